//! Materials go along when a view of a comparison gets another model. A variant has one material for all objects, so only
//! what is the same for all visible ones goes along.

use std::collections::BTreeMap;

use super::{
    Session, Severity, Traveller,
    carry::{
        alike, as_shown, copies_left, is_news, is_said_with, is_same_in, left_behind, with_whose,
        without_values,
    },
    travels::change,
};
use crate::{
    document::{Edit, Extent},
    parameter::Parameter,
    reflection::{
        ModelEntry,
        carry::{Carried, Journey, journey},
    },
    registry::Registry,
    scene::{Part, Variant, variant::LETTERS},
    text::{capitalised, listed, plural},
};

/// A variant that may get another model, before it does.
pub(super) struct ViewDeparture {
    variant: usize,
    /// The models that its view shows of the objects.
    from: Vec<String>,
}

/// The values that go along with all objects, the parameters for which the new model has no place, and those whose values
/// differ from object to object.
#[derive(Default)]
struct Common {
    carried: Option<Vec<Carried>>,
    /// By the model that is left, with the number of objects that it had a value of.
    left: BTreeMap<String, (usize, Vec<&'static Parameter>)>,
    /// The number of objects.
    all: usize,
    differ: Vec<&'static Parameter>,
}

impl Common {
    /// Adds an object, which had a model.
    fn add(&mut self, found: Journey, from: &str) {
        self.all += 1;
        if !found.left.is_empty() {
            let (count, left) = self.left.entry(from.to_owned()).or_default();
            *count += 1;
            found.left.into_iter().for_each(|p| add(left, p));
        }
        let (stays, differs) = match self.carried.take() {
            None => (found.carried, Vec::new()),
            Some(all) => {
                let is_theirs = |one: &Carried| is_same_in(one, &all, &found.carried);
                let (same, mut differs): (Vec<_>, Vec<_>) = all.iter().cloned().partition(is_theirs);
                let is_ours = |one: &Carried| same.iter().any(|other| alike(one, other));
                differs.extend(found.carried.iter().filter(|one| !is_ours(one)).cloned());
                (same, differs)
            }
        };
        differs.iter().flat_map(|one| &one.from).for_each(|p| add(&mut self.differ, p));
        self.carried = Some(stays);
    }
}

fn add(all: &mut Vec<&'static Parameter>, parameter: &'static Parameter) {
    if all.iter().all(|known| known.name != parameter.name) {
        all.push(parameter);
    }
}

impl Session {
    /// The variant that an edit may give another reflection model.
    pub(super) fn view_departure(&self, edit: &Edit, registry: &Registry) -> Option<ViewDeparture> {
        let (Part::Variant(variant), values) = edit.values() else { return None };
        values.iter().find(|(key, _)| *key == Variant::reflection_model.into())?;
        let (seen, _) = self.document.seen(variant + 1, registry)?;
        let from = seen.objects.iter().map(|object| seen.model_of(object).to_owned()).collect();
        Some(ViewDeparture { variant, from })
    }

