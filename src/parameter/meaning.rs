//! What parameters stand for: one table of correspondences, by which a material goes from one model to another that
//! calls the same quantity by another name, or measures it on another scale.
//!
//! Each [`Meaning`] leads to a common quantity and back, so that any two parameters with the same quantity correspond.
//! A parameter declares it by [`Parameter::stands_for`](super::Parameter::stands_for), in this crate, in others, and in
//! the files of custom models.

use super::kind::{ParameterKind, Value};
use crate::declared::debug_by;

/// The part of a quantity that differs along and across the tangent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The same in all directions.
    Both,
    /// Along the tangent.
    Along,
    /// Across it, along the bitangent.
    Across,
}

/// A quantity that a parameter stands for, and the scale on which the parameter has it.
#[derive(Clone, Copy)]
pub struct Meaning {
    /// The name in the declarations of custom models.
    pub id: &'static str,
    /// The common quantity. Parameters correspond if it is the same.
    pub quantity: &'static str,
    /// The part of the quantity.
    pub side: Side,
    /// The common quantity by the value of the parameter.
    pub formula: &'static str,
    /// Author, year and title.
    pub source: &'static str,
    /// The common quantity of a value.
    pub to: fn(f64) -> f64,
    /// The inverse of `to`.
    pub from: fn(f64) -> f64,
    /// A parameter of the same model that must be 0 for the formula to hold.
    pub without: Option<&'static str>,
    /// A meaning that makes one material with this one: either alone would be another.
    pub with: Option<&'static Self>,
}

/// Meanings are known by their ids.
impl PartialEq for Meaning {
    fn eq(&self, other: &Self) -> bool {
        self.id == other.id
    }
}

debug_by!(Meaning: id);

impl Meaning {
    /// A meaning with the quantity itself as its scale, the same in all directions.
    ///
    /// ```
    /// use lights_camera_models::parameter::{Meaning, Parameter};
    /// const WETNESS: Meaning = Meaning::of("wetness", "wetness", "w = p/100", "A. Author (2026), A Title")
    ///     .scale(|percent| percent / 100.0, |w| 100.0 * w);
    /// const PERCENT: Parameter = Parameter::number("wet_percent", 0.0..=100.0, 0.0).stands_for(&WETNESS);
    /// assert_eq!(PERCENT.stands_for, Some(&WETNESS));
    /// ```
    #[must_use]
    pub const fn of(
        id: &'static str,
        quantity: &'static str,
        formula: &'static str,
        source: &'static str,
    ) -> Self {
        const SAME: fn(f64) -> f64 = |v| v;
        let side = Side::Both;
        Self { id, quantity, side, formula, source, to: SAME, from: SAME, without: None, with: None }
    }

    /// Sets the scale: the quantity of a value, and the value of a quantity.
    #[must_use]
    pub const fn scale(self, to: fn(f64) -> f64, from: fn(f64) -> f64) -> Self {
        Self { to, from, ..self }
    }

    /// The same scale for one side, under an id of its own.
    #[must_use]
    pub const fn on(self, side: Side, id: &'static str) -> Self {
        Self { id, side, ..self }
    }

    /// Lets the formula hold only where another parameter of the model is 0.
    #[must_use]
    pub const fn without(self, parameter: &'static str) -> Self {
        Self { without: Some(parameter), ..self }
    }

    /// Declares a meaning that makes one material with this one; one of the two declares it.
    ///
    /// ```
    /// use lights_camera_models::parameter::Meaning;
    /// const DYE: Meaning = Meaning::of("dye", "colour of the dye", "C", "A. Author (2026), A Title");
    /// const AMOUNT: Meaning = Meaning::of("dye_amount", "amount of dye", "a", "A. Author (2026), A Title").with(&DYE);
    /// assert!(AMOUNT.belongs_with(&DYE) && DYE.belongs_with(&AMOUNT) && !DYE.belongs_with(&DYE));
    /// ```
    #[must_use]
    pub const fn with(self, other: &'static Self) -> Self {
        Self { with: Some(other), ..self }
    }

