//! The expanded size of constants and types: `const B = array(A, A)` doubles with every line, and an array of
//! arrays multiplies the lengths. The parser evaluates constants, so the size is estimated before, from the
//! text: a name counts as many words as its declaration.

use std::{cell::Cell, collections::HashMap};

use super::{
    Limits, Refusal, limited,
    token::{Finding, Kind, Token, at_most},
};

/// A declaration of the module.
struct Declaration<'a> {
    name: &'a str,
    at: usize,
    /// True for constants and types, which are expanded where they are used. Functions and variables are not.
    expands: bool,
    /// The tokens after the name.
    first: usize,
    end: usize,
}

/// The state of a declaration.
#[derive(Clone, Copy)]
enum State {
    Unknown,
    /// Being examined: the parser reports a declaration that uses itself.
    Open,
    /// The expanded number of words, and the longest chain of declarations in it.
    Known(u64, usize),
}

struct Search<'a> {
    limits: &'a Limits,
    tokens: &'a [Token<'a>],
    declarations: Vec<Declaration<'a>>,
    /// Declarations by name. Names declared twice, as in both branches of a condition, stand for both.
    by_name: HashMap<&'a str, Vec<usize>>,
    states: Vec<State>,
    /// For each declaration, the one in it with the longest chain.
    next: Vec<usize>,
    /// The declarations being examined, each within the one before.
    path: Vec<usize>,
    /// Initial values of constants, including those in functions, since array lengths may refer to them.
    values: HashMap<&'a str, Vec<(usize, usize)>>,
    /// The number of tokens left for calculating the lengths of arrays.
    steps: Cell<u32>,
}

/// Maximum number of tokens read for the lengths of all arrays, since constants that use each other may be
/// many.
const STEPS: u32 = 1 << 20;

/// Checks the declarations of a text.
pub(super) fn check(tokens: &[Token], limits: &Limits) -> Result<(), Refusal> {
    let (declarations, values) = declarations(tokens);
    limited(declarations.len(), limits.declarations, "declarations")?;
    let mut by_name: HashMap<_, Vec<_>> = HashMap::with_capacity(declarations.len());
    for (i, declaration) in declarations.iter().enumerate() {
        by_name.entry(declaration.name).or_default().push(i);
    }
    let states = vec![State::Unknown; declarations.len()];
    let next = vec![usize::MAX; declarations.len()];
    let steps = Cell::new(STEPS);
    let path = Vec::new();
    let mut search = Search { limits, tokens, declarations, by_name, states, next, path, values, steps };
    let (mut sum, mut parts) = (0_u64, Vec::new());
    for i in 0..search.declarations.len() {
        let words = search.declaration(i)?.0;
        sum = sum.saturating_add(words);
        parts.push((search.declarations[i].at, words));
        if sum > 4 * limits.expansion {
            let what = format!(
                "constants and types are expanded where they are used, which makes more than {} words in the composed shader",
                4 * limits.expansion
            );
            return Err(Refusal::Sum(parts, what));
        }
    }
    Ok(())
}

