//! The list of keys, and "about".

use bevy_egui::egui::Window;

use super::{keys, narrow, prelude::*};
use crate::program;

/// The least width of the window in which the list has two columns, points.
const TWO_COLUMNS: f32 = 1000.0;

/// The width of the line around a window, points.
const EDGE: f32 = 1.0;

/// The id of the list of keys, and its name.
pub(super) const KEYS: [&str; 2] = ["keys", "Keys and mouse"];
/// The id of the window about the program, and its name.
pub(super) const ABOUT: [&str; 2] = ["about", "About"];

/// The list of keys.
pub(super) fn keys_window(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let (session, registry, screen) = (context.session(), context.registry(), ui.ctx().content_rect());
    let wide = if screen.width() < TWO_COLUMNS { 560.0 } else { 720.0 };
    let wide = f32::min(wide, screen.width() - 48.0);
    // It would stay as wide as it was at another size of everything.
    let most = wide + ui.ctx().global_style().spacing.window_margin.sum().x + 2.0 * EDGE;
    let high = screen.height() - 140.0;
    let size = |window: Window<'static>| window.max_width(most);
    let open = session.view.keys_open;
    window(ui, KEYS, open, ViewChange::Keys(false), size, context, |ui| {
        ui.set_width(wide);
        let scroll = ScrollArea::vertical().auto_shrink([false, true]).min_scrolled_height(high);
        scroll.max_height(high).show(ui, |ui| key_list(ui, session, registry));
    });
}

/// Version and licences.
pub(super) fn about_window(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let (session, registry) = (context.session(), context.registry());
    let width = narrow::wide(ui.ctx(), 480.0, ui.spacing().window_margin.sum().x);
    let size = |window: Window<'static>| window.default_width(width);
    let (open, close) = (session.view.about_open, ViewChange::About(false));
    window(ui, ABOUT, open, close, size, context, |ui| about(ui, session, registry));
}

/// Shows the window of a panel while it is open. The button in its corner and Escape make the change `close`.
fn window(
    ui: &Ui,
    [id, title]: [&str; 2],
    is_open: bool,
    close: ViewChange,
    size: impl FnOnce(Window<'static>) -> Window<'static>,
    context: &mut PanelContext<'_>,
    content: impl FnOnce(&mut Ui),
) {
    let anchored = |window: Window<'static>| size(window.anchor(Align2::CENTER_CENTER, Vec2::ZERO));
    if !theme::window(ui, id, title, is_open, anchored, content) && is_open {
        context.act(Action::View(close));
    }
}

/// A line of the list: its group, its keys, and what they do.
type Row = (&'static str, String, String);

fn key_list(ui: &mut Ui, session: &Session, registry: &Registry) {
    let bindings = keys::bindings(session, registry).into_iter();
    let mut rows: Vec<Row> = bindings.map(|b| (b.group.name(), b.keys(), b.label)).collect();
    rows.extend(keys::ELSEWHERE.iter().map(|(group, key, label)| (*group, (*key).into(), (*label).into())));
    let [left, right] = halves(&rows);
    ui.spacing_mut().interact_size.y = 20.0;
    // The scroll bar floats over this margin.
    ui.set_width(ui.available_width() - 12.0);
    // Where there is no room for two, the second goes on below the first.
    let narrow = ui.ctx().content_rect().width() < TWO_COLUMNS;
    let columns = if narrow { vec![[left, right].concat()] } else { vec![left, right] };
    ui.columns(columns.len(), |uis| {
        for (ui, groups) in uis.iter_mut().zip(columns) {
            column(ui, &groups, &rows);
        }
    });
}

/// The groups in two columns of about the same length.
fn halves(rows: &[Row]) -> [Vec<&'static str>; 2] {
    let mut columns = [Vec::new(), Vec::new()];
    let mut count = 0;
    for (group, ..) in rows {
        if !columns.iter().flatten().any(|known| known == group) {
            let size = rows.iter().filter(|r| r.0 == *group).count();
            columns[usize::from(count + size / 2 > rows.len().div_ceil(2))].push(*group);
            count += size;
        }
    }
    columns
}

fn column(ui: &mut Ui, groups: &[&str], rows: &[Row]) {
    let colour = theme::Palette::here(ui).accent;
    let font = TextStyle::Body.resolve(ui.style());
    let line = ui.text_style_height(&TextStyle::Body);
    // Descriptions begin in line in all groups.
    let here = rows.iter().filter(|row| groups.contains(&row.0));
    let width =
        |key: &str| ui.painter().layout_no_wrap(key.to_owned(), font.clone(), Color32::WHITE).size().x;
    let keys = here.map(|row| width(&row.1)).fold(0.0, f32::max).ceil();
    for group in groups {
        ui.label(theme::strong(ui, *group));
        for (_, key, label) in rows.iter().filter(|row| row.0 == *group) {
            if narrow::is(ui.ctx()) {
                ui.add(Label::new(RichText::new(key).color(colour)).wrap());
                ui.add(Label::new(label).wrap());
                continue;
            }
            ui.horizontal_top(|ui| {
                let (place, response) = ui.allocate_exact_size(vec2(keys, line), Sense::hover());
                theme::says(&response, WidgetType::Label, key);
                ui.painter().text(place.min, Align2::LEFT_TOP, key, font.clone(), colour);
                ui.add(Label::new(label).wrap());
            });
        }
        ui.add_space(10.0);
    }
}

fn about(ui: &mut Ui, session: &Session, registry: &Registry) {
    let version = env!("CARGO_PKG_VERSION");
    if program::name() == program::LAB {
        ui.label(theme::strong(ui, format!("{}  {version}", program::title())));
        ui.add(Label::new(env!("CARGO_PKG_DESCRIPTION")).wrap());
    } else {
        // Its own version is not known.
        ui.label(theme::strong(ui, program::title()));
        ui.add(Label::new(format!("Made with {} {version}.", program::LAB_TITLE)).wrap());
    }
    ui.add_space(8.0);
    let line = format!(
        "{} reflection models · {} shading models · {} light types · {} object types",
        registry.models().len(),
        registry.shading_models().len(),
        registry.lights().len(),
        registry.shapes().len()
    );
    theme::note(ui, line);
    if !session.facts.adapter.is_empty() {
        theme::note(ui, format!("{} · {}", session.facts.adapter, session.facts.backend));
    }
    let licence =
        format!("Licence: {}. Type: Inter and STIX, SIL Open Font License 1.1.", env!("CARGO_PKG_LICENSE"));
    theme::note(ui, licence);
}
