//! The GPU renderer without a window: the same scene plugin, drawing into an image.

use std::{path::Path, sync::OnceLock, time::Duration};

use bevy::{
    a11y::AccessibilityPlugin,
    app::PluginsState,
    asset::RenderAssetUsages,
    camera::{Hdr, RenderTarget},
    light::cluster::GlobalClusterSettings,
    log::LogPlugin,
    prelude::*,
    render::{
        RenderApp, RenderPlugin,
        camera::CameraRenderGraph,
        render_asset::RenderAssets,
        render_resource::*,
        renderer::{RenderAdapterInfo, RenderDevice, RenderQueue, initialize_renderer},
        settings::{RenderCreation, RenderResources, WgpuSettings},
        texture::GpuImage,
    },
    tasks::block_on,
    window::ExitCondition,
    winit::WinitPlugin,
};
use thiserror::Error;
use wgpu::PollError;

use crate::{
    caught::catch_silently,
    channel::{DebugChannel, Setting},
    optics::TermSelection,
    platform::{self, backends},
    reference::{Settings, draw_wires},
    reflection::ends::Endless,
    registry::Registry,
    render::{
        camera::{PictureCamera, picture_camera},
        converge::Convergence,
        entities::CurrentScene,
        illumination::ShownTerms,
        live::LiveShaders,
        meshes::{BATCH, MESH_BUDGET, PICTURE_TRIANGLES, ShapeMeshes},
        overrides::Overrides,
        pass::buffer,
        plugin::ScenePlugin,
        schedule::run_on_one_thread,
        view::View,
    },
    scene::Scene,
    shader::check::ShaderProblem,
};

/// The reason why the GPU renderer could not draw.
#[derive(Debug, Error)]
pub enum GpuError {
    /// No Vulkan adapter, not even a software one.
    #[error(
        "no Vulkan driver found, or no memory to load it; on Debian and Ubuntu `apt-get install libvulkan1 mesa-vulkan-drivers` installs \
         one that needs no GPU, or use `--renderer cpu`, which needs no driver"
    )]
    NoAdapter,
    /// A page in a browser has no time for it.
    #[error("a page in a browser draws on the GPU in its window alone")]
    NoWaiting,
    /// The driver does not start.
    #[error(
        "the graphics driver did not start; it may lack memory; use `--renderer cpu`, which needs no driver"
    )]
    NoDevice,
    /// No picture was ready in time.
    #[error(
        "the GPU renderer gave no picture within {limit:?}: it was waiting for {waiting}; use `--renderer cpu`"
    )]
    TimedOut {
        /// The longest time.
        limit: Duration,
        /// The part that was not ready.
        waiting: String,
    },
    /// A shader could not be compiled.
    #[error("a shader could not be compiled: {0}")]
    Shader(String),
    /// A shader is invalid, at a known position.
    #[error("a shader is not valid: {0}")]
    Invalid(Box<ShaderProblem>),
    /// A model does not terminate, as the CPU found before the GPU was used.
    #[error(transparent)]
    Endless(#[from] Endless),
    /// The GPU does not finish.
    #[error("the GPU did not finish within {0:?}; a loop in a shader may have no end")]
    Stuck(Duration),
    /// The meshes do not fit into memory.
    #[error("{0}, or use `--renderer cpu`, which needs less memory")]
    Memory(String),
    /// The picture could not be copied from the GPU.
    #[error("the picture could not be copied from the GPU: {0}")]
    Copy(String),
}

/// Information about the adapter that draws.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AdapterFacts {
    /// Name given by the driver, e.g. "llvmpipe (LLVM 15.0.6, 256 bits)".
    pub name: String,
    /// True for a software renderer on the CPU.
    pub software: bool,
}

/// True if this machine may have a hardware GPU, judging by the device nodes created by drivers: the cheap
/// test that decides whether `--renderer auto` looks for an adapter at all.
#[must_use]
pub fn may_have_hardware() -> bool {
    if !cfg!(target_os = "linux") {
        return true;
    }
    let render_node = std::fs::read_dir("/dev/dri").is_ok_and(|mut nodes| {
        nodes.any(|n| n.is_ok_and(|n| n.file_name().to_string_lossy().starts_with("renderD")))
    });
    render_node || Path::new("/dev/nvidiactl").exists() || Path::new("/dev/dxg").exists()
}

/// The adapter that would draw, without starting anything: a hardware adapter if there is one.
///
/// # Errors
/// Returns [`GpuError::NoAdapter`] if there is no adapter at all.
pub fn find_adapter() -> Result<AdapterFacts, GpuError> {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = backends();
    let instance = wgpu::Instance::new(descriptor);
    let infos: Vec<_> =
        block_on(instance.enumerate_adapters(backends())).iter().map(wgpu::Adapter::get_info).collect();
    infos
        .iter()
        .find(|i| i.device_type != wgpu::DeviceType::Cpu)
        .or_else(|| infos.first())
        .map(|i| AdapterFacts { name: i.name.clone(), software: i.device_type == wgpu::DeviceType::Cpu })
        .ok_or(GpuError::NoAdapter)
}

