//! Compact encoding of meshes: vertices on a fine grid, differences between neighbours, small numbers in one
//! byte. The page calculates normals and tangents from them as the program does (`js/mesh.js`).

use glam::Vec3;

use crate::shape::PolygonMesh;

/// Grid steps from the centre to the farthest coordinate: finer than a thousandth of a pixel.
const STEPS: f32 = 524_288.0;
/// Steps of the components of tangents, which have unit length.
const TANGENT_STEPS: f32 = 2048.0;

/// The numbers of a mesh, which `js/mesh.js` reads.
#[derive(Clone, Debug, PartialEq)]
pub struct Packed {
    /// The number of vertices.
    pub vertices: usize,
    /// The number of polygons.
    pub polygons: usize,
    /// The size of a grid step.
    pub step: f32,
    /// True if each polygon has a tangent.
    pub tangents: bool,
    /// The columns one after the other: x, y and z of the vertices; the number of corners of each polygon;
    /// their first, second, third and fourth corners, each minus the one before; x, y and z of their
    /// tangents.
    pub bytes: Vec<u8>,
}

/// Packs a mesh; only anisotropic models need `tangents`.
#[must_use]
pub fn pack(mesh: &PolygonMesh, tangents: bool) -> Packed {
    let extent = mesh.positions.iter().map(|p| p.abs().max_element()).fold(0.0, f32::max);
    let step = if extent > 0.0 && extent.is_finite() { extent / STEPS } else { 1.0 };
    let mut bytes = Vec::new();
    for axis in 0..3 {
        column(&steps(&mesh.positions, axis, step), &mut bytes);
    }
    column(&mesh.polygons.iter().map(|p| p.corners().len() as i32).collect::<Vec<_>>(), &mut bytes);
    for place in 0..4 {
        let corner = |place: usize, corners: &[u32]| corners.get(place).map_or(0, |i| *i as i32);
        let relative = mesh.polygons.iter().map(|p| match (place, p.corners()) {
            (0, corners) => corner(0, corners),
            (place, corners) if place < corners.len() => corner(place, corners) - corner(place - 1, corners),
            _ => 0,
        });
        column(&relative.collect::<Vec<_>>(), &mut bytes);
    }
    if tangents {
        let all = mesh.polygon_tangents();
        for axis in 0..3 {
            column(&steps(&all, axis, 1.0 / TANGENT_STEPS), &mut bytes);
        }
    }
    Packed { vertices: mesh.positions.len(), polygons: mesh.polygons.len(), step, tangents, bytes }
}

fn steps(vectors: &[Vec3], axis: usize, step: f32) -> Vec<i32> {
    vectors.iter().map(|v| (v[axis] / step).round() as i32).collect()
}

/// Writes a column: the order of its differences, then the differences, in bytes of 7 bits.
fn column(values: &[i32], to: &mut Vec<u8>) {
    /// Maximum order. Surfaces are smooth: differences of differences are smaller, until rounding errors add
    /// up.
    const MOST: usize = 3;
    let mut candidates = vec![values.to_vec()];
    for order in 0..MOST {
        let mut before = 0;
        let next = candidates[order].iter().map(|v| v.wrapping_sub(std::mem::replace(&mut before, *v)));
        candidates.push(next.collect());
    }
    let bits = |values: &Vec<i32>| values.iter().map(|v| 32 - zigzag(*v).leading_zeros()).sum::<u32>();
    let Some((order, best)) = candidates.iter().enumerate().min_by_key(|(_, values)| bits(values)) else {
        return;
    };
    to.push(order as u8);
    for value in best {
        let mut rest = zigzag(*value);
        while rest >= 0x80 {
            to.push(rest as u8 | 0x80);
            rest >>= 7;
        }
        to.push(rest as u8);
    }
}

/// Maps small signed numbers to small unsigned ones: 0, −1, 1, −2 …
fn zigzag(value: i32) -> u32 {
    ((value << 1) ^ (value >> 31)) as u32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::registry::Registry;

    /// The reader, as in `js/mesh.js`.
    fn read(bytes: &[u8], at: &mut usize, count: usize) -> Vec<i32> {
        let order = bytes[*at];
        *at += 1;
        let mut values: Vec<i32> = (0..count)
            .map(|_| {
                let (mut value, mut shift) = (0u32, 0);
                loop {
                    let byte = bytes[*at];
                    *at += 1;
                    value |= u32::from(byte & 0x7f) << shift;
                    shift += 7;
                    if byte < 0x80 {
                        return (value >> 1) as i32 ^ -((value & 1) as i32);
                    }
                }
            })
            .collect();
        for _ in 0..order {
            let mut sum = 0i32;
            for value in &mut values {
                sum = sum.wrapping_add(*value);
                *value = sum;
            }
        }
        values
    }

    #[test]
    fn every_shape_comes_back() {
        for shape in Registry::builtin().shapes() {
            let mesh = shape.mesh(&Default::default(), shape.tessellation(None));
            let packed = pack(&mesh, true);
            let mut at = 0;
            let mut next = |count| read(&packed.bytes, &mut at, count);
            let axes: [_; 3] = std::array::from_fn(|_| next(mesh.positions.len()));
            for (i, p) in mesh.positions.iter().enumerate() {
                let back = Vec3::from(std::array::from_fn(|axis| axes[axis][i] as f32 * packed.step));
                assert!((back - *p).abs().max_element() < 1e-6, "{}", shape.declaration.id);
            }
            let counts = next(mesh.polygons.len());
            let corners: [_; 4] = std::array::from_fn(|_| next(mesh.polygons.len()));
            for (i, polygon) in mesh.polygons.iter().enumerate() {
                let mut here = 0;
                let back: Vec<_> = (0..counts[i] as usize)
                    .map(|place| {
                        here += corners[place][i];
                        here as u32
                    })
                    .collect();
                assert_eq!(back, polygon.corners());
            }
            next(3 * mesh.polygons.len());
        }
    }

    #[test]
    fn smooth_shapes_are_small() {
        let registry = Registry::builtin();
        let sphere = registry.shape("sphere").expect("built in");
        let mesh = sphere.mesh(&Default::default(), 96);
        let packed = pack(&mesh, false);
        assert!(packed.bytes.len() < 12 * mesh.positions.len(), "{}", packed.bytes.len());
    }
}
