//! Limits on a text before it is parsed: the parser, the lowering and the evaluation of constants recurse as
//! deep as expressions, blocks and types are nested, and a chain such as `a + b + c` is a tree as deep as it
//! is long.

use super::{
    Limits, Refusal, expansion, limited,
    token::{Finding, Kind, Token, at_most, tokens},
};
use crate::text::mathematics::nested_beyond;

/// Finds anything beyond a limit. `binds` is true for bytes at which bindings may be declared.
pub(super) fn check(text: &str, limits: &Limits, binds: impl Fn(usize) -> bool) -> Result<(), Refusal> {
    limited(text.len(), limits.bytes, "bytes")?;
    let tokens = tokens(text, limits.tokens)?.list;
    if tokens.len() > limits.tokens {
        let most = limits.tokens;
        let what = format!("the composed shader has more than {most} words and symbols, the most allowed");
        return Err(Refusal::Whole(what));
    }
    let mut walk = Walk { limits, groups: vec![Group::new(b'{', 0, 0)], sections: Vec::new(), statements: 0 };
    for (i, token) in tokens.iter().enumerate() {
        walk.step(&tokens, i, *token)?;
        if matches!(token.text, "var" | "ptr" | "binding" | "discard" | "override") {
            resource(&tokens, i, &binds)?;
        }
    }
    limited(walk.statements, limits.statements, "statements")?;
    if let Some((at, _)) = walk.sections.last() {
        return Err(Refusal::At(*at, "this condition has no #endif".to_owned()));
    }
    expansion::check(&tokens, limits)
}

/// A part in brackets, or in the braces of a block.
#[derive(Default)]
struct Group {
    open: u8,
    /// The depth of the enclosing trees down to here, without braces in between.
    above: usize,
    /// The nesting depth in brackets, and in braces of blocks.
    nesting: usize,
    /// Number of operators since the last comma: a bound for the depth of the tree.
    operators: usize,
    /// The deepest tree in inner brackets since the last comma.
    deepest: usize,
    /// The deepest tree before that.
    worst: usize,
    /// Number of `else if` in the present chain.
    chain: usize,
    /// Number of `case` values.
    cases: usize,
    /// True between `case` and its block.
    selectors: bool,
}

impl Group {
    fn new(open: u8, above: usize, nesting: usize) -> Self {
        Self { open, above, nesting, ..Self::default() }
    }

    /// Ends a tree at a comma, or a statement at a semicolon.
    fn next(&mut self) {
        self.worst = self.worst.max(self.operators + self.deepest);
        (self.operators, self.deepest) = (0, 0);
    }
}

struct Walk<'l> {
    limits: &'l Limits,
    /// The open groups, the innermost last; the first is the file.
    groups: Vec<Group>,
    /// The start of each preprocessor condition, and the number of groups open there.
    sections: Vec<(usize, usize)>,
    statements: usize,
}

