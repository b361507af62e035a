//! The finder of commands, and keys of the user's own.

use std::{collections::BTreeMap, sync::LazyLock};

use bevy_egui::egui::{Event, Key, Modifiers, vec2};
use lights_camera_models::{
    custom,
    document::{Edit, Selection},
    panel::{
        Panels,
        command::{Command, Group, Menu, all, declared, with_keys},
        keys::bindings,
        settings::Settings,
        state::{Action, Effect, LessonSource, Session, Shortcut, ViewChange},
    },
    registry::Registry,
    scene::{Part, Scene},
};

use crate::window::panels::Bench;

fn bench() -> Bench {
    let mut bench = Bench::new(Session::default());
    bench.size = vec2(1280.0, 720.0);
    bench.settle();
    bench
}

/// A window whose settings have these keys.
fn with_keys_of(json: &str) -> Bench {
    let mut session = Session::default();
    let settings = format!("{{ \"keys\": {json} }}");
    session.adopt(serde_json::from_str::<Settings>(&settings).expect("settings"));
    let mut bench = Bench::new(session);
    bench.size = vec2(1280.0, 720.0);
    bench.settle();
    bench
}

/// The usual keys of commands, as they are declared.
static USUAL: LazyLock<BTreeMap<String, Vec<Shortcut>>> = LazyLock::new(|| {
    let root = commands();
    each(&root).into_iter().map(|command| (command.id.to_string(), command.keys.clone())).collect()
});

/// The first of the usual keys of a command.
fn usual(id: &str) -> Shortcut {
    *USUAL.get(id).and_then(|keys| keys.first()).unwrap_or_else(|| panic!("{id} has no key"))
}

/// Presses the usual key of a command.
fn press(bench: &mut Bench, id: &str) {
    let Shortcut { ctrl, shift, alt, key } = usual(id);
    let held = if ctrl { Modifiers::COMMAND } else { Modifiers::NONE };
    bench.key(key, Modifiers { shift, alt, ..held });
}

fn open(bench: &mut Bench) {
    press(bench, "find");
    assert!(bench.session.view.finder_open && bench.ctx.text_edit_focused());
}

fn write(bench: &mut Bench, text: &str) {
    bench.frame(vec![Event::Text(text.to_owned())]);
    bench.settle();
}

#[test]
fn the_finder_makes_way_for_a_question() {
    let mut bench = bench();
    bench.apply(Action::Edit(Edit::set(Part::Scene, Scene::shading_model, "flat")));
    open(&mut bench);
    write(&mut bench, "labels");
    press(&mut bench, "new");
    bench.settle();
    assert!(bench.says("Save the changes?") && !bench.session.view.finder_open);
    bench.key(Key::Escape, Modifiers::NONE);
    assert!(!bench.says("Save the changes?"), "the question has the keys");
    assert_eq!(bench.session.document.shading_model, "flat");
}

/// Finds something and runs the first that is found.
fn run(bench: &mut Bench, letters: &str) {
    open(bench);
    write(bench, letters);
    bench.key(Key::Enter, Modifiers::NONE);
    assert!(!bench.session.view.finder_open, "“{letters}” runs");
}

#[test]
fn a_few_letters_and_enter_run_a_command_which_can_be_undone() {
    let mut bench = bench();
    run(&mut bench, "light spot");
    let lights = bench.session.document.lights.len();
    assert_eq!((lights, &*bench.session.document.lights[1].light_type), (2, "spot"));
    run(&mut bench, "undo");
    assert_eq!(bench.session.document.lights.len(), 1);
    run(&mut bench, "chan dep");
    assert!(bench.session.channel_of(0).is_some_and(|channel| channel.id() == "depth"));
    run(&mut bench, "theme light");
    assert!(bench.session.settings.theme != Settings::default().theme);
    run(&mut bench, "home");
    assert!(bench.effects.contains(&Effect::HomeView));
}

