//! Measured materials: optical constants from which models set their parameters.
//!
//! A model that can represent measured materials returns from
//! [`ReflectionModel::preset`](super::ReflectionModel::preset) the result of one of the functions here, perhaps with
//! additions: [`conductor`], [`base_colour_metallic`], [`colour`].

use std::{collections::BTreeMap, sync::LazyLock};

use glam::Vec3;
use serde::Deserialize;

use crate::{
    optics::colour::{luminance, srgb_encode8},
    parameter::{BASE_COLOUR, EXTINCTION, IOR, METALLIC, Parameter, REFLECTANCE, Value},
};

/// A material with a measured refractive index.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// Name in files: lower case, underscores.
    pub id: &'static str,
    /// Display name.
    pub name: &'static str,
    /// True for a metal: opaque, with the colour of its reflection.
    pub metal: bool,
    /// Refractive index n at 630, 532 and 465 nm.
    pub n: [f32; 3],
    /// Extinction coefficient k at the same wavelengths; almost 0 for dielectrics.
    pub k: [f32; 3],
    /// Unpolarised reflectance at normal incidence, linear sRGB under D65, clamped to [0, 1].
    pub f0: Vec3,
    /// The reflectance at 82° (the cosine 1/7).
    pub f82: Vec3,
    /// The source of the measurement and its publication.
    pub source: &'static str,
}

const CONSTANTS: &str = include_str!("../../assets/data/optical_constants.csv");
const SOURCES: &str = include_str!("../../assets/data/optical_constants_sources.json");

/// The second file's data about a row of the first.
#[derive(Deserialize)]
struct Origin {
    name: &'static str,
    metal: bool,
    source: &'static str,
}

/// Every measured material, metals first, each group by name. `assets/data/README.md` names the sources of the numbers.
#[must_use]
pub fn all() -> &'static [Measured] {
    static ALL: LazyLock<Vec<Measured>> = LazyLock::new(|| {
        // An unreadable row is skipped; a test ensures that there is none.
        let mut all: Vec<_> = read(CONSTANTS, SOURCES).into_iter().flatten().collect();
        all.sort_by_key(|m| (!m.metal, m.name));
        all
    });
    &ALL
}

/// The material with this id.
#[must_use]
pub fn by_id(id: &str) -> Option<&'static Measured> {
    all().iter().find(|m| m.id == id)
}

/// One entry for each row of the table; `None` where a column or the origin is missing.
fn read(constants: &'static str, sources: &'static str) -> Vec<Option<Measured>> {
    let origins: BTreeMap<&str, Origin> = serde_json::from_str(sources).unwrap_or_default();
    let mut lines = constants.lines();
    let header: Vec<_> = lines.next().unwrap_or_default().split(',').collect();
    let row = |line: &'static str| {
        let cells: Vec<&'static str> = line.split(',').collect();
        let cell = |column: &str| cells.get(header.iter().position(|h| *h == column)?).copied();
        let number = |column: &str| cell(column)?.parse::<f32>().ok().filter(|v| v.is_finite());
        let three = |[r, g, b]: [&str; 3]| Some([number(r)?, number(g)?, number(b)?]);
        let reflectance = |columns| Some(Vec3::from(three(columns)?).clamp(Vec3::ZERO, Vec3::ONE));
        let id = cell("name")?;
        let origin = origins.get(id)?;
        Some(Measured {
            id,
            name: origin.name,
            metal: origin.metal,
            n: three(["n630", "n532", "n465"])?,
            k: three(["k630", "k532", "k465"])?,
            f0: reflectance(["F0_R", "F0_G", "F0_B"])?,
            f82: reflectance(["F82_R", "F82_G", "F82_B"])?,
            source: origin.source,
        })
    };
    lines.map(row).collect()
}

/// For models with the Fresnel equations of conductors: [`IOR`] and [`EXTINCTION`]. Dielectrics get k = 0, since their
/// real one (10⁻⁸) makes no difference at the surface.
#[must_use]
pub fn conductor(material: &Measured) -> Vec<(&'static str, Value)> {
    let k = if material.metal { material.k } else { [0.0; 3] };
    vec![(IOR.name, Value::Triple(material.n)), (EXTINCTION.name, Value::Triple(k))]
}

/// For models with base colour and metalness. A metal gets its reflectance at normal incidence as [`BASE_COLOUR`] and
/// [`METALLIC`] 1. Anything else gets [`METALLIC`] 0 and the [`REFLECTANCE`] s of `F_0 = 0.16 s²`, by luminance, at
/// most 1 (diamond's 17 % become 16 %); its base colour stays, since that depends on pigments, not on the refractive
/// index.
#[must_use]
pub fn base_colour_metallic(material: &Measured) -> Vec<(&'static str, Value)> {
    if material.metal {
        vec![(BASE_COLOUR.name, colour(material.f0)), (METALLIC.name, Value::Number(1.0))]
    } else {
        let s = (luminance(material.f0) / 0.16).sqrt();
        vec![(METALLIC.name, Value::Number(0.0)), (REFLECTANCE.name, fraction(s))]
    }
}

