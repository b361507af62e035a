//! The scene list: hiding, colours, deleting, permanent names; and what the picture and the messages report
//! about it.

use std::{collections::BTreeSet, path::PathBuf};

use bevy_egui::egui::{Key, Modifiers, PointerButton, Shape, accesskit::Role};
use lights_camera_models::{
    document::{Edit, Extent, Selection},
    optics::TermSelection,
    panel::{
        caption::caption_text,
        state::{Action, Effect, Session, ViewChange},
    },
    parameter::{BASE_COLOUR, Value},
    reference,
    registry::Registry,
    render::{
        capture::gpu::{GpuRenderer, Output},
        entities::CurrentScene,
    },
    scene::{Light, Object, Part, Scene, examples::EXAMPLES},
};

use crate::{
    helpers::support::{changed, read, said, written},
    window::panels::Bench,
};

fn with_objects(kinds: &[&str]) -> Session {
    let objects = kinds.iter().enumerate().map(|(i, kind)| Object {
        object_type: (*kind).to_owned(),
        position: glam::Vec3::new(1.0 + i as f32, 5.0, 5.0),
        size: 0.8,
        ..Object::default()
    });
    Session::new(Scene { objects: objects.collect(), ..Scene::default() })
}

fn names(bench: &Bench) -> Vec<String> {
    let document = &bench.session.document;
    (0..document.objects.len()).map(|i| document.name_of(Selection::Object(i), &bench.registry)).collect()
}

#[test]
fn a_click_in_a_row_never_deletes() {
    let mut bench = Bench::new(with_objects(&["sphere", "sphere"]));
    let row = bench.find("Sphere 1").expect("there").rect;
    bench.hover(row.center());
    assert!(
        bench.find("Delete Sphere 1").is_none_or(|s| s.rect.left() > 900.0),
        "only the properties have a bin"
    );
    // Everywhere along the row, however the pointer got there.
    for x in (row.left() as i32..row.right() as i32).step_by(6) {
        bench.click_at(bevy_egui::egui::pos2(x as f32, row.center().y), PointerButton::Primary);
        bench.key(Key::Escape, Modifiers::NONE);
        assert_eq!(bench.session.document.objects.len(), 2, "a click at {x}");
    }
}

#[test]
fn the_dot_changes_the_colour() {
    let mut bench = Bench::new(with_objects(&["sphere"]));
    for (dot, colour) in [("Colour of Sphere 1", "object"), ("Colour of Point 1", "light")] {
        let before = bench.session.document.scene().clone();
        bench.click(dot);
        // The field of saturation and value is the largest slider of the picker, below the dot.
        let place = bench.find(dot).expect("there").rect.center();
        bench.click_at(place + bevy_egui::egui::vec2(60.0, 150.0), PointerButton::Primary);
        assert_ne!(*bench.session.document, before, "the colour of the {colour} did not change");
        bench.key(Key::Escape, Modifiers::NONE);
        bench.click_at(bevy_egui::egui::pos2(640.0, 800.0), PointerButton::Primary);
    }
    let material = &bench.session.document.objects[0].material;
    assert!(matches!(material.get(&BASE_COLOUR), Value::Colour(rgb) if rgb != [255; 3]));
    assert_ne!(bench.session.document.lights[0].colour, [255; 3]);
}

#[test]
fn the_colour_picker_works_by_keys_and_grey_keeps_its_hue() {
    let mut bench = Bench::new(with_objects(&["sphere"]));
    let colour = |bench: &Bench| match bench.session.document.objects[0].material.get(&BASE_COLOUR) {
        Value::Colour(rgb) => rgb,
        other => panic!("{other:?}"),
    };
    bench.click("Colour of Sphere 1");
    for label in ["Colour of Sphere 1: saturation and brightness", "Colour of Sphere 1: hue, degrees"] {
        assert!(bench.find(label).is_some(), "{label}");
    }
    assert!(bench.find("U8").is_none(), "the library’s picker");
    // White at first, and red as soon as it is saturated. The square has the focus.
    (0..9).for_each(|_| bench.key(Key::ArrowRight, Modifiers::SHIFT));
    let red = colour(&bench);
    assert!(red[0] == 255 && red[1] < 120 && red[1] == red[2], "{red:?}");
    (0..3).for_each(|_| bench.key(Key::ArrowDown, Modifiers::NONE));
    assert!(colour(&bench)[0] < 255);
    // Another hue, to white and back.
    bench.click("Colour of Sphere 1: hue, degrees");
    let cyan = colour(&bench);
    assert!(cyan[0] < cyan[1], "{cyan:?}");
    bench.click_at(
        bench.find("Colour of Sphere 1: saturation and brightness").expect("there").rect.left_top(),
        PointerButton::Primary,
    );
    assert_eq!(colour(&bench), [255; 3]);
    (0..9).for_each(|_| bench.key(Key::ArrowRight, Modifiers::SHIFT));
    let back = colour(&bench);
    assert!(back[0] < 120 && back[1] == 255, "{back:?}");
}

