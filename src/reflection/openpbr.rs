// The CPU's half: the model is not in the list of built-in ones before it has a shader.

use std::{f32::consts::PI, sync::LazyLock};

use glam::{Vec2, Vec3, Vec4};

use crate::{
    optics::{
        Frame, Terms,
        albedo::{Albedos, Lines, LobeAlbedo, lobe_albedos},
        diffuse::eon,
        distribution::{MINIMUM_ALPHA, ggx},
        fresnel::{dielectric, schlick},
        geometry::half_vector,
        masking::{separable, smith_ggx},
    },
    parameter::{BASE_COLOUR, METALLIC, Parameter, ParameterKind, ROUGHNESS, SPECULAR_COLOUR},
    parameters,
};

const fn fraction(name: &'static str, default: f32) -> Parameter {
    Parameter::number(name, 0.0..=1.0, default)
}

const fn index(name: &'static str, default: f32) -> Parameter {
    Parameter::number(name, 0.1..=6.0, default)
}

const BASE: Parameter = Parameter { kind: ParameterKind::Colour { default: [231, 231, 231] }, ..BASE_COLOUR };
const SPECULAR_ROUGHNESS: Parameter =
    Parameter { kind: ParameterKind::Number { min: 0.0, max: 1.0, default: 0.3 }, ..ROUGHNESS };
const BASE_WEIGHT: Parameter = fraction("base_weight", 1.0)
    .symbol("w_b")
    .label("weight of the base")
    .help("A factor on the base colour, of the body and of metal alike.");
const BASE_DIFFUSE_ROUGHNESS: Parameter = fraction("base_diffuse_roughness", 0.0)
    .symbol("σ")
    .label("roughness of the body")
    .help("The roughness of the body that scatters light, as in EON: 0 is Lambert's law, 1 flat and chalky.");
const SPECULAR_STRENGTH: Parameter = Parameter::number("specular_strength", 0.0..=10.0, 1.0)
    .symbol("ξ")
    .label("specular strength")
    .help("A factor on the reflectance at normal incidence: 0 removes the reflection of the base, values above 1 raise it.");
const SPECULAR_ANISOTROPY: Parameter = fraction("specular_roughness_anisotropy", 0.0)
    .symbol("a")
    .label("anisotropy")
    .help("From 0, isotropic, to 1, highlights stretched along the tangent, as on brushed metal.");
const SPECULAR_IOR: Parameter = index("specular_ior", 1.5)
    .symbol("n_s")
    .label("refractive index")
    .help("The refractive index of the non-metallic base: water 1.33, plastic and glass 1.5, diamond 2.4.");
const COAT_WEIGHT: Parameter = fraction("coat_weight", 0.0)
    .symbol("C")
    .label("coat")
    .help("The fraction of the surface under a clear coat, such as lacquer.");
const COAT_COLOUR: Parameter = Parameter::colour("coat_colour", [255; 3])
    .symbol("C_c")
    .label("colour of the coat")
    .help("The fraction of light that passes through the coat twice, in and out along the normal.");
const COAT_ROUGHNESS: Parameter = fraction("coat_roughness", 0.0)
    .symbol("r_c")
    .label("roughness of the coat")
    .help("From 0, a mirror, to 1, a matte coat, which also blurs the reflection of the base.");
const COAT_ANISOTROPY: Parameter = fraction("coat_roughness_anisotropy", 0.0)
    .symbol("a_c")
    .label("anisotropy of the coat")
    .help("From 0, isotropic, to 1, reflections of the coat stretched along the tangent.");
const COAT_IOR: Parameter = index("coat_ior", 1.6)
    .symbol("n_c")
    .label("refractive index of the coat")
    .help("The refractive index of the coat: lacquer has 1.5 to 1.6.");
const COAT_DARKENING: Parameter = fraction("coat_darkening", 1.0)
    .symbol("δ")
    .label("darkening by the coat")
    .help("The amount of the darkening and saturation of a base under a coat, which returns part of the light to it. 1 is physical.");
const FUZZ_WEIGHT: Parameter = fraction("fuzz_weight", 0.0)
    .symbol("F_z")
    .label("fuzz")
    .help("The amount of fuzz, a layer of fine fibres like the nap of velvet, or of dust.");
const FUZZ_COLOUR: Parameter = Parameter::colour("fuzz_colour", [255; 3])
    .symbol("C_f")
    .label("colour of the fuzz")
    .help("The colour of the fibres. Black fuzz darkens what lies below.");
const FUZZ_ROUGHNESS: Parameter = fraction("fuzz_roughness", 0.5)
    .symbol("r_f")
    .label("roughness of the fuzz")
    .help("The disorder of the fibres: small values shine at the rim alone, as velvet does, 1 like dust everywhere. 0 is no fuzz.");
