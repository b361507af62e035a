//! Combines shader sources: pure text to text. A [`LineMap`] leads from a line of the composed text back to
//! the author's file.
//!
//! Any file may import another file of the author: the line `#import "noise.wgsl"`, with a path relative to
//! the importing file's folder, inserts that file before it, once per composed source however often it is
//! imported. Of the built-in files, [`PANORAMA`] and [`HALF_DIFFERENCE`] can be imported.

use std::{
    collections::{BTreeMap, BTreeSet, HashSet},
    fmt::Write as _,
    sync::Arc,
};

use super::{Source, problem::ShaderProblem, wgsl};
use crate::parameter;

/// The vocabulary of the models, in the order of dependencies.
pub const OPTICS: &[Source] = &[
    wgsl!("terms.wgsl"),
    wgsl!("optics/fresnel.wgsl"),
    wgsl!("optics/distribution.wgsl"),
    wgsl!("optics/masking.wgsl"),
    wgsl!("optics/diffuse.wgsl"),
    wgsl!("optics/lobe.wgsl"),
    wgsl!("optics/film.wgsl"),
];
/// More of it, for models that light passes through: other models may use these names for their own functions.
pub const TRANSMISSION: &[Source] =
    &[wgsl!("optics/refraction.wgsl"), wgsl!("optics/interface.wgsl"), wgsl!("optics/slab.wgsl")];
/// The refractive index by wavelength, for solid bodies.
pub const DISPERSION: Source = wgsl!("optics/dispersion.wgsl");
/// Absorption along a way, for solid bodies.
pub const ABSORPTION: Source = wgsl!("optics/absorption.wgsl");
/// The directional albedo from the curve in a row, for models that have one.
pub const ALBEDO: Source = wgsl!("optics/albedo.wgsl");
/// Tables over half and difference angles, for models that import it.
pub const HALF_DIFFERENCE: Source = wgsl!("optics/half_difference.wgsl");
/// Pictures of the surroundings, for light types that import it.
pub const PANORAMA: Source = wgsl!("optics/panorama.wgsl");
/// The light record.
pub const LIGHTS: Source = wgsl!("lights.wgsl");
/// Random directions, for light with extent.
pub const SAMPLING: Source = wgsl!("sampling.wgsl");
/// The part of the light loop for light with extent.
pub const EXTENDED: Source = wgsl!("extended.wgsl");
/// The intersection of a ray with a mesh.
pub const HIERARCHY: Source = wgsl!("hierarchy.wgsl");
/// The way of light within a solid, after [`HIERARCHY`].
pub const INSIDE: Source = wgsl!("inside.wgsl");
/// The light that comes through a solid body, after [`INSIDE`].
pub const THROUGH: Source = wgsl!("through.wgsl");
/// The light loop.
pub const LOOP: Source = wgsl!("loop.wgsl");
/// The inputs and outputs of a shading model.
pub const SHADING: Source = wgsl!("shading.wgsl");
/// The debug channels.
pub const CHANNELS: Source = wgsl!("channels.wgsl");
/// The last step of every pixel.
pub const DISPLAY: Source = wgsl!("display.wgsl");
/// The wrapper that draws lights with extent.
pub const SEEN: Source = wgsl!("seen.wgsl");
/// The wrapper for the renderer: bindings and entry points.
pub const WRAPPER: Source = wgsl!("wrapper.wgsl");

/// The entry point that evaluates a single model.
pub const EVALUATE: Source = wgsl!("evaluate.wgsl");

/// The generated part of solid models, with the buffer of the mesh.
pub const BODY: &str = "(the body)";

/// The generated part of models that read a file, with the buffer of its numbers.
pub const FILE: &str = "(the file)";

/// The generated part of the source of a single light type, with the numbers of its files.
pub const LIGHT_ALONE: &str = "(light type)";

/// The generated parts of the source of a single shading model.
pub const SHADING_ALONE: &str = "(shading model)";

/// The texts of sources: edited copies by path, otherwise the built-in ones. Cloning is cheap: clones share the texts.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Sources {
    edited: BTreeMap<String, Arc<str>>,
}

impl Sources {
    /// The current text of a source.
    #[must_use]
    pub fn text<'a>(&'a self, source: &'a Source) -> &'a str {
        self.get(source.path).unwrap_or(source.text)
    }

    /// The edited text with this path, if any.
    #[must_use]
    pub fn get(&self, path: &str) -> Option<&str> {
        self.edited.get(path).map(|text| &**text)
    }

