//! Scene formats from other crates: known everywhere, checked like ours, and never a cause of data loss. And
//! scenes for serde.

use std::{fs, path::Path};

use lights_camera_models::{
    document::Edit,
    panel::{
        effects,
        state::{Action, Answer, Effect, Pick, Session},
    },
    parameter::{ALPHA, BASE_COLOUR, K_D, Value},
    registry::Registry,
    scene::{
        Display, Light, Object, Observer, Part, Scene, SceneSize,
        error::LoadError,
        formats::{self, Parsed, SceneFormat, SceneFormats as _, SceneWriter, Source, Target},
        load::{self, Defaults},
        save::{self, Expected},
    },
    window::files::DiskFiles,
};
use proptest::prelude::*;
use serde::de::DeserializeSeed as _;

use crate::{
    helpers::support::{check_wording, lcm_in},
    scenes::roundtrip::scene,
};

#[path = "../../../examples/format.rs"]
#[allow(dead_code)]
pub mod example;

/// JSON with another extension; its writer may forget something.
struct Other {
    name: &'static str,
    extensions: &'static [&'static str],
    forgets: Option<fn(&mut Scene)>,
}

impl Other {
    const GOOD: Self = Self { name: "other", extensions: &["other"], forgets: None };
}

impl SceneFormat for Other {
    fn name(&self) -> &'static str {
        self.name
    }

    fn extensions(&self) -> &'static [&'static str] {
        self.extensions
    }

    fn read<'a>(&self, source: &'a Source<'_>, registry: &'a Registry) -> Result<Parsed<'a>, LoadError> {
        formats::Json.read(source, registry)
    }

    fn writer(&self) -> Option<&dyn SceneWriter> {
        Some(self)
    }
}

impl SceneWriter for Other {
    fn write(&self, scene: &Scene, _: &Target<'_>, registry: &Registry) -> Result<Vec<u8>, String> {
        let mut scene = scene.clone();
        if let Some(forget) = self.forgets {
            forget(&mut scene);
        }
        Ok(save::to_json(&scene, None, registry).into_bytes())
    }
}

fn registry() -> Registry {
    let mut registry = Registry::builtin();
    registry.add_scene_format(example::Spheres);
    registry
}

fn said(text: &str, name: &str, registry: &Registry) -> String {
    let read = load::from_text(text, name, registry, Defaults::Refuse);
    read.err().map_or_else(String::new, |error| error.to_string())
}

#[test]
fn a_format_from_outside_is_read_and_checked_like_ours() {
    let registry = registry();
    let loaded =
        load::from_text("2 3 4 1\n5 5 5 0.5\n", "a.spheres", &registry, Defaults::Refuse).expect("valid");
    assert_eq!(loaded.scene.objects.len(), 2);
    assert_eq!(loaded.scene.objects[1].size, 0.5);
    for (text, expected) in [
        ("2 3 4 1\n5 5 5\n", "a.spheres:2:1: not list of spheres: a line needs four numbers: x y z size"),
        ("2 3 4 1\n5 5 5 -1\n", "a.spheres:2:1: objects[1].size is -1, but a size must be greater than 0"),
        (
            "2 3 4 1\n5 5 15 1\n5 5 0 1\n",
            "a.spheres:2:1: objects[1].position is [5, 5, 15], but a position must",
        ),
        (" ", "a.spheres is empty"),
    ] {
        let said = said(text, "A.spheres".to_lowercase().as_str(), &registry);
        assert!(said.contains(expected), "{said}");
    }
    // Both errors of the last are listed, in the order of the file.
    let both = said("2 3 4 1\n5 5 15 1\n5 5 0 1\n", "a.spheres", &registry);
    assert!(
        both.lines().count() == 2 && both.lines().nth(1).is_some_and(|l| l.starts_with("a.spheres:3:1")),
        "{both}"
    );
    // Also in capitals.
    assert_eq!(said("2 3 4 1\n", "A.SPHERES", &registry), "");
}

