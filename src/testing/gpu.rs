//! Compares reflection models in Rust and in WGSL on the GPU.

use glam::Vec3;

use super::{
    Outcome, assert_model, noticed,
    parity::{Comparison, WIDE, pair},
    sample::{direction, random, random_values},
};
use crate::{
    optics::{Frame, colour::Encoding},
    parameter::Values,
    reflection::{ModelEntry, ReflectionModel},
    render::capture::evaluate::Evaluator,
    shader::compose::Sources,
};

/// A seed for [`at_the_ends`].
pub const SEED_OF_ENDS: u64 = 11;

/// Asserts that a reflection model is equal in Rust and in WGSL on the GPU, including at the ends of all
/// ranges. Needs a Vulkan driver; a software one is enough.
///
/// # Panics
/// Panics if it is not, or without a driver.
#[track_caller]
pub fn assert_parity_on_gpu<M: ReflectionModel>() {
    let sources = Sources::default();
    assert_model::<M>(|model| {
        on_gpu(model, &sources)?;
        at_the_ends(model, &sources, &mut { SEED_OF_ENDS })
    });
}

/// Checks that WGSL on the GPU agrees with the Rust function.
///
/// # Errors
/// Returns the first difference, or the reason why the GPU returns no result.
pub fn on_gpu(model: &ModelEntry, sources: &Sources) -> Outcome {
    let mut seed = 7;
    // Every choice should occur.
    let choices = model.parameters.iter().filter(|p| !p.kind.options().is_empty()).count();
    let mut comparison = Comparison::default();
    // The shader is compiled once, which takes longer than its work.
    let mut evaluator = Evaluator::new(sources, model).map_err(|e| e.to_string())?;
    for _ in 0..8 * (1 + choices) {
        let values = random_values(model, &mut seed);
        let pairs: Vec<_> = (0..2000).map(|_| pair(model, &mut seed)).collect();
        evaluator.set(&values, Encoding::Srgb);
        let answers = evaluator.evaluate(&pairs).map_err(|e| e.to_string())?;
        let surface = model.instantiate(&values, Encoding::Srgb);
        for ((l, v), gpu) in pairs.iter().zip(answers) {
            comparison.compare(gpu, (model, &values), &*surface, [*l, *v])?;
        }
    }
    comparison.done()
}

/// Checks that both languages are finite and agree at the ends of all ranges, for directions along the
/// normal, at the horizon and within it, below, opposite each other, and on one line. `seed` chooses the
/// ends.
///
/// # Errors
/// Returns the first difference, or the reason why the GPU returns no result.
pub fn at_the_ends(model: &ModelEntry, sources: &Sources, seed: &mut u64) -> Outcome {
    let mut directions = SEED_OF_ENDS;
    let mut ends = vec![Vec3::Z, Vec3::NEG_Z, Vec3::X, Vec3::ZERO];
    for lift in [1e-20, 1e-9, 1e-6, 1e-3, -1e-6] {
        ends.extend([Vec3::new(1.0, 0.0, lift), Vec3::new(-1.0, 0.0, lift), Vec3::new(0.0, 1.0, lift)]);
    }
    ends.extend((0..6).map(|_| direction(&mut directions)));
    let pairs: Vec<_> = ends.iter().flat_map(|l| ends.iter().map(|v| (*l, *v))).collect();
    let mut sensitive = false;
    let mut evaluator = Evaluator::new(sources, model).map_err(|e| e.to_string())?;
    // All at the minimum, all at the maximum, then each at either.
    for set in 0..10 {
        let values = Values::each(model.parameters, |p| {
            let high = if set < 2 { set == 1 } else { random(seed) < 0.5 };
            let ends = p.kind.ends();
            let i = match p.kind.limits() {
                Some(_) => usize::from(high),
                None => (random(seed) * ends.len() as f32) as usize,
            };
            ends.into_iter().nth(i).unwrap_or_else(|| p.default_value())
        });
        evaluator.set(&values, Encoding::Srgb);
        let answers = evaluator.evaluate(&pairs).map_err(|e| e.to_string())?;
        let surface = model.instantiate(&values, Encoding::Srgb);
        for ((l, v), gpu) in pairs.iter().zip(answers) {
            let cpu = surface.response(*l, *v, &Frame::LOCAL);
            let case = || format!("{values:?} l {l} v {v}: GPU {gpu:?}, CPU {cpu:?}");
            for (g, c) in gpu.each().into_iter().zip(cpu.each()) {
                let legal = !model.declaration.laws.non_negative || g.min_element() >= -1e-6;
                if !(g.is_finite() && c.is_finite() && legal) {
                    return Err(case());
                }
                // For a sum as short as this the languages need not find the same direction.
                if (*l + *v).length() < 1e-12 {
                    continue;
                }
                let error = |c: Vec3| ((g - c).abs() / c.abs().max(Vec3::splat(1e-2))).max_element();
                if error(c) > WIDE {
                    return Err(case());
                }
                sensitive |= error(c * 1.002) > WIDE;
            }
        }
    }
    noticed(sensitive, "all responses are black, so a wrong one")
}
