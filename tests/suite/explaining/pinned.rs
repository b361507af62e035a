//! A pinned point stays on its object, whatever the camera and the object do.

use bevy_egui::egui::{Color32, Event, Key, Modifiers, PointerButton, Pos2, Rect, Shape, vec2};
use glam::{Quat, Vec3};
use lights_camera_models::{
    document::{Edit, Selection},
    explain::{Explanation, Seen, Sight},
    panel::{
        explain::{Explained, explained, lobes_shown, lobes_shown_in},
        state::{
            Action, Clipping, CompareCommand, EXPLAIN_TAB, Effect, LobeChoice, LobeScale, Pin, Session,
            Steer, ViewChange,
        },
        theme::DARK,
    },
    reflection::Term,
    scene::{Light, Object, Part, Scene, rotation::rotation},
};

use crate::window::panels::Bench;

/// A line of sight to the sphere of the default scene, next to its centre.
const PIN: Pin = Pin { view: 0, at: [0.06, 0.04] };

fn scene(model: &str, shading: &str) -> Scene {
    Scene { reflection_model: model.to_owned(), shading_model: shading.to_owned(), ..Scene::default() }
}

/// A window with a pinned pixel of the sphere.
fn bench(scene: Scene) -> Bench {
    let mut bench = Bench::new(Session::new(scene));
    bench.size = vec2(1280.0, 900.0);
    bench.apply(Action::View(ViewChange::BottomTab(EXPLAIN_TAB.to_owned())));
    bench.settle();
    bench.apply(Action::View(ViewChange::Pin(Some(PIN))));
    bench.settle();
    bench
}

fn now(bench: &Bench) -> std::sync::Arc<Explained> {
    explained(&bench.ctx).expect("something is explained")
}

fn shown(bench: &Bench) -> Explanation {
    now(bench).explanation.clone()
}

fn seen(bench: &Bench) -> Seen {
    shown(bench).seen.expect("an object")
}

/// The explained point, in the coordinates of its object.
fn point(bench: &Bench) -> Vec3 {
    let seen = seen(bench);
    let object = &bench.session.document.objects[seen.object.index];
    rotation(object.rotation).inverse() * (seen.position - object.position) / object.size
}

/// Turns the camera about the middle of the room, around an axis.
fn orbit(bench: &mut Bench, axis: Vec3, degrees: f32) {
    let middle = Vec3::splat(5.0);
    let turn = Quat::from_axis_angle(axis, degrees.to_radians());
    let facts = &mut bench.session.facts;
    facts.camera = turn * facts.camera;
    facts.eye = middle + turn * (facts.eye - middle);
    facts.camera_is_free = true;
    bench.settle();
}

/// Moves the camera back to the session's observer.
fn home(bench: &mut Bench) {
    let observer = bench.session.document.observer;
    bench.session.facts = lights_camera_models::panel::state::Facts::at(&observer);
    bench.settle();
}

fn edit(bench: &mut Bench, edit: Edit) {
    bench.apply(Action::Edit(edit));
    bench.settle();
}

fn lobe(bench: &mut Bench) {
    bench.apply(Action::View(ViewChange::Lobe(LobeChoice { scale: LobeScale::Linear, all: false })));
    bench.wait_for_lobes();
}

const MILLIMETRE: f32 = 1e-3;

/// The places of the letters of the vectors.
fn letters(bench: &mut Bench) -> Vec<Rect> {
    let picture = bench.area.rect;
    let letter = |shape| match shape {
        Shape::Text(text) if ["N", "L", "H", "R", "V"].contains(&&*text.galley.job.text) => {
            Some(text.visual_bounding_rect()).filter(|place| picture.contains_rect(*place))
        }
        _ => None,
    };
    bench.shapes().into_iter().filter_map(letter).collect()
}