#[test]
fn objects_are_hidden_and_lights_switched_off_by_click_key_and_menu() {
    let mut bench = Bench::new(with_objects(&["sphere", "cube"]));
    bench.click("Hide Cube 1");
    assert!(bench.session.document.objects[0].visible && !bench.session.document.objects[1].visible);
    bench.click("Show Cube 1");
    assert!(bench.session.document.objects[1].visible);
    bench.click("Switch off Point 1");
    assert!(!bench.session.document.lights[0].enabled);
    bench.click("Switch on Point 1");
    assert!(bench.session.document.lights[0].enabled);
    bench.apply(Action::Select(Selection::Object(0)));
    bench.key(Key::V, Modifiers::NONE);
    assert!(!bench.session.document.objects[0].visible && bench.session.is_dirty());
    let row = bench.find("Sphere 1").expect("there").rect.center();
    bench.click_at(row, PointerButton::Secondary);
    bench.click("Show");
    assert!(bench.session.document.objects[0].visible);
    bench.click_at(row, PointerButton::Secondary);
    bench.click("Delete");
    assert_eq!(names(&bench), ["Cube 1"]);
}

#[test]
fn what_is_hidden_is_saved_and_read() {
    let mut scene = Scene::default();
    scene.objects[0].visible = false;
    scene.lights[0].enabled = false;
    let text = written(&scene);
    assert!(text.contains("\"visible\": false") && text.contains("\"enabled\": false"), "{text}");
    assert_eq!(read(&text), scene);
    assert!(!written(&Scene::default()).contains("visible"), "what is as usual is not written");
    let wrong = said(&changed(|s| s["objects"][0]["visible"] = 1.into()));
    assert!(wrong.contains("objects[0].visible is 1, but visible must be true or false"), "{wrong}");
    let other = said(&changed(|s| s["lights"][0]["on"] = false.into()));
    assert!(other.contains("enabled"), "{other}");
}

#[test]
fn neither_renderer_draws_what_is_hidden_or_lights_what_is_dark() {
    const SIDE: u32 = 48;
    let registry = Registry::builtin();
    let mut gpu = GpuRenderer::new(SIDE, SIDE, 1, Output::Linear).expect("software Vulkan is installed");
    let mut brightest = |scene: &Scene| {
        let settings =
            reference::Settings { width: SIDE, height: SIDE, samples: 1, terms: TermSelection::All };
        let cpu = reference::render(scene, &registry, &settings);
        let covered = cpu.pixels.iter().filter(|p| p.w > 0.0).count();
        let on_cpu = cpu.pixels.iter().fold(0.0_f32, |m, p| m.max(p.x));
        gpu.set_scene(scene.clone());
        gpu.settle().expect("the GPU draws");
        let on_gpu = gpu.read_linear().expect("readable").iter().fold(0.0_f32, |m, p| m.max(p.x));
        (covered, on_cpu, on_gpu)
    };
    let scene = Scene::default();
    let (covered, on_cpu, on_gpu) = brightest(&scene);
    assert!(covered > 100 && on_cpu > 0.1 && on_gpu > 0.1, "{covered} {on_cpu} {on_gpu}");
    let mut dark = scene.clone();
    dark.lights[0].enabled = false;
    let (covered, on_cpu, on_gpu) = brightest(&dark);
    let background = on_gpu;
    assert!(covered > 100 && on_cpu == 0.0 && on_gpu < 0.1, "{covered} {on_cpu} {on_gpu}");
    let mut hidden = scene.clone();
    hidden.objects[0].visible = false;
    let (covered, on_cpu, on_gpu) = brightest(&hidden);
    assert!(covered == 0 && on_cpu == 0.0 && on_gpu <= background, "{covered} {on_cpu} {on_gpu}");
    // And back again, in the same window.
    assert!(brightest(&scene).2 > 0.1);
    assert!(gpu.app().world().resource::<CurrentScene>().0.objects[0].visible);
}

