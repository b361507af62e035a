//! Checks composed sources with naga, and reports problems in terms of the author's own file.

use naga::{
    Module,
    front::wgsl,
    valid::{Capabilities, ValidationFlags, Validator},
};

use super::{compose::Composed, explain, limits, pitfall, place::place};

pub(crate) use super::place::locate;
pub use super::problem::ShaderProblem;

/// Parses and validates a composed source without remaining imports, if it is within the [`limits`].
///
/// # Errors
/// Returns the first problem, located in the author's file.
pub fn validate(composed: &Composed) -> Result<Module, Box<ShaderProblem>> {
    if let Some(problem) = &composed.problem {
        return Err(problem.clone());
    }
    limits::check_text(composed)?;
    limits::on_stack(|| parsed(composed)).unwrap_or_else(|| {
        let what = "the shader cannot be checked: the parser crashes on it; the last change is the cause";
        Err(locate(composed, None, what.to_owned()))
    })
}

fn parsed(composed: &Composed) -> Result<Module, Box<ShaderProblem>> {
    let module = wgsl::parse_str(&composed.text)
        .map_err(|error| explained(composed, explain::unreadable(composed, &error)))?;
    let found = |(span, message): (naga::Span, String)| {
        explained(composed, (span.to_range().map(|range| range.start), message))
    };
    if let Some(beyond) = limits::check_module(&module) {
        return Err(found(beyond));
    }
    Validator::new(ValidationFlags::all(), Capabilities::all())
        .validate(&module)
        .map_err(|error| explained(composed, explain::invalid(composed, &module, &error)))?;
    match pitfall::find(&module) {
        Some(pitfall) => Err(found(pitfall)),
        None => Ok(module),
    }
}

/// An explanation with its position.
fn explained(composed: &Composed, (at, message): explain::Explained) -> Box<ShaderProblem> {
    locate(composed, at.map(|at| place(composed, at)), message)
}

/// The validator's complete message: the outermost part only states that some function is invalid, the
/// innermost explains why.
pub(crate) fn reason(error: &dyn std::error::Error) -> String {
    let mut message = error.to_string();
    let mut source = error.source();
    while let Some(inner) = source {
        message = format!("{message}: {inner}");
        source = inner.source();
    }
    message
}

/// The byte offsets of the members of a struct in a module, by name, and its size; `None` if there is no such struct.
#[must_use]
pub fn struct_layout(module: &Module, name: &str) -> Option<(Vec<(String, usize)>, usize)> {
    module.types.iter().find_map(|(_, ty)| match &ty.inner {
        naga::TypeInner::Struct { members, span } if ty.name.as_deref() == Some(name) => {
            let all = members.iter().map(|m| (m.name.clone().unwrap_or_default(), m.offset as usize));
            Some((all.collect(), *span as usize))
        }
        _ => None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        light::Twin,
        optics::colour::Encoding,
        parameter::{self, Values, stride},
        registry::{
            Registry,
            compose::{compose, compose_evaluation},
        },
        shader::compose::Sources,
    };

    fn members(module: &Module, name: &str) -> Option<Vec<(String, usize)>> {
        struct_layout(module, name).map(|(members, _)| members)
    }

    #[test]
    fn every_model_is_valid_and_its_parameters_lie_where_rust_puts_them() {
        for model in Registry::builtin().models() {
            let module = validate(&compose_evaluation(&Sources::default(), model)).expect("valid WGSL");
            let rust: Vec<_> = parameter::layout(model.parameters)
                .into_iter()
                .map(|(n, _, at)| (n.to_owned(), at))
                .collect();
            assert_eq!(members(&module, "Parameters"), Some(rust), "{}", model.declaration.id);
            let size = module.types.iter().find_map(|(_, t)| match t.inner {
                naga::TypeInner::Struct { span, .. } if t.name.as_deref() == Some("Parameters") => {
                    Some(span as usize)
                }
                _ => None,
            });
            assert_eq!(size, Some(stride(model.parameters)), "{}", model.declaration.id);
        }
    }

    #[test]
    fn the_shader_reads_as_many_words_as_a_light_has() {
        let registry = Registry::builtin();
        let (model, shading) = (&registry.models()[0], &registry.shading_models()[0]);
        let composed =
            compose(&Sources::default(), (model, model.declaration.passage()), shading, registry.lights());
        for light in registry.lights() {
            for twin in Twin::all(light.declaration.extent) {
                let call = format!("{{ return {}(", twin.of(light));
                let line = composed.text.lines().find(|line| line.contains(&call)).expect("it is dispatched");
                let words = light.words(&Values::default(), Encoding::default()).len();
                for word in 0..=words {
                    let read = line.contains(&format!("(light, {word}u)"));
                    assert_eq!(read, word < words, "{call} word {word} in {line}");
                }
            }
        }
    }

    #[test]
    fn problems_name_the_authors_file_and_line() {
        let registry = Registry::builtin();
        let mut sources = Sources::default();
        sources
            .edit("reflection/lambert.wgsl", "// mine\nfn response(l: vec3<f32>) -> Terms { return 1.0; }\n");
        let problem = validate(&compose_evaluation(&sources, &registry.models()[0])).expect_err("broken");
        assert_eq!((problem.file.as_str(), problem.line), ("reflection/lambert.wgsl", 2), "{problem}");
        sources.edit("reflection/lambert.wgsl", "fn f( {");
        let problem = validate(&compose_evaluation(&sources, &registry.models()[0])).expect_err("broken");
        assert_eq!((problem.file.as_str(), problem.line), ("reflection/lambert.wgsl", 1), "{problem}");
    }
}
