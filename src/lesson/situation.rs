//! The state in which a condition is decided: the scene, the window, the pinned pixel.

use crate::{
    channel::DebugChannel, curves::Kind, document::Selection, explain::Explanation, optics::TermSelection,
    registry::Registry, scene::Scene,
};

/// The state of the window in which a condition is evaluated.
#[derive(Clone, Copy, Debug)]
pub struct Situation<'a> {
    /// The scene of the active view: [`Scene::seen`].
    pub scene: &'a Scene,
    /// Registered models, lights and shapes.
    pub registry: &'a Registry,
    /// The selected part.
    pub selection: Selection,
    /// Facts about the window.
    pub window: WindowFacts,
    /// The explanation of the pinned pixel, or of the pixel under the pointer if none is pinned; `None` until
    /// it is calculated.
    pub probe: Option<&'a Explanation>,
    /// True if a pixel is pinned: quantities of pixels refer only to a pinned one.
    pub pinned: bool,
}

/// Facts about the window.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WindowFacts {
    /// The number of views, 1 to 4.
    pub views: usize,
    /// The active view: 0 is the scene, 1 view B.
    pub active: usize,
    /// The debug channel of the active view.
    pub channel: Option<DebugChannel>,
    /// The displayed terms.
    pub terms: TermSelection,
    /// The plot, if the *Plots* panel is visible.
    pub plots: Option<Kind>,
    /// True if the *Explain* panel is visible.
    pub explain: bool,
    /// True in presentation mode.
    pub presenting: bool,
    /// True if the *Code* panel shows a text.
    pub code: bool,
    /// Number of errors in the files of shaders and models.
    pub errors: usize,
}
