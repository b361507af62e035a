//! The shipped scenes are both examples and golden tests: each is valid, has a description, and looks like
//! its accepted picture in `tests/golden/`, with either renderer.

use std::{error::Error, fs, io::BufReader, path::Path};

use glam::Vec3;
use lights_camera_models::{
    optics::{TermSelection, tone::ToneMapping},
    picture::png,
    reference,
    registry::Registry,
    render::capture::gpu::{GpuRenderer, Output},
    scene::{
        Background, Display, Scene, check,
        load::{self, Defaults},
        save,
        schema::FILE_NAME,
        variant::LETTERS,
    },
};

use crate::{
    helpers::pictures::sampled,
    helpers::support::{builtin, root, shipped_scenes},
};

const WIDTH: u32 = 192;
const HEIGHT: u32 = 108;

/// The allowed difference between two pictures.
#[derive(Clone, Copy, Debug)]
pub struct Bound {
    /// Values that differ by at most this many levels agree.
    levels: u8,
    /// The fraction of values that may disagree.
    fraction: f64,
}

/// Between CPUs: compilers and libraries round sines and powers differently in the last bits, which can move a value by
/// a level and, seldom, a silhouette by a sample: room for ten such pixels.
pub const SAME_RENDERER: Bound = Bound { levels: 2, fraction: 0.0005 };

/// Between the renderers: they round independently, and snapping corners to a grid sometimes moves a sample of a
/// silhouette, which at this size, with much silhouette per picture, affects up to three pixels in a hundred.
const OTHER_RENDERER: Bound = Bound { levels: 2, fraction: 0.03 };

impl Bound {
    /// The fraction of values that disagree, if it is too large.
    pub fn broken(self, a: &[u8], b: &[u8]) -> Option<f64> {
        if a.len() != b.len() {
            return Some(1.0);
        }
        let off = a.iter().zip(b).filter(|(a, b)| a.abs_diff(**b) > self.levels).count();
        let fraction = off as f64 / a.len() as f64;
        (fraction > self.fraction).then_some(fraction)
    }
}

/// The shipped scenes with the names of their files.
fn scenes() -> Vec<(String, Scene)> {
    let registry = Registry::builtin();
    let read = |path: &Path| match load::file(path, &registry, Defaults::Refuse) {
        Ok(loaded) => loaded.scene,
        Err(error) => panic!("{error}"),
    };
    let name = |path: &Path| path.file_stem().unwrap().to_string_lossy().into_owned();
    shipped_scenes().iter().map(|path| (name(path), read(path))).collect()
}

/// The pictures of the shipped scenes: one for each view, with the letter of the view appended to the name
/// from B on.
fn views() -> Vec<(String, Scene)> {
    let registry = Registry::builtin();
    let mut all = Vec::new();
    for (name, scene) in scenes() {
        for (view, letter) in LETTERS.into_iter().enumerate().take(1 + scene.variants.len()) {
            let (seen, terms) = scene.seen(view, &registry).expect("it has this view");
            assert_eq!(terms, TermSelection::All, "{name}: the pictures here show all terms");
            let name = if view == 0 { name.clone() } else { format!("{name}_{}", letter.to_lowercase()) };
            all.push((name, seen));
        }
    }
    all
}

/// A colour in place of sky and sun, and a gradient behind lamps that are near: both are beyond the tone curve.
fn backgrounds() -> Vec<(String, Scene)> {
    let with = |file: &str, background: Background, tone_mapping: ToneMapping| {
        let (_, mut scene) = scenes().into_iter().find(|(name, _)| name == file).expect("shipped");
        let (background_colour, background_bottom) = ([250, 244, 226], [70, 96, 140]);
        scene.display =
            Display { background, background_colour, background_bottom, tone_mapping, ..scene.display };
        scene
    };
    vec![
        ("background_colour".to_owned(), with("under_the_sky", Background::Colour, ToneMapping::Aces)),
        (
            "background_gradient".to_owned(),
            with("softbox_and_lamps", Background::Gradient, ToneMapping::KhronosPbrNeutral),
        ),
    ]
}

