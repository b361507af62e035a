//! Shaders calculate functions of a scene's constants accurately: a driver's `cos` may be off by 2⁻¹¹.

use std::{fs, path::Path};

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

/// `cos_degrees` and `tan_degrees` as the CPU interprets them, in the precision of shaders.
#[test]
fn the_series_of_shaders_are_exact_to_six_digits() {
    use lights_camera_models::shader::{
        check::validate,
        compose::{Composed, OPTICS},
        interpret::Program,
    };
    let text: String = OPTICS[..1].iter().map(|source| source.text).collect();
    let module = validate(&Composed { text, ..Composed::default() }).expect("valid");
    let (cos, tan) =
        ["cos_degrees", "tan_degrees"].map(|f| Program::new(&module, f).expect("it runs")).into();
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
