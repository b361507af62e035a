//! What browsers take: the least that WebGPU promises without asking for more, and WebGL 2 on nearly every device. A
//! page beyond it would only fail at its reader's.

use serde_json::Value as Json;

use crate::{export::ExportError, shape::PolygonMesh};

/// Bytes of one uniform buffer.
const UNIFORM: usize = 65_536;
/// Uniform buffers of one shader.
const UNIFORMS: usize = 12;
/// Bytes of one buffer of vertices.
const VERTICES: usize = 1 << 28;
/// Bytes of a vertex that knows its polygon: six attributes of three floats.
const STRIDE: usize = 72;

/// Refuses shaders whose uniforms a browser does not take.
///
/// # Errors
/// The size and the limit.
pub fn uniforms<'a>(all: impl ExactSizeIterator<Item = (&'a str, usize)>) -> Result<(), ExportError> {
    if all.len() > UNIFORMS {
        let said = format!("a shader has {} uniform buffers, and browsers take {UNIFORMS}", all.len());
        return Err(ExportError::refused(said));
    }
    for (name, bytes) in all {
        if bytes > UNIFORM {
            let said = format!(
                "the values of {name} take {bytes} bytes, and browsers take {UNIFORM}; fewer lights, or fewer \
                 profiles of lamps, make them smaller"
            );
            return Err(ExportError::refused(said));
        }
    }
    Ok(())
}

/// Refuses a mesh with more vertices than a browser takes.
///
/// # Errors
/// The size and the limit.
pub fn mesh(polygons: &PolygonMesh) -> Result<(), ExportError> {
    vertices(polygons.polygons.iter().map(|polygon| polygon.corners().len()).sum())
}

fn vertices(corners: usize) -> Result<(), ExportError> {
    let most = VERTICES / STRIDE;
    if corners <= most {
        return Ok(());
    }
    Err(ExportError::refused(format!(
        "its mesh has {corners} corners of polygons, and browsers take {most}; a coarser mesh has fewer"
    )))
}

/// Refuses uniforms as they stand in the data of the page.
///
/// # Errors
/// As [`uniforms`].
pub fn listed(all: &[Json]) -> Result<(), ExportError> {
    let size = |json: &Json| json["size"].as_u64().unwrap_or(u64::MAX) as usize;
    uniforms(all.iter().map(|json| (json["name"].as_str().unwrap_or_default(), size(json))))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_browsers_do_not_take_is_refused_with_its_size() {
        let said = |result: Result<(), ExportError>| result.expect_err("refused").to_string();
        assert!(uniforms([("lights", UNIFORM)].into_iter()).is_ok());
        let large = said(uniforms([("lights", UNIFORM + 1)].into_iter()));
        assert!(large.contains("lights take 65537 bytes, and browsers take 65536"), "{large}");
        let many = said(uniforms(vec![("a", 16); UNIFORMS + 1].into_iter()));
        assert!(many.contains("13 uniform buffers, and browsers take 12"), "{many}");
        assert!(vertices(VERTICES / STRIDE).is_ok());
        let fine = said(vertices(VERTICES / STRIDE + 1));
        assert!(fine.contains("3728271 corners of polygons, and browsers take 3728270"), "{fine}");
    }
}
