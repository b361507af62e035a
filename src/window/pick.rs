//! Clicking into the picture selects what is under the pointer.

use bevy::{
    camera::Camera,
    ecs::prelude::*,
    input::{ButtonInput, mouse::MouseButton},
    math::Ray3d,
    picking::mesh_picking::ray_cast::{MeshRayCast, MeshRayCastSettings, RayCastVisibility},
    transform::components::GlobalTransform,
    window::{PrimaryWindow, Window},
};
use glam::Vec2;

use super::PicturePlace;
use crate::{
    document::Selection,
    panel::{
        marks::{self, Lens},
        state::{Action, Lab},
    },
    registry::Registry,
    render::{
        camera::PictureCamera,
        entities::{CurrentScene, LitObject, SceneEntities},
    },
};

/// How far from a light's mark a click still means it, points.
const LIGHT_REACH: f32 = 12.0;
/// How far the pointer may move between press and release of a click, points.
const CLICK_SLACK: f32 = 4.0;

/// Selects the light whose mark, or else the object whose surface, was clicked.
pub(super) fn pick(
    buttons: Res<ButtonInput<MouseButton>>,
    window: Single<&Window, With<PrimaryWindow>>,
    cameras: Query<(&Camera, &GlobalTransform), With<PictureCamera>>,
    scene: Res<CurrentScene>,
    entities: Res<SceneEntities>,
    objects: Query<(), With<LitObject>>,
    registry: Res<Registry>,
    mut lab: ResMut<Lab>,
    mut ray_cast: MeshRayCast,
    mut pressed_at: Local<Option<Vec2>>,
) {
    let pointer = window.cursor_position();
    if buttons.just_pressed(MouseButton::Left) {
        *pressed_at = pointer.filter(|_| lab.pointer_in_picture);
    }
    if !buttons.just_released(MouseButton::Left) {
        return;
    }
    let (Some(start), Some(end)) = (pressed_at.take(), pointer) else { return };
    let Ok((camera, place)) = cameras.single() else { return };
    if start.distance(end) > CLICK_SLACK * lab.zoom {
        return;
    }
    let end = PicturePlace::of(&lab, &window).within(&window, end);
    let reach = LIGHT_REACH * lab.zoom * window.scale_factor();
    let light =
        lab.view.show_gizmos.then(|| nearest_light(&scene, &lab, camera, place, end, reach)).flatten();
    let selection = light.map(Selection::Light).or_else(|| {
        let ray: Ray3d = camera.viewport_to_world(place, end).ok()?;
        let filter = |e: Entity| objects.contains(e);
        // A picture that stands still draws no object, but shows all of them.
        let settings =
            MeshRayCastSettings::default().with_filter(&filter).with_visibility(RayCastVisibility::Visible);
        let (hit, _) = ray_cast.cast_ray(ray, &settings).first()?;
        entities.objects.iter().position(|e| e == hit).map(Selection::Object)
    });
    if let Some(selection) = selection
        && selection != lab.selection
    {
        lab.apply(Action::Select(selection), &registry);
    }
}

fn nearest_light(
    scene: &CurrentScene,
    lab: &Lab,
    camera: &Camera,
    place: &GlobalTransform,
    pointer: Vec2,
    reach: f32,
) -> Option<usize> {
    let lens = Lens::of(lab, lab.picture_rect);
    scene
        .0
        .lights
        .iter()
        .enumerate()
        .filter_map(|(i, light)| {
            let at = camera.world_to_viewport(place, marks::place(light, &scene.0, &lens)?).ok()?;
            Some((i, at.distance(pointer)))
        })
        .filter(|(_, distance)| *distance <= reach)
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .map(|(i, _)| i)
}
