//! Values of the document that no model accepts any more, because custom models change while the window is open.
//!
//! Such values are stashed, so that the document can be saved, and restored when a model accepts them again.

use std::{borrow::Cow, collections::BTreeMap, mem::discriminant, ops::DerefMut};

use super::{Kept, ParameterPlace, Session, Severity, StashedValues};
use crate::{
    document::{Extent, Selection},
    parameter::{Parameter, Value},
    registry::Registry,
    scene::{Object, Repetition, check::Declared},
};

/// A value of the document that is replaced.
struct Change {
    place: ParameterPlace,
    /// The value set by the user.
    wanted: Value,
    /// The value that the document gets instead.
    to: Option<Value>,
    /// Declaration of the parameter, if any.
    declared: Option<&'static Parameter>,
}

/// Adapts the document to the current models: stashes values that no model accepts, moves numbers to the nearest value
/// in range, restores stashed values that are accepted again, and reports each change. Values that the user has changed
/// meanwhile stay. Borrows `session` mutably only when something changes.
pub fn follow_registry(session: impl DerefMut<Target = Session>, registry: &Registry) {
    follow(session, registry, false);
}

/// Adapts the document after a step that gave objects another model. The changes belong to that step.
pub fn follow_model(session: &mut Session, registry: &Registry) {
    follow(&mut *session, registry, true);
    tell_views(session, registry);
}

/// Says which values the models of views do not allow, unless it is said already.
pub fn tell_views(session: &mut Session, registry: &Registry) {
    for said in session.document.beyond_the_range_of_views(registry) {
        if session.messages.iter().all(|known| known.text != said) {
            session.say(Severity::Info, said);
        }
    }
}

fn follow(mut session: impl DerefMut<Target = Session>, registry: &Registry, within_step: bool) {
    let (changes, stashed) = plan(&session, registry);
    if stashed != session.stashed {
        session.stashed = stashed;
    }
    if changes.is_empty() {
        return;
    }
    let news = told(&session, registry, &changes);
    let session = &mut *session;
    let changes: Vec<_> = changes
        .into_iter()
        .filter_map(|change| Some((session.document.object(change.place.0)?, change.place.1, change.to)))
        .collect();
    let put = |object: &mut Object, name: Cow<'static, str>, to: Option<Value>| match to {
        Some(value) => object.material.set(name, value),
        None => drop(object.material.0.remove(&name)),
    };
    let is_copy = |i: usize| matches!(session.document.objects[i].repeat, Repetition::Copy { .. });
    let in_rows = changes.iter().any(|(i, ..)| is_copy(*i));
    if within_step && in_rows {
        session.document.go_on(Extent::All, |scene| {
            changes.into_iter().for_each(|(i, name, to)| put(&mut scene.objects[i], name, to));
            scene.follow_copies(registry);
        });
    } else if within_step {
        changes.into_iter().for_each(|(i, name, to)| {
            session.document.go_on(Extent::Object(i), |scene| put(&mut scene.objects[i], name, to))
        });
    } else {
        // Not a step for undo: undoing it would bring back values that no model accepts.
        session.document.amend(|scene| {
            changes.into_iter().for_each(|(i, name, to)| put(&mut scene.objects[i], name, to));
            scene.follow_copies(registry);
        });
    }
    for text in news {
        session.say(Severity::Info, text);
    }
}

