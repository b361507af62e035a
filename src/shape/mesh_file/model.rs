//! A model as in a file: polygons with any number of corners, converted to the numbers for
//! [`MeshFile`](super::MeshFile).

use std::collections::HashMap;

use bevy_platform::hash::RandomState;
use glam::{DVec3, Vec2, Vec3};

use super::polygon::{doubled_area, pieces};
use crate::shape::mesh::{Polygon, PolygonMesh};

/// Maximum number of polygons of a model; polygons with more than four corners are cut into triangles.
pub const MAX_POLYGONS: usize = 500_000;
/// Maximum number of vertices in a file.
pub const MAX_VERTICES: usize = 4 * MAX_POLYGONS;
/// Maximum number of corners of a polygon.
pub const MAX_CORNERS: usize = 128;

/// A corner of a polygon.
#[derive(Clone, Copy, Debug, Default)]
pub struct Corner {
    /// The position; 64 bits, because files may have their origin far away, such as those of maps.
    pub position: DVec3,
    /// Surface normal, of any length, if the file has one.
    pub normal: Option<Vec3>,
    /// Texture coordinates, if the file has them.
    pub texture: Option<Vec2>,
}

/// The polygons of a file, one after the other.
#[derive(Default)]
pub struct Builder {
    positions: Pool,
    normals: Pool,
    polygons: Vec<Read>,
    corners: Vec<[u32; 2]>,
    /// Number of polygons that will be drawn, or would be if that were allowed.
    drawn: usize,
    /// The first list of 32-bit positions that is too far from the origin for its extent: its distance and its extent.
    coarse: Option<[f32; 2]>,
    /// True if another list is not.
    is_fine: bool,
}

/// A polygon that was read: the end of its corners, and the direction of increasing texture coordinates.
struct Read {
    end: usize,
    brushed: Vec3,
}

/// Unique vectors.
#[derive(Default)]
struct Pool {
    all: Vec<DVec3>,
    known: HashMap<[u64; 3], u32, RandomState>,
}

impl Pool {
    fn index(&mut self, v: DVec3) -> u32 {
        // Adding 0 gives −0 and 0 the same bits.
        let key = (v + DVec3::ZERO).to_array().map(f64::to_bits);
        *self.known.entry(key).or_insert_with(|| {
            self.all.push(v);
            self.all.len() as u32 - 1
        })
    }
}

/// Smallest extent as a fraction of the distance from the origin: 256 steps of 32-bit floats.
const COARSEST: f32 = 1.0 / 65536.0;
/// Index that stands for a corner without a normal.
const NONE: u32 = u32::MAX;
/// Number of values per polygon: the number of its corners, four positions, four normals, and a direction.
const STRIDE: usize = 12;

impl Builder {
    /// Adds a polygon whose corners run counter-clockwise seen from outside.
    ///
    /// # Errors
    /// Returns an error if a corner is not finite, or if there are too many corners.
    pub fn polygon(&mut self, corners: &[Corner]) -> Result<(), String> {
        let nth = self.polygons.len() + 1;
        if corners.len() > MAX_CORNERS {
            let n = corners.len();
            return Err(format!("polygon {nth} has {n} corners; at most {MAX_CORNERS} are read"));
        }
        if let Some(nowhere) = corners.iter().map(|c| c.position.as_vec3()).find(|p| !p.is_finite()) {
            let [x, y, z] = nowhere.to_array();
            return Err(format!(
                "a corner of polygon {nth} is at ({x}, {y}, {z}), but positions must be finite"
            ));
        }
        let begin = self.corners.len();
        for corner in corners {
            let position = self.positions.index(corner.position);
            let unit =
                corner.normal.map(Vec3::normalize_or_zero).filter(|n| *n != Vec3::ZERO && n.is_finite());
            // A repeated vertex counts once.
            if self.corners[begin..].last().is_none_or(|[before, _]| *before != position) {
                self.corners.push([position, unit.map_or(NONE, |n| self.normals.index(n.as_dvec3()))]);
            }
        }
        let own = &self.corners[begin..];
        if own.len() > 1 && own[0][0] == own[own.len() - 1][0] {
            self.corners.pop();
        }
        match self.corners.len() - begin {
            0..3 => {
                self.corners.truncate(begin);
                return Ok(());
            }
            3 | 4 => self.drawn += 1,
            n => self.drawn += n - 2,
        }
        // Counted to the end, for the message.
        if self.drawn > MAX_POLYGONS {
            self.corners.truncate(begin);
            return Ok(());
        }
        self.polygons.push(Read { end: self.corners.len(), brushed: texture_direction(corners) });
        Ok(())
    }

