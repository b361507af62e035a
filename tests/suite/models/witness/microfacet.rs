//! The microfacet model and its factors.

use glam::{Vec2, Vec2Swizzles as _, Vec3};
use lights_camera_models::{
    optics::{
        albedo::{LobeAlbedo, directional},
        colour::Encoding,
        distribution,
        fresnel::{conductor, dielectric, schlick},
        geometry::half_vector,
        masking,
    },
    parameter::{ParameterSet, Value, Values},
    reflection::{Microfacet, ReflectionModel as _, brdf},
};

use super::{LOCAL, Row, assert_rows, near, rows};

/// Asserts that a factor equals that of every row, and that `wrong` does not.
fn assert_factor(rows: &[Row], factor: impl Fn(Vec3, Vec3) -> f32, wrong: impl Fn(Vec3, Vec3) -> f32) {
    for row in rows {
        let got = f64::from(factor(row.l, row.v));
        assert!(
            near(got, row.f[0], 1e-5),
            "{} at {} {}: {got} is not {}",
            row.params,
            row.l,
            row.v,
            row.f[0]
        );
    }
    let told = rows.iter().any(|row| !near(f64::from(wrong(row.l, row.v)), row.f[0], 1e-5));
    assert!(told, "{}: the wrong twin passes", rows[0].params);
}

#[test]
fn distributions_are_those_of_brdf_explorer() {
    let d = |f: fn(Vec3, Vec2) -> f32, alpha: f32| move |l, v| f(half_vector(l, v), Vec2::splat(alpha));
    let explorer = |model| rows("disney_brdf_explorer", model, "");
    let (ggx, beckmann) = (d(distribution::ggx, 0.3), d(distribution::beckmann, 0.3));
    assert_factor(&explorer("d_ggx"), ggx, beckmann);
    assert_factor(&explorer("d_beckmann"), beckmann, ggx);
    assert_factor(
        &explorer("d_trowbridge_reitz"),
        d(|h, a| distribution::gtr(h, a, 2.0), 0.3),
        d(|h, a| distribution::gtr(h, a, 1.9), 0.3),
    );
    let alpha = (2.0f32 / 52.0).sqrt();
    assert_factor(
        &explorer("d_blinnphong"),
        d(distribution::blinn_phong, alpha),
        d(distribution::blinn_phong, 0.2),
    );
}

#[test]
fn masking_terms_are_those_of_brdf_explorer() {
    let explorer = |model| rows("disney_brdf_explorer", model, "");
    // G = 4 (n·l)(n·v) V.
    let g = |visibility: fn(Vec3, Vec3, Vec3) -> f32| {
        move |l: Vec3, v: Vec3| 4.0 * l.z * v.z * visibility(l, v, half_vector(l, v))
    };
    let v_cavity = g(|l, v, h| masking::v_cavity(l.z, v.z, h.z, l.dot(h)));
    let neumann = g(|l, v, _| masking::neumann(l.z, v.z));
    let kelemen = g(|l, _, h| masking::kelemen(l.dot(h)));
    assert_factor(&explorer("g_cooktorrance"), v_cavity, neumann);
    assert_factor(&explorer("g_neumann"), neumann, kelemen);
    assert_factor(&explorer("g_kelemen"), kelemen, neumann);
    let ggx = |alpha: f32| {
        move |l: Vec3, v: Vec3| {
            let lambda = |d| masking::smith_ggx(d, Vec2::splat(alpha));
            4.0 * l.z * v.z * masking::separable(l.z, v.z, lambda(l), lambda(v))
        }
    };
    assert_factor(&explorer("g_walter07"), ggx(0.5), ggx(0.45));
    // Schlick's own k = √(2 m²/π).
    let schlick = |k: f32| move |l: Vec3, v: Vec3| 4.0 * l.z * v.z * masking::schlick_smith(l.z, v.z, k);
    assert_factor(
        &explorer("g_schlick"),
        schlick(0.5 * (2.0f32 / std::f32::consts::PI).sqrt()),
        schlick(0.5),
    );
}

