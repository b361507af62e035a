//! Mistakes in a condition that was read: quantities that do not exist, types that do not fit, tasks that are
//! done before they begin.

use super::{
    Condition, Expression, Operand, Sign, Term, Value,
    evaluate::{self, operands},
    quantity::{Argument, Asked, DISPLAY, Kind, kind_of_parameter},
    scene,
};
use crate::{
    document::Selection,
    lesson::{Situation, controls},
    registry::Registry,
    scene::Scene,
    text::{did_you_mean, listed, quoted},
};

/// The facts that are known when a step begins.
#[derive(Clone, Copy, Debug, Default)]
pub struct Knowledge {
    pub selection: Option<Selection>,
    pub channel: bool,
    pub terms: bool,
    pub plots: bool,
    pub explain: bool,
    pub active: bool,
    /// True if the learner has changed nothing of the scene yet.
    pub scene: bool,
}

impl Knowledge {
    fn of(&self, asked: &Asked) -> bool {
        match asked.quantity.name {
            "window.selected" | "window.selected_index" => self.selection.is_some(),
            "window.channel" => self.channel,
            "window.terms" | "window.shows_term_alone" => self.terms,
            "window.plots" => self.plots,
            "window.explain" => self.explain,
            "window.active" => self.active,
            "window.views" => self.scene,
            "window.presenting" => false,
            "scene.PATH" => self.scene,
            "knob.PARAMETER" if matches!(&asked.argument, Argument::Name(n) if DISPLAY.contains(&n.as_str())) => {
                self.scene
            }
            _ => asked.group() != "probe" && self.scene && self.selection.is_some(),
        }
    }
}

impl Condition {
    /// True if it surely holds when the step begins.
    pub(in crate::lesson) fn holds_at_once(&self, situation: &Situation, known: &Knowledge) -> bool {
        let ask = |asked: &Asked| {
            if known.of(asked) { asked.value(situation) } else { Err(String::new()) }
        };
        evaluate::holds(&self.expression, &ask) == Some(true)
    }

    /// Every mistake, by its byte, for a scene in which the step begins.
    pub(in crate::lesson) fn problems(
        &self,
        scene: &Scene,
        selection: Option<Selection>,
        registry: &Registry,
    ) -> Vec<(usize, String)> {
        let mut found = Vec::new();
        let mut kinds = |operand: &Operand| match kind(operand, scene, selection, registry) {
            Ok(kind) => Some(kind),
            Err(what) => {
                found.push((operand.at, what));
                None
            }
        };
        let mut mistakes = Vec::new();
        for part in comparisons(&self.expression) {
            match part {
                Expression::Truth(operand) => {
                    if let Some(kind @ (Kind::Number | Kind::Text)) = kinds(operand) {
                        mistakes.push((
                            operand.at,
                            format!(
                                "this is a {}, and alone neither true nor false; compare it, as in … = …",
                                kind.name()
                            ),
                        ));
                    }
                }
                Expression::Comparison { left, sign, right } => {
                    if let (Some(a), Some(b)) = (kinds(left), kinds(right)) {
                        mistakes.extend(compared(left, (a, b), *sign, right));
                        mistakes.extend(spelling(left, right, registry));
                        mistakes.extend(spelling(right, left, registry));
                    }
                }
                _ => {}
            }
        }
        found.extend(mistakes);
        if operands(&self.expression).iter().all(|operand| matches!(operand.what, Term::Value(_))) {
            found.push((0, "the condition asks for no quantity, so it never changes".to_owned()));
        }
        found
    }
}

/// The comparisons in an expression.
fn comparisons(expression: &Expression) -> Vec<&Expression> {
    match expression {
        Expression::All(parts) | Expression::Any(parts) => parts.iter().flat_map(comparisons).collect(),
        Expression::Not(part) => comparisons(part),
        Expression::Comparison { .. } | Expression::Truth(_) => vec![expression],
    }
}

/// The mistake in a comparison of two types.
fn compared(left: &Operand, (a, b): (Kind, Kind), sign: Sign, right: &Operand) -> Option<(usize, String)> {
    let has_order = !matches!(sign, Sign::Equal | Sign::NotEqual);
    for (operand, kind) in [(left, a), (right, b)] {
        if has_order && matches!(kind, Kind::Text | Kind::Truth) {
            let what = if kind == Kind::Text { "a text" } else { "true or false" };
            return Some((
                operand.at,
                format!("this is {what}, which is not greater or less than others; compare it by = or !="),
            ));
        }
    }
    (a != b && a != Kind::Various && b != Kind::Various).then(|| {
        let word = |kind: Kind| match kind {
            Kind::Number => "a number",
            Kind::Text => "a text",
            Kind::Truth | Kind::Various => "true or false",
        };
        (right.at, format!("this is {}, and the other side {}; both must be of one type", word(b), word(a)))
    })
}

