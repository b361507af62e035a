//! Translates naga's expressions to words and instructions.

use std::rc::Rc;

use naga::{BinaryOperator, Expression, RelationalFunction, ScalarKind, TypeInner, UnaryOperator};

use super::{
    Result,
    builder::Operand,
    instruction::Operation as O,
    lower::{Frame, Lowering, Place, Value, literal},
    shape::{self, Layout},
    unsupported,
};
use crate::shader::blocks::Expr;

type Words = Rc<[Operand]>;

/// Two values word by word; a single word is combined with each word of the other.
fn pairs<'a>(a: &'a [Operand], b: &'a [Operand]) -> impl Iterator<Item = (Operand, Operand)> + 'a {
    let count = a.len().max(b.len());
    let at = |words: &[Operand], i: usize| words[i.min(words.len() - 1)];
    let count = if a.is_empty() || b.is_empty() { 0 } else { count };
    (0..count).map(move |i| (at(a, i), at(b, i)))
}

/// The type of the numbers of a value.
pub(super) fn kind_of(inner: &TypeInner) -> ScalarKind {
    match inner.scalar_kind() {
        Some(ScalarKind::AbstractInt) => ScalarKind::Sint,
        Some(ScalarKind::AbstractFloat) | None => ScalarKind::Float,
        Some(kind) => kind,
    }
}

impl<'m> Lowering<'m> {
    /// Calculates an expression.
    pub(super) fn expression(&mut self, frame: &mut Frame<'m>, handle: Expr) -> Result<Value> {
        let function = frame.function;
        let words: Words = match function.expressions[handle] {
            Expression::Literal(value) => match literal(value) {
                Some(bits) => Rc::new([Operand::Constant(bits)]),
                None => return unsupported("it uses numbers that are not 32 bits wide"),
            },
            Expression::Constant(constant) => self.constant(constant)?,
            Expression::Override(handle) => {
                let name = self.module.overrides[handle].name.as_deref().unwrap_or_default();
                return unsupported(format!("it uses the override {name}"));
            }
            Expression::ZeroValue(ty) => {
                vec![Operand::Constant(0); shape::words(self.module, &self.module.types[ty].inner)?].into()
            }
            Expression::Compose { ref components, .. } => {
                let mut words = Vec::new();
                for component in components {
                    words.extend_from_slice(&self.words(frame, *component)?);
                }
                words.into()
            }
            Expression::Access { base, index } => return self.access(frame, base, index),
            Expression::AccessIndex { base, index } => return self.access_index(frame, base, index as usize),
            Expression::Splat { size, value } => vec![self.word(frame, value)?; size as usize].into(),
            Expression::Swizzle { size, vector, pattern } => {
                let words = self.words(frame, vector)?;
                pattern[..size as usize].iter().map(|c| words[*c as usize]).collect()
            }
            Expression::FunctionArgument(index) => {
                return match frame.arguments.get(index as usize) {
                    Some(value) => Ok(value.clone()),
                    None => unsupported("it uses an argument that it does not have"),
                };
            }
            Expression::GlobalVariable(variable) => return self.global(variable).map(Value::Place),
            Expression::LocalVariable(variable) => {
                let base = usize::from(frame.locals[variable.index()]);
                return Ok(Value::Place(Place { base, offset: None, layout: Layout::Packed }));
            }
            Expression::Load { pointer } => self.load(frame, pointer)?,
            Expression::Unary { op, expr } => self.unary(frame, op, expr)?,
            Expression::Binary { op, left, right } => self.binary(frame, op, left, right)?,
            Expression::Select { condition, accept, reject } => {
                self.select(frame, condition, accept, reject)?
            }
            Expression::Relational { fun, argument } => self.relational(frame, fun, argument)?,
            Expression::Math { fun, arg, arg1, arg2, arg3 } => {
                let kind = kind_of(self.type_of(frame, arg));
                let mut arguments = Vec::with_capacity(4);
                for argument in [Some(arg), arg1, arg2, arg3].into_iter().flatten() {
                    arguments.push(self.words(frame, argument)?);
                }
                let arg_type = self.type_of(frame, arg).clone();
                self.math(fun, kind, &arg_type, &arguments)?
            }
            Expression::As { expr, kind, convert } => self.cast(frame, expr, kind, convert)?,
            Expression::ArrayLength(pointer) => {
                // Only the table is an accessible buffer.
                self.place(frame, pointer)?;
                Rc::new([Operand::Constant(1)])
            }
            Expression::CallResult(_) => return unsupported("it uses the result of a call before the call"),
            Expression::ImageSample { .. } => return unsupported("it samples a texture"),
            Expression::ImageLoad { .. } | Expression::ImageQuery { .. } => {
                return unsupported("it reads a texture");
            }
            Expression::Derivative { .. } => return unsupported("it takes a derivative"),
            Expression::AtomicResult { .. } => return unsupported("it uses atomics"),
            Expression::WorkGroupUniformLoadResult { .. } => return unsupported("it waits at a barrier"),
            Expression::RayQueryVertexPositions { .. }
            | Expression::RayQueryProceedResult
            | Expression::RayQueryGetIntersection { .. } => return unsupported("it traces rays"),
            Expression::SubgroupBallotResult | Expression::SubgroupOperationResult { .. } => {
                return unsupported("it uses subgroup operations");
            }
            Expression::CooperativeLoad { .. } | Expression::CooperativeMultiplyAdd { .. } => {
                return unsupported("it uses cooperative matrices");
            }
        };
        Ok(Value::Words(words))
    }

