//! The document when its file changes on disk, with real files and without a window.

use std::{fs, path::PathBuf};

use bevy::ecs::{entity::Entity, schedule::Schedule, world::World};
use lights_camera_models::{
    document::{Edit, Selection},
    optics::TermSelection,
    panel::{
        effects,
        files::{Files as _, OnDisk},
        state::{Action, Answer, Effect, Offer, Question, Session, Severity, ViewChange},
    },
    parameter::Outside,
    registry::Registry,
    render::{
        entities::{CurrentScene, SceneEntities},
        reconcile::reconcile,
    },
    scene::{
        Object, Part, Scene,
        load::{self, Defaults, Stamp},
        save,
    },
    window::files::DiskFiles,
};

/// A document that was read from a file, and the window's part.
struct Desk {
    session: Session,
    files: DiskFiles,
    registry: Registry,
    /// Effects left to the window: all except those on files.
    left: Vec<Effect>,
    folder: tempfile::TempDir,
}

impl Desk {
    fn new() -> Self {
        Self::with(&text(&three()))
    }

    fn with(text: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("room.json");
        fs::write(&path, text).unwrap();
        let registry = Registry::builtin();
        let loaded = load::file(&path, &registry, Defaults::Use).unwrap();
        let mut session = Session::new(loaded.scene);
        session.path = Some(path.clone());
        let files = DiskFiles::new(Some(path), Some(loaded.stamp));
        Self { session, files, registry, left: Vec::new(), folder }
    }

    fn path(&self) -> PathBuf {
        self.folder.path().join("room.json")
    }

    fn write(&self, text: &str) {
        fs::write(self.path(), text).unwrap();
    }

    fn on_disk(&self) -> String {
        fs::read_to_string(self.path()).unwrap()
    }

    /// Carries effects out as the window does.
    fn carry_out(&mut self, effects: Vec<Effect>) {
        for effect in effects {
            if effect == Effect::DocumentChanged {
                self.files.document_changed(self.session.path.as_deref());
            }
            let more = effects::run(&mut self.session, &self.registry, effect.clone(), &mut self.files);
            if more == [effect.clone()] {
                self.left.push(effect);
            } else {
                self.carry_out(more);
            }
        }
    }

    fn act(&mut self, action: Action) {
        let effects = self.session.apply(action, &self.registry);
        self.carry_out(effects);
    }

    /// Reports the file as the watcher does. Returns whether it must be looked at again after a moment.
    fn report(&mut self) -> bool {
        self.carry_out(vec![Effect::CheckFile { discard: false }]);
        let before = self.left.len();
        let again = Effect::LookAgain(self.path());
        self.left.retain(|e| *e != again);
        self.left.len() < before
    }

    /// Writes the file, and lets a long time pass.
    fn edited(&mut self, text: &str) {
        self.write(text);
        if self.report() {
            assert!(!self.report(), "it is looked at again once");
        }
    }

    fn said(&self, words: &str) -> usize {
        self.session.messages.iter().filter(|m| m.text.contains(words)).count()
    }

    fn badge(&self) -> &str {
        self.session.disk.badge.as_ref().map_or("", |b| &b.text)
    }

    fn complaints(&self) -> Vec<&str> {
        let text = |e: &'_ Effect| matches!(e, Effect::Complain(_));
        self.left
            .iter()
            .filter(|e| text(e))
            .map(|e| match e {
                Effect::Complain(text) => text.as_str(),
                _ => "",
            })
            .collect()
    }

    /// An unsaved change in the window.
    fn change(&mut self) {
        self.act(Action::Edit(Edit::set(Part::Object(1), Object::size, 0.5)));
        assert!(self.session.is_dirty());
    }
}

/// Three objects in a row, the last with a name.
fn three() -> Scene {
    let at = |x: f32| Object { position: glam::Vec3::new(x, 5.0, 5.0), size: 1.0, ..Object::default() };
    let named = Object { name: Some("last".to_owned()), ..at(7.0) };
    Scene { objects: vec![at(3.0), at(5.0), named], ..Scene::default() }
}

fn text(scene: &Scene) -> String {
    save::to_json(scene, None, &Registry::builtin())
}

/// The scene with another size of one object.
fn grown(object: usize, size: f32) -> Scene {
    let mut scene = three();
    scene.objects[object].size = size;
    scene
}

