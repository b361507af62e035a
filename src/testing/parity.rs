//! Compares reflection models in Rust and in WGSL.

use glam::Vec3;

use super::{
    Outcome, noticed,
    sample::{direction, random, random_values},
    words::{bits, run, vectors, words},
};
use crate::{
    optics::{Frame, Terms, colour::Encoding},
    parameter::{self, Value, Values},
    reflection::{Ambient, ModelEntry, Surface},
    registry::{check, compose::compose_interpreted},
    shader::{check::validate, compose::Sources, interpret::Program},
};

/// Maximum difference attributed to rounding, relative where the response is not dark.
pub const TOLERANCE: f32 = 1e-4;
/// Maximum difference where all parameters are at the ends of their ranges, or directions were rotated back
/// and forth.
pub(super) const WIDE: f32 = 1e-3;

/// Checks everything that needs no GPU.
///
/// # Errors
/// Returns the first difference.
pub fn all(model: &ModelEntry, sources: &Sources) -> Outcome {
    interpreted(model, sources)?;
    in_any_frame(model, sources)?;
    under_uniform_light(model, sources)
}

fn program(model: &ModelEntry, sources: &Sources, function: &str) -> Result<Program, String> {
    check::wgsl::model(sources, model).map_err(|problem| problem.to_string())?;
    let module = validate(&compose_interpreted(sources, model)).map_err(|problem| problem.to_string())?;
    Program::with_table(&module, function, "parameter_table").map_err(|e| format!("{function}: {e}"))
}

/// The parameters of a model in the layout of its WGSL, where a struct has at least one field.
fn parameter_words(model: &ModelEntry, values: &Values) -> Vec<u32> {
    match model.parameters {
        [] => vec![0],
        all => parameter::words(all, values, Encoding::Srgb),
    }
}

/// The row of a surface, with the numbers of its file at the end.
fn row_of(model: &ModelEntry, values: &Values, uniform_light: bool) -> Vec<u32> {
    let mut row = words(&model.row(values, Encoding::Srgb, uniform_light));
    let table = model.table(values);
    for eight in table.iter().flat_map(|table| table.numbers.chunks(8)) {
        row.extend((0..8).map(|i| eight.get(i).map_or(0, |number| number.to_bits())));
    }
    row
}

/// A model's response calculated by its WGSL, with one set of parameters.
struct Twin<'a> {
    program: &'a Program,
    transmits: bool,
    row: Vec<u32>,
    parameters: Vec<u32>,
}

impl<'a> Twin<'a> {
    fn new(program: &'a Program, model: &ModelEntry, values: &Values) -> Self {
        let row = row_of(model, values, false);
        Self {
            program,
            transmits: model.declaration.transmits,
            row,
            parameters: parameter_words(model, values),
        }
    }

    fn response(&self, l: Vec3, v: Vec3, frame: &Frame) -> Result<Terms, String> {
        let directions = [l, v, frame.n, frame.t, frame.b];
        let arguments: Vec<_> = bits(&directions).chain(self.parameters.iter().copied()).collect();
        let (takes, gives) = (self.program.argument_words(), self.program.result_words());
        if (takes, gives) != (arguments.len(), 9) {
            let all = arguments.len();
            return Err(format!(
                "response takes {takes} numbers and gives {gives}, but must take {all} and give 9"
            ));
        }
        let through = self.transmits && frame.n.dot(l) * frame.n.dot(v) < 0.0;
        Ok(Terms::of_shader(vectors::<3>(&run::<9>(self.program, &self.row, &arguments)?), through))
    }
}

/// The largest difference, relative where the response is not dark: differences below 1e-5 are not visible on
/// any display.
#[must_use]
pub fn difference(a: Terms, b: Terms) -> f32 {
    let errors =
        a.each().into_iter().zip(b.each()).map(|(a, b)| (a - b).abs() / b.abs().max(Vec3::splat(1e-2)));
    errors
        .flat_map(|error| error.to_array())
        .fold(0.0, |worst, error| if error.is_nan() { f32::INFINITY } else { worst.max(error) })
}

/// A comparison, which records whether a slightly wrong twin would have been detected.
#[derive(Default)]
pub(super) struct Comparison {
    sensitive: bool,
}

impl Comparison {
    pub(super) fn compare(
        &mut self,
        wgsl: Terms,
        (model, values): (&ModelEntry, &Values),
        surface: &dyn Surface,
        [l, v]: [Vec3; 2],
    ) -> Outcome {
        let rust = surface.response(l, v, &Frame::LOCAL);
        let error = difference(wgsl, rust);
        if error > TOLERANCE && error > TOLERANCE + 4.0 * rounding((model, values), surface, [l, v], rust) {
            let case = format!("{values:?} l {l} v {v}");
            return Err(format!("{case}: WGSL gives {wgsl:?}, Rust {rust:?}: {error:.1e} apart"));
        }
        // 0.05 % more where the tolerance is 1e-4.
        let wrong = rust.each().map(|term| (1.0 + 5.0 * TOLERANCE) * term);
        self.sensitive |= difference(wgsl, wrong.into()) > TOLERANCE;
        Ok(())
    }

