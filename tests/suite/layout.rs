//! What the panels leave to the picture, and what of them is read whole, without a window.

use std::collections::BTreeSet;

use bevy_egui::egui::{Event, Key, Modifiers, PointerButton, Shape, pos2, vec2};
use lights_camera_models::{
    document::{Edit, ObjectField, Selection},
    panel::{
        keys,
        state::{Action, Session, ViewChange},
    },
    scene::Scene,
};

use crate::panels::Bench;

/// A window of 1280×720 pixels in which everything is so large, per cent.
fn bench(scale: u16) -> Bench {
    let mut bench = Bench::with_model("phong");
    bench.size = vec2(1280.0, 720.0);
    bench.apply(Action::View(ViewChange::Scale(scale)));
    bench
}

#[test]
fn panels_give_way_to_the_picture_and_the_width_of_a_user_counts() {
    for (scale, share) in [(100, 0.45), (125, 0.45), (150, 0.45), (200, 0.36)] {
        let whole = 1280.0 / (f32::from(scale) / 100.0);
        let mut bench = bench(scale);
        let picture = bench.area.rect;
        assert!(picture.width() >= share * whole - 2.0, "{scale} %: {} of {whole}", picture.width());
        // Also when the window becomes smaller while it is open, and the other way round.
        bench.size = vec2(1920.0, 1080.0);
        bench.settle();
        assert!(bench.area.rect.width() >= 0.45 * 1.5 * whole - 2.0);
        bench.size = vec2(1280.0, 720.0);
        bench.settle();
        assert_eq!(bench.area.rect, picture);
        // The edge of the properties is dragged to the left.
        let view = bench.session.view.clone();
        let (from, to) = (pos2(picture.right(), 200.0), pos2(picture.right() - 60.0, 200.0));
        let press = |pos, pressed| Event::PointerButton {
            pos,
            button: PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        };
        bench.frame(vec![Event::PointerMoved(from)]);
        bench.frame(vec![press(from, true)]);
        for k in 1..=6 {
            bench.frame(vec![Event::PointerMoved(from + (to - from) * (k as f32 / 6.0))]);
        }
        bench.frame(Vec::new());
        bench.frame(vec![press(to, false)]);
        bench.settle();
        let most = 0.45 * whole;
        let wanted = (whole - to.x).min(most);
        let right = whole - bench.area.rect.right();
        assert!((right - wanted).abs() < 4.0, "{scale} %: {right}, not {wanted}");
        assert!((bench.session.view.right_width - right).abs() < 4.0, "{scale} %: kept");
        assert_eq!(bench.session.view.left_width, view.left_width, "{scale} %: the other one is as it was");
        assert_eq!(bench.area.rect.left(), picture.left(), "{scale} %: on screen too");
    }
}

#[test]
fn an_override_is_said_at_the_top_however_large_everything_is() {
    for scale in [100, 125, 150, 175] {
        let mut bench = bench(scale);
        bench.apply(Action::AddObject("cube".to_owned()));
        assert!(!bench.says("overrides reflection"));
        bench.apply(Action::Edit(Edit::Object(1, ObjectField::Model(Some("lambert".to_owned())))));
        let hint = bench.tree.iter().find(|s| s.label.contains("“Cube 1” overrides reflection"));
        let hint = hint.unwrap_or_else(|| panic!("no hint at {scale} %")).rect;
        assert!(
            hint.right() <= 1280.0 / bench.ctx.zoom_factor() && hint.width() >= 16.0,
            "{scale} %: {hint:?}"
        );
    }
}

#[test]
fn what_is_switched_in_the_view_menu_stands_in_line() {
    let mut bench = bench(100);
    bench.size.y = 900.0;
    bench.settle();
    bench.click("View");
    let left = |bench: &mut Bench, words: &str| {
        let shapes = bench.shapes();
        let found = shapes.iter().find_map(|shape| match shape {
            Shape::Text(text) if text.galley.text() == words => Some(text.pos.x),
            _ => None,
        });
        found.unwrap_or_else(|| panic!("no {words}"))
    };
    assert_eq!(left(&mut bench, "Presentation"), left(&mut bench, "Full screen"));
    bench.click("Presentation");
    assert!(bench.session.view.presenting && !bench.says("Full screen"), "the menu is gone");
}

#[test]
fn the_description_of_the_scene_is_shown_whole_and_enter_keeps_it() {
    let long = "Left to right: Lambert; wrapped with k_d 0.8; half-Lambert (k_d 0.5, squared); the same without the square.";
    let scene = Scene { description: Some(long.to_owned()), ..Scene::default() };
    let mut bench = Bench::new(Session::new(scene));
    bench.apply(Action::Select(Selection::Room));
    let field = bench.tree.iter().find(|s| s.label == "What the scene shows").expect("a field").rect;
    let shapes = bench.shapes();
    let text = shapes.iter().find_map(|shape| match shape {
        Shape::Text(text) if text.galley.text() == long => Some(text),
        _ => None,
    });
    let text = text.expect("shown");
    assert!(text.galley.rows.len() >= 2 && text.galley.size().x <= field.width(), "{:?}", text.galley.size());
    assert!(text.galley.size().y <= field.height());
    bench.click_at(field.center(), PointerButton::Primary);
    bench.key(Key::A, Modifiers::COMMAND | Modifiers::CTRL);
    bench.frame(vec![Event::Text("Two words".to_owned())]);
    bench.key(Key::Enter, Modifiers::NONE);
    assert_eq!(bench.session.document.description.as_deref(), Some("Two words"));
    assert!(!bench.ctx.text_edit_focused());
}

#[test]
fn the_list_of_keys_has_its_descriptions_in_line_and_clear_of_the_scroll_bar() {
    let mut bench = bench(100);
    bench.apply(Action::View(ViewChange::Keys(true)));
    let labels: Vec<String> = (keys::bindings(&bench.session, &bench.registry).into_iter().map(|b| b.label))
        .chain(keys::ELSEWHERE.iter().map(|(_, _, label)| (*label).to_owned()))
        .collect();
    let mut lefts = BTreeSet::new();
    let mut right: f32 = 0.0;
    let mut bar = f32::INFINITY;
    for shape in bench.shapes() {
        if let Shape::Rect(r) = &shape
            && (3.0..8.0).contains(&r.rect.width())
            && r.rect.height() > 60.0
            && (640.0..1100.0).contains(&r.rect.left())
        {
            bar = bar.min(r.rect.left());
        }
        if let Shape::Text(text) = shape
            && labels.iter().any(|label| label == text.galley.text())
            && text.pos.y > 100.0
            // A key is called as what it does: Delete.
            && (300.0..900.0).contains(&text.pos.x)
        {
            lefts.insert(text.pos.x.round() as i32);
            right = right.max(text.pos.x + text.galley.size().x);
        }
    }
    assert_eq!(lefts.len(), 2, "two columns: {lefts:?}");
    assert!(bar.is_finite() && right <= bar - 4.0, "{right}, and the bar at {bar}");
}
