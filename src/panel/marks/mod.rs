//! The marks over the picture: lights with their place, direction and cone, the observer where the camera has left
//! it, what is selected; and arrows at the edge that point to the lights outside the view.
//!
//! They are painted as panels are, after the picture: tone mapping and exposure do not touch them, and each line has
//! a dark outline around a light core, one of which stands out on any picture.

use bevy_egui::egui::{Color32, Context, Rect, Ui, Vec2};
use glam::{Quat, Vec3};

use super::{
    kept,
    state::{Action, Session},
};
use crate::{
    document::Selection,
    light::LightEntry,
    registry::Registry,
    scene::{Light, Object, Observer, Scene, observer::rotation as look_along},
};
use edge::Outside;
use frames::{frame, frames};
use place::{CROWD, SHORT};

mod edge;
mod frames;
mod ink;
mod lens;
mod outline;
mod place;

pub(super) use ink::{Ink, OUTLINE};
pub use lens::Lens;
pub(super) use lens::Ray;
pub use place::{anchor, places};

/// Okabe–Ito yellow: lights.
const LIGHT: Color32 = Color32::from_rgb(0xf0, 0xe4, 0x42);
/// Okabe–Ito sky blue, lightened: the selection.
const SELECTED: Color32 = Color32::from_rgb(0x7c, 0xc8, 0xff);
/// Okabe–Ito bluish green, lightened: the observer.
const OBSERVER: Color32 = Color32::from_rgb(0x5f, 0xe3, 0xb5);
/// Lights that are switched off.
const OFF: Color32 = Color32::from_rgb(0xc0, 0xc0, 0xc0);
/// Radius of a light's mark, points.
const LAMP: f32 = 5.0;
/// Radius of a light's mark among many, points.
const DOT: f32 = 2.5;
/// Length of the arrows and the cone of the light that is selected, points.
const LONG: f32 = 88.0;
/// Length of the axis of a cone, of its reach.
pub(super) const AXIS: f32 = 1.25;
/// Length of the observer's mark, metres.
const OBSERVER_MARK: f32 = 0.4;
/// The cosine of the angle within which the camera looks along with the observer.
const ALONG: f32 = 0.9;
/// A mark of the observer with a smaller radius covers nothing, points.
const SMALL: f32 = 12.0;

/// A picture on the screen.
#[derive(Clone, Copy)]
pub struct Sight<'a> {
    /// Rectangle of the picture.
    pub rect: Rect,
    /// The rectangles that are written over it.
    pub written: &'a [Rect],
    /// The session that it shows.
    pub session: &'a Session,
    /// The known types and models.
    pub registry: &'a Registry,
}

/// The requested actions, and the clickable places, which do not belong to the picture.
pub type Asked = (Vec<Action>, Vec<Rect>);

/// Paints the marks into a picture.
pub fn marks(ui: &Ui, sight: Sight<'_>) -> Asked {
    let Sight { rect, written, session, registry } = sight;
    if !session.view.show_markers {
        return (Vec::new(), Vec::new());
    }
    let scene = &session.document;
    let lens = Lens::of(session, rect);
    let mut ink = Ink::new(lens);
    let mut outside = Vec::new();
    let crowd = scene.lights.len() > CROWD;
    let chosen = |i: usize| session.selection == Selection::Light(i);
    let colour_of = |i: usize| match scene.lights[i].enabled {
        _ if session.is_selected(Selection::Light(i)) => SELECTED,
        true => LIGHT,
        false => OFF,
    };
    let places = places_shown(ui.ctx(), sight, &lens);
    // The selected one is drawn last, over the others.
    let mut order: Vec<usize> = (0..scene.lights.len()).collect();
    order.sort_by_key(|i| chosen(*i));
    for i in order {
        let light = &scene.lights[i];
        if chosen(i) {
            outline::outline(&mut ink, light, scene, registry);
        }
        let (Some(at), Some(entry)) = (places[i], registry.light(&light.light_type)) else {
            continue;
        };
        match lens.project(at).filter(|at| rect.contains(*at)) {
            None => outside.push(Outside { light: i, way: lens.towards(at), covered: None }),
            Some(p) if written.iter().any(|r| r.contains(p)) => {
                let way = (p - rect.center()).normalized();
                outside.push(Outside { light: i, way, covered: Some(p) });
            }
            Some(_) => {
                let size = match chosen(i) {
                    true => Size::Long,
                    false if crowd => Size::Dot,
                    false => Size::Short,
                };
                lamp(&mut ink, &Lamp { light, entry, position: at, colour: colour_of(i), size }, scene);
            }
        }
    }
    if !is_in_the_way(&lens, scene) {
        observer(&mut ink, &scene.observer, session.selection == Selection::Observer);
    }
    if let Selection::Object(i) = session.selection
        && let Some(object) = scene.objects.get(i)
    {
        frame(ui, &mut ink, object, registry);
    }
    frames(ui, &mut ink, session, registry);
    ink.paint(&ui.painter_at(rect));
    edge::arrows(ui, sight, &outside, colour_of)
}

