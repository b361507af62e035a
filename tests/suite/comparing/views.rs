//! The window with several views of one scene.

use std::{
    fs, thread,
    time::{Duration, Instant},
};

use bevy_egui::egui::{Event, Key, Modifiers, PointerButton, Rect, Shape, Vec2, accesskit::Role, vec2};
use lights_camera_models::{
    caption::header,
    channel::DebugChannel,
    compare::{Pair, Shown, fitting_amplification},
    document::{Edit, Selection},
    optics::TermSelection,
    panel::marks::Lens,
    panel::picture::letters_of_map,
    panel::state::{
        Action, Clipping, CompareCommand, Converging, LessonCommand, LessonSource, Numbers, SCALES, Session,
        ViewChange,
    },
    parameter::{Value, Values},
    registry::Registry,
    scene::{
        Comparison, Part, Scene, Variant,
        comparison::{Compared, Layout},
        examples::EXAMPLES,
    },
};

use crate::{
    helpers::screen::{Picture, Screen},
    window::panels::{Bench, Seen},
};

/// A red sphere that view B shows in blue.
fn scene(layout: &str, more: &str) -> String {
    format!(
        r#"{{
  "scene_size": {{ "height": 10, "width": 10, "depth": 10 }},
  "reflection_model": "lambert",
  "shading_model": "phong",
  "lights": [{{ "type": "ambient", "intensity": 1 }}],
  "observer": {{ "position": [5, 5, 9.5], "direction": [0, 0, -1] }},
  "objects": [{{ "type": "sphere", "position": [5, 5, 5], "size": 3, "material": {{ "base_colour": [255, 0, 0] }} }}],
  "variants": [{{ "name": "in blue", "material": {{ "base_colour": [0, 0, 255] }} }}],
  "comparison": {{ "layout": "{layout}"{more} }}
}}"#
    )
}

const RED: fn([u8; 3]) -> bool = |p| p[0] > 200 && p[1] < 30 && p[2] < 30;
const BLUE: fn([u8; 3]) -> bool = |p| p[2] > 200 && p[1] < 30 && p[0] < 30;

#[test]
fn a_window_shows_the_views_of_a_scene_in_every_layout() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("room.json");
    fs::write(&file, scene("side_by_side", "")).expect("written");
    let screen = Screen::new(1280, 720);
    let mut window = screen.start(&["view", &file.to_string_lossy(), "--size", "1280x720"]);
    // Between the panels, the picture spans 208 to 936.
    let (left, right) = (210..570, 574..934);
    let count = |picture: &Picture, x: &std::ops::Range<u32>, is: fn([u8; 3]) -> bool| {
        picture.count(x.clone(), 70..640, is)
    };
    window.until("both views", |p| count(p, &left, RED) > 3000 && count(p, &right, BLUE) > 3000);
    // The screen may be captured while it shows half of a new picture.
    let picture = window.rest();
    assert_eq!((count(&picture, &left, BLUE), count(&picture, &right, RED)), (0, 0));

    fs::write(&file, scene("wipe", "")).expect("written");
    let halves = |p: &Picture| count(p, &left, RED) > 10_000 && count(p, &right, BLUE) > 10_000;
    window.until("the halves of one sphere", halves);
    let half = count(&window.rest(), &(210..934), BLUE);
    fs::write(&file, scene("wipe", ", \"split\": 0.4")).expect("written");
    window.until("more of the other view", |p| count(p, &(210..934), BLUE) > half + half / 8);
    fs::write(&file, scene("wipe", ", \"edge\": \"horizontal\"")).expect("written");
    window.until("one above the other", |p| {
        let (top, bottom) = (70..330, 370..610);
        p.count(210..934, top.clone(), RED) > 8000
            && p.count(210..934, bottom.clone(), BLUE) > 8000
            && p.count(210..934, top, BLUE) + p.count(210..934, bottom, RED) == 0
    });

    // Viridis: nothing is dark violet, the rest is yellow.
    fs::write(&file, scene("difference", "")).expect("written");
    let none = |p: [u8; 3]| p[0].abs_diff(68) < 4 && p[1] < 5 && p[2].abs_diff(84) < 4;
    let most = |p: [u8; 3]| p[0] > 240 && p[1] > 220 && p[2] < 60;
    window.until("the map of the difference", |p| {
        count(p, &(210..934), none) > 100_000 && count(p, &(210..934), most) > 10_000
    });

    fs::write(&file, scene("single", "")).expect("written");
    let picture = window.until("view A alone", |p| count(p, &(210..934), RED) > 20_000);
    assert_eq!(count(&picture, &(210..934), BLUE), 0);
    assert_eq!(window.said(), "");
}

const CTRL: Modifiers = Modifiers { ctrl: true, command: true, ..Modifiers::NONE };

fn bench() -> Bench {
    let mut bench = Bench::new(Session::default());
    bench.size = vec2(1280.0, 720.0);
    bench.settle();
    bench
}

/// The position of the widget that a screen reader calls by this name.
fn place(bench: &Bench, label: &str) -> Rect {
    let seen = bench.tree.iter().find(|seen| seen.label.contains(label));
    seen.unwrap_or_else(|| panic!("“{label}” is not shown")).rect
}

fn click(bench: &mut Bench, label: &str) {
    let at = place(bench, label).center();
    bench.click_at(at, PointerButton::Primary);
    bench.settle();
}

#[test]
fn a_second_view_is_added_changed_and_taken_back_by_hand() {
    let mut bench = bench();
    bench.key(Key::B, CTRL);
    bench.settle();
    assert_eq!(bench.session.document.comparison.layout, Layout::SideBySide);
    assert_eq!(bench.session.active(), 1);
    // The shading at the top is that of view B.
    bench.key(Key::P, Modifiers::NONE);
    bench.settle();
    assert_eq!(bench.session.document.shading_model, "gouraud");
    assert_eq!(bench.session.variant().and_then(|v| v.shading_model.clone()).as_deref(), Some("phong"));
    place(&bench, "shading model  Phong");
    click(&mut bench, "shading model: back to A");
    assert_eq!(bench.session.variant(), Some(&Variant::default()));
    click(&mut bench, "View A");
    assert_eq!(bench.session.active(), 0);
    bench.key(Key::K, CTRL);
    bench.settle();
    assert_eq!(bench.session.active(), 1);
    // Pressing a shading model's key in view A changes the scene.
    click(&mut bench, "View A");
    bench.key(Key::F, Modifiers::NONE);
    bench.settle();
    assert_eq!(bench.session.document.shading_model, "flat");
}

#[test]
fn the_edge_of_a_wipe_is_dragged_and_moved_by_keys_and_each_drag_is_one_step() {
    let mut bench = bench();
    bench.apply(Action::Compare(CompareCommand::Layout(Layout::Wipe)));
    bench.settle();
    let steps = bench.session.document.done();
    let edge = place(&bench, "Edge between the views");
    let (from, to) = (edge.center(), edge.center() + vec2(-100.0, 0.0));
    let button = |pos, pressed| Event::PointerButton {
        pos,
        button: PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    };
    bench.frame(vec![Event::PointerMoved(from)]);
    bench.frame(vec![button(from, true)]);
    for i in 1..=5 {
        bench.frame(vec![Event::PointerMoved(from.lerp(to, i as f32 / 5.0))]);
    }
    bench.frame(vec![button(to, false)]);
    bench.settle();
    let split = bench.session.document.comparison.split;
    assert!((0.3..0.42).contains(&split), "{split}");
    assert_eq!(bench.session.document.done(), steps + 1);
    bench.key(Key::Period, Modifiers::NONE);
    bench.settle();
    assert!((bench.session.document.comparison.split - split - 0.02).abs() < 1e-3);
    // The picture and its other view have the same size as before, so neither is drawn again.
    let size = |bench: &Bench| bench.area.cells.iter().map(|cell| cell.rect.size()).collect::<Vec<_>>();
    let before = size(&bench);
    assert_eq!(before.len(), 2);
    bench.key(Key::Comma, Modifiers::NONE);
    bench.settle();
    assert_eq!(size(&bench), before);
    bench.apply(Action::Undo);
    bench.apply(Action::Undo);
    bench.apply(Action::Undo);
    assert_eq!(bench.session.document.comparison.split, 0.5);
}

