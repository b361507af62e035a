use glam::Vec3;

use super::{Declaration, ReflectionModel, built_in};
use crate::{
    optics::{Frame, Terms, diffuse::eon},
    parameter::{BASE_COLOUR, Parameter, ROUGHNESS, meaning},
    parameters,
};

parameters! {
    /// **EON** — energy-preserving Oren–Nayar: rough and matte, without losing light.
    ///
    /// ```text
    /// f_r = C_b/π A (1 + r s/t) + ρ_m/π (1 − E(L)) (1 − E(V)) / (1 − ⟨E⟩)
    /// s = L·V − N·L N·V,  t = max(N·L, N·V) where s > 0, else 1
    /// A = 1 / (1 + (1/2 − 2/(3π)) r),  ⟨E⟩ = A (1 + (2/3 − 28/(15π)) r)
    /// E(μ) = A (1 + r/π (sin θ (θ − sin θ cos θ) + 2/3 (tan θ (1 − sin³ θ) − sin θ))),  μ = cos θ
    /// ρ_m = C_b² ⟨E⟩ / (1 − C_b (1 − ⟨E⟩))
    /// ```
    ///
    /// | parameter | symbol | unit | range | default |
    /// |---|---|---|---|---|
    /// | `base_colour` | C_b | sRGB | 0–255 | white |
    /// | `roughness` | r | – | 0–1 | 0.5 |
    ///
    /// Source: J. Portsmouth, P. Kutz, S. Hill (2024), *EON: A Practical Energy-Preserving Rough Diffuse BRDF*, arXiv
    /// 2410.18026; Journal of Computer Graphics Techniques 14(1), 2025. The first term is Y. Fujii's variant of
    /// Oren–Nayar, whose albedo E has a closed form; the second restores the lost light, coloured again by each further
    /// reflection, so rough surfaces are not darker but more saturated. It uses the exact E, not the authors'
    /// polynomial.
    ///
    /// Use it instead of Oren–Nayar. At r = 0 it is Lambert. It keeps all three laws; a white surface reflects exactly
    /// the incident light (E = 1), whatever its roughness.
    pub struct Eon {
        /// `C_b`, linear.
        base_colour: colour = BASE_COLOUR,
        /// `r`.
        roughness: number = Parameter {
            help: "From 0, matte and smooth as in Lambert's law, to 1, matte and very rough: flatter shading, darker on the side facing away from the light.",
            stands_for: Some(&meaning::BODY_ROUGHNESS),
            ..ROUGHNESS
        },
    }
}

impl ReflectionModel for Eon {
    const DECLARATION: Declaration = built_in!("eon", "EON", Diffuse).matte().ambient_by_albedo();

    fn response(&self, l: Vec3, v: Vec3, frame: &Frame) -> Terms {
        let Some((cos_l, cos_v)) = frame.cosines(l, v) else { return Terms::default() };
        let factor = eon(cos_l, cos_v, l.dot(v), self.roughness, self.base_colour);
        Terms { diffuse: cos_l * factor * self.base_colour, ..Terms::default() }
    }
}
