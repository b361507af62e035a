//! Lessons in the window, without a window: the panel, the user's own document kept aside, progress, ways to
//! start.

use std::collections::BTreeSet;

use bevy_egui::egui::{self, Key, Modifiers, PointerButton, Rect, Shape, accesskit::Role, pos2, vec2};
use lights_camera_models::{
    channel::DebugChannel,
    curves::Kind,
    document::{Edit, Selection},
    lesson::{Task, shipped::LESSONS},
    optics::TermSelection,
    panel::{
        self, effects,
        state::{
            Action, Answer, CameraChange, EXPLAIN_TAB, Effect, LessonCommand, LessonSource, Past, Pick, Pin,
            PlotCommand, Question, Session, ViewChange,
        },
        theme::DARK,
    },
    parameter::Value,
    registry::Registry,
    scene::{
        Part, Scene,
        load::{self, Defaults},
        save::{self, Expected},
    },
    window::files::DiskFiles,
};

use crate::window::panels::Bench;

const ALT: Modifiers = Modifiers::ALT;

/// A lesson with a step of each kind.
const TEXT: &str = r#"---
title: Light and angle
summary: How the angle of the light changes a colour.
minutes: 5
---

## The picture

Light that comes *straight* is bright: with k_d it is, see **F7**,

```equation
I_d = k_d max(0, N·L)
```

- one
- two

## Predict it

```predict
Which is brighter?
[ ] The left one. | It is turned away.
[x] The right one. | It faces the light.
```

## Do it

A shinier sphere.

```scene
shading_model = "phong"
reflection_model = "blinn_phong"
objects[0].material.alpha = 20
```

```view
select: object 1
channel: n_dot_l
```

```point
knob: alpha
menu: Help
```

```do
Raise the exponent above 100.
until: knob.alpha > 100
hint: It is the knob with the sign of the exponent.
```

## Find it

```view
channel: none
```

```find
Click a pixel of the sphere.
until: probe.background = false
```
"#;

/// A folder with the lesson as a file.
struct Desk {
    folder: tempfile::TempDir,
}

impl Desk {
    fn new() -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        std::fs::write(folder.path().join("light.md"), TEXT).expect("writable");
        Self { folder }
    }

    fn source(&self) -> LessonSource {
        LessonSource::File(self.folder.path().join("light.md"))
    }

    /// A window of 1280×720 with the lesson.
    fn bench(&self, session: Session) -> Bench {
        let mut bench = Bench::new(session);
        bench.size = vec2(1280.0, 720.0);
        self.open(&mut bench);
        bench
    }

    fn open(&self, bench: &mut Bench) {
        apply(bench, Action::Lesson(LessonCommand::Open(self.source())));
        assert!(bench.session.lesson.is_some(), "{:?}", bench.session.messages);
    }
}

/// Applies an action, and carries out the effects that need files.
fn apply(bench: &mut Bench, action: Action) -> Vec<Effect> {
    let mut files = DiskFiles::new(None, None);
    apply_with(bench, action, &mut files)
}

fn apply_with(bench: &mut Bench, action: Action, files: &mut DiskFiles) -> Vec<Effect> {
    let mut pending = bench.session.apply(action, &bench.registry);
    let mut done = Vec::new();
    while let Some(effect) = pending.pop() {
        done.push(effect.clone());
        // Nothing is written to the folders of whoever runs the tests.
        if matches!(effect, Effect::SaveProgress(_) | Effect::SaveSettings) {
            continue;
        }
        let more = effects::run(&mut bench.session, &bench.registry, effect.clone(), files);
        pending.extend(more.into_iter().filter(|e| *e != effect));
    }
    bench.settle();
    done
}

fn go(bench: &mut Bench, command: LessonCommand) -> Vec<Effect> {
    apply(bench, Action::Lesson(command))
}

fn evaluations(bench: &Bench) -> u64 {
    panel::lesson::check::evaluations(&bench.ctx)
}

fn step(bench: &Bench) -> usize {
    bench.session.lesson.as_ref().expect("a lesson").step
}

fn done(bench: &Bench) -> BTreeSet<usize> {
    bench.session.lesson.as_ref().expect("a lesson").done.clone()
}

fn edit_alpha(bench: &mut Bench, alpha: i64) {
    let edit = Edit::material(Part::Object(0), "alpha", Value::Integer(alpha));
    apply(bench, Action::Edit(edit));
}

/// A window with unsaved work, and with settings of the view.
fn busy() -> Session {
    let registry = Registry::builtin();
    let mut session = Session::new(Scene { name: Some("Mine".to_owned()), ..Scene::default() });
    for action in [
        Action::Edit(Edit::set(Part::Scene, Scene::reflection_model, "phong")),
        Action::Edit(Edit::set(Part::Scene, Scene::shading_model, "flat")),
        Action::Undo,
        Action::Select(Selection::Light(0)),
        Action::View(ViewChange::Terms(TermSelection::Diffuse)),
        Action::View(ViewChange::Channel(DebugChannel::next(None))),
        Action::View(ViewChange::Pin(Some(Pin::middle(0)))),
        Action::Plot(PlotCommand::Kind(Kind::Polar)),
        Action::Plot(PlotCommand::Light(70.0)),
        Action::Plot(PlotCommand::Pin),
    ] {
        session.apply(action, &registry);
    }
    session.path = Some("/scenes/mine.json".into());
    session
}

// ── the user's own document ──

#[test]
fn the_own_document_comes_back_with_all_that_belongs_to_it() {
    let desk = Desk::new();
    let before = busy();
    let mut bench = Bench::new(before.clone());
    bench.size = vec2(1280.0, 720.0);
    bench.settle();
    let before = bench.session.clone();
    assert!(before.is_dirty() && before.shows_unsaved());
    let steps: Vec<_> = before.document.steps().map(str::to_owned).collect();
    desk.open(&mut bench);
    let session = &bench.session;
    assert_eq!((session.title().as_str(), session.own_title().as_str()), ("Light and angle", "Mine"));
    assert!(session.is_dirty() && !session.shows_unsaved(), "the lesson’s scene is nobody’s loss");
    assert_eq!((session.path.clone(), session.own_path()), (None, before.path.as_deref()));
    assert_eq!(session.own_document().revision(), before.document.revision());
    assert!(session.document.steps().len() == 0 && session.view.terms == TermSelection::All);
    assert!(
        session.view.channels == [None; 4] && session.view.pinned.is_none() && session.plots.pins.is_empty()
    );
    // All of it is changed there.
    for _ in 0..2 {
        go(&mut bench, LessonCommand::Next);
    }
    go(&mut bench, LessonCommand::Next);
    for action in [
        Action::Edit(Edit::set(Part::Scene, Scene::reflection_model, "lambert")),
        Action::AddObject("cube".to_owned()),
        Action::View(ViewChange::Terms(TermSelection::Specular)),
        Action::Plot(PlotCommand::Light(3.0)),
        Action::Plot(PlotCommand::Pin),
        Action::View(ViewChange::BottomTab("history".to_owned())),
    ] {
        apply(&mut bench, action);
    }
    let effects = go(&mut bench, LessonCommand::Leave);
    assert!(effects.contains(&Effect::Camera(CameraChange::Exchange)), "{effects:?}");
    let after = &bench.session;
    assert!(after.lesson.is_none());
    assert_eq!(after.document.revision(), before.document.revision(), "the very same value");
    assert_eq!(after.document.steps().map(str::to_owned).collect::<Vec<_>>(), steps);
    assert_eq!(after.document.done(), before.document.done());
    assert_eq!((&after.path, after.selection, &after.disk), (&before.path, before.selection, &before.disk));
    assert_eq!((&after.plots, &after.model_slots), (&before.plots, &before.model_slots));
    assert_eq!(after.view, before.view);
    assert!(after.is_dirty() && after.shows_unsaved());
    bench.apply(Action::Redo);
    assert_eq!(bench.session.document.shading_model, "flat");
    for _ in 0..2 {
        bench.apply(Action::Undo);
    }
    assert!(!bench.session.is_dirty(), "back to what the file has");
}