#[test]
fn views_have_one_size_in_every_layout_and_stay_within_the_picture() {
    for size in [vec2(1280.0, 720.0), vec2(1920.0, 1080.0), vec2(1000.0, 560.0)] {
        for views in 1..4 {
            for layout in Layout::ALL {
                let mut bench = bench();
                bench.size = size;
                for _ in 0..views {
                    bench.apply(Action::Compare(CompareCommand::Add));
                }
                bench.apply(Action::Compare(CompareCommand::Layout(*layout)));
                bench.settle();
                bench.settle();
                let cells = &bench.area.cells;
                let expected = match layout {
                    Layout::Single => 1,
                    Layout::SideBySide => views + 1,
                    _ => 2,
                };
                assert_eq!(cells.len(), expected, "{layout:?}");
                for cell in cells {
                    let (a, b) = (cell.rect.size(), cells[0].rect.size());
                    assert!((a - b).abs().max_elem() < 0.01, "{layout:?}: {a:?} and {b:?}");
                    assert!(a.min_elem() > 80.0, "{layout:?} at {size:?}: {a:?}");
                    assert!(bench.area.rect.contains_rect(cell.rect), "{layout:?}");
                    assert!(cell.part.is_negative() || cell.rect.contains_rect(cell.part), "{layout:?}");
                }
                if *layout == Layout::SideBySide {
                    for (i, a) in cells.iter().enumerate() {
                        assert!(cells[..i].iter().all(|b| !a.rect.shrink(0.1).intersects(b.rect)));
                    }
                }
            }
        }
    }
}

#[test]
fn a_view_gets_a_name_and_one_that_others_are_based_on_keeps_it() {
    let mut bench = bench();
    bench.key(Key::B, CTRL);
    bench.settle();
    bench.type_into("Name of view B", "sharp");
    bench.key(Key::Enter, Modifiers::NONE);
    bench.settle();
    assert_eq!(bench.session.variant().and_then(|v| v.name.as_deref()), Some("sharp"));
    bench.apply(Action::Edit(Edit::set(Part::Variant(0), Variant::name, "soft")));
    let mut scene = (*bench.session.document).clone();
    scene.variants.push(Variant { based_on: Some("soft".to_owned()), ..Variant::default() });
    let mut bench = Bench::new(Session::new(scene));
    bench.apply(Action::Edit(Edit::set(Part::Variant(0), Variant::name, "hard")));
    assert_eq!(bench.session.document.variants[1].based_on.as_deref(), Some("hard"));
    bench.apply(Action::Edit(Edit::set(Part::Variant(0), Variant::name, String::new())));
    assert_eq!(bench.session.document.variants[0].name.as_deref(), Some("hard"));
    assert!(bench.says("based on this one by name"));
}

/// A scene with three variants, of which the last is based on the first.
fn three() -> Bench {
    let colour = |rgb| Values([("base_colour".into(), Value::Colour(rgb))].into());
    let mut scene = Scene { reflection_model: "phong".to_owned(), ..Scene::default() };
    scene.variants = vec![
        Variant {
            name: Some("b".to_owned()),
            reflection_model: Some("lambert".to_owned()),
            material: colour([0, 0, 255]),
            ..Variant::default()
        },
        Variant { exposure: Some(1.0), ..Variant::default() },
        Variant { based_on: Some("b".to_owned()), exposure: Some(2.0), ..Variant::default() },
    ];
    scene.comparison = Comparison { layout: Layout::SideBySide, with: 2, ..Comparison::default() };
    Bench::new(Session::new(scene))
}

/// The contents of a view, without names.
fn seen(bench: &Bench, view: usize) -> (String, String, String) {
    let (scene, _) = bench.session.document.seen(view, &bench.registry).expect("there is such a view");
    let object = &scene.objects[0];
    let colour = bench.registry.material_parameter("base_colour").expect("there is one");
    let model = scene.model_of(object).to_owned();
    (model, format!("{:?}", object.material.get(colour)), format!("{:?}", scene.display))
}

#[test]
fn views_are_swapped_and_the_others_stay_as_they_are() {
    let mut bench = three();
    let before: Vec<_> = (0..4).map(|view| seen(&bench, view)).collect();
    bench.apply(Action::Compare(CompareCommand::Swap(1)));
    let after: Vec<_> = (0..4).map(|view| seen(&bench, view)).collect();
    assert_eq!([&after[0], &after[1]], [&before[1], &before[0]]);
    assert_eq!(after[2..], before[2..]);
    bench.apply(Action::Undo);
    assert_eq!((0..4).map(|view| seen(&bench, view)).collect::<Vec<_>>(), before);
    // Terms are not part of the scene that would become view A.
    bench.apply(Action::Edit(Edit::set(Part::Variant(0), Variant::terms, TermSelection::Specular)));
    bench.apply(Action::Compare(CompareCommand::Swap(1)));
    assert!(bench.says("its own choice of terms"));
    assert_eq!(seen(&bench, 0), before[0]);
}

#[test]
fn the_compared_view_stays_the_same_when_one_before_it_goes() {
    let mut bench = three();
    let with = bench.session.document.comparison.with;
    let before = seen(&bench, with);
    bench.apply(Action::Compare(CompareCommand::Activate(0)));
    bench.apply(Action::Compare(CompareCommand::Remove(1)));
    assert_eq!(bench.session.document.comparison.with, with - 1);
    assert_eq!(seen(&bench, with - 1), before);
}

#[test]
fn a_scene_is_saved_with_the_view_that_was_compared() {
    let mut bench = three();
    bench.apply(Action::Compare(CompareCommand::Activate(3)));
    assert_eq!((bench.session.compared_with(), bench.session.document.comparison.with), (3, 2));
    assert!(!bench.session.is_dirty(), "looking at another view changes no scene");
    let steps = bench.session.document.steps().len();
    bench.session.settle_comparison();
    assert_eq!(bench.session.document.comparison.with, 3);
    assert_eq!(bench.session.document.steps().len(), steps);
}

#[test]
fn a_presentation_of_views_has_equation_and_caption_and_no_handles() {
    let mut bench = three();
    bench.size = vec2(1280.0, 720.0);
    bench.settle();
    assert!(bench.says("Handle: "));
    bench.apply(Action::View(ViewChange::Presenting(true)));
    bench.settle();
    assert!(!bench.says("Handle: ") && !bench.says("Menu of view"));
    let written: Vec<_> =
        crate::window::layout::texts(&mut bench).into_iter().map(|(text, _)| text).collect();
    let written = written.join(" ");
    assert!(written.contains("A:") && written.contains("Phong"), "{written}");
}

