//! Tables of numbers on standard input: CSV with a header line; every problem is reported with its line.
//! Input may be endless: rows are answered as they arrive, and neither lines nor problems grow without bound.

use std::io::{BufRead, Read as _};

use super::Outcome;
use crate::{failure::Failure, files::words, parameter::ABOVE_ZERO, scene::load::STDIN, text::quoted};

/// Maximum length of a line, in bytes: four numbers, each written out in full, take a fraction of it.
const MAX_LINE: usize = 4096;
/// Number of rows answered at a time; fewer if their text is long.
const BATCH_ROWS: usize = 16_384;
/// Approximate size of the text in a batch, in bytes.
const BATCH_BYTES: usize = 1 << 20;
/// Maximum number of problems listed; the rest are only counted.
const MAX_LISTED: usize = 20;
/// Number of problems after which reading stops.
const MAX_PROBLEMS: usize = 1_000_000;

/// One line of a table: its text and its numbers.
pub(super) struct Row<const N: usize> {
    /// The columns as written, trimmed.
    pub text: [String; N],
    /// The columns as numbers.
    pub numbers: [f64; N],
}

/// A column: its name and its legal values.
pub(super) struct Column {
    /// Name required in the header.
    pub name: &'static str,
    /// Minimum and maximum; `None` for any finite number. [`ABOVE_ZERO`] is the smallest number that is
    /// greater than zero.
    pub range: Option<(f64, f64)>,
}

/// Reads a table and answers its rows in batches, in order; the last batch may be empty. After the first
/// problem nothing more is answered, but the rest is read to find other problems. A table with a problem in
/// its first batch gets no answers.
///
/// # Errors
/// Returns all problems of the table, or the failure of an answer.
pub(super) fn stream<const N: usize>(
    input: impl BufRead,
    columns: &[Column; N],
    mut answer: impl FnMut(&[Row<N>]) -> Outcome,
) -> Outcome {
    let mut table = Table { input, columns, lines: 0, bytes: 0, problems: Problems::default() };
    table.header()?;
    let mut batch = Vec::new();
    let mut bytes = 0;
    while table.problems.count < MAX_PROBLEMS
        && let Some(line) = table.line()?
    {
        if line.trim().is_empty() {
            continue;
        }
        bytes += line.len();
        // Earlier rows are kept only while there are no problems.
        match table.row(&line) {
            Some(row) if table.problems.count == 0 => batch.push(row),
            _ => batch.clear(),
        }
        if batch.len() >= BATCH_ROWS || bytes >= BATCH_BYTES && !batch.is_empty() {
            answer(&batch)?;
            batch.clear();
            bytes = 0;
        }
    }
    if table.problems.count > 0 {
        return Err(table.problems.failure());
    }
    answer(&batch)
}

/// The problems of a table: the first ones, and the number of all.
#[derive(Default)]
struct Problems {
    listed: Vec<String>,
    count: usize,
}

impl Problems {
    fn add(&mut self, problem: String) {
        self.count += 1;
        if self.listed.len() < MAX_LISTED {
            self.listed.push(problem);
        }
    }

    /// All problems in one failure, a line each.
    fn failure(&self) -> Failure {
        let mut lines = self.listed.clone();
        match self.count - lines.len() {
            0 => {}
            1 => lines.push(format!("{STDIN}: 1 more problem")),
            more => {
                let least = if self.count < MAX_PROBLEMS { "" } else { "at least " };
                lines.push(format!("{STDIN}: {least}{more} more problems"));
            }
        }
        Failure::Invalid(lines.join("\n"))
    }
}

/// A table that is being read.
struct Table<'a, R, const N: usize> {
    input: R,
    columns: &'a [Column; N],
    /// Number of lines read.
    lines: usize,
    /// Number of bytes read.
    bytes: usize,
    problems: Problems,
}

