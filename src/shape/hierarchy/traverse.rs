//! Following a ray.
//!
//! Rays meet triangles after S. Woop, C. Benthin, I. Wald (2013), *Watertight Ray/Triangle Intersection*: seen along the
//! ray, all corners are moved by one shear and compared in two dimensions, where the two triangles of an edge calculate
//! the same number with opposite signs. Numbers of 0 count for both triangles, so that no ray passes between them. Boxes
//! are larger than their triangles by more than rounding.

use std::ops::Range;

use glam::{BVec4A, Vec3, Vec3A, Vec3Swizzles as _, Vec4};

use super::{CHILDREN, COUNT_SHIFT, Hierarchy, LEAF, NO_CHILD, NODE_ROWS, NODES, Row, STACK, floats};

/// A ray in the units of the mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// The origin.
    pub origin: Vec3,
    /// The direction, of any length; distances are in units of that length.
    pub direction: Vec3,
}

impl Ray {
    /// The point at a distance.
    #[must_use]
    pub fn at(&self, distance: f32) -> Vec3 {
        self.origin + distance * self.direction
    }
}

/// The sides from which triangles are met.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sides {
    /// From outside and from inside.
    Both,
    /// From inside: where a ray leaves the solid.
    Inside,
}

/// The intersection of a ray with a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// The distance.
    pub distance: f32,
    /// The weights of the triangle's corners: barycentric coordinates, whose sum is 1.
    pub weights: Vec3,
    /// The triangle.
    pub triangle: u32,
    /// True if the triangle is met from inside.
    pub leaves: bool,
}

/// Smallest component of a direction by which boxes are divided; a smaller one makes no difference within a mesh.
const LEAST_COMPONENT: f32 = 1e-20;

/// A ray, prepared for boxes.
struct Slabs {
    origin: Vec3,
    inverse: Vec3,
}

impl Slabs {
    fn new(ray: &Ray) -> Self {
        let inverse = ray.direction.to_array().map(|c| 1.0 / c.abs().max(LEAST_COMPONENT).copysign(c));
        Self { origin: ray.origin, inverse: inverse.into() }
    }

    /// The distances at which the ray enters the boxes of the four children, and true for those that it meets within a
    /// range; a child that does not exist may be among them. Written out for each axis: with rows by number, indices were
    /// checked.
    #[inline]
    fn enter(&self, node: &[Row; NODE_ROWS], range: &Range<f32>) -> (Vec4, BVec4A) {
        let [low_x, low_y, low_z, high_x, high_y, high_z, _] = node;
        let x = between(low_x, high_x, self.origin.x, self.inverse.x);
        let y = between(low_y, high_y, self.origin.y, self.inverse.y);
        let z = between(low_z, high_z, self.origin.z, self.inverse.z);
        let near = x.0.max(y.0).max(z.0.max(Vec4::splat(range.start)));
        let far = x.1.min(y.1).min(z.1.min(Vec4::splat(range.end)));
        (near, near.cmple(far))
    }
}

/// The distances of the nearer and of the farther planes along one axis. Rows that are exchanged by the sign of the
/// direction were copied through memory.
#[inline]
fn between(low: &Row, high: &Row, origin: f32, inverse: f32) -> (Vec4, Vec4) {
    let [low, high] = [low, high].map(|planes| (floats(*planes) - origin) * inverse);
    (low.min(high), low.max(high))
}

/// A ray, prepared for triangles: the axis along which it runs most is third.
struct Shear {
    axes: [usize; 3],
    origin: [Vec4; 3],
    /// Shear along the first and the second axis, and the scale of the third.
    shear: [f32; 3],
}

impl Shear {
    fn new(ray: &Ray) -> Self {
        let main = ray.direction.abs().max_position();
        let backwards = ray.direction[main] < 0.0;
        let [x, y] = [(main + 1) % 3, (main + 2) % 3];
        // Backwards, left and right are exchanged, so that signs tell the side.
        let axes = if backwards { [y, x, main] } else { [x, y, main] };
        let scale = 1.0 / ray.direction[main];
        Self {
            axes,
            origin: axes.map(|axis| Vec4::splat(ray.origin[axis])),
            shear: [ray.direction[axes[0]] * scale, ray.direction[axes[1]] * scale, scale],
        }
    }

