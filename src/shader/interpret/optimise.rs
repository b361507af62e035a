//! Optimises programs: fewer instructions with the same effect.
//!
//! Registers other than variables are written by a single instruction. This makes it easy to remove unread
//! results, and to fuse copies with the calculation before them, products with the sum after them, and three
//! equal operations on three words. Together these save a sixth of the time of Disney's model and a fifth of
//! that of the microfacet model (`benches/models.rs`).

use super::{
    builder::Builder,
    instruction::{Instruction, Operation as O},
};

/// The number of instructions searched for the origin of a value.
const REACH: usize = 64;

struct Optimiser<'b> {
    builder: &'b Builder,
    /// Instructions; `None` for removed ones.
    code: Vec<Option<Instruction>>,
    /// True for targets of jumps.
    targets: Vec<bool>,
    /// The number of reads of each register.
    reads: Vec<u32>,
}

/// The optimised code of a builder; `results` are read at the end.
pub(super) fn shortened(builder: &mut Builder, results: &[u16]) -> Vec<Instruction> {
    let code = std::mem::take(&mut builder.code);
    let mut targets = vec![false; code.len() + 1];
    let mut reads = vec![0; super::REGISTERS];
    for instruction in &code {
        if instruction.jumps() {
            targets[instruction.target()] = true;
        }
        for register in instruction.reads() {
            reads[usize::from(register)] += 1;
        }
    }
    for register in results.iter().chain(&builder.wanted) {
        reads[usize::from(*register)] += 1;
    }
    let code = code.into_iter().map(Some).collect();
    let mut optimiser = Optimiser { builder, code, targets, reads };
    optimiser.drop_unread();
    optimiser.join_products();
    optimiser.join_copies();
    let code = optimiser.compact();
    let targets = targets_of(&code);
    triples(code, &targets)
}

fn targets_of(code: &[Instruction]) -> Vec<bool> {
    let mut targets = vec![false; code.len() + 1];
    for instruction in code.iter().filter(|i| i.jumps()) {
        targets[instruction.target()] = true;
    }
    targets
}

