//! The window as a group of plugins.

use std::{path::PathBuf, time::Duration};

use bevy::{
    app::{PluginGroup, PluginGroupBuilder, ScheduleRunnerPlugin, TerminalCtrlCHandlerPlugin},
    asset::AssetPlugin,
    log::{Level, LogPlugin},
    prelude::DefaultPlugins,
    render::{RenderPlugin, pipelined_rendering::PipelinedRenderingPlugin, settings::RenderCreation},
    window::{ExitCondition, PresentMode, Window, WindowPlugin, WindowResolution},
    winit::WinitPlugin,
};
use bevy_egui::EguiPlugin;
use glam::UVec2;

use super::{
    ViewOptions, camera::CameraPlugin, capture::CapturePlugin, clipping::ClippingPlugin,
    difference::DifferencePlugin, document::DocumentPlugin, gizmos::GizmosPlugin, pick::PickingPlugin,
    picture::PicturePlugin, pictures::PicturesPlugin, recovery::RecoveryPlugin,
    requirements::RequirementsPlugin, shaders::ShaderFilesPlugin, shell::ShellPlugin,
    watching::WatchingPlugin,
};
use crate::{
    panel::PanelPlugin,
    render::{capture::gpu::wgpu_settings, plugin::ScenePlugin},
};

/// The size of a new window, points.
const SIZE: UVec2 = UVec2::new(1280, 720);

/// The whole window, as `lcm view` opens it:
///
/// ```no_run
/// use lights_camera_models::{bevy::prelude::*, prelude::*};
/// # use lights_camera_models::reflection::Lambert as Velvet;
///
/// App::new().add_plugins(LabPlugins::default()).add_reflection_model::<Velvet>().run();
/// ```
///
/// Bevy's `DefaultPlugins` are in it, and these parts. [`ScenePlugin`] and [`DocumentPlugin`] carry the others; each of
/// those can be disabled or replaced, as in every group of plugins, and the rest still works.
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
    /// A window with these choices.
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

    /// The size of the window in pixels, or that of the picture where there is no window.
    #[must_use]
    pub fn size(mut self, width: u32, height: u32) -> Self {
        self.options.size = Some([width, height]);
        self
    }

    /// Closes after so many frames.
    #[must_use]
    pub fn exit_after(mut self, frames: u32) -> Self {
        self.options.exit_after = Some(frames);
        self
    }

    /// Writes the window, or the picture where there is none, to a PNG file before it closes after
    /// [so many frames](Self::exit_after).
    #[must_use]
    pub fn capture(mut self, file: impl Into<PathBuf>) -> Self {
        self.options.capture = Some(file.into());
        self
    }

    /// The same without a window, for tests and batches: the document, the entities and the picture, and nothing that
    /// needs a user, a display, or the user's settings. Frames follow each other without a rest.
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
            // It lets no window sleep.
            .add(CapturePlugin::of(&options))
    }
}

/// Bevy's own plugins.
fn bevys(options: &ViewOptions, headless: bool) -> PluginGroupBuilder {
    let window = Window {
        title: "Lights, Camera, Models!".to_owned(),
        name: Some("lights-camera-models".to_owned()),
        resolution: options.size.map_or_else(
            || WindowResolution::new(SIZE.x, SIZE.y),
            |[w, h]| WindowResolution::new(w, h).with_scale_factor_override(1.0),
        ),
        // Software Vulkan offers no other mode everywhere.
        present_mode: PresentMode::AutoVsync,
        ..Window::default()
    };
    let group = DefaultPlugins
        .set(WindowPlugin {
            primary_window: (!headless).then_some(window),
            // Closing asks about unsaved changes first.
            close_when_requested: false,
            exit_condition: if headless { ExitCondition::DontExit } else { ExitCondition::OnPrimaryClosed },
            ..WindowPlugin::default()
        })
        .set(RenderPlugin {
            render_creation: RenderCreation::Automatic(Box::new(wgpu_settings())),
            // A model that is shown for the first time must not cost a frame without its object.
            synchronous_pipeline_compilation: true,
            ..RenderPlugin::default()
        })
        .set(AssetPlugin { watch_for_changes_override: Some(false), ..AssetPlugin::default() })
        .set(log_plugin(options))
        .disable::<PipelinedRenderingPlugin>()
        // Signals are heard elsewhere, also while the window sleeps.
        .disable::<TerminalCtrlCHandlerPlugin>();
    if headless { group.disable::<WinitPlugin>() } else { group.set(WinitPlugin { run_on_any_thread: true }) }
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
