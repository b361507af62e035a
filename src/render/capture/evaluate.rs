//! Evaluates a model's WGSL in a compute pass: the GPU's counterpart of the Rust function.

use bevy::render::{
    render_resource::{
        BindGroupEntries, BindGroupLayoutEntries, Buffer, BufferInitDescriptor, BufferUsages,
        CommandEncoderDescriptor, ShaderStages,
        binding_types::{storage_buffer_read_only_sized, storage_buffer_sized},
    },
    renderer::{RenderDevice, RenderQueue},
    settings::RenderResources,
};
use bevy::tasks::block_on;
use glam::{DVec3, Vec3};

use std::{sync::Arc, time::Duration};

use super::gpu::{GpuError, device, read_back, vector};
use crate::{
    optics::{Frame, Terms, albedo::directional_in_batches, colour::Encoding},
    parameter::Values,
    reflection::{ModelEntry, Surface, ends::ends},
    registry::compose::compose_evaluation,
    render::{
        pass::{Compute, buffer},
        trial::refused,
    },
    shader::{check, compose::Sources},
};

/// The response of a model to pairs of directions (to the light, to the viewer) in the local frame (normal
/// +z, tangent +x), calculated by its WGSL on the GPU. The shader texts come from `sources`.
///
/// # Errors
/// Returns an error without a driver, or if the model's WGSL is invalid.
pub fn evaluate(
    sources: &Sources,
    model: &ModelEntry,
    values: &Values,
    encoding: Encoding,
    pairs: &[(Vec3, Vec3)],
) -> Result<Vec<Terms>, GpuError> {
    if pairs.is_empty() {
        return Ok(Vec::new());
    }
    let mut evaluator = Evaluator::new(sources, model)?;
    evaluator.set(values, encoding);
    evaluator.evaluate(pairs)
}

/// The directional albedos of a model for views in the local frame, by its WGSL on the GPU: the directions
/// are chosen here, the responses come from the GPU, and are summed here in 64 bits.
///
/// # Errors
/// Returns the errors of [`evaluate`].
pub fn albedos(
    sources: &Sources,
    model: &ModelEntry,
    values: &Values,
    encoding: Encoding,
    views: &[Vec3],
) -> Result<Vec<DVec3>, GpuError> {
    if views.is_empty() {
        return Ok(Vec::new());
    }
    let mut evaluator = Evaluator::new(sources, model)?;
    evaluator.set(values, encoding);
    evaluator.albedos(views)
}

/// The parameters of a model in the layout of its shader. The response needs the lobe, but not the albedo.
fn row(device: &RenderDevice, model: &ModelEntry, values: &Values, encoding: Encoding) -> Buffer {
    device.create_buffer_with_data(&BufferInitDescriptor {
        label: Some("row"),
        contents: &model.row(values, encoding, false),
        usage: BufferUsages::STORAGE,
    })
}

/// The numbers of the file of a surface; of a model without a file a word that is not read.
fn file(device: &RenderDevice, model: &ModelEntry, values: &Values) -> Buffer {
    let numbers = model.table(values).map(|table| table.numbers);
    let words = numbers.as_deref().unwrap_or(&[0.0]).iter().flat_map(|number| number.to_le_bytes());
    device.create_buffer_with_data(&BufferInitDescriptor {
        label: Some("file"),
        contents: &words.collect::<Vec<_>>(),
        usage: BufferUsages::STORAGE,
    })
}

/// Size of `Pair` in `evaluate.wgsl`, in bytes: two vec3, each padded to 16.
const PAIR_BYTES: usize = 32;
/// Size of `Terms` in `terms.wgsl`, in bytes: three vec3, each padded to 16.
const ANSWER_BYTES: usize = 48;

/// Number of pairs in a batch, so that the time limit applies to a part of the work.
const BATCH: usize = 1 << 16;
/// Maximum duration of a batch; a slow model takes a second on two cores.
const PATIENCE: Duration = Duration::from_secs(30);

/// A model on the GPU that can be evaluated repeatedly with different parameters.
pub struct Evaluator {
    model: ModelEntry,
    device: RenderDevice,
    queue: RenderQueue,
    pass: Compute,
    row: Buffer,
    /// The numbers of its file.
    file: Buffer,
    /// The model on the CPU, if it is interpreted there.
    on_cpu: Option<Arc<dyn Surface>>,
    /// The model on the CPU, if it mirrors light without spreading it, which its response leaves out.
    mirror: Option<Arc<dyn Surface>>,
    patience: Duration,
}

impl Evaluator {
    /// The model with its default parameters.
    ///
    /// # Errors
    /// Returns an error without a driver, or if the model's WGSL is invalid.
    pub fn new(sources: &Sources, model: &ModelEntry) -> Result<Self, GpuError> {
        let composed = compose_evaluation(sources, model);
        check::validate(&composed).map_err(GpuError::Invalid)?;
        let RenderResources(device, queue, ..) = device()?;
        let row = row(&device, model, &Values::default(), Encoding::Srgb);
        let file = file(&device, model, &Values::default());
        // Users' shaders may ask for bindings that do not exist here.
        let scope = device.wgpu_device().push_error_scope(wgpu::ErrorFilter::Validation);
        let read = storage_buffer_read_only_sized(false, None);
        let entries = (read, read, storage_buffer_sized(false, None), read);
        let entries = BindGroupLayoutEntries::sequential(ShaderStages::COMPUTE, entries);
        let pass = Compute::new(&device, "evaluate", composed.text.as_str().into(), "evaluate", &entries);
        if let Some(error) = block_on(scope.pop()) {
            return Err(GpuError::Invalid(refused(&composed, &error)));
        }
        let (model, patience) = (model.clone(), PATIENCE);
        let (on_cpu, mirror) = (None, None);
        let mut evaluator = Self { model, device, queue, pass, row, file, on_cpu, mirror, patience };
        evaluator.set(&Values::default(), Encoding::Srgb);
        Ok(evaluator)
    }

