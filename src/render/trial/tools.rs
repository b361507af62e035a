//! The parts of the renderer that trials need.

use bevy::{
    asset::Assets,
    render::{
        render_resource::{BindGroupLayout, RenderPipelineDescriptor},
        renderer::{RenderAdapter, RenderDevice},
    },
    shader::Shader,
};

/// The mark in the pipelines of our materials, by which one is found as an example.
pub const MARK: &str = "LAB_SURFACE";
/// The prefix of the paths of our own composed shaders.
pub const COMPOSED: &str = "composed/";

/// A pipeline of our materials as Bevy made it, to be made again with another shader.
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
    /// All shaders that are loaded, Bevy's own among them.
    pub shaders: &'a Assets<Shader>,
}
