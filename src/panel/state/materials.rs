//! The library of materials in the window: materials for objects, and the material of an object for the library.

use std::path::PathBuf;

use super::{Effect, Session, Severity, follow::follow_model};
use crate::{
    document::{Edit, Revision, Selection},
    materials::{Material, Origin},
    parameter::{Parameter, Value, Values},
    registry::Registry,
    scene::{Key, Object, Part},
    text::listed,
};

/// Id of the panel with the materials.
pub const MATERIALS_TAB: &str = "materials";
/// Most parameters that a message names.
const MOST_NAMED: usize = 4;

/// A command for the library of materials.
#[derive(Clone, Debug, PartialEq)]
pub enum MaterialCommand {
    /// Give a material to the object with this index, or else to all selected objects.
    Apply(Box<Material>, Option<usize>),
    /// Ask for the name under which the material of the selected object is saved.
    Ask,
    /// The name, as typed.
    Type(String),
    /// Save it.
    Save,
    /// Do not save it.
    Cancel,
}

/// The library of materials in the window.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Materials {
    /// The material that is about to be saved, with its name as typed.
    pub draft: Option<Box<Material>>,
    /// Number of materials saved: the list is read again after each.
    pub saved: u64,
    /// The file of the one that was saved last.
    pub latest: Option<PathBuf>,
    /// The material that objects got last, and the revision of the document in which they have it.
    pub given: Option<(Box<Material>, Revision)>,
}

impl Materials {
    /// Notes that a material was saved to a file.
    pub fn was_saved(&mut self, path: PathBuf) {
        self.saved += 1;
        self.latest = Some(path);
    }
}

impl Session {
    /// Applies a command for the library of materials.
    pub(super) fn material(&mut self, command: MaterialCommand, registry: &Registry) {
        match command {
            MaterialCommand::Apply(material, to) => self.apply_material(&material, to, registry),
            MaterialCommand::Ask => self.ask_material(registry),
            MaterialCommand::Type(name) => {
                self.materials.draft.iter_mut().for_each(|draft| draft.name.clone_from(&name));
            }
            MaterialCommand::Save => {
                if let Some(mut material) = self.materials.draft.take() {
                    material.name = material.name.trim().to_owned();
                    self.request(Effect::SaveMaterial { material, overwrite: false });
                }
            }
            MaterialCommand::Cancel => self.materials.draft = None,
        }
    }

    /// True if objects just got this material, and the picture does not show it yet: its shader is being compiled.
    #[must_use]
    pub fn is_compiling(&self, material: &Material) -> bool {
        let is_it =
            |(given, at): &(Box<Material>, Revision)| *at == self.document.revision() && **given == *material;
        self.compiles(self.active()) && self.materials.given.as_ref().is_some_and(is_it)
    }

    fn ask_material(&mut self, registry: &Registry) {
        let scene = self.scene();
        let object = match self.selection {
            Selection::Object(i) => scene.objects.get(i),
            _ => None,
        };
        let Some(object) = object else {
            return self.say(Severity::Info, "Select an object to save its material.");
        };
        let id = scene.model_of(object);
        let Some(model) = registry.model(id) else {
            let text = format!("The material was not saved: there is no reflection model “{id}”.");
            return self.say(Severity::Warning, text);
        };
        let mut values = Values::default();
        for p in model.parameters.iter().filter(|p| may_travel(p)) {
            object.material.0.get(p.name).into_iter().for_each(|value| values.set(p.name, value.clone()));
        }
        self.materials.draft = Some(Box::new(Material {
            name: object.name.clone().unwrap_or_else(|| "My material".to_owned()),
            description: None,
            source: None,
            reflection_model: id.to_owned(),
            material: values,
            origin: Origin::Preset,
        }));
    }

