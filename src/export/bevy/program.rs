//! `main.rs`.

use std::fmt::Write as _;

use glam::Vec3;

use super::words::{camel, comment, field as field_name, kind, number, snake, string, value, vector};
use crate::{
    export::{
        lights::LightField,
        lit::{Lit, Material, Program},
        names::Names,
    },
    optics::{
        albedo::NODES,
        colour::{BACKGROUND, Encoding},
        lobes::MAX_LOBES,
        tone::ToneMapping,
    },
    parameter::Parameter,
    scene::observer::{NEAR, orientation},
};

/// The program for a scene; `package` is its name.
pub(super) fn text(lit: &Lit, package: &str) -> String {
    let mut out = String::new();
    head(&mut out, lit);
    constants(&mut out, lit);
    for program in &lit.programs {
        material_type(&mut out, lit, program);
    }
    let mut seen = Vec::new();
    for program in &lit.programs {
        let id = program.model.declaration.id;
        if !seen.contains(&id) {
            seen.push(id);
            parameters(
                &mut out,
                &format!("{}Parameters", camel(id)),
                program.model.parameters,
                &format!("The parameters of {} reflection.", program.model.declaration.name),
            );
        }
    }
    let mut seen = Vec::new();
    for program in lit.programs.iter().filter(|p| p.shader.reads_shading) {
        let id = program.shading.declaration.id;
        if !seen.contains(&id) {
            seen.push(id);
            parameters(
                &mut out,
                &format!("{}Shading", camel(id)),
                program.shading.parameters,
                &format!("The parameters of {} shading.", program.shading.declaration.name),
            );
        }
    }
    records(&mut out, lit);
    main_function(&mut out, lit, package);
    setup(&mut out, lit);
    meshes(&mut out, lit);
    out
}

fn title(lit: &Lit) -> String {
    lit.request.scene.name.clone().unwrap_or_else(|| lit.request.stem.to_owned())
}

fn head(out: &mut String, lit: &Lit) {
    let scene = lit.request.scene;
    let title = title(lit);
    let _ = writeln!(out, "//! {}", comment(&title));
    if let Some(description) = &scene.description {
        let _ = writeln!(out, "//!\n//! {}", comment(description));
    }
    out.push_str(
        "//!
//! `cargo run --release` opens a window; `cargo run --release -- --capture picture.png` writes a picture.

use std::time::Duration;

use bevy::{
    app::ScheduleRunnerPlugin,
    camera::{Hdr, RenderTarget},
    core_pipeline::tonemapping::{DebandDither, Tonemapping},
    mesh::{
        Indices, MeshVertexAttribute, MeshVertexBufferLayoutRef, PrimitiveTopology, VertexFormat,
    },
    pbr::{MaterialPipeline, MaterialPipelineKey},
    prelude::*,
    reflect::TypePath,
    render::{
        RenderPlugin,
        render_resource::{
            AsBindGroup, RenderPipelineDescriptor, ShaderType, SpecializedMeshPipelineError,
            TextureFormat,
        },
        view::screenshot::{Screenshot, ScreenshotCaptured, save_to_disk},
    },
    shader::ShaderRef,
    window::{ExitCondition, WindowResolution},
    winit::WinitPlugin,
};
",
    );
}

/// A comment above a declaration, wrapped to the line width.
fn doc(out: &mut String, text: &str, indent: &str, mark: &str) {
    const WIDTH: usize = 100;
    let mut line = String::new();
    for word in comment(text).split_whitespace() {
        if !line.is_empty()
            && indent.len() + mark.len() + 2 + line.chars().count() + word.chars().count() > WIDTH
        {
            let _ = writeln!(out, "{indent}{mark} {line}");
            line.clear();
        }
        if !line.is_empty() {
            line.push(' ');
        }
        line.push_str(word);
    }
    if !line.is_empty() {
        let _ = writeln!(out, "{indent}{mark} {line}");
    }
}

