//! Pictures with light with extent, sample by sample until there are enough.

use std::sync::atomic::AtomicBool;

use glam::Vec4;

use super::{LightSamples, Picture, Settings, render_noting, render_samples};
use crate::{
    optics::colour::luminance,
    registry::Registry,
    scene::{Scene, has_extent},
};

/// The end of a picture that converges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Until {
    /// The samples of each light that are taken at most.
    pub samples: u32,
    /// The noise at which it ends before; see [`Reached::noise`].
    pub noise: Option<f32>,
}

impl Default for Until {
    fn default() -> Self {
        Self { samples: LightSamples::DEFAULT, noise: None }
    }
}

/// How far a picture has converged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reached {
    /// The samples of each light; 0 where no light has extent.
    pub samples: u32,
    /// The noise: the standard error of the luminance of pixels that are lit, as the root of its mean square over them, divided
    /// by their mean luminance. It is estimated from the blocks of samples that the picture is the mean of; as those are spread
    /// more evenly together than alone, it is rather too large. `None` with fewer than four blocks.
    pub noise: Option<f32>,
}

/// The samples that are taken at once: a power of two, so that each block is evenly spread.
const AT_ONCE: u32 = 16;

/// The blocks from which on noise can be estimated.
const ENOUGH: u32 = 4;

/// Renders a scene to light until there are enough samples. The same samples give the same picture, whatever the machine.
#[must_use]
pub fn render_until(
    scene: &Scene,
    registry: &Registry,
    settings: &Settings,
    until: Until,
    odd: &AtomicBool,
) -> (Picture, Reached) {
    if !has_extent(scene.shining(), registry) {
        return (render_noting(scene, registry, settings, odd), Reached { samples: 0, noise: None });
    }
    let pixels = settings.width as usize * settings.height as usize;
    let mut mean = vec![Vec4::ZERO; pixels];
    // Of the luminance of blocks: the sum of squares about the mean, after B. Welford (1962).
    let mut squares = vec![0.0f32; pixels];
    let (mut taken, mut blocks, mut noise) = (0, 0u32, None);
    while taken < until.samples.max(1) {
        let count = AT_ONCE.min(until.samples.max(1) - taken);
        let samples = LightSamples { first: taken, count };
        let block = render_samples(scene, registry, settings, samples, odd);
        taken += count;
        blocks += 1;
        let share = count as f32 / taken as f32;
        for ((mean, squares), pixel) in mean.iter_mut().zip(&mut squares).zip(block.pixels) {
            let [before, new] = [*mean, pixel].map(|p| luminance(p.truncate()));
            *mean += (pixel - *mean) * share;
            *squares += (new - before) * (new - luminance(mean.truncate()));
        }
        if blocks >= ENOUGH {
            noise = Some(relative_error(&mean, &squares, blocks));
        }
        if until.noise.is_some_and(|enough| noise.is_some_and(|noise| noise <= enough)) {
            break;
        }
    }
    let picture = Picture { width: settings.width, height: settings.height, pixels: mean };
    (picture, Reached { samples: taken, noise })
}

/// See [`Reached::noise`].
fn relative_error(mean: &[Vec4], squares: &[f32], blocks: u32) -> f32 {
    let (mut variance, mut sum, mut lit) = (0.0f64, 0.0f64, 0.0f64);
    for (mean, squares) in mean.iter().zip(squares) {
        let here = f64::from(luminance(mean.truncate()));
        if here > 0.0 {
            variance += f64::from(*squares) / f64::from(blocks - 1) / f64::from(blocks);
            sum += here;
            lit += 1.0;
        }
    }
    if sum > 0.0 { ((variance / lit).sqrt() / (sum / lit)) as f32 } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{parameter::Value, scene::Light};
    use glam::Vec3;

    fn lit(registry: &Registry) -> Scene {
        let mut scene = Scene::default();
        let mut light = Light { position: Some(Vec3::new(7.0, 8.0, 7.0)), ..scene.lights[0].clone() };
        light.set_type(registry.light("rectangle").expect("built in"), registry, scene.scene_size);
        light.direction = Some(Vec3::new(-2.0, -3.0, -2.0));
        light.parameters.set("visible", Value::Choice("false".into()));
        scene.lights = vec![light];
        scene
    }

    const SMALL: Settings =
        Settings { width: 48, height: 32, samples: 1, terms: crate::optics::TermSelection::All };

    #[test]
    fn samples_in_blocks_are_the_samples_at_once() {
        let registry = Registry::builtin();
        let scene = lit(&registry);
        let odd = AtomicBool::default();
        let (picture, reached) =
            render_until(&scene, &registry, &SMALL, Until { samples: 72, noise: None }, &odd);
        assert_eq!(reached.samples, 72);
        let at_once = render_samples(&scene, &registry, &SMALL, LightSamples::of(72), &odd);
        let farthest = |a: &Picture, b: &Picture| {
            a.pixels.iter().zip(&b.pixels).map(|(a, b)| (*a - *b).abs().max_element()).fold(0.0, f32::max)
        };
        assert!(farthest(&picture, &at_once) < 1e-5, "{}", farthest(&picture, &at_once));
        let fewer = render_samples(&scene, &registry, &SMALL, LightSamples::of(64), &odd);
        assert!(farthest(&picture, &fewer) > 1e-4, "the wrong twin");
    }

    #[test]
    fn it_ends_at_the_noise_that_is_asked_for_which_is_that_of_the_picture() {
        let registry = Registry::builtin();
        let scene = lit(&registry);
        let odd = AtomicBool::default();
        let until = |noise| Until { samples: 4096, noise: Some(noise) };
        let (coarse, first) = render_until(&scene, &registry, &SMALL, until(0.004), &odd);
        let (_, second) = render_until(&scene, &registry, &SMALL, until(0.001), &odd);
        let noise = first.noise.expect("several blocks");
        assert!(noise <= 0.004 && second.noise.is_some_and(|noise| noise <= 0.001));
        assert!(first.samples < second.samples && second.samples < 4096, "{first:?} {second:?}");
        // The real error, against many samples: no larger than three times what is said, rather less.
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

    #[test]
    fn noise_is_the_standard_error_over_the_mean() {
        // Two pixels of the mean luminance 2, four blocks with the sums of squares 12 and 0: variances of the mean 1 and 0.
        let mean = [Vec4::new(2.0, 2.0, 2.0, 1.0); 2];
        let noise = relative_error(&mean, &[12.0, 0.0], 4);
        assert!((noise - 0.5f32.sqrt() / 2.0).abs() < 1e-6, "{noise}");
        assert_eq!(relative_error(&[Vec4::ZERO], &[0.0], 4), 0.0, "darkness has no noise");
    }

    #[test]
    fn without_light_with_extent_the_picture_is_the_same_bits() {
        let registry = Registry::builtin();
        let (scene, odd) = (Scene::default(), AtomicBool::default());
        let (picture, reached) = render_until(&scene, &registry, &SMALL, Until::default(), &odd);
        assert_eq!(reached, Reached { samples: 0, noise: None });
        assert_eq!(picture, crate::reference::render(&scene, &registry, &SMALL));
    }
}
