//! The space that the panels leave for the picture, and the texts in them that are shown in full; without a
//! window.

use std::collections::BTreeSet;

use bevy_egui::egui::{
    Event, Key, Modifiers, PointerButton, Pos2, Rect, Shape, epaint::TextShape, pos2, vec2,
};
use glam::Vec3;
use lights_camera_models::{
    document::{Edit, Selection},
    panel::{
        keys,
        state::{
            Action, CODE_TAB, CompareCommand, EXPLAIN_TAB, MATERIALS_TAB, MESSAGES_TAB, PLOTS_TAB,
            SHADER_TAB, Session, Severity, ViewChange,
        },
    },
    scene::{Light, Object, Part, Scene, comparison::Layout},
};

use crate::window::panels::Bench;

/// A window of 1280×720 pixels with this scale, in per cent.
fn bench(scale: u16) -> Bench {
    let mut bench = Bench::with_model("phong");
    bench.size = vec2(1280.0, 720.0);
    bench.apply(Action::View(ViewChange::Scale(scale)));
    bench
}

#[test]
fn panels_give_way_to_the_picture_and_the_width_of_a_user_counts() {
    for (scale, share) in [(100, 0.45), (125, 0.45), (150, 0.45), (200, 0.4)] {
        let whole = 1280.0 / (f32::from(scale) / 100.0);
        let mut bench = bench(scale);
        let picture = bench.area.rect;
        assert!(picture.width() >= share * whole - 2.0, "{scale} %: {} of {whole}", picture.width());
        // Also when the window shrinks while it is open, and vice versa.
        bench.size = vec2(1920.0, 1080.0);
        bench.settle();
        assert!(bench.area.rect.width() >= 0.45 * 1.5 * whole - 2.0);
        bench.size = vec2(1280.0, 720.0);
        bench.settle();
        assert_eq!(bench.area.rect, picture);
        // The edge of the properties is dragged to the left.
        let kept = bench.session.settings.clone();
        let (from, to) = (pos2(picture.right(), 200.0), pos2(picture.right() - 60.0, 200.0));
        drag(&mut bench, from, to);
        let most = 0.45 * whole;
        let wanted = (whole - to.x).min(most);
        let right = whole - bench.area.rect.right();
        assert!((right - wanted).abs() < 4.0, "{scale} %: {right}, not {wanted}");
        assert!((bench.session.settings.right_width - right).abs() < 4.0, "{scale} %: kept");
        assert_eq!(
            bench.session.settings.left_width, kept.left_width,
            "{scale} %: the other one is as it was"
        );
        assert_eq!(bench.area.rect.left(), picture.left(), "{scale} %: on screen too");
    }
}

/// Two views beside each other.
fn two_views(bench: &mut Bench) {
    bench.apply(Action::Compare(CompareCommand::Add));
    bench.apply(Action::Compare(CompareCommand::Layout(Layout::SideBySide)));
}

/// Drags from one place to another.
pub fn drag(bench: &mut Bench, from: Pos2, to: Pos2) {
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
}

#[test]
fn above_a_strip_that_nobody_has_dragged_the_pictures_keep_their_part_of_the_window() {
    for (scale, views) in [100, 150, 200].into_iter().flat_map(|scale| [(scale, 1), (scale, 2)]) {
        let whole = 720.0 / (f32::from(scale) / 100.0);
        let mut bench = bench(scale);
        if views > 1 {
            two_views(&mut bench);
        }
        for tab in [PLOTS_TAB, SHADER_TAB, EXPLAIN_TAB, CODE_TAB, MATERIALS_TAB, MESSAGES_TAB] {
            bench.apply(Action::View(ViewChange::BottomTab(tab.to_owned())));
            bench.settle();
            let picture = bench.area.rect;
            let here = format!("{scale} %, {views} views, {tab}: {picture:?} of {whole}");
            assert!(picture.height() >= 0.34 * whole, "{here}");
            assert!(picture.bottom() <= whole - 60.0, "{here}: nothing is left to the strip");
        }
    }
}