#[test]
fn the_legend_of_a_map_is_as_large_as_other_text() {
    let mut bench = three();
    bench.size = vec2(1280.0, 720.0);
    bench.apply(Action::Compare(CompareCommand::Layout(Layout::Difference)));
    for scale in [100, 150, 200] {
        bench.apply(Action::View(ViewChange::Scale(scale)));
        let zoom = bench.area.zoom;
        let height = zoom * bench.area.map.expect("there is a map").height();
        let letters = letters_of_map(&bench.area, height).expect("a legend");
        assert!((letters - 11.5 * zoom).abs() < 0.1, "{scale} %: {letters}");
    }
    bench.apply(Action::View(ViewChange::Presenting(true)));
    let height = bench.area.zoom * bench.area.map.expect("there is a map").height();
    let letters = letters_of_map(&bench.area, height).expect("a legend");
    // The map is only a part of the screen, and its legend is read from afar as well.
    assert!(letters > 0.03 * 720.0, "{letters} of 720, in a map of {height}");
}

#[test]
fn the_amplification_is_fitted_to_the_largest_difference() {
    for (largest, expected) in [(255.0, 1.0), (128.0, 1.0), (100.0, 2.0), (12.0, 20.0), (0.5, 100.0)] {
        assert_eq!(fitting_amplification(Compared::Codes, largest), expected, "{largest}");
    }
    assert_eq!(fitting_amplification(Compared::Light, 0.1), 10.0);
    let mut bench = three();
    bench.size = vec2(1280.0, 720.0);
    bench.apply(Action::Compare(CompareCommand::Layout(Layout::Difference)));
    bench.session.facts.comparison = Some(Numbers { largest: Some(12.0), ..Numbers::default() });
    bench.settle();
    assert_eq!(bench.session.document.comparison.amplification, None, "nobody had to ask for it");
    let said =
        |bench: &mut Bench| crate::window::layout::texts(bench).into_iter().any(|(text, _)| text == "20");
    assert!(said(&mut bench), "it says the factor");
    click(&mut bench, "Amplify automatically");
    assert_eq!(bench.session.document.comparison.amplification, Some(20.0), "it stays from now on");
    bench.session.facts.comparison = Some(Numbers { largest: Some(100.0), ..Numbers::default() });
    bench.settle();
    assert!(said(&mut bench));
    click(&mut bench, "Amplify automatically");
    assert!(!said(&mut bench));
}

#[test]
fn the_amplification_of_equal_views_is_that_of_their_map() {
    let mut bench = three();
    bench.size = vec2(1280.0, 720.0);
    bench.apply(Action::Compare(CompareCommand::Layout(Layout::Difference)));
    bench.settle();
    let said = |bench: &mut Bench| {
        crate::window::layout::texts(bench).into_iter().filter(|(text, _)| text == "100").count()
    };
    let before = said(&mut bench);
    // Nothing is known yet.
    click(&mut bench, "Amplify automatically");
    assert_eq!(bench.session.document.comparison.amplification, None, "there is none to keep");
    // Two equal pictures have no largest difference.
    let grey = Shown::of_codes(2, 1, vec![50; 6]).expect("as many as pixels");
    let differences = Pair::new(&grey, &grey).expect("of one size").differences(&Comparison::default());
    let of_map = differences.expect("codes are known").amplification(&Comparison::default());
    bench.session.facts.comparison = Some(Numbers::default());
    bench.settle();
    assert_eq!((of_map, said(&mut bench)), (100.0, before + 1), "it says the factor of the map");
    click(&mut bench, "Amplify automatically");
    assert_eq!(bench.session.document.comparison.amplification, Some(of_map));
}

#[test]
fn each_view_has_its_badges_in_every_layout() {
    let clipped = |share: u32| Clipping::new(vec![share; Clipping::GRID[0] * Clipping::GRID[1]]);
    for (layout, signs) in [
        (Layout::Single, "B"),
        (Layout::SideBySide, "AB"),
        (Layout::Wipe, "AB"),
        (Layout::Difference, "AB"),
        (Layout::Blink, "A"),
    ] {
        let mut bench = bench();
        bench.apply(Action::Compare(CompareCommand::Add));
        bench.apply(Action::Compare(CompareCommand::Layout(layout)));
        let terms = Edit::set(Part::Variant(0), Variant::terms, TermSelection::Diffuse);
        bench.apply(Action::Edit(terms));
        bench.session.facts.clipping = [clipped(2), clipped(20), None, None];
        bench.settle();
        let is_sign = |s: &&Seen| s.label.contains(" · Clipped: ");
        let mut all: Vec<_> = bench.tree.iter().filter(is_sign).cloned().collect();
        all.sort_by_key(|sign| sign.label.clone());
        let letters: String = all.iter().filter_map(|s| s.label.chars().next()).collect();
        assert_eq!(letters, signs, "{layout:?}");
        assert_eq!(bench.says("B · Only the diffuse term"), signs.contains('B'), "{layout:?}");
        for (i, sign) in all.iter().enumerate() {
            let cell = bench.area.cells.iter().find(|c| sign.label.starts_with(["A", "B"][c.view]));
            assert!(cell.is_some_and(|c| c.rect.contains_rect(sign.rect)), "{layout:?}: {sign:?}");
            assert!(all[..i].iter().all(|other| !other.rect.intersects(sign.rect)), "{layout:?}");
        }
        let share = |letter: &str| all.iter().find(|s| s.label.starts_with(letter)).map(|s| s.label.clone());
        if signs == "AB" {
            let [a, b] = ["A", "B"].map(|l| share(l).unwrap()[4..].to_owned());
            assert_ne!(a, b, "each counts its own view");
        }
    }
    // A click on another view's badge applies to that view.
    let mut bench = bench();
    bench.apply(Action::Compare(CompareCommand::Add));
    bench.apply(Action::Edit(Edit::set(Part::Variant(0), Variant::terms, TermSelection::Diffuse)));
    bench.apply(Action::Compare(CompareCommand::Activate(0)));
    bench.settle();
    click(&mut bench, "B · Only the diffuse term");
    assert_eq!((bench.session.active(), bench.session.terms_of(1)), (1, TermSelection::All));
}

#[test]
fn the_list_of_a_view_has_the_digits_of_its_heading() {
    let mut bench = bench();
    bench.apply(Action::Edit(Edit::set(Part::Scene, Scene::reflection_model, "metallic_roughness")));
    bench.key(Key::B, CTRL);
    let roughness = Value::Number(0.424_264_07);
    bench.apply(Action::Edit(Edit::material(Part::Variant(0), "roughness", roughness)));
    bench.apply(Action::Compare(CompareCommand::Activate(1)));
    bench.settle();
    let texts = crate::window::layout::texts(&mut bench);
    assert!(texts.iter().any(|(text, _)| text == "roughness  0.4243"), "{texts:?}");
}

