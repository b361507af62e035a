//! The equation of a model at a point, calculated from its text: the values of all quantities that it names,
//! in a readable order.
//!
//! The terms themselves come from the renderer. The quantities between the parameters and the terms follow
//! from the definitions in the model's declaration, so that each line can be followed by hand; a test
//! compares the results with the terms, for every model.

use std::collections::{HashMap, HashSet};

use glam::Vec3;

use super::{Geometry, Model, Setting, numbers::colour};
use crate::{
    optics::{TERMS, Terms},
    parameter::Value as Parameter,
    reflection::{Quantity, Term},
    text::{
        expression::{Expression, Scope, Value},
        mathematics::{self, Atom, same_symbol},
    },
};

/// Maximum number of quantities in one equation, and of their nesting.
const MOST: usize = 400;
const DEEPEST: usize = 60;

/// A definition of the declaration.
#[derive(Clone, Copy, Debug)]
pub(super) struct Definition {
    pub(super) term: Term,
    pub(super) text: &'static str,
    /// Name and source of the quantity; `None` for a part of the equation.
    pub(super) quantity: Option<&'static Quantity>,
}

impl Definition {
    fn of(quantity: &'static Quantity) -> Self {
        Self { term: Term::Total, text: quantity.text, quantity: Some(quantity) }
    }
}

/// A quantity with its value.
#[derive(Clone, Debug)]
pub(super) struct Worked {
    /// The definition with the arguments of a call substituted; only the name if the model provides the
    /// value.
    pub(super) text: String,
    pub(super) value: Value,
    pub(super) definition: Option<Definition>,
}

/// The known values at a point, and those derived from them.
pub(super) struct Workings<'a> {
    model: &'a Model,
    geometry: Option<&'a Geometry>,
    definitions: Vec<Definition>,
    known: Vec<(String, Value)>,
    /// All requested quantities, by name without spaces and braces.
    found: HashMap<String, Result<Value, String>>,
    running: HashSet<String>,
    /// Quantities in the order of their calculation.
    pub(super) worked: Vec<Worked>,
}

/// A name without optional characters.
fn bare(name: &str) -> String {
    name.replace(['{', '}', ' '], "")
}

/// The left and right sides of a definition.
pub(super) fn sides(text: &str) -> Option<(&str, &str)> {
    let (head, body) = text.split_once('=')?;
    // The equals sign of a condition does not count: 1 if θ = 0 else 2.
    (!head.contains(" if ")).then_some((head.trim(), body.trim()))
}

/// The name and the arguments of a left side: `H(μ)`.
fn signature(head: &str) -> (&str, Vec<&str>) {
    match head.split_once('(') {
        Some((name, rest)) => (name.trim(), rest.trim_end_matches(')').split(',').map(str::trim).collect()),
        None => (head, Vec::new()),
    }
}

fn number(v: f32) -> Value {
    Value::number(f64::from(v))
}

/// The terms, each with its value.
pub(super) fn of_terms(response: &Terms) -> [(Term, Vec3); TERMS] {
    let terms = [Term::Ambient, Term::Diffuse, Term::Specular, Term::Transmitted];
    let values = response.each();
    std::array::from_fn(|i| (terms[i], values[i]))
}

impl<'a> Workings<'a> {
    pub(super) fn new(model: &'a Model, geometry: Option<&'a Geometry>, terms: &Terms) -> Self {
        let mut known = Vec::new();
        for Setting { parameter, value, linear } in &model.settings {
            let value = match (value, linear) {
                (_, Some(linear)) => colour(*linear),
                // Equations use angles with units: σ = 20°.
                (Parameter::Number(v), _) if parameter.unit == "°" => Value::angle(f64::from(*v)),
                (Parameter::Number(v), _) => number(*v),
                (Parameter::Integer(v), _) => Value::number(*v as f64),
                _ => continue,
            };
            if !parameter.symbol.is_empty() {
                known.push((parameter.symbol.to_owned(), value));
            }
        }
        if let Some(geometry) = geometry {
            known.extend(geometry.products().map(|(name, cosine)| (name, Value::number(cosine))));
            known.extend(geometry.angles().map(|(name, angle)| (name.to_owned(), Value::angle(angle))));
        }
        known.extend(of_terms(terms).map(|(term, value)| (term.symbol().to_owned(), colour(value))));
        let declaration = model.declaration;
        let parts = model.equation.iter().filter(|part| !part.along_path).flat_map(|part| {
            let of = |text| Definition { term: part.term, text, quantity: None };
            mathematics::definitions(part.text).into_iter().map(of)
        });
        let holds = |quantity: &&Quantity| quantity.when.iter().all(|(name, ids)| model.chooses(name, ids));
        let quantities = declaration.quantities.iter().filter(holds).map(Definition::of);
        Self {
            model,
            geometry,
            definitions: parts.chain(quantities).collect(),
            known,
            found: HashMap::new(),
            running: HashSet::new(),
            worked: Vec::new(),
        }
    }

