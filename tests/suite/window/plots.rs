//! The plots of the window: the values, the handle, the list, what is calculated and when, files.
//!
//! `scripts/pictures` writes pictures, to be looked at.

use std::{
    fmt::Write as _,
    fs,
    path::{Path, PathBuf},
    sync::atomic::{AtomicUsize, Ordering},
    thread,
    time::{Duration, Instant},
};

use bevy::{app::PluginGroup as _, ecs::message::Messages};
use bevy_egui::egui::{Event, Key, Modifiers, PointerButton, Pos2, Rect, accesskit::Role, vec2};
use glam::Vec3;
use lights_camera_models::{
    curves::{Channel, Detail, Kind, Setup, Style, Subject, curve, draw::Line},
    document::Edit,
    optics::{Frame, Terms, colour::Encoding},
    panel::{
        plots::{Request, file_of, write},
        state::{
            Action, EXPLAIN_TAB, Effect, Of, PLOTS_TAB, PlotCommand, Session, Severity, SheetOf, ThemeChoice,
            ViewChange,
        },
        theme,
    },
    parameter::{NamedFile, Value, Values},
    parameters,
    progress::Progress,
    reflection::{self, ReflectionModel},
    registry::{Register, Registry},
    scene::{Part, Scene},
    shader::Source,
    window::LabPlugins,
};

use crate::{
    helpers::support::lcm,
    library::plugins::app,
    window::panels::{Bench, Seen},
};

fn ask(bench: &mut Bench, command: PlotCommand) {
    bench.apply(Action::Plot(command));
}

fn open(bench: &mut Bench) {
    bench.apply(Action::View(ViewChange::BottomTab(PLOTS_TAB.to_owned())));
}

/// Draws frames until a condition holds.
fn wait(bench: &mut Bench, until: impl Fn(&Bench) -> bool) {
    for _ in 0..12_000 {
        bench.frame(Vec::new());
        if until(bench) {
            return;
        }
        thread::sleep(Duration::from_millis(5));
    }
    panic!("it does not come; there are {:?}", bench.tree.iter().map(|s| &s.label).collect::<Vec<_>>());
}

/// A window with the plots of the default scene with a model.
fn plots(model: &str, kind: Kind) -> Bench {
    let mut bench = Bench::with_model(model);
    bench.size = vec2(1280.0, 720.0);
    ask(&mut bench, PlotCommand::Kind(kind));
    open(&mut bench);
    bench
}

fn surface(bench: &Bench) -> Seen {
    let image = |s: &&Seen| s.role == Role::Image;
    bench.tree.iter().find(image).expect("the plot is there").clone()
}

const LIGHT: &str = "Light in the plot: θ_i in degrees";

fn light(bench: &Bench) -> Pos2 {
    bench.tree.iter().find(|s| s.label == LIGHT).expect("the handle is there").rect.center()
}

/// The angle at which values are read, and the values.
fn reading(bench: &Bench) -> Option<(f64, Vec<f64>)> {
    let number = |text: &str| text.replace('−', "-").parse::<f64>().ok();
    let place = bench.tree.iter().find_map(|s| s.label.split(") at ").nth(1)?.strip_suffix('°'))?;
    let right = surface(bench).rect.right();
    let values = bench.tree.iter().filter(|s| s.role == Role::Label && s.rect.left() > right);
    Some((number(place)?, values.filter_map(|s| number(&s.label)).collect()))
}

#[test]
fn the_values_under_the_pointer_are_those_of_the_curves() {
    let mut bench = plots("phong", Kind::Brdf);
    bench.apply(Action::Edit(Edit::material(Part::Object(0), "alpha", Value::Integer(40))));
    let entry = bench.registry.model("phong").expect("built in").clone();
    let subject = |alpha: i64| {
        let mut values = Values::default();
        values.set("alpha", Value::Integer(alpha));
        Subject::model(&entry, &values, Encoding::Srgb)
    };
    let setup = Setup::new(Kind::Brdf, 45.0, 0.0).expect("legal");
    let fine = |alpha| curve(&subject(alpha), &setup, Detail::Fine, &Progress::NONE).expect("calculated");
    let (right, wrong) = (fine(40), fine(20));
    let place = surface(&bench).rect;
    wait(&mut bench, |bench| bench.find("Phong, α = 40").is_some());
    let near = |curve: &lights_camera_models::curves::Curve, angle: f64, value: f64| {
        let points = curve.points.iter().filter(|p| (p.angle - angle).abs() < 0.0501);
        points.map(|p| f64::from(p.rgb.x)).any(|v| (v - value).abs() <= 6e-4 * v)
    };
    // The fine curve comes a moment later.
    thread::sleep(Duration::from_millis(400));
    let begin = Instant::now();
    let mut compared = 0;
    for part in [0.2, 0.35, 0.5, 0.68, 0.7, 0.72, 0.74, 0.8] {
        let at = Pos2::new(place.left() + part * place.width(), place.center().y);
        bench.hover(at);
        let Some((mut angle, mut values)) = reading(&bench) else { continue };
        while !near(&right, angle, values[0]) && begin.elapsed() < Duration::from_secs(60) {
            thread::sleep(Duration::from_millis(20));
            bench.hover(at);
            (angle, values) = reading(&bench).expect("it was there");
        }
        assert!(near(&right, angle, values[0]), "{values:?} at {angle}°");
        compared += usize::from(!near(&wrong, angle, values[0]));
    }
    assert!(compared > 1, "only places where the two are the same were looked at");
}

