//! Compares `assets/shaders/hierarchy.wgsl` with its twin in Rust.

use std::{ops::Range, time::Duration};

use bevy::render::{
    render_resource::{
        BindGroupEntries, BindGroupLayoutEntries, BufferInitDescriptor, BufferUsages,
        CommandEncoderDescriptor, ShaderStages,
        binding_types::{storage_buffer_read_only_sized, storage_buffer_sized},
    },
    settings::RenderResources,
};
use glam::{EulerRot, Mat3, Vec3};

use super::gpu::{device, read_back, vector};
use crate::{
    optics::interior::Interior,
    reference::inside::{Entry, Normals, Solid, follow},
    render::pass::{Compute, buffer},
    shader::{
        Source,
        check::validate,
        compose::{Composed, HIERARCHY, INSIDE, OPTICS},
        wgsl,
    },
    shape::{
        Cube, Hierarchy, MeshFile, ObjectType as _, PolygonMesh, Sphere, Superellipsoid, Teapot, Torus,
        hierarchy::{Hit, LEVELS, Ray, Row, STACK, Sides},
    },
    testing::{direction, random},
};

const REFRACTION: Source = wgsl!("optics/refraction.wgsl");
const ABSORPTION: Source = wgsl!("optics/absorption.wgsl");

/// A ray, the range of its distances, and the sides.
type Question = (Ray, Range<f32>, Sides);

/// Met or not, the distance, from inside or not, the point, the vertex normal and the normal of the triangle.
#[derive(Clone, Copy, Debug)]
struct Answer {
    met: bool,
    leaves: bool,
    distance: f32,
    vectors: [Vec3; 3],
}

impl Answer {
    const BYTES: usize = 64;

    fn of(hierarchy: &Hierarchy, hit: Option<Hit>) -> Self {
        match hit {
            Some(Hit { distance, weights, triangle, leaves }) => Self {
                met: true,
                leaves,
                distance,
                vectors: [
                    hierarchy.point(triangle, weights),
                    hierarchy.vertex_normal(triangle, weights),
                    hierarchy.triangle_normal(triangle),
                ],
            },
            None => Self { met: false, leaves: false, distance: 0.0, vectors: [Vec3::ZERO; 3] },
        }
    }

    fn read(bytes: &[u8]) -> Self {
        let word = |at: usize| u32::from_le_bytes([0, 1, 2, 3].map(|i| bytes[at + i]));
        Self {
            met: word(0) != 0,
            leaves: word(4) != 0,
            distance: f32::from_bits(word(8)),
            vectors: [16, 32, 48].map(|at| vector(&bytes[at..])),
        }
    }
}

const ROWS: &str = "
@group(0) @binding(0) var<storage, read> hierarchy_rows: array<vec4<u32>>;

fn hierarchy_row(i: u32) -> vec4<u32> {
    return hierarchy_rows[i];
}
";

const NEAREST: &str = "
struct Question {
    origin: vec3<f32>,
    least: f32,
    direction: vec3<f32>,
    most: f32,
    base: u32,
    only_inside: u32,
    unused_0: u32,
    unused_1: u32,
}

struct Answer {
    met: u32,
    leaves: u32,
    distance: f32,
    unused: u32,
    point: vec3<f32>,
    normal: vec3<f32>,
    triangle_normal: vec3<f32>,
}

@group(0) @binding(1) var<storage, read> questions: array<Question>;
@group(0) @binding(2) var<storage, read_write> answers: array<Answer>;

@compute @workgroup_size(64)
fn ask(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&questions) {
        return;
    }
    let q = questions[id.x];
    let ray = MeshRay(q.origin, q.direction);
    let hit = hierarchy_nearest(q.base, ray, q.least, q.most, q.only_inside != 0u);
    answers[id.x] = Answer(0u, 0u, 0.0, 0u, vec3(0.0), vec3(0.0), vec3(0.0));
    if hit.met != 0u {
        answers[id.x] = Answer(1u, hit.leaves, hit.distance, 0u, hierarchy_point(q.base, hit),
            hierarchy_vertex_normal(q.base, hit), hierarchy_triangle_normal(q.base, hit.triangle));
    }
}
";

