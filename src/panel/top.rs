//! The bar at the top: document, menus, reflection, shading.

use super::{
    chooser,
    command::{self, Menu, show},
    explain::has_sides,
    keys,
    lesson::{list, point},
    maths, menu, model_override, narrow,
    prelude::*,
    segmented::{segment_width, segmented},
    state::Facts,
    welcome,
};
use crate::text::facts;

/// See the module.
pub(super) fn show(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let (session, registry) = (context.session(), context.registry());
    if narrow::is(ui.ctx()) {
        ui.horizontal(|ui| in_narrow(ui, context));
        return;
    }
    ui.horizontal(|ui| {
        ui.set_min_height(28.0);
        ui.spacing_mut().item_spacing.x = 4.0;
        document(ui, context);
        divider(ui);
        menus(ui, context);
        divider(ui);
        // Where there is little room, the captions go first, then the choices of shading fold up.
        let names: Vec<_> = registry.shading_models().iter().map(|m| m.declaration.name).collect();
        let buttons = names.iter().map(|n| segment_width(ui, n)).sum::<f32>() + 4.0;
        let captions = CAPTIONS.iter().map(|c| theme::small_width(ui, c) + 4.0).sum::<f32>();
        let left = ui.available_width() - chooser::WIDTH - 8.0 - 2.0 * 4.0;
        let (captioned, apart) = (left >= captions + buttons, left >= buttons);
        if captioned {
            caption(ui, CAPTIONS[0]);
        }
        let from = ui.cursor().left();
        chooser::show(ui, chooser::WIDTH, context);
        pointed(ui, "reflection", from);
        ui.add_space(8.0);
        if captioned {
            caption(ui, CAPTIONS[1]);
        }
        let from = ui.cursor().left();
        shading(ui, &names, apart, context);
        pointed(ui, "shading", from);
        model_override::whose(ui, session, registry);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| renderer(ui, &session.facts));
    });
}

/// The bar of a narrow window: all menus in one, the choices, and the scene's name if there is room. Where there is none
/// for both choices, that of shading is in the menu.
fn in_narrow(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let (session, registry) = (context.session(), context.registry());
    ui.spacing_mut().item_spacing.x = 4.0;
    let beside = SHADING + 12.0;
    let folds = ui.available_width() < SIGN + LEAST + beside;
    let menu = one_menu(ui, folds, context);
    let from = ui.cursor().left();
    let width = ui.available_width() - if folds { 0.0 } else { beside };
    chooser::show(ui, width.clamp(LEAST, chooser::WIDTH), context);
    pointed(ui, "reflection", from);
    if folds {
        point::button(ui, "shading", menu);
    } else {
        let from = ui.cursor().left();
        let names: Vec<_> = registry.shading_models().iter().map(|m| m.declaration.name).collect();
        shading(ui, &names, false, context);
        pointed(ui, "shading", from);
    }
    model_override::whose(ui, session, registry);
    if ui.available_width() >= NAMED {
        document(ui, context);
    }
}

/// A choice of this name is in the bar, from this place to the cursor.
fn pointed(ui: &Ui, name: &str, from: f32) {
    let to = ui.cursor().left() - ui.spacing().item_spacing.x;
    point::button(ui, name, ui.min_rect().with_min_x(from + 2.0).with_max_x(to - 2.0));
}

fn divider(ui: &mut Ui) {
    let (rect, _) = ui.allocate_exact_size(vec2(9.0, 18.0), Sense::hover());
    ui.painter().vline(rect.center().x, rect.y_range(), Stroke::new(1.0, Palette::here(ui).line));
}

fn caption(ui: &mut Ui, text: &str) {
    ui.label(theme::small(ui, text));
}

/// Width of the list of shading models, in points.
const SHADING: f32 = 100.0;
/// Width of the button for the menus where it is a sign alone, with the space beside it, in points.
const SIGN: f32 = 36.0;
/// Minimum width of the button for the reflection model, in points.
const LEAST: f32 = 64.0;
/// Width of a narrow bar from which on the button for the menus has a word beside its sign, in points.
const WORD: f32 = 320.0;
/// Room in a narrow bar from which on it has the scene's name, in points.
const NAMED: f32 = 120.0;

/// The captions of the choices.
const CAPTIONS: [&str; 2] = ["Reflection", "Shading"];

/// The text in place of the scene's name while a lesson is open.
const LESSON: &str = "Lesson";

