//! Directional albedo: the curves used in pictures, the quadrature on CPU and GPU, closed forms, and the white furnace.

use std::f32::consts::PI;

use glam::{Vec3, Vec4};
use lights_camera_models::{
    optics::{
        Frame, TermSelection, Terms,
        albedo::{AlbedoCurve, Albedos, Lines, LobeAlbedo, NamedCurve, Spacing, directional},
        colour::{BACKGROUND, Encoding},
    },
    parameter::{BASE_COLOUR, Parameter, Value, Values},
    parameters, reference,
    reflection::{self, EquationPart, ModelEntry, ReflectionModel, Term},
    registry::{Register, Registry, compose::compose_evaluation},
    render::capture::{
        evaluate::{albedos, evaluate},
        gpu::{GpuRenderer, Output},
    },
    scene::Scene,
    shader::{
        Source,
        check::{struct_layout, validate},
        compose::Sources,
    },
};

use crate::helpers::pictures::{close_up, compare, on_gpu};

const fn number(name: &'static str, default: f32) -> Parameter {
    Parameter::number(name, 0.0..=1.0, default).label("a number").help("A number.")
}

const SHARE: Parameter = number("share", 0.5);
const ALPHA_X: Parameter = number("alpha_x", 0.5);
const ALPHA_Y: Parameter = number("alpha_y", 0.5);

parameters! {
    /// Lambert and a GGX lobe that reflects everything, side by side.
    pub struct Patchwork {
        /// Of the Lambertian part.
        base_colour: colour = BASE_COLOUR,
        /// The fraction of the lobe.
        share: number = SHARE,
        /// Roughness.
        alpha_x: number = ALPHA_X,
    }
}

parameters! {
    /// A brushed GGX lobe that reflects everything, with compensation for multiple scattering (C. Kulla, A. Conty
    /// 2017).
    pub struct Brushed {
        /// Roughness along the tangent.
        alpha_x: number = ALPHA_X,
        /// Roughness across.
        alpha_y: number = ALPHA_Y,
    }
    derived {
        /// The reflection of the lobe alone.
        lobe: LobeAlbedo = |this: &Self| {
            let (x, y) = (this.alpha_x, this.alpha_y);
            LobeAlbedo::anisotropic(|l, v| ggx(l, v, &Frame::LOCAL, x, y))
        }
    }
}

/// The response of an anisotropic GGX lobe with F = 1 and height-correlated masking (E. Heitz 2014).
fn ggx(l: Vec3, v: Vec3, frame: &Frame, alpha_x: f32, alpha_y: f32) -> f32 {
    let local = |w: Vec3| Vec3::new(w.dot(frame.t), w.dot(frame.b), w.dot(frame.n));
    let (l, v) = (local(l), local(v));
    if l.z <= 0.0 || v.z <= 0.0 {
        return 0.0;
    }
    let h = (l + v).normalize();
    let (a, b) = (alpha_x.max(1e-3), alpha_y.max(1e-3));
    let s = (h.x / a).powi(2) + (h.y / b).powi(2) + h.z * h.z;
    let d = 1.0 / (PI * a * b * s * s);
    let root = |w: Vec3| ((a * w.x).powi(2) + (b * w.y).powi(2) + w.z * w.z).sqrt();
    // G/(4 n·l n·v) without a division by values that may vanish.
    let visibility = 0.5 / (v.z * root(l) + l.z * root(v));
    PI * d * visibility * l.z
}

/// The lobe in WGSL.
macro_rules! ggx {
    () => {
        "
fn lobe_of_test(l: vec3<f32>, v: vec3<f32>, frame: Frame, alpha_x: f32, alpha_y: f32) -> f32 {
    let cos_l = dot(l, frame.n);
    let cos_v = dot(v, frame.n);
    if cos_l <= 0.0 || cos_v <= 0.0 { return 0.0; }
    let alpha = max(vec2(alpha_x, alpha_y), vec2(1e-3));
    let h = half_vector(l, v);
    let q = vec3(vec2(dot(h, frame.t), dot(h, frame.b)) / alpha, dot(h, frame.n));
    let d = 1.0 / (PI * alpha.x * alpha.y * dot(q, q) * dot(q, q));
    let root_l = length(vec3(alpha * vec2(dot(l, frame.t), dot(l, frame.b)), cos_l));
    let root_v = length(vec3(alpha * vec2(dot(v, frame.t), dot(v, frame.b)), cos_v));
    return PI * d * cos_l * 0.5 / (cos_v * root_l + cos_l * root_v);
}
"
    };
}

