//! Figures: plots with two axes, polar plots and image slices, as SVG and as pictures.
//!
//! Series differ in colour (M. Okabe, K. Ito 2008, *Color Universal Design*), in dash and in marker, so they remain
//! distinguishable without colour. In a page, text and axes use colours that its style sheet replaces by its own, so
//! plots follow light and dark pages.

mod axis;
mod bitmap;
mod cartesian;
mod layout;
mod pen;
mod polar;
mod slices;
mod svg;

pub use axis::Axis;
pub use pen::{Anchor, COLOURS, Ink, Pen};
pub use polar::Polar;
pub use slices::{GAP, SIDE, Slices, Tile};

use bitmap::Bitmap;
use svg::{Place, Svg};

use crate::declared::{texts, with_defaults};

/// The colour of text and axes in stand-alone figures.
const INK: [u8; 3] = [28, 29, 31];
/// The colour of grid lines behind the curves.
const GRID: [u8; 3] = [222, 222, 218];

texts! {
    /// The line between the points of a series.
    Line(
        /// The line in words.
        name
    ) {
        /// A solid line.
        Solid = "solid",
        /// Dashes.
        Dashed = "dashed",
        /// Dots.
        Dotted = "dotted",
        /// Alternating dashes and dots.
        DashDot = "dash and dot",
        /// Long dashes.
        LongDashed = "long dashes",
        /// Alternating dashes and pairs of dots.
        DashDotDot = "dash and two dots",
        /// Alternating long and short dashes.
        LongShort = "long and short dashes",
        /// Short dashes close together.
        ShortDashed = "short dashes",
        /// No line.
        None = "none",
    }
}

impl Line {
    /// All lines, the plainest first.
    pub const ALL: [Self; 8] = [
        Self::Solid,
        Self::Dashed,
        Self::Dotted,
        Self::DashDot,
        Self::LongDashed,
        Self::DashDotDot,
        Self::LongShort,
        Self::ShortDashed,
    ];

    /// The lengths of dashes and gaps; empty for a solid line.
    #[must_use]
    pub fn dash(self) -> &'static [f64] {
        match self {
            Self::Solid | Self::None => &[],
            Self::Dashed => &[8.0, 5.0],
            Self::Dotted => &[2.0, 4.0],
            Self::DashDot => &[10.0, 4.0, 2.0, 4.0],
            Self::LongDashed => &[16.0, 6.0],
            Self::DashDotDot => &[10.0, 4.0, 2.0, 3.0, 2.0, 4.0],
            Self::LongShort => &[16.0, 4.0, 5.0, 4.0],
            Self::ShortDashed => &[4.0, 3.0],
        }
    }
}

/// The mark at each point of a series.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// No mark.
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
    /// Name in the legend.
    pub name: String,
    /// Points. A point that is not finite makes a gap in the line, with crosses at the edge of the plot.
    pub points: Vec<(f64, f64)>,
    /// The ends of a bar at each point, such as its uncertainty; empty without bars.
    pub bars: Vec<(f64, f64)>,
    /// Colour, counted from 0; 6 is the text colour.
    pub colour: usize,
    /// The line between the points.
    pub line: Line,
    /// The mark at each point.
    pub mark: Mark,
}

with_defaults! {
    /// A plot with two axes.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Plot {
        /// The content, for screen readers.
        pub title: String = String::new(),
        /// The line above the plot; often empty if there is a caption below.
        pub heading: String = String::new(),
        /// The horizontal axis.
        pub x: Axis = Axis::new("", 0.0, 1.0, 6),
        /// The vertical axis.
        pub y: Axis = Axis::new("", 0.0, 1.0, 6),
        /// The curves.
        pub series: Vec<Series> = Vec::new(),
        /// Width and height.
        pub size: (u32, u32) = (960, 600),
        /// True if the plot has a legend, at the right.
        pub legend: bool = true,
        /// Remarks below the plot.
        pub notes: Vec<String> = Vec::new(),
    }
}

impl Plot {
    /// The plot as an `<svg>` element for a page.
    #[must_use]
    pub fn page_svg(&self) -> String {
        let mut svg = Svg::new(Place::Page);
        cartesian::draw(self, &mut svg);
        svg.finish(size(self.size), &self.title)
    }
}

/// A figure as pixels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Red, green and blue, row by row from the top.
    pub rgb8: Vec<u8>,
}

/// A complete figure.
#[derive(Clone, Debug, PartialEq)]
pub enum Figure {
    /// A plot with two axes.
    Plot(Plot),
    /// A polar plot around a point of the surface.
    Polar(Polar),
    /// Pictures with two angles as axes.
    Slices(Slices),
}

/// The area of the values in a drawn figure, in its units.
#[derive(Clone, Debug, PartialEq)]
pub enum Ground {
    /// The area between two axes: left, top, right, bottom.
    Plot([f64; 4]),
    /// The area around a point.
    Polar {
        /// The point of the surface.
        centre: [f64; 2],
        /// The radius at the end of the scale.
        radius: f64,
        /// True if the half plane below the surface is shown too.
        around: bool,
    },
    /// The pictures: left, top, right, bottom of each.
    Slices(Vec<[f64; 4]>),
}

/// Pixels per unit of a figure.
const SCALE: f64 = 2.0;

impl Figure {
    /// Draws the figure, and returns the area of its values.
    pub fn draw(&self, pen: &mut impl Pen) -> Ground {
        match self {
            Self::Plot(plot) => cartesian::draw(plot, pen),
            Self::Polar(polar) => polar::draw(polar, pen),
            Self::Slices(slices) => slices::draw(slices, pen),
        }
    }

