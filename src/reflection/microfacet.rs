use std::f32::consts::{PI, SQRT_2};

use glam::{Vec2, Vec3};

use super::{Declaration, Factor, Measured, Readout, ReflectionModel, built_in, preset};
use crate::{
    optics::{
        Frame, Terms,
        albedo::LobeAlbedo,
        diffuse, distribution,
        fresnel::{conductor_rgb, dielectric_rgb, normal_reflectance_rgb, schlick},
        geometry::half_vector,
        lobes::{self, Lobe, Lobes},
        masking,
    },
    parameter::{ALPHA_X, ALPHA_Y, BASE_COLOUR, EXTINCTION, IOR, Parameter, Value},
    parameters,
};

const DISTRIBUTION: Parameter = Parameter::choice(
    "distribution",
    &[("blinn_phong", "Blinn–Phong"), ("beckmann", "Beckmann"), ("ggx", "GGX"), ("gtr", "GTR")],
    2,
)
.symbol("D")
.help("The distribution of microfacet normals: the shape of the highlight. With t = tan θ / α and c = cos θ, θ being the angle between N and H: Blinn–Phong D = (n + 2)/(2π) cⁿ, n = 2/α² − 2; Beckmann D = exp(−t²)/(π α² c⁴); GGX D = 1/(π α² c⁴ (1 + t²)²), with longer tails; GTR has γ in place of the 2 and chooses its tails.");

const GAMMA: Parameter = Parameter::number("gamma", 1.0..=10.0, 2.0)
    .symbol("γ")
    .label("exponent of GTR")
    .help("The falloff of the tails of the GTR distribution: 2 is GGX, 1 is Berry's distribution with longer tails.");

const MASKING: Parameter = Parameter::choice(
    "masking",
    &[
        ("implicit", "Implicit"),
        ("v_cavity", "V-cavities"),
        ("neumann", "Neumann"),
        ("kelemen", "Kelemen"),
        ("schlick_ggx", "Schlick, Karis k"),
        ("smith_separable", "Smith, separable"),
        ("smith_height_correlated", "Smith, height-correlated"),
    ],
    6,
)
.symbol("G")
.help("The shadowing of microfacets from the light, and their masking from the viewer, by each other. Implicit: G = (N·L)(N·V); V-cavities: min(1, 2 (N·H)(N·V)/(V·H), 2 (N·H)(N·L)/(V·H)); Neumann: (N·L)(N·V)/max(N·L, N·V); Kelemen: (N·L)(N·V)/(V·H)²; Smith's terms follow from the distribution: separable 1/((1 + Λ(L))(1 + Λ(V))), height-correlated 1/(1 + Λ(L) + Λ(V)), and Schlick's approximation to them.");

const FRESNEL: Parameter = Parameter::choice(
    "fresnel",
    &[
        ("none", "None (F = 1)"),
        ("schlick", "Schlick"),
        ("dielectric", "Dielectric, exact"),
        ("conductor", "Conductor, exact"),
    ],
    2,
)
.symbol("F")
.label("Fresnel term")
.help("The reflectance of a microfacet by angle: everything; Schlick's F = F₀ + (1 − F₀)(1 − V·H)⁵ with F₀ from n and k; or the exact equations of dielectrics (n) or conductors (n and k).");

const DIFFUSE: Parameter = Parameter::choice(
    "diffuse",
    &[("none", "None"), ("lambert", "Lambert"), ("burley", "Burley"), ("oren_nayar", "Oren–Nayar")],
    1,
)
.symbol("f_d")
.label("diffuse base")
.help("The material below the reflecting surface: none, or a body that scatters the light entering it.");

const MULTIPLE_SCATTERING: Parameter = Parameter::choice(
    "multiple_scattering",
    &[("none", "None"), ("kulla_conty", "Kulla–Conty"), ("turquin", "Turquin")],
    0,
)
.symbol("f_{ms}")
.label("multiple scattering")
.costly()
.help("Light that bounces between microfacets is lost in the plain model, which darkens rough metals. Kulla and Conty add it as a lobe of its own, Turquin by scaling the highlight.");

