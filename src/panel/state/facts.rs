//! Facts that the app feeds to the panels.

use glam::{Quat, Vec3};

use crate::scene::{Observer, observer::rotation, variant::MAX_VARIANTS};

/// Facts that the app feeds to the panels, as often as in every frame.
///
/// Whoever writes them bypasses change detection: those who follow the session have no use for them, and the panels
/// read them whenever they are drawn.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Facts {
    /// The orientation of the camera.
    pub camera: Quat,
    /// The position of the camera.
    pub eye: Vec3,
    /// True if the camera has left the observer.
    pub camera_left: bool,
    /// True while an object is still drawn as it was before, since its shader is not ready.
    pub compiling: bool,
    /// The clipped parts of the picture of each view, view A first; `None` where nothing clips.
    pub clipping: [Option<Clipping>; MAX_VARIANTS + 1],
    /// How far the picture of each view has converged, view A first.
    pub converged: [Converging; MAX_VARIANTS + 1],
    /// The numbers of the comparison; `None` until they are known.
    pub comparison: Option<Numbers>,
    /// The export that runs.
    pub export: Option<Exporting>,
    /// The match that runs.
    pub matching: Option<Matching>,
    /// Mean time per frame, milliseconds; 0 when not yet known.
    pub frame_ms: f32,
    /// The interface to the GPU: "Vulkan", "Metal", …
    pub backend: String,
    /// The GPU.
    pub adapter: String,
}

impl Facts {
    /// A camera at the observer, and nothing else known.
    #[must_use]
    pub fn at(observer: &Observer) -> Self {
        Self { camera: rotation(observer.direction), eye: observer.position, ..Self::default() }
    }

    /// An observer where the camera is.
    #[must_use]
    pub fn observer(&self, field_of_view: f32) -> Observer {
        Observer { position: self.eye, direction: self.camera * Vec3::NEG_Z, field_of_view }
    }

    /// Frames per second; 0 when not yet known.
    #[must_use]
    pub fn fps(&self) -> f32 {
        if self.frame_ms > 0.0 { 1000.0 / self.frame_ms } else { 0.0 }
    }
}

/// How far a picture of light with extent has converged.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Converging {
    /// The samples that it is the mean of.
    pub done: u32,
    /// Those that it will be the mean of; 0 if there is no such light.
    pub total: u32,
    /// The standard error of pixels over their mean luminance, once it is known.
    pub noise: Option<f32>,
}

impl Converging {
    /// The samples that it lacks.
    #[must_use]
    pub fn missing(&self) -> u32 {
        self.total.saturating_sub(self.done)
    }

    /// "63 of 256 samples".
    #[must_use]
    pub fn samples(&self) -> String {
        format!("{} of {} samples", self.done, self.total)
    }
}

/// The state of an export that runs.
#[derive(Clone, Debug, PartialEq)]
pub struct Exporting {
    /// The name of its form.
    pub name: &'static str,
    /// The fraction that is done.
    pub done: f32,
    /// The current step.
    pub step: String,
}

/// The state of a match that runs.
#[derive(Clone, Debug, PartialEq)]
pub struct Matching {
    /// The view that is matched to view A.
    pub view: usize,
    /// The fraction that is done.
    pub done: f32,
    /// The current step.
    pub step: String,
}

/// The clipped parts of the picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Clipping {
    /// Clipped pixels in each field, row by row from the top left.
    pub(in crate::panel) counts: Vec<u32>,
}

impl Clipping {
    /// Fields across and down in which clipped pixels are counted.
    pub const GRID: [usize; 2] = [128, 96];

    /// From the pixels counted in each field; `None` where none clips.
    #[must_use]
    pub fn new(counts: Vec<u32>) -> Option<Self> {
        (counts.len() == Self::GRID[0] * Self::GRID[1] && counts.iter().any(|n| *n > 0))
            .then_some(Self { counts })
    }

    /// Pixels that clip.
    #[must_use]
    pub fn pixels(&self) -> u64 {
        self.counts.iter().map(|n| u64::from(*n)).sum()
    }
}

/// The name of the largest difference among the numbers.
pub const LARGEST: &str = "largest";

/// The numbers of a comparison.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Numbers {
    /// The name of each, its value, and one sentence.
    pub all: Vec<[String; 3]>,
    /// The largest difference, in the values that are compared; `None` if the views are equal.
    pub largest: Option<f32>,
}

impl Numbers {
    /// The name of each, its value, and one sentence.
    pub fn entries(&self) -> impl Iterator<Item = (&str, &str, &str)> {
        self.all.iter().map(|[name, value, help]| (name.as_str(), value.as_str(), help.as_str()))
    }
}