#[test]
fn a_part_keeps_its_name_for_life() {
    let mut bench = Bench::new(with_objects(&["sphere", "sphere", "cube", "sphere"]));
    assert_eq!(names(&bench), ["Sphere 1", "Sphere 2", "Cube 1", "Sphere 3"]);
    bench.apply(Action::Remove(Selection::Object(0)));
    assert_eq!(names(&bench), ["Sphere 2", "Cube 1", "Sphere 3"]);
    // The others are unchanged: nothing is written into them; the file gets the names.
    assert!(bench.session.document.objects.iter().all(|object| object.name.is_none()));
    bench.apply(Action::AddObject("sphere".to_owned()));
    assert_eq!(names(&bench), ["Sphere 2", "Cube 1", "Sphere 3", "Sphere 4"]);
    bench.apply(Action::Duplicate(Selection::Object(1)));
    assert_eq!(names(&bench), ["Sphere 2", "Cube 1", "Cube 2", "Sphere 3", "Sphere 4"]);
    bench.apply(Action::Edit(Edit::set(Part::Object(0), Object::object_type, "cube")));
    assert_eq!(names(&bench)[1..], ["Cube 1", "Cube 2", "Sphere 3", "Sphere 4"]);
    let all = names(&bench);
    assert_eq!(all.iter().collect::<std::collections::BTreeSet<_>>().len(), all.len(), "{all:?}");
    // The file has them too, and names only the parts that it would otherwise name differently.
    let again = |session: &Session, registry: &Registry| {
        names(&Bench::new(Session::new(read(&written(&session.document.named(registry))))))
    };
    assert_eq!(again(&bench.session, &bench.registry), all);
    assert_ne!(names(&Bench::new(Session::new(read(&written(&bench.session.document))))), all);
    // A system that changes a type or the list does not rename other parts.
    let mut scene = bench.session.document.scene().clone();
    scene.objects[2].object_type = "torus".to_owned();
    scene.objects.remove(1);
    bench.session.submit(&scene, &[Extent::All], &bench.registry).expect("legal");
    let fewer = names(&bench);
    assert_eq!(fewer[1..], ["Torus 1", "Sphere 3", "Sphere 4"]);
    assert_eq!(fewer[0], all[0]);
    assert_eq!(again(&bench.session, &bench.registry), fewer);
    bench.apply(Action::Undo);
    assert_eq!(names(&bench), all);
    // Removing a name does not allow a second one of its kind.
    let name = |text: &str| Action::Edit(Edit::set(Part::Object(3), Object::name, text.to_owned()));
    bench.apply(name("Ball"));
    bench.apply(Action::Edit(Edit::set(Part::Object(4), Object::name, "Sphere 3")));
    bench.apply(name(""));
    assert_eq!(names(&bench)[3..], ["Sphere 5", "Sphere 3"]);
    bench.apply(Action::Undo);
    bench.apply(Action::Undo);
    bench.apply(Action::Undo);
    assert_eq!(names(&bench), all);
    // Lights as well.
    bench.apply(Action::AddLight("point".to_owned()));
    bench.apply(Action::AddLight("spot".to_owned()));
    bench.apply(Action::Remove(Selection::Light(0)));
    let lights: Vec<_> =
        (0..2).map(|i| bench.session.document.name_of(Selection::Light(i), &bench.registry)).collect();
    assert_eq!(lights, ["Point 2", "Spot 1"]);
}

