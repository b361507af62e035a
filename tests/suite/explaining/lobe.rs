//! The lobe of the model at the explained point, in the picture.

use std::sync::Arc;

use bevy_egui::egui::{Key, Modifiers, Rect, Shape, vec2};
use glam::Vec3;
use lights_camera_models::{
    curves::{Channel, lobe::value},
    document::Edit,
    explain::Spot,
    optics::TermSelection,
    panel::{
        explain::{Lobes, calculations, explained, lobe_calculations, lobes_shown},
        state::{Action, CompareCommand, EXPLAIN_TAB, LobeChoice, LobeScale, Pin, Session, ViewChange},
    },
    parameter::Value,
    registry::Registry,
    scene::{Light, Object, Part, Scene},
};

use crate::window::panels::Bench;

fn bench(scene: Scene) -> Bench {
    let mut bench = Bench::new(Session::new(scene));
    bench.size = vec2(1280.0, 720.0);
    bench.apply(Action::View(ViewChange::BottomTab(EXPLAIN_TAB.to_owned())));
    bench.settle();
    bench.apply(Action::View(ViewChange::Lobe(LobeChoice { scale: LobeScale::Linear, all: false })));
    bench.apply(Action::View(ViewChange::Pin(Some(Pin::middle(0)))));
    bench.wait_for_lobes();
    bench
}

fn is_written(bench: &mut Bench, part: &str) -> bool {
    bench.words().iter().any(|text| text.contains(part))
}

/// Triangles of translucent surfaces over the picture.
fn triangles(bench: &mut Bench) -> usize {
    let count = |shape| match shape {
        Shape::Mesh(mesh) if mesh.vertices.iter().any(|v| !v.color.is_opaque() && v.color.a() > 0) => {
            mesh.indices.len() / 3
        }
        _ => 0,
    };
    bench.shapes().into_iter().map(count).sum()
}

fn scene(model: &str, shading: &str) -> Scene {
    Scene { reflection_model: model.to_owned(), shading_model: shading.to_owned(), ..Scene::default() }
}

fn choose(bench: &mut Bench, scale: LobeScale, all: bool) {
    bench.apply(Action::View(ViewChange::Lobe(LobeChoice { scale, all })));
    bench.wait_for_lobes();
}

fn lobes(bench: &Bench) -> Arc<Lobes> {
    lobes_shown(&bench.ctx).unwrap_or_else(|| panic!("there are no lobes: {:?}", explained(&bench.ctx)))
}

/// The point whose vectors are shown: the most important one.
fn spot(bench: &Bench) -> Spot {
    let explained = explained(&bench.ctx).expect("something is explained");
    let seen = explained.explanation.seen.clone().expect("the sphere");
    let position = lobes(bench).position;
    seen.spots.into_iter().find(|spot| spot.position == position).expect("the lobe stands at a point of it")
}

#[test]
fn towards_the_observer_its_length_is_the_number_that_is_explained() {
    for (model, shading) in [("phong", "phong"), ("blinn_phong", "gouraud"), ("ward", "flat")] {
        let bench = bench(scene(model, shading));
        let (spot, lobes) = (spot(&bench), lobes(&bench));
        let drawn = lobes.lobes.as_ref().expect("a lobe");
        assert_eq!(drawn.len(), 1, "{model}");
        let lit = spot.lights.iter().find(|lit| lit.light.index == drawn[0].light).expect("of its lights");
        let seen = explained(&bench.ctx).and_then(|e| e.explanation.seen.clone()).expect("the sphere");
        let f = value(&*seen.model.surface.0, drawn[0].l, spot.view, &spot.frame, TermSelection::All);
        let geometry = lit.geometry.expect("a direction");
        let right =
            (lit.response.diffuse + lit.response.specular) / (std::f32::consts::PI * geometry.cosine("N·L"));
        assert!((f - right).abs().max_element() < 1e-5 * right.max_element().max(1e-3), "{model}");
        // The drawing has that value there.
        let lobe = &drawn[0].lobe;
        let nearest = (0..lobe.ways.len())
            .max_by(|a, b| lobe.ways[*a].dot(spot.view).total_cmp(&lobe.ways[*b].dot(spot.view)))
            .expect("not empty");
        let there =
            value(&*seen.model.surface.0, drawn[0].l, lobe.ways[nearest], &spot.frame, TermSelection::All);
        assert_eq!(lobe.values[nearest], Channel::Luminance.of(there), "{model}");
    }
}

