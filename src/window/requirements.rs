//! The display and the driver that a window needs.

use std::process;

use bevy::app::{App, Plugin};

use super::watching::complain;
use crate::{failure::Failure, platform, render::capture::gpu::find_adapter};

/// Reports a missing display or driver, and ends the process with the appropriate exit status before other plugins
/// panic.
#[derive(Clone, Copy, Debug)]
pub struct RequirementsPlugin {
    /// True if a display is needed.
    pub display: bool,
}

impl Plugin for RequirementsPlugin {
    fn build(&self, _app: &mut App) {
        let needs = || -> Result<(), Failure> {
            if self.display {
                need_display()?;
            }
            need_driver()
        };
        if let Err(failure) = needs() {
            complain(&failure.to_string());
            process::exit(failure.status().into());
        }
    }
}

/// Returns an error without a driver, for which Bevy would panic.
pub(super) fn need_driver() -> Result<(), Failure> {
    if !platform::WAITS_FOR_GPU {
        // The page has looked for one.
        return Ok(());
    }
    find_adapter().map(drop).map_err(|e| Failure::NoRenderer(e.to_string()))
}

/// Returns an error without a display, for which the windowing library would panic.
pub(super) fn need_display() -> Result<(), Failure> {
    let set = |name: &str| std::env::var_os(name).is_some_and(|v| !v.is_empty());
    if cfg!(target_os = "linux") && !set("DISPLAY") && !set("WAYLAND_DISPLAY") && !set("WAYLAND_SOCKET") {
        return Err(Failure::NoRenderer(
            "there is no display to open a window on (neither DISPLAY nor WAYLAND_DISPLAY is set); \
             `lcm render` makes pictures without one, and `xvfb-run lcm view` gives the window an invisible display \
             (Debian and Ubuntu: apt-get install xvfb)"
                .to_owned(),
        ));
    }
    Ok(())
}
