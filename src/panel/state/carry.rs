//! Materials go along when objects get another model: what corresponds takes its place in the new one, and goes when
//! that model is left, so that going back gives back what was there.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use super::{
    Session, Severity, Traveller,
    travels::{Changes, change},
};
use crate::{
    document::{Edit, Extent, PartId, Selection},
    parameter::{Parameter, Value, Values},
    reflection::{
        ModelEntry,
        carry::{Carried, Journey, journey, metal_of},
        usage::unused,
    },
    registry::Registry,
    scene::{Object, Part, Repetition, Scene, limits},
    text::{listed, plural},
};

/// Objects that may get another model, before they do.
pub(super) struct Departure {
    model: String,
    objects: Vec<PartId>,
}

/// An object with another model: what its material becomes.
struct Arrival {
    id: PartId,
    index: usize,
    /// The model that it had, and its material with that.
    from: String,
    before: Values,
    /// The material without what was carried to that model.
    kept: Values,
    /// The model that it has.
    to: String,
    /// The values of its material that change; until it is settled, only by what goes or is back.
    changes: Changes,
    journey: Journey,
}

impl Session {
    /// The objects that an edit may give another reflection model.
    pub(super) fn departure(&self, edit: &Edit) -> Option<Departure> {
        let (part, values) = edit.values();
        values.iter().find(|(key, _)| *key == Scene::reflection_model.into())?;
        let (model, objects): (String, Vec<usize>) = match part {
            Part::Scene => {
                let follows = |i: &usize| self.document.objects[*i].reflection_model.is_none();
                let all = (0..self.document.objects.len()).filter(follows).collect();
                (self.document.reflection_model.clone(), all)
            }
            Part::Object(i) => {
                let object = self.document.objects.get(i)?;
                let all = self.document.row(i).map_or(i..i + 1, |row| row.range()).collect();
                (self.document.model_of(object).to_owned(), all)
            }
            _ => return None,
        };
        let objects = objects.into_iter().filter_map(|i| self.document.object_id(i)).collect();
        Some(Departure { model, objects })
    }

    /// The objects that several edits may give another reflection model, by the model that they have.
    pub(super) fn departures(&self, edits: &[Edit]) -> Vec<Departure> {
        let mut all: BTreeMap<String, Vec<PartId>> = BTreeMap::new();
        for Departure { model, objects } in edits.iter().filter_map(|edit| self.departure(edit)) {
            all.entry(model).or_default().extend(objects);
        }
        all.into_iter().map(|(model, objects)| Departure { model, objects }).collect()
    }

    /// Carries the materials of objects that have another model now, as part of the step that gave it to them, and says
    /// what went along and what did not.
    pub(super) fn carry(&mut self, departures: Vec<Departure>, registry: &Registry) {
        let mut arrivals = Vec::new();
        for Departure { model, objects } in departures {
            arrivals.extend(objects.into_iter().filter_map(|id| self.arrival(id, &model, registry)));
        }
        self.keep_rows_alike(&mut arrivals);
        arrivals.iter_mut().for_each(Arrival::settle);
        for Arrival { id, from, to, kept, journey, .. } in &arrivals {
            let who = Traveller::Object(*id);
            self.desk.travels.leave(who, from);
            for one in &journey.carried {
                let place = (who, one.to.name.into());
                self.desk.travels.carry(place, to, &one.value, kept.0.get(one.to.name));
            }
        }
        self.put(&arrivals, registry);
        let models: BTreeSet<&str> = arrivals.iter().map(|one| one.to.as_str()).collect();
        for to in models.into_iter().filter_map(|id| registry.model(id)) {
            let all: Vec<_> = arrivals.iter().filter(|one| one.to == to.declaration.id).collect();
            let said = self.said(&all, to, registry);
            if !said.is_empty() {
                self.say(Severity::Info, said);
            }
        }
    }

    /// What of a material goes, and what is back, when a model is left. A metal whose colour the user has changed stays one,
    /// since the colour would be that of a body otherwise.
    pub(super) fn taken_back(
        &self,
        who: Traveller,
        from: &str,
        material: &Values,
        registry: &Registry,
    ) -> Changes {
        let travels = &self.desk.travels;
        let mut changes = travels.taken_back(who, from, material);
        if let Some([fraction, colour]) = registry.model(from).and_then(metal_of)
            && travels.was_changed(&(who, colour.name.into()), from, material.0.get(colour.name))
        {
            changes.remove(fraction.name);
        }
        changes
    }

