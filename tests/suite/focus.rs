//! The window by keyboard alone, without a window: where the focus goes, and that it is seen.

use bevy_egui::egui::{self, Key, Modifiers, Rect};
use lights_camera_models::{
    document::Selection,
    panel::{
        state::{Action, Effect, Lab, Steer},
        theme::DARK,
    },
};

use crate::panels::Bench;

fn focused(bench: &Bench) -> Option<Rect> {
    let id = bench.ctx.memory(egui::Memory::focused)?;
    bench.ctx.viewport(|v| v.prev_pass.widgets.get(id).map(|w| w.rect))
}

/// Frames in the colour of the accent.
fn rings(bench: &mut Bench) -> Vec<Rect> {
    let shapes = bench.shapes();
    shapes
        .iter()
        .filter_map(|shape| match shape {
            egui::Shape::Rect(r) if r.stroke.color == DARK.accent && r.stroke.width > 1.0 => Some(r.rect),
            _ => None,
        })
        .collect()
}

#[test]
fn f6_goes_from_panel_to_panel_and_back_to_the_picture() {
    let mut bench = Bench::new(Lab::default());
    let mut places = Vec::new();
    for _ in 0..4 {
        bench.key(Key::F6, Modifiers::NONE);
        places.push(focused(&bench).map(|r| (r.center().x, r.center().y)));
    }
    let [Some(top), Some(left), Some(right), Some(status)] = places[..] else { panic!("{places:?}") };
    assert!(top.1 < 40.0 && status.1 > 1500.0 && left.0 < 210.0 && right.0 > 900.0, "{places:?}");
    bench.key(Key::F6, Modifiers::NONE);
    assert_eq!(focused(&bench), None, "the picture has the keys again");
    bench.key(Key::F6, Modifiers::SHIFT);
    assert_eq!(focused(&bench).map(|r| r.center().y), Some(status.1), "backwards");
}

#[test]
fn every_focus_is_seen() {
    let mut bench = Bench::with_model("phong");
    bench.key(Key::F6, Modifiers::NONE);
    let mut seen = 0;
    for _ in 0..60 {
        bench.key(Key::Tab, Modifiers::NONE);
        if bench.ctx.text_edit_focused() {
            continue;
        }
        let Some(rect) = focused(&bench) else { continue };
        let visible = Rect::from_min_size(egui::Pos2::ZERO, bench.size).intersect(rect);
        let ring = rings(&mut bench).into_iter().any(|r| r.expand(4.0).contains_rect(visible));
        assert!(ring, "nothing shows that {rect:?} has the focus");
        let senses = bench
            .ctx
            .memory(egui::Memory::focused)
            .and_then(|id| bench.ctx.viewport(|v| v.prev_pass.widgets.get(id).map(|w| w.sense)));
        assert!(
            senses.is_some_and(|s| s.senses_click()),
            "Tab stops at what only the mouse can use: {rect:?}"
        );
        seen += 1;
    }
    assert!(seen > 20, "{seen}");
}

#[test]
fn menus_opened_by_mouse_listen_to_the_arrows_and_enter() {
    let mut bench = Bench::new(Lab::default());
    bench.click("Edit");
    bench.key(Key::ArrowDown, Modifiers::NONE);
    let first = focused(&bench).expect("the first entry");
    assert!(first.height() < 40.0, "an entry, not the menu as a whole");
    bench.key(Key::ArrowDown, Modifiers::NONE);
    let second = focused(&bench).expect("the second entry");
    assert!(second.top() > first.top() && (second.left() - first.left()).abs() < 2.0);
    bench.key(Key::ArrowUp, Modifiers::NONE);
    assert_eq!(focused(&bench), Some(first));
    // The first entry above the first one is the last.
    bench.key(Key::ArrowUp, Modifiers::NONE);
    assert!(focused(&bench).expect("the last entry").top() > second.top());
    bench.key(Key::Escape, Modifiers::NONE);
    bench.click("View");
    bench.key(Key::ArrowDown, Modifiers::NONE);
    bench.effects.clear();
    bench.key(Key::Enter, Modifiers::NONE);
    assert_eq!(bench.effects, [Effect::HomeView]);
}

#[test]
fn keys_steer_the_camera_unless_a_panel_has_them() {
    let mut bench = Bench::with_model("phong");
    bench.key(Key::ArrowLeft, Modifiers::NONE);
    assert_eq!(bench.effects, [Effect::Steer(Steer::Turn(-5.0, 0.0))]);
    bench.effects.clear();
    bench.key(Key::ArrowUp, Modifiers::SHIFT);
    bench.key(Key::PageUp, Modifiers::NONE);
    assert_eq!(bench.effects, [Effect::Steer(Steer::Move(0.0, 1.0)), Effect::Steer(Steer::Zoom(0.9))]);
    bench.effects.clear();
    bench.key(Key::F6, Modifiers::NONE);
    bench.key(Key::ArrowLeft, Modifiers::NONE);
    assert!(bench.effects.is_empty());
}

#[test]
fn a_new_name_takes_the_place_of_the_old_one() {
    let mut bench = Bench::new(Lab::default());
    bench.apply(Action::Select(Selection::Object(0)));
    bench.key(Key::F2, Modifiers::NONE);
    bench.frame(vec![egui::Event::Text("ball".to_owned())]);
    bench.settle();
    bench.key(Key::Enter, Modifiers::NONE);
    assert_eq!(bench.lab.document.objects[0].name.as_deref(), Some("ball"));
}

#[test]
fn the_menus_open_with_alt_and_with_f10() {
    let mut bench = Bench::new(Lab::default());
    bench.key(Key::E, Modifiers::ALT);
    assert!(bench.says("New reflection model…"), "Alt+E opens Edit");
    let first = focused(&bench).expect("its first entry");
    bench.key(Key::V, Modifiers::ALT);
    assert!(!bench.says("New reflection model…") && bench.says("Focus selection"), "Alt+V: View");
    bench.key(Key::E, Modifiers::ALT);
    assert_eq!(focused(&bench), Some(first), "Edit again");
    bench.key(Key::Escape, Modifiers::NONE);
    bench.key(Key::F10, Modifiers::NONE);
    assert!(bench.says("New default scene"), "F10 opens the first menu");
    bench.key(Key::F10, Modifiers::NONE);
    assert!(!bench.says("New default scene"), "and closes it");
    // A letter with Alt is no command of the picture.
    let mode = bench.lab.document.shading_model.clone();
    bench.key(Key::F, Modifiers::ALT);
    assert_eq!(bench.lab.document.shading_model, mode);
}
