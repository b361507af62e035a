//! The window used only with the keyboard, without a window: where the focus moves, and that it is visible.

use bevy_egui::egui::{self, Event, Key, Modifiers, PointerButton, Popup, Rect, vec2};
use lights_camera_models::{
    document::Selection,
    panel::{
        state::{
            Action, Badge, Effect, MATERIALS_TAB, MaterialCommand, ModelCommand, Offer, Question, Session,
            Severity, Steer, TakeCommand, Taken, ViewChange,
        },
        theme::DARK,
    },
    parameter::Value,
    scene::{Object, Scene, Variant},
};

use crate::window::panels::Bench;

fn focused(bench: &Bench) -> Option<Rect> {
    let id = bench.ctx.memory(egui::Memory::focused)?;
    bench.ctx.viewport(|v| v.prev_pass.widgets.get(id).map(|w| w.rect))
}

/// True if the focused widget is completely visible.
fn in_sight(bench: &Bench) -> bool {
    let id = bench.ctx.memory(egui::Memory::focused);
    let widget = id.and_then(|id| bench.ctx.viewport(|v| v.prev_pass.widgets.get(id).copied()));
    widget.is_some_and(|w| w.interact_rect.expand(0.5).contains_rect(w.rect))
}

/// The name of the focused widget.
fn name(bench: &Bench) -> String {
    let Some(rect) = focused(bench) else { return "nothing".to_owned() };
    // The tree contains the smaller widgets within it too.
    let seen = bench.tree.iter().filter(|s| !s.label.is_empty());
    let near = seen.min_by(|a, b| {
        let apart = |s: &Rect| (s.min - rect.min).length() + (s.max - rect.max).length();
        apart(&a.rect).total_cmp(&apart(&b.rect))
    });
    near.map_or_else(String::new, |s| s.label.clone())
}

/// Frames in the accent colour.
fn rings(bench: &mut Bench) -> Vec<Rect> {
    let shapes = bench.shapes();
    shapes
        .iter()
        .filter_map(|shape| match shape {
            egui::Shape::Rect(r) if r.stroke.color == DARK.accent && r.stroke.width > 1.0 => Some(r.rect),
            _ => None,
        })
        .collect()
}

#[test]
fn f6_goes_from_panel_to_panel_and_back_to_the_picture() {
    let mut bench = Bench::new(Session::default());
    let mut places = Vec::new();
    for _ in 0..4 {
        bench.key(Key::F6, Modifiers::NONE);
        places.push(focused(&bench).map(|r| (r.center().x, r.center().y)));
    }
    let [Some(top), Some(left), Some(right), Some(status)] = places[..] else { panic!("{places:?}") };
    assert!(top.1 < 40.0 && status.1 > 1500.0 && left.0 < 210.0 && right.0 > 900.0, "{places:?}");
    bench.key(Key::F6, Modifiers::NONE);
    assert_eq!(focused(&bench), None, "the picture has the keys again");
    bench.key(Key::F6, Modifiers::SHIFT);
    assert_eq!(focused(&bench).map(|r| r.center().y), Some(status.1), "backwards");
}

#[test]
fn f6_finds_the_tab_that_is_shown_and_not_the_edge_of_its_panel() {
    let mut bench = Bench::new(Session::default());
    bench.apply(Action::View(ViewChange::Bottom(true)));
    bench.apply(Action::View(ViewChange::BottomTab(MATERIALS_TAB.to_owned())));
    bench.settle();
    for _ in 0..4 {
        bench.key(Key::F6, Modifiers::NONE);
    }
    assert_eq!(name(&bench), "Materials");
}

