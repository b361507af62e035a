//! What of a material goes along when an object gets another model: values of parameters that the new model has under
//! another name, or on another scale, by [what they stand for](crate::parameter::meaning).
//!
//! Parameters of the same name keep their values, whatever they stand for. The exception are metals: one that is given by
//! n and k gets a base colour where the new model has a fraction of metal instead.

use glam::Vec3;

use super::{ModelEntry, cook_torrance::SPECULAR_WEIGHT, preset, usage::unused};
use crate::{
    optics::fresnel::normal_reflectance_rgb,
    parameter::{EXTINCTION, IOR, Meaning, Parameter, ParameterKind, Side, Value, Values, meaning},
};

/// A value that goes along.
#[derive(Clone, Debug, PartialEq)]
pub struct Carried {
    /// The parameters that it follows from: one, or those along and across the tangent.
    pub from: Vec<&'static Parameter>,
    /// The parameter of the new model.
    pub to: &'static Parameter,
    /// Its value.
    pub value: Value,
    /// True if the range of the new model does not reach the value that would correspond.
    pub limited: bool,
}

impl Carried {
    /// True if one of them alone would be another material, by [what they stand for](Meaning::with).
    #[must_use]
    pub fn belongs_with(&self, other: &Self) -> bool {
        self.to.stands_for.zip(other.to.stands_for).is_some_and(|(a, b)| a.belongs_with(b))
    }
}

/// What goes along, and what stays behind.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Journey {
    /// The values that go along.
    pub carried: Vec<Carried>,
    /// The parameters of the model that is left whose values, other than the defaults, the new one has no place for.
    pub left: Vec<&'static Parameter>,
}

/// The journey of a material to the model `to`. `from` are the models that it came through, the one that is left first:
/// of several values that stand for the same, that of the earliest counts. Values that are not in the material are
/// defaults, and do not go along; what it has under the new name stays. Only the base colour gives way to that of a metal,
/// if the material does not say yet how metallic it is.
///
/// ```
/// use lights_camera_models::{parameter::{Value, Values}, reflection::carry, registry::Registry};
/// let registry = Registry::builtin();
/// let [from, to] = ["metallic_roughness", "microfacet"].map(|id| registry.model(id).expect("built in"));
/// let mut material = Values::default();
/// material.set("roughness", Value::Number(0.5));
/// let journey = carry::journey(&[from], to, &material);
/// let carried: Vec<_> = journey.carried.iter().map(|one| (one.to.name, one.value.clone())).collect();
/// // α = r²: B. Burley (2012), Physically-Based Shading at Disney.
/// assert_eq!(carried, [("alpha_x", Value::Number(0.25)), ("alpha_y", Value::Number(0.25))]);
/// ```
#[must_use]
pub fn journey(from: &[&ModelEntry], to: &ModelEntry, material: &Values) -> Journey {
    let left_metal = from.first().and_then(|model| metal_in(model, material));
    let earlier_metal = || from.iter().skip(1).find_map(|model| metal_in(model, material));
    let of_metal = metal(|| left_metal.or_else(earlier_metal), to, material);
    let as_metal =
        |p: &'static Parameter| of_metal.iter().flatten().find(|one| one.to.name == p.name).cloned();
    let by_quantity = |p: &'static Parameter| {
        let meaning = p.stands_for.filter(|_| has_place(to, p, material))?;
        let (from, quantity) = from.iter().find_map(|model| quantity(model, meaning, material))?;
        // Codes of colours are no other numbers.
        let is_colour = |p: &Parameter| matches!(p.kind, ParameterKind::Colour(_));
        let same = from.iter().all(|q| is_colour(q) == is_colour(p));
        let from = Some(from).filter(|_| same)?;
        let wanted = meaning.value_of(quantity, &p.kind)?;
        let value = p.nearest(&wanted)?;
        Some(Carried { from, to: p, limited: value != wanted, value })
    };
    let carry = |p| as_metal(p).or_else(|| by_quantity(p));
    let carried: Vec<_> = to.parameters.iter().filter_map(carry).collect();
    // A metal that the new model has in its own way is not missed.
    let is_one_anyway = is_metal(to, material);
    let index = left_metal.map(|(index, _)| index);
    let says_metal =
        |p: &Parameter| stands_for(p, &meaning::METAL) || index.iter().flatten().any(|q| q.name == p.name);
    let stays = |p: &&'static Parameter| {
        let goes = || carried.iter().any(|one| one.from.iter().any(|q| q.name == p.name));
        let has_own = || {
            let alike = |q: &&Parameter| p.stands_for.is_some_and(|meaning| stands_for(q, meaning));
            to.parameters.iter().filter(alike).any(|q| material.0.contains_key(q.name))
        };
        let matters = material.get(p) != p.default_value();
        let is_metal_there = || is_one_anyway && says_metal(p);
        matters && to.parameter(p.name).is_none() && !goes() && !has_own() && !is_metal_there()
    };
    let left = from.first().into_iter().flat_map(|model| given(model, material)).filter(stays).collect();
    Journey { carried, left }
}

