//! Shaders and custom models in the panels, without a window.
//!
//! `scripts/pictures` writes pictures, to be looked at.

use std::{
    fs,
    path::{Path, PathBuf},
    time::{Duration, Instant},
};

use bevy_egui::egui::{self, Color32, Event, Key, Modifiers, PointerButton, Shape, pos2, vec2};
use lights_camera_models::{
    custom,
    document::Edit,
    library::status::{Reloaded, ShaderStatus, Trouble},
    panel::{
        picture,
        shader::consequence,
        state::{
            Action, CodeOf, CompareCommand, Effect, ModelCommand, ModelDraft, OpenCode, Session, Severity,
            ThemeChoice, ViewChange,
        },
        theme::Palette,
    },
    registry::{Folders, Registry},
    scene::{Light, Object, Part, Scene, Variant, comparison::Layout},
    shader::check::ShaderProblem,
    window::{
        authoring::{write, write_new},
        editor::{Editors, editor_command},
    },
};

use super::panels::Bench;

fn trouble(file: &str, line: usize, column: usize, source: &str, message: &str, stale: &[&str]) -> Trouble {
    Trouble {
        problem: ShaderProblem {
            file: file.to_owned(),
            line,
            column,
            source: source.to_owned(),
            message: message.to_owned(),
        },
        path: Some(Path::new("/home/mira/lab/shaders").join(file)),
        stale: stale.iter().map(|s| (*s).to_owned()).collect(),
    }
}

/// A missing word in the model shown by the window.
fn broken_lambert() -> Trouble {
    trouble(
        "reflection/lambert.wgsl",
        12,
        36,
        "\treturn Terms(vec3(0.0), cos_l * m.base_color, vec3(0.0));",
        "invalid field accessor `base_color`",
        &["Lambert"],
    )
}

#[test]
fn the_plate_about_an_error_covers_a_quarter_of_the_picture_at_most() {
    for scale in [100, 150, 200] {
        for views in 0..3 {
            let mut bench = bench_with(vec![broken_lambert(); 3]);
            bench.apply(Action::View(ViewChange::Scale(scale)));
            (0..views).for_each(|_| bench.apply(Action::Compare(CompareCommand::Add)));
            bench.settle();
            let cell = bench.area.cells.last().map_or(bench.area.rect, |cell| cell.rect);
            let Some(plate) = bench.tree.iter().find(|s| s.label.starts_with("Showing ")) else {
                assert!(cell.area() < 10_000.0, "{scale} %, {views} more views: {cell:?} has room for it");
                continue;
            };
            let share = plate.rect.area() / cell.area();
            assert!(share <= 0.25, "{scale} %, {views} more views: {share}");
        }
    }
}

#[test]
fn the_plate_about_an_error_stands_on_the_view_that_shows_the_model() {
    for (stale, expected) in [("Phong (a grey stand-in)", 1), ("Lambert", 0), ("Ward", 0)] {
        let wrong = Trouble { stale: vec![stale.to_owned()], ..broken_lambert() };
        let phong = Variant { reflection_model: Some("phong".to_owned()), ..Variant::default() };
        let mut scene = Scene { variants: vec![phong], ..Scene::default() };
        scene.comparison.layout = Layout::SideBySide;
        let mut session = Session::new(scene);
        session.shaders = ShaderStatus { troubles: vec![wrong], ..folders() };
        let mut bench = Bench::new(session);
        bench.size = vec2(1600.0, 900.0);
        bench.settle();
        let plate = bench.tree.iter().find(|s| s.label.starts_with("Showing ")).expect("a plate").rect;
        let cell =
            bench.area.cells.iter().find(|cell| cell.rect.contains_rect(plate)).expect("within a view");
        assert_eq!(cell.view, expected, "{stale}");
    }
}

#[test]
fn the_plate_about_an_error_has_a_shorter_sentence_rather_than_a_cut_one() {
    for (stale, said) in [("Gooch (a grey stand-in)", "rey stand-in"), ("Lambert", "ast good version")] {
        for scale in [100, 150, 200] {
            for views in 0..2 {
                let wrong = Trouble { stale: vec![stale.to_owned()], ..broken_lambert() };
                let mut bench = bench_with(vec![wrong]);
                bench.apply(Action::View(ViewChange::Scale(scale)));
                (0..views).for_each(|_| bench.apply(Action::Compare(CompareCommand::Add)));
                bench.settle();
                let plate = bench.tree.iter().find(|s| s.label.starts_with("Showing ")).map(|s| s.rect);
                assert!(views > 0 || plate.is_some(), "{scale} %: no plate");
                let Some(plate) = plate else { continue };
                let shapes = bench.shapes();
                let texts: Vec<_> = shapes
                    .iter()
                    .filter_map(|shape| match shape {
                        Shape::Text(text) if plate.contains(text.pos) => Some(&text.galley),
                        _ => None,
                    })
                    .collect();
                let heading = texts.first().expect("a heading");
                assert!(!heading.elided, "{scale} %, {views} more views: {}", heading.text());
                assert!(views > 0 || heading.text().contains(said), "{scale} %: {}", heading.text());
            }
        }
    }
}

fn folders() -> ShaderStatus {
    ShaderStatus {
        folders: Folders {
            shaders: Some(PathBuf::from("/home/mira/lab/shaders")),
            models: Some(PathBuf::from("/home/mira/lab/models")),
            ..Folders::default()
        },
        ..ShaderStatus::default()
    }
}

fn bench_with(troubles: Vec<Trouble>) -> Bench {
    let mut session = Session::default();
    session.shaders = ShaderStatus { troubles, ..folders() };
    let mut bench = Bench::new(session);
    bench.size = vec2(1280.0, 720.0);
    bench.settle();
    bench
}

/// The badge on the picture, as found by a screen reader.
fn badge(bench: &Bench) -> Option<(String, egui::Rect)> {
    let found = bench.tree.iter().find(|s| s.label.starts_with("Showing the last good version"))?;
    Some((found.label.clone(), found.rect))
}

// ── the badge ──

#[test]
fn the_picture_says_that_it_is_not_what_the_shader_says() {
    let mut bench = bench_with(vec![broken_lambert()]);
    let (said, rect) = badge(&bench).expect("a badge");
    for word in ["last good version of Lambert", "reflection/lambert.wgsl:12:36", "invalid field accessor"] {
        assert!(said.contains(word), "{said}");
    }
    assert!(bench.area.rect.contains_rect(rect), "on the picture");
    let line = |bench: &mut Bench, words: &str| bench.texts().iter().any(|text| text == words);
    assert!(!line(&mut bench, "No messages"), "beside an error");
    bench.session.shaders.troubles.clear();
    bench.settle();
    assert!(line(&mut bench, "No messages"));
    assert_eq!(badge(&bench), None, "gone with the error");
    bench.session.shaders.troubles = vec![Trouble { stale: Vec::new(), ..broken_lambert() }];
    bench.settle();
    assert_eq!(badge(&bench), None, "the picture is right");
    assert!(bench.says("nothing in the picture depends on it"), "but the status line tells");
}

