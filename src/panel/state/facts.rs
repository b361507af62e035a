//! Facts that the app provides to the panels.

use glam::{Quat, Vec3};

use crate::{
    document::Selection,
    scene::{Observer, observer::rotation, variant::MAX_VARIANTS},
};

/// Facts that the app provides to the panels, up to once per frame.
///
/// They are written without triggering change detection: systems that react to changes of the session do not need them,
/// and panels read them whenever they are drawn.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Facts {
    /// Orientation of the camera.
    pub camera: Quat,
    /// Position of the camera.
    pub eye: Vec3,
    /// True if the camera has left the observer.
    pub camera_is_free: bool,
    /// The ratio of width to height of the pictures on screen; `None` if there are none.
    pub aspect: Option<f32>,
    /// Views, view A first, in whose picture an object looks as before because its shader is not ready.
    pub compiling: [bool; MAX_VARIANTS + 1],
    /// Clipped parts of each view's picture, view A first; `None` if nothing clips.
    pub clipping: [Option<Clipping>; MAX_VARIANTS + 1],
    /// Lights and objects of each view, view A first, whose light is not a finite number.
    pub not_finite: [Vec<NoNumber>; MAX_VARIANTS + 1],
    /// The indices of objects that are not drawn, since the shapes or the triangles of the scene are too many; sorted.
    pub not_drawn: Vec<usize>,
    /// Convergence of each view's picture, view A first.
    pub converged: [Converging; MAX_VARIANTS + 1],
    /// Statistics of the comparison; `None` unless they belong to the pictures on screen.
    pub comparison: Option<Numbers>,
    /// The running export, labelled with the name of its format.
    pub export: Option<Running<&'static str>>,
    /// The running match, labelled with the view that is matched to view A.
    pub matching: Option<Running<usize>>,
    /// The running fits of every model.
    pub ranking: Option<Running<()>>,
    /// The picture being drawn for a file.
    pub picture: Option<Running<()>>,
    /// The sheet being drawn for a file.
    pub sheet: Option<Running<()>>,
    /// Mean time per frame, in milliseconds; 0 if not yet known.
    pub frame_ms: f32,
    /// The graphics API: "Vulkan", "Metal", …
    pub backend: String,
    /// Name of the GPU.
    pub adapter: String,
}

impl Facts {
    /// Facts with the camera at the observer, and nothing else known.
    #[must_use]
    pub fn at(observer: &Observer) -> Self {
        Self { camera: rotation(observer.direction), eye: observer.position, ..Self::default() }
    }

    /// An observer at the camera.
    #[must_use]
    pub fn observer(&self, of: Observer) -> Observer {
        Observer { position: self.eye, direction: self.camera * Vec3::NEG_Z, ..of }
    }

    /// Frames per second; 0 if not yet known.
    #[must_use]
    pub fn fps(&self) -> f32 {
        if self.frame_ms > 0.0 { 1000.0 / self.frame_ms } else { 0.0 }
    }
}

/// A light or object whose light is not a finite number.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NoNumber {
    /// The light or object.
    pub part: Selection,
    /// The sentence about it without its name: type or model, value, and where.
    pub what: String,
}

/// Convergence of a picture with light with extent.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Converging {
    /// Number of samples averaged so far.
    pub done: u32,
    /// Final number of samples; 0 without light with extent.
    pub total: u32,
    /// Standard error of the pixels relative to their mean luminance, once known.
    pub noise: Option<f32>,
}

impl Converging {
    /// Number of missing samples.
    #[must_use]
    pub fn missing(&self) -> u32 {
        self.total.saturating_sub(self.done)
    }

    /// The progress in words: "63 of 256 samples".
    #[must_use]
    pub fn samples(&self) -> String {
        format!("{} of {} samples", self.done, self.total)
    }
}

/// A running task.
#[derive(Clone, Debug, PartialEq)]
pub struct Running<L> {
    /// The subject of the task.
    pub label: L,
    /// Completed fraction.
    pub done: f32,
    /// The current step.
    pub step: String,
}

/// Clipped parts of a picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Clipping {
    /// Number of clipped pixels in each grid cell, row by row from the top left.
    pub(in crate::panel) counts: Vec<u32>,
}

impl Clipping {
    /// Share of clipped pixels that raises no warning: sharp highlights. New lights stay within this share.
    pub const TOLERATED: f64 = 0.001;
    /// Size of the grid in which clipped pixels are counted, across and down.
    pub const GRID: [usize; 2] = [128, 96];

    /// Creates the grid from the number of clipped pixels in each cell; `None` if nothing clips.
    #[must_use]
    pub fn new(counts: Vec<u32>) -> Option<Self> {
        (counts.len() == Self::GRID[0] * Self::GRID[1] && counts.iter().any(|n| *n > 0))
            .then_some(Self { counts })
    }

    /// Total number of clipped pixels.
    #[must_use]
    pub fn pixels(&self) -> u64 {
        self.counts.iter().map(|n| u64::from(*n)).sum()
    }
}

/// Name of the statistic with the largest difference.
pub const LARGEST: &str = "largest";

/// Statistics of a comparison.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Numbers {
    /// Name, value and description of each statistic.
    pub all: Vec<[String; 3]>,
    /// The largest difference, in the compared quantity; `None` if the views are equal.
    pub largest: Option<f32>,
}

impl Numbers {
    /// Name, value and description of each statistic.
    pub fn entries(&self) -> impl Iterator<Item = (&str, &str, &str)> {
        self.all.iter().map(|[name, value, help]| (name.as_str(), value.as_str(), help.as_str()))
    }
}
