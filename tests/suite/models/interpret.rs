//! The WGSL of every model, run on the CPU, agrees with its Rust function.

use lights_camera_models::{
    optics::colour::Encoding,
    reflection::ModelEntry,
    registry::{Registry, compose::compose_evaluation},
    shader::{check::validate, compose::Sources, interpret::Program},
    testing::{self, random, random_values},
};
use proptest::prelude::*;

/// Runs a comparison for every model.
fn agree(compare: fn(&ModelEntry, &Sources) -> testing::Outcome) {
    for model in Registry::builtin().models() {
        assert_eq!(compare(model, &Sources::default()), Ok(()), "{}", model.declaration.id);
    }
}

#[test]
fn the_interpreted_wgsl_of_every_model_agrees_with_its_rust_function() {
    agree(testing::parity::interpreted);
}

#[test]
fn a_model_with_one_sign_changed_is_noticed() {
    let registry = Registry::builtin();
    for (id, from, to) in [
        ("phong", "m.k_s * power", "-m.k_s * power"),
        ("disney", "norm = (1.0 - a2)", "norm = (1.0 + a2)"),
        ("microfacet", "specular += bounced", "specular -= bounced"),
    ] {
        let model = registry.model(id).expect("built in");
        let source = model.declaration.wgsl;
        assert!(source.text.contains(from), "{}: nothing to edit", source.path);
        let mut sources = Sources::default();
        sources.edit(source.path, source.text.replacen(from, to, 1));
        let found = testing::parity::interpreted(model, &sources).expect_err(id);
        assert!(found.contains("WGSL gives"), "{found}");
    }
}

#[test]
fn the_frame_is_used_as_the_rust_function_uses_it() {
    agree(testing::parity::in_any_frame);
}

#[test]
fn light_from_everywhere_is_answered_by_formula_and_by_the_curve_in_the_row() {
    agree(testing::parity::under_uniform_light);
}

/// Bytes as words.
fn words(bytes: &[u8]) -> Vec<u32> {
    bytes.chunks_exact(4).map(|b| u32::from_le_bytes(b.try_into().expect("four bytes"))).collect()
}

/// A text with a few of its tokens replaced by others of the same text, or removed.
fn mutated(text: &str, seed: &mut u64) -> String {
    let mut tokens: Vec<String> = Vec::new();
    for c in text.chars() {
        let word = |c: char| c.is_alphanumeric() || c == '_' || c == '.';
        match tokens.last_mut() {
            Some(last) if word(c) && last.chars().all(word) => last.push(c),
            _ => tokens.push(c.to_string()),
        }
    }
    let visible: Vec<usize> = (0..tokens.len()).filter(|i| !tokens[*i].trim().is_empty()).collect();
    let mut pick = || visible[(random(seed) * visible.len() as f32) as usize];
    for _ in 0..2 {
        let (at, from) = (pick(), pick());
        tokens[at] = tokens[from].clone();
    }
    tokens.concat()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]

    /// Mutations that are still valid, one in several dozens, crash neither the compilation of the program
    /// nor its run.
    #[test]
    fn mutated_models_never_panic(start in any::<u64>()) {
        let registry = Registry::builtin();
        let mut seed = start;
        for _ in 0..20 {
            let model = &registry.models()[(random(&mut seed) * registry.models().len() as f32) as usize];
            let source = model.declaration.wgsl;
            let mut sources = Sources::default();
            sources.edit(source.path, mutated(source.text, &mut seed));
            let Ok(module) = validate(&compose_evaluation(&sources, model)) else { continue };
            let Ok(program) = Program::with_table(&module, "response", "parameter_table") else { continue };
            let row = words(&model.row(&random_values(model, &mut seed), Encoding::Srgb, false));
            let mut results = vec![0; program.result_words()];
            for _ in 0..4 {
                let arguments: Vec<u32> =
                    (0..program.argument_words()).map(|_| (random(&mut seed) * 4e9) as u32).collect();
                let _ = program.run_with(&row, &arguments, &mut results);
            }
        }
    }
}
