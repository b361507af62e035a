//! The panels of a narrow window, such as that of a phone: one at a time below the picture, in the whole width. A row of
//! buttons chooses it; the list of panels says where each stands, and so which button it is behind.

use super::{
    context::{PanelContext, Panels},
    focus::{self, Region},
    glyphs,
    lesson::point,
    prelude::*,
    sides::{self, TABS},
    state::{CODE_TAB, EXPLAIN_TAB, PLOTS_TAB, PanelInfo, SHADER_TAB},
};

/// Margin at the sides, in points.
const SIDE: f32 = 6.0;
/// Minimum height of everything below the picture, in points: the buttons and a row of a panel.
const LEAST: f32 = 88.0;
/// Minimum size of the plots, whose list stands below the curves, in points.
const PLOTS: Vec2 = vec2(360.0, 420.0);
/// Minimum width of the content of *Explain*, *Code* and *Shader*, in points: in a narrower window, it is scrolled
/// sideways too.
const WIDE: f32 = 432.0;

/// Shows the buttons and the panel. `whole` is the window.
pub(super) fn below(ui: &mut Ui, panels: &mut Panels, whole: Rect, context: &mut PanelContext<'_>) {
    let session = context.session();
    let shown = session.view.in_front();
    let frame = theme::panel_frame(&Palette::of(&session.settings), vec2(SIDE, 2.0));
    let strip = egui::Panel::bottom(Id::new(("below the picture", shown.is_some()))).frame(frame);
    let strip = match shown {
        Some(_) => {
            let left = sides::left_below(ui, whole, whole.width(), context);
            strip.exact_size(left.max(LEAST).floor())
        }
        None => strip,
    };
    let response = strip.show(ui, |ui| {
        choices(ui, shown, panels, context);
        let Some(place) = shown else { return };
        let room = ui.available_rect_before_wrap();
        let mut inside = ui.new_child(UiBuilder::new().id_salt(place).max_rect(room));
        match place {
            Place::Bottom => tab(&mut inside, whole, panels, context),
            Place::Strip => panels.show(&mut inside, place, context),
            _ => sides::within(&mut inside, place, panels, context),
        }
        // What is too high for its place does not make it higher.
        ui.expand_to_include_rect(room);
    });
    let region = Region::Panel(shown.unwrap_or(Place::Bottom));
    focus::region(ui.ctx(), region, response.response.rect);
}

/// The buttons: one for each side, two where the lesson and the scene list share one, and a menu of all other panels.
fn choices(ui: &mut Ui, shown: Option<Place>, panels: &mut Panels, context: &mut PanelContext<'_>) {
    let session = context.session();
    let front = |place| vec![Action::View(ViewChange::Front(place))];
    let tree = session.lesson.as_ref().map(|open| open.tree_open);
    let left = shown == Some(Place::Left);
    let list = |open: bool| [front(Place::Left), vec![Action::Lesson(LessonCommand::Tree(open))]].concat();
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing = vec2(4.0, 2.0);
        if let Some(tree) = tree {
            choice(ui, "Lesson", left && !tree, list(false), context);
        }
        let actions = if tree.is_some() { list(true) } else { front(Place::Left) };
        let is_list = left && tree != Some(false);
        let button = choice(ui, "Scene", is_list, actions, context);
        if !is_list {
            point::behind(ui, Place::Left, button.rect);
        }
        let right = shown == Some(Place::Right);
        let button = choice(ui, "Properties", right, front(Place::Right), context);
        if !right {
            point::behind(ui, Place::Right, button.rect);
        }
        more(ui, shown, panels, context);
    });
}

/// A button that brings a panel to the front, or shows the picture alone if the panel is there.
fn choice(
    ui: &mut Ui,
    name: &str,
    on: bool,
    actions: Vec<Action>,
    context: &mut PanelContext<'_>,
) -> Response {
    let button = ui.add(Button::selectable(on, theme::strong(ui, name)));
    theme::says_chosen(&button, WidgetType::RadioButton, on, name);
    if button.clicked() {
        let alone = || vec![Action::View(ViewChange::Front(Place::Picture))];
        context.actions.extend(if on { alone() } else { actions });
    }
    if on {
        focus::first(ui.ctx(), button.id);
    }
    let tip =
        if on { "Show the picture alone".to_owned() } else { format!("Show below the picture: {name}") };
    button.on_hover_text(tip)
}

/// The menu of the panels at the bottom, and of the examples. It is called after the one that is shown.
fn more(ui: &mut Ui, shown: Option<Place>, panels: &mut Panels, context: &mut PanelContext<'_>) {
    let session = context.session();
    let mut all: Vec<_> = panels.at(Place::Bottom, session).map(|(info, _)| info).collect();
    all.extend(panels.at(Place::Strip, session).map(|(info, _)| info));
    let is_shown = |info: &PanelInfo| {
        shown == Some(info.place) && (info.place != Place::Bottom || info.id == session.view.bottom_tab)
    };
    let now = all.iter().find(|info| is_shown(info)).map_or("More", |info| info.title);
    let title = glyphs::legible(ui, now, "a panel").into_owned();
    let menu = ui.menu_button(theme::strong(ui, format!("{title} ▾")), |ui| {
        for info in &all {
            let title = glyphs::legible(ui, info.title, &format!("the panel “{}”", info.id));
            if ui.add(Button::selectable(is_shown(info), title.into_owned())).clicked() {
                context.act(Action::View(match info.place {
                    Place::Bottom => ViewChange::BottomTab(info.id.to_owned()),
                    place => ViewChange::Front(place),
                }));
                ui.close();
            }
        }
    });
    theme::says(&menu.response, WidgetType::ComboBox, "More panels");
    point::behind(ui, Place::Bottom, menu.response.rect);
}

/// The panel of the strip at the bottom that is chosen.
fn tab(ui: &mut Ui, whole: Rect, panels: &mut Panels, context: &mut PanelContext<'_>) {
    let session = context.session();
    let mut all: Vec<_> = panels.at(Place::Bottom, session).collect();
    let shown = all.iter().position(|(info, _)| info.id == session.view.bottom_tab).unwrap_or(0);
    let Some((info, panel)) = all.get_mut(shown) else { return };
    let high = sides::heights(info.id, whole).1 - TABS;
    let least = match info.id {
        PLOTS_TAB => PLOTS,
        EXPLAIN_TAB | CODE_TAB | SHADER_TAB => vec2(WIDE, high),
        _ => vec2(0.0, high),
    };
    sides::scrolled(ui, info, panel, least, context);
}
