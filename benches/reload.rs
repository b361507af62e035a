//! From saving a shader to the picture: median and 95th percentile for a model, a term used by all models,
//! and the light loop, in the default scene at the size of a window. A file is written, the watcher reports
//! it, the new version is tried, swapped in, compiled and drawn; frames follow each other as in an active
//! window. The trial runs in the same process, and in another one as for the window.
//!
//! Criterion reports means and medians; the 95th percentile is printed beside them.

use std::{
    fs,
    path::{Path, PathBuf},
    sync::mpsc,
    time::{Duration, Instant},
};

use bevy::ecs::change_detection::{DetectChangesMut as _, Mut};
use criterion::{Criterion, criterion_group, criterion_main};
use lights_camera_models::{
    library::assets::built_in_sources,
    registry::Registry,
    render::{
        capture::gpu::{GpuRenderer, Output},
        live::LiveShaders,
        trial::{
            Bench,
            process::{Budget, TrialProcess},
        },
    },
    scene::Scene,
    watch::Watcher,
};

/// The lab with its shaders in a watched folder.
struct Lab {
    renderer: GpuRenderer,
    watcher: Watcher,
    news: mpsc::Receiver<()>,
    folder: PathBuf,
}

impl Lab {
    fn new(folder: &Path, apart: bool) -> Self {
        let folder = folder.canonicalize().expect("the folder is there");
        for source in built_in_sources(&Registry::builtin()) {
            let file = folder.join(source.path);
            fs::create_dir_all(file.parent().expect("below the folder")).expect("writable");
            fs::write(file, source.text).expect("writable");
        }
        let mut renderer =
            GpuRenderer::new(1280, 720, 1, Output::Display).expect("a Vulkan driver, software will do");
        renderer.app().world_mut().resource_mut::<Registry>().set_shader_folder(&folder);
        renderer.set_scene(Scene::default());
        renderer.settle().expect("the GPU draws");
        // Unchanged content is not drawn: in the window, the processors are free for the trial.
        renderer.draw_on_demand();
        renderer.settle().expect("the GPU draws");
        let (wake, news) = mpsc::channel();
        if apart {
            let wake = wake.clone();
            let process = TrialProcess::new(env!("CARGO_BIN_EXE_lcm").into(), Budget::default(), move || {
                let _ = wake.send(());
            });
            renderer.app().world_mut().resource_mut::<Bench>().try_in(process);
        }
        let mut watcher = Watcher::new(move || {
            let _ = wake.send(());
        });
        watcher.watch_folder(&folder);
        Self { renderer, watcher, news, folder }
    }

    /// Saves a file and waits for the picture with the new version.
    fn save(&mut self, path: &str, text: &str) -> Duration {
        // Nobody saves again before the picture has settled.
        self.renderer.settle().expect("the GPU draws");
        self.renderer.wait();
        while self.news.try_recv().is_ok() {}
        let start = Instant::now();
        fs::write(self.folder.join(path), text).expect("writable");
        loop {
            self.news.recv_timeout(Duration::from_secs(10)).expect("somebody tells");
            let changed = self.watcher.changed();
            let world = self.renderer.app().world_mut();
            world.resource_scope(|world, mut live: Mut<LiveShaders>| {
                // As in the window: looking at a file does not report news about the models.
                let mut registry = world.resource_mut::<Registry>();
                changed.iter().for_each(|f| live.reread(f, registry.bypass_change_detection()));
            });
            self.renderer.step();
            self.renderer.wait();
            let elapsed = start.elapsed();
            let world = self.renderer.app().world();
            let (live, registry) = (world.resource::<LiveShaders>(), world.resource::<Registry>());
            if live.is_trying() || registry.sources().get(path) != Some(text) {
                continue;
            }
            assert!(live.is_up_to_date(), "{:?}", live.status().troubles);
            return elapsed;
        }
    }
}

fn latency(criterion: &mut Criterion) {
    measure(criterion, "save to picture", false);
    measure(criterion, "save to picture, tried in another process", true);
}

fn measure(criterion: &mut Criterion, title: &str, apart: bool) {
    let folder = tempfile::tempdir().expect("a folder");
    let mut lab = Lab::new(folder.path(), apart);
    let mut group = criterion.benchmark_group(title);
    group.sample_size(30).measurement_time(Duration::from_secs(10));
    for (name, path) in [
        ("the model", "reflection/lambert.wgsl"),
        ("a term of all models", "terms.wgsl"),
        ("the light loop", "loop.wgsl"),
    ] {
        let original = built_in_sources(&Registry::builtin())
            .into_iter()
            .find(|s| s.path == path)
            .expect("built in")
            .text;
        let mut times = Vec::new();
        let mut version = 0;
        group.bench_function(name, |b| {
            b.iter_custom(|rounds| {
                (0..rounds)
                    .map(|_| {
                        version += 1;
                        let time = lab.save(path, &format!("{original}// {version}\n"));
                        times.push(time);
                        time
                    })
                    .sum()
            });
        });
        times.sort_unstable();
        let at = |share: f64| times.get((times.len() as f64 * share) as usize).copied().unwrap_or_default();
        println!("{name}: median {:.1?}, 95th percentile {:.1?} of {}", at(0.5), at(0.95), times.len());
    }
    group.finish();
}

criterion_group!(benches, latency);
criterion_main!(benches);
