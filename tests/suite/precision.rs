//! Shaders calculate functions of a scene's constants exactly: a driver's `cos` may be off by 2⁻¹¹.

use std::{fs, path::Path};

use crate::support::root;

/// The lines that take a driver's trigonometric function of an angle in degrees. Angles in degrees are parameters, and so
/// constant.
fn inexact(text: &str) -> Vec<&str> {
    let functions = ["sin(radians(", "cos(radians(", "tan(radians("];
    // `exact_sin` is of terms.wgsl.
    text.lines().filter(|line| functions.iter().any(|f| line.replace("exact_sin(", "").contains(f))).collect()
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

/// The series of `exact_sin` in `terms.wgsl`, in the precision of shaders.
#[test]
fn the_series_of_shaders_is_exact_to_six_digits() {
    let text = fs::read_to_string(root().join("assets/shaders/terms.wgsl")).expect("readable");
    for line in [
        "let tail = 1.0 - s / 72.0 * (1.0 - s / 110.0 * (1.0 - s / 156.0));",
        "return x * (1.0 - s / 6.0 * (1.0 - s / 20.0 * (1.0 - s / 42.0 * tail)));",
        "let half = exact_sin(radians(0.5 * angle));",
        "return 1.0 - 2.0 * half * half;",
    ] {
        assert!(text.contains(line), "the same series here and there: {line}");
    }
    let exact_sin = |x: f32| {
        let s = x * x;
        let tail = 1.0 - s / 72.0 * (1.0 - s / 110.0 * (1.0 - s / 156.0));
        x * (1.0 - s / 6.0 * (1.0 - s / 20.0 * (1.0 - s / 42.0 * tail)))
    };
    for step in 0..=9000 {
        let angle = step as f32 / 100.0;
        let half = exact_sin((0.5 * angle).to_radians());
        let (cos, sin) = (1.0 - 2.0 * half * half, exact_sin(angle.to_radians()));
        let expected = f64::from(angle).to_radians();
        assert!((f64::from(cos) - expected.cos()).abs() < 3e-7, "cos {angle}°: {cos}");
        assert!((f64::from(sin) - expected.sin()).abs() < 3e-7, "sin {angle}°: {sin}");
    }
}
