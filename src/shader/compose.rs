//! Joining the shader sources: pure text to text.
//!
//! One composed source holds, in this order: terms, the light record, the row of an object (generated
//! from the declaration of the model), the reading of curves where rows have them, the model, the light
//! types, the dispatch over light types (generated), the light loop, the shading mode, and the wrapper
//! with bindings and entry points. A [`LineMap`] leads from a line of the composed text back to the author's file.
//!
//! Any file may ask for another one of the author's: the line `#import "noise.wgsl"` puts that file, named from
//! the folder of the file that asks, before it, once in a composed source however often it is asked for.

use std::{
    collections::{BTreeMap, BTreeSet, HashSet},
    fmt::Write as _,
    sync::Arc,
};

use super::{Source, check::ShaderProblem, wgsl};
use crate::{
    light::LightEntry,
    optics::albedo::NODES,
    reflection::{Ambient, Family, ModelEntry, parameter},
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

/// Where the text of a source comes from: edited copies by path, else the built-in one. Copies are cheap:
/// they share the texts.
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

    /// The edited text of that path, if there is one.
    #[must_use]
    pub fn get(&self, path: &str) -> Option<&str> {
        self.edited.get(path).map(|text| &**text)
    }

    /// Replaces the text of a source by path.
    pub fn edit(&mut self, path: impl Into<String>, text: impl Into<Arc<str>>) {
        self.edited.insert(path.into(), text.into());
    }

    /// Goes back to the built-in text of a path.
    pub fn forget(&mut self, path: &str) {
        self.edited.remove(path);
    }

    /// The paths that have an edited text.
    pub fn edited(&self) -> impl Iterator<Item = &str> {
        self.edited.keys().map(String::as_str)
    }

    /// Takes over the edited text of a path, or that it has none.
    pub fn copy_from(&mut self, other: &Self, path: &str) {
        match other.edited.get(path) {
            Some(text) => self.edit(path, text.clone()),
            None => self.forget(path),
        }
    }
}

/// Leads from lines of a composed source back to files.
#[derive(Clone, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
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

    /// The files that the composed text was made of, in the order of need. What is generated stands in
    /// parentheses.
    pub fn files(&self) -> impl Iterator<Item = &str> {
        self.pieces.iter().map(|(_, path)| path.as_str())
    }

    /// Whether a file is part of the composed text.
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
    /// Where each line came from.
    pub map: LineMap,
    /// The files that were asked for by `#import`, found or not: when one changes, so does this.
    pub imports: BTreeSet<String>,
    /// The first `#import` that could not be followed.
    pub problem: Option<Box<ShaderProblem>>,
}

impl Composed {
    /// Whether this may change when a file changes.
    #[must_use]
    pub fn depends_on(&self, path: &str) -> bool {
        self.map.has(path) || self.imports.contains(path)
    }

    /// The first line (from 1) of the file that has most of the text.
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

/// A text that means the same without comments and indentation, and with few lines, each of which costs the composer
/// time. Places in it are not those of the text.
#[must_use]
pub fn slim(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    // An import in braces may go on in the next lines.
    let mut importing = false;
    for line in without_comments(text).lines().map(str::trim_end).filter(|line| !line.is_empty()) {
        let directive = line.starts_with('#');
        if (directive || importing) && !out.is_empty() && !out.ends_with('\n') {
            out.push('\n');
        }
        out.push_str(line);
        importing = (importing || line.starts_with("#import")) && {
            let import = out.rfind("#import").map_or("", |start| &out[start..]);
            import.matches('{').count() > import.matches('}').count()
        };
        out.push(if directive || importing { '\n' } else { ' ' });
    }
    out
}

/// A text without comments and indentation; lines stay where they are.
fn without_comments(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    // How many `/*` are open: they nest.
    let mut depth = 0_usize;
    for line in text.lines() {
        let line = line.trim();
        let bytes = line.as_bytes();
        // The first byte that is not put out yet, and the one that is looked at.
        let (mut from, mut at) = (0, 0);
        while at < bytes.len() {
            match (depth, bytes[at], bytes.get(at + 1)) {
                (0, b'/', Some(b'/')) => break,
                (_, b'/', Some(b'*')) => {
                    if depth == 0 {
                        out.push_str(&line[from..at]);
                        // What stands before and behind stays apart.
                        out.push(' ');
                    }
                    depth += 1;
                    at += 2;
                }
                (1.., b'*', Some(b'/')) => {
                    depth -= 1;
                    at += 2;
                    from = at;
                }
                _ => at += 1,
            }
        }
        if depth == 0 {
            out.push_str(&line[from..at]);
        }
        out.push('\n');
    }
    out
}

/// Builds a composed source piece by piece.
struct Composer<'a> {
    sources: &'a Sources,
    composed: Composed,
    lines: usize,
    /// The files that are being put in: the one that was asked for last stands last.
    open: Vec<String>,
    done: HashSet<String>,
}