    /// What becomes of an object's material, if the object has another model than `from` now.
    fn arrival(&self, id: PartId, from: &str, registry: &Registry) -> Option<Arrival> {
        let index = self.document.object(id)?;
        let (object, who) = (&self.document.objects[index], Traveller::Object(id));
        let to = Some(self.document.model_of(object)).filter(|to| *to != from)?;
        let before = object.material.clone();
        // What was carried to the model that is left goes first, so that its origin is carried, and not its copy.
        let changes = self.taken_back(who, from, &before, registry);
        let mut kept = before.clone();
        change(&mut kept, &changes);
        let way: Vec<_> = self.desk.travels.way(who, from, to).filter_map(|id| registry.model(id)).collect();
        let mut journey = registry.model(to).map(|to| journey(&way, to, &kept)).unwrap_or_default();
        if let Some((from, to)) = registry.model(from).zip(registry.model(to)) {
            let gone = |name: &str| changes.contains_key(name);
            journey.left.extend(copies_left(from, to, &object.material, gone));
        }
        let (from, to) = (from.to_owned(), to.to_owned());
        Some(Arrival { id, index, from, before, kept, to, changes, journey })
    }

    /// Copies of a row stay alike: what would differ from copy to copy does not go along.
    fn keep_rows_alike(&self, arrivals: &mut [Arrival]) {
        let places: HashMap<usize, usize> =
            arrivals.iter().enumerate().map(|(k, one)| (one.index, k)).collect();
        for row in self.document.rows() {
            let all: Vec<usize> = row.range().filter_map(|i| places.get(&i).copied()).collect();
            let Some(first) = all.first() else { continue };
            let ours = &arrivals[*first].journey.carried;
            let is_common =
                |one: &&Carried| all.iter().all(|k| is_same_in(one, ours, &arrivals[*k].journey.carried));
            let common: Vec<Carried> = ours.iter().filter(is_common).cloned().collect();
            for k in all {
                let Arrival { journey, .. } = &mut arrivals[k];
                let (carried, gone) = std::mem::take(&mut journey.carried)
                    .into_iter()
                    .partition(|one: &Carried| common.iter().any(|known| alike(known, one)));
                journey.carried = carried;
                for p in gone.into_iter().flat_map(|one: Carried| one.from) {
                    if journey.left.iter().all(|known| known.name != p.name) {
                        journey.left.push(p);
                    }
                }
            }
        }
    }

    /// Changes the materials, as part of the last step.
    fn put(&mut self, arrivals: &[Arrival], registry: &Registry) {
        let changed: Vec<_> = arrivals.iter().filter(|one| !one.changes.is_empty()).collect();
        let is_single = |o: &Object| !matches!(o.repeat, Repetition::Copy { .. });
        match changed[..] {
            [] => {}
            [one] if is_single(&self.document.objects[one.index]) => {
                let extent = Extent::Object(one.index);
                self.document
                    .go_on(extent, |scene| change(&mut scene.objects[one.index].material, &one.changes));
            }
            _ => self.document.go_on(Extent::All, |scene| {
                changed.iter().for_each(|one| change(&mut scene.objects[one.index].material, &one.changes));
                scene.follow_copies(registry);
            }),
        }
    }

    /// The message: what went along, what did not, and what has another default.
    fn said(&self, arrivals: &[&Arrival], to: &ModelEntry, registry: &Registry) -> String {
        let mut by_model: BTreeMap<&str, Vec<&Arrival>> = BTreeMap::new();
        arrivals.iter().for_each(|one| by_model.entry(&one.from).or_default().push(one));
        let names = |all: &[&Arrival]| match all {
            [one] => self.name_of(Selection::Object(one.index), registry),
            all => plural(all.len(), "object"),
        };
        let (mut clauses, mut left, mut defaults) = (Vec::new(), Vec::new(), Vec::new());
        for (from, all) in &by_model {
            let Some(from) = registry.model(from) else { continue };
            clauses.extend(went(all, from, to).map(|(who, list)| (from, who, list)));
            left.extend(stayed(all).map(|(who, which)| (from, who, which)));
            all.iter().for_each(|one| add_all(&mut defaults, one.other_defaults(from, to)));
        }
        let name = to.declaration.name;
        let mut said = Vec::new();
        match &clauses[..] {
            [] => {}
            [(_, who, list)] if who.len() == arrivals.len() => {
                said.push(format!("{name} for {}: {list}.", names(who)));
            }
            _ => {
                let clause = |(from, who, list): &(&ModelEntry, Vec<&Arrival>, String)| {
                    let who = if who.len() == 1 { names(who) } else { who.len().to_string() };
                    let had = format!(" that had {}", from.declaration.name);
                    format!("of {who}{}: {list}", if by_model.len() == 1 { "" } else { had.as_str() })
                };
                let clauses: Vec<_> = clauses.iter().map(clause).collect();
                said.push(format!("{} use {name}; {}.", names(arrivals), clauses.join("; ")));
            }
        }
        for (i, (from, who, which)) in left.iter().enumerate() {
            let whose = (who.len() != arrivals.len()).then(|| names(who));
            let sentence = left_behind(which, Some(with_whose(from.declaration.name, whose).as_str()), to);
            let head = if i == 0 && clauses.is_empty() { names(arrivals) + ": " } else { String::new() };
            said.push(head + &sentence);
        }
        if !defaults.is_empty() {
            let word = if defaults.len() == 1 { "Default" } else { "Defaults" };
            said.push(format!("{word} of {name}: {}.", defaults.join(", ")));
        }
        said.join(" ")
    }
}

