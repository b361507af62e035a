//! Translates naga's functions to instructions: functions and calls, and the positions of values.
//!
//! Calls are inlined, vectors and structs are split into words. Rearranging words (swizzles, constructors,
//! members) takes no instructions, and arguments are not copied.

use std::{collections::HashMap, rc::Rc};

use naga::{
    AddressSpace, Block, Expression, Function, GlobalVariable, Handle, Literal, Module, Scalar, Statement,
    TypeInner, front::Typifier, proc::ResolveContext,
};

use super::{
    Result,
    builder::{Builder, Operand},
    shape::{self, Layout},
    unsupported,
};
use crate::shader::blocks::{Expr, blocks};

/// The value of an expression.
#[derive(Clone, Debug)]
pub(super) enum Value {
    /// The words of a value.
    Words(Rc<[Operand]>),
    /// A pointer.
    Place(Place),
}

/// The target of a pointer.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    /// The register, apart from an offset known only at run time.
    pub(super) base: usize,
    /// The register with an offset to add.
    pub(super) offset: Option<u16>,
    pub(super) layout: Layout,
}

/// A loop or a switch around a statement: jumps out of it, and to the next iteration.
pub(super) struct Around {
    pub(super) breaks: Vec<usize>,
    pub(super) continues: Option<Vec<usize>>,
}

/// A function being inlined.
pub(super) struct Frame<'m> {
    pub(super) function: &'m Function,
    /// True for the function being run, false for those that it calls.
    pub(super) is_outermost: bool,
    pub(super) types: Rc<Typifier>,
    pub(super) arguments: Vec<Value>,
    pub(super) values: Vec<Option<Value>>,
    pub(super) locals: Vec<u16>,
    /// The registers of the results; `None` if there is a single `return` at the end, and its value needs no
    /// copy.
    pub(super) results: Option<u16>,
    /// The value of that single `return`.
    pub(super) returned: Rc<[Operand]>,
    /// Jumps to the end.
    pub(super) returns: Vec<usize>,
    /// Enclosing loops and switches, the innermost last.
    pub(super) around: Vec<Around>,
}

pub(super) struct Lowering<'m> {
    pub(super) module: &'m Module,
    pub(super) builder: Builder,
    /// The values of the module's constant expressions; `None` for unsupported ones.
    constants: Vec<Option<Rc<[Operand]>>>,
    types: HashMap<Handle<Function>, Rc<Typifier>>,
    /// The registers of private variables in use.
    globals: HashMap<Handle<GlobalVariable>, u16>,
    /// The initial values of private variables.
    pub(super) initial: Vec<(u16, u32)>,
    /// The buffer used as input, and its first register.
    pub(super) row: Option<(Handle<GlobalVariable>, u16)>,
    /// The `let`s of the outermost function whose values are kept, and their registers.
    pub(super) watched: HashMap<Expr, Vec<u16>>,
    /// True while inside the outermost function.
    is_inside: bool,
}

/// The bits of a number; `None` if it is not 32 bits wide.
pub(super) fn literal(literal: Literal) -> Option<u32> {
    match literal {
        Literal::F32(v) => Some(v.to_bits()),
        Literal::U32(v) => Some(v),
        Literal::I32(v) => Some(v.cast_unsigned()),
        Literal::Bool(v) => Some(u32::from(v)),
        Literal::AbstractInt(v) => i32::try_from(v).ok().map(i32::cast_unsigned),
        Literal::AbstractFloat(v) => Some((v as f32).to_bits()),
        Literal::F64(_) | Literal::F16(_) | Literal::U64(_) | Literal::I64(_) => None,
    }
}

/// True if a function has no `return`, or only one as its last statement.
fn returns_last(function: &Function) -> bool {
    fn returns(block: &Block) -> usize {
        let own = |statement: &Statement| usize::from(matches!(statement, Statement::Return { .. }));
        block.iter().map(|statement| own(statement) + blocks(statement).map(returns).sum::<usize>()).sum()
    }
    match returns(&function.body) {
        0 => true,
        1 => matches!(function.body.last(), Some(Statement::Return { .. })),
        _ => false,
    }
}

impl<'m> Lowering<'m> {
    pub(super) fn new(module: &'m Module) -> Self {
        let mut lowering = Self {
            module,
            builder: Builder::default(),
            constants: Vec::new(),
            types: HashMap::new(),
            globals: HashMap::new(),
            initial: Vec::new(),
            row: None,
            watched: HashMap::new(),
            is_inside: false,
        };
        for (_, expression) in module.global_expressions.iter() {
            let value = lowering.constant_expression(expression);
            lowering.constants.push(value);
        }
        lowering
    }

