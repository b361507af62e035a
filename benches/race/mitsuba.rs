//! Light with extent in the CPU renderer and in Mitsuba 3 (`llvm_ad_rgb`): the time to an equal relative error at
//! 1280×720, for a sphere in dim surroundings with two small bright softboxes (its `direct` integrator), and for a ball
//! of glass under the sky (`path`, `max_depth` 18).
//! `$LCM_PYTHON` names the Python that has Mitsuba (`pip install mitsuba`); without it the race is skipped,
//! with a message.

use std::{env, fs, path::Path, process::Command, sync::atomic::AtomicBool, time::Instant};

use glam::{Vec3, Vec4};
use lights_camera_models::{
    export::{Progress, Request, form, write::write},
    files::Before,
    optics::colour::luminance,
    parameter::Value,
    reference::{LightSamples, Picture, Settings, render_samples},
    registry::Registry,
    scene::{Light, Object, Observer, Scene},
};

use super::opengl::{median, milliseconds};

/// Relative errors to which both are timed.
const ERRORS: [f64; 2] = [0.044, 0.016];
/// Maximum number of samples per pixel.
const LAST: u32 = 256;
/// Samples of the reference for the lab's errors.
const EXACT: LightSamples = LightSamples { first: 1 << 16, count: 1024 };
/// Distance from the silhouette within which pixels are excluded, as the other program smooths edges.
const EDGE: usize = 3;