    /// Replaces the text of a source by path.
    pub fn edit(&mut self, path: impl Into<String>, text: impl Into<Arc<str>>) {
        self.edited.insert(path.into(), text.into());
    }

    /// Restores the built-in text of a path.
    pub fn forget(&mut self, path: &str) {
        self.edited.remove(path);
    }

    /// The paths with an edited text.
    pub fn edited(&self) -> impl Iterator<Item = &str> {
        self.edited.keys().map(String::as_str)
    }

    /// Copies the edited text of a path, or its absence.
    pub fn copy_from(&mut self, other: &Self, path: &str) {
        match other.edited.get(path) {
            Some(text) => self.edit(path, text.clone()),
            None => self.forget(path),
        }
    }
}

/// Maps lines of a composed source to files.
#[derive(Clone, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct LineMap {
    /// First line (from 1) of each piece in the composed text, and the path of its file.
    pieces: Vec<(usize, String)>,
}

impl LineMap {
    /// The file and line (from 1) from which a line (from 1) of the composed text came.
    #[must_use]
    pub fn locate(&self, line: usize) -> Option<(&str, usize)> {
        let (first, path) = self.pieces.iter().rev().find(|(first, _)| *first <= line)?;
        Some((path, line - first + 1))
    }

    /// The files of the composed text, in the order of dependencies. Names of generated ones are in
    /// parentheses.
    pub fn files(&self) -> impl Iterator<Item = &str> {
        self.pieces.iter().map(|(_, path)| path.as_str())
    }

    /// True if a file is part of the composed text.
    #[must_use]
    pub fn has(&self, path: &str) -> bool {
        self.files().any(|file| file == path)
    }
}

/// A composed source.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Composed {
    /// The WGSL text.
    pub text: String,
    /// The origin of each line.
    pub map: LineMap,
    /// The files named by `#import`, found or not: a change of one of them changes the source.
    pub imports: BTreeSet<String>,
    /// The first `#import` that could not be resolved.
    pub problem: Option<Box<ShaderProblem>>,
}

impl Composed {
    /// True if the source may change when a file changes.
    #[must_use]
    pub fn depends_on(&self, path: &str) -> bool {
        self.map.has(path) || self.imports.contains(path)
    }

    /// The first line (from 1) of the file that contributes most of the text.
    #[must_use]
    pub fn longest_file(&self) -> Option<usize> {
        let mut sizes = vec![0; self.map.pieces.len()];
        let mut piece = 0;
        for (i, line) in self.text.lines().enumerate() {
            while self.map.pieces.get(piece + 1).is_some_and(|(first, _)| *first <= i + 1) {
                piece += 1;
            }
            if let Some(size) = sizes.get_mut(piece) {
                *size += line.len();
            }
        }
        let longest = (0..sizes.len()).max_by_key(|i| sizes[*i])?;
        Some(self.map.pieces[longest].0)
    }
}

/// Builds a composed source piece by piece.
pub(crate) struct Composer<'a> {
    sources: &'a Sources,
    /// The source so far.
    pub(crate) composed: Composed,
    lines: usize,
    /// The files being added, the most recent import last.
    open: Vec<String>,
    done: HashSet<String>,
}

impl<'a> Composer<'a> {
    pub(crate) fn new(sources: &'a Sources) -> Self {
        Self { sources, composed: Composed::default(), lines: 0, open: Vec::new(), done: HashSet::new() }
    }

