//! Checks composed sources for drawing, wrapper included, without a renderer: the wrapper's imports from Bevy
//! are replaced by functions with the same signatures.

use super::{
    check::{ShaderProblem, validate},
    compose::Composed,
};
use crate::text::template::chosen;

/// The replacements of the wrapper's imports.
const STAND_INS: &str = include_str!("stand_ins.wgsl");

/// Checks a source for drawing; `faces` as for shading models that calculate per polygon. A source that uses
/// more of Bevy than the shipped wrapper cannot be judged here and passes.
///
/// # Errors
/// Returns the first problem, located in the author's file.
pub fn validate_drawing(composed: &Composed, faces: bool) -> Result<(), Box<ShaderProblem>> {
    judged(composed, faces).unwrap_or(Ok(()))
}

/// Like [`validate_drawing`]; `None` if the source cannot be judged here.
pub fn judged(composed: &Composed, faces: bool) -> Option<Result<(), Box<ShaderProblem>>> {
    if let Some(problem) = &composed.problem {
        return Some(Err(problem.clone()));
    }
    let text = standing_alone(&composed.text, faces)?;
    Some(validate(&Composed { text, ..composed.clone() }).map(drop))
}

/// The text without preprocessor directives; positions stay the same.
pub(super) fn standing_alone(text: &str, faces: bool) -> Option<String> {
    let mut out = String::with_capacity(text.len() + 512);
    let mut stand_ins = String::new();
    // For each open condition, true if its lines count.
    let mut conditions: Vec<bool> = Vec::new();
    for line in text.lines() {
        let directive = line.trim();
        if !directive.starts_with('#') || directive.starts_with("#{") {
            if conditions.iter().all(|c| *c) {
                out.push_str(line);
            }
        } else if let Some(module) = directive.strip_prefix("#import ") {
            let stand_in = chosen(STAND_INS, |name| name == module.trim());
            stand_ins.push_str(Some(&stand_in).filter(|found| !found.is_empty())?);
        } else if let Some(name) = directive.strip_prefix("#ifdef ") {
            conditions.push(faces && name.trim() == "FACES");
        } else if let Some(name) = directive.strip_prefix("#ifndef ") {
            conditions.push(!(faces && name.trim() == "FACES"));
        } else if directive == "#else" {
            let last = conditions.last_mut()?;
            *last = !*last;
        } else if directive == "#endif" {
            conditions.pop()?;
        } else {
            return None;
        }
        out.push('\n');
    }
    let group = "#{MATERIAL_BIND_GROUP}";
    let out = out
        .replace("mesh_functions::", "mesh_functions__")
        .replace(group, &format!("{:<1$}", 2, group.len()));
    Some(out + &stand_ins)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        reflection::Passage,
        registry::{
            Registry,
            compose::{compose, compose_seen},
        },
        shader::compose::Sources,
        shading::Stage,
    };

    fn problem(path: &str, text: &str, shading: &str) -> Option<String> {
        let registry = Registry::builtin();
        let mut sources = Sources::default();
        sources.edit(path, text);
        let shading = registry.shading_model(shading).expect("built in");
        let composed = compose(&sources, (&registry.models()[0], Passage::NONE), shading, registry.lights());
        let faces = shading.declaration.stage == Stage::Polygon;
        validate_drawing(&composed, faces).err().map(|p| p.to_string())
    }

    #[test]
    fn every_model_is_valid_in_every_shading_model() {
        let registry = Registry::builtin();
        for model in registry.models() {
            for (shading, passage) in registry
                .shading_models()
                .iter()
                .flat_map(|shading| model.passages().into_iter().map(move |passage| (shading, passage)))
            {
                let composed = compose(&Sources::default(), (model, passage), shading, registry.lights());
                let faces = shading.declaration.stage == Stage::Polygon;
                let case = (model.declaration.id, passage);
                assert_eq!(validate_drawing(&composed, faces), Ok(()), "{case:?}");
            }
        }
    }

    #[test]
    fn what_draws_lights_is_valid_with_all_light_types_and_with_each() {
        let registry = Registry::builtin();
        let alone = registry.lights().chunks(1);
        for lights in alone.chain([registry.lights(), &[]]) {
            let composed = compose_seen(&Sources::default(), lights);
            // Without light with extent, nothing is drawn.
            if lights.iter().any(|light| light.declaration.extent) {
                assert_eq!(validate_drawing(&composed, false), Ok(()), "{}", lights[0].declaration.id);
            }
        }
    }

    #[test]
    fn mistakes_anywhere_are_found_where_they_are() {
        let wrapper = crate::shader::compose::WRAPPER.text;
        let at = wrapper.lines().position(|l| l.contains("corner.position =")).expect("there") + 1;
        let broken = wrapper.replace("corner.position =", "corner.postion =");
        let said = problem("wrapper.wgsl", &broken, "phong").expect("is broken");
        assert!(said.starts_with(&format!("wrapper.wgsl:{at}:")), "{said}");
        let at = wrapper.lines().position(|l| l.contains("corner.face_centre =")).expect("there") + 1;
        let broken = wrapper.replace("corner.face_centre =", "corner.face_center =");
        let said = problem("wrapper.wgsl", &broken, "flat").expect("is broken");
        assert!(said.starts_with(&format!("wrapper.wgsl:{at}:")), "{said}");
        assert_eq!(problem("wrapper.wgsl", &broken, "phong"), None);
        assert!(
            problem("loop.wgsl", "fn illuminate( {", "phong").expect("is broken").starts_with("loop.wgsl:1:")
        );
        // A source that uses more of Bevy is not judged.
        assert_eq!(problem("wrapper.wgsl", &format!("#import bevy_pbr::shadows\n{broken}"), "flat"), None);
    }
}