impl Arrival {
    /// Adds what goes along to what changes, and leaves out what is the same as before.
    fn settle(&mut self) {
        let Self { before, changes, journey, .. } = self;
        changes.extend(journey.carried.iter().map(|one| (one.to.name.into(), Some(one.value.clone()))));
        changes.retain(|name, value| before.0.get(name) != value.as_ref());
    }

    /// What went along, named as the model that is left shows it.
    fn shown(&self, from: &ModelEntry, to: &ModelEntry) -> Vec<Carried> {
        let all = self.journey.carried.iter().map(|one| as_shown(one, from, to, &self.before));
        all.filter(is_news).collect()
    }

    /// "roughness 0.3 (was 0.5)": values that nobody set, and that change because each model has a default of its own.
    fn other_defaults(&self, from: &ModelEntry, to: &ModelEntry) -> Vec<String> {
        let is_set = |name: &str| self.before.0.contains_key(name) || self.changes.contains_key(name);
        let other = |p: &'static Parameter| {
            let old = from.parameter(p.name).filter(|_| !is_set(p.name))?.default_value();
            let new = Some(p.default_value()).filter(|new| *new != old)?;
            unused(to.parameters, p, &self.before).is_none().then(|| format!("{} {new} (was {old})", p.label))
        };
        to.parameters.iter().filter_map(other).collect()
    }
}

/// Of objects that had one model, those with which something went along, and what, in words.
fn went<'a>(all: &[&'a Arrival], from: &ModelEntry, to: &ModelEntry) -> Option<(Vec<&'a Arrival>, String)> {
    let shown = all.iter().map(|one| (*one, one.shown(from, to)));
    let goers: Vec<_> = shown.filter(|(_, carried)| !carried.is_empty()).collect();
    let mut words = Vec::new();
    for (arrival, carried) in &goers {
        let word = |all: &[Carried]| match goers.len() {
            1 => with_values(all, &arrival.before),
            _ => without_values(all),
        };
        add_all(&mut words, carried.chunk_by(is_said_with).map(word));
    }
    (!goers.is_empty()).then(|| (goers.iter().map(|(one, _)| *one).collect(), words.join(", ")))
}

/// Of objects that had one model, those of which something did not go along, and what.
fn stayed<'a>(all: &[&'a Arrival]) -> Option<(Vec<&'a Arrival>, Vec<&'static Parameter>)> {
    let who: Vec<_> = all.iter().copied().filter(|one| !one.journey.left.is_empty()).collect();
    let mut left: Vec<&'static Parameter> = Vec::new();
    for p in who.iter().flat_map(|one| &one.journey.left) {
        if left.iter().all(|known| known.name != p.name) {
            left.push(*p);
        }
    }
    (!who.is_empty()).then_some((who, left))
}

/// Adds those that are new.
fn add_all(known: &mut Vec<String>, more: impl IntoIterator<Item = String>) {
    for one in more {
        if !known.contains(&one) {
            known.push(one);
        }
    }
}

/// "OpenPBR (6 objects)": the model with which values come back, and whose, unless they are those of all.
pub(super) fn with_whose(model: &str, whose: Option<String>) -> String {
    whose.map_or_else(|| model.to_owned(), |whose| format!("{model} ({whose})"))
}

/// What goes along, following from the parameters under which the model that is left shows it: it may come from an
/// earlier model, of whose values that one has copies.
pub(super) fn as_shown(one: &Carried, from: &ModelEntry, to: &ModelEntry, before: &Values) -> Carried {
    let name = one.to.name;
    if let Some(same) = from.parameter(name).filter(|_| before.0.get(name) == Some(&one.value)) {
        return Carried { from: vec![same], ..one.clone() };
    }
    let mut before = before.clone();
    before.0.remove(name);
    let there = journey(&[from], to, &before).carried.into_iter().find(|other| other.to.name == name);
    Carried { from: there.map_or_else(|| one.from.clone(), |there| there.from), ..one.clone() }
}

