//! The hemisphere above a point, seen from straight above: the Nusselt analogue (W. Nusselt 1928), in which
//! area is projected solid angle. It shows the arriving light, the lobe of the model, and their product,
//! whose mean times π is the light to the observer.

use glam::{Vec2, Vec3};

use super::{Spot, rounded_number_or_triple};
use crate::{
    light::{Emitter, Incident, LightRecord},
    optics::{Frame, TermSelection, geometry::mirror},
    reflection::Surface,
    registry::Registry,
    scene::{Light, Scene, emitter},
};

mod picture;

pub use picture::HemispherePicture;

/// What the discs lack of light that does not spread.
const SHARP: &str = "Light that is mirrored, or passes, without spreading comes from a single direction, such as R: that has no \
                     area, so lobe and product are black there.";

/// What the discs show without light with extent.
const NOTHING: &str = "No light with extent shines on the point: light and product are black. Yellow rings, if there are some, are lights \
                       of a single direction.";

/// Sample points per side of a pixel.
const FINE: usize = 2;

/// The values in one direction above a point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Above {
    /// The luminance that arrives from all lights with extent, cd/m².
    pub arriving: Vec3,
    /// The lobe: the model's response divided by the cosine, π f for a BRDF f.
    pub lobe: Vec3,
    /// The product of the two.
    pub product: Vec3,
}

/// A light with a single direction, which has no area.
#[derive(Clone, Debug)]
pub struct PointLight {
    /// Position in the disc.
    pub place: Vec2,
    /// The arriving light, lx.
    pub light: Vec3,
}

/// The hemisphere above a point as a disc in a square: tangent to the right, bitangent up, normal in the
/// middle.
#[derive(Clone, Debug)]
pub struct Hemisphere {
    /// Width and height, in pixels.
    pub side: usize,
    /// Row by row from the top: means over the part of each pixel inside the disc; `None` outside.
    pub pixels: Vec<Option<Above>>,
    /// The mean of the product over the disc times π: the integral over all lights with extent, unless some of them are
    /// smaller than a pixel.
    pub integral: Vec3,
    /// The same by the samples of the explanation, which find the smallest light; `None` without a light with extent.
    sampled: Option<Vec3>,
    /// The largest values, in any direction that was looked at.
    pub brightest: Above,
    /// Lights with a single direction, or smaller than a pixel, that shine on the point.
    pub points: Vec<PointLight>,
    /// Direction to the viewer in the disc.
    pub view: Vec2,
    /// Mirror direction of the viewer.
    pub mirror: Vec2,
    /// True if some light keeps a single direction: it is mirrored, or passes, without spreading.
    pub sharp: bool,
    /// True if light comes through a solid body, by other ways than from above.
    pub solid: bool,
}

/// The direction above a point for a position in the unit disc, in the local frame with the normal +z. Area
/// is projected solid angle.
#[must_use]
pub fn above(place: Vec2) -> Option<Vec3> {
    let squared = place.length_squared();
    (squared < 1.0).then(|| place.extend((1.0 - squared).sqrt()))
}

/// The lights of a scene that can shine on a point.
pub struct Shining(Vec<(Box<dyn Emitter>, LightRecord, bool)>);

impl Shining {
    /// The lights of a scene that are switched on.
    #[must_use]
    pub fn new(scene: &Scene, registry: &Registry) -> Self {
        let encoding = scene.display.encoding;
        let lamp = |light: &Light| {
            let (entry, emitter, record) = emitter(light, registry, encoding)?;
            Some((emitter, record, entry.declaration.extent))
        };
        Self(scene.shining().filter_map(lamp).collect())
    }

    /// The luminance arriving from lights with extent.
    fn seen(&self, p: Vec3, l: Vec3) -> Vec3 {
        let extended = self.0.iter().filter(|(.., extent)| *extent);
        extended.map(|(emitter, record, _)| emitter.seen(record, p, l).radiance * record.colour).sum()
    }

