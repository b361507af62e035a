//! Translates naga's statements to instructions and jumps.

use std::rc::Rc;

use naga::{Block, Statement, SwitchValue};

use super::{
    Result,
    builder::Operand,
    instruction::Operation as O,
    lower::{Around, Frame, Lowering, Value},
    shape::Layout,
    unsupported,
};
use crate::shader::blocks::Expr;

/// True if nothing after a statement runs.
fn leaves(block: &Block) -> bool {
    match block.last() {
        Some(Statement::Return { .. } | Statement::Break | Statement::Continue) => true,
        Some(Statement::Block(inner)) => leaves(inner),
        _ => false,
    }
}

impl<'m> Lowering<'m> {
    pub(super) fn block(&mut self, frame: &mut Frame<'m>, block: &'m Block) -> Result<()> {
        self.builder.enter()?;
        for statement in block {
            self.builder.work()?;
            self.statement(frame, statement)?;
        }
        self.builder.leave();
        Ok(())
    }

    /// A block whose results are unknown after it.
    fn inner(&mut self, frame: &mut Frame<'m>, block: &'m Block) -> Result<()> {
        let scope = self.builder.scope();
        self.block(frame, block)?;
        self.builder.forget(scope);
        Ok(())
    }

    fn statement(&mut self, frame: &mut Frame<'m>, statement: &'m Statement) -> Result<()> {
        match statement {
            Statement::Emit(range) => {
                for handle in range.clone() {
                    self.builder.work()?;
                    let value = self.expression(frame, handle)?;
                    frame.values[handle.index()] = Some(value);
                    self.watch(frame, handle)?;
                }
                Ok(())
            }
            Statement::Block(block) => self.block(frame, block),
            Statement::If { condition, accept, reject } => self.branch(frame, *condition, accept, reject),
            Statement::Switch { selector, cases } => self.switch(frame, *selector, cases),
            Statement::Loop { body, continuing, break_if } => self.repeat(frame, body, continuing, *break_if),
            Statement::Break => {
                let jump = self.builder.jump(O::Jump, 0, 0)?;
                if let Some(around) = frame.around.last_mut() {
                    around.breaks.push(jump);
                }
                Ok(())
            }
            Statement::Continue => {
                let jump = self.builder.jump(O::Jump, 0, 0)?;
                if let Some(continues) = frame.around.iter_mut().rev().find_map(|a| a.continues.as_mut()) {
                    continues.push(jump);
                }
                Ok(())
            }
            Statement::Return { value } => self.give_back(frame, *value),
            Statement::Store { pointer, value } => self.assign(frame, *pointer, *value),
            Statement::Call { function, arguments, result } => {
                let mut values = Vec::with_capacity(arguments.len());
                for argument in arguments {
                    values.push(self.value(frame, *argument)?);
                }
                let words = self.call(*function, values)?;
                if let Some(result) = result {
                    frame.values[result.index()] = Some(Value::Words(words));
                    self.watch(frame, *result)?;
                }
                Ok(())
            }
            Statement::Kill => unsupported("it discards a fragment"),
            Statement::ControlBarrier(_)
            | Statement::MemoryBarrier(_)
            | Statement::WorkGroupUniformLoad { .. } => unsupported("it waits at a barrier"),
            Statement::ImageStore { .. } | Statement::ImageAtomic { .. } => {
                unsupported("it writes a texture")
            }
            Statement::Atomic { .. } => unsupported("it uses atomics"),
            Statement::RayQuery { .. } | Statement::RayPipelineFunction(_) => unsupported("it traces rays"),
            Statement::SubgroupBallot { .. }
            | Statement::SubgroupGather { .. }
            | Statement::SubgroupCollectiveOperation { .. } => unsupported("it uses subgroup operations"),
            Statement::CooperativeStore { .. } => unsupported("it uses cooperative matrices"),
        }
    }

    fn give_back(&mut self, frame: &mut Frame<'m>, value: Option<Expr>) -> Result<()> {
        let words = match value {
            Some(value) => self.words(frame, value)?,
            None => Rc::new([]),
        };
        let Some(base) = frame.results else {
            frame.returned = words;
            return Ok(());
        };
        for (i, word) in words.iter().enumerate() {
            self.builder.store(base + i as u16, *word)?;
        }
        frame.returns.push(self.builder.jump(O::Jump, 0, 0)?);
        Ok(())
    }