#[test]
fn an_edit_elsewhere_becomes_the_document_and_the_view_stays() {
    let mut desk = Desk::new();
    desk.act(Action::Select(Selection::Object(2)));
    desk.act(Action::View(ViewChange::Terms(TermSelection::Diffuse)));
    desk.left.clear();
    desk.write(&text(&grown(0, 2.0)));
    assert!(!desk.report(), "nothing to wait for");
    assert_eq!(desk.session.document, grown(0, 2.0));
    assert!(!desk.session.is_dirty());
    assert_eq!(desk.session.selection, Selection::Object(2));
    assert_eq!(desk.session.view.terms, TermSelection::Diffuse);
    // Neither back to the observer nor to another document.
    assert!(desk.left.is_empty(), "{:?}", desk.left);
    assert_eq!(desk.said("room.json was reloaded"), 1);
    assert_eq!(desk.session.messages[0].severity, Severity::Info);
    // Many editors touch the file once more; that changes nothing.
    assert!(!desk.report());
    assert_eq!(desk.said("room.json was reloaded"), 1);
    // Another version: the message is not repeated.
    desk.edited(&text(&grown(0, 3.0)));
    assert_eq!(desk.session.document, grown(0, 3.0));
    assert_eq!(desk.session.messages.len(), 1);
    // The next save has nothing to ask.
    desk.change();
    desk.act(Action::Save);
    assert_eq!(desk.session.questions.open, None);
    assert!(!desk.session.is_dirty());
    assert_eq!(
        load::from_text(&desk.on_disk(), "", &desk.registry, Defaults::Refuse).unwrap().scene.objects[1].size,
        0.5
    );
}

#[test]
fn opening_a_file_by_hand_does_go_back_to_the_observer() {
    // The case that the test above must not detect.
    let mut desk = Desk::new();
    desk.act(Action::Reload);
    assert!(desk.left.contains(&Effect::DocumentChanged));
}

#[test]
fn the_same_content_changes_nothing() {
    let mut desk = Desk::new();
    let before = format!("{:?}", desk.session);
    desk.edited(&text(&three()));
    assert_eq!(format!("{:?}", desk.session), before);
    assert!(desk.left.is_empty());
}

#[test]
fn our_own_save_is_no_change_on_disk() {
    let mut desk = Desk::new();
    desk.change();
    desk.act(Action::Save);
    desk.left.clear();
    let before = format!("{:?}", desk.session);
    assert!(!desk.report());
    assert_eq!(format!("{:?}", desk.session), before);
    assert!(desk.left.is_empty());
    // Nor is saving to another file and continuing there.
    let other = desk.folder.path().join("other.json");
    desk.act(Action::SaveAs(other.clone()));
    desk.left.clear();
    let looked = desk.files.check(&other, &desk.registry, Outside::NONE);
    assert_eq!(looked, OnDisk::Same);
    // The same bytes from someone else's hand are the same; others are not.
    fs::write(&other, text(&three())).unwrap();
    assert!(matches!(desk.files.check(&other, &desk.registry, Outside::NONE), OnDisk::Changed { .. }));
}

#[test]
fn objects_that_did_not_change_keep_their_entities() {
    let mut desk = Desk::new();
    let mut world = World::new();
    let mut schedule = Schedule::default();
    schedule.add_systems(reconcile);
    world.insert_resource(Registry::builtin());
    world.init_resource::<SceneEntities>();
    let mut entities = |scene: &Scene| -> (Vec<Entity>, Vec<Entity>) {
        world.insert_resource(CurrentScene(scene.clone()));
        schedule.run(&mut world);
        let entities = world.resource::<SceneEntities>();
        (entities.objects.clone(), entities.lights.clone())
    };
    let before = entities(&desk.session.document);
    let mut scene = grown(1, 2.5);
    scene.objects.push(Object { position: glam::Vec3::splat(2.0), size: 1.0, ..Object::default() });
    desk.edited(&text(&scene));
    let after = entities(&desk.session.document);
    assert_eq!(after.0[..3], before.0[..]);
    assert_eq!(after.0.len(), 4);
    assert_eq!(after.1, before.1);
    assert!(!before.0.contains(&after.0[3]));
}

