//! The colour of one pixel, explained: where the equation of the model was evaluated, with which numbers, light by light,
//! and the way from light to the code on the display.
//!
//! Nothing is calculated in a second way: the CPU renderer draws a picture of this one pixel and is watched, so that the
//! last number is the code of the picture with one sample per pixel, at the pixel's centre.
//!
//! ```
//! use lights_camera_models::{explain, reference::Settings, registry::Registry, scene::Scene};
//! let settings = Settings { width: 640, height: 360, ..Settings::default() };
//! let explained = explain::pixel(&Scene::default(), &Registry::builtin(), &settings, [320, 180]).unwrap();
//! let seen = explained.seen.as_ref().expect("the sphere is in the middle");
//! assert_eq!(seen.model.id, "lambert");
//! // Gouraud shading: the equation was evaluated at three vertices.
//! assert_eq!(seen.spots.len(), 3);
//! assert!(explained.to_text().contains("max(0, N·L)"));
//! ```

use std::sync::Arc;

use glam::{Vec3, Vec4};
use thiserror::Error;

use crate::{
    light::Factor,
    optics::{Frame, TermSelection, Terms, colour::luminance},
    parameter::{Parameter, Value},
    reference::{
        DisplaySteps, Picture, Settings,
        meshes::MeshStore,
        probe::{Probe, probe},
        visible,
    },
    reflection::{Declaration, Surface},
    registry::Registry,
    scene::{Display, Scene},
    shading,
};

mod arriving;
mod collect;
mod factor_curve;
pub mod finite;
mod geometry;
pub mod hemisphere;
mod influence;
mod integral;
mod json;
mod lines;
mod noise;
mod numbers;
mod pairs;
mod pinned;
mod put;
mod sentence;
mod text;
mod workings;

pub use arriving::Step;
use collect::Explain;
pub use factor_curve::{Along, FactorCurve};
pub use geometry::Geometry;
pub use influence::{Influence, Knob};
pub use integral::{Brightest, Integral};
pub use lines::{Line, agrees, reading};
pub use noise::{told, triple_within, within};
pub use numbers::{measured, number, of_value, rounded, rounded_number_or_triple, rounded_triple, triple};
pub use pairs::{Pair, pairs};
pub use pinned::{Anchor, Sight};
pub use put::{Put, Symbols, put, put_in};
pub use sentence::sentence;

/// The reason why a pixel cannot be explained.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
pub enum ExplainError {
    /// It is not in the picture.
    #[error(
        "the pixel {},{} is outside the picture of {}x{} pixels; {}",
        .pixel[0], .pixel[1], .size[0], .size[1], legal(.size)
    )]
    Outside {
        /// The pixel.
        pixel: [u32; 2],
        /// Width and height of the picture.
        size: [u32; 2],
    },
}

/// Refuses a pixel that is not in a picture of this size.
///
/// # Errors
/// Its place, and the legal ones.
pub fn inside(pixel: [u32; 2], size: [u32; 2]) -> Result<(), ExplainError> {
    if pixel[0] < size[0] && pixel[1] < size[1] {
        return Ok(());
    }
    Err(ExplainError::Outside { pixel, size })
}

/// The legal pixels of a picture.
fn legal([width, height]: &[u32; 2]) -> String {
    match (width.checked_sub(1), height.checked_sub(1)) {
        (Some(x), Some(y)) => format!("X must be from 0 to {x}, and Y from 0 to {y}"),
        _ => "it has no pixels".to_owned(),
    }
}

/// The explanation of a pixel.
#[derive(Clone, Debug)]
pub struct Explanation {
    /// Column and row, from the top left, from 0.
    pub pixel: [u32; 2],
    /// Width and height of the picture.
    pub size: [u32; 2],
    /// The terms of the equation that are shown.
    pub terms: TermSelection,
    /// The object at the pixel's centre; none where there is only background, or a light.
    pub seen: Option<Seen>,
    /// The light with extent that is seen at the pixel's centre instead, if there is one.
    pub lamp: Option<Lamp>,
    /// The settings of the way to the display.
    pub display: Display,
    /// That way, ending at the code.
    pub steps: DisplaySteps,
}

