//! Objects: from the scene to triangles on the screen, shaded as far as the shading model works at corners.

use std::sync::Arc;

use glam::{EulerRot, Mat3, Mat4, Vec3, Vec4};
use rayon::prelude::*;

use super::{
    inside::Normals,
    lighting::LightsOn,
    lights::Lights,
    meshes::{Meshes, Prepared},
    raster::{Placed, Screen, Triangle, set_up},
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
        let mesh = &self.shape.mesh;
        if self.anisotropic {
            // Built now, since corners are shaded in parallel.
            self.shape.tangents();
        }
        let rotation = rotation(self.object.rotation);
        let room = |p: Vec3| self.room(rotation, p);
        let positions: Vec<Vec3> = mesh.positions.iter().map(|&p| room(p)).collect();
        let placed: Vec<Placed> =
            positions.iter().map(|p| Placed::new(*clip_from_room * p.extend(1.0), screen)).collect();
        let visible = self
            .shape
            .triangles()
            .filter(|(_, t)| Placed::may_be_seen(t.map(|c| &placed[c as usize]), screen))
            .map(|(polygon, t)| (polygon as u32, t))
            .collect();
        Posed { rotation, positions, placed, visible }
    }

    /// A point of the mesh in the room.
    fn room(&self, rotation: Mat3, p: Vec3) -> Vec3 {
        rotation * (p * self.object.size) + self.object.position
    }

    /// The polygon with this index or, for shading models that do not run per polygon, the vertex, as a
    /// corner to shade.
    pub(super) fn corner(&self, posed: &Posed, i: usize) -> Corner {
        let per_polygon = self.per_polygon();
        let (position, normals) = if per_polygon {
            (self.room(posed.rotation, self.shape.polygon_centres[i]), &self.shape.polygon_normals)
        } else {
            (posed.positions[i], &self.shape.vertex_normals)
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
        let posed = self.posed(clip_from_room, screen);
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
        let mesh = &self.shape.mesh;
        let mut place =
            vec![0u32; if self.per_polygon() { mesh.polygons.len() } else { mesh.positions.len() }];
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