    fn access(&mut self, frame: &mut Frame<'m>, base: Expr, index: Expr) -> Result<Value> {
        let index = match self.word(frame, index)? {
            Operand::Constant(bits) => return self.access_index(frame, base, bits as usize),
            register @ Operand::Register(_) => register,
        };
        let value = self.value(frame, base)?;
        let layout = match &value {
            Value::Words(_) => Layout::Packed,
            Value::Place(place) => place.layout,
        };
        let elements = shape::elements(self.module, self.type_of(frame, base), layout)?;
        let last = Operand::Constant(elements.count.saturating_sub(1) as u32);
        let offset =
            self.builder.emit(O::Index, &[index, last, Operand::Constant(elements.stride as u32)])?;
        match value {
            Value::Words(words) => {
                let first = usize::from(self.builder.in_a_row(&words)?);
                let offset = self.builder.register(offset)?;
                let mut element = Vec::with_capacity(elements.words);
                for k in 0..elements.words {
                    element.push(self.builder.load_at(first + k, offset)?);
                }
                Ok(Value::Words(element.into()))
            }
            Value::Place(place) => {
                let sum = match place.offset {
                    Some(before) => self.builder.emit(O::AddI, &[Operand::Register(before), offset])?,
                    None => offset,
                };
                let sum = self.builder.register(sum)?;
                Ok(Value::Place(Place { offset: Some(sum), ..place }))
            }
        }
    }

    fn access_index(&mut self, frame: &mut Frame<'m>, base: Expr, index: usize) -> Result<Value> {
        let value = self.value(frame, base)?;
        let inner = self.type_of(frame, base);
        match value {
            Value::Place(place) => {
                let skipped = shape::member(self.module, inner, index, place.layout)?;
                Ok(Value::Place(Place { base: place.base + skipped, ..place }))
            }
            Value::Words(words) => {
                let start = shape::member(self.module, inner, index, Layout::Packed)?;
                let count = match inner {
                    TypeInner::Struct { members, .. } => match members.get(index) {
                        Some(m) => shape::words(self.module, &self.module.types[m.ty].inner)?,
                        None => return unsupported("it uses a member that a struct does not have"),
                    },
                    inner => shape::elements(self.module, inner, Layout::Packed)?.words,
                };
                match words.get(start..start + count) {
                    Some(part) => Ok(Value::Words(part.into())),
                    None => unsupported("it uses a component that a value does not have"),
                }
            }
        }
    }

    fn load(&mut self, frame: &mut Frame<'m>, pointer: Expr) -> Result<Words> {
        let place = self.place(frame, pointer)?;
        let offsets = shape::offsets(self.module, self.type_of(frame, pointer), place.layout)?;
        let mut words = Vec::with_capacity(offsets.len());
        for offset in offsets {
            let at = place.base + offset;
            words.push(match place.offset {
                Some(offset) => self.builder.load_at(at, offset)?,
                None if place.layout == Layout::Buffer => Operand::Register(at as u16),
                None => self.builder.emit(O::Copy, &[Operand::Register(at as u16)])?,
            });
        }
        Ok(words.into())
    }

