//! A model, a light type and an object type from another crate, registered through the public methods, work
//! everywhere.

use std::path::Path;

use glam::Vec3;
use lights_camera_models::{
    document::{Edit, Selection},
    light::{self, Incident, LightRecord, LightType},
    optics::{
        Frame, TermSelection, Terms,
        colour::{BACKGROUND, Encoding},
    },
    panel::state::{Action, Session},
    parameter::{BASE_COLOUR, Parameter, Value},
    parameters, reference,
    reflection::{self, EquationPart, ReflectionModel, Term},
    registry::{Register, Registry},
    render::capture::gpu::{GpuRenderer, Output},
    scene::{
        Light, Part, Scene, check,
        formats::{Csv, SceneFormat as _, Target},
        load::{self, Defaults},
        save, schema,
    },
    shader::Source,
    shading::{self, Corner, Lighting, ShadingModel, Stage, Varying},
    shape::{self, ObjectType, PolygonMesh, mesh::Polygon},
};

use serde::de::DeserializeSeed as _;
use serde_json::{Value as Json, json};

use crate::{
    helpers::pictures::{close_up, compare, on_gpu},
    window::panels::Bench,
};

const BANDS: Parameter = Parameter::integer("bands", 1..=16, 4).symbol("n").help("How many tones there are.");

parameters! {
    /// Cartoon shading: Lambert in a few tones.
    pub struct Toon {
        /// The colour.
        base_colour: colour = BASE_COLOUR,
        /// The number of tones.
        bands: number = BANDS,
    }
}

impl ReflectionModel for Toon {
    const DECLARATION: reflection::Declaration = reflection::Declaration::new(
        "toon",
        "Toon",
        Source::new(
            "toon.wgsl",
            "fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {\n\
             return Terms(vec3(0.0), ceil(m.bands * max(dot(frame.n, l), 0.0)) / m.bands * m.base_colour, vec3(0.0)); }\n\
             fn ambient_response(v: vec3<f32>, frame: Frame, m: Parameters) -> vec3<f32> { return m.base_colour; }\n",
        ),
    )
    .summary("Lambert in a few tones.")
    .equation(&[EquationPart::new(Term::Diffuse, "I_d = ceil(n max(0, N·L)) C_b / n")])
    .non_negative();

    fn response(&self, l: Vec3, _v: Vec3, frame: &Frame) -> Terms {
        let tone = (self.bands * frame.n.dot(l).max(0.0)).ceil() / self.bands;
        Terms { diffuse: tone * self.base_colour, ..Terms::default() }
    }

    fn ambient_response(&self, _v: Vec3, _frame: &Frame) -> Vec3 {
        self.base_colour
    }
}

const CEILING: Parameter =
    Parameter::number("ceiling", 1.0..=100.0, 10.0).symbol("h").unit("m").help("The height of full light.");
const ZENITH: Parameter = Parameter::colour("zenith", [90, 160, 255]).help("The colour from above.");
const HAZE: Parameter =
    Parameter::triple("haze", 0.0..=1.0, [0.2, 0.1, 0.05]).help("The light at the floor.");
const PROFILE: Parameter =
    Parameter::choice("profile", &[("smooth", "Smooth"), ("steps", "In steps")], 0).help("How it grows.");
const STEPS: Parameter =
    Parameter::integer("steps", 1..=16, 3).help("How many steps.").used_when("profile", &["steps"]);
const UPSIDE_DOWN: Parameter =
    Parameter::flag("upside_down", false).label("upside down").help("Stronger at the bottom instead.");

parameters! {
    /// A light that is stronger at the top of the room, with a parameter of every type.
    struct Skylight {
        ceiling: number = CEILING,
        zenith: colour = ZENITH,
        haze: triple = HAZE,
        profile: choice = PROFILE,
        steps: number = STEPS,
        upside_down: flag = UPSIDE_DOWN,
    }
}

