//! The parameters declared by a model's file.

use jsonc_parser::common::Ranged as _;

use super::{
    intern,
    reader::{LONGEST_NAME, LONGEST_TEXT, Reader},
    text::{GREEK, allowed_in_wgsl, humanised, identifier},
};
use crate::{
    parameter::{
        Meaning, Parameter, ParameterKind,
        kind::{Declarations, Header, Type},
    },
    text::{
        json::{Cursor, Fields, Reader as _},
        listed, quoted,
    },
};

/// The keys of an entry of `parameters`, before and after those of its type.
const KEYS: [&[&str]; 2] =
    [&["name", "symbol", "label", "unit", "help", "type"], &["default", "used_when", "stands_for"]];

/// The default symbol of a parameter: a Greek letter if the parameter's name begins with that letter's name.
fn symbol_of(name: &str) -> String {
    let (first, rest) = name.split_once('_').map_or((name, None), |(f, r)| (f, Some(r)));
    let mut letters = GREEK.lines().take_while(|line| !line.is_empty());
    let letter = letters.find_map(|line| line.strip_prefix(first)?.strip_prefix(' '));
    let first = letter.unwrap_or(first);
    match rest {
        Some(rest) => format!("{first}_{{{}}}", rest.replace('_', " ")),
        None => first.to_owned(),
    }
}

impl Reader<'_> {
    pub(super) fn parameter(&mut self, value: Cursor) -> Option<Parameter> {
        let mut keys = KEYS[0].to_vec();
        for key in every_type().flat_map(|known| known.keys).copied() {
            if !keys.contains(&key) {
                keys.push(key);
            }
        }
        keys.extend(KEYS[1]);
        let fields = self.fields(value, &keys, "a parameter")?;
        let Some(named) = fields.get("name") else {
            self.lacking(
                &fields,
                "name",
                "it is the parameter's name in scene files, and in the shader: m.NAME",
            );
            return None;
        };
        let name = intern::text(self.string(named, "it must be text")?);
        let rule = match identifier(name) {
            Err(rule) => Some(format!("it {rule}")),
            Ok(()) if name.contains("color") => {
                Some(format!("in scene files it must be spelt {}", name.replace("color", "colour")))
            }
            Ok(()) if !allowed_in_wgsl(name) => {
                Some("that is a reserved word in WGSL; choose another".to_owned())
            }
            Ok(()) => None,
        };
        if let Some(rule) = rule {
            self.wrong(named, &rule);
            return None;
        }
        let before = self.mistakes.len();
        let shared = self.built_in(name);
        let kind = self.kind(&fields, shared.map(|s| &s.kind));
        self.same_type_elsewhere(named, name, kind.as_ref());
        let given = |reader: &mut Self, key, longest| reader.words(&fields, key, longest);
        let label = given(self, "label", LONGEST_NAME)
            .or(shared.map(|s| s.label))
            .unwrap_or_else(|| intern::text(&name.replace('_', " ")));
        let usual_unit = kind.as_ref().map_or("", |kind| kind.unit());
        let stands_for = self.meaning(&fields, kind.as_ref()).or(shared.and_then(|s| s.stands_for));
        let parameter = Parameter {
            name,
            symbol: given(self, "symbol", LONGEST_NAME)
                .or(shared.map(|s| s.symbol))
                .unwrap_or_else(|| intern::text(&symbol_of(name))),
            label,
            unit: given(self, "unit", LONGEST_NAME).or(shared.map(|s| s.unit)).unwrap_or(usual_unit),
            help: given(self, "help", LONGEST_TEXT)
                .or(shared.map(|s| s.help))
                .unwrap_or_else(|| intern::text(&format!("The {label}."))),
            kind: kind?,
            used_when: self.used_when(&fields),
            stands_for,
            costly: shared.is_some_and(|s| s.costly),
        };
        self.same_unit_elsewhere(named, &parameter);
        (self.mistakes.len() == before).then_some(parameter)
    }

    /// What the parameter stands for: a built-in meaning, or one of a registered model.
    fn meaning(&mut self, fields: &Fields, kind: Option<&ParameterKind>) -> Option<&'static Meaning> {
        let value = fields.get("stands_for")?;
        if kind.is_some_and(|kind| Meaning::ALL[0].value_of([1.0; 3], kind).is_none()) {
            self.wrong(value, "only numbers, triples and colours stand for a quantity");
            return None;
        }
        let mut known: Vec<_> = Meaning::ALL.iter().map(|one| (one.id, *one)).collect();
        for meaning in self.registry.material_users().flat_map(|(_, all)| all).filter_map(|p| p.stands_for) {
            if known.iter().all(|(id, _)| *id != meaning.id) {
                known.push((meaning.id, meaning));
            }
        }
        self.word(value, "a quantity", &known)
    }

    /// Reports a unit that differs from that of the same parameter elsewhere: a material keeps its numbers
    /// when the model changes, so their meaning must not change.
    fn same_unit_elsewhere(&mut self, named: Cursor, parameter: &Parameter) {
        let users = self.registry.material_users().filter(|(id, _)| *id != self.id);
        let other = users.flat_map(|(id, all)| all.iter().map(move |p| (id, p))).find_map(|(id, p)| {
            let same_type = std::mem::discriminant(&p.kind) == std::mem::discriminant(&parameter.kind);
            let (own, theirs) = parameter.clash(p).filter(|_| p.name == parameter.name && same_type)?;
            Some((id, own, theirs))
        });
        if let Some((id, own, theirs)) = other {
            let rule = format!(
                "it is {own} here, but {theirs} in {id}; parameters are shared by name, so use that unit or another name"
            );
            self.wrong(named, &rule);
        }
    }

    /// Reports a type that differs from that of the same parameter elsewhere: parameters are shared by name.
    fn same_type_elsewhere(&mut self, named: Cursor, name: &str, kind: Option<&ParameterKind>) {
        let Some(kind) = kind else { return };
        let other = self.registry.models().iter().filter(|m| m.declaration.id != self.id).find_map(|m| {
            let p = m.parameter(name)?;
            (p.kind.name() != kind.name()).then_some((m, p))
        });
        if let Some((model, parameter)) = other {
            let (id, kind) = (model.declaration.id, parameter.kind.name());
            let has = format!("{id} has a parameter of that name with type {kind}");
            let rule = format!("{has}; parameters are shared by name, so use that type or another name");
            self.wrong(named, &rule);
        }
    }

    fn kind(&mut self, fields: &Fields, shared: Option<&ParameterKind>) -> Option<ParameterKind> {
        let types: Vec<_> = every_type().map(|known| (known.name, known)).collect();
        let known = match (fields.get("type"), shared) {
            (Some(value), _) => self.word(value, "a type", &types)?,
            (None, Some(shared)) => every_type().find(|known| known.name == shared.name())?,
            (None, None) => self.fitting(fields)?,
        };
        let kind = known.name;
        for key in every_type().flat_map(|known| known.keys) {
            if let Some(value) = fields.get(key).filter(|_| !known.keys.contains(key)) {
                self.misplaced(value, &format!("is given, but a {kind} has none"));
                return None;
            }
        }
        (known.read)(&mut Header { reader: self, fields, shared })
    }

    /// The type of a parameter that names none. Reports that it must be named if the rest fits several.
    fn fitting(&mut self, fields: &Fields) -> Option<&'static Type> {
        let fitting: Vec<_> = every_type().filter(|known| (known.fits)(fields)).collect();
        match fitting[..] {
            [] => every_type().next(),
            [one] => Some(one),
            _ => {
                let named: Vec<_> = fitting.iter().map(|known| format!("a {}", quoted(known.name))).collect();
                self.lacking(fields, "type", &format!("a list may be {}", listed(&named, "or")));
                None
            }
        }
    }
}

