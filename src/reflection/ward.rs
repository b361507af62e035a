use glam::{Vec2, Vec3};

use super::{Ambient, Declaration, EquationPart, Family, Laws, Quantity, ReflectionModel, Term};
use crate::{
    optics::{
        Frame, Terms,
        geometry::half_slope,
        lobes::{Lobe, Lobes},
    },
    parameter::{ALPHA_X, ALPHA_Y, BASE_COLOUR, K_S, Parameter, ParameterKind, SPECULAR_COLOUR},
    parameters,
    shader::wgsl,
};

/// The division of the lobe by the cosines of light and view.
const WARD_FORM: Parameter = Parameter {
    name: "ward_form",
    symbol: "",
    label: "form",
    unit: "",
    help: "As published by Ward, the highlight fades at grazing angles; Dür's division by both cosines brightens it there, beyond the incident light.",
    kind: ParameterKind::Choice { options: &[("ward", "Ward 1992"), ("duer", "Dür 2006")], default: 0 },
    used_when: None,
};

parameters! {
    /// **Ward** — a Gaussian highlight, stretched on brushed surfaces.
    ///
    /// ```text
    /// f_r = ρ_d/π + ρ_s exp(−(x²/α_x² + y²/α_y²)) / (4π α_x α_y √(N·L N·V))      form "ward"
    /// f_r = ρ_d/π + ρ_s exp(−(x²/α_x² + y²/α_y²)) / (4π α_x α_y N·L N·V)         form "duer"
    /// x = H·T / H·N,  y = H·B / H·N;  ρ_d = (1 − k_s) C_b,  ρ_s = k_s C_s
    /// ```
    ///
    /// | parameter | symbol | unit | range | default |
    /// |---|---|---|---|---|
    /// | `base_colour` | C_b | sRGB | 0–255 | white |
    /// | `specular_colour` | C_s | sRGB | 0–255 | white |
    /// | `k_s` | k_s | – | 0–1 | 0.5 |
    /// | `alpha_x` | α_x | – | 0.001–1 | 0.3 |
    /// | `alpha_y` | α_y | – | 0.001–1 | 0.3 |
    /// | `ward_form` | – | – | `ward`, `duer` | `ward` |
    ///
    /// Source: G. J. Ward (1992), *Measuring and Modeling Anisotropic Reflection*, SIGGRAPH '92; the other form: A. Dür
    /// (2006), *An Improved Normalization for the Ward Reflectance Model*, journal of graphics tools 11(1). x and y are
    /// the slopes of the facet that mirrors L to V, so x² + y² = tan² θ_h; α_x and α_y are their root mean squares,
    /// times √2. Ward chose the constants so that few numbers, read off a measurement, suffice; he requires ρ_d + ρ_s ≤
    /// 1, which the division by k_s ensures.
    ///
    /// Use it for brushed metal and varnished wood, and to compare with its corrected successors. It has no Fresnel
    /// factor and no masking. Reciprocal. Not energy conserving: for a grazing view, Ward's form grows like 1/√cos θ,
    /// beyond 1 on anisotropic surfaces, and loses light elsewhere; Dür's is right for small α (E = 1) and grows like
    /// 1/cos θ near grazing angles (α = 0.3: E = 1.161 at cos θ = 0.1).
    pub struct Ward {
        /// `C_b`, linear.
        base_colour: colour = BASE_COLOUR,
        /// `C_s`, linear.
        specular_colour: colour = SPECULAR_COLOUR,
        /// `k_s`.
        k_s: number = K_S,
        /// `α_x`.
        alpha_x: number = ALPHA_X,
        /// `α_y`.
        alpha_y: number = ALPHA_Y,
        /// 0: Ward's form, 1: Dür's.
        ward_form: choice = WARD_FORM,
    }
}

impl ReflectionModel for Ward {
    const DECLARATION: Declaration = Declaration {
        id: "ward",
        name: "Ward",
        family: Family::Classical,
        author: "G. J. Ward 1992",
        source: "G. J. Ward (1992), Measuring and Modeling Anisotropic Reflection, SIGGRAPH '92, 265–272; A. Dür (2006), An Improved Normalization for the Ward Reflectance Model, journal of graphics tools 11(1), 51–59",
        summary: "A Gaussian highlight made to fit measurements, stretched on brushed surfaces. Dür's form conserves the light of small highlights and gains light at grazing angles.",
        synonyms: &["anisotropic", "brushed metal", "Beckmann"],
        equation: &[
            EquationPart { term: Term::Total, text: "I = I_d + I_s" },
            EquationPart { term: Term::Diffuse, text: "I_d = (1 − k_s) C_b N·L" },
            EquationPart {
                term: Term::Specular,
                text: "I_s = k_s C_s exp(−(x^2/α_x^2 + y^2/α_y^2)) / (4 α_x α_y) c",
            },
            EquationPart { term: Term::Specular, text: "x = tan θ_h cos φ_h, y = tan θ_h sin φ_h" },
        ],
        quantities: &[
            Quantity::new("c = √(N·L / N·V)", "division by the roots of both cosines, times N·L")
                .when(&[("ward_form", &["ward"])]),
            Quantity::new("c = 1/N·V", "division by both cosines, times N·L")
                .source("A. Dür 2006")
                .when(&[("ward_form", &["duer"])]),
        ],
        laws: Laws { reciprocal: true, energy_conserving: false, non_negative: true },
        ambient: Ambient::Albedo,
        anisotropic: true,
        wgsl: wgsl!("reflection/ward.wgsl"),
    };

    fn response(&self, l: Vec3, v: Vec3, frame: &Frame) -> Terms {
        let (cos_l, cos_v) = (frame.n.dot(l), frame.n.dot(v));
        if cos_l <= 0.0 || cos_v <= 0.0 {
            return Terms::default();
        }
        let slope = half_slope(l, v, frame);
        let lobe = (-(slope.x / self.alpha_x).powi(2) - (slope.y / self.alpha_y).powi(2)).exp()
            / (4.0 * self.alpha_x * self.alpha_y);
        // π cos θ_l / π over the cosines.
        let cosines = match self.ward_form {
            0 => (cos_l / cos_v.max(1e-12)).sqrt(),
            _ => 1.0 / cos_v.max(1e-12),
        };
        Terms {
            ambient: Vec3::ZERO,
            diffuse: (1.0 - self.k_s) * cos_l * self.base_colour,
            specular: self.k_s * lobe * cosines * self.specular_colour,
        }
    }

    fn lobes(&self) -> Lobes {
        let highlight = Lobe::wide(Vec2::new(self.alpha_x, self.alpha_y));
        Lobes::diffuse_and(highlight, (1.0 - self.k_s) * self.base_colour, self.k_s * self.specular_colour)
    }
}
