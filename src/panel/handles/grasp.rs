//! A dragged handle: from the motion of the pointer to a value.

use std::f32::consts::{PI, TAU};

use bevy_egui::egui::Pos2;
use glam::{Quat, Vec3};

use super::{
    Handle,
    shape::{Body, Placed, Target},
};
use crate::{
    document::{Edit, Selection},
    panel::{
        marks::{Lens, Ray},
        state::Together,
    },
    parameter::{Parameter, Value},
    scene::{Light, Object, Part, SceneSize, rotation::rotation},
};

/// Step of positions and sizes with Ctrl, in metres.
const METRES: f32 = 0.25;
/// Step of angles with Ctrl, in degrees.
pub(super) const DEGREES: f32 = 15.0;
/// Sine of the angle between a ring's plane and the line of sight below which the ring turns like a wheel seen from the
/// side.
const EDGE_ON: f32 = 0.2;
/// Sine of the angle between the line of sight and the plane of a cone's axis and handle, below which the cone is seen
/// end on.
const SIDEWAYS: f32 = 0.35;
/// Distance from the centre, in radii, beyond which a handle is off its sphere.
const OFF: f32 = 1.15;

/// The value that a drag sets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Dragged {
    /// The position, in metres.
    Position(Vec3),
    /// The rotation, in degrees, and the angle about the axis.
    Rotation(Vec3, f32),
    /// The size, in metres.
    Size(f32),
    /// The direction of a light.
    Direction(Vec3),
    /// A parameter of a light, in the parameter's unit.
    Parameter(f32),
}

impl Dragged {
    /// A parameter that is a number.
    pub(super) fn parameter(value: Option<Value>) -> Option<Self> {
        match value? {
            Value::Number(value) => Some(Self::Parameter(value)),
            _ => None,
        }
    }
}

/// A place of the pointer that pulls a handle.
pub(super) struct Pull<'a> {
    pub(super) lens: &'a Lens,
    /// Centre of the handles.
    pub(super) at: Vec3,
    pub(super) pointer: Pos2,
    /// The line of sight where the handle was grasped.
    pub(super) start: Ray,
    /// The line of sight now.
    pub(super) now: Ray,
    /// Values go in larger steps.
    pub(super) snap: bool,
    /// The step of lengths, metres.
    pub(super) step: f32,
    pub(super) room: SceneSize,
}

impl Pull<'_> {
    /// The place where a line of sight meets the plane of the picture through the middle of the handles.
    pub(super) fn flat(&self, ray: Ray) -> Option<Vec3> {
        let [_, _, ahead] = self.lens.axes();
        on_plane(ray, self.at, ahead)
    }
}