impl LightType for Skylight {
    const DECLARATION: light::Declaration = light::Declaration::new(
        "sky_light",
        "Skylight",
        Source::new(
            "skylight.wgsl",
            "fn incident_sky_light(light: Light, m: SkyLightParameters, p: vec3<f32>) -> Incident {
                 var share = p.y / m.ceiling;
                 if m.profile == 1u { share = ceil(share * m.steps) / m.steps; }
                 if m.upside_down == 1u { share = abs(1.0 - share); }
                 let colour = share * m.zenith + m.haze;
                 return Incident(vec3(0.0, 1.0, 0.0), light.intensity * colour, 0u);
             }\n",
        ),
    )
    .summary("Stronger at the top.")
    .glyph("s")
    .equation("I(p) = I y / h");

    fn incident(&self, light: &LightRecord, p: Vec3) -> Incident {
        let share = p.y / self.ceiling;
        let share = if self.profile == 1 { (share * self.steps).ceil() / self.steps } else { share };
        let share = if self.upside_down { (1.0 - share).abs() } else { share };
        Incident::From { l: Vec3::Y, intensity: light.intensity * (share * self.zenith + self.haze) }
    }
}

/// The extents of a brick.
const EXTENTS: Parameter =
    Parameter::triple("extents", 0.1..=1.0, [1.0, 0.5, 0.7]).symbol("e").help("A parameter.");
/// The shape of the top.
const TOP: Parameter =
    Parameter::choice("top", &[("flat", "Flat"), ("roof", "Roof")], 0).symbol("").help("A parameter.");
/// The height of a roof.
const PITCH: Parameter =
    Parameter::number("pitch", 0.1..=1.0, 0.5).symbol("p").help("A parameter.").used_when("top", &["roof"]);
/// Number of copies, on top of each other.
const COURSES: Parameter = Parameter::integer("courses", 1..=4, 1).symbol("c").help("A parameter.");
/// The lean, in which only the red channel counts.
const LEAN: Parameter = Parameter::colour("lean", [0; 3]).symbol("l").unit("").help("A parameter.");

parameters! {
    /// Bricks with parameters of every kind.
    struct Bricks {
        extents: triple = EXTENTS,
        top: choice = TOP,
        pitch: number = PITCH,
        courses: number = COURSES,
        lean: colour = LEAN,
    }
}

impl ObjectType for Bricks {
    const DECLARATION: shape::Declaration =
        shape::Declaration::new("bricks", "Bricks").summary("A pile of bricks.").glyph("▲");

    fn mesh(&self, _: u32) -> PolygonMesh {
        let Vec3 { x, y, z } = self.extents;
        let height = y * self.courses;
        let ridge = if self.top == 1 { self.pitch * y } else { 0.0 };
        let lean = Vec3::X * self.lean.x;
        let mut mesh = PolygonMesh {
            positions: vec![
                Vec3::ZERO,
                Vec3::X * x,
                Vec3::new(x, 0.0, -z),
                Vec3::Z * -z,
                Vec3::Y * height + lean,
                Vec3::new(x, height, 0.0) + lean,
                Vec3::new(x, height + ridge, -z) + lean,
                Vec3::new(0.0, height + ridge, -z) + lean,
            ],
            polygons: vec![
                Polygon::quad(0, 3, 2, 1),
                Polygon::quad(4, 5, 6, 7),
                Polygon::quad(0, 1, 5, 4),
                Polygon::quad(1, 2, 6, 5),
                Polygon::quad(2, 3, 7, 6),
                Polygon::quad(3, 0, 4, 7),
            ],
        };
        mesh.normalise();
        mesh
    }
}

const ORDER: Parameter =
    Parameter::choice("order", &[("first", "First"), ("last", "Last")], 0).symbol("").help("A parameter.");
const STRENGTH: Parameter = Parameter::number("strength", 0.0..=1.0, 0.2).symbol("s").help("A parameter.");
const TINT: Parameter =
    Parameter::triple("tint", 0.0..=2.0, [1.0, 0.8, 0.6]).symbol("t").help("A parameter.");
