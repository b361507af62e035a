//! Narrow windows, such as those of phones: the picture at the top, one panel below it, and controls for a thumb.

use bevy_egui::egui::{Id, Key, Modifiers, PointerButton, Rect, accesskit::Role, vec2};
use lights_camera_models::{
    document::{Edit, Selection},
    panel::state::{
        Action, CODE_TAB, CompareCommand, EXPLAIN_TAB, LessonCommand, LessonSource, MATERIALS_TAB,
        MESSAGES_TAB, PLOTS_TAB, Place, SHADER_TAB, TakeCommand, Taken, ViewChange,
    },
    scene::{Object, Part, Scene, comparison::Layout},
};

use crate::window::panels::{Bench, Seen};

/// Phones at two sizes of everything.
const PHONES: [([f32; 2], u16); 4] =
    [([390.0, 844.0], 100), ([390.0, 844.0], 150), ([360.0, 640.0], 100), ([360.0, 640.0], 150)];
/// Minimum height of a control, in points.
const THUMB: f32 = 32.0;

fn bench([width, height]: [f32; 2], scale: u16) -> Bench {
    let mut bench = Bench::with_model("phong");
    bench.size = vec2(width, height);
    bench.apply(Action::View(ViewChange::Scale(scale)));
    bench.settle();
    bench
}

fn whole(bench: &Bench) -> Rect {
    bench.ctx.content_rect().expand(0.6)
}

/// The widgets whose middle is in sight and that reach beyond a side of the window.
fn outside(bench: &Bench) -> Vec<&Seen> {
    let whole = whole(bench);
    let is_widget = |s: &&Seen| {
        matches!(s.role, Role::Button | Role::RadioButton | Role::ComboBox | Role::Slider | Role::TextInput)
    };
    let is_out = |s: &&Seen| s.rect.left() < whole.left() || s.rect.right() > whole.right();
    let in_sight = |s: &&Seen| s.rect.is_positive() && whole.y_range().contains(s.rect.center().y);
    bench.tree.iter().filter(is_widget).filter(in_sight).filter(is_out).collect()
}

fn check(bench: &Bench, here: &str) {
    let (picture, height) = (bench.area.rect, bench.ctx.content_rect().height());
    assert!(picture.height() >= 0.4 * height - 1.0, "{here}: {picture:?} of {height}");
    assert!(outside(bench).is_empty(), "{here}: {:?}", outside(bench));
    for label in ["Menu", "Scene", "Properties", "More panels"] {
        let place = bench.find(label).unwrap_or_else(|| panic!("{here}: no {label}")).rect;
        assert!(whole(bench).contains_rect(place), "{here}: {label} at {place:?}");
        assert!(place.height() >= THUMB - 0.1, "{here}: {label} is {} high", place.height());
    }
}

#[test]
fn the_picture_is_above_and_each_panel_can_be_brought_below_it() {
    for (size, scale) in PHONES {
        let here = format!("{size:?} at {scale} %");
        let mut bench = bench(size, scale);
        let picture = bench.area.rect;
        assert_eq!(picture.width(), bench.ctx.content_rect().width(), "{here}");
        bench.click("Scene");
        if bench.session.view.in_front() != Some(Place::Left) {
            bench.click("Scene");
        }
        check(&bench, &here);
        let row = ["Room", "Observer", "Sphere 1"].iter().find_map(|name| bench.find(name));
        let row = row.expect("a row").rect;
        assert!(row.top() > bench.area.rect.bottom() && row.height() >= THUMB - 0.1, "{here}: {row:?}");
        bench.click("Properties");
        assert_eq!(bench.session.view.in_front(), Some(Place::Right), "{here}");
        assert!(bench.find("Add a light").is_none(), "{here}: one panel");
        // In the narrowest one they are scrolled sideways.
        if bench.ctx.content_rect().width() >= 260.0 {
            check(&bench, &here);
        }
        let name = bench.field("Name").rect;
        assert!(name.top() > bench.area.rect.bottom() && name.height() >= THUMB - 0.1, "{here}: {name:?}");
        let sliders = bench.tree.iter().filter(|seen| seen.role == Role::Slider).map(|seen| seen.rect);
        let lows: Vec<_> = sliders.filter(|place| place.height() < THUMB - 0.1).collect();
        assert!(lows.is_empty(), "{here}: {lows:?}");
        for (title, tab) in [
            ("Messages", MESSAGES_TAB),
            ("Plots", PLOTS_TAB),
            ("Code", CODE_TAB),
            ("Shader", SHADER_TAB),
            ("Explain", EXPLAIN_TAB),
            ("Materials", MATERIALS_TAB),
        ] {
            bench.click("More panels");
            bench.click(title);
            let view = &bench.session.view;
            assert!(view.shows_strip() && view.bottom_tab == tab, "{here}: {title}");
            let height = bench.ctx.content_rect().height();
            assert!(bench.area.rect.height() >= 0.4 * height - 1.0, "{here}: {title}");
        }
    }
}

