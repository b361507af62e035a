//! Errors in types registered by other crates: each is reported with its type, its position and the remedy,
//! before anything is drawn.

use glam::Vec3;
use lights_camera_models::{
    light::{self, Incident, LightRecord, LightType, Size, ies},
    optics::{Frame, Terms},
    parameter::{BASE_COLOUR, K_D, Parameter, Values},
    parameters, reflection,
    reflection::ReflectionModel,
    registry::{Register, RegistrationError, Registry},
    shader::Source,
    shading::{self, Corner, Lighting, ShadingModel, Stage, Varying},
    shape::{self, ObjectType, PolygonMesh, mesh::Polygon},
};

/// White paper.
const PAPER: Source = Source::new(
    "paper.wgsl",
    "fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {
    return Terms(vec3(0.0), vec3(max(dot(frame.n, l), 0.0)), vec3(0.0));
}
fn ambient_response(v: vec3<f32>, frame: Frame, m: Parameters) -> vec3<f32> {
    return vec3(1.0);
}
",
);
const MODEL: reflection::Declaration =
    reflection::Declaration::new("paper", "Paper", PAPER).reciprocal().energy_conserving().non_negative();

/// A model, without its declaration and its parameters.
macro_rules! model {
    ($name:ident, $declaration:expr, { $($field:ident: $kind:ident = $parameter:expr),* }) => {
        parameters! {
            /// White paper.
            struct $name { $( $field: $kind = $parameter ),* }
        }
        impl ReflectionModel for $name {
            const DECLARATION: reflection::Declaration = $declaration;
            fn response(&self, l: Vec3, _: Vec3, frame: &Frame) -> Terms {
                Terms { diffuse: Vec3::splat(frame.n.dot(l).max(0.0)), ..Terms::default() }
            }
            fn ambient_response(&self, _: Vec3, _: &Frame) -> Vec3 {
                Vec3::ONE
            }
        }
    };
}

/// A light type, without its declaration and its parameters.
macro_rules! light {
    ($name:ident, $declaration:expr) => {
        light!($name, $declaration, {});
    };
    ($name:ident, $declaration:expr, { $($field:ident: $kind:ident = $parameter:expr),* }) => {
        parameters! {
            /// Light from above.
            struct $name { $( $field: $kind = $parameter ),* }
        }
        impl LightType for $name {
            const DECLARATION: light::Declaration = $declaration;
            fn incident(&self, light: &LightRecord, _: Vec3) -> Incident {
                Incident::From { l: Vec3::Y, intensity: Vec3::splat(light.intensity) }
            }
        }
    };
}

/// The WGSL of a light from above.
macro_rules! lamp {
    ($id:literal) => {
        Source::new(
            concat!($id, ".wgsl"),
            concat!(
                "fn incident_",
                $id,
                "(light: Light, p: vec3<f32>) -> Incident {\n    return Incident(vec3(0.0, 1.0, 0.0), vec3(light.intensity), 0u);\n}\n"
            ),
        )
    };
}
const LAMP: light::Declaration = light::Declaration::new("lamp", "Lamp", lamp!("lamp"));

/// A shading model, without its declaration.
macro_rules! shading {
    ($name:ident, $declaration:expr) => {
        shading!($name, $declaration, {});
    };
    ($name:ident, $declaration:expr, { $($field:ident: $kind:ident = $parameter:expr),* }) => {
        parameters! {
            /// Interpolated normals.
            struct $name { $( $field: $kind = $parameter ),* }
        }
        impl ShadingModel for $name {
            const DECLARATION: shading::Declaration = $declaration;
            fn vertex(&self, _: &dyn Lighting, corner: &Corner) -> Varying {
                Varying { position: corner.position, normal: corner.normal, ..Varying::default() }
            }
            fn pixel(&self, lighting: &dyn Lighting, varying: &Varying, _: Vec3) -> Vec3 {
                lighting.colour(varying.position, varying.normal.normalize_or_zero(), Vec3::ZERO)
            }
        }
    };
}

const STAGES: &str = "fn shade_vertex(corner: Corner) -> Varying {
    return Varying(corner.position, corner.normal, corner.tangent, vec3(0.0), vec3(0.0));
}
fn shade_pixel(passed: Varying) -> vec3<f32> {
    return illuminate(passed.position, unit_or_zero(passed.normal), vec3(0.0));
}
";
const SHADING: shading::Declaration =
    shading::Declaration::new("plain", "Plain", Stage::Pixel, 'N', Source::new("plain.wgsl", STAGES));

