//! Parameters that vary where models and types do not have them: in all pictures, which is refused, or in some, which are
//! marked.

use super::Sweep;
use crate::{scene::at::Idle, text::listed};

/// Maximum number of models that a message lists.
const NAMED: usize = 12;

/// For each picture, and each axis of a sweep, the reason why the axis has no effect there.
pub(super) struct Unused(pub(super) Vec<Vec<Option<Idle>>>);

impl Unused {
    fn in_picture(&self, picture: usize, axis: usize) -> Option<&Idle> {
        self.0.get(picture)?.get(axis)?.as_ref()
    }

    /// The pictures in which an axis has no effect, with the reasons.
    fn of(&self, axis: usize) -> impl Iterator<Item = (usize, &Idle)> {
        (0..self.0.len()).filter_map(move |i| Some((i, self.in_picture(i, axis)?)))
    }

    /// A sentence for each axis that has no effect in some pictures.
    ///
    /// # Errors
    /// Returns an error about an axis that has an effect in none.
    pub(super) fn remarks(&self, sweep: &Sweep) -> Result<Vec<String>, String> {
        let mut remarks = Vec::new();
        for (a, axis) in sweep.axes.iter().enumerate() {
            let (count, all) = (self.of(a).count(), self.0.len());
            let mut reasons: Vec<&str> = self.of(a).map(|(_, idle)| &*idle.why).collect();
            reasons.sort_unstable();
            reasons.dedup();
            let (Some((place, _)), true) = (axis.sets.first(), count > 0) else { continue };
            let (path, why) = (&place.path, reasons.join("; "));
            if count == all {
                let users = self.of(a).next().map_or(&[][..], |(_, idle)| idle.users.as_slice());
                return Err(format!("{path} has no effect: {why}{}", advice(users)));
            }
            remarks.push(format!("{path} has no effect in {count} of {all} pictures: {why}"));
        }
        Ok(remarks)
    }

    /// The steps of axes with which another axis has no effect: axis, step, and words for its label. Steps are not marked
    /// if it has none with any.
    pub(super) fn marks(&self, sweep: &Sweep) -> Vec<(usize, usize, String)> {
        let mut marks = Vec::new();
        for (a, idle) in sweep.axes.iter().enumerate() {
            let Some((place, _)) = idle.sets.first() else { continue };
            let unused: Vec<bool> = (0..self.0.len()).map(|i| self.in_picture(i, a).is_some()).collect();
            if !unused.contains(&true) {
                continue;
            }
            for (b, axis) in sweep.axes.iter().enumerate().filter(|(b, _)| *b != a) {
                let mut always = vec![true; axis.count()];
                for (i, unused) in unused.iter().enumerate() {
                    always[sweep.steps(i)[b]] &= unused;
                }
                let steps = (0..axis.count()).filter(|step| always[*step] && always.contains(&false));
                marks.extend(steps.map(|step| (b, step, format!("no {}", place.label()))));
            }
        }
        marks
    }
}

/// The models or types that have a parameter.
fn advice(users: &[&str]) -> String {
    let shown = &users[..users.len().min(NAMED)];
    match users.len() - shown.len() {
        _ if users.is_empty() => String::new(),
        0 => format!("; it belongs to {}", listed(shown, "and")),
        more => format!("; it belongs to {} and {more} more", shown.join(", ")),
    }
}
