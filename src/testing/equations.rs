//! Checks that equations can be followed by hand.

use std::sync::Arc;

use super::{Outcome, direction, random, random_values, sample::any_direction};
use crate::{
    explain::{Geometry, Line, Model, agrees, reading},
    optics::{Frame, Terms, colour::Encoding},
    parameter::Values,
    reflection::{ModelEntry, Surface},
};

/// Digits of numbers that a line must reproduce; the terms themselves are calculated with 32 bits and must
/// agree to one digit less.
const DIGITS: usize = 4;
/// Difference up to which terms agree: the light of white is 1.
const DARK: f64 = 1e-5;
/// Number of random parameter sets, with several directions for each.
const SURFACES: usize = 60;
const DIRECTIONS: usize = 8;

/// Checks that every line of the explanation of a model yields its own value when evaluated as printed: for
/// many random directions, frames and parameters. A quantity in the equation without a value is an error too.
///
/// # Errors
/// Returns the first line that does not, with its numbers.
pub fn followed(model: &ModelEntry) -> Outcome {
    let mut seed = 29;
    for i in 0..SURFACES {
        let values = if i == 0 { Values::default() } else { random_values(model, &mut seed) };
        let explained = Explained::of(model, &values);
        for j in 0..DIRECTIONS {
            let frame = Frame::new(any_direction(&mut seed), any_direction(&mut seed));
            let to_room = |d: glam::Vec3| d.x * frame.t + d.y * frame.b + d.z * frame.n;
            // Some near the mirror direction, where narrow lobes are, and some behind the surface.
            let v = direction(&mut seed);
            let mut l = match j {
                0 => any_direction(&mut seed),
                _ if j < 4 => direction(&mut seed),
                _ => glam::Vec3::new(-v.x, -v.y, v.z) + 0.3 * random(&mut seed) * any_direction(&mut seed),
            };
            l = l.normalize();
            let geometry = Geometry::of(to_room(l).normalize(), to_room(v).normalize(), frame);
            explained.at(&geometry)?;
        }
    }
    Ok(())
}

/// Like [`followed`], for one surface and one geometry.
///
/// # Errors
/// Returns the errors of [`followed`].
pub fn at(model: &ModelEntry, values: &Values, geometry: &Geometry) -> Outcome {
    Explained::of(model, values).at(geometry)
}

/// A surface and its explanation, which are the same for all directions: some models take long to be made.
struct Explained {
    surface: Arc<dyn Surface>,
    model: Model,
}

impl Explained {
    fn of(model: &ModelEntry, values: &Values) -> Self {
        let surface = model.instantiate(values, Encoding::Srgb);
        Self { model: Model::of(model, values, Encoding::Srgb, Arc::clone(&surface)), surface }
    }

    fn at(&self, geometry: &Geometry) -> Outcome {
        let response = self.surface.response(geometry.l, geometry.v, &geometry.frame);
        let lines = self.model.lines(Some(geometry), &response, DIGITS);
        let wrong = |line: &Line, why: &str| {
            let numbers = line.numbers.as_deref().unwrap_or("no numbers");
            let all: Vec<_> =
                lines.iter().map(|l| format!("{} | {:?} | {:?}", l.text, l.numbers, l.rgb())).collect();
            format!("{}: {why}: {numbers}; value {:?}\n{}", line.text, line.value, all.join("\n"))
        };
        for line in &lines {
            if let Err(why) = follows(line) {
                return Err(wrong(line, &why));
            }
        }
        every_term(self.model.id, &lines, &response)
    }
}

/// Checks that a line yields its own value.
///
/// # Errors
/// Returns the reason why it does not.
pub fn follows(line: &Line) -> Result<(), String> {
    let Some(value) = &line.value else { return Err("no value".to_owned()) };
    let calculated =
        line.numbers.as_deref().or_else(|| Some(line.text.as_str()).filter(|text| text.contains('=')));
    // A quantity that the model provides has no equation.
    let Some(calculated) = calculated else { return Ok(()) };
    let read = reading(calculated)?;
    // The loss of 32 bits in a dark tail is not visible.
    let apart = read.rgb.iter().zip(&value.rgb).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    if line.is_term() && apart <= DARK {
        return Ok(());
    }
    let digits = if line.is_term() { DIGITS - 1 } else { DIGITS };
    if agrees(&read, value, digits) { Ok(()) } else { Err(format!("gives {:?}", read.rgb)) }
}

/// Checks that every non-zero term has a line in the equation.
fn every_term(id: &str, lines: &[Line], response: &Terms) -> Outcome {
    for (symbol, value) in
        [("I_d", response.diffuse), ("I_s", response.specular), ("I_t", response.transmitted)]
    {
        let said = lines.iter().any(|line| line.defines() == symbol && !line.text.is_empty());
        if value != glam::Vec3::ZERO && !said {
            return Err(format!("{symbol} is {value}, and the equation of {id} has no line for it"));
        }
    }
    Ok(())
}
