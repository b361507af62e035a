//! Opens the window: the program around the panels and the picture.

use bevy::app::{App, PluginGroup as _, Plugins};

use super::{
    ViewOptions,
    capture::{Countdown, Report},
    document::open_late,
    ending,
    plugins::LabPlugins,
    recovery::Recovery,
    requirements::{RequirementsPlugin, need_display, need_driver},
};
use crate::{
    caught::{catch_silently, lock, message},
    failure::Failure,
    platform,
};

/// Opens the window and returns once it is closed. `extend` adds panels, systems and plugins to the app.
///
/// # Errors
/// Returns [`Failure::NoRenderer`] without a display or a driver, and [`Failure::Write`] if the capture cannot be
/// written.
pub fn view(options: ViewOptions, extend: impl FnOnce(&mut App)) -> Result<(), Failure> {
    need_display()?;
    need_driver()?;
    let mut app = App::new();
    let (late, known) = (options.late.clone(), options.registry.clone().unwrap_or_default());
    add_with_display(&mut app, LabPlugins::new(options).build().disable::<RequirementsPlugin>())?;
    extend(&mut app);
    if let Some((file, defaults)) = late {
        open_late(&mut app, &file, defaults, known).map_err(|error| Failure::Invalid(error.to_string()))?;
    }
    let report = Report::default();
    if let Some(mut countdown) = app.world_mut().get_resource_mut::<Countdown>() {
        countdown.reported = Some(report.clone());
    }
    let farewell = app.world_mut().get_resource_mut::<Recovery>().and_then(|mut r| r.hand_over());
    let ended = ending::run(&mut app, farewell.as_ref().map(|(farewell, _)| &farewell.keeper));
    let failure = lock(&report).take();
    if failure.is_none() {
        ended?;
    }
    if let Some((farewell, guard)) = farewell.filter(|_| platform::OUTLIVES_WINDOW) {
        drop(guard);
        farewell.say();
    }
    failure.map_or(Ok(()), Err)
}

/// Adds the plugins. The windowing library panics if the display named in the environment does not respond, and offers
/// no way to check first.
fn add_with_display<M>(app: &mut App, plugins: impl Plugins<M>) -> Result<(), Failure> {
    if !platform::OUTLIVES_WINDOW {
        app.add_plugins(plugins);
        // Bevy tells the console alone.
        platform::report_panics();
        return Ok(());
    }
    let added = catch_silently(|| _ = app.add_plugins(plugins));
    added.map_err(|payload| {
        let first = message(&*payload).lines().next();
        // The windowing library reports its own source files, not the cause.
        let why = first.filter(|text| !text.contains("event loop")).unwrap_or("it does not answer");
        let named = ["DISPLAY", "WAYLAND_DISPLAY"]
            .into_iter()
            .filter_map(|name| {
                Some(format!("{name}={}", std::env::var(name).ok().filter(|v| !v.is_empty())?))
            })
            .collect::<Vec<_>>()
            .join(", ");
        Failure::NoRenderer(format!(
            "the window could not be opened on the display that the environment names ({named}): {why}; \
             `lcm render` makes pictures without one"
        ))
    })
}
