//! Several lights and objects moved, turned, aligned and distributed together.

use std::{cmp::Ordering, f32, sync::Arc};

use glam::{Quat, Vec3};

use super::Session;
use crate::{
    declared::texts,
    document::{Edit, Selection},
    registry::Registry,
    scene::{
        Light, Object, Part, SceneSize,
        rotation::{rotation, turned},
    },
};

/// Distance that moved parts keep from the walls at 0, which are not part of the room, in metres.
const OFF_WALLS: f32 = 0.01;

texts! {
    /// The ways to arrange parts along an axis.
    Arrangement(
        /// The part of a command's id.
        id
    ) {
        /// The ends with the smallest coordinates in one plane.
        Low = "low",
        /// The middles of their extents in one plane.
        Middle = "middle",
        /// The ends with the largest coordinates in one plane.
        High = "high",
        /// Their positions in equal distances, between those of the first and the last.
        Apart = "apart",
    }
}

/// Rounds off the noise digits of a sum.
pub(super) fn tidy(v: Vec3) -> Vec3 {
    (v * 10_000.0).round() / 10_000.0 + Vec3::ZERO
}

/// A light or an object in its place.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Standing {
    part: Part,
    position: Option<Vec3>,
    /// Half the extents along the axes of the room.
    half: Vec3,
    /// The rotation of an object, in degrees.
    rotation: Option<Vec3>,
    /// The direction of a light.
    direction: Option<Vec3>,
}

/// Several lights and objects in their places, one for each row. Copies share them.
#[derive(Clone, Debug, PartialEq)]
pub struct Together {
    all: Arc<[Standing]>,
    /// The mean of their positions, which is theirs too when they are turned about it.
    middle: Vec3,
    name: Arc<str>,
}

impl Together {
    /// The selected lights and objects of a session; `None` if they are not several, or none has a position.
    #[must_use]
    pub fn of(session: &Session, registry: &Registry) -> Option<Self> {
        if !session.has_group() {
            return None;
        }
        let standing = |part: Selection| match part {
            Selection::Light(i) => {
                let Light { position, direction, .. } = session.document.lights.get(i)?;
                let (position, direction) = (*position, *direction);
                Some(Standing { part: part.into(), position, half: Vec3::ZERO, rotation: None, direction })
            }
            Selection::Object(i) => {
                let object = session.document.objects.get(i)?;
                let half = registry.shape(&object.object_type).map(|shape| shape.bounds(&object.shape).half);
                let turn = rotation(object.rotation);
                let half = object.size * half.unwrap_or_default();
                // The box around a box that is turned.
                let half = (0..3).map(|i| (turn * (half[i] * Vec3::AXES[i])).abs()).sum();
                let (position, rotation) = (Some(object.position), Some(object.rotation));
                Some(Standing { part: part.into(), position, half, rotation, direction: None })
            }
            Selection::Room | Selection::Observer => None,
        };
        let all = session.entries().into_iter().filter_map(standing).collect();
        Self::new(all, session.name_of_group())
    }

    fn new(all: Vec<Standing>, name: String) -> Option<Self> {
        let mut count = 0.0;
        // In 64 bits: there may be ten thousand.
        let mut sum = glam::DVec3::ZERO;
        for p in all.iter().filter_map(|one| one.position) {
            (count, sum) = (count + 1.0, sum + p.as_dvec3());
        }
        let middle = (sum / count).as_vec3();
        (count > 0.0).then(|| Self { all: all.into(), middle, name: name.into() })
    }

    /// The mean of their positions.
    #[must_use]
    pub fn middle(&self) -> Vec3 {
        self.middle
    }

    /// The diameter of the sphere about their middle that holds all of them.
    #[must_use]
    pub fn span(&self) -> f32 {
        2.0 * self.places().map(|(_, p, half)| p.distance(self.middle) + half.length()).fold(0.0, f32::max)
    }

