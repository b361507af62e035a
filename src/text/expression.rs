//! Evaluates equations: the notation of [`mathematics`](super::mathematics), parsed as expressions with
//! values. The evaluator is our own, since it must read the equations as they are displayed, with products by
//! juxtaposition, scalar products N·L, colours and degrees as a unit, rather than the syntax of a general
//! expression library.
//!
//! ```text
//! expression  sum ["if" condition ["else" expression]]
//! condition   sum ("<" | "≤" | ">" | "≥" | "=") sum, several of them with "and" between
//! sum         ["−"] product (("+" | "−") product)*
//! product     factor (["×" | "·" | "/"] factor)*, from left to right: a/b c is (a/b) c,
//!             and a/b(c) without a space is a/(b c), as it is set
//! factor      number, symbol, scalar product a·b, f(x), function of a factor or in brackets, (sum), (r, g, b), |sum|;
//!             each with a power
//! ```
//!
//! A symbol directly before a bracket is a function, but a product if a space is between them. Angles have a
//! unit: `20°` multiplied or divided by numbers stays an angle, `20°/180°` is a number, and a sum of an angle
//! and a number is an error, so an equation that mistakes degrees for radians cannot be evaluated. A product
//! whose left factor is zero is zero, and its right factor is not evaluated; nor is the branch of a condition
//! that does not apply.

use std::cmp::Ordering;

use super::mathematics::{Atom, MAX_DEPTH, beyond_limits, parse as atoms, write};

/// Letters of directions, whose scalar products are written `N·L`.
const VECTORS: &str = "NLVHRTB";
/// Maximum nesting of an expression; powers and signs count like brackets.
const DEEPEST: usize = 4 * MAX_DEPTH;

/// A value: red, green and blue, all equal for a number, and the power of the unit degree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Value {
    /// The three channels.
    pub rgb: [f64; 3],
    /// 1 for angles in degrees, 0 for numbers, 2 for the square of an angle.
    pub degrees: i32,
    /// True for a colour, even a grey one, and for values calculated from one.
    pub is_colour: bool,
}

impl Value {
    /// A plain number.
    #[must_use]
    pub const fn number(v: f64) -> Self {
        Self { rgb: [v; 3], degrees: 0, is_colour: false }
    }

    /// A colour.
    #[must_use]
    pub const fn colour(rgb: [f64; 3]) -> Self {
        Self { rgb, degrees: 0, is_colour: true }
    }

    /// An angle in degrees.
    #[must_use]
    pub const fn angle(degrees: f64) -> Self {
        Self { rgb: [degrees; 3], degrees: 1, is_colour: false }
    }

    /// True if red, green and blue are equal.
    #[must_use]
    pub fn is_grey(&self) -> bool {
        let [r, g, b] = self.rgb;
        r == g && g == b
    }

    fn is_zero(&self) -> bool {
        self.rgb == [0.0; 3]
    }

    fn map(self, degrees: i32, f: impl Fn(f64) -> f64) -> Self {
        Self { rgb: self.rgb.map(f), degrees, ..self }
    }

    fn zip(self, other: Self, degrees: i32, f: impl Fn(f64, f64) -> f64) -> Self {
        Self {
            rgb: std::array::from_fn(|i| f(self.rgb[i], other.rgb[i])),
            degrees,
            is_colour: self.is_colour || other.is_colour,
        }
    }

    /// The unit of two values that are added or compared: their common unit, or that of the other for zero.
    fn common(self, other: Self) -> Result<i32, String> {
        match (self.degrees, other.degrees) {
            (a, b) if a == b => Ok(a),
            (a, _) if other.is_zero() => Ok(a),
            (_, b) if self.is_zero() => Ok(b),
            _ => Err("an angle and a number are added or compared".to_owned()),
        }
    }

    fn plain(self, what: &str) -> Result<Self, String> {
        if self.degrees == 0 { Ok(self) } else { Err(format!("{what} of an angle in degrees")) }
    }