parameters! {
    /// A body that reflects what its named curves say: a sum of the albedos of two lobes and of a polygonal line.
    pub struct Named {
        /// Roughness of the first lobe.
        alpha_x: number = ALPHA_X,
        /// Roughness of the second.
        alpha_y: number = ALPHA_Y,
    }
    derived {
        /// The albedos of the lobes.
        lobes: Albedos = |this: &Self| {
            let lobe = |a: f32| LobeAlbedo::new(move |l, v| ggx(l, v, &Frame::LOCAL, a, a));
            Albedos::of([lobe(this.alpha_x), lobe(this.alpha_y), LobeAlbedo::default(), LobeAlbedo::default()])
        },
        /// A polygonal line.
        line: Lines<5> = |this: &Self| {
            Lines::new([0.0, 0.9, 0.1, 0.5, this.alpha_x].map(|y| Vec4::new(y, 0.5 * y, 0.0, 0.0)))
        }
    }
}

const NAMED: reflection::Declaration = reflection::Declaration::new(
    "named",
    "Named",
    Source::new(
        "named.wgsl",
        "fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {
    let cos_l = dot(l, frame.n);
    let cos_v = dot(v, frame.n);
    if cos_l <= 0.0 || cos_v <= 0.0 { return Terms(vec3(0.0), vec3(0.0), vec3(0.0)); }
    let red = curve_lobes(cos_l).x * (1.0 - curve_lobes(cos_v).y) * mean_lobes().x;
    let green = curve_line(cos_v).x + value_seen(1u).z;
    let blue = curve_line(cos_l).y + mean_line().x;
    return Terms(vec3(0.0), cos_l * vec3(red, green, blue), vec3(0.0));
}
",
    ),
)
.summary("What its named curves say.")
.non_negative()
.ambient_by_albedo();

impl ReflectionModel for Named {
    const DECLARATION: reflection::Declaration = NAMED;
    const CURVES: &'static [NamedCurve] = &[
        NamedCurve { name: "lobes", spacing: Spacing::Cubic },
        NamedCurve { name: "line", spacing: Spacing::Linear(5) },
        NamedCurve { name: "seen", spacing: Spacing::Values(2) },
    ];

    fn response(&self, l: Vec3, v: Vec3, frame: &Frame) -> Terms {
        let (cos_l, cos_v) = (frame.n.dot(l), frame.n.dot(v));
        if cos_l <= 0.0 || cos_v <= 0.0 {
            return Terms::default();
        }
        let red = self.lobes.at(cos_l).x * (1.0 - self.lobes.at(cos_v).y) * self.lobes.mean().x;
        let (green, blue) =
            (self.line.at(cos_v).x + self.alpha_x, self.line.at(cos_l).y + self.line.mean().x);
        Terms { diffuse: cos_l * Vec3::new(red, green, blue), ..Terms::default() }
    }

    fn curves(&self) -> Vec<Vec4> {
        let seen = vec![Vec4::ZERO, Vec4::new(0.0, 0.0, self.alpha_x, 0.0)];
        [self.lobes.values(), self.line.values(), seen].concat()
    }
}

const PATCHWORK: reflection::Declaration = reflection::Declaration::new(
    "patchwork",
    "Patchwork",
    Source::new(
        "patchwork.wgsl",
        concat!(
            ggx!(),
            "fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {
    let lit = select(0.0, max(dot(frame.n, l), 0.0), dot(frame.n, v) > 0.0);
    let specular = m.share * lobe_of_test(l, v, frame, m.alpha_x, m.alpha_x);
    return Terms(vec3(0.0), (1.0 - m.share) * lit * m.base_colour, vec3(specular));
}
"
        ),
    ),
)
.summary("Lambert and GGX.")
.equation(&[EquationPart::new(Term::Total, "I = I_d + I_s")])
.reciprocal()
.energy_conserving()
.non_negative()
.ambient_by_albedo();

impl ReflectionModel for Patchwork {
    const DECLARATION: reflection::Declaration = PATCHWORK;

