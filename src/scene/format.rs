//! The scene file as types: written by the writer and described by [`schema`](super::schema).
//!
//! The fields are in the order of writing: that of the CA. The documentation comments here are shown by editors of
//! scene files.

use schemars::JsonSchema;
use serde::{Serialize, Serializer};

use super::{
    Comparison, Display, Light, Object, Observer, Scene, SceneSize, Variant,
    comparison::{Channel, Compared, Edge, Layout, Sign},
    variant::LETTERS,
};
use crate::{
    optics::{TermSelection, colour::Encoding, tone::ToneMapping},
    parameter::{Parameter, Value, Values},
    registry::Registry,
};

/// A scene of *Lights, Camera, Models!*: a room with lights, objects and one observer.
#[derive(Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(title = "Scene of Lights, Camera, Models!")]
pub(super) struct SceneFile<'a> {
    /// Address of the JSON Schema of scene files, with which editors complete and check this file.
    #[serde(rename = "$schema", skip_serializing_if = "Option::is_none")]
    schema: Option<&'a str>,
    /// Name of the scene.
    #[serde(skip_serializing_if = "Option::is_none")]
    name: Option<&'a str>,
    /// Description of the scene, one line.
    #[serde(skip_serializing_if = "Option::is_none")]
    description: Option<&'a str>,
    /// Extent of the room in metres. One corner is the origin; x points right, y up, z to the front.
    scene_size: SizeFile,
    /// Reflection model: the equation for how light leaves a surface. For every object without an override.
    reflection_model: &'a str,
    /// Shading model: where on the surface the reflection model is evaluated. For every object without an override.
    shading_model: &'a str,
    /// The lights, 1 to 256.
    lights: Vec<LightFile<'a>>,
    /// Observer: the camera of the scene.
    observer: ObserverFile,
    /// The objects, 1 to 10 000.
    objects: Vec<ObjectFile<'a>>,
    /// Conversion of light to the picture on the display.
    #[serde(skip_serializing_if = "Option::is_none")]
    display: Option<DisplayFile>,
    /// Variants: the scene with some things changed, to be compared with it. The scene is view A; these are B, C and D.
    #[schemars(with = "Option<Vec<VariantFile>>", length(max = 3))]
    #[serde(skip_serializing_if = "Vec::is_empty")]
    variants: Vec<VariantFile<'a>>,
    /// Comparison: the way in which the views are shown.
    #[serde(skip_serializing_if = "Option::is_none")]
    comparison: Option<ComparisonFile>,
}

/// Extent of the room in metres.
#[derive(Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct SizeFile {
    /// Limit of y, metres.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 100, "default" = 10))]
    height: f32,
    /// Limit of x, metres.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 100, "default" = 10))]
    width: f32,
    /// Limit of z, metres.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 100, "default" = 10))]
    depth: f32,
}

/// A light.
#[derive(Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct LightFile<'a> {
    /// Light type.
    #[serde(rename = "type")]
    light_type: &'a str,
    /// Name of the light.
    #[serde(skip_serializing_if = "Option::is_none")]
    name: Option<&'a str>,
    /// False if switched off.
    #[schemars(extend("default" = true))]
    #[serde(skip_serializing_if = "Option::is_none")]
    enabled: Option<bool>,
    /// Position: [x, y, z] in metres, inside the room, not at the position of the observer or an object.
    #[serde(skip_serializing_if = "Option::is_none")]
    position: Option<[f32; 3]>,
    /// Direction in which it shines: [x, y, z], of any length.
    #[serde(skip_serializing_if = "Option::is_none")]
    direction: Option<[f32; 3]>,
    /// Colour: [red, green, blue], whole numbers from 0 to 255, sRGB. Conflicts with `colour_temperature`.
    #[schemars(extend("default" = [255, 255, 255]))]
    #[serde(skip_serializing_if = "Option::is_none")]
    colour: Option<[u8; 3]>,
    /// Colour temperature in kelvin: the colour of a black body of this temperature. A candle has 1900, a light bulb
    /// 2700, white is 6500. The luminance is that of a white light. Conflicts with `colour`.
    #[schemars(range(min = 1000, max = 40000))]
    #[serde(skip_serializing_if = "Option::is_none")]
    colour_temperature: Option<f32>,
    /// Intensity: candela for point and spot lights; lux for directional and ambient ones and the sun; cd/m² for rectangles, discs, spheres and cylinders; a factor for photometric lamps and environments, which of a uniform one is its luminance in cd/m². Conflicts with `luminous_flux`.
    #[schemars(range(min = 0))]
    #[serde(skip_serializing_if = "Option::is_none")]
    intensity: Option<f32>,
    /// Luminous flux in lumen: the light sent out in all directions together, as printed on light bulbs. Conflicts with
    /// `intensity`.
    #[schemars(range(min = 0))]
    #[serde(skip_serializing_if = "Option::is_none")]
    luminous_flux: Option<f32>,
    #[serde(flatten)]
    #[schemars(skip)]
    parameters: Ordered<'a>,
}

