//! Camera control: orbit, pan and zoom around an object, and return to the observer.

use bevy::{
    ecs::system::SystemParam,
    input::mouse::{MouseMotion, MouseWheel},
    prelude::*,
};
use bevy_egui::EguiPostUpdateSet;
use bevy_panorbit_camera::{PanOrbitCamera, PanOrbitCameraPlugin, PanOrbitCameraSystemSet};

use super::{
    WindowView,
    pick::CTRL,
    pointer::OverPicture,
    touch::{TouchPlugin, follow_fingers},
};
use crate::{
    document::{Edit, Selection},
    panel::state::{Action, CameraChange, PictureArea, Session, Steer, Together},
    registry::Registry,
    render::{camera::PictureCamera, entities::CurrentScene},
    scene::{Observer, Scene, observer::rotation},
};

/// Minimum distance of the camera from its target, in metres.
const NEAREST: f32 = 0.05;

/// Maximum elevation of the camera, up or down, in radians.
const HIGHEST: f32 = 89.9 / 180.0 * std::f32::consts::PI;

/// The orbit controls of the camera.
pub(super) fn orbit() -> PanOrbitCamera {
    PanOrbitCamera {
        button_orbit: MouseButton::Left,
        button_pan: MouseButton::Right,
        // Immediate: views under comparison must not glide.
        orbit_smoothness: 0.0,
        pan_smoothness: 0.0,
        zoom_smoothness: 0.0,
        zoom_sensitivity: 0.35,
        zoom_lower_limit: NEAREST,
        pitch_upper_limit: Some(89.9f32.to_radians()),
        pitch_lower_limit: Some(-89.9f32.to_radians()),
        enabled: false,
        ..PanOrbitCamera::default()
    }
}

/// Moves the camera of the picture by the pointer: orbit, pan, zoom.
#[derive(Clone, Copy, Debug, Default)]
pub struct CameraPlugin;

impl Plugin for CameraPlugin {
    fn build(&self, app: &mut App) {
        TouchPlugin::add_to(app);
        if !app.is_plugin_added::<PanOrbitCameraPlugin>() {
            app.add_plugins(PanOrbitCameraPlugin);
        }
        app.add_systems(PreUpdate, (gate.after(follow_fingers), keep_at_observer).chain()).add_systems(
            PostUpdate,
            // In time for the marks over the picture of the same frame.
            feed_viewpoint.after(PanOrbitCameraSystemSet).before(EguiPostUpdateSet::EndPass),
        );
    }
}

/// The target of a camera at the observer: the point on its line of sight nearest to the centre of the objects.
fn focus_of(scene: &Scene, observer: &Observer) -> Vec3 {
    let forward = rotation(observer.direction) * Vec3::NEG_Z;
    let count = scene.objects.len().max(1) as f32;
    let middle = scene.objects.iter().map(|o| o.position).sum::<Vec3>() / count;
    observer.position + forward * (middle - observer.position).dot(forward).max(0.5)
}

fn put_at(camera: &mut PanOrbitCamera, transform: &mut Transform, place: Transform, focus: Vec3) {
    *transform = place;
    camera.focus = focus;
    camera.yaw = None;
    camera.pitch = None;
    camera.radius = None;
    camera.initialized = false;
}

/// Enables the mouse controls only if nothing else uses the mouse, and detaches a moved camera from the observer.
fn gate(
    over: Res<OverPicture>,
    buttons: Res<ButtonInput<MouseButton>>,
    keys: Res<ButtonInput<KeyCode>>,
    touches: Res<Touches>,
    mut wheel: MessageReader<MouseWheel>,
    mut motion: MessageReader<MouseMotion>,
    mut dragging: Local<bool>,
    mut cameras: Query<(&mut PanOrbitCamera, &mut PictureCamera), With<WindowView>>,
) {
    let pressed = [MouseButton::Left, MouseButton::Right];
    let begins = over.pressed.is_some() && buttons.any_just_pressed(pressed);
    // With Ctrl the left button draws a frame around what shall be selected.
    let frames = keys.any_pressed(CTRL) && buttons.just_pressed(MouseButton::Left);
    *dragging = buttons.any_pressed(pressed) && (*dragging || begins && !frames);
    let pushed = over.fingers && touches.iter().any(|touch| touch.delta() != Vec2::ZERO);
    let moved = motion.read().count() > 0;
    let wheeled = wheel.read().count() > 0 && over.now;
    // A drag that started in the picture continues outside; one that started outside is ignored.
    let enabled = match over.touched {
        true => over.fingers,
        false => *dragging || (over.now && !buttons.any_pressed(pressed)),
    };
    let shift = keys.any_pressed([KeyCode::ShiftLeft, KeyCode::ShiftRight]);
    for (mut orbit, mut picture) in &mut cameras {
        if orbit.enabled != enabled {
            orbit.enabled = enabled;
        }
        let (turn, pan) = if shift {
            (MouseButton::Middle, MouseButton::Left)
        } else {
            (MouseButton::Left, MouseButton::Right)
        };
        if orbit.button_pan != pan {
            orbit.button_orbit = turn;
            orbit.button_pan = pan;
        }
        if picture.follows_observer && ((*dragging && moved) || wheeled || pushed) {
            picture.follows_observer = false;
        }
    }
}

