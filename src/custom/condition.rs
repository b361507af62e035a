//! The conditions under which the parameters of a model's file are used.

use jsonc_parser::ast::Value as Ast;

use super::{
    declaration::{Fields, Reader},
    intern,
};
use crate::{
    parameter::{Parameter, UsedWhen},
    reflection::usage,
};

impl Reader<'_> {
    /// The choices of another parameter under which this one is used: `{ "distribution": ["gtr"] }`.
    pub(super) fn used_when(&mut self, fields: &Fields) -> Option<UsedWhen> {
        let value = fields.get("used_when")?;
        let text = |value: &Ast| match value {
            Ast::StringLit(text) => Some(intern::text(&text.value)),
            _ => None,
        };
        let condition = match value {
            Ast::Object(object) => match object.properties.as_slice() {
                [property] => {
                    let choices: Option<Vec<_>> = match &property.value {
                        Ast::Array(list) => list.elements.iter().map(text).collect(),
                        one => text(one).map(|id| vec![id]),
                    };
                    choices.filter(|c| !c.is_empty()).map(|c| UsedWhen {
                        parameter: intern::text(property.name.as_str()),
                        choices: intern::names(c),
                    })
                }
                _ => None,
            },
            _ => None,
        };
        if condition.is_none() {
            let rule =
                "it must name one other parameter and the choices of it: { \"distribution\": [\"gtr\"] }";
            self.wrong(value, &fields.path("used_when"), rule);
        }
        condition
    }

    /// Reports conditions that no parameter of the model can meet. They can name parameters that come later,
    /// so it is done once all are known.
    pub(super) fn check_conditions(&mut self, list: &[Ast], parameters: &[Parameter]) {
        for (i, element) in list.iter().enumerate() {
            let Ast::Object(object) = element else { continue };
            let text =
                |key: &str| object.properties.iter().find(|p| p.name.as_str() == key).map(|p| &p.value);
            let (Some(Ast::StringLit(name)), Some(value)) = (text("name"), text("used_when")) else {
                continue;
            };
            let parameter = parameters.iter().find(|p| p.name == name.value.as_ref());
            if let Some(problem) = parameter.and_then(|p| usage::problem(parameters, p)) {
                self.wrong(value, &format!("parameters[{i}].used_when"), &problem);
            }
        }
    }
}
