//! The whole process, as a user pays for it: start, read, render, write the PNG file, end.

use std::process::{Command, Stdio};

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

criterion_group!(benches, render);
criterion_main!(benches);