#[test]
fn badges_take_one_line_where_there_is_little_room() {
    let heights = |size: Vec2| {
        let mut bench = bench();
        bench.size = size;
        bench.apply(Action::Compare(CompareCommand::Add));
        bench.apply(Action::Compare(CompareCommand::Layout(Layout::SideBySide)));
        let clipped = |share: u32| Clipping::new(vec![share; Clipping::GRID[0] * Clipping::GRID[1]]);
        bench.session.facts.clipping = [clipped(2), clipped(20), None, None];
        bench.settle();
        // Read out, it is whole.
        let sign = |letter: &str| {
            let is_it = |s: &&Seen| {
                s.label.starts_with(&format!("{letter} · Clipped: ")) && s.label.ends_with(" of the picture")
            };
            bench.tree.iter().find(is_it).map_or_else(|| panic!("no {letter}"), |s| s.rect)
        };
        let cells: Vec<_> = bench.area.cells.iter().map(|c| c.rect).collect();
        let signs = ["A", "B"].map(sign);
        assert!(signs.iter().zip(&cells).all(|(sign, cell)| cell.contains_rect(*sign)), "{signs:?}");
        signs.map(|sign| sign.height())
    };
    let wide = heights(vec2(1600.0, 900.0));
    // A small window, and one of 1280 by 720 at 150 %.
    for size in [vec2(960.0, 600.0), vec2(853.0, 480.0)] {
        let low = heights(size);
        assert!(low.iter().zip(&wide).all(|(a, b)| (a - b).abs() < 1.0), "{size:?}: {low:?} and {wide:?}");
    }
}

#[test]
fn badges_cover_at_most_a_quarter_of_a_small_picture() {
    let clipped = |share: u32| Clipping::new(vec![share; Clipping::GRID[0] * Clipping::GRID[1]]);
    let (mut tested, mut clicked) = (0, 0);
    for (layout, scale) in
        [Layout::Wipe, Layout::SideBySide].into_iter().flat_map(|l| [100, 125, 150].map(|s| (l, s)))
    {
        let here = format!("{layout:?} at {scale} %");
        let mut bench = bench();
        bench.size = vec2(640.0, 360.0);
        bench.apply(Action::View(ViewChange::Scale(scale)));
        bench.apply(Action::Compare(CompareCommand::Add));
        bench.apply(Action::Compare(CompareCommand::Layout(layout)));
        bench.apply(Action::Edit(Edit::set(Part::Variant(0), Variant::terms, TermSelection::Diffuse)));
        bench.session.facts.clipping = [clipped(2), clipped(20), None, None];
        bench.settle();
        let mut badges = bench.tree.clone();
        badges.retain(|s| ["A · ", "B · "].iter().any(|letter| s.label.starts_with(letter)));
        let all: Vec<_> = badges.iter().map(|s| s.label.as_str()).collect();
        // Read out, nothing is missing.
        for words in ["A · Clipped: ", "B · Clipped: ", "B · Only the diffuse term"] {
            assert!(all.iter().any(|label| label.contains(words)), "{here}: {words} of {all:?}");
        }
        let covered: f32 = badges.iter().map(|s| s.rect.area()).sum();
        let cells = &bench.area.cells;
        let picture: f32 = match layout {
            Layout::Wipe => cells[0].rect.area(),
            _ => cells.iter().map(|cell| cell.rect.area()).sum(),
        };
        // In less, the sign and a word take more.
        if picture > 24_000.0 {
            tested += 1;
            assert!(covered <= 0.25 * picture + 1.0, "{here}: {covered} of {picture}");
        }
        assert!(badges.len() == 3 || all.iter().any(|label| label.contains("; ")), "{here}: {all:?}");
        // The one of several does what the first of them does.
        if let Some(one) = badges.iter().find(|s| s.label.starts_with("B · ") && s.label.contains("; ")) {
            bench.click_at(one.rect.center(), PointerButton::Primary);
            assert_eq!(bench.session.terms_of(1), TermSelection::All, "{here}");
            clicked += 1;
        }
    }
    assert!(tested > 0 && clicked > 0, "{tested} pictures, {clicked} clicks");
}

#[test]
fn badges_cover_little_of_the_objects_in_views_over_each_other() {
    let clipped = |share: u32| Clipping::new(vec![share; Clipping::GRID[0] * Clipping::GRID[1]]);
    for layout in [Layout::Wipe, Layout::Difference] {
        let mut bench = shipped("compare_phong_blinn_phong.json");
        bench.apply(Action::View(ViewChange::Scale(150)));
        bench.apply(Action::Compare(CompareCommand::Layout(layout)));
        bench.apply(Action::Compare(CompareCommand::Activate(0)));
        bench.apply(Action::View(ViewChange::Terms(TermSelection::Diffuse)));
        bench.session.facts.clipping = [clipped(20), clipped(50), None, None];
        bench.settle();
        let badges: Vec<_> = (bench.tree.iter())
            .filter(|s| ["A · ", "B · "].iter().any(|letter| s.label.starts_with(letter)))
            .map(|s| s.rect)
            .collect();
        assert!(badges.len() > 1, "{layout:?}");
        let lens = Lens::of(&bench.session, bench.area.cells[0].rect);
        let ball = &bench.session.document.objects[0];
        let right = bench.session.facts.camera * glam::Vec3::X;
        let at = lens.project(ball.position).expect("before the camera");
        let radius = lens.project(ball.position + 0.5 * ball.size * right).expect("as well").distance(at);
        let steps = (-20i16..=20).flat_map(|x| (-20i16..=20).map(move |y| vec2(x.into(), y.into()) / 20.0));
        let inside: Vec<_> =
            steps.filter(|step| step.length() < 1.0).map(|step| at + radius * step).collect();
        let covered = inside.iter().filter(|p| badges.iter().any(|badge| badge.contains(**p))).count();
        let share = covered as f32 / inside.len() as f32;
        assert!(share < 0.12, "{layout:?}: {share}: {badges:?}");
    }
}

#[test]
fn a_header_says_the_terms_that_differ_where_there_is_no_room_for_all() {
    let mut bench = shipped("compare_phong_blinn_phong.json");
    bench.apply(Action::Compare(CompareCommand::Activate(1)));
    bench.apply(Action::View(ViewChange::Terms(TermSelection::Diffuse)));
    bench.apply(Action::Expose(3.0));
    bench.settle();
    let texts = bench.texts();
    for words in ["diffuse term alone", "all terms"] {
        assert!(texts.iter().any(|text| text == words), "{words} of {texts:?}");
    }
}

#[test]
fn a_view_differs_only_in_what_differs_now() {
    let mut bench = bench();
    bench.key(Key::B, CTRL);
    bench.apply(Action::Edit(Edit::set(Part::Scene, Scene::reflection_model, "phong")));
    bench.apply(Action::Expose(1.0));
    bench.settle();
    let texts = |bench: &mut Bench| -> Vec<_> {
        crate::window::layout::texts(bench).into_iter().map(|(text, _)| text).collect()
    };
    assert!(!texts(&mut bench).contains(&"also set in B, to what A has now".to_owned()));
    bench.apply(Action::Compare(CompareCommand::Activate(0)));
    bench.apply(Action::Edit(Edit::set(Part::Scene, Scene::reflection_model, "phong")));
    bench.apply(Action::Compare(CompareCommand::Activate(1)));
    bench.settle();
    let said = texts(&mut bench);
    let at = |text: &str| said.iter().position(|t| t == text).unwrap_or_else(|| panic!("{text}: {said:?}"));
    assert!(at("differs from A in") < at("exposure  1 EV"));
    assert!(at("exposure  1 EV") < at("also set in B, to what A has now"));
    assert!(at("also set in B, to what A has now") < at("reflection model  Phong"));
    // Both are undone as before.
    click(&mut bench, "exposure: back to A");
    assert!(texts(&mut bench).contains(&"as A".to_owned()));
    click(&mut bench, "reflection model: back to A");
    assert_eq!(bench.session.variant(), Some(&Variant::default()));
}

