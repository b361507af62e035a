//! The levels of an explanation: the sentence, the equation, every factor; the origin of numbers; what would
//! change the pixel; and two views side by side.

use bevy_egui::egui::{Key, Pos2, Rect, accesskit::Role, vec2};
use lights_camera_models::{
    document::Selection,
    optics::TermSelection,
    panel::state::{Action, EXPLAIN_TAB, Session, ViewChange},
    registry::Registry,
    scene::{
        Scene,
        load::{self, Defaults},
    },
};

use crate::{
    helpers::support::root,
    window::panels::{Bench, Seen},
};

/// A window with a scene and a pinned pixel near its middle.
fn explaining(scene: Scene) -> Bench {
    explaining_at(scene, |cell| cell.center() + vec2(13.0, 7.0))
}

/// A window with a scene and a pinned pixel at that place of its first view.
fn explaining_at(scene: Scene, place: impl Fn(Rect) -> Pos2) -> Bench {
    let mut bench = Bench::new(Session::new(scene));
    bench.size = vec2(1600.0, 2000.0);
    bench.session.settings.bottom_height = 1100.0;
    bench.apply(Action::Select(Selection::Object(0)));
    bench.apply(Action::View(ViewChange::BottomTab(EXPLAIN_TAB.to_owned())));
    bench.settle();
    bench.hover(place(bench.area.cells.first().map_or(bench.area.rect, |cell| cell.rect)));
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

/// All painted text.
fn texts(bench: &mut Bench) -> String {
    bench.texts().join("\n")
}

/// The first widget whose name begins with this text.
fn begins(bench: &Bench, start: &str) -> Option<String> {
    bench.tree.iter().find(|seen| seen.label.starts_with(start)).map(|seen| seen.label.clone())
}

#[test]
fn nothing_in_the_line_above_the_sentence_lies_over_something_else() {
    let file = root().join("scenes/compare_phong_blinn_phong.json");
    let scene = load::file(&file, &Registry::builtin(), Defaults::Refuse).expect("legal").scene;
    for (width, scale, shown, lines) in
        [(1600.0, 100, "of ", 1), (1280.0, 150, "view A", 1), (1100.0, 150, "of ", 2), (1280.0, 200, "", 2)]
    {
        let mut bench = explaining(scene.clone());
        bench.size = vec2(width, 1400.0);
        bench.apply(Action::View(ViewChange::Scale(scale)));
        let field = bench.field("column of the pixel").rect;
        let copy = bench.find("Copy").expect("a button").rect;
        let rows = field.top().min(copy.top()) - 4.0..copy.bottom() + 4.0;
        let case = format!("{width} points at {scale} %: {field:?} {copy:?}");
        assert_eq!(if copy.top() > field.bottom() { 2 } else { 1 }, lines, "{case}");
        let mut texts = bench.texts_in_sight();
        texts.retain(|(_, place)| rows.contains(&place.top()));
        for known in ["Pixel", "Copy", "Pin", "Beside B", "Equation"] {
            assert!(texts.iter().any(|(text, _)| text == known), "{case}: {known} of {texts:?}");
        }
        assert!(texts.iter().any(|(text, _)| text.starts_with(shown)), "{case}: {texts:?}");
        for (i, (a, here)) in texts.iter().enumerate() {
            let over = texts[..i].iter().find(|(_, there)| here.shrink(1.0).intersects(*there));
            assert!(over.is_none(), "{case}: “{a}” lies over {over:?}");
        }
    }
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
fn a_term_that_is_not_shown_is_not_listed() {
    let mut bench = under("metallic_roughness");
    let factor = "Λ(θ_i) = ";
    bench.click("Level: Every factor");
    bench.settle();
    assert!(begins(&bench, "= π × ").is_some() && begins(&bench, factor).is_some());
    bench.apply(Action::View(ViewChange::Terms(TermSelection::Diffuse)));
    bench.settle();
    assert!(begins(&bench, "= π × ").is_none(), "the specular term does not count");
    assert!(begins(&bench, factor).is_none(), "nor does what it alone needs");
    bench.apply(Action::View(ViewChange::Terms(TermSelection::Specular)));
    bench.settle();
    assert!(begins(&bench, "= π × ").is_some() && begins(&bench, factor).is_some());
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
fn what_would_change_the_pixel_is_a_list_of_knobs() {
    let mut bench = under("blinn_phong");
    bench.click("What would change this pixel?");
    bench.settle();
    // The field of the list, next to that of the inspector.
    let top = bench.area.rect.bottom();
    let field = |seen: &&Seen| {
        seen.label == "diffuse coefficient" && seen.role == Role::TextInput && seen.rect.top() > top
    };
    assert!(bench.tree.iter().any(|seen| field(&seen)), "the diffuse coefficient is in the list");
    let said = texts(&mut bench);
    assert!(said.contains("Change of luminance for 1 % of the range, by differences."), "{said}");
    bench.click("What would change this pixel?");
    bench.settle();
    assert!(!bench.tree.iter().any(|seen| field(&seen)), "folded again");
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

#[test]
fn views_of_background_beside_each_other_say_that_neither_shows_an_object() {
    let path = root().join("scenes/compare_gouraud_phong.json");
    let scene =
        load::file(&path, &Registry::builtin(), Defaults::Refuse).unwrap_or_else(|e| panic!("{e}")).scene;
    let mut bench = explaining_at(scene, |cell| cell.left_center() + vec2(12.0, 0.0));
    bench.click("Beside B");
    bench.settle();
    let said = texts(&mut bench);
    assert!(said.contains("the background shows"), "not the background: {said}");
    assert!(said.contains("Neither view shows an object here."), "{said}");
    assert!(!said.contains("Only one of the views"), "{said}");
    assert!(bench.texts().iter().filter(|text| *text == "background").count() >= 2, "{said}");
}
