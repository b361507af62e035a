//! The scene: a value, usually read from JSON.
//!
//! [`Scene`] is the basis of everything else: [`load`] reads it, and knows what may be missing; a document changes it;
//! both renderers draw it. Angles are degrees, lengths metres, colours
//! sRGB-encoded integers: the values as written by users.

use crate::{
    light::{Emitter, Incident, LightEntry, LightRecord},
    optics::{
        colour::{Encoding, srgb_encode},
        temperature,
        tone::ToneMapping,
    },
    parameter::{NamedFile, Value, Values},
    registry::{LightSet, Registry},
    shape::ShapeEntry,
};
use std::collections::BTreeSet;

use glam::Vec3;

mod beyond_room;
pub mod check;
pub mod comparison;
pub(crate) mod encoding;
pub mod error;
pub mod examples;
mod format;
pub mod formats;
mod kept;
mod layout;
pub mod limits;
pub mod load;
pub mod observer;
mod read;
pub mod rotation;
pub mod save;
pub mod schema;
mod serialise;
pub(crate) mod syntax;
pub mod variant;

pub use comparison::Comparison;
pub use serialise::{SceneIn, SceneOf};
pub use variant::Variant;

/// The largest legal extent of a scene in any direction, metres (CA `MAX_HEIGHT`, `MAX_WIDTH`, `MAX_DEPTH`).
pub const MAX_DIMENSION: f32 = 100.0;
/// The default extent in every direction, metres (CA `DEF_HEIGHT`, `DEF_WIDTH`, `DEF_DEPTH`).
pub const DEFAULT_DIMENSION: f32 = 10.0;
/// The reflection model offered if a scene names none (CA `DEF_LIGHT`).
pub const DEFAULT_REFLECTION_MODEL: &str = "lambert";
/// The shading model offered if a scene names none (CA `DEF_SHADE`).
pub const DEFAULT_SHADING_MODEL: &str = "gouraud";
/// Maximum number of objects in a scene.
pub const MAX_OBJECTS: usize = 10_000;
/// The object size if a scene gives none, metres.
pub const DEFAULT_SIZE: f32 = 2.0;
/// The vertical field of view if a scene gives none, degrees.
pub const DEFAULT_FIELD_OF_VIEW: f32 = 45.0;

/// A scene, valid or not: [`check`] checks it.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// The name, for lists and window titles.
    pub name: Option<String>,
    /// A one-line description of the scene.
    pub description: Option<String>,
    /// The room.
    pub scene_size: SceneSize,
    /// Id of the reflection model of every object without an override.
    pub reflection_model: String,
    /// Id of the shading model of every object without an override.
    pub shading_model: String,
    /// The lights, 1 to 256.
    pub lights: Vec<Light>,
    /// The observer.
    pub observer: Observer,
    /// The objects, 1 to 10 000.
    pub objects: Vec<Object>,
    /// Conversion of light to the picture on the display.
    pub display: Display,
    /// The scene with some things changed, to be compared with it: up to [`MAX_VARIANTS`](variant::MAX_VARIANTS).
    pub variants: Vec<Variant>,
    /// The way in which the views are compared.
    pub comparison: Comparison,
}

/// The extent of the room in metres; one corner is the origin. Right-handed, y up: `width` bounds x,
/// `height` bounds y, `depth` bounds z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SceneSize {
    /// The limit of y.
    pub height: f32,
    /// The limit of x.
    pub width: f32,
    /// The limit of z.
    pub depth: f32,
}

impl SceneSize {
    /// The corner opposite the origin.
    #[must_use]
    pub fn corner(self) -> Vec3 {
        Vec3::new(self.width, self.height, self.depth)
    }

    /// True if a point is in the room: 0 < coordinate ≤ size in each direction.
    #[must_use]
    pub fn contains(self, p: Vec3) -> bool {
        p.cmpgt(Vec3::ZERO).all() && p.cmple(self.corner()).all()
    }

    /// The point of the room nearest to this one, at least a centimetre from the walls at 0, which are not
    /// part of the room.
    #[must_use]
    pub fn nearest(self, p: Vec3) -> Vec3 {
        let corner = self.corner();
        p.max(corner.min(Vec3::splat(0.01))).min(corner)
    }
}

