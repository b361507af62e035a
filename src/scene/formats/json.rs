//! JSON, the format that holds everything in a scene and that editors check with a schema.

use super::{Parsed, SceneFormat, SceneWriter, Source, Target};
use crate::{
    platform::fs,
    registry::Registry,
    scene::{Scene, error::LoadError, read, schema, syntax::check_syntax, write::to_json},
    text::{
        after_mark,
        json::{self, STRICT},
        place::Lines,
    },
};

/// Scenes in JSON: `docs/scenes.md` describes the fields.
#[derive(Clone, Copy, Debug, Default)]
pub struct Json;

impl SceneFormat for Json {
    fn name(&self) -> &'static str {
        "JSON"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["json"]
    }

    fn read<'a>(&self, source: &'a Source<'_>, registry: &'a Registry) -> Result<Parsed<'a>, LoadError> {
        let text = source.text()?;
        parse(text, source, registry)
            .map_err(|(at, what)| source.syntax_error(self.name(), Lines::new(text).place(at), what))?
            .ok_or_else(|| LoadError::Empty { name: source.name.to_owned() })
    }

    fn writer(&self) -> Option<&dyn SceneWriter> {
        Some(self)
    }
}

/// The syntax tree of the scene in a text from a source; `None` if the text is empty.
///
/// # Errors
/// Returns the position where the text stops being JSON, and what was expected there.
pub(super) fn parse<'a>(
    text: &'a str,
    source: &'a Source<'_>,
    registry: &'a Registry,
) -> Result<Option<Parsed<'a>>, (usize, String)> {
    check_syntax(text)?;
    // The two parsers agree except for half surrogate pairs, which only this one refuses.
    let root = json::parse(text, &STRICT)?;
    Ok(root.map(|root| read::parsed(text, root, source, registry, Default::default())))
}

impl SceneWriter for Json {
    /// The `$schema` of the old file is kept; a new file refers to [`schema::FILE_NAME`] if that is in its folder.
    fn write(&self, scene: &Scene, target: &Target<'_>, registry: &Registry) -> Result<Vec<u8>, String> {
        let reference = match target.old {
            Some(old) => schema_of(old),
            None => {
                let beside = fs::is_file(target.folder.join(schema::FILE_NAME));
                beside.then(|| format!("./{}", schema::FILE_NAME))
            }
        };
        Ok(to_json(scene, reference.as_deref(), registry).into_bytes())
    }
}

/// The `$schema` of a scene file.
fn schema_of(bytes: &[u8]) -> Option<String> {
    /// The only key needed here.
    #[derive(serde::Deserialize)]
    struct Head {
        #[serde(rename = "$schema")]
        schema: Option<String>,
    }
    serde_json::from_slice::<Head>(after_mark(bytes)).ok()?.schema
}
