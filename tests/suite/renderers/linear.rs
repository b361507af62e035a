//! Linear pictures: the layers are the light, the terms and the lights of the scene, on both renderers, and `lcm render`
//! writes them to OpenEXR and Radiance files that open again.

use std::{collections::BTreeMap, f32::consts::PI, fs, io::Cursor, path::Path, sync::atomic::AtomicBool};

use exr::prelude::{ReadChannels as _, ReadLayers as _};
use glam::{Vec3, Vec4};
use image::{ImageDecoder as _, codecs::hdr::HdrDecoder};
use lights_camera_models::{
    channel::{LayerKind, layers},
    linear::Channels,
    optics::{TermSelection, tone::ToneMapping},
    parameter::Value,
    progress::Progress,
    reference::{self, Picture, Settings, Until, render_layers},
    registry::Registry,
    render::capture::gpu::{GpuRenderer, Output},
    scene::{
        Display, Light, Object, Observer, Scene,
        load::{self, Defaults},
    },
};

use crate::helpers::{
    pictures::{close_up, compare},
    support::{command_in, lcm_in, names, written},
};

const SIZE: u32 = 96;

fn settings(samples: u32) -> Settings {
    Settings { width: SIZE, height: SIZE, samples, ..Settings::default() }
}

/// A sphere under three lights, with exposure and a tone curve, which must not matter.
fn lit() -> Scene {
    let mut scene = close_up("sphere", "point");
    scene.reflection_model = "phong".to_owned();
    scene.shading_model = "phong".to_owned();
    scene.display = Display { exposure: 2.0, tone_mapping: ToneMapping::AgX, ..scene.display };
    let lamp = Light { name: Some("Blue lamp".to_owned()), colour: [40, 80, 255], ..scene.lights[0].clone() };
    let lamp = Light { position: Some(Vec3::new(3.0, 4.0, 9.0)), ..lamp };
    let around =
        Light { light_type: "ambient".to_owned(), position: None, intensity: 0.2, ..Light::default() };
    let dark = Light { enabled: false, ..lamp.clone() };
    scene.lights.extend([dark, lamp, around]);
    scene
}

/// The scene of [`lit`] with a lamp in sight.
fn with_lamp() -> Scene {
    let mut scene = lit();
    let registry = Registry::builtin();
    let mut lamp = Light { position: Some(Vec3::new(5.3, 5.5, 7.0)), ..Light::default() };
    lamp.set_type(registry.light("sphere").expect("built in"), &registry, scene.scene_size);
    lamp.parameters.set("radius", Value::Number(0.15));
    lamp.intensity = 5.0;
    scene.lights.push(lamp);
    scene
}

fn on_cpu(scene: &Scene, kinds: &[LayerKind], samples: u32) -> Channels {
    let registry = Registry::builtin();
    let layers = layers(scene, TermSelection::All, kinds, &registry);
    let (until, odd) = (Until { samples: 16, noise: None }, AtomicBool::default());
    render_layers(&layers, scene, &registry, &settings(samples), until, &odd, &Progress::NONE)
        .expect("nobody cancels")
        .0
}

/// The colours of a layer.
fn colours(channels: &Channels, layer: &str) -> Vec<Vec3> {
    let name =
        |channel: &str| if layer.is_empty() { channel.to_owned() } else { format!("{layer}.{channel}") };
    let [r, g, b] = ["R", "G", "B"].map(|channel| channels.get(&name(channel)).expect(layer));
    r.iter().zip(g).zip(b).map(|((r, g), b)| Vec3::new(*r, *g, *b)).collect()
}

/// The largest difference between a picture and a sum of layers, over the brightest pixel.
fn off(channels: &Channels, layers: &[&str]) -> f32 {
    off_where(channels, layers, |_| true)
}

