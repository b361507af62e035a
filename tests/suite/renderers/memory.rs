//! Memory stays bounded in long sessions, since everything replaced is freed.

use std::fs;

use bevy::{
    asset::Assets,
    mesh::Mesh,
    prelude::Shader,
    render::{RenderApp, render_resource::PipelineCache, storage::ShaderBuffer},
    shader::Source,
};
use glam::Vec3;
use lights_camera_models::{
    document::{Edit, Selection},
    light,
    optics::{
        TermSelection,
        colour::{BACKGROUND, srgb_decode},
    },
    panel::state::{Action, MAX_MESSAGES, Session as Window, Severity},
    parameter::Value,
    reference,
    registry::Registry,
    render::{
        capture::gpu::{GpuRenderer, Output},
        live::{LiveShaders, SPARE},
        material::ModelMaterial,
        meshes::ShapeMeshes,
    },
    scene::{Light, Object, Part, Scene, check},
};

use crate::{
    helpers::pictures::{close_up, compare},
    renderers::reload::{Lab, phong_scene},
};

/// The resources of a renderer that Bevy or this program might forget to free.
#[derive(Debug, PartialEq)]
struct Held {
    shaders: usize,
    /// Number of those that are not negligibly small.
    large: usize,
    tables: usize,
    materials: usize,
    meshes: usize,
    pipelines: usize,
}

fn held(renderer: &mut GpuRenderer) -> Held {
    // Unused resources are freed in the next frame.
    renderer.step();
    renderer.step();
    let world = renderer.app().world();
    let shaders = world.resource::<Assets<Shader>>();
    let is_large = |shader: &Shader| match &shader.source {
        Source::Wgsl(text) => shader.path.starts_with("composed/") && text.len() > 1000,
        _ => false,
    };
    let held = Held {
        shaders: shaders.len(),
        large: shaders.iter().filter(|(_, shader)| is_large(shader)).count(),
        tables: world.resource::<Assets<ShaderBuffer>>().len(),
        materials: world.resource::<Assets<ModelMaterial>>().len(),
        meshes: world.resource::<Assets<Mesh>>().len(),
        pipelines: 0,
    };
    let render = renderer.app().get_sub_app(RenderApp).expect("there is a renderer").world();
    Held { pipelines: render.resource::<PipelineCache>().pipelines().count(), ..held }
}

/// A model as bright as its last parameter. The number of parameters, and so the layout of the row, changes
/// from edit to edit.
fn declared(edit: usize) -> String {
    let more: String = (0..edit % 4)
        .map(|i| format!("{{ \"name\": \"more_{i}\", \"min\": 0, \"max\": 1, \"default\": 1 }}, "))
        .collect();
    let level = if edit.is_multiple_of(2) { 0.25 } else { 0.75 };
    format!(
        "/* lcm {{ \"name\": \"Edited\", \"summary\": \"Edit {edit}.\", \"parameters\": [{more}\
         {{ \"name\": \"level\", \"min\": 0, \"max\": 1, \"default\": {level} }}] }} */\n\
         fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {{\n    \
         return Terms(vec3(0.0), vec3(m.level), vec3(0.0));\n}}\n"
    )
}

/// A scene with one model from a file, lit so that the picture shows the model's value.
fn under(model: &str) -> Scene {
    let mut scene = close_up("sphere", "directional");
    scene.lights[0].intensity = 1.0;
    scene.lights[0].colour = [255; 3];
    model.clone_into(&mut scene.reflection_model);
    scene
}

/// The middle of a picture of the helper's size.
fn middle(picture: &[u8]) -> u8 {
    let pixels = picture.len() / 3;
    let side = pixels.isqrt();
    picture[3 * (side / 2 * side + side / 2)]
}

