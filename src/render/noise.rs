//! The noise of converging pictures, measured on the GPU: the root mean square of the standard error of the
//! luminance over all pixels in which samples differ, divided by their mean luminance. It is estimated from blocks of as
//! many samples as on the CPU, so that it is the same number: see [`Until::noise`](crate::reference::Until::noise).
//!
//! A frame has fewer samples than a block. The pass that adds it to the mean keeps the mean luminance before the
//! block; at the end of the block, it updates the sum of the squares about the mean, after B. Welford (1962), in
//! which x, the luminance of the block, is eliminated: of n samples, m before the block,
//! (n − m) (x − mean before) (x − mean) = n m / (n − m) (mean − mean before)².
//! These sums are added up over the picture after each block, and read back asynchronously.

use std::{
    collections::HashMap,
    sync::{Arc, Mutex},
};

use bevy::{
    prelude::*,
    render::{
        Render, RenderApp, RenderSystems,
        render_resource::{
            binding_types::{storage_buffer_sized, texture_2d},
            *,
        },
        renderer::RenderDevice,
    },
};

use super::{
    converge::{Converged, Part},
    pass::{Compute, buffer},
    view::Drawing,
};
use crate::{
    caught::lock,
    reference::{BLOCK, ENOUGH, relative_error},
};

/// Number of workgroups that sum, each over some of the rows.
const GROUPS: u32 = 64;
/// Size of their output, in bytes.
const BYTES: u64 = GROUPS as u64 * 16;

/// Measures the noise of converging views.
pub(super) fn plugin(app: &mut App) {
    // Without drawing there are no measurements, and nobody waits for them.
    let noise = Noise::default();
    let Some(render) = app.get_sub_app_mut(RenderApp) else { return };
    render
        .insert_resource(noise.clone())
        .init_resource::<Measuring>()
        .add_systems(Render, read.in_set(RenderSystems::Cleanup));
    app.insert_resource(noise);
}

/// The noise of the pictures of views.
#[derive(Clone, Debug, Default, Resource)]
pub struct Noise(Arc<Mutex<HashMap<Entity, Known>>>);

/// The known noise of a view's picture.
#[derive(Clone, Copy, Debug)]
struct Known {
    /// Number of the picture's last frame.
    frame: u64,
    /// `None` if it cannot be estimated, as in a picture of nothing.
    noise: Option<f32>,
}

impl Noise {
    fn known(&self, view: Entity) -> Option<Known> {
        lock(&self.0).get(&view).copied()
    }

    fn tell(&self, view: Entity, known: Known) {
        lock(&self.0).insert(view, known);
    }

    /// Forgets views that no longer exist.
    pub(super) fn keep(&self, exists: impl Fn(Entity) -> bool) {
        lock(&self.0).retain(|view, _| exists(*view));
    }

    /// The noise of a view's picture as a fraction of its mean luminance, if known.
    #[must_use]
    pub fn of(&self, view: Entity, drawing: &Drawing) -> Option<f32> {
        self.measured(view, drawing)?.filter(|noise| noise.is_finite())
    }

    /// The last measurement of a view's picture: not a number if its light is not finite, `None` if it shows nothing.
    pub(super) fn measured(&self, view: Entity, drawing: &Drawing) -> Option<Option<f32>> {
        self.known(view).filter(|known| known.frame >= drawing.began).map(|known| known.noise)
    }

    /// True if a picture has all its samples, and its known noise is older.
    #[must_use]
    pub fn is_awaited(&self, view: Entity, drawing: &Drawing) -> bool {
        let older = |known: Known| (drawing.began..drawing.drawn()).contains(&known.frame);
        drawing.rests() && self.known(view).is_some_and(older)
    }
}

/// A frame that is added to the mean of a view.
#[derive(Clone, Copy, Debug)]
pub(super) struct AddedFrame {
    /// The view in the main world.
    pub(super) view: Entity,
    pub(super) number: u64,
    /// Number of samples in the mean, including those of the frame, and the target.
    pub(super) converged: Converged,
    /// The samples in the frame.
    pub(super) part: Part,
}

/// The blocks of samples in the mean of a view. A block that is not whole, as at the beginning of a picture that begins
/// amid one, is in the mean, but not in the estimate of the noise.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Blocks {
    /// Number of whole blocks.
    whole: u32,
    /// Number of samples in the last block.
    last: u32,
    /// True if the last block is at its end.
    ended: bool,
}

