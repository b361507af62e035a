//! Both renderers pass equal tangents to an anisotropic model, with every shading model on every shape.

use glam::{Vec3, Vec4};
use lights_camera_models::{
    optics::{
        Frame, TermSelection, Terms,
        colour::{BACKGROUND, Encoding},
        geometry::half_vector,
    },
    parameter::BASE_COLOUR,
    parameters,
    reference::{self, Picture},
    reflection::{Declaration, EquationPart, ReflectionModel, Term},
    registry::{Register, Registry},
    render::capture::gpu::{GpuRenderer, Output},
    scene::Scene,
    shader::Source,
};

use crate::helpers::pictures::{close_up, compare, on_gpu};

parameters! {
    /// Lambert, brighter where the half vector leans along the tangent; it reveals the tangent's sign too.
    pub struct Brushed {
        /// The colour.
        base_colour: colour = BASE_COLOUR,
    }
}

impl ReflectionModel for Brushed {
    const DECLARATION: Declaration = Declaration::new(
        "brushed",
        "Brushed",
        Source::new(
            "brushed.wgsl",
            "fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {\n\
                   let along = 0.5 + 0.5 * dot(frame.t, half_vector(l, v));\n\
                   return Terms(vec3(0.0), max(dot(frame.n, l), 0.0) * along * m.base_colour, vec3(0.0)); }\n\
                   fn ambient_response(v: vec3<f32>, frame: Frame, m: Parameters) -> vec3<f32> { return (0.5 + 0.5 * frame.t) * m.base_colour; }\n",
        ),
    )
    .summary("Depends on the tangent.")
    .equation(&[EquationPart::new(Term::Diffuse, "I_d = max(0, N·L) (1 + T·H)/2 C_b")])
    .reciprocal()
    .energy_conserving()
    .non_negative()
    .anisotropic();

    fn response(&self, l: Vec3, v: Vec3, frame: &Frame) -> Terms {
        let along = 0.5 + 0.5 * frame.t.dot(half_vector(l, v));
        Terms { diffuse: frame.n.dot(l).max(0.0) * along * self.base_colour, ..Terms::default() }
    }

    fn ambient_response(&self, _v: Vec3, frame: &Frame) -> Vec3 {
        (0.5 + 0.5 * frame.t) * self.base_colour
    }
}

parameters! {
    /// The wrong twin: uses the bitangent as the tangent.
    pub struct Crosswise {
        /// The colour.
        base_colour: colour = BASE_COLOUR,
    }
}

impl ReflectionModel for Crosswise {
    const DECLARATION: Declaration = Brushed::DECLARATION.id("crosswise");

    fn response(&self, l: Vec3, v: Vec3, frame: &Frame) -> Terms {
        let turned = Frame { t: frame.b, ..*frame };
        ReflectionModel::response(&Brushed { base_colour: self.base_colour }, l, v, &turned)
    }

    fn ambient_response(&self, v: Vec3, frame: &Frame) -> Vec3 {
        let turned = Frame { t: frame.b, ..*frame };
        ReflectionModel::ambient_response(&Brushed { base_colour: self.base_colour }, v, &turned)
    }
}

fn registry() -> Registry {
    let mut registry = Registry::builtin();
    registry.add_reflection_model::<Brushed>();
    registry.add_reflection_model::<Crosswise>();
    registry
}

const SIZE: u32 = 96;

fn cpu(scene: &Scene, model: &str) -> Picture {
    let scene = Scene { reflection_model: model.to_owned(), ..scene.clone() };
    let settings = reference::Settings { width: SIZE, height: SIZE, samples: 1, terms: TermSelection::All };
    reference::render(&scene, &registry(), &settings)
}

#[test]
fn both_renderers_give_every_mode_and_shape_the_same_tangents() {
    let registry = registry();
    let mut renderer = GpuRenderer::extended(SIZE, SIZE, 1, Output::Linear, |app| {
        app.add_reflection_model::<Brushed>();
    })
    .expect("software Vulkan is installed");
    let background = Encoding::Srgb.decode(BACKGROUND);
    for shape in registry.shapes() {
        for shading in registry.shading_models() {
            for light in ["point", "ambient"] {
                let mut scene = close_up(shape.declaration.id, light);
                scene.reflection_model = "brushed".to_owned();
                scene.shading_model = shading.declaration.id.to_owned();
                let gpu = on_gpu(&mut renderer, &scene);
                let case = format!("{} × {} × {light}", shape.declaration.id, shading.declaration.id);
                let d = compare(&gpu, &cpu(&scene, "brushed"), background, 1e-3);
                // The tangent turns around within the pixel over a pole: the last bit decides the direction.
                assert!(d.covered > 500 && d.wrong <= 1 && d.edges * 50 <= d.covered, "{case}: {d:?}");
                let wrong = compare(&gpu, &cpu(&scene, "crosswise"), background, 1e-3);
                assert!(wrong.wrong * 2 > d.covered, "{case}, bitangent for tangent: {wrong:?}");
            }
        }
    }
}

/// The mean difference of two pictures where the first shows an object, in the largest channel.
fn change(a: &Picture, b: &Picture) -> f32 {
    let covered = a.pixels.iter().zip(&b.pixels).filter(|(a, _)| a.w > 0.0);
    let (sum, count) = covered.fold((Vec4::ZERO, 0.0), |(sum, n), (a, b)| (sum + (*a - *b).abs(), n + 1.0));
    sum.max_element() / count
}

#[test]
fn a_brushed_sphere_may_turn_about_its_axis_but_not_about_another() {
    for shading in registry().shading_models() {
        let mut scene = close_up("sphere", "point");
        scene.shading_model = shading.declaration.id.to_owned();
        let mut turned = |rotation: Vec3, model: &str| {
            scene.objects[0].rotation = rotation;
            cpu(&scene, model)
        };
        // Three of its 64 segments; a quarter turn.
        let (about_y, about_x) = (Vec3::Y * 3.0 * 360.0 / 64.0, Vec3::X * 90.0);
        let case = shading.declaration.id;
        let upright = turned(Vec3::ZERO, "brushed");
        assert!(change(&upright, &turned(about_y, "brushed")) < 1e-4, "{case}");
        assert!(change(&upright, &turned(about_x, "brushed")) > 0.05, "{case}");
        // Without tangents a quarter turn shows only in the polygons.
        assert!(change(&turned(Vec3::ZERO, "lambert"), &turned(about_x, "lambert")) < 0.02, "{case}");
    }
}