#[test]
fn letters_keep_clear_of_badges() {
    let mut bench = bench(scene("blinn_phong", "phong"));
    let clipping = Clipping::new(vec![1000; Clipping::GRID[0] * Clipping::GRID[1]]);
    let home = bench.session.facts.eye;
    bench.session.facts.camera_is_free = true;
    let mut would_be_covered = 0;
    for step in 0..8 {
        // The sphere goes to the upper left corner.
        let [x, y] = [0.3, 0.14].map(|far| far * step as f32);
        bench.session.facts.eye = home + Vec3::new(x, -y, 0.0);
        bench.session.facts.clipping[0] = None;
        bench.settle();
        let free = letters(&mut bench);
        bench.session.facts.clipping[0] = clipping.clone();
        bench.settle();
        let badge = bench.tree.iter().find(|s| s.label.starts_with("Clipped")).expect("a badge").rect;
        would_be_covered += free.iter().filter(|letter| letter.intersects(badge)).count();
        let now = letters(&mut bench);
        assert_eq!(now.len(), free.len(), "step {step}");
        assert!(!now.iter().any(|letter| letter.intersects(badge)), "step {step}: {now:?} under {badge:?}");
    }
    assert!(would_be_covered > 0);
}

#[test]
fn it_stays_on_its_object_while_the_camera_turns_around_it() {
    for shading in ["flat", "gouraud", "phong", "derivative"] {
        let mut bench = bench(scene("phong", shading));
        let (before, pixel, polygon) = (point(&bench), shown(&bench).pixel, seen(&bench).polygon);
        let cosine = |bench: &Bench| {
            let geometry = seen(bench).spots[0].lights[0].geometry.expect("a direction");
            geometry.cosine("N·L")
        };
        let lit = cosine(&bench);
        assert_eq!(now(&bench).sight, None, "the centre of the pixel");
        orbit(&mut bench, Vec3::Y, 60.0);
        assert_eq!(now(&bench).sight, Some(Sight::Clear), "{shading}");
        assert!(point(&bench).distance(before) < MILLIMETRE, "{shading}: {}", point(&bench));
        assert!((cosine(&bench) - lit).abs() < 1e-4, "{shading}: of the same point");
        assert_eq!(seen(&bench).polygon, polygon, "{shading}");
        let moved = shown(&bench).pixel;
        assert!(moved[0] + 50 < pixel[0], "{shading}: {moved:?} after {pixel:?}");
        assert!(bench.says("pinned point"), "{shading}");
        assert!(bench.words().iter().any(|word| word == "V"), "its vectors are there");
        // A twin that pins a line of sight would explain another point now.
        let other = lights_camera_models::explain::pixel(
            &Scene {
                observer: bench
                    .session
                    .facts
                    .observer(bench.session.document.observer)
                    .fitting(shown(&bench).size, bench.session.document.view_angle()),
                ..(*bench.session.document).clone()
            },
            &bench.registry,
            &lights_camera_models::reference::Settings {
                width: shown(&bench).size[0],
                height: shown(&bench).size[1],
                samples: 1,
                ..Default::default()
            },
            pixel,
        );
        let other = other.expect("in the picture").seen.expect("the sphere").position;
        assert!(other.distance(seen(&bench).position) > 0.3);
        home(&mut bench);
        assert_eq!((shown(&bench).pixel, now(&bench).sight), (pixel, None), "{shading}");
    }
}