/// Returns the function that sets a measured material for a model with these parameters, identified by their
/// names: for custom models.
#[must_use]
pub(super) fn by_names(parameters: &[Parameter]) -> fn(&Measured) -> Vec<(&'static str, Value)> {
    let has = |wanted: &[&Parameter]| wanted.iter().all(|w| parameters.iter().any(|p| p == *w));
    if has(&[&IOR, &EXTINCTION]) {
        conductor
    } else if has(&[&BASE_COLOUR, &METALLIC, &REFLECTANCE]) {
        base_colour_metallic
    } else {
        |_| Vec::new()
    }
}

/// A number as the value of a parameter with the maximum 1, with the digits that a control shows, so that the
/// displayed value is the value.
#[must_use]
pub fn fraction(v: f32) -> Value {
    Value::Number((v.min(1.0) * 1e4).round() / 1e4)
}

/// A linear reflectance as the value of a parameter that is a colour: sRGB-encoded, 8 bits.
#[must_use]
pub fn colour(reflectance: Vec3) -> Value {
    Value::Colour(reflectance.to_array().map(srgb_encode8))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        optics::{colour::Encoding, fresnel::normal_reflectance},
        parameter::Parameter,
    };

    fn material(id: &str) -> &'static Measured {
        by_id(id).unwrap_or_else(|| panic!("no {id}"))
    }

    #[test]
    fn every_row_of_the_table_is_read() {
        let rows = read(CONSTANTS, SOURCES);
        for (row, line) in rows.iter().zip(CONSTANTS.lines().skip(1)) {
            assert!(row.is_some(), "{line}");
        }
        assert_eq!((all().len(), rows.len()), (33, 33));
        let mut ids: Vec<_> = all().iter().map(|m| m.id).collect();
        ids.sort_unstable();
        ids.dedup();
        assert_eq!(ids.len(), all().len(), "each id once");
        // A row with a gap, or without a source, is noticed.
        assert_eq!(read("name,n630\ngold,0.2", SOURCES), [None]);
    }

    #[test]
    fn every_material_is_what_it_is_called() {
        for m in all() {
            assert!(m.f0.cmple(Vec3::ONE).all() && m.f0.cmpgt(Vec3::ZERO).all(), "{}", m.name);
            // Author, year in brackets, title, publication: at least three commas.
            let year = m.source.split_once(" (").and_then(|(_, rest)| rest.get(..4)?.parse::<u32>().ok());
            assert!(year.is_some_and(|y| (1900..2030).contains(&y)), "{}", m.source);
            // Dielectrics are transparent: absorption within a wavelength is negligible.
            let dark = m.k.iter().all(|k| *k > 0.01);
            assert!(if m.metal { dark } else { m.k.iter().all(|k| *k < 1e-6) }, "{}", m.name);
            // The colour is near the reflectance at the three wavelengths; saturated ones are further off.
            for c in 0..3 {
                let single = normal_reflectance(m.n[c], m.k[c]);
                assert!((m.f0[c] - single).abs() < 0.11, "{}: {} and {single}", m.name, m.f0[c]);
            }
        }
        assert_eq!(material("gold").f0.x, 1.0, "gold's red is outside sRGB");
        assert!((material("n_bk7").f0.y - 0.042_42).abs() < 1e-6);
    }

    #[test]
    fn presets_are_legal_values_of_the_shared_parameters() {
        let declared: [Parameter; 5] = [IOR, EXTINCTION, BASE_COLOUR, METALLIC, REFLECTANCE];
        for m in all() {
            for (name, value) in [conductor(m), base_colour_metallic(m)].into_iter().flatten() {
                let Some(p) = declared.iter().find(|p| p.name == name) else { panic!("{name}") };
                assert!(p.allows(&value), "{}: {name} {value}", m.name);
            }
        }
    }

    #[test]
    fn conductors_get_n_and_k_and_dielectrics_are_transparent() {
        let gold = conductor(material("gold"));
        assert_eq!(gold[0], ("ior", Value::Triple([0.18836, 0.54386, 1.33185])));
        assert_eq!(gold[1], ("extinction", Value::Triple([3.4034, 2.2309, 1.8693])));
        assert_eq!(conductor(material("water"))[1], ("extinction", Value::Triple([0.0; 3])));
        assert_eq!(conductor(material("diamond"))[0], ("ior", Value::Triple([2.4125, 2.42602, 2.44098])));
    }

    #[test]
    fn base_colour_and_reflectance_give_back_the_reflectance() {
        for m in all() {
            let values = base_colour_metallic(m);
            match values.as_slice() {
                [("base_colour", Value::Colour(rgb)), ("metallic", Value::Number(1.0))] => {
                    let error = (Encoding::Srgb.decode(*rgb) - m.f0).abs().max_element();
                    assert!(error < 0.005, "{}: {error}", m.name);
                }
                [("metallic", Value::Number(0.0)), ("reflectance", Value::Number(s))] => {
                    let error = 0.16 * s * s - luminance(m.f0);
                    assert!(error.abs() < 1e-5 || m.id == "diamond" && *s == 1.0, "{}: {error}", m.name);
                }
                other => panic!("{}: {other:?}", m.name),
            }
        }
    }
}