/// Words as a shader reads them.
fn bytes_of(words: impl IntoIterator<Item = u32>) -> Vec<u8> {
    words.into_iter().flat_map(u32::to_le_bytes).collect()
}

/// The answers of a shader to questions, each of so many bytes, about hierarchies in one buffer.
fn on_gpu(sources: &[&str], rows: &[Row], questions: &[u8], count: usize, answer: usize) -> Vec<u8> {
    let text: String = sources.concat();
    if let Err(problem) = validate(&Composed { text: text.clone(), ..Composed::default() }) {
        panic!("{problem}");
    }
    let RenderResources(device, queue, ..) = device().expect("software Vulkan is installed");
    let read = storage_buffer_read_only_sized(false, None);
    let entries = (read, read, storage_buffer_sized(false, None));
    let entries = BindGroupLayoutEntries::sequential(ShaderStages::COMPUTE, entries);
    let pass = Compute::new(&device, "traversal", text.into(), "ask", &entries);
    let filled = |contents: &[u8]| {
        let usage = BufferUsages::STORAGE;
        device.create_buffer_with_data(&BufferInitDescriptor { label: None, contents, usage })
    };
    let rows = filled(&bytes_of(rows.iter().flatten().copied()));
    let asked = filled(questions);
    let size = (count * answer) as u64;
    let empty = |usage| buffer(&device, "answers", size, usage);
    let output = empty(BufferUsages::STORAGE | BufferUsages::COPY_SRC);
    let staging = empty(BufferUsages::COPY_DST | BufferUsages::MAP_READ);
    let [rows, asked, to] = [&rows, &asked, &output].map(|buffer| buffer.as_entire_buffer_binding());
    let mut encoder = device.create_command_encoder(&CommandEncoderDescriptor { label: None });
    let groups = count.div_ceil(64) as u32;
    pass.run(&device, &mut encoder, &BindGroupEntries::sequential((rows, asked, to)), groups);
    encoder.copy_buffer_to_buffer(&output, 0, &staging, 0, size);
    queue.submit([encoder.finish()]);
    read_back(&device, &staging, Duration::from_secs(60)).expect("the answers can be read")
}

/// The answers to rays in one of several hierarchies, which begins at a row.
fn nearest_on_gpu(rows: &[Row], base: u32, questions: &[Question]) -> Vec<Answer> {
    let words = questions.iter().flat_map(|(ray, range, sides)| {
        let [o, d] = [ray.origin, ray.direction].map(|v| v.to_array().map(f32::to_bits));
        let inside = u32::from(*sides == Sides::Inside);
        let [least, most] = [range.start, range.end].map(f32::to_bits);
        [o[0], o[1], o[2], least, d[0], d[1], d[2], most, base, inside, 0, 0]
    });
    let sources = [OPTICS[0].text, HIERARCHY.text, ROWS, NEAREST];
    let bytes = on_gpu(&sources, rows, &bytes_of(words), questions.len(), Answer::BYTES);
    bytes.chunks_exact(Answer::BYTES).map(Answer::read).collect()
}

/// Rays from anywhere around a mesh, and from its surface inwards.
fn questions(hierarchy: &Hierarchy, seed: &mut u64) -> Vec<Question> {
    let count = hierarchy.triangle_count() as f32;
    (0..1500)
        .map(|i| {
            let towards = direction(seed) * if i % 2 == 0 { 1.0 } else { -1.0 };
            if i % 3 == 0 {
                let triangle = (random(seed) * count) as u32;
                let origin = hierarchy.point(triangle, Vec3::new(0.2, 0.3, 0.5));
                let direction = towards - 1.5 * hierarchy.triangle_normal(triangle);
                return (Ray { origin, direction }, -1e-5..9.0, Sides::Inside);
            }
            let mut place = || Vec3::from([(); 3].map(|()| 2.0 * random(seed) - 1.0));
            let origin = place();
            let towards = (0.35 * place() - origin).normalize();
            let sides = if i % 3 == 1 { Sides::Both } else { Sides::Inside };
            (Ray { origin, direction: towards }, 0.0..if i % 5 == 0 { 0.8 } else { 9.0 }, sides)
        })
        .collect()
}

