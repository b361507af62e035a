//! Pictures: the light of two views, drawn small by the CPU renderer.

use std::sync::atomic::AtomicBool;

use glam::{Vec3, Vec4};

use super::{
    search::{Given, Target},
    sides::Side,
};
use crate::{
    parameter::Values,
    reference::{self, LightSamples, Settings},
    registry::Registry,
    scene::{Scene, has_extent},
};

/// Height of the pictures, in pixels.
pub const HEIGHT: u32 = 96;
/// Width of the pictures, with the usual aspect ratio of 16 to 9.
pub const WIDTH: u32 = HEIGHT * 16 / 9;

/// Number of samples of lights with extent: what they leave out is missing in both pictures alike.
const SAMPLES: u32 = 32;

/// The light of a scene.
fn light(scene: &Scene, registry: &Registry, settings: &Settings) -> Vec<Vec4> {
    reference::render_samples(scene, registry, settings, LightSamples::of(SAMPLES), &AtomicBool::new(false))
        .pixels
}

/// The picture of a view, for comparison with that of view A.
pub(super) struct Picture<'r> {
    scene: Scene,
    /// The materials of the objects.
    own: Vec<Values>,
    registry: &'r Registry,
    settings: Settings,
    /// The pixels covered by objects in either view, with their light in view A.
    wanted: Vec<(usize, Vec3)>,
}

impl<'r> Picture<'r> {
    /// The picture of the second view, for comparison with the first; `None` if no object covers a pixel.
    pub(super) fn new([a, b]: [&Side; 2], registry: &'r Registry) -> Option<Self> {
        let settings = |side: &Side| Settings { width: WIDTH, height: HEIGHT, samples: 1, terms: side.terms };
        let [of_a, of_b] = [a, b].map(|side| light(&side.scene, registry, &settings(side)));
        let covered = |(i, (a, b)): (usize, (&Vec4, &Vec4))| (a.w.max(b.w) > 0.0).then(|| (i, a.truncate()));
        let wanted: Vec<_> = of_a.iter().zip(&of_b).enumerate().filter_map(covered).collect();
        if wanted.is_empty() {
            return None;
        }
        let own = b.scene.objects.iter().map(|object| object.material.clone()).collect();
        Some(Self { scene: b.scene.clone(), own, registry, settings: settings(b), wanted })
    }

    /// Number of responses of the models in a picture.
    pub(super) fn responses(&self) -> usize {
        let samples = |light| if has_extent([light], self.registry) { SAMPLES as usize } else { 1 };
        self.wanted.len() * self.scene.shining().map(samples).sum::<usize>()
    }
}

impl Target for Picture<'_> {
    fn count(&self) -> usize {
        3 * self.wanted.len()
    }

    fn differences(&mut self, values: &Given, to: &mut [f64]) {
        for (object, own) in self.scene.objects.iter_mut().zip(&self.own) {
            object.material.clone_from(own);
            values.iter().for_each(|(name, value)| object.material.set(*name, value.clone()));
        }
        let pixels = light(&self.scene, self.registry, &self.settings);
        for (to, (i, wanted)) in to.as_chunks_mut::<3>().0.iter_mut().zip(&self.wanted) {
            *to = (pixels[*i].truncate() - *wanted).to_array().map(f64::from);
        }
    }
}
