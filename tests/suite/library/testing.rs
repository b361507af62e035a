//! The public tests for models, light types and object types: valid ones pass, and a wrong twin of each
//! fails.

use glam::Vec3;
use lights_camera_models::{
    light::{self, Incident, LightRecord, LightType},
    optics::{Frame, Terms},
    parameter::Parameter,
    parameters, reflection,
    reflection::ReflectionModel,
    registry::Registry,
    shader::{Source, compose::Sources},
    shading::{self, Corner, Lighting, ShadingModel, Stage, Varying},
    shape::{self, ObjectType, PolygonMesh, mesh::Polygon},
    testing,
};

/// Paper that scatters this fraction of the light in Rust; in WGSL it scatters all of it.
macro_rules! paper {
    ($name:ident, $share:literal, $declaration:expr) => {
        parameters! {
            /// Paper.
            struct $name {}
        }
        impl ReflectionModel for $name {
            const DECLARATION: reflection::Declaration = $declaration;
            fn response(&self, l: Vec3, _: Vec3, frame: &Frame) -> Terms {
                Terms { diffuse: Vec3::splat($share * frame.n.dot(l).max(0.0)), ..Terms::default() }
            }
            fn ambient_response(&self, _: Vec3, _: &Frame) -> Vec3 {
                Vec3::splat($share)
            }
        }
    };
}

const PAPER: reflection::Declaration = reflection::Declaration::new(
    "paper",
    "Paper",
    Source::new(
        "paper.wgsl",
        "fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {
    return Terms(vec3(0.0), vec3(max(dot(frame.n, l), 0.0)), vec3(0.0));
}
fn ambient_response(v: vec3<f32>, frame: Frame, m: Parameters) -> vec3<f32> {
    return vec3(1.0);
}
",
    ),
)
.reciprocal()
.energy_conserving()
.non_negative();

paper!(Paper, 1.0, PAPER);
paper!(Darker, 0.9995, PAPER);
paper!(Glowing, 1.5, PAPER);
paper!(Black, 0.0, PAPER);
paper!(
    Modest,
    1.0,
    reflection::Declaration::new("paper", "Paper", PAPER.wgsl).energy_conserving().non_negative()
);

#[test]
fn what_is_right_passes() {
    testing::assert_laws::<Paper>();
    testing::assert_parity::<Paper>();
    testing::assert_parity_on_gpu::<Paper>();
    testing::assert_light::<Downlight>();
    testing::assert_mesh::<Tetrahedron>();
    testing::assert_shading::<Banded>();
}

/// Light in bands, with this exponent in Rust, declared for this stage.
macro_rules! banded {
    ($name:ident, $stage:expr, $power:literal) => {
        parameters! {
            struct $name { bands: number = BANDS }
        }
        impl ShadingModel for $name {
            const DECLARATION: shading::Declaration =
                shading::Declaration::new("in_bands", "In bands", $stage, 'Z', IN_BANDS);
            fn vertex(&self, _: &dyn Lighting, corner: &Corner) -> Varying {
                let Corner { position, normal, tangent, .. } = *corner;
                Varying { position, normal, tangent, ..Varying::default() }
            }
            fn pixel(&self, lighting: &dyn Lighting, varying: &Varying, face_normal: Vec3) -> Vec3 {
                let normal = varying.normal.normalize_or_zero().lerp(face_normal, 0.5);
                lighting.colour(varying.position, normal, varying.tangent).abs().powf($power) / self.bands
            }
        }
    };
}

const BANDS: Parameter = Parameter::number("bands", 1.0..=16.0, 4.0);
const IN_BANDS: Source = Source::new(
    "in_bands.wgsl",
    "fn shade_vertex(corner: Corner) -> Varying {
    return Varying(corner.position, corner.normal, corner.tangent, vec3(0.0), vec3(0.0));
}
fn shade_pixel(passed: Varying) -> vec3<f32> {
    let face = unit_or_zero(cross(dpdy(passed.offset), dpdx(passed.offset)));
    let colour = illuminate(passed.position, mix(unit_or_zero(passed.normal), face, 0.5), passed.tangent);
    return pow(abs(colour), vec3(2.0)) / shading_parameters().bands;
}
",
);
banded!(Banded, Stage::Pixel, 2.0);
banded!(Steeper, Stage::Pixel, 2.001);
banded!(Misplaced, Stage::Vertex, 2.0);

