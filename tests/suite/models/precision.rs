//! Shaders calculate functions of a scene's constants accurately: a driver's `cos` may be off by 2⁻¹¹.

use std::{fs, path::Path};

use glam::Vec3;
use lights_camera_models::{
    optics::{colour::Encoding, radiometry},
    parameter::{Value, Values},
    registry::Registry,
    shader::{
        check::validate,
        compose::{Composed, OPTICS},
        interpret::Program,
    },
};

use crate::helpers::support::root;

/// The lines that take a driver's trigonometric function of an angle in degrees. Angles in degrees are
/// parameters, and so constant.
fn inexact(text: &str) -> Vec<&str> {
    let functions = ["sin(radians(", "cos(radians(", "tan(radians("];
    text.lines().filter(|line| functions.iter().any(|f| line.contains(f))).collect()
}

fn look(folder: &Path, seen: &mut usize) {
    for entry in fs::read_dir(folder).expect("readable") {
        let path = entry.expect("readable").path();
        if path.is_dir() {
            look(&path, seen);
        } else if path.extension().is_some_and(|e| e == "wgsl") {
            let text = fs::read_to_string(&path).expect("readable");
            assert_eq!(
                inexact(&text),
                Vec::<&str>::new(),
                "{}: use cos_degrees or tan_degrees",
                path.display()
            );
            *seen += 1;
        }
    }
}

#[test]
fn no_shader_takes_a_drivers_cosine_of_a_parameter() {
    let mut seen = 0;
    look(&root().join("assets/shaders"), &mut seen);
    assert!(seen > 30, "{seen}");
    assert_eq!(inexact("let a = 1;\nlet b = cos(radians(m.cone_angle));").len(), 1);
}

#[test]
fn lights_send_what_is_the_same_in_every_pixel() {
    let folder = root().join("assets/shaders/light");
    let mut seen = 0;
    for entry in fs::read_dir(folder).expect("readable") {
        let path = entry.expect("readable").path();
        let text = fs::read_to_string(&path).expect("readable");
        let angles = ["radians(", "_degrees("].map(|function| text.contains(function));
        assert_eq!(angles, [false; 2], "{}: declare the number as DERIVED", path.display());
        seen += 1;
    }
    assert!(seen > 10, "{seen}");
    // 1 − cos 9°, which a driver's cosine may miss by 4 %.
    let registry = Registry::builtin();
    let spot = registry.light("spot").expect("built in");
    let values = Values([("cone_angle".into(), Value::Number(9.0))].into());
    let words = spot.words(&values, Encoding::default());
    let at = spot.fields().iter().position(|field| field.name == "outer_rise").expect("derived");
    let sent = f64::from(f32::from_bits(words[at]));
    assert!((sent / (1.0 - 9_f64.to_radians().cos()) - 1.0).abs() < 1e-6, "{sent}");
}

/// A function of the shaders' first file as the CPU interprets it, in the precision of shaders.
fn shader_function(name: &str) -> Program {
    let text: String = OPTICS[..1].iter().map(|source| source.text).collect();
    let module = validate(&Composed { text, ..Composed::default() }).expect("valid");
    Program::new(&module, name).expect("it runs")
}

#[test]
fn narrow_cones_of_shaders_fade_as_those_of_the_cpu_renderer_do() {
    let cone = shader_function("cone");
    let axis = Vec3::new(0.3, -0.8, 0.52).normalize();
    let across = axis.any_orthonormal_vector();
    for cone_angle in [0.01_f32, 0.1, 0.5, 5.0, 30.0, 90.0] {
        let edges = radiometry::cone_edges(cone_angle, 0.1);
        for step in 0..=100 {
            let angle = (cone_angle * (0.85 + 0.002 * step as f32)).to_radians();
            let ray = axis * angle.cos() + across * angle.sin();
            let arguments = [axis.to_array(), ray.to_array()].concat();
            let words: Vec<_> = arguments.iter().chain(&edges.to_array()).map(|v| v.to_bits()).collect();
            let mut result = [0];
            cone.run(&words, &mut result).expect("no loops");
            let (found, expected) = (f32::from_bits(result[0]), radiometry::cone(axis, ray, edges));
            assert!((found - expected).abs() < 1e-4, "{cone_angle}°, step {step}: {found} and {expected}");
        }
    }
}

#[test]
fn the_series_of_shaders_are_exact_to_six_digits() {
    let (cos, tan) = ["cos_degrees", "tan_degrees"].map(shader_function).into();
    for step in 0..=9000 {
        let angle = step as f32 / 100.0;
        let expected = f64::from(angle).to_radians();
        let mut both = [0; 2];
        cos.run(&[angle.to_bits(), (0.5 * angle).to_bits()], &mut both).expect("no loops");
        let [whole, half] = both.map(|word| f64::from(f32::from_bits(word)));
        assert!((whole - expected.cos()).abs() < 3e-7, "cos {angle}°: {whole}");
        assert!((half - (0.5 * expected).cos()).abs() < 3e-7, "cos {}°: {half}", 0.5 * angle);
        let mut one = [0];
        tan.run(&[angle.to_bits()], &mut one).expect("no loops");
        let found = f64::from(f32::from_bits(one[0]));
        assert!(
            angle > 80.0 || (found / expected.tan().max(1e-30) - 1.0).abs() < 3e-6 || step == 0,
            "tan {angle}°: {found}"
        );
    }
}
