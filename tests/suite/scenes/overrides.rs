//! Views of one scene with overrides, and the cost of a change of the scene.

use bevy::{
    app::{App, Last},
    asset::{AssetEvent, Assets},
    camera::{Hdr, RenderTarget, visibility::RenderLayers},
    ecs::prelude::*,
    math::URect,
    mesh::{Mesh3d, MeshTag},
    render::storage::ShaderBuffer,
    transform::components::{GlobalTransform, Transform},
};
use glam::{UVec2, Vec3};
use lights_camera_models::{
    optics::{TermSelection, colour::Encoding, tone::ToneMapping},
    parameter::{Value, Values},
    registry::Registry,
    render::{
        camera::picture_camera,
        capture::gpu::{GpuRenderer, Output},
        drawn::Drawn,
        entities::SceneEntities,
        overrides::Overrides,
        parts::{SceneObject, Surface, Tessellation},
        stage::{GIZMO_LAYER, ViewCopy},
        view::{Drawing, View, texture_of},
    },
    scene::{Display, Object, Scene},
};

use crate::helpers::pictures::close_up;

const SIZE: u32 = 96;

/// Three objects of different types, colours and models under two lights.
fn scene() -> Scene {
    let mut scene = close_up("sphere", "point");
    let front = scene.objects[0].clone();
    for (kind, x, colour, model) in
        [("cube", 3.9, [40, 90, 220], None), ("torus", 6.3, [60, 200, 90], Some("phong"))]
    {
        let mut object = Object {
            object_type: kind.to_owned(),
            size: 1.1,
            position: Vec3::new(x, 5.4, 6.4),
            reflection_model: model.map(str::to_owned),
            ..front.clone()
        };
        object.material.set("base_colour", Value::Colour(colour));
        scene.objects.push(object);
    }
    let mut second = close_up("sphere", "directional").lights.remove(0);
    second.intensity = 0.3;
    scene.lights.push(second);
    scene
}

fn renderer(scene: &Scene) -> GpuRenderer {
    let mut renderer =
        GpuRenderer::new(SIZE, SIZE, 1, Output::Display).expect("software Vulkan is installed");
    renderer.set_scene(scene.clone());
    renderer
}

/// A scene drawn by a renderer that draws nothing else.
fn alone(scene: &Scene, terms: TermSelection) -> Vec<u8> {
    let mut renderer = renderer(scene);
    renderer.set_terms(terms);
    renderer.settle().expect("the GPU draws");
    renderer.read().expect("the picture can be read")
}

/// A second view next to that of the renderer.
fn second_view(renderer: &mut GpuRenderer, overrides: Overrides) -> Entity {
    renderer.draw_on_demand();
    let target = RenderTarget::None { size: UVec2::ONE };
    let view = View::for_display(UVec2::splat(SIZE));
    renderer.app().world_mut().spawn((picture_camera(1), Hdr, target, view, overrides)).id()
}

fn picture_of(renderer: &mut GpuRenderer, view: Entity) -> Vec<u8> {
    let target = renderer.app().world().get::<RenderTarget>(view).expect("a view draws somewhere");
    let texture = texture_of(target).expect("a view has a texture").clone();
    renderer.read_view(&texture).expect("the picture can be read")
}

/// The number of pictures drawn by each view: those without overrides, and those with.
fn drawn(renderer: &mut GpuRenderer) -> [u64; 2] {
    let world = renderer.app().world_mut();
    let mut counts = [0; 2];
    for (drawing, overridden) in world.query::<(&Drawing, Has<Overrides>)>().iter(world) {
        counts[usize::from(overridden)] += drawing.drawn();
    }
    counts
}

fn model(id: &str) -> Overrides {
    Overrides { reflection_model: Some(id.to_owned()), ..Overrides::default() }
}

