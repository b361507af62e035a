//! The shader of one reflection model and one shading model for the lights of one scene: the source used on
//! screen, without the tables for arbitrary scenes, and without the parts that the scene does not use.

use std::{
    collections::BTreeSet,
    fmt::{Display, Write as _},
};

use naga::{
    Module,
    valid::{Capabilities, ModuleInfo, ValidationFlags, Validator},
};

use self::items::{Item, fields, items, retain_used};
use super::{
    ExportError, bodies,
    lamp_files::{UNIFORM_BYTES, excess},
    lights::{LightField, Lights, call, stride},
};
use crate::{
    light::Twin,
    optics::{colour::Encoding, lobes::MAX_LOBES, tone::ToneMapping},
    reflection::{Ambient, ModelEntry, Passage},
    registry::{
        Registry,
        compose::{named_curves, part, passes, sides},
    },
    shader::{
        Source,
        check::reason,
        compose::{
            ABSORPTION, ALBEDO, Composer, DISPERSION, EXTENDED, HIERARCHY, INSIDE, LIGHTS, LOOP, OPTICS,
            SAMPLING, SHADING, Sources, THROUGH, TRANSMISSION, parameter_struct,
        },
        definitions::definition,
    },
    shading::{self, ShadingEntry, Stage},
    text::{
        self,
        template::{chosen, filled},
    },
};

pub mod items;
mod wrapper;

/// The program that will use a shader.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Host {
    /// Any program: the shader is self-contained, and returns the colour for the display.
    Alone {
        /// Tone mapping.
        tone: ToneMapping,
        /// Encoding of colours.
        encoding: Encoding,
    },
    /// A Bevy program, which provides the camera, and applies tone mapping after the shader.
    Bevy {
        /// Factor of the exposure.
        exposure: f32,
        /// Encoding of colours.
        encoding: Encoding,
    },
}

/// A finished shader.
#[derive(Clone, Debug)]
pub struct Shader {
    /// WGSL source.
    pub text: String,
    /// The fields of its `Light`.
    pub light_fields: Vec<LightField>,
    /// True if the shader reads `albedo_curve`.
    pub reads_curve: bool,
    /// True if the shader reads `shading_values`, the parameters of the shading model.
    pub reads_shading: bool,
    /// True if the shader reads `lamp_numbers`, the numbers of the lights' files.
    pub reads_lamps: bool,
    /// True if the shader reads `material_lobes`, the lobes of the material.
    pub reads_lobes: bool,
    /// True if the shader reads `interior`, the inside of a solid body, and `solid_rows`, the hierarchy of its mesh.
    pub reads_body: bool,
    /// True if an edited light loop reads more of `illumination` than the lights.
    pub reads_header: bool,
    /// Declarations that the picture does not need: with them, the text has all that the albedo of the model takes.
    pub beside: String,
}

/// Number of samples of light with extent that a shader takes for each pixel, or for each vertex or polygon.
pub const LIGHT_SAMPLES: u32 = 64;

/// The index of the section of the light loop, before those of the light types.
const LIGHT_LOOP: usize = 3;

/// A part of the source under one heading.
struct Section {
    heading: String,
    items: Vec<Item>,
}

