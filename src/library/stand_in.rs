//! Fallback shaders, used when the WGSL of another crate is invalid.

use crate::{
    custom,
    light::{LightEntry, Twin},
    reflection::ModelEntry,
    shading::ShadingEntry,
};

/// The paths of the parts of a shader, each with its fallback: grey Lambert, an interpolated normal, and
/// darkness.
#[must_use]
pub fn of(model: &ModelEntry, shading: &ShadingEntry, lights: &[LightEntry]) -> Vec<(&'static str, String)> {
    let dark = |light: &LightEntry| {
        let function = |twin: &Twin| {
            format!("fn {}{} {{\n    return {};\n}}\n", twin.of(light), twin.signature(light), twin.dark)
        };
        Twin::all(light.declaration.extent).iter().map(function).collect()
    };
    let lights = lights.iter().map(|light| (light.declaration.wgsl.path, dark(light)));
    let own = model.declaration;
    let model = (own.wgsl.path, custom::stand_in(own.ambient, own.sharp));
    let shading = (shading.declaration.wgsl.path, crate::shading::STAND_IN.text.to_owned());
    lights.chain([model, shading]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        registry::{Registry, compose::compose},
        shader::{compose::Sources, whole::validate_drawing},
        shading::Stage,
    };

    #[test]
    fn everything_has_a_stand_in_that_can_be_drawn_with() {
        let registry = Registry::builtin();
        for model in registry.models() {
            for shading in registry.shading_models() {
                let mut sources = Sources::default();
                let all = of(model, shading, registry.lights());
                assert_eq!(all.len(), registry.lights().len() + 2);
                all.into_iter().for_each(|(path, text)| sources.edit(path, text));
                let composed =
                    compose(&sources, (model, model.declaration.passage()), shading, registry.lights());
                for faces in [false, shading.declaration.stage == Stage::Polygon] {
                    assert_eq!(validate_drawing(&composed, faces), Ok(()), "{}", model.declaration.id);
                }
            }
        }
    }
}
