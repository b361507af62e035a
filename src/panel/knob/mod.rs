//! Knobs: widgets that show one value, let the user drag or type it, and enforce its limits.
//!
//! A knob never returns an invalid value.

use bevy_egui::egui::Ui;

use crate::{
    parameter::{Parameter, ParameterKind, Value},
    scene::limits::Limits,
};

mod choice;
mod colour;
mod field;
mod file;
mod flag;
mod line;
mod number;
mod picker;
mod readout;
mod slider;
mod vector;

pub(super) use choice::{WIDE, drop_down};
pub use choice::{choice_knob, choice_with_help, list_knob};
pub use colour::{colour_knob, colour_sample, parse_hex};
pub use field::{Field, field, parse};
pub use file::file_knob;
pub use flag::flag_knob;
pub use line::Caption;
pub(super) use line::symbol_column;
pub use number::{number_knob, number_knob_beside, unit_choice};
pub(super) use picker::picker;
pub use readout::readout;
pub use vector::{triple_knob, vector_knob};

/// The limits of a declared number; `None` for other kinds.
#[must_use]
pub fn limits_of(parameter: &Parameter) -> Option<Limits> {
    match parameter.kind {
        ParameterKind::Number { min, max, .. } => Some(Limits {
            min: f64::from(min),
            max: f64::from(max),
            slider_min: if f64::from(min) < 1e-30 { f64::from(min.min(0.0)) } else { f64::from(min) },
            slider_max: f64::from(max),
            whole: false,
            because: None,
        }),
        ParameterKind::Integer { min, max, slider_max, .. } => Some(Limits {
            min: min as f64,
            max: max.map_or(f64::INFINITY, |m| m as f64),
            slider_min: min as f64,
            slider_max: max.unwrap_or(slider_max).min(slider_max.max(min + 1)) as f64,
            whole: true,
            because: None,
        }),
        ParameterKind::Colour { .. }
        | ParameterKind::Triple { .. }
        | ParameterKind::Choice { .. }
        | ParameterKind::File { .. } => None,
    }
}

/// The knob of a declared parameter. Returns a new valid value.
pub fn parameter_knob(
    ui: &mut Ui,
    salt: &str,
    parameter: &Parameter,
    value: &Value,
    disabled: Option<&str>,
) -> Option<Value> {
    let caption = Caption {
        symbol: parameter.symbol,
        label: parameter.label,
        unit: parameter.unit,
        help: parameter.help,
        disabled,
        ..Caption::default()
    };
    match (&parameter.kind, value) {
        (ParameterKind::Number { default, .. }, Value::Number(v)) => {
            let limits = limits_of(parameter)?;
            // The limits are f32: rounding to f64 must not push a value at an end out of range.
            number_knob(ui, salt, &caption, f64::from(*v), Some(f64::from(*default)), &limits)
                .map(|v| Value::Number(v as f32))
                .filter(|v| parameter.allows(v))
        }
        (ParameterKind::Integer { default, .. }, Value::Integer(v)) => {
            let limits = limits_of(parameter)?;
            number_knob(ui, salt, &caption, *v as f64, Some(*default as f64), &limits)
                .map(|v| Value::Integer(v as i64))
                .filter(|v| parameter.allows(v))
        }
        (ParameterKind::Colour { default }, Value::Colour(rgb)) => {
            colour_knob(ui, salt, &caption, *rgb, Some(*default)).map(Value::Colour)
        }
        (ParameterKind::Triple { min, max, default }, Value::Triple(v)) => {
            let limits = Limits::between(f64::from(*min), f64::from(*max));
            triple_knob(ui, salt, &caption, *v, *default, &limits)
                .map(Value::Triple)
                .filter(|v| parameter.allows(v))
        }
        (ParameterKind::Choice { .. }, value) if parameter.is_flag() => {
            // The name in files is a word, not a symbol of the equation.
            let symbol = if parameter.symbol == parameter.name { "" } else { parameter.symbol };
            flag_knob(ui, salt, &Caption { symbol, ..caption }, value.truth()?).map(Value::flag)
        }
        (ParameterKind::Choice { options, .. }, Value::Choice(id)) => {
            let chosen = options.iter().position(|(o, _)| *o == id.as_ref()).unwrap_or(0);
            let names: Vec<_> = options.iter().map(|(_, name)| *name).collect();
            choice_knob(ui, salt, &caption, chosen, &names).map(|i| Value::Choice(options[i].0.into()))
        }
        _ => None,
    }
}