impl Blocks {
    /// Adds a frame.
    pub(super) fn add(&mut self, frame: &AddedFrame) {
        let AddedFrame { part: Part { first, count }, converged: Converged { done, total }, .. } = *frame;
        if done == count {
            *self = Self::default();
        }
        self.last = count + if self.ended { 0 } else { self.last };
        let end = first + count;
        self.ended = end.is_multiple_of(BLOCK) || end == total || done >= total;
        self.whole += u32::from(self.completes());
    }

    /// True if the frame added last completes a whole block.
    fn completes(self) -> bool {
        self.ended && self.last == BLOCK
    }

    /// The numbers that `mean.wgsl` needs to add the last frame: its part in the mean, the weight of the square of
    /// the change since the block began, and 1 at the end of a block.
    pub(super) fn weights(self, frame: &AddedFrame) -> [f32; 4] {
        let done = frame.converged.done;
        let [all, before] = [done, done.saturating_sub(BLOCK)].map(|samples| samples as f32);
        let squares = if self.completes() { all * before / BLOCK as f32 } else { 0.0 };
        [frame.part.count as f32 / all, squares, f32::from(u8::from(self.ended)), 0.0]
    }
}

/// A picture to which a frame was added.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grown {
    pub(super) frame: AddedFrame,
    pub(super) blocks: Blocks,
}

impl Grown {
    fn is_measured(self) -> bool {
        self.blocks.whole >= ENOUGH && (self.frame.converged.is_done() || self.blocks.completes())
    }
}

/// The sums that the GPU calculates in this frame.
#[derive(Default, Resource)]
pub(super) struct Measuring {
    pass: Option<Compute>,
    sums: Vec<(Buffer, Grown)>,
}

impl Measuring {
    /// Sums the squares and the mean of a picture, if a measurement is due.
    pub(super) fn measure(
        &mut self,
        grown: Grown,
        [mean, squares]: [&TextureView; 2],
        device: &RenderDevice,
        encoder: &mut CommandEncoder,
    ) {
        if !grown.is_measured() {
            return;
        }
        let pass = self.pass.get_or_insert_with(|| {
            let float = texture_2d(TextureSampleType::Float { filterable: false });
            let entries = BindGroupLayoutEntries::sequential(
                ShaderStages::COMPUTE,
                (float, float, storage_buffer_sized(false, None)),
            );
            Compute::new(device, "noise", include_str!("noise.wgsl").into(), "sum", &entries)
        });
        let sums = buffer(device, "noise", BYTES, BufferUsages::STORAGE | BufferUsages::COPY_SRC);
        let read = buffer(device, "noise", BYTES, BufferUsages::MAP_READ | BufferUsages::COPY_DST);
        let entries = BindGroupEntries::sequential((mean, squares, sums.as_entire_buffer_binding()));
        pass.run(device, encoder, &entries, GROUPS);
        encoder.copy_buffer_to_buffer(&sums, 0, &read, 0, BYTES);
        self.sums.push((read, grown));
    }
}

/// Requests the sums once the commands are submitted to the GPU.
fn read(mut measuring: ResMut<Measuring>, noise: Res<Noise>) {
    for (buffer, grown) in measuring.sums.drain(..) {
        let (noise, mapped) = (noise.clone(), buffer.clone());
        buffer.slice(..).map_async(MapMode::Read, move |result| {
            let sums = result.is_ok().then(|| mapped.slice(..).get_mapped_range().to_vec());
            let AddedFrame { view, number: frame, converged, .. } = grown.frame;
            let known = sums.and_then(|bytes| noise_of(&bytes, grown.blocks.whole, converged.done));
            noise.tell(view, Known { frame, noise: known });
        });
    }
}

/// The noise from the sums of the workgroups; `None` for a picture of nothing.
fn noise_of(bytes: &[u8], blocks: u32, samples: u32) -> Option<f32> {
    let mut sums = [0.0f64; 4];
    for group in bytes.as_chunks::<4>().0.as_chunks::<4>().0 {
        for (sum, part) in sums.iter_mut().zip(group) {
            *sum += f64::from(f32::from_le_bytes(*part));
        }
    }
    let [squares, luminance, pixels, seen] = sums;
    let noise =
        || if pixels > 0.0 { relative_error([squares, luminance, pixels], blocks, samples) } else { 0.0 };
    (seen > 0.0).then(noise)
}

#[cfg(test)]
mod tests {
    use std::ops::Range;

    use super::*;
    use crate::testing::random;

