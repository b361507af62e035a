//! The bar at the top: document, menus, reflection, shading.

use bevy_egui::egui::{self, Align, Button, Key, Layout, RichText, Ui, WidgetInfo, WidgetType, vec2};

use super::{
    Panel, PanelContext, PanelInfo, Place, channels, chooser, compare,
    explain::{has_sides, lobe_entries},
    export, glyphs,
    history::HISTORY_TAB,
    keys::{self, Binding},
    labels,
    lesson::{list, point},
    maths, menu, model_override, pictures,
    segmented::{segment_width, segmented},
    state::{
        Action, HandleChange, HandleMode, MESSAGES_TAB, ModelCommand, PLOTS_TAB, SHADER_TAB, Session,
        ThemeChoice, View, ViewChange,
    },
    theme::{self, Palette},
    welcome,
};
use crate::document::Selection;
use crate::files::Shown as _;
use crate::{optics::TermSelection, registry::Registry};

/// See the module.
#[derive(Clone, Copy, Debug)]
pub struct TopBar;

impl Panel for TopBar {
    fn id(&self) -> &'static str {
        "top"
    }

    fn title(&self) -> &'static str {
        "Top bar"
    }

    fn place(&self) -> Place {
        Place::Top
    }

    fn show(&mut self, ui: &mut Ui, context: &mut PanelContext<'_>) {
        let (session, registry, actions) = (context.session(), context.registry(), &mut context.actions);
        let table = keys::bindings(session, registry);
        ui.horizontal(|ui| {
            ui.set_min_height(28.0);
            ui.spacing_mut().item_spacing.x = 4.0;
            document(ui, session, actions);
            divider(ui);
            menus(ui, session, registry, &table, actions);
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
            actions.extend(chooser::show(ui, session, registry));
            pointed(ui, "reflection", from);
            ui.add_space(8.0);
            if captioned {
                caption(ui, CAPTIONS[1]);
            }
            let from = ui.cursor().left();
            shading(ui, session, registry, &names, apart, actions);
            pointed(ui, "shading", from);
            model_override::whose(ui, session, registry);
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| renderer(ui, session));
        });
    }
}

/// A choice of this name is in the bar, from this place to the cursor.
fn pointed(ui: &Ui, name: &str, from: f32) {
    let to = ui.cursor().left() - ui.spacing().item_spacing.x;
    point::button(ui, name, ui.min_rect().with_min_x(from + 2.0).with_max_x(to - 2.0));
}

fn divider(ui: &mut Ui) {
    let palette = Palette::here(ui);
    let (rect, _) = ui.allocate_exact_size(vec2(9.0, 18.0), egui::Sense::hover());
    ui.painter().vline(rect.center().x, rect.y_range(), egui::Stroke::new(1.0, palette.line));
}

fn caption(ui: &mut Ui, text: &str) {
    let text = theme::small(ui, text);
    ui.label(text);
}

/// The captions of the choices.
const CAPTIONS: [&str; 2] = ["Reflection", "Shading"];

/// What stands in the place of the scene's name while a lesson is open.
const LESSON: &str = "Lesson";

/// The part of the title that is left for the scene's name beside a long name of its file.
const NAME: f32 = 0.45;

