use std::f32::consts::PI;

use glam::{Vec2, Vec3};

use super::{Declaration, Factor, Measured, Readout, ReflectionModel, built_in};
use crate::{
    optics::{
        Frame, Terms,
        fresnel::dielectric,
        interface::{Facets, Interface},
        lobes::{self, Lobe, Lobes},
        sharp::{Sharp, Sharps},
    },
    parameter::{ALPHA_X, ALPHA_Y, Parameter, REFRACTIVE_INDEX, Value},
    parameters,
};

const FACETS: Parameter =
    Parameter::choice("facets", &[("beckmann", "Beckmann"), ("ggx", "GGX")], 1)
        .symbol("D")
        .label("distribution of the facets")
        .help("The distribution of microfacet normals: the shape of the reflected and of the refracted lobe. Beckmann's falls off quickly; GGX has longer tails, as ground glass has.");

parameters! {
    /// **Rough dielectric** — a rough boundary between air and a clear body.
    ///
    /// ```text
    /// f_r = D(h) F(v·h) G(l, v) / (4 (n·l)(n·v))
    /// f_t = |v·m| |l·m| / (|n·l| (n·v)) · D(m) (1 − F(v·m)) G(l, v) / (v·m + n l·m)²
    /// m along −(v + n l),   G = 1/((1 + Λ(l))(1 + Λ(v)))
    /// ```
    ///
    /// | parameter | symbol | unit | range | default |
    /// |---|---|---|---|---|
    /// | `refractive_index` | n | – | 1–3 | 1.5 |
    /// | `facets` | D | – | `beckmann`, `ggx` | `ggx` |
    /// | `alpha_x`, `alpha_y` | α_x, α_y | – | 0.001–1 | 0.3 |
    ///
    /// Source: B. Walter, S. Marschner, H. Li, K. Torrance (2007), *Microfacet Models for Refraction through Rough
    /// Surfaces*, with the exact Fresnel equations. Mitsuba's `roughdielectric` is the same model; for Beckmann's distribution
    /// it approximates the masking, which is exact here.
    ///
    /// **Radiance** is scaled by 1/n² on its way out: a beam that leaves the denser medium widens. So this one boundary
    /// shows uniform light of the same radiance on both sides darker than it is, by R + (1 − R)/n². The light comes out of
    /// glass as bright as it went in only after a second boundary: see `glass`, and `thin_glass`.
    ///
    /// **Outside and inside**: the viewer is outside, n ≥ 1. Seen so, light from within arrives from at most the critical
    /// angle asin 1/n from the inner normal; beyond it, light within is reflected totally, which the viewer outside cannot
    /// see. Below n = 1.001 the boundary is invisible: light goes straight on, and that from points, and all reflected
    /// light, is zero.
    ///
    /// **When to use it**: to see refraction and Snell's law by themselves: where the transmitted lobe points, how wide it
    /// is (narrower than the reflected one), and how both share the light.
    ///
    /// **Laws**: all hold; reciprocity between the two sides in the form that radiance has there, f_t(l, v)/n_v² symmetric.
    /// Light that facets reflect or refract into each other is lost: at 60°, 1 % of it for α = 0.1 and a third for α = 1.
    pub struct RoughDielectric {
        /// `n`.
        refractive_index: number = REFRACTIVE_INDEX,
        /// `D`: index of the choice.
        facets: choice = FACETS,
        /// `α_x`.
        alpha_x: number = ALPHA_X,
        /// `α_y`.
        alpha_y: number = ALPHA_Y,
    }
}

impl RoughDielectric {
    fn interface(&self) -> Interface {
        let facets = if self.facets == 0 { Facets::Beckmann } else { Facets::Ggx };
        Interface::new(facets, Vec2::new(self.alpha_x, self.alpha_y), self.refractive_index)
    }
}

impl ReflectionModel for RoughDielectric {
    const DECLARATION: Declaration = built_in!("rough_dielectric", "Rough dielectric", Transmission)
        .ambient_by_albedo()
        .anisotropic()
        .transmitting()
        .boundary()
        .sharp();

