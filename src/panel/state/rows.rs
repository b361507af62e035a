//! Rows and grids of objects.

use glam::Vec3;

use super::{Session, Severity};
use crate::{
    document::{Edit, PartId, Selection},
    parameter::{ALPHA, Parameter, ROUGHNESS, SIGMA},
    reflection::usage,
    registry::Registry,
    scene::{Object, Repeat, Repetition, Varied, limits::significant, observer::WIDE, rows::Variable},
};

/// The distance of the objects of a new row, in sizes of an object.
const APART: f32 = 1.15;

impl Session {
    /// Makes a row of an object, with the value that says most about its model.
    pub(super) fn make_row(&mut self, part: Selection, registry: &Registry) {
        let Selection::Object(i) = part else {
            return self.say(Severity::Info, "Select an object to make a row of it.");
        };
        if self.document.row(i).is_some() {
            let text = "The object is in a row already: change it under “Row” in its properties.";
            return self.say(Severity::Info, text);
        }
        let Some(object) = self.document.objects.get(i) else { return };
        let vary = self.telling(object, registry).into_iter().collect();
        let entry = self.row_across(object, Repeat { vary, labels: true, ..Repeat::default() });
        let smaller = entry.size < object.size;
        let revision = self.document.revision();
        self.edit(Edit::Row { object: i, entry: Some(Box::new(entry)), what: "Row" }, registry);
        if smaller && self.document.revision() != revision {
            self.say(Severity::Info, "The objects became smaller, so that the row fits into the picture.");
        }
    }

    /// The value of an object's model that differs along a new row.
    fn telling(&self, object: &Object, registry: &Registry) -> Option<Varied> {
        let model = registry.model(self.document.model_of(object))?;
        let used = |p: &&Parameter| usage::unused(model.parameters, p, &object.material).is_none();
        let numbers = model.parameters.iter().filter(used).map(Variable::of_material);
        let ranges: Vec<_> = numbers.filter_map(Variable::over_its_range).collect();
        let telling = [ROUGHNESS, ALPHA, SIGMA].map(|p| format!("{}.{}", Object::material.key, p.name));
        let known = |path: &String| ranges.iter().find(|varied| varied.parameter == *path);
        telling.iter().find_map(known).or(ranges.last()).cloned()
    }

    /// An object as the entry of a row around its place, from the left of the picture to the right, within room and
    /// picture.
    fn row_across(&self, object: &Object, repeat: Repeat) -> Object {
        let (eye, camera) = (self.facts.eye, self.facts.camera);
        let right = camera * Vec3::X;
        let axis = if right.z.abs() > right.x.abs() {
            Vec3::Z * right.z.signum()
        } else {
            Vec3::X * right.x.signum()
        };
        let along = |v: Vec3| axis.abs().dot(v);
        let room = along(self.document.scene_size.corner());
        let inside = along(object.position).min(room - along(object.position));
        let seen = camera.inverse() * (object.position - eye);
        let wide = (0.5 * self.document.observer.field_of_view.to_radians()).tan() * WIDE;
        // What the camera does not see has the room alone.
        let in_view = if seen.z < 0.0 { -seen.z * wide - seen.x.abs() } else { inside };
        let reach = if in_view > 0.0 { in_view.min(inside) } else { inside };
        let widest = significant(f64::from(1.96 * reach / repeat.columns as f32), 2) as f32;
        let apart = widest.min(APART * object.size);
        let size = if apart < APART * object.size {
            significant(f64::from(apart / APART), 2) as f32
        } else {
            object.size
        };
        let first = object.position - axis * (0.5 * apart * (repeat.columns - 1) as f32);
        // Without the noise of differences.
        let position = (first * 1e4).round() / 1e4;
        let repeat = Repetition::Entry(Box::new(Repeat { spacing: axis * apart, ..repeat }));
        Object { position, size, repeat, ..object.clone() }
    }

    /// After a change of a row, selects the copy that was selected, or else the first.
    pub(super) fn stay_in_row(&mut self, selected: Option<PartId>, first: usize) {
        if !matches!(self.selection, Selection::Object(_)) {
            return;
        }
        let same = selected.and_then(|id| self.document.object(id));
        self.select_new(Selection::Object(same.unwrap_or(first)));
    }
}
