//! Helpers of several tests.

use std::{env, error::Error, fs, path::PathBuf, sync::atomic::AtomicBool};

use glam::{Vec3, Vec4};
use lights_camera_models::{
    reference::{self, LightSamples, Settings},
    registry::Registry,
    render::capture::gpu::GpuRenderer,
    scene::{Light, Object, Observer, Scene},
};

use super::support::builtin;

/// The folder that `scripts/pictures` names.
pub fn picture_folder() -> Result<PathBuf, Box<dyn Error>> {
    let folder = env::var_os("LCM_PANEL_PICTURES").ok_or("LCM_PANEL_PICTURES must name a folder")?;
    fs::create_dir_all(&folder)?;
    Ok(folder.into())
}

/// The picture of a scene for a display from the CPU, with so many samples of lights with extent.
pub fn sampled(scene: &Scene, registry: &Registry, settings: &Settings, count: u32) -> Vec<u8> {
    let samples = LightSamples::of(count);
    reference::render_samples(scene, registry, settings, samples, &AtomicBool::default())
        .to_rgb8(&scene.display)
}

/// The picture of a scene from the GPU, in linear light.
pub fn on_gpu(renderer: &mut GpuRenderer, scene: &Scene) -> Vec<Vec3> {
    renderer.set_scene(scene.clone());
    renderer.settle().expect("the GPU draws");
    renderer.read_linear().expect("the picture can be read")
}

/// A scene with one object that fills much of the picture and one light next to the observer.
pub fn close_up(shape: &str, light: &str) -> Scene {
    let registry = builtin();
    // Types from elsewhere are set up by their tests.
    let declaration = registry.light(light).map(|entry| entry.declaration);
    let mut scene = Scene {
        lights: vec![Light {
            light_type: light.to_owned(),
            position: declaration.is_some_and(|d| d.has_position).then_some(Vec3::new(6.6, 6.9, 8.4)),
            direction: declaration.is_some_and(|d| d.has_direction).then_some(Vec3::new(-0.5, -0.55, -1.0)),
            colour: [255, 240, 200],
            intensity: match declaration.map(|d| d.unit) {
                Some("cd") => 9.0,
                // Equivalent to a lamp of about 1000 cd.
                Some("×") => 0.009,
                _ => 0.8,
            },
            ..Light::default()
        }],
        observer: Observer {
            field_of_view: 40.0,
            ..Observer::at(Vec3::new(5.0, 5.2, 8.8), Vec3::new(0.02, -0.05, -1.0))
        },
        objects: vec![Object {
            object_type: shape.to_owned(),
            size: 2.4,
            rotation: Vec3::new(25.0, 35.0, 5.0),
            ..Object::default()
        }],
        ..Scene::default()
    };
    scene.objects[0]
        .material
        .set("base_colour", lights_camera_models::parameter::Value::Colour([220, 120, 60]));
    scene
}

/// The difference of two linear pictures.
#[derive(Debug, Default, Clone, Copy)]
pub struct Difference {
    /// Number of pixels covered by an object in the first picture.
    pub covered: usize,
    /// Number of pixels that differ by more than the tolerance, but are at a silhouette or between their
    /// neighbours: coverage.
    pub edges: usize,
    /// Number of pixels that differ otherwise.
    pub wrong: usize,
    /// The largest relative difference of a pixel that is not an edge.
    pub worst: f32,
}

/// Compares a picture of the GPU with one of the CPU renderer. A pixel agrees if it is within `tolerance`
/// relative (to its value, or to 0.001 where it is darker) beyond the effect, at the local contrast, of half
/// a step of the 1/256-pixel grid to which hardware may or may not snap corners; otherwise it counts as an
/// edge if it has the background next to it or if each channel is between those of its neighbours in the
/// CPU's picture, and else as wrong.
pub fn compare(gpu: &[Vec3], cpu: &reference::Picture, background: Vec3, tolerance: f32) -> Difference {
    let (w, h) = (cpu.width as i32, cpu.height as i32);
    let at = |x: i32, y: i32| {
        let p: Vec4 = cpu.pixels[(y.clamp(0, h - 1) * w + x.clamp(0, w - 1)) as usize];
        p.truncate() + (1.0 - p.w) * background
    };
    let mut difference = Difference::default();
    for y in 0..h {
        for x in 0..w {
            let (g, c) = (gpu[(y * w + x) as usize], at(x, y));
            let covered = cpu.pixels[(y * w + x) as usize].w > 0.0;
            difference.covered += usize::from(covered);
            let (mut low, mut high) = (c, c);
            let mut silhouette = false;
            for (dx, dy) in [(-1, -1), (0, -1), (1, -1), (-1, 0), (1, 0), (-1, 1), (0, 1), (1, 1)] {
                let n = at(x + dx, y + dy);
                let neighbour = (y + dy).clamp(0, h - 1) * w + (x + dx).clamp(0, w - 1);
                silhouette |= (cpu.pixels[neighbour as usize].w > 0.0) != covered;
                low = low.min(n);
                high = high.max(n);
            }
            let grid = (high - low) / 256.0;
            let error = (((g - c).abs() - grid) / c.abs().max(Vec3::splat(1e-3))).max_element().max(0.0);
            if error <= tolerance {
                difference.worst = difference.worst.max(error);
                continue;
            }
            // Colour is evaluated at the pixel's centre even if it is outside the triangle, so at an edge it
            // may overshoot slightly.
            let slack = (high * tolerance + 0.1 * (high - low)).max(Vec3::splat(1e-5));
            if silhouette || (g.cmpge(low - slack).all() && g.cmple(high + slack).all()) {
                difference.edges += 1;
            } else {
                difference.wrong += 1;
                difference.worst = difference.worst.max(error);
            }
        }
    }
    difference
}
