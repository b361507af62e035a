//! The handles of the selection, and their positions in the picture.

use std::f32::consts::TAU;

use bevy_egui::egui::{Pos2, Vec2, vec2};
use glam::Vec3;

use crate::{
    document::Selection,
    light::LightEntry,
    panel::{
        marks::{self, Lens},
        state::{HandleMode, Session},
    },
    parameter::Parameter,
    registry::Registry,
    scene::{Light, Object, rotation::rotation},
};

/// Length of an arrow, in points.
const ARM: f32 = 76.0;
/// Radius of a ring, in points.
pub(super) const RING: f32 = 78.0;
/// Radius of the area around the centre without handles, which leaves room for turning the view, in points.
const GAP: f32 = 13.0;
/// Minimum projected length of an arrow, in points: an axis seen end on cannot be dragged along.
const SHORTEST: f32 = 30.0;
/// Distance from the centre of the disc that moves in the picture plane, in points.
const ASIDE: f32 = 34.0;
/// Distance of the size handle from the centre, as a multiple of the largest half extent.
const OUTWARD: f32 = 1.2;
/// Minimum distance of the size handle from the centre, in points.
const NEAREST: f32 = 44.0;
/// Distance of a letter from the end of its arrow, in points.
pub(super) const LETTER: f32 = 13.0;
/// Radius of a disc, in points.
pub(super) const DISC: f32 = 6.0;
/// Grab distance of a line, in points.
const REACH: f32 = 6.0;
/// Distance of handles from their object, which they must not cover, in points.
const CLEAR: f32 = 7.0;
/// Minimum length of an arrow beyond the object, relative to [`ARM`]; also the length of arrows at the edge of the
/// view.
const STUB: f32 = 0.5;
/// Maximum length of an arrow, relative to [`ARM`].
const LONGEST: f32 = 1.2;
/// Grab radius of a letter, in points.
const LETTER_RADIUS: f32 = 8.0;
/// Number of segments of a ring.
const SIDES: usize = 72;

/// A handle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Handle {
    /// Moves along a world axis.
    Axis(usize),
    /// Moves in the picture plane.
    Plane,
    /// Turns about a world axis.
    Ring(usize),
    /// Changes the size.
    Size,
    /// Turns the direction of a light.
    Direction,
    /// Opens the cone of a light.
    Cone,
    /// Changes a size of a light: index among the declared sizes, and the dragged end.
    Extent(usize, End),
    /// Turns a light about its direction.
    Roll,
}

/// An end of a size of a light.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum End {
    /// The end in the direction of the size's axis.
    First,
    /// The opposite end.
    Second,
}

/// Names of the axes.
pub(super) const LETTERS: [&str; 3] = ["x", "y", "z"];

/// The part of the scene that the handles change.
pub(super) enum Body<'a> {
    /// An object, with half its extents relative to its size.
    Object(&'a Object, Vec3),
    /// A light.
    Light(&'a Light, &'a LightEntry),
}

/// The part that the handles belong to.
pub(super) struct Target<'a> {
    pub(super) part: Selection,
    /// Centre of the handles.
    pub(super) at: Vec3,
    pub(super) body: Body<'a>,
}

impl<'a> Target<'a> {
    /// The selection, if it has handles; `places` returns the positions of the light markers.
    pub(super) fn of(
        session: &'a Session,
        registry: &'a Registry,
        places: impl FnOnce() -> Vec<Option<Vec3>>,
    ) -> Option<Self> {
        let part = session.selection;
        match part {
            Selection::Object(i) => {
                let object = session.document.objects.get(i)?;
                let half = registry.shape(&object.object_type)?.bounds(&object.shape).half;
                Some(Self { part, at: object.position, body: Body::Object(object, half) })
            }
            Selection::Light(i) => {
                let light = session.document.lights.get(i)?;
                let entry = registry.light(&light.light_type)?;
                let at = light.position.or_else(|| places().get(i).copied().flatten())?;
                Some(Self { part, at, body: Body::Light(light, entry) })
            }
            Selection::Room | Selection::Observer => None,
        }
    }

