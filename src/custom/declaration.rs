//! The declaration at the top of an own model: a comment `/* lcm { … } */` whose inside is JSON with
//! comments and trailing commas. Every mistake is told with its place, the value and the rule.

use jsonc_parser::{
    CollectOptions, ParseOptions,
    ast::{Object as AstObject, ObjectProp, Value as Ast},
    common::Ranged,
    parse_to_ast,
};

use super::{
    intern,
    text::{Mistake, comment, humanised},
};
use crate::{
    parameter::{BLOCK_BYTES, Parameter, layout},
    reflection::{EquationPart, Laws, Term},
    registry::Registry,
    text::{listed, nearest, quoted, shortened},
};

/// What a declaration may say.
const MODEL_KEYS: &[&str] =
    &["name", "author", "source", "summary", "equation", "laws", "anisotropic", "lobe", "parameters"];
/// What a part of the equation says.
const PART_KEYS: &[&str] = &["term", "text"];
/// The longest name of a model, symbol or label, characters.
pub(super) const LONGEST_NAME: usize = 60;
/// The most brackets of a declaration.
const MOST_BRACKETS: usize = 600;
/// The longest declaration, bytes.
const MOST_BYTES: usize = 64 << 10;
/// So many mistakes are told; who makes more made one at the beginning.
const MOST_MISTAKES: usize = 50;
/// The longest text, characters.
pub(super) const LONGEST_TEXT: usize = 2000;

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

/// Reads the declaration of the model of that id.
///
/// # Errors
/// Everything that is wrong with it.
pub(super) fn read(text: &str, id: &str, registry: &Registry) -> Result<Said, Vec<Mistake>> {
    let comment = comment(text).map_err(|mistake| vec![mistake])?;
    // The parser goes as deep as the brackets do.
    if comment.json.matches(['[', '{']).count() > MOST_BRACKETS {
        let what = format!("the declaration has more than {MOST_BRACKETS} brackets, which none needs");
        return Err(vec![(comment.start, what)]);
    }
    if comment.json.len() > MOST_BYTES {
        let what = format!("the declaration is longer than {} KiB, which none needs to be", MOST_BYTES >> 10);
        return Err(vec![(comment.start, what)]);
    }
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
            mistakes.truncate(MOST_MISTAKES);
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
pub(super) struct Reader<'a> {
    json: &'a str,
    start: usize,
    pub(super) id: &'a str,
    pub(super) registry: &'a Registry,
    pub(super) mistakes: Vec<Mistake>,
}

/// The known fields of an object.
pub(super) struct Fields<'b, 'a> {
    path: String,
    start: usize,
    fields: Vec<(&'static str, &'b ObjectProp<'a>)>,
}

impl<'b, 'a> Fields<'b, 'a> {
    pub(super) fn get(&self, key: &str) -> Option<&'b Ast<'a>> {
        self.fields.iter().find(|(k, _)| *k == key).map(|(_, p)| &p.value)
    }

    pub(super) fn path(&self, key: &str) -> String {
        if self.path.is_empty() { key.to_owned() } else { format!("{}.{key}", self.path) }
    }
}

impl Reader<'_> {
    pub(super) fn mistake(&mut self, at: usize, what: impl Into<String>) {
        self.mistakes.push((self.start + at, what.into()));
    }

    /// A value that breaks a rule.
    pub(super) fn wrong(&mut self, value: &Ast, path: &str, rule: &str) {
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
            .unwrap_or_else(|| intern::text(&format!("A custom model, in {file}.")));
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
    pub(super) fn fields<'b, 'a>(
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
            if self.mistakes.len() >= MOST_MISTAKES {
                break;
            }
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
    pub(super) fn text(&mut self, fields: &Fields, key: &str, longest: usize) -> Option<&'static str> {
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
    pub(super) fn word<T: Copy>(
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

    pub(super) fn lacking(&mut self, fields: &Fields, key: &str, why: &str) {
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
        for (i, element) in list.elements.iter().take(MOST_MISTAKES).enumerate() {
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
            .filter(|m| m.has_lobe() && self.registry.custom_file(m.declaration.id).is_none())
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
            if self.mistakes.len() >= MOST_MISTAKES {
                break;
            }
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
        if self.mistakes.is_empty() {
            self.check_conditions(&list.elements, &parameters);
        }
        intern::parameters(parameters)
    }

    /// The parameter of that name of some built-in model.
    pub(super) fn built_in(&self, name: &str) -> Option<&'static Parameter> {
        let built_in =
            |m: &&crate::reflection::ModelEntry| self.registry.custom_file(m.declaration.id).is_none();
        self.registry.models().iter().filter(built_in).find_map(|m| m.parameter(name))
    }

    fn shared(&mut self, value: &Ast, path: &str, name: &str) -> Option<Parameter> {
        if let Some(parameter) = self.built_in(name) {
            // Its condition is about the parameters of that model.
            return Some(Parameter { used_when: None, ..parameter.clone() });
        }
        let known: Vec<_> = self
            .registry
            .models()
            .iter()
            .filter(|m| self.registry.custom_file(m.declaration.id).is_none())
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
