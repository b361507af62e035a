//! The models that this process knows: those built in, and those from WGSL texts.

use std::{
    path::Path,
    sync::{Arc, RwLock},
};

use lights_camera_models::{
    caught::unpoisoned,
    custom,
    parameter::json,
    reflection::ModelEntry,
    registry::{CustomModel, Registry},
    scene::field::Ids,
    shader::{check::ShaderProblem, report::annotated},
    text::{did_you_mean, quoted, shortened},
};
use pyo3::prelude::*;

use crate::{errors, work};

/// Words for models that are choices of another one's parameters.
const OTHER_WORDS: [(&str, &str); 8] = [
    ("ggx", "microfacet"),
    ("beckmann", "microfacet"),
    ("gtr", "microfacet"),
    ("trowbridge_reitz", "microfacet"),
    ("principled", "disney"),
    ("blinn", "blinn_phong"),
    ("dielectric", "glass"),
    ("pbr", "metallic_roughness"),
];

static KNOWN: RwLock<Option<Arc<Registry>>> = RwLock::new(None);

/// The registry as it is now.
pub fn registry() -> Arc<Registry> {
    let known = unpoisoned(KNOWN.read()).clone();
    known.unwrap_or_else(|| {
        let mut place = unpoisoned(KNOWN.write());
        place.get_or_insert_with(|| Arc::new(Registry::builtin())).clone()
    })
}

/// The registry with other versions of models, which nobody else sees.
pub fn with(py: Python<'_>, custom: &[(String, String)]) -> PyResult<Arc<Registry>> {
    let mut all = registry();
    for (id, text) in custom {
        if text_of(&all, id).as_deref() != Some(text) {
            let model = read(py, id, text, &all)?;
            Arc::make_mut(&mut all).put_custom_model(model);
        }
    }
    Ok(all)
}

/// The text of a custom model.
pub fn text_of(registry: &Registry, id: &str) -> Option<String> {
    registry.custom_file(id)?;
    Some(registry.sources().get(registry.model(id)?.declaration.wgsl.path)?.to_string())
}

/// The model with an id.
pub fn find(registry: &Registry, id: &str) -> PyResult<ModelEntry> {
    Ids::ReflectionModel.check(registry, id).map_err(|rule| {
        let lower = id.to_lowercase();
        let other = OTHER_WORDS
            .iter()
            .filter(|(word, _)| lower.contains(word))
            .map(|(_, model)| (lower.as_str(), *model));
        let near = if rule.contains("did you mean") { String::new() } else { did_you_mean(&lower, other) };
        errors::model(&format!("the model is {}, but {rule}{near}", quoted(&shortened(id))), None)
    })?;
    registry
        .model(id)
        .cloned()
        .ok_or_else(|| errors::model(&format!("there is no model {}", quoted(id)), None))
}

/// The ids of all models.
#[pyfunction]
pub fn models() -> Vec<&'static str> {
    registry().models().iter().map(|model| model.declaration.id).collect()
}

/// The declaration of a model, as JSON.
#[pyfunction]
pub fn describe(id: &str) -> PyResult<String> {
    Ok(described(&find(&registry(), id)?))
}

/// The declaration of a model, as JSON.
pub fn described(model: &ModelEntry) -> String {
    let declaration = model.declaration;
    let parameters: Vec<_> = model
        .parameters
        .iter()
        .map(|p| {
            serde_json::json!({
                "name": p.name, "label": p.label, "symbol": p.symbol, "unit": p.unit, "help": p.help,
                "rule": p.rule(), "default": json(&p.default_value()),
            })
        })
        .collect();
    let described = serde_json::json!({
        "id": declaration.id, "name": declaration.name, "author": declaration.author, "source": declaration.source,
        "summary": declaration.summary, "transmits": declaration.transmits, "anisotropic": declaration.anisotropic,
        "parameters": parameters,
    });
    described.to_string()
}

/// Reads a model from a WGSL text, in place of one of the same name that was read before.
#[pyfunction]
pub fn add_model(py: Python<'_>, id: &str, text: &str) -> PyResult<()> {
    let before = registry();
    let model = read(py, id, text, &before)?;
    let mut place = unpoisoned(KNOWN.write());
    Arc::make_mut(place.get_or_insert(before)).put_custom_model(model);
    Ok(())
}

fn read(py: Python<'_>, id: &str, text: &str, registry: &Registry) -> PyResult<CustomModel> {
    let name = format!("{}.{}", shortened(id), custom::EXTENSION);
    let read = work::long(py, |_| custom::read(Path::new(&name), text, registry))?;
    read.map_err(|problems: Vec<ShaderProblem>| {
        let all: Vec<_> = problems.iter().map(|problem| annotated(problem, &name)).collect();
        let each: Vec<_> = problems
            .iter()
            .map(|p| serde_json::json!({ "path": null, "line": p.line, "column": p.column, "value": null, "message": p.message }))
            .collect();
        errors::model(&all.join("\n"), Some(each.into()))
    })
}
