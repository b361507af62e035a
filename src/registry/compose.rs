//! Composes the source with which a model is drawn, and the source that evaluates it alone, from the
//! registered parts.
//!
//! A source for drawing contains, in this order: terms, the light record, the row of an object (generated
//! from the declaration of the model), the reading of curves where rows have them, the model, the light
//! types, the dispatch over light types (generated), the light loop, the shading model after its parameters
//! (generated), the debug channels, the last step of a pixel, and the wrapper with bindings and entry points.

use std::fmt::{Display, Write as _};

use crate::{
    debug,
    light::{LightEntry, Twin},
    optics::{
        albedo::{NODES, Spacing},
        lobes::MAX_LOBES,
        sharp,
    },
    parameter::{Parameter, Values, lanes},
    reflection::{Ambient, Family, ModelEntry, Passage},
    shader::{
        Source,
        compose::{
            ABSORPTION, ALBEDO, BODY, CHANNELS, Composed, Composer, DISPERSION, DISPLAY, EVALUATE, EXTENDED,
            FILE, HALF_DIFFERENCE, HIERARCHY, INSIDE, LIGHT_ALONE, LIGHTS, LOOP, OPTICS, PANORAMA, SAMPLING,
            SEEN, SHADING, SHADING_ALONE, Sources, THROUGH, TRANSMISSION, WRAPPER, parameter_struct,
        },
        definitions::definition,
    },
    shading::{self, ShadingEntry},
    text::template::{chosen, filled},
};

/// A generated part of sources. The names of its parts are separated by spaces.
pub(crate) fn part(names: &str, places: &[(&str, &dyn Display)]) -> String {
    let wanted = |name: &str| names.split(' ').any(|wanted| wanted == name);
    filled(&chosen(include_str!("parts.wgsl"), wanted), places)
}

/// The WGSL struct `Row` of a model, the data of one object in the shader's table, and the functions that
/// read its curve; `more` are additional fields. The array of rows is `parameter_table`, the index of the
/// object is `object_row`. Curves are read in place: a copy would cost time for every pixel.
#[must_use]
pub fn row_struct(model: &ModelEntry, more: &str) -> String {
    let names = if model.has_curve() { "row curve" } else { "row" };
    let places: &[(&str, &dyn Display)] =
        &[("more", &more), ("length", &model.curve_length()), ("harmonics", &model.harmonics())];
    parameter_struct("Parameters", model.parameters) + &part(names, places)
}

/// The functions that read the additional curves of a model by name: each begins where the one before ends.
#[must_use]
pub fn named_curves(model: &ModelEntry) -> String {
    let mut text = String::new();
    let mut first = model.harmonics() * NODES;
    for curve in model.curves() {
        let spacing = match curve.spacing {
            Spacing::Cubic => "cubic",
            Spacing::Values(_) => "values",
            Spacing::Linear(_) => "linear",
        };
        let steps = curve.nodes().saturating_sub(1);
        let places: &[(&str, &dyn Display)] = &[
            ("name", &curve.name),
            ("first", &first),
            ("next", &(first + 1)),
            ("mean", &(first + curve.nodes())),
            ("steps", &format!("{:?}", steps as f32)),
            ("last", &steps.saturating_sub(1)),
        ];
        text.push_str(&part(spacing, places));
        first += curve.length();
    }
    text
}

/// The constant that tells a model whose parameters decide it, or one from a file, whether light passes through the
/// surfaces that are drawn. The shaders of other surfaces then lack the code for such light.
#[must_use]
pub(crate) fn passes(model: &ModelEntry, passage: Passage, text: &str) -> String {
    if model.passage_varies() || text.contains("LIGHT_PASSES") {
        part("passes", &[("passes", &passage.transmits)])
    } else {
        String::new()
    }
}

/// Adds the row of a model, and the model; `file` is the part that reads the numbers of its file, if it has one.
fn push_model(c: &mut Composer, model: &ModelEntry, passage: Passage, more: &str, file: &str) {
    c.push("(row)", &row_struct(model, more));
    if model.file().is_some() {
        c.push(FILE, &part(file, &[]));
    }
    if model.has_curve() {
        c.source(&ALBEDO);
    }
    if !model.curves().is_empty() {
        c.push("(curves)", &named_curves(model));
    }
    if model.declaration.transmits {
        TRANSMISSION.iter().for_each(|s| c.source(s));
    }
    if model.declaration.sharp {
        c.push("(sharp directions)", &part("sharp", &[]));
    }
    let passes = passes(model, passage, c.text(&model.declaration.wgsl));
    if !passes.is_empty() {
        c.push("(passage)", &passes);
    }
    c.source(&model.declaration.wgsl);
    if model.declaration.ambient == Ambient::Albedo {
        c.push("(ambient)", &part("ambient", &[]));
    }
}

