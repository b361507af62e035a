//! The equation of a model for one light, line by line: as written, with numbers, and its value.

use glam::Vec3;

use super::{
    Geometry, Lit, Model, Setting, measured, number,
    numbers::{DIGITS, colour, of_value, rounded_triple},
    put::{Put, Symbols, put},
    triple,
    workings::{Definition, Workings, of_terms, sides},
};
use crate::{
    optics::{TermSelection, Terms},
    parameter::Value as Given,
    reflection::{Ambient, Quantity, Term},
    text::{
        expression::{Expression, Scope, Value},
        mathematics,
    },
};

/// Maximum number of digits of a number in a line; enough for every number in the program.
const MOST_DIGITS: usize = 12;

/// The response to uniform light of models without a formula for it.
const ALBEDO: Quantity = Quantity::new(
    "I_a",
    "directional albedo towards V: the integral of f_r N·L over the hemisphere, by the program",
);

/// A line of the equation of a model for one light.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// The term to which the line belongs.
    pub term: Term,
    /// The text as written by the model, with the arguments of functions substituted; only the name for a
    /// quantity that the model provides without an equation; empty for a term that the equation does not
    /// cover.
    pub text: String,
    /// The text with numbers, if any can be substituted, with as many digits as needed to obtain the value.
    pub numbers: Option<String>,
    /// The symbol replaced by each number on the right side, in order; see [`Put`].
    pub symbols: Vec<Option<String>>,
    /// The value, if known.
    pub value: Option<Value>,
    /// The standard error of the value, if it is an integral over a light with extent.
    pub error: Option<Vec3>,
    /// The declaration of a quantity; `None` for a part of the equation itself.
    pub quantity: Option<&'static Quantity>,
}

impl Line {
    /// A line without numbers.
    pub(super) fn new(term: Term, text: String, value: Value) -> Self {
        Self { term, text, numbers: None, symbols: vec![], value: Some(value), error: None, quantity: None }
    }

    /// The symbol of the line's term: `I_d`.
    #[must_use]
    pub fn symbol(&self) -> &'static str {
        self.term.symbol()
    }

    /// The symbol that the line defines: `I_d`, or `H(N·L)`.
    #[must_use]
    pub fn defines(&self) -> &str {
        match sides(&self.text) {
            Some((head, _)) => head,
            None if self.text.is_empty() => self.symbol(),
            None => &self.text,
        }
    }

    /// True if the line defines its term.
    #[must_use]
    pub fn is_term(&self) -> bool {
        self.defines() == self.symbol()
    }

    /// True for a line of the equation itself: a term, or a part that the equation defines; false for a
    /// separate quantity.
    #[must_use]
    pub fn is_equation(&self) -> bool {
        self.is_term() || self.quantity.is_none()
    }

    /// True if a number of the line stands for this symbol.
    fn names(&self, symbol: &str) -> bool {
        self.symbols.iter().flatten().any(|known| mathematics::same_symbol(known, symbol))
    }

    /// The value as red, green and blue.
    #[must_use]
    pub fn rgb(&self) -> Option<Vec3> {
        self.value.map(|value| Vec3::from_array(value.rgb.map(|v| v as f32)))
    }

    /// The value as written: with this many digits, or those that its standard error allows.
    #[must_use]
    pub fn outcome(&self, digits: usize) -> Option<String> {
        match (self.rgb(), self.error) {
            (Some(value), Some(error)) => Some(measured(value, error)),
            _ => self.value.as_ref().map(|value| of_value(value, digits)),
        }
    }

    /// The right side with numbers.
    #[must_use]
    pub fn right(&self) -> Option<&str> {
        let numbers = self.numbers.as_deref()?;
        Some(sides(numbers).map_or(numbers, |(_, body)| body))
    }
}

/// Values by their symbols.
#[derive(Default)]
pub(super) struct Known(pub(super) Vec<(String, Value)>);

impl Scope for Known {
    fn value(&mut self, symbol: &str) -> Result<Value, String> {
        let found = self.0.iter().find(|(known, _)| mathematics::same_symbol(known, symbol));
        found.map(|(_, value)| *value).ok_or_else(|| format!("{symbol} has no number"))
    }