/// True if a parameter of the new model has an effect, and no value yet.
fn has_place(model: &ModelEntry, p: &Parameter, material: &Values) -> bool {
    !material.0.contains_key(p.name) && unused(model.parameters, p, material).is_none()
}

/// The parameters of a model that a material gives, and that have an effect.
fn given<'m>(model: &'m ModelEntry, material: &'m Values) -> impl Iterator<Item = &'static Parameter> + 'm {
    let is_given = |p: &&'static Parameter| {
        material.0.get(p.name).is_some_and(|value| p.allows(value))
            && unused(model.parameters, p, material).is_none()
    };
    model.parameters.iter().filter(is_given)
}

fn stands_for(p: &Parameter, meaning: &Meaning) -> bool {
    p.stands_for.is_some_and(|known| known.corresponds_to(meaning))
}

/// The parameters of a model for the fraction of metal, and for the base colour, which is that of the metal.
#[must_use]
pub fn metal_of(model: &ModelEntry) -> Option<[&'static Parameter; 2]> {
    let that = |meaning: &Meaning| model.parameters.iter().find(|p| stands_for(p, meaning));
    Some([that(&meaning::METAL)?, that(&meaning::COLOUR_OF_BASE)?])
}

/// The parameters of a model for n and k, by the names that measured materials have for them, too.
fn complex_index(model: &ModelEntry) -> Option<[&'static Parameter; 2]> {
    Some([model.parameter(IOR.name)?, model.parameter(EXTINCTION.name)?])
}

