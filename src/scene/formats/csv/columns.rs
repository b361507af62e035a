//! The columns of a table: every field of every part of a scene, by its path.

use std::{collections::HashSet, fmt::Write as _};

use super::{
    grid::{Cell, Grid, Row},
    problems::Problems,
};
use crate::{
    declared::texts,
    parameter::Parameter,
    registry::Registry,
    scene::{
        Display, Field, Light, Object, Observer, Scene, SceneSize,
        error::{Path, Problem},
        field::{AXES, Kind},
        part::Structure as _,
        read::keys::OTHER_WORDS,
    },
    text::{did_you_mean, json::canonical, shortened},
};

/// The name of the first column.
pub(super) const PART: &str = "part";

texts! {
    /// The kinds of rows, by the names in the first column.
    Part(
        /// The name in the first column.
        name
    ) {
        Scene = "scene",
        Light = "light",
        Observer = "observer",
        Object = "object",
    }
}

impl Part {
    pub(super) const ALL: [Self; 4] = [Self::Scene, Self::Light, Self::Observer, Self::Object];

    /// The fields of the part.
    fn fields(self) -> &'static [&'static Field] {
        [Scene::FIELDS, Light::FIELDS, Observer::FIELDS, Object::FIELDS][self as usize]
    }
}

/// A column that a table may have.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Column {
    /// The name in the first line of the table.
    pub(super) name: String,
    /// The path of the field within the part: `material`, `k_d`.
    pub(super) keys: Vec<&'static str>,
    /// The index in the list if the column is one component of it.
    pub(super) component: Option<usize>,
    /// The names of the components of the list.
    entries: &'static [&'static str],
    /// The names of the columns of the components.
    pub(super) components: Vec<String>,
    /// The parts in which a field of this name is a text.
    texts: Vec<Part>,
    /// The parts that have the field.
    pub(super) of: Vec<Part>,
}

impl Column {
    /// True if a cell of this column is a text even if it looks like a number.
    pub(super) fn is_text(&self, part: Part) -> bool {
        self.texts.contains(&part)
    }

    /// True if each component has its own column in a new table: coordinates have, colours have not.
    pub(super) fn is_spread(&self) -> bool {
        self.entries == AXES
    }
}

/// All columns that a table may have, in the order of a new table.
pub(super) fn all(registry: &Registry) -> Vec<Column> {
    collected(|all| fill(all, registry))
}

/// The columns that a function adds.
fn collected(fill: impl Fn(&mut All)) -> Vec<Column> {
    // Components keep clear of the names of all fields.
    let mut fields = All::default();
    fill(&mut fields);
    let names = fields.list.into_iter().filter(|column| column.component.is_none()).map(|column| column.name);
    let mut all = All { fields: names.collect(), ..All::default() };
    fill(&mut all);
    all.list
}

fn fill(all: &mut All, registry: &Registry) {
    for key in ["type", "name"] {
        for part in Part::ALL {
            let field = part.fields().iter().find(|field| field.key == key);
            field.into_iter().for_each(|field| all.field(part, None, field));
        }
    }
    for part in [Part::Observer, Part::Light, Part::Object] {
        let own = |field: &&&Field| !matches!(field.kind, Kind::Material | Kind::Parameters | Kind::Part);
        part.fields().iter().filter(own).for_each(|field| all.field(part, None, field));
        match part {
            Part::Light => registry.lights().iter().for_each(|l| all.parameters(part, &[], l.parameters)),
            Part::Object => registry.shapes().iter().for_each(|s| all.parameters(part, &[], s.parameters)),
            _ => {}
        }
    }
    all.field(Part::Scene, None, &Scene::reflection_model);
    all.field(Part::Scene, None, &Scene::shading_model);
    registry.material_users().for_each(|(_, p)| all.parameters(Part::Object, &["material"], p));
    for (within, fields) in [(&Scene::scene_size, SceneSize::FIELDS), (&Scene::display, Display::FIELDS)] {
        fields.iter().for_each(|field| all.field(Part::Scene, Some(within), field));
    }
    all.field(Part::Scene, None, &Scene::description);
}

#[derive(Default)]
struct All {
    /// The columns collected so far.
    list: Vec<Column>,
    /// The names of the columns of whole fields.
    fields: HashSet<String>,
}

