//! Shader sources: text in, text out; composing, checking, interpreting.

mod blocks;
pub mod check;
pub mod compose;
pub(crate) mod definitions;
mod explain;
pub mod interpret;
pub mod limits;
pub mod pitfall;
mod place;
mod problem;
pub mod report;
pub mod slim;
mod token;
pub mod whole;

/// The WGSL source of one file under `assets/shaders/`, with its built-in copy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Source {
    /// Path below `assets/shaders/`, such as `reflection/phong.wgsl`; also its name in messages.
    pub path: &'static str,
    /// The text at build time.
    pub text: &'static str,
}

impl Source {
    /// A file by its path below a shader folder, with its text: `include_str!("../shaders/light/lamp.wgsl")`.
    #[must_use]
    pub const fn new(path: &'static str, text: &'static str) -> Self {
        Self { path, text }
    }
}

/// The built-in copy of a file under `assets/shaders/`.
macro_rules! wgsl {
    ($path:literal) => {
        $crate::shader::Source {
            path: $path,
            text: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/assets/shaders/", $path)),
        }
    };
}
pub(crate) use wgsl;
