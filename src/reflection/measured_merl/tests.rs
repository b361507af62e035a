//! Files written from known models.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::{DVec3, Vec3};

use super::{COUNTS, FORMAT, MeasuredMerl, SCALES, example::table};
use crate::{
    optics::{
        Frame,
        geometry::direction,
        half_difference::{Grid, angles, directions, middles},
    },
    parameter::{ParameterSet as _, Values},
    reflection::{ReflectionModel as _, brdf},
    testing::{direction as any_direction, random},
};

/// The header of a file.
fn header(counts: [i32; 3]) -> Vec<u8> {
    counts.iter().flat_map(|count| count.to_le_bytes()).collect()
}

/// A file with a value for each colour at the angles in the middles of its bins, in sr⁻¹; negative ones are written as they
/// are.
fn file(value: impl Fn([f32; 3]) -> [f64; 3], scales: [f64; 3]) -> Vec<u8> {
    let mut bytes = header([90, 90, 180]);
    let values: Vec<[f64; 3]> = middles(COUNTS).map(value).collect();
    for colour in 0..3 {
        bytes.extend(values.iter().flat_map(|value| (value[colour] / scales[colour]).to_le_bytes()));
    }
    bytes
}

/// A file of a BRDF, with −1 for directions below the surface.
fn of_brdf(brdf: impl Fn(Vec3, Vec3) -> Vec3) -> Vec<u8> {
    let value = |angles| {
        let (l, v) = directions(angles);
        if l.z > 0.0 && v.z > 0.0 { brdf(l, v).to_array().map(f64::from) } else { [-1.0; 3] }
    };
    file(value, SCALES)
}

/// GGX with masking, as a metal.
fn metal(l: Vec3, v: Vec3) -> Vec3 {
    let [l, v] = [l, v].map(|d| d.as_dvec3());
    let (alpha, h) = (0.2f64.powi(2), (l + v).normalize());
    let q = (1.0 - h.z * h.z) / alpha + h.z * h.z;
    let lambda = |d: DVec3| (d.z * d.z + alpha * (1.0 - d.z * d.z)).sqrt();
    let visible = 0.5 / (l.z * lambda(v) + v.z * lambda(l));
    let weight = (1.0 - l.dot(h)).powi(5);
    let f = DVec3::new(0.9, 0.6, 0.3) * (1.0 - weight) + weight;
    (f * visible / (PI * alpha * q * q)).as_vec3()
}

/// The largest relative difference between a table and a BRDF for directions up to 75° from the normal, half of them near the
/// mirror direction.
fn difference(value: impl Fn(Vec3, Vec3) -> Vec3, brdf: impl Fn(Vec3, Vec3) -> Vec3) -> f32 {
    let mut seed = 3;
    let mut most = 0.0f32;
    for i in 0..20_000 {
        let l = any_direction(&mut seed);
        let near = Vec3::new(-l.x, -l.y, l.z) + 0.2 * random(&mut seed) * any_direction(&mut seed);
        let v = if i % 2 == 0 { any_direction(&mut seed) } else { near.normalize() };
        if l.z.min(v.z) > 0.26 {
            let (found, expected) = (value(l, v), brdf(l, v));
            most = most.max(((found - expected) / expected).abs().max_element());
        }
    }
    most
}

#[test]
fn files_of_known_models_are_read_back_within_the_resolution_of_the_table() {
    let paper = |_: Vec3, _: Vec3| Vec3::new(0.8, 0.4, 0.1) / std::f32::consts::PI;
    let numbers = (FORMAT.read)(&of_brdf(paper)).expect("legal");
    let grid = Grid::new(&numbers).expect("a table");
    assert_eq!(grid.counts(), COUNTS);
    // Constant: what remains is the error of 16 bits.
    let at = |grid: Grid<'_>, l: Vec3, v: Vec3| grid.value(angles(l, v, Vec3::Z));
    assert!(difference(|l, v| at(grid, l, v), paper) < 1e-3);
    // Bins of 1° and, along the half angle, of less than 2 % of the width of the lobe.
    let numbers = (FORMAT.read)(&of_brdf(metal)).expect("legal");
    let grid = Grid::new(&numbers).expect("a table");
    let error = difference(|l, v| at(grid, l, v), metal);
    assert!(error < 0.01, "{error}");
    // The wrong twins: the two angles exchanged; no scale factors.
    let exchanged = |l: Vec3, v: Vec3| {
        let [h, d, phi] = angles(l, v, Vec3::Z);
        grid.value([d, h, phi])
    };
    assert!(difference(exchanged, metal) > 0.5);
    let unscaled = file(metal_at, [1.0; 3]);
    let numbers = (FORMAT.read)(&unscaled).expect("legal");
    let unscaled = Grid::new(&numbers).expect("a table");
    assert!(difference(|l, v| at(unscaled, l, v), metal) > 0.5);
    assert!(difference(|l, v| at(unscaled, l, v) / Vec3::from_array(SCALES.map(|s| s as f32)), metal) < 0.01);
}

