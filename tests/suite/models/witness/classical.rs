//! The classical models, and the two highlights of the *Commonality Analysis*, with lobes shared by other
//! programs.

use std::f64::consts::{LN_2, PI};

use glam::Vec3;
use lights_camera_models::{
    optics::colour::Encoding,
    parameter::{Value, Values},
    reflection::{
        BlinnPhong, BlinnPhongNormalised, Hapke, LommelSeeliger, Minnaert, ModifiedPhong, Phong, Strauss,
        Surface, brdf,
    },
    registry::Registry,
    render::capture::evaluate::Evaluator,
    shader::compose::Sources,
};

use super::{LOCAL, Row, assert_rows, direction, near, rows};

const BRDF_EXPLORER: &str = "disney_brdf_explorer";

fn phong(alpha: f32) -> Phong {
    let (base_colour, specular_colour) = (Vec3::ZERO, Vec3::ONE);
    Phong { base_colour, specular_colour, k_a: 0.0, k_d: 0.0, k_s: 1.0, alpha }
}

fn blinn_phong(alpha: f32) -> BlinnPhong {
    let (base_colour, specular_colour) = (Vec3::ZERO, Vec3::ONE);
    BlinnPhong { base_colour, specular_colour, k_a: 0.0, k_d: 0.0, k_s: 1.0, alpha }
}

fn normalised(k_s: f32, alpha: f32) -> BlinnPhongNormalised {
    BlinnPhongNormalised { base_colour: Vec3::ONE, specular_colour: Vec3::ONE, k_s, alpha }
}

fn modified_phong(k_s: f32, alpha: f32) -> ModifiedPhong {
    ModifiedPhong { base_colour: Vec3::ONE, specular_colour: Vec3::ONE, k_s, alpha }
}

fn minnaert(limb_darkening: f32) -> Minnaert {
    Minnaert { base_colour: Vec3::ONE, limb_darkening }
}

/// The rows with their values multiplied.
fn scaled(mut rows: Vec<Row>, factor: f64) -> Vec<Row> {
    rows.iter_mut().for_each(|row| row.f = row.f.map(|f| f * factor));
    rows
}

/// The BRDF in its red channel at angles in degrees: light at (θ_i, 0), view at (θ_r, φ).
fn at(surface: &dyn Surface, i: f64, r: f64, phi: f64) -> f64 {
    f64::from(brdf(surface, direction(i, 0.0), direction(r, phi), &LOCAL).x)
}

/// The directional albedo `∫ f cos θ dω` at a cosine, by two-point Gauss quadrature in each of many steps of
/// cos θ and of φ: accurate enough for BRDFs without narrow lobes.
fn albedo(surface: &dyn Surface, mu: f64) -> f64 {
    const STEPS: usize = 400;
    let view = direction(mu.acos().to_degrees(), 0.0);
    let points = |n: usize| {
        let half = 0.5 / 3f64.sqrt();
        (0..n).flat_map(move |i| [-half, half].map(|o| (i as f64 + 0.5 + o) / n as f64))
    };
    let mut sum = 0.0;
    for u in points(STEPS) {
        for v in points(16) {
            // dω = dφ d(cos θ).
            let l = direction(u.acos().to_degrees(), 360.0 * v);
            sum += f64::from(brdf(surface, l, view, &LOCAL).x) * 2.0 * PI * u;
        }
    }
    sum / (2 * STEPS * 32) as f64
}

fn assert_near(got: f64, expected: f64, tolerance: f64) {
    assert!(near(got, expected, tolerance), "{got} is not {expected}");
}

#[test]
fn the_highlights_of_the_ca_are_those_of_brdf_explorer() {
    // f = cos^n/(N·L) there; the response over π cos θ_i here.
    let expected = scaled(rows(BRDF_EXPLORER, "phong", "n=100"), 1.0 / PI);
    assert_rows(&expected, &phong(100.0), &phong(101.0), 2e-5);
    let lobes = rows(BRDF_EXPLORER, "blinnphong", "n=50");
    let divided = lobes.into_iter().filter(|row| row.params == "n=50").collect();
    assert_rows(&scaled(divided, 1.0 / PI), &blinn_phong(50.0), &blinn_phong(51.0), 2e-5);
}