#[test]
fn what_is_typed_before_the_field_is_there_is_searched_for() {
    let mut bench = bench();
    let before = bench.session.document.scene().clone();
    let key =
        |key, modifiers| Event::Key { key, physical_key: None, pressed: true, repeat: false, modifiers };
    let typed = |letters: &'static str| {
        letters.chars().flat_map(move |letter| {
            let letter = letter.to_string();
            let pressed = Key::from_name(&letter.to_uppercase()).map(|k| key(k, Modifiers::NONE));
            std::iter::once(Event::Text(letter)).chain(pressed)
        })
    };
    // A search before leaves its cursor.
    open(&mut bench);
    write(&mut bench, "p");
    bench.key(Key::Escape, Modifiers::NONE);
    // In the frame of the key, in the next one, and then.
    bench.frame([key(Key::F, Modifiers::COMMAND)].into_iter().chain(typed("ch")).collect());
    bench.frame(typed("an ").collect());
    bench.frame(typed("dep").collect());
    bench.settle();
    assert!(bench.session.view.finder_open && *bench.session.document.scene() == before, "no letter acts");
    assert!(bench.session.channel_of(0).is_none_or(|channel| channel.id() != "depth"));
    bench.key(Key::Enter, Modifiers::NONE);
    assert!(bench.session.channel_of(0).is_some_and(|channel| channel.id() == "depth"));
    // What was typed is gone when it opens again.
    open(&mut bench);
    assert!(bench.texts().iter().any(|text| text == "New default scene"));
}

#[test]
fn scenes_lessons_models_and_parameters_are_found() {
    let mut bench = bench();
    run(&mut bench, "oren nayar");
    assert_eq!(bench.session.document.reflection_model, "oren_nayar");
    for (name, id) in [("glass", "glass"), ("Thin glass", "thin_glass"), ("phong", "phong"), ("ward", "ward")]
    {
        run(&mut bench, name);
        assert_eq!(bench.session.document.reflection_model, id, "by its very name");
    }
    run(&mut bench, "1994 oren");
    run(&mut bench, "shininess phong 1975");
    assert_eq!(bench.session.document.reflection_model, "phong", "by a parameter and the year");
    run(&mut bench, "ggx");
    let found =
        Registry::builtin().model(&bench.session.document.reflection_model).map(|m| m.declaration.synonyms);
    assert!(found.is_some_and(|synonyms| synonyms.contains(&"GGX")), "before scenes called so");
    run(&mut bench, "furnace energy");
    assert!(bench.session.lesson.as_ref().is_some_and(|open| open.source == LessonSource::Shipped(7)));
    run(&mut bench, "leave the lesson");
    assert!(bench.session.lesson.is_none());
    run(&mut bench, "undo");
    run(&mut bench, "gouraud misses");
    assert!(bench.session.questions.open.is_some() || bench.session.title().contains("Gouraud"));
}

#[test]
fn what_is_called_exactly_so_comes_before_models_that_mention_it() {
    let mut bench = bench();
    run(&mut bench, "car paint");
    let title = bench.session.title();
    assert!(bench.session.questions.open.is_some() || title.contains("Car paint"), "{title}");
}

#[test]
fn a_row_says_why_it_is_found_where_its_name_does_not() {
    let mut bench = bench();
    let mut notes = |letters: &str| {
        open(&mut bench);
        write(&mut bench, letters);
        let texts = bench.texts();
        bench.key(Key::Escape, Modifiers::NONE);
        texts
    };
    for (letters, why) in [
        ("trowbridge", "Trowbridge–Reitz · "),
        ("filament", "Filament · "),
        ("shininess", "shininess · "),
        ("kelemen", "masking: Kelemen · "),
        ("openpbr sheen", "sheen · "),
        ("disney sheen", "sheen · "),
        ("disney cloth", "in the description · "),
    ] {
        let texts = notes(letters);
        assert!(texts.iter().any(|text| text.starts_with(why)), "{letters}: {texts:?}");
    }
}

#[test]
fn models_of_one_name_are_told_apart() {
    let mut bench = bench();
    let text = "/* lcm { \"name\": \"Sheen cloth\" } */\nfn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: \
                Parameters) -> Terms {\n    return Terms(vec3(0.0), vec3(0.5), vec3(0.0));\n}\n";
    for id in ["cloth_a", "cloth_b"] {
        let file = format!("models/{id}.wgsl");
        let model = custom::read(file.as_ref(), text, &bench.registry).expect("valid");
        bench.registry.put_custom_model(model);
    }
    for list in ["find", "choose_model"] {
        press(&mut bench, list);
        write(&mut bench, "cloth");
        let texts = bench.texts();
        for id in ["cloth_a", "cloth_b"] {
            assert!(
                texts.iter().any(|text| text.contains(&format!("{id} · unknown author"))),
                "{id}: {texts:?}"
            );
        }
        bench.key(Key::Escape, Modifiers::NONE);
    }
}