/// Keeps the controls up to date while the camera follows the observer, so that a drag starts there.
fn keep_at_observer(
    scene: Res<CurrentScene>,
    mut cameras: Query<(&mut PanOrbitCamera, &mut Transform, &PictureCamera), With<WindowView>>,
    mut known: Local<Option<(Observer, Vec3)>>,
) {
    let observer = scene.0.observer;
    let focus = focus_of(&scene.0, &observer);
    for (mut orbit, mut transform, picture) in &mut cameras {
        if !picture.follows_observer {
            *known = None;
        } else if *known != Some((observer, focus)) {
            let place =
                Transform::from_translation(observer.position).with_rotation(rotation(observer.direction));
            put_at(&mut orbit, &mut transform, place, focus);
            *known = Some((observer, focus));
        }
    }
}

/// Reports the position of the camera, and the shape of what it shows, to the panels.
fn feed_viewpoint(
    mut session: ResMut<Session>,
    area: Option<Res<PictureArea>>,
    cameras: Query<(&Transform, &PictureCamera), With<WindowView>>,
) {
    if let Some((transform, picture)) = cameras.iter().next() {
        let facts = &mut session.bypass_change_detection().facts;
        (facts.camera, facts.eye) = (transform.rotation, transform.translation);
        facts.camera_is_free = !picture.follows_observer;
        facts.aspect = area.and_then(|area| area.aspect());
    }
}

/// Distance at which an object of the given size takes about half of the smaller side of a picture, in metres; never
/// inside the object. The picture has the vertical field of view in radians, and the ratio of width to height.
fn framing(size: f32, [field_of_view, aspect]: [f32; 2]) -> f32 {
    let tangent = (0.5 * field_of_view).tan() * aspect.min(1.0);
    (0.91 * size / tangent).max(1.1 * size).max(2.2 * NEAREST)
}

/// The camera and its target after a movement.
fn steered(camera: Transform, focus: Vec3, steer: Steer) -> (Transform, Vec3) {
    let offset = camera.translation - focus;
    match steer {
        Steer::Turn(right, up) => {
            let turn = Quat::from_rotation_y(right.to_radians());
            let axis = turn * camera.rotation * Vec3::X;
            let turned = turn * offset;
            let elevation = (turned.y / turned.length().max(NEAREST)).clamp(-1.0, 1.0).asin();
            let wanted = (elevation + up.to_radians()).clamp(-HIGHEST, HIGHEST);
            let turn = Quat::from_axis_angle(axis, elevation - wanted) * turn;
            let place = camera.with_translation(focus + turn * offset).with_rotation(turn * camera.rotation);
            (place, focus)
        }
        Steer::Move(right, up) => {
            let step = camera.rotation * Vec3::new(right, up, 0.0) * 0.05 * offset.length().max(NEAREST);
            (camera.with_translation(camera.translation + step), focus + step)
        }
        Steer::Zoom(factor) => {
            let distance = (offset.length() * factor).max(NEAREST);
            (camera.with_translation(focus + offset.normalize_or(Vec3::Z) * distance), focus)
        }
        Steer::Along { point, way } => {
            let offset = camera.translation - point;
            // From the nearer side.
            let back = if way.dot(offset) < 0.0 { -way } else { way }.normalize_or(camera.rotation * Vec3::Z);
            let elevation = back.y.clamp(-1.0, 1.0).asin().clamp(-HIGHEST, HIGHEST);
            let right = camera.rotation * Vec3::X;
            let level = back.with_y(0.0).normalize_or(right.cross(Vec3::Y));
            let back = level * elevation.cos() + Vec3::Y * elevation.sin();
            let place = Transform::from_translation(point + back * offset.length().max(NEAREST));
            (place.with_rotation(rotation(-back)), point)
        }
    }
}

/// A camera that is kept: position, target, and true if it follows the observer.
#[derive(Clone, Copy, Debug)]
pub(super) struct Waiting {
    place: Transform,
    focus: Vec3,
    follows_observer: bool,
}

