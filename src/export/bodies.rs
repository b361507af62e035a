//! The meshes of solid bodies, with the hierarchies that shaders follow.

use super::ExportError;
use crate::shape::{Hierarchy, PolygonMesh, closed, hierarchy::Row};

/// Number of rows of a hierarchy side by side in a texture, each in one texel.
pub const WIDTH: u32 = 1024;

/// The row that stands for the hierarchy of a mesh that is not closed.
const NONE: Row = [0; 4];

/// The mesh of a body.
pub struct Body {
    hierarchy: Hierarchy,
    /// Why it is not closed, if it is not.
    open: Option<String>,
}

impl Body {
    /// The body with this mesh.
    #[must_use]
    pub fn of(mesh: &PolygonMesh) -> Self {
        let hierarchy = Hierarchy::new(mesh);
        let open = closed::check(mesh, &hierarchy).err().map(|why| why.to_string());
        Self { hierarchy, open }
    }

    /// True if the mesh is closed.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.open.is_none()
    }

    /// The rows that the shaders read.
    #[must_use]
    pub fn rows(&self) -> &[Row] {
        if self.is_closed() { self.hierarchy.rows() } else { &[NONE] }
    }

    /// A sentence about an object with an open mesh.
    #[must_use]
    pub fn note(&self, object: &str) -> Option<String> {
        self.open.as_ref().map(|why| format!("{object} is drawn as thin glass: {why}."))
    }

    /// Checks that the rows fit into a texture of a height.
    ///
    /// # Errors
    /// Returns an error with both sizes.
    pub fn fits(&self, most: u32) -> Result<(), ExportError> {
        fits(self.rows().len(), most)
    }
}

fn fits(rows: usize, most: u32) -> Result<(), ExportError> {
    let height = rows.div_ceil(WIDTH as usize);
    if height <= most as usize {
        return Ok(());
    }
    Err(ExportError::refused(format!(
        "the triangles of the body take a texture of {WIDTH}x{height}, and {WIDTH}x{most} is the limit; a coarser mesh has fewer"
    )))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::registry::Registry;

    fn body(shape: &str) -> Body {
        let registry = Registry::builtin();
        let shape = registry.shape(shape).expect("built in");
        Body::of(&shape.mesh(&Default::default(), 4))
    }

    #[test]
    fn an_open_mesh_has_one_row_of_zeros_and_says_why() {
        let sphere = body("sphere");
        assert!(sphere.is_closed() && sphere.rows().len() > 1 && sphere.note("a").is_none());
        let teapot = body("teapot");
        assert!(!teapot.is_closed());
        assert_eq!(teapot.rows(), [[0; 4]]);
        let note = teapot.note("objects[0]").expect("open");
        assert!(
            note.starts_with("objects[0] is drawn as thin glass: it is open: ") && note.ends_with('.'),
            "{note}"
        );
    }

    #[test]
    fn a_hierarchy_beyond_a_texture_is_refused_with_its_size() {
        assert!(body("sphere").fits(2048).is_ok() && fits(1024 * 2048, 2048).is_ok());
        let said = fits(1024 * 2048 + 1, 2048).expect_err("too large").to_string();
        assert!(said.contains("a texture of 1024x2049, and 1024x2048 is the limit"), "{said}");
    }
}
