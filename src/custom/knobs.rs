//! The parameters declared by a model's file.

use jsonc_parser::common::Ranged as _;

use super::{
    intern,
    reader::{LONGEST_NAME, LONGEST_TEXT, Reader},
    text::{allowed_in_wgsl, humanised, identifier},
};
use crate::{
    parameter::{ABOVE_ZERO, Parameter, ParameterKind},
    text::{
        json::{Ast, Cursor, Fields, Reader as _},
        quoted,
    },
};

/// The keys of an entry of `parameters`.
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
    "used_when",
];
/// The types of parameters.
const TYPES: &[&str] = &["number", "integer", "colour", "triple", "choice", "flag"];
/// The default symbol of a parameter: a Greek letter if the parameter's name begins with that letter's name.
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

impl Reader<'_> {
    pub(super) fn parameter(&mut self, value: Cursor) -> Option<Parameter> {
        let fields = self.fields(value, PARAMETER_KEYS, "a parameter")?;
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
        let usual_unit = if matches!(kind, Some(ParameterKind::Colour { .. })) { "sRGB" } else { "" };
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
        };
        self.same_unit_elsewhere(named, &parameter);
        (self.mistakes.len() == before).then_some(parameter)
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
            let rule = format!(
                "{} has a parameter of that name with type {}; parameters are shared by name, so use that type or another name",
                model.declaration.id,
                parameter.kind.name(),
            );
            self.wrong(named, &rule);
        }
    }

    fn kind(&mut self, fields: &Fields, shared: Option<&ParameterKind>) -> Option<ParameterKind> {
        let types: Vec<_> = TYPES.iter().map(|t| (*t, *t)).collect();
        let kind = match fields.get("type") {
            Some(value) => self.word(value, "a type", &types)?,
            None => match (shared, fields.get("choices"), fields.get("default")) {
                (Some(shared), ..) => shared.name(),
                (None, Some(_), _) => "choice",
                (None, None, Some(Cursor { value: Ast::BooleanLit(_), .. })) => "flag",
                (None, None, Some(default)) if default.list().is_some() => {
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
                self.misplaced(value, &format!("is given, but a {kind} has none"));
                return None;
            }
        }
        match kind {
            "number" => self.number_kind(fields, shared),
            "integer" => self.integer_kind(fields, shared),
            "colour" => self.colour_kind(fields, shared),
            "triple" => self.triple_kind(fields, shared),
            "flag" => Some(self.flag_kind(fields, shared)),
            _ => self.choice_kind(fields, shared),
        }
    }

    /// A finite 32-bit number.
    fn number(&mut self, value: Cursor) -> Option<f32> {
        let number = value.number().filter(|n| n.is_finite());
        if number.is_none() {
            self.wrong(value, "it must be a number");
        }
        number
    }

    /// An integer that a 32-bit float represents exactly, as in the shader.
    fn whole(&mut self, value: Cursor) -> Option<i64> {
        const EXACT: i64 = 1 << 24;
        let number = value.integer().filter(|n| (-EXACT..=EXACT).contains(n));
        if number.is_none() {
            self.wrong(value, &format!("it must be a whole number between -{EXACT} and {EXACT}"));
        }
        number
    }

    /// Three numbers, or one for all three.
    fn triple(&mut self, value: Cursor) -> Option<[f32; 3]> {
        match value.list() {
            None if value.number().is_some() => Some([self.number(value)?; 3]),
            Some(list) if list.len() == 3 => {
                let mut triple = [0.0; 3];
                for (to, element) in triple.iter_mut().zip(list) {
                    *to = self.number(value.holding(element.value))?;
                }
                Some(triple)
            }
            _ => {
                self.wrong(value, "it must be three numbers, [red, green, blue], or one for all");
                None
            }
        }
    }

    /// An optional field; `None` only if it is invalid.
    fn given<T>(
        &mut self,
        fields: &Fields,
        key: &str,
        read: fn(&mut Self, Cursor) -> Option<T>,
    ) -> Option<Option<T>> {
        fields.get(key).map_or(Some(None), |value| read(self, value).map(Some))
    }

    /// Minimum and maximum, from `range`, or from `min` or `above`, and `max`.
    fn limits<T: Copy + PartialOrd>(
        &mut self,
        fields: &Fields,
        (min, max): (T, Option<T>),
        read: fn(&mut Self, Cursor) -> Option<T>,
        above_zero: Option<T>,
    ) -> Option<(T, Option<T>)> {
        let (mut low, mut high) = (min, max);
        if let Some(value) = fields.get("range") {
            if let Some(other) = ["min", "max", "above"].into_iter().find(|key| fields.get(key).is_some()) {
                self.misplaced(value, &format!("conflicts with {other}; a range is [min, max]"));
                return None;
            }
            let Some(list) = value.list().filter(|list| list.len() == 2) else {
                self.wrong(value, "a range must be two numbers: [min, max]");
                return None;
            };
            let ends: Vec<_> = list.map(|end| read(self, end)).collect();
            (low, high) = (ends[0]?, Some(ends[1]?));
        }
        let (least, most) = (self.given(fields, "min", read), self.given(fields, "max", read));
        if let Some(value) = fields.get("above") {
            let zero = value.integer() == Some(0);
            let Some(above) = above_zero.filter(|_| zero && fields.get("min").is_none()) else {
                self.wrong(value, "it must be 0; it replaces min and means greater than 0");
                return None;
            };
            low = above;
        }
        (low, high) = (least?.unwrap_or(low), most?.or(high));
        if high.is_some_and(|h| h <= low) {
            let value = ["max", "range", "min", "above"].into_iter().find_map(|key| fields.get(key))?;
            self.wrong(value, "the largest value must be greater than the smallest");
            return None;
        }
        Some((low, high))
    }

    /// A default within the range.
    fn within(&mut self, fields: &Fields, parameter: ParameterKind) -> Option<ParameterKind> {
        let probe = Parameter {
            name: "",
            symbol: "",
            label: "",
            unit: "",
            help: "",
            kind: parameter,
            used_when: None,
        };
        if !probe.allows(&probe.default_value()) {
            match fields.get("default") {
                Some(value) => self.wrong(value, &format!("it must be {}", probe.rule())),
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
        let given = self.given(fields, "default", Self::number)?;
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
        let given = self.given(fields, "default", Self::whole)?;
        let slider_given = self.given(fields, "slider_max", Self::whole)?;
        let (min, max) = limits?;
        let inside = |v: i64| v >= min && max.is_none_or(|m| v <= m);
        let default = given.or(usual.filter(|u| inside(*u))).unwrap_or(min);
        let slider = slider_given.or(slider.filter(|s| *s > min));
        let slider_max =
            max.map_or_else(|| slider.unwrap_or(default.max(min) + 16), |m| slider.unwrap_or(m).min(m));
        if slider_max <= min {
            if let Some(value) = fields.get("slider_max") {
                self.wrong(value, &format!("it must be greater than {min}, the start of the slider"));
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
        let channel = |e: Cursor| e.integer().and_then(|v| u8::try_from(v).ok());
        let channels = value.list().and_then(|list| list.map(channel).collect::<Option<Vec<_>>>());
        let Some(default) = channels.and_then(|c| c.try_into().ok()) else {
            self.wrong(value, "a colour must be three whole numbers from 0 to 255: [red, green, blue]");
            return None;
        };
        Some(ParameterKind::Colour { default })
    }

    fn triple_kind(&mut self, fields: &Fields, shared: Option<&ParameterKind>) -> Option<ParameterKind> {
        let (min, max, usual) = match shared {
            Some(ParameterKind::Triple { min, max, default }) => (*min, *max, Some(*default)),
            _ => (0.0, 1.0, None),
        };
        let limits = self.limits(fields, (min, Some(max)), Self::number, Some(ABOVE_ZERO));
        let given = self.given(fields, "default", Self::triple)?;
        let (min, max) = limits?;
        let max = max.unwrap_or(1.0);
        let fits = |t: &[f32; 3]| t.iter().all(|c| (min..=max).contains(c));
        let default = given.or(usual.filter(fits)).unwrap_or([0.5 * min + 0.5 * max; 3]);
        self.within(fields, ParameterKind::Triple { min, max, default })
    }

    fn flag_kind(&mut self, fields: &Fields, shared: Option<&ParameterKind>) -> ParameterKind {
        let usual = matches!(shared, Some(ParameterKind::Choice { default: 1, .. }));
        ParameterKind::flag(self.flag(fields, "default", usual, "it must be true or false"))
    }

    fn choice_kind(&mut self, fields: &Fields, shared: Option<&ParameterKind>) -> Option<ParameterKind> {
        let (mut options, usual) = match shared {
            Some(ParameterKind::Choice { options, default }) => (options.to_vec(), options[*default].0),
            _ => (Vec::new(), ""),
        };
        if let Some(value) = fields.get("choices") {
            options = self.choices(value)?;
        }
        if options.is_empty() {
            self.lacking(
                fields,
                "choices",
                "a choice needs some: [\"one\", \"other\"], or { \"one\": \"its name\" }",
            );
            return None;
        }
        let known: Vec<_> = options.iter().enumerate().map(|(i, (id, _))| (*id, i)).collect();
        let default = match fields.get("default") {
            Some(value) => self.word(value, "the default", &known)?,
            None => options.iter().position(|(id, _)| *id == usual).unwrap_or(0),
        };
        Some(ParameterKind::Choice { options: intern::options(options), default })
    }

    /// Choices as a list of ids, or as an object from id to name.
    fn choices(&mut self, value: Cursor) -> Option<Vec<(&'static str, &'static str)>> {
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
        (self.mistakes.len() == before).then_some(options)
    }
}