/// The values of a parameter struct in WGSL, from its [`words`](crate::parameter::words): `word` reads the
/// one with an index as a type.
fn values(parameters: &[Parameter], word: impl Fn(usize, &str) -> String) -> String {
    let mut at = 0;
    let mut next = |kind: &str| {
        at += 1;
        word(at - 1, kind)
    };
    let fields: Vec<_> = parameters
        .iter()
        .map(|p| match lanes(p.kind.wgsl()) {
            1 => next(p.kind.wgsl()),
            n => format!("vec{n}({})", (0..n).map(|_| next("f32")).collect::<Vec<_>>().join(", ")),
        })
        .collect();
    fields.join(", ")
}

/// Adds a shading model, after the struct of its parameters and the function that reads them.
fn push_shading(c: &mut Composer, shading: &ShadingEntry) {
    let all = shading.parameters;
    if !all.is_empty() {
        let word = |i: usize, kind: &str| {
            let component = ["x", "y", "z", "w"][i % 4];
            format!("bitcast<{kind}>(parameter_table[object_row].shading[{}u].{component})", i / 4)
        };
        let name = shading::PARAMETERS;
        let text = format!(
            "{}fn shading_parameters() -> {name} {{\n    return {name}({});\n}}\n",
            parameter_struct(name, all),
            values(all, word)
        );
        c.push("(parameters of the shading model)", &text);
    }
    c.source(&shading.declaration.wgsl);
}

/// Adds a light type, after the struct of its parameters.
fn push_light(c: &mut Composer, light: &LightEntry) {
    let fields = light.fields();
    if !fields.is_empty() {
        let text = parameter_struct(&light.parameter_struct(), &fields);
        c.push("(parameters of a light type)", &text);
    }
    c.source(&light.declaration.wgsl);
}

/// True if any light type has extent, so that the light loop takes samples.
fn any_extent(lights: &[LightEntry]) -> bool {
    lights.iter().any(|light| light.declaration.extent)
}

/// The functions that dispatch a light to its type, by the index of the type in the registry, with the
/// light's own parameters, read from its [`words`](LightEntry::words). Lights of other types are dark.
#[must_use]
pub fn light_dispatch(lights: &[LightEntry]) -> String {
    let mut text = part("words", &[]);
    let mut dispatch = |twin: &Twin, function: &str, extent: bool| {
        let [taken, given] = twin.more;
        let result = twin.result;
        let _ = writeln!(text, "fn {function}(light: Light, p: vec3<f32>{taken}) -> {result} {{");
        text.push_str("    switch light.light_type {\n");
        for light in lights.iter().filter(|light| light.declaration.extent == extent) {
            let word = |i: usize, kind: &str| match kind {
                "u32" => format!("light_word(light, {i}u)"),
                _ => format!("light_number(light, {i}u)"),
            };
            let parameters = match light.fields().as_slice() {
                [] => String::new(),
                all => format!("{}({}), ", light.parameter_struct(), values(all, word)),
            };
            let (index, name) = (light.index, twin.of(light));
            let _ =
                writeln!(text, "        case {index}u: {{ return {name}(light, {parameters}p{given}); }}");
        }
        let _ = writeln!(text, "        default: {{ return {}; }}\n    }}\n}}", twin.dark);
    };
    for twin in Twin::all(false) {
        dispatch(twin, twin.name, false);
    }
    if any_extent(lights) {
        for twin in Twin::all(true) {
            dispatch(twin, &format!("{}_light", twin.name), true);
        }
        let extended = lights.iter().filter(|light| light.declaration.extent);
        let types: Vec<_> = extended.map(|light| format!("light_type == {}u", light.index)).collect();
        let _ = writeln!(
            text,
            "fn has_extent(light_type: u32) -> bool {{\n    return {};\n}}",
            types.join(" || ")
        );
    }
    text
}

