mod parameters;

use std::{f32::consts::PI, sync::LazyLock};

use glam::{Vec2, Vec3, Vec4};

use self::parameters::{
    ABBE_NUMBER, BASE, BASE_DIFFUSE_ROUGHNESS, BASE_WEIGHT, COAT_ANISOTROPY, COAT_COLOUR, COAT_DARKENING,
    COAT_IOR, COAT_ROUGHNESS, COAT_WEIGHT, DISPERSION_SCALE, FUZZ_COLOUR, FUZZ_ROUGHNESS, FUZZ_WEIGHT,
    SPECULAR_ANISOTROPY, SPECULAR_IOR, SPECULAR_ROUGHNESS, SPECULAR_STRENGTH, THIN_FILM_IOR,
    THIN_FILM_THICKNESS, THIN_FILM_WEIGHT, THIN_WALLED, TRANSMISSION_COLOUR, TRANSMISSION_DEPTH,
    TRANSMISSION_WEIGHT,
};
use super::{
    Declaration, Factor, Group, Measured, OnPages, Passage, Readout, ReflectionModel, built_in, preset,
};
use crate::{
    optics::{
        Frame, Terms, absorption,
        albedo::{Albedos, Lines, LobeAlbedo, NamedCurve, Spacing, lobe_albedos},
        diffuse::eon,
        dispersion::cauchy_of_abbe,
        distribution::{MINIMUM_ALPHA, ggx},
        film::thin_film,
        fresnel::{dielectric, schlick},
        geometry::half_vector,
        interface::{Facets, Interface},
        interior::Interior,
        lobes::{self, Lobe, Lobes, MAX_LOBES},
        masking::{separable, smith_ggx},
        refraction::refracted_cosine,
        sharp::{Sharp, Sharps},
        slab::{Slab, oblique, slab},
    },
    parameter::{METALLIC, SPECULAR_COLOUR, Value, Values},
    parameters,
};

/// The smallest cosine distinguished from 0.
const GRAZING: f32 = 1e-9;

/// The least α with which light that bounces between facets counts.
const BOUNCES: f32 = 0.0016;

/// The cosine at which light that meets several facets passes a boundary: the mean over evenly arriving light,
/// ∫ μ² dμ/∫ μ dμ.
const SCATTERED: f32 = 2.0 / 3.0;

/// Wavelengths of the film's interference for red, green and blue, in µm: those of Adobe's implementation.
const WAVELENGTHS: Vec3 = Vec3::new(0.62, 0.54, 0.45);

