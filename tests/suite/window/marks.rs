//! The marks over the picture are visible on every picture, and show lights that are outside it.

use bevy_egui::egui::{Color32, Event, PointerButton, Pos2, Rect, Shape, Vec2, epaint::ColorMode};
use glam::Vec3;
use lights_camera_models::{
    document::Selection,
    optics::colour::srgb_decode,
    panel::{
        marks::{Lens, places},
        state::{Action, Clipping, Session, ThemeChoice, ViewChange},
        theme,
    },
    parameter::Value,
    registry::Registry,
    scene::{Light, Scene, examples::EXAMPLES, rotation::rotation},
};

use crate::{helpers::screen::Picture, window::panels::Bench};

fn luminance([r, g, b]: [u8; 3]) -> f32 {
    let linear = |v: u8| srgb_decode(f32::from(v) / 255.0);
    0.2126 * linear(r) + 0.7152 * linear(g) + 0.0722 * linear(b)
}

fn contrast(a: [u8; 3], b: [u8; 3]) -> f32 {
    let (a, b) = (luminance(a) + 0.05, luminance(b) + 0.05);
    a.max(b) / a.min(b)
}

fn point(at: [f32; 3]) -> Light {
    Light { position: Some(Vec3::from_array(at)), ..Light::default() }
}

/// A selected sphere, three lights in view, and the observer next to the camera.
fn marked() -> Scene {
    let mut scene = Scene::default();
    let down = Some(Vec3::new(0.3, -1.0, 0.0));
    scene.lights = vec![
        point([3.0, 6.2, 4.0]),
        Light { light_type: "spot".to_owned(), direction: down, ..point([6.5, 6.2, 4.0]) },
        Light {
            light_type: "directional".to_owned(),
            position: None,
            direction: Some(Vec3::new(0.1, -0.1, 1.0)),
            ..Light::default()
        },
    ];
    scene.observer.position = Vec3::new(7.0, 4.0, 6.0);
    scene
}

fn bench(scene: Scene) -> Bench {
    let mut session = Session::new(scene);
    (session.facts.eye, session.facts.camera) = (Vec3::new(5.0, 5.0, 9.5), glam::Quat::IDENTITY);
    let mut bench = Bench::new(session);
    bench.size = bevy_egui::egui::vec2(1280.0, 720.0);
    bench.settle();
    bench
}

fn shown(bench: &mut Bench, ground: Color32) -> Picture {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("window.png");
    bench.picture(&file, ground).unwrap();
    Picture::read(&file)
}

#[test]
fn the_observer_is_not_drawn_over_objects_by_a_camera_behind_it() {
    let drawn = |bench: &mut Bench| {
        let observer = Color32::from_rgb(0x5f, 0xe3, 0xb5);
        bench.shapes().into_iter().any(|shape| match shape {
            Shape::LineSegment { stroke, .. } => stroke.color == observer,
            Shape::Path(path) => {
                matches!(path.stroke.color, ColorMode::Solid(colour) if colour == observer)
            }
            _ => false,
        })
    };
    let mut bench = bench(marked());
    assert!(drawn(&mut bench), "beside the sphere");
    let mut scene = marked();
    scene.observer.position = Vec3::new(5.0, 5.0, 8.0);
    bench = self::bench(scene);
    assert!(!drawn(&mut bench), "before the sphere");
    // From the side it is seen.
    bench.session.facts.eye = Vec3::new(9.5, 5.0, 6.5);
    bench.session.facts.camera = glam::Quat::from_rotation_y(std::f32::consts::FRAC_PI_2);
    bench.settle();
    assert!(drawn(&mut bench), "from the side");
}

#[test]
fn every_line_stands_out_of_every_picture() {
    let grounds = [255, 119, 0, theme::DARK.surround.r(), theme::LIGHT.surround.r()].map(|v| [v; 3]);
    let coloured = [[240, 228, 66], [124, 200, 255], [95, 227, 181], [255, 0, 0], [0, 0, 255]];
    let mut bench = bench(marked());
    for (i, ground) in grounds.into_iter().chain(coloured).enumerate() {
        let theme = if i % 2 == 0 { ThemeChoice::Light } else { ThemeChoice::Dark };
        bench.apply(Action::View(ViewChange::Theme(theme)));
        let colour = Color32::from_rgb(ground[0], ground[1], ground[2]);
        let with = shown(&mut bench, colour);
        bench.apply(Action::View(ViewChange::Markers(false)));
        let without = shown(&mut bench, colour);
        bench.apply(Action::View(ViewChange::Markers(true)));
        let rect = bench.area.rect.shrink(4.0);
        let columns = rect.left() as u32..rect.right() as u32;
        let pixels: Vec<_> = (rect.top() as u32..rect.bottom() as u32)
            .flat_map(|y| columns.clone().map(move |x| (x, y)))
            .filter(|(x, y)| without.at(*x, *y) == ground && with.at(*x, *y) != ground)
            .collect();
        assert!(pixels.len() > 3000, "on {ground:?}: {} pixels of marks", pixels.len());
        let stands_out = |x: u32, y: u32| contrast(with.at(x, y), ground) >= 3.0;
        // No further than from the centre of a lamp to its rim.
        let lost = pixels
            .iter()
            .filter(|(x, y)| !(x - 6..=x + 6).any(|x| (y - 6..=y + 6).any(|y| stands_out(x, y))));
        assert_eq!(lost.count(), 0, "on {ground:?}");
        let clear = pixels.iter().filter(|(x, y)| stands_out(*x, *y)).count();
        assert!(5 * clear > pixels.len(), "on {ground:?}: {clear} of {}", pixels.len());
    }
}

