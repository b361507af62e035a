use std::f32::consts::{FRAC_1_PI, PI};

use glam::{Vec2, Vec3};

use super::{Declaration, Factor, Group, Measured, Readout, ReflectionModel, built_in, preset};
use crate::{
    optics::{
        Frame, Terms,
        colour::luminance,
        diffuse::burley,
        distribution::{MINIMUM_ALPHA, ggx, gtr},
        fresnel::{schlick, schlick_weight},
        geometry::half_vector,
        lobes::{self, Lobe, Lobes},
        masking::{separable, smith_ggx},
    },
    parameter::{BASE_COLOUR, METALLIC, Parameter, ROUGHNESS, Value, meaning},
    parameters,
};

const SUBSURFACE: Parameter = Parameter::number("subsurface", 0.0..=1.0, 0.0)
    .symbol("s_s")
    .help("From 0, light scattered at the surface, to 1, an approximation of subsurface scattering: flatter shading, like skin, wax or marble seen from afar.");
const SPECULAR: Parameter = Parameter::number("specular", 0.0..=1.0, 0.5)
    .symbol("s")
    .help("The reflectance of the non-metallic part at normal incidence: 0.08 s. 0.5 gives 4 %, typical of plastic and glass.")
    .stands_for(&meaning::DISNEY_SPECULAR);
const SPECULAR_TINT: Parameter = Parameter::number("specular_tint", 0.0..=1.0, 0.0)
    .symbol("s_t")
    .label("specular tint")
    .help("The amount by which non-metallic reflection takes the hue of the base colour. Not physical; for effect.");
const ANISOTROPIC: Parameter = Parameter::number("anisotropic", 0.0..=1.0, 0.0)
    .symbol("a")
    .help("From 0, isotropic, to 1, highlights stretched along the tangent, as on brushed metal: ten times as long as across.")
    .stands_for(&meaning::DISNEY_ANISOTROPY);
const SHEEN: Parameter = Parameter::number("sheen", 0.0..=1.0, 0.0)
    .symbol("h")
    .help("A bright rim at grazing angles, as from the fibres of cloth. Adds light.")
    .stands_for(&meaning::SHEEN);
const SHEEN_TINT: Parameter = Parameter::number("sheen_tint", 0.0..=1.0, 0.5)
    .symbol("h_t")
    .label("sheen tint")
    .help("The amount by which the sheen takes the hue of the base colour: 0 is white.");
const CLEARCOAT: Parameter = Parameter::number("clearcoat", 0.0..=1.0, 0.0)
    .symbol("c")
    .label("clear coat")
    .help("The strength of a second, colourless layer of lacquer (refractive index 1.5, at most a quarter of its full reflection). Adds light.")
    .stands_for(&meaning::CLEAR_COAT);
const CLEARCOAT_GLOSS: Parameter = Parameter::number("clearcoat_gloss", 0.0..=1.0, 1.0)
    .symbol("c_g")
    .label("gloss of the coat")
    .help("From 0, a satin coat, to 1, a glossy one: its width is 0.1 to 0.001.")
    .stands_for(&meaning::GLOSS_OF_COAT);

