//! The bar below the views of a comparison: the layout, its choices, and the numbers.

use bevy_egui::egui::{
    self, Align, Button, Layout as Direction, Rect, Sense, Stroke, TextStyle, Ui, UiBuilder, WidgetInfo,
    WidgetType, vec2,
};

use crate::{
    compare::fitting_amplification,
    panel::{
        keys,
        segmented::{segment_width, segmented},
        state::{Action, CompareCommand, LARGEST, Session},
        theme::{self, Palette},
    },
    scene::{
        Comparison,
        comparison::{AMPLIFICATIONS, Channel, Compared, Edge, Layout, Sign},
    },
};

/// Height of a row of the bar, points.
pub(super) const ROW: f32 = 34.0;
/// In a narrower bar, the numbers have a row of their own.
pub(super) const NARROW: f32 = 560.0;

/// The layout, its choices, and the numbers.
pub(super) fn bar(ui: &mut Ui, rect: Rect, session: &Session, actions: &mut Vec<Action>) {
    let palette = Palette::here(ui);
    ui.painter().rect_filled(rect, 0.0, palette.panel);
    ui.painter().hline(rect.x_range(), rect.top(), Stroke::new(1.0, palette.line));
    let comparison = session.document.comparison;
    let row = |i: f32| {
        Rect::from_min_size(rect.min + vec2(0.0, i * ROW), vec2(rect.width(), ROW)).shrink2(vec2(6.0, 2.0))
    };
    // In the second row of a difference there is room for its largest.
    let first = |name: &str| comparison.layout != Layout::Difference || name != LARGEST;
    let left = |place: Rect| UiBuilder::new().max_rect(place).layout(Direction::left_to_right(Align::Center));
    ui.scope_builder(left(row(0.0)), |ui| {
        ui.set_clip_rect(ui.clip_rect().intersect(rect));
        let names: Vec<_> = Layout::ALL.iter().map(|layout| layout.name()).collect();
        let chosen = Layout::ALL.iter().position(|layout| *layout == comparison.layout);
        let tip = |ui: &mut Ui, i: usize| {
            ui.set_max_width(280.0);
            ui.label(Layout::ALL[i].summary());
            if Layout::ALL[i] == Layout::Blink {
                let key = keys::word(ui.ctx(), "blink");
                ui.label(theme::small(ui, format!("Hold {key} to see the other view.")));
            }
        };
        let width: f32 = names.iter().map(|name| segment_width(ui, name)).sum();
        let mut layout = comparison.layout;
        if width + 16.0 > rect.width() {
            choose(ui, "layout", Layout::ALL, &mut layout, Layout::name, Layout::summary);
        } else if let Some(i) = segmented(ui, "Layout", &names, chosen, tip) {
            layout = Layout::ALL[i];
        }
        if layout != comparison.layout {
            actions.push(Action::Compare(CompareCommand::Layout(layout)));
        }
        if rect.width() >= NARROW {
            let room = rect.width() - width - 28.0;
            ui.with_layout(Direction::right_to_left(Align::Center), |ui| numbers(ui, session, room, first));
        }
    });
    if rect.width() < NARROW {
        let last = row((rect.height() / ROW).round() - 1.0);
        let right = UiBuilder::new().max_rect(last).layout(Direction::right_to_left(Align::Center));
        ui.scope_builder(right, |ui| numbers(ui, session, last.width(), |_| true));
    }
    if !matches!(comparison.layout, Layout::Wipe | Layout::Difference) {
        return;
    }
    ui.scope_builder(left(row(1.0)), |ui| {
        ui.set_clip_rect(ui.clip_rect().intersect(rect));
        ui.spacing_mut().item_spacing.x = 8.0;
        let mut now = comparison;
        if comparison.layout == Layout::Wipe {
            let names: Vec<_> = Edge::ALL.iter().map(|edge| edge.name()).collect();
            let at = Edge::ALL.iter().position(|edge| *edge == comparison.edge);
            let tip = |ui: &mut Ui, i: usize| _ = ui.label(Edge::ALL[i].summary());
            ui.label(theme::small(ui, "edge"));
            if let Some(i) = segmented(ui, "Edge", &names, at, tip) {
                now.edge = Edge::ALL[i];
            }
        } else {
            let names: Vec<_> = Sign::ALL.iter().map(|sign| sign.name()).collect();
            let at = Sign::ALL.iter().position(|sign| *sign == comparison.sign);
            let tip = |ui: &mut Ui, i: usize| _ = ui.label(Sign::ALL[i].summary());
            if let Some(i) = segmented(ui, "Sign", &names, at, tip) {
                now.sign = Sign::ALL[i];
            }
            if rect.width() >= NARROW {
                chosen_values(ui, &mut now);
            }
            amplification(ui, session, &mut now);
        }
        if comparison.layout == Layout::Difference && rect.width() >= NARROW {
            let room = ui.available_width();
            let largest = |name: &str| name == LARGEST;
            ui.with_layout(Direction::right_to_left(Align::Center), |ui| numbers(ui, session, room, largest));
        }
        if now != comparison {
            actions.push(Action::Compare(CompareCommand::Set(now)));
        }
    });
    if comparison.layout == Layout::Difference && rect.width() < NARROW {
        let mut now = comparison;
        ui.scope_builder(left(row(2.0)), |ui| chosen_values(ui, &mut now));
        if now != comparison {
            actions.push(Action::Compare(CompareCommand::Set(now)));
        }
    }
}