fn constants(out: &mut String, lit: &Lit) {
    let scene = lit.request.scene;
    let (width, height) = lit.request.size;
    let observer = &scene.observer;
    let [r, g, b] = BACKGROUND;
    let _ = write!(
        out,
        "
/// The size of the window and of captured pictures, in pixels.
const SIZE: UVec2 = UVec2::new({width}, {height});
const BACKGROUND: Color = Color::srgb_u8({r}, {g}, {b});

/// The eye, in metres; y is up.
const OBSERVER: Vec3 = {};
const LOOKING_ALONG: Vec3 = {};
/// Vertical, in degrees.
const FIELD_OF_VIEW: f32 = {};
/// The distance of the nearest things that are drawn, in metres.
const NEAR: f32 = {};
",
        vector(observer.position),
        vector(observer.direction),
        number(observer.field_of_view),
        number(NEAR),
    );
    if let Some(fields) = light_fields(lit) {
        let _ =
            write!(out, "\n/// The lights.\nconst LIGHTS: [Light; {}] = [\n", lit.lights.rows.len().max(1));
        for row in &lit.lights.rows {
            let light = &scene.lights[row.index];
            let entry = lit.lights.types[row.light_type].declaration;
            let what = format!("{} light: {}, I in {}", entry.name, entry.equation, entry.unit);
            let name = light.name.as_deref().map_or(String::new(), |name| format!("{}: ", comment(name)));
            doc(out, &format!("{name}{what}."), "    ", "//");
            out.push_str("    Light {\n");
            for field in fields {
                let words = row.words(field);
                let value = light_value(field, &words);
                let _ = writeln!(out, "        {}: {value},", field_name(&field.name));
            }
            out.push_str("    },\n");
        }
        if lit.lights.rows.is_empty() {
            // A uniform cannot be empty; nothing reads this one.
            out.push_str("    Light {\n");
            for field in fields {
                let zero = vec![0; crate::export::lights::size(field.kind)];
                let _ = writeln!(out, "        {}: {},", field_name(&field.name), light_value(field, &zero));
            }
            out.push_str("    },\n");
        }
        out.push_str("];\n");
    }
    if lit.programs.iter().any(|p| p.shader.reads_lamps) {
        let rows: Vec<_> = lit.lights.numbers.chunks(4).collect();
        let _ = write!(
            out,
            "\n/// The numbers of the files of lamps: counts of angles, angles, candelas.\n#[rustfmt::skip]\nconst LAMP_NUMBERS: [Vec4; {}] = [\n",
            rows.len()
        );
        for row in rows {
            let at = |i: usize| row.get(i).copied().unwrap_or_default();
            let _ = writeln!(out, "    Vec4::new({:?}, {:?}, {:?}, {:?}),", at(0), at(1), at(2), at(3));
        }
        out.push_str("];\n");
    }
}

fn light_value(field: &LightField, words: &[u32]) -> String {
    let float = |i: usize| words.get(i).copied().map_or(0.0, f32::from_bits);
    match field.kind {
        "vec3<f32>" => vector(Vec3::new(float(0), float(1), float(2))),
        "u32" => words.first().copied().unwrap_or_default().to_string(),
        _ => number(float(0)),
    }
}

/// The fields of a light, shared by all shaders; `None` if no shader has lights.
fn light_fields<'a>(lit: &'a Lit) -> Option<&'a [LightField]> {
    lit.programs.first().map(|program| program.shader.light_fields.as_slice())
}

fn type_name(program: &Program) -> String {
    camel(&program.name())
}

