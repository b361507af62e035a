//! The window: panels, keys, pointer, pictures.

mod clipping;
mod code;
mod dialogs;
mod editors;
mod equations;
pub(crate) mod examples;
mod finder;
mod focus;
mod handles;
mod knobs;
mod law_check;
pub(crate) mod layout;
mod marks;
mod materials;
mod narrow;
pub(crate) mod panels;
mod plots;
mod pointer;
mod presentation;
mod program;
mod redraw;
mod reload;
mod scene_list;
mod several;
mod shader_panel;
mod taken;
