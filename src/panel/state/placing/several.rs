//! The step from several lights and objects to their copies, which keep their formation.

use std::collections::HashSet;

use glam::Vec3;

use super::{APART, Block, GAP, SLACK, Stand, round};
use crate::document::Selection;

/// Space that a light takes, in metres from its position.
const LAMP: f32 = 0.02;
/// Maximum number of parts whose copies are placed between them, and of steps that are tried for that.
const MOST_BETWEEN: usize = 256;
const STEPS_BETWEEN: u8 = 24;

/// Lights and objects that are copied together, and what is around them.
struct Group<'s> {
    stand: &'s Stand<'s>,
    all: Vec<Block>,
    /// Those that are completely in the picture, and those whose centres are.
    shown: Vec<Block>,
    seen: Vec<Block>,
    /// The other objects, and those of them that are not behind or around the group.
    others: Vec<Block>,
    beside: Vec<Block>,
    /// The boxes around all along the axes of the picture, and of the room.
    framed: Block,
    boxed: Block,
}

impl Stand<'_> {
    /// The step from several lights and objects to their copies: beside all of them as seen by the camera, at the same
    /// depth, where no copy stands in an object. Without room for that, between them, or in front of or behind all of
    /// them. `None` if there is no such place, or none of them has a position.
    pub(in crate::panel::state) fn step_of(&self, parts: &[Selection]) -> Option<Vec3> {
        let group = Group::new(self, parts)?;
        let [side, up] = [Vec3::X, Vec3::Y].map(|axis| group.width(self.turn * axis));
        let place = |fits: &dyn Fn(Vec3) -> bool| self.beside(Vec3::ZERO, [side, up], &APART, fits);
        place(&|by| group.shows(by) && group.is_free(by) && group.is_clear(by))
            .or_else(|| place(&|by| group.sees(by) && group.is_free(by) && group.is_clear(by)))
            .or_else(|| place(&|by| group.shows(by) && group.is_free(by)))
            .or_else(|| place(&|by| group.sees(by) && group.is_free(by)))
            .or_else(|| group.between())
            .or_else(|| place(&|by| group.is_free(by)))
            .or_else(|| group.behind())
    }
}

impl<'s> Group<'s> {
    fn new(stand: &'s Stand<'s>, parts: &[Selection]) -> Option<Self> {
        let scene = stand.scene;
        let block = |part: &Selection| match *part {
            Selection::Light(i) => scene.lights.get(i)?.position.map(|at| Block::ball(at, LAMP)),
            Selection::Object(i) => Some(Block::of(scene.objects.get(i)?, stand.registry).scaled(SLACK)),
            Selection::Room | Selection::Observer => None,
        };
        let all: Vec<_> = parts.iter().filter_map(block).collect();
        if all.is_empty() {
            return None;
        }
        let own: HashSet<_> = parts.iter().copied().collect();
        let others = scene.objects.iter().enumerate();
        let others = others.filter(|(i, _)| !own.contains(&Selection::Object(*i)));
        let others: Vec<_> = others.map(|(_, object)| Block::of(object, stand.registry)).collect();
        let framed = Block::around(&all, Vec3::AXES.map(|axis| stand.turn * axis));
        let of = |is: &dyn Fn(&Block) -> bool, blocks: &[Block]| -> Vec<Block> {
            blocks.iter().filter(|&block| is(block)).copied().collect()
        };
        Some(Self {
            stand,
            shown: of(&|block: &Block| stand.shows(block), &all),
            seen: of(&|block: &Block| stand.sees(block.centre, 0.0), &all),
            beside: of(&|other: &Block| !stand.hides(other, &framed, true), &others),
            others,
            boxed: Block::around(&all, Vec3::AXES),
            framed,
            all,
        })
    }

    /// The largest extent of one of them from its centre along an axis.
    fn reach(&self, axis: Vec3) -> f32 {
        self.all.iter().map(|block| block.reach(axis)).fold(0.0, f32::max)
    }

    /// The extent of all along an axis, with the gap that a single copy leaves.
    fn width(&self, axis: Vec3) -> f32 {
        let width = Block::end(&self.all, axis) + Block::end(&self.all, -axis);
        width + ((GAP - 2.0) * self.reach(axis)).max(0.05)
    }

    /// True if all copies are in the picture whose originals are.
    fn shows(&self, by: Vec3) -> bool {
        self.shown.iter().all(|block| self.stand.shows(&block.at(block.centre + by)))
    }

    /// True if the centres of all copies are in the picture for whose originals that holds.
    fn sees(&self, by: Vec3) -> bool {
        self.seen.iter().all(|block| self.stand.sees(block.centre + by, 0.0))
    }

    /// True if all copies are inside the room, away from lights and cameras, and touch none of the other objects.
    fn is_free(&self, by: Vec3) -> bool {
        let (stand, centre) = (self.stand, self.boxed.centre + by);
        let reach = Vec3::from(Vec3::AXES.map(|axis| self.boxed.reach(axis)));
        let framed = self.framed.at(self.framed.centre + by);
        let near: Vec<_> = self.others.iter().filter(|other| other.touches(&framed)).collect();
        let is_free = |block: Block| {
            stand.is_in_air(block.centre, block.radius) && near.iter().all(|other| !block.touches(other))
        };
        stand.is_inside(centre, reach.max(stand.margin()))
            && self.all.iter().all(|block| is_free(block.at(block.centre + by)))
    }

    /// True if the copies as a whole cover no neighbour in the picture.
    fn is_clear(&self, by: Vec3) -> bool {
        let framed = self.framed.at(self.framed.centre + by);
        self.beside.iter().all(|other| !self.stand.hides(other, &framed, false))
    }

    /// A step that takes no copy into one of the originals.
    fn is_apart(&self, by: Vec3) -> bool {
        self.all.iter().all(|block| {
            let copy = block.at(block.centre + by);
            self.all.iter().all(|other| !copy.touches(other))
        })
    }

    /// A step shorter than the group, to places between them.
    fn between(&self) -> Option<Vec3> {
        if self.all.len() > MOST_BETWEEN {
            return None;
        }
        let turn = self.stand.turn;
        let steps = [Vec3::X, Vec3::Y].map(|axis| 0.5 * GAP * self.reach(turn * axis).max(0.05));
        let counts: Vec<_> = (1..=STEPS_BETWEEN).map(f32::from).collect();
        let fits = |by: Vec3| self.sees(by) && self.is_apart(by) && self.is_free(by);
        self.stand.beside(Vec3::ZERO, steps, &counts, fits)
    }

    /// A level step to places behind or in front of all of them.
    fn behind(&self) -> Option<Vec3> {
        let right = (self.stand.turn * Vec3::X).with_y(0.0).try_normalize().unwrap_or(Vec3::X);
        let ahead = right.cross(Vec3::NEG_Y);
        let width = self.width(ahead);
        let steps = APART.iter().flat_map(|count| [width * *count, -width * *count]);
        let mut steps = steps.map(|step| round(step * ahead, 10.0 * self.stand.steps()));
        steps.find(|by| self.is_free(*by))
    }
}