#[test]
fn a_channel_is_not_compared_with_a_picture() {
    let mut bench = bench();
    bench.key(Key::B, CTRL);
    let numbers = vec![["RMSE", "0.031", "help"].map(str::to_owned)];
    bench.session.facts.comparison = Some(Numbers { all: numbers, ..Numbers::default() });
    bench.settle();
    assert!(bench.says("RMSE 0.031"));
    let why = "Not compared: A shows the picture, B shows N·V.";
    for layout in [Layout::SideBySide, Layout::Wipe, Layout::Difference] {
        bench.apply(Action::Compare(CompareCommand::Layout(layout)));
        bench.apply(Action::View(ViewChange::Channel(Some(DebugChannel::NDotV))));
        bench.settle();
        assert!(bench.says(why) && !bench.says("RMSE"), "{layout:?}");
    }
    let written = crate::window::layout::texts(&mut bench).iter().filter(|(text, _)| text == why).count();
    assert_eq!(written, 1, "in the place of the map, and not in the bar too");
    // A channel is compared with itself.
    bench.apply(Action::Compare(CompareCommand::Activate(0)));
    bench.apply(Action::View(ViewChange::Channel(Some(DebugChannel::NDotV))));
    bench.settle();
    assert!(bench.says("RMSE 0.031"));
}

#[test]
fn a_header_says_that_its_picture_is_behind_and_nothing_is_compared_meanwhile() {
    let mut bench = bench();
    bench.key(Key::B, CTRL);
    bench.apply(Action::Edit(Edit::set(Part::Scene, Scene::reflection_model, "openpbr")));
    let numbers = vec![["RMSE", "0.000", "help"].map(str::to_owned)];
    bench.session.facts.comparison = Some(Numbers { all: numbers, ..Numbers::default() });
    let texts = |bench: &mut Bench| {
        crate::window::layout::texts(bench).into_iter().map(|(text, _)| text).collect::<Vec<_>>()
    };
    for layout in [Layout::SideBySide, Layout::Wipe, Layout::Difference] {
        bench.apply(Action::Compare(CompareCommand::Layout(layout)));
        bench.session.facts.compiling[1] = true;
        bench.settle();
        assert!(bench.says("View B: compiling… · OpenPBR"), "{layout:?}");
        assert!(!bench.says("View A: compiling…") && !bench.says("RMSE"), "{layout:?}");
        assert!(bench.says("Measuring the difference…"), "{layout:?}");
        assert_eq!(texts(&mut bench).contains(&"Shown: A".to_owned()), layout.is_map(), "{layout:?}");
        bench.apply(Action::View(ViewChange::Presenting(true)));
        let said = texts(&mut bench);
        assert!(said.iter().any(|text| text == "compiling…"), "{layout:?}: {said:?}");
        assert!(!said.iter().any(|text| text.contains("RMSE")), "{layout:?}: {said:?}");
        bench.apply(Action::View(ViewChange::Presenting(false)));
        bench.session.facts.compiling[1] = false;
        bench.settle();
        assert!(bench.says("RMSE 0.000") && !bench.says("compiling…"), "{layout:?}");
    }
    bench.apply(Action::Compare(CompareCommand::Layout(Layout::Single)));
    bench.session.facts.compiling[1] = true;
    bench.settle();
    assert!(bench.says("View B: compiling… · OpenPBR"));
}

#[test]
fn a_difference_has_no_legend_of_dots_that_are_not_drawn_in_it() {
    for presenting in [false, true] {
        let mut bench = bench();
        bench.key(Key::B, CTRL);
        let channel = |bench: &mut Bench, channel: DebugChannel| {
            for view in [1, 0] {
                bench.apply(Action::Compare(CompareCommand::Activate(view)));
                bench.apply(Action::View(ViewChange::Channel(Some(channel))));
            }
        };
        channel(&mut bench, DebugChannel::Vertices);
        bench.apply(Action::View(ViewChange::Presenting(presenting)));
        for layout in [Layout::SideBySide, Layout::Difference] {
            bench.apply(Action::Compare(CompareCommand::Layout(layout)));
            bench.session.facts.comparison = Some(Numbers::default());
            bench.settle();
            assert_eq!(bench.says("Channel: A · Vertices"), !layout.is_map(), "{layout:?}, {presenting}");
        }
        // Values of a channel are there.
        channel(&mut bench, DebugChannel::NDotV);
        bench.session.facts.comparison = Some(Numbers::default());
        bench.settle();
        assert!(bench.says("Channel: A · N·V"), "{presenting}");
    }
}

#[test]
fn the_picture_in_place_of_a_difference_has_its_own_legend_and_dots_and_no_others() {
    for presenting in [false, true] {
        let mut bench = bench();
        bench.key(Key::B, CTRL);
        for (view, channel) in [(1, DebugChannel::Depth), (0, DebugChannel::Vertices)] {
            bench.apply(Action::Compare(CompareCommand::Activate(view)));
            bench.apply(Action::View(ViewChange::Channel(Some(channel))));
        }
        bench.apply(Action::View(ViewChange::Presenting(presenting)));
        bench.apply(Action::Compare(CompareCommand::Layout(Layout::Difference)));
        bench.settle();
        assert!(bench.says("Channel: A · Vertices"), "{presenting}");
        assert!(!bench.says("Channel: B"), "{presenting}: it shows A");
        // They are calculated on another thread.
        let dots = |shape: &Shape| matches!(shape, Shape::Mesh(mesh) if mesh.vertices.len() > 2000);
        let until = Instant::now() + Duration::from_secs(60);
        while !bench.shapes().iter().any(dots) {
            assert!(Instant::now() < until, "{presenting}: no lines and dots");
            thread::sleep(Duration::from_millis(20));
        }
    }
}

#[test]
fn numbers_and_map_wait_for_pictures_that_have_not_converged() {
    let mut bench = bench();
    bench.key(Key::B, CTRL);
    let numbers = vec![["RMSE", "0.031", "help"].map(str::to_owned)];
    bench.session.facts.comparison = Some(Numbers { all: numbers, ..Numbers::default() });
    let all = Converging { done: 256, total: 256, noise: Some(0.01) };
    bench.session.facts.converged[0] = all;
    bench.session.facts.converged[1] = Converging { done: 63, ..all };
    let why = "Not converged yet: 63 of 256 samples";
    for layout in [Layout::SideBySide, Layout::Wipe, Layout::Difference] {
        bench.apply(Action::Compare(CompareCommand::Layout(layout)));
        bench.settle();
        assert!(!bench.says("RMSE"), "{layout:?}");
        let written = crate::window::layout::texts(&mut bench).iter().filter(|(text, _)| text == why).count();
        assert_eq!(written, 1, "{layout:?}: in the bar, or in the place of a map");
        bench.apply(Action::View(ViewChange::Presenting(true)));
        let said = if layout.is_map() { format!("{why}. Shown: A") } else { why.to_owned() };
        let texts = crate::window::layout::texts(&mut bench);
        let written: Vec<_> = texts.into_iter().filter(|(text, _)| text.contains(why)).collect();
        assert!(
            written.len() == 1 && written[0].0 == said,
            "{layout:?}: a presentation says it once: {written:?}"
        );
        bench.apply(Action::View(ViewChange::Presenting(false)));
    }
    bench.session.facts.converged[1] = all;
    bench.settle();
    assert!(bench.says("RMSE 0.031") && !bench.says("Not converged"));
    bench.apply(Action::View(ViewChange::Presenting(true)));
    let numbers = bench.session.facts.comparison.clone();
    let mut ends = |numbers| {
        bench.session.facts.comparison = numbers;
        let texts = crate::window::layout::texts(&mut bench);
        let line =
            texts.into_iter().map(|(text, _)| text).find(|text| text.starts_with("B compared with A:"));
        let line = line.expect("the line below the pictures");
        (line.contains("RMSE 0.031"), line.contains('…'))
    };
    assert_eq!(ends(numbers), (true, false));
    assert_eq!(ends(None), (false, true), "there are none of these pictures");
}