/// The files that every source for drawing needs besides the vocabulary, and those for other uses.
pub(crate) const SHARED: [Source; 18] = [
    ALBEDO,
    PANORAMA,
    HALF_DIFFERENCE,
    DISPERSION,
    ABSORPTION,
    LIGHTS,
    SAMPLING,
    SHADING,
    HIERARCHY,
    INSIDE,
    THROUGH,
    LOOP,
    EXTENDED,
    CHANNELS,
    DISPLAY,
    WRAPPER,
    SEEN,
    EVALUATE,
];

/// The table from which a single light type reads the numbers of its files: one row, see [`compose_light`].
pub const FILE_TABLE: &str = "file_table";

/// The room for the numbers of the files of a light in [`FILE_TABLE`]: that of its defaults, at least 1.
pub(crate) fn numbers_of_files(light: &LightEntry) -> usize {
    let tables = light.parameters.iter().filter_map(|p| Values::default().table(p));
    tables.map(|table| table.numbers.len()).sum::<usize>().max(1)
}

/// The source of a single light type, with a function that calls it. The numbers of its files are not in
/// `light_words`, but in a table of one row with room for those of its defaults.
#[must_use]
pub fn compose_light(sources: &Sources, light: &LightEntry) -> Composed {
    let mut c = Composer::new(sources);
    OPTICS.iter().chain([&LIGHTS]).for_each(|s| c.source(s));
    if light.declaration.extent {
        // No directions of lobes are sampled here.
        c.source(&SAMPLING);
        c.push("(lobes)", &part("no_lobes", &[]));
    }
    push_light(&mut c, light);
    let numbers = numbers_of_files(light);
    let extent = light.declaration.extent;
    let call = |twin: &Twin| {
        let name = if extent { format!("{}_light", twin.name) } else { twin.name.to_owned() };
        let own = if light.fields().is_empty() { "" } else { "m, " };
        let given = twin.more[1];
        format!(
            "fn {name}{} {{\n    return {}(light, {own}p{given});\n}}\n",
            twin.signature(light),
            twin.of(light)
        )
    };
    let calls: String = Twin::all(extent).iter().map(call).collect();
    c.push(LIGHT_ALONE, &(part("light_alone", &[("numbers", &numbers)]) + &calls));
    c.composed
}

/// The source of a single shading model, with the function `pixel_alone` that calls its `shade_pixel` within
/// a plane triangle, given by its edges to the right and downwards on the screen. The light at a point is a
/// formula of its position, normal and tangent, and derivatives are those of the position.
#[must_use]
pub fn compose_shading(sources: &Sources, shading: &ShadingEntry) -> Composed {
    let mut c = Composer::new(sources);
    OPTICS.iter().chain([&SHADING]).for_each(|s| c.source(s));
    c.push(SHADING_ALONE, &part("shading_alone", &[("words", &(shading::PARAMETER_WORDS / 4))]));
    push_shading(&mut c, shading);
    c.push(SHADING_ALONE, &part("pixel_alone", &[]));
    c.composed
}

/// Adds the way of light through a solid body of a model, or that there is none.
fn push_body(c: &mut Composer, model: &str, solid: bool, extent: bool) {
    if !solid {
        c.push("(no body)", &part("opaque", &[]));
        return;
    }
    if !extent {
        c.push("(no light with extent)", &part("no_extent", &[]));
    }
    c.push(BODY, &part("solid", &[]));
    if definition(model, "entering").is_none() {
        c.push("(all enters)", &part("entering", &[]));
    }
    [DISPERSION, ABSORPTION, HIERARCHY, INSIDE, THROUGH].iter().for_each(|source| c.source(source));
}

/// The parts of the light loop that depend on the sides of a surface on which its model answers, and on whether light passes
/// through without spreading.
#[must_use]
pub(crate) fn sides(model: &ModelEntry, passage: Passage, extent: bool) -> String {
    let side = match (passage.transmits, model.declaration.lit_from_below) {
        (true, _) => "transmits",
        (false, true) => "from_below",
        (false, false) => "reflects",
    };
    let names = match (extent || passage.solid, passage.sharp) {
        (false, _) => side.to_owned(),
        (true, false) if passage.solid => format!("{side} spread radiance"),
        (true, false) => format!("{side} spread"),
        (true, true) => format!("{side} unspread radiance"),
    };
    part(&names, &[("most", &sharp::MOST)])
}