impl<'a> Composer<'a> {
    fn new(sources: &'a Sources) -> Self {
        Self { sources, composed: Composed::default(), lines: 0, open: Vec::new(), done: HashSet::new() }
    }

    /// Puts in a source, after the files that it asks for.
    fn source(&mut self, source: &Source) {
        let text = self.sources.text(source);
        if text != source.text {
            self.check_end(source.path, text);
        }
        self.file(source.path, text);
    }

    /// Complains of what would swallow the file behind.
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
                    "files of the lab have no import path: leave this line out, and write `#import \"file.wgsl\"` where the file is needed",
                ),
                None => {}
            }
            own.push_str(line);
            own.push('\n');
        }
        self.open.pop();
        self.push(path, &own);
    }

    /// Puts in the file that a line asks for, unless it is there already.
    fn import(&mut self, from: &str, at: usize, line: &str, name: &str) {
        let Some(path) = beside(from, name) else {
            return self.complain(
                from,
                at,
                line,
                &format!("`{name}` leads out of the folder of the shaders"),
            );
        };
        self.composed.imports.insert(path.clone());
        if let Some(first) = self.open.iter().position(|open| *open == path) {
            let mut round: Vec<_> = self.open[first..].to_vec();
            round.push(path);
            return self.complain(
                from,
                at,
                line,
                &format!("the files import each other in a circle: {}", round.join(" → ")),
            );
        }
        if !self.done.insert(path.clone()) {
            return;
        }
        match self.sources.get(&path) {
            Some(text) if self.composed.text.len() + text.len() > super::limits::LIMITS.bytes => self
                .complain(
                    from,
                    at,
                    line,
                    &format!(
                        "with this file the shader has more than {} bytes, which are all that are allowed",
                        super::limits::LIMITS.bytes
                    ),
                ),
            Some(text) => {
                self.check_end(&path, text);
                self.file(&path, text);
            }
            None => self.complain(from, at, line, &format!("there is no file `{path}` to import")),
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

    /// Puts in a text as it is.
    fn push(&mut self, path: &str, text: &str) {
        self.composed.map.pieces.push((self.lines + 1, path.to_owned()));
        self.composed.text.push_str(text);
        self.lines += text.matches('\n').count();
        if !text.ends_with('\n') {
            self.composed.text.push('\n');
            self.lines += 1;
        }
    }
}

/// The file that a line `#import "file.wgsl"` asks for. Imports without quotation marks are modules of Bevy.
fn import_of(line: &str) -> Option<&str> {
    let rest = line.trim().strip_prefix("#import")?.trim_start().strip_prefix('"')?;
    let (name, rest) = rest.split_once('"')?;
    (rest.trim().is_empty() || rest.trim().starts_with("//") || rest.trim() == ";").then_some(name)
}

/// The paths of the files that a text asks for by `#import`; `path` is its own.
pub(crate) fn imports_of<'a>(path: &'a str, text: &'a str) -> impl Iterator<Item = String> + 'a {
    text.lines().filter_map(import_of).filter_map(move |name| beside(path, name))
}

/// The path of a file that another one names, from the folder of that one; none if it leads out.
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
fn push_model(c: &mut Composer, model: &ModelEntry) {
    c.push("(row)", &row_struct(model));
    if model.has_curve() {
        c.source(&ALBEDO);
    }
    c.source(&model.declaration.wgsl);
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
    let mut c = Composer::new(sources);
    OPTICS.iter().chain([&LIGHTS, &SHADING]).for_each(|s| c.source(s));
    push_model(&mut c, model);
    lights.iter().for_each(|light| c.source(&light.declaration.wgsl));
    c.push("(light types)", &light_dispatch(lights));
    [&LOOP, &mode.declaration.wgsl, &WRAPPER].into_iter().for_each(|s| c.source(s));
    c.composed
}

/// What a file of a composed source is for, in the order in which authors look for them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Part {
    /// The reflection model.
    Model,
    /// A file of the author's that another one asks for.
    Import,
    /// The shading mode.
    Mode,
    /// The light loop.
    Loop,
    /// A light type.
    LightType,
    /// The vocabulary of the models.
    Vocabulary,
    /// The light record.
    LightRecord,
    /// What goes into and out of a shading mode.
    Stages,
    /// Bindings and entry points.
    Wrapper,
}

