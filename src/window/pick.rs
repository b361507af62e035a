//! Selection by clicks into the picture: a light by its marker, a lamp or an object by its visible surface.

use bevy::{prelude::*, window::PrimaryWindow};
use bevy_egui::egui::pos2;

use super::{
    WindowView,
    order::Loading,
    place::{PicturePlace, area_of},
    pointer::OverPicture,
    touch::TouchPlugin,
};
use crate::{
    document::Selection,
    panel::{
        marks::{self, Lens},
        state::{Action, Cell, CompareCommand, PictureArea, Session},
    },
    reference::{meshes::MeshStore, probe::towards},
    registry::Registry,
    render::{entities::CurrentScene, schedule::LabFrame},
    scene::{Light, Scene, emitter},
};

/// Selects what the user clicks in the picture.
#[derive(Clone, Copy, Debug, Default)]
pub struct PickingPlugin;

impl Plugin for PickingPlugin {
    fn build(&self, app: &mut App) {
        TouchPlugin::add_to(app);
        app.add_systems(LabFrame, pick.in_set(Loading::Pick));
    }
}

/// Click distance from a light's marker that selects the light, in points.
const LIGHT_REACH: f32 = 12.0;
/// Maximum movement of the pointer between press and release of a click, in points.
const CLICK_SLACK: f32 = 4.0;
/// The same of a finger, which rolls.
const TAP_SLACK: f32 = 12.0;

/// Selects the light whose marker was clicked, otherwise the object or lamp whose surface was clicked.
fn pick(
    (buttons, keys): (Res<ButtonInput<MouseButton>>, Res<ButtonInput<KeyCode>>),
    over: Res<OverPicture>,
    window: Single<&Window, With<PrimaryWindow>>,
    cameras: Query<(&Camera, &GlobalTransform), With<WindowView>>,
    scene: Res<CurrentScene>,
    registry: Res<Registry>,
    area: Option<Res<PictureArea>>,
    mut session: ResMut<Session>,
    mut meshes: Local<MeshStore>,
    mut pressed_at: Local<Option<Vec2>>,
) {
    let pointer = over.finger.or_else(|| window.cursor_position());
    let slack = if over.finger.is_some() { TAP_SLACK } else { CLICK_SLACK };
    let area = area_of(area.as_deref(), &window);
    if buttons.just_pressed(MouseButton::Left) {
        *pressed_at = over.pressed.filter(|_| !area.popup_open);
    }
    if !buttons.just_released(MouseButton::Left) {
        return;
    }
    let (Some(start), Some(end)) = (pressed_at.take(), pointer) else { return };
    let Ok((camera, place)) = cameras.single() else { return };
    if start.distance(end) > slack * area.zoom {
        return;
    }
    let point = pos2(end.x / area.zoom, end.y / area.zoom);
    let cell = area.cell_at(point).copied();
    if let Some(cell) = cell.filter(|cell| cell.view != session.active()) {
        session.apply(Action::Compare(CompareCommand::Activate(cell.view)), &registry);
    }
    let rect = cell.map_or(area.rect, |cell| cell.rect);
    let end = PicturePlace::of_rect(rect, area.zoom, &window).within(&window, end);
    let reach = LIGHT_REACH * area.zoom * window.scale_factor();
    let light = session
        .view
        .show_markers
        .then(|| nearest_light(&scene, &session, &registry, &area, cell, camera, place, end, reach))
        .flatten();
    let selection = light.map(Selection::Light).or_else(|| {
        let ray: Ray3d = camera.viewport_to_world(place, end).ok()?;
        let object = object_at(&scene.0, &registry, ray, &mut meshes);
        let object = object.map(|(i, distance)| (Selection::Object(i), distance));
        let lamp = lamp_at(&scene.0, &registry, ray).map(|(i, distance)| (Selection::Light(i), distance));
        let nearest = object.into_iter().chain(lamp).min_by(|a, b| a.1.total_cmp(&b.1));
        nearest.map(|(selection, _)| selection)
    });
    let Some(selection) = selection else { return };
    if keys.any_pressed(CTRL) {
        session.apply(Action::SelectAlso(selection), &registry);
    } else if selection != session.selection || session.has_group() {
        session.apply(Action::Select(selection), &registry);
    }
}

/// The keys with which a click adds to what is selected, and a drag draws a frame; of a Mac, ⌘.
pub(super) const CTRL: [KeyCode; 2] = if cfg!(target_os = "macos") {
    [KeyCode::SuperLeft, KeyCode::SuperRight]
} else {
    [KeyCode::ControlLeft, KeyCode::ControlRight]
};