    fn unary(&mut self, frame: &mut Frame<'m>, op: UnaryOperator, expr: Expr) -> Result<Words> {
        let kind = kind_of(self.type_of(frame, expr));
        let operation = match (op, kind) {
            (UnaryOperator::Negate, ScalarKind::Float) => O::NegF,
            (UnaryOperator::Negate, _) => O::NegI,
            (UnaryOperator::LogicalNot, _) => O::Not,
            (UnaryOperator::BitwiseNot, _) => O::Complement,
        };
        let words = self.words(frame, expr)?;
        self.map(operation, &[&words])
    }

    fn binary(
        &mut self,
        frame: &mut Frame<'m>,
        op: BinaryOperator,
        left: Expr,
        right: Expr,
    ) -> Result<Words> {
        use BinaryOperator as B;
        let (a, b) = (self.words(frame, left)?, self.words(frame, right)?);
        let (left, right) = (self.type_of(frame, left), self.type_of(frame, right));
        if op == B::Multiply
            && let Some(sizes) = product(left, right)
        {
            return self.matrix_product(&a, &b, sizes);
        }
        let kind = match kind_of(left) {
            ScalarKind::Float => 0,
            ScalarKind::Sint => 1,
            _ => 2,
        };
        // For floats, for signed and for unsigned integers.
        let operations = match op {
            B::Add => [O::AddF, O::AddI, O::AddI],
            B::Subtract => [O::SubF, O::SubI, O::SubI],
            B::Multiply => [O::MulF, O::MulI, O::MulI],
            B::Divide => [O::DivF, O::DivS, O::DivU],
            B::Modulo => [O::RemF, O::RemS, O::RemU],
            B::Equal => [O::EqualF, O::EqualI, O::EqualI],
            B::NotEqual => [O::NotEqualF, O::NotEqualI, O::NotEqualI],
            B::Less | B::Greater => [O::LessF, O::LessS, O::LessU],
            B::LessEqual | B::GreaterEqual => [O::LessEqualF, O::LessEqualS, O::LessEqualU],
            B::And | B::LogicalAnd => [O::And; 3],
            B::InclusiveOr | B::LogicalOr => [O::Or; 3],
            B::ExclusiveOr => [O::Xor; 3],
            B::ShiftLeft => [O::ShiftLeft; 3],
            B::ShiftRight => [O::ShiftRightU, O::ShiftRightS, O::ShiftRightU],
        };
        let sides = if matches!(op, B::Greater | B::GreaterEqual) { [&*b, &*a] } else { [&*a, &*b] };
        self.map(operations[kind], &sides)
    }

    /// Applies an operation word by word; single words are combined with each word of the others.
    pub(super) fn map(&mut self, operation: O, values: &[&[Operand]]) -> Result<Words> {
        let count = values.iter().map(|v| v.len()).max().unwrap_or(0);
        let mut words = Vec::with_capacity(count);
        for i in 0..count {
            let mut operands = [Operand::Constant(0); 3];
            for (operand, value) in operands.iter_mut().zip(values) {
                match value.get(if value.len() == 1 { 0 } else { i }) {
                    Some(word) => *operand = *word,
                    None => return unsupported("it calculates with values of different sizes"),
                }
            }
            words.push(self.builder.emit(operation, &operands[..values.len()])?);
        }
        Ok(words.into())
    }

    /// The sum of products of the words of two values.
    pub(super) fn dot(&mut self, a: &[Operand], b: &[Operand], float: bool) -> Result<Operand> {
        if float && let Some(sum) = self.builder.dot(a, b)? {
            return Ok(sum);
        }
        let mut sum = None;
        for (x, y) in pairs(a, b) {
            sum = Some(match (sum, float) {
                (None, true) => self.builder.emit(O::MulF, &[x, y])?,
                (None, false) => self.builder.emit(O::MulI, &[x, y])?,
                (Some(sum), true) => self.builder.emit(O::MulAddF, &[x, y, sum])?,
                (Some(sum), false) => {
                    let product = self.builder.emit(O::MulI, &[x, y])?;
                    self.builder.emit(O::AddI, &[sum, product])?
                }
            });
        }
        Ok(sum.unwrap_or(Operand::Constant(0)))
    }

