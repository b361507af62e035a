//! `main.rs`: its text is `template/main.rs.txt`, with places for what this module writes of the scene.

use std::{
    collections::{BTreeMap, BTreeSet},
    fmt::{Display, Write as _},
};

use glam::Vec3;

use super::bodies::Bodies;
use super::words::{camel, comment, field as field_name, kind, number, snake, string, value, vector};
use crate::{
    export::{
        Request,
        bodies::WIDTH,
        lights::LightField,
        lit::{Lit, Material, MeshData, Program},
        names::Names,
    },
    optics::{
        albedo::NODES,
        colour::{BACKGROUND, Encoding},
        lobes::MAX_LOBES,
        tone::ToneMapping,
    },
    parameter::{Parameter, lanes},
    scene::{
        Background,
        observer::{NEAR, orientation},
    },
    text::{
        template::{chosen, filled},
        wrapped,
    },
};

/// The program for a scene with these bodies; `package` is its name.
pub(super) fn text(lit: &Lit, bodies: &Bodies, package: &str) -> String {
    let Request { scene, stem, size: (width, height), .. } = lit.request;
    let observer = &scene.observer;
    let gradient = scene.display.background == Background::Gradient;
    let [above, below] = scene.display.backdrop().unwrap_or([BACKGROUND; 2]);
    let codes = |[r, g, b]: [u8; 3]| format!("{r}, {g}, {b}");
    let title = scene.name.as_deref().unwrap_or(stem);
    let mut names = Names::default();
    let meshes: Vec<_> = lit.meshes.iter().map(|m| names.unique(snake(&m.name))).collect();
    let spawns: String =
        lit.programs.iter().enumerate().map(|(i, p)| spawn(lit, i, p, &meshes, bodies)).collect();
    let polygons = lit.programs.iter().any(Program::faces);
    let main = chosen(include_str!("template/main.rs.txt"), |part| match part {
        "described" => scene.description.is_some(),
        "lamps" => lit.programs.iter().any(|p| p.shader.reads_lamps),
        "srgb" => spawns.contains("srgb("),
        "polygons" => polygons,
        "bodies" => !bodies.all.is_empty(),
        "no_bodies" => bodies.all.is_empty(),
        "gradient" => gradient,
        "plain" => !gradient,
        _ => lit.programs.iter().any(|p| !p.faces()),
    });
    let numbers = lit.lights.numbers.chunks(4);
    let number_of = |row: &[f32], i: usize| row.get(i).copied().unwrap_or_default();
    let all = |text: &dyn Fn(&Program) -> String| lit.programs.iter().map(text).collect::<String>();
    filled(
        &main,
        &[
            ("title", &comment(title)),
            ("description", &comment(scene.description.as_deref().unwrap_or_default())),
            ("size", &format!("{width}, {height}")),
            ("background", &codes(above)),
            ("background_below", &codes(below)),
            ("position", &vector(observer.position)),
            ("direction", &vector(observer.direction)),
            ("field_of_view", &number(observer.field_of_view)),
            ("near", &number(NEAR)),
            ("light_count", &lit.lights.rows.len().max(1)),
            ("lights", &lights(lit)),
            ("lamp_count", &numbers.len()),
            (
                "lamp_numbers",
                &numbers.map(|r| row("    ", [0, 1, 2, 3].map(|i| number_of(r, i)))).collect::<String>(),
            ),
            ("material_types", &all(&|program| material_type(lit, program))),
            ("parameters", &parameters(lit)),
            ("light_fields", &light_types(lit)),
            ("curves", &curves(lit)),
            ("package", &package),
            ("window", &string(title)),
            ("plugins", &all(&plugin)),
            ("tone_mapping", &tonemapping(scene.display.tone_mapping)),
            ("up", &up(observer.direction)),
            ("meshes", &handles(&meshes, "Mesh")),
            ("shaders", &shaders(lit)),
            ("mesh_files", &mesh_files(lit, &meshes)),
            ("bodies", &handles(bodies.all.iter().map(|(name, _)| name), "Image")),
            ("body_files", &body_files(bodies)),
            ("body_width", &WIDTH),
            ("spawns", &spawns),
            ("all_attributes", &attributes(polygons)),
        ],
    )
}

/// Bevy's name of a tone mapping.
fn tonemapping(tone: ToneMapping) -> String {
    match tone {
        ToneMapping::Aces => "AcesFitted".to_owned(),
        // The rest are called as here.
        other => format!("{other:?}"),
    }
}

/// The name of the attributes of vertices.
fn attributes(polygons: bool) -> &'static str {
    if polygons { "WITH_POLYGONS" } else { "ATTRIBUTES" }
}

