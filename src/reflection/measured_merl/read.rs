//! Reads files of the MERL BRDF database.

use glam::Vec3;

use super::example;
use crate::{
    optics::half_difference,
    parameter::{FileFormat, FileProblem, Shipped},
    text::shortened,
};

/// The numbers of entries along θ_h, θ_d and φ_d.
pub const COUNTS: [usize; 3] = [90, 90, 180];
/// The number of entries for each colour.
const ENTRIES: usize = COUNTS[0] * COUNTS[1] * COUNTS[2];
/// The values in sr⁻¹ of 1 in a file, for red, green and blue (the database's BRDFRead.cpp, 2003).
pub const SCALES: [f64; 3] = [1.0 / 1500.0, 1.15 / 1500.0, 1.66 / 1500.0];
/// The three counts.
const HEADER: usize = 12;
const LENGTH: usize = HEADER + 3 * 8 * ENTRIES;

/// Measured materials of the MERL database: three 32-bit integers 90, 90, 180, then 64-bit floats, all little-endian: all entries
/// for red, then for green, then for blue; φ_d is fastest, then θ_d. A negative value marks a direction that was not measured.
/// Renderers read a [table](half_difference), with the value of the nearest smaller θ_d where an entry was not measured.
///
/// That takes 11.7 MB for each file.
pub static FORMAT: FileFormat = FileFormat {
    name: "a file of the MERL BRDF database (.binary)",
    extensions: &["binary"],
    max_bytes: LENGTH as u64,
    read,
    shipped: &[(example::NAME, Shipped::Numbers(example::numbers))],
};

fn read(bytes: &[u8]) -> Result<Vec<f32>, FileProblem> {
    numbers(bytes).map_err(|message| FileProblem { line: None, message })
}

/// A number of an array of 64-bit floats.
fn double(bytes: &[u8], i: usize) -> f64 {
    bytes.get(8 * i..8 * i + 8).and_then(|all| all.try_into().ok()).map_or(f64::NAN, f64::from_le_bytes)
}

fn numbers(bytes: &[u8]) -> Result<Vec<f32>, String> {
    let expected = COUNTS.map(|count| count.to_string()).join(" × ");
    let Some((header, data)) = bytes.split_at_checked(HEADER) else {
        return Err(format!("it has {} bytes; a file of the MERL database has {LENGTH}", bytes.len()));
    };
    let counts: Vec<i32> =
        header.chunks_exact(4).filter_map(|all| Some(i32::from_le_bytes(all.try_into().ok()?))).collect();
    if counts.iter().map(|count| i64::from(*count)).ne(COUNTS.iter().map(|count| *count as i64)) {
        let text = String::from_utf8_lossy(&bytes[..bytes.len().min(32)]);
        // Most files of another kind begin with a word, or with a bracket and a new line.
        let readable = text.chars().take(4).all(|c| c.is_ascii_graphic() || c.is_ascii_whitespace());
        let has = if readable {
            format!("begins with {}", shortened(&text))
        } else {
            format!("has {} entries", counts.iter().map(i32::to_string).collect::<Vec<_>>().join(" × "))
        };
        return Err(format!("it {has}; a file of the MERL database has {expected} entries"));
    }
    if bytes.len() < LENGTH {
        let length = bytes.len();
        return Err(format!(
            "it ends after {length} bytes; {expected} entries in three colours take {LENGTH}"
        ));
    }
    let mut wrong = None;
    let entry = |i: usize| {
        let all: [f64; 3] = std::array::from_fn(|colour| double(data, colour * ENTRIES + i));
        if let Some(colour) = all.iter().position(|value| !value.is_finite()) {
            wrong.get_or_insert((i, colour, all[colour]));
        }
        let is_measured = all.iter().all(|value| *value >= 0.0);
        is_measured.then(|| Vec3::from_array(std::array::from_fn(|k| (all[k] * SCALES[k]) as f32)))
    };
    let entries: Vec<Option<Vec3>> = (0..ENTRIES).map(entry).collect();
    if let Some((i, colour, value)) = wrong {
        let place = [i / (COUNTS[1] * COUNTS[2]), i / COUNTS[2] % COUNTS[1], i % COUNTS[2]];
        let place = place.map(|index| index.to_string()).join(", ");
        let colour = ["red", "green", "blue"][colour];
        return Err(format!("{colour} of entry ({place}) is {value}, but must be a finite number"));
    }
    if entries.iter().all(Option::is_none) {
        return Err("every entry has a negative value in some colour, the mark of one that was not measured"
            .to_owned());
    }
    Ok(half_difference::with_gaps(COUNTS, entries))
}
