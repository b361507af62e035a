//! Users' models, one file each: `models/ID.wgsl` declares at its top the model's name and parameters, and defines
//! below it `fn response` in WGSL. Nothing is compiled into the program. The files of a [`folder`] are read on demand:
//! a used model completely, the declarations of others when needed, otherwise nothing.
//!
//! ```wgsl
//! /* lcm
//! {
//!     "name": "Matte",
//!     "laws": ["reciprocal", "energy conserving", "non-negative"],
//!     "parameters": ["base_colour", { "name": "strength", "min": 0, "max": 1, "default": 0.8 }],
//! }
//! */
//! fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {
//!     let cos_l = max(dot(frame.n, l), 0.0);
//!     return Terms(vec3(0.0), m.strength * m.base_colour * cos_l, vec3(0.0));
//! }
//! ```
//!
//! The GPU runs the file unchanged, the CPU interprets it. With a second function `fn ambient_response(v: vec3<f32>,
//! frame: Frame, m: Parameters) -> vec3<f32>` the model answers uniform light by a formula, without it by its
//! directional albedo. In a model that light passes through (`"transmits": true`), `fn sharp(i: u32, v: vec3<f32>, frame:
//! Frame, m: Parameters) -> Sharp` gives the directions in which light does not spread.

use std::{path::Path, sync::Arc};

use crate::files::Shown as _;
use crate::{
    reflection::{Ambient, Declaration},
    registry::{Registry, check::wgsl, compose::compose},
    shader::{Source, check::ShaderProblem, limits, whole::validate_drawing},
    shading::Stage,
};

mod condition;
mod curves;
mod declaration;
pub mod file;
pub mod folder;
mod intern;
mod knobs;
mod lobes;
mod reader;
mod surface;
mod text;
mod write;

use curves::Reads;
pub use surface::OnCpu;
pub use text::MARKER;
pub use write::{BadName, NotDuplicated, duplicate, id_of_name, template};

/// The file extension.
pub const EXTENSION: &str = "wgsl";

pub use crate::registry::CustomModel;

/// The name of a model's file in messages and [`Sources`](crate::shader::compose::Sources).
#[must_use]
pub fn source_path(id: &str) -> String {
    format!("models/{id}.{EXTENSION}")
}

/// The id of the model in a file: the file name without its extension.
#[must_use]
pub fn id_of(path: &Path) -> Option<&str> {
    path.extension().filter(|e| *e == EXTENSION).and(path.file_stem()).and_then(|stem| stem.to_str())
}

/// True if a word is a valid model id: lower-case letters, digits and underscores, starting with a letter.
#[must_use]
pub fn is_id(word: &str) -> bool {
    text::identifier(word).is_ok()
}

/// True if a text is a model: it has a declaration, or defines `response`. Other files in the folder contain
/// functions shared by models.
#[must_use]
pub fn is_model(text: &str) -> bool {
    // An unclosed comment swallows the function.
    let begins =
        text.trim_start().strip_prefix("/*").is_some_and(|rest| rest.trim_start().starts_with(MARKER));
    begins || text::comment(text).is_ok() || text::definition(text, "response").is_some()
}

/// The bytes of the declaration in a text: what stands in its comment.
#[must_use]
pub fn declaration_place(text: &str) -> Option<std::ops::Range<usize>> {
    let comment = text::comment(text).ok()?;
    Some(comment.start..comment.start + comment.json.len())
}

/// The name of a file in messages, before its validity is known.
fn named(path: &Path) -> String {
    format!("models/{}", path.file_name().unwrap_or_default().to_string_lossy())
}

/// A problem at a byte of a model's file.
fn problem(path: &Path, text: &str, (at, message): text::Mistake) -> ShaderProblem {
    ShaderProblem::at(&named(path), text, at, message)
}

