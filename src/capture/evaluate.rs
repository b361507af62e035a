//! Evaluating a model's WGSL in a compute pass: the GPU's answer to the same question that the Rust
//! function answers.

use bevy::render::{
    render_resource::{
        BindGroupEntry, BindGroupLayoutEntry, BindingType, BufferBindingType, BufferDescriptor,
        BufferInitDescriptor, BufferUsages, CommandEncoderDescriptor, ComputePassDescriptor,
        PipelineLayoutDescriptor, RawComputePipelineDescriptor, ShaderModuleDescriptor, ShaderSource,
        ShaderStages,
    },
    settings::RenderResources,
};
use glam::Vec3;

use super::gpu::{GpuError, device, read_back, vector};
use crate::{
    optics::{Terms, colour::Encoding},
    reflection::{
        ModelEntry,
        parameter::{Values, pack},
    },
    shader::{
        check,
        compose::{Sources, compose_evaluation},
    },
};

/// The response of a model to pairs of directions (to the light, to the viewer) in the local frame
/// (normal +z, tangent +x), calculated by its WGSL on the GPU.
///
/// # Errors
/// Without a driver, or when the model's WGSL is not valid.
pub fn evaluate(
    model: &ModelEntry,
    values: &Values,
    encoding: Encoding,
    pairs: &[(Vec3, Vec3)],
) -> Result<Vec<Terms>, GpuError> {
    if pairs.is_empty() {
        return Ok(Vec::new());
    }
    let composed = compose_evaluation(&Sources::default(), model);
    check::validate(&composed).map_err(|e| GpuError::Shader(e.to_string()))?;
    let RenderResources(device, queue, ..) = device()?;
    let limit = device.limits().max_storage_buffer_binding_size as usize / ANSWER_BYTES;
    let mut answers = Vec::with_capacity(pairs.len());
    for chunk in pairs.chunks(limit.min(65_535 * 64)) {
        answers.extend(run(
            &device,
            &queue,
            &composed.text,
            &pack(model.parameters, values, encoding),
            chunk,
        )?);
    }
    Ok(answers)
}

/// Bytes of `Pair` in `evaluate.wgsl`: two vec3, each padded to 16.
const PAIR_BYTES: usize = 32;
/// Bytes of `Terms` in `terms.wgsl`: three vec3, each padded to 16.
const ANSWER_BYTES: usize = 48;

fn run(
    device: &bevy::render::renderer::RenderDevice,
    queue: &bevy::render::renderer::RenderQueue,
    text: &str,
    parameters: &[u8],
    pairs: &[(Vec3, Vec3)],
) -> Result<Vec<Terms>, GpuError> {
    let mut input = Vec::with_capacity(pairs.len() * PAIR_BYTES);
    for v in pairs.iter().flat_map(|(l, v)| [l, v]) {
        for c in [v.x, v.y, v.z, 0.0] {
            input.extend_from_slice(&c.to_le_bytes());
        }
    }
    let buffer = |contents: &[u8], usage| {
        device.create_buffer_with_data(&BufferInitDescriptor { label: Some("evaluate"), contents, usage })
    };
    let parameters = buffer(parameters, BufferUsages::UNIFORM);
    let input = buffer(&input, BufferUsages::STORAGE);
    let size = (pairs.len() * ANSWER_BYTES) as u64;
    let empty = |usage| {
        device.create_buffer(&BufferDescriptor {
            label: Some("answers"),
            size,
            usage,
            mapped_at_creation: false,
        })
    };
    let output = empty(BufferUsages::STORAGE | BufferUsages::COPY_SRC);
    let staging = empty(BufferUsages::COPY_DST | BufferUsages::MAP_READ);

    let module = device.create_and_validate_shader_module(ShaderModuleDescriptor {
        label: Some("evaluate"),
        source: ShaderSource::Wgsl(text.into()),
    });
    let entry = |binding, ty| BindGroupLayoutEntry {
        binding,
        visibility: ShaderStages::COMPUTE,
        ty: BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None },
        count: None,
    };
    let layout = device.create_bind_group_layout(
        "evaluate",
        &[
            entry(0, BufferBindingType::Uniform),
            entry(1, BufferBindingType::Storage { read_only: true }),
            entry(2, BufferBindingType::Storage { read_only: false }),
        ],
    );
    let pipeline_layout = device.create_pipeline_layout(&PipelineLayoutDescriptor {
        label: Some("evaluate"),
        bind_group_layouts: &[Some(&layout)],
        immediate_size: 0,
    });
    let pipeline = device.create_compute_pipeline(&RawComputePipelineDescriptor {
        label: Some("evaluate"),
        layout: Some(&pipeline_layout),
        module: &module,
        entry_point: Some("evaluate"),
        compilation_options: wgpu::PipelineCompilationOptions::default(),
        cache: None,
    });
    let group = device.create_bind_group(
        "evaluate",
        &layout,
        &[
            BindGroupEntry { binding: 0, resource: parameters.as_entire_binding() },
            BindGroupEntry { binding: 1, resource: input.as_entire_binding() },
            BindGroupEntry { binding: 2, resource: output.as_entire_binding() },
        ],
    );
    let mut encoder = device.create_command_encoder(&CommandEncoderDescriptor { label: Some("evaluate") });
    {
        let mut pass = encoder
            .begin_compute_pass(&ComputePassDescriptor { label: Some("evaluate"), timestamp_writes: None });
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, Some(&*group), &[]);
        pass.dispatch_workgroups(pairs.len().div_ceil(64) as u32, 1, 1);
    }
    encoder.copy_buffer_to_buffer(&output, 0, &staging, 0, size);
    queue.submit([encoder.finish()]);
    Ok(read_back(device, &staging)?
        .chunks_exact(ANSWER_BYTES)
        .map(|b| Terms {
            ambient: vector(&b[..12]),
            diffuse: vector(&b[16..28]),
            specular: vector(&b[32..44]),
        })
        .collect())
}
