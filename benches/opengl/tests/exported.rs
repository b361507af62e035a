//! Exported GLSL draws what the lab draws, in a program that knows nothing but the manifest.

#[path = "../src/context.rs"]
mod context;

use glow::HasContext as _;
use lights_camera_models::{
    export::{self, Progress, Request},
    reference::{Settings, render_rgb8},
    registry::Registry,
    scene::{
        Scene,
        load::{Defaults, from_text},
    },
};
use serde_json::{Value, json};

const SIZE: (i32, i32) = (480, 270);

/// The content of an exported file.
fn file<'a>(export: &'a export::Export, name: &str) -> &'a [u8] {
    &export.files.iter().find(|file| file.path == name).expect("it is exported").bytes
}

fn text<'a>(export: &'a export::Export, name: &str) -> &'a str {
    std::str::from_utf8(file(export, name)).expect("text")
}

/// The bytes of a uniform, from the offsets and values of its fields.
fn bytes(binding: &Value) -> Vec<u8> {
    let mut bytes = vec![0; binding["size"].as_u64().expect("a size") as usize];
    for field in binding["fields"].as_array().expect("a list") {
        let values = match &field["value"] {
            Value::Array(all) => all.clone(),
            one => vec![one.clone()],
        };
        let whole = field["type"].as_str().expect("a type").contains("u32");
        let offset = field["offset"].as_u64().expect("an offset") as usize;
        for (i, value) in values.iter().enumerate() {
            let word = match whole {
                true => value.as_u64().expect("a whole number") as u32,
                false => (value.as_f64().expect("a number") as f32).to_bits(),
            };
            bytes[offset + 4 * i..offset + 4 * i + 4].copy_from_slice(&word.to_le_bytes());
        }
    }
    bytes
}

/// Draws an export off screen, and reads the pixels, the upper row first.
fn draw(gl: &glow::Context, export: &export::Export) -> Vec<u8> {
    let manifest: Value = serde_json::from_str(text(export, "manifest.json")).expect("JSON");
    let (width, height) = SIZE;
    unsafe {
        let program = gl.create_program().expect("a program");
        for (stage, name) in [(glow::VERTEX_SHADER, "shader.vert"), (glow::FRAGMENT_SHADER, "shader.frag")] {
            let shader = gl.create_shader(stage).expect("a shader");
            gl.shader_source(shader, text(export, name));
            gl.compile_shader(shader);
            assert!(gl.get_shader_compile_status(shader), "{name}: {}", gl.get_shader_info_log(shader));
            gl.attach_shader(program, shader);
        }
        gl.link_program(program);
        assert!(gl.get_program_link_status(program), "{}", gl.get_program_info_log(program));
        gl.use_program(Some(program));

        for binding in manifest["bindings"].as_array().expect("a list") {
            let buffer = gl.create_buffer().expect("a buffer");
            gl.bind_buffer(glow::UNIFORM_BUFFER, Some(buffer));
            gl.buffer_data_u8_slice(glow::UNIFORM_BUFFER, &bytes(binding), glow::STATIC_DRAW);
            let number = binding["binding"].as_u64().expect("a number") as u32;
            gl.bind_buffer_base(glow::UNIFORM_BUFFER, number, Some(buffer));
        }

        gl.bind_vertex_array(Some(gl.create_vertex_array().expect("an array")));
        gl.bind_buffer(glow::ARRAY_BUFFER, Some(gl.create_buffer().expect("a buffer")));
        gl.buffer_data_u8_slice(glow::ARRAY_BUFFER, file(export, "vertices.bin"), glow::STATIC_DRAW);
        let stride = manifest["vertices"]["stride"].as_i64().expect("a number") as i32;
        for attribute in manifest["vertices"]["attributes"].as_array().expect("a list") {
            let number = |key: &str| attribute[key].as_i64().expect("a number") as i32;
            let location = number("location") as u32;
            gl.enable_vertex_attrib_array(location);
            gl.vertex_attrib_pointer_f32(location, 3, glow::FLOAT, false, stride, number("offset"));
        }
        gl.bind_buffer(glow::ELEMENT_ARRAY_BUFFER, Some(gl.create_buffer().expect("a buffer")));
        gl.buffer_data_u8_slice(glow::ELEMENT_ARRAY_BUFFER, file(export, "indices.bin"), glow::STATIC_DRAW);

        gl.bind_framebuffer(glow::FRAMEBUFFER, Some(gl.create_framebuffer().expect("a target")));
        for (attachment, format) in
            [(glow::COLOR_ATTACHMENT0, glow::RGBA8), (glow::DEPTH_ATTACHMENT, glow::DEPTH_COMPONENT32F)]
        {
            let buffer = gl.create_renderbuffer().expect("a buffer");
            gl.bind_renderbuffer(glow::RENDERBUFFER, Some(buffer));
            gl.renderbuffer_storage(glow::RENDERBUFFER, format, width, height);
            gl.framebuffer_renderbuffer(glow::FRAMEBUFFER, attachment, glow::RENDERBUFFER, Some(buffer));
        }
        gl.viewport(0, 0, width, height);
        let background: Vec<f32> =
            (0..3).map(|i| manifest["background"][i].as_f64().expect("a number") as f32 / 255.0).collect();
        gl.clear_color(background[0], background[1], background[2], 1.0);
        gl.clear_depth_f64(manifest["depth"]["clear"].as_f64().expect("a number"));
        gl.enable(glow::CULL_FACE);
        let clockwise = manifest["indices"]["front_face"] == "cw";
        gl.front_face(if clockwise { glow::CW } else { glow::CCW });
        gl.enable(glow::DEPTH_TEST);
        gl.depth_func(glow::GREATER);
        gl.clear(glow::COLOR_BUFFER_BIT | glow::DEPTH_BUFFER_BIT);
        let count = manifest["indices"]["count"].as_i64().expect("a number") as i32;
        gl.draw_elements(glow::TRIANGLES, count, glow::UNSIGNED_INT, 0);

        let mut rgba = vec![0; (4 * width * height) as usize];
        let into = glow::PixelPackData::Slice(Some(&mut rgba));
        gl.read_pixels(0, 0, width, height, glow::RGBA, glow::UNSIGNED_BYTE, into);
        assert_eq!(gl.get_error(), glow::NO_ERROR);
        // As the manifest says, the first row is the upper one.
        rgba.chunks_exact(4).flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect()
    }
}