/// A dragged handle, with the values from the start of the drag.
#[derive(Clone, Debug)]
pub(super) struct Grasp {
    pub(super) handle: Handle,
    pub(super) part: Selection,
    /// Centre of the handles.
    pub(super) at: Vec3,
    /// Position of the pointer.
    pub(super) pointer: Pos2,
    /// The point in the scene that the handle represents.
    pub(super) point: Vec3,
    pub(super) rotation: Quat,
    pub(super) size: f32,
    pub(super) direction: Vec3,
    /// The parameter of a light that the handle changes, and the value.
    pub(super) parameter: Option<(&'static Parameter, f32)>,
    /// Vector to the end of a size of a light, and the fraction of the size that it covers.
    pub(super) end: Option<(Vec3, f32)>,
    /// Several parts, as they were.
    pub(super) together: Option<Together>,
    /// True if the handle is on the side of its sphere that faces the camera.
    near: bool,
    /// True if the handle was pulled off its sphere; when it returns, it changes sides.
    off: bool,
}

/// The nearest multiple of a step.
pub(super) fn snapped(v: f32, step: f32) -> f32 {
    (v / step).round() * step
}

/// An angle from −180° to 180°, in degrees.
pub(super) fn wrapped(radians: f32) -> f32 {
    let degrees = ((radians + PI).rem_euclid(TAU) - PI).to_degrees();
    if degrees <= -179.999 { 180.0 } else { degrees }
}

/// The largest power of ten up to a length, between 0.0001 and 0.01.
fn decimal(length: f32) -> f32 {
    10f32.powf(length.max(1e-6).log10().floor()).clamp(1e-4, 0.01)
}

/// The point at which a line of sight meets a plane.
fn on_plane(ray: Ray, through: Vec3, normal: Vec3) -> Option<Vec3> {
    let t = (through - ray.eye).dot(normal) / ray.way.dot(normal);
    (t.is_finite() && t > 0.0).then(|| ray.eye + t * ray.way)
}

/// The direction from the centre of a sphere to the near or far intersection with a line of sight; if the line misses,
/// to the nearest point of the outline.
fn on_sphere(ray: Ray, middle: Vec3, radius: f32, near: bool) -> Option<Vec3> {
    let to = middle - ray.eye;
    let closest = to.dot(ray.way);
    let inside = radius * radius - (to.length_squared() - closest * closest);
    let depth = inside.max(0.0).sqrt();
    let t = if near && closest > depth { closest - depth } else { closest + depth };
    (ray.eye + t * ray.way - middle).try_normalize()
}

/// True if the end of an arm is on the side of a sphere that is visible from `eye`.
fn is_near(arm: Vec3, eye: Vec3) -> bool {
    let limb = arm.length() / eye.length().max(1e-6);
    arm.normalize_or_zero().dot(eye.normalize_or_zero()) > limb - 0.01
}

/// The angle by which a rotation turns about an axis.
pub(super) fn twist(rotation: Quat, axis: Vec3) -> f32 {
    2.0 * rotation.xyz().dot(axis).atan2(rotation.w)
}

/// Azimuth and elevation of a direction in degrees: about y from +z, and above the horizon.
pub(super) fn angles(direction: Vec3) -> [f32; 2] {
    [direction.x.atan2(direction.z), direction.y.clamp(-1.0, 1.0).asin()].map(f32::to_degrees)
}

impl Grasp {
    /// Starts to drag a handle.
    pub(super) fn of(placed: &Placed, target: &Target, lens: &Lens, pointer: Pos2) -> Self {
        let mut grasp = Self {
            handle: placed.handle,
            part: target.part,
            at: target.at,
            pointer,
            point: placed.point,
            rotation: Quat::IDENTITY,
            size: 1.0,
            direction: Vec3::NEG_Y,
            parameter: None,
            end: None,
            near: is_near(placed.point - target.at, lens.eye - target.at),
            together: None,
            off: false,
        };
        match &target.body {
            Body::Group(all) => grasp.together = Some(all.clone()),
            Body::Object(object, _) => {
                (grasp.rotation, grasp.size) = (rotation(object.rotation), object.size);
            }
            Body::Light(light, _) => {
                grasp.direction = light.direction.and_then(Vec3::try_normalize).unwrap_or(Vec3::NEG_Y);
                let parameter = target.parameter(placed.handle);
                grasp.parameter = parameter.map(|p| (p, light.parameters.number(p)));
            }
        }
        (placed.handle.sort.hold)(&mut grasp, target, lens);
        grasp
    }

    /// The value for a pointer position, in steps if `snap` is set; `None` if the position is meaningless.
    pub(super) fn drag(&self, lens: &Lens, pointer: Pos2, snap: bool, room: SceneSize) -> Option<Dragged> {
        let step = if snap { METRES } else { decimal(lens.metres(self.at, 1.0)) };
        let (start, now) = (lens.ray(self.pointer), lens.ray(pointer));
        (self.handle.sort.drag)(self, &Pull { lens, at: self.at, pointer, start, now, snap, step, room })
    }

    /// The legal value of its parameter that is nearest.
    pub(super) fn nearest(&self, value: f32) -> Option<Dragged> {
        Dragged::parameter(self.parameter?.0.nearest(&Value::Number(value)))
    }

    /// The name of its parameter.
    pub(super) fn label(&self) -> &'static str {
        self.parameter.map_or("", |(parameter, _)| parameter.label)
    }

    /// Displacement of a point along an axis, in metres, for the motion of the pointer. Only the motion along the
    /// projected axis counts, and the point moves as far in the picture as the pointer, wherever the handle was
    /// grabbed.
    pub(super) fn moved_along(&self, lens: &Lens, pointer: Pos2, from: Vec3, axis: Vec3) -> Option<f32> {
        let place = lens.project(from)?;
        let end = lens.project(from + lens.metres(from, 10.0) * axis)?;
        let seen = (end - place).normalized();
        lens.ray(place + seen * (pointer - self.pointer).dot(seen)).along(from, axis)
    }

