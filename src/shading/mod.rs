//! Shading models: where on a surface the reflection model is evaluated.
//!
//! **To add one**: write `shading/x.rs` and `assets/shaders/shading/x.wgsl`, and add its name to
//! [`register_builtin`].

use glam::Vec3;

use crate::{
    declared::{entry, forwards, take_each, texts},
    optics::colour::Encoding,
    parameter::{self, Parameter, ParameterSet, Values},
    shader::{Source, wgsl},
};

pub mod normals;

mod builder;
mod derivative;
mod flat;
mod gouraud;
mod phong;

pub use derivative::Derivative;
pub use flat::Flat;
pub use gouraud::Gouraud;
pub use phong::PhongShading;

/// The fallback for a broken shader.
pub(crate) const STAND_IN: Source = wgsl!("shading/phong.wgsl");

/// Receives shading models one after the other.
pub trait Take {
    /// Receives the next one.
    fn take<T: ShadingModel>(&mut self);
}

/// Registers the built-in shading models, in the order of all lists.
pub fn register_builtin(to: &mut impl Take) {
    take_each!(to: Flat Gouraud PhongShading Derivative);
}

texts! {
    /// The stage that evaluates the reflection model.
    Stage(
        /// The stage in words: "per polygon", "per vertex" or "per pixel".
        phrase
    ) {
        /// Once per polygon.
        Polygon = "per polygon",
        /// Once per vertex.
        Vertex = "per vertex",
        /// Once per pixel.
        Pixel = "per pixel",
    }
}

/// The name, source and needs of a shading model.
#[derive(Debug)]
#[non_exhaustive]
pub struct Declaration {
    /// Name in scene files.
    pub id: &'static str,
    /// Display name.
    pub name: &'static str,
    /// Author and year.
    pub author: &'static str,
    /// Author, year, title and place of publication.
    pub source: &'static str,
    /// The method and what to look for, in one or two sentences.
    pub summary: &'static str,
    /// The stage that evaluates the reflection model.
    pub stage: Stage,
    /// True if normals are those of polygons; those inside solid bodies are then, too.
    pub faceted: bool,
    /// Key that selects it in the window.
    pub key: char,
    /// The twin in WGSL: `fn shade_vertex` and `fn shade_pixel`. `shading_parameters()` returns the
    /// parameters by name.
    pub wgsl: Source,
}

/// Evaluates the light loop: the colour of a point with a normal and a tangent, seen from the observer, under the
/// object's reflection model and all lights of the scene. Linear RGB before exposure.
pub trait Lighting {
    /// The colour at `position` (room coordinates, metres) with unit normal `normal` and a `tangent` of
    /// any length and angle to it, or zero; see [`Frame::new`](crate::optics::Frame::new).
    fn colour(&self, position: Vec3, normal: Vec3, tangent: Vec3) -> Vec3;

    /// Announces that the following colours belong to a pixel: light with extent is sampled differently for
    /// each pixel.
    fn begin_pixel(&self, _x: u32, _y: u32) {}
}

/// One corner of a polygon, in room coordinates.
#[derive(Clone, Copy, Debug)]
pub struct Corner {
    /// The position.
    pub position: Vec3,
    /// The vertex normal: the mean of the normals of the polygons around it.
    pub normal: Vec3,
    /// The tangent of the vertex: the brush direction of the surface. Zero without one, and in the CPU
    /// renderer for isotropic models.
    pub tangent: Vec3,
    /// The normal of the polygon.
    pub face_normal: Vec3,
    /// The tangent of the polygon.
    pub face_tangent: Vec3,
    /// The mean of the polygon's corners.
    pub face_centre: Vec3,
}

impl Corner {
    /// The values of the vertex, with a colour.
    #[must_use]
    #[inline]
    pub fn varying(&self, colour: Vec3) -> Varying {
        Varying { position: self.position, normal: self.normal, tangent: self.tangent, colour }
    }
}

/// The values passed from the corners to the pixels, interpolated with perspective correction.
#[derive(Clone, Copy, Debug, Default)]
pub struct Varying {
    /// Position in the room.
    pub position: Vec3,
    /// Normal, not renormalised.
    pub normal: Vec3,
    /// Tangent, neither renormalised nor perpendicular to the normal.
    pub tangent: Vec3,
    /// Colour calculated at the corner, if the shading model does so.
    pub colour: Vec3,
}

/// A shading model: the points at which the light loop runs, with their normals and tangents. The parameters
/// are in the materials of objects, next to those of reflection models, with which they are shared by name.
pub trait ShadingModel: ParameterSet {
    /// Name, source, stage, shader.
    const DECLARATION: Declaration;

    /// The values calculated at a corner of a polygon. For [`Stage::Polygon`] they must be equal at all
    /// corners of a polygon except for `position`. By default those of the vertex, without a colour.
    fn vertex(&self, _lighting: &dyn Lighting, corner: &Corner) -> Varying {
        corner.varying(Vec3::ZERO)
    }

    /// The colour of a pixel; `face_normal` is the exact normal of the **triangle** that covers it.
    fn pixel(&self, lighting: &dyn Lighting, varying: &Varying, face_normal: Vec3) -> Vec3;
}

/// A shading model with its parameters.
pub trait Shading: Send + Sync {
    /// See [`ShadingModel::vertex`].
    fn vertex(&self, lighting: &dyn Lighting, corner: &Corner) -> Varying;

    /// See [`ShadingModel::pixel`].
    fn pixel(&self, lighting: &dyn Lighting, varying: &Varying, face_normal: Vec3) -> Vec3;
}

impl<S: ShadingModel> Shading for S {
    forwards! {
        |this| this => ShadingModel:
        fn vertex(lighting: &dyn Lighting, corner: &Corner) -> Varying;
        fn pixel(lighting: &dyn Lighting, varying: &Varying, face_normal: Vec3) -> Vec3;
    }
}

/// The name of the parameter struct in WGSL, which `shading_parameters()` returns.
pub(crate) const PARAMETERS: &str = "ShadingParameters";
/// Space for parameters in the row of an object, in numbers: a colour takes three.
pub const PARAMETER_WORDS: usize = 16;

/// A registered shading model.
#[derive(Clone, Copy)]
pub struct ShadingEntry {
    /// Name, source, stage, shader.
    pub declaration: &'static Declaration,
    /// Parameters of the shading model.
    pub parameters: &'static [Parameter],
    /// Creates the shading model with the parameters of one object.
    pub instantiate: fn(&Values, Encoding) -> Box<dyn Shading>,
}

impl ShadingEntry {
    /// The entry of a shading model type.
    #[must_use]
    pub fn of<S: ShadingModel>() -> Self {
        Self {
            declaration: const { &S::DECLARATION },
            parameters: S::PARAMETERS,
            instantiate: |values, encoding| Box::new(S::from_values(values, encoding)),
        }
    }

    /// The parameters of one object as [`PARAMETER_WORDS`] numbers, the end of its row in the table that shaders read.
    #[must_use]
    pub fn row(&self, values: &Values, encoding: Encoding) -> Vec<u8> {
        let mut words = parameter::words(self.parameters, values, encoding);
        words.resize(PARAMETER_WORDS, 0);
        words.into_iter().flat_map(u32::to_le_bytes).collect()
    }
}

entry!(ShadingEntry);
