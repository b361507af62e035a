//! The keys of scene files, and other words for them.

use crate::{
    parameter::Parameter,
    registry::Registry,
    scene::{Light, Object, Scene, part::Structure},
};

/// The keys of a scene, in the order of messages: words come last.
pub(in crate::scene) fn scene_keys() -> Vec<&'static str> {
    let mut keys = Scene::keys();
    keys.rotate_left(2);
    keys.push("$schema");
    keys
}

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
    ("backdrop", "background"),
    ("background_top", "background_colour"),
];

/// The keys of all light types.
pub(super) fn light_keys(registry: &Registry) -> Vec<&'static str> {
    with(Light::keys(), registry.lights().iter().flat_map(|l| l.parameters))
}

/// The keys of all object types.
pub(super) fn object_keys(registry: &Registry) -> Vec<&'static str> {
    with(Object::keys(), registry.shapes().iter().flat_map(|s| s.parameters))
}

fn with(
    mut keys: Vec<&'static str>,
    declared: impl Iterator<Item = &'static Parameter>,
) -> Vec<&'static str> {
    for p in declared {
        if !keys.contains(&p.name) {
            keys.push(p.name);
        }
    }
    keys
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::registry::{LIGHT_KEYS, OBJECT_KEYS};

    #[test]
    fn the_registry_knows_which_names_parameters_cannot_have() {
        let named =
            |keys: &[&'static str]| keys.iter().copied().filter(|key| !key.is_empty()).collect::<Vec<_>>();
        assert_eq!((Light::keys(), Object::keys()), (named(LIGHT_KEYS), named(OBJECT_KEYS)));
    }
}
