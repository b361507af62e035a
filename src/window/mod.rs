//! The window: the picture in the middle, the panels around it, and what connects the two.
//!
//! [`panel`](crate::panel) draws and decides; here is what needs entities, a camera, files or the
//! operating system. Frames are drawn only when something changes.

use std::{
    panic::{self, AssertUnwindSafe},
    sync::{Arc, Mutex},
    time::Duration,
};

use bevy::{
    app::{
        App, AppExit, Last, Plugin, PluginGroup, Plugins, PostUpdate, PreUpdate, Startup,
        TerminalCtrlCHandlerPlugin,
    },
    asset::{AssetEvent, AssetPlugin},
    camera::{
        Camera, Camera2d, CameraMainTextureUsages, ClearColorConfig, Hdr, RenderTarget,
        visibility::RenderLayers,
    },
    ecs::prelude::*,
    image::Image,
    input::keyboard::{Key, KeyboardInput},
    light::cluster::GlobalClusterSettings,
    log::{Level, LogPlugin},
    math::URect,
    prelude::DefaultPlugins,
    render::{
        RenderPlugin,
        extract_component::ExtractComponent,
        pipelined_rendering::PipelinedRenderingPlugin,
        render_resource::TextureUsages,
        renderer::RenderAdapterInfo,
        settings::{RenderCreation, WgpuSettings},
        view::Msaa,
    },
    window::{
        ExitCondition, MonitorSelection, PresentMode, PrimaryWindow, RequestRedraw, Window,
        WindowCloseRequested, WindowMode, WindowPlugin, WindowResolution,
    },
    winit::{EventLoopProxyWrapper, UpdateMode, WinitSettings, WinitUserEvent},
};
use bevy_egui::{
    EguiGlobalSettings, EguiInput, EguiPlugin, EguiPostUpdateSet, EguiPreUpdateSet, PrimaryEguiContext, egui,
};
use bevy_panorbit_camera::{ActiveCameraData, PanOrbitCameraPlugin, PanOrbitCameraSystemSet};
use glam::{UVec2, Vec2};

use crate::{
    failure::Failure,
    library::status::ShaderStatus,
    panel::{
        PanelPlugin,
        files::{load_settings, run as run_files},
        state::{Action, Badge, Effect, LabEffect, Note, Session, Severity},
        theme::Palette,
    },
    recovery::Store,
    registry::Registry,
    render::{
        camera::{PictureCamera, picture_camera},
        capture::gpu::{find_adapter, wgpu_settings},
        entities::{CurrentScene, absorb},
        live::LiveShaders,
        plugin::{LabFrame, LabSystems, ScenePlugin, ShownTerms},
        show::{ShowPlugin, Shows},
        trial::{
            Bench,
            process::{Budget, TrialProcess},
        },
        view::{Drawing, View, ViewSystems, texture_of},
    },
};

pub mod authoring;
mod camera;
mod capture;
mod clipping;
pub mod editor;
mod ending;
pub mod files;
mod frames;
mod gizmos;
pub mod laws;
mod options;
mod pick;
mod pointer;
mod recovery;
mod shaders;
pub mod watching;

pub use options::ViewOptions;

/// The size of a new window, points.
const SIZE: UVec2 = UVec2::new(1280, 720);
/// How long the window sleeps when nothing happens; it wakes for input at once.
const SLEEP: Duration = Duration::from_secs(3600);
/// Frames that are drawn after the last change: the panels lay themselves out anew in the first and
/// settle in the second.
const SETTLING_FRAMES: u32 = 3;

/// The view that the window shows between its panels, and whose camera the pointer moves. Other views are their
/// owners' business.
#[derive(Component, ExtractComponent, Clone, Copy, Debug, Default)]
pub struct WindowView;

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
        session.fill_model_slots(registry);
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
            // What the windowing library says names its own source files, not the cause.
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
        // That the renderer is a program on the CPU stands in the status line, and what is wrong with a
        // shader is told in terms of its file; the rest of what is silenced here is no news to a user.
        (
            Level::WARN,
            "wgpu=error,naga=off,notify=error,bevy_render::renderer=error,bevy_render::gpu_readback=error,bevy_asset=error,bevy_winit=error,bevy_egui=error,winit=error",
        )
    };
    LogPlugin { level, filter: filter.to_owned(), ..LogPlugin::default() }
}

