//! The parts around a figure: heading, legend, remarks.

use super::{
    Line, Mark, Series,
    pen::{Anchor, Ink, Pen, circle, clipped},
};

/// The size of text.
pub(super) const FONT: f64 = 17.0;
/// The size of remarks.
const SMALL: f64 = 14.0;
/// The margin at the edges.
const MARGIN: f64 = 14.0;
/// The length of the samples in the legend.
const SAMPLE: f64 = 36.0;
/// The thickness of curves.
pub(super) const THICK: f64 = 2.0;

/// The parts around a figure.
pub(super) struct Around<'a> {
    pub(super) size: [f64; 2],
    pub(super) heading: &'a str,
    pub(super) notes: &'a [String],
    /// The entries of the legend.
    pub(super) legend: &'a [Series],
}

/// Draws the parts around a figure; returns the remaining area: left, top, right, bottom.
pub(super) fn around(pen: &mut impl Pen, parts: &Around) -> [f64; 4] {
    let [width, height] = parts.size;
    let (mut top, mut right, mut bottom) = (MARGIN, width - MARGIN, height - MARGIN);
    if !parts.heading.is_empty() {
        for line in pen.lines(FONT + 2.0, parts.heading, width - 2.0 * MARGIN) {
            top += FONT + 5.0;
            pen.text([MARGIN, top - 4.0], Anchor::Start, FONT + 2.0, &line);
        }
        top += 10.0;
    }
    let notes: Vec<_> =
        parts.notes.iter().flat_map(|note| pen.lines(SMALL, note, width - 2.0 * MARGIN)).collect();
    for line in notes.iter().rev() {
        pen.text([MARGIN, bottom - 3.0], Anchor::Start, SMALL, line);
        bottom -= SMALL + 5.0;
    }
    if !notes.is_empty() {
        bottom -= 8.0;
    }
    if !parts.legend.is_empty() {
        let names: Vec<_> = parts.legend.iter().map(|series| joined(&series.name)).collect();
        let widest = names.iter().map(|name| pen.width(FONT - 1.0, name)).fold(0.0, f64::max);
        let room = widest.min(0.34 * width - SAMPLE).max(40.0);
        right -= room + SAMPLE + 14.0;
        let left = right + 8.0;
        let mut y = top + 30.0;
        for (series, name) in parts.legend.iter().zip(&names) {
            let lines = pen.lines(FONT - 1.0, name, room);
            line(pen, &[[left, y], [left + SAMPLE - 8.0, y]], series);
            mark(pen, [left + 0.5 * (SAMPLE - 8.0), y], series);
            for text in lines {
                pen.text(
                    [left + SAMPLE, y + 0.33 * FONT],
                    Anchor::Start,
                    FONT - 1.0,
                    &text.replace('\u{a0}', " "),
                );
                y += FONT + 3.0;
            }
            y += 7.0;
        }
        right -= 6.0;
    }
    [MARGIN, top, right, bottom]
}

/// A name with line breaks prevented between a parameter and its value, and within brackets.
fn joined(name: &str) -> String {
    let mut depth = 0i32;
    let kept = |c: char| {
        depth += i32::from(c == '(') - i32::from(c == ')');
        if depth > 0 && c == ' ' { '\u{a0}' } else { c }
    };
    name.replace(" = ", "\u{a0}=\u{a0}").chars().map(kept).collect()
}

/// Draws the line of a series.
pub(super) fn line(pen: &mut impl Pen, path: &[[f64; 2]], series: &Series) {
    if series.line != Line::None {
        pen.stroke(path, Ink::Curve(series.colour), THICK, series.line.dash());
    }
}

/// Draws the points of a series, in coordinates of the figure, clipped to an area; a cross at the bottom of
/// the area marks each non-finite point, unless another cross is close.
pub(super) fn curve(pen: &mut impl Pen, points: &[[f64; 2]], area: [f64; 4], series: &Series) {
    for run in clipped(points, area) {
        line(pen, &run, series);
    }
    let [left, top, right, bottom] = area;
    for at in points {
        if (left..=right).contains(&at[0]) && (top..=bottom).contains(&at[1]) {
            mark(pen, *at, series);
        }
    }
    let mut last = f64::NEG_INFINITY;
    for [x, _] in points.iter().filter(|p| p[0].is_finite() && !p[1].is_finite()) {
        if (x - last).abs() >= 12.0 {
            last = *x;
            cross(pen, [*x, bottom - 8.0], series.colour);
        }
    }
}

/// Draws bars, so far apart that they can be told from each other.
pub(super) fn bars(
    pen: &mut impl Pen,
    bars: impl Iterator<Item = [[f64; 2]; 2]>,
    area: [f64; 4],
    colour: usize,
) {
    /// The least distance between bars.
    const APART: f64 = 16.0;
    let mut last: Option<[f64; 2]> = None;
    for bar in bars {
        let middle = [0.5 * (bar[0][0] + bar[1][0]), 0.5 * (bar[0][1] + bar[1][1])];
        if last.is_some_and(|[x, y]| (x - middle[0]).hypot(y - middle[1]) < APART) {
            continue;
        }
        last = Some(middle);
        let length = (bar[1][0] - bar[0][0]).hypot(bar[1][1] - bar[0][1]);
        for run in clipped(&bar, area) {
            pen.stroke(&run, Ink::Curve(colour), 1.0, &[]);
        }
        // The ends, across the bar.
        let across = [0, 1].map(|i| 3.0 * (bar[1][1 - i] - bar[0][1 - i]) / length.max(1e-9));
        for [x, y] in bar {
            let end = [[x - across[0], y + across[1]], [x + across[0], y - across[1]]];
            clipped(&end, area).iter().for_each(|run| pen.stroke(run, Ink::Curve(colour), 1.0, &[]));
        }
    }
}

/// A cross.
pub(super) fn cross(pen: &mut impl Pen, [x, y]: [f64; 2], colour: usize) {
    for turn in [-1.0, 1.0] {
        pen.stroke(&[[x - 4.0, y - 4.0 * turn], [x + 4.0, y + 4.0 * turn]], Ink::Curve(colour), THICK, &[]);
    }
}

/// Draws a marker.
pub(super) fn mark(pen: &mut impl Pen, at: [f64; 2], series: &Series) {
    let [x, y] = at;
    let ink = Ink::Curve(series.colour);
    match series.mark {
        Mark::None => {}
        Mark::Disc => pen.fill(&circle(at, 3.5), ink),
        Mark::Ring => pen.stroke(&circle(at, 4.0), ink, THICK, &[]),
        Mark::Triangle => pen.fill(&[[x, y - 5.0], [x - 5.0, y + 4.0], [x + 5.0, y + 4.0]], ink),
        Mark::Square => {
            pen.fill(&[[x - 3.5, y - 3.5], [x + 3.5, y - 3.5], [x + 3.5, y + 3.5], [x - 3.5, y + 3.5]], ink);
        }
        Mark::Cross => cross(pen, at, series.colour),
    }
}

/// The left edge of text.
pub(super) fn text_left() -> f64 {
    MARGIN
}
