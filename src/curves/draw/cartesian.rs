//! Plots with two axes.

use super::{
    Ground, Plot,
    layout::{self, Around, FONT},
    pen::{Anchor, Ink, Pen},
    size,
};

/// Draws a plot.
pub(super) fn draw(plot: &Plot, pen: &mut impl Pen) -> Ground {
    let legend: &[_] = if plot.legend { &plot.series } else { &[] };
    let parts = Around { size: size(plot.size), heading: &plot.heading, notes: &plot.notes, legend };
    let [left, top, right, bottom] = layout::around(pen, &parts);
    let (across, up) = (plot.x.marks(), plot.y.marks());
    let widest = up.iter().map(|(_, label)| pen.width(FONT - 1.0, label)).fold(0.0, f64::max);
    // The label of the vertical axis is above it, where it can be read without turning the head.
    let label_top = top;
    let [left, top, bottom] = [left + widest + 8.0, top + FONT + 14.0, bottom - 2.0 * FONT - 16.0];
    let x = |v: f64| left + plot.x.place(v) * (right - left);
    let y = |v: f64| bottom - plot.y.place(v) * (bottom - top);
    for (value, label) in &up {
        let at = y(*value);
        if label.is_empty() {
            pen.stroke(&[[left, at], [left + 4.0, at]], Ink::Text, 1.0, &[]);
        } else {
            pen.stroke(&[[left, at], [right, at]], Ink::Grid, 1.0, &[]);
            pen.text([left - 7.0, at + 0.33 * FONT], Anchor::End, FONT - 1.0, label);
        }
    }
    for (value, label) in &across {
        let at = x(*value);
        pen.stroke(&[[at, top], [at, bottom]], Ink::Grid, 1.0, &[]);
        pen.stroke(&[[at, bottom], [at, bottom + 5.0]], Ink::Text, 1.0, &[]);
        pen.text([at, bottom + 7.0 + FONT], Anchor::Middle, FONT - 1.0, label);
    }
    if plot.y.from < 0.0 && plot.y.to > 0.0 && !plot.y.log {
        pen.stroke(&[[left, y(0.0)], [right, y(0.0)]], Ink::Text, 1.0, &[]);
    }
    pen.stroke(&[[left, top], [left, bottom], [right, bottom]], Ink::Text, 1.0, &[]);
    pen.text([layout::text_left(), label_top + FONT], Anchor::Start, FONT, &plot.y.label);
    pen.text([0.5 * (left + right), bottom + 2.0 * FONT + 13.0], Anchor::Middle, FONT, &plot.x.label);
    for (i, series) in plot.series.iter().enumerate() {
        pen.series(Some(i));
        let points: Vec<_> = series.points.iter().map(|p| [x(p.0), y(p.1)]).collect();
        let bars = series
            .points
            .iter()
            .zip(&series.bars)
            .map(|(p, (low, high))| [[x(p.0), y(*low)], [x(p.0), y(*high)]]);
        layout::bars(pen, bars, [left, top, right, bottom], series.colour);
        layout::curve(pen, &points, [left, top, right, bottom], series);
    }
    pen.series(None);
    Ground::Plot([left, top, right, bottom])
}