/// Everything of the window that are systems.
struct WindowSystemsPlugin;

impl Plugin for WindowSystemsPlugin {
    fn build(&self, app: &mut App) {
        app.insert_resource(WinitSettings {
            focused_mode: UpdateMode::reactive(SLEEP),
            unfocused_mode: UpdateMode::reactive_low_power(SLEEP),
        })
        .init_resource::<Settling>()
        .init_resource::<editor::Editors>()
        .init_resource::<laws::LawChecks>()
        .init_resource::<frames::FrameClock>()
        .add_plugins((
            gizmos::GizmosPlugin,
            camera::CameraPlugin,
            ShowPlugin,
            clipping::ClippingPlugin,
            pointer::PointerPlugin,
            watching::WatchingPlugin,
        ))
        .add_systems(Startup, (spawn_cameras, adapter_facts))
        .add_systems(Last, (frames::measure, recovery::keep))
        .add_systems(PreUpdate, (close_requested, recovery::interrupted))
        .add_systems(
            PreUpdate,
            mend_input.after(EguiPreUpdateSet::ProcessInput).before(EguiPreUpdateSet::BeginPass),
        )
        .add_systems(
            LabFrame,
            (
                (
                    watching::collect,
                    shaders::follow,
                    shaders::follow_parameters,
                    watching::watch_document,
                    watching::follow_document,
                    carry_out,
                    recovery::stayed,
                    recovery::offer,
                    pick::pick,
                    lab_to_scene,
                )
                    .chain()
                    .in_set(LabSystems::Load),
                scene_to_lab.in_set(LabSystems::Edit).after(absorb),
                shaders::tell.in_set(LabSystems::Upload),
            ),
        )
        .configure_sets(PostUpdate, ViewSystems.after(PanOrbitCameraSystemSet))
        .add_systems(
            PostUpdate,
            (
                fit_picture.after(EguiPostUpdateSet::EndPass).before(ViewSystems),
                show_picture.after(ViewSystems),
                window_title,
                fullscreen,
                redraw,
            ),
        );
    }

    fn finish(&self, app: &mut App) {
        // egui gets a camera of its own, above the picture.
        if let Some(mut settings) = app.world_mut().get_resource_mut::<EguiGlobalSettings>() {
            settings.auto_create_primary_context = false;
        }
        if let Some(mut clusters) = app.world_mut().get_resource_mut::<GlobalClusterSettings>() {
            // Bevy's own lights are not used, so neither is their clustering.
            clusters.gpu_clustering = None;
        }
    }
}

fn spawn_cameras(mut commands: Commands, adapter: Option<Res<RenderAdapterInfo>>) {
    let software = adapter.is_some_and(|a| a.device_type == wgpu::DeviceType::Cpu);
    // Four samples double the cost of a frame where the GPU is a program on the CPU.
    let samples = if software { 1 } else { 4 };
    commands
        .spawn((picture_camera(samples), Hdr, RenderTarget::None { size: UVec2::ONE }, camera::orbit()))
        .insert((
            PictureCamera { follows_observer: true, fits_width: true },
            WindowView,
            // The panels say how large.
            View::for_display(UVec2::ZERO),
        ));
    commands.spawn((
        Camera2d,
        Camera { order: 1, ..Camera::default() },
        Shows::default(),
        CameraMainTextureUsages::default().with(TextureUsages::COPY_DST),
        Msaa::Off,
        bevy::core_pipeline::tonemapping::Tonemapping::None,
        RenderLayers::none(),
        PrimaryEguiContext,
    ));
}

fn adapter_facts(adapter: Option<Res<RenderAdapterInfo>>, mut session: ResMut<Session>) {
    if let Some(adapter) = adapter {
        session.status.backend = format!("{:?}", adapter.backend);
        session.status.adapter.clone_from(&adapter.name);
    }
}