/// The changes that the document needs, and the values that are then stashed.
fn plan(session: &Session, registry: &Registry) -> (Vec<Change>, StashedValues) {
    let mut changes = Vec::new();
    let mut stashed = StashedValues::default();
    let mut gone = BTreeMap::new();
    let mut place_value = |id, object: &Object, name: &Cow<'static, str>, wanted: &Value, from| {
        let declarations = Declared::of(registry, &session.document, object, name);
        let to = declarations.nearest(wanted);
        if to.as_ref() != Some(wanted) {
            let kept = Kept { wanted: wanted.clone(), instead: to.clone() };
            stashed.0.insert((id, name.clone()), kept);
        }
        if to.as_ref() != from {
            let all = declarations.all();
            let declared =
                all.iter().find(|p| to.as_ref().is_some_and(|v| p.allows(v))).or(all.first()).copied();
            changes.push(Change { place: (id, name.clone()), wanted: wanted.clone(), to, declared });
        }
    };
    for (i, object) in session.document.objects.iter().enumerate() {
        let Some(id) = session.document.object_id(i) else { continue };
        for (name, value) in &object.material.0 {
            let kept = session.stashed.0.get(&(id, name.clone()));
            let kept = kept.filter(|kept| kept.instead.as_ref() == Some(value));
            place_value(id, object, name, kept.map_or(value, |kept| &kept.wanted), Some(value));
        }
    }
    for ((id, name), kept) in &session.stashed.0 {
        match session.document.object(*id).and_then(|i| session.document.objects.get(i)) {
            Some(object) if kept.instead.is_none() && !object.material.0.contains_key(name) => {
                place_value(*id, object, name, &kept.wanted, None);
            }
            Some(_) => {}
            // Undo may bring the object back.
            None => drop(gone.insert((*id, name.clone()), kept.clone())),
        }
    }
    stashed.0.extend(gone);
    (changes, stashed)
}

/// The messages: one per parameter and kind of change, regardless of the number of objects.
fn told(session: &Session, registry: &Registry, changes: &[Change]) -> Vec<String> {
    let mut groups: BTreeMap<(String, String), (usize, &Change)> = BTreeMap::new();
    for change in changes {
        groups.entry(change.several()).or_insert((0, change)).0 += 1;
    }
    let name = |id| {
        session
            .document
            .object(id)
            .map_or_else(String::new, |i| session.name_of(Selection::Object(i), registry))
    };
    let one = |change: &Change| change.single(&name(change.place.0));
    groups
        .into_iter()
        .map(|((before, after), (count, first))| match count {
            1 => one(first),
            _ => format!("{before} {count} objects{after}"),
        })
        .collect()
}

impl Change {
    /// The label of the parameter, or its name if no model declares it.
    fn label(&self) -> &str {
        self.declared.map_or(&*self.place.1, |p| p.label)
    }

    /// The message about a single object.
    fn single(&self, object: &str) -> String {
        let (Self { wanted, to, .. }, name) = (self, self.label());
        match to {
            Some(value) if value == wanted => format!("{name} is {value} for {object} again."),
            Some(value) => {
                format!("{name} is now {value} for {object} instead of {wanted}, {}.", self.reason(value))
            }
            None => {
                let (why, until) = self.why_gone("when it is allowed again");
                format!(
                    "{name} {why}; its value {wanted} for {object} is kept for later and comes back {until}."
                )
            }
        }
    }

    /// The message about several objects: the parts before and after their number.
    fn several(&self) -> (String, String) {
        let (Self { wanted, to, .. }, name) = (self, self.label());
        match to {
            Some(value) if value == wanted => (format!("{name} is as it was again for"), ".".to_owned()),
            Some(value) if self.declared.is_some_and(|p| p.kind.components() > 1) => {
                (format!("{name} is now clamped to its range for"), format!(", {}.", self.reason(value)))
            }
            Some(value) => (format!("{name} is now {value} for"), format!(", {}.", self.reason(value))),
            None => {
                let (why, until) = self.why_gone("when they are allowed again");
                (
                    format!("{name} {why}; its values for"),
                    format!(" are kept for later and come back {until}."),
                )
            }
        }
    }

    /// The reason for a value that replaces the wanted one.
    fn reason(&self, value: &Value) -> String {
        let Some(p) = self.declared else { return String::new() };
        let range = p.kind.limits();
        let (most, least) = match (range, p.kind.number_of(value), p.kind.number_of(&self.wanted)) {
            (Some(range), Some(v), Some(wanted)) => {
                (v == range.max && wanted > v, v == range.min && wanted < v)
            }
            (Some(range), ..) if p.kind.components() > 1 => {
                return format!("since each must be between {} and {}", range.min as f32, range.max as f32);
            }
            _ => (false, false),
        };
        match (most, least) {
            (true, _) => "the largest value allowed".to_owned(),
            (_, true) => "the smallest value allowed".to_owned(),
            _ => format!("since it must be {}", p.rule()),
        }
    }