#[test]
fn keys_read_the_plot() {
    let mut bench = plots("lambert", Kind::Brdf);
    wait(&mut bench, |bench| surface(bench).label.contains("Lambert"));
    let place = surface(&bench).rect;
    bench.click_at(place.center(), PointerButton::Primary);
    // The pointer leaves; the focus stays.
    bench.frame(vec![Event::PointerGone]);
    bench.key(Key::ArrowLeft, Modifiers::NONE);
    let (before, values) = reading(&bench).expect("the focus is in the plot");
    assert!((values[0] - 0.8 / std::f64::consts::PI).abs() < 0.3, "{values:?}");
    bench.key(Key::ArrowRight, Modifiers::SHIFT);
    assert!((reading(&bench).expect("still").0 - before - 10.0).abs() < 1e-6);
    assert!(surface(&bench).label.contains("; at "), "{}", surface(&bench).label);
}

#[test]
fn the_light_is_dragged_in_the_plot() {
    for kind in [Kind::Response, Kind::Polar] {
        let mut bench = plots("phong", kind);
        ask(&mut bench, PlotCommand::Light(0.0));
        let top = light(&bench);
        ask(&mut bench, PlotCommand::Light(60.0));
        let there = light(&bench);
        ask(&mut bench, PlotCommand::Light(20.0));
        let from = light(&bench);
        assert!(there.x < from.x && from.x < top.x, "the light is at the left of the normal");
        let press = |pos, pressed| Event::PointerButton {
            pos,
            button: PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        };
        bench.frame(vec![Event::PointerMoved(from)]);
        bench.frame(vec![press(from, true)]);
        bench.frame(vec![Event::PointerMoved(from.lerp(there, 0.5))]);
        bench.frame(vec![Event::PointerMoved(there)]);
        bench.frame(vec![press(there, false)]);
        bench.settle();
        assert!(
            (bench.session.plots.theta_i - 60.0).abs() <= 1.0,
            "{kind:?} {}",
            bench.session.plots.theta_i
        );
        // Far out it stops above the horizon, and the keys continue from there.
        let start = light(&bench);
        bench.frame(vec![Event::PointerMoved(start)]);
        bench.frame(vec![press(start, true)]);
        bench.frame(vec![Event::PointerMoved(start + vec2(-2000.0, 500.0))]);
        bench.frame(vec![press(start + vec2(-2000.0, 500.0), false)]);
        bench.settle();
        assert_eq!(bench.session.plots.theta_i, 89.0, "{kind:?}");
        bench.key(Key::ArrowRight, Modifiers::NONE);
        assert_eq!(bench.session.plots.theta_i, 88.0, "{kind:?}");
        bench.key(Key::ArrowRight, Modifiers::SHIFT);
        assert_eq!(bench.session.plots.theta_i, 78.0);
        bench.key(Key::Home, Modifiers::NONE);
        assert_eq!(bench.session.plots.theta_i, 0.0);
        assert!(!bench.session.is_dirty(), "the plots are not the scene's");
    }
    // Where nothing depends on it, there is no handle.
    let bench = plots("phong", Kind::Albedo);
    assert!(bench.find(LIGHT).is_none());
}