fn metal_at(angles: [f32; 3]) -> [f64; 3] {
    let (l, v) = directions(angles);
    if l.z > 0.0 && v.z > 0.0 { metal(l, v).to_array().map(f64::from) } else { [-1.0; 3] }
}

/// The angles by S. Rusinkiewicz's two rotations.
fn rotated(l: Vec3, v: Vec3) -> [f64; 3] {
    let [l, v] = [l, v].map(|d| d.as_dvec3().normalize());
    let h = (l + v).normalize();
    let (theta_h, phi_h) = (h.z.clamp(-1.0, 1.0).acos(), h.y.atan2(h.x));
    let (sine, cosine) = phi_h.sin_cos();
    let d = DVec3::new(l.x * cosine + l.y * sine, l.y * cosine - l.x * sine, l.z);
    let (sine, cosine) = theta_h.sin_cos();
    let d = DVec3::new(d.x * cosine - d.z * sine, d.y, d.z * cosine + d.x * sine);
    [theta_h, d.z.clamp(-1.0, 1.0).acos(), d.y.atan2(d.x).rem_euclid(PI)]
}

#[test]
fn the_angles_are_those_of_two_rotations_and_both_ways_of_light_are_the_same() {
    let mut seed = 8;
    for _ in 0..10_000 {
        let (l, v) = (any_direction(&mut seed), any_direction(&mut seed));
        let (found, expected) = (angles(l, v, Vec3::Z).map(f64::from), rotated(l, v));
        let back = angles(v, l, Vec3::Z).map(f64::from);
        for (i, (found, back)) in found.into_iter().zip(back).enumerate() {
            // Azimuths go round, and lose digits where one of the other angles is small.
            let around = |a: f64, b: f64| (a - b).abs().min(if i == 2 { PI - (a - b).abs() } else { PI });
            let slack = if i == 2 { 1e-5 / (expected[0].sin() * expected[1].sin()) } else { 1e-5 };
            assert!(around(found, expected[i]) < slack, "{i} {l} {v}: {found} {}", expected[i]);
            assert!(around(found, back) < slack, "{i} {l} {v}: {found} {back}");
        }
    }
    // By hand: light and viewer in the plane of the normal, at 10° and 50° on two sides of it.
    let [h, d, phi] = angles(direction(10.0, 0.0), direction(50.0, 180.0), Vec3::Z);
    for (found, expected) in [(h, 20.0), (d, 30.0), (phi, 0.0)] {
        assert!((found.to_degrees() - expected).abs() < 1e-3, "{found} {expected}");
    }
    // Both at 40°, with the half vector on the normal: any azimuth, but a finite one.
    let [h, d, phi] = angles(direction(40.0, 70.0), direction(40.0, 250.0), Vec3::Z);
    assert!(h < 1e-3 && (d.to_degrees() - 40.0).abs() < 1e-3 && phi.is_finite());
}