#[test]
fn around_an_inset_the_picture_goes_on() {
    let mut scene = scene();
    // Left of what the observer sees.
    let front = scene.objects[0].clone();
    scene.objects.push(Object { position: front.position - Vec3::X * 1.9, ..front });
    let plain = alone(&scene, TermSelection::All);
    let (at, whole) = (UVec2::new(60, 8), UVec2::new(180, 120));
    let mut renderer =
        GpuRenderer::new(whole.x, whole.y, 1, Output::Display).expect("software Vulkan is installed");
    renderer.set_scene(scene);
    let view = second_view(&mut renderer, Overrides::default());
    let inset = Some(URect::from_corners(at, at + SIZE));
    renderer.app().world_mut().entity_mut(view).insert(View { inset, ..View::for_display(whole) });
    renderer.settle().expect("the GPU draws");
    let picture = picture_of(&mut renderer, view);
    assert_eq!(picture.len() as u32, 4 * whole.x * whole.y);
    let pixel = |x: u32, y: u32| &picture[4 * (y * whole.x + x) as usize..][..4];
    let (mut differ, mut beside) = (0, 0);
    for (x, y) in (0..whole.y).flat_map(|y| (0..whole.x).map(move |x| (x, y))) {
        let inside = (x.wrapping_sub(at.x) < SIZE && y.wrapping_sub(at.y) < SIZE)
            .then(|| &plain[4 * ((y - at.y) * SIZE + x - at.x) as usize..][..4]);
        match inside {
            Some(expected) => {
                differ += u32::from(pixel(x, y).iter().zip(expected).any(|(a, b)| a.abs_diff(*b) > 3))
            }
            None => beside += u32::from(x < at.x && pixel(x, y) != pixel(0, 0)),
        }
    }
    // Edges may cross the centre of a pixel.
    assert!(differ < 40, "{differ} of {} pixels differ", SIZE * SIZE);
    assert!(beside > 200, "an object beside the inset is seen: {beside}");
}

#[test]
fn views_with_overrides_draw_beside_others_what_each_draws_alone() {
    let scene = scene();
    let plain = alone(&scene, TermSelection::All);
    let mut values = Values::default();
    values.set("base_colour", Value::Colour([250, 240, 30]));
    let dark = Display { exposure: -1.5, tone_mapping: ToneMapping::AgX, ..Display::default() };
    let overrides = [
        model("ggx"),
        Overrides { shading_model: Some("flat".to_owned()), ..Overrides::default() },
        Overrides { parameters: values.clone(), ..Overrides::default() },
        Overrides { terms: Some(TermSelection::Specular), ..model("blinn_phong") },
        Overrides { display: Some(dark), ..Overrides::default() },
        Overrides {
            display: Some(Display { encoding: Encoding::Off, ..dark }),
            parameters: values,
            ..model("ggx")
        },
    ];
    let expected: Vec<_> = overrides
        .iter()
        .map(|o| alone(&o.applied(&scene, &Registry::builtin()), o.terms.unwrap_or_default()))
        .collect();

    let mut renderer = renderer(&scene);
    let views: Vec<_> = overrides.iter().map(|o| second_view(&mut renderer, o.clone())).collect();
    renderer.settle().expect("the GPU draws");
    // All in one frame.
    let world = renderer.app().world_mut();
    world.query::<&mut Drawing>().iter_mut(world).for_each(|mut drawing| drawing.redraw());
    let before = drawn(&mut renderer);
    renderer.step();
    let views_count = views.len() as u64;
    assert_eq!(drawn(&mut renderer), [before[0] + 1, before[1] + views_count]);
    assert!(renderer.read().expect("the picture can be read") == plain, "the view without overrides");
    for (i, view) in views.iter().enumerate() {
        let shown = picture_of(&mut renderer, *view);
        assert!(shown == expected[i], "{:?}", overrides[i]);
        // The wrong pictures: without the overrides, and with those of any other view.
        assert!(shown != plain, "{:?}", overrides[i]);
        assert!(
            expected.iter().enumerate().all(|(k, other)| k == i || shown != *other),
            "{:?}",
            overrides[i]
        );
        let layers = renderer.app().world().get::<RenderLayers>(*view).expect("its drawables have a layer");
        assert!(layers.intersects(&RenderLayers::layer(GIZMO_LAYER)), "gizmos are seen in every view");
    }
}

