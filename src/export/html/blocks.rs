//! Blocks of bytes for uniforms, each stored once.

use base64::{Engine as _, engine::general_purpose::STANDARD};
use serde_json::{Value as Json, json};

/// The blocks of a page.
#[derive(Debug, Default)]
pub struct Blocks(Vec<Vec<u8>>);

impl Blocks {
    /// Adds a block, unless it exists, and returns its index.
    pub fn add(&mut self, bytes: &[u8]) -> usize {
        self.0.iter().position(|known| known == bytes).unwrap_or_else(|| {
            self.0.push(bytes.to_vec());
            self.0.len() - 1
        })
    }

    /// The blocks in base64.
    #[must_use]
    pub fn json(&self) -> Json {
        json!(self.0.iter().map(|bytes| STANDARD.encode(bytes)).collect::<Vec<_>>())
    }
}