#[test]
fn every_built_in_shading_model_passes() {
    for shading in Registry::builtin().shading_models() {
        let all = testing::shadings::all(shading, &Sources::default());
        assert_eq!(all, Ok(()), "{}", shading.declaration.id);
    }
}

#[test]
#[should_panic(expected = "in_bands: Values({\"bands\": ")]
fn a_shading_model_that_differs_a_little_between_the_languages_fails() {
    testing::assert_shading::<Steeper>();
}

parameters! {
    struct NamelessBands { bands: number = BANDS }
}
impl ShadingModel for NamelessBands {
    const DECLARATION: shading::Declaration =
        shading::Declaration::new("in_bands", "", Stage::Pixel, 'Z', IN_BANDS);
    fn vertex(&self, lighting: &dyn Lighting, corner: &Corner) -> Varying {
        ShadingModel::vertex(&Banded { bands: self.bands }, lighting, corner)
    }
    fn pixel(&self, lighting: &dyn Lighting, varying: &Varying, face_normal: Vec3) -> Vec3 {
        ShadingModel::pixel(&Banded { bands: self.bands }, lighting, varying, face_normal)
    }
}

#[test]
#[should_panic(expected = "in_bands: the name is empty")]
fn a_shading_model_that_cannot_be_registered_fails() {
    testing::assert_shading::<NamelessBands>();
}

#[test]
#[should_panic(
    expected = "declares to be evaluated per vertex, but vertex does not evaluate the light and pixel evaluates it"
)]
fn a_shading_model_at_another_stage_fails() {
    testing::assert_shading::<Misplaced>();
}

paper!(
    Misspelt,
    1.0,
    reflection::Declaration::new(
        "paper",
        "Paper",
        Source::new(
            "paper.wgsl",
            "fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> vec3<f32> {
    return vec3(max(dot(frame.n, l), 0.0));
}
fn ambient_response(v: vec3<f32>, frame: Frame, m: Parameters) -> vec3<f32> {
    return vec3(1.0);
}
",
        ),
    )
);

#[test]
#[should_panic(expected = "paper: paper.wgsl:1:4: response must be fn response(l: vec3<f32>")]
fn a_mistake_is_named_in_the_file_of_the_model() {
    testing::assert_parity::<Misspelt>();
}

paper!(Nameless, 1.0, reflection::Declaration::new("paper", "", PAPER.wgsl));

#[test]
#[should_panic(expected = "paper: the name is empty")]
fn a_model_that_cannot_be_registered_keeps_no_laws() {
    testing::assert_laws::<Nameless>();
}

#[test]
#[should_panic(expected = "paper: the name is empty")]
fn its_equation_is_not_looked_at() {
    testing::assert_equation::<Nameless>();
}

#[test]
#[should_panic(expected = "paper: the name is empty")]
fn nor_is_it_compared_in_two_languages() {
    testing::assert_parity::<Nameless>();
}

#[test]
#[should_panic(expected = "paper: the name is empty")]
fn nor_on_the_gpu() {
    testing::assert_parity_on_gpu::<Nameless>();
}

#[test]
#[should_panic(expected = "paper: declares that it conserves energy, but reflects 1.5")]
fn a_model_that_makes_light_fails() {
    testing::assert_laws::<Glowing>();
}

#[test]
#[should_panic(expected = "paper: declares that it is not reciprocal, but both directions differ by 0")]
fn a_model_that_claims_less_than_it_keeps_fails() {
    testing::assert_laws::<Modest>();
}

#[test]
#[should_panic(expected = "WGSL gives")]
fn a_model_that_is_darker_by_a_twentieth_of_a_percent_in_one_language_fails() {
    testing::assert_parity::<Darker>();
}