    /// The angle by which the pointer turns a ring about an axis, in radians.
    pub(super) fn turned_about(&self, lens: &Lens, pointer: Pos2, axis: Vec3) -> Option<f32> {
        let (start, now) = (lens.ray(self.pointer), lens.ray(pointer));
        let to_eye = (lens.eye - self.at).normalize_or_zero();
        if axis.dot(to_eye).abs() < EDGE_ON {
            let [_, _, ahead] = lens.axes();
            let flat = |ray: Ray| on_plane(ray, self.at, ahead);
            let across = axis.cross(to_eye).normalize_or_zero();
            let radius = (self.point - self.at).length();
            return Some((flat(now)? - flat(start)?).dot(across) / radius);
        }
        let angle = |ray: Ray| {
            let arm = on_plane(ray, self.at, axis)? - self.at;
            let first = axis.any_orthonormal_vector();
            Some(arm.dot(axis.cross(first)).atan2(arm.dot(first)))
        };
        Some(angle(now)? - angle(start)?)
    }

    /// Takes note of a place of the pointer: pulled off its sphere and back, a handle is on its other side.
    pub(super) fn follow(&mut self, lens: &Lens, pointer: Pos2) {
        let Some(end) = self.end(lens, pointer).filter(|_| self.handle.sort.is_on_sphere) else { return };
        let (ray, to) = (lens.ray(end), self.at - lens.eye);
        let beside = to.reject_from_normalized(ray.way).length() / (self.point - self.at).length();
        if beside > OFF {
            self.off = true;
        } else if self.off && beside < 1.0 {
            (self.off, self.near) = (false, !self.near);
        }
    }

    /// The position in the picture of the point that the handle represents, corrected for the point where it was
    /// grabbed.
    fn end(&self, lens: &Lens, pointer: Pos2) -> Option<Pos2> {
        Some(pointer + (lens.project(self.point)? - self.pointer))
    }

    /// The direction to the represented point when the pointer pulls it along its sphere.
    pub(super) fn pulled(&self, lens: &Lens, pointer: Pos2) -> Option<Vec3> {
        let ray = lens.ray(self.end(lens, pointer)?);
        on_sphere(ray, self.at, (self.point - self.at).length(), self.near)
    }

    /// The angle between the axis of a cone and the point to which the cone's edge is pulled.
    pub(super) fn opened(&self, lens: &Lens, pointer: Pos2) -> Option<f32> {
        let side = (self.point - self.at).reject_from(self.direction).normalize_or_zero();
        let normal = self.direction.cross(side);
        if normal.dot((lens.eye - self.at).normalize_or_zero()).abs() < SIDEWAYS {
            return Some(self.direction.angle_between(self.pulled(lens, pointer)?));
        }
        // Seen from the side, the cone opens in a plane.
        let arm = on_plane(lens.ray(self.end(lens, pointer)?), self.at, normal)? - self.at;
        Some(arm.dot(side).abs().atan2(arm.dot(self.direction)))
    }

    /// The edit that gives the part a value.
    pub(super) fn edit(&self, dragged: Dragged, room: SceneSize) -> Option<Edit> {
        let part = Part::from(self.part);
        if let Some(all) = &self.together {
            return match dragged {
                Dragged::Position(p) => Some(all.moved(p - self.at, room)),
                Dragged::Rotation(_, degrees) => {
                    all.turned(Vec3::AXES[self.handle.which], degrees.to_radians(), room)
                }
                _ => None,
            };
        }
        Some(match (part, dragged) {
            (Part::Object(_), Dragged::Rotation(r, _)) => Edit::set(part, Object::rotation, r),
            (Part::Object(_), Dragged::Size(size)) => Edit::set(part, Object::size, size),
            (Part::Light(_), Dragged::Direction(d)) => Edit::set(part, Light::direction, d),
            (Part::Light(_), Dragged::Parameter(value)) => {
                Edit::parameter(part, self.parameter?.0.name, value)
            }
            (_, Dragged::Position(p)) => Edit::set(part, Object::position, p),
            _ => return None,
        })
    }

    /// The value in words.
    pub(super) fn words(&self, dragged: Dragged, metre: f32) -> String {
        let digits = if decimal(metre) < 0.005 { 3 } else { 2 };
        (self.handle.sort.words)(self, dragged, &|v| format!("{v:.digits$}")).replace('-', "−")
    }
}