parameters! {
    /// **Microfacet** — every published combination of distribution, masking and Fresnel term as a
    /// setting.
    ///
    /// ```text
    /// f_r = f_d + f_s + f_ms
    /// f_s = D(h) G(l, v) F(v·h) / (4 (n·l)(n·v))
    /// f_d = C_b/π · d(l, v) · (1 − F(n·l)) (1 − F(n·v))
    /// Kulla–Conty: f_ms = F_ms (1 − E(l)) (1 − E(v)) / (π (1 − E_avg)),
    ///              F_ms = F_avg² E_avg / (1 − F_avg (1 − E_avg))
    /// Turquin:     f_ms = f_s · F_0 (1 − E(v))/E(v)
    /// ```
    ///
    /// E is the directional albedo of the lobe with F = 1 (calculated from the chosen D and G, as a mean over the
    /// azimuth); E_avg and F_avg are cosine-weighted means. d is 1 for Lambert, Burley's factor at roughness √α, or
    /// Oren and Nayar's qualitative factor at σ = α/√2, the slope angle of the same microfacets.
    ///
    /// | parameter | symbol | unit | range | default |
    /// |---|---|---|---|---|
    /// | `base_colour` | C_b | sRGB | 0–255; used with a `diffuse` base | white |
    /// | `distribution` | D | – | `blinn_phong`, `beckmann`, `ggx`, `gtr` | `ggx` |
    /// | `gamma` | γ | – | 1–10; used with `gtr` | 2 |
    /// | `alpha_x`, `alpha_y` | α_x, α_y | – | 0.001–1 | 0.3 |
    /// | `masking` | G | – | `implicit`, `v_cavity`, `neumann`, `kelemen`, `schlick_ggx`, `smith_separable`, `smith_height_correlated` | `smith_height_correlated` |
    /// | `fresnel` | F | – | `none`, `schlick`, `dielectric`, `conductor` | `dielectric` |
    /// | `ior` | n | – | 0.01–6 per channel; not used with `fresnel` `none` | 1.5 |
    /// | `extinction` | k | – | 0–12 per channel; used with `schlick` and `conductor` | 0 |
    /// | `diffuse` | f_d | – | `none`, `lambert`, `burley`, `oren_nayar`; not used with `fresnel` `none`, which reflects everything | `lambert` |
    /// | `multiple_scattering` | f_ms | – | `none`, `kulla_conty`, `turquin` | `none` |
    ///
    /// Sources: the form is that of K. E. Torrance, E. M. Sparrow (1967), *Theory for Off-Specular Reflection from
    /// Roughened Surfaces*, and R. L. Cook, K. E. Torrance (1982), *A Reflectance Model for Computer Graphics*; the
    /// factors name theirs in [`distribution`], [`masking`] and [`fresnel`](crate::optics::fresnel). C. Kulla, A. Conty
    /// (2017), *Revisiting Physically Based Shading at Imageworks*, with the square of F_avg, since light leaving after
    /// the second bounce was reflected twice (S. Hill 2018, *A Multi-Faceted Exploration*); E. Turquin (2019),
    /// *Practical Multiple Scattering Compensation for Microfacet Models*.
    ///
    /// Use it to take a model apart: exchange one factor and see what changes. Smith's masking for the Blinn–Phong
    /// distribution is that of Beckmann with the same α (B. Walter et al. 2007), for GTR that of GGX (B. Burley 2012).
    /// Not declared reciprocal, since Turquin's factor depends on the viewer only; not energy conserving, since some
    /// settings are not: Kelemen's and Neumann's masking, Burley's base, and the masking of one distribution with
    /// another (Blinn–Phong at α = 1 gains a quarter more light at grazing angles). GGX and Beckmann with Smith's
    /// masking, without Turquin's factor and Burley's base, keep both laws.
    pub struct Microfacet {
        /// `C_b`, linear.
        base_colour: colour = BASE_COLOUR.used_when("diffuse", &["lambert", "burley", "oren_nayar"]),
        /// `D`: index of the choice.
        distribution: choice = DISTRIBUTION,
        /// `γ`.
        gamma: number = GAMMA.used_when("distribution", &["gtr"]),
        /// `α_x`.
        alpha_x: number = ALPHA_X,
        /// `α_y`.
        alpha_y: number = ALPHA_Y,
        /// `G`: index of the choice.
        masking: choice = MASKING,
        /// `F`: index of the choice.
        fresnel: choice = FRESNEL,
        /// `n`.
        ior: triple = IOR.used_when("fresnel", &["schlick", "dielectric", "conductor"]),
        /// `k`.
        extinction: triple = EXTINCTION.used_when("fresnel", &["schlick", "conductor"]),
        /// The diffuse base: index of the choice.
        diffuse: choice = DIFFUSE.used_when("fresnel", &["schlick", "dielectric", "conductor"]),
        /// `f_ms`: index of the choice.
        multiple_scattering: choice = MULTIPLE_SCATTERING,
    }
    derived {
        /// Albedo of the lobe with F = 1.
        lobe: LobeAlbedo = Self::lobe_of,
    }
}