#[test]
fn the_selection_follows_what_it_points_at() {
    let select = |at: usize, scene: &Scene| {
        let mut desk = Desk::new();
        desk.act(Action::Select(Selection::Object(at)));
        desk.edited(&text(scene));
        assert_eq!(desk.session.document, *scene);
        desk.session.selection
    };
    // The first was removed: the third is second now.
    let mut fewer = three();
    fewer.objects.remove(0);
    assert_eq!(select(2, &fewer), Selection::Object(1));
    // Also if it changed, by its name.
    fewer.objects[1].size = 0.3;
    assert_eq!(select(2, &fewer), Selection::Object(1));
    // One edited in place is still the same.
    assert_eq!(select(1, &grown(1, 0.3)), Selection::Object(1));
    // Deleted objects give way to those that exist.
    let mut one = three();
    one.objects.truncate(1);
    assert_eq!(select(1, &one), Selection::Object(0));
    assert_eq!(select(0, &one), Selection::Object(0));
}

#[test]
fn an_empty_or_half_written_file_is_given_a_moment() {
    let whole = text(&grown(0, 2.0));
    for half in ["", &whole[..whole.len() / 2]] {
        let mut desk = Desk::new();
        desk.write(half);
        assert!(desk.report(), "looks again");
        assert!(desk.session.messages.is_empty() && desk.badge().is_empty() && desk.left.is_empty());
        assert_eq!(desk.session.document, three());
        desk.write(&whole);
        assert!(!desk.report());
        assert_eq!(desk.session.document, grown(0, 2.0));
        assert_eq!(desk.badge(), "");
        assert!(desk.complaints().is_empty());
    }
    // While it is still being written, nothing is reported.
    let mut desk = Desk::new();
    for end in 1..20 {
        desk.write(&whole[..end]);
        assert!(desk.report());
    }
    assert!(desk.session.messages.is_empty());
    assert!(!desk.report(), "now it rests");
    assert_eq!(desk.badge(), "room.json has errors: showing the last good version");
}

#[test]
fn the_badge_of_a_broken_file_tells_if_unsaved_changes_are_shown() {
    let mut desk = Desk::new();
    let badge = |desk: &Desk| desk.session.disk_badge().map(|badge| badge.text);
    assert_eq!(badge(&desk), None);
    desk.edited("{ nonsense");
    let plain = "room.json has errors: showing the last good version";
    assert_eq!(badge(&desk).as_deref(), Some(plain));
    desk.change();
    assert_eq!(badge(&desk), Some(format!("{plain} with your unsaved changes")));
    desk.act(Action::Undo);
    assert_eq!(badge(&desk).as_deref(), Some(plain));
}

#[test]
fn a_broken_file_leaves_the_scene_and_says_where() {
    let mut desk = Desk::new();
    let broken = |k_d: &str| {
        text(&three()).replace("\"size\": 1", &format!("\"size\": 1, \"material\": {{ \"k_d\": {k_d} }}"))
    };
    desk.edited(&broken("7"));
    assert_eq!(desk.session.document, three());
    assert!(desk.session.is_dirty(), "no file has the scene that is shown");
    assert_eq!(desk.badge(), "room.json has errors: showing the last good version");
    let name = desk.path().display().to_string();
    // Each of the three objects has the problem, with its line and column.
    let places: Vec<_> =
        desk.session.messages.iter().filter_map(|m| m.text.strip_prefix(&format!("{name}:"))).collect();
    assert_eq!(places.len(), 3, "{:?}", desk.session.messages);
    for place in &places {
        let mut numbers = place.split(':');
        assert!(numbers.next().unwrap().parse::<u32>().is_ok_and(|line| line > 1), "{place}");
        assert!(numbers.next().unwrap().parse::<u32>().is_ok_and(|column| column > 1), "{place}");
        assert!(place.contains("k_d is 7"), "{place}");
    }
    assert!(desk.session.view.bottom_open);
    assert!(desk.session.disk.badge.as_ref().unwrap().help.contains("k_d is 7"), "the tooltip tells it all");
    assert_eq!(desk.complaints().len(), 1, "once on standard error");
    assert_eq!(desk.complaints()[0].lines().count(), 3);
    // The same version again reports nothing more.
    desk.session.messages.clear();
    assert!(!desk.report());
    assert!(desk.session.messages.is_empty());
    assert_eq!(desk.complaints().len(), 1);
    // Another one replaces the message.
    desk.edited(&broken("8"));
    desk.edited(&broken("9"));
    assert_eq!((desk.said("k_d is 8"), desk.said("k_d is 9")), (0, 3));
    assert_eq!((desk.session.messages.len(), desk.said("can no longer be read as a scene")), (4, 1));
    assert_eq!(desk.complaints().len(), 3);
    // A valid one clears everything, even if it equals the one shown.
    desk.edited(&text(&three()));
    assert_eq!(desk.badge(), "");
    assert!(desk.session.messages.is_empty());
    desk.edited(&broken("7"));
    desk.edited(&text(&grown(0, 2.0)));
    assert_eq!(desk.badge(), "");
    assert_eq!(desk.session.messages.len(), 1);
    assert_eq!(desk.said("was reloaded"), 1);
}