#[test]
fn a_parameter_that_is_found_has_the_focus_of_the_keys() {
    let mut bench = Bench::with_everything();
    bench.apply(Action::Select(Selection::Object(0)));
    bench.apply(Action::View(ViewChange::Right(false)));
    run(&mut bench, "sheen tint");
    (0..4).for_each(|_| bench.settle());
    let id = bench.ctx.memory(|m| m.focused()).expect("something has the focus");
    let at = bench.ctx.viewport(|v| v.prev_pass.widgets.get(id).map(|w| w.rect)).expect("shown");
    let knob =
        bench.tree.iter().find(|s| s.label == "sheen tint" && s.rect.expand(2.0).contains(at.center()));
    assert!(knob.is_some() && at.bottom() < bench.size.y, "{at:?}");
    bench.key(Key::ArrowRight, Modifiers::NONE);
    let value = bench.session.document.objects[0].material.0.get("sheen_tint").cloned();
    assert!(value.is_some(), "an arrow key changes it");
    // One that the chosen options do not use says why, and is not run.
    let mut bench = Bench::with_model("microfacet");
    bench.apply(Action::Select(Selection::Object(0)));
    open(&mut bench);
    write(&mut bench, "exponent of gtr");
    assert!(bench.texts().iter().any(|text| text.contains("Not used with GGX")));
    bench.key(Key::Enter, Modifiers::NONE);
    assert!(bench.session.view.finder_open);
}

#[test]
fn arrows_walk_escape_closes_and_what_cannot_be_used_says_why() {
    let mut bench = bench();
    open(&mut bench);
    assert!(bench.texts().iter().any(|text| text == "New default scene"));
    write(&mut bench, "undo");
    assert!(bench.texts().iter().any(|text| text == "There is nothing to undo"));
    assert!(
        bench.texts().iter().any(|text| *text == usual("undo").to_string()),
        "its key is shown all the same"
    );
    bench.key(Key::Enter, Modifiers::NONE);
    assert!(bench.session.view.finder_open && bench.session.messages.is_empty(), "it is not run");
    bench.key(Key::Escape, Modifiers::NONE);
    assert!(!bench.session.view.finder_open);
    open(&mut bench);
    assert!(bench.texts().iter().any(|text| text == "New default scene"), "it opens fresh");
    write(&mut bench, "theme");
    bench.key(Key::ArrowDown, Modifiers::NONE);
    bench.key(Key::Enter, Modifiers::NONE);
    assert!(bench.session.settings.theme != Settings::default().theme, "the second of dark and light");
    // The same key closes it, and what was run last comes first.
    open(&mut bench);
    assert!(bench.texts().iter().any(|text| text == "Used last"));
    press(&mut bench, "find");
    assert!(!bench.session.view.finder_open);
    // A letter is no command meanwhile.
    let shading = bench.session.document.shading_model.clone();
    open(&mut bench);
    bench.letter(Key::F, "f");
    assert_eq!(bench.session.document.shading_model, shading);
    bench.click_at(bevy_egui::egui::pos2(20.0, 700.0), bevy_egui::egui::PointerButton::Primary);
    assert!(!bench.session.view.finder_open, "a click elsewhere closes it");
}

#[test]
fn a_presentation_finds_what_a_presentation_has() {
    let mut bench = bench();
    press(&mut bench, "presentation");
    for (letters, name, there) in [
        ("hist", "History…", false),
        ("show hand", "Show handles", false),
        ("scene lis", "Panels: Scene list", false),
        ("dept", "Channel: Depth", true),
    ] {
        open(&mut bench);
        write(&mut bench, letters);
        assert_eq!(bench.texts().iter().any(|text| text == name), there, "{name}");
        bench.key(Key::Escape, Modifiers::NONE);
        assert!(bench.session.view.presenting, "Escape closes the finder alone");
    }
    open(&mut bench);
    write(&mut bench, "sheen");
    assert!(!bench.texts().iter().any(|text| text.starts_with("Parameter of")), "there is no knob");
    bench.key(Key::Escape, Modifiers::NONE);
    run(&mut bench, "lambert");
    assert_eq!(bench.session.document.reflection_model, "lambert");
    assert!(bench.session.view.presenting);
}

#[test]
fn it_fits_every_size() {
    for (width, height) in [(1280.0, 720.0), (1920.0, 1080.0), (640.0, 480.0)] {
        for scale in [100, 150, 200] {
            let mut bench = bench();
            bench.size = vec2(width, height);
            bench.apply(Action::View(ViewChange::Scale(scale)));
            open(&mut bench);
            let whole = bench.ctx.content_rect();
            let layer = bevy_egui::egui::Id::new("finder");
            let place = bench.ctx.memory(|m| m.area_rect(layer)).expect("it is open");
            assert!(whole.contains_rect(place), "{width}×{height} at {scale} %: {place:?} in {whole:?}");
            assert!(place.height() > 0.4 * whole.height(), "{width}×{height} at {scale} %: {place:?}");
            assert!((place.center().x - whole.center().x).abs() < 2.0);
        }
    }
}