#[test]
fn normalised_blinn_phong_is_the_lobe_of_brdf_explorer_times_the_exact_factor() {
    let n: f64 = 50.0;
    let exact = (n + 2.0) * (n + 4.0) / (8.0 * PI * ((-n / 2.0).exp2() + n));
    let expected = scaled(rows(BRDF_EXPLORER, "blinnphong", "divide_by_NdotL=0"), exact);
    assert_rows(&expected, &normalised(1.0, 50.0), &normalised(1.0, 51.0), 1e-5);
    // The factor itself: not (n + 8)/8π, which is 0.9549297.
    assert_near(at(&normalised(1.0, 16.0), 0.0, 0.0, 0.0), 0.895_028_0, 1e-6);
    assert!(!near(0.954_929_7, 0.895_028_0, 0.05));
    // α = 0 is Lambert, and so is a lobe without reflection.
    for surface in [normalised(1.0, 0.0), normalised(0.0, 500.0), normalised(0.3, 0.0)] {
        assert_near(at(&surface, 50.0, 20.0, 130.0), 1.0 / PI, 1e-6);
    }
}

#[test]
fn modified_phong_is_that_of_brdf_explorer_and_of_bbm() {
    for expected in [rows(BRDF_EXPLORER, "modifiedphong", "n=20"), rows("bbm", "Phong", "sharpness = 20")] {
        assert_rows(&expected, &modified_phong(1.0, 20.0), &modified_phong(1.0, 21.0), 1e-5);
        assert_rows(&expected, &modified_phong(1.0, 20.0), &normalised(1.0, 20.0), 1e-5);
    }
    // Shared light: k_d = 1 − k_s.
    assert_near(at(&modified_phong(0.4, 20.0), 0.0, 0.0, 0.0), 0.6 / PI + 0.4 * 22.0 / (2.0 * PI), 1e-6);
}

#[test]
fn narrow_lobes_have_the_height_and_width_of_the_formula() {
    let n: f64 = 1e6;
    for tilt in [0.0f64, 0.02, 0.05, 0.1, 0.2] {
        // Light at 30°, view tilted off the mirror direction in its plane; H off N by half of it.
        let off = tilt.to_radians();
        let expected = (n + 2.0) / (2.0 * PI) * off.cos().powf(n);
        // For directions in f32 the angle is accurate to 3e-8, which the power multiplies to n · off · 3e-8.
        let noise = 1e-5 + 2.0 * n * off * 6e-8;
        assert_near(at(&modified_phong(1.0, 1e6), 30.0, 30.0 + tilt, 180.0), expected, noise);
        let exact = (n + 2.0) * (n + 4.0) / (8.0 * PI * n);
        let expected = exact * (off / 2.0).cos().powf(n);
        assert_near(at(&normalised(1.0, 1e6), 30.0, 30.0 + tilt, 180.0), expected, noise);
        let naive = f64::from((off.cos() as f32).powf(1e6)) * (n + 2.0) / (2.0 * PI);
        assert!(
            !(0.02..=0.15).contains(&tilt) || !near(naive, off.cos().powf(n) * (n + 2.0) / (2.0 * PI), noise)
        );
    }
}

#[test]
fn narrow_lobes_are_the_same_on_the_gpu() {
    let registry = Registry::builtin();
    for (id, tilt) in [("modified_phong", 1.0), ("blinn_phong_normalised", 2.0)] {
        let model = registry.model(id).unwrap();
        let mut evaluator = Evaluator::new(&Sources::default(), model).expect("software Vulkan is installed");
        for alpha in [1_000, 30_000, 1_000_000] {
            let mut values = Values::default();
            values.set("alpha", Value::Integer(alpha));
            let width = tilt / (alpha as f64).sqrt();
            let pairs: Vec<_> = (0..400)
                .map(|i| {
                    let (i, off) = (f64::from(i % 20), f64::from(i / 20) * 0.1 * width);
                    let incident = 4.0 * i + 0.5;
                    (direction(incident, 0.0), direction(incident + off.to_degrees(), 180.0))
                })
                .collect();
            let surface = model.instantiate(&values, Encoding::Srgb);
            evaluator.set(&values, Encoding::Srgb);
            let answers = evaluator.evaluate(&pairs).expect("the GPU evaluates");
            for ((l, v), gpu) in pairs.iter().zip(answers) {
                let cpu = surface.response(*l, *v, &LOCAL).specular.x;
                let error = (gpu.specular.x - cpu).abs() / cpu.max(1e-2);
                assert!(error <= 1e-4, "{id} {alpha} {l} {v}: GPU {}, CPU {cpu}", gpu.specular.x);
            }
        }
    }
}

