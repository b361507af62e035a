//! A WGSL text as tokens: calls, their arguments, and their declarations.

use std::ops::Range;

use crate::{
    shader::{
        limits::LIMITS,
        token::{Kind, Token, tokens},
    },
    text::{listed, plural, shortened},
};

/// The tokens of a text.
pub(super) struct Scan<'a> {
    pub text: &'a str,
    pub tokens: Vec<Token<'a>>,
}

/// A struct or a function as declared.
pub(super) struct Declared<'a> {
    name: &'a str,
    /// The names of the fields or parameters, with their types.
    pub fields: Vec<(&'a str, &'a str)>,
    /// True for a struct.
    pub is_struct: bool,
}

impl<'a> Scan<'a> {
    /// `None` for a text beyond the limits.
    pub fn new(text: &'a str) -> Option<Self> {
        Some(Self { text, tokens: tokens(text, LIMITS.tokens).ok()?.list })
    }

    /// The index of the first token that begins at or after a byte.
    pub fn at(&self, byte: usize) -> usize {
        self.tokens.partition_point(|token| token.at < byte)
    }

    /// The text of a token; empty if it does not exist.
    pub fn word(&self, token: usize) -> &'a str {
        self.tokens.get(token).map_or("", |token| token.text)
    }

    /// The text of the token `back` places before another one.
    pub fn before(&self, token: usize, back: usize) -> &'a str {
        token.checked_sub(back).map_or("", |token| self.word(token))
    }

    /// The text of a range of tokens.
    pub fn source(&self, range: Range<usize>) -> &'a str {
        let ends = self.tokens.get(range.start).zip(self.tokens.get(range.end.wrapping_sub(1)));
        ends.and_then(|(first, last)| self.text.get(first.at..last.at + last.text.len())).unwrap_or_default()
    }

    /// The index of the token that closes a bracket.
    fn close(&self, open: usize) -> Option<usize> {
        let mut depth = 0_usize;
        (open..self.tokens.len()).find(|i| {
            match self.tokens[*i].kind {
                Kind::Open | Kind::TemplateOpen => depth += 1,
                Kind::Close | Kind::TemplateClose => depth = depth.saturating_sub(1),
                _ => {}
            }
            depth == 0
        })
    }

    /// The parts between the commas in the bracket that a token opens.
    pub fn parts(&self, open: usize) -> Vec<Range<usize>> {
        let Some(end) = self.close(open) else { return Vec::new() };
        let (mut parts, mut start, mut i) = (Vec::new(), open + 1, open + 1);
        while i < end {
            match self.tokens[i].kind {
                Kind::Open | Kind::TemplateOpen => i = self.close(i).unwrap_or(end),
                Kind::Comma => {
                    parts.push(start..i);
                    start = i + 1;
                }
                _ => {}
            }
            i += 1;
        }
        parts.push(start..end);
        parts.retain(|part| !part.is_empty());
        parts
    }

    /// The text of some bytes, including the arguments if it is the name of a called function.
    pub fn value(&self, bytes: Range<usize>) -> &'a str {
        let text = self.text.get(bytes.clone()).unwrap_or_default();
        let i = self.at(bytes.start);
        let called = text == self.word(i) && self.word(i + 1) == "(";
        called.then(|| self.close(i + 1)).flatten().map_or(text, |close| self.source(i..close + 1))
    }

    /// The innermost bracket around a token, and the number of commas since.
    pub fn around(&self, token: usize) -> Option<(usize, usize)> {
        let (mut depth, mut commas) = (0_usize, 0);
        for (i, token) in self.tokens.iter().enumerate().take(token).rev() {
            match token.kind {
                Kind::Close | Kind::TemplateClose => depth += 1,
                Kind::Open if depth == 0 && token.text == "(" => return Some((i, commas)),
                Kind::Open | Kind::TemplateOpen if depth == 0 => return None,
                Kind::Open | Kind::TemplateOpen => depth -= 1,
                Kind::Comma if depth == 0 => commas += 1,
                Kind::Semicolon if depth == 0 => return None,
                _ => {}
            }
        }
        None
    }

    /// The name of the value whose definition begins at a token: the compiler names this position instead of
    /// that of the use.
    pub fn name_of(&self, token: usize) -> Option<&'a str> {
        if self.before(token, 1) == "=" && self.before(token, 3) == "let" {
            return Some(self.before(token, 2));
        }
        (self.word(token + 1) == ":").then(|| self.word(token))
    }

    /// The name of the function around a token.
    pub fn function(&self, token: usize) -> Option<&'a str> {
        let begins = self.tokens.iter().take(token).rposition(|token| token.text == "fn")?;
        Some(self.word(begins + 1))
    }

    /// The end of a message about a value that is a struct: its fields.
    pub fn fields_of(&self, of: &str, value: &str) -> Option<String> {
        let declared = self.declared(of).filter(|declared| declared.is_struct)?;
        let names: Vec<_> = declared.fields.iter().map(|(name, _)| format!("`{value}.{name}`")).collect();
        Some(format!("; use one of its fields: {}", listed(&names, "or")))
    }

    /// The bodies of all functions: the indices of their braces.
    pub fn bodies(&self) -> Vec<Range<usize>> {
        let begins = (0..self.tokens.len()).filter(|i| self.word(*i) == "fn");
        let body = |begins: usize| {
            let open = (begins..self.tokens.len()).find(|i| self.word(*i) == "{")?;
            let end = self.close(open)?;
            Some(open..end)
        };
        begins.filter_map(body).collect()
    }

    /// The tokens that end the statements of a body or begin a block in it, each with the number of open
    /// braces after it.
    pub fn statements(&self, body: &Range<usize>) -> Vec<(usize, usize)> {
        let (mut braces, mut brackets) = (1_usize, 0_usize);
        let mut ends = Vec::new();
        for i in body.start + 1..body.end {
            match self.word(i) {
                "(" | "[" => brackets += 1,
                ")" | "]" => brackets = brackets.saturating_sub(1),
                "{" => braces += 1,
                "}" => braces = braces.saturating_sub(1),
                _ => {}
            }
            if matches!(self.word(i), "{" | ";") && brackets == 0 {
                ends.push((i, braces));
            }
        }
        ends
    }

    /// The declaration of a struct or a function.
    pub fn declared(&self, name: &str) -> Option<Declared<'a>> {
        let begins = |i: &usize| matches!(self.word(*i), "struct" | "fn") && self.word(i + 1) == name;
        let begins = (0..self.tokens.len()).find(begins)?;
        let field = |part: Range<usize>| {
            let colon = part.clone().find(|i| self.tokens[*i].kind == Kind::Colon)?;
            Some((self.before(colon, 1), self.source(colon + 1..part.end)))
        };
        Some(Declared {
            name: self.word(begins + 1),
            fields: self.parts(begins + 2).into_iter().filter_map(field).collect(),
            is_struct: self.word(begins) == "struct",
        })
    }
}