fn scene(reflection: &str, shading: &str, object: &str, tone: &str, exposure: f32) -> Scene {
    let text = json!({
        "scene_size": { "height": 10, "width": 10, "depth": 10 },
        "reflection_model": reflection,
        "shading_model": shading,
        "lights": [
            { "type": "point", "position": [1, 9, 9], "colour": [255, 250, 240], "intensity": 20 },
            { "type": "spot", "position": [5, 9, 9], "direction": [0, -1, -1], "cone_angle": 30, "luminous_flux": 400 },
            { "type": "photometric", "position": [8, 9, 6], "direction": [0, -1, 0], "intensity": 0.5 },
            { "type": "directional", "direction": [0, -1, -1], "intensity": 0.5 },
            { "type": "ambient", "intensity": 0.1 }
        ],
        "observer": { "position": [5, 5, 9], "direction": [0, 0, -1], "field_of_view": 45 },
        "objects": [{ "type": object, "position": [5, 5, 5], "size": 2.5, "rotation": [20, 30, 10], "tessellation": 12,
                      "material": { "base_colour": [200, 100, 50] } }],
        "display": { "tone_mapping": tone, "exposure": exposure }
    });
    match from_text(&text.to_string(), "scene.json", &Registry::builtin(), Defaults::Refuse) {
        Ok(loaded) => loaded.scene,
        Err(error) => panic!("{error}"),
    }
}

/// The fraction of values that differ by more than two codes.
fn different(a: &[u8], b: &[u8]) -> f64 {
    assert_eq!(a.len(), b.len());
    let count = a.iter().zip(b).filter(|(a, b)| a.abs_diff(**b) > 2).count();
    count as f64 / a.len() as f64
}

#[test]
fn exported_glsl_draws_the_picture_of_the_lab() {
    let gl = match context::create() {
        Ok(gl) => gl,
        Err(error) if error.to_string().contains("there is no EGL") => return println!("skipped: {error}"),
        Err(error) => panic!("{error}"),
    };
    let registry = Registry::builtin();
    let form = export::form("glsl").expect("built in");
    let cases = [
        ("lambert", "flat", "cube", "none", 0.0),
        ("blinn_phong", "gouraud", "torus", "reinhard", 1.0),
        ("microfacet", "phong", "teapot", "aces", 0.5),
        ("oren_nayar", "derivative", "superellipsoid", "khronos_pbr_neutral", -0.5),
        ("disney", "phong", "sphere", "reinhard_luminance", 0.0),
    ];
    let mut pictures = Vec::new();
    for (reflection, shading, object, tone, exposure) in cases {
        let scene = scene(reflection, shading, object, tone, exposure);
        let size = (SIZE.0 as u32, SIZE.1 as u32);
        let request =
            Request { scene: &scene, registry: &registry, stem: "scene", size, object: 0, point: None };
        let export = (form.make)(&request, &Progress::NONE).expect("exported");
        let drawn = draw(&gl, &export);
        let settings = Settings { width: size.0, height: size.1, samples: 1, ..Settings::default() };
        let lab = render_rgb8(&scene, &registry, &settings);
        let share = different(&drawn, &lab);
        // A pixel of the silhouette here and there.
        assert!(share < 0.001, "{reflection} {shading} {object}: {share} of the values differ");
        pictures.push(lab);
        // The wrong twin: another case's picture.
        if let [before @ .., _] = pictures.as_slice() {
            assert!(before.iter().all(|other| different(&drawn, other) > 0.02), "{reflection}");
        }
    }
}