/// The object that a ray meets first, and its distance, as the CPU renderer sees it: the meshes of the window are on the
/// GPU alone.
fn object_at(scene: &Scene, registry: &Registry, ray: Ray3d, meshes: &mut MeshStore) -> Option<(usize, f32)> {
    let (object, there) = towards(meshes, scene, registry, [ray.origin, ray.origin + *ray.direction])?;
    Some((object, there.distance(ray.origin)))
}

/// The nearest visible light with extent that a ray hits, and the distance. Surrounding light is the background.
fn lamp_at(scene: &Scene, registry: &Registry, ray: Ray3d) -> Option<(usize, f32)> {
    let met = |light: &Light| {
        let (entry, emitter, record) = emitter(light, registry, scene.display.encoding)?;
        let distance = emitter.seen(&record, ray.origin, *ray.direction).distance;
        let is_around = distance.is_infinite() && emitter.bounds(&record, ray.origin).is_none();
        let is_hidden = distance.is_infinite() && scene.display.backdrop().is_some();
        let is_met = light.enabled && entry.is_visible(&light.parameters) && distance > 0.0;
        (is_met && !is_around && !is_hidden).then_some(distance)
    };
    let lamps = scene.lights.iter().enumerate().filter_map(|(i, light)| Some((i, met(light)?)));
    lamps.min_by(|a, b| a.1.total_cmp(&b.1))
}

fn nearest_light(
    scene: &CurrentScene,
    session: &Session,
    registry: &Registry,
    area: &PictureArea,
    cell: Option<Cell>,
    camera: &Camera,
    place: &GlobalTransform,
    pointer: Vec2,
    reach: f32,
) -> Option<usize> {
    let lens = Lens::of(session, cell.map_or(area.frame, |cell| cell.rect));
    marks::places(&scene.0, registry, &lens, &area.written)
        .into_iter()
        .enumerate()
        .filter_map(|(i, at)| Some((i, camera.world_to_viewport(place, at?).ok()?.distance(pointer))))
        .filter(|(_, distance)| *distance <= reach)
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .map(|(i, _)| i)
}

#[cfg(test)]
mod tests {
    use bevy::{
        camera::{CameraProjection as _, PerspectiveProjection, RenderTargetInfo},
        math::Dir3,
        transform::components::Transform,
        window::WindowResolution,
    };
    use bevy_egui::egui::{Pos2, Rect, vec2};
    use glam::{UVec2, Vec3};

    use super::*;
    use crate::{parameter::Value, render::camera::picture_camera, scene::observer::NEAR};

    const SIZE: UVec2 = UVec2::new(400, 300);

    /// The selection after a click at the position of a point in the scene, with `others` additional cameras.
    fn clicked(scene: &Scene, point: Vec3, others: usize) -> Selection {
        let mut session = Session::new(scene.clone());
        session.selection = Selection::Observer;
        session_after(session, point, others, false).selection
    }

    /// A session after a click, with Ctrl held or not.
    fn session_after(session: Session, point: Vec3, others: usize, ctrl: bool) -> Session {
        let scene = session.document.scene().clone();
        let rect = Rect::from_min_size(Pos2::ZERO, vec2(SIZE.x as f32, SIZE.y as f32));
        let area = PictureArea { rect, frame: rect, has_pointer: true, ..PictureArea::default() };
        let mut camera = Camera::default();
        camera.computed.target_info = Some(RenderTargetInfo { physical_size: SIZE, scale_factor: 1.0 });
        let lens =
            PerspectiveProjection { fov: 1.4, near: NEAR, aspect_ratio: 4.0 / 3.0, ..Default::default() };
        camera.computed.clip_from_view = lens.get_clip_from_view();
        let place =
            GlobalTransform::from(Transform::from_translation(scene.observer.position + 6.0 * Vec3::Z));
        let at = camera.world_to_viewport(&place, point).expect("it is seen");
        let mut window = Window { resolution: WindowResolution::new(SIZE.x, SIZE.y), ..Window::default() };
        window.set_cursor_position(Some(at));

        let mut world = World::new();
        world.insert_resource(session);
        world.insert_resource(area);
        world.insert_resource(OverPicture { now: true, pressed: Some(at), ..OverPicture::default() });
        world.insert_resource(CurrentScene(scene));
        world.insert_resource(Registry::builtin());
        world.init_resource::<ButtonInput<MouseButton>>();
        world.init_resource::<ButtonInput<KeyCode>>();
        world.spawn((window, PrimaryWindow));
        for _ in 0..others {
            // These look elsewhere.
            world.spawn((picture_camera(1), GlobalTransform::from_xyz(0.0, 0.0, -50.0)));
        }
        world.spawn((picture_camera(1), WindowView)).insert((camera, place));
        let mut schedule = Schedule::default();
        schedule.add_systems(pick);
        if ctrl {
            world.resource_mut::<ButtonInput<KeyCode>>().press(CTRL[0]);
        }
        world.resource_mut::<ButtonInput<MouseButton>>().press(MouseButton::Left);
        schedule.run(&mut world);
        let mut buttons = world.resource_mut::<ButtonInput<MouseButton>>();
        buttons.clear();
        buttons.release(MouseButton::Left);
        schedule.run(&mut world);
        world.resource::<Session>().clone()
    }