/// Light with extent that is itself seen at a pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct Lamp {
    /// The light, or several that are infinitely far away.
    pub lights: Vec<Part>,
    /// Their radiance, cd/m².
    pub radiance: Vec3,
}

/// A part of the scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Part {
    /// Its place in the list of the scene, from 0.
    pub index: usize,
    /// The user's name for it.
    pub name: Option<String>,
    /// Id of its type.
    pub id: String,
    /// The name of its type.
    pub type_name: &'static str,
}

/// The object at a pixel, and how it got its light.
#[derive(Clone, Debug)]
pub struct Seen {
    /// The object.
    pub object: Part,
    /// Its reflection model.
    pub model: Model,
    /// Its shading model.
    pub shading: &'static shading::Declaration,
    /// The point of the triangle at the pixel's centre.
    pub position: Vec3,
    /// The number of the polygon in the mesh of the object.
    pub polygon: usize,
    /// The corners of that polygon.
    pub outline: Vec<Vec3>,
    /// The normal of the triangle, which is the polygon's unless the polygon is bent.
    pub face_normal: Vec3,
    /// The normal interpolated between the corners, as the shading model passes it on: not renormalised.
    pub interpolated_normal: Vec3,
    /// The corners of the triangle.
    pub corners: [Corner; 3],
    /// The points at which the equation was evaluated, in order.
    pub spots: Vec<Spot>,
    /// The point at which Phong shading would have evaluated it, for shading models that do so elsewhere.
    pub per_pixel: Option<Spot>,
    /// The light of the pixel: the result of the shading model.
    pub light: Vec3,
}

/// A reflection model with its parameters.
#[derive(Clone)]
pub struct Asked(pub Arc<dyn Surface>);

impl std::fmt::Debug for Asked {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Asked")
    }
}

/// A reflection model with its parameters.
#[derive(Clone, Debug)]
pub struct Model {
    /// Its id.
    pub id: &'static str,
    /// Name, source, equation.
    pub declaration: &'static Declaration,
    /// Its parameters.
    pub settings: Vec<Setting>,
    /// The model with these parameters, to be asked for other directions and for quantities of its equation.
    pub surface: Asked,
    /// True if the CPU interprets its WGSL.
    pub interpreted: bool,
    /// The reason why the CPU cannot run it, if any. Then it gives no light here, and the explanation is not that of the
    /// GPU's picture.
    pub trouble: Option<String>,
}

/// A parameter of the model with its value.
#[derive(Clone, Debug)]
pub struct Setting {
    /// The parameter.
    pub parameter: &'static Parameter,
    /// Its value as scene files have it.
    pub value: Value,
    /// The numbers for calculation, of colours and triples.
    pub linear: Option<Vec3>,
}

/// A corner of the triangle that covers a pixel.
#[derive(Clone, Copy, Debug)]
pub struct Corner {
    /// The number of the vertex in the mesh of the object.
    pub vertex: usize,
    /// Its position in the room.
    pub position: Vec3,
    /// Its weight in the pixel, with perspective correction; the three add up to 1.
    pub weight: f32,
    /// The colour that the shading model calculated there; zero for models that calculate it elsewhere.
    pub colour: Vec3,
}

/// The kind of a point at which the equation is evaluated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Place {
    /// The centre of a polygon.
    Polygon,
    /// A vertex.
    Vertex {
        /// Its number in the mesh of the object.
        vertex: usize,
        /// Its weight in the pixel.
        weight: f32,
    },
    /// The point seen at the pixel's centre.
    Pixel,
}

