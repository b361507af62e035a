//! The scene file as types: what the writer writes and what [`schema`](super::schema) describes.
//!
//! The fields stand in the order in which they are written: that of the CA. Documentation comments
//! here are what editors show while a scene file is edited.

use schemars::JsonSchema;
use serde::{Serialize, Serializer};

use super::{Display, Light, Object, Observer, Scene, SceneSize};
use crate::{
    parameter::{Parameter, Value, Values},
    registry::Registry,
};

/// A scene of *Lights, Camera, Models!*: a room with lights, objects and one observer.
#[derive(Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(title = "Scene of Lights, Camera, Models!")]
pub(super) struct SceneFile<'a> {
    /// Where the JSON Schema of scene files is, so that editors complete and check this file.
    #[serde(rename = "$schema", skip_serializing_if = "Option::is_none")]
    schema: Option<&'a str>,
    /// What the scene is called.
    #[serde(skip_serializing_if = "Option::is_none")]
    name: Option<&'a str>,
    /// One line: what the scene shows.
    #[serde(skip_serializing_if = "Option::is_none")]
    description: Option<&'a str>,
    /// The extent of the room in metres. One corner is the origin; x goes right, y up, z to the front.
    scene_size: SizeFile,
    /// How light leaves the surface of every object that names no model itself.
    reflection_model: &'a str,
    /// Where the reflection model is calculated, for every object that names no shading model itself.
    shading_model: &'a str,
    /// The lights, 1 to 256.
    lights: Vec<LightFile<'a>>,
    /// The eye.
    observer: ObserverFile,
    /// The objects, 1 to 10 000.
    objects: Vec<ObjectFile<'a>>,
    /// How the light in the picture is shown.
    #[serde(skip_serializing_if = "Option::is_none")]
    display: Option<DisplayFile>,
}

/// The extent of the room in metres.
#[derive(Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct SizeFile {
    /// Bounds y, metres.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 100, "default" = 10))]
    height: f32,
    /// Bounds x, metres.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 100, "default" = 10))]
    width: f32,
    /// Bounds z, metres.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 100, "default" = 10))]
    depth: f32,
}

/// A light.
#[derive(Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct LightFile<'a> {
    /// The light type.
    #[serde(rename = "type")]
    light_type: &'a str,
    /// What you call it.
    #[serde(skip_serializing_if = "Option::is_none")]
    name: Option<&'a str>,
    /// False switches it off.
    #[schemars(extend("default" = true))]
    #[serde(skip_serializing_if = "Option::is_none")]
    enabled: Option<bool>,
    /// Where it stands: [x, y, z] in metres, inside the room, not where the observer or an object is.
    #[serde(skip_serializing_if = "Option::is_none")]
    position: Option<[f32; 3]>,
    /// Where it shines: [x, y, z], of any length.
    #[serde(skip_serializing_if = "Option::is_none")]
    direction: Option<[f32; 3]>,
    /// Its colour: [red, green, blue], whole numbers from 0 to 255, sRGB. Not beside `colour_temperature`.
    #[schemars(extend("default" = [255, 255, 255]))]
    #[serde(skip_serializing_if = "Option::is_none")]
    colour: Option<[u8; 3]>,
    /// Its colour as that of a black body of this temperature, kelvin: a candle has 1900, a light bulb
    /// 2700, white is 6500. Not beside `colour`. How bright the light is does not change.
    #[schemars(range(min = 1000, max = 40000))]
    #[serde(skip_serializing_if = "Option::is_none")]
    colour_temperature: Option<f32>,
    /// How bright it is: candela for lights with a position, lux for the others. Not beside
    /// `luminous_flux`.
    #[schemars(range(min = 0))]
    #[serde(skip_serializing_if = "Option::is_none")]
    intensity: Option<f32>,
    /// How much light it sends out in all directions together, lumen, as printed on light bulbs. Not
    /// beside `intensity`.
    #[schemars(range(min = 0))]
    #[serde(skip_serializing_if = "Option::is_none")]
    luminous_flux: Option<f32>,
    #[serde(flatten)]
    #[schemars(skip)]
    parameters: Ordered<'a>,
}

/// The eye.
#[derive(Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct ObserverFile {
    /// Where the eye is: [x, y, z] in metres, inside the room, not where a light or an object is.
    position: [f32; 3],
    /// Where it looks: [x, y, z], of any length.
    direction: [f32; 3],
    /// The vertical field of view, degrees.
    #[schemars(range(min = 1, max = 170), extend("default" = 45))]
    #[serde(skip_serializing_if = "Option::is_none")]
    field_of_view: Option<f32>,
}