const THIN_FILM_WEIGHT: Parameter = fraction("thin_film_weight", 0.0).symbol("w_t").label("thin film").help(
    "The fraction of the base that has a film so thin that light interferes in it, as on soap bubbles.",
);
const THIN_FILM_THICKNESS: Parameter = Parameter::number("thin_film_thickness", 0.0..=10.0, 0.5)
    .symbol("d")
    .label("thickness of the film")
    .unit("µm")
    .help("The thickness of the film. Colours are strongest from 0.1 to 1 µm, and fade below 0.03 µm.");
const THIN_FILM_IOR: Parameter = index("thin_film_ior", 1.4)
    .symbol("n_t")
    .label("refractive index of the film")
    .help("The refractive index of the film: soap 1.33, oxides of metals 2 to 2.7.");

/// Wavelengths of the film's interference for red, green and blue, in µm: those of Adobe's program.
const WAVELENGTHS: Vec3 = Vec3::new(0.62, 0.54, 0.45);

parameters! {
    /// **OpenPBR** — the opaque part of OpenPBR Surface 1.1: fuzz over a coat over a mixture of metal and of a rough body
    /// below a dielectric boundary, which a thin film may cover.
    ///
    /// ```text
    /// f = F_z C_f f_fuzz + (1 − F_z R(V)) (C f_coat + S f_base)
    /// f_base = C_s (1 − M) f_d + M min(1, ξ F_82) D G / (4 (N·L)(N·V)) + f_ms + f_body
    /// S = T_V T_L (1 − C E_c(V)) Δ',   T_X = 1 + C (C_c^(1/(2 μ'_X)) − 1),   μ'² = 1 − (1 − μ²)/n_c²
    /// f_ms = M min(1, ξ F̄_82) F̄_82 (1 − E_1(V))(1 − E_1(L))/(π (1 − Ē_1))
    /// f_body = EON((1 − M) w_b C_b, σ) (1 − E_d(V))(1 − E_d(L))/(1 − Ē_d)
    /// F_82 = F_S(c) − c (1 − c)⁶ (1 − C_s) F_S(1/7) / (1/7 (6/7)⁶),   F_S = w_b C_b + (1 − w_b C_b)(1 − c)⁵
    /// Δ' = 1 + C δ (Δ − 1),   Δ = (1 − K)/(1 − E_b K)
    /// f_fuzz = R(V) a²/(π |(a x + b z, a y, z)|⁴),   L = (x, y, z) with V in the plane y = 0
    /// ```
    ///
    /// `f_d` and `f_coat` are D F G/(4 (N·L)(N·V)) with GGX, Smith's separable masking and the exact F of a dielectric; E_1,
    /// E_d and E_c are the albedos of such lobes with F = 1, with F of the base and of the coat, calculated for each
    /// material. α = r², along the tangent α √(2/(1 + (1 − a)²)), across it (1 − a) times that.
    ///
    /// | parameter | symbol | unit | range | default |
    /// |---|---|---|---|---|
    /// | `base_weight` | w_b | – | 0–1 | 1 |
    /// | `base_colour` | C_b | sRGB | 0–255 | 231 |
    /// | `metallic` | M | – | 0–1 | 0 |
    /// | `base_diffuse_roughness` | σ | – | 0–1 | 0 |
    /// | `specular_strength` | ξ | – | 0–10 | 1 |
    /// | `specular_colour` | C_s | sRGB | 0–255 | white |
    /// | `roughness` | r | – | 0–1 | 0.3 |
    /// | `specular_roughness_anisotropy` | a | – | 0–1 | 0 |
    /// | `specular_ior` | n_s | – | 0.1–6 | 1.5 |
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
    /// Sources: Z. Andersson and others (2026), *OpenPBR Surface specification 1.1.1*, Academy Software Foundation; where
    /// the text leaves a choice, that of Adobe's program *openpbr-bsdf* (2026). P. Kutz, M. Hašan, D. Edmondson (2021),
    /// *Novel Aspects of the Adobe Standard Material* (F_82); J. Portsmouth, P. Kutz, S. Hill (2024), *EON*; T. Zeltner,
    /// B. Burley, M. Chiang (2022), *Practical Multiple-Scattering Sheen Using Linearly Transformed Cosines* (fuzz, with
    /// the authors' table); C. Kulla, A. Conty (2017), *Revisiting Physically Based Shading at Imageworks*; C. Kelemen,
    /// L. Szirmay-Kalos (2001) (body and boundary); O. Gulbrandsen (2014), *Artist Friendly Metallic Fresnel* (film over
    /// metal); E. d'Eon (2021), *A Hitchhiker's Guide to Multiple Scattering* (Δ).
    ///
    /// **Deviations** from Adobe's program: the strength of metal is bounded, `min(1, ξ F)`, so ξ above 1 does not reflect
    /// more than everything; albedos and mean reflectances are integrated, where it reads tables and fits (up to 0.6 % of
    /// coats); α is at least 0.001, where a smooth coat has 10⁻⁶ there. From the specification's text: the body and its
    /// boundary are coupled in both directions (16 % of the body), masking is separable (3 % at r = 0.3, 68 % for rough
    /// metal at 85°), the film is evaluated at three wavelengths (0.03 over glass, 0.1 over copper).
    ///
    /// **Laws**: non-negative. Not reciprocal under a coat or fuzz, whose albedo is that for the viewer alone. Energy is not
    /// conserved: the albedo E_d of the boundary ignores a film, which may reflect far more.
    pub struct OpenPbr {
        /// `w_b`.
        base_weight: number = BASE_WEIGHT,
        /// `C_b`, linear.
        base_colour: colour = BASE,
        /// `M`.
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
        /// What depends on the parameters alone.
        prepared: Prepared = Prepared::of,
        /// E_1, E_d and E_c.
        boundaries: Albedos = Self::boundaries_of,
        /// a, b and R of the fuzz over the cosine of the view.
        fuzz: Lines<FUZZ_NODES> = |this: &Self| fuzz_row(this.fuzz_roughness),
    }
}