#[test]
fn while_the_editor_marks_an_error_the_picture_shows_one_line_at_its_edge_and_the_status_line_nothing() {
    let mut bench = bench_with(vec![broken_lambert()]);
    let says = |bench: &mut Bench| bench.words().iter().any(|text| text.contains("invalid field accessor"));
    assert!(says(&mut bench) && bench.says("1 shader error"));
    let path = broken_lambert().path.expect("on disk");
    bench.session.code.open.push(OpenCode {
        of: CodeOf::File(path),
        name: "lambert.wgsl".to_owned(),
        text: "fn f() {}".into(),
        base: "fn f() {}".into(),
        crlf: false,
        theirs: None,
        shows_difference: false,
        replaced: None,
        closing: false,
        number: 1,
    });
    for height in [720.0, 480.0] {
        bench.size.y = height;
        bench.apply(Action::View(ViewChange::BottomTab("code".to_owned())));
        let picture = bench.area.rect;
        if let Some((_, plate)) = badge(&bench) {
            let share = (plate.bottom() - picture.top()) / picture.height();
            assert!(share <= 0.25, "{height}: {share}");
        } else {
            assert!(height < 700.0, "there is room for it");
        }
        assert!(!says(&mut bench) && !bench.says("shader error"), "{height}");
    }
    // One in another file is not in sight.
    let other = trouble("optics/fresnel.wgsl", 1, 1, "x", "invalid field accessor", &["Lambert"]);
    bench.session.shaders.troubles.push(other);
    bench.size.y = 720.0;
    bench.settle();
    assert!(bench.says("2 shader errors"));
    bench.session.shaders.troubles.pop();
    bench.apply(Action::View(ViewChange::BottomTab("plots".to_owned())));
    assert!(says(&mut bench) && bench.says("1 shader error"));
}

#[test]
fn the_strip_that_an_error_unfolded_folds_itself_once_the_file_is_healed() {
    let mut bench = bench_with(Vec::new());
    let strip = |bench: &Bench| (bench.session.view.bottom_open, bench.session.view.bottom_tab.clone());
    let set = |bench: &mut Bench, troubles: Vec<Trouble>| {
        bench.session.shaders.troubles = troubles;
        bench.settle();
    };
    let shader = (true, "shader".to_owned());
    for before in [ViewChange::Bottom(false), ViewChange::BottomTab("plots".to_owned())] {
        bench.apply(Action::View(before));
        bench.settle();
        let before = strip(&bench);
        set(&mut bench, vec![broken_lambert()]);
        assert_eq!(strip(&bench), shader);
        // Another error, and one of the two fixed: it stays.
        let other = trouble("reflection/phong.wgsl", 3, 1, "", "another one", &[]);
        set(&mut bench, vec![broken_lambert(), other.clone()]);
        set(&mut bench, vec![other]);
        assert_eq!(strip(&bench), shader);
        set(&mut bench, Vec::new());
        assert_eq!(strip(&bench), before, "as it was");
    }
    // Anything opened or selected by the user meanwhile stays.
    set(&mut bench, vec![broken_lambert()]);
    bench.apply(Action::View(ViewChange::BottomTab("shader".to_owned())));
    set(&mut bench, Vec::new());
    assert_eq!(strip(&bench), shader);
    bench.apply(Action::View(ViewChange::Bottom(false)));
    set(&mut bench, vec![broken_lambert()]);
    bench.apply(Action::View(ViewChange::BottomTab("plots".to_owned())));
    set(&mut bench, Vec::new());
    assert_eq!(strip(&bench), (true, "plots".to_owned()));
}

#[test]
fn the_badge_leads_to_the_errors_and_is_not_the_picture() {
    let mut bench = bench_with(vec![broken_lambert()]);
    bench.apply(Action::View(ViewChange::Bottom(false)));
    let (_, rect) = badge(&bench).expect("a badge");
    bench.frame(vec![Event::PointerMoved(rect.center())]);
    bench.frame(Vec::new());
    assert!(!bench.area.has_pointer, "a click there must not turn the camera");
    bench.click_at(rect.center(), PointerButton::Primary);
    assert!(bench.session.view.bottom_open);
    assert_eq!(bench.session.view.bottom_tab, "shader");
    let below = pos2(rect.center().x, rect.bottom() + 40.0);
    bench.frame(vec![Event::PointerMoved(below)]);
    bench.frame(Vec::new());
    assert!(bench.area.has_pointer, "beside it, the picture is the picture");
}

#[test]
fn many_models_and_long_messages_stay_on_the_picture() {
    let long =
        "expected `;`, found `}` and a great many other things that naga may have to say about this line";
    let names = ["Lambert", "Phong", "Blinn–Phong", "Ward", "Disney principled 2012 (Burley)"];
    let troubles: Vec<_> =
        (1..9).map(|i| trouble("optics/fresnel.wgsl", i, 1, "}", &format!("{i}: {long}"), &names)).collect();
    let (heading, lines) =
        picture::stale_words(&ShaderStatus { troubles: troubles.clone(), ..folders() }, "Ward")
            .expect("stale");
    assert_eq!(
        heading,
        "Showing the last good version of Ward, Blinn–Phong, Disney principled 2012 (Burley) and 2 more"
    );
    assert_eq!(lines.len(), 4);
    assert_eq!(lines[3], "and 5 more errors");
    for (size, large) in
        [((1280.0, 720.0), false), ((1280.0, 720.0), true), ((1024.0, 600.0), true), ((1920.0, 1080.0), true)]
    {
        let mut bench = bench_with(troubles.clone());
        bench.size = size.into();
        bench.apply(Action::View(ViewChange::Scale(if large { 150 } else { 100 })));
        let (_, rect) = badge(&bench).expect("a badge");
        let picture = bench.area.rect;
        assert!(picture.contains_rect(rect), "{size:?} {large}: {rect:?} in {picture:?}");
        // Where it needs the corner of the axes, there are none.
        for shape in bench.shapes() {
            if let Shape::Circle(circle) = shape
                && circle.radius > 20.0
            {
                let disc = circle.visual_bounding_rect();
                assert!(!disc.intersects(rect), "{size:?} {large}: {disc:?} lies over {rect:?}");
            }
        }
    }
}

