//! The choices above the plot: the quantity, the angles, the scale.

use bevy_egui::egui::ComboBox;

use crate::{
    curves::{Channel, Form, Kind},
    panel::{knob, menu, narrow, prelude::*, state::MOST_LIGHT},
    scene::limits::Limits,
};

/// Shows them.
pub(super) fn row(ui: &mut Ui, context: &mut PanelContext<'_>) {
    if narrow::is(ui.ctx()) {
        ui.horizontal_wrapped(|ui| choices(ui, context));
    } else {
        ui.horizontal(|ui| choices(ui, context));
    }
}

fn choices(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let plots = &context.session().plots;
    let mut ask = |command: PlotCommand| context.act(Action::Plot(command));
    let kinds = Kind::ALL.map(|kind| {
        let [name, about] = kind.declaration().choice;
        (kind, name, about)
    });
    if let Some(kind) = list(ui, "Quantity", 176.0, plots.kind, &kinds) {
        ask(PlotCommand::Kind(kind));
    }
    ui.add_space(8.0);
    let light = plots.kind.declaration().has_light;
    let limits = Limits::between(0.0, MOST_LIGHT);
    let help = "The angle between light and normal, 0° to 89°. The handle in the plot changes it, too.";
    let name = "Angle of the light θ_i in degrees";
    if let Some(angle) = angle(ui, ["θ_i", name, help], plots.theta_i, &limits, light) {
        ask(PlotCommand::Light(angle));
    }
    let limits = Limits::between(-360.0, 360.0).slider(0.0, 360.0);
    let help =
        "The azimuth of the plane from the tangent. It matters to anisotropic models: brushed metal, hair.";
    let name = "Azimuth φ in degrees";
    let turns = plots.kind.declaration().has_azimuth;
    if let Some(angle) = angle(ui, ["φ", name, help], plots.phi_i, &limits, turns) {
        ask(PlotCommand::Azimuth(angle));
    }
    ui.add_space(8.0);
    let mut log = plots.log;
    let help = "Equal steps are equal factors: small values are seen beside large ones.";
    if ui.checkbox(&mut log, "logarithmic").on_hover_text(help).changed() {
        ask(PlotCommand::Log(log));
    }
    ui.add_space(8.0);
    if !plots.kind.declaration().is_scalar {
        let plain = match plots.kind.declaration().form {
            Form::Slices => (None, "in colour", "Red, green and blue at once."),
            Form::Plot | Form::Polar => (None, "luminance", "The brightness, after ITU-R BT.709."),
        };
        let one = |(channel, name)| (Some(channel), name, "One channel of the linear colour.");
        let own = [Channel::Red, Channel::Green, Channel::Blue].map(|c| one((c, c.name())));
        let mut all = vec![plain];
        all.extend(own);
        if let Some(channel) = list(ui, "Channel", 84.0, plots.channel, &all) {
            ask(PlotCommand::Channel(channel));
        }
    }
}

/// A field for an angle, behind its symbol.
fn angle(
    ui: &mut Ui,
    [symbol, name, help]: [&str; 3],
    value: f64,
    limits: &Limits,
    enabled: bool,
) -> Option<f64> {
    ui.add_enabled_ui(enabled, |ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        crate::panel::maths::symbol(ui, symbol, 15.0);
        let id = ui.make_persistent_id(("angle of the plots", symbol));
        let field = knob::field(ui, id, name, value, limits, 48.0);
        let wrong = field.error;
        let why = if enabled { help } else { "This quantity does not depend on it." };
        let response = field.response.on_hover_text(why).on_disabled_hover_text(why);
        if let Some(error) = wrong {
            response.on_hover_text(format!("{name} {error}"));
        }
        ui.label(theme::small(ui, "°"));
        field.value
    })
    .inner
}

/// A list of choices: each with its name and a tooltip.
fn list<T: Copy + PartialEq>(
    ui: &mut Ui,
    label: &str,
    width: f32,
    chosen: T,
    all: &[(T, &str, &str)],
) -> Option<T> {
    let names: Vec<_> = all.iter().map(|(_, name, _)| *name).collect();
    let now = all.iter().position(|(value, ..)| *value == chosen).unwrap_or(0);
    let tip = |ui: &mut Ui, i: usize| about_choice(ui, all[i].1, all[i].2);
    // The longest list is seen whole.
    let combo = ComboBox::from_id_salt(("plots", label)).width(width).height(400.0);
    let (button, picked) = menu::list(ui, combo, label, &names, Some(now), tip);
    button.on_hover_ui(|ui| tip(ui, now));
    picked.map(|i| all[i].0)
}

fn about_choice(ui: &mut Ui, name: &str, tip: &str) {
    ui.set_max_width(300.0);
    ui.label(theme::strong(ui, name));
    ui.add(Label::new(tip).wrap());
}
