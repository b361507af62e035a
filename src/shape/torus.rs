use super::{Declaration, ObjectType, PolygonMesh};

/// Placeholder.
#[derive(Clone, Copy, Debug)]
pub struct Torus;

impl ObjectType for Torus {
    const DECLARATION: Declaration = Declaration {
        id: "torus",
        name: "Torus",
        summary: "",
        glyph: "●",
        tessellation_help: "",
        tessellation: 1..=64,
        default_tessellation: 16,
    };

    fn mesh(_tessellation: u32) -> PolygonMesh {
        PolygonMesh::default()
    }
}