    /// The reason for a missing value, and the condition for its return.
    fn why_gone(&self, allowed: &'static str) -> (String, &'static str) {
        match self.declared {
            None => ("is no longer a parameter of any model".to_owned(), "when the name does"),
            Some(p) if discriminant(&p.default_value()) == discriminant(&self.wanted) => {
                (format!("must now be {}", p.rule()), allowed)
            }
            Some(_) => ("now has another type".to_owned(), "when the type does"),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::{
        custom,
        document::{Document, Edit},
        panel::state::{Action, CompareCommand},
        scene::{Part, Repeat, Scene, Varied, check, load, save},
    };

    /// Registers Lambert's law with parameters, none of which it uses.
    fn put(registry: &mut Registry, parameters: &str) {
        put_as("mine", registry, parameters);
    }

    fn put_as(id: &str, registry: &mut Registry, parameters: &str) {
        let text = format!(
            "/* lcm {{ \"parameters\": [{parameters}] }} */\nfn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, \
             m: Parameters) -> Terms {{\n    return Terms(vec3(0.0), vec3(max(dot(frame.n, l), 0.0)), vec3(0.0));\n}}\n"
        );
        let model = custom::read(Path::new(&format!("models/{id}.wgsl")), &text, registry)
            .unwrap_or_else(|problems| panic!("{parameters}: {problems:?}"));
        registry.put_custom_model(model);
    }

    fn number(name: &str, min: f32, max: f32) -> String {
        format!("{{ \"name\": \"{name}\", \"min\": {min}, \"max\": {max}, \"default\": {max} }}")
    }

    /// A document with one sphere of the model and one value.
    fn begin(declaration: &str, name: &'static str, value: Value) -> (Session, Registry) {
        let mut registry = Registry::builtin();
        put(&mut registry, declaration);
        let mut session = Session::default();
        let mut scene = Scene { reflection_model: "mine".to_owned(), ..Scene::default() };
        scene.objects[0].material.set(name, value);
        scene.objects[0].material.set("k_s", Value::Number(0.25));
        session.document = Document::new(scene);
        follow(&mut session, &registry, &[]);
        assert!(!session.is_dirty());
        (session, registry)
    }

    /// Follows the registry, and checks the messages and whether the document can be saved.
    fn follow(session: &mut Session, registry: &Registry, said: &[&str]) {
        session.messages.clear();
        follow_registry(&mut *session, registry);
        let texts: Vec<_> = session.messages.iter().map(|m| m.text.as_str()).collect();
        assert_eq!(texts, said);
        assert!(check::scene(&session.document, registry).is_empty());
        let text = save::to_json(&session.document, None, registry);
        let read = load::from_bytes(text.as_bytes(), "a.json", registry, load::Defaults::Ask)
            .unwrap_or_else(|e| panic!("{e}\n{text}"));
        assert_eq!(read.scene.objects, session.document.objects);
        assert_eq!(session.document.objects[0].material.0.get("k_s"), Some(&Value::Number(0.25)));
        // A second call changes nothing.
        let before = (session.document.scene().clone(), session.stashed.clone(), session.messages.clone());
        follow_registry(&mut *session, registry);
        assert_eq!(
            before,
            (session.document.scene().clone(), session.stashed.clone(), session.messages.clone())
        );
    }

    fn value<'a>(session: &'a Session, name: &str) -> Option<&'a Value> {
        session.document.objects[0].material.0.get(name)
    }

    #[test]
    fn a_value_whose_name_is_gone_comes_back_with_the_name() {
        let (mut session, mut registry) = begin(&number("gloss", 0.0, 1.0), "gloss", Value::Number(0.75));
        put(&mut registry, &number("sheen_of_mine", 0.0, 1.0));
        follow(
            &mut session,
            &registry,
            &[
                "gloss is no longer a parameter of any model; its value 0.75 for Sphere 1 is kept for later and comes back \
               when the name does.",
            ],
        );
        assert_eq!((value(&session, "gloss"), session.stashed.len()), (None, 1));
        put(&mut registry, &number("gloss", 0.0, 1.0));
        follow(&mut session, &registry, &["gloss is 0.75 for Sphere 1 again."]);
        assert!(session.stashed.is_empty() && !session.is_dirty());
    }

