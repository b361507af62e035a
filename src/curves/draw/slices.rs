//! Image slices: pictures with two angles as axes.

use super::{
    Ground,
    layout::{self, Around, FONT},
    pen::{Anchor, Ink, Pen},
};

/// One picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Tile {
    /// The name, above the picture.
    pub name: String,
    /// The number of pixels across and down.
    pub side: u32,
    /// Red, green and blue, row by row from the top.
    pub rgb8: Vec<u8>,
}

/// Pictures side by side, with axes from 0° to 90°.
#[derive(Clone, Debug, PartialEq)]
pub struct Slices {
    /// The content, for screen readers.
    pub title: String,
    /// The line above the pictures.
    pub heading: String,
    /// The pictures.
    pub tiles: Vec<Tile>,
    /// The side of each picture.
    pub side: f64,
    /// The number of pictures in a row.
    pub columns: usize,
    /// Remarks below the pictures.
    pub notes: Vec<String>,
}

/// The side of a picture in a file.
pub const SIDE: f64 = 320.0;
/// The gap between two pictures, with labels.
pub const GAP: [f64; 2] = [84.0, 5.6 * FONT];
/// Maximum number of pictures in a row.
const ROW: usize = 3;
/// The labels of the axes.
const AXES: [&str; 2] = ["half angle (°)", "difference angle (°)"];

impl Slices {
    /// The number of pictures in a row of a file with this number of pictures.
    pub(in crate::curves) fn columns_of(tiles: usize) -> usize {
        match tiles {
            4 => 2,
            n => n.clamp(1, ROW),
        }
    }

    /// Width and height.
    pub(super) fn size(&self) -> [f64; 2] {
        // In a narrow figure, remarks may need two lines.
        let columns = self.columns.max(1);
        let lines = self.notes.len() as f64 * if columns == 1 { 2.0 } else { 1.0 };
        let rows = self.tiles.len().div_ceil(columns).max(1);
        let width = (columns as f64 * (self.side + GAP[0]) + 28.0).max(560.0);
        [width, rows as f64 * (self.side + GAP[1]) + 56.0 + 19.0 * lines]
    }
}

/// Draws the slices.
pub(super) fn draw(slices: &Slices, pen: &mut impl Pen) -> Ground {
    let parts = Around { size: slices.size(), heading: &slices.heading, notes: &slices.notes, legend: &[] };
    let [left, top, _, _] = layout::around(pen, &parts);
    let (columns, side) = (slices.columns.max(1), slices.side);
    let mut places = Vec::new();
    for (i, tile) in slices.tiles.iter().enumerate() {
        let x = left + 50.0 + (i % columns) as f64 * (side + GAP[0]);
        let y = top + 2.6 * FONT + (i / columns) as f64 * (side + GAP[1]);
        pen.text([x, y - 1.7 * FONT], Anchor::Start, FONT, &tile.name);
        pen.text([x - 40.0, y - 0.5 * FONT], Anchor::Start, FONT - 2.0, AXES[1]);
        pen.picture([x, y, side, side], [tile.side; 2], &tile.rgb8);
        let frame = [[x, y], [x + side, y], [x + side, y + side], [x, y + side], [x, y]];
        pen.stroke(&frame, Ink::Text, 1.0, &[]);
        for angle in [0.0, 30.0, 60.0, 90.0] {
            let at = side * angle / 90.0;
            let label = format!("{angle}");
            pen.stroke(&[[x + at, y + side], [x + at, y + side + 5.0]], Ink::Text, 1.0, &[]);
            pen.text([x + at, y + side + 6.0 + FONT], Anchor::Middle, FONT - 2.0, &label);
            pen.stroke(&[[x - 5.0, y + side - at], [x, y + side - at]], Ink::Text, 1.0, &[]);
            pen.text([x - 9.0, y + side - at + 0.33 * FONT], Anchor::End, FONT - 2.0, &label);
        }
        pen.text([x + 0.5 * side, y + side + 2.0 * FONT + 8.0], Anchor::Middle, FONT - 2.0, AXES[0]);
        places.push([x, y, x + side, y + side]);
    }
    Ground::Slices(places)
}