parameters! {
    /// **OpenPBR** — OpenPBR Surface 1.1 without volumes that scatter light: fuzz over a coat over a mixture of metal and of
    /// a dielectric, opaque with a rough body or clear, which a thin film may cover.
    ///
    /// ```text
    /// f = F_z C_f f_fuzz + (1 − F_z E_f(V)) (C f_coat + S f_base)
    /// f_base = C_s (1 − m) f_d + m min(1, ξ F_82) D G / (4 (N·L)(N·V)) + f_ms + (1 − w_τ) f_body
    /// S = T_V T_L (1 − C E_c(V)) Δ',   T_X = 1 + C (C_c^(1/(2 μ'_X)) − 1),   μ'² = 1 − (1 − μ²)/n_c²
    /// f_ms = m min(1, ξ F̄_82) F̄_82 (1 − E_1(V))(1 − E_1(L))/(π (1 − Ē_1))
    /// f_body = EON((1 − m) w_b C_b, σ) (1 − E_d(V))(1 − E_d(L))/(1 − Ē_d)
    /// F_82 = F_S(c) − c (1 − c)⁶ (1 − C_s) F_S(1/7) / (1/7 (6/7)⁶),   F_S = w_b C_b + (1 − w_b C_b)(1 − c)⁵
    /// Δ' = 1 + C δ (Δ − 1),   Δ = (1 − K)/(1 − E_b K),   K = (1 − ρ) F̄(n_c) + ρ (1 − (1 − F̄(n_c))/n_c²)
    /// ρ = 1 + ((1 − m) F̄(η) + m) (r' − 1) between 1 and r',   E_b = m ξ F̄_82 + (1 − m)(w_τ + (1 − w_τ)(w_b C_b + (1 − w_b C_b) F̄(η)))
    /// n_a = 1 + C (n_c − 1),   n_b = n_a (1 + ε)/(1 − ε),   ε² = ξ ((n_s − n_a)/(n_s + n_a))²,   η = n_b/n_a
    /// r_c' = mix(r_c, (r_c⁴ + 0.005 mean(C_f) r_f⁵)^¼, F_z),   r' = mix(r, (r⁴ + (1 − 1/n_c) r_c'⁴)^¼, C)
    /// thin:  f_t = (1 − m) w_τ (1 − F_z E_f(V)) T_V (1 − C E_c(V)) Δ' (τ D G/(4 |N·L| (N·V)) + …),  F_d → (1 − w_τ) F_d + w_τ ρ
    ///        τ = (1 − F_d)² a/(1 − F_d² a²),   ρ = F_d + F_d a τ,   a = C_τ^(1/cos θ_t)
    /// solid: I_t = (1 − m) w_τ (1 − F_z E_f(V)) T_V² (1 − C E_c(V)) Δ' (1 − F_d)/(1 − F(n_b)) I_glass
    ///        of a body of n_b with σ = −ln(C_τ)/d_τ and V_d/s_τ;  d_τ = 0: σ = 0, and C_τ² before it
    /// f_fuzz = E_f(V) a²/(π |(a x + b z, a y, z)|⁴),   L = (x, y, z) with V in the plane y = 0
    /// ```
    ///
    /// `f_d` and `f_coat` are D F G/(4 (N·L)(N·V)) with GGX, Smith's separable masking and the exact F of a dielectric; E_1,
    /// E_d and E_c are the albedos of such lobes with F = 1, with F of the base and of the coat, calculated for each
    /// material, and F̄ are means over the hemisphere. Under a denser coat, η is inverted: light that the coat refracts meets
    /// the base at no angle of total reflection. A film replaces F_d and F_82 by its reflectance (`optics::film`) in the
    /// share w_t, and fades below 30 nm; under it, n and k of metal follow from w_b C_b and the edge tint C_s. α = r'², along the tangent α √(2/(1 + (1 − a)²)), across it (1 − a) times that.
    ///
    /// | parameter | symbol | unit | range | default |
    /// |---|---|---|---|---|
    /// | `base_weight` | w_b | – | 0–1 | 1 |
    /// | `base_colour` | C_b | sRGB | 0–255 | 231 |
    /// | `metallic` | m | – | 0–1 | 0 |
    /// | `base_diffuse_roughness` | σ | – | 0–1 | 0 |
    /// | `specular_strength` | ξ | – | 0–10 | 1 |
    /// | `specular_colour` | C_s | sRGB | 0–255 | white |
    /// | `roughness` | r | – | 0–1 | 0.3 |
    /// | `specular_roughness_anisotropy` | a | – | 0–1 | 0 |
    /// | `specular_ior` | n_s | – | 0.1–6 | 1.5 |
    /// | `transmission_weight` | w_τ | – | 0–1 | 0 |
    /// | `transmission_colour` | C_τ | sRGB | 0–255; after the depth d_τ | white |
    /// | `transmission_depth` | d_τ | m | 0–100 | 0 |
    /// | `transmission_dispersion_scale` | s_τ | – | 0–1 | 0 |
    /// | `transmission_dispersion_abbe_number` | V_d | – | 1–100 | 20 |
    /// | `geometry_thin_walled` | – | – | yes or no | no |
    /// | `coat_weight` | C | – | 0–1 | 0 |
    /// | `coat_colour` | C_c | sRGB | 0–255 | white |
    /// | `coat_roughness` | r_c | – | 0–1 | 0 |
    /// | `coat_roughness_anisotropy` | a_c | – | 0–1 | 0 |
    /// | `coat_ior` | n_c | – | 0.1–6 | 1.6 |
    /// | `coat_darkening` | δ | – | 0–1 | 1 |
    /// | `fuzz_weight` | F_z | – | 0–1 | 0 |
    /// | `fuzz_colour` | C_f | sRGB | 0–255 | white |
    /// | `fuzz_roughness` | r_f | – | 0–1 | 0.5 |
    /// | `thin_film_weight` | w_t | – | 0–1 | 0 |
    /// | `thin_film_thickness` | d | µm | 0–10 | 0.5 |
    /// | `thin_film_ior` | n_t | – | 0.1–6 | 1.4 |
    ///
    /// **Transmission**: in the share w_τ of the dielectric, light passes the boundary instead of being scattered in the body.
    /// Thin-walled, the surface is a sheet with two faces, as in `thin_glass`: smooth below α = 0.001, else it transmits the
    /// lobe that it reflects, mirrored. Otherwise the object is a body, as in `glass`: light follows its own mesh, which must
    /// be closed. The coat, the fuzz and the film are on the outside; light that leaves inside meets none of them, but
    /// is coloured by the coat as where it entered. A rough body has the same α in all directions. With a weight of 0 none
    /// of this is calculated. Left out are `transmission_scatter`, its anisotropy and subsurface scattering, which need a volume
    /// that scatters light, and emission and opacity.
    ///
    /// Sources: Z. Andersson and others (2026), *OpenPBR Surface specification 1.1.1*, Academy Software Foundation; where
    /// the text leaves a choice, and where it differs, Adobe's program *openpbr-bsdf* (2026). P. Kutz, M. Hašan, D. Edmondson (2021),
    /// *Novel Aspects of the Adobe Standard Material* (F_82); J. Portsmouth, P. Kutz, S. Hill (2024), *EON*; T. Zeltner,
    /// B. Burley, M. Chiang (2022), *Practical Multiple-Scattering Sheen Using Linearly Transformed Cosines* (fuzz, with
    /// the authors' table); C. Kulla, A. Conty (2017), *Revisiting Physically Based Shading at Imageworks*; C. Kelemen,
    /// L. Szirmay-Kalos (2001) (body and boundary); O. Gulbrandsen (2014), *Artist Friendly Metallic Fresnel* (film over
    /// metal); G. G. Stokes (1862) (sheet); E. d'Eon (2021), *A Hitchhiker's Guide to Multiple Scattering* (Δ).
    ///
    /// **Deviations** from Adobe's program: the strength of metal is bounded, `min(1, ξ F)` (above ξ = 1, up to the factor
    /// ξ); albedos and mean reflectances are integrated, where it reads tables and fits (up to 0.6 % of the reference values
    /// under a coat, up to 0.19 of an albedo near an index of 1 at grazing angles); α is at least 0.001, where it is 10⁻⁶
    /// there; all reflections in a sheet absorb, at the angle of the facet, as in the text, where it tints the sum for clear glass at N·V;
    /// boundaries of bodies do not give back what is reflected several times. From the text, as Adobe's program: roughening by the coat (82 % at r_c = 0.6), masking (68 % for rough metal at
    /// 85°, 3 % at r = 0.3), multiple scattering of metal (25 % at r = 1), films below 30 nm (22 %), absorption by a partial
    /// coat (18 %), darkening (17 %), coupling of body and boundary (16 %), weights within EON (11 %), the index of the base
    /// under a partial coat (10 %), three wavelengths in films (0.03 over glass, 0.1 over copper), and fuzz that lifts the
    /// roughness of the coat.
    ///
    /// **Laws**: non-negative. Not reciprocal under a coat or fuzz, whose albedo is that for the viewer alone. Energy is not
    /// conserved: the albedo E_d of the boundary ignores a film, which may reflect far more (1.3 times what arrives), E_1
    /// ignores anisotropy (1.05), and the coupling of a rough body gains (1.004). Clear glass without a film loses and
    /// gains nothing, neither as a sheet nor, if smooth, as a body.
    pub struct OpenPbr {
        /// `w_b`.
        base_weight: number = BASE_WEIGHT,
        /// `C_b`, linear.
        base_colour: colour = BASE,
        /// `m`.
        metallic: number = METALLIC,
        /// `σ`.
        base_diffuse_roughness: number = BASE_DIFFUSE_ROUGHNESS,
        /// `ξ`.
        specular_strength: number = SPECULAR_STRENGTH,
        /// `C_s`, linear.
        specular_colour: colour = SPECULAR_COLOUR,
        /// `r`.
        roughness: number = SPECULAR_ROUGHNESS,
        /// `a`.
        specular_roughness_anisotropy: number = SPECULAR_ANISOTROPY,
        /// `n_s`.
        specular_ior: number = SPECULAR_IOR,
        /// `w_τ`.
        transmission_weight: number = TRANSMISSION_WEIGHT,
        /// `C_τ`, linear.
        transmission_colour: colour = TRANSMISSION_COLOUR,
        /// `d_τ`, in m.
        transmission_depth: number = TRANSMISSION_DEPTH,
        /// `s_τ`.
        transmission_dispersion_scale: number = DISPERSION_SCALE,
        /// `V_d`.
        transmission_dispersion_abbe_number: number = ABBE_NUMBER,
        /// True for a sheet without an inside.
        geometry_thin_walled: flag = THIN_WALLED,
        /// `C`.
        coat_weight: number = COAT_WEIGHT,
        /// `C_c`, linear.
        coat_colour: colour = COAT_COLOUR,
        /// `r_c`.
        coat_roughness: number = COAT_ROUGHNESS,
        /// `a_c`.
        coat_roughness_anisotropy: number = COAT_ANISOTROPY,
        /// `n_c`.
        coat_ior: number = COAT_IOR,
        /// `δ`.
        coat_darkening: number = COAT_DARKENING,
        /// `F_z`.
        fuzz_weight: number = FUZZ_WEIGHT,
        /// `C_f`, linear.
        fuzz_colour: colour = FUZZ_COLOUR,
        /// `r_f`.
        fuzz_roughness: number = FUZZ_ROUGHNESS,
        /// `w_t`.
        thin_film_weight: number = THIN_FILM_WEIGHT,
        /// `d`, in µm.
        thin_film_thickness: number = THIN_FILM_THICKNESS,
        /// `n_t`.
        thin_film_ior: number = THIN_FILM_IOR,
    }
    derived {
        /// The values that depend on the parameters alone.
        prepared: Prepared = Prepared::of,
        /// E_1, E_d and E_c.
        boundaries: Albedos = Self::boundaries_of,
        /// a, b and R of the fuzz over the cosine of the view.
        fuzz: Lines<FUZZ_NODES> = |this: &Self| fuzz_row(this.fuzz_roughness),
    }
}

