//! Errors in a module that could be parsed: the types of its values, and the required types.

use naga::{
    BinaryOperator, Block, Expression, Function, Handle, Module, Span, Statement, TypeInner, UnaryOperator,
    common::wgsl::TypeContext as _,
    front::Typifier,
    proc::ResolveContext,
    valid::{CallError, EntryPointError, FunctionError, ValidationError},
};

use super::{
    Explained,
    scan::{Scan, called, given, misfit, remedy, result, shown},
};
use crate::shader::blocks::{Expr, blocks};

/// The explanation of an error, if it is in a function.
pub(super) fn explained(scan: &Scan, module: &Module, error: &ValidationError) -> Option<Explained> {
    let (name, function, source) = match error {
        ValidationError::Function { handle, name, source } => (name, &module.functions[*handle], source),
        ValidationError::EntryPoint { name, source: EntryPointError::Function(source), .. } => {
            (name, &module.entry_points.iter().find(|entry| entry.name == *name)?.function, source)
        }
        ValidationError::EntryPoint { source: EntryPointError::ForbiddenStageOperations, .. } => {
            let derivative =
                |text: &str| ["dpdx", "dpdy", "fwidth"].iter().any(|word| text.starts_with(word));
            let token = scan.tokens.iter().find(|token| derivative(token.text))?;
            let what = "is not available to a model, which is evaluated without a picture too";
            return Some((Some(token.at), format!("`{}` {what}", token.text)));
        }
        ValidationError::GlobalVariable { name, .. } => {
            let message = format!("a variable outside functions is declared with `var<private> {name}`");
            return Some((None, message));
        }
        _ => return None,
    };
    let values = Values::new(scan, module, name, function);
    match source {
        FunctionError::Expression { handle, .. } => values.expression(*handle),
        other => values.statement(other),
    }
}

/// The values of a function.
struct Values<'a> {
    scan: &'a Scan<'a>,
    module: &'a Module,
    name: &'a str,
    function: &'a Function,
    types: Typifier,
    /// The number of expressions before the first one without a type.
    known: usize,
}

impl<'a> Values<'a> {
    fn new(scan: &'a Scan, module: &'a Module, name: &'a str, function: &'a Function) -> Self {
        let context = ResolveContext::with_locals(module, &function.local_variables, &function.arguments);
        let mut types = Typifier::new();
        let grows = |(handle, _)| types.grow(handle, &function.expressions, &context).is_ok();
        let known = function.expressions.iter().map(grows).take_while(|grows| *grows).count();
        Self { scan, module, name, function, types, known }
    }

    fn of(&self, value: Expr) -> Option<String> {
        (value.index() < self.known)
            .then(|| self.module.to_ctx().type_resolution_to_string(&self.types[value]))
    }

