//! Polar plots: the length of the ray to each direction in a plane is the value there.

use super::{
    Axis, Ground, Series,
    layout::{self, Around, FONT},
    pen::{Anchor, Ink, Pen, arc, clipped},
    size,
};

/// A polar plot of the half plane above a surface, or of both half planes.
#[derive(Clone, Debug, PartialEq)]
pub struct Polar {
    /// The content, for screen readers.
    pub title: String,
    /// The line above the plot.
    pub heading: String,
    /// The scale of the radius, from the centre.
    pub radius: Axis,
    /// The curves: angles from the normal in degrees, positive to the right, and values.
    pub series: Vec<Series>,
    /// The angle between the light, at the left, and the normal, degrees.
    pub light: f64,
    /// True if the half plane below the surface is shown too.
    pub around: bool,
    /// Width and height.
    pub size: (u32, u32),
    /// True if the plot has a legend, at the right.
    pub legend: bool,
    /// Remarks below the plot.
    pub notes: Vec<String>,
}

/// Draws a plot.
pub(super) fn draw(plot: &Polar, pen: &mut impl Pen) -> Ground {
    let legend: &[_] = if plot.legend { &plot.series } else { &[] };
    let parts = Around { size: size(plot.size), heading: &plot.heading, notes: &plot.notes, legend };
    let [left, top, right, bottom] = layout::around(pen, &parts);
    let bottom = bottom - 2.0 * FONT - 16.0;
    // Below the surface there is room for labels as above it.
    let below = if plot.around { 0.5 * (bottom - top) + 0.2 * FONT } else { 0.0 };
    let [centre, floor] = [0.5 * (left + right), bottom - below];
    let named = named(plot.light);
    // Labels at the sides need room outside the circle.
    let sideways = |(angle, name): &(f64, String)| {
        let room = 0.5 * (right - left) - 0.8 * FONT - pen.width(FONT - 2.0, name);
        room / angle.to_radians().sin().abs().max(0.1)
    };
    let room = named.iter().map(sideways).fold(0.5 * (right - left) - 2.0 * FONT, f64::min);
    let full = room.min(floor - top - 2.2 * FONT).max(20.0);
    let most = if plot.around { 180.0 } else { 90.0 };
    let at = |angle: f64, radius: f64| {
        let (sin, cos) = angle.to_radians().sin_cos();
        [centre + radius * sin, floor - radius * cos]
    };
    let mut free = f64::NEG_INFINITY;
    for (value, label) in plot.radius.marks() {
        let r = full * plot.radius.place(value);
        if label.is_empty() || r > full + 0.5 {
            continue;
        }
        pen.stroke(&arc([centre, floor], r, -most, most), Ink::Grid, 1.0, &[]);
        let half = 0.5 * pen.width(FONT - 2.0, &label);
        if centre + r - half > free {
            pen.text([centre + r, floor + FONT + 3.0], Anchor::Middle, FONT - 2.0, &label);
            free = centre + r + half + 5.0;
        }
    }
    for angle in (-5..=6).map(|i| 30.0 * f64::from(i)).filter(|angle| angle.abs() <= most) {
        pen.stroke(&[at(angle, 0.0), at(angle, full)], Ink::Grid, 1.0, &[]);
        if (angle.abs() - 90.0).abs() > 5.0 && named.iter().all(|(other, _)| (other - angle).abs() > 12.0) {
            label(pen, at(angle, full + 0.7 * FONT), angle, &format!("{:.0}°", angle.abs()));
        }
    }
    pen.stroke(&arc([centre, floor], full, -most, most), Ink::Grid, 1.0, &[]);
    pen.stroke(&[[centre - full - FONT, floor], [centre + full + FONT, floor]], Ink::Text, 1.5, &[]);
    pen.text([centre, bottom + 2.0 * FONT + 13.0], Anchor::Middle, FONT, &plot.radius.label);
    for (angle, name) in &named {
        label(pen, at(*angle, full + 0.7 * FONT), *angle, name);
    }
    if named.len() > 1 {
        pen.stroke(&[at(plot.light, 0.0), at(plot.light, full)], Ink::Text, 1.0, &[3.0, 4.0]);
    }
    let from = -plot.light;
    pen.stroke(&[at(from, full), at(from, 0.0)], Ink::Text, 1.5, &[]);
    let tip = at(from, 0.55 * full);
    let wing = |turn: f64| {
        let (sin, cos) = (from + turn).to_radians().sin_cos();
        [tip[0] + 14.0 * sin, tip[1] - 14.0 * cos]
    };
    pen.fill(&[tip, wing(18.0), wing(-18.0)], Ink::Text);
    let area = [left, top, right, bottom];
    for (i, series) in plot.series.iter().enumerate() {
        pen.series(Some(i));
        let part = |value: f64| full * plot.radius.place(value).max(0.0);
        let bars = series.points.iter().zip(&series.bars);
        let bars = bars.map(|((angle, _), (low, high))| [at(*angle, part(*low)), at(*angle, part(*high))]);
        layout::bars(pen, bars, area, series.colour);
        let mut last = f64::NEG_INFINITY;
        let mut points = Vec::new();
        for (angle, value) in &series.points {
            let part = plot.radius.place(*value);
            // Values below the scale are at the centre.
            points.push(at(*angle, full * if part < 0.0 { 0.0 } else { part }));
            if !value.is_finite() && (angle - last).abs() > 2.0 {
                last = *angle;
                layout::cross(pen, at(*angle, full - 8.0), series.colour);
            }
        }
        for run in clipped(&points, area) {
            layout::line(pen, &run, series);
        }
        for point in points.iter().filter(|p| p[1] >= top && p[0] >= left && p[0] <= right) {
            layout::mark(pen, *point, series);
        }
    }
    pen.series(None);
    Ground::Polar { centre: [centre, floor], radius: full, around: plot.around }
}

/// The labels of light and mirror direction with their angles; a single label if two would overlap.
fn named(light: f64) -> Vec<(f64, String)> {
    let degrees = format!("{}°", (light * 10.0).round() / 10.0);
    if light < 6.0 {
        return vec![(-light, format!("light {degrees}"))];
    }
    vec![(-light, format!("light {degrees}")), (light, format!("mirror {degrees}"))]
}

/// A label outside the circle.
fn label(pen: &mut impl Pen, [x, y]: [f64; 2], angle: f64, text: &str) {
    let anchor = match angle.to_radians().sin() {
        sine if sine < -0.2 => Anchor::End,
        sine if sine > 0.2 => Anchor::Start,
        _ => Anchor::Middle,
    };
    pen.text([x, y + 0.2 * FONT], anchor, FONT - 2.0, text);
}