/// The part of the title that is left for the scene's name beside a long name of its file.
const NAME: f32 = 0.45;

/// The scene's name in a place whose size depends on the window alone, so that the menus stand still.
fn document(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let session = context.session();
    let palette = Palette::here(ui);
    let width = (0.16 * ui.max_rect().width()).clamp(88.0, 208.0);
    let (place, response) = ui.allocate_exact_size(vec2(width, 24.0), Sense::click());
    if theme::is_hot(&response) {
        let edge = if response.has_focus() { palette.accent } else { palette.hovered };
        ui.painter().rect(place, 4.0, palette.hovered, Stroke::new(1.0, edge), StrokeKind::Inside);
    }
    let line = |text: &str, room: f32| theme::elided(ui, text, theme::bold(ui), palette.text, room);
    let (mut title, mut whole, room) = (session.title(), session.window_title(), width - 8.0);
    // The lesson says its title itself.
    if session.lesson.is_some() && session.view.left_open {
        (title, whole) = (LESSON.to_owned(), LESSON.to_owned());
    }
    // The file has its share where both do not fit, unless it repeats the name.
    let mut file = whole.strip_prefix(&title).unwrap_or_default();
    if line(&title, f32::INFINITY).size().x + line(file, f32::INFINITY).size().x > room
        && repeats(&title, file)
    {
        file = "";
    }
    let name = line(&title, (room - line(file, room).size().x).max(NAME * room));
    let file = line(file, room - name.size().x);
    let mut at = place.left_center() + vec2(4.0, 0.0);
    for galley in [name, file].into_iter().filter(|g| g.size().x > 0.0) {
        let rect = Align2::LEFT_CENTER.anchor_size(at, galley.size());
        ui.painter().galley(rect.min, galley, palette.text);
        at.x = rect.right();
    }
    let state = if session.is_dirty() { "has unsaved changes" } else { "has no unsaved changes" };
    let own = session.own_title();
    theme::says(&response, WidgetType::Button, format!("{} {state}", session.window_title()));
    context.on_click(&response, || Action::Select(Selection::Room));
    response.on_hover_ui(|ui| {
        ui.label(theme::strong(ui, session.title()));
        if let Some(description) = &session.document.description {
            ui.label(maths::prose(ui, description, TextStyle::Body));
        }
        let file =
            session.path.as_ref().map_or("not saved to a file yet".to_owned(), |p| p.shown().to_string());
        let said = match session.lesson {
            Some(_) => format!("a scene of the lesson; “{own}” {state}, and comes back when you leave"),
            None => format!("{file}; {state}"),
        };
        ui.label(theme::small(ui, said));
    });
    // The place of the dot is kept, so that nothing moves when it comes and goes.
    let (rect, dot) = ui.allocate_exact_size(vec2(10.0, 18.0), Sense::hover());
    if session.shows_unsaved() {
        ui.painter().circle_filled(rect.center(), 3.5, palette.accent);
        dot.on_hover_text("Unsaved changes");
    }
}

/// True if all words of a file's name are in a title.
fn repeats(title: &str, file: &str) -> bool {
    let words = |text: &str| -> Vec<String> {
        text.to_lowercase().split(|c: char| !c.is_alphanumeric()).map(str::to_owned).collect()
    };
    let known = words(title);
    let file = std::path::Path::new(file).file_stem().unwrap_or_default().to_string_lossy();
    words(&file).iter().all(|word| word.is_empty() || known.contains(word))
}

/// What menus have beside their entries; see [`show::Special`].
fn beside<'s>(
    session: &'s Session,
    registry: &'s Registry,
) -> impl Fn(&mut Ui, &Menu, f32, &mut Vec<Action>) + 's {
    move |ui, menu, right, actions| match menu.name {
        command::EXAMPLES => welcome::menu(ui, right, registry, actions),
        command::LESSONS => list::entries(ui, session, actions),
        _ => {}
    }
}

