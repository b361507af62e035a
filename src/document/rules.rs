//! The rules that an edit must obey, with the same limits that widgets show.

use glam::Vec3;

use super::{Document, Edit, LightField, ObjectField, Selection, VariantField, edit::put_in_variant};
use crate::{
    parameter::{Parameter, Value},
    registry::Registry,
    scene::{
        Object, Scene, check,
        limits::{self, Limits},
    },
};

impl Document {
    /// The limits of one extent of the room.
    #[must_use]
    pub fn dimension_limits(&self, axis: usize, registry: &Registry) -> Limits {
        dimension(&self.scene, axis, |part| self.name_of(part, registry))
    }

    /// True if the rules of scenes allow an edit.
    #[must_use]
    pub fn allows(&self, edit: &Edit, registry: &Registry) -> bool {
        self.check(edit, registry).is_ok()
    }

    /// Checks an edit against the rules of scenes, with the limits that widgets show.
    pub(super) fn check(&self, edit: &Edit, registry: &Registry) -> Result<(), String> {
        let light = |i: usize| self.scene.lights.get(i).ok_or_else(|| "there is no such light".to_owned());
        let object = |i: usize| self.scene.objects.get(i).ok_or_else(|| "there is no such object".to_owned());
        let name = |part| self.name_of(part, registry);
        let known = |yes: bool, what: &str, id: &str| {
            if yes { Ok(()) } else { Err(format!("There is no {what} called “{id}”.")) }
        };
        let legal = |what: String, value: f32, limits: Limits| {
            if limits.allows(f64::from(value)) {
                return Ok(());
            }
            Err(format!("{what} is {}, but must be {}.", limits::number(f64::from(value)), limits.rule()))
        };
        let model = |id: &str| known(registry.model(id).is_some(), "reflection model", id);
        let shading = |id: &str| known(registry.shading_model(id).is_some(), "shading model", id);
        let place = |part: Selection, p: Vec3| {
            for (axis, letter) in ["x", "y", "z"].into_iter().enumerate() {
                let what = format!("{}: {letter}", name(part));
                legal(what, p.to_array()[axis], limits::position(self.scene.scene_size, axis))?;
            }
            match places(&self.scene).find(|(q, at)| may_not_meet(part, *q) && check::same_place(*at, p)) {
                Some((other, _)) => {
                    Err(format!("{} cannot stand exactly where {} stands.", name(part), name(other)))
                }
                None => Ok(()),
            }
        };
        let material = |object: &Object, id: &str, value: &Value| {
            check::Declared::of(registry, &self.scene, object, id).refusing(value).map_err(|p| match p {
                Some(p) => format!("{} is {value}, but must be {}.", p.label, p.rule()),
                None => format!("No model has a parameter “{id}”."),
            })
        };
        let of_type = |part: Selection, declared: Option<&Parameter>, id: &str, value: &Value| match declared
        {
            Some(p) if p.allows(value) => Ok(()),
            Some(p) => Err(match value {
                Value::File(file) => file.problem().unwrap_or_default() + ".",
                _ => format!("{} is {value}, but must be {}.", p.label, p.rule()),
            }),
            None => Err(format!("{} has no parameter “{id}”.", name(part))),
        };
        let direction = |part: Selection, d: Vec3| {
            if check::direction(d).is_ok() {
                return Ok(());
            }
            Err(format!("{}: the direction (0, 0, 0) points nowhere.", name(part)))
        };
        match edit {
            Edit::SceneName(_) | Edit::SceneDescription(_) => Ok(()),
            Edit::SceneSize(size) => {
                for (axis, what) in ["width", "height", "depth"].into_iter().enumerate() {
                    let value = size.corner().to_array()[axis];
                    legal(format!("The {what} of the room"), value, self.dimension_limits(axis, registry))?;
                }
                Ok(())
            }
            Edit::Display(d) => legal("The exposure".to_owned(), d.exposure, limits::exposure()),
            Edit::Model(id) => model(id),
            Edit::ShadingModel(id) => shading(id),
            Edit::Observer(o) => {
                place(Selection::Observer, o.position)?;
                direction(Selection::Observer, o.direction)?;
                legal("The field of view".to_owned(), o.field_of_view, limits::field_of_view())
            }
            Edit::Variant(i, _) if *i >= self.scene.variants.len() => {
                Err("There is no such variant.".to_owned())
            }
            Edit::Variant(i, VariantField::Name(name))
                if name.trim().is_empty() && is_basis(&self.scene, *i) =>
            {
                Err("Other views are based on this one by its name: give it another one.".to_owned())
            }
            Edit::Variant(i, field) => variants(&self.scene, registry, |scene| {
                put_in_variant(scene, *i, field.clone());
            }),
            Edit::Views { variants: all, comparison, .. } => variants(&self.scene, registry, |scene| {
                scene.variants.clone_from(all);
                scene.comparison = *comparison;
            }),
            Edit::Comparison(comparison) => {
                variants(&self.scene, registry, |scene| scene.comparison = *comparison)
            }
            Edit::Light(i, field) => {
                let light = light(*i)?;
                let part = Selection::Light(*i);
                let entry = registry.light(&light.light_type);
                let declaration = entry.map(|e| e.declaration);
                match field {
                    LightField::Name(_) | LightField::Enabled(_) | LightField::Colour(_) => Ok(()),
                    LightField::Type(id) => known(registry.light(id).is_some(), "light type", id),
                    LightField::Position(_) if declaration.is_some_and(|d| !d.has_position) => {
                        Err(format!("{} has no position.", name(part)))
                    }
                    LightField::Position(p) => place(part, *p),
                    LightField::Direction(_) if declaration.is_some_and(|d| !d.has_direction) => {
                        Err(format!("{} has no direction.", name(part)))
                    }
                    LightField::Direction(d) => direction(part, *d),
                    LightField::Intensity(v) => match declaration {
                        Some(d) => legal(format!("{}: the intensity", name(part)), *v, limits::intensity(d)),
                        None => Ok(()),
                    },
                    LightField::LuminousFlux(v) => match entry {
                        Some(e) if !e.has_flux() => Err(format!("{} has no luminous flux.", name(part))),
                        Some(e) => legal(
                            format!("{}: the luminous flux", name(part)),
                            *v,
                            limits::luminous_flux(e.declaration),
                        ),
                        None => Ok(()),
                    },
                    LightField::ColourTemperature(v) => legal(
                        format!("{}: the colour temperature", name(part)),
                        *v,
                        limits::colour_temperature(),
                    ),
                    LightField::Parameter(id, value) => {
                        of_type(part, entry.and_then(|e| e.parameter(id)), id, value)
                    }
                }
            }
            Edit::Object(i, field) => {
                let object = object(*i)?;
                let part = Selection::Object(*i);
                match field {
                    ObjectField::Name(_) | ObjectField::Visible(_) => Ok(()),
                    ObjectField::Type(id) => known(registry.shape(id).is_some(), "object type", id),
                    ObjectField::Position(p) => place(part, *p),
                    ObjectField::Size(v) => legal(
                        format!("{}: the size", name(part)),
                        *v,
                        limits::object_size(self.scene.scene_size),
                    ),
                    ObjectField::Rotation(r) if r.is_finite() => Ok(()),
                    ObjectField::Rotation(_) => Err(format!("{}: the rotation must be finite.", name(part))),
                    ObjectField::Tessellation(None) => Ok(()),
                    ObjectField::Tessellation(Some(n)) => match registry.shape(&object.object_type) {
                        Some(s) => legal(
                            format!("{}: the tessellation", name(part)),
                            *n as f32,
                            limits::tessellation(s.declaration),
                        ),
                        None => Ok(()),
                    },
                    ObjectField::Model(id) => id.as_deref().map_or(Ok(()), model),
                    ObjectField::ShadingModel(id) => id.as_deref().map_or(Ok(()), shading),
                    ObjectField::Shape(id, value) => {
                        let shape = registry.shape(&object.object_type);
                        of_type(part, shape.and_then(|s| s.parameter(id)), id, value)
                    }
                    ObjectField::Material(id, value) => material(object, id, value),
                    ObjectField::Preset(all) => {
                        all.iter().try_for_each(|(id, value)| material(object, id, value))
                    }
                }
            }
        }
    }
}

