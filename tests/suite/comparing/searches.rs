//! What the searches of matching find. Beside the other tests of [`matching`](lights_camera_models::matching), which are
//! built without optimisation, these would take minutes.

use lights_camera_models::{
    matching::{What, each, parameters},
    parameter::Value,
    progress::Progress,
    registry::Registry,
    scene::Scene,
    testing::shared::{PHONG, matched, two_views as scene},
};

fn number(value: f32) -> Value {
    Value::Number(value)
}

#[test]
fn a_model_matched_with_itself_finds_its_own_values() {
    for what in [What::Lobe, What::Picture] {
        let scene =
            scene(("phong", &PHONG), ("phong", &[("k_d", number(0.9)), ("alpha", Value::Integer(3))]));
        // The variant inherits the other two: if free, they keep their values.
        let all = matched(&scene, what, &["k_a", "k_d", "k_s", "alpha"]).expect("a match");
        assert_eq!(all.values, [PHONG[1].clone(), PHONG[3].clone()], "{what:?} {all:?}");
        assert_eq!(all.kept, ["k_a", "k_s"]);
        assert!(all.after < 1e-6 && all.before > 0.01, "{what:?} {all:?}");
        // The wrong twin: with a fixed parameter at another value, an error remains.
        let some = matched(&scene, what, &["alpha"]).expect("a match");
        assert!(some.after > 0.01 && some.after < some.before, "{what:?} {some:?}");
        // Where both are equal, nothing changes.
        let mut same = scene.clone();
        same.variants[0].material = Default::default();
        let none = matched(&same, what, &["k_a", "k_d", "k_s", "alpha"]).expect("a match");
        assert_eq!((none.values, none.before, none.after), (Vec::new(), 0.0, 0.0), "{what:?}");
        assert_eq!(none.kept, ["k_a", "k_d", "k_s", "alpha"]);
    }
}

