//! The explanation of the colour of one pixel: where the model's equation was evaluated, with which numbers,
//! light by light, and how light becomes the code on the display.
//!
//! Nothing is calculated a second time: the CPU renderer draws this one pixel and records its calculation, so
//! that the last number is the code of the picture with one sample per pixel, at the pixel's centre.
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
        DisplaySteps, LightSamples, Picture, Settings, Shot,
        meshes::MeshStore,
        probe::{Probe, probe},
        visible,
    },
    reflection::{Declaration, EquationPart, Surface},
    registry::Registry,
    scene::{Display, Scene},
    shading,
};

mod arriving;
mod collect;
pub mod dark_glass;
mod edited_lights;
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
mod refraction;
mod sentence;
pub mod solids;
mod text;
mod workings;

pub use crate::reference::probe::{Inside, ProbeCorner as Corner, Turn};
pub use arriving::Step;
pub use factor_curve::{Along, FactorCurve};
pub use geometry::Geometry;
pub use influence::{Influence, Knob};
pub use integral::{Brightest, Integral};
pub use lines::{Line, agrees, reading, shown_lines};
pub use noise::{told, triple_within, within};
pub use numbers::{measured, number, of_value, rounded, rounded_number_or_triple, rounded_triple, triple};
pub use pairs::{Pair, pairs};
pub use pinned::{Anchor, Sight};
pub use put::{Put, Symbols, put, put_in};
pub use refraction::Refraction;
pub use sentence::sentence;

/// The reason why a pixel cannot be explained.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
pub enum ExplainError {
    /// The pixel is not in the picture.
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

/// Checks that a pixel is in a picture of this size.
///
/// # Errors
/// Returns an error with the pixel and the valid range if it is outside.
pub fn inside(pixel: [u32; 2], size: [u32; 2]) -> Result<(), ExplainError> {
    if pixel[0] < size[0] && pixel[1] < size[1] {
        return Ok(());
    }
    Err(ExplainError::Outside { pixel, size })
}

/// The valid pixels of a picture.
fn legal([width, height]: &[u32; 2]) -> String {
    match (width.checked_sub(1), height.checked_sub(1)) {
        (Some(x), Some(y)) => format!("X must be from 0 to {x}, and Y from 0 to {y}"),
        _ => "it has no pixels".to_owned(),
    }
}

/// The explanation of a pixel.
#[derive(Clone, Debug)]
pub struct Explanation {
    /// Column and row, counted from 0 at the top left.
    pub pixel: [u32; 2],
    /// Width and height of the picture.
    pub size: [u32; 2],
    /// The displayed terms of the equation.
    pub terms: TermSelection,
    /// The object at the pixel's centre; `None` for background or a light.
    pub seen: Option<Seen>,
    /// The light with extent that is visible at the pixel's centre instead, if any.
    pub lamp: Option<Lamp>,
    /// The settings of the conversion to the display.
    pub display: Display,
    /// The steps of that conversion, ending with the code.
    pub steps: DisplaySteps,
}

impl Explanation {
    /// True if the pixel shows a background that the scene gives.
    #[must_use]
    pub fn shows_backdrop(&self) -> bool {
        self.seen.is_none() && self.lamp.is_none() && self.display.backdrop().is_some()
    }

    /// A pixel without an object or a light, in words.
    #[must_use]
    pub fn about_background(&self) -> &'static str {
        if self.shows_backdrop() {
            "There is no object at the centre of this pixel, only background: the colour that the scene gives. Lights, \
             exposure, encoding and tone mapping do not change it."
        } else {
            "There is no object at the centre of this pixel, only background. It is not light of the scene: lights and \
             exposure do not change it, tone mapping does."
        }
    }
}

/// A light with extent that is itself visible at a pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct Lamp {
    /// The light, or several lights at infinity.
    pub lights: Vec<Part>,
    /// The radiance of the light or lights, cd/m².
    pub radiance: Vec3,
    /// The light that the picture shows: π times the radiance, as a white surface shows that receives it from everywhere.
    pub light: Vec3,
}

/// A part of the scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Part {
    /// Index in the scene's list, from 0.
    pub index: usize,
    /// Name given by the user.
    pub name: Option<String>,
    /// Id of the type.
    pub id: String,
    /// Display name of the type.
    pub type_name: &'static str,
}

