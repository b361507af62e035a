//! Frames of the GPU renderer at 1280×720, one sample per pixel: compared with a frame of the same app with
//! an empty room, over objects, lights and views, under light with extent, by model, and compared with Bevy's
//! own material.

use bevy::{
    app::Update,
    asset::Assets,
    camera::{Hdr, RenderTarget},
    color::Color,
    ecs::prelude::*,
    image::Image,
    light::{GlobalAmbientLight, PointLight},
    mesh::{Mesh, Mesh3d},
    pbr::{MeshMaterial3d, StandardMaterial},
    render::render_resource::TextureFormat,
    transform::components::Transform,
};
use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use glam::Vec3;
use lights_camera_models::{
    parameter::Values,
    registry::Registry,
    render::{
        camera::picture_camera,
        capture::gpu::{GpuRenderer, Output},
        entities::SceneEntities,
        meshes::shared_mesh,
        overrides::Overrides,
        parts::Animated,
    },
    scene::{Light, Object, Observer, Scene, Variant},
};

fn renderer(scene: Scene) -> GpuRenderer {
    let mut renderer =
        GpuRenderer::new(1280, 720, 1, Output::Display).expect("a Vulkan driver, software will do");
    renderer.set_scene(scene);
    renderer.settle().expect("the GPU draws");
    renderer
}

/// A frame, including the wait for it: submitting alone would measure the queue.
fn frame(renderer: &mut GpuRenderer) {
    renderer.step();
    renderer.wait();
}

/// Objects on a grid that fills the picture, so that the covered area stays nearly the same.
fn grid(count: usize) -> Scene {
    let side = (count as f32).sqrt().ceil();
    let objects = (0..count)
        .map(|i| {
            let (x, y) = (i as f32 % side, (i as f32 / side).floor());
            Object {
                position: Vec3::new((x + 0.5) * 10.0 / side, (y + 0.5) * 10.0 / side, 1.0),
                size: 8.0 / side,
                tessellation: Some(8),
                ..Object::default()
            }
        })
        .collect();
    let observer =
        Observer { position: Vec3::new(5.0, 5.0, 9.9), field_of_view: 60.0, ..Observer::default() };
    Scene { objects, observer, ..Scene::default() }
}

/// Eight spheres with about as many triangles together, 2.1 million, as ten thousand of [`grid`].
fn fine() -> Scene {
    let mut scene = grid(8);
    for object in &mut scene.objects {
        object.tessellation = Some(256);
    }
    scene
}

fn lit(count: usize) -> Scene {
    let lights = (0..count)
        .map(|i| Light {
            position: Some(Vec3::new(1.0 + i as f32 * 0.03, 8.0, 8.0)),
            intensity: 1.0,
            ..Light::default()
        })
        .collect();
    Scene { lights, shading_model: "phong".to_owned(), ..Scene::default() }
}

fn frames(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("frame");
    group.sample_size(20);
    let mut empty = renderer(Scene { objects: Vec::new(), lights: Vec::new(), ..Scene::default() });
    group.bench_function("empty room", |b| b.iter(|| frame(&mut empty)));
    drop(empty);
    let mut default = renderer(Scene::default());
    group.bench_function("default scene", |b| b.iter(|| frame(&mut default)));
    drop(default);
    for count in [1, 100, 1000, 10_000] {
        let mut renderer = renderer(grid(count));
        group.bench_function(BenchmarkId::new("objects", count), |b| b.iter(|| frame(&mut renderer)));
    }
    let mut few = renderer(fine());
    group.bench_function("triangles of 10000 objects in 8", |b| b.iter(|| frame(&mut few)));
    drop(few);
    for count in [1, 16, 256] {
        let mut renderer = renderer(lit(count));
        group.bench_function(BenchmarkId::new("lights, Phong shading", count), |b| {
            b.iter(|| frame(&mut renderer))
        });
    }
    group.finish();
}

/// The default scene with Phong shading under one light with extent, or a point light for comparison, with one
/// sample: the first picture after a change.
fn extended(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("first picture, Phong shading");
    group.sample_size(20);
    let registry = Registry::builtin();
    for kind in ["point", "rectangle", "disc", "sphere", "cylinder", "sun", "environment"] {
        let mut scene = lit(1);
        let light = &mut scene.lights[0];
        light.set_type(registry.light(kind).expect("built in"), &registry, scene.scene_size);
        light.direction = Some(Vec3::new(-2.0, -3.0, -2.0));
        let mut renderer = renderer(Scene::default());
        renderer.set_light_samples(1);
        renderer.set_scene(scene);
        renderer.settle().expect("the GPU draws");
        group.bench_function(kind, |b| b.iter(|| frame(&mut renderer)));
    }
    group.finish();
}

/// A sphere so close that it fills the picture, under one point light, shaded per pixel.
fn full_screen(model: &str) -> Scene {
    Scene {
        objects: vec![Object {
            position: CENTRE,
            size: DIAMETER,
            tessellation: Some(TESSELLATION),
            ..Object::default()
        }],
        lights: vec![Light { position: Some(LIGHT), intensity: 9.0, ..Light::default() }],
        observer: Observer { position: EYE, field_of_view: 40.0, ..Observer::default() },
        reflection_model: model.to_owned(),
        shading_model: "phong".to_owned(),
        ..Scene::default()
    }
}

const CENTRE: Vec3 = Vec3::new(5.0, 5.0, 3.0);
const DIAMETER: f32 = 5.0;
const TESSELLATION: u32 = 32;
const LIGHT: Vec3 = Vec3::new(6.5, 7.0, 8.0);
const EYE: Vec3 = Vec3::new(5.0, 5.0, 6.7);

