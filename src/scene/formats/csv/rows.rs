//! Conversion from the cells of a table to the tree of values that JSON would give.

use std::ops::Range;

use jsonc_parser::{
    ast::{Array, BooleanLit, NumberLit, Object, ObjectPropName, StringLit},
    common,
};

use super::{
    columns::{Column, Columns, Part},
    grid::{Cell, Grid, Row, content},
    problems::Problems,
};
use crate::{
    scene::error::{Path, Problem},
    text::{
        did_you_mean, items,
        json::{Ast, ObjectProp},
        one_of, quoted, shortened,
    },
};

/// The rows below the header, with their parts; `None` for rows without a part.
fn parts<'g>(grid: &'g Grid, columns: &Columns) -> impl Iterator<Item = (&'g [Cell], Option<Part>)> {
    grid.rows[columns.heading + 1..].iter().filter_map(|row| match row {
        Row::Comment(_) => None,
        Row::Cells(cells) => {
            let name = cells.first().map(|cell| grid.content(cell)).unwrap_or_default();
            Some((cells.as_slice(), Part::ALL.into_iter().find(|part| part.name() == name)))
        }
    })
}

/// The bytes of the decimal commas; empty if commas separate columns.
pub(super) fn decimal_commas(grid: &Grid, columns: &Columns) -> Vec<usize> {
    let mut commas = Vec::new();
    if grid.separator == b',' {
        return commas;
    }
    for (cells, part) in parts(grid, columns) {
        let Some(part) = part else { continue };
        let numbers = columns
            .list
            .iter()
            .zip(&cells[1..])
            .filter(|(column, _)| column.as_ref().is_some_and(|column| !column.is_text(part)));
        for (_, cell) in numbers {
            let mut at = cell.range.start;
            for word in grid.text[cell.range.clone()].split([' ', ';', '\t', '[', ']']) {
                if let Some((whole, rest)) = word.split_once(',')
                    && is_number(&format!("{whole}.{rest}"))
                    && rest.starts_with(|c: char| c.is_ascii_digit())
                {
                    commas.push(at + whole.len());
                }
                at += word.len() + 1;
            }
        }
    }
    commas
}

/// The text with the commas at these bytes replaced by points.
pub(super) fn with_points(text: &str, commas: &[usize]) -> String {
    let mut pointed = text.to_owned();
    for at in commas {
        pointed.replace_range(at..&(at + 1), ".");
    }
    pointed
}

/// The scene in the rows of a table, and their problems.
pub(super) fn tree<'a>(text: &'a str, grid: &Grid, mut columns: Columns) -> (Ast<'a>, Problems) {
    let mut problems = std::mem::take(&mut columns.problems);
    let mut scene: Option<Vec<ObjectProp>> = None;
    let [mut lights, mut observers, mut objects] = [const { Vec::new() }; 3];
    for (cells, part) in parts(grid, &columns) {
        let at = cells.first().map_or(0, |cell| cell.range.start);
        let Some(part) = part else {
            problems.add(at, |hints| unknown_part(&content(text, &cells[0]), hints));
            continue;
        };
        let fields = fields(text, cells, &columns, part, &mut problems);
        let end = cells.last().map_or(at, |cell| cell.range.end);
        let row = || Object { range: range(&(at..end)), properties: Vec::new() };
        match part {
            Part::Scene if scene.is_some() => {
                let predicate = "is \"scene\", but there is a row for the scene above; a table has only one";
                problems.add(at, |_| Problem::about(Path::root().key("part"), predicate));
            }
            Part::Scene => scene = Some(fields),
            Part::Light => lights.push(Ast::Object(Object { properties: fields, ..row() })),
            Part::Observer => observers.push(Ast::Object(Object { properties: fields, ..row() })),
            Part::Object => objects.push(Ast::Object(Object { properties: fields, ..row() })),
        }
    }
    let mut properties = scene.unwrap_or_default();
    let whole = |rows: &[Ast]| {
        use common::Ranged as _;
        let start = rows.first().map_or(columns.start, |row| row.range().start);
        start..rows.last().map_or(start, |row| row.range().end)
    };
    if observers.len() == 1 {
        properties.extend(observers.pop().map(|observer| property(&whole(&[]), "observer", observer)));
    }
    for (key, rows) in [("lights", lights), ("observer", observers), ("objects", objects)] {
        if !rows.is_empty() {
            let place = whole(&rows);
            let list = Ast::Array(Array { range: range(&place), elements: rows });
            properties.push(property(&place, key, list));
        }
    }
    let root = Object { range: range(&(columns.start..text.len())), properties };
    (Ast::Object(root), problems)
}

