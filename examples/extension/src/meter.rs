//! A panel with state: the light of all lamps, and the most that there has been.

use lights_camera_models::{bevy_egui::egui::Ui, prelude::*};

#[derive(Default)]
pub struct Meter {
    most: f32,
}

impl Panel for Meter {
    fn id(&self) -> &'static str {
        "meter"
    }

    fn title(&self) -> &'static str {
        "Meter"
    }

    fn place(&self) -> Place {
        Place::Right
    }

    fn show(&mut self, ui: &mut Ui, context: &mut PanelContext<'_>) {
        let total: f32 = context.document().shining().map(|light| light.intensity).sum();
        self.most = self.most.max(total);
        ui.label(format!("Sum of intensities: {total:.1} · most so far: {:.1}", self.most));
        if ui.button("Forget the most").clicked() {
            self.most = total;
            context.say("The meter starts anew.".to_owned());
        }
    }
}