/// True if other variants inherit from one by its name.
fn is_basis(scene: &Scene, i: usize) -> bool {
    let name = scene.variants.get(i).and_then(|variant| variant.name.as_ref());
    name.is_some() && scene.variants.iter().any(|other| other.based_on.as_ref() == name)
}

/// `Ok` if the variants of a scene are legal after a change.
fn variants(scene: &Scene, registry: &Registry, change: impl FnOnce(&mut Scene)) -> Result<(), String> {
    let mut after = scene.clone();
    change(&mut after);
    // Errors caused before by a changed model file must not prevent other edits.
    let known = check::variants(scene, registry);
    let problem = check::variants(&after, registry).into_iter().find(|problem| !known.contains(problem));
    problem.map_or(Ok(()), |problem| Err(format!("{problem}.")))
}

/// The positions of all parts that have one.
fn places(scene: &Scene) -> impl Iterator<Item = (Selection, Vec3)> + '_ {
    let lights =
        scene.lights.iter().enumerate().filter_map(|(i, l)| Some((Selection::Light(i), l.position?)));
    let objects = scene.objects.iter().enumerate().map(|(i, o)| (Selection::Object(i), o.position));
    lights.chain(objects).chain([(Selection::Observer, scene.observer.position)])
}

/// True if two parts must not have the same position: lights, objects and the observer exclude each other;
/// two lights or two objects may share theirs.
fn may_not_meet(a: Selection, b: Selection) -> bool {
    std::mem::discriminant(&a) != std::mem::discriminant(&b)
}

/// An extent of the room, in metres: everything in the room must stay inside. `name` returns the name of a
/// part.
fn dimension(scene: &Scene, axis: usize, name: impl Fn(Selection) -> String) -> Limits {
    let at = |p: Vec3| p.to_array()[axis.min(2)];
    let lights =
        scene.lights.iter().enumerate().filter_map(|(i, l)| Some((Selection::Light(i), l.position?)));
    let objects = scene.objects.iter().enumerate().map(|(i, o)| (Selection::Object(i), o.position));
    let furthest = lights
        .chain(objects)
        .chain([(Selection::Observer, scene.observer.position)])
        .map(|(who, p)| (who, at(p)))
        .filter(|(_, c)| c.is_finite())
        .max_by(|a, b| a.1.total_cmp(&b.1));
    let any = limits::dimension();
    match furthest {
        Some((who, c)) if c > 0.0 && any.allows(f64::from(c)) => Limits {
            because: Some(format!(
                "{} stands at {} = {} m",
                name(who),
                ["x", "y", "z"][axis.min(2)],
                limits::number(f64::from(c))
            )),
            ..Limits::between(f64::from(c), any.max).slider(0.0, any.max)
        },
        _ => any,
    }
}