#[test]
fn an_unknown_extension_is_told_with_those_that_are_known() {
    let ours = "room.txt: .txt is not the extension of a scene; scenes are *.json (JSON), *.csv (CSV), *.png (PNG picture), \
                *.exr (OpenEXR picture) or *.hdr (Radiance picture)";
    assert_eq!(said("{}", "room.txt", &Registry::builtin()), ours);
    let theirs = said("{}", "room.txt", &registry());
    assert!(
        theirs.ends_with("*.exr (OpenEXR picture), *.hdr (Radiance picture) or *.spheres (list of spheres)"),
        "{theirs}"
    );
    check_wording(&theirs);
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("room.txt"), "{}").expect("written");
    for command in ["check", "render", "view"] {
        let run = lcm_in(folder.path(), &[command, "room.txt"], b"");
        assert!(run.status == Some(1) && run.err.contains(ours), "{}", run.err);
    }
    let run = lcm_in(folder.path(), &["new", "new.txt"], b"");
    assert!(
        run.status == Some(4) && run.err.contains("new.txt was not written: .txt is not the extension"),
        "{}",
        run.err
    );
    // Without an extension, a file is JSON, as always.
    let run = lcm_in(folder.path(), &["new", "room"], b"");
    assert_eq!(run.status, Some(0), "{}", run.err);
    assert_eq!(lcm_in(folder.path(), &["check", "room"], b"").status, Some(0));
}

#[test]
fn each_mistake_of_a_format_is_told_by_name() {
    let mut registry = registry();
    let good = Other::GOOD;
    for (wrong, expected) in [
        (Other { name: " ", ..good }, "it needs a display name"),
        (Other { extensions: &[], ..Other::GOOD }, "it needs an extension"),
        (
            Other { extensions: &[".other"], ..Other::GOOD },
            "the extension \".other\" must be lower-case letters and digits, without a dot",
        ),
        (Other { extensions: &["Other"], ..Other::GOOD }, "\"Other\" must be lower-case"),
        (Other { extensions: &["a", "a"], ..Other::GOOD }, "\"a\" is listed twice"),
        (
            Other { extensions: &["a", "csv"], ..Other::GOOD },
            "the extension \"csv\" belongs to the format CSV",
        ),
        (
            Other { extensions: &["spheres"], ..Other::GOOD },
            "\"spheres\" belongs to the format list of spheres",
        ),
        (Other { name: "JSON", ..Other::GOOD }, "a format of that name already exists"),
    ] {
        let name = wrong.name;
        let error = registry.try_add_scene_format(wrong).expect_err("refused").to_string();
        assert!(error.contains(expected) && error.contains(name), "{error}");
    }
    assert_eq!(registry.scene_formats().len(), 1, "nothing was added");
    registry.add_scene_format(Other::GOOD);
    let names: Vec<_> = formats::all(&registry).map(SceneFormat::name).collect();
    assert_eq!(
        names,
        ["JSON", "CSV", "PNG picture", "OpenEXR picture", "Radiance picture", "list of spheres", "other"]
    );
}

#[test]
fn what_a_writer_forgets_is_named_and_the_file_stays() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("room.other");
    let mut scene = Scene::default();
    scene.objects.push(Object {
        name: Some("Second".to_owned()),
        position: [3.0; 3].into(),
        ..Object::default()
    });
    scene.objects[1].material.set("k_d", Value::Number(0.75));
    let forgets: [(fn(&mut Scene), &str); 4] = [
        (|scene| scene.objects[1].name = None, "its format would lose objects[1].name"),
        (
            |scene| scene.objects[1].material.set("k_d", Value::Number(0.5)),
            "would lose objects[1].material.k_d",
        ),
        (|scene| drop(scene.objects.pop()), "would lose objects[1];"),
        (|scene| scene.objects.clear(), "what was written could not be read again"),
    ];
    for (forget, expected) in forgets {
        let mut registry = registry();
        registry.add_scene_format(Other { forgets: Some(forget), ..Other::GOOD });
        fs::write(&path, "precious").expect("written");
        let error =
            save::write(&path, &scene, &registry, Expected::Anything).expect_err("refused").to_string();
        assert!(error.contains(expected) && error.contains("save the scene as JSON"), "{error}");
        assert_eq!(fs::read_to_string(&path).expect("there"), "precious");
        assert_eq!(fs::read_dir(folder.path()).expect("readable").count(), 1, "no draft is left");
    }
    // The right twin forgets nothing.
    let mut registry = registry();
    registry.add_scene_format(Other::GOOD);
    save::write(&path, &scene, &registry, Expected::Anything).expect("written");
    assert_eq!(load::file(&path, &registry, Defaults::Refuse).expect("valid").scene, scene);
}