const WARM: Parameter = Parameter::colour("warm", [200, 120, 30]).symbol("w").help("A parameter.");
const TIMES: Parameter = Parameter::integer("times", 1..=4, 1).symbol("n").help("A parameter.");

parameters! {
    /// Gouraud shading, tinted, with parameters of every type that shading models may have.
    struct Tinted {
        order: choice = ORDER,
        strength: number = STRENGTH,
        tint: triple = TINT,
        warm: colour = WARM,
        times: number = TIMES,
    }
}

impl ShadingModel for Tinted {
    const DECLARATION: shading::Declaration = shading::Declaration::new(
        "tinted",
        "Tinted",
        Stage::Vertex,
        'N',
        Source::new(
            "tinted.wgsl",
            "fn shade_vertex(corner: Corner) -> Varying {
                 let colour = illuminate(corner.position, corner.normal, corner.tangent) * shading_parameters().tint;
                 return Varying(corner.position, corner.normal, corner.tangent, colour, vec3(0.0));
             }
             fn shade_pixel(passed: Varying) -> vec3<f32> {
                 let m = shading_parameters();
                 let added = m.strength * m.warm;
                 if m.order == 1u { return m.times * passed.colour + added; }
                 return m.times * (passed.colour + added);
             }\n",
        ),
    )
    .summary("Gouraud shading, tinted.");

    fn vertex(&self, lighting: &dyn Lighting, corner: &Corner) -> Varying {
        let Corner { position, normal, tangent, .. } = *corner;
        let colour = lighting.colour(position, normal, tangent) * self.tint;
        Varying { position, normal, tangent, colour }
    }

    fn pixel(&self, _: &dyn Lighting, varying: &Varying, _: Vec3) -> Vec3 {
        let added = self.strength * self.warm;
        match self.order {
            1 => self.times * varying.colour + added,
            _ => self.times * (varying.colour + added),
        }
    }
}

fn register(to: &mut impl Register) {
    to.add_reflection_model::<Toon>();
    to.add_shading_model::<Tinted>();
    to.add_light_type::<Skylight>();
    to.add_object_type::<Bricks>();
}

fn scene() -> Scene {
    let mut scene = close_up("sphere", "point");
    scene.objects[0].object_type = "bricks".to_owned();
    scene.reflection_model = "toon".to_owned();
    scene.shading_model = "flat".to_owned();
    scene.lights.push(Light {
        light_type: "sky_light".to_owned(),
        position: None,
        intensity: 0.5,
        ..Light::default()
    });
    scene
}

fn registry() -> Registry {
    let mut registry = Registry::builtin();
    register(&mut registry);
    registry
}

fn renderer() -> GpuRenderer {
    GpuRenderer::extended(64, 64, 1, Output::Linear, register).expect("software Vulkan is installed")
}

/// True if the CPU renderer draws a scene as the GPU did.
fn alike(gpu: &[Vec3], scene: &Scene) -> bool {
    let settings = reference::Settings { width: 64, height: 64, samples: 1, terms: TermSelection::All };
    let cpu = reference::render(scene, &registry(), &settings);
    let d = compare(gpu, &cpu, Encoding::Srgb.decode(BACKGROUND), 1e-3);
    assert!(d.covered > 300, "{d:?}");
    d.wrong == 0 && d.edges * 20 <= d.covered
}

#[test]
fn a_custom_model_light_and_shape_are_drawn_alike_by_both_renderers() {
    let mut renderer = renderer();
    assert!(alike(&on_gpu(&mut renderer, &scene()), &scene()));
}

