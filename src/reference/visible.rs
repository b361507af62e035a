//! Lights with extent visible in the picture: the nearest in each direction, with its radiance.

use std::f32::consts::PI;

use glam::{Mat3, Vec3};

use super::{Shot, lights::within_bounds};
use crate::{
    light::{Emitter, LightRecord, extent::Cone},
    scene::{
        emitter,
        observer::{half_tangents, orientation},
    },
};

/// The visible lights in one direction.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Shown {
    /// Indices among the lights of the scene: one, or several at infinity.
    pub(crate) lights: Vec<usize>,
    /// The light that the picture shows: π times the radiance, as a white surface shows that receives it from everywhere.
    pub(crate) light: Vec3,
    /// `1 / w`, as for objects; 0 at infinity.
    pub(crate) nearness: f32,
}

/// Light and nearness, without the indices.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sight {
    pub(super) light: Vec3,
    pub(super) nearness: f32,
}

struct Visible {
    emitter: Box<dyn Emitter>,
    record: LightRecord,
    /// Index among the lights of the scene.
    index: usize,
    /// The cone that contains the light, and the cosine of its half angle; `None` if the light may be
    /// anywhere.
    cone: Option<(Cone, f32)>,
}

impl Visible {
    /// True if all of the light is infinitely far away.
    fn is_at_infinity(&self, eye: Vec3, ahead: Vec3) -> bool {
        let towards = self.cone.map_or(ahead, |(cone, _)| cone.axis);
        self.emitter.seen(&self.record, eye, towards).distance.is_infinite()
    }

    /// The light's radiance and nearness in a direction, if it is there.
    fn seen(&self, ray: &Ray, eye: Vec3) -> Option<Sight> {
        // Rounding of small angles must not exclude any part.
        if self.cone.is_some_and(|(cone, cosine)| ray.l.dot(cone.axis) < cosine - 1e-6) {
            return None;
        }
        let seen = self.emitter.seen(&self.record, eye, ray.l);
        self.sight(seen.radiance, seen.distance, ray.stretch)
    }

    fn sight(&self, radiance: Vec3, distance: f32, stretch: f32) -> Option<Sight> {
        let light = within_bounds(PI * radiance * self.record.colour);
        (distance > 0.0).then(|| Sight { light, nearness: stretch / distance })
    }
}

/// A direction from the eye.
struct Ray {
    l: Vec3,
    /// One over the cosine to the viewing direction.
    stretch: f32,
}

/// The visible lights of a scene, and the eye.
pub(super) struct VisibleLights {
    lights: Vec<Visible>,
    eye: Vec3,
    /// Maps pixels right, down, and 1 to directions.
    rays: Mat3,
}

/// The lights visible at the centre of a pixel in front of a point, or of the background.
pub(crate) fn in_front(shot: Shot, pixel: [u32; 2], point: Option<Vec3>) -> Option<Shown> {
    let shown = VisibleLights::new(shot).at(pixel.map(|c| c as f32 + 0.5))?;
    let observer = &shot.scene.observer;
    let ahead = observer.direction.normalize_or_zero();
    let nearer = |point: Vec3| shown.nearness * (point - observer.position).dot(ahead) > 1.0;
    point.is_none_or(nearer).then_some(shown)
}

impl VisibleLights {
    pub(super) fn new(Shot { scene, registry, settings, .. }: Shot) -> Self {
        let encoding = scene.display.encoding;
        let eye = scene.observer.position;
        let ahead = scene.observer.direction.normalize_or(Vec3::NEG_Z);
        // A background that the scene gives stands in place of what is infinitely far away.
        let hides = scene.display.backdrop().is_some();
        let shining = scene.lights.iter().enumerate().filter(|(_, light)| light.enabled);
        let lights = shining.filter_map(|(index, light)| {
            let is_visible = registry.light(&light.light_type)?.is_visible(&light.parameters);
            let (_, emitter, record) = emitter(light, registry, encoding).filter(|_| is_visible)?;
            let cone = emitter.bounds(&record, eye).map(|cone| (cone, cone.half_angle.cos()));
            let light = Visible { emitter, record, index, cone };
            (!hides || !light.is_at_infinity(eye, ahead)).then_some(light)
        });
        let size = [settings.width, settings.height];
        let axes = orientation(scene.observer.direction);
        let [across, up] = half_tangents(size, scene.observer.field_of_view.to_radians());
        let [across, up] = [across as f32, up as f32];
        let step = [2.0 * across, 2.0 * up].map(f64::from);
        let [right, down] = [step[0] / f64::from(size[0].max(1)), step[1] / f64::from(size[1].max(1))];
        let rays = Mat3::from_cols(
            axes.x_axis * right as f32,
            -axes.y_axis * down as f32,
            -axes.z_axis - axes.x_axis * across + axes.y_axis * up,
        );
        Self { lights: lights.collect(), eye, rays }
    }