fn unknown_part(written: &str, hints: bool) -> Problem {
    let names = Part::ALL.map(Part::name);
    let rule = one_of("the part of the scene in a row", names.into_iter());
    let hint = || did_you_mean(written, names.into_iter().map(|name| (name, name)));
    let path = Path::root().key("part");
    match written {
        "" => Problem::about(path, format!("is missing; {rule}")),
        _ if !hints => Problem::value(path, quoted(written), rule),
        _ => Problem::value(path, quoted(written), rule + &hint()),
    }
}

/// The fields of a row.
fn fields<'a>(
    text: &'a str,
    cells: &[Cell],
    columns: &Columns,
    part: Part,
    problems: &mut Problems,
) -> Vec<ObjectProp<'a>> {
    let mut fields: Vec<ObjectProp> = Vec::new();
    // Components come in any order.
    let mut spread: Vec<(&[&'static str], [Option<Ast>; 3], Range<usize>)> = Vec::new();
    for (i, cell) in cells[1..].iter().enumerate().filter(|(_, cell)| !cell.range.is_empty()) {
        let Some(column) = columns.list.get(i) else {
            problems.add(cell.range.start, |_| {
                let counts = (cells.len(), columns.list.len() + 1);
                let what = format!("has {} cells, but the header has {}", counts.0, counts.1);
                Problem::about(Path::root().key("row"), what)
            });
            break;
        };
        if columns.unnamed.contains(&i) {
            problems.add(cell.range.start, |_| {
                let written = quoted(&shortened(&content(text, cell)));
                let what = format!(
                    "has {written} in a column without a name; name it in the header, or empty the cell"
                );
                Problem::about(Path::root().key("row"), what)
            });
        }
        let Some(column) = column else { continue };
        let value = value(text, cell, column, part);
        match column.component {
            None => put(&mut fields, &column.keys, &cell.range, value),
            Some(component) => match spread.iter_mut().find(|(keys, ..)| *keys == column.keys) {
                Some((_, components, _)) => components[component] = Some(value),
                None => {
                    let mut components = [const { None }; 3];
                    components[component] = Some(value);
                    spread.push((column.keys.as_slice(), components, cell.range.clone()));
                }
            },
        }
    }
    for (keys, components, place) in spread {
        let elements = components.into_iter().flatten().collect();
        put(&mut fields, keys, &place, Ast::Array(Array { range: range(&place), elements }));
    }
    fields
}

/// Inserts a value under its keys, of which there are at most two.
fn put<'a>(fields: &mut Vec<ObjectProp<'a>>, keys: &[&'static str], place: &Range<usize>, value: Ast<'a>) {
    match keys {
        [outer, inner] => {
            let within = fields.iter_mut().find(|field| field.name.as_str() == *outer);
            if let Some(ObjectProp { value: Ast::Object(object), .. }) = within {
                object.properties.push(property(place, inner, value));
                return;
            }
            let properties = vec![property(place, inner, value)];
            let object = Ast::Object(Object { range: range(place), properties });
            fields.push(property(place, outer, object));
        }
        [key, ..] => fields.push(property(place, key, value)),
        [] => {}
    }
}

/// The value in a cell: text if the field is a text, and otherwise according to its appearance.
fn value<'a>(text: &'a str, cell: &Cell, column: &Column, part: Part) -> Ast<'a> {
    let place = range(&cell.range);
    let string = || Ast::StringLit(StringLit { range: place, value: content(text, cell) });
    if column.is_text(part) {
        return string();
    }
    let written = &text[cell.range.clone()];
    // Spreadsheets write these in capitals.
    for flag in [true, false] {
        if written.eq_ignore_ascii_case(if flag { "true" } else { "false" }) {
            return Ast::BooleanLit(BooleanLit { range: place, value: flag });
        }
    }
    let number = |(at, item): (usize, &'a str)| {
        let start = cell.range.start + at;
        Ast::NumberLit(NumberLit { range: range(&(start..start + item.len())), value: item })
    };
    match items(written).as_slice() {
        list if !list.iter().all(|(_, item)| is_number(item)) => string(),
        [one] => number(*one),
        list => Ast::Array(Array { range: place, elements: list.iter().copied().map(number).collect() }),
    }
}

/// True for numbers as people write them, but not for infinity and the like.
fn is_number(text: &str) -> bool {
    text.bytes().all(|b| b.is_ascii_digit() || b"+-.eE".contains(&b)) && text.parse::<f64>().is_ok()
}

fn property<'a>(place: &Range<usize>, key: &'static str, value: Ast<'a>) -> ObjectProp<'a> {
    let name = ObjectPropName::String(StringLit { range: range(place), value: key.into() });
    ObjectProp { range: range(place), name, value }
}

fn range(bytes: &Range<usize>) -> common::Range {
    common::Range::new(bytes.start, bytes.end)
}
