//! Errors that WGSL allows, but that ruin a picture: endless loops and divisions by a constant zero.

use std::{
    cell::RefCell,
    collections::{HashMap, HashSet},
};

use naga::{
    Block, Expression, Function, GlobalVariable, Handle, Literal, LocalVariable, Module, Span, Statement,
    UnaryOperator,
};

use super::blocks::{Expr, blocks};

/// The first such error in a module: its position, and the message.
#[must_use]
pub fn find(module: &Module) -> Option<(Span, String)> {
    let functions = module.functions.iter().map(|(_, function)| function);
    functions.chain(module.entry_points.iter().map(|e| &e.function)).find_map(|function| {
        let search = Search { module, function };
        search.division().or_else(|| search.endless_loop(&function.body))
    })
}

/// The exits of a loop, and their conditions.
#[derive(Default)]
struct Exits {
    /// True if the loop can be left somewhere.
    some: bool,
    /// True if it has an exit that another iteration may reach even if this one does not.
    changing: bool,
}

/// The conditions of a position in a loop.
#[derive(Clone, Copy)]
struct Path {
    /// True if a condition on the way to the position may differ in the next iteration, or if there is none.
    changing: bool,
    conditional: bool,
    /// True if `break` here leaves the loop, and not a `switch` in it.
    breaks: bool,
}

struct Search<'a> {
    module: &'a Module,
    function: &'a Function,
}