/// A document opened from a file, and the files of its window.
pub struct Desk {
    pub session: Session,
    files: DiskFiles,
    registry: Registry,
    pub left: Vec<Effect>,
}

impl Desk {
    pub fn open(path: &Path, registry: Registry) -> Self {
        let files = DiskFiles::new(None, None);
        let mut desk = Self { session: Session::default(), files, registry, left: Vec::new() };
        desk.act(Action::Open(path.to_owned()));
        assert_eq!(desk.session.path.as_deref(), Some(path), "{:?}", desk.session.messages.last());
        desk
    }

    pub fn act(&mut self, action: Action) {
        let effects = self.session.apply(action, &self.registry);
        self.carry_out(effects);
    }

    fn carry_out(&mut self, effects: Vec<Effect>) {
        for effect in effects {
            if effect == Effect::DocumentChanged {
                self.files.document_changed(self.session.path.as_deref());
            }
            let more = effects::run(&mut self.session, &self.registry, effect.clone(), &mut self.files);
            if more == [effect.clone()] { self.left.push(effect) } else { self.carry_out(more) }
        }
    }
}

#[test]
fn a_scene_whose_format_can_only_be_read_is_saved_as_json_and_quitting_waits_for_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("balls.spheres");
    let text = "2 3 4 1\n5 5 5 0.5\n";
    fs::write(&path, text).expect("written");
    let mut desk = Desk::open(&path, registry());
    assert_eq!(desk.session.document.objects.len(), 2);
    assert!(desk.session.settings.recent_files[0].ends_with("balls.spheres"));
    desk.act(Action::Edit(Edit::set(Part::Scene, Scene::name, "Balls")));
    desk.act(Action::Quit);
    desk.act(Action::Answer(Answer::Save));
    assert!(desk.left.contains(&Effect::Pick(Pick::Save)), "{:?}", desk.left);
    let said = &desk.session.messages.last().expect("said").text;
    assert!(
        said.contains("balls.spheres was not written: files of the format list of spheres can only be read"),
        "{said}"
    );
    assert!(
        said.contains("save the scene as JSON, for example as ") && said.contains("balls.json"),
        "{said}"
    );
    assert!(desk.session.is_dirty() && !desk.left.contains(&Effect::Quit));
    assert_eq!(fs::read_to_string(&path).expect("there"), text);
    // The dialog is answered; the pending action continues.
    desk.act(Action::SaveAs(folder.path().join("balls.json")));
    assert!(!desk.session.is_dirty() && desk.left.contains(&Effect::Quit));
    let saved =
        load::file(&folder.path().join("balls.json"), &desk.registry, Defaults::Refuse).expect("valid");
    assert_eq!(saved.scene.name.as_deref(), Some("Balls"));
    assert_eq!(fs::read_to_string(&path).expect("there"), text);
}

#[test]
fn a_name_that_is_typed_decides_on_the_format() {
    let folder = tempfile::tempdir().expect("a folder");
    let typed = |name: &str| {
        let mut desk = Desk {
            session: Session::default(),
            files: DiskFiles::new(None, None),
            registry: registry(),
            left: Vec::new(),
        };
        desk.act(Action::SaveAs(folder.path().join(name)));
        desk.session
            .path
            .and_then(|path| Some(path.file_name()?.to_string_lossy().into_owned()))
            .unwrap_or_default()
    };
    for (name, file) in [
        ("a", "a.json"),
        ("b.csv", "b.csv"),
        ("c.CSV", "c.CSV"),
        // The dialog adds the extension chosen in it.
        ("d.csv.json", "d.csv"),
        ("e.json.csv", "e.json"),
        // This one cannot be written.
        ("f.spheres", "f.spheres.json"),
        ("g.txt", "g.txt.json"),
    ] {
        assert_eq!(typed(name), file);
        assert!(load::file(&folder.path().join(file), &registry(), Defaults::Refuse).is_ok(), "{file}");
    }
    assert!(fs::read_to_string(folder.path().join("b.csv")).expect("written").starts_with("part,"));
}

