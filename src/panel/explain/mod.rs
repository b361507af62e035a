//! Why this pixel has this colour: the explanation of the pixel under the pointer, or of one that is pinned, as a worked
//! example; and the vectors of its point in the picture.
//!
//! The numbers are those of [`explain`](crate::explain), which watches the CPU renderer. They are calculated when the
//! pixel, the scene, the camera or the view has changed, and only while the panel is open.

use std::sync::Arc;

use bevy_egui::egui::{
    self, Align, Button, Id, Layout, Rect, RichText, ScrollArea, Ui, UiBuilder, pos2, vec2,
};

use super::{
    Panel, PanelContext, Place, icon, knob,
    state::{Action, EXPLAIN_TAB, Pin, Session, Severity, ThemeChoice, ViewChange},
    theme::{self, Palette},
};
use crate::{
    document::Selection,
    explain::{Explanation, Seen},
    optics::TermSelection,
    registry::Registry,
    scene::{limits::Limits, variant::LETTERS},
    text::listed,
};

mod display;
mod lights;
mod lobe;
mod point;
mod probe;
mod rows;
mod surface;
mod vectors;

pub(super) use lobe::entries as lobe_entries;
pub use lobe::{Lobes, lobe_calculations, lobes_shown};
pub use probe::{Explained, aimed, calculations, clicked, explained, left, look};
pub use surface::LightLobe;
pub(super) use vectors::vectors;

/// The least width of a column, points; in less there is one column.
const COLUMN: f32 = 272.0;
/// Between columns, points.
const GAP: f32 = 24.0;

/// See the module.
#[derive(Clone, Copy, Debug)]
pub struct Explain;

impl Panel for Explain {
    fn id(&self) -> &'static str {
        EXPLAIN_TAB
    }

    fn title(&self) -> &'static str {
        "Explain"
    }

    fn place(&self) -> Place {
        Place::Bottom
    }

    fn show(&mut self, ui: &mut Ui, context: &mut PanelContext<'_>) {
        let (session, registry, actions) = (context.session(), context.registry(), &mut context.actions);
        let Some(explained) = probe::explained(ui.ctx()) else {
            ui.add_space(8.0);
            ui.add(
                egui::Label::new(
                    RichText::new(
                        "Point at the picture: this panel says why the pixel has its colour, number by number. E pins \
                         the pixel under the pointer, or the middle of the picture.",
                    )
                    .color(Palette::here(ui).weak),
                )
                .wrap(),
            );
            return;
        };
        header(ui, session, &explained, actions);
        for (severity, text) in remarks(&explained, session) {
            remark(ui, severity, &text);
        }
        ui.add_space(2.0);
        columns(ui, &explained, session, registry);
    }
}

/// The pixel, its code, and the buttons.
fn header(ui: &mut Ui, session: &Session, explained: &Explained, actions: &mut Vec<Action>) {
    let Explanation { pixel, size, .. } = explained.explanation;
    let (pinned, fov) = (session.view.pinned.is_some(), session.document.observer.field_of_view);
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 6.0;
        let code = explained.explanation.code();
        rows::chip(ui, code, vec2(40.0, 24.0));
        ui.label(theme::strong(ui, "Pixel"));
        for (i, name) in ["column of the pixel", "row of the pixel"].into_iter().enumerate() {
            let limits = Limits { whole: true, ..Limits::between(0.0, f64::from(size[i].saturating_sub(1))) };
            let id = Id::new(("explained pixel", i));
            let field = knob::field(ui, id, name, f64::from(pixel[i]), &limits, 52.0);
            if let Some(value) = field.value {
                let mut other = pixel;
                other[i] = value as u32;
                let pin = Pin::of_pixel(explained.view, other, size, fov);
                actions.push(Action::View(ViewChange::Pin(Some(pin))));
            }
        }
        let view = match session.document.variants.len() {
            0 => String::new(),
            _ => format!(" · view {}", LETTERS.get(explained.view).copied().unwrap_or("?")),
        };
        ui.label(theme::small(ui, format!("of {}×{}{view}", size[0], size[1])));
        let [r, g, b] = code;
        ui.label(theme::strong(ui, format!("red {r}, green {g}, blue {b}")));
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            if ui.button("Copy").on_hover_text("Copy the explanation as text, with all digits").clicked() {
                actions.push(Action::Copy(explained.explanation.to_text()));
            }
            let pin = ui.add(Button::selectable(pinned, "Pin")).on_hover_text(if pinned {
                "Let go of the pixel (E or Esc): the pointer is followed again"
            } else {
                "Keep this pixel explained wherever the pointer is. At the pointer: E, or Alt and a click"
            });
            if pin.clicked() {
                let this = Pin::of_pixel(explained.view, pixel, size, fov);
                actions.push(Action::View(ViewChange::Pin(Some(this).filter(|_| !pinned))));
            }
            lobe::button(ui, session, actions);
        });
    });
}