#[test]
fn the_azimuth_and_the_angle_can_be_typed() {
    let mut bench = plots("ward", Kind::Brdf);
    bench.type_into("Angle of the light θ_i in degrees", "30,5");
    bench.type_into("Azimuth φ in degrees", "90");
    assert_eq!((bench.session.plots.theta_i, bench.session.plots.phi_i), (30.5, 90.0));
    bench.type_into("Angle of the light θ_i in degrees", "90");
    assert_ne!(bench.session.plots.theta_i, 90.0, "the light would be in the surface");
}

#[test]
fn curves_are_pinned_hidden_and_removed() {
    let mut bench = plots("phong", Kind::Brdf);
    wait(&mut bench, |bench| bench.find("Phong").is_some());
    bench.click("Pin");
    bench.apply(Action::Edit(Edit::material(Part::Object(0), "alpha", Value::Integer(64))));
    wait(&mut bench, |bench| bench.find("Phong, α = 64").is_some());
    // The pinned one stays unchanged, with a separate colour.
    assert!(surface(&bench).label.ends_with("Phong, α = 64; Phong"), "{}", surface(&bench).label);
    let styles = [bench.session.plots.live_style, bench.session.plots.pins[0].style];
    assert!(styles[0].colour != styles[1].colour && styles[0].line != styles[1].line);
    bench.click("Hide the curve of Phong");
    assert!(surface(&bench).label.ends_with(": Phong, α = 64") && bench.session.plots.pins.len() == 1);
    bench.click("Show the curve of Phong");
    bench.click("Hide the curve of Phong, α = 64");
    assert!(surface(&bench).label.ends_with(": Phong"), "{}", surface(&bench).label);
    // Another scene: the pins belong to the window.
    bench.apply(Action::OpenExample(0));
    bench.apply(Action::Answer(lights_camera_models::panel::state::Answer::Discard));
    assert_eq!(bench.session.plots.pins.len(), 1);
    bench.click("Remove the curve of Phong");
    assert!(bench.session.plots.pins.is_empty());
    // The style is reused for the next.
    ask(&mut bench, PlotCommand::Pin);
    assert_eq!(bench.session.plots.pins[0].style, styles[1]);
}

#[test]
fn colour_and_dash_are_chosen_in_the_list() {
    let mut bench = plots("phong", Kind::Brdf);
    wait(&mut bench, |bench| bench.find("Phong").is_some());
    bench.click("Colour and dash of Phong: blue, solid");
    let offered = |bench: &Bench, name: &str| {
        bench.tree.iter().find(|s| s.label.trim_end() == name).map(|s| s.rect.center())
    };
    let green = offered(&bench, "green").expect("it is offered");
    bench.click_at(green, PointerButton::Primary);
    assert_eq!(bench.session.plots.live_style, Style { colour: 2, line: Line::Solid });
    bench.click("Colour and dash of Phong: green, solid");
    let dotted = offered(&bench, "dotted").expect("it is offered");
    bench.click_at(dotted, PointerButton::Primary);
    assert_eq!(bench.session.plots.live_style, Style { colour: 2, line: Line::Dotted });
    // Files contain the same.
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("a.svg");
    let request = Request::of(&bench.session, &bench.registry);
    write(&request, &file, false, &[], &Progress::NONE).expect("written");
    assert!(fs::read_to_string(file).expect("there").contains("#009e73"));
}

#[test]
fn models_and_measured_data_are_laid_over() {
    let mut bench = plots("phong", Kind::Response);
    bench.click("Lay a model over");
    bench.frame(vec![Event::Text("oren".to_owned())]);
    bench.settle();
    bench.key(Key::Enter, Modifiers::NONE);
    bench.click("Lay measured data over");
    bench.frame(vec![Event::Text("gold met".to_owned())]);
    bench.settle();
    bench.key(Key::Enter, Modifiers::NONE);
    let of: Vec<_> = bench.session.plots.pins.iter().map(|pin| pin.of.clone()).collect();
    assert!(matches!(&of[0], Of::Model { id, .. } if id.contains("oren")), "{of:?}");
    assert!(matches!(&of[1], Of::Measured(id) if id.starts_with("gold-metallic")), "{of:?}");
    wait(&mut bench, |bench| surface(bench).label.contains("gold metallic paint"));
    // A paint at a measured angle, and at another.
    ask(&mut bench, PlotCommand::Add(Of::Measured("garnet_red".to_owned())));
    wait(&mut bench, |bench| bench.says("Garnet red was measured with the light at"));
    let said = bench.tree.iter().find(|s| s.label.contains("measured with the light at")).expect("there");
    let angle = said.label.split("light at ").nth(1).and_then(|rest| rest.split('°').next());
    let angle = angle.and_then(|angle| angle.parse().ok()).expect("an angle");
    ask(&mut bench, PlotCommand::Light(angle));
    wait(&mut bench, |bench| surface(bench).label.contains("Garnet red (measured)"));
}

