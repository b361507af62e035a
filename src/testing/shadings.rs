//! Compares shading models in Rust and in WGSL, and checks the stage at which they evaluate the light.

use std::cell::Cell;

use glam::{Vec3, Vec3Swizzles as _};

use super::{
    Outcome, noticed,
    parity::TOLERANCE,
    sample::{any_direction, place, random, values_of},
    words::{bits, run, words},
};
use crate::{
    optics::{Frame, colour::Encoding},
    registry::compose::compose_shading,
    shader::{check::validate, compose::Sources, interpret::Program},
    shading::{Corner, Lighting, Shading, ShadingEntry, Stage, Varying},
};

/// Number of corners and pixels compared.
const SAMPLES: usize = 4000;

/// Checks everything about a shading model.
///
/// # Errors
/// Returns the first violation.
pub fn all(shading: &ShadingEntry, sources: &Sources) -> Outcome {
    stage(shading)?;
    parity(shading, sources)
}

/// The light at a point, with the same formula as in [`compose_shading`], and the number of evaluations.
#[derive(Default)]
struct StandIn(Cell<usize>);

impl Lighting for StandIn {
    fn colour(&self, position: Vec3, normal: Vec3, tangent: Vec3) -> Vec3 {
        self.0.set(self.0.get() + 1);
        0.5 + 0.25 * normal + 0.125 * tangent.yzx() + 0.03125 * position.zxy()
    }
}

/// A tangent as after interpolation and scaling: of any length, sometimes zero.
fn tangent(seed: &mut u64) -> Vec3 {
    if random(seed) < 0.05 { Vec3::ZERO } else { 2.0 * random(seed) * any_direction(seed) }
}

fn corner(seed: &mut u64) -> Corner {
    Corner {
        position: place(seed),
        normal: any_direction(seed),
        tangent: tangent(seed),
        face_normal: any_direction(seed),
        face_tangent: tangent(seed),
        face_centre: place(seed),
    }
}

/// Values between corners, with normals shorter than 1.
fn varying(seed: &mut u64) -> Varying {
    Varying {
        position: place(seed),
        normal: (0.2 + 0.8 * random(seed)) * any_direction(seed),
        tangent: tangent(seed),
        colour: 0.1 * place(seed),
    }
}

/// Checks that the light is evaluated only at the declared stage and that, for [`Stage::Polygon`], the
/// corners of a polygon have equal values except for their positions.
///
/// # Errors
/// Returns the first violation.
pub fn stage(shading: &ShadingEntry) -> Outcome {
    let mut seed = 41;
    let declared = shading.declaration.stage;
    for _ in 0..100 {
        let own = (shading.instantiate)(&values_of(shading.parameters, &mut seed), Encoding::Srgb);
        let [at_corner, at_pixel] = [StandIn::default(), StandIn::default()];
        let first = corner(&mut seed);
        let passed = own.vertex(&at_corner, &first);
        own.pixel(&at_pixel, &varying(&mut seed), any_direction(&mut seed));
        let found = (at_corner.0.get() > 0, at_pixel.0.get() > 0);
        if found != (declared != Stage::Pixel, declared == Stage::Pixel) {
            let of = |asked: bool| if asked { "evaluates" } else { "does not evaluate" };
            return Err(format!(
                "declares to be evaluated {}, but vertex {} the light and pixel {} it",
                declared.phrase(),
                of(found.0),
                of(found.1)
            ));
        }
        if declared == Stage::Polygon {
            let other = Corner {
                position: place(&mut seed),
                normal: any_direction(&mut seed),
                tangent: tangent(&mut seed),
                ..first
            };
            let there = own.vertex(&at_corner, &other);
            let same = |v: &Varying| (v.normal, v.tangent, v.colour);
            if same(&passed) != same(&there) {
                return Err(format!(
                    "declares to be evaluated per polygon, but two of its corners give {passed:?} and {there:?}"
                ));
            }
        }
    }
    Ok(())
}

/// A function in WGSL, with the row of parameters.
struct Twin {
    program: Program,
    name: &'static str,
}

