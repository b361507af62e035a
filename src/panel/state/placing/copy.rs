//! The position of a copy of an object, by the bounds of all objects in the picture.

use std::cell::LazyCell;

use glam::{Vec2, Vec3};

use super::{GAP, SLACK, Stand, block::Block, round};
use crate::scene::{Object, observer::WIDE};

/// Distances of a copy from the original, in widths or heights of a copy with a small gap: with that gap, closer down
/// to where the two touch, and then farther away in steps of [`FARTHER`].
const NEXT_TO: [f32; 6] = [1.0, 0.98, 0.96, 0.94, 0.925, 0.915];
const FARTHER: f32 = 0.03;
const MOST_FARTHER: u8 = 150;
/// Number of places across and down the picture that are tried all over it.
const PLACES: [i16; 2] = [48, 32];
/// The part of the bounds of objects that two of them cannot share.
const SOLID: f32 = 0.85;
/// Number of points across a copy that are tested for being covered or cut off.
const POINTS: i16 = 12;
/// Cost of a covered part of a copy relative to that of a part that is cut off.
const COVERED: f32 = 2.0;
/// Maximum cost of a place in the picture that is better than one beside the original and partly outside.
const LITTLE_HIDDEN: f32 = 0.35;
/// Cost of a copy that is cut off by more than half.
const MOSTLY_CUT: f32 = 1.0;
/// Cost of a copy that is neither level with the original nor right above or below it.
const ASKEW: f32 = 0.03;

/// Bounds in the picture, as tangents to the right and up.
#[derive(Clone, Copy, Debug)]
struct Framed {
    low: Vec2,
    high: Vec2,
}

impl Framed {
    fn middle(&self) -> Vec2 {
        0.5 * (self.low + self.high)
    }

    fn half(&self) -> Vec2 {
        0.5 * (self.high - self.low)
    }

    fn is_within(&self, [across, up]: [f32; 2]) -> bool {
        let opening = Vec2::new(across, up);
        self.low.cmpge(-opening).all() && self.high.cmple(opening).all()
    }

    fn meets(&self, other: &Self) -> bool {
        self.low.cmplt(other.high).all() && other.low.cmplt(self.high).all()
    }

    fn holds(&self, p: Vec2) -> bool {
        self.low.cmple(p).all() && self.high.cmpge(p).all()
    }

    /// True if a position is in the ellipse within the bounds.
    fn covers(&self, p: Vec2) -> bool {
        ((p - self.middle()) / self.half()).length_squared() <= 1.0
    }
}

/// The tangents of the angles at which a ball begins and ends that is aside of the line of sight. It is wholly in front
/// of the camera.
fn edges(aside: f32, depth: f32, radius: f32) -> [f32; 2] {
    let rest = (aside * aside + depth * depth - radius * radius).sqrt();
    [-1.0, 1.0].map(|side| (aside * depth + side * radius * rest) / (depth * depth - radius * radius))
}

/// An object, and what its copy keeps clear of.
struct Around<'s> {
    stand: &'s Stand<'s>,
    original: &'s Object,
    block: Block,
    /// The bounds of the original and of its neighbours.
    neighbours: Vec<Framed>,
    /// What a copy touches only if there is no other place, the original among it.
    solid: Vec<Block>,
    /// Floors and backdrops, on which a copy may stand, but not in them.
    ground: Vec<Block>,
    /// True if the original is out of the picture: its copy stands beside it nevertheless.
    is_out: bool,
}