/// An object type, without its declaration and a change of its mesh, a tetrahedron.
macro_rules! shape {
    ($name:ident, $declaration:expr, $change:expr) => {
        parameters! {
            struct $name {}
        }
        impl ObjectType for $name {
            const DECLARATION: shape::Declaration = $declaration;
            fn mesh(&self, tessellation: u32) -> PolygonMesh {
                let mut mesh = tetrahedron();
                let change: fn(&mut PolygonMesh, u32) = $change;
                change(&mut mesh, tessellation);
                mesh
            }
        }
    };
}
const SHAPE: shape::Declaration = shape::Declaration::new("tetrahedron", "Tetrahedron");

fn tetrahedron() -> PolygonMesh {
    let mut mesh = PolygonMesh {
        positions: vec![
            Vec3::new(1.0, 1.0, 1.0),
            Vec3::new(-1.0, -1.0, 1.0),
            Vec3::new(-1.0, 1.0, -1.0),
            Vec3::new(1.0, -1.0, -1.0),
        ],
        polygons: vec![
            Polygon::triangle(0, 2, 1),
            Polygon::triangle(0, 1, 3),
            Polygon::triangle(0, 3, 2),
            Polygon::triangle(1, 2, 3),
        ],
    };
    mesh.normalise();
    mesh
}

/// Asserts that the outcome is an error whose message contains all of these parts, and names type and id.
#[track_caller]
fn refused<T>(
    outcome: Result<&mut Registry, RegistrationError>,
    part: &str,
    id: &str,
    parts: &[&str],
) -> RegistrationError {
    let error = outcome.expect_err("it is wrong");
    let said = error.to_string();
    let begin = format!("{part} `{id}` ({}): ", std::any::type_name::<T>());
    assert!(said.starts_with(&begin), "{said}");
    for part in parts {
        assert!(said.contains(part), "“{part}” is not in: {said}");
    }
    error
}

#[track_caller]
fn model_refused<M: ReflectionModel>(parts: &[&str]) -> RegistrationError {
    let mut registry = Registry::builtin();
    let before = registry.models().len();
    let id = M::DECLARATION.id;
    let error = refused::<M>(registry.try_add_reflection_model::<M>(), "reflection model", id, parts);
    assert_eq!(registry.models().len(), before, "nothing is registered");
    error
}

#[track_caller]
fn light_refused<L: LightType>(parts: &[&str]) -> RegistrationError {
    let mut registry = Registry::builtin();
    refused::<L>(registry.try_add_light_type::<L>(), "light type", L::DECLARATION.id, parts)
}

#[track_caller]
fn shading_refused<S: ShadingModel>(parts: &[&str]) -> RegistrationError {
    let mut registry = Registry::builtin();
    refused::<S>(registry.try_add_shading_model::<S>(), "shading model", S::DECLARATION.id, parts)
}

#[track_caller]
fn shape_refused<T: ObjectType>(parts: &[&str]) -> RegistrationError {
    let mut registry = Registry::builtin();
    refused::<T>(registry.try_add_object_type::<T>(), "object type", T::DECLARATION.id, parts)
}

#[test]
fn what_is_right_is_registered() {
    model!(Good, MODEL, { base_colour: colour = BASE_COLOUR });
    light!(GoodLamp, LAMP);
    shading!(GoodShading, SHADING);
    shape!(GoodShape, SHAPE, |_, _| {});
    let mut registry = Registry::builtin();
    registry
        .try_add_reflection_model::<Good>()
        .and_then(|r| r.try_add_light_type::<GoodLamp>())
        .and_then(|r| r.try_add_shading_model::<GoodShading>())
        .and_then(|r| r.try_add_object_type::<GoodShape>())
        .expect("right");
    assert!(registry.model("paper").is_some() && registry.shape("tetrahedron").is_some());
    assert_eq!(registry.light_index("lamp"), Some(registry.lights().len() as u32 - 1));
}

