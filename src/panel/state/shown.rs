//! The document as shown by the window.

use std::{ffi::OsStr, path::Path};

use super::{Action, Session, Severity, ViewChange};
use crate::{
    document::{Edit, Selection},
    files::printable,
    optics::TermSelection,
    registry::Registry,
    scene::{Object, Observer, Part, Scene, Variant, check::same_place},
    text::listed,
};

/// Maximum number of objects that a message names.
const MOST_NAMED: usize = 3;

impl Session {
    /// The title: of the open lesson, otherwise of the user's own document.
    #[must_use]
    pub fn title(&self) -> String {
        self.lesson.as_ref().map_or_else(|| self.own_title(), |lesson| lesson.lesson.title.clone())
    }

    /// The file name without extension; without a file, derived from the title.
    #[must_use]
    pub fn stem(&self) -> String {
        if let Some(stem) = self.path.as_deref().and_then(Path::file_stem) {
            return stem.to_string_lossy().into_owned();
        }
        let title = self.title().to_lowercase();
        let words = title.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty());
        let stem = words.collect::<Vec<_>>().join("-");
        if stem.is_empty() { "scene".to_owned() } else { stem }
    }

    /// The window title: title of the document, and the file if it has a different name.
    #[must_use]
    pub fn window_title(&self) -> String {
        let title = self.title();
        // my_lesson.json counts as My lesson.
        let plain = |name: &str| name.to_lowercase().replace(|c: char| !c.is_alphanumeric(), "");
        let is_title = |stem: &OsStr| plain(&stem.to_string_lossy()) == plain(&title);
        match self.path.as_ref().filter(|p| !p.file_stem().is_some_and(is_title)) {
            Some(path) => {
                let file = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
                format!("{title} — {}", printable(&file))
            }
            None => title,
        }
    }

    /// The display name of a part of the scene: its own name, or its type and number.
    #[must_use]
    pub fn name_of(&self, part: Selection, registry: &Registry) -> String {
        self.document.name_of(part, registry)
    }

    /// True if an object is not drawn, since the shapes or the triangles of the scene are too many.
    #[must_use]
    pub fn is_not_drawn(&self, object: usize) -> bool {
        self.facts.not_drawn.binary_search(&object).is_ok()
    }

    /// A sentence with the names of objects that are not drawn, the selected one first; empty if all are drawn.
    #[must_use]
    pub fn names_not_drawn(&self, registry: &Registry) -> String {
        let all = &self.facts.not_drawn;
        let selected = match self.selection {
            Selection::Object(i) if self.is_not_drawn(i) => Some(i),
            _ => None,
        };
        let others = all.iter().copied().filter(|i| Some(*i) != selected);
        let first = selected.into_iter().chain(others).take(MOST_NAMED);
        let mut names: Vec<_> = first.map(|i| self.name_of(Selection::Object(i), registry)).collect();
        if all.len() > names.len() {
            names.push(format!("{} more", all.len() - names.len()));
        }
        if names.is_empty() { String::new() } else { format!("Not drawn: {}.", listed(&names, "and")) }
    }

    /// The selected object; none in a presentation.
    fn object_chosen(&self) -> Option<(usize, &Object)> {
        let Selection::Object(i) = self.selection else { return None };
        let object = self.scene().objects.get(i).filter(|_| !self.view.presenting)?;
        Some((i, object))
    }

    /// The selected object, if it overrides the scene's reflection model. The menu at the top then applies to that
    /// object, since the scene's model does not affect it. In a presentation, which shows no selection, the menu
    /// applies to the scene.
    #[must_use]
    pub fn model_override(&self) -> Option<(usize, &str)> {
        let (i, object) = self.object_chosen()?;
        Some((i, object.reflection_model.as_deref()?))
    }

    /// The selected object, if it overrides the scene's shading model.
    #[must_use]
    pub fn shading_override(&self) -> Option<(usize, &str)> {
        let (i, object) = self.object_chosen()?;
        Some((i, object.shading_model.as_deref()?))
    }

    /// The objects that the choice of a model at the top of the window changes together, one of each row; none unless
    /// several parts are selected, and none in a presentation.
    fn objects_chosen(&self) -> Vec<usize> {
        if !self.has_group() || self.view.presenting {
            return Vec::new();
        }
        let object = |part| if let Selection::Object(i) = part { Some(i) } else { None };
        self.entries().into_iter().filter_map(object).collect()
    }

    /// The object whose model stands for those of several that are selected.
    fn first_chosen(&self) -> Option<&Object> {
        let (i, object) = self.object_chosen()?;
        self.is_in_group(Selection::Object(i)).then_some(object)
    }

    /// The name of what the choice of a model at the top of the window changes, if that is not the scene.
    #[must_use]
    pub fn model_of(&self, registry: &Registry) -> Option<String> {
        if self.first_chosen().is_some() {
            return Some(self.name_of_group());
        }
        self.model_override().map(|_| self.name_of(self.selection, registry))
    }

    /// Id of the reflection model shown at the top of the window.
    #[must_use]
    pub fn model_shown(&self) -> &str {
        if let Some(object) = self.first_chosen() {
            return self.scene().model_of(object);
        }
        self.model_override().map_or(&self.scene().reflection_model, |(_, id)| id)
    }

    /// Id of the shading model shown at the top of the window.
    #[must_use]
    pub fn shading_shown(&self) -> &str {
        self.shading_override().map_or(&self.scene().shading_model, |(_, id)| id)
    }

    /// The edit that selects a reflection model at the top of the window. Where several objects are selected, it is one
    /// step that changes all of them.
    #[must_use]
    pub fn edit_model(&self, id: &str) -> Edit {
        let objects = self.objects_chosen();
        if !objects.is_empty() {
            let edits = objects.into_iter().map(|i| Edit::set(Part::Object(i), Object::reflection_model, id));
            let step = format!("Reflection model of {}", self.name_of_group());
            return Edit::Each { edits: edits.collect(), step };
        }
        let part = self.model_override().map_or(Part::Scene, |(i, _)| Part::Object(i));
        Edit::set(part, Scene::reflection_model, id)
    }

    /// The edit that selects a shading model at the top of the window.
    #[must_use]
    pub fn edit_shading_model(&self, id: &str) -> Edit {
        let part = self.shading_override().map_or(Part::Scene, |(i, _)| Part::Object(i));
        Edit::set(part, Scene::shading_model, id)
    }

    /// The terms that the picture can isolate, and all of them together; terms that are 0 everywhere are left out.
    #[must_use]
    pub fn offered_terms(&self, registry: &Registry) -> Vec<TermSelection> {
        self.seen.terms.offered(self.scene(), registry)
    }

    /// Isolates the next term of the equation.
    pub(super) fn next_terms(&mut self, registry: &Registry) {
        let offered = self.offered_terms(registry);
        let shown = self.terms();
        let next = match offered.iter().position(|t| *t == shown) {
            Some(at) => offered[(at + 1) % offered.len()],
            None => TermSelection::All,
        };
        if offered.len() == 1 && shown == next {
            self.say(Severity::Info, "The equation has only one term here: there is nothing to separate.");
        }
        self.carry_out(Action::View(ViewChange::Terms(next)), registry);
    }

    /// Isolates terms in the active view alone.
    pub(super) fn override_terms(&mut self, terms: TermSelection, registry: &Registry) {
        let edit = Edit::set(Part::Variant(self.active() - 1), Variant::terms, terms);
        self.edit_here(edit, registry);
    }

    /// True if nothing in a view's picture has the isolated term.
    #[must_use]
    pub fn lacks_term(&self, view: usize, registry: &Registry) -> bool {
        let shown = self.terms_of(view);
        if shown == TermSelection::All {
            return false;
        }
        let present = |scene: &Scene| self.seen.terms.present(scene, registry);
        let seen = (view != self.active()).then(|| self.document.seen(view, registry)).flatten();
        !seen.map_or_else(|| present(self.scene()), |(scene, _)| present(&scene)).contains(&shown)
    }

    /// The observer of the scene in a file with a picture of the present view: at the camera, unless there can be none, for
    /// the reason given.
    #[must_use]
    pub fn observer_in_file(&self) -> (Observer, Option<&'static str>) {
        let own = self.document.observer;
        let free = self.facts.camera_is_free;
        match self.observer_problem().filter(|_| free) {
            None if free => (self.facts.observer(own), None),
            why => (own, why),
        }
    }

    /// Why the observer can't be moved to the camera.
    #[must_use]
    pub fn observer_problem(&self) -> Option<&'static str> {
        let scene = &self.document;
        let taken = (scene.lights.iter().filter_map(|l| l.position))
            .chain(scene.objects.iter().map(|o| o.position))
            .any(|p| same_place(p, self.facts.eye));
        match scene.scene_size.contains(self.facts.eye) {
            false => Some("The view is outside the room."),
            true if taken => Some("The view is at the position of a light or an object."),
            true => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn objects_that_are_not_drawn_are_named_the_selected_one_first() {
        let registry = Registry::builtin();
        let objects = ["a", "b", "c", "d", "e", "f"]
            .map(|name| Object { name: Some(name.to_owned()), ..Object::default() });
        let mut session = Session::new(Scene { objects: objects.into(), ..Scene::default() });
        assert_eq!(session.names_not_drawn(&registry), "");
        session.facts.not_drawn = vec![4];
        assert_eq!(session.names_not_drawn(&registry), "Not drawn: e.");
        session.facts.not_drawn = vec![0, 1, 3, 4, 5];
        session.selection = Selection::Object(4);
        assert_eq!(session.names_not_drawn(&registry), "Not drawn: e, a, b and 2 more.");
        assert!(session.is_not_drawn(5) && !session.is_not_drawn(2));
    }
}