#[test]
fn opening_a_lesson_within_a_lesson_keeps_the_own_document() {
    let desk = Desk::new();
    let mut bench = desk.bench(busy());
    edit_alpha(&mut bench, 7);
    desk.open(&mut bench);
    assert_eq!(bench.session.own_title(), "Mine");
    go(&mut bench, LessonCommand::Leave);
    assert_eq!(bench.session.title(), "Mine");
}

#[test]
fn what_would_lose_the_own_document_asks_about_it_and_not_about_the_lesson() {
    let desk = Desk::new();
    for action in [
        Action::New,
        Action::Quit,
        Action::OpenExample(0),
        Action::OpenDialog,
        Action::Open("/scenes/other.json".into()),
    ] {
        let mut bench = desk.bench(busy());
        go(&mut bench, LessonCommand::Next);
        edit_alpha(&mut bench, 7);
        let scene = bench.session.document.scene().clone();
        let effects = bench.session.apply(action.clone(), &bench.registry);
        assert_eq!(effects, [Effect::Camera(CameraChange::Exchange)], "{action:?}");
        assert!(matches!(bench.session.questions.open, Some(Question::Unsaved { .. })));
        // The question refers to what is on screen.
        assert_eq!((bench.session.title().as_str(), bench.session.lesson.is_none()), ("Mine", true));
        bench.settle();
        assert!(bench.says("“Mine” has unsaved changes.") && !bench.says("Step 2 of 4"));
        bench.apply(Action::Answer(Answer::Cancel));
        assert_eq!(
            (step(&bench), bench.session.document.scene()),
            (1, &scene),
            "{action:?}: the lesson goes on"
        );
        assert_eq!(bench.session.own_title(), "Mine");
        // When given up, the document is discarded.
        bench.session.apply(action.clone(), &bench.registry);
        let effects = bench.session.apply(Action::Answer(Answer::Discard), &bench.registry);
        match action {
            Action::Quit => assert!(effects.contains(&Effect::Quit)),
            Action::OpenDialog => {
                assert!(effects.contains(&Effect::Pick(Pick::Open)));
                bench.settle();
                assert!(bench.session.lesson.is_none(), "while the dialog may still be cancelled");
                bench.session.questions.not_opened();
                bench.settle();
                assert_eq!(step(&bench), 1);
            }
            Action::Open(path) => {
                assert!(effects.contains(&Effect::OpenFile(path.clone())));
                assert_eq!(step(&bench), 1, "a file that is broken costs nothing");
                let _ = bench.session.opened(path, Scene::default());
                assert!(bench.session.lesson.is_none());
                assert!(!bench.session.is_dirty());
            }
            _ => {
                assert!(bench.session.lesson.is_none() && !bench.session.is_dirty(), "{action:?}");
                assert_ne!(bench.session.title(), "Mine");
            }
        }
    }
}

#[test]
fn without_unsaved_changes_another_scene_ends_the_lesson_at_once() {
    let desk = Desk::new();
    for action in [Action::New, Action::OpenExample(0)] {
        let mut bench = desk.bench(Session::default());
        go(&mut bench, LessonCommand::GoTo(2));
        edit_alpha(&mut bench, 7);
        let effects = bench.session.apply(action.clone(), &bench.registry);
        assert!(effects.contains(&Effect::DocumentChanged), "{action:?}");
        assert!(bench.session.lesson.is_none() && bench.session.questions.open.is_none());
        assert!(bench.session.view.channels == [None; 4] && !bench.session.is_dirty());
    }
    let mut bench = desk.bench(Session::default());
    assert!(bench.session.apply(Action::Quit, &bench.registry).contains(&Effect::Quit));
}

#[test]
fn saving_in_a_lesson_writes_a_copy_and_the_own_file_stays_known() {
    let desk = Desk::new();
    let registry = Registry::builtin();
    let own = desk.folder.path().join("own.json");
    let stamp = save::write(&own, &Scene::default(), &registry, Expected::Nothing).expect("written");
    let mut files = DiskFiles::new(Some(own.clone()), Some(stamp));
    let mut session = Session::default();
    session.path = Some(own.clone());
    let mut bench = desk.bench(session);
    bench.session.lesson.as_ref().expect("a lesson");
    apply(&mut bench, Action::Edit(Edit::set(Part::Scene, Scene::reflection_model, "phong")));
    assert_eq!(bench.session.apply(Action::Save, &registry), [Effect::Pick(Pick::Save)]);
    let copy = desk.folder.path().join("copy.json");
    apply_with(&mut bench, Action::SaveAs(copy.clone()), &mut files);
    let read = load::file(&copy, &registry, Defaults::Refuse).expect("legal").scene;
    assert_eq!(read.reflection_model, "phong");
    assert!(bench.says("A copy of this scene was saved to") && bench.session.lesson.is_some());
    assert_eq!((bench.session.path.clone(), bench.session.own_path()), (None, Some(own.as_path())));
    // It is replaced only after a question.
    let typed = desk.folder.path().join("copy");
    apply_with(&mut bench, Action::SaveAs(typed), &mut files);
    assert_eq!(bench.session.questions.open, Some(Question::ReplaceScene(copy.clone())));
    assert!(bench.says("Replace it with a copy of this scene?"));
    apply_with(
        &mut bench,
        Action::Edit(Edit::set(Part::Scene, Scene::reflection_model, "lambert")),
        &mut files,
    );
    apply_with(&mut bench, Action::Answer(Answer::Overwrite), &mut files);
    assert_eq!(
        load::file(&copy, &registry, Defaults::Refuse).expect("legal").scene.reflection_model,
        "lambert"
    );
    // Back in the document, saving needs no question.
    go(&mut bench, LessonCommand::Leave);
    apply(&mut bench, Action::Edit(Edit::set(Part::Scene, Scene::shading_model, "phong")));
    apply_with(&mut bench, Action::Save, &mut files);
    assert!(bench.session.questions.open.is_none() && !bench.session.is_dirty());
    assert_eq!(load::file(&own, &registry, Defaults::Refuse).expect("legal").scene.shading_model, "phong");
}

#[test]
fn the_own_file_replaces_nothing_while_a_lesson_is_shown_and_is_looked_at_afterwards() {
    let desk = Desk::new();
    let registry = Registry::builtin();
    let own = desk.folder.path().join("own.json");
    let stamp = save::write(&own, &Scene::default(), &registry, Expected::Nothing).expect("written");
    let mut files = DiskFiles::new(Some(own.clone()), Some(stamp));
    let mut session = Session::default();
    session.path = Some(own.clone());
    let mut bench = desk.bench(session);
    let news = Scene { shading_model: "flat".to_owned(), ..Scene::default() };
    save::write(&own, &news, &registry, Expected::Anything).expect("written");
    let look = Effect::CheckFile { discard: false };
    let before = bench.session.document.revision();
    assert_eq!(effects::run(&mut bench.session, &registry, look.clone(), &mut files), []);
    assert_eq!(bench.session.document.revision(), before);
    go(&mut bench, LessonCommand::Leave);
    assert_eq!(effects::run(&mut bench.session, &registry, look, &mut files), []);
    assert_eq!(bench.session.document.shading_model, "flat");
}

