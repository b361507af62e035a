//! The keys of scene files.

pub(in crate::scene) use crate::registry::{LIGHT_KEYS, OBJECT_KEYS};
use crate::{parameter::Parameter, registry::Registry};

/// The keys of a scene, in the order of messages.
pub(in crate::scene) const SCENE_KEYS: &[&str] = &[
    "scene_size",
    "reflection_model",
    "shading_model",
    "lights",
    "observer",
    "objects",
    "display",
    "variants",
    "comparison",
    "name",
    "description",
    "$schema",
];
/// The keys of `scene_size`.
pub(in crate::scene) const SIZE_KEYS: &[&str] = &["height", "width", "depth"];
/// Alternative keys of a light; if neither is given, the default of the first applies.
pub(in crate::scene) const LIGHT_ALTERNATIVES: [[&str; 2]; 2] =
    [["intensity", "luminous_flux"], ["colour", "colour_temperature"]];
/// The keys of `observer`.
pub(in crate::scene) const OBSERVER_KEYS: &[&str] = &["position", "direction", "field_of_view"];
/// The keys of `display`.
pub(in crate::scene) const DISPLAY_KEYS: &[&str] = &["tone_mapping", "exposure", "encoding"];

/// The keys of a variant.
pub(in crate::scene) const VARIANT_KEYS: &[&str] = &[
    "name",
    "based_on",
    "reflection_model",
    "shading_model",
    "material",
    "terms",
    "tone_mapping",
    "exposure",
    "encoding",
    "tessellation",
];
/// The keys of `comparison`.
pub(in crate::scene) const COMPARISON_KEYS: &[&str] =
    &["layout", "with", "split", "edge", "sign", "channel", "values", "amplification"];

/// Other words for keys, used only for suggestions: the names in other programs.
pub(in crate::scene) const OTHER_WORDS: &[(&str, &str)] = &[
    ("camera", "observer"),
    ("eye", "observer"),
    ("viewer", "observer"),
    ("fov", "field_of_view"),
    ("scale", "size"),
    ("radius", "size"),
    ("room", "scene_size"),
    ("lighting_model", "reflection_model"),
    ("shading", "shading_model"),
    ("reflection", "reflection_model"),
    ("shape", "type"),
    ("kind", "type"),
    ("location", "position"),
    ("orientation", "rotation"),
    ("look_at", "direction"),
    ("brightness", "intensity"),
    ("power", "intensity"),
    ("lumen", "luminous_flux"),
    ("lumens", "luminous_flux"),
    ("flux", "luminous_flux"),
    ("kelvin", "colour_temperature"),
    ("temperature", "colour_temperature"),
    ("segments", "tessellation"),
    ("subdivisions", "tessellation"),
    ("minor_radius", "tube_radius"),
    ("title", "name"),
    ("on", "enabled"),
    ("off", "enabled"),
    ("hidden", "visible"),
    ("visibility", "visible"),
    ("gamma", "encoding"),
    ("angle", "cone_angle"),
    ("shininess", "alpha"),
    ("inherits", "based_on"),
    ("parent", "based_on"),
    ("compare", "comparison"),
    ("views", "variants"),
];

/// The keys of all light types.
pub(super) fn light_keys(registry: &Registry) -> Vec<&'static str> {
    with(LIGHT_KEYS, registry.lights().iter().flat_map(|l| l.parameters))
}

/// The keys of all object types.
pub(super) fn object_keys(registry: &Registry) -> Vec<&'static str> {
    with(OBJECT_KEYS, registry.shapes().iter().flat_map(|s| s.parameters))
}

fn with(common: &[&'static str], declared: impl Iterator<Item = &'static Parameter>) -> Vec<&'static str> {
    let mut keys = common.to_vec();
    for p in declared {
        if !keys.contains(&p.name) {
            keys.push(p.name);
        }
    }
    keys
}
