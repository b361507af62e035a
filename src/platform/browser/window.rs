//! The window in the page.

use std::{
    io,
    path::{Path, PathBuf},
    sync::{Arc, Mutex},
    time::Duration,
};

use bevy::{app::PluginGroupBuilder, render::settings::Backends, window::Window};

use egui_file_dialog::{Disks, FileDialog, FileSystem, Metadata, UserDirectories};

use wasm_bindgen::closure::Closure;

use super::{super::notice::Notice, fs, page, tabs};
use crate::caught::lock;

/// The graphics API of browsers.
#[must_use]
pub fn backends() -> Backends {
    Backends::BROWSER_WEBGPU
}

/// Bevy's plugins, which in a browser are those that the window must have.
#[must_use]
pub fn fitting(plugins: PluginGroupBuilder) -> PluginGroupBuilder {
    plugins
}

/// The window in its canvas, which fills the page.
#[must_use]
pub fn placed(window: Window) -> Window {
    Window {
        canvas: Some("#lab".to_owned()),
        fit_canvas_to_parent: true,
        prevent_default_event_handling: true,
        ..window
    }
}

/// Shows the title of the window as that of the page, which asks before it is closed if that would lose something.
pub fn titled(title: &str, unsaved: bool) {
    page::titled(title, unsaved);
}

/// Lets the window take the place of what the page has shown so far.
pub fn shown() {
    page::shown();
}

/// The files that were dropped on the page, until they are taken.
static BROUGHT: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Listens for files that are dropped on the page, and calls a function whenever there are some.
pub fn listen_for_files(wake: impl Fn() + 'static) {
    let mut several = Vec::new();
    let brought = Closure::new(move |name: String, bytes: Vec<u8>, last: bool| {
        several.push(fs::bring(&name, bytes));
        if last {
            lock(&BROUGHT).append(&mut several);
            wake();
        }
    });
    page::listen(&brought);
    // As long as the page.
    brought.forget();
}

/// The files that were dropped on the page since the last call.
#[must_use]
pub fn brought() -> Vec<PathBuf> {
    std::mem::take(&mut *lock(&BROUGHT))
}

/// What has happened around the program, until it is taken.
static NOTICES: Mutex<Vec<Notice>> = Mutex::new(Vec::new());

/// Calls a function whenever something has happened around the program, and another one when its user may be about to
/// leave.
pub fn attend(wake: impl Fn() + 'static, leaving: impl Fn() + 'static) {
    let happened = Closure::new(move |what: String, subject: String, bytes: Vec<u8>| {
        if what == "leaving" {
            leaving();
        }
        lock(&NOTICES).extend(tabs::happened(&what, &subject, bytes));
        wake();
    });
    page::attend(&happened);
    // As long as the page.
    happened.forget();
}

/// What has happened around the program since the last call.
#[must_use]
pub fn notices() -> Vec<Notice> {
    std::mem::take(&mut *lock(&NOTICES))
}

/// Says why there are no more pictures, in their place.
pub fn stopped(why: &str) {
    page::stopped(why);
}

/// Notes shaders that may end the page, a line each.
pub fn note_trials(names: &str) {
    page::note_trials(names);
}

/// The shaders that have ended earlier pages.
#[must_use]
pub fn fatal_trials() -> Vec<String> {
    page::fatal_trials()
}

/// Copies a picture of RGBA pixels to the clipboard. Whether it was is among the [`notices`].
///
/// # Errors
/// Returns none.
pub fn copy_picture(rgba: Vec<u8>, [width, height]: [u32; 2]) -> Result<(), String> {
    page::copy_picture(rgba, width, height);
    Ok(())
}

/// A page opens no files of the desktop.
///
/// # Errors
/// Returns an error always.
pub fn open(_path: &Path) -> io::Result<()> {
    Err(io::Error::other("a page in a browser cannot open files of this computer"))
}

/// Hands a file to the browser, which downloads it.
///
/// # Errors
/// Returns an error if there is none.
pub fn open_within(path: &Path, _patience: Duration) -> io::Result<()> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    page::download(&name, &fs::read(path)?);
    Ok(())
}

/// A dialog that shows the files in memory.
#[must_use]
pub fn file_dialog() -> FileDialog {
    FileDialog::with_file_system(Arc::new(Memory)).canonicalize_paths(false)
}

/// The files in memory, as dialogs see them.
struct Memory;

impl FileSystem for Memory {
    fn metadata(&self, path: &Path) -> io::Result<Metadata> {
        fs::metadata(path).map(|_| Metadata::default())
    }

    fn is_dir(&self, path: &Path) -> bool {
        fs::is_dir(path)
    }

    fn is_file(&self, path: &Path) -> bool {
        fs::is_file(path)
    }

    fn read_dir(&self, path: &Path) -> io::Result<Vec<PathBuf>> {
        Ok(fs::read_dir(path)?.flatten().map(|entry| entry.path()).collect())
    }

    fn get_disks(&self, _canonicalize_paths: bool) -> Disks {
        Disks::new_empty()
    }

    fn is_path_hidden(&self, path: &Path) -> bool {
        path.file_name().is_some_and(|name| name.to_string_lossy().starts_with('.'))
    }

    fn create_dir(&self, path: &Path) -> io::Result<()> {
        fs::create_dir(path)
    }

    fn user_dirs(&self, _canonicalize_paths: bool) -> Option<UserDirectories> {
        let [files, downloads] = [fs::FILES, fs::DOWNLOADS].map(|path| Some(PathBuf::from(path)));
        Some(UserDirectories::new(files, None, None, None, downloads, None, None))
    }

    fn current_dir(&self) -> io::Result<PathBuf> {
        Ok(PathBuf::from(fs::FILES))
    }
}
