//! Light that comes through a solid body: the ray of view goes in, follows the mesh, and leaves into the lights with
//! extent and the surroundings. Other objects are not seen, and a ray that has left does not come back.
//!
//! A smooth body is one [chain](super::inside) of boundaries without chance; with dispersion, one for each of several
//! wavelengths. In a rough one a ray takes one way by chance at each boundary, and light is sampled there too, as at any
//! surface. Lights without extent reach through rough boundaries only.

use std::{f32::consts::PI, sync::Arc};

use glam::{Mat3, Vec2, Vec3};

use super::{
    extended::LightSamples,
    inside::{BEHIND, Entry, Normals, ORDERS, Solid, Turn, follow, turns},
    lights::Lights,
    meshes::Prepared,
};
use crate::{
    optics::{
        Frame,
        dispersion::{self, spectrum},
        interface::{Facets, Interface},
        interior::Interior,
        sequence::{Sequence, hash},
    },
    shape::{
        closed::NotSolid,
        hierarchy::{Ray, Sides},
    },
};

/// Largest number of wavelengths for one point.
const WAVELENGTHS: u32 = 4 * dispersion::PARTS;
/// Number of the sequence that chooses wavelengths; those of rough boundaries follow.
const FIRST_SEQUENCE: u32 = 1 << 16;

/// A body in its place.
#[derive(Clone)]
pub(crate) struct Body {
    pub(super) interior: Interior,
    pub(super) shape: Arc<Prepared>,
    pub(super) normals: Normals,
    pub(super) rotation: Mat3,
    pub(super) size: f32,
    pub(super) position: Vec3,
}

/// The point at which a ray of view meets a body.
pub(super) struct Viewed<'a> {
    pub(super) position: Vec3,
    pub(super) view: Vec3,
    pub(super) frame: &'a Frame,
    pub(super) seed: u32,
}

/// The transmitted light.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Through {
    /// The light that reaches the viewer.
    pub(crate) light: Vec3,
    /// The part of the light inside that was not followed any further.
    pub(crate) remaining: Vec3,
}

/// The inside of a body behind its boundary, for explanations.
#[derive(Clone, Debug, PartialEq)]
pub enum Inside {
    /// The body is a pane, because its mesh is not a solid.
    Pane(NotSolid),
    /// It is rough: each ray takes a way of its own, by chance.
    Chance,
    /// The boundaries that the ray meets, and the part of the light that was not followed any further; for light of the
    /// d line, if it disperses.
    Ways(Vec<Turn>, Vec3),
}

impl Inside {
    /// The inside as seen through a surface that transmits this part of the light.
    pub(crate) fn seen_by(mut self, part: Vec3) -> Self {
        if let Self::Ways(turns, remaining) = &mut self {
            turns
                .iter_mut()
                .filter_map(|turn| turn.leaves.as_mut())
                .for_each(|(_, through)| *through *= part);
            *remaining *= part;
        }
        self
    }
}

impl Body {
    /// The boundaries that a ray of view meets inside, from its point of entry on.
    pub(crate) fn inside(&self, position: Vec3, view: Vec3, normal: Vec3) -> Inside {
        match self.solid() {
            Err(why) => Inside::Pane(why.clone()),
            Ok(_) if self.interior.is_rough() => Inside::Chance,
            Ok(solid) => {
                let entry = Entry { position, view, normal, face_normal: normal };
                let (turns, remaining) = turns(&solid, &self.interior, &entry);
                Inside::Ways(turns, remaining)
            }
        }
    }

    /// True if light takes one of many ways through it, by chance.
    pub(super) fn leads_by_chance(&self) -> bool {
        self.interior.is_rough() && self.shape.body().is_ok()
    }

    /// The body as a solid, or the reason why its mesh is not one.
    fn solid(&self) -> Result<Solid<'_>, &NotSolid> {
        let hierarchy = self.shape.body()?;
        let Self { normals, rotation, size, position, .. } = *self;
        Ok(Solid { hierarchy, normals, rotation, size, position })
    }

    /// The light that comes through at a point.
    pub(super) fn through(&self, lights: &Lights, samples: LightSamples, from: &Viewed) -> Through {
        let Ok(solid) = self.solid() else {
            let light = self
                .interior
                .pane(from.view, from.frame)
                .into_iter()
                .map(|way| way.share * lights.along(from.position, way.l));
            return Through { light: light.sum(), ..Through::default() };
        };
        if self.interior.is_rough() {
            return self.rough(&solid, lights, samples, from);
        }
        if self.interior.cauchy_b == 0.0 {
            return smooth(&solid, &self.interior, lights, from);
        }
        let count =
            (samples.count / dispersion::PARTS).clamp(1, WAVELENGTHS / dispersion::PARTS) * dispersion::PARTS;
        let offset = Sequence::new(from.seed, FIRST_SEQUENCE).point(samples.first).x;
        let mut sum = Through::default();
        for i in 0..count {
            let wave = spectrum((i as f32 + offset) / count as f32);
            let one = smooth(&solid, &self.interior.at(wave.nm), lights, from);
            sum.light += wave.weight * one.light / count as f32;
            sum.remaining += wave.weight * one.remaining / count as f32;
        }
        sum
    }

    /// The mean over rays through a rough body.
    fn rough(&self, solid: &Solid, lights: &Lights, samples: LightSamples, from: &Viewed) -> Through {
        let mut sum = Through::default();
        for i in 0..samples.count {
            let index = samples.first.wrapping_add(i);
            let offset = || Sequence::new(from.seed, FIRST_SEQUENCE).point(index).x;
            let (interior, weight) = if self.interior.cauchy_b == 0.0 {
                (self.interior, Vec3::ONE)
            } else {
                let wave = spectrum(offset());
                (self.interior.at(wave.nm), wave.weight)
            };
            let one = Walk { solid, interior: &interior, lights, seed: from.seed, index }.walk(from);
            sum.light += weight * one.light;
            sum.remaining += weight * one.remaining;
        }
        let count = samples.count.max(1) as f32;
        Through { light: sum.light / count, remaining: sum.remaining / count }
    }
}