    /// Gives a material to objects, as one step.
    fn apply_material(&mut self, material: &Material, to: Option<usize>, registry: &Registry) {
        let (name, id) = (&material.name, &material.reflection_model);
        let Some(model) = registry.model(id) else {
            let text = format!("{name} cannot be used: there is no reflection model “{id}”.");
            return self.say(Severity::Warning, text);
        };
        let parts = to.map_or_else(|| self.entries(), |i| vec![Selection::Object(i)]);
        let index = |part| if let Selection::Object(i) = part { Some(i) } else { None };
        let objects: Vec<usize> =
            parts.into_iter().filter_map(index).filter(|i| *i < self.document.objects.len()).collect();
        let Some(first) = objects.first().copied() else {
            let text = "Select objects to give them a material, or drag it onto one.";
            return self.say(Severity::Info, text);
        };
        let of_view = self.active() > 0;
        let who = match objects[..] {
            _ if of_view => format!("all objects of view {}", self.letter()),
            [one] => self.name_of(Selection::Object(one), registry),
            ref all => format!("{} objects", all.len()),
        };
        let news = self.replaced(material, &objects, registry);
        let has_it = |i: &usize| self.scene().model_of(&self.scene().objects[*i]) == id;
        let all_have_it = if of_view {
            (0..self.scene().objects.len()).all(|i| has_it(&i))
        } else {
            objects.iter().all(has_it)
        };
        let model_value =
            (!all_have_it).then(|| (Key::from(Object::reflection_model), Some(Value::from(id.clone()))));
        // Every value is given, so that nothing of the material before shows through.
        let given = model.parameters.iter().filter(|p| may_travel(p));
        let given = given.map(|p| (Key::Material(p.name), Some(material.material.get(p))));
        let values: Vec<_> = model_value.into_iter().chain(given).collect();
        let set = |i| Edit::Set { part: Part::Object(i), values: values.clone(), what: Some("Material") };
        let edit = if of_view {
            self.redirected(set(first), registry)
        } else {
            Edit::Each { edits: objects.iter().map(|i| set(*i)).collect(), step: format!("{name} for {who}") }
        };
        self.document.end_gesture();
        let before = self.document.revision();
        if let Err(why) = self.document.edit(edit, self.selection, registry) {
            return self.say(Severity::Warning, why);
        }
        self.document.end_gesture();
        if self.document.revision() == before {
            let verb = if objects.len() == 1 && !of_view { "has" } else { "have" };
            return self.say(Severity::Info, format!("{who} {verb} {name} already."));
        }
        if !all_have_it {
            self.model_slots.take(id);
            follow_model(self, registry);
        }
        self.materials.given = Some((Box::new(material.clone()), self.document.revision()));
        self.messages.offer_undo(format!("{name} for {who}{news}"), self.last_step());
    }

    /// The end of the message: the models that are left, and the values that are replaced.
    fn replaced(&self, material: &Material, objects: &[usize], registry: &Registry) -> String {
        let scene = self.scene();
        let Some(to) = registry.model(&material.reflection_model) else { return String::new() };
        let (mut left, mut gone): (Vec<&str>, Vec<&str>) = (Vec::new(), Vec::new());
        for object in objects.iter().filter_map(|i| scene.objects.get(*i)) {
            let from = scene.model_of(object);
            let from = registry.model(from).map_or(from, |model| model.declaration.name);
            if from != to.declaration.name && !left.contains(&from) {
                left.push(from);
            }
            for p in to.parameters.iter().filter(|p| may_travel(p)) {
                if !gone.contains(&p.label)
                    && object.material.0.get(p.name).is_some_and(|known| *known != material.material.get(p))
                {
                    gone.push(p.label);
                }
            }
        }
        let mut said = match &left[..] {
            [] => ".".to_owned(),
            left => {
                let [name, list] = [to.declaration.name.to_owned(), listed(left, "and")];
                format!(", which is {name} in place of {list}; what else they set comes back with {list}.")
            }
        };
        let more = gone.len().saturating_sub(MOST_NAMED);
        if more > 0 {
            gone.truncate(MOST_NAMED);
            said += &format!(" It replaces {} and {more} more.", gone.join(", "));
        } else if !gone.is_empty() {
            said += &format!(" It replaces {}.", listed(&gone, "and"));
        }
        said
    }

    /// The letter of the active view.
    pub(in crate::panel) fn letter(&self) -> &'static str {
        crate::scene::variant::LETTERS.get(self.active()).copied().unwrap_or_default()
    }
}

/// True if a parameter is part of materials in the library: files stay in their folders.
fn may_travel(p: &Parameter) -> bool {
    p.kind.format().is_none()
}