// ── steps ──

#[test]
fn previous_and_again_begin_a_step_as_it_began() {
    let desk = Desk::new();
    let mut bench = desk.bench(Session::default());
    // The learner's changes are kept.
    apply(&mut bench, Action::Edit(Edit::set(Part::Scene, Scene::description, "changed")));
    go(&mut bench, LessonCommand::Next);
    let description = |bench: &Bench| bench.session.document.description.clone();
    assert_eq!((step(&bench), description(&bench).as_deref()), (1, Some("changed")));
    go(&mut bench, LessonCommand::GoTo(2));
    let alpha = |bench: &Bench| bench.session.document.objects[0].material.0.get("alpha").cloned();
    assert_eq!(alpha(&bench), Some(Value::Integer(20)));
    assert_eq!(bench.session.document.reflection_model, "blinn_phong");
    assert_eq!(bench.session.selection, Selection::Object(0));
    let channel = |bench: &Bench| bench.session.channel_of(0).map(|channel| channel.id());
    assert_eq!(channel(&bench), Some("n_dot_l"));
    assert_eq!(bench.session.document.steps().len(), 0, "nothing to undo at the beginning of a step");
    edit_alpha(&mut bench, 21);
    apply(&mut bench, Action::View(ViewChange::Channel(None)));
    go(&mut bench, LessonCommand::Again);
    assert_eq!((alpha(&bench), channel(&bench)), (Some(Value::Integer(20)), Some("n_dot_l")));
    edit_alpha(&mut bench, 22);
    for _ in 0..2 {
        go(&mut bench, LessonCommand::Next);
    }
    assert_eq!((step(&bench), alpha(&bench), channel(&bench)), (3, Some(Value::Integer(22)), None));
    go(&mut bench, LessonCommand::Previous);
    assert_eq!(
        (step(&bench), alpha(&bench), channel(&bench)),
        (2, Some(Value::Integer(20)), Some("n_dot_l"))
    );
    for _ in 0..3 {
        go(&mut bench, LessonCommand::Previous);
    }
    assert_eq!(step(&bench), 0);
}

#[test]
fn a_step_whose_scene_cannot_follow_begins_from_the_start() {
    let desk = Desk::new();
    let cube = "```scene\nobjects[1] = {\"type\": \"cube\", \"position\": [2, 5, 5], \"size\": 1}\n```\n\n```predict";
    let text =
        TEXT.replace("```predict", cube).replace("objects[0].material.alpha = 20", "objects[1].size = 2");
    std::fs::write(desk.folder.path().join("light.md"), text).expect("writable");
    let mut bench = desk.bench(Session::default());
    go(&mut bench, LessonCommand::Next);
    apply(&mut bench, Action::Remove(Selection::Object(1)));
    assert_eq!(bench.session.document.objects.len(), 1);
    for _ in 0..2 {
        go(&mut bench, LessonCommand::Next);
    }
    let objects = &bench.session.document.objects;
    assert_eq!((step(&bench), objects.len(), objects[1].size), (2, 2, 2.0));
}

#[test]
fn the_text_is_set_and_the_footer_and_the_own_scene_are_named() {
    let desk = Desk::new();
    let bench = desk.bench(busy());
    for words in [
        "Light and angle",
        "Step 1 of 4",
        "The picture",
        "Light that comes straight is bright: with kd it is, see F7,",
        "one",
        "I_d = k_d max(0, N·L)",
        "Leave the lesson: “Mine” comes back",
        "Begin this step again",
        "Scene list",
    ] {
        assert!(bench.says(words), "{words}");
    }
    let named = |label: &str| bench.find(label).unwrap_or_else(|| panic!("nothing is called {label}"));
    assert!(named("Previous").disabled && !named("Next").disabled);
    assert_eq!(named("Next").role, Role::Button);
}

#[test]
fn an_answer_is_chosen_by_mouse_or_key_and_only_the_right_one_does_the_task() {
    let desk = Desk::new();
    let mut bench = desk.bench(Session::default());
    bench.click("Next");
    assert_eq!(step(&bench), 1);
    assert!(!bench.says("It is turned away."));
    bench.click("The left one.");
    assert!(bench.says("It is turned away.") && bench.says("The left one.: wrong") && !bench.says("Done"));
    // Unmistakable: in words, and in the colour of errors; and it is counted.
    assert!(bench.says("Wrong. Try another answer.") && bench.says("1 try"));
    let error = DARK.error;
    let row = bench.find("The left one.: wrong").expect("an answer").rect;
    assert!(bench.shapes().into_iter().any(|shape| matches!(
        shape, Shape::Rect(r) if r.rect == row && r.stroke.color == error && r.stroke.width >= 2.0
    )));
    assert!(done(&bench).is_empty());
    // By keyboard: into the lesson, to the answer, Enter.
    bench.key(Key::F6, Modifiers::NONE);
    bench.key(Key::F6, Modifiers::NONE);
    for _ in 0..20 {
        if focused(&bench) == "The right one." {
            break;
        }
        bench.key(Key::Tab, Modifiers::NONE);
    }
    bench.key(Key::Enter, Modifiers::NONE);
    assert!(bench.says("It faces the light.") && bench.says("The right one.: right") && bench.says("Done"));
    assert_eq!(done(&bench), [1].into());
    assert!(bench.says("Right.") && bench.says("2 tries") && !bench.says("Wrong. Try another answer."));
    // It is kept, and further views of an answer do not count.
    bench.click("The left one.: wrong");
    let past = bench.session.progress.lessons.values().next().expect("it is kept").clone();
    assert_eq!(past.tries, [(1, 2)].into());
    assert!(bench.says("2 tries"));
}

#[test]
fn next_asks_before_a_task_is_skipped_and_the_step_is_not_done() {
    let desk = Desk::new();
    let mut bench = desk.bench(Session::default());
    bench.click("Next");
    bench.click("Next");
    assert_eq!(step(&bench), 1);
    assert!(bench.says("The task is not done. Skip it?"));
    bench.click("The left one.");
    assert!(!bench.says("Skip it?"), "whoever answers does not skip");
    bench.click("Next");
    bench.click("Skip the task");
    assert_eq!((step(&bench), done(&bench).len()), (2, 0));
    // A step without a task never asks, nor does one that is done.
    go(&mut bench, LessonCommand::GoTo(1));
    bench.click("The right one.");
    bench.click("Next");
    assert_eq!((step(&bench), done(&bench)), (2, [1].into()));
}