#[test]
fn the_caption_says_what_the_picture_shows() {
    let registry = Registry::builtin();
    let mut session = Session::new(Scene {
        reflection_model: "phong".to_owned(),
        shading_model: "phong".to_owned(),
        ..Scene::default()
    });
    assert_eq!(
        caption_text(&session, &registry),
        "Phong · Phong shading · computed per pixel · k_a 0.1 · k_d 0.8 · k_s 0.5 · α 32"
    );
    // The scene's shading does not affect an object with its own.
    session.document.amend(|scene| scene.objects[0].shading_model = Some("gouraud".to_owned()));
    session.document.amend(|scene| scene.shading_model = "flat".to_owned());
    session.selection = Selection::Room;
    assert!(caption_text(&session, &registry).contains("Gouraud shading · computed per vertex"));
    let mut session = with_objects(&["sphere", "sphere", "sphere"]);
    session.document.amend(|scene| scene.objects[1].reflection_model = Some("phong".to_owned()));
    session.document.amend(|scene| scene.objects[2].shading_model = Some("flat".to_owned()));
    assert_eq!(caption_text(&session, &registry), "2 models · 2 shading models");
    session.document.amend(|scene| scene.objects[1].visible = false);
    session.document.amend(|scene| scene.objects[2].visible = false);
    assert!(caption_text(&session, &registry).starts_with("Lambert · Gouraud shading"));
    session.document.amend(|scene| scene.objects[0].visible = false);
    assert_eq!(caption_text(&session, &registry), "nothing visible");
}

#[test]
fn terms_that_are_empty_are_passed_over() {
    let press = |bench: &mut Bench| {
        bench.key(Key::T, Modifiers::NONE);
        bench.session.view.terms
    };
    // One term: nothing to separate.
    let mut bench = Bench::new(Session::default());
    assert_eq!(press(&mut bench), TermSelection::All);
    assert!(bench.session.messages.iter().any(|m| m.text.contains("one term")));
    assert!(!bench.says("Terms:"), "no row for one term");
    let mut bench = Bench::with_model("phong");
    bench.apply(Action::Edit(Edit::material(Part::Object(0), "k_a", Value::Number(0.0))));
    assert!(bench.says("Terms: all"));
    assert_eq!(press(&mut bench), TermSelection::Diffuse, "k_a is 0: there is no ambient term");
    assert!(bench.says("Only the diffuse term"), "a badge while terms are hidden");
    assert_eq!(press(&mut bench), TermSelection::Specular);
    // The model changes: a single term is left, other than the one shown.
    bench.apply(Action::Edit(Edit::set(Part::Scene, Scene::reflection_model, "lambert")));
    assert!(bench.says("Terms: specular"), "the way back is there");
    assert_eq!(press(&mut bench), TermSelection::All);
    bench.apply(Action::View(ViewChange::Terms(TermSelection::All)));
    assert!(!bench.says("Only the"));
}

#[test]
fn saving_says_where_and_offers_to_keep_the_view() {
    let path = PathBuf::from("/somewhere/lecture.json");
    let mut bench = Bench::new(Session::default());
    bench.apply(Action::SaveAs(path.clone()));
    assert!(bench.effects.contains(&Effect::SaveFile { path: path.clone(), overwrite: true }));
    bench.session.saved(path.clone(), &bench.registry);
    bench.settle();
    assert_eq!(bench.session.title(), "lecture", "the scene has the name of its file");
    assert!(!bench.session.is_dirty());
    assert!(bench.says("Saved to /somewhere/lecture.json"), "in sight without unfolding anything");
    assert!(bench.find("Set observer to this view").is_none(), "the view is the observer's");
    bench.session.facts.camera_is_free = true;
    bench.session.saved(path.clone(), &bench.registry);
    bench.settle();
    assert_eq!(bench.session.messages.len(), 1, "the last time counts");
    assert!(bench.says("The file keeps the observer’s view"));
    bench.effects.clear();
    bench.click("Set observer to this view");
    assert_eq!(bench.effects, [Effect::ObserverFromView]);
    // A name typed with its extension gets no second one, and the file is not replaced unasked.
    bench.effects.clear();
    bench.apply(Action::SaveAs(PathBuf::from("/somewhere/a.json.json")));
    assert_eq!(
        bench.effects,
        [Effect::SaveFile { path: PathBuf::from("/somewhere/a.json"), overwrite: false }]
    );
    // A name given by the user stays.
    bench.apply(Action::Edit(Edit::set(Part::Scene, Scene::name, "My lecture")));
    bench.apply(Action::SaveAs(PathBuf::from("/somewhere/other.json")));
    assert_eq!(bench.session.title(), "My lecture");
}

