//! The shipped scenes in the window: menu, strip, small pictures.

use std::time::{Duration, Instant};

use bevy_egui::egui::{self, Event, Key, Modifiers, Shape, vec2};
use lights_camera_models::{
    document::Edit,
    panel::{
        preview::{self, Preview, Source},
        state::{
            Action, Answer, CompareCommand, EXPLAIN_TAB, Effect, ModelCommand, PLOTS_TAB, Pick, Question,
            SHADER_TAB, Session, ViewChange,
        },
    },
    parameter::Outside,
    reference::{self, LightSamples, Settings},
    registry::Registry,
    scene::{Part, Scene, examples::EXAMPLES},
};

use crate::window::panels::Bench;

/// Waits for work on a thread.
pub fn until(bench: &mut Bench, what: &str, mut is: impl FnMut(&mut Bench) -> bool) {
    let begin = Instant::now();
    while !is(bench) {
        assert!(begin.elapsed() < Duration::from_secs(120), "never {what}");
        std::thread::sleep(Duration::from_millis(10));
        bench.frame(Vec::new());
    }
    bench.settle();
}

#[test]
fn an_example_is_opened_from_the_menu_as_a_document_in_no_file() {
    let mut bench = Bench::new(Session::default());
    bench.click("File");
    bench.click("Examples ⏵");
    for example in EXAMPLES.iter() {
        assert!(
            bench.find(&format!("Example: {}", example.name)).is_some(),
            "{} is not listed",
            example.name
        );
    }
    bench.click("Example: Portrait");
    assert_eq!((bench.session.title().as_str(), bench.session.path.clone()), ("Portrait", None));
    assert!(!bench.session.is_dirty() && bench.find("Example: Portrait").is_none());
    assert!(bench.effects.contains(&Effect::DocumentChanged));
    // Saving asks for a path.
    let effects = bench.session.apply(Action::Save, &bench.registry);
    assert_eq!(effects, [Effect::Pick(Pick::Save)]);
}

#[test]
fn unsaved_changes_are_asked_about_before_an_example_is_opened() {
    let registry = Registry::builtin();
    for (answer, title) in [(Answer::Cancel, "Mine"), (Answer::Discard, "Portrait")] {
        let mut session = Session::default();
        session.apply(Action::Edit(Edit::set(Part::Scene, Scene::name, "Mine")), &registry);
        let portrait = EXAMPLES.iter().position(|e| e.name == "Portrait").expect("shipped");
        session.apply(Action::OpenExample(portrait), &registry);
        assert!(matches!(session.questions.open, Some(Question::Unsaved { .. })));
        assert_eq!(session.title(), "Mine");
        session.apply(Action::Answer(answer), &registry);
        assert_eq!(session.title(), title);
    }
}

#[test]
fn the_strip_stands_below_the_picture_and_escape_closes_it() {
    let mut bench = Bench::new(Session::default());
    bench.size = vec2(1280.0, 720.0);
    bench.settle();
    assert!(bench.find("Example: Portrait").is_none());
    let whole = bench.area.rect;
    bench.apply(Action::View(ViewChange::Examples(true)));
    let card = bench.find("Example: Shapes and lights").expect("a card").rect;
    let picture = bench.area.rect;
    assert!(picture.bottom() <= card.top() && whole.contains_rect(card), "{picture:?} {card:?}");
    assert!(picture.height() > 0.75 * whole.height(), "the picture keeps its room: {picture:?}");
    bench.click("Example: Shapes and lights");
    assert_eq!(bench.session.title(), "Shapes and lights");
    assert!(bench.session.view.examples_open, "one looks at several");
    bench.key(Key::Escape, Modifiers::NONE);
    assert!(!bench.session.view.examples_open);
    assert_eq!(bench.area.rect, whole);
}

