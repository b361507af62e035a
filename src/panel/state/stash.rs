//! Values of the document that no model accepts at present.

use std::{borrow::Cow, collections::BTreeMap};

use crate::{document::PartId, parameter::Value};

/// An object, and the name of a parameter.
pub(in crate::panel) type ParameterPlace = (PartId, Cow<'static, str>);

/// A stashed value.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::panel) struct Kept {
    /// The value set by the user.
    pub(in crate::panel) wanted: Value,
    /// The replacement value in the document, if any.
    pub(in crate::panel) instead: Option<Value>,
}

/// Values of the document that no model accepts; they are restored once a model accepts them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StashedValues(pub(in crate::panel) BTreeMap<ParameterPlace, Kept>);

impl StashedValues {
    /// Number of stashed values.
    #[must_use]
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// True if nothing is stashed.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Clears the stash for another document.
    pub(super) fn clear(&mut self) {
        self.0.clear();
    }

    /// Copies the stashed values of an object to its duplicate.
    pub(super) fn copied(&mut self, from: PartId, to: PartId) {
        let theirs = self.0.iter().filter(|((object, _), _)| *object == from);
        let copies: Vec<_> = theirs.map(|((_, name), kept)| ((to, name.clone()), kept.clone())).collect();
        self.0.extend(copies);
    }
}
