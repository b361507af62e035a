//! The labels of rows: the values in which each copy differs from the others.

use super::{Part, line, words::said};
use crate::{
    parameter::Value,
    registry::Registry,
    scene::{
        Scene,
        rows::{Row, Variable},
    },
};

/// The labels of the objects in rows that have labels, by their indices.
#[must_use]
pub fn row_labels(scene: &Scene, registry: &Registry) -> Vec<(usize, Vec<Part>)> {
    let labelled = scene.rows().filter(|row| row.repeat.labels);
    let mut labels: Vec<_> =
        labelled.flat_map(|row| row.range().zip(of_row(scene, &row, registry))).collect();
    labels.retain(|(_, parts)| !parts.is_empty());
    labels
}

/// The label of an object in a row that has labels; `None` for any other object.
#[must_use]
pub fn label_of(scene: &Scene, i: usize, registry: &Registry) -> Option<String> {
    let row = scene.row(i).filter(|row| row.repeat.labels)?;
    let variables: Vec<_> = row.variables(registry).collect();
    Some(line(&of_copy(scene, i, &variables, registry))).filter(|label| !label.is_empty())
}

/// The values in which each copy of a row differs from the others, whether the row has labels or not.
#[must_use]
pub fn of_row(scene: &Scene, row: &Row, registry: &Registry) -> Vec<Vec<Part>> {
    let variables: Vec<_> = row.variables(registry).collect();
    row.range().map(|i| of_copy(scene, i, &variables, registry)).collect()
}

/// The values of a copy that vary in its row, without those of which its model makes no use.
#[must_use]
pub fn of_copy(scene: &Scene, i: usize, variables: &[Variable], registry: &Registry) -> Vec<Part> {
    let Some(object) = scene.objects.get(i) else { return Vec::new() };
    let said = |variable: &Variable| {
        let Variable { key, declared } = variable;
        let held = declared.held(object, *key).filter(|held| !matches!(held, Value::File(_)))?;
        let counts = variable.idle(scene, i, registry).is_none();
        counts.then(|| said(declared.label(), declared.symbol(), declared.shown(&held, registry)))
    };
    variables.iter().filter_map(said).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Object;

    #[test]
    fn values_are_named_as_people_call_them_not_by_their_paths() {
        let registry = Registry::builtin();
        let torus = Object { object_type: "torus".to_owned(), ..Object::default() };
        let mut scene = Scene { objects: vec![torus], ..Scene::default() };
        let label = |scene: &Scene, path: &str| {
            let variable = Variable::with_path(path, "torus", &registry).expect(path);
            line(&of_copy(scene, 0, &[variable], &registry))
        };
        assert_eq!(label(&scene, "material.roughness"), "", "Lambert does not use it");
        scene.reflection_model = "eon".to_owned();
        let roughness = label(&scene, "material.roughness");
        assert!(roughness.starts_with("r 0."), "{roughness}");
        scene.reflection_model = "disney".to_owned();
        let label = |path: &str| label(&scene, path);
        assert_eq!((label("size"), label("visible")), ("size 2 m".to_owned(), "visible true".to_owned()));
        for path in ["tube_radius", "material.sheen", "rotation"] {
            let said = label(path);
            let declared = Variable::with_path(path, "torus", &registry).expect(path).declared;
            let name = if declared.symbol().is_empty() { declared.label() } else { declared.symbol() };
            assert!(said.starts_with(&format!("{name} ")) && !said.contains("material."), "{path}: {said}");
        }
    }
}
