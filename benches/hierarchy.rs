//! The hierarchy of a mesh of about 100 000 triangles on one core: its construction, and rays from the surface inwards,
//! which is what light within a solid follows; the time per element is that of one triangle, or of one ray.
#![allow(missing_docs)]

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use glam::Vec3;
use lights_camera_models::{
    shape::{
        Hierarchy, ObjectType as _, PolygonMesh, Teapot, Torus, closed,
        hierarchy::{Ray, Sides},
    },
    testing::{direction, random},
};

fn rays(hierarchy: &Hierarchy) -> Vec<Ray> {
    let (mut seed, count) = (1, hierarchy.triangle_count() as f32);
    (0..4096)
        .map(|_| {
            let triangle = (random(&mut seed) * count) as u32;
            let origin = hierarchy.point(triangle, Vec3::new(0.2, 0.3, 0.5));
            let inwards = -1.2 * hierarchy.triangle_normal(triangle);
            Ray { origin, direction: direction(&mut seed) + inwards }
        })
        .collect()
}

fn hierarchy(c: &mut Criterion) {
    let meshes: [(&str, PolygonMesh); 2] =
        [("torus", Torus::default().mesh(158)), ("teapot", Teapot {}.mesh(40))];
    for (name, mesh) in meshes {
        let triangles = mesh.triangles().count() as u64;
        let mut group = c.benchmark_group(format!("{name} of {triangles} triangles"));
        group.sample_size(10).throughput(Throughput::Elements(triangles));
        group.bench_function("build", |b| b.iter(|| Hierarchy::new(black_box(&mesh))));
        let hierarchy = Hierarchy::new(&mesh);
        group.bench_function("check that it is closed", |b| {
            b.iter(|| closed::check(black_box(&mesh), &hierarchy).is_ok());
        });
        let rays = rays(&hierarchy);
        group.throughput(Throughput::Elements(rays.len() as u64));
        group.bench_function("rays", |b| {
            b.iter(|| {
                for ray in &rays {
                    black_box(hierarchy.nearest(black_box(ray), -1e-5..f32::MAX, Sides::Inside));
                }
            });
        });
    }
}

criterion_group!(benches, hierarchy);
criterion_main!(benches);