/// The menus as one, of which each is an entry, after the choice of shading if that `folds` into it. Returns the place of
/// its button.
fn one_menu(ui: &mut Ui, folds: bool, context: &mut PanelContext<'_>) -> Rect {
    let (session, registry) = (context.session(), context.registry());
    let words = if ui.available_width() >= WORD { "☰ Menu" } else { "☰" };
    let button = ui.menu_button(words, |ui| {
        let all = command::all(session, registry, has_sides(ui.ctx(), session));
        if folds {
            menu::submenu(ui, "Shading", |ui| shading_entries(ui, context));
        }
        for (_, name) in command::BAR {
            let Some(menu) = all.find(name) else { continue };
            let special = beside(session, registry);
            menu::submenu(ui, name, |ui| show::content(ui, menu, &special, &mut context.actions));
        }
    });
    theme::says(&button.response, WidgetType::Button, "Menu");
    for (_, name) in command::BAR {
        point::menu(ui, name, button.response.rect);
    }
    let place = button.response.rect;
    menu::bar(ui.ctx(), &[("Menu", button.response)]);
    place
}

/// The shading models as entries of a menu.
fn shading_entries(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let (session, registry) = (context.session(), context.registry());
    for d in registry.shading_models().iter().map(|model| model.declaration) {
        if ui.radio(session.shading_shown() == d.id, d.name).on_hover_text(d.summary).clicked() {
            context.edit(session.edit_shading_model(d.id));
            ui.close();
        }
    }
}

fn menus(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let (session, registry) = (context.session(), context.registry());
    let beside = beside(session, registry);
    ui.scope(|ui| {
        egui::containers::menu::menu_style(ui.style_mut());
        ui.spacing_mut().item_spacing.x = 0.0;
        ui.spacing_mut().button_padding = vec2(7.0, 3.0);
        let bar = command::BAR.map(|(_, name)| {
            let menu = ui.menu_button(name, |ui| {
                let all = command::all(session, registry, has_sides(ui.ctx(), session));
                if let Some(menu) = all.find(name) {
                    show::content(ui, menu, &beside, &mut context.actions);
                }
            });
            point::menu(ui, name, menu.response.rect);
            (name, menu.response)
        });
        menu::bar(ui.ctx(), &bar);
    });
}

/// One button for each shading model, as one control.
fn shading(ui: &mut Ui, names: &[&str], apart: bool, context: &mut PanelContext<'_>) {
    let (session, registry) = (context.session(), context.registry());
    let chosen = registry.shading_models().iter().position(|m| m.declaration.id == session.shading_shown());
    let tip = |ui: &mut Ui, i: usize| {
        let d = registry.shading_models()[i].declaration;
        ui.set_max_width(300.0);
        ui.label(theme::strong(ui, format!("{} shading", d.name)));
        ui.label(d.summary);
        let mut said = facts([d.author, &format!("computed {}", d.stage.phrase())]);
        if let Some(key) = keys::of(ui.ctx(), &format!("shading.{}", d.id)) {
            said.push_str(&format!(" · key {key}"));
        }
        ui.label(theme::small(ui, said));
    };
    let picked = if apart {
        segmented(ui, "Shading", names, chosen, tip)
    } else {
        let combo = egui::ComboBox::from_id_salt("shading").width(SHADING).truncate();
        menu::list(ui, combo, "Shading", names, chosen, tip).1
    };
    if let Some(i) = picked {
        context.edit(session.edit_shading_model(registry.shading_models()[i].declaration.id));
    }
}

/// Lays out every digit in every place of a frame rate. A glyph that is drawn for the first time reaches
/// the GPU a frame late, so that a rate that changes with every frame would show gaps.
fn prepare_digits(ui: &Ui) {
    let font = TextStyle::Small.resolve(ui.style());
    ui.fonts_mut(|fonts| {
        for digit in 0..10 {
            let text = format!("{digit}{digit}{digit}{digit} fps");
            fonts.layout_no_wrap(text, font.clone(), Color32::WHITE);
        }
    });
}

fn renderer(ui: &mut Ui, facts: &Facts) {
    if ui.available_width() < 40.0 {
        return;
    }
    let mut parts = Vec::new();
    if facts.fps() > 0.0 {
        parts.push(format!("{:.0} fps", facts.fps()));
    }
    if !facts.backend.is_empty() {
        parts.push(facts.backend.clone());
    }
    if ui.available_width() < 100.0 {
        parts.truncate(1);
    }
    if parts.is_empty() {
        return;
    }
    prepare_digits(ui);
    ui.add(Label::new(theme::small(ui, parts.join(" · "))).truncate()).on_hover_ui(|ui| {
        ui.label(format!("{:.2} ms per frame", facts.frame_ms));
        if !facts.adapter.is_empty() {
            ui.label(&facts.adapter);
        }
    });
}
