//! Pictures by the GPU renderer.

use std::path::PathBuf;

use bevy::app::App;

use super::{
    super::{
        finite::{self, has_untested},
        workshop::invalid,
    },
    Order, Pictures,
};
use crate::files::Shown as _;
use crate::{
    channel::{Layer, Setting, settle},
    compare::{Cell, Shown},
    explain::finite::Tried,
    failure::Failure,
    linear::Channels,
    optics::colour::Encoding,
    progress::Progress,
    reference::Reached,
    reflection::ends::check_that_it_ends,
    registry::Registry,
    render::{
        capture::gpu::{GpuError, GpuRenderer, Output},
        trial::{
            Bench,
            process::{Budget, TrialProcess},
        },
    },
};

/// Maximum number of objects whose models are tried on the CPU before the GPU draws them.
const MOST_TRIED: usize = 64;

/// Draws pictures, one after the other.
#[derive(Default)]
pub(super) struct Gpu {
    /// The program that tries shaders in a separate process.
    trial_program: Option<PathBuf>,
    /// The renderer of the last picture, with its size, samples and output: the next picture likely has the same.
    last: Option<((u32, u32, u8, Output), GpuRenderer)>,
    /// The results on the CPU of models that tests do not cover.
    tried: Tried,
}

impl Gpu {
    pub(super) fn new(trial_program: Option<PathBuf>) -> Self {
        Self { trial_program, ..Self::default() }
    }

    /// The renderer for a part of a picture.
    fn renderer(&mut self, order: &Order, output: Output) -> Result<&mut GpuRenderer, Failure> {
        let Order { part, registry, .. } = *order;
        let Cell { width, height, .. } = part.cell;
        let samples = if order.samples == 4 && output == Output::Display { 4 } else { 1 };
        let key = (width, height, samples, output);
        // An endless loop on a GPU cannot be stopped.
        for object in part.scene.objects.iter().take(MOST_TRIED) {
            if let Some(model) = registry.model(part.scene.model_of(object)) {
                check_that_it_ends(model, &object.material, Encoding::Srgb)
                    .map_err(|e| failed(order, e.into()))?;
            }
        }
        if self.last.as_ref().is_none_or(|(last, _)| *last != key) {
            self.last = None;
            let renderer = GpuRenderer::extended(width, height, samples, output, |app| {
                try_apart(app, registry, self.trial_program.clone());
                app.insert_resource(registry.clone());
            });
            let mut renderer = renderer.map_err(|e| failed(order, e))?;
            renderer.save_memory();
            self.last = Some((key, renderer));
        }
        match &mut self.last {
            Some((_, renderer)) => {
                renderer.set_light_samples(order.until.samples);
                Ok(renderer)
            }
            None => Err(failed(order, GpuError::NoAdapter)),
        }
    }
}

impl Pictures for Gpu {
    fn draw(
        &mut self,
        order: &Order,
        channel: Option<Setting>,
        progress: &Progress,
    ) -> Result<(Shown, Reached, Option<String>), Failure> {
        let Order { part, registry, .. } = *order;
        let Cell { width, height, .. } = part.cell;
        let failed = |e: GpuError| failed(order, e);
        let renderer = self.renderer(order, Output::Display)?;
        renderer.set_terms(part.terms);
        let mut noise = order.until.noise;
        let mut measured = None;
        if let Some(setting) = channel.filter(|_| noise.is_some()) {
            // A channel takes as many samples as the picture, or as that under the light that it shows.
            let lit = setting.channel.is_picture().then(|| setting.lit(&part.scene));
            renderer.set_scene(lit.unwrap_or_else(|| part.scene.clone()));
            renderer.set_channel(None);
            let reached = renderer.settle_until(noise.take(), progress).map_err(failed)?;
            renderer.set_light_samples(reached.samples);
            measured = Some(reached);
        }
        renderer.set_scene(part.scene.clone());
        renderer.set_channel(channel);
        let drawn = renderer.settle_until(noise, progress).map_err(failed)?;
        let reached = measured.unwrap_or(drawn);
        if let Some(problem) = renderer.shader_problem() {
            return Err(invalid(registry, &problem));
        }
        let rgb8 = renderer.read_rgb8().map_err(failed)?;
        let shown =
            Shown::of_codes(width, height, rgb8).map_err(|e| failed(GpuError::Copy(e.to_string())))?;
        // Everything shipped with the program is finite.
        if !has_untested(registry) {
            return Ok((shown, reached, None));
        }
        renderer.set_light_samples(reached.samples);
        renderer.set_channel(Some(finite::channel(&part.scene, registry)));
        renderer.settle().map_err(failed)?;
        let channel = renderer.read_rgb8().map_err(failed)?;
        Ok((shown, reached, finite::remark_on_gpu(part, registry, &channel, &mut self.tried)))
    }

    fn layers(
        &mut self,
        order: &Order,
        layers: &[Layer],
        progress: &Progress,
    ) -> Result<(Channels, Option<String>), Failure> {
        let Order { part, registry, samples, .. } = *order;
        let renderer = self.renderer(order, Output::Linear)?;
        let [width, height] = renderer.size();
        let (mut channels, mut odd) = (Channels::new(width, height), false);
        for (i, layer) in layers.iter().enumerate() {
            (progress.tell)(i as f32 / layers.len() as f32, &layer.name);
            let scene = layer.scene(&part.scene);
            let (picture, is_odd) = renderer.light(layer, scene, samples).map_err(|e| failed(order, e))?;
            if let Some(problem) = renderer.shader_problem() {
                return Err(invalid(registry, &problem));
            }
            odd |= is_odd;
            channels.add(&layer.name, layer.channels, &picture.pixels);
        }
        settle(&mut channels, layers);
        let remark = odd.then(|| {
            finite::remark_on_cpu(part, registry).unwrap_or_else(|| {
                "some light is not finite: not a number became 0, infinite 1e30".to_owned()
            })
        });
        Ok((channels, remark))
    }
}

/// The failure of the GPU renderer.
fn failed(order: &Order, error: GpuError) -> Failure {
    match error {
        GpuError::Invalid(_) | GpuError::Endless(_) => error.into(),
        error => Failure::NoRenderer(format!("{}: {error}", order.file.shown())),
    }
}

/// Tries the shaders of users and of other crates in another process, since they may crash a driver.
fn try_apart(app: &mut App, registry: &Registry, program: Option<PathBuf>) {
    if has_untested(registry)
        && let Some(program) = program
        && let Some(mut bench) = app.world_mut().get_resource_mut::<Bench>()
    {
        bench.try_in(TrialProcess::new(program, Budget::default(), || {}));
    }
}
