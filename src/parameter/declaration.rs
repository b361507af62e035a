//! Properties derived from the declaration of a parameter.

use super::{Parameter, UsedWhen, kind::Value};
use crate::text::with_article;

impl Parameter {
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

    /// The parameter, whose values other than the default take many times as long to calculate: searches that try
    /// all choices leave it alone.
    #[must_use]
    pub const fn costly(self) -> Self {
        Self { costly: true, ..self }
    }

    /// The value if the scene gives none.
    #[must_use]
    pub fn default_value(&self) -> Value {
        self.kind.default_value()
    }

    /// The default and the ends of the range, each once; for a choice, all options. Useful in tests of code
    /// that uses the parameter.
    #[must_use]
    pub fn ends(&self) -> Vec<Value> {
        let default = self.default_value();
        let others: Vec<_> = self.kind.ends().into_iter().filter(|end| *end != default).collect();
        [vec![default], others].concat()
    }

    /// The legal values, as the end of a sentence: "must be between 0.5 and 1".
    #[must_use]
    pub fn rule(&self) -> String {
        self.kind.rule()
    }

    /// The unit as it follows a number; empty if the numbers have none.
    #[must_use]
    pub fn suffix(&self) -> String {
        match self.unit {
            "" => String::new(),
            _ if !self.kind.is_measured() => String::new(),
            "°" => "°".to_owned(),
            unit => format!(" {unit}"),
        }
    }

    /// True if a value has the right type and lies in the range.
    #[must_use]
    pub fn allows(&self, value: &Value) -> bool {
        self.kind.owns(value) && self.kind.allows(value)
    }

    /// The nearest allowed value, or the default if there is no nearest one because the value must be greater
    /// than 0. `None` for a value of another type.
    #[must_use]
    pub fn nearest(&self, value: &Value) -> Option<Value> {
        let nearest = self.kind.owns(value).then(|| self.kind.nearest(value))?;
        nearest.filter(|nearest| self.allows(nearest))
    }

    /// The nearest legal value to an angle in degrees, where angles that differ by whole turns are
    /// equivalent.
    #[must_use]
    pub fn nearest_angle(&self, degrees: f32) -> Option<Value> {
        let same = [0.0, -360.0, 360.0].map(|turn| Value::Number(degrees + turn));
        let legal = same.into_iter().find(|value| self.allows(value));
        legal.or_else(|| self.nearest(&Value::Number(degrees)))
    }
}
