//! The marks over the picture: lights with their place, direction and cone, the observer where the camera has left
//! it, what is selected; and arrows at the edge that point to the lights outside the view.
//!
//! They are painted as panels are, after the picture: tone mapping and exposure do not touch them, and each line has
//! a dark outline around a light core, one of which stands out on any picture.

use bevy_egui::egui::{
    Align2, Color32, CursorIcon, FontId, Id, Painter, Pos2, Rect, Sense, Shape, Stroke, Ui, Vec2, WidgetInfo,
    WidgetType, vec2,
};
use glam::{Quat, Vec3};

use super::{
    state::{Action, Session},
    theme,
};
use crate::document::Selection;
use crate::{
    light::LightEntry,
    registry::Registry,
    scene::{
        Light, Object, Observer, Scene,
        observer::{rotation as look_along, vertical_field_of_view},
        rotation::rotation,
    },
};

/// Okabe–Ito yellow: lights.
const LIGHT: Color32 = Color32::from_rgb(0xf0, 0xe4, 0x42);
/// Okabe–Ito sky blue, lightened: what is selected.
const SELECTED: Color32 = Color32::from_rgb(0x7c, 0xc8, 0xff);
/// Okabe–Ito bluish green, lightened: the observer.
const OBSERVER: Color32 = Color32::from_rgb(0x5f, 0xe3, 0xb5);
/// Lights that are switched off.
const OFF: Color32 = Color32::from_rgb(0xc0, 0xc0, 0xc0);
/// Around every line.
const OUTLINE: Color32 = Color32::from_rgb(8, 8, 8);

/// Width of a line, points.
const LINE: f32 = 1.75;
/// Width of the outline on either side, points.
const RIM: f32 = 1.5;
/// More lights than this get small marks.
const CROWD: usize = 24;
/// Radius of a light's mark, points.
const LAMP: f32 = 5.0;
/// Radius of a light's mark among many, points.
const DOT: f32 = 2.5;
/// Length of arrows and cones, metres per metre of distance from the camera: the same size everywhere.
const REACH: f32 = 0.14;
/// Length of the observer's mark, metres.
const OBSERVER_MARK: f32 = 0.4;
/// Nothing nearer to the camera than this is drawn, metres.
const NEAR: f32 = 0.05;
/// Half the height of an arrow at the edge, points.
const ARROW: f32 = 8.0;
/// Distance of the arrows from the edge, points.
const INSET: f32 = 16.0;
/// Distance of the arrows from the lower edge, where the caption stands, points.
const INSET_BELOW: f32 = 46.0;
/// Names in the tooltip of an arrow that stands for several lights.
const NAMES: usize = 8;

/// The way from the room to the picture: what the camera of the window shows in a rectangle.
#[derive(Clone, Copy, Debug)]
pub struct Lens {
    eye: Vec3,
    to_camera: Quat,
    rect: Rect,
    /// Points per unit of the tangent.
    scale: f32,
}

impl Lens {
    /// The camera of the window.
    #[must_use]
    pub fn of(session: &Session, rect: Rect) -> Self {
        let degrees = session.document.observer.field_of_view;
        let angle = vertical_field_of_view(degrees, rect.width() / rect.height().max(1.0), true);
        Self {
            eye: session.facts.eye,
            to_camera: session.facts.camera.inverse(),
            rect,
            scale: 0.5 * rect.height() / (0.5 * angle).tan(),
        }
    }

    /// A point of the room as the camera sees it: x to the right, y up, −z ahead.
    fn seen(&self, p: Vec3) -> Vec3 {
        self.to_camera * (p - self.eye)
    }

    fn flat(&self, seen: Vec3) -> Pos2 {
        self.rect.center() + vec2(seen.x, -seen.y) * (self.scale / -seen.z)
    }

    /// The place of a point in the picture or beside it; none behind the camera.
    #[must_use]
    pub fn project(&self, p: Vec3) -> Option<Pos2> {
        let seen = self.seen(p);
        (seen.z < -NEAR).then(|| self.flat(seen))
    }

    fn shows(&self, p: Vec3) -> bool {
        self.project(p).is_some_and(|at| self.rect.contains(at))
    }

    /// The direction in the picture in which a point outside it lies.
    fn towards(&self, p: Vec3) -> Vec2 {
        let seen = self.seen(p);
        let sideways = vec2(seen.x, -seen.y);
        if sideways.length() > 1e-4 { sideways.normalized() } else { vec2(0.0, 1.0) }
    }