/// Camera movements requested by panels.
#[derive(SystemParam)]
pub(super) struct CameraControl<'w, 's> {
    scene: Res<'w, CurrentScene>,
    cameras: Query<
        'w,
        's,
        (&'static mut PanOrbitCamera, &'static mut Transform, &'static mut PictureCamera),
        With<WindowView>,
    >,
    /// What the pictures show, which may be more than what the observer sees.
    lenses: Query<'w, 's, &'static Projection, With<WindowView>>,
    waiting: Local<'s, Option<Waiting>>,
}

impl CameraControl<'_, '_> {
    /// Keeps the camera for another document, or exchanges it with the one kept.
    pub(super) fn change(&mut self, change: CameraChange) {
        let Some((mut orbit, mut transform, mut picture)) = self.cameras.iter_mut().next() else { return };
        let now =
            Waiting { place: *transform, focus: orbit.focus, follows_observer: picture.follows_observer };
        let before = self.waiting.replace(now);
        match (change, before) {
            (CameraChange::Exchange, Some(Waiting { place, focus, follows_observer: false })) => {
                picture.follows_observer = false;
                put_at(&mut orbit, &mut transform, place, focus);
            }
            _ => picture.follows_observer = true,
        }
    }

    /// Returns to the observer.
    pub(super) fn home(&mut self) {
        for (_, _, mut picture) in &mut self.cameras {
            picture.follows_observer = true;
        }
    }

    /// Turns to the selection, keeping the direction of view.
    pub(super) fn focus(&mut self, session: &Session, registry: &Registry) {
        let scene = &self.scene.0;
        let corner = scene.scene_size.corner();
        let together = Together::of(session, registry).map(|all| (all.middle(), all.span().max(0.5)));
        let found = match session.selection {
            _ if together.is_some() => together,
            Selection::Object(i) => scene.objects.get(i).map(|object| (object.position, object.size)),
            Selection::Light(i) => scene.lights.get(i).and_then(|light| {
                let span = registry.light(&light.light_type).map_or(0.0, |of| of.span(&light.parameters));
                Some((light.position?, span.max(0.5)))
            }),
            Selection::Observer => return self.home(),
            Selection::Room => Some((corner * 0.5, corner.max_element())),
        };
        let Some((target, size)) = found else { return };
        let lens = self.lenses.iter().find_map(|lens| match lens {
            Projection::Perspective(lens) => Some([lens.fov, lens.aspect_ratio]),
            _ => None,
        });
        let lens = lens.unwrap_or([scene.observer.field_of_view.to_radians(), 1.0]);
        for (mut orbit, mut transform, mut picture) in &mut self.cameras {
            picture.follows_observer = false;
            let distance = framing(size, lens);
            let backward = transform.rotation * Vec3::Z;
            let place = transform.with_translation(target + backward * distance);
            put_at(&mut orbit, &mut transform, place, target);
        }
    }

    /// Moves the camera by a small step.
    pub(super) fn steer(&mut self, steer: Steer) {
        for (mut orbit, mut transform, mut picture) in &mut self.cameras {
            picture.follows_observer = false;
            let (place, focus) = steered(*transform, orbit.focus, steer);
            put_at(&mut orbit, &mut transform, place, focus);
        }
    }

    /// Moves the observer to the camera, if the scene allows it.
    pub(super) fn place_observer(&mut self, session: &mut Session, registry: &Registry) {
        let Some((_, transform, _)) = self.cameras.iter().next() else { return };
        let observer = Observer {
            position: transform.translation,
            direction: transform.rotation * Vec3::NEG_Z,
            ..session.document.observer
        };
        session.apply(Action::Edit(Edit::from(observer)), registry);
        if session.document.observer == observer {
            self.home();
        }
    }
}

#[cfg(test)]
mod tests {
    use bevy_egui::egui::{Pos2, Rect, vec2};

    use super::*;

    #[test]
    fn what_is_focused_is_framed_with_every_field_of_view() {
        for (degrees, size) in [(10.0, 2.0), (45.0, 0.1), (45.0, 8.0), (90.0, 2.0)] {
            for aspect in [0.4, 1.0, 1.8] {
                let vertical = f32::to_radians(degrees);
                let distance = framing(size, [vertical, aspect]);
                let up = distance * (0.5 * vertical).tan();
                let share = 0.5 * size / (up * aspect).min(up);
                assert!((0.4..0.6).contains(&share), "{degrees}°, {aspect}: {share}");
            }
        }
        assert!(framing(2.0, [f32::to_radians(150.0), 1.0]) > 2.0, "outside of it");
    }

    fn focus_selection(mut camera: CameraControl, session: Res<Session>, registry: Res<Registry>) {
        camera.focus(&session, &registry);
    }