/// A file of a composed source.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct File {
    /// What it is for.
    pub part: Part,
    /// Its path, as messages name it.
    pub path: String,
    /// Whether its text differs from the built-in one. Own models have none to differ from.
    pub edited: bool,
}

/// The files that [`compose`] joins; what is generated is left out.
#[must_use]
pub fn files(sources: &Sources, model: &ModelEntry, mode: &ModeEntry, lights: &[LightEntry]) -> Vec<File> {
    let known = OPTICS
        .iter()
        .chain([&ALBEDO])
        .map(|s| (Part::Vocabulary, s))
        .chain(lights.iter().map(|l| (Part::LightType, &l.declaration.wgsl)))
        .chain([
            (Part::LightRecord, &LIGHTS),
            (Part::Stages, &SHADING),
            (Part::Model, &model.declaration.wgsl),
            (Part::Loop, &LOOP),
            (Part::Mode, &mode.declaration.wgsl),
            (Part::Wrapper, &WRAPPER),
        ])
        .collect::<Vec<_>>();
    let file = |path: &str| {
        let source = known.iter().find(|(_, source)| source.path == path);
        let own = model.declaration.family == Family::Own && path == model.declaration.wgsl.path;
        let differs = |s: &Source| sources.get(path).is_some_and(|text| text != s.text);
        let edited = !own && source.is_some_and(|(_, s)| differs(s));
        File { part: source.map_or(Part::Import, |(part, _)| *part), path: path.to_owned(), edited }
    };
    let composed = compose(sources, model, mode, lights);
    let mut all: Vec<_> = composed.map.files().filter(|path| !path.starts_with('(')).map(file).collect();
    all.sort_by_key(|file| file.part);
    all
}