    /// The product of matrices stored column by column; a vector is a matrix of one column, or of one row.
    fn matrix_product(
        &mut self,
        a: &[Operand],
        b: &[Operand],
        (rows, inner, columns): Sizes,
    ) -> Result<Words> {
        let mut words = Vec::with_capacity(rows * columns);
        for column in 0..columns {
            for row in 0..rows {
                let across: Vec<_> = (0..inner).map(|k| a[k * rows + row]).collect();
                words.push(self.dot(&across, &b[column * inner..][..inner], true)?);
            }
        }
        Ok(words.into())
    }

    fn select(
        &mut self,
        frame: &mut Frame<'m>,
        condition: Expr,
        accept: Expr,
        reject: Expr,
    ) -> Result<Words> {
        let condition = self.words(frame, condition)?;
        let (accept, reject) = (self.words(frame, accept)?, self.words(frame, reject)?);
        match *condition {
            [Operand::Constant(0)] => Ok(reject),
            [Operand::Constant(_)] => Ok(accept),
            _ => self.map(O::Select, &[&condition, &accept, &reject]),
        }
    }

    fn relational(
        &mut self,
        frame: &mut Frame<'m>,
        fun: RelationalFunction,
        argument: Expr,
    ) -> Result<Words> {
        let words = self.words(frame, argument)?;
        let operation = match fun {
            RelationalFunction::All => O::And,
            RelationalFunction::Any => O::Or,
            RelationalFunction::IsNan => return self.map(O::NotEqualF, &[&words, &words]),
            RelationalFunction::IsInf => {
                let size = self.map(O::AbsF, &[&words])?;
                return self.map(O::EqualF, &[&size, &[Operand::Constant(f32::INFINITY.to_bits())]]);
            }
        };
        let Some((first, rest)) = words.split_first() else { return Ok(words) };
        let mut all = *first;
        for word in rest {
            all = self.builder.emit(operation, &[all, *word])?;
        }
        Ok(Rc::new([all]))
    }

    fn cast(
        &mut self,
        frame: &mut Frame<'m>,
        expr: Expr,
        to: ScalarKind,
        convert: Option<u8>,
    ) -> Result<Words> {
        let from = kind_of(self.type_of(frame, expr));
        let words = self.words(frame, expr)?;
        if convert.is_some_and(|width| width != 4 && to != ScalarKind::Bool) {
            return unsupported("it uses numbers that are not 32 bits wide");
        }
        if convert.is_none() {
            return Ok(words);
        }
        let operation = match (from, to) {
            (ScalarKind::Float, ScalarKind::Sint) => O::FloatToS,
            (ScalarKind::Float, ScalarKind::Uint) => O::FloatToU,
            (ScalarKind::Sint, ScalarKind::Float) => O::SToFloat,
            (ScalarKind::Uint, ScalarKind::Float) => O::UToFloat,
            (ScalarKind::Bool, ScalarKind::Float) => O::BoolToFloat,
            (ScalarKind::Float, ScalarKind::Bool) => O::FloatToBool,
            (ScalarKind::Sint | ScalarKind::Uint, ScalarKind::Bool) => O::IntToBool,
            _ => return Ok(words),
        };
        self.map(operation, &[&words])
    }
}

/// Rows, inner length and columns of a product of matrices.
type Sizes = (usize, usize, usize);

/// The sizes of a product of a matrix with a matrix or a vector.
fn product(left: &TypeInner, right: &TypeInner) -> Option<Sizes> {
    use TypeInner::{Matrix, Vector};
    match (left, right) {
        (Matrix { columns: k, rows, .. }, Matrix { columns, .. }) => {
            Some((*rows as usize, *k as usize, *columns as usize))
        }
        (Matrix { columns: k, rows, .. }, Vector { .. }) => Some((*rows as usize, *k as usize, 1)),
        (Vector { size, .. }, Matrix { columns, .. }) => Some((1, *size as usize, *columns as usize)),
        _ => None,
    }
}
