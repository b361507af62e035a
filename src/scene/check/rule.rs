//! The rules that need more than the [declaration](crate::scene::Field) of a field. Each is a clause: "the diffuse coefficient must be between 0.5 and 1".

use glam::Vec3;

use crate::{
    light::MAX_LIGHTS,
    parameter::{Parameter, Value},
    registry::Registry,
    scene::{
        MAX_OBJECTS, Object, Scene, SceneSize,
        clause::{Rule, must},
        range,
        views::MAX_VARIANTS,
    },
    shape::ShapeEntry,
    text::did_you_mean,
};

/// A position of a light, an object or the observer.
pub fn position(room: SceneSize, position: Vec3) -> Rule {
    must(room.contains(position), || {
        let SceneSize { width, height, depth, .. } = room;
        format!(
            "a position must be inside the room: 0 < x ≤ {width} (width), 0 < y ≤ {height} (height), \
             0 < z ≤ {depth} (depth)"
        )
    })
}

/// The tessellation of an object of a type.
pub fn tessellation(shape: &ShapeEntry, count: u32) -> Rule {
    must(range::tessellation(shape.declaration).allows(count.into()), || tessellation_rule(shape))
}

/// The rule of [`tessellation`].
pub(crate) fn tessellation_rule(shape: &ShapeEntry) -> String {
    let range = &shape.declaration.tessellation;
    format!(
        "the tessellation of a {} must be a whole number between {} and {}",
        shape.declaration.id,
        range.start(),
        range.end()
    )
}

/// A parameter in a material: the ranges that the reflection model and the shading model declare apply, and if neither
/// does, the range of some other that declares it.
pub fn material_parameter(registry: &Registry, models: [&str; 2], name: &str, value: &Value) -> Rule {
    // A legal value for another model needs no list of all declarations.
    if own(registry, models, name).next().is_none() && others(registry, name).any(|p| p.allows(value)) {
        return Ok(());
    }
    match Declared::of_models(registry, models, name).refusing(value) {
        Ok(()) => Ok(()),
        Err(Some(declared)) => declared.check(value),
        Err(None) => Err(unknown_material_parameter(registry, name)),
    }
}

/// The declarations of a name by a reflection model and a shading model.
fn own(
    registry: &Registry,
    [model, shading]: [&str; 2],
    name: &str,
) -> impl Iterator<Item = &'static Parameter> {
    let model = registry.model(model).and_then(|m| m.parameter(name));
    let shading = registry.shading_model(shading).and_then(|s| s.parameter(name));
    model.into_iter().chain(shading)
}

/// The declarations of a name by all models.
fn others(registry: &Registry, name: &str) -> impl Iterator<Item = &'static Parameter> {
    registry.material_users().flat_map(|(_, all)| all).filter(move |p| p.name == name)
}

/// The declarations against which a value in an object's material is checked.
#[derive(Clone, Debug)]
pub enum Declared {
    /// Declarations of the object's reflection model and shading model: both must allow the value.
    Own(Vec<&'static Parameter>),
    /// Declarations of others, since neither uses the name: one must allow the value. Empty for unknown
    /// names.
    Others(Vec<&'static Parameter>),
}

impl Declared {
    /// The declarations of a name for an object of a scene.
    #[must_use]
    pub fn of(registry: &Registry, scene: &Scene, object: &Object, name: &str) -> Self {
        Self::of_models(registry, [scene.model_of(object), scene.shading_model_of(object)], name)
    }

    /// The declarations of a name for objects with this reflection model and this shading model.
    #[must_use]
    pub fn of_models(registry: &Registry, models: [&str; 2], name: &str) -> Self {
        let own: Vec<_> = own(registry, models, name).collect();
        if !own.is_empty() {
            return Self::Own(own);
        }
        Self::Others(others(registry, name).collect())
    }

    /// All declarations.
    #[must_use]
    pub fn all(&self) -> &[&'static Parameter] {
        match self {
            Self::Own(all) | Self::Others(all) => all,
        }
    }

    /// Checks that the value is allowed.
    ///
    /// # Errors
    /// Returns the declaration whose rule the value breaks; `None` if there is none at all.
    pub fn refusing(&self, value: &Value) -> Result<(), Option<&'static Parameter>> {
        let refuses = |p: &&&'static Parameter| !p.allows(value);
        match self {
            Self::Own(all) => all.iter().find(refuses).map_or(Ok(()), |p| Err(Some(*p))),
            Self::Others(all) if all.iter().any(|p| p.allows(value)) => Ok(()),
            Self::Others(all) => Err(all.first().copied()),
        }
    }

    /// The value itself if it is allowed, or else the nearest allowed one; `None` if the type differs, or the
    /// ranges do not overlap.
    #[must_use]
    pub fn nearest(&self, value: &Value) -> Option<Value> {
        if self.refusing(value).is_ok() {
            return Some(value.clone());
        }
        match self {
            Self::Own(all) => {
                let brought = |value: Value, p: &&'static Parameter| {
                    if p.allows(&value) { Some(value) } else { p.nearest(&value) }
                };
                let nearest = all.iter().try_fold(value.clone(), brought)?;
                self.refusing(&nearest).is_ok().then_some(nearest)
            }
            Self::Others(all) => {
                let nearest = all.iter().filter_map(|p| p.nearest(value));
                let distance = |one: &Value| -> f64 {
                    one.numbers().iter().zip(value.numbers()).map(|(a, b)| (a - b).abs()).sum()
                };
                nearest.min_by(|a, b| distance(a).total_cmp(&distance(b)))
            }
        }
    }
}

/// The rule for a material parameter that no model declares, with a suggestion.
fn unknown_material_parameter(registry: &Registry, name: &str) -> String {
    let declared: Vec<_> = registry.material_parameters().collect();
    let also = declared.iter().flat_map(|p| [(p.label, p.name), (p.symbol, p.name)]);
    let known = declared.iter().map(|p| (p.name, p.name)).chain(also);
    format!("no model has a parameter of that name{}", did_you_mean(name, known))
}

/// The number of variants of a scene.
pub fn variant_count(count: usize) -> Rule {
    must(count <= MAX_VARIANTS, || {
        format!("a scene must have at most {MAX_VARIANTS} variants: with the scene itself, four views")
    })
}

/// The number of lights of a scene.
pub fn light_count(count: usize) -> Rule {
    must((1..=MAX_LIGHTS).contains(&count), || format!("a scene must have between 1 and {MAX_LIGHTS} lights"))
}

/// The number of objects of a scene.
pub fn object_count(count: usize) -> Rule {
    must((1..=MAX_OBJECTS).contains(&count), || {
        format!("a scene must have between 1 and {MAX_OBJECTS} objects")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_are_in_the_room_with_its_far_faces_but_not_its_near_ones() {
        let room = SceneSize { height: 1.0, width: 2.0, depth: 3.0 };
        assert_eq!(position(room, Vec3::new(2.0, 1.0, 3.0)), Ok(()));
        for outside in [
            Vec3::new(0.0, 0.5, 1.0),
            Vec3::new(2.1, 0.5, 1.0),
            Vec3::new(1.0, 1.5, 1.0),
            Vec3::new(1.0, 0.5, f32::INFINITY),
            Vec3::NAN,
        ] {
            assert!(position(room, outside).is_err(), "{outside}");
        }
    }
}