#[test]
fn it_is_calculated_when_something_changed_and_only_then() {
    let mut bench = bench(scene("blinn_phong", "phong"));
    assert!(triangles(&mut bench) > 200);
    let first = lobe_calculations(&bench.ctx);
    assert_eq!(first, 1);
    for _ in 0..5 {
        bench.settle();
    }
    choose(&mut bench, LobeScale::Logarithmic, false);
    choose(&mut bench, LobeScale::Linear, false);
    assert_eq!(lobe_calculations(&bench.ctx), first, "nothing of the lobe changed");

    let before = lobes(&bench);
    let alpha = Edit::material(Part::Object(0), "alpha", Value::Integer(300));
    bench.apply(Action::Edit(alpha));
    bench.wait_for_lobes();
    assert_eq!(lobe_calculations(&bench.ctx), first + 1, "a knob turned");
    let highest = |lobes: &Lobes| lobes.lobes.as_ref().expect("a lobe")[0].lobe.ways.len();
    assert_ne!(highest(&before), highest(&lobes(&bench)));

    let mut light = bench.session.document.lights[0].clone();
    light.position = light.position.map(|p| p + Vec3::new(1.5, -0.5, 0.0));
    let mut moved = (*bench.session.document).clone();
    moved.lights[0] = light;
    let l = lobes(&bench).lobes.as_ref().expect("a lobe")[0].l;
    let mut bench = self::bench(moved);
    let turned = lobes(&bench).lobes.as_ref().expect("a lobe")[0].l;
    assert!(turned.angle_between(l) > 0.05, "the lobe turns with the light");
    assert_eq!(turned, spot(&bench).lights[0].geometry.expect("a direction").l);

    let count = lobe_calculations(&bench.ctx);
    choose(&mut bench, LobeScale::Off, false);
    let alpha = Edit::material(Part::Object(0), "alpha", Value::Integer(40));
    bench.apply(Action::Edit(alpha));
    bench.settle();
    assert_eq!((lobe_calculations(&bench.ctx), triangles(&mut bench)), (count, 0), "it is off");
    assert!(calculations(&bench.ctx) > 1);
}

#[test]
fn it_hides_nothing_until_it_is_asked_for() {
    let mut bench = Bench::new(Session::new(scene("phong", "phong")));
    bench.size = vec2(1280.0, 720.0);
    bench.apply(Action::View(ViewChange::BottomTab(EXPLAIN_TAB.to_owned())));
    bench.apply(Action::View(ViewChange::Pin(Some(Pin::middle(0)))));
    bench.wait_for_lobes();
    assert!(bench.session.explains() && triangles(&mut bench) == 0 && !is_written(&mut bench, "Lobe"));
    bench.key(Key::E, Modifiers::SHIFT);
    bench.wait_for_lobes();
    assert!(triangles(&mut bench) > 200 && is_written(&mut bench, "Lobe"));
}

#[test]
fn its_scale_stays_while_a_pixel_is_pinned() {
    let paint = |bench: &mut Bench, code: u8| {
        let colour = Edit::material(Part::Object(0), "base_colour", Value::Colour([code; 3]));
        bench.apply(Action::Edit(colour));
        bench.wait_for_lobes();
    };
    let mut lambert = bench(scene("lambert", "phong"));
    for code in [255, 120, 40] {
        paint(&mut lambert, code);
        assert!(is_written(&mut lambert, "Length of the vectors: 0.318:\na white matte surface"), "{code}");
    }
    choose(&mut lambert, LobeScale::Logarithmic, false);
    for code in [255, 40] {
        paint(&mut lambert, code);
        assert!(is_written(&mut lambert, "Centre: 0.001; length of the vectors: 10"), "{code}");
    }
    // A taller lobe raises the scale, which another pixel forgets and a darker surface does not.
    let ends = |bench: &mut Bench| {
        let line = bench.words().into_iter().find_map(|text| {
            Some(text.lines().find_map(|line| line.strip_prefix("Length of the vectors: "))?.to_owned())
        });
        line.unwrap_or_else(|| panic!("no legend: {:?}", bench.words()))
    };
    let mut phong = bench(scene("blinn_phong", "phong"));
    let tall = ends(&mut phong);
    assert!(tall.parse::<f32>().expect("a number") > 0.4, "{tall}");
    phong.apply(Action::Edit(Edit::set(Part::Scene, Scene::reflection_model, "lambert")));
    phong.wait_for_lobes();
    assert_eq!(ends(&mut phong), tall);
    phong.apply(Action::View(ViewChange::Pin(Some(Pin { view: 0, at: [0.01, 0.01] }))));
    phong.wait_for_lobes();
    assert!(ends(&mut phong).starts_with("0.318"), "{}", ends(&mut phong));
}

