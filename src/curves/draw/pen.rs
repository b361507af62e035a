//! The drawing operations for figures: lines, areas, text and pictures, on light or dark paper.

/// A colour, by its purpose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ink {
    /// Text and axes.
    Text,
    /// Grid lines behind the curves.
    Grid,
    /// The colour of a curve, counted from 0; 6 is the colour of text.
    Curve(usize),
}

/// Okabe and Ito's colours except yellow, which is too light on white, and black, which is [`Ink::Text`].
pub const COLOURS: [[u8; 3]; 6] =
    [[0, 114, 178], [213, 94, 0], [0, 158, 115], [204, 121, 167], [230, 159, 0], [86, 180, 233]];

impl Ink {
    /// The colour of a curve; `None` for the colour of text.
    #[must_use]
    pub fn colour(self) -> Option<[u8; 3]> {
        match self {
            Self::Curve(index) => COLOURS.get(index % (COLOURS.len() + 1)).copied(),
            Self::Text | Self::Grid => None,
        }
    }
}

/// The part of a line of text that is placed at its position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// The left end.
    Start,
    /// The middle.
    Middle,
    /// The right end.
    End,
}

/// Draws the curves of a figure. Positions are in the figure's units, x to the right and y down from the
/// upper left corner.
pub trait Pen {
    /// Draws a line through points; `dash` holds the lengths of dashes and gaps, and is empty for a solid
    /// line.
    fn stroke(&mut self, path: &[[f64; 2]], ink: Ink, width: f64, dash: &[f64]);
    /// Fills an area.
    fn fill(&mut self, path: &[[f64; 2]], ink: Ink);
    /// Draws a line of text with its baseline at `at`.
    fn text(&mut self, at: [f64; 2], anchor: Anchor, px: f64, text: &str);
    /// Draws a picture of RGB bytes in a rectangle: left, top, width, height.
    fn picture(&mut self, to: [f64; 4], size: [u32; 2], rgb8: &[u8]);
    /// Says which series the following calls belong to, counted from 0, or `None`. Most pens ignore it.
    fn series(&mut self, _series: Option<usize>) {}
    /// The maximum width of a line of text.
    fn width(&self, px: f64, text: &str) -> f64;

    /// The text broken into lines no wider than `width`.
    fn lines(&self, px: f64, text: &str, width: f64) -> Vec<String> {
        let mut lines = Vec::new();
        let mut line = String::new();
        for word in text.split(' ') {
            let longer = if line.is_empty() { word.to_owned() } else { format!("{line} {word}") };
            if !line.is_empty() && self.width(px, &longer) > width {
                lines.push(std::mem::replace(&mut line, word.to_owned()));
            } else {
                line = longer;
            }
        }
        lines.push(line);
        lines
    }
}

/// The points of a circle.
pub(super) fn circle([x, y]: [f64; 2], radius: f64) -> Vec<[f64; 2]> {
    arc([x, y], radius, 0.0, 360.0)
}

/// The points of an arc between two angles in degrees, clockwise from the top.
pub(super) fn arc([x, y]: [f64; 2], radius: f64, from: f64, to: f64) -> Vec<[f64; 2]> {
    let steps = ((to - from).abs() / 360.0 * (radius * 2.0).clamp(24.0, 360.0)).ceil().max(2.0) as u32;
    let at = |i: u32| {
        let (sin, cos) = (from + (to - from) * f64::from(i) / f64::from(steps)).to_radians().sin_cos();
        [x + radius * sin, y - radius * cos]
    };
    (0..=steps).map(at).collect()
}

/// The parts of a line that lie in a rectangle: left, top, right, bottom. Points that are not finite are gaps.
pub(super) fn clipped(path: &[[f64; 2]], area: [f64; 4]) -> Vec<Vec<[f64; 2]>> {
    let mut runs: Vec<Vec<[f64; 2]>> = Vec::new();
    let finite = |p: &[f64; 2]| p.iter().all(|v| v.is_finite());
    for pair in path.windows(2) {
        let [a, b] = [pair[0], pair[1]];
        let Some((from, to)) = (finite(&a) && finite(&b)).then(|| inside(a, b, area)).flatten() else {
            continue;
        };
        match runs.last_mut().filter(|run| run.last() == Some(&from)) {
            Some(run) => run.push(to),
            None => runs.push(vec![from, to]),
        }
    }
    runs
}

/// The part of a segment that lies in a rectangle: Y.-D. Liang, B. A. Barsky (1984), *A New Concept and Method for Line
/// Clipping*.
fn inside(a: [f64; 2], b: [f64; 2], [left, top, right, bottom]: [f64; 4]) -> Option<([f64; 2], [f64; 2])> {
    let d = [b[0] - a[0], b[1] - a[1]];
    let (mut enter, mut leave) = (0.0f64, 1.0f64);
    let edges = [(-d[0], a[0] - left), (d[0], right - a[0]), (-d[1], a[1] - top), (d[1], bottom - a[1])];
    for (p, q) in edges {
        if p == 0.0 && q < 0.0 {
            return None;
        } else if p < 0.0 {
            enter = enter.max(q / p);
        } else if p > 0.0 {
            leave = leave.min(q / p);
        }
    }
    let at = |t: f64| match t {
        0.0 => a,
        1.0 => b,
        _ => [a[0] + t * d[0], a[1] + t * d[1]],
    };
    (enter <= leave).then(|| (at(enter), at(leave)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_cut_at_the_edges_and_at_gaps() {
        let area = [0.0, 0.0, 10.0, 10.0];
        let whole = [[1.0, 1.0], [5.0, 5.0], [9.0, 1.0]];
        assert_eq!(clipped(&whole, area), [whole.to_vec()]);
        // The line leaves at the top and comes in again.
        let over = [[0.0, 5.0], [5.0, -5.0], [10.0, 5.0]];
        assert_eq!(clipped(&over, area), [[[0.0, 5.0], [2.5, 0.0]], [[7.5, 0.0], [10.0, 5.0]]]);
        let gap = [[1.0, 1.0], [2.0, 1.0], [3.0, f64::NAN], [4.0, 1.0], [5.0, 1.0]];
        assert_eq!(clipped(&gap, area), [[[1.0, 1.0], [2.0, 1.0]], [[4.0, 1.0], [5.0, 1.0]]]);
        assert!(clipped(&[[-2.0, -2.0], [-1.0, 5.0]], area).is_empty());
        assert!(clipped(&[[1.0, f64::INFINITY], [2.0, 3.0]], area).is_empty());
    }
}