    /// The parameter that a handle changes.
    pub(super) fn parameter(&self, handle: Handle) -> Option<&'static Parameter> {
        let Body::Light(_, entry) = self.body else { return None };
        match handle {
            Handle::Cone => entry.cone_parameter(),
            Handle::Roll => entry.roll_parameter(),
            Handle::Extent(i, _) => entry.parameter(entry.declaration.sizes.get(i)?.parameter()),
            _ => None,
        }
    }

    /// The display name of a handle; `part` is the name of the part it belongs to.
    pub(super) fn name(&self, handle: Handle, part: &str) -> String {
        let label = || self.parameter(handle).map_or("size", |p| p.label);
        match handle {
            Handle::Axis(i) => format!("Handle: move {part} along {}", LETTERS[i]),
            Handle::Plane => format!("Handle: move {part} in the plane of the picture"),
            Handle::Ring(i) => format!("Handle: turn {part} about {}", LETTERS[i]),
            Handle::Size => format!("Handle: size of {part}"),
            Handle::Direction => format!("Handle: direction of {part}"),
            Handle::Cone => format!("Handle: cone of {part}"),
            Handle::Extent(_, End::First) | Handle::Roll => format!("Handle: {} of {part}", label()),
            Handle::Extent(_, End::Second) => format!("Handle: {} of {part}, at the other end", label()),
        }
    }
}

/// A handle in the picture.
#[derive(Clone, Debug)]
pub(super) struct Placed {
    pub(super) handle: Handle,
    /// Lines of the handle.
    pub(super) lines: Vec<Vec<Pos2>>,
    /// Lines on the far side, which are fainter.
    pub(super) far: Vec<Vec<Pos2>>,
    /// Position of the end or the letter.
    pub(super) end: Pos2,
    /// Grab radius of the end.
    pub(super) radius: f32,
    /// The point in the scene that the handle represents.
    pub(super) point: Vec3,
}

impl Placed {
    /// Distance of a position from the handle, 0 if it is on the handle; `None` if it is out of reach.
    pub(super) fn distance(&self, from: Pos2) -> Option<f32> {
        let end = (self.end.distance(from) - self.radius).max(0.0);
        let lines = self.lines.iter().map(|line| (line, 0.0)).chain(self.far.iter().map(|line| (line, 3.0)));
        let segments = lines.flat_map(|(line, more)| line.windows(2).map(move |pair| (pair, more)));
        let nearest = segments.map(|(pair, more)| more + apart(from, pair[0], pair[1]));
        Some(nearest.fold(end, f32::min)).filter(|distance| *distance <= REACH)
    }

    /// Points along the handle, dense enough that squares around them cover it.
    pub(super) fn points(&self) -> impl Iterator<Item = Pos2> + '_ {
        let lines = self.lines.iter().chain(&self.far);
        let along = lines.flat_map(|line| line.windows(2)).flat_map(|pair| {
            let count = (pair[0].distance(pair[1]) / REACH).ceil().max(1.0) as usize;
            (0..=count).map(move |k| pair[0].lerp(pair[1], k as f32 / count as f32))
        });
        along.chain([self.end])
    }

    /// Removes the parts of the lines that lie in front of the object.
    fn beyond(mut self, middle: Pos2, object: Option<Extent>) -> Self {
        let Some(object) = object else { return self };
        for lines in [&mut self.lines, &mut self.far] {
            let runs = lines
                .iter()
                .flat_map(|line| line.split(|p| p.distance(middle) < object.towards(*p - middle)));
            *lines = runs.filter(|run| run.len() > 1).map(<[Pos2]>::to_vec).collect();
        }
        self
    }

    /// Half the side of the squares around [`points`](Self::points).
    pub(super) fn half(&self) -> f32 {
        REACH.max(self.radius)
    }
}

