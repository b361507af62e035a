//! The legal values of numbers, for widgets, which check values while they are typed. Those of a field follow from its
//! [declaration](super::Field::limits); here are those that depend on other parts of the scene.

use glam::Vec3;

use crate::{
    light,
    optics::radiometry::SPHERE,
    parameter::ABOVE_ZERO,
    scene::{Light, Object, Part, Scene, SceneSize, check},
    shape,
};

/// The legal values of a number, and the range of its slider.
#[derive(Clone, Debug, PartialEq)]
pub struct Limits {
    /// The smallest legal value.
    pub min: f64,
    /// The largest legal value; infinite if unlimited.
    pub max: f64,
    /// The lower end of the slider.
    pub slider_min: f64,
    /// The upper end of the slider.
    pub slider_max: f64,
    /// True if only whole numbers are legal.
    pub whole: bool,
    /// The reason for the limits, if the numbers alone do not explain it.
    pub because: Option<String>,
}

impl Limits {
    /// All numbers between two limits, inclusive.
    #[must_use]
    pub fn between(min: f64, max: f64) -> Self {
        Self { min, max, slider_min: min, slider_max: max, whole: false, because: None }
    }

    /// Greater than zero and at most `max`.
    #[must_use]
    pub fn above_zero(max: f64) -> Self {
        Self { min: f64::from(ABOVE_ZERO), slider_min: 0.0, ..Self::between(0.0, max) }
    }

    /// The limits with a slider over part of the range.
    #[must_use]
    pub fn slider(mut self, min: f64, max: f64) -> Self {
        (self.slider_min, self.slider_max) = (min, max);
        self
    }

    /// The limits for integers.
    #[must_use]
    pub fn whole(mut self) -> Self {
        self.whole = true;
        self
    }

    /// True if a value is legal.
    #[must_use]
    pub fn allows(&self, value: f64) -> bool {
        // In f32, as in the scene: 0.1 is legal if the limit is the f32 next to it.
        let within = value as f32 >= self.min as f32 && value as f32 <= self.max as f32;
        value.is_finite() && within && (!self.whole || value.fract() == 0.0)
    }

    /// True if all positive numbers up to the maximum are legal, but zero is not.
    #[must_use]
    pub fn is_above_zero(&self) -> bool {
        self.min == f64::from(ABOVE_ZERO)
    }

    /// The rule, as the end of "must be …".
    #[must_use]
    pub fn rule(&self) -> String {
        let what = if self.whole { "a whole number " } else { "" };
        let max = if self.max < 1e6 { number(self.max) } else { format!("{:e}", self.max) };
        let min = number(self.min);
        let range = match (self.is_above_zero(), self.min.is_finite(), self.max.is_finite()) {
            (true, _, true) => format!("{what}greater than 0 and at most {max}"),
            (true, _, false) => format!("{what}greater than 0"),
            (_, true, true) => format!("{what}between {min} and {max}"),
            (_, true, false) if self.whole => format!("a whole number, {min} or more"),
            (_, true, false) => format!("at least {min}"),
            (_, false, true) => format!("{what}of at most {max}"),
            (_, false, false) if self.whole => "a whole number".to_owned(),
            (_, false, false) => "a number".to_owned(),
        };
        let range = if self.whole { range } else { range.replacen("of at", "at", 1) };
        match &self.because {
            Some(because) => format!("{range} ({because})"),
            None => range,
        }
    }
}

