//! The window as a group of plugins.

use std::{path::PathBuf, time::Duration};

use bevy::{
    app::{PluginGroupBuilder, ScheduleRunnerPlugin},
    log::{Level, LogPlugin},
    prelude::*,
    render::{RenderPlugin, settings::RenderCreation},
    window::{ExitCondition, PresentMode, WindowResizeConstraints, WindowResolution},
    winit::WinitPlugin,
};
use bevy_egui::EguiPlugin;

use super::{
    ViewOptions, camera::CameraPlugin, capture::CapturePlugin, clipping::ClippingPlugin,
    difference::DifferencePlugin, document::DocumentPlugin, gizmos::GizmosPlugin, pick::PickingPlugin,
    picture::PicturePlugin, pictures::PicturesPlugin, recovery::RecoveryPlugin,
    requirements::RequirementsPlugin, shaders::ShaderFilesPlugin, shell::ShellPlugin,
    watching::WatchingPlugin,
};
use crate::{
    panel::PanelPlugin,
    platform, program,
    render::{capture::gpu::wgpu_settings, plugin::ScenePlugin},
};

/// Size of a new window, in points.
const SIZE: UVec2 = UVec2::new(1280, 720);
/// Size below which the window cannot be made, in points: panels and questions would have no room.
const LEAST: Vec2 = Vec2::new(360.0, 360.0);

/// The whole window, as `lcm view` opens it:
///
/// ```no_run
/// use lights_camera_models::{bevy::prelude::*, prelude::*};
/// # use lights_camera_models::reflection::Lambert as Velvet;
///
/// App::new().add_plugins(LabPlugins::default()).add_reflection_model::<Velvet>().run();
/// ```
///
/// The group contains Bevy's `DefaultPlugins` and the parts below. [`ScenePlugin`] and [`DocumentPlugin`] are the basis
/// of the others; each of the others can be disabled or replaced, as in every plugin group, and the rest still works.
///
/// | plugin | part |
/// |---|---|
/// | [`RequirementsPlugin`] | a sentence and an exit status where there is no display or no driver |
/// | [`ScenePlugin`] | the scene as entities, lit and shaded |
/// | [`DocumentPlugin`] | the document, its files and its history |
/// | [`PicturePlugin`] | the view of the scene, and its place in the window |
/// | `EguiPlugin`, [`PanelPlugin`] | the panels; without them the picture fills the window |
/// | [`CameraPlugin`] | orbit, pan and zoom by the pointer |
/// | [`PickingPlugin`] | clicks select what is under the pointer |
/// | [`GizmosPlugin`] | the outline of the room |
/// | [`ClippingPlugin`] | counts clipped pixels |
/// | [`DifferencePlugin`] | the numbers and the map of a comparison |
/// | [`PicturesPlugin`] | saves and copies the picture |
/// | [`WatchingPlugin`] | the file of the scene is followed while others change it |
/// | [`ShaderFilesPlugin`] | custom models, and shaders on disk; followed too if there is a [`WatchingPlugin`] |
/// | [`RecoveryPlugin`] | copies of unsaved work, and the question before the window closes on Ctrl+C |
/// | [`ShellPlugin`] | title, full screen, closing; the window sleeps while nothing changes |
/// | [`CapturePlugin`] | closes after some frames, with a picture of the window |
#[derive(Clone, Debug)]
pub struct LabPlugins {
    options: ViewOptions,
    headless: bool,
}

impl Default for LabPlugins {
    fn default() -> Self {
        Self::new(ViewOptions { examples: true, ..ViewOptions::default() })
    }
}

impl LabPlugins {
    /// Creates a window with these options.
    #[must_use]
    pub fn new(options: ViewOptions) -> Self {
        Self { options, headless: false }
    }

    /// Opens a scene file. Problems with it are reported in the window.
    #[must_use]
    pub fn scene(mut self, file: impl Into<PathBuf>) -> Self {
        self.options.open = Some(file.into());
        self.options.examples = false;
        self
    }

    /// Sets the size of the window in pixels, or that of the picture if there is no window.
    #[must_use]
    pub fn size(mut self, width: u32, height: u32) -> Self {
        self.options.size = Some([width, height]);
        self
    }

    /// Closes the window after a number of frames.
    #[must_use]
    pub fn exit_after(mut self, frames: u32) -> Self {
        self.options.exit_after = Some(frames);
        self
    }

    /// Writes the window, or the picture if there is no window, to a PNG file before closing after [a number of
    /// frames](Self::exit_after).
    #[must_use]
    pub fn capture(mut self, file: impl Into<PathBuf>) -> Self {
        self.options.capture = Some(file.into());
        self
    }

