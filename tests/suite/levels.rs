//! How far an explanation goes: the sentence, the equation, every factor; where numbers come from; what would change the pixel; and
//! two views beside each other.

use bevy_egui::egui::{Event, Key, Modifiers, PointerButton, Shape, accesskit::Role, vec2};
use lights_camera_models::{
    document::Selection,
    panel::{
        explain::explained,
        state::{Action, EXPLAIN_TAB, Session, ViewChange},
    },
    parameter::Value,
    registry::Registry,
    scene::{
        Scene,
        load::{self, Defaults},
    },
};

use crate::{
    panels::{Bench, Seen},
    support::root,
};

/// A window on a scene with a pinned pixel near its middle.
fn explaining(scene: Scene) -> Bench {
    let mut bench = Bench::with_registry(Session::new(scene), Registry::builtin());
    bench.size = vec2(1600.0, 2000.0);
    bench.session.view.bottom_height = 1100.0;
    bench.apply(Action::Select(Selection::Object(0)));
    bench.apply(Action::View(ViewChange::BottomTab(EXPLAIN_TAB.to_owned())));
    bench.settle();
    let middle = bench.area.cells.first().map_or(bench.area.rect, |cell| cell.rect).center();
    bench.hover(middle + vec2(13.0, 7.0));
    bench.letter(Key::E, "e");
    bench.settle();
    assert!(bench.session.view.pinned.is_some());
    bench
}

fn under(model: &str) -> Bench {
    let mut scene = Scene { reflection_model: model.to_owned(), ..Scene::default() };
    scene.shading_model = "phong".to_owned();
    explaining(scene)
}

/// All that is written.
fn texts(bench: &mut Bench) -> String {
    let text = |shape| match shape {
        Shape::Text(text) => Some(text.galley.job.text.clone()),
        _ => None,
    };
    bench.shapes().into_iter().filter_map(text).collect::<Vec<_>>().join("\n")
}

/// The first thing whose name begins so.
fn begins(bench: &Bench, start: &str) -> Option<String> {
    bench.tree.iter().find(|seen| seen.label.starts_with(start)).map(|seen| seen.label.clone())
}

#[test]
fn a_sentence_stands_alone_the_equation_has_numbers_and_every_factor_unfolds() {
    let mut bench = under("metallic_roughness");
    assert!(begins(&bench, "Λ(θ_i) = ").is_none(), "the equation names it, and has its number");
    assert!(begins(&bench, "= π × ").is_some(), "the specular term with numbers");
    bench.click("Level: Sentence");
    bench.settle();
    assert!(begins(&bench, "= π × ").is_none());
    assert!(texts(&mut bench).contains("This pixel is ("));
    bench.click("Level: Every factor");
    bench.settle();
    let factor = begins(&bench, "Λ(θ_i) = ").expect("a row for the half of G");
    assert!(begins(&bench, "Λ(θ_i) over the angle of the light").is_none(), "folded");
    bench.click(&factor);
    bench.settle();
    assert!(begins(&bench, "Λ(θ_i) over the angle of the light to the normal").is_some(), "its plot");
    assert!(texts(&mut bench).contains("Source: "));
    bench.click(&factor);
    bench.settle();
    assert!(begins(&bench, "Λ(θ_i) over the angle of the light").is_none(), "folded again");
}

#[test]
fn a_number_leads_to_its_quantity_and_to_its_knob() {
    let mut bench = under("metallic_roughness");
    bench.click("where D comes from");
    bench.settle();
    assert!(begins(&bench, "D over the angle of the light").is_some(), "the row of D is unfolded");
    bench.click("where α comes from");
    bench.settle();
    assert!(bench.tree.iter().any(|seen| seen.label == "where r comes from"), "α is made of r");
}

#[test]
fn what_would_change_the_pixel_has_knobs_and_says_before_and_after() {
    let mut bench = under("blinn_phong");
    bench.click("What would change this pixel?");
    bench.settle();
    let before = explained(&bench.ctx).expect("explained").explanation.code();
    // The field of the list, not that of the inspector.
    let top = bench.area.rect.bottom();
    let field = |seen: &&Seen| {
        seen.label == "diffuse coefficient" && seen.role == Role::TextInput && seen.rect.top() > top
    };
    let at = bench.tree.iter().find(field).expect("in the list").rect.center();
    bench.click_at(at, PointerButton::Primary);
    bench.key(Key::A, Modifiers::COMMAND | Modifiers::CTRL);
    bench.frame(vec![Event::Text("0.2".to_owned())]);
    bench.settle();
    let registry = Registry::builtin();
    let parameter = registry.model("blinn_phong").and_then(|model| model.parameter("k_d")).expect("there");
    assert_eq!(bench.session.scene().objects[0].material.get(parameter), Value::Number(0.2));
    let after = explained(&bench.ctx).expect("explained").explanation.code();
    assert_ne!(before, after);
    let said = texts(&mut bench);
    for [r, g, b] in [before, after] {
        assert!(said.contains(&format!("{r}, {g}, {b}")), "{said}");
    }
    assert!(said.contains("→ after"), "{said}");
    bench.click("Undo");
    bench.settle();
    assert_eq!(explained(&bench.ctx).expect("explained").explanation.code(), before);
    bench.click("Done");
    bench.settle();
    assert!(!texts(&mut bench).contains("→ after"));
}

#[test]
fn two_views_stand_beside_each_other_with_marks_where_they_differ() {
    let path = root().join("scenes/compare_phong_blinn_phong.json");
    let scene =
        load::file(&path, &Registry::builtin(), Defaults::Refuse).unwrap_or_else(|e| panic!("{e}")).scene;
    let mut bench = explaining(scene);
    assert!(!texts(&mut bench).contains("View B: red"));
    bench.click("Beside B");
    bench.settle();
    let said = texts(&mut bench);
    for expected in ["View A: red", "View B: red", "≠", "≠ marks what differs: "] {
        assert!(said.contains(expected), "{expected}\n{said}");
    }
    bench.click("Beside B");
    bench.settle();
    assert!(!texts(&mut bench).contains("View B: red"));
}