#[test]
fn every_focus_is_seen() {
    let mut bench = Bench::with_model("phong");
    bench.key(Key::F6, Modifiers::NONE);
    let mut seen = 0;
    for _ in 0..60 {
        bench.key(Key::Tab, Modifiers::NONE);
        if bench.ctx.text_edit_focused() {
            continue;
        }
        let Some(rect) = focused(&bench) else { continue };
        let visible = Rect::from_min_size(egui::Pos2::ZERO, bench.size).intersect(rect);
        let ring = rings(&mut bench).into_iter().any(|r| r.expand(4.0).contains_rect(visible));
        assert!(ring, "nothing shows that {rect:?} has the focus");
        let senses = bench
            .ctx
            .memory(egui::Memory::focused)
            .and_then(|id| bench.ctx.viewport(|v| v.prev_pass.widgets.get(id).map(|w| w.sense)));
        assert!(
            senses.is_some_and(|s| s.senses_click()),
            "Tab stops at what only the mouse can use: {rect:?}"
        );
        seen += 1;
    }
    assert!(seen > 20, "{seen}");
}

#[test]
fn menus_opened_by_mouse_listen_to_the_arrows_and_enter() {
    let mut bench = Bench::new(Session::default());
    bench.click("Edit");
    bench.key(Key::ArrowDown, Modifiers::NONE);
    let first = focused(&bench).expect("the first entry");
    assert!(first.height() < 40.0, "an entry, not the menu as a whole");
    bench.key(Key::ArrowDown, Modifiers::NONE);
    let second = focused(&bench).expect("the second entry");
    assert!(second.top() > first.top() && (second.left() - first.left()).abs() < 2.0);
    bench.key(Key::ArrowUp, Modifiers::NONE);
    assert_eq!(focused(&bench), Some(first));
    // The entry above the first one is the last.
    bench.key(Key::ArrowUp, Modifiers::NONE);
    assert!(focused(&bench).expect("the last entry").top() > second.top());
    bench.key(Key::Escape, Modifiers::NONE);
    bench.click("View");
    bench.key(Key::ArrowDown, Modifiers::NONE);
    bench.effects.clear();
    bench.key(Key::Enter, Modifiers::NONE);
    assert_eq!(bench.effects, [Effect::HomeView]);
}

#[test]
fn keys_steer_the_camera_unless_a_panel_has_them() {
    let mut bench = Bench::with_model("phong");
    bench.key(Key::ArrowLeft, Modifiers::NONE);
    assert_eq!(bench.effects, [Effect::Steer(Steer::Turn(-5.0, 0.0))]);
    bench.effects.clear();
    bench.key(Key::ArrowUp, Modifiers::SHIFT);
    bench.key(Key::PageUp, Modifiers::NONE);
    assert_eq!(bench.effects, [Effect::Steer(Steer::Move(0.0, 1.0)), Effect::Steer(Steer::Zoom(0.9))]);
    bench.effects.clear();
    bench.key(Key::F6, Modifiers::NONE);
    bench.key(Key::ArrowLeft, Modifiers::NONE);
    assert!(bench.effects.is_empty());
}

#[test]
fn a_new_name_takes_the_place_of_the_old_one() {
    let mut bench = Bench::new(Session::default());
    bench.apply(Action::Select(Selection::Object(0)));
    bench.key(Key::F2, Modifiers::NONE);
    bench.frame(vec![egui::Event::Text("ball".to_owned())]);
    bench.settle();
    bench.key(Key::Enter, Modifiers::NONE);
    assert_eq!(bench.session.document.objects[0].name.as_deref(), Some("ball"));
}

#[test]
fn the_menus_open_with_alt_and_with_f10() {
    let mut bench = Bench::new(Session::default());
    bench.key(Key::E, Modifiers::ALT);
    assert!(bench.says("New reflection model…"), "Alt+E opens Edit");
    let first = focused(&bench).expect("its first entry");
    bench.key(Key::V, Modifiers::ALT);
    assert!(!bench.says("New reflection model…") && bench.says("Focus selection"), "Alt+V: View");
    bench.key(Key::E, Modifiers::ALT);
    assert_eq!(focused(&bench), Some(first), "Edit again");
    bench.key(Key::Escape, Modifiers::NONE);
    bench.key(Key::F10, Modifiers::NONE);
    assert!(bench.says("New default scene"), "F10 opens the first menu");
    bench.key(Key::F10, Modifiers::NONE);
    assert!(!bench.says("New default scene"), "and closes it");
    // A letter with Alt is not a command of the picture.
    let shading = bench.session.document.shading_model.clone();
    bench.key(Key::F, Modifiers::ALT);
    assert_eq!(bench.session.document.shading_model, shading);
}

