//! Light within a smooth solid: a ray of view goes in, is reflected inside, and at each boundary a part leaves.
//!
//! One chain: at each inner hit the ray leaves with the part that the boundary transmits (A. Fresnel 1823), and the
//! rest goes on. On the way, light is absorbed (A. Beer 1852). Directions follow the normals of the [shading](Normals),
//! so that a coarse mesh looks round; the sides are those of the triangles. A boundary at which both disagree, so that
//! a ray refracted outwards would point inwards, or a reflected one outwards, has the normal of the triangle. So no
//! light is lost: the parts that leave, that are absorbed and that [remain](follow) add up to the light that entered.
//!
//! Radiance that enters and leaves again is scaled twice, by η² and by 1/η²; so the parts are of radiance in the room.

use glam::{Mat3, Vec3};

use crate::{
    optics::{
        fresnel::dielectric,
        geometry::mirror,
        interior::Interior,
        refraction::{refracted, refracting_reflectance},
    },
    shape::{
        Hierarchy,
        hierarchy::{Hit, Ray, Sides},
    },
};

/// Maximum number of boundaries that a ray meets from inside.
pub const ORDERS: usize = 16;
/// The part of the light in the chain that is not followed any further; it counts as remaining.
const LEAST: f32 = 1e-7;
/// Distance in units of the mesh by which a ray may begin beyond a boundary, by rounding.
pub(super) const BEHIND: f32 = 1e-5;

/// The normals by which light is refracted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Normals {
    /// The means of the vertices' normals, as shading per vertex and per pixel has them.
    Vertices,
    /// Those of the polygons, as flat shading has them.
    Polygons,
}

/// A solid in its place in the room.
#[derive(Clone, Copy, Debug)]
pub struct Solid<'a> {
    /// The triangles of the solid.
    pub hierarchy: &'a Hierarchy,
    /// The normals of its boundary.
    pub normals: Normals,
    /// The rotation of the solid.
    pub rotation: Mat3,
    /// The size of the solid, metres.
    pub size: f32,
    /// The position of the solid, metres.
    pub position: Vec3,
}

impl Solid<'_> {
    /// A point of the mesh in the room.
    fn room(&self, p: Vec3) -> Vec3 {
        self.rotation * (self.size * p) + self.position
    }

    /// A point of the room in the mesh.
    fn local(&self, p: Vec3) -> Vec3 {
        self.rotation.transpose() * (p - self.position) / self.size
    }

    /// A ray of the room, in the mesh.
    pub(super) fn ray(&self, origin: Vec3, direction: Vec3) -> Ray {
        Ray {
            origin: self.local(origin),
            direction: (self.rotation.transpose() * direction).normalize_or_zero(),
        }
    }

    /// The point of a hit, and its outer normals of the shading and of the triangle, in the room.
    pub(super) fn boundary(&self, hit: &Hit) -> (Vec3, [Vec3; 2]) {
        let position = self.room(self.hierarchy.point(hit.triangle, hit.weights));
        (position, self.normals(hit).map(|normal| self.rotation * normal))
    }

    /// The outer normals at a hit, in the mesh: of the shading, and of the triangle.
    fn normals(&self, hit: &Hit) -> [Vec3; 2] {
        let flat = self.hierarchy.triangle_normal(hit.triangle);
        let shading = match self.normals {
            Normals::Vertices => self.hierarchy.vertex_normal(hit.triangle, hit.weights),
            Normals::Polygons => self.hierarchy.polygon_normal(hit.triangle),
        };
        [shading, flat]
    }
}

/// The intersection of a ray of view with a solid from outside, in the room.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Entry {
    /// The point.
    pub position: Vec3,
    /// Unit vector to the viewer.
    pub view: Vec3,
    /// The normal of the shading.
    pub normal: Vec3,
    /// The normal of the polygon, on whose inner side the ray goes on. Renderers shade with one normal, and pass it for
    /// both.
    pub face_normal: Vec3,
}

