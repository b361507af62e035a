//! Pictures with lights with extent, refined sample by sample until they have converged.

use std::sync::atomic::AtomicBool;

use glam::Vec4;

use super::{LightSamples, Picture, Settings, render_samples};
pub use crate::caption::Sampled as Reached;
use crate::{
    optics::colour::luminance,
    progress::{Cancelled, Progress},
    registry::Registry,
    scene::Scene,
};

/// The termination conditions of a converging picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Until {
    /// Maximum number of samples of each light. A picture without any noise after [`Until::FEWEST_FOR_NOISE`] ends there.
    pub samples: u32,
    /// Noise at which it ends earlier: the root mean square of the standard error of the luminance over all pixels in which
    /// samples differ, divided by their mean luminance. So lamps and surroundings in the picture, which have no noise, do not
    /// count, however bright they are. It is estimated from the blocks of samples of which the picture is the mean;
    /// since these are more evenly distributed together than alone, it is an overestimate.
    pub noise: Option<f32>,
}

impl Default for Until {
    fn default() -> Self {
        Self { samples: LightSamples::DEFAULT, noise: None }
    }
}

/// Number of samples in a block: a power of two, so that each block is evenly distributed.
pub(crate) const BLOCK: u32 = 16;

/// Minimum number of blocks for estimating noise.
pub(crate) const ENOUGH: u32 = 4;

impl Until {
    /// Minimum number of samples for estimating noise.
    pub const FEWEST_FOR_NOISE: u32 = BLOCK * ENOUGH;

    /// The fraction of the work that is done, and a description of the state. Noise falls at least with the
    /// square root of the number of samples, so the work ends no later than this predicts.
    pub(crate) fn progress(self, Reached { samples, noise }: Reached) -> (f32, String) {
        let done = |all: f32| (samples as f32 / all).min(1.0);
        let all = self.samples.max(1) as f32;
        match (self.noise, noise) {
            (Some(wanted), Some(noise)) => {
                let needed = samples as f32 * (noise / wanted).powi(2);
                let said =
                    format!("{samples} samples, noise {:.2} %, until {:.2} %", 100.0 * noise, 100.0 * wanted);
                (done(needed.min(all)), said)
            }
            // The end is not predictable yet.
            (Some(_), None) => (0.0, format!("{samples} samples")),
            (None, _) => (done(all), format!("{samples} of {} samples", self.samples)),
        }
    }
}

/// Renders a scene to light until it has converged. The same samples give the same picture on every machine.
///
/// # Errors
/// Returns [`Cancelled`] if the user cancels.
pub fn render_until(
    scene: &Scene,
    registry: &Registry,
    settings: &Settings,
    until: Until,
    odd: &AtomicBool,
    progress: &Progress,
) -> Result<(Picture, Reached), Cancelled> {
    if !scene.rests_on_samples(registry) {
        let picture = render_samples(scene, registry, settings, LightSamples::default(), odd);
        return Ok((picture, Reached { samples: 0, noise: None }));
    }
    if scene.is_exact(registry) {
        let picture = render_samples(scene, registry, settings, LightSamples::of(1), odd);
        progress.step(1.0, "1 sample")?;
        return Ok((picture, Reached { samples: 1, noise: Some(0.0) }));
    }
    let pixels = settings.width as usize * settings.height as usize;
    let mut mean = vec![Vec4::ZERO; pixels];
    // Of the luminance of blocks: the sum of squares about the mean, after B. Welford (1962).
    let mut squares = vec![0.0f64; pixels];
    let (mut taken, mut blocks, mut noise) = (0, 0u32, None);
    while taken < until.samples.max(1) {
        let count = BLOCK.min(until.samples.max(1) - taken);
        let samples = LightSamples { first: taken, count };
        let block = render_samples(scene, registry, settings, samples, odd);
        taken += count;
        // A last block with fewer samples is less reliable, and is left out of the estimate.
        let is_whole = count == BLOCK;
        blocks += u32::from(is_whole);
        let share = count as f32 / taken as f32;
        for ((mean, squares), pixel) in mean.iter_mut().zip(&mut squares).zip(block.pixels) {
            let of = |p: Vec4| f64::from(luminance(p.truncate()));
            let [before, new] = [*mean, pixel].map(of);
            *mean += (pixel - *mean) * share;
            if is_whole {
                *squares += (new - before) * (new - of(*mean));
            }
        }
        if blocks >= ENOUGH {
            noise = Some(noise_of(&mean, &squares, blocks, taken));
        }
        let (done, said) = until.progress(Reached { samples: taken, noise });
        progress.step(done, &said)?;
        // If nobody asks for a noise, only a picture without any ends early, as where all that spreads light is out of sight: its
        // blocks agree to the bit. Darkness may be light that has not been found yet.
        let is_lit = || mean.iter().any(|pixel| luminance(pixel.truncate()) > 0.0);
        let is_enough =
            |noise: f32| until.noise.map_or_else(|| noise == 0.0 && is_lit(), |enough| noise <= enough);
        if noise.is_some_and(is_enough) {
            break;
        }
    }
    let picture = Picture { width: settings.width, height: settings.height, pixels: mean };
    Ok((picture, Reached { samples: taken, noise }))
}

