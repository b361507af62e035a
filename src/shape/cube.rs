use super::{Declaration, ObjectType, PolygonMesh};

/// Placeholder.
#[derive(Clone, Copy, Debug)]
pub struct Cube;

impl ObjectType for Cube {
    const DECLARATION: Declaration = Declaration {
        id: "cube",
        name: "Cube",
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