    /// The value of a constant expression of the module, whose operands come before it.
    fn constant_expression(&self, expression: &Expression) -> Option<Rc<[Operand]>> {
        let known = |handle: Expr| self.constants.get(handle.index())?.clone();
        match expression {
            Expression::Literal(v) => Some(Rc::new([Operand::Constant(literal(*v)?)])),
            Expression::Constant(constant) => known(self.module.constants[*constant].init),
            Expression::ZeroValue(ty) => {
                let words = shape::words(self.module, &self.module.types[*ty].inner).ok()?;
                Some(vec![Operand::Constant(0); words].into())
            }
            Expression::Compose { components, .. } => {
                let parts: Option<Vec<_>> = components.iter().map(|c| known(*c)).collect();
                Some(parts?.iter().flat_map(|p| p.iter().copied()).collect())
            }
            Expression::Splat { size, value } => Some(vec![*known(*value)?.first()?; *size as usize].into()),
            _ => None,
        }
    }

    /// The value of a module constant.
    pub(super) fn constant(&self, constant: Handle<naga::Constant>) -> Result<Rc<[Operand]>> {
        let constant = &self.module.constants[constant];
        match self.constants.get(constant.init.index()) {
            Some(Some(value)) => Ok(value.clone()),
            _ => {
                let name = constant.name.as_deref().unwrap_or("without a name");
                unsupported(format!(
                    "it uses the constant {name}, whose value does not consist of 32-bit numbers"
                ))
            }
        }
    }

    /// A pointer to a module variable.
    pub(super) fn global(&mut self, handle: Handle<GlobalVariable>) -> Result<Place> {
        if let Some((row, base)) = self.row
            && row == handle
        {
            return Ok(Place { base: usize::from(base), offset: None, layout: Layout::Buffer });
        }
        let variable = &self.module.global_variables[handle];
        let name = variable.name.as_deref().unwrap_or_default();
        match variable.space {
            AddressSpace::Private => {}
            AddressSpace::Uniform | AddressSpace::Storage { .. } => {
                return unsupported(format!("it uses the buffer {name}"));
            }
            AddressSpace::Handle => return unsupported(format!("it uses the texture or sampler {name}")),
            _ => {
                let why = "which belongs to a stage of the pipeline";
                return unsupported(format!("it uses the variable {name}, {why}"));
            }
        }
        let place = |base: u16| Place { base: usize::from(base), offset: None, layout: Layout::Packed };
        if let Some(&base) = self.globals.get(&handle) {
            return Ok(place(base));
        }
        let words = shape::words(self.module, &self.module.types[variable.ty].inner)?;
        let base = self.builder.variable(words)?;
        let value = match variable.init {
            None => vec![Operand::Constant(0); words].into(),
            Some(init) => match self.constants.get(init.index()) {
                Some(Some(value)) => value.clone(),
                _ => {
                    let why = "which does not start with a constant";
                    return unsupported(format!("it uses the variable {name}, {why}"));
                }
            },
        };
        for (i, word) in value.iter().enumerate() {
            if let Operand::Constant(bits) = word {
                self.initial.push((base + i as u16, *bits));
            }
        }
        self.globals.insert(handle, base);
        Ok(place(base))
    }

    /// The types of the expressions of a function.
    fn types(&mut self, handle: Handle<Function>) -> Result<Rc<Typifier>> {
        if let Some(known) = self.types.get(&handle) {
            return Ok(known.clone());
        }
        let function = &self.module.functions[handle];
        let context =
            ResolveContext::with_locals(self.module, &function.local_variables, &function.arguments);
        let mut types = Typifier::new();
        for (expression, _) in function.expressions.iter() {
            if types.grow(expression, &function.expressions, &context).is_err() {
                return unsupported("it has an expression without a type");
            }
        }
        let types = Rc::new(types);
        self.types.insert(handle, types.clone());
        Ok(types)
    }

    /// The number of words of an expression of a function, if it is a float or a vector of them.
    pub(super) fn floats_of(&mut self, function: Handle<Function>, handle: Expr) -> Result<Option<usize>> {
        let types = self.types(function)?;
        Ok(match types.get(handle, &self.module.types) {
            TypeInner::Scalar(scalar) if *scalar == Scalar::F32 => Some(1),
            TypeInner::Vector { size, scalar } if *scalar == Scalar::F32 => Some(*size as usize),
            _ => None,
        })
    }

