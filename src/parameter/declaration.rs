//! The declaration of one parameter.

use std::borrow::Cow;

use super::{
    file::{FileFormat, NamedFile},
    value::Value,
};
use crate::text::with_article;

/// The declaration of one parameter.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Parameter {
    /// The name in scene files and on the command line.
    pub name: &'static str,
    /// The symbol in the equation, e.g. `k_d` or `α`.
    pub symbol: &'static str,
    /// The word beside the symbol, e.g. "diffuse coefficient".
    pub label: &'static str,
    /// The unit, empty for dimensionless numbers.
    pub unit: &'static str,
    /// One sentence about the effect, for tooltips and manuals.
    pub help: &'static str,
    /// Type, range and default.
    pub kind: ParameterKind,
    /// The condition under which the parameter is used; `None` if always. See [`Parameter::used_when`].
    pub used_when: Option<UsedWhen>,
}

/// A condition for the use of a parameter: another parameter of the model has one of these choices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct UsedWhen {
    /// The name of the other parameter.
    pub parameter: &'static str,
    /// The names of the required choices.
    pub choices: &'static [&'static str],
}

/// The smallest legal value of a number that must be greater than zero.
pub const ABOVE_ZERO: f32 = f32::MIN_POSITIVE;

/// Type, range and default of a parameter.
#[derive(Clone, Debug, PartialEq)]
pub enum ParameterKind {
    /// A real number in a closed range.
    Number {
        /// Smallest legal value.
        min: f32,
        /// Largest legal value.
        max: f32,
        /// The value if the scene gives none.
        default: f32,
    },
    /// A whole number with a lower bound and perhaps an upper one.
    Integer {
        /// Smallest legal value.
        min: i64,
        /// Largest legal value, if there is one.
        max: Option<i64>,
        /// The end of a slider if there is no largest value.
        slider_max: i64,
        /// The value if the scene gives none.
        default: i64,
    },
    /// Three sRGB-encoded integers, 0–255.
    Colour {
        /// The value if the scene gives none.
        default: [u8; 3],
    },
    /// Three real numbers in a closed range, for red, green and blue. Files may give one number for all three.
    Triple {
        /// Smallest legal value.
        min: f32,
        /// Largest legal value.
        max: f32,
        /// The value if the scene gives none.
        default: [f32; 3],
    },
    /// One of several named choices. A [flag](Self::flag) is a choice between `false` and `true`.
    Choice {
        /// The choices: name in files, name in the window.
        options: &'static [(&'static str, &'static str)],
        /// Index of the default.
        default: usize,
    },
    /// A file of numbers, given by its name relative to the folder of the scene file. Light types and object
    /// types may have such parameters.
    File {
        /// The files that are legal.
        format: &'static FileFormat,
        /// The name of the shipped file that is the value if the scene gives none.
        default: &'static str,
    },
}

impl ParameterKind {
    /// Yes or no: a JSON boolean in scene files, a checkbox in the window.
    #[must_use]
    pub const fn flag(default: bool) -> Self {
        Self::Choice { options: &[("false", "no"), ("true", "yes")], default: default as usize }
    }

    /// True if the choices are those of a [flag](Self::flag).
    #[must_use]
    pub fn is_flag(&self) -> bool {
        // The names in the window may differ.
        matches!(self, Self::Choice { options: [("false", _), ("true", _)], .. })
    }

    /// Name of the kind in messages and in the declarations of custom models.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Number { .. } => "number",
            Self::Integer { .. } => "integer",
            Self::Colour { .. } => "colour",
            Self::Triple { .. } => "triple",
            Self::Choice { .. } if self.is_flag() => "flag",
            Self::Choice { .. } => "choice",
            Self::File { .. } => "file",
        }
    }
}

impl Parameter {
    /// True for a [flag](ParameterKind::flag).
    #[must_use]
    pub fn is_flag(&self) -> bool {
        self.kind.is_flag()
    }

    /// The difference in type or unit that prevents two declarations from being the same parameter of
    /// materials, described for this declaration and for the other. Ranges and defaults may differ.
    #[must_use]
    pub fn clash(&self, other: &Self) -> Option<(String, String)> {
        if self.kind.name() != other.kind.name() {
            return Some((with_article(self.kind.name()), with_article(other.kind.name())));
        }
        let unit =
            |p: &Self| if p.unit.is_empty() { "without a unit".to_owned() } else { format!("in {}", p.unit) };
        (self.unit != other.unit).then(|| (unit(self), unit(other)))
    }

