//! Curves of reflection models: the BRDF in the plane of incidence, directional albedo, single factors of
//! microfacet models, image slices. Independent of the window: the content of plots, as numbers and as
//! figures.
//!
//! ```
//! use lights_camera_models::{
//!     curves::{Detail, Kind, Setup, Sheet, Subject, curve},
//!     optics::colour::Encoding,
//!     parameter::Values,
//!     progress::Progress,
//!     registry::Registry,
//! };
//!
//! let registry = Registry::builtin();
//! let phong = Subject::model(registry.model("phong").unwrap(), &Values::default(), Encoding::Srgb);
//! let setup = Setup::new(Kind::Brdf, 45.0, 0.0).unwrap();
//! let curve = curve(&phong, &setup, Detail::Coarse, &Progress::NONE).unwrap();
//! let sheet = Sheet { curves: vec![curve], ..Sheet::new(setup) };
//! assert!(sheet.figure().svg().contains("Phong"));
//! ```
//!
//! [`data`] has measured values for comparison, [`draw`] the figures.

mod adaptive;
mod angles;
mod channel;
pub mod data;
pub mod draw;
mod format;
mod kind;
pub mod lobe;
mod sample;
mod sheet;
mod slice;
mod subject;
mod table;

use glam::Vec3;

use crate::{progress::Cancelled, text::shortened};

pub use channel::Channel;
pub use format::Format;
pub use kind::{Declaration, Form, Kind};
pub use lobe::Lobe;
pub use sample::{curve, subjects_with};
pub use sheet::{Sheet, Style};
pub use slice::{Slice, slice};
pub use subject::Subject;

/// The settings shared by all curves of a plot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setup {
    /// The quantity.
    pub kind: Kind,
    /// The angle between light and normal, degrees; 0 ≤ θ_i < 90.
    pub theta_i: f64,
    /// The azimuth of the light from the tangent, degrees; for albedos that of the viewer, for D and slices that of the
    /// half vector. It matters for anisotropic models.
    pub phi_i: f64,
}

impl Setup {
    /// A setup with legal angles.
    ///
    /// # Errors
    /// Returns an error if the light is not above the surface, or the azimuth is more than a turn.
    pub fn new(kind: Kind, theta_i: f64, phi_i: f64) -> Result<Self, CurveError> {
        if !(0.0..90.0).contains(&theta_i) {
            return Err(CurveError::Light(theta_i));
        }
        if !(-360.0..=360.0).contains(&phi_i) {
            return Err(CurveError::Azimuth(phi_i));
        }
        Ok(Self { kind, theta_i, phi_i })
    }
}

/// The number of points of a curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Detail {
    /// A few points, for an immediate result.
    Coarse,
    /// As many as the curve needs to look smooth, more where it bends.
    Fine,
}

/// A point of a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// The angle in degrees; see [`Declaration::horizontal`].
    pub angle: f64,
    /// The value in red, green and blue, as calculated: it may not be finite.
    pub rgb: Vec3,
}

/// A curve, or measured points.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Name in the legend.
    pub name: String,
    /// The points by increasing angle.
    pub points: Vec<Point>,
    /// The standard uncertainty of each point's value; empty if it is not known.
    pub sigma: Vec<f64>,
    /// True if the points were measured, and nothing is known between them.
    pub measured: bool,
    /// True if a part of the light leaves in a single direction, which the curve leaves out.
    pub sharp: bool,
    /// True if light passes through the surface, which the curve does not count.
    pub reflected: bool,
}

impl Curve {
    /// The uncertainty of the point nearest to an angle.
    #[must_use]
    pub fn sigma_at(&self, angle: f64) -> Option<f64> {
        let off = |(point, _): &(&Point, &f64)| (point.angle - angle).abs();
        let nearest = self.points.iter().zip(&self.sigma).min_by(|a, b| off(a).total_cmp(&off(b)));
        nearest.map(|(_, sigma)| *sigma)
    }

    /// The points without a finite value.
    #[must_use]
    pub fn missing(&self) -> Option<Missing> {
        let runs = self.points.chunk_by(|a, b| a.rgb.is_finite() == b.rgb.is_finite());
        let broken = runs.filter(|run| !run[0].rgb.is_finite());
        let ranges: Vec<_> = broken.map(|run| (run[0].angle, run[run.len() - 1].angle)).collect();
        let all = self.points.iter().all(|p| !p.rgb.is_finite());
        (!ranges.is_empty()).then_some(Missing { ranges, all })
    }
}

/// Points of a curve that have no finite value.
#[derive(Clone, Debug, PartialEq)]
pub struct Missing {
    /// The first and the last angle of each gap, degrees.
    pub ranges: Vec<(f64, f64)>,
    /// True if no point has a finite value.
    pub all: bool,
}

impl std::fmt::Display for Missing {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        /// Maximum number of gaps that are listed.
        const LISTED: usize = 3;
        if self.all {
            return f.write_str("no value is a finite number");
        }
        let degrees = |v: f64| format!("{}°", (v * 10.0).round() / 10.0 + 0.0).replace('-', "−");
        let range = |(first, last): &(f64, f64)| match (degrees(*first), degrees(*last)) {
            (first, last) if first == last => format!("at {first}"),
            (first, last) => format!("from {first} to {last}"),
        };
        let mut gaps: Vec<_> = self.ranges.iter().take(LISTED).map(range).collect();
        if self.ranges.len() > LISTED {
            gaps.push("elsewhere".to_owned());
        }
        write!(f, "values are not finite numbers {}", crate::text::listed(&gaps, "and"))
    }
}

/// The reason why a curve cannot be calculated.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CurveError {
    /// The light is below the surface.
    #[error("the angle of the light is {}°, but it must be at least 0° and less than 90°", shortened(.0.to_string().as_str()))]
    Light(f64),
    /// The azimuth is more than a turn.
    #[error("the azimuth of the light is {}°, but it must be at least −360° and at most 360°", shortened(.0.to_string().as_str()))]
    Azimuth(f64),
    /// The model does not have the factor.
    #[error("{name} has no {what}")]
    NoFactor {
        /// The model.
        name: String,
        /// The factor.
        what: &'static str,
    },
    /// The measured points do not give this quantity.
    #[error("{name} was measured only at single directions, so it has no {what}")]
    NotMeasured {
        /// The paint.
        name: String,
        /// The quantity.
        what: &'static str,
    },
    /// The points were measured with the light elsewhere.
    #[error("{name} was measured with the light at {known}, not at {asked}°")]
    OtherLight {
        /// The paint.
        name: String,
        /// The angles.
        known: String,
        /// The requested angle.
        asked: f64,
    },
    /// The CPU cannot run the model.
    #[error("{name} cannot be run on the CPU: {why}")]
    NotOnCpu {
        /// The model.
        name: String,
        /// The reason.
        why: String,
    },
    /// The user cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

#[cfg(test)]
mod tests;
