//! A plot: curves with their shared settings, as a figure.

use std::io;

use super::{
    Channel, Curve, Form, Kind, Setup, Slice,
    angles::from_surface,
    draw::{Axis, COLOURS, Figure, Line, Mark, Plot, Polar, SIDE, Series, Slices, Tile},
    slice::LOG_RANGE,
};
use crate::{
    picture::png::{About, encode},
    text::capitalised,
};

/// The remark on curves of smooth surfaces.
const UNSPREAD: &str = "a smooth surface sends light on in single directions, where f has no finite value; the albedo \
                        counts what is mirrored.";

/// Curves or slices of one kind, with display settings.
#[derive(Clone, Debug, PartialEq)]
pub struct Sheet {
    /// The quantity and the angles.
    pub setup: Setup,
    /// The displayed channel; by default luminance for curves, and colour for slices.
    pub channel: Option<Channel>,
    /// True for a logarithmic axis.
    pub log: bool,
    /// The curves.
    pub curves: Vec<Curve>,
    /// The slices, where a quantity is [shown so](Form::Slices).
    pub slices: Vec<Slice>,
    /// The colour and the dash of each curve; by default, those that follow from its position in the list.
    pub styles: Vec<Style>,
}

/// The colour and the dash of a curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Style {
    /// The colour, counted from 0 in [`COLOURS`].
    pub colour: usize,
    /// The dash.
    pub line: Line,
}

impl Style {
    /// The n-th style. With six colours and eight dashes there are 24 different ones.
    #[must_use]
    pub fn nth(n: usize) -> Self {
        Self { colour: n % COLOURS.len(), line: Line::ALL[n % Line::ALL.len()] }
    }
}

/// Maximum number of decades of a logarithmic axis.
const DECADES: f64 = 6.0;

impl Sheet {
    /// A plot without curves.
    #[must_use]
    pub fn new(setup: Setup) -> Self {
        Self { setup, channel: None, log: false, curves: Vec::new(), slices: Vec::new(), styles: Vec::new() }
    }

    /// The displayed value of a point.
    #[must_use]
    pub fn value(&self, rgb: glam::Vec3) -> f64 {
        self.channel.unwrap_or(Channel::Luminance).of(rgb)
    }