/// The number of quadruples of [`Prepared::values`].
const PREPARED: usize = 7;

/// The values of a material that are calculated before any direction is known.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Prepared {
    /// The refractive indices above the base and of the base.
    indices: Vec2,
    /// The ratio of the indices at the dielectric boundary, inverted under a denser coat.
    ratio: f32,
    /// α of the base without anisotropy.
    alpha: f32,
    /// α of the base along and across the tangent.
    base: Vec2,
    /// α of the coat without anisotropy.
    coat_alpha: f32,
    /// α of the coat along and across the tangent.
    coat: Vec2,
    /// `F_0` of metal.
    f0: Vec3,
    /// The factor of the tint at 82° on `c (1 − c)⁶`.
    tint: Vec3,
    /// The mean of `F_82` over the hemisphere.
    mean: Vec3,
    /// `Δ'`.
    darkening: Vec3,
    /// The weight of the film.
    film: f32,
    /// n and k of metal under a film, from its colours at normal and grazing incidence.
    metal_index: [Vec3; 2],
    /// The part of the dielectric base that is a thin sheet.
    sheet: f32,
}

/// `a` to `b` for `t` from 0 to 1, exact at both ends.
fn mix(a: f32, b: f32, t: f32) -> f32 {
    a * (1.0 - t) + b * t
}