    /// Sets the parameters for subsequent evaluations.
    pub fn set(&mut self, values: &Values, encoding: Encoding) {
        self.row = row(&self.device, &self.model, values, encoding);
        self.file = file(&self.device, &self.model, values);
        self.on_cpu = self.model.is_interpreted().then(|| self.model.instantiate(values, encoding));
        self.mirror = self.model.declaration.sharp.then(|| self.model.instantiate(values, encoding));
    }

    /// The responses to pairs of directions, in as many passes as they need.
    ///
    /// # Errors
    /// Returns an error if the results cannot be copied from the GPU, or if the model does not terminate.
    pub fn evaluate(&self, pairs: &[(Vec3, Vec3)]) -> Result<Vec<Terms>, GpuError> {
        let limit = self.device.limits().max_storage_buffer_binding_size as usize / ANSWER_BYTES;
        let mut answers = Vec::with_capacity(pairs.len());
        for chunk in pairs.chunks(limit.min(BATCH)) {
            if let Some(surface) = &self.on_cpu {
                ends(&self.model, surface.as_ref(), chunk)?;
            }
            answers.extend(self.run(chunk)?);
        }
        Ok(answers)
    }

    /// The directional albedos for views, as in [`albedos`].
    ///
    /// # Errors
    /// Returns the errors of [`evaluate`](Self::evaluate).
    pub fn albedos(&self, views: &[Vec3]) -> Result<Vec<DVec3>, GpuError> {
        /// Maximum number of views with batches in memory at a time.
        const VIEWS: usize = 64;
        let mut albedos = Vec::with_capacity(views.len());
        for views in views.chunks(VIEWS) {
            let mirrored = |v: &Vec3| {
                self.mirror.as_ref().map_or(DVec3::ZERO, |of| of.mirrored(*v, &Frame::LOCAL).as_dvec3())
            };
            let spread = directional_in_batches(views, |pairs| self.evaluate(pairs))?;
            albedos.extend(spread.into_iter().zip(views).map(|(spread, v)| spread + mirrored(v)));
        }
        Ok(albedos)
    }

    fn run(&self, pairs: &[(Vec3, Vec3)]) -> Result<Vec<Terms>, GpuError> {
        let mut input = Vec::with_capacity(pairs.len() * PAIR_BYTES);
        for v in pairs.iter().flat_map(|(l, v)| [l, v]) {
            for c in [v.x, v.y, v.z, 0.0] {
                input.extend_from_slice(&c.to_le_bytes());
            }
        }
        let device = &self.device;
        let input = device.create_buffer_with_data(&BufferInitDescriptor {
            label: Some("pairs"),
            contents: &input,
            usage: BufferUsages::STORAGE,
        });
        let size = (pairs.len() * ANSWER_BYTES) as u64;
        let empty = |usage| buffer(device, "answers", size, usage);
        let output = empty(BufferUsages::STORAGE | BufferUsages::COPY_SRC);
        let staging = empty(BufferUsages::COPY_DST | BufferUsages::MAP_READ);
        let all = [&self.row, &input, &output, &self.file];
        let [row, from, to, file] = all.map(|buffer| buffer.as_entire_buffer_binding());
        let entries = BindGroupEntries::sequential((row, from, to, file));
        let mut encoder =
            device.create_command_encoder(&CommandEncoderDescriptor { label: Some("evaluate") });
        let groups = pairs.len().div_ceil(64) as u32;
        self.pass.run(device, &mut encoder, &entries, groups);
        encoder.copy_buffer_to_buffer(&output, 0, &staging, 0, size);
        self.queue.submit([encoder.finish()]);
        Ok(read_back(device, &staging, self.patience)?
            .chunks_exact(ANSWER_BYTES)
            .zip(pairs)
            .map(|(terms, (l, v))| {
                let through = self.model.declaration.transmits && l.z * v.z < 0.0;
                Terms::of_shader([0, 16, 32].map(|at| vector(&terms[at..])), through)
            })
            .collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::registry::Registry;

    #[test]
    fn a_batch_that_takes_too_long_is_not_waited_for() {
        let registry = Registry::builtin();
        let model = registry.model("lambert").expect("built in");
        let mut sources = Sources::default();
        let slow = "var s = l.x;\n    for (var i = 0u; i < 4000u; i++) { s = sin(s + f32(i)); }\n    return Terms(vec3(s), vec3(0.0), vec3(0.0));\n}\nfn unused(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {\n";
        let original = model.declaration.wgsl.text;
        let body = original.find("-> Terms {").expect("there") + "-> Terms {\n".len();
        sources
            .edit(model.declaration.wgsl.path, format!("{}{slow}{}", &original[..body], &original[body..]));
        let mut evaluator = Evaluator::new(&sources, model).expect("a Vulkan driver");
        let pairs = vec![(Vec3::Z, Vec3::new(0.6, 0.0, 0.8)); BATCH + 1];
        assert_eq!(evaluator.evaluate(&pairs).expect("in time").len(), pairs.len());
        evaluator.patience = Duration::from_micros(1);
        // On a busy machine the work may be done before anybody waits for it, but not repeatedly.
        let late = (0..10).find_map(|_| evaluator.evaluate(&pairs).err()).expect("no driver is as fast");
        assert!(matches!(late, GpuError::Stuck(_)), "{late}");
    }
}
