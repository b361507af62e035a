//! Pictures of the CPU renderer end when what was asked for is reached. Without optimisation, these would take long.

use std::sync::atomic::AtomicBool;

use lights_camera_models::{
    optics::colour::luminance,
    parameter::Value,
    reference::{LightSamples, Reached, Until, render_samples},
    registry::Registry,
    scene::Scene,
    testing::shared::{SMALL, lit, until},
};

#[test]
fn a_picture_that_does_not_depend_on_chance_ends_as_soon_as_that_is_known() {
    let registry = Registry::builtin();
    let under_sky = |name: &'static str, value: f32| {
        let mut scene = Scene { reflection_model: "glass".to_owned(), ..Scene::default() };
        scene.lights[0].set_type(
            registry.light("environment").expect("built in"),
            &registry,
            scene.scene_size,
        );
        scene.lights[0].parameters.set("source", Value::Choice("sky".into()));
        for object in &mut scene.objects {
            object.material.set(name, Value::Number(value));
        }
        scene
    };
    let smooth = under_sky("roughness", 0.0);
    let (picture, reached) = until(&smooth, &registry, 96, None);
    assert_eq!(reached, Reached { samples: 1, noise: Some(0.0) });
    assert!(picture.pixels.iter().any(|pixel| luminance(pixel.truncate()) > 0.0));
    let many = render_samples(&smooth, &registry, &SMALL, LightSamples::of(48), &AtomicBool::default());
    assert_eq!(picture, many, "more samples would change nothing");
    for chance in [under_sky("roughness", 0.5), under_sky("dispersion", 0.05)] {
        assert_eq!(until(&chance, &registry, 96, None).1.samples, 96, "the wrong twins");
    }
    // What spreads light, but is not in the picture, is noticed only by the samples.
    let mut unseen = smooth;
    let mut rough = under_sky("roughness", 0.5).objects.remove(0);
    rough.position = unseen.observer.position - 50.0 * unseen.observer.direction.normalize();
    unseen.objects.push(rough);
    let reached = until(&unseen, &registry, 96, None).1;
    assert_eq!(reached, Reached { samples: Until::FEWEST_FOR_NOISE, noise: Some(0.0) });
    let mut dark = lit(&registry);
    dark.lights[0].intensity = 0.0;
    assert_eq!(until(&dark, &registry, 96, None).1.samples, 96, "light may be found later");
}

#[test]
fn it_ends_at_the_noise_that_is_asked_for_which_is_that_of_the_picture() {
    let registry = Registry::builtin();
    let scene = lit(&registry);
    let odd = AtomicBool::default();
    let (coarse, first) = until(&scene, &registry, 4096, Some(0.004));
    let (_, second) = until(&scene, &registry, 4096, Some(0.001));
    let noise = first.noise.expect("several blocks");
    assert!(noise <= 0.004 && second.noise.is_some_and(|noise| noise <= 0.001));
    assert!(first.samples < second.samples && second.samples < 4096, "{first:?} {second:?}");
    // The actual error, against many samples: at most three times the estimate, and usually smaller.
    let exact = render_samples(&scene, &registry, &SMALL, LightSamples::of(4096), &odd);
    let (mut squares, mut sum, mut count) = (0.0, 0.0, 0.0);
    for (a, b) in coarse.pixels.iter().zip(&exact.pixels) {
        let [a, b] = [a, b].map(|p| f64::from(luminance(p.truncate())));
        if b > 0.0 {
            squares += (a - b) * (a - b);
            sum += b;
            count += 1.0;
        }
    }
    let real = (squares / count).sqrt() / (sum / count);
    assert!(real < 3.0 * f64::from(noise), "{real} {noise}");
}