    /// The value in radians, for functions of angles; a plain number is already in radians.
    fn radians(self) -> Result<Self, String> {
        match self.degrees {
            0 => Ok(self),
            1 => Ok(self.map(0, f64::to_radians)),
            _ => Err("the square of an angle is no angle".to_owned()),
        }
    }
}

/// Provides the values of names in expressions.
pub trait Scope {
    /// The value of a symbol, such as `k_d` or `F_{90}`, or of a scalar product, `N·L`.
    ///
    /// # Errors
    /// Returns the reason, in words, if the symbol has no value or cannot be calculated.
    fn value(&mut self, symbol: &str) -> Result<Value, String>;

    /// The value of a function that is not built in: `F(N·L)`. The arguments are as written.
    ///
    /// # Errors
    /// Returns the reason, in words, if the function has no value or cannot be calculated.
    fn call(&mut self, name: &str, arguments: &[String]) -> Result<Value, String>;
}

/// The names of the built-in functions.
const FUNCTIONS: [&str; 17] = [
    "max", "min", "exp", "ln", "√", "sin", "cos", "tan", "arccos", "arcsin", "arctan", "clamp", "mean",
    "abs", "floor", "ceil", "fract",
];

/// True for the name of a built-in function.
#[must_use]
pub fn is_function(word: &str) -> bool {
    FUNCTIONS.contains(&word)
}

