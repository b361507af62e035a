//! Runs WGSL on the CPU: a function of a validated module becomes a program for a small virtual machine. The
//! interpreter is our own, since naga parses and validates WGSL but does not run it.
//!
//! Custom models have no Rust twin. This interpreter evaluates them for the CPU renderer, the tables of the
//! command line and the curves of directional albedo.
//!
//! A program is a list of instructions on 32-bit registers: vectors and structs are split up, and calls
//! inlined, which is possible since WGSL has no recursion. Integers follow the rules of WGSL (they wrap,
//! division by zero returns the dividend, shifts use the last five bits of the distance), floats are those of
//! Rust. Indices beyond the end of an array refer to its last element, as with `wgpu` on the GPU.

use std::{
    cell::RefCell,
    sync::atomic::{AtomicU64, Ordering},
};

use naga::{Module, TypeInner};

mod builder;
mod expression;
mod instruction;
mod lower;
mod maths;
mod optimise;
mod shape;
mod statement;
#[cfg(test)]
mod tests;

use builder::Operand;
use instruction::{Instruction, REGISTERS, Registers, execute};
use lower::{Lowering, Value};

/// Maximum number of instructions in the loops of one run, counting the body in every iteration; a few
/// milliseconds. A finite loop may need more.
pub const STEPS: usize = 1 << 17;

/// A construct in a function that cannot be run on the CPU.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{what}")]
pub struct Unsupported {
    /// A sentence about the function, e.g. "it samples a texture".
    pub what: String,
}

type Result<T, E = Unsupported> = std::result::Result<T, E>;

fn unsupported<T>(what: impl Into<String>) -> Result<T> {
    Err(Unsupported { what: what.into() })
}

/// The names of `let`s, each with its number of words.
pub type Lets = Vec<(String, usize)>;

/// A program ran longer than [`STEPS`], perhaps forever; its results are undefined.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "a function runs too long: more than {STEPS} instructions in its loops for one direction; a loop may be endless"
)]
pub struct StepLimit;

/// A function of a module, with everything that it calls, ready to run.
///
/// Inputs and outputs are 32-bit words: `f32` by its bits, `bool` as 0 or 1; vectors, matrices (column by
/// column), arrays and structs flattened in the order of their members, without padding.
#[derive(Debug)]
pub struct Program {
    code: Box<[Instruction]>,
    /// Constants: register 65 535 − i holds constant i.
    constants: Box<[u32]>,
    /// The initial values of private variables.
    initial: Box<[(u16, u32)]>,
    argument_words: usize,
    /// The number of words in a row of the table, including padding; 0 without a table.
    row_words: usize,
    results: Box<[u16]>,
    /// Identifies the program.
    id: u64,
}

/// Registers kept between runs, and the program whose constants they hold.
struct Scratch {
    registers: Box<Registers>,
    program: u64,
}

impl Scratch {
    fn new() -> Self {
        let registers = vec![0.0; REGISTERS].into_boxed_slice();
        let registers = registers.try_into().unwrap_or_else(|_| Box::new([0.0; REGISTERS]));
        Self { registers, program: 0 }
    }
}

thread_local! {
    static SCRATCH: RefCell<Scratch> = RefCell::new(Scratch::new());
}

static PROGRAMS: AtomicU64 = AtomicU64::new(1);

impl Program {
    /// Prepares a function of a validated module, with everything that it calls.
    ///
    /// # Errors
    /// Returns an error if the function does not exist, or uses something that only a GPU has.
    pub fn new(module: &Module, function: &str) -> Result<Self> {
        Self::lets(module, function, None, |_| false).map(|(program, _)| program)
    }

    /// Like [`new`](Self::new), for a function that may read a table in a buffer: a read-only array with this
    /// name, of which [`run_with`](Self::run_with) receives one row. Every index refers to that row.
    ///
    /// # Errors
    /// Returns the errors of [`new`](Self::new).
    pub fn with_table(module: &Module, function: &str, table: &str) -> Result<Self> {
        Self::lets(module, function, Some(table), |_| false).map(|(program, _)| program)
    }

