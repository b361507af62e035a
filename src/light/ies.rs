//! Photometric files as published by luminaire manufacturers: IES LM-63 of 1986, 1991, 1995 and 2002, with
//! type C photometry. The reader is our own, since files come from strangers: it limits the number of values,
//! reports each mistake with its line, and completes symmetric files to the whole circle as renderers read
//! them.

use std::f64::consts::PI;

use crate::{
    parameter::{FileFormat, FileProblem, Shipped},
    text::{after_mark, plural, shortened, with_line_feeds},
};

/// Maximum number of candela values in a file, given for the whole circle: one for every degree.
pub const MAX_CANDELAS: usize = 181 * 361;

/// Maximum candelas, with the factors of the file: beyond them light is not finite. As of the luminance of surroundings.
const MOST_CANDELAS: f64 = 1e12;

/// Photometric files. Renderers read the number of vertical angles and of horizontal angles, the vertical
/// angles, the horizontal angles, and the candelas, one vertical half plane after the other. Angles are in
/// degrees. Horizontal angles range from 0 to 360, whatever symmetry the file uses; a file with rotational
/// symmetry has a single one. Candelas include the multiplier and the ballast factors of the file.
pub static FORMAT: FileFormat = FileFormat {
    name: "an IES photometric file",
    extensions: &["ies"],
    max_bytes: 4 << 20,
    read,
    shipped: &[(
        "wall_washer.ies",
        Shipped::Bytes(include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/wall_washer.ies"))),
    )],
};

/// The numbers in a text with their lines, separated by spaces, commas or line breaks.
struct Numbers<'a> {
    words: Box<dyn Iterator<Item = (usize, &'a str)> + 'a>,
    /// Line of the last number.
    line: usize,
}

impl<'a> Numbers<'a> {
    fn new(lines: impl Iterator<Item = (usize, &'a str)> + 'a) -> Self {
        let words = lines.flat_map(|(line, text)| {
            let words = text.split(|c: char| c.is_whitespace() || c == ',').filter(|word| !word.is_empty());
            words.map(move |word| (line, word))
        });
        Self { words: Box::new(words), line: 0 }
    }

    /// The next number; `what` describes it in messages.
    fn next(&mut self, what: &str) -> Result<f64, FileProblem> {
        let Some((line, word)) = self.words.next() else {
            return Err(self.problem(format!("the file ends before {what}")));
        };
        self.line = line;
        let number = word.parse().ok().filter(|number: &f64| number.is_finite());
        number.ok_or_else(|| self.problem(format!("{what} must be a number, not {}", shown(word, true))))
    }

    /// The next number, a count.
    fn count(&mut self, what: &str, least: usize) -> Result<usize, FileProblem> {
        let number = self.next(what)?;
        if number.fract() != 0.0 || number < least as f64 || number > MAX_CANDELAS as f64 {
            let rule =
                format!("{what} must be a whole number between {least} and {MAX_CANDELAS}, not {number}");
            return Err(self.problem(rule));
        }
        Ok(number as usize)
    }

    /// The next number, a factor of the candelas.
    fn factor(&mut self, what: &str) -> Result<f64, FileProblem> {
        let number = self.next(what)?;
        if number <= 0.0 {
            return Err(self.problem(format!("{what} must be greater than 0, not {number}")));
        }
        Ok(number)
    }

    /// A list of angles in ascending order.
    fn angles(&mut self, what: &str, count: usize, most: f64) -> Result<Vec<f64>, FileProblem> {
        let mut angles: Vec<f64> = Vec::with_capacity(count);
        for i in 0..count {
            let angle = self.next(&format!("{what} angle {} of {count}", i + 1))?;
            if !(0.0..=most).contains(&angle) {
                return Err(
                    self.problem(format!("a {what} angle must be between 0 and {most}°, not {angle}"))
                );
            }
            if let Some(before) = angles.last().filter(|before| **before >= angle) {
                let rule = format!("{what} angles must increase, but {before} is followed by {angle}");
                return Err(self.problem(rule));
            }
            angles.push(angle);
        }
        Ok(angles)
    }

    fn problem(&self, message: impl Into<String>) -> FileProblem {
        FileProblem { line: (self.line > 0).then_some(self.line), message: message.into() }
    }
}

/// A part of the file in a message; bytes that are not text are described in words.
fn shown(part: &str, in_quotes: bool) -> String {
    if part.contains(|c: char| c.is_control() || c == char::REPLACEMENT_CHARACTER) {
        return "binary data".to_owned();
    }
    let part = shortened(part);
    if in_quotes { format!("“{part}”") } else { part }
}

fn read(bytes: &[u8]) -> Result<Vec<f32>, FileProblem> {
    let text = String::from_utf8_lossy(after_mark(bytes));
    let text = with_line_feeds(&text);
    let mut lines = (1..).zip(text.lines());
    let Some((at, tilt)) = lines.by_ref().find(|(_, line)| line.trim_start().starts_with("TILT=")) else {
        let message = "this is not an IES LM-63 file: no line begins with TILT=".to_owned();
        return Err(FileProblem { line: None, message });
    };
    let mut numbers = Numbers::new(lines);
    numbers.line = at;
    let tilted = match tilt.trim().trim_start_matches("TILT=").trim() {
        "NONE" => 1.0,
        "INCLUDE" => upright(&mut numbers)?,
        other => {
            let message = format!(
                "TILT= must be NONE or INCLUDE, not {}: tables in other files are not read",
                shown(other, false)
            );
            return Err(numbers.problem(message));
        }
    };
    numbers.count("the number of lamps", 1)?;
    numbers.next("the number of lumens per lamp")?;
    let multiplier = numbers.factor("the multiplier of the candelas")?;
    let vertical = numbers.count("the number of vertical angles", 2)?;
    let horizontal = numbers.count("the number of horizontal angles", 1)?;
    let kind = numbers.next("the type of photometry")?;
    if kind != 1.0 {
        let name = if kind == 2.0 {
            ", type B"
        } else if kind == 3.0 {
            ", type A"
        } else {
            ""
        };
        let message = format!("the type of photometry must be 1, type C, not {kind}{name}");
        return Err(numbers.problem(message));
    }
    for what in ["the type of units", "the width", "the length", "the height"] {
        numbers.next(what)?;
    }
    let ballast = numbers.factor("the ballast factor")? * numbers.factor("the ballast-lamp factor")?;
    numbers.next("the watts")?;
    let gammas = numbers.angles("vertical", vertical, 180.0)?;
    let planes = numbers.angles("horizontal", horizontal, 360.0)?;
    let circle = circle(&planes).map_err(|message| numbers.problem(message))?;
    if vertical * circle.len() > MAX_CANDELAS {
        return Err(numbers
            .problem(format!("the file has more than {MAX_CANDELAS} candela values, the most allowed")));
    }
    let total = vertical * horizontal;
    let mut candelas = Vec::with_capacity(total);
    for i in 0..total {
        let what = format!(
            "candela value {} of {total}, {vertical} vertical × {horizontal} horizontal angles",
            i + 1
        );
        let candela = numbers.next(&what)?;
        if candela < 0.0 {
            return Err(numbers.problem(format!("{what}, must be 0 or more, not {candela}")));
        }
        let candela = candela * multiplier * ballast * tilted;
        if candela.is_nan() || candela > MOST_CANDELAS {
            let rule = format!("{what}, must be at most {MOST_CANDELAS:e} cd with the factors of the file");
            return Err(numbers.problem(format!("{rule}, not {candela:.2e}")));
        }
        candelas.push(candela as f32);
    }
    let more = numbers.words.by_ref().count();
    if more > 0 {
        let values = plural(more, "value");
        return Err(numbers.problem(format!("the {total} candela values are followed by {values} too many")));
    }
    if candelas.iter().all(|candela| *candela == 0.0) {
        return Err(numbers.problem("all candela values are 0: the lamp would emit no light"));
    }
    let head = [vertical as f32, circle.len() as f32];
    let angles = gammas.iter().chain(circle.iter().map(|(angle, _)| angle)).map(|angle| *angle as f32);
    let values = circle.iter().flat_map(|(_, plane)| &candelas[plane * vertical..][..vertical]);
    Ok(head.into_iter().chain(angles).chain(values.copied()).collect())
}

/// The factor for an upright luminaire in the table of `TILT=INCLUDE`, which describes how the light of a
/// lamp changes with its burning position.
fn upright(numbers: &mut Numbers) -> Result<f64, FileProblem> {
    numbers.next("the geometry of lamp and luminaire")?;
    let count = numbers.count("the number of tilt angles", 1)?;
    numbers.angles("tilt", count, 180.0)?;
    let mut factors = Vec::new();
    for i in 0..count {
        factors.push(numbers.factor(&format!("tilt factor {} of {count}", i + 1))?);
    }
    Ok(factors[0])
}

/// The horizontal angles of the whole circle, each with the plane of the file that holds its candelas.
fn circle(planes: &[f64]) -> Result<Vec<(f64, usize)>, String> {
    let (first, last) = (planes[0], planes[planes.len() - 1]);
    // The copies of a plane by symmetry: the position of C = 0, and the direction of the angles from there.
    let copies: &[(f64, f64)] = match (first, last) {
        (0.0, 0.0) => return Ok(vec![(0.0, 0)]),
        (0.0, 90.0) => &[(0.0, 1.0), (180.0, -1.0), (180.0, 1.0), (360.0, -1.0)],
        (0.0, 180.0) => &[(0.0, 1.0), (360.0, -1.0)],
        (90.0, 270.0) if planes.contains(&180.0) => &[(0.0, 1.0), (540.0, -1.0)],
        (90.0, 270.0) => return Err("horizontal angles from 90 to 270° must include 180°".to_owned()),
        (0.0, 360.0) => &[(0.0, 1.0)],
        _ => {
            return Err(format!(
                "horizontal angles must go from 0 to 0, 90, 180 or 360°, or from 90 to 270°, but these go from {first} to {last}"
            ));
        }
    };
    let copy = |(zero, sign): &(f64, f64), angle: f64| match zero + sign * angle {
        beyond if beyond > 360.0 => beyond - 360.0,
        within => within,
    };
    let mut circle: Vec<_> = copies
        .iter()
        .flat_map(|of| planes.iter().enumerate().map(move |(i, angle)| (copy(of, *angle), i)))
        .collect();
    circle.sort_by(|a, b| a.0.total_cmp(&b.0));
    circle.dedup_by_key(|(angle, _)| *angle);
    if circle[0].0 > 0.0 {
        circle.insert(0, (0.0, circle[circle.len() - 1].1));
    }
    Ok(circle)
}

/// A distribution in the layout of [`FORMAT`].
#[derive(Clone, Copy, Debug)]
pub struct Web<'a> {
    /// Vertical angles, in degrees from the axis.
    gammas: &'a [f32],
    /// Horizontal angles, in degrees; a single one, or from 0 to 360.
    planes: &'a [f32],
    /// Candelas, one plane after the other.
    candelas: &'a [f32],
}

impl<'a> Web<'a> {
    /// The distribution in the numbers of a file; `None` if they are invalid.
    #[must_use]
    pub fn new(numbers: &'a [f32]) -> Option<Self> {
        let [vertical, horizontal, rest @ ..] = numbers else { return None };
        let (gammas, rest) = rest.split_at_checked(*vertical as usize)?;
        let (planes, candelas) = rest.split_at_checked(*horizontal as usize)?;
        (candelas.len() == gammas.len() * planes.len() && !candelas.is_empty()).then_some(Self {
            gammas,
            planes,
            candelas,
        })
    }

    /// The candelas in a direction, interpolated linearly in both angles: `gamma` in degrees from the axis,
    /// `c` in degrees around it. Zero beyond the vertical angles of the file.
    #[must_use]
    pub fn candela(&self, gamma: f32, c: f32) -> f32 {
        let Some((i, t)) = between(self.gammas, gamma) else { return 0.0 };
        let along = |plane: usize| {
            let values = &self.candelas[plane * self.gammas.len()..][..self.gammas.len()];
            values[i] + t * (values[i + 1] - values[i])
        };
        match between(self.planes, c) {
            Some((j, s)) => along(j) + s * (along(j + 1) - along(j)),
            None => along(0),
        }
    }

    /// The luminous flux, lumen: the integral of the interpolated candelas over all directions.
    ///
    /// Around the axis, each pair of planes contributes its mean; from `γ_0` to `γ_1`, with `I = a + b γ`, `∫
    /// I sin γ dγ = [b sin γ − I cos γ]`.
    #[must_use]
    pub fn flux(&self) -> f64 {
        let n = self.gammas.len();
        let along = |plane: usize| {
            let cells = (0..n - 1).map(|i| {
                let [g0, g1] = [i, i + 1].map(|i| f64::from(self.gammas[i]).to_radians());
                let [i0, i1] = [i, i + 1].map(|i| f64::from(self.candelas[plane * n + i]));
                let slope = (i1 - i0) / (g1 - g0);
                slope * (g1.sin() - g0.sin()) - (i1 * g1.cos() - i0 * g0.cos())
            });
            cells.sum::<f64>()
        };
        if self.planes.len() == 1 {
            return 2.0 * PI * along(0);
        }
        let wedge = |j: usize| f64::from(self.planes[j + 1] - self.planes[j]).to_radians();
        (0..self.planes.len() - 1).map(|j| wedge(j) * 0.5 * (along(j) + along(j + 1))).sum()
    }
}

/// The index of the last angle not above `x`, and the position of `x` between it and the next angle; `None`
/// if `x` is outside.
fn between(angles: &[f32], x: f32) -> Option<(usize, f32)> {
    let (first, last) = (*angles.first()?, *angles.last()?);
    if angles.len() < 2 || !(first..=last).contains(&x) {
        return None;
    }
    let i = angles.partition_point(|angle| *angle <= x).clamp(1, angles.len() - 1) - 1;
    Some((i, (x - angles[i]) / (angles[i + 1] - angles[i])))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A file with these angles and candelas, and all other numbers 1.
    fn file(vertical: &str, horizontal: &str, candelas: &str) -> String {
        let count = |text: &str| text.split_whitespace().count();
        format!(
            "IESNA:LM-63-2002\n[TEST] 1\nTILT=NONE\n1 1000 1 {} {} 1 2 0 0 0\n1 1 50\n{vertical}\n{horizontal}\n{candelas}\n",
            count(vertical),
            count(horizontal)
        )
    }

    fn numbers(text: &str) -> Vec<f32> {
        match read(text.as_bytes()) {
            Ok(numbers) => numbers,
            Err(problem) => panic!("{problem:?} in {text}"),
        }
    }

    #[test]
    fn candelas_that_would_not_be_finite_light_are_refused() {
        let of = |candelas: &str, factors: [&str; 2]| {
            let text = file("0 90", "0", candelas).replace("1 1000 1 ", &format!("1 1000 {} ", factors[0]));
            read(text.replace("\n1 1 50", &format!("\n{} 1 50", factors[1])).as_bytes())
        };
        assert!(of("1e12 0", ["1", "1"]).is_ok() && of("1e6 1", ["1e3", "1e3"]).is_ok());
        for (candelas, factors, expected) in [
            ("1e38 1", ["1e38", "1"], "not 1.00e76"),
            ("1 2e12", ["1", "1"], "candela value 2 of 2"),
            ("0 1", ["1e308", "1e308"], "not inf"),
            ("1 1", ["1e308", "1e308"], "not inf"),
        ] {
            let problem = of(candelas, factors).expect_err(candelas);
            assert!(
                problem.message.contains("must be at most 1e12 cd with the factors of the file"),
                "{problem:?}"
            );
            assert!(problem.message.contains(expected) && problem.line == Some(8), "{problem:?}");
        }
    }

    fn candela(text: &str, gamma: f32, c: f32) -> f32 {
        Web::new(&numbers(text)).expect("a web").candela(gamma, c)
    }

    #[test]
    fn candelas_are_those_of_the_file_times_its_factors() {
        let text = file("0 90 180", "0", "100 50 0");
        assert_eq!(candela(&text, 45.0, 123.0), 75.0);
        assert_eq!(candela(&text, 180.0, 0.0), 0.0);
        let text = text.replace("1 1000 1 3", "1 1000 2.5 3").replace("\n1 1 50", "\n0.8 0.5 50");
        assert_eq!(candela(&text, 0.0, 0.0), 100.0);
        // Up to 1991, line breaks and spaces may be anywhere; commas separate too.
        let old = "IESNA91\nTILT=NONE\n1,1000,2.5,3\n1 1 2 0 0 0 0.8\n0.5, 50\n0 90\n180\n0\n100 50\n0";
        assert_eq!(numbers(old), numbers(&text));
        let marked = format!("\u{feff}{}", old.trim_start_matches("IESNA91\n"));
        assert_eq!(numbers(&marked), numbers(&text));
        assert_eq!(numbers(&marked.replace('\n', "\r")), numbers(&text));
        let oldest = text.replace("IESNA:LM-63-2002\n[TEST] 1\n", "A lamp of 1986\nwithout keywords\n");
        assert_eq!(numbers(&oldest), numbers(&text));
        let tilted = text.replace("TILT=NONE", "TILT=INCLUDE\n1\n3\n0 45 90\n0.5 0.4 0.3");
        assert_eq!(candela(&tilted, 0.0, 0.0), 50.0);
    }

    #[test]
    fn a_distribution_is_interpolated_in_both_angles_and_ends_where_the_file_ends() {
        let text = file("0 30 60", "0 90 180 360", "10 10 10  10 20 30  10 40 50  10 10 10");
        for (gamma, c, expected) in [
            (0.0, 77.0, 10.0),
            (30.0, 90.0, 20.0),
            (45.0, 90.0, 25.0),
            (30.0, 45.0, 15.0),
            (45.0, 45.0, 17.5),
            (60.0, 270.0, 30.0),
            (60.0, 360.0, 10.0),
            (60.1, 0.0, 0.0),
        ] {
            assert_eq!(candela(&text, gamma, c), expected, "γ = {gamma}, C = {c}");
        }
    }

    #[test]
    fn a_file_may_leave_out_what_is_symmetric() {
        // Candelas equal to the horizontal angle identify the plane.
        let symmetric = |horizontal: &str| {
            let planes: Vec<_> = horizontal.split_whitespace().map(|c| format!("{c} {c}")).collect();
            let text = file("0 90", horizontal, &planes.join("\n"));
            move |c: f32| candela(&text, 45.0, c)
        };
        let quarter = symmetric("0 30 90");
        let half = symmetric("0 30 180");
        let across = symmetric("90 150 180 270");
        let whole = symmetric("0 30 360");
        for (c, expected) in
            [(0.0, 0.0), (30.0, 30.0), (90.0, 90.0), (150.0, 30.0), (210.0, 30.0), (330.0, 30.0)]
        {
            assert_eq!(quarter(c), expected, "{c}");
        }
        assert_eq!([half(30.0), half(180.0), half(330.0), half(360.0)], [30.0, 180.0, 30.0, 0.0]);
        // The mirror of C = 150 in the plane of 90 and 270 is 30.
        assert_eq!([across(90.0), across(150.0), across(30.0), across(270.0)], [90.0, 150.0, 150.0, 270.0]);
        assert_eq!([across(0.0), across(360.0), across(180.0)], [180.0; 3]);
        assert_eq!([whole(30.0), whole(195.0), whole(360.0)], [30.0, 195.0, 360.0]);
    }

    /// By hand: 100 cd everywhere are `4π · 100` lm. Candelas that fall linearly from 200 at the axis to 0 at 90° are
    /// `2π · 200 ∫ (1 − 2γ/π) sin γ dγ = 400π (1 − 2/π)` lm, since `∫ sin γ = ∫ γ sin γ = 1` from 0 to `π/2`.
    #[test]
    fn the_flux_is_the_integral_over_all_directions() {
        let flux = |text: &str| Web::new(&numbers(text)).expect("a web").flux();
        let near = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-6;
        assert!(near(flux(&file("0 180", "0", "100 100")), 400.0 * PI));
        let cone = 400.0 * PI * (1.0 - 2.0 / PI);
        assert!(near(flux(&file("0 90", "0", "200 0")), cone));
        assert!(near(flux(&file("0 45 90", "0 90", "200 100 0 200 100 0")), cone));
        // One half of the circle is dark, with linear flanks of 90°.
        let half = flux(&file("0 90", "0 90 180 270 360", "200 0 200 0 0 0 0 0 200 0"));
        assert!(near(half, 0.5 * cone), "{half} {cone}");
        // The wrong twin: candelas summed without the sine.
        assert!(!near(2.0 * PI * 100.0 * 0.5 * PI, cone));
    }

    #[test]
    fn mistakes_are_told_with_their_lines() {
        let good = file("0 45 90", "0 90", "9 8 7\n9 8 7");
        let said = |from: &str, to: &str| {
            assert!(good.contains(from), "{from}");
            let problem = read(good.replacen(from, to, 1).as_bytes()).expect_err(to);
            format!("{}: {}", problem.line.unwrap_or_default(), problem.message)
        };
        assert!(read(good.as_bytes()).is_ok());
        for (from, to, expected) in [
            ("TILT=NONE", "tilted", "0: this is not an IES LM-63 file: no line begins with TILT="),
            ("TILT=NONE", "TILT=lamp.tlt", "3: TILT= must be NONE or INCLUDE, not lamp.tlt"),
            ("1000 1 3", "1000 zero 3", "4: the multiplier of the candelas must be a number, not “zero”"),
            ("1000 1 3", "1000 \0 3", "4: the multiplier of the candelas must be a number, not binary data"),
            ("1000 1 3", "1000 0 3", "4: the multiplier of the candelas must be greater than 0, not 0"),
            (
                "1 3 2 1 2",
                "1 3.5 2 1 2",
                "4: the number of vertical angles must be a whole number between 2 and",
            ),
            ("1 3 2 1 2", "1 3 2 3 2", "4: the type of photometry must be 1, type C, not 3, type A"),
            ("1 1 50", "0 1 50", "5: the ballast factor must be greater than 0, not 0"),
            ("0 45 90", "0 95 90", "6: vertical angles must increase, but 95 is followed by 90"),
            ("0 45 90", "0 45 190", "6: a vertical angle must be between 0 and 180°, not 190"),
            (
                "\n0 90\n",
                "\n0 100\n",
                "7: horizontal angles must go from 0 to 0, 90, 180 or 360°, or from 90 to 270°, but these go from 0 to 100",
            ),
            (
                "9 8 7\n9 8 7",
                "9 8 7\n9 8",
                "9: the file ends before candela value 6 of 6, 3 vertical × 2 horizontal angles",
            ),
            (
                "9 8 7\n9 8 7",
                "9 8 7\n9 8 7\n6 6",
                "9: the 6 candela values are followed by 2 values too many",
            ),
            (
                "9 8 7\n9 8 7",
                "9 8 7\n9 -8 7",
                "9: candela value 5 of 6, 3 vertical × 2 horizontal angles, must be 0 or more",
            ),
            ("9 8 7\n9 8 7", "0 0 0\n0 0 0", "9: all candela values are 0: the lamp would emit no light"),
        ] {
            let said = said(from, to);
            assert!(said.starts_with(expected), "{said}\n{expected}");
        }
    }

    #[test]
    fn hostile_files_are_refused_at_once() {
        for numbers in ["1e30 1", "65342 361", "NaN 1", "181 1e9", "-3 1", "inf inf"] {
            let text = format!("TILT=NONE\n1 1 1 {numbers} 1 2 0 0 0\n1 1 50\n0");
            assert!(read(text.as_bytes()).is_err(), "{numbers}");
        }
        assert!(read(&[0xff; 100]).is_err());
        assert!(Web::new(&[3.0]).is_none() && Web::new(&[f32::NAN, 1.0, 0.0]).is_none());
    }

    #[test]
    fn the_shipped_file_is_legal_and_says_that_it_is_made_up() {
        let [(name, Shipped::Bytes(bytes))] = FORMAT.shipped else { panic!("one") };
        let text = String::from_utf8_lossy(bytes);
        assert!(text.contains("calculated, not measured"), "{name}");
        // It throws most light towards C = 0.
        assert!(candela(&text, 35.0, 0.0) > 5.0 * candela(&text, 35.0, 180.0));
    }
}