/// Distance of a point from a segment.
fn apart(p: Pos2, a: Pos2, b: Pos2) -> f32 {
    let along = b - a;
    let t = ((p - a).dot(along) / along.length_sq().max(1e-6)).clamp(0.0, 1.0);
    p.distance(a + t * along)
}

/// Relative size of the handles in a view: smaller in a small view.
pub(super) fn part_of(lens: &Lens) -> f32 {
    (0.0034 * lens.rect().size().min_elem()).min(1.0)
}

/// The handles of a target in a mode, in painting order, without those for the sizes and the roll of a light.
pub(super) fn placed(target: &Target, mode: HandleMode, session: &Session, lens: &Lens) -> Vec<Placed> {
    let Some(middle) = lens.project(target.at).filter(|p| lens.rect().contains(*p)) else {
        return Vec::new();
    };
    let part = part_of(lens);
    let extent = Extent::of(target, middle, lens);
    let clear = extent.filter(|extent| extent.leaves_room(part, lens));
    let mut all = Vec::new();
    match (&target.body, mode) {
        (Body::Object(..), HandleMode::Turn) => {
            let most = 0.5 * lens.rect().size().max_elem() - LETTER;
            let around = |extent: Extent| (extent.most() + CLEAR).min(most).max(part * RING);
            let radius = extent.map_or(part * RING, around);
            all.extend((0..3).map(|axis| ring(target.at, axis, radius, lens).beyond(middle, extent)));
        }
        (Body::Object(object, half), HandleMode::Size) => {
            let radius = OUTWARD * object.size * half.max_element();
            all.extend(size(target.at, middle, radius, extent, lens));
        }
        (Body::Object(..), HandleMode::Move) if clear.is_none() => {
            all.extend(arrows_at_edge(target.at, middle, STUB * part * ARM, extent, lens));
        }
        (Body::Object(..), HandleMode::Move) => {
            all.extend(arrows(target.at, [middle; 2], part * ARM, clear, lens));
        }
        (Body::Light(light, _), HandleMode::Move) if light.position.is_some() => {
            all.extend(arrows(target.at, [middle; 2], part * ARM, None, lens));
        }
        (Body::Light(..), _) => {}
    }
    if let Body::Light(light, entry) = target.body
        // Size handles may be at the same position.
        && (mode != HandleMode::Size || entry.declaration.sizes.is_empty())
        && let Some(direction) = light.direction.and_then(Vec3::try_normalize)
    {
        let reach = marks::reach(lens, target.at, &session.document);
        let cone = entry.cone_angle(&light.parameters);
        let length = if cone.is_some() { marks::AXIS * reach } else { reach };
        let tip = target.at + direction * (length + lens.metres(target.at, DISC + 4.0));
        let disc = |handle: Handle, point: Vec3| {
            let end = lens.project(point)?;
            Some(Placed { handle, lines: Vec::new(), far: Vec::new(), end, radius: DISC, point })
        };
        all.extend(disc(Handle::Direction, tip));
        if let Some(angle) = cone {
            let (sin, cos) = angle.to_radians().sin_cos();
            let edge = direction * cos + lens.across(target.at, direction) * sin;
            all.extend(disc(Handle::Cone, target.at + reach * edge));
        }
    }
    all
}

/// Extent of an object in the picture: the projected half axes of the ellipsoid inscribed in its bounds, in points.
#[derive(Clone, Copy, Debug)]
struct Extent([Vec2; 3]);

impl Extent {
    /// Extent of the target's object; `None` if the target is a light or an axis ends behind the camera.
    fn of(target: &Target, middle: Pos2, lens: &Lens) -> Option<Self> {
        let Body::Object(object, half) = target.body else { return None };
        let turned = rotation(object.rotation);
        let axis = |i: usize| {
            let end = lens.project(target.at + turned * (Vec3::AXES[i] * object.size * half[i]))?;
            Some(end - middle)
        };
        Some(Self([axis(0)?, axis(1)?, axis(2)?]))
    }