#[test]
fn it_follows_its_object_and_survives_its_changes() {
    let mut bench = bench(scene("phong", "phong"));
    let (before, place) = (point(&bench), seen(&bench).position);
    edit(&mut bench, Edit::set(Part::Object(0), Object::position, Vec3::new(5.7, 4.8, 5.2)));
    assert!(point(&bench).distance(before) < MILLIMETRE);
    assert!((seen(&bench).position - place).distance(Vec3::new(0.7, -0.2, 0.2)) < MILLIMETRE);
    edit(&mut bench, Edit::set(Part::Object(0), Object::rotation, Vec3::new(20.0, -30.0, 10.0)));
    edit(&mut bench, Edit::set(Part::Object(0), Object::size, 1.4));
    assert!(point(&bench).distance(before) < MILLIMETRE);
    bench.apply(Action::Undo);
    bench.apply(Action::Undo);
    bench.apply(Action::Undo);
    bench.settle();
    assert!(seen(&bench).position.distance(place) < MILLIMETRE && now(&bench).sight.is_none());
    orbit(&mut bench, Vec3::X, -20.0);
    for (field, off) in [
        (Edit::set(Part::Object(0), Object::tessellation, 8), 0.1),
        (Edit::set(Part::Object(0), Object::tessellation, 90), 0.05),
        (Edit::set(Part::Object(0), Object::object_type, "cube"), 0.5),
    ] {
        edit(&mut bench, field.clone());
        assert!(point(&bench).distance(before) < off, "{field:?}: {}", point(&bench));
        let [a, b, c] = seen(&bench).corners.map(|corner| corner.position);
        let normal = (b - a).cross(c - a).normalize();
        assert!((seen(&bench).position - a).dot(normal).abs() < 1e-5, "{field:?}: on the surface");
        bench.apply(Action::Undo);
        bench.settle();
        assert!(point(&bench).distance(before) < MILLIMETRE, "{field:?} undone");
    }
    for shading in ["flat", "gouraud"] {
        bench.apply(Action::Edit(Edit::set(Part::Scene, Scene::shading_model, shading.to_owned())));
        bench.settle();
        assert!(point(&bench).distance(before) < MILLIMETRE && seen(&bench).shading.id == shading);
    }
    assert!(bench.session.view.pinned.is_some());
}

#[test]
fn a_point_that_nobody_sees_stays_explained_and_that_is_said() {
    let mut bench = bench(scene("phong", "phong"));
    let before = point(&bench);
    orbit(&mut bench, Vec3::Y, 180.0);
    assert_eq!(now(&bench).sight, Some(Sight::Away));
    assert!(
        point(&bench).distance(before) < MILLIMETRE && bench.says("The pinned point faces away from here")
    );
    assert!(bench.says("The pinned point would be (") && !bench.says("This pixel is ("));
    orbit(&mut bench, Vec3::Y, -180.0);
    assert!(!bench.says("The pinned point"));
    // Another object comes in between.
    let cube = Object {
        object_type: "cube".to_owned(),
        position: Vec3::new(5.0, 5.0, 7.5),
        size: 0.6,
        name: Some("curtain".to_owned()),
        ..Scene::default().objects[0].clone()
    };
    let pixel = shown(&bench).pixel;
    let with = Scene { objects: vec![Scene::default().objects[0].clone(), cube], ..scene("phong", "phong") };
    let mut hidden = self::bench(Scene { objects: with.objects[..1].to_vec(), ..with.clone() });
    hidden.session.document.change(
        "curtain",
        lights_camera_models::document::Extent::All,
        Selection::Room,
        |s| {
            s.objects = with.objects.clone();
        },
    );
    hidden.settle();
    assert_eq!(now(&hidden).sight, Some(Sight::Behind(1)));
    assert!(hidden.says("The pinned point is hidden here by curtain"));
    assert!(point(&hidden).distance(before) < MILLIMETRE);
    assert!(shown(&hidden).pixel.iter().zip(pixel).all(|(a, b)| a.abs_diff(b) <= 1));
    // The camera turns away: the point is outside the picture, and then behind the camera.
    for turn in [60.0, 60.0, 60.0] {
        let facts = &mut bench.session.facts;
        facts.camera = Quat::from_rotation_y(f32::to_radians(turn)) * facts.camera;
        facts.camera_is_free = true;
        bench.settle();
        assert_eq!(now(&bench).sight, Some(Sight::Outside));
        assert!(point(&bench).distance(before) < MILLIMETRE && bench.says("outside the picture"));
    }
}

