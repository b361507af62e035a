//! Linear pictures by the GPU renderer: light and numbers in 32-bit floats.
//!
//! Graphics cards need not resolve several samples of such targets, so a picture with four samples for each pixel is
//! the mean of four pictures with one, at the standard positions. Unlike in pictures for display, each sample then has
//! a colour of its own.

use bevy::{
    camera::{ClearColorConfig, SubCameraView},
    prelude::*,
};
use glam::Vec4;

use super::{
    gpu::{GpuError, GpuRenderer, vector},
    settle::set_background,
};
use crate::{
    channel::Layer,
    reference::{Picture, sample_positions, within_bounds},
    scene::Scene,
};

impl GpuRenderer {
    /// Draws a layer of a linear picture with its scene, like the CPU renderer: see [`Picture`]. For [`Output::Linear`]; the
    /// background stays dark from then on. The second result is true if light was not finite, and was replaced.
    ///
    /// [`Output::Linear`]: super::gpu::Output::Linear
    ///
    /// # Errors
    /// Returns the errors of [`settle`](Self::settle) and of [`read`](Self::read).
    pub fn light(&mut self, layer: &Layer, scene: Scene, samples: u32) -> Result<(Picture, bool), GpuError> {
        self.set_scene(scene);
        self.set_terms(layer.terms);
        self.set_channel(Some(layer.setting));
        let [width, height] = self.size();
        let mut pixels = vec![Vec4::ZERO; width as usize * height as usize];
        let mut odd = false;
        let places = sample_positions(if layer.is_of_geometry() { 1 } else { samples });
        let share = 1.0 / places.len() as f32;
        for place in &places {
            let full_size = UVec2::new(width, height);
            // The sample is where the centre of the pixel was.
            let offset = Vec2::from_array(*place) - 0.5;
            self.edit_camera(|camera| {
                set_background(camera, ClearColorConfig::Custom(Color::NONE));
                if let Some(mut camera) = camera.get_mut::<Camera>() {
                    camera.sub_camera_view = Some(SubCameraView { full_size, offset, size: full_size });
                }
            });
            self.settle()?;
            for (pixel, bytes) in pixels.iter_mut().zip(self.read()?.chunks_exact(16)) {
                let (light, covers) = (vector(bytes), vector(&bytes[4..]).z);
                if covers > 0.0 {
                    odd |= !light.is_finite();
                    *pixel += within_bounds(light).extend(1.0) * share;
                }
            }
        }
        Ok((Picture { width, height, pixels }, odd))
    }
}