    /// What they are, in words.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The positions, with the half extents along the axes of the room.
    pub fn places(&self) -> impl Iterator<Item = (Part, Vec3, Vec3)> {
        self.all.iter().filter_map(|one| Some((one.part, one.position?, one.half)))
    }

    fn edit(&self, verb: &str, edits: Vec<Edit>) -> Edit {
        Edit::Each { edits, step: format!("{verb} {}", self.name) }
    }

    /// A movement of all, as far as all of them stay in the room.
    #[must_use]
    pub fn within(&self, by: Vec3, room: SceneSize) -> Vec3 {
        let (mut least, mut most) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        for (_, p, _) in self.places() {
            (least, most) = (least.min(p), most.max(p));
        }
        let back = (Vec3::splat(OFF_WALLS) - least).min(Vec3::ZERO);
        let on = (room.corner() - most).max(Vec3::ZERO);
        by.max(back).min(on)
    }

    /// The edit that moves all alike, as far as all of them stay in the room.
    #[must_use]
    pub fn moved(&self, by: Vec3, room: SceneSize) -> Edit {
        let by = self.within(by, room);
        let to = |p: Vec3| if by == Vec3::ZERO { p } else { (p + by).map(digits).min(room.corner()) };
        let edits = self.places().map(|(part, p, _)| Edit::set(part, Object::position, to(p)));
        self.edit("Move", edits.collect())
    }

    /// The edit that turns all about an axis of the room through their common middle; `None` if one would leave the room.
    #[must_use]
    pub fn turned(&self, axis: Vec3, radians: f32, room: SceneSize) -> Option<Edit> {
        let turn = Quat::from_axis_angle(axis, radians);
        let mut edits = Vec::with_capacity(self.all.len());
        for one in &*self.all {
            let mut values = Vec::with_capacity(2);
            if let Some(p) = one.position {
                let to = if radians == 0.0 { p } else { tidy(self.middle + turn * (p - self.middle)) };
                if !room.contains(to) {
                    return None;
                }
                values.push((Object::position.into(), Some(to.into())));
            }
            if let Some(degrees) = one.rotation {
                let to = if radians == 0.0 { degrees } else { turned(rotation(degrees), axis, radians) };
                values.push((Object::rotation.into(), Some(to.into())));
            }
            if let Some(d) = one.direction {
                let to = if radians == 0.0 { d } else { tidy(turn * d) };
                values.push((Light::direction.into(), Some(to.into())));
            }
            edits.push(Edit::Set { part: one.part, values, what: None });
        }
        Some(self.edit("Turn", edits))
    }

    /// The edit that arranges all along an axis of the room.
    ///
    /// # Errors
    /// Returns the reason if they are too few.
    pub fn arranged(&self, how: Arrangement, axis: usize, room: SceneSize) -> Result<Edit, String> {
        let places: Vec<_> = self.places().collect();
        let ends = |one: &(Part, Vec3, Vec3)| [one.1[axis] - one.2[axis], one.1[axis] + one.2[axis]];
        let low = places.iter().map(|one| ends(one)[0]).fold(f32::INFINITY, f32::min);
        let high = places.iter().map(|one| ends(one)[1]).fold(f32::NEG_INFINITY, f32::max);
        let needed = if how == Arrangement::Apart { 3 } else { 2 };
        if places.len() < needed {
            let number = if needed == 3 { "three" } else { "two" };
            return Err(format!("Select at least {number} lights or objects with positions."));
        }
        let at: Vec<f32> = match how {
            Arrangement::Low => places.iter().map(|one| low + one.2[axis]).collect(),
            Arrangement::Middle => vec![0.5 * (low + high); places.len()],
            Arrangement::High => places.iter().map(|one| high - one.2[axis]).collect(),
            Arrangement::Apart => apart(&places.iter().map(|one| one.1[axis]).collect::<Vec<_>>()),
        };
        let edits = places.iter().zip(at).map(|((part, p, _), at)| {
            let mut to = *p;
            if at != p[axis] {
                to[axis] = digits(at);
                to[axis] = room.nearest(to)[axis];
            }
            Edit::set(*part, Object::position, to)
        });
        let verb = if how == Arrangement::Apart { "Distribute" } else { "Align" };
        Ok(self.edit(verb, edits.collect()))
    }
}

