//! Smooth glass in scenes whose lights have no extent: nothing is seen through it.

use std::fmt;

use crate::{
    registry::Registry,
    scene::{Object, Scene, error::Path, has_extent, shines_from_everywhere},
    text::{plural, quoted},
};

/// The reason why smooth glass is dark, and the remedy: the end of a sentence.
pub const WHY: &str = "lights without extent are not seen through it; add a light with extent or an environment, or make the \
                       glass rough";

/// Smooth glass through which no light of the scene is seen.
#[derive(Clone, Debug, PartialEq)]
pub struct DarkGlass {
    /// Path of the first such object.
    pub path: Path,
    /// Name of the object.
    pub name: Option<String>,
    /// Number of further such objects.
    more: usize,
}

impl fmt::Display for DarkGlass {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { path, name, more } = self;
        let name = name.as_deref().map_or_else(String::new, |name| format!(" ({})", quoted(name)));
        write!(f, "{path}{name} is smooth glass and looks dark: {WHY}")?;
        if *more > 0 {
            write!(f, " (the same for {})", plural(*more, "more object"))?;
        }
        Ok(())
    }
}

/// The smooth glass of a scene through which no light is seen, if there is any.
#[must_use]
pub fn dark_glass(scene: &Scene, registry: &Registry) -> Option<DarkGlass> {
    if !has_points_alone(scene, registry) {
        return None;
    }
    let mut dark =
        scene.objects.iter().enumerate().filter(|(_, o)| o.visible && is_clear(scene, o, registry));
    let (i, first) = dark.next()?;
    let path = Path::root().key("objects").index(i);
    Some(DarkGlass { path, name: first.name.clone(), more: dark.count() })
}

/// True if an object of a scene is smooth glass through which no light is seen.
pub(super) fn is_dark_glass(scene: &Scene, object: &Object, registry: &Registry) -> bool {
    has_points_alone(scene, registry) && is_clear(scene, object, registry)
}

/// True if lights shine, and none of them can be seen through smooth glass. The background of a picture cannot, either.
fn has_points_alone(scene: &Scene, registry: &Registry) -> bool {
    scene.shining().next().is_some()
        && !has_extent(scene.shining(), registry)
        && !shines_from_everywhere(scene.shining(), scene.display.encoding, registry)
}

fn is_clear(scene: &Scene, object: &Object, registry: &Registry) -> bool {
    registry.model(scene.model_of(object)).is_some_and(|model| model.is_clear(&object.material))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        explain::{pixel, sentence},
        optics::TermSelection,
        parameter::{Value, Values},
        reference::Settings,
        scene::Light,
    };

    fn scene(model: &str, material: &[(&'static str, Value)]) -> Scene {
        let mut scene = Scene { reflection_model: model.to_owned(), ..Scene::default() };
        scene.shading_model = "phong".to_owned();
        let mut values = Values::default();
        material.iter().for_each(|(name, value)| values.set(*name, value.clone()));
        scene.objects[0].material = values;
        scene
    }

    fn is_said(scene: &Scene) -> bool {
        dark_glass(scene, &Registry::builtin()).is_some()
    }

    /// Light from everywhere, of a type.
    fn all_around(light_type: &str) -> Light {
        Light { light_type: light_type.to_owned(), position: None, intensity: 0.2, ..Light::default() }
    }

    #[test]
    fn smooth_glass_under_points_is_named_and_rough_or_opaque_surfaces_are_not() {
        let roughness = |r: f32| ("roughness", Value::Number(r));
        let weight = ("transmission_weight", Value::Number(1.0));
        let thin = ("geometry_thin_walled", Value::flag(true));
        for (model, smooth) in [
            ("glass", vec![roughness(0.0)]),
            ("thin_glass", vec![roughness(0.0)]),
            ("openpbr", vec![roughness(0.0), weight.clone()]),
            ("openpbr", vec![roughness(0.0), weight, thin]),
        ] {
            assert!(is_said(&scene(model, &smooth)), "{model} {smooth:?}");
            let mut rough = smooth;
            rough[0] = roughness(0.4);
            assert!(!is_said(&scene(model, &rough)), "{model} {rough:?}");
        }
        for (model, material) in [
            ("openpbr", vec![roughness(0.0)]),
            ("rough_dielectric", Vec::new()),
            ("diffuse_transmission", Vec::new()),
            ("phong", Vec::new()),
        ] {
            assert!(!is_said(&scene(model, &material)), "{model}");
        }
    }

    #[test]
    fn light_that_is_seen_through_glass_silences_it() {
        let glass = scene("glass", &[]);
        for light_type in ["environment", "ambient"] {
            let mut lit = glass.clone();
            lit.lights.push(all_around(light_type));
            assert!(!is_said(&lit), "{light_type}");
            // Switched off, it shows nothing.
            lit.lights[1].enabled = false;
            assert!(is_said(&lit), "{light_type}");
        }
        let mut unlit = glass.clone();
        unlit.lights[0].enabled = false;
        assert!(!is_said(&unlit), "another matter");
        let mut hidden = glass;
        hidden.objects[0].visible = false;
        assert!(!is_said(&hidden));
    }

    #[test]
    fn the_first_object_is_named_and_the_others_are_counted() {
        let mut scene = scene("glass", &[]);
        scene.objects[0].name = Some("ball".to_owned());
        let said = |scene: &Scene| dark_glass(scene, &Registry::builtin()).map(|dark| dark.to_string());
        let one = format!("objects[0] (\"ball\") is smooth glass and looks dark: {WHY}");
        assert_eq!(said(&scene), Some(one.clone()));
        scene.objects.extend([scene.objects[0].clone(), scene.objects[0].clone()]);
        assert_eq!(said(&scene), Some(format!("{one} (the same for 2 more objects)")));
    }

    #[test]
    fn explanations_say_why_the_glass_is_dark() {
        let settings = Settings { width: 64, height: 36, samples: 1, terms: TermSelection::All };
        let told = |scene: &Scene| {
            let found = pixel(scene, &Registry::builtin(), &settings, [32, 18]).expect("in the picture");
            assert!(found.seen.is_some(), "the sphere is in the middle");
            [sentence(&found, "This pixel is", &|light| format!("Lamp {light}")), found.to_text()]
        };
        let mut glass = scene("glass", &[]);
        for text in told(&glass) {
            assert!(text.contains(WHY), "{text}");
        }
        glass.lights.push(all_around("environment"));
        for text in told(&glass).into_iter().chain(told(&scene("phong", &[]))) {
            assert!(!text.contains(WHY), "{text}");
        }
    }
}
