//! Joining the shader sources: pure text to text.
//!
//! One composed source holds, in this order: terms, the light record, the row of an object (generated
//! from the declaration of the model), the reading of curves where rows have them, the model, the light
//! types, the dispatch over light types (generated), the light loop, the shading mode, and the wrapper
//! with bindings and entry points. A [`LineMap`] leads from a line of the composed text back to the author's file.

use std::{collections::HashMap, fmt::Write as _};

use super::{Source, wgsl};
use crate::{
    light::LightEntry,
    optics::albedo::NODES,
    reflection::{Ambient, ModelEntry, parameter},
    shading::ModeEntry,
};

/// The vocabulary of the models, in the order of need.
pub const OPTICS: &[Source] = &[
    wgsl!("terms.wgsl"),
    wgsl!("optics/fresnel.wgsl"),
    wgsl!("optics/distribution.wgsl"),
    wgsl!("optics/masking.wgsl"),
    wgsl!("optics/diffuse.wgsl"),
    wgsl!("optics/lobe.wgsl"),
];
/// The directional albedo from the curve in a row, for models that have one.
pub const ALBEDO: Source = wgsl!("optics/albedo.wgsl");
/// The light record.
pub const LIGHTS: Source = wgsl!("lights.wgsl");
/// The light loop.
pub const LOOP: Source = wgsl!("loop.wgsl");
/// What goes into and out of a shading mode.
pub const SHADING: Source = wgsl!("shading.wgsl");
/// The wrapper for the renderer: bindings and entry points.
pub const WRAPPER: Source = wgsl!("wrapper.wgsl");

/// Where the text of a source comes from: edited copies by path, else the built-in one.
#[derive(Clone, Debug, Default)]
pub struct Sources {
    edited: HashMap<String, String>,
}

impl Sources {
    /// The current text of a source.
    #[must_use]
    pub fn text<'a>(&'a self, source: &'a Source) -> &'a str {
        self.edited.get(source.path).map_or(source.text, String::as_str)
    }

    /// Replaces the text of a source by path.
    pub fn edit(&mut self, path: impl Into<String>, text: impl Into<String>) {
        self.edited.insert(path.into(), text.into());
    }
}

/// Leads from lines of a composed source back to files.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LineMap {
    /// First line (from 1) of each piece in the composed text, and the path of its file.
    pieces: Vec<(usize, String)>,
}

impl LineMap {
    /// The file and line (from 1) that a line (from 1) of the composed text came from.
    #[must_use]
    pub fn locate(&self, line: usize) -> Option<(&str, usize)> {
        let (first, path) = self.pieces.iter().rev().find(|(first, _)| *first <= line)?;
        Some((path, line - first + 1))
    }
}

/// A composed source.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Composed {
    /// The WGSL text.
    pub text: String,
    /// Where each line came from.
    pub map: LineMap,
}

/// Builds a composed source piece by piece.
#[derive(Default)]
struct Composer {
    text: String,
    lines: usize,
    map: LineMap,
}

impl Composer {
    fn push(&mut self, path: &str, text: &str) {
        self.map.pieces.push((self.lines + 1, path.to_owned()));
        self.text.push_str(text);
        self.lines += text.matches('\n').count();
        if !text.ends_with('\n') {
            self.text.push('\n');
            self.lines += 1;
        }
    }

    fn finish(self) -> Composed {
        Composed { text: self.text, map: self.map }
    }
}

/// The WGSL struct `Parameters` of a model. A model without parameters gets an unused field, since
/// WGSL has no empty structs.
#[must_use]
pub fn parameter_struct(parameters: &[parameter::Parameter]) -> String {
    let mut text = String::from("struct Parameters {\n");
    for (name, kind, _) in parameter::layout(parameters) {
        let _ = writeln!(text, "    {name}: {kind},");
    }
    if parameters.is_empty() {
        text.push_str("    unused: f32,\n");
    }
    text.push_str("}\n");
    text
}

/// The WGSL struct `Row` of a model, what one object has in the table that the shader reads, and the
/// functions that read the curve in it. The array of rows is `parameter_table`, the index of the
/// object's own `object_row`. Curves are read in place: a copy would cost every pixel.
#[must_use]
pub fn row_struct(model: &ModelEntry) -> String {
    let mut text = parameter_struct(model.parameters);
    if !model.has_curve() {
        text.push_str("struct Row {\n    parameters: Parameters,\n}\n");
        return text;
    }
    let harmonics = model.harmonics();
    let _ = write!(
        text,
        "struct Row {{
    parameters: Parameters,
    curve: array<vec4<f32>, {}>,
    lobe_mean: f32,
}}
const HARMONICS: u32 = {harmonics}u;
fn curve_node(i: u32) -> vec4<f32> {{
    return parameter_table[object_row].curve[i];
}}
fn lobe_mean() -> f32 {{
    return parameter_table[object_row].lobe_mean;
}}
",
        harmonics * NODES
    );
    text
}

