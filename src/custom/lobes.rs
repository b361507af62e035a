//! Lobes of custom models: the directions from which they reflect most, for sampling light with extent.
//!
//! `"lobes": ["cosine", { "shape": "ggx", "roughness": "roughness", "weight": "k_s" }]` or `"lobes":
//! "phong"`, the lobes of a built-in model with parameters of the same names.

use super::reader::Reader;
use crate::{
    optics::{
        colour::Encoding,
        lobes::{Lobe, Lobes, MAX_LOBES},
    },
    parameter::{Parameter, Values},
    reflection::{Declaration, ModelEntry},
    text::{
        json::{Cursor, Fields, Reader as _},
        listed, quoted,
    },
};

/// The keys that give the width of a lobe.
const WIDTHS: &[&str] = &["alpha", "roughness", "exponent"];
const KEYS: &[&str] = &["shape", "weight", "alpha", "roughness", "exponent"];
const RULE: &str = "it must be a list such as [\"cosine\", { \"shape\": \"ggx\", \"alpha\": 0.3 }], or the id of a built-in model whose lobes fit";

/// The lobes given by a declaration.
#[derive(Clone, Default)]
pub(super) enum SaidLobes {
    /// No lobes declared.
    #[default]
    Nothing,
    /// The lobes of a built-in model, with the custom model's parameters by name.
    Of(ModelEntry),
    /// These lobes, with their weights.
    These(Vec<(Shape, Number)>),
}

/// The shape of a lobe.
#[derive(Clone)]
pub(super) enum Shape {
    Cosine,
    /// Widths along tangent and bitangent, and how they are given.
    Ggx(Width, [Number; 2]),
    Power(Number),
}

#[derive(Clone, Copy)]
pub(super) enum Width {
    Alpha,
    /// Roughness; its square is α.
    Roughness,
    /// Exponent of a lobe of half vectors.
    Exponent,
}

/// A number, or a parameter that provides one.
#[derive(Clone)]
pub(super) enum Number {
    Fixed(f32),
    Of(Parameter),
}

impl Number {
    fn value(&self, values: &Values, encoding: Encoding) -> f32 {
        match self {
            Self::Fixed(number) => *number,
            Self::Of(p) => match p.kind.linear(&values.get(p), encoding) {
                Some(three) => three.element_sum() / 3.0,
                None => values.number(p),
            },
        }
    }
}

impl Shape {
    fn lobe(&self, values: &Values, encoding: Encoding) -> Lobe {
        let number = |n: &Number| n.value(values, encoding);
        match self {
            Self::Cosine => Lobe::Cosine,
            Self::Power(exponent) => Lobe::Power { exponent: number(exponent) },
            Self::Ggx(width, both) => {
                let [x, y] = both.each_ref().map(number);
                match width {
                    Width::Alpha => Lobe::Ggx { alpha_x: x, alpha_y: y },
                    Width::Roughness => Lobe::Ggx { alpha_x: x * x, alpha_y: y * y },
                    Width::Exponent => Lobe::of_half_vectors(x, y),
                }
            }
        }
    }
}

impl SaidLobes {
    /// The lobes for these values of the model's parameters.
    pub fn lobes(
        &self,
        declaration: &Declaration,
        parameters: &[Parameter],
        values: &Values,
        encoding: Encoding,
    ) -> Lobes {
        match self {
            Self::Nothing if declaration.transmits => Lobes::of_both_sides(),
            Self::Nothing => Lobes::default(),
            Self::Of(model) => model.instantiate(&declared_alone(parameters, values), encoding).lobes(),
            Self::These(all) => {
                let lobe = |(shape, weight): &(Shape, Number)| {
                    (shape.lobe(values, encoding), weight.value(values, encoding))
                };
                Lobes::new(&all.iter().map(lobe).collect::<Vec<_>>())
            }
        }
    }
}

/// The values of declared parameters only: others must not affect the appearance of a model.
pub(super) fn declared_alone(parameters: &[Parameter], values: &Values) -> Values {
    let mut own = Values::default();
    for p in parameters {
        own.set(p.name, values.get(p));
    }
    own
}