impl Walk<'_> {
    fn step(&mut self, tokens: &[Token], i: usize, token: Token) -> Result<(), Finding> {
        let before = i.checked_sub(1).map(|i| tokens[i]);
        match token.kind {
            Kind::Directive => return self.directive(token),
            Kind::Open if token.text == "{" => self.open_block(token)?,
            Kind::Open | Kind::TemplateOpen => self.open(token)?,
            Kind::Close if token.text == "}" => self.close_block(token)?,
            Kind::Close | Kind::TemplateClose => self.close(token)?,
            // An assignment is not part of an expression.
            Kind::Operator if token.text == "=" => {}
            Kind::Operator | Kind::Dot => self.operator(token)?,
            Kind::Comma => {
                let group = self.innermost();
                group.next();
                group.cases += usize::from(group.selectors);
                self.check_cases(token)?;
            }
            Kind::Semicolon => {
                let group = self.innermost();
                group.next();
                group.chain = 0;
                self.statements += 1;
            }
            Kind::Colon => self.innermost().selectors = false,
            Kind::Word if token.text == "case" => {
                let group = self.innermost();
                group.cases += 1;
                group.selectors = true;
                self.check_cases(token)?;
            }
            Kind::Word if token.text == "if" => {
                let follows = before.is_some_and(|b| b.text == "else");
                let group = self.innermost();
                group.chain = if follows { group.chain + 1 } else { 0 };
                let blocks = group.nesting + group.chain + 1;
                if follows {
                    at_most(blocks, self.limits.blocks, token.at, "; a switch is not nested", || {
                        format!("this `else if` is {blocks} blocks deep, each in the one before")
                    })?;
                }
            }
            _ => {}
        }
        Ok(())
    }

    fn innermost(&mut self) -> &mut Group {
        if self.groups.is_empty() {
            self.groups.push(Group::new(b'{', 0, 0));
        }
        let last = self.groups.len() - 1;
        &mut self.groups[last]
    }

    fn operator(&mut self, token: Token) -> Result<(), Finding> {
        let group = self.innermost();
        group.operators += 1;
        let depth = group.above + group.operators + group.deepest;
        self.check_depth(token, depth)
    }

    fn open(&mut self, token: Token) -> Result<(), Finding> {
        let group = self.innermost();
        // A call, an index and a template list are operators on what precedes them.
        group.operators += 1;
        let above = group.above + group.operators;
        let nesting = if group.open == b'{' { 1 } else { group.nesting + 1 };
        self.check_depth(token, above)?;
        if nesting > self.limits.nesting {
            return Err((token.at, nested_beyond(self.limits.nesting)));
        }
        self.groups.push(Group::new(token.text.as_bytes()[0], above, nesting));
        Ok(())
    }

    fn close(&mut self, token: Token) -> Result<(), Finding> {
        // Mismatched brackets are reported by the parser, which does not read further.
        if self.innermost().open == b'{' || self.in_section(1) {
            return self.unbalanced(token);
        }
        if let Some(mut closed) = self.groups.pop() {
            closed.next();
            let group = self.innermost();
            group.deepest = group.deepest.max(closed.worst);
            let depth = group.above + group.operators + group.deepest;
            return self.check_depth(token, depth);
        }
        Ok(())
    }

    fn open_block(&mut self, token: Token) -> Result<(), Finding> {
        self.statements += 1;
        let group = self.innermost();
        group.next();
        group.selectors = false;
        let blocks = group.nesting + group.chain + 1;
        let what = || format!("this block is nested {blocks} deep");
        at_most(blocks, self.limits.blocks, token.at, "", what)?;
        self.groups.push(Group::new(b'{', 0, blocks));
        Ok(())
    }

    fn close_block(&mut self, token: Token) -> Result<(), Finding> {
        let Some(open) = self.groups.iter().rposition(|g| g.open == b'{').filter(|open| *open > 0) else {
            return self.unbalanced(token);
        };
        if self.in_section(self.groups.len() - open) {
            return self.unbalanced(token);
        }
        self.groups.truncate(open);
        self.innermost().next();
        Ok(())
    }

    /// True if closing this many groups would close one from before the open condition.
    fn in_section(&self, closed: usize) -> bool {
        self.sections.last().is_some_and(|(_, open)| self.groups.len() < open + closed)
    }

    /// Refuses unbalanced code in conditions: code hidden from the parser must not hide depth here.
    fn unbalanced(&self, token: Token) -> Result<(), Finding> {
        if self.sections.is_empty() {
            return Ok(());
        }
        Err((token.at, "this closes a bracket from before an open condition: its #endif is missing, or it does not close its own brackets".to_owned()))
    }

    fn directive(&mut self, token: Token) -> Result<(), Finding> {
        let open = self.groups.len();
        if token.text.starts_with("if") {
            self.sections.push((token.at, open));
        } else if token.text.starts_with("else") || token.text.starts_with("endif") {
            let Some(&(_, began)) = self.sections.last() else {
                return Err((token.at, format!("this #{} has no condition before it", token.text)));
            };
            if open != began {
                let what = "brackets opened in this condition are not closed; each part of a condition must close its own";
                return Err((token.at, what.to_owned()));
            }
            if token.text.starts_with("endif") {
                self.sections.pop();
            }
        }
        Ok(())
    }

    fn check_cases(&mut self, token: Token) -> Result<(), Finding> {
        let most = self.limits.cases;
        at_most(self.innermost().cases, most, token.at, "", || {
            format!("this switch has more than {most} cases")
        })
    }

    fn check_depth(&self, token: Token, depth: usize) -> Result<(), Finding> {
        at_most(depth, self.limits.depth, token.at, "; put parts of it into variables", || {
            format!("this expression has {depth} operators and brackets on one path")
        })
    }
}

