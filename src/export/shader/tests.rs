use super::*;
use crate::{
    optics::sharp,
    parameter::Values,
    scene::{Light, Scene},
    shader::compose::LOOP,
};

fn with_lights(types: &[&str], registry: &Registry) -> Scene {
    let mut scene = Scene { lights: Vec::new(), ..Scene::default() };
    for id in types {
        let mut light = Light::default();
        light.set_type(registry.light(id).expect("built in"), registry, scene.scene_size);
        scene.lights.push(light);
    }
    scene
}

/// A model with its defaults.
fn of(model: &ModelEntry) -> (&ModelEntry, Passage) {
    (model, model.passage(&Values::default()))
}

const ALONE: Host = Host::Alone { tone: ToneMapping::None, encoding: Encoding::Srgb };

#[test]
fn every_model_is_valid_by_itself_in_every_shading_model() {
    let registry = Registry::builtin();
    for types in [
        &["point"][..],
        &["point", "spot", "photometric", "directional", "ambient"],
        &["rectangle"],
        &["environment", "point", "rectangle", "disc", "sphere", "cylinder", "sun", "ambient"],
    ] {
        let scene = with_lights(types, &registry);
        let lights = Lights::of(&scene, &registry);
        let all = registry.models().iter().filter(|m| m.file().is_none());
        let all = all.flat_map(|m| m.passages().into_iter().map(move |passage| (m, passage)));
        for (model, passage) in all {
            for shading in registry.shading_models() {
                let shader = compose(&lights, &registry, (model, passage), shading, ALONE).expect("composed");
                assert_eq!(shader.reads_body, passage.solid);
                assert!(!shader.reads_header, "{}", shader.text);
                let (checked, _) = module(&shader.text)
                    .unwrap_or_else(|error| panic!("{}: {error}\n{}", model.declaration.id, shader.text));
                let light = checked.types.iter().find(|(_, ty)| ty.name.as_deref() == Some("Light"));
                let bytes = light.map(|(_, ty)| ty.inner.size(checked.to_ctx()) as usize);
                assert_eq!(bytes, Some(stride(&shader.light_fields)));
            }
        }
    }
}

#[test]
fn parts_that_a_scene_does_not_need_are_left_out() {
    let registry = Registry::builtin();
    let scene = with_lights(&["point"], &registry);
    let (lambert, gouraud) =
        (registry.model("lambert").expect("is"), registry.shading_model("gouraud").expect("is"));
    let text = compose(&Lights::of(&scene, &registry), &registry, of(lambert), gouraud, ALONE)
        .expect("composed")
        .text;
    for absent in [
        "incident_spot",
        "ambient_response",
        "ggx",
        "select_terms",
        "light_type",
        "exposure: f32,\n    gamma",
        "switch",
        "MAX_LIGHTS",
        "direction:",
        "parameter_table",
    ] {
        assert!(!text.contains(absent), "{absent} in\n{text}");
    }
    for present in ["incident_point", "LIGHT_COUNT: u32 = 1u", "Gouraud", "J. H. Lambert"] {
        assert!(text.contains(present), "{present} not in\n{text}");
    }
    let scene = with_lights(&["point", "ambient"], &registry);
    let text = compose(&Lights::of(&scene, &registry), &registry, of(lambert), gouraud, ALONE)
        .expect("composed")
        .text;
    assert!(text.contains("ambient_response") && text.contains("light_type"), "{text}");
}

/// Light with extent is sampled, each type handles only its own lights, and a scene without such light
/// contains none of this code.
#[test]
fn light_with_extent_is_sampled_where_there_is_some() {
    let registry = Registry::builtin();
    let (model, shading) =
        (registry.model("lambert").expect("is"), registry.shading_model("phong").expect("is"));
    let of = |types: &[&str]| {
        let scene = with_lights(types, &registry);
        compose(&Lights::of(&scene, &registry), &registry, of(model), shading, ALONE).expect("composed")
    };
    let without = of(&["point"]);
    for part in ["extended", "sample_seed", "LIGHT_SAMPLES", "material_lobes"] {
        assert!(!without.text.contains(part), "{part} in\n{}", without.text);
    }
    assert!(!without.reads_lobes);
    let with = of(&["point", "rectangle"]);
    for part in [
        " + extended(position, v, frame)",
        "LIGHT_SAMPLES: u32 = 64u",
        "sample_seed = pixel.x",
        "case 0u: { return incident_point(light, p); }\n        default: { return Incident(vec3(0.0)",
        "return light_type == 1u;",
        "case 1u: { return sample_rectangle(light, RectangleParameters(light.width, light.height,",
        "default: { return NOTHING_SEEN; }",
    ] {
        assert!(with.text.contains(part), "{part} not in\n{}", with.text);
    }
    assert!(with.reads_lobes && !with.reads_header && !with.text.contains("reverseBits"));
}