/// The choice of what is compared.
fn chosen_values(ui: &mut Ui, now: &mut Comparison) {
    choose(ui, "channel", Channel::ALL, &mut now.channel, Channel::name, Channel::summary);
    choose(ui, "values", Compared::ALL, &mut now.values, Compared::name, Compared::summary);
}

/// The amplification: a number, or the one that fits the largest difference.
fn amplification(ui: &mut Ui, session: &Session, now: &mut Comparison) {
    let help = "Differences are multiplied by this before they become colours, 1 to 100.";
    ui.label(theme::small(ui, "amplify ×")).on_hover_text(help);
    // Where views are equal, no difference is largest.
    let largest = session.facts.comparison.as_ref().map(|numbers| numbers.largest.unwrap_or(0.0));
    let used = now.amplification.or_else(|| Some(fitting_amplification(now.values, largest?)));
    let mut factor = used.unwrap_or(*AMPLIFICATIONS.start());
    let mut field = egui::DragValue::new(&mut factor).range(AMPLIFICATIONS).speed(0.2).max_decimals(0);
    if used.is_none() {
        field = field.custom_formatter(|_, _| "…".to_owned());
    }
    if ui.add(field).on_hover_text(help).changed() {
        now.amplification = Some(factor);
    }
    let fits = now.amplification.is_none();
    let fit = ui.add(Button::new("auto").small().selected(fits));
    fit.widget_info(|| WidgetInfo::selected(WidgetType::Checkbox, true, fits, "Amplify automatically"));
    let fit = fit.on_hover_text("Amplify so that the largest difference has nearly the last colour.");
    if fit.clicked() {
        now.amplification = if fits { used } else { None };
    }
}

/// A list of choices.
fn choose<T: Copy + PartialEq>(
    ui: &mut Ui,
    label: &str,
    all: &[T],
    value: &mut T,
    name: fn(T) -> &'static str,
    summary: fn(T) -> &'static str,
) {
    ui.label(theme::small(ui, label));
    let list = egui::ComboBox::from_id_salt(("comparison", label)).selected_text(name(*value));
    let shown = list.show_ui(ui, |ui| {
        for choice in all {
            ui.selectable_value(value, *choice, name(*choice)).on_hover_text(summary(*choice));
        }
    });
    shown.response.on_hover_text(summary(*value));
}

/// Between two numbers, points.
const SPACE: f32 = 14.0;

/// Those numbers of the comparison that are wanted; those that have no room are left out.
fn numbers(ui: &mut Ui, session: &Session, room: f32, wanted: impl Fn(&str) -> bool) {
    let palette = Palette::here(ui);
    // Once, where the usual numbers would be.
    if let Some(reason) = session.no_difference() {
        if wanted("RMSE") {
            let later =
                "The difference is calculated once both pictures have all samples of light with extent.";
            let help = if session.incomparable().is_some() { &reason } else { later };
            let galley = theme::elided(ui, &reason, TextStyle::Body, palette.weak, room);
            let (rect, response) = ui.allocate_exact_size(galley.size(), Sense::hover());
            ui.painter().galley(rect.min, galley, palette.weak);
            response.widget_info(|| WidgetInfo::labeled(WidgetType::Label, true, &reason));
            response.on_hover_text(help);
        }
        return;
    }
    let Some(numbers) = session.facts.comparison.as_ref() else { return };
    let mut left = room;
    let entries = numbers.entries().filter(|(name, ..)| wanted(name));
    let laid_out = entries.map(|(name, value, help)| {
        let text = format!("{name} {value}").trim_end().to_owned();
        (theme::elided(ui, &text, TextStyle::Body, palette.text, f32::INFINITY), text, help)
    });
    let mut fits = |(galley, ..): &(std::sync::Arc<egui::Galley>, String, &str)| {
        left -= galley.size().x + SPACE;
        left >= 0.0
    };
    let shown: Vec<_> = laid_out.take_while(&mut fits).collect();
    // From right to left.
    for (galley, text, help) in shown.into_iter().rev() {
        let (rect, response) = ui.allocate_exact_size(galley.size(), Sense::hover());
        ui.painter().galley(rect.min, galley, palette.text);
        response.widget_info(|| WidgetInfo::labeled(WidgetType::Label, true, &text));
        response.on_hover_ui(|ui| {
            ui.set_max_width(320.0);
            ui.label(help);
        });
        ui.add_space(SPACE - ui.spacing().item_spacing.x);
    }
}