fn smooth(solid: &Solid, interior: &Interior, lights: &Lights, from: &Viewed) -> Through {
    let entry =
        Entry { position: from.position, view: from.view, normal: from.frame.n, face_normal: from.frame.n };
    let mut light = Vec3::ZERO;
    let remaining = follow(solid, interior, &entry, |position, direction, part| {
        light += part * lights.along(position, direction);
    });
    Through { light, remaining }
}

/// One ray through a rough body.
struct Walk<'a> {
    solid: &'a Solid<'a>,
    interior: &'a Interior,
    lights: &'a Lights,
    seed: u32,
    index: u32,
}

impl Walk<'_> {
    /// Random numbers for a boundary: two directions on the facets, and a choice.
    fn random(&self, order: usize) -> Vec3 {
        let number = |k: usize| hash(FIRST_SEQUENCE + 1 + (2 * order + k) as u32);
        let point = |k| Sequence::new(self.seed, number(k)).point(self.index);
        let (a, b): (Vec2, Vec2) = (point(0), point(1));
        a.extend(b.x)
    }

    fn walk(&self, from: &Viewed) -> Through {
        let interface = Interface::new(Facets::Ggx, Vec2::splat(self.interior.alpha), self.interior.eta());
        // Tangents are known to some renderers only, and the facets are alike in all directions.
        let outside = Frame::from_normal(from.frame.n);
        let v = outside.to_local(from.view);
        let Some(Step { l, weight, .. }) = step(&interface, self.random(0), v).filter(|step| step.l.z < 0.0)
        else {
            return Through::default();
        };
        let room = |d: Vec3| d.x * outside.t + d.y * outside.b + d.z * outside.n;
        let mut part = Vec3::splat(weight);
        let mut ray = self.solid.ray(from.position, room(l));
        let mut light = Vec3::ZERO;
        for order in 1..=ORDERS {
            let Some(hit) = self.solid.hierarchy.nearest(&ray, -BEHIND..f32::MAX, Sides::Inside) else {
                break;
            };
            part *= self.interior.left(self.solid.size * hit.distance);
            let (position, normals) = self.solid.boundary(&hit);
            let back = -(self.solid.rotation * ray.direction);
            let normal = normals.into_iter().find(|n| n.dot(back) < 0.0).unwrap_or(-back);
            let frame = Frame::from_normal(normal);
            let v = frame.to_local(back);
            let response = |l: Vec3| {
                let l = frame.to_local(l);
                if l.z > 0.0 { PI * l.z * interface.transmitted(l, v) } else { 0.0 }
            };
            let pdf = |l: Vec3| interface.pdf(frame.to_local(l), v);
            let seed = hash(self.seed ^ hash(order as u32));
            light += part * self.lights.sampled_at(position, (seed, self.index), &response, &pdf);
            let Some(Step { l, weight, pdf }) = step(&interface, self.random(order), v) else { break };
            part *= weight;
            let direction = l.x * frame.t + l.y * frame.b + l.z * frame.n;
            if l.z > 0.0 {
                light += part * self.lights.along_lobe(position, direction, pdf);
                return Through { light, remaining: Vec3::ZERO };
            }
            let inwards = self.solid.ray(position, direction);
            // A reflected ray that points outwards between the normals of shading and triangle is lost.
            if normals[1].dot(direction) >= 0.0 {
                break;
            }
            ray = Ray { origin: self.solid.hierarchy.point(hit.triangle, hit.weights), ..inwards };
        }
        Through { light, remaining: part }
    }
}

/// The way of a ray at a rough boundary.
struct Step {
    /// The direction in which the ray goes on.
    l: Vec3,
    /// The part of the light from there.
    weight: f32,
    /// The density of the direction in sr⁻¹: infinite at an invisible boundary, which lets nothing come from any other.
    pdf: f32,
}

