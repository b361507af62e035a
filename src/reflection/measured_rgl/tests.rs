//! Files written from known models.

use std::f32::consts::PI;

use glam::{Vec2, Vec3};

use super::{
    FORMAT, MAX_NUMBERS,
    example::{arrays, metal},
    is_spectral,
    table::{Arrays, Data, numbers},
    viewed::lit_by,
};
use crate::{
    optics::{Frame, radiometry::Arriving},
    testing::direction as any_direction,
};

type Field<'a> = (&'a str, Vec<u64>, u8, Vec<u8>);

/// A tensor file.
fn tensors(fields: &[Field<'_>]) -> Vec<u8> {
    let heads = fields.iter().map(|(name, shape, ..)| 13 + name.len() + 8 * shape.len());
    let mut offset = 18 + heads.sum::<usize>();
    let mut bytes = [b"tensor_file\0\x01\0".as_slice(), &(fields.len() as u32).to_le_bytes()].concat();
    for (name, shape, kind, data) in fields {
        bytes.extend((name.len() as u16).to_le_bytes());
        bytes.extend(name.as_bytes());
        bytes.extend((shape.len() as u16).to_le_bytes());
        bytes.push(*kind);
        bytes.extend((offset as u64).to_le_bytes());
        bytes.extend(shape.iter().flat_map(|n| n.to_le_bytes()));
        offset += data.len();
    }
    fields.iter().for_each(|(.., data)| bytes.extend(data));
    bytes
}

fn floats<'a>(name: &'a str, shape: &[usize], all: &[f32]) -> Field<'a> {
    let data = all.iter().flat_map(|x| x.to_le_bytes()).collect();
    (name, shape.iter().map(|n| *n as u64).collect(), 10, data)
}

/// The fields of a file in colour, or with the same values at each wavelength of a spectrum.
fn fields<'a>(arrays: &Arrays, nm: &[f32]) -> Vec<Field<'a>> {
    let Arrays { phi, theta, sizes, ndf, sigma, vndf, values, jacobian, .. } = arrays;
    let [density, grid, normals, area] = *sizes;
    let channels = if nm.is_empty() { 3 } else { nm.len() };
    let mut channel_by_channel = Vec::new();
    for slice in values.chunks_exact(grid[0] * grid[1]) {
        for k in 0..channels {
            channel_by_channel
                .extend(slice.iter().map(|value| if nm.is_empty() { value[k] } else { value.y }));
        }
    }
    let counts = [phi.len(), theta.len()];
    let mut all = vec![
        floats("phi_i", &[counts[0]], phi),
        floats("theta_i", &[counts[1]], theta),
        floats("ndf", &[normals[1], normals[0]], ndf),
        floats("sigma", &[area[1], area[0]], sigma),
        floats("vndf", &[counts[0], counts[1], density[1], density[0]], vndf),
        ("jacobian", vec![1], 1, vec![u8::from(*jacobian)]),
    ];
    let shape = [counts[0], counts[1], channels, grid[1], grid[0]];
    if nm.is_empty() {
        all.push(floats("rgb", &shape, &channel_by_channel));
    } else {
        all.push(floats("spectra", &shape, &channel_by_channel));
        all.push(floats("wavelengths", &[nm.len()], nm));
    }
    all
}

fn read(bytes: &[u8]) -> Vec<f32> {
    (FORMAT.read)(bytes).unwrap_or_else(|problem| panic!("{problem:?}"))
}

/// f_r N·L in sr⁻¹ for directions in the local frame.
fn response(data: &Data<'_>, l: Vec3, v: Vec3) -> Vec3 {
    lit_by(data, &[Arriving { l, light: Vec3::ONE }], v, &Frame::LOCAL) / PI
}

