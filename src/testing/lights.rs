//! Compares light types in Rust and in WGSL, and checks their laws.

use std::f32::consts::TAU;

use glam::Vec3;

use super::{
    Outcome, extended,
    lamp::sample,
    noticed,
    sample::{place, random},
    words::{run, vectors},
};
use crate::{
    light::{Incident, LightEntry, LightRecord},
    optics::colour::Encoding,
    parameter::Values,
    registry::{check, compose::FILE_TABLE},
    shader::{compose::Sources, interpret::Program},
};

/// Maximum relative difference between the languages attributed to rounding.
pub const TOLERANCE: f32 = 1e-4;
/// Maximum relative difference of a luminous flux attributed to its quadrature.
const FLUX_TOLERANCE: f64 = 0.02;
/// Number of directions in that quadrature.
const DIRECTIONS: usize = 50_000;

/// Checks everything about a light type.
///
/// # Errors
/// Returns the first violation.
pub fn all(light: &LightEntry, sources: &Sources) -> Outcome {
    if light.declaration.extent {
        return extended::all(light, sources);
    }
    parity(light, sources)?;
    laws(light)?;
    flux(light)
}

/// The answer of a light, for comparison: direction, intensity, 1 if it comes from everywhere.
fn flat(incident: Incident) -> (Vec3, Vec3, u32) {
    match incident {
        Incident::From { l, intensity } => (l, intensity, 0),
        Incident::Uniform { intensity } => (Vec3::ZERO, intensity, 1),
    }
}

/// WGSL that the CPU interprets agrees with the Rust function.
///
/// # Errors
/// Returns the first difference.
pub fn parity(light: &LightEntry, sources: &Sources) -> Outcome {
    let module = check::wgsl::light(sources, light).map_err(|problem| problem.to_string())?;
    let function = format!("incident_{}", light.declaration.id);
    let program =
        Program::with_table(&module, "incident", FILE_TABLE).map_err(|e| format!("{function}: {e}"))?;
    let mut seed = 31;
    let mut sensitive = false;
    for _ in 0..4000 {
        let (values, record) = sample(light, &mut seed);
        let p = place(&mut seed);
        let (own, files) = light.arguments(&values, Encoding::Srgb);
        let results: [u32; 7] = run(&program, &files, &record.arguments(&own, p))?;
        let ([direction, intensity], everywhere) = (vectors(&results), results[6]);
        let wgsl = (direction, intensity);
        let (l, rust, uniform) = flat((light.instantiate)(&values, Encoding::Srgb).incident(&record, p));
        for (language, value, direction) in [("Rust", rust, l), ("WGSL", wgsl.1, wgsl.0)] {
            if !(value.is_finite() && direction.is_finite()) {
                return Err(format!(
                    "{values:?} at {p}, {record:?}: its light is not finite: {language} gives the intensity {value} and \
                     the direction {direction}"
                ));
            }
        }
        // At the edge of a beam a rounded angle is a large part of little light: 1 % of the mean over all
        // directions counts as dark.
        let mean = light.solid_angle(&values).map_or(0.0, |sr| sr as f32 / (2.0 * TAU));
        let dark = 0.01 * mean * record.intensity / (record.position - p).length_squared().max(1e-6);
        let scale = rust.abs().max(Vec3::splat(dark.max(1e-3)));
        let turned = if uniform == 1 { 0.0 } else { (wgsl.0 - l).abs().max_element() };
        let error = |rust: Vec3| ((wgsl.1 - rust).abs() / scale).max_element();
        let close = turned <= TOLERANCE && error(rust) <= TOLERANCE;
        if !(close && (everywhere != 0) == (uniform == 1)) {
            return Err(format!(
                "{values:?} at {p}, {record:?}: WGSL gives {wgsl:?} and everywhere = {everywhere}, Rust {l}, {rust} and {uniform}"
            ));
        }
        sensitive |= error(1.0005 * rust) > TOLERANCE;
    }
    noticed(sensitive, "it gives no light anywhere, so a wrong twin")
}

