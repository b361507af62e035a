//! Custom models on the CPU: their WGSL, interpreted.

use std::sync::{
    Arc, OnceLock,
    atomic::{AtomicBool, Ordering},
};

use glam::{Vec3, Vec4};
use naga::Module;

use super::{curves::Reads, text::GREEK};
use crate::{
    optics::{
        Frame, Terms,
        albedo::{self, AlbedoCurve, LobeAlbedo},
        colour::Encoding,
        lobes::Lobes,
        sharp::{self, Sharp, Sharps},
    },
    parameter::{BLOCK_BYTES, Parameter, Values, pack, words},
    reflection::{Ambient, Declaration, EquationPart, Instantiate, Lobe, ModelEntry, Surface, append_curve},
    shader::interpret::{Program, StepLimit},
    text::mathematics::{parse, plain_symbol, same_symbol},
};

/// Maximum number of words in `let`s whose values are kept.
const MOST_WORDS: usize = 256;

/// A custom model evaluated on the CPU.
pub struct OnCpu {
    programs: Result<Programs, String>,
    /// True if a function exceeded the step limit.
    endless: AtomicBool,
}

struct Programs {
    response: Program,
    /// The `let`s of `response` that appear in the equation, by their symbols there.
    lets: Option<(Program, Vec<(String, usize)>)>,
    /// Present for models with a formula for uniform light.
    ambient: Option<Program>,
    /// Present for models with directions in which light does not spread.
    sharp: Option<Program>,
}

impl OnCpu {
    fn new(module: &Module, declaration: &Declaration, parameters: &[Parameter], lobe: bool) -> Self {
        // The albedo of a lobe is read from the row of the object.
        let table = lobe.then_some("parameter_table");
        let program = |function| {
            let program = match table {
                Some(table) => Program::with_table(module, function, table),
                None => Program::new(module, function),
            };
            program.map_err(|e| e.to_string())
        };
        let ambient = declaration.ambient;
        let symbols = symbols(declaration.equation, parameters);
        let named = |name: &str| symbols.iter().any(|symbol| is_name_of(name, symbol));
        let programs = program("response").and_then(|response| {
            let ambient = match ambient {
                Ambient::Formula => Some(program("ambient_response")?),
                Ambient::Albedo => None,
            };
            let sharp = if declaration.sharp { Some(program("sharp")?) } else { None };
            // A second program is needed only for requested names.
            let wanted = module.functions.iter().filter(|(_, f)| f.name.as_deref() == Some("response"));
            let wanted = wanted.flat_map(|(_, f)| f.named_expressions.values()).any(|name| named(name));
            let lets = wanted.then(|| Program::lets(module, "response", table, named).ok()).flatten();
            let lets = lets.map(|(program, lets)| {
                let symbol = |name: &str| symbols.iter().find(|symbol| is_name_of(name, symbol));
                let of = |(name, words): (String, usize)| (symbol(&name).cloned().unwrap_or(name), words);
                (program, lets.into_iter().map(of).collect())
            });
            Ok(Programs { response, ambient, sharp, lets })
        });
        Self { programs, endless: AtomicBool::new(false) }
    }

    /// The results of a function; zeros if it cannot be run.
    fn run<const N: usize>(
        &self,
        which: fn(&Programs) -> Option<&Program>,
        row: &[u32],
        arguments: &[u32],
    ) -> [f32; N] {
        let mut results = [0; N];
        let Some(program) = self.programs.as_ref().ok().and_then(which) else { return [0.0; N] };
        // Each run up to the limit takes time, and a picture needs a million.
        if self.endless.load(Ordering::Relaxed) {
            return [0.0; N];
        }
        if program.run_with(row, arguments, &mut results).is_err() {
            self.endless.store(true, Ordering::Relaxed);
            return [0.0; N];
        }
        results.map(f32::from_bits)
    }
}

impl crate::reflection::Interpreted for OnCpu {
    fn trouble(&self) -> Option<String> {
        match &self.programs {
            Err(what) => Some(what.clone()),
            Ok(_) if self.endless.load(Ordering::Relaxed) => Some(StepLimit.to_string()),
            Ok(_) => None,
        }
    }

    fn runs_too_long(&self) -> bool {
        self.endless.load(Ordering::Relaxed)
    }

    fn run_again(&self) {
        self.endless.store(false, Ordering::Relaxed);
    }
}

/// The symbols of an equation that are not parameters and may be the names of `let`s.
fn symbols(equation: &[EquationPart], parameters: &[Parameter]) -> Vec<String> {
    let atoms = equation.iter().flat_map(|part| parse(part.text));
    let mut symbols: Vec<_> = atoms.filter_map(|atom| atom.symbol()).map(|s| plain_symbol(&s)).collect();
    symbols.sort();
    symbols.dedup();
    symbols.retain(|symbol| !parameters.iter().any(|p| same_symbol(p.symbol, symbol)));
    symbols
}

