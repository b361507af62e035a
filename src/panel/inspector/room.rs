//! The properties of the room, of the display and of the background.

use super::{
    part::{Text, number, section, text_field},
    variant::marked,
};
use crate::{
    optics::{colour::Encoding, tone::ToneMapping},
    panel::{
        knob::{self, Caption},
        prelude::*,
    },
    scene::{Background, Display, Field, Variant},
};

pub(super) fn room(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let (session, registry) = (context.session(), context.registry());
    let width = ui.available_width();
    let s = session.scene();
    let name = s.name.as_deref().unwrap_or_default();
    text_field(ui, "scene name", "Name of the scene", name, "Untitled scene", width, Text::Heading, |text| {
        context.edit(Edit::set(Part::Scene, Scene::name, text));
    });
    ui.add_space(4.0);
    let description = s.description.as_deref().unwrap_or_default();
    let (label, hint) = ("What the scene shows", "What the scene shows, in a sentence or two");
    text_field(ui, "description", label, description, hint, width, Text::Sentences, |text| {
        context.edit(Edit::set(Part::Scene, Scene::description, text));
    });
    ui.add_space(6.0);
    section(ui, "Room", true, |ui| {
        let mut size = s.scene_size;
        let help = "Width along x, height along y, depth along z. One corner of the room is the origin; everything stands in it.";
        let limits = [0, 1, 2].map(|axis| session.document.dimension_limits(axis, registry));
        let caption = Caption::new("size", "m", help);
        if let Some(c) = knob::vector_knob(ui, &caption, size.corner(), &limits) {
            [size.width, size.height, size.depth] = c.to_array();
            context.edit(Edit::from(size));
        }
    });
    section(ui, "Display", true, |ui| display(ui, context));
    section(ui, "Background", true, |ui| background(ui, context));
    let objects = s.objects.len();
    let own = s.objects.iter().filter(|o| o.reflection_model.is_some() || o.shading_model.is_some()).count();
    ui.add_space(8.0);
    let text = format!("{} · {}", plural(s.lights.len(), "light"), plural(objects, "object"));
    let text = if own > 0 { format!("{text}, {own} with an override of model or shading") } else { text };
    theme::note(ui, text);
}

/// Exposure, tone mapping and encoding, which a view may override.
fn display(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let d = context.session().scene().display;
    let edit = marked(ui, Variant::exposure, context, |ui| {
        number(ui, Part::Display, Display::exposure, [d.exposure, Display::default().exposure])
    });
    context.edits(edit);
    let options: Vec<_> = ToneMapping::ALL.iter().map(|t| [t.name(), t.author(), t.summary()]).collect();
    let chosen = ToneMapping::ALL.iter().position(|t| *t == d.tone_mapping).unwrap_or(0);
    let caption = Caption::of(&Display::tone_mapping);
    if let Some(i) = marked(ui, Variant::tone_mapping, context, |ui| {
        knob::choice_with_help(ui, &caption, chosen, &options)
    }) {
        let edit = Edit::set(Part::Display, Display::tone_mapping, ToneMapping::ALL[i]);
        context.edit(edit);
    }
    let names = Encoding::ALL.map(|encoding| match encoding {
        Encoding::Srgb => "sRGB",
        Encoding::Off => "off (gamma-naive)",
    });
    let chosen = Encoding::ALL.iter().position(|e| *e == d.encoding).unwrap_or(0);
    let help = "sRGB: colours are decoded to linear light, the picture is encoded for the display. Off: neither; deliberately wrong, for comparison.";
    let caption = Caption { help, ..Caption::of(&Variant::encoding) };
    if let Some(i) =
        marked(ui, Variant::encoding, context, |ui| knob::choice_knob(ui, &caption, chosen, &names))
    {
        context.edit(Edit::set(Part::Display, Display::encoding, Encoding::ALL[i]));
    }
}

/// The background of all views.
fn background(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let d = context.session().scene().display;
    let options: Vec<_> = Background::ALL.iter().map(|b| [b.name(), "", b.summary()]).collect();
    let chosen = Background::ALL.iter().position(|b| *b == d.background).unwrap_or(0);
    let help = "What the picture shows behind everything, in all views. It lights nothing.";
    let caption = Caption { salt: "background", help, ..Caption::of(&Display::background) };
    if let Some(i) = knob::choice_with_help(ui, &caption, chosen, &options) {
        context.edit(Edit::set(Part::Display, Display::background, Background::ALL[i]));
    }
    let mut colour = |field: Field, label: &str, now: [u8; 3], default: [u8; 3]| {
        let caption = Caption { salt: field.key, label, ..Caption::of(&field) };
        let new = knob::colour_knob(ui, &caption, now, Some(default));
        context.edits(new.map(|rgb| Edit::set(Part::Display, field, rgb)));
    };
    let usual = Display::default();
    let (top, top_default) = (d.background_colour, usual.background_colour);
    match d.background {
        Background::Environment => {}
        Background::Colour => {
            colour(Display::background_colour, "colour", top, top_default);
        }
        Background::Gradient => {
            colour(Display::background_colour, "colour at the top", top, top_default);
            let (bottom, default) = (d.background_bottom, usual.background_bottom);
            colour(Display::background_bottom, "colour at the bottom", bottom, default);
        }
    }
}
