//! Passes with shaders of their own, beside those of Bevy's materials.

use std::borrow::Cow;

use bevy::render::{
    render_resource::{
        BindGroupEntry, BindGroupLayout, BindGroupLayoutEntry, Buffer, BufferDescriptor, BufferUsages,
        CommandEncoder, ComputePassDescriptor, ComputePipeline, PipelineLayout, PipelineLayoutDescriptor,
        RenderPipeline, ShaderModule, ShaderModuleDescriptor, ShaderSource, TextureFormat,
    },
    renderer::RenderDevice,
};

/// The layout of a pass's bindings, that of its pipeline, and its shader.
pub(super) fn parts(
    device: &RenderDevice,
    label: &'static str,
    text: Cow<'_, str>,
    entries: &[BindGroupLayoutEntry],
) -> (BindGroupLayout, PipelineLayout, ShaderModule) {
    let source = ShaderSource::Wgsl(text);
    let module =
        device.create_and_validate_shader_module(ShaderModuleDescriptor { label: Some(label), source });
    let bindings = device.create_bind_group_layout(label, entries);
    let layout = device.create_pipeline_layout(&PipelineLayoutDescriptor {
        label: Some(label),
        bind_group_layouts: &[Some(&bindings)],
        immediate_size: 0,
    });
    (bindings, layout, module)
}

/// A pass that draws a triangle over the whole target.
pub(super) struct Cover {
    pub(super) bindings: BindGroupLayout,
    pub(super) pipeline: RenderPipeline,
}

impl Cover {
    /// The pass of the entry points `vertex` and `fragment` of a shader, into targets with so many samples in a pixel.
    pub(super) fn new(
        device: &RenderDevice,
        label: &'static str,
        (text, fragment): (Cow<'_, str>, &str),
        entries: &[BindGroupLayoutEntry],
        (formats, samples): (&[TextureFormat], u32),
    ) -> Self {
        let (bindings, layout, module) = parts(device, label, text, entries);
        let targets: Vec<_> = formats.iter().map(|format| Some((*format).into())).collect();
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(label),
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("vertex"),
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: Default::default(),
            depth_stencil: None,
            multisample: wgpu::MultisampleState { count: samples, ..Default::default() },
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some(fragment),
                compilation_options: Default::default(),
                targets: &targets,
            }),
            multiview_mask: None,
            cache: None,
        });
        Self { bindings, pipeline }
    }
}

/// An empty buffer.
pub(super) fn buffer(device: &RenderDevice, label: &str, size: u64, usage: BufferUsages) -> Buffer {
    device.create_buffer(&BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false })
}

/// A compute pass.
pub(super) struct Compute {
    label: &'static str,
    bindings: BindGroupLayout,
    pipeline: ComputePipeline,
}

impl Compute {
    pub(super) fn new(
        device: &RenderDevice,
        label: &'static str,
        text: Cow<'_, str>,
        entry_point: &str,
        entries: &[BindGroupLayoutEntry],
    ) -> Self {
        let (bindings, layout, module) = parts(device, label, text, entries);
        let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(label),
            layout: Some(&layout),
            module: &module,
            entry_point: Some(entry_point),
            compilation_options: Default::default(),
            cache: None,
        });
        Self { label, bindings, pipeline }
    }

    /// Adds the pass to commands, with so many workgroups.
    pub(super) fn run(
        &self,
        device: &RenderDevice,
        encoder: &mut CommandEncoder,
        entries: &[BindGroupEntry],
        groups: u32,
    ) {
        let bound = device.create_bind_group(self.label, &self.bindings, entries);
        let descriptor = ComputePassDescriptor { label: Some(self.label), timestamp_writes: None };
        let mut pass = encoder.begin_compute_pass(&descriptor);
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &*bound, &[]);
        pass.dispatch_workgroups(groups, 1, 1);
    }
}
