//! The pictures of both renderers.

mod batches;
mod channels;
mod contact_sheet;
mod converging;
mod finite;
pub(crate) mod golden;
mod gpu_parity;
mod hot_swap;
mod memory;
mod reference;
pub(crate) mod reload;
mod rows;
mod tangents;
