//! Light types in words, for comments of exports and for the window.

use super::Declaration;

impl Declaration {
    /// The name with its noun: "Disc light", "Point light", "Photometric lamp".
    #[must_use]
    pub fn title(&self) -> String {
        let has_noun = ["light", "lamp"].iter().any(|noun| self.name.ends_with(noun));
        if has_noun { self.name.to_owned() } else { format!("{} light", self.name) }
    }

    /// The letter of the intensity in the equation: L if it is a luminance.
    #[must_use]
    pub fn symbol(&self) -> &'static str {
        if self.unit == "cd/m²" { "L" } else { "I" }
    }

    /// The equation, and what the letter of the intensity is: "I(p) = I / d^2, I in cd".
    #[must_use]
    pub fn equation_with_unit(&self) -> String {
        let (equation, symbol) = (self.equation, self.symbol());
        match self.unit {
            "×" => format!("{equation}, {symbol} is a factor"),
            unit => format!("{equation}, {symbol} in {unit}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::{registry::Registry, text::capitalised};

    #[test]
    fn the_intensity_has_the_letter_of_the_equation() {
        let registry = Registry::builtin();
        let said = |id: &str| {
            let d = registry.light(id).expect("built in").declaration;
            format!("{}: {}", d.title(), d.equation_with_unit())
        };
        assert_eq!(said("disc"), "Disc light: L(p, l) = L, L in cd/m²");
        assert_eq!(said("point"), "Point light: I(p) = I / d^2, I in cd");
        assert_eq!(said("environment"), "Environment light: L(p, l) = I L_s(l), I is a factor");
        assert!(said("photometric").starts_with("Photometric lamp: "), "{}", said("photometric"));
        // Shapes have these names too.
        for id in ["rectangle", "disc", "sphere", "cylinder"] {
            let d = registry.light(id).expect("built in").declaration;
            assert_eq!(d.name, format!("{} light", capitalised(id)));
        }
        for light in registry.lights() {
            let d = light.declaration;
            let (_, right) = d.equation.split_once('=').unwrap_or(("", d.equation));
            assert!(right.contains(d.symbol()), "{}: {}", d.id, d.equation);
            assert!(!d.title().contains("light light") && !d.equation_with_unit().contains("in ×"));
        }
    }
}
