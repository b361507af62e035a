//! The numbers of a scene with the greatest influence on a pixel, by finite differences.

use glam::Vec3;

use super::{
    ExplainError, Explainer, Seen,
    numbers::{DIGITS, digits_within},
};
use crate::{
    optics::colour::luminance,
    parameter::{Parameter, limits::Limits},
    reference::Settings,
    registry::Registry,
    scene::{Scene, limits},
};

/// Fraction of a number's range by which it is changed up and down.
const STEP: f64 = 0.01;

/// A number of the scene.
#[derive(Clone, Debug, PartialEq)]
pub enum Knob {
    /// A parameter of the reflection model of the object at the pixel, by name.
    Material {
        /// Index of the object.
        object: usize,
        /// The parameter.
        parameter: &'static Parameter,
    },
    /// The intensity or the luminous flux of a light.
    Intensity {
        /// Index of the light.
        light: usize,
    },
}

/// The dependence of a pixel on a number of the scene: a difference quotient between two values around the
/// present one.
#[derive(Clone, Debug, PartialEq)]
pub struct Influence {
    /// The number.
    pub knob: Knob,
    /// Symbol of the number.
    pub symbol: &'static str,
    /// Name in words.
    pub label: String,
    /// Unit; often empty.
    pub unit: &'static str,
    /// Present value.
    pub value: f64,
    /// The two values tried: a hundredth of the range below and above, where legal.
    pub tried: [f64; 2],
    /// The light of the pixel for these two values.
    pub light: [Vec3; 2],
    /// A hundredth of the range.
    pub hundredth: f64,
    /// Significant digits of the differences: fewer where light with extent has noise.
    pub digits: usize,
}

impl Influence {
    /// `Δ light / Δ value`: red, green and blue per unit of the number.
    #[must_use]
    pub fn derivative(&self) -> Vec3 {
        let [low, high] = self.tried;
        if high > low { (self.light[1] - self.light[0]) / (high - low) as f32 } else { Vec3::ZERO }
    }

    /// True if the light changes with the number.
    #[must_use]
    pub fn moves(&self) -> bool {
        self.derivative() != Vec3::ZERO
    }

    /// The change of the luminance of the light for a hundredth of the range.
    #[must_use]
    pub fn effect(&self) -> f32 {
        luminance(self.derivative()) * self.hundredth as f32
    }
}

impl Explainer {
    /// The numbers of a scene, sorted by their [effect](Influence::effect) on a pixel, largest first: the
    /// material of the object there, without colours, and the intensities of the lights. Each takes two
    /// renderings of the pixel, so call this on demand, not in every frame.
    ///
    /// # Errors
    /// Returns an error if the pixel is not in the picture.
    pub fn influences(
        &mut self,
        scene: &Scene,
        registry: &Registry,
        settings: &Settings,
        pixel: [u32; 2],
    ) -> Result<Vec<Influence>, ExplainError> {
        let explanation = self.pixel(scene, registry, settings, pixel)?;
        let Some(seen) = explanation.seen else { return Ok(Vec::new()) };
        let object = seen.object.index;
        // All values use the same samples, so that differences are smooth; these have the relative error of
        // the sum.
        let digits = digits_within(noise(&seen), DIGITS);
        let mut knobs = Vec::new();
        for setting in &seen.model.settings {
            let parameter = setting.parameter;
            let Some(value) = parameter.kind.number_of(&setting.value) else { continue };
            let Some(limits) = parameter.kind.limits() else { continue };
            let knob = Knob::Material { object, parameter };
            let Parameter { symbol, label, unit, .. } = *parameter;
            knobs.push((knob, symbol, label.to_owned(), unit, value, limits));
        }
        for (i, light) in scene.lights.iter().enumerate().filter(|(_, light)| light.enabled) {
            let Some(entry) = registry.light(&light.light_type) else { continue };
            let (value, unit, limits) = match light.luminous_flux {
                Some(flux) => (flux, "lm", limits::luminous_flux(entry.declaration)),
                None => {
                    (light.intensity, entry.unit(&light.parameters), limits::intensity(entry.declaration))
                }
            };
            let name = light.name.clone().unwrap_or_else(|| format!("{} {}", entry.declaration.name, i + 1));
            let label = format!("{name}: intensity");
            let limits = Limits::between(0.0, limits.slider_max);
            knobs.push((Knob::Intensity { light: i }, "I", label, unit, f64::from(value), limits));
        }
        let mut found = Vec::new();
        for (knob, symbol, label, unit, value, limits) in knobs {
            let (min, max) = (limits.min, limits.top());
            // Integers change in whole steps.
            let hundredth =
                if limits.whole { (STEP * (max - min)).round().max(1.0) } else { STEP * (max - min) };
            // A light may be brighter than the maximum of its slider.
            let tried = [(value - hundredth).max(min), (value + hundredth).min(max.max(value))];
            let (mut changed, mut light) = (scene.clone(), [Vec3::ZERO; 2]);
            for (light, tried) in light.iter_mut().zip(tried) {
                knob.set(&mut changed, tried as f32);
                *light = self.pixel(&changed, registry, settings, pixel)?.steps.light;
            }
            found.push(Influence { knob, symbol, label, unit, value, tried, light, hundredth, digits });
        }
        let size = |influence: &Influence| influence.effect().abs();
        found.sort_by(|a, b| size(b).total_cmp(&size(a)));
        Ok(found)
    }
}