    /// True if the picture has room for handles around the object.
    fn leaves_room(&self, part: f32, lens: &Lens) -> bool {
        let needed = STUB * part * ARM + 2.0 * LETTER;
        self.most() + needed < 0.5 * lens.rect().size().min_elem()
    }

    /// Distance from the centre, in a direction of the picture, beyond which a handle does not cover the object.
    fn towards(&self, way: Vec2) -> f32 {
        let way = way.normalized();
        self.0.iter().map(|axis| axis.dot(way).powi(2)).sum::<f32>().sqrt() + CLEAR
    }

    /// The largest such distance in any direction.
    fn most(&self) -> f32 {
        let ways = (0..16).map(|k| Vec2::angled(k as f32 / 16.0 * 0.5 * TAU));
        ways.map(|way| self.towards(way)).fold(0.0, f32::max)
    }
}

/// Arrows for an object that leaves no room around it, at an edge of the view where they cover the object least. They
/// are dragged like any others: only the motion of the pointer counts.
fn arrows_at_edge(at: Vec3, middle: Pos2, arm: f32, extent: Option<Extent>, lens: &Lens) -> Vec<Placed> {
    let inset = (LONGEST * arm + LETTER + LETTER_RADIUS).min(0.5 * lens.rect().size().min_elem());
    let inside = lens.rect().shrink(inset);
    // Bottom corners first: badges and captions tend to be at the top.
    let places = [
        inside.left_bottom(),
        inside.right_bottom(),
        inside.right_top(),
        inside.left_top(),
        inside.center_bottom(),
        inside.center_top(),
        inside.left_center(),
        inside.right_center(),
    ];
    let mut best: Option<(f32, Vec<Placed>)> = None;
    for origin in places {
        let all = arrows(at, [origin, middle], arm, None, lens);
        let gap = |p: Pos2| extent.map_or(0.0, |extent| p.distance(middle) - extent.towards(p - middle));
        let free = all.iter().flat_map(Placed::points).map(gap).fold(f32::INFINITY, f32::min);
        if free >= 0.0 {
            return all;
        }
        if best.as_ref().is_none_or(|(most, _)| free > *most) {
            best = Some((free, all));
        }
    }
    best.map(|(_, all)| all).unwrap_or_default()
}

/// Arrows along the world axes, and the disc that moves in the picture plane, around `origin`; `middle` is the centre
/// of the moved part.
fn arrows(
    at: Vec3,
    [origin, middle]: [Pos2; 2],
    arm: f32,
    clear: Option<Extent>,
    lens: &Lens,
) -> Vec<Placed> {
    let length = lens.metres(at, arm);
    let mut all = Vec::new();
    for (axis, way) in Vec3::AXES.into_iter().enumerate() {
        let point = at + length * way;
        let Some(tip) = lens.project(point) else { continue };
        let along = tip - middle;
        if along.length() < SHORTEST.min(0.5 * arm) {
            continue;
        }
        let way = along.normalized();
        let arrow = |clear: Option<f32>| {
            let from = GAP.min(0.3 * arm).max(clear.unwrap_or_default());
            // An arrow that points at the camera would grow without bound.
            let to = along.length().min(LONGEST * arm).max(clear.map_or(0.0, |clear| clear + STUB * arm));
            (vec![origin + from * way, origin + to * way], origin + (to + LETTER) * way)
        };
        // A letter outside the view could not be grabbed.
        let inside = lens.rect().shrink(LETTER);
        let beyond =
            Some(arrow(clear.map(|clear| clear.towards(way)))).filter(|(_, end)| inside.contains(*end));
        let (line, end) = beyond.unwrap_or_else(|| arrow(None));
        all.push(Placed {
            handle: Handle::Axis(axis),
            lines: vec![line],
            far: Vec::new(),
            end,
            radius: LETTER_RADIUS,
            point,
        });
    }
    // In the widest gap between the arrows, preferably at the upper right.
    let ways: Vec<Vec2> = all.iter().map(|p: &Placed| (p.end - origin).normalized()).collect();
    let corners = [vec2(1.0, -1.0), vec2(-1.0, -1.0), vec2(1.0, 1.0), vec2(-1.0, 1.0)].map(Vec2::normalized);
    let nearest = |corner: &Vec2| ways.iter().map(|way| way.dot(*corner)).fold(-1.0, f32::max);
    let free = corners.iter().find(|corner| nearest(corner) < 0.87);
    let corner = free.copied().unwrap_or(corners[0]);
    all.push(Placed {
        handle: Handle::Plane,
        lines: Vec::new(),
        far: Vec::new(),
        end: origin
            + corner * (ASIDE * arm / ARM).max(DISC + clear.map_or(GAP, |clear| clear.towards(corner))),
        radius: DISC,
        point: at,
    });
    all
}