impl Twin {
    fn run<const N: usize>(&self, row: &[u32], arguments: &[Vec3]) -> Result<[f32; N], String> {
        let results = run(&self.program, row, &bits(arguments).collect::<Vec<_>>());
        Ok(results.map_err(|e| format!("{}: {e}", self.name))?.map(f32::from_bits))
    }
}

/// Checks that WGSL interpreted on the CPU agrees with the Rust functions. Derivatives on the screen are
/// those of a plane triangle, so a shading model that takes derivatives of anything but the position cannot
/// be compared.
///
/// # Errors
/// Returns the first difference.
pub fn parity(shading: &ShadingEntry, sources: &Sources) -> Outcome {
    let module = validate(&compose_shading(sources, shading)).map_err(|problem| problem.to_string())?;
    let [vertex, pixel] =
        [("shade_vertex", "shade_vertex"), ("pixel_alone", "shade_pixel")].map(|(function, name)| {
            let program = Program::with_table(&module, function, "parameter_table");
            program.map(|program| Twin { program, name }).map_err(|e| format!("{name}: {e}"))
        });
    let (vertex, pixel) = (vertex?, pixel?);
    let mut seed = 42;
    let mut sensitive = false;
    for _ in 0..SAMPLES {
        let values = values_of(shading.parameters, &mut seed);
        let row = words(&shading.row(&values, Encoding::Srgb));
        let own = (shading.instantiate)(&values, Encoding::Srgb);
        let (at, between) = (corner(&mut seed), varying(&mut seed));
        at_corner(&*own, &vertex, &row, &at).map_err(|what| format!("{values:?} {at:?}: {what}"))?;
        let lit = in_pixel((&*own, &pixel), &row, &between, &mut seed);
        sensitive |= lit.map_err(|what| format!("{values:?} {between:?}: {what}"))?;
    }
    noticed(sensitive, "all pixels are black, so a wrong twin")
}

fn compared(what: &str, wgsl: Vec3, rust: Vec3) -> Outcome {
    let close = (wgsl - rust).abs().cmple(TOLERANCE * rust.abs().max(Vec3::ONE)).all();
    match close && rust.is_finite() {
        true => Ok(()),
        false => Err(format!("{what}: WGSL gives {wgsl}, Rust {rust}")),
    }
}

fn at_corner(own: &dyn Shading, twin: &Twin, row: &[u32], at: &Corner) -> Outcome {
    let rust = own.vertex(&StandIn::default(), at);
    let Corner { position, normal, tangent, face_normal, face_tangent, face_centre } = *at;
    // The last three are the offset, which the renderer fills in.
    let wgsl: [f32; 15] =
        twin.run(row, &[position, normal, tangent, face_normal, face_tangent, face_centre])?;
    let passed = [rust.position, rust.normal, rust.tangent, rust.colour];
    let names = ["position", "normal", "tangent", "colour"];
    names.iter().zip(passed).zip(wgsl.chunks_exact(3)).try_for_each(|((name, rust), wgsl)| {
        compared(&format!("the {name} of shade_vertex"), Vec3::from_slice(wgsl), rust)
    })
}

/// True if a pixel that is 0.05 % brighter would have been detected.
fn in_pixel(
    (own, twin): (&dyn Shading, &Twin),
    row: &[u32],
    passed: &Varying,
    seed: &mut u64,
) -> Result<bool, String> {
    let frame = Frame::from_normal(any_direction(seed));
    // Downwards × to the right is the normal.
    let down = (0.01 + random(seed)) * frame.t;
    let right = (0.01 + random(seed)) * frame.b + random(seed) * frame.t;
    let rust = own.pixel(&StandIn::default(), passed, frame.n);
    let Varying { position, normal, tangent, colour } = *passed;
    let wgsl: [f32; 3] = twin.run(row, &[position, normal, tangent, colour, Vec3::ZERO, right, down])?;
    let wgsl = Vec3::from_array(wgsl);
    compared("shade_pixel", wgsl, rust)?;
    Ok(compared("", wgsl, 1.0005 * rust).is_err())
}
