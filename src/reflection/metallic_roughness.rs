use std::f32::consts::PI;

use glam::{Vec2, Vec3};

use super::{Declaration, Factor, Measured, Readout, ReflectionModel, built_in, preset};
use crate::{
    optics::{
        Frame, Terms,
        distribution::{MINIMUM_ALPHA, ggx},
        fresnel::schlick,
        geometry::half_vector,
        lobes::{self, Lobe, Lobes},
        masking::{height_correlated, smith_ggx},
    },
    parameter::{BASE_COLOUR, METALLIC, REFLECTANCE, ROUGHNESS, Value},
    parameters,
};

parameters! {
    /// **Metallic–roughness** — the material of today's engines and of glTF 2.0: GGX, height-correlated Smith masking,
    /// Schlick's Fresnel term, and four intuitive parameters.
    ///
    /// ```text
    /// f_r = (1 − F)(1 − m) C_b/π + D F G / (4 (N·L)(N·V))
    /// D = α² / (π (α² cos² θ_h + sin² θ_h)²),   α = r²
    /// G = 1 / (1 + Λ(L) + Λ(V)),   Λ(X) = (√(1 + α² tan² θ_X) − 1)/2
    /// F = F_0 + (1 − F_0)(1 − V·H)⁵,   F_0 = (1 − m) 0.16 s² + m C_b
    /// ```
    ///
    /// | parameter | symbol | unit | range | default |
    /// |---|---|---|---|---|
    /// | `base_colour` | C_b | sRGB | 0–255 | white |
    /// | `metallic` | m | – | 0–1 | 0 |
    /// | `roughness` | r | – | 0–1 | 0.5 |
    /// | `reflectance` | s | – | 0–1 | 0.5 |
    ///
    /// Sources: B. Karis (2013), *Real Shading in Unreal Engine 4*, SIGGRAPH course; S. Lagarde, C. de
    /// Rousiers (2014), *Moving Frostbite to Physically Based Rendering*, SIGGRAPH course (0.16 s²); Khronos
    /// Group (2021), *glTF 2.0 Specification*, appendix B; R. Guy, M. Agopian (2018), *Physically Based
    /// Rendering in Filament*. α is at least 0.001, below which a lobe is narrower than the rounding of H.
    ///
    /// **The diffuse part** is glTF's: Lambert's, times 1 − F at the facet that mirrors L to V. Filament and Unreal
    /// omit that factor, which is cheaper but gains still more light; it is kept here because glTF is the published
    /// standard and because a body under a mirror must darken. F is calculated per channel; the specification's is
    /// white for non-metals, where the two agree.
    ///
    /// **When to use it**: first, for anything: most programs exchange it, and measured metals need only their colour
    /// at normal incidence. Where that colour is not enough (the dip of gold before grazing angles, n and k), use
    /// `cook_torrance` or `microfacet`.
    ///
    /// **Laws**: reciprocal and non-negative. Energy is not conserved: F of one facet stands for the whole reflection
    /// of the rough surface, so a smooth white dielectric seen at a grazing angle reflects up to twice the light.
    /// Metals do conserve it, and lose the light of multiple reflections.
    pub struct MetallicRoughness {
        /// `C_b`, linear.
        base_colour: colour = BASE_COLOUR,
        /// `m`.
        metallic: number = METALLIC,
        /// `r`.
        roughness: number = ROUGHNESS,
        /// `s`.
        reflectance: number = REFLECTANCE,
    }
}

impl MetallicRoughness {
    fn alpha(&self) -> f32 {
        (self.roughness * self.roughness).max(MINIMUM_ALPHA)
    }

    fn f0(&self) -> Vec3 {
        let dielectric = 0.16 * self.reflectance * self.reflectance;
        Vec3::splat(dielectric).lerp(self.base_colour, self.metallic)
    }
}

impl ReflectionModel for MetallicRoughness {
    const DECLARATION: Declaration =
        built_in!("metallic_roughness", "Metallic–roughness", Standard).ambient_by_albedo();

    fn response(&self, l: Vec3, v: Vec3, frame: &Frame) -> Terms {
        let (cos_l, cos_v) = (frame.n.dot(l), frame.n.dot(v));
        // Below the surface, or at such a grazing angle that the quotients would leave the range of f32.
        if cos_l.min(cos_v) < 1e-9 {
            return Terms::default();
        }
        // Only angles to the normal matter, so each vector is in a frame with x along its tangential part.
        // The half vector comes from the cross product, since 1 − (N·H)² would cancel where the lobe is
        // narrow.
        let leaning = |cosine: f32| Vec3::new((1.0 - cosine * cosine).max(0.0).sqrt(), 0.0, cosine);
        let h = half_vector(l, v);
        let cos_d = 0.5 * (l + v).length();
        let alpha = Vec2::splat(self.alpha());
        let d = ggx(Vec3::new(frame.n.cross(h).length(), 0.0, frame.n.dot(h)), alpha);
        let (lambda_l, lambda_v) = (smith_ggx(leaning(cos_l), alpha), smith_ggx(leaning(cos_v), alpha));
        let visibility = height_correlated(cos_l, cos_v, lambda_l, lambda_v);
        let f = schlick(self.f0(), cos_d);
        let diffuse = (Vec3::ONE - f) * ((1.0 - self.metallic) * cos_l) * self.base_colour;
        let specular = PI * d * (visibility * cos_l) * f;
        Terms::of(diffuse, specular)
    }

    fn lobes(&self) -> Lobes {
        let reflected = schlick(self.f0(), lobes::OBLIQUE);
        Lobes::diffuse_and(Lobe::ggx(self.alpha()), (1.0 - self.metallic) * self.base_colour, reflected)
    }

    fn readouts(&self) -> Vec<Readout> {
        vec![Readout::of_f0(self.f0()), Readout::of_alpha(self.alpha())]
    }

    fn factor(&self, factor: Factor) -> Option<Vec3> {
        let alpha = Vec2::splat(self.alpha());
        factor.by(
            |cos_d| schlick(self.f0(), cos_d),
            |h| ggx(h, alpha),
            |l, v| height_correlated(l.z, v.z, smith_ggx(l, alpha), smith_ggx(v, alpha)),
        )
    }

    fn preset(material: &Measured) -> Vec<(&'static str, Value)> {
        preset::base_colour_metallic(material)
    }
}
