//! Models in single files: the contents of a file, messages about errors, and the picture.

use std::{path::Path, sync::atomic::AtomicBool};

use glam::Vec3;
use lights_camera_models::{
    custom::{self},
    library::assets::EXAMPLES,
    optics::{
        Frame, TermSelection,
        colour::{BACKGROUND, Encoding},
        lobes::{Lobe, Lobes},
    },
    parameter::{BASE_COLOUR, Parameter, ParameterKind, Value, Values, kind::integer::Integer, meaning},
    reference::{self, LightSamples},
    reflection::{
        Ambient, ModelEntry,
        laws::{self, Effort, Findings, RECIPROCITY_TOLERANCE, Random},
    },
    registry::{CustomModel, Registry},
    render::capture::{
        evaluate::{Evaluator, evaluate},
        gpu::{GpuRenderer, Output},
    },
    scene::Scene,
};

use crate::{
    helpers::pictures::{close_up, compare, on_gpu},
    helpers::support::check_wording,
};

/// The path of a model with this id.
fn path(id: &str) -> std::path::PathBuf {
    Path::new("somewhere").join(format!("{id}.wgsl"))
}

/// A registry with a model from a text.
fn with(id: &str, text: &str) -> Registry {
    let mut registry = Registry::builtin();
    let model = custom::read(&path(id), text, &registry).unwrap_or_else(|p| panic!("{id}: {p:?}\n{text}"));
    registry.put_custom_model(model);
    registry
}

/// Lambert's law with a declaration.
fn matt(declaration: &str) -> String {
    format!(
        "/* lcm {declaration} */\nfn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {{\n    \
         return Terms(vec3(0.0), vec3(max(dot(frame.n, l), 0.0)), vec3(0.0));\n}}\n"
    )
}

/// The messages of reading a file; one line per problem.
fn said_of(id: &str, text: &str) -> String {
    match custom::read(&path(id), text, &Registry::builtin()) {
        Ok(_) => String::new(),
        Err(problems) => problems.iter().map(|p| format!("{p}\n")).collect(),
    }
}

/// The messages about a declaration.
fn said(declaration: &str) -> String {
    said_of("mine", &matt(declaration))
}