#[test]
fn a_change_of_the_overrides_draws_that_view_and_a_change_of_the_scene_draws_all() {
    let scene = scene();
    let mut renderer = renderer(&scene);
    let view = second_view(&mut renderer, model("ggx"));
    renderer.settle().expect("the GPU draws");
    let rest = |renderer: &mut GpuRenderer, change: &dyn Fn(&mut World)| {
        (0..4).for_each(|_| renderer.step());
        let before = drawn(renderer);
        change(renderer.app().world_mut());
        renderer.settle().expect("the GPU draws");
        (0..4).for_each(|_| renderer.step());
        let after = drawn(renderer);
        (after[0] - before[0], after[1] - before[1])
    };
    assert_eq!(rest(&mut renderer, &|_| {}), (0, 0));
    let (plain, overridden) = rest(&mut renderer, &|world| {
        world.get_mut::<Overrides>(view).expect("it has overrides").terms = Some(TermSelection::Diffuse);
    });
    assert!(plain == 0 && overridden > 0, "terms: {plain}, {overridden}");
    let (plain, overridden) = rest(&mut renderer, &|world| {
        let mut overrides = world.get_mut::<Overrides>(view).expect("it has overrides");
        overrides.parameters.set("base_colour", Value::Colour([1, 2, 3]));
    });
    assert!(plain == 0 && overridden > 0, "parameters: {plain}, {overridden}");

    // The copies follow the originals.
    let mut moved = scene.clone();
    moved.objects[0].position.x += 0.4;
    moved.objects.remove(1);
    let mut hidden = Object { visible: false, ..moved.objects[0].clone() };
    hidden.position.x -= 1.0;
    moved.objects.push(hidden);
    renderer.set_scene(moved.clone());
    let (plain, overridden) = rest(&mut renderer, &|_| {});
    assert_eq!((plain, overridden), (0, 0));
    let overrides = renderer.app().world().get::<Overrides>(view).expect("it has overrides").clone();
    let expected = alone(&overrides.applied(&moved, &Registry::builtin()), TermSelection::Diffuse);
    assert!(picture_of(&mut renderer, view) == expected);
    let world = renderer.app().world_mut();
    assert_eq!(world.query::<&ViewCopy>().iter(world).count(), 3);

    // Without overrides it shows what the others show.
    renderer.app().world_mut().entity_mut(view).remove::<Overrides>();
    renderer.settle().expect("the GPU draws");
    assert!(picture_of(&mut renderer, view) == alone(&moved, TermSelection::All));
}

#[test]
fn a_view_that_goes_leaves_nothing_behind() {
    let mut renderer = renderer(&scene());
    renderer.settle().expect("the GPU draws");
    let held = |renderer: &mut GpuRenderer| {
        (0..3).for_each(|_| renderer.step());
        let world = renderer.app().world_mut();
        let drawables = world.query::<&Mesh3d>().iter(world).count();
        // Materials hold their buffers, so a leaked material is detected here too.
        (drawables, world.resource::<Assets<ShaderBuffer>>().len())
    };
    let before = held(&mut renderer);
    for round in 0..3 {
        let view = second_view(&mut renderer, model("lambert"));
        renderer.settle().expect("the GPU draws");
        let (drawables, buffers) = held(&mut renderer);
        assert_eq!(drawables, 2 * before.0, "round {round}");
        assert!(buffers > before.1, "round {round}");
        renderer.app().world_mut().despawn(view);
        assert_eq!(held(&mut renderer), before, "round {round}");
    }
}

/// The changes made in one frame.
#[derive(Clone, Debug, Default, PartialEq, Eq, Resource)]
struct Cost {
    objects: usize,
    transforms: usize,
    names: usize,
    drawn: usize,
    places: usize,
    tags: usize,
    meshes: usize,
    gone: usize,
    /// Number of bytes in buffers passed to the renderer.
    uploaded: usize,
}