/// The object at a pixel, and the calculation of its light.
#[derive(Clone, Debug)]
pub struct Seen {
    /// The object.
    pub object: Part,
    /// The label of the object in a picture, if it stands in a row that has labels.
    pub label: Option<String>,
    /// Reflection model.
    pub model: Model,
    /// Shading model.
    pub shading: &'static shading::Declaration,
    /// The point of the triangle at the pixel's centre.
    pub position: Vec3,
    /// Index of the polygon in the object's mesh.
    pub polygon: usize,
    /// The corners of that polygon.
    pub outline: Vec<Vec3>,
    /// The normal of the triangle, equal to that of the polygon if it is planar.
    pub face_normal: Vec3,
    /// The normal interpolated between the corners, as the shading model passes it on: not renormalised.
    pub interpolated_normal: Vec3,
    /// The corners of the triangle.
    pub corners: [Corner; 3],
    /// The points at which the equation was evaluated, in order.
    pub spots: Vec<Spot>,
    /// The point at which Phong shading would have evaluated the equation, for shading models that evaluate
    /// it elsewhere.
    pub per_pixel: Option<Spot>,
    /// The light of the pixel: the result of the shading model.
    pub light: Vec3,
    /// True for smooth glass [through which no light is seen](dark_glass).
    pub dark_glass: bool,
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
    /// Id of the model.
    pub id: &'static str,
    /// Name, source, equation.
    pub declaration: &'static Declaration,
    /// The parts of its equation, of an opaque surface without the transmitted term.
    pub equation: Vec<EquationPart>,
    /// Parameters of the model.
    pub settings: Vec<Setting>,
    /// The model with these parameters, which can be evaluated for other directions and for quantities of its
    /// equation.
    pub surface: Asked,
    /// True if the CPU interprets its WGSL.
    pub interpreted: bool,
    /// The reason why the CPU cannot run the model, if any. The model then gives no light here, and the
    /// explanation does not match the GPU's picture.
    pub trouble: Option<String>,
}

/// A parameter of the model with its value.
#[derive(Clone, Debug)]
pub struct Setting {
    /// The parameter.
    pub parameter: &'static Parameter,
    /// Value as in scene files.
    pub value: Value,
    /// Linear values of colours and triples, for calculation.
    pub linear: Option<Vec3>,
}

/// The kind of a point at which the equation is evaluated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Place {
    /// The centre of a polygon.
    Polygon,
    /// A vertex.
    Vertex {
        /// Index in the object's mesh.
        vertex: usize,
        /// Weight in the pixel.
        weight: f32,
    },
    /// The point seen at the pixel's centre.
    Pixel,
}

/// A point at which the equation was evaluated.
#[derive(Clone, Debug)]
pub struct Spot {
    /// Kind of point.
    pub place: Place,
    /// Position in the room.
    pub position: Vec3,
    /// The normal `N`.
    pub normal: Vec3,
    /// The frame around the normal: anisotropic models are brushed along its tangent.
    pub frame: Frame,
    /// The direction to the observer.
    pub eye: Vec3,
    /// The direction `V` passed to the model: the direction to the observer, mirrored in the surface if the
    /// normal faces away.
    pub view: Vec3,
    /// The distance to the observer, metres.
    pub distance: f32,
    /// The refraction of the view, for models that bend light.
    pub refraction: Option<Refraction>,
    /// The active lights, in the order of the scene.
    pub lights: Vec<Lit>,
    /// The unmodified sum over the lights.
    pub sum: Vec3,
    /// The sum as used: NaN becomes 0, and values are limited to ±10³⁰.
    pub colour: Vec3,
}

/// One light at a point.
#[derive(Clone, Debug)]
pub struct Lit {
    /// The light.
    pub light: Part,
    /// The equation of the light that arrives at a point.
    pub equation: &'static str,
    /// Position, for types that have one.
    pub position: Option<Vec3>,
    /// Distance in metres, for types that have a position.
    pub distance: Option<f32>,
    /// The factors of the intensity.
    pub factors: Vec<Factor>,
    /// The intensity `I(p)` at the point.
    pub intensity: Vec3,
    /// The linear colour of the light.
    pub colour: Vec3,
    /// Intensity times colour; 1 for a light with extent, whose luminance is in the integral.
    pub arriving: Vec3,
    /// Directions and cosines; none for uniform light and for light with extent.
    pub geometry: Option<Geometry>,
    /// The response of the model to light of unit intensity, by term; its ambient response for uniform light;
    /// the integral of response times luminance for light with extent.
    pub response: Terms,
    /// Basis of the integral, for light with extent.
    pub integral: Option<Integral>,
    /// The light of a light without extent that comes through the body, if that is displayed.
    pub through: Vec3,
    /// The light to the observer: the response times the arriving light, for the displayed terms, and the transmitted
    /// light.
    pub contribution: Vec3,
}

