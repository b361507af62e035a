//! Tables written from known models.

use std::fmt::Write as _;

use glam::Vec3;

use super::{
    FORMAT, MAX_SAMPLES,
    read::{plastic, stations},
};
use crate::{
    optics::{
        geometry::direction,
        half_difference::{Grid, angles},
    },
    testing::{direction as any_direction, random},
};

/// A table of a BRDF at the stations.
fn written(brdf: impl Fn(Vec3, Vec3) -> Vec3) -> String {
    let mut text = "# calculated\ntheta_i,phi_i,theta_o,phi_o,r,g,b\n".to_owned();
    for [theta_i, phi_i, theta_o, phi_o] in stations() {
        let Vec3 { x, y, z } = brdf(direction(theta_i, phi_i), direction(theta_o, phi_o));
        let _ = writeln!(text, "{theta_i},{phi_i},{theta_o},{phi_o},{x},{y},{z}");
    }
    text
}

fn numbers(text: &str) -> Vec<f32> {
    (FORMAT.read)(text.as_bytes()).unwrap_or_else(|problem| panic!("{problem:?}"))
}

fn at(numbers: &[f32], l: Vec3, v: Vec3) -> Vec3 {
    Grid::new(numbers).expect("a table").value(angles(l, v, Vec3::Z))
}

#[test]
fn samples_of_known_models_are_interpolated() {
    let paper = numbers(&written(|_, _| Vec3::new(0.3, 0.2, 0.1)));
    let shiny = numbers(&written(plastic));
    let mut seed = 4;
    let (mut sum, mut wrong, mut count) = (0.0f32, 0.0f32, 0.0f32);
    for _ in 0..2000 {
        let l = any_direction(&mut seed);
        let near = Vec3::new(-l.x, -l.y, l.z) + 0.4 * random(&mut seed) * any_direction(&mut seed);
        let v = near.normalize();
        // Constant samples are constant between and beyond them.
        assert!((at(&paper, l, v) - Vec3::new(0.3, 0.2, 0.1)).abs().max_element() < 4e-4, "{l} {v}");
        if l.z.min(v.z) > 0.5 {
            let expected = plastic(l, v);
            sum += ((at(&shiny, l, v) - expected) / expected).abs().max_element();
            // The wrong twin: the viewer on the side of the light.
            let other = Vec3::new(-v.x, -v.y, v.z);
            wrong += ((at(&shiny, l, other) - expected) / expected).abs().max_element();
            count += 1.0;
        }
    }
    // The samples are 10° to 15° apart, about the width of the lobe.
    assert!(sum / count < 0.15, "{}", sum / count);
    assert!(wrong > 2.0 * sum, "{wrong} {sum}");
}

#[test]
fn where_there_are_no_samples_the_table_says_so_and_the_uncertainty_is_kept() {
    let table = "theta_i;phi_i;theta_o;phi_o;value;sigma\n0;0;10;0;0.5;0.05\n0;0;20;0;0.4;0.04\n0;0;30;0;0.3;-0\n10;0;10;0;-1;0\n";
    let old = numbers(&format!("\u{feff}{}", table.replace('\n', "\r")));
    let numbers = numbers(table);
    assert!(old.iter().map(|n| n.to_bits()).eq(numbers.iter().map(|n| n.to_bits())), "old line ends");
    let grid = Grid::new(&numbers).expect("a table");
    assert!((grid.note() - 0.09 / 1.2).abs() < 1e-4, "{}", grid.note());
    assert!(grid.missing() > 7000, "{}", grid.missing());
    let near = at(&numbers, Vec3::Z, direction(20.0, 0.0)).x;
    assert!((0.33..0.47).contains(&near), "{near}");
    let far = at(&numbers, direction(80.0, 0.0), direction(80.0, 180.0)).x;
    assert!((0.3..=0.5).contains(&far), "a mean of what there is: {far}");
}

#[test]
fn what_is_no_table_is_refused_with_line_and_reason() {
    let said = |text: &str| {
        let problem = (FORMAT.read)(text.as_bytes()).expect_err(text);
        (problem.line, problem.message)
    };
    let head = "theta_i,phi_i,theta_o,phi_o,value\n";
    for (text, line, message) in [
        (String::new(), None, "it is empty; the first line must have the names of the columns"),
        ("a,b\n".into(), Some(1), "there is no column \"a\""),
        ("theta_i,phi_i,value\n".into(), Some(1), "the first line lacks theta_o and phi_o"),
        ("theta_i,theta_i,value\n".into(), Some(1), "the column theta_i is there twice"),
        (
            "theta_i,phi_i,theta_o,phi_o,r,g\n".into(),
            Some(1),
            "the values must be in one column, value, or in three",
        ),
        (format!("{head}1,2,3\n"), Some(2), "it has 3 cells, but there are 5 columns"),
        (format!("# remark\n\n{head}1,2,3,4,x\n"), Some(4), "value must be a number, not \"x\""),
        (format!("{head}1,2,3,4,NaN\n"), Some(2), "value must be a number, not \"NaN\""),
        (format!("{head}90,2,3,4,1\n"), Some(2), "theta_i is 90, but must be at least 0 and less than 90"),
        (format!("{head}1,2,-3,4,1\n"), Some(2), "theta_o is -3, but must be"),
        (format!("{head}1,2,3,4,-1\n"), None, "it has no sample with a value of 0 or more"),
        (head.to_owned(), None, "it has no sample with a value of 0 or more"),
        (
            "theta_i,phi_i,theta_o,phi_o,value,sigma\n1,2,3,4,1,-1\n".into(),
            Some(2),
            "sigma is -1, but must be at least 0",
        ),
        (
            head.to_owned() + &"1,2,3,4,1\n".repeat(MAX_SAMPLES + 1),
            Some(MAX_SAMPLES + 2),
            "it has more than 10000 samples",
        ),
    ] {
        let (at, found) = said(&text);
        assert!(at == line && found.starts_with(message), "{at:?} {found}\n{message}");
    }
    assert!((FORMAT.read)(b"\xff\xfe").is_err());
}