#[test]
fn until_there_is_a_difference_it_is_measured_and_a_map_says_whose_picture_stands_there() {
    let mut bench = bench();
    bench.key(Key::B, CTRL);
    let texts = |bench: &mut Bench| {
        crate::window::layout::texts(bench).into_iter().map(|(text, _)| text).collect::<Vec<_>>()
    };
    let count = |texts: &[String], said: &str| texts.iter().filter(|text| *text == said).count();
    for (layout, measuring, shown) in
        [(Layout::Single, 0, 0), (Layout::SideBySide, 1, 0), (Layout::Wipe, 1, 0), (Layout::Difference, 1, 1)]
    {
        bench.apply(Action::Compare(CompareCommand::Layout(layout)));
        bench.session.facts.comparison = None;
        bench.settle();
        let said = texts(&mut bench);
        assert_eq!(count(&said, "Measuring the difference…"), measuring, "{layout:?}");
        assert_eq!(count(&said, "Shown: A"), shown, "{layout:?}");
        let numbers = vec![["RMSE", "0.031", "help"].map(str::to_owned)];
        bench.session.facts.comparison = Some(Numbers { all: numbers, largest: None });
        bench.settle();
        assert!(!bench.says("Measuring") && !bench.says("Shown: A"), "{layout:?}");
    }
    bench.session.facts.comparison = None;
    bench.apply(Action::View(ViewChange::Presenting(true)));
    assert!(texts(&mut bench).contains(&"B compared with A: … Shown: A".to_owned()));
}

#[test]
fn what_is_said_in_place_of_a_map_lies_among_the_badges_and_not_where_its_legend_is() {
    for scale in [100, 150, 200] {
        let mut bench = bench();
        bench.size = vec2(1920.0, 1080.0);
        bench.key(Key::B, CTRL);
        bench.apply(Action::View(ViewChange::Scale(scale)));
        bench.apply(Action::Compare(CompareCommand::Layout(Layout::Difference)));
        bench.session.facts.converged[1] = Converging { done: 63, total: 256, noise: None };
        let share = vec![20; Clipping::GRID[0] * Clipping::GRID[1]];
        bench.session.facts.clipping[0] = Clipping::new(share);
        bench.settle();
        let map = bench.area.map.expect("a map");
        let of_map = |label: &str| {
            let seen = bench.tree.iter().find(|s| s.label.contains(label) && map.contains_rect(s.rect));
            seen.unwrap_or_else(|| panic!("“{label}” is not in the map at {scale} %")).rect
        };
        let all = ["Not converged yet", "Shown: A", "A · Clipped"].map(of_map);
        for (i, place) in all.iter().enumerate() {
            assert!(place.bottom() < map.center().y, "{scale} %: {place:?} in {map:?}");
            assert!(all[..i].iter().all(|other| !other.intersects(*place)), "{scale} %: {all:?}");
        }
    }
}

#[test]
fn the_buttons_of_layouts_stay_where_they_are() {
    for (size, scale) in [(vec2(1280.0, 720.0), 100), (vec2(1280.0, 720.0), 150), (vec2(1920.0, 300.0), 100)]
    {
        let mut bench = bench();
        bench.size = size;
        bench.key(Key::B, CTRL);
        bench.apply(Action::View(ViewChange::Scale(scale)));
        let mut known = None;
        for layout in Layout::ALL {
            bench.apply(Action::Compare(CompareCommand::Layout(*layout)));
            bench.settle();
            let layouts = bench.tree.iter().filter(|s| s.label.starts_with("Layout: "));
            let mut places: Vec<_> = layouts.map(|s| (s.label.clone(), s.rect)).collect();
            places.sort_by(|a, b| a.0.cmp(&b.0));
            assert!(!places.is_empty() || scale > 100, "{layout:?}");
            assert_eq!(*known.get_or_insert(places.clone()), places, "{layout:?} at {scale} %");
        }
    }
}

#[test]
fn legends_of_two_channels_do_not_overlap() {
    for scale in [100, 150, 200] {
        for layout in [Layout::SideBySide, Layout::Wipe, Layout::Difference] {
            let mut bench = bench();
            bench.key(Key::B, CTRL);
            bench.apply(Action::View(ViewChange::Scale(scale)));
            bench.apply(Action::Compare(CompareCommand::Layout(layout)));
            for view in [0, 1] {
                bench.apply(Action::Compare(CompareCommand::Activate(view)));
                bench.apply(Action::View(ViewChange::Channel(Some(DebugChannel::NDotL))));
            }
            bench.settle();
            let legends: Vec<_> =
                bench.tree.iter().filter(|s| s.label.starts_with("Channel: ")).map(|s| s.rect).collect();
            match legends.as_slice() {
                // As long as there is no map, A is shown in its place.
                [_] if layout == Layout::Difference => {}
                [a, b] if layout != Layout::Difference => {
                    assert!(!a.intersects(*b), "{layout:?} at {scale} %: {a:?} and {b:?}");
                }
                _ => panic!("{layout:?}: {legends:?}"),
            }
        }
    }
}

#[test]
fn legends_of_four_views_are_whole_within_their_pictures() {
    for scale in [100, 200] {
        let mut bench = bench();
        (0..3).for_each(|_| bench.apply(Action::Compare(CompareCommand::Add)));
        bench.apply(Action::View(ViewChange::Scale(scale)));
        for view in 0..4 {
            bench.apply(Action::Compare(CompareCommand::Activate(view)));
            bench.apply(Action::View(ViewChange::Channel(Some(DebugChannel::Normals))));
        }
        bench.settle();
        for cell in bench.area.cells.clone() {
            let name = format!("Channel: {} · ", ["A", "B", "C", "D"][cell.view]);
            let legend = bench.tree.iter().find(|s| s.label.starts_with(&name)).expect("its legend").rect;
            assert!(cell.rect.contains_rect(legend), "{scale} %: {legend:?} in {:?}", cell.rect);
            assert!(legend.height() < 0.5 * cell.rect.height(), "{scale} %: {legend:?} in {:?}", cell.rect);
        }
    }
}

#[test]
fn in_large_letters_legends_beside_each_other_are_low_and_not_cut() {
    let mut bench = bench();
    bench.key(Key::B, CTRL);
    bench.apply(Action::View(ViewChange::Scale(200)));
    for channels in
        [[DebugChannel::Vertices, DebugChannel::NDotL], [DebugChannel::Depth, DebugChannel::NDotL]]
    {
        for (view, channel) in channels.into_iter().enumerate() {
            bench.apply(Action::Compare(CompareCommand::Activate(view)));
            bench.apply(Action::View(ViewChange::Channel(Some(channel))));
        }
        bench.settle();
        let shapes = bench.shapes();
        for (cell, channel) in bench.area.cells.clone().into_iter().zip(channels) {
            let start = format!("{} · ", ["A", "B"][cell.view]);
            let name = format!("Channel: {start}");
            let legend = bench.tree.iter().find(|s| s.label.starts_with(&name)).expect("its legend").rect;
            assert!(
                legend.height() <= 0.25 * cell.rect.height(),
                "{channel:?}: {legend:?} in {:?}",
                cell.rect
            );
            let title = shapes.iter().find_map(|shape| match shape {
                Shape::Text(text) if text.galley.text().starts_with(&start) => Some(&text.galley),
                _ => None,
            });
            let title = title.expect("its title");
            let [said, name] = [title.text(), channel.name()].map(str::to_lowercase);
            assert!(!title.elided && said.contains(&name), "{said}");
        }
    }
}