#[test]
fn what_gets_the_focus_comes_into_sight() {
    let mut bench = Bench::with_everything();
    bench.size = vec2(1280.0, 480.0);
    bench.settle();
    (0..3).for_each(|_| bench.key(Key::F6, Modifiers::NONE));
    for way in [Modifiers::NONE, Modifiers::SHIFT] {
        for i in 0..30 {
            bench.key(Key::Tab, way);
            assert!(in_sight(&bench), "{i} {way:?}: {} at {:?}", name(&bench), focused(&bench));
        }
    }
}

#[test]
fn arrows_in_the_scene_list_select_the_row_they_lead_to() {
    let scene = Scene { objects: vec![Object::default(); 60], ..Scene::default() };
    let mut bench = Bench::new(Session::new(scene));
    bench.size = vec2(1280.0, 480.0);
    bench.apply(Action::Select(Selection::Room));
    (0..2).for_each(|_| bench.key(Key::F6, Modifiers::NONE));
    for i in 0..40 {
        bench.key(Key::ArrowDown, Modifiers::NONE);
        assert!(in_sight(&bench), "{i}");
    }
    // Room, observer, one light.
    assert_eq!(bench.session.selection, Selection::Object(40 - 3));
    (0..39).for_each(|_| bench.key(Key::ArrowUp, Modifiers::NONE));
    assert_eq!(bench.session.selection, Selection::Observer);
    assert!(in_sight(&bench) && name(&bench) == "Observer");
}

#[test]
fn the_menu_of_a_row_is_about_what_is_selected() {
    let mut bench = Bench::new(Session::default());
    bench.apply(Action::Duplicate(Selection::Object(0)));
    bench.apply(Action::Select(Selection::Room));
    let row = bench.find("Observer").expect("listed").rect.center();
    bench.click_at(row, PointerButton::Secondary);
    assert_eq!(bench.session.selection, Selection::Observer);
}

#[test]
fn a_deletion_keeps_the_selection_and_is_said_with_a_way_back() {
    let mut bench = Bench::new(Session::default());
    (0..2).for_each(|_| bench.apply(Action::Duplicate(Selection::Object(0))));
    bench.apply(Action::Select(Selection::Object(2)));
    let before = bench.session.document.scene().clone();
    bench.apply(Action::Remove(Selection::Object(0)));
    assert_eq!(bench.session.selection, Selection::Object(1), "the same object");
    assert!(bench.says("Deleted “"), "{:?}", bench.session.messages);
    bench.click("Undo");
    assert_eq!(*bench.session.document.scene(), before);
    // Undo is not offered where it would undo something else.
    bench.apply(Action::Remove(Selection::Object(0)));
    bench.apply(Action::Edit(bench.session.edit_shading_model("flat")));
    assert!(bench.session.messages.iter().all(|note| note.offer.is_none()));
}

#[test]
fn after_the_name_come_the_buttons_and_the_bin_last() {
    let mut bench = Bench::new(Session::default());
    bench.apply(Action::Select(Selection::Object(0)));
    let at = bench.field("Name").rect.center();
    bench.click_at(at, PointerButton::Primary);
    for says in ["Look at", "Duplicate", "Delete"] {
        bench.key(Key::Tab, Modifiers::NONE);
        assert!(name(&bench).starts_with(says), "{says}: {}", name(&bench));
    }
}

#[test]
fn menus_open_with_the_focus_on_their_first_entry_and_arrows_change_them() {
    let mut bench = Bench::new(Session::default());
    for (key, modifiers) in [(Key::F, Modifiers::ALT), (Key::F10, Modifiers::NONE)] {
        bench.key(key, modifiers);
        assert!(name(&bench).starts_with("New default scene"), "{}", name(&bench));
        bench.key(Key::Escape, Modifiers::NONE);
    }
    bench.key(Key::F, Modifiers::ALT);
    bench.key(Key::ArrowRight, Modifiers::NONE);
    assert!(bench.says("New reflection model…") && !bench.says("New default scene"));
    assert!(focused(&bench).is_some_and(|r| r.height() < 40.0));
    bench.key(Key::ArrowLeft, Modifiers::NONE);
    bench.key(Key::ArrowLeft, Modifiers::NONE);
    assert!(name(&bench).starts_with("Manual"), "{}", name(&bench));
}