    /// The name of a value, or its text.
    fn source(&self, value: Expr) -> &'a str {
        let function = self.function;
        let named = match &function.expressions[value] {
            Expression::FunctionArgument(index) => function.arguments[*index as usize].name.as_deref(),
            Expression::LocalVariable(variable) => function.local_variables[*variable].name.as_deref(),
            Expression::Load { pointer } => Some(self.source(*pointer)),
            _ => function.named_expressions.get(&value).map(String::as_str),
        };
        named.unwrap_or_else(|| {
            let range = function.expressions.get_span(value).to_range();
            range.map_or("", |range| self.scan.value(range))
        })
    }

    fn place(&self, value: Expr) -> Option<usize> {
        Some(self.function.expressions.get_span(value).to_range()?.start)
    }

    /// The explanation of an invalid expression.
    fn expression(&self, wrong: Expr) -> Option<Explained> {
        let expressions = &self.function.expressions;
        let uses = |expression: &Expression, used: &Expr| match expression {
            Expression::Binary { left, right, .. } => [left, right].contains(&used),
            Expression::Compose { components, .. } => components.contains(used),
            Expression::Splat { value, .. } => value == used,
            _ => false,
        };
        // A number whose type could not be determined from its use.
        let mut wrong = wrong;
        while matches!(expressions[wrong], Expression::Literal(_) | Expression::Splat { .. })
            || self.of(wrong).is_some_and(|of| of.contains("Abstract"))
        {
            wrong = expressions.iter().find(|(_, expression)| uses(expression, &wrong))?.0;
        }
        let message = match &expressions[wrong] {
            Expression::Binary { op, left, right } => self.combined(*op, *left, *right)?,
            Expression::Unary { op, expr } => {
                let of = self.of(*expr)?;
                let (sign, takes) = match op {
                    UnaryOperator::LogicalNot => ("!", "bool"),
                    UnaryOperator::Negate => ("-", "f32"),
                    UnaryOperator::BitwiseNot => ("~", "i32"),
                };
                let value = self.source(*expr);
                let fields = self.scan.fields_of(&of, value).unwrap_or_default();
                format!("{sign} needs {}, but {}{fields}", called(takes), misfit(takes, &of, value))
            }
            Expression::Compose { ty, components } => {
                let at = self.place(wrong)?;
                return self.composed(at, *ty, components);
            }
            Expression::Select { condition, accept, reject } => {
                let of = self.of(*condition)?;
                if of.ends_with("bool") || of.ends_with("bool>") {
                    let (a, b) = (called(&self.of(*reject)?), called(&self.of(*accept)?));
                    format!("the two values of select must have the same type, but are {a} and {b}")
                } else {
                    let misfit = misfit("bool", &of, self.source(*condition));
                    format!("the condition of select must be true or false, but {misfit}")
                }
            }
            Expression::Access { index, .. } => {
                let of = self.of(*index)?;
                format!("an index is a whole number, but {}", misfit("i32", &of, self.source(*index)))
            }
            _ => return None,
        };
        Some((self.place(wrong), message))
    }

    /// The message about two values that an operator does not accept.
    fn combined(&self, op: BinaryOperator, left: Expr, right: Expr) -> Option<String> {
        use BinaryOperator as Op;
        let sign = naga::back::binary_operation_str(op);
        let (a, b) = (self.of(left)?, self.of(right)?);
        let (first, second) = (self.source(left), self.source(right));
        let logical = matches!(op, Op::And | Op::InclusiveOr | Op::LogicalAnd | Op::LogicalOr);
        let compares = matches!(op, Op::Less | Op::LessEqual | Op::Greater | Op::GreaterEqual);
        let fields = self.scan.fields_of(&a, first).or_else(|| self.scan.fields_of(&b, second));
        let hint = if let Some(fields) = fields {
            fields
        } else if op == Op::ExclusiveOr {
            format!("; a power is `pow({first}, {second})`")
        } else if compares && a == "bool" {
            format!("; write `… && {} {sign} {second}`", last_operand(first))
        } else if logical && a != b {
            let (of, value) = if a == "bool" { (&b, second) } else { (&a, first) };
            remedy("bool", of, value)
        } else if compares && (a.starts_with("vec") || b.starts_with("vec")) {
            "; compare a component or the length".to_owned()
        } else if a == "bool" || b == "bool" {
            String::new()
        } else if matches!(a.as_str(), "i32" | "u32") {
            remedy("f32", &a, first)
        } else if let Some(columns) = a.strip_prefix("mat").and_then(|rest| rest.get(..1)) {
            remedy(&format!("vec{columns}<f32>"), &b, second)
        } else {
            remedy(&a, &b, second)
        };
        let [a, b] =
            [(first, a), (second, b)].map(|(value, of)| format!("{}, {}", shown(value), called(&of)));
        Some(format!("{sign} cannot combine {a}, with {b}{hint}"))
    }

    /// The explanation of a struct or a vector constructed from the wrong values.
    fn composed(&self, at: usize, ty: Handle<naga::Type>, components: &[Expr]) -> Option<Explained> {
        let types: Vec<_> = components.iter().map(|value| self.of(*value)).collect::<Option<_>>()?;
        let called_at = self.scan.at(at);
        match &self.module.types[ty].inner {
            TypeInner::Struct { members, .. } => {
                let declared = self.scan.declared(self.module.types[ty].name.as_deref()?)?;
                if members.len() != components.len() {
                    return Some((Some(at), declared.wants(components.len())));
                }
                let wrong =
                    types.iter().zip(&declared.fields).position(|(got, (_, of))| got != &plain(of))?;
                let written = || (at, self.source(components[wrong]));
                let (place, value) = self.argument(called_at, wrong).unwrap_or_else(written);
                Some((Some(place), declared.wants_other(wrong, &types[wrong], value)?))
            }
            TypeInner::Vector { size, .. } => {
                let size = *size as usize;
                let width = |of: &String| of.strip_prefix("vec").and_then(|rest| rest.get(..1)?.parse().ok());
                let count: usize = types.iter().map(|of| width(of).unwrap_or(1)).sum();
                if count != size {
                    let takes = format!("vec{size} takes {size} numbers, or one for all");
                    return Some((Some(at), format!("{takes}, but {}", given(count))));
                }
                let wrong = types.iter().position(|of| matches!(of.as_str(), "i32" | "u32" | "bool"))?;
                let misfit = misfit("f32", &types[wrong], self.source(components[wrong]));
                Some((Some(at), format!("a vec{size} is made of numbers, but {misfit}")))
            }
            _ => None,
        }
    }

    /// The position and the text of a value in the call that begins at a token.
    fn argument(&self, call: usize, index: usize) -> Option<(usize, &'a str)> {
        let part = self.scan.parts(call + 1).get(index)?.clone();
        Some((self.scan.tokens.get(part.start)?.at, self.scan.source(part)))
    }

    /// The explanation of an invalid statement.
    fn statement(&self, error: &FunctionError) -> Option<Explained> {
        let begins =
            |wanted: &dyn Fn(&Statement) -> bool| Some(find(&self.function.body, wanted)?.to_range()?.start);
        let said = |what: &str| Some((None, what.to_owned()));
        match error {
            FunctionError::InvalidReturnType { expression: Some(value), expected_ty } => {
                let at = begins(&|s| matches!(s, Statement::Return { value: Some(v) } if v == value));
                let expected = expected_ty.map(|ty| self.module.to_ctx().type_to_string(ty));
                let (got, value) = (self.of(*value)?, self.source(*value));
                Some((at, result(self.scan, self.name, expected.as_deref(), &got, value)))
            }
            FunctionError::InvalidReturnType { expression: None, expected_ty: Some(ty) } => {
                let bare = begins(&|s| matches!(s, Statement::Return { value: None }));
                if let Some(at) = bare.filter(|at| self.scan.text[*at..].starts_with("return")) {
                    let of = self.module.to_ctx().type_to_string(*ty);
                    let of = self.scan.declared(&of).map_or_else(|| called(&of), |declared| declared.call());
                    let what = format!("{} must return {of}, but this returns nothing", self.name);
                    return Some((Some(at), what));
                }
                let named = |f: &Function| f.name.as_deref() == Some(self.name);
                let (function, _) = self.module.functions.iter().find(|(_, f)| named(f))?;
                let end = self.module.functions.get_span(function).to_range()?.end;
                Some((end.checked_sub(1), format!("the function {} ends without a return", self.name)))
            }
            FunctionError::InvalidStoreTypes { pointer, value } => {
                let at = begins(&|s| matches!(s, Statement::Store { value: v, .. } if v == value));
                let (got, text) = (self.of(*value)?, self.source(*value));
                let target = self.source(*pointer);
                if target.is_empty()
                    || matches!(&self.function.expressions[*pointer], Expression::LocalVariable(v) if self.function.local_variables[*v].name.is_none())
                {
                    let misfit = misfit("bool", &got, text);
                    return Some((at, format!("&& and || need true or false, but {misfit}")));
                }
                let of = self.of(*pointer)?;
                let of = of.split_once(", ").map_or("", |(_, of)| of.trim_end_matches('>'));
                // `vec3<f32>` ends like the pointer type.
                let of = if of.contains('<') { format!("{of}>") } else { of.to_owned() };
                Some((at, format!("`{target}` is {}, but {}", called(&of), misfit(&of, &got, text))))
            }
            FunctionError::InvalidIfType(condition) => {
                let at = begins(&|s| matches!(s, Statement::If { condition: c, .. } if c == condition));
                let (of, text) = (self.of(*condition)?, self.source(*condition));
                let hint = if of.starts_with("vec") && of.contains("bool") {
                    "; write `all(…)` or `any(…)` around the comparison".to_owned()
                } else {
                    remedy("bool", &of, text)
                };
                let is = format!("{} is {}", shown(text), called(&of));
                Some((at, format!("a condition must be true or false, but {is}{hint}")))
            }
            FunctionError::LocalVariable { name, .. } => {
                let rule = "an array needs its length: `array<f32, 3>`";
                Some((None, format!("`{name}` cannot have this type; {rule}")))
            }
            FunctionError::InvalidCall { function, error } => {
                let name = self.module.functions[*function].name.as_deref()?;
                if naga::keywords::wgsl::BUILTIN_IDENTIFIERS.contains(&name) {
                    let defined = |i: &usize| self.scan.before(*i, 1) == "fn" && self.scan.word(*i) == name;
                    let at = (0..self.scan.tokens.len()).find(defined).map(|i| self.scan.tokens[i].at);
                    return Some((at, format!("`{name}` is a function of WGSL; choose another name")));
                }
                let declared = self.scan.declared(name)?;
                match error {
                    CallError::ArgumentCount { seen, .. } => {
                        let called = |s: &Statement| matches!(s, Statement::Call { function: f, arguments, .. } if f == function && arguments.len() == *seen);
                        Some((begins(&called), declared.wants(*seen)))
                    }
                    CallError::ArgumentType { index, seen_expression, .. } => {
                        let called = |s: &Statement| matches!(s, Statement::Call { function: f, arguments, .. } if f == function && arguments.get(*index) == Some(seen_expression));
                        let call = begins(&called)?;
                        let (at, value) = self.argument(self.scan.at(call), *index).unwrap_or((call, ""));
                        Some((Some(at), declared.wants_other(*index, &self.of(*seen_expression)?, value)?))
                    }
                    _ => None,
                }
            }
            FunctionError::BreakOutsideOfLoopOrSwitch => said("break can only stand in a loop or a switch"),
            FunctionError::ContinueOutsideOfLoop => said("continue can only stand in a loop"),
            FunctionError::MissingDefaultCase => said("this switch needs a `default: { … }`"),
            _ => None,
        }
    }
}

/// A type in naga's notation: `vec3f` is `vec3<f32>`.
fn plain(of: &str) -> String {
    match of.as_bytes() {
        [b'v', b'e', b'c', _, b'f'] => format!("{}<f32>", &of[..4]),
        _ => of.replace(' ', ""),
    }
}

/// The last value of a chain of comparisons: `b` of `a < b`.
fn last_operand(text: &str) -> &str {
    text.rsplit(['<', '>', '=']).next().unwrap_or(text).trim()
}

/// The position of the first matching statement in a block.
fn find(block: &Block, wanted: &dyn Fn(&Statement) -> bool) -> Option<Span> {
    block.span_iter().find_map(|(statement, span)| {
        if wanted(statement) {
            return Some(*span);
        }
        blocks(statement).find_map(|inner| find(inner, wanted))
    })
}