/// The shader of a reflection model and a shading model for the lights of a scene.
///
/// # Errors
/// Returns an error if the sources cannot be combined: for unresolved `#import`s, which drawing reports too, and for models
/// that read a file.
pub fn compose(
    lights: &Lights,
    registry: &Registry,
    (model, passage): (&ModelEntry, Passage),
    shading: &ShadingEntry,
    host: Host,
) -> Result<Shader, ExportError> {
    if let Some(file) = model.file() {
        // The label may be a plural.
        let (name, label) = (model.declaration.name, file.label);
        return Err(ExportError::refused(format!(
            "a uniform does not hold all numbers of the {label} of {name}; fit another model with `lcm match`, or \
             export a program"
        )));
    }
    if let Some(excess) = excess(lights.numbers.len(), lights.pictures) {
        return Err(ExportError::refused(excess));
    }
    let sources = registry.sources();
    let faces = shading.declaration.stage == Stage::Polygon;
    let (own, standing) = (model.declaration, shading.declaration);
    let mut sections = vec![
        Section { heading: String::new(), items: items(&wrapper::text(host, faces, lights, passage)) },
        Section { heading: String::new(), items: items(&inputs(lights, (model, passage), shading, host)) },
        Section {
            heading: credit(standing.name, "shading", standing.source, standing.summary),
            items: items(&text(sources, &standing.wgsl)?),
        },
        Section {
            heading: "The light that leaves a point: the sum over the lights.".to_owned(),
            items: items(&(light_loop(sources, lights, (model, passage))? + &dispatch(lights))),
        },
    ];
    for entry in &lights.types {
        let what = entry.declaration;
        let mut all = items(&text(sources, &what.wgsl)?);
        let fields = entry.fields();
        if !fields.is_empty() {
            all.extend(items(&parameter_struct(&entry.parameter_struct(), &fields)));
        }
        let heading = format!("{}: {}", what.title(), what.equation);
        sections.push(Section { heading, items: all });
    }
    let mut heading = credit(own.name, "reflection", own.source, own.summary);
    for part in own.equation {
        let _ = write!(heading, "\n    {}", part.text);
    }
    let mut response = if own.sharp { part("sharp", &[]) } else { String::new() };
    let own_text = text(sources, &own.wgsl)?;
    response.push_str(&passes(model, passage, &own_text));
    response.push_str(&own_text);
    if own.ambient == Ambient::Albedo {
        response.push_str(&part("ambient", &[]));
    }
    sections.push(Section { heading, items: items(&response) });
    if passage.solid {
        let heading = "The way of light through the body, along the triangles of its mesh.".to_owned();
        sections.push(Section { heading, items: items(&body(sources, lights, &response)?) });
    }
    let mut vocabulary = Vec::new();
    let transmission = if own.transmits { TRANSMISSION } else { &[] };
    for source in OPTICS.iter().chain(transmission).chain([&SHADING, &LIGHTS, &ALBEDO]) {
        // The record of a light is generated for the scene.
        let all = items(&text(sources, source)?);
        vocabulary.extend(all.into_iter().filter(|item| !MADE.contains(&item.name.as_str())));
    }
    vocabulary.extend(items(&named_curves(model)));
    if lights.has_extent() || passage.solid {
        // GLSL for WebGL 2 lacks a function that reverses bits.
        let sampling = text(sources, &SAMPLING)?.replace("reverseBits(", "bits_reversed(");
        vocabulary.extend(items(&(sampling + include_str!("bits_reversed.wgsl"))));
    }
    if let Host::Alone { .. } = host {
        vocabulary.extend(items(include_str!("tone.wgsl")));
    }
    let heading = "Functions and types that the equations share.".to_owned();
    sections.push(Section { heading, items: vocabulary });
    unique(&sections)?;
    let shader = finish(sections, lights, host);
    // They follow the header of `Illumination`.
    let records = 16 + lights.rows.len() * stride(&shader.light_fields);
    if records > UNIFORM_BYTES {
        return Err(ExportError::refused(format!(
            "the lights take {records} bytes in total, but a uniform holds {UNIFORM_BYTES}; use fewer lights"
        )));
    }
    Ok(shader)
}

/// Refuses sources that declare a name twice: custom models may use names that exist only in exports.
fn unique(sections: &[Section]) -> Result<(), ExportError> {
    let mut known = BTreeSet::new();
    let twice = sections.iter().flat_map(|s| &s.items).find(|item| !known.insert(item.name.as_str()));
    twice.map_or(Ok(()), |Item { name, .. }| {
        let what = format!("a shader declares `{name}`, a name reserved for exports; choose another name");
        Err(ExportError::refused(what))
    })
}

/// The declarations of `lights.wgsl` that are generated for each scene.
const MADE: [&str; 3] = ["Light", "Illumination", "MAX_LIGHTS"];

fn credit(name: &str, what: &str, source: &str, summary: &str) -> String {
    let name = if name.to_lowercase().contains(what) { name.to_owned() } else { format!("{name} {what}") };
    // Some sources begin with the code of a requirement.
    let source = source.strip_prefix("CA ").and_then(|rest| Some(rest.split_once(": ")?.1)).unwrap_or(source);
    let source = if source.is_empty() { String::new() } else { format!(" ({source})") };
    format!("{name}{source}.\n{summary}")
}

/// The text of a source, after the sources that it imports.
fn text(sources: &Sources, source: &Source) -> Result<String, ExportError> {
    let mut composer = Composer::new(sources);
    composer.source(source);
    match composer.composed.problem {
        Some(problem) => Err(ExportError::refused(problem.to_string())),
        None => Ok(composer.composed.text.replace("\r\n", "\n")),
    }
}