#[test]
fn a_condition_that_holds_marks_the_step_and_is_looked_at_when_something_changed() {
    let desk = Desk::new();
    let mut bench = desk.bench(Session::default());
    go(&mut bench, LessonCommand::GoTo(2));
    assert!(bench.says("Raise the exponent above 100.") && !bench.says("It is the knob"));
    bench.click("Show a hint");
    assert!(bench.says("It is the knob with the sign of the exponent.") && bench.says("Hide the hint"));
    let looked = evaluations(&bench);
    bench.settle();
    assert_eq!(evaluations(&bench), looked, "at rest nothing is calculated");
    edit_alpha(&mut bench, 100);
    assert!(done(&bench).is_empty() && evaluations(&bench) > looked);
    edit_alpha(&mut bench, 101);
    assert_eq!(done(&bench), [2].into());
    assert!(bench.says("Done") && bench.says("It is the knob"), "the hint stays open");
    let looked = evaluations(&bench);
    edit_alpha(&mut bench, 5);
    assert_eq!(done(&bench), [2].into(), "once done, it stays done");
    assert_eq!(evaluations(&bench), looked);
}

#[test]
fn a_task_that_is_not_done_says_which_part_fails_once_something_was_done() {
    let desk = Desk::new();
    let mut bench = desk.bench(Session::default());
    go(&mut bench, LessonCommand::GoTo(2));
    let said = |bench: &mut Bench, text: &str| {
        bench.shapes().iter().any(|shape| matches!(shape, Shape::Text(t) if t.galley.text() == text))
    };
    assert!(!bench.says("Not yet: "), "nothing was tried yet");
    bench.click("Show a hint");
    assert!(!bench.says("Not yet: "), "to ask is not to try");
    edit_alpha(&mut bench, 50);
    assert!(said(&mut bench, "Not yet: the shininess α is 50; it must be above 100."));
    edit_alpha(&mut bench, 99);
    assert!(said(&mut bench, "Not yet: the shininess α is 99; it must be above 100."));
    go(&mut bench, LessonCommand::Again);
    assert!(!bench.says("Not yet: "), "the step begins again");
    edit_alpha(&mut bench, 101);
    assert!(!bench.says("Not yet: ") && done(&bench) == [2].into());
}

#[test]
fn a_quantity_without_a_value_says_why_and_a_click_finds_the_pixel() {
    let desk = Desk::new();
    let mut bench = desk.bench(Session::default());
    go(&mut bench, LessonCommand::GoTo(3));
    assert!(bench.says("Click a pixel of the sphere.") && bench.says("Not yet: "));
    let rect = bench.area.rect;
    bench.click_at(rect.left_top() + vec2(30.0, 200.0), PointerButton::Primary);
    assert!(bench.session.view.pinned.is_some() && done(&bench).is_empty(), "the background");
    assert!(bench.session.explains(), "the numbers of the pixel are in sight");
    bench.settle();
    let rect = bench.area.rect;
    bench.click_at(rect.center() + vec2(10.0, 10.0), PointerButton::Primary);
    assert_eq!(done(&bench), [3].into());
    // Then clicks only select again.
    let pinned = bench.session.view.pinned;
    bench.click_at(rect.center() + vec2(-20.0, 10.0), PointerButton::Primary);
    assert_eq!(bench.session.view.pinned, pinned);
}

#[test]
fn the_last_step_finishes_the_lesson_and_it_begins_anew() {
    let desk = Desk::new();
    let mut bench = desk.bench(busy());
    go(&mut bench, LessonCommand::GoTo(3));
    assert!(bench.says("Finish"));
    bench.click("Finish");
    bench.click("Skip the task");
    assert!(bench.session.lesson.is_none() && bench.session.title() == "Mine");
    assert!(bench.says("You have finished “Light and angle”. You did 0 of 3 tasks."));
    let past = bench.session.progress.of(&desk.source().name()).expect("kept").clone();
    assert_eq!((past.finished, past.step, past.words().as_str()), (true, 0, "finished"));
    desk.open(&mut bench);
    assert_eq!((step(&bench), done(&bench).len()), (0, 0));
}

// ── progress ──

#[test]
fn a_lesson_goes_on_where_it_was_left() {
    let desk = Desk::new();
    let mut bench = desk.bench(Session::default());
    go(&mut bench, LessonCommand::Next);
    go(&mut bench, LessonCommand::Answer(1));
    let effects = go(&mut bench, LessonCommand::Next);
    let name = desk.source().name();
    assert!(effects.contains(&Effect::SaveProgress(name.clone())));
    let progress = bench.session.progress.clone();
    assert_eq!(progress.last.as_deref(), Some(name.as_str()));
    let past = Past {
        title: "Light and angle".to_owned(),
        step: 2,
        steps: 4,
        done: [1].into(),
        tries: [(1, 1)].into(),
        ..Past::default()
    };
    assert_eq!(progress.of(&name), Some(&past));
    assert_eq!(progress.next(), Some(desk.source()));
    // Another day.
    let mut session = Session::default();
    session.progress = progress;
    let mut bench = Bench::new(session);
    desk.open(&mut bench);
    assert_eq!((step(&bench), done(&bench)), (2, [1].into()));
    assert_eq!(bench.session.document.reflection_model, "blinn_phong", "with the scenes of the steps before");
    assert!(bench.session.channel_of(0).is_some());
}

#[test]
fn progress_beyond_the_end_of_a_lesson_that_became_shorter_is_no_harm() {
    let desk = Desk::new();
    let mut session = Session::default();
    let past = Past { step: 99, steps: 100, done: [7, 98].into(), ..Past::default() };
    session.progress.lessons.insert(desk.source().name(), past);
    let bench = desk.bench(session);
    assert_eq!(step(&bench), 3);
}

// ── a teacher’s own ──

#[test]
fn a_lesson_with_problems_is_not_opened_and_every_problem_is_said() {
    let desk = Desk::new();
    let file = desk.folder.path().join("broken.md");
    std::fs::write(
        &file,
        TEXT.replace("knob.alpha >", "knob.alpha >>").replace("## The picture", "### The picture"),
    )
    .expect("writable");
    let mut bench = Bench::new(busy());
    let open = LessonCommand::Open(LessonSource::File(file.clone()));
    go(&mut bench, open);
    assert!(bench.session.lesson.is_none() && bench.session.title() == "Mine");
    let said: Vec<_> = bench.session.messages.iter().map(|note| note.text.clone()).collect();
    assert!(said.iter().filter(|text| text.contains("broken.md")).count() >= 3, "{said:?}");
    let line = TEXT.lines().position(|line| line.starts_with("until: knob.alpha")).expect("there") + 1;
    assert!(said.iter().any(|text| text.contains(&format!(":{line}:"))), "{said:?}");
    // Nor is a nonexistent one.
    go(&mut bench, LessonCommand::Open(LessonSource::File("/nowhere/x.md".into())));
    assert!(bench.session.messages.last().is_some_and(|note| note.text.contains("/nowhere/x.md")));
}