    /// The intersection of the ray with a triangle: the distance, the weights, and true from inside.
    #[inline]
    fn meet(&self, triangle: &[Row; 3], sides: Sides) -> Option<(f32, Vec3, bool)> {
        // The last number belongs to the normal.
        let along = |i: usize| Vec3A::from_vec4(floats(triangle[self.axes[i]]) - self.origin[i]);
        let (x, y, z) = (along(0), along(1), along(2));
        let (x, y) = (x - self.shear[0] * z, y - self.shear[1] * z);
        let edges = x.yzx() * y.zxy() - y.yzx() * x.zxy();
        let inside = edges.cmpge(Vec3A::ZERO).all();
        if !inside && (sides == Sides::Inside || !edges.cmple(Vec3A::ZERO).all()) {
            return None;
        }
        let sum = edges.x + edges.y + edges.z;
        if sum == 0.0 {
            return None;
        }
        let weights = edges / sum;
        Some((self.shear[2] * weights.dot(z), weights.into(), sum > 0.0))
    }
}

/// A child that waits, and where the ray enters its box.
#[derive(Clone, Copy, Default)]
struct Waiting {
    child: u32,
    enters: f32,
}

/// The children that wait, the nearest last.
struct Stack {
    waiting: [Waiting; STACK],
    count: usize,
}

impl Stack {
    fn pop(&mut self) -> Option<Waiting> {
        self.count = self.count.checked_sub(1)?;
        Some(self.waiting[self.count])
    }

    /// Adds the children that a ray meets, the farthest first.
    #[inline]
    fn push(&mut self, children: &Row, enters: Vec4, mut meets: u32) {
        let (first, enters) = (self.count, enters.to_array());
        // Most rays meet one child or two.
        while meets != 0 {
            let i = (meets.trailing_zeros() & 3) as usize;
            meets &= meets - 1;
            let new = Waiting { child: children[i], enters: enters[i] };
            if new.child == NO_CHILD {
                continue;
            }
            let mut at = self.count;
            while at > first && self.waiting[at - 1].enters < new.enters {
                self.waiting[at] = self.waiting[at - 1];
                at -= 1;
            }
            self.waiting[at] = new;
            self.count += 1;
        }
    }
}

impl Hierarchy {
    /// The first intersection of a ray with a triangle within a range of distances. Of triangles at equal distance, as
    /// at a shared edge, any.
    #[must_use]
    pub fn nearest(&self, ray: &Ray, range: Range<f32>, sides: Sides) -> Option<Hit> {
        let (slabs, shear) = (Slabs::new(ray), Shear::new(ray));
        let mut best = None;
        let mut range = range;
        let mut stack = Stack { waiting: [Waiting::default(); STACK], count: 1 };
        stack.waiting[0].enters = range.start;
        while let Some(Waiting { child, enters }) = stack.pop() {
            if enters > range.end {
                continue;
            }
            if child & LEAF == 0 {
                let first = NODES + NODE_ROWS * child as usize;
                let Some(node) = self.rows[first..].first_chunk() else { continue };
                let (enters, meets) = slabs.enter(node, &range);
                stack.push(&node[CHILDREN], enters, meets.bitmask());
                continue;
            }
            let first = child & ((1 << COUNT_SHIFT) - 1);
            for triangle in first..first + (child >> COUNT_SHIFT & 7) + 1 {
                let met = shear.meet(self.triangle(triangle), sides);
                if let Some((distance, weights, leaves)) = met.filter(|(d, ..)| range.contains(d)) {
                    range.end = distance;
                    best = Some(Hit { distance, weights, triangle, leaves });
                }
            }
        }
        best
    }
}