    #[test]
    fn a_number_out_of_range_is_the_nearest_that_is_not_until_it_is_allowed_again() {
        let (mut session, mut registry) =
            begin(&number("polish", 0.0, 200.0), "polish", Value::Number(150.0));
        put(&mut registry, &number("polish", 0.0, 100.0));
        let most = "polish is now 100 for Sphere 1 instead of 150, the largest value allowed.";
        follow(&mut session, &registry, &[most]);
        put(&mut registry, &number("polish", 160.0, 200.0));
        let least = "polish is now 160 for Sphere 1 instead of 150, the smallest value allowed.";
        follow(&mut session, &registry, &[least]);
        put(&mut registry, &number("polish", 0.0, 200.0));
        follow(&mut session, &registry, &["polish is 150 for Sphere 1 again."]);
        assert!(session.stashed.is_empty() && !session.is_dirty());
    }

    #[test]
    fn a_parameter_is_named_by_its_label() {
        let (mut session, mut registry) =
            begin(&number("shine_x", 0.0, 200.0), "shine_x", Value::Number(80.0));
        put(&mut registry, &number("shine_x", 0.0, 1.0));
        let said = "shine x is now 1 for Sphere 1 instead of 80, the largest value allowed.";
        follow(&mut session, &registry, &[said]);
        let object = Object { reflection_model: Some("mine".to_owned()), ..Object::default() };
        session.document.amend(|scene| scene.objects.push(object));
        session.document.amend(|scene| scene.objects[1].material.set("shine_x", Value::Number(1.0)));
        put(&mut registry, &number("shine_x", 0.0, 0.5));
        follow(&mut session, &registry, &["shine x is now 0.5 for 2 objects, the largest value allowed."]);
    }

    #[test]
    fn whole_numbers_and_three_numbers_follow_too() {
        let integer = |max| {
            format!(
                "{{ \"name\": \"steps\", \"type\": \"integer\", \"min\": 1, \"max\": {max}, \"default\": 2 }}"
            )
        };
        let (mut session, mut registry) = begin(&integer(9), "steps", Value::Integer(7));
        put(&mut registry, &integer(5));
        follow(
            &mut session,
            &registry,
            &["steps is now 5 for Sphere 1 instead of 7, the largest value allowed."],
        );
        put(&mut registry, "{ \"name\": \"steps\", \"type\": \"colour\", \"default\": [1, 2, 3] }");
        follow(
            &mut session,
            &registry,
            &[
                "steps now has another type; its value 7 for Sphere 1 is kept for later and comes back when the type does.",
            ],
        );
        put(&mut registry, &integer(9));
        follow(&mut session, &registry, &["steps is 7 for Sphere 1 again."]);
        assert!(!session.is_dirty());
        let triple = |max| {
            format!(
                "{{ \"name\": \"index\", \"type\": \"triple\", \"min\": 0, \"max\": {max}, \"default\": 1 }}"
            )
        };
        let (mut session, mut registry) = begin(&triple(4), "index", Value::Triple([1.0, 2.0, 3.0]));
        put(&mut registry, &triple(2));
        follow(
            &mut session,
            &registry,
            &["index is now 1,2,2 for Sphere 1 instead of 1,2,3, since each must be between 0 and 2."],
        );
    }

    #[test]
    fn where_a_number_must_be_greater_than_zero_the_default_stands_in() {
        let (mut session, mut registry) = begin(&number("polish", 0.0, 9.0), "polish", Value::Number(0.0));
        put(&mut registry, "{ \"name\": \"polish\", \"above\": 0, \"max\": 9, \"default\": 3 }");
        follow(
            &mut session,
            &registry,
            &["polish is now 3 for Sphere 1 instead of 0, since it must be greater than 0 and at most 9."],
        );
    }