    /// Notes positions that belong together and that the file has as 32-bit floats: far from the origin nothing is left of
    /// their shape.
    pub fn note(&mut self, positions: impl Iterator<Item = Vec3>) {
        let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        for position in positions {
            (low, high) = (low.min(position), high.max(position));
        }
        let (distance, extent) = (low.abs().max(high.abs()).max_element(), (high - low).max_element());
        if extent > 0.0 && extent < distance * COARSEST {
            self.coarse.get_or_insert([distance, extent]);
        } else {
            self.is_fine = true;
        }
    }

    /// True if there are no polygons.
    pub fn is_empty(&self) -> bool {
        self.polygons.is_empty()
    }

    /// The numbers for [`Model`]: vertices scaled so that the largest extent is 1, around the origin.
    /// Polygons without area are dropped.
    ///
    /// # Errors
    /// Returns an error if there are no polygons or too many, or if all positions are too coarse.
    pub fn numbers(self) -> Result<Vec<f32>, String> {
        let Self { positions, normals, polygons, corners, drawn, coarse, is_fine } = self;
        if drawn > MAX_POLYGONS {
            return Err(format!(
                "it has {drawn} polygons, counting the triangles of those with five corners and more; at most {MAX_POLYGONS} \
                 are allowed"
            ));
        }
        if let Some([distance, extent]) = coarse.filter(|_| !is_fine) {
            return Err(format!(
                "it has an extent of {extent} at {distance} from its origin, where its 32-bit floats are too coarse; move it \
                 to the origin before you export it, or save it as OBJ"
            ));
        }
        let mut faces: Vec<(&[[u32; 2]], Vec3)> = Vec::with_capacity(polygons.len());
        let mut begin = 0;
        for Read { end, brushed } in &polygons {
            faces.push((&corners[begin..*end], *brushed));
            begin = *end;
        }
        // Dropped polygons may have been the outermost; twice is enough except for models that consist of
        // them.
        let (mut unit, mut room) = (Vec::new(), Vec::new());
        for _ in 0..3 {
            let (middle, extent) = bounds(&faces, &positions.all);
            let scaled = |p: &DVec3| ((*p - middle) / extent).as_vec3();
            unit = positions.all.iter().map(scaled).collect();
            let before = faces.len();
            faces.retain(|(face, _)| doubled_area(at(face, &unit, &mut room)) > 0.0);
            if faces.len() == before {
                break;
            }
        }
        if faces.is_empty() {
            let mut begin = 0;
            let crossed = polygons.iter().any(|Read { end, .. }| {
                let face = &corners[std::mem::replace(&mut begin, *end)..*end];
                crosses(face, &positions.all)
            });
            let hint = if crossed { "; those that cross themselves, like a bow tie, have none" } else { "" };
            return Err(format!("it has no polygons with an area{hint}"));
        }
        let normals: Vec<_> = normals.all.iter().map(|n| n.as_vec3()).collect();
        Ok(written(&faces, &unit, &normals))
    }
}

/// True if a polygon without area is no line: its parts on both sides of a crossing cancel each other.
fn crosses(face: &[[u32; 2]], positions: &[DVec3]) -> bool {
    let place = |corner: &[u32; 2]| positions[corner[0] as usize];
    let [first, rest @ ..] = face else { return false };
    let from_first: Vec<_> =
        rest.iter().map(|corner| (place(corner) - place(first)).normalize_or_zero()).collect();
    from_first.len() > 2 && from_first.windows(2).any(|pair| pair[0].cross(pair[1]).length() > 1e-6)
}

