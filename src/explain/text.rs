//! Explanations as text: a worked example.

use std::fmt::Write as _;

use glam::Vec3;

use super::{
    Brightest, Explanation, Geometry, Influence, Inside, Line, Lit, Model, Part, Place, Refraction, Seen,
    Spot, agrees, angle,
    dark_glass::WHY,
    lines::{self, calculation, reading},
    noise::{estimated, told, within},
    number,
    numbers::{DIGITS, colour, of_value},
    pairs, rounded, rounded_number_or_triple, rounded_triple, triple,
};
use crate::{
    light::Factor,
    optics::{TermSelection, colour::Encoding},
    reference::DisplaySteps,
    reflection::{Family, Quantity},
    shading::Stage,
    text::{
        mathematics::{self, same_symbol},
        plural,
    },
};

/// Writes a line with arguments, at a depth.
macro_rules! say {
    ($out:expr, $depth:expr, $($what:tt)+) => {
        $out.line($depth, format_args!($($what)+))
    };
}

impl Explanation {
    /// The explanation as a worked example in plain text: the equation, then with numbers, light by light,
    /// and the way from light to the code.
    #[must_use]
    pub fn to_text(&self) -> String {
        self.written(false)
    }

    /// The explanation as Markdown: a heading for each part, lists, and mathematics as code.
    #[must_use]
    pub fn to_markdown(&self) -> String {
        self.written(true)
    }

    /// The numbers of the scene with the greatest influence on the pixel, as text or Markdown.
    #[must_use]
    pub fn influences_to_text(influences: &[Influence], markdown: bool) -> String {
        let mut out = Writer { text: String::new(), markdown };
        out.heading("What would move this pixel most, by differences");
        if influences.iter().any(|influence| influence.digits < DIGITS) {
            out.line(1, "The digits are those that the noise of the light with extent leaves.");
        }
        if !influences.iter().any(Influence::moves) {
            out.line(1, "No number of the material or of a light changes this pixel.");
        }
        for influence in influences.iter().filter(|influence| influence.moves()) {
            let Influence { symbol, label, unit, value, tried, .. } = influence;
            let space = if matches!(*unit, "" | "°") { "" } else { " " };
            let [low, high] = tried.map(|v| rounded(v, DIGITS));
            let what = format!("{symbol} = {}{space}{unit}", rounded(*value, DIGITS));
            let derivative = rounded_triple(influence.derivative(), influence.digits);
            let slope = format!("Δ light/Δ {symbol} = {derivative} between {low} and {high}");
            let effect = signed(influence.effect(), influence.digits);
            say!(out, 1, "{what}, {label}: {slope}; luminance {effect} for 1 % of the range");
        }
        out.text
    }

    /// The differences between the explanations of one pixel in two views, light by light, as text or
    /// Markdown.
    #[must_use]
    pub fn differences_to_text(&self, other: &Self, names: [&str; 2], markdown: bool) -> String {
        let mut out = Writer { text: String::new(), markdown };
        let [a, b] = names;
        out.heading(format_args!("View {a} beside view {b}"));
        for (name, explained) in [(a, self), (b, other)] {
            let [red, green, blue] = explained.code();
            let nothing = if explained.lamp.is_some() { "a light" } else { "background" };
            let model = explained.seen.as_ref().map_or(nothing, |seen| seen.model.declaration.name);
            say!(out, 1, "{name}: {model}, red {red}, green {green}, blue {blue}");
        }
        let (Some(first), Some(second)) = (&self.seen, &other.seen) else { return out.text };
        let spots = first.spots.iter().zip(&second.spots);
        for (one, two) in spots {
            for lit in &one.lights {
                let Some(against) = two.lights.iter().find(|l| l.light.index == lit.light.index) else {
                    continue;
                };
                let (light, place) = (named("lights", &lit.light), heading(first, one).to_lowercase());
                let kind = lit.light.type_name;
                out.subheading(format_args!("{light}, {kind}, {place}: lines that differ"));
                let all = pairs(&lit.lines(&first.model), &against.lines(&second.model));
                for pair in all.iter().filter(|pair| pair.differs()) {
                    for (name, line) in [(a, &pair.a), (b, &pair.b)] {
                        match line {
                            Some(line) => {
                                let numbers = line.right().map(str::to_owned);
                                let sides = numbers.into_iter().chain(line.outcome(DIGITS));
                                let sides: String = sides.map(|side| format!(" = {side}")).collect();
                                out.mathematics(2, format_args!("{name}: {}{sides}", line.text), "");
                            }
                            None => say!(out, 2, "{name}: no line for {}", pair.defines()),
                        }
                    }
                }
                let same = all.iter().filter(|pair| !pair.differs()).count();
                say!(out, 2, "{} the same in both", plural(same, "line"));
            }
        }
        out.text
    }