/// The lines of a circle spanned by two directions, on the near side and on the far side.
pub(super) fn circle(at: Vec3, [first, second]: [Vec3; 2], length: f32, lens: &Lens) -> [Vec<Vec<Pos2>>; 2] {
    let around = |k: usize| {
        let (y, x) = (k as f32 / SIDES as f32 * TAU).sin_cos();
        at + length * (x * first + y * second)
    };
    let to_eye = (lens.eye() - at).normalize_or_zero();
    let is_near = |p: Vec3| (p - at).dot(to_eye) >= -0.06 * length;
    let (mut lines, mut far) = (Vec::new(), Vec::new());
    for k in 0..SIDES {
        let pair = [around(k), around(k + 1)];
        let near = is_near(0.5 * (pair[0] + pair[1]));
        let to: &mut Vec<Vec<Pos2>> = if near { &mut lines } else { &mut far };
        for run in lens.path(&pair) {
            match to.last_mut().filter(|line| line.last().is_some_and(|p| p.distance(run[0]) < 0.01)) {
                Some(line) => line.extend(&run[1..]),
                None => to.push(run),
            }
        }
    }
    [lines, far]
}

/// A ring about a world axis.
fn ring(at: Vec3, axis: usize, radius: f32, lens: &Lens) -> Placed {
    let sides = [Vec3::AXES[(axis + 1) % 3], Vec3::AXES[(axis + 2) % 3]];
    let length = lens.metres(at, radius);
    let [lines, far] = circle(at, sides, length, lens);
    // The letters are spread for legibility: at the top, at the right, and between them.
    let wanted = [vec2(0.0, -1.0), vec2(1.0, 0.0), vec2(0.7, 0.7)][axis];
    let middle = lens.project(at).unwrap_or_default();
    let inside = lens.rect().shrink(LETTER + LETTER_RADIUS);
    let best = |within: bool| {
        let points = lines.iter().flatten().copied().filter(|p| !within || inside.contains(*p));
        points.max_by(|a, b| (*a - middle).dot(wanted).total_cmp(&(*b - middle).dot(wanted)))
    };
    let best = best(true).or_else(|| best(false)).unwrap_or(middle);
    let end = best + (best - middle).normalized() * LETTER;
    Placed {
        handle: Handle::Ring(axis),
        lines,
        far,
        end,
        radius: LETTER_RADIUS,
        point: at + length * sides[0],
    }
}

/// The size handle, to the upper right of the centre.
fn size(at: Vec3, middle: Pos2, radius: f32, clear: Option<Extent>, lens: &Lens) -> Option<Placed> {
    let way = vec2(1.0, -1.0).normalized();
    let clear = clear.map_or(GAP, |clear| clear.towards(way));
    let edge = [lens.rect().right() - middle.x, middle.y - lens.rect().top()]
        .map(|room| (room - 20.0) / way.x.abs());
    let most = edge[0].min(edge[1]).max(GAP + DISC);
    let points = (radius / lens.metres(at, 1.0)).max(NEAREST).min(most);
    let end = middle + points * way;
    let line = vec![middle + clear.min(points) * way, end];
    Some(Placed {
        handle: Handle::Size,
        lines: vec![line],
        far: Vec::new(),
        end,
        radius: DISC + 2.0,
        point: at,
    })
}