/// The declarations of a module, and the values of its constants.
fn declarations<'a>(tokens: &'a [Token]) -> (Vec<Declaration<'a>>, HashMap<&'a str, Vec<(usize, usize)>>) {
    let mut found = Vec::new();
    let mut values: HashMap<_, Vec<_>> = HashMap::new();
    let (mut i, mut braces) = (0, 0_usize);
    // The declaration that has not ended yet.
    let mut open: Option<Declaration> = None;
    while let Some(token) = tokens.get(i) {
        match (token.kind, token.text) {
            (Kind::Word, word @ ("const" | "alias" | "struct" | "fn" | "var" | "override")) => {
                let mut at = i + 1;
                if let Some(template) = tokens.get(at).filter(|t| t.kind == Kind::TemplateOpen) {
                    at = template.end + 1;
                }
                if let Some(name) = tokens.get(at).filter(|t| t.kind == Kind::Word) {
                    if word == "const" {
                        values.entry(name.text).or_default().push(value(tokens, at + 1));
                    }
                    if braces == 0 {
                        found.extend(open.take().map(|d| Declaration { end: i, ..d }));
                        let expands = matches!(word, "const" | "alias" | "struct");
                        open = Some(Declaration {
                            name: name.text,
                            at: name.at,
                            expands,
                            first: at + 1,
                            end: at + 1,
                        });
                    }
                    i = at;
                }
            }
            (Kind::Open, "{") => braces += 1,
            (Kind::Close, "}") => {
                braces = braces.saturating_sub(1);
                if braces == 0 {
                    found.extend(open.take().map(|d| Declaration { end: i, ..d }));
                }
            }
            (Kind::Semicolon, _) if braces == 0 => {
                found.extend(open.take().map(|d| Declaration { end: i, ..d }));
            }
            _ => {}
        }
        i += 1;
    }
    found.extend(open.map(|d| Declaration { end: tokens.len(), ..d }));
    (found, values)
}

/// The tokens of an initial value: after `=`, up to the semicolon.
fn value(tokens: &[Token], from: usize) -> (usize, usize) {
    let rest = &tokens[from.min(tokens.len())..];
    let end = rest.iter().position(|t| t.kind == Kind::Semicolon).unwrap_or(rest.len());
    let start = rest[..end].iter().position(|t| t.text == "=").map_or(end, |at| at + 1);
    (from + start, from + end)
}

impl<'a> Search<'a> {
    /// The expanded number of words of a declaration, and its chain.
    fn declaration(&mut self, i: usize) -> Result<(u64, usize), Finding> {
        match self.states[i] {
            State::Known(words, below) => return Ok((words, below)),
            State::Open => return Ok((1, 0)),
            State::Unknown => {}
        }
        let Declaration { at, first, end, expands, .. } = self.declarations[i];
        self.path.push(i);
        if self.path.len() > self.limits.chain {
            return Err(self.chain(self.path[self.limits.chain / 2], self.path.len()));
        }
        self.states[i] = State::Open;
        let (words, below) = self.words(first, end, i)?;
        let chain = below + 1;
        if chain > self.limits.chain {
            // The ends of a chain are built in, so its middle is reported.
            let middle = (0..self.limits.chain / 2).fold(i, |at, _| self.next.get(at).copied().unwrap_or(at));
            return Err(self.chain(middle, chain));
        }
        if expands {
            at_most(words, self.limits.expansion, at, "", || expands_to(words))?;
        }
        self.states[i] = State::Known(words, chain);
        self.path.pop();
        Ok((words, chain))
    }

    fn chain(&self, blamed: usize, length: usize) -> Finding {
        let what = format!(
            "this is part of a chain of {length} constants, types and functions, each of which uses the next; at most {} are allowed",
            self.limits.chain
        );
        (self.declarations.get(blamed).map_or(0, |d| d.at), what)
    }

