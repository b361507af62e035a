//! The marks over the picture can be seen on every picture, and show lights that are outside it.

use bevy_egui::egui::{Color32, Event, PointerButton};
use glam::Vec3;
use lights_camera_models::{
    document::Selection,
    optics::colour::srgb_decode,
    panel::{
        marks::{Lens, anchor, place},
        state::{Action, Session, ThemeChoice, ViewChange},
        theme,
    },
    registry::Registry,
    scene::{Light, Scene, examples::EXAMPLES},
};

use crate::{panels::Bench, screen::Picture};

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

/// A sphere that is selected, three lights in view, and the observer beside the camera.
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
fn every_line_stands_out_of_every_picture() {
    let grounds = [255, 119, 0, theme::DARK.surround.r(), theme::LIGHT.surround.r()].map(|v| [v; 3]);
    let coloured = [[240, 228, 66], [124, 200, 255], [95, 227, 181], [255, 0, 0], [0, 0, 255]];
    let mut bench = bench(marked());
    for (i, ground) in grounds.into_iter().chain(coloured).enumerate() {
        let theme = if i % 2 == 0 { ThemeChoice::Light } else { ThemeChoice::Dark };
        bench.apply(Action::View(ViewChange::Theme(theme)));
        let colour = Color32::from_rgb(ground[0], ground[1], ground[2]);
        let with = shown(&mut bench, colour);
        bench.apply(Action::View(ViewChange::Gizmos(false)));
        let without = shown(&mut bench, colour);
        bench.apply(Action::View(ViewChange::Gizmos(true)));
        let rect = bench.area.rect.shrink(4.0);
        let columns = rect.left() as u32..rect.right() as u32;
        let pixels: Vec<_> = (rect.top() as u32..rect.bottom() as u32)
            .flat_map(|y| columns.clone().map(move |x| (x, y)))
            .filter(|(x, y)| without.at(*x, *y) == ground && with.at(*x, *y) != ground)
            .collect();
        assert!(pixels.len() > 3000, "on {ground:?}: {} pixels of marks", pixels.len());
        let stands_out = |x: u32, y: u32| contrast(with.at(x, y), ground) >= 3.0;
        // No further than from the middle of a lamp to its rim.
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
    for light in &bench.session.document.lights {
        let at = anchor(light, &bench.session.document).and_then(|p| lens.project(p)).unwrap();
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
    // It stands at the upper right.
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
    // Clicking again goes on to the next.
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
        let light = bench.session.document.lights.last().unwrap();
        let rect = bench.area.rect;
        let lens = Lens::of(&bench.session, rect);
        let at = place(light, &bench.session.document, &lens).and_then(|p| lens.project(p)).unwrap();
        assert!(rect.shrink(20.0).contains(at), "{}: {at:?} in {rect:?}", example.file);
    }
}
