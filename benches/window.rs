//! The window's frames with only panels, compared with those of an empty window of Bevy and egui, in one run:
//! medians in milliseconds. Needs a display: `xvfb-run -s "-screen 0 1920x1080x24" cargo bench --bench
//! window`.

use std::{
    env,
    process::Command,
    time::{Duration, Instant},
};

use bevy::{
    core_pipeline::tonemapping::Tonemapping,
    log::LogPlugin,
    prelude::*,
    render::{
        RenderPlugin, pipelined_rendering::PipelinedRenderingPlugin, settings::RenderCreation, view::Msaa,
    },
    window::{PresentMode, WindowResolution},
    winit::WinitSettings,
};
use bevy_egui::{EguiContexts, EguiPlugin, EguiPrimaryContextPass, egui};
use lights_camera_models::render::capture::gpu::wgpu_settings;

/// Frames of a run, and the number of first frames that are skipped because the window is still being created.
const FRAMES: usize = 220;
const FIRST: usize = 20;

fn main() {
    let arguments: Vec<String> = env::args().collect();
    if let Some(size) = arguments.iter().position(|a| a == "--empty").and_then(|i| arguments.get(i + 1)) {
        return empty(size);
    }
    println!("{:<11} {:>9} {:>9} {:>9} {:>6}", "", "empty", "panels", "picture", "ratio");
    for size in ["1280x720", "1920x1080"] {
        let this = env::current_exe().expect("this program has a path");
        let empty = number(&said(Command::new(this).args(["--empty", size])), "median ");
        let frames = FRAMES.to_string();
        let window = said(Command::new(env!("CARGO_BIN_EXE_lcm")).args([
            "view",
            "--size",
            size,
            "--exit-after",
            &frames,
            "--verbose",
        ]));
        let panels = number(&window, "panels alone");
        let picture = number(&window, "panels and picture");
        let show = |ms: Option<f64>| ms.map_or("–".to_owned(), |ms| format!("{ms:.1} ms"));
        let ratio = panels.zip(empty).map_or("–".to_owned(), |(a, b)| format!("{:.2}", a / b));
        println!("{size:<11} {:>9} {:>9} {:>9} {ratio:>6}", show(empty), show(panels), show(picture));
    }
}

fn said(command: &mut Command) -> String {
    let output = command.output().expect("it can be started");
    String::from_utf8_lossy(&output.stderr).into_owned() + &String::from_utf8_lossy(&output.stdout)
}

/// The median after `mark` in a text.
fn number(text: &str, mark: &str) -> Option<f64> {
    let after = &text[text.rfind(mark)? + mark.len()..];
    let after = after.split(';').next()?;
    let after = after.split_once("median ").map_or(after, |(_, after)| after);
    after.split_whitespace().next()?.parse().ok()
}

/// A window with one camera and an empty panel, with the same settings otherwise.
fn empty(size: &str) {
    let (width, height) = size.split_once('x').expect("WxH");
    let resolution =
        WindowResolution::new(width.parse().expect("a number"), height.parse().expect("a number"));
    App::new()
        .add_plugins((
            DefaultPlugins
                .set(WindowPlugin {
                    primary_window: Some(Window {
                        resolution: resolution.with_scale_factor_override(1.0),
                        present_mode: PresentMode::AutoVsync,
                        ..Window::default()
                    }),
                    ..WindowPlugin::default()
                })
                .set(RenderPlugin {
                    render_creation: RenderCreation::Automatic(Box::new(wgpu_settings())),
                    synchronous_pipeline_compilation: true,
                    ..RenderPlugin::default()
                })
                .disable::<LogPlugin>()
                .disable::<PipelinedRenderingPlugin>(),
            EguiPlugin::default(),
        ))
        .insert_resource(WinitSettings::continuous())
        .add_systems(Startup, |mut commands: Commands| {
            commands.spawn((Camera2d, Msaa::Off, Tonemapping::None));
        })
        .add_systems(EguiPrimaryContextPass, |mut contexts: EguiContexts| -> Result {
            let context = contexts.ctx_mut()?.clone();
            let all = egui::UiBuilder::new()
                .layer_id(egui::LayerId::background())
                .max_rect(context.viewport_rect());
            let mut ui = egui::Ui::new(context, egui::Id::new("empty"), all);
            egui::CentralPanel::default().show(&mut ui, |_| {});
            Ok(())
        })
        .add_systems(Last, measure)
        .run();
}

fn measure(
    mut last: Local<Option<Instant>>,
    mut times: Local<Vec<Duration>>,
    mut exit: MessageWriter<AppExit>,
) {
    let now = Instant::now();
    times.extend(last.replace(now).map(|last| now - last));
    if times.len() == FRAMES {
        let mut times = times.split_off(FIRST);
        times.sort_unstable();
        println!("median {:.1} ms", times[times.len() / 2].as_secs_f64() * 1e3);
        exit.write(AppExit::Success);
    }
}
