//! Exceptions, which the module `errors` in Python declares.

use lights_camera_models::{
    reflection::ModelEntry,
    scene::error::{LoadError, Problem},
};
use pyo3::{prelude::*, types::PyDict};
use serde_json::{Value, json};

/// An exception of the package, with its problems.
fn raise(name: &str, text: &str, problems: &Value) -> PyErr {
    Python::attach(|py| {
        let exception = || -> PyResult<PyErr> {
            let module = py.import("lights_camera_models.errors")?;
            let named = PyDict::new(py);
            named.set_item("problems", py.import("json")?.call_method1("loads", (problems.to_string(),))?)?;
            Ok(PyErr::from_value(module.getattr(name)?.call((text,), Some(&named))?))
        };
        exception().unwrap_or_else(|error| error)
    })
}

/// A parameter or a model that is refused, with its problems if they are known.
pub fn model(text: &str, problems: Option<Value>) -> PyErr {
    let one = || json!([{ "path": null, "line": null, "column": null, "value": null, "message": text }]);
    raise("ModelError", text, &problems.unwrap_or_else(one))
}

/// A model that the CPU cannot run.
pub fn cannot_run(model: &ModelEntry, why: &str) -> PyErr {
    self::model(&format!("{} cannot be run: {why}", model.declaration.id), None)
}

/// A scene that cannot be read; with the places of problems if it is a file.
pub fn scene(error: &LoadError, is_file: bool) -> PyErr {
    if is_file {
        return raise("SceneError", &here(&error.to_string()), &json!(error.problems()));
    }
    // Positions would refer to a text that nobody wrote.
    values(error.problems().into_iter().map(|problem| Problem { place: None, ..problem }).collect())
}

/// Values of a scene that are refused.
pub fn values(problems: Vec<Problem>) -> PyErr {
    let each: Vec<_> = problems.iter().map(|problem| here(&problem.to_string())).collect();
    raise("SceneError", &each.join("\n"), &json!(problems))
}

/// A path or a text that is refused.
pub fn value(path: &str, message: &str) -> PyErr {
    each(&[(path, message.to_owned())])
}

/// Paths or texts that are refused, each with its message.
pub fn each(refused: &[(&str, String)]) -> PyErr {
    let problem = |(path, message): &(&str, String)| json!({ "path": path, "line": null, "column": null, "value": null, "message": message });
    let messages: Vec<_> = refused.iter().map(|(_, message)| message.as_str()).collect();
    raise("SceneError", &messages.join("\n"), &refused.iter().map(problem).collect())
}

/// A message of the program in words of this package.
fn here(text: &str) -> String {
    text.replace("--use-defaults accepts", "use_defaults=True accepts")
        .replace("--use-defaults loads", "use_defaults=True loads")
}