/// A value in words, with what says a length in metres.
pub(super) fn words(grasp: &Grasp, dragged: Dragged, metres: &dyn Fn(f32) -> String) -> String {
    match dragged {
        Dragged::Position(p) => {
            let [x, y, z] = p.to_array().map(metres);
            format!("x {x}   y {y}   z {z} m")
        }
        Dragged::Rotation(_, angle) => format!("{angle:.0}°"),
        Dragged::Size(size) => format!("size {} m", metres(size)),
        Dragged::Direction(d) => {
            let [azimuth, elevation] = angles(d.normalize_or_zero()).map(|v| v.round() + 0.0);
            format!("azimuth {azimuth}°   elevation {elevation}°")
        }
        Dragged::Parameter(value) => format!("{} {value:.1}°", grasp.label()),
    }
}

#[cfg(test)]
mod tests {
    use bevy_egui::egui::{Rect, Vec2, pos2, vec2};

    use super::*;
    use crate::{
        panel::{
            handles::{axis, cone, direction, plane, ring, shape::placed, size},
            state::{HandleMode, Session},
        },
        registry::Registry,
        scene::{Light, Scene},
    };

    /// A view from the right and above, in which every axis is visible.
    fn session() -> Session {
        let mut scene = Scene::default();
        scene.lights[0] = Light {
            light_type: "spot".to_owned(),
            position: Some(Vec3::new(4.5, 5.5, 5.0)),
            direction: Some(Vec3::new(0.6, -0.8, 0.0)),
            ..Light::default()
        };
        let mut session = Session::new(scene);
        session.facts.camera = Quat::from_rotation_y(0.6) * Quat::from_rotation_x(-0.5);
        session.facts.eye = Vec3::splat(5.0) + session.facts.camera * Vec3::new(0.0, 0.0, 4.0);
        session
    }

    fn lens(session: &Session) -> Lens {
        Lens::of(session, Rect::from_min_size(pos2(200.0, 50.0), vec2(800.0, 600.0)))
    }

    fn grasp(session: &Session, mode: HandleMode, handle: Handle) -> (Grasp, Placed) {
        let registry = Registry::builtin();
        let target = Target::of(session, &registry, None, Vec::new).expect("selected");
        let all = placed(&target, mode, session, (&lens(session), None));
        let handle = all.iter().find(|p| p.handle == handle).expect("it is there").clone();
        let start = handle.lines.first().map_or(handle.end, |line| line[line.len() / 2]);
        (Grasp::of(&handle, &target, &lens(session), start), handle)
    }

    fn drag(session: &Session, grasp: &Grasp, to: Pos2, snap: bool) -> Dragged {
        grasp.drag(&lens(session), to, snap, session.document.scene_size).expect("it means something")
    }

    #[test]
    fn a_drag_along_an_axis_moves_along_it_and_along_no_other() {
        let session = session();
        let lens = lens(&session);
        for axis in 0..3 {
            let (grasp, _) = grasp(&session, HandleMode::Move, axis::SORT.handle(axis));
            let way = Vec3::AXES[axis];
            // Half a metre further in the picture.
            let [from, after] = [0.0, 0.5].map(|t| lens.project(grasp.at + t * way).expect("in view"));
            let to = grasp.pointer + (after - from);
            let Dragged::Position(p) = drag(&session, &grasp, to, false) else { panic!("it moves") };
            assert!((p - grasp.at - 0.5 * way).length() < 0.011, "{axis}: {p}");
            assert!((0..3).all(|other| other == axis || p[other] == grasp.at[other]), "{axis}: {p}");
            // Across the axis, it hardly moves.
            let side = (to - grasp.pointer).rot90();
            let Dragged::Position(p) = drag(&session, &grasp, grasp.pointer + side, false) else { panic!() };
            assert!((p - grasp.at).length() < 0.011, "{axis}: {p}");
        }
    }

    #[test]
    fn a_drag_in_the_plane_keeps_what_was_grasped_under_the_pointer() {
        let session = session();
        let (grasp, _) = grasp(&session, HandleMode::Move, plane::SORT.handle(0));
        let by = vec2(60.0, -25.0);
        let Dragged::Position(p) = drag(&session, &grasp, grasp.pointer + by, false) else { panic!() };
        let lens = lens(&session);
        let (before, after) = (lens.project(grasp.at).expect("seen"), lens.project(p).expect("seen"));
        assert!((after - before - by).length() < 2.0, "{:?}", after - before);
    }