/// A number in plain notation: at most four decimals, no trailing zeros, a true minus sign.
#[must_use]
pub fn number(value: f64) -> String {
    if !value.is_finite() {
        return if value.is_nan() {
            "–".to_owned()
        } else if value > 0.0 {
            "∞".to_owned()
        } else {
            "−∞".to_owned()
        };
    }
    let magnitude = value.abs();
    if magnitude != 0.0 && magnitude < 5e-5 {
        return format!("{value:.1e}").replace('-', "−");
    }
    let text = format!("{value:.4}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.replace('-', "−") }
}

/// A coordinate of a position in a room: 0 < coordinate ≤ size. `axis` is 0 for x, 1 for y, 2 for z.
#[must_use]
pub fn position(size: SceneSize, axis: usize) -> Limits {
    let name = ["wide", "high", "deep"][axis.min(2)];
    let extent = f64::from(size.corner().to_array()[axis.min(2)]);
    let because = format!("the room is {} m {name}", number(extent));
    Limits { because: Some(because), ..Limits::above_zero(extent) }
}

/// The size of an object, metres, with a slider for the room.
#[must_use]
pub fn object_size(size: SceneSize) -> Limits {
    Object::size.limits().slider(0.0, f64::from(size.corner().max_element()))
}

/// The tessellation of an object.
#[must_use]
pub fn tessellation(shape: &shape::Declaration) -> Limits {
    let range = &shape.tessellation;
    Limits::between(f64::from(*range.start()), f64::from(*range.end())).whole()
}

/// The intensity of a light.
#[must_use]
pub fn intensity(light: &light::Declaration) -> Limits {
    Light::intensity.limits().slider(0.0, f64::from(light.slider_max))
}

/// The luminous flux of a light, lumen. The end of the slider corresponds to that of the intensity, for a
/// light that shines in every direction.
#[must_use]
pub fn luminous_flux(light: &light::Declaration) -> Limits {
    let end = f64::from(light.slider_max) * SPHERE;
    Light::luminous_flux.limits().slider(0.0, significant(end, 1))
}

/// A number rounded to this number of significant digits.
#[must_use]
pub fn significant(value: f64, digits: usize) -> f64 {
    // In decimal, so that the result is the number nearest to what people read.
    format!("{value:.0$e}", digits.saturating_sub(1)).parse().unwrap_or(value)
}

/// An extent of the room, in metres: everything in the room must stay inside. `axis` is 0 for width, 1 for height, 2 for
/// depth; `name` returns the name of a part.
#[must_use]
pub fn extent(scene: &Scene, axis: usize, name: impl Fn(Part) -> String) -> Limits {
    let at = |p: Vec3| p.to_array()[axis.min(2)];
    let furthest = check::places(&scene.lights, &scene.objects, scene)
        .map(|(who, p)| (who, at(p)))
        .filter(|(_, c)| c.is_finite())
        .max_by(|a, b| a.1.total_cmp(&b.1));
    let any = SceneSize::width.limits();
    match furthest {
        Some((who, c)) if c > 0.0 && any.allows(f64::from(c)) => Limits {
            because: Some(format!(
                "{} is at {} = {} m",
                name(who),
                ["x", "y", "z"][axis.min(2)],
                number(f64::from(c))
            )),
            ..Limits::between(f64::from(c), any.max).slider(0.0, any.max)
        },
        _ => any,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_as_people_write_them() {
        assert_eq!(number(0.8), "0.8");
        assert_eq!(number(f64::from(0.1f32)), "0.1");
        assert_eq!(number(-2.0), "−2");
        assert_eq!(number(-0.0), "0");
        assert_eq!(number(1e-7), "1.0e−7");
    }

    #[test]
    fn numbers_are_rounded_to_significant_digits() {
        assert_eq!(significant(251.327, 3), 251.0);
        assert_eq!(significant(2513.27, 1), 3000.0);
        assert_eq!(significant(0.076_349, 2), 0.076);
        assert_eq!(significant(-1.6e-7, 1), -2e-7);
        assert_eq!(significant(0.0, 3), 0.0);
    }

    #[test]
    fn rules_are_sentences() {
        assert_eq!(Limits::between(0.5, 1.0).rule(), "between 0.5 and 1");
        assert_eq!(Object::size.limits().rule(), "greater than 0 and at most 1e9");
        assert_eq!(Limits::above_zero(90.0).rule(), "greater than 0 and at most 90");
        assert_eq!(Limits::between(0.0, f64::INFINITY).whole().rule(), "a whole number, 0 or more");
        assert_eq!(Limits::between(0.0, f64::INFINITY).rule(), "at least 0");
    }

    #[test]
    fn limits_exclude_what_they_say() {
        assert!(!Limits::above_zero(1.0).allows(0.0));
        assert!(!Limits::between(0.0, 9.0).whole().allows(1.5));
        assert!(!Light::direction.limits().allows(f64::NAN));
    }
}
