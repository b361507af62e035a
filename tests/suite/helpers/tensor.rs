//! A small file of the RGL database, of no real surface.

use std::{f32::consts::PI, fs, path::Path};

type Field<'a> = (&'a str, Vec<usize>, Vec<f32>);

/// Writes a brushed surface, or another, with `across` in place of `along`: the widths of its highlight.
pub fn write(path: &Path, along: f32, across: f32) {
    const COLUMNS: usize = 16;
    const ROWS: usize = 33;
    const SIDE: usize = 8;
    let phi: Vec<f32> = (0..9).map(|i| PI * (i as f32 / 4.0 - 1.0)).collect();
    let theta: Vec<f32> = (0..6).map(|i| 0.3 * i as f32).collect();
    let grid = |value: &dyn Fn(f32, f32) -> f32| -> Vec<f32> {
        let (polar, around) = (COLUMNS - 1, ROWS - 1);
        (0..ROWS * COLUMNS)
            .map(|i| {
                let (u, v) = ((i % COLUMNS) as f32 / polar as f32, (i / COLUMNS) as f32 / around as f32);
                value(0.5 * PI * u * u, PI * (2.0 * v - 1.0))
            })
            .collect()
    };
    let normals = |theta: f32, phi: f32| {
        let slope = (phi.cos() / along).powi(2) + (phi.sin() / across).powi(2);
        let k = theta.cos().powi(2) + theta.sin().powi(2) * slope;
        1.0 / (PI * along * across * k * k)
    };
    let area = |theta: f32, phi: f32| {
        let spread = (along * phi.cos()).powi(2) + (across * phi.sin()).powi(2);
        0.5 * (theta.cos() + (theta.cos().powi(2) + theta.sin().powi(2) * spread).sqrt())
    };
    let (mut vndf, mut rgb, mut luminance) = (Vec::new(), Vec::new(), Vec::new());
    for p in &phi {
        for t in &theta {
            vndf.extend(grid(&|theta, phi| {
                let facing = theta.sin() * t.sin() * (phi - p).cos() + theta.cos() * t.cos();
                theta.sqrt() * theta.sin() * normals(theta, phi) * facing.max(0.0)
            }));
            let value = |k: usize, i: usize| {
                let (x, y) = ((i % SIDE) as f32 / 7.0, (i / SIDE) as f32 / 7.0);
                0.4 + 0.2 * (k as f32 - 1.0) * x + 0.1 * (2.0 * PI * y).cos() + 0.05 * t
            };
            (0..3).for_each(|k| rgb.extend((0..SIDE * SIDE).map(|i| value(k, i))));
            luminance.extend((0..SIDE * SIDE).map(|i| value(1, i)));
        }
    }
    let sides = |more: &[usize]| [&[phi.len(), theta.len()], more].concat();
    let fields: Vec<Field<'_>> = vec![
        ("phi_i", vec![phi.len()], phi.clone()),
        ("theta_i", vec![theta.len()], theta.clone()),
        ("ndf", vec![ROWS, COLUMNS], grid(&normals)),
        ("sigma", vec![ROWS, COLUMNS], grid(&area)),
        ("vndf", sides(&[ROWS, COLUMNS]), vndf),
        ("rgb", sides(&[3, SIDE, SIDE]), rgb),
        ("luminance", sides(&[SIDE, SIDE]), luminance),
    ];
    // Two more of bytes: Mitsuba wants a description.
    let bytes: [(&str, &[u8]); 2] = [("jacobian", &[1]), ("description", b"calculated")];
    let heads = fields.iter().map(|(name, shape, _)| 13 + name.len() + 8 * shape.len());
    let more = bytes.iter().map(|(name, _)| 21 + name.len());
    let mut offset = 18 + heads.sum::<usize>() + more.sum::<usize>();
    let mut out = [b"tensor_file\0\x01\0".as_slice(), &9u32.to_le_bytes()].concat();
    let mut head = |name: &str, shape: &[usize], kind: u8, length: usize| {
        out.extend((name.len() as u16).to_le_bytes());
        out.extend(name.as_bytes());
        out.extend((shape.len() as u16).to_le_bytes());
        out.push(kind);
        out.extend((offset as u64).to_le_bytes());
        out.extend(shape.iter().flat_map(|n| (*n as u64).to_le_bytes()));
        offset += length;
    };
    fields.iter().for_each(|(name, shape, all)| head(name, shape, 10, 4 * all.len()));
    bytes.iter().for_each(|(name, all)| head(name, &[all.len()], 1, all.len()));
    fields.iter().for_each(|(.., all)| out.extend(all.iter().flat_map(|x| x.to_le_bytes())));
    bytes.iter().for_each(|(_, all)| out.extend(*all));
    fs::write(path, out).expect("written");
}