/// `(1 + ε)/(1 − ε)`: the ratio of indices with the reflectance of `ratio` at normal incidence times a
/// factor.
fn scaled_ratio(ratio: f32, factor: f32) -> f32 {
    let r = (ratio - 1.0) / (ratio + 1.0);
    let e = (factor * r * r).min(0.9999).sqrt().copysign(r);
    (1.0 + e) / (1.0 - e)
}

/// `2 ∫ F(μ) μ dμ` of a dielectric boundary, by Simpson's rule over √μ; from inside the denser medium by reciprocity.
fn mean_fresnel(ratio: f32) -> f32 {
    if ratio < 1.0 {
        return 1.0 - ratio * ratio * (1.0 - mean_fresnel(1.0 / ratio));
    }
    let n = 128u16;
    let point = |i: u16| {
        let x = f32::from(i) / f32::from(n);
        let weight = if i == 0 || i == n { 1.0 } else { f32::from(2 + 2 * (i % 2)) };
        weight * 4.0 * x.powi(3) * dielectric(ratio, x * x)
    };
    (0..=n).map(point).sum::<f32>() / (3.0 * f32::from(n))
}

/// n and k of a metal with these reflectances at normal and (an edge tint) at grazing incidence: O. Gulbrandsen (2014).
fn metal_index(f0: Vec3, edge: Vec3) -> [Vec3; 2] {
    let r = f0.min(Vec3::splat(0.99));
    let root = r.map(f32::sqrt);
    let n = edge * (1.0 - r) / (1.0 + r) + (1.0 - edge) * (1.0 + root) / (1.0 - root);
    let k2 = ((n + 1.0) * (n + 1.0) * r - (n - 1.0) * (n - 1.0)) / (1.0 - r);
    [n, k2.max(Vec3::ZERO).map(f32::sqrt)]
}

/// α of a roughness, and α along and across the tangent: `α_t² + α_b² = 2 α²`.
fn alphas(roughness: f32, anisotropy: f32) -> (f32, Vec2) {
    let alpha = roughness * roughness;
    let aspect = 1.0 - anisotropy;
    let along = alpha * (2.0 / (1.0 + aspect * aspect)).sqrt();
    (alpha.max(MINIMUM_ALPHA), Vec2::new(along, aspect * along).max(Vec2::splat(MINIMUM_ALPHA)))
}

impl Prepared {
    fn of(m: &OpenPbr) -> Self {
        let c = m.coat_weight;
        let above = mix(1.0, m.coat_ior, c);
        let below = above * scaled_ratio(m.specular_ior / above, m.specular_strength);
        let ratio = if c > 0.0 && above > below && below >= 1.0 { above / below } else { below / above };

        let lifted = |r: f32, by: f32, weight: f32| mix(r, (r.powi(4) + by).min(1.0).sqrt().sqrt(), weight);
        let fibres = 0.005 * m.fuzz_colour.element_sum() / 3.0 * m.fuzz_roughness.powi(5);
        let coat_roughness = lifted(m.coat_roughness, fibres, m.fuzz_weight);
        let spread = if m.coat_ior < 1.0 { 1.0 - m.coat_ior } else { 1.0 - 1.0 / m.coat_ior };
        let roughness = lifted(m.roughness, spread * coat_roughness.powi(4), c);
        let (alpha, base) = alphas(roughness, m.specular_roughness_anisotropy);
        let (coat_alpha, coat) = alphas(coat_roughness, m.coat_roughness_anisotropy);

        let f0 = m.base_weight * m.base_colour;
        // c (1 − c)⁶ at cos 82° = 1/7.
        let bump = (6.0f32 / 7.0).powi(6) / 7.0;
        let tint = (Vec3::ONE - m.specular_colour) * schlick(f0, 1.0 / 7.0) / bump;
        let mean = (f0 + (Vec3::ONE - f0) / 21.0 - tint / 126.0).clamp(Vec3::ZERO, Vec3::ONE);

        let (reflected, coat_reflected) = (mean_fresnel(ratio), mean_fresnel(m.coat_ior));
        // Light that passes counts as returned: what it meets inside is not known.
        let dielectric_part = (f0 + (Vec3::ONE - f0) * reflected).lerp(Vec3::ONE, m.transmission_weight);
        let albedo =
            (m.metallic * m.specular_strength * mean + (1.0 - m.metallic) * dielectric_part).min(Vec3::ONE);
        let from_inside = 1.0 - (1.0 - coat_reflected) / (m.coat_ior * m.coat_ior);
        let scattered = mix(1.0, roughness, mix(reflected, 1.0, m.metallic));
        let k = mix(coat_reflected, from_inside, scattered).clamp(0.0, 0.9999);
        let darkening = (1.0 - k) / (Vec3::ONE - albedo * k);
        let t = (m.thin_film_thickness / 0.03).clamp(0.0, 1.0);
        Self {
            indices: Vec2::new(above, below),
            ratio,
            alpha,
            base,
            coat_alpha,
            coat,
            f0,
            tint,
            mean,
            darkening: Vec3::ONE + (darkening - Vec3::ONE) * (c * m.coat_darkening),
            film: m.thin_film_weight * t * t * (3.0 - 2.0 * t),
            metal_index: metal_index(f0, m.specular_colour),
            sheet: if m.geometry_thin_walled { m.transmission_weight } else { 0.0 },
        }
    }