#[test]
fn legends_beside_each_other_say_both_ends_of_their_scales() {
    for scale in [100, 150] {
        let mut bench = bench();
        bench.size = vec2(1280.0, 720.0);
        bench.key(Key::B, CTRL);
        bench.apply(Action::View(ViewChange::Scale(scale)));
        for view in [0, 1] {
            bench.apply(Action::Compare(CompareCommand::Activate(view)));
            bench.apply(Action::View(ViewChange::Channel(Some(DebugChannel::NDotV))));
        }
        bench.settle();
        let texts = crate::window::layout::texts(&mut bench);
        for cell in bench.area.cells.clone() {
            let name = format!("Channel: {} · ", ["A", "B"][cell.view]);
            let legend = bench.tree.iter().find(|s| s.label.starts_with(&name)).expect("its legend").rect;
            assert!(cell.rect.contains_rect(legend), "{scale} %: {legend:?} in {:?}", cell.rect);
            let inside = texts.iter().filter(|(_, place)| legend.expand(1.0).contains_rect(*place));
            let said: Vec<_> = inside.map(|(text, _)| text.as_str()).collect();
            assert!(said.contains(&"0") && said.contains(&"1"), "{scale} %: {said:?}");
        }
    }
}

#[test]
fn the_bar_says_in_full_why_views_are_not_compared() {
    let mut bench = bench();
    bench.key(Key::B, CTRL);
    bench.apply(Action::Compare(CompareCommand::Activate(0)));
    bench.apply(Action::View(ViewChange::Channel(Some(DebugChannel::Normals))));
    bench.settle();
    let bar = bench.shapes().into_iter().find_map(|shape| match shape {
        Shape::Text(text) if text.galley.text().starts_with("Not compared: ") => Some(text.galley),
        _ => None,
    });
    let bar = bar.expect("it says why");
    assert!(!bar.elided && bar.rows.len() <= 2, "{} in {} rows", bar.text(), bar.rows.len());
}

#[test]
fn the_bar_of_a_difference_stays_within_its_column() {
    for (width, scale) in [(1280.0, 100), (1280.0, 150), (1280.0, 200), (1500.0, 100), (1920.0, 200)] {
        let mut bench = bench();
        bench.size = vec2(width, 900.0);
        bench.key(Key::B, CTRL);
        bench.apply(Action::View(ViewChange::Scale(scale)));
        bench.apply(Action::Compare(CompareCommand::Layout(Layout::Difference)));
        bench.settle();
        let picture = bench.area.rect;
        for label in ["Amplify automatically", "largest", "display codes"] {
            let place = place(&bench, label);
            let here = format!("{width} at {scale} %: {label} at {place:?} of {picture:?}");
            assert!(place.left() >= picture.left() && place.right() <= picture.right() + 0.5, "{here}");
        }
    }
}

#[test]
fn a_heading_that_leaves_something_out_says_so() {
    let mut scene = Scene { reflection_model: "phong".to_owned(), ..Scene::default() };
    let values = [("k_a", 0.3), ("k_d", 0.7), ("k_s", 0.9)].map(|(name, v)| (name.into(), Value::Number(v)));
    scene.variants = vec![Variant {
        reflection_model: Some("blinn_phong".to_owned()),
        shading_model: Some("phong".to_owned()),
        material: Values(values.into()),
        exposure: Some(1.0),
        tessellation: Some(12),
        ..Variant::default()
    }];
    scene.comparison = Comparison { layout: Layout::SideBySide, ..Comparison::default() };
    let mut bench = Bench::new(Session::new(scene));
    let mut cut = 0;
    for width in (900..1500).step_by(20) {
        bench.size = vec2(width as f32, 720.0);
        bench.settle();
        let shapes = bench.shapes();
        let ends = [0, 1].map(|i| {
            let place = bench.area.cells[i].rect;
            let above = Rect::from_min_max(place.min - vec2(0.0, 28.0), place.right_top());
            shapes.iter().any(|shape| match shape {
                Shape::Text(text) if above.contains(text.visual_bounding_rect().center()) => {
                    text.galley.elided || text.galley.text().ends_with('…')
                }
                _ => false,
            })
        });
        assert_eq!(ends[0], ends[1], "{width}");
        cut += usize::from(ends[0]);
    }
    assert!(cut > 0, "nothing is tested");
    let heading = bench.area.cells[0].rect.left_top() + vec2(60.0, -14.0);
    bench.hover(heading);
    assert!(bench.texts().iter().any(|text| text.starts_with("Phong, ") && text.contains("k_a")));
}

#[test]
fn beside_each_other_objects_keep_their_size() {
    let radius = |bench: &Bench, cell: Rect| {
        let lens = Lens::of(&bench.session, cell);
        let middle = bench.session.document.objects[0].position;
        let right = bench.session.facts.camera * glam::Vec3::X;
        let at = lens.project(middle).unwrap();
        lens.project(middle + right).unwrap().distance(at) / cell.size().min_elem()
    };
    let mut bench = bench();
    bench.key(Key::B, CTRL);
    bench.settle();
    let beside = radius(&bench, bench.area.cells[0].rect);
    bench.size = vec2(2560.0, 900.0);
    bench.settle();
    let wide = radius(&bench, bench.area.cells[0].rect);
    assert!((beside / wide - 1.0).abs() < 0.01, "of the smaller side: {beside} and {wide}");
}

#[test]
fn a_presentation_of_two_views_says_both_and_their_difference_and_covers_nothing() {
    for size in [vec2(1280.0, 720.0), vec2(1920.0, 1080.0)] {
        for scale in [100, 150, 200] {
            let mut bench = three();
            bench.size = size;
            bench.apply(Action::View(ViewChange::Scale(scale)));
            bench.apply(Action::Compare(CompareCommand::Activate(1)));
            let numbers = vec![["RMSE", "0.031", "help"].map(str::to_owned)];
            bench.session.facts.comparison = Some(Numbers { all: numbers, ..Numbers::default() });
            bench.apply(Action::View(ViewChange::Presenting(true)));
            bench.settle();
            let said = crate::window::layout::texts(&mut bench);
            let has = |text: &str| said.iter().any(|(t, _)| t == text);
            assert!(has("A:") && has("B:") && has("B compared with A: RMSE 0.031"), "{scale} %: {said:?}");
            let label = |text: &str| bench.tree.iter().any(|s| s.label.contains(text));
            assert!(label("I_s = ") && label("I_d = "), "the equation of Phong, and that of Lambert");
            for shape in bench.shapes() {
                if let Shape::Text(text) = shape {
                    assert!(!text.galley.elided, "{scale} %: “{}” is cut", text.galley.text());
                }
            }
            let places = bench.area.cells.clone();
            assert!(places.iter().all(|cell| cell.rect.height() > 0.2 * size.y * 100.0 / f32::from(scale)));
        }
    }
}

