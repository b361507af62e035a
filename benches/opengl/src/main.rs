//! The default scene of the lab, written in OpenGL: a sphere, a point light, Lambert's law at the vertices.
//!
//!     default-scene-in-opengl [-o FILE.png] [--size WxH] [--frames N]
//!
//! Draws off screen, and writes the picture to a PNG file. With --frames it then draws so many frames, waits for each,
//! and prints the milliseconds that each took.

mod context;

use std::{error::Error, fs::File, io::BufWriter, time::Instant};

use glam::{Mat4, Vec3};
use glow::HasContext as _;

const BANDS: u32 = 32;
const SPHERE_CENTRE: Vec3 = Vec3::new(5.0, 5.0, 5.0);
const SPHERE_DIAMETER: f32 = 2.0;
const BASE_COLOUR: Vec3 = Vec3::ONE;
const LIGHT_POSITION: Vec3 = Vec3::new(7.5, 8.0, 9.0);
const LIGHT_INTENSITY: Vec3 = Vec3::splat(20.0);
const EYE: Vec3 = Vec3::new(5.0, 5.0, 9.5);
const FIELD_OF_VIEW: f32 = 45.0;
/// sRGB 46 in linear light.
const BACKGROUND: f32 = 0.027_320_892;

/// Positions with their normals, and triangles, of a sphere of diameter 1.
fn sphere() -> (Vec<f32>, Vec<u16>) {
    let segments = 2 * BANDS;
    let mut vertices = Vec::new();
    for band in 0..=BANDS {
        let (sin_polar, cos_polar) = (std::f32::consts::PI * band as f32 / BANDS as f32).sin_cos();
        for segment in 0..=segments {
            let (sin, cos) = (std::f32::consts::TAU * segment as f32 / segments as f32).sin_cos();
            let normal = Vec3::new(sin_polar * cos, cos_polar, -sin_polar * sin);
            vertices.extend((0.5 * normal).to_array());
            vertices.extend(normal.to_array());
        }
    }
    let mut indices = Vec::new();
    let index = |band: u32, segment: u32| (band * (segments + 1) + segment) as u16;
    for band in 0..BANDS {
        for segment in 0..segments {
            let (a, b) = (index(band, segment), index(band + 1, segment));
            let (c, d) = (index(band + 1, segment + 1), index(band, segment + 1));
            if band + 1 < BANDS {
                indices.extend([a, b, c]);
            }
            if band > 0 {
                indices.extend([a, c, d]);
            }
        }
    }
    (vertices, indices)
}

/// Everything that is created once.
struct Scene {
    gl: glow::Context,
    index_count: i32,
}