impl Default for SceneSize {
    fn default() -> Self {
        Self { height: DEFAULT_DIMENSION, width: DEFAULT_DIMENSION, depth: DEFAULT_DIMENSION }
    }
}

/// A light.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    /// Id of the light type.
    pub light_type: String,
    /// Name given by the user.
    pub name: Option<String>,
    /// False while switched off.
    pub enabled: bool,
    /// Position; `None` for types without one.
    pub position: Option<Vec3>,
    /// Direction, not normalised; `None` for types without one.
    pub direction: Option<Vec3>,
    /// The colour, unless [`colour_temperature`](Self::colour_temperature) is given.
    pub colour: [u8; 3],
    /// Colour temperature in kelvin, instead of the colour.
    pub colour_temperature: Option<f32>,
    /// The intensity in the unit of the type, unless [`luminous_flux`](Self::luminous_flux) is given.
    pub intensity: f32,
    /// Luminous flux in lumen, instead of the intensity; `None` for types without a flux.
    pub luminous_flux: Option<f32>,
    /// Further parameters declared by the type; absent ones have their defaults.
    pub parameters: Values,
}

/// The observer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Observer {
    /// Position of the eye.
    pub position: Vec3,
    /// Direction of view, not normalised.
    pub direction: Vec3,
    /// Vertical field of view in degrees.
    pub field_of_view: f32,
}

/// An object.
#[derive(Clone, Debug, PartialEq)]
pub struct Object {
    /// Id of the object type.
    pub object_type: String,
    /// Parameters declared by the type; absent ones have their defaults.
    pub shape: Values,
    /// Name given by the user.
    pub name: Option<String>,
    /// False while hidden.
    pub visible: bool,
    /// Position of the centre.
    pub position: Vec3,
    /// Largest extent in metres.
    pub size: f32,
    /// Euler angles XYZ in degrees (extrinsic order: about x first, then y, then z of the room).
    pub rotation: Vec3,
    /// Tessellation; `None` for the type's default.
    pub tessellation: Option<u32>,
    /// Id of the reflection model that overrides the scene's, if any.
    pub reflection_model: Option<String>,
    /// Id of the shading model that overrides the scene's, if any.
    pub shading_model: Option<String>,
    /// Parameters by name, of the object's model and of any other.
    pub material: Values,
}

/// Conversion of light to the picture on the display.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Display {
    /// The curve from light to display.
    pub tone_mapping: ToneMapping,
    /// Exposure in EV: the picture is multiplied by `2^EV`.
    pub exposure: f32,
    /// Decoding and encoding of colours.
    pub encoding: Encoding,
}

impl Default for Light {
    /// A white point light of 20 cd near the upper right front corner of the default room.
    fn default() -> Self {
        Self {
            light_type: "point".to_owned(),
            name: None,
            enabled: true,
            position: Some(Vec3::new(7.5, 8.0, 9.0)),
            direction: None,
            colour: [255; 3],
            colour_temperature: None,
            intensity: 20.0,
            luminous_flux: None,
            parameters: Values::default(),
        }
    }
}

impl Light {
    /// The intensity in the unit of the light's type, whether given as intensity or as flux.
    #[must_use]
    pub fn intensity_as(&self, entry: &LightEntry) -> f32 {
        match self.luminous_flux.zip(entry.solid_angle(&self.parameters)) {
            // A cone may be so narrow that the quotient is not finite in 32 bits.
            Some((flux, solid_angle)) => ((f64::from(flux) / solid_angle) as f32).min(f32::MAX),
            None => self.intensity,
        }
    }

    /// The colour for calculation, whether given as a colour or as a temperature.
    ///
    /// A colour takes away from white light, as a filter does. A temperature keeps the luminance of white.
    #[must_use]
    pub fn colour_under(&self, encoding: Encoding) -> Vec3 {
        let Some(kelvin) = self.colour_temperature else { return encoding.decode(self.colour) };
        let colour = temperature::black_body(kelvin);
        temperature::light_of(match encoding {
            Encoding::Srgb => colour,
            // Gamma-naive: the numbers of a colour picker are used unchanged.
            Encoding::Off => colour.map(srgb_encode),
        })
    }