    #[test]
    fn with_ctrl_a_click_adds_what_is_clicked_or_takes_it_out() {
        let mut scene = Scene::default();
        let middle = scene.objects[0].position;
        let beside =
            crate::scene::Object { position: middle + 2.0 * Vec3::X, size: 0.5, ..scene.objects[0].clone() };
        scene.objects.push(beside);
        let both = session_after(Session::new(scene.clone()), middle + 2.0 * Vec3::X, 0, true);
        assert_eq!(both.group(), [Selection::Object(0), Selection::Object(1)]);
        let one = session_after(both.clone(), middle, 0, true);
        assert_eq!(one.group(), [Selection::Object(1)]);
        let alone = session_after(both, middle, 0, false);
        assert_eq!(alone.group(), [Selection::Object(0)], "a click without it selects one");
    }

    #[test]
    fn a_click_selects_a_light_however_many_cameras_there_are() {
        let scene = Scene::default();
        let light = marks::anchor(&scene.lights[0], &scene).expect("it has a place");
        for others in 0..3 {
            assert_eq!(clicked(&scene, light, others), Selection::Light(0), "{others} more");
        }
    }

    #[test]
    fn a_click_on_an_object_selects_it_though_its_mesh_is_on_the_gpu_alone() {
        let mut scene = Scene::default();
        let middle = scene.objects[0].position;
        assert_eq!(clicked(&scene, middle, 0), Selection::Object(0));
        assert_eq!(clicked(&scene, middle + 2.5 * Vec3::Y, 0), Selection::Observer, "beside it");
        scene
            .objects
            .insert(0, crate::scene::Object { position: middle - 3.0 * Vec3::Z, ..scene.objects[0].clone() });
        assert_eq!(clicked(&scene, middle, 0), Selection::Object(1), "the nearer one");
        scene.objects[1].visible = false;
        assert_eq!(clicked(&scene, middle, 0), Selection::Object(0), "hidden ones are not in the way");
    }

    /// A light with extent that faces the camera.
    fn lamp(light_type: &str, position: Vec3) -> Light {
        let mut light = Light {
            light_type: light_type.to_owned(),
            position: Some(position),
            direction: (light_type != "sphere").then_some(Vec3::Z),
            ..Light::default()
        };
        light.parameters.set("radius", Value::Number(1.0));
        light
    }

    #[test]
    fn a_click_on_a_lamp_selects_it_where_it_is_seen() {
        let middle = Vec3::new(5.0, 5.0, 13.0);
        for light_type in ["rectangle", "disc", "sphere"] {
            let mut scene = Scene { lights: vec![lamp(light_type, middle)], ..Scene::default() };
            // Away from its marker.
            let (on, beside) = (middle + Vec3::new(0.75, 0.2, 0.0), middle + Vec3::new(1.2, 1.2, 0.0));
            assert_eq!(clicked(&scene, on, 0), Selection::Light(0), "{light_type}");
            assert_eq!(clicked(&scene, beside, 0), Selection::Observer, "{light_type}");
            for (name, value) in [("visible", false), ("enabled", false)] {
                scene.lights[0] = lamp(light_type, middle);
                scene.lights[0].parameters.set("visible", Value::flag(name != "visible" || value));
                scene.lights[0].enabled = name != "enabled" || value;
                assert_eq!(clicked(&scene, on, 0), Selection::Observer, "{light_type}, not {name}");
            }
        }
    }

    #[test]
    fn the_nearest_lamp_is_met_and_what_is_all_around_is_not() {
        let registry = Registry::builtin();
        let around = Light { light_type: "environment".to_owned(), position: None, ..Light::default() };
        let sun = Light {
            light_type: "sun".to_owned(),
            position: None,
            direction: Some(Vec3::Z),
            ..Light::default()
        };
        let [far, near] = [2.0, 4.0].map(|z| lamp("disc", Vec3::new(5.0, 5.0, z)));
        let mut scene = Scene { lights: vec![around, sun, far, near], ..Scene::default() };
        let ray = Ray3d::new(Vec3::new(5.0, 5.0, 9.0), Dir3::NEG_Z);
        assert_eq!(lamp_at(&scene, &registry, ray), Some((3, 5.0)));
        scene.lights.truncate(2);
        assert_eq!(lamp_at(&scene, &registry, ray), Some((1, f32::INFINITY)), "the sun is a disc");
        scene.lights.truncate(1);
        assert_eq!(lamp_at(&scene, &registry, ray), None);
    }
}