/// Carries out what the panels asked for.
fn carry_out(
    mut effects: MessageReader<LabEffect>,
    mut session: ResMut<Session>,
    registry: Res<Registry>,
    mut files: ResMut<files::DiskFiles>,
    mut camera: camera::CameraControl,
    watch: Res<watching::FileWatch>,
    mut exit: MessageWriter<AppExit>,
    editors: Res<editor::Editors>,
    laws: Res<laws::LawChecks>,
    proxy: Option<Res<EventLoopProxyWrapper>>,
    mut recovery: ResMut<recovery::Recovery>,
    mut commands: Commands,
) {
    for complaint in editors.take() {
        session.say(Severity::Error, complaint);
    }
    if let Some((model, outcome)) = laws.take() {
        session.laws_checked(&model, outcome);
    }
    let mut pending: Vec<_> = effects.read().map(|e| e.0.clone()).collect();
    pending.reverse();
    while let Some(effect) = pending.pop() {
        match effect {
            Effect::HomeView => camera.home(),
            Effect::FocusSelection => camera.focus(&session),
            Effect::Steer(steer) => camera.steer(steer),
            Effect::ObserverFromView => camera.place_observer(&mut session, &registry),
            Effect::DocumentChanged => {
                files.document_changed(session.path.as_deref());
                camera.home();
            }
            Effect::Quit => {
                recovery.farewell.close();
                exit.write(AppExit::Success);
            }
            Effect::Recovery(choice) => recovery.answer(choice, &mut session, &mut files, &registry),
            Effect::LookAgain(path) => watch.0.report_later(&path, watching::GRACE),
            Effect::Complain(text) => watching::complain(&text),
            // The clipboard belongs to the panels, and so do the dialogs.
            Effect::CopyText(_) => {}
            dialog @ (Effect::PickOpen | Effect::PickSave | Effect::PickShaderFolder) => {
                session.wanted_dialog = Some(dialog);
            }
            Effect::NewModel { .. } | Effect::DuplicateModel { .. } | Effect::ExportShaders(_) => {
                if let Some(folder) = authoring::write(&effect, &mut session, &registry) {
                    commands.queue(move |world: &mut World| shaders::move_to(world, &folder));
                }
            }
            Effect::OpenInEditor { path, line } => {
                let proxy = proxy.as_ref().map(|proxy| (***proxy).clone());
                let variable = std::env::var(editor::EDITOR_VARIABLE).ok();
                editors.open(variable.as_deref(), &path, line, move || {
                    // The window sleeps; without it there is nobody to tell.
                    proxy.map(|proxy| proxy.send_event(WinitUserEvent::WakeUp));
                });
            }
            Effect::CheckLaws(model) => {
                let proxy = proxy.as_ref().map(|proxy| (***proxy).clone());
                laws.begin(&model, registry.folders(), move || {
                    proxy.map(|proxy| proxy.send_event(WinitUserEvent::WakeUp));
                });
            }
            other => {
                let more = run_files(&mut session, &registry, other.clone(), &mut *files);
                // What comes back unchanged is nobody's.
                pending.extend(more.into_iter().rev().filter(|e| *e != other));
            }
        }
    }
}

/// The document goes into the scene that is shown.
fn lab_to_scene(session: Res<Session>, mut scene: ResMut<CurrentScene>, mut terms: ResMut<ShownTerms>) {
    if !session.is_changed() {
        return;
    }
    if session.document != scene.0 {
        scene.0 = session.document.scene().clone();
    }
    terms.set_if_neq(ShownTerms(session.view.terms));
}

/// What others changed in the entities is submitted to the document; what it refuses goes back.
fn scene_to_lab(mut scene: ResMut<CurrentScene>, registry: Res<Registry>, mut session: ResMut<Session>) {
    if scene.is_changed() && session.document != scene.0 {
        if let Err(why) = session.submit(scene.0.clone(), &registry) {
            session.say(Severity::Warning, why);
        }
        if session.document != scene.0 {
            scene.0 = session.document.scene().clone();
        }
    }
}

fn close_requested(
    mut requests: MessageReader<WindowCloseRequested>,
    mut session: ResMut<Session>,
    registry: Res<Registry>,
    mut effects: MessageWriter<LabEffect>,
) {
    if requests.read().count() > 0 {
        for effect in session.apply(Action::Quit, &registry) {
            effects.write(LabEffect(effect));
        }
    }
}

