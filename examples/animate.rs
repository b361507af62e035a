//! A system that swings a spotlight: `cargo run --release --example animate` draws eight pictures of it, to
//! `renders/animate-1.png` and so on.
//!
//! The spotlight is an entity like any other: spawning it adds a light to the scene, and turning its transform turns its
//! light. `Animated` keeps the motion out of the scene: it is shown, and neither stored nor undone.
#![allow(clippy::print_stdout, missing_docs)]

use std::{error::Error, path::Path};

use bevy::prelude::*;
use lights_camera_models::{
    light::Spot,
    render::{
        capture::{
            gpu::{GpuRenderer, Output},
            png,
        },
        entities::CurrentScene,
        parts::{Animated, LightPower, SceneLight},
    },
    scene::Scene,
};

const WIDTH: u32 = 640;
const HEIGHT: u32 = 360;

/// Turns all spotlights a little further in every frame.
fn swing(mut lights: Query<&mut Transform, With<Spot>>, mut frame: Local<u32>) {
    let angle = (*frame as f32 * 0.5).sin();
    *frame += 1;
    for mut place in &mut lights {
        place.look_to(Vec3::new(0.4 * angle, -1.0, -0.1), Vec3::Z);
    }
}

/// So many pictures of the swinging light, and the scene after them.
pub fn pictures(count: usize) -> Result<(Vec<Vec<u8>>, Scene), Box<dyn Error>> {
    let mut renderer = GpuRenderer::extended(WIDTH, HEIGHT, 1, Output::Display, |app| {
        app.add_systems(Update, swing);
    })?;
    let mut scene = Scene { shading_model: "phong".to_owned(), ..Scene::default() };
    scene.lights[0].intensity = 4.0;
    renderer.set_scene(scene);
    renderer.app().world_mut().spawn((
        Spot { cone_angle: 14.0, ..default() },
        SceneLight { power: LightPower::Intensity(60.0), ..default() },
        Transform::from_xyz(5.0, 9.0, 5.5),
        Animated,
    ));
    renderer.settle()?;
    let mut pictures = Vec::new();
    for _ in 0..count {
        renderer.step();
        pictures.push(renderer.read_rgb8()?);
    }
    let scene = renderer.app().world().resource::<CurrentScene>().0.clone();
    Ok((pictures, scene))
}

#[allow(dead_code)]
fn main() -> Result<(), Box<dyn Error>> {
    let (pictures, scene) = pictures(8)?;
    for (i, picture) in pictures.iter().enumerate() {
        let path = format!("renders/animate-{}.png", i + 1);
        png::write(Path::new(&path), WIDTH, HEIGHT, picture, &[])?;
        println!("wrote {path}");
    }
    println!("The scene has {} lights.", scene.lights.len());
    Ok(())
}
