//! Knobs for a number in red, green and blue.

use bevy_egui::egui::Ui;

use super::{
    Declared, Knob,
    field::{Entry, complaint, read, text_field},
    line::{Caption, NUMBER, Words, explain, head, knob, tooltip, unit},
    vector::three_fields,
};
use crate::{
    parameter::{Value, kind::triple::Triple},
    scene::limits::{Limits, number},
    text::capitalised,
};

impl Knob for Triple {
    fn show(&self, ui: &mut Ui, of: &Declared, value: &Value) -> Option<Value> {
        let (Value::Triple(v), limits) = (value, of.parameter.kind.limits()?) else { return None };
        triple_knob(ui, &of.caption, *v, self.default, &limits).map(Value::Triple)
    }
}

/// A knob for a number in red, green and blue: one field for all three, and one for each.
pub fn triple_knob(
    ui: &mut Ui,
    caption: &Caption,
    value: [f32; 3],
    default: [f32; 3],
    limits: &Limits,
) -> Option<[f32; 3]> {
    let id = ui.make_persistent_id(caption.salt);
    let out = knob(ui, caption, |ui| {
        ui.spacing_mut().item_spacing.y = 2.0;
        let plain = |v: f32| number(f64::from(v));
        let list = |v: [f32; 3]| v.map(plain).join(", ");
        let same = value[0] == value[1] && value[1] == value[2];
        let (label, all) = head(ui, caption, Words::Leave(NUMBER), |ui| {
            unit(ui, "");
            let shown = if same { plain(value[0]) } else { String::new() };
            let read = |text: &str| read(text, limits).map(|v| [v as f32; 3]);
            let name = format!("{}: all three", caption.label);
            let id = id.with("all");
            text_field(ui, Entry { id, name: &name, shown: &shown, hint: "all", width: 64.0 }, read)
        });
        let mut out = all.value;
        let rule = format!("each {}. Default {}", limits.rule(), list(default));
        explain(label, |ui| tooltip(ui, caption, &rule, ""));
        let mut wrong = all.error.map(|e| (capitalised(&e), list(value), all.response));
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 4.0;
            let bounds = [limits.clone(), limits.clone(), limits.clone()];
            let (new, bad) = three_fields(ui, id, caption, ["R", "G", "B"], value.into(), &bounds);
            out = new.map(Into::into).or(out);
            wrong = wrong.take().or(bad.map(|(e, kept, field)| (e, number(kept), field)));
        });
        if let Some((error, kept, field)) = wrong {
            complaint(ui, &field, &error, &kept);
        }
        ui.add_space(6.0);
        out
    });
    out.filter(|v| *v != value)
}
