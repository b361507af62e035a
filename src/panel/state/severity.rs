//! Severities.

use crate::declared::in_words;

in_words! {
    /// Severity of a message.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
    pub enum Severity {
        /// Information.
        Info = "note",
        /// Something is not as requested, but the picture is correct.
        Warning = "warning",
        /// Something failed.
        Error = "error",
    }
    /// Name of the severity.
    name
}