    pub(super) fn done(&self) -> Outcome {
        noticed(self.sensitive, "all responses are black, so a wrong one")
    }
}

/// The largest difference that one unit in the last place of one number of the directions or the parameters makes: near a critical
/// angle, or in a thick film, more than elsewhere.
fn rounding(
    (model, values): (&ModelEntry, &Values),
    surface: &dyn Surface,
    [l, v]: [Vec3; 2],
    rust: Terms,
) -> f32 {
    let moved = |d: Vec3, i: usize, up: bool| {
        let mut d = d;
        d[i] = if up { d[i].next_up() } else { d[i].next_down() };
        d
    };
    let all = (0..6).flat_map(|i| [(i, false), (i, true)]);
    let differences = all.map(|(i, up)| {
        let (l, v) = if i < 3 { (moved(l, i, up), v) } else { (l, moved(v, i - 3, up)) };
        difference(surface.response(l, v, &Frame::LOCAL), rust)
    });
    let of_values = model.parameters.iter().filter_map(|parameter| match values.get(parameter) {
        Value::Number(number) => {
            let mut values = values.clone();
            values.set(parameter.name, Value::Number(number.next_up()));
            let surface = model.instantiate(&values, Encoding::Srgb);
            Some(difference(surface.response(l, v, &Frame::LOCAL), rust))
        }
        _ => None,
    });
    differences.chain(of_values).fold(0.0, f32::max)
}

/// Directions to light and viewer; for models that light passes through, half of them on different sides.
pub(super) fn pair(model: &ModelEntry, seed: &mut u64) -> (Vec3, Vec3) {
    let (l, v) = (direction(seed), direction(seed));
    let through = model.declaration.transmits && random(seed) < 0.5;
    (if through { Vec3::new(l.x, l.y, -l.z) } else { l }, v)
}

/// Checks that WGSL interpreted on the CPU agrees with the Rust function in the local frame.
///
/// # Errors
/// Returns the first difference.
pub fn interpreted(model: &ModelEntry, sources: &Sources) -> Outcome {
    let program = program(model, sources, "response")?;
    let mut seed = 21;
    let mut comparison = Comparison::default();
    for _ in 0..40 {
        let values = random_values(model, &mut seed);
        let twin = Twin::new(&program, model, &values);
        let surface = model.instantiate(&values, Encoding::Srgb);
        for _ in 0..200 {
            let (l, v) = pair(model, &mut seed);
            let wgsl = twin.response(l, v, &Frame::LOCAL)?;
            comparison.compare(wgsl, (model, &values), &*surface, [l, v])?;
        }
    }
    comparison.done()
}

/// Checks that the frame is used as in the Rust function.
///
/// # Errors
/// Returns the first difference.
pub fn in_any_frame(model: &ModelEntry, sources: &Sources) -> Outcome {
    let program = program(model, sources, "response")?;
    let mut seed = 23;
    let values = random_values(model, &mut seed);
    let twin = Twin::new(&program, model, &values);
    let surface = model.instantiate(&values, Encoding::Srgb);
    for _ in 0..100 {
        let frame = Frame::new(direction(&mut seed), direction(&mut seed) - direction(&mut seed));
        let room = |d: Vec3| d.x * frame.t + d.y * frame.b + d.z * frame.n;
        let (l, v) = pair(model, &mut seed);
        let (l, v) = (room(l), room(v));
        let error = difference(twin.response(l, v, &frame)?, surface.response(l, v, &frame));
        // Directions rotated back and forth are rounded differently.
        if error > 2.0 * WIDE {
            return Err(format!("{values:?} {frame:?} l {l} v {v}: WGSL and Rust are {error:.1e} apart"));
        }
    }
    Ok(())
}

/// Checks that the responses to uniform light agree, by formula or by the curve in the row of the object.
///
/// # Errors
/// Returns the first difference.
pub fn under_uniform_light(model: &ModelEntry, sources: &Sources) -> Outcome {
    let program = program(model, sources, "ambient_response")?;
    let mut seed = 24;
    for _ in 0..5 {
        let values = random_values(model, &mut seed);
        let surface = model.instantiate(&values, Encoding::Srgb);
        let row = row_of(model, &values, true);
        for _ in 0..50 {
            let v = direction(&mut seed);
            let directions = [v, Frame::LOCAL.n, Frame::LOCAL.t, Frame::LOCAL.b];
            let arguments: Vec<_> = bits(&directions).chain(parameter_words(model, &values)).collect();
            let run = |row: &[u32]| Ok::<_, String>(vectors(&run::<3>(&program, row, &arguments)?));
            let [wgsl] = run(&row)?;
            let rust = surface.ambient_response(v, &Frame::LOCAL).max(Vec3::ZERO);
            let close = (wgsl - rust).abs().max_element() <= TOLERANCE;
            if !(close && wgsl.is_finite()) {
                return Err(format!("{values:?} v {v}: in uniform light WGSL gives {wgsl}, Rust {rust}"));
            }
            let by_curve = model.declaration.ambient == Ambient::Albedo && rust.max_element() > 1e-2;
            if by_curve && run(&vec![0; row.len()])? == [wgsl] {
                return Err("the curve in the row is not read".to_owned());
            }
        }
    }
    Ok(())
}
