//! Exports from the window: the menu, the dialog, the question, progress and cancellation; and the result on
//! disk.

use std::{fs, path::Path};

use bevy::{
    app::{App, PluginGroup as _},
    ecs::message::Messages,
};
use lights_camera_models::{
    export::FORMS,
    panel::{
        export::SIZE,
        state::{Action, Answer, Effect, ExportCommand, Pin, Question, Running, Session, Severity},
    },
    window::LabPlugins,
};

use crate::{helpers::support::names, library::plugins::app, window::panels::Bench};

#[test]
fn the_menu_offers_every_form_and_a_dialog_asks_for_the_place() {
    let mut bench = Bench::new(Session::default());
    bench.click("File");
    bench.click("Export as ⏵");
    for form in FORMS {
        assert!(bench.find(&format!("{}…", form.name)).is_some(), "{}", form.name);
    }
    bench.click("Bevy project…");
    assert!(bench.dialogs.is_open() && bench.says("Export as Bevy project"));
}

#[test]
fn nothing_is_replaced_unasked() {
    let mut bench = Bench::new(Session::default());
    bench
        .session
        .questions
        .ask(Question::ReplaceExport { form: "bevy", path: "/somewhere/scene_bevy".into() });
    bench.settle();
    assert!(bench.says("/somewhere/scene_bevy exists. Replace it with the export?"));
    bench.apply(Action::Answer(Answer::Cancel));
    assert_eq!(bench.effects, []);
    bench
        .session
        .questions
        .ask(Question::ReplaceExport { form: "bevy", path: "/somewhere/scene_bevy".into() });
    bench.apply(Action::Answer(Answer::Overwrite));
    let path = "/somewhere/scene_bevy".into();
    assert_eq!(bench.effects, [Effect::Export { form: "bevy", path, overwrite: true }]);
}

#[test]
fn the_progress_is_shown_and_can_be_stopped() {
    let mut bench = Bench::new(Session::default());
    assert!(!bench.says("Exporting"));
    bench.session.facts.export = Some(Running { label: "Web page", done: 0.5, step: "packing".to_owned() });
    bench.settle();
    assert!(bench.says("Exporting as Web page"));
    // One at a time.
    bench.apply(Action::Export(ExportCommand::Dialog("bevy")));
    assert_eq!(bench.effects, []);
    assert!(bench.session.messages.iter().any(|m| m.text.starts_with("An export is still running")));
    bench.click("Cancel");
    assert_eq!(bench.effects, [Effect::CancelExport]);
}

#[test]
fn the_shader_of_the_object_goes_to_the_clipboard() {
    let mut bench = Bench::new(Session::default());
    bench.key(bevy_egui::egui::Key::F9, bevy_egui::egui::Modifiers::NONE);
    bench.click("Copy as…");
    assert!(bench.find("SPIR-V shader").is_none(), "it is no text");
    bench.click("GLSL shaders");
    let text = bench.copied.clone().expect("something was copied");
    assert!(text.contains("#version 450 core") && text.contains("incident_point"), "{text}");
}

/// Runs an export in a windowless window, until it reports the result.
fn export(app: &mut App, effect: Effect) -> Vec<(Severity, String)> {
    let before = app.world().resource::<Session>().messages.len();
    app.world_mut().resource_mut::<Messages<Effect>>().write(effect);
    for _ in 0..12_000 {
        app.update();
        let session = app.world().resource::<Session>();
        if session.messages.len() > before || session.questions.open.is_some() {
            return session.messages[before..].iter().map(|m| (m.severity, m.text.clone())).collect();
        }
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    panic!("the export does not end");
}

#[test]
fn an_export_of_the_window_is_on_disk_at_the_end_and_says_so() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = folder.path().join("room.json");
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/shapes_and_lights.json");
    fs::copy(shipped, &scene).expect("writable");
    let plugins = LabPlugins::default().scene(&scene).size(64, 36).exit_after(100_000).headless();
    let mut app = app(plugins.build(), |_| ());
    let to = |form: &'static str, name: &str, overwrite: bool| Effect::Export {
        form,
        path: folder.path().join(name),
        overwrite,
    };
    let said = export(&mut app, to("bevy", "project", false));
    let project = folder.path().join("project");
    assert_eq!(said, [(Severity::Info, format!("Exported as Bevy project to {}.", project.display()))]);
    assert_eq!(names(&project), ["Cargo.toml", "assets", "src"]);
    // The same place again: a question, and the folder is left unchanged.
    fs::write(project.join("mine.txt"), "notes").expect("writable");
    let said = export(&mut app, to("bevy", "project", false));
    assert_eq!(said, []);
    let mut session = app.world_mut().resource_mut::<Session>();
    let asked = session.questions.open.take();
    assert_eq!(asked, Some(Question::ReplaceExport { form: "bevy", path: project.clone() }));
    assert!(project.join("mine.txt").exists());
    // Parts that a form cannot contain are reported, and nothing is written.
    session.document.change(
        "Tone mapping",
        lights_camera_models::document::Extent::Rest,
        Default::default(),
        |scene| {
            scene.display.tone_mapping = lights_camera_models::optics::tone::ToneMapping::AgX;
        },
    );
    let said = export(&mut app, to("glsl", "shaders", false));
    assert!(said.iter().all(|(severity, _)| *severity == Severity::Error), "{said:?}");
    assert!(said.iter().any(|(_, text)| text.contains("agx is a table")), "{said:?}");
    assert_eq!(names(folder.path()), ["project", "room.json"]);
}

/// A windowless window that writes pages.
pub struct Opened {
    app: App,
    folder: std::path::PathBuf,
}

impl Opened {
    /// Opens a scene.
    pub fn new(scene: &Path) -> Self {
        let plugins = LabPlugins::default().scene(scene).size(64, 36).exit_after(100_000).headless();
        Self {
            app: app(plugins.build(), |_| ()),
            folder: scene.parent().expect("it is in a folder").to_owned(),
        }
    }

    /// Pins a pixel of a picture of the size of exports.
    pub fn pin(&mut self, pixel: [u32; 2]) {
        let mut session = self.app.world_mut().resource_mut::<Session>();
        let pin = Pin::of_pixel(0, pixel, SIZE.into(), session.document.view_angle());
        session.view.pinned = Some(pin);
    }

    /// Writes the page, and returns it.
    pub fn page(&mut self, name: &str) -> String {
        let path = self.folder.join(name);
        let said =
            export(&mut self.app, Effect::Export { form: "html", path: path.clone(), overwrite: false });
        assert!(said.iter().all(|(severity, _)| *severity == Severity::Info), "{said:?}");
        fs::read_to_string(path).expect("UTF-8")
    }
}