/// Reads a model: checks its declaration, and its WGSL as far as possible without drawing. If the registry
/// already has a custom model with this id, this one is its next version.
///
/// # Errors
/// Returns every error in the declaration, or the first error in the WGSL.
pub fn read(path: &Path, text: &str, registry: &Registry) -> Result<CustomModel, Vec<ShaderProblem>> {
    let (model, reads) = declared(path, text, registry)?;
    let problem_at = |at, message: String| vec![problem(path, text, (at, message))];
    // The comment may contain the function.
    if let Some((at, what)) = limits::unfinished(text) {
        return Err(problem_at(at, what));
    }
    if let Some((at, what)) = wgsl::RESPONSE.missing(text) {
        return Err(problem_at(at.unwrap_or_else(|| text::comment(text).map_or(0, |c| c.end)), what));
    }
    let mut sources = registry.sources().clone();
    sources.edit(model.entry.declaration.wgsl.path, model.text.clone());
    let module = wgsl::model(&sources, &model.entry).map_err(|found| vec![*found])?;
    for shading in registry.shading_models() {
        let drawn = (&model.entry, model.entry.declaration.passage());
        let composed = compose(&sources, drawn, shading, registry.lights());
        let faces = shading.declaration.stage == Stage::Polygon;
        validate_drawing(&composed, faces).map_err(|found| vec![*found])?;
    }
    let entry = surface::entry(model.entry.declaration, model.entry.parameters, reads, &module)
        .grouped(model.entry.groups);
    Ok(CustomModel { entry, ..model })
}

/// Reads the declaration of a model without its WGSL; both renderers draw a fallback. Used for models that
/// are not needed yet, and when the window opens while a file is broken. Cheap: nothing is compiled.
///
/// # Errors
/// Returns every error in the declaration.
pub fn declare(path: &Path, text: &str, registry: &Registry) -> Result<CustomModel, Vec<ShaderProblem>> {
    declared(path, text, registry).map(|(model, _)| model)
}

/// The declared model, drawn with the fallback, and the curves that it reads.
fn declared(
    path: &Path,
    text: &str,
    registry: &Registry,
) -> Result<(CustomModel, Reads), Vec<ShaderProblem>> {
    let wrong = |mistake| problem(path, text, mistake);
    let id = usable_id(path, registry).map_err(|what| vec![wrong((0, what))])?;
    let said = declaration::read(text, id, registry)
        .map_err(|mistakes| mistakes.into_iter().map(wrong).collect::<Vec<_>>())?;
    let formula = text::definition(&text[said.end..], "ambient_response").is_some();
    let ambient = if formula { Ambient::Formula } else { Ambient::Albedo };
    // Other models may have a function of that name for their own use.
    let sharp = said.transmits && text::definition(&text[said.end..], "sharp").is_some();
    let wgsl = Source { path: intern::text(&source_path(id)), text: intern::text(&stand_in(ambient, sharp)) };
    let declaration = intern::declaration(Declaration {
        author: said.author,
        source: said.source,
        summary: said.summary,
        equation: said.equation,
        laws: said.laws,
        ambient,
        anisotropic: said.anisotropic,
        transmits: said.transmits,
        lit_from_below: said.lit_from_below,
        boundary: said.boundary,
        sharp,
        ..Declaration::new(intern::text(id), said.name, wgsl)
    });
    let lobe = said.lobe.and_then(|id| registry.model(id)).cloned();
    let reads = Reads { lobe, own: said.curves.into(), lobes: Arc::new(said.lobes) };
    let entry = surface::stand_in(declaration, said.parameters, &reads).grouped(said.groups);
    Ok((CustomModel { entry, path: path.to_owned(), text: text.into() }, reads))
}

/// The id of a file, if valid.
fn usable_id<'a>(path: &'a Path, registry: &Registry) -> Result<&'a str, String> {
    let id = id_of(path)
        .ok_or_else(|| format!("the file name is {}, but it must be ID.{EXTENSION}", path.shown()))?;
    text::identifier(id).map_err(|rule| format!("the file name is the id of the model: {id} {rule}"))?;
    if registry.model(id).is_some() && registry.custom_file(id).is_none() {
        return Err(format!("{id} is the id of a built-in model; give the file another name"));
    }
    Ok(id)
}

/// The fallback for models without a valid version: Lambert's law in grey, regardless of the parameters, with the
/// functions that the declaration promises.
pub(crate) fn stand_in(ambient: Ambient, sharp: bool) -> String {
    let ambient = if ambient == Ambient::Formula { include_str!("stand_in_ambient.wgsl") } else { "" };
    let sharp = if sharp { include_str!("stand_in_sharp.wgsl") } else { "" };
    [include_str!("stand_in.wgsl"), ambient, sharp].concat()
}
