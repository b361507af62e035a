//! Explanations as text: a worked example.

use std::fmt::Write as _;

use glam::Vec3;

use super::{
    Explanation, Lit, Part, Place, Seen, Spot, angle, equation, number, numbers::number_or_triple, triple,
};
use crate::{
    optics::{TermSelection, colour::Encoding},
    reflection::Term,
    shading::Stage,
    text::plural,
};

impl Explanation {
    /// The explanation as a worked example in plain text: the equation, the same with numbers, light by light, and the
    /// way from light to the code.
    #[must_use]
    pub fn to_text(&self) -> String {
        let mut out = Writer::default();
        let [x, y] = self.pixel;
        let [width, height] = self.size;
        let [r, g, b] = self.code();
        out.line(0, format_args!("Pixel {x},{y} of {width}×{height}: red {r}, green {g}, blue {b}"));
        if self.terms != TermSelection::All {
            out.line(0, format_args!("Only the {} term is shown.", self.terms.id()));
        }
        match &self.seen {
            Some(seen) => self.object(&mut out, seen),
            None => out.line(
                0,
                "There is no object at the centre of this pixel, only background. It is not light of the scene: lights and \
                 exposure do not change it, tone mapping does.",
            ),
        }
        self.display(&mut out);
        out.text
    }

    fn object(&self, out: &mut Writer, seen: &Seen) {
        let part = named("objects", &seen.object);
        out.line(0, format_args!("{part}, {}, polygon {}", seen.object.type_name, seen.polygon));
        model(out, seen);
        shading(out, seen);
        for spot in &seen.spots {
            self.spot(out, seen, spot, &heading(seen, spot));
        }
        if seen.spots.is_empty() {
            out.heading("The shading model did not evaluate the reflection model.");
        }
        result(out, seen);
        if let Some(spot) = &seen.per_pixel {
            self.spot(
                out,
                seen,
                spot,
                "For comparison: per-pixel shading at this pixel, which is not what is shown",
            );
            out.line(
                1,
                format_args!("the light would be {} instead of {}", triple(spot.colour), triple(seen.light)),
            );
        }
    }

    fn spot(&self, out: &mut Writer, seen: &Seen, spot: &Spot, heading: &str) {
        out.heading(heading);
        out.line(1, format_args!("position {} m", triple(spot.position)));
        out.line(1, format_args!("N = {}", triple(spot.normal)));
        out.line(1, format_args!("V = {}, {} m to the observer", triple(spot.view), number(spot.distance)));
        if spot.is_mirrored() {
            out.line(
                1,
                format_args!(
                    "The normal faces away from the observer, who sees the surface all the same: V is the direction to the \
                     observer, {}, mirrored in the surface.",
                    triple(spot.eye)
                ),
            );
        }
        if spot.lights.is_empty() {
            out.line(1, "No light is switched on, so there is no light here.");
        }
        for lit in spot.brightest() {
            self.light(out, seen, lit);
        }
        if spot.lights.len() > 1 {
            let lights = plural(spot.lights.len(), "light");
            out.line(1, format_args!("sum over {lights} = {}", triple(spot.sum)));
        }
        if spot.is_replaced() {
            out.line(
                1,
                format_args!(
                    "The sum is {}; what is no number counts as 0, and nothing beyond ±10^30: {}",
                    triple(spot.sum),
                    triple(spot.colour)
                ),
            );
        }
    }