/// Lays measurements in files of these names over, all of the same values.
fn lay_files(bench: &mut Bench, folder: &Path, names: &[String]) {
    let parameter =
        bench.registry.model("measured_table").and_then(|model| model.file()).expect("it reads one");
    let format = parameter.kind.format().expect("a file");
    let mut samples = "theta_i,phi_i,theta_o,phi_o,value\n".to_owned();
    for (i, o, azimuth) in [0, 20, 40, 60, 80]
        .iter()
        .flat_map(|i| [0, 20, 40, 60, 80].map(|o| (i, o)))
        .flat_map(|(i, o)| [0, 45, 90, 135, 180].map(|azimuth| (i, o, azimuth)))
    {
        let _ = writeln!(samples, "{i},0,{o},{azimuth},0.2");
    }
    for name in names {
        fs::write(folder.join(name), &samples).expect("writable");
        let mut values = Values::default();
        values.set(parameter.name, Value::File(NamedFile::chosen(name, folder, format)));
        let of = Of::Model { id: "measured_table".to_owned(), values, encoding: Encoding::Srgb };
        ask(bench, PlotCommand::Add(of));
    }
}

#[test]
fn the_list_stays_where_it_is_while_values_are_read() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut bench = plots("lambert", Kind::Brdf);
    // So many letters that the room for a value decides on the lines of some.
    let names = [16, 18, 20, 22, 24, 26, 28, 30].map(|letters| format!("{}.csv", "a".repeat(letters)));
    lay_files(&mut bench, folder.path(), &names);
    let places = |bench: &Bench| -> Vec<(String, Rect)> {
        let rows = bench.tree.iter().filter(|seen| seen.label.starts_with("Hide the curve of "));
        let mut rows: Vec<_> = rows.map(|seen| (seen.label.clone(), seen.rect)).collect();
        rows.sort_by(|a, b| a.0.cmp(&b.0));
        rows
    };
    wait(&mut bench, |bench| surface(bench).label.contains(&"a".repeat(30)));
    rest(&mut bench);
    let before = places(&bench);
    assert_eq!(before.len(), 9, "{before:?}");
    for part in [0.3, 0.5, 0.6] {
        let plot = surface(&bench).rect;
        bench.hover(plot.lerp_inside(vec2(part, 0.4)));
        bench.settle();
        assert!(reading(&bench).is_some(), "{part}");
        assert_eq!(places(&bench), before, "{part}");
    }
}

#[test]
fn slices_of_several_files_say_which_each_is_of() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut bench = plots("lambert", Kind::Slice);
    let names = [1, 2, 3, 4].map(|n| format!("paper_measured_by_the_goniometer_of_the_institute_{n}.csv"));
    lay_files(&mut bench, folder.path(), &names);
    let whole = |bench: &Bench, name: &str| {
        let right = surface(bench).rect.right();
        let label = format!("Measured (table), {name}");
        let is = |s: &&Seen| s.label == label && s.rect.left() < right;
        bench.tree.iter().find(is).map(|s| s.rect)
    };
    wait(&mut bench, |bench| names.iter().all(|name| whole(bench, name).is_some()));
    let right = surface(&bench).rect.right();
    let texts = bench.texts_in_sight();
    for name in &names {
        // Shortened in the middle: what differs is at the end.
        let end = &name[name.len() - 5..];
        let said = texts.iter().any(|(text, at)| {
            text.starts_with("pap") && text.contains('…') && text.ends_with(end) && at.left() < right
        });
        assert!(said, "{name} in {texts:?}");
    }
    let at = whole(&bench, &names[0]).expect("there").left_center() + vec2(4.0, 0.0);
    bench.hover(at);
    assert!(bench.says(&folder.path().join(&names[0]).display().to_string()), "its path");
}

