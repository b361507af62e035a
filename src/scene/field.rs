//! The declaration of a field of a scene, in the words in which models declare their parameters. Keys, reading, rules,
//! writing, the schema, the limits of widgets and the names of steps follow from it.

pub use super::ids::{Ids, Listed};
use super::{
    clause::{Rule, direction},
    ids::one_of,
};
use crate::{
    declared::setters,
    parameter::{
        ABOVE_ZERO, Value,
        kind::{RGB, colour},
        limits::{Limits, number},
    },
    registry::Registry,
};

/// A declared field.
#[derive(Clone, Copy, Debug)]
pub struct Field {
    /// The key in scene files.
    pub key: &'static str,
    /// The documentation, for editors of scene files and for manuals.
    pub help: &'static str,
    /// The subject of its rule: "the field of view".
    pub subject: &'static str,
    /// The name for people where it differs from the subject.
    pub name: &'static str,
    /// The unit, empty for dimensionless numbers.
    pub unit: &'static str,
    /// Type and range.
    pub kind: Kind,
    /// The meaning of its absence in a file.
    pub absent: Absent,
    /// True if it is written even with its default.
    pub always: bool,
    /// True if its default depends on the type of its part.
    pub by_type: bool,
    /// The key of the field that may be given instead; if neither is given, this one has its default.
    pub instead: Option<&'static str>,
}