    fn ray(&self, [x, y]: [f32; 2]) -> Ray {
        let d = self.rays * Vec3::new(x, y, 1.0);
        let stretch = d.length();
        Ray { l: d / stretch, stretch }
    }

    /// The lights visible at a position in the picture, in pixels from the top left; `None` if there is none.
    pub(super) fn at(&self, place: [f32; 2]) -> Option<Shown> {
        let ray = self.ray(place);
        let all: Vec<_> = self.lights.iter().collect();
        let Sight { light, nearness } = sum(&all, None, &ray, self.eye)?;
        let is_it = |light: &&Visible| light.seen(&ray, self.eye).is_some_and(|s| s.nearness == nearness);
        let lights = self.lights.iter().filter(is_it).map(|light| light.index).collect();
        Some(Shown { lights, light, nearness })
    }

    /// The lights that may be visible in a square part of the picture, whose pixels have so many samples; `None` if
    /// there are none.
    pub(super) fn within(&self, origin: [usize; 2], edge: usize, samples: usize) -> Option<Part<'_>> {
        if self.lights.is_empty() {
            return None;
        }
        let [left, top] = origin;
        let corner = |x: usize, y: usize| self.ray([(left + x) as f32, (top + y) as f32]).l;
        let middle = self.ray([left as f32 + 0.5 * edge as f32, top as f32 + 0.5 * edge as f32]).l;
        let corners = [corner(0, 0), corner(edge, 0), corner(0, edge), corner(edge, edge)];
        let half = corners.iter().map(|c| middle.angle_between(*c)).fold(0.0, f32::max) + 1e-3;
        let touches = |cone: Cone| middle.angle_between(cone.axis) <= cone.half_angle + half;
        let (bounded, around): (Vec<_>, Vec<_>) = self
            .lights
            .iter()
            .filter(|light| light.cone.is_none_or(|(cone, _)| touches(cone)))
            .partition(|light| light.cone.is_some());
        if bounded.is_empty() && around.is_empty() {
            return None;
        }
        let same = around.iter().try_fold(None, |known, light| {
            let radiance = light.emitter.same_between(&light.record, &corners)?;
            Some(joined(known, light.sight(radiance, f32::INFINITY, 1.0)))
        });
        let known = match same {
            Some(_) => Vec::new(),
            None => self.surroundings(&around, origin, edge, samples),
        };
        let throughout = same.flatten().filter(|_| bounded.is_empty()).map(|sight| sight.light);
        let same = same.map(|same| (same, around.len()));
        Some(Part { of: self, lights: [around, bounded].concat(), origin, edge, same, known, throughout })
    }

    /// For each pixel of a part, the light of its surroundings and their number, or nothing if it differs between the
    /// samples of the pixel.
    fn surroundings(
        &self,
        around: &[&Visible],
        origin: [usize; 2],
        edge: usize,
        samples: usize,
    ) -> Vec<(Option<Sight>, usize)> {
        // Pixels with one sample have it at their centre; the others compare with their neighbours.
        let margin = usize::from(samples > 1);
        let side = edge + 2 * margin;
        let at = |axis: usize, step: usize| origin[axis] as f32 + step as f32 + 0.5 - margin as f32;
        let rays: Vec<Ray> = (0..side * side).map(|i| self.ray([at(0, i % side), at(1, i / side)])).collect();
        let directions: Vec<Vec3> = rays.iter().map(|ray| ray.l).collect();
        let mut seen = vec![(Vec3::ZERO, 0.0); rays.len()];
        let mut centres = vec![None; rays.len()];
        for light in around {
            light.emitter.seen_along(&light.record, self.eye, &directions, &mut seen);
            for ((known, (radiance, distance)), ray) in centres.iter_mut().zip(&seen).zip(&rays) {
                *known = joined(*known, light.sight(*radiance, *distance, ray.stretch));
            }
        }
        let pixels = (0..edge * edge).map(|i| (i / edge + margin) * side + i % edge + margin);
        let known = |i: usize| match margin {
            0 => (centres[i], around.len()),
            _ => even(&centres, i, side).map_or((None, 0), |sight| (Some(sight), around.len())),
        };
        pixels.map(known).collect()
    }
}