fn step(interface: &Interface, u: Vec3, v: Vec3) -> Option<Step> {
    if interface.is_invisible() {
        return Some(Step { l: -v, weight: 1.0, pdf: f32::INFINITY });
    }
    let l = interface.sample(u, v)?;
    let pdf = interface.pdf(l, v);
    let weight = interface.bsdf(l, v) * l.z.abs() / pdf;
    (pdf > 0.0 && weight.is_finite()).then_some(Step { l, weight, pdf })
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::AtomicBool;

    use super::*;
    use crate::{
        parameter::Value,
        reference::{Picture, Settings, render_samples},
        registry::Registry,
        scene::{Light, Object, Observer, Scene},
    };

    const SIZE: u32 = 48;

    /// An object of a model in uniform light of 0.25 π, which is seen around it.
    fn scene(object_type: &str, material: &[(&'static str, Value)]) -> Scene {
        let mut light = Light {
            light_type: "environment".to_owned(),
            intensity: 0.25,
            colour: [255; 3],
            ..Light::default()
        };
        light.parameters.set("source", Value::Choice("uniform".into()));
        let mut object = Object {
            object_type: object_type.to_owned(),
            position: Vec3::new(5.0, 5.0, 5.0),
            rotation: Vec3::new(20.0, 30.0, 0.0),
            size: 2.0,
            ..Object::default()
        };
        material.iter().for_each(|(name, value)| object.material.set(*name, value.clone()));
        Scene {
            reflection_model: "glass".to_owned(),
            shading_model: "phong".to_owned(),
            lights: vec![light],
            objects: vec![object],
            observer: Observer {
                field_of_view: 30.0,
                ..Observer::at(Vec3::new(5.0, 5.0, 10.0), Vec3::NEG_Z)
            },
            ..Scene::default()
        }
    }

    fn picture(scene: &Scene, samples: u32) -> Picture {
        let settings = Settings { width: SIZE, height: SIZE, samples: 1, ..Settings::default() };
        let samples = LightSamples::of(samples);
        render_samples(scene, &Registry::builtin(), &settings, samples, &AtomicBool::default())
    }

    /// The largest and the mean deviation from the surroundings, relative.
    fn visible(picture: &Picture) -> [f32; 2] {
        let around = picture.pixel(0, 0).x;
        assert!((around - 0.25 * PI).abs() < 1e-5, "{around}");
        let off: Vec<_> =
            picture.pixels.iter().map(|p| (p.truncate() / around - 1.0).abs().max_element()).collect();
        [off.iter().copied().fold(0.0, f32::max), off.iter().sum::<f32>() / off.len() as f32]
    }

    #[test]
    fn a_body_that_absorbs_nothing_is_invisible_in_uniform_light() {
        // The mean normals at the edges of a cube would keep light in its corners.
        for (object_type, shading) in [("sphere", "phong"), ("cube", "derivative")] {
            let scene = Scene { shading_model: shading.to_owned(), ..scene(object_type, &[]) };
            let [most, mean] = visible(&picture(&scene, 1));
            // After 16 boundaries as much may remain where nearly all light is reflected.
            assert!(most < 3e-2 && mean < 1e-3, "{object_type}: {most} {mean}");
        }
        let disperses = [("dispersion", Value::Number(0.03))];
        let [most, mean] = visible(&picture(&scene("sphere", &disperses), 16));
        // Sixteen wavelengths are white within half a code of 255.
        assert!(most < 2e-2 && mean < 0.5 / 255.0, "with dispersion: {most} {mean}");
        // The wrong twin: green glass is seen.
        let green = [("transmittance_colour", Value::Colour([200, 255, 200]))];
        assert!(visible(&picture(&scene("sphere", &green), 1))[1] > 0.02);
    }

    #[test]
    fn a_rough_body_loses_what_its_facets_hide() {
        // The part of the picture that a ball of radius 1 covers at a distance of 5: π tan² asin(1/5)/(2 tan 15°)².
        let covered = PI * (1.0 / 24.0) / (4.0 * 15.0f32.to_radians().tan().powi(2));
        let loss = |roughness: f32| {
            let picture = picture(&scene("sphere", &[("roughness", Value::Number(roughness))]), 64);
            let around = picture.pixel(0, 0).x;
            let sum = picture.pixels.iter().map(|p| 1.0 - p.x / around).sum::<f32>();
            sum / (picture.pixels.len() as f32 * covered)
        };
        // Of light that meets a perfect ball of α = 0.4² all over, facets hide 0.124 from each other: 400 000 rays of
        // another program, which draws facets by their visible normals (E. Heitz 2018). Noise cancels out.
        let rough = loss(0.4);
        assert!((rough - 0.124).abs() < 0.015, "{rough}");
        // The wrong twin: facets of α = 0.01 hide hardly any.
        let polished = loss(0.1);
        assert!(polished.abs() < 0.015, "{polished}");
    }

    #[test]
    fn an_open_body_is_a_pane_that_loses_nothing() {
        let [most, _] = visible(&picture(&scene("teapot", &[]), 1));
        assert!(most < 1e-4, "{most}");
    }
}