/// The largest such difference in some of the pixels.
fn off_where(channels: &Channels, layers: &[&str], counts: impl Fn(usize) -> bool) -> f32 {
    let picture = colours(channels, "");
    let mut sum = vec![Vec3::ZERO; picture.len()];
    for layer in layers {
        sum.iter_mut().zip(colours(channels, layer)).for_each(|(sum, colour)| *sum += colour);
    }
    let most = picture.iter().map(|c| c.max_element()).fold(0.0, f32::max);
    assert!(most > 0.1, "the picture is dark");
    let differences = sum.iter().zip(&picture).map(|(a, b)| (*a - *b).abs().max_element()).enumerate();
    differences.filter(|(i, _)| counts(*i)).map(|(_, error)| error).fold(0.0, f32::max) / most
}

const TERMS: [&str; 3] = ["ambient", "diffuse", "specular"];

#[test]
fn the_picture_is_the_sum_of_its_lights_and_of_its_terms() {
    let channels = on_cpu(&lit(), LayerKind::ALL, 4);
    let lights = ["light_1", "light_3_blue_lamp", "light_4"];
    assert!(off(&channels, &lights) < 1e-6, "{}", off(&channels, &lights));
    assert!(off(&channels, &TERMS) < 1e-6, "{}", off(&channels, &TERMS));
    // Wrong twins: without one of them.
    assert!(off(&channels, &lights[..2]) > 0.01 && off(&channels, &TERMS[..2]) > 0.01);
    assert!(channels.get("emission.R").is_none() && channels.get("light_2.R").is_none());
    // Neither exposure nor the tone curve is in it.
    let registry = Registry::builtin();
    let picture = reference::render(&lit(), &registry, &settings(4));
    let plain: Vec<_> = picture.pixels.iter().map(|pixel| pixel.truncate()).collect();
    assert_eq!(colours(&channels, ""), plain);
    let coverage: Vec<_> = picture.pixels.iter().map(|pixel| pixel.w).collect();
    assert_eq!(channels.get("A"), Some(&coverage[..]));
    assert!(coverage.iter().any(|a| ![0.0, 1.0].contains(a)));
    // A layer of a light is the channel of that name.
    let mut alone = lit();
    alone.lights[0].enabled = false;
    alone.lights[3].enabled = false;
    let alone = reference::render(&alone, &registry, &settings(4));
    let alone: Vec<_> = alone.pixels.iter().map(|pixel| pixel.truncate()).collect();
    assert_eq!(colours(&channels, "light_3_blue_lamp"), alone);
}

#[test]
fn a_lamp_in_sight_is_the_emission_beside_the_terms() {
    let channels = on_cpu(&with_lamp(), &[LayerKind::Terms, LayerKind::Lights], 4);
    let all = [&TERMS[..], &["emission"]].concat();
    assert!(off(&channels, &all) < 1e-5, "{}", off(&channels, &all));
    assert!(off(&channels, &TERMS) > 0.1);
    let emission = colours(&channels, "emission");
    // As bright as a white surface whose luminance is that of the lamp.
    let brightest = emission.iter().map(|c| c.max_element()).fold(0.0, f32::max);
    assert!((brightest - 5.0 * PI).abs() < 1e-4, "{brightest}");
    let lights = ["light_1", "light_3_blue_lamp", "light_4", "light_5"];
    // Each light alone has samples of its own, and hides what is behind it in its own layer alone.
    let hides: Vec<bool> = emission.iter().map(|light| *light != Vec3::ZERO).collect();
    let error = off_where(&channels, &lights, |i| !hides[i]);
    assert!(error < 0.05 && off(&channels, &lights) > error, "{error}");
}