    #[test]
    fn a_value_follows_the_model_that_the_object_gets_and_undoing_gives_it_back() {
        let (mut session, mut registry) = begin(&number("polish", 0.0, 100.0), "polish", Value::Number(80.0));
        put_as("other", &mut registry, &number("polish", 0.0, 1.0));
        let start = session.document.scene().clone();
        let polish = |v| Edit::material(Part::Object(0), "polish", Value::Number(v));
        let model = |id: &str| Edit::set(Part::Scene, Scene::reflection_model, id.to_owned());
        let edit = |session: &mut Session, registry: &Registry, edit, now| {
            session.document.end_gesture();
            session.apply(Action::Edit(edit), registry);
            assert_eq!(value(session, "polish"), Some(&Value::Number(now)));
            assert_eq!(check::scene(&session.document, registry), []);
        };
        edit(&mut session, &registry, model("other"), 1.0);
        edit(&mut session, &registry, model("mine"), 80.0);
        edit(&mut session, &registry, polish(38.5), 38.5);
        edit(&mut session, &registry, polish(120.0), 38.5);
        edit(&mut session, &registry, model("other"), 1.0);
        edit(&mut session, &registry, polish(0.375), 0.375);
        edit(&mut session, &registry, polish(38.5), 0.375);
        put(&mut registry, &number("polish", 0.0, 100.0));
        follow_registry(&mut session, &registry);
        assert_eq!(session.document.steps().len(), 5);
        while session.document.done() > 0 {
            session.apply(Action::Undo, &registry);
            assert_eq!(check::scene(&session.document, &registry), []);
        }
        assert!(*session.document.scene() == start && !session.is_dirty());
    }

    #[test]
    fn a_view_that_gets_another_model_says_which_value_it_uses() {
        let (mut session, mut registry) = begin(&number("polish", 0.0, 100.0), "polish", Value::Number(80.0));
        put_as("other", &mut registry, &number("polish", 0.0, 1.0));
        session.apply(Action::Compare(CompareCommand::Add), &registry);
        assert_eq!(session.active(), 1);
        session.messages.clear();
        for id in ["other", "mine", "other"] {
            session.document.end_gesture();
            let edit = session.edit_model(id);
            session.apply(Action::Edit(edit), &registry);
        }
        let texts: Vec<_> = session.messages.iter().map(|m| m.text.as_str()).collect();
        let said =
            "view B: objects[0].material.polish is 80, but for other it must be between 0 and 1: 1 is used";
        assert_eq!(texts, [said]);
        assert_eq!(value(&session, "polish"), Some(&Value::Number(80.0)));
    }

    #[test]
    fn what_the_user_changed_meanwhile_stays() {
        let (mut session, mut registry) =
            begin(&number("polish", 0.0, 200.0), "polish", Value::Number(150.0));
        put(&mut registry, &number("polish", 0.0, 100.0));
        follow_registry(&mut session, &registry);
        session.document.amend(|scene| scene.objects[0].material.set("polish", Value::Number(60.0)));
        put(&mut registry, &number("polish", 0.0, 200.0));
        follow(&mut session, &registry, &[]);
        assert_eq!(value(&session, "polish"), Some(&Value::Number(60.0)));
        assert!(session.stashed.is_empty());
    }

    #[test]
    fn a_value_of_another_type_or_a_choice_that_is_gone_waits_until_it_fits_again() {
        let (mut session, mut registry) = begin(&number("gloss", 0.0, 1.0), "gloss", Value::Number(0.75));
        put(&mut registry, "{ \"name\": \"gloss\", \"type\": \"choice\", \"choices\": [\"low\", \"high\"] }");
        follow(
            &mut session,
            &registry,
            &[
                "gloss now has another type; its value 0.75 for Sphere 1 is kept for later and comes back when the type does.",
            ],
        );
        assert_eq!(value(&session, "gloss"), None);
        // A value set by the user replaces the stashed one.
        session.document.amend(|scene| scene.objects[0].material.set("gloss", Value::Choice("high".into())));
        put(&mut registry, "{ \"name\": \"gloss\", \"type\": \"choice\", \"choices\": [\"low\", \"full\"] }");
        follow(
            &mut session,
            &registry,
            &[
                "gloss must now be one of \"low\", \"full\"; its value high for Sphere 1 is kept for later and comes back \
               when it is allowed again.",
            ],
        );
        put(
            &mut registry,
            "{ \"name\": \"gloss\", \"type\": \"choice\", \"choices\": [\"high\", \"full\"] }",
        );
        follow(&mut session, &registry, &["gloss is high for Sphere 1 again."]);
    }