/// The light loop, with a known number of lights and all terms. The built-in one loses the code that the scene does not
/// need.
fn light_loop(
    sources: &Sources,
    lights: &Lights,
    (model, passage): (&ModelEntry, Passage),
) -> Result<String, ExportError> {
    let extent = lights.has_extent();
    let all = if extent { &[LOOP, EXTENDED][..] } else { &[LOOP] };
    let mut joined = String::new();
    for source in all {
        joined.push_str(&text(sources, source)?);
    }
    joined.push_str(&sides(model, passage, extent));
    if !extent {
        joined = joined.replace(" + extended(position, v, frame)", "");
    }
    if !passage.solid {
        joined = joined.replace(" + through(position, v, frame, selection)", "");
    }
    joined = specialised(joined, lights, is_edited(sources, all));
    if !lights.uniform {
        joined = joined.replace(EITHER, DIRECTED);
    }
    if !passage.transmits && !model.declaration.lit_from_below {
        joined = joined.replace("counts(local.z)", "local.z > 0.0");
    }
    if !passage.sharp {
        joined = joined.replace(UNSPREAD, "");
    }
    Ok(joined)
}

/// The way of light through a solid body of a model with this source, for the lights of the scene.
fn body(sources: &Sources, lights: &Lights, model: &str) -> Result<String, ExportError> {
    let all = [DISPERSION, ABSORPTION, HIERARCHY, INSIDE, THROUGH];
    let mut joined = String::new();
    for source in &all {
        joined.push_str(&text(sources, source)?);
    }
    if !lights.has_extent() {
        joined.push_str(&part("no_extent", &[]));
    }
    if definition(model, "entering").is_none() {
        joined.push_str(&part("entering", &[]));
    }
    Ok(specialised(joined, lights, is_edited(sources, &all)))
}

fn is_edited(sources: &Sources, all: &[Source]) -> bool {
    all.iter().any(|source| sources.text(source) != source.text)
}

/// A part of the light loop with what is known for the scene; simpler, unless it is edited.
fn specialised(mut text: String, lights: &Lights, edited: bool) -> String {
    let simpler = if edited { &[] } else { SIMPLER };
    for (general, special) in simpler.iter().chain(KNOWN) {
        text = text.replace(general, special);
    }
    if !lights.has_extent() {
        // So the type of a light is read where other models of the scene read it.
        text = text.replace("has_extent(light.light_type)", "false");
    }
    text
}

