//! Emits code: registers, constants, folding, and reuse of earlier results.

use std::collections::HashMap;

use super::{
    Result, Unsupported,
    instruction::{Instruction, Operation, REGISTERS},
    unsupported,
};

/// The most instructions, calls and expressions of a program with all calls inlined.
const WORK: usize = 1 << 20;
/// Maximum nesting of blocks and calls.
const DEPTH: usize = 200;

/// A word, known now or at run time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Operand {
    Constant(u32),
    Register(u16),
}

fn too_large() -> Unsupported {
    Unsupported { what: "it is too large with all calls inlined".to_owned() }
}

#[derive(Default)]
pub(super) struct Builder {
    pub(super) code: Vec<Instruction>,
    /// Constants: register 65 535 − i holds constant i.
    pub(super) constants: Vec<u32>,
    places: HashMap<u32, u16>,
    blocks: HashMap<Vec<u32>, u16>,
    /// For each register below the constants, true if it is written more than once.
    mutable: Vec<bool>,
    /// The registers of operations on values that do not change.
    known: HashMap<(Operation, [Operand; 3]), u16>,
    /// The keys of `known`, in the order of insertion.
    log: Vec<(Operation, [Operand; 3])>,
    /// Registers read by number.
    pub(super) wanted: Vec<u16>,
    work: usize,
    depth: usize,
}

impl Builder {
    /// Counts a unit of work.
    pub(super) fn work(&mut self) -> Result<()> {
        self.work += 1;
        if self.work > WORK { Err(too_large()) } else { Ok(()) }
    }

    /// Enters a block or call.
    pub(super) fn enter(&mut self) -> Result<()> {
        self.depth += 1;
        if self.depth > DEPTH {
            return unsupported("its blocks and calls are nested too deeply");
        }
        Ok(())
    }

    /// Leaves the block or call entered by [`enter`](Self::enter).
    pub(super) fn leave(&mut self) {
        self.depth -= 1;
    }

    fn allocate(&mut self, words: usize, mutable: bool) -> Result<u16> {
        let base = self.mutable.len();
        if base + words + self.constants.len() > REGISTERS {
            return Err(too_large());
        }
        self.mutable.resize(base + words, mutable);
        u16::try_from(base).map_err(|_| too_large())
    }

    /// New registers that may be rewritten.
    pub(super) fn variable(&mut self, words: usize) -> Result<u16> {
        self.allocate(words, true)
    }

    /// New registers, filled before the program starts.
    pub(super) fn input(&mut self, words: usize) -> Result<u16> {
        self.allocate(words, false)
    }

    /// The registers in use below the constants.
    pub(super) fn registers(&self) -> usize {
        self.mutable.len()
    }

    fn push_constant(&mut self, bits: u32) -> Result<u16> {
        if self.mutable.len() + self.constants.len() >= REGISTERS {
            return Err(too_large());
        }
        self.constants.push(bits);
        Ok((REGISTERS - self.constants.len()) as u16)
    }

    /// The register of an operand.
    pub(super) fn register(&mut self, operand: Operand) -> Result<u16> {
        match operand {
            Operand::Register(register) => Ok(register),
            Operand::Constant(bits) => {
                if let Some(&register) = self.places.get(&bits) {
                    return Ok(register);
                }
                let register = self.push_constant(bits)?;
                self.places.insert(bits, register);
                Ok(register)
            }
        }
    }

    /// True if a register may be rewritten.
    pub(super) fn is_mutable(&self, register: u16) -> bool {
        self.mutable.get(usize::from(register)).copied().unwrap_or(false)
    }

    fn settled(&self, operand: Operand) -> bool {
        match operand {
            Operand::Constant(_) => true,
            Operand::Register(register) => !self.is_mutable(register),
        }
    }

    /// Emits an instruction unchanged.
    pub(super) fn push(&mut self, instruction: Instruction) -> Result<()> {
        self.work()?;
        self.code.push(instruction);
        Ok(())
    }

    /// The value of a pure operation: constant, already in a register, or calculated by a new instruction.
    pub(super) fn emit(&mut self, operation: Operation, operands: &[Operand]) -> Result<Operand> {
        let mut words = [Operand::Constant(0); 3];
        for (word, operand) in words.iter_mut().zip(operands) {
            *word = *operand;
        }
        if let [Operand::Constant(a), Operand::Constant(b), Operand::Constant(c)] = words {
            return Ok(Operand::Constant(operation.evaluate([a, b, c])));
        }
        let settled = words.iter().all(|w| self.settled(*w));
        self.once((operation, words), settled, |this| {
            let mut registers = [0; 3];
            for (register, word) in registers.iter_mut().zip(words).take(operation.arity()) {
                *register = this.register(word)?;
            }
            Ok(registers)
        })
    }