    fn call(&mut self, name: &str, _: &[String]) -> Result<Value, String> {
        Err(format!("{name} has no number"))
    }
}

/// The value of a line as written: of the right side, or of the whole text without an equals sign.
///
/// # Errors
/// Returns a description of the error if the line cannot be calculated.
pub fn reading(numbers: &str) -> Result<Value, String> {
    let body = sides(numbers).map_or(numbers, |(_, body)| body);
    // Written numbers contain no names.
    Expression::read(body)?.value(&mut Known::default())
}

/// True if two values agree to this many significant digits, or both are negligible: below a billionth.
#[must_use]
pub fn agrees(a: &Value, b: &Value, digits: usize) -> bool {
    agrees_above(a, b, digits, 1e-9)
}

/// Like [`agrees`], with another threshold for negligible values: at most one unit of the last digit apart,
/// or half a unit for a number that begins with 1.
fn agrees_above(a: &Value, b: &Value, digits: usize, nothing: f64) -> bool {
    let most = b.rgb.iter().fold(0.0f64, |most, v| most.max(v.abs()));
    let near = |(a, b): (&f64, &f64)| {
        let size = b.abs().max(1e-3 * most);
        let digit = 10f64.powi(1 - digits as i32);
        let unit = digit * 10f64.powf(size.max(1e-300).log10().floor());
        let bound = unit.min(0.5 * digit * size) + nothing;
        (a - b).abs() <= bound || a == b || a.is_nan() && b.is_nan()
    };
    a.rgb.iter().zip(&b.rgb).all(near)
}

/// True if two values are written alike with this many digits, or nearly: rounding may depend on the last
/// bit.
fn reads_as(a: &Value, b: &Value, digits: usize) -> bool {
    agrees_above(a, b, digits + 1, 1e-15)
        || agrees_above(a, b, digits, 1e-15) && of_value(a, digits) == of_value(b, digits)
}

/// A calculation with as many digits as needed to obtain its value, but at least this many.
pub(super) fn calculation(digits: usize, value: &Value, with: impl Fn(usize) -> String) -> String {
    let fits = |text: &String| reading(text).is_ok_and(|read| reads_as(&read, value, digits));
    (digits..=MOST_DIGITS).map(&with).find(fits).unwrap_or_else(|| with(digits))
}

impl Lit {
    /// The equation of the model for this light, line by line: each term with its value, then the quantities
    /// that it needs, in the order of their appearance. Every non-zero term has a line with its value.
    #[must_use]
    pub fn lines(&self, model: &Model) -> Vec<Line> {
        self.rounded_lines(model, DIGITS)
    }

    /// The lines with this many significant digits, and more where the value would not follow from so few.
    #[must_use]
    pub fn rounded_lines(&self, model: &Model, digits: usize) -> Vec<Line> {
        match &self.integral {
            Some(integral) => integral.lines(&self.response, model),
            None => model.lines(self.geometry.as_ref(), &self.response, digits),
        }
    }

    /// The terms that reach the observer: shown, and not 0.
    fn shown(&self, terms: TermSelection) -> impl Iterator<Item = (Term, Vec3)> {
        let shown = move |term: Term| terms == TermSelection::All || term.alone() == Some(terms);
        of_terms(&self.response).into_iter().filter(move |(term, value)| *value != Vec3::ZERO && shown(*term))
    }

    /// The terms that reach the observer (shown, and not 0) as a factor: `(I_d + I_s)`.
    #[must_use]
    pub fn sum(&self, terms: TermSelection) -> String {
        factor(self.shown(terms).map(|(term, _)| term.symbol().to_owned()))
    }

    /// The factor with values, times the arriving light, with as many digits as needed to obtain the light to
    /// the observer.
    pub(super) fn product(&self, terms: TermSelection) -> String {
        let with = |digits: usize| {
            let sum = factor(self.shown(terms).map(|(_, value)| rounded_triple(value, digits)));
            let through = match self.through {
                Vec3::ZERO => String::new(),
                through => format!(" + {}", rounded_triple(through, digits)),
            };
            format!("{sum} × {}{through}", rounded_triple(self.arriving, digits))
        };
        calculation(DIGITS, &colour(self.contribution), with)
    }
}