/// The complete source for drawing surfaces of a model through which light passes in some way, with a shading model under
/// the given light types, those of the scene: an error in another type does not affect the picture.
#[must_use]
pub fn compose(
    sources: &Sources,
    (model, passage): (&ModelEntry, Passage),
    shading: &ShadingEntry,
    lights: &[LightEntry],
) -> Composed {
    let mut c = Composer::new(sources);
    OPTICS.iter().chain([&LIGHTS, &SHADING]).for_each(|s| c.source(s));
    let extent = any_extent(lights);
    let solid = passage.solid;
    if extent || solid {
        c.source(&SAMPLING);
    }
    let mut words = format!(
        "    shading: array<vec4<u32>, {}>,\n    lobes: array<vec4<f32>, {MAX_LOBES}>,\n",
        shading::PARAMETER_WORDS / 4
    );
    if solid {
        words.push_str("    interior: array<vec4<f32>, 2>,\n");
    }
    push_model(&mut c, model, passage, &words, "file_drawn");
    if extent || solid {
        c.push("(lobes)", &part("lobes", &[]));
    }
    lights.iter().for_each(|light| push_light(&mut c, light));
    c.push("(light types)", &light_dispatch(lights));
    c.push("(sides of the surface)", &sides(model, passage, extent));
    push_body(&mut c, sources.text(&model.declaration.wgsl), solid, extent);
    c.source(&LOOP);
    if extent {
        c.source(&EXTENDED);
    } else {
        c.push("(no light with extent)", &part("not_extended", &[]));
    }
    push_shading(&mut c, shading);
    c.source(&CHANNELS);
    c.push("(channels)", &debug::wgsl());
    c.source(&DISPLAY);
    c.source(&WRAPPER);
    if solid {
        // Only what follows the wrapper knows what it imports.
        c.push("(the place of the body)", &part("placement", &[]));
    }
    c.composed
}

/// The complete source for drawing lights with extent themselves, of the given types.
#[must_use]
pub fn compose_seen(sources: &Sources, lights: &[LightEntry]) -> Composed {
    let mut c = Composer::new(sources);
    OPTICS.iter().chain([&LIGHTS, &SAMPLING]).for_each(|s| c.source(s));
    c.push("(lobes)", &part("no_lobes", &[]));
    let lights: Vec<_> = lights.iter().filter(|light| light.declaration.extent).copied().collect();
    lights.iter().for_each(|light| push_light(&mut c, light));
    c.push("(light types)", &light_dispatch(&lights));
    c.push("(visible lights)", &visible(&lights));
    c.source(&DISPLAY);
    c.source(&SEEN);
    c.composed
}

/// The function that returns whether a light is visible in the picture, the twin of
/// [`LightEntry::is_visible`].
fn visible(lights: &[LightEntry]) -> String {
    let mut text = "fn light_is_visible(light: Light) -> bool {\n    switch light.light_type {\n".to_owned();
    for light in lights {
        let visible = light
            .visible_word()
            .map_or_else(|| "true".to_owned(), |i| format!("light_word(light, {i}u) == 1u"));
        let _ = writeln!(text, "        case {}u: {{ return {visible}; }}", light.index);
    }
    text.push_str("        default: { return false; }\n    }\n}\n");
    text
}

/// The role of a file in a composed source, in the order in which authors look for them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Part {
    /// The reflection model.
    Model,
    /// A file imported by another file of the author.
    Import,
    /// The shading model.
    ShadingModel,
    /// The light loop.
    Loop,
    /// A light type.
    LightType,
    /// The vocabulary of the models.
    Vocabulary,
    /// The light record.
    LightRecord,
    /// The input and output of a shading model.
    Stages,
    /// The debug channels.
    Channels,
    /// Bindings and entry points, and the last step of a pixel.
    Wrapper,
}

/// A file of a composed source.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct File {
    /// Role of the file.
    pub part: Part,
    /// Path, as in messages.
    pub path: String,
    /// True if the text differs from the built-in one; false for custom models.
    pub edited: bool,
}