/// In a slow frame, Alt may be up again when its letter arrives.
#[test]
fn the_letter_that_opens_a_menu_is_not_typed_into_a_field() {
    let mut bench = Bench::new(Session::default());
    bench.apply(Action::Select(Selection::Object(0)));
    bench.settle();
    let at = bench.field("Name").rect.center();
    bench.click_at(at, PointerButton::Primary);
    assert!(bench.ctx.text_edit_focused());
    let says = |bench: &mut Bench, words: &str| bench.texts().iter().any(|text| text.contains(words));
    bench.frame(vec![Event::Text("zq".to_owned())]);
    assert!(says(&mut bench, "zq"), "letters are typed");
    let (modifiers, changed) = (Modifiers::ALT, Event::ModifiersChanged);
    let key = Event::Key { key: Key::V, physical_key: None, pressed: true, repeat: false, modifiers };
    let letter = Event::Text("v".to_owned());
    bench.frame(vec![changed(Modifiers::ALT), key, letter, changed(Modifiers::NONE)]);
    bench.settle();
    assert!(!says(&mut bench, "zqv") && Popup::is_any_open(&bench.ctx));
}

fn pressed(key: Key, modifiers: Modifiers) -> Event {
    Event::Key { key, physical_key: None, pressed: true, repeat: false, modifiers }
}

/// The letters of menus are known by their keys: others in the same frame are text.
#[test]
fn only_the_letter_with_alt_is_dropped() {
    let mut bench = Bench::new(Session::default());
    bench.apply(Action::Select(Selection::Object(0)));
    bench.settle();
    let at = bench.field("Name").rect.center();
    bench.click_at(at, PointerButton::Primary);
    let text = |text: &str| Event::Text(text.to_owned());
    let none = Modifiers::NONE;
    // A keyboard sends a letter before its key. With Alt, even a letter without a menu is no text.
    let mut all = vec![text("q"), pressed(Key::Q, none), text("x"), pressed(Key::X, Modifiers::ALT)];
    all.extend([text("z"), pressed(Key::Z, none), Event::ModifiersChanged(Modifiers::ALT)]);
    bench.frame(all);
    bench.frame(vec![text("ö")]);
    bench.frame(vec![Event::ModifiersChanged(none)]);
    bench.settle();
    let has = |bench: &mut Bench, words: &str| bench.texts().iter().any(|text| text.contains(words));
    assert!(has(&mut bench, "qz") && !has(&mut bench, "qzö"), "{:?}", bench.texts());
}

/// The keys that open the dialog about a new model.
const NEW_MODEL: Modifiers = Modifiers { ctrl: true, shift: true, command: true, ..Modifiers::NONE };

/// In slow frames, more keys are pressed before the dialog is in sight.
#[test]
fn keys_pressed_before_a_dialog_is_in_sight_are_for_it() {
    let typed = || Event::Text("Student toon".to_owned());
    let rest = || vec![pressed(Key::E, Modifiers::ALT), typed(), pressed(Key::Enter, Modifiers::NONE)];
    let is_new = |effect: &Effect| matches!(effect, Effect::NewModel { id, .. } if id == "student_toon");
    for in_one_frame in [true, false] {
        let mut bench = Bench::new(Session::default());
        // A menu behind has the focus, which Enter would open.
        bench.key(Key::F6, Modifiers::NONE);
        assert!(focused(&bench).is_some());
        let before = bench.session.document.scene().clone();
        let new = pressed(Key::N, NEW_MODEL);
        if in_one_frame {
            bench.frame([vec![new], rest()].concat());
        } else {
            bench.frame(vec![new]);
            bench.frame(rest());
        }
        bench.settle();
        assert!(bench.effects.iter().any(is_new), "{in_one_frame}: {:?}", bench.effects);
        assert!(!Popup::is_any_open(&bench.ctx) && *bench.session.document.scene() == before);
        bench.frame(vec![pressed(Key::N, NEW_MODEL), pressed(Key::Escape, Modifiers::NONE)]);
        bench.settle();
        assert_eq!(bench.session.authoring.draft, None, "Escape, too");
    }
}

