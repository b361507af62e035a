//! The document and its file: opening, saving, replacing.

use std::path::{Path, PathBuf};

use super::{Action, Effect, Note, Pick, RECENT_FILES, Session, Severity};
use crate::{
    document::{Document, Edit, Extent, Selection},
    files::{self, Shown as _},
    optics::TermSelection,
    parameter::{NamedFile, Outside, Parameter, Value, Values},
    platform::fs,
    registry::Registry,
    scene::{Key, Part, Scene, examples::EXAMPLES, formats},
};

/// The file for a name typed for a scene: keeps the extension of a writable format, once, and otherwise appends that of
/// JSON.
fn scene_file(typed: &Path, registry: &Registry) -> PathBuf {
    let known = |path: &Path| formats::can_write(path, registry);
    if known(typed) {
        return files::meant(typed, "json", known);
    }
    let mut name = typed.as_os_str().to_owned();
    name.push(".json");
    name.into()
}

/// Rewrites the file names among some values for a scene in this folder. Returns true if any name has changed.
fn see_from(values: &mut Values, folder: &Path) -> bool {
    let mut changed = false;
    for value in values.0.values_mut() {
        if let Value::File(file) = value {
            let there = file.seen_from(folder);
            changed |= there != *file;
            *file = there;
        }
    }
    changed
}

impl Session {
    /// Makes a scene read from a file the document.
    pub fn opened(&mut self, path: PathBuf, scene: Scene) -> Vec<Effect> {
        self.show_opened(path, scene);
        self.requests()
    }

    pub(super) fn show_opened(&mut self, path: PathBuf, scene: Scene) {
        self.view.examples_open = false;
        self.healed(&path);
        self.remember_file(&path);
        self.replace_document(Some(path), scene);
        self.requested.extend([Effect::DocumentChanged, Effect::SaveSettings]);
    }

    /// Saves the document to its file, or asks for one.
    pub(super) fn save(&mut self) {
        self.request(match self.path.clone() {
            Some(path) => Effect::SaveFile { path, overwrite: false },
            None => Effect::Pick(Pick::Save),
        });
    }

    /// Saves the document to a file with the typed name.
    pub(super) fn save_as(&mut self, typed: &Path, registry: &Registry) {
        // The default scene and examples take the name of their file from now on.
        let shipped = |name: &String| EXAMPLES.iter().any(|example| example.name == *name);
        if self.lesson.is_none() && self.path.is_none() && self.document.name.as_ref().is_some_and(shipped) {
            self.document
                .change("Name of the scene", Extent::Rest, self.selection, |scene| scene.name = None);
        }
        // The dialog asked only about the exact name that was typed.
        let path = scene_file(typed, registry);
        let overwrite = path == typed;
        self.keep_files(&path);
        self.request(Effect::SaveFile { path, overwrite });
    }

    /// True for the name, and for the description, if they are those of the default scene and still apply. False in a
    /// lesson, which has its own. A scene in a file keeps its name, which stands beside that of the file.
    pub(super) fn default_words(&self) -> [bool; 2] {
        let scene = self.document.scene();
        let ([light], [object], None) = (&scene.lights[..], &scene.objects[..], &self.lesson) else {
            return [false; 2];
        };
        let default = Scene::default();
        let (lamp, ball) = (&default.lights[0], &default.objects[0]);
        let parts = object.object_type == ball.object_type && light.light_type == lamp.light_type;
        let look = parts
            && scene.model_of(object) == default.reflection_model
            && (light.colour, light.colour_temperature) == (lamp.colour, None);
        [
            parts && self.path.is_none() && scene.name == default.name,
            look && scene.description == default.description,
        ]
    }

    /// Removes the default name and description, as part of the step that made them wrong. `before` says which of them
    /// applied before the step.
    pub(super) fn forget_default_words(&mut self, before: [bool; 2]) {
        let now = self.default_words();
        let default = Scene::default();
        let scene = self.document.scene();
        let name = before[0] && !now[0] && scene.name == default.name;
        let description = before[1] && !now[1] && scene.description == default.description;
        if (name || description) && self.lesson.is_none() && self.document.done() > 0 {
            self.document.go_on(Extent::Rest, |scene| {
                if name {
                    scene.name = None;
                }
                if description {
                    scene.description = None;
                }
            });
        }
    }

    /// Makes file names of lights and objects relative to the scene's folder absolute, if they would not be found from
    /// the scene's new folder.
    fn keep_files(&mut self, path: &Path) {
        let folder = path.parent().unwrap_or(Path::new(""));
        let mut scene = self.document.scene().clone();
        let lights = scene.lights.iter_mut().map(|light| &mut light.parameters).enumerate();
        let lights = lights.map(|(i, values)| (Extent::Light(i), values));
        let lights = lights.map(|(part, values)| (part, see_from(values, folder)));
        let objects = scene.objects.iter_mut().enumerate().map(|(i, object)| {
            let seen = [&mut object.shape, &mut object.material].map(|values| see_from(values, folder));
            (Extent::Object(i), seen.contains(&true))
        });
        let variants = scene.variants.iter_mut();
        let variants = variants.map(|variant| (Extent::Rest, see_from(&mut variant.material, folder)));
        let all = lights.chain(objects).chain(variants);
        let moved = all.filter_map(|(part, seen)| seen.then_some(part));
        for part in moved.collect::<Vec<_>>() {
            self.document.change("Place of a file", part, self.selection, |to| part.copy(&scene, to));
        }
        self.outside.allow(self.document.files());
    }

