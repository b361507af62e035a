//! Fits to a measurement in the window: by one click, and of every model, listed by what remains.

use bevy::{app::PluginGroup as _, ecs::message::Messages};
use lights_camera_models::{
    matching::{
        Match, Measure, Metric, What,
        each::{Matched, Ranking},
    },
    panel::state::{Action, CompareCommand, Effect, MatchCommand, Running, Session, Severity},
    parameter::Value,
    registry::Registry,
    scene::{Scene, Variant, comparison::Layout},
    window::LabPlugins,
};

use crate::{library::plugins::app, window::panels::Bench};

/// The calculated measurement in view A, and perhaps another model in view B.
fn scene(other: Option<&str>) -> Scene {
    let of = |model: &str| Variant { reflection_model: Some(model.to_owned()), ..Variant::default() };
    Scene {
        reflection_model: "measured_merl".to_owned(),
        variants: other.map(of).into_iter().collect(),
        ..Scene::default()
    }
}

fn bench(scene: Scene) -> Bench {
    let mut bench = Bench::new(Session::new(scene));
    if !bench.session.document.variants.is_empty() {
        bench.apply(Action::Compare(CompareCommand::Layout(Layout::SideBySide)));
    }
    bench.apply(Action::Compare(CompareCommand::Activate(0)));
    bench
}

/// What is asked of the app; other effects are not of interest.
fn asked(bench: &mut Bench) -> Vec<Effect> {
    let all = std::mem::take(&mut bench.effects);
    all.into_iter()
        .filter(|e| matches!(e, Effect::Match { .. } | Effect::MatchEvery { .. } | Effect::CancelMatch))
        .collect()
}

fn every(view: usize, metric: Metric) -> Effect {
    Effect::MatchEvery { view, measure: Measure { what: What::Lobe, metric } }
}

/// Two models, the first the nearest.
fn ranking() -> Ranking {
    let matched = |model, after, values| {
        let found = Match { values, before: 0.5, after, ..Match::default() };
        Matched { model, found }
    };
    Ranking {
        matched: vec![
            matched("ward", 0.01, vec![("k_s", Value::Number(0.4))]),
            matched("lambert", 0.2, vec![]),
        ],
        left_out: vec![],
        unfinished: vec!["openpbr"],
    }
}

#[test]
fn one_click_fits_the_model_beside_a_measurement() {
    let mut bench = bench(scene(Some("lambert")));
    bench.click("Fit to it");
    let expected = Effect::Match { view: 1, measure: Measure::default(), parameters: vec!["base_colour"] };
    assert_eq!(asked(&mut bench), std::slice::from_ref(&expected), "its colours are free too");
    // Not twice.
    bench.session.facts.matching = Some(Running { label: 1, done: 0.4, step: String::new() });
    bench.apply(Action::Match(MatchCommand::Fit));
    assert_eq!(asked(&mut bench), []);
    assert!(bench.session.messages.iter().any(|m| m.text.starts_with("A match is still running")));
    // The other way round, the views are swapped first.
    let mut other =
        self::bench(Scene { reflection_model: "lambert".to_owned(), ..scene(Some("measured_merl")) });
    let before = (*other.session.document).clone();
    other.apply(Action::Match(MatchCommand::Fit));
    assert_eq!(asked(&mut other), [expected]);
    assert_eq!(other.session.document.variants[0].reflection_model.as_deref(), Some("lambert"));
    other.apply(Action::Undo);
    assert_eq!(*other.session.document, before);
}

#[test]
fn nothing_is_fitted_where_nothing_was_measured() {
    for command in [MatchCommand::Fit, MatchCommand::Every(Measure::default())] {
        let mut bench = bench(Scene { reflection_model: "phong".to_owned(), ..scene(Some("ward")) });
        assert!(bench.find("Fit to it").is_none());
        bench.apply(Action::Match(command));
        assert_eq!(asked(&mut bench), []);
        assert!(bench.session.fits.is_none());
        assert!(
            bench.session.messages.iter().any(|m| m.text.starts_with("No view shows a measured surface"))
        );
    }
}

