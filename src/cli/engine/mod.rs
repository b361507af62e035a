//! The requests of commands to the window and the GPU. In a program built without them, [`engine`] reports that.

use std::path::{Path, PathBuf};

use glam::{DVec3, Vec3};

use super::{Options, Outcome, view, views::Part, workshop::Places};
use crate::{
    channel::{Layer, Setting},
    compare::Shown,
    failure::Failure,
    linear::Channels,
    optics::{Terms, colour::Encoding},
    parameter::Values,
    program::without_window,
    progress::Progress,
    reference::{Reached, Until},
    reflection::ModelEntry,
    registry::Registry,
    shader::compose::Sources,
};

#[cfg(not(feature = "window"))]
mod missing;
#[cfg(feature = "window")]
mod pictures;
#[cfg(feature = "window")]
mod present;
#[cfg(feature = "window")]
mod window;

#[cfg(not(feature = "window"))]
pub use missing::App;
#[cfg(not(feature = "window"))]
pub(super) use missing::ENGINE;
#[cfg(feature = "window")]
pub use present::App;
#[cfg(feature = "window")]
pub(super) use present::ENGINE;

/// Changes the app of the window before it opens.
pub(super) type Additions<'a> = Box<dyn FnOnce(&mut App) + 'a>;

/// The window and the GPU.
pub(super) struct Engine {
    /// Opens the window.
    pub(super) view: fn(view::Arguments, Options, &Places, Registry, Additions) -> Outcome,
    /// Answers another process of this program, which has shaders tried.
    pub(super) try_shaders: fn() -> Outcome,
    /// True if this machine may have a GPU: a test that asks no driver.
    pub(super) may_have_gpu: fn() -> bool,
    /// Looks for something that draws: true for hardware, false for a driver that draws on the CPU.
    pub(super) find_adapter: fn() -> Result<bool, Failure>,
    /// Draws pictures; the program tries shaders in a separate process.
    pub(super) pictures: fn(Option<PathBuf>) -> Box<dyn Pictures>,
    /// Evaluates a model.
    pub(super) evaluator: fn(&Sources, &ModelEntry) -> Result<Box<dyn Evaluator>, Failure>,
}

/// The window and the GPU. Without them, fails with what to do instead.
pub(super) fn engine(remedy: &str) -> Result<&'static Engine, Failure> {
    ENGINE.ok_or_else(|| Failure::NoRenderer(without_window(remedy)))
}

/// A view to draw on the GPU.
pub(super) struct Order<'a> {
    pub(super) part: &'a Part,
    /// Samples per pixel.
    pub(super) samples: u32,
    /// The samples of lights with extent.
    pub(super) until: Until,
    pub(super) registry: &'a Registry,
    /// The picture's file, for messages.
    pub(super) file: &'a Path,
}

/// The GPU renderer.
pub(super) trait Pictures {
    /// A view for display, or a debug channel instead, with how lights with extent were sampled, if they were, and a remark on
    /// light that is not finite.
    fn draw(
        &mut self,
        order: &Order,
        channel: Option<Setting>,
        progress: &Progress,
    ) -> Result<(Shown, Reached, Option<String>), Failure>;

    /// The layers of a linear picture, with such a remark. Noise does not end it.
    fn layers(
        &mut self,
        order: &Order,
        layers: &[Layer],
        progress: &Progress,
    ) -> Result<(Channels, Option<String>), Failure>;
}

/// A model on the GPU.
pub(super) trait Evaluator {
    /// Sets the parameters for subsequent evaluations.
    fn set(&mut self, values: &Values, encoding: Encoding);
    /// The responses to pairs of directions, to the light and to the viewer.
    fn evaluate(&self, pairs: &[(Vec3, Vec3)]) -> Result<Vec<Terms>, Failure>;
    /// The directional albedos for views.
    fn albedos(&self, views: &[Vec3]) -> Result<Vec<DVec3>, Failure>;
}
