//! The pixels that objects cover, and the outlines of objects: the borders between pixels that show different objects
//! or the background.

use std::sync::atomic::AtomicBool;

use super::{LightSamples, Settings, render, render_samples};
use crate::{
    optics::TermSelection,
    parameter::Value,
    registry::Registry,
    scene::{Light, Scene},
};

/// The scene with surfaces of one simple model, which cover the same pixels.
fn plain(scene: &Scene) -> Scene {
    let mut plain = Scene {
        reflection_model: Scene::default().reflection_model,
        shading_model: "flat".to_owned(),
        ..scene.clone().alone()
    };
    for object in &mut plain.objects {
        (object.reflection_model, object.shading_model) = (None, None);
        object.material = Default::default();
    }
    plain
}

/// True for each pixel of which objects, or lights that are seen, cover a sample, as in the light of [`render`]. No
/// model of the scene has to run on the CPU.
#[must_use]
pub fn covered(scene: &Scene, registry: &Registry, settings: &Settings) -> Vec<bool> {
    // The light does not matter.
    let light =
        render_samples(&plain(scene), registry, settings, LightSamples::of(1), &AtomicBool::default());
    light.pixels.iter().map(|pixel| pixel.w > 0.0).collect()
}

/// True if the objects, and the lights that are seen, [cover](covered) the same pixels in two scenes, whatever the
/// models, the materials and the display.
#[must_use]
pub fn covers_alike(a: &Scene, b: &Scene) -> bool {
    let bodies = |scene: &Scene| Scene { display: Default::default(), ..plain(scene) };
    bodies(a) == bodies(b)
}

/// True for each pixel whose right or lower neighbour shows another object or the background, row by row from
/// the top.
#[must_use]
pub fn outlines(scene: &Scene, registry: &Registry, [width, height]: [u32; 2]) -> Vec<bool> {
    // Each object gets a different, uniform light, so that the picture identifies objects.
    let mut ids = Scene {
        lights: vec![Light {
            light_type: "ambient".to_owned(),
            position: None,
            intensity: 1.0,
            ..Light::default()
        }],
        ..plain(scene)
    };
    for (i, object) in ids.objects.iter_mut().enumerate() {
        let [.., high, low] = (i as u32).to_be_bytes();
        object.material.set("base_colour", Value::Colour([low, high, 255]));
    }
    let settings = Settings { width, height, samples: 1, terms: TermSelection::All };
    let pixels = render(&ids, registry, &settings).pixels;
    let (across, down) = (width as usize, height as usize);
    // Rounding in the light loop is smaller than a step between the darkest codes.
    let differ = |a: usize, b: usize| !pixels[a].abs_diff_eq(pixels[b], 2e-5);
    let at = |i: usize| {
        let (x, y) = (i % across, i / across);
        (x + 1 < across && differ(i, i + 1)) || (y + 1 < down && differ(i, i + across))
    };
    (0..pixels.len()).map(at).collect()
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::scene::Object;

    #[test]
    fn what_is_covered_is_what_the_light_covers_with_lights_that_are_seen() {
        let registry = Registry::builtin();
        let glass = Scene { reflection_model: "glass".to_owned(), ..Scene::default() };
        let mut sky = glass.clone();
        let mut light = Light::default();
        light.set_type(registry.light("environment").expect("built in"), &registry, sky.scene_size);
        light.parameters.set("visible", Value::Choice("true".into()));
        sky.lights.push(light);
        for (scene, whole) in [(glass, false), (sky, true)] {
            for samples in [1, 4] {
                let settings = Settings { width: 64, height: 36, samples, terms: TermSelection::All };
                let all = covered(&scene, &registry, &settings);
                let lit = render(&scene, &registry, &settings).pixels;
                assert!(lit.iter().map(|pixel| pixel.w > 0.0).eq(all.iter().copied()), "{samples}");
                assert_eq!(all.iter().all(|on| *on), whole);
                assert!(all.contains(&true));
            }
        }
    }

    #[test]
    fn views_of_the_same_bodies_cover_alike_and_others_do_not() {
        let scene = Scene::default();
        let mut views = vec![scene.clone(); 4];
        views[0].display.exposure += 1.0;
        views[0].reflection_model = "glass".to_owned();
        views[0].objects[0].material.set("alpha", Value::Integer(7));
        views[1].objects[0].tessellation = Some(5);
        views[2].observer.field_of_view += 1.0;
        views[3].objects[0].visible = false;
        let alike: Vec<_> = views.iter().map(|view| covers_alike(view, &scene)).collect();
        assert_eq!(alike, [true, false, false, false]);
    }

    #[test]
    fn an_object_has_one_outline_also_before_another_and_none_within() {
        let registry = Registry::builtin();
        let sphere = Object { size: 2.0, ..Scene::default().objects[0].clone() };
        let wall = Object { position: Vec3::new(5.0, 5.0, 1.0), size: 5.0, ..sphere.clone() };
        let scene = |objects: Vec<Object>| Scene { objects, ..Scene::default() };
        let row = |scene: &Scene| {
            let all = outlines(scene, &registry, [96, 54]);
            all[27 * 96..28 * 96].iter().filter(|on| **on).count()
        };
        assert_eq!(row(&scene(vec![sphere.clone()])), 2);
        assert_eq!(row(&scene(vec![sphere.clone(), wall.clone()])), 4);
        let alone = Object { visible: false, ..sphere };
        assert_eq!(row(&scene(vec![alone, wall])), 2);
    }
}
