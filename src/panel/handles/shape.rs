//! The handles of the selection, and their positions in the picture.

use std::f32::consts::TAU;

use bevy_egui::egui::{Pos2, Vec2};
use glam::Vec3;

use super::{Handle, SORTS};
use crate::{
    document::Selection,
    light::LightEntry,
    panel::{
        marks::Lens,
        state::{HandleMode, Session, Together},
    },
    parameter::Parameter,
    registry::Registry,
    scene::{Light, Object, rotation::rotation},
};

/// Length of an arrow, in points.
pub(super) const ARM: f32 = 76.0;
/// Radius of the area around the centre without handles, which leaves room for turning the view, in points.
pub(super) const GAP: f32 = 13.0;
/// Distance of a letter from the end of its arrow, in points.
pub(super) const LETTER: f32 = 13.0;
/// Radius of a disc, in points.
pub(super) const DISC: f32 = 6.0;
/// Grab distance of a line, in points.
const REACH: f32 = 6.0;
/// Distance of handles from their object, which they must not cover, in points.
pub(super) const CLEAR: f32 = 7.0;
/// Minimum length of an arrow beyond the object, relative to [`ARM`]; also the length of arrows beside an object that
/// leaves no room around it.
pub(super) const STUB: f32 = 0.5;
/// Grab radius of a letter, in points.
pub(super) const LETTER_RADIUS: f32 = 8.0;
/// Names of the axes.
pub(super) const LETTERS: [&str; 3] = ["x", "y", "z"];

/// The part of the scene that the handles change.
pub(super) enum Body<'a> {
    /// An object, with half its extents relative to its size.
    Object(&'a Object, Vec3),
    /// A light.
    Light(&'a Light, &'a LightEntry),
    /// Several lights and objects.
    Group(Together),
}

/// The part that the handles belong to.
pub(super) struct Target<'a> {
    pub(super) part: Selection,
    /// Centre of the handles.
    pub(super) at: Vec3,
    pub(super) body: Body<'a>,
}

impl<'a> Target<'a> {
    /// The selection, if it has handles; `places` returns the positions of the light markers. `together` are several parts.
    pub(super) fn of(
        session: &'a Session,
        registry: &'a Registry,
        together: Option<Together>,
        places: impl FnOnce() -> Vec<Option<Vec3>>,
    ) -> Option<Self> {
        let part = session.selection;
        if session.has_group() {
            return together.map(|all| Self { part, at: all.middle(), body: Body::Group(all) });
        }
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

    /// The object, if it is one.
    pub(super) fn object(&self) -> Option<&'a Object> {
        if let Body::Object(object, _) = self.body { Some(object) } else { None }
    }

    /// The light, if it is one.
    pub(super) fn light(&self) -> Option<&'a Light> {
        if let Body::Light(light, _) = self.body { Some(light) } else { None }
    }

    /// The parts, if they are several.
    pub(super) fn group(&self) -> Option<&Together> {
        if let Body::Group(all) = &self.body { Some(all) } else { None }
    }

    /// The name in texts.
    pub(super) fn words(&self, session: &Session, registry: &Registry) -> String {
        match &self.body {
            Body::Group(all) => all.name().to_owned(),
            _ => session.name_of(self.part, registry),
        }
    }

    /// The parameter that a handle changes.
    pub(super) fn parameter(&self, handle: Handle) -> Option<&'static Parameter> {
        let Body::Light(_, entry) = self.body else { return None };
        (handle.sort.parameter)(entry, handle.which)
    }

    /// The display name of a handle; `part` is the name of the part it belongs to.
    pub(super) fn name(&self, handle: Handle, part: &str) -> String {
        format!("Handle: {}", (handle.sort.name)(self, handle.which, part))
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
    /// A handle without lines.
    pub(super) fn new(handle: Handle, end: Pos2, radius: f32, point: Vec3) -> Self {
        Self { handle, lines: Vec::new(), far: Vec::new(), end, radius, point }
    }

    /// A disc at a point of the room; none if that is not seen.
    pub(super) fn disc(handle: Handle, point: Vec3, lens: &Lens) -> Option<Self> {
        Some(Self::new(handle, lens.project(point)?, DISC, point))
    }

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
    pub(super) fn beyond(mut self, middle: Pos2, object: Option<HalfAxes>) -> Self {
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
    (0.0034 * lens.rect.size().min_elem()).min(1.0)
}

/// The surroundings in which handles are placed.
pub(super) struct Around<'a> {
    pub(super) target: &'a Target<'a>,
    pub(super) mode: HandleMode,
    pub(super) session: &'a Session,
    pub(super) lens: &'a Lens,
    /// The place of the target in the picture.
    pub(super) middle: Pos2,
    /// The size of handles in the view.
    pub(super) part: f32,
    /// The extent of the object.
    pub(super) extent: Option<HalfAxes>,
    /// The handle that is dragged.
    pub(super) held: Option<Handle>,
}

/// The handles of a target in a mode, in the order in which they are painted.
pub(super) fn placed(
    target: &Target,
    mode: HandleMode,
    session: &Session,
    (lens, held): (&Lens, Option<Handle>),
) -> Vec<Placed> {
    let Some(middle) = lens.project(target.at).filter(|p| lens.rect.contains(*p)) else {
        return Vec::new();
    };
    let (part, extent) = (part_of(lens), HalfAxes::of(target, middle, lens));
    let around = Around { target, mode, session, lens, middle, part, extent, held };
    SORTS.iter().flat_map(|sort| (sort.placed)(&around)).collect()
}

/// Extent of an object in the picture: the projected half axes of the ellipsoid inscribed in its bounds, in points.
#[derive(Clone, Copy, Debug)]
pub(super) struct HalfAxes([Vec2; 3]);

impl HalfAxes {
    /// Extent of the target's object; `None` if the target is a light or an axis ends behind the camera.
    pub(super) fn of(target: &Target, middle: Pos2, lens: &Lens) -> Option<Self> {
        let Body::Object(object, half) = target.body else { return None };
        let turned = rotation(object.rotation);
        let axis = |i: usize| {
            let end = lens.project(target.at + turned * (Vec3::AXES[i] * object.size * half[i]))?;
            Some(end - middle)
        };
        Some(Self([axis(0)?, axis(1)?, axis(2)?]))
    }

    /// True if the picture has room for handles around the object.
    pub(super) fn leaves_room(&self, part: f32, lens: &Lens) -> bool {
        let needed = STUB * part * ARM + 2.0 * LETTER;
        self.most() + needed < 0.5 * lens.rect.size().min_elem()
    }

    /// Distance from the centre, in a direction of the picture, beyond which a handle does not cover the object.
    pub(super) fn towards(&self, way: Vec2) -> f32 {
        let way = way.normalized();
        self.0.iter().map(|axis| axis.dot(way).powi(2)).sum::<f32>().sqrt() + CLEAR
    }

    /// The largest such distance in any direction.
    pub(super) fn most(&self) -> f32 {
        let ways = (0..16).map(|k| Vec2::angled(k as f32 / 16.0 * 0.5 * TAU));
        ways.map(|way| self.towards(way)).fold(0.0, f32::max)
    }
}
