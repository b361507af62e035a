//! The optics of light that goes through, in WGSL as the CPU interprets it, against Rust.

use glam::{Vec2, Vec3};
use lights_camera_models::{
    optics::{
        absorption, dispersion,
        geometry::direction,
        interface::{Facets, Interface},
        refraction::{refracted, refracted_cosine},
        slab::{oblique, slab},
    },
    shader::{
        check::validate,
        compose::{ABSORPTION, Composed, DISPERSION, OPTICS, TRANSMISSION},
        interpret::Program,
    },
};

/// Functions of numbers and vectors alone, around those with structs.
const WRAPPERS: &str = "
fn boundary(facets: f32, alpha: vec2<f32>, ior: f32) -> Interface {
    return Interface(u32(facets), alpha, ior);
}
fn try_bsdf(facets: f32, alpha: vec2<f32>, ior: f32, l: vec3<f32>, v: vec3<f32>) -> vec3<f32> {
    let i = boundary(facets, alpha, ior);
    return vec3(interface_bsdf(i, l, v), interface_pdf(i, l, v), 0.0);
}
fn try_sample(facets: f32, alpha: vec2<f32>, ior: f32, u: vec3<f32>, v: vec3<f32>) -> vec3<f32> {
    return interface_sample(boundary(facets, alpha, ior), u, v);
}
fn try_refracted(v: vec3<f32>, eta: f32) -> vec3<f32> {
    return refracted(v, vec3(0.0, 0.0, 1.0), eta);
}
fn try_reflectance(r: f32, a: vec3<f32>) -> vec3<f32> {
    return slab(vec3(r), a).reflectance;
}
fn try_transmittance(r: f32, a: vec3<f32>) -> vec3<f32> {
    return slab(vec3(r), a).transmittance;
}
fn try_oblique(a: vec3<f32>, cosine: f32) -> vec3<f32> {
    return oblique(a, cosine);
}
fn try_index(n_d: f32, abbe: f32, nm: f32) -> vec3<f32> {
    let b = cauchy_of_abbe(n_d, abbe);
    return vec3(b, cauchy(n_d, b, nm), refracted_cosine(abbe / 100.0, 1.0 / n_d));
}
fn try_spectrum(u: f32) -> vec3<f32> {
    return spectrum(u).weight;
}
fn try_wavelength(u: f32) -> vec3<f32> {
    return vec3(spectrum(u).nm);
}
fn try_absorption(colour: vec3<f32>, distance: f32, way: f32) -> vec3<f32> {
    return absorption_left(absorption_coefficient(colour, distance), way);
}
";

/// The twins, by name.
struct Twins(naga::Module);

impl Twins {
    fn new() -> Self {
        let optics: String = OPTICS
            .iter()
            .chain(TRANSMISSION)
            .chain([&DISPERSION, &ABSORPTION])
            .map(|source| source.text)
            .collect();
        let text = optics + WRAPPERS;
        Self(validate(&Composed { text, ..Composed::default() }).expect("valid WGSL"))
    }

    fn function(&self, name: &str) -> impl Fn(&[f32]) -> Vec3 {
        let program = Program::new(&self.0, name).expect("it runs");
        move |arguments| {
            let arguments: Vec<_> = arguments.iter().map(|x| x.to_bits()).collect();
            assert_eq!(arguments.len(), program.argument_words());
            let mut result = [0; 3];
            program.run(&arguments, &mut result).expect("it ends");
            Vec3::from_array(result.map(f32::from_bits))
        }
    }
}

/// Asserts that two vectors are equal to four digits.
fn assert_same(found: Vec3, expected: Vec3, what: &str) {
    let near = (found - expected).abs().cmple(1e-4 * expected.abs() + 1e-6);
    assert!(near.all(), "{what}: WGSL gives {found}, Rust {expected}");
}