#[test]
fn every_type_of_parameter_of_a_light_reaches_both_renderers() {
    let mut renderer = renderer();
    let mut scene = scene();
    let values = [
        ("ceiling", Value::Number(7.0)),
        ("zenith", Value::Colour([250, 40, 120])),
        ("haze", Value::Triple([0.05, 0.6, 0.3])),
        ("profile", Value::Choice("steps".into())),
        ("steps", Value::Integer(9)),
        ("upside_down", Value::flag(true)),
    ];
    let mut shown = on_gpu(&mut renderer, &scene);
    for (name, value) in values {
        scene.lights[1].parameters.set(name, value);
        // The wrong twin: the picture before the change.
        assert!(!alike(&shown, &scene), "a change of {name} goes unnoticed");
        shown = on_gpu(&mut renderer, &scene);
        assert!(alike(&shown, &scene), "{name}");
    }
    // The type is a component with its parameters.
    let world = renderer.app().world_mut();
    let lights: Vec<_> = world.query::<&Skylight>().iter(world).copied().collect();
    let zenith = Encoding::Srgb.decode([250, 40, 120]);
    assert_eq!(
        lights,
        [Skylight {
            ceiling: 7.0,
            zenith,
            haze: Vec3::new(0.05, 0.6, 0.3),
            profile: 1,
            steps: 9.0,
            upside_down: true
        }]
    );
}

#[test]
fn lights_whose_parameters_outgrow_the_buffer_are_drawn() {
    let mut renderer = renderer();
    let mut scene = scene();
    assert!(alike(&on_gpu(&mut renderer, &scene), &scene));
    let other = scene.clone();
    for i in 0..250_u8 {
        let mut light = Light { intensity: 0.01, ..scene.lights[1].clone() };
        light.parameters.set("zenith", Value::Colour([i, 255 - i, i / 2]));
        scene.lights.push(light);
    }
    let shown = on_gpu(&mut renderer, &scene);
    assert!(alike(&shown, &scene));
    // The wrong twin: another colour only for the last one.
    let mut wrong = scene.clone();
    wrong.lights[251].parameters.set("zenith", Value::Colour([255; 3]));
    wrong.lights[251].intensity = 0.05;
    assert!(!alike(&shown, &wrong));
    assert!(alike(&on_gpu(&mut renderer, &other), &other), "and fewer again");
}

#[test]
fn parameters_of_a_light_are_read_checked_written_and_in_the_schema() {
    let registry = registry();
    let mut scene = scene();
    scene.lights[1].parameters.set("zenith", Value::Colour([1, 2, 3]));
    scene.lights[1].parameters.set("haze", Value::Triple([0.5; 3]));
    scene.lights[1].parameters.set("steps", Value::Integer(2));
    scene.lights[1].parameters.set("profile", Value::Choice("steps".into()));
    scene.lights[1].parameters.set("upside_down", Value::flag(true));
    let text = save::to_json(&scene, None, &registry);
    let read = |text: &str| load::from_text(text, "scene.json", &registry, Defaults::Refuse);
    assert_eq!(read(&text).map(|loaded| loaded.scene.lights).ok(), Some(scene.lights));
    for (right, wrong, message) in [
        ("\"zenith\": [1, 2, 3]", "\"zenith\": [1, 2, 300]", "zenith"),
        ("\"haze\": [0.5, 0.5, 0.5]", "\"haze\": [0.5, 0.5, 1.5]", "between 0 and 1"),
        ("\"steps\": 2", "\"steps\": 2.5", "a whole number between 1 and 16"),
        ("\"profile\": \"steps\"", "\"profile\": \"step\"", "did you mean \"steps\"?"),
        (
            "\"upside_down\": true",
            "\"upside_down\": \"true\"",
            "lights[1].upside_down is \"true\", but upside_down must be true or false, without quotes",
        ),
        (
            "\"upside_down\": true",
            "\"upside_down\": \"yes\"",
            "lights[1].upside_down is \"yes\", but upside_down must be true or false",
        ),
        (
            "\"upside_down\": true",
            "\"upside_down\": 1",
            "lights[1].upside_down is 1, but upside_down must be true or false",
        ),
        ("\"steps\": 2", "\"cone_angle\": 2", "is given, but a sky_light light has no cone_angle"),
    ] {
        assert!(text.contains(right), "{right} in {text}");
        let Err(problem) = read(&text.replace(right, wrong)) else { panic!("{wrong} is legal") };
        let said = problem.to_string();
        assert!(said.contains(message), "{said}");
        assert_eq!(said.contains("without quotes"), wrong.ends_with("\"true\""), "{said}");
    }
    let schema = schema::text(&registry);
    for name in ["ceiling", "zenith", "haze", "profile", "steps", "upside_down"] {
        assert!(schema.contains(&format!("\"{name}\": {{")), "{name}");
    }
}