impl Scene {
    fn new(gl: glow::Context, width: i32, height: i32) -> Result<Self, Box<dyn Error>> {
        let (vertices, indices) = sphere();
        unsafe {
            let colour = gl.create_renderbuffer()?;
            gl.bind_renderbuffer(glow::RENDERBUFFER, Some(colour));
            gl.renderbuffer_storage(glow::RENDERBUFFER, glow::SRGB8_ALPHA8, width, height);
            let depth = gl.create_renderbuffer()?;
            gl.bind_renderbuffer(glow::RENDERBUFFER, Some(depth));
            gl.renderbuffer_storage(glow::RENDERBUFFER, glow::DEPTH_COMPONENT24, width, height);
            let target = gl.create_framebuffer()?;
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(target));
            for (attachment, buffer) in [(glow::COLOR_ATTACHMENT0, colour), (glow::DEPTH_ATTACHMENT, depth)] {
                gl.framebuffer_renderbuffer(glow::FRAMEBUFFER, attachment, glow::RENDERBUFFER, Some(buffer));
            }
            if gl.check_framebuffer_status(glow::FRAMEBUFFER) != glow::FRAMEBUFFER_COMPLETE {
                return Err("the framebuffer is not complete".into());
            }
            gl.viewport(0, 0, width, height);

            let array = gl.create_vertex_array()?;
            gl.bind_vertex_array(Some(array));
            let buffer = gl.create_buffer()?;
            gl.bind_buffer(glow::ARRAY_BUFFER, Some(buffer));
            gl.buffer_data_u8_slice(
                glow::ARRAY_BUFFER,
                &bytes(&vertices, f32::to_ne_bytes),
                glow::STATIC_DRAW,
            );
            let buffer = gl.create_buffer()?;
            gl.bind_buffer(glow::ELEMENT_ARRAY_BUFFER, Some(buffer));
            gl.buffer_data_u8_slice(
                glow::ELEMENT_ARRAY_BUFFER,
                &bytes(&indices, u16::to_ne_bytes),
                glow::STATIC_DRAW,
            );
            for (location, offset) in [(0, 0), (1, 12)] {
                gl.vertex_attrib_pointer_f32(location, 3, glow::FLOAT, false, 24, offset);
                gl.enable_vertex_attrib_array(location);
            }

            let program = program(&gl)?;
            gl.use_program(Some(program));
            let place = |name: &str| gl.get_uniform_location(program, name);
            let model =
                Mat4::from_translation(SPHERE_CENTRE) * Mat4::from_scale(Vec3::splat(SPHERE_DIAMETER));
            let view = Mat4::look_at_rh(EYE, EYE + Vec3::NEG_Z, Vec3::Y);
            let aspect = width as f32 / height as f32;
            let projection = Mat4::perspective_rh_gl(FIELD_OF_VIEW.to_radians(), aspect, 0.1, 100.0);
            gl.uniform_matrix_4_f32_slice(place("model").as_ref(), false, &model.to_cols_array());
            gl.uniform_matrix_4_f32_slice(
                place("view_projection").as_ref(),
                false,
                &(projection * view).to_cols_array(),
            );
            for (name, value) in [
                ("light_position", LIGHT_POSITION),
                ("light_intensity", LIGHT_INTENSITY),
                ("base_colour", BASE_COLOUR),
            ] {
                gl.uniform_3_f32_slice(place(name).as_ref(), &value.to_array());
            }

            gl.enable(glow::DEPTH_TEST);
            gl.enable(glow::CULL_FACE);
            gl.enable(glow::FRAMEBUFFER_SRGB);
            gl.clear_color(BACKGROUND, BACKGROUND, BACKGROUND, 1.0);
        }
        Ok(Self { gl, index_count: indices.len() as i32 })
    }

    /// Draws a frame and waits for it.
    fn draw(&self) {
        unsafe {
            self.gl.clear(glow::COLOR_BUFFER_BIT | glow::DEPTH_BUFFER_BIT);
            self.gl.draw_elements(glow::TRIANGLES, self.index_count, glow::UNSIGNED_SHORT, 0);
            self.gl.finish();
        }
    }

    /// The picture, row by row from the top.
    fn read(&self, width: i32, height: i32) -> Vec<u8> {
        let row = 4 * width as usize;
        let mut rgba = vec![0; row * height as usize];
        unsafe {
            let to = glow::PixelPackData::Slice(Some(&mut rgba));
            self.gl.read_pixels(0, 0, width, height, glow::RGBA, glow::UNSIGNED_BYTE, to);
        }
        rgba.chunks_exact(row)
            .rev()
            .flat_map(|row| row.chunks_exact(4))
            .flat_map(|p| [p[0], p[1], p[2]])
            .collect()
    }
}

fn bytes<T: Copy, const N: usize>(values: &[T], to_bytes: fn(T) -> [u8; N]) -> Vec<u8> {
    values.iter().flat_map(|value| to_bytes(*value)).collect()
}

fn program(gl: &glow::Context) -> Result<glow::Program, Box<dyn Error>> {
    unsafe {
        let program = gl.create_program()?;
        for (stage, source) in [
            (glow::VERTEX_SHADER, include_str!("vertex.glsl")),
            (glow::FRAGMENT_SHADER, include_str!("fragment.glsl")),
        ] {
            let shader = gl.create_shader(stage)?;
            gl.shader_source(shader, source);
            gl.compile_shader(shader);
            if !gl.get_shader_compile_status(shader) {
                return Err(gl.get_shader_info_log(shader).into());
            }
            gl.attach_shader(program, shader);
        }
        gl.link_program(program);
        if !gl.get_program_link_status(program) {
            return Err(gl.get_program_info_log(program).into());
        }
        Ok(program)
    }
}

fn write(file: &str, width: i32, height: i32, rgb: &[u8]) -> Result<(), Box<dyn Error>> {
    let mut encoder = png::Encoder::new(BufWriter::new(File::create(file)?), width as u32, height as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_compression(png::Compression::Fast);
    encoder.write_header()?.write_image_data(rgb)?;
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let (mut file, mut size, mut frames) = ("opengl.png".to_owned(), (1280, 720), 0);
    let mut arguments = std::env::args().skip(1);
    while let Some(name) = arguments.next() {
        let value = arguments.next().ok_or_else(|| format!("{name} needs a value"))?;
        match name.as_str() {
            "-o" => file = value,
            "--size" => {
                let (width, height) = value.split_once('x').ok_or("--size is WIDTHxHEIGHT")?;
                size = (width.parse()?, height.parse()?);
            }
            "--frames" => frames = value.parse()?,
            _ => return Err(format!("unknown option {name}").into()),
        }
    }
    let (width, height) = size;
    let scene = Scene::new(context::create()?, width, height)?;
    scene.draw();
    write(&file, width, height, &scene.read(width, height))?;
    for _ in 0..frames {
        let begin = Instant::now();
        scene.draw();
        println!("{:.4}", begin.elapsed().as_secs_f64() * 1e3);
    }
    Ok(())
}
