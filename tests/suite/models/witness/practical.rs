//! Torrance–Sparrow, Cook–Torrance, metallic–roughness and Disney.
//!
//! Omitted rows, since nothing here has an equal definition: Mitsuba's `roughplastic` (light that is
//! scattered below and leaves through the surface again) and the last set of its `principled` (its clear coat
//! has another strength and distribution).

use std::f64::consts::{PI, TAU};

use glam::{DVec3, Vec3};
use lights_camera_models::{
    optics::fresnel::{dielectric, schlick_weight},
    reflection::{CookTorrance, Disney, MetallicRoughness, Surface, TorranceSparrow, brdf, preset},
};

use super::{LOCAL, Row, assert_rows, near, rows};

const TOLERANCE: f64 = 1e-5;

/// Rows with every value multiplied by a factor that depends on the directions.
fn scaled(mut rows: Vec<Row>, factor: impl Fn(&Row) -> f64) -> Vec<Row> {
    for row in &mut rows {
        let factor = factor(row);
        row.f = row.f.map(|f| f * factor);
    }
    rows
}

fn cook_torrance(slope: f32) -> CookTorrance {
    CookTorrance {
        ior: Vec3::splat(1.5),
        extinction: Vec3::ZERO,
        slope,
        base_colour: Vec3::ONE,
        specular_weight: 1.0,
    }
}

#[test]
fn cook_torrance_is_a_quarter_of_what_the_paper_prints() {
    // BBM follows the printed version: F D G/(π (N·L)(N·V)) with D = exp(−tan²/m²)/(m² cos⁴), four times the
    // form of a normalised D.
    let printed = rows("bbm", "CookTorrance", "");
    assert_rows(&scaled(printed, |_| 0.25), &cook_torrance(0.2), &cook_torrance(0.2001), TOLERANCE);
    let at_normal = f64::from(brdf(&cook_torrance(0.2), Vec3::Z, Vec3::Z, &LOCAL).x);
    assert!(!near(at_normal, 1.0 / PI, 0.5), "the print itself passes");
}

#[test]
fn cook_torrance_is_beckmann_of_other_programs_where_nothing_is_masked() {
    // They mask by Smith's theory, which differs from V-shaped cavities only at 85°.
    let open = |rows: Vec<Row>| rows.into_iter().filter(|r| r.l.z > 0.3).collect::<Vec<_>>();
    for (model, params) in [("CookTorranceWalter", "0.3"), ("CookTorranceHeitz", "[0.3, 0.3]")] {
        let rows = open(rows("bbm", model, params));
        assert_eq!(rows.len(), 5);
        assert_rows(&rows, &cook_torrance(0.3), &cook_torrance(0.3002), TOLERANCE);
    }
    // Aluminium: Mitsuba converts spectra to colours, which three wavelengths replace here, hence 3 %.
    let metal = preset::by_id("aluminium").unwrap();
    let aluminium = |slope| CookTorrance {
        ior: metal.n.into(),
        extinction: metal.k.into(),
        slope,
        base_colour: Vec3::ONE,
        specular_weight: 1.0,
    };
    let rows = open(rows("mitsuba3.9.1", "roughconductor", "beckmann"));
    assert_rows(&rows, &aluminium(0.3), &aluminium(0.31), 0.03);
}

#[test]
fn torrance_sparrow_is_the_gaussian_form_of_blinn_1977_normalised() {
    // The rows are D F G/((N·L)(N·V)) with D = exp(−c² θ²), c = 10; c²/π and 1/4 are added.
    let surface = |spread: f64| TorranceSparrow {
        ior: Vec3::splat(1.5),
        extinction: Vec3::ZERO,
        facet_spread: spread.to_degrees() as f32,
        base_colour: Vec3::ONE,
        specular_weight: 1.0,
    };
    let rows = scaled(rows("disney_brdf_explorer", "blinn", "n=10 ior=1.5"), |_| 100.0 / (4.0 * PI));
    assert_rows(&rows, &surface(0.1), &surface(0.1001), TOLERANCE);
}

/// The base colour used by BRDF Explorer, which decodes with gamma 2.2.
fn gamma(rgb: [f64; 3]) -> Vec3 {
    DVec3::from(rgb.map(|c| c.powf(2.2))).as_vec3()
}

fn disney(base_colour: Vec3) -> Disney {
    Disney {
        base_colour,
        metallic: 0.0,
        subsurface: 0.0,
        specular: 0.5,
        roughness: 0.5,
        specular_tint: 0.0,
        anisotropic: 0.0,
        sheen: 0.0,
        sheen_tint: 0.5,
        clearcoat: 0.0,
        clearcoat_gloss: 1.0,
    }
}

#[test]
fn disney_is_brdf_explorers_disney() {
    let rows = |params| rows("disney_brdf_explorer", "disney", params);
    let gold = disney(gamma([0.82, 0.67, 0.16]));
    assert_rows(&rows("=.82"), &gold, &Disney { roughness: 0.501, ..gold }, TOLERANCE);

    let copper = disney(gamma([0.8, 0.4, 0.2]));
    let metal = Disney { metallic: 1.0, roughness: 0.3, ..copper };
    assert_rows(&rows("metallic=1"), &metal, &Disney { metallic: 0.999, ..metal }, TOLERANCE);

    let all = Disney {
        roughness: 0.4,
        metallic: 0.3,
        specular_tint: 0.3,
        anisotropic: 0.6,
        sheen: 0.5,
        clearcoat: 0.7,
        clearcoat_gloss: 0.8,
        subsurface: 0.4,
        ..copper
    };
    let wrong = [
        Disney { specular_tint: 0.31, ..all },
        Disney { anisotropic: 0.59, ..all },
        Disney { sheen: 0.49, ..all },
        Disney { sheen_tint: 0.49, ..all },
        Disney { clearcoat: 0.71, ..all },
        Disney { clearcoat_gloss: 0.79, ..all },
        Disney { subsurface: 0.41, ..all },
    ];
    for wrong in wrong {
        assert_rows(&rows("sheen"), &all, &wrong, TOLERANCE);
    }
}