#[test]
fn the_button_of_the_panel_in_sight_shows_the_picture_alone() {
    let mut bench = bench([390.0, 844.0], 100);
    bench.apply(Action::View(ViewChange::Front(Place::Right)));
    let before = bench.area.rect.height();
    bench.click("Properties");
    assert_eq!(bench.session.view.in_front(), None);
    assert!(bench.area.rect.height() > before + 200.0, "{:?}", bench.area.rect);
    bench.click("Properties");
    assert_eq!(bench.area.rect.height(), before);
}

#[test]
fn what_is_opened_comes_to_the_front() {
    let mut bench = bench([390.0, 844.0], 100);
    let front = |bench: &mut Bench, change: ViewChange| {
        bench.apply(Action::View(change));
        bench.session.view.in_front()
    };
    assert_eq!(front(&mut bench, ViewChange::BottomTab(PLOTS_TAB.to_owned())), Some(Place::Bottom));
    assert_eq!(front(&mut bench, ViewChange::Right(true)), Some(Place::Right));
    assert_eq!(front(&mut bench, ViewChange::Examples(true)), Some(Place::Strip));
    assert!(bench.find("Example: Default scene").is_some());
    check(&bench, "examples");
    // Escape closes them, and what was open before is in sight.
    bench.key(Key::Escape, Modifiers::NONE);
    assert_eq!(bench.session.view.in_front(), Some(Place::Left));
    assert_eq!(front(&mut bench, ViewChange::Bottom(true)), Some(Place::Bottom));
    assert_eq!(front(&mut bench, ViewChange::Bottom(false)), Some(Place::Left));
}

#[test]
fn one_button_holds_all_menus() {
    let mut bench = bench([390.0, 844.0], 100);
    assert!(bench.find("File").is_none());
    bench.click("Menu");
    for menu in ["File ⏵", "Edit ⏵", "View ⏵", "Help ⏵"] {
        let place = bench.find(menu).unwrap_or_else(|| panic!("no {menu}")).rect;
        assert!(whole(&bench).contains_rect(place) && place.height() >= THUMB - 0.1, "{menu}: {place:?}");
    }
    bench.click("View ⏵");
    assert!(bench.says("Full screen"));
    assert!(outside(&bench).is_empty(), "{:?}", outside(&bench));
    // A wider window has a bar.
    bench.key(Key::Escape, Modifiers::NONE);
    bench.size = vec2(640.0, 844.0);
    bench.settle();
    assert!(bench.find("Menu").is_none() && bench.find("File").is_some());
}

#[test]
fn the_bar_ends_in_the_window_and_folds_the_choice_of_shading_into_the_menu() {
    for (size, scale) in
        [([640.0, 360.0], 150), ([640.0, 360.0], 200), ([360.0, 640.0], 150), ([360.0, 360.0], 200)]
    {
        let here = format!("{size:?} at {scale} %");
        let mut bench = bench(size, scale);
        bench.apply(Action::Edit(Edit::set(Part::Scene, Scene::shading_model, "derivative")));
        bench.apply(Action::AddObject("cube".to_owned()));
        bench.apply(Action::Edit(Edit::set(Part::Object(1), Object::reflection_model, "minnaert")));
        let right = bench.ctx.content_rect().right() - 7.0;
        let over =
            bench.tree.iter().filter(|s| s.rect.bottom() < bench.area.rect.top() && s.rect.right() > right);
        let over: Vec<_> = over.filter(|s| !s.label.is_empty()).collect();
        assert!(over.is_empty(), "{here}: {over:?}");
        let folds = bench.find("Shading: Derivative").is_none();
        assert_eq!(folds, right < 200.0, "{here}");
        if folds {
            bench.click("Menu");
            bench.click("Shading ⏵");
            let entry = bench.tree.iter().find(|s| s.role == Role::RadioButton && s.label == "Phong");
            let entry = entry.expect("an entry").rect.center();
            bench.click_at(entry, PointerButton::Primary);
            assert_eq!(bench.session.document.shading_model, "phong", "{here}");
        }
    }
}