/// What is to be said before the numbers.
fn remarks(explained: &Explained, session: &Session) -> Vec<(Severity, String)> {
    let explanation = &explained.explanation;
    let mut all = Vec::new();
    if !explained.ignored.is_empty() {
        let files: Vec<_> = explained.ignored.iter().map(String::as_str).collect();
        all.push((
            Severity::Warning,
            format!(
                "This is not the explanation of the picture: it is that of the CPU renderer, which ignores the edited {}.",
                listed(&files, "and")
            ),
        ));
    }
    let trouble = explanation.seen.as_ref().and_then(|seen| seen.model.trouble.as_ref());
    if let Some(trouble) = trouble {
        all.push((
            Severity::Warning,
            format!(
                "This is not the explanation of the picture: the CPU cannot run this model, so the numbers are not its \
                 own: {trouble}."
            ),
        ));
    }
    if explanation.seen.is_none() && session.view.theme == ThemeChoice::Light {
        all.push((
            Severity::Info,
            "The window with the light theme has a light surround here; pictures that are rendered have this background."
                .to_owned(),
        ));
    }
    if explanation.terms != TermSelection::All {
        all.push((Severity::Info, format!("Only the {} term is shown.", explanation.terms.id())));
    }
    let light = explanation.steps.light;
    if light.is_nan()
        || explanation.seen.as_ref().is_some_and(|seen| seen.spots.iter().any(|s| s.is_replaced()))
    {
        all.push((
            Severity::Warning,
            "Some light here is not a number, or infinite; it counts as 0, or as ±10³⁰.".to_owned(),
        ));
    }
    all
}

fn remark(ui: &mut Ui, severity: Severity, text: &str) {
    let palette = Palette::here(ui);
    ui.horizontal_top(|ui| {
        ui.spacing_mut().item_spacing.x = 6.0;
        let (sign, _) = ui.allocate_exact_size(vec2(16.0, 18.0), egui::Sense::hover());
        icon::severity(ui.painter(), sign.center(), 5.5, severity, &palette);
        ui.add(egui::Label::new(text).wrap().selectable(true));
    });
}

/// A part of the explanation.
type Part<'a> = (&'a str, f32, Box<dyn FnOnce(&mut Ui) + 'a>);

/// The explanation in columns, as light goes: from the surface and the lights to the display. In little room, one below
/// the other.
fn columns(ui: &mut Ui, explained: &Arc<Explained>, session: &Session, registry: &Registry) {
    let explanation = &explained.explanation;
    let choice = probe::choice(ui.ctx());
    let mut parts: Vec<Part> = Vec::new();
    match &explanation.seen {
        Some(seen) => {
            parts.push(("surface", 0.3, Box::new(|ui| surface(ui, seen, session, registry))));
            parts.push(("lights", 0.42, Box::new(move |ui| lights::lights(ui, explanation, seen, choice))));
        }
        None => parts.push(("background", 0.6, Box::new(background))),
    }
    parts.push(("display", 0.28, Box::new(|ui| display::display(ui, explanation))));
    let room = ui.available_rect_before_wrap();
    let whole: f32 = parts.iter().map(|(_, share, _)| share).sum();
    let width = room.width() - GAP * (parts.len() - 1) as f32;
    let least = parts.iter().map(|(_, share, _)| width * share / whole).fold(f32::INFINITY, f32::min);
    let scroll = |id: &str| ScrollArea::vertical().id_salt(("explain", id)).auto_shrink(false);
    if least < COLUMN {
        scroll("all").show(ui, |ui| {
            ui.set_max_width(ui.available_width() - 10.0);
            for (_, _, part) in parts {
                part(ui);
                ui.add_space(10.0);
            }
        });
        return;
    }
    let mut left = room.left();
    for (i, (id, share, part)) in parts.into_iter().enumerate() {
        let right = left + width * share / whole;
        let place = Rect::from_min_max(pos2(left, room.top()), pos2(right, room.bottom()));
        if i > 0 {
            let line = egui::Stroke::new(1.0, Palette::here(ui).line);
            ui.painter().vline(left - 0.5 * GAP, room.y_range(), line);
        }
        let mut column = ui.new_child(UiBuilder::new().max_rect(place).id_salt(id));
        column.set_clip_rect(column.clip_rect().intersect(place.expand2(vec2(4.0, 0.0))));
        scroll(id).show(&mut column, |ui| {
            ui.set_max_width(ui.available_width() - 10.0);
            part(ui);
            ui.add_space(8.0);
        });
        left = right + GAP;
    }
    ui.advance_cursor_after_rect(room);
}

/// The object, and where and how its light is calculated.
fn surface(ui: &mut Ui, seen: &Seen, session: &Session, registry: &Registry) {
    rows::heading(ui, &session.name_of(Selection::Object(seen.object.index), registry));
    let d = seen.model.declaration;
    let author = if d.author.is_empty() { String::new() } else { format!(" · {}", d.author) };
    rows::note(ui, &format!("{}{author}", d.name));
    if seen.model.interpreted {
        rows::note(ui, "The CPU interprets the WGSL of this model.");
    }
    ui.add_space(2.0);
    if let Some(shading) = registry.shading_model(seen.shading.id) {
        super::inspector::model::stage(ui, shading);
    }
    point::point(ui, seen);
}

fn background(ui: &mut Ui) {
    rows::heading(ui, "Background");
    ui.add(
        egui::Label::new(
            "There is no object at the centre of this pixel. The background is not light of the scene: lights and \
             exposure do not change it, tone mapping does.",
        )
        .wrap(),
    );
}