/// Checks that light is finite and not negative, comes from a direction of unit length, is proportional to
/// the intensity, and is the product of its factors.
///
/// # Errors
/// Returns the first violation.
pub fn laws(light: &LightEntry) -> Outcome {
    let mut seed = 32;
    for _ in 0..4000 {
        let (values, record) = sample(light, &mut seed);
        // Sometimes at the light itself.
        let p = if random(&mut seed) < 0.01 { record.position } else { place(&mut seed) };
        let case = |what: String| Err(format!("{values:?} at {p}, {record:?}: {what}"));
        let emitter = (light.instantiate)(&values, Encoding::Srgb);
        let (l, intensity, uniform) = flat(emitter.incident(&record, p));
        if !(intensity.is_finite() && l.is_finite()) {
            return case(format!(
                "its light is not finite: the intensity is {intensity}, and the direction to the light {l}"
            ));
        }
        if intensity.min_element() < 0.0 {
            return case(format!("the intensity is {intensity}, but must not be negative"));
        }
        // Exactly at the light there is none.
        let directed = uniform == 0 && intensity != Vec3::ZERO && p != record.position;
        if directed && (l.length() - 1.0).abs() > 1e-4 {
            return case(format!("the direction to the light is {l}, but must be a unit vector"));
        }
        let factors = emitter.factors(&record, p);
        let product = factors.iter().fold(Vec3::ONE, |product, factor| product * factor.value);
        if !((product - intensity).abs().cmple(1e-4 * intensity + Vec3::splat(1e-6)).all()) {
            return case(format!(
                "its factors multiply to {product}, but its intensity is {intensity}: {factors:?}"
            ));
        }
        let twice = LightRecord { intensity: 2.0 * record.intensity, ..record };
        let (_, doubled, _) = flat(emitter.incident(&twice, p));
        if (doubled - 2.0 * intensity).abs().cmpgt(1e-3 * intensity).any() {
            return case(format!(
                "twice the intensity gives {doubled} instead of {intensity}, but must give twice as much"
            ));
        }
    }
    Ok(())
}

/// Checks that the luminous flux of a type that has one is its light in all directions: `Φ = ∫ I dω`.
///
/// # Errors
/// Returns an error if it is not.
pub fn flux(light: &LightEntry) -> Outcome {
    let mut seed = 33;
    for set in 0..8 {
        let (mut values, record) = sample(light, &mut seed);
        if set == 0 {
            values = Values::default();
        }
        let Some(expected) = light.solid_angle(&values) else { continue };
        // The quadrature captures too little of a very narrow beam.
        if !light.declaration.has_position || expected < 0.2 {
            continue;
        }
        let emitter = (light.instantiate)(&values, Encoding::Srgb);
        // Points spread evenly over the unit sphere (the golden angle), where 1/d² is 1.
        let golden = TAU * (1.0 - 2.0 / (1.0 + 5.0f32.sqrt()));
        let sum: f64 = (0..DIRECTIONS)
            .map(|i| {
                let y = 1.0 - 2.0 * (i as f32 + 0.5) / DIRECTIONS as f32;
                let (sin, cos) = (golden * i as f32).rem_euclid(TAU).sin_cos();
                let r = (1.0 - y * y).sqrt();
                let p = record.position + Vec3::new(r * cos, y, r * sin);
                // For coloured light, the mean of its colours.
                f64::from(flat(emitter.incident(&record, p)).1.element_sum() / 3.0)
            })
            .sum();
        let found = sum / f64::from(record.intensity) * f64::from(2.0 * TAU) / DIRECTIONS as f64;
        if (found - expected).abs() > FLUX_TOLERANCE * expected {
            return Err(format!(
                "{values:?}: solid_angle is {expected:.4} sr, but its light in all directions is {found:.4} sr times the intensity"
            ));
        }
    }
    Ok(())
}