/// The files joined by [`compose`], without generated text.
#[must_use]
pub fn files(
    sources: &Sources,
    (model, passage): (&ModelEntry, Passage),
    shading: &ShadingEntry,
    lights: &[LightEntry],
) -> Vec<File> {
    let known = OPTICS
        .iter()
        .chain(TRANSMISSION)
        .chain([&ALBEDO, &PANORAMA, &HALF_DIFFERENCE, &DISPERSION, &ABSORPTION])
        .map(|s| (Part::Vocabulary, s))
        .chain(lights.iter().map(|l| (Part::LightType, &l.declaration.wgsl)))
        .chain([
            (Part::LightRecord, &LIGHTS),
            (Part::Stages, &SHADING),
            (Part::Model, &model.declaration.wgsl),
            (Part::Vocabulary, &SAMPLING),
            (Part::Loop, &LOOP),
            (Part::Loop, &EXTENDED),
            (Part::Loop, &HIERARCHY),
            (Part::Loop, &INSIDE),
            (Part::Loop, &THROUGH),
            (Part::ShadingModel, &shading.declaration.wgsl),
            (Part::Channels, &CHANNELS),
            (Part::Wrapper, &DISPLAY),
            (Part::Wrapper, &WRAPPER),
        ])
        .collect::<Vec<_>>();
    let file = |path: &str| {
        let source = known.iter().find(|(_, source)| source.path == path);
        let custom = model.declaration.family == Family::Custom && path == model.declaration.wgsl.path;
        let differs = |s: &Source| sources.get(path).is_some_and(|text| text != s.text);
        let edited = !custom && source.is_some_and(|(_, s)| differs(s));
        File { part: source.map_or(Part::Import, |(part, _)| *part), path: path.to_owned(), edited }
    };
    let composed = compose(sources, (model, passage), shading, lights);
    let mut all: Vec<_> = composed.map.files().filter(|path| !path.starts_with('(')).map(file).collect();
    all.sort_by_key(|file| file.part);
    all
}

/// The source for evaluating a single model in a compute pass: directions in, terms out. It has all that any surface of the
/// model needs.
#[must_use]
pub fn compose_evaluation(sources: &Sources, model: &ModelEntry) -> Composed {
    evaluation(sources, model, "", "file_evaluated")
}

/// Like [`compose_evaluation`], with the numbers of the file of the model, if it has one, at the end of the row: for the
/// interpreter, which knows one table. There is room for those of the default.
#[must_use]
pub fn compose_interpreted(sources: &Sources, model: &ModelEntry) -> Composed {
    let Some(table) = model.table(&Values::default()) else { return compose_evaluation(sources, model) };
    // What follows the last number of the curve in its quadruple.
    let padding = if model.has_curve() { part("file_padding", &[("padding", &3)]) } else { String::new() };
    // In two levels, since the limits of models hold for arrays here, too.
    let more = padding + &part("file_row", &[("eights", &table.numbers.len().div_ceil(8))]);
    evaluation(sources, model, &more, "file_alone")
}