    fn response(&self, l: Vec3, v: Vec3, frame: &Frame) -> Terms {
        let lit = if frame.n.dot(v) > 0.0 { frame.n.dot(l).max(0.0) } else { 0.0 };
        Terms {
            diffuse: (1.0 - self.share) * lit * self.base_colour,
            specular: Vec3::splat(self.share * ggx(l, v, frame, self.alpha_x, self.alpha_x)),
            ..Terms::default()
        }
    }
}

impl ReflectionModel for Brushed {
    const DECLARATION: reflection::Declaration = reflection::Declaration::new(
        "brushed",
        "Brushed",
        Source::new(
            "brushed.wgsl",
            concat!(
                ggx!(),
                "fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {
    let cos_l = dot(l, frame.n);
    let cos_v = dot(v, frame.n);
    if cos_l <= 0.0 || cos_v <= 0.0 { return Terms(vec3(0.0), vec3(0.0), vec3(0.0)); }
    let lost = (1.0 - lobe_albedo(cos_l)) * (1.0 - lobe_albedo(cos_v));
    let back = cos_l * lost / max(1.0 - average_lobe_albedo(), 1e-6);
    return Terms(vec3(0.0), vec3(0.0), vec3(lobe_of_test(l, v, frame, m.alpha_x, m.alpha_y) + back));
}
"
            ),
        ),
    )
    .summary("A brushed GGX lobe.")
    .reciprocal()
    .energy_conserving()
    .non_negative()
    .ambient_by_albedo()
    .anisotropic();
    const LOBE: bool = true;

    fn response(&self, l: Vec3, v: Vec3, frame: &Frame) -> Terms {
        let (cos_l, cos_v) = (frame.n.dot(l), frame.n.dot(v));
        if cos_l <= 0.0 || cos_v <= 0.0 {
            return Terms::default();
        }
        let lost = (1.0 - self.lobe.at(cos_l)) * (1.0 - self.lobe.at(cos_v));
        let back = cos_l * lost / (1.0 - self.lobe.average()).max(1e-6);
        let specular = ggx(l, v, frame, self.alpha_x, self.alpha_y) + back;
        Terms { specular: Vec3::splat(specular), ..Terms::default() }
    }

    fn lobe(&self) -> Option<LobeAlbedo> {
        Some(self.lobe)
    }
}

fn register(to: &mut impl Register) {
    to.add_reflection_model::<Patchwork>();
    to.add_reflection_model::<Brushed>();
    to.add_reflection_model::<Named>();
}

fn registry() -> Registry {
    let mut registry = Registry::builtin();
    register(&mut registry);
    registry
}