#[test]
fn a_flag_is_a_boolean_in_files() {
    let registry = registry();
    let with = |value: Value| {
        let mut scene = scene();
        scene.lights[1].parameters.set("upside_down", value);
        scene
    };
    let schema = jsonschema::draft202012::new(&schema::schema(&registry)).expect("a valid schema");
    for on in [false, true] {
        let scene = with(Value::flag(on));
        let text = save::to_json(&scene, None, &registry);
        let mut json: Json = serde_json::from_str(&text).expect("JSON");
        assert_eq!(json["lights"][1]["upside_down"], Json::Bool(on));
        assert!(schema.is_valid(&json));
        let target = Target::new(Path::new(""), None);
        let table = Csv.writer().expect("it writes").write(&scene, &target, &registry).expect("written");
        let table = String::from_utf8(table).expect("text");
        let back = load::from_text(&table, "room.csv", &registry, Defaults::Refuse).expect("legal");
        assert_eq!(back.scene.lights, scene.lights, "{table}");
        assert_eq!((&UPSIDE_DOWN).deserialize(Json::Bool(on)).expect("legal"), Value::flag(on));
        json["lights"][1]["upside_down"] = on.to_string().into();
        assert!(!schema.is_valid(&json), "the wrong twin: text");
        assert!((&UPSIDE_DOWN).deserialize(Json::from(on.to_string())).is_err());
    }
    let wrong = check::scene(&with(Value::Choice("maybe".into())), &registry);
    assert_eq!(
        wrong.iter().map(ToString::to_string).collect::<Vec<_>>(),
        ["lights[1].upside_down is \"maybe\", but upside_down must be true or false"]
    );
}

#[test]
fn a_flag_has_a_checkbox() {
    let mut bench = Bench::with_registry(Session::new(scene()), registry());
    bench.apply(Action::Select(Selection::Light(1)));
    let flag = |b: &Bench| b.session.document.lights[1].parameters.get(&UPSIDE_DOWN);
    let seen = bench.find("upside down").expect("a checkbox").rect;
    bench.hover(seen.center());
    assert!(bench.says("Stronger at the bottom instead."));
    for on in [true, false] {
        bench.click("upside down");
        assert_eq!(flag(&bench), Value::flag(on));
    }
    bench.apply(Action::Undo);
    assert_eq!(flag(&bench), Value::flag(true));
}

#[test]
fn every_type_of_parameter_of_a_shape_reaches_both_renderers() {
    let registry = registry();
    let mut renderer =
        GpuRenderer::extended(64, 64, 1, Output::Linear, register).expect("software Vulkan is installed");
    let mut pictures = Vec::new();
    for (name, value) in [
        ("top", Value::Choice("flat".into())),
        ("extents", Value::Triple([0.3, 1.0, 0.3])),
        ("courses", Value::Integer(3)),
        ("lean", Value::Colour([200, 0, 0])),
        ("top", Value::Choice("roof".into())),
        ("pitch", Value::Number(1.0)),
    ] {
        let mut scene = scene();
        if name == "pitch" {
            scene.objects[0].shape.set("top", Value::Choice("roof".into()));
        }
        scene.objects[0].shape.set(name, value);
        let gpu = on_gpu(&mut renderer, &scene);
        let settings = reference::Settings { width: 64, height: 64, samples: 1, terms: TermSelection::All };
        let cpu = reference::render(&scene, &registry, &settings);
        let d = compare(&gpu, &cpu, Encoding::Srgb.decode(BACKGROUND), 1e-3);
        assert!(d.covered > 200 && d.wrong == 0 && d.edges * 20 <= d.covered, "{name}: {d:?}");
        assert!(!pictures.contains(&gpu), "{name} changes nothing");
        pictures.push(gpu);
    }
}