#[test]
fn fresnel_terms_are_those_of_brdf_explorer() {
    let explorer = |model| rows("disney_brdf_explorer", model, "");
    let f = |fresnel: fn(f32) -> f32| move |l: Vec3, v: Vec3| fresnel(l.dot(half_vector(l, v)));
    assert_factor(&explorer("f_cooktorrance"), f(|c| dielectric(1.5, c)), f(|c| dielectric(1.45, c)));
    assert_factor(&explorer("f_schlick"), f(|c| schlick(Vec3::splat(0.04), c).x), f(|c| dielectric(1.5, c)));
    assert_factor(
        &explorer("f_schlick_f0"),
        f(|c| schlick(Vec3::splat(0.1), c).x),
        f(|c| schlick(Vec3::splat(0.09), c).x),
    );
}

/// White, no diffuse base, with the given choices.
fn microfacet(d: u32, g: u32, f: u32, alpha: [f32; 2], n: f32) -> Microfacet {
    Microfacet {
        distribution: d,
        masking: g,
        fresnel: f,
        alpha_x: alpha[0],
        alpha_y: alpha[1],
        ior: Vec3::splat(n),
        diffuse: 0,
        ..Microfacet::from_values(&Values::default(), Encoding::Srgb)
    }
}

const BECKMANN: u32 = 1;
const GGX: u32 = 2;
const SEPARABLE: u32 = 5;
const CORRELATED: u32 = 6;
const NONE: u32 = 0;
const SCHLICK: u32 = 1;
const DIELECTRIC: u32 = 2;

#[test]
fn combinations_are_those_of_three_programs() {
    let explorer = rows("disney_brdf_explorer", "walter", "alphaG=0.3 ior=1.5");
    let ggx = |g, f, alpha| microfacet(GGX, g, f, alpha, 1.5);
    assert_rows(
        &explorer,
        &ggx(SEPARABLE, DIELECTRIC, [0.3; 2]),
        &ggx(CORRELATED, DIELECTRIC, [0.3; 2]),
        1e-5,
    );
    let explorer = rows("disney_brdf_explorer", "walter", "alphaG=0.6");
    assert_rows(&explorer, &ggx(SEPARABLE, NONE, [0.6; 2]), &ggx(SEPARABLE, DIELECTRIC, [0.6; 2]), 1e-5);
    let heitz = rows("bbm", "GGXHeitz", "[0.3, 0.3]");
    assert_rows(&heitz, &ggx(CORRELATED, DIELECTRIC, [0.3; 2]), &ggx(SEPARABLE, DIELECTRIC, [0.3; 2]), 2e-5);
    // These rows use Walter's approximation of Λ, up to 0.6 % off.
    let heitz = rows("bbm", "CookTorranceHeitz", "[0.3, 0.3]");
    let beckmann = |g, alpha| microfacet(BECKMANN, g, DIELECTRIC, alpha, 1.5);
    assert_rows(&heitz, &beckmann(CORRELATED, [0.3; 2]), &ggx(CORRELATED, DIELECTRIC, [0.3; 2]), 6e-3);
    let walter = rows("bbm", "GGX", "0.3");
    assert_rows(&walter, &ggx(SEPARABLE, DIELECTRIC, [0.3; 2]), &ggx(CORRELATED, DIELECTRIC, [0.3; 2]), 2e-5);
    let mitsuba = rows("mitsuba3.9.1", "roughdielectric", "ggx");
    assert_rows(
        &mitsuba,
        &ggx(SEPARABLE, DIELECTRIC, [0.3; 2]),
        &ggx(CORRELATED, DIELECTRIC, [0.3; 2]),
        2e-5,
    );
    let mitsuba = rows("mitsuba3.9.1", "roughdielectric", "beckmann");
    let beckmann = |n| microfacet(BECKMANN, SEPARABLE, DIELECTRIC, [0.5; 2], n);
    assert_rows(&mitsuba, &beckmann(1.33), &beckmann(1.35), 6e-3);
}

