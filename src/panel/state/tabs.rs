//! The panels at the lower edge that the state itself opens.

/// Id of the panel that shows the messages.
pub const MESSAGES_TAB: &str = "messages";
/// Id of the panel that shows the plots.
pub const PLOTS_TAB: &str = "plots";
/// Id of the panel that shows the shaders.
pub const SHADER_TAB: &str = "shader";
