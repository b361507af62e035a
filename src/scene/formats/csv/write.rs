//! Conversion from the tree of values of JSON to the rows of a table.

use std::{borrow::Cow, collections::HashSet};

use super::{
    columns::{self, Column, Columns, Part},
    grid::{Grid, Row},
    rows::decimal_commas,
};
use crate::{
    declared::with_defaults,
    registry::Registry,
    text::{
        json::{self, Ast, STRICT},
        with_line_feeds,
    },
};

with_defaults! {
    /// The properties of an existing table that are kept when it is written again.
    struct Manner {
        separator: char = ',',
        line_end: &'static str = "\n",
        has_mark: bool = false,
        decimal_comma: bool = false,
        /// The names of the columns.
        columns: Vec<String> = Vec::new(),
        /// The remarks, each with the part and index of the row after it; `None` for those at the end.
        remarks: Vec<(Option<Place>, String)> = Vec::new(),
    }
}

/// The position of a row: the heading, or the n-th row of a part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Place {
    Heading,
    Row(Part, usize),
}

impl Manner {
    /// The properties of a table; the defaults if the text is not a table.
    fn of(old: &str, registry: &Registry) -> Self {
        let text = old.trim_start_matches('\u{FEFF}');
        let text = &*with_line_feeds(text);
        let Ok(grid) = Grid::of(text) else { return Self::default() };
        let Ok(columns) = Columns::of(&grid, registry) else { return Self::default() };
        let mut manner = Self {
            separator: char::from(grid.separator),
            line_end: if ends_as_on_windows(text) { "\r\n" } else { "\n" },
            has_mark: text.len() < old.len(),
            decimal_comma: !decimal_commas(&grid, &columns).is_empty(),
            columns: columns.list.iter().flatten().map(|column| column.name.clone()).collect(),
            remarks: Vec::new(),
        };
        let mut counts = [0; Part::ALL.len()];
        let mut waiting = Vec::new();
        for (i, row) in grid.rows.iter().enumerate() {
            let place = match row {
                Row::Comment(range) => {
                    waiting.push(text[range.clone()].to_owned());
                    continue;
                }
                Row::Cells(_) if i == columns.heading => Place::Heading,
                Row::Cells(cells) => {
                    let name = grid.content(&cells[0]);
                    let Some(part) = Part::ALL.iter().position(|part| part.name() == name) else { continue };
                    counts[part] += 1;
                    Place::Row(Part::ALL[part], counts[part] - 1)
                }
            };
            manner.remarks.extend(waiting.drain(..).map(|remark| (Some(place), remark)));
        }
        manner.remarks.extend(waiting.into_iter().map(|remark| (None, remark)));
        manner
    }
}

/// True if the first line ends with a Windows line break.
fn ends_as_on_windows(text: &str) -> bool {
    text.find('\n').is_some_and(|at| text[..at].ends_with('\r'))
}

/// A row: its cells, each with the name of its column.
struct Cells {
    part: Part,
    list: Vec<(String, String)>,
}