/// The mean relative difference between a table and GGX, for directions up to 70° from the normal and half vectors within 35°.
fn difference(numbers: &[f32], alpha: Vec2, turned: bool) -> f32 {
    let data = Data::new(numbers).expect("a table");
    let mut seed = 6;
    let (mut sum, mut count) = (0.0, 0.0);
    for _ in 0..20_000 {
        let (l, v) = (any_direction(&mut seed), any_direction(&mut seed));
        if l.z.min(v.z) > 0.34 && (l + v).normalize().z > 0.82 {
            let turn = |d: Vec3| if turned { Vec3::new(-d.y, d.x, d.z) } else { d };
            let (found, expected) = (response(&data, turn(l), turn(v)), metal(l, v, alpha) * l.z);
            sum += ((found - expected) / expected).abs().max_element();
            count += 1.0;
        }
    }
    assert!(count > 500.0);
    sum / count
}

#[test]
fn files_of_ggx_are_read_back_within_the_resolution_of_the_table() {
    // Viewers 12° apart, normals on 32 × 64, and values on 16 × 16 places.
    for (alpha, phis) in [(Vec2::splat(0.35), 1), (Vec2::new(0.4, 0.25), 5)] {
        let arrays = arrays(alpha, [phis, 8], [32, 64], 16);
        let numbers = read(&tensors(&fields(&arrays, &[])));
        let error = difference(&numbers, alpha, false);
        assert!(error < 0.01, "{alpha}: {error}");
        // The wrong twins: the surface turned, which an isotropic one does not notice; the values in other places.
        let turned = difference(&numbers, alpha, true);
        assert!(
            if phis == 1 { (turned - error).abs() < 1e-3 } else { turned > 3.0 * error },
            "{turned} {error}"
        );
        let mut other = arrays.clone();
        other.values.chunks_exact_mut(16 * 16).for_each(<[Vec3]>::reverse);
        let other = difference(&read(&tensors(&fields(&other, &[]))), alpha, false);
        assert!(other > 2.0 * error, "{other} {error}");
    }
}

#[test]
fn several_lights_give_what_each_gives_alone() {
    // The law of all models has the shipped file, which is anisotropic.
    let numbers = numbers(&arrays(Vec2::splat(0.35), [1, 5], [16, 16], 8));
    let data = Data::new(&numbers).expect("a table");
    let mut seed = 9;
    for count in 0..11 {
        let v = any_direction(&mut seed);
        let light = |i| Arriving { l: any_direction(&mut seed), light: Vec3::new(1.0, i as f32, 2.0) };
        let lights: Vec<_> = (0..count).map(light).collect();
        let alone: Vec3 = lights.iter().map(|at| lit_by(&data, &[*at], v, &Frame::LOCAL)).sum();
        let found = lit_by(&data, &lights, v, &Frame::LOCAL);
        assert!((found - alone).abs().max_element() <= 1e-5 * alone.max_element(), "{found} {alone}");
    }
}

#[test]
fn a_flat_spectrum_is_white_and_others_have_their_colour() {
    let arrays = arrays(Vec2::splat(0.4), [1, 4], [12, 12], 6);
    let nm: Vec<f32> = (0..40).map(|i| 360.0 + 12.0 * i as f32).collect();
    let bytes = tensors(&fields(&arrays, &nm));
    assert!(is_spectral(&bytes) && !is_spectral(&tensors(&fields(&arrays, &[]))));
    let mut green = arrays.clone();
    green.values.iter_mut().for_each(|value| *value = Vec3::splat(value.y));
    let (found, expected) = (read(&bytes), numbers(&green));
    assert_eq!(found.len(), expected.len());
    assert!(found.iter().zip(&expected).all(|(a, b)| (a - b).abs() <= 1e-5 * (1.0 + b.abs())));
    // Long waves alone are red.
    let mut red = fields(&arrays, &nm);
    let spectra = &mut red[6].3;
    let side = 4 * 36;
    for slice in spectra.chunks_exact_mut(side * nm.len()) {
        slice[..side * 22].fill(0);
    }
    let numbers = read(&tensors(&red));
    let value = response(&Data::new(&numbers).expect("a table"), Vec3::Z, Vec3::Z);
    assert!(value.x > 4.0 * value.y && value.x > 4.0 * value.z, "{value}");
}

