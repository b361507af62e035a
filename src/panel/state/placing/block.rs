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

    /// The block moved to another centre.
    pub(super) fn at(self, centre: Vec3) -> Self {
        Self { centre, ..self }
    }

    /// Extent from the centre along a unit direction.
    pub(super) fn reach(&self, way: Vec3) -> f32 {
        let edges = self.axes.iter().zip(self.half);
        edges.map(|(axis, half)| half * axis.dot(way).abs()).sum::<f32>().min(self.radius)
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
        let one = cube(Vec3::ZERO, 1.0, 0.0);
        // A corner reaches farther than a face.
        assert!(one.touches(&cube(Vec3::X * 1.15, 1.0, 45.0)));
        assert!(!one.touches(&cube(Vec3::X * 1.15, 1.0, 0.0)));
        assert!((one.reach(Vec3::X) - 0.5).abs() < 1e-6);
    }
}
