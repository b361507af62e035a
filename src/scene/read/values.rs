//! The values of a scene, by type.

use glam::Vec3;

use super::Reader;
use crate::{
    parameter::{Parameter, Value},
    scene::check,
    text::json::{Cursor, Fields, Reader as _},
};

impl Reader<'_> {
    /// A declared parameter, if the value has its type. The range is checked later.
    pub(super) fn parameter(&mut self, value: Cursor, parameter: &'static Parameter) -> Option<Value> {
        let files = (self.folder, self.outside);
        parameter.kind.read(self, value, &parameter.clause(), files)
    }

    /// The entries of a list of lights or objects. If the list is too long, only its length is reported,
    /// because it may be very long.
    pub(super) fn list<T>(
        &mut self,
        scene: &Fields,
        key: &'static str,
        count: fn(usize) -> check::Rule,
        mut read: impl FnMut(&mut Self, Cursor) -> T,
    ) -> Vec<T> {
        let why = format!("a scene must have a list of {key}");
        let Some(value) = scene.get(key) else {
            self.lacking(scene, key, &why);
            return Vec::new();
        };
        let rule = match value.list() {
            Some(list) => match count(list.len()) {
                Ok(()) => return list.map(|entry| read(self, entry)).collect(),
                Err(rule) => rule,
            },
            None => why,
        };
        self.wrong(value, &rule);
        Vec::new()
    }

    /// Three numbers; NaN if they could not be read. Numbers that are too large for 32 bits are left to the check of the
    /// range, if there is one.
    pub(super) fn vector(&mut self, value: Cursor, has_range: bool, rule: impl Fn() -> String) -> Vec3 {
        let Some(list) = value.list().filter(|list| list.len() == 3) else {
            self.wrong(value, &rule());
            return Vec3::NAN;
        };
        let mut vector = Vec3::NAN;
        let mut good = true;
        for (i, element) in list.enumerate() {
            let excess = element.too_large().filter(|_| !has_range);
            match element.number().filter(|_| excess.is_none()) {
                Some(number) => vector[i] = number,
                None => {
                    good = false;
                    self.wrong(element, &excess.map_or_else(&rule, str::to_owned));
                }
            }
        }
        if !good {
            self.reported.insert(value.path());
            return Vec3::NAN;
        }
        vector
    }
}
