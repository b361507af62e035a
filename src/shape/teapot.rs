use super::{Declaration, ObjectType, PolygonMesh};

/// Placeholder.
#[derive(Clone, Copy, Debug)]
pub struct Teapot;

impl ObjectType for Teapot {
    const DECLARATION: Declaration = Declaration {
        id: "teapot",
        name: "Teapot",
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
