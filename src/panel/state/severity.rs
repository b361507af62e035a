//! Severities.

use crate::declared::texts;

texts! {
    /// Severity of a message.
    #[derive(PartialOrd, Ord)]
    Severity(
        /// Name of the severity.
        name
    ) {
        /// Information.
        Info = "note",
        /// Something is not as requested, but the picture is correct.
        Warning = "warning",
        /// Something failed.
        Error = "error",
    }
}
