//! The driver's own time for ten thousand spheres: a frame of the lab, alternating with a bare draw of the
//! same triangles from the same position, whose vertex shader is one matrix and whose pixels are white.
//! Medians of one run, waiting for each frame, with one sample and with four.

mod spheres;

use std::time::Instant;

use bevy::render::renderer::{RenderDevice, RenderQueue};
use lights_camera_models::render::capture::gpu::{GpuRenderer, Output};
use spheres::{Bare, SIZE, assert_drawn, grid};

const ROUNDS: usize = 5;

fn main() {
    println!("{:<44} {:>9} {:>9} {:>6}", "10 000 spheres, 1280×720, medians", "lab", "bare", "ratio");
    for (lights, what) in [(1, "one light"), (256, "256 lights")] {
        for samples in [1, 4] {
            let scene = grid(lights);
            let mut lab =
                GpuRenderer::new(SIZE.0, SIZE.1, samples, Output::Display).expect("a Vulkan driver");
            lab.set_scene(scene.clone());
            lab.settle().expect("the GPU draws");
            let world = lab.app().world();
            let (device, queue) =
                (world.resource::<RenderDevice>().clone(), world.resource::<RenderQueue>().clone());
            let bare = Bare::new(device, queue, &scene, SHADER, u32::from(samples));
            let mut times = [Vec::new(), Vec::new()];
            for _ in 0..ROUNDS {
                times[0].push(timed(|| {
                    lab.step();
                    lab.wait();
                }));
                times[1].push(timed(|| bare.draw(u64::MAX, true)));
            }
            assert_drawn(&lab.read_rgb8().expect("the picture can be read"), 3);
            bare.check();
            let [lab, bare] = times.map(|mut times| {
                times.sort_by(f64::total_cmp);
                times[times.len() / 2]
            });
            let what = format!("{what}, samples: {samples}");
            println!("{what:<44} {lab:>6.0} ms {bare:>6.0} ms {:>6.2}", lab / bare);
        }
    }
}

fn timed(work: impl FnOnce()) -> f64 {
    let begin = Instant::now();
    work();
    begin.elapsed().as_secs_f64() * 1e3
}

const SHADER: &str = "
@group(0) @binding(0) var<uniform> clip_from_world: mat4x4<f32>;
@vertex fn vertex(@location(0) vertex: vec3<f32>, @location(2) place: vec4<f32>) -> @builtin(position) vec4<f32> {
    return clip_from_world * vec4(place.xyz + place.w * vertex, 1.0);
}
@fragment fn fragment() -> @location(0) vec4<f32> { return vec4(1.0); }
";