/// Writes the material type of a program and its implementation.
fn material_type(out: &mut String, lit: &Lit, program: &Program) {
    let (model, shading) = (program.model.declaration, program.shading.declaration);
    let name = type_name(program);
    out.push('\n');
    doc(out, &format!("{} under {} shading.", model.name, shading.name), "", "///");
    if !model.source.is_empty() {
        doc(out, &format!("{}.", model.source.trim_end_matches('.')), "", "///");
    }
    if !model.equation.is_empty() {
        out.push_str("///\n/// ```text\n");
        for part in model.equation {
            let _ = writeln!(out, "/// {}", part.text);
        }
        out.push_str("/// ```\n");
    }
    let _ = write!(
        out,
        "#[derive(Asset, TypePath, AsBindGroup, Clone)]
struct {name} {{
    #[uniform(0)]
    parameters: {}Parameters,
    #[uniform(1)]
    lights: Lights,
",
        camel(model.id)
    );
    if program.shader.reads_curve {
        let _ = write!(
            out,
            "    #[uniform(2)]\n    albedo_curve: {},\n",
            curve_type(program.model.curve_length())
        );
    }
    if program.shader.reads_shading {
        let _ = write!(out, "    #[uniform(3)]\n    shading: {}Shading,\n", camel(shading.id));
    }
    if program.shader.reads_lamps {
        let _ = write!(
            out,
            "    #[uniform(4)]\n    lamp_numbers: [Vec4; {}],\n",
            lit.lights.numbers.len().div_ceil(4)
        );
    }
    if program.shader.reads_lobes {
        let _ = write!(out, "    #[uniform(7)]\n    lobes: [Vec4; {MAX_LOBES}],\n");
    }
    let attributes = if program.faces() { "&WITH_POLYGONS" } else { "&ATTRIBUTES" };
    let _ = write!(
        out,
        "}}

impl Material for {name} {{
    fn vertex_shader() -> ShaderRef {{
        \"shaders/{file}.wgsl\".into()
    }}

    fn fragment_shader() -> ShaderRef {{
        \"shaders/{file}.wgsl\".into()
    }}

    fn enable_prepass() -> bool {{
        false
    }}

    fn enable_shadows() -> bool {{
        false
    }}

    fn specialize(
        _pipeline: &MaterialPipeline,
        descriptor: &mut RenderPipelineDescriptor,
        layout: &MeshVertexBufferLayoutRef,
        _key: MaterialPipelineKey<Self>,
    ) -> Result<(), SpecializedMeshPipelineError> {{
        use_attributes(descriptor, layout, {attributes})
    }}
}}
",
        file = program.name()
    );
}

/// Writes a struct of parameters.
fn parameters(out: &mut String, name: &str, all: &[Parameter], what: &str) {
    let _ = write!(out, "\n/// {what}\n#[derive(ShaderType, Clone, Copy, Debug)]\nstruct {name} {{\n");
    for p in all {
        let unit = match p.unit {
            "" => String::new(),
            // The values are decoded where they are written.
            "sRGB" => ", linear".to_owned(),
            unit => format!(", {unit}"),
        };
        let own = p.symbol.is_empty() || p.symbol == p.label;
        let symbol = if own { String::new() } else { format!("{}: ", p.symbol) };
        doc(out, &format!("{symbol}{}{unit}.", p.label), "    ", "///");
        let _ = writeln!(out, "    {}: {},", field_name(p.name), kind(p.wgsl_type()));
    }
    if all.is_empty() {
        out.push_str("    unused: f32,\n");
    }
    out.push_str("}\n");
}

/// The unit of a parameter, appended to its label.
fn unit(unit: &str) -> String {
    if unit.is_empty() { ".".to_owned() } else { format!(", {unit}.") }
}

/// Writes the records of lights and curves.
fn records(out: &mut String, lit: &Lit) {
    if let Some(fields) = light_fields(lit) {
        let _ = write!(
            out,
            "
/// The lights as the shaders read them.
#[derive(ShaderType, Clone, Copy, Debug)]
struct Lights {{
    lights: [Light; {}],
}}

#[derive(ShaderType, Clone, Copy, Debug)]
struct Light {{
",
            lit.lights.rows.len().max(1)
        );
        for field in fields {
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
            doc(out, &about, "    ", "///");
            let _ = writeln!(out, "    {}: {},", field_name(&field.name), kind(field.kind));
        }
        out.push_str("}\n");
    }
    let mut sizes: Vec<_> =
        lit.programs.iter().filter(|p| p.shader.reads_curve).map(|p| p.model.curve_length()).collect();
    sizes.sort_unstable();
    sizes.dedup();
    for length in sizes {
        let _ = write!(
            out,
            "
/// The directional albedo of a material, calculated beforehand by numerical integration.
#[derive(ShaderType, Clone, Copy, Debug)]
struct {} {{
    /// For cosines (i/15)³ of the angle of view: red, green, blue, and that of the specular lobe alone; then the curves
    /// that the model has beside it.
    nodes: [Vec4; {length}],
    /// The mean of the lobe's over the hemisphere.
    mean: f32,
}}
",
            curve_type(length)
        );
    }
}

/// The name of the struct for curves of this length, numbered by harmonics if they contain nothing else.
fn curve_type(length: usize) -> String {
    if length.is_multiple_of(NODES) {
        format!("AlbedoCurve{}", length / NODES)
    } else {
        format!("AlbedoCurveOf{length}")
    }
}

/// The name of a tone mapping in Bevy.
fn tonemapping(tone: ToneMapping) -> &'static str {
    match tone {
        ToneMapping::None => "None",
        ToneMapping::Reinhard => "Reinhard",
        ToneMapping::ReinhardLuminance => "ReinhardLuminance",
        ToneMapping::Aces => "AcesFitted",
        ToneMapping::AgX => "AgX",
        ToneMapping::TonyMcMapface => "TonyMcMapface",
        ToneMapping::BlenderFilmic => "BlenderFilmic",
        ToneMapping::KhronosPbrNeutral => "KhronosPbrNeutral",
    }
}

fn main_function(out: &mut String, lit: &Lit, package: &str) {
    let groups: String = lit
        .programs
        .iter()
        .map(|p| {
            format!(
                "    app.add_plugins(MaterialPlugin::<{}>::default())
        .add_systems(Startup, spawn_{}.after(load));
",
                type_name(p),
                p.name()
            )
        })
        .collect();
    let _ = write!(
        out,
        "
/// The file for a picture, if one is wanted instead of a window.
#[derive(Resource, Clone)]
struct Capture(String);

fn main() -> AppExit {{
    let capture = match std::env::args().skip(1).collect::<Vec<_>>().as_slice() {{
        [] => None,
        [flag, file] if flag == \"--capture\" => Some(Capture(file.clone())),
        _ => {{
            {TELL}(\"usage: {package} [--capture FILE.png]\");
            return AppExit::from_code(2);
        }}
    }};
    let window = Window {{
        title: {}.into(),
        resolution: WindowResolution::new(SIZE.x, SIZE.y),
        ..default()
    }};
    let mut plugins = DefaultPlugins.build().set(RenderPlugin {{
        // A picture shows everything from its first frame on.
        synchronous_pipeline_compilation: true,
        ..default()
    }});
    plugins = match capture {{
        None => plugins.set(WindowPlugin {{
            primary_window: Some(window),
            ..default()
        }}),
        Some(_) => plugins.disable::<WinitPlugin>().set(WindowPlugin {{
            primary_window: None,
            exit_condition: ExitCondition::DontExit,
            ..default()
        }}),
    }};
    let mut app = App::new();
    app.add_plugins(plugins);
{groups}    app.insert_resource(ClearColor(BACKGROUND))
        .add_systems(Startup, (load, camera));
    if let Some(capture) = capture {{
        app.add_plugins(ScheduleRunnerPlugin::run_loop(Duration::ZERO));
        app.insert_resource(capture)
            .add_systems(Update, take_picture);
    }}
    app.run()
}}

/// Looks at the scene, into the window or into a picture.
fn camera(
    mut commands: Commands,
    mut images: ResMut<Assets<Image>>,
    capture: Option<Res<Capture>>,
) {{
    let mut camera = commands.spawn((
        Camera3d::default(),
        Hdr,
        Tonemapping::{},
        DebandDither::Disabled,
        Msaa::Sample4,
        Transform::from_translation(OBSERVER).looking_to(LOOKING_ALONG, {}),
        Projection::Perspective(PerspectiveProjection {{
            fov: FIELD_OF_VIEW.to_radians(),
            near: NEAR,
            ..default()
        }}),
    ));
    if capture.is_some() {{
        let picture =
            Image::new_target_texture(SIZE.x, SIZE.y, TextureFormat::Rgba8UnormSrgb, None);
        camera.insert(RenderTarget::Image(images.add(picture).into()));
    }}
}}

/// Waits until the shaders are there, writes the picture, and ends the program.
fn take_picture(
    mut commands: Commands,
    mut frames: Local<u32>,
    capture: Res<Capture>,
    shaders: Res<Shaders>,
    assets: Res<AssetServer>,
    camera: Single<&RenderTarget>,
) {{
    /// Frames that are drawn between loading and the picture.
    const PAUSE: u32 = 3;
    let loaded = |shader: &Handle<Shader>| assets.is_loaded_with_dependencies(shader);
    if !shaders.0.iter().all(loaded) {{
        return;
    }}
    *frames += 1;
    if *frames == PAUSE {{
        commands
            .spawn(Screenshot(camera.clone()))
            .observe(save_to_disk(capture.0.clone()))
            .observe(
                |_: On<ScreenshotCaptured>, mut exit: MessageWriter<AppExit>| {{
                    exit.write(AppExit::Success);
                }},
            );
    }}
}}
",
        string(&title(lit)),
        tonemapping(lit.request.scene.display.tone_mapping),
        up(lit.request.scene.observer.direction),
    );
}

/// The up direction of the picture: y, unless that is the viewing direction.
fn up(direction: Vec3) -> &'static str {
    match orientation(direction).y_axis {
        axis if axis.y > 1e-6 => "Vec3::Y",
        axis if axis.z > 0.0 => "Vec3::Z",
        _ => "Vec3::NEG_Z",
    }
}

/// Writes the systems that load the meshes and spawn the objects, one for each material type.
fn setup(out: &mut String, lit: &Lit) {
    let mut names = Names::default();
    let meshes: Vec<_> = lit.meshes.iter().map(|m| names.unique(snake(&m.name))).collect();
    load(out, lit, &meshes);
    for (index, program) in lit.programs.iter().enumerate() {
        spawn(out, lit, index, program, &meshes);
    }
    if out.contains("srgb(") {
        out.push_str(SRGB);
    }
    out.push_str(PLACE);
}

/// Writes the system that loads shaders and meshes.
fn load(out: &mut String, lit: &Lit, meshes: &[String]) {
    out.push_str(
        "
/// The shaders, which load while the program starts.
#[derive(Resource)]
struct Shaders(Vec<Handle<Shader>>);

/// The meshes, shared by the objects.
#[derive(Resource)]
struct Meshes {
",
    );
    for name in meshes {
        let _ = writeln!(out, "    {name}: Handle<Mesh>,");
    }
    out.push_str(
        "}

fn load(mut commands: Commands, assets: Res<AssetServer>, mut meshes: ResMut<Assets<Mesh>>) {
",
    );
    let loads: Vec<_> =
        lit.programs.iter().map(|p| format!("assets.load(\"shaders/{}.wgsl\")", p.name())).collect();
    let loads = match loads.as_slice() {
        [one] => one.clone(),
        all => format!("\n        {},\n    ", all.join(",\n        ")),
    };
    let _ = writeln!(
        out,
        "    let shaders = [{loads}];
    commands.insert_resource(Shaders(shaders.into()));
    commands.insert_resource(Meshes {{"
    );
    for (mesh, name) in lit.meshes.iter().zip(meshes) {
        let file = format!("\"../assets/meshes/{}.bin\"", mesh.name);
        let line = format!("        {name}: meshes.add(mesh(include_bytes!({file}))),");
        // Formatted as by rustfmt.
        let line = if line.len() > 100 {
            format!("        {name}: meshes.add(mesh(include_bytes!(\n            {file}\n        ))),")
        } else {
            line
        };
        let _ = writeln!(out, "{line}");
    }
    out.push_str("    });\n}\n");
}

/// Writes the system that spawns the objects of a material type.
fn spawn(out: &mut String, lit: &Lit, index: usize, program: &Program, meshes: &[String]) {
    let _ = write!(
        out,
        "
/// Spawns what reflects by {} under {} shading.
fn spawn_{}(
    mut commands: Commands,
    meshes: Res<Meshes>,
    mut materials: ResMut<Assets<{}>>,
) {{
",
        program.model.declaration.name,
        program.shading.declaration.name,
        program.name(),
        type_name(program)
    );
    let mut taken = Names::default();
    let mut handles = std::collections::BTreeMap::new();
    for (m, material) in lit.materials.iter().enumerate().filter(|(_, m)| m.program == index) {
        let first = lit.objects.iter().find(|o| o.material == m);
        let object = first.and_then(|o| lit.request.scene.objects[o.index].name.as_deref());
        let base = object
            .map(snake)
            .filter(|name| !name.is_empty())
            .unwrap_or_else(|| program.model.declaration.id.to_owned());
        let handle = taken.unique(format!("{base}_material"));
        new_material(out, lit, program, material, &handle);
        handles.insert(m, handle);
    }
    out.push_str("    #[rustfmt::skip]\n    let objects = [\n        // Name, mesh, material, position in metres, rotation about x, y, z in degrees, size in metres.\n");
    for drawn in lit.objects.iter().filter(|o| lit.materials[o.material].program == index) {
        let object = &lit.request.scene.objects[drawn.index];
        let name = object.name.clone().unwrap_or_else(|| object.object_type.clone());
        let _ = writeln!(
            out,
            "        ({}, &meshes.{}, &{}, {}, {}, {}),",
            string(&name),
            meshes[drawn.mesh],
            handles[&drawn.material],
            vector(object.position),
            vector(object.rotation),
            number(object.size)
        );
    }
    out.push_str(
        "    ];
    for (name, mesh, material, position, rotation, size) in objects {
        commands.spawn((
            Name::new(name),
            Mesh3d(mesh.clone()),
            MeshMaterial3d(material.clone()),
            place(position, rotation, size),
        ));
    }
}
",
    );
}

fn new_material(out: &mut String, lit: &Lit, program: &Program, material: &Material, handle: &str) {
    let encoding = lit.request.scene.display.encoding;
    let _ = writeln!(out, "    let {handle} = materials.add({} {{", type_name(program));
    let _ = writeln!(out, "        parameters: {}Parameters {{", camel(program.model.declaration.id));
    values(out, program.model.parameters, material, encoding);
    out.push_str("        },\n        lights: Lights { lights: LIGHTS },\n");
    if program.shader.reads_curve {
        let float = |at: usize| {
            material.curve.get(at..at + 4).and_then(|b| b.try_into().ok()).map_or(0.0, f32::from_le_bytes)
        };
        let length = program.model.curve_length();
        let _ = writeln!(out, "        albedo_curve: {} {{\n            nodes: [", curve_type(length));
        for node in 0..length {
            let at = 16 * node;
            let _ = writeln!(
                out,
                "                Vec4::new({:?}, {:?}, {:?}, {:?}),",
                float(at),
                float(at + 4),
                float(at + 8),
                float(at + 12)
            );
        }
        let _ = writeln!(out, "            ],\n            mean: {:?},\n        }},", float(16 * length));
    }
    if program.shader.reads_shading {
        let _ = writeln!(out, "        shading: {}Shading {{", camel(program.shading.declaration.id));
        values(out, program.shading.parameters, material, encoding);
        out.push_str("        },\n");
    }
    if program.shader.reads_lamps {
        out.push_str("        lamp_numbers: LAMP_NUMBERS,\n");
    }
    if program.shader.reads_lobes {
        out.push_str("        // The directions from which it reflects most light: they guide samples.\n        lobes: [\n");
        for row in material.lobes.chunks(16) {
            let (words, _) = row.as_chunks::<4>();
            let [kind, first, second, share] =
                [0, 1, 2, 3].map(|i| words.get(i).copied().map_or(0.0, f32::from_le_bytes));
            let _ = writeln!(out, "            Vec4::new({kind:?}, {first:?}, {second:?}, {share:?}),");
        }
        out.push_str("        ],\n");
    }
    out.push_str("    });\n");
}

fn values(out: &mut String, all: &[Parameter], material: &Material, encoding: Encoding) {
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
}

/// The macro with which the exported program reports wrong usage; written in one word it would look like a
/// call in this program.
const TELL: &str = concat!("eprint", "ln!");

/// Conversion of colours.
const SRGB: &str = "
/// Linear light from an sRGB colour.
fn srgb(red: u8, green: u8, blue: u8) -> Vec3 {
    Color::srgb_u8(red, green, blue).to_linear().to_vec3()
}
";

const PLACE: &str = "
fn place(position: Vec3, degrees: Vec3, size: f32) -> Transform {
    let [x, y, z] = degrees.to_array().map(f32::to_radians);
    let rotation = Quat::from_euler(EulerRot::ZYX, z, y, x);
    Transform {
        translation: position,
        rotation,
        scale: Vec3::splat(size),
    }
}
";

/// Writes the attributes of vertices, and the functions that read and use them.
fn meshes(out: &mut String, lit: &Lit) {
    let some = lit.programs.iter().any(Program::faces);
    let others = lit.programs.iter().any(|p| !p.faces());
    out.push_str(BRUSH);
    if others {
        out.push_str(ATTRIBUTES);
    }
    if some {
        out.push_str(WITH_POLYGONS);
    }
    let all = if some { "WITH_POLYGONS" } else { "ATTRIBUTES" };
    out.push_str(&MESH.replace("ALL_ATTRIBUTES", all));
}

const BRUSH: &str = "
/// The direction in which the surface is brushed, which matters to anisotropic materials.
const BRUSH: MeshVertexAttribute =
    MeshVertexAttribute::new(\"Brush\", 0x6272_7501, VertexFormat::Float32x3);
";
const ATTRIBUTES: &str = "
/// What vertices have, in the order of the locations in the shaders.
const ATTRIBUTES: [MeshVertexAttribute; 3] =
    [Mesh::ATTRIBUTE_POSITION, Mesh::ATTRIBUTE_NORMAL, BRUSH];
";
const WITH_POLYGONS: &str = "
/// What vertices have that belong to one polygon each, for colours that are calculated at its centre.
const WITH_POLYGONS: [MeshVertexAttribute; 6] = [
    Mesh::ATTRIBUTE_POSITION,
    Mesh::ATTRIBUTE_NORMAL,
    BRUSH,
    MeshVertexAttribute::new(\"FaceNormal\", 0x6272_7502, VertexFormat::Float32x3),
    MeshVertexAttribute::new(\"FaceBrush\", 0x6272_7503, VertexFormat::Float32x3),
    MeshVertexAttribute::new(\"FaceCentre\", 0x6272_7504, VertexFormat::Float32x3),
];
";
const MESH: &str = "
fn use_attributes(
    descriptor: &mut RenderPipelineDescriptor,
    layout: &MeshVertexBufferLayoutRef,
    attributes: &[MeshVertexAttribute],
) -> Result<(), SpecializedMeshPipelineError> {
    let located: Vec<_> = attributes
        .iter()
        .zip(0..)
        .map(|(attribute, at)| attribute.at_shader_location(at))
        .collect();
    descriptor.vertex.buffers = vec![layout.0.get_layout(&located)?];
    descriptor.vertex.entry_point = Some(\"vertex\".into());
    if let Some(fragment) = &mut descriptor.fragment {
        fragment.entry_point = Some(\"fragment\".into());
    }
    Ok(())
}

/// Reads a mesh: the numbers of vertices and attributes; for each vertex three floats for each of its attributes;
/// then three vertices for each triangle. Everything has 32 bits, the lowest byte first.
fn mesh(bytes: &[u8]) -> Mesh {
    let (words, _) = bytes.as_chunks::<4>();
    let [vertices, attributes] = [0, 1].map(|i| u32::from_le_bytes(words[i]) as usize);
    let (floats, indices) = words[2..].split_at(vertices * attributes * 3);
    let float = |i: usize| f32::from_le_bytes(floats[i]);
    let mut mesh = Mesh::new(PrimitiveTopology::TriangleList, default());
    for (at, attribute) in ALL_ATTRIBUTES.into_iter().take(attributes).enumerate() {
        let start = |vertex: usize| (vertex * attributes + at) * 3;
        let values: Vec<_> = (0..vertices)
            .map(|v| [0, 1, 2].map(|k| float(start(v) + k)))
            .collect();
        mesh.insert_attribute(attribute, values);
    }
    mesh.insert_indices(Indices::U32(
        indices.iter().map(|i| u32::from_le_bytes(*i)).collect(),
    ));
    mesh
}
";