// ── declarations ──

/// All commands of a window with its panels.
fn commands() -> Menu {
    let mut session = Session::new(Scene::default());
    session.panels = Panels::builtin().infos().collect();
    declared(&session, &Registry::builtin(), true, true)
}

fn each(root: &Menu) -> Vec<&Command> {
    root.commands().into_iter().map(|(_, command)| command).collect()
}

#[test]
fn ids_are_words_and_no_two_are_equal() {
    let root = commands();
    let all = each(&root);
    assert!(all.len() > 200, "{}", all.len());
    for (i, command) in all.iter().enumerate() {
        let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || "._".contains(c);
        assert!(command.id.chars().all(plain), "{}", command.id);
        assert!(all[..i].iter().all(|other| other.id != command.id), "{} twice", command.id);
        assert!(command.absent || !command.name.is_empty(), "{} has a name", command.id);
    }
}

#[test]
fn the_list_of_keys_has_the_groups_and_rows_in_their_order() {
    let mut session = Session::default();
    session.panels = Panels::builtin().infos().collect();
    let root = all(&session, &Registry::builtin(), false);
    let listed = with_keys(&root);
    assert!(listed.is_sorted_by_key(|(_, command)| command.heading()), "each group is in one place");
    // Each command that has keys stands in the list, with all of them, below its heading.
    let declared = each(&root).into_iter().filter(|command| !command.absent);
    let shown = bindings(&session, &Registry::builtin());
    let mut count = 0;
    for command in declared {
        let rows = shown.iter().filter(|row| row.group == command.heading());
        let rows: Vec<_> = rows.map(|row| row.shortcut).collect();
        count += command.keys.len();
        let all = &command.keys[..];
        assert!(all.is_empty() || rows.windows(all.len()).any(|some| some == all), "{}", command.id);
    }
    assert_eq!(shown.len(), count);
    // The first rows are those that are looked for most.
    for (group, ids) in [
        (Group::Edit, ["undo", "redo", "select.all"]),
        (Group::Picture, ["next_channel", "channel.none", "next_object"]),
        (Group::Window, ["larger", "smaller", "size_100"]),
    ] {
        let first = listed.iter().filter(|(_, command)| command.heading() == group).map(|(_, c)| &*c.id);
        assert_eq!(first.take(ids.len()).collect::<Vec<_>>(), ids);
    }
}

// ── keys of the user's own ──

#[test]
fn own_keys_are_pressed_and_shown_wherever_keys_are() {
    let mut bench = with_keys_of(
        r#"{ "find": "Ctrl+Shift+P", "copy_picture": "Ctrl+Shift+C", "panel.messages": "F12", "home": "J", "keys": ["F1", "F4"] }"#,
    );
    assert!(bench.session.messages.is_empty(), "{:?}", bench.session.messages);
    bench.letter(Key::J, "j");
    assert!(bench.effects.contains(&Effect::HomeView));
    bench.effects.clear();
    bench.letter(Key::H, "h");
    assert!(bench.effects.is_empty(), "the usual key does it no more");
    bench.key(Key::C, Modifiers { shift: true, ..Modifiers::COMMAND });
    assert_eq!(bench.effects, [Effect::Picture { view: None, file: None, overwrite: false }]);
    bench.key(Key::P, Modifiers { shift: true, ..Modifiers::COMMAND });
    assert!(bench.session.view.finder_open);
    assert!(bench.texts().iter().any(|text| text == "Ctrl+Shift+C"), "in the finder");
    bench.key(Key::Escape, Modifiers::NONE);
    bench.key(Key::F4, Modifiers::NONE);
    let texts = bench.texts();
    for key in ["F4", "F12", "J", "Ctrl+Shift+C"] {
        assert!(texts.iter().any(|text| text == key), "{key} in the list of keys");
    }
    assert!(
        !texts
            .iter()
            .any(|text| [usual("panel.messages"), usual("home")].map(|key| key.to_string()).contains(text))
    );
    bench.key(Key::F1, Modifiers::NONE);
    bench.click("View");
    assert!(bench.tree.iter().any(|s| s.label == "Home: the observer’s view J"), "in the menu");
    bench.key(Key::Escape, Modifiers::NONE);
    // In a tooltip.
    let messages = bench.find("Messages: 0").expect("shown").rect.center();
    bench.hover(messages);
    assert!(bench.texts().iter().any(|text| text == "Show messages (F12)"));
}