    /// The text of a source.
    pub(crate) fn text(&self, source: &'a Source) -> &'a str {
        self.sources.text(source)
    }

    /// Adds a source, after its imports.
    pub(crate) fn source(&mut self, source: &Source) {
        let text = self.sources.text(source);
        if text != source.text {
            self.check_end(source.path, text);
        }
        self.file(source.path, text);
    }

    /// Reports anything that would swallow the next file.
    fn check_end(&mut self, path: &str, text: &str) {
        if let Some((at, what)) = super::limits::unfinished(text) {
            let problem = || Box::new(ShaderProblem::at(path, text, at, what));
            self.composed.problem.get_or_insert_with(problem);
        }
    }

    fn file(&mut self, path: &str, text: &str) {
        self.open.push(path.to_owned());
        let mut own = String::with_capacity(text.len());
        for (i, line) in text.lines().enumerate() {
            let line = line.trim_end_matches('\r');
            match import_of(line) {
                Some(name) => {
                    self.import(path, i + 1, line, name);
                    own.push_str("// ");
                }
                None if line.trim_start().starts_with("#define_import_path") => self.complain(
                    path,
                    i + 1,
                    line,
                    "files here have no import path: remove this line, and write `#import \"file.wgsl\"` where the file is needed",
                ),
                None => {}
            }
            own.push_str(line);
            own.push('\n');
        }
        self.open.pop();
        self.push(path, &own);
    }

    /// Adds the file imported by a line, unless it was added before.
    fn import(&mut self, from: &str, at: usize, line: &str, name: &str) {
        let Some(path) = beside(from, name) else {
            return self.complain(from, at, line, &format!("`{name}` leads out of the folder of shaders"));
        };
        self.composed.imports.insert(path.clone());
        if let Some(first) = self.open.iter().position(|open| *open == path) {
            let round: Vec<_> = self.open[first..].iter().chain([&path]).map(|path| shown(path)).collect();
            return self.complain(from, at, line, &format!("circular import: {}", round.join(" → ")));
        }
        if !self.done.insert(path.clone()) {
            return;
        }
        let importable = [PANORAMA, HALF_DIFFERENCE];
        let built_in = importable.iter().find(|source| source.path == path).map(|source| source.text);
        let most = super::limits::LIMITS.bytes;
        match self.sources.get(&path).or(built_in) {
            Some(text) if self.composed.text.len() + text.len() > most => {
                let what = format!("with this file the shader exceeds the limit of {most} bytes");
                self.complain(from, at, line, &what);
            }
            Some(text) => {
                self.check_end(&path, text);
                self.file(&path, text);
            }
            None => self.complain(from, at, line, &format!("there is no file `{}` to import", shown(&path))),
        }
    }

    fn complain(&mut self, file: &str, line: usize, source: &str, message: &str) {
        let column = source.chars().take_while(|c| c.is_whitespace()).count() + 1;
        self.composed.problem.get_or_insert_with(|| {
            Box::new(ShaderProblem {
                file: file.to_owned(),
                line,
                column,
                source: source.to_owned(),
                message: message.to_owned(),
            })
        });
    }

    /// Adds a text unchanged.
    pub(crate) fn push(&mut self, path: &str, text: &str) {
        self.composed.map.pieces.push((self.lines + 1, path.to_owned()));
        self.composed.text.push_str(text);
        self.lines += text.matches('\n').count();
        if !text.ends_with('\n') {
            self.composed.text.push('\n');
            self.lines += 1;
        }
    }
}

/// A path as shown in messages: custom models are in a folder of any name, which stands before the message.
pub(super) fn shown(path: &str) -> &str {
    path.strip_prefix("models/").unwrap_or(path)
}

/// The file named by a line `#import "file.wgsl"`. Imports without quotation marks are modules of Bevy.
fn import_of(line: &str) -> Option<&str> {
    let rest = line.trim().strip_prefix("#import")?.trim_start().strip_prefix('"')?;
    let (name, rest) = rest.split_once('"')?;
    (rest.trim().is_empty() || rest.trim().starts_with("//") || rest.trim() == ";").then_some(name)
}

/// The paths of the files imported by a text; `path` is the path of the text itself.
pub(crate) fn imports_of<'a>(path: &'a str, text: &'a str) -> impl Iterator<Item = String> + 'a {
    text.lines().filter_map(import_of).filter_map(move |name| beside(path, name))
}

/// The path of a file named in another one, relative to the folder of that one; `None` if it leads out.
fn beside(from: &str, name: &str) -> Option<String> {
    let mut parts: Vec<_> = from.split('/').collect();
    parts.pop();
    for part in name.split(['/', '\\']) {
        match part {
            "" | "." => {}
            ".." => {
                parts.pop()?;
            }
            part => parts.push(part),
        }
    }
    (!parts.is_empty()).then(|| parts.join("/"))
}

/// The WGSL struct of parameters. Without parameters it gets an unused field, since WGSL has no empty structs.
#[must_use]
pub fn parameter_struct(name: &str, parameters: &[parameter::Parameter]) -> String {
    let mut text = format!("struct {name} {{\n");
    for (name, kind, _) in parameter::layout(parameters) {
        let _ = writeln!(text, "    {name}: {kind},");
    }
    if parameters.is_empty() {
        text.push_str("    unused: f32,\n");
    }
    text.push_str("}\n");
    text
}
