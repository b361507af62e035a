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

use std::collections::BTreeMap;

use naga::{Module, Span};

use super::{
    compose::{BODY, Composed, EVALUATE, FILE, LIGHT_ALONE, SEEN, SHADING_ALONE, WRAPPER},
    place::locate,
    problem::ShaderProblem,
    token::{self, Finding, at_most},
};

mod closed;
mod expansion;
mod module;
mod numbers;
mod text;

pub use closed::{is_empty, unfinished};
pub use numbers::{LIMITS, Limits};

pub use super::token::LONGEST_WORD;

/// The reason for refusing a text.
#[derive(Debug)]
enum Refusal {
    /// Something at a byte.
    At(usize, String),
    /// The size of the whole.
    Whole(String),
    /// The sum of parts: the byte and the size of each.
    Sum(Vec<(usize, u64)>, String),
}

impl From<Finding> for Refusal {
    fn from((at, what): Finding) -> Self {
        Self::At(at, what)
    }
}

/// Stack size for parsing and checking anything within the limits, in bytes: twice that of Bevy's threads.
const STACK: usize = 4 << 20;

/// Refuses a shader with too many of something.
fn limited(found: usize, most: usize, what: &str) -> Result<(), Refusal> {
    at_most(found, most, (), "", || format!("the composed shader has {found} {what}"))
        .map_err(|((), what)| Refusal::Whole(what))
}

/// Checks a composed text before it is parsed.
///
/// # Errors
/// Returns anything beyond a limit, in terms of the author's file.
pub fn check_text(composed: &Composed) -> Result<(), Box<ShaderProblem>> {
    let text = &composed.text;
    let ends: Vec<_> = text.match_indices('\n').map(|(end, _)| end).collect();
    let line_of = |at: usize| ends.partition_point(|end| *end < at) + 1;
    let file_of = |at: usize| composed.map.locate(line_of(at)).map(|(file, _)| file);
    let binds = |at: usize| {
        file_of(at).is_none_or(|file| {
            [WRAPPER.path, SEEN.path, EVALUATE.path, BODY, FILE, LIGHT_ALONE, SHADING_ALONE].contains(&file)
        })
    };
    let place_of = |at: usize| {
        let start = text[..at].rfind('\n').map_or(0, |i| i + 1);
        (line_of(at), at - start + 1)
    };
    text::check(text, &LIMITS, binds).map_err(|refusal| match refusal {
        Refusal::At(at, what) => locate(composed, Some(place_of(at)), what),
        // The longest file makes up most of it.
        Refusal::Whole(what) => locate(composed, composed.longest_file().map(|line| (line, 1)), what),
        Refusal::Sum(parts, what) => locate(composed, greatest(&parts, file_of).map(place_of), what),
    })
}

/// The greatest part of the file that makes up most of a sum.
fn greatest<F: Ord>(parts: &[(usize, u64)], file_of: impl Fn(usize) -> F) -> Option<usize> {
    let mut files: BTreeMap<F, (u64, (u64, usize))> = BTreeMap::new();
    for (at, size) in parts {
        let (sum, most) = files.entry(file_of(*at)).or_default();
        *sum = sum.saturating_add(*size);
        *most = (*most).max((*size, *at));
    }
    files.into_values().max().map(|(_, (_, at))| at)
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
    crate::platform::on_stack("shader", STACK, call)
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
            for (shading, passage) in registry
                .shading_models()
                .iter()
                .flat_map(|shading| model.passages().into_iter().map(move |passage| (shading, passage)))
            {
                let composed = compose(registry.sources(), (model, passage), shading, registry.lights());
                let faces = shading.declaration.stage == Stage::Polygon;
                let text = whole::standing_alone(&composed.text, faces).expect("built in");
                let name = format!("{id} {passage:?}, {}", shading.declaration.id);
                texts.push((name, Composed { text, ..composed }));
            }
        }
        texts
    }

    #[test]
    fn the_largest_shader_is_as_documented() {
        let page = include_str!("../../../docs/custom-models.md").replace('\n', " ");
        for words in [
            "solid body of OpenPBR",
            "about 28 000 of the 150 000 words",
            "below a fifth of the 393 216 words",
        ] {
            assert!(page.contains(words), "{words}");
        }
        assert_eq!((LIMITS.tokens, 4 * LIMITS.expansion), (150_000, 393_216));
        let all = shipped();
        let size = |(_, composed): &&(String, Composed)| {
            token::tokens(&composed.text, LIMITS.tokens).map_or(0, |tokens| tokens.list.len())
        };
        let found = all.iter().max_by_key(size).expect("there are some");
        let (count, (name, largest)) = (size(&found), found);
        assert!(name.starts_with("openpbr") && (26_000..30_000).contains(&count), "{name}: {count}");
        // Of all declarations together it is four times as much.
        let passes =
            |expansion| text::check(&largest.text, &Limits { expansion, ..LIMITS }, |_| true).is_ok();
        assert!(passes(LIMITS.expansion / 5) && !passes(LIMITS.expansion / 20), "{name}");
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