#[test]
fn it_lets_go_of_an_object_that_is_gone() {
    let ball = Scene::default().objects[0].clone();
    let other = Object { position: Vec3::new(1.0, 1.0, 1.0), size: 0.2, ..ball.clone() };
    for gone in [Action::Remove(Selection::Object(0)), Action::Toggle(Selection::Object(0))] {
        let objects = vec![ball.clone(), other.clone()];
        let mut bench = bench(Scene { objects, ..scene("phong", "phong") });
        orbit(&mut bench, Vec3::Y, 30.0);
        bench.apply(gone);
        bench.settle();
        assert_eq!(bench.session.view.pinned, None);
        bench.apply(Action::Undo);
        bench.settle();
        assert_eq!(bench.session.view.pinned, None);
    }
    // Objects in front of it come and go.
    let mut bench = bench(Scene { objects: vec![other, ball], ..scene("phong", "phong") });
    let before = point(&bench);
    assert_eq!(seen(&bench).object.index, 1);
    bench.apply(Action::Remove(Selection::Object(0)));
    orbit(&mut bench, Vec3::Y, 30.0);
    assert_eq!((seen(&bench).object.index, bench.session.view.pinned), (0, Some(PIN)));
    assert!(point(&bench).distance(before) < MILLIMETRE);
}

#[test]
fn the_same_pixel_pinned_anew_is_another_point() {
    let mut bench = bench(scene("phong", "phong"));
    let before = point(&bench);
    orbit(&mut bench, Vec3::Y, 40.0);
    bench.apply(Action::View(ViewChange::Pin(Some(PIN))));
    bench.settle();
    let anew = point(&bench);
    assert!(anew.distance(before) > 0.2 && now(&bench).sight.is_none());
    // A click at the point, wherever it has moved, unpins it; a click where it was pinned does not.
    orbit(&mut bench, Vec3::Y, -40.0);
    let Explanation { pixel, .. } = shown(&bench);
    let at = bench.area.rect.min + vec2(pixel[0] as f32 + 0.5, pixel[1] as f32 + 0.5);
    let click = |bench: &mut Bench, at: Pos2| {
        let modifiers = Modifiers::ALT;
        let press =
            |pressed| Event::PointerButton { pos: at, button: PointerButton::Primary, pressed, modifiers };
        bench.frame(vec![Event::ModifiersChanged(modifiers), Event::PointerMoved(at)]);
        bench.frame(vec![press(true)]);
        bench.frame(vec![press(false)]);
        bench.frame(vec![Event::ModifiersChanged(Modifiers::NONE)]);
        bench.settle();
    };
    click(&mut bench, at);
    assert_eq!(bench.session.view.pinned, None);
    // Another scene: the pixel stays pinned.
    bench.apply(Action::View(ViewChange::Pin(Some(PIN))));
    orbit(&mut bench, Vec3::Y, 40.0);
    let effects = bench.session.apply(Action::New, &bench.registry);
    assert_eq!(effects, [Effect::DocumentChanged]);
    // The camera goes home, and is not there at once.
    bench.session.facts.camera_is_free = false;
    bench.settle();
    home(&mut bench);
    assert!(bench.session.view.pinned.is_some() && now(&bench).sight.is_none());
    assert!(point(&bench).distance(before) < 0.01);
}

#[test]
fn both_views_show_the_vectors_and_the_lobe_of_the_same_point() {
    let mut bench = bench(scene("lambert", "phong"));
    bench.apply(Action::Compare(CompareCommand::Add));
    bench.apply(Action::Edit(Edit::set(Part::Scene, Scene::reflection_model, "blinn_phong")));
    lobe(&mut bench);
    for degrees in [0.0, 25.0] {
        orbit(&mut bench, Vec3::Y, degrees);
        bench.wait_for_lobes();
        let words = bench.words();
        let count = |letter: &str| words.iter().filter(|word| *word == letter).count();
        assert_eq!((count("N"), count("L"), count("V")), (2, 2, 2), "{degrees}°: {words:?}");
        assert_eq!(count("H"), 1, "that of the model with a half vector");
        let [a, b] = [0, 1].map(|view| lobes_shown_in(&bench.ctx, view).expect("a lobe"));
        assert!(a.position.distance(b.position) < 1e-4 && a.position.distance(seen(&bench).position) < 1e-4);
        let largest = |lobes: &lights_camera_models::panel::explain::Lobes| {
            lobes.lobes.as_ref().expect("a lobe")[0].lobe.largest()
        };
        assert!(largest(&b) > 1.1 * largest(&a), "each of its own model");
        assert_eq!((now(&bench).view, seen(&bench).model.id), (0, "lambert"), "the numbers are of one");
        // Both share one scale.
        let scales: Vec<_> = words
            .iter()
            .filter_map(|text| text.lines().find(|line| line.starts_with("Length of the vectors")))
            .map(|line| line.trim_end_matches(':').to_owned())
            .collect();
        assert!(scales.len() == 2 && scales[0] == scales[1], "{scales:?}");
    }
    bench.apply(Action::View(ViewChange::Pin(None)));
    bench.wait_for_lobes();
    let cell = bench.area.cells[1].rect;
    bench.frame(vec![Event::PointerMoved(cell.center())]);
    bench.settle();
    assert_eq!(bench.words().iter().filter(|word| *word == "N").count(), 1, "only where the pointer is");
}

