//! The contact sheet of the documents: every reflection model under a studio, the sky, uniform light and a softbox.

use glam::Vec3;
use lights_camera_models::{
    lettering::Lettering,
    optics::TermSelection,
    picture::png,
    reference::Settings,
    registry::Registry,
    render::capture::gpu::{GpuRenderer, Output},
    scene::{
        Scene,
        load::{self, Defaults},
    },
};

use crate::{
    helpers::pictures::sampled,
    helpers::support::root,
    renderers::golden::{SAME_RENDERER, read_png, updating},
};

const FILE: &str = "docs/images/models_and_lights.png";

/// Width and height of a picture of one model under one light.
const CELL: u32 = 112;
const SETTINGS: Settings = Settings { width: CELL, height: CELL, samples: 4, terms: TermSelection::All };
/// Number of samples of lights, enough for small pictures.
const SAMPLES: u32 = 64;

/// The lights, with the headings of their columns.
const LIGHTS: [(&str, &str); 4] = [
    (
        "studio",
        r#"{ "type": "environment", "source": "studio", "intensity": 0.7, "rotation": 20, "visible": false }"#,
    ),
    (
        "clear sky",
        r#"{ "type": "environment", "source": "sky", "intensity": 1, "sky_type": "12", "sun_elevation": 40,
             "sun_azimuth": 215, "zenith_luminance": 0.09, "ground_reflectance": 0.25, "visible": false }"#,
    ),
    ("uniform", r#"{ "type": "environment", "source": "uniform", "intensity": 0.25, "visible": false }"#),
    (
        "softbox",
        r#"{ "type": "rectangle", "position": [3, 7.2, 8], "direction": [2, -2.2, -3], "width": 3, "height": 2,
             "intensity": 2.4, "visible": false }"#,
    ),
];

/// Number of blocks side by side, and their dimensions: the column of names, the row of lights, the gap
/// between cells.
const BLOCKS: u32 = 2;
const NAMES: u32 = 216;
const HEAD: u32 = 34;
const GAP: u32 = 4;
const TEXT: f32 = 17.0;

const GROUND: [u8; 3] = [24; 3];
const INK: [u8; 3] = [222; 3];

/// The i-th of evenly spaced hues around the circle.
fn colour(i: usize, count: usize) -> [u8; 3] {
    let channel = |shift: f32| {
        let turn = (i as f32 / count as f32 + shift).fract();
        // Up, along the top, down, along the bottom: a sixth of the circle up, two sixths along.
        let height = ((3.0 * turn - 1.5).abs() * 2.0 - 1.0).clamp(0.0, 1.0);
        (80.0 + 140.0 * height) as u8
    };
    [0.0, 2.0 / 3.0, 1.0 / 3.0].map(channel)
}

/// The scenes: for each model its name, and itself under each light.
fn scenes(registry: &Registry) -> Vec<(&'static str, Vec<Scene>)> {
    let models = registry.models();
    let scene = |i: usize, light: &str| {
        let text = format!(
            r#"{{ "scene_size": {{ "height": 10, "width": 10, "depth": 10 }}, "reflection_model": "{}",
                "shading_model": "phong", "lights": [{light}],
                "observer": {{ "position": [5, 5.6, 9.6], "direction": [0, -0.6, -4.6], "field_of_view": 26 }},
                "objects": [{{ "type": "sphere", "position": [5, 5, 5], "size": 2, "tessellation": 64,
                    "material": {{ "base_colour": {:?} }} }}] }}"#,
            models[i].declaration.id,
            colour(i, models.len())
        );
        load::from_text(&text, "sheet.json", registry, Defaults::Use).unwrap_or_else(|e| panic!("{e}")).scene
    };
    let row =
        |i: usize| (models[i].declaration.name, LIGHTS.iter().map(|(_, light)| scene(i, light)).collect());
    (0..models.len()).map(row).collect()
}