/// The value of a built-in function.
fn apply(function: &str, x: &[Value]) -> Result<Value, String> {
    let first = x.first().copied().ok_or("a function without an argument")?;
    let fold = |f: fn(f64, f64) -> f64| -> Result<Value, String> {
        x[1..].iter().try_fold(first, |a, b| Ok(a.zip(*b, a.common(*b)?, f)))
    };
    Ok(match function {
        "max" => fold(f64::max)?,
        "min" => fold(f64::min)?,
        "clamp" => apply("min", &[apply("max", &[first, x[1]])?, x[2]])?,
        "√" if first.degrees % 2 == 0 => first.map(first.degrees / 2, f64::sqrt),
        "√" => return Err("the root of an angle".to_owned()),
        "sin" => first.radians()?.map(0, f64::sin),
        "cos" => first.radians()?.map(0, f64::cos),
        "tan" => first.radians()?.map(0, f64::tan),
        // Equations have angles in degrees.
        "arccos" => first.plain(function)?.map(1, |c| c.clamp(-1.0, 1.0).acos().to_degrees()),
        "arcsin" => first.plain(function)?.map(1, |s| s.clamp(-1.0, 1.0).asin().to_degrees()),
        "arctan" => first.plain(function)?.map(1, |t| t.atan().to_degrees()),
        "abs" => first.map(first.degrees, f64::abs),
        "mean" => {
            let mean = first.rgb.iter().sum::<f64>() / 3.0;
            Value { rgb: [mean; 3], is_colour: false, ..first }
        }
        "exp" => first.plain(function)?.map(0, f64::exp),
        "ln" => first.plain(function)?.map(0, f64::ln),
        "floor" => first.plain(function)?.map(0, f64::floor),
        "ceil" => first.plain(function)?.map(0, f64::ceil),
        _ => first.plain(function)?.map(0, |v| v - v.floor()),
    })
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Sign {
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
}

/// A parsed expression.
#[derive(Clone, Debug, PartialEq)]
pub struct Expression(Node);

#[derive(Clone, Debug, PartialEq)]
enum Node {
    Known(Value),
    Symbol(String),
    Triple(Box<[Node; 3]>),
    Negative(Box<Node>),
    Two(Sign, Box<[Node; 2]>),
    Function(&'static str, Vec<Node>),
    Call(String, Vec<String>),
    /// Both branches, and the conditions: their sides, and the orders in which these may be.
    If(Box<(Node, Option<Node>)>, Vec<(Node, &'static [Ordering], Node)>),
}

impl Expression {
    /// Parses an expression.
    ///
    /// # Errors
    /// Returns the reason, in words, if the text is not an expression, or exceeds the limits of equations.
    pub fn read(text: &str) -> Result<Self, String> {
        if let Some((_, what)) = beyond_limits(text) {
            return Err(what);
        }
        Self::of_atoms(&atoms(text), 0)
    }

    fn of_atoms(atoms: &[Atom], depth: usize) -> Result<Self, String> {
        let mut reader = Reader { atoms, at: 0, depth };
        let node = reader.expression()?;
        reader.skip_spaces();
        match reader.peek() {
            None => Ok(Self(node)),
            Some(atom) => Err(format!("{} is not expected here", quote(atom))),
        }
    }

    /// Evaluates the expression.
    ///
    /// # Errors
    /// Returns the reason, in words, if something in it has no value, or units do not match.
    pub fn value(&self, scope: &mut dyn Scope) -> Result<Value, String> {
        self.0.value(scope)
    }
}

fn quote(atom: &Atom) -> String {
    format!("“{}”", atom.base())
}

impl Node {
    fn value(&self, scope: &mut dyn Scope) -> Result<Value, String> {
        Ok(match self {
            Self::Known(value) => *value,
            Self::Symbol(symbol) => scope.value(symbol)?,
            Self::Triple(parts) => {
                let [r, g, b] = [parts[0].value(scope)?, parts[1].value(scope)?, parts[2].value(scope)?];
                Value {
                    rgb: [r.rgb[0], g.rgb[1], b.rgb[2]],
                    degrees: r.common(g)?.max(b.degrees),
                    is_colour: true,
                }
            }
            Self::Negative(of) => {
                let value = of.value(scope)?;
                value.map(value.degrees, |v| -v)
            }
            Self::Two(sign, sides) => {
                let a = sides[0].value(scope)?;
                if a.is_zero() && matches!(sign, Sign::Multiply | Sign::Divide) {
                    return Ok(Value::number(0.0));
                }
                two(*sign, a, sides[1].value(scope)?)?
            }
            Self::Function(function, arguments) => {
                let values: Vec<_> = arguments.iter().map(|x| x.value(scope)).collect::<Result<_, _>>()?;
                apply(function, &values)?
            }
            Self::Call(name, arguments) => scope.call(name, arguments)?,
            Self::If(sides, conditions) => {
                let mut holds = true;
                for (a, orders, b) in conditions {
                    holds = holds
                        && compare(a.value(scope)?, b.value(scope)?)?.is_some_and(|o| orders.contains(&o));
                }
                match &**sides {
                    (side, _) if holds => side.value(scope)?,
                    (_, Some(side)) => side.value(scope)?,
                    (_, None) => return Err("its condition does not hold".to_owned()),
                }
            }
        })
    }
}

fn two(sign: Sign, a: Value, b: Value) -> Result<Value, String> {
    Ok(match sign {
        Sign::Add => a.zip(b, a.common(b)?, |a, b| a + b),
        Sign::Subtract => a.zip(b, a.common(b)?, |a, b| a - b),
        Sign::Multiply => a.zip(b, a.degrees + b.degrees, |a, b| a * b),
        Sign::Divide => a.zip(b, a.degrees - b.degrees, |a, b| a / b),
        Sign::Power => {
            let b = b.plain("a power")?;
            let whole = b.is_grey() && b.rgb[0].fract() == 0.0 && b.rgb[0].abs() < 9.0;
            match a.degrees {
                0 => a.zip(b, 0, f64::powf),
                unit if whole => a.zip(b, unit * b.rgb[0] as i32, f64::powf),
                _ => return Err("a power of an angle that is no whole number".to_owned()),
            }
        }
    })
}

/// The orders of two sides for which the sign of a condition holds.
fn orders(sign: &str) -> Option<&'static [Ordering]> {
    let orders: &[_] = match sign {
        "<" => &[Ordering::Less],
        "≤" => &[Ordering::Less, Ordering::Equal],
        ">" => &[Ordering::Greater],
        "≥" => &[Ordering::Greater, Ordering::Equal],
        "=" => &[Ordering::Equal],
        _ => return None,
    };
    Some(orders)
}

/// The order of two values; `None` for values that are not numbers.
fn compare(a: Value, b: Value) -> Result<Option<Ordering>, String> {
    a.common(b)?;
    if !a.is_grey() || !b.is_grey() {
        return Err("a condition compares colours".to_owned());
    }
    Ok(a.rgb[0].partial_cmp(&b.rgb[0]))
}

struct Reader<'a> {
    atoms: &'a [Atom],
    at: usize,
    depth: usize,
}

impl<'a> Reader<'a> {
    fn peek(&self) -> Option<&'a Atom> {
        self.atoms.get(self.at)
    }

    fn skip_spaces(&mut self) {
        while self.peek() == Some(&Atom::Space) {
            self.at += 1;
        }
    }

    /// The next atom that is not a space, without consuming it.
    fn next_base(&mut self) -> &'a str {
        self.skip_spaces();
        self.peek().map_or("", Atom::base)
    }

    fn takes(&mut self, base: &str) -> bool {
        let found = self.next_base() == base;
        self.at += usize::from(found);
        found
    }

    fn deeper<T>(&mut self, read: impl FnOnce(&mut Self) -> Result<T, String>) -> Result<T, String> {
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err("it is nested too deep".to_owned());
        }
        let read = read(self);
        self.depth -= 1;
        read
    }

    fn expression(&mut self) -> Result<Node, String> {
        self.deeper(|reader| {
            let value = reader.sum()?;
            if !reader.takes("if") {
                return Ok(value);
            }
            let mut conditions = vec![reader.condition()?];
            while reader.takes("and") {
                conditions.push(reader.condition()?);
            }
            let otherwise = if reader.takes("else") { Some(reader.expression()?) } else { None };
            Ok(Node::If(Box::new((value, otherwise)), conditions))
        })
    }

    fn condition(&mut self) -> Result<(Node, &'static [Ordering], Node), String> {
        let a = self.sum()?;
        let orders = orders(self.next_base()).ok_or("a condition compares two values")?;
        self.at += 1;
        Ok((a, orders, self.sum()?))
    }

    fn sum(&mut self) -> Result<Node, String> {
        let negative = matches!(self.next_base(), "−" | "-" | "+") && {
            let sign = self.next_base();
            self.at += 1;
            sign != "+"
        };
        let mut sum = self.product()?;
        if negative {
            sum = Node::Negative(Box::new(sum));
        }
        loop {
            let sign = match self.next_base() {
                "+" => Sign::Add,
                "−" | "-" => Sign::Subtract,
                _ => return Ok(sum),
            };
            self.at += 1;
            sum = Node::Two(sign, Box::new([sum, self.product()?]));
        }
    }

    fn product(&mut self) -> Result<Node, String> {
        let mut product = self.factor()?;
        loop {
            let sign = self.next_base();
            self.at += usize::from(matches!(sign, "×" | "·" | "/"));
            let (sign, factor) = match sign {
                "/" => (Sign::Divide, self.divisor()?),
                "" | "+" | "−" | "-" | ")" | "]" | "," | "|" | "if" | "else" | "and" | "<" | "≤" | ">"
                | "≥" | "=" => return Ok(product),
                _ => (Sign::Multiply, self.factor()?),
            };
            product = Node::Two(sign, Box::new([product, factor]));
        }
    }

    /// The divisor after a slash: one factor after a space, and otherwise everything up to the next space, as
    /// in print.
    fn divisor(&mut self) -> Result<Node, String> {
        let spaced = self.peek() == Some(&Atom::Space);
        let mut divisor = self.factor()?;
        let begins = |atom: &Atom| {
            matches!(atom, Atom::Symbol { .. }) || matches!(atom.base(), "(" | "[" | "√") || {
                let base = atom.base();
                base.starts_with(|c: char| c.is_ascii_digit()) || is_function(base)
            }
        };
        while !spaced && self.peek().is_some_and(begins) {
            divisor = Node::Two(Sign::Multiply, Box::new([divisor, self.factor()?]));
        }
        Ok(divisor)
    }

    /// An atom that ends a factor, with its power.
    fn raised(&mut self, base: Node, by: &Atom) -> Result<Node, String> {
        if by.sup().is_empty() {
            return Ok(base);
        }
        let power = Expression::of_atoms(&atoms(by.sup()), self.depth + 1)?;
        Ok(Node::Two(Sign::Power, Box::new([base, power.0])))
    }

    fn factor(&mut self) -> Result<Node, String> {
        self.deeper(Self::one_factor)
    }

    fn one_factor(&mut self) -> Result<Node, String> {
        self.skip_spaces();
        let atom = self.peek().ok_or("something is missing at the end")?;
        self.at += 1;
        if let Some(symbol) = atom.symbol() {
            return self.symbol(atom, symbol);
        }
        let base = atom.base();
        if let Some(function) = FUNCTIONS.into_iter().find(|known| *known == base) {
            let (arguments, bracket) = self.arguments_of(function)?;
            // A power of the function's name, as in tan² θ, applies to its value.
            let value = self.raised(Node::Function(function, arguments), atom)?;
            return match bracket {
                Some(bracket) => self.raised(value, bracket),
                None => Ok(value),
            };
        }
        match base {
            "(" | "[" => {
                let (parts, close) = self.list(if base == "(" { ")" } else { "]" })?;
                let inside = match <[Node; 3]>::try_from(parts) {
                    Ok(colour) => Node::Triple(Box::new(colour)),
                    Err(mut parts) if parts.len() == 1 => parts.remove(0),
                    Err(parts) => {
                        let n = parts.len();
                        return Err(format!("brackets hold one value or the three of a colour, not {n}"));
                    }
                };
                self.raised(inside, close)
            }
            "|" => {
                let inside = self.sum()?;
                self.skip_spaces();
                let close = self.peek().filter(|atom| atom.base() == "|").ok_or("a bar is not closed")?;
                self.at += 1;
                self.raised(Node::Function("abs", vec![inside]), close)
            }
            // A sign before a factor, as in 2 × (−1) without its brackets.
            "−" | "-" => Ok(Node::Negative(Box::new(self.factor()?))),
            number if number.starts_with(|c: char| c.is_ascii_digit()) => self.number(atom),
            _ => Err(format!("{} is no value", quote(atom))),
        }
    }

    fn number(&mut self, atom: &Atom) -> Result<Node, String> {
        let unread = || format!("{} is no number", quote(atom));
        let mut value: f64 = atom.base().parse().map_err(|_| unread())?;
        // 1.5·10^−7 is one number.
        if let [dot, ten, ..] = &self.atoms[self.at..]
            && (dot.base(), ten.base()) == ("·", "10")
            && atom.sup().is_empty()
        {
            let power: i32 = ten.sup().replace('−', "-").parse().map_err(|_| unread())?;
            value = format!("{}e{power}", atom.base()).parse().map_err(|_| unread())?;
            self.at += 2;
        }
        if self.peek().is_some_and(|degree| degree.base() == "°") {
            let degree = &self.atoms[self.at];
            self.at += 1;
            let angle = self.raised(Node::Known(Value::angle(value)), degree)?;
            return self.raised(angle, atom);
        }
        self.raised(Node::Known(Value::number(value)), atom)
    }

    fn symbol(&mut self, atom: &Atom, symbol: String) -> Result<Node, String> {
        let is_vector = |atom: &Atom| {
            atom.sub().is_empty()
                && matches!(atom, Atom::Symbol { base, .. } if VECTORS.contains(base.as_str()))
        };
        if let [dot, other, ..] = &self.atoms[self.at..]
            && dot.base() == "·"
            && is_vector(atom)
            && is_vector(other)
            && atom.sup().is_empty()
        {
            self.at += 2;
            let product = format!("{}·{}", atom.base(), other.base());
            return self.raised(Node::Symbol(product), other);
        }
        if self.peek().is_some_and(|next| next.base() == "(") && atom.sup().is_empty() {
            self.at += 1;
            let start = self.at;
            let (parts, close) = self.list(")")?;
            let texts = split(&self.atoms[start..self.at - 1]);
            debug_assert_eq!(parts.len(), texts.len());
            return self.raised(Node::Call(symbol, texts), close);
        }
        let value = match symbol.as_str() {
            "π" => Node::Known(Value::number(std::f64::consts::PI)),
            _ => Node::Symbol(symbol),
        };
        self.raised(value, atom)
    }

    /// The arguments of a function, and the bracket that closes them, if there are brackets.
    fn arguments_of(&mut self, function: &str) -> Result<(Vec<Node>, Option<&'a Atom>), String> {
        self.skip_spaces();
        if self.peek().is_none_or(|next| next.base() != "(") {
            return Ok((vec![self.factor()?], None));
        }
        self.at += 1;
        let (parts, close) = self.list(")")?;
        let (least, most) = match function {
            "max" | "min" => (2, 8),
            "clamp" => (3, 3),
            _ => (1, 1),
        };
        // The brackets of a colour are those of the argument.
        let parts = match <[Node; 3]>::try_from(parts) {
            Ok(colour) if most == 1 => vec![Node::Triple(Box::new(colour))],
            Ok(three) => three.into(),
            Err(parts) => parts,
        };
        if !(least..=most).contains(&parts.len()) {
            return Err(format!("a function has {} arguments", parts.len()));
        }
        Ok((parts, Some(close)))
    }

    /// Values separated by commas, up to a closing bracket.
    fn list(&mut self, close: &str) -> Result<(Vec<Node>, &'a Atom), String> {
        let mut parts = vec![self.expression()?];
        loop {
            self.skip_spaces();
            let atom = self.peek().ok_or("a bracket is not closed")?;
            self.at += 1;
            match atom.base() {
                "," => parts.push(self.expression()?),
                base if base == close => return Ok((parts, atom)),
                _ => return Err(format!("{} is not expected here", quote(atom))),
            }
        }
    }
}

