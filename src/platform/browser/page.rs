//! The page around the program, and what it does for it.

#![allow(unsafe_code, reason = "the macro makes it of the declarations")]

use std::panic;

use wasm_bindgen::prelude::*;

#[wasm_bindgen(module = "/src/platform/browser/page.js")]
extern "C" {
    /// The part of the address from `?` to `#`.
    pub(super) fn query() -> String;
    /// The part of the address from `#` on.
    pub(super) fn fragment() -> String;
    /// The address without either.
    pub(super) fn place() -> String;
    /// The content of the file of the site with this name in the address, if it was loaded.
    #[wasm_bindgen(js_name = loadedBytes)]
    pub(super) fn loaded_bytes(name: &str) -> Option<Vec<u8>>;
    /// Why it was not.
    #[wasm_bindgen(js_name = loadProblem)]
    pub(super) fn load_problem(name: &str) -> Option<String>;
    /// Writes a line to the console.
    pub(super) fn tell(line: &str);
    /// Writes a line to the console, and tells the page that the program has ended by it.
    fn failed(line: &str);
    /// The paths of the files that the page has kept.
    #[wasm_bindgen(js_name = keptPaths)]
    fn kept_paths() -> Vec<String>;
    /// The content of one of them.
    #[wasm_bindgen(js_name = keptBytes)]
    fn kept_bytes(path: &str) -> Vec<u8>;
    /// The number of this tab.
    pub(super) fn process() -> u32;
    /// How many bytes more the page can keep.
    pub(super) fn room() -> f64;
    /// Locks a file for this tab. False if another tab has it.
    pub(super) fn hold(path: &str) -> bool;
    /// Unlocks a file.
    pub(super) fn release(path: &str);
    /// Hears of what happens: its sort, what it is about, and the content of a file.
    pub(super) fn attend(happened: &Closure<dyn FnMut(String, String, Vec<u8>)>);
    /// Says that there are no more pictures, and offers to load the page again.
    pub(super) fn stopped(line: &str);
    /// Notes what may end the page, a line each.
    #[wasm_bindgen(js_name = noteTrials)]
    pub(super) fn note_trials(names: &str);
    /// What was noted by pages that have ended so.
    #[wasm_bindgen(js_name = fatalTrials)]
    pub(super) fn fatal_trials() -> Vec<String>;
    /// Keeps a file.
    pub(super) fn keep(path: &str, bytes: &[u8]);
    /// Keeps a file no longer.
    pub(super) fn forget(path: &str);
    /// Hands a file to the browser as a download.
    pub(super) fn download(name: &str, bytes: &[u8]);
    /// Calls a function after a time.
    pub(super) fn after(milliseconds: f64, call: &JsValue);
    /// Hears of files that are dropped on the page: their names, their bytes, and whether they are the last.
    pub(super) fn listen(brought: &Closure<dyn FnMut(String, Vec<u8>, bool)>);
    /// The title of the page, and whether it asks before it is closed.
    pub(super) fn titled(title: &str, unsaved: bool);
    /// Lets the canvas take the place of what the page has shown so far.
    pub(super) fn shown();
    /// Copies a picture to the clipboard.
    #[wasm_bindgen(js_name = copyPicture)]
    pub(super) fn copy_picture(rgba: Vec<u8>, width: u32, height: u32);
}

/// The files that the page has kept.
pub(super) fn kept() -> impl Iterator<Item = (String, Vec<u8>)> {
    kept_paths().into_iter().map(|path| {
        let bytes = kept_bytes(&path);
        (path, bytes)
    })
}

/// Makes the page say that the program has panicked.
pub fn report_panics() {
    panic::set_hook(Box::new(|info| failed(&info.to_string())));
}
