//! Limits on users' shaders, so that a short file neither crashes nor freezes the program.
//!
//! Parsers, validators and compilers of shaders recurse as deep as the code is nested, inline every call and
//! lay out every array, without limits of their own, and a stack overflow ends the process. A text is
//! therefore checked before it is parsed ([`check_text`]), and a module before it is validated
//! ([`check_module`]) or passed to a driver. All of this takes time proportional to the length of the text.
//!
//! The numbers: threads of Bevy and of rayon have stacks of 2 MiB, on which naga 29 and naga_oil 0.22 can
//! recurse at least four times as deep as allowed here (tested by `hostile`); the shipped shaders stay five
//! times below.

use std::thread;

use naga::{Module, Span};

use super::{
    check::{ShaderProblem, locate},
    compose::{Composed, EVALUATE, LIGHT_ALONE, SEEN, SHADING_ALONE, WRAPPER},
    token,
};

mod closed;
mod expansion;
mod module;
mod text;

pub use closed::{is_empty, unfinished};

/// Limits on a shader.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Maximum size of a composed text, in bytes. The preprocessor has 21 bits for a position in it.
    pub bytes: usize,
    /// Maximum number of tokens in a composed text.
    pub tokens: usize,
    /// Maximum number of statements in a composed text.
    pub statements: usize,
    /// Maximum number of declarations in a composed text: functions, constants, types, variables.
    pub declarations: usize,
    /// Maximum nesting of brackets, including template lists.
    pub nesting: usize,
    /// Maximum number of operators, calls and brackets on one path through an expression.
    pub depth: usize,
    /// Maximum nesting of blocks; each `else if` counts as nested in the one before.
    pub blocks: usize,
    /// Maximum number of `case` values in a switch.
    pub cases: usize,
    /// Maximum length of a chain of declarations that use each other.
    pub chain: usize,
    /// Maximum number of elements in an array.
    pub elements: u64,
    /// Maximum number of words in a constant or a type when everything in it is expanded.
    pub expansion: u64,
    /// Maximum size of a value or variable, in bytes. Software Vulkan takes quadratic time: ten seconds for
    /// this size.
    pub value_bytes: u32,
    /// Maximum size of the variables of a function, including the functions that it calls, and of a module,
    /// in bytes; also that of constants.
    pub variable_bytes: u64,
    /// Maximum number of expressions in a function.
    pub expressions: usize,
    /// Maximum length of a chain of expressions that use each other, including through `let`.
    pub values: usize,
    /// Maximum number of steps in a function with all calls inlined, as drivers do.
    pub steps: u64,
    /// Maximum nesting of loops.
    pub loops: usize,
}

/// The limits for models and other shaders of the lab.
pub const LIMITS: Limits = Limits {
    bytes: 1 << 20,
    tokens: 100_000,
    statements: 8_192,
    declarations: 2_048,
    nesting: 100,
    depth: 256,
    blocks: 64,
    cases: 256,
    chain: 64,
    elements: 4_096,
    expansion: 65_536,
    value_bytes: 4 << 10,
    variable_bytes: 16 << 10,
    expressions: 32_768,
    values: 1_024,
    steps: 196_608,
    loops: 16,
};

/// Stack size for parsing and checking anything within the limits, in bytes: twice that of Bevy's threads.
const STACK: usize = 4 << 20;

/// Checks a composed text before it is parsed.
///
/// # Errors
/// Returns anything beyond a limit, in terms of the author's file.
pub fn check_text(composed: &Composed) -> Result<(), Box<ShaderProblem>> {
    let text = &composed.text;
    let line_of = |at: usize| text.as_bytes()[..at].iter().filter(|b| **b == b'\n').count() + 1;
    let binds = |at: usize| {
        let file = composed.map.locate(line_of(at)).map(|(file, _)| file);
        file.is_none_or(|file| {
            [WRAPPER.path, SEEN.path, EVALUATE.path, LIGHT_ALONE, SHADING_ALONE].contains(&file)
        })
    };
    text::check(text, &LIMITS, binds).map_err(|refusal| match refusal {
        text::Refusal::At(at, what) => {
            let start = text[..at].rfind('\n').map_or(0, |i| i + 1);
            locate(composed, Some((line_of(at), at - start + 1)), what)
        }
        // The longest file accounts for most of it.
        text::Refusal::Whole(what) => locate(composed, composed.longest_file().map(|line| (line, 1)), what),
    })
}

/// The first thing in a module that exceeds a limit: its position, and the message. The module need not be
/// valid.
#[must_use]
pub fn check_module(module: &Module) -> Option<(Span, String)> {
    module::check(module, &LIMITS).err()
}

/// Calls a function on a stack large enough for anything within the limits; `None` if it panics, or if the
/// stack cannot be allocated.
pub(super) fn on_stack<T: Send>(call: impl FnOnce() -> T + Send) -> Option<T> {
    thread::scope(|scope| {
        let thread = thread::Builder::new().name("shader".to_owned()).stack_size(STACK);
        thread.spawn_scoped(scope, call).ok()?.join().ok()
    })
}

#[cfg(test)]
mod tests {
    use naga::front::wgsl;

    use super::*;
    use crate::{
        registry::{
            Registry,
            compose::{compose, compose_evaluation},
        },
        shader::whole,
        shading::Stage,
    };

    impl Limits {
        fn divided(self, n: u8) -> Self {
            let (size, count) = (usize::from(n), u64::from(n));
            Self {
                bytes: self.bytes / size,
                tokens: self.tokens / size,
                statements: self.statements / size,
                declarations: self.declarations / size,
                nesting: self.nesting / size,
                depth: self.depth / size,
                blocks: self.blocks / size,
                cases: self.cases / size,
                chain: self.chain / size,
                elements: self.elements / count,
                expansion: self.expansion / count,
                value_bytes: self.value_bytes / u32::from(n),
                variable_bytes: self.variable_bytes / count,
                expressions: self.expressions / size,
                values: self.values / size,
                steps: self.steps / count,
                loops: self.loops / size,
            }
        }
    }

    /// All texts of the shipped models, for drawing and for evaluation.
    fn shipped() -> Vec<(String, Composed)> {
        let mut registry = Registry::builtin();
        for (name, text) in crate::library::assets::EXAMPLES {
            let path = std::path::Path::new(name);
            let model = crate::custom::read(path, text, &registry).unwrap_or_else(|p| panic!("{p:?}"));
            registry.put_custom_model(model);
        }
        let mut texts = Vec::new();
        for model in registry.models() {
            let id = model.declaration.id;
            texts.push((format!("{id}, evaluated"), compose_evaluation(registry.sources(), model)));
            for shading in registry.shading_models() {
                let composed = compose(registry.sources(), model, shading, registry.lights());
                let faces = shading.declaration.stage == Stage::Polygon;
                let text = whole::standing_alone(&composed.text, faces).expect("built in");
                texts.push((format!("{id}, {}", shading.declaration.id), Composed { text, ..composed }));
            }
        }
        texts
    }

    #[test]
    fn what_is_shipped_stays_far_below_the_limits() {
        let fifth = LIMITS.divided(5);
        for (name, composed) in shipped() {
            let checked = text::check(&composed.text, &fifth, |_| true);
            assert!(checked.is_ok(), "{name}: {checked:?}");
            let module = wgsl::parse_str(&composed.text).expect("valid");
            assert_eq!(module::check(&module, &fifth), Ok(()), "{name}");
        }
    }
}