fn count(
    mut cost: ResMut<Cost>,
    objects: Query<(), Or<(Changed<SceneObject>, Changed<Surface>, Changed<Tessellation>)>>,
    transforms: Query<(), (Changed<Transform>, With<SceneObject>)>,
    places: Query<(), (Changed<GlobalTransform>, With<SceneObject>)>,
    names: Query<(), (Changed<Name>, With<SceneObject>)>,
    drawn: Query<(), Changed<Drawn>>,
    tags: Query<(), Changed<MeshTag>>,
    meshes: Query<(), Changed<Mesh3d>>,
    mut gone: RemovedComponents<SceneObject>,
    mut events: MessageReader<AssetEvent<ShaderBuffer>>,
    buffers: Res<Assets<ShaderBuffer>>,
) {
    let mut uploaded = 0;
    for event in events.read() {
        if let AssetEvent::Added { id } | AssetEvent::Modified { id } = event {
            uploaded += buffers.get(*id).and_then(|buffer| buffer.data.as_ref()).map_or(0, Vec::len);
        }
    }
    *cost = Cost {
        objects: objects.iter().count(),
        transforms: transforms.iter().count(),
        places: places.iter().count(),
        names: names.iter().count(),
        drawn: drawn.iter().count(),
        tags: tags.iter().count(),
        meshes: meshes.iter().count(),
        gone: gone.read().count(),
        uploaded,
    };
}

#[test]
fn an_object_that_goes_or_comes_touches_no_other_of_ten_thousand() {
    const OBJECTS: usize = 10_000;
    let object = |i: usize| {
        let place = Vec3::new((i % 100) as f32, (i / 100) as f32, 0.0) * 0.09 + Vec3::new(0.5, 0.5, 2.0);
        let mut object =
            Object { object_type: "cube".to_owned(), size: 0.05, position: place, ..Object::default() };
        object.material.set("base_colour", Value::Colour([(i % 251) as u8, (i % 241) as u8, 90]));
        object
    };
    let mut scene = Scene { objects: (0..OBJECTS).map(object).collect(), ..Scene::default() };
    let count_costs = |app: &mut App| {
        app.init_resource::<Cost>().add_systems(Last, count);
    };
    let mut renderer = GpuRenderer::extended(SIZE, SIZE, 1, Output::Display, count_costs)
        .expect("software Vulkan is installed");
    renderer.set_scene(scene.clone());
    renderer.settle().expect("the GPU draws");
    let mut cost = |scene: &Scene| {
        renderer.set_scene(scene.clone());
        renderer.step();
        let cost = renderer.app().world().resource::<Cost>().clone();
        renderer.step();
        assert_eq!(
            *renderer.app().world().resource::<Cost>(),
            Cost::default(),
            "a frame in which nothing changes"
        );
        cost
    };
    let first = scene.objects.remove(0);
    assert_eq!(cost(&scene), Cost { gone: 1, ..Cost::default() });

    // The row of the removed one is free for the next. The table has one row for each object.
    scene.objects.insert(OBJECTS / 2, first);
    let came = cost(&scene);
    let one = Cost {
        objects: 1,
        transforms: 1,
        names: 1,
        drawn: 1,
        places: 1,
        tags: 1,
        meshes: 1,
        gone: 0,
        uploaded: 0,
    };
    assert_eq!(Cost { uploaded: 0, ..came.clone() }, one);
    assert!(came.uploaded <= 64 * OBJECTS, "{}", came.uploaded);

    // The picture is that of the scene, whatever was removed and added.
    scene.objects.swap_remove(17);
    scene.objects.truncate(OBJECTS / 3);
    scene.objects.insert(0, object(OBJECTS - 1));
    cost(&scene);
    let count = renderer.app().world().resource::<SceneEntities>().objects.len();
    assert_eq!(count, scene.objects.len());
    assert!(renderer.read().expect("the picture can be read") == alone(&scene, TermSelection::All));
}
