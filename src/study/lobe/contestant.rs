//! The models in the comparison of lobes, and their fits.

use crate::{
    curves::draw::{Line, Mark},
    optics::{Frame, colour::Encoding, equivalence},
    registry::Registry,
    study::{
        Lab, StudyError, alpha,
        fit::{self, Fit, Sample},
        set,
    },
};

/// Range of widths tried.
const WIDTHS: (f64, f64) = (0.002, 1.0);

/// A model in the comparison: its specular lobe with variable width.
pub(in crate::study) struct Contestant {
    pub(in crate::study) name: &'static str,
    id: &'static str,
    pub(super) settings: String,
    /// Alternative settings, used if they fit better.
    pub(super) instead: Option<String>,
    width: fn(f64) -> String,
    /// Colour, line and mark in plots.
    pub(super) style: (usize, Line, Mark),
}

fn exponent(width: f64) -> String {
    format!("alpha={}", equivalence::exponent_of_alpha(width as f32).round())
}

/// Phong's exponent: a quarter of Blinn's has about the same lobe (F. Fisher, A. Woo 1994).
fn mirror_exponent(width: f64) -> String {
    format!("alpha={}", (0.25 * equivalence::exponent_of_alpha(width as f32)).round().max(1.0))
}

impl Contestant {
    fn microfacet(name: &'static str, d: &'static str, g: &'static str, style: (usize, Line, Mark)) -> Self {
        let settings = |f| format!("distribution={d} masking={g} fresnel={f} diffuse=none ior=1.5");
        let (settings, instead) = (settings("dielectric"), Some(settings("none")));
        Self { name, id: "microfacet", settings, instead, width: alpha, style }
    }

    fn simple(
        name: &'static str,
        id: &'static str,
        width: fn(f64) -> String,
        style: (usize, Line, Mark),
    ) -> Self {
        Self { name, id, settings: "k_s=1".to_owned(), instead: None, width, style }
    }

    /// The four models, behind Phong's, whose lobe is about the mirror direction.
    pub(in crate::study) fn with_phong() -> Vec<Self> {
        let phong = Self::simple("Phong", "phong", mirror_exponent, (3, Line::Dashed, Mark::Disc));
        [phong].into_iter().chain(Self::all()).collect()
    }

    /// The four models of the comparison.
    pub(in crate::study) fn all() -> Vec<Self> {
        vec![
            Self::simple("Blinn–Phong", "blinn_phong", exponent, (1, Line::Dashed, Mark::Triangle)),
            Self::simple("Ward", "ward", alpha, (4, Line::Dotted, Mark::Square)),
            Self::microfacet("Cook–Torrance", "beckmann", "v_cavity", (2, Line::Dashed, Mark::Cross)),
            Self::microfacet("GGX", "ggx", "smith_height_correlated", (0, Line::Solid, Mark::Disc)),
        ]
    }

    /// Microfacet models that differ only in the distribution.
    pub(super) fn distributions() -> Vec<Self> {
        let smith = "smith_height_correlated";
        vec![
            Self::microfacet("Blinn’s distribution", "blinn_phong", smith, (1, Line::Solid, Mark::None)),
            Self::microfacet("Beckmann’s distribution", "beckmann", smith, (2, Line::Solid, Mark::None)),
            Self::microfacet("GGX distribution", "ggx", smith, (0, Line::Solid, Mark::None)),
        ]
    }

    /// Refuses settings that the model does not have.
    pub(in crate::study) fn check(&self, lab: &Lab) -> Result<(), StudyError> {
        for settings in [&self.settings].into_iter().chain(&self.instead) {
            set(lab.registry, self.id, &format!("{settings} {}", (self.width)(0.1)))?;
        }
        Ok(())
    }

    /// The specular lobe as a BRDF at every sample.
    fn lobe(&self, registry: &Registry, settings: &str, width: f64, samples: &[Sample]) -> Vec<f64> {
        let set = set(registry, self.id, &format!("{settings} {}", (self.width)(width)));
        let Ok((model, values)) = set else { return vec![0.0; samples.len()] };
        let surface = model.instantiate(&values, Encoding::Srgb);
        let f = |s: &Sample| {
            let specular = surface.response(s.l, s.v, &Frame::LOCAL).specular.y;
            f64::from(specular) / (std::f64::consts::PI * f64::from(s.l.z))
        };
        samples.iter().map(f).collect()
    }

    /// The lobe with a width at every sample, with each of the settings.
    pub(in crate::study) fn lobes(
        &self,
        registry: &Registry,
        width: f64,
        samples: &[Sample],
    ) -> Vec<Vec<f64>> {
        let settings = [&self.settings].into_iter().chain(&self.instead);
        settings.map(|settings| self.lobe(registry, settings, width, samples)).collect()
    }

    /// The best fit, with the Fresnel term of a dielectric.
    pub(in crate::study) fn fit(&self, registry: &Registry, samples: &[Sample]) -> Fit {
        fit::fit(samples, WIDTHS, |width, samples| self.lobe(registry, &self.settings, width, samples))
    }

    /// The best fit and its settings; with the better Fresnel term for models that offer the choice.
    pub(super) fn fit_freely(&self, registry: &Registry, samples: &[Sample]) -> Found {
        let first = self.fit(registry, samples);
        let bound = first.error;
        let found = |fit, settings: &str| Found { fit, settings: settings.to_owned(), bound };
        let Some(instead) = &self.instead else { return found(first, &self.settings) };
        let second = fit::fit(samples, WIDTHS, |width, samples| self.lobe(registry, instead, width, samples));
        if second.error < bound { found(second, instead) } else { found(first, &self.settings) }
    }

    /// The values of a fit at other samples.
    pub(super) fn predict(
        &self,
        registry: &Registry,
        settings: &str,
        fit: &Fit,
        samples: &[Sample],
    ) -> Vec<f64> {
        let lobe = self.lobe(registry, settings, fit.width, samples);
        lobe.iter().map(|q| fit.diffuse / std::f64::consts::PI + fit.specular * q).collect()
    }

    /// The error of a fit at other samples.
    pub(in crate::study) fn error(&self, registry: &Registry, fit: &Fit, samples: &[Sample]) -> f64 {
        let values: Vec<f64> = samples.iter().map(|s| s.value).collect();
        fit::error(fit, &values, &self.lobe(registry, &self.settings, fit.width, samples))
    }
}

/// The fit of a contestant to a material.
pub(super) struct Found {
    pub(super) fit: Fit,
    /// The chosen settings.
    pub(super) settings: String,
    /// The error without the choice of the Fresnel term.
    pub(super) bound: f64,
}