    /// The values that the shader reads, by the index of `value_prepared`.
    fn values(&self) -> [Vec4; PREPARED] {
        [
            Vec4::new(self.indices.x, self.indices.y, self.ratio, self.film),
            Vec4::new(self.base.x, self.base.y, self.coat.x, self.coat.y),
            self.tint.extend(self.alpha),
            self.mean.extend(0.0),
            self.darkening.extend(0.0),
            self.metal_index[0].extend(0.0),
            self.metal_index[1].extend(0.0),
        ]
    }

    /// True if the boundary does not spread the light that passes.
    fn is_smooth(&self) -> bool {
        self.alpha <= MINIMUM_ALPHA
    }

    /// The refractive index of a solid body, within the limits of arithmetic.
    fn ior(&self) -> f32 {
        self.indices.y.clamp(0.1, 10.0)
    }

    /// `F_82` without a film.
    fn metal(&self, cos_d: f32) -> Vec3 {
        let c = cos_d.clamp(0.0, 1.0);
        (schlick(self.f0, c) - self.tint * (c * (1.0 - c).powi(6))).clamp(Vec3::ZERO, Vec3::ONE)
    }
}

/// `D G / (4 (N·L)(N·V))` of GGX with separable masking, in the local frame.
fn facets(l: Vec3, v: Vec3, alpha: Vec2) -> f32 {
    ggx(half_vector(l, v), alpha) * separable(l.z, v.z, smith_ggx(l, alpha), smith_ggx(v, alpha))
}

/// Nodes of the fuzz table over the cosine of the view, and over the roughness.
const FUZZ_NODES: usize = 32;

/// a, b, R of the fuzz by roughness and cosine, from the authors' table.
static FUZZ: LazyLock<Vec<Vec4>> = LazyLock::new(|| {
    let text = include_str!("../../assets/data/ltc_sheen.csv");
    let row = |line: &str| {
        let mut cells = line.split(',').skip(2).map(|cell| cell.trim().parse().unwrap_or(0.0));
        let mut next = || cells.next().unwrap_or(0.0);
        Vec4::new(next(), next(), next(), 0.0)
    };
    let mut rows: Vec<_> = text.lines().skip(1).map(row).collect();
    // A short file must not be read beyond its end; a test counts the rows.
    rows.resize(FUZZ_NODES * FUZZ_NODES, Vec4::ZERO);
    rows
});

fn fuzz_row(roughness: f32) -> Lines<FUZZ_NODES> {
    let x = roughness.clamp(0.0, 1.0) * (FUZZ_NODES - 1) as f32;
    let i = (x as usize).min(FUZZ_NODES - 2);
    let at = |row: usize, j: usize| FUZZ[row * FUZZ_NODES + j];
    Lines::new(std::array::from_fn(|j| at(i, j).lerp(at(i + 1, j), x - i as f32)))
}

impl OpenPbr {
    fn boundaries_of(&self) -> Albedos {
        let p = &self.prepared;
        let cosine = |l: Vec3, v: Vec3| 0.5 * (l + v).length();
        let lobe = |l: Vec3, v: Vec3, alpha: f32| {
            if l.z <= 0.0 || v.z <= 0.0 { 0.0 } else { PI * l.z * facets(l, v, Vec2::splat(alpha)) }
        };
        let [all, base] = lobe_albedos(|l, v| {
            let lobe = lobe(l, v, p.alpha);
            [lobe, lobe * dielectric(p.ratio, cosine(l, v))]
        });
        let coat = if self.coat_weight > 0.0 {
            LobeAlbedo::new(|l, v| lobe(l, v, p.coat_alpha) * dielectric(self.coat_ior, cosine(l, v)))
        } else {
            LobeAlbedo::default()
        };
        Albedos::of([all, base, coat, LobeAlbedo::default()])
    }

    /// A reflectance of the base with its film, over a refractive index n + i k.
    fn filmed(&self, bare: Vec3, [n, k]: [Vec3; 2], cos_d: f32) -> Vec3 {
        let p = &self.prepared;
        let covered = |i: usize| {
            let turns = self.thin_film_thickness / WAVELENGTHS[i];
            thin_film(p.indices.x, self.thin_film_ior, n[i], k[i], turns, cos_d)
        };
        if p.film > 0.0 { bare.lerp(Vec3::from_array([0, 1, 2].map(covered)), p.film) } else { bare }
    }

    /// The reflectance of the dielectric boundary with its film.
    fn boundary(&self, cos_d: f32) -> Vec3 {
        let p = &self.prepared;
        let bare = Vec3::splat(dielectric(p.ratio, cos_d));
        self.filmed(bare, [Vec3::splat(p.indices.y), Vec3::ZERO], cos_d)
    }

    /// The reflectance of the base, a mixture of a dielectric boundary and metal, both with their film.
    fn fresnel(&self, cos_d: f32) -> Vec3 {
        let p = &self.prepared;
        let mut reflected = Vec3::ZERO;
        // Films are expensive, and most materials have only one of the two.
        if self.metallic < 1.0 {
            let mut covered = self.boundary(cos_d);
            if p.sheet > 0.0 {
                covered = covered.lerp(self.sheet(covered, cos_d).reflectance, p.sheet);
            }
            reflected += (1.0 - self.metallic) * self.specular_colour * covered;
        }
        if self.metallic > 0.0 {
            let covered = self.filmed(p.metal(cos_d), p.metal_index, cos_d);
            reflected += self.metallic * (self.specular_strength * covered).min(Vec3::ONE);
        }
        reflected
    }

