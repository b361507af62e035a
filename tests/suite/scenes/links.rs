//! Scenes in the ends of addresses: every shipped one, what they cannot hold, and the commands that open them.

use std::fs;

use bevy_egui::egui::PointerButton;
use lights_camera_models::{
    panel::state::{Action, Effect, LessonCommand, LessonSource, Session, Severity},
    parameter::{NamedFile, Value},
    registry::Registry,
    scene::{
        Scene,
        examples::EXAMPLES,
        link,
        load::{self, Defaults},
        save,
    },
    shape::mesh_file,
};

use crate::{
    helpers::support::{lcm_in, root},
    window::panels::Bench,
};

/// The scene to which a link leads.
fn followed(link: &str) -> Result<Scene, String> {
    let json = link::unpacked(link)?;
    let loaded = load::from_text(&json, "link", &Registry::builtin(), Defaults::Refuse);
    loaded.map(|loaded| loaded.scene).map_err(|error| error.to_string())
}

#[test]
fn every_shipped_scene_has_a_link_that_leads_to_it() {
    let registry = Registry::builtin();
    let mut longest = 0;
    for example in EXAMPLES.iter() {
        let scene = example.scene(&registry).unwrap_or_else(|e| panic!("{e}"));
        let link = link::made(&scene, &registry).unwrap_or_else(|why| panic!("{}: {why}", example.file));
        assert!(link.is_ascii() && link.len() <= link::MOST_MADE, "{}: {}", example.file, link.len());
        assert_eq!(followed(&link).as_ref(), Ok(&scene), "{}", example.file);
        longest = longest.max(link.len());
    }
    assert!(longest > 2_000, "some are large: {longest}");
    // The wrong twin.
    let mut scene = Scene::default();
    let before = link::made(&scene, &registry).expect("small");
    scene.objects[0].size = 3.0;
    let after = link::made(&scene, &registry).expect("small");
    assert!(before != after && followed(&before) != followed(&after));
    assert_eq!(followed(&after), Ok(scene));
}

#[test]
fn what_a_link_cannot_hold_is_named() {
    let registry = Registry::builtin();
    let mut scene = Scene::default();
    let folder = root().join("scenes");
    scene.objects[0]
        .shape
        .set("path", Value::File(NamedFile::chosen("gem.obj", &folder, &mesh_file::FORMAT)));
    let said = link::made(&scene, &registry).expect_err("a file beside it");
    assert!(said.starts_with("a link cannot hold gem.obj, which the scene needs; save the scene"), "{said}");
    let words = (0..4_000_u32).map(|i| format!("{:x}", i.wrapping_mul(2_654_435_761)));
    let novel = Scene { description: Some(words.collect()), ..Scene::default() };
    let said = link::made(&novel, &registry).expect_err("too long");
    assert!(said.contains(" characters, and a link has at most 8000; save the scene"), "{said}");
    let none = Scene { lights: Vec::new(), ..Scene::default() };
    let said = link::made(&none, &registry).expect_err("no light");
    assert!(said.starts_with("the scene has problems: "), "{said}");
}

#[test]
fn commands_open_links_like_files() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = Scene { reflection_model: "oren_nayar".to_owned(), ..Scene::default() };
    let end = link::packed(&save::to_json(&scene, None, &Registry::builtin()));
    let whole = format!("https://lab.example.org/a/?x=1{end}");
    for link in [end.as_str(), whole.as_str()] {
        let run = lcm_in(folder.path(), &["check", link], b"");
        assert_eq!((run.status, run.err.as_str()), (Some(0), ""), "{link}");
        assert!(run.out.starts_with("link: valid: 1 light, 1 object"), "{}", run.out);
    }
    let run = lcm_in(folder.path(), &["render", "--renderer", "cpu", "--size", "16x9", &whole], b"");
    assert_eq!(run.status, Some(0), "{}", run.err);
    let picture = folder.path().join("renders/link.png");
    let said = lcm_in(folder.path(), &["check", "--json", &picture.to_string_lossy()], b"");
    assert_eq!(said.status, Some(0), "{}", said.err);
    assert!(fs::metadata(&picture).is_ok_and(|picture| picture.len() > 100));
    // Wrong twins.
    for (link, words) in [
        (&whole[..whole.len() - 5], "link: it is damaged"),
        ("#scene=2.AAAA", "link: it is of version 2"),
        (&*link::packed("{ \"lights\": 7 }"), "link:1:"),
    ] {
        let run = lcm_in(folder.path(), &["check", link], b"");
        assert_eq!(run.status, Some(1), "{link}");
        let said = run.out + &run.err;
        assert!(said.contains(words), "{link}: {said}");
    }
}

#[test]
fn links_are_copied_from_the_menu_and_from_the_list_of_steps() {
    let mut bench = Bench::new(Session::default());
    bench.session.settings.web_address = Some("https://lab.example.org/".to_owned());
    bench.settle();
    bench.click("File");
    // Its key, which it has not, would follow.
    let entry = bench.tree.iter().find(|seen| seen.label.starts_with("Copy link to this scene"));
    let entry = entry.expect("an entry").rect;
    bench.click_at(entry.center(), PointerButton::Primary);
    let copied = bench.copied.take().expect("copied");
    let end = copied.strip_prefix("https://lab.example.org/").expect("the address of the settings");
    assert_eq!(followed(end).map(|scene| scene.objects), Ok(Scene::default().objects));
    let last = bench.session.messages.last().map(|note| (note.severity, note.text.as_str()));
    assert_eq!(last, Some((Severity::Info, "Copied the link to this scene.")));
    assert!(!bench.effects.iter().any(|effect| matches!(effect, Effect::CopyText(_))));

    let open = Action::Lesson(LessonCommand::Open(LessonSource::Shipped(0)));
    bench.apply(open);
    bench.apply(Action::Lesson(LessonCommand::GoTo(1)));
    let steps = bench.session.lesson.as_ref().map_or(0, |open| open.lesson.steps.len());
    bench.click(&format!("Step 2 of {steps} ▾"));
    bench.click("Copy link to this step");
    let name = LessonSource::Shipped(0).name();
    assert_eq!(bench.copied.take(), Some(format!("https://lab.example.org/?lesson={name}&step=2")));
}