pub(super) fn race() {
    let python = env::var("LCM_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let found = Command::new(&python).args(["-c", "import mitsuba, numpy"]).output();
    if !found.is_ok_and(|output| output.status.success()) {
        println!("skipped: Mitsuba 3 is not installed (pip install mitsuba; $LCM_PYTHON names the Python)");
        return;
    }
    let registry = Registry::builtin();
    println!("1280×720, time to the relative error, medians");
    println!("{:<34} {:>10} {:>10} {:>7}", "", "lab", "Mitsuba", "ratio");
    for (name, material, bsdf) in [
        ("GGX, α = 0.3", "microfacet", None),
        ("Disney's model", "disney", Some(PRINCIPLED)),
        ("a ball of glass under the sky", "glass", None),
    ] {
        let mut scene = scene(material, &registry);
        if material == "glass" {
            // The first light is the studio.
            scene.lights.truncate(1);
            scene.lights[0].parameters.set("source", Value::Choice("sky".into()));
        }
        let (ours, inner, mean) = ours(&scene, &registry);
        let (theirs, their_mean) = theirs(&python, &scene, &registry, bsdf, &inner);
        for error in ERRORS {
            match [&ours, &theirs].map(|runs| time_to(error, runs)) {
                [Some(lab), Some(other)] => println!(
                    "{name:<34} {lab:>7.0} ms {other:>7.0} ms {:>7.2}   at {:.1} %",
                    lab / other,
                    100.0 * error
                ),
                _ => println!("{name:<34} {:.1} % was not reached", 100.0 * error),
            }
        }
        for ([lab_time, lab_error], [time, error]) in ours.iter().zip(&theirs) {
            println!(
                "{:<34} {lab_time:>7.0} ms {time:>7.0} ms   errors {:.2} %, {:.2} %",
                "  as many samples",
                100.0 * lab_error,
                100.0 * error
            );
        }
        println!("{:<34} {:>10.4} {:>10.4} {:>7.4}", "  mean luminance", mean, their_mean, mean / their_mean);
    }
}

/// Disney's model in Mitsuba, whose roughness is also √α.
const PRINCIPLED: &str = r#"<bsdf type="principled"><rgb name="base_color" value="0.57758,0.18782,0.04519"/>
<float name="roughness" value="0.5477226"/><float name="specular" value="0.5"/></bsdf>"#;

fn scene(model: &str, registry: &Registry) -> Scene {
    const MIDDLE: Vec3 = Vec3::splat(5.0);
    let light = |kind: &str, intensity: f32| {
        let mut light = Light::default();
        light.set_type(registry.light(kind).expect("built in"), registry, Scene::default().scene_size);
        light.parameters.set("visible", Value::Choice("false".into()));
        Light { intensity, luminous_flux: None, ..light }
    };
    let softbox = |position: Vec3, intensity: f32| {
        let mut softbox = Light {
            position: Some(position),
            direction: Some(MIDDLE - position),
            ..light("rectangle", intensity)
        };
        softbox.parameters.set("width", Value::Number(0.6));
        softbox.parameters.set("height", Value::Number(0.4));
        softbox
    };
    let mut object = Object {
        object_type: "sphere".into(),
        position: MIDDLE,
        size: 4.0,
        tessellation: Some(64),
        ..Object::default()
    };
    let choice = |id: &'static str| Value::Choice(id.into());
    let values = if model == "microfacet" {
        vec![
            ("fresnel", choice("conductor")),
            ("masking", choice("smith_separable")),
            ("diffuse", choice("none")),
            ("distribution", choice("ggx")),
            ("multiple_scattering", choice("none")),
            ("alpha_x", Value::Number(0.3)),
            ("alpha_y", Value::Number(0.3)),
            ("ior", Value::Triple([0.18, 0.42, 1.37])),
            ("extinction", Value::Triple([3.42, 2.35, 1.77])),
        ]
    } else if model == "glass" {
        Vec::new()
    } else {
        vec![("roughness", Value::Number(0.3f32.sqrt())), ("base_colour", Value::Colour([200, 120, 60]))]
    };
    values.into_iter().for_each(|(name, value)| object.material.set(name, value));
    Scene {
        reflection_model: model.into(),
        shading_model: "phong".into(),
        objects: vec![object],
        lights: vec![
            light("environment", 0.1),
            softbox(Vec3::new(7.5, 8.0, 8.5), 60.0),
            softbox(Vec3::new(2.0, 6.5, 7.0), 40.0),
        ],
        observer: Observer {
            position: Vec3::new(5.0, 5.0, 9.9),
            direction: Vec3::NEG_Z,
            field_of_view: 50.0,
        },
        ..Scene::default()
    }
}

/// Milliseconds and relative errors with 1, 4, … samples; the pixels that count, and their mean luminance.
fn ours(scene: &Scene, registry: &Registry) -> (Vec<[f64; 2]>, Vec<bool>, f64) {
    let settings = Settings { samples: 1, ..Settings::default() };
    let odd = AtomicBool::default();
    let draw = |samples| render_samples(scene, registry, &settings, samples, &odd);
    let exact = draw(EXACT);
    let inner = inner(&exact);
    let of = |p: &Vec4| f64::from(luminance(p.truncate()));
    let pixels = || exact.pixels.iter().zip(&inner).filter(|(_, is)| **is).map(|(p, _)| of(p));
    let mean = pixels().sum::<f64>() / pixels().count() as f64;
    let error = |picture: &Picture| {
        let pairs = picture.pixels.iter().zip(&exact.pixels).zip(&inner).filter(|(_, is)| **is);
        let squares: Vec<f64> = pairs.map(|((a, b), _)| (of(a) - of(b)).powi(2)).collect();
        (squares.iter().sum::<f64>() / squares.len() as f64).sqrt() / mean
    };
    let counts = std::iter::successors(Some(1), |n| Some(4 * n)).take_while(|n| *n <= LAST);
    let runs = counts.map(|count| {
        let mut error_there = 0.0;
        let times = (0..if count <= 16 { 9 } else { 3 }).map(|_| {
            let begin = Instant::now();
            let picture = draw(LightSamples::of(count));
            let time = milliseconds(begin);
            error_there = error(&picture);
            time
        });
        [median(times.collect()), error_there]
    });
    (runs.collect(), inner, mean)
}

/// The pixels covered by an object, as are their neighbours.
fn inner(picture: &Picture) -> Vec<bool> {
    let (width, height) = (picture.width as usize, picture.height as usize);
    let covered = |x: usize, y: usize| x < width && y < height && picture.pixels[y * width + x].w == 1.0;
    let all = |x: usize, y: usize| {
        let near = |at: usize| at.saturating_sub(EDGE)..=at + EDGE;
        near(y).all(|y| near(x).all(|x| covered(x, y)))
    };
    (0..width * height).map(|i| all(i % width, i / width)).collect()
}

/// Milliseconds and relative errors of Mitsuba.
fn theirs(
    python: &str,
    scene: &Scene,
    registry: &Registry,
    bsdf: Option<&str>,
    inner: &[bool],
) -> (Vec<[f64; 2]>, f64) {
    let folder = tempfile::tempdir().expect("a folder");
    let place = folder.path().join("scene");
    // Disney's model is not exported; the sphere has one that is, and its text is replaced.
    let exported =
        if bsdf.is_some() { &Scene { reflection_model: "lambert".into(), ..scene.clone() } } else { scene };
    let settings = Settings::default();
    let size = (settings.width, settings.height);
    let request = Request { scene: exported, registry, stem: "scene", size, object: 0, point: None };
    let form = form("mitsuba").expect("listed");
    let export = (form.make)(&request, &Progress::NONE).expect("it can be exported");
    write(&export, &place, &Before::of(&place)).expect("it can be written");
    let file = place.join("scene.xml");
    if let Some(bsdf) = bsdf {
        let text = fs::read_to_string(&file).expect("it was written");
        // The last one is that of the sphere; lamps have one before it.
        let (begin, end) =
            (text.rfind("<bsdf").expect("it has one"), text.rfind("</bsdf>").expect("it ends"));
        fs::write(&file, format!("{}{bsdf}{}", &text[..begin], &text[end + "</bsdf>".len()..]))
            .expect("the same place");
    }
    let mask = folder.path().join("inner");
    fs::write(&mask, inner.iter().map(|is| u8::from(*is)).collect::<Vec<_>>()).expect("a place");
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/race/again.py");
    let output = Command::new(python)
        .arg(script)
        .args([&file, &mask])
        .arg(LAST.to_string())
        .output()
        .expect("Python starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8_lossy(&output.stdout);
    let numbers = |line: &str| -> Vec<f64> { line.split(' ').filter_map(|n| n.parse().ok()).collect() };
    let runs = text.lines().map(numbers).filter(|n| n.len() == 3).map(|n| [n[1], n[2]]).collect();
    let mean =
        text.lines().rev().map(numbers).find_map(|n| <[f64; 1]>::try_from(n).ok()).expect("the last line");
    assert!(mean[0] > 0.0, "Mitsuba's picture is dark");
    (runs, mean[0])
}

/// The time to an error, interpolated between the nearest runs in logarithms; for larger errors than that of
/// the first run, its time.
fn time_to(error: f64, runs: &[[f64; 2]]) -> Option<f64> {
    let first = runs.first().filter(|[_, first]| *first <= error).map(|[time, _]| *time);
    first.or_else(|| {
        let pair = runs.windows(2).find(|pair| pair[1][1] <= error)?;
        let [[t0, e0], [t1, e1]] = [pair[0], pair[1]].map(|run| run.map(f64::ln));
        Some((t0 + (t1 - t0) * (error.ln() - e0) / (e1 - e0)).exp())
    })
}
