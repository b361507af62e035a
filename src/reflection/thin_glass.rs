use std::f32::consts::PI;

use glam::{Vec2, Vec3};

use super::{
    Declaration, Factor, Measured, Readout, ReadoutValue, ReflectionModel, built_in,
    rough_dielectric::refractive_index_of,
};
use crate::{
    optics::{
        Frame, Terms,
        albedo::LobeAlbedo,
        distribution::{MINIMUM_ALPHA, ggx},
        fresnel::dielectric,
        geometry::{half_vector, mirror},
        lobes::{self, Lobe, Lobes},
        masking::{height_correlated, smith_ggx},
        refraction::refracted_cosine,
        sharp::{Sharp, Sharps},
        slab::{Slab, oblique, slab},
    },
    parameter::{Parameter, REFRACTIVE_INDEX, ROUGHNESS, TRANSMITTANCE_COLOUR, Value},
    parameters,
};

/// A roughness that may be 0.
pub(super) const SMOOTH: Parameter = Parameter { kind: Parameter::number("", 0.0..=1.0, 0.0).kind, ..ROUGHNESS }
    .help("From 0, clear glass, to 1, fully frosted, in perceptually even steps. The width of the distribution of microfacet slopes is its square, α = r². Below 0.032 the surface is smooth: the view through it is sharp, and lights without extent leave no highlight.");

/// The cosine at which light that meets several facets is reflected and transmitted: the mean over evenly arriving light,
/// ∫ μ² dμ/∫ μ dμ.
const SCATTERED: f32 = 2.0 / 3.0;

/// The least light of several bounces that is divided by: less is lost, and known too imprecisely.
const LEAST: f32 = 2e-3;

parameters! {
    /// **Thin glass** — a pane whose two faces are too close together to see between.
    ///
    /// ```text
    /// ρ = F + F a τ,   τ = (1 − F)² a/(1 − F² a²),   a = C_t^(1/cos θ_t)
    /// smooth: ρ(N·V) of the radiance from the mirror direction, τ(N·V) of that from straight behind
    /// rough:  f_r = D G ρ(v·h) / (4 (n·l)(n·v)) + f_ms ρ(2/3)
    ///         f_t = the same with τ, and l mirrored to the side of v
    ///         f_ms = (1 − E(l)) (1 − E(v)) / (π (1 − E_avg))
    /// ```
    ///
    /// | parameter | symbol | unit | range | default |
    /// |---|---|---|---|---|
    /// | `refractive_index` | n | – | 1–3 | 1.5 |
    /// | `roughness` | r | – | 0–1 | 0 |
    /// | `transmittance_colour` | C_t | sRGB | 0–255; after one crossing along the normal | white |
    ///
    /// Sources: G. G. Stokes (1862), *On the Intensity of the Light Reflected from or Transmitted through a Pile of Plates*:
    /// all orders of reflection between the faces add up to these closed forms; without absorption `ρ = 2F/(1 + F)` and `τ
    /// = (1 − F)/(1 + F)`. C. Kulla, A. Conty (2017), *Revisiting Physically Based Shading at Imageworks*: rough glass
    /// transmits the lobe that it reflects, mirrored in the surface, and light of several bounces between facets is given
    /// back. Absorption by P. Bouguer (1729) and A. Beer (1852): tinted glass is darker where it is seen obliquely. With
    /// only one pane, thickness and colour are one number; F is the exact Fresnel reflectance of one face.
    ///
    /// A real frosted pane bends light at each face, so its transmitted lobe is wider or narrower than the reflected one as
    /// n and the finish of the faces have it; here both are equal. Light that meets several facets is divided as at the mean
    /// cosine, 2/3.
    ///
    /// **Smooth or rough**: α = r² below 0.001 counts as smooth. Then the two directions are sharp: the picture shows lights
    /// with extent and the surroundings in them, and lights without extent leave no highlight. Several panes behind each
    /// other are not seen through each other: each shows the surroundings.
    ///
    /// **When to use it**: windows, drinking glasses from afar, bubbles, bottles with thin walls. For a lens, a gem or a
    /// paperweight, in which light is bent, use `glass`.
    ///
    /// **Laws**: all hold. Without absorption, `ρ + τ = 1`: the sum over the sphere is 1 for a smooth pane, and to
    /// 1 % for a rough one.
    pub struct ThinGlass {
        /// `n`.
        refractive_index: number = REFRACTIVE_INDEX,
        /// `r`.
        roughness: number = SMOOTH,
        /// `C_t`, linear.
        transmittance_colour: colour = TRANSMITTANCE_COLOUR,
    }
    derived {
        /// Albedo of the lobe with F = 1.
        lobe: LobeAlbedo = Self::lobe_of,
    }
}

