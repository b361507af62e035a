//! The noise of light with extent on its way to the code: standard errors, and the digits that they allow.

use glam::Vec3;

use super::{
    Corner, Explanation, Lit, Place, Seen, Spot,
    numbers::{DIGITS, measured, rounded, rounded_triple, with_error},
};
use crate::reference::{DisplaySteps, Picture};

impl Lit {
    /// The standard error of the light to the observer; `None` if the light has no extent.
    #[must_use]
    pub fn error(&self) -> Option<Vec3> {
        self.integral.map(|integral| integral.error)
    }
}

impl Spot {
    /// The standard error of the sum over the lights; `None` without light with extent.
    #[must_use]
    pub fn error(&self) -> Option<Vec3> {
        root_of_squares(self.lights.iter().filter_map(Lit::error))
    }
}

impl Seen {
    /// The standard error of the light of the pixel; `None` without light with extent.
    #[must_use]
    pub fn error(&self) -> Option<Vec3> {
        root_of_squares(self.spots.iter().filter_map(|spot| Some(spot.error()? * spot.place.weight())))
    }

    /// The standard error of a corner's colour; `None` if the equation was evaluated elsewhere.
    #[must_use]
    pub fn error_at(&self, corner: &Corner) -> Option<Vec3> {
        let is = |spot: &&Spot| matches!(spot.place, Place::Vertex { vertex, .. } if vertex == corner.vertex);
        self.spots.iter().find(is)?.error()
    }
}

impl Explanation {
    /// The steps to the codes of light one standard error brighter and one standard error darker; none where no light has
    /// extent.
    #[must_use]
    pub fn brighter_and_darker(&self) -> Option<[DisplaySteps; 2]> {
        let error = self.seen.as_ref()?.error()?;
        Some([error, -error].map(|error| {
            let light = (self.steps.light + error).max(self.steps.light.min(Vec3::ZERO));
            Picture::display_steps(
                light.extend(self.steps.coverage),
                &self.display,
                self.pixel[1],
                self.size[1],
            )
        }))
    }

    /// The standard error of a step on the way to the code: the larger change towards brighter or darker light, as one of
    /// them is clipped near white; none where no light has extent.
    #[must_use]
    pub fn error_of(&self, step: impl Fn(&DisplaySteps) -> Vec3) -> Option<Vec3> {
        let change = |to: &DisplaySteps| (step(to) - step(&self.steps)).abs();
        self.brighter_and_darker().map(|[brighter, darker]| change(&brighter).max(change(&darker)))
    }
}

/// The error of a sum of independent values.
fn root_of_squares(errors: impl Iterator<Item = Vec3>) -> Option<Vec3> {
    let squares = errors.map(|error| error * error).reduce(|sum, squares| sum + squares);
    squares.map(|squares| squares.map(f32::sqrt))
}

/// A number with the digits that its standard error allows, but at most this many.
#[must_use]
pub fn within(v: f32, error: Option<f32>, digits: usize) -> String {
    let usual = rounded(v, digits);
    let Some(error) = error.filter(|error| *error > 0.0) else { return usual };
    let [measured, _] = with_error(v, error);
    // Both are roundings of one number: the one with fewer digits is not longer.
    if measured.chars().count() <= usual.chars().count() { measured } else { usual }
}

/// Red, green and blue with the digits that their standard errors allow, but at most this many.
#[must_use]
pub fn triple_within(v: Vec3, error: Option<Vec3>, digits: usize) -> String {
    let [r, g, b] = [0, 1, 2].map(|i| within(v[i], error.map(|error| error[i]), digits));
    format!("({r}, {g}, {b})")
}

/// Red, green and blue with this many digits, or with their standard errors and the digits that these allow.
#[must_use]
pub fn told(v: Vec3, error: Option<Vec3>, digits: usize) -> String {
    error.map_or_else(|| rounded_triple(v, digits), |error| measured(v, error))
}