/// The lights that may be seen in a part of the picture.
pub(super) struct Part<'a> {
    of: &'a VisibleLights,
    /// Surroundings, which may be anywhere, before the others.
    lights: Vec<&'a Visible>,
    origin: [usize; 2],
    edge: usize,
    /// The light known in the whole part, and the number of lights that it is from.
    same: Option<(Option<Sight>, usize)>,
    /// The light of each pixel, with that number, if it is not known in the whole part.
    known: Vec<(Option<Sight>, usize)>,
    /// The radiance of the lights, if it is the same in the whole part.
    pub(super) throughout: Option<Vec3>,
}

impl Part<'_> {
    /// The visible lights at the samples of a pixel, which are given relative to it: radiance and `1 / w`.
    pub(super) fn pixel<const S: usize>(
        &self,
        [x, y]: [usize; 2],
        samples: [[f32; 2]; S],
    ) -> [Option<Sight>; S] {
        let (known, count) = self.same.unwrap_or_else(|| self.known[y * self.edge + x]);
        let others = &self.lights[count..];
        if others.is_empty() {
            return [known; S];
        }
        let at = |axis: usize, place: usize| (self.origin[axis] + place) as f32;
        samples.map(|[right, down]| {
            sum(others, known, &self.of.ray([at(0, x) + right, at(1, y) + down]), self.of.eye)
        })
    }
}

/// The surrounding light at the centre of a pixel, if it is nearly the same at its neighbours; rows have `side` pixels.
fn even(centres: &[Option<Sight>], i: usize, side: usize) -> Option<Sight> {
    /// Maximum relative difference.
    const EVEN: f32 = 1.0 / 64.0;
    let here = centres[i]?;
    let is_near = |i: usize| {
        let there = centres[i]?;
        let difference = (there.light - here.light).abs().max_element();
        (there.nearness == here.nearness && difference <= EVEN * here.light.abs().max_element()).then_some(())
    };
    [i - side, i - 1, i + 1, i + side].into_iter().try_for_each(is_near)?;
    // Something near has a different nearness at each sample.
    (here.nearness == 0.0).then_some(here)
}

/// The light visible in a direction, combined with the known light: the nearest, or the sum of lights at
/// infinity.
fn sum(lights: &[&Visible], known: Option<Sight>, ray: &Ray, eye: Vec3) -> Option<Sight> {
    lights.iter().map(|light| light.seen(ray, eye)).fold(known, joined)
}