    /// The fraction of light that passes through the coat once, at a cosine.
    fn through_coat(&self, mu: f32) -> Vec3 {
        let inside = (1.0 - (1.0 - mu * mu) / (self.coat_ior * self.coat_ior)).max(1e-4).sqrt();
        let passed = self.coat_colour.max(Vec3::splat(1e-9)).powf(0.5 / inside);
        Vec3::ONE.lerp(passed, self.coat_weight)
    }

    /// The reflection and transmission of a thin sheet between two such boundaries.
    fn sheet(&self, boundary: Vec3, cos_d: f32) -> Slab {
        let inside = refracted_cosine(cos_d, self.prepared.indices.y);
        slab(boundary, oblique(self.transmission_colour, inside))
    }

    /// The sheet for light that meets several facets.
    fn scattering_sheet(&self) -> Slab {
        self.sheet(self.boundary(SCATTERED), SCATTERED)
    }

    /// The part of the light from below the base that passes the layers above it, towards a viewer at a cosine.
    fn above(&self, mu: f32) -> Vec3 {
        let mut above = Vec3::ONE;
        if self.coat_weight > 0.0 {
            let passes = missing(self.coat_weight * self.boundaries.at(mu).z);
            above = self.through_coat(mu) * self.prepared.darkening * passes;
        }
        if self.fuzz_weight > 0.0 {
            above *= missing(self.fuzz_weight * self.fuzz.at(mu).z);
        }
        above
    }

    /// The light that bounces between facets, `π f cos θ_l`, before it is coloured: the light that single reflection
    /// loses.
    fn bounced(&self, l: Vec3, v: Vec3) -> f32 {
        let [of_l, of_v] = [l, v].map(|d| missing(self.boundaries.at(d.z).x));
        let shape = of_v * of_l * l.z / missing(self.boundaries.mean().x).max(1e-6);
        shape.min(1.0)
    }

    /// The response to light behind a thin sheet, for its direction mirrored to the side of the viewer.
    fn through_sheet(&self, l: Vec3, v: Vec3) -> Vec3 {
        let p = &self.prepared;
        let cos_d = 0.5 * (l + v).length();
        let mut passed = Vec3::ZERO;
        if !p.is_smooth() {
            let once = self.sheet(self.boundary(cos_d), cos_d).transmittance;
            passed += PI * l.z * facets(l, v, p.base) * once;
        }
        if p.alpha >= BOUNCES {
            passed += self.bounced(l, v) * self.scattering_sheet().transmittance;
        }
        (1.0 - self.metallic) * p.sheet * self.above(v.z) * passed
    }

    /// The light that a smooth sheet lets straight through to a viewer at a cosine.
    fn straight_through(&self, v: Vec3, mu: f32) -> Option<Sharp> {
        let p = &self.prepared;
        if p.sheet <= 0.0 || !p.is_smooth() || mu <= 0.0 {
            return None;
        }
        let passed = (1.0 - self.metallic) * p.sheet * self.sheet(self.boundary(mu), mu).transmittance;
        Some(Sharp::transmitted(-v, self.above(mu) * passed))
    }

    /// The inside of a body.
    fn inside(&self) -> Interior {
        let (p, scale) = (&self.prepared, self.transmission_dispersion_scale);
        Interior {
            ior: p.ior(),
            cauchy_b: if scale > 0.0 {
                cauchy_of_abbe(p.ior(), self.transmission_dispersion_abbe_number / scale)
            } else {
                0.0
            },
            alpha: if p.is_smooth() { 0.0 } else { p.alpha },
            absorption: absorption::coefficient(self.transmission_colour, self.transmission_depth),
        }
    }

    /// The part of the light that passes into a body at a cosine, over that of a body without coat, film and tint.
    fn passed(&self, mu: f32) -> Vec3 {
        let p = &self.prepared;
        // The way inside begins at the boundary of the body to air: what the coat and the film change about that.
        // Light that would be reflected totally there enters along the normal.
        let scattered = if p.ior() * p.ior() > 1.0 - SCATTERED * SCATTERED { SCATTERED } else { 1.0 };
        let at = if p.is_smooth() { mu } else { scattered };
        let bare = (1.0 - dielectric(p.ior(), at)).max(1e-6);
        let entered = (Vec3::ONE - self.boundary(at)) / bare;
        (1.0 - self.metallic) * self.transmission_weight * self.above(mu) * entered
    }

    /// The tint of light that crosses the surface of a body.
    fn tint(&self) -> Vec3 {
        if self.transmission_depth > 0.0 { Vec3::ONE } else { self.transmission_colour }
    }

    /// The part of the light from within a body that enters it at a cosine and leaves it elsewhere, over that of a body
    /// without coat, film and tint.
    fn entered(&self, mu: f32) -> Vec3 {
        // The coat colours the light once more where it leaves, as at this angle.
        let left = if self.coat_weight > 0.0 { self.through_coat(mu) } else { Vec3::ONE };
        let tint = self.tint();
        self.passed(mu) * left * tint * tint
    }

