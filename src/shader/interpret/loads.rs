//! Which loads need no copy, and which variables no zeros: where in a function what is read and written.

use naga::{Block, Expression, Function, Handle, LocalVariable, Statement};

/// What a look at a whole function tells.
#[derive(Debug)]
pub(super) struct Facts {
    /// For each expression: a load of a local variable that is not written before the last use of the
    /// value. Then the variable itself stands for the value.
    pub(super) direct: Vec<bool>,
    /// For each local variable whether its first value may be seen.
    pub(super) starts: Vec<bool>,
    /// Whether the only `return` is the last statement.
    pub(super) returns_last: bool,
}

/// The variable that a pointer leads into.
fn root(function: &Function, mut pointer: Handle<Expression>) -> Option<Handle<LocalVariable>> {
    loop {
        match function.expressions[pointer] {
            Expression::LocalVariable(variable) => return Some(variable),
            Expression::Access { base, .. } | Expression::AccessIndex { base, .. } => pointer = base,
            _ => return None,
        }
    }
}

/// Whether the value of an expression always stands in registers of its own.
fn fresh(expression: &Expression) -> bool {
    match expression {
        Expression::Binary { .. } | Expression::Unary { .. } | Expression::Load { .. } => true,
        Expression::Math { fun, .. } => *fun != naga::MathFunction::Transpose,
        _ => false,
    }
}

struct Walk<'a> {
    function: &'a Function,
    now: usize,
    depth: usize,
    returns: usize,
    /// When each expression gets its value, and is last used.
    made: Vec<Option<usize>>,
    used: Vec<usize>,
    /// The loops in the order in which they begin.
    loops: Vec<Round>,
    /// The loop that is being walked through.
    within: Option<usize>,
    /// For each variable the moments at which it is written.
    written: Vec<Vec<usize>>,
    /// For each variable the first moment at which it is seen other than being written as a whole.
    seen: Vec<usize>,
    /// For each variable the first moment at which it is written as a whole, whatever way is taken.
    set: Vec<usize>,
    uses: Vec<(Handle<Expression>, usize)>,
    /// Expressions whose value may be that of another.
    same: Vec<(Handle<Expression>, Handle<Expression>)>,
}

/// First and last moment of a loop, and the loop around it.
struct Round {
    start: usize,
    end: usize,
    around: Option<usize>,
}

impl Walk<'_> {
    fn use_of(&mut self, expression: Handle<Expression>) {
        self.uses.push((expression, self.now));
        self.see(expression);
    }

    fn see(&mut self, expression: Handle<Expression>) {
        if let Some(variable) = root(self.function, expression) {
            let seen = &mut self.seen[variable.index()];
            *seen = (*seen).min(self.now);
        }
    }

    fn write(&mut self, pointer: Handle<Expression>) {
        if let Some(variable) = root(self.function, pointer) {
            self.written[variable.index()].push(self.now);
        }
    }

    fn made(&mut self, expression: Handle<Expression>) {
        self.made[expression.index()] = Some(self.now);
        let kind = &self.function.expressions[expression];
        let fresh = fresh(kind);
        operands(kind, |operand| {
            self.uses.push((operand, self.now));
            if !fresh {
                self.same.push((expression, operand));
            }
        });
        if let Expression::Load { pointer } = *kind {
            self.see(pointer);
        }
    }

    fn block(&mut self, block: &Block) {
        self.depth += 1;
        for statement in block {
            self.now += 1;
            self.statement(statement);
        }
        self.depth -= 1;
    }

    fn statement(&mut self, statement: &Statement) {
        match statement {
            Statement::Emit(range) => {
                for expression in range.clone() {
                    self.now += 1;
                    self.made(expression);
                }
            }
            Statement::Block(block) => {
                // A block of its own is always run.
                self.depth -= 1;
                self.block(block);
                self.depth += 1;
            }
            Statement::If { condition, accept, reject } => {
                self.use_of(*condition);
                self.block(accept);
                self.block(reject);
            }
            Statement::Switch { selector, cases } => {
                self.use_of(*selector);
                for case in cases {
                    self.block(&case.body);
                }
            }
            Statement::Loop { body, continuing, break_if } => {
                let this = self.loops.len();
                self.loops.push(Round { start: self.now, end: usize::MAX, around: self.within });
                self.within = Some(this);
                self.block(body);
                self.block(continuing);
                self.now += 1;
                if let Some(condition) = break_if {
                    self.use_of(*condition);
                }
                self.now += 1;
                self.within = self.loops[this].around;
                self.loops[this].end = self.now;
            }
            Statement::Return { value } => {
                self.returns += 1;
                if let Some(value) = value {
                    self.use_of(*value);
                }
            }
            Statement::Store { pointer, value } => {
                self.use_of(*value);
                self.write(*pointer);
                match self.function.expressions[*pointer] {
                    Expression::LocalVariable(variable) if self.depth == 1 => {
                        let set = &mut self.set[variable.index()];
                        *set = (*set).min(self.now);
                    }
                    Expression::LocalVariable(_) => {}
                    _ => self.see(*pointer),
                }
            }
            Statement::Call { arguments, result, .. } => {
                for argument in arguments {
                    self.use_of(*argument);
                    self.write(*argument);
                    if let Some(result) = result {
                        self.same.push((*result, *argument));
                    }
                }
                if let Some(result) = result {
                    self.made[result.index()] = Some(self.now);
                }
            }
            // The rest is refused.
            _ => {}
        }
    }

    /// The last moment at which a value that was made at one moment and is used at another must last.
    fn lasts(&self, made: usize, used: usize) -> usize {
        // The loop that began last before the use, or one around that.
        let mut at = self.loops.partition_point(|l| l.start < used).checked_sub(1);
        let mut last = used;
        while let Some(round) = at.map(|at| &self.loops[at])
            && round.start >= made
        {
            if used <= round.end {
                last = last.max(round.end);
            }
            at = round.around;
        }
        last
    }
}