    #[test]
    fn with_ctrl_values_go_in_steps_and_never_leave_the_room() {
        let session = session();
        let (grasp_x, _) = grasp(&session, HandleMode::Move, axis::SORT.handle(0));
        let is_step = |v: f32, step: f32| (v / step - (v / step).round()).abs() < 1e-3;
        let mut values = Vec::new();
        for k in -30..=30 {
            let to = grasp_x.pointer + vec2(20.0 * k as f32, 0.0);
            let Some(Dragged::Position(p)) =
                grasp_x.drag(&lens(&session), to, true, session.document.scene_size)
            else {
                continue;
            };
            assert!(session.document.scene_size.contains(p), "{p}");
            let inside = (0.011..=9.99).contains(&p.x);
            assert!(!inside || is_step(p.x, 0.25), "{p}");
            values.push(p.x);
        }
        assert!(values.windows(2).any(|v| v[0] != v[1]));
        let (ring, placed) = grasp(&session, HandleMode::Turn, ring::SORT.handle(1));
        for point in placed.lines.iter().flatten() {
            let Dragged::Rotation(degrees, angle) = drag(&session, &ring, *point, true) else { panic!() };
            assert!(
                is_step(angle, 15.0)
                    && (rotation(degrees).y.abs() - (0.5 * angle).to_radians().sin().abs()).abs() < 1e-3
            );
        }
        let (size, _) = grasp(&session, HandleMode::Size, size::SORT.handle(0));
        for k in 0..20 {
            let to = size.pointer + vec2(7.0, -7.0) * (k as f32 - 10.0);
            let Dragged::Size(metres) = drag(&session, &size, to, true) else { panic!() };
            assert!(metres >= 0.25 && is_step(metres, 0.25), "{metres}");
        }
    }

    #[test]
    fn a_ring_turns_about_its_axis_by_the_angle_of_the_drag() {
        let session = session();
        let lens = lens(&session);
        for axis in 0..3 {
            let (grasp, _) = grasp(&session, HandleMode::Turn, ring::SORT.handle(axis));
            let way = Vec3::AXES[axis];
            let arm = on_plane(lens.ray(grasp.pointer), grasp.at, way).expect("met") - grasp.at;
            let after = Quat::from_axis_angle(way, 30f32.to_radians()) * arm;
            let to = lens.project(grasp.at + after).expect("seen");
            let Dragged::Rotation(degrees, angle) = drag(&session, &grasp, to, false) else { panic!() };
            assert!((angle - 30.0).abs() <= 1.0, "{axis}: {angle}");
            assert!(degrees.distance(30.0 * way) <= 1.1, "{axis}: {degrees}");
        }
    }

    #[test]
    fn a_ring_seen_from_its_edge_turns_as_a_wheel() {
        let mut session = session();
        session.facts.camera = Quat::IDENTITY;
        session.facts.eye = Vec3::new(5.0, 5.0, 9.0);
        let (grasp, _) = grasp(&session, HandleMode::Turn, ring::SORT.handle(1));
        let Dragged::Rotation(right, _) = drag(&session, &grasp, grasp.pointer + vec2(80.0, 0.0), false)
        else {
            panic!()
        };
        // The side towards the eye turns to the right.
        assert!(right.y > 20.0 && right.x == 0.0 && right.z == 0.0, "{right}");
    }

    #[test]
    fn the_size_follows_the_distance_from_the_middle() {
        let session = session();
        let (grasp, placed) = grasp(&session, HandleMode::Size, size::SORT.handle(0));
        let middle = lens(&session).project(grasp.at).expect("seen");
        let to = middle + 1.5 * (grasp.pointer - middle);
        let before = session.document.objects[0].size;
        let Dragged::Size(size) = drag(&session, &grasp, to, false) else { panic!() };
        assert!((size / before - 1.5).abs() < 0.03, "{size}");
        assert!(placed.end.x > middle.x && placed.end.y < middle.y);
    }

    #[test]
    fn a_light_shines_to_where_its_handle_is_pulled() {
        let mut session = session();
        session.selection = Selection::Light(0);
        let (grasp, _) = grasp(&session, HandleMode::Move, direction::SORT.handle(0));
        let lens = lens(&session);
        let arm = (grasp.point - grasp.at).length();
        let wanted = Vec3::new(0.5, -0.8, -0.3).normalize();
        let to = lens.project(grasp.at + arm * wanted).expect("seen");
        let Dragged::Direction(d) = drag(&session, &grasp, to, false) else { panic!() };
        assert!(d.distance(wanted) < 0.02, "{d}");
        let Dragged::Direction(d) = drag(&session, &grasp, to, true) else { panic!() };
        let is_step = |v: f32| (v / 15.0 - (v / 15.0).round()).abs() < 0.01;
        assert!(angles(d).into_iter().all(is_step), "{:?}", angles(d));
        let still = drag(&session, &grasp, grasp.pointer, false);
        let Dragged::Direction(d) = still else { panic!() };
        assert!(d.distance(Vec3::new(0.6, -0.8, 0.0)) < 0.002, "{d}");
    }