/// Upper half of the nodes and weights of the eight-point Gauss–Legendre rule on [0, 1], which is symmetric about ½.
const GAUSS: [(f32, f32); 4] = [
    (0.591_717_3, 0.181_341_89),
    (0.762_766_2, 0.156_853_32),
    (0.898_333_24, 0.111_190_52),
    (0.980_144_9, 0.050_614_268),
];

impl Microfacet {
    fn alpha(&self) -> Vec2 {
        Vec2::new(self.alpha_x, self.alpha_y).max(Vec2::splat(distribution::MINIMUM_ALPHA))
    }

    /// `D(h)`.
    fn d(&self, h: Vec3) -> f32 {
        let alpha = self.alpha();
        match self.distribution {
            0 => distribution::blinn_phong(h, alpha),
            1 => distribution::beckmann(h, alpha),
            2 => distribution::ggx(h, alpha),
            _ => distribution::gtr(h, alpha, self.gamma),
        }
    }

    /// `G / (4 (n·l)(n·v))`, everything in the local frame.
    #[inline]
    fn visibility(&self, l: Vec3, v: Vec3, h: Vec3) -> f32 {
        let alpha = self.alpha();
        let cos_d = h.dot(l);
        let lambda = |d: Vec3| match self.distribution {
            0 | 1 => masking::smith_beckmann(d, alpha),
            _ => masking::smith_ggx(d, alpha),
        };
        match self.masking {
            0 => masking::implicit(),
            1 => masking::v_cavity(l.z, v.z, h.z, cos_d),
            2 => masking::neumann(l.z, v.z),
            3 => masking::kelemen(cos_d),
            4 => masking::schlick_smith(l.z, v.z, masking::karis_k((alpha.x * alpha.y).sqrt())),
            5 => masking::separable(l.z, v.z, lambda(l), lambda(v)),
            _ => masking::height_correlated(l.z, v.z, lambda(l), lambda(v)),
        }
    }

    /// `F_0`.
    fn f0(&self) -> Vec3 {
        match self.fresnel {
            0 => Vec3::ONE,
            2 => normal_reflectance_rgb(self.ior, Vec3::ZERO),
            _ => normal_reflectance_rgb(self.ior, self.extinction),
        }
    }

    /// `F` at the angle between light and facet.
    fn f(&self, cos_d: f32) -> Vec3 {
        match self.fresnel {
            0 => Vec3::ONE,
            1 => schlick(self.f0(), cos_d),
            2 => dielectric_rgb(self.ior, cos_d),
            _ => conductor_rgb(self.ior, self.extinction, cos_d),
        }
    }

    /// `F_avg = 2 ∫ F(μ) μ dμ`.
    fn average_f(&self) -> Vec3 {
        GAUSS
            .into_iter()
            .flat_map(|(x, weight)| [(x, weight), (1.0 - x, weight)])
            .map(|(mu, weight)| 2.0 * weight * mu * self.f(mu))
            .sum()
    }

    /// The albedo of the lobe with F = 1, if needed.
    fn lobe_of(&self) -> LobeAlbedo {
        if self.multiple_scattering == 0 {
            return LobeAlbedo::default();
        }
        LobeAlbedo::anisotropic(|l, v| {
            if l.z <= 0.0 || v.z <= 0.0 {
                return 0.0;
            }
            let h = half_vector(l, v);
            PI * self.d(h) * self.visibility(l, v, h) * l.z
        })
    }

    /// True if nothing lies below the reflecting surface, or no light gets there.
    fn is_bare(&self) -> bool {
        self.diffuse == 0 || self.fresnel == 0
    }

