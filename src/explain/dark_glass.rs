//! Smooth glass in scenes whose lights have no extent: nothing is seen through it.

use crate::{
    registry::Registry,
    scene::{Object, Scene, has_extent, shines_from_everywhere},
    text::plural,
};

/// The reason why smooth glass is dark, and the remedy: the end of a sentence.
pub const WHY: &str = "lights without extent are not seen through it; add a light with extent or an environment, or make the \
                       glass rough";

/// A sentence on the smooth glass of a scene through which no light is seen, if there is any.
#[must_use]
pub fn dark_glass(scene: &Scene, registry: &Registry) -> Option<String> {
    if !has_points_alone(scene, registry) {
        return None;
    }
    let objects = scene.objects.iter().enumerate().filter(|(_, object)| object.visible);
    let mut dark = objects.filter(|(_, object)| is_clear(scene, object, registry));
    let first = scene.object_path(dark.next()?.0);
    let same = the_same_for(dark.count());
    Some(format!("{first} is smooth glass and looks dark: {WHY}{same}"))
}

/// The end of a sentence on an object that holds for more objects: ` (the same for 2 more objects)`.
pub(super) fn the_same_for(more: usize) -> String {
    if more == 0 { String::new() } else { format!(" (the same for {})", plural(more, "more object")) }
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
        let said = |scene: &Scene| dark_glass(scene, &Registry::builtin());
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