/// The positions of corners, stored in `room`.
fn at<'r>(face: &[[u32; 2]], positions: &[Vec3], room: &'r mut Vec<Vec3>) -> &'r [Vec3] {
    room.clear();
    room.extend(face.iter().map(|[p, _]| positions[*p as usize]));
    room
}

/// The centre and the largest extent of some polygons.
fn bounds(faces: &[(&[[u32; 2]], Vec3)], positions: &[DVec3]) -> (DVec3, f64) {
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for [p, _] in faces.iter().flat_map(|(face, _)| *face) {
        let p = positions[*p as usize];
        (low, high) = (low.min(p), high.max(p));
    }
    ((low + high) * 0.5, (high - low).max_element())
}

/// The numbers: counts of positions, normals and polygons, then these. Only what polygons use is kept, and positions
/// that 32-bit floats do not tell apart are one.
fn written(faces: &[(&[[u32; 2]], Vec3)], positions: &[Vec3], normals: &[Vec3]) -> Vec<f32> {
    /// The used vectors, each with its new index.
    struct Used<'a> {
        all: &'a [Vec3],
        places: Vec<u32>,
        kept: Pool,
    }
    impl<'a> Used<'a> {
        fn of(all: &'a [Vec3]) -> Self {
            Self { all, places: vec![NONE; all.len()], kept: Pool::default() }
        }
        fn place(&mut self, i: u32) -> f32 {
            let Some(place) = self.places.get_mut(i as usize) else { return -1.0 };
            if *place == NONE {
                *place = self.kept.index(self.all[i as usize].as_dvec3());
            }
            *place as f32
        }
    }
    let (mut used, mut used_normals) = (Used::of(positions), Used::of(normals));
    let mut polygons = Vec::with_capacity(STRIDE * faces.len());
    let (mut face, mut corners) = (Vec::new(), Vec::new());
    for (read, brushed) in faces {
        let place = |corner: &[u32; 2]| positions[corner[0] as usize];
        face.clear();
        face.extend_from_slice(read);
        face.dedup_by(|next, before| place(next) == place(before));
        face.pop_if(|last| place(last) == place(&read[0]));
        pieces(at(&face, positions, &mut corners), |piece| {
            polygons.push(piece.len() as f32);
            let corner = |k: usize| face[piece[k.min(piece.len() - 1)]];
            polygons.extend((0..4).map(|k| used.place(corner(k)[0])));
            polygons.extend((0..4).map(|k| used_normals.place(corner(k)[1])));
            polygons.extend(brushed.to_array());
        });
    }
    let counts =
        [used.kept.all.len(), used_normals.kept.all.len(), polygons.len() / STRIDE].map(|n| n as f32);
    let vectors = used.kept.all.iter().chain(&used_normals.kept.all).flat_map(|v| v.as_vec3().to_array());
    counts.into_iter().chain(vectors).chain(polygons).collect()
}

/// The direction in which the first texture coordinate grows along a polygon; zero without texture coordinates.
fn texture_direction(corners: &[Corner]) -> Vec3 {
    let mut sum = DVec3::ZERO;
    let fan = corners.iter().skip(1).zip(corners.iter().skip(2));
    for (b, c) in fan {
        let a = &corners[0];
        let (Some(u), Some(v), Some(w)) = (a.texture, b.texture, c.texture) else { return Vec3::ZERO };
        let (along, across) = (b.position - a.position, c.position - a.position);
        let (s, t) = ((v - u).as_dvec2(), (w - u).as_dvec2());
        let area = s.perp_dot(t);
        // The gradient of u in the plane of the triangle is this over the area.
        let direction = (along * t.y - across * s.y) * area.signum();
        sum += direction.normalize_or_zero();
    }
    if sum.is_finite() { sum.normalize_or_zero().as_vec3() } else { Vec3::ZERO }
}

/// The numbers of a file in use.
#[derive(Clone, Copy, Debug)]
pub struct Model<'a> {
    positions: &'a [[f32; 3]],
    normals: &'a [[f32; 3]],
    polygons: &'a [[f32; STRIDE]],
}