const SETTINGS: reference::Settings =
    reference::Settings { width: WIDTH, height: HEIGHT, samples: 4, terms: TermSelection::All };

/// Samples of lights with extent: both renderers take the same number, and software Vulkan is slow.
const LIGHT_SAMPLES: u32 = 8;

fn on_cpu(scene: &Scene) -> Vec<u8> {
    sampled(scene, &builtin(), &SETTINGS, LIGHT_SAMPLES)
}

pub fn updating() -> bool {
    std::env::var_os("LCM_UPDATE").is_some()
}

/// Reads an 8-bit RGB picture: width, height, values.
pub fn read_png(path: &Path) -> Result<(u32, u32, Vec<u8>), Box<dyn Error>> {
    let mut reader = ::png::Decoder::new(BufReader::new(fs::File::open(path)?)).read_info()?;
    let mut rgb8 = vec![0; reader.output_buffer_size().ok_or("too large")?];
    let info = reader.next_frame(&mut rgb8)?;
    if (info.color_type, info.bit_depth) != (::png::ColorType::Rgb, ::png::BitDepth::Eight) {
        return Err("it is not 8-bit RGB".into());
    }
    rgb8.truncate(info.buffer_size());
    Ok((info.width, info.height, rgb8))
}

/// The golden picture of a scene.
fn golden(name: &str) -> Vec<u8> {
    let path = root().join(format!("tests/golden/{name}.png"));
    let how = "look at the new picture, and if it is right, accept it with LCM_UPDATE=1 scripts/test";
    let (width, height, rgb8) =
        read_png(&path).unwrap_or_else(|e| panic!("{} cannot be read ({e}); {how}", path.display()));
    assert_eq!((width, height), (WIDTH, HEIGHT), "{}; {how}", path.display());
    rgb8
}

/// Writes the picture and the amplified difference, for visual inspection.
fn keep(name: &str, actual: &[u8], expected: &[u8]) {
    let folder = root().join("error_output");
    fs::create_dir_all(&folder).expect("the folder can be made");
    let difference: Vec<u8> =
        actual.iter().zip(expected).map(|(a, b)| a.abs_diff(*b).saturating_mul(16)).collect();
    for (what, picture) in [("actual", actual), ("difference", &difference[..])] {
        let path = folder.join(format!("{name}_{what}.png"));
        png::write(&path, WIDTH, HEIGHT, picture, &png::About::default())
            .expect("the picture can be written");
    }
}

/// Compares pictures with the golden ones and lists the differing ones.
fn assert_golden(pictures: &[(String, Vec<u8>)], renderer: &str, bound: Bound) {
    let mut report = Vec::new();
    for (name, actual) in pictures {
        let expected = golden(name);
        if let Some(fraction) = bound.broken(actual, &expected) {
            keep(&format!("{name}_{renderer}"), actual, &expected);
            report.push(format!("{name}: {:.2} % of the values differ", 100.0 * fraction));
        }
    }
    assert!(
        report.is_empty(),
        "on the {renderer} (see error_output/; accept right pictures with LCM_UPDATE=1):\n{}",
        report.join("\n")
    );
}

#[test]
fn shipped_scenes_look_as_accepted_on_the_cpu() {
    let scenes = views().into_iter().chain(backgrounds());
    let pictures: Vec<_> = scenes.map(|(name, scene)| (name, on_cpu(&scene))).collect();
    if updating() {
        fs::create_dir_all(root().join("tests/golden")).expect("the folder can be made");
        for (name, picture) in &pictures {
            let path = root().join(format!("tests/golden/{name}.png"));
            // A picture that still agrees is not written again.
            let agrees = read_png(&path).is_ok_and(|(w, h, old)| {
                (w, h) == (WIDTH, HEIGHT) && SAME_RENDERER.broken(picture, &old).is_none()
            });
            if !agrees {
                png::write(&path, WIDTH, HEIGHT, picture, &png::About::default())
                    .expect("the picture can be written");
            }
        }
    }
    assert_golden(&pictures, "cpu", SAME_RENDERER);
}