    #[test]
    fn several_objects_are_counted_and_keep_what_is_theirs_when_the_list_changes() {
        let (mut session, mut registry) = begin(&number("gloss", 0.0, 1.0), "gloss", Value::Number(0.75));
        for v in [0.25, 0.5] {
            let mut object = Object { reflection_model: Some("mine".to_owned()), ..Object::default() };
            object.material.set("gloss", Value::Number(v));
            session.document.amend(|scene| scene.objects.push(object));
        }
        put(&mut registry, "");
        follow(
            &mut session,
            &registry,
            &[
                "gloss is no longer a parameter of any model; its values for 3 objects are kept for later and come back \
               when the name does.",
            ],
        );
        let part = Selection::Object(1);
        let _ = session.apply(super::super::Action::Duplicate(part), &registry);
        let _ = session.apply(super::super::Action::Remove(part), &registry);
        put(&mut registry, &number("gloss", 0.0, 1.0));
        follow(&mut session, &registry, &["gloss is as it was again for 3 objects."]);
        let values: Vec<_> =
            session.document.objects.iter().map(|o| o.material.0.get("gloss").cloned()).collect();
        assert_eq!(values, [0.75, 0.25, 0.5].map(|v| Some(Value::Number(v))));
    }

    #[test]
    fn the_entry_of_a_row_follows_its_copies() {
        let mut registry = Registry::builtin();
        put(&mut registry, &number("gloss", 0.0, 1.0));
        put_as("theirs", &mut registry, &number("gloss", 0.5, 1.0));
        let varied = Varied {
            parameter: "material.gloss".to_owned(),
            from: Some(0.2),
            to: Some(0.6),
            ..Varied::default()
        };
        let theirs = || "theirs".to_owned();
        let of_scene = Edit::set(Part::Scene, Scene::reflection_model, theirs());
        let of_copy = Edit::set(Part::Object(1), Object::reflection_model, theirs());
        for (edit, vary, expected) in [
            (&of_scene, vec![], [0.5; 3]),
            (&of_scene, vec![varied.clone()], [0.5, 0.5, 0.6]),
            (&of_copy, vec![], [0.5; 3]),
            (&of_copy, vec![varied], [0.5, 0.5, 0.6]),
        ] {
            let mut session = Session::default();
            let repeat = Repeat { columns: 3, spacing: glam::Vec3::X, vary, ..Repeat::default() };
            let mut entry = Object { repeat: Repetition::Entry(Box::new(repeat)), ..Object::default() };
            entry.material.set("gloss", Value::Number(0.2));
            let scene =
                Scene { reflection_model: "mine".to_owned(), objects: vec![entry], ..Scene::default() };
            session.document = Document::new(scene.expanded(&registry).expect("a row"));
            let start = session.document.scene().clone();
            let _ = session.apply(Action::Edit(edit.clone()), &registry);
            let values: Vec<_> =
                session.document.objects.iter().map(|o| o.material.0.get("gloss").cloned()).collect();
            assert_eq!(values, expected.map(|v| Some(Value::Number(v))), "{edit:?}");
            assert_eq!(session.document.gathered(&registry).objects.len(), 1, "{edit:?}");
            assert_eq!(check::scene(&session.document, &registry), []);
            let _ = session.apply(Action::Undo, &registry);
            assert!(*session.document.scene() == start, "{edit:?}");
        }
    }

    #[test]
    fn another_document_gets_nothing_of_what_was_put_aside() {
        let (mut session, mut registry) = begin(&number("gloss", 0.0, 1.0), "gloss", Value::Number(0.75));
        put(&mut registry, "");
        follow_registry(&mut session, &registry);
        let mut other = session.document.scene().clone();
        other.name = Some("Other".to_owned());
        let _ = session.opened("other.json".into(), other);
        assert!(session.stashed.is_empty());
        put(&mut registry, &number("gloss", 0.0, 1.0));
        follow(&mut session, &registry, &[]);
        assert_eq!(value(&session, "gloss"), None);
    }
}
