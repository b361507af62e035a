//! Facts fed by the app.

/// Facts for the status line.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Status {
    /// Mean time per frame, milliseconds; 0 when not yet known.
    pub frame_ms: f32,
    /// The interface to the GPU: "Vulkan", "Metal", …
    pub backend: String,
    /// The GPU.
    pub adapter: String,
    /// How the shaders are.
    pub shaders: Shaders,
    /// What is in progress, from 0 to 1, and what it is.
    pub progress: Option<(String, f32)>,
}

impl Status {
    /// Frames per second; 0 when not yet known.
    #[must_use]
    pub fn fps(&self) -> f32 {
        if self.frame_ms > 0.0 { 1000.0 / self.frame_ms } else { 0.0 }
    }
}

/// How the shaders are.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Shaders {
    /// All compiled.
    #[default]
    Ready,
    /// Some are being compiled.
    Compiling,
    /// The last change does not compile; the picture shows the one before.
    Stale,
}