    /// A line through the room as lines in the picture, without what is behind the camera.
    fn path(&self, points: &[Vec3]) -> Vec<Vec<Pos2>> {
        let mut runs = vec![Vec::new()];
        let mut last: Option<Vec3> = None;
        for point in points {
            let seen = self.seen(*point);
            let ahead = |p: Vec3| p.z < -NEAR;
            if let Some(last) = last.filter(|last| ahead(*last) != ahead(seen)) {
                let t = (-NEAR - last.z) / (seen.z - last.z);
                let border = self.flat(last.lerp(seen, t).with_z(-NEAR));
                runs.last_mut().into_iter().for_each(|run| run.push(border));
                if ahead(last) {
                    runs.push(Vec::new());
                }
            }
            if ahead(seen) {
                let at = self.flat(seen);
                runs.last_mut().into_iter().for_each(|run| run.push(at));
            }
            last = Some(seen);
        }
        runs.retain(|run| run.len() > 1);
        runs
    }
}

/// Lines with their outlines; no outline covers another line.
struct Ink {
    lens: Lens,
    below: Vec<Shape>,
    above: Vec<Shape>,
}

impl Ink {
    fn line(&mut self, mut points: Vec<Pos2>, colour: Color32) {
        self.above.push(Shape::line(points.clone(), Stroke::new(LINE, colour)));
        // The outline goes around the ends too.
        let end = points.len() - 1;
        let (first, last) = (points[0] - points[1], points[end] - points[end - 1]);
        points[0] += first.normalized() * RIM;
        points[end] += last.normalized() * RIM;
        self.below.push(Shape::line(points, Stroke::new(LINE + 2.0 * RIM, OUTLINE)));
    }

    fn path(&mut self, points: &[Vec3], colour: Color32) {
        for run in self.lens.path(points) {
            self.line(run, colour);
        }
    }

    fn disc(&mut self, at: Pos2, radius: f32, colour: Color32) {
        self.above.push(Shape::circle_filled(at, radius + RIM, OUTLINE));
        self.above.push(Shape::circle_filled(at, radius, colour));
    }

    fn arrow(&mut self, from: Vec3, to: Vec3, colour: Color32) {
        self.path(&[from, to], colour);
        let (Some(a), Some(b)) = (self.lens.project(from), self.lens.project(to)) else { return };
        let tip = 6.0;
        // Seen from its end, an arrow has no sides.
        if (b - a).length() < tip {
            return;
        }
        let back = (a - b).normalized() * tip;
        let side = back.rot90() * 0.55;
        self.line(vec![b + back + side, b, b + back - side], colour);
    }

    fn paint(self, painter: &Painter) {
        painter.extend(self.below);
        painter.extend(self.above);
    }
}

/// The place of a light's mark: that of the light; for light from a direction, where it enters the room. None for
/// uniform light.
#[must_use]
pub fn anchor(light: &Light, scene: &Scene) -> Option<Vec3> {
    let direction = light.direction.and_then(Vec3::try_normalize);
    light.position.or_else(|| {
        let half = 0.5 * scene.scene_size.corner();
        let room = 0.92 * (half / direction?.abs().max(Vec3::splat(1e-6))).min_element();
        Some(half - direction? * room)
    })
}

/// The place of a light's mark in the view: for light from a direction, as far from the objects as it can be seen.
#[must_use]
pub fn place(light: &Light, scene: &Scene, lens: &Lens) -> Option<Vec3> {
    let far = anchor(light, scene)?;
    if light.position.is_some() || lens.shows(far) {
        return Some(far);
    }
    let objects = &scene.objects;
    let middle = objects.iter().map(|o| o.position).sum::<Vec3>() / objects.len().max(1) as f32;
    let back = -light.direction.and_then(Vec3::try_normalize)?;
    let depth = lens.seen(middle).length();
    // Not so near to the camera that its arrows fill the picture.
    let seen = |p: Vec3| {
        let at = lens.project(p).filter(|_| -lens.seen(p).z > 0.4 * depth);
        at.is_some_and(|at| lens.rect.shrink2(vec2(INSET_BELOW, INSET_BELOW)).contains(at))
    };
    let farthest = |from: Vec3| {
        let mut steps = (0..=32).map(|k| from + back * (depth * k as f32 / 32.0));
        steps.rfind(|p| scene.scene_size.contains(*p) && seen(*p))
    };
    let ahead = lens.eye + lens.to_camera.inverse() * Vec3::new(0.0, 0.0, -depth);
    Some(farthest(middle).or_else(|| farthest(ahead)).unwrap_or(far))
}

