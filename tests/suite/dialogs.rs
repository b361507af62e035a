//! The dialogs that choose files: their size, their colours, the preview.

use std::fs;

use bevy_egui::egui::{Color32, Event, Id, Key, Modifiers, Order, Shape, vec2};
use lights_camera_models::{
    optics::colour::srgb_decode,
    panel::{
        state::{Action, Session, ThemeChoice, ViewChange},
        theme::Palette,
    },
};

use crate::{examples::until, panels::Bench, support::root};

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
fn the_dialog_takes_seventy_per_cent_of_the_window() {
    for percent in [100, 150] {
        let (bench, _folder) = open(ThemeChoice::Dark, percent);
        let rect = bench.ctx.memory(|m| m.area_rect(Id::new("open dialog"))).expect("open");
        let share = rect.size() / bench.ctx.content_rect().size();
        assert!(
            (0.66..=0.78).contains(&share.x) && (0.66..=0.82).contains(&share.y),
            "{percent} %: {share:?}"
        );
        assert!(bench.ctx.content_rect().contains_rect(rect));
    }
}

#[test]
fn what_is_typed_and_what_is_selected_can_be_seen_in_both_themes() {
    for theme in [ThemeChoice::Dark, ThemeChoice::Light] {
        let (mut bench, _folder) = open(theme, 100);
        let palette = Palette::of(&bench.session.view);
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
        // The style of the dialogs stays theirs.
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