#[test]
fn minnaert_is_that_of_brdf_explorer_and_reflects_a_power_of_the_cosine() {
    for (params, k) in [("k=0.8", 0.8), ("k=1.5", 1.5)] {
        assert_rows(&rows(BRDF_EXPLORER, "minnaert", params), &minnaert(k), &minnaert(k + 0.001), 1e-5);
        for mu in [1.0f64, 0.7, 0.3, 0.05] {
            assert_near(albedo(&minnaert(k), mu), mu.powf(f64::from(k) - 1.0), 1e-3);
        }
        assert!(!near(albedo(&minnaert(k + 0.02), 0.3), 0.3f64.powf(f64::from(k) - 1.0), 1e-3));
    }
    assert_near(at(&minnaert(1.0), 70.0, 40.0, 10.0), 1.0 / PI, 1e-6);
}

#[test]
fn lommel_seeliger_reflects_what_its_closed_form_says() {
    let surface = LommelSeeliger { base_colour: Vec3::ONE };
    for (i, r) in [(0.0f64, 0.0f64), (30.0, 60.0), (80.0, 85.0), (5.0, 89.0)] {
        let cosines = i.to_radians().cos() + r.to_radians().cos();
        assert_near(at(&surface, i, r, 77.0), 1.0 / (2.0 * PI * cosines), 1e-5);
        // With w/4π for 1/2π, for a single scatterer of albedo 1.
        assert!(!near(at(&surface, i, r, 77.0), 1.0 / (4.0 * PI * cosines), 0.1));
    }
    for mu in [1.0f64, 0.6, 0.1] {
        assert_near(albedo(&surface, mu), 1.0 - mu * (1.0 / mu).ln_1p(), 1e-3);
    }
    assert_near(albedo(&surface, 1.0), 1.0 - LN_2, 1e-4);
}

/// The ground of the given values: no opposition surge, slopes of 30°.
const REGOLITH: Hapke = Hapke {
    base_colour: Vec3::ONE,
    single_scattering_albedo: 0.52,
    grain_asymmetry: 0.213,
    backscatter: 1.0,
    opposition_amplitude: 0.0,
    opposition_width: 0.05,
    mean_slope: 30.0,
};

/// Hapke's formulas as published, in f64, by angles in radians: incidence, emergence, phase.
fn published_hapke(m: &Hapke, i: f64, e: f64, g: f64) -> f64 {
    let [w, b, c, b_0, h] = [
        m.single_scattering_albedo,
        m.grain_asymmetry,
        m.backscatter,
        m.opposition_amplitude,
        m.opposition_width,
    ]
    .map(f64::from);
    let slope = f64::from(m.mean_slope).to_radians();
    let chi = 1.0 / (1.0 + PI * slope.tan().powi(2)).sqrt();
    let cot = |x: f64| 1.0 / x.max(1e-12).tan();
    let e_1 = |x: f64| (-2.0 / PI * cot(slope) * cot(x)).exp();
    let e_2 = |x: f64| (-1.0 / PI * (cot(slope) * cot(x)).powi(2)).exp();
    let psi = if i.sin() * e.sin() < 1e-12 {
        0.0
    } else {
        ((g.cos() - i.cos() * e.cos()) / (i.sin() * e.sin())).clamp(-1.0, 1.0).acos()
    };
    let eta = |x: f64| chi * (x.cos() + x.sin() * slope.tan() * e_2(x) / (2.0 - e_1(x)));
    let half = (psi / 2.0).sin().powi(2);
    let f = (-2.0 * (psi / 2.0).tan()).exp();
    let (mu_0, mu) = if i <= e {
        let below = 2.0 - e_1(e) - psi / PI * e_1(i);
        (
            chi * (i.cos() + i.sin() * slope.tan() * (psi.cos() * e_2(e) + half * e_2(i)) / below),
            chi * (e.cos() + e.sin() * slope.tan() * (e_2(e) - half * e_2(i)) / below),
        )
    } else {
        let below = 2.0 - e_1(i) - psi / PI * e_1(e);
        (
            chi * (i.cos() + i.sin() * slope.tan() * (e_2(i) - half * e_2(e)) / below),
            chi * (e.cos() + e.sin() * slope.tan() * (psi.cos() * e_2(i) + half * e_2(e)) / below),
        )
    };
    let nearer = i.min(e);
    let s = mu / eta(e) * i.cos() / eta(i) * chi / (1.0 - f + f * chi * nearer.cos() / eta(nearer));
    let gamma = (1.0 - w).sqrt();
    let chandrasekhar = |x: f64| (1.0 + 2.0 * x) / (1.0 + 2.0 * x * gamma);
    let lobe = |sign: f64| (1.0 - b * b) / (1.0 - sign * 2.0 * b * g.cos() + b * b).powf(1.5);
    let p = 0.5 * (1.0 + c) * lobe(1.0) + 0.5 * (1.0 - c) * lobe(-1.0);
    let surge = b_0 / (1.0 + (g / 2.0).tan() / h);
    let brackets = (1.0 + surge) * p + chandrasekhar(mu_0) * chandrasekhar(mu) - 1.0;
    w / (4.0 * PI) * mu_0 / (mu_0 + mu) * brackets * s / i.cos()
}

