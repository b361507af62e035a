//! What a desktop and a browser do differently: one interface, and an implementation of each. Nothing else asks where the
//! program runs.

#[cfg(target_arch = "wasm32")]
mod browser;
#[cfg(not(target_arch = "wasm32"))]
mod desktop;
mod next;

#[cfg(target_arch = "wasm32")]
pub use browser::*;
#[cfg(not(target_arch = "wasm32"))]
pub use desktop::*;
pub use next::Next;

#[cfg(test)]
mod tests;