/// The parameters for n and k of a metal, and its reflectance at normal incidence.
type Metal = ([&'static Parameter; 2], Vec3);

/// The parameters by which a material is a metal with n and k in a model, and its reflectance at normal incidence.
///
/// Models that mix it with a matte body have a colour for each, while those with a fraction of metal have one for both. So
/// the larger part counts, as a whole: half of the surface is enough, which is the default, since less would tint the
/// body with the colour of the metal.
fn metal_in(model: &ModelEntry, material: &Values) -> Option<Metal> {
    let [n, k] = complex_index(model)?;
    let (Value::Triple(index), Value::Triple(extinction)) = (material.get(n), material.get(k)) else {
        return None;
    };
    let is_given = given(model, material).any(|p| p.name == k.name);
    let share = model.parameter(SPECULAR_WEIGHT.name).map_or(1.0, |p| material.number(p));
    // Coloured dielectrics have k below a thousandth, metals above 1.
    let absorbs = extinction.iter().any(|k| *k >= 0.1);
    let is_metal = is_given && share >= 0.5 && absorbs;
    is_metal.then(|| ([n, k], normal_reflectance_rgb(index.into(), extinction.into())))
}

/// True if a material is a metal by the parameters of a model, at least in part.
fn is_metal(model: &ModelEntry, material: &Values) -> bool {
    let has_some = |p: &Parameter| {
        unused(model.parameters, p, material).is_none() && material.get(p) != p.default_value()
    };
    metal_in(model, material).is_some() || metal_of(model).is_some_and(|[fraction, _]| has_some(fraction))
}

/// A metal with n and k in a model that has a fraction of metal instead: all of it, in the colour of the reflectance at
/// normal incidence (A. Fresnel 1823), encoded as that of measured metals is. `found` is the metal in the models that the
/// material came through.
///
/// There is no way back from a colour to n and k. Each reflectance has many pairs, and O. Gulbrandsen (2014), *Artist
/// Friendly Metallic Fresnel*, chooses one by the colour at the edge, which the materials that would be left do not have;
/// whoever came from n and k gets their own back.
fn metal(found: impl FnOnce() -> Option<Metal>, to: &ModelEntry, material: &Values) -> Option<[Carried; 2]> {
    let [fraction, colour] = metal_of(to).filter(|_| complex_index(to).is_none())?;
    let has_effect = unused(to.parameters, colour, material).is_none();
    if !has_effect || !has_place(to, fraction, material) {
        return None;
    }
    let (index, f0) = found()?;
    let whole = fraction.stands_for?.value_of([1.0; 3], &fraction.kind)?;
    let carried = |to: &'static Parameter, value: Value| {
        to.allows(&value).then(|| Carried { from: index.to_vec(), to, value, limited: false })
    };
    Some([carried(fraction, whole)?, carried(colour, preset::colour(f0))?])
}

/// The quantity of a meaning that a material gives by the parameters of a model, and these parameters.
fn quantity(
    model: &ModelEntry,
    meaning: &Meaning,
    material: &Values,
) -> Option<(Vec<&'static Parameter>, [f64; 3])> {
    let declared = |side: Side| {
        let stands = |known: &&Meaning| known.corresponds_to(meaning) && known.side == side;
        model.parameters.iter().find_map(|p| Some((p, p.stands_for.filter(stands)?)))
    };
    let holds = |known: &Meaning| {
        let other = known.without.and_then(|name| model.parameter(name));
        other.is_none_or(|p| match material.get(p) {
            Value::Number(v) => v == 0.0,
            Value::Triple(v) => v == [0.0; 3],
            _ => true,
        })
    };
    let is_given = |p: &Parameter| given(model, material).any(|q| q.name == p.name);
    let value = |(p, known): (&'static Parameter, &Meaning)| known.quantity_of(&material.get(p));
    let one = |side: Side| {
        let (p, known) = declared(side).filter(|(p, known)| is_given(p) && holds(known))?;
        Some((vec![p], value((p, known))?))
    };
    let both = || {
        // An ellipse is as large as the circle whose radius is the geometric mean.
        let (x, y) = declared(Side::Along).zip(declared(Side::Across))?;
        let from: Vec<_> = [x.0, y.0].into_iter().filter(|p| is_given(p)).collect();
        let (a, b) = value(x).zip(value(y)).filter(|_| !from.is_empty())?;
        Some((from, std::array::from_fn(|i| (a[i] * b[i]).sqrt())))
    };
    match meaning.side {
        Side::Both => one(Side::Both).or_else(both),
        side => one(side).or_else(|| one(Side::Both)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{optics::colour::Encoding, reflection::Factor, registry::Registry};

    fn material(values: &[(&'static str, Value)]) -> Values {
        Values(values.iter().map(|(name, value)| ((*name).into(), value.clone())).collect())
    }

    /// The values that go from one model to another.
    fn goes(from: &str, to: &str, values: &[(&'static str, Value)]) -> Vec<(&'static str, Value)> {
        let registry = Registry::builtin();
        let [from, to] = [from, to].map(|id| registry.model(id).expect("built in"));
        let journey = journey(&[from], to, &material(values));
        journey.carried.into_iter().map(|one| (one.to.name, one.value)).collect()
    }

    fn number(v: f32) -> Value {
        Value::Number(v)
    }

    #[test]
    fn the_highlight_keeps_its_width() {
        let alpha = |a: f32| vec![("alpha_x", number(a)), ("alpha_y", number(a))];
        assert_eq!(goes("disney", "ward", &[("roughness", number(0.5))]), alpha(0.25));
        let exponent = [("alpha", Value::Integer(30))];
        assert_eq!(goes("blinn_phong", "ward", &exponent), alpha(0.25));
        assert_eq!(goes("blinn_phong", "disney", &exponent), [("roughness", number(0.5))]);
        // Phong's counts four times as much.
        assert_eq!(
            goes("phong", "disney", &[("alpha", Value::Integer(120))]),
            goes("blinn_phong", "disney", &[("alpha", Value::Integer(480))])
        );
        assert_eq!(goes("ward", "blinn_phong", &alpha(0.25)), [("alpha", Value::Integer(30))]);
        assert_eq!(
            goes("ward", "cook_torrance", &[("alpha_x", number(0.1)), ("alpha_y", number(0.4))]),
            [("slope", number(0.2))]
        );
        assert_eq!(goes("cook_torrance", "microfacet", &[("slope", number(0.2))]), alpha(0.2));
        assert_eq!(
            goes("ashikhmin_shirley", "ward", &[("exponent_u", Value::Integer(30))]),
            [("alpha_x", number(0.25))]
        );
        assert_eq!(goes("eon", "ward", &[("roughness", number(0.5))]), [], "a matte one has no highlight");
        assert_eq!(
            goes("eon", "openpbr", &[("roughness", number(0.5))]),
            [("base_diffuse_roughness", number(0.5))]
        );
    }

    #[test]
    fn reflectance_coat_sheen_and_glass_go_along() {
        let green = [("reflectance", number(0.5))];
        assert_eq!(goes("metallic_roughness", "disney", &green), [("specular", number(0.5))]);
        let index = goes("metallic_roughness", "openpbr", &green);
        assert!(
            matches!(index[..], [("specular_ior", Value::Number(n))] if (n - 1.5).abs() < 1e-6),
            "{index:?}"
        );
        let glass = [("ior", Value::Triple([1.3, 1.4, 1.6]))];
        assert_eq!(goes("cook_torrance", "rough_dielectric", &glass), [("refractive_index", number(1.4))]);
        let gold = [glass[0].clone(), ("extinction", Value::Triple([3.9, 2.4, 1.9]))];
        assert_eq!(goes("cook_torrance", "rough_dielectric", &gold), [], "a metal has no such index");
        assert_eq!(
            goes("disney", "openpbr", &[("clearcoat", number(0.5)), ("sheen", number(0.25))]),
            [("coat_weight", number(0.125)), ("fuzz_weight", number(0.25))]
        );
        let colour = Value::Colour([10, 200, 30]);
        assert_eq!(
            goes("glass", "openpbr", &[("transmittance_colour", colour.clone()), ("distance", number(2.0))]),
            [("transmission_colour", colour), ("transmission_depth", number(2.0))]
        );
    }

    /// Measured n and k of gold: P. B. Johnson, R. W. Christy (1972); and more.
    fn gold(more: &[(&'static str, Value)]) -> Vec<(&'static str, Value)> {
        let mut all = vec![
            ("ior", Value::Triple([0.188_36, 0.543_86, 1.331_85])),
            ("extinction", Value::Triple([3.4034, 2.2309, 1.8693])),
        ];
        all.extend_from_slice(more);
        all
    }

    #[test]
    fn a_metal_with_n_and_k_gets_a_base_colour() {
        // F_0 is 0.9420, 0.7044 and 0.4035, calculated by hand.
        let metal = [("base_colour", Value::Colour([248, 218, 170])), ("metallic", number(1.0))];
        let fresnel = |id: &'static str| ("fresnel", Value::Choice(id.into()));
        for to in ["disney", "openpbr", "metallic_roughness"] {
            let found = |from: &str, more: &[(&'static str, Value)]| goes(from, to, &gold(more));
            for from in ["cook_torrance", "torrance_sparrow"] {
                assert_eq!(found(from, &[]), metal, "{from} → {to}");
                assert_eq!(found(from, &[("base_colour", Value::Colour([255; 3]))]), metal, "{from} → {to}");
                assert_eq!(found(from, &[("specular_weight", number(1.0))]), metal, "{from} → {to}");
                // Most of the surface is a body, which has its own colour.
                assert_eq!(found(from, &[("specular_weight", number(0.4))]), [], "{from} → {to}");
                // The material says already how metallic it is.
                assert_eq!(found(from, &[("metallic", number(0.0))]), [], "{from} → {to}");
            }
            assert_eq!(found("microfacet", &[fresnel("conductor")]), metal, "{to}");
            assert_eq!(found("microfacet", &[fresnel("schlick")]), metal, "{to}");
            // k has no effect.
            assert_eq!(found("microfacet", &[fresnel("dielectric")]), [], "{to}");
        }
    }

    #[test]
    fn without_extinction_nothing_is_metal() {
        let clear = [("ior", Value::Triple([1.5; 3])), ("extinction", Value::Triple([0.0; 3]))];
        for from in ["cook_torrance", "torrance_sparrow"] {
            assert_eq!(goes(from, "disney", &clear), goes(from, "disney", &clear[..1]), "{from}");
            let names: Vec<_> = goes(from, "disney", &clear).into_iter().map(|(name, _)| name).collect();
            assert_eq!(names, ["specular"], "{from}");
        }
    }

    #[test]
    fn a_metal_is_missed_only_where_nothing_stands_for_it() {
        let registry = Registry::builtin();
        let model = |id: &str| registry.model(id).expect("built in");
        let left = |from: &str, to: &str, more: &[(&'static str, Value)]| {
            let journey = journey(&[model(from)], model(to), &material(&gold(more)));
            journey.left.iter().map(|p| p.name).collect::<Vec<_>>()
        };
        assert!(left("cook_torrance", "disney", &[]).is_empty());
        assert_eq!(left("cook_torrance", "lambert", &[]), ["ior", "extinction"]);
        assert_eq!(left("cook_torrance", "disney", &[("metallic", number(0.0))]), ["ior", "extinction"]);
        let metal = [("metallic", number(1.0))];
        assert!(left("cook_torrance", "disney", &metal).is_empty());
        assert!(left("disney", "cook_torrance", &metal).is_empty());
        assert_eq!(left("disney", "lambert", &metal), ["metallic"]);
    }

    #[test]
    fn a_metal_comes_from_further_back_and_as_a_whole() {
        let registry = Registry::builtin();
        let [lambert, cook_torrance, strauss] =
            ["lambert", "cook_torrance", "strauss"].map(|id| registry.model(id).expect("built in"));
        let carried = journey(&[lambert, cook_torrance], strauss, &material(&gold(&[]))).carried;
        let [colour, fraction] = &carried[..] else { panic!("{carried:?}") };
        assert_eq!((colour.to.name, fraction.to.name), ("base_colour", "metallic"));
        assert!(colour.belongs_with(fraction) && fraction.belongs_with(colour));
        let names = |one: &Carried| one.from.iter().map(|p| p.name).collect::<Vec<_>>();
        assert_eq!([colour, fraction].map(names), [["ior", "extinction"]; 2]);
    }

    #[test]
    fn other_meanings_may_belong_together() {
        const DYE: Meaning = Meaning::of("dye", "dye", "d", "A. Author (2026), A Title");
        const DEPTH: Meaning = Meaning::of("dye_depth", "depth of the dye", "t", DYE.source).with(&DYE);
        static PARAMETERS: [Parameter; 3] = [
            Parameter::number("dye", 0.0..=1.0, 0.0).stands_for(&DYE),
            Parameter::number("depth", 0.0..=1.0, 0.0).stands_for(&DEPTH),
            Parameter::number("metallic", 0.0..=1.0, 0.0).stands_for(&meaning::METAL),
        ];
        let [dye, depth, metal] = PARAMETERS.each_ref().map(|to| Carried {
            from: vec![to],
            to,
            value: number(1.0),
            limited: false,
        });
        assert!(dye.belongs_with(&depth) && depth.belongs_with(&dye));
        assert!(!dye.belongs_with(&metal) && !metal.belongs_with(&depth));
    }

    #[test]
    fn what_is_default_or_there_already_does_not_move() {
        assert_eq!(goes("disney", "ward", &[]), []);
        assert_eq!(goes("disney", "metallic_roughness", &[("roughness", number(0.2))]), []);
        let own = [("clearcoat", number(1.0)), ("coat_weight", number(0.9))];
        assert_eq!(goes("disney", "openpbr", &own), []);
        // A value outside the range is no value.
        assert_eq!(goes("disney", "ward", &[("roughness", number(7.0))]), []);
    }

    #[test]
    fn what_has_no_place_is_named_and_what_does_not_fit_is_limited() {
        let registry = Registry::builtin();
        let model = |id: &str| registry.model(id).expect("built in");
        let values = material(&[
            ("subsurface", number(1.0)),
            ("clearcoat", number(1.0)),
            // The default, which nobody misses.
            ("sheen", number(0.0)),
            ("base_colour", Value::Colour([1, 2, 3])),
        ]);
        let journey_to = |to: &str| journey(&[model("disney")], model(to), &values);
        let names = |to: &str| journey_to(to).left.iter().map(|p| p.name).collect::<Vec<_>>();
        assert_eq!(names("openpbr"), ["subsurface"]);
        assert_eq!(names("lambert"), ["subsurface", "clearcoat"]);
        let full = material(&[("coat_weight", number(1.0))]);
        let back = journey(&[model("openpbr")], model("disney"), &full).carried;
        assert!(matches!(&back[..], [one] if one.limited && one.value == number(1.0)), "{back:?}");
    }

    #[test]
    fn models_further_back_are_asked_in_their_order() {
        let registry = Registry::builtin();
        let [disney, lambert, openpbr, phong] =
            ["disney", "lambert", "openpbr", "phong"].map(|id| registry.model(id).expect("built in"));
        let values = material(&[("clearcoat", number(1.0)), ("roughness", number(0.5))]);
        let journey = |from: &[&ModelEntry], to| journey(from, to, &values).carried;
        assert_eq!(journey(&[lambert], openpbr), []);
        assert_eq!(journey(&[lambert, disney], openpbr), journey(&[disney], openpbr));
        assert!(!journey(&[lambert, disney], openpbr).is_empty());
        assert_eq!(journey(&[lambert, disney], phong)[0].value, Value::Integer(8), "n = (2/α² − 2)/4, 7.5");
    }

    /// The largest relative difference of the distributions of two models over the hemisphere.
    fn difference(a: (&str, &Values), b: (&str, &Values)) -> f32 {
        let registry = Registry::builtin();
        let [a, b] = [a, b]
            .map(|(id, values)| registry.model(id).expect("built in").instantiate(values, Encoding::Srgb));
        let angles = (0..90).map(|i| (i as f32).to_radians());
        let d = |h: Vec3| {
            let [a, b] = [&a, &b].map(|s| s.factor(Factor::Distribution { h }).expect("it has one").x);
            (a - b).abs() / a.max(b).max(1e-9)
        };
        angles.map(|t| d(Vec3::new(t.sin(), 0.0, t.cos()))).fold(0.0, f32::max)
    }

    #[test]
    fn the_curve_is_the_same_where_the_correspondence_is_exact() {
        for r in [0.1, 0.3, 0.5, 0.77, 1.0] {
            let rough = material(&[("roughness", number(r))]);
            let carried =
                |from, values: &[(&'static str, Value)]| material(&goes(from, "microfacet", values));
            let faceted = carried("metallic_roughness", &[("roughness", number(r))]);
            assert_eq!(difference(("metallic_roughness", &rough), ("microfacet", &faceted)), 0.0, "{r}");
            // The same number as α is another curve.
            let wrong = material(&[("alpha_x", number(r)), ("alpha_y", number(r))]);
            let other = difference(("metallic_roughness", &rough), ("microfacet", &wrong));
            assert!(r == 1.0 || other > 0.1, "{r}: {other}");
            // There and back.
            let registry = Registry::builtin();
            let [from, to] =
                ["microfacet", "metallic_roughness"].map(|id| registry.model(id).expect("built in"));
            let back = journey(&[from], to, &faceted).carried;
            assert!(matches!(back[0].value, Value::Number(v) if (v - r).abs() < 1e-6), "{back:?}");
        }
    }

    #[test]
    fn every_pair_of_models_gives_values_that_its_model_allows() {
        let registry = Registry::builtin();
        for from in registry.models() {
            let ends: Vec<Values> = (0..3)
                .map(|k| {
                    Values::each(from.parameters, |p| {
                        let ends = p.ends();
                        ends[k % ends.len()].clone()
                    })
                })
                .collect();
            for to in registry.models() {
                for values in &ends {
                    for one in journey(&[from], to, values).carried {
                        let said = format!("{} → {}: {one:?}", from.declaration.id, to.declaration.id);
                        assert!(one.to.allows(&one.value), "{said}");
                        assert!(to.parameter(one.to.name).is_some() && !one.from.is_empty(), "{said}");
                    }
                }
            }
        }
    }
}