    fn written(&self, markdown: bool) -> String {
        let mut out = Writer { text: String::new(), markdown };
        let [x, y] = self.pixel;
        let [width, height] = self.size;
        let [r, g, b] = self.code();
        out.marked("#", 0, format_args!("Pixel {x},{y} of {width}×{height}: red {r}, green {g}, blue {b}"));
        if self.terms != TermSelection::All {
            say!(out, 0, "Only the {} term is shown.", self.terms.id());
        }
        match (&self.seen, &self.lamp) {
            (Some(seen), _) => self.object(&mut out, seen),
            (None, Some(lamp)) => {
                for light in &lamp.lights {
                    say!(out, 0, "{}, {}, is seen here.", named("lights", light), light.type_name);
                }
                say!(out, 1, "L = {} cd/m²", triple(lamp.radiance));
                say!(out, 1, "light = π L = {}", triple(lamp.light));
            }
            (None, None) => out.line(0, self.about_background()),
        }
        self.display(&mut out);
        out.text
    }

    fn object(&self, out: &mut Writer, seen: &Seen) {
        let part = named("objects", &seen.object);
        say!(out, 0, "{part}, {}, polygon {}", seen.object.type_name, seen.polygon);
        if let Some(label) = &seen.label {
            say!(out, 1, "label: {label}");
        }
        if seen.dark_glass {
            say!(out, 1, "It is smooth glass: {WHY}.");
        }
        out.gap();
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
            let heading = "For comparison: per-pixel shading at this pixel, which is not what is shown";
            self.spot(out, seen, spot, heading);
            let [would, light] = [estimated(spot.colour, spot.error()), estimated(seen.light, seen.error())];
            say!(out, 1, "the light would be {would} instead of {light}");
        }
    }

    fn spot(&self, out: &mut Writer, seen: &Seen, spot: &Spot, heading: &str) {
        out.heading(heading);
        say!(out, 1, "position {} m", triple(spot.position));
        say!(out, 1, "N = {}", triple(spot.normal));
        say!(out, 1, "V = {}, {} m to the observer", triple(spot.view), number(spot.distance));
        if spot.is_mirrored() {
            let eye =
                format!("V is the direction to the observer, {}, mirrored in the surface", triple(spot.eye));
            say!(out, 1, "The normal faces away from the observer: {eye}.");
        }
        for line in spot.refraction.iter().flat_map(Refraction::lines) {
            out.line(1, line);
        }
        if spot.lights.is_empty() {
            out.line(1, "No light is switched on, so there is no light here.");
        }
        for lit in spot.brightest() {
            self.light(out, seen, lit);
        }
        if spot.lights.len() > 1 {
            let lights = plural(spot.lights.len(), "light");
            let sum = told(spot.sum, spot.error(), DIGITS);
            say!(out, 1, "sum over {lights} = {sum}");
        }
        if spot.is_replaced() {
            let [sum, colour] = [spot.sum, spot.colour].map(triple);
            let rule = "what is no number counts as 0, and nothing beyond ±10^30";
            say!(out, 1, "The sum is {sum}; {rule}: {colour}");
        }
    }

    fn light(&self, out: &mut Writer, seen: &Seen, lit: &Lit) {
        out.subheading(format_args!("{}, {}", named("lights", &lit.light), lit.light.type_name));
        if let (Some(position), Some(distance)) = (lit.position, lit.distance) {
            say!(out, 2, "position {} m, distance d = {} m", triple(position), number(distance));
        }
        if let Some(geometry) = &lit.geometry {
            directions(out, seen, geometry);
        }
        match &lit.integral {
            Some(integral) => {
                out.line(2, integral.basis());
                out.line(2, integral.filled());
            }
            None => arriving(out, lit),
        }
        if let Some(remark) = lit.remark_on(&seen.model) {
            out.line(2, remark);
        }
        if lit.is_dark() {
            return;
        }
        for line in lines::shown_lines(&lit.lines(&seen.model), self.terms) {
            equation(out, line);
        }
        let sum = lit.sum(self.terms);
        if lit.integral.is_some() {
            say!(out, 2, "light to the observer: {sum}");
        } else {
            let through = match lit.through {
                Vec3::ZERO => String::new(),
                through => {
                    let by_chance = |spot: &Spot| {
                        spot.refraction.as_ref().is_some_and(|found| found.inside == Some(Inside::Chance))
                    };
                    let noise = match seen.spots.iter().any(by_chance) {
                        true => ", a mean over random ways, with noise",
                        false => "",
                    };
                    say!(out, 2, "light that comes through the body: {}{noise}", triple(through));
                    format!(" + {}", triple(through))
                }
            };
            say!(out, 2, "light to the observer: {sum} × {}{through}", triple(lit.arriving));
            if sum != "0" {
                out.equals(lit.product(self.terms));
            }
        }
        out.equals(lit.outcome(DIGITS));
        if let Some(brightest) = lit.integral.and_then(|integral| integral.brightest) {
            self.brightest(out, seen, &brightest);
        }
        if !lit.is_finite() {
            out.line(2, "Some of these are not finite numbers.");
        }
    }

    /// The direction of a light with extent that contributes most, with the equation for light from that
    /// direction.
    fn brightest(&self, out: &mut Writer, seen: &Seen, brightest: &Brightest) {
        out.line(2, "Of the directions that were sampled, the one that gives most:");
        directions(out, seen, &brightest.geometry);
        let luminance = rounded_number_or_triple(brightest.luminance, DIGITS);
        out.mathematics(2, format_args!("L(l) = {luminance} cd/m²"), ": the luminance from there");
        for line in lines::shown_lines(&brightest.lines(&seen.model, DIGITS), self.terms) {
            equation(out, line);
        }
        let gives = triple(brightest.gives(self.terms));
        say!(out, 2, "from there to the observer, per steradian: {gives}");
    }

    fn display(&self, out: &mut Writer) {
        let steps = &self.steps;
        let say = |step: fn(&DisplaySteps) -> Vec3| estimated(step(steps), self.error_of(step));
        out.heading("From light to the code on the display");
        if self.seen.is_some() || self.lamp.is_some() {
            let light = told(steps.light, self.error_of(|steps| steps.light), DIGITS);
            say!(out, 1, "light {light}");
            let (ev, factor) = (number(self.display.exposure), number(steps.exposure));
            say!(out, 1, "exposure {ev} EV, factor 2^{ev} = {factor}: {}", say(|steps| steps.exposed));
        } else if self.shows_backdrop() {
            say!(out, 1, "background {}, as the scene gives it", triple(steps.exposed));
        } else {
            say!(out, 1, "background {}, whatever the exposure", triple(steps.exposed));
        }
        if self.display.encoding == Encoding::Off && !self.shows_backdrop() {
            let why = "clipped to 0–1 and decoded, since the last step encodes";
            let input = say(|steps| steps.input);
            say!(out, 1, "without encoding, the numbers themselves are to reach the display: {why}: {input}");
        }
        if !self.shows_backdrop() {
            let tone = self.display.tone_mapping.name();
            say!(out, 1, "tone mapping, {tone}: {}", say(|steps| steps.mapped));
        }
        if steps.mapped.is_nan() {
            out.line(1, "what is no number is shown as 0");
        } else if steps.mapped.max_element() > 1.0 || steps.mapped.min_element() < 0.0 {
            out.line(1, "what is beyond 0–1 is clipped");
        }
        say!(out, 1, "sRGB encoding: {}", say(|steps| steps.encoded));
        let [of_mapped, of_encoded] =
            [self.error_of(|steps| steps.mapped), self.error_of(|steps| steps.encoded)];
        for (i, channel) in ["red", "green", "blue"].into_iter().enumerate() {
            let (linear, encoded) = (steps.mapped[i], steps.encoded[i]);
            // The formula of IEC 61966-2-1, as used by the display.
            let x = if linear.is_nan() { 0.0 } else { linear.clamp(0.0, 1.0) };
            let put = within(x, of_mapped.map(|error| error[i]), DIGITS);
            let numbers = match x {
                x if x > 0.003_130_8 => format!("1.055 × {put}^(1/2.4) − 0.055"),
                _ => format!("12.92 × {put}"),
            };
            let encoded = within(encoded, of_encoded.map(|error| error[i]), DIGITS);
            out.mathematics(2, format_args!("{channel}: {numbers} = {encoded}"), "");
        }
        let [r, g, b] = steps.codes;
        say!(out, 1, "× 255, rounded: {r}, {g}, {b}");
        if let Some(error) = of_encoded {
            let codes = rounded_triple(255.0 * error, 1);
            let error = format!("The standard error of the light is that of {codes} codes.");
            say!(out, 1, "These are the codes of the picture, made from all digits. {error}");
        }
    }
}