/// The lines that the displayed terms need: their own, and those that define what a needed line names.
#[must_use]
pub fn shown_lines(lines: &[Line], terms: TermSelection) -> Vec<&Line> {
    let mut needed: Vec<_> =
        lines.iter().map(|line| terms == TermSelection::All || line.term.alone() == Some(terms)).collect();
    let is_named = |line: &Line, needed: &[bool]| {
        lines.iter().zip(needed).any(|(other, is)| *is && other.names(line.defines()))
    };
    let next = |needed: &[bool]| {
        let mut all = lines.iter().zip(needed);
        all.position(|(line, is)| !is && !line.is_term() && is_named(line, needed))
    };
    while let Some(more) = next(&needed) {
        needed[more] = true;
    }
    lines.iter().zip(needed).filter(|(_, is)| *is).map(|(line, _)| line).collect()
}

/// A sum as a factor: in brackets if there are several.
fn factor(terms: impl Iterator<Item = String>) -> String {
    let terms: Vec<_> = terms.collect();
    match terms.as_slice() {
        [] => "0".to_owned(),
        [one] => one.clone(),
        several => format!("({})", several.join(" + ")),
    }
}

impl Model {
    /// The lines of the equation for light from a direction, or for uniform light, and the response of the
    /// model: see [`Lit::rounded_lines`].
    #[must_use]
    pub fn lines(&self, geometry: Option<&Geometry>, response: &Terms, digits: usize) -> Vec<Line> {
        let workings = Workings::new(self, geometry, response);
        let mut lines = Lines { model: self, geometry, workings, digits, lines: Vec::new() };
        for (term, value) in of_terms(response) {
            lines.term(term, value);
        }
        // A model may have one formula for all its light.
        let total = response.select(TermSelection::All);
        for text in parts(self, Term::Total).filter(|_| geometry.is_some()) {
            lines.total(text, total);
        }
        lines.lines
    }
}

/// The definitions of a term in the equation.
fn parts(model: &Model, term: Term) -> impl Iterator<Item = &'static str> {
    let of_term = model.equation.iter().filter(move |part| part.term == term && !part.along_path);
    of_term.flat_map(|part| mathematics::definitions(part.text))
}

struct Lines<'a> {
    model: &'a Model,
    geometry: Option<&'a Geometry>,
    workings: Workings<'a>,
    digits: usize,
    lines: Vec<Line>,
}

