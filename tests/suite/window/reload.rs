//! The open window follows the file of its scene, automatically and without any input.

#![cfg(target_os = "linux")]

use std::{
    fs,
    io::Write as _,
    path::Path,
    thread,
    time::{Duration, Instant},
};

use lights_camera_models::{library::assets::export, registry::Registry};

use crate::{
    helpers::keyboard::{Key, Keyboard},
    helpers::screen::{Picture, Running, Screen},
};

/// A sphere with this colour in the middle of the picture.
fn scene(colour: [u8; 3]) -> String {
    format!(
        r#"{{
  "scene_size": {{ "height": 10, "width": 10, "depth": 10 }},
  "reflection_model": "lambert",
  "shading_model": "phong",
  "lights": [{{ "type": "point", "position": [7.5, 8, 9], "intensity": 60 }}],
  "observer": {{ "position": [5, 5, 9.5], "direction": [0, 0, -1], "field_of_view": 45 }},
  "objects": [
    {{ "type": "sphere", "position": [5, 5, 5], "size": 2, "material": {{ "base_colour": {colour:?} }} }}
  ]
}}"#
    )
}

/// True if the picture shows a sphere in only one channel.
fn shows(channel: usize) -> impl Fn(&Picture) -> bool {
    move |picture| {
        let lit = |p: [u8; 3]| p[channel] > 100 && (0..3).all(|c| c == channel || p[c] < 40);
        picture.count(220..920, 80..560, lit) > 5000
    }
}

/// True if there is a badge in the colour of errors at the upper left of the picture.
fn error_badge(picture: &Picture) -> bool {
    picture.count(210..700, 40..90, |p| p == [0xff, 0x8a, 0x7a]) > 100
}

/// Saves as many editors do: another file replaces the old one.
fn save_by_renaming(file: &Path, text: &str) {
    let new = file.with_extension("new");
    fs::write(&new, text).expect("writable");
    fs::rename(&new, file).expect("renamed");
}

/// Saves as the others do: the file is emptied, then written.
fn save_in_place(file: &Path, text: &str) {
    let mut file = fs::File::create(file).expect("writable");
    thread::sleep(Duration::from_millis(60));
    file.write_all(text.as_bytes()).expect("writable");
}

#[test]
fn an_open_window_shows_what_is_edited_elsewhere() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("room.json");
    fs::write(&file, scene([255, 0, 0])).expect("writable");
    let screen = Screen::new(1280, 720);
    let mut window = screen.start(&["view", &file.to_string_lossy(), "--size", "1280x720"]);
    window.until("a red sphere", shows(0));

    save_by_renaming(&file, &scene([0, 255, 0]));
    let picture = window.until("a green sphere", shows(1));
    assert!(!shows(0)(&picture));

    save_in_place(&file, &scene([0, 0, 255]));
    window.until("a blue sphere", shows(2));
    let picture = window.rest();
    assert!(shows(2)(&picture) && !error_badge(&picture));
    assert_eq!(window.said(), "", "an empty file for a moment is no error");

    // A resting window uses no processor time at all.
    let begin = Instant::now();
    loop {
        let before = window.ticks();
        thread::sleep(Duration::from_secs(1));
        if window.ticks() == before {
            break;
        }
        assert!(begin.elapsed() < Duration::from_secs(60), "the window never rests");
    }

    let broken = scene([255, 0, 0]).replace("\"size\": 2", "\"size\": -2");
    save_by_renaming(&file, &broken);
    let picture = window.until("a badge", error_badge);
    assert!(shows(2)(&picture), "the last good version stays");
    let line = format!("{}:", file.display());
    let said = window.said();
    assert!(said.starts_with(&line) && said.contains("size is -2"), "{said}");
    assert_eq!(said.lines().count(), 1, "{said}");

    save_in_place(&file, &scene([255, 0, 0]));
    let picture = window.until("a red sphere again", |p| shows(0)(p) && !error_badge(p));
    assert!(!shows(2)(&picture));
}