#[test]
fn hapke_gives_the_radiance_factors_of_planetary_science() {
    // I/F at phase, incidence and emergence; the BRDF is that over π cos θ_i.
    for (g, i, e, radiance) in [(0.0f64, 0.0f64, 0.0f64, 0.158_749), (60.0, 45.0, 30.0, 0.091_179_9)] {
        let (i_r, e_r) = (i.to_radians(), e.to_radians());
        let azimuth = if i == 0.0 {
            0.0
        } else {
            let cosine = (g.to_radians().cos() - i_r.cos() * e_r.cos()) / (i_r.sin() * e_r.sin());
            cosine.acos().to_degrees()
        };
        let factor = |surface: &Hapke| at(surface, i, e, azimuth) * PI * i_r.cos();
        assert_near(factor(&REGOLITH), radiance, 1e-5);
        for wrong in [
            Hapke { mean_slope: 0.0, ..REGOLITH },
            Hapke { backscatter: -1.0, ..REGOLITH },
            Hapke { opposition_amplitude: 1.0, ..REGOLITH },
            Hapke { single_scattering_albedo: 0.521, ..REGOLITH },
        ] {
            assert!(!near(factor(&wrong), radiance, 1e-3), "{wrong:?}");
        }
    }
}

#[test]
fn hapke_is_what_was_published_at_all_angles() {
    let surfaces = [
        REGOLITH,
        Hapke { opposition_amplitude: 0.7, opposition_width: 0.06, mean_slope: 20.0, ..REGOLITH },
        Hapke { backscatter: -0.4, grain_asymmetry: 0.6, single_scattering_albedo: 0.97, ..REGOLITH },
        Hapke { mean_slope: 5.0, opposition_amplitude: 1.0, ..REGOLITH },
        Hapke { mean_slope: 45.0, grain_asymmetry: 0.0, single_scattering_albedo: 0.1, ..REGOLITH },
    ];
    for (n, surface) in surfaces.iter().enumerate() {
        let mut told_apart = false;
        for (i, e) in [(10.0, 50.0), (50.0, 10.0), (35.0, 35.0), (70.0, 80.0), (85.0, 60.0), (0.0, 40.0)] {
            for phi in [0.0, 25.0, 90.0, 150.0, 179.0] {
                let (l, v) = (direction(i, 0.0), direction(e, phi));
                let g = l.as_dvec3().normalize().angle_between(v.as_dvec3().normalize());
                let (i, e) = (f64::to_radians(i), f64::to_radians(e));
                let got = f64::from(brdf(surface, l, v, &LOCAL).x);
                let expected = published_hapke(surface, i, e, g);
                // The azimuth, which the published form derives from the phase angle, is accurate to about
                // 1e-6.
                assert!(near(got, expected, 1e-4), "{n} at {i} {e} {phi}: {got} is not {expected}");
                let wrong = Hapke { mean_slope: surface.mean_slope + 0.1, ..*surface };
                told_apart |= !near(got, published_hapke(&wrong, i, e, g), 1e-4);
            }
        }
        assert!(told_apart, "{n}: a tenth of a degree more goes unnoticed");
    }
}