#[test]
fn an_edited_lesson_is_read_again_and_keeps_the_step() {
    let desk = Desk::new();
    let mut bench = desk.bench(busy());
    go(&mut bench, LessonCommand::GoTo(2));
    edit_alpha(&mut bench, 33);
    let file = desk.folder.path().join("light.md");
    let write = |text: &str| std::fs::write(&file, text).expect("writable");
    let look = |bench: &mut Bench| {
        let mut files = DiskFiles::new(None, None);
        let effects =
            effects::run(&mut bench.session, &Registry::builtin(), Effect::LookAtLesson, &mut files);
        bench.settle();
        effects
    };
    write(&TEXT.replace("A shinier sphere.", "A much shinier sphere."));
    look(&mut bench);
    assert!(bench.says("A much shinier sphere."));
    let alpha = |bench: &Bench| bench.session.document.objects[0].material.0.get("alpha").cloned();
    assert_eq!((step(&bench), alpha(&bench)), (2, Some(Value::Integer(33))), "text alone changes no scene");
    // With errors the last valid version stays, and they are reported where the author looks.
    write(&TEXT.replace("knob.alpha >", "knob.alpha >>"));
    look(&mut bench);
    assert!(bench.says("A much shinier sphere.") && bench.says("The file has errors"));
    let line = TEXT.lines().position(|line| line.starts_with("until: knob.alpha")).expect("there") + 1;
    assert!(
        bench.says(&format!("light.md:{line}:")),
        "{:?}",
        bench.session.lesson.as_ref().map(|l| &l.problems)
    );
    write(&TEXT.replace("alpha = 20", "alpha = 60"));
    look(&mut bench);
    assert!(!bench.says("The file has errors"));
    assert_eq!((step(&bench), alpha(&bench)), (2, Some(Value::Integer(60))), "its scene is another one");
    assert_eq!(bench.session.own_title(), "Mine");
    // Steps may be removed.
    write(TEXT.split("## Do it").next().expect("text"));
    look(&mut bench);
    assert_eq!((step(&bench), bench.session.lesson.as_ref().expect("open").lesson.steps.len()), (1, 2));
    let before = bench.session.lesson.as_ref().map(|open| open.step);
    std::fs::remove_file(&file).expect("removed");
    look(&mut bench);
    assert_eq!(bench.session.lesson.as_ref().map(|open| open.step), before);
    assert!(bench.says("The file has errors"));
}

// ── keys and focus ──

fn focused(bench: &Bench) -> String {
    let id = bench.ctx.memory(egui::Memory::focused);
    let rect = id.and_then(|id| bench.ctx.viewport(|v| v.prev_pass.widgets.get(id).map(|w| w.rect)));
    let Some(rect) = rect else { return String::new() };
    let near = |seen: &Rect| (seen.min - rect.min).length() + (seen.max - rect.max).length() < 2.0;
    bench
        .tree
        .iter()
        .find(|seen| !seen.label.is_empty() && near(&seen.rect))
        .map_or_else(String::new, |s| s.label.clone())
}

#[test]
fn every_key_of_lessons() {
    let desk = Desk::new();
    let mut bench = desk.bench(Session::default());
    bench.key(Key::ArrowRight, ALT);
    assert_eq!(step(&bench), 1);
    bench.key(Key::ArrowLeft, ALT);
    assert_eq!(step(&bench), 0);
    // F6 leads to the next button, and Enter continues.
    bench.key(Key::F6, Modifiers::NONE);
    bench.key(Key::F6, Modifiers::NONE);
    assert_eq!(focused(&bench), "Next");
    for _ in 0..3 {
        bench.key(Key::Enter, Modifiers::NONE);
    }
    assert_eq!(step(&bench), 2, "the second Enter asked");
    assert_eq!(focused(&bench), "Next");
    // In a presentation also the keys of a remote control.
    bench.key(Key::F5, Modifiers::NONE);
    bench.effects.clear();
    bench.key(Key::PageUp, Modifiers::NONE);
    assert_eq!(step(&bench), 1);
    bench.key(Key::PageDown, Modifiers::NONE);
    bench.key(Key::PageDown, Modifiers::NONE);
    assert_eq!(step(&bench), 2);
    assert!(!bench.effects.iter().any(|effect| matches!(effect, Effect::Steer(_))));
    // The first Escape leaves the button.
    bench.key(Key::Escape, Modifiers::NONE);
    bench.key(Key::Escape, Modifiers::NONE);
    assert!(!bench.session.view.presenting && bench.session.lesson.is_some());
    // Without a lesson they report it.
    go(&mut bench, LessonCommand::Leave);
    bench.key(Key::ArrowRight, ALT);
    assert!(bench.says("No lesson is open: Help › Lessons lists them."));
}

#[test]
fn page_keys_scroll_long_text_and_the_footer_stays() {
    let desk = Desk::new();
    let long =
        TEXT.replace("- one", &"Words and words and words, more than the panel has room for.\n\n".repeat(40));
    std::fs::write(desk.folder.path().join("light.md"), long).expect("writable");
    for (size, scale) in [((1280.0, 720.0), 100), ((1280.0, 720.0), 150), ((1920.0, 1080.0), 200)] {
        let mut bench = Bench::new(Session::default());
        bench.size = size.into();
        bench.apply(Action::View(ViewChange::Scale(scale)));
        desk.open(&mut bench);
        let heading = |bench: &Bench| bench.find("The picture").map(|seen| seen.rect.top());
        let (top, next) = (heading(&bench).expect("in sight"), bench.find("Next").expect("a button").rect);
        assert!(next.bottom() < bench.size.y / bench.ctx.zoom_factor());
        bench.key(Key::PageDown, Modifiers::NONE);
        assert_eq!(heading(&bench), Some(top), "the key is the camera’s");
        bench.key(Key::F6, Modifiers::NONE);
        bench.key(Key::F6, Modifiers::NONE);
        bench.key(Key::PageDown, Modifiers::NONE);
        (0..20).for_each(|_| bench.frame(Vec::new()));
        assert!(
            heading(&bench).is_none_or(|now| now < top - 100.0),
            "{size:?} {scale}: {:?}",
            heading(&bench)
        );
        assert_eq!(bench.find("Next").expect("a button").rect, next);
        // The next step begins at its top.
        bench.key(Key::Enter, Modifiers::NONE);
        let place = bench.find("Predict it").expect("in sight").rect.top();
        assert!((place - top).abs() < 1.0, "{place} {top}");
    }
}

#[test]
fn the_reason_of_an_answer_is_scrolled_into_sight() {
    let lamp = LESSONS.iter().position(|lesson| lesson.id.starts_with("09")).expect("a lesson");
    for (step, answer, reason) in [(0, 1, "That is why the equations"), (4, 0, "The highlight is its mirror")]
    {
        let mut bench = Bench::new(Session::default());
        bench.size = vec2(1280.0, 720.0);
        go(&mut bench, LessonCommand::Open(LessonSource::Shipped(lamp)));
        go(&mut bench, LessonCommand::GoTo(step));
        go(&mut bench, LessonCommand::Answer(answer));
        (0..30).for_each(|_| bench.frame(Vec::new()));
        let next = bench.find("Next").expect("a button").rect;
        let texts = bench.texts_in_sight();
        let place =
            |start: &str| texts.iter().find(|(text, _)| text.starts_with(start)).map(|(_, place)| *place);
        let (verdict, reason) = (place("Right.").expect("in sight"), place(reason).expect("in sight"));
        assert!(verdict.top() > 60.0 && reason.bottom() <= next.top(), "{step}: {verdict} {reason} {next}");
    }
}

#[test]
fn after_a_wrong_answer_the_others_are_in_sight_and_in_a_presentation_the_verdict() {
    let first = LESSONS.iter().position(|lesson| lesson.id.starts_with("01")).expect("a lesson");
    let mut bench = Bench::new(Session::default());
    bench.size = vec2(1280.0, 720.0);
    go(&mut bench, LessonCommand::Open(LessonSource::Shipped(first)));
    go(&mut bench, LessonCommand::GoTo(2));
    go(&mut bench, LessonCommand::Answer(0));
    let both = ["One third", "Wrong. Try another answer.", "The law uses the cosine"];
    for (presenting, seen) in
        [(false, [&both[..], &["One half.", "All of it."][..]].concat()), (true, both.into())]
    {
        bench.apply(Action::View(ViewChange::Presenting(presenting)));
        (0..30).for_each(|_| bench.frame(Vec::new()));
        let next = bench.find("Next").expect("a button").rect;
        let texts = bench.texts_in_sight();
        for start in seen {
            let place = texts.iter().find(|(text, _)| text.starts_with(start)).map(|(_, place)| *place);
            let place = place.unwrap_or_else(|| panic!("{presenting}: “{start}” is not in sight"));
            assert!(place.top() > 40.0 && place.bottom() <= next.top(), "{presenting}: “{start}” at {place}");
        }
    }
}