#[test]
fn ids_and_names_are_identifiers_and_there_once() {
    model!(BadId, MODEL.id("Bad Id!"), {});
    model_refused::<BadId>(&["the id must be lower-case letters", "for example bad_id"]);
    model!(Reserved, MODEL.id("struct"), {});
    model_refused::<Reserved>(&["the id is a reserved word in WGSL or JSON; choose another"]);
    model!(Null, MODEL.id("null"), {});
    model_refused::<Null>(&["the id is a reserved word"]);
    model!(Second, MODEL.id("lambert"), {});
    model_refused::<Second>(&[
        "that id is already used by another reflection model; choose another id, or call replace_reflection_model",
    ]);
    model!(Nameless, reflection::Declaration::new("paper", " ", PAPER), {});
    model_refused::<Nameless>(&["the name is empty"]);
    light!(Hyphen, light::Declaration::new("my-lamp", "My lamp", LAMP.wgsl));
    light_refused::<Hyphen>(&["for example my_lamp"]);
    light!(Point, light::Declaration::new("point", "Point", LAMP.wgsl));
    light_refused::<Point>(&["that id is already used by another light type"]);
    shape!(Cube, shape::Declaration::new("cube", "Cube"), |_, _| {});
    shape_refused::<Cube>(&["that id is already used by another object type"]);
    model!(SamePath, MODEL.wgsl(Source::new("loop.wgsl", PAPER.text)), {});
    model_refused::<SamePath>(&["the path of its shader is \"loop.wgsl\", which is that of another shader"]);
    model!(Elsewhere, MODEL.wgsl(Source::new("../paper.wgsl", PAPER.text)), {});
    model_refused::<Elsewhere>(&["must be a path below the folder of shaders"]);
}

#[test]
fn parameters_have_names_ranges_and_defaults_that_work() {
    model!(Outside, MODEL, { bands: number = Parameter::number("bands", 1.0..=16.0, 20.0) });
    model_refused::<Outside>(&["parameter `bands`: its default is 20, but must be between 1 and 16"]);
    model!(Backwards, MODEL, { bands: number = Parameter::number("bands", 16.0..=1.0, 4.0) });
    model_refused::<Backwards>(&["parameter `bands`: its range is 16 to 1"]);
    model!(Infinite, MODEL, { bands: number = Parameter::number("bands", 0.0..=f32::INFINITY, 4.0) });
    model_refused::<Infinite>(&["must be two finite numbers"]);
    model!(NoSuchChoice, MODEL, { sort: choice = Parameter::choice("sort", &[("a", "A"), ("b", "B")], 2) });
    model_refused::<NoSuchChoice>(&[
        "parameter `sort`: its default is choice 2, but must be an index from 0 to 1",
    ]);
    model!(NoChoice, MODEL, { sort: choice = Parameter::choice("sort", &[], 0) });
    model_refused::<NoChoice>(&["it has no choices"]);
    model!(TwiceChoice, MODEL, { sort: choice = Parameter::choice("sort", &[("a", "A"), ("a", "B")], 0) });
    model_refused::<TwiceChoice>(&["the choice \"a\" is empty or given twice"]);
    model!(Truth, MODEL, { sort: choice = Parameter::choice("sort", &[("a", "A"), ("true", "B")], 0) });
    model_refused::<Truth>(&["the choice \"true\" is a value of flags"]);
    model!(Twice, MODEL, { a: number = Parameter::number("w", 0.0..=1.0, 0.5), b: number = Parameter::number("w", 0.0..=1.0, 0.5) });
    model_refused::<Twice>(&["parameter `w`: is declared twice"]);
    model!(Named, MODEL, { bands: number = Parameter::number("bandCount", 0.0..=1.0, 0.5) });
    model_refused::<Named>(&["parameter `bandCount`: the name must be lower-case", "for example band_count"]);
    model!(Keyword, MODEL, { fill: number = Parameter::number("loop", 0.0..=1.0, 0.5) });
    model_refused::<Keyword>(&["parameter `loop`: the name is a reserved word"]);
    model!(KeyOfObject, MODEL, { size: number = Parameter::number("size", 0.0..=1.0, 0.5) });
    model_refused::<KeyOfObject>(&["parameter `size`: the name is that of another key of an object"]);
    model!(OtherKind, MODEL, { base_colour: number = Parameter::number("base_colour", 0.0..=1.0, 0.5) });
    model_refused::<OtherKind>(&["parameter `base_colour`: is a number, but that of `lambert` is a colour"]);
    model!(When, MODEL, {
        bands: number = Parameter::number("bands", 0.0..=1.0, 0.5).used_when("sort", &["a"])
    });
    model_refused::<When>(&["parameter `bands`: used_when: it must name a parameter of this model"]);
}