/// A line of the equation: as written, with numbers, and its value.
fn equation(out: &mut Writer, line: &Line) {
    let value = line.outcome(DIGITS);
    let about = line.quantity.map_or_else(String::new, |quantity| match quantity.source {
        "" => format!(": {}", quantity.label),
        source => format!(": {}, {source}", quantity.label),
    });
    match (&value, line.text.contains('=')) {
        (Some(value), false) => out.mathematics(2, format_args!("{} = {value}", line.defines()), &about),
        _ => {
            out.mathematics(2, &line.text, &about);
            let numbers = line.right().filter(|numbers| Some(*numbers) != value.as_deref());
            numbers.into_iter().chain(value.as_deref()).for_each(|side| out.equals(side));
        }
    }
}

/// A number with its sign and this many digits.
fn signed(v: f32, digits: usize) -> String {
    let sign = if v > 0.0 { "+" } else { "" };
    format!("{sign}{}", rounded(v, digits))
}

/// A part of the scene as named in messages.
fn named(list: &str, part: &Part) -> String {
    match &part.name {
        Some(name) => format!("{list}[{}] “{name}”", part.index),
        None => format!("{list}[{}]", part.index),
    }
}

/// Number of steps from the equation of light along a path to the quantities that are named with it.
const NESTED: usize = 2;