// ── layout ──

#[test]
fn the_picture_keeps_its_room_and_no_text_leaves_the_panel() {
    let desk = Desk::new();
    for (size, scale, share) in [
        (vec2(1280.0, 720.0), 100, 0.45),
        (vec2(1280.0, 720.0), 150, 0.4),
        (vec2(1280.0, 720.0), 200, 0.29),
        (vec2(1920.0, 1080.0), 150, 0.45),
        (vec2(1920.0, 1080.0), 200, 0.38),
    ] {
        let mut bench = Bench::new(Session::default());
        bench.size = size;
        bench.apply(Action::View(ViewChange::Scale(scale)));
        desk.open(&mut bench);
        for step in 0..4 {
            go(&mut bench, LessonCommand::GoTo(step));
            let whole = size.x / bench.ctx.zoom_factor();
            let area = bench.area.rect;
            assert!(area.width() >= share * whole - 2.0, "{size:?} {scale}: {} of {whole}", area.width());
            let (mut texts, right) = (0, area.left() - 4.0);
            for shape in bench.shapes() {
                if let Shape::Text(text) = shape
                    && text.pos.x < right
                    && text.pos.y > 40.0
                    && text.pos.y < area.bottom() - 30.0
                {
                    assert!(
                        text.visual_bounding_rect().right() <= right,
                        "{}: {scale} %",
                        text.galley.text()
                    );
                    texts += 1;
                }
            }
            assert!(texts > 4, "{texts}");
        }
    }
}

#[test]
fn titles_of_lessons_are_shown_whole() {
    let mut bench = Bench::new(Session::default());
    bench.size = vec2(1280.0, 720.0);
    let mut lines = BTreeSet::new();
    for (i, lesson) in LESSONS.iter().enumerate() {
        go(&mut bench, LessonCommand::Open(LessonSource::Shipped(i)));
        let titles: Vec<_> = bench
            .shapes()
            .into_iter()
            .filter_map(|shape| match shape {
                Shape::Text(text) if text.galley.job.text == lesson.title && text.pos.y > 36.0 => Some(text),
                _ => None,
            })
            .collect();
        let [title] = titles.as_slice() else { panic!("{}: {}", lesson.title, titles.len()) };
        assert!(!title.galley.elided, "{}", lesson.title);
        lines.insert(title.galley.rows.len());
        let place = title.galley.rect.translate(title.pos.to_vec2());
        let (step, again) =
            (format!("Step 1 of {} ▾", lesson.steps.len()), "Begin this step again".to_owned());
        for other in [step, again] {
            let other = bench.find(&other).expect("it is beside or below").rect;
            assert!(!place.shrink(1.0).intersects(other), "{}: {place:?} {other:?}", lesson.title);
        }
    }
    assert_eq!(lines, BTreeSet::from([1, 2]), "else this would prove nothing");
}

#[test]
fn the_scene_list_is_below_the_lesson_and_unfolds() {
    let desk = Desk::new();
    let mut bench = desk.bench(Session::default());
    assert!(bench.find("Observer").is_none());
    bench.click("Scene list");
    let row = bench.find("Point 1").expect("a row").rect;
    let next = bench.find("Next").expect("a button").rect;
    assert!(row.top() > next.bottom() && row.right() < bench.area.rect.left());
    bench.click("Point 1");
    assert_eq!(bench.session.selection, Selection::Light(0));
    bench.click("Scene list");
    assert!(bench.find("Observer").is_none());
    // It takes all of the left side again.
    go(&mut bench, LessonCommand::Leave);
    assert!(bench.find("Observer").is_some() && bench.find("Next").is_none());
    assert!(bench.area.rect.left() < 220.0);
}

#[test]
fn a_presentation_keeps_the_text_in_large_letters_beside_the_picture() {
    let desk = Desk::new();
    let mut bench = desk.bench(Session::default());
    bench.size = vec2(1920.0, 1080.0);
    bench.settle();
    let letters = |bench: &mut Bench| {
        let shapes = bench.shapes();
        let text = shapes.iter().find_map(|shape| match shape {
            Shape::Text(text) if text.galley.text().starts_with("Light that comes") => Some(text),
            _ => None,
        });
        let text = text.expect("the text");
        (text.galley.job.sections[0].format.font_id.size, text.visual_bounding_rect())
    };
    let (small, _) = letters(&mut bench);
    bench.apply(Action::View(ViewChange::Presenting(true)));
    let (large, place) = letters(&mut bench);
    assert!(large > 1.8 * small && large >= 0.023 * 1080.0, "{large}");
    assert!(bench.find("Next").is_some() && bench.find("File").is_none() && bench.find("Observer").is_none());
    assert!(bench.area.rect.left() >= place.right() && bench.area.rect.width() > 0.6 * 1920.0);
    assert!(bench.area.rect.height() > 1079.0, "{:?}", bench.area.rect);
    // Hidden before, it stays hidden.
    bench.apply(Action::View(ViewChange::Left(false)));
    assert!(bench.find("Next").is_none() && bench.area.rect.width() > 1919.0);
}

#[test]
fn the_width_of_the_lesson_and_that_of_the_scene_list_are_kept_apart() {
    let desk = Desk::new();
    let mut bench = desk.bench(Session::default());
    let (list, lesson) = (bench.session.settings.left_width, bench.session.settings.lesson_width);
    let edge = bench.area.rect.left();
    let (from, to) = (pos2(edge, 300.0), pos2(edge + 60.0, 300.0));
    crate::window::layout::drag(&mut bench, from, to);
    let kept = &bench.session.settings;
    assert!((kept.lesson_width - lesson - 60.0).abs() < 4.0, "{}", kept.lesson_width);
    assert_eq!(kept.left_width, list);
    assert!(bench.effects.contains(&Effect::SaveSettings));
    go(&mut bench, LessonCommand::Leave);
    assert!((bench.area.rect.left() - list).abs() < 2.0);
}

// ── pointing ──

/// Rings in the accent colour with the width of highlights.
fn rings(bench: &mut Bench) -> Vec<Rect> {
    let shapes = bench.shapes();
    let ring = |shape: &Shape| match shape {
        Shape::Rect(r) if r.stroke.color == DARK.accent && r.stroke.width >= 2.0 && r.fill.a() == 0 => {
            Some(r.rect)
        }
        _ => None,
    };
    shapes.iter().filter_map(ring).collect()
}

