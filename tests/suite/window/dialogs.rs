//! The dialogs that choose files: their size, their colours, the preview.

use std::fs;

use bevy_egui::egui::{
    Color32, Event, Id, Key, Modifiers, Order, Rect, Shape, containers::panel::PanelState, pos2, vec2,
};
use lights_camera_models::{
    document::Edit,
    optics::colour::srgb_decode,
    panel::{
        caption::caption_text,
        state::{Action, Effect, SCALES, Session, ThemeChoice, ViewChange},
        theme::Palette,
    },
    registry::Registry,
    scene::{Part, Scene, formats::SceneFormats as _},
};

use crate::{helpers::support::root, window::examples::until, window::panels::Bench};

fn luminance(c: Color32) -> f32 {
    let linear = |v: u8| srgb_decode(f32::from(v) / 255.0);
    0.2126 * linear(c.r()) + 0.7152 * linear(c.g()) + 0.0722 * linear(c.b())
}

fn contrast(a: Color32, b: Color32) -> f32 {
    let (a, b) = (luminance(a) + 0.05, luminance(b) + 0.05);
    a.max(b) / a.min(b)
}

/// A window whose document is in a folder with two scenes, one of them broken, and the open dialog.
fn open(theme: ThemeChoice, percent: u16) -> (Bench, tempfile::TempDir) {
    let folder = tempfile::tempdir().expect("a folder");
    fs::copy(root().join("scenes/shapes_and_lights.json"), folder.path().join("shapes.json"))
        .expect("copied");
    fs::write(folder.path().join("broken.json"), r#"{ "lights": 5 }"#).expect("written");
    let mut session = Session::default();
    session.path = Some(folder.path().join("shapes.json"));
    let mut bench = Bench::new(session);
    bench.size = vec2(1280.0, 720.0);
    bench.apply(Action::View(ViewChange::Theme(theme)));
    bench.apply(Action::View(ViewChange::Scale(percent)));
    bench.key(Key::O, Modifiers::COMMAND | Modifiers::CTRL);
    let listed = |b: &mut Bench| b.tree.iter().any(|s| s.label.contains("shapes.json"));
    until(&mut bench, "the list", listed);
    (bench, folder)
}

fn select(bench: &mut Bench, name: &str) {
    let row = bench.tree.iter().find(|s| s.label.contains(name)).expect("listed").rect;
    bench.click_at(row.center(), bevy_egui::egui::PointerButton::Primary);
}

#[test]
fn the_dialog_takes_seventy_per_cent_of_the_window_and_nearly_all_of_a_scaled_one() {
    for (percent, least, most) in [(100, 0.66, [0.78, 0.82]), (150, 0.92, [1.0; 2]), (200, 0.92, [1.0; 2])] {
        let (bench, _folder) = open(ThemeChoice::Dark, percent);
        let rect = bench.ctx.memory(|m| m.area_rect(Id::new("open dialog"))).expect("open");
        let share = rect.size() / bench.ctx.content_rect().size();
        assert!(
            (least..=most[0]).contains(&share.x) && (least..=most[1]).contains(&share.y),
            "{percent} %: {share:?}"
        );
        assert!(bench.ctx.content_rect().contains_rect(rect));
    }
}

#[test]
fn a_dialog_is_whole_at_every_size_of_type() {
    for percent in SCALES {
        let (mut bench, _folder) = open(ThemeChoice::Dark, percent);
        let whole = bench.ctx.memory(|m| m.area_rect(Id::new("open dialog"))).expect("open");
        assert!(bench.ctx.content_rect().contains_rect(whole), "{percent} %: {whole:?}");
        let texts: Vec<_> = (bench.shapes().into_iter())
            .filter_map(|shape| match shape {
                Shape::Text(text) if !text.galley.elided => Some(text),
                _ => None,
            })
            .collect();
        for words in ["Open a scene", "Scenes", "Cancel", "Open"] {
            let is_whole = |rect: Rect| whole.shrink(8.0).contains_rect(rect);
            let mut found = texts.iter().filter(|text| text.galley.text().trim_end().ends_with(words));
            assert!(found.any(|text| is_whole(text.visual_bounding_rect())), "{percent} %: no {words}");
        }
        let panel = PanelState::load(&bench.ctx, Id::new("open dialog").with("bottom_panel")).expect("shown");
        let ground = Palette::of(&bench.session.settings).panel;
        let edge = bench.shapes().into_iter().any(|shape| match shape {
            Shape::Rect(r) => r.fill == ground && (r.rect.max - panel.outer_rect.max).length() < 2.0,
            _ => false,
        });
        assert!(!edge, "{percent} %: the buttons stand on an edge");
    }
}

#[test]
fn a_scaled_dialog_lists_many_files() {
    for (key, modifiers, dialog) in
        [(Key::O, Modifiers::NONE, "open dialog"), (Key::S, Modifiers::SHIFT, "save dialog")]
    {
        let (mut bench, folder) = open(ThemeChoice::Dark, 150);
        bench.key(Key::Escape, Modifiers::NONE);
        for i in 0..40 {
            fs::write(folder.path().join(format!("lesson{i:02}.json")), "{}").expect("written");
        }
        bench.key(key, modifiers | Modifiers::COMMAND | Modifiers::CTRL);
        until(&mut bench, "the list", |b: &mut Bench| b.says("lesson00.json"));
        assert!(bench.ctx.memory(|m| m.area_rect(Id::new(dialog))).is_some());
        bench.settle();
        let rows = bench.tree.iter().filter(|s| s.label.contains("lesson")).count();
        assert!(rows >= 10, "{dialog}: {rows} files are in sight");
    }
}

#[test]
fn enter_and_escape_reach_the_dialog_from_the_search() {
    let (mut bench, folder) = open(ThemeChoice::Dark, 100);
    bench.effects.clear();
    bench.frame(vec![Event::Text("shap".to_owned())]);
    bench.settle();
    assert!(bench.ctx.text_edit_focused(), "in the search");
    bench.key(Key::Enter, Modifiers::NONE);
    assert!(!bench.dialogs.is_open(), "one press opens");
    let path = folder.path().join("shapes.json");
    assert!(matches!(&bench.effects[..], [Effect::OpenFile(file)] if file.file_name() == path.file_name()));

    let (mut bench, _folder) = open(ThemeChoice::Dark, 150);
    bench.frame(vec![Event::Text("shap".to_owned())]);
    bench.settle();
    bench.key(Key::Escape, Modifiers::NONE);
    assert!(!bench.dialogs.is_open(), "one press closes");
    // The file name keeps its Enter, and Escape closes from there too.
    bench.key(Key::S, Modifiers::SHIFT | Modifiers::COMMAND | Modifiers::CTRL);
    assert!(bench.dialogs.is_open() && bench.ctx.text_edit_focused());
    bench.key(Key::Escape, Modifiers::NONE);
    assert!(!bench.dialogs.is_open());
    // The path at the top is left alone first.
    bench.key(Key::O, Modifiers::COMMAND | Modifiers::CTRL);
    bench.letter(Key::Slash, "/");
    assert!(bench.ctx.text_edit_focused(), "in the path");
    bench.key(Key::Escape, Modifiers::NONE);
    assert!(bench.dialogs.is_open());
    bench.key(Key::Escape, Modifiers::NONE);
    assert!(!bench.dialogs.is_open());
}

#[test]
fn one_escape_closes_the_dialog_whatever_has_the_focus() {
    let mut buttons = 0;
    for count in 1..6 {
        let (mut bench, _folder) = open(ThemeChoice::Dark, 100);
        (0..count).for_each(|_| bench.key(Key::Tab, Modifiers::NONE));
        let focus = bench.ctx.memory(bevy_egui::egui::Memory::focused);
        buttons += usize::from(focus.is_some() && !bench.ctx.text_edit_focused());
        bench.key(Key::Escape, Modifiers::NONE);
        assert!(!bench.dialogs.is_open(), "after {count} steps with Tab");
    }
    assert!(buttons > 0, "nothing is tested");
    let (mut bench, _folder) = open(ThemeChoice::Dark, 100);
    select(&mut bench, "shapes.json");
    bench.key(Key::Escape, Modifiers::NONE);
    assert!(!bench.dialogs.is_open(), "after a click");
}

#[test]
fn a_shortcut_is_no_text_for_the_search() {
    let (mut bench, _folder) = open(ThemeChoice::Dark, 100);
    // As the window passes it on after a slow frame: the letter before its key, and Ctrl already released.
    let modifiers = Modifiers::COMMAND | Modifiers::CTRL;
    let key = Event::Key { key: Key::O, physical_key: None, pressed: true, repeat: false, modifiers };
    bench.frame(vec![Event::Text("o".to_owned()), key, Event::ModifiersChanged(Modifiers::NONE)]);
    bench.settle();
    assert!(!bench.ctx.text_edit_focused() && bench.says("shapes.json") && bench.says("broken.json"));
}

#[test]
fn an_empty_list_says_so() {
    const NONE: &str = "No file or folder matches.";
    let (mut bench, _folder) = open(ThemeChoice::Light, 100);
    assert!(!bench.texts().iter().any(|text| text == NONE));
    bench.frame(vec![Event::Text("zebra".to_owned())]);
    bench.settle();
    assert!(bench.texts().iter().any(|text| text == NONE));
    (0.."zebra".len()).for_each(|_| bench.key(Key::Backspace, Modifiers::NONE));
    assert!(!bench.texts().iter().any(|text| text == NONE));
}

#[test]
fn the_type_of_the_file_is_named_once() {
    let (mut bench, _folder) = open(ThemeChoice::Dark, 100);
    bench.key(Key::Escape, Modifiers::NONE);
    bench.key(Key::S, Modifiers::SHIFT | Modifiers::COMMAND | Modifiers::CTRL);
    assert!(bench.texts().iter().any(|text| text == "Scene (.json)"));
}

#[test]
fn the_dialogs_list_the_scenes_of_every_format() {
    let folder = tempfile::tempdir().expect("a folder");
    for name in ["room.json", "table.csv", "balls.spheres", "notes.txt"] {
        fs::write(folder.path().join(name), "").expect("written");
    }
    let save = Modifiers::SHIFT | Modifiers::COMMAND | Modifiers::CTRL;
    let opened = |spheres: bool, file: &str, key: Key, modifiers: Modifiers| {
        let mut session = Session::default();
        session.path = Some(folder.path().join(file));
        let mut registry = Registry::builtin();
        if spheres {
            registry.add_scene_format(crate::scenes::formats::example::Spheres);
        }
        let mut bench = Bench::with_registry(session, registry);
        bench.size = vec2(1280.0, 720.0);
        bench.key(key, modifiers | Modifiers::COMMAND | Modifiers::CTRL);
        until(&mut bench, "the list", |b: &mut Bench| {
            b.tree.iter().any(|s| s.label.contains("room.json") || s.label.contains("table.csv"))
        });
        bench.settle();
        bench
    };
    let bench = opened(false, "room.json", Key::O, Modifiers::NONE);
    assert!(bench.says("room.json") && bench.says("table.csv"));
    assert!(!bench.says("balls.spheres") && !bench.says("notes.txt"));
    let bench = opened(true, "room.json", Key::O, Modifiers::NONE);
    assert!(bench.says("balls.spheres") && !bench.says("notes.txt"));
    // Saving proposes the format of the file, and JSON for one that can only be read.
    let mut bench = opened(true, "table.csv", Key::S, save);
    assert!(bench.texts().iter().any(|text| text == "Scene as CSV (.csv)"));
    assert!(bench.texts().iter().any(|text| text == "table.csv"));
    let mut bench = opened(true, "balls.spheres", Key::S, save);
    let texts = bench.texts();
    assert!(
        texts.iter().any(|text| text == "Scene (.json)") && texts.iter().any(|text| text == "balls.json"),
        "{texts:?}"
    );
}

#[test]
fn what_stands_behind_a_window_says_nothing_over_it() {
    let mut bench = Bench::new(Session::default());
    bench.size = vec2(1280.0, 720.0);
    bench.settle();
    let control = bench.find("Delete Sphere 1").expect("there").rect;
    bench.hover(control.center());
    let said = |bench: &mut Bench| bench.texts().iter().any(|text| text.starts_with("Delete Sphere"));
    assert!(said(&mut bench), "there is a tooltip: {:?}", bench.texts());
    for (key, modifiers) in
        [(Key::N, Modifiers::SHIFT | Modifiers::COMMAND | Modifiers::CTRL), (Key::F1, Modifiers::NONE)]
    {
        bench.key(key, modifiers);
        bench.hover(control.center());
        assert!(!said(&mut bench), "{key:?}");
        bench.key(Key::Escape, Modifiers::NONE);
    }
}

#[test]
fn no_tooltip_stands_over_a_question() {
    let mut bench = Bench::with_model("blinn_phong");
    bench.size = vec2(1280.0, 720.0);
    bench.apply(Action::View(ViewChange::Scale(150)));
    bench.apply(Action::Edit(Edit::set(Part::Scene, Scene::shading_model, "derivative")));
    let whole = caption_text(&bench.session, &bench.registry);
    let said = |bench: &mut Bench| bench.texts().contains(&whole);
    bench.hover(bench.area.rect.left_bottom() + vec2(40.0, -16.0));
    assert!(said(&mut bench), "there is a tooltip: {:?}", bench.texts());
    bench.apply(Action::Quit);
    assert!(bench.says("Save the changes?") && !said(&mut bench));
    bench.key(Key::Escape, Modifiers::NONE);
    assert!(!bench.says("Save the changes?") && said(&mut bench));
}

#[test]
fn the_buttons_of_a_dialog_are_clear_of_its_preview() {
    for (size, percent) in [(1280.0, 100), (1280.0, 125), (1280.0, 150), (1280.0, 175), (1280.0, 200)] {
        let (mut bench, _folder) = open(ThemeChoice::Light, percent);
        bench.size = vec2(size, 0.5625 * size);
        bench.settle();
        let panel = |name: &str| {
            let id = Id::new("open dialog").with(name);
            PanelState::load(&bench.ctx, id).unwrap_or_else(|| panic!("no {name}")).outer_rect
        };
        let (bottom, preview) = (panel("bottom_panel"), panel("right_panel"));
        assert!(
            bottom.right() <= preview.left() + 1.0,
            "{percent} %: {bottom:?} reaches into the preview {preview:?}"
        );
        let word = bench.shapes().into_iter().find_map(|shape| match shape {
            Shape::Text(text) if text.galley.text().ends_with("Open") => Some(text.visual_bounding_rect()),
            _ => None,
        });
        let word = word.expect("a button");
        assert!(bottom.contains_rect(word) && word.right() < preview.left() - 8.0, "{percent} %: {word:?}");
    }
}

#[test]
fn what_is_said_of_a_model_does_not_hide_the_list() {
    for (percent, expected) in [(100, true), (200, false)] {
        let mut bench = Bench::new(Session::default());
        bench.size = vec2(1280.0, 720.0);
        bench.apply(Action::View(ViewChange::Scale(percent)));
        bench.key(Key::R, Modifiers::NONE);
        let row = bench.find("Phong").expect("listed").rect;
        // The tree counts pixels.
        bench.hover(row.center() / bench.ctx.zoom_factor());
        let summary = bench.registry.model("phong").expect("built in").declaration.summary;
        assert_eq!(bench.texts().iter().any(|text| text == summary), expected, "{percent} %");
    }
}

#[test]
fn what_is_typed_and_what_is_selected_can_be_seen_in_both_themes() {
    for theme in [ThemeChoice::Dark, ThemeChoice::Light] {
        let (mut bench, _folder) = open(theme, 100);
        let palette = Palette::of(&bench.session.settings);
        select(&mut bench, "shapes.json");
        let selected =
            bench.shapes().into_iter().any(|s| matches!(s, Shape::Rect(r) if r.fill == palette.accent));
        assert!(selected, "the row of the selected file is filled");
        assert!(
            contrast(palette.accent, palette.raised) >= 3.0 && contrast(palette.panel, palette.accent) >= 4.5
        );
        bench.frame(vec![Event::Text("shap".to_owned())]);
        bench.settle();
        let shapes = bench.shapes();
        let dark =
            shapes.iter().any(|s| matches!(s, Shape::Rect(r) if r.fill == Color32::from_black_alpha(250)));
        assert!(!dark, "a field has the colour of no theme");
        let typed = shapes.iter().find_map(|s| match s {
            Shape::Text(t) if t.galley.job.text == "shap" => Some(t.galley.job.sections[0].format.color),
            _ => None,
        });
        let typed = typed.expect("the search is shown");
        let seen = contrast(typed, palette.field);
        assert!(seen >= 4.5, "{theme:?}: {typed:?} on {:?}: {seen}", palette.field);
        // The style of the dialogs stays unchanged.
        assert_eq!(bench.ctx.global_style().visuals.selection.bg_fill, palette.chosen);
    }
}

#[test]
fn the_selected_scene_is_shown_with_its_description_and_what_is_wrong_with_it() {
    let (mut bench, _folder) = open(ThemeChoice::Dark, 100);
    assert!(bench.says("Select a scene"));
    select(&mut bench, "shapes.json");
    until(&mut bench, "the preview", |b| b.says("Sphere, torus, teapot and cube under a point"));
    assert!(bench.says("5 objects · 4 lights"));
    let drawn = bench.shapes().into_iter().any(|s| match s {
        Shape::Rect(r) => r.brush.is_some() && r.rect.width() > 150.0,
        Shape::Mesh(m) => m.calc_bounds().width() > 150.0,
        _ => false,
    });
    assert!(drawn, "the picture is there");
    select(&mut bench, "broken.json");
    until(&mut bench, "the mistake", |b| b.says("lights"));
    assert!(bench.tree.iter().any(|s| s.label.contains("broken.json:1")), "where the mistake is");
}

#[test]
fn the_keys_stay_in_the_dialog() {
    let (mut bench, _folder) = open(ThemeChoice::Dark, 100);
    let key = Event::Key {
        key: Key::F,
        physical_key: None,
        pressed: true,
        repeat: false,
        modifiers: Modifiers::ALT,
    };
    bench.frame(vec![Event::ModifiersChanged(Modifiers::ALT), key, Event::Text("f".to_owned())]);
    bench.frame(vec![Event::ModifiersChanged(Modifiers::NONE)]);
    bench.settle();
    assert!(!bench.says("New default scene"), "Alt+F opens no menu over the dialog");
    assert!(bench.says("shapes.json"), "and its letter is not searched for");
    for _ in 0..40 {
        bench.key(Key::Tab, Modifiers::NONE);
        let focus = bench.ctx.memory(bevy_egui::egui::Memory::focused);
        let layer =
            focus.and_then(|id| bench.ctx.viewport(|v| v.prev_pass.widgets.get(id).map(|w| w.layer_id)));
        assert!(
            layer.is_none_or(|layer| layer.order != Order::Background),
            "Tab leaves the dialog: {layer:?}"
        );
    }
}

#[test]
fn a_lamp_gets_the_file_that_is_chosen_and_keeps_its_own_if_that_is_no_good() {
    let folder = tempfile::tempdir().expect("a folder");
    let ies = "TILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 10\n0 180\n0\n50 50\n";
    fs::write(folder.path().join("bright.ies"), ies).expect("written");
    fs::write(folder.path().join("another.json"), "{}").expect("written");
    fs::write(folder.path().join("dull.ies"), ies.replace("50 50", "50")).expect("written");
    let mut session = Session::default();
    session.path = Some(folder.path().join("room.json"));
    let mut bench = Bench::new(session);
    bench.size = vec2(1280.0, 720.0);
    bench.apply(Action::AddLight("photometric".to_owned()));
    let choose = |bench: &mut Bench, shown: &str, name: &str| {
        let knob = format!("photometric file: {shown}");
        until(bench, "the knob", |b: &mut Bench| b.tree.iter().any(|s| s.label.contains(&knob)));
        select(bench, &knob);
        until(bench, "the list", |b: &mut Bench| b.says("bright.ies") && b.says("dull.ies"));
        assert!(!bench.says("another.json"), "only photometric files are listed");
        bench.frame(vec![Event::Text(name.to_owned())]);
        bench.settle();
        bench.key(Key::Enter, Modifiers::NONE);
        assert!(!bench.dialogs.is_open());
        bench.settle();
        let lamp = bench.session.document.lights.last().expect("added");
        lamp.parameters.0.get("file").map(|file| file.to_string())
    };
    assert_eq!(choose(&mut bench, "wall_washer.ies", "bright").as_deref(), Some("bright.ies"));
    assert_eq!(choose(&mut bench, "bright.ies", "dull").as_deref(), Some("bright.ies"));
    let problem = "dull.ies:6: the file ends before candela value 2 of 2";
    let said = bench.session.messages.iter().any(|message| message.text.contains(problem));
    assert!(said, "the mistake is told");
}

#[test]
fn a_folder_is_opened_by_the_button_as_by_a_double_click() {
    for percent in [100, 150] {
        let (mut bench, folder) = open(ThemeChoice::Dark, percent);
        bench.key(Key::Escape, Modifiers::NONE);
        let inner = folder.path().join("of_last_year");
        fs::create_dir(&inner).expect("created");
        fs::copy(folder.path().join("shapes.json"), inner.join("inside.json")).expect("copied");
        bench.key(Key::O, Modifiers::COMMAND | Modifiers::CTRL);
        until(&mut bench, "the folder", |b: &mut Bench| b.says("of_last_year"));
        select(&mut bench, "of_last_year");
        bench.settle();
        let open = |bench: &mut Bench| {
            let button = bench.tree.iter().rfind(|s| s.label.ends_with("  Open") && !s.disabled);
            let at = button.expect("enabled").rect.center();
            bench.click_at(at, bevy_egui::egui::PointerButton::Primary);
        };
        open(&mut bench);
        until(&mut bench, "what is in it", |b: &mut Bench| {
            b.tree.iter().any(|s| s.label.contains("inside.json"))
        });
        assert!(bench.dialogs.is_open());
        assert!(!bench.effects.iter().any(|effect| matches!(effect, Effect::OpenFile(_))));
        bench.effects.clear();
        bench.settle();
        let enabled = bench.tree.iter().any(|s| s.label.ends_with("  Open") && !s.disabled);
        assert!(!enabled, "{percent} %: nothing is selected there");
        // There it opens files again.
        select(&mut bench, "inside.json");
        bench.settle();
        open(&mut bench);
        assert!(!bench.dialogs.is_open());
        let file = inner.join("inside.json");
        assert!(
            matches!(&bench.effects[..], [Effect::OpenFile(path)] if path.file_name() == file.file_name()),
            "{:?}",
            bench.effects
        );
    }
}

#[test]
fn the_icons_of_a_dialog_say_what_they_do() {
    let (mut bench, _folder) = open(ThemeChoice::Dark, 100);
    bench.settle();
    for (icon, words) in [
        ("⏶", "The folder that this one is in"),
        ("⏴", "Back: the folder before"),
        ("⏵", "Forward again"),
        ("☰", "Reload, hidden files and more"),
    ] {
        let sign = bench.shapes().into_iter().find_map(|shape| match &shape {
            Shape::Text(text) if text.galley.text() == icon => Some(shape.visual_bounding_rect()),
            _ => None,
        });
        let sign = sign.unwrap_or_else(|| panic!("no icon {icon}"));
        bench.frame(vec![Event::PointerMoved(sign.center())]);
        bench.settle();
        assert!(bench.texts().iter().any(|text| text == words), "{icon}: {:?}", bench.texts());
        let rows = bench.shapes().into_iter().find_map(|shape| match &shape {
            Shape::Text(text) if text.galley.text() == words => Some(text.galley.rows.len()),
            _ => None,
        });
        assert_eq!(rows, Some(1), "{words} is in one line");
    }
}

const LONG_NAME: &str = "a_room_with_many_lamps_as_it_was_lit_on_the_first_evening.json";

/// The dialog in large letters, with a file of a long name selected.
fn with_a_long_name() -> (Bench, tempfile::TempDir) {
    let (mut bench, folder) = open(ThemeChoice::Dark, 150);
    bench.key(Key::Escape, Modifiers::NONE);
    fs::copy(folder.path().join("shapes.json"), folder.path().join(LONG_NAME)).expect("copied");
    bench.key(Key::O, Modifiers::COMMAND | Modifiers::CTRL);
    until(&mut bench, "the list", |b: &mut Bench| b.tree.iter().any(|s| s.label.contains("a_room")));
    select(&mut bench, "a_room");
    until(&mut bench, "the name", |b: &mut Bench| b.tree.iter().any(|s| s.label == LONG_NAME));
    (bench, folder)
}

#[test]
fn a_name_that_does_not_fit_below_the_list_has_both_of_its_ends() {
    let (mut bench, _folder) = with_a_long_name();
    bench.settle();
    let texts = bench.texts_in_sight();
    let is_short = |text: &str| text.starts_with("a_room") && text.contains('…') && text.ends_with(".json");
    let name = texts.iter().find(|(text, _)| is_short(text)).expect("shortened in the middle").1;
    let label = texts.iter().find(|(text, _)| text == "File:").expect("below").1;
    let bottom = PanelState::load(&bench.ctx, Id::new("open dialog").with("bottom_panel")).expect("shown");
    assert!(
        name.left() > label.right() && name.right() < bottom.outer_rect.right(),
        "{name:?} is cut off after {label:?}"
    );
}

#[test]
fn the_name_of_the_selected_file_is_whole() {
    let (mut bench, _folder) = with_a_long_name();
    let screen = bench.ctx.content_rect();
    let whole = bench.shapes().into_iter().any(|shape| match &shape {
        Shape::Text(text) => {
            let seen = shape.visual_bounding_rect();
            let beside = seen.left() > screen.left() + 0.6 * screen.width();
            text.galley.text() == LONG_NAME && !text.galley.elided && screen.contains_rect(seen) && beside
        }
        _ => false,
    });
    assert!(whole, "beside the list, in as many lines as it takes");
}

#[test]
fn a_name_that_does_not_fit_below_the_list_is_whole_under_the_pointer() {
    let (mut bench, folder) = open(ThemeChoice::Dark, 150);
    for name in [LONG_NAME, "short.json"] {
        bench.key(Key::Escape, Modifiers::NONE);
        fs::copy(folder.path().join("shapes.json"), folder.path().join(name)).expect("copied");
        bench.key(Key::O, Modifiers::COMMAND | Modifiers::CTRL);
        until(&mut bench, "the list", |b: &mut Bench| b.tree.iter().any(|s| s.label.contains(&name[..5])));
        select(&mut bench, &name[..5]);
        until(&mut bench, "the name", |b: &mut Bench| b.tree.iter().any(|s| s.label == name));
        let shown =
            |bench: &mut Bench| bench.texts_in_sight().iter().filter(|(text, _)| text == name).count();
        // Off the list, which has tooltips of its own.
        bench.hover(pos2(2.0, 2.0));
        let before = shown(&mut bench);
        let label = bench.texts_in_sight().into_iter().find(|(text, _)| text == "File:").expect("below").1;
        bench.hover(label.right_center() + vec2(20.0, 0.0));
        let expected = if name == LONG_NAME { before + 1 } else { before };
        assert_eq!(shown(&mut bench), expected, "{name}");
    }
}

#[test]
fn the_name_of_the_selected_file_has_a_line_of_its_own() {
    const NAME: &str = "compare_diffuse_models.json";
    for percent in [100, 150, 200] {
        let (mut bench, folder) = open(ThemeChoice::Dark, percent);
        bench.key(Key::Escape, Modifiers::NONE);
        fs::copy(folder.path().join("shapes.json"), folder.path().join(NAME)).expect("copied");
        bench.key(Key::O, Modifiers::COMMAND | Modifiers::CTRL);
        until(&mut bench, "the list", |b: &mut Bench| b.tree.iter().any(|s| s.label.contains("compare_")));
        select(&mut bench, "compare_");
        bench.settle();
        let bottom = PanelState::load(&bench.ctx, Id::new("open dialog").with("bottom_panel"))
            .expect("shown")
            .outer_rect;
        let shapes = bench.shapes();
        let place = |words: &str| {
            let mut places = shapes.iter().filter_map(|shape| match shape {
                Shape::Text(text) if text.galley.text() == words => Some(shape.visual_bounding_rect()),
                _ => None,
            });
            let place = places.find(|place| bottom.contains(place.center()));
            place.unwrap_or_else(|| panic!("{percent} %: no {words} below the list"))
        };
        let (label, name, filter) = (place("File:"), place(NAME), place("Scenes"));
        assert!(
            name.left() > label.right() && name.right() < bottom.right(),
            "{percent} %: {name:?} is cut off between {label:?} and {bottom:?}"
        );
        assert!(filter.top() >= name.bottom(), "{percent} %: the filter {filter:?} is beside {name:?}");
    }
}

#[test]
fn a_dialog_opened_at_another_size_of_type_has_room_for_its_buttons() {
    let (mut bench, _folder) = open(ThemeChoice::Dark, 100);
    bench.key(Key::Escape, Modifiers::NONE);
    for percent in [200, 150, 100, 200] {
        bench.apply(Action::View(ViewChange::Scale(percent)));
        bench.key(Key::O, Modifiers::COMMAND | Modifiers::CTRL);
        until(&mut bench, "the list", |b: &mut Bench| b.tree.iter().any(|s| s.label.contains("shapes.json")));
        bench.settle();
        let panel = |name: &str| {
            let state = PanelState::load(&bench.ctx, Id::new("open dialog").with(name));
            state.unwrap_or_else(|| panic!("no {name}")).outer_rect
        };
        let (bottom, preview) = (panel("bottom_panel"), panel("right_panel"));
        let whole = bench.ctx.memory(|m| m.area_rect(Id::new("open dialog"))).expect("open");
        assert!(preview.width() < 0.4 * whole.width(), "{percent} %: {preview:?} of {whole:?}");
        for words in ["Cancel", "Open", "Scenes"] {
            let is_whole = bench.shapes().into_iter().any(|shape| match &shape {
                Shape::Text(text) => {
                    let is_it = text.galley.text().trim_end().ends_with(words) && !text.galley.elided;
                    is_it && bottom.contains_rect(shape.visual_bounding_rect())
                }
                _ => false,
            });
            assert!(is_whole, "{percent} %: {words} is cut off in {bottom:?}");
        }
        bench.key(Key::Escape, Modifiers::NONE);
    }
}

#[test]
fn a_question_keeps_a_margin_in_a_small_window() {
    let mut bench = Bench::new(Session::default());
    for width in [400.0, 640.0] {
        bench.size = vec2(width, 300.0);
        bench.apply(Action::Edit(Edit::set(Part::Scene, Scene::shading_model, "flat")));
        bench.apply(Action::Quit);
        bench.settle();
        let question = bench.ctx.memory(|m| m.area_rect(Id::new("question"))).expect("asked");
        let screen = bench.ctx.content_rect();
        assert!(screen.shrink2(vec2(8.0, 0.0)).contains_rect(question), "{question:?} in {screen:?}");
        let inner = question.shrink2(vec2(8.0, 0.0));
        for label in ["Save", "Cancel"] {
            let mut there = bench.tree.iter().filter(|s| s.label == label);
            assert!(there.any(|s| inner.contains_rect(s.rect)), "{width}: {label} in {question:?}");
        }
        bench.key(Key::Escape, Modifiers::NONE);
    }
}
