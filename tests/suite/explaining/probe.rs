//! The panel that explains a pixel: which pixel, the numbers of the picture, and the overlay.

use bevy_egui::egui::{Event, Key, Modifiers, PointerButton, Pos2, Shape, vec2};
use glam::{Quat, Vec3};
use lights_camera_models::{
    channel::DebugChannel,
    document::Edit,
    explain::{Explanation, Place},
    optics::{Frame, TermSelection, Terms},
    panel::{
        explain::{calculations, explained},
        keys::{ELSEWHERE, bindings},
        state::{Action, CompareCommand, EXPLAIN_TAB, Pin, Session, ThemeChoice, ViewChange},
    },
    parameter::Value,
    parameters,
    reference::{self, Settings},
    reflection::{Declaration, ReflectionModel},
    registry::{Register, Registry},
    scene::{Light, Observer, Part, Scene, comparison::Layout, examples::EXAMPLES},
    shader::Source,
    testing::random,
};

use crate::{
    helpers::support::{builtin, lcm},
    window::panels::Bench,
};

fn bench_of(session: Session, registry: Registry) -> Bench {
    let mut bench = Bench::with_registry(session, registry);
    bench.size = vec2(1280.0, 720.0);
    bench.apply(Action::View(ViewChange::BottomTab(EXPLAIN_TAB.to_owned())));
    bench.settle();
    bench
}

fn bench(scene: Scene) -> Bench {
    bench_of(Session::new(scene), builtin())
}

fn scene(model: &str, shading: &str) -> Scene {
    Scene { reflection_model: model.to_owned(), shading_model: shading.to_owned(), ..Scene::default() }
}

#[test]
fn light_with_extent_has_its_error_and_a_choice_of_samples() {
    let mut scene = scene("phong", "phong");
    let at = scene.objects[0].position;
    let lamp = |side: Vec3| Light {
        light_type: "rectangle".to_owned(),
        position: Some(at + side),
        direction: Some(-side),
        intensity: 8.0,
        ..scene.lights[0].clone()
    };
    scene.lights = vec![lamp(Vec3::new(1.0, 1.5, 2.0)), lamp(Vec3::new(-1.0, 0.5, 2.0))];
    let mut bench = bench(scene);
    bench.size = vec2(1600.0, 2000.0);
    bench.session.settings.bottom_height = 1100.0;
    bench.settle();
    let pin = Pin::of_pixel(0, [320, 180], [640, 360], bench.session.document.view_angle());
    bench.apply(Action::View(ViewChange::Pin(Some(pin))));
    bench.settle();
    let error = |bench: &Bench| shown(bench).seen.and_then(|seen| seen.error()).expect("noise").max_element();
    let usual = error(&bench);
    let texts = bench.texts();
    let after = |label: &str| {
        let i = texts
            .iter()
            .position(|text| text.starts_with(label))
            .unwrap_or_else(|| panic!("{label}: {texts:?}"));
        texts[i + 1..].iter().take(2).any(|text| text.contains('±'))
    };
    for label in ["sum over 2 lights", "light of the pixel"] {
        assert!(after(label), "{label} has no error: {texts:?}");
    }
    bench.click("Light samples: 4096");
    bench.settle();
    assert!(bench.texts().iter().any(|text| text.contains("by 4096 samples")), "{:?}", bench.texts());
    assert!(2.0 * error(&bench) < usual, "{} of {usual}", error(&bench));
}

#[test]
fn the_first_step_to_the_display_looks_like_the_others() {
    let mut bench = bench(scene("phong", "phong"));
    bench.size = vec2(1600.0, 2000.0);
    bench.session.settings.bottom_height = 1100.0;
    let pin = Pin::of_pixel(0, [320, 180], [640, 360], bench.session.document.view_angle());
    bench.apply(Action::View(ViewChange::Pin(Some(pin))));
    bench.settle();
    let looks: Vec<_> = bench
        .shapes()
        .iter()
        .filter_map(|shape| match shape {
            Shape::Text(text) => {
                let format = &text.galley.job.sections.first()?.format;
                Some((text.galley.text().to_owned(), format.font_id.size, format.color))
            }
            _ => None,
        })
        .collect();
    let of = |begin: &str| {
        let found = looks.iter().find(|(text, ..)| text.starts_with(begin) && text.ends_with(':'));
        let (_, size, colour) = found.unwrap_or_else(|| panic!("{begin}: {looks:?}"));
        (*size, *colour)
    };
    assert_eq!(of("light of the pixel"), of("exposure 0 EV"));
}