impl ThinGlass {
    /// The roughness, if it is not smooth.
    fn alpha(&self) -> Option<f32> {
        let alpha = self.roughness * self.roughness;
        (alpha >= MINIMUM_ALPHA).then_some(alpha)
    }

    /// The reflection and transmission of the pane at an angle of incidence.
    fn pane(&self, cosine: f32) -> Slab {
        let n = self.refractive_index;
        let left = oblique(self.transmittance_colour, refracted_cosine(cosine, n));
        slab(Vec3::splat(dielectric(n, cosine)), left)
    }

    fn lobe_of(&self) -> LobeAlbedo {
        let Some(alpha) = self.alpha() else { return LobeAlbedo::default() };
        LobeAlbedo::new(|l, v| {
            if l.z <= 0.0 || v.z <= 0.0 { 0.0 } else { PI * l.z * facets(l, v, Vec2::splat(alpha)) }
        })
    }

    /// The light of several bounces between facets, `π f_ms cos θ_l`, before it is divided between the sides.
    fn bounced(&self, l: Vec3, v: Vec3) -> f32 {
        let lost = self.lobe.loss(l.z) * self.lobe.loss(v.z);
        lost / (1.0 - self.lobe.average()).max(LEAST) * l.z
    }
}

/// `D G / (4 (N·L)(N·V))` in the local frame.
fn facets(l: Vec3, v: Vec3, alpha: Vec2) -> f32 {
    ggx(half_vector(l, v), alpha) * height_correlated(l.z, v.z, smith_ggx(l, alpha), smith_ggx(v, alpha))
}

impl ReflectionModel for ThinGlass {
    const DECLARATION: Declaration =
        built_in!("thin_glass", "Thin glass", Transmission).ambient_by_albedo().transmitting().sharp();

    fn response(&self, l: Vec3, v: Vec3, frame: &Frame) -> Terms {
        let (l, v) = (frame.to_local(l), frame.to_local(v));
        let Some(alpha) = self.alpha().filter(|_| v.z > 0.0 && l.z != 0.0) else { return Terms::default() };
        let near = l.with_z(l.z.abs());
        let cos_d = half_vector(near, v).dot(v);
        let single = PI * near.z * facets(near, v, Vec2::splat(alpha));
        let [once, often] = [self.pane(cos_d), self.pane(SCATTERED)];
        let bounced = self.bounced(near, v);
        if l.z < 0.0 {
            return Terms::through(single * once.transmittance + bounced * often.transmittance);
        }
        Terms::of(Vec3::ZERO, single * once.reflectance + bounced * often.reflectance)
    }

    fn sharp(&self, v: Vec3, frame: &Frame) -> Sharps {
        let cosine = frame.n.dot(v);
        if self.alpha().is_some() || cosine <= 0.0 {
            return Sharps::new();
        }
        let Slab { reflectance, transmittance } = self.pane(cosine);
        Sharps::from([
            Sharp::reflected(mirror(v, frame.n), reflectance),
            Sharp::transmitted(-v, transmittance),
        ])
    }

    fn spreads(&self) -> bool {
        self.alpha().is_some()
    }

    fn lobes(&self) -> Lobes {
        let alpha = self.alpha().unwrap_or(MINIMUM_ALPHA);
        let pane = self.pane(lobes::OBLIQUE);
        let [reflected, transmitted] =
            [pane.reflectance, pane.transmittance].map(|share| (share.element_sum() / 3.0).max(0.25));
        // Light of several bounces leaves in all directions.
        let bounced = (1.0 - self.lobe.average()).clamp(0.05, 1.0);
        let below = Lobe::refracted(Vec2::splat(alpha), 1.0);
        Lobes::new(&[(Lobe::ggx(alpha), reflected), (below, transmitted), (Lobe::Cosine, bounced)])
    }

    const LOBE: bool = true;

    fn lobe(&self) -> Option<LobeAlbedo> {
        Some(self.lobe)
    }

    fn refractive_index(&self) -> Option<f32> {
        Some(self.refractive_index)
    }

    fn readouts(&self) -> Vec<Readout> {
        let Slab { reflectance, transmittance } = self.pane(1.0);
        vec![
            Readout {
                symbol: "ρ_0",
                label: "reflectance at normal incidence",
                help: "The fraction of light that both faces together reflect at normal incidence, in red, green and blue.",
                value: ReadoutValue::Reflectance(reflectance),
            },
            Readout {
                symbol: "τ_0",
                label: "transmittance at normal incidence",
                help: "The fraction of light that passes through the pane at normal incidence, in red, green and blue.",
                value: ReadoutValue::Reflectance(transmittance),
            },
        ]
    }