parameters! {
    /// **Disney** — B. Burley's "principled" model: few intuitive parameters, all from 0 to 1, every combination
    /// plausible.
    ///
    /// ```text
    /// f_r = (1 − m) (((1 − s_s) f_d + s_s f_s) C_b/π + h F_H C_h) + D_s F_s G_s + c/4 D_r F_r G_r
    /// F_H = (1 − L·H)⁵, F_L and F_V alike of N·L and N·V
    /// f_d = (1 + (F_90 − 1) F_L)(1 + (F_90 − 1) F_V),   F_90 = 1/2 + 2 r (L·H)²
    /// f_s = 1.25 (f (1/(N·L + N·V) − 1/2) + 1/2),   f as f_d with F_90 = r (L·H)²
    /// D_s = 1 / (π α_x α_y ((H·T/α_x)² + (H·B/α_y)² + (N·H)²)²)
    /// α_x = max(0.001, r²/q), α_y = max(0.001, r² q), q = √(1 − 0.9 a)
    /// F_s = C_0 + (1 − C_0) F_H,   C_0 = (1 − m) 0.08 s ((1 − s_t) + s_t C_t) + m C_b
    /// D_r = (w² − 1) / (π ln w² (1 + (w² − 1)(N·H)²)),   w = 0.1 (1 − c_g) + 0.001 c_g
    /// F_r = 0.04 + 0.96 F_H,   G_r with α = 0.25
    /// G = g(L) g(V),   g(X) = 1/(N·X + √((α_x X·T)² + (α_y X·B)² + (N·X)²))
    /// C_t = C_b / luminance,   C_h = (1 − h_t) + h_t C_t
    /// ```
    ///
    /// | parameter | symbol | unit | range | default |
    /// |---|---|---|---|---|
    /// | `base_colour` | C_b | sRGB | 0–255 | white |
    /// | `metallic` | m | – | 0–1 | 0 |
    /// | `subsurface` | s_s | – | 0–1 | 0 |
    /// | `specular` | s | – | 0–1 | 0.5 |
    /// | `roughness` | r | – | 0–1 | 0.5 |
    /// | `specular_tint` | s_t | – | 0–1 | 0 |
    /// | `anisotropic` | a | – | 0–1 | 0 |
    /// | `sheen` | h | – | 0–1 | 0 |
    /// | `sheen_tint` | h_t | – | 0–1 | 0.5 |
    /// | `clearcoat` | c | – | 0–1 | 0 |
    /// | `clearcoat_gloss` | c_g | – | 0–1 | 1 |
    ///
    /// Source: B. Burley (2012), *Physically-Based Shading at Disney*, SIGGRAPH course. Details that the notes leave
    /// open follow Disney's BRDF Explorer: the luminance 0.3 R + 0.6 G + 0.1 B, the factor 1.25 that keeps the albedo
    /// of the subsurface term, which is flattened after P. Hanrahan and W. Krueger (1993). The notes use (1/2 + r/2)²
    /// instead of r in G; the Explorer's program uses r², as does this model (B. Burley 2015, *Extending the Disney
    /// BRDF to a BSDF*, dropped the change too). G here is the quotient `G/(4 (N·L)(N·V))` of other models.
    ///
    /// **When to use it**: for cloth (sheen), car paint (clear coat), brushed metal (anisotropic), skin from afar
    /// (subsurface). With these at 0 it is close to `metallic_roughness` except for the diffuse part, which brightens
    /// towards the rim of rough objects and darkens on smooth ones, like measured materials.
    ///
    /// **Laws**: reciprocal and non-negative. Energy is not conserved: the diffuse part of a rough surface alone
    /// reflects up to 1.4 times the light at grazing angles, and highlight, sheen and coat are added without reducing
    /// the layers below. The aim was plausible pictures.
    pub struct Disney {
        /// `C_b`, linear.
        base_colour: colour = BASE_COLOUR,
        /// `m`.
        metallic: number = METALLIC,
        /// `s_s`.
        subsurface: number = SUBSURFACE,
        /// `s`.
        specular: number = SPECULAR,
        /// `r`.
        roughness: number = ROUGHNESS,
        /// `s_t`.
        specular_tint: number = SPECULAR_TINT,
        /// `a`.
        anisotropic: number = ANISOTROPIC,
        /// `h`.
        sheen: number = SHEEN,
        /// `h_t`.
        sheen_tint: number = SHEEN_TINT,
        /// `c`.
        clearcoat: number = CLEARCOAT,
        /// `c_g`.
        clearcoat_gloss: number = CLEARCOAT_GLOSS,
    }
}

impl Disney {
    /// The base colour scaled to luminance 1: its hue; white for black.
    fn tint(&self) -> Vec3 {
        let luminance = self.base_colour.dot(Vec3::new(0.3, 0.6, 0.1));
        if luminance > 0.0 { self.base_colour / luminance } else { Vec3::ONE }
    }

    fn f0(&self) -> Vec3 {
        let dielectric = 0.08 * self.specular * Vec3::ONE.lerp(self.tint(), self.specular_tint);
        dielectric.lerp(self.base_colour, self.metallic)
    }

    /// The roughness along and across the tangent; the first may exceed 1.
    fn alpha(&self) -> Vec2 {
        let alpha = self.roughness * self.roughness;
        let aspect = (1.0 - 0.9 * self.anisotropic).sqrt();
        Vec2::new(alpha / aspect, alpha * aspect).max(Vec2::splat(MINIMUM_ALPHA))
    }

    /// `w`.
    fn coat_width(&self) -> f32 {
        0.1 + (0.001 - 0.1) * self.clearcoat_gloss
    }
}

