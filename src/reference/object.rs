//! Objects: from the scene to triangles on the screen, shaded as far as the shading model works at corners.

use std::sync::Arc;

use glam::{EulerRot, Mat3, Mat4, Vec3, Vec4};
use rayon::prelude::*;

use super::{
    inside::Normals,
    lighting::LightsOn,
    lights::Lights,
    meshes::{Meshes, Prepared},
    raster::{Boxes, Placed, Screen, Triangle, set_up},
    through::Body,
};
use crate::{
    optics::lobes::Lobes,
    reflection::Surface,
    registry::Registry,
    scene::{Object, Scene},
    shading::{Corner, Lighting, Shading, Stage, Varying},
};

/// Minimum number of vertices or polygons shaded by one task.
const SHADED_PER_TASK: usize = 256;

/// True if an object certainly lies beyond one of the planes of a view frustum.
pub(super) fn hidden(object: &Object, shape: &Prepared, frustum: &[Vec4]) -> bool {
    let radius = shape.radius * object.size;
    frustum.iter().any(|plane| plane.dot(object.position.extend(1.0)) < -radius)
}

/// An object with everything needed to draw it.
pub(super) struct Draw<'a> {
    pub(super) object: &'a Object,
    pub(super) shape: Arc<Prepared>,
    pub(super) stage: Stage,
    pub(super) shading: Box<dyn Shading>,
    pub(super) surface: Arc<dyn Surface>,
    /// The lobes of the surface.
    pub(super) lobes: Lobes,
    /// The body behind the surface, if it is solid.
    pub(super) body: Option<Body>,
    /// True if the model needs tangents.
    pub(super) anisotropic: bool,
}

/// A polygon, and the corners of one of its triangles.
pub(super) type Face = (u32, [u32; 3]);

/// An object in its place: its corners in the room and on the screen, and the triangles that may be visible.
pub(super) struct Posed {
    rotation: Mat3,
    /// The vertices of the mesh that the corners are; `None` if each vertex is one.
    vertices: Option<Vec<u32>>,
    pub(super) positions: Vec<Vec3>,
    placed: Vec<Placed>,
    pub(super) visible: Vec<Face>,
}

/// The rotation of an object: first about x, then y, then z of the room, in degrees.
fn rotation(degrees: Vec3) -> Mat3 {
    let r = degrees.map(f32::to_radians);
    Mat3::from_euler(EulerRot::ZYX, r.z, r.y, r.x)
}

impl<'a> Draw<'a> {
    /// `None` if the registry does not know the object's models.
    pub(super) fn new(
        scene: &'a Scene,
        registry: &Registry,
        object: &'a Object,
        shape: Arc<Prepared>,
    ) -> Option<Self> {
        let model = registry.model(scene.model_of(object))?;
        let shading = registry.shading_model(scene.shading_model_of(object))?;
        let encoding = scene.display.encoding;
        let surface = model.instantiate(&object.material, encoding);
        Some(Self {
            object,
            stage: shading.declaration.stage,
            shading: (shading.instantiate)(&object.material, encoding),
            lobes: surface.lobes(),
            body: surface.interior().map(|interior| Body {
                interior,
                shape: shape.clone(),
                normals: if shading.declaration.faceted { Normals::Polygons } else { Normals::Vertices },
                rotation: rotation(object.rotation),
                size: object.size,
                position: object.position,
            }),
            surface,
            shape,
            anisotropic: model.declaration.anisotropic,
        })
    }