#[test]
fn geometry_is_numbers() {
    // A sphere whose nearest point is in the middle of the picture, 3 m away.
    let sphere = Object {
        object_type: "sphere".to_owned(),
        position: Vec3::splat(5.0),
        size: 2.0,
        tessellation: Some(64),
        ..Object::default()
    };
    let observer = Observer { field_of_view: 40.0, ..Observer::at(Vec3::new(5.0, 5.0, 9.0), Vec3::NEG_Z) };
    let scene = Scene { observer, objects: vec![sphere], ..Scene::default() };
    let kinds = [LayerKind::Normals, LayerKind::FaceNormals, LayerKind::Depth];
    let cpu = on_cpu(&scene, &kinds, 4);
    let mut gpu = Channels::new(SIZE, SIZE);
    let mut renderer = renderer();
    let registry = Registry::builtin();
    for layer in layers(&scene, TermSelection::All, &kinds, &registry).into_iter().skip(1) {
        let (picture, odd) = renderer.light(&layer, layer.scene(&scene), 4).expect("it draws");
        assert!(!odd);
        gpu.add(&layer.name, layer.channels, &picture.pixels);
    }
    let near = |a: f32, b: f32, tolerance: f32| (a - b).abs() <= tolerance;
    let middle = (SIZE * SIZE / 2 + SIZE / 2) as usize;
    for channels in [&cpu, &gpu] {
        let get = |name: &str| channels.get(name).expect(name);
        assert!(near(get("depth.Z")[middle], 3.0, 0.01), "{}", get("depth.Z")[middle]);
        assert!(near(get("normals.Z")[middle], 1.0, 1e-3) && near(get("normals.X")[middle], 0.0, 0.05));
        assert_eq!(
            [get("depth.Z")[0], get("normals.X")[0], get("face_normals.Z")[0]],
            [0.0; 3],
            "nothing there"
        );
        let left = middle - 15;
        assert!(get("normals.X")[left] < -0.3 && get("depth.Z")[left] > 3.02);
        for i in (0..get("depth.Z").len()).filter(|i| get("depth.Z")[*i] > 0.0) {
            for layer in ["normals", "face_normals"] {
                let length = ["X", "Y", "Z"].map(|axis| get(&format!("{layer}.{axis}"))[i]);
                assert!(near(Vec3::from_array(length).length(), 1.0, 1e-3), "{layer}: {length:?}");
            }
        }
    }
    // Both renderers agree but for a few pixels at the edge.
    for name in ["normals.X", "normals.Y", "normals.Z", "face_normals.Y", "depth.Z"] {
        let (a, b) = (cpu.get(name).expect(name), gpu.get(name).expect(name));
        let wrong = a.iter().zip(b).filter(|(a, b)| !near(**a, **b, 2e-3)).count();
        assert!(wrong < 40, "{name}: {wrong} pixels differ");
    }
}

fn renderer() -> GpuRenderer {
    GpuRenderer::new(SIZE, SIZE, 1, Output::Linear).expect("software Vulkan is installed")
}

/// Layers by the GPU renderer, by name.
fn on_gpu(scene: &Scene, kinds: &[LayerKind], samples: u32) -> BTreeMap<String, Picture> {
    let registry = Registry::builtin();
    let mut renderer = renderer();
    let layers = layers(scene, TermSelection::All, kinds, &registry);
    let drawn = layers.iter().map(|layer| {
        let scene = layer.scene(scene);
        (layer.name.clone(), renderer.light(layer, scene, samples).expect("it draws").0)
    });
    drawn.collect()
}

#[test]
fn both_renderers_draw_the_same_light_and_the_same_layers() {
    for (scene, kinds) in [(lit(), LayerKind::ALL), (with_lamp(), &[LayerKind::Terms][..])] {
        let registry = Registry::builtin();
        let gpu = on_gpu(&scene, kinds, 1);
        for layer in layers(&scene, TermSelection::All, kinds, &registry) {
            let shown = layer.scene(&scene);
            let settings = Settings { terms: layer.terms, ..settings(1) };
            let cpu = match layer.is_of_geometry() {
                true => reference::render_numbers(&shown, &registry, &settings, &layer.setting),
                false => reference::render(&shown, &registry, &settings),
            };
            let gpu = &gpu[&layer.name];
            let light: Vec<_> = gpu.pixels.iter().map(|pixel| pixel.truncate()).collect();
            // Light with extent has the noise of its samples' rounding.
            let difference = compare(&light, &cpu, Vec3::ZERO, 2e-3);
            let case = format!("{}: {difference:?}", layer.name);
            assert!(difference.covered > 500 || layer.name == "emission", "{case}");
            assert!(
                difference.wrong * 200 <= difference.covered && difference.edges * 20 <= difference.covered,
                "{case}"
            );
            let covers = |picture: &Picture| picture.pixels.iter().filter(|pixel| pixel.w > 0.0).count();
            assert!(covers(gpu).abs_diff(covers(&cpu)) < 40, "{case}");
        }
    }
}