    /// A program that returns the values of those `let`s of the function whose names are wanted, one after
    /// the other, each with its name and its number of words. The words of a `let` that a run does not reach
    /// are NaN. Without such `let`s, the results are those of the function.
    ///
    /// # Errors
    /// Returns the errors of [`new`](Self::new).
    pub fn lets(
        module: &Module,
        name: &str,
        table: Option<&str>,
        wanted: impl Fn(&str) -> bool,
    ) -> Result<(Self, Lets)> {
        let found = module.functions.iter().find(|(_, f)| f.name.as_deref() == Some(name));
        let Some((handle, function)) = found else {
            return unsupported(format!("there is no function {name}"));
        };
        let mut lowering = Lowering::new(module);
        let mut arguments = Vec::with_capacity(function.arguments.len());
        for argument in &function.arguments {
            let inner = &module.types[argument.ty].inner;
            if matches!(inner, TypeInner::Pointer { .. } | TypeInner::ValuePointer { .. }) {
                return unsupported("it takes a pointer");
            }
            let words = shape::words(module, inner)?;
            let base = lowering.builder.input(words)?;
            arguments.push(Value::Words((0..words).map(|i| Operand::Register(base + i as u16)).collect()));
        }
        let argument_words = lowering.builder.registers();
        let variable =
            module.global_variables.iter().find(|(_, v)| table.is_some() && v.name.as_deref() == table);
        let mut row_words = 0;
        if let Some((handle, variable)) = variable {
            row_words = shape::span(module, &module.types[variable.ty].inner);
            let base = lowering.builder.input(row_words)?;
            lowering.row = Some((handle, base));
        }
        let mut lets = Vec::new();
        let mut kept = Vec::new();
        for (expression, name) in function.named_expressions.iter().filter(|(_, name)| wanted(name)) {
            let Some(words) = lowering.floats_of(handle, *expression)? else { continue };
            let base = lowering.builder.variable(words)?;
            let registers: Vec<_> = (0..words as u16).map(|i| base + i).collect();
            lowering.initial.extend(registers.iter().map(|register| (*register, f32::NAN.to_bits())));
            kept.extend(registers.iter().copied());
            lowering.watched.insert(*expression, registers);
            lets.push((name.clone(), words));
        }
        let results = lowering.call(handle, arguments)?;
        let own = if kept.is_empty() { &results[..] } else { &[] };
        let mut results: Vec<_> =
            own.iter().map(|word| lowering.builder.register(*word)).collect::<Result<_, _>>()?;
        results.extend(kept);
        let results: Box<[_]> = results.into();
        let program = Self {
            code: optimise::shortened(&mut lowering.builder, &results).into(),
            constants: lowering.builder.constants.into(),
            initial: lowering.initial.into(),
            argument_words,
            row_words,
            results,
            id: PROGRAMS.fetch_add(1, Ordering::Relaxed),
        };
        Ok((program, lets))
    }

    /// The number of words of the arguments.
    #[must_use]
    pub fn argument_words(&self) -> usize {
        self.argument_words
    }

    /// The number of words of the result.
    #[must_use]
    pub fn result_words(&self) -> usize {
        self.results.len()
    }

    /// Runs the function. Missing arguments are zero; results are written as far as there is space.
    ///
    /// # Errors
    /// Returns an error if the function does not terminate.
    pub fn run(&self, arguments: &[u32], results: &mut [u32]) -> Result<(), StepLimit> {
        self.run_with(&[], arguments, results)
    }

    /// Runs the function with a row of the table of [`with_table`](Self::with_table), laid out as in the buffer: with
    /// padding, in words. Missing words are zero.
    ///
    /// # Errors
    /// Returns the errors of [`run`](Self::run).
    pub fn run_with(&self, row: &[u32], arguments: &[u32], results: &mut [u32]) -> Result<(), StepLimit> {
        SCRATCH.with_borrow_mut(|scratch| {
            if scratch.program != self.id {
                for (register, constant) in scratch.registers.iter_mut().rev().zip(&self.constants) {
                    *register = f32::from_bits(*constant);
                }
                scratch.program = self.id;
            }
            let registers = &mut *scratch.registers;
            let (to_arguments, rest) = registers.split_at_mut(self.argument_words);
            fill(to_arguments, arguments);
            fill(&mut rest[..self.row_words], row);
            for (register, word) in &self.initial {
                registers[usize::from(*register)] = f32::from_bits(*word);
            }
            execute(&self.code, registers)?;
            for (result, register) in results.iter_mut().zip(&self.results) {
                *result = registers[usize::from(*register)].to_bits();
            }
            Ok(())
        })
    }
}

/// Copies words; missing ones are zero.
fn fill(to: &mut [f32], from: &[u32]) {
    let given = to.len().min(from.len());
    for (to, from) in to.iter_mut().zip(from) {
        *to = f32::from_bits(*from);
    }
    to[given..].fill(0.0);
}