/// The factor of the subsurface term on `C_b/π`.
fn flattened(cos_l: f32, cos_v: f32, cos_d: f32, roughness: f32) -> f32 {
    let f90 = cos_d * cos_d * roughness;
    let rim = |cosine: f32| 1.0 + (f90 - 1.0) * schlick_weight(cosine);
    1.25 * (rim(cos_l) * rim(cos_v) * (1.0 / (cos_l + cos_v) - 0.5) + 0.5)
}

impl ReflectionModel for Disney {
    const GROUPS: &'static [Group] = &[
        Group::new("Base", &["base_colour", "metallic", "subsurface"]),
        Group::new("Specular", &["specular", "specular_tint", "roughness", "anisotropic"]),
        Group::new("Sheen", &["sheen", "sheen_tint"]),
        Group::new("Clear coat", &["clearcoat", "clearcoat_gloss"]),
    ];

    const DECLARATION: Declaration =
        built_in!("disney", "Disney", Standard).ambient_by_albedo().anisotropic();

    fn response(&self, l: Vec3, v: Vec3, frame: &Frame) -> Terms {
        let (l, v) = (frame.to_local(l), frame.to_local(v));
        let (cos_l, cos_v) = (l.z, v.z);
        // Below the surface, or at such a grazing angle that the quotients would leave the range of f32.
        if cos_l.min(cos_v) < 1e-9 {
            return Terms::default();
        }
        let h = half_vector(l, v);
        // L·H without cancellation.
        let cos_d = 0.5 * (l + v).length();
        let fresnel = schlick_weight(cos_d);

        let scattered = burley(cos_l, cos_v, cos_d, self.roughness);
        let below = flattened(cos_l, cos_v, cos_d, self.roughness);
        let diffuse = scattered + self.subsurface * (below - scattered);
        let sheen = self.sheen * fresnel * Vec3::ONE.lerp(self.tint(), self.sheen_tint);
        let body = FRAC_1_PI * diffuse * self.base_colour + sheen;

        // Disney's G is the visibility: it contains the quotient of Smith's term and the cosines.
        let lobe =
            |d: f32, alpha: Vec2| d * separable(cos_l, cos_v, smith_ggx(l, alpha), smith_ggx(v, alpha));
        let alpha = self.alpha();
        let f0 = self.f0();
        let main = lobe(ggx(h, alpha), alpha) * (f0 + (Vec3::ONE - f0) * fresnel);
        // Its distribution has a power, which would take as long as the rest.
        let coat = if self.clearcoat > 0.0 {
            let lobe = lobe(gtr(h, Vec2::splat(self.coat_width()), 1.0), Vec2::splat(0.25));
            0.25 * self.clearcoat * (lobe * (0.04 + 0.96 * fresnel))
        } else {
            0.0
        };
        Terms::of(PI * cos_l * (1.0 - self.metallic) * body, PI * cos_l * (main + coat))
    }

    fn lobes(&self) -> Lobes {
        let alpha = self.alpha();
        let weight = schlick_weight(lobes::OBLIQUE);
        let base = schlick(self.f0(), lobes::OBLIQUE);
        let coat = (
            Lobe::of_gtr(Vec2::splat(self.coat_width()), 1.0),
            0.25 * self.clearcoat * (0.04 + 0.96 * weight),
        );
        let body = (1.0 - self.metallic) * (self.base_colour + self.sheen * Vec3::ONE);
        Lobes::coated(coat, Lobe::wide(alpha), body, base)
    }

    fn readouts(&self) -> Vec<Readout> {
        vec![Readout::of_f0(self.f0()), Readout::of_alpha(self.roughness * self.roughness)]
    }

    /// The factors of the main lobe, without the clear coat.
    fn factor(&self, factor: Factor) -> Option<Vec3> {
        let alpha = self.alpha();
        factor.by(
            |cos_d| schlick(self.f0(), cos_d),
            |h| ggx(h, alpha),
            |l, v| separable(l.z, v.z, smith_ggx(l, alpha), smith_ggx(v, alpha)),
        )
    }

    fn preset(material: &Measured) -> Vec<(&'static str, Value)> {
        if material.metal {
            return preset::base_colour_metallic(material);
        }
        // At most 1, F_0 = 8 %: diamond's 17 % are out of range.
        let specular = preset::fraction(luminance(material.f0) / 0.08);
        vec![(METALLIC.name, Value::Number(0.0)), (SPECULAR.name, specular)]
    }
}