/// What a material prepares before any direction is known.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Prepared {
    /// The index above the base and that of the base.
    indices: Vec2,
    /// The ratio of both at the dielectric boundary, inverted under a denser coat.
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
    /// The share of the film.
    film: f32,
}

/// `a` to `b` for `t` from 0 to 1, exact at both ends.
fn mix(a: f32, b: f32, t: f32) -> f32 {
    a * (1.0 - t) + b * t
}

/// `(1 + ε)/(1 − ε)`: the ratio of indices whose reflectance at normal incidence is that of `ratio`, times a factor.
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

/// α of a roughness, and the same along and across the tangent: `α_t² + α_b² = 2 α²`.
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
        let dielectric_part = f0 + (Vec3::ONE - f0) * reflected;
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
        }
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

/// Complex numbers, of which a film needs four operations.
#[derive(Clone, Copy)]
struct Complex(f32, f32);

impl Complex {
    fn plus(self, o: Self) -> Self {
        Self(self.0 + o.0, self.1 + o.1)
    }

    fn times(self, o: Self) -> Self {
        Self(self.0 * o.0 - self.1 * o.1, self.0 * o.1 + self.1 * o.0)
    }

    fn squared(self) -> f32 {
        self.0 * self.0 + self.1 * self.1
    }

    /// `(a − self)/(a + self)`, `a` being real.
    fn reflected(self, a: f32) -> Self {
        let scale = (Self(a, 0.0).plus(self)).squared().max(f32::MIN_POSITIVE).recip();
        Self((a * a - self.squared()) * scale, -2.0 * a * self.1 * scale)
    }

    /// The square root with an imaginary part of at least 0; that of this one is at least 0.
    fn root(self) -> Self {
        let modulus = self.0.hypot(self.1);
        let half = |x: f32| (0.5 * x.max(0.0)).sqrt();
        // The larger part first, the other from it, without cancellation.
        if self.0 >= 0.0 {
            let re = half(modulus + self.0);
            Self(re, if re > 0.0 { 0.5 * self.1 / re } else { 0.0 })
        } else {
            let im = half(modulus - self.0);
            Self(0.5 * self.1 / im, im)
        }
    }
}