    /// The expanded number of words of some tokens, and the longest chain of declarations below them.
    fn words(&mut self, first: usize, end: usize, user: usize) -> Result<(u64, usize), Finding> {
        let tokens = self.tokens;
        // The enclosing arrays: the end and the place of each, and the product of their numbers of elements.
        let mut arrays: Vec<(usize, usize, u64)> = Vec::new();
        let (mut sum, mut below) = (0_u64, 0);
        for i in first..end.min(tokens.len()) {
            while arrays.last().is_some_and(|(end, ..)| *end <= i) {
                arrays.pop();
            }
            let elements = arrays.last().map_or(1, |(.., elements)| *elements);
            let token = tokens[i];
            let mut words = 1;
            if token.kind == Kind::Word {
                let next = tokens.get(i + 1);
                let list = next.filter(|n| n.kind == Kind::TemplateOpen).map(|n| n.end);
                if let Some(list) = list.filter(|_| token.text == "array") {
                    let elements = elements.saturating_mul(self.length(token, i + 2, list)?);
                    arrays.push((list, token.at, elements));
                }
                let member = i > 0 && tokens[i - 1].kind == Kind::Dot;
                let called = next.is_some_and(|n| n.text == "(");
                let named = if member { None } else { self.by_name.get(token.text).cloned() };
                for declaration in named.into_iter().flatten() {
                    let expands = self.declarations[declaration].expands;
                    if expands || called {
                        let (grown, chain) = self.declaration(declaration)?;
                        if chain > below {
                            below = chain;
                            self.next[user] = declaration;
                        }
                        words += if expands { grown } else { 0 };
                    }
                }
            }
            let words = elements.saturating_mul(words);
            // In a function, or as the type of a variable, nothing else limits it before the sum of all. Nested
            // arrays count by what is in the innermost.
            if token.kind == Kind::Word && token.text != "array" {
                let at = arrays.first().map_or(token.at, |(_, at, _)| *at);
                at_most(words, self.limits.expansion, at, "", || expands_to(words))?;
            }
            sum = sum.saturating_add(words);
        }
        Ok((sum, below))
    }

    /// The greatest number of elements of an array, given the tokens of its template list.
    fn length(&self, array: Token, first: usize, end: usize) -> Result<u64, Finding> {
        let (mut at, mut brackets, mut commas) = (first, 0_usize, Vec::new());
        while at < end {
            match self.tokens[at].kind {
                Kind::TemplateOpen => at = self.tokens[at].end,
                Kind::Open => brackets += 1,
                Kind::Close => brackets = brackets.saturating_sub(1),
                Kind::Comma if brackets == 0 => commas.push(at),
                _ => {}
            }
            at += 1;
        }
        // A trailing comma is allowed.
        let last = commas.get(1).copied().unwrap_or(end);
        let Some(comma) = commas.first().copied() else { return Ok(1) };
        let count = self.magnitude(comma + 1, last, 0);
        match count {
            Some(count) if count <= self.limits.elements => Ok(count),
            Some(count) => {
                let what = format!("this array has up to {count} elements; at most {} are allowed", self.limits.elements);
                Err((array.at, what))
            }
            None => Err((
                array.at,
                "the length of this array cannot be determined; write it with whole numbers, constants and + - * /"
                    .to_owned(),
            )),
        }
    }

    /// The largest possible value of an integer expression: sums and products are bounded by the product of
    /// their operands, each plus one.
    fn magnitude(&self, first: usize, end: usize, depth: usize) -> Option<u64> {
        let tokens = self.tokens.get(first..end)?;
        let single = tokens.len() == 1;
        let mut product = 1_u64;
        for token in tokens {
            self.steps.set(self.steps.get().checked_sub(1)?);
            let value = match token.kind {
                Kind::Number => whole(token.text)?,
                Kind::Word if matches!(token.text, "u32" | "i32" | "min" | "max" | "abs") => continue,
                Kind::Word if depth < 8 => {
                    let values = self.values.get(token.text)?;
                    let each: Option<Vec<_>> =
                        values.iter().map(|(first, end)| self.magnitude(*first, *end, depth + 1)).collect();
                    each?.into_iter().max()?
                }
                Kind::Open | Kind::Close | Kind::Comma => continue,
                Kind::Operator if matches!(token.text, "+" | "-" | "*" | "/" | "%") => continue,
                _ => return None,
            };
            product = product.saturating_mul(if single { value } else { value.saturating_add(1) });
            if product > self.limits.elements {
                // It does not become smaller.
                break;
            }
        }
        Some(product)
    }
}

fn expands_to(words: u64) -> String {
    format!("this expands to {words} words")
}

/// An integer in the syntax of WGSL.
fn whole(text: &str) -> Option<u64> {
    let digits = text.trim_end_matches(['u', 'i']);
    match digits.strip_prefix("0x").or_else(|| digits.strip_prefix("0X")) {
        Some(digits) => u64::from_str_radix(digits, 16).ok(),
        None => digits.parse().ok(),
    }
}