    /// True if both have the same quantity, on whatever scale.
    #[must_use]
    pub fn corresponds_to(&self, other: &Self) -> bool {
        self.quantity == other.quantity
    }

    /// True if one of them is declared to make one material with the other.
    #[must_use]
    pub fn belongs_with(&self, other: &Self) -> bool {
        let declares = |a: &Self, b: &Self| a.with.is_some_and(|with| with.corresponds_to(b));
        declares(self, other) || declares(other, self)
    }

    /// The quantity of a value, for red, green and blue; of a colour, its codes. `None` if the value is no number, or
    /// has no finite quantity.
    #[must_use]
    pub fn quantity_of(&self, value: &Value) -> Option<[f64; 3]> {
        let numbers = match value {
            Value::Number(v) => [f64::from(*v); 3],
            Value::Integer(n) => [*n as f64; 3],
            Value::Triple(all) => all.map(f64::from),
            Value::Colour(codes) => codes.map(f64::from),
            _ => return None,
        };
        let quantity = numbers.map(self.to);
        quantity.iter().all(|v| v.is_finite()).then_some(quantity)
    }

    /// The value that has a quantity, for a parameter of this kind; it may lie outside the range. One number is that of
    /// green light. `None` if the kind has no numbers.
    #[must_use]
    pub fn value_of(&self, quantity: [f64; 3], kind: &ParameterKind) -> Option<Value> {
        let numbers = quantity.map(self.from);
        if !numbers.iter().all(|v| v.is_finite()) {
            return None;
        }
        Some(match kind {
            ParameterKind::Number(_) => Value::Number(numbers[1] as f32),
            ParameterKind::Integer(_) => Value::Integer(numbers[1].round() as i64),
            ParameterKind::Triple(_) => Value::Triple(numbers.map(|v| v as f32)),
            ParameterKind::Colour(_) => Value::Colour(numbers.map(|v| v.round().clamp(0.0, 255.0) as u8)),
            _ => return None,
        })
    }
}

/// The width of the lobe.
const LOBE: &str = "width α of the lobe";
/// The reflection of a dielectric.
const F_0: &str = "F_0 of a dielectric";
const WALTER: &str = "B. Walter, S. Marschner, H. Li, K. Torrance (2007), Microfacet Models for Refraction through Rough Surfaces, section 5.2";
const FISHER: &str = "F. Fisher, A. Woo (1994), R·E versus N·H Specular Highlights, Graphics Gems IV, with Walter and others (2007)";
const BURLEY: &str = "B. Burley (2012), Physically-Based Shading at Disney";
const OPENPBR: &str = "Z. Andersson and others (2026), OpenPBR Surface specification 1.1.1";

fn alpha_of_exponent(n: f64) -> f64 {
    (2.0 / (n.max(0.0) + 2.0)).sqrt()
}

fn exponent_of_alpha(alpha: f64) -> f64 {
    (2.0 / (alpha * alpha) - 2.0).max(0.0)
}

/// Blinn–Phong's exponent for one of Phong's.
const PER_PHONG: f64 = 4.0;