/// A comment above a declaration, wrapped to the line width.
fn doc(out: &mut String, text: &str, indent: &str, mark: &str) {
    const WIDTH: usize = 99;
    let lines = wrapped(&comment(text), WIDTH - indent.len() - mark.len());
    for line in lines.iter().filter(|line| !line.is_empty()) {
        let _ = writeln!(out, "{indent}{mark} {line}");
    }
}

/// Four numbers as a line.
fn row(indent: &str, [x, y, z, w]: [f32; 4]) -> String {
    format!("{indent}Vec4::new({x:?}, {y:?}, {z:?}, {w:?}),\n")
}

/// The numbers in some bytes as such a line; 0 for those that are missing.
fn row_of(indent: &str, bytes: &[u8]) -> String {
    let (words, _) = bytes.as_chunks::<4>();
    row(indent, [0, 1, 2, 3].map(|i| words.get(i).copied().map_or(0.0, f32::from_le_bytes)))
}

/// The lights; a uniform cannot be empty, so without any there is one that nothing reads.
fn lights(lit: &Lit) -> String {
    let mut out = String::new();
    let light = |out: &mut String, words: &dyn Fn(&LightField) -> Vec<u32>| {
        out.push_str("    Light {\n");
        for field in light_fields(lit) {
            let _ =
                writeln!(out, "        {}: {},", field_name(&field.name), light_value(field, &words(field)));
        }
        out.push_str("    },\n");
    };
    for row in &lit.lights.rows {
        let entry = lit.lights.types[row.light_type].declaration;
        let name = lit.request.scene.lights[row.index].name.as_deref();
        let name = name.map_or(String::new(), |name| format!("{}: ", comment(name)));
        let what = format!("{name}{}: {}.", entry.title(), entry.equation_with_unit());
        doc(&mut out, &what, "    ", "//");
        light(&mut out, &|field| row.words(field));
    }
    if lit.lights.rows.is_empty() {
        light(&mut out, &|field| vec![0; lanes(field.kind)]);
    }
    out
}

fn light_value(field: &LightField, words: &[u32]) -> String {
    let float = |i: usize| words.get(i).copied().map_or(0.0, f32::from_bits);
    match field.kind {
        "vec3<f32>" => vector(Vec3::new(float(0), float(1), float(2))),
        "vec2<f32>" => format!("Vec2::new({}, {})", number(float(0)), number(float(1))),
        "u32" => words.first().copied().unwrap_or_default().to_string(),
        _ => number(float(0)),
    }
}

/// The fields of a light, the same in all shaders.
fn light_fields<'a>(lit: &'a Lit) -> &'a [LightField] {
    lit.programs.first().map_or(&[], |program| program.shader.light_fields.as_slice())
}

fn type_name(program: &Program) -> String {
    camel(&program.name())
}

/// The material type of a program, and its implementation.
fn material_type(lit: &Lit, program: &Program) -> String {
    let (model, shading) = (program.model.declaration, program.shading.declaration);
    let mut about = String::new();
    doc(&mut about, &format!("{} under {} shading.", model.name, shading.name), "", "///");
    if !model.source.is_empty() {
        doc(&mut about, &format!("{}.", model.source.trim_end_matches('.')), "", "///");
    }
    if !model.equation.is_empty() {
        about.push_str("///\n/// ```text\n");
        for part in model.equation {
            let _ = writeln!(about, "/// {}", part.text);
        }
        about.push_str("/// ```\n");
    }
    filled(
        &with_inputs(include_str!("template/material.rs.txt"), program),
        &[
            ("about", &about),
            ("name", &type_name(program)),
            ("model", &camel(model.id)),
            ("curve", &curve_type(program.model.curve_length())),
            ("shading", &camel(shading.id)),
            ("lamp_count", &lit.lights.numbers.len().div_ceil(4)),
            ("lobe_count", &MAX_LOBES),
            ("file", &program.name()),
            ("attributes", &attributes(program.faces())),
        ],
    )
}

/// A template with the inputs that the shader of a program reads.
fn with_inputs(template: &str, program: &Program) -> String {
    let shader = &program.shader;
    chosen(template, |input| match input {
        "curve" => shader.reads_curve,
        "shading" => shader.reads_shading,
        "lamps" => shader.reads_lamps,
        "body" => shader.reads_body,
        _ => shader.reads_lobes,
    })
}