/// Red, green and blue with four digits, as in explanations.
pub(super) fn estimated(v: Vec3, error: Option<Vec3>) -> String {
    triple_within(v, error, DIGITS)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        explain::Explainer,
        reference::{LightSamples, Settings},
        registry::Registry,
        scene::{Light, Scene},
    };

    #[test]
    fn numbers_have_no_digit_that_noise_made() {
        for (v, error, expected) in [
            (0.225_34, Some(0.03), "0.225"),
            (0.225_34, Some(0.3), "0.23"),
            (0.225_34, Some(0.000_01), "0.2253"),
            (0.225_34, Some(0.0), "0.2253"),
            (0.225_34, None, "0.2253"),
            (0.5, Some(0.2), "0.5"),
            (12_345.0, Some(3000.0), "12300"),
            (f32::NAN, Some(f32::NAN), "NaN"),
        ] {
            assert_eq!(within(v, error, DIGITS), expected, "{v} {error:?}");
        }
        let v = Vec3::new(0.225_34, 0.5, 1.0 / 3.0);
        assert_eq!(triple_within(v, Some(Vec3::new(0.03, 0.0, 0.4)), DIGITS), "(0.225, 0.5, 0.33)");
    }

    /// The explanation of a pixel of the default scene under another light.
    fn explained(light: &str, shading: &str) -> Explanation {
        explained_by(LightSamples::DEFAULT, light, shading)
    }

    /// The same with this number of samples.
    fn explained_by(samples: u32, light: &str, shading: &str) -> Explanation {
        let mut scene = Scene { shading_model: shading.to_owned(), ..Scene::default() };
        scene.display.exposure = -1.0;
        let at = scene.objects[0].position;
        let lamp = |side: Vec3| Light {
            light_type: light.to_owned(),
            position: Some(at + side),
            direction: Some(-side),
            intensity: 8.0,
            ..scene.lights[0].clone()
        };
        scene.lights = vec![lamp(Vec3::new(1.0, 1.5, 2.0)), lamp(Vec3::new(-1.0, 0.5, 2.0))];
        let settings = Settings { width: 64, height: 36, samples: 1, ..Settings::default() };
        let mut explainer = Explainer::default();
        explainer.set_light_samples(samples);
        explainer.pixel(&scene, &Registry::builtin(), &settings, [34, 16]).expect("inside")
    }

    /// The maximum number of decimals in the last line that begins with `begins`.
    fn digits(text: &str, begins: &str) -> usize {
        let line = text.lines().map(str::trim).rfind(|line| line.starts_with(begins)).expect(begins);
        let value =
            line.split(" ± ").next().and_then(|line| line.rsplit([':', '=']).next()).expect("a value");
        let numbers =
            value.split(|c: char| !c.is_ascii_digit() && c != '.').filter_map(|n| n.split_once('.'));
        numbers.map(|(_, behind)| behind.len()).max().unwrap_or(0)
    }

    #[test]
    fn errors_go_from_the_lights_to_the_code() {
        let explanation = explained("rectangle", "phong");
        let spot = &explanation.seen.as_ref().expect("the sphere").spots[0];
        let errors: Vec<_> =
            spot.lights.iter().map(|lit| lit.integral.expect("it has extent").error).collect();
        let sum = spot.error().expect("both have noise");
        assert!((sum * sum - errors[0] * errors[0] - errors[1] * errors[1]).abs().max_element() < 1e-9);
        assert!(sum.cmpge(errors[0]).all() && sum.cmpgt(Vec3::ZERO).all());
        let of_light = explanation.error_of(|steps| steps.light).expect("noise");
        assert!((of_light - sum).abs().max_element() < 1e-6, "{of_light} {sum}");
        let exposed = explanation.error_of(|steps| steps.exposed).expect("noise");
        assert!((exposed - 0.5 * sum).abs().max_element() < 1e-6, "half at −1 EV");
        // For vertices, weighted.
        let explanation = explained("rectangle", "gouraud");
        let seen = explanation.seen.as_ref().expect("the sphere");
        let squares: Vec3 = seen
            .corners
            .iter()
            .map(|corner| seen.error_at(corner).expect("noise") * corner.weight)
            .map(|error| error * error)
            .sum();
        let error = seen.error().expect("noise");
        assert!((error * error - squares).abs().max_element() < 1e-9);
        assert_eq!(explained("point", "phong").brighter_and_darker(), None);
    }

    #[test]
    fn more_samples_have_less_noise_in_all_shading_models() {
        for shading in ["flat", "gouraud", "phong"] {
            let [few, usual, many] =
                [64, LightSamples::DEFAULT, 4096].map(|samples| explained_by(samples, "rectangle", shading));
            let error = |e: &Explanation| e.seen.as_ref().and_then(Seen::error).expect("noise").max_element();
            assert!(error(&few) > error(&usual) && error(&usual) > 2.0 * error(&many), "{shading}");
            let near = (few.steps.light - many.steps.light).abs().max_element();
            assert!(near < 5.0 * error(&few), "{shading}: {near} and {}", error(&few));
            assert!(
                many.to_text().contains("by 4096 samples of the light and 4096 of the lobes"),
                "{shading}"
            );
            assert_eq!(usual.to_text(), explained("rectangle", shading).to_text());
        }
    }

    #[test]
    fn a_known_solid_angle_has_no_error() {
        let filled = |light: &str| {
            let text = explained(light, "phong").to_text();
            text.lines().find(|line| line.contains("it fills")).map(str::to_owned).expect(light)
        };
        assert!(filled("environment").ends_with("it fills 12.57 sr."), "{}", filled("environment"));
        assert!(!filled("rectangle").contains('±') && filled("cylinder").contains('±'));
    }

    #[test]
    fn near_white_darker_light_tells_the_error() {
        let mut explanation = explained("rectangle", "phong");
        let encoded = |steps: &DisplaySteps| steps.encoded;
        let light = explanation.steps.light;
        // The exposure at which red is just white.
        explanation.display.exposure = -light.x.log2();
        explanation.steps = Picture::display_steps(light.extend(1.0), &explanation.display, 0, 1);
        let [brighter, _] = explanation.brighter_and_darker().expect("noise");
        assert!((brighter.encoded.x - explanation.steps.encoded.x).abs() < 1e-4, "clipped");
        let error = explanation.error_of(encoded).expect("noise");
        assert!(error.x > 1e-4, "{error}");
    }

    #[test]
    fn no_line_from_the_sum_to_the_code_has_a_digit_that_noise_made() {
        let sphere = explained("rectangle", "phong");
        // Two digits of the error.
        let most = |step: fn(&DisplaySteps) -> Vec3| {
            let error = sphere.error_of(step).expect("noise").min_element();
            (1.0 - error.log10().floor()) as usize
        };
        let text = sphere.to_text();
        let light: fn(&DisplaySteps) -> Vec3 = |steps| steps.light;
        let encoded: fn(&DisplaySteps) -> Vec3 = |steps| steps.encoded;
        for (begins, step) in [
            ("sum over 2 lights", light),
            ("light ", light),
            ("exposure", |steps| steps.exposed),
            ("tone mapping", |steps| steps.mapped),
            ("sRGB encoding", encoded),
            ("red:", encoded),
        ] {
            assert!(digits(&text, begins) <= most(step), "{begins}: {}\n{text}", most(step));
        }
        assert!(text.contains("The standard error of the light is that of ("), "{text}");
        // Without noise, all four digits are written.
        let exact = explained("point", "phong").to_text();
        assert!(digits(&exact, "sum over 2 lights") == 3 && digits(&exact, "light ") == 3, "{exact}");
        assert!(!exact.contains("standard error"), "{exact}");
    }
}
