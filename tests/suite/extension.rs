//! A model, a light type and an object type from outside the crate, registered through the public calls, work
//! everywhere.

use glam::Vec3;
use lights_camera_models::{
    light::{self, Incident, LightRecord, LightType},
    optics::{
        Frame, TermSelection, Terms,
        colour::{BACKGROUND, Encoding},
    },
    parameter::{BASE_COLOUR, Parameter, ParameterKind, Value},
    parameters, reference,
    reflection::{self, EquationPart, Family, Laws, ReflectionModel, Term},
    registry::{Register, Registry},
    render::capture::gpu::{GpuRenderer, Output},
    scene::{
        Light, Scene,
        load::{self, Defaults},
        save, schema,
    },
    shader::Source,
    shape::{self, ObjectType, PolygonMesh, mesh::Polygon},
};

use crate::pictures::{close_up, compare};

const BANDS: Parameter = Parameter {
    name: "bands",
    symbol: "n",
    label: "bands",
    unit: "",
    help: "How many tones there are.",
    kind: ParameterKind::Integer { min: 1, max: Some(16), slider_max: 16, default: 4 },
    used_when: None,
};

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
    const DECLARATION: reflection::Declaration = reflection::Declaration {
        id: "toon",
        name: "Toon",
        family: Family::Custom,
        author: "a test",
        source: "a test",
        summary: "Lambert in a few tones.",
        equation: &[EquationPart { term: Term::Diffuse, text: "I_d = ceil(n max(0, N·L)) C_b / n" }],
        laws: Laws { reciprocal: false, energy_conserving: false, non_negative: true },
        ambient: reflection::Ambient::Formula,
        anisotropic: false,
        wgsl: Source {
            path: "toon.wgsl",
            text: "fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {\n\
                   return Terms(vec3(0.0), ceil(m.bands * max(dot(frame.n, l), 0.0)) / m.bands * m.base_colour, vec3(0.0)); }\n\
                   fn ambient_response(v: vec3<f32>, frame: Frame, m: Parameters) -> vec3<f32> { return m.base_colour; }\n",
        },
    };

    fn response(&self, l: Vec3, _v: Vec3, frame: &Frame) -> Terms {
        let tone = (self.bands * frame.n.dot(l).max(0.0)).ceil() / self.bands;
        Terms { diffuse: tone * self.base_colour, ..Terms::default() }
    }

    fn ambient_response(&self, _v: Vec3, _frame: &Frame) -> Vec3 {
        self.base_colour
    }
}

const CEILING: Parameter = Parameter {
    name: "ceiling",
    symbol: "h",
    label: "ceiling",
    unit: "m",
    help: "The height of full light.",
    kind: ParameterKind::Number { min: 1.0, max: 100.0, default: 10.0 },
    used_when: None,
};
const ZENITH: Parameter = Parameter {
    name: "zenith",
    label: "zenith",
    kind: ParameterKind::Colour { default: [90, 160, 255] },
    ..CEILING
};
const HAZE: Parameter = Parameter {
    name: "haze",
    label: "haze",
    kind: ParameterKind::Triple { min: 0.0, max: 1.0, default: [0.2, 0.1, 0.05] },
    ..CEILING
};
const PROFILE: Parameter = Parameter {
    name: "profile",
    label: "profile",
    kind: ParameterKind::Choice { options: &[("smooth", "Smooth"), ("steps", "In steps")], default: 0 },
    ..CEILING
};
const STEPS: Parameter = Parameter {
    name: "steps",
    label: "steps",
    kind: ParameterKind::Integer { min: 1, max: Some(16), slider_max: 16, default: 3 },
    ..CEILING
}
.used_when("profile", &["steps"]);

parameters! {
    /// A light that is stronger at the top of the room, with a parameter of every type.
    struct Skylight {
        ceiling: number = CEILING,
        zenith: colour = ZENITH,
        haze: triple = HAZE,
        profile: choice = PROFILE,
        steps: number = STEPS,
    }
}