/// True if a WGSL name matches a symbol of the equation, directly or with Greek letters spelt out: `alpha_x`
/// is `α_x`.
fn is_name_of(name: &str, symbol: &str) -> bool {
    let (base, index) = symbol.split_once('_').unwrap_or((symbol, ""));
    let (letter, rest) = name.split_once('_').unwrap_or((name, ""));
    rest == index
        && (letter == base || GREEK.lines().any(|line| line.split_once(' ') == Some((letter, base))))
}

/// The model whose lobe is read.
fn lobe_of(reads: &Reads) -> Lobe {
    reads.lobe.as_ref().map_or(Lobe::None, |model| Lobe::Of(model.declaration.id))
}

/// The entry of a model whose WGSL is in a valid module.
pub(super) fn entry(
    declaration: &'static Declaration,
    parameters: &'static [Parameter],
    reads: Reads,
    module: &Module,
) -> ModelEntry {
    let on_cpu = Arc::new(OnCpu::new(module, declaration, parameters, reads.any()));
    let (lobe, curves) = (lobe_of(&reads), reads.named());
    let instantiate: Instantiate = {
        let on_cpu = on_cpu.clone();
        Arc::new(move |values, encoding| {
            let read = reads.any().then(|| reads.values(parameters, values, encoding));
            Arc::new(Interpreted {
                on_cpu: on_cpu.clone(),
                ambient: declaration.ambient,
                anisotropic: declaration.anisotropic,
                transmits: declaration.transmits,
                lit_from_below: declaration.lit_from_below,
                sharp: declaration.sharp,
                parameters: flattened(parameters, values, encoding),
                row: read.as_ref().map_or_else(Vec::new, |(lobe, curves)| {
                    row(declaration, parameters, values, encoding, *lobe, curves)
                }),
                read,
                lobes: reads.lobes.lobes(declaration, parameters, values, encoding),
                curve: OnceLock::new(),
            })
        })
    };
    ModelEntry::custom(declaration, parameters, lobe, curves, instantiate, Some(on_cpu))
}

/// The entry of a model of which only the declaration is valid: the CPU draws the same fallback as the WGSL,
/// Lambert's law in grey.
pub(super) fn stand_in(
    declaration: &'static Declaration,
    parameters: &'static [Parameter],
    reads: &Reads,
) -> ModelEntry {
    let instantiate: Instantiate =
        Arc::new(move |_, _| Arc::new(Grey { ambient: declaration.ambient, curve: OnceLock::new() }));
    ModelEntry::custom(declaration, parameters, lobe_of(reads), reads.named(), instantiate, None)
}

/// Albedo of the fallback.
const GREY: f32 = 0.5;

/// The fallback surface.
struct Grey {
    ambient: Ambient,
    curve: OnceLock<Option<AlbedoCurve>>,
}

impl Surface for Grey {
    fn response(&self, l: Vec3, _: Vec3, frame: &Frame) -> Terms {
        let diffuse = Vec3::splat(GREY * frame.n.dot(l).max(0.0));
        Terms::of(diffuse, Vec3::ZERO)
    }

    fn ambient_response(&self, v: Vec3, frame: &Frame) -> Vec3 {
        // As on the GPU, which reads the curve if one exists.
        self.curve().map_or(Vec3::splat(GREY), |curve| curve.at(v, frame))
    }

    fn curve(&self) -> Option<AlbedoCurve> {
        let new = || AlbedoCurve::new(|l, v| self.response(l, v, &Frame::LOCAL), false);
        *self.curve.get_or_init(|| (self.ambient == Ambient::Albedo).then(new))
    }
}

/// The members of the WGSL struct `Parameters`, one word for each number.
fn flattened(parameters: &[Parameter], values: &Values, encoding: Encoding) -> Vec<u32> {
    let mut words = words(parameters, values, encoding);
    // WGSL has no empty struct: this one has an unused member.
    if words.is_empty() {
        words.push(0);
    }
    words
}