#[test]
fn an_edited_declaration_takes_the_place_of_the_one_before() {
    let mut lab = Lab::new(phong_scene("gouraud"));
    lab.save("own/edited.wgsl", declared(0));
    lab.settled();
    lab.renderer.set_scene(under("edited"));
    lab.settled();
    lab.save("own/edited.wgsl", declared(1));
    lab.settled();
    let before = held(&mut lab.renderer);
    for edit in 2..40 {
        lab.save("own/edited.wgsl", declared(edit));
        // The shader and the table change in one frame, or the picture would mix parameters.
        let shown = middle(&lab.frame());
        let expected = if edit.is_multiple_of(2) { 137 } else { 225 };
        assert!(shown.abs_diff(expected) <= 1, "edit {edit}: {shown}");
    }
    assert_eq!(held(&mut lab.renderer), before);
}

#[test]
fn a_model_that_is_gone_leaves_its_place_to_the_next() {
    let mut lab = Lab::new(phong_scene("gouraud"));
    let mut round = |i: usize| {
        let file = format!("own/passing_{i}.wgsl");
        lab.save(&file, declared(i));
        lab.settled();
        lab.renderer.set_scene(under(&format!("passing_{i}")));
        lab.settled();
        lab.renderer.set_scene(phong_scene("gouraud"));
        lab.settled();
        fs::remove_file(lab.file(&file)).expect("it is there");
        lab.reread(&file);
        lab.settled();
        let world = lab.renderer.app().world();
        assert!(world.resource::<Registry>().model(&format!("passing_{i}")).is_none(), "{i}");
        let held = held(&mut lab.renderer);
        (held.shaders, held.materials, held.pipelines)
    };
    let first = round(0);
    for i in 1..6 {
        assert_eq!(round(i), first);
    }
}

#[test]
fn shaders_that_nothing_is_drawn_with_rest_and_wake() {
    let mut renderer = GpuRenderer::new(48, 48, 1, Output::Display).expect("software Vulkan is installed");
    let registry = Registry::builtin();
    let pairs: Vec<_> = registry
        .models()
        .iter()
        .flat_map(|model| registry.shading_models().iter().map(|m| (model.declaration.id, m.declaration.id)))
        .take(SPARE + 8)
        .collect();
    let show = |renderer: &mut GpuRenderer, (model, shading): (&str, &str)| {
        let mut scene = close_up("sphere", "point");
        model.clone_into(&mut scene.reflection_model);
        shading.clone_into(&mut scene.shading_model);
        scene.objects[0].tessellation = Some(12);
        renderer.set_scene(scene);
        renderer.step();
        renderer.read_rgb8().expect("the picture can be read")
    };
    renderer.settle().expect("the GPU draws");
    let mut pictures = Vec::new();
    for &pair in &pairs {
        pictures.push(show(&mut renderer, pair));
        let ready = renderer.app().world().resource::<LiveShaders>().ready();
        assert!(ready <= SPARE + 2, "{ready} after {pair:?}");
    }
    let before = held(&mut renderer);
    assert!(before.large <= SPARE + 1, "{before:?}");
    // The first ones are at rest by now. The frame in which they return is right.
    for (pair, picture) in pairs.iter().zip(&pictures).take(6) {
        assert!(*picture == show(&mut renderer, *pair), "{pair:?}");
    }
    let after = held(&mut renderer);
    assert!(after.large <= SPARE + 1, "{after:?}");
    assert_eq!((after.shaders, after.pipelines), (before.shaders, before.pipelines));
}

/// A reproducible stream of random numbers.
struct Numbers(u64);

impl Numbers {
    fn below(&mut self, end: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % end.max(1)
    }
}

