//! Shader sources: text in, text out; composing, checking, trying, and exchanging them while they are on the
//! picture.

pub mod check;
pub mod compose;
mod field;
pub mod interpret;
pub mod limits;
pub mod pitfall;
pub mod report;
pub mod slim;
pub mod whole;

/// The WGSL source of one file under `assets/shaders/`, with the copy that is built in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Source {
    /// Path below `assets/shaders/`, e.g. `reflection/phong.wgsl`; what messages name.
    pub path: &'static str,
    /// The text as it was when the program was built.
    pub text: &'static str,
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