    /// The factor of the diffuse base on Lambert's law.
    fn body(&self, l: Vec3, v: Vec3, cos_d: f32) -> f32 {
        let alpha = self.alpha();
        let alpha = (alpha.x * alpha.y).sqrt();
        match self.diffuse {
            0 => 0.0,
            1 => 1.0,
            2 => diffuse::burley(l.z, v.z, cos_d, alpha.sqrt()),
            _ => diffuse::oren_nayar_qualitative(l.z, v.z, l.dot(v), alpha / SQRT_2),
        }
    }
}

impl ReflectionModel for Microfacet {
    const DECLARATION: Declaration =
        built_in!("microfacet", "Microfacet", Microfacet).ambient_by_albedo().anisotropic();

    fn response(&self, l: Vec3, v: Vec3, frame: &Frame) -> Terms {
        let (l, v) = (frame.to_local(l), frame.to_local(v));
        if l.z <= 0.0 || v.z <= 0.0 {
            return Terms::default();
        }
        let h = half_vector(l, v);
        let cos_d = h.dot(l).clamp(0.0, 1.0);
        let single = PI * self.d(h) * self.visibility(l, v, h) * l.z * self.f(cos_d);
        let specular = match self.multiple_scattering {
            1 => {
                let missing = |mu| (1.0 - self.lobe.at(mu)).max(0.0);
                let average = self.lobe.average();
                let f = self.average_f();
                let bounced = f * f * average / (Vec3::ONE - f * (1.0 - average));
                let shape = missing(l.z) * missing(v.z) / (1.0 - average).max(1e-6);
                single + bounced * (shape * l.z)
            }
            2 => {
                let seen = self.lobe.at(v.z).max(1e-3);
                single * (Vec3::ONE + self.f0() * ((1.0 - seen) / seen))
            }
            _ => single,
        };
        if self.is_bare() {
            return Terms { specular, ..Terms::default() };
        }
        let entering = (Vec3::ONE - self.f(l.z)) * (Vec3::ONE - self.f(v.z));
        let diffuse = self.base_colour * entering * (self.body(l, v, cos_d) * l.z);
        Terms::of(diffuse, specular)
    }

    fn lobes(&self) -> Lobes {
        let gamma = if self.distribution == 3 { self.gamma } else { 2.0 };
        let body = if self.is_bare() { Vec3::ZERO } else { self.base_colour };
        // Light of several bounces leaves in all directions.
        let bounced = if self.multiple_scattering == 1 { 1.0 - self.lobe.average() } else { 0.0 };
        Lobes::diffuse_and(Lobe::of_gtr(self.alpha(), gamma), body + bounced, self.f(lobes::OBLIQUE))
    }

    const LOBE: bool = true;

    fn lobe(&self) -> Option<LobeAlbedo> {
        Some(self.lobe)
    }

    fn readouts(&self) -> Vec<Readout> {
        vec![Readout::of_f0(self.f0())]
    }

    fn factor(&self, factor: Factor) -> Option<Vec3> {
        factor.by(|cos_d| self.f(cos_d), |h| self.d(h), |l, v| self.visibility(l, v, half_vector(l, v)))
    }

    fn quantity(&self, symbol: &str, arguments: &[f32]) -> Option<Vec3> {
        match (symbol, arguments) {
            ("E", [mu]) => Some(Vec3::splat(self.lobe.at(*mu))),
            ("E_m", []) => Some(Vec3::splat(self.lobe.average())),
            ("F_m", []) => Some(self.average_f()),
            _ => None,
        }
    }

    fn preset(material: &Measured) -> Vec<(&'static str, Value)> {
        let mut values = preset::conductor(material);
        let (fresnel, diffuse) =
            if material.metal { ("conductor", "none") } else { ("dielectric", "lambert") };
        values.push((FRESNEL.name, Value::Choice(fresnel.into())));
        values.push((DIFFUSE.name, Value::Choice(diffuse.into())));
        values
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        optics::colour::Encoding,
        parameter::{ParameterSet as _, Values},
    };

    #[test]
    fn the_mean_reflectance_is_that_of_the_closed_forms() {
        let with = |fresnel: &'static str| {
            let mut values = Values::default();
            values.set("fresnel", Value::Choice(fresnel.into()));
            Microfacet::from_values(&values, Encoding::Srgb).average_f().x
        };
        assert!((with("none") - 1.0).abs() < 1e-6);
        assert!((with("dielectric") - 0.091_778).abs() < 1e-4);
        assert!((with("schlick") - (0.04 + 0.96 / 21.0)).abs() < 1e-6);
    }
}
