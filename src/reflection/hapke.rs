use std::f32::consts::{FRAC_2_PI, PI};

use glam::Vec3;

use super::{Declaration, ReflectionModel, built_in};
use crate::{
    optics::{Frame, Terms},
    parameter::{BASE_COLOUR, Parameter},
    parameters,
};

/// Single-scattering albedo.
const SINGLE_SCATTERING_ALBEDO: Parameter = Parameter::number("single_scattering_albedo", 0.0..=1.0, 0.52)
    .symbol("w")
    .label("single-scattering albedo")
    .help("The fraction of light that a grain scatters rather than absorbs; multiplied by the base colour for red, green and blue. About 0.2 for the Moon's dark plains, nearly 1 for snow.");

/// Width of the lobes of the phase function.
const GRAIN_ASYMMETRY: Parameter = Parameter::number("grain_asymmetry", 0.0..=0.9, 0.213)
    .symbol("b")
    .label("asymmetry of grains")
    .help("The narrowness of the lobes into which a grain scatters: 0 is even in all directions.");

/// Balance of the lobes of the phase function.
const BACKSCATTER: Parameter = Parameter::number("backscatter", -1.0..=1.0, 1.0)
    .symbol("c")
    .label("backscattering")
    .help("1: grains scatter back to the light, like rough opaque ones; −1: forward, like clear ones.");

/// Height of the opposition surge.
const OPPOSITION_AMPLITUDE: Parameter = Parameter::number("opposition_amplitude", 0.0..=1.0, 1.0)
    .symbol("B_0")
    .label("opposition surge")
    .help("The increase of single scattering when the light is behind the observer, where every grain hides its own shadow.");

/// Width of the opposition surge.
const OPPOSITION_WIDTH: Parameter =
    Parameter::number("opposition_width", 0.001..=1.0, 0.05).symbol("h").label("width of the surge").help(
        "At a phase angle of 2 arctan h the surge has half its height: 0.05 is 6°. Small for loose powder.",
    );

/// Macroscopic roughness.
const MEAN_SLOPE: Parameter = Parameter::number("mean_slope", 0.0..=45.0, 30.0)
    .symbol("θ_m")
    .label("mean slope")
    .unit("°")
    .help("The ruggedness of the ground at scales larger than the grains: the mean slope of its faces, which shadow and hide each other.");