#[test]
fn menu_button_and_key_choose_it() {
    let mut bench = bench(scene("phong", "phong"));
    assert!(is_written(&mut bench, "BRDF f in sr⁻¹") && is_written(&mut bench, "Length of the vectors: "));
    bench.key(Key::E, Modifiers::SHIFT);
    assert_eq!(bench.session.view.lobe.scale, LobeScale::Logarithmic);
    bench.wait_for_lobes();
    assert!(is_written(&mut bench, "logarithmic"));
    bench.key(Key::E, Modifiers::SHIFT);
    assert!(bench.session.view.lobe.scale == LobeScale::Off && !is_written(&mut bench, "Lobe: "));
    bench.key(Key::E, Modifiers::SHIFT);
    assert_eq!(bench.session.view.lobe.scale, LobeScale::Linear);
    bench.click("Lobe: linear");
    bench.settle();
    bench.click("For all lights");
    assert!(bench.session.view.lobe.all);
    bench.key(Key::F1, Modifiers::NONE);
    assert!(bench.says("Lobe at the explained point"));
}

/// Three lights around the default sphere, one of them behind it, and ambient light.
fn three_lights() -> Scene {
    let light = |x: f32, y: f32, z: f32| Light {
        position: Some(Vec3::new(x, y, z)),
        ..Scene::default().lights[0].clone()
    };
    let everywhere =
        Light { light_type: "ambient".to_owned(), position: None, intensity: 0.01, ..Light::default() };
    Scene {
        lights: vec![light(2.0, 8.0, 8.5), light(8.0, 7.0, 8.0), light(5.0, 5.0, 1.0), everywhere],
        ..scene("phong", "phong")
    }
}

#[test]
fn each_light_that_reaches_the_point_has_a_lobe() {
    let mut bench = bench(three_lights());
    assert_eq!(lobes(&bench).lobes.as_ref().expect("a lobe").len(), 1);
    choose(&mut bench, LobeScale::Linear, true);
    let of = |bench: &Bench| -> Vec<usize> {
        let mut lights: Vec<_> =
            lobes(bench).lobes.as_ref().expect("lobes").iter().map(|light| light.light).collect();
        lights.sort_unstable();
        lights
    };
    assert_eq!(of(&bench), [0, 1], "not the one behind, nor ambient light");
    assert!(is_written(&mut bench, "Point 1") && is_written(&mut bench, "Point 2"));
    // More than there are colours: the brightest, with a remark.
    let mut many = three_lights();
    let first = many.lights[0].clone();
    many.lights = (0..9)
        .map(|i| Light { position: Some(Vec3::new(1.0 + i as f32, 8.0, 8.5)), ..first.clone() })
        .collect();
    let mut bench = self::bench(many);
    choose(&mut bench, LobeScale::Logarithmic, true);
    assert_eq!(of(&bench).len(), 6);
    assert!(is_written(&mut bench, "The 6 brightest of 9 lights"));
}

#[test]
fn it_says_why_there_is_none() {
    let mut dark = three_lights();
    dark.lights.drain(0..2);
    let mut bench = bench(dark);
    bench.session.view.lobe.all = true;
    bench.settle();
    assert!(is_written(&mut bench, "No light with a direction reaches the point"));
    let mut behind = three_lights();
    behind.lights = vec![behind.lights[2].clone()];
    let mut bench = self::bench(behind);
    assert!(is_written(&mut bench, "faces away from the light") && triangles(&mut bench) == 0);
    let mut everywhere = three_lights();
    everywhere.lights.drain(0..3);
    let mut bench = self::bench(everywhere);
    assert!(is_written(&mut bench, "Ambient light has no direction"));
    let mut bench = self::bench(scene("phong", "phong"));
    bench.apply(Action::View(ViewChange::Terms(TermSelection::Ambient)));
    bench.settle();
    assert!(is_written(&mut bench, "The ambient term has no lobe"));
    bench.apply(Action::View(ViewChange::Terms(TermSelection::Specular)));
    bench.wait_for_lobes();
    assert!(is_written(&mut bench, "specular term of f"));
    // For an explained background, there is no remark.
    let corner = bench.area.rect.left_top() + vec2(24.0, 80.0);
    bench.apply(Action::View(ViewChange::Pin(None)));
    bench.frame(vec![bevy_egui::egui::Event::PointerMoved(corner)]);
    bench.settle();
    assert!(!is_written(&mut bench, "lobe") && triangles(&mut bench) == 0);
}

#[test]
fn of_several_views_each_has_that_of_a_pinned_point() {
    let mut bench = bench(scene("lambert", "phong"));
    let alone = triangles(&mut bench);
    bench.apply(Action::Compare(CompareCommand::Add));
    bench.apply(Action::Edit(Edit::set(Part::Scene, Scene::reflection_model, "blinn_phong")));
    bench.apply(Action::View(ViewChange::Pin(Some(Pin::middle(1)))));
    bench.wait_for_lobes();
    let both = triangles(&mut bench);
    assert!(alone > 500 && both > alone + 500, "{alone}, {both}");
    assert_eq!(lobes(&bench).lobes.as_ref().expect("a lobe").len(), 1);
}