    fn light(&self, out: &mut Writer, seen: &Seen, lit: &Lit) {
        out.line(0, "");
        out.line(1, format_args!("{}, {}", named("lights", &lit.light), lit.light.type_name));
        if let (Some(position), Some(distance)) = (lit.position, lit.distance) {
            out.line(2, format_args!("position {} m, distance d = {} m", triple(position), number(distance)));
        }
        if let Some(geometry) = &lit.geometry {
            let [l, h, r] = [geometry.l, geometry.h, geometry.r].map(triple);
            out.line(2, format_args!("L = {l}, H = {h}, R = {r}"));
            let shown = if seen.model.declaration.anisotropic {
                [0, 1, 2, 3, 4, 7, 8].as_slice()
            } else {
                &[0, 1, 2, 3, 4]
            };
            let cosines = shown.iter().map(|i| geometry.cosines[*i]);
            let cosines: Vec<_> =
                cosines.map(|(name, c)| format!("{name} = {} ({}°)", number(c), number(angle(c)))).collect();
            out.line(2, cosines.join(", "));
        }
        arriving(out, lit);
        if lit.is_dark() {
            out.line(2, "None of its light reaches the point.");
            return;
        }
        if lit.is_behind() {
            out.line(2, "N·L ≤ 0: the surface faces away from the light.");
        }
        if lit.geometry.is_none() {
            out.line(2, "Light from everywhere: the model answers it as a whole, with its ambient term.");
        }
        for line in lit.lines(&seen.model) {
            let value = line.value.map(triple);
            match (line.text, &value) {
                ("", Some(value)) => out.line(2, format_args!("{} = {value}", line.symbol())),
                (text, _) => out.line(2, text),
            }
            if let Some(numbers) = &line.numbers {
                // What is defined stands on the left once.
                out.line(3, numbers.find(" = ").map_or(numbers.as_str(), |at| &numbers[at + 1..]));
            }
            if let Some(value) = value.filter(|_| !line.text.is_empty()) {
                // A formula alone would not be 0 then.
                let none = lit.is_behind() && line.term != Term::Ambient && line.value == Some(Vec3::ZERO);
                out.line(3, format_args!("= {value}{}", if none { ", since N·L ≤ 0" } else { "" }));
            }
        }
        let left_out = |term: Term, value: Vec3| {
            let shown = self.terms == TermSelection::All || term.alone() == Some(self.terms);
            !shown && value != Vec3::ZERO
        };
        let response = lit.response;
        let terms = [
            (Term::Ambient, response.ambient, "I_a"),
            (Term::Diffuse, response.diffuse, "I_d"),
            (Term::Specular, response.specular, "I_s"),
        ];
        let shown: Vec<_> = terms
            .iter()
            .filter(|(term, value, _)| *value != Vec3::ZERO && !left_out(*term, *value))
            .map(|(_, _, symbol)| *symbol)
            .collect();
        let sum = match shown.as_slice() {
            [] => "0".to_owned(),
            [one] => (*one).to_owned(),
            several => format!("({})", several.join(" + ")),
        };
        let contribution = triple(lit.contribution);
        out.line(2, format_args!("light to the observer: {sum} × {} = {contribution}", triple(lit.arriving)));
        if !lit.is_finite() {
            out.line(2, "Some of these are not finite numbers.");
        }
    }

    fn display(&self, out: &mut Writer) {
        let steps = &self.steps;
        out.heading("From light to the code on the display");
        match &self.seen {
            Some(_) => {
                out.line(1, format_args!("light {}", triple(steps.light)));
                let (ev, factor) = (number(self.display.exposure), number(steps.exposure));
                out.line(
                    1,
                    format_args!("exposure {ev} EV, factor 2^{ev} = {factor}: {}", triple(steps.exposed)),
                );
            }
            None => out.line(1, format_args!("background {}, whatever the exposure", triple(steps.exposed))),
        }
        if self.display.encoding == Encoding::Off {
            out.line(
                1,
                format_args!(
                    "without encoding, the numbers themselves are to reach the display: clipped to 0–1 and decoded, since \
                     the last step encodes: {}",
                    triple(steps.input)
                ),
            );
        }
        let tone = self.display.tone_mapping.name();
        out.line(1, format_args!("tone mapping, {tone}: {}", triple(steps.mapped)));
        if steps.mapped.is_nan() {
            out.line(1, "what is no number is shown as 0");
        } else if steps.mapped.max_element() > 1.0 || steps.mapped.min_element() < 0.0 {
            out.line(1, "what is beyond 0–1 is clipped");
        }
        out.line(1, format_args!("sRGB encoding: {}", triple(steps.encoded)));
        let [r, g, b] = steps.codes;
        out.line(1, format_args!("× 255, rounded: {r}, {g}, {b}"));
    }
}