#[test]
fn a_surface_that_is_no_mirror_image_of_itself_keeps_its_hand() {
    // By reciprocity it has a period of half a turn.
    let value = |[h, d, phi]: [f64; 3]| 0.1 * (1.0 + 0.5 * (2.0 * phi).sin() * h.sin() * d.sin());
    let bytes = file(|angles| [value(angles.map(f64::from)); 3], SCALES);
    let numbers = (FORMAT.read)(&bytes).expect("legal");
    let grid = Grid::new(&numbers).expect("a table");
    let mut seed = 5;
    let mut mirrored = 0.0f64;
    for _ in 0..5000 {
        let (l, v) = (any_direction(&mut seed), any_direction(&mut seed));
        let found = f64::from(grid.value(angles(l, v, Vec3::Z)).y);
        let expected = value(rotated(l, v));
        // In front of the first middle the table is constant.
        assert!((found / expected - 1.0).abs() < 2e-3, "{l} {v}: {found} {expected}");
        let [h, d, phi] = rotated(l, v);
        mirrored = mirrored.max((found / value([h, d, -phi]) - 1.0).abs());
    }
    assert!(mirrored > 0.5, "the wrong twin, light from the other side, goes unnoticed: {mirrored}");
}

#[test]
fn the_nearest_directions_that_were_measured_have_the_values_of_the_file() {
    let numbers = (FORMAT.read)(&of_brdf(metal)).expect("legal");
    let grid = Grid::new(&numbers).expect("a table");
    let mut seed = 4;
    let (mut own, mut between, mut missing) = (0.0f32, 0.0f32, 0);
    for _ in 0..20_000 {
        let (l, v) = (any_direction(&mut seed), any_direction(&mut seed));
        let error = |l: Vec3, v: Vec3| {
            let expected = metal(l, v);
            ((grid.value(angles(l, v, Vec3::Z)) - expected) / expected).abs().max_element()
        };
        let Some((a, b)) = grid.nearest(l, v) else {
            missing += 1;
            assert!(l.z.min(v.z) < 0.05, "{l} {v}");
            continue;
        };
        // A bin is at most 2° wide, but for the azimuth about a half vector.
        assert!((l - a).length() < 0.06 && (v - b).length() < 0.06, "{l} {a}, {v} {b}");
        if l.z.min(v.z) > 0.26 && a.z.min(b.z) > 0.26 {
            own = own.max(error(a, b));
            between = between.max(error(l, v));
        }
    }
    // What remains is the error of 16 bits.
    assert!(own < 1.5e-3 && between > 2.0 * own, "{own} {between}");
    assert!(missing > 0);
}

#[test]
fn where_entries_are_missing_the_table_goes_on_and_says_so() {
    const END: f32 = 1.0;
    let value = |[_, theta_d, _]: [f32; 3]| match theta_d {
        // A mark in one colour is one for all.
        d if d > END => [f64::from(d), -1.0, 0.5],
        d => [f64::from(d); 3],
    };
    let numbers = (FORMAT.read)(&file(value, SCALES)).expect("legal");
    let grid = Grid::new(&numbers).expect("a table");
    // The last middle below 1 is that of bin 56.
    let last = (56.5f32 / 90.0) * FRAC_PI_2 as f32;
    assert_eq!(grid.missing(), 33 * 90 * 180);
    for theta_d in [1.1, 1.3, 1.57] {
        let found = grid.value([0.3, theta_d, 1.0]);
        assert!((found - Vec3::splat(last)).abs().max_element() < 2e-3 * last, "{theta_d}: {found}");
    }
    assert_eq!((grid.entry([10.0, 56.0, 7.0]).w, grid.entry([10.0, 57.0, 7.0]).w), (1.0, 0.0));
    // A table whose first rows are missing begins with the first that is there.
    let begins = |[theta_h, ..]: [f32; 3]| [if theta_h < 0.5 { -1.0 } else { 0.25 }; 3];
    let numbers = (FORMAT.read)(&file(begins, SCALES)).expect("legal");
    let grid = Grid::new(&numbers).expect("a table");
    assert!((grid.value([0.0, 0.2, 0.3]) - Vec3::splat(0.25)).abs().max_element() < 1e-3);
    assert!(grid.missing() > 0);
}