/// The structs of parameters, each once: those of the reflection models, then those of the shading models.
fn parameters(lit: &Lit) -> String {
    let models = lit.programs.iter().map(|p| {
        let d = p.model.declaration;
        (d.id, "Parameters", format!("{} reflection", d.name), p.model.parameters)
    });
    let shadings = lit.programs.iter().filter(|p| p.shader.reads_shading).map(|p| {
        let d = p.shading.declaration;
        (d.id, "Shading", format!("{} shading", d.name), p.shading.parameters)
    });
    let mut known = BTreeSet::new();
    let mut out = String::new();
    for (id, kind, what, all) in models.chain(shadings) {
        if known.insert((kind, id)) {
            let name = format!("{}{kind}", camel(id));
            let places: &[(&str, &dyn Display)] = &[("of", &what), ("name", &name), ("fields", &fields(all))];
            out.push_str(&filled(include_str!("template/parameters.rs.txt"), places));
        }
    }
    out
}

/// The fields of a struct of parameters.
fn fields(all: &[Parameter]) -> String {
    let mut out = String::new();
    for p in all {
        let unit = match p.unit {
            "" => String::new(),
            // The values are decoded where they are written.
            "sRGB" => ", linear".to_owned(),
            unit => format!(", {unit}"),
        };
        let own = p.symbol.is_empty() || p.symbol == p.label;
        let symbol = if own { String::new() } else { format!("{}: ", p.symbol) };
        doc(&mut out, &format!("{symbol}{}{unit}.", p.label), "    ", "///");
        let _ = writeln!(out, "    {}: {},", field_name(p.name), kind(p.kind.wgsl()));
    }
    if all.is_empty() {
        out.push_str("    unused: f32,\n");
    }
    out
}

/// The unit of a parameter, appended to its label.
fn unit(unit: &str) -> String {
    if unit.is_empty() { ".".to_owned() } else { format!(", {unit}.") }
}

/// The fields of a light, with what they are.
fn light_types(lit: &Lit) -> String {
    let mut out = String::new();
    for field in light_fields(lit) {
        let about = match field.name.as_str() {
            "position" => "Metres.",
            "direction" => "The direction in which it shines, of length 1.",
            "intensity" => "In the unit of its type.",
            "colour" => "Linear.",
            "light_type" => "The number of its type in the shader.",
            _ => "",
        };
        let of_type =
            lit.lights.types.iter().flat_map(|t| t.parameters).find(|p| field.name.ends_with(p.name));
        let about = match of_type {
            Some(p) if about.is_empty() => format!("{}{} {}", p.label, unit(p.unit), p.help),
            _ => about.to_owned(),
        };
        doc(&mut out, &about, "    ", "///");
        let _ = writeln!(out, "    {}: {},", field_name(&field.name), kind(field.kind));
    }
    out
}

/// The structs of curves, one for each length.
fn curves(lit: &Lit) -> String {
    let with_curves = lit.programs.iter().filter(|p| p.shader.reads_curve);
    let lengths: BTreeSet<_> = with_curves.map(|p| p.model.curve_length()).collect();
    let curve =
        |n: usize| filled(include_str!("template/curve.rs.txt"), &[("name", &curve_type(n)), ("length", &n)]);
    lengths.into_iter().map(curve).collect()
}

/// The name of the struct for curves of this length, numbered by harmonics if they contain nothing else.
fn curve_type(length: usize) -> String {
    if length.is_multiple_of(NODES) {
        format!("AlbedoCurve{}", length / NODES)
    } else {
        format!("AlbedoCurveOf{length}")
    }
}

/// The statements of the program for a material type.
fn plugin(program: &Program) -> String {
    let after = if program.shader.reads_body { "load_bodies" } else { "load" };
    let places: &[(&str, &dyn Display)] =
        &[("type", &type_name(program)), ("program", &program.name()), ("after", &after)];
    filled(include_str!("template/plugin.rs.txt"), places)
}

/// The up direction of the picture: y, unless that is the viewing direction.
fn up(direction: Vec3) -> &'static str {
    match orientation(direction).y_axis {
        axis if axis.y > 1e-6 => "Vec3::Y",
        axis if axis.z > 0.0 => "Vec3::Z",
        _ => "Vec3::NEG_Z",
    }
}

/// The shaders, between the brackets of a list.
fn shaders(lit: &Lit) -> String {
    let loads: Vec<_> =
        lit.programs.iter().map(|p| format!("assets.load(\"shaders/{}.wgsl\")", p.name())).collect();
    match loads.as_slice() {
        [one] => one.clone(),
        all => format!("\n        {},\n    ", all.join(",\n        ")),
    }
}

/// The fields of a struct with handles.
fn handles<'a>(names: impl IntoIterator<Item = &'a String>, of: &str) -> String {
    names.into_iter().map(|name| format!("    {name}: Handle<{of}>,\n")).collect()
}

/// The meshes with their files.
fn mesh_files(lit: &Lit, meshes: &[String]) -> String {
    let line = |(mesh, name): (&MeshData, &String)| included(name, "meshes.add(mesh", &mesh.name);
    lit.meshes.iter().zip(meshes).map(line).collect()
}