impl Reader<'_> {
    pub(super) fn lobes(&mut self, fields: &Fields, parameters: &[Parameter]) -> SaidLobes {
        let Some(value) = fields.get("lobes") else { return SaidLobes::Nothing };
        if value.text().is_some() {
            let known: Vec<_> =
                self.built_in_models().map(|m| (m.declaration.id, m.declaration.id)).collect();
            let id = self.word(value, "the model whose lobes fit", &known);
            let model = id.and_then(|id| self.registry.model(id)).cloned();
            return model.map_or(SaidLobes::Nothing, SaidLobes::Of);
        }
        let Some(list) = value.list().filter(|list| list.len() > 0) else {
            self.wrong(value, RULE);
            return SaidLobes::Nothing;
        };
        if list.len() > MAX_LOBES {
            self.wrong(value, &format!("at most {MAX_LOBES} lobes fit"));
            return SaidLobes::Nothing;
        }
        SaidLobes::These(list.filter_map(|element| self.lobe_shape(element, parameters)).collect())
    }

    fn lobe_shape(&mut self, value: Cursor, parameters: &[Parameter]) -> Option<(Shape, Number)> {
        const SHAPES: &[(&str, &str)] = &[("cosine", "cosine"), ("ggx", "ggx"), ("power", "power")];
        if value.text().is_some() {
            // The only shape without a width.
            if value.text() == Some("cosine") {
                return Some((Shape::Cosine, Number::Fixed(1.0)));
            }
            self.wrong(value, "a lobe without a width must be \"cosine\"; others need one: { \"shape\": \"ggx\", \"alpha\": 0.3 }");
            return None;
        }
        let fields = self.fields(value, KEYS, "a lobe")?;
        let Some(shape) = fields.get("shape") else {
            self.lacking(&fields, "shape", "it must be \"cosine\", \"ggx\" or \"power\"");
            return None;
        };
        let shape = self.word(shape, "the shape of a lobe", SHAPES)?;
        let usable: &[&str] = match shape {
            "ggx" => WIDTHS,
            "power" => &["exponent"],
            _ => &[],
        };
        for key in WIDTHS {
            if let Some(value) = fields.get(key).filter(|_| !usable.contains(key)) {
                self.misplaced(value, &format!("is given, but a lobe of the shape {shape} has none"));
                return None;
            }
        }
        let widths: Vec<_> = usable.iter().filter_map(|key| Some((*key, fields.get(key)?))).collect();
        let weight = match fields.get("weight") {
            Some(value) => self.lobe_number(value, parameters, true)?,
            None => Number::Fixed(1.0),
        };
        let shape = match (usable, widths.as_slice()) {
            ([], _) => Shape::Cosine,
            (_, [(_, exponent)]) if shape == "power" => {
                Shape::Power(self.lobe_number(*exponent, parameters, false)?)
            }
            (_, [(key, value)]) => {
                let width = match *key {
                    "alpha" => Width::Alpha,
                    "roughness" => Width::Roughness,
                    _ => Width::Exponent,
                };
                let both = match value.list().filter(|list| list.len() == 2) {
                    Some(mut list) => {
                        let [x, y] = [list.next()?, list.next()?];
                        [self.lobe_number(x, parameters, false)?, self.lobe_number(y, parameters, false)?]
                    }
                    None => {
                        let one = self.lobe_number(*value, parameters, false)?;
                        [one.clone(), one]
                    }
                };
                Shape::Ggx(width, both)
            }
            (usable, _) => {
                let keys: Vec<_> = usable.iter().map(|key| quoted(key)).collect();
                let rule = format!("a lobe of the shape {shape} needs one of {}", listed(&keys, "or"));
                self.mistake(value.start(), format!("{}: {rule}", value.path()));
                return None;
            }
        };
        Some((shape, weight))
    }

    /// A non-negative number, or the name of a numeric parameter; for a weight, also the mean of a colour or
    /// triple parameter.
    fn lobe_number(&mut self, value: Cursor, parameters: &[Parameter], mean: bool) -> Option<Number> {
        let fits = |p: &&Parameter| p.kind.is_number() || mean && p.kind.limits().is_some();
        let found = match value.text() {
            Some(name) => parameters.iter().filter(fits).find(|p| p.name == name).cloned().map(Number::Of),
            None => value.number().filter(|n| n.is_finite() && *n >= 0.0).map(Number::Fixed),
        };
        if found.is_none() {
            let names: Vec<_> = parameters.iter().filter(fits).map(|p| quoted(p.name)).collect();
            let or = if names.is_empty() {
                String::new()
            } else {
                format!(", or one of the parameters {}", listed(&names, "and"))
            };
            let rule = format!("it must be a number, 0 or more{or}");
            self.wrong(value, value.too_large().unwrap_or(&rule));
        }
        found
    }
}
