//! The pictures of both renderers.

mod background;
mod batches;
mod bodies;
mod channels;
mod contact_sheet;
mod converging;
mod finite;
mod frames;
pub(crate) mod golden;
mod gpu_parity;
mod hot_swap;
pub(crate) mod linear;
mod memory;
mod reference;
pub(crate) mod reload;
mod rows;
mod tangents;
mod until;
