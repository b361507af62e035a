//! A format of scene files: a list of spheres, as a script or a simulation may write it. The command line that is in
//! `main` reads such files in every command, and its window opens and follows them.
//!
//! `cargo run --release --example format -- check balls.spheres`
#![allow(missing_docs)]

use std::process::ExitCode;

use lights_camera_models::{
    bevy::math::Vec3,
    cli,
    prelude::*,
    scene::{
        error::LoadError,
        formats::{Parsed, Source},
    },
    text::place::Place,
};

/// Spheres in the default room, one per line: `x y z size`.
pub struct Spheres;

impl SceneFormat for Spheres {
    fn name(&self) -> &'static str {
        "list of spheres"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["spheres"]
    }

    fn read<'a>(&self, source: &'a Source<'_>, _: &'a Registry) -> Result<Parsed<'a>, LoadError> {
        let mut scene = Scene { name: None, objects: Vec::new(), ..Scene::default() };
        for (i, line) in source.text()?.lines().enumerate() {
            let numbers: Result<Vec<f32>, _> = line.split_whitespace().map(str::parse).collect();
            let Some([x, y, z, size]) = numbers.ok().and_then(|n| <[f32; 4]>::try_from(n).ok()) else {
                let place = Place { line: i + 1, column: 1 };
                return Err(source.syntax_error(self.name(), place, "a line needs four numbers: x y z size"));
            };
            scene.objects.push(Object { position: Vec3::new(x, y, z), size, ..Object::default() });
        }
        // Values are checked as in every format; a mistake is reported at the line of its sphere.
        Ok(Parsed::new(scene).with_places(|path| {
            let sphere = path.index_in("objects")?;
            Some(Place { line: sphere + 1, column: 1 })
        }))
    }
}

pub fn main() -> ExitCode {
    cli::main_with(
        |registry| {
            registry.add_scene_format(Spheres);
        },
        |_| (),
    )
}