/// The picture has the size of the room that the panels leave, and is shown there.
fn fit_picture(
    session: Res<Session>,
    window: Single<&Window, With<PrimaryWindow>>,
    mut views: Query<(Entity, &mut View, &mut Drawing, &mut Camera), With<WindowView>>,
    mut controls: ResMut<ActiveCameraData>,
    mut room: Local<Option<bool>>,
) {
    let Ok((entity, mut view, mut drawing, mut camera)) = views.single_mut() else { return };
    let place = PicturePlace::of(&session, &window);
    if place.size.min_element() == 0 {
        return;
    }
    let frame = PicturePlace::of_rect(session.picture_frame, &session, &window);
    let at = frame.at.saturating_sub(place.at);
    let inset = (frame != place).then(|| URect::from_corners(at, at + frame.size));
    view.set_if_neq(View { inset, ..View::for_display(place.size) });
    // In the light theme the surround is light.
    let grey = Palette::of(&session.view).surround;
    let surround = bevy::color::Color::srgb_u8(grey.r(), grey.g(), grey.b());
    if !matches!(camera.clear_color, ClearColorConfig::Custom(known) if known == surround) {
        camera.clear_color = ClearColorConfig::Custom(surround);
    }
    if room.replace(session.view.show_room) != Some(session.view.show_room) {
        drawing.redraw();
    }
    controls.set_if_neq(ActiveCameraData {
        entity: Some(entity),
        viewport_size: Some(place.size.as_vec2() / window.scale_factor()),
        window_size: Some(window.size()),
        manual: true,
    });
}

/// Shows the picture's texture in its place.
fn show_picture(
    session: Res<Session>,
    window: Single<&Window, With<PrimaryWindow>>,
    views: Query<&RenderTarget, With<WindowView>>,
    mut shows: Single<&mut Shows, With<PrimaryEguiContext>>,
) {
    let at = PicturePlace::of(&session, &window).at;
    let pictures = views.iter().filter_map(texture_of).map(|texture| (texture.clone(), at)).collect();
    shows.set_if_neq(Shows(pictures));
}

/// Where the picture is in the window, pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct PicturePlace {
    at: UVec2,
    size: UVec2,
}

impl PicturePlace {
    fn of(session: &Session, window: &Window) -> Self {
        Self::of_rect(session.picture_rect, session, window)
    }

    fn of_rect(rect: egui::Rect, session: &Session, window: &Window) -> Self {
        let limit = window.physical_size();
        if !rect.is_finite() || !rect.is_positive() || limit.min_element() == 0 {
            return Self { at: UVec2::ZERO, size: UVec2::ZERO };
        }
        let pixels = |points: f32| (points * session.zoom * window.scale_factor()).round().max(0.0) as u32;
        let at = UVec2::new(pixels(rect.min.x), pixels(rect.min.y)).min(limit.saturating_sub(UVec2::ONE));
        let end = UVec2::new(pixels(rect.max.x), pixels(rect.max.y)).min(limit);
        Self { at, size: end.saturating_sub(at).max(UVec2::ONE) }
    }

    /// Where a place of the window is in the picture, pixels.
    fn within(self, window: &Window, point: Vec2) -> Vec2 {
        point * window.scale_factor() - self.at.as_vec2()
    }
}

fn window_title(session: Res<Session>, mut window: Single<&mut Window, With<PrimaryWindow>>) {
    let mark = if session.is_dirty() { " •" } else { "" };
    let title = format!("{}{mark} – Lights, Camera, Models!", session.window_title());
    if window.title != title {
        window.title = title;
    }
}

/// The window fills the screen where the state says so.
fn fullscreen(session: Res<Session>, mut window: Single<&mut Window, With<PrimaryWindow>>) {
    let mode = if session.view.fullscreen {
        WindowMode::BorderlessFullscreen(MonitorSelection::Current)
    } else {
        WindowMode::Windowed
    };
    if window.mode != mode {
        window.mode = mode;
    }
}

/// How many frames are still to be drawn because something changed.
#[derive(Resource)]
struct Settling {
    frames: u32,
    last: Option<Box<Snapshot>>,
}

impl Default for Settling {
    fn default() -> Self {
        Self { frames: 10, last: None }
    }
}