/// The row of an object as the shader reads it, with the albedo of the lobe and the additional curves.
fn row(
    declaration: &Declaration,
    parameters: &[Parameter],
    values: &Values,
    encoding: Encoding,
    lobe: LobeAlbedo,
    curves: &[Vec4],
) -> Vec<u32> {
    let mut bytes = pack(parameters, values, encoding);
    let harmonics = if declaration.anisotropic { 3 } else { 1 };
    append_curve(&mut bytes, harmonics, None, Some(lobe), curves);
    bytes.chunks_exact(4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect()
}

/// A custom model with its parameters set.
struct Interpreted {
    on_cpu: Arc<OnCpu>,
    ambient: Ambient,
    anisotropic: bool,
    transmits: bool,
    lit_from_below: bool,
    sharp: bool,
    parameters: Vec<u32>,
    /// The row as in the shader's table, without the curve; empty if it is not read.
    row: Vec<u32>,
    /// The lobe and the additional curves that the shader reads.
    read: Option<(LobeAlbedo, Vec<Vec4>)>,
    /// The directions in which the model reflects most.
    lobes: Lobes,
    curve: OnceLock<Option<AlbedoCurve>>,
}

impl Interpreted {
    /// The part of uniform light that passes through, or does not spread.
    fn beyond(&self, v: Vec3, frame: &Frame) -> Vec3 {
        const SAMPLES: u32 = 1 << 10;
        if !self.transmits {
            return Vec3::ZERO;
        }
        let sharp: Vec3 = self.sharp(v, frame).iter().map(|sharp| sharp.share).sum();
        sharp + albedo::through(|l| self.response(l, v, frame).transmitted, &self.lobes, v, frame, SAMPLES)
    }

    /// The results of a function of directions, the frame and the parameters.
    fn ask<const N: usize>(
        &self,
        which: fn(&Programs) -> Option<&Program>,
        directions: &[Vec3],
        frame: &Frame,
    ) -> [f32; N] {
        self.ask_for(which, None, directions, frame)
    }

    /// Like [`ask`](Self::ask), with a whole number as the first argument.
    fn ask_for<const N: usize>(
        &self,
        which: fn(&Programs) -> Option<&Program>,
        first: Option<u32>,
        directions: &[Vec3],
        frame: &Frame,
    ) -> [f32; N] {
        // A whole number, two directions, three vectors of the frame, and the maximum number of parameters.
        let mut arguments = [0; 16 + BLOCK_BYTES / 4];
        let vectors = directions.iter().chain([&frame.n, &frame.t, &frame.b]);
        let vectors = vectors.flat_map(|v| v.to_array().map(f32::to_bits));
        let words = first.into_iter().chain(vectors).chain(self.parameters.iter().copied());
        let mut count = 0;
        for (to, word) in arguments.iter_mut().zip(words) {
            *to = word;
            count += 1;
        }
        self.on_cpu.run(which, &self.row, &arguments[..count])
    }
}

impl Surface for Interpreted {
    fn response(&self, l: Vec3, v: Vec3, frame: &Frame) -> Terms {
        let terms: [f32; 9] = self.ask(|p| Some(&p.response), &[l, v], frame);
        let vector = |at: usize| Vec3::new(terms[at], terms[at + 1], terms[at + 2]);
        let through = self.transmits && frame.n.dot(l) * frame.n.dot(v) < 0.0;
        Terms::of_shader([0, 3, 6].map(vector), through)
    }

    fn transmits(&self) -> bool {
        self.transmits
    }

    fn lit_from_below(&self) -> bool {
        self.lit_from_below
    }

    fn sharp(&self, v: Vec3, frame: &Frame) -> Sharps {
        if !self.sharp {
            return Sharps::new();
        }
        let at = |i: usize| {
            let [a, b, c, red, green, blue] = self.ask_for(|p| p.sharp.as_ref(), Some(i as u32), &[v], frame);
            let (l, share) = (Vec3::new(a, b, c), Vec3::new(red, green, blue));
            let transmitted = frame.n.dot(l) * frame.n.dot(v) < 0.0;
            (share != Vec3::ZERO).then_some(Sharp { l, share, transmitted })
        };
        (0..sharp::MOST).filter_map(at).collect()
    }

    fn quantity(&self, symbol: &str, arguments: &[f32], l: Vec3, v: Vec3, frame: &Frame) -> Option<Vec3> {
        let (_, lets) = self.on_cpu.programs.as_ref().ok()?.lets.as_ref()?;
        let at = lets.iter().position(|(name, _)| name == symbol).filter(|_| arguments.is_empty())?;
        let first: usize = lets[..at].iter().map(|(_, words)| words).sum();
        let words: [f32; MOST_WORDS] =
            self.ask(|p| p.lets.as_ref().map(|(program, _)| program), &[l, v], frame);
        let value = match lets[at].1 {
            1 => Vec3::splat(*words.get(first)?),
            3 => Vec3::from_slice(words.get(first..first + 3)?),
            _ => return None,
        };
        // Values that were not reached are NaN.
        (!value.is_nan()).then_some(value)
    }

    fn ambient_response(&self, v: Vec3, frame: &Frame) -> Vec3 {
        match self.ambient {
            Ambient::Formula => self.ask::<3>(|p| p.ambient.as_ref(), &[v], frame).into(),
            Ambient::Albedo => match self.curve() {
                Some(curve) => curve.at(v, frame),
                None => {
                    let reflected = albedo::directional(|l| self.response(l, v, frame), v, frame).as_vec3();
                    reflected + self.beyond(v, frame)
                }
            },
        }
    }

    fn curve(&self) -> Option<AlbedoCurve> {
        let new = || {
            let curve = AlbedoCurve::new(|l, v| self.response(l, v, &Frame::LOCAL), self.anisotropic);
            curve.with(|v| self.beyond(v, &Frame::LOCAL), self.anisotropic)
        };
        *self.curve.get_or_init(|| (self.ambient == Ambient::Albedo).then(new))
    }

    fn lobe(&self) -> Option<LobeAlbedo> {
        self.read.as_ref().map(|(lobe, _)| *lobe)
    }

    fn lobes(&self) -> Lobes {
        self.lobes
    }

    fn curves(&self) -> Vec<Vec4> {
        self.read.as_ref().map_or_else(Vec::new, |(_, curves)| curves.clone())
    }
}
