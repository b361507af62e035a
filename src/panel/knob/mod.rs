//! Knobs: widgets that show one value, let the user drag or type it, and enforce its limits.
//!
//! A knob never returns an invalid value.

use bevy_egui::egui::Ui;

use crate::parameter::{Parameter, ParameterKind, Value, kind::every_kind};

mod field;
mod flag;
mod line;
mod picker;
mod readout;
mod slider;
mod vector;

pub(super) use self::choice::{WIDE, drop_down};
pub use self::choice::{choice_knob, choice_with_help, list_knob};
pub use self::colour::{colour_knob, colour_sample, parse_hex};
pub use self::file::file_knob;
pub use self::number::{number_knob, number_knob_beside, unit_choice};
pub use self::triple::triple_knob;
pub use field::{Field, field, parse};
pub use flag::flag_knob;
pub use line::Caption;
pub(super) use line::symbol_column;
pub(super) use picker::picker;
pub use readout::readout;
pub use slider::Amount;
pub use vector::vector_knob;

/// A parameter with a knob.
struct Declared<'a> {
    parameter: &'a Parameter,
    caption: Caption<'a>,
}

/// A kind of parameter as a widget.
trait Knob {
    /// Shows a value, which is of this kind. Returns another one.
    fn show(&self, ui: &mut Ui, of: &Declared, value: &Value) -> Option<Value>;
}

/// The files of the kinds. `scripts/test` names them to rustfmt, which sees no modules that a macro declares.
macro_rules! knobs {
    ($($file:ident::$Kind:ident),+) => {
        $(mod $file;)+

        fn of(kind: &ParameterKind) -> &dyn Knob {
            match kind {
                $(ParameterKind::$Kind(kind) => kind,)+
            }
        }
    };
}
every_kind!(knobs);

/// The knob of a declared parameter. Returns a new valid value.
pub fn parameter_knob(
    ui: &mut Ui,
    salt: &str,
    parameter: &Parameter,
    value: &Value,
    disabled: Option<&str>,
) -> Option<Value> {
    let Parameter { symbol, label, unit, help, .. } = *parameter;
    let caption = Caption { salt, symbol, label, unit, help, disabled, indent: 0.0 };
    let new = of(&parameter.kind).show(ui, &Declared { parameter, caption }, value);
    // The limits are f32: rounding to f64 must not push a value at an end out of range.
    new.filter(|new| parameter.allows(new))
}