#[test]
fn a_command_looks_at_it_from_the_side() {
    let steer = |bench: &mut Bench| {
        let found = bench.effects.iter().find_map(|effect| match effect {
            Effect::Steer(Steer::Along { point, way }) => Some((*point, *way)),
            _ => None,
        });
        bench.effects.clear();
        found
    };
    let mut bench = bench(scene("phong", "phong"));
    bench.key(Key::H, Modifiers::SHIFT);
    let (at, way) = steer(&mut bench).expect("a movement of the camera");
    let seen = seen(&bench);
    let spot = &seen.spots[0];
    let l = spot.lights[0].geometry.expect("a direction").l;
    assert_eq!(at, seen.position);
    assert!(way.dot(spot.normal).abs() < 1e-4 && way.dot(l).abs() < 1e-4, "N and L are seen face on");
    // Light along the normal: the plane of N and V.
    let light = seen.position + 3.0 * spot.normal;
    bench.apply(Action::Edit(Edit::set(Part::Light(0), Light::position, light)));
    orbit(&mut bench, Vec3::Y, 20.0);
    bench.key(Key::H, Modifiers::SHIFT);
    let (_, way) = steer(&mut bench).expect("a movement of the camera");
    let spot = &self::seen(&bench).spots[0];
    assert!(way.dot(spot.normal).abs() < 1e-3 && way.dot(spot.view).abs() < 1e-3);
    let entry = |bench: &mut Bench| {
        bench.click("View");
        let found = bench.tree.iter().find(|s| s.label.starts_with("Look from the side")).cloned();
        found.expect("an entry of the menu")
    };
    let found = entry(&mut bench);
    assert!(!found.disabled);
    bench.click_at(found.rect.center(), PointerButton::Primary);
    assert!(steer(&mut bench).is_some());
    bench.apply(Action::View(ViewChange::Pin(None)));
    bench.settle();
    bench.key(Key::H, Modifiers::SHIFT);
    assert!(steer(&mut bench).is_none());
    assert!(bench.session.messages.iter().any(|m| m.text.contains("no pinned point")));
    assert!(entry(&mut bench).disabled);
}

