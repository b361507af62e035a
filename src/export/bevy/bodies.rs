//! The solid bodies of a project: a file for each mesh that light is followed through.

use std::collections::HashMap;

use crate::export::{ExportError, bodies::Body, lit::Lit, names::Names};

/// Height of a texture that every system takes (WebGPU, *Limits*).
const TEXTURE: u32 = 8192;

/// The bodies of a scene.
#[derive(Default)]
pub(super) struct Bodies {
    /// Each mesh once, with the bytes of its rows.
    pub(super) all: Vec<(String, Vec<u8>)>,
    /// The index of the body of each material that has one.
    pub(super) of_materials: HashMap<usize, usize>,
    /// Sentences about open meshes.
    pub(super) notes: Vec<String>,
}

impl Bodies {
    /// Takes the bodies out of a scene.
    ///
    /// # Errors
    /// Returns an error for a mesh that does not fit into a texture.
    pub(super) fn of(lit: &Lit) -> Result<Self, ExportError> {
        let registry = lit.request.registry;
        let (mut bodies, mut known, mut names) = (Self::default(), HashMap::new(), Names::default());
        for drawn in &lit.objects {
            let object = &lit.request.scene.objects[drawn.index];
            let Some(shape) = registry.shape(&object.object_type) else { continue };
            if !lit.programs[lit.materials[drawn.material].program].shader.reads_body {
                continue;
            }
            let key = shape.key(&object.shape, object.tessellation);
            if let Some(index) = known.get(&key) {
                bodies.of_materials.insert(drawn.material, *index);
                continue;
            }
            let tessellation = shape.tessellation(object.tessellation);
            let body = Body::of(&shape.mesh(&object.shape, tessellation));
            let path = lit.request.scene.object_path(drawn.index);
            body.fits(TEXTURE).map_err(|why| ExportError::refused(format!("{path}: {why}")))?;
            bodies.notes.extend(body.note(&path));
            let bytes = body.rows().iter().flatten().flat_map(|word| word.to_le_bytes()).collect();
            bodies.of_materials.insert(drawn.material, bodies.all.len());
            known.insert(key, bodies.all.len());
            bodies.all.push((names.unique(format!("{}_{tessellation}", shape.declaration.id)), bytes));
        }
        Ok(bodies)
    }
}