    /// The size of the figure, and its content for screen readers.
    #[must_use]
    pub fn frame(&self) -> ([f64; 2], &str) {
        match self {
            Self::Plot(plot) => (size(plot.size), &plot.title),
            Self::Polar(polar) => (size(polar.size), &polar.title),
            Self::Slices(slices) => (slices.size(), &slices.title),
        }
    }

    /// The figure as an SVG file.
    #[must_use]
    pub fn svg(&self) -> String {
        let (size, title) = self.frame();
        let mut svg = Svg::new(Place::Alone);
        self.draw(&mut svg);
        svg.finish(size, title)
    }

    /// The figure as a picture, two pixels per unit.
    #[must_use]
    pub fn picture(&self) -> Picture {
        let mut bitmap = Bitmap::new(self.frame().0, SCALE);
        self.draw(&mut bitmap);
        Picture { size: bitmap.size, rgb8: bitmap.rgb8 }
    }
}

/// Draws the sample of a series for a legend: its line, from a point to the right, and its mark.
pub fn sample(pen: &mut impl Pen, [x, y]: [f64; 2], length: f64, series: &Series) {
    layout::line(pen, &[[x, y], [x + length, y]], series);
    layout::mark(pen, [x + 0.5 * length, y], series);
}

fn size((width, height): (u32, u32)) -> [f64; 2] {
    [width.into(), height.into()]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plot(log: bool) -> Plot {
        let y = if log { Axis::log("f (sr⁻¹)", 0.001, 10.0) } else { Axis::new("E", 0.0, 1.0, 5) };
        let mut marks =
            [Mark::None, Mark::Disc, Mark::Ring, Mark::Triangle, Mark::Cross, Mark::Square].into_iter();
        let series = Line::ALL.into_iter().chain([Line::None]).enumerate().map(|(i, line)| Series {
            name: format!("a < b & {i}"),
            points: (1..20u8)
                .map(|x| (f64::from(x), 0.05 * f64::from(x)))
                .chain([(20.0, f64::NAN), (21.0, 0.5), (22.0, 0.5)])
                .collect(),
            bars: Vec::new(),
            colour: i,
            line,
            mark: marks.next().unwrap_or(Mark::None),
        });
        Plot {
            title: "a \"test\" & more".to_owned(),
            x: Axis::new("θ (°)", 0.0, 90.0, 7),
            y,
            series: series.collect(),
            size: (720, 360),
            notes: vec!["a remark <".to_owned()],
            ..Plot::default()
        }
    }

    /// The names of elements, each closed in the right order, or a description of the mistake.
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
            for svg in [plot(log).page_svg(), Figure::Plot(plot(log)).svg()] {
                let names = elements(&svg).unwrap_or_else(|e| panic!("{e}\n{svg}"));
                assert_eq!(names[0], "svg");
                assert!(names.iter().filter(|n| *n == "polyline").count() > 16, "{names:?}");
                assert!(!svg.contains("NaN") && svg.contains("a &lt; b &amp; 3") && svg.contains("θ (°)"));
                assert!(svg.contains("aria-label=\"a &quot;test&quot; &amp; more\""));
                assert!(svg.contains("a remark &lt;"));
            }
        }
        assert!(elements("<svg><g></svg>").is_err() && elements("<svg a=\"1></svg>").is_err());
    }

    #[test]
    fn pages_get_colours_to_replace_and_files_get_their_own() {
        let (page, alone) = (plot(false).page_svg(), Figure::Plot(plot(false)).svg());
        for stand_in in ["#010203", "#040506"] {
            assert!(page.contains(stand_in) && !alone.contains(stand_in), "{stand_in}");
        }
        assert!(alone.contains("fill=\"#ffffff\"") && !page.contains("fill=\"#ffffff\""));
        assert!(alone.contains("#0072b2") && alone.contains("#1c1d1f"));
    }

    #[test]
    fn a_gap_is_a_gap_and_is_marked() {
        let with = |missing: f64| {
            let mut plot = plot(false);
            plot.series = vec![Series {
                name: "gap".to_owned(),
                points: vec![(0.0, 0.1), (30.0, 0.2), (45.0, missing), (60.0, 0.2), (90.0, 0.1)],
                bars: Vec::new(),
                colour: 0,
                line: Line::Solid,
                mark: Mark::None,
            }];
            plot.page_svg().matches("stroke=\"#0072b2\"").count()
        };
        // In the legend and in the plot; with two pieces, and a cross of two lines.
        assert_eq!((with(0.3), with(f64::NAN), with(f64::INFINITY)), (2, 5, 5));
    }

    #[test]
    fn pictures_have_the_colours_of_the_curves() {
        let picture = Figure::Plot(plot(true)).picture();
        assert_eq!(picture.size, [1440, 720]);
        assert_eq!(picture.rgb8.len(), 3 * 1440 * 720);
        let count = |colour: [u8; 3]| picture.rgb8.chunks(3).filter(|p| *p == colour).count();
        for colour in pen::COLOURS {
            assert!(count(colour) > 100, "{colour:?}: {}", count(colour));
        }
        assert_eq!(count([240, 228, 66]), 0, "yellow is not among them");
        assert!(count([255; 3]) > 720 * 720);
    }

    #[test]
    fn every_line_has_a_dash_of_its_own() {
        let mut dashes: Vec<_> = Line::ALL.iter().map(|line| format!("{:?}", line.dash())).collect();
        dashes.sort();
        dashes.dedup();
        assert_eq!(dashes.len(), Line::ALL.len());
    }
}
