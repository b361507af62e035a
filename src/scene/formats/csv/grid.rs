//! Cells and their positions: CSV according to RFC 4180, with the separators of spreadsheets.

use std::{borrow::Cow, ops::Range};

use super::Csv;
use crate::{light::MAX_LIGHTS, scene::MAX_OBJECTS};

/// The separators of columns, the usual one first.
const SEPARATORS: [u8; 3] = [b',', b';', b'\t'];

/// A cell.
#[derive(Clone, Debug)]
pub(super) struct Cell {
    /// The bytes of the content, without quotation marks around it and white space outside them.
    pub(super) range: Range<usize>,
    /// True if the cell is in quotation marks.
    quoted: bool,
}

/// A line of the table; a cell may have line breaks.
#[derive(Clone, Debug)]
pub(super) enum Row {
    /// A remark: the byte range of the whole line.
    Comment(Range<usize>),
    /// Cells, of which at least one is not empty.
    Cells(Vec<Cell>),
}

/// A text as a table.
pub(super) struct Grid<'a> {
    pub(super) text: &'a str,
    pub(super) separator: u8,
    /// The rows in the order of the text, without empty ones.
    pub(super) rows: Vec<Row>,
    /// The number of rows that are not remarks.
    filled: usize,
    /// The number of all cells and remarks.
    cells: usize,
}

impl<'a> Grid<'a> {
    /// The table in a text. The error is a byte index and the reason why the text is not a table.
    pub(super) fn of(text: &'a str) -> Result<Self, (usize, String)> {
        let mut grid = Self { text, separator: separator(text), rows: Vec::new(), filled: 0, cells: 0 };
        let mut at = 0;
        while at < text.len() {
            let start = at;
            at = grid.row(at)?;
            if grid.filled > Csv::MAX_ROWS {
                let what = format!(
                    "the table has more than {} rows; a scene has at most {MAX_LIGHTS} lights and {MAX_OBJECTS} \
                     objects",
                    Csv::MAX_ROWS
                );
                return Err((start, what));
            }
        }
        Ok(grid)
    }

    /// Counts a cell or a remark at this byte.
    fn count(&mut self, at: usize) -> Result<(), (usize, String)> {
        self.cells += 1;
        match self.cells {
            ..=Csv::MAX_CELLS => Ok(()),
            _ => Err((
                at,
                format!("the table has more than {} cells and remarks, the most allowed", Csv::MAX_CELLS),
            )),
        }
    }

    /// The content of a cell.
    pub(super) fn content(&self, cell: &Cell) -> Cow<'a, str> {
        content(self.text, cell)
    }

    /// Reads the row at this byte; returns the index of the byte after it.
    fn row(&mut self, start: usize) -> Result<usize, (usize, String)> {
        let bytes = self.text.as_bytes();
        let end_of_line =
            |from: usize| bytes[from..].iter().position(|b| *b == b'\n').map_or(bytes.len(), |n| from + n);
        if bytes[start] == b'#' {
            let end = end_of_line(start);
            self.count(start)?;
            self.rows.push(Row::Comment(start..trimmed(self.text, start..end).end));
            return Ok(end + 1);
        }
        let mut cells = Vec::new();
        let mut at = start;
        let end = loop {
            self.count(at)?;
            let (cell, after) = self.cell(at)?;
            if cells.len() == Csv::MAX_COLUMNS {
                return Err((
                    at,
                    format!("the row has more than {} columns, the most allowed", Csv::MAX_COLUMNS),
                ));
            }
            cells.push(cell);
            match bytes.get(after) {
                Some(b) if *b == self.separator => at = after + 1,
                _ => break after,
            }
        };
        let is_empty = |cell: &Cell| cell.range.is_empty();
        match cells.split_first() {
            // A spreadsheet puts a remark with a comma in quotation marks, and as many separators behind it as the
            // table has columns.
            Some((first, rest))
                if self.text[first.range.clone()].starts_with('#') && rest.iter().all(is_empty) =>
            {
                self.rows.push(Row::Comment(trimmed(self.text, start..end)));
            }
            _ if cells.iter().all(is_empty) => {}
            _ => {
                self.filled += 1;
                self.rows.push(Row::Cells(cells));
            }
        }
        Ok(end + 1)
    }

    /// Reads the cell at this byte; returns the index of the separator or line break after it.
    fn cell(&self, start: usize) -> Result<(Cell, usize), (usize, String)> {
        let bytes = self.text.as_bytes();
        let ends = |b: u8| b == self.separator || b == b'\n';
        let blank = |b: u8| !ends(b) && matches!(b, b' ' | b'\t' | b'\r');
        let skip =
            |from: usize| bytes[from..].iter().position(|b| !blank(*b)).map_or(bytes.len(), |n| from + n);
        let open = skip(start);
        if bytes.get(open) != Some(&b'"') {
            let end = bytes[start..].iter().position(|b| ends(*b)).map_or(bytes.len(), |n| start + n);
            return Ok((Cell { range: trimmed(self.text, start..end), quoted: false }, end));
        }
        let mut at = open + 1;
        loop {
            match (bytes.get(at), bytes.get(at + 1)) {
                (None, _) => {
                    let what = "the quotation mark that opens here (\") is not closed; write \"\" for one within a text";
                    return Err((open, what.to_owned()));
                }
                (Some(b'"'), Some(b'"')) => at += 2,
                (Some(b'"'), _) => break,
                _ => at += 1,
            }
        }
        let after = skip(at + 1);
        if bytes.get(after).is_some_and(|b| !ends(*b)) {
            let what =
                "expected the next column after the closing quotation mark; write \"\" for one within a text";
            return Err((after, what.to_owned()));
        }
        Ok((Cell { range: open + 1..at, quoted: true }, after))
    }
}

