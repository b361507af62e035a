//! The bar below the views of a comparison: the layout, its options, and the statistics.

use bevy_egui::egui::Layout as Direction;

use super::place::Arranging;
use crate::{
    panel::{
        prelude::*,
        segmented::{segment_width, values},
        state::LARGEST,
    },
    scene::comparison::Layout,
};

/// Height of a row of the bar, in points.
pub(super) const ROW: f32 = 34.0;
/// Width below which the statistics have a row of their own, in points.
pub(super) const NARROW: f32 = 560.0;

/// Shows the layout, its options, and the statistics.
pub(super) fn bar(
    ui: &mut Ui,
    rect: Rect,
    arranging: fn(Layout) -> &'static Arranging,
    context: &mut PanelContext<'_>,
) {
    let session = context.session();
    let palette = Palette::here(ui);
    ui.painter().rect_filled(rect, 0.0, palette.panel);
    ui.painter().hline(rect.x_range(), rect.top(), Stroke::new(1.0, palette.line));
    let comparison = session.document.comparison;
    let hint = |layout: Layout| arranging(layout).hint;
    let (arranging, wide) = (arranging(comparison.layout), rect.width() >= NARROW);
    let row = |i: f32| {
        Rect::from_min_size(rect.min + vec2(0.0, i * ROW), vec2(rect.width(), ROW)).shrink2(vec2(6.0, 2.0))
    };
    let left = |place: Rect| UiBuilder::new().max_rect(place).layout(Direction::left_to_right(Align::Center));
    let right = Direction::right_to_left(Align::Center);
    // In a low window there are fewer rows: the numbers go first, then the choices. The layouts are below, where they
    // stay as other rows come and go.
    let count = (rect.height() / ROW).round() as usize;
    let choices = arranging.rows[usize::from(!wide)];
    ui.scope_builder(left(row(count.saturating_sub(1) as f32)), |ui| {
        ui.set_clip_rect(ui.clip_rect().intersect(rect));
        let width = layouts(ui, rect.width(), comparison.layout, hint, context);
        if wide {
            let room = rect.width() - width - 28.0;
            let first = |name: &str| !arranging.largest_apart || name != LARGEST;
            ui.with_layout(right, |ui| numbers(ui, session, room, first));
        }
    });
    if !wide && count > choices + 1 {
        let above = row((count - 2) as f32);
        let place = UiBuilder::new().max_rect(above).layout(right);
        ui.scope_builder(place, |ui| numbers(ui, session, above.width(), |_| true));
    }
    for i in 0..choices.min(count.saturating_sub(1)) {
        let mut now = comparison;
        ui.scope_builder(left(row(i as f32)), |ui| {
            if i == 0 {
                ui.set_clip_rect(ui.clip_rect().intersect(rect));
                ui.spacing_mut().item_spacing.x = 8.0;
            }
            (arranging.choices)(ui, session, &mut now, i, wide);
            if arranging.largest_apart && wide {
                let room = ui.available_width();
                ui.with_layout(right, |ui| numbers(ui, session, room, |name| name == LARGEST));
            }
        });
        if now != comparison {
            context.act(Action::Compare(CompareCommand::Set(now)));
        }
    }
}

/// The choice of the layout: side by side, or as a list if `most` is too narrow. Returns its width side by side.
fn layouts(
    ui: &mut Ui,
    most: f32,
    shown: Layout,
    hint: impl Fn(Layout) -> Option<fn(&Context) -> String>,
    context: &mut PanelContext<'_>,
) -> f32 {
    let names: Vec<_> = Layout::ALL.iter().map(|layout| layout.name()).collect();
    let width: f32 = names.iter().map(|name| segment_width(ui, name)).sum();
    let tip = |ui: &mut Ui, layout: Layout| {
        ui.set_max_width(280.0);
        ui.label(layout.summary());
        if let Some(hint) = hint(layout) {
            ui.label(theme::small(ui, hint(ui.ctx())));
        }
    };
    let mut layout = shown;
    if width + 16.0 > most {
        choose(ui, "layout", Layout::ALL, &mut layout, Layout::name, Layout::summary, None);
    } else if let Some(other) = values(ui, "Layout", Layout::ALL, shown, Layout::name, tip) {
        layout = other;
    }
    if layout != shown {
        context.act(Action::Compare(CompareCommand::Layout(layout)));
    }
    width
}

