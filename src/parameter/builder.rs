//! Builder methods for declarations of parameters: adding a field to [`Parameter`] does not break existing
//! declarations. They begin with that of a [kind](super::kind).

use super::{Meaning, Parameter, ParameterKind};
use crate::declared::setters;

impl Parameter {
    /// A parameter whose symbol and label are its name, without unit and help.
    #[must_use]
    pub const fn new(name: &'static str, kind: ParameterKind) -> Self {
        Self {
            name,
            symbol: name,
            label: name,
            unit: "",
            help: "",
            kind,
            used_when: None,
            stands_for: None,
            costly: false,
        }
    }

    setters! {
        /// Sets the symbol for equations.
        symbol(symbol: &'static str) { symbol }

        /// Sets the display label.
        label(label: &'static str) { label }

        /// Sets the unit.
        unit(unit: &'static str) { unit }

        /// Sets a sentence about the parameter's effect.
        help(help: &'static str) { help }

        /// Sets what the parameter stands for, so that its value goes along to other models.
        stands_for(meaning: &'static Meaning) { stands_for: Some(meaning) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parameter::Value;

    #[test]
    fn a_choice_is_found_by_its_name_in_files() {
        let choice = Parameter::choice("f", &[("g", "G"), ("h", "H")], 1);
        assert_eq!(["g", "h", "G"].map(|id| choice.kind.option(id)), [Some("G"), Some("H"), None]);
        assert_eq!(Parameter::number("a", 0.0..=2.0, 1.5).kind.option("g"), None);
    }

    #[test]
    fn every_type_is_declared_with_its_default() {
        const ALL: [(Parameter, Value); 8] = [
            (Parameter::number("a", 0.0..=2.0, 1.5), Value::Number(1.5)),
            (Parameter::integer("b", 1..=16, 4), Value::Integer(4)),
            (Parameter::integer_from("c", 0, 512, 32), Value::Integer(32)),
            (Parameter::colour("d", [1, 2, 3]), Value::Colour([1, 2, 3])),
            (Parameter::triple("e", 0.0..=6.0, [1.0, 2.0, 3.0]), Value::Triple([1.0, 2.0, 3.0])),
            (
                Parameter::choice("f", &[("g", "G"), ("h", "H")], 1),
                Value::Choice(std::borrow::Cow::Borrowed("h")),
            ),
            (Parameter::flag("i", false), Value::flag(false)),
            (Parameter::flag("j", true), Value::flag(true)),
        ];
        for (p, value) in ALL {
            assert_eq!(p.default_value(), value, "{}", p.name);
            assert!(p.allows(&value), "{}", p.name);
        }
        let all = Parameter::number("a", 0.0..=2.0, 1.5).symbol("α").label("shine").unit("m").help("More.");
        assert_eq!((all.symbol, all.label, all.unit, all.help), ("α", "shine", "m", "More."));
    }
}
