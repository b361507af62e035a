//! The declaration at the top of an own model: a comment `/* lcm { … } */` whose inside is JSON with
//! comments and trailing commas. Every mistake is told with its place, the value and the rule.

use jsonc_parser::{
    CollectOptions, ParseOptions,
    ast::{Object as AstObject, ObjectProp, Value as Ast},
    common::Ranged,
    parse_to_ast,
};

use super::intern;
use crate::{
    reflection::{
        EquationPart, Laws, Term,
        parameter::{ABOVE_ZERO, BLOCK_BYTES, Parameter, ParameterKind, layout},
    },
    registry::Registry,
    scene::{
        check::{listed, nearest},
        error::{quoted, shortened},
    },
};

/// The word behind `/*` that makes a comment the declaration.
pub const MARKER: &str = "lcm";

/// What a declaration may say.
const MODEL_KEYS: &[&str] =
    &["name", "author", "source", "summary", "equation", "laws", "anisotropic", "lobe", "parameters"];
/// What an entry of `parameters` may say.
const PARAMETER_KEYS: &[&str] = &[
    "name",
    "symbol",
    "label",
    "unit",
    "help",
    "type",
    "range",
    "min",
    "max",
    "above",
    "slider_max",
    "default",
    "choices",
];
/// What a part of the equation says.
const PART_KEYS: &[&str] = &["term", "text"];
/// The types of parameters.
const TYPES: &[&str] = &["number", "integer", "colour", "triple", "choice"];
/// The longest id or name of a parameter, characters.
const LONGEST_ID: usize = 40;
/// The longest name of a model, symbol or label, characters.
const LONGEST_NAME: usize = 60;
/// The longest text, characters.
const LONGEST_TEXT: usize = 2000;

/// A mistake: the byte in the file, and what is wrong there.
pub(super) type Mistake = (usize, String);

/// What a declaration says.
pub(super) struct Said {
    pub name: &'static str,
    pub author: &'static str,
    pub source: &'static str,
    pub summary: &'static str,
    pub equation: &'static [EquationPart],
    pub laws: Laws,
    pub anisotropic: bool,
    /// The built-in model whose lobe the model uses.
    pub lobe: Option<&'static str>,
    pub parameters: &'static [Parameter],
    /// The byte behind the comment.
    pub end: usize,
}

/// The comment that declares, within a file.
pub(super) struct Comment<'a> {
    /// What stands between the marker and the end.
    pub json: &'a str,
    /// The byte where that begins.
    pub start: usize,
    /// The byte behind the comment.
    pub end: usize,
}

/// The bytes of a comment that begins at a byte with `/*`: up to behind its end. Comments nest, as in WGSL.
fn block_comment(text: &str, start: usize) -> Option<usize> {
    let bytes = text.as_bytes();
    let (mut at, mut depth) = (start, 0);
    while at + 1 < bytes.len() {
        match &bytes[at..at + 2] {
            b"/*" => depth += 1,
            b"*/" => depth -= 1,
            _ => {
                at += 1;
                continue;
            }
        }
        at += 2;
        if depth == 0 {
            return Some(at);
        }
    }
    None
}

/// Finds the declaration: the first thing in the file but for space and other comments.
pub(super) fn comment(text: &str) -> Result<Comment<'_>, Mistake> {
    let mut at = 0;
    loop {
        at = text.len() - text[at..].trim_start().len();
        let rest = &text[at..];
        if rest.starts_with("//") {
            at += rest.find('\n').unwrap_or(rest.len());
            continue;
        }
        if !rest.starts_with("/*") {
            let what = format!(
                "the declaration is missing; a model begins with a comment /* {MARKER} {{ \"name\": …, \"parameters\": […] }} */"
            );
            return Err((at.min(text.len()), what));
        }
        let Some(end) = block_comment(text, at) else {
            return Err((at, "the comment is not closed; write */ behind it".to_owned()));
        };
        let inside = &text[at + 2..end - 2];
        let word = inside.trim_start();
        if let Some(json) =
            word.strip_prefix(MARKER).filter(|j| !j.starts_with(|c: char| c.is_alphanumeric() || c == '_'))
        {
            return Ok(Comment { json, start: end - 2 - json.len(), end });
        }
        at = end;
    }
}

/// The text without its comments: spaces in their place.
pub(super) fn without_comments(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut at = 0;
    while at < text.len() {
        let rest = &text[at..];
        let end = if rest.starts_with("//") {
            at + rest.find('\n').unwrap_or(rest.len())
        } else if rest.starts_with("/*") {
            block_comment(text, at).unwrap_or(text.len())
        } else {
            let length = rest.chars().next().map_or(1, char::len_utf8);
            out.push_str(&rest[..length]);
            at += length;
            continue;
        };
        out.extend(text[at..end].bytes().map(|b| if b == b'\n' { '\n' } else { ' ' }));
        at = end;
    }
    out
}