#[test]
fn what_a_model_lacks_is_said() {
    let mut bench = plots("lambert", Kind::Fresnel);
    wait(&mut bench, |bench| bench.says("Lambert has no Fresnel factor F. Models with one: "));
    // It needs no choice of the light, which would have no effect.
    assert!(bench.field("Angle of the light θ_i in degrees").disabled);
    ask(&mut bench, PlotCommand::Kind(Kind::Albedo));
    ask(&mut bench, PlotCommand::Add(Of::Measured("acryl_blue".to_owned())));
    wait(&mut bench, |bench| bench.says("Acryl blue was measured only at single directions"));
    ask(&mut bench, PlotCommand::Add(Of::Measured("nonsense".to_owned())));
    wait(&mut bench, |bench| bench.says("measured data must be one of the paints"));
    let of = Of::Model { id: "gone".to_owned(), values: Values::default(), encoding: Encoding::Srgb };
    ask(&mut bench, PlotCommand::Add(of));
    wait(&mut bench, |bench| bench.says("There is no reflection model “gone”."));
}

parameters! {
    /// Nothing.
    pub struct Nothing {}
}

impl ReflectionModel for Nothing {
    const DECLARATION: reflection::Declaration =
        reflection::Declaration::new("nothing", "Nothing", Source::new("nothing.wgsl", ""));

    fn response(&self, _l: Vec3, _v: Vec3, _frame: &Frame) -> Terms {
        Terms { diffuse: Vec3::NAN, ..Terms::default() }
    }
}

#[test]
fn models_without_numbers_are_named() {
    let mut registry = Registry::builtin();
    registry.add_reflection_model::<Nothing>();
    let scene = Scene { reflection_model: "nothing".to_owned(), ..Scene::default() };
    let mut bench = Bench::with_registry(Session::new(scene), registry);
    for (kind, said) in [
        (Kind::Polar, "Nothing: no value is a finite number"),
        (Kind::Brdf, "Nothing: no value is a finite number"),
        (Kind::Albedo, "Nothing: no value is a finite number"),
        (Kind::Slice, "values are not finite numbers (magenta and black)"),
    ] {
        ask(&mut bench, PlotCommand::Kind(kind));
        open(&mut bench);
        wait(&mut bench, |bench| bench.says(said));
        let place = surface(&bench).rect;
        bench.hover(place.center() - vec2(0.0, 30.0));
        if kind == Kind::Brdf {
            assert!(bench.says("not a number"));
        }
    }
}

static CALLS: AtomicUsize = AtomicUsize::new(0);

parameters! {
    /// A number.
    pub struct Counted {
        /// See there.
        base_colour: colour = lights_camera_models::parameter::BASE_COLOUR,
    }
}

impl ReflectionModel for Counted {
    const DECLARATION: reflection::Declaration =
        reflection::Declaration::new("counted", "Counted", Source::new("counted.wgsl", ""));

    fn response(&self, _l: Vec3, _v: Vec3, _frame: &Frame) -> Terms {
        CALLS.fetch_add(1, Ordering::Relaxed);
        // Some models are slow.
        thread::sleep(Duration::from_millis(2));
        Terms::default()
    }
}

#[test]
fn nothing_is_calculated_while_the_plots_are_closed_and_no_frame_waits() {
    let mut registry = Registry::builtin();
    registry.add_reflection_model::<Counted>();
    let scene = Scene { reflection_model: "counted".to_owned(), ..Scene::default() };
    let mut bench = Bench::with_registry(Session::new(scene), registry);
    bench.session.view.unfold("messages");
    let calls = || CALLS.load(Ordering::Relaxed);
    let change = |bench: &mut Bench, red: u8| {
        let colour = Value::Colour([red, 0, 0]);
        bench.apply(Action::Edit(Edit::material(Part::Object(0), "base_colour", colour)));
    };
    bench.settle();
    for red in 0..10 {
        change(&mut bench, red);
    }
    // A change only asks the model which terms it has.
    let before = calls();
    bench.settle();
    thread::sleep(Duration::from_millis(300));
    assert_eq!(calls(), before, "the tab is closed");
    ask(&mut bench, PlotCommand::Kind(Kind::Slice));
    let start = Instant::now();
    open(&mut bench);
    change(&mut bench, 20);
    let frames = start.elapsed();
    // A slice needs 48 × 48 values of 2 ms.
    assert!(!bench.says("Image slice of the BRDF: Counted"), "it cannot be there yet");
    assert!(frames < Duration::from_millis(1200), "the frames waited: {frames:?}");
    wait(&mut bench, |_| calls() > before);
    // When collapsed, the work stops within a few frames.
    bench.apply(Action::View(ViewChange::Bottom(false)));
    let mut stopped = calls();
    loop {
        thread::sleep(Duration::from_millis(1000));
        let now = calls();
        assert!(now < before + 48 * 48, "it goes on");
        if now == stopped {
            break;
        }
        stopped = now;
    }
    // And continues when they are shown again.
    ask(&mut bench, PlotCommand::Kind(Kind::Brdf));
    open(&mut bench);
    wait(&mut bench, |bench| surface(bench).label.ends_with("Counted, base colour = (20, 0, 0)"));
}