#[test]
fn the_controls_that_a_step_names_get_a_ring_and_come_into_view() {
    let desk = Desk::new();
    let mut bench = desk.bench(Session::default());
    bench.apply(Action::View(ViewChange::Scale(200)));
    assert_eq!(rings(&mut bench), []);
    go(&mut bench, LessonCommand::GoTo(2));
    (0..60).for_each(|_| bench.frame(Vec::new()));
    let knob = bench.field("shininess").rect;
    let inside = bench.area.rect.right()..1280.0 / bench.ctx.zoom_factor();
    let screen = Rect::from_x_y_ranges(inside.start..=inside.end, 20.0..=330.0);
    assert!(screen.contains_rect(knob), "scrolled into view: {knob:?}");
    let all = rings(&mut bench);
    let help = bench.tree.iter().find(|s| s.label == "Help" && s.rect.top() < 30.0).expect("a menu").rect;
    assert_eq!(all.len(), 2, "{all:?}");
    assert!(
        all.iter().any(|ring| ring.contains_rect(knob)) && all.iter().any(|ring| ring.contains_rect(help))
    );
    // It swells for a moment; then the window rests.
    assert!(!bench.ctx.has_requested_repaint(), "{:?}", bench.ctx.repaint_causes());
    go(&mut bench, LessonCommand::GoTo(3));
    assert_eq!(rings(&mut bench), []);
    // The window is the learner's: what was scrolled away stays away.
    go(&mut bench, LessonCommand::Leave);
    assert_eq!(rings(&mut bench), []);
}

#[test]
fn a_few_slow_frames_are_enough_to_show_a_knob() {
    let desk = Desk::new();
    let mut bench = desk.bench(Session::default());
    bench.apply(Action::View(ViewChange::Scale(200)));
    bench.session.apply(Action::Lesson(LessonCommand::GoTo(2)), &bench.registry);
    (0..4).for_each(|_| bench.frame(Vec::new()));
    let knob = bench.field("shininess").rect;
    assert!(knob.top() > 20.0 && knob.bottom() < 330.0, "scrolled into view: {knob:?}");
}

#[test]
fn a_part_that_a_step_points_at_is_in_sight() {
    let desk = Desk::new();
    let text = TEXT.replace("knob: alpha\nmenu: Help", "part: light 1\ntab: explain\nbutton: shading");
    std::fs::write(desk.folder.path().join("light.md"), text).expect("writable");
    let mut bench = desk.bench(Session::default());
    go(&mut bench, LessonCommand::GoTo(2));
    bench.apply(Action::View(ViewChange::BottomTab(EXPLAIN_TAB.to_owned())));
    (0..60).for_each(|_| bench.frame(Vec::new()));
    let row = bench.find("Point 1").expect("the scene list is unfolded").rect;
    let tab = bench.find("Explain").expect("a tab").rect;
    let shading = bench.find("Shading: Phong").expect("a choice").rect;
    let all = rings(&mut bench);
    for place in [row, tab, shading] {
        assert!(all.iter().any(|ring| ring.contains_rect(place.shrink(1.0))), "{place:?}: {all:?}");
    }
    assert_eq!(all.len(), 3);
}

/// A window with the lesson about refraction.
fn straw() -> Bench {
    let i =
        LESSONS.iter().position(|lesson| lesson.id.ends_with("why_a_straw_looks_broken")).expect("shipped");
    let mut bench = Bench::new(Session::default());
    bench.size = vec2(1280.0, 720.0);
    bench.settle();
    go(&mut bench, LessonCommand::Open(LessonSource::Shipped(i)));
    bench
}

#[test]
fn the_line_that_a_task_asks_to_read_is_in_sight_for_every_point() {
    let mut bench = straw();
    for (step, line) in [(2, "° inside, n = "), (4, "the part of the light that is reflected here")] {
        go(&mut bench, LessonCommand::GoTo(step));
        for at in [[0.02, 0.03], [0.05, 0.08], [0.04, 0.05]] {
            bench.apply(Action::View(ViewChange::Pin(Some(Pin { view: 0, at }))));
            (0..60).for_each(|_| bench.frame(Vec::new()));
            let texts = bench.texts_in_sight();
            let found = texts.iter().find(|(text, _)| text.contains(line));
            let (_, place) = found.unwrap_or_else(|| panic!("step {step}, {at:?}: {texts:?}"));
            assert!(place.bottom() < 710.0, "step {step}, {at:?}: {place:?}");
            let around = rings(&mut bench).into_iter().find(|ring| ring.contains_rect(place.shrink(2.0)));
            assert!(around.is_some(), "step {step}, {at:?}");
        }
    }
}

#[test]
fn no_marker_of_a_light_covers_the_straw_and_the_own_markers_come_back() {
    let mut bench = straw();
    assert!(!bench.session.view.show_markers);
    // What the learner changes there lasts as long as the lesson.
    bench.apply(Action::View(ViewChange::Markers(true)));
    go(&mut bench, LessonCommand::Again);
    assert!(!bench.session.view.show_markers, "as the step began");
    go(&mut bench, LessonCommand::Leave);
    assert!(bench.session.view.show_markers);
    // Whoever hides them has none in lessons that say nothing of them.
    bench.apply(Action::View(ViewChange::Markers(false)));
    go(&mut bench, LessonCommand::Open(LessonSource::Shipped(0)));
    assert!(!bench.session.view.show_markers);
    go(&mut bench, LessonCommand::GoTo(2));
    assert!(!bench.session.view.show_markers);
}

// ── the way in ──

#[test]
fn the_menu_lists_the_lessons_with_their_progress() {
    let mut session = Session::default();
    let first = &LESSONS[0];
    let past = Past { title: first.title.clone(), step: 1, steps: first.steps.len(), ..Past::default() };
    session.progress.lessons.insert(first.id.clone(), past);
    let mut bench = Bench::new(session);
    bench.size = vec2(1280.0, 720.0);
    bench.settle();
    bench.click("Help");
    bench.click("Lessons ⏵");
    for lesson in LESSONS.iter() {
        assert!(bench.find(&format!("Lesson: {}", lesson.title)).is_some(), "{}", lesson.title);
    }
    let texts: Vec<_> = bench
        .shapes()
        .into_iter()
        .filter_map(|shape| match shape {
            Shape::Text(text) => Some(text.galley.text().to_owned()),
            _ => None,
        })
        .collect();
    let facts = format!("step 2 of {}", first.steps.len());
    assert!(texts.iter().any(|text| text.contains(&facts)), "{texts:?}");
    bench.click(&format!("Lesson: {}", first.title));
    let open = bench.session.lesson.as_ref().expect("open");
    assert_eq!((&open.lesson.title, open.step), (&first.title, 1));
    bench.click("Help");
    bench.click("Lessons ⏵");
    bench.click("Leave the lesson");
    assert!(bench.session.lesson.is_none());
    bench.click("Help");
    bench.click("Lessons ⏵");
    bench.click("Open a lesson…");
    assert!(bench.dialogs.is_open() && bench.says("Open a lesson"));
}