impl LightType for Skylight {
    const DECLARATION: light::Declaration = light::Declaration {
        id: "sky_light",
        name: "Skylight",
        summary: "Stronger at the top.",
        glyph: "s",
        has_position: false,
        has_direction: false,
        unit: "lx",
        default_intensity: 1.0,
        slider_max: 10.0,
        cone_parameter: None,
        equation: "I(p) = I y / h",
        wgsl: Source {
            path: "skylight.wgsl",
            text: "fn incident_sky_light(light: Light, m: SkyLightParameters, p: vec3<f32>) -> Incident {
                       var share = p.y / m.ceiling;
                       if m.profile == 1u { share = ceil(share * m.steps) / m.steps; }
                       let colour = share * m.zenith + m.haze;
                       return Incident(vec3(0.0, 1.0, 0.0), light.intensity * colour, 0u);
                   }\n",
        },
    };

    fn incident(&self, light: &LightRecord, p: Vec3) -> Incident {
        let share = p.y / self.ceiling;
        let share = if self.profile == 1 { (share * self.steps).ceil() / self.steps } else { share };
        Incident::From { l: Vec3::Y, intensity: light.intensity * (share * self.zenith + self.haze) }
    }
}

/// A tetrahedron.
struct Tetrahedron;

impl ObjectType for Tetrahedron {
    const DECLARATION: shape::Declaration = shape::Declaration {
        id: "tetrahedron",
        name: "Tetrahedron",
        summary: "Four triangles.",
        glyph: "▲",
        tessellation_help: "always 1",
        tessellation: 1..=1,
        default_tessellation: 1,
    };

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

fn gpu(renderer: &mut GpuRenderer, scene: &Scene) -> Vec<Vec3> {
    renderer.set_scene(scene.clone());
    renderer.settle().expect("the GPU draws");
    renderer.read_linear().expect("the picture can be read")
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
    assert!(alike(&gpu(&mut renderer, &scene()), &scene()));
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
    ];
    let mut shown = gpu(&mut renderer, &scene);
    for (name, value) in values {
        scene.lights[1].parameters.set(name, value);
        // The wrong twin: the picture before the change.
        assert!(!alike(&shown, &scene), "a change of {name} goes unnoticed");
        shown = gpu(&mut renderer, &scene);
        assert!(alike(&shown, &scene), "{name}");
    }
    // The type is a component with its parameters.
    let world = renderer.app().world_mut();
    let lights: Vec<_> = world.query::<&Skylight>().iter(world).copied().collect();
    let zenith = Encoding::Srgb.decode([250, 40, 120]);
    assert_eq!(
        lights,
        [Skylight { ceiling: 7.0, zenith, haze: Vec3::new(0.05, 0.6, 0.3), profile: 1, steps: 9.0 }]
    );
}

#[test]
fn lights_whose_parameters_outgrow_the_buffer_are_drawn() {
    let mut renderer = renderer();
    let mut scene = scene();
    assert!(alike(&gpu(&mut renderer, &scene), &scene));
    let other = scene.clone();
    for i in 0..250_u8 {
        let mut light = Light { intensity: 0.01, ..scene.lights[1].clone() };
        light.parameters.set("zenith", Value::Colour([i, 255 - i, i / 2]));
        scene.lights.push(light);
    }
    let shown = gpu(&mut renderer, &scene);
    assert!(alike(&shown, &scene));
    // The wrong twin: another colour of the last one alone.
    let mut wrong = scene.clone();
    wrong.lights[251].parameters.set("zenith", Value::Colour([255; 3]));
    wrong.lights[251].intensity = 0.05;
    assert!(!alike(&shown, &wrong));
    assert!(alike(&gpu(&mut renderer, &other), &other), "and fewer again");
}