/// A point at which the equation was evaluated.
#[derive(Clone, Debug)]
pub struct Spot {
    /// Its kind.
    pub place: Place,
    /// Its position in the room.
    pub position: Vec3,
    /// The normal `N`.
    pub normal: Vec3,
    /// The frame around it: anisotropic models are brushed along its tangent.
    pub frame: Frame,
    /// The direction to the observer.
    pub eye: Vec3,
    /// The direction `V` that the model got: that to the observer, mirrored in the surface if the normal faces away from
    /// it.
    pub view: Vec3,
    /// The distance to the observer, metres.
    pub distance: f32,
    /// The lights that are switched on, in the order of the scene.
    pub lights: Vec<Lit>,
    /// The sum over the lights, as it comes.
    pub sum: Vec3,
    /// The sum that is used: values that are no numbers are 0, and none is beyond ±10³⁰.
    pub colour: Vec3,
}

/// One light at a point.
#[derive(Clone, Debug)]
pub struct Lit {
    /// The light.
    pub light: Part,
    /// The equation of the light that arrives at a point.
    pub equation: &'static str,
    /// Its position, for types that have one.
    pub position: Option<Vec3>,
    /// The distance, for types that have a position, metres.
    pub distance: Option<f32>,
    /// The factors of the intensity.
    pub factors: Vec<Factor>,
    /// The intensity `I(p)` at the point.
    pub intensity: Vec3,
    /// The linear colour of the light.
    pub colour: Vec3,
    /// Intensity times colour. Of a light with extent 1: its luminance is in the integral.
    pub arriving: Vec3,
    /// Directions and cosines; none for light from everywhere, and for light with extent.
    pub geometry: Option<Geometry>,
    /// The answer of the model to light of unit intensity, by term; for light from everywhere, its ambient response; for light
    /// with extent the integral of the answer times the luminance.
    pub response: Terms,
    /// What the integral rests on, for light with extent.
    pub integral: Option<Integral>,
    /// The light that leaves to the observer: the response times the arriving light, of the terms that are shown.
    pub contribution: Vec3,
}

impl Explanation {
    /// The code of the pixel: red, green and blue, 0–255.
    #[must_use]
    pub fn code(&self) -> [u8; 3] {
        self.steps.codes
    }
}

impl Seen {
    /// The point that counts most in the pixel: of vertices, the one with the largest weight. None if the shading model did
    /// not evaluate the reflection model.
    #[must_use]
    pub fn main_spot(&self) -> Option<usize> {
        let weight = |i: &usize| match self.spots[*i].place {
            Place::Vertex { weight, .. } => weight,
            Place::Polygon | Place::Pixel => 1.0,
        };
        (0..self.spots.len()).max_by(|a, b| weight(a).total_cmp(&weight(b)))
    }
}

impl Spot {
    /// True if the normal faces away from the observer, who is mirrored in the surface then.
    #[must_use]
    pub fn is_mirrored(&self) -> bool {
        self.eye != self.view
    }

    /// True if the sum was no number, or too bright, and another one was used.
    #[must_use]
    pub fn is_replaced(&self) -> bool {
        self.sum != self.colour
    }

    /// The lights by their contribution, the brightest first; contributions that are no numbers before all others.
    #[must_use]
    pub fn brightest(&self) -> Vec<&Lit> {
        let mut lights: Vec<_> = self.lights.iter().collect();
        let key = |lit: &Lit| match luminance(lit.contribution) {
            light if light.is_nan() => f32::INFINITY,
            light => light,
        };
        lights.sort_by(|a, b| key(b).total_cmp(&key(a)));
        lights
    }
}

impl Lit {
    /// True if the light does not reach the point, as outside a cone.
    #[must_use]
    pub fn is_dark(&self) -> bool {
        self.arriving == Vec3::ZERO || self.integral.is_some() && self.response == Terms::default()
    }

    /// True if the surface faces away from the light.
    #[must_use]
    pub fn is_behind(&self) -> bool {
        self.geometry.is_some_and(|geometry| geometry.cosine("N·L") <= 0.0)
    }