    /// The colour in sRGB, whether given as a colour or as a temperature.
    #[must_use]
    pub fn rgb8(&self) -> [u8; 3] {
        self.colour_temperature.map_or(self.colour, temperature::black_body_rgb8)
    }

    /// Changes the type: position, direction and parameters are added or removed as the new type requires.
    /// Intensity or luminous flux is kept, unless the new type has another unit.
    pub fn set_type(&mut self, to: &LightEntry, registry: &Registry, room: SceneSize) {
        let new = to.declaration;
        let flux = self.luminous_flux.filter(|_| to.has_flux());
        self.intensity = match registry.light(&self.light_type) {
            Some(old) if flux.is_none() && old.declaration.unit == new.unit => self.intensity_as(old),
            // 20 cd and 20 lx are very different: a new unit starts from its default.
            _ => new.default_intensity,
        };
        self.luminous_flux = flux;
        let centre = Vec3::new(room.width / 2.0, room.height * 0.8, room.depth / 2.0);
        self.position = new.has_position.then(|| self.position.unwrap_or(centre));
        self.direction = new.has_direction.then(|| self.direction.unwrap_or(Vec3::NEG_Y));
        self.parameters = self.parameters.legal(to.parameters);
        new.id.clone_into(&mut self.light_type);
    }
}

impl Object {
    /// Changes the type. Parameters of both types are kept, but not the tessellation, which has a different
    /// meaning for each type.
    pub fn set_type(&mut self, to: &ShapeEntry) {
        self.shape = self.shape.legal(to.parameters);
        self.tessellation = None;
        to.declaration.id.clone_into(&mut self.object_type);
    }
}

impl Default for Observer {
    /// An observer in the middle of the front of the default room, looking at its centre.
    fn default() -> Self {
        Self {
            position: Vec3::new(5.0, 5.0, 9.5),
            direction: Vec3::NEG_Z,
            field_of_view: DEFAULT_FIELD_OF_VIEW,
        }
    }
}

impl Default for Object {
    /// A sphere of default material in the centre of the default room.
    fn default() -> Self {
        Self {
            object_type: "sphere".to_owned(),
            shape: Values::default(),
            name: None,
            visible: true,
            position: Vec3::splat(5.0),
            size: DEFAULT_SIZE,
            rotation: Vec3::ZERO,
            tessellation: None,
            reflection_model: None,
            shading_model: None,
            material: Values::default(),
        }
    }
}

impl Default for Scene {
    /// The default scene: 10×10×10, one white point light, one sphere of default material,
    /// Gouraud shading, Lambertian reflection.
    fn default() -> Self {
        Self {
            name: Some("Default scene".to_owned()),
            description: Some("One white point light, one matte sphere: the scene to start from.".to_owned()),
            scene_size: SceneSize::default(),
            reflection_model: DEFAULT_REFLECTION_MODEL.to_owned(),
            shading_model: DEFAULT_SHADING_MODEL.to_owned(),
            lights: vec![Light::default()],
            observer: Observer::default(),
            objects: vec![Object::default()],
            display: Display::default(),
            variants: Vec::new(),
            comparison: Comparison::default(),
        }
    }
}

impl Scene {
    /// The ids of the reflection models named by the scene and its variants, each once.
    #[must_use]
    pub fn models(&self) -> BTreeSet<&str> {
        let own = self.objects.iter().filter_map(|o| o.reflection_model.as_deref());
        let of_variants = self.variants.iter().filter_map(|v| v.reflection_model.as_deref());
        own.chain(of_variants).chain([self.reflection_model.as_str()]).collect()
    }

    /// The active lights.
    pub fn shining(&self) -> impl Iterator<Item = &Light> {
        self.lights.iter().filter(|light| light.enabled)
    }

    /// The light types of all lights, including those switched off: the light types in the scene's shader.
    #[must_use]
    pub fn light_types(&self, registry: &Registry) -> LightSet {
        registry.light_set(self.lights.iter().map(|light| light.light_type.as_str()))
    }

    /// The files named by lights and objects, with repetitions.
    pub fn files(&self) -> impl Iterator<Item = &NamedFile> {
        let of_lights = self.lights.iter().map(|light| &light.parameters);
        let values = of_lights.chain(self.objects.iter().map(|object| &object.shape));
        values.flat_map(|values| values.0.values()).filter_map(|value| match value {
            Value::File(file) => Some(file),
            _ => None,
        })
    }