/// A text that a quantity never has.
fn spelling(quantity: &Operand, text: &Operand, registry: &Registry) -> Option<(usize, String)> {
    let (Term::Quantity(asked), Term::Value(Value::Text(written))) = (&quantity.what, &text.what) else {
        return None;
    };
    let mut known = (asked.quantity.texts)(registry);
    match &asked.argument {
        Argument::Name(name) => {
            let parameter = registry.material_parameter(name);
            if let Some(crate::parameter::ParameterKind::Choice { options, .. }) = parameter.map(|p| &p.kind)
            {
                known = options.iter().map(|(id, _)| *id).collect();
            }
        }
        Argument::Path(path) => match path.segments().last() {
            Some(crate::text::path::Segment::Key(key)) if key == "reflection_model" => {
                known = registry.models().iter().map(|m| m.declaration.id).collect();
            }
            Some(crate::text::path::Segment::Key(key)) if key == "shading_model" => {
                known = registry.shading_models().iter().map(|m| m.declaration.id).collect();
            }
            _ => {}
        },
        Argument::None | Argument::Angle(_) => {}
    }
    if known.is_empty() || known.contains(&written.as_str()) {
        return None;
    }
    let near = did_you_mean(written, known.iter().map(|k| (*k, *k)));
    let all = if known.len() > 12 { String::new() } else { format!("; it is {}", listed(&known, "or")) };
    let name = match &asked.argument {
        Argument::Path(path) => format!("scene.{path}"),
        Argument::Name(name) => format!("knob.{name}"),
        Argument::None | Argument::Angle(_) => asked.quantity.name.to_owned(),
    };
    Some((text.at, format!("{name} is never {}{all}{near}", quoted(written))))
}

/// The type of an operand, or why it does not exist.
fn kind(
    operand: &Operand,
    scene: &Scene,
    selection: Option<Selection>,
    registry: &Registry,
) -> Result<Kind, String> {
    let asked = match &operand.what {
        Term::Value(Value::Number(_)) => return Ok(Kind::Number),
        Term::Value(Value::Text(_)) => return Ok(Kind::Text),
        Term::Value(Value::Truth(_)) => return Ok(Kind::Truth),
        Term::Quantity(asked) => asked,
    };
    match &asked.argument {
        Argument::Path(path) => match scene::json_at(scene, path, registry)? {
            serde_json::Value::Null => Ok(Kind::Various),
            _ => scene::value(scene, path, registry).map(|value| match value {
                Value::Number(_) => Kind::Number,
                Value::Text(_) => Kind::Text,
                Value::Truth(_) => Kind::Truth,
            }),
        },
        Argument::Name(name) => of_knob(name, scene, selection, registry),
        Argument::None | Argument::Angle(_) => {
            if asked.group() == "curve" && selection.is_some_and(|s| !matches!(s, Selection::Object(_))) {
                return Err("this is about the selected object, but the step selects none; write select: object 1 in its view block".to_owned());
            }
            Ok(asked.quantity.kind)
        }
    }
}

/// The type of a knob.
fn of_knob(
    name: &str,
    scene: &Scene,
    selection: Option<Selection>,
    registry: &Registry,
) -> Result<Kind, String> {
    match name {
        "exposure" => return Ok(Kind::Number),
        "tone_mapping" | "encoding" => return Ok(Kind::Text),
        _ => {}
    }
    let lights = registry.lights().iter().flat_map(|entry| entry.parameters);
    let shapes = registry.shapes().iter().flat_map(|entry| entry.parameters);
    let found = registry.material_parameters().chain(lights).chain(shapes).find(|p| p.name == name);
    if let Some(parameter) = found {
        let used = match selection {
            Some(Selection::Object(i)) => scene.objects.get(i).and_then(|object| {
                let model = registry.model(scene.model_of(object))?;
                let shading = registry.shading_model(scene.shading_model_of(object))?;
                let shape = registry.shape(&object.object_type)?;
                let mut all = model.parameters.iter().chain(shading.parameters).chain(shape.parameters);
                // A task may be to choose another model first.
                Some(all.any(|p| p.name == name) || registry.material_parameter(name).is_some())
            }),
            Some(Selection::Light(i)) => scene.lights.get(i).and_then(|light| {
                Some(registry.light(&light.light_type)?.parameters.iter().any(|p| p.name == name))
            }),
            Some(Selection::Room | Selection::Observer) => Some(false),
            None => None,
        };
        if used == Some(false) {
            return Err(format!("what the step selects has no knob {}", quoted(name)));
        }
        return kind_of_parameter(&parameter.kind).ok_or_else(|| {
            format!("{name} is three numbers; compare one of them, as in scene.objects[0].material.{name}[0]")
        });
    }
    match name {
        "intensity" | "luminous_flux" | "colour_temperature" | "size" | "tessellation" | "field_of_view" => {
            Ok(Kind::Number)
        }
        "colour" => {
            Err("colour is three numbers; compare one of them, as in scene.lights[0].colour[0]".to_owned())
        }
        _ => {
            let mut known = controls::parameters(registry);
            known.extend(controls::KNOBS);
            let near = did_you_mean(name, known.iter().map(|k| (*k, *k)));
            Err(format!("there is no parameter {}{near}", quoted(name)))
        }
    }
}