#[test]
fn parameters_of_a_light_are_read_checked_written_and_in_the_schema() {
    let registry = registry();
    let mut scene = scene();
    scene.lights[1].parameters.set("zenith", Value::Colour([1, 2, 3]));
    scene.lights[1].parameters.set("haze", Value::Triple([0.5; 3]));
    scene.lights[1].parameters.set("steps", Value::Integer(2));
    scene.lights[1].parameters.set("profile", Value::Choice("steps".into()));
    let text = save::to_json(&scene, None, &registry);
    let read = |text: &str| load::from_text(text, "scene.json", &registry, Defaults::Refuse);
    assert_eq!(read(&text).map(|loaded| loaded.scene.lights).ok(), Some(scene.lights));
    for (right, wrong, message) in [
        ("\"zenith\": [1, 2, 3]", "\"zenith\": [1, 2, 300]", "zenith"),
        ("\"haze\": [0.5, 0.5, 0.5]", "\"haze\": [0.5, 0.5, 1.5]", "between 0 and 1"),
        ("\"steps\": 2", "\"steps\": 2.5", "a whole number between 1 and 16"),
        ("\"profile\": \"steps\"", "\"profile\": \"step\"", "did you mean \"steps\"?"),
        ("\"steps\": 2", "\"cone_angle\": 2", "is given, but a sky_light light has no cone_angle"),
    ] {
        assert!(text.contains(right), "{right} in {text}");
        let Err(problem) = read(&text.replace(right, wrong)) else { panic!("{wrong} is legal") };
        assert!(problem.to_string().contains(message), "{problem}");
    }
    let schema = schema::text(&registry);
    for name in ["ceiling", "zenith", "haze", "profile", "steps"] {
        assert!(schema.contains(&format!("\"{name}\": {{")), "{name}");
    }
}

#[test]
fn a_parameter_that_means_something_else_elsewhere_is_refused() {
    const WRONG: Parameter =
        Parameter { kind: ParameterKind::Number { min: 0.0, max: 1.0, default: 0.5 }, ..BASE_COLOUR };
    parameters! {
        /// Uses the name of a colour for a number.
        pub struct Clash {
            /// Not a colour.
            base_colour: number = WRONG,
        }
    }
    impl ReflectionModel for Clash {
        const DECLARATION: reflection::Declaration =
            reflection::Declaration { id: "clash", ..Toon::DECLARATION };
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

#[test]
fn light_types_that_cannot_work_are_refused() {
    parameters! {
        /// Needs more than fits.
        struct Wide {
            a: triple = HAZE, b: triple = HAZE, c: triple = HAZE, d: triple = HAZE, e: triple = HAZE, f: triple = HAZE,
            g: triple = HAZE, h: triple = HAZE, i: triple = HAZE, j: triple = HAZE, k: triple = HAZE, l: triple = HAZE,
            m: triple = HAZE, n: triple = HAZE, o: triple = HAZE, p: triple = HAZE, q: triple = HAZE,
        }
    }
    parameters! {
        /// Its cone is a colour.
        struct Coloured { zenith: colour = ZENITH }
    }
    macro_rules! like_skylight {
        ($($name:ident, $id:literal, $cone:expr);*) => {$(
            impl LightType for $name {
                const DECLARATION: light::Declaration =
                    light::Declaration { id: $id, cone_parameter: $cone, ..Skylight::DECLARATION };
                fn incident(&self, light: &LightRecord, p: Vec3) -> Incident {
                    Skylight::default().incident(light, p)
                }
            }
        )*};
    }
    like_skylight!(Wide, "wide", None; Coloured, "coloured", Some("zenith"));
    let refused = |add: fn(&mut Registry)| std::panic::catch_unwind(|| add(&mut registry())).is_err();
    assert!(!refused(|registry| _ = registry.add_light_type::<Skylight>()));
    assert!(refused(|registry| _ = registry.add_light_type::<Wide>()));
    assert!(refused(|registry| _ = registry.add_light_type::<Coloured>()));
}