/// The observer: the camera of the scene.
#[derive(Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct ObserverFile {
    /// Position: [x, y, z] in metres, inside the room, not at the position of a light or an object.
    position: [f32; 3],
    /// Direction of view: [x, y, z], of any length.
    direction: [f32; 3],
    /// Vertical field of view, degrees.
    #[schemars(range(min = 1, max = 170), extend("default" = 45))]
    #[serde(skip_serializing_if = "Option::is_none")]
    field_of_view: Option<f32>,
}

/// An object.
#[derive(Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct ObjectFile<'a> {
    /// Object type.
    #[serde(rename = "type")]
    object_type: &'a str,
    /// Name of the object.
    #[serde(skip_serializing_if = "Option::is_none")]
    name: Option<&'a str>,
    /// False if hidden.
    #[schemars(extend("default" = true))]
    #[serde(skip_serializing_if = "Option::is_none")]
    visible: Option<bool>,
    /// Position of the centre: [x, y, z] in metres, inside the room, not at the position of a light or the observer.
    position: [f32; 3],
    /// Largest extent, metres.
    #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 1_000_000_000, "default" = 2))]
    #[serde(skip_serializing_if = "Option::is_none")]
    size: Option<f32>,
    /// Rotation in degrees about x, then y, then z.
    #[schemars(extend("default" = [0, 0, 0]))]
    #[serde(skip_serializing_if = "Option::is_none")]
    rotation: Option<[f32; 3]>,
    /// Tessellation: how finely the shape is divided into polygons.
    #[serde(skip_serializing_if = "Option::is_none")]
    tessellation: Option<u32>,
    #[serde(flatten)]
    #[schemars(skip)]
    shape: Ordered<'a>,
    /// Override of the scene's reflection model.
    #[serde(skip_serializing_if = "Option::is_none")]
    reflection_model: Option<&'a str>,
    /// Override of the scene's shading model.
    #[serde(skip_serializing_if = "Option::is_none")]
    shading_model: Option<&'a str>,
    /// Parameters of the reflection model and of the shading model, by name. One material serves every model: values not
    /// used by the current
    /// model are kept for the others.
    #[schemars(with = "Option<serde_json::Map<String, serde_json::Value>>")]
    #[serde(skip_serializing_if = "Ordered::is_empty")]
    material: Ordered<'a>,
}

/// Conversion of light to the picture on the display.
#[derive(Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct DisplayFile {
    /// Tone mapping: the curve from light to display.
    #[schemars(extend("default" = "none"))]
    #[serde(skip_serializing_if = "Option::is_none")]
    tone_mapping: Option<&'static str>,
    /// Exposure in EV: each step up doubles the light.
    #[schemars(range(min = -16, max = 16), extend("default" = 0))]
    #[serde(skip_serializing_if = "Option::is_none")]
    exposure: Option<f32>,
    /// `srgb`: colours are decoded before and encoded after the calculation. `off`: neither; deliberately wrong, for
    /// comparison.
    #[schemars(extend("default" = "srgb"))]
    #[serde(skip_serializing_if = "Option::is_none")]
    encoding: Option<&'static str>,
}