impl Stand<'_> {
    /// Position of a copy of the object with the given index, at the depth of the original: to its left or right as
    /// seen by the camera, wholly in the picture and over no other object; elsewhere in the picture if there is no such
    /// place; to the left or right of the original and partly outside the picture if that has none; and only if there
    /// is no free place either, where the least of it is covered or cut off.
    pub(in crate::panel::state) fn copy(&self, index: usize) -> Vec3 {
        let Some(original) = self.scene.objects.get(index) else { return self.middle() };
        let around = Around::new(self, original, index);
        let [sides, ups] = [Vec3::X, Vec3::Y].map(|axis| around.along(axis, &NEXT_TO));
        let others: Vec<_> = ups.into_iter().chain(around.all_over()).collect();
        let clear = |places: &[Vec3]| {
            let find = |widens: bool| places.iter().copied().find(|p| around.is_clear(*p, widens));
            find(false).or_else(|| find(true))
        };
        let free = LazyCell::new(|| {
            let places = sides.iter().chain(&others).copied();
            let free: Vec<_> = places.filter(|p| self.sees(*p, 0.0) && around.is_free(*p)).collect();
            around.least_hidden(&free)
        });
        clear(&sides)
            .or_else(|| clear(&others))
            .or_else(|| free.filter(|p| around.hidden(*p) <= LITTLE_HIDDEN))
            .or_else(|| around.beside())
            .or_else(|| *free)
            .or_else(|| around.least_hidden(&[sides.as_slice(), others.as_slice()].concat()))
            .or_else(|| {
                self.search(original.position, 0.55 * original.size, |p| self.free(p, around.block.radius))
            })
            .unwrap_or_else(|| self.lattice(original.position))
    }

    /// True if an object is partly or wholly outside pictures with this ratio of width to height; without one, outside every
    /// view that is no wider than it must be. Floors and backdrops, larger than the picture or around the camera, are not meant
    /// to be whole.
    pub(in crate::panel::state) fn cuts_off(&self, index: usize, aspect: Option<f32>) -> bool {
        let Some(block) = self.taken.get(index) else { return false };
        let opening = aspect.map_or(self.opening, |aspect| {
            let up = (0.5 * self.scene.view_angle().vertical(aspect)).tan();
            [aspect * up, up]
        });
        let is_larger = |framed: &Framed| framed.half().cmpgt(Vec2::from(opening)).any();
        match self.framed(block) {
            Some(framed) => !framed.is_within(opening) && !is_larger(&framed),
            None => !block.ball_holds(self.eye),
        }
    }

    /// The bounds of a block in the picture; `None` if it is around the camera or behind it.
    fn framed(&self, block: &Block) -> Option<Framed> {
        let to_camera = self.turn.inverse();
        let seen = to_camera * (block.centre - self.eye);
        let depth = -seen.z;
        if depth <= block.radius.max(0.1) {
            return None;
        }
        let [[left, right], [bottom, top]] = [seen.x, seen.y].map(|aside| edges(aside, depth, block.radius));
        let mut all = Framed { low: Vec2::new(left, bottom), high: Vec2::new(right, top) };
        let corners = block.corners().map(|corner| to_camera * (corner - self.eye));
        if corners.iter().all(|corner| corner.z < -0.1) {
            let flat = corners.map(|corner| corner.truncate() / -corner.z);
            all.low = all.low.max(flat.into_iter().fold(Vec2::INFINITY, Vec2::min));
            all.high = all.high.min(flat.into_iter().fold(Vec2::NEG_INFINITY, Vec2::max));
        }
        Some(all)
    }

    /// What the picture shows at least if views beside each other are as wide as they can become, as tangents.
    fn widest(&self) -> Vec2 {
        let [across, up] = self.opening;
        Vec2::new(across.max(WIDE * up), up)
    }

    /// True if a block is inside the room, and away from lights and cameras.
    fn has_room(&self, block: &Block) -> bool {
        let reach = Vec3::from([Vec3::X, Vec3::Y, Vec3::Z].map(|axis| block.reach(axis)));
        self.is_inside(block.centre, reach.max(self.margin())) && self.is_in_air(block.centre, block.radius)
    }
}

impl<'s> Around<'s> {
    fn new(stand: &'s Stand<'s>, original: &'s Object, index: usize) -> Self {
        let block = Block::of(original, stand.registry);
        let is_out = !stand.sees(original.position, 0.0);
        let own = stand.framed(&block);
        let (mut neighbours, mut ground): (Vec<_>, Vec<_>) = (own.into_iter().collect(), Vec::new());
        let mut solid = vec![block];
        let (at, depth) = stand.flat(block.centre);
        let picture = Framed { low: -stand.widest(), high: stand.widest() };
        for (_, other) in stand.taken.iter().enumerate().filter(|(i, _)| *i != index) {
            let framed = stand.framed(other);
            // What is behind or around the original, and larger, is no neighbour.
            let is_ground = |framed: &Framed| {
                let is_larger = own
                    .is_none_or(|own| framed.half().element_product() > 2.0 * own.half().element_product());
                framed.holds(at) && is_larger && stand.flat(other.centre).1 + other.radius > depth
            };
            let is_in_sight = |framed: &Framed| is_out || framed.meets(&picture);
            neighbours.extend(framed.filter(|framed| !is_ground(framed) && is_in_sight(framed)));
            // A room holds the camera or the original.
            let is_room = other.gap(stand.eye) <= 0.0 || other.gap(block.centre) <= 0.0;
            if !is_room {
                solid.push(*other);
            }
            if !is_room && (is_out || framed.is_none_or(|framed| is_ground(&framed))) {
                ground.push(*other);
            }
        }
        Self { stand, original, block, neighbours, solid, ground, is_out }
    }