/// The byte of the name of a function in a WGSL text, if the text defines it.
pub(super) fn definition(text: &str, name: &str) -> Option<usize> {
    let plain = without_comments(text);
    let word = |c: char| c.is_alphanumeric() || c == '_';
    plain.match_indices("fn").find_map(|(at, _)| {
        let before = plain[..at].chars().next_back().is_none_or(|c| !word(c));
        let behind = &plain[at + 2..];
        let found = behind.trim_start();
        let rest = found.strip_prefix(name)?;
        let whole = before && found.len() < behind.len() && !rest.starts_with(word);
        whole.then(|| plain.len() - found.len())
    })
}

/// Whether an id or the name of a parameter can be used: what is wrong with it if not.
pub(super) fn identifier(id: &str) -> Result<(), String> {
    let legal = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
    let starts = id.starts_with(|c: char| c.is_ascii_lowercase());
    if !starts || !id.chars().all(legal) || id.len() > LONGEST_ID {
        return Err(format!(
            "must be lower-case letters, digits and underscores, begin with a letter and have at most {LONGEST_ID} characters"
        ));
    }
    Ok(())
}

/// Whether WGSL allows a name: it has many reserved words.
fn allowed_in_wgsl(name: &str) -> bool {
    naga::front::wgsl::parse_str(&format!("struct S {{ {name}: f32 }}")).is_ok()
}

/// An id as people read it: `charlie_sheen` is Charlie sheen.
pub(super) fn humanised(id: &str) -> String {
    let spaced = id.replace('_', " ");
    let mut letters = spaced.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// The symbol of a parameter that gives none: a Greek letter where the name begins with the name of one.
fn symbol_of(name: &str) -> String {
    const GREEK: &[(&str, &str)] = &[
        ("alpha", "α"),
        ("beta", "β"),
        ("gamma", "γ"),
        ("delta", "δ"),
        ("epsilon", "ε"),
        ("eta", "η"),
        ("theta", "θ"),
        ("kappa", "κ"),
        ("lambda", "λ"),
        ("mu", "μ"),
        ("nu", "ν"),
        ("rho", "ρ"),
        ("sigma", "σ"),
        ("tau", "τ"),
        ("phi", "φ"),
        ("omega", "ω"),
    ];
    let (first, rest) = name.split_once('_').map_or((name, None), |(f, r)| (f, Some(r)));
    let first = GREEK.iter().find(|(n, _)| *n == first).map_or(first, |(_, letter)| letter);
    match rest {
        Some(rest) => format!("{first}_{{{}}}", rest.replace('_', " ")),
        None => first.to_owned(),
    }
}

/// Reads the declaration of the model of that id.
///
/// # Errors
/// Everything that is wrong with it.
pub(super) fn read(text: &str, id: &str, registry: &Registry) -> Result<Said, Vec<Mistake>> {
    let comment = comment(text).map_err(|mistake| vec![mistake])?;
    let options = ParseOptions {
        allow_comments: true,
        allow_trailing_commas: true,
        allow_loose_object_property_names: false,
        allow_missing_commas: false,
        allow_single_quoted_strings: false,
        allow_hexadecimal_numbers: false,
        allow_unary_plus_numbers: false,
        allow_bare_decimal_point_numbers: false,
        allow_non_finite_numbers: false,
        allow_extended_string_escapes: false,
    };
    let parsed = parse_to_ast(comment.json, &CollectOptions::default(), &options).map_err(|e| {
        let what = e.kind().to_string();
        vec![(comment.start + e.range().start, format!("the declaration is not JSON: {}", lower(&what)))]
    })?;
    let Some(root) = parsed.value else {
        let what = "the declaration is empty; it must be an object: { \"name\": …, \"parameters\": […] }";
        return Err(vec![(comment.start, what.to_owned())]);
    };
    let mut reader = Reader { json: comment.json, start: comment.start, id, registry, mistakes: Vec::new() };
    let said = reader.model(&root, comment.end);
    let mut mistakes = reader.mistakes;
    match said {
        Some(said) if mistakes.is_empty() => Ok(said),
        _ => {
            mistakes.sort_by_key(|(at, _)| *at);
            Err(mistakes)
        }
    }
}

/// With a small first letter.
fn lower(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_lowercase().chain(letters).collect())
}

/// What is being read.
struct Reader<'a> {
    json: &'a str,
    start: usize,
    id: &'a str,
    registry: &'a Registry,
    mistakes: Vec<Mistake>,
}

