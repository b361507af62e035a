//! Plots as SVG.
//!
//! Series differ in colour (M. Okabe, K. Ito 2008, *Color Universal Design*), in dash and in marker, so they remain
//! distinguishable without colour. Text and axes use a colour that the page replaces by its own, so plots follow light
//! and dark pages.

use plotters::{
    prelude::*,
    style::text_anchor::{HPos, Pos, VPos},
};

/// A stand-in for the page's text colour.
pub const INK: RGBColor = RGBColor(1, 2, 3);
/// A stand-in for the page's colour of thin lines.
pub const GRID: RGBColor = RGBColor(4, 5, 6);
/// Okabe and Ito's colours except yellow, which is too light on white; black is [`INK`].
const COLOURS: [RGBColor; 7] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    INK,
];

/// An axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Its quantity, with its unit.
    pub label: String,
    /// Smallest value.
    pub from: f64,
    /// Largest value.
    pub to: f64,
    /// True if it is logarithmic.
    pub log: bool,
    /// The approximate number of labels.
    pub ticks: usize,
}

/// The line between the points of a series.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Line {
    /// Without a gap.
    Solid,
    /// By dashes.
    Dashed,
    /// By dots.
    Dotted,
    /// Not at all.
    None,
}

/// The mark at each point of a series.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// Nothing.
    None,
    /// A filled circle.
    Disc,
    /// A circle.
    Ring,
    /// A filled triangle.
    Triangle,
    /// A cross.
    Cross,
    /// A square.
    Square,
}

/// Points that belong together.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Its name in the legend.
    pub name: String,
    /// Its points.
    pub points: Vec<(f64, f64)>,
    /// Its colour, counted from 0; 6 is the text colour.
    pub colour: usize,
    /// The line between them.
    pub line: Line,
    /// The mark at each of them.
    pub mark: Mark,
}

/// A plot.
#[derive(Clone, Debug, PartialEq)]
pub struct Plot {
    /// Its content, for screen readers.
    pub title: String,
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// The curves.
    pub series: Vec<Series>,
    /// Width and height.
    pub size: (u32, u32),
    /// True if it has a legend, at the right.
    pub legend: bool,
}

const LEGEND: i32 = 232;
const FONT: i32 = 19;

impl Axis {
    /// An axis with equal steps.
    #[must_use]
    pub fn new(label: &str, from: f64, to: f64, ticks: usize) -> Self {
        Self { label: label.to_owned(), from, to, log: false, ticks }
    }

    /// An axis with equal factors.
    #[must_use]
    pub fn log(label: &str, from: f64, to: f64) -> Self {
        let ticks = (to.log10() - from.log10()).ceil() as usize + 1;
        Self { label: label.to_owned(), from, to, log: true, ticks }
    }

    fn place(&self, v: f64) -> f64 {
        if self.log { v.max(1e-30).log10() } else { v }
    }

    fn range(&self) -> std::ops::Range<f64> {
        self.place(self.from)..self.place(self.to)
    }

    /// The label at a place of the axis.
    fn text(&self, at: f64) -> String {
        if !self.log {
            let step = (self.to - self.from) / self.ticks.max(1) as f64;
            let digits = if step >= 1.0 {
                0
            } else if step >= 0.1 {
                1
            } else {
                2
            };
            return format!("{:.digits$}", at + 0.0).replace('-', "−");
        }
        if (at - at.round()).abs() > 1e-6 {
            return String::new();
        }
        let power = at.round() as i32;
        if (-2..=3).contains(&power) {
            return format!("{}", 10f64.powi(power));
        }
        let superscript = |c: char| match c {
            '-' => '⁻',
            _ => c.to_digit(10).map_or(c, |d| ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'][d as usize]),
        };
        format!("10{}", power.to_string().chars().map(superscript).collect::<String>())
    }
}

impl Plot {
    /// The plot as an `<svg>` element.
    ///
    /// # Errors
    /// The message of the library.
    pub fn svg(&self) -> Result<String, String> {
        let mut text = String::new();
        self.draw(&mut text)?;
        // In a page, and named.
        let start = text.find("<svg").ok_or("there is no <svg>")?;
        let title = self.title.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;");
        Ok(text[start..].replacen("<svg", &format!("<svg role=\"img\" aria-label=\"{title}\""), 1))
    }