#[test]
fn a_light_that_is_off_is_no_light_from_everywhere() {
    let mut scene = Scene::default();
    scene.lights.push(Light { light_type: "ambient".to_owned(), position: None, ..Light::default() });
    scene.lights[0].enabled = false;
    assert_eq!(scene.shining().map(|l| l.light_type.as_str()).collect::<Vec<_>>(), ["ambient"]);
    let edit = Edit::set(Part::Light(1), Light::enabled, false);
    let mut bench = Bench::new(Session::new(scene));
    bench.apply(Action::Edit(edit));
    assert_eq!(bench.session.document.shining().count(), 0);
}

#[test]
fn the_caption_has_key_values_in_the_order_of_their_declaration() {
    for (model, values) in [
        ("disney", " · m 0 · "),
        ("hapke", " · w "),
        ("microfacet", " · GGX · α_x "),
        ("blinn_phong", " · k_a 0.1 · k_d 0.8 · k_s 0.5 · α 32"),
    ] {
        let bench = Bench::with_model(model);
        let caption = caption_text(&bench.session, &bench.registry);
        assert!(caption.contains(values), "{caption}");
        assert!(caption.matches(" · ").count() <= 6, "{caption}");
    }
    // A changed parameter is scrolled into view, wherever it is.
    let mut bench = Bench::with_model("disney");
    bench.apply(Action::Edit(Edit::material(Part::Object(0), "clearcoat", Value::Number(0.25))));
    assert!(caption_text(&bench.session, &bench.registry).ends_with(" 0.25"));
}

#[test]
fn the_caption_is_broken_between_its_parts_and_never_long() {
    for (scale, size) in
        [(100, (1280.0, 720.0)), (150, (1280.0, 720.0)), (200, (1280.0, 720.0)), (200, (1920.0, 1080.0))]
    {
        for model in ["blinn_phong", "microfacet"] {
            let mut bench = Bench::with_model(model);
            bench.size = size.into();
            bench.apply(Action::View(ViewChange::Scale(scale)));
            let foot = bench.area.rect.with_min_y(bench.area.rect.bottom() - 60.0);
            // A narrow picture has no axes in its corner.
            let axes = if foot.width() < 240.0 { 0.0 } else { 90.0 };
            let right = foot.right() - axes;
            let texts: Vec<_> = (bench.shapes().into_iter())
                .filter_map(|shape| match shape {
                    Shape::Text(t) if foot.contains(t.pos) && t.pos.x < right => {
                        Some((t.galley.text().to_owned(), t.pos.y, t.galley.rows.len()))
                    }
                    _ => None,
                })
                .collect();
            assert!(texts.iter().any(|(t, ..)| t.contains("shading")), "{scale}: {texts:?}");
            assert!(texts.iter().all(|(t, _, rows)| *rows == 1 && !t.contains('_')), "{scale}: {texts:?}");
            // If only some values fit, the exponent is among them.
            let shows = |value: &str| texts.iter().any(|(t, ..)| t == value);
            let coefficients = ["0.1", "0.8", "0.5"].into_iter().any(shows);
            assert!(model != "blinn_phong" || !coefficients || shows("32"), "{scale}: {texts:?}");
            let lines: BTreeSet<_> =
                texts.iter().filter(|(t, ..)| t.len() > 4).map(|(_, y, _)| y.round() as i32).collect();
            assert!(lines.len() <= 2, "{scale}: {texts:?}");
        }
    }
}

#[test]
fn a_badge_brings_hidden_terms_back_whatever_is_selected() {
    let mut bench = Bench::with_model("phong");
    let badge = |bench: &Bench| bench.tree.iter().find(|s| s.label.starts_with("Only the")).cloned();
    for part in [Selection::Room, Selection::Observer, Selection::Light(0)] {
        bench.apply(Action::View(ViewChange::Terms(TermSelection::Specular)));
        bench.apply(Action::Select(part));
        let button = badge(&bench).unwrap();
        assert_eq!((button.role, button.label.as_str()), (Role::Button, "Only the specular term · Show all"));
        bench.click_at(button.rect.center(), PointerButton::Primary);
        assert_eq!((bench.session.view.terms, bench.session.selection), (TermSelection::All, part));
        assert!(badge(&bench).is_none());
    }
    // A model that lacks the term is black, and the badge explains why.
    bench.apply(Action::View(ViewChange::Terms(TermSelection::Specular)));
    bench.apply(Action::Edit(Edit::set(Part::Scene, Scene::reflection_model, "lambert")));
    assert!(badge(&bench).unwrap().label.contains("which is 0 with Lambert"));
    bench.apply(Action::View(ViewChange::Terms(TermSelection::Diffuse)));
    assert!(!badge(&bench).unwrap().label.contains("which is 0"));
}

