//! Sets of light types: a shader contains those that its scene uses.

use super::Registry;
use crate::light::LightEntry;

/// Maximum number of light types in a registry.
pub const MAX_LIGHT_TYPES: usize = 64;

/// A set of registered light types.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct LightSet(u64);

impl LightSet {
    /// True if a type is in the set.
    #[must_use]
    pub fn has(self, light: &LightEntry) -> bool {
        self.0 >> light.index & 1 == 1
    }

    /// The set as a unique number.
    #[must_use]
    pub fn bits(self) -> u64 {
        self.0
    }
}

impl<'a> FromIterator<&'a LightEntry> for LightSet {
    fn from_iter<T: IntoIterator<Item = &'a LightEntry>>(lights: T) -> Self {
        Self(lights.into_iter().fold(0, |bits, light| bits | 1 << light.index))
    }
}

impl Registry {
    /// The known light types among these ids.
    #[must_use]
    pub fn light_set<'a>(&self, ids: impl IntoIterator<Item = &'a str>) -> LightSet {
        ids.into_iter().filter_map(|id| self.light(id)).collect()
    }

    /// The light types of a set, in the order of registration.
    #[must_use]
    pub fn lights_in(&self, set: LightSet) -> Vec<LightEntry> {
        self.lights.iter().filter(|light| set.has(light)).copied().collect()
    }

    /// True if any light type in a set has extent.
    #[must_use]
    pub fn has_extent(&self, set: LightSet) -> bool {
        self.lights.iter().any(|light| set.has(light) && light.declaration.extent)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_set_has_the_known_types_that_were_named_in_the_order_of_registration() {
        let registry = Registry::builtin();
        let ids = |set| registry.lights_in(set).iter().map(|l| l.declaration.id).collect::<Vec<_>>();
        let set = registry.light_set(["ambient", "point", "laser", "point"]);
        assert_eq!(ids(set), ["point", "ambient"]);
        assert_eq!(ids(LightSet::default()), [""; 0]);
        assert_eq!(ids(registry.lights().iter().collect()).len(), registry.lights().len());
        assert_ne!(set, registry.light_set(["point"]));
    }
}