#[test]
fn two_views_stand_one_above_the_other() {
    for (size, scale) in PHONES {
        let here = format!("{size:?} at {scale} %");
        let mut bench = bench(size, scale);
        bench.apply(Action::Compare(CompareCommand::Add));
        bench.apply(Action::Compare(CompareCommand::Layout(Layout::SideBySide)));
        bench.settle();
        check(&bench, &here);
        let [a, b] = [0, 1].map(|i| bench.area.cells[i].rect);
        assert!((a.size() - b.size()).length() < 0.1, "{here}: {a:?}, {b:?}");
        assert!(a.bottom() < b.top() && a.width() > a.height(), "{here}: {a:?}, {b:?}");
        // Four have two columns.
        bench.apply(Action::Compare(CompareCommand::Add));
        bench.apply(Action::Compare(CompareCommand::Add));
        bench.settle();
        let [a, b] = [0, 1].map(|i| bench.area.cells[i].rect);
        assert!(a.right() < b.left() && a.top() == b.top(), "{here}: {a:?}, {b:?}");
    }
}

#[test]
fn the_text_of_a_lesson_is_below_the_picture_with_its_buttons_in_sight() {
    for (size, scale) in PHONES {
        let here = format!("{size:?} at {scale} %");
        let mut bench = bench(size, scale);
        // What a step opens does not hide its text.
        bench.apply(Action::View(ViewChange::BottomTab(PLOTS_TAB.to_owned())));
        bench.apply(Action::Lesson(LessonCommand::Open(LessonSource::Shipped(0))));
        bench.settle();
        assert_eq!(bench.session.view.in_front(), Some(Place::Left), "{here}");
        check(&bench, &here);
        for label in ["Lesson", "Next", "Previous"] {
            let place = bench.find(label).unwrap_or_else(|| panic!("{here}: no {label}")).rect;
            assert!(whole(&bench).contains_rect(place), "{here}: {label} at {place:?}");
            assert!(place.height() >= 30.0 && place.top() >= bench.area.rect.bottom(), "{here}: {label}");
        }
        bench.click("Scene");
        let lists = |bench: &Bench| bench.session.lesson.as_ref().is_some_and(|open| open.tree_open);
        assert!(lists(&bench) && bench.find("Next").is_none(), "{here}");
        bench.click("Lesson");
        assert!(!lists(&bench) && bench.find("Next").is_some(), "{here}");
        // In a presentation the picture is above, too.
        bench.apply(Action::View(ViewChange::Presenting(true)));
        bench.settle();
        let (picture, height) = (bench.area.rect, bench.ctx.content_rect().height());
        assert!(picture.height() >= 0.4 * height, "{here}: {picture:?}");
        assert_eq!(picture.width(), bench.ctx.content_rect().width(), "{here}");
        assert!(bench.find("Next").is_some_and(|next| whole(&bench).contains_rect(next.rect)), "{here}");
    }
}

#[test]
fn dialogs_and_lists_fit() {
    for (size, scale) in PHONES {
        let here = format!("{size:?} at {scale} %");
        let mut bench = bench(size, scale);
        let area = |bench: &Bench, id: &str| {
            let place = bench.ctx.memory(|memory| memory.area_rect(Id::new(id)));
            place.unwrap_or_else(|| panic!("{here}: no {id}"))
        };
        for (id, open, close) in [
            ("keys", ViewChange::Keys(true), ViewChange::Keys(false)),
            ("about", ViewChange::About(true), ViewChange::About(false)),
            ("finder", ViewChange::Finder(true), ViewChange::Finder(false)),
        ] {
            bench.apply(Action::View(open));
            bench.settle();
            let place = area(&bench, id);
            assert!(whole(&bench).contains_rect(place), "{here}: {id} at {place:?}");
            bench.apply(Action::View(close));
        }
        bench.apply(Action::Take(TakeCommand::Ask(Taken::Picture(None))));
        bench.settle();
        let place = area(&bench, "take draft");
        assert!(whole(&bench).contains_rect(place), "{here}: {place:?}");
        bench.apply(Action::Take(TakeCommand::Close));
        bench.apply(Action::Edit(Edit::set(Part::Scene, Scene::shading_model, "flat")));
        bench.apply(Action::Quit);
        bench.settle();
        let place = area(&bench, "question");
        assert!(whole(&bench).contains_rect(place), "{here}: {place:?}");
        for label in ["Save", "Don't save", "Cancel"] {
            let button = bench.find(label).unwrap_or_else(|| panic!("{here}: no {label}")).rect;
            assert!(place.contains_rect(button) && button.height() >= THUMB - 0.1, "{here}: {label}");
        }
    }
}

#[test]
fn a_window_of_640_points_has_its_panels_beside_the_picture() {
    let mut bench = bench([640.0, 844.0], 100);
    bench.apply(Action::Select(Selection::Room));
    assert!(!bench.session.view.narrow && bench.area.rect.left() > 90.0);
    bench.size.x = 620.0;
    bench.settle();
    assert!(bench.session.view.narrow && bench.area.rect.left() == 0.0);
}