parameters! {
    /// **Hapke** — the surfaces of moons and planets: scattering grains, shadows between them, slopes.
    ///
    /// ```text
    /// f_r = w/4π · μ_l/(μ_l + μ_v) · [(1 + B) P + H(μ_l) H(μ_v) − 1] · S/cos θ_i      w ← w C_b
    /// response = π f_r max(0, N·L), 0 where N·V ≤ 0
    /// H(x) = (1 + 2x)/(1 + 2x √(1 − w))
    /// P = (1 + c)/2 · (1 − b²)/(1 − 2b cos g + b²)^{3/2} + (1 − c)/2 · (1 − b²)/(1 + 2b cos g + b²)^{3/2}
    /// B = B_0/(1 + tan(g/2)/h)
    /// ```
    ///
    /// g is the angle between light and view (0: light behind the observer). Single scattering is exact for the phase
    /// function P, a double Henyey–Greenstein lobe, and increased by the opposition surge B; multiple scattering is
    /// that of isotropically scattering grains, with Chandrasekhar's H in Hapke's approximation of 1981.
    ///
    /// Slopes of mean θ̄ (1984) replace the cosines by effective ones μ_l, μ_v and add the shadowing S.
    /// With θ the smaller of the angles of light and view, Θ the larger, ψ the azimuth between them,
    ///
    /// ```text
    /// χ = 1/√(1 + π tan² θ̄)   E₁(x) = exp(−2/π cot θ̄ cot x)   E₂(x) = exp(−1/π cot² θ̄ cot² x)
    /// μ(θ) = χ (cos θ + sin θ tan θ̄ [cos ψ E₂(Θ) + sin²(ψ/2) E₂(θ)]/[2 − E₁(Θ) − ψ/π E₁(θ)])
    /// μ(Θ) = χ (cos Θ + sin Θ tan θ̄ [E₂(Θ) − sin²(ψ/2) E₂(θ)]/[2 − E₁(Θ) − ψ/π E₁(θ)])
    /// η(x) = χ (cos x + sin x tan θ̄ E₂(x)/(2 − E₁(x)))
    /// S = cos θ_i μ_v χ/(η(θ) η(Θ) (1 − f + f χ cos θ/η(θ)))    f = exp(−2 tan(ψ/2))
    /// ```
    ///
    /// | parameter | symbol | unit | range | default |
    /// |---|---|---|---|---|
    /// | `base_colour` | C_b | sRGB | 0–255 | white |
    /// | `single_scattering_albedo` | w | – | 0–1 | 0.52 |
    /// | `grain_asymmetry` | b | – | 0–0.9 | 0.213 |
    /// | `backscatter` | c | – | −1–1 | 1 |
    /// | `opposition_amplitude` | B_0 | – | 0–1 | 1 |
    /// | `opposition_width` | h | – | 0.001–1 | 0.05 |
    /// | `mean_slope` | θ̄ | degrees | 0–45 | 30 |
    ///
    /// Use it for regolith, dust, snow, soil; with b = B_0 = θ̄ = 0 and a small w it is Lommel–Seeliger. The radiance
    /// factor I/F of planetary science is the response. Reciprocal; not energy conserving for w near 1: the approximate
    /// H alone gives up to 1.04, and backscattering grains give more, since the multiple scattering ignores P.
    ///
    /// Source: B. Hapke (1981), *Bidirectional Reflectance Spectroscopy 1. Theory*, Journal of Geophysical
    /// Research 86(B4), 3039–3054; (1984), *3. Correction for Macroscopic Roughness*, Icarus 59, 41–59;
    /// (1986), *4. The Extinction Coefficient and the Opposition Effect*, Icarus 67, 264–280. P: A.
    /// McGuire, B. Hapke (1995), *An Experimental Study of Light Scattering by Large, Irregular
    /// Particles*, Icarus 113, 134–155.
    pub struct Hapke {
        /// `C_b`, linear.
        base_colour: colour = BASE_COLOUR,
        /// `w`.
        single_scattering_albedo: number = SINGLE_SCATTERING_ALBEDO,
        /// `b`.
        grain_asymmetry: number = GRAIN_ASYMMETRY,
        /// `c`.
        backscatter: number = BACKSCATTER,
        /// `B_0`.
        opposition_amplitude: number = OPPOSITION_AMPLITUDE,
        /// `h`.
        opposition_width: number = OPPOSITION_WIDTH,
        /// `θ̄` in degrees.
        mean_slope: number = MEAN_SLOPE,
    }
}

/// Guards denominators that reach 0 at the normal, at the horizon or at θ̄ = 0.
const TINY: f32 = 1e-10;

/// A direction on the slopes: the quantities of the roughness correction for light or view.
struct Slanted {
    cosine: f32,
    /// `tan θ̄ sin x`.
    rise: f32,
    /// `1 − E₁`.
    unshaded: f32,
    e1: f32,
    e2: f32,
}

impl Slanted {
    fn new(cosine: f32, sine: f32, tangent: f32) -> Self {
        let rise = tangent * sine;
        let cot_cot = cosine / rise.max(TINY);
        let unshaded = -(-FRAC_2_PI * cot_cot).exp_m1();
        Self { cosine, rise, unshaded, e1: 1.0 - unshaded, e2: (-cot_cot * cot_cot / PI).exp() }
    }

    /// `η/χ`.
    fn eta(&self) -> f32 {
        self.cosine + self.rise * self.e2 / (1.0 + self.unshaded)
    }
}