#[test]
fn four_samples_on_the_gpu_are_the_standard_ones_and_nothing_is_cut_off() {
    let mut scene = lit();
    // Far beyond half floats.
    scene.lights[0].intensity = 1e7;
    let gpu = &on_gpu(&scene, &[], 4)[""];
    let cpu = reference::render(&scene, &Registry::builtin(), &settings(4));
    let most = |picture: &Picture| picture.pixels.iter().map(|p| p.max_element()).fold(0.0, f32::max);
    assert!(most(gpu) > 1e5 && (most(gpu) / most(&cpu) - 1.0).abs() < 0.05, "{} {}", most(gpu), most(&cpu));
    let edges = |picture: &Picture| picture.pixels.iter().filter(|p| ![0.0, 1.0].contains(&p.w)).count();
    assert!(edges(gpu) > 50 && edges(gpu).abs_diff(edges(&cpu)) < 20, "{} {}", edges(gpu), edges(&cpu));
    let coverage = |a: &Vec4, b: &Vec4| (a.w - b.w).abs() > 0.3;
    let moved = gpu.pixels.iter().zip(&cpu.pixels).filter(|(a, b)| coverage(a, b)).count();
    assert!(moved < 10, "{moved} pixels have another coverage");
    // The wrong twin: one sample at the centre.
    let one = &on_gpu(&scene, &[], 1)[""];
    assert_eq!(edges(one), 0);
    assert_eq!(on_gpu(&scene, &[], 4)[""].pixels, gpu.pixels, "the same again");
}

/// The channels of an OpenEXR file.
pub fn read_exr(path: &Path) -> BTreeMap<String, Vec<f32>> {
    let read = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .all_layers()
        .all_attributes()
        .from_buffered(Cursor::new(fs::read(path).expect("there")))
        .expect("an OpenEXR file");
    let [layer] = &read.layer_data[..] else { panic!("one part") };
    let channels = layer.channel_data.list.iter();
    channels
        .map(|channel| (channel.name.to_string(), channel.sample_data.values_as_f32().collect()))
        .collect()
}

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let put =
        |name: &str, scene: &Scene| fs::write(folder.path().join(name), written(scene)).expect("written");
    put("lit.json", &Scene { name: Some("Größe".to_owned()), ..lit() });
    put("lamp.json", &with_lamp());
    let two = lights_camera_models::scene::Variant::default();
    let mut views = Scene { variants: vec![two], ..lit() };
    views.comparison.layout = lights_camera_models::scene::comparison::Layout::SideBySide;
    put("views.json", &views);
    folder
}

/// Draws a small picture; returns the messages.
fn render(folder: &Path, arguments: &[&str]) -> (Option<i32>, String) {
    let usual = ["render", "--size", "96x96", "--light-samples", "16"];
    let run = lcm_in(folder, &[&usual, arguments].concat(), b"");
    assert_eq!(run.out, "");
    (run.status, run.err)
}