/// A scene that comes with the program, in a window of 1280 × 720 pixels.
fn shipped(file: &str) -> Bench {
    let example = EXAMPLES.iter().find(|example| example.file == file).expect("shipped");
    let mut bench = Bench::new(Session::new(example.scene(&Registry::builtin()).expect("it is valid")));
    bench.size = vec2(1280.0, 720.0);
    bench.settle();
    bench
}

#[test]
fn a_presentation_of_two_views_shows_the_equations_of_both_on_the_same_baselines() {
    for scale in [100, 200] {
        let mut bench = shipped("compare_gold.json");
        bench.size = vec2(1920.0, 1080.0);
        bench.apply(Action::View(ViewChange::Scale(scale)));
        bench.apply(Action::View(ViewChange::Presenting(true)));
        let said: Vec<_> = bench.tree.iter().flat_map(|s| s.label.split("; ")).collect();
        for total in ["I = I_a + I_d + I_s", "I = I_d + I_s"] {
            assert!(said.contains(&total), "{scale} %: {total} is not among {said:?}");
        }
    }
    // One of the lines has a power, and others stand beside it.
    let mut bench = shipped("compare_phong_blinn_phong.json");
    bench.size = vec2(1920.0, 1080.0);
    bench.apply(Action::View(ViewChange::Presenting(true)));
    let below = bench.area.cells[0].rect.bottom();
    let mut lines: Vec<_> = (bench.shapes().into_iter())
        .filter_map(|shape| match shape {
            Shape::Text(text) if text.galley.text() == "=" && text.pos.y > below => Some(text.pos.y),
            _ => None,
        })
        .collect();
    lines.sort_by(f32::total_cmp);
    assert_eq!(lines.len(), 8, "four definitions for each");
    let steps: Vec<_> = lines.windows(2).map(|pair| pair[1] - pair[0]).collect();
    assert!(steps.iter().any(|step| *step < 0.5), "some stand side by side");
    assert!(steps.iter().all(|step| *step < 0.5 || *step > 30.0), "{steps:?}");
}

#[test]
fn the_empty_place_beside_three_views_says_nothing_in_a_presentation() {
    let mut bench = bench();
    (0..2).for_each(|_| bench.apply(Action::Compare(CompareCommand::Add)));
    let said = |bench: &mut Bench| bench.texts().iter().any(|text| text.ends_with("adds a view"));
    assert!(said(&mut bench));
    bench.apply(Action::View(ViewChange::Scale(200)));
    let texts = crate::window::layout::texts(&mut bench);
    let (_, words) = texts.into_iter().find(|(text, _)| text.ends_with("adds a view")).expect("it is said");
    let beside = bench.area.cells[2].rect;
    assert!(words.left() > beside.right() && words.right() < bench.area.rect.right(), "{words:?}");
    bench.apply(Action::View(ViewChange::Presenting(true)));
    assert!(!said(&mut bench));
}

#[test]
fn headings_keep_what_differs_and_drop_the_same_where_space_is_short() {
    let mut said = Vec::new();
    for scale in [100, 150, 200] {
        let mut bench = shipped("compare_phong_blinn_phong.json");
        bench.apply(Action::View(ViewChange::Scale(scale)));
        let headings = [0, 1].map(|i| {
            let place = bench.area.cells[i].rect;
            let above = Rect::from_min_max(place.min - vec2(0.0, 28.0), place.right_top());
            let texts = crate::window::layout::texts(&mut bench).into_iter();
            let above = texts.filter(|(_, rect)| above.contains(rect.center()));
            // A name may stand on two lines.
            above.map(|(text, _)| text.replace('\n', "")).collect::<Vec<_>>()
        });
        let has = |i: usize, words: &str| headings[i].iter().any(|text| text.contains(words));
        assert!(has(0, "Phong") && has(1, "Blinn–Phong"), "{scale} %: {headings:?}");
        assert_eq!(has(0, "0.05"), has(1, "0.05"), "{scale} %, k_a: {headings:?}");
        assert_eq!(has(0, "15"), has(1, "60"), "{scale} %, α: {headings:?}");
        said.push((has(0, "15"), has(0, "0.05")));
    }
    assert_eq!(said[..2], [(true, true), (true, false)], "α differs, and outlasts k_a");
}

#[test]
fn headings_say_the_terms_that_their_views_show() {
    let mut bench = shipped("compare_phong_blinn_phong.json");
    bench.letter(Key::T, "t");
    bench.letter(Key::T, "t");
    assert_eq!(bench.session.terms_of(0), TermSelection::Diffuse);
    click(&mut bench, "B · Only the diffuse term");
    for presenting in [false, true] {
        bench.apply(Action::View(ViewChange::Presenting(presenting)));
        let heading = |view: &str| {
            let is = |s: &&Seen| s.role == Role::RadioButton && s.label.starts_with(view);
            &bench.tree.iter().find(is).expect("its heading").label
        };
        let (a, b) = (heading("View A: "), heading("View B: "));
        assert!(a.contains("diffuse term alone") && !a.contains("all terms"), "{a}");
        assert!(b.contains("all terms"), "{b}");
    }
}

#[test]
fn headings_of_compared_views_say_the_same_things() {
    let mut scene = Scene { reflection_model: "phong".to_owned(), ..Scene::default() };
    scene.objects[0].material.set("k_s", Value::Number(0.25));
    let values = Values([("alpha".into(), Value::Integer(80))].into());
    scene.variants = vec![
        Variant { material: values, ..Variant::default() },
        Variant { exposure: Some(1.0), ..Variant::default() },
        Variant::default(),
    ];
    let registry = Registry::builtin();
    let said: Vec<_> = (0..4).map(|view| header(&scene, view, &registry)).collect();
    assert_eq!(said, ["A · α 32, 0 EV", "B · α 80, 0 EV", "C · α 32, +1 EV", "D · as A"]);
}

#[test]
fn panels_and_views_do_not_overlap_beside_a_lesson_at_any_scale() {
    for size in [vec2(1280.0, 690.0), vec2(1280.0, 720.0), vec2(1920.0, 1080.0)] {
        for scale in SCALES {
            let mut bench = bench();
            bench.size = size;
            bench.apply(Action::View(ViewChange::Scale(scale)));
            bench.apply(Action::Lesson(LessonCommand::Open(LessonSource::Shipped(1))));
            bench.settle();
            bench.apply(Action::Select(Selection::Object(0)));
            bench.apply(Action::View(ViewChange::Right(true)));
            bench.apply(Action::Compare(CompareCommand::Add));
            bench.apply(Action::Compare(CompareCommand::Layout(Layout::SideBySide)));
            bench.settle();
            let whole = size.x / bench.ctx.zoom_factor();
            let here = format!("{size:?} at {scale} %");
            assert_eq!(bench.area.cells.len(), 2, "{here}");
            assert!(bench.area.cells.iter().all(|cell| bench.area.rect.contains_rect(cell.rect)), "{here}");
            assert!(bench.area.rect.width() >= 0.29 * whole - 2.0, "{here}: {:?}", bench.area.rect);
            // What the properties say begins where the picture ends.
            let name = place(&bench, "Name of view B");
            assert!(name.left() >= bench.area.rect.right(), "{here}: {name:?} over {:?}", bench.area.rect);
            assert!(name.right() <= whole, "{here}: {name:?} of {whole}");
        }
    }
}