    /// Symbols with values, for substitution: given and calculated ones.
    pub(super) fn values(&self) -> impl Iterator<Item = (&str, Value)> {
        let found =
            self.found.iter().filter_map(|(name, value)| Some((name.as_str(), *value.as_ref().ok()?)));
        self.known.iter().map(|(name, value)| (name.as_str(), *value)).chain(found)
    }

    /// The value of a definition's right side.
    pub(super) fn evaluate(&mut self, text: &str) -> Result<Value, String> {
        let body = sides(text).map_or(text, |(_, body)| body);
        Expression::read(body)?.value(self)
    }

    fn given(&self, symbol: &str) -> Option<Value> {
        let known = |(name, _): &&(String, Value)| match name.split_once('·') {
            // A product of two directions, in either order.
            Some((a, b)) => symbol == name || symbol.split_once('·') == Some((b, a)),
            None => same_symbol(name, symbol),
        };
        self.known.iter().find(known).map(|(_, value)| *value)
    }

    /// The definition of a symbol, or of a function with this many arguments.
    fn definition(&self, name: &str, arguments: usize) -> Option<(Definition, Vec<&'static str>)> {
        self.definitions.iter().find_map(|definition| {
            let (head, _) = sides(definition.text)?;
            let (symbol, parameters) = signature(head);
            (same_symbol(symbol, name) && parameters.len() == arguments).then_some((*definition, parameters))
        })
    }

    /// A quantity by name, `F_0` or `H(N·L)`, looked up only once.
    fn look_up(
        &mut self,
        name: String,
        find: impl FnOnce(&mut Self) -> Result<Value, String>,
    ) -> Result<Value, String> {
        let key = bare(&name);
        if let Some(found) = self.found.get(&key) {
            return found.clone();
        }
        if self.running.len() >= DEEPEST || self.found.len() >= MOST {
            return Err(format!("{name} leads to too many others"));
        }
        if !self.running.insert(key.clone()) {
            return Err(format!("{name} is defined by itself"));
        }
        let value = find(self);
        self.running.remove(&key);
        self.found.insert(key, value.clone());
        value
    }

    /// Calculates a definition, and records it before those that it needs.
    fn work_out(&mut self, definition: Definition, text: String) -> Result<Value, String> {
        let at = self.worked.len();
        let value = self.evaluate(&text)?;
        self.worked.insert(at, Worked { text, value, definition: Some(definition) });
        Ok(value)
    }

    /// A quantity that the model provides.
    fn ask_model(&mut self, symbol: &str, arguments: &[f32], name: &str) -> Result<Value, String> {
        let asked = mathematics::plain_symbol(symbol);
        let given = match self.geometry {
            Some(geometry) => {
                let Geometry { l, v, frame, .. } = geometry;
                self.model.surface.0.quantity(&asked, arguments, *l, *v, frame)
            }
            None => None,
        };
        let value = given.ok_or_else(|| format!("{name} is not defined"))?;
        let value = if value.x == value.y && value.y == value.z { number(value.x) } else { colour(value) };
        // If several quantities share a symbol, the present choices select one.
        let mut quantities = self.definitions.iter().filter_map(|definition| definition.quantity);
        let quantity = quantities.find(|quantity| same_symbol(quantity.symbol(), symbol));
        let definition = quantity.map(Definition::of);
        self.worked.push(Worked { text: name.to_owned(), value, definition });
        Ok(value)
    }
}