    /// The first of several objects that are drawn one after the other, unless it is hidden.
    pub(super) fn first(
        scene: &'a Scene,
        meshes: &mut Meshes,
        objects: &[&'a Object],
        frustum: &[Vec4],
    ) -> Option<Self> {
        let shape = meshes.first(objects).filter(|shape| !hidden(objects[0], shape, frustum))?;
        Self::new(scene, meshes.registry, objects[0], shape)
    }

    /// Some lights as they shine on the object.
    pub(super) fn under<'l>(&'l self, lights: &'l Lights) -> LightsOn<'l> {
        lights.on(&*self.surface, self.lobes, self.body.as_ref())
    }

    fn per_polygon(&self) -> bool {
        self.stage == Stage::Polygon
    }

    /// Places the object in the room and on the screen.
    pub(super) fn posed(&self, clip_from_room: &Mat4, screen: &Screen) -> Posed {
        let faces = self.shape.triangles().map(|(polygon, t)| (polygon as u32, t));
        self.posed_of(None, faces, clip_from_room, screen)
    }

    /// Like [`posed`](Self::posed), without most corners where most of the mesh covers no sample: thousands of objects of many
    /// polygons each would take minutes for a small picture.
    fn posed_near_samples(&self, clip_from_room: &Mat4, screen: &Screen) -> Posed {
        let shape = &*self.shape;
        let turned = self.object.size * rotation(self.object.rotation);
        let reach = self.object.size * shape.radius;
        let boxes = Boxes::new(clip_from_room, (turned, self.object.position), reach, screen);
        let near = shape.patches.iter().filter(|patch| boxes.may_cover(patch.centre, patch.half));
        let near: Vec<_> = near.collect();
        if 2 * near.iter().map(|patch| patch.len()).sum::<usize>() > shape.mesh.polygons.len() {
            return self.posed(clip_from_room, screen);
        }
        let faces = near.into_iter().flat_map(|patch| shape.triangles_of(patch));
        let mut faces: Vec<Face> = faces.map(|(polygon, t)| (polygon as u32, t)).collect();
        let mut vertices: Vec<u32> = faces.iter().flat_map(|(_, t)| *t).collect();
        vertices.sort_unstable();
        vertices.dedup();
        for corner in faces.iter_mut().flat_map(|(_, t)| t) {
            *corner = vertices.partition_point(|vertex| vertex < corner) as u32;
        }
        self.posed_of(Some(vertices), faces.into_iter(), clip_from_room, screen)
    }

    /// Places some vertices of the mesh, or all, and the faces of these corners.
    fn posed_of(
        &self,
        vertices: Option<Vec<u32>>,
        faces: impl Iterator<Item = Face>,
        clip_from_room: &Mat4,
        screen: &Screen,
    ) -> Posed {
        let mesh = &self.shape.mesh;
        if self.anisotropic {
            // Built now, since corners are shaded in parallel.
            self.shape.tangents();
        }
        let rotation = rotation(self.object.rotation);
        let room = |p: Vec3| self.room(rotation, p);
        let positions: Vec<Vec3> = match &vertices {
            Some(some) => some.iter().map(|&vertex| room(mesh.positions[vertex as usize])).collect(),
            None => mesh.positions.iter().map(|&p| room(p)).collect(),
        };
        let placed: Vec<Placed> =
            positions.iter().map(|p| Placed::new(*clip_from_room * p.extend(1.0), screen)).collect();
        let is_seen = |(_, t): &Face| Placed::may_be_seen(t.map(|c| &placed[c as usize]), screen);
        let visible = faces.filter(is_seen).collect();
        Posed { rotation, vertices, positions, placed, visible }
    }

    /// A point of the mesh in the room.
    fn room(&self, rotation: Mat3, p: Vec3) -> Vec3 {
        rotation * (p * self.object.size) + self.object.position
    }

    /// The polygon with this index or, for shading models that do not run per polygon, the corner, to be
    /// shaded.
    pub(super) fn corner(&self, posed: &Posed, i: usize) -> Corner {
        let per_polygon = self.per_polygon();
        let (position, normals, i) = if per_polygon {
            (self.room(posed.rotation, self.shape.polygon_centres[i]), &self.shape.polygon_normals, i)
        } else {
            let vertex = posed.vertices.as_ref().map_or(i, |vertices| vertices[i] as usize);
            (posed.positions[i], &self.shape.vertex_normals, vertex)
        };
        let normal = posed.rotation * normals[i];
        let tangents = self.anisotropic.then(|| self.shape.tangents());
        let tangent = tangents.map_or(Vec3::ZERO, |[polygon, vertex]| {
            posed.rotation * if per_polygon { polygon } else { vertex }[i]
        });
        Corner {
            position,
            normal,
            tangent,
            face_normal: normal,
            face_tangent: tangent,
            face_centre: position,
        }
    }

    /// The corners of a triangle with their values; `shaded` returns those of a polygon or a vertex.
    pub(super) fn varyings(
        &self,
        posed: &Posed,
        (polygon, corners): Face,
        mut shaded: impl FnMut(u32) -> Varying,
    ) -> [Varying; 3] {
        corners.map(|c| {
            let shaded = shaded(if self.per_polygon() { polygon } else { c });
            Varying { position: posed.positions[c as usize], ..shaded }
        })
    }

    /// Calls `emit` for the visible parts of a triangle.
    pub(super) fn set_up(
        &self,
        posed: &Posed,
        (_, corners): Face,
        varyings: [Varying; 3],
        screen: &Screen,
        emit: &mut impl FnMut(Triangle),
    ) {
        let placed = corners.map(|c| &posed.placed[c as usize]);
        set_up(placed, varyings, self.anisotropic, screen, emit);
    }

    /// The triangles that may be visible, shaded as far as the shading model works at corners.
    pub(super) fn triangles(&self, lights: &Lights, clip_from_room: &Mat4, screen: &Screen) -> Vec<Triangle> {
        let posed = self.posed_near_samples(clip_from_room, screen);
        let lighting = self.under(lights);

        // The values of corners are calculated once per polygon or once per vertex, and only where needed.
        let mut needed: Vec<u32> = if self.per_polygon() {
            posed.visible.iter().map(|(polygon, _)| *polygon).collect()
        } else {
            posed.visible.iter().flat_map(|(_, t)| *t).collect()
        };
        needed.sort_unstable();
        needed.dedup();
        let shaded: Vec<Varying> = needed
            .par_iter()
            .with_min_len(SHADED_PER_TASK)
            .map(|&i| {
                let corner = self.corner(&posed, i as usize);
                self.shading.vertex(&lighting as &dyn Lighting, &corner)
            })
            .collect();
        let polygons = self.shape.mesh.polygons.len();
        let mut place = vec![0u32; if self.per_polygon() { polygons } else { posed.positions.len() }];
        for (at, &i) in needed.iter().enumerate() {
            place[i as usize] = at as u32;
        }

        let mut out = Vec::with_capacity(posed.visible.len());
        for &face in &posed.visible {
            let varyings = self.varyings(&posed, face, |i| shaded[place[i as usize] as usize]);
            self.set_up(&posed, face, varyings, screen, &mut |triangle| out.push(triangle));
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{optics::TermSelection, parameter::Value, scene::observer::clip_from_room};

    /// An object of a superellipsoid's mesh.
    fn object(position: Vec3, size: f32, tessellation: u32) -> Object {
        let mut object = Object {
            object_type: "superellipsoid".to_owned(),
            position,
            size,
            rotation: Vec3::new(20.0, 50.0, 10.0),
            tessellation: Some(tessellation),
            ..Object::default()
        };
        object.shape.set("vertical_exponent", Value::Number(2.5));
        object
    }

    /// The corners that are placed for an object, out of all, if the same faces can be seen as without leaving any out.
    fn corners(observer: Vec3, object: Object, [width, height]: [usize; 2], samples: usize) -> [usize; 2] {
        let registry = Registry::builtin();
        let mut scene = Scene::default();
        scene.observer.position = observer;
        scene.objects = vec![object];
        let shown: Vec<_> = scene.shown().collect();
        let mut meshes = Meshes::new(&registry);
        let draw = Draw::first(&scene, &mut meshes, &shown, &[]).expect("known");
        let clip = clip_from_room(&scene.observer, width as f32 / height as f32);
        let screen = Screen::new(width, height, samples);
        let [all, near] = [draw.posed(&clip, &screen), draw.posed_near_samples(&clip, &screen)];
        let lights = Lights::new(&scene, &registry, TermSelection::All);
        let faces = |posed: &Posed| -> Vec<_> {
            let shaded = |c: u32| {
                let corner = draw.corner(posed, c as usize);
                draw.shading.vertex(&draw.under(&lights) as &dyn Lighting, &corner)
            };
            let mut faces = Vec::new();
            for face in &posed.visible {
                let values =
                    face.1.map(|c| (posed.positions[c as usize], shaded(c).normal, shaded(c).colour));
                draw.set_up(posed, *face, draw.varyings(posed, *face, shaded), &screen, &mut |_| {
                    faces.push((face.0, values));
                });
            }
            faces
        };
        let (expected, found) = (faces(&all), faces(&near));
        assert!(expected == found, "{observer} {width}×{height}: {} and {}", expected.len(), found.len());
        [near.positions.len(), all.positions.len()]
    }

    #[test]
    fn what_covers_no_sample_is_left_out_and_what_is_seen_stays() {
        // A small object in a small picture.
        for i in 0..40 {
            let at = Vec3::new(3.0 + 0.103 * i as f32, 5.0 - 0.017 * i as f32, 4.0);
            let [some, all] = corners(Vec3::new(5.0, 5.0, 9.9), object(at, 0.05, 256), [64, 36], 4);
            assert!(some < all / 5, "{i}: {some} of {all}");
        }
        // Half outside, around the eye, close to it, and large.
        for (at, size, picture) in [
            (Vec3::new(1.0, 5.0, 4.0), 2.0, [64, 36]),
            (Vec3::new(5.0, 5.0, 9.9), 1.0, [64, 36]),
            (Vec3::new(5.0, 5.0, 9.6), 0.5, [320, 180]),
            (Vec3::new(5.2, 5.1, 9.8), 0.1, [4000, 4000]),
            (Vec3::new(5.0, 5.0, 4.0), 2.0, [16_384, 3]),
        ] {
            for samples in [1, 4] {
                corners(Vec3::new(5.0, 5.0, 9.9), object(at, size, 64), picture, samples);
            }
        }
    }
}