#[test]
fn no_click_before_a_dialog_is_in_sight_opens_a_menu_over_it() {
    let mut bench = Bench::new(Session::default());
    let at = bench.find("Edit").expect("a menu").rect.center();
    let press = |pressed| Event::PointerButton {
        pos: at,
        button: PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    };
    bench.frame(vec![Event::PointerMoved(at)]);
    bench.frame(vec![pressed(Key::N, NEW_MODEL)]);
    bench.frame(vec![press(true), press(false)]);
    bench.settle();
    assert!(bench.session.authoring.draft.is_some() && !Popup::is_any_open(&bench.ctx));
    bench.click("Edit");
    assert!(!Popup::is_any_open(&bench.ctx), "nor later");
}

#[test]
fn a_click_beside_a_dialog_leaves_the_keys_to_its_field() {
    let mut bench = Bench::new(Session::default());
    bench.apply(Action::Model(ModelCommand::New));
    assert!(bench.ctx.text_edit_focused(), "the name");
    let menu = bench.find("Edit").expect("a menu").rect.center();
    for at in [menu, bench.area.rect.left_top() + vec2(30.0, 30.0)] {
        bench.click_at(at, PointerButton::Primary);
        assert!(bench.ctx.text_edit_focused(), "after a click at {at:?}");
    }
    bench.letter(Key::Q, "q");
    let name = bench.session.authoring.draft.as_ref().map(|draft| draft.name.clone());
    assert!(name.as_ref().is_some_and(|name| name.ends_with('q')), "{name:?}");
    // Without the dialog, a click takes the focus again.
    bench.key(Key::Escape, Modifiers::NONE);
    bench.key(Key::F6, Modifiers::NONE);
    let menu = focused(&bench);
    assert!(menu.is_some());
    bench.click_at(bench.area.rect.left_top() + vec2(30.0, 30.0), PointerButton::Primary);
    assert_ne!(focused(&bench), menu);
}

#[test]
fn a_question_that_follows_another_begins_at_its_safe_answer() {
    let copy = |title: &str| {
        let scene = Err("what is odd".to_owned());
        let file = format!("{title}.json").into();
        let (title, when) = (title.to_owned(), "5 minutes ago".to_owned());
        Question::Recover(Box::new(Offer { title, path: None, file, when, scene }))
    };
    let mut bench = Bench::new(Session::default());
    bench.session.questions.ask(copy("first"));
    bench.settle();
    assert_eq!(name(&bench), "Keep the copy");
    bench.key(Key::Tab, Modifiers::NONE);
    assert_eq!(name(&bench), "Delete it");
    bench.session.questions.ask(copy("other"));
    bench.settle();
    assert_eq!(name(&bench), "Keep the copy");
}

#[test]
fn every_dialog_has_the_keys_to_itself() {
    type Opens = fn(&mut Bench);
    let dialogs: [(&str, Opens); 5] = [
        ("model", |b| b.apply(Action::Model(ModelCommand::New))),
        ("material", |b| {
            b.apply(Action::Select(Selection::Object(0)));
            b.apply(Action::Material(MaterialCommand::Ask));
        }),
        ("match", |b| crate::comparing::matching::ask(b, "blinn_phong")),
        ("picture", |b| b.apply(Action::Take(TakeCommand::Ask(Taken::Picture(None))))),
        ("question", |b| {
            b.session.questions.ask(Question::EmptyFile("a.json".into()));
            b.settle();
        }),
    ];
    for (name, open) in dialogs {
        let scene = Scene {
            reflection_model: "phong".to_owned(),
            variants: vec![Variant::default()],
            ..Scene::default()
        };
        let mut bench = Bench::new(Session::new(scene));
        open(&mut bench);
        assert!(bench.find("Cancel").is_some() && !bench.area.has_keys, "{name} is open");
        let before = bench.session.document.scene().clone();
        bench.click_at(bench.area.rect.left_top() + vec2(30.0, 30.0), PointerButton::Primary);
        bench.key(Key::V, Modifiers::ALT);
        bench.key(Key::F10, Modifiers::NONE);
        assert!(!Popup::is_any_open(&bench.ctx), "{name}: no menu");
        bench.letter(Key::F, "f");
        bench.key(Key::F1, Modifiers::NONE);
        assert_eq!(*bench.session.document.scene(), before, "{name}");
        assert!(bench.find("Cancel").is_some(), "{name}: nothing closed it");
        bench.key(Key::Escape, Modifiers::NONE);
        assert!(bench.find("Cancel").is_none() && bench.area.has_keys, "{name}: Escape is for it");
    }
}

