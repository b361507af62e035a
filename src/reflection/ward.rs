use glam::{Vec2, Vec3};

use super::{Declaration, ReflectionModel, built_in};
use crate::{
    optics::{
        Frame, Terms,
        geometry::half_slope,
        lobes::{Lobe, Lobes},
    },
    parameter::{ALPHA_X, ALPHA_Y, BASE_COLOUR, K_S, Parameter, SPECULAR_COLOUR},
    parameters,
};

/// The division of the lobe by the cosines of light and view.
const WARD_FORM: Parameter = Parameter::choice(
    "ward_form",
    &[("ward", "Ward 1992"), ("duer", "Dür 2006")],
    0,
)
.symbol("")
.label("form")
.help("As published by Ward, the highlight fades at grazing angles; Dür's division by both cosines brightens it there, beyond the incident light.");

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
    const DECLARATION: Declaration = built_in!("ward", "Ward", Classical).ambient_by_albedo().anisotropic();

    fn response(&self, l: Vec3, v: Vec3, frame: &Frame) -> Terms {
        let Some((cos_l, cos_v)) = frame.cosines(l, v) else { return Terms::default() };
        let slope = half_slope(l, v, frame);
        let lobe = (-(slope.x / self.alpha_x).powi(2) - (slope.y / self.alpha_y).powi(2)).exp()
            / (4.0 * self.alpha_x * self.alpha_y);
        // π cos θ_l / π over the cosines.
        let cosines = match self.ward_form {
            0 => (cos_l / cos_v.max(1e-12)).sqrt(),
            _ => 1.0 / cos_v.max(1e-12),
        };
        let diffuse = (1.0 - self.k_s) * cos_l * self.base_colour;
        let specular = self.k_s * lobe * cosines * self.specular_colour;
        Terms::of(diffuse, specular)
    }

    fn lobes(&self) -> Lobes {
        let highlight = Lobe::wide(Vec2::new(self.alpha_x, self.alpha_y));
        Lobes::diffuse_and(highlight, (1.0 - self.k_s) * self.base_colour, self.k_s * self.specular_colour)
    }
}
