//! The WGSL of every model, run on the CPU, agrees with its Rust function.

use glam::Vec3;
use lights_camera_models::{
    optics::{Frame, Terms, colour::Encoding},
    parameter::{self, Values},
    reflection::{Ambient, ModelEntry},
    registry::{Registry, compose::compose_evaluation},
    shader::{check::validate, compose::Sources, interpret::Program},
};
use proptest::prelude::*;

use crate::gpu_parity::{direction, random, random_values};

/// A function of a model's WGSL; one source may be edited.
fn program(model: &ModelEntry, function: &str, edited: Option<(&str, &str)>) -> Program {
    let mut sources = Sources::default();
    if let Some((from, to)) = edited {
        let source = model.declaration.wgsl;
        assert!(source.text.contains(from), "{}: nothing to edit", source.path);
        sources.edit(source.path, source.text.replacen(from, to, 1));
    }
    let module = validate(&compose_evaluation(&sources, model)).expect("valid WGSL");
    Program::with_table(&module, function, "parameter_table")
        .unwrap_or_else(|e| panic!("{}: {e}", model.declaration.id))
}

/// Bytes as words.
fn words(bytes: &[u8]) -> Vec<u32> {
    bytes.chunks_exact(4).map(|b| u32::from_le_bytes(b.try_into().expect("four bytes"))).collect()
}

fn put(to: &mut Vec<u32>, v: Vec3) {
    to.extend(v.to_array().map(f32::to_bits));
}

fn put_frame(to: &mut Vec<u32>, frame: &Frame) {
    for v in [frame.n, frame.t, frame.b] {
        put(to, v);
    }
}

/// A model's response by its WGSL.
struct Twin {
    program: Program,
    row: Vec<u32>,
    parameters: Vec<u32>,
}

impl Twin {
    fn new(model: &ModelEntry, values: &Values, edited: Option<(&str, &str)>) -> Self {
        let program = program(model, "response", edited);
        let row = words(&model.row(values, Encoding::Srgb, false));
        Self { program, row, parameters: parameter::words(model.parameters, values, Encoding::Srgb) }
    }

    fn response(&self, l: Vec3, v: Vec3, frame: &Frame) -> Terms {
        let mut arguments = Vec::new();
        put(&mut arguments, l);
        put(&mut arguments, v);
        put_frame(&mut arguments, frame);
        arguments.extend(&self.parameters);
        assert_eq!(arguments.len(), self.program.argument_words());
        let mut results = [0; 9];
        assert_eq!(self.program.result_words(), results.len());
        self.program.run_with(&self.row, &arguments, &mut results).expect("it ends");
        let at = |i: usize| Vec3::from_array([0, 1, 2].map(|k| f32::from_bits(results[i + k])));
        Terms { ambient: at(0), diffuse: at(3), specular: at(6) }
    }
}

/// The largest difference, relative where the response is not dark.
fn difference(a: Terms, b: Terms) -> f32 {
    [(a.ambient, b.ambient), (a.diffuse, b.diffuse), (a.specular, b.specular)]
        .map(|(a, b)| ((a - b).abs() / b.abs().max(Vec3::splat(1e-2))).max_element())
        .into_iter()
        .fold(0.0, f32::max)
}

#[test]
fn the_interpreted_wgsl_of_every_model_agrees_with_its_rust_function() {
    let mut seed = 21;
    for model in Registry::builtin().models() {
        let mut wrong_twin_noticed = false;
        for _ in 0..40 {
            let values = random_values(model, &mut seed);
            let twin = Twin::new(model, &values, None);
            let surface = model.instantiate(&values, Encoding::Srgb);
            for _ in 0..200 {
                let (l, v) = (direction(&mut seed), direction(&mut seed));
                let (wgsl, rust) =
                    (twin.response(l, v, &Frame::LOCAL), surface.response(l, v, &Frame::LOCAL));
                let case = || format!("{} {values:?} l {l} v {v}: {wgsl:?}, {rust:?}", model.declaration.id);
                assert!((wgsl.ambient + wgsl.diffuse + wgsl.specular).is_finite(), "{}", case());
                assert!(difference(wgsl, rust) <= 1e-4, "{}", case());
                let wrong = Terms {
                    ambient: rust.ambient * 1.0005,
                    diffuse: rust.diffuse * 1.0005,
                    specular: rust.specular * 1.0005,
                };
                wrong_twin_noticed |= difference(wgsl, wrong) > 1e-4;
            }
        }
        assert!(wrong_twin_noticed, "{}: 0.05 % more goes unnoticed", model.declaration.id);
    }
}