    /// Remarks on non-finite values, and on values that the figure cannot show.
    #[must_use]
    pub fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        for curve in &self.curves {
            if let Some(missing) = curve.missing() {
                notes.push(format!("{}: {missing}, where the curve has a gap.", curve.name));
            }
            if !curve.sigma.is_empty() {
                notes.push(format!("{}: bars are the standard uncertainty σ, up and down.", curve.name));
            }
            if curve.sharp {
                notes.push(format!("{}: {UNSPREAD}", curve.name));
            }
            let mut values = curve.points.iter().map(|p| self.value(p.rgb)).filter(|v| v.is_finite());
            let what = if self.log && values.clone().any(|v| v < 0.0) {
                "negative values have"
            } else if self.log && values.clone().next().is_some() && !values.any(|v| v > 0.0) {
                "every value is 0, which has"
            } else {
                continue;
            };
            notes.push(format!("{}: {what} no place on a logarithmic axis.", curve.name));
        }
        for slice in &self.slices {
            let (n, all) = (slice.missing(), slice.values.len());
            if n > 0 {
                let what = format!("{n} of {all} values are not finite numbers (magenta and black).");
                notes.push(format!("{}: {what}", slice.name));
            }
        }
        notes
    }

    /// The heading: the quantity, the light, the channel.
    #[must_use]
    pub fn heading(&self) -> String {
        let Setup { kind, theta_i, phi_i } = self.setup;
        let name = kind.declaration().heading.unwrap_or(kind.name());
        // Both sides of a surface together: a bidirectional scattering distribution function.
        let mut words = if self.is_around() { name.replace("BRDF", "BSDF") } else { name.to_owned() };
        words = capitalised(&words);
        if kind.declaration().has_light {
            words += &format!(" in the plane of incidence, light at {theta_i}°");
        }
        if self.curves.iter().any(|curve| curve.reflected) {
            words += ", reflected light only";
        }
        if phi_i != 0.0 && kind.declaration().has_azimuth {
            words += &format!(", azimuth {phi_i}°");
        }
        match self.channel {
            _ if kind.declaration().is_scalar => {}
            Some(channel) => words += &format!(", {}", channel.name()),
            None if self.is_coloured() => words += ", luminance",
            None => {}
        }
        words
    }

    /// True if the channels of some curve differ, so the choice of a channel matters.
    fn is_coloured(&self) -> bool {
        let grey = |rgb: &glam::Vec3| rgb.x == rgb.y && rgb.y == rgb.z || !rgb.is_finite();
        self.curves.iter().flat_map(|curve| &curve.points).any(|p| !grey(&p.rgb))
    }

    /// True if a curve goes on behind the surface.
    fn is_around(&self) -> bool {
        self.curves.iter().flat_map(|curve| &curve.points).any(|point| point.angle.abs() > 90.0)
    }

    /// The figure.
    #[must_use]
    pub fn figure(&self) -> Figure {
        let heading = self.heading();
        let form = self.setup.kind.declaration().form;
        let names: Vec<_> = match form {
            Form::Slices => self.slices.iter().map(|s| s.name.as_str()).collect(),
            Form::Plot | Form::Polar => self.curves.iter().map(|c| c.name.as_str()).collect(),
        };
        let title = format!("{heading}: {}", names.join("; "));
        match form {
            Form::Slices => Figure::Slices(self.tiles(heading, title)),
            Form::Polar => Figure::Polar(Polar {
                title,
                heading,
                radius: self.axis(true),
                series: self.series(),
                light: self.setup.theta_i,
                around: self.is_around(),
                size: (960, if self.is_around() { 760 } else { 500 }),
                legend: true,
                notes: self.notes(),
            }),
            Form::Plot => {
                let horizontal = self.setup.kind.declaration().horizontal;
                let x = if self.is_around() {
                    let name = format!("{}, beyond 90° behind the surface", horizontal.name);
                    Axis::new(&name, -180.0, 180.0, 9)
                } else {
                    let (from, to) = horizontal.ends;
                    Axis::new(horizontal.name, from, to, 7)
                };
                let y = self.axis(false);
                let mut notes = self.notes();
                notes.extend(self.beyond(&y));
                Figure::Plot(Plot { title, heading, x, y, series: self.series(), notes, ..Plot::default() })
            }
        }
    }

    /// The figure as the bytes of a PNG file.
    ///
    /// # Errors
    /// Returns an error if the picture is too large to be encoded.
    pub fn png(&self) -> io::Result<Vec<u8>> {
        let picture = self.figure().picture();
        let mut bytes = Vec::new();
        let about = About::program().with("Title", self.heading());
        encode(&mut bytes, picture.size[0], picture.size[1], &picture.rgb8, &about)?;
        Ok(bytes)
    }

    /// Remarks on values beyond the axis.
    fn beyond(&self, axis: &Axis) -> Vec<String> {
        let largest = |curve: &Curve| {
            let values = curve.points.iter().map(|p| self.value(p.rgb));
            values.filter(|v| v.is_finite()).fold(f64::NEG_INFINITY, f64::max)
        };
        let over = |curve: &&Curve| largest(curve) > axis.to * 1.001;
        let note = |curve: &Curve| {
            format!("{} rises to {:.3} at grazing angles, beyond the plot.", curve.name, largest(curve))
        };
        self.curves.iter().filter(over).map(note).collect()
    }

    fn tiles(&self, heading: String, title: String) -> Slices {
        let tiles: Vec<_> = self
            .slices
            .iter()
            .map(|s| Tile { name: s.name.clone(), side: s.side, rgb8: s.rgb8(self.channel, self.log) })
            .collect();
        let all: usize = self.slices.iter().map(|s| s.values.len()).sum();
        let clipped: usize = self.slices.iter().map(|s| s.clipped(self.channel)).sum();
        let mut notes = vec![if self.log {
            let range = 10f32.powf(LOG_RANGE);
            format!("π f, logarithmic: {} is black, 1 is grey, {range} is white.", 1.0 / range)
        } else {
            let part = 100.0 * clipped as f64 / all.max(1) as f64;
            let digits = if part < 10.0 { 1 } else { 0 };
            match clipped {
                0 => "π f in sRGB: 1 is white.".to_owned(),
                _ => format!("π f in sRGB: 1 is white; {part:.digits$} % of the pixels would be brighter."),
            }
        }];
        notes.extend(self.notes());
        let columns = Slices::columns_of(tiles.len());
        Slices { title, heading, tiles, side: SIDE, columns, notes }
    }

    /// The series of the curves: each with its own colour and dash, and black for measured data.
    fn series(&self) -> Vec<Series> {
        let marks = [Mark::Ring, Mark::Square, Mark::Triangle, Mark::Cross];
        let (mut lines, mut measured) = (0, 0);
        let each = |(i, curve): (usize, &Curve)| {
            let points: Vec<_> = curve.points.iter().map(|p| (p.angle, self.value(p.rgb))).collect();
            let bars =
                points.iter().zip(&curve.sigma).map(|((_, v), sigma)| (v - sigma, v + sigma)).collect();
            let (colour, line, mark) = if curve.measured {
                measured += 1;
                (6, Line::None, marks[(measured - 1) % marks.len()])
            } else {
                lines += 1;
                let Style { colour, line } =
                    self.styles.get(i).copied().unwrap_or_else(|| Style::nth(lines - 1));
                (colour, line, Mark::None)
            };
            Series { name: curve.name.clone(), points, bars, colour, line, mark }
        };
        self.curves.iter().enumerate().map(each).collect()
    }

    /// The largest angle whose values must fit on the axis. Some models rise without limit towards grazing
    /// angles, and the last degree must not flatten the rest of a curve.
    fn limit(&self) -> f64 {
        let Setup { kind, theta_i, .. } = self.setup;
        if (kind.declaration().rises)(theta_i) { 86.0 } else { 90.0 }
    }

    /// The axis of the values, wide enough for those up to the limit.
    fn axis(&self, from_centre: bool) -> Axis {
        let limit = if from_centre || self.log { 90.0 } else { self.limit() };
        let points = self.curves.iter().flat_map(|curve| &curve.points);
        let shown = points.filter(|p| from_surface(p.angle) <= limit);
        let mut values: Vec<_> = shown.map(|p| self.value(p.rgb)).filter(|v| v.is_finite()).collect();
        let ends = self.curves.iter().flat_map(|curve| curve.points.iter().zip(&curve.sigma));
        let ends = ends.filter(|(p, _)| from_surface(p.angle) <= limit);
        values.extend(ends.map(|(p, sigma)| self.value(p.rgb) + sigma).filter(|v| v.is_finite()));
        span(self.setup.kind, self.log, from_centre, &values)
    }
}