    #[test]
    fn pulled_off_its_sphere_and_back_a_direction_is_on_the_other_side() {
        let mut session = session();
        session.selection = Selection::Light(0);
        let (mut grasp, _) = grasp(&session, HandleMode::Move, direction::SORT.handle(0));
        let lens = lens(&session);
        let middle = lens.project(grasp.at).expect("seen");
        let out = grasp.pointer - middle;
        let to_eye = (lens.eye - grasp.at).normalize();
        let pull = |grasp: &mut Grasp, part: f32| {
            let to = middle + part * out;
            grasp.follow(&lens, to);
            let Some(Dragged::Direction(d)) = grasp.drag(&lens, to, false, session.document.scene_size)
            else {
                panic!()
            };
            d.dot(to_eye)
        };
        assert!(pull(&mut grasp, 0.5) < -0.5);
        // Slightly beyond the edge does not count.
        pull(&mut grasp, 1.05);
        assert!(pull(&mut grasp, 0.5) < -0.5);
        pull(&mut grasp, 1.4);
        assert!(pull(&mut grasp, 0.5) > 0.5);
    }

    #[test]
    fn the_cone_opens_to_where_its_handle_is_pulled_and_stays_legal() {
        let mut session = session();
        session.selection = Selection::Light(0);
        let (grasp, placed) = grasp(&session, HandleMode::Size, cone::SORT.handle(0));
        let lens = lens(&session);
        let arm = placed.point - grasp.at;
        let side = arm.reject_from(grasp.direction).normalize();
        let to = |degrees: f32| {
            let (sin, cos) = degrees.to_radians().sin_cos();
            lens.project(grasp.at + arm.length() * (cos * grasp.direction + sin * side)).expect("seen")
        };
        for degrees in [10.0, 35.0, 60.0] {
            let Dragged::Parameter(angle) = drag(&session, &grasp, to(degrees), false) else { panic!() };
            assert!((angle - degrees).abs() < 1.0, "{angle} for {degrees}");
        }
        let Dragged::Parameter(angle) = drag(&session, &grasp, to(170.0), false) else { panic!() };
        assert!(grasp.parameter.is_some_and(|(p, _)| p.allows(&Value::Number(angle))), "{angle}");
    }

    #[test]
    fn words_have_the_unit_and_a_true_minus() {
        let session = session();
        let said = |mode, handle, dragged| grasp(&session, mode, handle).0.words(dragged, 0.02);
        let at = Dragged::Position(Vec3::new(3.25, 1.0, 2.0));
        assert_eq!(said(HandleMode::Move, axis::SORT.handle(0), at), "x 3.25 m");
        assert_eq!(said(HandleMode::Move, plane::SORT.handle(0), at), "x 3.25   y 1.00   z 2.00 m");
        let turned = Dragged::Rotation(Vec3::ZERO, -45.0);
        assert_eq!(said(HandleMode::Turn, ring::SORT.handle(1), turned), "y −45°");
        assert_eq!(said(HandleMode::Size, size::SORT.handle(0), Dragged::Size(2.5)), "size 2.50 m");
    }

    #[test]
    fn a_handle_is_grasped_near_its_line_and_not_beside_it() {
        let session = session();
        let (grasp, placed) = grasp(&session, HandleMode::Move, axis::SORT.handle(0));
        let side = (placed.end - grasp.pointer).normalized().rot90();
        assert!(placed.distance(grasp.pointer + 5.0 * side).is_some());
        assert!(placed.distance(grasp.pointer + 9.0 * side).is_none());
        let covered = |at: Pos2| {
            placed.points().any(|p| Rect::from_center_size(p, Vec2::splat(2.0 * placed.half())).contains(at))
        };
        assert!(covered(grasp.pointer + 4.0 * side) && !covered(grasp.pointer + 14.0 * side));
        let middle = lens(&session).project(grasp.at).expect("seen");
        assert!(placed.distance(middle).is_none(), "in the middle the picture is turned");
    }
}