#[test]
fn the_observer_is_offered_no_place_outside_the_room() {
    let mut bench = Bench::new(Session::default());
    bench.session.facts.camera_is_free = true;
    bench.session.facts.eye = glam::Vec3::new(5.0, 5.0, 14.0);
    bench.session.saved(PathBuf::from("/somewhere/lecture.json"), &bench.registry);
    bench.settle();
    assert!(bench.says("The view is outside the room"));
    assert!(bench.find("Set observer to this view").is_none());
    bench.apply(Action::Select(Selection::Observer));
    let button = bench.find("Set observer to this view").cloned().unwrap();
    assert!(button.disabled);
    bench.hover(button.rect.center());
    bench.session.facts.eye.z = 9.0;
    bench.settle();
    assert!(!bench.find("Set observer to this view").unwrap().disabled);
}

#[test]
fn the_window_names_the_file_beside_the_scene() {
    let mut session = Session::default();
    assert_eq!(session.window_title(), "Default scene");
    session.path = Some(PathBuf::from("/somewhere/my-lesson.json"));
    assert_eq!(session.window_title(), "Default scene — my-lesson.json");
    session.document.amend(|scene| scene.name = Some("My lesson".to_owned()));
    assert_eq!(session.window_title(), "My lesson", "nothing is said twice");
    session.document.amend(|scene| scene.name = None);
    assert_eq!(session.window_title(), "my-lesson");
}

#[test]
fn a_choice_that_every_object_overrides_says_why_nothing_changes() {
    let mut bench = Bench::new(with_objects(&["sphere", "sphere"]));
    bench.session.document.amend(|scene| scene.objects[0].shading_model = Some("phong".to_owned()));
    bench.apply(Action::Select(Selection::Room));
    bench.letter(Key::F, "f");
    assert!(bench.session.messages.is_empty(), "one object follows");
    bench.session.document.amend(|scene| scene.objects[1].shading_model = Some("gouraud".to_owned()));
    bench.letter(Key::G, "g");
    assert!(bench.session.messages.iter().any(|m| m.text.contains("overrides the shading model")));
    assert!(!bench.session.view.bottom_open && bench.says("overrides the shading model"), "in sight");
    // As often as requested, until something else is done.
    bench.letter(Key::F, "f");
    assert!(bench.says("overrides the shading model"));
    bench.apply(Action::Edit(Edit::set(Part::Object(0), Object::size, 0.5)));
    assert!(!bench.says("overrides the shading model"), "of what is no longer news");
    bench.letter(Key::G, "g");
    bench.apply(Action::Undo);
    assert!(!bench.says("overrides the shading model"), "it is undone");
}

#[test]
fn what_a_key_cannot_do_is_said_in_a_changed_scene() {
    let mut bench = Bench::with_model("lambert");
    bench.apply(Action::Edit(Edit::set(Part::Scene, Scene::shading_model, "phong")));
    bench.letter(Key::T, "t");
    assert!(bench.says("there is nothing to separate"));
}

#[test]
fn the_properties_of_an_object_that_is_not_drawn_say_so() {
    let mut bench = Bench::new(Session::default());
    assert!(!bench.says("Not drawn"));
    bench.session.facts.not_drawn = vec![0];
    bench.settle();
    assert!(bench.says("Not drawn"));
    bench.apply(Action::Duplicate(Selection::Object(0)));
    assert!(!bench.says("Not drawn"), "there is room for the copy");
}

#[test]
fn a_scene_that_was_saved_elsewhere_is_called_so() {
    let mut bench = Bench::new(Session::default());
    let shapes = EXAMPLES.iter().position(|e| e.name == "Shapes and lights").expect("shipped");
    bench.apply(Action::OpenExample(shapes));
    let path = PathBuf::from("/somewhere/ex1.json");
    bench.apply(Action::SaveAs(path.clone()));
    bench.session.saved(path, &bench.registry);
    bench.settle();
    assert_eq!(bench.session.window_title(), "ex1");
    assert!(bench.says("ex1 has no unsaved changes"), "the bar says the same");
    // A scene that came from a file has the name given by its author.
    let example = EXAMPLES[shapes].scene(&bench.registry).expect("shipped");
    bench.session.opened(PathBuf::from("/somewhere/shapes_and_lights.json"), example);
    let path = PathBuf::from("/somewhere/copy.json");
    bench.apply(Action::SaveAs(path.clone()));
    bench.session.saved(path, &bench.registry);
    bench.settle();
    assert_eq!(bench.session.window_title(), "Shapes and lights — copy.json");
    assert!(bench.says("Shapes and lights — copy.json has no unsaved changes"), "the bar says the same");
}