    /// The lobes of reflection, with that of a rough sheet: as many as there is room for.
    fn lobes_beside(&self, reflected: Lobes) -> Lobes {
        let p = &self.prepared;
        if p.sheet <= 0.0 || p.is_smooth() {
            return reflected;
        }
        let through = ((1.0 - self.metallic) * p.sheet).clamp(0.1, 0.6);
        let mut all = *reflected.all();
        all.sort_by(|(_, a), (_, b)| b.total_cmp(a));
        all[MAX_LOBES - 1] = (Lobe::refracted(p.base, 1.0), through / (1.0 - through));
        Lobes::new(&all)
    }
}

/// The passage of light through surfaces with these parameters.
fn passage_with(values: &Values) -> Passage {
    passage(values.number(&TRANSMISSION_WEIGHT), values.choice(&THIN_WALLED) != 0)
}

/// The passage of light, from the two parameters that decide it.
fn passage(weight: f32, thin: bool) -> Passage {
    match (weight > 0.0, thin) {
        (false, _) => Passage::NONE,
        (true, true) => Passage::SHEET,
        (true, false) => Passage::BODY,
    }
}

/// The part of the light that an albedo leaves.
fn missing(albedo: f32) -> f32 {
    (1.0 - albedo).max(0.0)
}

impl ReflectionModel for OpenPbr {
    const DECLARATION: Declaration = built_in!("openpbr", "OpenPBR", Standard)
        .ambient_by_albedo()
        .anisotropic()
        .transmitting()
        .sharp()
        .solid();

    const PASSAGE: Option<fn(&Values) -> Passage> = Some(passage_with);