/// An axis of the quantity, wide enough for the finite values; `from_centre` leaves no room for negative
/// values.
pub(super) fn span(kind: Kind, log: bool, from_centre: bool, values: &[f64]) -> Axis {
    let top = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if log {
        let least = values.iter().copied().filter(|v| *v > 0.0).fold(f64::INFINITY, f64::min);
        if !least.is_finite() {
            return Axis::log(kind.declaration().quantity, 0.001, 1.0);
        }
        let to = round_up(top, &[1.0, 2.0, 5.0, 10.0]);
        let from = least.max(to / 10f64.powf(DECADES)).min(to / 10.0);
        return Axis::log(kind.declaration().quantity, 10f64.powf((from.log10() + 1e-9).floor()), to);
    }
    let whole = kind.declaration().up_to_one;
    let steps = [1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0];
    let to = match () {
        () if whole => top.max(1.0),
        () if top > 0.0 => top,
        () => 1.0,
    };
    let to = if to <= 1.0 && whole { 1.0 } else { round_up(to, &steps) };
    let bottom = values.iter().copied().fold(0.0, f64::min);
    let from = if bottom < 0.0 && !from_centre { -round_up(-bottom, &steps) } else { 0.0 };
    Axis::new(kind.declaration().quantity, from, to, 6)
}

/// The next larger number that is one of the steps times a power of ten.
fn round_up(v: f64, steps: &[f64]) -> f64 {
    let power = 10f64.powf(v.log10().floor());
    let found = steps.iter().map(|s| s * power).find(|s| *s >= v * (1.0 - 1e-9));
    found.unwrap_or(10.0 * power)
}
