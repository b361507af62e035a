//! The parameters used by a model with its present choices.

use crate::parameter::{Parameter, UsedWhen, Values};

/// The unmet condition of a parameter, with the parameter that it concerns. A parameter that depends on an unused one
/// is itself unused.
fn unmet<'a>(
    parameters: &'a [Parameter],
    parameter: &'a Parameter,
    values: &Values,
) -> Option<(UsedWhen, &'a Parameter)> {
    let mut here = parameter;
    // Chains cannot be longer unless they are circular.
    for _ in parameters {
        let condition = here.used_when?;
        let other = parameters.iter().find(|p| p.name == condition.parameter)?;
        let (chosen, _) = other.kind.options().get(values.choice(other) as usize)?;
        if !condition.choices.contains(chosen) {
            return Some((condition, other));
        }
        here = other;
    }
    None
}

/// The reason why a parameter has no effect at present, without a full stop; `None` if it has an effect.
///
/// ```
/// use lights_camera_models::{parameter::Values, reflection::usage, registry::Registry};
/// let registry = Registry::builtin();
/// let model = registry.model("microfacet").unwrap();
/// let gamma = model.parameter("gamma").unwrap();
/// let reason = usage::unused(model.parameters, gamma, &Values::default());
/// assert_eq!(reason.as_deref(), Some("Not used with GGX: only GTR has γ"));
/// ```
#[must_use]
pub fn unused(parameters: &[Parameter], parameter: &Parameter, values: &Values) -> Option<String> {
    /// Maximum number of choices listed.
    const FEW: usize = 2;
    let (condition, other) = unmet(parameters, parameter, values)?;
    let options = other.kind.options();
    // A name with a comma would look like two.
    let quoted =
        |name: &str| if name.contains([',', '(']) { format!("“{name}”") } else { name.to_owned() };
    let chosen = quoted(options[values.choice(other) as usize].1);
    let users: Vec<_> = options
        .iter()
        .filter(|(id, _)| condition.choices.contains(id))
        .map(|(_, name)| quoted(name))
        .collect();
    if other.kind.is_flag() {
        return Some(format!("Not used while “{}” is {chosen}", other.label));
    }
    if users.len() > FEW || parameter.used_when != Some(condition) {
        return Some(format!("Not used while the {} is {chosen}", other.label));
    }
    let plain = !parameter.symbol.is_empty() && !parameter.symbol.contains(['_', '{', '^']);
    let what = if plain { parameter.symbol } else { parameter.label };
    let verb = if users.len() == 1 { "has" } else { "have" };
    Some(format!("Not used with {chosen}: only {} {verb} {what}", users.join(" and ")))
}