#[test]
fn a_height_that_a_user_gave_the_strip_stays() {
    let mut bench = bench(200);
    bench.apply(Action::View(ViewChange::BottomTab(PLOTS_TAB.to_owned())));
    let usual = bench.session.settings.bottom_height;
    let edge = bench.area.rect.bottom();
    assert!(edge < 240.0, "{edge}");
    drag(&mut bench, pos2(320.0, edge), pos2(320.0, edge - 36.0));
    let given = bench.session.settings.bottom_height;
    assert!(given != usual, "{given}");
    for tab in [MESSAGES_TAB, PLOTS_TAB] {
        bench.apply(Action::View(ViewChange::BottomTab(tab.to_owned())));
    }
    bench.settle();
    let now = bench.area.rect;
    assert!((now.bottom() - edge + 36.0).abs() < 4.0, "{now:?}, and the edge was at {edge}");
    assert!(now.height() < 0.34 * 360.0, "{now:?}");
}

#[test]
fn a_drag_of_something_else_gives_the_strip_no_height() {
    let mut bench = bench(100);
    bench.size.y = 1600.0;
    bench.apply(Action::View(ViewChange::BottomTab(PLOTS_TAB.to_owned())));
    let before = bench.session.settings.clone();
    let picture = bench.area.rect;
    drag(&mut bench, pos2(picture.right(), 200.0), pos2(picture.right() - 60.0, 200.0));
    let after = &bench.session.settings;
    assert!(after.right_width != before.right_width, "{}", after.right_width);
    assert_eq!(after.bottom_height, before.bottom_height);
    assert_eq!(bench.area.rect.bottom(), picture.bottom());
}

#[test]
fn headers_name_their_models_whole_however_large_everything_is() {
    for (scale, layout) in
        [100, 150, 200].into_iter().flat_map(|s| [(s, Layout::SideBySide), (s, Layout::Wipe)])
    {
        let mut bench = bench(scale);
        two_views(&mut bench);
        bench.apply(Action::Compare(CompareCommand::Layout(layout)));
        bench.apply(Action::Compare(CompareCommand::Activate(1)));
        bench.apply(Action::Edit(Edit::set(Part::Scene, Scene::reflection_model, "blinn_phong")));
        bench.settle();
        let picture = bench.area.rect;
        let headers: Vec<_> = (bench.shapes().into_iter())
            .filter_map(|shape| match shape {
                Shape::Text(text) if picture.x_range().contains(text.pos.x) => Some(text),
                _ => None,
            })
            .filter(|text| (picture.top() - 40.0..picture.top()).contains(&text.pos.y))
            .map(|text| (text.galley.text().replace('\n', ""), text.galley.elided))
            .collect();
        for name in ["Phong", "Blinn–Phong"] {
            let is_whole = headers.contains(&(name.to_owned(), false));
            assert!(is_whole, "{name} at {scale} %, {layout:?}: {headers:?}");
        }
    }
}

#[test]
fn an_override_is_said_at_the_top_however_large_everything_is() {
    for scale in [100, 125, 150, 175] {
        let mut bench = bench(scale);
        bench.apply(Action::AddObject("cube".to_owned()));
        assert!(!bench.says("overrides reflection"));
        bench.apply(Action::Edit(Edit::set(Part::Object(1), Object::reflection_model, "lambert")));
        let hint = bench.tree.iter().find(|s| s.label.contains("“Cube 1” overrides reflection"));
        let hint = hint.unwrap_or_else(|| panic!("no hint at {scale} %")).rect;
        assert!(
            hint.right() <= 1280.0 / bench.ctx.zoom_factor() && hint.width() >= 16.0,
            "{scale} %: {hint:?}"
        );
    }
}