#[test]
fn each_kind_of_light_in_view_has_its_mark_in_the_room() {
    let mut bench = bench(marked());
    let picture = shown(&mut bench, Color32::BLACK);
    let lens = Lens::of(&bench.session, bench.area.rect);
    let places = places(&bench.session.document, &bench.registry, &lens, &bench.area.written);
    for (light, place) in bench.session.document.lights.iter().zip(places) {
        assert!(light.position.is_none() || light.position == place);
        let at = place.and_then(|p| lens.project(p)).unwrap();
        assert!(bench.area.rect.contains(at), "{}: {at:?}", light.light_type);
        let (x, y) = (at.x as u32, at.y as u32);
        let yellow = |p: [u8; 3]| p[0] > 200 && p[1] > 190 && p[2] < 110;
        assert!(picture.count(x - 5..x + 5, y - 5..y + 5, yellow) > 20, "{} at {at:?}", light.light_type);
    }
    assert!(!bench.says("Outside the view"));
}

#[test]
fn a_light_outside_the_view_has_an_arrow_that_selects_it() {
    let mut bench = bench(Scene::default());
    let rect = bench.area.rect;
    let arrow = bench.find("Outside the view: Point 1").map(|s| s.rect.center()).unwrap();
    // It is at the upper right.
    assert!(arrow.x > rect.center().x && arrow.y < rect.center().y, "{arrow:?}");
    let edge = rect.shrink(50.0);
    assert!(rect.contains(arrow) && !edge.contains(arrow), "{arrow:?} in {rect:?}");
    bench.frame(vec![Event::PointerMoved(arrow)]);
    bench.settle();
    assert!(!bench.area.has_pointer, "a drag there does not turn the camera");
    bench.click_at(arrow, PointerButton::Primary);
    assert_eq!(bench.session.selection, Selection::Light(0));
    bench.hover(arrow);
    assert!(bench.says("Point 1"), "the tooltip names it");
    bench.session.document.amend(|scene| scene.lights[0].position = Some(Vec3::new(5.0, 6.0, 5.0)));
    bench.settle();
    assert!(!bench.says("Outside the view"));
}

#[test]
fn light_from_everywhere_has_neither_mark_nor_arrow() {
    let light = Light { light_type: "ambient".to_owned(), position: None, ..Light::default() };
    let bench = bench(Scene { lights: vec![light], ..Scene::default() });
    assert!(!bench.says("Outside the view"));
}

#[test]
fn many_lights_share_their_arrows() {
    let lights = (0..256)
        .map(|i| {
            let (x, z) = (i % 16, i / 16);
            point([0.6 * (x as f32 + 0.5), 9.0, 0.6 * (z as f32 + 0.5)])
        })
        .collect();
    let mut bench = bench(Scene { lights, ..Scene::default() });
    let arrows: Vec<_> =
        bench.tree.iter().filter(|s| s.label.starts_with("Outside the view")).cloned().collect();
    assert!((2..=40).contains(&arrows.len()), "{} arrows", arrows.len());
    for (i, a) in arrows.iter().enumerate() {
        for b in &arrows[i + 1..] {
            assert!(a.rect.center().distance(b.rect.center()) > 15.0, "{} and {}", a.label, b.label);
        }
    }
    let many = arrows.iter().find(|a| a.label.ends_with("more")).unwrap();
    // Clicking again selects the next.
    bench.click_at(many.rect.center(), PointerButton::Primary);
    let first = bench.session.selection;
    bench.click_at(many.rect.center(), PointerButton::Primary);
    assert!(matches!(first, Selection::Light(_)) && bench.session.selection != first);
    let shapes = bench.shapes().len();
    assert!(shapes < 5000, "{shapes} shapes");
}