    fn branch(
        &mut self,
        frame: &mut Frame<'m>,
        condition: Expr,
        accept: &'m Block,
        reject: &'m Block,
    ) -> Result<()> {
        let condition = match self.word(frame, condition)? {
            Operand::Constant(0) => return self.inner(frame, reject),
            Operand::Constant(_) => return self.inner(frame, accept),
            Operand::Register(register) => register,
        };
        let past = self.builder.jump(O::JumpUnless, condition, 0)?;
        self.inner(frame, accept)?;
        if reject.is_empty() {
            self.builder.land(&[past]);
            return Ok(());
        }
        let end = if leaves(accept) { None } else { Some(self.builder.jump(O::Jump, 0, 0)?) };
        self.builder.land(&[past]);
        self.inner(frame, reject)?;
        if let Some(end) = end {
            self.builder.land(&[end]);
        }
        Ok(())
    }

    fn switch(&mut self, frame: &mut Frame<'m>, selector: Expr, cases: &'m [naga::SwitchCase]) -> Result<()> {
        let selector = self.word(frame, selector)?;
        let selector = self.builder.register(selector)?;
        let mut tests = vec![None; cases.len()];
        for (case, test) in cases.iter().zip(&mut tests) {
            let bits = match case.value {
                SwitchValue::I32(v) => v.cast_unsigned(),
                SwitchValue::U32(v) => v,
                SwitchValue::Default => continue,
            };
            let value = self.builder.register(Operand::Constant(bits))?;
            *test = Some(self.builder.jump(O::JumpIfEqual, selector, value)?);
        }
        let otherwise = self.builder.jump(O::Jump, 0, 0)?;
        let mut has_default = false;
        frame.around.push(Around { breaks: Vec::new(), continues: None });
        for (i, (case, test)) in cases.iter().zip(tests).enumerate() {
            has_default |= test.is_none();
            self.builder.land(&[test.unwrap_or(otherwise)]);
            self.inner(frame, &case.body)?;
            let last = i + 1 == cases.len();
            if !case.fall_through && !last && !leaves(&case.body) {
                let jump = self.builder.jump(O::Jump, 0, 0)?;
                if let Some(around) = frame.around.last_mut() {
                    around.breaks.push(jump);
                }
            }
        }
        if !has_default {
            self.builder.land(&[otherwise]);
        }
        self.land_breaks(frame);
        Ok(())
    }

    fn land_breaks(&mut self, frame: &mut Frame<'m>) {
        if let Some(around) = frame.around.pop() {
            self.builder.land(&around.breaks);
        }
    }

    fn repeat(
        &mut self,
        frame: &mut Frame<'m>,
        body: &'m Block,
        continuing: &'m Block,
        break_if: Option<Expr>,
    ) -> Result<()> {
        let top = self.builder.here();
        frame.around.push(Around { breaks: Vec::new(), continues: Some(Vec::new()) });
        self.inner(frame, body)?;
        if let Some(continues) = frame.around.last_mut().and_then(|a| a.continues.take()) {
            self.builder.land(&continues);
        }
        let scope = self.builder.scope();
        self.block(frame, continuing)?;
        match break_if {
            None => self.builder.jump_to(O::Repeat, 0, top)?,
            Some(condition) => {
                let condition = self.word(frame, condition)?;
                let condition = self.builder.register(condition)?;
                self.builder.jump_to(O::RepeatUnless, condition, top)?;
            }
        }
        self.builder.forget(scope);
        self.land_breaks(frame);
        Ok(())
    }

    fn assign(&mut self, frame: &mut Frame<'m>, pointer: Expr, value: Expr) -> Result<()> {
        let words = self.words(frame, value)?;
        let place = self.place(frame, pointer)?;
        if place.layout == Layout::Buffer {
            return unsupported("it writes into a buffer");
        }
        for (i, word) in words.iter().enumerate() {
            match place.offset {
                None => self.builder.store((place.base + i) as u16, *word)?,
                Some(offset) => self.builder.store_at(place.base + i, offset, *word)?,
            }
        }
        Ok(())
    }
}