/// The known fields of an object.
struct Fields<'b, 'a> {
    path: String,
    start: usize,
    fields: Vec<(&'static str, &'b ObjectProp<'a>)>,
}

impl<'b, 'a> Fields<'b, 'a> {
    fn get(&self, key: &str) -> Option<&'b Ast<'a>> {
        self.fields.iter().find(|(k, _)| *k == key).map(|(_, p)| &p.value)
    }

    fn path(&self, key: &str) -> String {
        if self.path.is_empty() { key.to_owned() } else { format!("{}.{key}", self.path) }
    }
}

impl Reader<'_> {
    fn mistake(&mut self, at: usize, what: impl Into<String>) {
        self.mistakes.push((self.start + at, what.into()));
    }

    /// A value that breaks a rule.
    fn wrong(&mut self, value: &Ast, path: &str, rule: &str) {
        let found = describe(value, self.json);
        self.mistake(value.start(), format!("{path} is {found}, but {rule}"));
    }

    fn model(&mut self, root: &Ast, end: usize) -> Option<Said> {
        let fields = self.fields(root, String::new(), MODEL_KEYS, "a model")?;
        let id = self.id;
        let file = super::source_path(id);
        let name = self.text(&fields, "name", LONGEST_NAME).unwrap_or_else(|| intern::text(&humanised(id)));
        let author = self.text(&fields, "author", LONGEST_TEXT).unwrap_or("unknown author");
        let source = self.text(&fields, "source", LONGEST_TEXT).unwrap_or_else(|| intern::text(&file));
        let summary = self
            .text(&fields, "summary", LONGEST_TEXT)
            .unwrap_or_else(|| intern::text(&format!("A model of its own, in {file}.")));
        Some(Said {
            name,
            author,
            source,
            summary,
            equation: self.equation(&fields),
            laws: self.laws(&fields),
            anisotropic: self.truth(&fields, "anisotropic"),
            parameters: self.parameters(&fields),
            lobe: self.lobe(&fields),
            end,
        })
    }

