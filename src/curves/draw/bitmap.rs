//! Figures as pictures, with smooth edges.

use super::pen::{Anchor, Ink, Pen};
use crate::lettering::Lettering;

/// A picture of RGB bytes.
pub(super) struct Bitmap {
    pub(super) size: [u32; 2],
    pub(super) rgb8: Vec<u8>,
    /// Pixels per unit of the figure.
    scale: f64,
}

impl Bitmap {
    /// A white bitmap for a figure of this width and height.
    pub(super) fn new(size: [f64; 2], scale: f64) -> Self {
        let size = size.map(|v| (v * scale).round().max(1.0) as u32);
        Self { size, rgb8: vec![255; 3 * size[0] as usize * size[1] as usize], scale }
    }

    fn colour(ink: Ink) -> [u8; 3] {
        match ink {
            Ink::Grid => super::GRID,
            _ => ink.colour().unwrap_or(super::INK),
        }
    }

    /// The pixels of the picture in the box from `low` to `high`.
    fn box_of(&self, low: [f64; 2], high: [f64; 2]) -> [std::ops::Range<i64>; 2] {
        let range = |i: usize| {
            let end = i64::from(self.size[i]);
            (low[i].floor() as i64).clamp(0, end)..(high[i].ceil() as i64 + 1).clamp(0, end)
        };
        [range(0), range(1)]
    }

    fn blend(&mut self, x: i64, y: i64, colour: [u8; 3], part: f64) {
        let i = 3 * (y as usize * self.size[0] as usize + x as usize);
        for (old, new) in self.rgb8[i..i + 3].iter_mut().zip(colour) {
            *old = (f64::from(*old) + part * (f64::from(new) - f64::from(*old))).round() as u8;
        }
    }
}

/// The pieces of a line that its dashes cover.
fn dashes(path: &[[f64; 2]], dash: &[f64]) -> Vec<Vec<[f64; 2]>> {
    if dash.iter().sum::<f64>() <= 0.0 {
        return vec![path.to_vec()];
    }
    let (mut pieces, mut piece) = (Vec::new(), Vec::new());
    let (mut which, mut remaining) = (0, dash[0]);
    for pair in path.windows(2) {
        let ([ax, ay], [bx, by]) = (pair[0], pair[1]);
        let length = (bx - ax).hypot(by - ay);
        let mut at = 0.0;
        if which % 2 == 0 && piece.is_empty() {
            piece.push([ax, ay]);
        }
        while length - at > remaining {
            at += remaining;
            let here = [ax + (bx - ax) * at / length, ay + (by - ay) * at / length];
            if which % 2 == 0 {
                piece.push(here);
                pieces.push(std::mem::take(&mut piece));
            } else {
                piece = vec![here];
            }
            which += 1;
            remaining = dash[which % dash.len()];
        }
        remaining -= length - at;
        if which % 2 == 0 {
            piece.push([bx, by]);
        }
    }
    if piece.len() > 1 {
        pieces.push(piece);
    }
    pieces
}

impl Pen for Bitmap {
    fn stroke(&mut self, path: &[[f64; 2]], ink: Ink, width: f64, dash: &[f64]) {
        let colour = Self::colour(ink);
        let half = 0.5 * width * self.scale;
        let mut covered = std::collections::BTreeMap::<(i64, i64), f64>::new();
        for piece in dashes(path, dash) {
            for pair in piece.windows(2) {
                let [[ax, ay], [bx, by]] = [pair[0], pair[1]].map(|p| p.map(|v| v * self.scale));
                let (dx, dy) = (bx - ax, by - ay);
                let squared = dx * dx + dy * dy;
                let reach = half + 1.0;
                let [across, down] = self.box_of(
                    [ax.min(bx) - reach, ay.min(by) - reach],
                    [ax.max(bx) + reach, ay.max(by) + reach],
                );
                for y in down {
                    for x in across.clone() {
                        let (px, py) = (x as f64 + 0.5 - ax, y as f64 + 0.5 - ay);
                        let t =
                            if squared > 0.0 { ((px * dx + py * dy) / squared).clamp(0.0, 1.0) } else { 0.0 };
                        let part = (half + 0.5 - (px - t * dx).hypot(py - t * dy)).clamp(0.0, 1.0);
                        if part > 0.0 {
                            // The joints of a line are not covered twice.
                            let most = covered.entry((x, y)).or_default();
                            *most = most.max(part);
                        }
                    }
                }
            }
        }
        for ((x, y), part) in covered {
            self.blend(x, y, colour, part);
        }
    }

