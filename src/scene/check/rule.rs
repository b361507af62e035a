//! The rules for single fields. Each is a clause: "the diffuse coefficient must be between 0.5 and 1".

use glam::Vec3;

use crate::files::Shown as _;
use crate::{
    custom,
    light::MAX_LIGHTS,
    optics::{
        TermSelection,
        colour::Encoding,
        temperature::{MAX_TEMPERATURE, MIN_TEMPERATURE},
        tone::ToneMapping,
    },
    parameter::{Parameter, Value},
    registry::Registry,
    scene::{
        MAX_DIMENSION, MAX_OBJECTS, Object, Scene, SceneSize,
        comparison::{AMPLIFICATIONS, Channel, Compared, Edge, Layout, Sign},
        limits,
        variant::{LETTERS, MAX_VARIANTS},
    },
    shape::ShapeEntry,
    text::{self, detailed, did_you_mean},
};

/// The narrowest legal field of view, degrees.
pub const MIN_FIELD_OF_VIEW: f32 = 1.0;
/// The widest legal field of view, degrees.
pub const MAX_FIELD_OF_VIEW: f32 = 170.0;
/// The largest legal exposure, EV; the smallest is its negative.
pub const MAX_EXPOSURE: f32 = 16.0;

/// The largest legal size of an object, metres: a million kilometres. Far beyond, the squares of distances and of their
/// derivatives overflow on GPUs, and the two renderers could not agree on a picture.
pub const MAX_SIZE: f32 = 1e9;

/// `Ok`, or the rule that is broken.
pub type Rule = Result<(), String>;

/// `Ok` if the rule is kept.
fn must(kept: bool, rule: impl FnOnce() -> String) -> Rule {
    if kept { Ok(()) } else { Err(rule()) }
}

/// One extent of the room, in metres; `axis` is `height`, `width` or `depth`.
pub fn dimension(axis: &str, metres: f32) -> Rule {
    must(limits::dimension().allows(metres.into()), || {
        format!("the {axis} of the room must be greater than 0 and at most {MAX_DIMENSION} m")
    })
}

/// A position of a light, an object or the observer.
pub fn position(room: SceneSize, position: Vec3) -> Rule {
    must(room.contains(position), || {
        let SceneSize { width, height, depth } = room;
        format!(
            "a position must be inside the room: 0 < x ≤ {width} (width), 0 < y ≤ {height} (height), \
             0 < z ≤ {depth} (depth)"
        )
    })
}

/// A direction of a light or the observer. It need not have length 1.
pub fn direction(direction: Vec3) -> Rule {
    must(direction != Vec3::ZERO, || "a direction must not be zero".to_owned())?;
    must(direction.is_finite() && direction.try_normalize().is_some(), || {
        "this is too long or too short to be a direction; write it with a length near 1".to_owned()
    })
}

/// The intensity of a light.
pub fn intensity(value: f32) -> Rule {
    brightness("an intensity", value)
}

/// The luminous flux of a light, in lumen.
pub fn luminous_flux(value: f32) -> Rule {
    brightness("a luminous flux", value)
}

fn brightness(what: &str, value: f32) -> Rule {
    must(limits::brightness().allows(value.into()), || {
        if value == f32::INFINITY {
            format!("{what} must be at most 3.4e38")
        } else {
            format!("{what} must be at least 0")
        }
    })
}

/// The colour temperature of a light, in kelvin.
pub fn colour_temperature(kelvin: f32) -> Rule {
    must(limits::colour_temperature().allows(kelvin.into()), || {
        format!("a colour temperature must be between {MIN_TEMPERATURE} and {MAX_TEMPERATURE} K")
    })
}

/// The vertical field of view of the observer, in degrees.
pub fn field_of_view(degrees: f32) -> Rule {
    must(limits::field_of_view().allows(degrees.into()), || {
        format!("the field of view must be between {MIN_FIELD_OF_VIEW} and {MAX_FIELD_OF_VIEW} degrees")
    })
}

/// The largest extent of an object, in metres.
pub fn size(metres: f32) -> Rule {
    must(limits::any_size().allows(metres.into()), || {
        if metres > MAX_SIZE {
            format!("a size must be at most {MAX_SIZE:e} m")
        } else {
            "a size must be greater than 0".to_owned()
        }
    })
}

/// Euler angles in degrees.
pub fn rotation(degrees: Vec3) -> Rule {
    must(degrees.is_finite(), || "a rotation must be three finite numbers of degrees".to_owned())
}