#[test]
fn scenes_are_saved_with_their_extension() {
    let mut bench = Bench::new(Session::default());
    for (typed, file, overwrite) in [
        // Nobody was asked about this file.
        ("/somewhere/renamed", "/somewhere/renamed.json", false),
        ("/somewhere/lesson.v2", "/somewhere/lesson.v2.json", false),
        ("/somewhere/a.json", "/somewhere/a.json", true),
        ("/somewhere/A.JSON", "/somewhere/A.JSON", true),
        ("/somewhere/a.json.json", "/somewhere/a.json", false),
    ] {
        bench.effects.clear();
        bench.apply(Action::SaveAs(PathBuf::from(typed)));
        assert_eq!(bench.effects, [Effect::SaveFile { path: PathBuf::from(file), overwrite }], "{typed}");
    }
}

#[test]
fn a_shading_model_has_one_name_everywhere() {
    let mut bench = Bench::new(Session::default());
    bench.size = bevy_egui::egui::vec2(1280.0, 720.0);
    bench.settle();
    for shading in bench.registry.clone().shading_models() {
        let name = format!("Shading: {}", shading.declaration.name);
        assert!(bench.find(&name).is_some_and(|s| s.role == Role::RadioButton), "{name}");
    }
}

#[test]
fn names_that_begin_alike_can_be_told_apart() {
    let names = ["candle", "street lamp", "sun"].map(|what| format!("gold under the light of the {what}"));
    let mut session = with_objects(&["sphere"; 3]);
    session.document.amend(|scene| {
        for (object, name) in scene.objects.iter_mut().zip(&names) {
            object.name = Some(name.clone());
        }
    });
    let mut bench = Bench::new(session);
    bench.size = bevy_egui::egui::vec2(1280.0, 720.0);
    bench.apply(Action::Select(Selection::Room));
    let shown: BTreeSet<_> = (bench.shapes().into_iter())
        .filter_map(|shape| match shape {
            // As painted: omitted text is not in any glyph.
            Shape::Text(t) if t.galley.text().starts_with("gold") => {
                Some(t.galley.rows[0].glyphs.iter().map(|g| g.chr).collect::<String>())
            }
            _ => None,
        })
        .collect();
    assert_eq!(shown.len(), 3, "{shown:?}");
    for (name, end) in names.iter().zip(["andle", "lamp", "sun"]) {
        assert!(shown.iter().any(|s| s.contains('…') && s.ends_with(end)), "{shown:?}");
        let row = bench.find(name).expect("the whole name is there for screen readers").rect;
        bench.hover(row.left_center() + bevy_egui::egui::vec2(60.0, 0.0));
        let whole = |shape: &Shape| matches!(shape, Shape::Text(t) if t.galley.text() == name);
        assert!(bench.shapes().iter().any(whole), "and in the tooltip");
    }
}

#[test]
fn the_caption_says_what_there_is_none_of() {
    let registry = Registry::builtin();
    for model in registry.models() {
        let mut scene = Scene { reflection_model: model.declaration.id.to_owned(), ..Scene::default() };
        for p in model.parameters {
            if p.kind.options().iter().any(|(id, _)| *id == "none") {
                scene.objects[0].material.set(p.name, Value::Choice("none".into()));
            }
        }
        let caption = caption_text(&Session::new(scene), &registry);
        assert!(caption.split(" · ").all(|part| part != "None"), "{caption}");
    }
}