#[test]
fn right_goes_into_a_menu_within_a_menu_and_left_comes_back() {
    let mut bench = Bench::new(Session::default());
    let to = |bench: &mut Bench, entry: &str| {
        for _ in 0..20 {
            if name(bench).starts_with(entry) {
                return;
            }
            bench.key(Key::ArrowDown, Modifiers::NONE);
        }
        panic!("never at {entry}");
    };
    bench.key(Key::E, Modifiers::ALT);
    to(&mut bench, "Add a light");
    let parent = focused(&bench).expect("the entry");
    for open in [Key::ArrowRight, Key::Enter] {
        bench.key(open, Modifiers::NONE);
        let first = focused(&bench).expect("the first light");
        assert!(first.left() > parent.left() + 20.0, "{open:?}: within the menu that hangs there");
        bench.key(Key::ArrowDown, Modifiers::NONE);
        let second = focused(&bench).expect("the second light");
        assert!(second.top() > first.top() && (second.left() - first.left()).abs() < 2.0, "{open:?}");
        bench.key(Key::ArrowLeft, Modifiers::NONE);
        assert_eq!(focused(&bench), Some(parent), "{open:?}");
    }
    bench.key(Key::ArrowRight, Modifiers::NONE);
    bench.key(Key::Enter, Modifiers::NONE);
    assert_eq!(bench.session.document.lights.len(), 2);
    assert!(!Popup::is_any_open(&bench.ctx));
}

#[test]
fn entries_scrolled_out_of_a_long_menu_are_reached() {
    let mut bench = Bench::new(Session::default());
    bench.size = vec2(1280.0, 360.0);
    bench.settle();
    bench.key(Key::V, Modifiers::ALT);
    bench.key(Key::ArrowUp, Modifiers::NONE);
    assert!(name(&bench).starts_with("Full screen"), "{}", name(&bench));
    assert!(in_sight(&bench));
}

#[test]
fn enter_closes_a_drop_down_list_and_its_button_has_the_focus() {
    let mut bench = Bench::new(Session::default());
    bench.apply(Action::Select(Selection::Light(0)));
    let button = bench.tree.iter().find(|s| s.label.starts_with("type: ")).expect("a list of types").rect;
    bench.click_at(button.center(), PointerButton::Primary);
    let before = bench.session.document.lights[0].light_type.clone();
    bench.key(Key::ArrowDown, Modifiers::NONE);
    bench.key(Key::ArrowDown, Modifiers::NONE);
    bench.key(Key::Enter, Modifiers::NONE);
    assert_ne!(bench.session.document.lights[0].light_type, before);
    assert!(!Popup::is_any_open(&bench.ctx));
    assert!(name(&bench).starts_with("type: "), "{}", name(&bench));
}

