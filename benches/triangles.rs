//! The driver's own time for many triangles: a picture of ten thousand spheres of the default tessellation,
//! 1280×720, four samples, by the two renderers of `lcm render`, and drawn bare in the same batches: the vertex
//! shader is one matrix, and the colours of pixels are interpolated from the vertices.
//!
//! Without the `--bench` of `cargo bench`, the program in `target/release/deps` draws each picture once: so
//! `/usr/bin/time triangles-… 'bare, each'` shows processor time and memory.

mod spheres;

use std::{hint::black_box, time::Duration};

use bevy::{
    render::{renderer::initialize_renderer, settings::RenderResources},
    tasks::block_on,
};
use criterion::{Criterion, SamplingMode, criterion_group, criterion_main};
use lights_camera_models::{
    reference::{Settings, render_rgb8},
    registry::Registry,
    render::{
        capture::gpu::{GpuRenderer, Output, find_adapter, wgpu_settings},
        meshes::PICTURE_TRIANGLES,
    },
    scene::Scene,
};
use spheres::{Bare, SIZE, assert_drawn, grid};

const SAMPLES: u8 = 4;
const SHADER: &str = "
struct Corner {
    @builtin(position) position: vec4<f32>,
    @location(0) colour: vec3<f32>,
}
@group(0) @binding(0) var<uniform> clip_from_world: mat4x4<f32>;
@vertex fn vertex(
    @location(0) corner: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) place: vec4<f32>,
) -> Corner {
    return Corner(clip_from_world * vec4(place.xyz + place.w * corner, 1.0), 0.5 + 0.5 * normal);
}
@fragment fn fragment(@location(0) colour: vec3<f32>) -> @location(0) vec4<f32> { return vec4(colour, 1.0); }
";

/// The renderer of `lcm render --renderer gpu`.
fn renderer(scene: &Scene) -> GpuRenderer {
    let mut renderer =
        GpuRenderer::new(SIZE.0, SIZE.1, SAMPLES, Output::Display).expect("there is an adapter");
    renderer.save_memory();
    renderer.set_scene(scene.clone());
    renderer
}

/// On a device of its own, so that a process that draws nothing else does not start the lab.
fn bare(scene: &Scene) -> Bare {
    let settings = wgpu_settings();
    let backends = settings.backends.expect("the lab chooses them");
    let RenderResources(device, queue, ..) = block_on(initialize_renderer(backends, None, &settings));
    Bare::new(device, queue, scene, SHADER, u32::from(SAMPLES))
}

fn pictures(criterion: &mut Criterion) {
    let scene = grid(1);
    let mut group = criterion.benchmark_group("10 000 spheres, 1280x720, 4 samples");
    group.sample_size(10).sampling_mode(SamplingMode::Flat);
    group.warm_up_time(Duration::from_secs(1)).measurement_time(Duration::from_secs(5));
    // Nothing is prepared that the filter of the command line leaves out.
    match find_adapter() {
        Err(why) => println!("skipped, except for the CPU renderer: {why}"),
        Ok(adapter) => {
            println!("{}", adapter.name);
            let mut lab: Option<GpuRenderer> = None;
            group.bench_function("GPU renderer", |b| {
                let lab = lab.get_or_insert_with(|| renderer(&scene));
                b.iter(|| {
                    lab.settle().expect("the GPU draws");
                    lab.wait();
                });
            });
            if let Some(mut lab) = lab {
                assert_drawn(&lab.read_rgb8().expect("the picture can be read"), 3);
            }
            for (name, each) in
                [("bare, each batch waited for", true), ("bare, the last batch waited for", false)]
            {
                let mut drawn: Option<Bare> = None;
                group.bench_function(name, |b| {
                    let bare = drawn.get_or_insert_with(|| bare(&scene));
                    b.iter(|| bare.draw(PICTURE_TRIANGLES, each));
                });
                drawn.iter().for_each(Bare::check);
            }
        }
    }
    let registry = Registry::builtin();
    let settings =
        Settings { width: SIZE.0, height: SIZE.1, samples: u32::from(SAMPLES), ..Settings::default() };
    group.bench_function("CPU renderer", |b| {
        b.iter(|| render_rgb8(black_box(&scene), &registry, &settings));
    });
    group.finish();
}

criterion_group!(benches, pictures);
criterion_main!(benches);