    /// The parameter, used only if another parameter of the model has one of these choices and is itself
    /// used. Otherwise its control is disabled and gives the reason.
    #[must_use]
    pub const fn used_when(self, parameter: &'static str, choices: &'static [&'static str]) -> Self {
        Self { used_when: Some(UsedWhen { parameter, choices }), ..self }
    }

    /// The value if the scene gives none.
    #[must_use]
    pub fn default_value(&self) -> Value {
        match self.kind {
            ParameterKind::Number { default, .. } => Value::Number(default),
            ParameterKind::Integer { default, .. } => Value::Integer(default),
            ParameterKind::Colour { default } => Value::Colour(default),
            ParameterKind::Triple { default, .. } => Value::Triple(default),
            ParameterKind::Choice { options, default } => Value::Choice(Cow::Borrowed(options[default].0)),
            ParameterKind::File { format, default } => Value::File(NamedFile::shipped(default, format)),
        }
    }

    /// The default and the ends of the range, each once; for a choice, all options. Useful in tests of code
    /// that uses the parameter.
    #[must_use]
    pub fn ends(&self) -> Vec<Value> {
        let mut ends = vec![self.default_value()];
        let others = match &self.kind {
            ParameterKind::Number { min, max, .. } => vec![Value::Number(*min), Value::Number(*max)],
            ParameterKind::Integer { min, max, slider_max, .. } => {
                vec![Value::Integer(*min), Value::Integer(max.unwrap_or(*slider_max))]
            }
            ParameterKind::Colour { .. } => vec![Value::Colour([0; 3]), Value::Colour([255; 3])],
            ParameterKind::Triple { min, max, .. } => {
                vec![Value::Triple([*min; 3]), Value::Triple([*max; 3])]
            }
            ParameterKind::Choice { options, .. } => {
                options.iter().map(|(id, _)| Value::Choice(Cow::Borrowed(id))).collect()
            }
            ParameterKind::File { .. } => Vec::new(),
        };
        ends.extend(others.into_iter().filter(|end| *end != self.default_value()));
        ends
    }

    /// The legal values, as the end of a sentence: "must be between 0.5 and 1".
    #[must_use]
    pub fn rule(&self) -> String {
        match &self.kind {
            ParameterKind::Number { min, max, .. } if *min == ABOVE_ZERO => {
                format!("greater than 0 and at most {max}")
            }
            ParameterKind::Number { min, max, .. } => format!("between {min} and {max}"),
            ParameterKind::Integer { min, max: Some(max), .. } => {
                format!("a whole number between {min} and {max}")
            }
            ParameterKind::Integer { min, max: None, .. } => format!("a whole number, {min} or more"),
            ParameterKind::Colour { .. } => {
                "three whole numbers from 0 to 255: [red, green, blue]".to_owned()
            }
            ParameterKind::Triple { min, max, .. } => {
                format!("three numbers between {min} and {max}, [red, green, blue], or one for all")
            }
            ParameterKind::Choice { .. } if self.is_flag() => "true or false".to_owned(),
            ParameterKind::Choice { options, .. } => {
                let names: Vec<_> = options.iter().map(|(id, _)| format!("\"{id}\"")).collect();
                format!("one of {}", names.join(", "))
            }
            ParameterKind::File { format, .. } => format!("the name of {}", format.name),
        }
    }

    /// True if a value has the right type and lies in the range.
    #[must_use]
    pub fn allows(&self, value: &Value) -> bool {
        match (&self.kind, value) {
            (ParameterKind::Number { min, max, .. }, Value::Number(v)) => {
                v.is_finite() && (min..=max).contains(&v)
            }
            (ParameterKind::Integer { min, max, .. }, Value::Integer(v)) => {
                v >= min && max.is_none_or(|m| *v <= m)
            }
            (ParameterKind::Colour { .. }, Value::Colour(_)) => true,
            (ParameterKind::Triple { min, max, .. }, Value::Triple(v)) => {
                v.iter().all(|c| c.is_finite() && (min..=max).contains(&c))
            }
            (ParameterKind::Choice { options, .. }, Value::Choice(v)) => {
                options.iter().any(|(id, _)| *id == v.as_ref())
            }
            (ParameterKind::File { format, .. }, Value::File(file)) => {
                file.is_in(format) && file.numbers().is_some()
            }
            _ => false,
        }
    }

    /// The nearest allowed value, or the default if there is no nearest one because the value must be greater
    /// than 0. `None` for a value of another type.
    #[must_use]
    pub fn nearest(&self, value: &Value) -> Option<Value> {
        let nearest = match (&self.kind, value) {
            (ParameterKind::Number { min, default, .. }, Value::Number(v))
                if *min == ABOVE_ZERO && v < min =>
            {
                Value::Number(*default)
            }
            (ParameterKind::Number { min, max, .. }, Value::Number(v)) => {
                Value::Number(v.max(*min).min(*max))
            }
            (ParameterKind::Integer { min, max, .. }, Value::Integer(v)) => {
                let v = *v.max(min);
                Value::Integer(max.map_or(v, |max| v.min(max)))
            }
            (ParameterKind::Triple { min, max, .. }, Value::Triple(v)) => {
                Value::Triple(v.map(|c| c.max(*min).min(*max)))
            }
            _ => return None,
        };
        self.allows(&nearest).then_some(nearest)
    }

    /// The nearest legal value to an angle in degrees, where angles that differ by whole turns are
    /// equivalent.
    #[must_use]
    pub fn nearest_angle(&self, degrees: f32) -> Option<Value> {
        let same = [0.0, -360.0, 360.0].map(|turn| Value::Number(degrees + turn));
        let legal = same.into_iter().find(|value| self.allows(value));
        legal.or_else(|| self.nearest(&Value::Number(degrees)))
    }

    /// The WGSL type of the parameter's field.
    #[must_use]
    pub fn wgsl_type(&self) -> &'static str {
        match self.kind {
            ParameterKind::Number { .. } | ParameterKind::Integer { .. } => "f32",
            ParameterKind::Colour { .. } | ParameterKind::Triple { .. } => "vec3<f32>",
            ParameterKind::Choice { .. } | ParameterKind::File { .. } => "u32",
        }
    }
}