/// The scene as a file, with parameters of the bricks.
fn file(parameters: Json) -> String {
    let mut file: Json = serde_json::from_str(&save::to_json(&scene(), None, &registry())).expect("JSON");
    let object = file["objects"][0].as_object_mut().expect("an object");
    object.extend(parameters.as_object().cloned().unwrap_or_default());
    file.to_string()
}

#[test]
fn parameters_of_every_kind_stand_in_files_of_scenes() {
    let registry = registry();
    let schema = jsonschema::draft202012::new(&schema::schema(&registry)).expect("a valid schema");
    let read = |text: &str| load::from_text(text, "scene.json", &registry, Defaults::Refuse);
    let valid = |text: &str| schema.is_valid(&serde_json::from_str(text).expect("JSON"));
    let all =
        json!({ "extents": [0.2, 0.4, 1], "top": "roof", "pitch": 0.25, "courses": 2, "lean": [9, 8, 7] });
    let text = file(all.clone());
    let scene = read(&text).expect("legal").scene;
    assert_eq!(scene.objects[0].shape.0.len(), 5);
    assert!(valid(&text));
    let saved = save::to_json(&scene, None, &registry);
    let written: Json = serde_json::from_str(&saved).expect("JSON");
    for (key, value) in all.as_object().expect("an object") {
        let numbers = |v: &Json| v.to_string().replace(".0", "");
        assert_eq!(numbers(&written["objects"][0][key]), numbers(value), "{key}");
    }
    assert_eq!(read(&saved).expect("legal").scene, scene);
    // One number for all three.
    assert_eq!(
        read(&file(json!({ "extents": 0.5 }))).expect("legal").scene.objects[0].shape.0["extents"],
        Value::Triple([0.5; 3])
    );
    for (parameters, message) in [
        (json!({ "extents": [1, 2, 1] }), "objects[0].extents is [1, 2, 1], but it must be three numbers"),
        (json!({ "extents": [1, 1] }), "objects[0].extents is [1, 1], but it must be three numbers"),
        (json!({ "top": "rof" }), "but it must be one of \"flat\", \"roof\"; did you mean \"roof\"?"),
        (json!({ "top": 1 }), "objects[0].top is 1, but it must be one of \"flat\", \"roof\""),
        (json!({ "pitch": 2 }), "objects[0].pitch is 2, but it must be between 0.1 and 1"),
        (json!({ "courses": 1.5 }), "but it must be a whole number between 1 and 4"),
        (
            json!({ "lean": [256, 0, 0] }),
            "objects[0].lean[0] is 256, but the lean must be three whole numbers",
        ),
        (json!({ "tube_radius": 0.1 }), "objects[0].tube_radius is given, but a bricks has no tube_radius"),
        (json!({ "cuorses": 1 }), "objects[0].cuorses is not a key of an object; did you mean \"courses\"?"),
    ] {
        let text = file(parameters);
        let said = read(&text).expect_err("illegal").to_string();
        assert!(said.contains(message), "{said}");
        assert!(!valid(&text), "{text}");
    }
}

#[test]
fn parameters_of_every_kind_have_knobs() {
    let mut bench = Bench::with_registry(Session::new(scene()), registry());
    bench.apply(Action::Select(Selection::Object(0)));
    let shape = |b: &Bench| b.session.document.objects[0].shape.clone();
    for (field, text, name, value) in [
        ("courses", "3", "courses", Value::Integer(3)),
        ("extents R", "0.3", "extents", Value::Triple([0.3, 0.5, 0.7])),
    ] {
        bench.type_into(field, text);
        assert_eq!(shape(&bench).0.get(name), Some(&value));
    }
    assert!(bench.field("lean in hexadecimal").rect.is_positive());
    let pitch = bench.field("pitch");
    assert!(pitch.disabled, "the top is flat");
    bench.hover(pitch.rect.center());
    assert!(bench.says("Not used with Flat: only Roof has p"));
    bench.apply(Action::Edit(Edit::parameter(Part::Object(0), "top", Value::Choice("roof".into()))));
    assert!(!bench.field("pitch").disabled);
    bench.type_into("pitch", "0.75");
    assert_eq!(shape(&bench).0.get("pitch"), Some(&Value::Number(0.75)));
    let registry = registry();
    assert_eq!(check::scene(&bench.session.document, &registry), []);
}

