//! Reads tables of measurements.

use std::f32::consts::PI;

use glam::Vec3;

use super::scattered::{Sample, table};
use crate::{
    optics::{
        distribution::ggx,
        fresnel::schlick,
        geometry::{direction, half_vector},
        masking::{height_correlated, smith_ggx},
    },
    parameter::{FileFormat, FileProblem, Shipped},
    text::{after_mark, listed, shortened, with_line_feeds},
};

/// The name of the shipped file.
pub(super) const NAME: &str = "calculated.csv";
/// Maximum number of samples.
pub const MAX_SAMPLES: usize = 10_000;
/// The columns of the angles.
const ANGLES: [&str; 4] = ["theta_i", "phi_i", "theta_o", "phi_o"];
/// The columns of a colour.
const COLOUR: [&str; 3] = ["r", "g", "b"];

/// Measurements as text: a line of the names of columns, then a line for each sample, with commas, semicolons or tabs between
/// the cells. `theta_i` and `phi_i` are the angle of the light to the normal and its azimuth, `theta_o` and `phi_o` those of the viewer, in
/// degrees; `value`, or `r`, `g` and `b`, the BRDF in sr⁻¹; `sigma`, which may be missing, its standard uncertainty. Lines that begin with #
/// are remarks. Samples with a negative value count as not measured.
///
/// Renderers read a [table](crate::optics::half_difference), into which the samples are interpolated, with the mean relative
/// uncertainty as the number of the model, and the uncertainties interpolated like the values.
pub static FORMAT: FileFormat = FileFormat {
    name: "a table of measurements (.csv)",
    extensions: &["csv"],
    max_bytes: 4 << 20,
    read,
    shipped: &[(NAME, Shipped::Numbers(calculated))],
};

/// The places of the columns.
struct Columns {
    angles: [usize; 4],
    value: [usize; 3],
    sigma: Option<usize>,
    count: usize,
}

impl Columns {
    fn of(cells: &[&str]) -> Result<Self, String> {
        let names: Vec<String> = cells.iter().map(|cell| cell.to_lowercase()).collect();
        let place = |name: &str| names.iter().position(|known| known == name);
        for (i, name) in names.iter().enumerate() {
            let known = ANGLES.iter().chain(&COLOUR).chain(&["value", "sigma"]).any(|known| known == name);
            if !known {
                let name = shortened(name);
                return Err(format!(
                    "there is no column \"{name}\"; there are {}, value or r, g, b, and sigma",
                    ANGLES.join(", ")
                ));
            }
            if place(name) != Some(i) {
                return Err(format!("the column {name} is there twice"));
            }
        }
        let angles = ANGLES.map(place);
        let missing: Vec<_> =
            ANGLES.iter().zip(angles).filter(|(_, at)| at.is_none()).map(|(name, _)| *name).collect();
        if !missing.is_empty() {
            return Err(format!("the first line lacks {}", listed(&missing, "and")));
        }
        let value = match (place("value"), COLOUR.map(place)) {
            (Some(at), [None, None, None]) => [at; 3],
            (None, [Some(r), Some(g), Some(b)]) => [r, g, b],
            _ => return Err("the values must be in one column, value, or in three, r, g and b".to_owned()),
        };
        let angles = angles.map(Option::unwrap_or_default);
        Ok(Self { angles, value, sigma: place("sigma"), count: names.len() })
    }
}