/// Paints the marks into the rectangle of the picture. Returns what was asked for, and the places that can be
/// clicked, which do not belong to the picture.
pub fn marks(ui: &Ui, rect: Rect, session: &Session, registry: &Registry) -> (Vec<Action>, Vec<Rect>) {
    if !session.view.show_gizmos {
        return (Vec::new(), Vec::new());
    }
    let scene = &session.document;
    let lens = Lens::of(session, rect);
    let painter = ui.painter_at(rect);
    let mut ink = Ink { lens, below: Vec::new(), above: Vec::new() };
    let mut outside = Vec::new();
    let crowd = scene.lights.len() > CROWD;
    let chosen = |i: usize| session.selection == Selection::Light(i);
    let colour_of = |i: usize| match scene.lights[i].enabled {
        _ if chosen(i) => SELECTED,
        true => LIGHT,
        false => OFF,
    };
    // What is selected is drawn last, over the others.
    let mut order: Vec<usize> = (0..scene.lights.len()).collect();
    order.sort_by_key(|i| chosen(*i));
    for i in order {
        let light = &scene.lights[i];
        let (Some(at), Some(entry)) = (place(light, scene, &lens), registry.light(&light.light_type)) else {
            continue;
        };
        if !lens.shows(at) {
            outside.push((i, lens.towards(at)));
        }
        let colour = colour_of(i);
        lamp(&mut ink, light, entry, at, scene, colour, crowd && !chosen(i));
    }
    // From within, its own pyramid would frame the picture.
    if session.facts.eye.distance(scene.observer.position) > OBSERVER_MARK {
        observer(&mut ink, &scene.observer, session.selection == Selection::Observer);
    }
    if let Selection::Object(i) = session.selection
        && let Some(object) = scene.objects.get(i)
    {
        corners(&mut ink, object, registry);
    }
    ink.paint(&painter);
    arrows(ui, &painter, rect, &outside, session, registry)
}

fn lamp(
    ink: &mut Ink,
    light: &Light,
    entry: &LightEntry,
    position: Vec3,
    scene: &Scene,
    colour: Color32,
    small: bool,
) {
    let direction = light.direction.and_then(Vec3::try_normalize);
    let place = ink.lens.project(position);
    let corner = scene.scene_size.corner();
    let reach = (0.12 * corner.max_element()).min(REACH * position.distance(ink.lens.eye).max(0.5));
    if let Some(direction) = direction {
        let turn = Quat::from_rotation_arc(Vec3::Z, direction);
        match entry.declaration.cone_parameter {
            _ if small => ink.path(&[position, position + direction * (0.4 * reach)], colour),
            Some(index) => {
                let angle = entry.numbers(&light.parameters)[index].to_radians();
                // The rim on a sphere around the light: also a half angle of 90° has one.
                let rim = position + direction * (reach * angle.cos());
                let radius = reach * angle.sin();
                let around = |turns: f32| {
                    let (y, x) = (turns * std::f32::consts::TAU).sin_cos();
                    rim + turn * Vec3::new(x, y, 0.0) * radius
                };
                ink.path(&(0..=48).map(|k| around(k as f32 / 48.0)).collect::<Vec<_>>(), colour);
                for side in [0.0, 0.25, 0.5, 0.75] {
                    ink.path(&[position, around(side)], colour);
                }
                ink.arrow(position, position + direction * reach * 1.25, colour);
            }
            None => {
                for side in [Vec3::ZERO, Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y] {
                    let start = position + turn * side * (0.3 * reach);
                    ink.arrow(start, start + direction * reach, colour);
                }
            }
        }
    }
    let Some(at) = place else { return };
    if small {
        ink.disc(at, DOT, colour);
    } else if light.position.is_some() {
        if direction.is_none() {
            for ray in 0..8 {
                let out = Vec2::angled(ray as f32 * std::f32::consts::TAU / 8.0);
                ink.line(vec![at + out * (LAMP + 3.5), at + out * (LAMP + 7.5)], colour);
            }
        }
        ink.disc(at, LAMP, colour);
    } else {
        // Seen from their ends, its arrows are nearly points.
        ink.disc(at, 1.4 * DOT, colour);
    }
}