/// An object.
#[derive(Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct ObjectFile<'a> {
    /// The object type.
    #[serde(rename = "type")]
    object_type: &'a str,
    /// What you call it.
    #[serde(skip_serializing_if = "Option::is_none")]
    name: Option<&'a str>,
    /// False hides it.
    #[schemars(extend("default" = true))]
    #[serde(skip_serializing_if = "Option::is_none")]
    visible: Option<bool>,
    /// Where its centre is: [x, y, z] in metres, inside the room, not where a light or the observer is.
    position: [f32; 3],
    /// Its largest extent, metres.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 1_000_000_000, "default" = 2))]
    #[serde(skip_serializing_if = "Option::is_none")]
    size: Option<f32>,
    /// How it is turned: degrees about x, then y, then z.
    #[schemars(extend("default" = [0, 0, 0]))]
    #[serde(skip_serializing_if = "Option::is_none")]
    rotation: Option<[f32; 3]>,
    /// How finely it is cut into polygons.
    #[serde(skip_serializing_if = "Option::is_none")]
    tessellation: Option<u32>,
    /// Its own reflection model instead of the scene's.
    #[serde(skip_serializing_if = "Option::is_none")]
    reflection_model: Option<&'a str>,
    /// Its own shading model instead of the scene's.
    #[serde(skip_serializing_if = "Option::is_none")]
    shading_model: Option<&'a str>,
    /// The parameters of the reflection model, by name. One material serves every model: what the
    /// current model does not use is kept for the others.
    #[schemars(with = "Option<serde_json::Map<String, serde_json::Value>>")]
    #[serde(skip_serializing_if = "Ordered::is_empty")]
    material: Ordered<'a>,
}

/// How the light in the picture is shown.
#[derive(Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct DisplayFile {
    /// The curve from light to display.
    #[schemars(extend("default" = "none"))]
    #[serde(skip_serializing_if = "Option::is_none")]
    tone_mapping: Option<&'static str>,
    /// Exposure in EV: each step up doubles the light.
    #[schemars(range(min = -16, max = 16), extend("default" = 0))]
    #[serde(skip_serializing_if = "Option::is_none")]
    exposure: Option<f32>,
    /// `srgb`: colours are decoded before and encoded after the calculation. `off`: neither, which is
    /// wrong on purpose, to see the difference.
    #[schemars(extend("default" = "srgb"))]
    #[serde(skip_serializing_if = "Option::is_none")]
    encoding: Option<&'static str>,
}

/// Parameters in the order in which they are declared.
struct Ordered<'a>(Vec<(&'a str, &'a Value)>);

impl<'a> Ordered<'a> {
    /// The values in the order of the declarations; what is not declared stands last.
    fn new(values: &'a Values, declared: impl Iterator<Item = &'static Parameter>) -> Self {
        let mut ordered = Vec::with_capacity(values.0.len());
        for p in declared {
            if let Some(value) = values.0.get(p.name) {
                ordered.push((p.name, value));
            }
        }
        if ordered.len() < values.0.len() {
            for (name, value) in &values.0 {
                if !ordered.iter().any(|(n, _)| n == name) {
                    ordered.push((name, value));
                }
            }
        }
        Self(ordered)
    }

    fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

impl Serialize for Ordered<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().copied())
    }
}

impl<'a> SceneFile<'a> {
    /// The file of a scene. Fields that a scene always has are always written; those that are absent
    /// or as the default is, are not.
    pub(super) fn new(scene: &'a Scene, schema: Option<&'a str>, registry: &Registry) -> Self {
        let SceneSize { height, width, depth } = scene.scene_size;
        let declared: Vec<_> = registry.material_parameters().collect();
        Self {
            schema,
            name: scene.name.as_deref(),
            description: scene.description.as_deref(),
            scene_size: SizeFile { height, width, depth },
            reflection_model: &scene.reflection_model,
            shading_model: &scene.shading_model,
            lights: scene.lights.iter().map(|l| LightFile::new(l, registry)).collect(),
            observer: ObserverFile::new(&scene.observer),
            objects: scene.objects.iter().map(|o| ObjectFile::new(o, &declared)).collect(),
            display: (scene.display != Display::default()).then(|| DisplayFile::new(&scene.display)),
        }
    }
}

impl<'a> LightFile<'a> {
    fn new(light: &'a Light, registry: &Registry) -> Self {
        let declared = registry.light(&light.light_type).map_or(&[][..], |l| l.declaration.parameters);
        Self {
            light_type: &light.light_type,
            name: light.name.as_deref(),
            enabled: (!light.enabled).then_some(false),
            position: light.position.map(Into::into),
            direction: light.direction.map(Into::into),
            colour: light.colour_temperature.is_none().then_some(light.colour),
            colour_temperature: light.colour_temperature,
            intensity: light.luminous_flux.is_none().then_some(light.intensity),
            luminous_flux: light.luminous_flux,
            parameters: Ordered::new(&light.parameters, declared.iter()),
        }
    }
}

impl ObserverFile {
    fn new(observer: &Observer) -> Self {
        Self {
            position: observer.position.into(),
            direction: observer.direction.into(),
            field_of_view: Some(observer.field_of_view),
        }
    }
}

impl<'a> ObjectFile<'a> {
    fn new(object: &'a Object, declared: &[&'static Parameter]) -> Self {
        Self {
            object_type: &object.object_type,
            name: object.name.as_deref(),
            visible: (!object.visible).then_some(false),
            position: object.position.into(),
            size: Some(object.size),
            rotation: (object.rotation != glam::Vec3::ZERO).then(|| object.rotation.into()),
            tessellation: object.tessellation,
            reflection_model: object.reflection_model.as_deref(),
            shading_model: object.shading_model.as_deref(),
            material: Ordered::new(&object.material, declared.iter().copied()),
        }
    }
}

impl DisplayFile {
    fn new(display: &Display) -> Self {
        Self {
            tone_mapping: Some(display.tone_mapping.id()),
            exposure: Some(display.exposure),
            encoding: Some(display.encoding.id()),
        }
    }
}