/// See [`Until::noise`].
fn noise_of(mean: &[Vec4], squares: &[f64], blocks: u32, samples: u32) -> f32 {
    let mut sums = [0.0f64; 3];
    for (mean, squares) in mean.iter().zip(squares) {
        let here = f64::from(luminance(mean.truncate()));
        if here > 0.0 && *squares > 0.0 {
            let of = [f64::from(BLOCK) * squares, here, 1.0];
            sums.iter_mut().zip(of).for_each(|(sum, part)| *sum += part);
        }
    }
    if sums[1] > 0.0 { relative_error(sums, blocks, samples) } else { 0.0 }
}

/// The noise of a picture from sums over its pixels that have any: the squares about the mean luminance, counted once
/// for each sample of their block; the mean luminance; the number of pixels. It is the noise of a picture of
/// several blocks that have this many samples together.
pub(crate) fn relative_error([squares, luminance, pixels]: [f64; 3], blocks: u32, samples: u32) -> f32 {
    let variance = squares / f64::from(blocks - 1) / f64::from(samples);
    ((variance / pixels).sqrt() / (luminance / pixels)) as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        parameter::Value,
        testing::shared::{SMALL, lit, until},
    };

    #[test]
    fn samples_in_blocks_are_the_samples_at_once() {
        let registry = Registry::builtin();
        let scene = lit(&registry);
        let odd = AtomicBool::default();
        let (picture, reached) = until(&scene, &registry, 72, None);
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
    fn ways_through_a_rough_body_are_samples_under_any_light() {
        let registry = Registry::builtin();
        let glass = |roughness: f32| {
            let mut scene = Scene { reflection_model: "glass".to_owned(), ..Scene::default() };
            for object in &mut scene.objects {
                object.material.set("roughness", Value::Number(roughness));
            }
            scene
        };
        let (once, _) = until(&glass(0.5), &registry, 1, None);
        let (often, reached) = until(&glass(0.5), &registry, 32, None);
        assert_eq!(reached.samples, 32);
        assert!(once.pixels != often.pixels);
        // A smooth one leads light nowhere by chance, and one that nobody sees does not count.
        assert_eq!(until(&glass(0.0), &registry, 32, None).1.samples, 0);
        let mut hidden = glass(0.5);
        hidden.objects.iter_mut().for_each(|object| object.visible = false);
        assert!(!hidden.rests_on_samples(&registry));
    }

    #[test]
    fn noise_is_the_standard_error_over_the_mean() {
        // Pixels of the mean luminance 2, four blocks with the sums of squares 12 and 3: variances of the mean 1 and 0.25. One
        // without any is a lamp, and does not count.
        let mean = [Vec4::new(2.0, 2.0, 2.0, 1.0); 3];
        let noise = noise_of(&mean, &[12.0, 3.0, 0.0], 4, 4 * BLOCK);
        assert!((noise - 0.625f32.sqrt() / 2.0).abs() < 1e-6, "{noise}");
        assert_eq!(noise_of(&[Vec4::ZERO], &[0.0], 4, 4 * BLOCK), 0.0, "darkness has no noise");
    }

    #[test]
    fn a_lamp_in_the_picture_does_not_hide_the_noise() {
        let registry = Registry::builtin();
        let without = lit(&registry);
        let mut with = without.clone();
        let mut lamp = without.lights[0].clone();
        let eye = without.observer;
        // Before the object and towards the observer: it lights nothing.
        let ahead = eye.direction.normalize();
        lamp.position = Some(eye.position + 2.0 * ahead + 0.7 * ahead.any_orthonormal_vector());
        lamp.direction = Some(-ahead);
        lamp.parameters.set("width", Value::Number(0.3));
        lamp.intensity = 1e4;
        lamp.parameters.set("visible", Value::Choice("true".into()));
        with.lights.push(lamp);
        let noise = |scene: &Scene| until(scene, &registry, 64, None);
        let [(dark, plain), (bright, lamp)] = [noise(&without), noise(&with)];
        let brightest = |picture: &Picture| picture.pixels.iter().map(|p| p.x).fold(0.0, f32::max);
        assert!(brightest(&bright) > 100.0 * brightest(&dark), "the lamp is seen");
        let ratio = lamp.noise.expect("known") / plain.noise.expect("known");
        assert!((0.5..2.0).contains(&ratio), "{ratio}");
    }

    #[test]
    fn a_few_samples_more_tell_no_more_noise() {
        let registry = Registry::builtin();
        let scene = lit(&registry);
        let noise = |samples: u32| until(&scene, &registry, samples, None).1.noise.expect("enough samples");
        let whole = noise(64);
        for samples in [65, 72, 79] {
            let ratio = noise(samples) / (whole * (64.0 / samples as f32).sqrt());
            assert!((0.95..1.05).contains(&ratio), "{samples}: {ratio}");
        }
        // One more block gives another estimate.
        assert_ne!(noise(80), whole * 0.8f32.sqrt());
    }

    #[test]
    fn noise_does_not_depend_on_the_strength_of_light() {
        let registry = Registry::builtin();
        let noise = |strength: f32| {
            let mut scene = lit(&registry);
            scene.lights[0].intensity *= strength;
            until(&scene, &registry, 64, None).1.noise.expect("enough samples")
        };
        let usual = noise(1.0);
        assert!((noise(1e22) / usual - 1.0).abs() < 1e-3, "{} {usual}", noise(1e22));
    }

    #[test]
    fn without_light_with_extent_the_picture_is_the_same_bits() {
        let registry = Registry::builtin();
        let scene = Scene::default();
        let (picture, reached) = until(&scene, &registry, 256, None);
        assert_eq!(reached, Reached { samples: 0, noise: None });
        assert_eq!(picture, crate::reference::render(&scene, &registry, &SMALL));
    }

    #[test]
    fn progress_is_told_block_by_block_and_it_can_be_cancelled() {
        let registry = Registry::builtin();
        let (scene, odd) = (lit(&registry), AtomicBool::default());
        let told = std::cell::RefCell::new(Vec::new());
        let tell = |done: f32, what: &str| told.borrow_mut().push((done, what.to_owned()));
        let watched = |until, most: usize| {
            told.borrow_mut().clear();
            let cancelled = || told.borrow().len() >= most;
            let progress = Progress { tell: &tell, cancelled: &cancelled };
            render_until(&scene, &registry, &SMALL, until, &odd, &progress).map(|(_, reached)| reached)
        };
        let end = watched(Until { samples: 40, noise: None }, 9);
        assert_eq!(end.map(|reached| reached.samples), Ok(40));
        let said = |done, what: &str| (done, what.to_owned());
        let expected =
            [said(0.4, "16 of 40 samples"), said(0.8, "32 of 40 samples"), said(1.0, "40 of 40 samples")];
        assert_eq!(*told.borrow(), expected);
        assert_eq!(watched(Until { samples: 4096, noise: None }, 2), Err(Cancelled));
        assert_eq!(told.borrow().len(), 2);
        // If noise decides, the end is estimated from it.
        let end = watched(Until { samples: 4096, noise: Some(0.002) }, 999);
        let told = told.borrow();
        assert!(told[..3].iter().all(|(done, _)| *done == 0.0) && told[3].0 > 0.0, "{told:?}");
        assert_eq!(told.last().map(|(done, _)| *done), Some(1.0), "{told:?}");
        assert!(told.last().is_some_and(|(_, what)| what.ends_with(", until 0.20 %")), "{told:?} {end:?}");
    }
}