    #[test]
    fn noise_is_the_standard_error_over_the_mean() {
        // Two groups with one pixel each, of luminance 2; four blocks of two samples, squares 12 and 0 in
        // each block.
        let group = |squares: f32| [2.0 * squares, 2.0, 1.0, 1.0].map(f32::to_le_bytes).concat();
        let bytes = [group(12.0), group(0.0)].concat();
        let noise = noise_of(&bytes, 4, 8).expect("something is seen");
        assert!((noise - 0.5f32.sqrt() / 2.0).abs() < 1e-6, "{noise}");
        assert_eq!(noise_of(&[0; 32], 4, 8), None, "nothing is seen");
        let same = [0.0, 0.0, 0.0, 9.0].map(f32::to_le_bytes).concat();
        assert_eq!(noise_of(&same, 4, 8), Some(0.0), "nothing depends on chance");
    }

    /// The frames of a picture of `total` samples that begins with sample `first`, each with at most `most`.
    fn frames(first: u32, total: u32, most: u32) -> Vec<AddedFrame> {
        let (mut next, mut done) = (first, 0);
        let mut frames = Vec::new();
        while done < total {
            let aligned = if next == 0 { most } else { 1 << next.trailing_zeros() };
            let room = most.min(total - done).min(total - next);
            let part = Part { first: next, count: aligned.min(1 << room.ilog2()) };
            (next, done) = ((next + part.count) % total, done + part.count);
            let converged = Converged { done, total };
            frames.push(AddedFrame { view: Entity::PLACEHOLDER, number: 1, converged, part });
        }
        frames
    }

    #[test]
    fn squares_are_those_of_whole_blocks_whatever_the_frames() {
        let mut seed = 7;
        let values: [f64; 160] = std::array::from_fn(|_| f64::from(random(&mut seed)));
        let mean_of = |samples: Range<u32>| {
            let values = &values[samples.start as usize..samples.end as usize];
            values.iter().sum::<f64>() / values.len() as f64
        };
        // The last picture begins amid a block: two parts of that are in the mean alone.
        for (first, total, most, whole) in
            [(0, 160, 8, 10), (0, 160, 1, 10), (0, 100, 4, 6), (48, 160, 8, 10), (37, 160, 8, 9)]
        {
            let case = format!("{first} {total} {most}");
            let (mut blocks, mut mean, mut before) = (Blocks::default(), 0.0, 0.0);
            let (mut squares, mut twin) = (0.0, 0.0);
            for frame in frames(first, total, most) {
                blocks.add(&frame);
                let [share, weight, ends, _] = blocks.weights(&frame).map(f64::from);
                let Part { first, count } = frame.part;
                let last = mean;
                mean += (mean_of(first..first + count) - mean) * share;
                squares += weight * (mean - before).powi(2);
                twin += weight * (mean - last).powi(2);
                if ends > 0.0 {
                    before = mean;
                }
            }
            assert_eq!(blocks.whole, whole, "{case}");
            assert!((mean - mean_of(0..total)).abs() < 1e-6, "{case}");
            let starts = (0..whole).map(|block| block * BLOCK);
            let means: Vec<_> = starts.map(|start| mean_of(start..start + BLOCK)).collect();
            let middle = means.iter().sum::<f64>() / means.len() as f64;
            let expected = f64::from(BLOCK) * means.iter().map(|x| (x - middle).powi(2)).sum::<f64>();
            if first != 37 {
                assert!((squares / expected - 1.0).abs() < 1e-4, "{case}: {squares} {expected}");
                assert!(twin < 0.9 * expected, "{case}: the wrong twin, of frames: {twin} {expected}");
            }
        }
    }

    #[test]
    fn it_is_measured_now_and_then_and_at_the_end() {
        let entity = Entity::PLACEHOLDER;
        let grown = |whole, last, done| {
            let (converged, part) = (Converged { done, total: 100 }, Part { first: done - 4, count: 4 });
            let blocks = Blocks { whole, last, ended: done.is_multiple_of(BLOCK) || done == 100 };
            Grown { frame: AddedFrame { view: entity, number: 1, converged, part }, blocks }
        };
        for (whole, last, done, is) in [
            (1, BLOCK, 16, false),
            (4, BLOCK, 64, true),
            (4, 4, 68, false),
            (3, 12, 64, false),
            (5, 12, 96, false),
            (6, 4, 100, true),
        ] {
            assert_eq!(grown(whole, last, done).is_measured(), is, "{whole} {last} {done}");
        }
    }
}