    /// The fields of an object by key.
    fn fields<'b, 'a>(
        &mut self,
        value: &'b Ast<'a>,
        path: String,
        known: &[&'static str],
        what: &str,
    ) -> Option<Fields<'b, 'a>> {
        let Ast::Object(object) = value else {
            let rule = format!("{what} must be an object, with the keys {}", listed(known, "and"));
            let place = if path.is_empty() { "the declaration" } else { &path };
            self.wrong(value, place, &rule);
            return None;
        };
        let mut fields: Vec<(&'static str, &'b ObjectProp<'a>)> = Vec::new();
        for property in &object.properties {
            let written = property.name.as_str();
            let at = if path.is_empty() { String::new() } else { format!("{path}.") };
            match known.iter().find(|k| **k == written) {
                Some(key) if fields.iter().any(|(k, _)| k == key) => {
                    self.mistake(property.start(), format!("{at}{written} is given twice"));
                }
                Some(key) => fields.push((key, property)),
                None => {
                    let spelling = written.replace("color", "colour");
                    let words = [
                        ("title", "name"),
                        ("description", "summary"),
                        ("options", "choices"),
                        ("params", "parameters"),
                    ];
                    let candidates =
                        known.iter().map(|k| (*k, *k)).chain(words).filter(|(_, k)| known.contains(k));
                    let hint = nearest(&spelling, candidates).map_or_else(
                        || format!("; {what} has the keys {}", listed(known, "and")),
                        |n| format!("; did you mean {}?", quoted(n)),
                    );
                    self.mistake(
                        property.start(),
                        format!("{at}{} is not a key of {what}{hint}", shortened(written)),
                    );
                }
            }
        }
        Some(Fields { path, start: object.start(), fields })
    }

    /// A text of limited length, if it is given.
    fn text(&mut self, fields: &Fields, key: &str, longest: usize) -> Option<&'static str> {
        let value = fields.get(key)?;
        match value {
            Ast::StringLit(text)
                if text.value.chars().count() <= longest && !text.value.contains(char::is_control) =>
            {
                if key == "name" && text.value.trim().is_empty() {
                    self.wrong(value, &fields.path(key), "a name must have letters");
                    return None;
                }
                Some(intern::text(&text.value))
            }
            _ => {
                let rule = format!("it must be text on one line, of at most {longest} characters");
                self.wrong(value, &fields.path(key), &rule);
                None
            }
        }
    }

    fn truth(&mut self, fields: &Fields, key: &str) -> bool {
        match fields.get(key) {
            None => false,
            Some(Ast::BooleanLit(truth)) => truth.value,
            Some(value) => {
                self.wrong(value, &fields.path(key), "it must be true or false");
                false
            }
        }
    }

    /// One of some words, each of which stands for something.
    fn word<T: Copy>(
        &mut self,
        value: &Ast,
        path: &str,
        what: &str,
        known: &[(&'static str, T)],
    ) -> Option<T> {
        let words: Vec<_> = known.iter().map(|(word, _)| quoted(word)).collect();
        let rule = format!("{what} must be {}", listed(&words, "or"));
        let Ast::StringLit(text) = value else {
            self.wrong(value, path, &rule);
            return None;
        };
        if let Some((_, meaning)) = known.iter().find(|(word, _)| *word == text.value) {
            return Some(*meaning);
        }
        let spelling = text.value.replace("color", "colour");
        let hint = nearest(&spelling, known.iter().map(|(word, _)| (*word, *word)))
            .map_or_else(String::new, |n| format!("; did you mean {}?", quoted(n)));
        self.wrong(value, path, &format!("{rule}{hint}"));
        None
    }

    fn equation(&mut self, fields: &Fields) -> &'static [EquationPart] {
        const TERMS: &[(&str, Term)] = &[
            ("total", Term::Total),
            ("ambient", Term::Ambient),
            ("diffuse", Term::Diffuse),
            ("specular", Term::Specular),
        ];
        let mut parts = Vec::new();
        match fields.get("equation") {
            None => {}
            Some(Ast::StringLit(_)) => {
                if let Some(text) = self.text(fields, "equation", LONGEST_TEXT) {
                    parts.push(EquationPart { term: Term::Total, text });
                }
            }
            Some(Ast::Array(list)) => {
                for (i, element) in list.elements.iter().enumerate() {
                    let path = format!("equation[{i}]");
                    let Some(part) = self.fields(element, path, PART_KEYS, "a part of an equation") else {
                        continue;
                    };
                    let term = match part.get("term") {
                        None => Some(Term::Total),
                        Some(term) => self.word(term, &part.path("term"), "a term", TERMS),
                    };
                    let text = self.text(&part, "text", LONGEST_TEXT);
                    if part.get("text").is_none() {
                        self.lacking(&part, "text", "a part of an equation has one");
                    }
                    if let (Some(term), Some(text)) = (term, text) {
                        parts.push(EquationPart { term, text });
                    }
                }
            }
            Some(value) => {
                let rule =
                    "it must be text, or a list of parts: [{ \"term\": \"diffuse\", \"text\": \"I_d = …\" }]";
                self.wrong(value, "equation", rule);
            }
        }
        intern::equation(parts)
    }

    fn lacking(&mut self, fields: &Fields, key: &str, why: &str) {
        self.mistake(fields.start, format!("{} is missing; {why}", fields.path(key)));
    }

    fn laws(&mut self, fields: &Fields) -> Laws {
        let mut laws = Laws { reciprocal: false, energy_conserving: false, non_negative: false };
        let Some(value) = fields.get("laws") else { return laws };
        let Ast::Array(list) = value else {
            let names = laws.list().map(|(name, _)| quoted(name));
            let rule =
                format!("it must be a list of the laws that the model keeps, of {}", listed(&names, "and"));
            self.wrong(value, "laws", &rule);
            return laws;
        };
        let names = laws.list().map(|(name, _)| (name, name));
        for (i, element) in list.elements.iter().enumerate() {
            match self.word(element, &format!("laws[{i}]"), "a law", &names) {
                Some("reciprocal") => laws.reciprocal = true,
                Some("energy conserving") => laws.energy_conserving = true,
                Some("non-negative") => laws.non_negative = true,
                _ => {}
            }
        }
        laws
    }

    fn lobe(&mut self, fields: &Fields) -> Option<&'static str> {
        let value = fields.get("lobe")?;
        let known: Vec<_> = self
            .registry
            .models()
            .iter()
            .filter(|m| m.has_lobe() && self.registry.own_file(m.declaration.id).is_none())
            .map(|m| (m.declaration.id, m.declaration.id))
            .collect();
        self.word(value, "lobe", "the model whose lobe is compensated", &known)
    }

    fn parameters(&mut self, fields: &Fields) -> &'static [Parameter] {
        let mut parameters: Vec<Parameter> = Vec::new();
        let list = match fields.get("parameters") {
            None => return intern::parameters(parameters),
            Some(Ast::Array(list)) => list,
            Some(value) => {
                let rule = "it must be a list: names of shared parameters, such as \"base_colour\", and objects that declare new ones";
                self.wrong(value, "parameters", rule);
                return intern::parameters(parameters);
            }
        };
        for (i, element) in list.elements.iter().enumerate() {
            let path = format!("parameters[{i}]");
            let parameter = match element {
                Ast::StringLit(name) => self.shared(element, &path, &name.value),
                _ => self.parameter(element, path.clone()),
            };
            let Some(parameter) = parameter else { continue };
            if parameters.iter().any(|p| p.name == parameter.name) {
                self.mistake(element.start(), format!("{path}: there are two parameters {}", parameter.name));
                continue;
            }
            parameters.push(parameter);
            let bytes = layout(&parameters).last().map_or(0, |f| f.2 + 12);
            if bytes > BLOCK_BYTES {
                let what = format!(
                    "{path}: the parameters up to here take {bytes} bytes, but at most {BLOCK_BYTES} fit; a number takes 4, a colour or triple 16"
                );
                self.mistake(element.start(), what);
                break;
            }
        }
        intern::parameters(parameters)
    }

