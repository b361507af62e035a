use std::f32::consts::PI;

use glam::{Vec2, Vec3};

use super::{
    Declaration, Factor, Measured, Readout, ReflectionModel, built_in, rough_dielectric::refractive_index_of,
    thin_glass::SMOOTH,
};
use crate::{
    optics::{
        Frame, Terms, absorption,
        dispersion::{STRONGEST, cauchy_of_abbe},
        distribution::MINIMUM_ALPHA,
        fresnel::dielectric,
        geometry::mirror,
        interface::{Facets, Interface},
        interior::Interior,
        lobes::{Lobe, Lobes},
        sharp::{Sharp, Sharps},
    },
    parameter::{Parameter, REFRACTIVE_INDEX, TRANSMITTANCE_COLOUR, Value, meaning},
    parameters,
};

const COLOUR: Parameter = TRANSMITTANCE_COLOUR
    .help("The colour of white light after the distance below inside the body: white takes nothing away. Thick parts are darker and more saturated.");

const DISTANCE: Parameter = Parameter::number("distance", 0.001..=100.0, 1.0)
    .symbol("d")
    .unit("m")
    .label("distance of the colour")
    .help("The path length in the body after which white light has the transmittance colour. Short for strongly coloured glass.")
    .stands_for(&meaning::DEPTH_OF_TRANSMISSION);

const DISPERSION: Parameter = Parameter::number("dispersion", 0.0..=STRONGEST, 0.0)
    .symbol("1/V_d")
    .label("dispersion")
    .help("How much more blue light is bent than red: the reciprocal of the Abbe number. Crown glass has 0.016, diamond 0.018, flint glass 0.028; 0 disperses nothing.");

parameters! {
    /// **Glass** — a solid, clear body: a ball, a lens, a gem, a paperweight.
    ///
    /// ```text
    /// I = π F L(R) + π Σ over the ways out: (1 − ρ₀) a₁ ρ₁ a₂ ρ₂ … a_k (1 − ρ_k) L(d_k),   a_k = exp(−σ s_k)
    /// σ = −ln(C_t)/d,   n(λ) = n + B (1/λ² − 1/λ_d²),   B = (n − 1)/(V_d (1/λ_F² − 1/λ_C²))
    /// ```
    ///
    /// | parameter | symbol | unit | range | default |
    /// |---|---|---|---|---|
    /// | `refractive_index` | n | – | 1–3 | 1.5 |
    /// | `roughness` | r | – | 0–1 | 0 |
    /// | `transmittance_colour` | C_t | sRGB | 0–255; after the distance d | white |
    /// | `distance` | d | m | 0.001–100 | 1 |
    /// | `dispersion` | 1/V_d | – | 0–0.1 | 0 |
    ///
    /// Sources: W. Snell (about 1621) for the direction, A. Fresnel (1823) for the parts, A. Beer (1852) for absorption, A. L.
    /// Cauchy (1836) and E. Abbe (1886) for dispersion; rough: B. Walter, S. Marschner, H. Li, K. Torrance (2007),
    /// *Microfacet Models for Refraction through Rough Surfaces*.
    ///
    /// **The way of light** follows the object's own mesh: at each boundary a part leaves, and the rest is reflected inside,
    /// at most 16 times. It leaves into the lights with extent and the surroundings; other objects are not seen through the
    /// glass, and what has left does not come back. Light without extent shines through rough glass only,
    /// and a lamp inside the body is not seen: the path inside ends at the mesh.
    ///
    /// **The mesh must be closed**, with faces outwards. An open one is drawn as thin glass.
    ///
    /// **Smooth or rough**: α = r² below 0.001 counts as smooth.
    ///
    /// **Laws**: those of the outer boundary, which reflects; a smooth body that absorbs nothing is invisible in uniform
    /// light; facets of a rough one hide a part.
    pub struct Glass {
        /// `n`.
        refractive_index: number = REFRACTIVE_INDEX,
        /// `r`.
        roughness: number = SMOOTH,
        /// `C_t`, linear.
        transmittance_colour: colour = COLOUR,
        /// `d`.
        distance: number = DISTANCE,
        /// `1/V_d`.
        dispersion: number = DISPERSION,
    }
}

impl Glass {
    /// The roughness, if it is not smooth.
    fn alpha(&self) -> Option<f32> {
        let alpha = self.roughness * self.roughness;
        (alpha >= MINIMUM_ALPHA).then_some(alpha)
    }