#[test]
fn what_is_no_file_of_the_database_is_refused_with_the_reason() {
    let said = |bytes: &[u8]| (FORMAT.read)(bytes).expect_err("refused").message;
    assert_eq!(said(&[]), "it has 0 bytes; a file of the MERL database has 34992012");
    assert_eq!(
        said(b"solid cube\nfacet"),
        "it begins with solid cube facet; a file of the MERL database has 90 × 90 × 180 entries"
    );
    assert_eq!(
        said(b"{\n  \"name\": 1}"),
        "it begins with {   \"name\": 1}; a file of the MERL database has 90 × 90 × 180 entries"
    );
    for counts in [[90, 90, 360], [i32::MAX; 3], [-1, 0, 90], [i32::MIN; 3]] {
        let message = said(&header(counts));
        assert!(message.contains(&format!("{} × {} × {}", counts[0], counts[1], counts[2])), "{message}");
    }
    let whole = file(|_| [0.1; 3], SCALES);
    assert_eq!(whole.len() as u64, FORMAT.max_bytes);
    let long = crate::files::FileError::TooLarge(FORMAT.max_bytes).to_string();
    assert_eq!(long, "it is larger than 34992012 bytes");
    let cut = said(&whole[..1000]);
    assert_eq!(cut, "it ends after 1000 bytes; 90 × 90 × 180 entries in three colours take 34992012");
    let mut wrong = whole.clone();
    // The second colour of the entry (1, 2, 3).
    let at = 12 + 8 * (COUNTS.iter().product::<usize>() + (90 + 2) * 180 + 3);
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        wrong[at..at + 8].copy_from_slice(&value.to_le_bytes());
        assert_eq!(said(&wrong), format!("green of entry (1, 2, 3) is {value}, but must be a finite number"));
    }
    let negative = file(|_| [-1.0; 3], SCALES);
    assert_eq!(
        said(&negative),
        "every entry has a negative value in some colour, the mark of one that was not measured"
    );
    // Enormous values stay finite.
    let numbers = (FORMAT.read)(&file(|_| [1e300; 3], SCALES)).expect("legal");
    assert!(Grid::new(&numbers).expect("a table").value([0.5, 0.5, 0.5]).is_finite());
}

#[test]
fn the_lobe_for_sampling_is_about_as_wide_as_the_highlight() {
    const SMALL: [usize; 3] = [90, 30, 4];
    for alpha in [0.05f32, 0.15, 0.4] {
        let lobe = |l: Vec3, v: Vec3| {
            let h = (l + v).normalize();
            let q = (1.0 - h.z * h.z) / (alpha * alpha) + h.z * h.z;
            Vec3::splat(0.05 + 0.1 / (alpha * alpha * q * q))
        };
        let numbers = table(SMALL, lobe);
        let [found, diffuse, specular] = Grid::new(&numbers).expect("a table").lobe();
        assert!((0.8..1.25).contains(&(found / alpha)), "{alpha}: {found}");
        assert!((0.1..0.3).contains(&diffuse) && specular > 0.05, "{alpha}: {diffuse} {specular}");
    }
    let numbers = table(SMALL, |_, _| Vec3::splat(0.2));
    let [_, diffuse, specular] = Grid::new(&numbers).expect("a table").lobe();
    assert!((diffuse - 0.628).abs() < 0.01 && specular < 1e-3, "{diffuse} {specular}");
}

#[test]
fn without_a_file_a_calculated_surface_is_shown() {
    let model = MeasuredMerl::from_values(&Values::default(), crate::optics::colour::Encoding::Srgb);
    let file = model.merl_file.file.as_ref().expect("the default");
    assert_eq!((file.name(), file.path(), file.problem()), ("calculated.binary", None, None));
    let f = |l, v| brdf(&model, l, v, &Frame::LOCAL);
    let (l, v) = (direction(30.0, 0.0), direction(30.0, 180.0));
    // Copper: D = 1/(π α²) and F between F₀ and 1.
    let mirror = f(l, v);
    assert!(mirror.x > 1.2 * mirror.y && mirror.y > 1.1 * mirror.z && mirror.x > 1.0, "{mirror}");
    assert!(f(l, direction(60.0, 90.0)).max_element() < 0.2 * mirror.x);
    // In every frame, and black below.
    let frame = Frame::from_normal(Vec3::new(0.6, 0.0, 0.8));
    let room = |d: Vec3| d.x * frame.t + d.y * frame.b + d.z * frame.n;
    let there = model.response(room(l), room(v), &frame).specular;
    let here = model.response(l, v, &Frame::LOCAL).specular;
    assert!((there / here - 1.0).abs().max_element() < 1e-4, "{there} {here}");
    assert_eq!(model.response(Vec3::NEG_Z, v, &Frame::LOCAL).specular, Vec3::ZERO);
}
