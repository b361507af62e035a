//! Tables of numbers on standard input: CSV with a header line, every problem with its line.

use std::io::{self, Read};

use super::Failure;
use crate::{
    reflection::parameter::ABOVE_ZERO,
    scene::{error::quoted, load::STDIN},
};

/// One line of a table: the text as it was written, and its numbers.
pub(super) struct Row<const N: usize> {
    /// The columns as written, without white space around them.
    pub text: [String; N],
    /// The same as numbers.
    pub numbers: [f64; N],
}

/// One column: its name, and what is allowed in it.
pub(super) struct Column {
    /// As the header must say.
    pub name: &'static str,
    /// Smallest and largest legal value; any finite number if there are none. [`ABOVE_ZERO`] is the
    /// smallest number that is greater than zero.
    pub range: Option<(f64, f64)>,
}

/// Reads a table from standard input.
pub(super) fn from_stdin<const N: usize>(columns: &[Column; N]) -> Result<Vec<Row<N>>, Failure> {
    let mut bytes = Vec::new();
    io::stdin()
        .lock()
        .read_to_end(&mut bytes)
        .map_err(|e| Failure::Invalid(format!("{STDIN} could not be read: {e}")))?;
    let text = String::from_utf8(bytes).map_err(|e| {
        Failure::Invalid(format!("{STDIN}: not UTF-8 text from byte {} on", e.utf8_error().valid_up_to()))
    })?;
    parse(&text, columns).map_err(|problems| Failure::Invalid(problems.join("\n")))
}

/// The rows of a table, or everything that is wrong with it.
pub(super) fn parse<const N: usize>(text: &str, columns: &[Column; N]) -> Result<Vec<Row<N>>, Vec<String>> {
    let names = columns.each_ref().map(|c| c.name);
    let header = names.join(",");
    // Spreadsheets put a byte order mark before CSV.
    let mut lines = text.trim_start_matches('\u{FEFF}').lines().enumerate();
    let Some((_, first)) = lines.next() else {
        return Err(vec![format!("{STDIN} is empty, but the first line must be the header {header}")]);
    };
    if !first.split(',').map(str::trim).eq(names) {
        return Err(vec![format!(
            "{STDIN}:1: the header is {}, but it must be {header}",
            quoted(first.trim())
        )]);
    }
    let mut rows = Vec::new();
    let mut problems = Vec::new();
    for (i, line) in lines.filter(|(_, line)| !line.trim().is_empty()) {
        let number = i + 1;
        let cells: Vec<_> = line.split(',').map(|cell| cell.trim().to_owned()).collect();
        let count = cells.len();
        let Ok(text) = <[String; N]>::try_from(cells) else {
            let columns = if count == 1 { "is 1 column".to_owned() } else { format!("are {count} columns") };
            problems.push(format!("{STDIN}:{number}: there {columns}, but there must be {N}: {header}"));
            continue;
        };
        let mut numbers = [0.0; N];
        let mut good = true;
        for ((cell, column), to) in text.iter().zip(columns).zip(&mut numbers) {
            match legal(cell, column) {
                Ok(value) => *to = value,
                Err(rule) => {
                    good = false;
                    problems.push(format!(
                        "{STDIN}:{number}: {} is {}, but {rule}",
                        column.name,
                        quoted(cell)
                    ));
                }
            }
        }
        if good {
            rows.push(Row { text, numbers });
        }
    }
    if problems.is_empty() { Ok(rows) } else { Err(problems) }
}

/// The number in a cell, or the rule that it breaks.
fn legal(cell: &str, column: &Column) -> Result<f64, String> {
    let value: f64 =
        cell.parse().ok().filter(|v: &f64| v.is_finite()).ok_or("it must be a finite number".to_owned())?;
    match column.range {
        Some((min, max)) if min == f64::from(ABOVE_ZERO) && !(min..=max).contains(&value) => {
            Err(format!("it must be greater than 0 and at most {max}"))
        }
        Some((min, max)) if !(min..=max).contains(&value) => {
            Err(format!("it must be between {min} and {max}"))
        }
        _ => Ok(value),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const COLUMNS: [Column; 2] =
        [Column { name: "a", range: Some((0.0, 90.0)) }, Column { name: "b", range: None }];

    #[test]
    fn a_table_is_read_as_spreadsheets_write_it() {
        let rows = parse("\u{FEFF}a, b\r\n1 ,-2.50\r\n\r\n90,1e3\r\n", &COLUMNS).expect("valid");
        assert_eq!(rows.len(), 2);
        assert_eq!(rows[0].text, ["1", "-2.50"]);
        assert_eq!(rows[1].numbers, [90.0, 1000.0]);
    }

    #[test]
    fn every_problem_has_its_line() {
        let problems = parse("a,b\n1,2\n91,x\n1\n1,2,3\nnan,inf\n", &COLUMNS).err().unwrap_or_default();
        assert_eq!(
            problems,
            [
                "standard input:3: a is \"91\", but it must be between 0 and 90",
                "standard input:3: b is \"x\", but it must be a finite number",
                "standard input:4: there is 1 column, but there must be 2: a,b",
                "standard input:5: there are 3 columns, but there must be 2: a,b",
                "standard input:6: a is \"nan\", but it must be a finite number",
                "standard input:6: b is \"inf\", but it must be a finite number",
            ]
        );
        assert!(parse("", &COLUMNS).err().unwrap_or_default()[0].contains("is empty"));
        assert!(parse("b,a\n", &COLUMNS).err().unwrap_or_default()[0].contains("the header is \"b,a\""));
    }
}