fn evaluation(sources: &Sources, model: &ModelEntry, more: &str, file: &str) -> Composed {
    let mut c = Composer::new(sources);
    OPTICS.iter().for_each(|s| c.source(s));
    push_model(&mut c, model, model.declaration.passage(), more, file);
    c.source(&EVALUATE);
    c.composed
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::registry::Registry;

    /// The first model, which is opaque.
    fn first(registry: &Registry) -> (&ModelEntry, Passage) {
        (&registry.models()[0], Passage::NONE)
    }

    #[test]
    fn what_lets_light_through_is_only_where_light_passes() {
        let registry = Registry::builtin();
        let model = registry.model("openpbr").expect("built in");
        let shading = &registry.shading_models()[0];
        let of = |passage| compose(&Sources::default(), (model, passage), shading, registry.lights()).text;
        let [opaque, sheet, body] = [Passage::NONE, Passage::SHEET, Passage::BODY].map(of);
        let has = |text: &str| {
            ["const LIGHT_PASSES: bool = true;", "sharp(i, v,", "fn follow_inside"]
                .map(|what| text.contains(what))
        };
        assert_eq!(has(&opaque), [false; 3]);
        assert_eq!(has(&sheet), [true, true, false]);
        assert_eq!(has(&body), [true, false, true]);
        // Others have no such constant.
        let glass = registry.model("glass").expect("built in");
        let drawn = (glass, glass.declaration.passage());
        let text = compose(&Sources::default(), drawn, shading, registry.lights()).text;
        assert_eq!(has(&text), [false, true, true]);
    }

    #[test]
    fn every_line_leads_back_to_its_file() {
        let registry = Registry::builtin();
        for model in registry.models() {
            for shading in registry.shading_models() {
                let drawn = (model, model.passage(&Values::default()));
                let composed = compose(&Sources::default(), drawn, shading, registry.lights());
                let pieces =
                    [OPTICS[0], OPTICS[1], LOOP, WRAPPER, model.declaration.wgsl, shading.declaration.wgsl];
                for (i, line) in composed.text.lines().enumerate() {
                    let (path, at) = composed.map.locate(i + 1).expect("every line has a place");
                    if let Some(source) = pieces.iter().find(|s| s.path == path) {
                        // An import is a remark once it was followed.
                        let line =
                            line.strip_prefix("// ").filter(|l| l.starts_with("#import")).unwrap_or(line);
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
        let composed = compose(&sources, first(&registry), &registry.shading_models()[0], registry.lights());
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
        let (model, shading) =
            (registry.model("phong").expect("there"), registry.shading_model("gouraud").expect("there"));
        let drawn = (model, Passage::NONE);
        let all = files(&sources, drawn, shading, registry.lights());
        let composed = compose(&sources, drawn, shading, registry.lights());
        let real = composed.map.files().filter(|path| !path.starts_with('(')).count();
        assert_eq!(all.len(), real);
        let of = |part: Part| {
            all.iter().filter(|f| f.part == part).map(|f| (f.path.as_str(), f.edited)).collect::<Vec<_>>()
        };
        assert_eq!(all[0].part, Part::Model);
        assert_eq!(of(Part::Model), [("reflection/phong.wgsl", false)], "read from disk, but the same");
        assert_eq!(of(Part::ShadingModel), [("shading/gouraud.wgsl", true)]);
        assert_eq!(of(Part::Loop), [("loop.wgsl", true), ("extended.wgsl", false)]);
        assert_eq!(of(Part::Import), [("shading/noise.wgsl", false)]);
        assert_eq!(of(Part::LightType).len(), registry.lights().len());
        assert_eq!(of(Part::Vocabulary).len(), OPTICS.len() + 2, "and those of light with extent");
        assert_eq!(of(Part::Wrapper), [("display.wgsl", false), ("wrapper.wgsl", false)]);
        for part in [Part::LightRecord, Part::Stages, Part::Channels] {
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
            "reflection/a.wgsl:1:1: circular import: reflection/lambert.wgsl → reflection/a.wgsl → reflection/lambert.wgsl"
        );
        assert!(
            problem(&[("terms.wgsl", "#import \"terms.wgsl\"")])
                .contains("circular import: terms.wgsl → terms.wgsl")
        );
        assert!(problem(&[("terms.wgsl", "#import \"../../x.wgsl\"")]).contains("leads out"));
        assert!(problem(&[("terms.wgsl", "#define_import_path a")]).contains("no import path"));
    }

    #[test]
    fn every_light_type_is_dispatched_by_its_number_in_the_registry() {
        let registry = Registry::builtin();
        let all = light_dispatch(registry.lights());
        for (i, light) in registry.lights().iter().enumerate() {
            let twins = Twin::all(light.declaration.extent);
            // Alone as among all.
            let alone = light_dispatch(&[*light]);
            for twin in twins {
                let case = format!("case {i}u: {{ return {}(", twin.of(light));
                assert!(all.contains(&case) && alone.contains(&case), "{alone}");
            }
            assert_eq!(alone.matches("case ").count(), twins.len(), "{alone}");
            assert_eq!(alone.contains("has_extent"), light.declaration.extent);
        }
    }

    #[test]
    fn a_source_holds_the_light_types_that_are_asked_for_and_no_other() {
        let registry = Registry::builtin();
        let lights = registry.lights_in(registry.light_set(["spot"]));
        let composed = compose(&Sources::default(), first(&registry), &registry.shading_models()[0], &lights);
        let types: Vec<_> = composed.map.files().filter(|path| path.starts_with("light/")).collect();
        assert_eq!(types, ["light/spot.wgsl"]);
        let unlit = compose(&Sources::default(), first(&registry), &registry.shading_models()[0], &[]);
        assert_eq!(
            crate::shader::whole::validate_drawing(&unlit, true),
            Ok(()),
            "a scene whose lights are all unknown"
        );
    }
}