    /// The place of a copy at an offset to the right and up, at the depth of the original.
    fn at(&self, offset: Vec2) -> Vec3 {
        // Fine enough to preserve the depth.
        round(self.original.position + self.stand.turn * offset.extend(0.0), 10.0 * self.stand.steps())
    }

    /// Places in both directions along an axis of the picture: at the given distances, and then farther and farther away.
    fn along(&self, axis: Vec3, next_to: &[f32]) -> Vec<Vec3> {
        let width = GAP * self.block.reach(self.stand.turn * axis).max(0.05);
        let farther = (1..=MOST_FARTHER).map(|n| 1.0 + FARTHER * f32::from(n));
        let counts = next_to.iter().copied().chain(farther);
        counts
            .flat_map(|count| [1.0, -1.0].map(|way| self.at(way * count * width * axis.truncate())))
            .collect()
    }

    /// The nearest free place to the right or left of the original, in the picture or not.
    fn beside(&self) -> Option<Vec3> {
        let mut nearest = NEXT_TO;
        nearest.reverse();
        self.along(Vec3::X, &nearest).into_iter().find(|p| self.is_free(*p))
    }

    /// True if a copy there is in the room, and touches no object.
    fn is_free(&self, p: Vec3) -> bool {
        let block = self.block.at(p);
        let within = block.scaled(SLACK);
        self.stand.has_room(&block)
            && !self.solid.iter().chain(&self.ground).any(|other| within.touches(other))
    }

    /// Places all over the picture, the nearest first; none for an object out of it.
    fn all_over(&self) -> impl Iterator<Item = Vec3> {
        let (at, depth) = self.stand.flat(self.original.position);
        let opening = self.stand.widest();
        let [columns, rows] = PLACES;
        let step = 2.0 * opening / Vec2::new(f32::from(columns), f32::from(rows));
        let mut offsets = Vec::new();
        for i in -columns..=columns {
            for j in -rows..=rows {
                let offset = step * Vec2::new(f32::from(i), f32::from(j));
                if !self.is_out && (at + offset).abs().cmple(opening).all() {
                    offsets.push(depth * offset);
                }
            }
        }
        offsets.sort_by(|a, b| a.length_squared().total_cmp(&b.length_squared()));
        offsets.into_iter().map(|offset| self.at(offset))
    }

    /// What the picture shows at least, as tangents across and up; if it `widens`, as soon as a copy stands there, as views
    /// beside each other do.
    fn opening(&self, p: Vec3, widens: bool) -> [f32; 2] {
        let [across, up] = self.stand.opening;
        let widens = widens && self.original.visible;
        let keeps = widens.then(|| self.stand.scene.widened_by(p, self.original)).flatten();
        [across.max(keeps.map_or(0.0, |keeps| keeps * up)), up]
    }

    /// True if a copy there stands in nothing, is wholly in the picture, and is over no neighbour.
    fn is_clear(&self, p: Vec3, widens: bool) -> bool {
        let block = self.block.at(p);
        let is_seen = |framed: &Framed| {
            (self.is_out || framed.is_within(self.opening(p, widens)))
                && self.neighbours.iter().all(|other| !other.meets(framed))
        };
        self.stand.has_room(&block)
            && self.stand.framed(&block).map_or(self.is_out, |framed| is_seen(&framed))
            && self.ground.iter().all(|other| !block.scaled(SLACK).touches(other))
    }