/// Arguments as written, without their commas.
fn split(atoms: &[Atom]) -> Vec<String> {
    let (mut texts, mut start, mut depth) = (Vec::new(), 0, 0);
    for (i, atom) in atoms.iter().enumerate() {
        match atom.base() {
            "(" | "[" => depth += 1,
            ")" | "]" => depth -= 1,
            "," if depth == 0 => {
                texts.push(write(&atoms[start..i]));
                start = i + 1;
            }
            _ => {}
        }
    }
    texts.push(write(&atoms[start..]));
    texts
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Known;

    impl Scope for Known {
        fn value(&mut self, symbol: &str) -> Result<Value, String> {
            match symbol {
                "α" => Ok(Value::number(0.5)),
                "C_b" => Ok(Value::colour([1.0, 0.5, 0.0])),
                "N·L" => Ok(Value::number(0.25)),
                "σ" => Ok(Value::angle(60.0)),
                "F_90" => Ok(Value::number(2.0)),
                "z" => Ok(Value::number(0.0)),
                _ => Err(format!("{symbol} is unknown")),
            }
        }

        fn call(&mut self, name: &str, arguments: &[String]) -> Result<Value, String> {
            let value = Expression::read(&arguments[0])?.value(self)?;
            if name == "F" { Ok(value.map(0, |v| 10.0 * v)) } else { Err(format!("{name} is unknown")) }
        }
    }

    fn value(text: &str) -> Result<Value, String> {
        Expression::read(text)?.value(&mut Known)
    }

    fn near(text: &str, expected: [f64; 3]) {
        let got = value(text).unwrap_or_else(|why| panic!("{text}: {why}"));
        for (a, b) in got.rgb.iter().zip(expected) {
            assert!((a - b).abs() < 1e-12 * b.abs().max(1.0), "{text}: {got:?}, not {expected:?}");
        }
    }

    #[test]
    fn expressions_have_the_values_of_textbooks() {
        for (text, expected) in [
            ("1 + 2 × 3", 7.0),
            ("6/2 (1 + 2)", 9.0),
            ("6/2(1 + 2)", 1.0),
            ("6 / 2 3", 9.0),
            ("α/(1)(2) 4", 1.0),
            ("1/2 α", 0.25),
            ("−2^2", -4.0),
            ("(−2)^2", 4.0),
            ("2^{1 + 1} − 1", 3.0),
            ("2^3^2", 512.0),
            ("2^{1 + 1}^2", 16.0),
            ("2 − 3 − 4", -5.0),
            ("max(0, −N·L)", 0.0),
            ("(N·L)^2", 0.0625),
            ("1 − N·L/2", 0.875),
            ("√(16) 2", 8.0),
            ("√(9)/6", 0.5),
            ("exp(−(1 − 1))", 1.0),
            ("cos σ", 0.5),
            ("sin^2 σ + cos^2 σ", 1.0),
            ("cos 60°", 0.5),
            ("σ/90°", 2.0 / 3.0),
            ("σ π/180°", std::f64::consts::FRAC_PI_3),
            ("(σ/180°)^2", 1.0 / 9.0),
            ("arccos(1/2)/60°", 1.0),
            ("1.5·10^−3 × 2", 0.003),
            ("F(N·L)", 2.5),
            ("F(α − N·L) F(1)", 25.0),
            ("F_{90} 3", 6.0),
            ("|1 − 3|^2", 4.0),
            ("1 if N·L > 0 else 2", 1.0),
            ("1 if N·L > 0 and α = 0 else 2 if α < 1 else 3", 2.0),
            ("mean(C_b)", 0.5),
            ("abs(−2) + floor(1.5) + ceil(0.2) + fract(2.25)", 4.25),
            ("clamp(3, 0, 1)", 1.0),
            ("2 × −3", -6.0),
            ("0 × q", 0.0),
            ("z f_x", 0.0),
            ("2 if α = 1/2 else q", 2.0),
        ] {
            near(text, [expected; 3]);
        }
        near("C_b^2 2", [2.0, 0.5, 0.0]);
        near("0.5 × (1, 0.5, 0) × max(0, 0.25)", [0.125, 0.0625, 0.0]);
        near("√((4, 9, 16))", [2.0, 3.0, 4.0]);
        near("(1, 2, 3)^2", [1.0, 4.0, 9.0]);
    }

    #[test]
    fn degrees_are_not_taken_for_numbers() {
        for text in ["σ + 1", "exp(σ)", "max(σ, 0.3)", "1 if σ > 0.3 else 2", "√(σ)", "2^σ", "cos (σ^2)"]
        {
            let got = value(text).expect_err(text);
            assert!(got.contains("angle"), "{text}: {got}");
        }
        assert_eq!(value("2 σ").map(|v| v.degrees), Ok(1));
        assert_eq!(value("σ^2").map(|v| v.degrees), Ok(2));
        assert_eq!(value("σ^2/σ^2").map(|v| v.degrees), Ok(0));
        assert_eq!(value("√(σ^2)").map(|v| v.degrees), Ok(1));
        assert_eq!(value("max(0, σ)"), Ok(Value::angle(60.0)));
        assert!(
            value("0 + C_b").is_ok_and(|v| v.is_colour) && value("mean(C_b)").is_ok_and(|v| !v.is_colour)
        );
    }

    #[test]
    fn what_is_no_expression_is_refused_in_words() {
        for (text, what) in [
            ("", "missing"),
            ("1 +", "missing"),
            ("(1", "not closed"),
            ("1)", "“)” is not expected"),
            ("(1, 2)", "not 2"),
            ("∫ f", "“∫” is no value"),
            ("1.2.3", "no number"),
            ("1 if 2", "compares"),
            ("1 if 2 > 3", "does not hold"),
            ("max(1)", "1 arguments"),
            ("q", "q is unknown"),
            ("g(1)", "g is unknown"),
            ("|2", "not closed"),
            ("1 if C_b > 0 else 2", "colours"),
        ] {
            let got = value(text).expect_err(text);
            assert!(got.contains(what), "{text}: {got}");
        }
        for deep in ["−", "(", "√", "cos ", "|(", "2^{", "2^", "2^2^"] {
            assert!(value(&deep.repeat(900)).is_err(), "{deep}");
        }
    }
}