impl Search<'_> {
    fn division(&self) -> Option<(Span, String)> {
        self.function.expressions.iter().find_map(|(handle, expression)| match expression {
            Expression::Binary {
                op: naga::BinaryOperator::Divide | naga::BinaryOperator::Modulo,
                right,
                ..
            } if self.is_zero(*right) => {
                Some((self.function.expressions.get_span(handle), "this divides by zero".to_owned()))
            }
            _ => None,
        })
    }

    /// True if an expression is zero, or a vector with a zero component, for all parameters.
    fn is_zero(&self, handle: Expr) -> bool {
        is_zero(&self.function.expressions, handle, self.module)
    }

    /// The value of a constant condition.
    fn always(&self, condition: Expr) -> Option<bool> {
        let (mut at, mut negated) = (condition, false);
        while let Expression::Unary { op: UnaryOperator::LogicalNot, expr } = self.function.expressions[at] {
            (at, negated) = (expr, !negated);
        }
        let literal = match &self.function.expressions[at] {
            Expression::Constant(constant) => {
                &self.module.global_expressions[self.module.constants[*constant].init]
            }
            other => other,
        };
        match literal {
            Expression::Literal(Literal::Bool(truth)) => Some(*truth != negated),
            _ => None,
        }
    }

    /// The first endless loop.
    fn endless_loop(&self, block: &Block) -> Option<(Span, String)> {
        block.span_iter().find_map(|(statement, span)| {
            let wrong = match statement {
                Statement::Loop { body, continuing, break_if } => self.endless(body, continuing, *break_if),
                _ => None,
            };
            let wrong = wrong.map(|what| (*span, what.to_owned()));
            wrong.or_else(|| blocks(statement).find_map(|inner| self.endless_loop(inner)))
        })
    }

    /// The reason why a loop is endless, if it is.
    fn endless(&self, body: &Block, continuing: &Block, break_if: Option<Expr>) -> Option<&'static str> {
        let written = self.written(&[body, continuing]);
        let mut exits = Exits::default();
        let start = Path { changing: false, conditional: false, breaks: true };
        self.exits(body, start, &written, &mut exits);
        match break_if.map(|c| (c, self.always(c))) {
            None | Some((_, Some(false))) => {}
            Some((_, Some(true))) => exits = Exits { some: true, changing: true },
            Some((condition, None)) => {
                exits.some = true;
                exits.changing |= self.may_change(condition, &written);
            }
        }
        match exits {
            Exits { some: false, .. } => Some("this loop has no end: nothing in it leaves it"),
            Exits { changing: false, .. } => {
                Some("this loop ends in its first iteration or never: nothing in its condition changes")
            }
            _ => None,
        }
    }

    /// Collects the exits of a loop from a block in it.
    fn exits(&self, block: &Block, path: Path, written: &Written, exits: &mut Exits) {
        for statement in block {
            match statement {
                Statement::Break if !path.breaks => {}
                Statement::Break | Statement::Return { .. } | Statement::Kill => {
                    exits.some = true;
                    exits.changing |= path.changing || !path.conditional;
                }
                Statement::Block(inner) => self.exits(inner, path, written, exits),
                Statement::If { condition, accept, reject } => {
                    let truth = self.always(*condition);
                    let inner = match truth {
                        Some(_) => path,
                        None => Path {
                            changing: path.changing || self.may_change(*condition, written),
                            conditional: true,
                            ..path
                        },
                    };
                    if truth != Some(false) {
                        self.exits(accept, inner, written, exits);
                    }
                    if truth != Some(true) {
                        self.exits(reject, inner, written, exits);
                    }
                }
                Statement::Switch { selector, cases } => {
                    let inner = Path {
                        changing: path.changing || self.may_change(*selector, written),
                        conditional: true,
                        breaks: false,
                    };
                    cases.iter().for_each(|case| self.exits(&case.body, inner, written, exits));
                }
                // Leaving the function leaves this loop too, even from an inner loop.
                Statement::Loop { body, continuing, .. } => {
                    let inner = Path { changing: true, conditional: true, breaks: false };
                    self.exits(body, inner, written, exits);
                    self.exits(continuing, inner, written, exits);
                }
                _ => {}
            }
        }
    }

    /// True if an expression may have another value in the next iteration of a loop that writes to these
    /// variables. Values used twice are examined once: otherwise a chain of sums of a value with itself would
    /// double the work each time.
    fn may_change(&self, handle: Expr, written: &Written) -> bool {
        if let Some(known) = written.known.borrow().get(&handle) {
            return *known;
        }
        let may = self.may_change_anew(handle, written);
        written.known.borrow_mut().insert(handle, may);
        may
    }

    fn may_change_anew(&self, handle: Expr, written: &Written) -> bool {
        let change = |h: &Expr| self.may_change(*h, written);
        match &self.function.expressions[handle] {
            Expression::Literal(_)
            | Expression::Constant(_)
            | Expression::Override(_)
            | Expression::ZeroValue(_)
            | Expression::FunctionArgument(_) => false,
            Expression::LocalVariable(variable) => written.locals.contains(variable) || written.anything,
            Expression::GlobalVariable(variable) => {
                let constant = matches!(
                    self.module.global_variables[*variable].space,
                    naga::AddressSpace::Uniform | naga::AddressSpace::Handle
                ) || matches!(
                    self.module.global_variables[*variable].space,
                    naga::AddressSpace::Storage { access } if !access.contains(naga::StorageAccess::STORE)
                );
                !constant && (written.anything || written.globals.contains(variable))
            }
            Expression::Load { pointer: inner }
            | Expression::AccessIndex { base: inner, .. }
            | Expression::Splat { value: inner, .. }
            | Expression::Swizzle { vector: inner, .. }
            | Expression::Unary { expr: inner, .. }
            | Expression::Relational { argument: inner, .. }
            | Expression::As { expr: inner, .. }
            | Expression::ArrayLength(inner) => change(inner),
            Expression::Access { base, index } => change(base) || change(index),
            Expression::Binary { left, right, .. } => change(left) || change(right),
            Expression::Select { condition, accept, reject } => {
                change(condition) || change(accept) || change(reject)
            }
            Expression::Compose { components, .. } => components.iter().any(change),
            Expression::Math { arg, arg1, arg2, arg3, .. } => {
                change(arg) || [arg1, arg2, arg3].into_iter().flatten().any(change)
            }
            // The result of a function or of the hardware may differ next time.
            _ => true,
        }
    }

    /// The variables written in some blocks.
    fn written(&self, blocks: &[&Block]) -> Written {
        let mut written = Written::default();
        blocks.iter().for_each(|block| self.collect_written(block, &mut written));
        written
    }

    fn collect_written(&self, block: &Block, written: &mut Written) {
        for statement in block {
            blocks(statement).for_each(|inner| self.collect_written(inner, written));
            match statement {
                Statement::Store { pointer, .. } => self.note(*pointer, written),
                Statement::Call { arguments, .. } => {
                    arguments.iter().for_each(|argument| self.note(*argument, written));
                    // A function may write to any module variable.
                    written.globals.extend(self.module.global_variables.iter().map(|(h, _)| h));
                }
                Statement::Block(_)
                | Statement::If { .. }
                | Statement::Switch { .. }
                | Statement::Loop { .. }
                | Statement::Emit(_)
                | Statement::Break
                | Statement::Continue
                | Statement::Return { .. }
                | Statement::Kill => {}
                _ => written.anything = true,
            }
        }
    }

    /// Records the variable that a pointer points into; other values are ignored.
    fn note(&self, pointer: Expr, written: &mut Written) {
        match &self.function.expressions[pointer] {
            Expression::LocalVariable(variable) => {
                written.locals.insert(*variable);
            }
            Expression::GlobalVariable(variable) => {
                written.globals.insert(*variable);
            }
            Expression::Access { base, .. } | Expression::AccessIndex { base, .. } => {
                self.note(*base, written)
            }
            _ => {}
        }
    }
}