/// The types of parameters.
fn every_type() -> impl Iterator<Item = &'static Type> {
    ParameterKind::TYPES.iter().copied().flatten()
}

impl Declarations for Reader<'_> {
    /// Choices as a list of ids, or as an object from id to name.
    fn choices(&mut self, value: Cursor) -> Option<&'static [(&'static str, &'static str)]> {
        let mut options: Vec<(&'static str, &'static str)> = Vec::new();
        let before = self.mistakes.len();
        let mut add = |reader: &mut Self, at: usize, id: &str, name: &str| {
            let predicate = if let Err(rule) = identifier(id) {
                format!("has {}, but a choice {rule}", quoted(id))
            } else if id.parse::<bool>().is_ok() {
                format!("has {}, but true and false are only for the type \"flag\"", quoted(id))
            } else if options.iter().any(|(known, _)| *known == id) {
                format!("has {} twice", quoted(id))
            } else {
                options.push((intern::text(id), intern::text(name)));
                return;
            };
            reader.report(at, value.path(), None, &predicate);
        };
        if let Some(list) = value.list() {
            for element in list.map(|element| value.holding(element.value)) {
                if let Some(id) = self.string(element, "a choice must be text") {
                    add(self, element.start(), id, &humanised(id));
                }
            }
        } else if let Some(properties) = value.properties() {
            for property in properties {
                let named = value.holding(&property.value);
                let fits = |name: &&str| !name.trim().is_empty() && name.chars().count() <= LONGEST_NAME;
                match named.text().filter(fits) {
                    Some(name) => add(self, property.start(), property.name.as_str(), name),
                    None => self.wrong(named, "the name of a choice must be a short, non-empty text"),
                }
            }
        } else {
            self.wrong(
                value,
                "it must be a list: [\"one\", \"other\"], or an object: { \"one\": \"its name\" }",
            );
        }
        (self.mistakes.len() == before).then(|| intern::options(options))
    }

    fn index(&mut self, value: Cursor, what: &str, words: &[&'static str]) -> Option<usize> {
        let known: Vec<_> = words.iter().enumerate().map(|(i, word)| (*word, i)).collect();
        self.word(value, what, &known)
    }
}
