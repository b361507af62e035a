//! The noise of converging pictures, measured on the GPU: the root mean square of the standard error of the
//! luminance over all pixels in which frames differ, divided by their mean luminance. Frames are more evenly
//! distributed together than alone, so it is an overestimate.
//!
//! The pass that adds a frame to the mean updates the sum of the squares about the mean, after B. Welford
//! (1962). From time to time these are summed over the picture, and read back asynchronously.

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
    converge::Converged,
    pass::{Compute, buffer},
    view::Drawing,
};
use crate::{caught::lock, reference::relative_error};

/// Number of workgroups that sum, each over some of the rows.
const GROUPS: u32 = 64;
/// Size of their output, in bytes.
const BYTES: u64 = GROUPS as u64 * 16;
/// Minimum number of frames for estimating noise.
const ENOUGH: u32 = 4;
/// Number of samples between two measurements.
const BETWEEN: u32 = 16;

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
    /// `None` if it cannot be estimated.
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
        self.known(view).filter(|known| known.frame >= drawing.began)?.noise
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
pub(super) struct Frame {
    /// The view in the main world.
    pub(super) view: Entity,
    pub(super) number: u64,
    /// Number of samples in the mean, including those of the frame, and the target.
    pub(super) converged: Converged,
    /// Number of samples in the frame.
    pub(super) count: u32,
}

/// A picture to which a frame was added.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grown {
    pub(super) frame: Frame,
    /// Number of frames in the mean.
    pub(super) frames: u32,
}

impl Grown {
    fn is_measured(self) -> bool {
        let (Frame { converged, count, .. }, step) = (self.frame, |samples: u32| samples / BETWEEN);
        let grows = step(converged.done) > step(converged.done - count);
        self.frames >= ENOUGH && (converged.is_done() || grows)
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
        noise: &Noise,
    ) {
        let Frame { view, number: frame, converged, .. } = grown.frame;
        if !grown.is_measured() {
            if converged.is_done() {
                noise.tell(view, Known { frame, noise: None });
            }
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
            let Frame { view, number: frame, converged, .. } = grown.frame;
            let known = sums.and_then(|bytes| noise_of(&bytes, grown.frames, converged.done));
            noise.tell(view, Known { frame, noise: known });
        });
    }
}

/// The noise from the sums of the workgroups; `None` for an empty picture.
fn noise_of(bytes: &[u8], frames: u32, samples: u32) -> Option<f32> {
    let mut sums = [0.0f64; 3];
    for [squares, luminance, pixels, _] in bytes.as_chunks::<4>().0.as_chunks::<4>().0 {
        for (sum, part) in sums.iter_mut().zip([squares, luminance, pixels]) {
            *sum += f64::from(f32::from_le_bytes(*part));
        }
    }
    Some(relative_error(sums, frames, samples)).filter(|noise| noise.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_is_the_standard_error_over_the_mean() {
        // Two groups with one pixel each, of luminance 2; four frames of two samples, squares 12 and 0 in
        // each frame.
        let group = |squares: f32| [2.0 * squares, 2.0, 1.0, 0.0].map(f32::to_le_bytes).concat();
        let bytes = [group(12.0), group(0.0)].concat();
        let noise = noise_of(&bytes, 4, 8).expect("something is seen");
        assert!((noise - 0.5f32.sqrt() / 2.0).abs() < 1e-6, "{noise}");
        assert_eq!(noise_of(&[0; 32], 4, 8), None, "nothing is seen");
    }

    #[test]
    fn it_is_measured_now_and_then_and_at_the_end() {
        let entity = Entity::PLACEHOLDER;
        let grown = |frames, done, count| {
            let converged = Converged { done, total: 100 };
            Grown { frame: Frame { view: entity, number: 1, converged, count }, frames }
        };
        for (frames, done, count, is) in [
            (1, 1, 1, false),
            (9, 15, 8, false),
            (9, 16, 1, true),
            (9, 18, 8, true),
            (3, 16, 8, false),
            (9, 100, 4, true),
        ] {
            assert_eq!(grown(frames, done, count).is_measured(), is, "{frames} {done} {count}");
        }
    }
}
