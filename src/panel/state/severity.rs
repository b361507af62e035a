//! Severities.

/// Severity of a message.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Severity {
    /// Information.
    Info,
    /// Something is not as requested, but the picture is correct.
    Warning,
    /// Something failed.
    Error,
}

impl Severity {
    /// Name of the severity.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Info => "note",
            Self::Warning => "warning",
            Self::Error => "error",
        }
    }
}