/// The quantities of light along a path, and those that they need: it has no line of its own with numbers, so they are
/// named at once.
fn along_path(model: &Model) -> Vec<&'static Quantity> {
    let holds = |quantity: &&Quantity| quantity.when.iter().all(|(name, ids)| model.chooses(name, ids));
    let quantities = model.declaration.quantities.iter().filter(holds);
    let mut texts: Vec<_> = model.parts().filter(|part| part.along_path).map(|part| part.text).collect();
    let mut found: Vec<&Quantity> = Vec::new();
    // The surface has further ones below these, which are its own.
    for _ in 0..NESTED {
        let atoms = texts.iter().flat_map(|text| mathematics::parse(text));
        let symbols: Vec<_> = atoms.filter_map(|atom| atom.symbol()).collect();
        let named = |quantity: &&Quantity| symbols.iter().any(|s| same_symbol(quantity.symbol(), s));
        let is_new = |quantity: &&Quantity| !found.iter().any(|known| known.text == quantity.text);
        let new: Vec<_> = quantities.clone().filter(named).filter(is_new).collect();
        texts = new.iter().map(|quantity| quantity.text).collect();
        found.extend(new);
    }
    // In the order of their declaration.
    quantities.filter(|quantity| found.iter().any(|known| known.text == quantity.text)).collect()
}

