//! Debug channels: the legend in the picture.

use bevy_egui::egui::{CornerRadius, Mesh};

use super::{
    keys,
    placer::{EDGE, Placer},
    prelude::*,
    wires,
};
use crate::{
    channel::{DebugChannel, Legend, Plate, Setting, Spacing},
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

/// Maximum height of a legend, as a fraction of the picture: in a smaller picture there are the title and the ends of
/// the scale, or the title alone; where that would be cut, the name of the channel.
const TALLEST: f32 = 0.4;
/// The same beside other views, where pictures are small and objects large in them.
const TALLEST_OF_SEVERAL: f32 = 0.25;
/// The same in a presentation, where all letters are large, and where a band above the picture may be as high.
const TALLEST_ON_SLIDE: f32 = 0.45;

/// Paints the legend of a view's channel, if the view shows one; a click on it shows the picture again. Returns the
/// legend's rectangle.
pub(super) fn legend(
    ui: &mut Ui,
    placer: &mut Placer,
    view: usize,
    context: &mut PanelContext<'_>,
) -> Option<Rect> {
    let (session, registry) = (context.session(), context.registry());
    let (channel, mut legend) = shown(session, view, registry)?;
    let several = !session.document.variants.is_empty();
    let mut name = channel.name().to_owned();
    if several {
        let letter = LETTERS[view.min(MAX_VARIANTS)];
        for text in [&mut legend.title, &mut name] {
            *text = format!("{letter} · {text}");
        }
    }
    if let Some(remark) = wires::remark(ui.ctx(), view).filter(|_| channel.has_wires()) {
        legend.title = format!("{} ({remark})", legend.title);
    }
    let rect = placer.room;
    let part = match (session.view.presenting, several) {
        (true, _) => TALLEST_ON_SLIDE,
        (false, true) => TALLEST_OF_SEVERAL,
        (false, false) => TALLEST,
    };
    let tallest = part * rect.height();
    let (laid_out, is_cut) = that_fits(ui, rect, &legend, &name, tallest);
    let place = placer.place(laid_out.size);
    laid_out.paint(ui, rect, place);
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
    let more = if is_cut { format!("{}\n\n", in_words(&legend)) } else { String::new() };
    let help = format!(
        "{more}{}\n\nClick, or {}: the picture again. {}: the next channel.",
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

/// A legend in a picture, at most so tall: whole; or its title, or else the name of its channel, with the ends of the
/// scale; or else without. Returns also true if something is left out.
fn that_fits(ui: &Ui, rect: Rect, legend: &Legend, name: &str, tallest: f32) -> (LaidOut, bool) {
    let fits =
        |all: &LaidOut| all.size.x <= rect.width() - 2.0 * EDGE && all.size.y <= tallest && !all.title.elided;
    let whole = LaidOut::new(ui, rect, legend, usize::MAX);
    if fits(&whole) {
        return (whole, false);
    }
    let short = [legend.title.as_str(), name]
        .map(|title| Legend { scale: legend.scale.clone(), ..Legend::new(title) });
    let ends = short.iter().filter(|legend| legend.scale.is_some());
    let mut ends = ends.map(|legend| LaidOut::with_ends(ui, rect, legend));
    if let Some(ends) = ends.find(fits) {
        return (ends, true);
    }
    let title = LaidOut::new(ui, rect, &Legend::new(legend.title.clone()), 1);
    if !title.title.elided {
        return (title, true);
    }
    let named = |rows| LaidOut::new(ui, rect, &Legend::new(name.to_owned()), rows);
    let two = named(2);
    (if two.size.y <= tallest { two } else { named(1) }, true)
}

/// A legend that is only a text.
fn in_words(legend: &Legend) -> String {
    let scale = legend.scale.iter().map(|[from, _, to]| format!("{from} to {to}"));
    let colours = legend.colours.iter().map(|(_, text)| text.clone());
    [legend.title.clone()].into_iter().chain(scale).chain(colours).collect::<Vec<_>>().join("\n")
}

/// A legend, laid out.
pub(super) struct LaidOut {
    title: Arc<Galley>,
    numbers: Vec<Arc<Galley>>,
    colours: Vec<([u8; 3], Arc<Galley>)>,
    plate: Plate,
    /// Side of the square that shows a colour.
    swatch: f32,
    /// Its size, with the space around the text.
    pub(super) size: Vec2,
}

impl LaidOut {
    /// Width of the bar with three numbers below it, and minimum width of one between two, at scale 1.
    const BARS: [f32; 2] = [180.0, 40.0];

    /// Lays out a legend for a picture, with at most so many rows of the title.
    pub(super) fn new(ui: &Ui, rect: Rect, legend: &Legend, rows: usize) -> Self {
        let numbers: Vec<_> = legend.scale.iter().flatten().collect();
        Self::of(ui, rect, legend, (&numbers[..], Self::BARS[0]), rows)
    }

    /// Lays out a legend with a title in one line, and the ends of the scale at those of its bar.
    fn with_ends(ui: &Ui, rect: Rect, legend: &Legend) -> Self {
        let ends: Vec<_> = legend.scale.iter().flat_map(|[from, _, to]| [from, to]).collect();
        Self::of(ui, rect, legend, (&ends[..], Self::BARS[1]), 1)
    }

    fn of(ui: &Ui, rect: Rect, legend: &Legend, (numbers, bar): (&[&String], f32), rows: usize) -> Self {
        let ink = Palette::here(ui).text;
        let scale = theme::scale_here(ui);
        let [swatch, gap, side, above, bar] = [12.0, 4.0, 10.0, 6.0, bar].map(|v| v * scale);
        let room = (rect.width() - 2.0 * EDGE - 2.0 * side).max(64.0);
        let small = FontId::proportional(TextStyle::Small.resolve(ui.style()).size);
        let title = theme::lines(ui, &legend.title, theme::bold(ui), ink, (room, rows));
        let lay_out = |text: &String| ui.painter().layout_no_wrap(text.clone(), small.clone(), ink);
        let numbers: Vec<_> = numbers.iter().map(|text| lay_out(text)).collect();
        let colours: Vec<_> = legend.colours.iter().map(|(c, text)| (*c, lay_out(text))).collect();
        // Three numbers stand apart, however large they are.
        let bar = match &numbers[..] {
            [from, middle, to] => bar.max(2.0 * (from.size().x.max(to.size().x) + gap) + middle.size().x),
            _ => bar,
        };
        let spacing = Spacing {
            padding: [side, above],
            bar: swatch,
            least: bar.min(room),
            gaps: [gap, 0.5 * gap, 0.5 * gap],
            beside: 2.0 * gap,
            line: 0.5 * gap,
        };
        let size = |text: &Arc<Galley>| <[f32; 2]>::from(text.size());
        let sizes: Vec<_> = numbers.iter().map(size).collect();
        let texts: Vec<_> = colours.iter().map(|(_, text)| size(text)).collect();
        let plate = Plate::new(&spacing, size(&title), &sizes, &texts);
        let size = Vec2::from(plate.size);
        Self { title, numbers, colours, plate, swatch, size }
    }

    /// Paints the legend into a picture.
    pub(super) fn paint(self, ui: &Ui, rect: Rect, place: Rect) {
        let palette = Palette::here(ui);
        let painter = ui.painter_at(rect);
        let at = |p: [f32; 2]| place.min + Vec2::from(p);
        painter.rect_filled(place, 4.0, palette.plate());
        painter.galley(at(self.plate.title), self.title, palette.text);
        if let Some([x, y, width, height]) = self.plate.bar {
            let bar = Rect::from_min_size(at([x, y]), vec2(width, height));
            painter.add(gradient(bar));
            painter.rect_stroke(bar, CornerRadius::ZERO, Stroke::new(1.0, palette.line), StrokeKind::Outside);
        }
        for (number, place) in self.numbers.into_iter().zip(self.plate.numbers) {
            painter.galley(at(place), number, palette.text);
        }
        for (([r, g, b], text), [square, words]) in self.colours.into_iter().zip(self.plate.colours) {
            let square = Rect::from_min_size(at(square), Vec2::splat(self.swatch));
            let (colour, stroke) = (Color32::from_rgb(r, g, b), Stroke::new(1.0, palette.weak));
            painter.rect(square, 2.0, colour, stroke, StrokeKind::Outside);
            painter.galley(at(words), text, palette.text);
        }
    }
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