#[test]
fn a_model_with_one_sign_changed_is_noticed() {
    let registry = Registry::builtin();
    let mut seed = 22;
    for (id, edit) in [
        ("phong", ("m.k_s * power", "-m.k_s * power")),
        ("disney", ("norm = (1.0 - a2)", "norm = (1.0 + a2)")),
        ("microfacet", ("specular += bounced", "specular -= bounced")),
    ] {
        let model = registry.model(id).expect("built in");
        let noticed = (0..20).any(|_| {
            let values = random_values(model, &mut seed);
            let twin = Twin::new(model, &values, Some(edit));
            let surface = model.instantiate(&values, Encoding::Srgb);
            (0..50).any(|_| {
                let (l, v) = (direction(&mut seed), direction(&mut seed));
                difference(twin.response(l, v, &Frame::LOCAL), surface.response(l, v, &Frame::LOCAL)) > 1e-4
            })
        });
        assert!(noticed, "{id}: {edit:?} goes unnoticed");
    }
}

#[test]
fn the_frame_is_used_as_the_rust_function_uses_it() {
    let mut seed = 23;
    for model in Registry::builtin().models() {
        let values = random_values(model, &mut seed);
        let twin = Twin::new(model, &values, None);
        let surface = model.instantiate(&values, Encoding::Srgb);
        for _ in 0..100 {
            let frame = Frame::new(direction(&mut seed), direction(&mut seed) - direction(&mut seed));
            let room = |d: Vec3| d.x * frame.t + d.y * frame.b + d.z * frame.n;
            let (l, v) = (room(direction(&mut seed)), room(direction(&mut seed)));
            let error = difference(twin.response(l, v, &frame), surface.response(l, v, &frame));
            // Directions rotated back and forth are rounded differently.
            assert!(error <= 2e-3, "{} {values:?} {frame:?} l {l} v {v}: {error}", model.declaration.id);
        }
    }
}

#[test]
fn light_from_everywhere_is_answered_by_formula_and_by_the_curve_in_the_row() {
    let mut seed = 24;
    for model in Registry::builtin().models() {
        let program = program(model, "ambient_response", None);
        for _ in 0..5 {
            let values = random_values(model, &mut seed);
            let surface = model.instantiate(&values, Encoding::Srgb);
            let row = words(&model.row(&values, Encoding::Srgb, true));
            for _ in 0..50 {
                let v = direction(&mut seed);
                let mut arguments = Vec::new();
                put(&mut arguments, v);
                put_frame(&mut arguments, &Frame::LOCAL);
                arguments.extend(parameter::words(model.parameters, &values, Encoding::Srgb));
                let mut results = [0; 3];
                program.run_with(&row, &arguments, &mut results).expect("it ends");
                let wgsl = Vec3::from_array(results.map(f32::from_bits));
                let rust = surface.ambient_response(v, &Frame::LOCAL).max(Vec3::ZERO);
                let error = (wgsl - rust).abs().max_element();
                assert!(error <= 1e-4, "{} {values:?} v {v}: {wgsl}, {rust}", model.declaration.id);
                if model.declaration.ambient == Ambient::Albedo && rust.max_element() > 1e-2 {
                    let (zero, mut wrong) = (vec![0; row.len()], [0; 3]);
                    program.run_with(&zero, &arguments, &mut wrong).expect("it ends");
                    assert_ne!(wrong, results, "{}: the curve is not read", model.declaration.id);
                }
            }
        }
    }
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

    /// Mutations that are still valid, one in some dozens, crash neither the compilation of the program nor its run.
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