#[test]
fn hundreds_of_random_actions_leave_no_more_behind_than_the_last_scene_needs() {
    let registry = Registry::builtin();
    let shapes: Vec<_> = registry.shapes().iter().map(|s| s.declaration.id.to_owned()).collect();
    // Few models, and no light with extent, so that compiling them does not take long; the test above covers
    // many.
    let without = registry.lights().iter().filter(|light| !light.declaration.extent);
    let lights: Vec<_> = without.map(|light| light.declaration.id.to_owned()).collect();
    let models = ["lambert", "phong"].map(str::to_owned);
    let shadings: Vec<_> = registry.shading_models().iter().map(|m| m.declaration.id.to_owned()).collect();
    let mut renderer = GpuRenderer::new(32, 32, 1, Output::Display).expect("software Vulkan is installed");
    let mut window = Window::default();
    let mut numbers = Numbers(9);
    let mut random = |window: &mut Window, renderer: &mut GpuRenderer, actions: usize| {
        for _ in 0..actions {
            let mut any = |list: &[String]| list[numbers.below(list.len())].clone();
            let (shape, light, model, shading) = (any(&shapes), any(&lights), any(&models), any(&shadings));
            let i = numbers.below(window.document.objects.len());
            let l = numbers.below(window.document.lights.len());
            let number = numbers.below(60);
            let action = match numbers.below(14) {
                0 => Action::AddObject(shape),
                1 => Action::Duplicate(Selection::Object(i)),
                2 | 3 => Action::Remove(Selection::Object(i)),
                4 => Action::AddLight(light),
                5 => Action::Remove(Selection::Light(l)),
                6 => Action::Edit(Edit::set(Part::Light(l), Light::light_type, light)),
                7 => Action::Edit(Edit::set(Part::Object(i), Object::object_type, shape)),
                8 => Action::Edit(Edit::set(Part::Object(i), Object::size, 0.1 + number as f32 / 20.0)),
                9 => Action::Edit(Edit::set(Part::Object(i), Object::reflection_model, model)),
                10 => Action::Edit(Edit::set(Part::Object(i), Object::shading_model, shading)),
                11 => Action::Edit(Edit::parameter(
                    Part::Object(i),
                    "tube_radius",
                    Value::Number(0.02 + number as f32 / 300.0),
                )),
                12 => Action::Edit(Edit::parameter(
                    Part::Object(i),
                    "vertical_exponent",
                    Value::Number(0.1 + number as f32 / 30.0),
                )),
                _ => Action::Edit(Edit::set(Part::Object(i), Object::tessellation, 3 + number as u32)),
            };
            window.apply(action, &registry);
            assert!(window.document.lights.len() <= light::MAX_LIGHTS);
            renderer.set_scene(window.document.scene().clone());
            renderer.step();
        }
        held(renderer)
    };
    let before = random(&mut window, &mut renderer, 150);
    let after = random(&mut window, &mut renderer, 300);
    // Two meshes for each type and tessellation of the scene, and for some that existed before.
    let most = |objects: usize| 2 * (objects + 17) + 8;
    assert!(after.meshes <= most(window.document.objects.len()), "{before:?} {after:?}");
    assert!(after.tables <= models.len() + 2, "{after:?}");
    assert!(after.large <= models.len() * shadings.len() + 2, "{after:?}");
    let entities = renderer.app().world().entities().len() as usize;
    assert!(entities < 2000, "{entities}");
}

#[test]
fn messages_that_nobody_dismisses_are_kept_up_to_a_number() {
    let mut window = Window::default();
    for i in 0..3 * MAX_MESSAGES {
        window.say(Severity::Info, format!("Message {i}."));
    }
    assert_eq!(window.messages.len(), MAX_MESSAGES);
    assert_eq!(window.messages[MAX_MESSAGES - 1].text, format!("Message {}.", 3 * MAX_MESSAGES - 1));
}