macro_rules! meanings {
    ($($(#[$about:meta])* $NAME:ident = $meaning:expr;)+) => {
        $($(#[$about])* pub const $NAME: Meaning = $meaning;)+

        impl Meaning {
            /// The built-in meanings, in the order of the documentation.
            pub const ALL: &'static [&'static Self] = &[$(&$NAME),+];
        }
    };
}

meanings! {
    /// The width α of a distribution of microfacets: GGX, Beckmann, Ward.
    ALPHA_OF_FACETS = Meaning::of("alpha", LOBE, "α", WALTER);
    /// The same along the tangent.
    ALPHA_ALONG = ALPHA_OF_FACETS.on(Side::Along, "alpha_along");
    /// The same across the tangent.
    ALPHA_ACROSS = ALPHA_OF_FACETS.on(Side::Across, "alpha_across");
    /// Perceptual roughness.
    PERCEPTUAL_ROUGHNESS = Meaning::of("roughness", LOBE, "α = r²", BURLEY).scale(|r| r * r, |a| a.max(0.0).sqrt());
    /// The exponent n of `(N·H)^n`.
    BLINN_PHONG_EXPONENT = Meaning::of("blinn_phong_exponent", LOBE, "α = √(2/(n + 2))", WALTER)
        .scale(alpha_of_exponent, exponent_of_alpha);
    /// The same along the tangent.
    EXPONENT_ALONG = BLINN_PHONG_EXPONENT.on(Side::Along, "exponent_along");
    /// The same across the tangent.
    EXPONENT_ACROSS = BLINN_PHONG_EXPONENT.on(Side::Across, "exponent_across");
    /// The exponent n of `(R·V)^n`: a quarter of Blinn–Phong's.
    PHONG_EXPONENT = Meaning::of("phong_exponent", LOBE, "α = √(2/(4n + 2))", FISHER)
        .scale(|n| alpha_of_exponent(PER_PHONG * n), |a| exponent_of_alpha(a) / PER_PHONG);
    /// Strauss's smoothness, of which the exponent of `R·V` follows.
    SMOOTHNESS = Meaning::of(
        "smoothness", LOBE, "α = √(2/(4n + 2)), n = 3/(1 − s)",
        "P. Strauss (1990), A Realistic Lighting Model for Computer Animators, with Fisher and Woo (1994)",
    ).scale(
        |s| alpha_of_exponent(PER_PHONG * 3.0 / (1.0 - s).max(1e-9)),
        |a| 1.0 - 3.0 / (exponent_of_alpha(a) / PER_PHONG).max(3.0),
    );
    /// The angle at which Gaussian facets are rarer by the factor e.
    FACET_ANGLE = Meaning::of(
        "facet_angle", LOBE, "α = β π/180",
        "K. Torrance, E. Sparrow (1967), Theory for Off-Specular Reflection from Roughened Surfaces; tan θ ≈ θ",
    ).scale(f64::to_radians, f64::to_degrees);
    /// Disney's anisotropy, as the quotient of the widths.
    DISNEY_ANISOTROPY = Meaning::of("disney_anisotropy", "α_y/α_x", "α_y/α_x = 1 − 0.9 a", BURLEY)
        .scale(|a| 1.0 - 0.9 * a, |q| (1.0 - q) / 0.9);
    /// OpenPBR's anisotropy, as the quotient of the widths.
    OPENPBR_ANISOTROPY = Meaning::of("openpbr_anisotropy", "α_y/α_x", "α_y/α_x = 1 − a", OPENPBR)
        .scale(|a| 1.0 - a, |q| 1.0 - q);
    /// The roughness of a body that scatters light.
    BODY_ROUGHNESS = Meaning::of(
        "body_roughness", "roughness of the body", "r",
        "J. Portsmouth, P. Kutz, S. Hill (2024), EON: A Practical Energy-Preserving Rough Diffuse BRDF",
    );
    /// The colour of the material itself.
    COLOUR_OF_BASE = Meaning::of("base_colour", "base colour", "C_b", BURLEY);
    /// The colour of highlights.
    COLOUR_OF_HIGHLIGHT = Meaning::of(
        "specular_colour", "specular colour", "C_s",
        "B. T. Phong (1975), Illumination for Computer Generated Pictures",
    );
    /// The fraction of metal. Without it the base colour is that of a body.
    METAL = Meaning::of("metallic", "fraction of metal", "m", BURLEY).with(&COLOUR_OF_BASE);
    /// The refractive index of a dielectric.
    INDEX = Meaning::of(
        "refractive_index", F_0, "F_0 = ((n − 1)/(n + 1))²",
        "A. Fresnel (1823), Mémoire sur la loi des modifications que la réflexion imprime à la lumière polarisée",
    ).scale(|n| ((n - 1.0) / (n + 1.0)).powi(2), index_of).without("extinction");
    /// Reflectance on the scale of Frostbite.
    SQUARED_REFLECTANCE = Meaning::of(
        "reflectance", F_0, "F_0 = 0.16 s²",
        "S. Lagarde, C. de Rousiers (2014), Moving Frostbite to Physically Based Rendering",
    ).scale(|s| 0.16 * s * s, |f| (f.max(0.0) / 0.16).sqrt());
    /// Reflectance on Disney's scale.
    DISNEY_SPECULAR = Meaning::of("disney_specular", F_0, "F_0 = 0.08 s", BURLEY).scale(|s| 0.08 * s, |f| f / 0.08);
    /// The fraction of the surface under a clear coat.
    COAT = Meaning::of("coat_weight", "weight of the coat", "C", OPENPBR);
    /// Disney's clear coat, which reflects at most a quarter of the light that a full one does.
    CLEAR_COAT = Meaning::of("clearcoat", "weight of the coat", "C = c/4", BURLEY).scale(|c| 0.25 * c, |w| 4.0 * w);
    /// The roughness of a coat.
    ROUGHNESS_OF_COAT = Meaning::of("coat_roughness", "width α of the coat", "α = r²", OPENPBR)
        .scale(|r| r * r, |a| a.max(0.0).sqrt());
    /// The gloss of Disney's coat.
    GLOSS_OF_COAT = Meaning::of("coat_gloss", "width α of the coat", "α = 0.1 (1 − g) + 0.001 g", BURLEY)
        .scale(|g| 0.1 - 0.099 * g, |a| (0.1 - a) / 0.099);
    /// The amount of fibres that shine at the rim.
    SHEEN = Meaning::of(
        "sheen", "weight of the sheen", "h",
        "T. Zeltner, B. Burley, M. Chiang (2022), Practical Multiple-Scattering Sheen Using Linearly Transformed Cosines",
    );
    /// The colour of these fibres.
    COLOUR_OF_SHEEN = Meaning::of("sheen_colour", "colour of the sheen", "C_f", OPENPBR);
    /// The disorder of these fibres.
    ROUGHNESS_OF_SHEEN = Meaning::of(
        "sheen_roughness", "roughness of the sheen", "r_f",
        "A. C. Estevez, C. Kulla (2017), Production Friendly Microfacet Sheen BRDF",
    );
    /// The fraction of light that passes instead of being scattered.
    TRANSMISSION = Meaning::of("transmission", "weight of the transmission", "w_τ", OPENPBR);
    /// The colour of light that has passed through.
    COLOUR_OF_TRANSMISSION = Meaning::of(
        "transmission_colour", "colour of transmitted light", "C_t",
        "A. Beer (1852), Bestimmung der Absorption des rothen Lichts in farbigen Flüssigkeiten",
    );
    /// The path after which light has that colour, in metres.
    DEPTH_OF_TRANSMISSION = Meaning::of(
        "transmission_depth", "depth of the colour", "d",
        "A. Beer (1852), Bestimmung der Absorption des rothen Lichts in farbigen Flüssigkeiten",
    );
}

/// The refractive index above 1 with a reflectance at normal incidence.
fn index_of(f0: f64) -> f64 {
    let root = f0.clamp(0.0, 1.0).sqrt();
    (1.0 + root) / (1.0 - root)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optics::{equivalence, fresnel::normal_reflectance};

    #[test]
    fn every_correspondence_has_an_id_a_formula_and_a_source_with_a_year() {
        for (i, one) in Meaning::ALL.iter().enumerate() {
            assert!(Meaning::ALL[..i].iter().all(|other| other.id != one.id), "{}", one.id);
            assert!(!one.formula.is_empty() && !one.quantity.is_empty(), "{}", one.id);
            let year = |word: &str| {
                let digits = word.trim_matches(|c: char| !c.is_ascii_digit());
                digits.len() == 4 && digits.parse::<u32>().is_ok_and(|year| (1800..2100).contains(&year))
            };
            assert!(one.source.split_whitespace().any(year), "{}: {}", one.id, one.source);
        }
    }

    #[test]
    fn every_scale_leads_back() {
        for one in Meaning::ALL {
            let values: &[f64] = match one.id {
                "phong_exponent" | "blinn_phong_exponent" | "exponent_along" | "exponent_across" => {
                    &[1.0, 32.0, 512.0]
                }
                "refractive_index" => &[1.1, 1.5, 2.4],
                "facet_angle" => &[0.5, 12.0, 60.0],
                _ => &[0.1, 0.5, 0.9],
            };
            for v in values {
                let back = (one.from)((one.to)(*v));
                assert!((back - v).abs() < 1e-9 * v.abs().max(1.0), "{}: {v} → {back}", one.id);
            }
        }
    }

    #[test]
    fn the_scales_are_those_of_the_functions_that_models_use() {
        for n in [1.0f32, 32.0, 200.0] {
            let near = |a: f64, b: f32| (a - f64::from(b)).abs() < 1e-6;
            let blinn = equivalence::alpha_of_exponent(n);
            assert!(near((BLINN_PHONG_EXPONENT.to)(n.into()), blinn), "{n}");
            let phong = equivalence::alpha_of_exponent(equivalence::blinn_of_phong(n));
            assert!(near((PHONG_EXPONENT.to)(n.into()), phong), "{n}");
            // A quarter the other way round fails.
            assert!(!near((PHONG_EXPONENT.to)(n.into()), equivalence::alpha_of_exponent(n / 4.0)), "{n}");
            assert!(near((PERCEPTUAL_ROUGHNESS.from)(blinn.into()), equivalence::roughness_of_alpha(blinn)));
        }
        for n in [1.33f32, 1.5, 2.4] {
            assert!(((INDEX.to)(n.into()) - f64::from(normal_reflectance(n, 0.0))).abs() < 1e-6, "{n}");
        }
        // An index of 1.5 reflects 4 %, which is 0.5 on both scales of reflectance.
        let f0 = (INDEX.to)(1.5);
        assert!(((SQUARED_REFLECTANCE.from)(f0) - 0.5).abs() < 1e-12);
        assert!(((DISNEY_SPECULAR.from)(f0) - 0.5).abs() < 1e-12);
    }

    #[test]
    fn numbers_colours_and_triples_keep_their_kind() {
        use crate::parameter::{ALPHA, BASE_COLOUR, IOR, METALLIC};
        let green = INDEX.quantity_of(&Value::Triple([1.4, 1.5, 1.6])).expect("finite");
        assert_eq!(INDEX.value_of(green, &METALLIC.kind), Some(Value::Number(1.5)));
        assert_eq!(INDEX.value_of(green, &IOR.kind), Some(Value::Triple([1.4, 1.5, 1.6])));
        let colour = COLOUR_OF_BASE.quantity_of(&Value::Colour([1, 2, 255])).expect("finite");
        assert_eq!(COLOUR_OF_BASE.value_of(colour, &BASE_COLOUR.kind), Some(Value::Colour([1, 2, 255])));
        assert_eq!(BLINN_PHONG_EXPONENT.value_of([0.25; 3], &ALPHA.kind), Some(Value::Integer(30)));
        assert_eq!(INDEX.quantity_of(&Value::flag(true)), None);
        assert_eq!(INDEX.value_of([1.0; 3], &METALLIC.kind), None, "no index reflects everything");
        assert_eq!(BLINN_PHONG_EXPONENT.value_of([0.0; 3], &ALPHA.kind), None);
    }
}