    /// The parameter of that name of some built-in model.
    fn built_in(&self, name: &str) -> Option<&'static Parameter> {
        let built_in =
            |m: &&crate::reflection::ModelEntry| self.registry.own_file(m.declaration.id).is_none();
        self.registry.models().iter().filter(built_in).find_map(|m| m.parameter(name))
    }

    fn shared(&mut self, value: &Ast, path: &str, name: &str) -> Option<Parameter> {
        if let Some(parameter) = self.built_in(name) {
            return Some(parameter.clone());
        }
        let known: Vec<_> = self
            .registry
            .models()
            .iter()
            .filter(|m| self.registry.own_file(m.declaration.id).is_none())
            .flat_map(|m| m.parameters)
            .map(|p| (p.name, p.name))
            .collect();
        let hint = nearest(&name.replace("color", "colour"), known.into_iter()).map_or_else(
            || {
                "; to declare a new one write { \"name\": …, \"min\": …, \"max\": …, \"default\": … }"
                    .to_owned()
            },
            |n| format!("; did you mean {}?", quoted(n)),
        );
        self.wrong(value, path, &format!("no built-in model has a parameter of that name{hint}"));
        None
    }

    fn parameter(&mut self, value: &Ast, path: String) -> Option<Parameter> {
        let fields = self.fields(value, path, PARAMETER_KEYS, "a parameter")?;
        let Some(named) = fields.get("name") else {
            self.lacking(
                &fields,
                "name",
                "it is what scene files call the parameter, and the shader: m.NAME",
            );
            return None;
        };
        let Ast::StringLit(name) = named else {
            self.wrong(named, &fields.path("name"), "it must be text");
            return None;
        };
        let name = intern::text(&name.value);
        let rule = match identifier(name) {
            Err(rule) => Some(format!("it {rule}")),
            Ok(()) if name.contains("color") => {
                Some(format!("scene files spell {}", name.replace("color", "colour")))
            }
            Ok(()) if !allowed_in_wgsl(name) => {
                Some("that is a reserved word in WGSL; choose another".to_owned())
            }
            Ok(()) => None,
        };
        if let Some(rule) = rule {
            self.wrong(named, &fields.path("name"), &rule);
            return None;
        }
        let before = self.mistakes.len();
        let shared = self.built_in(name);
        let kind = self.kind(&fields, shared.map(|s| &s.kind));
        self.same_type_elsewhere(named, &fields, kind.as_ref());
        let given = |reader: &mut Self, key, longest| reader.text(&fields, key, longest);
        let label = given(self, "label", LONGEST_NAME)
            .or(shared.map(|s| s.label))
            .unwrap_or_else(|| intern::text(&name.replace('_', " ")));
        let parameter = Parameter {
            name,
            symbol: given(self, "symbol", LONGEST_NAME)
                .or(shared.map(|s| s.symbol))
                .unwrap_or_else(|| intern::text(&symbol_of(name))),
            label,
            unit: given(self, "unit", LONGEST_NAME).or(shared.map(|s| s.unit)).unwrap_or_else(|| {
                if matches!(kind, Some(ParameterKind::Colour { .. })) { "sRGB" } else { "" }
            }),
            help: given(self, "help", LONGEST_TEXT)
                .or(shared.map(|s| s.help))
                .unwrap_or_else(|| intern::text(&format!("The {label}."))),
            kind: kind?,
        };
        (self.mistakes.len() == before).then_some(parameter)
    }

    /// Parameters are shared by name, so the same name is the same type everywhere.
    fn same_type_elsewhere(&mut self, named: &Ast, fields: &Fields, kind: Option<&ParameterKind>) {
        let Some(kind) = kind else { return };
        let Ast::StringLit(name) = named else { return };
        let other = self.registry.models().iter().filter(|m| m.declaration.id != self.id).find_map(|m| {
            let p = m.parameter(&name.value)?;
            (std::mem::discriminant(&p.kind) != std::mem::discriminant(kind)).then_some((m, p))
        });
        if let Some((model, parameter)) = other {
            let rule = format!(
                "{} has a parameter of that name whose type is {}, and parameters are shared by name; give it that type or another name",
                model.declaration.id,
                type_name(&parameter.kind),
            );
            self.wrong(named, &fields.path("name"), &rule);
        }
    }

    fn kind(&mut self, fields: &Fields, shared: Option<&ParameterKind>) -> Option<ParameterKind> {
        let types: Vec<_> = TYPES.iter().map(|t| (*t, *t)).collect();
        let kind = match fields.get("type") {
            Some(value) => self.word(value, &fields.path("type"), "a type", &types)?,
            None => match (shared, fields.get("choices"), fields.get("default")) {
                (Some(shared), ..) => type_name(shared),
                (None, Some(_), _) => "choice",
                (None, None, Some(Ast::Array(_))) => {
                    self.lacking(fields, "type", "a list may be a \"colour\" or a \"triple\"");
                    return None;
                }
                _ => "number",
            },
        };
        let usable: &[&str] = match kind {
            "number" | "triple" => &["range", "min", "max", "above"],
            "integer" => &["range", "min", "max", "slider_max"],
            "choice" => &["choices"],
            _ => &[],
        };
        for key in ["range", "min", "max", "above", "slider_max", "choices"] {
            if let Some(value) = fields.get(key).filter(|_| !usable.contains(&key)) {
                self.mistake(value.start(), format!("{} is given, but a {kind} has none", fields.path(key)));
                return None;
            }
        }
        match kind {
            "number" => self.number_kind(fields, shared),
            "integer" => self.integer_kind(fields, shared),
            "colour" => self.colour_kind(fields, shared),
            "triple" => self.triple_kind(fields, shared),
            _ => self.choice_kind(fields, shared),
        }
    }

    /// A finite number in 32 bits.
    fn number(&mut self, value: &Ast, path: &str) -> Option<f32> {
        let number = match value {
            Ast::NumberLit(number) => number.value.parse::<f32>().ok().filter(|n| n.is_finite()),
            _ => None,
        };
        if number.is_none() {
            self.wrong(value, path, "it must be a number");
        }
        number
    }

    /// A whole number that 32-bit floats hold exactly, as the shader gets it.
    fn whole(&mut self, value: &Ast, path: &str) -> Option<i64> {
        const EXACT: f64 = 16_777_216.0;
        let number = match value {
            Ast::NumberLit(number) => {
                number.value.parse::<f64>().ok().filter(|n| n.fract() == 0.0 && n.abs() <= EXACT)
            }
            _ => None,
        };
        if number.is_none() {
            self.wrong(value, path, &format!("it must be a whole number between -{EXACT} and {EXACT}"));
        }
        number.map(|n| n as i64)
    }

    /// Smallest and largest value, from `range`, or from `min` or `above`, and `max`.
    fn limits<T: Copy + PartialOrd>(
        &mut self,
        fields: &Fields,
        (min, max): (T, Option<T>),
        read: fn(&mut Self, &Ast, &str) -> Option<T>,
        above_zero: Option<T>,
    ) -> Option<(T, Option<T>)> {
        let given = |key| fields.get(key).map(|value| (value, fields.path(key)));
        let (mut low, mut high, mut good) = (min, max, true);
        if let Some((value, path)) = given("range") {
            if let Some(other) = ["min", "max", "above"].into_iter().find(|key| fields.get(key).is_some()) {
                self.mistake(
                    value.start(),
                    format!("{path} is given, but so is {other}; a range is [min, max]"),
                );
                return None;
            }
            let Ast::Array(list) = value else {
                self.wrong(value, &path, "a range must be two numbers: [min, max]");
                return None;
            };
            let [a, b] = list.elements.as_slice() else {
                self.wrong(value, &path, "a range must be two numbers: [min, max]");
                return None;
            };
            let (a, b) = (read(self, a, &format!("{path}[0]")), read(self, b, &format!("{path}[1]")));
            (low, high) = (a?, Some(b?));
        }
        if let Some((value, path)) = given("min") {
            match read(self, value, &path) {
                Some(v) => low = v,
                None => good = false,
            }
        }
        if let Some((value, path)) = given("above") {
            let zero = matches!(value, Ast::NumberLit(n) if n.value.parse::<f64>() == Ok(0.0));
            match above_zero.filter(|_| zero && fields.get("min").is_none()) {
                Some(v) => low = v,
                None => {
                    self.wrong(value, &path, "it must be 0, and stands in place of min: greater than 0");
                    good = false;
                }
            }
        }
        if let Some((value, path)) = given("max") {
            match read(self, value, &path) {
                Some(v) => high = Some(v),
                None => good = false,
            }
        }
        if !good {
            return None;
        }
        if high.is_some_and(|h| h <= low) {
            let (value, path) = given("max").or(given("range")).or(given("min")).or(given("above"))?;
            self.wrong(value, &path, "the largest value must be greater than the smallest");
            return None;
        }
        Some((low, high))
    }

    /// A default that lies in the range.
    fn within(&mut self, fields: &Fields, parameter: ParameterKind) -> Option<ParameterKind> {
        let probe = Parameter { name: "", symbol: "", label: "", unit: "", help: "", kind: parameter };
        if !probe.allows(&probe.default_value()) {
            match fields.get("default") {
                Some(value) => {
                    self.wrong(value, &fields.path("default"), &format!("it must be {}", probe.rule()))
                }
                None => self.lacking(fields, "default", &format!("it must be {}", probe.rule())),
            }
            return None;
        }
        Some(probe.kind)
    }

    fn number_kind(&mut self, fields: &Fields, shared: Option<&ParameterKind>) -> Option<ParameterKind> {
        let (min, max, usual) = match shared {
            Some(ParameterKind::Number { min, max, default }) => (*min, *max, Some(*default)),
            _ => (0.0, 1.0, None),
        };
        let limits = self.limits(fields, (min, Some(max)), Self::number, Some(ABOVE_ZERO));
        let given = match fields.get("default") {
            Some(value) => Some(self.number(value, &fields.path("default"))?),
            None => None,
        };
        let (min, max) = limits?;
        let max = max.unwrap_or(1.0);
        let middle = || usual.filter(|u| (min..=max).contains(u)).unwrap_or(0.5 * min + 0.5 * max);
        let default = given.unwrap_or_else(middle);
        self.within(fields, ParameterKind::Number { min, max, default })
    }

    fn integer_kind(&mut self, fields: &Fields, shared: Option<&ParameterKind>) -> Option<ParameterKind> {
        let (min, max, slider, usual) = match shared {
            Some(ParameterKind::Integer { min, max, slider_max, default }) => {
                (*min, *max, Some(*slider_max), Some(*default))
            }
            _ => (0, None, None, None),
        };
        let limits = self.limits(fields, (min, max), Self::whole, None);
        let mut read = |key: &str| match fields.get(key) {
            Some(value) => self.whole(value, &fields.path(key)).map(Some),
            None => Some(None),
        };
        let (given, slider_given) = (read("default")?, read("slider_max")?);
        let (min, max) = limits?;
        let inside = |v: i64| v >= min && max.is_none_or(|m| v <= m);
        let default = given.or(usual.filter(|u| inside(*u))).unwrap_or(min);
        let slider = slider_given.or(slider.filter(|s| *s > min));
        let slider_max =
            max.map_or_else(|| slider.unwrap_or(default.max(min) + 16), |m| slider.unwrap_or(m).min(m));
        if slider_max <= min {
            if let Some(value) = fields.get("slider_max") {
                self.wrong(
                    value,
                    &fields.path("slider_max"),
                    &format!("it must be greater than {min}, where the slider begins"),
                );
            }
            return None;
        }
        self.within(fields, ParameterKind::Integer { min, max, slider_max, default })
    }

    fn colour_kind(&mut self, fields: &Fields, shared: Option<&ParameterKind>) -> Option<ParameterKind> {
        let usual = match shared {
            Some(ParameterKind::Colour { default }) => *default,
            _ => [255; 3],
        };
        let Some(value) = fields.get("default") else {
            return Some(ParameterKind::Colour { default: usual });
        };
        let channel = |e: &Ast| match e {
            Ast::NumberLit(n) => n.value.parse::<u8>().ok(),
            _ => None,
        };
        let channels: Option<Vec<u8>> = match value {
            Ast::Array(list) => list.elements.iter().map(channel).collect(),
            _ => None,
        };
        match channels.and_then(|c| c.try_into().ok()) {
            Some(default) => Some(ParameterKind::Colour { default }),
            None => {
                let rule = "a colour must be three whole numbers from 0 to 255: [red, green, blue]";
                self.wrong(value, &fields.path("default"), rule);
                None
            }
        }
    }

    fn triple_kind(&mut self, fields: &Fields, shared: Option<&ParameterKind>) -> Option<ParameterKind> {
        let (min, max, usual) = match shared {
            Some(ParameterKind::Triple { min, max, default }) => (*min, *max, Some(*default)),
            _ => (0.0, 1.0, None),
        };
        let limits = self.limits(fields, (min, Some(max)), Self::number, Some(ABOVE_ZERO));
        let path = fields.path("default");
        let given = match fields.get("default") {
            None => None,
            Some(value @ Ast::NumberLit(_)) => Some([self.number(value, &path)?; 3]),
            Some(Ast::Array(list)) if list.elements.len() == 3 => {
                let mut triple = [0.0; 3];
                for (to, element) in triple.iter_mut().zip(&list.elements) {
                    *to = self.number(element, &path)?;
                }
                Some(triple)
            }
            Some(value) => {
                self.wrong(value, &path, "it must be three numbers, [red, green, blue], or one for all");
                return None;
            }
        };
        let (min, max) = limits?;
        let max = max.unwrap_or(1.0);
        let fits = |t: &[f32; 3]| t.iter().all(|c| (min..=max).contains(c));
        let default = given.or(usual.filter(fits)).unwrap_or([0.5 * min + 0.5 * max; 3]);
        self.within(fields, ParameterKind::Triple { min, max, default })
    }

    fn choice_kind(&mut self, fields: &Fields, shared: Option<&ParameterKind>) -> Option<ParameterKind> {
        let (mut options, usual) = match shared {
            Some(ParameterKind::Choice { options, default }) => (options.to_vec(), options[*default].0),
            _ => (Vec::new(), ""),
        };
        if let Some(value) = fields.get("choices") {
            options = self.choices(value, &fields.path("choices"))?;
        }
        if options.is_empty() {
            self.lacking(
                fields,
                "choices",
                "a choice has some: [\"one\", \"other\"], or { \"one\": \"its name\" }",
            );
            return None;
        }
        let known: Vec<_> = options.iter().enumerate().map(|(i, (id, _))| (*id, i)).collect();
        let default = match fields.get("default") {
            Some(value) => self.word(value, &fields.path("default"), "the default", &known)?,
            None => options.iter().position(|(id, _)| *id == usual).unwrap_or(0),
        };
        Some(ParameterKind::Choice { options: intern::options(options), default })
    }

    /// Choices as a list of ids, or as an object from id to name.
    fn choices(&mut self, value: &Ast, path: &str) -> Option<Vec<(&'static str, &'static str)>> {
        let mut options: Vec<(&'static str, &'static str)> = Vec::new();
        let before = self.mistakes.len();
        let mut add = |reader: &mut Self, at: usize, id: &str, name: &str| {
            if let Err(rule) = identifier(id) {
                reader.mistake(at, format!("{path} has {}, but a choice {rule}", quoted(id)));
            } else if options.iter().any(|(known, _)| *known == id) {
                reader.mistake(at, format!("{path} has {} twice", quoted(id)));
            } else {
                options.push((intern::text(id), intern::text(name)));
            }
        };
        match value {
            Ast::Array(list) => {
                for element in &list.elements {
                    match element {
                        Ast::StringLit(id) => add(self, element.start(), &id.value, &humanised(&id.value)),
                        _ => self.wrong(element, path, "a choice must be text"),
                    }
                }
            }
            Ast::Object(object) => {
                for property in &object.properties {
                    match &property.value {
                        Ast::StringLit(name)
                            if !name.value.trim().is_empty()
                                && name.value.chars().count() <= LONGEST_NAME =>
                        {
                            add(self, property.start(), property.name.as_str(), &name.value);
                        }
                        other => self.wrong(other, path, "the name of a choice must be a short text"),
                    }
                }
            }
            _ => self.wrong(
                value,
                path,
                "it must be a list: [\"one\", \"other\"], or an object: { \"one\": \"its name\" }",
            ),
        }
        (self.mistakes.len() == before).then_some(options)
    }
}

/// The word for the type of a parameter.
pub(super) fn type_name(kind: &ParameterKind) -> &'static str {
    match kind {
        ParameterKind::Number { .. } => "number",
        ParameterKind::Integer { .. } => "integer",
        ParameterKind::Colour { .. } => "colour",
        ParameterKind::Triple { .. } => "triple",
        ParameterKind::Choice { .. } => "choice",
    }
}

/// A value as it is written, if it is short, and what it is otherwise.
fn describe(value: &Ast, json: &str) -> String {
    match value {
        Ast::Object(AstObject { properties, .. }) if properties.is_empty() => "{}".to_owned(),
        Ast::Object(_) => "an object".to_owned(),
        Ast::Array(list) if list.elements.len() > 4 => format!("a list of {}", list.elements.len()),
        _ => shortened(value.text(json)),
    }
}