    /// The edit that sets a file parameter of a light, an object or a material. The name is relative to the folder of the scene if
    /// the file is inside it.
    pub(in crate::panel) fn file_chosen(
        &self,
        part: Selection,
        key: Key,
        parameter: &'static Parameter,
        path: &Path,
        registry: &Registry,
    ) -> Option<Edit> {
        let file = self.chosen(parameter, path)?;
        Some(self.setting(part, key, parameter, file, registry))
    }

    /// The edit that sets a parameter of a light or an object, with what has to follow.
    pub(super) fn setting(
        &self,
        part: Selection,
        key: Key,
        parameter: &'static Parameter,
        value: Value,
        registry: &Registry,
    ) -> Edit {
        let light = match part {
            Selection::Light(i) => self.document.lights.get(i),
            _ => None,
        };
        let found = light.and_then(|light| Some((light, registry.light(&light.light_type)?)));
        let part = Part::from(part);
        match found {
            Some((light, entry)) => {
                Edit::Set { part, values: light.setting(entry, parameter, value), what: None }
            }
            None => Edit::set(part, key, value),
        }
    }

    /// A selected file, as the value of a parameter.
    pub(super) fn chosen(&self, parameter: &Parameter, path: &Path) -> Option<Value> {
        let format = parameter.kind.format()?;
        let folder = self.path.as_deref().and_then(Path::parent).unwrap_or(Path::new(""));
        let below = fs::absolute(folder).ok().filter(|_| self.path.is_some());
        let written = below.and_then(|folder| path.strip_prefix(folder).ok()).unwrap_or(path);
        Some(Value::File(NamedFile::chosen(&written.to_string_lossy(), folder, format)))
    }

    /// Records that the document has been saved. Returns the effects of the action pending on it.
    pub fn saved(&mut self, path: PathBuf, registry: &Registry) -> Vec<Effect> {
        self.remember_file(&path);
        self.note_saved(&path);
        self.path = Some(path);
        self.document.mark_saved(registry);
        self.disk_saved();
        self.request(Effect::SaveSettings);
        if let Some(action) = self.questions.after_save.take() {
            self.act(action, registry);
        }
        self.requests()
    }

    /// Records that a copy of the open lesson's scene has been saved.
    pub(in crate::panel) fn copy_saved(&mut self, path: &Path) -> Vec<Effect> {
        self.remember_file(path);
        let text = format!("A copy of this scene was saved to {}; the lesson goes on.", path.shown());
        self.note_file(text, path);
        vec![Effect::SaveSettings]
    }

    /// The message that the scene was kept in something, and that the camera is not, if it has left the observer.
    pub(super) fn with_view(&self, mut note: Note, kept_in: &str) -> Note {
        if !self.facts.camera_is_free {
            return note;
        }
        let text = format!(" The {kept_in} keeps the observer’s view, not the one you turned to.");
        note.text.push_str(&text);
        match self.observer_problem() {
            None => note.offering("Set observer to this view", Action::Do(Effect::ObserverFromView)),
            Some(why) => {
                note.text.push_str(&format!(" {why}"));
                note
            }
        }
    }

    pub(super) fn note_saved(&mut self, path: &Path) {
        let note = Note::new(Severity::Info, format!("Saved to {}.", path.shown()));
        let mut note = self.with_view(note, "file");
        let folder = files::folder_of(path);
        if let Some(file) = self.document.files().find(|file| file.is_outside(folder)) {
            let option = Outside::OPTION;
            note.text.push_str(&format!(
                " It names {}, outside its folder: copy it there, or start with {option} to open it again.",
                file.name()
            ));
        }
        self.messages.retain(|m| m.severity != Severity::Info || !m.text.starts_with("Saved to "));
        self.note(note);
    }

    /// Shows a scene that has no file.
    pub(super) fn start_with(&mut self, scene: Scene) {
        self.replace_document(None, scene);
        self.request(Effect::DocumentChanged);
    }

    pub(super) fn open_example(&mut self, i: usize, registry: &Registry) {
        match EXAMPLES.get(i).map(|example| example.scene(registry)) {
            Some(Ok(scene)) => self.start_with(scene),
            Some(Err(error)) => self.say(Severity::Error, error.to_string()),
            None => {}
        }
    }

    pub(super) fn replace_document(&mut self, path: Option<PathBuf>, scene: Scene) {
        self.drop_lesson();
        self.document = Document::new(scene);
        // Renews the pin, which held a point of the previous document.
        self.view.pin(self.view.pinned);
        self.path = path;
        self.stashed.clear();
        self.travels.clear();
        self.renaming = None;
        self.questions.not_saved();
        self.questions.not_opened();
        self.messages.another_document();
        self.disk_saved();
        self.view.terms = TermSelection::All;
        self.view.channels = Default::default();
        self.select_first();
        self.desk.model_slots.take(&self.document.reflection_model);
    }

    /// Makes the scene of a recovery copy the document, with unsaved changes.
    pub(in crate::panel) fn recovered(&mut self, path: Option<PathBuf>, scene: Scene) {
        self.outside.allow(scene.files());
        self.replace_document(path, scene);
        self.disk.recovered = true;
    }

    pub(super) fn clear_recent(&mut self) {
        self.settings.recent_files.clear();
        self.request(Effect::SaveSettings);
    }

    pub(super) fn remember_file(&mut self, path: &Path) {
        // The next start may be in another folder.
        let path = fs::absolute(path).unwrap_or_else(|_| path.to_owned());
        self.settings.recent_files.retain(|p| *p != path);
        self.settings.recent_files.insert(0, path);
        self.settings.recent_files.truncate(RECENT_FILES);
    }
}