/// BBM's anisotropic rows mask with the geometric mean of the two roughnesses, where the theory (E. Heitz
/// 2014) uses the roughness along the direction. With its masking, its distribution equals ours.
#[test]
fn anisotropic_lobes_are_those_of_bbm_but_for_its_masking() {
    let alpha = Vec2::new(0.2, 0.5);
    let mean = Vec2::splat((alpha.x * alpha.y).sqrt());
    let rows = rows("bbm", "GGXHeitz", "[0.2, 0.5]");
    let f = |alpha: Vec2, row: &Row| {
        let h = half_vector(row.l, row.v);
        let (lambda_l, lambda_v) = (masking::smith_ggx(row.l, mean), masking::smith_ggx(row.v, mean));
        let g = masking::height_correlated(row.l.z, row.v.z, lambda_l, lambda_v);
        f64::from(distribution::ggx(h, alpha) * g * dielectric(1.5, row.l.dot(h)))
    };
    for row in &rows {
        assert!(
            near(f(alpha, row), row.f[0], 2e-5),
            "{} {}: {} is not {}",
            row.l,
            row.v,
            f(alpha, row),
            row.f[0]
        );
    }
    assert!(rows.iter().any(|row| !near(f(alpha.yx(), row), row.f[0], 1e-2)), "the wrong twin passes");
}

/// Mitsuba converts measured spectra of n and k to three numbers in its own way. One pair (n, k) per channel
/// matches all its rows with this lobe, and none with another lobe.
#[test]
fn metals_of_mitsuba_are_conductors_with_one_pair_of_constants() {
    let misfit = |rows: &[Row], d: u32, alpha: [f32; 2], channel: usize| {
        let lobe = microfacet(d, SEPARABLE, NONE, alpha, 1.5);
        // Rows far in the tails reveal more about noise than about F.
        let reflectances: Vec<(f32, f64)> = rows
            .iter()
            .filter(|row| row.f[channel] > 1e-3)
            .map(|row| {
                let bare = f64::from(brdf(&lobe, row.l, row.v, &LOCAL).x);
                (row.l.dot(half_vector(row.l, row.v)), row.f[channel] / bare)
            })
            .collect();
        assert!(reflectances.len() > 3);
        let off = |n: f32, k: f32| {
            let squares =
                reflectances.iter().map(|(c, f)| (f64::from(conductor(n, k, *c)) / f - 1.0).powi(2));
            (squares.sum::<f64>() / reflectances.len() as f64).sqrt()
        };
        let (mut best, mut n, mut k, mut step) = (f64::INFINITY, 1.0f32, 3.0f32, 0.5f32);
        for _ in 0..4000 {
            let around = [
                (0.0, 1.0),
                (0.0, -1.0),
                (1.0, 0.0),
                (-1.0, 0.0),
                (1.0, 1.0),
                (-1.0, -1.0),
                (1.0, -1.0),
                (-1.0, 1.0),
            ];
            let next = around
                .map(|(x, y): (f32, f32)| ((n + x * step).max(0.01), (k + y * step).max(0.0)))
                .map(|(n, k)| (off(n, k), n, k))
                .into_iter()
                .min_by(|a, b| a.0.total_cmp(&b.0))
                .unwrap();
            if next.0 < best {
                (best, n, k) = next;
            } else {
                step *= 0.7;
            }
        }
        best
    };
    for (params, d, other, alpha) in [
        ("\"Au\"", GGX, BECKMANN, [0.3, 0.3]),
        ("\"Al\"", BECKMANN, GGX, [0.3, 0.3]),
        ("\"Cu\"", GGX, BECKMANN, [0.2, 0.5]),
    ] {
        let rows = rows("mitsuba3.9.1", "roughconductor", params);
        let tolerance = if d == BECKMANN { 6e-3 } else { 2e-3 };
        for channel in 0..3 {
            let right = misfit(&rows, d, alpha, channel);
            assert!(right < tolerance, "{params} channel {channel}: {right}");
            let wrong = misfit(&rows, other, alpha, channel);
            assert!(
                wrong > 5.0 * tolerance,
                "{params} channel {channel}: the wrong twin is off by {wrong} only"
            );
        }
    }
}

#[test]
fn the_roughest_surface_is_that_of_lommel_and_seeliger() {
    let (right, wrong) =
        (microfacet(GGX, CORRELATED, NONE, [1.0; 2], 1.5), microfacet(GGX, SEPARABLE, NONE, [1.0; 2], 1.5));
    let mut told = false;
    for i in 1..40 {
        for j in 1..40 {
            let (l, v) = (
                super::direction(f64::from(i) * 2.2, 0.0),
                super::direction(f64::from(j) * 2.2, f64::from(i * j)),
            );
            let expected = 1.0 / (std::f64::consts::TAU * f64::from(l.z + v.z));
            let f = |m: &Microfacet| f64::from(brdf(m, l, v, &LOCAL).x);
            assert!((f(&right) / expected - 1.0).abs() < 1e-4, "{l} {v}");
            told |= (f(&wrong) / expected - 1.0).abs() > 1e-2;
        }
    }
    assert!(told, "the wrong twin passes");
}