#[test]
fn the_words_of_the_badge_can_be_read() {
    // The plate is filled with the colour of errors, the words have that of the panel.
    for theme in [ThemeChoice::Dark, ThemeChoice::Light] {
        let mut bench = bench_with(vec![broken_lambert()]);
        bench.apply(Action::View(ViewChange::Theme(theme)));
        let palette = Palette::of(&bench.session.settings);
        let (_, rect) = badge(&bench).expect("a badge");
        let shapes = bench.shapes();
        let inside = |at: egui::Pos2| rect.expand(1.0).contains(at);
        let plate =
            shapes.iter().any(|s| matches!(s, Shape::Rect(r) if r.fill == palette.error && r.rect == rect));
        assert!(plate, "{theme:?}: filled");
        let words: Vec<_> = shapes
            .iter()
            .filter_map(|s| match s {
                Shape::Text(t) if inside(t.pos) => Some(t.galley.job.sections[0].format.color),
                _ => None,
            })
            .collect();
        assert!(words.len() >= 2 && words.iter().all(|c| *c == palette.panel), "{theme:?}: {words:?}");
    }
}

// ── the tab ──

#[test]
fn a_new_error_unfolds_the_panel_once() {
    let mut bench = bench_with(Vec::new());
    assert!(!bench.session.view.bottom_open);
    bench.session.shaders.troubles = vec![broken_lambert()];
    bench.settle();
    assert!(bench.session.view.bottom_open && bench.session.view.bottom_tab == "shader");
    bench.apply(Action::View(ViewChange::Bottom(false)));
    assert!(!bench.session.view.bottom_open, "it stays folded");
    bench.session.shaders.troubles[0].problem.line += 3;
    bench.settle();
    assert!(!bench.session.view.bottom_open, "the same error, moved");
    bench.session.shaders.troubles.push(trouble("loop.wgsl", 1, 1, "x", "expected a declaration", &[]));
    bench.settle();
    assert!(bench.session.view.bottom_open, "the next one is news");
    bench.apply(Action::View(ViewChange::Bottom(false)));
    bench.session.shaders.troubles.clear();
    bench.settle();
    assert!(!bench.session.view.bottom_open, "good news unfold nothing");
    bench.session.shaders.troubles = vec![broken_lambert()];
    bench.settle();
    assert!(bench.session.view.bottom_open, "the old error, made again");
}

#[test]
fn the_tab_counts_the_errors_and_keys_and_status_line_lead_to_it() {
    let other = trouble("light/spot.wgsl", 3, 1, "x", "expected a declaration", &[]);
    let mut bench = bench_with(vec![broken_lambert(), other]);
    assert!(bench.says("2 errors"));
    assert!(bench.says("2 shader errors: the picture shows the last good version"));
    bench.key(Key::F9, Modifiers::NONE);
    assert!(!bench.session.view.bottom_open, "F9 folds what it shows");
    bench.key(Key::F8, Modifiers::NONE);
    assert_eq!(bench.session.view.bottom_tab, "messages");
    bench.key(Key::F9, Modifiers::NONE);
    assert_eq!(bench.session.view.bottom_tab, "shader");
    bench.apply(Action::View(ViewChange::Bottom(false)));
    bench.click("2 shader errors: the picture shows the last good version");
    assert!(bench.session.view.bottom_open && bench.session.view.bottom_tab == "shader");
}

#[test]
fn badge_panel_and_status_line_say_the_same_of_a_stand_in() {
    let mut broken = broken_lambert();
    broken.stale = vec!["Mine (a grey stand-in)".to_owned()];
    let mut bench = bench_with(vec![broken.clone()]);
    bench.apply(Action::View(ViewChange::BottomTab("shader".to_owned())));
    bench.settle();
    assert!(bench.says("1 shader error: the picture shows a grey stand-in"));
    assert!(bench.says("The picture shows a grey stand-in for Mine until this is corrected."));
    assert!(!bench.texts().iter().any(|text| text.contains("last good version")), "{:?}", bench.texts());
    // As many that not all are named.
    let many = ["A", "B", "C", "D", "E"].map(|name| format!("{name} (a grey stand-in)"));
    let status = ShaderStatus { troubles: vec![Trouble { stale: many.to_vec(), ..broken }], ..folders() };
    let heading = picture::stale_words(&status, "").map(|(heading, _)| heading);
    assert_eq!(heading.as_deref(), Some("Showing a grey stand-in for A, B, C and 2 more"));
}

#[test]
fn an_error_is_told_with_its_line_and_what_the_picture_shows() {
    let mut bench = bench_with(vec![broken_lambert()]);
    for words in [
        "reflection/lambert.wgsl:12:36",
        "invalid field accessor `base_color`",
        "line 12: return Terms(vec3(0.0), cos_l * m.base_color, vec3(0.0));",
        "The picture shows the last good version of Lambert until this is corrected.",
    ] {
        assert!(bench.says(words), "{words}");
    }
    bench.click("Copy");
    let copied = bench.copied.take().expect("text");
    for words in [
        "error: invalid field accessor `base_color`",
        "/home/mira/lab/shaders/reflection/lambert.wgsl:12:36",
        "base_color, vec3(0.0));",
        "\nThe picture shows the last good version of Lambert until this is corrected.\n",
    ] {
        assert!(copied.contains(words), "{words}: {copied}");
    }
    bench.effects.clear();
    bench.click("Open in editor");
    let path = PathBuf::from("/home/mira/lab/shaders/reflection/lambert.wgsl");
    assert_eq!(bench.effects, [Effect::OpenInEditor { path, line: 12 }]);
    assert_eq!(
        consequence(&Trouble { stale: Vec::new(), ..broken_lambert() }),
        "Nothing in the picture depends on it."
    );
}

#[test]
fn the_caret_stands_below_the_character_that_is_meant() {
    for (source, column, meant) in [
        ("let x = ;", 9, ';'),
        ("\t\tlet x = ;", 11, ';'),
        ("/* 漢字 and ä */ let x = ;", 24, ';'),
        (
            "        let a_long_name_for_a_value = another_function(with, many, arguments) + one_more(of, those, that, never, end, 1.0) * @;",
            126,
            '@',
        ),
    ] {
        assert_eq!(source.chars().nth(column - 1), Some(meant), "the test is right");
        let mut bench =
            bench_with(vec![trouble("loop.wgsl", 7, column, source, "expected expression", &["Lambert"])]);
        let shapes = bench.shapes();
        let texts: Vec<_> =
            shapes.iter().filter_map(|s| if let Shape::Text(t) = s { Some(t) } else { None }).collect();
        let caret = texts.iter().find(|t| t.galley.text() == "^").expect("a caret");
        let line = texts
            .iter()
            .find(|t| {
                t.galley.text().contains(meant) && t.pos.y < caret.pos.y && caret.pos.y - t.pos.y < 24.0
            })
            .expect("the line");
        let at = line.galley.text().chars().position(|c| c == meant).expect("in it");
        let edge = |i| line.pos.x + line.galley.pos_from_cursor(egui::text::CCursor::new(i)).min.x;
        let (centre, middle) = (caret.pos.x + 0.5 * caret.galley.size().x, 0.5 * (edge(at) + edge(at + 1)));
        assert!((centre - middle).abs() < 1.0, "{source}: {centre} and {middle}");
        assert!(!line.galley.text().contains('\t'));
        assert!(line.pos.x + line.galley.size().x <= bench.size.x, "{source}: within the window");
    }
}