/// The content of a cell in this text.
pub(super) fn content<'t>(text: &'t str, cell: &Cell) -> Cow<'t, str> {
    let content = &text[cell.range.clone()];
    if cell.quoted && content.contains("\"\"") {
        content.replace("\"\"", "\"").into()
    } else {
        content.into()
    }
}

/// A range without white space at its ends.
fn trimmed(text: &str, range: Range<usize>) -> Range<usize> {
    let all = &text[range.clone()];
    let start = range.start + (all.len() - all.trim_start().len());
    start..start + all.trim().len()
}

/// The separator that gives the most columns in the first line that is not a remark.
fn separator(text: &str) -> u8 {
    let is_remark = |line: &str| line.trim_start_matches('"').starts_with('#');
    let first = text.lines().find(|line| !line.trim().is_empty() && !is_remark(line)).unwrap_or_default();
    let count = |separator: u8| first.bytes().filter(|b| *b == separator).count();
    // Among equal counts, `max_by_key` returns the last.
    SEPARATORS.into_iter().rev().max_by_key(|separator| count(*separator)).unwrap_or(b',')
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cells(text: &str) -> Vec<Vec<String>> {
        let grid = Grid::of(text).unwrap_or_else(|e| panic!("{e:?}"));
        grid.rows
            .iter()
            .filter_map(|row| match row {
                Row::Comment(_) => None,
                Row::Cells(cells) => Some(cells.iter().map(|c| grid.content(c).into_owned()).collect()),
            })
            .collect()
    }

    #[test]
    fn cells_are_read_as_spreadsheets_write_them() {
        for text in [
            "part,name\nlight,\"a, \"\"b\"\"\"\n",
            "part;name\r\nlight;\"a, \"\"b\"\"\"\r\n",
            "part\tname\nlight\t a, \"b\" ",
            "# a, remark\n\n\"part\" , \"name\"\n,\n\"# b, c\",\nlight,\"a, \"\"b\"\"\" \n",
        ] {
            assert_eq!(cells(text), [["part", "name"], ["light", "a, \"b\""]], "{text:?}");
        }
        assert_eq!(cells("part,name\nlight,\"two\nlines\"\n")[1][1], "two\nlines");
    }

    #[test]
    fn quotation_marks_that_do_not_match_are_reported_where_they_stand() {
        let mistake = |text: &str| Grid::of(text).err().unwrap_or_default();
        assert!(mistake("part,name\nlight,\"a\n").1.contains("is not closed"));
        assert_eq!(mistake("part,name\nlight,\"a\n").0, 16);
        assert!(mistake("part,\"name\" x\n").1.contains("expected the next column"));
        assert_eq!(mistake("part,\"name\" x\n").0, 12);
    }
}