#[test]
fn every_type_of_parameter_of_a_shading_model_reaches_both_renderers() {
    let registry = registry();
    // The parameters are in rows of different layouts: with a curve and without, and with three harmonics.
    let curved = |anisotropic| {
        let mut all = registry.models().iter();
        all.find(|m| m.has_curve() && m.declaration.anisotropic == anisotropic).expect("one").declaration.id
    };
    let mut renderer = renderer();
    for model in ["lambert", curved(false), curved(true)] {
        let mut scene = close_up("sphere", "point");
        scene.reflection_model = model.to_owned();
        scene.shading_model = "tinted".to_owned();
        let mut shown = on_gpu(&mut renderer, &scene);
        assert!(alike(&shown, &scene), "{model}");
        for (name, value) in [
            ("order", Value::Choice("last".into())),
            ("strength", Value::Number(0.7)),
            ("tint", Value::Triple([0.3, 1.0, 2.0])),
            ("warm", Value::Colour([10, 90, 250])),
            ("times", Value::Integer(3)),
        ] {
            scene.objects[0].material.set(name, value);
            // The wrong twin: the picture before the change.
            assert!(name == "order" || !alike(&shown, &scene), "{model}: a change of {name} goes unnoticed");
            shown = on_gpu(&mut renderer, &scene);
            assert!(alike(&shown, &scene), "{model}: {name}");
        }
        let mut wrong = scene.clone();
        wrong.objects[0].material.set("order", Value::Choice("first".into()));
        assert!(!alike(&shown, &wrong), "{model}: order");
    }
}

#[test]
fn objects_of_one_model_may_have_shading_models_with_different_parameters() {
    let mut renderer = renderer();
    let mut scene = scene();
    scene.objects[0].shading_model = Some("tinted".to_owned());
    scene.objects[0].material.set("warm", Value::Colour([0, 255, 0]));
    let mut other = scene.objects[0].clone();
    other.position.x += 1.5;
    other.shading_model = Some("flat".to_owned());
    scene.objects.push(other);
    let shown = on_gpu(&mut renderer, &scene);
    assert!(alike(&shown, &scene));
    scene.objects[1].shading_model = None;
    scene.shading_model = "tinted".to_owned();
    assert!(!alike(&shown, &scene));
    assert!(alike(&on_gpu(&mut renderer, &scene), &scene));
}

#[test]
fn parameters_of_a_shading_model_stand_in_materials_and_have_knobs() {
    let registry = registry();
    let mut scene = scene();
    scene.shading_model = "tinted".to_owned();
    let material =
        json!({ "order": "last", "strength": 0.5, "tint": [1, 2, 0], "warm": [1, 2, 3], "times": 2 });
    let file = |material: &Json| {
        let mut file: Json = serde_json::from_str(&save::to_json(&scene, None, &registry)).expect("JSON");
        file["objects"][0]["material"] = material.clone();
        file.to_string()
    };
    let read = |text: &str| load::from_text(text, "scene.json", &registry, Defaults::Refuse);
    let loaded = read(&file(&material)).expect("legal").scene;
    assert_eq!(loaded.objects[0].material.0.len(), 5);
    assert_eq!(read(&save::to_json(&loaded, None, &registry)).expect("legal").scene, loaded);
    let schema = schema::text(&registry);
    assert!(schema.contains("Used by: Tinted shading."), "{schema}");
    for (key, value, message) in [
        ("strength", json!(2), "objects[0].material.strength is 2, but it must be between 0 and 1"),
        ("times", json!(1.5), "must be a whole number between 1 and 4"),
        ("order", json!("lsat"), "did you mean \"last\"?"),
        ("strenght", json!(1), "did you mean \"strength\"?"),
    ] {
        let mut wrong = material.clone();
        wrong[key] = value;
        let said = read(&file(&wrong)).expect_err("illegal").to_string();
        assert!(said.contains(message), "{said}");
    }
    // With another shading model they are kept, and marked as such.
    let mut bench = Bench::with_registry(Session::new(loaded), registry);
    bench.apply(Action::Select(Selection::Object(0)));
    assert!(bench.says("Tinted shading"));
    bench.type_into("strength", "0.25");
    let strength = |b: &Bench| b.session.document.objects[0].material.0.get("strength").cloned();
    assert_eq!(strength(&bench), Some(Value::Number(0.25)));
    let refused = Edit::material(Part::Object(0), "strength", Value::Number(3.0));
    bench.apply(Action::Edit(refused));
    assert_eq!(strength(&bench), Some(Value::Number(0.25)));
    assert!(!bench.field("strength").disabled);
    bench.apply(Action::Edit(Edit::set(Part::Scene, Scene::shading_model, "flat")));
    assert!(bench.field("strength").disabled);
    assert_eq!(strength(&bench), Some(Value::Number(0.25)));
}

