//! The declaration of rows and grids: what an object of a scene file says about its copies.

use std::collections::BTreeMap;

use glam::Vec3;

use super::{
    Field,
    field::Kind,
    held::{Word, word},
    part::part,
};
use crate::{declared::choice, parameter::Value};

/// Maximum number of values that vary in one row.
pub const MAX_VARIED: usize = 4;

choice! {
    /// The way from the first value to the last.
    Scale {
        #[default]
        Linear "linear" "linear" "Equal steps.",
        Logarithmic "logarithmic" "logarithmic" "Equal factors.",
    }
}

choice! {
    /// The copies from one of which to the next a value varies.
    Along {
        #[default]
        Columns "columns" "columns" "From column to column.",
        Rows "rows" "rows" "From row to row.",
        All "all" "all copies" "From copy to copy, one row after the other.",
    }
}

impl Scale {
    /// Numbers from one to another, evenly spaced on this scale; both ends are exact.
    pub fn between(self, [from, to]: [f64; 2], count: usize) -> impl Iterator<Item = f64> {
        (0..count).map(move |i| match i {
            0 => from,
            i if i + 1 == count => to,
            i => {
                let t = i as f64 / (count - 1) as f64;
                match self {
                    Self::Linear => from + (to - from) * t,
                    Self::Logarithmic => from * (to / from).powf(t),
                }
            }
        })
    }
}

word! {
    Scale: |scale| scale.name(), scale.summary();
    Along: |along| along.name(), along.summary();
}

/// The largest end of a range, so that steps between two ends stay finite.
const FAR: f32 = 1e9;

part! {
    /// A value that differs from copy to copy: from one number to another, or as listed.
    pub struct Varied("a varied value") {
        /// Path of the value within the object: `material.roughness`, `size`, `tube_radius`, `reflection_model`.
        parameter: String = Field::of("the parameter", Kind::Text(None))
            .required("a varied value needs the path of a parameter, such as \"material.roughness\""), String::new();
        /// Number of the first copy.
        from: Option<f32> = Field::number("the first value", -FAR..=FAR).called("from"), None;
        /// Number of the last copy.
        to: Option<f32> = Field::number("the last value", -FAR..=FAR).called("to"), None;
        /// `linear`: equal steps from copy to copy. `logarithmic`: equal factors.
        scale: Scale = Field::of("the scale", Kind::Choice(Scale::words)), Scale::Linear;
        /// Values of the copies one by one, instead of `from` and `to`.
        values: Vec<Value> = Field::of("the values", Kind::List), Vec::new();
        /// Copies of a grid from one of which to the next it varies.
        along: Along = Field::of("the direction", Kind::Choice(Along::words)), Along::Columns;
    }
}

part! {
    /// Copies of an object in a row or a grid. The position of the object is that of the first copy.
    pub struct Repeat("a row") {
        /// Copies from column to column; in a row, all.
        columns: u32 = Field::of("the number of columns", Kind::Count(1)).called("columns")
            .required("a row needs the number of its copies"), 5;
        /// Step from one column to the next.
        spacing: Vec3 = Field::of("the spacing", Kind::Step).unit("m").always(), Vec3::X;
        /// Copies from row to row: more than one make a grid.
        rows: u32 = Field::of("the number of rows", Kind::Count(1)).called("rows"), 1;
        /// Step from one row to the next.
        row_spacing: Vec3 = Field::of("the spacing of rows", Kind::Step).unit("m"), Vec3::NEG_Y;
        /// Labels below the copies with the values that vary.
        labels: bool = Field::of("labels", Kind::Flag(["Hide the labels of", "Label"])), false;
        /// Values that differ from copy to copy.
        vary: Vec<Varied> = Field::of("", Kind::Parts), Vec::new();
    }
}

impl Repeat {
    /// The number of copies.
    #[must_use]
    pub fn total(&self) -> u64 {
        u64::from(self.columns) * u64::from(self.rows)
    }

    /// The number of values from the first to the last in a direction.
    #[must_use]
    pub fn steps(&self, along: Along) -> u64 {
        match along {
            Along::Columns => self.columns.into(),
            Along::Rows => self.rows.into(),
            Along::All => self.total(),
        }
    }

    /// The place of a copy in a direction, from 0.
    #[must_use]
    pub fn place(&self, copy: u32, along: Along) -> usize {
        let columns = self.columns.max(1);
        let place = match along {
            Along::Columns => copy % columns,
            Along::Rows => copy / columns,
            Along::All => copy,
        };
        place as usize
    }

    /// Gives lists of values as many as there are steps. Values that are cut off stay in `known`, from where they come
    /// back; values that no list had follow from `next`, and otherwise the last value is repeated.
    pub fn fit_lists(&mut self, known: &mut Lists, next: impl Fn(&Varied) -> Option<Value>) {
        let steps = [Along::Columns, Along::Rows, Along::All].map(|along| (along, self.steps(along)));
        for varied in self.vary.iter_mut().filter(|varied| !varied.values.is_empty()) {
            let count = steps.iter().find(|(along, _)| *along == varied.along).map_or(0, |(_, count)| *count);
            // More than a scene can hold is refused anyway.
            let count = usize::try_from(count).unwrap_or(usize::MAX).clamp(1, super::MAX_OBJECTS);
            varied.values = known.longest(varied);
            while varied.values.len() < count {
                let Some(value) = next(varied).or_else(|| varied.values.last().cloned()) else { break };
                varied.values.push(value);
            }
            known.0.insert(varied.parameter.clone(), varied.values.clone());
            varied.values.truncate(count);
        }
    }
}

/// The lists of a row's values as long as they ever were, by their parameters: copies that come back have the values that
/// they had.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Lists(BTreeMap<String, Vec<Value>>);

impl Lists {
    /// The known list that goes on where that of a varied value ends, or else the latter.
    fn longest(&self, varied: &Varied) -> Vec<Value> {
        let known = self.0.get(&varied.parameter).filter(|known| known.starts_with(&varied.values));
        known.unwrap_or(&varied.values).clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_equal_or_have_equal_factors_between_exact_ends() {
        let of = |scale: Scale, ends, count| scale.between(ends, count).collect::<Vec<_>>();
        assert_eq!(of(Scale::Linear, [1.0, 0.0], 3), [1.0, 0.5, 0.0]);
        assert_eq!(of(Scale::Linear, [0.1, 0.7], 2), [0.1, 0.7]);
        assert_eq!(of(Scale::Linear, [2.0, 3.0], 1), [2.0]);
        let factors = of(Scale::Logarithmic, [1.0, 100.0], 3);
        assert!((factors[1] - 10.0).abs() < 1e-12, "{factors:?}");
        assert_eq!((factors[0], factors[2]), (1.0, 100.0));
    }
}