#[test]
fn saving_over_a_broken_file_asks() {
    let mut desk = Desk::new();
    desk.edited("{ broken");
    desk.change();
    desk.act(Action::Save);
    assert!(matches!(desk.session.questions.open, Some(Question::ChangedOnDisk { .. })));
    assert_eq!(desk.on_disk(), "{ broken");
    desk.act(Action::Answer(Answer::Overwrite));
    assert_eq!(desk.badge(), "", "what was saved is good");
    assert!(desk.session.messages.iter().all(|m| m.text.starts_with("Saved to ")));
    assert!(!desk.report());
}

#[test]
fn missing_parts_are_not_taken_unasked() {
    let lacking = |scene: &Scene, part: &str| {
        let text = text(scene);
        text.lines().filter(|l| !l.contains(part)).collect::<Vec<_>>().join("\n")
    };
    let mut desk = Desk::new();
    desk.edited(&lacking(&grown(0, 2.0), "shading_model"));
    assert_eq!(desk.session.document, three());
    assert_eq!(desk.session.questions.open, None, "who types elsewhere is not stopped by a question");
    assert_eq!(desk.badge(), "room.json has errors: showing the last good version");
    assert_eq!(desk.said("shading_model is missing"), 1);
    // Consent to a default holds from then on.
    let mut desk = Desk::new();
    desk.write(&lacking(&three(), "shading_model"));
    desk.act(Action::Reload);
    desk.act(Action::Answer(Answer::UseDefaults));
    assert!(desk.session.is_dirty(), "the file lacks what the document has");
    desk.edited(&lacking(&grown(0, 2.0), "shading_model"));
    assert_eq!(desk.session.document, grown(0, 2.0));
    assert!(desk.session.is_dirty());
    // But only to that one.
    let two = lacking(&grown(0, 3.0), "shading_model");
    let two: Vec<_> = two.lines().filter(|l| !l.contains("reflection_model")).collect();
    desk.edited(&two.join("\n"));
    assert_eq!(desk.session.document, grown(0, 2.0));
    // Once the part exists, nothing is missing.
    desk.edited(&text(&grown(0, 4.0)));
    assert_eq!(desk.session.document, grown(0, 4.0));
    assert!(!desk.session.is_dirty());
    // `--use-defaults` accepts all.
    let mut desk = Desk::new();
    desk.session.disk.use_defaults = true;
    desk.edited(&lacking(&grown(0, 2.0), "shading_model"));
    assert_eq!(desk.session.document, grown(0, 2.0));
}

