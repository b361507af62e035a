//! The commands for the editor of texts.

use std::{path::PathBuf, sync::Arc};

/// Id of the panel with the editor.
pub const CODE_TAB: &str = "code";

/// A command for the editor.
#[derive(Clone, Debug, PartialEq)]
pub enum CodeCommand {
    /// Open the file of the current model.
    Model,
    /// Open the file of the model with this id; where it has none, offer to copy it as a file.
    ModelOf(String),
    /// Open a file at a line, from 1. 0: at the place where it was left, a new one at its start.
    File(PathBuf, usize),
    /// Open the scene as JSON.
    Scene,
    /// Let the scene as JSON follow the document.
    Follow,
    /// Show the n-th open text.
    Show(usize),
    /// The text with this number, as typed.
    Type(u64, Arc<str>),
    /// The panel has gone to the line.
    Arrived,
    /// Write the visible text to its file, or make its scene that of the document.
    Save,
    /// Close the visible text, after a question about unsaved changes.
    Close,
    /// Close it, and lose the changes.
    Discard,
    /// Do not close it.
    Stay,
    /// Keep the text as typed; saving it replaces the other version.
    KeepMine,
    /// Take the other version; undoing in the editor brings back the text as typed.
    TakeTheirs,
    /// Show the difference from the other version, or the text.
    Difference(bool),
    /// Continue with the text of this file that an earlier window left.
    Recover(PathBuf),
}
