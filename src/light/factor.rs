//! The factors of the light at a point, for explanations.

use glam::Vec3;

use super::{Incident, LightRecord};

/// A factor of the intensity `I(p)` of a light, as in its [equation](super::Declaration::equation).
#[derive(Clone, Debug, PartialEq)]
pub struct Factor {
    /// Notation in the equation, such as `1/d^2`.
    pub symbol: &'static str,
    /// Meaning in words.
    pub meaning: &'static str,
    /// Unit; empty if there is none.
    pub unit: &'static str,
    /// Red, green and blue; equal for a plain number.
    pub value: Vec3,
    /// The numbers from which it is calculated: symbol, value, unit.
    pub from: Vec<(&'static str, f32, &'static str)>,
    /// The calculation from these numbers, in the notation of [`expression`](crate::text::expression): the
    /// right side of its definition, then definitions of the symbols in it, separated by commas: `x^2, x =
    /// cos θ`. Empty for a factor that is given or read from a table.
    pub equation: &'static str,
}

impl Factor {
    /// A plain number with its notation and its meaning.
    #[must_use]
    pub fn new(symbol: &'static str, meaning: &'static str, value: f32) -> Self {
        Self { symbol, meaning, unit: "", value: Vec3::splat(value), from: Vec::new(), equation: "" }
    }

    /// Sets the unit.
    #[must_use]
    pub fn unit(self, unit: &'static str) -> Self {
        Self { unit, ..self }
    }

    /// Adds a number from which the factor is calculated: symbol, value, unit.
    #[must_use]
    pub fn given(mut self, symbol: &'static str, value: f32, unit: &'static str) -> Self {
        self.from.push((symbol, value, unit));
        self
    }

    /// Sets the calculation from the given numbers.
    #[must_use]
    pub fn equation(self, equation: &'static str) -> Self {
        Self { equation, ..self }
    }

    /// The given numbers as text: "d = 4.82 m".
    #[must_use]
    pub fn givens(&self, number: impl Fn(f32) -> String) -> String {
        let given = |(symbol, value, unit): &(&str, f32, &str)| {
            let space = if unit.is_empty() || *unit == "°" { "" } else { " " };
            format!("{symbol} = {}{space}{unit}", number(*value))
        };
        self.from.iter().map(given).collect::<Vec<_>>().join(", ")
    }

    /// The intensity `I` of a light, in the unit of the light type.
    #[must_use]
    pub fn intensity(light: &LightRecord, unit: &'static str) -> Self {
        Self::new("I", "the intensity of the light", light.intensity).unit(unit)
    }

    /// The inverse square of the distance, with a value from
    /// [`inverse_square`](crate::optics::radiometry::inverse_square).
    #[must_use]
    pub fn inverse_square(value: f32, distance: f32) -> Self {
        Self::new("1/d^2", "the falloff with the square of the distance", value)
            .unit("1/m²")
            .given("d", distance, "m")
            .equation("1/d^2")
    }
}

/// The factors of a type that does not list any: the intensity, and the rest of `incident`.
pub(super) fn whole(incident: Incident, light: &LightRecord, unit: &'static str) -> Vec<Factor> {
    let (Incident::From { intensity, .. } | Incident::Uniform { intensity }) = incident;
    let mut factors = vec![Factor::intensity(light, unit)];
    let rest = intensity / light.intensity;
    if light.intensity != 0.0 && rest != Vec3::ONE {
        factors
            .push(Factor { value: rest, ..Factor::new("I(p)/I", "the share that reaches the point", 1.0) });
    }
    factors
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_type_that_says_nothing_has_the_intensity_and_the_rest() {
        let light = LightRecord { intensity: 4.0, ..LightRecord::default() };
        let from = |intensity: Vec3| Incident::From { l: Vec3::Y, intensity };
        let factors = whole(from(Vec3::new(2.0, 1.0, 0.0)), &light, "lx");
        assert_eq!(factors.len(), 2);
        assert_eq!((factors[0].value, factors[0].unit), (Vec3::splat(4.0), "lx"));
        assert_eq!(factors[1].value, Vec3::new(0.5, 0.25, 0.0));
        // Nothing to separate, or division by zero.
        assert_eq!(whole(from(Vec3::splat(4.0)), &light, "lx").len(), 1);
        assert_eq!(whole(from(Vec3::ZERO), &LightRecord::default(), "lx").len(), 1);
    }
}