/// Calls with each expression that an expression is made of.
fn operands(expression: &Expression, mut each: impl FnMut(Handle<Expression>)) {
    match expression {
        Expression::Compose { components, .. } => components.iter().copied().for_each(each),
        Expression::Access { base, index } => {
            each(*base);
            each(*index);
        }
        Expression::AccessIndex { base, .. } => each(*base),
        Expression::Splat { value, .. } => each(*value),
        Expression::Swizzle { vector, .. } => each(*vector),
        Expression::Load { pointer } => each(*pointer),
        Expression::Unary { expr, .. } | Expression::As { expr, .. } => each(*expr),
        Expression::Binary { left, right, .. } => {
            each(*left);
            each(*right);
        }
        Expression::Select { condition, accept, reject } => {
            each(*condition);
            each(*accept);
            each(*reject);
        }
        Expression::Relational { argument, .. } => each(*argument),
        Expression::Math { arg, arg1, arg2, arg3, .. } => {
            each(*arg);
            [arg1, arg2, arg3].into_iter().flatten().copied().for_each(each);
        }
        // The rest has none, or is refused.
        _ => {}
    }
}

/// Looks at a function.
pub(super) fn facts(function: &Function) -> Facts {
    let (expressions, variables) = (function.expressions.len(), function.local_variables.len());
    let mut walk = Walk {
        function,
        now: 0,
        depth: 0,
        returns: 0,
        made: vec![None; expressions],
        used: vec![0; expressions],
        loops: Vec::new(),
        within: None,
        written: vec![Vec::new(); variables],
        seen: vec![usize::MAX; variables],
        set: vec![usize::MAX; variables],
        uses: Vec::new(),
        same: Vec::new(),
    };
    walk.block(&function.body);
    for (expression, used) in std::mem::take(&mut walk.uses) {
        let made = walk.made[expression.index()].unwrap_or(0);
        let lasts = walk.lasts(made, used);
        let used = &mut walk.used[expression.index()];
        *used = (*used).max(lasts);
    }
    // What is made of a value comes after it, so that the last is settled first.
    let mut same = std::mem::take(&mut walk.same);
    same.sort_unstable_by_key(|(value, _)| std::cmp::Reverse(*value));
    for (value, operand) in same {
        let made = walk.made[operand.index()].unwrap_or(0);
        let lasts = walk.lasts(made, walk.used[value.index()]);
        let used = &mut walk.used[operand.index()];
        *used = (*used).max(lasts);
    }
    let direct = |(handle, expression): (Handle<Expression>, &Expression)| {
        let Expression::Load { pointer } = *expression else { return false };
        let (Some(variable), Some(made)) = (root(function, pointer), walk.made[handle.index()]) else {
            return false;
        };
        let last = walk.used[handle.index()];
        // The moments are in order.
        let written = &walk.written[variable.index()];
        written.get(written.partition_point(|w| *w <= made)).is_none_or(|w| *w > last)
    };
    let last_is_return = matches!(function.body.last(), Some(Statement::Return { .. }));
    Facts {
        direct: function.expressions.iter().map(direct).collect(),
        starts: walk.seen.iter().zip(&walk.set).map(|(seen, set)| seen <= set).collect(),
        returns_last: walk.returns == 0 || walk.returns == 1 && last_is_return,
    }
}