    /// Inlines a call, and returns the words of the result.
    pub(super) fn call(&mut self, handle: Handle<Function>, arguments: Vec<Value>) -> Result<Rc<[Operand]>> {
        let function = &self.module.functions[handle];
        let types = self.types(handle)?;
        self.builder.enter()?;
        let count = match &function.result {
            Some(result) => shape::words(self.module, &self.module.types[result.ty].inner)?,
            None => 0,
        };
        let results = if returns_last(function) { None } else { Some(self.builder.variable(count)?) };
        let is_outermost = !std::mem::replace(&mut self.is_inside, true);
        let mut frame = Frame {
            function,
            is_outermost,
            types,
            arguments,
            values: vec![None; function.expressions.len()],
            locals: Vec::new(),
            results,
            returned: Rc::new([]),
            returns: Vec::new(),
            around: Vec::new(),
        };
        self.locals(&mut frame)?;
        // Literals and arguments have values without a statement.
        let named = if is_outermost { self.watched.keys().copied().collect() } else { Vec::new() };
        for handle in named.into_iter().filter(|handle| function.expressions[*handle].needs_pre_emit()) {
            self.watch(&mut frame, handle)?;
        }
        let scope = self.builder.scope();
        self.block(&mut frame, &function.body)?;
        self.builder.land(&frame.returns);
        self.builder.leave();
        let Some(base) = results else { return Ok(frame.returned) };
        self.builder.forget(scope);
        Ok((0..count).map(|i| Operand::Register(base + i as u16)).collect())
    }

    /// Keeps the value of a watched `let`. Values in branches that are not taken stay NaN.
    pub(super) fn watch(&mut self, frame: &mut Frame<'m>, handle: Expr) -> Result<()> {
        if !frame.is_outermost {
            return Ok(());
        }
        let Some(registers) = self.watched.get(&handle).cloned() else { return Ok(()) };
        let words = self.words(frame, handle)?;
        for (register, word) in registers.iter().zip(words.iter()) {
            self.builder.store(*register, *word)?;
        }
        Ok(())
    }

    /// Gives local variables their registers and initial values.
    fn locals(&mut self, frame: &mut Frame<'m>) -> Result<()> {
        let function = frame.function;
        for (_, variable) in function.local_variables.iter() {
            let words = shape::words(self.module, &self.module.types[variable.ty].inner)?;
            let base = self.builder.variable(words)?;
            frame.locals.push(base);
            let value = match variable.init {
                Some(init) => self.words(frame, init)?,
                None => vec![Operand::Constant(0); words].into(),
            };
            for (i, word) in value.iter().enumerate() {
                self.builder.store(base + i as u16, *word)?;
            }
        }
        Ok(())
    }

    /// The type of an expression.
    pub(super) fn type_of<'f>(&'f self, frame: &'f Frame<'m>, handle: Expr) -> &'f TypeInner {
        match frame.types.get(handle, &self.module.types) {
            TypeInner::Pointer { base, .. } => &self.module.types[*base].inner,
            inner => inner,
        }
    }

    /// The value of an expression: calculated before, or available without calculation.
    pub(super) fn value(&mut self, frame: &mut Frame<'m>, handle: Expr) -> Result<Value> {
        if let Some(value) = &frame.values[handle.index()] {
            return Ok(value.clone());
        }
        let value = self.expression(frame, handle)?;
        // Variables keep their positions, constants their values.
        frame.values[handle.index()] = Some(value.clone());
        Ok(value)
    }

    /// The words of a value.
    pub(super) fn words(&mut self, frame: &mut Frame<'m>, handle: Expr) -> Result<Rc<[Operand]>> {
        match self.value(frame, handle)? {
            Value::Words(words) => Ok(words),
            Value::Place(_) => unsupported("it uses a pointer as a value"),
        }
    }

    /// The single word of a value.
    pub(super) fn word(&mut self, frame: &mut Frame<'m>, handle: Expr) -> Result<Operand> {
        match self.words(frame, handle)?.first() {
            Some(word) => Ok(*word),
            None => unsupported("it uses a value of no size"),
        }
    }

    /// The target of a pointer.
    pub(super) fn place(&mut self, frame: &mut Frame<'m>, handle: Expr) -> Result<Place> {
        match self.value(frame, handle)? {
            Value::Place(place) => Ok(place),
            Value::Words(_) => unsupported("it uses a value as a pointer"),
        }
    }
}