    fn draw(&self, to: &mut String) -> Result<(), String> {
        let root = SVGBackend::with_string(to, self.size).into_drawing_area();
        let (width, height) = (self.size.0 as i32, self.size.1 as i32);
        let (area, _) = root.split_horizontally(if self.legend { width - LEGEND } else { width });
        let mut chart = ChartBuilder::on(&area)
            .margin_top(10)
            .margin_right(14)
            .x_label_area_size(56)
            .y_label_area_size(74)
            .build_cartesian_2d(self.x.range(), self.y.range())
            .map_err(said)?;
        let font = |size: i32| ("sans-serif", size).into_font().color(&INK);
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(GRID)
            .axis_style(INK)
            .x_labels(self.x.ticks)
            .y_labels(self.y.ticks)
            .x_label_formatter(&|v| self.x.text(*v))
            .y_label_formatter(&|v| self.y.text(*v))
            .x_desc(&self.x.label)
            .y_desc(&self.y.label)
            .label_style(font(FONT))
            .axis_desc_style(font(FONT))
            .draw()
            .map_err(said)?;
        let inside = |p: &(f64, f64)| p.0.is_finite() && p.1.is_finite();
        for series in &self.series {
            let colour = COLOURS[series.colour % COLOURS.len()];
            let points: Vec<(f64, f64)> = series
                .points
                .iter()
                .map(|(x, y)| {
                    (self.x.place(*x), self.y.place(*y).clamp(self.y.range().start, self.y.range().end))
                })
                .filter(inside)
                .collect();
            let stroke = colour.stroke_width(2);
            match series.line {
                Line::Solid => {
                    chart.draw_series(LineSeries::new(points.iter().copied(), stroke)).map_err(said)?;
                }
                Line::Dashed => {
                    chart
                        .draw_series(DashedLineSeries::new(points.iter().copied(), 8, 5, stroke))
                        .map_err(said)?;
                }
                Line::Dotted => {
                    chart
                        .draw_series(DashedLineSeries::new(points.iter().copied(), 2, 4, stroke))
                        .map_err(said)?;
                }
                Line::None => {}
            }
            for p in &points {
                mark(&root, chart.backend_coord(p), series.mark, colour)?;
            }
        }
        if self.legend {
            self.key(&root, width - LEGEND, height)?;
        }
        root.present().map_err(said)
    }

