//! The command line.

mod assets;
mod command_line;
mod files;
mod installed;
mod materials;
mod outputs;
mod plot;
mod sampling;
mod signals;
mod study;
mod sweep;
mod without_window;