#[test]
fn disney_is_mitsubas_principled_but_for_the_fresnel_term_of_dielectrics() {
    let base = Vec3::new(0.8, 0.4, 0.2);
    let rows = |params| rows("mitsuba3.9.1", "principled", params);
    let metal = Disney { metallic: 1.0, ..disney(base) };
    assert_rows(&rows("\"metallic\": 1.0"), &metal, &Disney { roughness: 0.501, ..metal }, TOLERANCE);

    // Mitsuba has the exact equations where Disney has Schlick's approximation.
    let plastic = disney(base);
    let mut told_apart = false;
    for row in rows("\"specular\": 0.5}") {
        let cos_d = 0.5 * (row.l + row.v).length();
        let ratio = dielectric(1.5, cos_d) / (0.04 + 0.96 * schlick_weight(cos_d));
        let terms = Surface::response(&plastic, row.l, row.v, &LOCAL);
        let got = (terms.diffuse + terms.specular * ratio) / (std::f32::consts::PI * row.l.z);
        let schlick = brdf(&plastic, row.l, row.v, &LOCAL);
        for (i, expected) in row.f.into_iter().enumerate() {
            let got = f64::from(got[i]);
            assert!(near(got, expected, TOLERANCE), "{} {}: {got} is not {expected}", row.l, row.v);
            told_apart |= !near(f64::from(schlick[i]), expected, TOLERANCE);
        }
    }
    assert!(told_apart, "Schlick's approximation passes as exact");
}

#[test]
fn metallic_roughness_is_mitsubas_principled_metal_but_for_correlated_masking() {
    let metal = |roughness| MetallicRoughness {
        base_colour: Vec3::new(0.8, 0.4, 0.2),
        metallic: 1.0,
        roughness,
        reflectance: 0.5,
    };
    // Λ = (√(1 + α² tan²) − 1)/2; Mitsuba's G is 1/((1 + Λ)(1 + Λ')), here it is 1/(1 + Λ + Λ').
    let lambda = |d: Vec3| {
        let tan2 = 1.0 / f64::from(d.z).powi(2) - 1.0;
        ((1.0 + 0.0625 * tan2).sqrt() - 1.0) / 2.0
    };
    let correlated = |row: &Row| {
        let (l, v) = (lambda(row.l), lambda(row.v));
        (1.0 + l) * (1.0 + v) / (1.0 + l + v)
    };
    let rows = || rows("mitsuba3.9.1", "principled", "\"metallic\": 1.0");
    assert_rows(&scaled(rows(), correlated), &metal(0.5), &metal(0.501), TOLERANCE);
    let grazing = rows().into_iter().find(|r| r.l.z < 0.1).unwrap();
    let here = f64::from(brdf(&metal(0.5), grazing.l, grazing.v, &LOCAL).x);
    assert!(!near(here, grazing.f[0], 0.1), "separable masking passes as correlated");
}

/// `∫ f_r cos θ dω` of the red channel for a viewer of this cosine, by the midpoint rule around the
/// mirror direction.
fn albedo(surface: &dyn Surface, mu: f64) -> f64 {
    let (rows, columns) = (150, 200);
    let v = DVec3::new((1.0 - mu * mu).sqrt(), 0.0, mu);
    let (axis, across) = (DVec3::new(-v.x, 0.0, v.z), DVec3::new(v.z, 0.0, v.x));
    let mut sum = 0.0;
    for i in 0..rows {
        let t = (f64::from(i) + 0.5) / f64::from(rows);
        let (sin, cos) = (PI * t.powi(3)).sin_cos();
        let weight = sin * PI * 3.0 * t * t / f64::from(rows) * TAU / f64::from(columns);
        for j in 0..columns {
            let (s, c) = (TAU * (f64::from(j) + 0.5) / f64::from(columns)).sin_cos();
            let l = (cos * axis + sin * (c * across + s * DVec3::Y)).as_vec3();
            let terms = surface.response(l, v.as_vec3(), &LOCAL);
            sum += weight * f64::from((terms.diffuse + terms.specular).x);
        }
    }
    sum / PI
}

#[test]
fn metallic_roughness_reflects_what_the_table_of_the_split_sum_says() {
    let table = include_str!("../../../data/golden/directional_albedo.csv");
    let mut compared = 0;
    let mut told_apart = false;
    for line in table.lines().skip(1) {
        let cells: Vec<_> = line.split(',').collect();
        let number = |i: usize| cells[i].parse::<f64>().unwrap();
        let (alpha, mu) = (number(2), number(4));
        // Narrower lobes and more grazing views need a finer quadrature.
        if cells[0] != "ggx" || alpha < 0.05 || mu < 0.1 {
            continue;
        }
        // F_0 A + B.
        let f0 = 0.3f32;
        let metal = MetallicRoughness {
            base_colour: Vec3::splat(f0),
            metallic: 1.0,
            roughness: alpha.sqrt() as f32,
            reflectance: 0.5,
        };
        let expected = f64::from(f0) * number(6) + number(7);
        let found = albedo(&metal, mu);
        if cells[1] == "hc" {
            assert!((found - expected).abs() < 1e-3, "α {alpha} μ {mu}: {found} is not {expected}");
            compared += 1;
        } else {
            told_apart |= (found - expected).abs() > 1e-2;
        }
    }
    assert!(compared > 30, "{compared}");
    assert!(told_apart, "separable masking passes as correlated");
}
