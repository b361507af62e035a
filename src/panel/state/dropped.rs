//! Files that are dropped on the window.

use std::path::{Path, PathBuf};

use super::{Action, Effect, LessonCommand, LessonSource, ModelCommand, Note, Session, Severity};
use crate::files::Shown as _;
use crate::{
    custom,
    document::{Edit, Selection},
    parameter::{Parameter, ParameterKind, Value},
    registry::Registry,
    scene::formats,
};

/// True if a file has an extension, in small letters or in capitals.
fn ends_in(path: &Path, extensions: &[&str]) -> bool {
    path.extension().is_some_and(|own| extensions.iter().any(|known| own.eq_ignore_ascii_case(known)))
}

/// The first of these parameters that takes such a file.
fn taker(parameters: &'static [Parameter], path: &Path) -> Option<&'static Parameter> {
    parameters
        .iter()
        .find(|p| matches!(p.kind, ParameterKind::File { format, .. } if ends_in(path, format.extensions)))
}

impl Session {
    /// Opens what was dropped: the first scene, picture with a scene or lesson; else every object and lamp becomes part
    /// of the scene, and a model is chosen.
    pub(super) fn dropped(&mut self, paths: Vec<PathBuf>, registry: &Registry) -> Vec<Effect> {
        let Some(first) = paths.first().cloned() else { return Vec::new() };
        if let Some(scene) = paths.iter().find(|path| formats::is_scene_file(path, registry)) {
            return self.carry_out(Action::Open(scene.clone()), registry);
        }
        if let Some(lesson) = paths.iter().find(|path| ends_in(path, &["md"]) || path.is_dir()) {
            let open = LessonCommand::Open(LessonSource::File(lesson.clone()));
            return self.carry_out(Action::Lesson(open), registry);
        }
        let mut taken = false;
        for path in &paths {
            taken |= self.take_part(path, registry) || self.take_model(path, registry);
        }
        // What is nothing of that is opened as a scene: the message says why it is none.
        if taken { Vec::new() } else { self.carry_out(Action::Open(first), registry) }
    }

    /// Adds an object or a lamp that is made from this file; a lamp that is selected gets it instead. True if there are
    /// such.
    fn take_part(&mut self, path: &Path, registry: &Registry) -> bool {
        if let Some((shape, parameter)) =
            registry.shapes().iter().find_map(|shape| Some((shape, taker(shape.parameters, path)?)))
        {
            let Some(file) = self.usable(parameter, path) else { return true };
            let name = path.file_stem().map(|stem| stem.to_string_lossy().into_owned());
            self.add_object_with(
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
                let edit = Edit::Light(i, crate::document::LightField::Parameter(parameter.name, file));
                self.edit(edit, registry);
            }
            None => self.add_light_with(id, |light| light.parameters.set(parameter.name, file), registry),
        }
        true
    }

    /// The file as a value, unless it is broken, which is said.
    fn usable(&mut self, parameter: &'static Parameter, path: &Path) -> Option<Value> {
        let file = self.chosen(parameter, path)?;
        if let Value::File(named) = &file
            && let Some(problem) = named.problem()
        {
            self.say(Severity::Error, format!("{problem}; nothing was added."));
            return None;
        }
        Some(file)
    }

    /// Chooses a model whose file is in the folder of custom models; of one elsewhere, offers a copy there. True if it is
    /// a model.
    fn take_model(&mut self, path: &Path, registry: &Registry) -> bool {
        if !ends_in(path, &[custom::EXTENSION]) {
            return false;
        }
        let folder = registry.custom_folder().and_then(|folder| folder.canonicalize().ok());
        let here = path.parent().and_then(|parent| parent.canonicalize().ok());
        let id = path.file_stem().and_then(|stem| registry.model(stem.to_str()?)).map(|m| m.declaration.id);
        match id.filter(|_| folder.is_some() && folder == here) {
            Some(id) => {
                let edit = self.edit_model(id);
                self.edit(edit, registry);
            }
            None => {
                let text = format!(
                    "{} is not in the folder of custom models. A copy there can be used.",
                    path.shown()
                );
                let copy = Action::Model(ModelCommand::Adopt(path.to_owned()));
                self.note(Note::new(Severity::Info, text).offering("Copy it there", copy));
                self.view.unfold(super::MESSAGES_TAB);
            }
        }
        true
    }
}