/// The relative standard error of a pixel's light, at the noisiest of its points.
fn noise(seen: &Seen) -> f32 {
    let of = |spot: &super::Spot| {
        let squares: f32 =
            spot.lights.iter().filter_map(|lit| Some(luminance(lit.integral?.error).powi(2))).sum();
        let light = luminance(spot.sum);
        if light > 0.0 { squares.sqrt() / light } else { 0.0 }
    };
    seen.spots.iter().map(of).fold(0.0, f32::max)
}

impl Knob {
    fn set(&self, scene: &mut Scene, value: f32) {
        match *self {
            Self::Material { object, parameter } => {
                if let Some(object) = scene.objects.get_mut(object) {
                    object.material.set(parameter.name, parameter.kind.of_numbers([value.into(); 3]));
                }
            }
            Self::Intensity { light } => {
                if let Some(light) = scene.lights.get_mut(light) {
                    match &mut light.luminous_flux {
                        Some(flux) => *flux = value,
                        None => light.intensity = value,
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Light, Object};

    #[test]
    fn the_light_of_a_lambertian_surface_is_proportional_to_its_coefficient_and_the_intensity() {
        let registry = Registry::builtin();
        let settings = Settings { width: 64, height: 36, ..Settings::default() };
        let scene = Scene { reflection_model: "phong".to_owned(), ..Scene::default() };
        let mut explainer = Explainer::default();
        let light = explainer.pixel(&scene, &registry, &settings, [32, 18]).expect("inside").steps.light;
        let found = explainer.influences(&scene, &registry, &settings, [32, 18]).expect("inside");
        let of =
            |symbol: &str| found.iter().find(|i| i.symbol == symbol).unwrap_or_else(|| panic!("{symbol}"));
        // Here the diffuse term gives all of the light except the ambient.
        for (symbol, light) in [("k_d", light - of("k_a").derivative() * 0.1), ("I", light)] {
            let influence = of(symbol);
            let expected = light / influence.value as f32;
            let off = (influence.derivative() - expected).length() / expected.length();
            assert!(off < 1e-3, "{symbol}: {:?}, not {expected:?}", influence.derivative());
        }
        assert!(found.windows(2).all(|two| two[0].effect().abs() >= two[1].effect().abs()));
    }

    #[test]
    fn what_another_pixel_depends_on_is_left_out() {
        let registry = Registry::builtin();
        let settings = Settings { width: 64, height: 36, ..Settings::default() };
        let mut scene = Scene::default();
        scene.lights.push(Light { enabled: false, ..scene.lights[0].clone() });
        scene.objects.push(Object {
            position: glam::Vec3::new(0.5, 0.5, 0.5),
            size: 0.1,
            ..Object::default()
        });
        let found = Explainer::default().influences(&scene, &registry, &settings, [32, 18]).expect("inside");
        assert!(
            found
                .iter()
                .all(|i| !matches!(i.knob, Knob::Intensity { light: 1 } | Knob::Material { object: 1, .. }))
        );
        let none = Explainer::default().influences(&scene, &registry, &settings, [0, 0]).expect("inside");
        assert_eq!(none, []);
    }
}