    const GROUPS: &'static [Group] = &[
        Group::new("Base", &["base_weight", "base_colour", "metallic", "base_diffuse_roughness"]),
        Group::new(
            "Specular",
            &[
                "specular_strength",
                "specular_colour",
                "roughness",
                "specular_roughness_anisotropy",
                "specular_ior",
            ],
        ),
        Group::new(
            "Transmission",
            &[
                "transmission_weight",
                "transmission_colour",
                "transmission_depth",
                "transmission_dispersion_scale",
                "transmission_dispersion_abbe_number",
                "geometry_thin_walled",
            ],
        ),
        Group::new(
            "Coat",
            &[
                "coat_weight",
                "coat_colour",
                "coat_roughness",
                "coat_roughness_anisotropy",
                "coat_ior",
                "coat_darkening",
            ],
        ),
        Group::new("Fuzz", &["fuzz_weight", "fuzz_colour", "fuzz_roughness"]),
        Group::new("Thin film", &["thin_film_weight", "thin_film_thickness", "thin_film_ior"]),
    ];

    const CURVES: &'static [NamedCurve] = &[
        NamedCurve { name: "boundaries", spacing: Spacing::Cubic },
        NamedCurve { name: "fuzz", spacing: Spacing::Linear(FUZZ_NODES) },
        NamedCurve { name: "prepared", spacing: Spacing::Values(PREPARED) },
    ];

    const ON_PAGES: Option<OnPages> = Some(OnPages {
        script: include_str!("openpbr.js"),
        table: || FUZZ.iter().flat_map(|v| v.to_array()).collect(),
    });

    const INTERIOR_ON_PAGES: Option<&'static str> = Some(include_str!("openpbr/interior.js"));

    fn curves(&self) -> Vec<Vec4> {
        let mut all = [self.boundaries.values(), self.fuzz.values()].concat();
        all.extend(self.prepared.values());
        all
    }

    fn passage(&self) -> Passage {
        passage(self.transmission_weight, self.geometry_thin_walled)
    }

    // The body is diffuse, everything else on its side specular.
    fn response(&self, l: Vec3, v: Vec3, frame: &Frame) -> Terms {
        let (l, v) = (frame.to_local(l), frame.to_local(v));
        let p = &self.prepared;
        let behind = l.z < 0.0 && p.sheet > 0.0;
        if v.z <= 0.0 || l.z <= 0.0 && !behind {
            return Terms::default();
        }
        // At more grazing angles the quotients would leave the range of f32.
        let (l, v) = (l.with_z(l.z.abs().max(GRAZING)), v.with_z(v.z.max(GRAZING)));
        if behind {
            return Terms::through(self.through_sheet(l, v));
        }
        let cos_d = 0.5 * (l + v).length();
        let (of_l, of_v, mean) = (self.boundaries.at(l.z), self.boundaries.at(v.z), self.boundaries.mean());

        let strength = self.specular_strength;
        let mut specular = PI * l.z * facets(l, v, p.base) * self.fresnel(cos_d);
        if p.alpha >= BOUNCES {
            let shape = missing(of_v.x) * missing(of_l.x) * l.z / missing(mean.x).max(1e-6);
            let again = (strength * p.mean).min(Vec3::ONE) * p.mean;
            specular += self.metallic * shape.min(1.0) * again;
            if p.sheet > 0.0 {
                let part = (1.0 - self.metallic) * p.sheet * self.specular_colour;
                specular += part * shape.min(1.0) * self.scattering_sheet().reflectance;
            }
        }

        let rho = (1.0 - self.metallic) * p.f0;
        let coupled = missing(of_v.y) * missing(of_l.y) / missing(mean.y).max(1e-6);
        let mut diffuse = rho * eon(l.z, v.z, l.dot(v), self.base_diffuse_roughness, rho) * (coupled * l.z);
        diffuse *= 1.0 - self.transmission_weight;

        if self.coat_weight > 0.0 {
            let coat = self.coat_weight;
            let below =
                self.through_coat(l.z) * self.through_coat(v.z) * p.darkening * missing(coat * of_v.z);
            let top = PI * l.z * facets(l, v, p.coat) * dielectric(self.coat_ior, cos_d);
            diffuse *= below;
            specular = specular * below + Vec3::splat(coat * top);
        }
        if self.fuzz_weight > 0.0 {
            let [a, b, reflected, _] = self.fuzz.at(v.z).to_array();
            let below = missing(self.fuzz_weight * reflected);
            // L in the frame whose x–z plane holds V.
            let azimuth = Vec2::new(v.x, v.y).normalize_or(Vec2::X);
            let (x, y) = (azimuth.dot(l.truncate()), azimuth.perp_dot(l.truncate()));
            let w2 = Vec3::new(a * x + b * l.z, a * y, l.z).length_squared();
            let lobe = reflected * a * a / (w2 * w2).max(1e-30);
            diffuse *= below;
            specular = specular * below + self.fuzz_weight * lobe * l.z * self.fuzz_colour;
        }
        Terms::of(diffuse, specular)
    }

    fn sharp(&self, v: Vec3, frame: &Frame) -> Sharps {
        self.straight_through(v, frame.n.dot(v)).into_iter().collect()
    }

    fn behind(&self, l: Vec3, v: Vec3, frame: &Frame) -> Vec3 {
        if !self.passage().solid {
            return self.response(v, l, frame).transmitted / (PI * frame.n.dot(v).abs());
        }
        let p = &self.prepared;
        if p.is_smooth() {
            return Vec3::ZERO;
        }
        let (l, v) = (frame.to_local(l), frame.to_local(v));
        let interface = Interface::new(Facets::Ggx, Vec2::splat(p.alpha), p.ior());
        self.passed(l.z.max(GRAZING)) * self.tint() * interface.transmitted(l, v)
    }

    fn interior(&self) -> Option<Interior> {
        self.passage().solid.then(|| self.inside())
    }

    fn entering(&self, v: Vec3, frame: &Frame) -> Vec3 {
        self.entered(frame.n.dot(v).max(GRAZING))
    }

    fn lobes(&self) -> Lobes {
        let p = &self.prepared;
        let coat = self.coat_weight * dielectric(self.coat_ior, lobes::OBLIQUE);
        let body = (1.0 - self.metallic) * (1.0 - self.transmission_weight) * p.f0
            + self.fuzz_weight * self.fuzz_colour;
        let base = self.fresnel(lobes::OBLIQUE);
        let reflected = Lobes::coated(
            (Lobe::wide(p.coat), coat),
            Lobe::wide(p.base),
            (1.0 - coat) * body,
            (1.0 - coat) * base,
        );
        self.lobes_beside(reflected)
    }

    fn quantity(&self, symbol: &str, arguments: &[f32]) -> Option<Vec3> {
        let x = arguments.first().copied();
        match symbol {
            "ρ_n" => return Some(self.scattering_sheet().reflectance),
            "τ_n" => return Some(self.scattering_sheet().transmittance),
            _ => {}
        }
        Some(Vec3::splat(match symbol {
            "U" => missing(self.boundaries.at(x?).x),
            "U_m" => missing(self.boundaries.mean().x),
            "T_d" => missing(self.boundaries.at(x?).y),
            "T_h" => missing(self.boundaries.mean().y),
            "E_c" => self.boundaries.at(x?).z,
            "E_f" => self.fuzz.at(x?).z,
            "a_f" => self.fuzz.at(x?).x,
            "b_f" => self.fuzz.at(x?).y,
            "F_h" => mean_fresnel(x?),
            _ => return None,
        }))
    }

    fn readouts(&self) -> Vec<Readout> {
        vec![Readout::of_f0(self.fresnel(1.0)), Readout::of_alpha(self.prepared.alpha)]
    }

    /// The factors of the base, without coat and fuzz.
    fn factor(&self, factor: Factor) -> Option<Vec3> {
        let alpha = self.prepared.base;
        factor.by(
            |cos_d| self.fresnel(cos_d),
            |h| ggx(h, alpha),
            |l, v| separable(l.z, v.z, smith_ggx(l, alpha), smith_ggx(v, alpha)),
        )
    }

    /// Sets a metal by its reflectances at normal incidence and at 82°, a dielectric by its refractive index.
    fn preset(material: &Measured) -> Vec<(&'static str, Value)> {
        let mut values = if material.metal {
            let tint = material.f82 / schlick(material.f0, 1.0 / 7.0);
            let mut metal = preset::base_colour_metallic(material);
            metal.push((BASE_WEIGHT.name, Value::Number(1.0)));
            metal.push((SPECULAR_COLOUR.name, preset::colour(tint)));
            metal
        } else {
            vec![
                (METALLIC.name, Value::Number(0.0)),
                (SPECULAR_COLOUR.name, Value::Colour([255; 3])),
                (SPECULAR_IOR.name, Value::Number(material.n[1])),
            ]
        };
        // The measurement is of the bare material; layers of another material would change it.
        values.push((SPECULAR_STRENGTH.name, Value::Number(1.0)));
        let layers = [COAT_WEIGHT, FUZZ_WEIGHT, THIN_FILM_WEIGHT];
        values.extend(layers.map(|layer| (layer.name, Value::Number(0.0))));
        values
    }
}