#[test]
fn the_entries_of_the_view_menu_stand_in_line_with_and_without_marks() {
    let mut bench = bench(100);
    bench.click("View");
    let left = |bench: &mut Bench, words: &str| {
        let shapes = bench.shapes();
        let found = shapes.iter().find_map(|shape| match shape {
            Shape::Text(text) if text.galley.text() == words => Some(text.pos.x),
            _ => None,
        });
        found.unwrap_or_else(|| panic!("no {words}"))
    };
    let marked = left(&mut bench, "Presentation");
    for words in ["Full screen", "Home: the observer’s view", "Compare", "Marks", "Theme"] {
        assert!((left(&mut bench, words) - marked).abs() < 0.6, "{words}: {marked}");
    }
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
            // A key is named after what it does: Delete.
            && (300.0..900.0).contains(&text.pos.x)
        {
            lefts.insert(text.pos.x.round() as i32);
            right = right.max(text.pos.x + text.galley.size().x);
        }
    }
    assert_eq!(lefts.len(), 2, "two columns: {lefts:?}");
    assert!(bar.is_finite() && right <= bar - 4.0, "{right}, and the bar at {bar}");
}

/// The texts on screen, and their positions.
pub fn texts(bench: &mut Bench) -> Vec<(String, Rect)> {
    let text = |shape| match shape {
        Shape::Text(text) => Some((text.galley.text().to_owned(), text.visual_bounding_rect())),
        _ => None,
    };
    bench.shapes().into_iter().filter_map(text).collect()
}

/// The words of a text as displayed, with … where it is cut.
fn glyphs(text: &TextShape) -> String {
    text.galley.rows.iter().flat_map(|row| &row.glyphs).map(|glyph| glyph.chr).collect()
}

#[test]
fn the_last_message_is_whole_where_there_is_room() {
    let mut bench = bench(150);
    let words = "Saved to /home/mira/courses/computer_graphics/scenes/lesson_3/exercise_1b.json.";
    bench.session.say(Severity::Info, words);
    bench.settle();
    let whole = |shape: Shape| match shape {
        Shape::Text(text) if text.galley.text() == words => Some(!text.galley.elided),
        _ => None,
    };
    assert_eq!(bench.shapes().into_iter().find_map(whole), Some(true));
    // A long one leaves space for the texts on the right.
    bench.session.say(Severity::Info, words.repeat(9));
    bench.settle();
    let selected = bench.find("Sphere 1 selected · F1 keys").expect("shown").rect;
    assert!(selected.width() > 60.0 && selected.right() <= 1280.0 / 1.5, "{selected:?}");
    // One tooltip says the rest.
    let long = words.repeat(9);
    let all = |bench: &mut Bench| bench.texts().iter().filter(|text| **text == long).count();
    let (before, at) = (all(&mut bench), bench.find(&long).expect("shown").rect.center());
    bench.hover(at);
    assert_eq!(all(&mut bench), before + 1);
}

#[test]
fn fields_show_their_numbers_whole_or_rounded_and_give_the_whole_on_request() {
    for scale in [100, 150, 200] {
        let mut bench = bench(scale);
        bench.size.y = 2000.0;
        bench.apply(Action::AddLight("directional".to_owned()));
        let direction = Vec3::new(-0.4082, -0.0824, -0.8165);
        bench.apply(Action::Edit(Edit::set(Part::Light(1), Light::direction, direction)));
        let shown: Vec<_> = ["x", "y", "z"]
            .map(|axis| {
                let field = bench.field(&format!("direction {axis}")).rect;
                let inner = field.shrink2(vec2(4.0, 0.0));
                let texts = texts(&mut bench);
                let (text, place) =
                    texts.iter().find(|(_, place)| field.contains(place.center())).expect("a number");
                assert!(
                    place.left() >= inner.left() && place.right() <= inner.right() + 1.0,
                    "{scale} %: {text} at {place:?} in {inner:?}"
                );
                text.clone()
            })
            .into();
        let whole = ["−0.4082", "−0.0824", "−0.8165"];
        for (text, whole) in shown.iter().zip(whole) {
            let parse = |text: &str| text.replace('−', "-").parse::<f32>().expect("a number");
            assert!((parse(text) - parse(whole)).abs() < 0.006, "{scale} %: {text}");
        }
    }
    // A rounded number is edited as it is.
    let mut bench = bench(100);
    let number = Vec3::new(-0.40824, -0.0824, -0.8165);
    bench.apply(Action::AddLight("directional".to_owned()));
    bench.apply(Action::Edit(Edit::set(Part::Light(1), Light::direction, number)));
    let before = bench.session.document.scene().clone();
    let field = bench.field("direction x").rect;
    bench.click_at(field.center(), PointerButton::Primary);
    assert!(
        texts(&mut bench).iter().any(|(text, place)| text == "−0.4082" && field.contains(place.center()))
    );
    bench.key(Key::Enter, Modifiers::NONE);
    assert_eq!(*bench.session.document, before, "looking at it changes nothing");
}