/// The light whose mark is held, and the place of the mark.
#[derive(Clone, Copy, Default)]
struct Held(Option<(usize, Vec3)>);

/// Keeps the mark of a light in its place, or lets all go: light from a direction would move its own away from the
/// pointer that turns it.
pub(super) fn hold(ctx: &Context, light: Option<(usize, Vec3)>) {
    kept::set(ctx, Held(light));
}

/// The [`places`] of the marks, and of the one that is held.
pub(super) fn places_shown(ctx: &Context, sight: Sight<'_>, lens: &Lens) -> Vec<Option<Vec3>> {
    let scene = &sight.session.document;
    let mut all = places(scene, sight.registry, lens, sight.written);
    let Held(held) = kept::get(ctx);
    let moves = |light: usize| scene.lights.get(light).is_some_and(|light| light.position.is_none());
    if let Some((light, at)) = held.filter(|(light, _)| moves(*light)) {
        all[light] = Some(at);
    }
    all
}

/// The radius in metres of the mark of a light that is selected: of the sphere on which its cone ends.
pub(super) fn reach(lens: &Lens, at: Vec3, scene: &Scene) -> f32 {
    reach_of(lens, at, LONG, scene)
}

fn reach_of(lens: &Lens, at: Vec3, points: f32, scene: &Scene) -> f32 {
    lens.metres(at, points).min(0.12 * scene.scene_size.corner().max_element())
}

/// The size of the mark of a light.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Size {
    /// Among many.
    Dot,
    /// Beside what is looked at.
    Short,
    /// Selected.
    Long,
}

/// The mark of a light.
struct Lamp<'a> {
    light: &'a Light,
    entry: &'a LightEntry,
    position: Vec3,
    colour: Color32,
    size: Size,
}

fn lamp(ink: &mut Ink, lamp: &Lamp<'_>, scene: &Scene) {
    let Lamp { light, position, colour, size, .. } = *lamp;
    let direction = light.direction.and_then(Vec3::try_normalize);
    if let Some(direction) = direction {
        let points = if size == Size::Long { LONG } else { SHORT };
        let reach = reach_of(&ink.lens, position, points, scene);
        beam(ink, lamp, direction, reach);
    }
    let Some(at) = ink.lens.project(position) else { return };
    if size == Size::Dot {
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

/// The cone or the arrows of a light that shines in a direction, from its position and as far as `reach`.
fn beam(ink: &mut Ink, lamp: &Lamp<'_>, direction: Vec3, reach: f32) {
    let Lamp { light, entry, position, colour, size } = *lamp;
    let turn = Quat::from_rotation_arc(Vec3::Z, direction);
    match entry.cone_angle(&light.parameters) {
        _ if size == Size::Dot => ink.path(&[position, position + direction * (0.5 * reach)], colour),
        Some(angle) => {
            let angle = angle.to_radians();
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
            if size == Size::Long {
                ink.arrow(position, position + direction * reach * AXIS, colour);
            }
        }
        // Several would look like light from a direction.
        None if !entry.declaration.sizes.is_empty() => {
            ink.arrow(position, position + direction * reach, colour);
        }
        None => {
            // Side by side as the camera sees them: so few cannot hide each other.
            let across = ink.lens.across(position, direction);
            let around = [Vec3::ZERO, Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y].map(|side| turn * side);
            let few = [Vec3::ZERO, across, -across];
            let (sides, apart) = if size == Size::Long { (&around[..], 0.3) } else { (&few[..], 0.4) };
            for side in sides {
                let start = position + *side * (apart * reach);
                ink.arrow(start, start + direction * reach, colour);
            }
        }
    }
}

/// True if the pyramid of the observer would frame the picture, seen from within, or cover objects, seen over its shoulder.
fn is_in_the_way(lens: &Lens, scene: &Scene) -> bool {
    let Observer { position, direction, .. } = scene.observer;
    if lens.eye.distance(position) <= OBSERVER_MARK {
        return true;
    }
    let (way, [.., ahead]) = (look_along(direction) * Vec3::NEG_Z, lens.axes());
    let circle = |p: Vec3, radius: f32| Some((lens.project(p)?, radius / lens.metres(p, 1.0)));
    let half = 0.5 * OBSERVER_MARK;
    let Some((at, radius)) = circle(position + half * way, half).filter(|_| way.dot(ahead) > ALONG) else {
        return false;
    };
    let covers = |object: &Object| {
        let object = circle(object.position, 0.5 * object.size);
        object.is_some_and(|(middle, extent)| at.distance(middle) < radius + extent)
    };
    radius >= SMALL && scene.objects.iter().any(covers)
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