#[test]
fn every_file_of_the_picture_is_listed_and_can_be_opened() {
    let mut bench = bench_with(vec![broken_lambert()]);
    bench.size = vec2(1280.0, 1400.0);
    bench.session.settings.bottom_height = 700.0;
    bench.settle();
    for (name, path) in [
        ("the model", "reflection/lambert.wgsl"),
        ("the shading model", "shading/gouraud.wgsl"),
        ("the light loop", "loop.wgsl"),
        ("the light type: point", "light/point.wgsl"),
        ("vocabulary: terms", "terms.wgsl"),
        ("the wrapper", "wrapper.wgsl"),
    ] {
        assert!(bench.says(&format!("{name}: {path}")), "{path}");
    }
    // The scene has no spotlight, so its shaders omit it.
    assert!(!bench.says("the light type: spot: light/spot.wgsl"));
    assert!(bench.says("the model: reflection/lambert.wgsl: error in line 12"));
    bench.click("Open reflection/lambert.wgsl in an editor");
    bench.click("Open loop.wgsl in an editor");
    let file = |name: &str| Path::new("/home/mira/lab/shaders").join(name);
    let expected = [
        Effect::OpenInEditor { path: file("reflection/lambert.wgsl"), line: 12 },
        Effect::OpenInEditor { path: file("loop.wgsl"), line: 1 },
    ];
    assert_eq!(bench.effects, expected);
    bench.apply(Action::Edit(Edit::set(Part::Object(0), Object::reflection_model, "phong")));
    assert!(bench.says("the model: reflection/phong.wgsl"), "the model of the selected object");
}

#[test]
fn built_in_shaders_can_be_written_out_and_not_opened() {
    let mut bench = Bench::new(Session::default());
    bench.apply(Action::View(ViewChange::BottomTab("shader".to_owned())));
    assert!(bench.says("The shaders are built in."));
    assert!(!bench.says("Open reflection/lambert.wgsl in an editor"));
    assert!(bench.find("Open in editor").expect("there").disabled);
    bench.click("Export shaders for editing…");
    assert!(bench.dialogs.is_open());
    let folder = PathBuf::from("/tmp/shaders");
    bench.effects.clear();
    bench.apply(Action::Do(Effect::ExportShaders(folder.clone())));
    assert_eq!(bench.effects, [Effect::ExportShaders(folder)]);
    let mut bench = Bench::new(Session::default());
    bench.key(Key::E, Modifiers::COMMAND | Modifiers::CTRL);
    assert_eq!(bench.effects, []);
    assert!(bench.session.messages[0].text.contains("built in"));
}

#[test]
fn all_of_the_panel_is_in_the_window_however_large_everything_is() {
    for (scale, model) in
        [(100, "lambert"), (150, "disney"), (150, "blinn_phong_normalised"), (200, "disney")]
    {
        let mut bench = Bench::with_model(model);
        bench.size = vec2(1280.0, 720.0);
        bench.apply(Action::View(ViewChange::Scale(scale)));
        bench.apply(Action::View(ViewChange::BottomTab("shader".to_owned())));
        let right = 1280.0 / bench.ctx.zoom_factor();
        let place = |label: &str| bench.find(label).unwrap_or_else(|| panic!("no {label}")).rect;
        let export = place("Export shaders for editing…");
        let first = place("New model…");
        assert!(export.right() < first.left(), "{model} at {scale} %: {export:?} {first:?}");
        for label in ["Check laws", "New model…", "Duplicate as a file…", "Open in editor"] {
            assert!(place(label).right() < right, "{model} at {scale} %: {label} {:?}", place(label));
        }
        let explained =
            bench.tree.iter().find(|s| s.label.starts_with("To change how the picture is computed"));
        assert!(explained.expect("shown").rect.right() < right, "{model} at {scale} %");
    }
}

#[test]
fn the_names_of_files_are_shown_whole() {
    let mut scene = Scene::default();
    scene.lights[0] = Light { light_type: "directional".to_owned(), ..scene.lights[0].clone() };
    for scale in [100, 150] {
        let mut bench = Bench::new(Session::new(scene.clone()));
        bench.size = vec2(1280.0, 720.0);
        bench.apply(Action::View(ViewChange::Scale(scale)));
        bench.session.settings.bottom_height = 420.0;
        bench.apply(Action::View(ViewChange::BottomTab("shader".to_owned())));
        let mut names = 0;
        for shape in bench.shapes() {
            if let Shape::Text(text) = shape
                && text.galley.text().starts_with("the light type: ")
            {
                assert!(!text.galley.elided, "{} at {scale} %", text.galley.text());
                names += 1;
            }
        }
        assert!(names > 0, "{scale} %");
    }
}

#[test]
fn paths_keep_both_ends_where_there_is_little_room() {
    let mut bench = bench_with(Vec::new());
    let folder = "/home/mira/courses/computer_graphics_2026/lab/shaders";
    bench.session.shaders.folders.shaders = Some(PathBuf::from(folder));
    bench.apply(Action::View(ViewChange::Scale(150)));
    bench.session.settings.bottom_height = 420.0;
    bench.apply(Action::View(ViewChange::BottomTab("shader".to_owned())));
    let shown = texts(&mut bench);
    let folder = shown.iter().find(|text| text.ends_with("lab/shaders")).expect("the folder that is watched");
    assert!(folder.starts_with("/home") && folder.contains('…'), "{folder}");
    // Next to the line of an error, the file name matters.
    bench.session.shaders.troubles = vec![broken_lambert()];
    bench.settle();
    let shown = texts(&mut bench);
    for file in ["…/gouraud.wgsl", "…/point.wgsl"] {
        assert!(shown.iter().any(|text| text == file), "{file}: {shown:?}");
    }
    bench.session.shaders.troubles.clear();
    bench.settle();
    let model = "reflection/lambert.wgsl";
    let row = bench.tree.iter().find(|s| s.label == format!("the model: {model}")).expect("its row").rect;
    bench.hover(row.center());
    let whole = format!("/home/mira/courses/computer_graphics_2026/lab/shaders/{model}");
    assert!(texts(&mut bench).contains(&whole), "{:?}", texts(&mut bench));
}