/// The WGSL of a light with parameters: those that a light with this id may have.
const DIMMED: Source = Source::new(
    "lamp.wgsl",
    "fn incident_lamp(light: Light, m: LampParameters, p: vec3<f32>) -> Incident {
    return Incident(vec3(0.0, 1.0, 0.0), vec3(m.dimmed * light.intensity), 0u);
}
",
);
const DIMMED_BY: Parameter = Parameter::number("dimmed", 0.0..=1.0, 0.5);

#[test]
fn parameters_of_light_types_fit_and_their_cone_is_a_number() {
    const fn triple(name: &'static str) -> Parameter {
        Parameter::triple(name, 0.0..=1.0, [0.5; 3])
    }
    light!(Wide, LAMP, {
        aa: triple = triple("aa"), bb: triple = triple("bb"), cc: triple = triple("cc"), dd: triple = triple("dd"),
        ee: triple = triple("ee"), ff: triple = triple("ff"), gg: triple = triple("gg"), hh: triple = triple("hh"),
        ii: triple = triple("ii"), jj: triple = triple("jj"), kk: triple = triple("kk"), ll: triple = triple("ll"),
        mm: triple = triple("mm"), nn: triple = triple("nn"), oo: triple = triple("oo"), pp: triple = triple("pp"),
        qq: triple = triple("qq")
    });
    light_refused::<Wide>(&["its parameters take 268 bytes, but at most 256 fit"]);
    light!(Coloured, LAMP.cone("zenith"), { zenith: colour = Parameter::colour("zenith", [0; 3]) });
    light_refused::<Coloured>(&["its cone is parameter `zenith`, but must be a parameter of type number"]);
    light!(Coneless, LAMP.cone("cone_angle"));
    light_refused::<Coneless>(&[
        "its cone is parameter `cone_angle`, but must be a parameter of type number",
    ]);
    light!(OtherCone, LAMP, { cone_angle: colour = Parameter::colour("cone_angle", [0; 3]) });
    light_refused::<OtherCone>(&[
        "parameter `cone_angle`: is a colour, but that of `spot` is a number; light types share parameters by name",
    ]);
    light!(Sizeless, LAMP.at_position().sizes(&[Size::Radius("zenith")]), {
        zenith: colour = Parameter::colour("zenith", [0; 3])
    });
    light_refused::<Sizeless>(&["its size is parameter `zenith`, but must be a parameter of type number"]);
    light!(Rolled, LAMP.at_position().with_direction().roll("tilt"));
    light_refused::<Rolled>(&["its roll is parameter `tilt`, but must be a parameter of type number"]);
    light!(Nowhere, LAMP.sizes(&[Size::Radius("dimmed")]), { dimmed: number = DIMMED_BY });
    light_refused::<Nowhere>(&["it has sizes, but no position around which they lie"]);
    light!(Undirected, LAMP.at_position().sizes(&[Size::Width("dimmed")]), { dimmed: number = DIMMED_BY });
    light_refused::<Undirected>(&["`dimmed` is measured by its direction, but it has none"]);
    light!(KeyOfLight, LAMP, { intensity: number = Parameter::number("intensity", 0.0..=1.0, 0.5) });
    light_refused::<KeyOfLight>(&["parameter `intensity`: the name is that of another key of a light"]);
    light!(Without, LAMP, { dimmed: number = DIMMED_BY });
    light_refused::<Without>(&[
        "incident_lamp must be fn incident_lamp(light: Light, m: LampParameters, p: vec3<f32>)",
    ]);
    light!(Right, light::Declaration::new("lamp", "Lamp", DIMMED).factor(1.0, 5.0).cone("dimmed"), {
        dimmed: number = DIMMED_BY
    });
    let mut registry = Registry::builtin();
    registry.try_add_light_type::<Right>().expect("right");
    let entry = registry.light("lamp").expect("registered");
    assert_eq!((entry.declaration.unit, entry.cone_angle(&Values::default())), ("×", Some(0.5)));
}