impl Entry {
    /// The direction of the ray inside, and the part of the light that enters; `None` where everything is reflected.
    fn inwards(&self, eta: f32) -> Option<(Vec3, f32)> {
        let Self { view, normal, face_normal, .. } = *self;
        let inner = |d: &Vec3| d.dot(face_normal) < 0.0;
        let direction = Some(refracted(view, normal, eta)?)
            .filter(inner)
            .or_else(|| refracted(view, face_normal, eta))
            // Into a thinner body, where the face alone would reflect everything.
            .unwrap_or(-view);
        let share = 1.0 - dielectric(eta, view.dot(normal));
        (share > 0.0).then_some((direction, share))
    }
}

/// The split of a ray at a boundary that it meets from inside.
struct Boundary {
    /// The direction of the refracted ray; `None` for total reflection.
    out: Option<Vec3>,
    /// The part that is reflected.
    reflectance: f32,
    reflected: Vec3,
    /// The cosine of the angle at which it meets the boundary.
    cosine: f32,
}

impl Boundary {
    /// A boundary with an outer normal; η is the refractive index inside.
    fn new(direction: Vec3, outer: Vec3, eta: f32) -> Self {
        let out = refracted(-direction, -outer, 1.0 / eta);
        let reflectance =
            out.map_or(1.0, |out| refracting_reflectance(out.dot(outer), direction.dot(outer), 1.0 / eta));
        Self { out, reflectance, reflected: -mirror(direction, outer), cosine: direction.dot(outer) }
    }

    /// The boundary by the normal of the shading, unless that leads to the wrong side.
    fn of([shading, flat]: [Vec3; 2], direction: Vec3, eta: f32) -> Self {
        let boundary = Self::new(direction, shading, eta);
        let leaves = boundary.out.is_none_or(|out| out.dot(flat) > 0.0);
        if direction.dot(shading) > 0.0 && boundary.reflected.dot(flat) < 0.0 && leaves {
            boundary
        } else {
            Self::new(direction, flat, eta)
        }
    }
}

/// Follows a ray of view through a smooth solid. Calls `leave` for each part that leaves: with the point, the direction, and
/// the part of the radiance from there that reaches the viewer; all in the room. Returns the part that remains
/// inside: after [`ORDERS`] boundaries, where hardly anything is left, or, by rounding, where the mesh has no way out.
/// A ray that only touches the rim goes straight on.
///
/// Light that the solid reflects outside, before the ray enters, is not included. Nor is the dispersion of the
/// interior: [`Interior::at`] has the body for one wavelength.
#[must_use]
pub fn follow(
    solid: &Solid,
    interior: &Interior,
    entry: &Entry,
    mut leave: impl FnMut(Vec3, Vec3, Vec3),
) -> Vec3 {
    trace(solid, interior, entry, |met| {
        if let Some(out) = met.boundary.out {
            let through = met.part * (1.0 - met.boundary.reflectance);
            leave(solid.room(met.origin), solid.rotation * out, through);
        }
    })
}

/// A boundary that a ray meets from inside, for explanations; in the room.
#[derive(Clone, Debug, PartialEq)]
pub struct Turn {
    /// The point.
    pub position: Vec3,
    /// The way to it from the boundary before, metres.
    pub length: f32,
    /// The cosine of the angle at which the ray meets it.
    pub cosine: f32,
    /// The part of the light that is reflected: 1 for total reflection.
    pub reflectance: f32,
    /// The direction in which a part leaves, and that part; `None` for total reflection.
    pub leaves: Option<(Vec3, Vec3)>,
}

/// The boundaries that a ray of view meets within a smooth solid, and the part that [remains](follow).
#[must_use]
pub fn turns(solid: &Solid, interior: &Interior, entry: &Entry) -> (Vec<Turn>, Vec3) {
    let mut turns = Vec::new();
    let remaining = trace(solid, interior, entry, |met| {
        let Boundary { out, reflectance, cosine, .. } = met.boundary;
        let leaves = out.map(|out| (solid.rotation * out, met.part * (1.0 - reflectance)));
        turns.push(Turn {
            position: solid.room(met.origin),
            length: met.length,
            cosine,
            reflectance,
            leaves,
        });
    });
    (turns, remaining)
}