    /// The place of which the least is covered or cut off, with its centre in the picture if possible.
    fn least_hidden(&self, places: &[Vec3]) -> Option<Vec3> {
        let stand = self.stand;
        // Two objects at the same position look like one.
        let least = 0.2 * self.block.radius;
        let is_another = |p: Vec3| {
            stand.is_inside(p, Vec3::ZERO)
                && stand.is_in_air(p, 0.0)
                && stand.taken.iter().all(|other| other.centre.distance(p) > least)
        };
        let find = |is_seen: &dyn Fn(Vec3) -> bool| {
            let places = places.iter().copied().filter(|p| is_seen(*p) && is_another(*p));
            let costs = places.map(|p| (self.hidden(p), p));
            costs.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, p)| p)
        };
        find(&|p| self.is_out || stand.sees(p, 0.0)).or_else(|| find(&|_| true))
    }

    /// The part of a copy there that is cut off, and that which is covered or stands in something, as a cost.
    fn hidden(&self, p: Vec3) -> f32 {
        let block = self.block.at(p);
        let Some(framed) = self.stand.framed(&block) else { return f32::MAX };
        let opening = Vec2::from(self.opening(p, true));
        let near: Vec<_> = self.neighbours.iter().filter(|other| other.meets(&framed)).collect();
        let (mut count, mut cut, mut covered) = (0.0f32, 0.0, 0.0);
        for i in 0..POINTS {
            for j in 0..POINTS {
                let part = Vec2::new(f32::from(i), f32::from(j)) + 0.5;
                let part = 2.0 * part / f32::from(POINTS) - 1.0;
                let point = framed.middle() + part * framed.half();
                if part.length_squared() > 1.0 {
                    continue;
                }
                count += 1.0;
                if !self.is_out && point.abs().cmpgt(opening).any() {
                    cut += 1.0;
                } else if near.iter().any(|other| other.covers(point)) {
                    covered += 1.0;
                }
            }
        }
        let core = block.scaled(SOLID);
        let stands_in = self.ground.iter().any(|other| block.scaled(SLACK).touches(other))
            || self.solid.iter().any(|other| core.touches(&other.scaled(SOLID)));
        let mostly = if cut > 0.5 * count { MOSTLY_CUT } else { 0.0 };
        let offset = (self.stand.turn.inverse() * (p - self.original.position)).truncate().abs();
        let askew = if offset.min_element() > 0.02 * self.block.radius { ASKEW } else { 0.0 };
        (COVERED * covered + cut) / count + mostly + askew + if stands_in { COVERED } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::{
        document::Selection,
        panel::state::{Action, Session},
        registry::Registry,
        scene::load::{self, Defaults},
    };

    fn session_of(name: &str) -> Session {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes/{name}.json"));
        let scene = load::file(&file, &Registry::builtin(), Defaults::Refuse).expect("legal").scene;
        Session::new(scene)
    }

    fn stand<'a>(session: &'a Session, registry: &'a Registry) -> Stand<'a> {
        Stand::new(&session.document, registry, session.facts.eye, session.facts.camera)
    }

    /// An object of a shipped scene, its copy, and whether the picture with both shows the centre of the copy.
    fn copied(name: &str, index: usize) -> (Block, Block, bool) {
        let (registry, mut session) = (Registry::builtin(), session_of(name));
        let _ = session.apply(Action::Duplicate(Selection::Object(index)), &registry);
        let stand = stand(&session, &registry);
        let [original, copy] = [0, 1].map(|i| stand.taken[index + i]);
        (original, copy, stand.sees(copy.centre, 0.0))
    }

    #[test]
    fn a_copy_with_little_room_stands_as_far_from_the_original_as_the_picture_reaches() {
        let (original, copy, seen) = copied("models_from_files", 0);
        assert!(seen && !copy.scaled(0.85).touches(&original.scaled(0.85)), "{copy:?} in {original:?}");
    }

    #[test]
    fn a_copy_is_seen_in_the_narrow_views_of_a_comparison() {
        let (original, copy, seen) = copied("compare_phong_blinn_phong", 0);
        assert!(seen, "{copy:?}");
        assert!(copy.centre.distance(original.centre) > 1.1 * original.radius, "{copy:?}");
        assert!(!copy.touches(&original), "{copy:?} in {original:?}");
    }

    #[test]
    fn floors_are_not_cut_off_but_objects_out_of_the_picture_are() {
        let (registry, mut session) = (Registry::builtin(), session_of("default"));
        let eye = session.facts.eye;
        let cube = |position: Vec3, size: f32| Object {
            object_type: "cube".to_owned(),
            position,
            size,
            ..Object::default()
        };
        session.document.amend(|scene| {
            scene.objects = [cube(eye - 18.0 * Vec3::Y, 30.0), cube(eye + 18.0 * Vec3::X, 1.0)].into();
        });
        let stand = stand(&session, &registry);
        assert!(!stand.cuts_off(0, None) && stand.cuts_off(1, None));
    }

    #[test]
    fn what_is_cut_off_depends_on_the_shape_of_the_picture() {
        let (registry, mut session) = (Registry::builtin(), session_of("default"));
        let up = (0.5 * session.document.observer.field_of_view.to_radians()).tan();
        let (eye, turn) = (session.facts.eye, session.facts.camera);
        // In halves of the height of a wide picture.
        let ball = |across: f32, rise: f32| Object {
            position: eye + turn * (4.5 * Vec3::new(across * up, rise * up, -1.0)),
            size: 0.2,
            ..Object::default()
        };
        session.document.amend(|scene| scene.objects = [ball(2.0, 0.0), ball(0.0, 1.3)].into());
        let stand = stand(&session, &registry);
        for (aspect, cut) in [
            (None, [true, true]),
            (Some(WIDE), [true, true]),
            (Some(2.2), [false, true]),
            (Some(1.0), [true, false]),
        ] {
            assert_eq!([0, 1].map(|i| stand.cuts_off(i, aspect)), cut, "{aspect:?}");
        }
    }

    #[test]
    fn a_copy_without_room_in_the_picture_stands_beside_the_original_in_nothing() {
        for name in ["compare_phong_blinn_phong", "portrait"] {
            let (registry, session) = (Registry::builtin(), session_of(name));
            let stand = stand(&session, &registry);
            let (original, copy) = (stand.taken[0], stand.taken[0].at(stand.copy(0)));
            assert!(!copy.touches(&original), "{name}: {copy:?} in {original:?}");
            assert!(stand.has_room(&copy), "{name}: {copy:?}");
            let by = stand.turn.inverse() * (copy.centre - original.centre);
            let width = original.reach(stand.turn * Vec3::X);
            assert!(by.y.abs() < 0.02 && by.z.abs() < 0.02, "{name}: {by}, as the camera sees it");
            assert!((1.99..2.1).contains(&(by.x.abs() / width)), "{name}: {by} at a width of {width}");
        }
    }

    /// The bounds of all objects after copies of one were made, each wholly in the picture and over no other object.
    fn all_clear(what: &str, mut session: Session, index: usize, copies: usize) {
        let registry = Registry::builtin();
        for _ in 0..copies {
            let _ = session.apply(Action::Duplicate(Selection::Object(index)), &registry);
        }
        let stand = stand(&session, &registry);
        let all: Vec<_> = stand.taken.iter().filter_map(|block| stand.framed(block)).collect();
        let depths = stand.taken.iter().map(|block| stand.flat(block.centre).1);
        let depths: Vec<_> = depths.skip(index).take(copies + 1).collect();
        assert!(depths.iter().all(|depth| (depth - depths[0]).abs() < 0.02), "{what}: {depths:?}");
        for (i, one) in all.iter().enumerate() {
            assert!(one.is_within(stand.opening), "{what}: {i} is cut off: {one:?} in {:?}", stand.opening);
            assert!(all[..i].iter().all(|other| !other.meets(one)), "{what}: {i} overlaps: {all:?}");
        }
    }

    #[test]
    fn copies_are_whole_and_overlap_nothing_where_the_picture_has_room() {
        all_clear("default", session_of("default"), 0, 2);
        let mut beside = session_of("default");
        beside.document.amend(|scene| {
            scene.comparison.layout = crate::scene::comparison::Layout::SideBySide;
            scene.variants.push(crate::scene::Variant::default());
        });
        all_clear("beside another view", beside, 0, 2);
        // No room on the axes of the picture, but in its corners.
        let object =
            |x: f32, y: f32| Object { position: Vec3::new(x, y, 5.0), size: 0.9, ..Object::default() };
        let mut cross = session_of("default");
        cross.document.amend(|scene| {
            scene.objects =
                [(0.0, 0.0), (1.1, 0.0), (2.2, 0.0), (-1.1, 0.0), (-2.2, 0.0), (0.0, 1.1), (0.0, -1.1)]
                    .map(|(x, y)| object(5.0 + x, 5.0 + y))
                    .into();
        });
        all_clear("a cross", cross, 0, 1);
    }

    #[test]
    fn a_copy_where_nothing_is_clear_is_covered_and_cut_off_least() {
        let (registry, session) = (Registry::builtin(), session_of("superellipsoids"));
        let stand = stand(&session, &registry);
        let around = Around::new(&stand, &session.document.objects[4], 4);
        let copy = stand.copy(4);
        let least = around.hidden(copy);
        assert!(least > 0.0, "there is a clear place, {copy}");
        for p in around.all_over().filter(|p| stand.sees(*p, 0.0) && around.is_free(*p)) {
            assert!(around.hidden(p) >= least, "{p} rather than {copy}");
        }
    }
}
