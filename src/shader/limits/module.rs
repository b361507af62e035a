//! Limits on a parsed module: the size of values and variables, the depth of expressions, and the total with
//! all calls inlined.

use naga::{
    Block, Expression, Function, Handle, Module, Span, Statement, Type, TypeInner, front::Typifier,
    proc::ResolveContext,
};

use super::{Limits, token::at_most};

type Finding = (Span, String);
type Result<T> = std::result::Result<T, Finding>;

/// Size, in bytes, from which reading or writing a value counts as more than one step.
const LARGE: u32 = 256;

/// The first thing in a module that exceeds a limit.
pub(super) fn check(module: &Module, limits: &Limits) -> Result<()> {
    constants(module, limits)?;
    let mut private = 0;
    for (handle, variable) in module.global_variables.iter() {
        if matches!(variable.space, naga::AddressSpace::Private | naga::AddressSpace::WorkGroup) {
            let span = module.global_variables.get_span(handle);
            private += u64::from(size(module, limits, variable.ty, span, "this variable")?);
            within(private, limits.variable_bytes, span, "bytes of variables of the module")?;
        }
    }
    // Functions come after those they call.
    let mut costs: Vec<Cost> = Vec::with_capacity(module.functions.len());
    for (handle, function) in module.functions.iter() {
        let cost = Walk::new(module, limits, function, &costs).function(module.functions.get_span(handle))?;
        costs.push(cost);
    }
    for entry in &module.entry_points {
        Walk::new(module, limits, &entry.function, &costs).function(Span::UNDEFINED)?;
    }
    Ok(())
}

fn within(found: u64, most: u64, span: Span, what: &str) -> Result<()> {
    at_most(found, most, span, "", || format!("this makes {found} {what}"))
}

/// The size of a type in bytes, if a value may have it.
fn size(module: &Module, limits: &Limits, ty: Handle<Type>, span: Span, what: &str) -> Result<u32> {
    match bytes(module, &module.types[ty].inner) {
        Some(size) if size <= limits.value_bytes => Ok(size),
        size => {
            let size = size.map_or_else(|| "more than a gigabyte".to_owned(), |s| format!("{s} bytes"));
            Err((span, format!("{what} takes {size}; at most {} are allowed", limits.value_bytes)))
        }
    }
}

/// The size of a type in bytes; `None` if it is too large to count.
fn bytes(module: &Module, inner: &TypeInner) -> Option<u32> {
    match inner {
        TypeInner::Pointer { .. } | TypeInner::ValuePointer { .. } => Some(4),
        inner => inner.try_size(module.to_ctx()),
    }
}

/// Checks the sizes and the depth of constants.
fn constants(module: &Module, limits: &Limits) -> Result<()> {
    let mut depths: Vec<usize> = Vec::with_capacity(module.global_expressions.len());
    for (handle, expression) in module.global_expressions.iter() {
        let mut depth = 0;
        let mut note = |h: Handle<Expression>| depth = depth.max(depths.get(h.index()).copied().unwrap_or(0));
        match expression {
            Expression::Constant(constant) => note(module.constants[*constant].init),
            other => operands(other, note),
        }
        let span = module.global_expressions.get_span(handle);
        // One word of the text may produce three expressions.
        let what = || format!("this constant depends on a chain of {depth} others");
        at_most(depth + 1, 4 * limits.chain, span, "", what)?;
        depths.push(depth + 1);
        if let Expression::Compose { ty, .. } | Expression::ZeroValue(ty) = *expression {
            size(module, limits, ty, span, "this value")?;
        }
    }
    let mut sum = 0;
    for (handle, constant) in module.constants.iter() {
        let span = module.constants.get_span(handle);
        let bytes = size(module, limits, constant.ty, span, "this constant")?;
        if bytes > LARGE {
            sum += u64::from(bytes);
            within(sum, limits.variable_bytes, span, "bytes of constants")?;
        }
    }
    Ok(())
}

/// The cost of a function with all its calls inlined.
#[derive(Clone, Copy, Default)]
struct Cost {
    steps: u64,
    bytes: u64,
}

struct Walk<'a> {
    module: &'a Module,
    limits: &'a Limits,
    function: &'a Function,
    costs: &'a [Cost],
    cost: Cost,
}

impl<'a> Walk<'a> {
    fn new(module: &'a Module, limits: &'a Limits, function: &'a Function, costs: &'a [Cost]) -> Self {
        Self { module, limits, function, costs, cost: Cost::default() }
    }

    fn function(mut self, span: Span) -> Result<Cost> {
        let (module, limits, function) = (self.module, self.limits, self.function);
        let mut large = false;
        let types = function.arguments.iter().map(|a| a.ty).chain(function.result.iter().map(|r| r.ty));
        for ty in types {
            large |= size(module, limits, ty, span, "a parameter or the result of this function")? > LARGE;
        }
        for (handle, variable) in function.local_variables.iter() {
            let span = function.local_variables.get_span(handle);
            let bytes = size(module, limits, variable.ty, span, "this variable")?;
            large |= bytes > LARGE;
            self.cost.bytes += u64::from(bytes);
            within(self.cost.bytes, limits.variable_bytes, span, "bytes of variables in this function")?;
        }
        large |= self.types_are_large();
        self.expressions(large)?;
        self.block(&function.body, 0)?;
        Ok(self.cost)
    }

    /// True if the module has constants, variables or types that are costly to read.
    fn types_are_large(&self) -> bool {
        let global = |(_, variable): (_, &naga::GlobalVariable)| {
            variable.space == naga::AddressSpace::Private
                && bytes(self.module, &self.module.types[variable.ty].inner).is_none_or(|b| b > LARGE)
        };
        let constant = |(_, constant): (_, &naga::Constant)| {
            bytes(self.module, &self.module.types[constant.ty].inner).is_none_or(|b| b > LARGE)
        };
        self.module.global_variables.iter().any(global) || self.module.constants.iter().any(constant)
    }