/// The scene's name in a place whose size depends on the window alone, so that the menus stand still.
fn document(ui: &mut Ui, session: &Session, actions: &mut Vec<Action>) {
    let palette = Palette::here(ui);
    let width = (0.16 * ui.max_rect().width()).clamp(88.0, 208.0);
    let (place, response) = ui.allocate_exact_size(vec2(width, 24.0), egui::Sense::click());
    if response.hovered() || response.has_focus() {
        let edge = if response.has_focus() { palette.accent } else { palette.hovered };
        let stroke = egui::Stroke::new(1.0, edge);
        ui.painter().rect(place, 4.0, palette.hovered, stroke, egui::StrokeKind::Inside);
    }
    let font = egui::FontId::new(egui::TextStyle::Body.resolve(ui.style()).size, theme::semibold());
    let line = |text: &str, room: f32| theme::elided(ui, text, font.clone(), palette.text, room);
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
        let rect = egui::Align2::LEFT_CENTER.anchor_size(at, galley.size());
        ui.painter().galley(rect.min, galley, palette.text);
        at.x = rect.right();
    }
    let state = if session.is_dirty() { "has unsaved changes" } else { "has no unsaved changes" };
    let own = session.own_title();
    response.widget_info(|| {
        WidgetInfo::labeled(WidgetType::Button, true, format!("{} {state}", session.window_title()))
    });
    if response.clicked() {
        actions.push(Action::Select(Selection::Room));
    }
    response.on_hover_ui(|ui| {
        ui.label(theme::strong(ui, session.title()));
        if let Some(description) = &session.document.description {
            ui.label(maths::prose(ui, description, egui::TextStyle::Body));
        }
        let file = session.path.as_ref().map_or("in no file yet".to_owned(), |p| p.shown().to_string());
        let said = match session.lesson {
            Some(_) => format!("a scene of the lesson; “{own}” {state}, and comes back when you leave"),
            None => format!("{file}; {state}"),
        };
        ui.label(theme::small(ui, said));
    });
    // The place of the dot is kept, so that nothing moves when it comes and goes.
    let (rect, dot) = ui.allocate_exact_size(vec2(10.0, 18.0), egui::Sense::hover());
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

/// Room for the longest entry and its key, points.
const MENU_WIDTH: f32 = 232.0;

