//! Limits of browsers: the minimum that WebGPU guarantees by default, and that of WebGL 2 on nearly every
//! device. A page beyond these limits would only fail for its readers.

use crate::{export::ExportError, shape::PolygonMesh};

/// Bytes in one uniform buffer.
const UNIFORM: usize = 65_536;
/// Uniform buffers of one shader.
const UNIFORMS: usize = 12;
/// Bytes in one vertex buffer.
const VERTICES: usize = 1 << 28;
/// Height of a texture.
pub const TEXTURE: u32 = 2048;
/// Bytes of a vertex with data of its polygon: six attributes of three floats.
const STRIDE: usize = 72;

/// Checks that uniforms fit into a browser's buffers.
///
/// # Errors
/// Returns an error with the size and the limit.
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

/// Checks that the vertices of a mesh fit into a browser's buffer.
///
/// # Errors
/// Returns an error with the size and the limit.
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