    /// The depth of expressions; each counts one step, or as many as its value has words.
    fn expressions(&mut self, mut large: bool) -> Result<()> {
        let (module, limits, function) = (self.module, self.limits, self.function);
        let span = |handle| function.expressions.get_span(handle);
        let context = ResolveContext::with_locals(module, &function.local_variables, &function.arguments);
        let mut types = Typifier::new();
        let mut depths: Vec<usize> = Vec::with_capacity(function.expressions.len());
        for (handle, expression) in function.expressions.iter() {
            let mut depth = 0;
            operands(expression, |h| depth = depth.max(depths.get(h.index()).copied().unwrap_or(0)));
            at_most(
                depth + 1,
                limits.values,
                span(handle),
                "; a variable in between starts a new chain",
                || format!("this ends a chain of {depth} values, each calculated from the one before"),
            )?;
            depths.push(depth + 1);
            if let Expression::Compose { ty, .. } | Expression::ZeroValue(ty) = *expression {
                large |= size(module, limits, ty, span(handle), "this value")? > LARGE;
            }
            let mut steps = 1;
            if large && types.grow(handle, &function.expressions, &context).is_ok() {
                let inner = types.get(handle, &module.types);
                steps = u64::from(bytes(module, inner).unwrap_or(u32::MAX) / 16).max(1);
            }
            self.cost.steps += steps;
            self.check_steps(span(handle))?;
        }
        let (count, most) = (function.expressions.len(), limits.expressions);
        if count > most {
            let last = function.expressions.iter().last().map_or(Span::UNDEFINED, |(h, _)| span(h));
            return Err((last, format!("this function has {count} expressions; at most {most} are allowed")));
        }
        Ok(())
    }

    fn check_steps(&self, span: Span) -> Result<()> {
        let steps = self.cost.steps;
        at_most(steps, self.limits.steps, span, "", || {
            format!(
                "up to here the function takes {steps} steps with all calls inlined, as graphics drivers do"
            )
        })
    }

    fn block(&mut self, block: &Block, loops: usize) -> Result<()> {
        for (statement, span) in block.span_iter() {
            self.cost.steps += 1;
            match statement {
                Statement::Block(inner) => self.block(inner, loops)?,
                Statement::If { accept, reject, .. } => {
                    self.block(accept, loops)?;
                    self.block(reject, loops)?;
                }
                Statement::Switch { cases, .. } => {
                    let (count, most) = (cases.len(), self.limits.cases);
                    let what = || format!("this switch has {count} cases");
                    at_most(count.saturating_sub(1), most, *span, "", what)?;
                    for case in cases {
                        self.cost.steps += 1;
                        self.block(&case.body, loops)?;
                    }
                }
                Statement::Loop { body, continuing, .. } => {
                    if loops == self.limits.loops {
                        let what =
                            format!("this loop is within {loops} others; at most {loops} may be nested");
                        return Err((*span, what));
                    }
                    self.block(body, loops + 1)?;
                    self.block(continuing, loops + 1)?;
                }
                Statement::Call { function, .. } => {
                    let called = self.costs.get(function.index()).copied().unwrap_or_default();
                    self.cost.steps = self.cost.steps.saturating_add(called.steps);
                    self.cost.bytes = self.cost.bytes.saturating_add(called.bytes);
                    let what = "bytes of variables in this function and those it calls";
                    within(self.cost.bytes, self.limits.variable_bytes, *span, what)?;
                }
                other => {
                    if let Some(what) = unavailable(other) {
                        return Err((*span, format!("{what} are not available to a model")));
                    }
                }
            }
            self.check_steps(*span)?;
        }
        Ok(())
    }
}

/// The name of a statement that models have no use for and that might hang.
fn unavailable(statement: &Statement) -> Option<&'static str> {
    use Statement as S;
    match statement {
        S::ControlBarrier(_) | S::MemoryBarrier(_) | S::WorkGroupUniformLoad { .. } => Some("barriers"),
        S::Atomic { .. } | S::ImageAtomic { .. } => Some("atomics"),
        S::SubgroupBallot { .. } | S::SubgroupGather { .. } | S::SubgroupCollectiveOperation { .. } => {
            Some("subgroup operations")
        }
        _ => None,
    }
}

/// Calls a function with each operand of an expression.
fn operands(expression: &Expression, mut each: impl FnMut(Handle<Expression>)) {
    use Expression as E;
    match expression {
        E::Compose { components, .. } => components.iter().copied().for_each(each),
        E::Access { base: a, index: b } | E::Binary { left: a, right: b, .. } => {
            each(*a);
            each(*b);
        }
        E::AccessIndex { base: a, .. }
        | E::Splat { value: a, .. }
        | E::Swizzle { vector: a, .. }
        | E::Load { pointer: a }
        | E::Unary { expr: a, .. }
        | E::Derivative { expr: a, .. }
        | E::Relational { argument: a, .. }
        | E::As { expr: a, .. }
        | E::ArrayLength(a) => each(*a),
        E::Select { condition, accept, reject } => {
            each(*condition);
            each(*accept);
            each(*reject);
        }
        E::Math { arg, arg1, arg2, arg3, .. } => {
            each(*arg);
            [arg1, arg2, arg3].into_iter().flatten().copied().for_each(each);
        }
        E::ImageLoad { image, coordinate, array_index, sample, level } => {
            each(*image);
            each(*coordinate);
            [array_index, sample, level].into_iter().flatten().copied().for_each(each);
        }
        E::ImageSample { image, coordinate, .. } => {
            each(*image);
            each(*coordinate);
        }
        _ => {}
    }
}