fn menus(ui: &mut Ui, session: &Session, registry: &Registry, table: &[Binding], actions: &mut Vec<Action>) {
    let item = |ui: &mut Ui, text: &str, action: Action, actions: &mut Vec<Action>| {
        let keys = RichText::new(keys::keys_of(table, &action)).color(Palette::here(ui).weak);
        if ui.add(Button::new(text).shortcut_text(keys)).clicked() {
            actions.push(action);
            ui.close();
        }
    };
    let check = |ui: &mut Ui, text: &str, on: bool, keys: &str, action: Action, actions: &mut Vec<Action>| {
        let mut on = on;
        ui.horizontal(|ui| {
            if ui.checkbox(&mut on, text).clicked() {
                // A presentation has no menus.
                if matches!(action, Action::View(ViewChange::Presenting(true))) {
                    ui.close();
                }
                actions.push(action);
            }
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| ui.weak(keys));
        });
    };
    ui.scope(|ui| {
        egui::containers::menu::menu_style(ui.style_mut());
        ui.spacing_mut().item_spacing.x = 0.0;
        ui.spacing_mut().button_padding = vec2(7.0, 3.0);
        let file = ui.menu_button("File", |ui| {
            ui.set_width(MENU_WIDTH);
            item(ui, "New default scene", Action::New, actions);
            item(ui, "Open…", Action::OpenDialog, actions);
            menu::submenu(ui, "Open recent", |ui| {
                if session.recent_files.is_empty() {
                    ui.weak("Files that you open or save appear here.");
                    return;
                }
                for path in &session.recent_files {
                    let name = path
                        .file_name()
                        .map_or_else(|| path.shown().to_string(), |n| n.to_string_lossy().into_owned());
                    if ui.button(name).on_hover_text(path.shown().to_string()).clicked() {
                        actions.push(Action::Open(path.clone()));
                        ui.close();
                    }
                }
                ui.separator();
                item(ui, "Clear the list", Action::ClearRecent, actions);
            });
            let right = ui.max_rect().right();
            menu::submenu(ui, "Examples", |ui| welcome::menu(ui, right, registry, actions));
            ui.separator();
            item(ui, "Save", Action::Save, actions);
            item(ui, "Save as…", Action::SaveAsDialog, actions);
            ui.add_enabled_ui(session.path.is_some(), |ui| {
                item(ui, "Reload from disk", Action::Reload, actions)
            });
            ui.separator();
            pictures::menu(ui, session, table, actions);
            export::menu(ui, session, actions);
            ui.separator();
            item(ui, "Quit", Action::Quit, actions);
        });
        let edit = ui.menu_button("Edit", |ui| {
            ui.set_width(1.3 * MENU_WIDTH);
            let (done, steps) = (session.document.done(), session.document.steps().len());
            let step =
                |verb: &str, at: Option<usize>| match at.and_then(|at| session.document.steps().nth(at)) {
                    Some(name) => format!("{verb} “{name}”"),
                    None => verb.to_owned(),
                };
            let undo = done.checked_sub(1);
            ui.add_enabled_ui(undo.is_some(), |ui| item(ui, &step("Undo", undo), Action::Undo, actions));
            let redo = Some(done).filter(|done| *done < steps);
            ui.add_enabled_ui(redo.is_some(), |ui| item(ui, &step("Redo", redo), Action::Redo, actions));
            let history = Action::View(ViewChange::BottomTab(HISTORY_TAB.to_owned()));
            item(ui, "History…", history, actions);
            ui.separator();
            menu::submenu(ui, "Add a light", |ui| {
                for light in registry.lights() {
                    let d = light.declaration;
                    let glyph = glyphs::glyph(ui, d.glyph, d.name);
                    if ui.button(format!("{glyph}  {}", d.name)).on_hover_text(d.summary).clicked() {
                        actions.push(Action::AddLight(d.id.to_owned()));
                        ui.close();
                    }
                }
            });
            menu::submenu(ui, "Add an object", |ui| {
                for shape in registry.shapes() {
                    let d = shape.declaration;
                    let glyph = glyphs::glyph(ui, d.glyph, d.name);
                    if ui.button(format!("{glyph}  {}", d.name)).on_hover_text(d.summary).clicked() {
                        actions.push(Action::AddObject(d.id.to_owned()));
                        ui.close();
                    }
                }
            });
            ui.separator();
            let part = matches!(session.selection, Selection::Light(_) | Selection::Object(_));
            ui.add_enabled_ui(part, |ui| {
                item(ui, "Rename", Action::BeginRename(session.selection), actions);
                item(ui, "Duplicate", Action::Duplicate(session.selection), actions);
                item(ui, "Hide or switch off", Action::Toggle(session.selection), actions);
                item(ui, "Delete", Action::Remove(session.selection), actions);
            });
            ui.separator();
            item(ui, "New reflection model…", Action::Model(ModelCommand::New), actions);
            item(ui, "Duplicate the model as a file…", Action::Model(ModelCommand::Duplicate), actions);
            item(ui, "Open the model in an editor", Action::Model(ModelCommand::EditShown), actions);
            item(ui, "Export shaders for editing…", Action::Model(ModelCommand::ExportDialog), actions);
        });
        let view_menu = ui.menu_button("View", |ui| {
            ui.set_width(MENU_WIDTH);
            let most = ui.ctx().content_rect().height() - 48.0;
            egui::ScrollArea::vertical().max_height(most).min_scrolled_height(most).show(ui, |ui| {
                item(ui, "Home: the observer’s view", Action::HomeView, actions);
                item(ui, "Focus selection", Action::FocusSelection, actions);
                ui.add_enabled_ui(has_sides(ui.ctx(), session), |ui| {
                    item(ui, "Look from the side", Action::LookFromSide, actions);
                });
                let problem = session.observer_problem();
                let place =
                    |ui: &mut Ui| item(ui, "Set observer to this view", Action::ObserverFromView, actions);
                let place = ui.add_enabled_ui(problem.is_none(), place).response;
                problem.map(|why| place.on_hover_text(why));
                menu::submenu(ui, "Terms of the equation", |ui| {
                    for terms in session.offered_terms(registry) {
                        let name = match terms {
                            TermSelection::All => "All terms".to_owned(),
                            other => format!("The {} term alone", other.id()),
                        };
                        if ui.radio(session.terms() == terms, name).clicked() {
                            actions.push(Action::View(ViewChange::Terms(terms)));
                        }
                    }
                    ui.separator();
                    menu::submenu(ui, "Lobe at the explained point", |ui| lobe_entries(ui, session, actions));
                });
                menu::submenu(ui, "Compare", |ui| compare::entries(ui, session, table, actions));
                ui.separator();
                let v = &session.view;
                let view = |c: ViewChange| Action::View(c);
                menu::submenu(ui, "Marks", |ui| {
                    let lights = view(ViewChange::Gizmos(!v.show_gizmos));
                    check(ui, "Show light markers", v.show_gizmos, "", lights, actions);
                    let room = view(ViewChange::Room(!v.show_room));
                    check(ui, "Outline of the room", v.show_room, "", room, actions);
                });
                menu::submenu(ui, format!("Handles: {}", handles_word(v)), |ui| {
                    let show = view(ViewChange::Handles(HandleChange::Show(!v.show_handles)));
                    check(ui, "Show handles", v.show_handles, "", show, actions);
                    ui.separator();
                    for mode in HandleMode::ALL {
                        let on = v.show_handles && v.handles == mode;
                        if ui.radio(on, mode.name()).clicked() {
                            actions.push(view(ViewChange::Handles(HandleChange::Mode(mode))));
                            ui.close();
                        }
                    }
                    ui.separator();
                    let next = view(ViewChange::Handles(HandleChange::Mode(v.handles.next())));
                    item(ui, "Next", next, actions);
                });
                menu::submenu(ui, "Labels of objects", |ui| labels::entries(ui, session, actions));
                menu::submenu(ui, "Channel", |ui| {
                    channels::entries(ui, session, actions);
                    ui.separator();
                    let clipping = ViewChange::Clipping(!v.show_clipping);
                    check(ui, "Show clipped pixels", v.show_clipping, "", view(clipping), actions);
                });
                ui.separator();
                menu::submenu(ui, "Panels", |ui| {
                    ui.set_width(0.8 * MENU_WIDTH);
                    let (left, right) = (ViewChange::Left(!v.left_open), ViewChange::Right(!v.right_open));
                    let left_name =
                        if session.lesson.is_some() { "Lesson and scene list" } else { "Scene list" };
                    check(ui, left_name, v.left_open, "", view(left), actions);
                    check(ui, "Properties", v.right_open, "", view(right), actions);
                    let examples = ViewChange::Examples(!v.examples_open);
                    check(ui, "Examples", v.examples_open, "", view(examples), actions);
                    let beside = |p: &&PanelInfo| p.guest && matches!(p.place, Place::Left | Place::Right);
                    for panel in session.panels.iter().filter(beside) {
                        let side = if panel.place == Place::Left { v.left_open } else { v.right_open };
                        let shown = side && !v.hides(panel.id);
                        let change = ViewChange::Panel(panel.id.to_owned(), !shown);
                        let name = title(ui, panel);
                        check(ui, &name, shown, "", view(change), actions);
                    }
                    for panel in session.panels.iter().filter(|p| p.place == Place::Bottom) {
                        let shown = v.bottom_open && v.bottom_tab == panel.id;
                        let change = if shown {
                            ViewChange::Bottom(false)
                        } else {
                            ViewChange::BottomTab(panel.id.to_owned())
                        };
                        let key = match panel.id {
                            MESSAGES_TAB => "F8",
                            PLOTS_TAB => "F7",
                            SHADER_TAB => "F9",
                            _ => "",
                        };
                        let name = title(ui, panel);
                        check(ui, &name, shown, key, view(change), actions);
                    }
                });
                menu::submenu(ui, format!("Size of everything: {} %", v.scale), |ui| {
                    item(ui, "Larger", view(ViewChange::Larger), actions);
                    item(ui, "Smaller", view(ViewChange::Smaller), actions);
                    item(ui, "100 %", view(ViewChange::Scale(100)), actions);
                });
                menu::submenu(ui, "Theme", |ui| {
                    for (choice, name) in [(ThemeChoice::Dark, "Dark"), (ThemeChoice::Light, "Light")] {
                        if ui.radio(v.theme == choice, name).clicked() {
                            actions.push(view(ViewChange::Theme(choice)));
                        }
                    }
                });
                let presenting = view(ViewChange::Presenting(!v.presenting));
                check(ui, "Presentation", v.presenting, "F5", presenting, actions);
                check(
                    ui,
                    "Full screen",
                    v.fullscreen,
                    "F11",
                    view(ViewChange::Fullscreen(!v.fullscreen)),
                    actions,
                );
            });
        });
        let help = ui.menu_button("Help", |ui| {
            ui.set_width(MENU_WIDTH);
            item(ui, "Manual", Action::Manual, actions);
            item(ui, "Keys and mouse", Action::View(ViewChange::Keys(!session.view.keys_open)), actions);
            menu::submenu(ui, "Lessons", |ui| list::entries(ui, session, actions));
            item(ui, "About", Action::View(ViewChange::About(true)), actions);
        });
        let bar = [(Key::F, file), (Key::E, edit), (Key::V, view_menu), (Key::H, help)];
        for ((_, menu), name) in bar.iter().zip(["File", "Edit", "View", "Help"]) {
            point::menu(ui, name, menu.response.rect);
        }
        menu::bar(ui.ctx(), &bar.map(|(key, menu)| (key, menu.response)));
    });
}