#[test]
fn a_name_that_is_longer_than_its_field_is_told_whole() {
    let mut bench = bench(150);
    let name = "gold under the light: white, from the front".to_owned();
    bench.apply(Action::Edit(Edit::set(Part::Object(0), Object::name, name.clone())));
    let field = bench.field("Name").rect;
    let count = |bench: &mut Bench| texts(bench).iter().filter(|(text, _)| *text == name).count();
    let before = count(&mut bench);
    bench.hover(field.center());
    assert_eq!(count(&mut bench), before + 1);
}

#[test]
fn the_colour_of_a_temperature_stands_beside_its_choice() {
    for scale in [100, 125, 150, 200] {
        let mut bench = bench(scale);
        bench.size.y = 2000.0;
        bench.apply(Action::Select(Selection::Light(0)));
        bench.apply(Action::Edit(Edit::set(Part::Light(0), Light::colour_temperature, 2700.0)));
        let choice = bench.find("Colour by: temperature").expect("a choice").rect;
        let sample = bench.shapes().into_iter().find_map(|shape| match shape {
            Shape::Rect(r) if r.rect.size() == vec2(44.0, 22.0) && r.rect.left() > choice.left() => {
                Some(r.rect)
            }
            _ => None,
        });
        let sample = sample.expect("a colour");
        assert!(choice.right() + 4.0 <= sample.left(), "{scale} %: {choice:?}, {sample:?}");
    }
}

#[test]
fn the_menus_fit_a_window_in_which_everything_is_larger() {
    for (menu, last) in [("File", "Quit"), ("Edit", "Export shaders for editing…"), ("View", "Full screen")]
    {
        let mut bench = bench(150);
        bench.click(menu);
        let entry = bench.tree.iter().find(|s| s.label.starts_with(last)).expect("the last entry").rect;
        assert!(entry.is_positive() && entry.bottom() <= 480.0, "{menu}: {entry:?}");
        let seen = texts(&mut bench).into_iter().find(|(text, _)| text.starts_with(last)).expect("painted").1;
        assert!(seen.bottom() <= 480.0, "{menu}: {seen:?}");
    }
    let mut bench = bench(150);
    bench.click("View");
    bench.click("Panels ⏵");
    bench.click("Properties");
    assert!(!bench.session.view.right_open);
}

#[test]
fn the_title_leaves_room_for_the_file_unless_that_repeats_it() {
    let name = "A long look at shapes and lights";
    let all = [(1280.0, 100), (1280.0, 150), (1920.0, 100)];
    let files = ["exercise_one.json", "long_look_at_shapes_and_lights.json"];
    for (file_name, (size, scale)) in files.into_iter().flat_map(|f| all.map(|s| (f, s))) {
        let mut session = Session::new(Scene { name: Some(name.to_owned()), ..Scene::default() });
        session.path = Some(format!("/home/mira/{file_name}").into());
        let mut bench = Bench::new(session);
        bench.size = vec2(size, 0.5625 * size);
        bench.apply(Action::View(ViewChange::Scale(scale)));
        let file = bench.find("File").expect("a menu").rect;
        let shown: Vec<_> = (bench.shapes().into_iter())
            .filter_map(|shape| match shape {
                Shape::Text(text) if text.pos.x < file.left() && text.pos.y < 36.0 => {
                    Some((glyphs(&text), text.visual_bounding_rect()))
                }
                _ => None,
            })
            .collect();
        let title: String = shown.iter().map(|(text, _)| text.as_str()).collect();
        assert!(title.starts_with("A l"), "{size}, {scale} %: {title}");
        assert_eq!(title.contains(" — "), file_name == files[0], "{size}, {scale} %: {title}");
        assert!(file_name != files[0] || title.contains(" — ex"), "{size}, {scale} %: {title}");
        assert!(shown.iter().all(|(_, place)| place.right() < file.left() - 8.0), "{shown:?}");
    }
}