/// Refuses features that are not available to models: memory, since their input comes as parameters;
/// `discard`, since they do not only draw pixels; and constants set from outside.
fn resource(tokens: &[Token], i: usize, binds: impl Fn(usize) -> bool) -> Result<(), Finding> {
    let token = tokens[i];
    if token.kind == Kind::Word && matches!(token.text, "discard" | "override") && !binds(token.at) {
        let instead = if token.text == "discard" { "return zero instead" } else { "write const" };
        return Err((token.at, format!("`{}` is not available to a model; {instead}", token.text)));
    }
    let next = |n: usize| tokens.get(i + n).map_or("", |t| t.text);
    if matches!(token.text, "var" | "ptr") && next(1) == "<" {
        let space = next(2);
        if space == "workgroup" {
            let what = "workgroup memory is not available to a model; use var<private> or a local variable";
            return Err((token.at, what.to_owned()));
        }
        let own = token.text == "ptr" || matches!(space, "private" | "function");
        if !own && !binds(token.at) {
            let what = format!("var<{space}> is not available to a model; its input comes as parameters");
            return Err((token.at, what));
        }
    }
    let attribute = i > 0 && tokens[i - 1].kind == Kind::Attribute;
    if attribute && token.text == "binding" && !binds(token.at) {
        let number = next(2);
        let what = format!(
            "@binding({number}) is not available to a model: it has no buffers or textures; its input comes as parameters"
        );
        return Err((tokens[i - 1].at, what));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shader::limits::LIMITS;

    fn said(text: &str) -> String {
        let small = crate::shader::limits::Limits { nesting: 3, depth: 8, blocks: 3, cases: 2, ..LIMITS };
        match check(text, &small, |_| false) {
            Ok(()) => String::new(),
            Err(Refusal::At(at, what)) => format!("{at}: {what}"),
            Err(Refusal::Whole(what) | Refusal::Sum(_, what)) => what,
        }
    }

    #[test]
    fn depth_is_that_of_trees_and_brackets_and_not_length() {
        for text in [
            "fn f() { let y = ((x)); }",
            "fn f() { let y = a + b + c + d + e + f + g; }",
            "fn f() { let y = array(a + b + c + d, a + b + c + d, a + b + c + d); }",
            "fn f() { let y = a + b + c + d; let z = a + b + c + d; }",
            "fn f() { if a < b { } if a < b { } if a < b { } if c < d { } }",
            "fn f() { let y = array<vec2<f32>, 2>(vec2<f32>(a), vec2<f32>(b)); }",
            "fn f() { let y = a<<b; let z = a >= b; { { x = 1; } } }",
            "fn f() { switch x { case 1: { } case 2: { } default: { } } switch x { case 1, 2: { } } }",
            "fn f() { if a { } else if b { } else { } if c { } else if d { } }",
            "/* ((((( /* ((( */ ((( */ fn f() { } // (((((((",
        ] {
            assert_eq!(said(text), "", "{text}");
        }
        for (text, found, what) in [
            ("fn f() { let y = ((((x)))); }", "(x)", "nested more than 3 brackets deep, the most allowed"),
            ("fn f() { let y = a[b[c[d[0]]]]; }", "[0]", "nested more than 3 brackets"),
            ("fn f() { let y = a<b<c<d<e>>>>(); }", "<e>", "nested more than 3 brackets"),
            ("fn f() { let y = a<1, b<1, c<1, d<1, e>>>>(); }", "<1, e>", "nested more than 3 brackets"),
            ("fn f() { let y = a+b+c+d+e+f+g+h+i+j; }", "+j", "has 9 operators"),
            ("fn f() { let y = - - - - - - - - -x; }", "-x", "has 9 operators"),
            ("fn f() { let y = x.x.x.x.x.x.x.x.x.y; }", ".y", "has 9 operators"),
            ("fn f() { let y = a + (b + (c + d + e + f + g + h)); }", "+ h", "has 9 operators"),
            ("fn f() { let y = (a + (b + c + d + e + f + h)) + g; }", "+ g", "has 9 operators"),
            ("fn f() { { { { } } } }", "{ } } } }", "nested 4 deep; at most 3"),
            ("fn f() { if a { } else if b { } else if c { } }", "if c", "4 blocks deep"),
            ("fn f() { switch x { case 1, 2, 3: { } } }", ", 3", "more than 2 cases"),
            ("fn f() { switch x { case 1: { } case 2: { } case 3: { } } }", "case 3", "more than 2 cases"),
        ] {
            let said = said(text);
            let at = text.find(found).expect("in the text");
            assert!(said.starts_with(&format!("{at}: ")) && said.contains(what), "{text}\n{said}");
        }
    }

    #[test]
    fn nothing_is_hidden_by_what_the_preprocessor_leaves_out() {
        assert_eq!(said("#ifdef A\nfn f() { x = (1); }\n#else\nfn f() { }\n#endif\n"), "");
        assert_eq!(said("fn f() {\n#ifdef A\n x = (1);\n#endif\n}"), "");
        for (text, what) in [
            ("fn f() { x = (\n#ifdef A\n)\n#endif\n1); }", "from before an open condition"),
            ("fn f() {\n#ifdef A\n}\n#endif\n}", "from before an open condition"),
            ("#ifdef A\nfn f() { x = (\n#else\n#endif", "must close its own"),
            ("#ifdef A\nfn f() { }", "has no #endif"),
            ("fn f() { }\n#endif", "has no condition before it"),
            ("/* */ # ifdef A\nfn f() { }", "has no #endif"),
            ("#ifdef A /*\n#endif */", "has no #endif"),
            ("#define A \"\n/* \"", "not closed"),
            ("fn f() { x = \"a\"; }", "no quotation marks"),
            ("// a\u{2028}b", "ends the comment"),
            ("// a\rb", "ends the comment"),
            ("fn\u{85}f() { }", "invisible"),
            ("fn f\u{a0}() { }", "4: the invisible character U+00A0 (no-break space)"),
        ] {
            assert!(said(text).contains(what), "{text:?}\n{}", said(text));
        }
        assert_eq!(said("// a\r\n/* \u{2028} */ fn ü() { }"), "");
    }

    #[test]
    fn constants_and_types_are_counted_as_they_are_written_out() {
        for text in [
            "const N = 8; const M = N * 2; fn f() { var a: array<f32, M>; var b: array<vec2<f32>, 2 * N,>; }",
            "alias T = array<f32, 64>; struct S { a: T, b: array<T, 8> } fn f(s: S) -> T { return s.a; }",
            "fn g() { } fn f() { g(); const N = 4; var a: array<f32, u32(N)>; }",
        ] {
            assert_eq!(said(text), "", "{text}");
        }
        let chain: String = (0..90).map(|i| format!("fn g{}() {{ g{i}(); }} ", i + 1)).collect();
        let doubled: String =
            (0..20).map(|i| format!("const A{} = array(A{i}, A{i}); ", i + 1)).rev().collect();
        for (text, what) in [
            ("fn f() { var a: array<f32, 5000>; }", "up to 5000 elements"),
            ("const N = 100; fn f() { var a: array<f32, N * N>; }", "elements"),
            ("fn f() { var a: array<f32, 1 << 20>; }", "cannot be determined"),
            ("fn f() { var a: array<f32, u32(1.0 / 0.00001)>; }", "cannot be determined"),
            ("fn f() { let y = a[0]; } const a = array<array<array<f32, 99>, 99>, 99>();", "this expands to"),
            ("alias A = array<f32, 999>; alias B = array<A, 999>;", "this expands to"),
            (&chain, "a chain of 81"),
            (&doubled, "this expands to"),
        ] {
            assert!(said(text).contains(what), "{text}\n{}", said(text));
        }
        // The parser reports a declaration that uses itself.
        assert_eq!(said("const A = B; const B = A; fn f() { f(); }"), "");
    }
}