/// The bodies with their files.
fn body_files(bodies: &Bodies) -> String {
    let line = |(name, _): &(String, _)| included(name, "images.add(body", &format!("{name}_body"));
    bodies.all.iter().map(line).collect()
}

/// A field with the content of a file, broken into lines as rustfmt would.
fn included(field: &str, read: &str, file: &str) -> String {
    let file = format!("\"../assets/meshes/{file}.bin\"");
    let line = format!("        {field}: {read}(include_bytes!({file}))),\n");
    // The argument of `add`: rustfmt allows calls 60 characters for theirs.
    let argument = "mesh(include_bytes!())".len() + file.len();
    if line.len() <= 101 && argument <= 60 {
        return line;
    }
    format!("        {field}: {read}(include_bytes!(\n            {file}\n        ))),\n")
}

/// The system that spawns the objects of a material type.
fn spawn(lit: &Lit, index: usize, program: &Program, meshes: &[String], bodies: &Bodies) -> String {
    let mut taken = Names::default();
    let mut handles = BTreeMap::new();
    let mut materials = String::new();
    for (m, material) in lit.materials.iter().enumerate().filter(|(_, m)| m.program == index) {
        let first = lit.objects.iter().find(|o| o.material == m);
        let object = first.and_then(|o| lit.request.scene.objects[o.index].name.as_deref());
        let base = object
            .map(snake)
            .filter(|name| !name.is_empty())
            .unwrap_or_else(|| program.model.declaration.id.to_owned());
        let handle = taken.unique(format!("{base}_material"));
        let body = bodies.of_materials.get(&m).map_or("", |body| bodies.all[*body].0.as_str());
        materials.push_str(&new_material(lit, program, material, (&handle, body)));
        handles.insert(m, handle);
    }
    let mut objects = String::new();
    for drawn in lit.objects.iter().filter(|o| lit.materials[o.material].program == index) {
        let object = &lit.request.scene.objects[drawn.index];
        let name = object.name.as_deref().unwrap_or(&object.object_type);
        let (name, mesh, material) = (string(name), &meshes[drawn.mesh], &handles[&drawn.material]);
        let [position, rotation] = [object.position, object.rotation].map(vector);
        let size = number(object.size);
        let place = format!("{position}, {rotation}, {size}");
        let _ = writeln!(objects, "        ({name}, &meshes.{mesh}, &{material}, {place}),");
    }
    filled(
        &with_inputs(include_str!("template/spawn.rs.txt"), program),
        &[
            ("model", &program.model.declaration.name),
            ("shading", &program.shading.declaration.name),
            ("program", &program.name()),
            ("type", &type_name(program)),
            ("materials", &materials),
            ("objects", &objects),
        ],
    )
}

/// The statement that makes a material, by its name and that of its body.
fn new_material(lit: &Lit, program: &Program, material: &Material, (handle, body): (&str, &str)) -> String {
    let encoding = lit.request.scene.display.encoding;
    let length = program.model.curve_length();
    let nodes = material.curve.get(..16 * length).unwrap_or_default();
    let mean = material.curve.get(16 * length..).and_then(|b| b.first_chunk());
    let rows =
        |bytes: &[u8], indent: &str| bytes.chunks(16).map(|row| row_of(indent, row)).collect::<String>();
    filled(
        &with_inputs(include_str!("template/new_material.rs.txt"), program),
        &[
            ("handle", &handle),
            ("type", &type_name(program)),
            ("model", &camel(program.model.declaration.id)),
            ("parameters", &values(program.model.parameters, material, encoding)),
            ("curve", &curve_type(length)),
            ("nodes", &rows(nodes, "                ")),
            ("mean", &number(mean.copied().map_or(0.0, f32::from_le_bytes))),
            ("shading", &camel(program.shading.declaration.id)),
            ("shading_parameters", &values(program.shading.parameters, material, encoding)),
            ("lobes", &rows(&material.lobes, "            ")),
            ("interior", &rows(&material.interior, "            ")),
            ("body", &body),
        ],
    )
}

/// The fields of a struct of parameters with the values of a material.
fn values(all: &[Parameter], material: &Material, encoding: Encoding) -> String {
    let mut out = String::new();
    for p in all {
        let (text, comment) = value(p, &material.values, encoding);
        if let Some(comment) = comment {
            let _ = writeln!(out, "            // {comment}.");
        }
        let _ = writeln!(out, "            {}: {text},", field_name(p.name));
    }
    if all.is_empty() {
        out.push_str("            unused: 0.0,\n");
    }
    out
}