impl Scope for Workings<'_> {
    fn value(&mut self, symbol: &str) -> Result<Value, String> {
        if let Some(value) = self.given(symbol) {
            return Ok(value);
        }
        self.look_up(symbol.to_owned(), |this| match this.definition(symbol, 0) {
            Some((definition, _)) => this.work_out(definition, definition.text.to_owned()),
            None => this.ask_model(symbol, &[], symbol).or_else(|why| match symbol {
                "e" => Ok(Value::number(std::f64::consts::E)),
                _ => Err(why),
            }),
        })
    }

    fn call(&mut self, name: &str, arguments: &[String]) -> Result<Value, String> {
        let call = format!("{name}({})", arguments.join(", "));
        self.look_up(call.clone(), |this| match this.definition(name, arguments.len()) {
            Some((definition, parameters)) => {
                let body = sides(definition.text).map_or("", |(_, body)| body);
                let body = substituted(body, &parameters, arguments);
                this.work_out(definition, format!("{call} = {body}"))
            }
            None => {
                let mut values = Vec::with_capacity(arguments.len());
                for argument in arguments {
                    values.push(Expression::read(argument)?.value(this)?.rgb[0] as f32);
                }
                this.ask_model(name, &values, &call)
            }
        })
    }
}

/// An expression with arguments substituted for the parameters of a function; in brackets if they consist of
/// several parts.
fn substituted(body: &str, parameters: &[&str], arguments: &[String]) -> String {
    let mut out = Vec::new();
    let atoms = mathematics::parse(body);
    let ends = |atom: Option<&Atom>, bases: [&str; 2]| atom.is_some_and(|atom| bases.contains(&atom.base()));
    // The whole argument of a function, as μ in F(0, μ).
    let is_argument = |i: usize| {
        let solid = |atom: &&Atom| !matches!(atom, Atom::Space);
        ends(atoms[..i].iter().rev().find(solid), ["(", ","])
            && ends(atoms[i + 1..].iter().find(solid), [")", ","])
    };
    let whole: Vec<bool> = (0..atoms.len()).map(is_argument).collect();
    for (atom, whole) in atoms.into_iter().zip(whole) {
        let place = parameters.iter().position(|p| atom.symbol().is_some_and(|s| same_symbol(&s, p)));
        let scripts = |text: &str| substituted(text, parameters, arguments);
        match (place, atom) {
            (Some(i), atom) => {
                let argument = mathematics::parse(&arguments[i]);
                let alone = argument.len() == 1 && atom.sup().is_empty();
                // A scalar product without a power binds like a single symbol.
                let product =
                    atom.sup().is_empty() && matches!(argument.as_slice(), [_, dot, _] if dot.base() == "·");
                let upright = |base: &str, sup: String| Atom::Upright {
                    base: base.to_owned(),
                    sub: String::new(),
                    sup,
                };
                let sup = scripts(atom.sup());
                if alone || product || whole && atom.sup().is_empty() {
                    out.extend(argument);
                } else {
                    out.push(upright("(", String::new()));
                    out.extend(argument);
                    out.push(upright(")", sup));
                }
            }
            (None, Atom::Space) => out.push(Atom::Space),
            (None, Atom::Symbol { base, sub, sup }) => {
                out.push(Atom::Symbol { base, sub, sup: scripts(&sup) });
            }
            (None, Atom::Upright { base, sub, sup }) => {
                out.push(Atom::Upright { base, sub, sup: scripts(&sup) });
            }
        }
    }
    mathematics::write(&out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arguments_take_the_place_of_parameters() {
        for (body, arguments, expected) in [
            ("(1 + 2 μ)/(1 + 2 μ √(1 − w))", "μ_l", "(1 + 2 μ_l)/(1 + 2 μ_l √(1 − w))"),
            ("μ^2 + 1", "N·L", "(N·L)^2 + 1"),
            ("1 − μ", "N·L", "1 − N·L"),
            ("2 μ", "a + b", "2 (a + b)"),
            ("2^μ", "a", "2^a"),
            ("F(μ) − G(0, μ) μ", "2/3", "F(2/3) − G(0, 2/3) (2/3)"),
            ("(μ)^2 + F(μ^2)", "a + b", "(a + b)^2 + F((a + b)^2)"),
            ("μ_1 μ", "0.5", "μ_1 0.5"),
        ] {
            assert_eq!(substituted(body, &["μ"], &[arguments.to_owned()]), expected);
        }
    }
}