impl<R: BufRead, const N: usize> Table<'_, R, N> {
    /// Ends reading with a problem, reported after those before it.
    fn give_up(&mut self, problem: String) -> Failure {
        self.problems.add(problem);
        self.problems.failure()
    }

    /// The next line, with its line end.
    fn line(&mut self) -> Result<Option<String>, Failure> {
        let mut line = Vec::new();
        if let Err(e) = (&mut self.input).take(MAX_LINE as u64 + 1).read_until(b'\n', &mut line) {
            return Err(self.give_up(format!("{STDIN} could not be read: {}", words(&e))));
        }
        if line.is_empty() {
            return Ok(None);
        }
        self.lines += 1;
        if line.len() > MAX_LINE {
            let number = self.lines;
            return Err(self.give_up(format!(
                "{STDIN}:{number}: the line is longer than {MAX_LINE} bytes, too long for a row of numbers"
            )));
        }
        let begin = self.bytes;
        self.bytes += line.len();
        String::from_utf8(line).map(Some).map_err(|e| {
            let at = begin + e.utf8_error().valid_up_to();
            self.give_up(format!("{STDIN}: not UTF-8 at byte {at}"))
        })
    }

    fn names(&self) -> [&'static str; N] {
        self.columns.each_ref().map(|c| c.name)
    }

    /// Reads the first line.
    fn header(&mut self) -> Outcome {
        let names = self.names();
        let header = names.join(",");
        let Some(first) = self.line()? else {
            return Err(
                self.give_up(format!("{STDIN} is empty, but the first line must be the header {header}"))
            );
        };
        // Spreadsheets write a byte order mark before CSV.
        let first = first.trim_start_matches('\u{FEFF}').trim();
        if first.split(',').map(str::trim).eq(names) {
            return Ok(());
        }
        Err(self.give_up(format!("{STDIN}:1: the header is {}, but it must be {header}", quoted(first))))
    }

    /// The row in a line, if it is valid.
    fn row(&mut self, line: &str) -> Option<Row<N>> {
        let number = self.lines;
        let cells: Vec<_> = line.split(',').map(|cell| cell.trim().to_owned()).collect();
        let count = cells.len();
        let Ok(text) = <[String; N]>::try_from(cells) else {
            let columns = if count == 1 { "is 1 column".to_owned() } else { format!("are {count} columns") };
            let header = self.names().join(",");
            self.problems.add(format!("{STDIN}:{number}: there {columns}, but there must be {N}: {header}"));
            return None;
        };
        let mut numbers = [0.0; N];
        let mut good = true;
        for ((cell, column), to) in text.iter().zip(self.columns).zip(&mut numbers) {
            match legal(cell, column) {
                Ok(value) => *to = value,
                Err(rule) => {
                    good = false;
                    let name = column.name;
                    self.problems.add(format!("{STDIN}:{number}: {name} is {}, but {rule}", quoted(cell)));
                }
            }
        }
        good.then_some(Row { text, numbers })
    }
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

    /// The rows of a table, or all its problems.
    fn parse<const N: usize>(text: &str, columns: &[Column; N]) -> Result<Vec<Row<N>>, Vec<String>> {
        let mut rows = Vec::new();
        let copy = |row: &Row<N>| Row { text: row.text.clone(), numbers: row.numbers };
        let read = stream(text.as_bytes(), columns, |batch| {
            rows.extend(batch.iter().map(copy));
            Ok(())
        });
        match read {
            Ok(()) => Ok(rows),
            Err(Failure::Invalid(problems)) => Err(problems.lines().map(str::to_owned).collect()),
            Err(other) => panic!("{other:?}"),
        }
    }

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

    #[test]
    fn a_long_table_is_answered_in_batches_and_in_order() {
        let mut text = "a,b\n".to_owned();
        let count = 2 * BATCH_ROWS + 7;
        (0..count).for_each(|i| text.push_str(&format!("1,{i}\n")));
        let mut sizes = Vec::new();
        let mut next = 0;
        let read = stream(text.as_bytes(), &COLUMNS, |batch| {
            sizes.push(batch.len());
            for row in batch {
                assert_eq!(row.numbers[1], f64::from(next));
                next += 1;
            }
            Ok(())
        });
        assert!(read.is_ok());
        assert_eq!(sizes, [BATCH_ROWS, BATCH_ROWS, 7]);
        // Long lines make batches smaller.
        let row = format!("1,2{}\n", " ".repeat(4000));
        let mut sizes = Vec::new();
        let read = stream(format!("a,b\n{}", row.repeat(1000)).as_bytes(), &COLUMNS, |batch| {
            sizes.push(batch.len());
            Ok(())
        });
        assert!(read.is_ok());
        assert!(sizes.len() > 3 && sizes.iter().sum::<usize>() == 1000, "{sizes:?}");
    }

    #[test]
    fn after_a_problem_nothing_is_answered() {
        let mut answered = 0;
        let text = format!("a,b\n{}x,1\n{}", "1,2\n".repeat(BATCH_ROWS + 5), "1,2\n".repeat(BATCH_ROWS));
        let read = stream(text.as_bytes(), &COLUMNS, |batch| {
            answered += batch.len();
            Ok(())
        });
        assert!(matches!(read, Err(Failure::Invalid(problem)) if problem.contains("a is \"x\"")));
        assert_eq!(answered, BATCH_ROWS);
    }

    #[test]
    fn problems_and_lines_are_bounded() {
        let problems = parse(&format!("a,b\n{}", "x,1\n".repeat(25)), &COLUMNS).err().unwrap_or_default();
        assert_eq!(problems.len(), MAX_LISTED + 1);
        assert_eq!(problems[MAX_LISTED], "standard input: 5 more problems");
        let problems = parse(&format!("a,b\n{}", "x,1\n".repeat(21)), &COLUMNS).err().unwrap_or_default();
        assert_eq!(problems[MAX_LISTED], "standard input: 1 more problem");
        let long = format!("a,b\n1,{}\n", "0".repeat(MAX_LINE));
        let problems = parse(&long, &COLUMNS).err().unwrap_or_default();
        assert_eq!(
            problems,
            ["standard input:2: the line is longer than 4096 bytes, too long for a row of numbers"]
        );
        let fits = format!("a,b\n1,{}\n", "0".repeat(MAX_LINE - 3));
        assert!(parse(&fits, &COLUMNS).is_ok());
        // Earlier problems are listed too.
        let both =
            parse(&format!("a,b\nx,1\n1,{}", "0".repeat(MAX_LINE)), &COLUMNS).err().unwrap_or_default();
        assert_eq!(both.len(), 2, "{both:?}");
    }
}
