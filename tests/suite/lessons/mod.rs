//! Lessons: the command, the panel, and every shipped one from start to end.

mod command;
mod panel;
mod played;