#[test]
fn an_azimuth_is_one_of_the_part_of_a_turn_that_the_file_covers() {
    let alpha = Vec2::new(0.4, 0.2);
    let numbers = numbers(&arrays(alpha, [3, 5], [24, 48], 8));
    let data = Data::new(&numbers).expect("a table");
    let mut seed = 2;
    for _ in 0..500 {
        let (l, v) = (any_direction(&mut seed), any_direction(&mut seed));
        let found = response(&data, l, v);
        for (x, y) in [(-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)] {
            let mirrored = |d: Vec3| Vec3::new(x * d.x, y * d.y, d.z);
            let there = response(&data, mirrored(l), mirrored(v));
            assert!(
                (there - found).abs().max_element() <= 1e-3 * (0.01 + found.max_element()),
                "{there} {found}"
            );
        }
    }
    // Values that the file has without the density are as they are.
    let mut plain = arrays(alpha, [3, 5], [24, 48], 8);
    plain.jacobian = false;
    plain.values.fill(Vec3::splat(0.25 / PI));
    let plain = super::table::numbers(&plain);
    let value = response(&Data::new(&plain).expect("a table"), Vec3::Z, Vec3::new(0.6, 0.0, 0.8));
    assert!((value - 0.25 / PI).abs().max_element() < 1e-5, "{value}");
}

#[test]
fn what_is_no_file_of_the_database_is_refused_with_the_reason() {
    let said = |bytes: &[u8]| (FORMAT.read)(bytes).expect_err("refused").message;
    assert!(said(b"solid cube").contains("begins with tensor_file"));
    assert!(said(b"").contains("begins with tensor_file"));
    assert!(said(b"tensor_file\0\x02\0").contains("version 2.0"));
    assert!(said(b"tensor_file\0\x01\0\xff\xff\xff\xff").contains("4294967295 fields"));
    assert!(said(b"tensor_file\0\x01\0\x01\0\0\0").contains("ends within its list"));
    assert!(said(b"tensor_file\0\x01\0\0\0\0\0").contains("no field phi_i"));
    let right = fields(&arrays(Vec2::splat(0.4), [1, 4], [12, 12], 6), &[]);
    let whole = tensors(&right);
    for length in 0..whole.len() {
        // Every 97th length of the data, and every length of the head.
        if length < 400 || length % 97 == 0 {
            assert!((FORMAT.read)(&whole[..length]).is_err(), "{length}");
        }
    }
    let changed = |change: &dyn Fn(&mut Vec<Field<'_>>)| {
        let mut fields = right.clone();
        change(&mut fields);
        said(&tensors(&fields))
    };
    assert!(changed(&|all| all[2].1 = vec![u64::MAX, u64::MAX]).contains("beyond the end"));
    assert!(changed(&|all| all[2].1 = vec![1 << 40, 1 << 40]).contains("beyond the end"));
    assert!(changed(&|all| all[4].1 = vec![4, 1, 12, 12]).contains("4 × 1 directions"));
    assert!(changed(&|all| all[4].1 = vec![4 * 144]).contains("4 dimensions"));
    assert!(changed(&|all| all[2].2 = 99).contains("unknown type, 99"));
    assert!(changed(&|all| all[2].1[0] = 0).contains("a side of the field ndf is 0"));
    assert!(changed(&|all| all[1].3.fill(0)).contains("theta_i must ascend"));
    let steep = changed(&|all| all[1].3[12..].copy_from_slice(&2f32.to_le_bytes()));
    assert!(steep.contains("theta_i has 2, but must be from 0 to π/2"), "{steep}");
    assert!(changed(&|all| all[2].3.fill(0)).contains("ndf is nowhere above 0"));
    for (number, shown) in [(f32::NAN, "NaN"), (f32::INFINITY, "inf"), (-1e21, "-1e21")] {
        let said = changed(&|all| all[4].3[..4].copy_from_slice(&f32::to_le_bytes(number)));
        let rule = format!("number 0 of the field vndf is {shown}, but must be from -1e20 to 1e20");
        assert!(said.contains(&rule), "{said}");
    }
    assert!(changed(&|all| _ = all.pop()).contains("no field wavelengths"));
    assert!(FORMAT.max_bytes > 4 * MAX_NUMBERS as u64);
}