#[test]
#[should_panic(expected = "WGSL gives")]
fn the_same_fails_on_the_gpu() {
    testing::assert_parity_on_gpu::<Darker>();
}

#[test]
#[should_panic(expected = "WGSL gives")]
fn a_model_that_is_black_in_one_language_fails() {
    testing::assert_parity::<Black>();
}

/// A lamp with this fraction of the light in Rust, and all of it in WGSL, and with this solid angle.
macro_rules! downlight {
    ($name:ident, $intensity:expr, $solid_angle:expr) => {
        parameters! {
            struct $name {}
        }
        impl LightType for $name {
            const DECLARATION: light::Declaration = DOWNLIGHT;
            fn incident(&self, light: &LightRecord, p: Vec3) -> Incident {
                let to_light = light.position - p;
                let share: fn(f32) -> f32 = $intensity;
                let l = to_light.normalize_or_zero();
                let falloff = light.intensity / to_light.length_squared().max(1e-12);
                Incident::From { l, intensity: Vec3::splat(share(l.y.max(0.0) * falloff)) }
            }
            fn solid_angle(&self) -> Option<f64> {
                Some($solid_angle)
            }
        }
    };
}

const DOWNLIGHT: light::Declaration = light::Declaration::new(
    "downlight",
    "Downlight",
    Source::new(
        "downlight.wgsl",
        "fn incident_downlight(light: Light, p: vec3<f32>) -> Incident {
    let to_light = light.position - p;
    let l = unit_or_zero(to_light);
    return Incident(l, vec3(max(l.y, 0.0) * light.intensity / max(dot(to_light, to_light), 1e-12)), 0u);
}
",
    ),
)
.at_position()
.candela(10.0, 100.0);

downlight!(Downlight, |i| i, std::f64::consts::PI);
downlight!(Dimmer, |i| 0.9995 * i, std::f64::consts::PI);
downlight!(Wider, |i| i, 1.1 * std::f64::consts::PI);

parameters! {
    struct Forgetful {}
}
impl LightType for Forgetful {
    const DECLARATION: light::Declaration = DOWNLIGHT;
    fn incident(&self, light: &LightRecord, p: Vec3) -> Incident {
        LightType::incident(&Downlight::default(), light, p)
    }
    fn factors(&self, light: &LightRecord, p: Vec3) -> Vec<light::Factor> {
        vec![
            light::Factor::intensity(light, "cd"),
            light::Factor::inverse_square(1.0, light.position.distance(p)),
        ]
    }
    fn solid_angle(&self) -> Option<f64> {
        LightType::solid_angle(&Downlight::default())
    }
}

parameters! {
    struct NamelessLight {}
}
impl LightType for NamelessLight {
    const DECLARATION: light::Declaration =
        light::Declaration::new("downlight", "", DOWNLIGHT.wgsl).at_position().candela(10.0, 100.0);
    fn incident(&self, light: &LightRecord, p: Vec3) -> Incident {
        LightType::incident(&Downlight::default(), light, p)
    }
    fn solid_angle(&self) -> Option<f64> {
        LightType::solid_angle(&Downlight::default())
    }
}

#[test]
#[should_panic(expected = "downlight: the name is empty")]
fn a_light_that_cannot_be_registered_fails() {
    testing::assert_light::<NamelessLight>();
}

#[test]
#[should_panic(expected = "its factors multiply to")]
fn a_light_whose_factors_are_not_its_light_fails() {
    testing::assert_light::<Forgetful>();
}

#[test]
#[should_panic(expected = "downlight: ")]
fn a_light_that_is_darker_by_a_twentieth_of_a_percent_in_one_language_fails() {
    testing::assert_light::<Dimmer>();
}

downlight!(Nothing, |i| i / (0.0 * i), std::f64::consts::PI);

#[test]
#[should_panic(expected = "its light is not finite: Rust gives the intensity [")]
fn a_light_that_is_not_finite_fails_and_that_is_said() {
    testing::assert_light::<Nothing>();
}

