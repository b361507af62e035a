//! The knob of whole numbers, which is that of numbers.

use bevy_egui::egui::Ui;

use super::{Declared, Knob, number};
use crate::parameter::{Value, kind::integer::Integer};

impl Knob for Integer {
    fn show(&self, ui: &mut Ui, of: &Declared, value: &Value) -> Option<Value> {
        number::of_parameter(ui, of, value, self.default as f64)
    }
}