#[test]
fn every_mistake_in_a_declaration_is_told_with_its_place_value_and_rule() {
    let check = |declaration: &str, expected: &str| {
        let said = said(declaration);
        check_wording(&said);
        assert!(said.contains(expected), "{declaration}\n{said}is not\n{expected}");
        assert!(said.lines().all(|l| l.starts_with("models/mine.wgsl:")), "{said}");
    };
    for (declaration, expected) in [
        ("", "1:7: the declaration is empty; it must be an object"),
        ("[]", "1:8: the declaration is [], but a model must be an object, with the keys name, author"),
        ("{ \"name\": }", "1:18: the declaration is not JSON: "),
        ("{ 'name': \"x\" }", "1:10: the declaration is not JSON: "),
        (
            "{ \"parameters\": [{ \"name\": \"x\", \"default\": NaN }] }",
            "1:51: the declaration is not JSON: NaN is not a number in JSON; write a finite number",
        ),
        (
            "{ \"parameters\": [{ \"name\": \"x\", \"min\": -inf, \"max\": 1, \"default\": 0 }] }",
            "1:47: the declaration is not JSON: -inf is not a number in JSON; write a finite number",
        ),
        (
            "{ \"parameters\": [{ \"name\": \"x\", \"min\": .5 }] }",
            "1:47: the declaration is not JSON: .5: numbers begin with a digit: 0.5, not .5",
        ),
        ("{ \"nam\": \"x\" }", "1:10: nam is not a key of a model; did you mean \"name\"?"),
        ("{ \"title\": \"x\" }", "did you mean \"name\"?"),
        (
            "{ \"banana\": 1 }",
            "banana is not a key of a model; a model has the keys name, author, source, summary",
        ),
        ("{ \"name\": \"a\",\n \"name\": \"b\" }", "2:2: name is given twice"),
        ("{ \"name\": 3 }", "1:18: name is 3, but it must be one line of text, of at most 60 characters"),
        ("{ \"name\": \" \" }", "name is \" \", but a name must not be blank"),
        ("{ \"anisotropic\": 1 }", "anisotropic is 1, but it must be true or false"),
        (
            "{ \"boundary\": true }",
            "boundary is true, but light passes through a boundary: it needs \"transmits\": true",
        ),
        (r#"{ "equation": "f = .5\cdot x" }"#, "the declaration is not JSON: invalid escape"),
        ("{ \"equation\": 1 }", "equation is 1, but it must be text, or a list of parts"),
        (
            "{ \"equation\": [{ \"term\": \"difuse\", \"text\": \"\" }] }",
            "equation[0].term is \"difuse\", but a term must be \"total\", \"ambient\", \"diffuse\", \"specular\" or \"transmitted\"; did you mean \"diffuse\"?",
        ),
        ("{ \"equation\": [{ \"term\": \"diffuse\" }] }", "equation[0].text is missing"),
        (
            "{ \"laws\": true }",
            "laws is true, but it must be a list of the laws that the model keeps, any of \"reciprocal\", \"energy conserving\" and \"non-negative\"",
        ),
        (
            "{ \"laws\": [\"recipocal\"] }",
            "laws[0] is \"recipocal\", but a law must be \"reciprocal\", \"energy conserving\" or \"non-negative\"; did you mean \"reciprocal\"?",
        ),
        (
            "{ \"lobe\": \"phong\" }",
            "lobe is \"phong\", but the model whose lobe is compensated must be \"microfacet\"",
        ),
        ("{ \"lobes\": 1 }", "lobes is 1, but it must be a list such as [\"cosine\", {"),
        ("{ \"lobes\": [] }", "lobes is [], but it must be a list such as"),
        ("{ \"lobes\": \"fong\" }", "lobes is \"fong\", but the model whose lobes fit must be \"lambert\", "),
        (
            "{ \"lobes\": [\"cosine\", \"cosine\", \"cosine\", \"cosine\"] }",
            "lobes is [\"cosine\", \"cosine\", \"cosine\", \"cosine\"], but at most 3 lobes fit",
        ),
        (
            "{ \"lobes\": [\"ggx\"] }",
            "lobes[0] is \"ggx\", but a lobe without a width must be \"cosine\"; others need one: { \"shape\": \"ggx\", \"alpha\": 0.3 }",
        ),
        (
            "{ \"lobes\": [{ \"alpha\": 1 }] }",
            "lobes[0].shape is missing; it must be \"cosine\", \"ggx\" or \"power\"",
        ),
        (
            "{ \"lobes\": [{ \"shape\": \"gx\" }] }",
            "lobes[0].shape is \"gx\", but the shape of a lobe must be \"cosine\", \"ggx\" or \"power\"; did you mean \"ggx\"?",
        ),
        (
            "{ \"lobes\": [{ \"shape\": \"ggx\" }] }",
            "lobes[0]: a lobe of the shape ggx needs one of \"alpha\", \"roughness\" or \"exponent\"",
        ),
        (
            "{ \"lobes\": [{ \"shape\": \"ggx\", \"alpha\": 1, \"roughness\": 1 }] }",
            "lobes[0]: a lobe of the shape ggx needs one of",
        ),
        (
            "{ \"lobes\": [{ \"shape\": \"cosine\", \"alpha\": 1 }] }",
            "lobes[0].alpha is given, but a lobe of the shape cosine has none",
        ),
        (
            "{ \"lobes\": [{ \"shape\": \"power\", \"exponent\": -1 }] }",
            "lobes[0].exponent is -1, but it must be a number, 0 or more",
        ),
        (
            "{ \"lobes\": [{ \"shape\": \"ggx\", \"alpha\": 1e308 }] }",
            "lobes[0].alpha is 1e308, but numbers must be between -3.4e38 and 3.4e38, the largest of 32 bits",
        ),
        (
            "{ \"parameters\": [{ \"name\": \"a\", \"min\": 1e400 }] }",
            "parameters[0].min is 1e400, but numbers must be between -3.4e38 and 3.4e38, the largest of 32 bits",
        ),
        (
            "{ \"parameters\": [\"alpha\", \"base_colour\"], \"lobes\": [{ \"shape\": \"power\", \"exponent\": \"base_colour\" }] }",
            "lobes[0].exponent is \"base_colour\", but it must be a number, 0 or more, or one of the parameters \"alpha\"",
        ),
        ("{ \"parameters\": {} }", "parameters is {}, but it must be a list"),
        (
            "{ \"parameters\": [\"base_color\"] }",
            "parameters[0] is \"base_color\", but no built-in model has a parameter of that name; did you mean \"base_colour\"?",
        ),
        ("{ \"parameters\": [\"banana\"] }", "to declare a new one, write { \"name\": …"),
        ("{ \"parameters\": [3] }", "parameters[0] is 3, but a parameter must be an object"),
        ("{ \"parameters\": [{ \"min\": 0 }] }", "parameters[0].name is missing"),
        ("{ \"parameters\": [{ \"name\": 3 }] }", "parameters[0].name is 3, but it must be text"),
        (
            "{ \"parameters\": [{ \"name\": \"Mine\" }] }",
            "parameters[0].name is \"Mine\", but it must be lower-case letters, digits and underscores",
        ),
        (
            "{ \"parameters\": [{ \"name\": \"rim_color\" }] }",
            "but in scene files it must be spelt rim_colour",
        ),
        ("{ \"parameters\": [{ \"name\": \"loop\" }] }", "\"loop\", but that is a reserved word in WGSL"),
        ("{ \"parameters\": [\"k_s\", { \"name\": \"k_s\" }] }", "k_s is declared twice"),
        ("{ \"groups\": [\"k_s\"] }", "groups is [\"k_s\"], but it must be an object of lists"),
        ("{ \"groups\": { \"Coat\": 1 } }", "groups is 1, but it must be an object of lists"),
        (
            "{ \"parameters\": [\"k_s\"],\n \"groups\": { \"Coat\": [\"k_d\"] } }",
            "2:14: group \"Coat\": \"k_d\" is not a parameter of the model; did you mean \"k_s\"?",
        ),
        (
            "{ \"parameters\": [\"k_s\"], \"groups\": { \"A\": [\"k_s\"], \"B\": [\"k_s\"] } }",
            "group \"B\": \"k_s\" is already in a group",
        ),
        (
            "{ \"parameters\": [{ \"name\": \"base_colour\", \"type\": \"number\" }] }",
            "parameters[0].name is \"base_colour\", but lambert has a parameter of that name with type colour",
        ),
    ] {
        check(declaration, expected);
    }
    // For a parameter.
    for (fields, expected) in [
        (
            r#""type": "nummer""#,
            r#"type is "nummer", but a type must be "number", "integer", "colour", "triple", "choice" or "flag"; did you mean "number"?"#,
        ),
        (
            r#""type": "color""#,
            r#"type is "color", but a type must be "number", "integer", "colour", "triple", "choice" or "flag"; did you mean "colour"?"#,
        ),
        (r#""default": [1, 2, 3]"#, r#"type is missing; a list may be a "colour" or a "triple""#),
        (r#""min": "0""#, r#"min is "0", but it must be a number"#),
        (r#""max": 1e99"#, "max is 1e99, but numbers must be between -3.4e38 and 3.4e38"),
        (r#""min": 2, "max": 1"#, "max is 1, but the largest value must be greater than the smallest"),
        (r#""range": [1, 1]"#, "range is [1, 1], but the largest value must be greater"),
        (r#""range": 1"#, "range is 1, but a range must be two numbers: [min, max]"),
        (r#""range": [0, 1], "max": 2"#, "range conflicts with max"),
        (r#""above": 1"#, "above is 1, but it must be 0; it replaces min and means greater than 0"),
        (r#""default": 2"#, "default is 2, but it must be between 0 and 1"),
        (r#""type": "integer", "default": 1.5"#, "default is 1.5, but it must be a whole number"),
        (
            r#""type": "integer", "max": 4, "default": 5"#,
            "default is 5, but it must be a whole number between 0 and 4",
        ),
        (
            r#""type": "integer", "slider_max": 0"#,
            "slider_max is 0, but it must be greater than 0, the start of the slider",
        ),
        (
            r#""type": "colour", "default": [1, 2]"#,
            "default is [1, 2], but a colour must be three whole numbers from 0 to 255",
        ),
        (
            r#""type": "colour", "default": [1, 2, 256]"#,
            "default is [1, 2, 256], but a colour must be three whole numbers",
        ),
        (r#""type": "colour", "min": 0"#, "min is given, but a colour has none"),
        (
            r#""type": "triple", "default": [0, 2, 0]"#,
            "default is [0, 2, 0], but it must be three numbers between 0 and 1",
        ),
        (r#""type": "choice""#, "choices is missing"),
        (r#""choices": []"#, "choices is missing"),
        (r#""choices": 1"#, "choices is 1, but it must be a list"),
        (r#""choices": ["A b"]"#, r#"choices has "A b", but a choice must be lower-case letters"#),
        (r#""choices": ["a", "a"]"#, r#"choices has "a" twice"#),
        (
            r#""choices": ["one", "two"], "default": "on""#,
            r#"default is "on", but it must be "one" or "two"; did you mean "one"?"#,
        ),
        (
            r#""choices": ["maybe", "true"]"#,
            r#"choices has "true", but true and false are only for the type "flag""#,
        ),
        (r#""type": "flag", "default": "true""#, r#"default is "true", but it must be true or false"#),
        (r#""default": true, "max": 1"#, "max is given, but a flag has none"),
        (r#""colour": 1"#, "colour is not a key of a parameter"),
    ] {
        check(
            &format!("{{ \"parameters\": [{{ \"name\": \"mine\", {fields} }}] }}"),
            &format!("parameters[0].{expected}"),
        );
    }
    // All at once, in the order of the file.
    let said =
        said("{\n\"nam\": 1,\n\"laws\": [1],\n\"parameters\": [\"x\", { \"name\": \"y\", \"min\": 3 }]\n}");
    let lines: Vec<_> = said.lines().map(|l| l.split(':').nth(1).unwrap_or_default()).collect();
    assert_eq!(lines, ["2", "3", "4", "4"], "{said}");
}

#[test]
fn lobes_follow_the_parameters_of_the_model() {
    let lobes = |declaration: &str, values: &Values| {
        let registry = with("shiny", &matt(declaration));
        registry.model("shiny").unwrap().instantiate(values, Encoding::Srgb).lobes()
    };
    let mut values = Values::default();
    values.set("k_s", Value::Number(0.25));
    values.set("roughness", Value::Number(0.5));
    values.set("specular_colour", Value::Colour([255, 0, 0]));
    values.set("alpha", Value::Integer(14));
    let parameters = "\"parameters\": [\"k_s\", \"roughness\", \"specular_colour\", \"alpha\"]";
    let said = |lobes_said: &str| lobes(&format!("{{ {parameters}, \"lobes\": {lobes_said} }}"), &values);
    assert_eq!(lobes("{}", &values), Lobes::default());
    assert_eq!(said("[\"cosine\"]"), Lobes::cosine());
    assert_eq!(
        said("[\"cosine\", { \"shape\": \"ggx\", \"roughness\": \"roughness\", \"weight\": \"k_s\" }]"),
        Lobes::new(&[(Lobe::Cosine, 1.0), (Lobe::ggx(0.25), 0.25)])
    );
    assert_eq!(
        said(
            "[{ \"shape\": \"ggx\", \"alpha\": [0.5, \"k_s\"] }, { \"shape\": \"power\", \"exponent\": \"alpha\", \"weight\": \"specular_colour\" }]"
        ),
        Lobes::new(&[
            (Lobe::Ggx { alpha_x: 0.5, alpha_y: 0.25 }, 1.0),
            (Lobe::Power { exponent: 14.0 }, 1.0 / 3.0)
        ])
    );
    assert_eq!(
        said("[{ \"shape\": \"ggx\", \"exponent\": \"alpha\" }]"),
        Lobes::new(&[(Lobe::ggx((2.0f32 / 16.0).sqrt()), 1.0)])
    );
    // The lobes of a built-in model, with only the declared parameters.
    let phong = Registry::builtin();
    let phong = |values: &Values| phong.model("phong").unwrap().instantiate(values, Encoding::Srgb).lobes();
    assert_eq!(said("\"phong\""), phong(&values));
    assert_eq!(lobes("{ \"lobes\": \"phong\" }", &values), phong(&Values::default()));
    assert_ne!(phong(&values), phong(&Values::default()));
}

#[test]
fn too_many_parameters_are_refused_and_as_many_as_fit_are_not() {
    let of = |count: usize| {
        let list: Vec<_> = (0..count).map(|i| format!("{{ \"name\": \"p{i}\" }}")).collect();
        format!("{{ \"parameters\": [{}] }}", list.join(", "))
    };
    assert_eq!(said(&of(60)), "");
    assert!(said(&of(80)).contains("take 260 bytes, but at most 256 fit"), "{}", said(&of(80)));
}

#[test]
fn a_file_without_a_good_name_or_declaration_is_refused() {
    let good = matt("{}");
    assert_eq!(said_of("mine", &good), "");
    for (id, expected) in [
        ("Mine", "models/Mine.wgsl:1:1: the file name is the id of the model: Mine must be lower-case"),
        ("my model", "must be lower-case letters"),
        ("1st", "begin with a letter"),
        ("phong", "models/phong.wgsl:1:1: phong is the id of a built-in model; give the file another name"),
    ] {
        assert!(said_of(id, &good).contains(expected), "{id}: {}", said_of(id, &good));
    }
    assert!(
        said_of("mine", "fn response() {}").contains("1:1: the declaration is missing; a model begins with")
    );
    assert!(said_of("mine", "\n  /* lcm { }").contains("2:3: the comment is not closed"));
    // Other comments may come before it, and inside.
    assert_eq!(said_of("mine", &format!("// Licence\n/* lcms */\n{good}")), "");
    assert_eq!(said("{ /* a comment */ \"name\": \"x\", // and this\n }"), "");
    assert!(custom::is_model(&good) && custom::is_model("fn response() {}"));
    assert!(!custom::is_model("// fn response()\nfn helper() {}"));
}

#[test]
fn what_is_left_out_has_a_sensible_value() {
    let declaration = "{ \"parameters\": [\"base_colour\", { \"name\": \"alpha_rim\" }, { \"name\": \"roughness\", \"default\": 0.2 }, \
        { \"name\": \"steps\", \"type\": \"integer\", \"min\": 1 }, { \"name\": \"kind\", \"choices\": { \"a\": \"The first\" } }, \
        { \"name\": \"width\", \"above\": 0, \"max\": 4 }] }";
    let registry = with("rim_light", &matt(declaration));
    let model = registry.model("rim_light").unwrap();
    let d = model.declaration;
    assert_eq!((d.id, d.name, d.wgsl.path), ("rim_light", "Rim light", "models/rim_light.wgsl"));
    assert_eq!(d.ambient, Ambient::Albedo);
    assert_eq!(registry.custom_file("rim_light"), Some(path("rim_light").as_path()));
    let [colour, rim, roughness, steps, kind, width] = model.parameters else {
        panic!("{:?}", model.parameters)
    };
    assert_eq!(*colour, BASE_COLOUR);
    assert_eq!((rim.symbol, rim.label), ("α_{rim}", "alpha rim"));
    assert_eq!(rim.kind, Parameter::number("", 0.0..=1.0, 0.5).kind);
    assert_eq!(roughness.label, "roughness");
    assert_eq!(roughness.kind, Parameter::number("", 0.0..=1.0, 0.2).kind);
    let ParameterKind::Integer(Integer { min: 1, max: None, default: 1, .. }) = steps.kind else {
        panic!("{steps:?}")
    };
    assert_eq!(kind.kind, Parameter::choice("", &[("a", "The first")], 0).kind);
    assert_eq!(width.rule(), "greater than 0 and at most 4");
}

#[test]
fn a_flag_is_declared_by_its_type_or_its_default() {
    let text = matt(
        r#"{ "parameters": [{ "name": "on", "default": true }, { "name": "off", "type": "flag" }, { "name": "colourful", "used_when": { "on": ["true"] } }] }"#,
    );
    let model = custom::read(&path("lamp"), &text, &Registry::builtin()).expect("valid").entry;
    let [on, off, _] = model.parameters else { panic!("{:?}", model.parameters) };
    assert_eq!((&on.kind, &off.kind), (&ParameterKind::flag(true), &ParameterKind::flag(false)));
    assert_eq!((on.kind.wgsl(), on.rule().as_str()), ("u32", "true or false"));
}

#[test]
fn a_parameter_says_what_it_stands_for() {
    let read = |parameter: &str| {
        let text = matt(&format!("{{ \"parameters\": [{parameter}] }}"));
        custom::read(&path("lacquer"), &text, &Registry::builtin())
    };
    let model = read(r#"{ "name": "polish", "max": 500, "stands_for": "blinn_phong_exponent" }, "metallic""#);
    let [polish, metallic] = model.expect("valid").entry.parameters else { panic!("two") };
    assert_eq!(polish.stands_for, Some(&meaning::BLINN_PHONG_EXPONENT));
    assert_eq!(metallic.stands_for, Some(&meaning::METAL));
    for (parameter, said) in [
        (r#"{ "name": "polish", "stands_for": "roughnes" }"#, "did you mean"),
        (r#"{ "name": "polish", "stands_for": 3 }"#, "stands_for"),
        (r#"{ "name": "polish", "choices": ["a", "b"], "stands_for": "roughness" }"#, "only numbers"),
    ] {
        let problems = read(parameter).map(drop).expect_err(parameter);
        assert!(problems.iter().any(|p| p.message.contains(said)), "{parameter}: {problems:?}");
    }
    // A copy of a model stands for the same.
    let registry = Registry::builtin();
    for id in ["phong", "blinn_phong", "disney", "openpbr"] {
        let entry = registry.model(id).expect("built in");
        let copy = custom::duplicate(entry, registry.sources(), "copied", "Copied").expect("an id");
        let copy = custom::read(&path("copied"), &copy, &registry).expect("valid").entry;
        for p in entry.parameters {
            let there = copy.parameter(p.name).unwrap_or_else(|| panic!("{id}: {}", p.name));
            assert_eq!(there.stands_for, p.stands_for, "{id}: {}", p.name);
        }
    }
}

#[test]
fn equal_declarations_are_the_same_one() {
    let read = |text: &str| custom::read(&path("same"), text, &Registry::builtin()).expect("valid");
    let text = matt("{ \"name\": \"Same\", \"parameters\": [\"base_colour\", { \"name\": \"mine\" }] }");
    let (a, b) = (read(&text), read(&text.replace("0.0), vec3(max", "0.0), vec3(0.5 * max")));
    assert!(std::ptr::eq(a.entry.declaration, b.entry.declaration));
    assert!(std::ptr::eq(a.entry.parameters, b.entry.parameters));
    assert_ne!(a.text, b.text);
    let other = read(&text.replace("Same", "Other"));
    assert!(!std::ptr::eq(a.entry.declaration, other.entry.declaration));
    assert!(std::ptr::eq(a.entry.parameters, other.entry.parameters));
    // A formula for uniform light is part of the declaration.
    let formula = format!(
        "{text}fn ambient_response(v: vec3<f32>, frame: Frame, m: Parameters) -> vec3<f32> {{ return m.base_colour; }}"
    );
    assert_eq!(read(&formula).entry.declaration.ambient, Ambient::Formula);
}

#[test]
fn registering_replaces_in_place_and_removing_forgets() {
    let mut registry = with("first", &matt("{}"));
    let second = custom::read(&path("second"), &matt("{}"), &registry).expect("valid");
    registry.put_custom_model(second);
    let again = custom::read(&path("first"), &matt("{ \"name\": \"Again\" }"), &registry).expect("valid");
    registry.put_custom_model(again);
    let ids: Vec<_> = registry.custom_models().map(|(m, _)| (m.declaration.id, m.declaration.name)).collect();
    assert_eq!(ids, [("first", "Again"), ("second", "Second")]);
    assert!(registry.sources().get("models/first.wgsl").is_some());
    registry.remove_model("first");
    assert!(registry.model("first").is_none() && registry.custom_file("first").is_none());
    assert_eq!(registry.sources().get("models/first.wgsl"), None);
    // Custom models must agree on the types of parameters.
    let clash = custom::read(
        &path("third"),
        &matt("{ \"parameters\": [{ \"name\": \"x\", \"type\": \"colour\" }] }"),
        &with("second", &matt("{ \"parameters\": [{ \"name\": \"x\" }] }")),
    );
    assert!(clash.unwrap_err()[0].message.contains("second has a parameter of that name with type number"));
    // And on their units.
    let clash = custom::read(
        &path("third"),
        &matt("{ \"parameters\": [{ \"name\": \"x\", \"unit\": \"°\" }] }"),
        &with("second", &matt("{ \"parameters\": [{ \"name\": \"x\" }] }")),
    );
    let said = clash.unwrap_err()[0].message.clone();
    assert!(said.contains("it is in ° here, but without a unit in second"), "{said}");
}

#[test]
fn a_model_without_a_good_version_is_drawn_as_a_stand_in() {
    let broken = "/* lcm { \"parameters\": [\"base_colour\"] } */\nfn response(";
    let mut registry = Registry::builtin();
    assert!(custom::read(&path("broken"), broken, &registry).is_err());
    let model = custom::declare(&path("broken"), broken, &registry).expect("the declaration is good");
    registry.put_stand_in(model);
    let mut scene = close_up("sphere", "point");
    scene.reflection_model = "broken".to_owned();
    let picture = on_gpu(&mut renderer(&registry), &scene);
    let cpu = on_cpu(&registry, &scene);
    let d = compare(&picture, &cpu, Encoding::Srgb.decode(BACKGROUND), 1e-3);
    assert!(d.covered > 300 && d.wrong == 0, "{d:?}");
}

/// A renderer on the GPU with the contents of a registry.
fn renderer(registry: &Registry) -> GpuRenderer {
    let registry = registry.clone();
    GpuRenderer::extended(64, 64, 1, Output::Linear, |app| {
        app.insert_resource(registry);
    })
    .expect("software Vulkan is installed")
}

/// The picture by the CPU renderer.
fn on_cpu(registry: &Registry, scene: &Scene) -> reference::Picture {
    let settings = reference::Settings { width: 64, height: 64, samples: 1, terms: TermSelection::All };
    reference::render(scene, registry, &settings)
}

/// A built-in model as a file, registered with another id.
fn duplicated(model: &ModelEntry) -> (Registry, CustomModel) {
    let registry = Registry::builtin();
    let id = format!("{}_copy", model.declaration.id);
    let text = custom::duplicate(model, registry.sources(), &id, &id).expect("can be duplicated");
    let copy = custom::read(&path(&id), &text, &registry).unwrap_or_else(|p| panic!("{id}: {p:?}\n{text}"));
    let mut registry = registry;
    registry.put_custom_model(copy.clone());
    (registry, copy)
}

#[test]
fn every_built_in_model_as_a_file_has_the_same_knobs_and_the_same_numbers() {
    let mut random = Random(5);
    // Models in files have no files.
    for model in Registry::builtin().models().iter().filter(|model| model.file().is_none()) {
        let (registry, copy) = duplicated(model);
        let (ours, theirs) = (copy.entry.declaration, model.declaration);
        let id = theirs.id;
        assert_eq!(copy.entry.parameters, model.parameters, "{id}");
        assert_eq!(
            (ours.laws, ours.ambient, ours.anisotropic),
            (theirs.laws, theirs.ambient, theirs.anisotropic),
            "{id}"
        );
        assert_eq!(
            (ours.author, ours.source, ours.summary),
            (theirs.author, theirs.source, theirs.summary),
            "{id}"
        );
        // What light does along a path is not the file's.
        let spread = theirs.equation.iter().filter(|part| !part.along_path);
        assert!(ours.equation.iter().eq(spread), "{id}: {:?}", ours.equation);
        assert_eq!((ours.transmits, ours.sharp, ours.solid), (theirs.transmits, theirs.sharp, false), "{id}");
        assert_eq!(ours.boundary, theirs.boundary, "{id}");
        assert_eq!(copy.entry.not_on_cpu(), None, "{id}");
        let mut told_apart = false;
        // Each shader is compiled once.
        let mut evaluators = [model, &copy.entry]
            .map(|m| Evaluator::new(registry.sources(), m).expect("software Vulkan is installed"));
        for set in 0..3 {
            let values = if set == 0 { Values::default() } else { random.values(model) };
            let pairs: Vec<_> = (0..500).map(|_| (random.direction(), random.direction())).collect();
            let [original, copied] = evaluators.each_mut().map(|evaluator| {
                evaluator.set(&values, Encoding::Srgb);
                evaluator.evaluate(&pairs).expect("the GPU evaluates")
            });
            assert_eq!(original, copied, "{id} {values:?}");
            // The CPU interprets the file; the original is written in Rust.
            let surface = copy.entry.instantiate(&values, Encoding::Srgb);
            let lobes = model.instantiate(&values, Encoding::Srgb).lobes();
            assert_eq!(surface.lobes(), lobes, "{id} {values:?}");
            for ((l, v), gpu) in pairs.iter().zip(&copied) {
                let cpu = surface.response(*l, *v, &Frame::LOCAL);
                for (g, c) in [
                    (gpu.ambient, cpu.ambient),
                    (gpu.diffuse, cpu.diffuse),
                    (gpu.specular, cpu.specular),
                    (gpu.transmitted, cpu.transmitted),
                ] {
                    let error = |c: Vec3| ((g - c).abs() / c.abs().max(Vec3::splat(1e-2))).max_element();
                    assert!(error(c) <= 2e-4, "{id} {values:?} l {l} v {v}: GPU {g}, CPU {c}");
                    told_apart |= error(c * 1.001) > 2e-4;
                }
            }
            let v = random.above(&Frame::LOCAL);
            let ambient =
                |m: &ModelEntry| m.instantiate(&values, Encoding::Srgb).ambient_response(v, &Frame::LOCAL);
            let (a, b) = (ambient(model), ambient(&copy.entry));
            assert!((a - b).abs().max_element() < 2e-3, "{id} {values:?} {v}: {a} is not {b}");
        }
        assert!(told_apart, "{id}: 0.1 % more goes unnoticed");
    }
}

#[test]
fn a_built_in_model_as_a_file_gives_the_same_picture_in_every_shading_model() {
    for id in ["lambert", "ward", "microfacet", "hapke"] {
        let builtin = Registry::builtin();
        let (registry, copy) = duplicated(builtin.model(id).unwrap());
        let mut gpu = renderer(&registry);
        for shading in builtin.shading_models() {
            let mut scene = close_up("torus", "point");
            scene.lights.push(close_up("torus", "ambient").lights[0].clone());
            scene.shading_model = shading.declaration.id.to_owned();
            scene.reflection_model = id.to_owned();
            scene.objects[0].material.set("base_colour", Value::Colour([200, 120, 60]));
            scene.objects[0].material.set("multiple_scattering", Value::Choice("kulla_conty".into()));
            let original = on_gpu(&mut gpu, &scene);
            scene.reflection_model = copy.entry.declaration.id.to_owned();
            let copied = on_gpu(&mut gpu, &scene);
            let error =
                original.iter().zip(&copied).map(|(a, b)| (*a - *b).abs().max_element()).fold(0.0, f32::max);
            // Curves of albedo are integrated from the Rust functions here and from the interpreted file
            // there.
            assert!(error < 1e-3, "{id} {}: {error}", shading.declaration.id);
            let lit = original.iter().filter(|p| **p != Encoding::Srgb.decode(BACKGROUND)).count();
            assert!(lit > 300, "{id} {}: {lit}", shading.declaration.id);
            let d = compare(&copied, &on_cpu(&registry, &scene), Encoding::Srgb.decode(BACKGROUND), 1e-3);
            assert!(d.wrong == 0 && d.edges * 20 <= d.covered, "{id} {}: {d:?}", shading.declaration.id);
        }
    }
}

/// A leaf after the documents: it reflects one colour and lets another through, where a line of its header says so.
fn leaf(line: &str) -> String {
    format!(
        "/* lcm {{ {line} \"parameters\": [\"base_colour\", \"transmittance_colour\"] }} */
fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {{
    let cos_l = dot(frame.n, l);
    let colour = select(m.base_colour, m.transmittance_colour, cos_l < 0.0);
    return Terms(vec3(0.0), 0.5 * abs(cos_l) * colour, vec3(0.0));
}}"
    )
}

#[test]
fn a_file_lets_light_through_by_one_line_of_its_header() {
    let mut scene = close_up("sphere", "point");
    scene.reflection_model = "leaf".to_owned();
    scene.shading_model = "phong".to_owned();
    scene.objects[0].material.set("transmittance_colour", Value::Colour([90, 200, 40]));
    let at = scene.lights[0].position.expect("a point light has a place");
    scene.lights[0].position = Some(Vec3::new(at.x, at.y, 10.0 - at.z));
    let settings =
        reference::Settings { width: 64, height: 64, samples: 1, terms: TermSelection::Transmitted };
    for (line, goes_through) in [("\"transmits\": true,", true), ("", false)] {
        let registry = with("leaf", &leaf(line));
        let declared = registry.model("leaf").expect("read").declaration;
        assert_eq!(declared.transmits, goes_through);
        let picture = reference::render(&scene, &registry, &settings);
        let mut gpu = renderer(&registry);
        gpu.set_terms(TermSelection::Transmitted);
        let d = compare(&on_gpu(&mut gpu, &scene), &picture, Encoding::Srgb.decode(BACKGROUND), 1e-3);
        assert!(d.wrong == 0 && d.edges * 20 <= d.covered, "{line}: {d:?}");
        // Green light from behind.
        let green = picture.pixels.iter().filter(|p| p.w > 0.5 && p.y > 3.0 * p.x && p.y > 0.01).count();
        assert!(if goes_through { green > 300 } else { green == 0 }, "{line}: {green}");
    }
    let wrong = "{ \"transmits\": \"yes\" }";
    assert!(said(wrong).contains("transmits is \"yes\", but it must be true or false"), "{}", said(wrong));
}

#[test]
fn a_file_is_lit_by_every_light_with_extent_on_both_renderers() {
    const SAMPLES: u32 = 16;
    let registry = with("mine", &custom::template("mine", "mine"));
    let mut gpu = renderer(&registry);
    gpu.set_light_samples(SAMPLES);
    let settings = reference::Settings { width: 64, height: 64, samples: 1, terms: TermSelection::All };
    let light_types = registry.lights().iter().filter(|light| light.declaration.extent);
    let mut lit = 0;
    for light in light_types.map(|light| light.declaration.id) {
        let mut scene = close_up("sphere", light);
        scene.lights[0].parameters.set("visible", Value::flag(false));
        scene.reflection_model = "mine".to_owned();
        scene.shading_model = "phong".to_owned();
        let samples = LightSamples::of(SAMPLES);
        let picture =
            reference::render_samples(&scene, &registry, &settings, samples, &AtomicBool::default());
        let d = compare(&on_gpu(&mut gpu, &scene), &picture, Encoding::Srgb.decode(BACKGROUND), 1e-3);
        assert!(d.wrong * 200 <= d.covered && d.edges * 20 <= d.covered, "{light}: {d:?}");
        // The wrong twin: a lamp that is a fifth brighter.
        scene.lights[0].intensity *= 1.2;
        let twin = compare(&on_gpu(&mut gpu, &scene), &picture, Encoding::Srgb.decode(BACKGROUND), 1e-3);
        assert!(twin.wrong * 5 > twin.covered, "{light}: {twin:?}");
        lit += 1;
    }
    assert_eq!(lit, 6);
}

/// The GPU's findings about a model.
fn examined(registry: &Registry, id: &str) -> Findings {
    let model = registry.model(id).unwrap();
    let mut evaluator = Evaluator::new(registry.sources(), model).expect("software Vulkan is installed");
    let effort = Effort { sets: 24, pairs: 400 };
    laws::examine(model, &Values::default(), effort, |values, pairs| {
        evaluator.set(values, Encoding::Srgb);
        evaluator.evaluate(pairs)
    })
    .expect("the GPU evaluates")
}

#[test]
fn the_laws_that_files_claim_are_put_to_the_test() {
    // Divided by the cosine of the view alone, the BRDF is not reciprocal; brighter than white, it gains energy.
    for (law, body) in [
        ("reciprocal", "0.5 * cos_l * (1.0 - 0.5 * cos_v)"),
        ("energy conserving", "1.2 * cos_l"),
        ("non-negative", "cos_l * (cos_l * cos_v - 0.25)"),
    ] {
        let text = format!(
            "/* lcm {{ \"laws\": [\"reciprocal\", \"energy conserving\", \"non-negative\"] }} */
fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {{
    let cos_l = max(dot(frame.n, l), 0.0);
    let cos_v = max(dot(frame.n, v), 0.0);
    return Terms(vec3(0.0), vec3({body}), vec3(0.0));
}}"
        );
        let found = examined(&with("claims", &text), "claims");
        for (name, kept) in found.kept().list() {
            assert_eq!(kept, name != law, "{law}: {name} {found:?}");
        }
        assert!(found.reciprocity.case.is_some() && found.not_finite == 0);
    }
    let text = matt("{}").replace("vec3(max(dot(frame.n, l), 0.0))", "vec3(1.0 / max(frame.n.z - l.z, 0.0))");
    let found = examined(&with("infinite", &text), "infinite");
    assert!(found.not_finite > 0 && found.first_not_finite.is_some(), "{found:?}");
}

#[test]
fn built_in_models_keep_what_they_claim_on_the_graphics_card_too() {
    let registry = Registry::builtin();
    for id in ["lambert", "torrance_sparrow", "eon", "phong"] {
        let found = examined(&registry, id);
        let claimed = registry.model(id).unwrap().declaration.laws.list();
        for ((law, claimed), (_, kept)) in claimed.into_iter().zip(found.kept().list()) {
            assert!(kept || !claimed, "{id} {law}: {found:?}");
        }
        assert_eq!(found.not_finite, 0, "{id}");
    }
    let phong = examined(&registry, "phong");
    assert!(phong.reciprocity.size > 10.0 * RECIPROCITY_TOLERANCE, "{phong:?}");
    // Lambert reflects its colour: white reflects everything.
    let lambert = examined(&registry, "lambert");
    assert!((lambert.albedo.size - 1.0).abs() < 1e-3, "{lambert:?}");
}

#[test]
fn the_file_to_start_from_works_at_once_and_keeps_what_it_claims() {
    let text = custom::template("my_velvet", "My \"velvet\" */");
    let registry = with("my_velvet", &text);
    let model = registry.model("my_velvet").unwrap();
    assert_eq!(model.declaration.name, "My \"velvet\" */");
    // No placeholders in the window.
    assert_eq!(model.declaration.author, "unknown author");
    assert_eq!(model.declaration.source, "models/my_velvet.wgsl");
    assert_eq!(custom::id_of_name("My velvet"), Ok("my_velvet".to_owned()));
    assert!(custom::id_of_name("3 things").is_err());
    let found = examined(&registry, "my_velvet");
    assert_eq!(model.declaration.laws, found.kept());
    assert!(model.declaration.laws.list().iter().all(|(_, claimed)| *claimed));
    let mut scene = close_up("sphere", "point");
    scene.reflection_model = "my_velvet".to_owned();
    scene.shading_model = "phong".to_owned();
    let d = compare(
        &on_gpu(&mut renderer(&registry), &scene),
        &on_cpu(&registry, &scene),
        Encoding::Srgb.decode(BACKGROUND),
        1e-3,
    );
    assert!(d.covered > 300 && d.wrong == 0, "{d:?}");
}

#[test]
fn the_examples_are_all_there_and_say_the_truth() {
    let folder = crate::helpers::support::root().join("assets/models");
    let there: Vec<_> = EXAMPLES.iter().map(|(name, _)| folder.join(name)).collect();
    let mut registry = Registry::builtin();
    for path in &there {
        let model = custom::read(path, &std::fs::read_to_string(path).unwrap(), &registry).unwrap();
        registry.put_custom_model(model);
        let id = custom::id_of(path).unwrap();
        let model = registry.model(id).unwrap();
        assert_eq!(model.not_on_cpu(), None);
        let found = examined(&registry, id);
        assert_eq!(model.declaration.laws, found.kept(), "{id}: {found:?}");
        assert_eq!(found.not_finite, 0, "{id}: {found:?}");
        let mut scene = close_up("teapot", "point");
        scene.lights.push(close_up("torus", "ambient").lights[0].clone());
        scene.reflection_model = id.to_owned();
        scene.shading_model = "phong".to_owned();
        let d = compare(
            &on_gpu(&mut renderer(&registry), &scene),
            &on_cpu(&registry, &scene),
            Encoding::Srgb.decode(BACKGROUND),
            1e-3,
        );
        assert!(d.covered > 300 && d.wrong == 0, "{id}: {d:?}");
    }
}

#[test]
fn the_model_in_the_documents_works_and_keeps_what_it_claims() {
    let page =
        std::fs::read_to_string(crate::helpers::support::root().join("docs/custom-models.md")).unwrap();
    let (_, rest) = page.split_once("<!-- moss.wgsl -->\n\n```wgsl\n").unwrap();
    let (text, _) = rest.split_once("```\n\n<!-- end of moss.wgsl -->").unwrap();
    let registry = with("moss", text);
    let found = examined(&registry, "moss");
    assert_eq!(registry.model("moss").unwrap().declaration.laws, found.kept(), "{found:?}");
}

#[test]
fn no_damage_to_a_file_makes_the_program_panic() {
    let registry = Registry::builtin();
    let whole: Vec<char> = custom::template("mine", "Mine").chars().collect();
    let mut random = Random(21);
    let mut refused = 0;
    for _ in 0..300 {
        let mut text = whole.clone();
        for _ in 0..1 + (random.unit() * 4.0) as usize {
            let at = (random.unit() * text.len() as f32) as usize;
            match (random.unit() * 4.0) as u32 {
                0 => text.truncate(at),
                1 => drop(text.drain(at..(at + 9).min(text.len()))),
                2 => text
                    .insert(at, ['"', '{', '*', '/', 'é', '\u{0}', '-', ']'][(random.unit() * 8.0) as usize]),
                _ => text.rotate_left(at / 9),
            }
        }
        let text: String = text.into_iter().collect();
        if let Err(problems) = custom::read(&path("mine"), &text, &registry) {
            refused += 1;
            for problem in problems {
                let line = text.lines().nth(problem.line - 1).unwrap_or_default();
                let ours = problem.file == "models/mine.wgsl";
                assert!(!ours || problem.source.trim_end() == line.trim_end(), "{problem}\n{text}");
            }
        }
        let _ = custom::declare(&path("mine"), &text, &registry);
    }
    assert!(refused > 200, "{refused}");
    for deep in ["[".repeat(100_000), "{\"a\":".repeat(50_000)] {
        assert!(said(&deep).contains("the declaration has more than 600 brackets"));
    }
}

#[test]
fn a_loop_without_end_is_told_and_not_waited_for() {
    let text = matt("{}").replace(
        "return Terms(",
        "var x = 0.0;\n    while x >= 0.0 { x += f32(frame.n.z >= 0.0); }\n    return Terms(",
    );
    let registry = with("endless", &text);
    let model = registry.model("endless").unwrap();
    assert_eq!(model.not_on_cpu(), None);
    let surface = model.instantiate(&Values::default(), Encoding::Srgb);
    for _ in 0..1000 {
        assert_eq!(surface.response(Vec3::Z, Vec3::Z, &Frame::LOCAL).diffuse, Vec3::ZERO);
    }
    assert!(model.not_on_cpu().is_some_and(|why| why.contains("runs too long")));
}

#[test]
fn parameters_of_custom_models_are_saved_and_kept() {
    use lights_camera_models::scene::{
        load::{self, Defaults},
        save,
    };
    let registry =
        with("mine", &matt("{ \"parameters\": [\"base_colour\", { \"name\": \"fuzz\", \"max\": 9 }] }"));
    let mut scene = close_up("sphere", "point");
    scene.reflection_model = "mine".to_owned();
    scene.objects[0].material.set("fuzz", Value::Number(7.5));
    let text = save::to_json(&scene, None, &registry);
    assert!(text.contains("\"fuzz\": 7.5"), "{text}");
    let loaded = load::from_text(&text, "scene.json", &registry, Defaults::Refuse).expect("valid");
    assert_eq!(loaded.scene.objects[0].material, scene.objects[0].material);
    let wrong = text.replace("7.5", "10");
    let error = load::from_text(&wrong, "scene.json", &registry, Defaults::Refuse).unwrap_err().to_string();
    assert!(error.contains("fuzz is 10, but it must be between 0 and 9"), "{error}");
    let error =
        load::from_text(&text, "scene.json", &Registry::builtin(), Defaults::Refuse).unwrap_err().to_string();
    assert!(error.contains("reflection_model is \"mine\", but"), "{error}");
}

#[test]
fn the_same_parameters_are_the_same_words_on_both_machines() {
    // One of each type, distinguished by weights: a word in the wrong place gives another number.
    let declaration = "{ \"parameters\": [{ \"name\": \"a\" }, \"base_colour\", { \"name\": \"kind\", \"choices\": [\"x\", \"y\", \"z\"] }, \
        { \"name\": \"t\", \"type\": \"triple\" }, { \"name\": \"n\", \"type\": \"integer\", \"max\": 9 }] }";
    let text = matt(declaration).replace(
        "vec3(max(dot(frame.n, l), 0.0))",
        "m.base_colour + 2.0 * m.t + vec3(4.0 * m.a + 8.0 * f32(m.kind) + 16.0 * m.n)",
    );
    let registry = with("words", &text);
    let model = registry.model("words").unwrap();
    let mut values = Values::default();
    let set: [(&str, Value); 5] = [
        ("a", Value::Number(0.25)),
        ("base_colour", Value::Colour([255, 0, 128])),
        ("kind", Value::Choice("z".into())),
        ("t", Value::Triple([0.1, 0.2, 0.3])),
        ("n", Value::Integer(5)),
    ];
    for (name, value) in set {
        values.set(name, value);
    }
    let cpu = model.instantiate(&values, Encoding::Srgb).response(Vec3::Z, Vec3::Z, &Frame::LOCAL).diffuse;
    let gpu = evaluate(registry.sources(), model, &values, Encoding::Srgb, &[(Vec3::Z, Vec3::Z)]).unwrap()[0]
        .diffuse;
    let half = Encoding::Srgb.decode([128; 3]).x;
    let expected = Vec3::new(1.0 + 0.2, 0.4, half + 0.6) + Vec3::splat(1.0 + 16.0 + 80.0);
    assert!((cpu - expected).abs().max_element() < 1e-4, "{cpu}");
    assert!((gpu - expected).abs().max_element() < 1e-4, "{gpu}");
}

#[test]
fn a_copy_of_the_registry_shares_the_texts() {
    let registry = with("mine", &matt("{}"));
    let at = |r: &Registry| r.sources().get("models/mine.wgsl").map(str::as_ptr);
    assert!(at(&registry).is_some());
    assert_eq!(at(&registry), at(&registry.clone()));
}