#[test]
fn files_are_not_for_shading_models_and_their_defaults_are_shipped() {
    const WEB: Parameter = Parameter::file("web", &ies::FORMAT, "wall_washer.ies");
    light!(Lost, LAMP, { web: file = Parameter::file("web", &ies::FORMAT, "lost.ies") });
    light_refused::<Lost>(&[
        "parameter `web`: its default is the file \"lost.ies\", but must be one that its format ships",
    ]);
    parameters! {
        struct OfShape { web: file = WEB }
    }
    impl ObjectType for OfShape {
        const DECLARATION: shape::Declaration = SHAPE;
        fn mesh(&self, _: u32) -> PolygonMesh {
            tetrahedron()
        }
    }
    let mut registry = Registry::builtin();
    registry.try_add_object_type::<OfShape>().expect("an object type may have files");
    shading!(OfShading, SHADING, { web: file = WEB });
    shading_refused::<OfShading>(&["parameter `web`: is a file, which shading models may not have"]);
    const READING: Source = Source::new(
        "lamp.wgsl",
        "fn incident_lamp(light: Light, m: LampParameters, p: vec3<f32>) -> Incident {
    return Incident(vec3(0.0, 1.0, 0.0), vec3(illumination_number(m.web) * light.intensity), 0u);
}
",
    );
    light!(Reading, light::Declaration::new("lamp", "Lamp", READING), { web: file = WEB });
    assert!(Registry::builtin().try_add_light_type::<Reading>().is_ok());
    const PRINTED: Source = Source::new(
        "printed.wgsl",
        "fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {
    return Terms(vec3(0.0), vec3(bitcast<f32>(file_word(m.web))), vec3(0.0));
}
fn ambient_response(v: vec3<f32>, frame: Frame, m: Parameters) -> vec3<f32> {
    return vec3(1.0);
}
",
    );
    const OTHER: Parameter = Parameter::file("other", &ies::FORMAT, "wall_washer.ies");
    model!(Printed, MODEL.wgsl(PRINTED), { web: file = WEB });
    let mut registry = Registry::builtin();
    registry.try_add_reflection_model::<Printed>().expect("a reflection model may have a file");
    model!(TwoFiles, MODEL.wgsl(PRINTED), { web: file = WEB, other: file = OTHER });
    model_refused::<TwoFiles>(&["parameter `other`: is a file, but a reflection model may have only one"]);
}

#[test]
fn the_schema_has_the_label_and_the_help_of_every_model_that_has_a_parameter() {
    const TILT: Parameter = Parameter::number("tilt", 0.0..=1.0, 0.5).symbol("t");
    model!(First, MODEL, { tilt: number = TILT.label("lean").help("How far it leans.") });
    const fn second() -> reflection::Declaration {
        reflection::Declaration::new("second", "Second", MODEL.wgsl)
    }
    model!(Second, second(), { tilt: number = TILT.label("slope").help("How steep it is.") });
    let mut registry = Registry::builtin();
    registry.try_add_reflection_model::<First>().expect("right");
    registry.try_add_reflection_model::<Second>().expect("other words");
    let schema = lights_camera_models::scene::schema::schema(&registry);
    let field = &schema["properties"]["objects"]["items"]["properties"]["material"]["properties"]["tilt"];
    assert_eq!(field["title"], "lean (t) in paper; slope (t) in second");
    let said = field["description"].as_str().expect("described");
    assert!(said.starts_with("paper: How far it leans. second: How steep it is. Used by: "), "{said}");
}

