//! The properties of the room and of the display.

use bevy_egui::egui::{self, Ui};

use super::{
    part::{Text, section, text_field},
    variant::marked,
};
use crate::{
    document::{Edit, VariantField},
    optics::{colour::Encoding, tone::ToneMapping},
    panel::{
        knob::{self, Caption},
        state::{Action, Session},
        theme,
    },
    registry::Registry,
    scene::{Display, SceneSize, Variant, limits},
    text::plural,
};

pub(super) fn room(ui: &mut Ui, session: &Session, registry: &Registry, actions: &mut Vec<Action>) {
    let width = ui.available_width();
    let s = session.scene();
    text_field(
        ui,
        "scene name",
        "Name of the scene",
        s.name.as_deref().unwrap_or_default(),
        "Untitled scene",
        width,
        Text::Heading,
        |text| {
            actions.push(Action::Edit(Edit::SceneName(text)));
        },
    );
    ui.add_space(4.0);
    text_field(
        ui,
        "description",
        "What the scene shows",
        s.description.as_deref().unwrap_or_default(),
        "What the scene shows, in a sentence or two",
        width,
        Text::Sentences,
        |text| {
            actions.push(Action::Edit(Edit::SceneDescription(text)));
        },
    );
    ui.add_space(6.0);
    section(ui, "Room", true, |ui| {
        let size = s.scene_size;
        let caption = Caption {
            label: "size",
            unit: "m",
            help: "Width along x, height along y, depth along z. One corner of the room is the origin; everything stands in it.",
            ..Caption::default()
        };
        let limits = [0, 1, 2].map(|axis| session.document.dimension_limits(axis, registry));
        if let Some(c) = knob::vector_knob(ui, "size", &caption, size.corner(), &limits) {
            actions.push(Action::Edit(Edit::SceneSize(SceneSize { width: c.x, height: c.y, depth: c.z })));
        }
    });
    section(ui, "Display", true, |ui| {
        let d = s.display;
        let set = |d: Display| Action::Edit(Edit::Display(d));
        let caption = Caption {
            label: "exposure",
            unit: "EV",
            help: "Each EV doubles the brightness of the picture, as a stop of a camera does.",
            ..Caption::default()
        };
        let own = |variant: &Variant| variant.exposure.map(|_| VariantField::Exposure(None));
        if let Some(v) = marked(ui, session, own, actions, |ui| {
            knob::number_knob(ui, "exposure", &caption, f64::from(d.exposure), Some(0.0), &limits::exposure())
        }) {
            actions.push(set(Display { exposure: v as f32, ..d }));
        }
        let options: Vec<_> = ToneMapping::ALL.iter().map(|t| [t.name(), t.author(), t.summary()]).collect();
        let chosen = ToneMapping::ALL.iter().position(|t| *t == d.tone_mapping).unwrap_or(0);
        let caption = Caption {
            label: "tone mapping",
            help: "How light brighter than the display can show is brought into its range. None: it is cut off, and values stay comparable.",
            ..Caption::default()
        };
        let own = |variant: &Variant| variant.tone_mapping.map(|_| VariantField::ToneMapping(None));
        if let Some(i) = marked(ui, session, own, actions, |ui| {
            knob::choice_with_help(ui, "tone mapping", &caption, chosen, &options)
        }) {
            actions.push(set(Display { tone_mapping: ToneMapping::ALL[i], ..d }));
        }
        let names: Vec<_> = Encoding::ALL
            .iter()
            .map(|e| match e {
                Encoding::Srgb => "sRGB",
                Encoding::Off => "off (gamma-naive)",
            })
            .collect();
        let chosen = Encoding::ALL.iter().position(|e| *e == d.encoding).unwrap_or(0);
        let caption = Caption {
            label: "encoding",
            help: "sRGB: colours are decoded to linear light, the picture is encoded for the display. Off: neither; deliberately wrong, for comparison.",
            ..Caption::default()
        };
        let own = |variant: &Variant| variant.encoding.map(|_| VariantField::Encoding(None));
        if let Some(i) = marked(ui, session, own, actions, |ui| {
            knob::choice_knob(ui, "encoding", &caption, chosen, &names)
        }) {
            actions.push(set(Display { encoding: Encoding::ALL[i], ..d }));
        }
    });
    let objects = s.objects.len();
    let own = s.objects.iter().filter(|o| o.reflection_model.is_some() || o.shading_model.is_some()).count();
    ui.add_space(8.0);
    let text = format!("{} · {}", plural(s.lights.len(), "light"), plural(objects, "object"));
    let text = if own > 0 { format!("{text}, {own} with an override of model or shading") } else { text };
    ui.add(egui::Label::new(theme::small(ui, text)).wrap());
}