/// A drop-down list of options, which is beside its label and as wide as its text, or without a label of a given width.
pub(super) fn choose<T: Copy + PartialEq>(
    ui: &mut Ui,
    label: &str,
    all: &[T],
    value: &mut T,
    name: fn(T) -> &'static str,
    summary: fn(T) -> &'static str,
    width: Option<f32>,
) {
    let list = egui::ComboBox::from_id_salt(("comparison", label)).selected_text(name(*value));
    let entries = |ui: &mut Ui| {
        for choice in all {
            ui.selectable_value(value, *choice, name(*choice)).on_hover_text(summary(*choice));
        }
    };
    let shown = match width {
        None => {
            ui.label(theme::small(ui, label));
            list.show_ui(ui, entries)
        }
        Some(width) => {
            let left = ui.cursor().left();
            let place = Rect::from_x_y_ranges(left..=left + width, ui.max_rect().y_range());
            let inside = UiBuilder::new().max_rect(place).layout(Direction::left_to_right(Align::Center));
            ui.scope_builder(inside, |ui| list.width(width).truncate().show_ui(ui, entries)).inner
        }
    };
    let help = summary(*value);
    shown.response.on_hover_text(match width {
        None => help.to_owned(),
        Some(_) => format!("{label}: {help}"),
    });
}

/// Space between two statistics, in points.
const SPACE: f32 = 14.0;

/// Shows the requested statistics of the comparison, leaving out those that do not fit.
fn numbers(ui: &mut Ui, session: &Session, room: f32, wanted: impl Fn(&str) -> bool) {
    let palette = Palette::here(ui);
    // Once, in place of the main statistics, unless it stands in place of the map.
    if let Some(reason) = session.no_difference() {
        if wanted("RMSE") && session.shown_for_map().is_none() {
            let later = "The difference is calculated once both pictures rest, with all samples of light with extent.";
            let help = if session.incomparable().is_some() { &reason } else { later };
            // In small letters, the row has room for two lines.
            let whole = theme::elided(ui, &reason, TextStyle::Body, palette.weak, f32::INFINITY);
            let two = || theme::lines(ui, &reason, TextStyle::Small, palette.weak, (room, 2));
            let galley = if whole.size().x <= room { whole } else { two() };
            let (rect, response) = ui.allocate_exact_size(galley.size(), Sense::hover());
            ui.painter().galley(rect.min, galley, palette.weak);
            theme::says(&response, WidgetType::Label, &reason);
            response.on_hover_text(help);
        }
        return;
    }
    let Some(numbers) = session.numbers() else { return };
    let mut left = room;
    let entries = numbers.entries().filter(|(name, ..)| wanted(name));
    let laid_out = entries.map(|(name, value, help)| {
        let text = format!("{name} {value}").trim_end().to_owned();
        (theme::elided(ui, &text, TextStyle::Body, palette.text, f32::INFINITY), text, help)
    });
    let mut fits = |(galley, ..): &(std::sync::Arc<Galley>, String, &str)| {
        left -= galley.size().x + SPACE;
        left >= 0.0
    };
    let shown: Vec<_> = laid_out.take_while(&mut fits).collect();
    // From right to left.
    for (galley, text, help) in shown.into_iter().rev() {
        let (rect, response) = ui.allocate_exact_size(galley.size(), Sense::hover());
        ui.painter().galley(rect.min, galley, palette.text);
        theme::says(&response, WidgetType::Label, text);
        theme::tip(response, 320.0, |ui| _ = ui.label(help));
        ui.add_space(SPACE - ui.spacing().item_spacing.x);
    }
}