impl All {
    fn parameters(&mut self, part: Part, before: &[&'static str], parameters: &'static [Parameter]) {
        for p in parameters {
            let keys: Vec<_> = before.iter().copied().chain([p.name]).collect();
            self.add(part, keys, p.kind.entries(), p.kind.is_text());
        }
    }

    fn field(&mut self, part: Part, within: Option<&Field>, field: &Field) {
        let keys = within.into_iter().chain([field]).map(|field| field.key).collect();
        self.add(part, keys, field.kind.entries(), field.kind.is_text());
    }

    fn add(&mut self, part: Part, keys: Vec<&'static str>, entries: &'static [&'static str], is_text: bool) {
        let (name, component, texts, of) = (keys.join("."), None, Vec::new(), Vec::new());
        // Lists under one key have one set of columns.
        let same = |known: &&Column| known.name == name && known.component.is_none();
        let listed = |known: &Column| if known.entries.is_empty() { entries } else { known.entries };
        let entries =
            if entries.is_empty() { entries } else { self.list.iter().find(same).map_or(entries, listed) };
        let components = self.components(&name, entries);
        let whole = Column { name, keys, component, entries, components, texts, of };
        let each = whole.components.iter().cloned().enumerate();
        let each = each.map(|(i, name)| Column { name, component: Some(i), ..whole.clone() });
        for column in [whole.clone()].into_iter().chain(each) {
            let same = |known: &Column| (&known.name, known.component) == (&column.name, column.component);
            let at = self.list.iter().position(same).unwrap_or_else(|| {
                self.list.push(column);
                self.list.len() - 1
            });
            let column = &mut self.list[at];
            // A key may stand for one number in some parts, and for a list in others.
            if column.entries.is_empty() {
                (column.entries, column.components) = (entries, whole.components.clone());
            }
            if is_text && !column.texts.contains(&part) {
                column.texts.push(part);
            }
            if !column.of.contains(&part) {
                column.of.push(part);
            }
        }
    }
}

impl All {
    /// The names of the columns of components: with the first letter of each, or where that is not enough to tell all
    /// columns apart, with its name or its number.
    fn components(&self, name: &str, entries: &[&str]) -> Vec<String> {
        let letters = entries.iter().map(|entry| entry.chars().take(1).collect::<String>()).collect();
        let words = entries.iter().map(ToString::to_string).collect();
        let numbers = (1..=entries.len()).map(|i| i.to_string()).collect();
        let named = |each: Vec<String>| each.iter().map(|one| format!("{name}.{one}")).collect();
        let apart = |all: &Vec<String>| {
            all.iter().enumerate().all(|(i, one)| !all[..i].contains(one) && !self.fields.contains(one))
        };
        [letters, words, numbers].into_iter().map(named).find(apart).unwrap_or_default()
    }
}

/// The columns of a table.
pub(super) struct Columns {
    /// The columns after the first; `None` for unknown ones.
    pub(super) list: Vec<Option<Column>>,
    /// The indices of columns without a name.
    pub(super) unnamed: HashSet<usize>,
    /// The index of the heading's row in the grid.
    pub(super) heading: usize,
    /// The index of the heading's first byte.
    pub(super) start: usize,
    /// The problems of unknown names and of names given twice.
    pub(super) problems: Problems,
}

impl Columns {
    /// The columns in the heading of a table. The error is a byte index and the reason why the table has no
    /// heading.
    pub(super) fn of(grid: &Grid, registry: &Registry) -> Result<Self, (usize, String)> {
        let rows = grid.rows.iter().enumerate();
        let heading = rows
            .filter_map(|(i, row)| if let Row::Cells(cells) = row { Some((i, cells)) } else { None })
            .next();
        let expected = "the first line must name the columns, the first of them part: \
                        part,type,position.x,position.y,position.z";
        let Some((heading, cells)) = heading else { return Err((0, expected.to_owned())) };
        let start = cells.first().map_or(0, |cell| cell.range.start);
        if cells.first().is_none_or(|cell| grid.content(cell) != PART) {
            return Err((start, expected.to_owned()));
        }
        let known = all(registry);
        let names: Vec<_> = known.iter().map(|column| column.name.as_str()).collect();
        let (list, unnamed, problems) = (Vec::new(), HashSet::new(), Problems::default());
        let mut columns = Self { list, unnamed, heading, start, problems };
        let mut seen: Vec<&str> = Vec::new();
        for cell in &cells[1..] {
            let written = grid.content(cell);
            let found = canonical(&written, &names).and_then(|name| known.iter().find(|c| c.name == name));
            let column = found.filter(|column| !seen.contains(&column.name.as_str()));
            if let Some(again) = found.filter(|_| column.is_none()) {
                let twice = format!("is given twice: there is another column {}", again.name);
                columns.report(cell, &written, |_| twice);
            } else if written.is_empty() {
                columns.unnamed.insert(columns.list.len());
            } else if column.is_none() {
                let hint = |hints| if hints { hint(&written, &known) } else { String::new() };
                columns.report(cell, &written, |hints| format!("is not a column{}", hint(hints)));
            }
            seen.extend(column.map(|column| column.name.as_str()));
            columns.list.push(column.cloned());
        }
        Ok(columns)
    }

    fn report(&mut self, cell: &Cell, written: &str, predicate: impl FnOnce(bool) -> String) {
        self.problems.add(cell.range.start, |hints| {
            let written = shortened(written);
            let path = written.split('.').fold(Path::root(), |path, key| path.key(key.to_owned()));
            Problem::about(path, predicate(hints))
        });
    }
}

/// The nearest name of a column, by its last word or by the name in other programs.
fn hint(written: &str, known: &[Column]) -> String {
    let names = known.iter().map(|column| (column.name.as_str(), column.name.as_str()));
    let last = |column: &Column| column.name.rsplit_once('.').map_or(0, |(before, _)| before.len() + 1);
    let short = known.iter().map(|column| (&column.name[last(column)..], column.name.as_str()));
    let others = OTHER_WORDS.iter().filter_map(|(word, key)| {
        known.iter().find(|column| column.name == *key).map(|column| (*word, column.name.as_str()))
    });
    match did_you_mean(&written.replace("color", "colour"), names.chain(short).chain(others)) {
        none if none.is_empty() => "; columns have the names of fields in scene files".to_owned(),
        hint => hint,
    }
}

/// The columns of the built-in parts as a table in Markdown, without those of parameters.
#[must_use]
pub fn table(registry: &Registry) -> String {
    let mut text = "| column | rows |\n|---|---|\n".to_owned();
    let parameters = |column: &Column| {
        let key = column.keys.last().copied().unwrap_or_default();
        let lights = registry.lights().iter().any(|l| l.parameter(key).is_some());
        let shapes = registry.shapes().iter().any(|s| s.parameter(key).is_some());
        column.keys[0] == "material" || (lights || shapes) && !column.is_spread()
    };
    for column in all(registry).iter().filter(|column| column.component.is_none() && !parameters(column)) {
        let spread: String = column.components.iter().map(|name| format!(", `{name}`")).collect();
        let rows: Vec<_> = column.of.iter().map(|part| part.name()).collect();
        // Writing to a String cannot fail.
        let _ = writeln!(text, "| `{}`{spread} | {} |", column.name, rows.join(", "));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn components_that_share_a_letter_or_the_name_of_a_field_are_kept_apart() {
        let names = |fill: fn(&mut All)| collected(fill).into_iter().map(|c| c.name).collect::<Vec<_>>();
        let found = names(|all| {
            all.add(Part::Light, vec!["tint"], &["red", "green", "blue"], false);
            all.add(Part::Light, vec!["grain"], &["red", "rough", "ridge"], false);
            all.add(Part::Light, vec!["material"], &["red", "green", "blue"], false);
            all.add(Part::Light, vec!["scale"], &["x", "y"], false);
            all.add(Part::Object, vec!["material", "r"], &[], false);
            all.add(Part::Object, vec!["scale", "x"], &[], false);
        });
        let tint = ["tint", "tint.r", "tint.g", "tint.b"];
        let grain = ["grain", "grain.red", "grain.rough", "grain.ridge"];
        let material = ["material", "material.red", "material.green", "material.blue"];
        let scale = ["scale", "scale.1", "scale.2"];
        let expected = [&tint[..], &grain, &material, &scale, &["material.r", "scale.x"]].concat();
        assert_eq!(found, expected);
    }

    #[test]
    fn a_key_that_is_a_number_in_one_part_is_a_list_in_another() {
        let all = collected(|all| {
            all.add(Part::Light, vec!["size"], &[], false);
            all.add(Part::Object, vec!["size"], &AXES, false);
        });
        let of: Vec<_> = all.iter().map(|column| (&*column.name, column.component, &*column.of)).collect();
        let object = &[Part::Object][..];
        let each = [("size.x", Some(0), object), ("size.y", Some(1), object), ("size.z", Some(2), object)];
        assert_eq!(of, [&[("size", None, &[Part::Light, Part::Object][..])], &each[..]].concat());
        assert!(all[0].is_spread() && all[0].components.len() == 3);
    }
}
