//! The declaration of a channel, and the inputs of its formula.

use glam::Vec3;

use super::{
    colours::{BELOW, codes},
    legend::{About, Legend},
};
use crate::optics::{colour::srgb_decode, viridis::viridis};

/// The declaration of a debug channel.
pub struct Declaration {
    /// The name on the command line.
    pub id: &'static str,
    /// The display name.
    pub name: &'static str,
    /// The values of the channel, and what to look for.
    pub explanation: &'static str,
    /// The legend of a picture.
    pub legend: fn(&About<'_>) -> Legend,
    /// True if the legend depends on the shading models of what a view shows.
    pub legend_of_shading: bool,
    /// True if the channel is about one light.
    pub has_light: bool,
    /// True if the light of its formula is the part that remains inside solid bodies, not what leaves the surface.
    pub of_remaining: bool,
    /// The ends of its scale, from the distances between the eye and the near and the far side of each object.
    pub range: Option<fn(&mut dyn Iterator<Item = [f32; 2]>) -> [f32; 2]>,
    /// The picture.
    pub shows: Shows,
}

impl Declaration {
    /// The values that most channels share.
    pub const PLAIN: Self = Self {
        id: "",
        name: "",
        explanation: "",
        legend: |_| Legend::new(""),
        legend_of_shading: false,
        has_light: false,
        of_remaining: false,
        range: None,
        shows: Shows::Picture,
    };
}

/// The picture of a channel: a formula in Rust and the body of its twin in WGSL, or what is drawn over a dim grey surface.
/// The WGSL has the fields of [`Leaving`] or [`Point`] by name, `luminance` for `bright`, and returns what
/// `channels.wgsl` says: display codes, light, a place on the scale, or a direction.
pub enum Shows {
    /// A picture like any other, under one light.
    Picture,
    /// The light that leaves the surface.
    Light(fn(&Leaving<'_>) -> Made, &'static str),
    /// The geometry of the mesh, whatever the shading model makes of it.
    Geometry(fn(&Point<'_>) -> Made, &'static str),
    /// The edges of the polygons.
    Edges,
    /// A line along the normal at each vertex, of these display codes.
    Normals(fn(&Vertex<'_>) -> [u8; 3]),
    /// A dot at each vertex, of these display codes.
    Dots(fn(&Vertex<'_>) -> [u8; 3]),
}

/// The light that leaves a point; it is a number.
pub struct Leaving<'a> {
    /// Before exposure; it may be infinite or below 0.
    pub light: Vec3,
    /// The luminance of the light; finite.
    pub bright: f32,
    /// After exposure.
    pub exposed: Vec3,
    /// The factor of exposure.
    pub exposure: f32,
    /// The pixel in which the point is seen.
    pub pixel: &'a dyn Fn() -> [u32; 2],
    /// True if the display shows light without encoding.
    pub unencoded: bool,
}

/// A point of a surface.
pub struct Point<'a> {
    /// The interpolated normal.
    pub normal: Vec3,
    /// The normal of the triangle.
    pub face_normal: Vec3,
    /// The way to the eye, metres.
    pub to_eye: Vec3,
    /// The direction to the eye.
    pub v: Vec3,
    /// The direction to the light; `None` if there is none with a direction.
    pub l: &'a dyn Fn() -> Option<Vec3>,
    /// The ends of the scale.
    pub range: [f32; 2],
}

/// The result of a formula for a pixel.
pub enum Made {
    /// Linear light.
    Light(Vec3),
    /// A colour as display codes from 0 to 1.
    Codes(Vec3),
    /// A place on the scale, from 0 to 1.
    Place(f32),
    /// A direction.
    Direction(Vec3),
}

impl Made {
    /// A colour of the legend.
    #[must_use]
    pub fn colour(colour: [u8; 3]) -> Self {
        Self::Codes(codes(colour))
    }

    /// A cosine; those below 0, and those that are unknown, are grey.
    #[must_use]
    pub fn cosine(cosine: Option<f32>) -> Self {
        match cosine {
            None | Some(..0.0) => Self::colour(BELOW),
            Some(cosine) => Self::Place(cosine),
        }
    }

    /// The light that shows it.
    #[must_use]
    pub fn shown(self) -> Vec3 {
        match self {
            Self::Light(light) => light,
            Self::Codes(codes) => codes.map(srgb_decode),
            Self::Place(place) => viridis(place).map(srgb_decode),
            Self::Direction(direction) => (0.5 + 0.5 * direction).map(srgb_decode),
        }
    }

    /// The numbers themselves: x, y and z of a direction; a place alone.
    #[must_use]
    pub fn numbers(self) -> Vec3 {
        match self {
            Self::Light(numbers) | Self::Codes(numbers) | Self::Direction(numbers) => numbers,
            Self::Place(place) => Vec3::new(place, 0.0, 0.0),
        }
    }
}

/// A vertex in sight.
pub struct Vertex<'a> {
    /// The normal.
    pub normal: Vec3,
    /// The display codes of the colour that the shading model calculates there, if it does.
    pub colour: Option<&'a dyn Fn() -> [u8; 3]>,
}

impl Vertex<'_> {
    /// The display codes of the normal.
    #[must_use]
    pub fn codes_of_normal(&self) -> [u8; 3] {
        (255.0 * (0.5 + 0.5 * self.normal)).to_array().map(|c| c.round() as u8)
    }
}
