//! Explanations of pixels, on the command line, in pages and in the window.

mod followed;
mod levels;
mod linked;
mod lobe;
mod pages;
mod pinned;
mod pixels;
mod probe;