#[test]
fn letters_keep_off_the_lobe() {
    for (model, turn) in [("lambert", 0.0), ("lambert", 50.0), ("phong", 35.0), ("blinn_phong", -40.0)] {
        let mut bench = bench(scene(model, "phong"));
        lobe(&mut bench);
        orbit(&mut bench, Vec3::Y, turn);
        bench.wait_for_lobes();
        assert!(lobes_shown(&bench.ctx).is_some_and(|lobes| lobes.lobes.is_ok()));
        let picture = bench.area.rect;
        let (mut plates, mut corners) = (Vec::new(), Vec::new());
        for shape in bench.shapes() {
            match shape {
                Shape::Text(text) if picture.contains(text.pos) => {
                    let word = text.galley.job.text.clone();
                    if word.ends_with('°') || ["N", "L", "V", "H", "R"].contains(&word.as_str()) {
                        plates.push((word, text.galley.rect.translate(text.pos.to_vec2())));
                    }
                }
                Shape::Mesh(mesh)
                    if mesh.vertices.iter().any(|v| !v.color.is_opaque() && v.color.a() > 0) =>
                {
                    corners.extend(mesh.indices.chunks(3).filter_map(|t| {
                        let [a, b, c] = *t else { return None };
                        let at = |i: u32| mesh.vertices[i as usize].pos.to_vec2();
                        Some(((at(a) + at(b) + at(c)) / 3.0).to_pos2())
                    }));
                }
                _ => {}
            }
        }
        assert!(plates.len() >= 4 && corners.len() > 200, "{model}: {plates:?}");
        for (word, plate) in &plates {
            let under: Vec<&Pos2> = corners.iter().filter(|at| plate.contains(**at)).collect();
            assert!(under.is_empty(), "{model}: {word} covers {} triangles", under.len());
        }
        let apart = |a: &Rect, b: &Rect| !a.intersects(*b);
        for (i, (_, a)) in plates.iter().enumerate() {
            assert!(plates[..i].iter().all(|(_, b)| apart(a, b)), "{model}: {plates:?}");
        }
    }
}

#[test]
#[ignore = "draws pictures to look at: scripts/pictures"]
fn pictures_of_a_pinned_point() -> Result<(), Box<dyn std::error::Error>> {
    let folder = crate::helpers::pictures::picture_folder()?;
    for (name, views, turn) in
        [("front", 1, 0.0), ("turned", 1, 60.0), ("behind", 1, 150.0), ("views", 2, 40.0)]
    {
        let mut bench = bench(scene("blinn_phong", "phong"));
        if views > 1 {
            bench.apply(Action::Compare(CompareCommand::Add));
            bench.apply(Action::Edit(Edit::set(Part::Scene, Scene::reflection_model, "lambert")));
        }
        lobe(&mut bench);
        orbit(&mut bench, Vec3::Y, turn);
        bench.wait_for_lobes();
        bench.picture(&folder.join(format!("pinned-{name}.png")), Color32::from_gray(60))?;
    }
    Ok(())
}

#[test]
fn the_way_through_a_glass_ball_is_drawn_and_told() {
    let mut glass = bench(scene("glass", "phong"));
    assert!(glass.words().iter().any(|word| word == "T"), "{:?}", glass.words());
    // In the colour of the term whose light it is.
    let colours = |shapes: &[Shape]| -> Vec<Color32> {
        let of = |shape: &Shape| match shape {
            Shape::Text(text) if text.galley.text() == "T" => Some(text.galley.job.sections[0].format.color),
            _ => None,
        };
        shapes.iter().filter_map(of).collect()
    };
    assert_eq!(colours(&glass.shapes()), [DARK.term(Term::Transmitted)]);
    for told in ["Through the surface", "inside, n = 1.5", "is reflected completely", "remains inside"] {
        assert!(glass.says(told), "{told}");
    }
    // From the side, the plane in which the ray bends is seen face on.
    let spot = seen(&glass).spots[0].clone();
    glass.key(Key::H, Modifiers::SHIFT);
    assert!(glass.effects.iter().any(|effect| matches!(effect, Effect::Steer(_))), "by the key");
    glass.effects.clear();
    glass.click("From the side");
    let steered = glass.effects.iter().find_map(|effect| match effect {
        Effect::Steer(Steer::Along { way, .. }) => Some(*way),
        _ => None,
    });
    let way = steered.expect("the camera turns");
    assert!(way.dot(spot.normal).abs() < 1e-4 && way.dot(spot.view).abs() < 1e-4, "{way}");
    for model in ["phong", "diffuse_transmission"] {
        let mut other = bench(scene(model, "phong"));
        assert!(
            !other.words().iter().any(|word| word == "T") && !other.says("Through the surface"),
            "{model}"
        );
    }
    // A boundary alone has angles, and no way behind it.
    let mut boundary = bench(scene("rough_dielectric", "phong"));
    assert!(!boundary.words().iter().any(|word| word == "T") && boundary.says("Through the surface"));
}