    /// The product of two vectors of three words, in one instruction if each is in consecutive registers.
    pub(super) fn dot(&mut self, a: &[Operand], b: &[Operand]) -> Result<Option<Operand>> {
        if a.len() != 3 || b.len() != 3 || a.iter().chain(b).all(|w| matches!(w, Operand::Constant(_))) {
            return Ok(None);
        }
        let (Some(first), Some(second)) = (self.row_of(a)?, self.row_of(b)?) else { return Ok(None) };
        let settled = a.iter().chain(b).all(|w| self.settled(*w));
        let key =
            (Operation::Dot, [Operand::Register(first), Operand::Register(second), Operand::Constant(0)]);
        self.once(key, settled, |_| Ok([first, second, 0])).map(Some)
    }

    /// The result of an operation, which is calculated once if the operands are settled.
    fn once(
        &mut self,
        key: (Operation, [Operand; 3]),
        settled: bool,
        registers: impl FnOnce(&mut Self) -> Result<[u16; 3]>,
    ) -> Result<Operand> {
        if settled && let Some(&register) = self.known.get(&key) {
            return Ok(Operand::Register(register));
        }
        let registers = registers(self)?;
        let d = self.allocate(1, false)?;
        self.push(Instruction::new(key.0, d, registers))?;
        if settled {
            self.known.insert(key, d);
            self.log.push(key);
        }
        Ok(Operand::Register(d))
    }

    /// Assigns a value to a variable.
    pub(super) fn store(&mut self, register: u16, value: Operand) -> Result<()> {
        let a = self.register(value)?;
        if a == register {
            return Ok(());
        }
        self.push(Instruction::new(Operation::Copy, register, [a, 0, 0]))
    }

    /// The word at a position known at run time.
    pub(super) fn load_at(&mut self, base: usize, offset: u16) -> Result<Operand> {
        let d = self.allocate(1, false)?;
        let b = base as u16;
        self.push(Instruction::new(Operation::LoadAt, d, [offset, b, 0]))?;
        Ok(Operand::Register(d))
    }

    /// Writes a value to a position known at run time.
    pub(super) fn store_at(&mut self, base: usize, offset: u16, value: Operand) -> Result<()> {
        let a = self.register(value)?;
        self.push(Instruction::new(Operation::StoreAt, base as u16, [a, offset, 0]))
    }

    /// The first of consecutive registers that already hold these values, or can since they are constants.
    fn row_of(&mut self, values: &[Operand]) -> Result<Option<u16>> {
        let constants: Option<Vec<u32>> = values
            .iter()
            .map(|v| match v {
                Operand::Constant(bits) => Some(*bits),
                Operand::Register(_) => None,
            })
            .collect();
        if let Some(constants) = constants {
            return self.block_of(constants).map(Some);
        }
        if let Some(Operand::Register(first)) = values.first() {
            let follows = |(i, v): (usize, &Operand)| matches!(v, Operand::Register(r) if usize::from(*r) == usize::from(*first) + i);
            if values.iter().enumerate().all(follows) {
                return Ok(Some(*first));
            }
        }
        Ok(None)
    }

    /// The first of consecutive registers that hold these values, for instructions that address them by
    /// number.
    pub(super) fn in_a_row(&mut self, values: &[Operand]) -> Result<u16> {
        if let Some(base) = self.row_of(values)? {
            self.wanted.extend((0..values.len()).map(|i| base + i as u16));
            return Ok(base);
        }
        let base = self.variable(values.len())?;
        for (i, value) in values.iter().enumerate() {
            self.store(base + i as u16, *value)?;
        }
        Ok(base)
    }

    fn block_of(&mut self, constants: Vec<u32>) -> Result<u16> {
        if let Some(&base) = self.blocks.get(&constants) {
            return Ok(base);
        }
        let mut base = 0;
        for bits in constants.iter().rev() {
            base = self.push_constant(*bits)?;
        }
        self.blocks.insert(constants, base);
        Ok(base)
    }

    /// The position of the next instruction.
    pub(super) fn here(&self) -> usize {
        self.code.len()
    }

    /// Emits a jump whose target is set later, by [`land`](Self::land).
    pub(super) fn jump(&mut self, operation: Operation, a: u16, d: u16) -> Result<usize> {
        self.push(Instruction::new(operation, d, [a, 0, 0]))?;
        Ok(self.code.len() - 1)
    }

    /// Emits a jump to a target.
    pub(super) fn jump_to(&mut self, operation: Operation, a: u16, target: usize) -> Result<()> {
        let at = self.jump(operation, a, 0)?;
        self.code[at].aim(target);
        Ok(())
    }

    /// Sets the target of jumps to the next instruction.
    pub(super) fn land(&mut self, jumps: &[usize]) {
        let here = self.here();
        for jump in jumps {
            self.code[*jump].aim(here);
        }
    }

    /// Begins code that may not run, or not before the code after it.
    pub(super) fn scope(&self) -> usize {
        self.log.len()
    }

    /// Forgets results since [`scope`](Self::scope).
    pub(super) fn forget(&mut self, scope: usize) {
        for key in self.log.drain(scope..) {
            self.known.remove(&key);
        }
    }
}