/// A part of the scene as messages name it.
fn named(list: &str, part: &Part) -> String {
    match &part.name {
        Some(name) => format!("{list}[{}] “{name}”", part.index),
        None => format!("{list}[{}]", part.index),
    }
}

fn model(out: &mut Writer, seen: &Seen) {
    let d = seen.model.declaration;
    let author = if d.author.is_empty() { String::new() } else { format!(" ({})", d.author) };
    out.heading(&format!("Reflection model: {}{author}", d.name));
    for part in d.equation {
        out.line(1, part.text);
    }
    for setting in &seen.model.settings {
        out.line(1, equation::setting(setting));
    }
    if seen.model.interpreted {
        out.line(1, "The CPU interprets the WGSL of this model.");
    }
    if let Some(trouble) = &seen.model.trouble {
        out.line(
            1,
            format_args!("The CPU cannot run this model, so the numbers below are not its own: {trouble}."),
        );
    }
}

fn shading(out: &mut Writer, seen: &Seen) {
    let d = seen.shading;
    out.heading(&format!("Shading model: {}, {}", d.name, d.stage.phrase()));
    out.line(1, d.summary);
    out.line(1, format_args!("point at the pixel's centre: {} m", triple(seen.position)));
    out.line(1, format_args!("normal of the triangle: {}", triple(seen.face_normal)));
    if d.stage == Stage::Pixel {
        let n = seen.interpolated_normal;
        out.line(1, format_args!("interpolated normal: {}, length {}", triple(n), number(n.length())));
        if n != Vec3::ZERO {
            out.line(1, format_args!("renormalised: {}", triple(n.normalize_or_zero())));
        }
    }
}

fn heading(seen: &Seen, spot: &Spot) -> String {
    match spot.place {
        Place::Polygon => format!("At the centre of polygon {}", seen.polygon),
        Place::Vertex { vertex, weight } => format!("At vertex {vertex}, weight {}", number(weight)),
        Place::Pixel => "At this pixel".to_owned(),
    }
}

/// The light of the pixel from the colours of its points.
fn result(out: &mut Writer, seen: &Seen) {
    if seen.shading.stage != Stage::Vertex {
        return;
    }
    out.heading("Interpolated between the vertices");
    for (i, corner) in seen.corners.iter().enumerate() {
        let sign = if i == 0 { "" } else { "+ " };
        out.line(1, format_args!("{sign}{} × {}", number(corner.weight), triple(corner.colour)));
    }
    out.line(1, format_args!("= {}", triple(seen.light)));
}

/// The light that arrives at a point.
fn arriving(out: &mut Writer, lit: &Lit) {
    for factor in lit.factors.iter().filter(|factor| !factor.from.is_empty()) {
        let (symbol, value) = (factor.symbol, number_or_triple(factor.value));
        out.line(2, format_args!("{symbol} = {value} for {}: {}", factor.givens(number), factor.meaning));
    }
    let factors = lit.factors.iter().map(|factor| {
        let value = number_or_triple(factor.value);
        if matches!(factor.unit, "" | "×") { value } else { format!("{value} {}", factor.unit) }
    });
    let factors = factors.collect::<Vec<_>>().join(" × ");
    let intensity = number_or_triple(lit.intensity);
    let equation = if lit.equation.is_empty() { "I(p)" } else { lit.equation };
    if lit.factors.len() > 1 {
        out.line(2, format_args!("{equation} = {factors} = {intensity}"));
    } else {
        out.line(2, format_args!("{equation} = {factors}"));
    }
    if lit.colour != Vec3::ONE && lit.intensity != Vec3::ZERO {
        let (colour, arriving) = (triple(lit.colour), triple(lit.arriving));
        out.line(2, format_args!("times the colour of the light: {intensity} × {colour} = {arriving}"));
    }
}

/// Lines with their indentation.
#[derive(Default)]
struct Writer {
    text: String,
}

impl Writer {
    fn line(&mut self, depth: usize, what: impl std::fmt::Display) {
        let line = format!("{:width$}{what}", "", width = 2 * depth);
        // Writing to a text does not fail.
        let _ = writeln!(self.text, "{}", line.trim_end());
    }

    fn heading(&mut self, what: &str) {
        self.line(0, "");
        self.line(0, what);
    }
}
