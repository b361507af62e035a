//! Named curves of custom models: albedos of built-in models that follow the parameters of the custom one.

use std::path::Path;

use glam::Vec3;
use lights_camera_models::{
    custom,
    optics::{Frame, albedo, colour::Encoding, geometry::direction},
    parameter::{Value, Values},
    registry::Registry,
    render::capture::evaluate::Evaluator,
    shader::check::ShaderProblem,
};

const DECLARED: &str = r#"
    "curves": {
        // A coat, and a rough metal below it.
        "coat": { "model": "microfacet", "alpha_x": "coat_alpha", "alpha_y": "coat_alpha", "fresnel": "dielectric", "ior": 1.5, "diffuse": "lambert" },
        "metal": { "model": "microfacet", "alpha_x": 0.8, "alpha_y": 0.8, "fresnel": "none", "diffuse": "none" },
        "tinted": { "model": "lambert", "base_colour": "tint" },
    },
    "parameters": [
        { "name": "coat_alpha", "min": 0, "max": 1, "default": 0.3 },
        { "name": "tint", "type": "colour", "default": [255, 128, 64] },
    ],
"#;

/// A model that returns its curves: at the view in the ambient and diffuse terms, the means in the specular
/// term.
fn text(declared: &str) -> String {
    format!(
        "/* lcm {{ {declared} }} */
fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {{
    let mu = dot(frame.n, v);
    let coat = curve_coat(mu);
    return Terms(vec3(curve_metal(mu).w, coat.x, coat.w), curve_tinted(mu).rgb,
        vec3(mean_coat().x, mean_metal().w, mean_tinted().z));
}}
"
    )
}

fn read(id: &str, text: &str) -> Result<Registry, Vec<ShaderProblem>> {
    let mut registry = Registry::builtin();
    let model = custom::read(&Path::new("somewhere").join(format!("{id}.wgsl")), text, &registry)?;
    registry.put_custom_model(model);
    Ok(registry)
}