impl Declared<'_> {
    /// The declaration as a call: `Terms(ambient, diffuse, specular)`, `power(x: f32, p: f32)`.
    pub fn call(&self) -> String {
        let field = |(name, of): &(&str, &str)| {
            if self.is_struct { (*name).to_owned() } else { format!("{name}: {of}") }
        };
        format!("{}({})", self.name, self.fields.iter().map(field).collect::<Vec<_>>().join(", "))
    }

    /// ", each a vec3<f32>" if all have one type.
    fn each(&self) -> String {
        match &self.fields[..] {
            [(_, of), rest @ ..] if !rest.is_empty() && rest.iter().all(|(_, other)| other == of) => {
                format!(", each {}", called(of))
            }
            _ => String::new(),
        }
    }

    /// The message about a call with a wrong number of values.
    pub fn wants(&self, count: usize) -> String {
        let fields = plural(self.fields.len(), "value");
        format!("{} takes {fields}{}, but {}", self.call(), self.each(), given(count))
    }

    /// The message about a value of the wrong type in a call.
    pub fn wants_other(&self, index: usize, got: &str, value: &str) -> Option<String> {
        let (name, of) = self.fields.get(index)?;
        Some(format!("{} needs {} for {name}, but {}", self.call(), called(of), misfit(of, got, value)))
    }
}

/// "1 is given", "2 are given".
pub(super) fn given(count: usize) -> String {
    if count == 1 { "1 is given".to_owned() } else { format!("{count} are given") }
}

/// A type in a sentence: "a number", `a vec3<f32>`.
pub(super) fn called(of: &str) -> String {
    match of {
        "f32" | "{AbstractFloat}" | "{AbstractInt}" => "a number".to_owned(),
        "i32" | "u32" => format!("a whole number ({of})"),
        "bool" => "true or false".to_owned(),
        of => format!("a {}", of.replace("{AbstractFloat}", "f32").replace("{AbstractInt}", "f32")),
    }
}