#[test]
fn files_are_what_the_command_writes() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    let mut bench = plots("phong", Kind::Response);
    bench.apply(Action::Edit(Edit::material(Part::Object(0), "alpha", Value::Integer(20))));
    let of = Of::Model { id: "lambert".to_owned(), values: Values::default(), encoding: Encoding::Srgb };
    ask(&mut bench, PlotCommand::Add(of));
    ask(&mut bench, PlotCommand::Add(Of::Measured("gold-metallic-paint".to_owned())));
    ask(&mut bench, PlotCommand::Light(30.0));
    ask(&mut bench, PlotCommand::Channel(Some(Channel::Red)));
    let both = |bench: &Bench, kind: &str, more: &[&str]| {
        let request = Request::of(&bench.session, &bench.registry);
        for format in ["svg", "png", "csv"] {
            let (ours, theirs) = (at(&format!("ours.{format}")), at(&format!("theirs.{format}")));
            write(&request, &ours, true, &[], &Progress::NONE).expect("written");
            let common = ["plot", "phong:alpha=20", "lambert", "--data", "gold-metallic-paint", "--quiet"];
            let output = theirs.display().to_string();
            let own = ["--theta-i", "30", "--channel", "r", "--kind", kind, "-o", &output];
            let run = lcm(&[&common[..], &own, more].concat(), "");
            assert_eq!(run.status, Some(0), "{}", run.err);
            let [a, b] = [&ours, &theirs].map(|file| fs::read(file).expect("there"));
            assert!(a == b, "{kind}, {format}");
        }
    };
    both(&bench, "pi_f_cos", &[]);
    ask(&mut bench, PlotCommand::Kind(Kind::Polar));
    ask(&mut bench, PlotCommand::Log(true));
    both(&bench, "polar", &["--log"]);
    ask(&mut bench, PlotCommand::Kind(Kind::Slice));
    both(&bench, "slice", &["--log"]);
}

#[test]
fn files_that_are_something_else_stay() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    let bench = plots("phong", Kind::Brdf);
    let request = Request::of(&bench.session, &bench.registry);
    let refused = |file: &Path, replace: bool, inputs: &[PathBuf]| {
        write(&request, file, replace, inputs, &Progress::NONE).expect_err("refused")
    };
    assert!(refused(&at("a.jpg"), false, &[]).contains("a plot is written as .svg, .png or .csv"));
    fs::write(at("notes.csv"), "my,numbers\n").expect("writable");
    refused(&at("notes.csv"), true, &[]);
    assert_eq!(fs::read_to_string(at("notes.csv")).expect("there"), "my,numbers\n");
    assert_eq!(write(&request, &at("a.csv"), false, &[], &Progress::NONE), Ok(Vec::new()));
    assert!(refused(&at("a.csv"), false, &[]).contains("a.csv exists"));
    refused(&at("a.csv"), true, &[at("a.csv")]);
    assert_eq!(write(&request, &at("a.csv"), true, &[], &Progress::NONE), Ok(Vec::new()));
    assert_eq!(write(&request, &at("new/a.csv"), false, &[], &Progress::NONE), Ok(Vec::new()));
    assert!(at("new/a.csv").exists(), "folders are made");
    refused(&at("a.csv/b.csv"), false, &[]);
    // A plot without curves is not a plot.
    let mut empty = request.clone();
    empty.entries.iter_mut().for_each(|entry| entry.shown = false);
    let why = write(&empty, &at("b.svg"), false, &[], &Progress::NONE).expect_err("it is empty");
    assert!(why.contains("no curve is shown") && !at("b.svg").exists(), "{why}");
    for (typed, meant) in
        [("a", "a.svg"), ("a.png", "a.png"), ("a.csv.svg", "a.csv"), ("v1.2.svg", "v1.2.svg")]
    {
        assert_eq!(file_of(Path::new(typed)), Path::new(meant));
    }
}