/// The scene with some things changed. What is absent is inherited.
#[derive(Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct VariantFile<'a> {
    /// Name of the variant.
    #[serde(skip_serializing_if = "Option::is_none")]
    name: Option<&'a str>,
    /// Name of another variant from which it inherits, instead of the scene.
    #[serde(skip_serializing_if = "Option::is_none")]
    based_on: Option<&'a str>,
    /// Reflection model of every object.
    #[serde(skip_serializing_if = "Option::is_none")]
    reflection_model: Option<&'a str>,
    /// Shading model of every object.
    #[serde(skip_serializing_if = "Option::is_none")]
    shading_model: Option<&'a str>,
    /// Parameters of the material of every object.
    #[schemars(with = "Option<serde_json::Map<String, serde_json::Value>>")]
    #[serde(skip_serializing_if = "Ordered::is_empty")]
    material: Ordered<'a>,
    /// Terms of the equation that are shown.
    #[serde(skip_serializing_if = "Option::is_none")]
    terms: Option<&'static str>,
    /// Tone mapping: the curve from light to display.
    #[serde(skip_serializing_if = "Option::is_none")]
    tone_mapping: Option<&'static str>,
    /// Exposure in EV: each step up doubles the light.
    #[schemars(range(min = -16, max = 16))]
    #[serde(skip_serializing_if = "Option::is_none")]
    exposure: Option<f32>,
    /// `srgb`: colours are decoded before and encoded after the calculation. `off`: neither; deliberately wrong, for
    /// comparison.
    #[serde(skip_serializing_if = "Option::is_none")]
    encoding: Option<&'static str>,
    /// Tessellation of every object, as far as the object's type allows it.
    #[schemars(range(min = 1))]
    #[serde(skip_serializing_if = "Option::is_none")]
    tessellation: Option<u32>,
}

/// The way in which the views of a scene are shown.
#[derive(Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct ComparisonFile {
    /// Arrangement of the views.
    #[schemars(extend("default" = "single"))]
    #[serde(skip_serializing_if = "Option::is_none")]
    layout: Option<&'static str>,
    /// Letter of the view that is compared with view A where two are.
    #[schemars(extend("default" = "B", "enum" = ["B", "C", "D"]))]
    #[serde(skip_serializing_if = "Option::is_none")]
    with: Option<&'static str>,
    /// Place of the edge of a wipe: 0 at the left or top, 1 at the right or bottom.
    #[schemars(range(min = 0, max = 1), extend("default" = 0.5))]
    #[serde(skip_serializing_if = "Option::is_none")]
    split: Option<f32>,
    /// Direction of the edge of a wipe.
    #[schemars(extend("default" = "vertical"))]
    #[serde(skip_serializing_if = "Option::is_none")]
    edge: Option<&'static str>,
    /// Sign of differences.
    #[schemars(extend("default" = "absolute"))]
    #[serde(skip_serializing_if = "Option::is_none")]
    sign: Option<&'static str>,
    /// The number of a pixel that is compared.
    #[schemars(extend("default" = "largest"))]
    #[serde(skip_serializing_if = "Option::is_none")]
    channel: Option<&'static str>,
    /// The values that are compared.
    #[schemars(extend("default" = "codes"))]
    #[serde(skip_serializing_if = "Option::is_none")]
    values: Option<&'static str>,
    /// Factor by which a difference is multiplied before it becomes a colour. Default: the one that fits the largest
    /// difference.
    #[schemars(range(min = 1, max = 100))]
    #[serde(skip_serializing_if = "Option::is_none")]
    amplification: Option<f32>,
}

/// Parameters in the order of their declarations.
struct Ordered<'a>(Vec<(&'a str, &'a Value)>);

