//! Curves of custom models: the albedos of built-in models whose parameters follow those of the custom one.
//!
//! `"curves": { "coat": { "model": "microfacet", "alpha_x": "coat_alpha", "fresnel": "dielectric" } }` gives the shader
//! `curve_coat(mu)`, the directional albedo of that material in rgb and the luminance of its specular term in w, and
//! `mean_coat()`, their means over the hemisphere.

use std::{mem::discriminant, sync::Arc};

use glam::Vec4;
use jsonc_parser::{ast::ObjectProp, common::Ranged as _};

use super::{
    intern,
    lobes::{SaidLobes, declared_alone},
    reader::Reader,
    text,
};
use crate::{
    optics::{
        Frame, Terms,
        albedo::{AlbedoCurve, Albedos, LobeAlbedo, NamedCurve, Spacing},
        colour::{Encoding, luminance},
    },
    parameter::{Parameter, Value, Values},
    reflection::ModelEntry,
    text::{
        did_you_mean,
        json::{Ast, Cursor, Fields, Reader as _, describe},
        listed, quoted,
    },
};

/// Maximum number of curves of a model: each takes 17 quadruples of an object's row.
const MOST: usize = 8;
const RULE: &str = "it must be an object of curves: { \"coat\": { \"model\": \"microfacet\", \"alpha_x\": \"coat_alpha\" } }";

/// A curve.
#[derive(Clone)]
pub(super) struct Curve {
    name: &'static str,
    model: ModelEntry,
    settings: Vec<(&'static Parameter, Setting)>,
}

/// The value of a parameter of the built-in model.
#[derive(Clone)]
enum Setting {
    Fixed(Value),
    /// The value of the custom model's parameter of the same type.
    Of(Parameter),
}

/// The curves that the shader of a custom model reads: those of a built-in model, and its own.
#[derive(Clone, Default)]
pub(super) struct Reads {
    /// The built-in model whose lobe and curves are read, with the parameters of the custom model by name.
    pub lobe: Option<ModelEntry>,
    pub own: Arc<[Curve]>,
    /// The directions in which the model reflects most, for the light loop.
    pub lobes: Arc<SaidLobes>,
}

impl Reads {
    /// True if the model reads any curve.
    pub fn any(&self) -> bool {
        self.lobe.is_some() || !self.own.is_empty()
    }

    /// The curves' names, in the order of the row.
    pub fn named(&self) -> &'static [NamedCurve] {
        let of_model = self.lobe.as_ref().map_or(&[][..], ModelEntry::curves);
        let own = self.own.iter().map(|curve| NamedCurve { name: curve.name, spacing: Spacing::Cubic });
        intern::curves(of_model.iter().copied().chain(own).collect())
    }

    /// The lobe and the values of the curves.
    pub fn values(
        &self,
        parameters: &[Parameter],
        values: &Values,
        encoding: Encoding,
    ) -> (LobeAlbedo, Vec<Vec4>) {
        // A model that has curves but no lobe: its row contains the lobe that reflects everything.
        let (lobe, mut all) = self.lobe.as_ref().map_or_else(Default::default, |model| {
            let surface = model.instantiate(&declared_alone(parameters, values), encoding);
            (surface.lobe().unwrap_or_default(), model.curves_of(&*surface))
        });
        all.extend(self.own.iter().flat_map(|curve| curve.values(values, encoding)));
        (lobe, all)
    }
}

impl Curve {
    fn values(&self, values: &Values, encoding: Encoding) -> Vec<Vec4> {
        let mut set = Values::default();
        for (parameter, setting) in &self.settings {
            let value = match setting {
                Setting::Fixed(value) => Some(value.clone()),
                // Values outside the built-in model's range are clamped to it.
                Setting::Of(own) => {
                    let value = values.get(own);
                    if parameter.allows(&value) { Some(value) } else { parameter.nearest(&value) }
                }
            };
            if let Some(value) = value {
                set.set(parameter.name, value);
            }
        }
        let surface = self.model.instantiate(&set, encoding);
        let anisotropic = self.model.declaration.anisotropic;
        let new = |of: fn(Terms) -> Terms| {
            AlbedoCurve::new(|l, v| of(surface.response(l, v, &Frame::LOCAL)), anisotropic).harmonics[0]
        };
        let all = surface.curve().map_or_else(|| new(|terms| terms), |curve| curve.harmonics[0]);
        let specular = new(|terms| Terms { specular: terms.specular, ..Terms::default() });
        let channel = |c: usize| LobeAlbedo::from_nodes(all.map(|rgb| rgb[c]));
        let specular = LobeAlbedo::from_nodes(specular.map(luminance));
        Albedos::of([channel(0), channel(1), channel(2), specular]).values()
    }
}