/// The albedo of the microfacet model with these settings, by integration.
fn microfacet(settings: &[(&'static str, Value)], v: Vec3) -> f32 {
    let mut values = Values::default();
    for (name, value) in settings {
        values.set(*name, value.clone());
    }
    let surface =
        Registry::builtin().model("microfacet").expect("built in").instantiate(&values, Encoding::Srgb);
    albedo::directional(|l| surface.response(l, v, &Frame::LOCAL), v, &Frame::LOCAL).x as f32
}

fn settings(alpha: f32, fresnel: &'static str) -> Vec<(&'static str, Value)> {
    vec![
        ("alpha_x", Value::Number(alpha)),
        ("alpha_y", Value::Number(alpha)),
        ("fresnel", Value::Choice(fresnel.into())),
        ("ior", Value::Triple([1.5; 3])),
        ("diffuse", Value::Choice("none".into())),
    ]
}

#[test]
fn the_curves_of_a_custom_model_are_the_albedos_of_the_models_that_they_name() {
    let registry = read("layered", &text(DECLARED)).expect("valid");
    let model = registry.model("layered").expect("registered");
    let mut evaluator = Evaluator::new(registry.sources(), model).expect("software Vulkan is installed");
    for alpha in [0.3f32, 0.7] {
        let mut values = Values::default();
        values.set("coat_alpha", Value::Number(alpha));
        evaluator.set(&values, Encoding::Srgb);
        let surface = model.instantiate(&values, Encoding::Srgb);
        for degrees in [0.0, 40.0, 75.0] {
            let v = direction(degrees, 0.0);
            let found = surface.response(Vec3::Z, v, &Frame::LOCAL);
            let coat = microfacet(&settings(alpha, "dielectric"), v);
            let mut body = settings(alpha, "dielectric");
            body.push(("diffuse", Value::Choice("lambert".into())));
            let whole = microfacet(&body, v);
            let lobe = |alpha| microfacet(&settings(alpha, "none"), v);
            // Curves of 16 nodes.
            let near = |a: f32, b: f32| (a - b).abs() < 2e-3;
            assert!(near(found.ambient.x, lobe(0.8)), "{degrees}: {} {}", found.ambient.x, lobe(0.8));
            assert!(near(found.ambient.y, whole), "{degrees}: {} {whole}", found.ambient.y);
            assert!(near(found.ambient.z, coat), "{degrees}: {} {coat}", found.ambient.z);
            // The wrong twin: the default of the parameter instead of its value.
            let default = microfacet(&settings(0.3, "dielectric"), v);
            assert!(alpha < 0.5 || !near(found.ambient.z, default), "{degrees}: {default}");
            let tint = Encoding::Srgb.decode([255, 128, 64]);
            assert!((found.diffuse - tint).abs().max_element() < 1e-4, "{}", found.diffuse);
            assert!(near(found.specular.z, tint.z) && (0.3..1.0).contains(&found.specular.x));
            // The shader reads the same.
            let gpu = evaluator.evaluate(&[(Vec3::Z, v)]).expect("the GPU evaluates")[0];
            for (a, b) in
                [(gpu.ambient, found.ambient), (gpu.diffuse, found.diffuse), (gpu.specular, found.specular)]
            {
                assert!((a - b).abs().max_element() < 1e-4, "{a} {b}");
            }
        }
    }
}

#[test]
fn a_copy_of_a_model_with_curves_keeps_them() {
    let registry = read("layered", &text(DECLARED)).expect("valid");
    let model = registry.model("layered").expect("registered");
    let copy = custom::duplicate(model, registry.sources(), "other", "Other").expect("copied");
    assert!(copy.contains("\"alpha_x\": \"coat_alpha\""), "{copy}");
    let again = read("other", &copy).expect("valid");
    let ask = |registry: &Registry, id: &str| {
        let surface = registry.model(id).expect("registered").instantiate(&Values::default(), Encoding::Srgb);
        surface.response(Vec3::Z, direction(50.0, 0.0), &Frame::LOCAL)
    };
    assert_eq!(ask(&registry, "layered"), ask(&again, "other"));
}

#[test]
fn mistakes_in_curves_are_told_with_what_would_be_right() {
    let one = |curve: &str| {
        format!("\"curves\": {{ {curve} }}, \"parameters\": [{{ \"name\": \"mine\" }}, \"base_colour\"]")
    };
    let many: Vec<_> = (0..9).map(|i| format!("\"c{i}\": {{ \"model\": \"lambert\" }}")).collect();
    for (declared, expected) in [
        ("\"curves\": 3".to_owned(), "curves is 3, but it must be an object of curves: { \"coat\":"),
        (one("\"coat\": 1"), "but it must be an object of curves"),
        (one("\"coat\": {}"), "curves: \"coat\": it needs a \"model\""),
        (
            one("\"coat\": { \"model\": \"xm\" }"),
            "curves.coat.model is \"xm\", but the model of a curve must be",
        ),
        (one("\"coat\": { \"model\": \"microfaset\" }"), "did you mean \"microfacet\"?"),
        (
            one("\"Coat\": { \"model\": \"lambert\" }"),
            "curves: \"Coat\": a name in the shader must be lower-case",
        ),
        (
            one("\"a\": { \"model\": \"lambert\" }, \"a\": { \"model\": \"lambert\" }"),
            "curves: \"a\": is given twice",
        ),
        (one(&many.join(", ")), "curves: \"c8\": is one too many: at most 8 fit"),
        (
            one("\"coat\": { \"model\": \"microfacet\", \"alfa_x\": 0.3 }"),
            "\"alfa_x\" is not a parameter of microfacet; did you mean \"alpha_x\"?",
        ),
        (
            one("\"coat\": { \"model\": \"microfacet\", \"alpha_x\": \"base_colour\" }"),
            "curves: \"coat\": alpha_x is \"base_colour\", but it must be between 0.001 and 1, or one of the model's parameters \"mine\"",
        ),
        (
            one("\"coat\": { \"model\": \"microfacet\", \"alpha_x\": 7 }"),
            "alpha_x is 7, but it must be between 0.001 and 1, or one of the model's parameters \"mine\"",
        ),
        (
            one("\"coat\": { \"model\": \"microfacet\", \"alpha_x\": 0.1, \"alpha_x\": 0.2 }"),
            "curves: \"coat\": alpha_x is given twice",
        ),
        (
            one("\"coat\": { \"model\": \"microfacet\", \"model\": \"lambert\" }"),
            "curves: \"coat\": model is given twice",
        ),
        (
            format!("\"lobe\": \"openpbr\", {}", one("\"fuzz\": { \"model\": \"lambert\" }")),
            "curves: \"fuzz\": is the name of a curve of the \"lobe\" model; choose another name",
        ),
    ] {
        let problems = read("layered", &text(&declared)).expect_err(&declared);
        assert!(problems.iter().any(|p| p.to_string().contains(expected)), "{problems:?}\nnot: {expected}");
    }
}