/// The painted texts.
fn texts(bench: &mut Bench) -> Vec<String> {
    let text = |s| if let Shape::Text(t) = s { Some(t.galley.text().to_owned()) } else { None };
    bench.shapes().into_iter().filter_map(text).collect()
}

#[test]
fn a_model_in_a_file_is_not_called_built_in() {
    let mut bench = bare();
    bench.session.shaders.folders.shaders = None;
    bench.apply(Action::View(ViewChange::BottomTab("shader".to_owned())));
    assert!(bench.says("Bare · ") && !bench.says("The shaders are built in."));
    assert!(bench.says("All but the model is built in."));
}

#[test]
fn what_was_taken_over_last_is_told_while_all_is_well() {
    let mut bench = bench_with(Vec::new());
    bench.session.shaders.last = Some(Reloaded { file: "loop.wgsl".to_owned(), milliseconds: 34.4 });
    bench.apply(Action::View(ViewChange::BottomTab("shader".to_owned())));
    assert!(bench.says("No errors") && bench.says("loop.wgsl loaded in 34 ms"));
    assert!(!bench.says("shader error"));
}

// ── custom models ──

#[test]
fn a_new_model_is_named_and_written() {
    let mut bench = bench_with(Vec::new());
    bench.key(Key::N, Modifiers::COMMAND | Modifiers::CTRL | Modifiers::SHIFT);
    assert_eq!(bench.session.authoring.draft, Some(ModelDraft { of: None, name: "my_model".to_owned() }));
    // The field has the focus, and typing replaces the suggestion.
    bench.frame(vec![Event::Text("größe".to_owned())]);
    bench.settle();
    assert!(bench.says("for example “groesse”"), "what would be right");
    assert!(bench.find("Create").expect("there").disabled);
    bench.key(Key::Enter, Modifiers::NONE);
    assert!(
        bench.session.authoring.draft.is_some() && bench.effects.is_empty(),
        "nothing is written under a wrong name"
    );
    bench.type_into("Name of the model", "phong");
    assert!(bench.says("There is already a model “phong”"));
    bench.type_into("Name of the model", "Student toon");
    assert!(bench.says("student_toon"), "says what it becomes");
    assert!(bench.says("/home/mira/lab/models/student_toon.wgsl"), "says where");
    bench.key(Key::Enter, Modifiers::NONE);
    let (name, id) = ("Student toon".to_owned(), "student_toon".to_owned());
    let new = Effect::NewModel { of: None, id, name };
    assert_eq!(bench.effects, [new]);
    assert_eq!(bench.session.authoring.draft, None);
}

#[test]
fn nothing_moves_when_a_name_is_wrong() {
    for percent in [100, 150] {
        let mut bench = bench_with(Vec::new());
        bench.apply(Action::View(ViewChange::Scale(percent)));
        bench.key(Key::N, Modifiers::COMMAND | Modifiers::CTRL | Modifiers::SHIFT);
        let place = |bench: &Bench| bench.ctx.memory(|m| m.area_rect(egui::Id::new("model draft")));
        let before = place(&bench).expect("open");
        for name in ["phong", "größe", "2 fast", "", "a fine name"] {
            bench.type_into("Name of the model", name);
            assert_eq!(place(&bench), Some(before), "“{name}” at {percent} %");
        }
    }
}

#[test]
fn the_shown_model_is_copied() {
    let mut bench = bench_with(Vec::new());
    bench.apply(Action::Edit(Edit::set(Part::Object(0), Object::reflection_model, "phong")));
    bench.click("Edit");
    bench.click("Duplicate the model as a file… Ctrl+Shift+D");
    assert_eq!(
        bench.session.authoring.draft,
        Some(ModelDraft { of: Some("phong".to_owned()), name: "my_phong".to_owned() })
    );
    bench.click("Create");
    let (of, id) = (Some("phong".to_owned()), "my_phong".to_owned());
    assert_eq!(bench.effects, [Effect::NewModel { of, name: id.clone(), id }]);
    bench.key(Key::D, Modifiers::COMMAND | Modifiers::CTRL | Modifiers::SHIFT);
    assert!(bench.session.authoring.draft.is_some());
    bench.key(Key::Escape, Modifiers::NONE);
    assert_eq!(bench.session.authoring.draft, None, "Escape drops it");
}

#[test]
fn the_chooser_leads_to_custom_models() {
    let mut bench = bench_with(Vec::new());
    bench.key(Key::R, Modifiers::NONE);
    for button in ["New model…", "Duplicate as a file…", "Open in editor"] {
        let seen = bench.find(button).unwrap_or_else(|| panic!("{button}"));
        assert!(!seen.disabled && seen.rect.bottom() < 720.0, "{button}: {:?}", seen.rect);
    }
    bench.click("New model…");
    assert!(bench.session.authoring.draft.is_some() && !bench.session.view.chooser_open);
    assert_eq!(*bench.session.document, Scene::default(), "no model was chosen on the way");
    let mut bench = bench_with(Vec::new());
    bench.key(Key::R, Modifiers::NONE);
    bench.click("Open in editor");
    let path = PathBuf::from("/home/mira/lab/shaders/reflection/lambert.wgsl");
    assert_eq!(bench.effects, [Effect::OpenInEditor { path, line: 1 }]);
}

#[test]
fn a_model_that_was_asked_for_is_chosen_once_it_is_there() {
    let mut bench = bench_with(Vec::new());
    bench.registry = Registry::default();
    bench.session.authoring.wanted_model = Some("phong".to_owned());
    bench.settle();
    assert_eq!(bench.session.document.reflection_model, "lambert", "not there yet");
    bench.session.say(Severity::Info, "my_phong.wgsl was written.");
    bench.registry = Registry::builtin();
    bench.settle();
    assert_eq!(bench.session.document.reflection_model, "phong");
    assert!(bench.says("my_phong.wgsl was written."), "what follows from it does not hide it");
    bench.apply(Action::Edit(Edit::set(Part::Scene, Scene::reflection_model, "ward")));
    bench.settle();
    assert_eq!(bench.session.document.reflection_model, "ward", "it was asked for once");
}