#[test]
fn the_lobe_of_a_setting_is_used_only_where_it_is_needed() {
    assert_eq!(Microfacet::from_values(&Values::default(), Encoding::Srgb).lobe, LobeAlbedo::default());
}

/// The table of directional albedos: distribution, masking, α, μ, E with F = 1, and the scale A and bias B
/// of Schlick's F: E = A F_0 + B.
fn table() -> Vec<(u32, u32, f32, f64, [f64; 3])> {
    let text = include_str!("../../../data/golden/directional_albedo.csv");
    text.lines()
        .skip(1)
        .map(|line| {
            let cells: Vec<_> = line.split(',').collect();
            let number = |i: usize| cells[i].parse::<f64>().unwrap();
            let d = if cells[0] == "ggx" { GGX } else { BECKMANN };
            let g = if cells[1] == "hc" { CORRELATED } else { SEPARABLE };
            (d, g, number(2) as f32, number(4), [number(5), number(6), number(7)])
        })
        .collect()
}

/// E(μ) of a surface, by the quadrature behind `lcm albedo`.
fn albedo(surface: &Microfacet, mu: f64) -> f64 {
    let v = super::direction(mu.acos().to_degrees(), 0.0);
    directional(|l| surface.response(l, v, &LOCAL), v, &LOCAL).x
}

#[test]
fn directional_albedos_are_those_of_the_table() {
    let rows = table();
    assert!(rows.len() > 200);
    let mut told = false;
    for (d, g, alpha, mu, [with_all, scale, bias]) in rows {
        let lobe = |d, g, f| microfacet(d, g, f, [alpha; 2], 1.5);
        let e = albedo(&lobe(d, g, NONE), mu);
        assert!((e - with_all).abs() < 1e-3, "D {d} G {g} α {alpha} μ {mu}: {e} is not {with_all}");
        let e = albedo(&lobe(d, g, SCHLICK), mu);
        let expected = 0.04 * scale + bias;
        assert!((e - expected).abs() < 1e-3, "D {d} G {g} α {alpha} μ {mu}, Schlick: {e} is not {expected}");
        let wrong = albedo(&lobe(d, CORRELATED + SEPARABLE - g, NONE), mu);
        told |= (wrong - with_all).abs() > 1e-2;
    }
    assert!(told, "the wrong twin passes");
}

#[test]
fn with_compensation_a_white_metal_vanishes_in_a_white_furnace() {
    for (name, d, g) in [("GGX", GGX, CORRELATED), ("Beckmann", BECKMANN, SEPARABLE)] {
        for alpha in [0.05, 0.3, 1.0] {
            let with = |choice: u32| {
                let mut values = Values::default();
                let id = |p: &str, i: u32| {
                    let found = Microfacet::PARAMETERS.iter().find(|q| q.name == p).unwrap();
                    Value::Choice(found.kind.options()[i as usize].0.into())
                };
                for (p, i) in [
                    ("distribution", d),
                    ("masking", g),
                    ("fresnel", NONE),
                    ("diffuse", 0),
                    ("multiple_scattering", choice),
                ] {
                    values.set(p, id(p, i));
                }
                values.set("alpha_x", Value::Number(alpha));
                values.set("alpha_y", Value::Number(alpha));
                Microfacet::from_values(&values, Encoding::Srgb)
            };
            for mu in [0.05, 0.2, 0.6, 1.0] {
                for choice in [1, 2] {
                    let e = albedo(&with(choice), mu);
                    assert!((e - 1.0).abs() < 4e-3, "{name} α {alpha} μ {mu}, compensation {choice}: {e}");
                }
            }
            let lost = albedo(&with(0), 0.6);
            assert!(alpha < 0.9 || lost < 0.9, "{name}: without compensation {lost}");
        }
    }
}
