//! Values of the document that no model takes at present.

use std::{borrow::Cow, collections::BTreeMap};

use crate::{document::PartId, parameter::Value};

/// An object, and the name of a parameter.
pub(in crate::panel) type ParameterPlace = (PartId, Cow<'static, str>);

/// A value that was stashed.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::panel) struct Kept {
    /// The value that the user wants.
    pub(in crate::panel) wanted: Value,
    /// The value that the document has in its place, if any.
    pub(in crate::panel) instead: Option<Value>,
}

/// The values of the document that no model takes, and that come back when one does.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StashedValues(pub(in crate::panel) BTreeMap<ParameterPlace, Kept>);

impl StashedValues {
    /// The number of stashed values.
    #[must_use]
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// True if nothing is stashed.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Another document is open.
    pub(super) fn clear(&mut self) {
        self.0.clear();
    }

    /// An object was copied.
    pub(super) fn copied(&mut self, from: PartId, to: PartId) {
        let theirs = self.0.iter().filter(|((object, _), _)| *object == from);
        let copies: Vec<_> = theirs.map(|((_, name), kept)| ((to, name.clone()), kept.clone())).collect();
        self.0.extend(copies);
    }
}