/// The error in a condition, as a rule: the other parameter must be a choice of the same model, the choices
/// must exist, and the conditions must not form a cycle.
#[must_use]
pub fn problem(parameters: &[Parameter], parameter: &Parameter) -> Option<String> {
    let condition = parameter.used_when?;
    let name = condition.parameter;
    let Some(other) = parameters.iter().find(|p| p.name == name) else {
        return Some(format!("it must name a parameter of this model; there is no \"{name}\""));
    };
    let options = other.kind.options();
    if options.is_empty() {
        return Some(format!("it must name a parameter of type choice; \"{name}\" has another type"));
    }
    if let Some(unknown) = condition.choices.iter().find(|c| options.iter().all(|(id, _)| id != *c)) {
        let known: Vec<_> = options.iter().map(|(id, _)| format!("\"{id}\"")).collect();
        return Some(format!("\"{unknown}\" is not a choice of {name}, which has {}", known.join(", ")));
    }
    let mut here = other;
    for _ in parameters {
        let next = here.used_when?;
        if next.parameter == parameter.name {
            return Some(format!("it must not depend on {}, which depends on {}", here.name, parameter.name));
        }
        here = parameters.iter().find(|p| p.name == next.parameter)?;
    }
    None
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::{
        optics::{Frame, colour::Encoding},
        parameter::{BASE_COLOUR, ParameterKind, Value},
        reflection::ModelEntry,
        registry::Registry,
    };

    /// Directions above the surface, spread over the hemisphere.
    fn directions() -> Vec<Vec3> {
        (0..9)
            .map(|i| {
                let (z, angle) = (0.08 + 0.11 * i as f32, 2.4 * i as f32);
                Vec3::new(angle.cos(), angle.sin(), 0.0) * (1.0 - z * z).sqrt() + Vec3::Z * z
            })
            .collect()
    }

    /// The bits of the response for many pairs of directions.
    fn responses(model: &ModelEntry, values: &Values) -> Vec<u32> {
        let surface = (model.instantiate)(values, Encoding::Srgb);
        let directions = directions();
        let mut out = Vec::new();
        for l in &directions {
            for v in &directions {
                let terms = surface.response(*l, *v, &Frame::LOCAL);
                let parts = terms.each();
                out.extend(parts.iter().flat_map(|t| t.to_array()).map(f32::to_bits));
            }
        }
        // What is behind the surface.
        for l in &directions {
            let terms = surface.response(-*l, directions[0], &Frame::LOCAL);
            out.extend(terms.transmitted.to_array().map(f32::to_bits));
        }
        let inside = surface.interior().map(|inside| format!("{inside:?}"));
        out.extend(inside.into_iter().flat_map(String::into_bytes).map(u32::from));
        out
    }

    /// Legal values that differ from the given one.
    fn others(p: &Parameter, now: &Value) -> Vec<Value> {
        let whole = p.kind.limits().is_some_and(|range| range.whole);
        let candidates = match &p.kind {
            ParameterKind::Colour(_) => vec![Value::Colour([200, 120, 40]), Value::Colour([40, 90, 230])],
            kind => match kind.limits() {
                None => kind.ends(),
                Some(range) if whole => {
                    [range.min + 1.0, range.slider_max].map(|v| kind.of_numbers([v; 3])).to_vec()
                }
                Some(range) => [[0.2, 0.15, 0.1], [0.5; 3], [0.8, 0.4, 0.2]]
                    .map(|t| kind.of_numbers(t.map(|t| range.min + t * (range.max - range.min))))
                    .to_vec(),
            },
        };
        candidates.into_iter().filter(|v| v != now && p.allows(v)).collect()
    }

    /// The model with its defaults, and with each choice and each pair of choices that is cheap enough.
    fn settings(model: &ModelEntry) -> Vec<Values> {
        let choices: Vec<(&Parameter, &str)> = model
            .parameters
            .iter()
            .flat_map(|p| p.kind.options().iter().map(move |(id, _)| (p, *id)))
            .collect();
        let mut all = vec![Values::default()];
        for (i, (p, a)) in choices.iter().enumerate() {
            let mut one = Values::default();
            one.set(p.name, Value::Choice((*a).into()));
            all.push(one.clone());
            for (q, b) in &choices[i + 1..] {
                // The compensation of multiple scattering is integrated again for every value.
                if q.name != p.name && q.name != "multiple_scattering" {
                    let mut two = one.clone();
                    two.set(q.name, Value::Choice((*b).into()));
                    all.push(two);
                }
            }
        }
        all
    }

    /// Values in the middle of their ranges, where the defaults switch parts of a model off.
    fn mixed(model: &ModelEntry, choices: &Values) -> Values {
        let mut values = choices.clone();
        for p in model.parameters {
            let middle = match (&p.kind, p.kind.limits()) {
                (ParameterKind::Colour(_), _) => Value::Colour([180, 90, 60]),
                (kind, Some(range)) if range.whole => {
                    kind.of_numbers([(0.25 * (range.min + range.slider_max)).trunc(); 3])
                }
                (kind, Some(range)) => kind.of_numbers([range.min + 0.4 * (range.max - range.min); 3]),
                (_, None) => continue,
            };
            if p.allows(&middle) {
                values.set(p.name, middle);
            }
        }
        values
    }

    #[test]
    fn what_is_not_used_changes_nothing_and_what_is_used_does() {
        for model in Registry::builtin().models() {
            for chosen in settings(model) {
                let bases = [mixed(model, &chosen), chosen].map(|values| {
                    let response = responses(model, &values);
                    (values, response)
                });
                // There is no other file.
                for p in model.parameters.iter().filter(|p| p.kind.format().is_none()) {
                    let changes = bases.iter().any(|(values, before)| {
                        others(p, &values.get(p)).into_iter().any(|other| {
                            let mut changed = values.clone();
                            changed.set(p.name, other);
                            responses(model, &changed) != *before
                        })
                    });
                    let (values, _) = &bases[1];
                    let why = unused(model.parameters, p, values);
                    assert_ne!(
                        why.is_some(),
                        changes,
                        "{}: {} under {values:?}: {why:?}",
                        model.declaration.id,
                        p.name
                    );
                }
            }
        }
    }

    #[test]
    fn reasons_name_what_would_use_it() {
        let registry = Registry::builtin();
        let Some(model) = registry.model("microfacet") else { panic!("built in") };
        let mut values = Values::default();
        let reason = |name: &str, values: &Values| {
            model.parameter(name).and_then(|p| unused(model.parameters, p, values)).unwrap_or_default()
        };
        assert_eq!(reason("gamma", &values), "Not used with GGX: only GTR has γ");
        let extinction = "Not used with “Dielectric, exact”: only Schlick and “Conductor, exact” have k";
        assert_eq!(reason("extinction", &values), extinction);
        assert_eq!(reason("base_colour", &values), "");
        values.set("fresnel", Value::Choice("none".into()));
        for name in ["ior", "diffuse", "base_colour"] {
            assert_eq!(reason(name, &values), "Not used while the Fresnel term is “None (F = 1)”", "{name}");
        }
        values.set("distribution", Value::Choice("gtr".into()));
        assert_eq!(reason("gamma", &values), "");
    }

    #[test]
    fn conditions_that_cannot_hold_are_found() {
        let choice = |name: &'static str| Parameter::choice(name, &[("a", "A"), ("b", "B")], 0);
        let problem_of = |condition: (&'static str, &'static [&'static str])| {
            let list = [choice("one"), choice("two").used_when(condition.0, condition.1), BASE_COLOUR];
            problem(&list, &list[1]).unwrap_or_default()
        };
        let flag = [Parameter::flag("lit", false).label("lit"), BASE_COLOUR.used_when("lit", &["true"])];
        let reason = |on| {
            unused(&flag, &flag[1], &Values([("lit".into(), Value::flag(on))].into())).unwrap_or_default()
        };
        assert_eq!((reason(true).as_str(), reason(false).as_str()), ("", "Not used while “lit” is no"));
        assert_eq!(problem_of(("one", &["a"])), "");
        assert!(problem_of(("three", &["a"])).contains("there is no \"three\""));
        assert!(problem_of(("base_colour", &["a"])).contains("has another type"));
        assert!(problem_of(("one", &["c"])).contains("\"c\" is not a choice of one, which has \"a\", \"b\""));
        assert!(problem_of(("two", &["a"])).contains("must not depend on two"));
        let circle = [choice("one").used_when("two", &["a"]), choice("two").used_when("one", &["a"])];
        assert!(problem(&circle, &circle[0]).is_some_and(|p| p.contains("must not depend on two")));
        assert_eq!(unused(&circle, &circle[0], &Values::default()), None, "and it ends");
    }
}
