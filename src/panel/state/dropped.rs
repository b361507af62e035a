//! Files dropped on the window.

use std::path::{Path, PathBuf};

use super::{Action, Effect, LessonCommand, LessonSource, Note, Session, Severity};
use crate::files::Shown as _;
use crate::{
    custom,
    document::Selection,
    parameter::{Parameter, Value},
    platform::fs,
    registry::Registry,
    scene::{Key, formats},
};

/// True if a file has one of these extensions, ignoring case.
fn ends_in(path: &Path, extensions: &[&str]) -> bool {
    path.extension().is_some_and(|own| extensions.iter().any(|known| own.eq_ignore_ascii_case(known)))
}

/// The first of the parameters that accepts the file.
fn taker(parameters: &'static [Parameter], path: &Path) -> Option<&'static Parameter> {
    parameters.iter().find(|p| p.kind.format().is_some_and(|format| ends_in(path, format.extensions)))
}

impl Session {
    /// Opens dropped files: the first scene, picture with a scene, or lesson; otherwise adds every object and lamp to
    /// the scene, and selects a model.
    pub(super) fn dropped(&mut self, paths: Vec<PathBuf>, registry: &Registry) {
        let Some(first) = paths.first().cloned() else { return };
        let is_scene = |path: &&PathBuf| formats::is_scene_file(path, registry) && formats::holds_scene(path);
        if let Some(scene) = paths.iter().find(is_scene) {
            return self.carry_out(Action::Open(scene.clone()), registry);
        }
        if let Some(lesson) = paths.iter().find(|path| ends_in(path, &["md"]) || fs::is_dir(path)) {
            let open = LessonCommand::Open(LessonSource::File(lesson.clone()));
            return self.carry_out(Action::Lesson(open), registry);
        }
        let mut taken = false;
        for path in &paths {
            taken |= self.take_part(path, registry) || self.take_model(path, registry);
        }
        // Any other file is opened as a scene: the message explains why it is not one.
        if !taken {
            self.carry_out(Action::Open(first), registry);
        }
    }

    /// Adds an object or a lamp made from the file; a selected lamp of that type receives the file instead. Returns
    /// true if the file type is accepted.
    fn take_part(&mut self, path: &Path, registry: &Registry) -> bool {
        if let Some((shape, parameter)) =
            registry.shapes().iter().find_map(|shape| Some((shape, taker(shape.parameters, path)?)))
        {
            let Some(file) = self.usable(parameter, path) else { return true };
            let name = path.file_stem().map(|stem| stem.to_string_lossy().into_owned());
            self.add_object(
                shape.declaration.id,
                name,
                |object| object.shape.set(parameter.name, file),
                registry,
            );
            return true;
        }
        let lamp = registry.lights().iter().find_map(|light| Some((light, taker(light.parameters, path)?)));
        let Some((lamp, parameter)) = lamp else { return false };
        let Some(file) = self.usable(parameter, path) else { return true };
        let selected = match self.selection {
            Selection::Light(i) => self.document.lights.get(i).map(|light| (i, light.light_type.as_str())),
            _ => None,
        };
        let id = lamp.declaration.id;
        match selected.filter(|(_, known)| *known == id) {
            Some((i, _)) => {
                let edit =
                    self.setting(Selection::Light(i), Key::Own(parameter.name), parameter, file, registry);
                self.edit(edit, registry);
            }
            None => self.add_light(id, |light| light.parameters.set(parameter.name, file), registry),
        }
        true
    }

    /// The file as a value; `None` with a message if the file is damaged.
    fn usable(&mut self, parameter: &'static Parameter, path: &Path) -> Option<Value> {
        let file = self.chosen(parameter, path)?;
        if let Value::File(named) = &file {
            self.outside.allow([named]);
            if let Some(problem) = named.problem() {
                self.say(Severity::Error, format!("{problem}; nothing was added."));
                return None;
            }
        }
        Some(file)
    }

    /// Selects a model whose file is in the folder of custom models; otherwise offers to copy the file there. Returns
    /// true if the file is a model.
    fn take_model(&mut self, path: &Path, registry: &Registry) -> bool {
        if !ends_in(path, &[custom::EXTENSION]) {
            return false;
        }
        let folder = registry.custom_folder().and_then(|folder| fs::canonicalize(folder).ok());
        let here = path.parent().and_then(|parent| fs::canonicalize(parent).ok());
        let id = path.file_stem().and_then(|stem| registry.model(stem.to_str()?)).map(|m| m.declaration.id);
        match id.filter(|_| folder.is_some() && folder == here) {
            Some(id) => {
                let edit = self.edit_model(id);
                self.edit(edit, registry);
            }
            None => {
                let text = format!(
                    "{} is not in the folder of custom models. Copy it there to use it.",
                    path.shown()
                );
                let copy = Action::Do(Effect::AdoptModel(path.to_owned()));
                self.note(Note::new(Severity::Info, text).offering("Copy it there", copy));
                self.view.unfold(super::MESSAGES_TAB);
            }
        }
        true
    }
}