#[test]
fn a_new_directional_light_has_its_mark_in_the_view() {
    for example in EXAMPLES.iter() {
        let registry = Registry::builtin();
        let session = Session::new(example.scene(&registry).unwrap());
        let mut bench = Bench::new(session);
        bench.size = bevy_egui::egui::vec2(1280.0, 720.0);
        bench.settle();
        bench.apply(Action::AddLight("directional".to_owned()));
        let rect = bench.area.rect;
        let lens = Lens::of(&bench.session, rect);
        let places = places(&bench.session.document, &bench.registry, &lens, &bench.area.written);
        let at = places.last().copied().flatten().and_then(|p| lens.project(p)).unwrap();
        assert!(rect.shrink(20.0).contains(at), "{}: {at:?} in {rect:?}", example.file);
    }
}

/// The colours of lights and of the selection.
const YELLOW: Color32 = Color32::from_rgb(0xf0, 0xe4, 0x42);
const BLUE: Color32 = Color32::from_rgb(0x7c, 0xc8, 0xff);

/// The lines in this colour.
fn lines(bench: &mut Bench, colour: Color32) -> Vec<Vec<Pos2>> {
    let line = |shape| match shape {
        Shape::Path(p) if p.stroke.color == ColorMode::Solid(colour) => Some(p.points),
        Shape::LineSegment { points, stroke } if stroke.color == colour => Some(points.to_vec()),
        _ => None,
    };
    bench.shapes().into_iter().filter_map(line).collect()
}

/// The texts over the picture: badges, caption, axes.
fn written(bench: &mut Bench) -> Vec<Rect> {
    let (plate, disc) = (theme::DARK.plate(), theme::DARK.panel.gamma_multiply(0.72));
    let part = |shape| match shape {
        Shape::Rect(r) if r.fill == plate => Some(r.rect),
        Shape::Circle(c) if c.fill == disc => {
            Some(Rect::from_center_size(c.center, Vec2::splat(2.0 * c.radius)))
        }
        _ => None,
    };
    bench.shapes().into_iter().filter_map(part).collect()
}

fn arrows(bench: &Bench) -> Vec<(String, Rect)> {
    let labels = ["Outside the view", "Under what is written"];
    let arrow = |label: &str| labels.iter().any(|l| label.starts_with(l));
    bench.tree.iter().filter(|s| arrow(&s.label)).map(|s| (s.label.clone(), s.rect)).collect()
}

fn example(file: &str) -> Bench {
    let example = EXAMPLES.iter().find(|e| e.file == file).unwrap();
    let mut bench = Bench::new(Session::new(example.scene(&Registry::builtin()).unwrap()));
    bench.size = bevy_egui::egui::vec2(1280.0, 720.0);
    bench.settle();
    bench
}

#[test]
fn light_from_a_direction_has_a_small_mark_beside_the_objects() {
    for file in ["gouraud_misses_highlight.json", "shapes_and_lights.json", "gold_three_lights.json"] {
        let mut bench = example(file);
        let lens = Lens::of(&bench.session, bench.area.rect);
        let scene = bench.session.document.scene().clone();
        let objects: Vec<_> = (scene.objects.iter())
            .map(|o| {
                let at = lens.project(o.position).unwrap();
                let side =
                    lens.project(o.position + bench.session.facts.camera * Vec3::X * 0.25 * o.size).unwrap();
                (at, at.distance(side))
            })
            .collect();
        for line in lines(&mut bench, YELLOW) {
            let size = Rect::from_points(&line).size();
            assert!(size.x.max(size.y) <= 60.0, "{file}: a line of {size:?}");
            // Lights with a position are drawn there.
            if scene.lights.iter().all(|l| l.position.is_none()) {
                let over = line.iter().any(|p| objects.iter().any(|(at, r)| at.distance(*p) < *r));
                assert!(!over, "{file}: {line:?} lies across an object");
            }
        }
    }
}

#[test]
fn the_light_that_is_selected_has_its_mark_in_full_size() {
    let mut bench = example("gouraud_misses_highlight.json");
    let longest = |lines: Vec<Vec<Pos2>>| lines.iter().map(|l| l[0].distance(l[1])).fold(0.0, f32::max);
    let before = longest(lines(&mut bench, YELLOW));
    bench.apply(Action::Select(Selection::Light(0)));
    let after = longest(lines(&mut bench, BLUE));
    assert!(after > 2.0 * before && before > 12.0, "{before} and {after}");
}