#[test]
fn shipped_scenes_look_as_accepted_on_the_gpu() {
    if updating() {
        // The other test is writing them.
        return;
    }
    let mut renderer =
        GpuRenderer::new(WIDTH, HEIGHT, 4, Output::Display).expect("software Vulkan is installed");
    renderer.set_light_samples(LIGHT_SAMPLES);
    let pictures: Vec<_> = views()
        .into_iter()
        .chain(backgrounds())
        .map(|(name, scene)| {
            renderer.set_scene(scene);
            renderer.settle().expect("the GPU draws");
            (name, renderer.read_rgb8().expect("the picture can be read"))
        })
        .collect();
    assert_golden(&pictures, "gpu", OTHER_RENDERER);
}

#[test]
fn the_comparison_notices_one_light_changed() {
    // The noise is equal in both.
    let drawn = |scene: &Scene| sampled(scene, &builtin(), &SETTINGS, 16);
    for (name, mut scene) in scenes() {
        let right = drawn(&scene);
        assert_eq!(SAME_RENDERER.broken(&right, &right), None);
        // One of the middle: the outer ones of many may be outside the picture.
        let count = scene.lights.len();
        let (before, after) = scene.lights.split_at_mut((count / 2 + 2) % count);
        let mut lights = after.iter_mut().chain(before);
        // The sun itself is no more than a pixel.
        let moves = |l: &&mut lights_camera_models::scene::Light| {
            l.light_type != "sun" && (l.position.is_some() || l.direction.is_some())
        };
        match lights.find(moves) {
            Some(light) => {
                light.position.iter_mut().for_each(|p| p.y += 2.0);
                light.direction.iter_mut().for_each(|d| *d += Vec3::new(0.1, -0.1, 0.0));
            }
            // Uniform light cannot be moved.
            None => scene.lights.iter_mut().for_each(|l| l.intensity *= 0.95),
        }
        let wrong = drawn(&scene);
        assert!(SAME_RENDERER.broken(&wrong, &right).is_some(), "{name}: a changed light goes unnoticed");
    }
}

#[test]
fn shipped_scenes_are_valid_and_say_what_they_show() {
    for (name, scene) in scenes() {
        assert_eq!(check::scene(&scene, &Registry::builtin()), [], "{name}");
        for (what, text) in [("name", &scene.name), ("description", &scene.description)] {
            let text = text.as_deref().unwrap_or_default();
            assert!(!text.is_empty() && !text.contains('\n'), "{name} needs a {what} of one line");
        }
        let unnamed = scene.objects.iter().filter(|o| o.name.is_none()).count();
        assert!(unnamed == 0 || scene.objects.len() == 1, "{name}: {unnamed} objects have no name");
    }
}

#[test]
fn shipped_scenes_are_written_as_the_program_writes_them() {
    let reference = format!("./{FILE_NAME}");
    for (path, (_, scene)) in shipped_scenes().iter().zip(scenes()) {
        let expected = save::to_json(&scene, Some(&reference), &Registry::builtin());
        let mut shipped = fs::read_to_string(path).expect("readable");
        if updating() && shipped != expected {
            // In one step: other tests are reading the scenes.
            let beside = path.with_extension("new");
            fs::write(&beside, &expected).and_then(|()| fs::rename(&beside, path)).expect("written");
            shipped.clone_from(&expected);
        }
        assert!(
            shipped == expected,
            "{} is laid out otherwise; run the tests once with LCM_UPDATE=1",
            path.display()
        );
    }
}

#[test]
fn the_matrix_shows_every_model_in_every_shading_model() {
    let (_, scene) = scenes().into_iter().find(|(name, _)| name == "model_matrix").expect("shipped");
    let registry = Registry::builtin();
    // The scene is a web page, too, which holds no measurements.
    for model in registry.models().iter().filter(|model| model.file().is_none()) {
        for shading in registry.shading_models() {
            let (model, shading) = (model.declaration.id, shading.declaration.id);
            let shown = scene.objects.iter().any(|o| {
                o.reflection_model.as_deref() == Some(model) && o.shading_model.as_deref() == Some(shading)
            });
            assert!(shown, "scenes/model_matrix.json lacks {model} with {shading} shading");
        }
    }
}