/// The effective cosines of light and view in either order, and their product times `S/(cos θ_i μ_l)`: the
/// effect of slopes with this mean tangent on the reflection of a level surface. Symmetric in light and view.
fn roughen(l: Vec3, v: Vec3, n: Vec3, tangent: f32) -> (f32, f32, f32) {
    let (cos_l, cos_v) = (n.dot(l), n.dot(v));
    let (across_l, across_v) = (l - cos_l * n, v - cos_v * n);
    let chi = 1.0 / (1.0 + PI * tangent * tangent).sqrt();
    let light = Slanted::new(cos_l, across_l.length(), tangent);
    let view = Slanted::new(cos_v, across_v.length(), tangent);
    let (steep, flat) = if cos_l >= cos_v { (light, view) } else { (view, light) };

    // sin and cos of ψ/2 from the unit tangents; along the normal the azimuth is undefined and irrelevant.
    let (t_l, t_v) = (across_l.normalize_or_zero(), across_v.normalize_or_zero());
    let (sin, cos) = if t_l == Vec3::ZERO || t_v == Vec3::ZERO {
        (0.0, 1.0)
    } else {
        (0.5 * (t_l - t_v).length(), 0.5 * (t_l + t_v).length())
    };

    // The published brackets, with cos ψ = 1 − 2 sin² (ψ/2) and the difference of the two E₂ written without
    // cancellation at the horizon.
    let spread = (steep.cosine - flat.cosine) * (steep.cosine + flat.cosine)
        / (steep.rise * flat.rise / tangent.max(TINY)).powi(2).max(TINY * TINY);
    let difference = -flat.e2 * (-spread / PI).exp_m1();
    let common = cos * cos * flat.e2;
    let opposed = sin * sin * difference;
    let visible = (flat.unshaded + steep.unshaded + steep.e1 * FRAC_2_PI * cos.atan2(sin)).max(TINY);
    let mu_steep = (chi * (steep.cosine + steep.rise * (common - opposed) / visible)).max(0.0);
    let mu_flat = chi * (flat.cosine + flat.rise * (common + opposed) / visible);

    let f = (-2.0 * sin / cos.max(TINY)).exp();
    let q = steep.cosine / steep.eta().max(TINY);
    let shadow = (mu_steep / (chi * steep.eta()).max(TINY)) * (mu_flat / (chi * flat.eta()).max(TINY)) * chi
        / (1.0 - f + f * q);
    (mu_steep, mu_flat, shadow)
}

impl ReflectionModel for Hapke {
    const DECLARATION: Declaration = built_in!("hapke", "Hapke", Classical).ambient_by_albedo();

    fn response(&self, l: Vec3, v: Vec3, frame: &Frame) -> Terms {
        let Some((cos_i, _)) = frame.cosines(l, v) else { return Terms::default() };
        let (mu_a, mu_b, shadow) = roughen(l, v, frame.n, self.mean_slope.to_radians().tan());

        // Twice the sine and the cosine of half the phase angle: 1 ∓ 2b cos g + b² without cancellation.
        let (apart, together) = ((l - v).length(), (l + v).length());
        let b = self.grain_asymmetry;
        let lobe = |chord: f32| {
            let squared = (1.0 - b) * (1.0 - b) + b * chord * chord;
            (1.0 - b * b) / (squared * squared.sqrt())
        };
        let phase =
            0.5 * ((1.0 + self.backscatter) * lobe(apart) + (1.0 - self.backscatter) * lobe(together));
        let surge = self.opposition_amplitude * self.opposition_width * together
            / (self.opposition_width * together + apart);

        let w = self.single_scattering_albedo * self.base_colour;
        let gamma = (1.0 - w).max(Vec3::ZERO).map(f32::sqrt);
        // H − 1, so that H H − 1 keeps its digits for dark grains.
        let above_one = |x: f32| 2.0 * x * w / ((1.0 + gamma) * (1.0 + 2.0 * x * gamma));
        let (h_a, h_b) = (above_one(mu_a), above_one(mu_b));
        let scattered = (1.0 + surge) * phase + (h_a + h_b + h_a * h_b);
        let diffuse = 0.25 * w * scattered * (shadow * cos_i / (mu_a + mu_b).max(TINY));
        Terms { diffuse, ..Terms::default() }
    }
}
