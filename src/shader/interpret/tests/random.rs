//! Compares random functions with a separate interpreter: variables that change while values read from them
//! are in use, loops, early returns, pointers.

use std::fmt::Write as _;

use super::{run, valid};

#[derive(Clone, Debug)]
enum Expr {
    Number(i32),
    Variable(usize),
    Element(Box<Expr>),
    Known(usize),
    Two(char, Box<Expr>, Box<Expr>),
    Choose(Box<Expr>, Box<Expr>, Box<Expr>),
}

#[derive(Clone, Debug)]
enum Step {
    Set(usize, Expr),
    SetElement(Expr, Expr),
    Shuffle,
    Know(usize, Expr),
    /// Adds to a variable through a pointer, and makes its old value known.
    Bump(usize, usize, Expr),
    Branch(Expr, Vec<Step>, Vec<Step>),
    Switch(Expr, Vec<Step>, Vec<Step>),
    Repeat(i32, Vec<Step>),
    Leave(Expr, &'static str),
    Return(Expr, Expr),
}

const VARIABLES: usize = 3;

struct Source {
    seed: u64,
    /// Values that may be used here.
    known: Vec<usize>,
    next: usize,
}

impl Source {
    fn pick(&mut self, count: usize) -> usize {
        self.seed = self.seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.seed >> 33) as usize % count
    }

    fn expr(&mut self, depth: usize) -> Expr {
        let kinds = if depth == 0 { 4 } else { 8 };
        match self.pick(kinds) {
            0 => Expr::Number(self.pick(7) as i32 - 2),
            1 => Expr::Variable(self.pick(VARIABLES)),
            2 if depth > 0 => Expr::Element(Box::new(self.expr(0))),
            2 | 3 if !self.known.is_empty() => {
                let which = self.pick(self.known.len());
                Expr::Known(self.known[which])
            }
            2..=4 => Expr::Variable(self.pick(VARIABLES)),
            7 => {
                let [a, b, c] = [(); 3].map(|()| Box::new(self.expr(depth - 1)));
                Expr::Choose(a, b, c)
            }
            _ => {
                let operator = ['+', '-', '*', '^', '/', '%'][self.pick(6)];
                Expr::Two(operator, Box::new(self.expr(depth - 1)), Box::new(self.expr(depth - 1)))
            }
        }
    }

    fn block(&mut self, depth: usize, looping: bool) -> Vec<Step> {
        let known = self.known.len();
        let steps = (0..2 + self.pick(4)).map(|_| self.step(depth, looping)).collect();
        self.known.truncate(known);
        steps
    }

    fn know(&mut self) -> usize {
        self.next += 1;
        self.next
    }

    fn step(&mut self, depth: usize, looping: bool) -> Step {
        let kinds = if depth == 0 { 8 } else { 12 };
        match self.pick(kinds) {
            0 | 1 => Step::Set(self.pick(VARIABLES), self.expr(2)),
            2 => Step::SetElement(self.expr(1), self.expr(2)),
            3 => Step::Shuffle,
            4 | 5 => {
                let (expr, name) = (self.expr(2), self.know());
                self.known.push(name);
                Step::Know(name, expr)
            }
            6 => {
                let (variable, expr, name) = (self.pick(VARIABLES), self.expr(1), self.know());
                self.known.push(name);
                Step::Bump(name, variable, expr)
            }
            7 if looping => Step::Leave(self.expr(1), ["break", "continue"][self.pick(2)]),
            7 => Step::Return(self.expr(1), self.expr(1)),
            8 => Step::Switch(self.expr(1), self.block(depth - 1, false), self.block(depth - 1, false)),
            9 | 10 => {
                Step::Branch(self.expr(1), self.block(depth - 1, looping), self.block(depth - 1, looping))
            }
            _ => Step::Repeat(self.pick(4) as i32, self.block(depth - 1, true)),
        }
    }
}

fn text(expr: &Expr) -> String {
    match expr {
        Expr::Number(n) => format!("({n})"),
        Expr::Variable(v) => format!("v{v}"),
        Expr::Element(i) => format!("table[{}]", text(i)),
        Expr::Known(k) => format!("k{k}"),
        Expr::Two(operator, a, b) => format!("({} {operator} {})", text(a), text(b)),
        Expr::Choose(a, b, c) => format!("select({}, {}, {} > 0)", text(a), text(b), text(c)),
    }
}

fn write(steps: &[Step], to: &mut String) {
    for step in steps {
        let _ = match step {
            Step::Set(v, e) => writeln!(to, "v{v} = {};", text(e)),
            Step::SetElement(i, e) => writeln!(to, "table[{}] = {};", text(i), text(e)),
            Step::Shuffle => writeln!(to, "table = table.yxwz;"),
            Step::Know(k, e) => writeln!(to, "let k{k} = {};", text(e)),
            Step::Bump(k, v, e) => writeln!(to, "let k{k} = bump(&v{v}, {});", text(e)),
            Step::Leave(e, how) => writeln!(to, "if {} > 1 {{ {how}; }}", text(e)),
            Step::Return(condition, e) => {
                writeln!(to, "if {} > 9 {{ return {}; }}", text(condition), text(e))
            }
            Step::Branch(e, accept, reject) => {
                let _ = writeln!(to, "if {} > 0 {{", text(e));
                write(accept, to);
                to.push_str("} else {\n");
                write(reject, to);
                writeln!(to, "}}")
            }
            Step::Switch(e, one, other) => {
                let _ = writeln!(to, "switch {} {{ case 1, 2: {{", text(e));
                write(one, to);
                to.push_str("} case 0: {} default: {\n");
                write(other, to);
                writeln!(to, "}} }}")
            }
            Step::Repeat(n, body) => {
                let _ = writeln!(to, "for (var i = 0; i < {n}; i++) {{");
                write(body, to);
                writeln!(to, "}}")
            }
        };
    }
}