#[test]
fn other_models_find_their_own_values_too() {
    let cases: [(&str, &[(&'static str, Value)], &[&str]); 5] = [
        (
            "ward",
            &[
                ("k_s", Value::Number(0.15)),
                ("alpha_x", Value::Number(0.05)),
                ("alpha_y", Value::Number(0.4)),
            ],
            &["k_s", "alpha_x", "alpha_y"],
        ),
        (
            "metallic_roughness",
            &[("roughness", Value::Number(0.35)), ("metallic", Value::Number(0.8))],
            &["roughness", "metallic"],
        ),
        ("oren_nayar", &[("sigma", Value::Number(31.0))], &["sigma"]),
        (
            "ashikhmin_shirley",
            &[
                ("exponent_u", Value::Integer(400)),
                ("exponent_v", Value::Integer(7)),
                ("k_s", Value::Number(0.2)),
            ],
            &["exponent_u", "exponent_v", "k_s"],
        ),
        (
            "phong",
            &[("base_colour", Value::Colour([200, 90, 30])), ("k_s", Value::Number(0.1))],
            &["base_colour", "k_s", "alpha"],
        ),
    ];
    for (id, values, free) in cases {
        let scene = scene((id, values), (id, &[]));
        // Inherited values would already be equal.
        let mut scene = Scene { objects: scene.objects, ..scene };
        let registry = Registry::builtin();
        for (name, _) in values {
            let parameter = registry.material_parameter(name).expect("declared");
            scene.variants[0].material.set(*name, parameter.default_value());
        }
        let found = matched(&scene, What::Lobe, free).expect("a match");
        for (name, value) in values {
            let own = found.values.iter().find(|(n, _)| n == name).map(|(_, value)| value.clone());
            let parameter = registry.material_parameter(name).expect("declared");
            let expected = Some(value.clone()).filter(|v| *v != parameter.default_value());
            assert_eq!(own, expected, "{id} {name}: {found:?}");
        }
        assert!(found.after < 2e-4 * found.before && found.before > 0.003, "{id}: {found:?}");
    }
}

#[test]
fn more_free_parameters_do_not_end_worse() {
    let scene = scene(("lambert", &[("base_colour", Value::Colour([200; 3]))]), ("disney", &[]));
    let after = |names: &[&str]| matched(&scene, What::Picture, names).expect("a match").after;
    let alone = after(&["roughness"]);
    let together = after(&["roughness", "metallic"]);
    assert!(together <= 1.01 * alone, "together {together}, roughness alone {alone}");
}

/// A Disney highlight that is narrow and stretched: the descent with all numbers free ends beside it.
#[test]
fn all_numbers_free_end_as_near_as_those_that_differ() {
    let metal = [("roughness", number(0.09)), ("anisotropic", number(0.97)), ("metallic", number(0.91))];
    let plain = [("roughness", number(0.5)), ("anisotropic", number(0.0)), ("metallic", number(0.0))];
    let scene = Scene { shading_model: "phong".to_owned(), ..scene(("disney", &metal), ("disney", &plain)) };
    let registry = Registry::builtin();
    let all: Vec<_> =
        parameters(&scene, 1, &registry).into_iter().map(|(parameter, _)| parameter.name).collect();
    let numbers: Vec<_> = all.into_iter().filter(|name| *name != "base_colour").collect();
    let together = matched(&scene, What::Picture, &numbers).expect("a match");
    let some = matched(&scene, What::Picture, &["roughness", "anisotropic", "metallic"]).expect("a match");
    assert!(together.after <= some.after + 1e-5 * some.before, "{together:?}\n{some:?}");
    // The base is white, so its hue tints nothing.
    assert!(together.without_effect.contains(&"sheen_tint"), "{together:?}");
    assert!(together.without_effect.iter().all(|name| together.kept.contains(name)), "{together:?}");
}

/// OpenPBR's base takes the place of its coat, whose roughness shows only where there is a coat.
#[test]
fn a_coat_is_found_among_numbers_that_are_free() {
    let coated = [("coat_weight", number(0.8)), ("coat_roughness", number(0.2)), ("roughness", number(0.4))];
    let plain = [("coat_weight", number(0.0)), ("coat_roughness", number(0.0)), ("roughness", number(0.3))];
    let scene = scene(("openpbr", &coated), ("openpbr", &plain));
    let free = ["coat_weight", "coat_roughness", "roughness", "metallic", "specular_ior"];
    let together = matched(&scene, What::Lobe, &free).expect("a match");
    let some = matched(&scene, What::Lobe, &free[..3]).expect("a match");
    assert!(together.after <= some.after + 1e-5 * some.before, "{together:?}\n{some:?}");
    assert!(together.after < 1e-4 * together.before, "{together:?}");
}

#[test]
fn choices_are_tried_and_named() {
    let registry = Registry::builtin();
    let model = registry.model("microfacet").expect("built in");
    let default = model.parameter("distribution").expect("declared").default_value();
    let other = ["ggx", "beckmann"].map(|id| Value::Choice(id.into())).into_iter().find(|v| *v != default);
    let other = other.expect("one of them");
    let wanted = [("distribution", other.clone()), ("alpha_x", number(0.25)), ("alpha_y", number(0.25))];
    let scene = scene(("microfacet", &wanted), ("lambert", &[]));
    let ranking = each::match_each(&scene, [model], What::Lobe.into(), &registry, &Progress::NONE);
    let found = &ranking.matched[0].found;
    assert!(found.values.contains(&("distribution", other)), "{found:?}");
    assert!(found.after < 0.01 * found.before, "{found:?}");
}

#[test]
fn what_was_matched_before_the_user_cancelled_is_kept() {
    let registry = Registry::builtin();
    let scene = scene(("phong", &PHONG), ("phong", &[]));
    let models = ["lambert", "phong", "ward"].map(|id| registry.model(id).expect("built in"));
    let second = std::cell::Cell::new(false);
    let tell = |_: f32, step: &str| second.set(second.get() || step.starts_with("Phong"));
    let progress = Progress { tell: &tell, cancelled: &|| second.get() };
    let ranking = each::match_each(&scene, models, What::Lobe.into(), &registry, &progress);
    assert_eq!(ranking.matched.iter().map(|matched| matched.model).collect::<Vec<_>>(), ["lambert"]);
    assert_eq!(ranking.unfinished, ["phong", "ward"]);
    let whole = each::match_each(&scene, models, What::Lobe.into(), &registry, &Progress::NONE);
    assert!(whole.unfinished.is_empty() && whole.matched[0].model == "phong", "{whole:?}");
}

#[test]
fn two_searches_find_the_same_to_the_bit() {
    let scene = scene(("ward", &[("alpha_x", number(0.1))]), ("blinn_phong", &[]));
    let [first, second] =
        [0, 1].map(|_| matched(&scene, What::Lobe, &["k_d", "k_s", "alpha"]).expect("a match"));
    assert_eq!(first, second);
    assert!(first.evaluations > 100 && first.after < first.before, "{first:?}");
}