/// The scene as a table.
fn table([r, g, b]: [u8; 3]) -> String {
    format!(
        "part,type,position,direction,intensity,size,material.base_colour,reflection_model,shading_model,scene_size.height,scene_size.width,scene_size.depth,field_of_view
scene,,,,,,,lambert,phong,10,10,10,
light,point,7.5 8 9,,60
observer,,5 5 9.5,0 0 -1,,,,,,,,,45
object,sphere,5 5 5,,,2,{r} {g} {b}
"
    )
}

#[test]
fn an_open_window_follows_a_table() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("room.csv");
    fs::write(&file, table([255, 0, 0])).expect("writable");
    let screen = Screen::new(1280, 720);
    let mut window = screen.start(&["view", &file.to_string_lossy(), "--size", "1280x720"]);
    window.until("a red sphere", shows(0));
    save_by_renaming(&file, &table([0, 255, 0]));
    let picture = window.until("a green sphere", shows(1));
    assert!(!shows(0)(&picture));
    save_in_place(&file, &table([0, 0, 255]));
    window.until("a blue sphere", shows(2));
    assert_eq!(window.said(), "", "an empty file for a moment is no error");
    save_by_renaming(&file, &table([255, 0, 0]).replace(",,,2,", ",,,-2,"));
    let picture = window.until("a badge", error_badge);
    assert!(shows(2)(&picture), "the last good version stays");
    let said = window.said();
    assert!(said.starts_with(&format!("{}:5:", file.display())) && said.contains("size is -2"), "{said}");
    save_in_place(&file, &table([0, 255, 0]));
    window.until("a green sphere again", |p| shows(1)(p) && !error_badge(p));
}

#[test]
fn an_open_window_follows_the_file_of_a_lamp() {
    let folder = tempfile::tempdir().expect("a folder");
    let (file, lamp) = (folder.path().join("room.json"), folder.path().join("lamp.ies"));
    let ies =
        |candela: u32| format!("TILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 10\n0 180\n0\n{candela} {candela}\n");
    let point = "\"type\": \"point\", \"position\": [7.5, 8, 9], \"intensity\": 60";
    let photometric = "\"type\": \"photometric\", \"position\": [7.5, 8, 9], \"direction\": [0, -1, 0], \"file\": \"lamp.ies\"";
    let text = scene([255, 0, 0]);
    assert!(text.contains(point));
    fs::write(&file, text.replace(point, photometric)).expect("writable");
    fs::write(&lamp, ies(60)).expect("writable");
    let screen = Screen::new(1280, 720);
    let mut window = screen.start(&["view", &file.to_string_lossy(), "--size", "1280x720"]);
    window.until("a red sphere", shows(0));
    save_in_place(&lamp, &ies(1));
    window.until("a dark sphere", |picture| !shows(0)(picture));
    save_by_renaming(&lamp, &ies(60));
    window.until("a red sphere again", shows(0));
    assert_eq!(window.said(), "", "an empty file for a moment is no error");
    save_by_renaming(&lamp, "TILT=NONE\n1 1");
    let said = until_said(&window, |said| !said.is_empty());
    assert!(said.contains("lamp.ies:2: the file ends before the multiplier"), "{said}");
    assert!(shows(0)(&window.rest()), "the last good version stays");
}

/// A custom model that shows the light on its surface in one colour.
fn custom_model(colour: &str, more: &str) -> String {
    format!(
        "/* lcm
{{
    \"name\": \"Tinted\",
    \"parameters\": [{more}]
}}
*/
fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {{
    return Terms(vec3(0.0), {colour} * max(dot(frame.n, l), 0.0), vec3(0.0));
}}
"
    )
}

/// Waits until the window has written a matching message to standard error since the last valid state, and
/// returns it.
fn until_said(window: &Running<'_>, expected: impl Fn(&str) -> bool) -> String {
    let begin = Instant::now();
    loop {
        let said = window.said();
        let news = said.rsplit("up to date again.").next().unwrap_or_default().trim();
        if expected(news) {
            return news.to_owned();
        }
        assert!(begin.elapsed() < Duration::from_secs(60), "it said: {said}");
        thread::sleep(Duration::from_millis(20));
    }
}

/// True if the picture contains the colour of errors: the badge and the frame of stale shaders.
fn stale(picture: &Picture) -> bool {
    picture.count(210..920, 40..560, |p| p == [0xff, 0x8a, 0x7a]) > 1000
}