/// The sheet of pictures, model by model and light by light: its size and its values.
fn sheet(rows: &[(&str, Vec<Vec<u8>>)]) -> ([u32; 2], Vec<u8>) {
    let each = (rows.len() as u32).div_ceil(BLOCKS);
    let block = NAMES + LIGHTS.len() as u32 * (CELL + GAP);
    let size = [BLOCKS * block, HEAD + each * (CELL + GAP)];
    let mut whole = GROUND.repeat((size[0] * size[1]) as usize);
    let text = Lettering::Regular;
    let lower = (CELL as i32 - text.height(TEXT) as i32) / 2;
    for left in (0..BLOCKS).map(|i| i * block + NAMES) {
        for (light, (name, _)) in (0u32..).zip(LIGHTS) {
            let middle = left + light * (CELL + GAP) + CELL / 2;
            let at = [middle as i32 - text.width(TEXT, name) as i32 / 2, 8];
            Lettering::Semibold.draw(&mut whole, size, at, TEXT, INK, name);
        }
    }
    for (i, (name, pictures)) in (0u32..).zip(rows) {
        let (left, top) = (i / each * block, HEAD + i % each * (CELL + GAP));
        let at = [(left + NAMES) as i32 - 12 - text.width(TEXT, name) as i32, top as i32 + lower];
        text.draw(&mut whole, size, at, TEXT, INK, name);
        for (light, picture) in (0u32..).zip(pictures) {
            for (y, line) in (0u32..).zip(picture.chunks(3 * CELL as usize)) {
                let x = left + NAMES + light * (CELL + GAP);
                let start = 3 * ((top + y) * size[0] + x) as usize;
                whole[start..start + line.len()].copy_from_slice(line);
            }
        }
    }
    (size, whole)
}

#[test]
fn every_model_under_every_kind_of_light_looks_as_the_documents_show() {
    let registry = Registry::builtin();
    let rows: Vec<_> = scenes(&registry)
        .iter()
        .map(|(name, scenes)| {
            (*name, scenes.iter().map(|scene| sampled(scene, &registry, &SETTINGS, SAMPLES)).collect())
        })
        .collect();
    let (size, picture) = sheet(&rows);
    let path = root().join(FILE);
    let agrees = || {
        read_png(&path).is_ok_and(|(width, height, old)| {
            [width, height] == size && SAME_RENDERER.broken(&picture, &old).is_none()
        })
    };
    if updating() && !agrees() {
        png::write(&path, size[0], size[1], &picture, &png::About::default()).expect("it can be written");
    }
    assert!(agrees(), "{FILE} is not what the models look like; accept with LCM_UPDATE=1");
}

/// `cargo test --release --test suite -- --ignored --nocapture contact_sheet` prints what the documents
/// report about both renderers, and writes the sheet of the GPU to `error_output/`.
#[test]
#[ignore = "minutes, with software Vulkan"]
fn the_renderers_draw_the_same_contact_sheet() {
    let registry = Registry::builtin();
    let mut renderer =
        GpuRenderer::new(CELL, CELL, 4, Output::Display).expect("software Vulkan is installed");
    renderer.set_light_samples(SAMPLES);
    let mut rows = Vec::new();
    let (mut beyond, mut largest, mut count) = (0, 0, 0);
    for (name, scenes) in scenes(&registry) {
        let mut pictures = Vec::new();
        for (scene, (light, _)) in scenes.iter().zip(LIGHTS) {
            renderer.set_scene(scene.clone());
            renderer.settle().expect("the GPU draws");
            let gpu = renderer.read_rgb8().expect("the picture can be read");
            let cpu = sampled(scene, &registry, &SETTINGS, SAMPLES);
            let far = |(a, b): (&[u8], &[u8])| (0..3).map(|c| a[c].abs_diff(b[c])).max().unwrap_or(0);
            let all: Vec<u8> = gpu.chunks(3).zip(cpu.chunks(3)).map(far).collect();
            let off = all.iter().filter(|far| **far > 2).count();
            let most = all.iter().copied().max().unwrap_or(0);
            println!(
                "{name}, {light}: {off} of {} pixels differ by more than 2, at most by {most}",
                all.len()
            );
            (beyond, largest, count) = (beyond + off, largest.max(most), count + all.len());
            pictures.push(gpu);
        }
        rows.push((name, pictures));
    }
    println!("{beyond} of {count} pixels differ by more than 2 of 255, at most by {largest}");
    let (size, picture) = sheet(&rows);
    let folder = root().join("error_output");
    std::fs::create_dir_all(&folder).expect("the folder can be made");
    png::write(&folder.join("models_and_lights_gpu.png"), size[0], size[1], &picture, &png::About::default())
        .expect("it can be written");
    assert!(beyond * 1000 <= count, "more than one pixel in a thousand");
}

#[test]
fn the_colours_of_the_sheet_go_around_the_circle() {
    assert_eq!([0, 1, 2].map(|i| colour(i, 3)), [[220, 80, 80], [80, 220, 80], [80, 80, 220]]);
    let far = |a: [u8; 3], b: [u8; 3]| Vec3::from(a.map(f32::from)).distance(Vec3::from(b.map(f32::from)));
    assert!((1..22).all(|i| far(colour(i, 22), colour(i - 1, 22)) > 20.0));
}