#[test]
fn rough_boundaries_are_the_same_in_wgsl() {
    let twins = Twins::new();
    let (bsdf, sample) = (twins.function("try_bsdf"), twins.function("try_sample"));
    let mut lit = 0;
    for (kind, facets) in [(0.0, Facets::Ggx), (1.0, Facets::Beckmann)] {
        for (x, y, ior) in
            [(0.3, 0.3, 1.5), (0.05, 0.6, 1.33), (0.8, 0.8, 2.4), (0.3, 0.3, 1.0), (0.4, 0.4, 0.7)]
        {
            let interface = Interface::new(facets, Vec2::new(x, y), ior);
            for i in 0..2000 {
                let fraction = |step: f64| (f64::from(i) * step).fract();
                let theta = |step| (1.0 - 2.0 * fraction(step)).acos().to_degrees();
                let l = direction(theta(0.819_172_513), 360.0 * fraction(0.671_043_607));
                let v = direction(theta(0.549_700_478), 360.0 * fraction(0.450_307_264));
                let what = format!("{interface:?} l {l} v {v}");
                let boundary = [kind, x, y, ior];
                let arguments = [&boundary[..], &l.to_array(), &v.to_array()].concat();
                let expected = Vec3::new(interface.bsdf(l, v), interface.pdf(l, v), 0.0);
                assert_same(bsdf(&arguments), expected, &what);
                lit += usize::from(expected.x > 1e-3);
                let u = Vec3::new(
                    fraction(0.123_456_7) as f32,
                    fraction(0.765_432_1) as f32,
                    fraction(0.3) as f32,
                );
                let arguments = [&boundary[..], &u.to_array(), &v.to_array()].concat();
                let expected = interface.sample(u, v).unwrap_or_default();
                assert!((sample(&arguments) - expected).length() < 1e-4, "{what} u {u}: {expected}");
            }
        }
    }
    assert!(lit > 2000, "{lit}");
}

#[test]
fn plates_wavelengths_and_absorption_are_the_same_in_wgsl() {
    let twins = Twins::new();
    let of = |name| twins.function(name);
    let [reflectance, transmittance, tilted] =
        ["try_reflectance", "try_transmittance", "try_oblique"].map(of);
    let [bent, index, weight, nm, kept] =
        ["try_refracted", "try_index", "try_spectrum", "try_wavelength", "try_absorption"].map(of);
    for i in 0..=200u16 {
        let x = f32::from(i) / 200.0;
        let colour = Vec3::new(x, 1.0 - x, 0.3);
        let pane = slab(Vec3::splat(x), colour);
        let arguments = [x, colour.x, colour.y, colour.z];
        assert_same(reflectance(&arguments), pane.reflectance, "reflectance");
        assert_same(transmittance(&arguments), pane.transmittance, "transmittance");
        let arguments = [colour.x, colour.y, colour.z, x];
        assert_same(tilted(&arguments), oblique(colour, x), "oblique");

        let v = direction(90.0 * f64::from(x), 30.0);
        for eta in [1.5, 1.0, 0.6] {
            let expected = refracted(v, Vec3::Z, eta).unwrap_or_default();
            assert_same(bent(&[v.x, v.y, v.z, eta]), expected, "refracted");
        }
        let (n, abbe, wave) = (1.3 + x, 10.0 + 80.0 * x, 400.0 + 300.0 * x);
        let b = dispersion::cauchy_of_abbe(n, abbe);
        let expected = Vec3::new(b, dispersion::cauchy(n, b, wave), refracted_cosine(abbe / 100.0, 1.0 / n));
        assert_same(index(&[n, abbe, wave]), expected, "index");
        let expected = dispersion::spectrum(x);
        assert_same(weight(&[x]), expected.weight, "weight");
        assert_same(nm(&[x]), Vec3::splat(expected.nm), "wavelength");
        for distance in [0.0, 0.5, 3.0] {
            let expected = absorption::left(absorption::coefficient(colour, distance), 2.0 * x);
            let arguments = [colour.x, colour.y, colour.z, distance, 2.0 * x];
            assert_same(kept(&arguments), expected, "absorption");
        }
    }
}