    /// What is to be said before its equation, if anything.
    #[must_use]
    pub fn remark(&self) -> Option<&'static str> {
        if self.is_dark() {
            Some("None of its light reaches the point.")
        } else if self.is_behind() {
            Some("N·L ≤ 0: the surface faces away from the light.")
        } else if self.geometry.is_none() && self.integral.is_none() {
            Some("Light from everywhere: the model answers it as a whole, with its ambient term.")
        } else {
            None
        }
    }

    /// True if all its numbers are finite.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        let Terms { ambient, diffuse, specular } = self.response;
        [ambient, diffuse, specular, self.arriving, self.contribution].iter().all(|v| v.is_finite())
    }
}

/// The angle of a cosine, degrees; rounding beyond ±1 is cut off.
#[must_use]
pub fn angle(cosine: f32) -> f32 {
    cosine.clamp(-1.0, 1.0).acos().to_degrees()
}

/// Explains a pixel of the picture of a scene with these settings, as the CPU renderer draws it with one sample at the
/// pixel's centre; more samples are ignored. The scene of a view is that of [`Scene::seen`].
///
/// # Errors
/// If the pixel is not in the picture.
pub fn pixel(
    scene: &Scene,
    registry: &Registry,
    settings: &Settings,
    pixel: [u32; 2],
) -> Result<Explanation, ExplainError> {
    Explainer::default().pixel(scene, registry, settings, pixel)
}

/// Explains pixel after pixel, and makes the meshes of the scene only once.
#[derive(Default)]
pub struct Explainer {
    meshes: MeshStore,
}

impl std::fmt::Debug for Explainer {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Explainer").finish_non_exhaustive()
    }
}

impl Explainer {
    /// See [`pixel`].
    ///
    /// # Errors
    /// If the pixel is not in the picture.
    pub fn pixel(
        &mut self,
        scene: &Scene,
        registry: &Registry,
        settings: &Settings,
        pixel: [u32; 2],
    ) -> Result<Explanation, ExplainError> {
        explained(&mut self.meshes, scene, registry, settings, pixel)
    }
}

fn explained(
    meshes: &mut MeshStore,
    scene: &Scene,
    registry: &Registry,
    settings: &Settings,
    pixel: [u32; 2],
) -> Result<Explanation, ExplainError> {
    let size = [settings.width, settings.height];
    inside(pixel, size)?;
    let found = probe(meshes, scene, registry, settings, pixel);
    let explain = Explain { scene, registry, settings };
    let beyond = found.as_ref().map(|found| found.varying.position);
    if let Some(shown) = visible::in_front(scene, registry, settings, pixel, beyond) {
        let lights = shown.lights.iter().filter_map(|i| Some(explain.light(*i, scene.lights.get(*i)?)));
        let lamp = Lamp { lights: lights.collect(), radiance: shown.radiance };
        return Ok(explained_as(&explain, pixel, None, Some(lamp), shown.radiance.extend(1.0)));
    }
    Ok(explanation(scene, registry, settings, pixel, found))
}

/// The explanation of what a probe found.
fn explanation(
    scene: &Scene,
    registry: &Registry,
    settings: &Settings,
    pixel: [u32; 2],
    found: Option<Probe>,
) -> Explanation {
    let explain = Explain { scene, registry, settings };
    let light = found.as_ref().map_or(Vec4::ZERO, |found| found.light);
    explained_as(&explain, pixel, found, None, light)
}

/// The explanation of what is seen at a pixel, and its light.
fn explained_as(
    explain: &Explain,
    pixel: [u32; 2],
    found: Option<Probe>,
    lamp: Option<Lamp>,
    light: Vec4,
) -> Explanation {
    let Explain { scene, settings, .. } = explain;
    Explanation {
        pixel,
        size: [settings.width, settings.height],
        terms: settings.terms,
        seen: found.and_then(|found| explain.seen(found)),
        lamp,
        display: scene.display,
        steps: Picture::display_steps(light, &scene.display),
    }
}
