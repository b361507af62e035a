//! OpenPBR's transmission: through a thin sheet, and through the boundary of a solid body.

use std::f32::consts::PI;

use glam::Vec3;

use super::{BOUNCES, OpenPbr, Prepared, facets, fraction, missing};
use crate::{
    optics::{
        absorption,
        dispersion::cauchy_of_abbe,
        distribution::MINIMUM_ALPHA,
        fresnel::dielectric,
        interior::Interior,
        lobes::{Lobe, Lobes, MAX_LOBES},
        refraction::refracted_cosine,
        sharp::Sharp,
        slab::{Slab, oblique, slab},
    },
    parameter::{Parameter, Values},
    reflection::Passage,
};

/// The cosine at which light that meets several facets passes a boundary: the mean over evenly arriving light,
/// ∫ μ² dμ/∫ μ dμ.
const SCATTERED: f32 = 2.0 / 3.0;

const THIN: &str = "geometry_thin_walled";
pub(super) const TRANSMISSION_WEIGHT: Parameter = fraction("transmission_weight", 0.0)
    .symbol("w_τ")
    .label("transmission")
    .help("The fraction of the non-metallic base that is clear: light passes through it instead of being scattered in the body.");
pub(super) const TRANSMISSION_COLOUR: Parameter = Parameter::colour("transmission_colour", [255; 3])
    .symbol("C_τ")
    .label("colour of the transmitted light")
    .help("The colour of white light after the depth below, inside the object. At depth 0 the surface tints, wherever light enters or leaves; a thin wall does so at its single crossing.");
pub(super) const TRANSMISSION_DEPTH: Parameter = Parameter::number("transmission_depth", 0.0..=100.0, 0.0)
    .symbol("d_τ")
    .label("depth of the colour")
    .unit("m")
    .help("The length of way inside after which white light has the transmission colour. 0 absorbs nothing: then the colour tints at the surface.")
    .used_when(THIN, &["false"]);
pub(super) const DISPERSION_SCALE: Parameter = fraction("transmission_dispersion_scale", 0.0)
    .symbol("s_τ")
    .label("dispersion")
    .help("How much more blue light is bent than red: 0 nothing, 1 as much as the Abbe number says.")
    .used_when(THIN, &["false"]);
pub(super) const ABBE_NUMBER: Parameter = Parameter::number("transmission_dispersion_abbe_number", 1.0..=100.0, 20.0)
    .symbol("V_d")
    .label("Abbe number")
    .help("The dispersion of the material at full scale; small numbers disperse more. Glass has 20 to 90, water and diamond 55.")
    .used_when(THIN, &["false"]);
pub(super) const THIN_WALLED: Parameter = Parameter::flag(THIN, false)
    .label("thin-walled")
    .help("A sheet without an inside, such as a window or a bubble: light goes straight through. Otherwise the object is solid, and light is bent in it.");
/// How light passes through surfaces with these parameters.
pub(super) fn passage_with(values: &Values) -> Passage {
    passage(values.number(&TRANSMISSION_WEIGHT), values.choice(&THIN_WALLED) != 0)
}

/// The same, from the two parameters that decide it.
pub(super) fn passage(weight: f32, thin: bool) -> Passage {
    match (weight > 0.0, thin) {
        (false, _) => Passage::NONE,
        (true, true) => Passage::SHEET,
        (true, false) => Passage::BODY,
    }
}

impl Prepared {
    /// True if the boundary does not spread the light that passes.
    fn is_smooth(&self) -> bool {
        self.alpha <= MINIMUM_ALPHA
    }

    /// The refractive index of a solid body, within the limits of arithmetic.
    fn ior(&self) -> f32 {
        self.indices.y.clamp(0.1, 10.0)
    }
}

impl OpenPbr {
    /// What a thin sheet between two such boundaries reflects and transmits.
    pub(super) fn sheet(&self, boundary: Vec3, cos_d: f32) -> Slab {
        let inside = refracted_cosine(cos_d, self.prepared.indices.y);
        slab(boundary, oblique(self.transmission_colour, inside))
    }

    /// The sheet for light that meets several facets.
    pub(super) fn scattering_sheet(&self) -> Slab {
        self.sheet(self.boundary(SCATTERED), SCATTERED)
    }

    /// The part of the light from below the base that passes the layers above it, towards a viewer at a cosine.
    pub(super) fn above(&self, mu: f32) -> Vec3 {
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

    /// The light that bounces between facets, `π f cos θ_l`, before it is coloured: what single reflection loses.
    pub(super) fn bounced(&self, l: Vec3, v: Vec3) -> f32 {
        let [of_l, of_v] = [l, v].map(|d| missing(self.boundaries.at(d.z).x));
        let shape = of_v * of_l * l.z / missing(self.boundaries.mean().x).max(1e-6);
        shape.min(1.0)
    }

    /// The response to light behind a thin sheet, for its direction mirrored to the side of the viewer.
    pub(super) fn through_sheet(&self, l: Vec3, v: Vec3) -> Vec3 {
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
    pub(super) fn straight_through(&self, v: Vec3, mu: f32) -> Option<Sharp> {
        let p = &self.prepared;
        if p.sheet <= 0.0 || !p.is_smooth() || mu <= 0.0 {
            return None;
        }
        let passed = (1.0 - self.metallic) * p.sheet * self.sheet(self.boundary(mu), mu).transmittance;
        Some(Sharp::transmitted(-v, self.above(mu) * passed))
    }

    /// The inside of a body.
    pub(super) fn inside(&self) -> Interior {
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

    /// The part of the light from within a body that enters it at a cosine and leaves it elsewhere, over that of a body
    /// without coat, film and tint.
    pub(super) fn entered(&self, mu: f32) -> Vec3 {
        let p = &self.prepared;
        // The way inside begins at the boundary of the body to air: what the coat and the film change about that.
        let at = if p.is_smooth() { mu } else { SCATTERED };
        let bare = (1.0 - dielectric(p.ior(), at)).max(1e-6);
        let entered = (Vec3::ONE - self.boundary(at)) / bare;
        // The coat colours the light once more where it leaves, as at this angle.
        let left = if self.coat_weight > 0.0 { self.through_coat(mu) } else { Vec3::ONE };
        let tint = if self.transmission_depth > 0.0 { Vec3::ONE } else { self.transmission_colour };
        (1.0 - self.metallic) * self.transmission_weight * self.above(mu) * entered * left * tint * tint
    }

    /// The lobes of reflection, with that of a rough sheet: as many as there is room for.
    pub(super) fn lobes_beside(&self, reflected: Lobes) -> Lobes {
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