#[test]
fn no_line_ends_within_three_numbers_in_a_window_of_1280_points() {
    for shading in ["gouraud", "phong"] {
        let mut scene = scene("phong", shading);
        scene.objects[0].material.set("base_colour", Value::Colour([200, 120, 60]));
        scene.lights[0] = Light {
            light_type: "rectangle".to_owned(),
            direction: Some(scene.objects[0].position - scene.lights[0].position.expect("a place")),
            ..scene.lights[0].clone()
        };
        let mut bench = bench(scene);
        bench.size = vec2(1280.0, 2000.0);
        bench.session.settings.bottom_height = 1100.0;
        bench.settle();
        let pin = Pin::of_pixel(0, [320, 180], [640, 360], bench.session.document.view_angle());
        bench.apply(Action::View(ViewChange::Pin(Some(pin))));
        bench.settle();
        let begins_with_number = |text: &str| text.starts_with(|c: char| c.is_ascii_digit() || c == '−');
        let mut triples = 0;
        for shape in bench.shapes() {
            let Shape::Text(text) = shape else { continue };
            for row in &text.galley.rows {
                let row: String = row.glyphs.iter().map(|glyph| glyph.chr).collect();
                let last = row.rsplit_once('(').map(|(_, end)| end).filter(|end| begins_with_number(end));
                triples += usize::from(last.is_some());
                let is_open = last.is_some_and(|end| !end.contains(')'));
                let is_cut = is_open || row.trim_end().ends_with('±');
                assert!(!is_cut, "{shading}: “{row}” of {}", text.galley.text());
            }
        }
        assert!(triples > 10, "{shading}: {triples}");
    }
}