/// A piece of the author's text in a sentence.
pub(super) fn shown(value: &str) -> String {
    if value.is_empty() || value.contains('\n') {
        "this".to_owned()
    } else {
        format!("`{}`", shortened(value))
    }
}

/// "`0.0` is a number; write `vec3(0.0)`": a value where another type is expected.
pub(super) fn misfit(expected: &str, got: &str, value: &str) -> String {
    format!("{} is {}{}", shown(value), called(got), remedy(expected, got, value))
}

/// The end of a message about a value of one type where another is expected.
pub(super) fn remedy(expected: &str, got: &str, value: &str) -> String {
    if let (Some('2' | '3'), Some('3' | '4')) = (width(expected), width(got))
        && width(expected) < width(got)
    {
        return format!("; take its `.{}`", if width(expected) == Some('2') { "xy" } else { "xyz" });
    }
    if matches!(expected, "i32" | "u32") && got == "{AbstractFloat}" {
        return "; a var that begins as `1.0` instead of `1` is a number".to_owned();
    }
    match fitted(expected, got, value) {
        code if code.is_empty() => String::new(),
        _ if width(got).is_some() && width(expected).is_none() => {
            "; to get a number from a vector, use a component such as `.x`, or `dot`, or `length`".to_owned()
        }
        code => format!("; write `{code}`"),
    }
}

/// The number of components of a vector, as a letter.
fn width(of: &str) -> Option<char> {
    of.strip_prefix("vec").and_then(|rest| rest.chars().next())
}

/// The text of a value as another type; empty if it cannot be converted.
fn fitted(expected: &str, got: &str, value: &str) -> String {
    let number = |of: &str| matches!(of, "f32" | "{AbstractFloat}" | "{AbstractInt}");
    let whole = |of: &str| matches!(of, "i32" | "u32");
    let long = value.is_empty() || value.contains('\n') || value.chars().count() > 40;
    let value = if long { "…" } else { value };
    let simple = value.chars().all(|c| c.is_alphanumeric() || "_.()…".contains(c));
    let single = if simple { value.to_owned() } else { format!("({value})") };
    match (width(expected), width(got)) {
        _ if expected.starts_with("ptr<") => format!("&{value}"),
        (None, None) if number(expected) && whole(got) => format!("f32({value})"),
        (None, None) if whole(expected) && (number(got) || whole(got)) => format!("{expected}({value})"),
        (None, None) if number(expected) && got == "bool" => format!("select(0.0, 1.0, {value})"),
        (None, None) if expected == "bool" && (number(got) || whole(got)) => format!("{single} > 0"),
        (Some(n), None) if number(got) => format!("vec{n}({value})"),
        (Some(n), None) if whole(got) => format!("vec{n}(f32({value}))"),
        // The fourth component of a direction.
        (Some('4'), Some('3')) => format!("vec4({value}, 0.0)"),
        (None, Some(_)) if number(expected) => format!("{single}.x"),
        (Some(n), Some(m)) if n == m && expected.contains("f32") => match got {
            of if of.contains("i32") || of.contains("u32") => format!("vec{n}<f32>({value})"),
            _ => value.to_owned(),
        },
        _ => String::new(),
    }
}

/// The message about the result of a function: `expected` is the declared type, if there is one.
pub(super) fn result(scan: &Scan, function: &str, expected: Option<&str>, got: &str, value: &str) -> String {
    /// The way to return a single term of a struct that has several.
    const ONE_TERM: (&str, &str) = ("Terms", "Terms(vec3(0.0), …, vec3(0.0))");
    let Some(expected) = expected else {
        let returned = called(got);
        return format!(
            "{function} declares no result, but returns {returned}; write `-> TYPE` before its {{"
        );
    };
    let Some(of) = scan.declared(expected) else {
        return format!("{function} must return {}, but {}", called(expected), misfit(expected, got, value));
    };
    let one = |part: &str| match fitted(part, got, value) {
        nothing if nothing.is_empty() => "…".to_owned(),
        code => code,
    };
    let example = match (expected == ONE_TERM.0, of.fields.first()) {
        (true, Some((_, part))) => format!("; write `return {};`", ONE_TERM.1.replace('…', &one(part))),
        _ => String::new(),
    };
    let must = format!("{function} must return {}{}", of.call(), of.each());
    format!("{must}, but {} is {}{example}", shown(value), called(got))
}
