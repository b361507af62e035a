//! The parts of the renderer that trials need.

use bevy::{
    prelude::*,
    render::{
        render_resource::{BindGroupLayout, RenderPipelineDescriptor},
        renderer::{RenderAdapter, RenderDevice},
    },
};

/// Marks the pipelines of our materials, so that one can be found as an example.
pub const MARK: &str = "LAB_SURFACE";
/// Prefix of the paths of our own composed shaders.
pub const COMPOSED: &str = "composed/";

/// A pipeline of our materials as built by Bevy, to be rebuilt with another shader.
pub(super) struct Example {
    pub descriptor: RenderPipelineDescriptor,
    pub layouts: Vec<BindGroupLayout>,
}

/// The parts of the renderer that a trial needs.
#[derive(Clone, Copy)]
pub struct Tools<'a> {
    /// The graphics device.
    pub device: &'a RenderDevice,
    /// The adapter of the device.
    pub adapter: &'a RenderAdapter,
    /// All loaded shaders, including Bevy's own.
    pub shaders: &'a Assets<Shader>,
}
