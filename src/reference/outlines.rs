//! The outlines of objects: the borders between pixels that show different objects or the background.

use super::{Settings, render};
use crate::{
    optics::TermSelection,
    parameter::Value,
    registry::Registry,
    scene::{Light, Scene},
};

/// True for each pixel whose right or lower neighbour shows another object or the background, row by row from
/// the top.
#[must_use]
pub fn outlines(scene: &Scene, registry: &Registry, [width, height]: [u32; 2]) -> Vec<bool> {
    // Each object gets a different, uniform light, so that the picture identifies objects.
    let even = Scene::default();
    let mut ids = Scene {
        reflection_model: even.reflection_model,
        shading_model: "flat".to_owned(),
        lights: vec![Light {
            light_type: "ambient".to_owned(),
            position: None,
            intensity: 1.0,
            ..Light::default()
        }],
        ..scene.clone().alone()
    };
    for (i, object) in ids.objects.iter_mut().enumerate() {
        (object.reflection_model, object.shading_model) = (None, None);
        let [.., high, low] = (i as u32).to_be_bytes();
        object.material = Default::default();
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