#[test]
fn the_strip_closes_for_good_when_the_user_goes_on() {
    let start = || {
        let mut bench = Bench::new(Session::default());
        bench.size = vec2(1280.0, 720.0);
        bench.apply(Action::View(ViewChange::Examples(true)));
        assert!(bench.find("Example: Default scene").is_some());
        bench
    };
    let is_closed =
        |bench: &Bench| !bench.session.view.examples_open && bench.find("Example: Default scene").is_none();
    for tab in [EXPLAIN_TAB, PLOTS_TAB, SHADER_TAB] {
        let mut bench = start();
        bench.apply(Action::View(ViewChange::BottomTab(tab.to_owned())));
        assert!(is_closed(&bench), "{tab}");
        bench.apply(Action::View(ViewChange::Bottom(false)));
        assert!(is_closed(&bench), "{tab} is closed");
        // Who asks for it gets it.
        bench.apply(Action::View(ViewChange::Examples(true)));
        assert!(!is_closed(&bench), "{tab}");
    }
    let mut bench = start();
    bench.apply(Action::Compare(CompareCommand::Add));
    assert!(is_closed(&bench), "a second view");
    bench.apply(Action::Compare(CompareCommand::Remove(1)));
    assert!(is_closed(&bench), "one view again");
    let mut bench = start();
    bench.apply(Action::Model(ModelCommand::New));
    bench.apply(Action::Model(ModelCommand::Cancel));
    assert!(!is_closed(&bench), "nothing has begun");
    bench.apply(Action::Model(ModelCommand::New));
    bench.apply(Action::Model(ModelCommand::Create));
    assert!(is_closed(&bench), "a model");
}

#[test]
fn the_wheel_scrolls_the_strip_and_titles_are_whole() {
    for size in [vec2(1280.0, 720.0), vec2(1920.0, 1080.0)] {
        let mut bench = Bench::new(Session::default());
        bench.size = size;
        bench.apply(Action::View(ViewChange::Examples(true)));
        let left = |bench: &Bench| bench.find("Example: Default scene").expect("a card").rect.left();
        let before = left(&bench);
        let cut = |bench: &mut Bench| {
            let names: Vec<_> = EXAMPLES.iter().map(|e| e.name.as_str()).collect();
            let mut texts = 0;
            for shape in bench.shapes() {
                if let Shape::Text(text) = shape
                    && names.contains(&text.galley.text())
                {
                    assert!(!text.galley.elided, "{} at {size:?}", text.galley.text());
                    texts += 1;
                }
            }
            assert!(texts >= 5, "{texts}");
        };
        cut(&mut bench);
        let at = bench.find("Example: Shapes and lights").expect("a card").rect.center();
        bench.frame(vec![Event::PointerMoved(at)]);
        let wheel = Event::MouseWheel {
            unit: egui::MouseWheelUnit::Point,
            delta: vec2(0.0, -40_000.0),
            phase: egui::TouchPhase::Move,
            modifiers: Modifiers::NONE,
        };
        bench.frame(vec![wheel]);
        (0..10).for_each(|_| bench.settle());
        let visible = size.x - 208.0 - 344.0;
        let scrolls = EXAMPLES.len() as f32 * 120.0 > visible;
        assert!(!scrolls || left(&bench) < before - 50.0, "{} at {size:?}", left(&bench));
        cut(&mut bench);
        let last = EXAMPLES.last().expect("there are some");
        let card = bench.find(&format!("Example: {}", last.name)).expect("a card").rect;
        assert!(bench.area.rect.x_range().contains(card.center().x), "the last is reached");
    }
}

#[test]
fn titles_of_the_strip_are_clear_of_its_scroll_bar() {
    for scale in [100, 150] {
        let mut bench = Bench::new(Session::default());
        bench.size = vec2(1280.0, 720.0);
        bench.apply(Action::View(ViewChange::Scale(scale)));
        bench.apply(Action::View(ViewChange::Examples(true)));
        let shapes = bench.shapes();
        let bar = shapes.iter().filter_map(|shape| match shape {
            Shape::Rect(r) if (2.0..12.0).contains(&r.rect.height()) && r.rect.width() > 60.0 => Some(r.rect),
            _ => None,
        });
        let bar = bar.max_by(|a, b| a.top().total_cmp(&b.top())).expect("it scrolls");
        for shape in &shapes {
            if let Shape::Text(text) = shape
                && EXAMPLES.iter().any(|e| e.name == text.galley.text())
                && text.pos.y > bench.area.rect.bottom()
            {
                let title = text.visual_bounding_rect();
                assert!(
                    title.bottom() < bar.top(),
                    "{scale} %: {} at {title:?}, {bar:?}",
                    text.galley.text()
                );
            }
        }
    }
}