/// The tessellation of an object of a type.
pub fn tessellation(shape: &ShapeEntry, count: u32) -> Rule {
    must(limits::tessellation(shape.declaration).allows(count.into()), || tessellation_rule(shape))
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

/// The exposure of the display, in EV.
pub fn exposure(ev: f32) -> Rule {
    must(limits::exposure().allows(ev.into()), || {
        format!("the exposure must be between -{MAX_EXPOSURE} and {MAX_EXPOSURE} EV")
    })
}

/// The value of a declared parameter of a model, a light or an object type.
pub fn parameter(parameter: &Parameter, value: &Value) -> Rule {
    parameter.check(value)
}

/// A parameter in the material of an object: the ranges that its reflection model and its shading model declare apply,
/// and if neither does, the range of some other that declares it.
pub fn material_parameter(
    registry: &Registry,
    scene: &Scene,
    object: &Object,
    name: &str,
    value: &Value,
) -> Rule {
    match Declared::of(registry, scene, object, name).refusing(value) {
        Ok(()) => Ok(()),
        Err(Some(declared)) => parameter(declared, value),
        Err(None) => Err(unknown_material_parameter(registry, name)),
    }
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
        let model = registry.model(scene.model_of(object)).and_then(|m| m.parameter(name));
        let shading = registry.shading_model(scene.shading_model_of(object)).and_then(|s| s.parameter(name));
        let own: Vec<_> = model.into_iter().chain(shading).collect();
        if !own.is_empty() {
            return Self::Own(own);
        }
        Self::Others(registry.material_users().flat_map(|(_, all)| all).filter(|p| p.name == name).collect())
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
                nearest.min_by(|a, b| a.distance(value).total_cmp(&b.distance(value)))
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

/// The id of a reflection model.
pub fn reflection_model(registry: &Registry, id: &str) -> Rule {
    let known = registry.models().iter().map(|m| (m.declaration.id, m.declaration.name));
    one_of("the reflection model", id, known).map_err(|rule| match registry.broken_model(id) {
        Some(why) => format!("the file of that custom model has an error: {why}"),
        None => match custom_model_missing(registry, id) {
            Some(detail) => detailed(&rule, &detail),
            None => rule,
        },
    })
}

/// Details about an id without a model in the folder of custom models: its file may be missing, or not be a
/// model.
fn custom_model_missing(registry: &Registry, id: &str) -> Option<String> {
    let folder = registry.custom_folder().filter(|folder| folder.is_dir() && custom::is_id(id))?;
    let file = folder.join(id).with_extension(custom::EXTENSION);
    let file_shown = file.shown();
    Some(if file.is_file() {
        format!(
            "{file_shown} is no model: it neither begins with a comment /* lcm … */ nor defines fn response"
        )
    } else {
        format!("the folder of custom models has no {file_shown}")
    })
}

/// The id of a shading model.
pub fn shading_model(registry: &Registry, id: &str) -> Rule {
    let known = registry.shading_models().iter().map(|m| (m.declaration.id, m.declaration.name));
    one_of("the shading model", id, known)
}

/// The id of a light type.
pub fn light_type(registry: &Registry, id: &str) -> Rule {
    one_of("the light type", id, registry.lights().iter().map(|l| (l.declaration.id, l.declaration.name)))
}

/// The id of an object type.
pub fn object_type(registry: &Registry, id: &str) -> Rule {
    one_of("the object type", id, registry.shapes().iter().map(|s| (s.declaration.id, s.declaration.name)))
}

/// The id of a tone mapping.
pub fn tone_mapping(id: &str) -> Rule {
    one_of("the tone mapping", id, ToneMapping::ALL.into_iter().map(|t| (t.id(), t.name())))
}

/// The id of an encoding.
pub fn encoding(id: &str) -> Rule {
    one_of("the encoding", id, Encoding::ALL.into_iter().map(|e| (e.id(), e.id())))
}

/// The id of a selection of terms.
pub fn terms(id: &str) -> Rule {
    one_of("the terms", id, TermSelection::ALL.into_iter().map(|t| (t.id(), t.id())))
}

/// The id of a layout.
pub fn layout(id: &str) -> Rule {
    one_of("the layout", id, Layout::ALL.iter().map(|c| (c.id(), c.name())))
}

/// The id of the direction of a wipe's edge.
pub fn edge(id: &str) -> Rule {
    one_of("the edge of a wipe", id, Edge::ALL.iter().map(|c| (c.id(), c.name())))
}

/// The id of the sign of differences.
pub fn sign(id: &str) -> Rule {
    one_of("the sign of a difference", id, Sign::ALL.iter().map(|c| (c.id(), c.name())))
}

/// The id of the channel of differences.
pub fn channel(id: &str) -> Rule {
    one_of("the channel of a difference", id, Channel::ALL.iter().map(|c| (c.id(), c.name())))
}

/// The id of the kind of values that are compared.
pub fn compared(id: &str) -> Rule {
    one_of("the values of a difference", id, Compared::ALL.iter().map(|c| (c.id(), c.name())))
}

/// The letter of a view other than A.
pub fn view_letter(letter: &str) -> Rule {
    one_of("the other view", letter, LETTERS[1..].iter().map(|l| (*l, *l)))
}

/// The position of the edge of a wipe.
pub fn split(place: f32) -> Rule {
    must((0.0..=1.0).contains(&place), || "the place of the edge must be between 0 and 1".to_owned())
}

/// The amplification of a difference.
pub fn amplification(factor: f32) -> Rule {
    must(AMPLIFICATIONS.contains(&factor), || {
        format!("the amplification must be between {} and {}", AMPLIFICATIONS.start(), AMPLIFICATIONS.end())
    })
}

/// The rule for the tessellation of a variant.
pub const ANY_TESSELLATION: &str = "the tessellation of a variant must be a whole number of at least 1";

/// The tessellation of a variant, which each object follows as far as its type allows.
pub fn any_tessellation(count: u32) -> Rule {
    must(count > 0, || ANY_TESSELLATION.to_owned())
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

/// One of several ids: the rule lists them and names the nearest.
fn one_of<'a>(what: &str, id: &str, known: impl Iterator<Item = (&'a str, &'a str)> + Clone) -> Rule {
    must(known.clone().any(|(k, _)| k == id), || {
        let names = known.clone().map(|(k, name)| (name, k));
        let candidates = known.clone().map(|(k, _)| (k, k)).chain(names);
        text::one_of(what, known.clone().map(|(k, _)| k)) + &did_you_mean(id, candidates)
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

    #[test]
    fn extreme_directions_are_refused_because_they_cannot_be_normalised() {
        assert_eq!(direction(Vec3::new(0.0, -3.0, 0.0)), Ok(()));
        for d in [Vec3::splat(1e-30), Vec3::splat(1e30), Vec3::splat(f32::INFINITY), Vec3::NAN] {
            assert!(direction(d).is_err_and(|rule| rule.contains("too long or too short")), "{d}");
        }
    }
}
