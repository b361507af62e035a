use super::{Declaration, ObjectType, PolygonMesh};

/// Placeholder.
#[derive(Clone, Copy, Debug)]
pub struct Sphere;

impl ObjectType for Sphere {
    const DECLARATION: Declaration = Declaration {
        id: "sphere",
        name: "Sphere",
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
