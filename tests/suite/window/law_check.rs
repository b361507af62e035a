//! The law check of the window: the button, the process behind it, and the result.

use std::{path::PathBuf, sync::mpsc, time::Duration};

use bevy_egui::egui::accesskit::Role;
use lights_camera_models::{
    library::{assets::Folders, status::Reloaded},
    panel::state::{Action, Effect, ModelCommand, Session, Severity, ViewChange},
    reflection::law_report::LawReport,
    window::laws::LawChecks,
};

use crate::{
    helpers::support::{lcm, root},
    window::panels::Bench,
};

/// The outcome for a model of a folder.
fn outcome(id: &str, folders: &Folders, program: Option<PathBuf>) -> Result<LawReport, String> {
    let checks = LawChecks::by(program);
    let (done, woken) = mpsc::channel();
    checks.begin(id, folders, move || {
        let _ = done.send(());
    });
    woken.recv_timeout(Duration::from_secs(200)).expect("there is an outcome");
    let (model, outcome) = checks.take().expect("it waits");
    assert_eq!(model, id);
    outcome
}

fn program() -> Option<PathBuf> {
    Some(PathBuf::from(env!("CARGO_BIN_EXE_lcm")))
}

#[test]
fn laws_are_checked_in_another_process_and_shown() {
    let mut bench = Bench::new(Session::default());
    bench.apply(Action::View(ViewChange::BottomTab("shader".to_owned())));
    bench.click("Check laws");
    assert_eq!(bench.effects, [Effect::CheckLaws("lambert".to_owned())]);
    bench.settle();
    assert!(bench.find("Check laws").expect("there").disabled && bench.says("Checking Lambert…"));
    bench.apply(Action::Model(ModelCommand::CheckLaws));
    assert_eq!(bench.effects.len(), 1, "one at a time");

    // A new user has no model folder yet.
    let nowhere = tempfile::tempdir().expect("a folder").path().join("models");
    let folders = Folders { models: Some(nowhere), ..Folders::default() };
    let found = outcome("lambert", &folders, program());
    assert_eq!(found.as_ref().map(|r| r.laws.len()), Ok(3), "{found:?}");
    bench.session.authoring.laws_checked("phong", found.clone());
    assert!(
        bench.session.authoring.laws.as_ref().is_some_and(|check| check.outcome.is_none()),
        "another model"
    );
    let mut broken = found.clone().expect("was checked");
    broken.laws[1].kept = false;
    bench.session.authoring.laws_checked("lambert", Ok(broken));
    bench.settle();
    assert!(bench.says("Energy conserving: claimed and broken") && bench.says("No errors, but broken laws"));
    bench.session.authoring.laws_checked("lambert", found);
    bench.settle();
    assert!(!bench.says("broken laws"));
    for law in ["Reciprocal", "Energy conserving", "Non-negative"] {
        assert!(bench.says(&format!("{law}: claimed and kept")), "{law}");
    }
    assert!(!bench.find("Check laws").expect("there").disabled);
    bench.session.shaders.last = Some(Reloaded { file: "terms.wgsl".to_owned(), milliseconds: 1.0 });
    bench.settle();
    assert!(bench.says("Findings from before the last change"));
    bench.session.authoring.laws_checked("lambert", Err("the check took longer than 120 s".to_owned()));
    bench.settle();
    assert!(bench.says("The laws were not checked: the check took longer"));
}

#[test]
fn a_note_is_in_sight_unless_the_messages_are() {
    let mut bench = Bench::new(Session::default());
    for tab in ["shader", "history", "messages"] {
        bench.apply(Action::View(ViewChange::BottomTab(tab.to_owned())));
        let advice = format!("Advice beside {tab}.");
        bench.apply(Action::Say(Severity::Info, advice.clone()));
        // In the status line, or in the list.
        let found = bench.tree.iter().filter(|s| s.role == Role::Label && s.label.contains(&advice));
        assert_eq!(found.count(), 1, "{tab}");
    }
}

#[test]
fn a_model_of_the_folder_that_breaks_a_law_is_shown_with_the_place() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = std::fs::read_to_string(root().join("assets/models/gooch.wgsl")).expect("there");
    let text = text.replace("\"laws\": [", "\"laws\": [\"reciprocal\", ");
    std::fs::write(folder.path().join("mine.wgsl"), text).expect("writable");
    let folders = Folders { models: Some(folder.path().to_owned()), ..Folders::default() };
    let report = outcome("mine", &folders, program()).expect("was checked");
    assert_eq!(report.broken(), ["reciprocal"]);
    assert!(report.laws[0].at[0].starts_with("at l (θ "), "{:?}", report.laws[0].at);
    // The reason is shown for a model that cannot be checked.
    std::fs::write(folder.path().join("mine.wgsl"), "/* lcm { } */\nfn response(").expect("writable");
    let why = outcome("mine", &folders, program()).expect_err("is broken");
    assert!(why.contains("this ( is not closed"), "{why}");
    let why = outcome("mine", &folders, Some("/nonexistent/lcm".into())).expect_err("is not there");
    assert!(why.contains("did not start"), "{why}");
    assert!(outcome("mine", &folders, None).is_err());
}

#[test]
fn the_command_gives_the_same_as_data() {
    let run = lcm(&["models", "check", "lambert", "--json"], "");
    let report: LawReport = serde_json::from_str(&run.out).expect("is a report");
    assert_eq!((run.status, report.model.as_str(), report.broken().len()), (Some(0), "lambert", 0));
}
