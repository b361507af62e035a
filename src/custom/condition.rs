//! The conditions under which the parameters of a model's file are used.

use jsonc_parser::common::Ranged as _;

use super::{intern, reader::Reader};
use crate::{
    parameter::{Parameter, UsedWhen},
    reflection::usage,
    text::{
        json::{Cursor, Fields, Reader as _},
        shortened,
    },
};

impl Reader<'_> {
    /// The choices of another parameter for which this one is used: `{ "distribution": ["gtr"] }`.
    pub(super) fn used_when(&mut self, fields: &Fields) -> Option<UsedWhen> {
        let value = fields.get("used_when")?;
        let condition = condition(value);
        if condition.is_none() {
            let rule = "it must name one other parameter and its choices: { \"distribution\": [\"gtr\"] }";
            self.wrong_condition(value, rule);
        }
        condition
    }

    /// Reports conditions that no parameter of the model can meet. They may name parameters that come later, so this
    /// runs once all are known.
    pub(super) fn check_conditions(&mut self, list: Cursor, parameters: &[Parameter]) {
        for element in list.list().into_iter().flatten() {
            let Some((name, value)) = element.get("name").zip(element.get("used_when")) else { continue };
            let parameter = parameters.iter().find(|p| Some(p.name) == name.text());
            if let Some(problem) = parameter.and_then(|p| usage::problem(parameters, p)) {
                self.wrong_condition(value, &problem);
            }
        }
    }

    /// Reports a condition as it is written.
    fn wrong_condition(&mut self, value: Cursor, rule: &str) {
        let found = shortened(value.value.text(self.text()));
        self.report(value.start(), value.path(), Some(found), rule);
    }
}

fn condition(value: Cursor) -> Option<UsedWhen> {
    let [property] = value.properties()? else { return None };
    let choices = value.holding(&property.value);
    let text = |choice: Cursor| choice.text().map(intern::text);
    let choices: Vec<_> = match choices.list() {
        Some(list) => list.map(text).collect::<Option<_>>()?,
        None => vec![text(choices)?],
    };
    let parameter = intern::text(property.name.as_str());
    (!choices.is_empty()).then(|| UsedWhen { parameter, choices: intern::names(choices) })
}
