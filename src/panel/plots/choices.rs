//! The choices above the plot: the quantity, the angles, the scale.

use bevy_egui::egui::{self, ComboBox, Ui, WidgetInfo, WidgetType};

use crate::{
    curves::{Channel, Kind},
    panel::{
        knob, menu,
        state::{Action, MOST_LIGHT, PlotCommand, Session},
        theme,
    },
    scene::limits::Limits,
};

/// The quantity in a few words.
pub(super) fn name(kind: Kind) -> &'static str {
    match kind {
        Kind::Brdf => "BRDF f",
        Kind::BrdfCos => "f cos θ",
        Kind::Response => "Response π f cos θ",
        Kind::Polar => "Polar lobe",
        Kind::Albedo => "Directional albedo E",
        Kind::Fresnel => "Fresnel factor F",
        Kind::Distribution => "Distribution D",
        Kind::Masking => "Masking G",
        Kind::Slice => "Image slice",
    }
}

fn about(kind: Kind) -> &'static str {
    match kind {
        Kind::Brdf => "The BRDF f in sr⁻¹ by the angle of the viewer, in the plane of light and normal.",
        Kind::BrdfCos => {
            "f cos θ_i in sr⁻¹: the light that leaves towards the viewer, per unit of irradiance at normal incidence."
        }
        Kind::Response => {
            "π f cos θ_i: the response, which the picture shows. It is 1 for a white matte surface that faces the light."
        }
        Kind::Polar => "The BRDF around a point of the surface: the length of the ray to each viewer is f.",
        Kind::Albedo => {
            "The part of the light that leaves the surface when light comes evenly from everywhere, by the angle of the viewer. More than 1 means that energy is made from nothing."
        }
        Kind::Fresnel => {
            "The part of the light that a mirror of this material reflects, by the angle between light and facet. A factor of microfacet models."
        }
        Kind::Distribution => {
            "How the normals of the microfacets are spread: D in sr⁻¹ by their angle from the normal of the surface. A factor of microfacet models."
        }
        Kind::Masking => {
            "The part of the microfacets that is neither in shadow nor hidden by others. A factor of microfacet models."
        }
        Kind::Slice => {
            "π f as a picture, after B. Burley (2012): the half angle θ_h from left to right, the difference angle θ_d from bottom to top. Highlights are at the left, the Fresnel effect at the top, retroreflection at the bottom."
        }
    }
}

/// Shows them.
pub(super) fn row(ui: &mut Ui, session: &Session, actions: &mut Vec<Action>) {
    let plots = &session.plots;
    let mut ask = |command: PlotCommand| actions.push(Action::Plot(command));
    ui.horizontal(|ui| {
        let kinds = Kind::ALL.map(|kind| (kind, name(kind), about(kind)));
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
        let turns = plots.kind != Kind::Fresnel;
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
            let plain = match plots.kind {
                Kind::Slice => (None, "in colour", "Red, green and blue at once."),
                _ => (None, "luminance", "The brightness, after ITU-R BT.709."),
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
