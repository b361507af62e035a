//! The properties of the observer.

use super::part::{number, section, vector};
use crate::{
    panel::{keys, prelude::*, state::Effect},
    scene::Observer,
};

pub(super) fn observer(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let session = context.session();
    let o = session.document.observer;
    ui.label(RichText::new("Observer").heading());
    ui.label(theme::small(ui, "The camera of the scene"));
    ui.add_space(6.0);
    section(ui, "Position", true, |ui| {
        let (part, room) = (Part::Observer, session.document.scene_size);
        let help = "Position of the eye; y is up, the origin is a corner of the room.";
        let position = vector(ui, part, Observer::position, help, o.position, room);
        let help = "Viewing direction; its length does not matter.";
        let direction = vector(ui, part, Observer::direction, help, o.direction, room);
        let help = "The angle between the lower and the upper edge of the picture.";
        let field = Observer::field_of_view;
        let angles = [o.field_of_view, Observer::default().field_of_view];
        let angle = number(ui, part, field, help, angles, &field.limits());
        context.edits([position, direction, angle].into_iter().flatten());
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