#[test]
fn panels_and_menus_are_reached_by_commands_like_all_others() {
    let mut bench = with_keys_of(r#"{ "next_panel": "F12", "menu.edit": "Ctrl+M" }"#);
    assert!(bench.session.messages.is_empty(), "{:?}", bench.session.messages);
    press(&mut bench, "next_panel");
    assert_eq!(bench.ctx.memory(|m| m.focused()), None, "the usual key does it no more");
    bench.key(Key::F12, Modifiers::NONE);
    assert!(bench.ctx.memory(|m| m.focused()).is_some());
    bench.key(Key::M, Modifiers::COMMAND);
    assert!(bench.says("New reflection model…"));
    bench.key(Key::M, Modifiers::COMMAND);
    assert!(!bench.says("New reflection model…"));
    run(&mut bench, "view menu");
    assert!(bench.says("Focus selection"), "the finder opens it");
    bench.key(Key::Escape, Modifiers::NONE);
    for id in ["presentation", "menu_bar", "presentation"] {
        press(&mut bench, id);
    }
    bench.settle();
    assert!(!bench.says("New default scene"), "what a presentation cannot show is forgotten");
}

#[test]
fn wrong_keys_are_reported_once_change_nothing_and_stay_in_the_settings() {
    let json = r#"{ "sav": "F4", "save": "Ctrl+O", "open": "Strg+O", "home": "J" }"#;
    let mut bench = with_keys_of(json);
    let said: Vec<_> = bench.session.messages.iter().map(|note| note.text.clone()).collect();
    assert_eq!(said.len(), 3, "{said:?}");
    for (said, part) in said.iter().zip([
        "keys has \"sav\", which is not a command; did you mean \"save\"?",
        "keys.open is \"Strg+O\", but must be a key",
        "keys.save has Ctrl+O, which is the key of \"open\"",
    ]) {
        assert!(said.contains(part) && said.contains("settings"), "{said}");
    }
    bench.letter(Key::J, "j");
    assert!(bench.effects.contains(&Effect::HomeView), "what is right is in force");
    let written = serde_json::to_string(&bench.session.settings).expect("settings");
    let compact: String = json.split_whitespace().collect();
    assert!(written.contains(&compact), "{written}");
    bench.settle();
    assert_eq!(bench.session.messages.len(), 3, "reported once");
    press(&mut bench, "save");
    assert!(bench.dialogs.is_open() && bench.says("Save"), "Ctrl+S saves as before");
}

#[test]
fn a_command_may_lose_its_key_and_another_get_one() {
    let mut bench = with_keys_of(r#"{ "delete": null, "add_light.point": "L", "picture_caption": [] }"#);
    assert_eq!(bench.session.messages.len(), 1, "there is no command “picture_caption”");
    bench.key(Key::Delete, Modifiers::NONE);
    bench.letter(Key::L, "l");
    let document = &bench.session.document;
    assert_eq!((document.objects.len(), document.lights.len()), (1, 2));
    // A text says the command where there is no key.
    let mut bench = with_keys_of(r#"{ "choose_model": null, "panel.messages": null }"#);
    let chooser = bench.tree.iter().find(|s| s.label.starts_with("Reflection model: ")).expect("shown").rect;
    bench.hover(chooser.center());
    assert!(!bench.says("key R"));
    let messages = bench.find("Messages: 0").expect("shown").rect.center();
    bench.hover(messages);
    assert!(bench.texts().iter().any(|text| text == "Show messages"));
}

#[test]
fn a_key_that_is_held_blinks_until_it_is_let_go_of() {
    let mut bench = with_keys_of(r#"{ "blink": "B" }"#);
    let action = Action::Do(Effect::Picture { view: None, file: None, overwrite: false });
    assert!(bindings(&bench.session, &bench.registry).iter().any(|b| b.action == action));
    bench.apply(Action::Compare(lights_camera_models::panel::state::CompareCommand::Layout(
        lights_camera_models::scene::comparison::Layout::Blink,
    )));
    let event = |pressed| Event::Key {
        key: Key::B,
        physical_key: None,
        pressed,
        repeat: false,
        modifiers: Modifiers::NONE,
    };
    bench.frame(vec![event(true)]);
    bench.frame(Vec::new());
    assert!(bench.session.view.blinking);
    bench.frame(vec![event(false)]);
    bench.frame(Vec::new());
    assert!(!bench.session.view.blinking);
}