#[test]
fn parameters_of_one_name_have_one_unit_and_the_schema_says_every_range() {
    const TILT: Parameter = Parameter::number("tilt", 0.0..=1.0, 0.5);
    model!(First, MODEL, { tilt: number = TILT });
    const fn second() -> reflection::Declaration {
        reflection::Declaration::new("second", "Second", MODEL.wgsl)
    }
    let mut registry = Registry::builtin();
    registry.try_add_reflection_model::<First>().expect("right");
    model!(InDegrees, second(), { tilt: number = TILT.unit("°") });
    shading!(Shading, SHADING, { tilt: number = TILT.unit("m") });
    let refused = |result: Result<(), RegistrationError>, expected: &str| {
        let said = result.expect_err(expected).what;
        assert!(said.contains(expected) && said.contains("models share parameters by name"), "{said}");
    };
    let added = registry.try_add_reflection_model::<InDegrees>().map(drop);
    refused(added, "parameter `tilt`: is in °, but that of `paper` is without a unit");
    let added = registry.try_add_shading_model::<Shading>().map(drop);
    refused(added, "parameter `tilt`: is in m, but that of `paper` is without a unit");

    model!(Wider, second(), { tilt: number = Parameter::number("tilt", 0.0..=90.0, 45.0) });
    registry.try_add_reflection_model::<Wider>().expect("another range and default");
    let schema = lights_camera_models::scene::schema::schema(&registry);
    let object = &schema["properties"]["objects"]["items"];
    let field = &object["properties"]["material"]["properties"]["tilt"];
    let said = field["description"].as_str().expect("described");
    assert!(said.contains("It is between 0 and 1 in paper; between 0 and 90 in second."), "{said}");
    assert!(said.ends_with("By default 0.5 in paper; 45 in second."), "{said}");
    assert!(field.get("default").is_none() && field.get("maximum").is_none(), "neither of them: {field}");
    assert_eq!(field["anyOf"][1]["maximum"], 90);
    let own: Vec<_> = object["allOf"]
        .as_array()
        .expect("conditions")
        .iter()
        .map(|c| {
            let maximum = &c["then"]["properties"]["material"]["properties"]["tilt"]["maximum"];
            (
                c["if"]["properties"]["reflection_model"]["const"].as_str().unwrap_or_default(),
                maximum.as_f64(),
            )
        })
        .filter(|(_, maximum)| maximum.is_some())
        .collect();
    assert_eq!(own, [("paper", Some(1.0)), ("second", Some(90.0))]);
}

#[test]
fn a_label_is_asked_for() {
    model!(Raw, MODEL, { fur: number = Parameter::number("fur_length", 0.0..=1.0, 0.5) });
    model_refused::<Raw>(&[
        "parameter `fur_length`: has no label for people to read; add .label(\"fur length\")",
    ]);
    light!(RawLamp, LAMP, { fur: number = Parameter::number("fur_length", 0.0..=1.0, 0.5) });
    light_refused::<RawLamp>(&["parameter `fur_length`: has no label"]);
}

#[test]
fn shading_models_have_a_key_of_their_own() {
    const fn keyed(key: char) -> shading::Declaration {
        shading::Declaration::new("plain", "Plain", Stage::Pixel, key, SHADING.wgsl)
    }
    shading!(Lower, keyed('n'));
    shading_refused::<Lower>(&["its key is 'n', but must be a letter from A to Z"]);
    shading!(OfPhong, keyed('P'));
    shading_refused::<OfPhong>(&["its key is 'P', which is that of `phong`; choose another"]);
    shading!(OfWindow, keyed('H'));
    let said = shading_refused::<OfWindow>(&["its key is 'H', which the window uses already"]).what;
    let free = said.rsplit("available are ").next().unwrap_or_default();
    assert!(free.contains('N') && !free.contains(['P', 'H', 'T', 'D']), "{said}");
}

