//! Checks a parsed condition: unknown quantities, wrong types, and values that cannot occur.

use super::{
    Condition, Expression, Operand, Sign, Term, Value,
    evaluate::operands,
    never,
    quantity::{Argument, Kind, type_of},
    scene,
};
use crate::{
    document::Selection,
    lesson::controls,
    parameter::Parameter,
    registry::Registry,
    scene::{Field, Scene},
    text::{did_you_mean, listed, quoted},
};

impl Condition {
    /// All mistakes, by byte, for the scene in which the step begins.
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
        for (part, wanted) in comparisons(&self.expression, true) {
            match part {
                Expression::Truth(operand) => {
                    if let Some(kind @ (Kind::Number | Kind::Text)) = kinds(operand) {
                        let what = "which alone is neither true nor false; compare it, as in … = …";
                        mistakes.push((operand.at, format!("this is a {}, {what}", kind.name())));
                    }
                }
                Expression::Comparison { left, sign, right } => {
                    if let (Some(a), Some(b)) = (kinds(left), kinds(right)) {
                        let meant = if wanted { *sign } else { sign.opposite() };
                        mistakes.extend(compared(left, (a, b), *sign, right));
                        mistakes.extend(never::beyond(left, meant, right, registry));
                        mistakes.extend(spelling(left, right, scene, registry));
                        mistakes.extend(spelling(right, left, scene, registry));
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

/// The comparisons in an expression: true for those that should hold, false for those that should not.
fn comparisons(expression: &Expression, wanted: bool) -> Vec<(&Expression, bool)> {
    match expression {
        Expression::All(parts) | Expression::Any(parts) => {
            parts.iter().flat_map(|part| comparisons(part, wanted)).collect()
        }
        Expression::Not(part) => comparisons(part, !wanted),
        Expression::Comparison { .. } | Expression::Truth(_) => vec![(expression, wanted)],
    }
}

/// The mistake in a comparison between two types.
fn compared(left: &Operand, (a, b): (Kind, Kind), sign: Sign, right: &Operand) -> Option<(usize, String)> {
    let has_order = !matches!(sign, Sign::Equal | Sign::NotEqual);
    for (operand, kind) in [(left, a), (right, b)] {
        if has_order && matches!(kind, Kind::Text | Kind::Truth) {
            let what = if kind == Kind::Text { "a text" } else { "true or false" };
            let rule = "cannot be greater or less than another value; compare it with = or !=";
            return Some((operand.at, format!("this is {what}, which {rule}")));
        }
    }
    (a != b && a != Kind::Various && b != Kind::Various).then(|| {
        let word = |kind: Kind| match kind {
            Kind::Number => "a number",
            Kind::Text => "a text",
            Kind::Truth | Kind::Various => "true or false",
        };
        let (here, there) = (word(b), word(a));
        (right.at, format!("this is {here}, but the other side is {there}; both must have the same type"))
    })
}

/// A text that is not a possible value of a quantity.
fn spelling(
    quantity: &Operand,
    text: &Operand,
    scene: &Scene,
    registry: &Registry,
) -> Option<(usize, String)> {
    let (Term::Quantity(asked), Term::Value(Value::Text(written))) = (&quantity.what, &text.what) else {
        return None;
    };
    let mut known = (asked.quantity.texts)(registry);
    let names = object_names(scene);
    if asked.quantity.name == "probe.object" {
        // The learner may add objects.
        let added = written.strip_prefix("object ").and_then(|number| number.parse::<usize>().ok());
        if added.is_some_and(|number| number > scene.objects.len()) {
            return None;
        }
        known = names.iter().map(String::as_str).collect();
    }
    match &asked.argument {
        Argument::Name(name) => {
            let options = registry.material_parameter(name).map_or(&[][..], |p| p.kind.options());
            if !options.is_empty() {
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
        Argument::None | Argument::Angle(_) | Argument::Declared(_) => {}
    }
    if known.is_empty() || known.contains(&written.as_str()) {
        return None;
    }
    let near = did_you_mean(written, known.iter().map(|k| (*k, *k)));
    let all = if known.len() > 12 { String::new() } else { format!("; it is {}", listed(&known, "or")) };
    Some((text.at, format!("{} is never {}{all}{near}", asked.written(), quoted(written))))
}

/// The names of the objects, as in the probe.
fn object_names(scene: &Scene) -> Vec<String> {
    let name = |(i, object): (usize, &crate::scene::Object)| {
        object.name.clone().unwrap_or_else(|| format!("object {}", i + 1))
    };
    scene.objects.iter().enumerate().map(name).collect()
}

/// The type of an operand, or the reason why it does not exist.
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
        Argument::None | Argument::Angle(_) | Argument::Declared(_) => {
            if asked.group() == "curve" && selection.is_some_and(|s| !matches!(s, Selection::Object(_))) {
                return Err("this is about the selected object, but the step selects none; write select: object 1 in its view block".to_owned());
            }
            Ok(asked.quantity.kind)
        }
    }
}

/// The type of a parameter.
fn of_knob(
    name: &str,
    scene: &Scene,
    selection: Option<Selection>,
    registry: &Registry,
) -> Result<Kind, String> {
    let of = |entries: &[&str], is_text, is_flag, part: &str| {
        type_of(entries, is_text, is_flag).ok_or_else(|| {
            let count = ["", "", "two", "three"].get(entries.len()).unwrap_or(&"several");
            format!("{name} is {count} numbers; compare one of them, as in scene.{part}.{name}[0]")
        })
    };
    let parameter = controls::parameters(registry).find(|p| p.name == name);
    if let Some(Parameter { kind, .. }) = parameter.filter(|_| !controls::is_of_display(name)) {
        let used = match selection {
            Some(Selection::Object(i)) => scene.objects.get(i).and_then(|object| {
                let model = registry.model(scene.model_of(object))?;
                let shading = registry.shading_model(scene.shading_model_of(object))?;
                let shape = registry.shape(&object.object_type)?;
                let mut all = model.parameters.iter().chain(shading.parameters).chain(shape.parameters);
                // The task may begin with choosing another model.
                Some(all.any(|p| p.name == name) || registry.material_parameter(name).is_some())
            }),
            Some(Selection::Light(i)) => scene.lights.get(i).and_then(|light| {
                Some(registry.light(&light.light_type)?.parameters.iter().any(|p| p.name == name))
            }),
            Some(Selection::Room | Selection::Observer) => Some(false),
            None => None,
        };
        if used == Some(false) {
            return Err(format!("the part that the step selects has no knob {}", quoted(name)));
        }
        return of(kind.entries(), kind.is_text(), kind.is_flag(), "objects[0].material");
    }
    match controls::field(name).filter(|_| controls::KNOBS.contains(&name)) {
        Some(Field { kind, .. }) => of(kind.entries(), kind.is_text(), kind.is_flag(), "lights[0]"),
        None => {
            let known = controls::knobs(registry);
            let near = did_you_mean(name, known.iter().map(|k| (*k, *k)));
            Err(format!("there is no parameter {}{near}", quoted(name)))
        }
    }
}