/// The settings of the renderer, with or without windows.
#[must_use]
pub fn wgpu_settings() -> WgpuSettings {
    WgpuSettings { backends: Some(backends()), ..WgpuSettings::default() }
}

/// The device of this process. All renderers without a window share it: creating one takes longer than
/// drawing a picture.
pub(super) fn device() -> Result<RenderResources, GpuError> {
    static DEVICE: OnceLock<Option<RenderResources>> = OnceLock::new();
    if !platform::WAITS_FOR_GPU {
        return Err(GpuError::NoWaiting);
    }
    if DEVICE.get().is_none() {
        find_adapter()?;
    }
    DEVICE.get_or_init(start_device).clone().ok_or(GpuError::NoDevice)
}

/// The device, unless the driver fails, as with too little memory: Bevy then panics, which is neither shown nor passed on.
fn start_device() -> Option<RenderResources> {
    catch_silently(|| block_on(initialize_renderer(backends(), None, &wgpu_settings()))).ok()
}

/// The contents of the target.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Output {
    /// For display: tone mapped, sRGB-encoded, 8 bits.
    Display,
    /// Linear 32-bit floats, unclamped, for measurements. One sample per pixel.
    Linear,
}

impl Output {
    fn format(self) -> TextureFormat {
        match self {
            Self::Display => TextureFormat::Rgba8UnormSrgb,
            Self::Linear => TextureFormat::Rgba32Float,
        }
    }
}

/// Maximum duration of a first picture; software Vulkan compiles shaders for a few seconds at most.
pub(super) const PATIENCE: Duration = Duration::from_secs(60);

/// A renderer that draws scenes into an image, frame by frame.
pub struct GpuRenderer {
    pub(super) app: App,
    pub(super) target: Handle<Image>,
    /// The background and the render graph of the camera, if the last picture took several batches.
    pub(super) batched: Option<(ClearColorConfig, CameraRenderGraph)>,
    /// True once frames have run that prepare the first picture.
    pub(super) started: bool,
    /// The channel that is shown.
    pub(super) channel: Option<DebugChannel>,
    /// True if frames take a part of the samples each.
    pub(super) by_parts: bool,
    /// True if frames draw only what changed.
    pub(super) on_demand: bool,
    /// Maximum number of triangles in a frame of a picture that settles.
    pub(super) most_triangles: u64,
    staging: Option<Buffer>,
    output: Output,
    width: u32,
    height: u32,
}

impl GpuRenderer {
    /// Starts a renderer for pictures of one size. `samples` is 1 or 4; [`Output::Linear`] has 1.
    ///
    /// # Errors
    /// Returns [`GpuError::NoAdapter`] without a driver.
    pub fn new(width: u32, height: u32, samples: u8, output: Output) -> Result<Self, GpuError> {
        Self::extended(width, height, samples, output, |_| {})
    }

    /// Like [`new`](Self::new), with additional models, shading models, lights or shapes registered by
    /// `extend`.
    ///
    /// # Errors
    /// Returns the errors of [`new`](Self::new).
    pub fn extended(
        width: u32,
        height: u32,
        samples: u8,
        output: Output,
        extend: impl FnOnce(&mut App),
    ) -> Result<Self, GpuError> {
        let resources = device()?;
        let mut app = App::new();
        app.add_plugins(
            platform::fitting(DefaultPlugins.build())
                .set(WindowPlugin {
                    primary_window: None,
                    exit_condition: ExitCondition::DontExit,
                    ..default()
                })
                .set(RenderPlugin {
                    render_creation: RenderCreation::Manual(resources),
                    synchronous_pipeline_compilation: true,
                    ..RenderPlugin::default()
                })
                .set(AssetPlugin { watch_for_changes_override: Some(false), ..AssetPlugin::default() })
                .disable::<WinitPlugin>()
                .disable::<LogPlugin>()
                // There is no user input.
                .disable::<AccessibilityPlugin>(),
        )
        .add_plugins(ScenePlugin);
        extend(&mut app);

        let mut image = Image::new_target_texture(width, height, output.format(), None);
        image.texture_descriptor.usage |= TextureUsages::COPY_SRC;
        image.asset_usage = RenderAssetUsages::default();
        let target = app.world_mut().resource_mut::<Assets<Image>>().add(image);
        let samples = if output == Output::Linear { 1 } else { samples };
        let mut camera =
            app.world_mut().spawn((picture_camera(samples), RenderTarget::Image(target.clone().into())));
        if output == Output::Display {
            camera.insert(Hdr);
        }
        while app.plugins_state() == PluginsState::Adding {
            std::thread::yield_now();
        }
        app.finish();
        app.cleanup();
        if let Some(mut clusters) = app.world_mut().get_resource_mut::<GlobalClusterSettings>() {
            // Bevy's own lights are not used, so neither is their clustering.
            clusters.gpu_clustering = None;
        }
        app.world_mut().resource_mut::<ShapeMeshes>().limit(BATCH, MESH_BUDGET);
        run_on_one_thread(&mut app);
        Ok(Self {
            app,
            target,
            batched: None,
            started: false,
            channel: None,
            by_parts: false,
            on_demand: false,
            most_triangles: u64::MAX,
            staging: None,
            output,
            width,
            height,
        })
    }

