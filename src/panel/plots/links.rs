//! The curves that a symbol stands for: `D` for that of the distribution, `α` for one whose shape it changes.

use super::{Entry, Key, Recipe, Request};
use crate::{
    curves::{Detail, Kind, Setup},
    panel::{
        linked::{Domain, lit_in},
        maths::{definition, same_symbol},
        prelude::*,
        state::Slot,
    },
    parameter::{Parameter, Value},
    progress::Progress,
    reflection::ModelEntry,
};

/// True if a symbol changes a curve: calculated once for each.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Influence {
    of: (Key, Setup, &'static str),
    changes: bool,
}

/// The symbols of a quantity in the equation of a model. A lobe is the answer of the whole model to light.
pub(super) fn symbols(model: &ModelEntry, kind: Kind) -> &'static [&'static str] {
    (kind.declaration().symbols)(definition(model.declaration.equation, "I").is_some())
}

/// The symbols that a curve of the list stands for, if it is of the model whose equation is shown.
pub(super) fn of_slot(request: &Request, slot: Slot) -> &'static [&'static str] {
    let model = |slot: Slot| match &request.entries.iter().find(|entry| entry.slot == slot)?.recipe {
        Recipe::Model(model, ..) => Some(model),
        _ => None,
    };
    match (model(Slot::Live), model(slot)) {
        (Some(live), Some(model)) if live.declaration.id == model.declaration.id => {
            symbols(model, request.setup.kind)
        }
        _ => &[],
    }
}

/// True if the curve of the selected object is what a symbol that lights stands for, or if the parameter with that symbol
/// changes its shape.
pub(super) fn is_live_lit(ctx: &Context, request: &Request, known: &mut Vec<Influence>) -> bool {
    let lit = lit_in(ctx, Domain::Surface);
    let live = request.entries.iter().find(|entry| entry.slot == Slot::Live);
    let (Some(entry), false) = (live, lit.is_empty()) else { return false };
    let Recipe::Model(model, ..) = &entry.recipe else { return false };
    let has = |symbol: &str| lit.iter().any(|lit| same_symbol(lit, symbol));
    if symbols(model, request.setup.kind).iter().any(|symbol| has(symbol)) {
        return true;
    }
    let parameter = model.parameters.iter().find(|parameter| has(parameter.symbol));
    parameter.is_some_and(|parameter| {
        let setup = tried(request);
        let of = (entry.key.clone(), setup, parameter.name);
        if let Some(known) = known.iter().find(|known| known.of == of) {
            return known.changes;
        }
        let changes = changes(entry, &setup, parameter);
        // Of other values they are not asked for again.
        known.retain(|known| known.of.0 == of.0 && known.of.1 == of.1);
        known.push(Influence { of, changes });
        changes
    })
}

/// The curve that is calculated to find out: for integrals and pictures, what they are made of.
fn tried(request: &Request) -> Setup {
    let setup = request.calculated();
    match setup.kind.declaration().tried {
        Some((kind, theta_i)) => Setup { kind, theta_i, ..setup },
        None => setup,
    }
}

/// True if a curve is another one with another value of a parameter.
fn changes(entry: &Entry, setup: &Setup, parameter: &'static Parameter) -> bool {
    let Recipe::Model(model, values, encoding) = &entry.recipe else { return false };
    let Some(other) = other(parameter, &values.get(parameter)) else { return false };
    let mut changed = values.clone();
    changed.set(parameter.name, other);
    let points = |values| {
        let recipe = Recipe::Model(model.clone(), values, *encoding);
        let drawn = recipe.draw(setup, Detail::Coarse, None, &Progress::NONE).ok()?;
        let bits = |point: &crate::curves::Point| point.rgb.to_array().map(f32::to_bits);
        match drawn {
            super::Drawn::Curve(curve) => Some(curve.points.iter().map(bits).collect::<Vec<_>>()),
            super::Drawn::Slice(_) => None,
        }
    };
    points(values.clone()) != points(changed)
}

/// Another legal value, far enough that it matters.
fn other(parameter: &Parameter, value: &Value) -> Option<Value> {
    parameter.kind.others(value).into_iter().find(|other| other != value && parameter.allows(other))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        panel::state::{Action, PlotCommand, Session},
        registry::Registry,
        scene::Scene,
    };

    fn request(model: &str, kind: Kind) -> Request {
        let registry = Registry::builtin();
        let scene = Scene { reflection_model: model.to_owned(), ..Scene::default() };
        let mut session = Session::new(scene);
        let _ = session.apply(Action::Plot(PlotCommand::Kind(kind)), &registry);
        Request::of(&session, &registry)
    }

    fn shapes(model: &str, kind: Kind) -> Vec<&'static str> {
        let request = request(model, kind);
        let entry = &request.entries[0];
        let Recipe::Model(model, ..) = &entry.recipe else { panic!("a model") };
        let changes = |p: &&'static Parameter| changes(entry, &tried(&request), p);
        model.parameters.iter().filter(changes).map(|p| p.name).collect()
    }

    #[test]
    fn a_curve_is_changed_by_its_own_parameters() {
        assert_eq!(shapes("phong", Kind::Polar), ["base_colour", "specular_colour", "k_d", "k_s", "alpha"]);
        assert_eq!(shapes("metallic_roughness", Kind::Distribution), ["roughness"]);
        assert_eq!(shapes("metallic_roughness", Kind::Fresnel), ["metallic", "reflectance"]);
        assert_eq!(shapes("metallic_roughness", Kind::Masking), ["roughness"]);
        assert_eq!(shapes("lambert", Kind::Albedo), ["base_colour"]);
        assert!(shapes("lambert", Kind::Slice).contains(&"base_colour"));
    }

    #[test]
    fn every_parameter_has_another_value() {
        for model in Registry::builtin().models() {
            // Another file is the user's to choose.
            for parameter in model.parameters.iter().filter(|p| p.kind.format().is_none()) {
                let value = parameter.default_value();
                assert!(other(parameter, &value).is_some_and(|v| v != value), "{}", parameter.name);
            }
        }
    }

    #[test]
    fn quantities_have_the_symbols_of_the_equation() {
        let of = |model: &str, kind| of_slot(&request(model, kind), Slot::Live);
        assert_eq!(of("phong", Kind::Polar), ["I"]);
        assert_eq!(of("lambert", Kind::Response), ["I_d", "I_s"]);
        assert!(of("cook_torrance", Kind::Distribution).contains(&"D"));
        assert!(of_slot(&request("phong", Kind::Polar), Slot::Pin(3)).is_empty());
    }
}