/// A coordinate without the noise digits of a sum.
fn digits(v: f32) -> f32 {
    tidy(Vec3::splat(v)).x
}

/// Numbers in their order with equal distances: x_k = x_0 + k (x_n − x_0) / n. The first and the last stay.
fn apart(numbers: &[f32]) -> Vec<f32> {
    let mut order: Vec<usize> = (0..numbers.len()).collect();
    order.sort_by(|a, b| numbers[*a].partial_cmp(&numbers[*b]).unwrap_or(Ordering::Equal));
    let mut to = numbers.to_vec();
    if let [first, .., last] = order[..] {
        let (from, range) = (numbers[first], numbers[last] - numbers[first]);
        let count = (order.len() - 1) as f32;
        for (k, i) in order[..order.len() - 1].iter().enumerate() {
            to[*i] = from + range * k as f32 / count;
        }
    }
    to
}

impl Session {
    pub(super) fn arrange(&mut self, how: Arrangement, axis: usize, registry: &Registry) {
        let room = self.document.scene_size;
        let edit = Together::of(self, registry)
            .ok_or_else(|| "Select several lights or objects to arrange them.".to_owned())
            .and_then(|all| all.arranged(how, axis.min(2), room));
        self.alone(edit, registry);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROOM: SceneSize = SceneSize { height: 10.0, width: 10.0, depth: 10.0 };

    fn together(places: &[(Vec3, f32)]) -> Together {
        let standing = |(i, (p, half)): (usize, &(Vec3, f32))| Standing {
            part: Part::Object(i),
            position: Some(*p),
            half: Vec3::splat(*half),
            rotation: Some(Vec3::ZERO),
            direction: None,
        };
        let all = places.iter().enumerate().map(standing).collect();
        Together::new(all, "some".to_owned()).expect("they have places")
    }

    fn three() -> Together {
        together(&[
            (Vec3::new(2.0, 3.0, 5.0), 0.5),
            (Vec3::new(6.0, 4.0, 5.0), 1.0),
            (Vec3::new(3.0, 8.0, 2.0), 0.25),
        ])
    }

    /// The positions that an edit sets.
    fn positions(edit: &Edit) -> Vec<Vec3> {
        let Edit::Each { edits, .. } = edit else { panic!("{edit:?}") };
        let position = |edit: &Edit| {
            edit.values().1.iter().find_map(|(key, value)| match value {
                Some(crate::parameter::Value::Triple(p)) if *key == Object::position.into() => {
                    Some(Vec3::from(*p))
                }
                _ => None,
            })
        };
        edits.iter().filter_map(position).collect()
    }

    fn arranged(how: Arrangement, axis: usize) -> Vec<f32> {
        let edit = three().arranged(how, axis, ROOM).expect("they are three");
        positions(&edit).iter().map(|p| p[axis]).collect()
    }

    #[test]
    fn ends_and_middles_come_into_one_plane() {
        let halves = [0.5, 1.0, 0.25];
        let spread = |ends: &[f32]| ends.iter().fold(0.0, |most: f32, v| most.max((v - ends[0]).abs()));
        for axis in 0..3 {
            for (how, sign) in
                [(Arrangement::Low, -1.0), (Arrangement::Middle, 0.0), (Arrangement::High, 1.0)]
            {
                let at = arranged(how, axis);
                let ends = |sign: f32| -> Vec<f32> {
                    at.iter().zip(halves).map(|(p, half)| p + sign * half).collect()
                };
                assert!(spread(&ends(sign)) < 1e-3, "{how:?} along {axis}: {at:?}");
                // The twin takes another end: of different sizes only one can be in a plane.
                assert!(spread(&ends(sign - 1.0)) > 0.2, "{how:?} along {axis}: {at:?}");
            }
        }
        assert_eq!(arranged(Arrangement::Low, 0), [2.0, 2.5, 1.75]);
        assert_eq!(arranged(Arrangement::High, 1), [7.75, 7.25, 8.0]);
    }

    #[test]
    fn distances_become_equal_and_the_order_stays() {
        assert_eq!(arranged(Arrangement::Apart, 0), [2.0, 6.0, 4.0]);
        let steps = |all: &[f32]| all.windows(2).map(|pair| pair[1] - pair[0]).collect::<Vec<_>>();
        let equal = |steps: &[f32]| steps.iter().all(|step| (step - steps[0]).abs() < 1e-5);
        let before = [0.5, 1.0, 4.0, 4.5, 9.0];
        let after = apart(&before);
        assert!(equal(&steps(&after)), "{after:?}");
        assert!(!equal(&steps(&before)), "the twin that changes nothing");
        assert_eq!((after[0], after[4]), (0.5, 9.0));
        let two = together(&[(Vec3::ONE, 0.1), (Vec3::splat(2.0), 0.1)]);
        assert!(two.arranged(Arrangement::Apart, 0, ROOM).is_err());
    }

    #[test]
    fn all_move_alike_and_stop_together_at_the_walls() {
        let all = three();
        let before: Vec<_> = all.places().map(|(_, p, _)| p).collect();
        for (by, expected) in [
            (Vec3::new(1.0, -2.0, 0.5), Vec3::new(1.0, -2.0, 0.5)),
            (Vec3::new(50.0, 0.0, 0.0), Vec3::new(4.0, 0.0, 0.0)),
            (Vec3::new(0.0, -50.0, 0.0), Vec3::new(0.0, -2.99, 0.0)),
        ] {
            let after = positions(&all.moved(by, ROOM));
            for (from, to) in before.iter().zip(&after) {
                assert!((*to - *from).distance(expected) < 1e-3, "{by}: {from} became {to}");
            }
        }
        assert_eq!(positions(&all.moved(Vec3::ZERO, ROOM)), before);
    }

    #[test]
    fn the_span_holds_all_of_them() {
        let two = together(&[(Vec3::new(2.0, 5.0, 5.0), 0.5), (Vec3::new(6.0, 5.0, 5.0), 0.25)]);
        assert!((two.span() - 2.0 * (2.0 + 0.5 * 3f32.sqrt())).abs() < 1e-5, "{}", two.span());
    }

    #[test]
    fn turning_keeps_distances_and_the_common_middle() {
        let all = three();
        let before: Vec<_> = all.places().map(|(_, p, _)| p).collect();
        let edit = all.turned(Vec3::Y, 0.7, ROOM).expect("there is room");
        let after = positions(&edit);
        let middle = after.iter().sum::<Vec3>() / 3.0;
        assert!(middle.distance(all.middle()) < 1e-3, "{middle}");
        for (i, k) in [(0, 1), (1, 2), (0, 2)] {
            let apart = |p: &[Vec3]| p[i].distance(p[k]);
            assert!((apart(&before) - apart(&after)).abs() < 1e-3);
        }
        assert!(before.iter().zip(&after).all(|(from, to)| from.distance(*to) > 0.1));
        let Edit::Each { edits, .. } = edit else { unreachable!("as above") };
        let turned = Some(Vec3::new(0.0, 40.11, 0.0).into());
        assert!(edits.iter().all(|edit| edit.values().1[1].1 == turned), "{edits:?}");
        // At the wall there is none.
        let wide = together(&[(Vec3::new(0.5, 5.0, 0.5), 0.1), (Vec3::new(9.5, 5.0, 9.5), 0.1)]);
        assert!(wide.turned(Vec3::Y, 0.8, ROOM).is_none());
    }
}
