//! A panel from outside the crate, complete: it dims all lights at once.
//!
//! `cargo run --release --example panel` opens the window with it, at the right below the properties.
#![allow(missing_docs)]

use lights_camera_models::{
    bevy::prelude::*,
    bevy_egui::egui::{Slider, Ui},
    prelude::*,
};

/// The part of the light that stays, per cent: the state of the panel.
pub struct Dimmer(f32);

impl Default for Dimmer {
    fn default() -> Self {
        Self(50.0)
    }
}

impl Panel for Dimmer {
    fn id(&self) -> &'static str {
        "dimmer"
    }

    fn title(&self) -> &'static str {
        "Dimmer"
    }

    fn place(&self) -> Place {
        Place::Right
    }

    fn show(&mut self, ui: &mut Ui, context: &mut PanelContext<'_>) {
        let lights = &context.document().lights;
        // The world can be read …
        let world = context.world();
        let objects = world.try_query::<&SceneObject>().map_or(0, |mut query| query.iter(world).count());
        ui.label(format!("Lights: {} · Objects: {objects}", lights.len()));
        ui.add(Slider::new(&mut self.0, 1.0..=200.0).suffix(" %"));
        ui.horizontal(|ui| {
            if ui.button("Dim all lights").clicked() {
                for (i, light) in lights.iter().enumerate() {
                    let intensity = light.intensity * self.0 / 100.0;
                    context.edit(Edit::set(Part::Light(i), Light::intensity, intensity));
                }
                context.say(format!("All lights have {} % of what they had.", self.0));
            }
            if ui.button("Turn objects").clicked() {
                // … and changed once all panels are shown.
                context.queue(|world| {
                    let mut objects = world.query_filtered::<&mut Transform, With<SceneObject>>();
                    objects.iter_mut(world).for_each(|mut place| place.rotate_y(1.0));
                });
            }
        });
    }
}

pub fn main() -> AppExit {
    App::new().add_plugins(LabPlugins::default()).add_panel(Dimmer::default()).run()
}