    fn interface(&self, alpha: f32) -> Interface {
        Interface::new(Facets::Ggx, Vec2::splat(alpha), self.refractive_index)
    }
}

impl ReflectionModel for Glass {
    const DECLARATION: Declaration =
        built_in!("glass", "Glass", Transmission).ambient_by_albedo().transmitting().sharp().solid();

    const INTERIOR_ON_PAGES: Option<&'static str> = Some(include_str!("glass.js"));

    fn response(&self, l: Vec3, v: Vec3, frame: &Frame) -> Terms {
        let (l, v) = (frame.to_local(l), frame.to_local(v));
        let Some(alpha) = self.alpha().filter(|_| l.z > 0.0 && v.z > 0.0) else { return Terms::default() };
        Terms::of(Vec3::ZERO, Vec3::splat(PI * l.z * self.interface(alpha).reflected(l, v)))
    }

    fn sharp(&self, v: Vec3, frame: &Frame) -> Sharps {
        let cosine = frame.n.dot(v);
        if self.alpha().is_some() || cosine <= 0.0 {
            return Sharps::new();
        }
        let share = Vec3::splat(dielectric(self.refractive_index, cosine));
        Sharps::from_iter([Sharp::reflected(mirror(v, frame.n), share)])
    }

    fn spreads(&self) -> bool {
        self.alpha().is_some()
    }

    fn behind(&self, l: Vec3, v: Vec3, frame: &Frame) -> Vec3 {
        let within = |alpha| self.interface(alpha).transmitted(frame.to_local(l), frame.to_local(v));
        Vec3::splat(self.alpha().map_or(0.0, within))
    }

    fn interior(&self) -> Option<Interior> {
        let n = self.refractive_index;
        Some(Interior {
            ior: n,
            cauchy_b: if self.dispersion > 0.0 { cauchy_of_abbe(n, 1.0 / self.dispersion) } else { 0.0 },
            alpha: self.alpha().unwrap_or(0.0),
            absorption: absorption::coefficient(self.transmittance_colour, self.distance),
        })
    }

    fn lobes(&self) -> Lobes {
        let alpha = self.alpha().unwrap_or(MINIMUM_ALPHA);
        Lobes::new(&[(Lobe::ggx(alpha), 0.9), (Lobe::Cosine, 0.1)])
    }

    fn readouts(&self) -> Vec<Readout> {
        Readout::of_boundary(self.refractive_index)
    }

    fn factor(&self, factor: Factor) -> Option<Vec3> {
        factor.of_boundary(&self.interface(self.alpha().unwrap_or(MINIMUM_ALPHA)))
    }

    fn preset(material: &Measured) -> Vec<(&'static str, Value)> {
        refractive_index_of(material)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optics::{dispersion::abbe_of_cauchy, geometry::direction};

    #[test]
    fn the_inside_has_the_constants_of_the_parameters() {
        let flint = Glass { dispersion: 1.0 / 36.0, refractive_index: 1.62, ..Glass::default() };
        let inside = flint.interior().expect("solid");
        assert!((abbe_of_cauchy(inside.ior, inside.cauchy_b) - 36.0).abs() < 1e-3, "{inside:?}");
        let green =
            Glass { transmittance_colour: Vec3::new(0.25, 1.0, 0.5), distance: 0.5, ..Glass::default() };
        let left = green.interior().expect("solid").left(1.0);
        assert!((left - Vec3::new(0.0625, 1.0, 0.25)).length() < 1e-6, "{left}");
        assert_eq!(
            Glass::default().interior().map(|inside| (inside.cauchy_b, inside.alpha)),
            Some((0.0, 0.0))
        );
    }

    #[test]
    fn a_smooth_boundary_reflects_sharply_and_a_rough_one_spreads() {
        let v = direction(50.0, 10.0);
        let smooth = ReflectionModel::sharp(&Glass::default(), v, &Frame::LOCAL);
        assert_eq!(smooth.len(), 1);
        assert_eq!(smooth[0].share.x, dielectric(1.5, v.z));
        let frosted = Glass { roughness: 0.5, ..Glass::default() };
        assert!(ReflectionModel::sharp(&frosted, v, &Frame::LOCAL).is_empty());
        let mirrored = Vec3::new(-v.x, -v.y, v.z);
        assert!(ReflectionModel::response(&frosted, mirrored, v, &Frame::LOCAL).specular.x > 0.0);
        assert_eq!(ReflectionModel::response(&frosted, -v, v, &Frame::LOCAL), Terms::default());
    }
}