    /// The app, for tests and for registering more.
    pub fn app(&mut self) -> &mut App {
        &mut self.app
    }

    /// Width and height of the pictures, in pixels.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        [self.width, self.height]
    }

    /// Shows another scene from the next frame on.
    pub fn set_scene(&mut self, scene: Scene) {
        self.app.world_mut().resource_mut::<CurrentScene>().set_if_neq(CurrentScene(scene));
    }

    /// Bounds the memory of pictures that [settle](Self::settle): without a GPU they are drawn in batches of at most
    /// [`PICTURE_TRIANGLES`]. For programs that want pictures, not frames: later frames show nothing new.
    pub fn save_memory(&mut self) {
        let adapter = self.app.world().get_resource::<RenderAdapterInfo>();
        if adapter.is_some_and(|adapter| adapter.device_type == wgpu::DeviceType::Cpu) {
            self.limit_triangles(PICTURE_TRIANGLES);
        }
    }

    /// Limits the triangles in a frame of a picture that [settles](Self::settle).
    pub fn limit_triangles(&mut self, most: u64) {
        self.most_triangles = most;
    }

    /// Sets the number of samples of lights with extent, at least 1, for the pictures of scenes set from now
    /// on. Each frame takes all of them if they are at most 256, otherwise eight, as always where light goes through bodies;
    /// of linear pictures, and of those whose shapes come in batches, always all, so large numbers need a fast GPU.
    pub fn set_light_samples(&mut self, count: u32) {
        self.app.world_mut().resource_mut::<Convergence>().target = count.max(1);
    }

    /// Shows only some terms from the next frame on.
    pub fn set_terms(&mut self, terms: TermSelection) {
        self.app.world_mut().resource_mut::<ShownTerms>().set_if_neq(ShownTerms(terms));
    }

    /// Shows a debug channel from the next frame on, or the picture.
    pub fn set_channel(&mut self, channel: Option<Setting>) {
        self.channel = channel.as_ref().map(|setting| setting.channel);
        let world = self.app.world_mut();
        let mut cameras = world.query_filtered::<(Entity, Option<&Overrides>), With<PictureCamera>>();
        let cameras: Vec<_> = cameras.iter(world).map(|(camera, known)| (camera, known.cloned())).collect();
        for (camera, known) in cameras {
            let wanted = Overrides { channel, ..known.clone().unwrap_or_default() };
            if wanted == Overrides::default() {
                world.entity_mut(camera).remove::<Overrides>();
            } else if known.as_ref() != Some(&wanted) {
                world.entity_mut(camera).insert(wanted);
            }
        }
    }

    /// Makes frames draw only what changed, as in the window.
    pub fn draw_on_demand(&mut self) {
        self.on_demand = true;
        self.add_views();
    }

    pub(super) fn add_views(&mut self) {
        let view =
            View { size: UVec2::new(self.width, self.height), format: self.output.format(), inset: None };
        let world = self.app.world_mut();
        let cameras: Vec<_> = world.query_filtered::<Entity, With<PictureCamera>>().iter(world).collect();
        for camera in cameras {
            world.entity_mut(camera).insert(view);
        }
    }

    /// Draws one frame. A picture drawn in [batches](Self::settle) stays unchanged until the next has
    /// settled.
    pub fn step(&mut self) {
        self.app.update();
    }

    /// Waits until the GPU has finished all submitted work; for timing.
    pub fn wait(&mut self) {
        if let Some(render_app) = self.app.get_sub_app(RenderApp) {
            // A lost device is detected when the picture is read.
            let _ = render_app.world().resource::<RenderDevice>().poll(PollType::wait_indefinitely());
        }
    }

    /// The problem that keeps the picture from following the shader files, if any.
    #[must_use]
    pub fn shader_problem(&self) -> Option<ShaderProblem> {
        self.app.world().get_resource::<LiveShaders>()?.refused().cloned()
    }

    /// The bytes of the last picture, rows without padding.
    ///
    /// # Errors
    /// Returns [`GpuError::Copy`] if the picture does not exist yet, or the device was lost.
    pub fn read(&mut self) -> Result<Vec<u8>, GpuError> {
        let target = self.target.clone();
        self.read_view(&target)
    }

    /// Like [`read`](Self::read), from the texture of another view of the same size and format.
    ///
    /// # Errors
    /// Returns the errors of [`read`](Self::read).
    pub fn read_view(&mut self, texture: &Handle<Image>) -> Result<Vec<u8>, GpuError> {
        let missing = || GpuError::Copy("nothing has been drawn yet".to_owned());
        let render_app = self.app.get_sub_app(RenderApp).ok_or_else(missing)?;
        let world = render_app.world();
        let device = world.resource::<RenderDevice>();
        let queue = world.resource::<RenderQueue>();
        let image = world.resource::<RenderAssets<GpuImage>>().get(texture).ok_or_else(missing)?;

        let row = self.width * self.output.format().block_copy_size(None).unwrap_or_default();
        let padded = row.next_multiple_of(256);
        let size = u64::from(padded) * u64::from(self.height);
        let usage = BufferUsages::COPY_DST | BufferUsages::MAP_READ;
        let staging = self.staging.get_or_insert_with(|| buffer(device, "picture", size, usage));
        let mut encoder =
            device.create_command_encoder(&CommandEncoderDescriptor { label: Some("read picture") });
        let layout = TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(padded), rows_per_image: None };
        encoder.copy_texture_to_buffer(
            image.texture.as_image_copy(),
            TexelCopyBufferInfo { buffer: staging, layout },
            Extent3d { width: self.width, height: self.height, depth_or_array_layers: 1 },
        );
        queue.submit([encoder.finish()]);
        let pixels = u64::from(self.width) * u64::from(self.height);
        let bytes = read_back(device, staging, PATIENCE + Duration::from_micros(pixels))?;
        Ok(bytes.chunks_exact(padded as usize).flat_map(|line| &line[..row as usize]).copied().collect())
    }

    /// The last picture, 8-bit RGB, with the lines and dots of its channel.
    ///
    /// # Errors
    /// Returns the errors of [`read`](Self::read).
    pub fn read_rgb8(&mut self) -> Result<Vec<u8>, GpuError> {
        let mut rgb8: Vec<u8> = self.read()?.chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).collect();
        let world = self.app.world_mut();
        let mut cameras = world.query_filtered::<&Overrides, With<PictureCamera>>();
        let channel = cameras.iter(world).find_map(|overrides| overrides.channel).map(|shown| shown.channel);
        if let Some(channel) = channel.filter(|channel| channel.has_wires()) {
            let terms = world.resource::<ShownTerms>().0;
            let settings = Settings { width: self.width, height: self.height, samples: 1, terms };
            let (scene, registry) = (world.resource::<CurrentScene>(), world.resource::<Registry>());
            draw_wires(&mut rgb8, &scene.0, registry, &settings, channel);
        }
        Ok(rgb8)
    }

    /// The last picture, linear RGB; for [`Output::Linear`].
    ///
    /// # Errors
    /// Returns the errors of [`read`](Self::read).
    pub fn read_linear(&mut self) -> Result<Vec<Vec3>, GpuError> {
        Ok(self.read()?.chunks_exact(16).map(vector).collect())
    }
}

