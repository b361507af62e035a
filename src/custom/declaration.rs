//! The declaration at the top of a custom model: a comment `/* lcm { … } */` containing JSON with comments and trailing
//! commas. Every error is reported with its place, the value and the rule.

use jsonc_parser::{ParseOptions, common::Ranged as _};

use super::{
    curves::Curve,
    intern,
    lobes::SaidLobes,
    reader::{LONGEST_NAME, LONGEST_TEXT, MOST_MISTAKES, Reader},
    text::{Mistake, comment, humanised},
};
use crate::{
    parameter::{BLOCK_BYTES, Parameter, layout},
    reflection::{EquationPart, Group, Laws, ModelEntry, Term},
    registry::Registry,
    text::{
        did_you_mean,
        json::{self, Cursor, Fields, Reader as _, STRICT},
        listed, mathematics, quoted,
    },
};

/// JSON with comments and trailing commas.
const OPTIONS: ParseOptions = ParseOptions { allow_comments: true, allow_trailing_commas: true, ..STRICT };
/// The keys of a declaration.
const MODEL_KEYS: &str = "name author source summary equation laws anisotropic transmits lit_from_below boundary lobe \
                          lobes curves parameters groups";
/// The keys of a part of the equation.
const PART_KEYS: &[&str] = &["term", "text"];
/// The most brackets of a declaration, and so its deepest nesting.
const MOST_BRACKETS: usize = 600;
/// Maximum size of a declaration, in bytes.
const MOST_BYTES: usize = 64 << 10;

/// The contents of a declaration.
pub(super) struct Said {
    pub name: &'static str,
    pub author: &'static str,
    pub source: &'static str,
    pub summary: &'static str,
    pub equation: &'static [EquationPart],
    pub laws: Laws,
    pub anisotropic: bool,
    /// True if light passes through.
    pub transmits: bool,
    pub lit_from_below: bool,
    /// True for the boundary of a body with another refractive index.
    pub boundary: bool,
    /// The built-in model whose lobe the model uses.
    pub lobe: Option<&'static str>,
    /// The directions in which the model reflects most.
    pub lobes: SaidLobes,
    /// Additional curves, of other built-in models.
    pub curves: Vec<Curve>,
    pub parameters: &'static [Parameter],
    pub groups: &'static [Group],
    /// The byte after the comment.
    pub end: usize,
}