    /// The lights above a point that have a single direction, or whose cone has at most this half-angle.
    fn points(&self, p: Vec3, frame: &Frame, small: f32) -> Vec<PointLight> {
        let point = |(emitter, record, extent): &(Box<dyn Emitter>, LightRecord, bool)| {
            let (l, light) = match emitter.incident(record, p) {
                _ if *extent => {
                    emitter.bounds(record, p).filter(|cone| cone.half_angle <= small)?;
                    let middle = emitter.sample(record, p, Vec2::splat(0.5));
                    (middle.l, middle.radiance / middle.pdf)
                }
                Incident::From { l, intensity } => (l, intensity),
                _ => return None,
            };
            let shines = frame.n.dot(l) > 0.0 && light.is_finite() && light != Vec3::ZERO;
            shines.then(|| PointLight { place: frame.to_local(l).truncate(), light: light * record.colour })
        };
        self.0.iter().filter_map(point).collect()
    }
}

/// One of the three discs.
#[derive(Debug)]
pub struct Disc {
    /// Name of the quantity.
    pub name: &'static str,
    /// The name where there is little room.
    pub short: &'static str,
    /// Unit of the values.
    pub unit: &'static str,
    /// Selects the value.
    pub of: fn(&Above) -> Vec3,
}

/// The discs.
pub const DISCS: [Disc; 3] = [
    Disc { name: "Light that arrives: L", short: "Light: L", unit: "cd/m²", of: |above| above.arriving },
    Disc { name: "Lobe of the model: π f", short: "Lobe: π f", unit: "", of: |above| above.lobe },
    Disc { name: "Product: π f L", short: "Product: π f L", unit: "cd/m²", of: |above| above.product },
];

impl Hemisphere {
    /// The hemisphere above a point of an explanation, with these terms of the model, as discs with this many
    /// pixels per side.
    #[must_use]
    pub fn new(
        shining: &Shining,
        surface: &dyn Surface,
        spot: &Spot,
        terms: TermSelection,
        side: usize,
    ) -> Self {
        Self::by(above, shining, surface, spot, (terms, side))
    }

    fn by(
        project: impl Fn(Vec2) -> Option<Vec3>,
        shining: &Shining,
        surface: &dyn Surface,
        spot: &Spot,
        (terms, side): (TermSelection, usize),
    ) -> Self {
        let frame = &spot.frame;
        let place = |d: Vec3| frame.to_local(d).truncate();
        let at = |place: Vec2| {
            let local = project(place)?;
            let l = frame.t * local.x + frame.b * local.y + frame.n * local.z;
            let arriving = shining.seen(spot.position, l);
            let lobe = surface.response(l, spot.view, frame).select(terms) / local.z;
            Some([arriving, lobe, arriving * lobe])
        };
        let (mut sum, mut count) = (Vec3::ZERO, 0.0f32);
        let mut most = [Vec3::ZERO; 3];
        let mut pixels = Vec::with_capacity(side * side);
        let fine = (side * FINE) as f32;
        for pixel in 0..side * side {
            let (column, row) = (pixel % side, pixel / side);
            let (mut all, mut n) = ([Vec3::ZERO; 3], 0.0f32);
            for part in 0..FINE * FINE {
                let x = (column * FINE + part % FINE) as f32 + 0.5;
                let y = (row * FINE + part / FINE) as f32 + 0.5;
                let Some(found) = at(Vec2::new(2.0 * x / fine - 1.0, 1.0 - 2.0 * y / fine)) else { continue };
                all.iter_mut().zip(found).for_each(|(sum, part)| *sum += part);
                let finite = |v: Vec3| if v.is_finite() { v } else { Vec3::ZERO };
                most.iter_mut().zip(found).for_each(|(most, part)| *most = most.max(finite(part)));
                n += 1.0;
            }
            (sum, count) = (sum + all[2], count + n);
            let [arriving, lobe, product] = all.map(|sum| sum / n);
            pixels.push((n > 0.0).then_some(Above { arriving, lobe, product }));
        }
        let integral = std::f32::consts::PI * sum / count.max(1.0);
        let [view, mirror] = [spot.view, mirror(spot.view, frame.n)].map(place);
        let points = shining.points(spot.position, frame, 2.0 / side as f32);
        let sharp = surface.sharp(spot.view, frame).iter().next().is_some();
        let solid = surface.interior().is_some();
        let [arriving, lobe, product] = most;
        let brightest = Above { arriving, lobe, product };
        let extended = spot.lights.iter().filter(|lit| lit.integral.is_some());
        let sampled = extended.map(|lit| lit.response.select(terms)).reduce(|a, b| a + b);
        Self { side, pixels, integral, sampled, brightest, points, view, mirror, sharp, solid }
    }