    /// Carries what all visible objects have in common to the variant, as part of the step that gave it another model, and
    /// says so.
    pub(super) fn carry_in_view(&mut self, departure: ViewDeparture, registry: &Registry) {
        let ViewDeparture { variant, from } = departure;
        let who = Traveller::Variant(variant);
        let Some(merged) = self.document.overrides(variant + 1) else { return };
        let travels = &self.desk.travels;
        // What was carried to the model that is left goes first.
        let mut own = self.document.variants[variant].material.clone();
        let mut changes =
            from.first().map(|from| self.taken_back(who, from, &own, registry)).unwrap_or_default();
        let mut kept = merged.material.clone();
        [&mut own, &mut kept].into_iter().for_each(|material| change(material, &changes));
        let mut common = Common::default();
        let mut models = None;
        for (object, from) in self.document.objects.iter().zip(&from).filter(|(o, _)| o.visible) {
            let to = merged.reflection_model.as_deref().unwrap_or_else(|| self.document.model_of(object));
            let mut material = object.material.clone();
            material.0.extend(kept.0.clone());
            let way: Vec<_> = travels.way(who, from, to).filter_map(|id| registry.model(id)).collect();
            let mut found = match registry.model(to).filter(|_| from != to) {
                Some(to) => journey(&way, to, &material),
                None => Journey::default(),
            };
            if let Some((from, to)) = registry.model(from).zip(registry.model(to)).filter(|_| from != to) {
                material.0.extend(merged.material.0.clone());
                let is_gone = |name: &str| changes.contains_key(name);
                found.left.extend(copies_left(from, to, &material, is_gone));
                found.carried.iter_mut().for_each(|one| *one = as_shown(one, from, to, &material));
            }
            if from != to {
                models.get_or_insert_with(|| (from.clone(), to.to_owned()));
            }
            common.add(found, from);
        }
        let (Some((from, to)), carried) = (models, common.carried.clone().unwrap_or_default()) else {
            return;
        };
        self.desk.travels.leave(who, &from);
        for one in &carried {
            self.desk.travels.carry((who, one.to.name.into()), &to, &one.value, own.0.get(one.to.name));
        }
        changes.extend(carried.iter().map(|one| (one.to.name.into(), Some(one.value.clone()))));
        if !changes.is_empty() {
            self.document.go_on(Extent::Rest, |scene| {
                change(&mut scene.variants[variant].material, &changes);
            });
        }
        let Some(to) = registry.model(&to) else { return };
        let view = LETTERS.get(variant + 1).copied().unwrap_or_default();
        let said = words(view, to, &common, registry);
        if !said.is_empty() {
            self.say(Severity::Info, said);
        }
    }
}

/// The message: what went along, and what did not.
fn words(view: &str, to: &ModelEntry, common: &Common, registry: &Registry) -> String {
    let mut said = Vec::new();
    let news: Vec<_> = common.carried.iter().flatten().filter(|one| is_news(one)).cloned().collect();
    let carried: Vec<_> = news.chunk_by(is_said_with).map(without_values).collect();
    if !carried.is_empty() {
        said.push(format!("{} in view {view}: {}.", to.declaration.name, carried.join(", ")));
    }
    for (from, (count, left)) in &common.left {
        let whose = (*count != common.all).then(|| plural(*count, "object"));
        let from = registry.model(from).map(|model| with_whose(model.declaration.name, whose));
        said.push(left_behind(left, from.as_deref(), to));
    }
    let differ: Vec<_> = common.differ.iter().map(|p| p.label).collect();
    if !differ.is_empty() {
        let verb = if differ.len() == 1 { "differs" } else { "differ" };
        let names = capitalised(&listed(&differ, "and"));
        said.push(format!("{names} {verb} from object to object, and view {view} has one value for all."));
    }
    said.join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        document::Document,
        panel::state::{Action, CompareCommand},
        parameter::{Value, Values},
        scene::{Object, Scene},
    };

    /// A session with a view B that is active, of spheres with these roughnesses.
    fn begin(roughness: &[f32]) -> (Session, Registry) {
        let mut scene = Scene { reflection_model: "disney".to_owned(), ..Scene::default() };
        let sphere = scene.objects[0].clone();
        scene.objects = (0..roughness.len())
            .map(|i| {
                let mut object = sphere.clone();
                object.position.x += 0.1 * i as f32;
                object.material.set("roughness", Value::Number(roughness[i]));
                object
            })
            .collect();
        let mut session = Session { document: Document::new(scene), ..Session::default() };
        let registry = Registry::builtin();
        let _ = session.apply(Action::Compare(CompareCommand::Add), &registry);
        assert_eq!(session.active(), 1);
        (session, registry)
    }

    fn choose(session: &mut Session, registry: &Registry, id: &str) {
        session.document.end_gesture();
        let edit = session.edit_model(id);
        let _ = session.apply(Action::Edit(edit), registry);
    }

    fn alpha(session: &Session) -> Option<&Value> {
        session.document.variants[0].material.0.get("alpha_x")
    }

    #[test]
    fn a_view_gets_what_all_objects_have_and_goes_back() {
        let (mut session, registry) = begin(&[0.5, 0.5]);
        let start = session.document.scene().clone();
        choose(&mut session, &registry, "ward");
        assert_eq!(alpha(&session), Some(&Value::Number(0.25)));
        assert!(session.document.objects == start.objects, "view A has what it had");
        assert!(session.messages.last().is_some_and(|note| note.text.starts_with("Ward in view B: ")));
        let there = session.document.scene().clone();
        choose(&mut session, &registry, "disney");
        assert_eq!(session.document.variants[0].material, Values::default());
        let _ = session.apply(Action::Undo, &registry);
        assert!(*session.document.scene() == there);
        let _ = session.apply(Action::Undo, &registry);
        assert!(*session.document.scene() == start);
    }