/// A boundary that a ray meets from inside, in the mesh.
struct Met {
    origin: Vec3,
    boundary: Boundary,
    /// The part of the light that arrives.
    part: Vec3,
    /// The way from the boundary before, metres.
    length: f32,
}

impl Met {
    /// The boundary of a ray that only touches the rim of a solid, past which the shading normal leads it: it goes
    /// straight on.
    fn beside(origin: Vec3, direction: Vec3, part: Vec3) -> Self {
        let boundary =
            Boundary { out: Some(direction), reflectance: 0.0, reflected: Vec3::ZERO, cosine: 0.0 };
        Self { origin, boundary, part, length: 0.0 }
    }
}

#[inline]
fn trace(solid: &Solid, interior: &Interior, entry: &Entry, mut meet: impl FnMut(&Met)) -> Vec3 {
    let eta = interior.eta();
    let Some((direction, share)) = entry.inwards(eta) else { return Vec3::ZERO };
    let mut part = Vec3::splat(share);
    let mut ray = Ray {
        origin: solid.local(entry.position),
        direction: (solid.rotation.transpose() * direction).normalize_or_zero(),
    };
    for order in 0..ORDERS {
        let Some(hit) = solid.hierarchy.nearest(&ray, -BEHIND..f32::MAX, Sides::Inside) else {
            if order == 0 {
                meet(&Met::beside(ray.origin, solid.rotation.transpose() * -entry.view, part));
                return Vec3::ZERO;
            }
            break;
        };
        let length = solid.size * hit.distance;
        part *= interior.left(length);
        let boundary = Boundary::of(solid.normals(&hit), ray.direction, eta);
        let met = Met { origin: solid.hierarchy.point(hit.triangle, hit.weights), boundary, part, length };
        meet(&met);
        let Boundary { reflectance, reflected, .. } = met.boundary;
        part *= reflectance;
        if part.max_element() < LEAST {
            break;
        }
        ray = Ray { origin: met.origin, direction: reflected.normalize_or_zero() };
    }
    part
}

#[cfg(test)]
mod tests {
    use glam::Quat;

    use super::*;
    use crate::{
        shape::{Cube, ObjectType as _, PolygonMesh, Sphere, Torus},
        testing::{direction, random},
    };

    /// A body of glass that absorbs nothing.
    const GLASS: Interior = Interior { ior: 1.5, cauchy_b: 0.0, alpha: 0.0, absorption: Vec3::ZERO };