    /// The remark that there is no light with extent, if that is so.
    #[must_use]
    pub fn nothing(&self) -> Option<&'static str> {
        self.sampled.is_none().then_some(NOTHING)
    }

    /// The discs in words: what is missing in them, if anything, and the integral.
    #[must_use]
    pub fn said(&self) -> Vec<String> {
        let sharp = self.sharp.then(|| SHARP.to_owned()).into_iter();
        let Some(sampled) = self.sampled else { return sharp.chain([NOTHING.to_owned()]).collect() };
        let apart = self.sharp || self.solid;
        // The pixels of the disc give two digits, and know nothing of light that does not spread.
        let integral = rounded_number_or_triple(if apart { self.integral } else { sampled }, 2);
        let rest = if apart { "the rest of " } else { "" };
        let mean = format!(
            "The mean of the product times π is {rest}the light to the observer from lights with extent: about {integral}"
        );
        sharp.chain([mean]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        explain::{Explanation, pixel},
        parameter::Value,
        reference::Settings,
    };

    const SETTINGS: Settings = Settings { width: 64, height: 36, samples: 1, terms: TermSelection::All };

    fn light(light_type: &str, intensity: f32) -> Light {
        Light {
            light_type: light_type.to_owned(),
            position: Some(Scene::default().objects[0].position + Vec3::new(1.0, 1.5, 2.0)),
            direction: Some(Vec3::new(-1.0, -1.5, -2.0)),
            intensity,
            ..Scene::default().lights[0].clone()
        }
    }

    fn scene(model: &str, lights: Vec<Light>) -> Scene {
        let shading_model = "phong".to_owned();
        Scene { reflection_model: model.to_owned(), shading_model, lights, ..Scene::default() }
    }

    fn explained(scene: &Scene) -> Explanation {
        pixel(scene, &Registry::builtin(), &SETTINGS, [34, 16]).expect("inside")
    }

    fn hemisphere(scene: &Scene, project: impl Fn(Vec2) -> Option<Vec3>) -> (Hemisphere, Vec3) {
        let seen = explained(scene).seen.expect("the sphere");
        let (spot, surface) = (&seen.spots[0], &*seen.model.surface.0);
        let found = Hemisphere::by(
            project,
            &Shining::new(scene, &Registry::builtin()),
            surface,
            spot,
            (TermSelection::All, 96),
        );
        (found, spot.sum)
    }

    fn stereographic(place: Vec2) -> Option<Vec3> {
        let squared = place.length_squared();
        (squared < 1.0).then(|| (2.0 * place).extend(1.0 - squared) / (1.0 + squared))
    }

    #[test]
    fn the_mean_of_the_product_times_pi_is_the_integral() {
        let mut wrong = 0;
        let mut everywhere = light("environment", 10.0);
        everywhere.parameters.set("source", Value::Choice("uniform".into()));
        for model in ["lambert", "blinn_phong", "oren_nayar"] {
            let mut scene =
                scene(model, vec![light("rectangle", 10.0), light("sphere", 3.0), everywhere.clone()]);
            // Blinn's ambient term counts light from below too, which the hemisphere above does not hold.
            scene.objects[0].material.set("k_a", Value::Number(0.0));
            let off = |(found, sum): (Hemisphere, Vec3)| (found.integral - sum).length() / sum.length();
            let right = off(hemisphere(&scene, above));
            assert!(right < 0.02, "{model}: {right}");
            wrong += usize::from(off(hemisphere(&scene, stereographic)) > 0.04);
        }
        assert_eq!(wrong, 3, "another projection gives other integrals");
    }

    #[test]
    fn a_uniform_environment_fills_the_disc_evenly_and_a_point_is_a_dot() {
        let mut everywhere = light("environment", 2.0);
        everywhere.parameters.set("source", Value::Choice("uniform".into()));
        let (found, _) = hemisphere(&scene("lambert", vec![everywhere, light("point", 10.0)]), above);
        let all: Vec<_> = found.pixels.iter().flatten().map(|above| above.arriving).collect();
        assert!(all.iter().all(|l| (*l - all[0]).abs().max_element() < 1e-5 && l.x > 0.0));
        let part = all.len() as f32 / (96.0 * 96.0);
        assert!((part - std::f32::consts::FRAC_PI_4).abs() < 0.04, "{part}");
        let lobe = found.pixels[96 * 48 + 48].expect("the middle").lobe;
        assert!(found.pixels.iter().flatten().all(|above| (above.lobe - lobe).abs().max_element() < 1e-3));
        assert_eq!(found.points.len(), 1);
        assert!((found.view + found.mirror).length() < 1e-4, "beside each other's opposite");
    }

    #[test]
    fn a_light_smaller_than_a_pixel_is_marked_and_counted() {
        let mut sun = light("sun", 10.0);
        sun.parameters.set("diameter", Value::Number(0.05));
        let (found, sum) = hemisphere(&scene("lambert", vec![sun.clone()]), above);
        assert!((found.integral - sum).length() > 0.5 * sum.length(), "the discs miss it");
        let said = found.said().concat();
        assert!(said.ends_with(&rounded_number_or_triple(sum, 2)), "{said} {sum}");
        let mark = found.points.first().expect("a mark").light;
        assert!((mark - 10.0).abs().max_element() < 0.1, "{mark}");
        // One that fills pixels has no mark, and is as bright as its lamp where it is seen at all.
        let (found, _) = hemisphere(&scene("lambert", vec![light("rectangle", 10.0)]), above);
        assert!(found.points.is_empty());
        assert_eq!(found.brightest.arriving, Vec3::splat(10.0));
    }

    #[test]
    fn the_picture_says_what_it_shows() {
        let scene = scene("blinn_phong", vec![light("rectangle", 10.0), light("point", 10.0)]);
        let picture = hemisphere(&scene, above).0.picture();
        assert_eq!(picture.rgb8.len() as u32, 3 * picture.size[0] * picture.size[1]);
        assert!(picture.about.contains("tangent") && picture.about.contains("cd/m²"), "{}", picture.about);
        let dark = hemisphere(&self::scene("lambert", vec![light("point", 10.0)]), above).0;
        assert_eq!(dark.integral, Vec3::ZERO);
        assert_ne!(dark.picture().rgb8, picture.rgb8);
        let about = dark.picture().about;
        assert!(about.contains("No light with extent shines on the point"), "{about}");
        assert!(about.contains("white in “Light that arrives: L”: none, all is black"), "{about}");
        assert!(!picture.about.contains("black"), "{}", picture.about);
    }

    #[test]
    fn a_smooth_surface_says_why_its_discs_are_black() {
        let lights = || vec![light("rectangle", 10.0)];
        for model in ["glass", "thin_glass"] {
            let (found, _) = hemisphere(&scene(model, lights()), above);
            assert!(found.pixels.iter().flatten().all(|above| above.product == Vec3::ZERO), "{model}");
            let about = found.picture().about;
            assert!(about.contains("a single direction") && about.contains("the rest of"), "{about}");
        }
        let rough = hemisphere(&scene("blinn_phong", lights()), above).0.picture().about;
        assert!(!rough.contains("a single direction") && !rough.contains("the rest of"), "{rough}");
    }

    #[test]
    fn an_explanation_of_light_with_extent_is_an_integral() {
        let scene = scene("blinn_phong", vec![light("rectangle", 10.0), light("sphere", 3.0)]);
        let text = explained(&scene).to_text();
        for part in [
            "256 samples of the light and 256 of the lobes",
            "I_d = ∫ I_d(l) L(l) dω",
            " ± ",
            " sr.",
            "the one that gives most",
        ] {
            assert!(text.contains(part), "{part}:\n{text}");
        }
        assert!(!text.contains("I(p)"), "{text}");
        let json = explained(&scene).to_json();
        let lit = &json["seen"]["spots"][0]["lights"][0];
        assert!(lit["intensity"].is_null() && lit["integral"]["samples"]["light"] == 256, "{lit:#}");
        assert!(lit["integral"]["solid_angle"].as_f64().is_some_and(|angle| angle > 0.0), "{lit:#}");
        assert!(lit["lines"][0]["error"].is_array(), "{lit:#}");
    }

    #[test]
    fn differences_are_smooth_though_integrals_have_noise() {
        let scene = scene("lambert", vec![light("rectangle", 10.0)]);
        let registry = Registry::builtin();
        let mut explainer = crate::explain::Explainer::default();
        let found = explainer.influences(&scene, &registry, &SETTINGS, [34, 16]).expect("inside");
        let intensity = found.iter().find(|i| i.symbol == "I").expect("a light");
        let expected = explained(&scene).steps.light / 10.0;
        let off = (intensity.derivative() - expected).length() / expected.length();
        assert!(off < 1e-3, "{:?} {expected}", intensity.derivative());
    }
}
