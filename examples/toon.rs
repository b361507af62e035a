//! A reflection model from outside the crate, complete: cartoon shading in a few tones.
//!
//! `cargo run --release --example toon` draws a teapot with it to `renders/toon.png`. The struct has the
//! parameters, `DECLARATION` the name and the laws of the model, `response` is the equation, and `toon.wgsl`
//! the same equation for the GPU. Within the crate the same code would be `src/reflection/toon.rs` and one
//! line in its `register_builtin`.
#![allow(clippy::print_stdout, missing_docs)]

use std::{error::Error, path::Path};

use glam::Vec3;
use lights_camera_models::{
    optics::{Frame, Terms},
    parameter::{BASE_COLOUR, Parameter, Value},
    parameters,
    picture::png,
    reference::{self, Settings},
    reflection::{Declaration, EquationPart, ReflectionModel, Term},
    registry::{Register, Registry},
    scene::{Object, Scene},
    shader::Source,
};

const TONES: Parameter = Parameter::integer("tones", 1..=16, 4)
    .symbol("n")
    .help("The number of tones between black and the base colour.");

parameters! {
    /// Lambert in a few tones.
    pub struct Toon {
        /// The colour, linear.
        base_colour: colour = BASE_COLOUR,
        /// The number of tones.
        tones: number = TONES,
    }
}

impl ReflectionModel for Toon {
    const DECLARATION: Declaration =
        Declaration::new("toon", "Toon", Source::new("toon.wgsl", include_str!("toon.wgsl")))
            .published("an example", "examples/toon.rs")
            .summary("Lambert in a few tones, as in a cartoon.")
            .equation(&[EquationPart::new(Term::Diffuse, "I_d = ceil(n max(0, N·L)) C_b / n")])
            .non_negative();

    fn response(&self, l: Vec3, _v: Vec3, frame: &Frame) -> Terms {
        let tone = (self.tones * frame.n.dot(l).max(0.0)).ceil() / self.tones;
        Terms { diffuse: tone * self.base_colour, ..Terms::default() }
    }

    fn ambient_response(&self, _v: Vec3, _frame: &Frame) -> Vec3 {
        self.base_colour
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    // For an `App` the call is the same: `app.add_reflection_model::<Toon>()`.
    let mut registry = Registry::builtin();
    registry.add_reflection_model::<Toon>();

    let mut teapot = Object { object_type: "teapot".to_owned(), size: 3.4, ..Object::default() };
    teapot.material.set("base_colour", Value::Colour([240, 150, 40]));
    let scene = Scene {
        reflection_model: "toon".to_owned(),
        shading_model: "phong".to_owned(),
        objects: vec![teapot],
        ..Scene::default()
    };

    let settings = Settings { width: 640, height: 360, ..Settings::default() };
    let picture = reference::render_rgb8(&scene, &registry, &settings);
    let path = Path::new("renders/toon.png");
    png::write(path, settings.width, settings.height, &picture, &png::About::default())?;
    println!("wrote {}", path.display());
    Ok(())
}
