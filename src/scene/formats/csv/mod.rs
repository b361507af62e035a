//! Scenes as tables (CSV, RFC 4180): one row per part, for scenes that are made in a spreadsheet or by a script. The
//! reader is our own, since messages need the byte position of each cell, and a table that is written again keeps its
//! separators and comments, which a reader of plain records loses.
//!
//! The first column, `part`, gives the kind of a row: `scene`, `light`, `observer` or `object`. The other
//! columns have the names of the fields of scene files in JSON, relative to the part: `type`, `size`,
//! `material.k_d`. Each component of a list may have a column: `position.x`. Empty cells count as missing.
//! Rows whose first cell begins with `#` are comments.
//!
//! A table becomes the same tree of values as JSON, with the positions of its cells, and is read from there
//! by the same code; it is written from what would be written as JSON. All rules, parameters and messages are
//! therefore those of JSON.
//!
//! As in tables from spreadsheets in some countries, columns may be separated by semicolons or tabs; numbers
//! may then have a decimal comma. Lines may end as on old Macintoshes. A table that is written again keeps
//! its separators, the order of its columns, and its comments.

use std::borrow::Cow;

use super::{Parsed, SceneFormat, SceneWriter, Source, Target};
use crate::{
    light::MAX_LIGHTS,
    registry::Registry,
    scene::{MAX_OBJECTS, Scene, error::LoadError, read, write::to_json},
    text::{after_mark, place::Lines, with_line_feeds},
};

mod columns;
mod grid;
mod problems;
mod rows;
mod write;

pub use columns::table as column_table;

use columns::Columns;
use grid::Grid;

/// Scenes in CSV: `docs/scenes.md` describes the columns.
#[derive(Clone, Copy, Debug, Default)]
pub struct Csv;

impl Csv {
    /// Maximum number of rows except comments: the header, the scene, the observer, and all parts that a
    /// scene may have. Reading stops after this number, so a longer table costs no more than the largest
    /// legal one.
    pub const MAX_ROWS: usize = 3 + MAX_LIGHTS + MAX_OBJECTS;
    /// Maximum number of cells in a row. Only some hundred columns have a meaning.
    pub const MAX_COLUMNS: usize = 1 << 15;
    /// Maximum number of cells and remarks; a legal table with all columns has a third of it.
    pub const MAX_CELLS: usize = 4_000_000;
}

impl SceneFormat for Csv {
    fn name(&self) -> &'static str {
        "CSV"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["csv"]
    }

    /// True if the first line that is not a comment begins with the name of the first column.
    fn recognises(&self, content: &[u8]) -> bool {
        let mut lines = after_mark(content).split(|b| b"\r\n".contains(b)).map(<[u8]>::trim_ascii);
        let first = lines.find(|line| !line.is_empty() && !line.starts_with(b"#")).unwrap_or_default();
        let first = first.split(|b| b",;\t".contains(b)).next().unwrap_or_default().trim_ascii();
        [columns::PART.as_bytes(), b"\"part\""].contains(&first)
    }

    fn read<'a>(&self, source: &'a Source<'_>, registry: &'a Registry) -> Result<Parsed<'a>, LoadError> {
        let text = source.text()?;
        let lines = with_line_feeds(text);
        let syntax = |(at, what): (usize, String)| {
            source.syntax_error(self.name(), Lines::new(&lines).place(at), what)
        };
        let grid = Grid::of(&lines).map_err(syntax)?;
        let columns = Columns::of(&grid, registry).map_err(syntax)?;
        // Decimal commas become points, at the same byte.
        let text = match rows::decimal_commas(&grid, &columns) {
            commas if commas.is_empty() && matches!(lines, Cow::Borrowed(_)) => text,
            commas => source.derived(|| rows::with_points(&lines, &commas)),
        };
        let (root, problems) = rows::tree(text, &grid, columns);
        Ok(read::parsed(text, root, source, registry, problems.into_parts()))
    }

    fn writer(&self) -> Option<&dyn SceneWriter> {
        Some(self)
    }
}

impl SceneWriter for Csv {
    fn write(&self, scene: &Scene, target: &Target<'_>, registry: &Registry) -> Result<Vec<u8>, String> {
        let old = target.old.map(String::from_utf8_lossy);
        let text = write::table(&to_json(scene, None, registry), old.as_deref(), registry);
        if text.contains('\0') {
            return Err("a text in it has a zero character, which no table can hold".to_owned());
        }
        Ok(text.into_bytes())
    }
}
