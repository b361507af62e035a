//! The labels of rows: the values in which each copy differs from the others.

use super::{Part, words::value};
use crate::{
    parameter::Value,
    registry::Registry,
    scene::{Scene, field::Kind, rows::Variable},
};

/// The labels of the objects in rows that have labels, by their indices.
#[must_use]
pub fn row_labels(scene: &Scene, registry: &Registry) -> Vec<(usize, Vec<Part>)> {
    let (mut labels, mut i) = (Vec::new(), 0);
    while i < scene.objects.len() {
        let Some(row) = scene.row(i) else {
            i += 1;
            continue;
        };
        if row.repeat.labels {
            let variables: Vec<_> = row.variables(registry).collect();
            labels.extend(row.range().map(|copy| {
                let object = &scene.objects[copy];
                let said = |v: &Variable| said(*v, &v.of_object(object)?, registry);
                (copy, variables.iter().filter_map(said).collect::<Vec<_>>())
            }));
        }
        i += row.count;
    }
    labels.retain(|(_, parts)| !parts.is_empty());
    labels
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