fn model(out: &mut Writer, seen: &Seen) {
    let d = seen.model.declaration;
    let author = if d.author.is_empty() { String::new() } else { format!(" ({})", d.author) };
    out.heading(format_args!("Reflection model: {}{author}", d.name));
    for part in seen.model.parts() {
        out.mathematics(1, part.text, "");
    }
    for quantity in along_path(&seen.model) {
        let by = if quantity.source.is_empty() { String::new() } else { format!(", {}", quantity.source) };
        out.mathematics(2, quantity.text, &format!(": {}{by}", quantity.label));
    }
    if d.family != Family::Basic && !d.equation.is_empty() {
        out.line(1, "I is the answer to light of unit intensity: for a BRDF f_r, π f_r N·L.");
    }
    if d.measured {
        out.line(1, "f is measured: there is no equation of it, but a table, read as below.");
    }
    for setting in &seen.model.settings {
        out.line(1, lines::setting(setting));
    }
    if seen.model.interpreted {
        out.line(1, "The CPU interprets the WGSL of this model.");
    }
    if let Some(trouble) = &seen.model.trouble {
        say!(out, 1, "The CPU cannot run this model, so the numbers below are not its own: {trouble}.");
    }
}

fn shading(out: &mut Writer, seen: &Seen) {
    let d = seen.shading;
    out.heading(format_args!("Shading model: {}, {}", d.name, d.stage.phrase()));
    out.line(1, d.summary);
    say!(out, 1, "point at the pixel's centre: {} m", triple(seen.position));
    say!(out, 1, "normal of the triangle: {}", triple(seen.face_normal));
    if d.stage == Stage::Pixel {
        let n = seen.interpolated_normal;
        say!(out, 1, "interpolated normal: {}, length {}", triple(n), number(n.length()));
        if n != Vec3::ZERO {
            say!(out, 1, "renormalised: {}", triple(n.normalize_or_zero()));
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
        let colour = estimated(corner.colour, seen.error_at(corner));
        say!(out, 1, "{sign}{} × {colour}", number(corner.weight));
    }
    say!(out, 1, "= {}", estimated(seen.light, seen.error()));
}

/// Directions, their cosines and angles.
fn directions(out: &mut Writer, seen: &Seen, geometry: &Geometry) {
    let [l, h, r] = [geometry.l, geometry.h, geometry.r].map(triple);
    say!(out, 2, "L = {l}, H = {h}, R = {r}");
    let shown =
        if seen.model.declaration.anisotropic { [0, 1, 2, 3, 4, 7, 8].as_slice() } else { &[0, 1, 2, 3, 4] };
    let cosines = shown.iter().map(|i| geometry.cosines[*i]);
    let cosines: Vec<_> =
        cosines.map(|(name, c)| format!("{name} = {} ({}°)", number(c), number(angle(c)))).collect();
    out.line(2, cosines.join(", "));
    angles(out, seen, geometry);
}

/// The angles of directions, by their symbols in equations; azimuths, and the tangent from which they are
/// measured, only where the model uses them.
fn angles(out: &mut Writer, seen: &Seen, geometry: &Geometry) {
    let d = seen.model.declaration;
    let texts = seen.model.equation.iter().map(|part| part.text).chain(d.quantities.iter().map(|q| q.text));
    let around = d.anisotropic || texts.clone().any(|text| text.contains('φ'));
    let named = |symbol: &str| texts.clone().any(|text| text.contains(symbol));
    let all: Vec<_> = geometry
        .angles()
        .into_iter()
        .filter(|(symbol, _)| if symbol.starts_with('φ') { around && named(symbol) } else { named(symbol) })
        .map(|(symbol, angle)| format!("{symbol} = {}°", rounded(angle, DIGITS)))
        .collect();
    if around {
        let [t, b] = [geometry.frame.t, geometry.frame.b].map(triple);
        say!(out, 2, "tangent T = {t}, B = {b}");
    }
    if !all.is_empty() {
        say!(out, 2, "angles: {}", all.join(", "));
    }
}

/// The light that arrives at a point.
fn arriving(out: &mut Writer, lit: &Lit) {
    for factor in lit.factors.iter().filter(|factor| !factor.from.is_empty()) {
        let (symbol, value) = (factor.symbol, rounded_number_or_triple(factor.value, DIGITS));
        let about = format!(" for {}: {}", factor.givens(number), factor.meaning);
        let steps = factor.steps(DIGITS);
        if steps.is_empty() {
            out.mathematics(2, format_args!("{symbol} = {value}"), &about);
        }
        for (i, step) in steps.iter().enumerate() {
            out.mathematics(2, &step.text, if i == 0 { &about } else { "" });
            out.equals(&step.numbers);
            out.equals(of_value(&step.value, DIGITS));
        }
    }
    let numbers = |digits: usize, with_unit: bool| {
        let factor = |factor: &Factor| {
            let value = rounded_number_or_triple(factor.value, digits);
            if !with_unit || matches!(factor.unit, "" | "×") {
                value
            } else {
                format!("{value} {}", factor.unit)
            }
        };
        lit.factors.iter().map(factor).collect::<Vec<_>>().join(" × ")
    };
    let intensity = rounded_number_or_triple(lit.intensity, DIGITS);
    let equation = lit.arrival();
    // With as many digits as the product of the numbers without units needs.
    let value = colour(lit.intensity);
    let fits =
        |digits: &usize| reading(&numbers(*digits, false)).is_ok_and(|read| agrees(&read, &value, DIGITS));
    let factors = numbers((DIGITS..=9).find(fits).unwrap_or(DIGITS), true);
    let all = if lit.factors.len() > 1 { format!("{factors} = {intensity} lx") } else { factors };
    out.mathematics(2, format_args!("{equation} = {all}"), "");
    if lit.colour != Vec3::ONE && lit.intensity != Vec3::ZERO {
        let numbers = |digits: usize| {
            let intensity = rounded_number_or_triple(lit.intensity, digits);
            format!("{intensity} × {}", rounded_triple(lit.colour, digits))
        };
        let numbers = calculation(DIGITS, &colour(lit.arriving), numbers);
        let all = format!("{numbers} = {} lx", triple(lit.arriving));
        out.mathematics(2, &all, ": times the colour of the light");
    }
}

/// Writes indented lines, or the headings and nested lists of Markdown.
struct Writer {
    text: String,
    markdown: bool,
}

impl Writer {
    fn line(&mut self, depth: usize, what: impl std::fmt::Display) {
        let line = match (self.markdown, depth) {
            (false, _) => format!("{:width$}{what}", "", width = 2 * depth),
            (true, 0) => what.to_string(),
            (true, _) => format!("{:width$}- {what}", "", width = 2 * (depth - 1)),
        };
        // Writing to a String cannot fail.
        let _ = writeln!(self.text, "{}", line.trim_end());
    }

    /// Writes mathematics, with words after it.
    fn mathematics(&mut self, depth: usize, what: impl std::fmt::Display, behind: &str) {
        let quote = if self.markdown { "`" } else { "" };
        self.line(depth, format_args!("{quote}{what}{quote}{behind}"));
    }

    /// Writes a further side of an equation.
    fn equals(&mut self, what: impl std::fmt::Display) {
        self.mathematics(3, format_args!("= {what}"), "");
    }

    /// Writes an empty line, which Markdown needs before lists.
    fn gap(&mut self) {
        if self.markdown {
            self.text.push('\n');
        }
    }

    /// Writes a heading with its mark in Markdown, or at a depth.
    fn marked(&mut self, mark: &str, depth: usize, what: impl std::fmt::Display) {
        match self.markdown {
            true => self.line(0, format_args!("{mark} {what}")),
            false => self.line(depth, what),
        }
        self.gap();
    }

    fn heading(&mut self, what: impl std::fmt::Display) {
        self.line(0, "");
        self.marked("##", 0, what);
    }

    /// Writes the heading of a light.
    fn subheading(&mut self, what: impl std::fmt::Display) {
        self.line(0, "");
        self.marked("###", 1, what);
    }
}