/// Reads the declaration of the model with this id.
///
/// # Errors
/// Returns every error in the declaration.
pub(super) fn read(text: &str, id: &str, registry: &Registry) -> Result<Said, Vec<Mistake>> {
    let comment = comment(text).map_err(|mistake| vec![mistake])?;
    // The parser recurses as deep as the brackets.
    if comment.json.matches(['[', '{']).count() > MOST_BRACKETS {
        let what = format!("the declaration has more than {MOST_BRACKETS} brackets, the most allowed");
        return Err(vec![(comment.start, what)]);
    }
    if comment.json.len() > MOST_BYTES {
        let what = format!("the declaration is longer than {} KiB, the most allowed", MOST_BYTES >> 10);
        return Err(vec![(comment.start, what)]);
    }
    let parsed = json::parse(comment.json, &OPTIONS)
        .map_err(|(at, what)| vec![(comment.start + at, format!("the declaration is not JSON: {what}"))])?;
    let Some(root) = parsed else {
        let what = "the declaration is empty; it must be an object: { \"name\": …, \"parameters\": […] }";
        return Err(vec![(comment.start, what.to_owned())]);
    };
    let mut reader = Reader { json: comment.json, start: comment.start, id, registry, mistakes: Vec::new() };
    let said = reader.model(Cursor::root(&root), comment.end);
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

/// The text of the value under a key of a declaration.
pub(super) fn written<'a>(json: &'a str, key: &'static str) -> Option<&'a str> {
    let root = json::parse(json, &OPTIONS).ok()??;
    let range = Cursor::root(&root).get(key)?.value.range();
    json.get(range.start..range.end)
}

impl Reader<'_> {
    fn model(&mut self, root: Cursor, end: usize) -> Option<Said> {
        let fields = self.fields(root, &MODEL_KEYS.split(' ').collect::<Vec<_>>(), "a model")?;
        let id = self.id;
        let file = super::source_path(id);
        let name = self.words(&fields, "name", LONGEST_NAME).unwrap_or_else(|| intern::text(&humanised(id)));
        let author = self.words(&fields, "author", LONGEST_TEXT).unwrap_or("unknown author");
        let source = self.words(&fields, "source", LONGEST_TEXT).unwrap_or_else(|| intern::text(&file));
        let summary = self
            .words(&fields, "summary", LONGEST_TEXT)
            .unwrap_or_else(|| intern::text(&format!("A custom model, in {file}.")));
        let parameters = self.parameters(&fields);
        let lobe = self.lobe(&fields);
        let taken = lobe.and_then(|id| self.registry.model(id)).map_or(&[][..], ModelEntry::curves);
        let transmits = self.flag(&fields, "transmits", false, "it must be true or false");
        let lit_from_below = self.flag(&fields, "lit_from_below", false, "it must be true or false");
        let boundary = self.flag(&fields, "boundary", false, "it must be true or false");
        if let Some(value) = fields.get("boundary").filter(|_| boundary && !transmits) {
            self.wrong(value, "light passes through a boundary: it needs \"transmits\": true");
        }
        Some(Said {
            name,
            author,
            source,
            summary,
            equation: self.equation(&fields),
            laws: self.laws(&fields),
            anisotropic: self.flag(&fields, "anisotropic", false, "it must be true or false"),
            transmits,
            lit_from_below,
            boundary,
            parameters,
            groups: self.groups(&fields, parameters),
            lobe,
            lobes: self.lobes(&fields, parameters),
            curves: self.curves(&fields, parameters, taken),
            end,
        })
    }

    fn equation(&mut self, fields: &Fields) -> &'static [EquationPart] {
        const TERMS: &[(&str, Term)] = &[
            ("total", Term::Total),
            ("ambient", Term::Ambient),
            ("diffuse", Term::Diffuse),
            ("specular", Term::Specular),
            ("transmitted", Term::Transmitted),
        ];
        let Some(value) = fields.get("equation") else { return intern::equation(Vec::new()) };
        let mut parts = Vec::new();
        if value.text().is_some() {
            let text = self.mathematics(fields, "equation");
            parts.extend(text.map(|text| EquationPart::new(Term::Total, text)));
        } else if let Some(list) = value.list() {
            for element in list {
                let Some(part) = self.fields(element, PART_KEYS, "a part of an equation") else { continue };
                let term = match part.get("term") {
                    None => Some(Term::Total),
                    Some(term) => self.word(term, "a term", TERMS),
                };
                let text = self.mathematics(&part, "text");
                if part.get("text").is_none() {
                    self.lacking(&part, "text", "a part of an equation needs one");
                }
                parts.extend(term.zip(text).map(|(term, text)| EquationPart::new(term, text)));
            }
        } else {
            let rule =
                "it must be text, or a list of parts: [{ \"term\": \"diffuse\", \"text\": \"I_d = …\" }]";
            self.wrong(value, rule);
        }
        intern::equation(parts)
    }

    /// An equation line.
    fn mathematics(&mut self, fields: &Fields, key: &str) -> Option<&'static str> {
        let text = self.words(fields, key, mathematics::LONGEST_LINE)?;
        let Some((_, what)) = mathematics::beyond_limits(text) else { return Some(text) };
        self.wrong(fields.get(key)?, &what);
        None
    }

    fn laws(&mut self, fields: &Fields) -> Laws {
        let mut laws = Laws { reciprocal: false, energy_conserving: false, non_negative: false };
        let Some(value) = fields.get("laws") else { return laws };
        let Some(list) = value.list() else {
            let names = listed(&laws.list().map(|(name, _)| quoted(name)), "and");
            let rule = format!("it must be a list of the laws that the model keeps, any of {names}");
            self.wrong(value, &rule);
            return laws;
        };
        let names = laws.list().map(|(name, _)| (name, name));
        for element in list.take(MOST_MISTAKES) {
            match self.word(element, "a law", &names) {
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
        let known = self.built_in_models().filter(|m| m.has_lobe()).map(|m| m.declaration.id);
        let known: Vec<_> = known.map(|id| (id, id)).collect();
        self.word(value, "the model whose lobe is compensated", &known)
    }

    fn parameters(&mut self, fields: &Fields) -> &'static [Parameter] {
        let mut parameters: Vec<Parameter> = Vec::new();
        let Some(value) = fields.get("parameters") else { return intern::parameters(parameters) };
        let Some(list) = value.list() else {
            let rule = "it must be a list: names of shared parameters, such as \"base_colour\", and objects that declare new ones";
            self.wrong(value, rule);
            return intern::parameters(parameters);
        };
        for element in list {
            if self.has_enough() {
                break;
            }
            let parameter = match element.text() {
                Some(name) => self.shared(element, name),
                None => self.parameter(element),
            };
            let Some(parameter) = parameter else { continue };
            let what = |what: String| format!("{}: {what}", element.path());
            if parameters.iter().any(|p| p.name == parameter.name) {
                let twice = format!("{} is declared twice", parameter.name);
                self.mistake(element.start(), what(twice));
                continue;
            }
            parameters.push(parameter);
            let bytes = layout(&parameters).last().map_or(0, |f| f.2 + 12);
            if bytes > BLOCK_BYTES {
                let full = format!(
                    "the parameters up to here take {bytes} bytes, but at most {BLOCK_BYTES} fit; a number takes 4, a colour or triple 16"
                );
                self.mistake(element.start(), what(full));
                break;
            }
        }
        if self.mistakes.is_empty() {
            self.check_conditions(value, &parameters);
        }
        intern::parameters(parameters)
    }

    /// The groups by name, each with the names of its parameters.
    fn groups(&mut self, fields: &Fields, parameters: &[Parameter]) -> &'static [Group] {
        const RULE: &str = "it must be an object of lists: { \"Coat\": [\"coat_weight\", \"coat_colour\"] }";
        let Some(value) = fields.get("groups") else { return intern::groups(Vec::new()) };
        let Some(properties) = value.properties() else {
            self.wrong(value, RULE);
            return intern::groups(Vec::new());
        };
        let mut groups = Vec::new();
        let mut starts = Vec::new();
        for property in properties {
            let list = value.holding(&property.value);
            let Some(elements) = list.list() else {
                self.wrong(list, RULE);
                continue;
            };
            let name = property.name.as_str();
            if name.chars().count() > LONGEST_NAME || name.contains(char::is_control) {
                let rule = format!("the name of a group must have at most {LONGEST_NAME} characters");
                self.mistake(property.start(), format!("groups: {rule}"));
            }
            let names: Vec<_> = elements.filter_map(|e| e.text().map(intern::text)).collect();
            if list.list().is_none_or(|all| all.len() != names.len()) {
                self.wrong(list, RULE);
                continue;
            }
            starts.push(property.start());
            groups.push(Group { name: intern::text(name), parameters: intern::names(names) });
        }
        // Rejected parameters have been reported already.
        if self.mistakes.is_empty()
            && let Some((i, problem)) = Group::problem(&groups, parameters)
        {
            self.mistake(starts[i], problem);
        }
        intern::groups(groups)
    }

    fn shared(&mut self, value: Cursor, name: &str) -> Option<Parameter> {
        if let Some(parameter) = self.built_in(name) {
            // Its condition refers to parameters of that model.
            return Some(Parameter { used_when: None, ..parameter.clone() });
        }
        let known = self.built_in_models().flat_map(|m| m.parameters).map(|p| (p.name, p.name));
        let hint = match did_you_mean(&name.replace("color", "colour"), known) {
            none if none.is_empty() => {
                "; to declare a new one, write { \"name\": …, \"min\": …, \"max\": …, \"default\": … }"
            }
            hint => &hint.clone(),
        };
        self.wrong(value, &format!("no built-in model has a parameter of that name{hint}"));
        None
    }
}