#[test]
fn the_dialog_of_the_window_leads_to_a_file() {
    let mut bench = plots("phong", Kind::Brdf);
    bench.click("Export…");
    assert!(bench.dialogs.is_open() && bench.says("Export the plot"));
    let mut session = Session::default();
    let path = PathBuf::from("/somewhere/a.svg");
    let asked = session.apply(Action::Do(Effect::WritePlot(path.clone())), &Registry::builtin());
    assert_eq!(asked, [Effect::WritePlot(path)]);
    let folder = tempfile::tempdir().expect("a folder");
    let plugins = LabPlugins::default().size(64, 36).exit_after(100_000).headless();
    let mut app = app(plugins.build(), |_| ());
    for (name, said) in [("a.png", "The plot was written to "), ("a.jpg", "The plot was not written: ")] {
        let file = folder.path().join(name);
        app.world_mut().resource_mut::<Messages<Effect>>().write(Effect::WritePlot(file.clone()));
        let found = (0..12_000).any(|_| {
            app.update();
            thread::sleep(Duration::from_millis(2));
            let messages = &app.world().resource::<Session>().messages;
            messages.iter().any(|m| m.text.starts_with(said))
        });
        assert!(found, "{name}");
        assert_eq!(file.exists(), name == "a.png");
    }
    let messages = &app.world().resource::<Session>().messages;
    let count = |severity| messages.iter().filter(|m| m.severity == severity).count();
    assert_eq!((count(Severity::Info), count(Severity::Error)), (1, 1));
}

#[test]
fn everything_in_the_plots_has_a_name_and_a_place_on_screen() {
    for scale in [100, 150] {
        let mut bench = plots("phong", Kind::Polar);
        bench.apply(Action::View(ViewChange::Scale(scale)));
        ask(&mut bench, PlotCommand::Pin);
        bench.apply(Action::Edit(Edit::set(Part::Scene, Scene::reflection_model, "microfacet")));
        wait(&mut bench, |bench| bench.find("Remove the curve of Phong").is_some());
        let named =
            [Role::Button, Role::ComboBox, Role::Slider, Role::CheckBox, Role::TextInput, Role::Image];
        let strip = surface(&bench).rect.top() - 40.0..bench.size.y;
        let inside = |s: &&Seen| strip.contains(&s.rect.top()) && named.contains(&s.role);
        let all: Vec<_> = bench.tree.iter().filter(inside).collect();
        assert!(all.iter().all(|s| !s.label.trim().is_empty()), "{all:?}");
        let words = [
            "Quantity",
            "Angle of the light",
            "Azimuth",
            "logarithmic",
            "Channel",
            LIGHT,
            "Pin",
            "Lay a model",
            "Lay measured",
            "Export…",
            "Hide the curve of Phong",
            "Colour and dash of Phong",
            "Remove the curve",
        ];
        let asked: Vec<_> = words
            .iter()
            .map(|word| {
                bench.tree.iter().find(|s| s.label.starts_with(word)).unwrap_or_else(|| panic!("{word}"))
            })
            .collect();
        let screen = bevy_egui::egui::Rect::from_min_size(Pos2::ZERO, bench.size);
        for seen in asked {
            assert!(screen.expand(1.0).contains_rect(seen.rect), "{seen:?} at {scale} %");
        }
    }
}

#[test]
fn a_key_opens_the_plots_and_folds_them_away() {
    let mut bench = Bench::new(Session::default());
    bench.key(Key::F7, Modifiers::NONE);
    assert!(bench.session.view.bottom_open && bench.session.view.bottom_tab == PLOTS_TAB);
    bench.key(Key::F7, Modifiers::NONE);
    assert!(!bench.session.view.bottom_open);
}

#[test]
#[ignore = "a measurement, of the panels alone: without anything that is drawn by the GPU"]
fn the_time_of_a_frame_while_a_knob_is_dragged() {
    for round in 0..3 {
        for tab in ["history", PLOTS_TAB, EXPLAIN_TAB] {
            let mut bench = plots("phong", Kind::Polar);
            ask(&mut bench, PlotCommand::Pin);
            bench.apply(Action::View(ViewChange::BottomTab(tab.to_owned())));
            bench.session.settings.bottom_height = 312.0;
            if tab == EXPLAIN_TAB {
                let sphere = bench.area.rect.center() + vec2(13.0, 7.0);
                bench.frame(vec![Event::PointerMoved(sphere)]);
                bench.letter(Key::E, "e");
            }
            let mut times = Vec::new();
            for i in 0..200 {
                let alpha = Value::Integer(10 + i);
                let edit = Edit::material(Part::Object(0), "alpha", alpha);
                let start = Instant::now();
                let effects = bench.session.apply(Action::Edit(edit), &bench.registry);
                bench.effects.extend(effects);
                bench.frame(Vec::new());
                times.push(start.elapsed().as_secs_f64() * 1e3);
                thread::sleep(Duration::from_millis(8));
            }
            times.sort_by(f64::total_cmp);
            println!("{round} {tab}: median {:.2} ms, 95 % {:.2} ms", times[100], times[190]);
        }
    }
}