impl Optimiser<'_> {
    /// True if a register is written by one instruction, and read by one.
    fn passing(&self, register: u16) -> bool {
        !self.builder.is_mutable(register)
            && usize::from(register) < self.builder.registers()
            && self.reads[usize::from(register)] == 1
    }

    fn remove(&mut self, at: usize) {
        if let Some(instruction) = self.code[at].take() {
            for register in instruction.reads() {
                self.reads[usize::from(register)] -= 1;
            }
        }
    }

    fn drop_unread(&mut self) {
        for at in (0..self.code.len()).rev() {
            let Some(instruction) = self.code[at] else { continue };
            if let Some(d) = instruction.writes()
                && !self.builder.is_mutable(d)
                && self.reads[usize::from(d)] == 0
            {
                self.remove(at);
            }
        }
    }

    /// The instruction before another one that writes a register, if the code between passes a test and has
    /// no jumps into or out of it.
    fn origin(&self, register: u16, at: usize, passes: impl Fn(Instruction) -> bool) -> Option<usize> {
        if self.targets[at] {
            return None;
        }
        for before in (at.saturating_sub(REACH)..at).rev() {
            if let Some(instruction) = self.code[before] {
                if instruction.jumps() {
                    return None;
                }
                if instruction.writes() == Some(register) {
                    return Some(before);
                }
                if !passes(instruction) {
                    return None;
                }
            }
            if self.targets[before] {
                return None;
            }
        }
        None
    }

    /// `d = x + t` where `t = p q` is read nowhere else becomes `d = p q + x`.
    fn join_products(&mut self) {
        for at in 0..self.code.len() {
            let Some(sum) = self.code[at] else { continue };
            if sum.operation != O::AddF {
                continue;
            }
            for (product, other) in [(sum.a, sum.b), (sum.b, sum.a)] {
                let Some(origin) = self.origin_of_product(product, at) else { continue };
                let Some(factors) = self.code[origin] else { continue };
                let joined = Instruction::new(O::MulAddF, sum.d, [factors.a, factors.b, other]);
                self.code[at] = Some(joined);
                self.code[origin] = None;
                break;
            }
        }
    }

    /// The origin of a product read once, if its factors have not changed since.
    fn origin_of_product(&self, register: u16, at: usize) -> Option<usize> {
        if !self.passing(register) {
            return None;
        }
        let origin = self.origin(register, at, |_| true)?;
        let product = self.code[origin].filter(|i| i.operation == O::MulF)?;
        let steady = |factor: u16| !self.builder.is_mutable(factor);
        (steady(product.a) && steady(product.b)).then_some(origin)
    }

    /// Writes a value directly to the variable that is its only copy.
    fn join_copies(&mut self) {
        for at in 0..self.code.len() {
            let Some(copy) = self.code[at] else { continue };
            if copy.operation != O::Copy || !self.passing(copy.a) {
                continue;
            }
            let untouched = |i: Instruction| {
                // These two use registers with numbers known only at run time.
                let wanders = matches!(i.operation, O::LoadAt | O::StoreAt);
                !wanders && i.writes() != Some(copy.d) && i.reads().all(|register| register != copy.d)
            };
            let Some(origin) = self.origin(copy.a, at, untouched) else { continue };
            if let Some(instruction) = &mut self.code[origin] {
                instruction.d = copy.d;
                self.reads[usize::from(copy.a)] = 0;
                self.code[at] = None;
            }
        }
    }

    /// The remaining instructions, without jumps to the next one.
    fn compact(mut self) -> Vec<Instruction> {
        for at in (0..self.code.len()).rev() {
            if let Some(jump) = self.code[at]
                && jump.operation == O::Jump
                && jump.target() > at
                && self.code[at + 1..jump.target()].iter().all(Option::is_none)
            {
                self.code[at] = None;
            }
        }
        let mut places = Vec::with_capacity(self.code.len() + 1);
        let mut count = 0;
        for instruction in &self.code {
            places.push(count);
            count += usize::from(instruction.is_some());
        }
        places.push(count);
        let moved = |mut instruction: Instruction| {
            if instruction.jumps() {
                instruction.aim(places[instruction.target()]);
            }
            instruction
        };
        self.code.into_iter().flatten().map(moved).collect()
    }
}

/// Replaces three instructions that do the same to three words by one.
fn triples(code: Vec<Instruction>, targets: &[bool]) -> Vec<Instruction> {
    let mut joined: Vec<Instruction> = Vec::with_capacity(code.len());
    let mut places = Vec::with_capacity(code.len() + 1);
    let mut at = 0;
    while at < code.len() {
        places.push(joined.len());
        let triple = code.get(at..at + 3).filter(|_| !targets[at + 1] && !targets[at + 2]).and_then(triple);
        if triple.is_some() {
            places.extend([joined.len(); 2]);
            at += 2;
        }
        joined.push(triple.unwrap_or(code[at]));
        at += 1;
    }
    places.push(joined.len());
    for instruction in joined.iter_mut().filter(|i| i.jumps()) {
        instruction.aim(places[instruction.target()]);
    }
    joined
}

/// The instruction equivalent to these three.
fn triple(three: &[Instruction]) -> Option<Instruction> {
    let [first, rest @ ..] = three else { return None };
    let operation = first.operation.triple()?;
    let mut strides = 0;
    for (n, start) in [first.a, first.b, first.c].into_iter().enumerate().take(first.operation.arity()) {
        let goes_on = (1u16..).zip(rest).all(|(k, i)| [i.a, i.b, i.c][n] == start.wrapping_add(k));
        let stays = rest.iter().all(|i| [i.a, i.b, i.c][n] == start);
        if !goes_on && !stays {
            return None;
        }
        strides |= u8::from(goes_on) << n;
    }
    let same =
        (1u16..).zip(rest).all(|(k, i)| i.operation == first.operation && i.d == first.d.wrapping_add(k));
    same.then_some(Instruction { operation, strides, ..*first })
}