/// Type and range of a field.
#[derive(Clone, Copy, Debug)]
pub enum Kind {
    /// A real number in a closed range, with the ends of its slider if they differ from the range's.
    Number {
        /// Smallest legal value.
        min: f32,
        /// Largest legal value; infinite if there is none.
        max: f32,
        /// The ends of the slider.
        slider: Option<[f32; 2]>,
    },
    /// A whole number, that or more.
    Count(u32),
    /// Yes or no, with the first words of the steps that switch it off and on.
    Flag([&'static str; 2]),
    /// A text, and the rule that a value of another type breaks, if it is not obvious.
    Text(Option<&'static str>),
    /// A position in the room.
    Position,
    /// A direction of any length.
    Direction,
    /// A way of any length but 0, in metres.
    Step,
    /// Euler angles in degrees.
    Rotation,
    /// Three sRGB-encoded integers, 0–255.
    Colour,
    /// The id of a registered model or type.
    Id(Ids),
    /// One of several words: id, name and summary of each.
    Choice(fn() -> Vec<[&'static str; 3]>),
    /// The values of a material.
    Material,
    /// The parameters that the type of the part declares, each with a key of its own.
    Parameters,
    /// Values of another field or parameter.
    List,
    /// Another part.
    Part,
    /// A list of parts.
    Parts,
}

/// The names of coordinates.
pub const AXES: [&str; 3] = ["x", "y", "z"];

impl Kind {
    /// The names of its numbers if it has several, as of [parameters](crate::parameter::kind::Kind::entries).
    #[must_use]
    pub const fn entries(&self) -> &'static [&'static str] {
        match self {
            Self::Position | Self::Direction | Self::Step | Self::Rotation => &AXES,
            Self::Colour => &RGB,
            _ => &[],
        }
    }

    /// True for numbers that have a unit: those of colours are codes.
    #[must_use]
    pub const fn is_measured(&self) -> bool {
        !matches!(self, Self::Colour)
    }

    /// True for yes or no.
    #[must_use]
    pub const fn is_flag(&self) -> bool {
        matches!(self, Self::Flag(_))
    }

    /// True if scene files have a text.
    #[must_use]
    pub const fn is_text(&self) -> bool {
        matches!(self, Self::Text(_) | Self::Id(_) | Self::Choice(_))
    }
}

/// The meaning of a field's absence in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Absent {
    /// It has its default, or is not there.
    Allowed,
    /// The user is asked whether to take the default.
    Asked,
    /// An error: "the observer needs one".
    Error(&'static str),
}

impl Field {
    /// A real number in a range. From [`ABOVE_ZERO`] on it is greater than zero.
    #[must_use]
    pub const fn number(subject: &'static str, range: std::ops::RangeInclusive<f32>) -> Self {
        Self::of(subject, Kind::Number { min: *range.start(), max: *range.end(), slider: None })
    }

    /// A field of another kind.
    #[must_use]
    pub const fn of(subject: &'static str, kind: Kind) -> Self {
        let (key, help, name, unit, absent) = ("", "", "", "", Absent::Allowed);
        Self { key, help, subject, name, unit, kind, absent, always: false, by_type: false, instead: None }
    }

    setters! {
        /// Sets the name for people.
        called(name: &'static str) { name }

        /// Sets the unit.
        unit(unit: &'static str) { unit }

        /// Writes the field even with its default.
        always() { always: true }

        /// Requires the field, and asks where it is missing.
        asked() { absent: Absent::Asked, always: true }

        /// Requires the field, for this reason.
        required(why: &'static str) { absent: Absent::Error(why), always: true }

        /// Leaves the default, and whether there is one, to the type of the part; it is always written.
        by_type() { by_type: true, always: true }

        /// Allows another field instead.
        or(other: &'static str) { instead: Some(other), always: true }
    }

    /// Sets the ends of the slider.
    #[must_use]
    pub const fn slider(self, from: f32, to: f32) -> Self {
        match self.kind {
            Kind::Number { min, max, .. } => {
                Self { kind: Kind::Number { min, max, slider: Some([from, to]) }, ..self }
            }
            _ => self,
        }
    }

    /// The name for people: "field of view".
    #[must_use]
    pub fn label(&self) -> &'static str {
        match self.name {
            "" => self.subject.split_once(' ').map_or(self.subject, |(_, label)| label),
            name => name,
        }
    }

    /// A value in words: the names of what is chosen, numbers with their unit.
    #[must_use]
    pub fn shown(&self, value: &Value, registry: &Registry) -> String {
        match (self.kind, value) {
            (Kind::Id(ids), Value::Choice(id)) => {
                ids.find(registry, id).map_or(id.as_ref(), |listed| listed.name).to_owned()
            }
            (Kind::Choice(words), Value::Choice(word)) => {
                let known = words().into_iter().find(|[known, ..]| known == word);
                known.map_or(word.as_ref(), |[_, name, _]| name).to_owned()
            }
            (_, Value::Number(v)) => format!("{} {}", number((*v).into()), self.unit).trim_end().to_owned(),
            (_, value) => value.to_string(),
        }
    }

    /// The legal numbers, for widgets.
    #[must_use]
    pub fn limits(&self) -> Limits {
        let any = Limits::between(f64::NEG_INFINITY, f64::INFINITY);
        match self.kind {
            Kind::Number { min, max, slider } => {
                let limits = Limits::of(min, max);
                match slider {
                    Some([from, to]) => limits.slider(from.into(), to.into()),
                    None => limits,
                }
            }
            Kind::Count(min) => Limits::between(min.into(), f64::INFINITY).whole(),
            Kind::Rotation => any.slider(-180.0, 180.0),
            Kind::Colour => Limits::between(0.0, 255.0).whole(),
            _ => any.slider(-1.0, 1.0),
        }
    }

    /// Checks a value by itself. [`check`](mod@super::check) decides whether a position is in the room and
    /// whether parameters are known.
    ///
    /// # Errors
    /// Returns the broken rule as a clause.
    pub fn check(&self, value: &Value, registry: &Registry) -> Rule {
        match (self.kind, value) {
            (Kind::Number { .. }, Value::Number(v)) => self.check_number(*v),
            (Kind::Count(min), Value::Integer(n)) if *n < i64::from(min) => Err(self.rule(registry)),
            (Kind::Direction, Value::Triple(v)) => direction((*v).into()),
            (Kind::Rotation, Value::Triple(v)) if v.iter().any(|v| !v.is_finite()) => {
                Err("a rotation must be three finite numbers of degrees".to_owned())
            }
            (Kind::Step, Value::Triple(v)) if *v == [0.0; 3] || v.iter().any(|v| !v.is_finite()) => {
                Err(format!("{} must be three finite numbers of metres, not all of them 0", self.subject))
            }
            (Kind::Id(ids), Value::Choice(id)) => ids.check(registry, id),
            _ => Ok(()),
        }
    }

    /// Checks the word of a choice.
    ///
    /// # Errors
    /// Returns the broken rule as a clause.
    pub fn check_text(&self, word: &str) -> Rule {
        let Kind::Choice(words) = self.kind else { return Ok(()) };
        one_of(
            self.subject,
            word,
            words().into_iter().map(|[id, name, _]| (id, if name.is_empty() { id } else { name })),
        )
    }

    /// Checks a number.
    ///
    /// # Errors
    /// Returns the broken rule as a clause.
    pub fn check_number(&self, v: f32) -> Rule {
        let Kind::Number { min, max, .. } = self.kind else { return Ok(()) };
        if v.is_finite() && min <= v && v <= max { Ok(()) } else { Err(self.clause(v)) }
    }

    /// The rule that a number breaks.
    fn clause(&self, v: f32) -> String {
        let Kind::Number { min, max, .. } = self.kind else { return String::new() };
        let Self { subject, unit, .. } = self;
        let unit = match *unit {
            "" => String::new(),
            _ if max.is_infinite() => String::new(),
            "°" => " degrees".to_owned(),
            unit => format!(" {unit}"),
        };
        // Of a range that nobody reaches, only the end that was left is of interest.
        let wide = max >= 1e6;
        let most =
            if wide { format!("{:.1e}", max.min(f32::MAX)).replace(".0e", "e") } else { max.to_string() };
        match (wide, min == ABOVE_ZERO) {
            (true, _) if v > max || v == f32::INFINITY => format!("{subject} must be at most {most}{unit}"),
            (true, true) => format!("{subject} must be greater than 0"),
            (true, false) => format!("{subject} must be at least {min}"),
            (false, true) => format!("{subject} must be greater than 0 and at most {most}{unit}"),
            (false, false) => format!("{subject} must be between {min} and {most}{unit}"),
        }
    }

    /// The rule that a value of another type breaks.
    #[must_use]
    pub fn rule(&self, registry: &Registry) -> String {
        let subject = self.subject;
        match self.kind {
            Kind::Number { .. } => self.clause(f32::NAN),
            Kind::Count(0) => format!("{subject} must be a whole number"),
            Kind::Count(min) => format!("{subject} must be a whole number of at least {min}"),
            Kind::Flag(_) => format!("{} must be true or false", self.key),
            Kind::Text(rule) => rule.map_or_else(|| format!("{subject} must be text"), str::to_owned),
            Kind::Position | Kind::Direction | Kind::Step | Kind::Rotation => {
                format!("{subject} must be three numbers: [x, y, z]")
            }
            Kind::List => format!("{subject} must be a list"),
            Kind::Colour => format!("{subject} must be {}", colour::RULE),
            Kind::Id(ids) => ids.check(registry, "").err().unwrap_or_default(),
            Kind::Choice(_) => self.check_text("").err().unwrap_or_default(),
            Kind::Material | Kind::Parameters | Kind::Part | Kind::Parts => String::new(),
        }
    }
}