#[test]
fn an_open_window_shows_what_is_edited_in_shaders_and_never_loses_the_picture() {
    let folder = tempfile::tempdir().expect("a folder");
    let assets = folder.path().join("assets");
    export(&assets, &Registry::builtin()).expect("written");
    let model = assets.join("models/tinted.wgsl");
    fs::write(&model, custom_model("vec3(1.0, 0.0, 0.0)", "")).expect("writable");
    let room = folder.path().join("room.json");
    fs::write(&room, scene([255, 255, 255]).replace("\"lambert\"", "\"tinted\"")).expect("writable");
    let screen = Screen::new(1280, 720);
    let mut window = screen.start(&[
        "view",
        &room.to_string_lossy(),
        "--size",
        "1280x720",
        "--assets",
        &assets.to_string_lossy(),
    ]);
    window.until("a red sphere", shows(0));

    // The text alone, then a parameter too, which changes the layout of the rows.
    save_by_renaming(&model, &custom_model("vec3(0.0, 1.0, 0.0)", ""));
    window.until("a green sphere", shows(1));
    let knob = r#"{ "name": "tint", "type": "colour", "default": [0, 0, 255] }, "base_colour""#;
    save_in_place(&model, &custom_model("m.tint", knob));
    window.until("a blue sphere", shows(2));
    assert_eq!(window.said(), "");

    // Five errors; each leaves the blue sphere and reports its position.
    for (mistake, line) in [
        (custom_model("m.tint", knob).replace("dot(frame.n, l)", "dot(frame.n l)"), "8:"),
        (custom_model("m.tnt", knob), "8:"),
        (custom_model("m.tint", knob).replace("\"default\": [0, 0, 255]", "\"default\": [0, 0]"), "4:"),
        (custom_model("1u", knob), "8:"),
        (custom_model("m.tint", knob).replace("fn response", "fn answer"), ""),
    ] {
        save_by_renaming(&model, &mistake);
        let picture = window.until("a badge", stale);
        assert!(shows(2)(&picture), "the last good version stays");
        let place = format!("{}:{line}", model.display());
        let said = until_said(&window, |news| news.contains(&place) && news.contains('^'));
        assert!(!said.contains("panicked"), "{said}");
        save_in_place(&model, &custom_model("m.tint", knob));
        until_said(&window, str::is_empty);
        let picture = window.until("no badge", |p| !stale(p));
        assert!(shows(2)(&picture));
    }

    // A file that all shaders share, broken for all; then the light loop removes the green.
    let file = assets.join("shaders/loop.wgsl");
    let text = fs::read_to_string(&file).expect("there");
    save_in_place(&file, &text.replace("fn illuminate(", "fn illuminate(("));
    assert!(shows(2)(&window.until("a badge", stale)));
    let turned =
        text.replace("return colour +", "return (colour +").replace("selection);\n}", "selection)).zyx;\n}");
    assert!(turned.contains(".zyx;") && turned.contains("(colour +"), "the loop ends as the test expects");
    save_by_renaming(&file, &turned);
    let picture = window.until("a red sphere", shows(0));
    assert!(!stale(&picture) || !stale(&window.until("no badge", |p| !stale(p))));
    // A missing file is reported, and the picture stays.
    fs::remove_file(&model).expect("removed");
    assert!(shows(0)(&window.until("a badge", stale)));
    fs::write(&model, custom_model("vec3(0.0, 1.0, 0.0)", "")).expect("writable");
    window.until("a green sphere", |p| shows(1)(p) && !stale(p));
}

/// A model whose response does something before it returns.
fn doing(global: &str, what: &str) -> String {
    custom_model("vec3(0.0, 1.0, 0.0)", "").replace(
        "fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {",
        &format!(
            "{global}\nfn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {{\n    var x = frame.n.x;\n    {what}"
        ),
    )
}