    #[test]
    fn what_is_focused_beside_another_object_is_framed_in_narrow_views() {
        use crate::scene::{Object, Variant, comparison::Layout};
        // A copy, for which views beside each other have become wider.
        let object = |x: f32| Object { position: Vec3::new(x, 5.0, 5.0), size: 3.0, ..Object::default() };
        let mut scene = Scene { objects: [5.0, 8.0].map(object).into(), ..Scene::default() };
        scene.comparison.layout = Layout::SideBySide;
        scene.variants.push(Variant::default());
        let aspect = 0.7;
        let fov = scene.view_angle().vertical(aspect);
        let mut session = Session::new(scene.clone());
        session.selection = Selection::Object(1);
        let mut app = App::new();
        app.insert_resource(CurrentScene(scene))
            .insert_resource(session)
            .insert_resource(Registry::builtin());
        let lens = PerspectiveProjection { fov, aspect_ratio: aspect, ..default() };
        let camera = app
            .world_mut()
            .spawn((
                WindowView,
                PanOrbitCamera::default(),
                PictureCamera { follows_observer: true, fits_width: true },
                Transform::default(),
                Projection::Perspective(lens),
            ))
            .id();
        app.add_systems(Update, focus_selection);
        app.update();
        let place = app.world().get::<Transform>(camera).expect("it has a place").translation;
        let across = place.distance(Vec3::new(8.0, 5.0, 5.0)) * (0.5 * fov).tan() * aspect;
        assert!((0.4..0.6).contains(&(1.5 / across)), "{}", 1.5 / across);
    }

    #[test]
    fn the_panels_know_where_the_camera_is_and_the_shape_of_the_pictures() {
        let mut app = App::new();
        app.init_resource::<Session>().init_resource::<PictureArea>();
        let place = Transform::from_xyz(1.0, 2.0, 3.0);
        app.world_mut().spawn((
            WindowView,
            PictureCamera { follows_observer: false, fits_width: false },
            place,
        ));
        app.add_systems(Update, feed_viewpoint);
        app.update();
        assert_eq!(app.world().resource::<Session>().facts.aspect, None, "there is no picture yet");
        let frame = Rect::from_min_size(Pos2::ZERO, vec2(600.0, 400.0));
        app.insert_resource(PictureArea { frame, ..default() });
        app.update();
        let facts = &app.world().resource::<Session>().facts;
        assert_eq!((facts.eye, facts.aspect), (place.translation, Some(1.5)));
        assert!(facts.camera_is_free);
    }

    #[test]
    fn keys_turn_about_what_is_looked_at_and_keep_the_distance() {
        let focus = Vec3::new(5.0, 5.0, 5.0);
        let camera = Transform::from_translation(Vec3::new(5.0, 5.0, 9.5));
        let looks_at = |camera: Transform, focus: Vec3| {
            (camera.rotation * Vec3::NEG_Z).dot((focus - camera.translation).normalize())
        };
        let (right, same) = steered(camera, focus, Steer::Turn(90.0, 0.0));
        assert_eq!(same, focus);
        assert!(right.translation.abs_diff_eq(Vec3::new(9.5, 5.0, 5.0), 1e-4), "{right:?}");
        assert!(looks_at(right, focus) > 0.999);
        let (up, _) = steered(camera, focus, Steer::Turn(0.0, 30.0));
        assert!(up.translation.y > 7.0 && (up.translation - focus).length() - 4.5 < 1e-4, "{up:?}");
        assert!(looks_at(up, focus) > 0.999);
        // Never over the pole.
        let mut above = camera;
        for _ in 0..100 {
            above = steered(above, focus, Steer::Turn(0.0, 5.0)).0;
        }
        assert!(above.translation.y > 9.4 && (above.rotation * Vec3::Y).y > 0.0, "{above:?}");
        assert!(looks_at(above, focus) > 0.999);
        let (moved, ahead) = steered(camera, focus, Steer::Move(1.0, 0.0));
        assert_eq!(moved.translation - camera.translation, ahead - focus);
        assert!(ahead.x > focus.x);
        // From the side: face on, at the same distance, from the nearer side, upright.
        for way in [Vec3::X, Vec3::NEG_X, Vec3::new(1.0, -2.0, 0.5), Vec3::Y, Vec3::NEG_Z] {
            let point = Vec3::new(5.5, 5.2, 5.9);
            let (aside, ahead) = steered(camera, focus, Steer::Along { point, way });
            assert_eq!(ahead, point);
            let offset = aside.translation - point;
            let before = camera.translation.distance(point);
            assert!((offset.length() - before).abs() < 1e-4, "{way}");
            assert!(offset.normalize().dot(way.normalize()).abs() > 0.9999, "{way}: {offset}");
            assert!(offset.dot(camera.translation - point) > 0.0 || way == Vec3::Y, "{way}");
            assert!(looks_at(aside, point) > 0.9999 && (aside.rotation * Vec3::X).y.abs() < 1e-5, "{way}");
        }
        let (near, _) = steered(camera, focus, Steer::Zoom(0.5));
        assert!((near.translation - focus).length() - 2.25 < 1e-5);
    }
}
