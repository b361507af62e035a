//! A model, a light type and an object type from outside the crate, registered through the public calls, work
//! everywhere.

use bevy::ecs::component::Component;
use glam::Vec3;
use lights_camera_models::{
    light::{self, Incident, LightRecord, LightType},
    optics::{
        Frame, TermSelection, Terms,
        colour::{BACKGROUND, Encoding},
    },
    parameter::{BASE_COLOUR, Parameter},
    parameters, reference,
    reflection::{self, EquationPart, ReflectionModel, Term},
    registry::{Register, Registry},
    render::capture::gpu::{GpuRenderer, Output},
    scene::{Light, Scene},
    shader::Source,
    shape::{self, ObjectType, PolygonMesh, mesh::Polygon},
};

use crate::pictures::{close_up, compare};

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

/// A light that is stronger at the top of the room.
#[derive(Component, Default)]
struct Skylight;

impl LightType for Skylight {
    const DECLARATION: light::Declaration = light::Declaration::new(
        "skylight",
        "Skylight",
        Source::new(
            "skylight.wgsl",
            "fn incident_skylight(light: Light, p: vec3<f32>) -> Incident { return Incident(vec3(0.0, 1.0, 0.0), light.intensity * p.y / 10.0, 0u); }\n",
        ),
    )
    .summary("Stronger at the top.")
    .glyph("s")
    .equation("I(p) = I y / 10");

    fn incident(light: &LightRecord, p: Vec3) -> Incident {
        Incident::From { l: Vec3::Y, intensity: light.intensity * p.y / 10.0 }
    }
}

/// A tetrahedron.
struct Tetrahedron;

impl ObjectType for Tetrahedron {
    const DECLARATION: shape::Declaration =
        shape::Declaration::new("tetrahedron", "Tetrahedron").summary("Four triangles.").glyph("▲");

    fn mesh(_: u32) -> PolygonMesh {
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
}

fn register(to: &mut impl Register) {
    to.add_reflection_model::<Toon>();
    to.add_light_type::<Skylight>();
    to.add_object_type::<Tetrahedron>();
}

fn scene() -> Scene {
    let mut scene = close_up("sphere", "point");
    scene.objects[0].object_type = "tetrahedron".to_owned();
    scene.reflection_model = "toon".to_owned();
    scene.shading_model = "flat".to_owned();
    scene.lights.push(Light {
        light_type: "skylight".to_owned(),
        position: None,
        intensity: 0.5,
        ..Light::default()
    });
    scene
}

#[test]
fn a_custom_model_light_and_shape_are_drawn_alike_by_both_renderers() {
    let mut registry = Registry::builtin();
    register(&mut registry);
    let mut renderer =
        GpuRenderer::extended(64, 64, 1, Output::Linear, register).expect("software Vulkan is installed");
    renderer.set_scene(scene());
    renderer.settle().expect("the GPU draws");
    let gpu = renderer.read_linear().expect("the picture can be read");
    let settings = reference::Settings { width: 64, height: 64, samples: 1, terms: TermSelection::All };
    let cpu = reference::render(&scene(), &registry, &settings);
    let d = compare(&gpu, &cpu, Encoding::Srgb.decode(BACKGROUND), 1e-3);
    assert!(d.covered > 300 && d.wrong == 0 && d.edges * 20 <= d.covered, "{d:?}");
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