fn compare(rows: &[Row], base: usize, hierarchy: &Hierarchy, seed: &mut u64) {
    let questions = questions(hierarchy, seed);
    let (mut met, mut edges) = (0, 0);
    for (question, gpu) in questions.iter().zip(nearest_on_gpu(rows, base as u32, &questions)) {
        let (ray, range, sides) = question.clone();
        let cpu = Answer::of(hierarchy, hierarchy.nearest(&ray, range, sides));
        met += usize::from(cpu.met);
        let off = |(a, b): (Vec3, Vec3)| a.distance(b);
        let [point, normal, flat] = [0, 1, 2].map(|i| off((gpu.vectors[i], cpu.vectors[i])));
        let close = (gpu.distance - cpu.distance).abs() < 2e-5 && point < 2e-5;
        // At an edge, either triangle.
        let same = (gpu.met, gpu.leaves) == (cpu.met, cpu.leaves) && close && normal < 1e-3 && flat < 1e-3;
        edges += usize::from(!same);
        assert!(same || edges < 4, "{question:?}: GPU {gpu:?}, CPU {cpu:?}");
    }
    assert!(met > 600, "hardly anything is met: {met}");
}

#[test]
fn the_gpu_meets_the_same_triangles() {
    let edgy = Superellipsoid { vertical_exponent: 0.1, horizontal_exponent: 2.5 };
    let meshes: [PolygonMesh; 6] = [
        Cube {}.mesh(1),
        Sphere {}.mesh(24),
        Torus::default().mesh(20),
        edgy.mesh(16),
        Teapot {}.mesh(4),
        MeshFile::default().mesh(1),
    ];
    let all: Vec<_> = meshes.iter().map(Hierarchy::new).collect();
    let rows: Vec<Row> = all.iter().flat_map(|h| h.rows()).copied().collect();
    let (mut seed, mut base) = (4, 0);
    for hierarchy in &all {
        compare(&rows, base, hierarchy, &mut seed);
        base += hierarchy.rows().len();
    }
}

#[test]
fn the_stack_of_the_shader_is_as_long_as_the_hierarchy_is_deep() {
    assert!(HIERARCHY.text.contains(&format!("const HIERARCHY_STACK: u32 = {STACK}u;")));
    assert_eq!(STACK, 3 * LEVELS + 1);
}

/// The way within a solid: the sums of the parts that leave, of their directions and of their places, each weighted by
/// the part in red; and the part that remains.
const WAY: &str = "
struct Question {
    position: vec3<f32>,
    view: vec3<f32>,
    normal: vec3<f32>,
    face_normal: vec3<f32>,
    solid: Solid,
    sigma: vec3<f32>,
    ior: f32,
}

@group(0) @binding(1) var<storage, read> questions: array<Question>;
@group(0) @binding(2) var<storage, read_write> answers: array<array<vec4<f32>, 4>>;

var<private> parts: vec3<f32>;
var<private> directions: vec3<f32>;
var<private> places: vec3<f32>;

fn leaves_solid(position: vec3<f32>, direction: vec3<f32>, part: vec3<f32>) {
    parts += part;
    directions += part.x * direction;
    places += part.x * position;
}

@compute @workgroup_size(64)
fn ask(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&questions) {
        return;
    }
    let q = questions[id.x];
    let rest = follow_inside(q.solid, q.ior, q.sigma, q.position, q.view, q.normal, q.face_normal);
    answers[id.x] =
        array<vec4<f32>, 4>(vec4(parts, 0.0), vec4(directions, 0.0), vec4(places, 0.0), vec4(rest, 0.0));
}
";

/// A question as the shader reads it: vectors and columns of matrices take four words.
fn way_words(solid: &Solid, interior: &Interior, entry: &Entry) -> Vec<u32> {
    let wide = |v: Vec3| v.extend(0.0).to_array();
    let Entry { position, view, normal, face_normal } = *entry;
    let turn = solid.rotation;
    let vectors = [position, view, normal, face_normal, turn.x_axis, turn.y_axis, turn.z_axis];
    let mut words: Vec<u32> = vectors.into_iter().flat_map(wide).map(f32::to_bits).collect();
    words.extend(solid.position.to_array().map(f32::to_bits));
    words.extend([solid.size.to_bits(), 0, u32::from(solid.normals == Normals::Polygons), 0, 0]);
    words.extend(interior.absorption.extend(interior.ior).to_array().map(f32::to_bits));
    words
}