#[test]
fn the_menu_of_the_examples_does_not_scroll_where_there_is_room() {
    let mut bench = Bench::new(Session::default());
    bench.size = vec2(1920.0, 1080.0);
    bench.settle();
    bench.click("File");
    bench.click("Examples ⏵");
    let last = EXAMPLES.last().expect("there are some");
    let entry = bench.find(&format!("Example: {}", last.name)).expect("an entry").rect;
    let name = bench.shapes().into_iter().find_map(|shape| match shape {
        Shape::Text(text) if text.galley.text() == last.name => Some(text.visual_bounding_rect()),
        _ => None,
    });
    assert!(entry.bottom() <= 1080.0 && name.is_some_and(|name| entry.contains_rect(name)), "{entry:?}");
    // A widget that is scrolled out is not under the pointer.
    let layer = bench.ctx.layer_id_at(entry.center()).expect("a menu");
    assert_eq!(layer.order, egui::Order::Foreground, "{entry:?}");
}

#[test]
fn the_menu_of_the_examples_says_all_of_them_and_leaves_the_menu_before_it_free() {
    let mut bench = Bench::new(Session::default());
    bench.size = vec2(1280.0, 720.0);
    bench.apply(Action::View(ViewChange::Scale(150)));
    bench.click("File");
    bench.click("Examples ⏵");
    let file =
        bench.find("Quit").or(bench.tree.iter().find(|s| s.label.starts_with("Quit"))).expect("an entry");
    let first = bench.find("Example: Default scene").expect("an entry").rect;
    assert!(first.left() >= file.rect.right(), "{first:?} lies over {:?}", file.rect);
    assert!(first.right() < 1280.0 / 1.5, "{first:?}");
    let texts: Vec<_> = bench
        .shapes()
        .into_iter()
        .filter_map(|shape| match shape {
            Shape::Text(text) => Some(text.galley.clone()),
            _ => None,
        })
        .collect();
    let wraps = texts.iter().find(|t| t.text().starts_with("Left to right: Lambert")).expect("shown");
    assert!(!wraps.elided && wraps.text().ends_with("half-Lambert without the square."), "{}", wraps.text());
    assert!(texts.iter().all(|t| !t.text().contains("k_d") && !t.text().contains('`')));
}

#[test]
fn every_example_gets_its_small_picture() {
    let mut bench = Bench::new(Session::default());
    let registry = bench.registry.clone();
    until(&mut bench, "all pictures", |bench| {
        let ready = |i| match preview::of(&bench.ctx, &Source::Example(i), &registry, Outside::NONE) {
            Preview::Waiting => false,
            Preview::Ready(shown) => {
                assert_eq!(shown.name.as_deref(), Some(EXAMPLES[i].name.as_str()));
                // On a slow machine, one with many lights may take too long.
                i > 0 || shown.picture.is_some()
            }
            Preview::Failed(why) => panic!("{}: {why}", EXAMPLES[i].file),
        };
        (0..EXAMPLES.len()).all(ready)
    });
}

#[test]
fn a_picture_that_takes_too_long_is_given_up() {
    let (scene, registry) = (Scene::default(), Registry::builtin());
    let settings = Settings { width: 64, height: 36, ..Settings::default() };
    let whole = reference::render_rgb8(&scene, &registry, &settings);
    let end = Instant::now() + Duration::from_secs(600);
    let until = |end| reference::render_rgb8_until(&scene, &registry, &settings, LightSamples::of(1), end);
    assert_eq!(until(end), Some(whole));
    assert_eq!(until(Instant::now()), None);
}

#[cfg(target_os = "linux")]
#[test]
fn the_window_shows_the_examples_when_it_opens_without_a_file() {
    use crate::helpers::screen::Screen;
    let screen = Screen::new(1280, 720);
    // The strip has the colour of the panels where else the picture's surround would be.
    let panel =
        |p: &crate::helpers::screen::Picture| p.count(300..700, 553..561, |c| c == [21, 21, 21]) > 1500;
    let scene = format!("{}/scenes/default.json", env!("CARGO_MANIFEST_DIR"));
    screen.start(&["view", "--size", "1280x720"]).until("the examples", panel);
    let mut window = screen.start(&["view", &scene, "--size", "1280x720"]);
    window.until("the picture", |p| p.count(220..230, 60..600, |c| c == [46, 46, 46]) > 3000);
    assert!(!panel(&window.rest()));
}