    #[test]
    fn carried_values_without_a_place_are_named_too() {
        let (mut session, registry) = begin(&[0.5, 0.5]);
        for i in 0..2 {
            let edit = Edit::material(Part::Object(i), "clearcoat", Value::Number(0.8));
            let _ = session.apply(Action::Edit(edit), &registry);
        }
        choose(&mut session, &registry, "openpbr");
        session.messages.clear();
        choose(&mut session, &registry, "metallic_roughness");
        let said = session.messages.last().map_or("", |note| &note.text);
        assert!(said.ends_with(" has no place for coat; it comes back with OpenPBR."), "{said}");
    }

    #[test]
    fn what_has_no_place_is_named_with_the_model_of_its_objects() {
        let (mut session, registry) = begin(&[0.5, 0.5, 0.5, 0.5]);
        for i in [2, 3] {
            let edit = Edit::set(Part::Object(i), Object::reflection_model, "openpbr");
            session.edit_here(edit, &registry);
            session.edit_here(Edit::material(Part::Object(i), "coat_weight", Value::Number(0.8)), &registry);
        }
        session.messages.clear();
        let edit = Edit::set(Part::Variant(0), Variant::reflection_model, "metallic_roughness");
        session.edit_here(edit, &registry);
        let said: Vec<_> = session.messages.iter().map(|note| note.text.as_str()).collect();
        let expected = "Metallic–roughness has no place for coat; it comes back with OpenPBR (2 objects).";
        assert_eq!(said, [expected]);
    }

    #[test]
    fn a_value_of_a_view_has_the_name_that_its_model_showed() {
        let (mut session, registry) = begin(&[0.5]);
        let set = |session: &mut Session, edit| session.edit_here(edit, &registry);
        set(&mut session, Edit::set(Part::Object(0), Object::reflection_model, "openpbr"));
        set(&mut session, Edit::material(Part::Object(0), "specular_ior", Value::Number(1.4)));
        choose(&mut session, &registry, "disney");
        let last =
            |session: &Session| session.messages.last().map_or(String::new(), |note| note.text.clone());
        assert!(last(&session).contains("refractive index becomes specular"), "{}", last(&session));
        choose(&mut session, &registry, "metallic_roughness");
        assert!(last(&session).contains("specular becomes reflectance"), "{}", last(&session));
    }

    /// Gives an object n and k of a metal.
    fn plate(session: &mut Session, object: usize, k: [f32; 3], registry: &Registry) {
        let values = [("ior", [0.188_36, 0.543_86, 1.331_85]), ("extinction", k)];
        for (name, triple) in values {
            session.edit_here(Edit::material(Part::Object(object), name, Value::Triple(triple)), registry);
        }
    }

    #[test]
    fn a_metal_of_a_view_takes_the_place_of_its_own_base_colour_until_it_is_left() {
        const GOLD: [f32; 3] = [3.4034, 2.2309, 1.8693];
        let (mut session, registry) = begin(&[0.5, 0.5]);
        choose(&mut session, &registry, "cook_torrance");
        for i in 0..2 {
            plate(&mut session, i, GOLD, &registry);
        }
        let red = Value::Colour([200, 10, 10]);
        session.edit_here(Edit::material(Part::Variant(0), "base_colour", red.clone()), &registry);
        let own = session.document.variants[0].material.clone();
        assert_eq!(own.0.get("base_colour"), Some(&red));
        let objects = session.document.objects.clone();
        choose(&mut session, &registry, "openpbr");
        let get = |session: &Session, name: &str| session.document.variants[0].material.0.get(name).cloned();
        assert_eq!(get(&session, "base_colour"), Some(Value::Colour([248, 218, 170])));
        assert_eq!(get(&session, "metallic"), Some(Value::Number(1.0)));
        assert!(session.document.objects == objects, "view A has what it had");
        choose(&mut session, &registry, "cook_torrance");
        assert_eq!(session.document.variants[0].material, own);
        // Of two metals, none goes along, and not the fraction alone, which would make all white metal.
        plate(&mut session, 1, [5.0, 4.0, 3.0], &registry);
        choose(&mut session, &registry, "openpbr");
        assert_eq!((get(&session, "base_colour"), get(&session, "metallic")), (Some(red), None));
        let said: Vec<_> = session.messages.iter().map(|note| note.text.as_str()).collect();
        let expected = "Refractive index and extinction coefficient differ from object to object";
        assert!(said.iter().any(|text| text.contains(expected)), "{said:?}");
    }

    #[test]
    fn what_differs_from_object_to_object_stays() {
        let (mut session, registry) = begin(&[0.5, 0.6]);
        choose(&mut session, &registry, "ward");
        assert_eq!(alpha(&session), None);
        assert!(session.messages.last().is_some_and(|note| {
            note.text == "Roughness differs from object to object, and view B has one value for all."
        }));
    }
}