/// The reflectance of a film of index `n_2` between media of the indices `n_1` and `n + ik`, for unpolarised light that
/// meets it at the cosine c: G. Airy's sum. `turns` is its thickness over the wavelength.
fn airy(n_1: f32, n_2: f32, n: f32, k: f32, turns: f32, c: f32) -> f32 {
    let sin2 = 1.0 - c * c;
    let cos2 = 1.0 - (n_1 / n_2) * (n_1 / n_2) * sin2;
    if cos2 <= 0.0 {
        return 1.0;
    }
    let c_2 = cos2.sqrt();
    let phase = 4.0 * PI * n_2 * turns * c_2;
    let wave = Complex(phase.cos(), phase.sin());
    let n2 = Complex((n - k) * (n + k), 2.0 * n * k);
    // n₃ cos θ₃, and the admittance n₃/cos θ₃ = n₃²/(n₃ cos θ₃) of the other polarisation.
    let q = Complex(n2.0 - n_1 * n_1 * sin2, n2.1).root();
    let scale = q.squared().max(1e-30).recip();
    let other = n2.times(Complex(q.0 * scale, -q.1 * scale));
    let sum = |first: f32, second: Complex| {
        let bounced = second.times(wave);
        let over = Complex(first, 0.0).plus(bounced).squared();
        let under = Complex(1.0, 0.0).plus(Complex(first * bounced.0, first * bounced.1)).squared();
        over / under.max(1e-30)
    };
    let real = |a: f32, b: f32| (a - b) / (a + b).max(f32::MIN_POSITIVE);
    let s = sum(real(n_1 * c, n_2 * c_2), q.reflected(n_2 * c_2));
    let p = sum(real(n_1 / c.max(1e-9), n_2 / c_2), other.reflected(n_2 / c_2));
    (0.5 * (s + p)).clamp(0.0, 1.0)
}

/// Nodes of the table of fuzz over the cosine of the view, and as many over the roughness.
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

    /// The reflectances of the dielectric boundary and of metal, both with their film.
    fn fresnel(&self, cos_d: f32) -> (Vec3, Vec3) {
        let p = &self.prepared;
        let (glass, metal) = (Vec3::splat(dielectric(p.ratio, cos_d)), p.metal(cos_d));
        if p.film <= 0.0 {
            return (glass, metal);
        }
        let film = |channel: usize, n: f32, k: f32| {
            let turns = self.thin_film_thickness / WAVELENGTHS[channel];
            airy(p.indices.x, self.thin_film_ior, n, k, turns, cos_d)
        };
        // O. Gulbrandsen (2014): n and k from the colours at normal and at grazing incidence.
        let of_metal = |i: usize| {
            let (r, g) = (p.f0[i].min(0.99), self.specular_colour[i]);
            let root = r.sqrt();
            let n = g * (1.0 - r) / (1.0 + r) + (1.0 - g) * (1.0 + root) / (1.0 - root);
            let k2 = ((n + 1.0) * (n + 1.0) * r - (n - 1.0) * (n - 1.0)) / (1.0 - r);
            film(i, n, k2.max(0.0).sqrt())
        };
        let covered = Vec3::from_array([0, 1, 2].map(|i| film(i, p.indices.y, 0.0)));
        let covered_metal = Vec3::from_array([0, 1, 2].map(of_metal));
        (glass.lerp(covered, p.film), metal.lerp(covered_metal, p.film))
    }

    /// The fraction of light that passes the coat once, at a cosine.
    fn through_coat(&self, mu: f32) -> Vec3 {
        let inside = (1.0 - (1.0 - mu * mu) / (self.coat_ior * self.coat_ior)).max(1e-4).sqrt();
        let passed = self.coat_colour.max(Vec3::splat(1e-9)).powf(0.5 / inside);
        Vec3::ONE.lerp(passed, self.coat_weight)
    }

    /// The response `π f_r cos θ_l`, by term: the body is diffuse, everything else specular.
    #[must_use]
    pub fn response(&self, l: Vec3, v: Vec3, frame: &Frame) -> Terms {
        let (l, v) = (frame.to_local(l), frame.to_local(v));
        // Below the surface, or at such a grazing angle that the quotients would leave the range of f32.
        if l.z.min(v.z) < 1e-9 {
            return Terms::default();
        }
        let p = &self.prepared;
        let cos_d = 0.5 * (l + v).length();
        let (of_l, of_v, mean) = (self.boundaries.at(l.z), self.boundaries.at(v.z), self.boundaries.mean());
        let missing = |x: f32| (1.0 - x).max(0.0);

        let (glass, metal) = self.fresnel(cos_d);
        let strength = self.specular_strength;
        let once = (1.0 - self.metallic) * self.specular_colour * glass
            + self.metallic * (strength * metal).min(Vec3::ONE);
        let mut specular = PI * l.z * facets(l, v, p.base) * once;
        if p.alpha >= 0.0016 {
            let shape = missing(of_v.x) * missing(of_l.x) * l.z / missing(mean.x).max(1e-6);
            let again = (strength * p.mean).min(Vec3::ONE) * p.mean;
            specular += self.metallic * shape.min(1.0) * again;
        }

        let rho = (1.0 - self.metallic) * p.f0;
        let coupled = missing(of_v.y) * missing(of_l.y) / missing(mean.y).max(1e-6);
        let mut diffuse = rho * eon(l.z, v.z, l.dot(v), self.base_diffuse_roughness, rho) * (coupled * l.z);

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
        Terms { ambient: Vec3::ZERO, diffuse, specular }
    }
}