impl Explanation {
    /// The code of the pixel: red, green and blue, 0–255.
    #[must_use]
    pub fn code(&self) -> [u8; 3] {
        self.steps.codes
    }
}

impl Place {
    /// Weight in the pixel.
    #[must_use]
    pub fn weight(self) -> f32 {
        match self {
            Self::Vertex { weight, .. } => weight,
            Self::Polygon | Self::Pixel => 1.0,
        }
    }
}

impl Seen {
    /// The most important point of the pixel: among vertices, the one with the largest weight. `None` if the
    /// shading model did not evaluate the reflection model.
    #[must_use]
    pub fn main_spot(&self) -> Option<usize> {
        let weight = |i: &usize| self.spots[*i].place.weight();
        (0..self.spots.len()).max_by(|a, b| weight(a).total_cmp(&weight(b)))
    }
}

impl Spot {
    /// True if the normal faces away from the observer, whose direction is then mirrored in the surface.
    #[must_use]
    pub fn is_mirrored(&self) -> bool {
        self.eye != self.view
    }

    /// True if the sum was NaN or too bright, and was replaced.
    #[must_use]
    pub fn is_replaced(&self) -> bool {
        self.sum != self.colour
    }

    /// The lights by contribution, brightest first; NaN contributions come before all others.
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

    /// The remark to show before the equation of a model, if any.
    #[must_use]
    pub fn remark_on(&self, model: &Model) -> Option<&'static str> {
        if model.declaration.transmits && self.is_behind() && !self.is_dark() {
            return Some(
                "N·L ≤ 0: the light is behind the surface, and what is seen of it has come through.",
            );
        }
        self.remark()
    }

    /// The remark to show before the equation of a model that only reflects, if any.
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

    /// True if all numbers are finite.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.response.each().iter().chain([&self.arriving, &self.contribution]).all(|v| v.is_finite())
    }
}

/// The angle of a cosine, in degrees; rounding beyond ±1 is clamped.
#[must_use]
pub fn angle(cosine: f32) -> f32 {
    cosine.clamp(-1.0, 1.0).acos().to_degrees()
}

/// Explains a pixel of the picture of a scene with these settings, as the CPU renderer draws it with one
/// sample at the pixel's centre; more samples are ignored. For a view, pass the scene from [`Scene::seen`].
///
/// # Errors
/// Returns an error if the pixel is not in the picture.
pub fn pixel(
    scene: &Scene,
    registry: &Registry,
    settings: &Settings,
    pixel: [u32; 2],
) -> Result<Explanation, ExplainError> {
    Explainer::default().pixel(scene, registry, settings, pixel)
}

/// Explains one pixel after another, building the meshes of the scene only once.
#[derive(Debug, Default)]
pub struct Explainer {
    meshes: MeshStore,
    samples: LightSamples,
}

impl Explainer {
    /// Sets the number of samples of each light with extent, and of the lobes; by default [`LightSamples::DEFAULT`], as in
    /// pictures.
    pub fn set_light_samples(&mut self, count: u32) {
        self.samples = LightSamples::of(count.max(1));
    }

    /// See [`pixel`].
    ///
    /// # Errors
    /// Returns an error if the pixel is not in the picture.
    pub fn pixel(
        &mut self,
        scene: &Scene,
        registry: &Registry,
        settings: &Settings,
        pixel: [u32; 2],
    ) -> Result<Explanation, ExplainError> {
        let shot = Shot { samples: self.samples, ..Shot::new(scene, registry, settings) };
        inside(pixel, [settings.width, settings.height])?;
        let found = probe(&mut self.meshes, shot, pixel);
        let beyond = found.as_ref().map(|found| found.varying.position);
        let lamp = visible::in_front(shot, pixel, beyond).map(|shown| shot.lamp(&shown));
        Ok(explanation(shot, pixel, found.filter(|_| lamp.is_none()), lamp))
    }
}

/// The explanation of the object at a pixel, or of the light that is visible there.
fn explanation(shot: Shot, pixel: [u32; 2], found: Option<Probe>, lamp: Option<Lamp>) -> Explanation {
    let Shot { scene, settings, .. } = shot;
    let of_object = || found.as_ref().map_or(Vec4::ZERO, |found| found.light);
    let light = lamp.as_ref().map_or_else(of_object, |lamp| lamp.light.extend(1.0));
    Explanation {
        pixel,
        size: [settings.width, settings.height],
        terms: settings.terms,
        seen: found.and_then(|found| shot.seen(found)),
        lamp,
        display: scene.display,
        steps: Picture::display_steps(light, &scene.display, pixel[1], settings.height),
    }
}
