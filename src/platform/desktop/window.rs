//! The window on a desktop.

use std::{
    borrow::Cow,
    io,
    path::{Path, PathBuf},
    sync::Mutex,
    time::Duration,
};

use arboard::{Clipboard, ImageData};
use bevy::{
    app::{PluginGroupBuilder, TerminalCtrlCHandlerPlugin},
    render::{pipelined_rendering::PipelinedRenderingPlugin, settings::Backends},
    window::Window,
};

use egui_file_dialog::FileDialog;

use super::super::notice::Notice;
use crate::caught::lock;

/// The graphics APIs to use: `WGPU_BACKEND` if set; otherwise Vulkan on Linux (requesting OpenGL as well
/// would print warnings on machines without it) and all elsewhere.
#[must_use]
pub fn backends() -> Backends {
    Backends::from_env().unwrap_or(if cfg!(target_os = "linux") {
        Backends::VULKAN
    } else {
        Backends::PRIMARY
    })
}

/// Bevy's plugins without those that a window must not have.
#[must_use]
pub fn fitting(plugins: PluginGroupBuilder) -> PluginGroupBuilder {
    plugins
        .disable::<PipelinedRenderingPlugin>()
        // Signals are handled elsewhere, even while the window sleeps.
        .disable::<TerminalCtrlCHandlerPlugin>()
}

/// The window in its place.
#[must_use]
pub fn placed(window: Window) -> Window {
    window
}

/// Hears of the title of the window, and whether closing it would lose something. The window shows and asks.
pub fn titled(_title: &str, _unsaved: bool) {}

/// Hears that the window has been drawn for the first time.
pub fn shown() {}

/// A dialog that shows the files of this computer.
#[must_use]
pub fn file_dialog() -> FileDialog {
    FileDialog::new()
}

/// The windowing library hears of files that are dropped on the window.
pub fn listen_for_files(_wake: impl Fn() + 'static) {}

/// The windowing library hears of files that are dropped on the window.
#[must_use]
pub fn brought() -> Vec<PathBuf> {
    Vec::new()
}

/// Other programs are heard of through their files.
pub fn attend(_wake: impl Fn() + 'static, _leaving: impl Fn() + 'static) {}

/// Other programs are heard of through their files.
#[must_use]
pub fn notices() -> Vec<Notice> {
    Vec::new()
}

/// The end of the process says why.
pub fn stopped(_why: &str) {}

/// Another process tries shaders, and may end by it.
pub fn note_trials(_names: &str) {}

/// Another process tries shaders, and may end by it.
#[must_use]
pub fn fatal_trials() -> Vec<String> {
    Vec::new()
}

/// Copies a picture of RGBA pixels to the clipboard. Under X11, it stays there while this program runs.
///
/// # Errors
/// Returns the reason if it is not copied.
pub fn copy_picture(rgba: Vec<u8>, [width, height]: [u32; 2]) -> Result<(), String> {
    static CLIPBOARD: Mutex<Option<Clipboard>> = Mutex::new(None);
    let picture = ImageData { width: width as usize, height: height as usize, bytes: Cow::Owned(rgba) };
    let mut clipboard = lock(&CLIPBOARD);
    let set = match &mut *clipboard {
        Some(clipboard) => clipboard.set_image(picture),
        none => Clipboard::new().and_then(|new| none.insert(new).set_image(picture)),
    };
    set.map_err(|error| error.to_string())
}

/// Opens a file or a folder with the program of the desktop for it.
///
/// # Errors
/// Returns an error if there is none, or it does not start.
pub fn open(path: &Path) -> io::Result<()> {
    open::that_detached(path)
}

/// Like [`open()`], and waits at most so long for the program to report that it cannot.
///
/// # Errors
/// Returns the errors of [`open()`].
pub fn open_within(path: &Path, patience: Duration) -> io::Result<()> {
    open::that_detached_with_timeout(path, patience)
}