/// True if the same value goes to the same parameter.
pub(super) fn alike(a: &Carried, b: &Carried) -> bool {
    a.to.name == b.to.name && a.value == b.value
}

/// True if one of our values goes along in another journey, too, with all that belongs with it.
pub(super) fn is_same_in(one: &Carried, ours: &[Carried], theirs: &[Carried]) -> bool {
    let mut together = ours.iter().filter(|other| alike(one, other) || one.belongs_with(other));
    together.all(|our| theirs.iter().any(|their| alike(our, their)))
}

/// False of a value that stays under its name.
pub(super) fn is_news(one: &Carried) -> bool {
    one.from.iter().all(|p| p.name != one.to.name)
}

/// The parameters for which a new model has no place, of those whose values were carried to the model that is left and
/// are `gone` with it. What they came from belongs to an earlier model, so that it is not missed on this step.
pub(super) fn copies_left(
    from: &ModelEntry,
    to: &ModelEntry,
    material: &Values,
    gone: impl Fn(&str) -> bool,
) -> impl Iterator<Item = &'static Parameter> {
    journey(&[from], to, material).left.into_iter().filter(move |p| gone(p.name))
}

/// True of values that follow from the same parameters, which are named once.
pub(super) fn is_said_with(one: &Carried, next: &Carried) -> bool {
    let names = |one: &Carried| one.from.iter().map(|p| p.name).collect::<Vec<_>>();
    !one.limited && !next.limited && names(one) == names(next)
}

/// "clear coat becomes coat", or "become" for several.
fn become_of(from: &[impl AsRef<str>], to: &[impl AsRef<str>]) -> String {
    let verb = if from.len() == 1 { "becomes" } else { "become" };
    format!("{} {verb} {}", listed(from, "and"), listed(to, "and"))
}

/// A value as knobs write it.
fn shown(p: &Parameter, value: &Value) -> String {
    // Three numbers are one word in files.
    p.kind.number_of(value).map_or_else(|| value.to_string().replace(',', ", "), limits::number)
}

/// "clear coat 0.5 becomes coat 0.125", of values that follow from the same parameters.
fn with_values(all: &[Carried], material: &Values) -> String {
    let from = all.first().into_iter().flat_map(|one| &one.from);
    let from: Vec<_> = from.map(|p| format!("{} {}", p.label, shown(p, &material.get(p)))).collect();
    let to = all.iter().map(|one| {
        let limit = if one.limited { ", the nearest that it allows" } else { "" };
        format!("{} {}{limit}", one.to.label, shown(one.to, &one.value))
    });
    become_of(&from, &to.collect::<Vec<_>>())
}

/// "OpenPBR has no place for subsurface; it comes back with Disney."
pub(super) fn left_behind(left: &[&Parameter], from: Option<&str>, to: &ModelEntry) -> String {
    let names: Vec<_> = left.iter().map(|p| p.label).collect();
    let verb = if names.len() == 1 { "it comes back" } else { "they come back" };
    let back = from.map_or(String::new(), |from| format!("; {verb} with {from}"));
    format!("{} has no place for {}{back}.", to.declaration.name, listed(&names, "and"))
}