    /// Removes the window, for tests and batch jobs: keeps the document, the entities and the picture, but nothing that
    /// needs a user, a display, or the user's settings. Frames follow each other without a pause.
    #[must_use]
    pub fn headless(mut self) -> Self {
        self.headless = true;
        self
    }
}

impl PluginGroup for LabPlugins {
    fn build(self) -> PluginGroupBuilder {
        let Self { options, headless } = self;
        let size = options.size.map(|[w, h]| UVec2::new(w, h));
        let group = PluginGroupBuilder::start::<Self>()
            .add(RequirementsPlugin { display: !headless })
            .add_group(bevys(&options, headless))
            .add(ScenePlugin)
            .add(DocumentPlugin { options: options.clone(), for_user: !headless })
            .add(PicturePlugin { alone: headless.then(|| size.unwrap_or(SIZE)) })
            .add(PicturesPlugin)
            .add(GizmosPlugin)
            .add(WatchingPlugin)
            .add(ShaderFilesPlugin { trial_program: options.trial_program.clone() });
        if headless {
            return group
                .add(CapturePlugin::of(&options))
                .add(ScheduleRunnerPlugin::run_loop(Duration::ZERO));
        }
        group
            .add(EguiPlugin::default())
            .add(PanelPlugin)
            .add(CameraPlugin)
            .add(PickingPlugin)
            .add(ClippingPlugin)
            .add(DifferencePlugin)
            .add(ShellPlugin { verbose: options.verbose })
            .add(RecoveryPlugin::of(&options))
            // It keeps the window awake.
            .add(CapturePlugin::of(&options))
    }
}

/// The window at its start.
fn window(options: &ViewOptions) -> Window {
    Window {
        title: program::title().to_owned(),
        name: Some(program::name().to_owned()),
        resolution: options.size.map_or_else(
            || WindowResolution::new(SIZE.x, SIZE.y),
            |[w, h]| WindowResolution::new(w, h).with_scale_factor_override(1.0),
        ),
        // A size that was asked for counts, whatever it is.
        resize_constraints: match options.size {
            Some(_) => WindowResizeConstraints::default(),
            None => WindowResizeConstraints { min_width: LEAST.x, min_height: LEAST.y, ..default() },
        },
        // The only mode that software Vulkan supports everywhere.
        present_mode: PresentMode::AutoVsync,
        ..Window::default()
    }
}

/// Bevy's default plugins.
fn bevys(options: &ViewOptions, headless: bool) -> PluginGroupBuilder {
    let group = DefaultPlugins
        .set(WindowPlugin {
            primary_window: (!headless).then(|| platform::placed(window(options))),
            // Closing the window first asks about unsaved changes.
            close_when_requested: false,
            exit_condition: if headless { ExitCondition::DontExit } else { ExitCondition::OnPrimaryClosed },
            ..WindowPlugin::default()
        })
        .set(RenderPlugin {
            render_creation: RenderCreation::Automatic(Box::new(wgpu_settings())),
            // A newly shown model must not cost a frame without its object.
            synchronous_pipeline_compilation: true,
            ..RenderPlugin::default()
        })
        .set(AssetPlugin { watch_for_changes_override: Some(false), ..AssetPlugin::default() })
        .set(log_plugin(options));
    let group = platform::fitting(group);
    if headless { group.disable::<WinitPlugin>() } else { group.set(WinitPlugin { run_on_any_thread: true }) }
}

fn log_plugin(options: &ViewOptions) -> LogPlugin {
    // Where Bevy has no tables of tone curves, it has the program's, and does not know.
    const ALWAYS: &str =
        "wgpu=error,notify=error,bevy_render::gpu_readback=error,bevy_core_pipeline::tonemapping=off";
    let (level, more) = if options.verbose {
        (Level::INFO, "naga=warn")
    } else if options.quiet {
        (Level::ERROR, "naga=off")
    } else {
        // The status line says if the renderer runs on the CPU, and problems of a shader are reported in terms of its
        // file; the other messages silenced here are irrelevant to users.
        (
            Level::WARN,
            "naga=off,bevy_render::renderer=error,bevy_asset=error,bevy_winit=error,bevy_egui=error,winit=error",
        )
    };
    LogPlugin { level, filter: format!("{ALWAYS},{more}"), ..LogPlugin::default() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_window_stays_large_enough_for_its_panels_unless_a_size_was_asked_for() {
        let least = |options: &ViewOptions| {
            let limits = window(options).resize_constraints;
            [limits.min_width, limits.min_height]
        };
        assert_eq!(least(&ViewOptions::default()), LEAST.to_array());
        let asked = ViewOptions { size: Some([400, 300]), ..ViewOptions::default() };
        assert!(least(&asked)[0] <= 400.0 && least(&asked)[1] <= 300.0);
    }
}