#[test]
fn an_edited_table_is_saved_as_a_table_and_followed() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("wheel.csv");
    fs::copy(crate::helpers::support::root().join("scenes/colour_wheel.csv"), &path).expect("copied");
    let mut desk = Desk::open(&path, registry());
    desk.act(Action::Edit(Edit::set(Part::Scene, Scene::name, "Mine")));
    desk.act(Action::Save);
    assert!(!desk.session.is_dirty(), "{:?}", desk.session.messages.last());
    let text = fs::read_to_string(&path).expect("written");
    assert!(text.starts_with("# ") && text.contains("\nscene,,Mine,"), "{text}");
    // Another program changes it.
    fs::write(&path, text.replace("Mine", "Theirs")).expect("written");
    desk.carry_out(vec![Effect::CheckFile { discard: false }]);
    assert_eq!(desk.session.title(), "Theirs");
    // And breaks it: the last valid version stays, and the error has a position.
    fs::write(&path, text.replace(",sphere,Red,", ",sphre,Red,")).expect("written");
    (0..2).for_each(|_| desk.carry_out(vec![Effect::CheckFile { discard: false }]));
    assert_eq!(desk.session.title(), "Theirs");
    assert!(desk.session.messages.iter().any(|m| m.text.contains("wheel.csv:6:8: objects[0].type is sphre")));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn every_scene_and_its_parts_come_back_through_serde(scene in scene()) {
        let text = serde_json::to_string(&scene).unwrap();
        let value = serde_json::to_value(&scene).unwrap();
        prop_assert_eq!(&serde_json::from_str::<Scene>(&text).unwrap(), &scene);
        prop_assert_eq!(&serde_json::from_value::<Scene>(value).unwrap(), &scene);
        // The structure is that of scene files.
        prop_assert_eq!(&load::from_text(&text, "a.json", &Registry::builtin(), Defaults::Refuse).unwrap().scene, &scene);
        for light in &scene.lights {
            prop_assert_eq!(&serde_json::from_value::<Light>(serde_json::to_value(light).unwrap()).unwrap(), light);
        }
        for object in &scene.objects {
            prop_assert_eq!(&serde_json::from_value::<Object>(serde_json::to_value(object).unwrap()).unwrap(), object);
        }
        let again = serde_json::from_value::<Observer>(serde_json::to_value(scene.observer).unwrap()).unwrap();
        prop_assert_eq!(again, scene.observer);
        let again = serde_json::from_value::<SceneSize>(serde_json::to_value(scene.scene_size).unwrap()).unwrap();
        prop_assert_eq!(again, scene.scene_size);
        let again = serde_json::from_value::<Display>(serde_json::to_value(scene.display).unwrap()).unwrap();
        prop_assert_eq!(again, scene.display);
    }
}

#[test]
fn serde_refuses_what_a_file_may_not_hold() {
    let value = serde_json::to_value(Scene::default()).unwrap();
    let said = |change: fn(&mut serde_json::Value)| {
        let mut value = value.clone();
        change(&mut value);
        serde_json::from_value::<Scene>(value).err().map_or_else(String::new, |e| e.to_string())
    };
    assert_eq!(said(|_| ()), "");
    assert_eq!(
        said(|v| v["objects"][0]["size"] = (-1).into()),
        "objects[0].size is -1, but a size must be greater than 0"
    );
    assert!(
        said(|v| v["objects"][0]["colour"] = 1.into())
            .contains("objects[0].colour is not a key of an object")
    );
    assert!(said(|v| v["lights"] = 5.into()).contains("lights is 5, but a scene must have a list of lights"));
    let part = serde_json::from_str::<Light>(r#"{ "type": "point", "intensity": "bright" }"#)
        .unwrap_err()
        .to_string();
    assert!(part.contains("intensity is \"bright\", but it must be a number"), "{part}");
    // One parameter: its declaration determines the meaning of a number or a list.
    let value = |p: &'static lights_camera_models::parameter::Parameter, json: &str| {
        p.deserialize(&mut serde_json::Deserializer::from_str(json)).map_err(|e| e.to_string())
    };
    assert_eq!(value(&K_D, "0.75"), Ok(Value::Number(0.75)));
    assert_eq!(value(&ALPHA, "8"), Ok(Value::Integer(8)));
    assert_eq!(value(&BASE_COLOUR, "[1, 2, 3]"), Ok(Value::Colour([1, 2, 3])));
    for (p, json) in [(&K_D, "0.2"), (&K_D, "\"0.75\""), (&BASE_COLOUR, "[1, 2]"), (&ALPHA, "null")] {
        let said = value(p, json).unwrap_err();
        assert!(said.starts_with(p.name) && said.contains(" must be "), "{said}");
    }
}