#[test]
fn hapke_of_dark_even_grains_on_level_ground_is_lommel_seeliger() {
    let dark = Hapke { single_scattering_albedo: 1e-4, grain_asymmetry: 0.0, mean_slope: 0.0, ..REGOLITH };
    let lommel = LommelSeeliger { base_colour: Vec3::splat(0.5e-4) };
    for (i, r, phi) in [(0.0, 0.0, 0.0), (30.0, 70.0, 40.0), (85.0, 20.0, 170.0)] {
        assert_near(at(&dark, i, r, phi) * 1e4, at(&lommel, i, r, phi) * 1e4, 2e-4);
    }
}

#[test]
fn strauss_is_what_was_published_at_all_angles() {
    let f_of =
        |x: f64, k: f64| (1.0 / (x - k).powi(2) - 1.0 / (k * k)) / (1.0 / (1.0 - k).powi(2) - 1.0 / (k * k));
    let g_of = |x: f64, k: f64| {
        (1.0 / (1.0 - k).powi(2) - 1.0 / (x - k).powi(2)) / (1.0 / (1.0 - k).powi(2) - 1.0 / (k * k))
    };
    let published = |m: &Strauss, k_g: f64, i: f64, r: f64, phi: f64| {
        let [s, metal, t] = [m.smoothness, m.metallic, m.transparency].map(f64::from);
        let r_d = (1.0 - s.powi(3)) * (1.0 - t);
        let r_n = 1.0 - t - r_d;
        let f = f_of(i / 90.0, 1.12);
        let r_j = (r_n + (r_n + 0.1) * f * g_of(i / 90.0, k_g) * g_of(r / 90.0, k_g)).min(1.0);
        let (i, r, phi) = (i.to_radians(), r.to_radians(), phi.to_radians());
        let mirror = (i.cos() * r.cos() - i.sin() * r.sin() * phi.cos()).max(0.0);
        [0, 1, 2].map(|channel| {
            let c = f64::from(m.base_colour[channel]);
            let diffuse = r_d * (1.0 - metal * s) * c * i.cos();
            let tint = 1.0 + metal * (1.0 - f) * (c - 1.0);
            (diffuse + r_j * tint * mirror.powf(3.0 / (1.0 - s))) / (PI * i.cos())
        })
    };
    let base_colour = Vec3::new(0.9, 0.5, 0.1);
    for (smoothness, metallic, transparency) in
        [(0.0, 0.0, 0.0), (0.5, 0.0, 0.0), (0.75, 1.0, 0.0), (0.25, 0.5, 0.25), (0.96875, 0.75, 0.5)]
    {
        let surface = Strauss { base_colour, smoothness, metallic, transparency };
        let mut told_apart = false;
        for (i, r) in [(0.0, 0.0), (20.0, 35.0), (60.0, 60.0), (85.0, 80.0), (89.0, 85.0), (45.0, 89.5)] {
            for phi in [0.0, 60.0, 120.0, 180.0] {
                let got = brdf(&surface, direction(i, 0.0), direction(r, phi), &LOCAL).to_array();
                let expected = published(&surface, 1.01, i, r, phi);
                let wrong = published(&surface, 1.02, i, r, phi);
                for channel in 0..3 {
                    let (got, expected) = (f64::from(got[channel]), expected[channel]);
                    assert!(near(got, expected, 2e-5), "{surface:?} at {i} {r} {phi}: {got}, not {expected}");
                    told_apart |= !near(got, wrong[channel], 2e-5);
                }
            }
        }
        assert!(told_apart, "{surface:?}: k_g = 1.02 goes unnoticed");
    }
    // A perfect mirror is omitted: at s = 1 the highlight is finite.
    let mirror = Strauss { base_colour, smoothness: 1.0, metallic: 1.0, transparency: 0.0 };
    assert_near(at(&mirror, 0.0, 0.0, 0.0), f64::from(base_colour.x) / PI, 1e-5);
}

#[test]
fn strauss_makes_half_a_percent_of_light_at_most() {
    let dull =
        |smoothness: f32| Strauss { base_colour: Vec3::ONE, smoothness, metallic: 0.0, transparency: 0.0 };
    let most = |surface: &Strauss| {
        [0.95, 0.6, 0.3, 0.1].map(|mu| albedo(surface, mu)).into_iter().fold(0.0, f64::max)
    };
    assert!((1.004..1.006).contains(&most(&dull(0.0))), "{}", most(&dull(0.0)));
    assert!(most(&dull(0.2)) < 1.0, "{}", most(&dull(0.2)));
}
