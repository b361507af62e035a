//! The list of keys, and "about".

use bevy_egui::egui::{
    self, Align2, Color32, Id, Label, RichText, ScrollArea, Sense, TextStyle, Ui, Vec2, WidgetInfo,
    WidgetType, Window, vec2,
};

use super::{
    keys,
    state::{Action, Session, ViewChange},
    theme,
};
use crate::registry::Registry;

/// The least width of the window in which the list has two columns, points.
const TWO_COLUMNS: f32 = 1000.0;

/// The width of the line around a window, points.
const EDGE: f32 = 1.0;

/// Shows the windows that are open.
pub fn show(ctx: &egui::Context, session: &Session, registry: &Registry) -> Vec<Action> {
    let mut actions = Vec::new();
    let screen = ctx.content_rect();
    let wide = if screen.width() < TWO_COLUMNS { 560.0 } else { 720.0 };
    let wide = f32::min(wide, screen.width() - 48.0);
    let mut open = session.view.keys_open;
    Window::new(RichText::new("Keys and mouse").heading())
        .id(Id::new("keys"))
        .open(&mut open)
        .collapsible(false)
        .resizable(false)
        // It would stay as wide as it was at another size of everything.
        .max_width(wide + ctx.global_style().spacing.window_margin.sum().x + 2.0 * EDGE)
        .anchor(Align2::CENTER_CENTER, Vec2::ZERO)
        .show(ctx, |ui| {
            ui.set_width(wide);
            ScrollArea::vertical()
                .auto_shrink([false, true])
                .min_scrolled_height(screen.height() - 140.0)
                .max_height(screen.height() - 140.0)
                .show(ui, |ui| key_list(ui, session, registry));
        });
    if open != session.view.keys_open {
        actions.push(Action::View(ViewChange::Keys(open)));
    }
    let mut open = session.view.about_open;
    Window::new(RichText::new("About").heading())
        .id(Id::new("about"))
        .open(&mut open)
        .collapsible(false)
        .resizable(false)
        .default_width(480.0)
        .anchor(Align2::CENTER_CENTER, Vec2::ZERO)
        .show(ctx, |ui| about(ui, session, registry));
    if open != session.view.about_open {
        actions.push(Action::View(ViewChange::About(open)));
    }
    if ctx.input(|i| i.key_pressed(egui::Key::Escape)) {
        for (open, close) in [
            (session.view.keys_open, ViewChange::Keys(false)),
            (session.view.about_open, ViewChange::About(false)),
        ] {
            if open {
                actions.push(Action::View(close));
            }
        }
    }
    actions
}

fn key_list(ui: &mut Ui, session: &Session, registry: &Registry) {
    let bindings = keys::bindings(session, registry).into_iter();
    let mut rows: Vec<(&str, String, String)> =
        bindings.map(|b| (b.group.name(), b.keys(), b.label)).collect();
    rows.extend(
        keys::ELSEWHERE.iter().map(|(group, key, label)| (*group, (*key).to_owned(), (*label).to_owned())),
    );
    let mut groups: Vec<&str> = Vec::new();
    for (group, ..) in &rows {
        if !groups.contains(group) {
            groups.push(group);
        }
    }
    // Two columns of about the same length.
    let half = rows.len().div_ceil(2);
    let mut left = Vec::new();
    let mut right = Vec::new();
    let mut count = 0;
    for group in groups {
        let size = rows.iter().filter(|r| r.0 == group).count();
        if count + size / 2 <= half {
            left.push(group)
        } else {
            right.push(group)
        }
        count += size;
    }
    ui.spacing_mut().interact_size.y = 20.0;
    // The scroll bar floats over this margin.
    ui.set_width(ui.available_width() - 12.0);
    // Where there is no room for two, the second goes on below the first.
    let narrow = ui.ctx().content_rect().width() < TWO_COLUMNS;
    let columns = if narrow { vec![[left, right].concat()] } else { vec![left, right] };
    let font = TextStyle::Body.resolve(ui.style());
    let line = ui.text_style_height(&TextStyle::Body);
    ui.columns(columns.len(), |uis| {
        for (ui, groups) in uis.iter_mut().zip(columns) {
            // Descriptions begin in line in all groups.
            let here = rows.iter().filter(|row| groups.contains(&row.0));
            let width = |key: &str| {
                let text = ui.painter().layout_no_wrap(key.to_owned(), font.clone(), Color32::WHITE);
                text.size().x
            };
            let keys = here.map(|row| width(&row.1)).fold(0.0, f32::max).ceil();
            for group in groups {
                ui.label(theme::strong(ui, group));
                for (_, key, label) in rows.iter().filter(|row| row.0 == group) {
                    ui.horizontal_top(|ui| {
                        let colour = theme::Palette::here(ui).accent;
                        let (place, response) = ui.allocate_exact_size(vec2(keys, line), Sense::hover());
                        response.widget_info(|| WidgetInfo::labeled(WidgetType::Label, true, key));
                        ui.painter().text(place.min, Align2::LEFT_TOP, key, font.clone(), colour);
                        ui.add(Label::new(label).wrap());
                    });
                }
                ui.add_space(10.0);
            }
        }
    });
}

fn about(ui: &mut Ui, session: &Session, registry: &Registry) {
    ui.label(theme::strong(ui, format!("Lights, Camera, Models!  {}", env!("CARGO_PKG_VERSION"))));
    ui.add(egui::Label::new(env!("CARGO_PKG_DESCRIPTION")).wrap());
    ui.add_space(8.0);
    let line = format!(
        "{} reflection models · {} shading models · {} light types · {} object types",
        registry.models().len(),
        registry.shading_models().len(),
        registry.lights().len(),
        registry.shapes().len()
    );
    ui.add(egui::Label::new(theme::small(ui, line)).wrap());
    if !session.facts.adapter.is_empty() {
        ui.add(
            egui::Label::new(theme::small(
                ui,
                format!("{} · {}", session.facts.adapter, session.facts.backend),
            ))
            .wrap(),
        );
    }
    let licence =
        format!("Licence: {}. Type: Inter and STIX, SIL Open Font License 1.1.", env!("CARGO_PKG_LICENSE"));
    ui.add(egui::Label::new(theme::small(ui, licence)).wrap());
}