    fn factor(&self, factor: Factor) -> Option<Vec3> {
        let alpha = Vec2::splat(self.alpha().unwrap_or(MINIMUM_ALPHA));
        factor.by(
            |cos_d| self.pane(cos_d).reflectance,
            |h| ggx(h, alpha),
            |l, v| height_correlated(l.z, v.z, smith_ggx(l, alpha), smith_ggx(v, alpha)),
        )
    }

    fn quantity(&self, symbol: &str, arguments: &[f32]) -> Option<Vec3> {
        match (symbol, arguments) {
            ("E", [mu]) => Some(Vec3::splat(self.lobe.at(*mu))),
            ("E_m", []) => Some(Vec3::splat(self.lobe.average())),
            _ => None,
        }
    }

    fn preset(material: &Measured) -> Vec<(&'static str, Value)> {
        refractive_index_of(material)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{optics::geometry::direction, parameter::ParameterSet as _, parameter::Values};

    fn glass(roughness: f32, tint: [u8; 3]) -> ThinGlass {
        let mut values = Values::default();
        values.set("roughness", Value::Number(roughness));
        values.set("transmittance_colour", Value::Colour(tint));
        ThinGlass::from_values(&values, crate::optics::colour::Encoding::Srgb)
    }

    fn albedo(glass: &ThinGlass, theta: f64) -> Vec3 {
        crate::reflection::Surface::ambient_response(glass, direction(theta, 20.0), &Frame::LOCAL)
    }

    #[test]
    fn clear_glass_loses_no_light_smooth_or_rough() {
        for (roughness, tolerance) in
            [(0.0, 1e-6), (0.1, 0.01), (0.2, 0.01), (0.3, 4e-3), (0.6, 4e-3), (1.0, 4e-3)]
        {
            let clear = glass(roughness, [255; 3]);
            for theta in [0.0, 45.0, 70.0, 85.0] {
                let found = albedo(&clear, theta);
                assert!((found - 1.0).abs().max_element() < tolerance, "{roughness} {theta}°: {found}");
            }
            // Tinted glass takes some of each colour that it has not.
            let tinted = albedo(&glass(roughness, [255, 188, 0]), 45.0);
            assert!((tinted.x - 1.0).abs() < tolerance.max(1e-5), "{roughness}: {tinted}");
            assert!(tinted.y < 0.7 && tinted.z < 0.3 && tinted.z > 0.03, "{roughness}: {tinted}");
        }
    }

    #[test]
    fn a_smooth_pane_has_stokes_sums_in_two_directions() {
        let pane = glass(0.0, [255; 3]);
        let v = direction(60.0, 40.0);
        let sharps = ReflectionModel::sharp(&pane, v, &Frame::LOCAL);
        let r = 0.089_187;
        let [back, through] = [sharps[0], sharps[1]];
        assert!((back.share.x - 2.0 * r / (1.0 + r)).abs() < 1e-5 && !back.transmitted);
        assert!((through.share.x - (1.0 - r) / (1.0 + r)).abs() < 1e-5 && through.transmitted);
        assert!((back.l - Vec3::new(-v.x, -v.y, v.z)).length() < 1e-6 && through.l == -v);
        assert_eq!(ReflectionModel::response(&pane, -v, v, &Frame::LOCAL), Terms::default());
        assert!(ReflectionModel::sharp(&pane, -v, &Frame::LOCAL).is_empty());
        assert!(ReflectionModel::sharp(&glass(0.3, [255; 3]), v, &Frame::LOCAL).is_empty());
    }

    #[test]
    fn rough_glass_transmits_the_mirrored_lobe() {
        let frosted = glass(0.5, [255; 3]);
        let v = direction(30.0, 0.0);
        let at = |l: Vec3| ReflectionModel::response(&frosted, l, v, &Frame::LOCAL);
        for (theta, phi) in [(30.0, 180.0), (10.0, 60.0), (70.0, 200.0)] {
            let l = direction(theta, phi);
            let (front, behind) = (at(l), at(l.with_z(-l.z)));
            assert!(front.transmitted == Vec3::ZERO && behind.specular == Vec3::ZERO);
            // Together both are the lobe without a Fresnel term.
            let alpha = Vec2::splat(0.25);
            let whole = PI * l.z * facets(l, v, alpha) + frosted.bounced(l, v);
            assert!((front.specular.x + behind.transmitted.x - whole).abs() < 1e-5 * whole, "{theta}");
            assert!(behind.transmitted.x > 3.0 * front.specular.x, "{theta}");
        }
        // Brightest about straight behind.
        assert!(at(-v).transmitted.x > at(direction(120.0, 0.0)).transmitted.x);
    }
}