    /// A solid of size 1 at the origin.
    fn solid(hierarchy: &Hierarchy, normals: Normals) -> Solid<'_> {
        Solid { hierarchy, normals, rotation: Mat3::IDENTITY, size: 1.0, position: Vec3::ZERO }
    }

    /// The intersection of a ray from outside with a solid.
    fn meet(solid: &Solid, origin: Vec3, direction: Vec3) -> Option<Entry> {
        let turned = solid.rotation.transpose() * direction;
        let ray = Ray { origin: solid.local(origin), direction: turned };
        let hit = solid.hierarchy.nearest(&ray, 0.0..f32::MAX, Sides::Both).filter(|hit| !hit.leaves)?;
        let [normal, face_normal] = solid.normals(&hit).map(|n| solid.rotation * n);
        let position = solid.room(solid.hierarchy.point(hit.triangle, hit.weights));
        Some(Entry { position, view: -direction, normal, face_normal })
    }

    /// The points, directions and parts that leave, and the part that remains.
    fn parts(solid: &Solid, interior: &Interior, entry: &Entry) -> (Vec<(Vec3, Vec3, Vec3)>, Vec3) {
        let mut parts = Vec::new();
        let remains = follow(solid, interior, entry, |p, d, part| parts.push((p, d, part)));
        (parts, remains)
    }

    fn of(mesh: PolygonMesh) -> Hierarchy {
        Hierarchy::new(&mesh)
    }

    #[test]
    fn a_lossless_solid_in_uniform_light_is_invisible() {
        let mut seed = 3;
        let meshes = [Sphere {}.mesh(24), Cube {}.mesh(2), Torus::default().mesh(16), Sphere {}.mesh(3)];
        for hierarchy in meshes.map(of) {
            for normals in [Normals::Vertices, Normals::Polygons] {
                let solid = solid(&hierarchy, normals);
                let (mut rays, mut trapped) = (0, 0.0);
                for _ in 0..300 {
                    let d = direction(&mut seed) * if random(&mut seed) < 0.5 { 1.0 } else { -1.0 };
                    let aim = 0.6 * Vec3::from([(); 3].map(|()| random(&mut seed) - 0.5));
                    let Some(entry) = meet(&solid, aim - 3.0 * d, d) else { continue };
                    for ior in [1.0, 1.0 + 1e-3, 1.1, 1.5, 2.4, 0.8] {
                        let (parts, remains) = parts(&solid, &Interior { ior, ..GLASS }, &entry);
                        let out: Vec3 = parts.iter().map(|(_, _, part)| *part).sum();
                        let reflected = dielectric(ior, entry.view.dot(entry.normal));
                        let all = out + remains + reflected;
                        assert!((all - 1.0).abs().max_element() < 1e-5, "{ior} {entry:?}: {all}");
                        assert!(parts.len() <= ORDERS && remains.min_element() >= 0.0);
                        trapped += remains.x;
                        rays += 1;
                    }
                }
                assert!(rays > 600, "{rays}");
                // By total reflection in the torus and between the faces of the coarse sphere.
                assert!(trapped < 0.1 * rays as f32, "{normals:?}: {trapped} of {rays}");
            }
        }
    }

    #[test]
    fn turns_are_the_parts_that_leave_and_total_reflection_between_them() {
        let hierarchy = of(Cube {}.mesh(3));
        let solid = solid(&hierarchy, Normals::Polygons);
        let d = Vec3::new(70.0f32.to_radians().sin(), 0.0, -70.0f32.to_radians().cos());
        let entry = meet(&solid, Vec3::new(0.4, 0.07, 0.5) - d, d).expect("the front");
        let (parts, remains) = parts(&solid, &GLASS, &entry);
        let (turns, remaining) = turns(&solid, &GLASS, &entry);
        assert_eq!(remaining, remains);
        let leaving: Vec<_> =
            turns.iter().filter_map(|t| Some((t.position, t.leaves?.0, t.leaves?.1))).collect();
        assert_eq!(leaving, parts);
        // The right face reflects everything: cos θ = sin θ_t there, and n² cos² θ > n² − 1 does not hold.
        let first = &turns[0];
        let sine = 70.0f32.to_radians().sin() / 1.5;
        assert!((first.cosine - sine).abs() < 1e-5 && first.reflectance == 1.0 && first.leaves.is_none());
        assert!(
            (first.position.x - 0.5).abs() < 1e-6 && (first.length - 0.1 / sine).abs() < 1e-5,
            "{first:?}"
        );
        // The lengths are those between the points.
        for pair in turns.windows(2) {
            assert!(((pair[1].position - pair[0].position).length() - pair[1].length).abs() < 1e-5);
        }
    }

    #[test]
    fn all_parts_leave_outwards_from_the_boundary() {
        let hierarchy = of(Sphere {}.mesh(16));
        let solid = solid(&hierarchy, Normals::Vertices);
        for i in 0..40 {
            let height = 0.0123 * i as f32;
            let entry = meet(&solid, Vec3::new(0.1, height, 3.0), Vec3::NEG_Z).expect("within the ball");
            for (p, d, _) in parts(&solid, &GLASS, &entry).0 {
                assert!((p.length() - 0.5).abs() < 6e-3 && (d.length() - 1.0).abs() < 1e-5, "{p} {d}");
                assert!(d.dot(p) > -0.05, "{height}: {p} {d}");
            }
        }
    }

    #[test]
    fn a_ray_through_the_centre_goes_straight_on_in_parts_of_a_geometric_series() {
        let hierarchy = of(Sphere {}.mesh(32));
        let solid = solid(&hierarchy, Normals::Vertices);
        // Through the vertices of two poles, and of two ridges.
        for d in [Vec3::NEG_Y, Vec3::X, Vec3::new(0.6, 0.0, 0.8)] {
            let entry = meet(&solid, -3.0 * d, d).expect("the middle");
            let (parts, remains) = parts(&solid, &GLASS, &entry);
            let r = 0.04f32;
            for (i, (p, out, part)) in parts.iter().enumerate() {
                let sign = if i % 2 == 0 { 1.0 } else { -1.0 };
                assert!((*out - sign * d).length() < 5e-3, "{i}: {out}");
                assert!((*p - 0.5 * sign * d).length() < 5e-3, "{i}: {p}");
                let expected = (1.0 - r) * (1.0 - r) * r.powi(i as i32);
                assert!((part.x - expected).abs() < 1e-5 && part.x == part.y, "{i}: {part}");
            }
            // (1 − R)²/(1 − R²) = (1 − R)/(1 + R) in all of what goes on.
            let on: f32 = parts.iter().step_by(2).map(|(_, _, part)| part.x).sum();
            assert!((on - (1.0 - r) / (1.0 + r)).abs() < 1e-5, "{on}");
            assert!(parts.len() >= 4 && remains.x < 1e-6);
        }
    }

    #[test]
    fn the_picture_through_a_ball_is_upside_down() {
        let hierarchy = of(Sphere {}.mesh(48));
        let solid = solid(&hierarchy, Normals::Vertices);
        for height in [0.05, 0.1, 0.2, 0.3] {
            let entry = meet(&solid, Vec3::new(0.02, height, 3.0), Vec3::NEG_Z).expect("within the ball");
            let (p, d, part) = parts(&solid, &GLASS, &entry).0[0];
            // Twice by the angle of incidence less that of refraction.
            let incidence = (2.0 * height).asin();
            let turn = 2.0 * (incidence - (2.0 * height / 1.5).asin());
            assert!((-d.y - turn.sin()).abs() < 0.01, "{height}: {d}");
            assert!(d.y < 0.0 && d.z < 0.0 && (p + 10.0 * d).y < 0.0 && part.x > 0.8, "{height}: {p} {d}");
            // Without refraction it stays where it is: a wrong twin.
            let (p, d, _) = parts(&solid, &Interior { ior: 1.0, ..GLASS }, &entry).0[0];
            assert!((d - Vec3::NEG_Z).length() < 1e-5 && (p.y - height).abs() < 1e-5);
        }
    }

    #[test]
    fn opposite_faces_of_a_cube_leave_the_direction_and_shift_the_ray() {
        let hierarchy = of(Cube {}.mesh(3));
        let solid = solid(&hierarchy, Normals::Polygons);
        for angle in [0.0f32, 0.2, 0.5, 0.7] {
            let d = Vec3::new(angle.sin(), 0.0, -angle.cos());
            let entry = meet(&solid, Vec3::new(-0.31, 0.07, 0.5) - d, d).expect("the front");
            let (p, out, _) = parts(&solid, &GLASS, &entry).0[0];
            assert!((out - d).length() < 1e-5, "{out} instead of {d}");
            let inner = (angle.sin() / 1.5).asin();
            assert!((p - Vec3::new(-0.31 + inner.tan(), 0.07, -0.5)).length() < 1e-5, "{p}");
        }
    }

    #[test]
    fn adjacent_faces_bend_by_snells_law_or_reflect_everything() {
        let hierarchy = of(Cube {}.mesh(3));
        let solid = solid(&hierarchy, Normals::Polygons);
        let angle = 70.0f32.to_radians();
        let d = Vec3::new(angle.sin(), 0.0, -angle.cos());
        let entry = meet(&solid, Vec3::new(0.4, 0.07, 0.5) - d, d).expect("the front");
        // From the right face: n cos θ' = √(n² − sin² θ).
        let (p, out, _) = parts(&solid, &Interior { ior: 1.2, ..GLASS }, &entry).0[0];
        assert!((p.x - 0.5).abs() < 1e-6, "{p}");
        let sine = (1.2 * 1.2 - angle.sin().powi(2)).sqrt();
        assert!((out.z + sine).abs() < 1e-5 && out.x > 0.0, "{out} {sine}");
        // For n² ≥ 2 never: it goes on to the back.
        let (p, out, part) = parts(&solid, &GLASS, &entry).0[0];
        assert!((p.z + 0.5).abs() < 1e-6 && out.x < 0.0, "{p} {out}");
        let once = 1.0 - dielectric(1.5, angle.cos());
        assert!((part.x - once * once).abs() < 1e-5, "{part}");
    }

    #[test]
    fn light_is_absorbed_along_its_way_in_the_room() {
        let hierarchy = of(Cube {}.mesh(1));
        let sigma = Vec3::new(0.3, 0.0, 1.7);
        let size = 0.7;
        let turn = Mat3::from_quat(Quat::from_euler(glam::EulerRot::XYZ, 0.3, -1.1, 2.0));
        let solid = Solid {
            size,
            rotation: turn,
            position: Vec3::new(4.0, -2.0, 9.0),
            ..solid(&hierarchy, Normals::Polygons)
        };
        let d = turn * Vec3::X;
        let entry = meet(&solid, solid.position - 2.0 * d, d).expect("a face");
        let (parts, _) = parts(&solid, &Interior { absorption: sigma, ..GLASS }, &entry);
        for (i, (p, out, part)) in parts.iter().take(4).enumerate() {
            let sign = if i % 2 == 0 { 1.0 } else { -1.0 };
            assert!((*out - sign * d).length() < 1e-5);
            assert!((*p - (solid.position + 0.5 * size * sign * d)).length() < 1e-5, "{p}");
            let way = size * (i + 1) as f32;
            let expected = 0.96 * 0.96 * 0.04f32.powi(i as i32) * (-sigma * way).exp();
            assert!((*part - expected).abs().max_element() < 1e-6, "{i}: {part} {expected}");
        }
        // What is absorbed does not remain.
        let all: Vec3 = parts.iter().map(|(_, _, part)| *part).sum();
        assert!((all.y - 0.96).abs() < 1e-5 && all.z < 0.5 * all.y, "{all}");
    }

    #[test]
    fn normals_that_contradict_the_triangles_lose_no_light() {
        let hierarchy = of(Sphere {}.mesh(2));
        let solid = solid(&hierarchy, Normals::Vertices);
        let mut seed = 8;
        for _ in 0..500 {
            let d = direction(&mut seed);
            let entry = meet(&solid, 0.3 * direction(&mut seed) - 2.0 * d, d);
            let Some(entry) = entry else { continue };
            // As far aside as interpolation between corners of an octahedron gets, and further.
            let normal = (entry.face_normal + 0.9 * direction(&mut seed)).normalize();
            let entry = Entry { normal, ..entry };
            let (parts, remains) = parts(&solid, &GLASS, &entry);
            let out: Vec3 = parts.iter().map(|(_, _, part)| *part).sum();
            let entered = 1.0 - dielectric(1.5, entry.view.dot(normal));
            assert!((out.x + remains.x - entered).abs() < 1e-5, "{entry:?}");
        }
    }

    #[test]
    fn rays_stay_on_their_side_of_the_triangles() {
        let (mut seed, mut corrected) = (2, 0);
        for _ in 0..2000 {
            let flat = direction(&mut seed);
            let shading = (flat + 0.7 * direction(&mut seed)).normalize();
            let ray = (direction(&mut seed) + 0.9 * flat).normalize();
            if ray.dot(flat) < 1e-3 {
                continue;
            }
            let boundary = Boundary::of([shading, flat], ray, 1.5);
            assert!(boundary.reflected.dot(flat) < 0.0, "{flat} {shading} {ray}");
            assert!(boundary.out.is_none_or(|out| out.dot(flat) > 0.0), "{flat} {shading} {ray}");
            corrected += usize::from(boundary.reflected == Boundary::new(ray, flat, 1.5).reflected);
            // Without a normal of the shading, too.
            assert!(Boundary::of([Vec3::ZERO, flat], ray, 1.5).reflected.is_finite());
        }
        assert!((20..500).contains(&corrected), "{corrected}");
    }
}