/// The observer as the pyramid of its view.
fn observer(ink: &mut Ink, observer: &Observer, selected: bool) {
    let colour = if selected { SELECTED } else { OBSERVER };
    let turn = look_along(observer.direction);
    let half = OBSERVER_MARK * (observer.field_of_view.min(120.0) * 0.5).to_radians().tan();
    let corners = [(-1.6, -1.0), (1.6, -1.0), (1.6, 1.0), (-1.6, 1.0)]
        .map(|(x, y)| observer.position + turn * Vec3::new(x * half, y * half, -OBSERVER_MARK));
    for corner in corners {
        ink.path(&[observer.position, corner], colour);
    }
    ink.path(&[corners[0], corners[1], corners[2], corners[3], corners[0]], colour);
    let top = (corners[2] + corners[3]) * 0.5 + turn * Vec3::Y * half * 0.5;
    ink.path(&[corners[3], top, corners[2]], colour);
}

/// The corners of the box around the selected object, so that little of the object is covered.
fn corners(ink: &mut Ink, object: &Object, registry: &Registry) {
    let Some(shape) = registry.shape(&object.object_type) else { return };
    // The coarsest mesh has the extent of any other, nearly.
    let mesh = shape.mesh(*shape.declaration.tessellation.start());
    let extent = mesh.positions.iter().fold(Vec3::ZERO, |extent, p| extent.max(p.abs()));
    let half = extent.max(Vec3::splat(0.02)) * 1.04;
    let turn = rotation(object.rotation);
    let place = |at: Vec3| object.position + turn * (object.size * at);
    for corner in 0..8u32 {
        let sign = |bit: u32| if corner & bit == 0 { -1.0 } else { 1.0 };
        let at = Vec3::new(sign(1), sign(2), sign(4)) * half;
        for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
            let inward = at - axis * at * 0.2;
            ink.path(&[place(at), place(inward)], SELECTED);
        }
    }
}

/// The arrows at the edge of the picture. Where many would overlap, one stands for them and says how many.
fn arrows(
    ui: &Ui,
    painter: &Painter,
    rect: Rect,
    outside: &[(usize, Vec2)],
    session: &Session,
    registry: &Registry,
) -> (Vec<Action>, Vec<Rect>) {
    let mut frame = rect.shrink(INSET);
    frame.max.y -= INSET_BELOW - INSET;
    let (mut actions, mut places) = (Vec::new(), Vec::new());
    if !frame.is_positive() {
        return (actions, places);
    }
    let mut ends: Vec<_> = outside.iter().map(|(i, way)| (*i, *way, at_edge(frame, *way))).collect();
    // Around the picture, so that neighbours come one after the other.
    ends.sort_by(|a, b| a.1.angle().total_cmp(&b.1.angle()));
    let mut groups: Vec<(Vec2, Pos2, Vec<usize>)> = Vec::new();
    for (i, way, at) in ends {
        match groups.last_mut() {
            Some((_, first, lights)) if first.distance(at) < 3.4 * ARROW => lights.push(i),
            _ => groups.push((way, at, vec![i])),
        }
    }
    for (way, at, mut lights) in groups {
        lights.sort_unstable();
        let chosen = lights.iter().position(|i| session.selection == Selection::Light(*i));
        let colour = match lights.iter().any(|i| session.document.lights[*i].enabled) {
            _ if chosen.is_some() => SELECTED,
            true => LIGHT,
            false => OFF,
        };
        let (ahead, side) = (way * ARROW, way.rot90() * ARROW);
        // So slim that it cannot be taken for an arrow in another direction.
        let (tip, back) = (at + ahead * 1.2, at - ahead);
        let triangle = vec![tip, back + side * 0.7, back - side * 0.7];
        painter.add(Shape::convex_polygon(triangle, colour, Stroke::new(RIM, OUTLINE)));
        if lights.len() > 1 {
            let font = FontId::new(10.5, theme::semibold());
            let text = painter.layout_no_wrap(lights.len().to_string(), font, colour);
            let middle = at - way * (ARROW + 0.5 * text.size().max_elem() + 3.0);
            let plate = Rect::from_center_size(middle, text.size() + vec2(6.0, 2.0));
            painter.rect_filled(plate, 3.0, OUTLINE);
            painter.galley(Align2::CENTER_CENTER.anchor_size(middle, text.size()).min, text, colour);
        }
        let place = Rect::from_center_size(at, Vec2::splat(3.0 * ARROW));
        let id = Id::new(("light outside the view", lights[0]));
        let response = ui.interact(place, id, Sense::click()).on_hover_cursor(CursorIcon::PointingHand);
        let name = |i: usize| session.name_of(Selection::Light(i), registry);
        let mut names: Vec<_> = lights.iter().take(NAMES).map(|i| name(*i)).collect();
        if lights.len() > NAMES {
            names.push(format!("and {} more", lights.len() - NAMES));
        }
        let said = format!("Outside the view: {}", names.join(", "));
        response.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, &said));
        if response.clicked() {
            // Again and again: one after the other.
            let next = chosen.map_or(0, |k| (k + 1) % lights.len());
            actions.push(Action::Select(Selection::Light(lights[next])));
        }
        response.on_hover_ui(|ui| {
            names.iter().for_each(|name| drop(ui.label(name)));
            let hint = if lights.len() > 1 {
                "Outside the view. Click to select the next"
            } else {
                "Outside the view. Click to select"
            };
            ui.label(theme::small(ui, hint));
        });
        places.push(place);
    }
    (actions, places)
}