#[test]
fn a_warning_is_read_without_opening_the_list() {
    let mut bench = bench(100);
    bench.session.say(Severity::Warning, "scene.json was not opened.");
    bench.settle();
    assert!(!bench.session.view.bottom_open && bench.says("scene.json was not opened."));
}

#[test]
fn an_error_in_a_field_covers_no_other_knob() {
    for scale in [100, 150] {
        let mut bench = bench(scale);
        bench.apply(Action::Select(Selection::Observer));
        bench.type_into("position x", "90");
        let said = texts(&mut bench).into_iter().find(|(text, _)| text.contains("the picture keeps"));
        let place = said.expect("a rule").1;
        assert!(place.right() < bench.area.rect.right() && place.left() > 0.0, "{scale} %: {place:?}");
        let field = bench.field("position x").rect;
        assert!(place.y_range().contains(field.center().y), "{scale} %: beside its field");
    }
}

#[test]
fn the_caption_says_that_the_picture_is_behind_until_it_is_not() {
    let mut bench = bench(100);
    let says = |bench: &mut Bench| texts(bench).iter().any(|(text, _)| text == "compiling…");
    assert!(!says(&mut bench));
    bench.session.facts.compiling[0] = true;
    bench.settle();
    assert!(says(&mut bench));
    bench.session.facts.compiling[0] = false;
    bench.settle();
    assert!(!says(&mut bench));
}

#[test]
fn a_line_of_the_caption_ends_with_no_dot_and_keeps_its_padding() {
    let mut bench = bench(150);
    bench.apply(Action::Edit(Edit::set(Part::Scene, Scene::shading_model, "derivative")));
    let corner = bench.area.rect.left_bottom();
    let mut pieces: Vec<_> = texts(&mut bench)
        .into_iter()
        .filter(|(_, place)| (place.left() - corner.x).abs() < 300.0 && corner.y - place.top() < 48.0)
        .filter(|(_, place)| place.bottom() < corner.y)
        .collect();
    pieces.sort_by_key(|(_, place)| (place.bottom().round() as i32, place.left().round() as i32));
    let last = |bottom: f32| {
        let line = pieces.iter().filter(|(_, place)| (place.center().y - bottom).abs() < 8.0);
        line.max_by_key(|(_, place)| place.right() as i32).expect("a line").0.clone()
    };
    let (first, end) = (pieces[0].1.center().y, pieces[pieces.len() - 1].1.center().y);
    assert!(end - first > 8.0, "two lines: {pieces:?}");
    for line in [first, end] {
        assert!(!last(line).trim_end().ends_with('·'), "{pieces:?}");
    }
    let plate = bench.shapes().into_iter().find_map(|shape| match shape {
        Shape::Rect(r) if r.rect.height() < 60.0 && r.rect.contains_rect(pieces[0].1) => Some(r.rect),
        _ => None,
    });
    let plate = plate.expect("a plate");
    for (text, place) in pieces.iter().filter(|(_, place)| plate.contains(place.center())) {
        assert!(plate.right() - place.right() > 6.0, "{text} at {place:?} in {plate:?}");
    }
}

#[test]
fn the_authors_of_models_are_whole_in_the_list_of_an_override() {
    let mut bench = bench(100);
    bench.size.y = 1600.0;
    bench.settle();
    bench.click("Override model and shading: none");
    let authors: Vec<_> = bench.registry.models().iter().map(|m| m.declaration.author).collect();
    let mut seen = 0;
    for shape in bench.shapes() {
        if let Shape::Text(text) = shape
            && text.pos.x < 1100.0
            && authors.contains(&text.galley.text())
        {
            assert!(!text.galley.elided, "{}", text.galley.text());
            seen += 1;
        }
    }
    assert!(seen > 5, "{seen}");
}