#[test]
fn the_row_of_terms_has_those_of_the_equation_above_it() {
    let ambient = Light { light_type: "ambient".to_owned(), position: None, ..Light::default() };
    let mut session = with_objects(&["sphere", "sphere", "sphere"]);
    session.document.amend(|scene| {
        scene.lights.push(ambient);
        for (object, model) in scene.objects.iter_mut().zip(["phong", "modified_phong", "mod_lambert"]) {
            object.reflection_model = Some(model.to_owned());
        }
    });
    let mut bench = Bench::new(session);
    let rows: Vec<BTreeSet<String>> = (0..3)
        .map(|i| {
            bench.apply(Action::Select(Selection::Object(i)));
            let labels = bench.tree.iter().filter_map(|s| s.label.strip_prefix("Terms: ").map(str::to_owned));
            labels.collect()
        })
        .collect();
    let offered = |i: usize| rows[i].iter().map(String::as_str).collect::<Vec<_>>();
    assert_eq!(offered(0), ["all", "ambient", "diffuse", "specular"]);
    assert_eq!(offered(1), ["all", "diffuse", "specular"], "I = I_d + I_s");
    assert_eq!(offered(2), [""; 0], "one term is all of it");
}

/// The choices of terms, from left to right.
fn terms_in_row(bench: &Bench) -> Vec<String> {
    let mut all: Vec<_> =
        bench.tree.iter().filter_map(|s| Some((s.rect.left(), s.label.strip_prefix("Terms: ")?))).collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    all.into_iter().map(|(_, name)| name.to_owned()).collect()
}

#[test]
fn the_row_of_terms_has_their_order_also_with_one_that_is_not_there() {
    let mut bench = Bench::with_model("diffuse_transmission");
    let offered = terms_in_row(&bench);
    assert_eq!(offered, ["all", "diffuse", "transmitted"]);
    bench.apply(Action::View(ViewChange::Terms(TermSelection::Specular)));
    assert_eq!(terms_in_row(&bench), ["all", "diffuse", "specular", "transmitted"]);
}

#[test]
fn the_row_of_terms_stays_while_a_knob_makes_a_term_0() {
    let mut bench = Bench::with_model("glass");
    bench.apply(Action::Select(Selection::Object(0)));
    let place = |bench: &Bench| bench.field("refractive index").rect;
    let (before, terms) = (place(&bench), terms_in_row(&bench));
    assert_eq!(terms, ["all", "specular", "transmitted"]);
    bench.apply(Action::Edit(Edit::material(Part::Object(0), "refractive_index", Value::Number(1.0))));
    assert_eq!((place(&bench), terms_in_row(&bench)), (before, terms), "nothing moves under the hand");
}

#[test]
fn in_a_narrow_window_names_go_before_icons_and_sliders_have_room() {
    let mut session = with_objects(&["sphere", "cube"]);
    session.settings.left_width = 121.0;
    let mut bench = Bench::new(session);
    bench.size = (1280.0, 720.0).into();
    bench.apply(Action::View(ViewChange::Scale(150)));
    bench.apply(Action::AddLight("rectangle".to_owned()));
    bench.hover(bench.area.rect.center());
    let texts = bench.texts();
    for name in ["Sphere 1", "Cube 1", "Point 1"] {
        assert!(texts.iter().any(|text| text == name), "{name}: {texts:?}");
    }
    assert!(texts.iter().any(|text| text.starts_with("Rectan") && text.ends_with(" 1")), "{texts:?}");
    // Under the pointer a row has all of its icons.
    let row = bench.find("Sphere 1").expect("there").rect;
    bench.hover(row.center() / bench.ctx.zoom_factor());
    assert!(bench.find("Hide Sphere 1").is_some() && bench.find("Colour of Sphere 1").is_some());
    // The unit of a luminance is long.
    let slider = bench.tree.iter().find(|s| s.role == Role::Slider && s.label.contains("intensity"));
    let slider = slider.expect("of the rectangle").rect.width() / bench.ctx.zoom_factor();
    assert!(slider > 48.0, "{slider}");
}

#[test]
fn in_a_narrow_panel_the_unit_of_a_colour_is_whole() {
    let mut session = with_objects(&["sphere"]);
    session.settings.right_width = 264.0;
    let mut bench = Bench::new(session);
    // So low that there is a scroll bar.
    bench.size = (1280.0, 400.0).into();
    bench.apply(Action::Select(Selection::Light(0)));
    bench.settle();
    let right = |shape| match shape {
        Shape::Text(text) if text.galley.text() == "sRGB" => Some(text.visual_bounding_rect().right()),
        _ => None,
    };
    let units: Vec<_> = bench.shapes().into_iter().filter_map(right).collect();
    assert!(!units.is_empty() && units.iter().all(|right| *right < 1270.0), "{units:?}");
}