/// "clear coat becomes coat", of values that follow from the same parameters.
pub(super) fn without_values(all: &[Carried]) -> String {
    let from: Vec<_> = all.first().into_iter().flat_map(|one| &one.from).map(|p| p.label).collect();
    let to: Vec<_> = all.iter().map(|one| one.to.label).collect();
    become_of(&from, &to)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        document::Document,
        panel::state::{Action, Travels},
        scene::{Repeat, Varied, check},
    };

    fn number(v: f32) -> Value {
        Value::Number(v)
    }

    /// A session with so many spheres of a model and these values, and a colour, whose default models do not share.
    fn begin(model: &str, count: usize, values: &[(&'static str, f32)]) -> (Session, Registry) {
        let mut scene = Scene { reflection_model: model.to_owned(), ..Scene::default() };
        scene.objects[0].material.set("base_colour", Value::Colour([200, 100, 50]));
        values.iter().for_each(|(name, v)| scene.objects[0].material.set(*name, number(*v)));
        for i in 1..count {
            let mut copy = scene.objects[0].clone();
            copy.position.x += 0.1 * i as f32;
            scene.objects.push(copy);
        }
        let session = Session { document: Document::new(scene), ..Session::default() };
        (session, Registry::builtin())
    }

    fn choose(session: &mut Session, registry: &Registry, id: &str) {
        session.document.end_gesture();
        let edit = session.edit_model(id);
        let _ = session.apply(Action::Edit(edit), registry);
        assert_eq!(check::scene(&session.document, registry), []);
    }

    fn value(session: &Session, name: &str) -> Option<Value> {
        session.document.objects[0].material.0.get(name).cloned()
    }

    fn last(session: &Session) -> &str {
        session.messages.last().map_or("", |note| &note.text)
    }

    #[test]
    fn a_material_goes_along_and_comes_back_as_it_was() {
        let values = [("roughness", 0.3), ("clearcoat", 0.5), ("subsurface", 0.2)];
        let (mut session, registry) = begin("disney", 1, &values);
        let start = session.document.objects[0].material.clone();
        choose(&mut session, &registry, "openpbr");
        assert_eq!(value(&session, "coat_weight"), Some(number(0.125)));
        assert_eq!(
            last(&session),
            "OpenPBR for Sphere 1: clear coat 0.5 becomes coat 0.125. OpenPBR has no place for subsurface; it comes \
             back with Disney."
        );
        choose(&mut session, &registry, "ward");
        assert_eq!(value(&session, "coat_weight"), None);
        assert_eq!(value(&session, "alpha_x"), Some(number(0.3f32 * 0.3)));
        // By way of a model without a coat, too.
        choose(&mut session, &registry, "openpbr");
        assert_eq!((value(&session, "coat_weight"), value(&session, "alpha_x")), (Some(number(0.125)), None));
        choose(&mut session, &registry, "disney");
        assert_eq!(session.document.objects[0].material, start);
        // A change there is carried anew.
        let edit = Edit::material(Part::Object(0), "clearcoat", number(1.0));
        let _ = session.apply(Action::Edit(edit), &registry);
        choose(&mut session, &registry, "openpbr");
        assert_eq!(value(&session, "coat_weight"), Some(number(0.25)));
    }

    #[test]
    fn carried_values_are_said_as_knobs_write_them() {
        let (mut session, registry) = begin("disney", 1, &[("clearcoat", 0.123_456)]);
        choose(&mut session, &registry, "openpbr");
        let said = last(&session);
        assert!(said.contains("clear coat 0.1235 becomes coat 0.0309"), "{said}");
    }

    #[test]
    fn carried_values_without_a_place_are_named_too() {
        // The roughness is set, since its default is another in each of the models.
        for coat in [[0.8, 0.4], [0.0, 0.0]] {
            let values = &[("clearcoat", coat[0]), ("sheen", coat[1]), ("roughness", 0.4)];
            let (mut session, registry) = begin("disney", 1, values);
            let is_set = values[0].1 > 0.0;
            choose(&mut session, &registry, "openpbr");
            let said = "OpenPBR for Sphere 1: clear coat 0.8 becomes coat 0.2, sheen 0.4 becomes fuzz 0.4.";
            assert_eq!(last(&session) == said, is_set, "{}", last(&session));
            session.messages.clear();
            choose(&mut session, &registry, "metallic_roughness");
            let name = registry.model("metallic_roughness").expect("built in").declaration.name;
            let said =
                format!("Sphere 1: {name} has no place for coat and fuzz; they come back with OpenPBR.");
            assert_eq!(last(&session), if is_set { said.as_str() } else { "" });
            // Nor is anything missed where the values came from.
            session.messages.clear();
            choose(&mut session, &registry, "openpbr");
            session.messages.clear();
            choose(&mut session, &registry, "disney");
            assert_eq!(last(&session), "");
        }
    }

    /// Objects with these models and one value each.
    fn mixed(all: &[(&'static str, &'static str, f32)]) -> (Session, Registry) {
        let (mut session, registry) = begin("lambert", all.len(), &[]);
        let mut scene = session.document.scene().clone();
        for (object, (model, name, v)) in scene.objects.iter_mut().zip(all) {
            object.reflection_model = Some((*model).to_owned());
            object.material.set(*name, number(*v));
            object.material.set("roughness", number(0.4));
        }
        session.document = Document::new(scene);
        (session, registry)
    }

    fn choose_for_each(session: &mut Session, registry: &Registry, id: &'static str) {
        session.document.end_gesture();
        let edits = (0..session.document.objects.len())
            .map(|i| Edit::set(Part::Object(i), Object::reflection_model, id))
            .collect();
        let _ = session.apply(Action::Edit(Edit::Each { edits, step: "Models".to_owned() }), registry);
    }

    #[test]
    fn each_value_is_named_with_the_model_that_the_object_had() {
        let disney = ("disney", "specular", 0.4);
        let openpbr = ("openpbr", "coat_weight", 0.8);
        let (mut session, registry) = mixed(&[disney, disney, openpbr, openpbr]);
        choose_for_each(&mut session, &registry, "metallic_roughness");
        let [note] = &session.messages[..] else { panic!("one message: {}", session.messages.len()) };
        assert_eq!(
            note.text,
            "4 objects use Metallic–roughness; of 2 that had Disney: specular becomes reflectance. \
             Metallic–roughness has no place for coat; it comes back with OpenPBR (2 objects)."
        );
    }

    #[test]
    fn a_message_counts_the_objects_that_changed_and_those_of_which_it_is_true() {
        let (mut session, registry) = begin("disney", 3, &[("roughness", 0.4)]);
        for i in [0, 1] {
            let edit = Edit::material(Part::Object(i), "specular", number(0.4));
            let _ = session.apply(Action::Edit(edit), &registry);
        }
        choose(&mut session, &registry, "metallic_roughness");
        assert_eq!(last(&session), "3 objects use Metallic–roughness; of 2: specular becomes reflectance.");
    }

    #[test]
    fn a_value_has_the_name_that_the_model_showed_from_which_the_object_comes() {
        let (mut session, registry) = begin("openpbr", 1, &[("specular_ior", 1.4), ("roughness", 0.4)]);
        choose(&mut session, &registry, "disney");
        assert!(last(&session).contains("refractive index 1.4 becomes specular"), "{}", last(&session));
        choose(&mut session, &registry, "metallic_roughness");
        let said = last(&session);
        assert!(said.starts_with("Metallic–roughness for Sphere 1: specular "), "{said}");
        assert!(said.contains(" becomes reflectance ") && !said.contains("index"), "{said}");
        // A value that keeps its name and size is no news.
        let (mut session, registry) = begin("ward", 1, &[("alpha_x", 0.25), ("alpha_y", 0.25)]);
        choose(&mut session, &registry, "disney");
        session.messages.clear();
        choose(&mut session, &registry, "metallic_roughness");
        assert_eq!(value(&session, "roughness"), Some(number(0.5)));
        assert_eq!(last(&session), "");
    }

    #[test]
    fn another_default_is_said() {
        let (mut session, registry) = begin("disney", 1, &[]);
        let start = session.document.objects[0].material.clone();
        choose(&mut session, &registry, "openpbr");
        assert_eq!(last(&session), "Default of OpenPBR: roughness 0.3 (was 0.5).");
        assert_eq!(session.document.objects[0].material, start, "and nothing is written into the scene");
        choose(&mut session, &registry, "disney");
        assert!(last(&session).contains("roughness 0.5 (was 0.3)"), "{}", last(&session));
        let (mut session, registry) = begin("disney", 1, &[("roughness", 0.5)]);
        choose(&mut session, &registry, "openpbr");
        assert!(!last(&session).contains("roughness"), "a value that is set stays");
    }

    #[test]
    fn several_values_become_one() {
        let (mut session, registry) = begin("ward", 1, &[("alpha_x", 0.3), ("alpha_y", 0.1)]);
        choose(&mut session, &registry, "blinn_phong");
        let said = last(&session);
        assert!(said.contains("roughness across the tangent 0.1 become "), "{said}");
        let (mut session, registry) = begin("ward", 2, &[("alpha_x", 0.3), ("alpha_y", 0.1)]);
        choose(&mut session, &registry, "blinn_phong");
        let said = last(&session);
        assert!(said.contains("roughness across the tangent become "), "{said}");
    }

    #[test]
    fn what_the_user_sets_stays() {
        let (mut session, registry) = begin("disney", 1, &[("clearcoat", 0.5), ("roughness", 0.3)]);
        choose(&mut session, &registry, "openpbr");
        let edit = Edit::material(Part::Object(0), "coat_weight", number(0.7));
        let _ = session.apply(Action::Edit(edit), &registry);
        choose(&mut session, &registry, "disney");
        let both = |session: &Session| (value(session, "clearcoat"), value(session, "coat_weight"));
        assert_eq!(both(&session), (Some(number(0.5)), Some(number(0.7))));
        choose(&mut session, &registry, "openpbr");
        assert_eq!(both(&session), (Some(number(0.5)), Some(number(0.7))));
    }

    #[test]
    fn it_is_one_step_for_undo_and_redo() {
        let (mut session, registry) = begin("disney", 3, &[("clearcoat", 0.5), ("roughness", 0.3)]);
        let start = session.document.scene().clone();
        choose(&mut session, &registry, "openpbr");
        let there = session.document.scene().clone();
        assert_eq!(session.document.done(), 1);
        assert_eq!(last(&session), "OpenPBR for 3 objects: clear coat becomes coat.");
        for _ in 0..2 {
            let _ = session.apply(Action::Undo, &registry);
            assert!(*session.document.scene() == start);
            let _ = session.apply(Action::Redo, &registry);
            assert!(*session.document.scene() == there);
        }
        // After undo and redo, leaving the model takes back what was carried all the same.
        choose(&mut session, &registry, "ward");
        assert_eq!(value(&session, "coat_weight"), None);
        choose(&mut session, &registry, "disney");
        assert!(session.document.objects == start.objects);
        let _ = session.apply(Action::Undo, &registry);
        let _ = session.apply(Action::Undo, &registry);
        assert!(*session.document.scene() == there);
    }

    #[test]
    fn one_object_goes_alone() {
        let (mut session, registry) = begin("disney", 2, &[("clearcoat", 0.5)]);
        let edit = Edit::set(Part::Object(1), Object::reflection_model, "openpbr");
        let _ = session.apply(Action::Edit(edit), &registry);
        let coat = |i: usize| session.document.objects[i].material.0.get("coat_weight").cloned();
        assert_eq!((coat(0), coat(1)), (None, Some(number(0.125))));
        // Back to the scene's.
        let edit = Edit::put(Part::Object(1), Object::reflection_model, None::<Value>);
        let _ = session.apply(Action::Edit(edit), &registry);
        assert_eq!(session.document.objects[1].material, session.document.objects[0].material);
    }

    #[test]
    fn a_row_stays_a_row() {
        for (varied, carried) in [("size", Some(number(0.25))), ("material.roughness", None)] {
            let (mut session, registry) = begin("disney", 1, &[("roughness", 0.5)]);
            let mut scene = session.document.scene().clone();
            let by =
                Varied { parameter: varied.to_owned(), from: Some(0.5), to: Some(0.9), ..Varied::default() };
            let repeat = Repeat { columns: 3, spacing: glam::Vec3::X, vary: vec![by], ..Repeat::default() };
            scene.objects[0].repeat = Repetition::Entry(Box::new(repeat));
            session.document = Document::new(scene.expanded(&registry).expect("a row"));
            choose(&mut session, &registry, "ward");
            assert_eq!(value(&session, "alpha_x"), carried, "{varied}");
            assert_eq!(session.document.gathered(&registry).objects.len(), 1, "{varied}");
        }
    }

    /// What n and k of gold reflect, as codes.
    const COLOUR_OF_GOLD: Value = Value::Colour([248, 218, 170]);

    /// Gives all objects gold by its n and k.
    fn gild(session: &mut Session) {
        let mut scene = session.document.scene().clone();
        for Values(material) in scene.objects.iter_mut().map(|object| &mut object.material) {
            material.insert("ior".into(), Value::Triple([0.188_36, 0.543_86, 1.331_85]));
            material.insert("extinction".into(), Value::Triple([3.4034, 2.2309, 1.8693]));
            material.insert("fresnel".into(), Value::Choice("conductor".into()));
        }
        session.document = Document::new(scene);
    }

    /// The base colour and the fraction of metal.
    fn metal(session: &Session) -> (Option<Value>, Option<Value>) {
        (value(session, "base_colour"), value(session, "metallic"))
    }

    #[test]
    fn a_metal_goes_along_and_gives_the_base_colour_back() {
        for from in ["microfacet", "cook_torrance", "torrance_sparrow"] {
            for to in ["disney", "openpbr", "metallic_roughness"] {
                let (mut session, registry) = begin(from, 1, &[]);
                gild(&mut session);
                let start = session.document.objects[0].material.clone();
                choose(&mut session, &registry, to);
                let gold = (Some(COLOUR_OF_GOLD), Some(number(1.0)));
                assert_eq!(metal(&session), gold, "{from} → {to}");
                let missed = last(&session).split("no place for").nth(1).unwrap_or_default();
                assert!(!missed.contains("index") && !missed.contains("extinction"), "{missed}");
                let _ = session.apply(Action::Undo, &registry);
                assert_eq!(session.document.objects[0].material, start, "{from} → {to}");
                let _ = session.apply(Action::Redo, &registry);
                assert_eq!(metal(&session), gold, "{from} → {to}");
                // The next model with a fraction of metal has it, too, and one without any has the colour of the body.
                choose(&mut session, &registry, "strauss");
                assert_eq!(metal(&session), gold, "{from} → {to} → strauss");
                choose(&mut session, &registry, "lambert");
                assert_eq!(metal(&session), (Some(Value::Colour([200, 100, 50])), None), "{from} → {to}");
                choose(&mut session, &registry, to);
                assert_eq!(metal(&session), gold, "lambert → {to}");
                session.messages.clear();
                choose(&mut session, &registry, from);
                assert_eq!(session.document.objects[0].material, start, "{to} → {from}");
                assert_eq!(last(&session), "", "nothing is missed: {to} → {from}");
            }
        }
    }

    #[test]
    fn a_metal_without_a_base_colour_goes_back_without_one() {
        let (mut session, registry) = begin("cook_torrance", 1, &[]);
        gild(&mut session);
        let mut scene = session.document.scene().clone();
        scene.objects[0].material.0.remove("base_colour");
        session.document = Document::new(scene);
        choose(&mut session, &registry, "disney");
        assert_eq!(metal(&session), (Some(COLOUR_OF_GOLD), Some(number(1.0))));
        choose(&mut session, &registry, "cook_torrance");
        assert_eq!(metal(&session), (None, None));
    }

    #[test]
    fn what_becomes_of_a_metal_is_said() {
        let index =
            "refractive index 0.18836, 0.54386, 1.33185 and extinction coefficient 3.4034, 2.2309, 1.8693";
        let (mut session, registry) = begin("cook_torrance", 1, &[]);
        gild(&mut session);
        choose(&mut session, &registry, "disney");
        let said = format!("Disney for Sphere 1: {index} become base colour 248, 218, 170 and metallic 1.");
        assert_eq!(last(&session), said);
        let (mut session, registry) = begin("cook_torrance", 2, &[]);
        gild(&mut session);
        choose(&mut session, &registry, "disney");
        assert_eq!(
            last(&session),
            "Disney for 2 objects: refractive index and extinction coefficient become base colour and metallic."
        );
    }

    #[test]
    fn a_metal_that_the_user_has_dyed_stays_one() {
        let (mut session, registry) = begin("cook_torrance", 1, &[]);
        gild(&mut session);
        choose(&mut session, &registry, "disney");
        let green = Value::Colour([20, 200, 40]);
        let edit = Edit::material(Part::Object(0), "base_colour", green.clone());
        let _ = session.apply(Action::Edit(edit), &registry);
        for id in ["cook_torrance", "disney", "openpbr"] {
            choose(&mut session, &registry, id);
            assert_eq!(metal(&session), (Some(green.clone()), Some(number(1.0))), "{id}");
        }
    }

    #[test]
    fn a_base_colour_that_changes_meanwhile_is_the_one_that_is_back() {
        let (mut session, registry) = begin("cook_torrance", 1, &[]);
        gild(&mut session);
        choose(&mut session, &registry, "disney");
        choose(&mut session, &registry, "cook_torrance");
        let blue = Value::Colour([20, 40, 200]);
        let edit = Edit::material(Part::Object(0), "base_colour", blue.clone());
        let _ = session.apply(Action::Edit(edit), &registry);
        choose(&mut session, &registry, "disney");
        assert_eq!(metal(&session), (Some(COLOUR_OF_GOLD), Some(number(1.0))));
        choose(&mut session, &registry, "cook_torrance");
        assert_eq!(metal(&session), (Some(blue), None));
    }

    #[test]
    fn a_row_of_metal_stays_a_row() {
        // Where some copies are a body rather than a metal, neither the fraction nor the colour goes along.
        for (varied, goes) in [("size", true), ("material.specular_weight", false)] {
            let (mut session, registry) = begin("cook_torrance", 1, &[("specular_weight", 0.6)]);
            gild(&mut session);
            let mut scene = session.document.scene().clone();
            let by =
                Varied { parameter: varied.to_owned(), from: Some(0.3), to: Some(0.9), ..Varied::default() };
            let repeat = Repeat { columns: 3, spacing: glam::Vec3::X, vary: vec![by], ..Repeat::default() };
            scene.objects[0].repeat = Repetition::Entry(Box::new(repeat));
            session.document = Document::new(scene.expanded(&registry).expect("a row"));
            let start = session.document.objects.clone();
            choose(&mut session, &registry, "disney");
            for object in &session.document.objects {
                assert_eq!(object.material.0.contains_key("metallic"), goes, "{varied}");
                let is_gold = object.material.0.get("base_colour") == Some(&COLOUR_OF_GOLD);
                assert_eq!(is_gold, goes, "{varied}");
            }
            assert_eq!(session.document.gathered(&registry).objects.len(), 1, "{varied}");
            choose(&mut session, &registry, "cook_torrance");
            assert!(session.document.objects == start, "{varied}");
        }
    }

    #[test]
    fn another_document_knows_nothing_of_the_way() {
        let (mut session, registry) = begin("disney", 1, &[("clearcoat", 0.5)]);
        choose(&mut session, &registry, "openpbr");
        assert!(session.desk.travels != Travels::default());
        let other = session.document.scene().clone();
        let _ = session.opened("other.json".into(), other);
        assert!(session.desk.travels == Travels::default());
    }
}