    /// The visible objects.
    pub fn shown(&self) -> impl Iterator<Item = &Object> {
        self.objects.iter().filter(|object| object.visible)
    }

    /// The reflection model of an object: its override, or the scene's.
    #[must_use]
    pub fn model_of<'a>(&'a self, object: &'a Object) -> &'a str {
        object.reflection_model.as_deref().unwrap_or(&self.reflection_model)
    }

    /// The shading model of an object: its override, or the scene's.
    #[must_use]
    pub fn shading_model_of<'a>(&'a self, object: &'a Object) -> &'a str {
        object.shading_model.as_deref().unwrap_or(&self.shading_model)
    }
}

/// A light of the scene for calculation, without its type's parameters. A light of an unknown type is dark.
#[must_use]
pub fn record(light: &Light, registry: &Registry, encoding: Encoding) -> LightRecord {
    let Some(entry) = registry.light(&light.light_type) else {
        return LightRecord { light_type: u32::MAX, ..LightRecord::default() };
    };
    LightRecord {
        light_type: entry.index,
        position: light.position.unwrap_or(Vec3::ZERO),
        direction: light.direction.unwrap_or(Vec3::ZERO).normalize_or_zero(),
        colour: light.colour_under(encoding),
        intensity: light.intensity_as(entry),
    }
}

/// A light of the scene for calculation: its type, the type with its parameters, and the rest. `None` if its
/// type is unknown.
#[must_use]
pub fn emitter<'a>(
    light: &Light,
    registry: &'a Registry,
    encoding: Encoding,
) -> Option<(&'a LightEntry, Box<dyn Emitter>, LightRecord)> {
    let entry = registry.light(&light.light_type)?;
    Some((entry, (entry.instantiate)(&light.parameters, encoding), record(light, registry, encoding)))
}

/// True if any active light has extent, so that lights are sampled.
#[must_use]
pub fn has_extent<'a>(shining: impl IntoIterator<Item = &'a Light>, registry: &Registry) -> bool {
    shining
        .into_iter()
        .any(|light| registry.light(&light.light_type).is_some_and(|entry| entry.declaration.extent))
}

/// True if any active light is uniform, so that albedos are needed.
#[must_use]
pub fn shines_from_everywhere<'a>(
    shining: impl IntoIterator<Item = &'a Light>,
    encoding: Encoding,
    registry: &Registry,
) -> bool {
    shining
        .into_iter()
        .filter_map(|light| emitter(light, registry, encoding))
        .any(|(_, emitter, record)| matches!(emitter.incident(&record, Vec3::ZERO), Incident::Uniform { .. }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unknown_light_types_give_no_light_and_no_panic() {
        let light = Light { light_type: "laser".to_owned(), ..Light::default() };
        assert_eq!(record(&light, &Registry::builtin(), Encoding::Srgb).light_type, u32::MAX);
    }

    #[test]
    fn changing_the_type_of_an_object_keeps_the_scene_valid() {
        let registry = Registry::builtin();
        let mut s = Scene::default();
        for from in registry.shapes() {
            for to in registry.shapes() {
                let object = &mut s.objects[0];
                object.set_type(from);
                object.tessellation = Some(*from.declaration.tessellation.end());
                for p in from.parameters {
                    object.shape.set(p.name, p.default_value());
                }
                let before = object.shape.clone();
                object.set_type(to);
                let same = from.declaration.id == to.declaration.id;
                assert!(!same || s.objects[0].shape == before);
                assert_eq!(check::scene(&s, &registry), []);
            }
        }
    }

    #[test]
    fn changing_the_type_of_a_light_keeps_the_scene_valid() {
        let registry = Registry::builtin();
        let mut s = Scene::default();
        for from in registry.lights() {
            for to in registry.lights() {
                s.lights[0].set_type(from, &registry, s.scene_size);
                for p in from.parameters {
                    s.lights[0].parameters.set(p.name, p.default_value());
                }
                s.lights[0].set_type(to, &registry, s.scene_size);
                assert_eq!(check::scene(&s, &registry), []);
            }
        }
    }
}