#[test]
#[cfg(unix)]
fn a_file_that_no_longer_holds_the_scene_leaves_it_unsaved_and_nothing_waits_for_it() {
    /// Replaces the file by something else.
    type Happens = fn(&std::path::Path);
    let fill: [(Happens, &str); 5] = [
        (|path| fs::write(path, "").unwrap(), "is empty"),
        (|path| fs::write(path, &text(&three())[..90]).unwrap(), "room.json"),
        (
            |path| {
                fs::remove_file(path).unwrap();
                assert!(std::process::Command::new("mkfifo").arg(path).status().unwrap().success());
            },
            "a named pipe",
        ),
        (|path| fs::File::options().write(true).open(path).unwrap().set_len(1 << 30).unwrap(), "larger than"),
        (
            |path| {
                fs::remove_file(path).unwrap();
                fs::create_dir(path).unwrap();
            },
            "is a folder",
        ),
    ];
    for (happens, expected) in fill {
        let mut desk = Desk::new();
        happens(&desk.path());
        let begin = std::time::Instant::now();
        assert!(desk.report() && !desk.report(), "{expected}");
        assert!(begin.elapsed() < std::time::Duration::from_secs(2), "{expected}");
        assert_eq!(desk.session.document, three());
        assert!(desk.session.shows_unsaved(), "{expected}: only the window has the scene");
        assert_eq!(desk.said("can no longer be read as a scene"), 1, "{expected}");
        assert!(desk.said(expected) > 0, "{:?}", desk.session.messages);
        assert_eq!(desk.badge(), "room.json has errors: showing the last good version");
        assert_eq!(desk.session.disk_badge().map(|b| b.text).as_deref(), Some(desk.badge()), "nobody edited");
        desk.act(Action::Quit);
        assert!(matches!(desk.session.questions.open, Some(Question::Unsaved { .. })), "{expected}");
        desk.act(Action::Answer(Answer::Cancel));
        // It comes back unchanged, and the message disappears.
        let _ = fs::remove_dir(desk.path());
        let _ = fs::remove_file(desk.path());
        desk.edited(&text(&three()));
        assert_eq!((desk.badge(), desk.session.is_dirty()), ("", false), "{expected}");
        assert!(desk.session.messages.is_empty(), "{:?}", desk.session.messages);
    }
}

#[test]
fn a_deleted_file_leaves_the_scene_which_is_unsaved_then() {
    let mut desk = Desk::new();
    fs::remove_file(desk.path()).unwrap();
    assert!(desk.report(), "some editors delete the file and write it anew");
    assert_eq!(desk.badge(), "");
    assert!(!desk.report());
    assert_eq!(desk.badge(), "room.json was deleted: only this window has the scene");
    assert_eq!(desk.said("was deleted or moved"), 1);
    assert_eq!(desk.session.document, three());
    desk.act(Action::Quit);
    assert!(
        matches!(desk.session.questions.open, Some(Question::Unsaved { .. })),
        "nobody else has the scene"
    );
    desk.act(Action::Answer(Answer::Cancel));
    // It comes back.
    desk.edited(&text(&three()));
    assert_eq!(desk.badge(), "");
    assert!(!desk.session.is_dirty() && desk.session.messages.is_empty());
    // And comes back as another one.
    fs::remove_file(desk.path()).unwrap();
    assert!(desk.report() && !desk.report());
    desk.edited(&text(&grown(0, 2.0)));
    assert_eq!((desk.badge(), desk.session.is_dirty()), ("", false));
    assert_eq!(desk.session.document, grown(0, 2.0));
    // Saving writes it again, without a question.
    fs::remove_file(desk.path()).unwrap();
    assert!(desk.report() && !desk.report());
    desk.act(Action::Save);
    assert_eq!(desk.session.questions.open, None);
    assert_eq!(desk.on_disk(), text(&grown(0, 2.0)));
    assert_eq!((desk.badge(), desk.session.is_dirty()), ("", false));
    assert!(!desk.report());
}

#[test]
fn saving_a_deleted_file_does_not_overwrite_what_came_in_its_place() {
    let mut desk = Desk::new();
    fs::remove_file(desk.path()).unwrap();
    assert!(desk.report() && !desk.report());
    let other = text(&grown(0, 2.0));
    desk.write(&other);
    // Before the watcher reports it.
    desk.act(Action::Save);
    assert!(matches!(desk.session.questions.open, Some(Question::ChangedOnDisk { .. })));
    assert_eq!(desk.on_disk(), other);
}

/// A document with unsaved changes whose file has changed too.
fn conflict() -> Desk {
    let mut desk = Desk::new();
    desk.change();
    desk.edited(&text(&grown(0, 2.0)));
    let Some(Question::NewerOnDisk { scene, .. }) = &desk.session.questions.open else {
        panic!("{:?}", desk.session.questions.open)
    };
    assert_eq!(**scene, grown(0, 2.0));
    assert_eq!(desk.session.document, grown(1, 0.5), "nothing is lost without a question");
    desk
}