/// A solid body is followed where the lights with extent and uniform light are; the record of a light stays that of the
/// other models.
#[test]
fn light_goes_through_solid_bodies_alone() {
    let registry = Registry::builtin();
    let shading = registry.shading_model("phong").expect("is");
    for types in [&["rectangle"][..], &["point"], &["environment", "point"], &["ambient"], &[]] {
        let scene = with_lights(types, &registry);
        let lights = Lights::of(&scene, &registry);
        let with = |id: &str| {
            let drawn = of(registry.model(id).expect("is"));
            compose(&lights, &registry, drawn, shading, ALONE).expect("composed")
        };
        let (solid, thin) = (with("glass"), with("thin_glass"));
        for part in
            ["solid_rows: texture_2d<u32>", "fn follow_inside", "fn walk_inside", "LIGHT_SAMPLES: u32"]
        {
            assert!(solid.text.contains(part), "{part} not in\n{}", solid.text);
        }
        for part in ["solid_rows", "interior", "through(", "mesh_functions", "first_sample"] {
            assert!(!thin.text.contains(part), "{part} in\n{}", thin.text);
        }
        for part in
            ["object_instance", "mesh_functions", "first_sample", "illumination.terms", "select_terms"]
        {
            assert!(!solid.text.contains(part), "{part} in\n{}", solid.text);
        }
        assert_eq!(solid.light_fields, thin.light_fields, "{types:?}");
    }
}

#[test]
fn the_light_loop_has_the_parts_that_are_simplified() {
    let unspread = part("unspread", &[("most", &sharp::MOST)]);
    for part in SIMPLER.iter().map(|(general, _)| *general).chain([EITHER]) {
        let texts = [LOOP.text, EXTENDED.text, THROUGH.text, &unspread];
        assert!(texts.iter().any(|text| text.contains(part)), "{part}");
    }
    assert!(THROUGH.text.contains("has_extent(light.light_type)"));
}

#[test]
fn an_edited_light_loop_stays_as_it_is_and_stands_alone() {
    let mut registry = Registry::builtin();
    let edited = LOOP.text.replace("let v = eye", "let strange = illumination.count;\n    let v = eye");
    registry.sources_mut().edit("loop.wgsl", edited);
    let scene = with_lights(&["point", "spot"], &registry);
    let (model, shading) =
        (registry.model("phong").expect("is"), registry.shading_model("phong").expect("is"));
    let shader =
        compose(&Lights::of(&scene, &registry), &registry, of(model), shading, ALONE).expect("composed");
    assert!(shader.text.contains("let strange = LIGHT_COUNT") && !shader.reads_header, "{}", shader.text);
    module(&shader.text).expect("valid");
}

#[test]
fn names_that_exports_have_themselves_are_refused_in_models() {
    let mut registry = Registry::builtin();
    let wgsl = registry.model("phong").expect("is").declaration.wgsl;
    registry.sources_mut().edit(wgsl.path, format!("fn srgb_encode() {{}}\n{}", wgsl.text));
    let scene = with_lights(&["point"], &registry);
    let (model, shading) =
        (registry.model("phong").expect("is"), registry.shading_model("phong").expect("is"));
    let refused =
        compose(&Lights::of(&scene, &registry), &registry, of(model), shading, ALONE).expect_err("twice");
    assert!(refused.to_string().starts_with("a shader declares `srgb_encode`, a name"), "{refused}");
}

#[test]
fn the_files_of_lamps_and_the_lights_must_fit_into_a_uniform() {
    let registry = Registry::builtin();
    let scene = with_lights(&["photometric"], &registry);
    let (model, shading) =
        (registry.model("phong").expect("is"), registry.shading_model("phong").expect("is"));
    let mut lights = Lights::of(&scene, &registry);
    assert!(compose(&lights, &registry, of(model), shading, ALONE).is_ok());
    lights.numbers.resize(20_000, 0.0);
    let refused = compose(&lights, &registry, of(model), shading, ALONE).expect_err("too much");
    assert!(refused.to_string().contains("80000 bytes, but a uniform holds 65536"), "{refused}");
    lights.numbers.clear();
    lights.rows = vec![lights.rows[0].clone(); 2000];
    let refused = compose(&lights, &registry, of(model), shading, ALONE).expect_err("too much").to_string();
    assert!(
        refused.starts_with("the lights take ") && refused.contains("a uniform holds 65536"),
        "{refused}"
    );
}

#[test]
fn measured_models_are_refused_by_name() {
    let registry = Registry::builtin();
    let scene = with_lights(&["point"], &registry);
    let shading = registry.shading_model("phong").expect("is");
    for (id, what) in [
        ("measured_table", "the measurements of Measured (table);"),
        ("measured_merl", "the measurement of Measured (MERL);"),
    ] {
        let model = registry.model(id).expect("is");
        let refused = compose(&Lights::of(&scene, &registry), &registry, of(model), shading, ALONE);
        let refused = refused.expect_err("too much").to_string();
        assert!(refused.starts_with(&format!("a uniform does not hold all numbers of {what}")), "{refused}");
    }
}

#[test]
fn the_record_of_a_light_is_the_same_for_all_models_of_a_scene() {
    let mut registry = Registry::builtin();
    let wgsl = registry.model("phong").expect("is").declaration.wgsl;
    // A comment on a Light next to a field with that name.
    let mut text = wgsl.text.to_owned();
    text.push_str("// No Light.\nfn unused_position(f: Corner) -> vec3<f32> { return f.position; }\n");
    text = text.replace("-> Terms {", "-> Terms { var corner: Corner; _ = unused_position(corner);");
    registry.sources_mut().edit(wgsl.path, text);
    let scene = with_lights(&["directional"], &registry);
    let lights = Lights::of(&scene, &registry);
    let shading = registry.shading_model("phong").expect("is");
    let fields = |id: &str| {
        compose(&lights, &registry, of(registry.model(id).expect("is")), shading, ALONE)
            .expect("composed")
            .light_fields
    };
    assert_eq!(fields("phong"), fields("lambert"));
}
