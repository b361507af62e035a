//! The labels of rows: the values in which each copy differs from the others.

use super::{Part, words::value};
use crate::{
    parameter::Value,
    registry::Registry,
    scene::{
        Object, Scene,
        field::Kind,
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

/// The values in which each copy of a row differs from the others, whether the row has labels or not.
#[must_use]
pub fn of_row(scene: &Scene, row: &Row, registry: &Registry) -> Vec<Vec<Part>> {
    let variables: Vec<_> = row.variables(registry).collect();
    scene.objects[row.range()].iter().map(|object| of_copy(object, &variables, registry)).collect()
}

/// The values of a copy that vary in its row.
#[must_use]
pub fn of_copy(object: &Object, variables: &[Variable], registry: &Registry) -> Vec<Part> {
    let said = |v: &Variable| said(*v, &v.of_object(object)?, registry);
    variables.iter().filter_map(said).collect()
}

/// A value with its symbol or name.
fn said(variable: Variable, held: &Value, registry: &Registry) -> Option<Part> {
    match variable {
        Variable::Field(field) => {
            let shown = field.shown(held, registry);
            Some(Part::new(
                0,
                match field.kind {
                    Kind::Id(_) => shown,
                    _ => format!("{} {shown}", field.label()),
                },
            ))
        }
        Variable::Shape(p) | Variable::Material(p) => {
            let (symbol, text) = value(p, held)?;
            Some(Part { symbol, ..Part::new(0, text + &p.suffix()) })
        }
    }
}