    fn fill(&mut self, path: &[[f64; 2]], ink: Ink) {
        const ACROSS: i64 = 4;
        let path: Vec<_> = path.iter().map(|p| p.map(|v| v * self.scale)).collect();
        let Some(first) = path.first().copied() else { return };
        let low = path.iter().fold(first, |m, p| [m[0].min(p[0]), m[1].min(p[1])]);
        let high = path.iter().fold(first, |m, p| [m[0].max(p[0]), m[1].max(p[1])]);
        let inside = |x: f64, y: f64| {
            let edges = path.iter().zip(path.iter().cycle().skip(1));
            let crossed = edges.filter(|(a, b)| {
                (a[1] > y) != (b[1] > y) && x < a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0])
            });
            crossed.count() % 2 == 1
        };
        let [across, down] = self.box_of(low, high);
        for y in down {
            for x in across.clone() {
                let place = |i: i64| (i as f64 + 0.5) / ACROSS as f64;
                let hits = (0..ACROSS * ACROSS)
                    .filter(|i| inside(x as f64 + place(i % ACROSS), y as f64 + place(i / ACROSS)))
                    .count();
                self.blend(x, y, Self::colour(ink), hits as f64 / (ACROSS * ACROSS) as f64);
            }
        }
    }

    fn text(&mut self, [x, y]: [f64; 2], anchor: Anchor, px: f64, text: &str) {
        let px = (px * self.scale) as f32;
        let width = f64::from(Lettering::Regular.width(px, text));
        let left = match anchor {
            Anchor::Start => 0.0,
            Anchor::Middle => 0.5 * width,
            Anchor::End => width,
        };
        let top = y * self.scale - f64::from(Lettering::Regular.foot(px));
        let at = [(x * self.scale - left).round() as i32, top.round() as i32];
        Lettering::Regular.draw(&mut self.rgb8, self.size, at, px, super::INK, text);
    }

    fn picture(&mut self, to: [f64; 4], size: [u32; 2], rgb8: &[u8]) {
        let [left, top, width, height] = to.map(|v| v * self.scale);
        let [across, down] = self.box_of([left, top], [left + width - 1.0, top + height - 1.0]);
        let nearest = |at: i64, from: f64, length: f64, count: u32| {
            let part = (at as f64 + 0.5 - from) / length;
            (part * f64::from(count)).clamp(0.0, f64::from(count) - 1.0) as usize
        };
        for y in down {
            for x in across.clone() {
                let i =
                    nearest(y, top, height, size[1]) * size[0] as usize + nearest(x, left, width, size[0]);
                if let Some([r, g, b]) = rgb8.get(3 * i..3 * i + 3) {
                    self.blend(x, y, [*r, *g, *b], 1.0);
                }
            }
        }
    }

    fn width(&self, px: f64, text: &str) -> f64 {
        f64::from(Lettering::Regular.width((px * self.scale) as f32, text)) / self.scale
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dashes_go_on_around_corners() {
        let path = [[0.0, 0.0], [3.0, 0.0], [3.0, 10.0]];
        assert_eq!(
            dashes(&path, &[5.0, 2.0]),
            [vec![[0.0, 0.0], [3.0, 0.0], [3.0, 2.0]], vec![[3.0, 4.0], [3.0, 9.0]]]
        );
        assert_eq!(dashes(&path, &[]), [path.to_vec()]);
    }

    #[test]
    fn a_line_is_as_wide_as_asked_and_outside_the_paper_nothing_happens() {
        let mut paper = Bitmap::new([20.0, 10.0], 1.0);
        paper.stroke(&[[-5.0, 5.0], [30.0, 5.0]], Ink::Curve(0), 2.0, &[]);
        let rows: Vec<_> = (0..10).map(|y| paper.rgb8[3 * (y * 20 + 10)]).collect();
        assert_eq!(rows, [255, 255, 255, 255, 0, 0, 255, 255, 255, 255]);
        paper.fill(&[[2.0, 1.0], [4.0, 1.0], [4.0, 3.0], [2.0, 3.0]], Ink::Text);
        assert_eq!(paper.rgb8[3 * (2 * 20 + 3)], super::super::INK[0]);
        assert_eq!(paper.rgb8[3 * (2 * 20 + 5)], 255);
    }
}