#[test]
fn every_model_is_listed_by_what_remains_and_a_click_shows_it_in_view_b() {
    let mut bench = bench(scene(None));
    // Without a model beside it, one click fits every model.
    bench.click("Fit to it");
    assert_eq!(asked(&mut bench), [every(0, Metric::Cosine)]);
    assert!(bench.says("Fits to a measurement"));
    bench.session.facts.ranking =
        Some(Running { label: (), done: 0.4, step: "Ward: trying α alone".to_owned() });
    bench.settle();
    assert!(bench.says("Fitting every model"));
    let texts = bench.texts();
    assert!(texts.iter().any(|t| t.starts_with("40 %") && t.ends_with("Ward: trying α alone")), "{texts:?}");
    bench.click("Cancel");
    assert_eq!(asked(&mut bench), [Effect::CancelMatch]);
    bench.session.facts.ranking = None;
    bench.session.ranked((0, Measure::default()), Some(ranking()), &bench.registry);
    bench.settle();
    let last = bench.session.messages.last().expect("it is said");
    assert!(
        last.text
            .starts_with("2 models fitted to the measurement of view A; Ward comes nearest. Error: 0.01"),
        "{}",
        last.text
    );
    assert!(bench.says("Cancelled: 1 model is not in the list."));
    let before = (*bench.session.document).clone();
    bench.click("Show the fit of Ward");
    let variant = &bench.session.document.variants[0];
    assert_eq!(variant.reflection_model.as_deref(), Some("ward"));
    assert_eq!(variant.material.0["k_s"], Value::Number(0.4));
    let default = Registry::builtin().material_parameter("alpha_x").expect("declared").default_value();
    assert_eq!(variant.material.0["alpha_x"], default, "it does not inherit what is for another model");
    // Another takes its place, and each is one step.
    bench.click("Show the fit of Lambert");
    assert_eq!(bench.session.document.variants.len(), 1);
    assert_eq!(bench.session.document.variants[0].reflection_model.as_deref(), Some("lambert"));
    bench.apply(Action::Undo);
    assert_eq!(bench.session.document.variants[0].reflection_model.as_deref(), Some("ward"));
    bench.apply(Action::Undo);
    assert_eq!(*bench.session.document, before);
    // Another metric ranks them again.
    bench.click("Metric: log");
    assert_eq!(asked(&mut bench), [every(0, Metric::Log)]);
    bench.apply(Action::Match(MatchCommand::CloseFits));
    assert!(!bench.says("Fits to a measurement"));
}

#[test]
fn a_fit_does_not_replace_a_measurement_in_view_b() {
    let mut bench = bench(Scene { reflection_model: "phong".to_owned(), ..scene(Some("measured_merl")) });
    bench.apply(Action::Match(MatchCommand::Every(Measure::default())));
    assert_eq!(asked(&mut bench), [every(1, Metric::Cosine)]);
    let fitted = bench.session.to_fit(1, &bench.registry);
    assert!(fitted.variants.is_empty() && fitted.reflection_model == "measured_merl", "{fitted:?}");
    bench.session.ranked((1, Measure::default()), Some(ranking()), &bench.registry);
    bench.apply(Action::Match(MatchCommand::Show("ward")));
    let models: Vec<_> = bench
        .session
        .document
        .variants
        .iter()
        .map(|v| v.reflection_model.as_deref().unwrap_or("none"))
        .collect();
    assert_eq!(models, ["measured_merl", "ward"]);
}

#[test]
fn the_fits_of_the_window_run_in_the_background_and_keep_what_they_have_when_cancelled() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("a.json");
    let text = lights_camera_models::scene::save::to_json(&scene(None), None, &Registry::builtin());
    std::fs::write(&file, text).expect("writable");
    let plugins = LabPlugins::default().scene(file).size(64, 36).exit_after(100_000).headless();
    let mut app = app(plugins.build(), |_| ());
    app.update();
    app.world_mut().resource_mut::<Messages<Effect>>().write(every(0, Metric::Log));
    let mut cancelled = false;
    for _ in 0..24_000 {
        app.update();
        let session = app.world().resource::<Session>();
        if let Some(ranking) = session.fits.as_ref().and_then(|fits| fits.ranking.clone()) {
            assert!(!ranking.matched.is_empty() && !ranking.unfinished.is_empty(), "{ranking:?}");
            assert_eq!(session.messages.last().map(|m| m.severity), Some(Severity::Info));
            assert!(session.facts.ranking.is_none());
            return;
        }
        let some = session.facts.ranking.as_ref().is_some_and(|running| running.done > 0.1);
        if some && !cancelled {
            cancelled = true;
            app.world_mut().resource_mut::<Messages<Effect>>().write(Effect::CancelMatch);
        }
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    panic!("the fits do not end");
}