#[test]
fn unsaved_changes_are_kept_when_the_user_says_so_and_saving_replaces_the_file() {
    let mut desk = conflict();
    desk.act(Action::Answer(Answer::Keep));
    assert_eq!(desk.session.document, grown(1, 0.5));
    assert!(desk.session.is_dirty());
    assert!(!desk.report());
    assert_eq!(desk.session.questions.open, None, "asked once about a version");
    assert_eq!(desk.badge(), "");
    // Yet another version is another question.
    desk.edited(&text(&grown(0, 3.0)));
    assert!(matches!(desk.session.questions.open, Some(Question::NewerOnDisk { .. })));
    desk.act(Action::Answer(Answer::Keep));
    desk.act(Action::Save);
    assert_eq!(desk.session.questions.open, None, "saving was what was meant");
    assert_eq!(desk.on_disk(), text(&grown(1, 0.5)));
    assert!(!desk.session.is_dirty());
}

#[test]
fn who_kept_a_version_and_undoes_all_is_still_unsaved() {
    let mut desk = conflict();
    desk.act(Action::Answer(Answer::Keep));
    desk.act(Action::Edit(Edit::set(Part::Object(1), Object::size, 1.0)));
    assert_eq!(desk.session.document, three());
    assert!(desk.session.is_dirty(), "the file holds something else");
}

#[test]
fn unsaved_changes_are_lost_only_on_yes() {
    let mut desk = conflict();
    desk.act(Action::Answer(Answer::Reload));
    assert_eq!(desk.session.document, grown(0, 2.0));
    assert!(!desk.session.is_dirty());
    assert_eq!(desk.session.questions.open, None);
    assert!(!desk.left.contains(&Effect::DocumentChanged), "the camera stays");
    desk.change();
    desk.act(Action::Save);
    assert_eq!(desk.session.questions.open, None);
}

#[test]
fn reading_again_takes_what_is_on_disk_by_then() {
    let mut desk = conflict();
    desk.write("{ broken");
    desk.act(Action::Answer(Answer::Reload));
    assert_eq!(desk.left.pop(), Some(Effect::LookAgain(desk.path())));
    assert!(!desk.report());
    assert_eq!(desk.session.document, grown(1, 0.5), "a broken file costs nothing");
    assert_eq!(desk.badge(), "room.json has errors: showing the last good version");
    let mut desk = conflict();
    desk.write(&text(&grown(0, 4.0)));
    desk.act(Action::Answer(Answer::Reload));
    assert_eq!(desk.session.document, grown(0, 4.0));
}

#[test]
fn who_decides_later_is_asked_when_saving() {
    let mut desk = conflict();
    desk.act(Action::Answer(Answer::Cancel));
    assert_eq!(desk.badge(), "room.json changed on disk: showing yours");
    assert_eq!(desk.session.document, grown(1, 0.5));
    assert!(!desk.report());
    assert_eq!(desk.session.questions.open, None, "not asked again about the same version");
    desk.act(Action::Save);
    assert!(matches!(desk.session.questions.open, Some(Question::ChangedOnDisk { .. })));
    assert_eq!(desk.on_disk(), text(&grown(0, 2.0)), "not overwritten");
    desk.act(Action::Answer(Answer::Overwrite));
    assert_eq!(desk.on_disk(), text(&grown(1, 0.5)));
    assert_eq!(desk.badge(), "");
    // The previous version comes back: nothing is left to decide.
    let mut desk = conflict();
    desk.act(Action::Answer(Answer::Cancel));
    desk.edited(&text(&three()));
    assert_eq!((desk.badge(), &desk.session.questions.open), ("", &None));
    assert_eq!(desk.session.document, grown(1, 0.5));
}

#[test]
fn where_both_did_the_same_or_only_the_layout_changed_there_is_nothing_to_ask() {
    let mut desk = Desk::new();
    desk.change();
    desk.edited(&text(&grown(1, 0.5)));
    assert_eq!(desk.session.questions.open, None);
    assert!(!desk.session.is_dirty(), "the file holds what is shown");
    let mut desk = Desk::new();
    desk.change();
    desk.edited(&text(&three()).replace("  ", "\t"));
    assert_eq!(desk.session.questions.open, None);
    assert_eq!(desk.session.document, grown(1, 0.5));
    assert!(desk.session.is_dirty());
    desk.act(Action::Save);
    assert_eq!(desk.session.questions.open, None);
}