/// The source for evaluating a model alone in a compute pass: directions in, terms out.
#[must_use]
pub fn compose_evaluation(sources: &Sources, model: &ModelEntry) -> Composed {
    let mut c = Composer::new(sources);
    OPTICS.iter().for_each(|s| c.source(s));
    push_model(&mut c, model);
    c.source(&EVALUATE);
    c.composed
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
    fn every_file_of_a_composed_source_is_listed_with_what_it_is_for() {
        let registry = Registry::builtin();
        let mut sources = Sources::default();
        sources.edit("loop.wgsl", format!("{}// edited\n", LOOP.text));
        sources.edit("reflection/phong.wgsl", registry.model("phong").expect("there").declaration.wgsl.text);
        sources.edit("shading/gouraud.wgsl", "#import \"noise.wgsl\"\n");
        sources.edit("shading/noise.wgsl", "fn noise() {}");
        let (model, mode) =
            (registry.model("phong").expect("there"), registry.mode("gouraud").expect("there"));
        let all = files(&sources, model, mode, registry.lights());
        let composed = compose(&sources, model, mode, registry.lights());
        let real = composed.map.files().filter(|path| !path.starts_with('(')).count();
        assert_eq!(all.len(), real);
        let of = |part: Part| {
            all.iter().filter(|f| f.part == part).map(|f| (f.path.as_str(), f.edited)).collect::<Vec<_>>()
        };
        assert_eq!(all[0].part, Part::Model);
        assert_eq!(of(Part::Model), [("reflection/phong.wgsl", false)], "read from disk, but the same");
        assert_eq!(of(Part::Mode), [("shading/gouraud.wgsl", true)]);
        assert_eq!(of(Part::Loop), [("loop.wgsl", true)]);
        assert_eq!(of(Part::Import), [("shading/noise.wgsl", false)]);
        assert_eq!(of(Part::LightType).len(), registry.lights().len());
        assert_eq!(of(Part::Vocabulary).len(), OPTICS.len());
        for part in [Part::LightRecord, Part::Stages, Part::Wrapper] {
            assert_eq!(of(part).len(), 1, "{part:?}");
        }
    }

    #[test]
    fn a_file_puts_another_one_before_itself_once() {
        let registry = Registry::builtin();
        let mut sources = Sources::default();
        sources.edit(
            "reflection/lambert.wgsl",
            "#import \"own/noise.wgsl\"\n#import \"../shared.wgsl\" // twice\nfn f() {}",
        );
        sources.edit("reflection/own/noise.wgsl", "#import \"../../shared.wgsl\"\nfn noise() {}");
        sources.edit("shared.wgsl", "fn shared() {}");
        let composed = compose_evaluation(&sources, &registry.models()[0]);
        assert_eq!(composed.problem, None);
        let files: Vec<_> = composed.map.files().filter(|f| sources.get(f).is_some()).collect();
        assert_eq!(files, ["shared.wgsl", "reflection/own/noise.wgsl", "reflection/lambert.wgsl"]);
        assert_eq!(composed.text.matches("fn shared").count(), 1);
        assert!(composed.depends_on("shared.wgsl") && !composed.depends_on("reflection/phong.wgsl"));
        let at = composed.text.lines().position(|l| l == "fn f() {}").expect("there");
        assert_eq!(composed.map.locate(at + 1), Some(("reflection/lambert.wgsl", 3)));
    }

    #[test]
    fn imports_that_cannot_be_followed_are_told() {
        let registry = Registry::builtin();
        let problem = |files: &[(&str, &str)]| {
            let mut sources = Sources::default();
            files.iter().for_each(|(path, text)| sources.edit(*path, *text));
            let composed = compose_evaluation(&sources, &registry.models()[0]);
            composed.problem.map(|p| p.to_string()).unwrap_or_default()
        };
        assert_eq!(
            problem(&[("reflection/lambert.wgsl", "//\n  #import \"none.wgsl\"")]),
            "reflection/lambert.wgsl:2:3: there is no file `reflection/none.wgsl` to import"
        );
        assert_eq!(
            problem(&[
                ("reflection/lambert.wgsl", "#import \"a.wgsl\""),
                ("reflection/a.wgsl", "#import \"lambert.wgsl\"")
            ]),
            "reflection/a.wgsl:1:1: the files import each other in a circle: reflection/lambert.wgsl → reflection/a.wgsl → reflection/lambert.wgsl"
        );
        assert!(
            problem(&[("terms.wgsl", "#import \"terms.wgsl\"")]).contains("circle: terms.wgsl → terms.wgsl")
        );
        assert!(problem(&[("terms.wgsl", "#import \"../../x.wgsl\"")]).contains("leads out"));
        assert!(problem(&[("terms.wgsl", "#define_import_path a")]).contains("no import path"));
    }

    #[test]
    fn comments_go_and_lines_stay() {
        for (text, expected) in [
            ("a // b\n  c", "a \nc\n"),
            ("a /* b\nc */ d", "a  \n d\n"),
            ("a/*/**/*/b", "a b\n"),
            ("a // /* b\nc", "a \nc\n"),
            ("a /* // */ b", "a   b\n"),
            ("/* never closed\nx", " \n\n"),
        ] {
            assert_eq!(without_comments(text), expected, "{text}");
        }
    }

    #[test]
    fn a_slim_text_means_the_same_and_has_few_lines() {
        for (text, expected) in [
            ("a\n  b // c\n\nd", "a b d "),
            ("a\n#ifdef X\nb\nc\n#endif\nd", "a \n#ifdef X\nb c \n#endif\nd "),
            ("#import a::{\n  b,\n  c,\n}\nd\ne", "#import a::{\nb,\nc,\n} d e "),
            ("@group(#{G}) x\ny", "@group(#{G}) x y "),
        ] {
            assert_eq!(slim(text), expected, "{text}");
        }
        for model in Registry::builtin().models() {
            let composed = compose_evaluation(&Sources::default(), model);
            let slim = slim(&composed.text);
            let functions = |text| naga::front::wgsl::parse_str(text).map(|m| m.functions.len()).ok();
            assert_eq!(functions(&slim), functions(&composed.text), "{}", model.declaration.id);
            assert!(slim.lines().count() < 20, "{slim}");
        }
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