#[test]
fn a_model_that_was_asked_for_in_a_view_is_chosen_in_that_view() -> Result<(), Box<dyn std::error::Error>> {
    let folder = tempfile::tempdir()?;
    let models = folder.path().join("models");
    let mut bench = bench_with(Vec::new());
    bench.registry.set_custom_folder(&models);
    bench.session.document.amend(|scene| scene.variants.push(Variant::default()));
    bench.apply(Action::Compare(CompareCommand::Activate(1)));
    let name = || "my_velvet".to_owned();
    write(&Effect::NewModel { of: None, id: name(), name: name() }, &mut bench.session, &bench.registry);
    // The user goes on in another view while it is compiled.
    bench.apply(Action::Compare(CompareCommand::Activate(0)));
    let file = models.join("my_velvet.wgsl");
    let model = custom::read(&file, &fs::read_to_string(&file)?, &bench.registry);
    bench.registry.put_custom_model(model.map_err(|all| all[0].to_string())?);
    bench.settle();
    let document = &bench.session.document;
    assert_eq!(document.variants[0].reflection_model.as_deref(), Some("my_velvet"));
    assert_eq!((&*document.reflection_model, bench.session.active()), ("lambert", 0));
    Ok(())
}

#[test]
fn a_model_that_vanishes_leaves_a_sentence() {
    let scene = Scene { reflection_model: "my_velvet".to_owned(), ..Scene::default() };
    let mut bench = Bench::new(Session::new(scene));
    bench.session.shaders = folders();
    bench.size = vec2(1280.0, 720.0);
    bench.apply(Action::View(ViewChange::BottomTab("shader".to_owned())));
    assert!(bench.says("the file models/my_velvet.wgsl is missing"));
    bench.click("Choose another model");
    assert!(bench.session.view.chooser_open);
    bench.key(Key::Escape, Modifiers::NONE);
    bench.session.shaders.troubles =
        vec![trouble("models/my_velvet.wgsl", 3, 9, "  x", "expected a declaration", &[])];
    bench.settle();
    assert!(bench.says("models/my_velvet.wgsl:3:9: expected a declaration"));
    assert!(bench.says("The file models/my_velvet.wgsl has no working version yet"));
    // Nothing that it can be asked causes it to stop.
    for ask in [ModelCommand::Duplicate, ModelCommand::EditShown] {
        bench.apply(Action::Model(ask));
    }
    assert_eq!(bench.session.authoring.draft, None);
    let path = PathBuf::from("/home/mira/lab/models/my_velvet.wgsl");
    assert!(bench.effects.contains(&Effect::OpenInEditor { path, line: 3 }));
    for key in [Key::T, Key::Num1, Key::F1, Key::Tab] {
        bench.key(key, Modifiers::NONE);
    }
}

// ── files and editors ──

#[test]
fn the_command_of_the_editor_is_split_and_filled_in() {
    let file = Path::new("/home/mira/my lab/x.wgsl");
    let command = |variable| editor_command(variable, file, 12);
    let expected = |program: &str, arguments: &[&str]| {
        Some((program.to_owned(), arguments.iter().map(|a| (*a).to_owned()).collect::<Vec<_>>()))
    };
    let path = "/home/mira/my lab/x.wgsl";
    assert_eq!(command(Some("gedit")), expected("gedit", &[path]));
    assert_eq!(command(Some("  emacsclient  -n  ")), expected("emacsclient", &["-n", path]));
    let goto = "/home/mira/my lab/x.wgsl:12";
    assert_eq!(command(Some("code --goto {file}:{line}")), expected("code", &["--goto", goto]));
    assert_eq!(command(Some("vim +{line}")), expected("vim", &["+12", path]));
    for nothing in [None, Some(""), Some("   ")] {
        assert_eq!(command(nothing), None, "the system chooses");
    }
    // The braces of a file name are its own.
    let odd = Path::new("/tmp/{line}.wgsl");
    assert_eq!(editor_command(Some("ed {file}"), odd, 3), expected("ed", &["/tmp/{line}.wgsl"]));
}

#[cfg(unix)]
#[test]
fn an_editor_is_started_and_a_failure_is_told() -> Result<(), Box<dyn std::error::Error>> {
    use std::os::unix::fs::PermissionsExt as _;
    let folder = tempfile::tempdir()?;
    let (script, told) = (folder.path().join("editor"), folder.path().join("told"));
    // Renamed at the end, so that the test never reads half of it.
    let text =
        format!("#!/bin/sh\nprintf '%s\\n' \"$@\" > '{0}.part'\nmv '{0}.part' '{0}'\n", told.display());
    fs::write(&script, text)?;
    fs::set_permissions(&script, fs::Permissions::from_mode(0o755))?;
    let file = folder.path().join("a model.wgsl");
    let editors = Editors::default();
    let (done, woken) = std::sync::mpsc::channel();
    let wake = || {
        let done = done.clone();
        move || {
            let _ = done.send(());
        }
    };
    let patience = Duration::from_secs(60);
    editors.open(Some(&format!("{} -n +{{line}}", script.display())), &file, 7, wake());
    let started = Instant::now();
    while !told.exists() && started.elapsed() < patience {
        std::thread::sleep(Duration::from_millis(5));
    }
    assert_eq!(fs::read_to_string(&told)?, format!("-n\n+7\n{}\n", file.display()));
    assert_eq!(editors.take(), [""; 0]);
    for (command, why) in [("/nonexistent/editor", "could not be started"), ("false", "ended with")] {
        editors.open(Some(command), &file, 1, wake());
        woken.recv_timeout(patience)?;
        let complaints = editors.take();
        assert_eq!(complaints.len(), 1);
        for word in [why, command, "LCM_EDITOR", &*file.to_string_lossy()] {
            assert!(complaints[0].contains(word), "{complaints:?}");
        }
    }
    // An editor that stays open blocks nothing.
    let started = Instant::now();
    editors.open(Some("sh -c sleep\t10 {file}"), &file, 1, wake());
    assert!(started.elapsed() < Duration::from_secs(5));
    Ok(())
}

#[test]
fn a_file_is_written_whole_and_never_over_another_one() -> Result<(), Box<dyn std::error::Error>> {
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("models/deep/my_velvet.wgsl");
    write_new(&path, "first\n")?;
    assert_eq!(fs::read_to_string(&path)?, "first\n");
    let again = write_new(&path, "second\n").expect_err("it is there");
    assert_eq!(again.kind(), std::io::ErrorKind::AlreadyExists);
    assert_eq!(fs::read_to_string(&path)?, "first\n");
    let left: Vec<_> = fs::read_dir(path.parent().expect("a folder"))?.collect();
    assert_eq!(left.len(), 1, "nothing is left lying about");
    fs::write(folder.path().join("file"), "")?;
    assert!(write_new(&folder.path().join("file/x.wgsl"), "").is_err());
    Ok(())
}