#[test]
fn parameters_of_shading_models_fit_and_agree_with_those_of_reflection_models() {
    const STEPS: Parameter = Parameter::integer("steps", 1..=8, 4);
    const WITH_STEPS: &str = "fn shade_vertex(corner: Corner) -> Varying {
    return Varying(corner.position, corner.normal, corner.tangent, vec3(shading_parameters().steps), vec3(0.0));
}
fn shade_pixel(passed: Varying) -> vec3<f32> {
    return passed.colour;
}
";
    const MISSPELT: &str = "fn shade_vertex(corner: Corner) -> Varying {
    return Varying(corner.position, corner.normal, corner.tangent, vec3(0.0), vec3(0.0));
}
fn shade_pixel(passed: Varying) -> vec3<f32> {
    return passed.colour * shading_parameters().stpes;
}
";
    const fn with(text: &'static str) -> shading::Declaration {
        shading::Declaration::new("plain", "Plain", Stage::Pixel, 'N', Source::new("plain.wgsl", text))
    }
    shading!(Right, with(WITH_STEPS), { steps: number = STEPS });
    let mut registry = Registry::builtin();
    assert!(registry.try_add_shading_model::<Right>().is_ok());
    assert!(registry.material_parameter("steps").is_some());
    shading!(Misspelt, with(MISSPELT), { steps: number = STEPS });
    shading_refused::<Misspelt>(&["plain.wgsl:5:", "stpes"]);
    const COLOUR_AS_NUMBER: Parameter = Parameter::number("base_colour", 0.0..=1.0, 0.5);
    shading!(Clash, with(STAGES), { base_colour: number = COLOUR_AS_NUMBER });
    shading_refused::<Clash>(&["parameter `base_colour`: is a number, but that of `lambert` is a colour"]);
    const POSITION: Parameter = Parameter::number("position", 0.0..=1.0, 0.5);
    shading!(Reserved, with(STAGES), { position: number = POSITION });
    shading_refused::<Reserved>(&["parameter `position`", "that of another key of an object"]);
    const A: Parameter = Parameter::colour("a", [0; 3]);
    const B: Parameter = Parameter::colour("b", [0; 3]);
    const C: Parameter = Parameter::colour("c", [0; 3]);
    const D: Parameter = Parameter::colour("d", [0; 3]);
    const E: Parameter = Parameter::colour("e", [0; 3]);
    shading!(Many, with(STAGES), { a: colour = A, b: colour = B, c: colour = C, d: colour = D, e: colour = E, steps: number = STEPS, k_d: number = K_D });
    shading_refused::<Many>(&["its parameters take 17 numbers, but at most 16 fit; a colour takes three"]);
    // The other way round: a reflection model that uses the name differently.
    const STEPS_AS_COLOUR: Parameter = Parameter::colour("steps", [0; 3]);
    model!(Later, MODEL, { steps: colour = STEPS_AS_COLOUR });
    let said = registry.try_add_reflection_model::<Later>().map(drop).expect_err("another type");
    assert!(said.to_string().contains("that of `plain` is"), "{said}");
}

#[test]
fn meshes_are_checked_at_both_ends_and_the_default() {
    shape!(Empty, SHAPE, |m, _| m.polygons.clear());
    shape_refused::<Empty>(&["the mesh of tessellation 1: has 4 vertices and 0 polygons"]);
    shape!(NotANumber, SHAPE, |m, _| m.positions[1].x = f32::NAN);
    shape_refused::<NotANumber>(&["vertex 1 is [NaN", "must be three finite numbers"]);
    shape!(Large, SHAPE, |m, _| m.positions.iter_mut().for_each(|p| *p *= 40.0));
    shape_refused::<Large>(&["its largest extent is 40, but must be 1"]);
    shape!(Aside, SHAPE, |m, _| m.positions.iter_mut().for_each(|p| p.y += 1.0));
    shape_refused::<Aside>(&["its centre is at [0, 1, 0], but must be at the origin"]);
    shape!(Beyond, SHAPE, |m, _| m.polygons.push(Polygon::triangle(0, 1, 4)));
    shape_refused::<Beyond>(&["polygon 4 has the corner 4, but there are 4 vertices, counted from 0"]);
    shape!(Inwards, SHAPE, |m, _| m.polygons = vec![
        Polygon::triangle(1, 2, 0),
        Polygon::triangle(3, 1, 0),
        Polygon::triangle(2, 3, 0),
        Polygon::triangle(3, 2, 1),
    ]);
    shape_refused::<Inwards>(&["its polygons face inwards"]);
    shape!(OnlyFine, SHAPE.tessellation(1..=64, 4, "Nothing."), |m, n| if n == 64 {
        m.positions[0].x = 7.0
    });
    shape_refused::<OnlyFine>(&["the mesh of tessellation 64: its largest extent is"]);
    shape!(NoDefault, SHAPE.tessellation(2..=64, 1, "Nothing."), |_, _| {});
    shape_refused::<NoDefault>(&["its default tessellation is 1, but must be from 2 to 64"]);
}

