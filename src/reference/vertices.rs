//! The colours calculated by shading models at the vertices of an object.

use glam::{Mat4, Vec3};

use super::{lights::Lights, meshes::Meshes, object::Draw, raster::Screen};
use crate::{
    optics::{TermSelection, colour::luminance},
    registry::Registry,
    scene::{Observer, Scene},
    shading::Stage,
};

/// The luminance of the brightest vertex of an object among those of triangles that face an eye. `None` if
/// its shading model does not evaluate the equation at vertices, if no triangle faces the eye, or if no
/// vertex is lit.
#[must_use]
pub fn brightest_vertex(
    scene: &Scene,
    registry: &Registry,
    terms: TermSelection,
    object: usize,
    eye: Vec3,
) -> Option<f32> {
    let own = scene.objects.get(object)?;
    let observer = Observer { position: eye, ..scene.observer };
    let scene = &Scene {
        name: None,
        description: None,
        reflection_model: scene.reflection_model.clone(),
        shading_model: scene.shading_model.clone(),
        lights: scene.lights.clone(),
        observer,
        objects: vec![own.clone()],
        variants: Vec::new(),
        ..*scene
    };
    let mut meshes = Meshes::new(registry);
    let draw = Draw::first(scene, &mut meshes, &[&scene.objects[0]], &[])?;
    if draw.stage != Stage::Vertex {
        return None;
    }
    // Only the corners in the room matter, not those in a picture.
    let posed = draw.posed(&Mat4::IDENTITY, &Screen::new(1, 1, 1));
    let lights = Lights::new(scene, registry, terms);
    let lighting = draw.under(&lights);
    let faces = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|i| posed.positions[i as usize]);
        (b - a).cross(c - a).dot(eye - a) > 0.0
    };
    let mut corners: Vec<u32> =
        draw.shape.mesh.triangles().map(|(_, triangle)| triangle).filter(faces).flatten().collect();
    corners.sort_unstable();
    corners.dedup();
    corners
        .into_iter()
        .map(|i| luminance(draw.shading.vertex(&lighting, &draw.corner(&posed, i as usize)).colour))
        .max_by(f32::total_cmp)
        .filter(|most| *most > 0.0)
}
