//! What a desktop and a browser do differently: one interface, and an implementation of each. Nothing else asks where the
//! program runs.

#[cfg(target_arch = "wasm32")]
mod browser;
#[cfg(not(target_arch = "wasm32"))]
mod desktop;
mod next;
mod notice;

#[cfg(target_arch = "wasm32")]
pub use browser::*;
#[cfg(not(target_arch = "wasm32"))]
pub use desktop::*;
pub use next::Next;
pub use notice::Notice;

#[cfg(test)]
mod tests;
