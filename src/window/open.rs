//! Opening the window: the program around the panels and the picture.

use std::{
    panic::{self, AssertUnwindSafe},
    sync::{Arc, Mutex},
};

use bevy::{
    app::{App, PluginGroup, Plugins, Startup, TerminalCtrlCHandlerPlugin},
    asset::AssetPlugin,
    ecs::prelude::*,
    log::{Level, LogPlugin},
    prelude::DefaultPlugins,
    render::{
        RenderPlugin,
        pipelined_rendering::PipelinedRenderingPlugin,
        settings::{RenderCreation, WgpuSettings},
    },
    window::{ExitCondition, PresentMode, Window, WindowPlugin, WindowResolution},
    winit::{EventLoopProxyWrapper, WinitSettings},
};
use bevy_egui::EguiPlugin;
use bevy_panorbit_camera::PanOrbitCameraPlugin;
use glam::UVec2;

use super::{
    ViewOptions, WindowSystemsPlugin, capture, ending, files, frames, laws, recovery, shaders, watching,
};
use crate::{
    failure::Failure,
    panel::{
        PanelPlugin,
        settings::load_settings,
        state::{Effect, LabEffect, Session, Severity},
    },
    recovery::Store,
    registry::Registry,
    render::{
        capture::gpu::{find_adapter, wgpu_settings},
        entities::CurrentScene,
        live::LiveShaders,
        plugin::ScenePlugin,
        trial::{
            Bench,
            process::{Budget, TrialProcess},
        },
    },
};

/// The size of a new window, points.
const SIZE: UVec2 = UVec2::new(1280, 720);

/// Opens the window and stays until it is closed.
///
/// # Errors
/// [`Failure::NoRenderer`] without a display or a driver, [`Failure::Write`] when the capture cannot
/// be written.
pub fn view(options: ViewOptions) -> Result<(), Failure> {
    need_display()?;
    find_adapter().map_err(|e| Failure::NoRenderer(e.to_string()))?;
    let failure = Arc::new(Mutex::new(None));
    let mut app = App::new();
    let plugins = (
        DefaultPlugins
            .set(WindowPlugin {
                primary_window: Some(Window {
                    title: "Lights, Camera, Models!".to_owned(),
                    name: Some("lights-camera-models".to_owned()),
                    resolution: options.size.map_or_else(
                        || WindowResolution::new(SIZE.x, SIZE.y),
                        |[w, h]| WindowResolution::new(w, h).with_scale_factor_override(1.0),
                    ),
                    // Software Vulkan offers no other mode everywhere.
                    present_mode: PresentMode::AutoVsync,
                    ..Window::default()
                }),
                // Closing asks about unsaved changes first.
                close_when_requested: false,
                exit_condition: ExitCondition::OnPrimaryClosed,
                ..WindowPlugin::default()
            })
            .set(RenderPlugin {
                render_creation: RenderCreation::Automatic(Box::new(WgpuSettings { ..wgpu_settings() })),
                // A model that is shown for the first time must not cost a frame without its object.
                synchronous_pipeline_compilation: true,
                ..RenderPlugin::default()
            })
            .set(AssetPlugin { watch_for_changes_override: Some(false), ..AssetPlugin::default() })
            .set(log_plugin(&options))
            .disable::<PipelinedRenderingPlugin>()
            // Signals are heard elsewhere, also while the window sleeps.
            .disable::<TerminalCtrlCHandlerPlugin>(),
        EguiPlugin::default(),
        PanOrbitCameraPlugin,
        ScenePlugin,
        PanelPlugin,
        WindowSystemsPlugin,
    );
    add_with_display(&mut app, plugins)?;
    app.insert_resource(options.registry.clone());
    app.insert_resource(laws::LawChecks::by(options.trial_program.clone()));
    app.world_mut().resource_mut::<frames::FrameClock>().tells = options.verbose;
    let mut session = Session::new(options.scene.clone());
    session.path.clone_from(&options.file);
    session.disk.use_defaults = options.use_defaults;
    session.view.examples_open = options.examples;
    load_settings(&mut session);
    options.warnings.iter().for_each(|warning| session.say(Severity::Warning, warning.as_str()));
    if let Some(registry) = app.world().get_resource::<Registry>() {
        session.model_slots.fill(registry);
    }
    app.insert_resource(CurrentScene(options.scene.clone())).insert_resource(session);
    app.insert_resource(files::DiskFiles::new(options.file.clone(), options.stamp));
    if let Some(program) = options.trial_program {
        let wake = watching::waker(app.world());
        app.world_mut().resource_mut::<Bench>().try_in(TrialProcess::new(program, Budget::default(), wake));
    }
    let wake = watching::waker(app.world());
    app.world_mut().resource_mut::<LiveShaders>().read_apart(wake);
    shaders::open(app.world_mut());
    if let Some(path) = options.open.clone() {
        app.add_systems(Startup, move |mut effects: MessageWriter<LabEffect>| {
            effects.write(LabEffect(Effect::OpenFile(path.clone())));
        });
    }
    let store = Store::of_user();
    let proxy = app.world().get_resource::<EventLoopProxyWrapper>();
    let farewell = recovery::Farewell::prepare(store.clone(), proxy);
    let guard = ending::Guard::set(&farewell.keeper);
    let mut copies = recovery::Recovery::new(farewell.clone());
    if options.exit_after.is_none() || !options.quiet {
        let file = options.file.as_deref().or(options.open.as_deref());
        copies.look(store.as_ref(), file, options.exit_after.is_none());
    }
    app.insert_resource(copies);
    if let Some(frames) = options.exit_after {
        app.insert_resource(WinitSettings::continuous());
        app.add_plugins(capture::ExitAfter { frames, file: options.capture, failure: failure.clone() });
    }
    ending::run(&mut app, &farewell.keeper)?;
    drop(guard);
    farewell.say();
    let failure = failure.lock().ok().and_then(|mut f| f.take());
    failure.map_or(Ok(()), Err)
}

