//! The shipped scenes, built into the program, so that it needs no folder next to it.

use std::sync::LazyLock;

use super::{
    Scene,
    error::LoadError,
    load::{self, Defaults},
};
use crate::{parameter::Values, registry::Registry};

/// A shipped scene.
#[derive(Clone, Debug)]
pub struct Example {
    /// The file name in the folder `scenes`.
    pub file: &'static str,
    /// The text of the file.
    pub text: &'static str,
    /// The name of the scene.
    pub name: String,
    /// A one-line description of the content.
    pub description: String,
}

macro_rules! texts {
    ($($file:literal),* $(,)?) => {
        [$(($file, include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/", $file)))),*]
    };
}

/// The scenes, from the simplest to those that measure something.
const TEXTS: [(&str, &str); 36] = texts![
    "default.json",
    "shapes_and_lights.json",
    "superellipsoids.json",
    "five_spheres.json",
    "models_from_files.json",
    "gouraud_misses_highlight.json",
    "half_lambert.json",
    "photometric_lamps.json",
    "colour_wheel.csv",
    "portrait.json",
    "lobe_shape.json",
    "fresnel_effect.json",
    "gold_three_lights.json",
    "white_furnace.json",
    "softbox_and_lamps.json",
    "studio.json",
    "under_the_sky.json",
    "in_a_room.json",
    "same_in_mitsuba.json",
    "glass_thin_and_solid.json",
    "glass_ball.json",
    "broken_straw.json",
    "gem.json",
    "lampshade.json",
    "coloured_glass.json",
    "invisible_ball.json",
    "model_matrix.json",
    "many_lights.json",
    "compare_gouraud_phong.json",
    "compare_flat_derivative.json",
    "compare_phong_blinn_phong.json",
    "compare_diffuse_models.json",
    "compare_gold.json",
    "compare_furnace.json",
    "compare_gamma.json",
    "compare_tone_mappings.json",
];

/// Scenes of one object each, whose materials are the [`looks`].
const LOOKS: [(&str, &str); 10] = texts![
    "openpbr_car_paint.json",
    "openpbr_satin.json",
    "openpbr_velvet.json",
    "openpbr_soap_film_on_black.json",
    "openpbr_anodised_titanium.json",
    "openpbr_lacquered_wood.json",
    "openpbr_brushed_steel.json",
    "openpbr_wet_stone.json",
    "openpbr_pearl.json",
    "openpbr_ceramic.json",
];

/// A ready-made material: a preset of its reflection model.
#[derive(Clone, Debug)]
pub struct Look {
    /// The id of the reflection model.
    pub model: String,
    /// The name: "Car paint".
    pub name: String,
    /// A one-line description of its parts.
    pub description: String,
    /// The values of the parameters.
    pub material: Values,
}

/// All looks, in the order of lists.
#[must_use]
pub fn looks() -> &'static [Look] {
    static ALL: LazyLock<Vec<Look>> = LazyLock::new(|| {
        let registry = Registry::builtin();
        let look = |(file, text): (&str, &str)| {
            // A scene that cannot be read, or has no object, is skipped; a test ensures that there is none.
            let scene = load::from_text(text, file, &registry, Defaults::Use).ok()?.scene;
            let material = scene.objects.first()?.material.clone();
            Some(Look {
                model: scene.reflection_model,
                name: scene.name?,
                description: scene.description?,
                material,
            })
        };
        LOOKS.into_iter().filter_map(look).collect()
    });
    &ALL
}

/// All examples, in the order of lists.
pub static EXAMPLES: LazyLock<Vec<Example>> = LazyLock::new(|| {
    let registry = Registry::builtin();
    TEXTS
        .into_iter()
        .chain(LOOKS)
        .map(|(file, text)| {
            let (name, description) = head(file, text, &registry);
            Example { file, text, name, description }
        })
        .collect()
});

/// The name and the description of a scene. JSON is not read as a whole for them, since some scenes are large.
fn head(file: &str, text: &str, registry: &Registry) -> (String, String) {
    #[derive(serde::Deserialize)]
    struct Head {
        name: String,
        description: String,
    }
    if let Ok(Head { name, description }) = serde_json::from_str(text) {
        return (name, description);
    }
    let scene = load::from_text(text, file, registry, Defaults::Use).map(|loaded| loaded.scene);
    scene.map_or_else(
        |_| Default::default(),
        |s| (s.name.unwrap_or_default(), s.description.unwrap_or_default()),
    )
}

impl Example {
    /// Reads the scene.
    ///
    /// # Errors Returns a [`LoadError`] if the registry lacks a model or type in the scene.
    pub fn scene(&self, registry: &Registry) -> Result<Scene, LoadError> {
        load::from_text(self.text, self.file, registry, Defaults::Use).map(|loaded| loaded.scene)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::formats;

    #[test]
    fn every_look_sets_each_parameter_of_its_model_and_differs_from_the_others() {
        let registry = Registry::builtin();
        assert_eq!(looks().len(), LOOKS.len());
        for (i, look) in looks().iter().enumerate() {
            let model = registry.model(&look.model).expect("built in");
            for p in model.parameters {
                assert!(
                    look.material.0.get(p.name).is_some_and(|v| p.allows(v)),
                    "{}: {}",
                    look.name,
                    p.name
                );
            }
            assert!(!looks()[..i].iter().any(|other| other.material == look.material), "{}", look.name);
        }
    }

    #[test]
    fn every_shipped_scene_is_an_example_with_a_name_and_a_description() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes");
        let mut files: Vec<_> = std::fs::read_dir(folder)
            .expect("the folder is there")
            .map(|entry| entry.expect("readable").file_name().to_string_lossy().into_owned())
            .filter(|name| formats::is_scene_file(name.as_ref(), &Registry::builtin()))
            // Pictures of surroundings.
            .filter(|name| formats::can_write(name.as_ref(), &Registry::builtin()))
            .collect();
        let mut known: Vec<_> = EXAMPLES.iter().map(|e| e.file.to_owned()).collect();
        files.sort();
        known.sort();
        assert_eq!(known, files);
        let registry = Registry::builtin();
        for example in EXAMPLES.iter() {
            assert!(!example.name.is_empty() && !example.description.is_empty(), "{}", example.file);
            let scene = example.scene(&Registry::builtin()).expect(example.file);
            for light in &scene.lights {
                let name = light.name.as_deref().unwrap_or_default();
                let mut ids = registry.lights().iter().map(|entry| entry.declaration.id);
                let misled = ids.any(|id| id == name && id != light.light_type);
                assert!(!misled, "{}: a light of type {} named {name}", example.file, light.light_type);
            }
            // In prose, parameters have names and not identifiers.
            let names = scene.lights.iter().map(|l| &l.name).chain(scene.objects.iter().map(|o| &o.name));
            for text in names.flatten().chain([&example.name, &example.description]) {
                assert!(!text.contains('_'), "{}: {text}", example.file);
            }
        }
    }
}