fn values(numbers: &[(&'static str, f32)]) -> Values {
    let mut values = Values::default();
    for (name, number) in numbers {
        values.set(*name, Value::Number(*number));
    }
    values
}

fn view(mu: f32, azimuth: f32) -> Vec3 {
    let sin = (1.0 - mu * mu).max(0.0).sqrt();
    Vec3::new(sin * azimuth.cos(), sin * azimuth.sin(), mu)
}

#[test]
fn rows_lie_where_rust_puts_them() {
    let registry = registry();
    for (id, harmonics) in [("patchwork", 1), ("brushed", 3), ("lambert", 0)] {
        let model = registry.model(id).unwrap();
        let module = validate(&compose_evaluation(&Sources::default(), model)).expect("valid WGSL");
        let row = model.row(&Values::default(), Encoding::Srgb, true);
        let (fields, _) = struct_layout(&module, "Row").expect("there is a row");
        if harmonics == 0 {
            assert_eq!(fields.len(), 1);
            continue;
        }
        let curve = fields[1].1;
        let mean = curve + harmonics * 16 * 16;
        assert_eq!(fields[2], ("lobe_mean".to_owned(), mean));
        assert_eq!(row.len(), mean + 16);
        let at = |i: usize| f32::from_le_bytes(row[i..i + 4].try_into().unwrap());
        let surface = model.instantiate(&Values::default(), Encoding::Srgb);
        let nodes = surface.curve().expect("it has one").harmonics;
        assert_eq!(at(curve), nodes[0][0].x);
        assert_eq!(at(mean - 16), nodes[harmonics - 1][15].x);
        let lobe = surface.lobe().unwrap_or_default();
        assert_eq!((at(curve + 12), at(mean)), (lobe.nodes[0], lobe.average()));
        // Without uniform light the colours are skipped, the lobe stays.
        let dark = model.row(&Values::default(), Encoding::Srgb, false);
        assert_eq!(dark.len(), row.len());
        assert_eq!(dark[curve..curve + 12], [0; 12]);
        assert_eq!(dark[curve + 12..curve + 16], row[curve + 12..curve + 16]);
    }
}

/// The largest difference between the curve and both quadratures.
fn differences(model: &ModelEntry, values: &Values, views: &[Vec3]) -> [f64; 2] {
    let surface = model.instantiate(values, Encoding::Srgb);
    let gpu = albedos(&Sources::default(), model, values, Encoding::Srgb, views).expect("the GPU evaluates");
    let mut worst = [0.0f64; 2];
    for (v, gpu) in views.iter().zip(gpu) {
        let cpu = directional(|l| surface.response(l, *v, &Frame::LOCAL), *v, &Frame::LOCAL);
        let curve = surface.ambient_response(*v, &Frame::LOCAL).as_dvec3();
        worst[0] = worst[0].max((gpu - cpu).abs().max_element());
        worst[1] = worst[1].max((curve - cpu).abs().max_element());
    }
    worst
}

#[test]
fn curve_and_quadrature_agree_on_both_machines() {
    let registry = registry();
    for (id, numbers, tolerance) in [
        ("patchwork", &[("alpha_x", 0.05)][..], 5e-3),
        ("patchwork", &[("alpha_x", 0.3), ("share", 0.8)], 2e-3),
        ("patchwork", &[("alpha_x", 1.0), ("share", 1.0)], 3e-3),
        ("brushed", &[("alpha_x", 0.3), ("alpha_y", 0.3)], 3e-3),
        ("brushed", &[("alpha_x", 0.6), ("alpha_y", 0.25)], 1.2e-2),
    ] {
        let model = registry.model(id).unwrap();
        let views: Vec<_> = [0.02, 0.1, 0.25, 0.5, 0.77, 1.0]
            .iter()
            .flat_map(|mu| [0.0, 0.4, 1.2, 2.5].map(|azimuth| view(*mu, azimuth)))
            .collect();
        let [machines, curve] = differences(model, &values(numbers), &views);
        assert!(machines < 1e-4, "{id} {numbers:?}: CPU and GPU differ by {machines}");
        assert!(curve < tolerance, "{id} {numbers:?}: the curve is {curve} off");
    }
    // The wrong twins: another roughness, and an anisotropic surface treated as isotropic.
    let model = registry.model("patchwork").unwrap();
    let surface = model.instantiate(&values(&[("alpha_x", 0.31)]), Encoding::Srgb);
    let v = view(0.25, 0.0);
    let right =
        albedos(&Sources::default(), model, &values(&[("alpha_x", 0.3)]), Encoding::Srgb, &[v]).unwrap()[0];
    let wrong = directional(|l| surface.response(l, v, &Frame::LOCAL), v, &Frame::LOCAL);
    assert!((right - wrong).abs().max_element() > 1e-3);
    let turned = values(&[("alpha_x", 0.6), ("alpha_y", 0.25)]);
    let brushed = registry.model("brushed").unwrap().instantiate(&turned, Encoding::Srgb);
    let isotropic = AlbedoCurve::new(|l, v| brushed.response(l, v, &Frame::LOCAL), false);
    let v = view(0.25, PI / 2.0);
    let off = (isotropic.at(v, &Frame::LOCAL) - brushed.ambient_response(v, &Frame::LOCAL)).abs();
    assert!(off.max_element() > 5e-3, "{off}");
}

#[test]
fn the_lobe_in_the_row_is_the_lobe_of_the_model() {
    let registry = registry();
    let model = registry.model("brushed").unwrap();
    let set = values(&[("alpha_x", 0.9), ("alpha_y", 0.4)]);
    let pairs: Vec<_> = (0..400)
        .map(|i| {
            let i = i as f32;
            (view((i * 0.618).fract().max(0.05), i), view((i * 0.754).fract().max(0.05), 1.7 * i))
        })
        .collect();
    let gpu = evaluate(&Sources::default(), model, &set, Encoding::Srgb, &pairs).expect("the GPU evaluates");
    let surface = model.instantiate(&set, Encoding::Srgb);
    let worst = |of: &dyn Fn(Vec3, Vec3) -> f32| {
        let differ = |((l, v), gpu): (&(Vec3, Vec3), &Terms)| (gpu.specular.x / of(*l, *v) - 1.0).abs();
        pairs.iter().zip(&gpu).map(differ).fold(0.0, f32::max)
    };
    let right = worst(&|l, v| surface.response(l, v, &Frame::LOCAL).specular.x);
    assert!(right < 1e-4, "{right}");
    // The wrong twin: without compensation.
    assert!(worst(&|l, v| ggx(l, v, &Frame::LOCAL, 0.9, 0.4)) > 1e-2);
}

/// True if the responses of the GPU agree with those of a surface.
fn agrees(model: &ModelEntry, set: &Values, surface: &dyn reflection::Surface) -> bool {
    let pairs: Vec<_> = (0..400)
        .map(|i| {
            let i = i as f32;
            (view((i * 0.618).fract().max(0.001), i), view((i * 0.754).fract().max(0.001), 1.7 * i))
        })
        .collect();
    let gpu = evaluate(&Sources::default(), model, set, Encoding::Srgb, &pairs).expect("the GPU evaluates");
    let near = |((l, v), gpu): (&(Vec3, Vec3), &Terms)| {
        let cpu = surface.response(*l, *v, &Frame::LOCAL).diffuse;
        (cpu - gpu.diffuse).abs().max_element() <= 1e-4 * cpu.abs().max_element()
    };
    pairs.iter().zip(&gpu).all(near)
}

#[test]
fn named_curves_in_the_row_are_those_of_the_model() {
    let registry = registry();
    let model = registry.model("named").unwrap();
    assert_eq!(model.curve_length(), 16 + 17 + 6 + 2);
    assert!(model.has_curve() && model.has_lobe());
    let set = values(&[("alpha_x", 0.9), ("alpha_y", 0.4)]);
    let row = model.row(&set, Encoding::Srgb, false);
    let surface = model.instantiate(&set, Encoding::Srgb);
    let first = row.len() - 16 - 16 * (17 + 6 + 2);
    let at = |i: usize| f32::from_le_bytes(row[i..i + 4].try_into().unwrap());
    assert_eq!(at(first), surface.curves()[0].x);
    assert_eq!(at(first + 16 * 18 + 4), surface.curves()[18].y);
    assert!(agrees(model, &set, &*surface));
    // The wrong twin: the curves of other parameters.
    let other = values(&[("alpha_x", 0.9), ("alpha_y", 0.5)]);
    assert!(!agrees(model, &set, &*model.instantiate(&other, Encoding::Srgb)));
    // A model without named curves has none in its row.
    let plain = registry.model("patchwork").unwrap();
    assert!(plain.curves().is_empty() && plain.curve_length() == 16);
}

#[test]
fn a_compensated_isotropic_lobe_loses_nothing() {
    let registry = registry();
    let model = registry.model("brushed").unwrap();
    let surface = model.instantiate(&values(&[("alpha_x", 0.8), ("alpha_y", 0.8)]), Encoding::Srgb);
    for mu in [0.05, 0.3, 0.6, 1.0] {
        let v = view(mu, 0.3);
        let e = directional(|l| surface.response(l, v, &Frame::LOCAL), v, &Frame::LOCAL).x;
        assert!((e - 1.0).abs() < 2e-3, "μ {mu}: {e}");
        let lobe = directional(
            |l| Terms { specular: Vec3::splat(ggx(l, v, &Frame::LOCAL, 0.8, 0.8)), ..Terms::default() },
            v,
            &Frame::LOCAL,
        )
        .x;
        assert!(lobe < 0.95, "μ {mu}: without compensation {lobe}");
    }
}

/// Masking of Beckmann's distribution (P. Beckmann, A. Spizzichino 1963), exact: with the error function
/// of M. Abramowitz, I. Stegun, 7.1.26.
fn beckmann_lambda(w: Vec3, alpha: f64) -> f64 {
    let tan = f64::from(w.x).hypot(f64::from(w.y)) / f64::from(w.z);
    if tan == 0.0 {
        return 0.0;
    }
    let a = 1.0 / (alpha * tan);
    let t = 1.0 / (1.0 + 0.327_591_1 * a);
    let polynomial = t
        * (0.254_829_592
            + t * (-0.284_496_736 + t * (1.421_413_741 + t * (-1.453_152_027 + t * 1.061_405_429))));
    let bell = (-a * a).exp();
    (0.5 * (bell / (a * f64::from(PI).sqrt()) - polynomial * bell)).max(0.0)
}

fn ggx_lambda(w: Vec3, alpha: f64) -> f64 {
    let tan = f64::from(w.x).hypot(f64::from(w.y)) / f64::from(w.z);
    0.5 * ((1.0 + (alpha * tan).powi(2)).sqrt() - 1.0)
}

/// The response of a microfacet lobe with F = 1.
fn microfacets(beckmann: bool, correlated: bool, alpha: f64, l: Vec3, v: Vec3) -> f32 {
    if l.z <= 0.0 || v.z <= 0.0 {
        return 0.0;
    }
    let h = (l.as_dvec3() + v.as_dvec3()).normalize();
    let (tan2, cos4, a2) = ((h.x * h.x + h.y * h.y) / (h.z * h.z), h.z.powi(4), alpha * alpha);
    let (d, lambda): (f64, fn(Vec3, f64) -> f64) = if beckmann {
        ((-tan2 / a2).exp() / (a2 * cos4), beckmann_lambda)
    } else {
        (a2 / (cos4 * (a2 + tan2).powi(2)), ggx_lambda)
    };
    let (a, b) = (lambda(l, alpha), lambda(v, alpha));
    let g = if correlated { 1.0 / (1.0 + a + b) } else { 1.0 / ((1.0 + a) * (1.0 + b)) };
    (d * g / (4.0 * f64::from(v.z))) as f32
}

#[test]
fn microfacet_lobes_have_the_albedos_of_the_table() {
    let table = include_str!("../../data/golden/directional_albedo.csv");
    let rows: Vec<_> = table
        .lines()
        .skip(1)
        .map(|line| {
            let cells: Vec<_> = line.split(',').collect();
            let number = |i: usize| cells[i].parse::<f64>().expect("a number");
            (cells[0] == "beckmann", cells[1] == "hc", [number(2), number(4), number(5), number(8)])
        })
        .collect();
    assert_eq!(rows.len(), 264);
    let (mut worst, mut wrong) = (0.0f64, 0.0f64);
    let (mut curve, mut mean) = (0.0f64, 0.0f64);
    let mut lobe = LobeAlbedo::default();
    let mut of = None;
    for (beckmann, correlated, [alpha, mu, expected, average]) in rows {
        let v = view(mu as f32, 0.0);
        let e = |correlated: bool| {
            let response = |l| Terms {
                specular: Vec3::splat(microfacets(beckmann, correlated, alpha, l, v)),
                ..Terms::default()
            };
            directional(response, v, &Frame::LOCAL).x
        };
        worst = worst.max((e(correlated) - expected).abs());
        // The wrong twin: the other masking.
        wrong = wrong.max((e(!correlated) - expected).abs());
        if of.replace((beckmann, correlated, alpha)) != Some((beckmann, correlated, alpha)) {
            lobe = LobeAlbedo::new(|l, v| microfacets(beckmann, correlated, alpha, l, v));
        }
        curve = curve.max((f64::from(lobe.at(mu as f32)) - expected).abs());
        mean = mean.max((f64::from(lobe.average()) - average).abs());
    }
    assert!(worst < 1e-4 && wrong > 1e-2, "the quadrature is {worst} off, with the other masking {wrong}");
    assert!(curve < 4e-3 && mean < 1e-3, "the lobe is {curve} off, its average {mean}");
}

fn ambient_only(model: &str, shading: &str) -> Scene {
    let mut scene = close_up("torus", "ambient");
    scene.lights[0].intensity = 1.0;
    scene.lights[0].colour = [255; 3];
    scene.reflection_model = model.to_owned();
    scene.shading_model = shading.to_owned();
    scene
}

#[test]
fn light_from_everywhere_gives_the_same_picture_on_both_machines() {
    const SIZE: u32 = 96;
    let registry = registry();
    let mut renderer =
        GpuRenderer::extended(SIZE, SIZE, 1, Output::Linear, register).expect("software Vulkan is installed");
    let settings = reference::Settings { width: SIZE, height: SIZE, samples: 1, terms: TermSelection::All };
    let mut draw = |scene: &Scene| on_gpu(&mut renderer, scene);
    let background = Encoding::Srgb.decode(BACKGROUND);
    for model in ["patchwork", "brushed"] {
        for shading in registry.shading_models() {
            let mut scene = ambient_only(model, shading.declaration.id);
            scene.objects[0].material.set("alpha_x", Value::Number(0.9));
            scene.objects[0].material.set("alpha_y", Value::Number(0.3));
            let lamps = close_up("torus", "point").lights;
            // Lit first only by a lamp: the curve is filled when the ambient light appears.
            draw(&Scene { lights: lamps, ..scene.clone() });
            let gpu = draw(&scene);
            let d = compare(&gpu, &reference::render(&scene, &registry, &settings), background, 1e-3);
            assert!(
                d.covered > 500 && d.wrong == 0 && d.edges * 50 <= d.covered,
                "{model} {shading:?}: {d:?}"
            );
            // The wrong twin: another roughness.
            scene.objects[0].material.set("alpha_x", Value::Number(0.85));
            let d = compare(&gpu, &reference::render(&scene, &registry, &settings), background, 1e-3);
            assert!(d.wrong > 0 || d.edges * 50 > d.covered, "{model}: {d:?}");
        }
    }
}

#[test]
fn every_shape_vanishes_in_a_white_furnace_to_its_silhouette() {
    let registry = Registry::builtin();
    let settings = reference::Settings { width: 64, height: 64, samples: 1, terms: TermSelection::All };
    let furthest = |scene: &Scene| {
        let picture = reference::render(scene, &registry, &settings);
        let covered = picture.pixels.iter().filter(|p| p.w == 1.0);
        covered.map(|p| (p.truncate() - Vec3::ONE).abs().max_element()).fold(0.0, f32::max)
    };
    let choice = |name: &'static str, id: &'static str| (name, Value::Choice(id.into()));
    let compensated = [
        choice("fresnel", "none"),
        choice("diffuse", "none"),
        choice("multiple_scattering", "kulla_conty"),
        ("alpha_x", Value::Number(0.8)),
        ("alpha_y", Value::Number(0.8)),
    ];
    for (model, settings, tolerance) in
        [("eon", &[("roughness", Value::Number(1.0))][..], 1e-4), ("microfacet", &compensated[..], 4e-3)]
    {
        for shape in registry.shapes() {
            for shading in registry.shading_models() {
                let mut scene = ambient_only(model, shading.declaration.id);
                scene.objects[0].object_type = shape.declaration.id.to_owned();
                scene.objects[0].material.set("base_colour", Value::Colour([255; 3]));
                for (name, value) in settings {
                    scene.objects[0].material.set(*name, value.clone());
                }
                // Interpolated normals face away from the viewer there, most of all on the cube.
                let off = furthest(&scene);
                let case = format!("{model} × {} × {}", shape.declaration.id, shading.declaration.id);
                assert!(off < tolerance, "{case}: {off}");
                scene.objects[0].material.set("multiple_scattering", Value::Choice("none".into()));
                scene.objects[0].material.set("base_colour", Value::Colour([254; 3]));
                assert!(furthest(&scene) > tolerance, "{case}: the wrong twin vanishes too");
            }
        }
    }
}

#[test]
fn a_white_object_vanishes_in_a_white_furnace() {
    let registry = registry();
    let settings = reference::Settings { width: 64, height: 64, samples: 1, terms: TermSelection::All };
    let mut scene = ambient_only("patchwork", "phong");
    scene.objects[0].material.set("base_colour", Value::Colour([255; 3]));
    scene.objects[0].material.set("share", Value::Number(0.0));
    let furthest = |scene: &Scene| {
        reference::render(scene, &registry, &settings)
            .pixels
            .iter()
            .filter(|p| p.w == 1.0)
            .map(|p| (p.truncate() - Vec3::ONE).abs().max_element())
            .fold(0.0, f32::max)
    };
    assert!(furthest(&scene) < 1e-3);
    // A rough lobe without compensation loses light, and shows.
    scene.objects[0].material.set("share", Value::Number(1.0));
    scene.objects[0].material.set("alpha_x", Value::Number(1.0));
    assert!(furthest(&scene) > 0.1);
}