/// What a frame shows beside the input that egui itself watches.
#[derive(Clone, PartialEq)]
struct Snapshot {
    rect: [f32; 4],
    camera: Option<bevy::transform::components::Transform>,
    terms: ShownTerms,
    messages: Vec<Note>,
    badges: Vec<Badge>,
    question: bool,
    shaders: ShaderStatus,
}

/// Asks for another frame while something changes, and for none when nothing does.
fn redraw(
    session: Res<Session>,
    scene: Res<CurrentScene>,
    terms: Res<ShownTerms>,
    live: Res<LiveShaders>,
    bench: Res<Bench>,
    cameras: Query<&bevy::transform::components::Transform, With<WindowView>>,
    drawings: Query<&Drawing>,
    mut textures: MessageReader<AssetEvent<Image>>,
    mut settling: ResMut<Settling>,
    mut requests: MessageWriter<RequestRedraw>,
) {
    if textures.read().count() > 0 {
        // New letters reach the GPU one frame after they are asked for.
        settling.frames = settling.frames.max(SETTLING_FRAMES);
    }
    let rect = session.picture_rect;
    let now = Snapshot {
        rect: [rect.min.x, rect.min.y, rect.max.x, rect.max.y],
        camera: cameras.iter().next().copied(),
        terms: *terms,
        messages: session.messages.clone(),
        badges: session.disk.badge.iter().chain(&session.badges).cloned().collect(),
        question: session.question.is_some(),
        shaders: session.shaders.clone(),
    };
    // An edit of the panels reaches the scene in the next frame.
    if scene.is_changed() || session.document != scene.0 || settling.last.as_deref() != Some(&now) {
        settling.last = Some(Box::new(now));
        settling.frames = settling.frames.max(SETTLING_FRAMES);
    }
    if drawings.iter().any(|drawing| drawing.draws() && !drawing.is_done()) {
        settling.frames = settling.frames.max(1);
    }
    if live.is_busy() && !bench.is_waiting() && !live.is_reading() {
        // Problems are told after a while, and what is not on the picture is tried one in a frame.
        settling.frames = settling.frames.max(SETTLING_FRAMES);
    }
    if settling.frames > 0 {
        settling.frames -= 1;
        requests.write(RequestRedraw);
    }
}

/// bevy_egui 0.42 tells egui in every frame which modifier keys are held, and egui draws again after
/// every event: the window would never rest. Only changes are news.
///
/// It also gives every key of a frame the modifiers as they are at the frame's end, so that a quick
/// Ctrl+D in a slow frame would be a D: here each key gets those that were held when it was pressed.
fn mend_input(
    mut contexts: Query<&mut EguiInput>,
    mut keyboard: MessageReader<KeyboardInput>,
    mut held: Local<egui::Modifiers>,
    mut running: Local<egui::Modifiers>,
) {
    let mut keys = Vec::new();
    for message in keyboard.read() {
        let pressed = message.state.is_pressed();
        match message.logical_key {
            Key::Shift => running.shift = pressed,
            Key::Alt => running.alt = pressed,
            Key::Control => {
                running.ctrl = pressed;
                running.command = pressed && !cfg!(target_os = "macos");
            }
            Key::Super | Key::Meta if cfg!(target_os = "macos") => {
                running.mac_cmd = pressed;
                running.command = pressed;
            }
            _ => {}
        }
        let key = bevy_egui::helpers::bevy_to_egui_key(&message.logical_key)
            .or_else(|| bevy_egui::helpers::bevy_to_egui_physical_key(&message.key_code));
        keys.extend(key.map(|key| (key, pressed, *running)));
    }
    for mut input in &mut contexts {
        let mut in_order = keys.iter();
        for event in &mut input.events {
            if let egui::Event::Key { key, pressed, modifiers, .. } = event
                && let Some(known) = in_order.by_ref().find(|k| k.0 == *key && k.1 == *pressed)
            {
                *modifiers = known.2;
            }
            if let egui::Event::WindowFocused(false) = event {
                *running = egui::Modifiers::NONE;
            }
        }
        let mut changed = false;
        let known = *held;
        input.events.retain(|event| match event {
            egui::Event::ModifiersChanged(now) => {
                changed |= *now != known;
                *held = *now;
                changed
            }
            _ => true,
        });
    }
}