/// The sphere, light and camera with Bevy's own material, light and light loop: no shadows, no ambient light.
/// The lights are clustered on the CPU, which is cheaper for a single light.
fn standard_material() -> GpuRenderer {
    let empty = Scene { objects: Vec::new(), lights: Vec::new(), ..full_screen("lambert") };
    let mut renderer =
        GpuRenderer::new(1280, 720, 1, Output::Display).expect("a Vulkan driver, software will do");
    renderer.set_scene(empty);
    let registry = Registry::builtin();
    let sphere = registry.shape("sphere").expect("built in");
    let mesh = shared_mesh(&sphere.mesh(&Values::default(), TESSELLATION));
    let world = renderer.app().world_mut();
    let mesh = world.resource_mut::<Assets<Mesh>>().add(mesh);
    let material = world.resource_mut::<Assets<StandardMaterial>>().add(StandardMaterial {
        base_color: Color::WHITE,
        perceptual_roughness: 0.5,
        metallic: 0.0,
        reflectance: 0.5,
        ..StandardMaterial::default()
    });
    world.insert_resource(GlobalAmbientLight::NONE);
    let at = Transform::from_translation(CENTRE).with_scale(Vec3::splat(DIAMETER));
    world.spawn((Mesh3d(mesh), MeshMaterial3d(material), at));
    let light = PointLight { intensity: 4e6, shadow_maps_enabled: false, ..PointLight::default() };
    world.spawn((light, Transform::from_translation(LIGHT)));
    renderer.settle().expect("the GPU draws");
    renderer
}

/// Asserts that the picture is filled by something lit: the background has the code 46.
fn assert_lit(renderer: &mut GpuRenderer, what: &str) {
    let rgb = renderer.read_rgb8().expect("the picture can be read");
    let middle = rgb[3 * (1280 * 360 + 640)];
    let corner = rgb[0];
    assert!(middle > 60 && corner != 46, "{what}: the middle is {middle}, the corner {corner}");
}

fn models(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("full screen");
    group.sample_size(30);
    let mut renderer = renderer(full_screen("lambert"));
    for model in Registry::builtin().models() {
        let id = model.declaration.id;
        renderer.set_scene(full_screen(id));
        renderer.settle().expect("the GPU draws");
        group.bench_function(id, |b| b.iter(|| frame(&mut renderer)));
    }
    drop(renderer);
    // The comparison back to back, each in a separate app.
    for round in 1..=2 {
        let mut ours = self::renderer(full_screen("metallic_roughness"));
        assert_lit(&mut ours, "metallic_roughness");
        group.bench_function(BenchmarkId::new("against Bevy: metallic_roughness", round), |b| {
            b.iter(|| frame(&mut ours));
        });
        drop(ours);
        let mut bevys = standard_material();
        assert_lit(&mut bevys, "StandardMaterial");
        group.bench_function(BenchmarkId::new("against Bevy: StandardMaterial", round), |b| {
            b.iter(|| frame(&mut bevys));
        });
    }
    group.finish();
}

/// Marks objects rotated by a system in every frame.
#[derive(Component)]
struct Turns;

fn turn(mut objects: Query<&mut Transform, With<Turns>>) {
    objects.iter_mut().for_each(|mut place| place.rotate_y(0.01));
}

/// Ten thousand objects at rest, and rotated in every frame by a system: only displayed, and stored in the
/// scene.
fn moved(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("10 000 objects");
    group.sample_size(20);
    let mut renderer = GpuRenderer::extended(1280, 720, 1, Output::Display, |app| {
        app.add_systems(Update, turn);
    })
    .expect("a Vulkan driver, software will do");
    // Simple ones, so that drawing them does not hide anything.
    let mut scene = grid(10_000);
    for object in &mut scene.objects {
        (object.object_type, object.tessellation) = ("cube".to_owned(), Some(1));
    }
    renderer.set_scene(scene);
    renderer.settle().expect("the GPU draws");
    let objects = renderer.app().world().resource::<SceneEntities>().objects.clone();
    for what in ["at rest", "animated", "stored"] {
        for object in &objects {
            let mut entity = renderer.app().world_mut().entity_mut(*object);
            match what {
                "animated" => entity.insert((Turns, Animated)),
                "stored" => entity.remove::<Animated>(),
                _ => &mut entity,
            };
        }
        group.bench_function(what, |b| b.iter(|| frame(&mut renderer)));
    }
    group.finish();
}

/// A frame of one view, and of two of the same size: the scene, and next to it with another reflection model.
fn views(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("views");
    group.sample_size(50);
    let phong = Variant { reflection_model: Some("phong".to_owned()), ..Variant::default() };
    let scene = Scene { variants: vec![phong], ..Scene::default() };
    for round in 1..=2 {
        let mut one = renderer(scene.clone());
        group.bench_function(BenchmarkId::new("one", round), |b| b.iter(|| frame(&mut one)));
        drop(one);
        let mut two = renderer(scene.clone());
        let world = two.app().world_mut();
        let format = TextureFormat::Rgba8UnormSrgb;
        let target = Image::new_target_texture(1280, 720, format, None);
        let target = world.resource_mut::<Assets<Image>>().add(target);
        let overrides = Overrides::of_view(&scene, 1).expect("view B differs");
        world.spawn((picture_camera(1), Hdr, RenderTarget::Image(target.into()), overrides));
        two.settle().expect("the GPU draws");
        group.bench_function(BenchmarkId::new("two", round), |b| b.iter(|| frame(&mut two)));
    }
    group.finish();
}

criterion_group!(benches, models, frames, extended, moved, views);
criterion_main!(benches);