#[test]
fn new_models_are_written_announced_and_chosen() -> Result<(), Box<dyn std::error::Error>> {
    let folder = tempfile::tempdir()?;
    let models = folder.path().join("models");
    let mut bench = bench_with(Vec::new());
    bench.registry.set_custom_folder(&models);
    let name = || "my_velvet".to_owned();
    let new = Effect::NewModel { of: None, id: name(), name: name() };
    assert_eq!(write(&new, &mut bench.session, &bench.registry), None);
    let file = models.join("my_velvet.wgsl");
    let text = fs::read_to_string(&file)?;
    let said = bench.session.messages.last().map(|m| m.text.clone()).unwrap_or_default();
    assert!(said.contains(&*file.to_string_lossy()) && said.contains("was written"), "{said}");
    let shown = bench.session.code.visible().and_then(OpenCode::path);
    assert_eq!(
        (shown, bench.session.view.bottom_tab.as_str()),
        (Some(&*file), "code"),
        "it is there to be edited"
    );
    assert!(text.contains("choice and flag"), "all types");
    assert_eq!(bench.session.authoring.wanted_model, Some(name()));
    // As the reload system does when it sees the file.
    let model = custom::read(&file, &text, &bench.registry).map_err(|all| all[0].to_string())?;
    bench.registry.put_custom_model(model);
    bench.settle();
    assert_eq!(bench.session.document.reflection_model, "my_velvet");
    assert!(bench.says("My velvet"), "the name that its file says");
    bench.apply(Action::View(ViewChange::BottomTab("shader".to_owned())));
    assert!(bench.says("the model: models/my_velvet.wgsl") && !bench.says("my_velvet.wgsl: edited"));
    bench.key(Key::R, Modifiers::NONE);
    assert!(bench.find("Custom models").is_some(), "a family of its own");
    bench.key(Key::Escape, Modifiers::NONE);

    // The same again is refused, with another question.
    fs::write(&file, "mine")?;
    let copy = |id: &str, name: &str| Effect::NewModel {
        of: Some("phong".to_owned()),
        id: id.to_owned(),
        name: name.to_owned(),
    };
    write(&copy("my_velvet", "My velvet"), &mut bench.session, &bench.registry);
    assert_eq!(fs::read_to_string(&file)?, "mine");
    let asked_again = ModelDraft { of: Some("phong".to_owned()), name: "My velvet".to_owned() };
    assert_eq!(bench.session.authoring.draft, Some(asked_again));
    assert!(bench.session.messages.last().is_some_and(|m| m.text.contains("already exists")));
    write(&copy("my_phong", "My Phong"), &mut bench.session, &bench.registry);
    let file = models.join("my_phong.wgsl");
    let model = custom::read(&file, &fs::read_to_string(&file)?, &bench.registry)
        .map_err(|all| all[0].to_string())?;
    assert!(model.entry.declaration.equation.len() > 1, "equation and all");
    assert_eq!(model.entry.declaration.name, "My Phong", "as it was typed");
    let name = "x".to_owned();
    let gone = Effect::NewModel { of: Some("gone".to_owned()), id: name.clone(), name };
    write(&gone, &mut bench.session, &bench.registry);
    assert!(bench.session.messages.last().is_some_and(|m| m.text.contains("no reflection model “gone”")));
    // A path that cannot be a folder.
    bench.registry.set_custom_folder(&file);
    write(&new, &mut bench.session, &bench.registry);
    assert!(bench.session.messages.last().is_some_and(|m| m.text.contains("could not be written")));
    Ok(())
}

#[test]
fn shaders_are_written_out_once_and_told() -> Result<(), Box<dyn std::error::Error>> {
    let folder = tempfile::tempdir()?;
    let mut bench = bench_with(Vec::new());
    let export = Effect::ExportShaders(folder.path().to_owned());
    assert_eq!(write(&export, &mut bench.session, &bench.registry).as_deref(), Some(folder.path()));
    let loop_file = folder.path().join("shaders/loop.wgsl");
    fs::write(&loop_file, "// mine")?;
    let last = |b: &Bench| b.session.messages.last().map(|m| m.text.clone()).unwrap_or_default();
    assert!(last(&bench).contains("files of shaders"), "{}", last(&bench));
    write(&export, &mut bench.session, &bench.registry);
    assert_eq!(fs::read_to_string(&loop_file)?, "// mine");
    assert!(last(&bench).contains("; 1 file that differ were not changed"), "{}", last(&bench));
    let impossible = Effect::ExportShaders(loop_file);
    assert_eq!(write(&impossible, &mut bench.session, &bench.registry), None);
    assert!(last(&bench).contains("could not be written"), "{}", last(&bench));
    Ok(())
}

/// The minimum of a custom model file.
const BARE: &str = "fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {
    return Terms(vec3(0.0), vec3(max(dot(frame.n, l), 0.0)), vec3(0.0));
}
";

/// A window with a model without a description.
fn bare() -> Bench {
    let mut bench = bench_with(Vec::new());
    let path = Path::new("/home/mira/lab/models/bare.wgsl");
    let text = format!("/* lcm\n{{}}\n*/\n{BARE}");
    match custom::read(path, &text, &bench.registry) {
        Ok(model) => bench.registry.put_custom_model(model),
        Err(problems) => panic!("{}", problems[0]),
    }
    bench.apply(Action::Edit(Edit::set(Part::Scene, Scene::reflection_model, "bare")));
    bench
}

#[test]
fn a_model_without_equation_source_and_laws_is_shown_as_it_is() {
    let mut bench = bare();
    assert!(bench.says("Bare"));
    assert!(!bench.says("Terms: all"), "no equation, no terms to choose from");
    assert!(bench.says("This model has no knobs."));
    bench.key(Key::R, Modifiers::NONE);
    bench.frame(vec![Event::Text("bare".to_owned())]);
    bench.settle();
    let row = bench.tree.iter().rfind(|s| s.label == "Bare").map(|s| s.rect).expect("listed");
    bench.hover(row.center());
    assert!(!bench.tree.iter().any(|s| s.label == "✗ not reciprocal"), "what is not claimed is not denied");
}

/// Asserts that these are completely within the strip.
fn whole(bench: &Bench, labels: &[&str]) {
    let scale = bench.area.zoom;
    let bottom = (720.0 - 22.0) / scale;
    for label in labels {
        let all: Vec<_> = bench.tree.iter().filter(|s| s.label.starts_with(label)).map(|s| s.rect).collect();
        let low = all.iter().max_by(|a, b| a.bottom().total_cmp(&b.bottom())).expect(label);
        assert!(
            low.bottom() <= bottom && low.height() > 12.0 && low.right() <= 1280.0 / scale,
            "{label}: {low:?} of {bottom}"
        );
    }
}

