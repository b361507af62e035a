//! The space that an object takes: a box that rotates with it, inside a sphere.

use glam::Vec3;

use crate::{
    registry::Registry,
    scene::{Object, rotation::rotation},
    shape::Bounds,
};

/// The intersection of a rotated box and its bounding sphere.
#[derive(Clone, Copy, Debug)]
pub(super) struct Block {
    pub(super) centre: Vec3,
    /// Directions of the edges, and half the extents along them.
    axes: [Vec3; 3],
    half: [f32; 3],
    /// Radius of the sphere.
    pub(super) radius: f32,
}

impl Block {
    pub(super) fn of(object: &Object, registry: &Registry) -> Self {
        let shape = registry.shape(&object.object_type);
        let bounds = shape.map_or_else(Bounds::default, |shape| shape.bounds(&object.shape));
        let turn = rotation(object.rotation);
        Self {
            centre: object.position,
            axes: [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| turn * axis),
            half: (object.size * bounds.half).to_array(),
            radius: object.size * bounds.radius,
        }
    }

    /// A ball.
    pub(super) fn ball(centre: Vec3, radius: f32) -> Self {
        Self { centre, axes: Vec3::AXES, half: [radius; 3], radius }
    }

    /// The box with edges along these directions around blocks.
    pub(super) fn around(all: &[Self], axes: [Vec3; 3]) -> Self {
        let ends = axes.map(|axis| [Self::end(all, axis), Self::end(all, -axis)]);
        let centre = axes.into_iter().zip(ends).map(|(axis, [high, low])| 0.5 * (high - low) * axis).sum();
        let half = ends.map(|[high, low]| 0.5 * (high + low));
        Self { centre, axes, half, radius: Vec3::from(half).length() }
    }

    /// The coordinate along a unit direction at which the last of these blocks ends.
    pub(super) fn end(all: &[Self], way: Vec3) -> f32 {
        all.iter().map(|block| block.centre.dot(way) + block.reach(way)).fold(f32::NEG_INFINITY, f32::max)
    }

    /// The block in another size.
    pub(super) fn scaled(self, factor: f32) -> Self {
        Self { half: self.half.map(|half| factor * half), radius: factor * self.radius, ..self }
    }

    /// The block moved to another centre.
    pub(super) fn at(self, centre: Vec3) -> Self {
        Self { centre, ..self }
    }

    /// Extent from the centre along a unit direction.
    pub(super) fn reach(&self, way: Vec3) -> f32 {
        let edges = self.axes.iter().zip(self.half);
        edges.map(|(axis, half)| half * axis.dot(way).abs()).sum::<f32>().min(self.radius)
    }

    /// The corners of the box.
    pub(super) fn corners(&self) -> [Vec3; 8] {
        let edges: [Vec3; 3] = std::array::from_fn(|i| self.half[i] * self.axes[i]);
        std::array::from_fn(|n| {
            let side = |i: usize| if (n >> i) & 1 == 0 { -edges[i] } else { edges[i] };
            self.centre + side(0) + side(1) + side(2)
        })
    }

    /// True if a position is inside the sphere.
    pub(super) fn ball_holds(&self, p: Vec3) -> bool {
        p.distance(self.centre) < self.radius
    }

    /// Distance of a position from the block, at least that from the box and that from the sphere; 0 inside.
    pub(super) fn gap(&self, p: Vec3) -> f32 {
        let way = p - self.centre;
        let beyond = |i: usize| (self.axes[i].dot(way).abs() - self.half[i]).max(0.0);
        let from_box = Vec3::new(beyond(0), beyond(1), beyond(2)).length();
        from_box.max(way.length() - self.radius)
    }

    /// True unless a plane separates the blocks: one along faces or edges of the two, or between the centres.
    pub(super) fn touches(&self, other: &Self) -> bool {
        let between = other.centre - self.centre;
        if between.length() >= self.radius + other.radius {
            return false;
        }
        let edges = self.axes.into_iter().flat_map(|a| other.axes.into_iter().map(move |b| a.cross(b)));
        let mut ways = self.axes.into_iter().chain(other.axes).chain([between]).chain(edges);
        !ways.any(|way| {
            way.try_normalize()
                .is_some_and(|way| between.dot(way).abs() >= self.reach(way) + other.reach(way))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_box_around_blocks_ends_where_they_do() {
        let balls = [Block::ball(Vec3::new(1.0, 2.0, 3.0), 0.5), Block::ball(Vec3::new(4.0, 2.5, 3.0), 1.0)];
        let around = Block::around(&balls, Vec3::AXES);
        assert!(around.centre.distance(Vec3::new(2.75, 2.5, 3.0)) < 1e-6, "{around:?}");
        let reaches = Vec3::AXES.map(|axis| around.reach(axis));
        assert!(Vec3::from(reaches).distance(Vec3::new(2.25, 1.0, 1.0)) < 1e-6, "{around:?}");
        assert!((Block::end(&balls, Vec3::NEG_X) + 0.5).abs() < 1e-6);
        assert!((around.scaled(0.5).reach(Vec3::X) - 1.125).abs() < 1e-6);
        let corners = around.corners().map(|corner| (corner - around.centre).abs());
        assert!(corners.iter().all(|c| c.distance(Vec3::new(2.25, 1.0, 1.0)) < 1e-6), "{corners:?}");
    }

    #[test]
    fn blocks_touch_where_the_shapes_do() {
        let registry = Registry::builtin();
        let cube = |position: Vec3, size: f32, turn: f32| {
            let rotation = Vec3::new(0.0, turn, 0.0);
            let cube =
                Object { object_type: "cube".to_owned(), position, size, rotation, ..Object::default() };
            Block::of(&cube, &registry)
        };
        let floor = cube(Vec3::ZERO, 60.0, 0.0);
        // Inside the sphere around the floor, but above the floor.
        assert!(!floor.touches(&cube(Vec3::new(0.0, 30.6, 0.0), 1.0, 30.0)));
        assert!(floor.touches(&cube(Vec3::new(0.0, 30.4, 0.0), 1.0, 30.0)));
        // The gap is that from the box where it ends before the sphere.
        assert!((floor.gap(Vec3::new(5.0, 33.0, -9.0)) - 3.0).abs() < 1e-4);
        assert_eq!(floor.gap(Vec3::new(5.0, 29.0, -9.0)), 0.0);
        assert!(floor.ball_holds(Vec3::new(5.0, 33.0, -9.0)));
        assert!((Block::ball(Vec3::ZERO, 1.0).gap(Vec3::splat(2.0)) - (12f32.sqrt() - 1.0)).abs() < 1e-5);
        let one = cube(Vec3::ZERO, 1.0, 0.0);
        // A corner reaches farther than a face.
        assert!(one.touches(&cube(Vec3::X * 1.15, 1.0, 45.0)));
        assert!(!one.touches(&cube(Vec3::X * 1.15, 1.0, 0.0)));
        assert!((one.reach(Vec3::X) - 0.5).abs() < 1e-6);
    }
}
