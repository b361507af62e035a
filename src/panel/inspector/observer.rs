//! The properties of the observer.

use bevy_egui::egui::{Button, RichText, Ui};

use super::part::{direction_knob, position_limits, section};
use crate::{
    document::Edit,
    panel::{
        keys,
        knob::{self, Caption},
        state::{Action, Session},
        theme,
    },
    scene::{Observer, limits},
};

pub(super) fn observer(ui: &mut Ui, session: &Session, actions: &mut Vec<Action>) {
    let o = session.document.observer;
    let set = |o: Observer| Action::Edit(Edit::Observer(o));
    ui.label(RichText::new("Observer").heading());
    ui.label(theme::small(ui, "The camera of the scene"));
    ui.add_space(6.0);
    section(ui, "Position", true, |ui| {
        let caption = Caption {
            label: "position",
            unit: "m",
            help: "Position of the eye; y is up, the origin is a corner of the room.",
            ..Caption::default()
        };
        if let Some(position) = knob::vector_knob(
            ui,
            "position",
            &caption,
            o.position,
            &position_limits(session.document.scene_size),
        ) {
            actions.push(set(Observer { position, ..o }));
        }
        if let Some(direction) =
            direction_knob(ui, o.direction, "Viewing direction; its length does not matter.")
        {
            actions.push(set(Observer { direction, ..o }));
        }
        let caption = Caption {
            label: "field of view",
            unit: "°",
            help: "The angle between the lower and the upper edge of the picture.",
            ..Caption::default()
        };
        let default = Some(f64::from(crate::scene::DEFAULT_FIELD_OF_VIEW));
        if let Some(v) = knob::number_knob(
            ui,
            "field of view",
            &caption,
            f64::from(o.field_of_view),
            default,
            &limits::field_of_view(),
        ) {
            actions.push(set(Observer { field_of_view: v as f32, ..o }));
        }
        ui.horizontal_wrapped(|ui| {
            let tip = keys::hint(ui.ctx(), "Move the camera to the observer", "home");
            if ui.button("View as observer").on_hover_text(tip).clicked() {
                actions.push(Action::HomeView);
            }
            let problem = session.observer_problem();
            if ui
                .add_enabled(problem.is_none(), Button::new("Set observer to this view"))
                .on_hover_text("Move the observer to the camera")
                .on_disabled_hover_text(problem.unwrap_or_default())
                .clicked()
            {
                actions.push(Action::ObserverFromView);
            }
        });
    });
}
