//! Figures as SVG. The elements are written directly, since four kinds of them suffice, and the figures share one
//! [`Pen`] with those in pixels; a library for SVG would only replace the format strings.

use std::fmt::Write as _;

use base64::Engine as _;

use super::pen::{Anchor, Ink, Pen};
use crate::{
    lettering::Lettering,
    picture::png::{About, encode},
    text::xml,
};

/// The context of the figure, which determines the colours of text and grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    /// A page whose style sheet replaces the colours: `#010203` for text, `#040506` for the grid.
    Page,
    /// A stand-alone file, on white.
    Alone,
}

/// An SVG document under construction.
pub(super) struct Svg {
    place: Place,
    body: String,
}

/// The allowance for system fonts, which are wider than the program's font, in which text is measured.
const WIDER: f64 = 1.14;

impl Svg {
    pub(super) fn new(place: Place) -> Self {
        Self { place, body: String::new() }
    }

    /// The `<svg>` element, with its width and height and a name for screen readers.
    pub(super) fn finish(self, [width, height]: [f64; 2], title: &str) -> String {
        let title = escaped(title);
        let ground = match self.place {
            Place::Page => String::new(),
            Place::Alone => format!("<rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n"),
        };
        format!(
            "<svg role=\"img\" aria-label=\"{title}\" width=\"{width}\" height=\"{height}\" \
             viewBox=\"0 0 {width} {height}\" xmlns=\"http://www.w3.org/2000/svg\">\n{ground}{}</svg>\n",
            self.body
        )
    }

    fn colour(&self, ink: Ink) -> String {
        let [r, g, b] = match (ink, self.place) {
            (Ink::Grid, Place::Page) => [4, 5, 6],
            (Ink::Grid, Place::Alone) => super::GRID,
            (_, place) => ink.colour().unwrap_or(if place == Place::Page { [1, 2, 3] } else { super::INK }),
        };
        format!("#{r:02x}{g:02x}{b:02x}")
    }

    fn add(&mut self, element: &str) {
        self.body.push_str(element);
        self.body.push('\n');
    }
}

/// The text with XML's special characters escaped and forbidden characters removed.
fn escaped(text: &str) -> String {
    xml::escaped(&text.replace(char::is_whitespace, " "))
}

/// A length rounded to the visible digits.
fn short(v: f64) -> f64 {
    (v * 100.0).round() / 100.0 + 0.0
}

fn points(path: &[[f64; 2]]) -> String {
    path.iter().map(|[x, y]| format!("{},{}", short(*x), short(*y))).collect::<Vec<_>>().join(" ")
}

impl Pen for Svg {
    fn stroke(&mut self, path: &[[f64; 2]], ink: Ink, width: f64, dash: &[f64]) {
        let mut style = format!("stroke=\"{}\" stroke-width=\"{width}\"", self.colour(ink));
        if !dash.is_empty() {
            let lengths: Vec<_> = dash.iter().map(f64::to_string).collect();
            // Writing to a string cannot fail.
            let _ = write!(style, " stroke-dasharray=\"{}\"", lengths.join(" "));
        }
        let path = points(path);
        self.add(&format!("<polyline fill=\"none\" {style} stroke-linejoin=\"round\" points=\"{path}\"/>"));
    }

    fn fill(&mut self, path: &[[f64; 2]], ink: Ink) {
        let colour = self.colour(ink);
        self.add(&format!("<polygon fill=\"{colour}\" points=\"{}\"/>", points(path)));
    }

    fn text(&mut self, [x, y]: [f64; 2], anchor: Anchor, px: f64, text: &str) {
        let anchor = match anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let colour = self.colour(Ink::Text);
        let ([x, y], text) = ([x, y].map(short), escaped(text));
        let font = format!("font-family=\"sans-serif\" font-size=\"{px}\" fill=\"{colour}\"");
        self.add(&format!("<text x=\"{x}\" y=\"{y}\" text-anchor=\"{anchor}\" {font}>{text}</text>"));
    }

    fn picture(&mut self, [x, y, width, height]: [f64; 4], [across, down]: [u32; 2], rgb8: &[u8]) {
        let mut bytes = Vec::new();
        // The size matches the bytes, and writing to memory cannot fail.
        if encode(&mut bytes, across, down, rgb8, &About::default()).is_ok() {
            let data = base64::engine::general_purpose::STANDARD.encode(bytes);
            self.add(&format!(
                "<image x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" \
                 preserveAspectRatio=\"none\" href=\"data:image/png;base64,{data}\"/>"
            ));
        }
    }

    fn width(&self, px: f64, text: &str) -> f64 {
        WIDER * f64::from(Lettering::Regular.width(px as f32, text))
    }
}
