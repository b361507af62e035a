//! The keys of scene files.

use crate::registry::Registry;
pub(in crate::scene) use crate::registry::{LIGHT_KEYS, OBJECT_KEYS};

/// The keys of a scene, in the order of messages.
pub(in crate::scene) const SCENE_KEYS: &[&str] = &[
    "scene_size",
    "reflection_model",
    "shading_model",
    "lights",
    "observer",
    "objects",
    "display",
    "name",
    "description",
    "$schema",
];
/// The keys of `scene_size`.
pub(in crate::scene) const SIZE_KEYS: &[&str] = &["height", "width", "depth"];
/// Alternative keys of a light; the first counts if neither is given.
pub(in crate::scene) const LIGHT_ALTERNATIVES: [[&str; 2]; 2] =
    [["intensity", "luminous_flux"], ["colour", "colour_temperature"]];
/// The keys of `observer`.
pub(in crate::scene) const OBSERVER_KEYS: &[&str] = &["position", "direction", "field_of_view"];
/// The keys of `display`.
pub(in crate::scene) const DISPLAY_KEYS: &[&str] = &["tone_mapping", "exposure", "encoding"];

/// Other words for keys, for suggestions only: the names in other programs.
pub(super) const OTHER_WORDS: &[(&str, &str)] = &[
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
    ("title", "name"),
    ("on", "enabled"),
    ("off", "enabled"),
    ("hidden", "visible"),
    ("visibility", "visible"),
    ("gamma", "encoding"),
    ("angle", "cone_angle"),
    ("shininess", "alpha"),
];

/// The keys of all light types.
pub(super) fn light_keys(registry: &Registry) -> Vec<&'static str> {
    let declared = registry.lights().iter().flat_map(|l| l.declaration.parameters).map(|p| p.name);
    let mut keys = LIGHT_KEYS.to_vec();
    for name in declared {
        if !keys.contains(&name) {
            keys.push(name);
        }
    }
    keys
}