#[test]
fn the_frame_of_an_anisotropic_model_is_that_of_the_picture() {
    let object = Object { rotation: Vec3::new(0.0, 0.0, 40.0), ..Scene::default().objects[0].clone() };
    let mut brushed = Scene { objects: vec![object], ..scene("ward", "phong") };
    brushed.objects[0].material.set("alpha_x", Value::Number(0.08));
    brushed.objects[0].material.set("alpha_y", Value::Number(0.5));
    let bench = bench(brushed);
    let (spot, lobes) = (spot(&bench), lobes(&bench));
    let lit = spot.lights.first().expect("a light");
    let geometry = lit.geometry.expect("a direction");
    let h = geometry.h;
    assert!((h.dot(spot.frame.t) - geometry.cosine("H·T")).abs() < 1e-6);
    // The lobe is longer along the brushed grooves' normal than along them.
    let drawn = &lobes.lobes.as_ref().expect("a lobe")[0].lobe;
    let mean = |axis: Vec3| {
        let high = drawn.ways.iter().zip(&drawn.values).filter(|(_, v)| **v > 0.3 * drawn.largest());
        let (sum, count) = high
            .fold((0.0, 0), |(sum, n), (way, _)| ((way.dot(axis) - geometry.r.dot(axis)).abs() + sum, n + 1));
        sum / count.max(1) as f32
    };
    assert!(mean(spot.frame.b) > 2.0 * mean(spot.frame.t), "{} {}", mean(spot.frame.b), mean(spot.frame.t));
}

#[test]
fn the_legend_says_which_direction_of_a_light_with_extent_it_is_for() {
    let said = "Light with extent: from the direction\nthat gives most";
    let mut scene = scene("blinn_phong", "phong");
    assert!(!is_written(&mut bench(scene.clone()), said), "a point light has one direction");
    let lamp = &mut scene.lights[0];
    lamp.set_type(
        Registry::builtin().light("sphere").expect("built in"),
        &Registry::builtin(),
        scene.scene_size,
    );
    let mut bench = bench(scene);
    assert!(is_written(&mut bench, said), "{:?}", bench.words());
    let (spot, lobes) = (spot(&bench), lobes(&bench));
    let drawn = &lobes.lobes.as_ref().expect("a lobe")[0];
    let brightest = spot.lights[0].integral.and_then(|integral| integral.brightest).expect("it shines");
    assert!(drawn.extends && drawn.l == brightest.geometry.l);
}

/// The texts on the screen, each with the size of its letters and its place.
fn sizes(shapes: &[Shape]) -> Vec<(String, f32, Rect)> {
    let text = |shape: &Shape| match shape {
        Shape::Text(text) => {
            let size = text.galley.job.sections.first()?.format.font_id.size;
            Some((text.galley.text().to_owned(), size, text.visual_bounding_rect()))
        }
        _ => None,
    };
    shapes.iter().filter_map(text).collect()
}

#[test]
fn in_a_presentation_its_legend_and_the_letters_of_vectors_are_as_large_as_the_caption() {
    for model in ["phong", "cook_torrance"] {
        let mut bench = bench(scene(model, "phong"));
        bench.apply(Action::View(ViewChange::Presenting(true)));
        bench.wait_for_lobes();
        let shapes = bench.shapes();
        let texts = sizes(&shapes);
        let of = |start: &str| {
            let found = texts.iter().find(|(text, ..)| text.starts_with(start));
            found.unwrap_or_else(|| panic!("{model}: {start} is not in {texts:?}"))
        };
        let (caption, title) = (of("Phong shading").1, of("Lobe: ").2);
        let is_as_large = |size: f32| (size - caption).abs() < 0.01;
        assert!(caption > 20.0, "{caption}");
        for letter in ["N", "L", "V"] {
            let found = texts.iter().any(|(text, size, _)| text == letter && is_as_large(*size));
            assert!(found, "{model}: {letter} in {texts:?}");
        }
        // The smallest plate around the title.
        let plates = shapes.iter().filter_map(|shape| match shape {
            Shape::Rect(plate) if plate.rect.contains_rect(title) => Some(plate.rect),
            _ => None,
        });
        let plate = plates.min_by(|a, b| a.area().total_cmp(&b.area())).expect("a plate");
        assert!(bench.area.frame.shrink(7.9).contains_rect(plate), "{model}: {plate:?}");
        let (inside, outside): (Vec<_>, Vec<_>) =
            texts.iter().partition(|(_, _, place)| plate.expand(1.0).contains_rect(*place));
        assert!(inside.len() >= 4, "{model}: a title and three numbers, not {inside:?}");
        assert!(inside.iter().all(|(_, size, _)| is_as_large(*size)), "{model}: {inside:?}");
        let covered: Vec<_> = outside.iter().filter(|(_, _, place)| place.intersects(plate)).collect();
        assert!(covered.is_empty(), "{model}: {covered:?}");
    }
}