#[test]
fn files_hold_the_light_and_open_as_the_scene() {
    let folder = folder();
    let at = |name: &str| folder.path().join(name);
    let (status, said) = render(folder.path(), &["lit.json", "-o", "a.exr", "--layers", "all"]);
    assert!(status == Some(0) && said.contains("wrote a.exr"), "{said}");
    let file = read_exr(&at("a.exr"));
    let channels = on_cpu(&lit(), LayerKind::ALL, 4);
    let mut names: Vec<_> = channels.names().map(str::to_owned).collect();
    names.sort();
    assert_eq!(file.keys().cloned().collect::<Vec<_>>(), names);
    for (name, numbers) in &file {
        assert_eq!(Some(&numbers[..]), channels.get(name), "{name}");
    }
    // The same bytes again, and on a single thread.
    assert_eq!(render(folder.path(), &["lit.json", "-o", "b.exr", "--layers", "all"]).0, Some(0));
    let arguments =
        ["render", "lit.json", "--size", "96x96", "-o", "c.exr", "--layers", "all", "--renderer", "cpu"];
    let alone = command_in(folder.path(), arguments).env("RAYON_NUM_THREADS", "1").output().expect("it runs");
    assert!(alone.status.success());
    let bytes = fs::read(at("a.exr")).expect("there");
    assert!(bytes == fs::read(at("b.exr")).expect("there") && bytes == fs::read(at("c.exr")).expect("there"));
    // Radiance has steps of at most 1/128 of the brightest channel.
    assert_eq!(render(folder.path(), &["lit.json", "-o", "a.hdr"]).0, Some(0));
    let decoder =
        HdrDecoder::new(Cursor::new(fs::read(at("a.hdr")).expect("there"))).expect("a Radiance file");
    assert_eq!(decoder.dimensions(), (SIZE, SIZE));
    let mut read = vec![0; 12 * (SIZE * SIZE) as usize];
    decoder.read_image(&mut read).expect("whole");
    let numbers: Vec<_> = read.as_chunks::<4>().0.iter().map(|bytes| f32::from_ne_bytes(*bytes)).collect();
    for (read, right) in numbers.as_chunks::<3>().0.iter().zip(colours(&channels, "")) {
        let wrong = (Vec3::from_array(*read) - right).abs().max_element();
        assert!(wrong <= right.max_element() / 127.0, "{read:?} {right}");
    }
    let scene = load::file(&at("lit.json"), &Registry::builtin(), Defaults::Refuse).expect("valid").scene;
    for name in ["a.exr", "a.hdr"] {
        let back = load::file(&at(name), &Registry::builtin(), Defaults::Refuse).expect("has a scene").scene;
        assert_eq!(back, scene, "{name}");
        let checked = lcm_in(folder.path(), &["check", name], b"");
        assert_eq!(checked.status, Some(0), "{}", checked.err);
        let said = render(folder.path(), &[name, "-o", "again.exr", "--no-scene"]);
        assert_eq!(said.0, Some(0), "{}", said.1);
        let again = read_exr(&at("again.exr"));
        assert!(["R", "G", "B", "A"].iter().all(|channel| again[*channel] == file[*channel]), "{name}");
        let none = lcm_in(folder.path(), &["check", "again.exr"], b"");
        assert!(
            none.status == Some(1) && none.err.contains("there is no scene in this picture"),
            "{}",
            none.err
        );
        let own = render(folder.path(), &[name, "-o", name]);
        assert!(own.0 == Some(4) && own.1.contains("is read by this command"), "{}", own.1);
    }
}

#[test]
fn the_renderer_that_is_asked_for_draws_and_says_so() {
    let folder = folder();
    let at = |name: &str| folder.path().join(name);
    let arguments = ["lit.json", "-o", "gpu.exr", "--layers", "depth,lights", "--renderer", "gpu"];
    let run = lcm_in(folder.path(), &[&["render", "--size", "96x96"], &arguments[..]].concat(), b"");
    assert_eq!(run.status, Some(0), "{}", run.err);
    let (gpu, cpu) = (read_exr(&at("gpu.exr")), on_cpu(&lit(), LayerKind::ALL, 4));
    assert!(gpu.contains_key("depth.Z") && gpu.contains_key("light_4.G") && !gpu.contains_key("normals.X"));
    let sum = |numbers: &[f32]| numbers.iter().map(|n| f64::from(*n)).sum::<f64>();
    for (name, numbers) in &gpu {
        let (a, b) = (sum(numbers), sum(cpu.get(name).expect(name)));
        assert!((a / b - 1.0).abs() < 5e-3 || (a - b).abs() < 1e-9, "{name}: {a} {b}");
    }
    let has = |file: &str, text: &str| {
        let bytes = fs::read(at(file)).expect("there");
        bytes.windows(text.len()).any(|part| part == text.as_bytes())
    };
    assert!(has("gpu.exr", "Renderer: GPU"));
    assert_eq!(render(folder.path(), &["lamp.json", "-o", "cpu.exr"]).0, Some(0));
    assert!(has("cpu.exr", "Renderer: CPU") && has("cpu.exr", "Light: 16 samples of each light"));
}