#[test]
fn news_wait_for_the_answer_to_an_open_question() {
    let mut desk = Desk::new();
    desk.change();
    desk.act(Action::Quit);
    desk.edited(&text(&grown(0, 2.0)));
    assert!(matches!(desk.session.questions.open, Some(Question::Unsaved { .. })), "the question stays");
    desk.act(Action::Answer(Answer::Cancel));
    assert!(matches!(desk.session.questions.open, Some(Question::NewerOnDisk { .. })), "then comes the next");
    desk.act(Action::Answer(Answer::Keep));
    assert_eq!(desk.session.questions.open, None);
    // Saving finds the change by itself, and one question is enough.
    let mut desk = Desk::new();
    desk.change();
    desk.act(Action::Quit);
    desk.edited(&text(&grown(0, 2.0)));
    desk.act(Action::Answer(Answer::Save));
    assert!(matches!(desk.session.questions.open, Some(Question::ChangedOnDisk { .. })));
    desk.act(Action::Answer(Answer::Overwrite));
    assert_eq!(desk.session.questions.open, None);
    assert!(desk.left.contains(&Effect::Quit));
    assert_eq!(desk.on_disk(), text(&grown(1, 0.5)));
}

#[test]
fn a_file_that_is_lost_while_a_question_is_open_leaves_its_scene_unsaved() {
    let lost: [fn(&std::path::Path); 3] = [
        |path| fs::remove_file(path).unwrap(),
        |path| fs::write(path, "").unwrap(),
        |path| fs::write(path, &text(&three())[..90]).unwrap(),
    ];
    for happens in lost {
        let mut desk = Desk::new();
        let copy = offer(desk.path(), &grown(1, 0.5));
        let question = Some(Question::Recover(Box::new(copy)));
        desk.session.questions.open.clone_from(&question);
        happens(&desk.path());
        assert!(desk.report() && !desk.report());
        assert!(desk.session.shows_unsaved() && desk.badge().starts_with("room.json "));
        // It holds a scene again: the question is not about that.
        desk.edited(&text(&grown(0, 2.0)));
        assert_eq!(desk.session.document, grown(0, 2.0));
        assert_eq!((desk.badge(), desk.session.shows_unsaved()), ("", false));
        happens(&desk.path());
        assert!(desk.report() && !desk.report());
        assert_eq!(desk.session.questions.open, question);
        let before = desk.session.messages.clone();
        desk.act(Action::Answer(Answer::Discard));
        assert!(desk.session.shows_unsaved() && !desk.report());
        assert_eq!(desk.session.messages, before, "nothing is said twice");

        let mut desk = Desk::new();
        desk.change();
        desk.act(Action::Quit);
        happens(&desk.path());
        assert!(desk.report() && !desk.report());
        assert!(desk.badge().starts_with("room.json "));
        assert!(matches!(desk.session.questions.open, Some(Question::Unsaved { .. })), "the question stays");
    }
}

#[test]
fn a_document_without_a_file_has_nothing_to_follow() {
    let mut desk = Desk::new();
    desk.act(Action::New);
    desk.left.clear();
    let before = format!("{:?}", desk.session);
    desk.edited(&text(&grown(0, 2.0)));
    assert_eq!(format!("{:?}", desk.session), before);
    assert!(desk.left.is_empty());
}

#[cfg(unix)]
#[test]
fn what_can_be_read_only_once_is_not_read_again() {
    let folder = tempfile::tempdir().unwrap();
    let pipe = folder.path().join("pipe");
    let made = std::process::Command::new("mkfifo").arg(&pipe).status().unwrap();
    assert!(made.success());
    let mut files = DiskFiles::new(Some(pipe.clone()), None);
    // Reading would wait for ever.
    assert_eq!(files.check(&pipe, &Registry::builtin(), Outside::NONE), OnDisk::Same);
}

/// The copy of a file that an earlier window left.
fn offer(path: PathBuf, copy: &Scene) -> Offer {
    Offer {
        title: "Room".to_owned(),
        path: Some(path),
        file: PathBuf::from("copy.json"),
        when: String::new(),
        scene: Ok(copy.clone()),
    }
}

/// A window that continues with a copy of the file from an earlier one, with the file's state as known then.
fn recovered(copy: &Scene, known: &str) -> Desk {
    let mut desk = Desk::new();
    let path = desk.path();
    // Like a window without a scene.
    desk.session = Session::default();
    desk.files = DiskFiles::new(None, None);
    desk.session.questions.ask(Question::Recover(Box::new(offer(path.clone(), copy))));
    desk.act(Action::Answer(Answer::Recover));
    desk.files.expect(&path, Some(Stamp::of(known.as_bytes())));
    assert!(desk.session.is_dirty());
    desk
}