/// The row of a model, and the model.
fn push_model(c: &mut Composer, sources: &Sources, model: &ModelEntry) {
    c.push("(row)", &row_struct(model));
    if model.has_curve() {
        c.push(ALBEDO.path, sources.text(&ALBEDO));
    }
    c.push(model.declaration.wgsl.path, sources.text(&model.declaration.wgsl));
    if model.declaration.ambient == Ambient::Albedo {
        c.push("(ambient)", AMBIENT);
    }
}

/// How models answer to light from everywhere that declare to do so by their albedo.
const AMBIENT: &str = "fn ambient_response(v: vec3<f32>, frame: Frame, m: Parameters) -> vec3<f32> {
    return directional_albedo(v, frame);
}
";

/// The function that hands a light to its type, by the index of the type in the registry.
#[must_use]
pub fn light_dispatch(lights: &[LightEntry]) -> String {
    let mut text =
        String::from("fn incident(light: Light, p: vec3<f32>) -> Incident {\n    switch light.kind {\n");
    for (i, light) in lights.iter().enumerate() {
        let _ =
            writeln!(text, "        case {i}u: {{ return incident_{}(light, p); }}", light.declaration.id);
    }
    text.push_str("        default: { return Incident(vec3(0.0), 0.0, 0u); }\n    }\n}\n");
    text
}

/// The complete source for drawing with a model and a mode under the given light types.
#[must_use]
pub fn compose(sources: &Sources, model: &ModelEntry, mode: &ModeEntry, lights: &[LightEntry]) -> Composed {
    let mut c = Composer::default();
    let source = |c: &mut Composer, s: &Source| c.push(s.path, sources.text(s));
    for s in OPTICS {
        source(&mut c, s);
    }
    source(&mut c, &LIGHTS);
    source(&mut c, &SHADING);
    push_model(&mut c, sources, model);
    for light in lights {
        source(&mut c, &light.declaration.wgsl);
    }
    c.push("(light types)", &light_dispatch(lights));
    source(&mut c, &LOOP);
    source(&mut c, &mode.declaration.wgsl);
    source(&mut c, &WRAPPER);
    c.finish()
}

/// The source for evaluating a model alone in a compute pass: directions in, terms out.
#[must_use]
pub fn compose_evaluation(sources: &Sources, model: &ModelEntry) -> Composed {
    let mut c = Composer::default();
    for s in OPTICS {
        c.push(s.path, sources.text(s));
    }
    push_model(&mut c, sources, model);
    c.push(EVALUATE.path, sources.text(&EVALUATE));
    c.finish()
}

/// The entry point of [`compose_evaluation`].
pub const EVALUATE: Source = wgsl!("evaluate.wgsl");

#[cfg(test)]
mod tests {
    use super::*;
    use crate::registry::Registry;

    #[test]
    fn every_line_leads_back_to_its_file() {
        let registry = Registry::builtin();
        for model in registry.models() {
            for mode in registry.modes() {
                let composed = compose(&Sources::default(), model, mode, registry.lights());
                let pieces =
                    [OPTICS[0], OPTICS[1], LOOP, WRAPPER, model.declaration.wgsl, mode.declaration.wgsl];
                for (i, line) in composed.text.lines().enumerate() {
                    let (path, at) = composed.map.locate(i + 1).expect("every line has a place");
                    if let Some(source) = pieces.iter().find(|s| s.path == path) {
                        assert_eq!(source.text.lines().nth(at - 1), Some(line), "{path}:{at}");
                    }
                }
            }
        }
    }

    #[test]
    fn an_edited_source_replaces_the_built_in_one() {
        let registry = Registry::builtin();
        let mut sources = Sources::default();
        sources.edit("loop.wgsl", "// edited");
        let composed = compose(&sources, &registry.models()[0], &registry.modes()[0], registry.lights());
        assert!(composed.text.contains("// edited"));
        assert!(!composed.text.contains("fn illuminate"));
    }

    #[test]
    fn every_light_type_is_dispatched_by_its_index() {
        let registry = Registry::builtin();
        let text = light_dispatch(registry.lights());
        for (i, light) in registry.lights().iter().enumerate() {
            assert!(text.contains(&format!("case {i}u: {{ return incident_{}(", light.declaration.id)));
        }
    }
}