#[test]
fn the_panel_is_whole_where_everything_is_larger() {
    for scale in [100, 150] {
        let mut bench = bench_with(Vec::new());
        bench.apply(Action::View(ViewChange::Scale(scale)));
        bench.apply(Action::View(ViewChange::BottomTab("shader".to_owned())));
        whole(&bench, &["New model…", "Duplicate as a file…", "Open in editor"]);
        bench.session.shaders.troubles = vec![broken_lambert()];
        bench.settle();
        whole(&bench, &["Open in editor", "line 12: ", "The picture shows the last good"]);
    }
}

// ── pictures ──

#[test]
#[ignore = "draws pictures to look at: scripts/pictures"]
fn pictures_of_the_shader_panel() -> Result<(), Box<dyn std::error::Error>> {
    let folder = crate::helpers::pictures::picture_folder()?;
    type Setup = fn(&mut Bench);
    fn light(b: &mut Bench) {
        b.apply(Action::View(ViewChange::Theme(ThemeChoice::Light)));
    }
    fn large(b: &mut Bench) {
        b.apply(Action::View(ViewChange::Scale(150)));
    }
    fn one(b: &mut Bench) {
        b.session.shaders.troubles = vec![broken_lambert()];
    }
    fn several(b: &mut Bench) {
        let long = "the value of expression [21] has the type vec3<f32>, but a value of the type f32 was expected here, since the function `ggx` takes a number";
        b.session.shaders.troubles = vec![
            broken_lambert(),
            trouble(
                "optics/fresnel.wgsl",
                41,
                18,
                "        let x = schlick(f0, cos_h) * (1.0 + \t/* 漢字 */ ;",
                "expected expression, found `;`",
                &["Lambert", "Blinn–Phong (normalised)", "Cook–Torrance", "Disney"],
            ),
            trouble(
                "optics/distribution.wgsl",
                7,
                12,
                "    return ggx(vec3(cos_h, cos_h, cos_h), roughness_of_a_very_rough_surface_with_a_long_name * 2.0, another_argument, and_one_more);",
                long,
                &["Microfacet"],
            ),
            trouble(
                "light/spot.wgsl",
                3,
                1,
                "func incident_spot(light: Light, p: vec3<f32>) -> Incident {",
                "expected a global item (`struct`, `const`, `fn` …), found `func`",
                &[],
            ),
        ];
    }
    fn built_in(b: &mut Bench) {
        b.session.shaders = ShaderStatus::default();
        b.apply(Action::View(ViewChange::BottomTab("shader".to_owned())));
    }
    fn well(b: &mut Bench) {
        b.session.shaders.last =
            Some(Reloaded { file: "reflection/lambert.wgsl".to_owned(), milliseconds: 34.4 });
        b.apply(Action::View(ViewChange::BottomTab("shader".to_owned())));
    }
    fn vanished(b: &mut Bench) {
        b.session.document.amend(|scene| scene.reflection_model = "my_velvet".to_owned());
        b.session.shaders.troubles = vec![trouble(
            "models/my_velvet.wgsl",
            3,
            9,
            "  let x = ;",
            "expected expression, found `;`",
            &[],
        )];
    }
    fn draft(b: &mut Bench) {
        b.key(Key::N, Modifiers::COMMAND | Modifiers::CTRL | Modifiers::SHIFT);
    }
    let states: &[(&str, (f32, f32), u8, &[Setup])] = &[
        ("one", (1280.0, 720.0), 46, &[one]),
        ("one-bright", (1280.0, 720.0), 250, &[one]),
        ("one-black", (1280.0, 720.0), 0, &[one]),
        ("one-large", (1280.0, 720.0), 46, &[large, one]),
        ("one-light", (1280.0, 720.0), 184, &[light, one]),
        ("one-light-black", (1280.0, 720.0), 0, &[light, one]),
        ("one-wide", (1920.0, 1080.0), 46, &[one]),
        ("several", (1280.0, 720.0), 46, &[several]),
        ("several-wide-light", (1920.0, 1080.0), 250, &[light, several]),
        ("several-large", (1280.0, 720.0), 46, &[large, light, several]),
        ("several-large-wide", (1920.0, 1080.0), 46, &[large, several]),
        (
            "elsewhere",
            (1280.0, 720.0),
            46,
            &[|b| b.session.shaders.troubles = vec![Trouble { stale: Vec::new(), ..broken_lambert() }]],
        ),
        ("built-in", (1280.0, 720.0), 46, &[built_in]),
        ("built-in-large", (1280.0, 720.0), 46, &[large, light, built_in]),
        ("well", (1280.0, 720.0), 46, &[well]),
        ("well-wide", (1920.0, 1080.0), 46, &[light, well]),
        ("vanished", (1280.0, 720.0), 46, &[vanished]),
        ("bare", (1280.0, 720.0), 46, &[|b| *b = bare()]),
        (
            "bare-about",
            (1280.0, 720.0),
            46,
            &[|b| {
                *b = bare();
                b.key(Key::R, Modifiers::NONE);
                let row = b.tree.iter().rfind(|s| s.label == "Bare").map(|s| s.rect.center());
                b.hover(row.unwrap_or_default());
            }],
        ),
        ("draft", (1280.0, 720.0), 46, &[draft]),
        (
            "draft-wrong",
            (1280.0, 720.0),
            46,
            &[light, draft, |b| b.type_into("Name of the model", "My Velvet")],
        ),
        ("draft-large", (1280.0, 720.0), 46, &[large, draft, |b| b.type_into("Name of the model", "phong")]),
        ("chooser-own", (1280.0, 720.0), 46, &[|b| b.key(Key::R, Modifiers::NONE)]),
        ("chooser-own-large", (1280.0, 720.0), 46, &[large, |b| b.key(Key::R, Modifiers::NONE)]),
        ("edit-menu", (1280.0, 720.0), 46, &[|b| b.click("Edit")]),
        ("export", (1280.0, 720.0), 46, &[built_in, |b| b.click("Export shaders for editing…")]),
    ];
    let only = std::env::var("LCM_PANEL_ONLY").ok().filter(|o| !o.is_empty());
    for (name, size, ground, setups) in states {
        if only.as_ref().is_some_and(|o| !o.split(',').any(|o| o == *name)) {
            continue;
        }
        let mut bench = bench_with(Vec::new());
        bench.size = (*size).into();
        bench.session.facts.frame_ms = 16.6;
        bench.session.facts.backend = "Vulkan".to_owned();
        for setup in *setups {
            setup(&mut bench);
            bench.settle();
        }
        bench.picture(&folder.join(format!("shader-{name}.png")), Color32::from_gray(*ground))?;
    }
    Ok(())
}
