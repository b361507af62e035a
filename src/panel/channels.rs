//! Debug channels: the legend in the picture.

use bevy_egui::egui::{CornerRadius, Mesh};

use super::{keys, prelude::*, wires};
use crate::{
    channel::{DebugChannel, Legend, Setting},
    optics::viridis::{VIRIDIS, viridis},
};

/// The channel that a view shows, with its picture's legend.
#[must_use]
pub fn shown(session: &Session, view: usize, registry: &Registry) -> Option<(DebugChannel, Legend)> {
    let channel = session.channel_of(view)?;
    let other = channel.declaration().legend_of_shading && view != session.active();
    let seen = other.then(|| session.document.seen(view, registry)).flatten();
    let scene = match &seen {
        Some((scene, _)) => scene,
        None if view == session.active() => session.scene(),
        None => &session.document,
    };
    let setting = Setting::new(channel, scene, registry, session.facts.eye, session.channel_light());
    Some((channel, setting.legend(scene, registry)))
}

/// Paints the legend of a view's channel from a corner on, if the view shows one; a click on it shows the picture
/// again. Returns the legend's rectangle.
pub(super) fn legend(
    ui: &mut Ui,
    rect: Rect,
    (side, top): (Align2, f32),
    view: usize,
    context: &mut PanelContext<'_>,
) -> Option<Rect> {
    let (session, registry) = (context.session(), context.registry());
    let (channel, mut legend) = shown(session, view, registry)?;
    if !session.document.variants.is_empty() {
        legend.title = format!("{} · {}", LETTERS[view.min(MAX_VARIANTS)], legend.title);
    }
    if let Some(remark) = wires::remark(ui.ctx(), view).filter(|_| channel.has_wires()) {
        legend.title = format!("{} ({remark})", legend.title);
    }
    let place = plate(ui, rect, side, top, &legend);
    let response = ui.interact(place, Id::new(("channel legend", view)), Sense::click());
    theme::says(&response, WidgetType::Button, format!("Channel: {}. Show the picture", legend.title));
    let palette = Palette::here(ui);
    let rim = if theme::is_hot(&response) { palette.text } else { palette.accent };
    let stroke = Stroke::new(theme::scale_here(ui), rim);
    ui.painter_at(rect).rect_stroke(place, 4.0, stroke, StrokeKind::Inside);
    if response.clicked() {
        if view != session.active() {
            context.act(Action::Compare(CompareCommand::Activate(view)));
        }
        context.act(Action::View(ViewChange::Channel(None)));
    }
    let help = format!(
        "{}\n\nClick, or {}: the picture again. {}: the next channel.",
        channel.explanation(),
        keys::word(ui.ctx(), "channel.none"),
        keys::word(ui.ctx(), "next_channel"),
    );
    // By key there is no other way to its help.
    if response.has_focus() {
        response.show_tooltip_text(&help);
    }
    response.on_hover_cursor(CursorIcon::PointingHand).on_hover_text(help);
    Some(place)
}

/// Paints a legend at a side of the picture, and returns its rectangle.
pub(super) fn plate(ui: &Ui, rect: Rect, side: Align2, top: f32, legend: &Legend) -> Rect {
    let palette = Palette::here(ui);
    let scale = theme::scale_here(ui);
    let padding = vec2(10.0, 6.0) * scale;
    let room = (rect.width() - 16.0 - 2.0 * padding.x).max(64.0);
    let body = TextStyle::Body.resolve(ui.style());
    let small = FontId::proportional(TextStyle::Small.resolve(ui.style()).size);
    let painter = ui.painter_at(rect);
    let title =
        painter.layout(legend.title.clone(), FontId::new(body.size, theme::semibold()), palette.text, room);
    let lay_out = |text: &String| painter.layout_no_wrap(text.clone(), small.clone(), palette.text);
    let numbers = legend.scale.as_ref().map(|numbers| numbers.each_ref().map(lay_out));
    let colours: Vec<_> = legend.colours.iter().map(|(c, text)| (*c, lay_out(text))).collect();
    let swatch = 12.0 * scale;
    let gap = 4.0 * scale;
    let rows = colours.iter().map(|(_, text)| swatch + 2.0 * gap + text.size().x);
    let bar = if numbers.is_some() { 180.0 * scale } else { 0.0 };
    let width = rows.fold(title.size().x.max(bar.min(room)), f32::max);
    let line = |text: &Galley| text.size().y.max(swatch) + 0.5 * gap;
    let of_scale = numbers.as_ref().map_or(0.0, |n| 2.0 * gap + swatch + n[0].size().y);
    let height = title.size().y + of_scale + colours.iter().map(|(_, text)| line(text)).sum::<f32>();
    let corner = pos2(side.pos_in_rect(&rect.shrink(8.0)).x, top);
    let place = side.anchor_size(corner, vec2(width, height) + 2.0 * padding);
    painter.rect_filled(place, 4.0, palette.panel.gamma_multiply(0.92));
    let mut at = place.min + padding;
    let below = title.size().y;
    painter.galley(at, title, palette.text);
    at.y += below;
    if let Some(numbers) = numbers {
        at.y += gap;
        let bar = Rect::from_min_size(at, vec2(width, swatch));
        painter.add(gradient(bar));
        painter.rect_stroke(bar, CornerRadius::ZERO, Stroke::new(1.0, palette.line), StrokeKind::Outside);
        at.y = bar.bottom() + 0.5 * gap;
        let below = numbers[0].size().y + 0.5 * gap;
        for (number, part) in numbers.into_iter().zip([0.0, 0.5, 1.0]) {
            let x = at.x + part * (width - number.size().x);
            painter.galley(pos2(x, at.y), number, palette.text);
        }
        at.y += below;
    }
    for ([r, g, b], text) in colours {
        let height = line(&text);
        let square = Align2::LEFT_CENTER.anchor_size(pos2(at.x, at.y + 0.5 * height), vec2(swatch, swatch));
        let (colour, stroke) = (Color32::from_rgb(r, g, b), Stroke::new(1.0, palette.weak));
        painter.rect(square, 2.0, colour, stroke, StrokeKind::Outside);
        let y = at.y + 0.5 * (height - text.size().y);
        painter.galley(pos2(square.right() + 2.0 * gap, y), text, palette.text);
        at.y += height;
    }
    place
}

/// The colours of viridis, from left to right.
fn gradient(bar: Rect) -> Mesh {
    let mut mesh = Mesh::default();
    let columns = VIRIDIS.len() - 1;
    for i in 0..=columns {
        let part = i as f32 / columns as f32;
        let [r, g, b] = (255.0 * viridis(part)).to_array().map(|c| c.round() as u8);
        let x = egui::lerp(bar.x_range(), part);
        mesh.colored_vertex(pos2(x, bar.top()), Color32::from_rgb(r, g, b));
        mesh.colored_vertex(pos2(x, bar.bottom()), Color32::from_rgb(r, g, b));
    }
    for corner in (0..2 * columns as u32).step_by(2) {
        mesh.add_triangle(corner, corner + 1, corner + 2);
        mesh.add_triangle(corner + 1, corner + 2, corner + 3);
    }
    mesh
}