#[test]
fn the_hemisphere_is_whole_beside_the_list_in_a_window_of_1280_by_720() {
    let mut scene = scene("phong", "phong");
    scene.lights[0] = Light {
        light_type: "rectangle".to_owned(),
        direction: Some(scene.objects[0].position - scene.lights[0].position.expect("a place")),
        // With its unit it would need a second line.
        intensity: 1234.5,
        ..scene.lights[0].clone()
    };
    let mut bench = bench(scene);
    let pin = Pin::of_pixel(0, [320, 180], [640, 360], bench.session.document.view_angle());
    bench.apply(Action::View(ViewChange::Pin(Some(pin))));
    let mut scales = Vec::new();
    // It is calculated in a thread.
    for _ in 0..6000 {
        bench.frame(Vec::new());
        scales = bench.texts_in_sight();
        scales.retain(|(text, _)| text.starts_with("white: "));
        if !scales.is_empty() {
            break;
        }
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    assert_eq!(scales.len(), 3, "each below its disc: {scales:?}");
    let texts = bench.texts_in_sight();
    let of = |start: &str| {
        let found = texts.iter().find(|(text, _)| text.starts_with(start));
        found.unwrap_or_else(|| panic!("{start} is not in sight: {texts:?}")).1
    };
    let (title, list) = (of("The hemisphere above"), of("Light by light"));
    assert!((title.top() - list.top()).abs() < 4.0 && title.right() < list.left(), "{title} beside {list}");
    for (text, place) in scales {
        let disc = place.top() - title.bottom();
        assert!(disc > 80.0 && place.bottom() < 694.0, "{text}: {place} below {title}");
        let lines = text.lines().count() as f32;
        assert!(place.height() < 16.0 * lines, "{text} is broken: {place}");
    }
}

#[test]
fn messages_do_not_take_the_height_that_the_explanation_was_given() {
    let mut bench = bench(scene("phong", "phong"));
    let edge = bench.area.rect.bottom();
    let press = |pos, pressed| Event::PointerButton {
        pos,
        button: PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    };
    let at = |y: f32| bevy_egui::egui::pos2(640.0, y);
    bench.frame(vec![Event::PointerMoved(at(edge))]);
    bench.frame(vec![press(at(edge), true)]);
    for k in 1..=6 {
        bench.frame(vec![Event::PointerMoved(at(edge - 20.0 * k as f32))]);
    }
    bench.frame(vec![press(at(edge - 120.0), false)]);
    bench.settle();
    let settings = bench.session.settings.clone();
    assert!(settings.bottom_height > 350.0, "{}", settings.bottom_height);
    bench.session.say(lights_camera_models::panel::state::Severity::Error, "room.json:14:20: k_d is 0.2");
    bench.settle();
    assert!(720.0 - bench.area.rect.bottom() < 230.0, "the strip: {}", bench.area.rect);
    assert_eq!(bench.session.settings, settings);
    bench.apply(Action::View(ViewChange::BottomTab(EXPLAIN_TAB.to_owned())));
    bench.settle();
    assert!((bench.area.rect.bottom() - edge + 120.0).abs() < 4.0, "{} of {edge}", bench.area.rect);
}

/// Moves the pointer to a place.
fn point(bench: &mut Bench, at: Pos2) {
    bench.frame(vec![Event::PointerMoved(at)]);
    bench.frame(Vec::new());
}

/// Moves the pointer to the sphere.
fn point_at_sphere(bench: &mut Bench) {
    let at = middle(bench);
    point(bench, at);
}

/// The present explanation.
fn shown(bench: &Bench) -> Explanation {
    explained(&bench.ctx).expect("something is explained").explanation.clone()
}

/// The middle of the picture, where the sphere is.
fn middle(bench: &Bench) -> Pos2 {
    bench.area.cells.first().map_or(bench.area.rect, |cell| cell.rect).center() + vec2(13.0, 7.0)
}

/// The corner of the picture, which is empty.
fn corner(bench: &Bench) -> Pos2 {
    bench.area.rect.left_top() + vec2(20.0, 60.0)
}

fn alt_click(bench: &mut Bench, at: Pos2) {
    let modifiers = Modifiers::ALT;
    let press =
        |pressed| Event::PointerButton { pos: at, button: PointerButton::Primary, pressed, modifiers };
    bench.frame(vec![Event::ModifiersChanged(modifiers), Event::PointerMoved(at)]);
    bench.frame(vec![press(true)]);
    bench.frame(vec![press(false)]);
    bench.frame(vec![Event::ModifiersChanged(Modifiers::NONE)]);
    bench.settle();
}

/// The letters of every model.
const LETTERS: [&str; 3] = ["N", "L", "V"];

fn has_vectors(bench: &mut Bench) -> bool {
    let words = bench.words();
    let found = LETTERS.map(|letter| words.iter().any(|word| word == letter));
    assert!(found.iter().all(|f| *f == found[0]), "only some vectors: {words:?}");
    found[0]
}

/// The codes of the picture of a session, as the CPU renderer draws it.
fn picture(bench: &Bench, size: [u32; 2]) -> Vec<u8> {
    let mut seen = (*bench.session.document).clone();
    let fov = seen.view_angle().vertical(size[0] as f32 / size[1] as f32);
    seen.observer = Observer {
        field_of_view: fov.to_degrees(),
        ..Observer::at(bench.session.facts.eye, bench.session.facts.camera * Vec3::NEG_Z)
    };
    let settings = Settings { width: size[0], height: size[1], samples: 1, terms: TermSelection::All };
    reference::render_rgb8(&seen, &bench.registry, &settings)
}

#[test]
fn the_code_is_that_of_the_picture_in_every_shading_model() {
    for (model, shading, turn) in [
        ("phong", "flat", 0.0),
        ("blinn_phong", "gouraud", 0.3),
        ("ward", "phong", 0.3),
        ("lambert", "derivative", -0.2),
    ] {
        let mut session = Session::new(scene(model, shading));
        session.facts.camera = Quat::from_rotation_y(turn);
        session.facts.eye = Vec3::splat(5.0) + session.facts.camera * Vec3::new(0.3, 0.2, 4.5);
        let mut bench = bench_of(session, builtin());
        point_at_sphere(&mut bench);
        let size = shown(&bench).size;
        let codes = picture(&bench, size);
        let rect = bench.area.rect;
        let mut seed = 7;
        for _ in 0..40 {
            let near = vec2(random(&mut seed) - 0.5, random(&mut seed) - 0.5) * 0.7 * rect.height();
            point(&mut bench, rect.center() + near);
            let explanation = shown(&bench);
            let [x, y] = explanation.pixel;
            let at = 3 * (y * size[0] + x) as usize;
            let code = [codes[at], codes[at + 1], codes[at + 2]];
            assert_eq!(explanation.code(), code, "{model}, {shading}: pixel {x},{y}");
            let [r, g, b] = code;
            assert!(
                bench.says(&format!("red {r}, green {g}, blue {b}")),
                "{model}, {shading}: pixel {x},{y}"
            );
        }
    }
}

#[test]
fn a_sentence_says_which_light_and_which_term_give_the_most() {
    let of = |scene: Scene| {
        let mut bench = bench(scene);
        point_at_sphere(&mut bench);
        bench
    };
    let says = |bench: &Bench, text: &str| {
        let all: Vec<_> =
            bench.tree.iter().map(|s| s.label.clone()).filter(|l| l.starts_with("This ")).collect();
        assert!(bench.says(text), "no “{text}” in {all:?}");
    };
    let light = |at: [f32; 3], intensity: f32, name: Option<&str>| Light {
        position: Some(at.into()),
        intensity,
        name: name.map(str::to_owned),
        ..Scene::default().lights[0].clone()
    };
    let at = [3.0, 8.0, 9.0];
    let lit = |model: &str, lights: Vec<Light>| Scene { lights, ..scene(model, "phong") };

    let one = of(lit("lambert", vec![light(at, 60.0, None)]));
    let [r, g, b] = shown(&one).code();
    says(&one, &format!("This pixel is ({r}, {g}, {b}): "));
    says(&one, "Point 1 gives all of its light, by the diffuse term.");
    let two = of(lit("lambert", vec![light(at, 30.0, None), light(at, 90.0, Some("warm lamp"))]));
    says(&two, "warm lamp gives 75 % of its light, by the diffuse term.");
    let gouraud = Scene { shading_model: "gouraud".to_owned(), ..(*two.session.document).clone() };
    says(&of(gouraud), "warm lamp gives 75 % of its light");
    says(&of(lit("lambert", Vec::new())), "no light is switched on.");
    says(&of(lit("lambert", vec![light([5.0, 5.0, 1.0], 60.0, None)])), "no light leaves this point");
    says(&of(lit("lambert", vec![light(at, 1e6, None)])), "brighter than the display can show, and clipped.");
    let everywhere =
        Light { light_type: "ambient".to_owned(), position: None, intensity: 0.2, ..Light::default() };
    says(&of(lit("lambert", vec![everywhere])), "gives all of its light, by the ambient term.");
    let mut background = bench(Scene::default());
    let at = corner(&background);
    point(&mut background, at);
    says(&background, "no object is here, and the background shows.");
}

#[test]
fn a_presentation_keeps_the_vectors_of_a_pinned_pixel() {
    let mut bench = bench(scene("lambert", "phong"));
    point_at_sphere(&mut bench);
    bench.key(Key::F5, Modifiers::NONE);
    bench.settle();
    // Lambert's equation, which is in the picture, has no V.
    let has_v = |bench: &mut Bench| bench.words().iter().any(|word| word == "V");
    assert!(bench.session.view.presenting && !has_v(&mut bench), "nothing is pinned");
    bench.key(Key::F5, Modifiers::NONE);
    bench.settle();
    point_at_sphere(&mut bench);
    bench.key(Key::E, Modifiers::NONE);
    bench.key(Key::F5, Modifiers::NONE);
    bench.settle();
    assert!(bench.session.view.presenting && bench.session.view.pinned.is_some());
    assert!(has_v(&mut bench));
}

#[test]
fn what_is_copied_is_what_the_command_line_says() {
    let mut bench = bench(Scene::default());
    point_at_sphere(&mut bench);
    bench.key(Key::E, Modifiers::NONE);
    let Explanation { pixel: [x, y], size: [width, height], .. } = shown(&bench);
    bench.click("Copy");
    let (at, size) = (format!("{x},{y}"), format!("{width}x{height}"));
    let said = lcm(&["explain", "--at", &at, "--size", &size], "");
    assert_eq!((said.status, bench.copied.as_deref()), (Some(0), Some(&*said.out)), "{}", said.err);
}

#[test]
fn the_pointer_is_followed_unless_a_pixel_is_pinned() {
    let mut bench = bench(scene("phong", "phong"));
    assert!(bench.says("Point at the picture"));
    let (at, away) = (middle(&bench), corner(&bench));
    point(&mut bench, at);
    let pixel = shown(&bench).pixel;
    let offset = (at - bench.area.rect.min).floor();
    assert_eq!(pixel, [offset.x as u32, offset.y as u32]);
    assert!(has_vectors(&mut bench));
    point(&mut bench, away);
    assert!(shown(&bench).seen.is_none() && bench.says("only background") && !has_vectors(&mut bench));
    // Once it has left, the last pixel stays explained; its vectors are hidden.
    point(&mut bench, at);
    let panel = bench.find("Copy").expect("there").rect.center();
    bench.frame(vec![Event::PointerMoved(panel)]);
    assert!(shown(&bench).pixel == pixel && !has_vectors(&mut bench));

    for by_key in [true, false] {
        let toggle = |bench: &mut Bench| match by_key {
            true => {
                point(bench, at);
                bench.letter(Key::E, "e");
            }
            false => alt_click(bench, at),
        };
        toggle(&mut bench);
        assert!(bench.session.view.pinned.is_some());
        point(&mut bench, away);
        assert_eq!(shown(&bench).pixel, pixel);
        bench.frame(vec![Event::PointerMoved(panel)]);
        assert!(has_vectors(&mut bench), "what is pinned keeps its vectors");
        toggle(&mut bench);
        assert_eq!(bench.session.view.pinned, None);
        toggle(&mut bench);
        bench.key(Key::Escape, Modifiers::NONE);
        assert_eq!(bench.session.view.pinned, None, "Escape lets go");
        point(&mut bench, away);
        assert_ne!(shown(&bench).pixel, pixel);
    }
    alt_click(&mut bench, at);
    alt_click(&mut bench, at + vec2(40.0, 0.0));
    assert_eq!(shown(&bench).pixel, [pixel[0] + 40, pixel[1]], "a click elsewhere pins there");
    // So does the key. With the pointer away from the picture it lets go.
    point(&mut bench, at);
    bench.letter(Key::E, "e");
    assert!(
        bench.session.view.pinned.is_some() && shown(&bench).pixel == pixel,
        "the key elsewhere pins there"
    );
    bench.frame(vec![Event::PointerMoved(panel)]);
    bench.letter(Key::E, "e");
    assert_eq!(bench.session.view.pinned, None);
    alt_click(&mut bench, at);
    bench.click("Pin");
    assert_eq!(bench.session.view.pinned, None);
    // A click without Alt pins nothing.
    bench.click_at(at, PointerButton::Primary);
    assert_eq!(bench.session.view.pinned, None);
}

#[test]
fn it_works_by_keyboard_alone() {
    let mut bench = Bench::new(Session::default());
    bench.size = vec2(1280.0, 720.0);
    bench.settle();
    assert!(!bench.session.view.bottom_open);
    bench.letter(Key::E, "e");
    assert!(bench.session.view.bottom_open && bench.session.view.bottom_tab == EXPLAIN_TAB);
    let Explanation { pixel, size, .. } = shown(&bench);
    assert_eq!(pixel, size.map(|side| side / 2));
    bench.type_into("column of the pixel", "17");
    bench.key(Key::Enter, Modifiers::NONE);
    assert_eq!(shown(&bench).pixel, [17, size[1] / 2]);
    // When collapsed, it is shown again before it is unpinned.
    bench.apply(Action::View(ViewChange::Bottom(false)));
    bench.letter(Key::E, "e");
    assert!(bench.session.view.pinned.is_some() && bench.session.view.bottom_open);
    bench.letter(Key::E, "e");
    assert_eq!(bench.session.view.pinned, None);

    let table = bindings(&bench.session, &bench.registry);
    assert!(table.iter().any(|b| b.keys() == "E" && b.action == Action::Pin && b.label.contains("Explain")));
    assert!(ELSEWHERE.iter().any(|(_, keys, what)| *keys == "Alt and click" && what.contains("Explain")));
    bench.key(Key::F1, Modifiers::NONE);
    assert!(bench.says("Explain the pixel at the pointer"));
}

#[test]
fn nothing_is_calculated_while_closed_or_unchanged() {
    let mut bench = Bench::new(Session::default());
    bench.size = vec2(1280.0, 720.0);
    bench.settle();
    for k in 0..10 {
        let at = middle(&bench) + vec2(k as f32, 0.0);
        point(&mut bench, at);
    }
    bench.apply(Action::Edit(Edit::set(Part::Scene, Scene::shading_model, "phong")));
    assert_eq!((calculations(&bench.ctx), explained(&bench.ctx).is_none()), (0, true));

    bench.apply(Action::View(ViewChange::BottomTab(EXPLAIN_TAB.to_owned())));
    point_at_sphere(&mut bench);
    bench.settle();
    let before = calculations(&bench.ctx);
    bench.settle();
    assert_eq!(calculations(&bench.ctx), before, "nothing changed");
    let light = shown(&bench).steps.light;
    let colour = Edit::material(Part::Object(0), "base_colour", Value::Colour([20, 90, 200]));
    bench.apply(Action::Edit(colour));
    assert_eq!(calculations(&bench.ctx), before + 1);
    assert_ne!(shown(&bench).steps.light, light);
    bench.session.facts.eye += 0.2 * Vec3::Z;
    bench.settle();
    assert_eq!(calculations(&bench.ctx), before + 2, "the camera moved");
    bench.apply(Action::View(ViewChange::Presenting(true)));
    bench.session.facts.eye += 0.2 * Vec3::Z;
    bench.settle();
    bench.apply(Action::View(ViewChange::Presenting(false)));
    bench.apply(Action::View(ViewChange::BottomTab("messages".to_owned())));
    bench.session.facts.eye += 0.2 * Vec3::Z;
    bench.settle();
    assert!(calculations(&bench.ctx) <= before + 4 && explained(&bench.ctx).is_none());
    assert!(!has_vectors(&mut bench));
}

#[test]
fn of_several_views_the_one_under_the_pointer_is_explained() {
    let mut bench = bench(scene("lambert", "phong"));
    bench.apply(Action::Compare(CompareCommand::Add));
    bench.apply(Action::Edit(Edit::set(Part::Scene, Scene::reflection_model, "blinn_phong")));
    bench.settle();
    assert_eq!(bench.session.document.comparison.layout, Layout::SideBySide);
    let cells = bench.area.cells.clone();
    assert_eq!(cells.len(), 2);
    for (cell, model, letter) in [(cells[0], "lambert", "A"), (cells[1], "blinn_phong", "B")] {
        point(&mut bench, cell.rect.center());
        let explanation = shown(&bench);
        assert_eq!(explanation.seen.as_ref().expect("the sphere").model.id, model);
        let size = [cell.rect.width().round() as u32, cell.rect.height().round() as u32];
        assert!((0..2).all(|i| explanation.size[i].abs_diff(size[i]) <= 1), "{:?}", explanation.size);
        assert!(bench.says(&format!("view {letter}")));
        let words = bench.words();
        assert_eq!(words.iter().filter(|word| *word == "N").count(), 1, "only in its view");
    }
    bench.key(Key::E, Modifiers::NONE);
    assert_eq!(bench.session.view.pinned.map(|pin| pin.view), Some(1));
    bench.apply(Action::Compare(CompareCommand::Remove(1)));
    bench.settle();
    assert!(explained(&bench.ctx).is_none(), "there is no view B any more");
}

#[test]
fn a_view_is_explained_with_the_remark_that_its_picture_is_behind() {
    let mut bench = bench(scene("lambert", "phong"));
    bench.apply(Action::Compare(CompareCommand::Add));
    bench.apply(Action::Edit(Edit::set(Part::Scene, Scene::reflection_model, "blinn_phong")));
    bench.session.facts.compiling[1] = true;
    for cell in bench.area.cells.clone() {
        point(&mut bench, cell.rect.center());
        assert_eq!(bench.says("Compiling: until the shader is ready"), cell.view == 1, "{}", cell.view);
    }
}

#[test]
fn vertices_can_be_chosen_and_per_pixel_shading_compared() {
    let mut bench = bench(scene("phong", "gouraud"));
    point_at_sphere(&mut bench);
    bench.key(Key::E, Modifiers::NONE);
    let seen = shown(&bench).seen.expect("the sphere");
    for corner in &seen.corners {
        assert!(bench.says(&format!("Point: vertex {}", corner.vertex)));
    }
    let most = seen.corners.iter().map(|c| c.weight).fold(0.0, f32::max);
    let Some(Place::Vertex { vertex, .. }) = seen
        .spots
        .iter()
        .map(|s| s.place)
        .find(|p| matches!(p, Place::Vertex { weight, .. } if *weight == most))
    else {
        panic!("no vertex")
    };
    let chosen = bench.tree.iter().find(|s| s.label.starts_with(&format!("Point: vertex {vertex}")));
    assert!(chosen.is_some());
    bench.click("Point: per pixel");
    assert!(bench.says("per-pixel shading would give"));
    let light = "Point 1: ";
    let blocks = |bench: &Bench| bench.tree.iter().filter(|s| s.label.starts_with(light)).count();
    assert_eq!(blocks(&bench), 1);
    assert!(bench.says("light to the observer"), "the brightest is unfolded");
    let at = bench.tree.iter().find(|s| s.label.starts_with(light)).expect("there").rect.center();
    bench.click_at(at, PointerButton::Primary);
    assert!(!bench.says("light to the observer"), "a click folds it");
}

#[test]
fn only_vectors_of_the_equation_are_drawn() {
    for (model, expected) in [
        ("lambert", "NLV"),
        ("phong", "NLVR"),
        ("blinn_phong", "NLVH"),
        ("microfacet", "NLVH"),
        ("disney", "NLVH"),
        ("oren_nayar", "NLV"),
    ] {
        let mut bench = bench(scene(model, "phong"));
        bench.apply(Action::View(ViewChange::Pin(Some(Pin::middle(0)))));
        bench.settle();
        let words = bench.words();
        let found: String = ["N", "L", "V", "H", "R"]
            .into_iter()
            .filter(|letter| words.iter().any(|w| w == letter))
            .collect();
        assert_eq!(found, expected, "{model}");
    }
}

parameters! {
    /// A model without parameters.
    pub struct Broken {}
}

impl ReflectionModel for Broken {
    const DECLARATION: Declaration = Declaration::new("broken", "Broken", Source::new("broken.wgsl", ""));

    fn response(&self, _l: Vec3, _v: Vec3, _frame: &Frame) -> Terms {
        Terms { diffuse: Vec3::splat(f32::NAN), ..Terms::default() }
    }
}

#[test]
fn what_is_no_number_and_what_the_picture_does_not_show_is_said() {
    let mut registry = Registry::builtin();
    registry.add_reflection_model::<Broken>();
    let mut bench = bench_of(Session::new(scene("broken", "phong")), registry);
    point_at_sphere(&mut bench);
    assert!(bench.says("Some light here is not a number"));

    let mut registry = Registry::builtin();
    registry.sources_mut().edit("reflection/phong.wgsl", "// mine");
    let mut bench = bench_of(Session::new(scene("phong", "phong")), registry);
    point_at_sphere(&mut bench);
    assert!(bench.says("ignores the edited reflection/phong.wgsl"));

    let mut bench = self::bench(scene("phong", "phong"));
    let at = corner(&bench);
    point(&mut bench, at);
    bench.settle();
    assert!(bench.says("only background") && !bench.says("light surround"));
    bench.apply(Action::View(ViewChange::Theme(ThemeChoice::Light)));
    assert!(bench.says("light surround"), "the background of the window is not that of the picture");
    bench.apply(Action::View(ViewChange::Terms(TermSelection::Diffuse)));
    point_at_sphere(&mut bench);
    assert!(bench.says("Only the diffuse term is shown"));
    assert_eq!(shown(&bench).terms, TermSelection::Diffuse);
    assert!(!bench.says("The picture shows a channel"));
    bench.apply(Action::View(ViewChange::Channel(Some(DebugChannel::NDotV))));
    point_at_sphere(&mut bench);
    assert!(bench.says("The picture shows a channel, ") && bench.says("the numbers are those of the light"));
}

#[test]
fn each_move_of_the_pointer_explains_one_pixel_in_every_example() {
    for (i, example) in EXAMPLES.iter().enumerate() {
        let mut bench = bench(Scene::default());
        bench.apply(Action::OpenExample(i));
        let at = middle(&bench);
        point(&mut bench, at);
        let before = calculations(&bench.ctx);
        const COUNT: u32 = 8;
        for k in 0..COUNT {
            let to = at + vec2(k as f32 - 4.0, 1.0);
            bench.frame(vec![Event::PointerMoved(to)]);
            let seen = calculations(&bench.ctx) - before;
            assert_eq!(seen, u64::from(k) + 1, "{} at {to}", example.file);
        }
        // The time is measured by `cargo bench --bench explain`.
    }
}