/// Without a display the windowing library would panic; say what is missing instead.
fn need_display() -> Result<(), Failure> {
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

/// Adds the plugins. The windowing library panics when the display that the environment names does not
/// answer, and offers no way to ask first.
fn add_with_display<M>(app: &mut App, plugins: impl Plugins<M>) -> Result<(), Failure> {
    let hook = panic::take_hook();
    panic::set_hook(Box::new(|_| {}));
    let added = panic::catch_unwind(AssertUnwindSafe(|| {
        app.add_plugins(plugins);
    }));
    panic::set_hook(hook);
    added.map_err(|payload| {
        let why = payload
            .downcast_ref::<String>()
            .map(String::as_str)
            .or_else(|| payload.downcast_ref::<&str>().copied())
            .and_then(|text| text.lines().next())
            // The windowing library names its own source files, not the cause.
            .filter(|text| !text.contains("event loop"))
            .map_or_else(|| "it does not answer".to_owned(), str::to_owned);
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

fn log_plugin(options: &ViewOptions) -> LogPlugin {
    let (level, filter) = if options.verbose {
        (Level::INFO, "wgpu=error,naga=warn,notify=error,bevy_render::gpu_readback=error")
    } else if options.quiet {
        (Level::ERROR, "wgpu=error,naga=off,notify=error,bevy_render::gpu_readback=error")
    } else {
        // The status line says that the renderer is a program on the CPU, and problems of a
        // shader are reported in terms of its file; the other messages silenced here are no news to a user.
        (
            Level::WARN,
            "wgpu=error,naga=off,notify=error,bevy_render::renderer=error,bevy_render::gpu_readback=error,bevy_asset=error,bevy_winit=error,bevy_egui=error,winit=error",
        )
    };
    LogPlugin { level, filter: filter.to_owned(), ..LogPlugin::default() }
}