    fn response(&self, l: Vec3, v: Vec3, frame: &Frame) -> Terms {
        let (l, v) = (frame.to_local(l), frame.to_local(v));
        if v.z <= 0.0 {
            return Terms::default();
        }
        let interface = self.interface();
        if l.z < 0.0 {
            return Terms::through(Vec3::splat(-PI * l.z * interface.transmitted(l, v)));
        }
        Terms::of(Vec3::ZERO, Vec3::splat(PI * l.z * interface.reflected(l, v)))
    }

    fn sharp(&self, v: Vec3, frame: &Frame) -> Sharps {
        if self.interface().is_invisible() && frame.n.dot(v) > 0.0 {
            return Sharps::from_iter([Sharp::transmitted(-v, Vec3::ONE)]);
        }
        Sharps::new()
    }

    fn lobes(&self) -> Lobes {
        let n = self.refractive_index;
        let alpha = Vec2::new(self.alpha_x, self.alpha_y);
        let reflected = dielectric(n, lobes::OBLIQUE);
        let below = Lobe::refracted(alpha, n);
        // The reflected lobe gets at least a quarter of the samples, since it grows at grazing angles.
        Lobes::new(&[(Lobe::wide(alpha), reflected.max(0.25)), (below, 1.0 - reflected), (Lobe::Cosine, 0.1)])
    }

    fn behind(&self, l: Vec3, v: Vec3, frame: &Frame) -> Vec3 {
        Vec3::splat(self.interface().transmitted(frame.to_local(l), frame.to_local(v)))
    }

    fn refractive_index(&self) -> Option<f32> {
        Some(self.refractive_index)
    }

    fn readouts(&self) -> Vec<Readout> {
        Readout::of_boundary(self.refractive_index)
    }

    fn factor(&self, factor: Factor) -> Option<Vec3> {
        factor.of_boundary(&self.interface())
    }

    fn preset(material: &Measured) -> Vec<(&'static str, Value)> {
        refractive_index_of(material)
    }
}

/// The refractive index of a clear material in green light, as the value of [`REFRACTIVE_INDEX`]; nothing for metals,
/// through which no light passes.
pub(super) fn refractive_index_of(material: &Measured) -> Vec<(&'static str, Value)> {
    if material.metal {
        return Vec::new();
    }
    let index = (material.n[1] * 1e4).round() / 1e4;
    vec![(REFRACTIVE_INDEX.name, Value::Number(index.clamp(1.0, 3.0)))]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        optics::geometry::direction,
        reflection::{Surface, preset},
    };

    fn of(n: f32, alpha: f32) -> RoughDielectric {
        RoughDielectric { refractive_index: n, alpha_x: alpha, alpha_y: alpha, ..RoughDielectric::default() }
    }

    #[test]
    fn a_smooth_boundary_shows_uniform_light_by_fresnels_shares() {
        for n in [1.33f32, 1.5, 2.4] {
            for theta in [0.0, 40.0, 70.0] {
                let v = direction(theta, 30.0);
                let share = dielectric(n, v.z);
                let expected = share + (1.0 - share) / (n * n);
                let found = Surface::ambient_response(&of(n, 0.01), v, &Frame::LOCAL).x;
                assert!((found - expected).abs() < 5e-3, "{n} {theta}°: {found} {expected}");
                // Flux instead of radiance would be all of it.
                assert!((found - 1.0).abs() > 0.2);
            }
        }
    }

    #[test]
    fn an_invisible_boundary_lets_light_go_straight_on() {
        for n in [1.0, 1.000_5] {
            let surface = of(n, 0.3);
            let v = direction(50.0, 20.0);
            let sharps = ReflectionModel::sharp(&surface, v, &Frame::LOCAL);
            assert_eq!(sharps.as_slice(), [Sharp::transmitted(-v, Vec3::ONE)]);
            assert_eq!(ReflectionModel::response(&surface, -v, v, &Frame::LOCAL), Terms::default());
            assert_eq!(Surface::ambient_response(&surface, v, &Frame::LOCAL), Vec3::ONE);
        }
        assert!(ReflectionModel::sharp(&of(1.5, 0.3), Vec3::Z, &Frame::LOCAL).is_empty());
    }

    #[test]
    fn clear_materials_have_their_index_and_metals_none() {
        for material in preset::all() {
            let values = refractive_index_of(material);
            assert_eq!(values.is_empty(), material.metal, "{}", material.id);
            assert!(values.iter().all(|(_, value)| REFRACTIVE_INDEX.allows(value)), "{}", material.id);
        }
    }
}
