//! The properties of the observer.

use super::part::{number, section, vector};
use crate::{
    panel::{keys, prelude::*, state::Effect},
    parameter::Value,
    scene::{
        Field, Observer, SceneSize,
        part::{Fields as _, Structure as _},
    },
};

pub(super) fn observer(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let session = context.session();
    let observer = session.document.observer;
    ui.label(RichText::new("Observer").heading());
    ui.label(theme::small(ui, "The camera of the scene"));
    ui.add_space(6.0);
    section(ui, "Position", true, |ui| {
        for field in Observer::FIELDS {
            context.edits(knob_of_field(ui, **field, &observer, session.document.scene_size));
        }
        ui.horizontal_wrapped(|ui| {
            let tip = keys::hint(ui.ctx(), "Move the camera to the observer", "home");
            let button = ui.button("View as observer").on_hover_text(tip);
            context.on_click(&button, || Action::Do(Effect::HomeView));
            let problem = session.observer_problem();
            if ui
                .add_enabled(problem.is_none(), Button::new("Set observer to this view"))
                .on_hover_text("Move the observer to the camera")
                .on_disabled_hover_text(problem.unwrap_or_default())
                .clicked()
            {
                context.act(Action::Do(Effect::ObserverFromView));
            }
        });
    });
}

/// The knob of a field of the observer, by the type of its value.
fn knob_of_field(ui: &mut Ui, field: Field, now: &Observer, room: SceneSize) -> Option<Edit> {
    let [value, default] = [now, &Observer::default()].map(|observer| observer.value(field.into()));
    match (value?, default?) {
        (Value::Triple(v), _) => vector(ui, Part::Observer, field, v.into(), room),
        (Value::Number(v), Value::Number(default)) => number(ui, Part::Observer, field, [v, default]),
        _ => None,
    }
}
