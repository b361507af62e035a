//! The whole process, as experienced by a user: start, read, render, write the PNG file, end.

use std::{
    fs,
    path::Path,
    process::{Command, Stdio},
};

use criterion::{Criterion, criterion_group, criterion_main};

fn render(criterion: &mut Criterion) {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("default.png");
    let mut group = criterion.benchmark_group("lcm render, default scene, 1280×720, whole process");
    group.sample_size(20);
    for renderer in ["cpu", "auto"] {
        for samples in ["1", "4"] {
            group.bench_function(format!("--renderer {renderer} --samples {samples}"), |b| {
                b.iter(|| {
                    let status = Command::new(env!("CARGO_BIN_EXE_lcm"))
                        .args(["render", "--size", "1280x720", "--quiet"])
                        .args(["--renderer", renderer, "--samples", samples, "-o"])
                        .arg(&file)
                        .stdout(Stdio::null())
                        .status()
                        .expect("lcm runs");
                    assert!(status.success());
                });
            });
        }
    }
    group.finish();
}

/// The cost of custom models for commands that do not use them, and for one that lists them.
fn custom_models(criterion: &mut Criterion) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let text = fs::read_to_string(root.join("assets/models/charlie_sheen.wgsl")).expect("it is shipped");
    let scene = root.join("scenes/default.json");
    let mut group = criterion.benchmark_group("custom models in the folder, whole process");
    group.sample_size(21);
    for count in [0, 500] {
        let folder = tempfile::tempdir().expect("a folder");
        let models = folder.path().join("models");
        fs::create_dir(&models).expect("writable");
        for i in 0..count {
            fs::write(models.join(format!("sheen_{i}.wgsl")), &text).expect("writable");
        }
        for command in ["render", "check", "models"] {
            group.bench_function(format!("{command}, {count}"), |b| {
                b.iter(|| {
                    let mut lcm = Command::new(env!("CARGO_BIN_EXE_lcm"));
                    lcm.args([command, "--models"]).arg(&models).stdout(Stdio::null());
                    match command {
                        "render" => lcm.args(["--quiet", "-o"]).arg(folder.path().join("default.png")),
                        "check" => lcm.arg(&scene),
                        _ => &mut lcm,
                    };
                    assert!(lcm.status().expect("lcm runs").success());
                });
            });
        }
    }
    group.finish();
}

criterion_group!(benches, render, custom_models);
criterion_main!(benches);
