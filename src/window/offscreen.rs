//! Views drawn off screen, for pictures of another size or with another background than the window shows.
//!
//! The CPU renderer draws them, which tells its progress and can be stopped. Models that it cannot run, and edited
//! shaders, which it ignores, are drawn by a renderer of their own on the GPU; the window goes on meanwhile.

use std::sync::atomic::AtomicBool;

use crate::{
    caption::Sampled,
    channel::Setting,
    compare::{self, Shown, View},
    linear::MAX_PIXELS,
    optics::TermSelection,
    progress::{Cancelled, Progress},
    reference::{Settings, Until, ignored_edits, not_on_cpu},
    registry::Registry,
    render::capture::gpu::{GpuRenderer, Output},
    scene::Scene,
};

/// Why a view was not drawn.
#[derive(Debug, thiserror::Error)]
pub(super) enum Undrawn {
    /// The user cancelled.
    #[error("cancelled")]
    Cancelled,
    /// For the given reason.
    #[error("{0}")]
    Failed(String),
}

impl From<Cancelled> for Undrawn {
    fn from(_: Cancelled) -> Self {
        Self::Cancelled
    }
}

impl From<compare::Undrawn> for Undrawn {
    fn from(undrawn: compare::Undrawn) -> Self {
        match undrawn {
            compare::Undrawn::Cancelled => Self::Cancelled,
            compare::Undrawn::TooLarge(_) | compare::Undrawn::NoRoom(..) => Self::of(undrawn),
        }
    }
}

impl Undrawn {
    fn of(error: impl ToString) -> Self {
        Self::Failed(error.to_string())
    }
}

/// A view to draw.
pub(super) struct OffScreen<'a> {
    /// The scene of the view.
    pub(super) seen: &'a Scene,
    pub(super) registry: &'a Registry,
    pub(super) size: [u32; 2],
    pub(super) samples: u32,
    pub(super) terms: TermSelection,
    /// The debug channel that it shows instead of the picture.
    pub(super) channel: Option<Setting>,
    /// True if its light and its coverage are needed as well.
    pub(super) lit: bool,
}

impl OffScreen<'_> {
    /// Draws the view. Returns also how lights with extent were sampled, if there are some.
    pub(super) fn draw(&self, progress: &Progress) -> Result<(Shown, Option<Sampled>), Undrawn> {
        progress.step(0.0, "drawing")?;
        let needs_gpu = self.needs_gpu();
        let drawn = if needs_gpu { self.on_gpu(progress)? } else { self.on_cpu(progress)? };
        // An endless function of a custom model is detected only when it runs.
        if let Some((_, why)) = not_on_cpu(self.seen, self.registry).filter(|_| !needs_gpu) {
            return Err(Undrawn::Failed(why));
        }
        progress.step(1.0, "drawn")?;
        Ok(drawn)
    }

    /// True if the CPU would draw it otherwise than the window, or not at all.
    pub(super) fn needs_gpu(&self) -> bool {
        not_on_cpu(self.seen, self.registry).is_some() || !ignored_edits(self.registry, self.seen).is_empty()
    }

    fn on_cpu(&self, progress: &Progress) -> Result<(Shown, Option<Sampled>), Undrawn> {
        let Self { seen, registry, size: [width, height], samples, terms, channel, lit } = *self;
        let settings = Settings { width, height, samples, terms };
        let view = View { scene: seen, registry, settings, channel, until: Until::default(), lit };
        Ok(view.draw(&AtomicBool::default(), progress)?)
    }

    fn on_gpu(&self, progress: &Progress) -> Result<(Shown, Option<Sampled>), Undrawn> {
        let Self { seen, registry, size: [width, height], samples, terms, channel, lit } = *self;
        if width as usize * height as usize > MAX_PIXELS {
            let said = format!("{width}×{height} are too many pixels for the GPU");
            return Err(Undrawn::Failed(format!("{said}; at most {MAX_PIXELS} are possible")));
        }
        let samples = if samples > 1 { 4 } else { 1 };
        let renderer = GpuRenderer::extended(width, height, samples, Output::Display, |app| {
            app.insert_resource(registry.clone());
        });
        let mut renderer = renderer.map_err(Undrawn::of)?;
        renderer.save_memory();
        renderer.set_scene(seen.clone());
        renderer.set_terms(terms);
        renderer.set_channel(channel);
        let reached = renderer.settle_until(None, progress).map_err(Undrawn::of)?;
        if let Some(problem) = renderer.shader_problem() {
            return Err(Undrawn::of(problem));
        }
        let rgb8 = renderer.read_rgb8().map_err(Undrawn::of)?;
        let sampled = seen.rests_on_samples(registry).then_some(reached);
        let shown = Shown::of_codes(width, height, rgb8).map_err(Undrawn::of)?;
        Ok((if lit { shown.covering_objects(seen, registry, samples.into()) } else { shown }, sampled))
    }
}
