//! The metric of a fit: what the difference of two lobes is taken of.

use std::f64::consts::PI;

use super::What;
use crate::declared::ids;

ids! {
    /// The metric by which lobes are compared.
    #[derive(Default)]
    Metric(
        /// One sentence about the metric.
        summary,
        /// Its publication.
        source,
        /// Meaning of the error, with its unit.
        unit
    ) {
        /// f cos θ.
        #[default]
        Cosine = "cosine"
            "The difference of π f cos θ: bright highlights decide."
            "A. Ngan, F. Durand, W. Matusik (2005), *Experimental Analysis of BRDF Models*"
            "RMS difference of the reflected light; 1 is a white matte surface lit head-on",
        /// ln(1 + f cos θ).
        Log = "log"
            "The difference of ln(1 + f cos θ): tails count beside bright highlights."
            "J. Löw, J. Kronander, A. Ynnerman, J. Unger (2012), *BRDF Models for Accurate and Efficient Rendering of Glossy Surfaces*"
            "RMS difference of ln(1 + f cos θ), f in sr⁻¹",
        /// ∛(f cos θ).
        CubeRoot = "cube-root"
            "The difference of ∛(f cos θ): about equal steps of lightness."
            "A. Fores, J. Ferwerda, J. Gu (2012), *Toward a Perceptually Based Metric for BRDF Modeling*"
            "RMS difference of ∛(f cos θ), f in sr⁻¹",
    }
}

impl Metric {
    /// The number whose difference counts, from the reflected light π f cos θ.
    #[must_use]
    pub fn of(self, reflected: f64) -> f64 {
        match self {
            Self::Cosine => reflected,
            Self::Log => (reflected / PI).max(0.0).ln_1p(),
            Self::CubeRoot => (reflected / PI).max(0.0).cbrt(),
        }
    }
}

/// A quantity with the metric of its differences.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Measure {
    /// The quantity.
    pub what: What,
    /// The metric of lobes; pictures and highlights have their own.
    pub metric: Metric,
}

impl From<What> for Measure {
    fn from(what: What) -> Self {
        Self { what, ..Self::default() }
    }
}

impl Measure {
    /// Meaning of the error, with its unit.
    #[must_use]
    pub fn unit(self) -> &'static str {
        self.metric().map_or_else(|| self.what.unit(), Metric::unit)
    }

    /// The metric, where it counts.
    #[must_use]
    pub fn metric(self) -> Option<Metric> {
        Some(self.metric).filter(|_| self.what == What::Lobe)
    }
}

impl std::fmt::Display for Measure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.what.id())?;
        self.metric().map_or(Ok(()), |metric| write!(f, " ({})", metric.id()))
    }
}