#[test]
fn both_models_of_an_object_limit_a_parameter_that_they_share() {
    const NARROW: Parameter = Parameter::integer("bands", 2..=6, 3).symbol("n").help("A parameter.");
    parameters! {
        /// Allows fewer bands than the reflection model.
        struct Few {
            bands: number = NARROW,
        }
    }
    impl ShadingModel for Few {
        const DECLARATION: shading::Declaration =
            shading::Declaration::new("few", "Few", Stage::Pixel, 'K', Tinted::DECLARATION.wgsl);
        fn vertex(&self, _: &dyn Lighting, _: &Corner) -> Varying {
            Varying::default()
        }
        fn pixel(&self, _: &dyn Lighting, _: &Varying, _: Vec3) -> Vec3 {
            Vec3::splat(self.bands)
        }
    }
    let mut registry = registry();
    registry.add_shading_model::<Few>();
    let mut scene = scene();
    scene.objects[0].material.set("bands", Value::Integer(12));
    let mut bench = Bench::with_registry(Session::new(scene), registry);
    let bands = |b: &Bench| b.session.document.objects[0].material.0["bands"].clone();
    bench.apply(Action::Edit(Edit::set(Part::Scene, Scene::shading_model, "few")));
    assert_eq!(bands(&bench), Value::Integer(6), "the most that both allow");
    assert!(bench.session.messages.iter().any(|m| m.text.contains("bands is now 6 for")));
    for (value, expected) in [(1, 6), (9, 6), (4, 4)] {
        let edit = Edit::material(Part::Object(0), "bands", Value::Integer(value));
        bench.apply(Action::Edit(edit));
        assert_eq!(bands(&bench), Value::Integer(expected), "{value}");
    }
    bench.apply(Action::Undo);
    bench.apply(Action::Undo);
    assert_eq!(bands(&bench), Value::Integer(12));
    assert_eq!(check::scene(&bench.session.document, &bench.registry), []);
}

#[test]
fn a_parameter_that_means_something_else_elsewhere_is_refused() {
    const WRONG: Parameter = Parameter::number("base_colour", 0.0..=1.0, 0.5);
    parameters! {
        /// Uses the name of a colour for a number.
        pub struct Clash {
            /// Not a colour.
            base_colour: number = WRONG,
        }
    }
    impl ReflectionModel for Clash {
        const DECLARATION: reflection::Declaration = Toon::DECLARATION.id("clash");
        fn response(&self, _: Vec3, _: Vec3, _: &Frame) -> Terms {
            Terms::default()
        }
        fn ambient_response(&self, _: Vec3, _: &Frame) -> Vec3 {
            Vec3::splat(self.base_colour)
        }
    }
    let refused = std::panic::catch_unwind(|| {
        Registry::builtin().add_reflection_model::<Clash>();
    });
    assert!(refused.is_err());
}