#[test]
fn the_start_has_three_doors() {
    for (size, scale) in [((1280.0, 720.0), 100), ((1280.0, 720.0), 150), ((1920.0, 1080.0), 100)] {
        let mut bench = Bench::new(Session::default());
        bench.size = size.into();
        bench.apply(Action::View(ViewChange::Scale(scale)));
        bench.apply(Action::View(ViewChange::Examples(true)));
        let first = &LESSONS[0];
        let door =
            bench.tree.iter().find(|seen| seen.label.starts_with("Begin here")).expect("a lesson").clone();
        assert!(door.label.contains(&first.title) && door.rect.top() > bench.area.rect.bottom());
        assert!(bench.find("Example: Default scene").is_some());
        // Nothing overlaps anything else.
        let doors: Vec<_> =
            ["All lessons ▾", "New reflection model…", "New model…", "Example: Default scene"]
                .into_iter()
                .filter_map(|name| bench.find(name))
                .chain([&door])
                .map(|seen| seen.rect)
                .collect();
        assert_eq!(doors.len(), 4, "{size:?} {scale}");
        for (i, a) in doors.iter().enumerate() {
            assert!(doors[..i].iter().all(|b| !a.shrink(0.5).intersects(*b)), "{size:?} {scale}: {doors:?}");
        }
        let model = if scale == 100 { "New reflection model…" } else { "New model…" };
        bench.click(model);
        assert!(bench.session.authoring.draft.is_some());
        bench.apply(Action::Model(lights_camera_models::panel::state::ModelCommand::Cancel));
        bench.click("All lessons ▾");
        assert!(bench.find(&format!("Lesson: {}", first.title)).is_some());
        bench.key(Key::Escape, Modifiers::NONE);
        // By keyboard: the strip is the part of the window before the status line.
        let label = door.label;
        for _ in 0..6 {
            if focused(&bench) == label {
                break;
            }
            bench.key(Key::F6, Modifiers::NONE);
        }
        bench.key(Key::Enter, Modifiers::NONE);
        assert_eq!(bench.session.title(), first.title);
        assert!(!bench.session.view.examples_open);
        go(&mut bench, LessonCommand::Leave);
        assert!(bench.session.view.examples_open, "the strip comes back");
        bench.key(Key::Escape, Modifiers::NONE);
        assert!(!bench.session.view.examples_open);
    }
}

#[test]
fn the_door_goes_on_with_the_last_lesson() {
    let mut bench = Bench::new(Session::default());
    bench.size = vec2(1280.0, 720.0);
    let second = LessonSource::Shipped(1);
    go(&mut bench, LessonCommand::Open(second.clone()));
    go(&mut bench, LessonCommand::GoTo(2));
    go(&mut bench, LessonCommand::Leave);
    bench.apply(Action::View(ViewChange::Examples(true)));
    let steps = LESSONS[1].steps.len();
    bench.click(&format!("Go on: step 3 of {steps}, {}", LESSONS[1].title));
    assert_eq!(
        (bench.session.lesson.as_ref().map(|open| open.source.clone()), step(&bench)),
        (Some(second), 2)
    );
    // Once it is finished, the first unfinished one.
    go(&mut bench, LessonCommand::GoTo(steps - 1));
    while bench.session.lesson.is_some() {
        go(&mut bench, LessonCommand::Next);
    }
    assert_eq!(bench.session.progress.next(), Some(LessonSource::Shipped(0)));
    assert!(bench.says(&format!("The next one is “{}”.", LESSONS[2].title)));
    bench.apply(Action::View(ViewChange::Examples(true)));
    let door =
        |word: &str| format!("{word}: {} min, {}", LESSONS[0].minutes.expect("given"), LESSONS[0].title);
    assert!(bench.find(&door("Next")).is_some(), "the first is a beginning no longer");
    assert!(bench.find(&door("Go on")).is_none(), "it was never begun");
}

#[test]
fn to_look_at_a_lesson_is_not_to_begin_it() {
    let mut bench = Bench::new(Session::default());
    bench.size = vec2(1280.0, 720.0);
    go(&mut bench, LessonCommand::Open(LessonSource::Shipped(3)));
    go(&mut bench, LessonCommand::Leave);
    bench.apply(Action::View(ViewChange::Examples(true)));
    assert_eq!(bench.session.progress.next(), Some(LessonSource::Shipped(0)));
    let door = format!("Begin here: {} min, {}", LESSONS[0].minutes.expect("given"), LESSONS[0].title);
    assert!(bench.find(&door).is_some());
    assert!(bench.tree.iter().all(|seen| !seen.label.starts_with("Go on")));
    // Any answer counts as a start, even a wrong one.
    go(&mut bench, LessonCommand::Open(LessonSource::Shipped(3)));
    let at = LESSONS[3].steps.iter().position(|step| matches!(step.task, Some(Task::Predict { .. })));
    go(&mut bench, LessonCommand::GoTo(at.expect("it asks something")));
    go(&mut bench, LessonCommand::Answer(0));
    go(&mut bench, LessonCommand::GoTo(0));
    go(&mut bench, LessonCommand::Leave);
    assert_eq!(bench.session.progress.next(), Some(LessonSource::Shipped(3)));
    assert!(bench.tree.iter().any(|seen| seen.label.starts_with("Go on: step 1 of ")));
}

#[test]
fn every_shipped_lesson_can_be_gone_through_and_left() {
    for (i, lesson) in LESSONS.iter().enumerate() {
        let mut bench = Bench::new(busy());
        bench.size = vec2(1280.0, 720.0);
        go(&mut bench, LessonCommand::Open(LessonSource::Shipped(i)));
        for at in 0..lesson.steps.len() {
            assert_eq!(step(&bench), at, "{}", lesson.title);
            assert!(bench.says(&lesson.steps[at].title));
            while bench.session.lesson.as_ref().is_some_and(|open| open.step == at) {
                go(&mut bench, LessonCommand::Next);
            }
        }
        assert!(bench.session.lesson.is_none(), "{}", lesson.title);
        assert_eq!(bench.session.title(), "Mine");
    }
}

#[test]
fn a_lesson_that_there_is_not_is_named_on_the_command_line() {
    let folder = tempfile::tempdir().expect("a folder");
    let said = |arguments: &[&str]| {
        let output = crate::helpers::screen::lcm(arguments, folder.path()).output().expect("lcm runs");
        (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
    };
    let name = &LESSONS[0].id;
    let misspelt = format!("{name}x");
    let (code, text) = said(&["view", "--lesson", &misspelt]);
    assert_eq!(code, Some(1), "{text}");
    assert!(
        text.contains(&format!("there is no lesson \"{misspelt}\"")) && text.contains(name.as_str()),
        "{text}"
    );
    let file = folder.path().join("broken.md");
    std::fs::write(&file, TEXT.replace("knob.alpha >", "knob.alpha >>")).expect("writable");
    let (code, text) = said(&["view", "--lesson", &file.display().to_string()]);
    let line = TEXT.lines().position(|line| line.starts_with("until: knob.alpha")).expect("there") + 1;
    assert_eq!(code, Some(1), "{text}");
    assert!(text.contains(&format!("broken.md:{line}:")), "{text}");
    assert_eq!(said(&["view", "--step", "2"]).0, Some(2), "a step of nothing");
}

#[cfg(target_os = "linux")]
#[test]
fn the_window_follows_the_file_of_the_lesson() {
    use crate::helpers::screen::Screen;
    let desk = Desk::new();
    let file = desk.folder.path().join("light.md");
    let screen = Screen::new(1280, 720);
    let mut window = screen.start(&["view", "--size", "1280x720", "--lesson", &file.display().to_string()]);
    let error = |p: &crate::helpers::screen::Picture| p.count(0..340, 100..600, |c| c == [0xff, 0x8a, 0x7a]);
    // The panel of the lesson is wider than the scene list.
    window.until("the lesson", |p| p.count(220..336, 560..610, |c| c == [21; 3]) > 4000 && error(p) == 0);
    std::fs::write(&file, TEXT.replace("knob.alpha >", "knob.alpha >>")).expect("writable");
    window.until("the errors", |p| error(p) > 100);
    std::fs::write(&file, TEXT).expect("writable");
    window.until("the lesson again", |p| error(p) == 0);
}
