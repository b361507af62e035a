//! A value from text, as typed on the command line, and the rule that a value breaks.

use super::{Parameter, kind::Value};
use crate::text::{behind, shortened};

/// The reason why a text is not a legal value of a parameter. Displayed as the end of a sentence: "is 0.2,
/// but the diffuse coefficient must be between 0.5 and 1".
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("is {}, but {rule}", if .found.trim().is_empty() { "empty".to_owned() } else { shortened(.found) })]
#[non_exhaustive]
pub struct ParseError {
    /// The text.
    pub found: String,
    /// The broken rule: "the diffuse coefficient must be between 0.5 and 1".
    pub rule: String,
}

impl Parameter {
    /// The value written as text: a number, three numbers such as `255,128,0` or `255 128 0`, the name of a choice, or
    /// the name of a file in the current folder. One number serves for all three of a [triple](super::kind::triple).
    ///
    /// ```
    /// use lights_camera_models::parameter::{ALPHA, BASE_COLOUR, K_D, Value};
    ///
    /// assert_eq!(BASE_COLOUR.parse("255, 128, 0"), Ok(Value::Colour([255, 128, 0])));
    /// assert_eq!(ALPHA.parse("8"), Ok(Value::Integer(8)));
    /// let error = K_D.parse("0.2").unwrap_err();
    /// assert_eq!(error.to_string(), "is 0.2, but the diffuse coefficient must be between 0.5 and 1");
    /// ```
    ///
    /// # Errors
    /// Returns a [`ParseError`] if the text is not a value of the parameter's kind, or the value is out of range.
    pub fn parse(&self, text: &str) -> Result<Value, ParseError> {
        let broken =
            |rule: String| ParseError { found: text.to_owned(), rule: behind(self.name, &rule).into_owned() };
        let value = self.kind.parse(text).ok_or_else(|| broken(self.clause() + &self.kind.excess(text)))?;
        self.check(&value).map(|()| value).map_err(broken)
    }

    /// Checks that the value is legal. The error is the rule that it breaks, with a hint: "the Fresnel term
    /// must be one of …; did you mean …?"
    ///
    /// # Errors
    /// Returns the broken rule as a clause.
    pub fn check(&self, value: &Value) -> Result<(), String> {
        if self.allows(value) {
            return Ok(());
        }
        let hint = if self.kind.owns(value) { self.kind.hint(value) } else { String::new() };
        Err(self.clause() + &hint)
    }

    /// The parameter's [rule](Self::rule) as a clause with its name and unit: "the slope deviation must be
    /// between 0 and 35 degrees"; for a flag, with the name used in files: "two_sided must be true or false".
    #[must_use]
    pub fn clause(&self) -> String {
        // The label need not be a noun: "two-sided".
        if self.kind.is_flag() {
            return format!("{} must be {}", self.name, self.rule());
        }
        let unit = match self.suffix() {
            sign if sign == "°" => " degrees".to_owned(),
            unit => unit,
        };
        format!("the {} must be {}{unit}", self.label, self.rule())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        parameter::{BASE_COLOUR, IOR, K_D},
        registry::Registry,
    };

    #[test]
    fn every_legal_value_is_read_from_its_own_text() {
        let registry = Registry::builtin();
        let lights = registry.lights().iter().flat_map(|l| l.parameters);
        let shapes = registry.shapes().iter().flat_map(|s| s.parameters);
        let mut values = 0;
        for p in registry.material_parameters().chain(lights).chain(shapes) {
            for value in p.ends() {
                assert_eq!(p.parse(&value.to_string()), Ok(value), "{}", p.name);
                values += 1;
            }
        }
        assert!(values > 100);
        assert_eq!(IOR.parse("1.5"), Ok(Value::Triple([1.5; 3])), "one number for all");
        assert_eq!(BASE_COLOUR.parse("[1 2 3]"), Ok(Value::Colour([1, 2, 3])));
    }

    #[test]
    fn far_ends_of_ranges_are_short_and_numbers_beyond_32_bits_break_them() {
        for (range, rule) in [
            (0.0..=1e7, "between 0 and 10000000"),
            (-1e20..=1e20, "between -1e20 and 1e20"),
            (f32::MIN..=f32::MAX, "between -3.4e38 and 3.4e38"),
        ] {
            let p = Parameter::number("a", range, 0.0);
            assert_eq!(p.rule(), rule);
            for text in ["1e39", "-1e300"] {
                let said = p.parse(text).expect_err("refused").to_string();
                assert!(said.contains(&format!("is {text}, but")) && said.contains(rule), "{said}");
            }
        }
    }

    #[test]
    fn other_text_is_refused_with_the_rule() {
        for (p, text, rule) in [
            (K_D, "0.2", "is 0.2, but the diffuse coefficient must be between 0.5 and 1"),
            (K_D, "nan", "is nan, but the diffuse coefficient must be between 0.5 and 1"),
            (K_D, " ", "is empty, but the diffuse coefficient must be"),
            (BASE_COLOUR, "1,2", "three whole numbers from 0 to 255"),
            (BASE_COLOUR, "1,2,256", "three whole numbers from 0 to 255"),
            (BASE_COLOUR, "1,,2,3", "three whole numbers from 0 to 255"),
            (IOR, "1 2", "must be three numbers between 0.01 and 6"),
        ] {
            let said = p.parse(text).expect_err("refused").to_string();
            assert!(said.contains(rule), "{text}: {said}");
        }
        let registry = Registry::builtin();
        let fresnel = registry.material_parameter("fresnel").expect("declared");
        let said = fresnel.parse("conducter").expect_err("refused").to_string();
        assert!(said.contains("did you mean \"conductor\"?"), "{said}");
    }

    #[test]
    fn a_flag_is_true_or_false() {
        const FLAG: Parameter = Parameter::flag("two_sided", true).label("two-sided");
        for on in [true, false] {
            assert_eq!(FLAG.parse(&format!(" {on} ")), Ok(Value::flag(on)));
            assert_eq!(Value::flag(on).truth(), Some(on));
        }
        for (text, rule) in [
            ("yes", "is yes, but two_sided must be true or false"),
            ("True", "is True, but two_sided must be true or false"),
            ("1", "is 1, but two_sided must be true or false"),
            ("", "is empty, but two_sided must be true or false"),
        ] {
            assert_eq!(FLAG.parse(text).expect_err("refused").to_string(), rule);
        }
        let other = Parameter::choice("two_sided", &[("no", "No"), ("yes", "Yes")], 0);
        assert!(!other.kind.is_flag());
        assert_eq!(FLAG.clash(&other), Some(("a flag".to_owned(), "a choice".to_owned())));
    }
    #[test]
    fn choices_that_are_numbers_are_said_as_a_range_and_near_digits_are_no_hint() {
        const TYPES: &[(&str, &str)] = &[("9", "9 hazy"), ("10", "10 uniform"), ("11", "11 clear")];
        let parameter = Parameter::choice("sky_type", TYPES, 0).label("type of sky");
        let why = |text: &str| parameter.parse(text).map_err(|e| e.to_string()).expect_err("not a type");
        for text in ["16", "1", "10.5"] {
            let expected = format!("is {text}, but the type of sky must be one of \"9\" to \"11\"");
            assert_eq!(why(text), expected);
        }
        assert!(why("11 cleer").ends_with("; did you mean \"11\"?"), "{}", why("11 cleer"));
        // Numbers with a gap are named.
        let gap = Parameter::choice("speed", &[("1", "slow"), ("2", "medium"), ("4", "fast")], 0);
        assert!(gap.rule().starts_with("one of \"1\", \"2\", \"4\""));
    }
}
