//! Rows and grids of objects.

use glam::Vec3;

use super::{Session, Severity};
use crate::{
    document::{Edit, PartId, Selection},
    parameter::{ALPHA, ALPHA_X, ALPHA_Y, Parameter, ROUGHNESS, SIGMA},
    reflection::usage,
    registry::Registry,
    scene::{
        Object, Repeat, Repetition, Varied,
        limits::significant,
        observer::WIDE,
        rows::{Row, Variable},
    },
};

/// The distance of the objects of a new row, in sizes of an object.
const APART: f32 = 1.15;
/// The part of the picture's width and height that a new row takes at most; the rest is a margin.
const TAKES: f32 = 0.86;
/// The parts of the picture's height that a line of a label takes, and the space around it.
const LINE: f32 = 0.04;
const AROUND: f32 = 0.03;
/// The factor between spacings that are tried, and how often it is applied: as long as copies are easily seen, to a tenth;
/// and at all, to a thousandth.
const NARROWER: f32 = 0.97;
const VISIBLE: i32 = 75;
const NARROWEST: i32 = 227;

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
        let vary = self.telling(object, registry);
        let entry = self.row_across(object, Repeat { vary, labels: true, ..Repeat::default() });
        let smaller = entry.size < object.size;
        let revision = self.document.revision();
        self.select(part);
        self.edit(Edit::Row { object: i, entry: Some(Box::new(entry)), what: "Row" }, registry);
        if smaller && self.document.revision() != revision {
            self.say(Severity::Info, "The objects became smaller, so that the row fits into the picture.");
        }
    }

    /// The values of an object's model that differ along a new row: one, or the two of a highlight that stays round.
    fn telling(&self, object: &Object, registry: &Registry) -> Vec<Varied> {
        let Some(model) = registry.model(self.document.model_of(object)) else { return Vec::new() };
        let used = |p: &&Parameter| usage::unused(model.parameters, p, &object.material).is_none();
        let numbers = model.parameters.iter().filter(used).map(Variable::of_material);
        let ranges: Vec<_> = numbers.filter_map(Variable::over_its_range).collect();
        let telling: [&[Parameter]; 4] = [&[ROUGHNESS], &[ALPHA], &[ALPHA_X, ALPHA_Y], &[SIGMA]];
        let known = |all: &[Parameter]| -> Option<Vec<Varied>> {
            let path = |p: &Parameter| format!("{}.{}", Object::material.key, p.name);
            let of = |p: &Parameter| ranges.iter().find(|varied| varied.parameter == path(p)).cloned();
            all.iter().map(of).collect()
        };
        telling.into_iter().find_map(known).unwrap_or_else(|| ranges.last().cloned().into_iter().collect())
    }

    /// An object as the entry of a row around its place, from the left of the picture to the right: as large as it is, or as
    /// the room and a picture with a margin have place for all copies.
    fn row_across(&self, object: &Object, repeat: Repeat) -> Object {
        let right = self.facts.camera * Vec3::X;
        let axis = if right.z.abs() > right.x.abs() {
            Vec3::Z * right.z.signum()
        } else {
            Vec3::X * right.x.signum()
        };
        let whole = APART * object.size;
        let rounded = |v: f32| significant(f64::from(v), 2) as f32;
        let sized = |apart: f32| if apart < whole { rounded(apart / APART) } else { object.size };
        let half = 0.5 * (repeat.columns - 1) as f32;
        // What lies between the ends fits if these do.
        let ends = |apart: f32| [-half, half].map(|steps| object.position + steps * apart * axis);
        let has_room = |apart: &f32| {
            let (reach, room) = (0.5 * sized(*apart) * axis, self.document.scene_size);
            ends(*apart).into_iter().all(|p| room.contains(p - reach) && room.contains(p + reach))
        };
        let in_view = |apart: &f32| ends(*apart).into_iter().all(|p| self.shows_well(p, 0.5 * sized(*apart)));
        let narrower = |k: i32| if k == 0 { whole } else { rounded(whole * NARROWER.powi(k)) };
        let all = |most: i32| (0..=most).map(narrower);
        // Beyond sight the room alone counts.
        let apart = all(VISIBLE).find(|apart| has_room(apart) && in_view(apart));
        let apart = apart.or_else(|| all(NARROWEST).find(has_room)).unwrap_or(whole);
        let first = object.position - half * apart * axis;
        // Without the noise of differences.
        let position = (first * 1e4).round() / 1e4;
        let size = sized(apart);
        let repeat = Repetition::Entry(Box::new(Repeat { spacing: axis * apart, ..repeat }));
        Object { position, size, repeat, ..object.clone() }
    }

    /// The step from row to row of a grid that leaves room for labels, or as much of it as so many rows have in the room.
    /// `None` for a row without labels, and for one whose step was chosen otherwise.
    #[must_use]
    pub(in crate::panel) fn step_for_labels(&self, row: &Row, rows: u32) -> Option<Vec3> {
        let usual = Repeat::default().row_spacing;
        let now = row.repeat.row_spacing;
        let is_own = now != usual && now != self.step_below(row, row.repeat.rows);
        (row.repeat.labels && !is_own).then(|| self.step_below(row, rows))
    }

    /// The step downwards past the largest copy and its label.
    fn step_below(&self, row: &Row, rows: u32) -> Vec3 {
        let copies = self.document.objects.get(row.range()).unwrap_or_default();
        let largest = copies.iter().map(|copy| copy.size).fold(0.0, f32::max);
        // At the height of the eye, so that rows above and below make no difference.
        let seen = self.facts.camera.inverse() * (row.middle() - self.facts.eye).with_y(0.0);
        let height = 2.0 * seen.z.abs() * (0.5 * self.document.observer.field_of_view.to_radians()).tan();
        let label = AROUND + LINE * row.repeat.vary.len() as f32;
        let wanted = significant(f64::from(APART * largest + label * height), 2);
        let Some(steps) = rows.checked_sub(1).filter(|steps| *steps > 0) else {
            return Vec3::NEG_Y * wanted as f32;
        };
        let taken = row.repeat.columns.saturating_sub(1) as f32 * row.repeat.spacing.y.abs();
        let left = f64::from((self.document.scene_size.height - taken).max(0.0));
        // To four decimals, with a margin, since coordinates are greater than 0.
        let room = ((left * 1e4 - 2.0) / f64::from(steps)).floor().max(0.0) / 1e4;
        Vec3::NEG_Y * wanted.min(room) as f32
    }

    /// True if the camera sees a sphere, with a margin around the picture.
    fn shows_well(&self, p: Vec3, radius: f32) -> bool {
        let seen = self.facts.camera.inverse() * (p - self.facts.eye);
        let up = TAKES * (0.5 * self.document.observer.field_of_view.to_radians()).tan();
        let within = |side: f32, opening: f32| {
            opening * -seen.z - side.abs() >= radius * (1.0 + opening * opening).sqrt()
        };
        -seen.z > radius && within(seen.x, WIDE * up) && within(seen.y, up)
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
