//! The choices above the plot: the quantity, the angles, the scale.

use bevy_egui::egui::{self, ComboBox, Ui, WidgetInfo, WidgetType};

use crate::{
    curves::{Channel, Form, Kind},
    panel::{
        knob, menu,
        state::{Action, MOST_LIGHT, PlotCommand, Session},
        theme,
    },
    scene::limits::Limits,
};

/// Shows them.
pub(super) fn row(ui: &mut Ui, session: &Session, actions: &mut Vec<Action>) {
    let plots = &session.plots;
    let mut ask = |command: PlotCommand| actions.push(Action::Plot(command));
    ui.horizontal(|ui| {
        let kinds = Kind::ALL.map(|kind| {
            let [name, about] = kind.declaration().choice;
            (kind, name, about)
        });
        if let Some(kind) = list(ui, "Quantity", 176.0, plots.kind, &kinds) {
            ask(PlotCommand::Kind(kind));
        }
        ui.add_space(8.0);
        let light = plots.kind.has_light();
        let limits = Limits::between(0.0, MOST_LIGHT);
        let help = "The angle between light and normal, 0° to 89°. The handle in the plot changes it, too.";
        let name = "Angle of the light θ_i in degrees";
        if let Some(angle) = angle(ui, ["θ_i", name, help], plots.theta_i, &limits, light) {
            ask(PlotCommand::Light(angle));
        }
        let limits = Limits::between(-360.0, 360.0).slider(0.0, 360.0);
        let help = "The azimuth of the plane from the tangent. It matters to anisotropic models: brushed metal, hair.";
        let name = "Azimuth φ in degrees";
        let turns = plots.kind.has_azimuth();
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
        if !plots.kind.is_scalar() {
            let plain = match plots.kind.form() {
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
    });
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
    let now = all.iter().find(|(value, ..)| *value == chosen).or(all.first());
    let (shown, tip) = now.map_or(("–", ""), |(_, name, tip)| (*name, *tip));
    let mut by_key = false;
    let combo = ComboBox::from_id_salt(("plots", label)).width(width).selected_text(shown);
    // The longest list is seen whole.
    let combo = combo.height(400.0);
    let menu = combo.show_ui(ui, |ui| {
        let mut picked = None;
        for (value, name, tip) in all {
            let response = menu::choice(ui, *value == chosen, *name, &mut by_key);
            if response.clicked() {
                picked = Some(*value);
            }
            response.on_hover_ui(|ui| about_choice(ui, name, tip));
        }
        picked
    });
    menu.response
        .widget_info(|| WidgetInfo::labeled(WidgetType::ComboBox, true, format!("{label}: {shown}")));
    if by_key {
        menu.response.request_focus();
    }
    menu.response.on_hover_ui(|ui| about_choice(ui, shown, tip));
    menu.inner.flatten()
}

fn about_choice(ui: &mut Ui, name: &str, tip: &str) {
    ui.set_max_width(300.0);
    ui.label(theme::strong(ui, name));
    ui.add(egui::Label::new(tip).wrap());
}