#[test]
fn hostile_models_neither_end_nor_freeze_an_open_window() {
    let folder = tempfile::tempdir().expect("a folder");
    let models = folder.path().join("models");
    fs::create_dir(&models).expect("writable");
    let model = models.join("tinted.wgsl");
    fs::write(&model, custom_model("vec3(1.0, 0.0, 0.0)", "")).expect("writable");
    let room = folder.path().join("room.json");
    let text = scene([255, 255, 255]).replace("\"lambert\"", "\"tinted\"");
    fs::write(&room, &text).expect("writable");
    let screen = Screen::new(1280, 720);
    let models = models.to_string_lossy().into_owned();
    let mut window =
        screen.start(&["view", &room.to_string_lossy(), "--size", "1280x720", "--models", &models]);
    window.until("a red sphere", shows(0));
    let calls =
        (0..26).map(|i| format!("fn f{}(x: f32) -> f32 {{ return f{i}(x) + f{i}(x + 1.0); }}\n", i + 1));
    let calls = format!("fn f0(x: f32) -> f32 {{ return x; }}\n{}", calls.collect::<String>());
    for (name, hostile) in [
        ("workgroup", doing("var<workgroup> W: f32;", "W = x; x = W;")),
        ("nested", doing("", &format!("x = {}x{};", "(-".repeat(3000), ")".repeat(3000)))),
        ("summands", doing("", &format!("x = x{};", " + x".repeat(20_000)))),
        ("array", doing("", "var a: array<f32, 1000000>; a[u32(x)] = x; x = a[u32(x + 1.0)];")),
        ("calls", doing(&calls, "x = f26(x);")),
        ("endless", doing("", "while x > -2.0 { x = x + 1.0; if x > 1e6 { x = 0.0; } }")),
    ] {
        save_by_renaming(&model, &hostile);
        let begin = Instant::now();
        until_said(&window, |news| news.contains("tinted.wgsl:"));
        println!("{name}: told after {:?}", begin.elapsed());
        assert!(shows(0)(&window.until("a badge", stale)), "{name}: the last good version stays");
        // It still responds: another scene is shown.
        save_by_renaming(&room, &text.replace("\"size\": 2,", "\"size\": 2.5,"));
        window.until("a larger sphere", |p| shows(0)(p));
        save_by_renaming(&room, &text);
        save_by_renaming(&model, &custom_model("vec3(1.0, 0.0, 0.0)", ""));
        until_said(&window, str::is_empty);
        window.until("no badge", |p| shows(0)(p) && !stale(p));
    }
    // The twin: a harmless model is drawn.
    save_by_renaming(&model, &doing("", "x = x + 1.0;"));
    window.until("a green sphere", shows(1));
}

#[test]
fn a_new_model_is_named_in_whole_before_the_window_rests() {
    let folder = tempfile::tempdir().expect("a folder");
    let models = folder.path().to_string_lossy().into_owned();
    let room = folder.path().join("room.json");
    fs::write(&room, scene([255, 255, 255])).expect("writable");
    let screen = Screen::new(1280, 720);
    let mut window =
        screen.start(&["view", &room.to_string_lossy(), "--size", "1280x720", "--models", &models]);
    window.until("a sphere", |p| p.count(220..920, 80..560, |at| at[0] > 200) > 5000);
    let mut keyboard = Keyboard::new(screen.display());
    keyboard.point_at(560, 600);
    window.rest();
    let name = |picture: &Picture| -> Vec<_> {
        (2..34).flat_map(|y| (470..900).map(move |x| (x, y))).map(|(x, y)| picture.at(x, y)).collect()
    };
    // Letters that nothing else on the screen has.
    for (i, letter) in [Key::Q, Key::X, Key::W, Key::Z].into_iter().enumerate() {
        keyboard.press(&[Key::Control, Key::Shift, Key::D]);
        window.rest();
        for _ in 0..=i {
            keyboard.press(&[letter]);
        }
        window.rest();
        let before = name(&window.rest());
        keyboard.press(&[Key::Return]);
        let begin = Instant::now();
        while fs::read_dir(folder.path()).expect("there").count() < i + 2 {
            assert!(begin.elapsed() < Duration::from_secs(60), "no file is written");
            thread::sleep(Duration::from_millis(20));
        }
        // The file is noticed, read and tried.
        window.until("another name", |picture| name(picture) != before);
        for _ in 0..4 {
            window.rest();
        }
        let rested = window.rest();
        keyboard.move_by(1, 0);
        window.rest();
        let moved = window.rest();
        assert!(name(&rested) == name(&moved), "what was drawn last was not what there is: model {i}");
    }
}