/// Parts of the built-in light loop, and their replacements if all terms are shown.
const SIMPLER: &[(&str, &str)] = &[
    (" `illumination`, `light_at`, `parameters` and `observer_position` come from the wrapper.", ""),
    (
        "    let count = min(illumination.count, MAX_LIGHTS);
    let selection = illumination.terms;
    for (var i = 0u; i < count; i++) {
",
        "    for (var i = 0u; i < LIGHT_COUNT; i++) {\n",
    ),
    ("    let selection = illumination.terms;\n", ""),
    (
        "select_terms(terms, on_side(selection, dot(frame.n, arriving.l)))",
        "(terms.ambient + terms.diffuse + terms.specular)",
    ),
    (
        "select_terms(terms, on_side(selection, dot(frame.n, chosen.l)))",
        "(terms.ambient + terms.diffuse + terms.specular)",
    ),
    (
        "            let shown = on_side(selection, dot(frame.n, way.l));
            let terms = Terms(vec3(0.0), vec3(0.0), PI * way.share);
            colour += select_terms(terms, shown) * radiance_from(position, way.l);
",
        "            colour += PI * way.share * radiance_from(position, way.l);\n",
    ),
    (
        "    let remains = selection == TERM_REMAINING;
    if selection != TERM_ALL && selection != TERM_TRANSMITTED && !remains {
        return vec3(0.0);
    }
",
        "    let remains = false;\n",
    ),
    (", frame, selection)", ", frame, TERM_ALL)"),
];
/// Expressions known for the scene, in any light loop.
const KNOWN: &[(&str, &str)] = &[
    ("light_at(i)", "illumination.lights[i]"),
    ("min(illumination.count, MAX_LIGHTS)", "LIGHT_COUNT"),
    ("illumination.count", "LIGHT_COUNT"),
    ("illumination.terms", "TERM_ALL"),
    ("max(illumination.sample_count, 1u)", "LIGHT_SAMPLES"),
    ("illumination.sample_count", "LIGHT_SAMPLES"),
    ("illumination.first_sample + ", ""),
    ("illumination.first_sample", "0u"),
];
/// The part of the light loop that distinguishes uniform light from other light.
const EITHER: &str = "        var terms: Terms;
        if arriving.everywhere != 0u {
            terms = Terms(ambient_response(v, frame, parameters), vec3(0.0), vec3(0.0));
        } else {
            terms = response(arriving.l, v, frame, parameters);
        }
";
/// The replacement of that part without uniform light.
const DIRECTED: &str = "        let terms = response(arriving.l, v, frame, parameters);\n";

/// The part of the light loop for light that does not spread.
const UNSPREAD: &str = " + unspread(position, view_direction, frame, TERM_ALL)";

/// The functions that dispatch a light to its type.
fn dispatch(lights: &Lights) -> String {
    let mut text = "// The light that arrives at a point of the room from one light.\n".to_owned();
    for twin in Twin::all(false) {
        function(&mut text, lights, twin, twin.name, false);
    }
    if lights.has_extent() {
        for twin in Twin::all(true) {
            function(&mut text, lights, twin, &format!("{}_light", twin.name), true);
        }
        let all = lights.types.iter().enumerate().filter(|(_, entry)| entry.declaration.extent);
        let all: Vec<_> = all.map(|(t, _)| format!("light_type == {t}u")).collect();
        let _ =
            writeln!(text, "fn has_extent(light_type: u32) -> bool {{\n    return {};\n}}", all.join(" || "));
    }
    text
}

/// A function that dispatches lights with or without extent to their types; others are dark there.
fn function(text: &mut String, lights: &Lights, twin: &Twin, name: &str, extent: bool) {
    let [taken, _] = twin.more;
    let _ = writeln!(text, "fn {name}(light: Light, p: vec3<f32>{taken}) -> {} {{", twin.result);
    let all = lights.types.iter().enumerate().filter(|(_, entry)| entry.declaration.extent == extent);
    let mut calls: Vec<_> = all.map(|(t, _)| (t, call(lights, t, twin))).collect();
    let rest = match calls.len() == lights.types.len() {
        true => calls.pop().map_or_else(|| twin.dark.to_owned(), |(_, last)| last),
        false => twin.dark.to_owned(),
    };
    if calls.is_empty() {
        let _ = writeln!(text, "    return {rest};\n}}");
        return;
    }
    text.push_str("    switch light.light_type {\n");
    for (t, call) in calls {
        let _ = writeln!(text, "        case {t}u: {{ return {call}; }}");
    }
    let _ = writeln!(text, "        default: {{ return {rest}; }}\n    }}\n}}");
}

/// The inputs of the shader: their types, bindings, and the functions that read them.
fn inputs(
    lights: &Lights,
    (model, passage): (&ModelEntry, Passage),
    shading: &ShadingEntry,
    host: Host,
) -> String {
    let wanted = |part: &str| match part {
        "curve" => model.has_curve(),
        "shading" => !shading.parameters.is_empty(),
        "extent" => lights.has_extent(),
        "lamps" => !lights.numbers.is_empty(),
        "solid" => passage.solid,
        "samples" => lights.has_extent() || passage.solid,
        // Surroundings may have a picture.
        _ => lights.numbers.is_empty() && lights.has_extent(),
    };
    let places: &[(&str, &dyn Display)] = &[
        ("group", &wrapper::group(host)),
        ("parameters", &parameter_struct("Parameters", model.parameters)),
        ("count", &lights.rows.len()),
        ("room", &lights.rows.len().max(1)),
        ("length", &model.curve_length()),
        ("harmonics", &model.harmonics()),
        ("shading", &parameter_struct(shading::PARAMETERS, shading.parameters)),
        ("samples", &LIGHT_SAMPLES),
        ("lobes", &MAX_LOBES),
        ("width", &bodies::WIDTH),
        ("rows", &lights.numbers.len().div_ceil(4)),
    ];
    filled(&chosen(include_str!("inputs.wgsl"), wanted), places)
}

/// Drops unused parts, then builds the record of a light from the fields that are left.
fn finish(sections: Vec<Section>, lights: &Lights, host: Host) -> Shader {
    let (headings, mut all): (Vec<_>, Vec<_>) = sections.into_iter().map(|s| (s.heading, s.items)).unzip();
    let mut more = all.clone();
    retain_used(&mut all, &["vertex", "fragment"]);
    retain_used(&mut more, &["vertex", "fragment", "sharp"]);
    let has = |name: &str| all.iter().flatten().any(|item| item.name == name);
    let beside = more.iter().flatten().filter(|item| !has(&item.name));
    let beside = beside.fold(String::new(), |text, item| text + "\n" + &item.text + "\n");
    // In the light loop and the light types, a field name refers to a light, or equals the name of a light's
    // field. Both are the same for all models of a scene, and so is the record.
    let handling = LIGHT_LOOP..LIGHT_LOOP + 1 + lights.types.len();
    let texts: Vec<_> = all[handling].iter().flatten().map(|item| item.text.as_str()).collect();
    let used = fields(texts.iter().copied());
    let light_fields: Vec<_> =
        lights.fields().into_iter().filter(|field| used.contains(field.name.as_str())).collect();
    let read = |field: &str| texts.iter().any(|text| text.contains(&format!("illumination.{field}")));
    let kept = |line: &&str| line.trim().split_once(':').is_none_or(|(name, _)| read(name));
    let narrow = |item: &Item| item.text.lines().filter(kept).collect::<Vec<_>>().join("\n");
    let illumination = all.iter().flatten().find(|item| item.name == "Illumination").map(narrow);
    for item in all.iter_mut().flatten().filter(|item| item.name == "Illumination") {
        item.text = illumination.clone().unwrap_or_default();
    }
    let mut record = "struct Light {\n".to_owned();
    for LightField { name, kind, .. } in &light_fields {
        let _ = writeln!(record, "    {name}: {kind},");
    }
    record.push('}');
    all[1].insert(1, Item { name: "Light".to_owned(), text: record });
    let has = |name: &str| all.iter().flatten().any(|item| item.name == name);
    let (reads_curve, reads_shading, reads_lamps) =
        (has("albedo_curve"), has("shading_values"), has("lamp_numbers"));
    let (reads_lobes, reads_body) = (has("material_lobes"), has("solid_rows"));
    let mut text = wrapper::prelude(host).to_owned();
    // Inputs come first.
    for section in [1, 0].into_iter().chain(2..all.len()) {
        if all[section].is_empty() {
            continue;
        }
        if !headings[section].is_empty() {
            text.push_str("\n// ---------------------------------------------------------------------\n");
            for line in headings[section].lines().flat_map(wrapped) {
                let _ = writeln!(text, "// {}", line.replace(char::is_control, " "));
            }
        }
        for item in &all[section] {
            let apart = !(item.text.starts_with("const ") && text.ends_with(";\n"));
            let gap = if apart && !text.is_empty() { "\n" } else { "" };
            let _ = writeln!(text, "{gap}{}", item.text);
        }
    }
    let reads_header = illumination.is_some_and(|text| text.matches(':').count() > 1);
    Shader {
        text,
        light_fields,
        reads_curve,
        reads_shading,
        reads_lamps,
        reads_lobes,
        reads_body,
        reads_header,
        beside,
    }
}

/// A line for a comment, wrapped at spaces to the line width of the files.
fn wrapped(line: &str) -> Vec<String> {
    /// Characters in a line.
    const WIDTH: usize = 96;
    let indent = &line[..line.len() - line.trim_start().len()];
    let lines = text::wrapped(line, WIDTH.saturating_sub(indent.chars().count()));
    lines.into_iter().map(|line| format!("{indent}{line}")).collect()
}

/// The validated module of a self-contained shader.
///
/// # Errors
/// Returns an error for invalid WGSL, which drawing would have reported.
pub fn module(text: &str) -> Result<(Module, ModuleInfo), ExportError> {
    let module = naga::front::wgsl::parse_str(text)
        .map_err(|e| ExportError::refused(format!("its shader is not valid: {}", e.emit_to_string(text))))?;
    let info = Validator::new(ValidationFlags::all(), Capabilities::empty())
        .validate(&module)
        .map_err(|e| ExportError::refused(format!("its shader is not valid: {}", reason(&e))))?;
    Ok((module, info))
}

#[cfg(test)]
mod tests;
