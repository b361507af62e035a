//! Edits meet the rules of scenes. A refusal is put in words for people, who see names and not paths.

use super::{Document, Edit, Selection};
use crate::{
    parameter::{Parameter, Value},
    registry::Registry,
    scene::{
        Key, Object, Part,
        check::{self, Change, Declared},
        error::{Problem, Segment},
        field::Kind,
        limits::{self, Limits},
        part::Fields,
    },
};

impl Document {
    /// The limits of one extent of the room.
    #[must_use]
    pub fn dimension_limits(&self, axis: usize, registry: &Registry) -> Limits {
        limits::extent(&self.scene, axis, |part| self.name_of_part(part, registry))
    }

    /// True if the rules of scenes allow an edit.
    #[must_use]
    pub fn allows(&self, edit: &Edit, registry: &Registry) -> bool {
        match edit {
            Edit::Each { edits, .. } => self.check_each(edits, registry).is_ok(),
            edit => self.check(edit, registry).is_ok(),
        }
    }

    /// The change that an edit makes, or the reason why the rules of scenes refuse it.
    pub(super) fn check(&self, edit: &Edit, registry: &Registry) -> Result<Change, String> {
        let change = self.changed(edit, registry)?;
        let (part, values) = edit.values();
        if let Change::Row(places, _) = &change {
            // Values of materials follow when a model is chosen.
            let models = [Object::reflection_model, Object::shading_model];
            let chooses = values.iter().any(|(key, _)| models.into_iter().any(|model| *key == model.into()));
            let follows = |problem: &Problem| {
                let key = problem.path.segments().get(2);
                chooses && matches!(key, Some(Segment::Key(key)) if key == Object::material.key)
            };
            let problem =
                check::change(&self.scene, part, &change, registry).into_iter().find(|one| !follows(one));
            return problem
                .map_or(Ok(()), |problem| Err(self.refused_copy(places, &problem, registry)))
                .map(|()| change);
        }
        for problem in check::change(&self.scene, part, &change, registry) {
            let key = values.iter().map(|(key, _)| *key).find(|key| key.within(part) == problem.path);
            // Other values of a part follow when a type or a model is chosen.
            if key.is_some() || matches!(part, Part::Size | Part::Variant(_) | Part::Comparison) {
                let said = self.refusal(part, key, &change, &problem, registry);
                return Err(said.unwrap_or_else(|| format!("{problem}.")));
            }
        }
        Ok(change)
    }

    /// The reason for the refusal of a change; `None` if the problem says it.
    pub(super) fn refusal(
        &self,
        part: Part,
        key: Option<Key>,
        change: &Change,
        problem: &Problem,
        registry: &Registry,
    ) -> Option<String> {
        let fields: &dyn Fields = match change {
            Change::Light(_, light) => light,
            Change::Object(_, object) => object,
            Change::Rest(rest) => rest.part(part)?,
            Change::Row(..) => return None,
        };
        match (part, key) {
            (Part::Size, _) => {
                ["width", "height", "depth"].into_iter().enumerate().find_map(|(axis, what)| {
                    let value = fields.value(Key::Own(what))?;
                    beyond(&format!("The {what} of the room"), value, &self.dimension_limits(axis, registry))
                })
            }
            (Part::Variant(_) | Part::Comparison, _) | (_, None) => None,
            (_, Some(key @ Key::Material(name))) => {
                let (Change::Object(_, object), value) = (change, fields.value(key)?) else { return None };
                let declared = Declared::of(registry, &self.scene, object, name).refusing(&value).err()?;
                Some(refused(declared, &value, || format!("No model has a parameter “{name}”.")))
            }
            (_, Some(Key::Own(key))) => self.refused_field(part, fields, key, problem, registry),
        }
    }

    /// The reason for the refusal of a value in a part as it would be.
    fn refused_field(
        &self,
        part: Part,
        fields: &dyn Fields,
        key: &'static str,
        problem: &Problem,
        registry: &Registry,
    ) -> Option<String> {
        let name = self.name_of_part(part, registry);
        let value = fields.value(Key::Own(key))?;
        let Some(field) = fields.field(key) else {
            let declared = fields.parameters(registry).iter().find(|p| p.name == key);
            return Some(refused(declared, &value, || format!("{name} has no parameter “{key}”.")));
        };
        let label = field.label();
        if problem.found.is_none() {
            return Some(format!("{name} has no {label}."));
        }
        let what = match part {
            Part::Light(_) | Part::Object(_) => format!("{name}: the {label}"),
            _ => format!("The {label}"),
        };
        match (field.kind, value) {
            (Kind::Position, Value::Triple(p)) => {
                let outside = ["x", "y", "z"].into_iter().enumerate().find_map(|(axis, letter)| {
                    let limits = limits::position(self.scene.scene_size, axis);
                    beyond(&format!("{name}: {letter}"), p[axis].into(), &limits)
                });
                outside.or_else(|| {
                    let other = self.name_of_part(check::met(&self.scene, part, p.into())?, registry);
                    Some(format!("{name} cannot be at the same position as {other}."))
                })
            }
            (Kind::Direction, _) => Some(format!("{name}: the direction must not be (0, 0, 0).")),
            (Kind::Rotation, _) => Some(format!("{name}: the rotation must be finite.")),
            (Kind::Count(_), count) => {
                let Part::Object(i) = part else { return None };
                let shape = registry.shape(&self.scene.objects.get(i)?.object_type)?;
                beyond(&what, count, &limits::tessellation(shape.declaration))
            }
            (Kind::Id(ids), Value::Choice(id)) => Some(format!("There is no {} called “{id}”.", ids.name())),
            (_, value) => beyond(&what, value, &field.limits()),
        }
    }

    /// The name of any part, as [`name_of`](Self::name_of) gives it.
    pub(super) fn name_of_part(&self, part: Part, registry: &Registry) -> String {
        let selection = match part {
            Part::Light(i) => Selection::Light(i),
            Part::Object(i) => Selection::Object(i),
            Part::Observer => Selection::Observer,
            _ => Selection::Room,
        };
        self.name_of(selection, registry)
    }
}

/// The sentence about a value of a parameter that is refused, or does not exist.
fn refused(declared: Option<&Parameter>, value: &Value, no: impl FnOnce() -> String) -> String {
    match (declared, value) {
        (None, _) => no(),
        (Some(_), Value::File(file)) => file.problem().unwrap_or_default() + ".",
        (Some(p), value) => format!("{} is {value}, but must be {}.", p.label, p.rule()),
    }
}

/// The sentence about a number that is not within its limits.
fn beyond(what: &str, value: Value, limits: &Limits) -> Option<String> {
    let value = match value {
        Value::Number(v) => f64::from(v),
        Value::Integer(n) => n as f64,
        _ => return None,
    };
    let rule = || format!("{what} is {}, but must be {}.", limits::number(value), limits.rule());
    (!limits.allows(value)).then(rule)
}