/// The bytes of a buffer to which all submitted work has been copied, if this is done in time.
pub(super) fn read_back(
    device: &RenderDevice,
    staging: &Buffer,
    patience: Duration,
) -> Result<Vec<u8>, GpuError> {
    let failed = |e: &dyn std::fmt::Display| GpuError::Copy(e.to_string());
    let (sender, receiver) = std::sync::mpsc::channel();
    staging.slice(..).map_async(MapMode::Read, move |result| {
        let _ = sender.send(result);
    });
    match device.poll(PollType::Wait { submission_index: None, timeout: Some(patience) }) {
        Ok(_) => {}
        Err(PollError::Timeout) => return Err(GpuError::Stuck(patience)),
        Err(e) => return Err(failed(&e)),
    }
    receiver.recv().map_err(|e| failed(&e))?.map_err(|e| failed(&e))?;
    let bytes = staging.slice(..).get_mapped_range().to_vec();
    staging.unmap();
    Ok(bytes)
}

/// Three floats, little-endian.
pub(super) fn vector(bytes: &[u8]) -> Vec3 {
    let float = |b: &[u8]| f32::from_le_bytes([b[0], b[1], b[2], b[3]]);
    Vec3::new(float(&bytes[..4]), float(&bytes[4..8]), float(&bytes[8..12]))
}