#[test]
fn both_renderers_agree_on_extreme_directions_and_sizes() {
    let (width, height) = (96, 64);
    let registry = Registry::builtin();
    let mut gpu = GpuRenderer::new(width, height, 1, Output::Linear).expect("software Vulkan is installed");
    let mut agree = |what: &str, scene: &Scene, covered: bool| {
        assert_eq!(check::scene(scene, &registry), [], "{what}");
        gpu.set_scene(scene.clone());
        gpu.settle().expect("the GPU draws");
        let picture = gpu.read_linear().expect("the picture can be read");
        let settings = reference::Settings { width, height, samples: 1, terms: TermSelection::All };
        let cpu = reference::render(scene, &registry, &settings);
        let background = Vec3::from(BACKGROUND.map(|c| srgb_decode(f32::from(c) / 255.0)));
        let difference = compare(&picture, &cpu, background, 1e-2);
        assert!(!covered || difference.covered > 50, "{what}: {difference:?}");
        assert!(difference.wrong == 0 && difference.edges <= 8, "{what}: {difference:?}");
        assert!(picture.iter().all(|p| p.is_finite()), "{what}");
    };
    for direction in [
        Vec3::new(1e18, 1e-10, 1e18),
        Vec3::new(1e18, 1e-10, -1e18),
        Vec3::new(-1e18, 1e18, 1e18),
        Vec3::new(1e-17, -1e-18, -1e-17),
        Vec3::new(1e-25, -1.0, 1e-25),
        Vec3::new(1e-7, 1.0, 0.0),
    ] {
        let mut scene = close_up("cube", "point");
        scene.observer.direction = direction;
        scene.observer.field_of_view = 120.0;
        let centre = scene.observer.position;
        for (i, side) in
            [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z].into_iter().enumerate()
        {
            let mut object = scene.objects[0].clone();
            ["sphere", "torus", "cube", "teapot"][i % 4].clone_into(&mut object.object_type);
            object.size = 0.7;
            object.position = centre + 1.1 * side;
            scene.objects.push(object);
        }
        agree(&format!("{direction}"), &scene, true);
    }
    let largest = Object::size.limits().max as f32;
    for kind in ["sphere", "cube", "torus", "teapot"] {
        for shading in registry.shading_models() {
            for size in [f32::MIN_POSITIVE, 1e-10, 1e5, largest] {
                let mut scene = close_up(kind, "directional");
                shading.declaration.id.clone_into(&mut scene.shading_model);
                scene.objects[0].size = size;
                scene.objects[0].position = Vec3::new(5.0, 0.01, 5.0);
                scene.observer.field_of_view = 100.0;
                // From within a sphere or a cube there is nothing to see.
                let open = size > 1.0 && matches!(kind, "torus" | "teapot");
                agree(&format!("{kind} {} {size:e}", shading.declaration.id), &scene, open);
            }
        }
    }
}

#[test]
fn sizes_that_no_picture_can_show_are_refused() {
    let largest = Object::size.limits().max as f32;
    for size in [largest * 1.001, 3.4e38, f32::INFINITY] {
        let mut scene = Scene::default();
        scene.objects[0].size = size;
        let found = check::scene(&scene, &Registry::builtin());
        let [problem] = &found[..] else { panic!("{size}: {found:?}") };
        assert!(problem.to_string().ends_with("but a size must be at most 1e9 m"), "{problem}");
        let mut window = Window::default();
        window.apply(Action::Edit(Edit::set(Part::Object(0), Object::size, size)), &Registry::builtin());
        assert!(window.document == Scene::default(), "the window refuses it too");
    }
}

/// Shapes that no two objects share do not fit into memory at once, and are drawn one batch after the other.
#[test]
fn a_scene_beyond_the_memory_for_meshes_is_drawn_and_so_is_a_later_one() {
    let scene = |count: u32, tessellation: u32| {
        let mut scene = Scene::default();
        let object = scene.objects[0].clone();
        scene.objects = (0..count)
            .map(|i| {
                let mut object = object.clone();
                object.object_type = "superellipsoid".to_owned();
                object.size = 0.5;
                object.tessellation = Some(tessellation);
                object.shape.set("vertical_exponent", Value::Number(0.3 + 0.01 * i as f32));
                object.shading_model = Some("flat".to_owned());
                object
            })
            .collect();
        scene
    };
    let mut renderer = GpuRenderer::new(64, 64, 1, Output::Display).expect("a driver");
    // Each takes 40 MB with a colour per polygon; a batch is 32 MiB, and a larger mesh one of its own.
    renderer.set_scene(scene(5, 256));
    renderer.settle().expect("one after the other");
    assert!(middle(&renderer.read().expect("a picture")) > 0);
    assert_eq!(renderer.app().world().resource::<ShapeMeshes>().bytes(), 0, "nothing stays after batches");
    renderer.set_scene(scene(3, 16));
    renderer.settle().expect("the GPU draws");
    let picture = renderer.read().expect("a picture");
    assert!(middle(&picture) > 0);
}