/// The point at which the way from the middle meets the frame.
fn at_edge(frame: Rect, way: Vec2) -> Pos2 {
    let half = 0.5 * frame.size();
    let reach = |half: f32, way: f32| if way.abs() > 1e-6 { half / way.abs() } else { f32::INFINITY };
    frame.center() + way * reach(half.x, way.x).min(reach(half.y, way.y))
}

#[cfg(test)]
mod tests {
    use bevy_egui::egui::pos2;

    use super::*;

    fn lens(scene: Scene) -> Lens {
        let rect = Rect::from_min_size(pos2(100.0, 50.0), vec2(800.0, 450.0));
        Lens::of(&Session::new(scene), rect)
    }

    #[test]
    fn the_lens_is_that_of_the_observer() {
        let lens = lens(Scene::default());
        assert_eq!(lens.project(Vec3::splat(5.0)), Some(pos2(500.0, 275.0)));
        // 45° from bottom to top, at a distance of 4.5 m.
        let top = lens.project(Vec3::new(5.0, 5.0 + 4.5 * 22.5f32.to_radians().tan(), 5.0));
        assert!(top.is_some_and(|p| (p.y - 50.0).abs() < 0.01), "{top:?}");
        assert_eq!(lens.project(Vec3::new(5.0, 5.0, 9.9)), None, "behind the camera");
    }

    #[test]
    fn a_line_that_passes_the_camera_is_cut_off_there() {
        let lens = lens(Scene::default());
        let ahead = Vec3::new(5.0, 5.5, 5.0);
        let runs = lens.path(&[ahead, Vec3::new(5.0, 5.5, 9.9), ahead]);
        assert_eq!(runs.len(), 2);
        assert!(runs.iter().flatten().all(|p| p.y < 275.0 && p.x == 500.0), "{runs:?}");
        assert!(lens.path(&[Vec3::new(1.0, 1.0, 9.9), Vec3::new(2.0, 1.0, 9.9)]).is_empty());
    }

    #[test]
    fn arrows_point_to_where_the_light_is() {
        let lens = lens(Scene::default());
        for (light, way) in [
            (Vec3::new(9.9, 5.0, 5.0), vec2(1.0, 0.0)),
            (Vec3::new(5.0, 9.9, 5.0), vec2(0.0, -1.0)),
            (Vec3::new(0.1, 5.0, 9.9), vec2(-1.0, 0.0)),
        ] {
            assert!(!lens.shows(light));
            assert!((lens.towards(light) - way).length() < 1e-3, "{light}");
        }
        let frame = Rect::from_min_max(pos2(0.0, 0.0), pos2(200.0, 100.0));
        assert_eq!(at_edge(frame, vec2(1.0, 0.0)), pos2(200.0, 50.0));
        assert_eq!(at_edge(frame, vec2(0.0, -1.0)), pos2(100.0, 0.0));
    }

    #[test]
    fn light_from_a_direction_has_its_mark_where_it_enters_the_room() {
        let mut scene = Scene::default();
        let down = Light { position: None, direction: Some(Vec3::NEG_Y), ..Light::default() };
        assert!(anchor(&down, &scene).is_some_and(|p| p.distance(Vec3::new(5.0, 9.6, 5.0)) < 1e-4));
        scene.scene_size.width = 40.0;
        let flat = Light { direction: Some(Vec3::new(-3.0, 0.0, 0.0)), ..down.clone() };
        assert!(anchor(&flat, &scene).is_some_and(|p| scene.scene_size.contains(p) && p.x > 38.0));
        assert_eq!(anchor(&Light { direction: None, ..down }, &scene), None, "uniform light");
    }
}