impl Reader<'_> {
    /// The curves by name, each with its model and parameter settings. `taken` are the curve names of the
    /// model whose lobe is read.
    pub(super) fn curves(
        &mut self,
        fields: &Fields,
        parameters: &[Parameter],
        taken: &[NamedCurve],
    ) -> Vec<Curve> {
        let Some(value) = fields.get("curves") else { return Vec::new() };
        let Some(properties) = value.properties() else {
            self.wrong(value, RULE);
            return Vec::new();
        };
        let mut curves: Vec<Curve> = Vec::new();
        for property in properties {
            let name = property.name.as_str();
            let problem = if let Err(rule) = text::identifier(name) {
                Some(format!("a name in the shader {rule}"))
            } else if curves.iter().any(|c| c.name == name) {
                Some("is given twice".to_owned())
            } else if taken.iter().any(|c| c.name == name) {
                Some("is the name of a curve of the \"lobe\" model; choose another name".to_owned())
            } else if curves.len() == MOST {
                Some(format!("is one too many: at most {MOST} fit"))
            } else {
                None
            };
            if let Some(problem) = problem {
                self.mistake(property.start(), format!("curves: {}: {problem}", quoted(name)));
                continue;
            }
            let entry = value.entry(intern::text(name), &property.value);
            curves.extend(self.curve(entry, property, parameters));
        }
        curves
    }

    fn curve(&mut self, of: Cursor, property: &ObjectProp, parameters: &[Parameter]) -> Option<Curve> {
        let Some(properties) = of.properties() else {
            self.wrong(of, RULE);
            return None;
        };
        let name = property.name.as_str();
        let at = format!("curves: {}", quoted(name));
        let known: Vec<_> = self.built_in_models().map(|m| (m.declaration.id, m.declaration.id)).collect();
        let Some(model) = properties.iter().find(|p| p.name.as_str() == "model") else {
            let rule = "it needs a \"model\": the built-in model whose albedo it is";
            self.mistake(property.start(), format!("{at}: {rule}"));
            return None;
        };
        let id = self.word(of.entry("model", &model.value), "the model of a curve", &known)?;
        let model = self.registry.model(id)?.clone();
        let mut settings: Vec<(&'static Parameter, Setting)> = Vec::new();
        if let Some(twice) = properties.iter().filter(|p| p.name.as_str() == "model").nth(1) {
            self.mistake(twice.start(), format!("{at}: model is given twice"));
        }
        for setting in properties.iter().filter(|p| p.name.as_str() != "model") {
            let written = setting.name.as_str();
            let Some(parameter) = model.parameter(&written.replace("color", "colour")) else {
                let hint = did_you_mean(written, model.parameters.iter().map(|p| (p.name, p.name)));
                let what = format!("{at}: {} is not a parameter of {id}{hint}", quoted(written));
                self.mistake(setting.start(), what);
                continue;
            };
            let name = parameter.name;
            if settings.iter().any(|(known, _)| known.name == name) {
                self.mistake(setting.start(), format!("{at}: {name} is given twice"));
                continue;
            }
            if let Some(value) = meaning(parameter, &setting.value, parameters) {
                settings.push((parameter, value));
                continue;
            }
            let same: Vec<_> =
                parameters.iter().filter(|p| alike(p, parameter)).map(|p| quoted(p.name)).collect();
            let all = format!(", or one of the model's parameters {}", listed(&same, "and"));
            let or = if same.is_empty() { "" } else { &all };
            let (found, rule) = (describe(&setting.value, self.text()), parameter.rule());
            let what = format!("{at}: {name} is {found}, but it must be {rule}{or}");
            self.mistake(setting.value.start(), what);
        }
        Some(Curve { name: intern::text(name), model, settings })
    }
}

/// True if values of one parameter are valid for the other.
fn alike(one: &Parameter, other: &Parameter) -> bool {
    discriminant(&one.kind) == discriminant(&other.kind) && one.kind.options() == other.kind.options()
}

/// A literal value, or the name of a parameter of the custom model.
fn meaning(parameter: &Parameter, written: &Ast, own: &[Parameter]) -> Option<Setting> {
    let literal = |value: &Ast| match value {
        Ast::NumberLit(number) => Some(number.value.to_owned()),
        Ast::StringLit(text) => Some(text.value.to_string()),
        Ast::BooleanLit(flag) => Some(flag.value.to_string()),
        _ => None,
    };
    let text = match written {
        Ast::Array(array) => array.elements.iter().map(literal).collect::<Option<Vec<_>>>()?.join(","),
        value => literal(value)?,
    };
    if let Ok(value) = parameter.parse(&text) {
        return Some(Setting::Fixed(value));
    }
    own.iter().find(|p| p.name == text && alike(p, parameter)).cloned().map(Setting::Of)
}