#[test]
fn marks_keep_clear_of_what_is_written() {
    // Lights behind the badge, the caption and the axes; and farther out in the same directions.
    for (far, said) in [(1.0, "Under what is written"), (1.6, "Outside the view")] {
        for file in ["many_lights.json", "gold_three_lights.json", "shapes_and_lights.json"] {
            let mut bench = example(file);
            bench.session.facts.clipping[0] = Clipping::new(vec![50; Clipping::GRID[0] * Clipping::GRID[1]]);
            bench.settle();
            let lens = Lens::of(&bench.session, bench.area.rect);
            let plates = written(&mut bench);
            assert_eq!(plates.len(), 3, "{file}: badge, caption, axes");
            let (eye, camera) = (bench.session.facts.eye, bench.session.facts.camera);
            let [ahead, right, up] = [Vec3::NEG_Z, Vec3::X, Vec3::Y].map(|axis| camera * axis);
            let origin = lens.project(eye + ahead).unwrap();
            let unit = lens.project(eye + ahead + right).unwrap().x - origin.x;
            let behind = |plate: &Rect| {
                let to = (plate.center() - origin) * far / unit;
                point((eye + 3.0 * (ahead + right * to.x - up * to.y)).to_array())
            };
            let lights: Vec<_> = plates.iter().map(behind).collect();
            bench.session.document.amend(|scene| scene.lights = lights);
            bench.settle();
            let arrows = arrows(&bench);
            assert_eq!(arrows.len(), 3, "{file}: {arrows:?}");
            for (label, arrow) in &arrows {
                assert!(label.starts_with(said), "{file}: {label}");
                let hidden = plates.iter().any(|p| p.shrink(0.5).intersects(arrow.shrink(4.0)));
                assert!(!hidden, "{file}: {label} at {arrow:?} is under {plates:?}");
            }
            assert!(lines(&mut bench, YELLOW).is_empty(), "{file}: no marks where they are covered");
        }
    }
}

#[test]
fn a_light_outside_the_view_has_its_arrow_and_nothing_else() {
    // Its beam enters the picture from above.
    let down = Some(Vec3::new(0.0, -1.0, 0.0));
    let mut bench = bench(Scene::default());
    let rect = bench.area.rect;
    let lens = Lens::of(&bench.session, rect);
    let heights = (0..100).map(|k| 6.0 + 0.04 * k as f32);
    let above = |y: &f32| lens.project(Vec3::new(5.0, *y, 5.0)).unwrap().y < rect.top() - 4.0;
    let y = heights.into_iter().find(above).unwrap();
    let spot = Light { light_type: "spot".to_owned(), direction: down, ..point([5.0, y, 5.0]) };
    bench.session.document.amend(|scene| scene.lights = vec![spot]);
    bench.settle();
    assert_eq!(arrows(&bench).len(), 1);
    assert!(lines(&mut bench, YELLOW).is_empty());
}

#[test]
fn the_frame_of_what_is_selected_is_tight() {
    for (kind, turn, parameter) in [
        ("teapot", [0.0, 0.0, 0.0], None),
        ("teapot", [30.0, 40.0, 10.0], None),
        ("sphere", [0.0; 3], None),
        ("torus", [80.0, 0.0, 0.0], Some(("tube_radius", 0.02))),
        ("torus", [80.0, 0.0, 0.0], Some(("tube_radius", 0.24))),
        ("superellipsoid", [45.0, 30.0, 0.0], Some(("vertical_exponent", 0.1))),
        ("superellipsoid", [45.0, 30.0, 0.0], Some(("vertical_exponent", 3.0))),
    ] {
        let mut scene = Scene::default();
        scene.objects[0].object_type = kind.to_owned();
        scene.objects[0].rotation = Vec3::from_array(turn);
        if let Some((name, value)) = parameter {
            scene.objects[0].shape.set(name, Value::Number(value));
        }
        let mut bench = bench(scene);
        bench.apply(Action::Select(Selection::Object(0)));
        let lens = Lens::of(&bench.session, bench.area.rect);
        let object = bench.session.document.objects[0].clone();
        let shape = bench.registry.shape(kind).unwrap();
        let mesh = shape.mesh(&object.shape, shape.declaration.default_tessellation);
        let turn = rotation(object.rotation);
        let seen =
            mesh.positions.iter().map(|p| lens.project(object.position + turn * (object.size * *p)).unwrap());
        let seen = Rect::from_points(&seen.collect::<Vec<_>>());
        let points: Vec<_> = lines(&mut bench, BLUE).into_iter().flatten().collect();
        let frame = Rect::from_points(&points);
        for (of, is) in [(seen.min, frame.min), (seen.max, frame.max)] {
            let apart = (of - is).abs();
            assert!(apart.x.max(apart.y) <= 12.0, "{kind}: {frame:?} around {seen:?}");
        }
        assert!(points.iter().all(|p| !seen.contains(*p)), "{kind}: it covers nothing");
    }
    // It stays in the picture, however large the object is.
    let mut bench = bench(Scene::default());
    bench.session.document.amend(|scene| scene.objects[0].size = 8.0);
    bench.apply(Action::Select(Selection::Object(0)));
    let points: Vec<_> = lines(&mut bench, BLUE).into_iter().flatten().collect();
    assert!(points.len() >= 12 && points.iter().all(|p| bench.area.rect.contains(*p)), "{points:?}");
}