impl<'a> Model<'a> {
    /// The model in the numbers of a file; `None` if they are invalid.
    #[must_use]
    pub fn new(numbers: &'a [f32]) -> Option<Self> {
        let [positions, normals, polygons, rest @ ..] = numbers else { return None };
        let (positions, rest) = rest.split_at_checked((*positions as usize).checked_mul(3)?)?;
        let (normals, rest) = rest.split_at_checked((*normals as usize).checked_mul(3)?)?;
        let model = Self {
            positions: positions.as_chunks().0,
            normals: normals.as_chunks().0,
            polygons: rest.as_chunks().0,
        };
        let whole = rest.len() == model.polygons.len() * STRIDE && model.polygons.len() == *polygons as usize;
        let within = |i: &f32| (*i as usize) < model.positions.len();
        (whole && model.polygons.iter().all(|polygon| polygon[1..5].iter().all(within))).then_some(model)
    }

    /// The mesh: each point of the surface once or, with the normals of the file, once for each normal.
    #[must_use]
    pub fn mesh(&self, own_normals: bool) -> PolygonMesh {
        let mut mesh = PolygonMesh::default();
        if !own_normals {
            mesh.positions = self.positions.iter().map(|p| Vec3::from_array(*p)).collect();
        }
        let mut places: HashMap<[i32; 2], u32, RandomState> = HashMap::default();
        for polygon in self.polygons {
            let [count, a, b, c, d, normals @ .., x, y, z] = *polygon;
            let normals = normals.map(|i| i as i32);
            let mut vertex = |position: f32, normal: i32| {
                if !own_normals {
                    return position as u32;
                }
                *places.entry([position as i32, normal]).or_insert_with(|| {
                    mesh.positions.push(vector(self.positions, position as i32));
                    mesh.positions.len() as u32 - 1
                })
            };
            let [a, b, c] = [(a, normals[0]), (b, normals[1]), (c, normals[2])].map(|(p, n)| vertex(p, n));
            let polygon = match count as usize {
                4 => Polygon::quad(a, b, c, vertex(d, normals[3])),
                _ => Polygon::triangle(a, b, c),
            };
            let polygon = polygon.brushed(Vec3::new(x, y, z));
            let own = || polygon.with_normals(normals.map(|i| vector(self.normals, i)));
            mesh.polygons.push(if own_normals { own() } else { polygon });
        }
        mesh
    }
}