fn read(bytes: &[u8]) -> Result<Vec<f32>, FileProblem> {
    let whole = |message: &str| FileProblem { line: None, message: message.to_owned() };
    let text = std::str::from_utf8(after_mark(bytes)).map_err(|_| whole("it is not a text in UTF-8"))?;
    let text = with_line_feeds(text);
    let lines = text.lines().enumerate().map(|(i, line)| (i + 1, line.trim()));
    let mut lines = lines.filter(|(_, line)| !line.is_empty() && !line.starts_with('#'));
    let Some((line, head)) = lines.next() else {
        return Err(whole("it is empty; the first line must have the names of the columns"));
    };
    let separator = [';', '\t'].into_iter().find(|c| head.contains(*c)).unwrap_or(',');
    let cells = |line: &'_ str| {
        line.split(separator).map(|cell| cell.trim().trim_matches('"').to_owned()).collect::<Vec<_>>()
    };
    let head = cells(head);
    let head: Vec<_> = head.iter().map(String::as_str).collect();
    let columns = Columns::of(&head).map_err(|message| FileProblem { line: Some(line), message })?;
    let mut samples = Vec::new();
    let (mut sigmas, mut values) = (0.0, 0.0);
    for (line, row) in lines {
        let problem = |message: String| FileProblem { line: Some(line), message };
        if samples.len() >= MAX_SAMPLES {
            return Err(problem(format!("it has more than {MAX_SAMPLES} samples")));
        }
        let row = cells(row);
        if row.len() != columns.count {
            return Err(problem(format!(
                "it has {} cells, but there are {} columns",
                row.len(),
                columns.count
            )));
        }
        let number = |at: usize| {
            let number = row[at].parse::<f64>().ok().filter(|number| number.is_finite());
            number.ok_or_else(|| {
                problem(format!("{} must be a number, not \"{}\"", head[at], shortened(&row[at])))
            })
        };
        let [theta_i, phi_i, theta_o, phi_o] = columns.angles.map(number);
        let [theta_i, phi_i, theta_o, phi_o] = [theta_i?, phi_i?, theta_o?, phi_o?];
        for (name, theta) in [(ANGLES[0], theta_i), (ANGLES[2], theta_o)] {
            if !(0.0..90.0).contains(&theta) {
                return Err(problem(format!("{name} is {theta}, but must be at least 0 and less than 90")));
            }
        }
        let [r, g, b] = columns.value.map(number);
        let value = [r?, g?, b?];
        let sigma = columns.sigma.map_or(Ok(0.0), number)?;
        if sigma < 0.0 {
            return Err(problem(format!("sigma is {sigma}, but must be at least 0")));
        }
        if value.iter().all(|value| *value >= 0.0) {
            let value = Vec3::from_array(value.map(|value| value.min(1e9) as f32));
            (sigmas, values) = (sigmas + sigma, values + f64::from(value.element_sum()) / 3.0);
            let (l, v, sigma) = (direction(theta_i, phi_i), direction(theta_o, phi_o), sigma.min(1e9) as f32);
            samples.push(Sample { l, v, value, sigma });
        }
    }
    if samples.is_empty() {
        return Err(whole("it has no sample with a value of 0 or more"));
    }
    let sigma = if values > 0.0 { (sigmas / values).min(1e6) as f32 } else { 0.0 };
    Ok(table(&samples, sigma))
}

/// The BRDF of a glossy blue plastic in sr⁻¹, which is shown until a file is chosen.
pub(super) fn plastic(l: Vec3, v: Vec3) -> Vec3 {
    const ALPHA: glam::Vec2 = glam::Vec2::splat(0.35);
    let h = half_vector(l, v);
    let masking = height_correlated(l.z, v.z, smith_ggx(l, ALPHA), smith_ggx(v, ALPHA));
    let specular = ggx(h, ALPHA) * masking * schlick(Vec3::splat(0.04), l.dot(h));
    specular + Vec3::new(0.05, 0.15, 0.5) / PI
}

/// Directions like those of a goniometer: light at six angles, the viewer on a hemisphere.
pub(super) fn stations() -> impl Iterator<Item = [f64; 4]> {
    let viewers = (0..9).flat_map(|i| (0..13).map(move |j| [f64::from(10 * i), f64::from(15 * j)]));
    let lights = (0..6).map(|i| f64::from(15 * i));
    lights
        .flat_map(move |theta_i| viewers.clone().map(move |[theta_o, phi_o]| [theta_i, 0.0, theta_o, phi_o]))
}

/// The samples of a BRDF in sr⁻¹.
pub(super) fn samples(brdf: impl Fn(Vec3, Vec3) -> Vec3) -> Vec<Sample> {
    let sample = |[theta_i, phi_i, theta_o, phi_o]: [f64; 4]| {
        let (l, v) = (direction(theta_i, phi_i), direction(theta_o, phi_o));
        Sample { l, v, value: brdf(l, v), sigma: 0.0 }
    };
    stations().map(sample).collect()
}

fn calculated() -> Vec<f32> {
    table(&samples(plastic), 0.0)
}
