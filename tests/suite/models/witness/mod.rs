//! Every model against values calculated by other programs (`tests/data/golden/`), and against closed forms.
//! One file for each group of models.

mod classical;
mod microfacet;
mod openpbr;
mod practical;
mod rough;

use glam::Vec3;
pub use lights_camera_models::optics::geometry::direction;
use lights_camera_models::{
    optics::Frame,
    reflection::{Surface, brdf},
};

/// A value from another program: the BRDF in sr⁻¹ without the cosine, or the bare factor after which the row
/// is named.
pub struct Row {
    /// The program's input, in its own notation.
    pub params: String,
    /// Unit vector to the light, in the local frame: normal +z, tangent +x.
    pub l: Vec3,
    /// Unit vector to the viewer.
    pub v: Vec3,
    /// The value.
    pub f: [f64; 3],
}

/// The frame of the rows.
pub const LOCAL: Frame = Frame::LOCAL;

/// The rows of a program's model whose parameters contain `params`.
///
/// # Panics
/// Panics if there are none: a comparison with nothing is not a test.
pub fn rows(oracle: &str, model: &str, params: &str) -> Vec<Row> {
    let text = include_str!("../../../data/golden/brdf_values.csv");
    let rows: Vec<_> = text
        .lines()
        .skip(1)
        .map(cells)
        .filter(|c| c[0] == oracle && c[1] == model && c[2].contains(params))
        .map(|c| {
            let number = |i: usize| c[i].parse::<f64>().unwrap();
            Row {
                l: direction(number(3), number(4)),
                v: direction(number(5), number(6)),
                f: [number(7), number(8), number(9)],
                params: c[2].clone(),
            }
        })
        .collect();
    assert!(!rows.is_empty(), "no rows of {oracle} {model} {params}");
    rows
}

/// The cells of a line of CSV; quotation marks are doubled within quoted cells.
fn cells(line: &str) -> Vec<String> {
    let mut cells = vec![String::new()];
    let mut quoted = false;
    let mut characters = line.chars().peekable();
    while let Some(c) = characters.next() {
        match c {
            '"' if quoted && characters.peek() == Some(&'"') => {
                characters.next();
                cells.last_mut().unwrap().push('"');
            }
            '"' => quoted = !quoted,
            ',' if !quoted => cells.push(String::new()),
            c => cells.last_mut().unwrap().push(c),
        }
    }
    cells
}

/// True if two values are equal up to the relative `tolerance`; values below 1e-7 count as zero.
pub fn near(a: f64, b: f64, tolerance: f64) -> bool {
    (a - b).abs() <= tolerance * a.abs().max(b.abs()) + 1e-7
}

/// Asserts that a surface has the BRDF of every row, and that `wrong` does not.
pub fn assert_rows(rows: &[Row], surface: &dyn Surface, wrong: &dyn Surface, tolerance: f64) {
    let f = |surface: &dyn Surface, row: &Row| brdf(surface, row.l, row.v, &LOCAL).to_array().map(f64::from);
    let same = |a: [f64; 3], b: [f64; 3]| (0..3).all(|i| near(a[i], b[i], tolerance));
    for row in rows {
        let got = f(surface, row);
        assert!(same(got, row.f), "{} at {} {}: {got:?} is not {:?}", row.params, row.l, row.v, row.f);
    }
    assert!(rows.iter().any(|row| !same(f(wrong, row), row.f)), "{}: the wrong twin passes", rows[0].params);
}

#[test]
fn quoted_cells_are_read_as_spreadsheets_write_them() {
    assert_eq!(cells("a,\"b, \"\"c\"\"\",,d"), ["a", "b, \"c\"", "", "d"]);
}