#[derive(Default)]
struct State {
    variables: [i32; VARIABLES],
    table: [i32; 4],
    known: std::collections::HashMap<usize, i32>,
}

enum Flow {
    On,
    Leave(&'static str),
    Return(i32),
}

impl State {
    fn value(&self, expr: &Expr) -> i32 {
        match expr {
            Expr::Number(n) => *n,
            Expr::Variable(v) => self.variables[*v],
            Expr::Element(i) => self.table[(self.value(i) as u32).min(3) as usize],
            Expr::Known(k) => self.known[k],
            Expr::Choose(a, b, c) => {
                if self.value(c) > 0 {
                    self.value(b)
                } else {
                    self.value(a)
                }
            }
            Expr::Two(operator, a, b) => {
                let (a, b) = (self.value(a), self.value(b));
                match operator {
                    '+' => a.wrapping_add(b),
                    '-' => a.wrapping_sub(b),
                    '*' => a.wrapping_mul(b),
                    '^' => a ^ b,
                    '/' if b == 0 => a,
                    '/' => a.wrapping_div(b),
                    _ if b == 0 => 0,
                    _ => a.wrapping_rem(b),
                }
            }
        }
    }

    fn steps(&mut self, steps: &[Step]) -> Flow {
        for step in steps {
            match self.step(step) {
                Flow::On => {}
                flow => return flow,
            }
        }
        Flow::On
    }

    fn step(&mut self, step: &Step) -> Flow {
        match step {
            Step::Set(v, e) => self.variables[*v] = self.value(e),
            Step::SetElement(i, e) => self.table[(self.value(i) as u32).min(3) as usize] = self.value(e),
            Step::Shuffle => self.table = [1, 0, 3, 2].map(|i| self.table[i]),
            Step::Know(k, e) => {
                self.known.insert(*k, self.value(e));
            }
            Step::Bump(k, v, e) => {
                let before = self.variables[*v];
                self.variables[*v] = before.wrapping_add(self.value(e));
                self.known.insert(*k, before);
            }
            Step::Leave(e, how) if self.value(e) > 1 => return Flow::Leave(how),
            Step::Return(condition, e) if self.value(condition) > 9 => return Flow::Return(self.value(e)),
            Step::Leave(..) | Step::Return(..) => {}
            Step::Branch(e, accept, reject) => {
                return if self.value(e) > 0 { self.steps(accept) } else { self.steps(reject) };
            }
            Step::Switch(e, one, other) => {
                return match self.value(e) {
                    1 | 2 => self.steps(one),
                    0 => Flow::On,
                    _ => self.steps(other),
                };
            }
            Step::Repeat(n, body) => {
                for _ in 0..*n {
                    match self.steps(body) {
                        Flow::Leave("break") => break,
                        Flow::Leave(_) | Flow::On => {}
                        flow @ Flow::Return(_) => return flow,
                    }
                }
            }
        }
        Flow::On
    }
}

#[test]
fn random_functions_give_what_they_should() {
    let mut lengths = 0;
    for seed in 0..3000 {
        let mut source = Source { seed, known: Vec::new(), next: 0 };
        let steps = source.block(3, false);
        let mut body = String::new();
        write(&steps, &mut body);
        // Once as the function itself, and once called in a loop.
        let text = format!(
            "fn bump(v: ptr<function, i32>, by: i32) -> i32 {{ let before = *v; *v = before + by; return before; }}
            fn inner(a: i32, b: i32) -> i32 {{ var v0 = a; var v1 = b; var v2 = 0; var table = vec4(a, b, 1, 2);
            {body}
            return v0 + 10 * v1 + 100 * v2 + 1000 * (table.x - table.y + 3 * table.z - 5 * table.w); }}
            fn f(a: i32, b: i32) -> vec2<i32> {{ var sum = 0; for (var n = 0; n < 2; n++) {{ sum = 3 * sum + inner(b + n, a); }}
            return vec2(inner(a, b), sum); }}"
        );
        // Constants that divide by zero or are invalid indices are errors in WGSL.
        if !valid(&text) {
            continue;
        }
        lengths += body.len();
        for arguments in [[0, 0], [1, 2], [-3, 12]] {
            let inner = |a: i32, b: i32| {
                let mut state = State { variables: [a, b, 0], table: [a, b, 1, 2], ..State::default() };
                if let Flow::Return(value) = state.steps(&steps) {
                    return value;
                }
                let ([v0, v1, v2], [x, y, z, w]) = (state.variables, state.table);
                let table = x.wrapping_sub(y).wrapping_add(z.wrapping_mul(3)).wrapping_sub(w.wrapping_mul(5));
                v0.wrapping_add(v1.wrapping_mul(10))
                    .wrapping_add(v2.wrapping_mul(100))
                    .wrapping_add(table.wrapping_mul(1000))
            };
            let [a, b] = arguments;
            let sum = inner(b, a).wrapping_mul(3).wrapping_add(inner(b.wrapping_add(1), a));
            let got = run(&text, &arguments.map(i32::cast_unsigned));
            assert_eq!(
                got,
                [inner(a, b), sum].map(i32::cast_unsigned),
                "seed {seed}, {arguments:?}:\n{text}"
            );
        }
    }
    assert!(lengths > 200_000, "the functions are too short to tell much: {lengths}");
}
