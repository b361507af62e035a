//! What is drawn over the picture to explain it: the room as an outline, the lights with their
//! position, direction and cone, the observer when the camera has left it, and what is selected.

use bevy::{
    app::{App, Plugin},
    color::{Color, Srgba},
    ecs::prelude::*,
    gizmos::{
        config::{GizmoConfig, GizmoConfigGroup},
        gizmos::Gizmos,
        primitives::dim3::GizmoPrimitive3d,
    },
    math::{Isometry3d, primitives::Cuboid},
    reflect::Reflect,
    transform::components::Transform,
};
use glam::{Quat, Vec3};

use crate::{
    app::{LabFrame, LabSystems},
    observer::{camera::PictureCamera, rotation as look_along},
    panel::state::{Lab, Selection},
    registry::Registry,
    scene::{
        Light, Object, Observer, Scene,
        spawn::{CurrentScene, object_transform},
    },
    shape::PolygonMesh,
};

/// Marks that are hidden by what stands before them: the room.
#[derive(Default, Reflect, GizmoConfigGroup)]
struct InRoom;

/// Marks that are always seen: lights, observer, selection.
#[derive(Default, Reflect, GizmoConfigGroup)]
struct OnTop;

pub(super) struct GizmosPlugin;

impl Plugin for GizmosPlugin {
    fn build(&self, app: &mut App) {
        use bevy::gizmos::AppGizmoBuilder;
        app.insert_gizmo_config(InRoom, config(1.0, 0.0))
            .insert_gizmo_config(OnTop, config(1.5, -1.0))
            .add_systems(LabFrame, draw.in_set(LabSystems::Capture));
    }
}

fn config(width: f32, depth_bias: f32) -> GizmoConfig {
    let mut config = GizmoConfig { depth_bias, ..GizmoConfig::default() };
    config.line.width = width;
    config
}

/// Neutral, a little lighter than the surround.
const ROOM: Color = Color::srgb(0.36, 0.36, 0.36);
/// Okabe–Ito sky blue: the one accent.
const SELECTED: Color = Color::srgb(0.337, 0.706, 0.914);
/// Okabe–Ito yellow: lights.
const LIGHT: Color = Color::srgb(0.941, 0.894, 0.259);
/// Okabe–Ito bluish green: the observer.
const OBSERVER: Color = Color::srgb(0.0, 0.62, 0.451);

/// Radius of a light's mark, metres per metre of distance from the camera: the same size everywhere.
const MARK: f32 = 0.012;

/// More lights than this get small marks.
const CROWD: usize = 24;

/// Length of arrows and cones, metres per metre of distance from the camera: in a large room they
/// would else cover the picture.
const REACH: f32 = 0.14;

fn draw(
    lab: Res<Lab>,
    scene: Res<CurrentScene>,
    registry: Res<Registry>,
    cameras: Query<(&Transform, &PictureCamera)>,
    mut room: Gizmos<InRoom>,
    mut top: Gizmos<OnTop>,
) {
    let Ok((eye, camera)) = cameras.single() else { return };
    let scene = &scene.0;
    let corner = scene.scene_size.corner();
    if lab.view.show_room {
        room.primitive_3d(&Cuboid::from_size(corner), Isometry3d::from_translation(corner * 0.5), ROOM);
        draw_floor(&mut room, corner);
    }
    if lab.view.show_gizmos {
        for (i, light) in scene.lights.iter().enumerate() {
            let selected = lab.selection == Selection::Light(i);
            draw_light(&mut top, light, selected, scene, &registry, eye.translation);
        }
        // From within, its own pyramid would frame the picture.
        let apart = eye.translation.distance(scene.observer.position) > OBSERVER_MARK;
        if !camera.follows_observer && apart {
            draw_observer(&mut top, &scene.observer, lab.selection == Selection::Observer);
        }
        if let Selection::Object(i) = lab.selection
            && let Some(object) = scene.objects.get(i)
        {
            draw_selection(&mut top, object, &registry);
        }
    }
}

/// Lines on the floor every metre or, in large rooms, every ten.
fn draw_floor(gizmos: &mut Gizmos<InRoom>, corner: Vec3) {
    let step = if corner.x.max(corner.z) > 20.0 { 10.0 } else { 1.0 };
    let faint = ROOM.with_alpha_factor(0.35);
    for i in 1..=(corner.x / step) as u32 {
        let x = i as f32 * step;
        gizmos.line(Vec3::new(x, 0.0, 0.0), Vec3::new(x, 0.0, corner.z), faint);
    }
    for i in 1..=(corner.z / step) as u32 {
        let z = i as f32 * step;
        gizmos.line(Vec3::new(0.0, 0.0, z), Vec3::new(corner.x, 0.0, z), faint);
    }
}

trait Faint {
    fn with_alpha_factor(self, factor: f32) -> Color;
}