#[test]
fn f6_reaches_the_examples_and_the_badges_and_shows_that_the_picture_has_the_keys() {
    let mut bench = Bench::new(Session::default());
    bench.session.disk.badge = Some(Badge {
        severity: Severity::Info,
        text: "Not what it seems".to_owned(),
        shorter: Vec::new(),
        help: "The whole story.".to_owned(),
    });
    bench.apply(Action::View(ViewChange::Examples(true)));
    (0..5).for_each(|_| bench.key(Key::F6, Modifiers::NONE));
    assert!(focused(&bench).is_some_and(|r| r.top() > bench.area.rect.bottom()), "{}", name(&bench));
    let picture = bench.area.rect;
    let around = |bench: &mut Bench| {
        rings(bench).into_iter().any(|r| picture.contains_rect(r) && r.width() > picture.width() - 8.0)
    };
    assert!(!around(&mut bench));
    bench.key(Key::F6, Modifiers::NONE);
    assert_eq!(focused(&bench), None);
    assert!(around(&mut bench));
    bench.key(Key::F6, Modifiers::NONE);
    assert!(name(&bench).starts_with("Outside the view: "), "{}", name(&bench));
    bench.key(Key::Tab, Modifiers::NONE);
    assert_eq!(name(&bench), "Not what it seems");
    assert!(bench.says("The whole story.") && !around(&mut bench));
    bench.key(Key::F6, Modifiers::NONE);
    assert!(focused(&bench).is_some_and(|r| r.top() < 40.0), "the first panel again");
}

#[test]
fn f6_to_the_scene_list_leads_to_the_row_that_is_selected() {
    let mut bench = Bench::new(Session::default());
    for (part, row) in [(Selection::Light(0), "Point 1"), (Selection::Observer, "Observer")] {
        bench.apply(Action::Select(part));
        (0..2).for_each(|_| bench.key(Key::F6, Modifiers::NONE));
        assert_eq!(name(&bench), row);
        assert_eq!(bench.session.selection, part, "to look is not to select");
        bench.key(Key::Escape, Modifiers::NONE);
    }
}

#[test]
fn arrows_in_a_drop_down_list_begin_at_what_is_chosen() {
    let mut bench = Bench::new(Session::default());
    bench.apply(Action::Select(Selection::Light(0)));
    let types: Vec<_> = bench.registry.lights().iter().map(|l| l.declaration.name).collect();
    let id = &bench.session.document.lights[0].light_type;
    let chosen = bench.registry.light_index(id).expect("known") as usize;
    let count = types.len();
    for (key, expected) in
        [(Key::ArrowDown, (chosen + 1) % count), (Key::ArrowUp, (chosen + count - 1) % count)]
    {
        let button = bench.tree.iter().find(|s| s.label.starts_with("type: ")).expect("a list").rect;
        bench.click_at(button.center(), PointerButton::Primary);
        bench.key(key, Modifiers::NONE);
        assert_eq!(name(&bench), types[expected], "{key:?} from {}", types[chosen]);
        bench.key(Key::Escape, Modifiers::NONE);
    }
}

#[test]
fn the_chosen_entry_of_a_long_list_is_whole_when_it_opens_and_so_is_each_that_gets_the_focus() {
    let mut scene = Scene::default();
    scene.lights[0].light_type = "environment".to_owned();
    scene.lights[0].position = None;
    for (name, value) in [("source", "sky"), ("sky_type", "12")] {
        scene.lights[0].parameters.set(name, Value::Choice(value.into()));
    }
    let mut bench = Bench::new(Session::new(scene));
    bench.size = vec2(1280.0, 720.0);
    bench.apply(Action::Select(Selection::Light(0)));
    let button = bench.tree.iter().find(|s| s.label.starts_with("type of sky: ")).expect("a list").rect;
    bench.click_at(button.center(), PointerButton::Primary);
    let entry = bench.tree.iter().find(|s| s.label.starts_with("12 ")).expect("an entry").rect;
    let whole = bench.ctx.viewport(|viewport| {
        let mut all = viewport.prev_pass.widgets.layers().flat_map(|(_, all)| all);
        let is_entry =
            |w: &egui::WidgetRect| (w.rect.min - entry.min).length() < 1.0 && w.sense.senses_click();
        all.any(|w| is_entry(w) && w.interact_rect.expand(0.5).contains_rect(w.rect))
    });
    assert!(whole, "{entry} is cut");
    for key in [Key::ArrowDown, Key::ArrowUp, Key::ArrowUp, Key::ArrowDown] {
        bench.key(key, Modifiers::NONE);
        assert!(in_sight(&bench), "{} at {:?}", name(&bench), focused(&bench));
    }
}