    /// The legend.
    fn key(&self, root: &Canvas, left: i32, height: i32) -> Result<(), String> {
        let row = 27;
        let top = ((height - 46 - row * self.series.len() as i32) / 2).max(12);
        for (i, series) in self.series.iter().enumerate() {
            let y = top + row * i as i32;
            let colour = COLOURS[series.colour % COLOURS.len()];
            let (dash, gap) = match series.line {
                Line::Solid => (30, 0),
                Line::Dashed => (8, 5),
                Line::Dotted => (2, 4),
                Line::None => (0, 40),
            };
            let mut x = 2;
            while x < 32 && dash > 0 {
                let end = (x + dash).min(32);
                root.draw(&PathElement::new(vec![(left + x, y), (left + end, y)], colour.stroke_width(2)))
                    .map_err(said)?;
                x = end + gap;
            }
            mark(root, (left + 17, y), series.mark, colour)?;
            let style =
                ("sans-serif", FONT - 2).into_font().color(&INK).pos(Pos::new(HPos::Left, VPos::Center));
            root.draw(&Text::new(series.name.clone(), (left + 40, y), style)).map_err(said)?;
        }
        Ok(())
    }
}

type Canvas<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;

/// The message of a library.
fn said(error: impl std::fmt::Display) -> String {
    error.to_string()
}

/// Draws a marker.
fn mark(to: &Canvas, (x, y): (i32, i32), mark: Mark, colour: RGBColor) -> Result<(), String> {
    match mark {
        Mark::None => {}
        Mark::Disc => to.draw(&Circle::new((x, y), 3, colour.filled())).map_err(said)?,
        Mark::Ring => to.draw(&Circle::new((x, y), 4, colour.stroke_width(2))).map_err(said)?,
        Mark::Triangle => to.draw(&TriangleMarker::new((x, y), 5, colour.filled())).map_err(said)?,
        Mark::Square => {
            to.draw(&Rectangle::new([(x - 3, y - 3), (x + 3, y + 3)], colour.filled())).map_err(said)?
        }
        Mark::Cross => {
            for (from, to_) in [((x - 4, y - 4), (x + 4, y + 4)), ((x - 4, y + 4), (x + 4, y - 4))] {
                to.draw(&PathElement::new(vec![from, to_], colour.stroke_width(2))).map_err(said)?;
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plot(log: bool) -> Plot {
        let y = if log { Axis::log("f (sr⁻¹)", 0.001, 10.0) } else { Axis::new("E", 0.0, 1.0, 5) };
        let mut marks =
            [Mark::None, Mark::Disc, Mark::Ring, Mark::Triangle, Mark::Cross, Mark::Square].into_iter();
        let series =
            [Line::Solid, Line::Dashed, Line::Dotted, Line::None].into_iter().enumerate().map(|(i, line)| {
                Series {
                    name: format!("a < b & {i}"),
                    points: (1..20u8)
                        .map(|x| (f64::from(x), 0.05 * f64::from(x)))
                        .chain([(5.0, f64::NAN)])
                        .collect(),
                    colour: i,
                    line,
                    mark: marks.next().unwrap_or(Mark::None),
                }
            });
        Plot {
            title: "a \"test\" & more".to_owned(),
            x: Axis::new("θ (°)", 0.0, 90.0, 7),
            y,
            series: series.collect(),
            size: (720, 360),
            legend: true,
        }
    }

    /// The names of elements, each closed as it was opened, or what is wrong.
    fn elements(xml: &str) -> Result<Vec<String>, String> {
        let (mut open, mut all) = (Vec::new(), Vec::new());
        let mut rest = xml;
        while let Some(start) = rest.find('<') {
            let inside = &rest[start + 1..];
            let end = inside.find('>').ok_or("an element does not end")?;
            let tag = &inside[..end];
            if tag.contains('<') || tag.matches('"').count() % 2 == 1 {
                return Err(format!("<{tag}> is no element"));
            }
            if let Some(name) = tag.strip_prefix('/') {
                if open.pop().as_deref() != Some(name) {
                    return Err(format!("</{name}> closes nothing"));
                }
            } else {
                let name: String = tag.split([' ', '/', '\n']).next().unwrap_or_default().to_owned();
                all.push(name.clone());
                if !tag.ends_with('/') {
                    open.push(name);
                }
            }
            rest = &inside[end + 1..];
        }
        if open.is_empty() { Ok(all) } else { Err(format!("{open:?} stays open")) }
    }

    #[test]
    fn plots_are_sound_and_show_every_series() {
        for log in [false, true] {
            let svg = plot(log).svg().expect("can be drawn");
            let names = elements(&svg).unwrap_or_else(|e| panic!("{e}\n{svg}"));
            assert_eq!(names[0], "svg");
            assert!(names.iter().filter(|n| *n == "polyline").count() > 3, "{names:?}");
            assert!(!svg.contains("NaN") && svg.contains("a &lt; b &amp; 3") && svg.contains("θ (°)"));
            assert!(svg.contains("aria-label=\"a &quot;test&quot; &amp; more\""));
        }
        assert!(elements("<svg><g></svg>").is_err() && elements("<svg a=\"1></svg>").is_err());
    }

    #[test]
    fn logarithmic_axes_are_labelled_at_powers_of_ten_only() {
        let axis = Axis::log("f", 1e-4, 1e4);
        assert_eq!(
            ["0.01", "1", "1000", "10⁻⁴", "10⁴", ""],
            [-2.0, 0.0, 3.0, -4.0, 4.0, 0.5].map(|x| axis.text(x))
        );
        assert_eq!(Axis::new("θ", -90.0, 90.0, 6).text(-30.0), "−30");
    }
}