impl Faint for Color {
    fn with_alpha_factor(self, factor: f32) -> Color {
        let c = Srgba::from(self);
        Color::srgba(c.red, c.green, c.blue, c.alpha * factor)
    }
}

fn draw_light(
    gizmos: &mut Gizmos<OnTop>,
    light: &Light,
    selected: bool,
    scene: &Scene,
    registry: &Registry,
    eye: Vec3,
) {
    let Some(entry) = registry.light(&light.kind) else { return };
    let colour = if selected { SELECTED } else { LIGHT };
    // A light without a place is drawn under the middle of the ceiling; one without place and
    // direction comes from everywhere and has no mark.
    let corner = scene.scene_size.corner();
    let position = light.position.unwrap_or(Vec3::new(0.5 * corner.x, 0.95 * corner.y, 0.5 * corner.z));
    // Where there are many, full marks would cover the picture.
    let crowded = scene.lights.len() > CROWD && !selected;
    let mark = MARK * position.distance(eye).max(0.5) * if crowded { 0.3 } else { 1.0 };
    let direction = light.direction.and_then(Vec3::try_normalize);
    if light.position.is_some() {
        gizmos.sphere(Isometry3d::from_translation(position), mark, colour).resolution(if crowded {
            6
        } else {
            16
        });
        if direction.is_none() && !crowded {
            for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
                for sign in [-1.0, 1.0] {
                    gizmos.line(
                        position + axis * sign * mark * 1.5,
                        position + axis * sign * mark * 2.4,
                        colour,
                    );
                }
            }
        }
    }
    let Some(direction) = direction else { return };
    let length = (0.12 * corner.max_element()).min(REACH * position.distance(eye).max(0.5));
    let turn = Quat::from_rotation_arc(Vec3::Z, direction);
    match entry.declaration.cone_parameter {
        Some(index) => {
            let angle = entry.numbers(&light.parameters)[index].to_radians();
            // The rim on a sphere around the light: also a half angle of 90° has one.
            let rim = position + direction * (length * angle.cos());
            let radius = length * angle.sin();
            gizmos.circle(Isometry3d::new(rim, turn), radius, colour).resolution(48);
            for side in [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y] {
                gizmos.line(position, rim + turn * side * radius, colour);
            }
            gizmos.arrow(position, position + direction * length * 1.25, colour).with_tip_length(mark * 1.5);
        }
        None => {
            for side in [Vec3::ZERO, Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y] {
                let start = position + turn * side * (0.3 * length);
                gizmos.arrow(start, start + direction * length, colour).with_tip_length(mark * 1.5);
            }
        }
    }
}

/// Length of the observer's mark, metres.
const OBSERVER_MARK: f32 = 0.4;

/// The observer as the pyramid of its view.
fn draw_observer(gizmos: &mut Gizmos<OnTop>, observer: &Observer, selected: bool) {
    let colour = if selected { SELECTED } else { OBSERVER };
    let turn = look_along(observer.direction);
    let half = OBSERVER_MARK * (observer.field_of_view.min(120.0) * 0.5).to_radians().tan();
    let corners = [(-1.6, -1.0), (1.6, -1.0), (1.6, 1.0), (-1.6, 1.0)]
        .map(|(x, y)| observer.position + turn * Vec3::new(x * half, y * half, -OBSERVER_MARK));
    for i in 0..4 {
        gizmos.line(observer.position, corners[i], colour);
        gizmos.line(corners[i], corners[(i + 1) % 4], colour);
    }
    let top = (corners[2] + corners[3]) * 0.5;
    gizmos.line(corners[3], top + turn * Vec3::Y * half * 0.5, colour);
    gizmos.line(corners[2], top + turn * Vec3::Y * half * 0.5, colour);
}

/// The corners of the box around the selected object, so that little of the object is covered.
fn draw_selection(gizmos: &mut Gizmos<OnTop>, object: &Object, registry: &Registry) {
    let Some(shape) = registry.shape(&object.kind) else { return };
    // The coarsest mesh has the extent of any other, nearly.
    let half =
        half_extent(&shape.mesh(*shape.declaration.tessellation.start())).max(Vec3::splat(0.02)) * 1.04;
    let place = object_transform(object);
    for corner in 0..8u32 {
        let sign = Vec3::new(
            if corner & 1 == 0 { -1.0 } else { 1.0 },
            if corner & 2 == 0 { -1.0 } else { 1.0 },
            if corner & 4 == 0 { -1.0 } else { 1.0 },
        );
        let at = sign * half;
        for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
            let inward = at - axis * at * 0.2;
            gizmos.line(place.transform_point(at), place.transform_point(inward), SELECTED);
        }
    }
}

fn half_extent(mesh: &PolygonMesh) -> Vec3 {
    mesh.positions.iter().fold(Vec3::ZERO, |extent, p| extent.max(p.abs()))
}