/// Entries into a solid at random from outside.
fn entries(solid: &Solid, seed: &mut u64) -> Vec<Entry> {
    let count = solid.hierarchy.triangle_count() as f32;
    let entry = |seed: &mut u64| {
        let triangle = (random(seed) * count) as u32;
        let weights = Vec3::new(0.21, 0.33, 0.46);
        let normal = solid.hierarchy.vertex_normal(triangle, weights);
        let face_normal = solid.hierarchy.triangle_normal(triangle);
        let view = (direction(seed) - 0.5 + 1.2 * face_normal).normalize();
        let position =
            solid.rotation * (solid.size * solid.hierarchy.point(triangle, weights)) + solid.position;
        let [view, normal, face_normal] = [view, normal, face_normal].map(|v| solid.rotation * v);
        Entry { position, view, normal, face_normal }
    };
    let seen = |entry: &Entry| entry.view.dot(entry.face_normal) > 0.0;
    (0..1000).map(|_| entry(seed)).filter(seen).collect()
}

/// The sums by the Rust function.
fn way(solid: &Solid, interior: &Interior, entry: &Entry) -> [Vec3; 4] {
    let mut sums = [Vec3::ZERO; 4];
    sums[3] = follow(solid, interior, entry, |place, direction, part| {
        for (sum, more) in sums.iter_mut().zip([part, part.x * direction, part.x * place]) {
            *sum += more;
        }
    });
    sums
}

#[test]
fn the_gpu_follows_the_same_way_within_a_solid() {
    let sigma = Vec3::new(0.1, 0.0, 0.9);
    let glass = Interior { ior: 1.5, cauchy_b: 0.0, alpha: 0.0, absorption: sigma };
    let mut seed = 12;
    for (mesh, normals) in [
        (Sphere {}.mesh(32), Normals::Vertices),
        (Cube {}.mesh(2), Normals::Polygons),
        (Torus::default().mesh(20), Normals::Vertices),
    ] {
        let hierarchy = Hierarchy::new(&mesh);
        let rotation = Mat3::from_euler(EulerRot::ZYX, 0.4, 1.0, -2.0);
        let position = Vec3::new(0.3, -0.2, 1.0);
        let solid = Solid { hierarchy: &hierarchy, normals, rotation, size: 1.7, position };
        for ior in [1.5, 1.15, 1.0, 0.8] {
            let interior = Interior { ior, ..glass };
            let entries = entries(&solid, &mut seed);
            let words = entries.iter().flat_map(|entry| way_words(&solid, &interior, entry));
            let vocabulary =
                [OPTICS[0], OPTICS[1], REFRACTION, ABSORPTION, HIERARCHY, INSIDE].map(|s| s.text);
            let sources = [&vocabulary[..], &[ROWS, WAY]].concat();
            let bytes = on_gpu(&sources, hierarchy.rows(), &bytes_of(words), entries.len(), 64);
            let (mut apart, mut light) = (0, 0.0);
            for (entry, gpu) in entries.iter().zip(bytes.chunks_exact(64)) {
                let gpu: [Vec3; 4] = [0, 16, 32, 48].map(|at| vector(&gpu[at..]));
                let cpu = way(&solid, &interior, entry);
                light += cpu[0].y;
                // A ray near an edge, or near the angle of total reflection, may go another way.
                apart += usize::from(gpu.iter().zip(cpu).any(|(g, c)| (*g - c).abs().max_element() > 5e-3));
                assert!(apart * 50 <= entries.len(), "{normals:?} {ior} {entry:?}: GPU {gpu:?}, CPU {cpu:?}");
            }
            assert!(entries.len() > 500 && light > 0.3 * entries.len() as f32, "{ior}: {light}");
        }
    }
}