/// What the handles do, in a word.
fn handles_word(view: &View) -> String {
    if view.show_handles { view.handles.name().to_lowercase() } else { "hidden".to_owned() }
}

/// The title of a panel in menus.
fn title(ui: &Ui, panel: &PanelInfo) -> String {
    glyphs::legible(ui, panel.title, &format!("the panel “{}”", panel.id)).into_owned()
}

/// One button for each shading model, as one control.
fn shading(
    ui: &mut Ui,
    session: &Session,
    registry: &Registry,
    names: &[&str],
    apart: bool,
    actions: &mut Vec<Action>,
) {
    let chosen = registry.shading_models().iter().position(|m| m.declaration.id == session.shading_shown());
    let tip = |ui: &mut Ui, i: usize| {
        let d = registry.shading_models()[i].declaration;
        ui.set_max_width(300.0);
        ui.label(theme::strong(ui, format!("{} shading", d.name)));
        ui.label(d.summary);
        ui.label(theme::small(ui, format!("{} · computed {} · key {}", d.author, d.stage.phrase(), d.key)));
    };
    let picked = if apart {
        segmented(ui, "Shading", names, chosen, tip)
    } else {
        let shown = chosen.map_or("–", |i| names[i]);
        let mut by_key = false;
        let menu =
            egui::ComboBox::from_id_salt("shading").width(88.0).selected_text(shown).show_ui(ui, |ui| {
                let mut picked = None;
                for (i, name) in names.iter().enumerate() {
                    let response = menu::choice(ui, chosen == Some(i), *name, &mut by_key);
                    if response.clicked() {
                        picked = Some(i);
                    }
                    response.on_hover_ui(|ui| tip(ui, i));
                }
                picked
            });
        menu.response
            .widget_info(|| WidgetInfo::labeled(WidgetType::ComboBox, true, format!("Shading: {shown}")));
        if by_key {
            menu.response.request_focus();
        }
        menu.inner.flatten()
    };
    if let Some(i) = picked {
        actions.push(Action::Edit(session.edit_shading_model(registry.shading_models()[i].declaration.id)));
    }
}

/// Lays out every digit in every place of a frame rate. A glyph that is drawn for the first time reaches
/// the GPU a frame late, so that a rate that changes with every frame would show gaps.
fn prepare_digits(ui: &Ui) {
    let font = egui::TextStyle::Small.resolve(ui.style());
    ui.fonts_mut(|fonts| {
        for digit in 0..10 {
            let text = format!("{digit}{digit}{digit}{digit} fps");
            fonts.layout_no_wrap(text, font.clone(), egui::Color32::WHITE);
        }
    });
}

fn renderer(ui: &mut Ui, session: &Session) {
    if ui.available_width() < 40.0 {
        return;
    }
    let facts = &session.facts;
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
    let text = theme::small(ui, parts.join(" · "));
    ui.add(egui::Label::new(text).truncate()).on_hover_ui(|ui| {
        ui.label(format!("{:.2} ms per frame", facts.frame_ms));
        if !facts.adapter.is_empty() {
            ui.label(&facts.adapter);
        }
    });
}