#[test]
#[should_panic(expected = "its light is not finite: the intensity is [")]
fn the_laws_say_so_too() {
    let light = lights_camera_models::light::LightEntry::of::<Nothing>();
    if let Err(what) = testing::lights::laws(&light) {
        panic!("{what}");
    }
}

#[test]
#[should_panic(expected = "solid_angle is 3.4558 sr, but its light in all directions is 3.14")]
fn a_light_whose_flux_is_not_what_it_sends_out_fails() {
    testing::assert_light::<Wider>();
}

#[test]
fn every_built_in_light_passes() {
    for light in Registry::builtin().lights() {
        assert_eq!(testing::lights::all(light, &Sources::default()), Ok(()), "{}", light.declaration.id);
    }
}

#[test]
fn a_light_with_one_sign_changed_is_noticed() {
    let registry = Registry::builtin();
    for (id, from, to) in [
        ("point", "light.position - p", "p - light.position"),
        ("spot", "light.direction, -l", "light.direction, l"),
        ("photometric", "cross(zero, axis)", "cross(axis, zero)"),
        ("directional", "-light.direction", "light.direction"),
        ("ambient", "1u", "0u"),
    ] {
        let light = registry.light(id).expect("built in");
        let source = light.declaration.wgsl;
        assert!(source.text.contains(from), "{id}: nothing to edit");
        let mut sources = Sources::default();
        sources.edit(source.path, source.text.replacen(from, to, 1));
        let found = testing::lights::parity(light, &sources).expect_err(id);
        assert!(found.contains("WGSL gives"), "{found}");
    }
}

/// A tetrahedron, after a change.
macro_rules! tetrahedron {
    ($name:ident, $change:expr) => {
        parameters! {
            struct $name {}
        }
        impl ObjectType for $name {
            const DECLARATION: shape::Declaration = shape::Declaration::new("tetrahedron", "Tetrahedron");
            fn mesh(&self, _: u32) -> PolygonMesh {
                let mut mesh = PolygonMesh {
                    positions: vec![
                        Vec3::new(0.5, 0.5, 0.5),
                        Vec3::new(-0.5, -0.5, 0.5),
                        Vec3::new(-0.5, 0.5, -0.5),
                        Vec3::new(0.5, -0.5, -0.5),
                    ],
                    polygons: vec![
                        Polygon::triangle(0, 2, 1),
                        Polygon::triangle(0, 1, 3),
                        Polygon::triangle(0, 3, 2),
                        Polygon::triangle(1, 2, 3),
                    ],
                };
                let change: fn(&mut PolygonMesh) = $change;
                change(&mut mesh);
                mesh
            }
        }
    };
}

tetrahedron!(Tetrahedron, |_| {});
tetrahedron!(Turned, |m| m.polygons[0] = Polygon::triangle(1, 2, 0));
tetrahedron!(Torn, |m| {
    m.positions.push(m.positions[0]);
    m.polygons[2] = Polygon::triangle(4, 3, 2);
});
tetrahedron!(Lonely, |m| m.positions.push(Vec3::ZERO));

#[test]
#[should_panic(expected = "one of them faces the other way")]
fn a_mesh_with_one_polygon_turned_fails() {
    testing::assert_mesh::<Turned>();
}

#[test]
#[should_panic(expected = "1 places have two vertices or more: polygons that meet must share their corners")]
fn a_mesh_torn_at_a_vertex_fails() {
    testing::assert_mesh::<Torn>();
}

#[test]
#[should_panic(expected = "1 polygons or vertices have no normal")]
fn a_mesh_with_a_vertex_of_no_polygon_fails() {
    testing::assert_mesh::<Lonely>();
}

parameters! {
    struct NamelessShape {}
}
impl ObjectType for NamelessShape {
    const DECLARATION: shape::Declaration = shape::Declaration::new("tetrahedron", "");
    fn mesh(&self, tessellation: u32) -> PolygonMesh {
        ObjectType::mesh(&Tetrahedron::default(), tessellation)
    }
}

#[test]
#[should_panic(expected = "tetrahedron: the name is empty")]
fn a_mesh_that_cannot_be_registered_fails() {
    testing::assert_mesh::<NamelessShape>();
}