/// One of several vectors; zero if the index is invalid.
fn vector(of: &[[f32; 3]], index: i32) -> Vec3 {
    usize::try_from(index).ok().and_then(|i| of.get(i)).map_or(Vec3::ZERO, |v| Vec3::from_array(*v))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A polygon through these points.
    fn add(builder: &mut Builder, points: &[[f32; 3]]) -> Result<(), String> {
        let corner = |p: &[f32; 3]| Corner { position: Vec3::from_array(*p).as_dvec3(), ..Corner::default() };
        builder.polygon(&points.iter().map(corner).collect::<Vec<_>>())
    }

    fn mesh(builder: Builder, own_normals: bool) -> PolygonMesh {
        Model::new(&builder.numbers().expect("polygons")).expect("a model").mesh(own_normals)
    }

    #[test]
    fn the_largest_extent_becomes_one_around_the_origin_whatever_the_scale() {
        for scale in [1.0, 1e-30, 1e30, 3e38] {
            let mut builder = Builder::default();
            let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.5, 0.0], [0.0, 0.5, 0.0]];
            add(&mut builder, &corners.map(|p| p.map(|c| (c - 0.5) * scale))).expect("legal");
            let mesh = mesh(builder, false);
            let expected = [[-0.5, -0.25], [0.5, -0.25], [0.5, 0.25], [-0.5, 0.25]];
            for (p, [x, y]) in mesh.positions.iter().zip(expected) {
                assert!((*p - Vec3::new(x, y, 0.0)).length() < 1e-6, "{scale}: {p}");
            }
            assert_eq!(mesh.polygon_normals(), [Vec3::Z]);
        }
    }

    #[test]
    fn what_has_no_area_is_left_out_and_does_not_count_for_the_size() {
        let mut builder = Builder::default();
        add(&mut builder, &[[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]]).expect("legal");
        add(&mut builder, &[[0.0, 0.0, 0.0], [50.0, 0.0, 0.0], [99.0, 0.0, 0.0]]).expect("a line");
        add(&mut builder, &[[7.0, 0.0, 0.0], [7.0, 0.0, 0.0], [7.0, 9.0, 0.0]]).expect("two points");
        add(&mut builder, &[]).expect("nothing");
        let mesh = mesh(builder, false);
        assert_eq!((mesh.positions.len(), mesh.polygons.len()), (3, 1));
        assert_eq!(mesh.positions[1], Vec3::new(0.5, -0.5, 0.0));
        let mut nothing = Builder::default();
        add(&mut nothing, &[[0.0; 3], [1.0; 3], [2.0; 3]]).expect("a line");
        assert_eq!(nothing.numbers(), Err("it has no polygons with an area".to_owned()));
        let mut bow = Builder::default();
        add(&mut bow, &[[0.0; 3], [1.0; 3], [2.0; 3]]).expect("a line");
        add(&mut bow, &[[0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
            .expect("a bow tie");
        let said = bow.numbers().expect_err("no area");
        assert!(said.ends_with("; those that cross themselves, like a bow tie, have none"), "{said}");
    }

    #[test]
    fn corners_that_are_nowhere_and_too_many_are_refused() {
        let said = |points: &[[f32; 3]]| add(&mut Builder::default(), points).expect_err("refused");
        for nowhere in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            let said = said(&[[0.0; 3], [1.0; 3], [nowhere, 0.0, 0.0]]);
            assert!(
                said.starts_with("a corner of polygon 1 is at (") && said.ends_with("must be finite"),
                "{said}"
            );
        }
        assert_eq!(said(&[[0.0; 3]; 129]), "polygon 1 has 129 corners; at most 128 are read");
        let mut many = Builder { drawn: MAX_POLYGONS - 2, ..Builder::default() };
        add(&mut many, &[[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 2.0, 0.0], [0.0, 2.0, 0.0]]).expect("one");
        let five = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 2.0, 0.0], [1.0, 3.0, 0.0], [0.0, 2.0, 0.0]];
        add(&mut many, &five).expect("three triangles");
        add(&mut many, &five).expect("three more");
        let full = many.numbers().expect_err("too many");
        assert!(
            full.starts_with("it has 500005 polygons, ") && full.ends_with("at most 500000 are allowed"),
            "{full}"
        );
    }

    /// Two triangles that meet at a right angle, with normals of each at both ends of the edge.
    #[test]
    fn points_are_shared_unless_the_normals_of_the_file_differ() {
        let build = || {
            let mut builder = Builder::default();
            for (normal, tip) in [(Vec3::Z, Vec3::Y), (Vec3::NEG_Y * 7.0, Vec3::Z)] {
                let tip = if normal.z > 0.0 { tip } else { -tip };
                let corner = |p: Vec3| Corner { position: p.as_dvec3(), normal: Some(normal), texture: None };
                builder.polygon(&[corner(Vec3::ZERO), corner(Vec3::X), corner(tip)]).expect("legal");
            }
            builder
        };
        let computed = mesh(build(), false);
        assert_eq!(computed.positions.len(), 4);
        // The mean of both polygons.
        let mean = (computed.polygon_normals()[0] + computed.polygon_normals()[1]).normalize();
        assert!((computed.vertex_normals()[0] - mean).length() < 1e-6);
        let own = mesh(build(), true);
        assert_eq!(own.positions.len(), 6);
        assert_eq!(own.vertex_normals()[..3], [Vec3::Z; 3]);
        assert_eq!(own.vertex_normals()[3..], [Vec3::NEG_Y; 3]);
    }

    #[test]
    fn positions_of_32_bits_far_from_the_origin_are_refused() {
        let refused = |lists: &[&[Vec3]]| {
            let mut builder = Builder::default();
            add(&mut builder, &[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]).expect("legal");
            lists.iter().for_each(|list| builder.note(list.iter().copied()));
            builder.numbers().err()
        };
        let at = |x: f32| [Vec3::X * x, Vec3::X * x + Vec3::ONE];
        let said = refused(&[&at(4.6e6)]).expect("an error");
        assert!(said.starts_with("it has an extent of 1 at 4600001 from its origin, where"), "{said}");
        // Small parts of a large model may be coarse.
        let (far, near, not_far, point) = (at(4.6e6), at(0.0), at(6e4), [Vec3::ONE * 1e9; 2]);
        assert_eq!(refused(&[&far, &near]), None);
        for fine in [&near[..], &not_far, &point, &[]] {
            assert_eq!(refused(&[fine]), None, "{fine:?}");
        }
        assert_eq!(refused(&[]), None);
    }

    #[test]
    fn points_that_the_mesh_cannot_tell_apart_are_one() {
        let mut builder = Builder::default();
        let corner = |p: DVec3| Corner { position: p, ..Corner::default() };
        let off = DVec3::splat(1e-12);
        builder.polygon(&[DVec3::ZERO, DVec3::X, DVec3::ONE].map(corner)).expect("legal");
        builder.polygon(&[off, DVec3::ONE - off, DVec3::Y, DVec3::Y + off].map(corner)).expect("legal");
        let mesh = mesh(builder, false);
        assert_eq!((mesh.positions.len(), mesh.polygons.len()), (4, 2));
        assert_eq!(mesh.polygons[1].corners(), [0, 2, 3]);
    }

    #[test]
    fn normals_that_are_none_give_way_to_those_of_the_polygons() {
        let mut builder = Builder::default();
        let corner = |p: Vec3, normal| Corner { position: p.as_dvec3(), normal: Some(normal), texture: None };
        let corners = [
            corner(Vec3::ZERO, Vec3::ZERO),
            corner(Vec3::X, Vec3::NAN),
            corner(Vec3::Y, Vec3::new(0.0, 3.0, 4.0)),
        ];
        builder.polygon(&corners).expect("legal");
        let normals = mesh(builder, true).vertex_normals();
        assert_eq!(normals, [Vec3::Z, Vec3::Z, Vec3::new(0.0, 0.6, 0.8)]);
    }

    #[test]
    fn a_polygon_is_brushed_where_its_first_texture_coordinate_grows() {
        let brushed = |textures: [[f32; 2]; 3]| {
            let mut builder = Builder::default();
            let positions = [Vec3::ZERO, Vec3::X * 3.0, Vec3::Y * 2.0];
            let corner = |(position, texture): (Vec3, [f32; 2])| Corner {
                position: position.as_dvec3(),
                normal: None,
                texture: Some(texture.into()),
            };
            let corners: Vec<_> = positions.into_iter().zip(textures).map(corner).collect();
            builder.polygon(&corners).expect("legal");
            mesh(builder, false).polygon_tangents()[0]
        };
        assert!((brushed([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]) - Vec3::X).length() < 1e-6);
        assert!((brushed([[0.0, 0.0], [0.0, 1.0], [1.0, 0.0]]) - Vec3::Y).length() < 1e-6);
        assert!(
            (brushed([[1.0, 0.0], [0.0, 0.0], [1.0, 1.0]]) + Vec3::X).length() < 1e-6,
            "it shrinks along x"
        );
        // Without a direction it is brushed horizontally.
        let horizontal = Vec3::Y.cross(Vec3::Z);
        for nowhere in [[[0.5, 0.5]; 3], [[f32::NAN, 0.0], [1.0, 0.0], [0.0, 1.0]]] {
            assert!((brushed(nowhere) - horizontal).length() < 1e-6, "{nowhere:?}");
        }
    }

    #[test]
    fn numbers_of_other_origin_are_no_model() {
        for wrong in [&[][..], &[1.0], &[1.0, 0.0, 0.0], &[0.0, 0.0, 1.0, 3.0], &[f32::NAN, -1.0, 1e30]] {
            assert!(Model::new(wrong).is_none(), "{wrong:?}");
        }
        let stray =
            [1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 3.0, 0.0, 9.0, -7.0, 0.0, 5.0, 5.0, 5.0, 5.0, 0.0, 0.0, 0.0];
        assert!(Model::new(&stray).is_none(), "its corners are beyond its positions");
    }
}
