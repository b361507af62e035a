//! Compares light types with extent in Rust and in WGSL, and checks their laws.

use glam::{Vec2, Vec3};

use super::{
    Outcome,
    lamp::sample,
    noticed,
    sample::{any_direction, place, random},
    words::{run, vectors},
};
use crate::{
    light::{
        LightEntry,
        extent::{Sample, Seen},
    },
    optics::colour::Encoding,
    registry::{check, compose::FILE_TABLE},
    shader::{compose::Sources, interpret::Program},
};

/// Maximum relative difference between the languages, or between a sample and the light seen in its
/// direction, attributed to rounding: densities of small lights are differences of angles.
const TOLERANCE: f32 = 5e-3;

/// Maximum fraction of directions that may cross an edge by rounding.
const AT_EDGES: f32 = 0.01;

/// Number of points tried.
const TRIES: u32 = 4000;

/// True if numbers agree, relative to the larger one and to a negligible value.
fn near(a: f32, b: f32) -> bool {
    (a - b).abs() <= TOLERANCE * a.abs().max(b.abs()).max(1e-3)
}

fn near3(a: Vec3, b: Vec3) -> bool {
    a.to_array().into_iter().zip(b.to_array()).all(|(a, b)| near(a, b))
}

/// Checks that WGSL interpreted on the CPU agrees with the Rust functions; that a sample is seen again in its
/// direction, with its radiance and its density; and that radiance is finite, not negative, and proportional
/// to the intensity.
///
/// # Errors
/// Returns the first violation, or an error if too many directions are at edges.
pub fn all(light: &LightEntry, sources: &Sources) -> Outcome {
    let module = check::wgsl::light(sources, light).map_err(|problem| problem.to_string())?;
    let program =
        |name: &str| Program::with_table(&module, name, FILE_TABLE).map_err(|e| format!("{name}: {e}"));
    let (sampled, seen) = (program("sample_light")?, program("seen_light")?);
    let mut seed = 34;
    let (mut shines, mut at_edges) = (0u32, 0u32);
    for i in 0..TRIES {
        let (values, record) = sample(light, &mut seed);
        // Sometimes at the light itself.
        let p = if random(&mut seed) < 0.01 { record.position } else { place(&mut seed) };
        let u = Vec2::new(random(&mut seed), random(&mut seed));
        let case = |what: String| Err(format!("{values:?} at {p}, {record:?}, sample {u}: {what}"));
        let emitter = (light.instantiate)(&values, Encoding::Srgb);
        let own = emitter.sample(&record, p, u);
        let (parameters, files) = light.arguments(&values, Encoding::Srgb);
        let with = |last: &[f32]| {
            let mut all = record.arguments(&parameters, p);
            all.extend(last.iter().map(|n| n.to_bits()));
            all
        };
        let results: [u32; 7] = run(&sampled, &files, &with(&u.to_array()))?;
        let [l, radiance] = vectors(&results);
        let other = Sample { l, radiance, pdf: f32::from_bits(results[6]) };
        for (language, Sample { l, radiance, pdf }) in [("Rust", own), ("WGSL", other)] {
            if !(l.is_finite() && radiance.is_finite() && pdf.is_finite()) {
                return case(format!(
                    "it is not finite: {language} gives the direction {l}, {radiance}, {pdf}"
                ));
            }
            if radiance.min_element() < 0.0 || pdf < 0.0 {
                return case(format!("{language} gives {radiance}, {pdf}, which must not be negative"));
            }
        }
        if own.pdf == 0.0 && other.pdf == 0.0 {
            continue;
        }
        if own.pdf > 0.0 && (own.l.length() - 1.0).abs() > 1e-4 {
            return case(format!("the direction is {}, but must be a unit vector", own.l));
        }
        let same = (own.l - other.l).length() < TOLERANCE
            && near3(own.radiance, other.radiance)
            && near(own.pdf, other.pdf);
        let again = emitter.seen(&record, p, own.l);
        let fits = near3(again.radiance, own.radiance) && near(again.pdf, own.pdf);
        // Another direction too, which mostly misses the light.
        let l = if i % 2 == 0 { own.l } else { any_direction(&mut seed) };
        let here = emitter.seen(&record, p, l);
        let results: [u32; 5] = run(&seen, &files, &with(&l.to_array()))?;
        let [radiance] = vectors(&results);
        let there = (radiance, f32::from_bits(results[3]));
        let agrees = near3(here.radiance, there.0) && near(here.pdf, there.1);
        at_edges += u32::from(!(same && fits && agrees));
        if at_edges as f32 > AT_EDGES * TRIES as f32 {
            return case(format!(
                "too often something does not fit, lastly here: Rust samples {own:?} and sees {again:?} there, WGSL samples \
                 {other:?}; towards {l} Rust sees {here:?}, WGSL {there:?}"
            ));
        }
        let twice = crate::light::LightRecord { intensity: 2.0 * record.intensity, ..record };
        let Seen { radiance, .. } = emitter.seen(&twice, p, l);
        if !near3(radiance, 2.0 * here.radiance) {
            return case(format!("twice the intensity gives {radiance} instead of {}", here.radiance));
        }
        shines += u32::from(own.pdf > 0.0 && own.radiance != Vec3::ZERO);
    }
    noticed(shines > 0, "it gives no light anywhere, so a wrong twin")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::registry::Registry;

    #[test]
    fn wrong_twins_are_noticed() {
        let registry = Registry::builtin();
        for (id, right, wrong) in [
            ("rectangle", "0.5 * vec2(m.width, m.height)", "0.52 * vec2(m.width, m.height)"),
            ("disc", "PI * m.radius * m.radius", "PI * m.radius"),
            ("sphere", "sine * sine", "sine"),
            ("cylinder", "2.0 * half_angle", "half_angle"),
            ("sun", "PI * m.sine_squared", "PI * m.rise"),
            ("environment", "(SKY_AROUND + 1.0)", "SKY_AROUND"),
        ] {
            let light = registry.light(id).expect("built in");
            let path = light.declaration.wgsl.path;
            let text = light.declaration.wgsl.text;
            assert!(text.contains(right), "{id}: {right}");
            let mut sources = Sources::default();
            assert_eq!(all(light, &sources), Ok(()), "{id}");
            sources.edit(path, text.replace(right, wrong));
            assert!(all(light, &sources).is_err(), "{id}: {wrong}");
        }
    }
}