#[derive(Default)]
struct Written {
    locals: HashSet<Handle<LocalVariable>>,
    globals: HashSet<Handle<GlobalVariable>>,
    /// True if there are statements that are not examined: they may write anywhere.
    anything: bool,
    /// The findings on values, see [`Search::may_change`].
    known: RefCell<HashMap<Expr, bool>>,
}

fn is_zero(expressions: &naga::Arena<Expression>, handle: Expr, module: &Module) -> bool {
    match &expressions[handle] {
        Expression::Literal(literal) => matches!(
            literal,
            Literal::F32(0.0)
                | Literal::F64(0.0)
                | Literal::I32(0)
                | Literal::U32(0)
                | Literal::AbstractInt(0)
                | Literal::AbstractFloat(0.0)
        ),
        Expression::ZeroValue(_) => true,
        Expression::Splat { value, .. } => is_zero(expressions, *value, module),
        Expression::Compose { components, .. } => components.iter().any(|c| is_zero(expressions, *c, module)),
        Expression::Constant(constant) => {
            is_zero(&module.global_expressions, module.constants[*constant].init, module)
        }
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        registry::{Registry, compose::compose_evaluation},
        shader::{check, compose::Sources},
    };

    fn said(text: &str) -> String {
        let module = naga::front::wgsl::parse_str(text).expect("WGSL");
        find(&module)
            .map(|(span, what)| format!("{}: {what}", span.location(text).line_number))
            .unwrap_or_default()
    }

    fn in_function(body: &str) -> String {
        said(&format!(
            "struct S {{ n: u32 }}\n@group(0) @binding(0) var<uniform> s: S;\nvar<private> g: u32;\nfn next() -> u32 {{ g += 1u; return g; }}\nfn f(x: f32, n: u32) -> f32 {{\n{body}\nreturn x;\n}}"
        ))
    }

    #[test]
    fn loops_that_nothing_leaves_are_found() {
        for body in [
            "loop { }",
            "while true { }",
            "for (;;) { var y = x; y += 1.0; }",
            "for (var i = 0u; true; i++) { continue; }",
            "loop { switch n { case 0u: { break; } default: {} } }",
            "loop { loop { break; } }",
            "if x > 0.0 { loop { continuing { break if false; } } }",
            "loop { if false { break; } }",
        ] {
            assert!(in_function(body).contains("6: this loop has no end"), "{body}: {}", in_function(body));
        }
    }

    #[test]
    fn loops_whose_condition_cannot_change_are_found() {
        for body in [
            "for (var i = 0u; i < n; ) { g = i; }",
            "var i = 0u; while i < n { g += i; }",
            "var i = 0u; loop { if i > s.n { break; } if i > n { return x; } }",
            "var i = 0u; loop { let y = i; continuing { break if y > 3u; } }",
        ] {
            assert!(in_function(body).contains("first iteration or never"), "{body}: {}", in_function(body));
        }
    }

    #[test]
    fn loops_that_end_are_left_alone() {
        for body in [
            "for (var i = 0u; i < n; i++) { }",
            "var i = 0u; while i < n { i += 2u; }",
            "loop { break; }",
            "loop { return x; }",
            "loop { if next() > 3u { break; } }",
            "var i = 0u; loop { if i > 3u { break; } continuing { i++; } }",
            "while g < 3u { let y = next(); }",
            "var a = array<u32, 3>(); while a[0] < n { a[0] = a[0] + 1u; }",
            "var i = 0u; loop { loop { if i > n { return x; } i++; } }",
            "loop { switch n { case 0u: { return x; } default: { break; } } if next() > 1u { break; } }",
        ] {
            assert_eq!(in_function(body), "", "{body}");
        }
    }

    #[test]
    fn divisions_by_a_constant_zero_are_found() {
        for body in [
            "let y = x / 0.0;",
            "let y = n % 0u;",
            "const Z = 0.0; let y = x / Z;",
            "let y = vec2(x) / vec2(1.0, 0.0);",
        ] {
            assert_eq!(in_function(body), "6: this divides by zero", "{body}");
        }
        for body in ["let y = x / 2.0;", "let y = 0.0 / x;", "let y = x / (x - x);"] {
            assert_eq!(in_function(body), "", "{body}");
        }
    }

    #[test]
    fn no_model_has_one() {
        for model in Registry::builtin().models() {
            let composed = compose_evaluation(&Sources::default(), model);
            assert!(find(&check::validate(&composed).expect("valid")).is_none(), "{}", model.declaration.id);
        }
    }
}