#[test]
fn what_is_recovered_is_saved_to_its_file_if_nobody_changed_that() {
    let mut desk = recovered(&grown(1, 0.5), &text(&three()));
    assert!(!desk.report());
    assert_eq!(desk.session.questions.open, None);
    desk.act(Action::Save);
    assert_eq!((&desk.session.questions.open, desk.on_disk()), (&None, text(&grown(1, 0.5))));
    assert!(!desk.session.is_dirty());
}

#[test]
fn what_is_recovered_never_replaces_the_changes_of_others_unasked() {
    // Even if they are those with which an untouched window begins.
    for other in [grown(0, 2.0), Scene::default(), three()] {
        let mut desk = recovered(&grown(1, 0.5), "as it was");
        desk.write(&text(&other));
        desk.report();
        assert!(
            matches!(desk.session.questions.open, Some(Question::NewerOnDisk { .. })),
            "{:?}",
            desk.session.questions.open
        );
        assert_eq!(desk.session.document, grown(1, 0.5));
        desk.act(Action::Answer(Answer::Keep));
        assert!(desk.session.is_dirty());
        desk.act(Action::Save);
        assert_eq!(desk.on_disk(), text(&grown(1, 0.5)));
    }
    // Before the watcher reports it.
    let mut desk = recovered(&grown(1, 0.5), "as it was");
    desk.act(Action::Save);
    assert!(matches!(desk.session.questions.open, Some(Question::ChangedOnDisk { .. })));
    assert_eq!(desk.on_disk(), text(&three()));
}

#[test]
fn what_is_recovered_and_on_disk_by_now_is_saved() {
    let mut desk = recovered(&three(), "as it was");
    desk.report();
    assert_eq!(desk.session.questions.open, None);
    assert!(!desk.session.is_dirty());
}

#[test]
fn the_strip_that_an_error_unfolded_folds_once_it_is_mended() {
    let good = text(&three());
    let strip = |desk: &Desk| (desk.session.view.bottom_open, desk.session.view.bottom_tab.clone());
    let mut desk = Desk::new();
    let before = strip(&desk);
    assert!(!before.0);
    desk.edited("{ broken");
    assert_eq!(strip(&desk), (true, "messages".to_owned()));
    desk.edited("{ worse");
    assert!(desk.session.view.bottom_open, "it is still broken");
    desk.edited(&good);
    assert_eq!(strip(&desk), before);
    // One that the user had open, or has touched since, stays.
    desk.act(Action::View(ViewChange::BottomTab("messages".to_owned())));
    desk.edited("{ broken");
    desk.edited(&good);
    assert!(desk.session.view.bottom_open);
    desk.act(Action::View(ViewChange::Bottom(false)));
    desk.edited("{ broken");
    desk.act(Action::View(ViewChange::BottomTab("messages".to_owned())));
    desk.edited(&good);
    assert!(desk.session.view.bottom_open);
    // Another panel comes back.
    desk.act(Action::View(ViewChange::BottomTab("explain".to_owned())));
    desk.edited("{ broken");
    assert_eq!(strip(&desk), (true, "messages".to_owned()));
    desk.edited(&good);
    assert_eq!(strip(&desk), (true, "explain".to_owned()));
    desk.act(Action::View(ViewChange::Bottom(false)));
    // Another error keeps it.
    desk.edited("{ broken");
    desk.session.say(Severity::Error, "Something else.");
    desk.edited(&good);
    assert!(desk.session.view.bottom_open);
    // A file that was not opened, and is once it is fixed.
    let mut desk = Desk::new();
    let other = desk.folder.path().join("other.json");
    fs::write(&other, "{ broken").unwrap();
    desk.act(Action::Open(other.clone()));
    assert!(desk.session.view.bottom_open && desk.session.path == Some(desk.path()));
    fs::write(&other, &good).unwrap();
    desk.act(Action::Open(other.clone()));
    assert_eq!((desk.session.path.clone(), desk.session.view.bottom_open), (Some(other), false));
    assert!(desk.session.messages.iter().all(|m| m.severity != Severity::Error));
}