impl<'a> Ordered<'a> {
    /// The values in the order of the declarations; undeclared ones come last.
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
    /// The file of a scene. Fields that every scene has are always written; absent fields and fields equal to the
    /// default are not.
    pub(super) fn new(scene: &'a Scene, schema: Option<&'a str>, registry: &Registry) -> Self {
        let declared: Vec<_> = registry.material_parameters().collect();
        Self {
            schema,
            name: scene.name.as_deref(),
            description: scene.description.as_deref(),
            scene_size: SizeFile::new(scene.scene_size),
            reflection_model: &scene.reflection_model,
            shading_model: &scene.shading_model,
            lights: scene.lights.iter().map(|l| LightFile::new(l, registry)).collect(),
            observer: ObserverFile::new(&scene.observer),
            objects: scene.objects.iter().map(|o| ObjectFile::new(o, &declared, registry)).collect(),
            display: (scene.display != Display::default()).then(|| DisplayFile::new(&scene.display)),
            variants: scene.variants.iter().map(|v| VariantFile::new(v, &declared)).collect(),
            comparison: (scene.comparison != Comparison::default())
                .then(|| ComparisonFile::new(&scene.comparison)),
        }
    }
}

impl SizeFile {
    pub(super) fn new(SceneSize { height, width, depth }: SceneSize) -> Self {
        Self { height, width, depth }
    }
}

impl<'a> LightFile<'a> {
    pub(super) fn new(light: &'a Light, registry: &Registry) -> Self {
        let declared = registry.light(&light.light_type).map_or(&[][..], |l| l.parameters);
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
    pub(super) fn new(observer: &Observer) -> Self {
        Self {
            position: observer.position.into(),
            direction: observer.direction.into(),
            field_of_view: Some(observer.field_of_view),
        }
    }
}

impl<'a> ObjectFile<'a> {
    pub(super) fn new(object: &'a Object, declared: &[&'static Parameter], registry: &Registry) -> Self {
        let of_type = registry.shape(&object.object_type).map_or(&[][..], |shape| shape.parameters);
        Self {
            object_type: &object.object_type,
            name: object.name.as_deref(),
            visible: (!object.visible).then_some(false),
            position: object.position.into(),
            size: Some(object.size),
            rotation: (object.rotation != glam::Vec3::ZERO).then(|| object.rotation.into()),
            tessellation: object.tessellation,
            shape: Ordered::new(&object.shape, of_type.iter()),
            reflection_model: object.reflection_model.as_deref(),
            shading_model: object.shading_model.as_deref(),
            material: Ordered::new(&object.material, declared.iter().copied()),
        }
    }
}

impl DisplayFile {
    pub(super) fn new(display: &Display) -> Self {
        Self {
            tone_mapping: Some(display.tone_mapping.id()),
            exposure: Some(display.exposure),
            encoding: Some(display.encoding.id()),
        }
    }
}

impl<'a> VariantFile<'a> {
    fn new(variant: &'a Variant, declared: &[&'static Parameter]) -> Self {
        Self {
            name: variant.name.as_deref(),
            based_on: variant.based_on.as_deref(),
            reflection_model: variant.reflection_model.as_deref(),
            shading_model: variant.shading_model.as_deref(),
            material: Ordered::new(&variant.material, declared.iter().copied()),
            terms: variant.terms.map(TermSelection::id),
            tone_mapping: variant.tone_mapping.map(ToneMapping::id),
            exposure: variant.exposure,
            encoding: variant.encoding.map(Encoding::id),
            tessellation: variant.tessellation,
        }
    }
}

impl ComparisonFile {
    /// Only what differs from the default.
    fn new(comparison: &Comparison) -> Self {
        fn unless<T: PartialEq, U>(value: T, default: T, written: impl FnOnce(T) -> U) -> Option<U> {
            (value != default).then(|| written(value))
        }
        let default = Comparison::default();
        Self {
            layout: unless(comparison.layout, default.layout, Layout::id),
            with: unless(comparison.with, default.with, |view| LETTERS.get(view).copied().unwrap_or("?")),
            split: unless(comparison.split, default.split, |split| split),
            edge: unless(comparison.edge, default.edge, Edge::id),
            sign: unless(comparison.sign, default.sign, Sign::id),
            channel: unless(comparison.channel, default.channel, Channel::id),
            values: unless(comparison.values, default.values, Compared::id),
            amplification: comparison.amplification,
        }
    }
}