/// The table of a scene, from its JSON.
pub(super) fn table(json: &str, old: Option<&str>, registry: &Registry) -> String {
    let manner = old.map_or_else(Manner::default, |old| Manner::of(old, registry));
    // It was written by the writer of JSON.
    let Ok(Some(Ast::Object(scene))) = json::parse(json, &STRICT) else { return String::new() };
    let known = columns::all(registry);
    let mut rows = vec![Cells { part: Part::Scene, list: Vec::new() }];
    for property in &scene.properties {
        let (part, values) = match (property.name.as_str(), &property.value) {
            ("lights", Ast::Array(list)) => (Part::Light, &list.elements[..]),
            ("objects", Ast::Array(list)) => (Part::Object, &list.elements[..]),
            ("observer", value) => (Part::Observer, std::slice::from_ref(value)),
            (key, value) => {
                flatten(key, value, json, &manner, &known, &mut rows[0].list);
                continue;
            }
        };
        for value in values {
            let mut list = Vec::new();
            flatten("", value, json, &manner, &known, &mut list);
            rows.push(Cells { part, list });
        }
    }
    let names = names(&rows, &manner, known);
    let mut out = String::with_capacity(json.len());
    if manner.has_mark {
        out.push('\u{FEFF}');
    }
    remarks(&manner, |place| place == Some(Place::Heading), &mut out);
    line([columns::PART].into_iter().chain(names.iter().map(String::as_str)), &manner, &mut out);
    let mut counts = [0; Part::ALL.len()];
    for Cells { part, list } in &rows {
        let count = &mut counts[*part as usize];
        remarks(&manner, |place| place == Some(Place::Row(*part, *count)), &mut out);
        *count += 1;
        let cell = |name: &String| list.iter().find(|(n, _)| n == name).map_or("", |(_, cell)| cell.as_str());
        line([part.name()].into_iter().chain(names.iter().map(cell)), &manner, &mut out);
    }
    // Comments on removed rows stay too.
    let gone = |place: Option<Place>| match place {
        None => true,
        Some(Place::Heading) => false,
        Some(Place::Row(part, i)) => i >= counts[part as usize],
    };
    remarks(&manner, gone, &mut out);
    out
}

/// The values within a value, each as a cell with the name of its column.
fn flatten(
    name: &str,
    value: &Ast,
    json: &str,
    manner: &Manner,
    known: &[Column],
    cells: &mut Vec<(String, String)>,
) {
    use jsonc_parser::common::Ranged as _;
    let number = |value: &Ast| {
        let text = value.text(json);
        if manner.decimal_comma { text.replace('.', ",") } else { text.to_owned() }
    };
    match value {
        Ast::Object(object) => {
            for property in &object.properties {
                let key = property.name.as_str();
                let inner = if name.is_empty() { key.to_owned() } else { format!("{name}.{key}") };
                flatten(&inner, &property.value, json, manner, known, cells);
            }
        }
        Ast::Array(list) => {
            let column = known.iter().find(|column| column.name == name);
            let each = column.map_or(&[][..], |column| &column.components);
            let has = |name: &str| manner.columns.iter().any(|column| column == name);
            let is_spread =
                each.iter().any(|name| has(name)) || column.is_some_and(Column::is_spread) && !has(name);
            if is_spread {
                cells.extend(each.iter().cloned().zip(list.elements.iter().map(number)));
            } else {
                let all: Vec<_> = list.elements.iter().map(number).collect();
                cells.push((name.to_owned(), all.join(" ")));
            }
        }
        Ast::StringLit(text) => cells.push((name.to_owned(), text.value.clone().into_owned())),
        other => cells.push((name.to_owned(), number(other))),
    }
}

/// The columns of the table: the existing ones, and those that are needed.
fn names(rows: &[Cells], manner: &Manner, known: Vec<Column>) -> Vec<String> {
    let used: HashSet<&str> = rows.iter().flat_map(|row| row.list.iter().map(|(n, _)| n.as_str())).collect();
    let mut names = manner.columns.clone();
    for column in known {
        if used.contains(column.name.as_str()) && !names.contains(&column.name) {
            names.push(column.name);
        }
    }
    names
}

/// Writes the remarks at the selected positions.
fn remarks(manner: &Manner, of: impl Fn(Option<Place>) -> bool, out: &mut String) {
    for (_, remark) in manner.remarks.iter().filter(|(place, _)| of(*place)) {
        out.push_str(remark);
        out.push_str(manner.line_end);
    }
}

fn line<'c>(cells: impl Iterator<Item = &'c str>, manner: &Manner, out: &mut String) {
    for (i, cell) in cells.enumerate() {
        if i > 0 {
            out.push(manner.separator);
        }
        out.push_str(&escaped(cell, manner.separator));
    }
    out.push_str(manner.line_end);
}

/// A cell, in quotation marks if necessary.
fn escaped(cell: &str, separator: char) -> Cow<'_, str> {
    if cell.contains([separator, '"', '\n', '\r']) || cell != cell.trim() {
        return format!("\"{}\"", cell.replace('"', "\"\"")).into();
    }
    cell.into()
}
