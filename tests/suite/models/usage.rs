//! Parameters not used by the present choices: their controls, declarations and lists.

use std::path::Path;

use bevy_egui::egui::{PointerButton, accesskit::Role};
use lights_camera_models::{
    custom,
    document::Edit,
    panel::{caption::caption_text, state::Action},
    parameter::{UsedWhen, Value},
    registry::Registry,
    scene::Part,
};

use crate::{helpers::support::lcm, window::panels::Bench};

fn choose(bench: &mut Bench, name: &'static str, choice: &'static str) {
    bench.apply(Action::Edit(Edit::material(Part::Object(0), name, Value::Choice(choice.into()))));
}

#[test]
fn a_knob_without_effect_is_disabled_and_says_why() {
    let mut bench = Bench::with_model("microfacet");
    let gamma = bench.field("exponent of GTR");
    assert!(gamma.disabled, "the distribution is GGX");
    bench.hover(gamma.rect.center());
    assert!(bench.says("Not used with GGX: only GTR has γ"));
    let value = bench.session.document.objects[0].material.clone();
    bench.click_at(gamma.rect.center(), PointerButton::Primary);
    assert_eq!(bench.session.document.objects[0].material, value);
    assert!(!caption_text(&bench.session, &bench.registry).contains('γ'), "nor does the caption show it");
    choose(&mut bench, "distribution", "gtr");
    assert!(!bench.field("exponent of GTR").disabled);
    assert!(caption_text(&bench.session, &bench.registry).contains("γ 2"));
    // A chain: without a Fresnel term there is no diffuse base, and without the base no colour.
    choose(&mut bench, "fresnel", "none");
    assert!(bench.field("base colour in hexadecimal").disabled);
    let base = bench.tree.iter().find(|s| s.role == Role::ComboBox && s.label.starts_with("diffuse base"));
    assert!(base.is_some_and(|s| s.disabled));
}

#[test]
fn the_list_of_models_says_when_a_parameter_is_used() {
    let run = lcm(&["models"], "");
    assert!(
        run.out.contains("gamma (exponent of GTR): between 1 and 10, default 2; used with distribution gtr")
    );
    let run = lcm(&["models", "--json"], "");
    let models: serde_json::Value = serde_json::from_str(&run.out).expect("JSON");
    let parameter = |id: &str, name: &str| -> serde_json::Value {
        let model = models.as_array().and_then(|all| all.iter().find(|m| m["id"] == id)).expect("listed");
        let all = model["parameters"].as_array().expect("a list");
        all.iter().find(|p| p["name"] == name).expect("listed").clone()
    };
    assert_eq!(
        parameter("microfacet", "extinction")["used_when"],
        serde_json::json!({ "fresnel": ["schlick", "conductor"] })
    );
    assert!(parameter("cook_torrance", "extinction")["used_when"].is_null());
}

/// A model with a parameter used by one of two forms.
fn forms(used_when: &str) -> String {
    format!(
        "/* lcm {{ \"parameters\": [\n\
         {{ \"name\": \"form\", \"choices\": {{ \"plain\": \"Plain\", \"soft\": \"Soft\" }} }},\n\
         {{ \"name\": \"softness\", \"used_when\": {used_when} }}, \"k_d\", \"gamma\", \"base_colour\" ] }} */\n\
         fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {{\n\
         return Terms(vec3(0.0), vec3(max(dot(frame.n, l), 0.0)), vec3(0.0));\n}}\n"
    )
}

fn read(text: &str) -> Result<custom::CustomModel, String> {
    custom::read(Path::new("forms.wgsl"), text, &Registry::builtin())
        .map_err(|all| all.iter().map(|p| format!("{p}\n")).collect())
}

#[test]
fn a_model_from_a_file_declares_it_too() {
    for declared in ["{ \"form\": [\"soft\"] }", "{ \"form\": \"soft\" }"] {
        let model = read(&forms(declared)).unwrap_or_else(|e| panic!("{e}"));
        let softness = model.entry.parameter("softness").expect("declared");
        assert_eq!(softness.used_when, Some(UsedWhen { parameter: "form", choices: &["soft"] }));
        let shared = model.entry.parameter("gamma").expect("declared");
        assert_eq!(shared.used_when, None, "a condition of the model that it is from does not come along");
        let mut registry = Registry::builtin();
        registry.put_custom_model(model);
        let mut bench = Bench::with_registry(
            lights_camera_models::panel::state::Session::new(lights_camera_models::scene::Scene {
                reflection_model: "forms".to_owned(),
                ..Default::default()
            }),
            registry,
        );
        assert!(bench.field("softness").disabled);
        choose(&mut bench, "form", "soft");
        assert!(!bench.field("softness").disabled);
    }
}

#[test]
fn a_condition_that_cannot_hold_is_reported_where_it_stands() {
    for (declared, expected) in [
        ("\"soft\"", "3:36: parameters[1].used_when is \"soft\", but it must name one other parameter"),
        (
            "{ \"from\": [\"soft\"] }",
            "used_when is { \"from\": [\"soft\"] }, but it must name a parameter of this model; there is no \"from\"",
        ),
        ("{ \"k_d\": [\"soft\"] }", "it must name a parameter of type choice; \"k_d\" has another type"),
        ("{ \"form\": [\"sfot\"] }", "\"sfot\" is not a choice of form, which has \"plain\", \"soft\""),
        ("{ \"form\": [] }", "it must name one other parameter"),
    ] {
        let said = read(&forms(declared)).err().unwrap_or_default();
        assert!(said.contains(expected), "{declared}:\n{said}");
        assert!(said.contains("3:36"), "{said}");
    }
}

#[test]
fn a_copy_of_a_model_has_its_conditions() {
    let registry = Registry::builtin();
    let model = registry.model("microfacet").expect("built in");
    let text = custom::duplicate(model, registry.sources(), "microfacet_copy", "Microfacet copy")
        .expect("can be duplicated");
    assert!(text.contains("\"used_when\": { \"distribution\": [\"gtr\"] }"), "{text}");
    let copy = custom::read(Path::new("microfacet_copy.wgsl"), &text, &registry).expect("can be read");
    for p in model.parameters {
        assert_eq!(copy.entry.parameter(p.name).and_then(|c| c.used_when), p.used_when, "{}", p.name);
    }
}