#[test]
fn what_a_linear_picture_cannot_hold_is_refused_with_what_would_be_right() {
    let folder = folder();
    fs::write(folder.path().join("notes.exr"), "notes").expect("written");
    let before = names(folder.path());
    let many = |layers: &'static str| ["lit.json", "-o", "x.exr", "--size", "8000x8000", "--layers", layers];
    for (arguments, status, expected) in [
        (&["lit.json", "-o", "x.exr", "--layers", "depths"][..], 2, "did you mean depth?"),
        (
            &["lit.json", "-o", "x.exr", "--layers", ""],
            2,
            "each layer must be normals, face_normals, depth, terms",
        ),
        (
            &["lit.json", "-o", "x.png", "--layers", "depth"],
            2,
            "--layers needs an OpenEXR file, e.g. -o room.exr",
        ),
        (&["lit.json", "--layers", "depth"], 2, "--layers needs an OpenEXR file"),
        (&["lit.json", "-o", "x.hdr", "--layers", "depth"], 2, "x.hdr cannot hold --layers; -o x.exr can"),
        (
            &["lit.json", "-o", "x.exr", "--channel", "depth"],
            2,
            "--channel draws display codes, but x.exr holds light; use -o x.png, or --layers normals",
        ),
        (
            &["lit.json", "-o", "x.hdr", "--caption"],
            2,
            "--caption draws display codes, but x.hdr holds light",
        ),
        (&["lit.json", "lamp.json", "-o", "x.exr"], 2, "-o x.exr is one file, but there are 2 scenes"),
        (&["lit.json", "-o", "x.exr", "--size", "9000x9000"], 2, "more pixels than x.exr can hold"),
        (
            &many("all"),
            1,
            "lit.json: x.exr: 29 channels of 8000×8000 pixels take 7080 MiB, but a file has at most",
        ),
        (
            &["views.json", "-o", "x.exr"],
            1,
            "views.json: x.exr holds the light of one view, but the scene shows 2; --view A draws one alone",
        ),
        (
            &["lit.json", "-o", "notes.exr"],
            4,
            "notes.exr exists and is not an OpenEXR file; it was not overwritten",
        ),
        (&["lit.json", "-o", "x.tiff"], 2, "only PNG, OpenEXR and Radiance files can be written"),
    ] {
        let run = lcm_in(folder.path(), &[&["render"], arguments].concat(), b"");
        assert!(run.status == Some(status) && run.err.contains(expected), "{arguments:?}: {}", run.err);
    }
    assert_eq!(names(folder.path()), before);
    assert_eq!(render(folder.path(), &["views.json", "-o", "b.exr", "--view", "B"]).0, Some(0));
    assert_eq!(
        render(folder.path(), &["lit.json", "-o", "d.exr", "--term", "diffuse", "--layers", "terms"]).0,
        Some(0)
    );
    let file = read_exr(&folder.path().join("d.exr"));
    assert!(file["R"] == file["diffuse.R"] && !file.contains_key("ambient.R"));
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_leaves_the_old_file_and_nothing_else() {
    let folder = folder();
    let at = |name: &str| folder.path().join(name);
    std::os::unix::fs::symlink("/dev/full", at("full.exr")).expect("linked");
    let (status, said) = render(folder.path(), &["lit.json", "-o", "full.exr"]);
    assert!(status == Some(4) && said.contains("full.exr could not be written: "), "{said}");
    assert_eq!(render(folder.path(), &["lit.json", "-o", "old.exr"]).0, Some(0));
    let (old, before) = (fs::read(at("old.exr")).expect("there"), names(folder.path()));
    // A file that may not grow is like a disk that is full.
    let lcm = command_in(folder.path(), ["render", "lit.json", "-o", "old.exr", "--layers", "all"]);
    let mut shell = std::process::Command::new("sh");
    shell
        .args(["-c", "trap '' XFSZ; ulimit -f 64; exec \"$@\"", "sh"])
        .arg(lcm.get_program())
        .args(lcm.get_args());
    let ended = shell.current_dir(folder.path()).env("LCM_DATA_DIR", at("none")).output().expect("it runs");
    assert_eq!(ended.status.code(), Some(4), "{}", String::from_utf8_lossy(&ended.stderr));
    assert!(fs::read(at("old.exr")).expect("there") == old);
    assert_eq!(names(folder.path()), before);
}