/// Asserts that the calculated curves appear in the pictures.
fn rest(bench: &mut Bench) {
    for _ in 0..12 {
        thread::sleep(Duration::from_millis(60));
        bench.frame(Vec::new());
    }
}

#[test]
#[ignore = "draws pictures to look at: scripts/pictures"]
fn pictures_of_the_plots() -> Result<(), Box<dyn std::error::Error>> {
    let folder = crate::helpers::pictures::picture_folder()?;
    fs::create_dir_all(&folder)?;
    let lively = |kind: Kind| {
        let mut bench = plots("phong", kind);
        ask(&mut bench, PlotCommand::Pin);
        bench.apply(Action::Edit(Edit::material(Part::Object(0), "alpha", Value::Integer(40))));
        for id in ["microfacet", "oren_nayar"] {
            let of = Of::Model { id: id.to_owned(), values: Values::default(), encoding: Encoding::Srgb };
            ask(&mut bench, PlotCommand::Add(of));
        }
        ask(&mut bench, PlotCommand::Add(Of::Measured("garnet_red".to_owned())));
        ask(&mut bench, PlotCommand::Add(Of::Measured("gold-metallic-paint".to_owned())));
        bench
    };
    let sizes = [
        ("1280", vec2(1280.0, 720.0), ThemeChoice::Dark, 100),
        ("1280-light", vec2(1280.0, 720.0), ThemeChoice::Light, 100),
        ("1280-150", vec2(1280.0, 720.0), ThemeChoice::Dark, 150),
        ("1920", vec2(1920.0, 1080.0), ThemeChoice::Light, 100),
    ];
    for (name, size, theme, scale) in sizes {
        let ground = if theme == ThemeChoice::Dark { theme::DARK } else { theme::LIGHT };
        for (i, kind) in Kind::ALL.into_iter().enumerate() {
            let mut bench = lively(kind);
            bench.size = size;
            bench.session.settings.theme = theme;
            bench.session.settings.scale = scale;
            ask(&mut bench, PlotCommand::Log(i % 4 == 2));
            ask(&mut bench, PlotCommand::Light(if size.x > 1500.0 { 60.0 } else { 40.0 }));
            if kind == Kind::Masking {
                bench.apply(Action::Edit(Edit::set(Part::Scene, Scene::reflection_model, "microfacet")));
                ask(&mut bench, PlotCommand::Remove(0));
            }
            rest(&mut bench);
            let place = surface(&bench).rect;
            bench.hover(place.center() + vec2(0.12 * place.width(), -0.1 * place.height()));
            bench.picture(&folder.join(format!("plots-{name}-{}.png", kind.id())), ground.surround)?;
        }
        let mut bench = plots("lambert", Kind::Fresnel);
        bench.size = size;
        bench.session.settings.theme = theme;
        bench.session.settings.scale = scale;
        rest(&mut bench);
        bench.picture(&folder.join(format!("plots-{name}-lacks.png")), ground.surround)?;
    }
    Ok(())
}

#[test]
fn a_sheet_of_the_views_is_written_from_the_window() {
    let mut session = Session::default();
    let path = PathBuf::from("/somewhere/a.png");
    let write = |path: PathBuf| Effect::WriteSheet { subject: SheetOf::Views, path };
    let asked = session.apply(Action::Do(write(path.clone())), &Registry::builtin());
    assert_eq!(asked, [write(path)]);
    let folder = tempfile::tempdir().expect("a folder");
    let plugins = LabPlugins::default().size(64, 36).exit_after(100_000).headless();
    let mut app = app(plugins.build(), |_| ());
    for (name, said) in [("a.png", "Saved the sheet to "), ("a.jpg", "The sheet was not saved: ")] {
        let file = folder.path().join(name);
        app.world_mut().resource_mut::<Messages<Effect>>().write(write(file.clone()));
        let found = (0..12_000).any(|_| {
            app.update();
            thread::sleep(Duration::from_millis(2));
            let messages = &app.world().resource::<Session>().messages;
            messages.iter().any(|m| m.text.starts_with(said))
        });
        assert!(found, "{name}");
        assert_eq!(file.exists(), name == "a.png");
    }
}
