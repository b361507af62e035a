//! The quantities of plots.

use glam::Vec3;

use crate::optics::colour::luminance;

/// The quantity of a plot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kind {
    /// `f` in sr⁻¹ in the plane of incidence.
    Brdf,
    /// `f cos θ_i` in sr⁻¹: the light that leaves, per unit of irradiance at normal incidence.
    BrdfCos,
    /// `π f cos θ_i`: the response of the program, 1 for a white matte surface that faces the light.
    Response,
    /// `f` as a polar plot: the length of the ray to each viewer.
    Polar,
    /// The directional albedo `E = ∫ f cos θ dω` by the angle of the viewer.
    Albedo,
    /// The reflectance `F` of a facet by the angle between light and facet.
    Fresnel,
    /// The distribution `D` of microfacet normals in sr⁻¹ by the angle θ_h from the normal.
    Distribution,
    /// The masking `G` in the plane of incidence.
    Masking,
    /// `f` by half angle θ_h and difference angle θ_d, across (φ_d = 90°), as a picture: B. Burley (2012),
    /// *Physically-Based Shading at Disney*; angles of S. Rusinkiewicz (1998), *A New Change of Variables for Efficient
    /// BRDF Representation*.
    Slice,
}

impl Kind {
    /// All kinds.
    pub const ALL: [Self; 9] = [
        Self::Brdf,
        Self::BrdfCos,
        Self::Response,
        Self::Polar,
        Self::Albedo,
        Self::Fresnel,
        Self::Distribution,
        Self::Masking,
        Self::Slice,
    ];

    /// The name on the command line.
    #[must_use]
    pub fn id(self) -> &'static str {
        match self {
            Self::Brdf => "f",
            Self::BrdfCos => "f_cos",
            Self::Response => "pi_f_cos",
            Self::Polar => "polar",
            Self::Albedo => "albedo",
            Self::Fresnel => "fresnel",
            Self::Distribution => "d",
            Self::Masking => "g",
            Self::Slice => "slice",
        }
    }

    /// The kind with this name.
    #[must_use]
    pub fn from_id(id: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.id() == id)
    }

    /// The quantity in words.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Brdf | Self::Polar => "BRDF",
            Self::BrdfCos => "BRDF times the cosine of the light",
            Self::Response => "response",
            Self::Albedo => "directional albedo E",
            Self::Fresnel => "Fresnel factor F",
            Self::Distribution => "distribution D of microfacets",
            Self::Masking => "masking factor G",
            Self::Slice => "image slice",
        }
    }

    /// The quantity with its unit, for an axis.
    #[must_use]
    pub fn quantity(self) -> &'static str {
        match self {
            Self::Brdf | Self::Polar | Self::Slice => "f (sr⁻¹)",
            Self::BrdfCos => "f cos θ (sr⁻¹)",
            Self::Response => "π f cos θ",
            Self::Albedo => "E",
            Self::Fresnel => "F",
            Self::Distribution => "D (sr⁻¹)",
            Self::Masking => "G",
        }
    }

    /// The angle of the horizontal axis, with its unit.
    #[must_use]
    pub fn angle(self) -> &'static str {
        match self {
            Self::Brdf | Self::BrdfCos | Self::Response | Self::Polar | Self::Masking => {
                "angle of the viewer (°), mirror side positive"
            }
            Self::Albedo => "angle of the viewer (°)",
            Self::Fresnel => "angle between light and facet (°)",
            Self::Distribution | Self::Slice => "angle between normal and half vector (°)",
        }
    }

    /// True if the quantity depends on the angle of the light.
    #[must_use]
    pub fn has_light(self) -> bool {
        matches!(self, Self::Brdf | Self::BrdfCos | Self::Response | Self::Polar | Self::Masking)
    }

    /// True if the quantity has no colour channels.
    #[must_use]
    pub fn is_scalar(self) -> bool {
        matches!(self, Self::Distribution | Self::Masking)
    }

    /// True if the quantity is the BRDF, perhaps with a factor, in the plane of incidence.
    pub(super) fn is_lobe(self) -> bool {
        matches!(self, Self::Brdf | Self::BrdfCos | Self::Response | Self::Polar)
    }
}

/// The channel shown by a curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Channel {
    /// Luminance by ITU-R BT.709.
    Luminance,
    /// Red.
    Red,
    /// Green.
    Green,
    /// Blue.
    Blue,
}

impl Channel {
    /// All channels.
    pub const ALL: [Self; 4] = [Self::Luminance, Self::Red, Self::Green, Self::Blue];

    /// The name on the command line.
    #[must_use]
    pub fn id(self) -> &'static str {
        match self {
            Self::Luminance => "luminance",
            Self::Red => "r",
            Self::Green => "g",
            Self::Blue => "b",
        }
    }

    /// The channel with this name.
    #[must_use]
    pub fn from_id(id: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|channel| channel.id() == id)
    }

    /// The name in words.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Luminance => "luminance",
            Self::Red => "red",
            Self::Green => "green",
            Self::Blue => "blue",
        }
    }

    /// The value of a colour; not finite if one of its channels is not.
    #[must_use]
    pub fn of(self, rgb: Vec3) -> f64 {
        let value = match self {
            Self::Luminance if rgb.x == rgb.y && rgb.y == rgb.z => rgb.x,
            Self::Luminance if !rgb.is_finite() => f32::NAN,
            Self::Luminance => luminance(rgb),
            Self::Red => rgb.x,
            Self::Green => rgb.y,
            Self::Blue => rgb.z,
        };
        value.into()
    }
}