#[test]
fn wgsl_is_checked_with_file_and_line() {
    model!(Lacking, MODEL.wgsl(Source::new("paper.wgsl", "fn respond() {}\n")), {});
    let error =
        model_refused::<Lacking>(&["paper.wgsl:1:4: the function response is missing; define fn response("]);
    assert_eq!(error.shader.map(|problem| problem.file).as_deref(), Some("paper.wgsl"));
    model!(Broken, MODEL.wgsl(Source::new("paper.wgsl", concat!(
        "// mine\n",
        "fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {\n",
        "    return Terms(vec3(0.0), vec3(m.shine), vec3(0.0));\n}\n",
        "fn ambient_response(v: vec3<f32>, frame: Frame, m: Parameters) -> vec3<f32> { return vec3(1.0); }\n",
    ))), {});
    model_refused::<Broken>(&["paper.wgsl:3:", "shine"]);
    light!(OtherFunction, light::Declaration::new("lamp", "Lamp", lamp!("lump")));
    light_refused::<OtherFunction>(&[
        "lump.wgsl:1:4: the function incident_lamp is missing; define fn incident_lamp(light: Light, p: vec3<f32>) -> Incident",
        "did you name it incident_lump?",
    ]);
    shading!(
        HalfShading,
        shading::Declaration::new(
            "plain",
            "Plain",
            Stage::Pixel,
            'N',
            Source::new(
                "plain.wgsl",
                "fn shade_vertex(corner: Corner) -> Varying { var v: Varying; return v; }\n"
            )
        )
    );
    shading_refused::<HalfShading>(&["plain.wgsl:1:", "the function shade_pixel is missing"]);
}

#[test]
fn replacing_is_a_call_of_its_own() {
    model!(Lambert2, MODEL.id("lambert"), { base_colour: colour = BASE_COLOUR });
    model!(Unknown, MODEL.id("unknown"), {});
    let mut registry = Registry::builtin();
    let place = |registry: &Registry| registry.models().iter().position(|m| m.declaration.id == "lambert");
    let (count, before) = (registry.models().len(), place(&registry));
    registry.replace_reflection_model::<Lambert2>().expect("there is one");
    assert_eq!((registry.models().len(), place(&registry)), (count, before));
    assert_eq!(registry.model("lambert").map(|m| m.declaration.name), Some("Paper"));
    refused::<Unknown>(
        registry.replace_reflection_model::<Unknown>(),
        "reflection model",
        "unknown",
        &["there is no reflection model `unknown` to replace; add_reflection_model adds a new one"],
    );
    light!(Spot2, light::Declaration::new("spot", "Spot", lamp!("spot")));
    let index = registry.light_index("spot");
    registry.replace_light_type::<Spot2>().expect("there is one");
    assert_eq!(registry.light_index("spot"), index, "shaders know it by the same number");
}

#[test]
fn the_calls_that_panic_say_the_same() {
    model!(BadDefault, MODEL, { bands: number = Parameter::number("bands", 1.0..=16.0, 20.0) });
    let expected = model_refused::<BadDefault>(&[]).to_string();
    let panic = std::panic::catch_unwind(|| {
        Registry::builtin().add_reflection_model::<BadDefault>();
    });
    let said = panic.expect_err("it is wrong").downcast::<String>().expect("a message");
    assert_eq!(*said, expected);
    // Invalid WGSL alone leaves the rest of the program usable: it is reported where it is used.
    model!(BadText, MODEL.wgsl(Source::new("paper.wgsl", "fn response() {}")), {});
    assert!(Registry::builtin().add_reflection_model::<BadText>().model("paper").is_some());
}

#[test]
fn parameters_of_object_types_are_checked_as_others_and_with_the_mesh_of_each_end() {
    parameters! {
        struct Keyed { size: number = Parameter::number("size", 0.1..=1.0, 0.5) }
    }
    impl ObjectType for Keyed {
        const DECLARATION: shape::Declaration = SHAPE;
        fn mesh(&self, _: u32) -> PolygonMesh {
            tetrahedron()
        }
    }
    shape_refused::<Keyed>(&["parameter `size`: the name is that of another key of an object"]);
    parameters! {
        struct Stretched { stretch: number = Parameter::number("stretch", 1.0..=3.0, 1.0) }
    }
    impl ObjectType for Stretched {
        const DECLARATION: shape::Declaration = SHAPE;
        fn mesh(&self, _: u32) -> PolygonMesh {
            let mut mesh = tetrahedron();
            mesh.positions.iter_mut().for_each(|p| p.x *= self.stretch);
            mesh
        }
    }
    shape_refused::<Stretched>(&[
        "the mesh of tessellation 1 with stretch 3: its largest extent is 3, but must be 1",
    ]);
}