fn joined(known: Option<Sight>, sight: Option<Sight>) -> Option<Sight> {
    match (known, sight) {
        (known, None) => known,
        (Some(known), Some(sight)) if sight.nearness > known.nearness => Some(sight),
        (Some(known), Some(sight)) if known.nearness == 0.0 => {
            Some(Sight { light: known.light + sight.light, ..known })
        }
        (Some(known), Some(_)) => Some(known),
        (None, sight) => sight,
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::AtomicBool;

    use super::*;
    use crate::{
        parameter::Value,
        reference::{LightSamples, Picture, Settings, render_samples},
        registry::Registry,
        scene::{Light, Object, Observer, Scene},
    };

    const SIZE: u32 = 64;

    fn settings(samples: u32) -> Settings {
        Settings { width: SIZE, height: SIZE, samples, ..Settings::default() }
    }

    /// A light in front of the observer, who looks along −z from z = 10.
    fn scene(light_type: &str, z: f32) -> Scene {
        let registry = Registry::builtin();
        let declaration = registry.light(light_type).expect("built in").declaration;
        // The cylinder stands upright; the others shine towards the observer, and the sun from the viewing
        // direction.
        let direction = if light_type == "cylinder" { Vec3::Y } else { Vec3::Z };
        let mut light = Light {
            light_type: light_type.to_owned(),
            position: declaration.has_position.then_some(Vec3::new(5.0, 5.0, z)),
            direction: declaration.has_direction.then_some(direction),
            intensity: 3.0,
            colour: [255, 128, 0],
            ..Light::default()
        };
        light.parameters.set("diameter", Value::Number(20.0));
        light.parameters.set("radius", Value::Number(0.5));
        Scene {
            lights: vec![light],
            objects: Vec::new(),
            observer: Observer {
                field_of_view: 60.0,
                ..Observer::at(Vec3::new(5.0, 5.0, 10.0), Vec3::NEG_Z)
            },
            ..Scene::default()
        }
    }

    fn extended() -> Vec<&'static str> {
        let registry = Registry::builtin();
        registry.lights().iter().map(|l| l.declaration).filter(|d| d.extent).map(|d| d.id).collect()
    }

    fn picture(scene: &Scene, samples: u32) -> Picture {
        let few = LightSamples::of(8);
        render_samples(scene, &Registry::builtin(), &settings(samples), few, &AtomicBool::default())
    }

    fn middle(scene: &Scene) -> Vec3 {
        picture(scene, 4).pixel(SIZE / 2, SIZE / 2).truncate()
    }

    /// The light that the observer receives from straight ahead.
    fn ahead(scene: &Scene) -> Vec3 {
        let shown = in_front(Shot::new(scene, &Registry::builtin(), &settings(1)), [SIZE / 2; 2], None);
        shown.expect("it is in the middle").light
    }

    #[test]
    fn a_light_is_seen_with_its_radiance_unless_it_is_to_be_invisible_or_off() {
        assert_eq!(extended().len(), 6);
        for light_type in extended() {
            let mut scene = scene(light_type, 5.0);
            let radiance = ahead(&scene);
            assert!(radiance.x > 0.0 && radiance.z == 0.0, "{light_type}: {radiance}");
            if light_type != "sun" && light_type != "environment" {
                assert!((radiance.x - 3.0 * PI).abs() < 1e-5, "{light_type}: {radiance}");
            }
            let error = (middle(&scene) - radiance).abs().max_element();
            assert!(error <= 2e-2 * radiance.x, "{light_type}: {error}");
            let covers = |scene: &Scene| picture(scene, 4).pixels.iter().any(|p| p.w > 0.0);
            assert!(covers(&scene), "{light_type}");
            scene.lights[0].enabled = false;
            assert!(!covers(&scene), "{light_type}");
            scene.lights[0].enabled = true;
            scene.lights[0].parameters.set("visible", Value::Choice("false".into()));
            assert!(!covers(&scene), "{light_type}");
        }
    }

    #[test]
    fn lights_and_objects_hide_what_is_behind_them() {
        let ball = Object { position: Vec3::new(5.0, 5.0, 5.0), size: 1.0, ..Object::default() };
        for light_type in extended() {
            let is_near = !["sun", "environment"].contains(&light_type);
            for (z, in_front) in [(7.0, is_near), (2.0, false)] {
                let mut scene = scene(light_type, z);
                scene.objects.push(ball.clone());
                let shows = (middle(&scene) - ahead(&scene)).abs().max_element() < 1e-4;
                assert_eq!(shows, in_front, "{light_type} at {z}");
            }
        }
    }

    #[test]
    fn the_nearest_light_is_seen_and_lights_without_end_add_up() {
        let mut both = scene("sphere", 5.0);
        both.lights.push(Light { intensity: 7.0, ..scene("disc", 3.0).lights.remove(0) });
        assert!((ahead(&both).x - 3.0 * PI).abs() < 1e-5);
        both.lights.reverse();
        assert!((ahead(&both).x - 3.0 * PI).abs() < 1e-5);
        let mut sum = scene("environment", 0.0);
        let [sky, sun] = [ahead(&sum), ahead(&scene("sun", 0.0))];
        sum.lights.extend(scene("sun", 0.0).lights);
        assert!((ahead(&sum) - sky - sun).abs().max_element() < 1e-5 * sun.x);
        sum.lights.extend(scene("sphere", 5.0).lights);
        assert!((ahead(&sum).x - 3.0 * PI).abs() < 1e-5);
    }

    #[test]
    fn the_parts_of_a_picture_show_every_light_that_the_whole_shows() {
        let registry = Registry::builtin();
        for light_type in extended().into_iter().filter(|id| *id != "environment") {
            for (x, z) in [(5.0, 5.0), (2.5, 6.0), (7.4, 8.5), (5.3, 9.4)] {
                let mut scene = scene(light_type, z);
                if let Some(position) = &mut scene.lights[0].position {
                    *position += Vec3::new(x - 5.0, 0.4, 0.0);
                }
                scene.lights[0].direction = scene.lights[0].direction.map(|d| d + Vec3::new(0.3, 0.2, 0.0));
                scene.lights[0].parameters.set("diameter", Value::Number(10.0 + x));
                let mut lights = VisibleLights::new(Shot::new(&scene, &registry, &settings(1)));
                let differ = |lights: &VisibleLights| {
                    let mut differ = 0;
                    for (column, row) in (0..SIZE as usize / 8).flat_map(|r| (0..8).map(move |c| (c, r))) {
                        let part = lights.within([8 * column, 8 * row], 8, 1);
                        for (x, y) in (0..8).flat_map(|y| (0..8).map(move |x| (x, y))) {
                            let shown = part.as_ref().map(|part| part.pixel([x, y], [[0.5, 0.5]]));
                            let place = [8 * column + x, 8 * row + y].map(|c| c as f32 + 0.5);
                            let all = VisibleLights::new(Shot::new(&scene, &registry, &settings(1)));
                            let cone = |light: Visible| Visible { cone: None, ..light };
                            let all =
                                VisibleLights { lights: all.lights.into_iter().map(cone).collect(), ..all };
                            let known = all.at(place);
                            let known = known.map(|Shown { light, nearness, .. }| Sight { light, nearness });
                            differ += usize::from(shown.and_then(|[one]| one) != known);
                        }
                    }
                    differ
                };
                assert_eq!(differ(&lights), 0, "{light_type} at {x}, {z}");
                // The wrong twin: a narrower cone.
                let Some((cone, cosine)) = &mut lights.lights[0].cone else { continue };
                *cosine = (0.8 * cone.half_angle).cos();
                if ["sphere", "sun"].contains(&light_type) && (x, z) == (5.0, 5.0) {
                    assert!(differ(&lights) > 0, "{light_type}");
                }
            }
        }
    }

    #[test]
    fn what_is_even_is_asked_once_for_a_pixel_and_edges_at_each_sample() {
        let mut scene = scene("environment", 0.0);
        scene.observer.direction = Vec3::new(0.7, 0.1, -1.0);
        let registry = Registry::builtin();
        let shown = picture(&scene, 4);
        let exact = VisibleLights::new(Shot::new(&scene, &registry, &settings(4)));
        let samples = [[96.0, 32.0], [224.0, 96.0], [32.0, 160.0], [160.0, 224.0]];
        let (mut edges, mut worst) = (0, 0.0f32);
        for (x, y) in (0..SIZE).flat_map(|y| (0..SIZE).map(move |x| (x, y))) {
            let at = |[right, down]: [f32; 2]| {
                let place = [x as f32 + right / 256.0, y as f32 + down / 256.0];
                exact.at(place).expect("it is everywhere").light.x
            };
            let each = samples.map(at);
            let mean = each.iter().sum::<f32>() / 4.0;
            edges += usize::from(each.iter().any(|one| (one - each[0]).abs() > 0.1 * mean));
            worst = worst.max((shown.pixel(x, y).x - mean).abs() / mean);
        }
        assert!(edges > 5, "{edges} pixels with edges of softboxes");
        assert!(worst < 0.02, "{worst}");
    }
}