impl Lines<'_> {
    fn term(&mut self, term: Term, light: Vec3) {
        let value = colour(light);
        // An equation describes light from a direction, except in its ambient term.
        let said = term == Term::Ambient || self.geometry.is_some();
        let before = self.lines.len();
        // A model without a formula for uniform light responds with its albedo.
        let albedo = term == Term::Ambient && self.model.declaration.ambient == Ambient::Albedo;
        let text = if albedo { term.symbol().to_owned() } else { String::new() };
        let blank = Line { quantity: albedo.then_some(&ALBEDO), ..Line::new(term, text, value) };
        let texts: Vec<_> = parts(self.model, term).filter(|_| said).collect();
        let is_head = |text: &str| sides(text).is_some_and(|(head, _)| head == blank.symbol());
        for text in texts.iter().filter(|text| is_head(text)) {
            let start = self.workings.worked.len();
            let outcome = self.workings.evaluate(text);
            // Behind the surface an equation may give another value or none: a shader has returned before its
            // `let`s.
            let off = outcome.as_ref().map_or(true, |worked| !agrees(worked, &value, self.digits));
            let gate = self.geometry.and_then(|geometry| gate(geometry, blank.symbol()));
            if let Some(gate) = gate.filter(|_| off && light == Vec3::ZERO) {
                self.workings.worked.truncate(start);
                self.push(term, &gate, Some(value), None);
                continue;
            }
            match outcome {
                Ok(worked) => {
                    // The equation determines the digits; the last ones differ from those of 32 bits.
                    self.push_with(term, text, (Some(value), Some(&worked)), None);
                    self.quantities(term, start);
                }
                // Mathematics that cannot be calculated, such as an integral, stays as written.
                Err(_) => {
                    self.push(term, text, Some(value), None);
                    self.quantities(term, start);
                    for text in texts.iter().filter(|text| !is_head(text)) {
                        if !self.lines[before..].iter().any(|line| line.text == **text) {
                            self.push(term, text, None, None);
                        }
                    }
                }
            }
        }
        if self.lines.len() == before && (light != Vec3::ZERO || !texts.is_empty()) {
            self.lines.push(blank);
            let worked = self.workings.worked.len();
            for text in texts {
                let value = self.workings.evaluate(text).ok();
                self.push(term, text, value, None);
            }
            self.quantities(term, worked);
        }
    }

    /// Adds the line for the sum of the terms, if it has numbers.
    fn total(&mut self, text: &'static str, total: Vec3) {
        if self.lines.iter().any(|line| line.text == text) || total == Vec3::ZERO {
            return;
        }
        let start = self.workings.worked.len();
        let defines = sides(text).is_some_and(|(head, _)| head == "I");
        let worked = self.workings.evaluate(text).ok();
        let value = if defines { Some(colour(total)) } else { worked };
        let before = self.lines.len();
        self.push(Term::Total, text, value, None);
        if self.lines[before].numbers.is_none() {
            self.lines.truncate(before);
        }
        self.quantities(Term::Total, start);
    }

    /// Adds the lines of the quantities calculated since `start`.
    fn quantities(&mut self, term: Term, start: usize) {
        for worked in self.workings.worked.split_off(start) {
            let Definition { term: own, quantity, .. } =
                worked.definition.unwrap_or(Definition { term, text: "", quantity: None });
            let term = if own == Term::Total { term } else { own };
            self.push(term, &worked.text, Some(worked.value), quantity);
        }
    }

    fn push(&mut self, term: Term, text: &str, value: Option<Value>, quantity: Option<&'static Quantity>) {
        self.push_with(term, text, (value, value.as_ref()), quantity);
    }

    /// Adds a line with its value, and the value that its numbers should give.
    fn push_with(
        &mut self,
        term: Term,
        text: &str,
        (value, given): (Option<Value>, Option<&Value>),
        quantity: Option<&'static Quantity>,
    ) {
        let put = self.numbers(text, given);
        let (numbers, symbols) = put.map_or((None, Vec::new()), |put| (Some(put.text), put.symbols));
        self.lines.push(Line { term, text: text.to_owned(), numbers, symbols, value, error: None, quantity });
    }

    /// A text with numbers, with as many digits as needed to obtain the value.
    fn numbers(&self, text: &str, value: Option<&Value>) -> Option<Put> {
        sides(text)?;
        let with = |digits: usize| put(text, &Symbols::of(self.workings.values(), digits));
        let first = with(self.digits)?;
        let Some(value) = value else { return Some(first) };
        let fits = |put: &Put| reading(&put.text).is_ok_and(|read| reads_as(&read, value, self.digits));
        if fits(&first) {
            return Some(first);
        }
        let more = (self.digits + 1..=MOST_DIGITS).filter_map(with).find(fits);
        // A line that cannot be calculated is written with few digits.
        more.or_else(|| if reading(&first.text).is_ok() { with(MOST_DIGITS) } else { Some(first) })
    }
}

/// The reason why a term is 0 although its equation is not.
fn gate(geometry: &Geometry, symbol: &str) -> Option<String> {
    let below = ["N·L", "N·V"].into_iter().find(|product| geometry.cosine(product) <= 0.0)?;
    Some(format!("{symbol} = 0 if {below} ≤ 0"))
}

/// A parameter as written in an explanation: `k_d = 0.8, diffuse coefficient`.
pub(super) fn setting(setting: &Setting) -> String {
    let p = setting.parameter;
    let value = match (&setting.value, setting.linear) {
        (Given::Number(v), _) => number(*v),
        (Given::Colour([r, g, b]), Some(linear)) => {
            return format!("{} = {}, {}, {r},{g},{b} in sRGB", p.symbol, triple(linear), p.label);
        }
        (_, Some(linear)) => triple(linear),
        (Given::Choice(id), _) => p.kind.option(id).unwrap_or(id).to_owned(),
        (value, _) => value.to_string(),
    };
    let space = if p.unit.is_empty() || p.unit == "°" { "" } else { " " };
    match p.symbol {
        "" => format!("{}: {value}{space}{}", p.label, p.unit),
        symbol => format!("{symbol} = {value}{space}{}, {}", p.unit, p.label),
    }
}
