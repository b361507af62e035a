//! Lights with extent: their densities, the luminances of sun and sky, their flux, and places at which numbers could cease to be
//! finite.

use std::f64::consts::{PI, TAU};

use glam::{DVec3, Quat, Vec2, Vec3};
use rayon::prelude::*;

use super::{
    Emitter, LightEntry, LightRecord,
    extent::{SMALLEST, Sample, Seen},
};
use crate::{
    optics::{
        chi_squared::{over, passes},
        colour::Encoding,
        sampling,
        sequence::Sequence,
    },
    parameter::{ParameterKind, Values},
    registry::Registry,
};

/// A light of intensity 1.
struct Lamp {
    entry: LightEntry,
    values: Values,
    emitter: Box<dyn Emitter>,
    record: LightRecord,
}

/// A light of a type with parameters such as `width=2 roll=30`.
fn lamp(id: &str, settings: &str, position: [f32; 3], direction: [f32; 3]) -> Lamp {
    let entry = *Registry::builtin().light(id).expect("built in");
    let mut values = Values::default();
    for (name, text) in settings.split(' ').filter_map(|word| word.split_once('=')) {
        let parameter = entry.parameters.iter().find(|p| p.name == name).expect(name);
        values.set(parameter.name, parameter.parse(text).expect(name));
    }
    let record = LightRecord {
        position: position.into(),
        direction: Vec3::from(direction).normalize_or_zero(),
        colour: Vec3::ONE,
        intensity: 1.0,
        ..LightRecord::default()
    };
    let emitter = (entry.instantiate)(&values, Encoding::Srgb);
    Lamp { entry, values, emitter, record }
}

/// The surroundings from a source, such as `sky sky_type=5`.
fn surroundings(source: &str) -> Lamp {
    lamp("environment", &format!("source={source}"), [0.0; 3], [0.0; 3])
}

impl Lamp {
    fn seen(&self, p: Vec3, l: Vec3) -> Seen {
        self.emitter.seen(&self.record, p, l)
    }

    fn sample(&self, p: Vec3, u: Vec2) -> Sample {
        self.emitter.sample(&self.record, p, u)
    }

    /// The mean over samples of a function of the direction times the radiance.
    fn integral(&self, p: Vec3, count: u32, of: impl Fn(Vec3) -> f64) -> f64 {
        let sequence = Sequence::new(21, 1);
        let one = |i| {
            let Sample { l, radiance, pdf } = self.sample(p, sequence.point(i));
            if pdf > 0.0 { f64::from(radiance.y) / f64::from(pdf) * of(l) } else { 0.0 }
        };
        (0..count).map(one).sum::<f64>() / f64::from(count)
    }
}

#[test]
fn solid_angles_by_formula_are_those_of_the_samples() {
    let p = Vec3::new(0.3, -0.2, 0.1);
    for (id, settings, position, direction) in [
        ("rectangle", "width=2 height=1 roll=25", [0.5, 1.5, 2.0], [-0.2, -0.5, -1.0]),
        ("rectangle", "width=0.01 height=0.02", [1.0, 2.0, 1.0], [-0.5, -1.0, -0.4]),
        ("rectangle", "width=3 height=2 two_sided=true", [0.0, 0.0, 1.0], [0.1, 0.2, 1.0]),
        ("sphere", "radius=0.8", [1.0, 1.0, 1.0], [0.0; 3]),
        ("sphere", "radius=0.001", [4.0, 1.0, 1.0], [0.0; 3]),
        ("sun", "diameter=0.53", [0.0; 3], [0.0, -1.0, 0.3]),
        ("sun", "diameter=60", [0.0; 3], [0.0, -1.0, 0.3]),
        ("environment", "source=uniform", [0.0; 3], [0.0; 3]),
        ("environment", "source=studio", [0.0; 3], [0.0; 3]),
    ] {
        let lamp = lamp(id, settings, position, direction);
        let exact = lamp.emitter.fills(&lamp.record, p).expect(id);
        let sequence = Sequence::new(5, 1);
        let inverse = |i| {
            let pdf = lamp.sample(p, sequence.point(i)).pdf;
            if pdf > 0.0 { 1.0 / f64::from(pdf) } else { 0.0 }
        };
        let count = 1 << 15;
        let mean = (0..count).map(inverse).sum::<f64>() / f64::from(count);
        assert!((mean / exact - 1.0).abs() < 0.01, "{id} {settings}: {exact}, by samples {mean}");
    }
    // The wrong twin: area over squared distance, without the cosine.
    let flat = lamp("rectangle", "width=0.01 height=0.02", [1.0, 2.0, 1.0], [-0.5, -1.0, -0.4]);
    let exact = flat.emitter.fills(&flat.record, p).expect("a rectangle");
    let wrong = 0.01 * 0.02 / f64::from((flat.record.position - p).length_squared());
    assert!((wrong / exact - 1.0).abs() > 0.01, "{wrong} {exact}");
    // From behind and from inside nothing is seen.
    let behind = Vec3::new(2.0, 4.0, 1.8);
    assert_eq!(flat.emitter.fills(&flat.record, behind), Some(0.0));
    let sphere = lamp("sphere", "radius=0.8", [1.0, 1.0, 1.0], [0.0; 3]);
    for inside in [Vec3::ONE, Vec3::new(1.0, 1.5, 1.0)] {
        assert_eq!(sphere.emitter.fills(&sphere.record, inside), Some(0.0));
    }
}

/// The directions in which a light may be, stretched over the whole sphere, so that small lights fill many boxes of the
/// chi-squared test.
enum Chart {
    /// A cone.
    Cone {
        axis: DVec3,
        sides: [DVec3; 2],
        /// 1 minus the cosine of the half angle.
        rise: f64,
    },
    /// A tube: by the sine of the angle along it, and by the turn about its axis. Its density grows beyond all bounds towards
    /// its outline, therefore the turn is `limit · sin ψ`, which makes up for it.
    Tube {
        axis: DVec3,
        /// From the point to the axis, and across.
        sides: [DVec3; 2],
        /// Half the angle between its outlines.
        limit: f64,
        /// The sines of the angles of its ends.
        ends: [f64; 2],
    },
}

impl Chart {
    /// Slightly more than the directions of a light as seen from the origin; by default all, about y.
    fn around(lamp: &Lamp) -> Self {
        if lamp.entry.declaration.id == "cylinder" {
            return Self::along(lamp);
        }
        let (axis, rise) = match lamp.emitter.bounds(&lamp.record, Vec3::ZERO) {
            Some(cone) => {
                (cone.axis, 2.0 * (0.5 * (1.15 * f64::from(cone.half_angle)).min(PI)).sin().powi(2))
            }
            None => (Vec3::Y, 2.0),
        };
        let axis = axis.as_dvec3().normalize();
        let (x, y) = axis.any_orthonormal_pair();
        Self::Cone { axis, sides: [x, y], rise }
    }

    fn along(lamp: &Lamp) -> Self {
        let number = |name| {
            let parameter = lamp.entry.parameters.iter().find(|p| p.name == name).expect("it has it");
            f64::from(lamp.values.number(parameter))
        };
        let [radius, length] = ["radius", "length"].map(number);
        let [axis, middle] = [lamp.record.direction, lamp.record.position].map(|v| v.as_dvec3());
        let axis = axis.normalize();
        let from = middle - middle.dot(axis) * axis;
        let out = from.normalize();
        // At the distance at which an end is farthest to its side.
        let end = |side: f64| {
            let at = middle.dot(axis) + side * (0.5 * length + 0.02);
            let away = from.length() - if at * side > 0.0 { radius } else { -radius };
            at / at.hypot(away)
        };
        Self::Tube {
            axis,
            sides: [out, axis.cross(out)],
            limit: (radius / from.length()).asin(),
            ends: [end(-1.0), end(1.0)],
        }
    }

    /// `None` for directions outside it.
    fn to_sphere(&self, l: Vec3) -> Option<Vec3> {
        let l = l.as_dvec3().normalize();
        let (z, turn) = match self {
            Self::Cone { axis, sides: [x, y], rise } => {
                let cosine = axis.dot(l);
                // From the squared sine, which keeps the digits of small angles.
                let squared = axis.cross(l).length_squared().min(1.0);
                let down = if cosine > 0.0 { squared / (1.0 + (1.0 - squared).sqrt()) } else { 1.0 - cosine };
                (1.0 - 2.0 * down / rise, y.dot(l).atan2(x.dot(l)))
            }
            Self::Tube { axis, sides: [x, y], limit, ends: [low, high] } => {
                let part = y.dot(l).atan2(x.dot(l)) / limit;
                if part.abs() > 1.0 + 1e-5 {
                    return None;
                }
                (2.0 * (axis.dot(l) - low) / (high - low) - 1.0, 2.0 * part.clamp(-1.0, 1.0).asin())
            }
        };
        let sine = (1.0 - z * z).max(0.0).sqrt();
        (z.abs() <= 1.0 + 1e-9).then(|| DVec3::new(sine * turn.cos(), sine * turn.sin(), z).as_vec3())
    }

    /// The direction for one on the sphere, and the solid angle that a small part of the sphere is there, relative to it.
    fn to_light(&self, d: Vec3) -> (Vec3, f64) {
        let (z, turn) = (f64::from(d.z), f64::from(d.y).atan2(f64::from(d.x)));
        let (up, turn, axis, [x, y], part) = match self {
            Self::Cone { axis, sides, rise } => (1.0 - 0.5 * rise * (1.0 - z), turn, axis, sides, 0.5 * rise),
            Self::Tube { axis, sides, limit, ends: [low, high] } => {
                let up = low + 0.5 * (high - low) * (1.0 + z);
                // At the outline itself, directions would be rounded.
                let last = 0.5 * PI - 3e-3;
                let (sine, cosine) = (0.5 * turn).clamp(-last, last).sin_cos();
                (up, limit * sine, axis, sides, 0.25 * limit * cosine * (high - low))
            }
        };
        let flat = ((1.0 - up) * (1.0 + up)).max(0.0).sqrt();
        ((*axis * up + flat * (*x * turn.cos() + *y * turn.sin())).as_vec3(), part)
    }
}

/// A light as seen from the origin, with a wrong density for its samples.
struct Case {
    name: &'static str,
    lamp: Lamp,
    twin: Twin,
}

type Twin = fn(&Lamp, Vec3, Seen) -> f64;

/// The angle from a direction, radians.
fn off(axis: Vec3, l: Vec3) -> f64 {
    let (axis, l) = (axis.as_dvec3(), l.as_dvec3());
    axis.cross(l).length().atan2(axis.dot(l))
}

/// The density of directions whose angle from an axis is evenly distributed up to a limit.
fn even_in_angle(angle: f64, limit: f64) -> f64 {
    1.0 / (TAU * limit * angle.sin().max(1e-9))
}

/// The density without the cosine of the emitting surface.
fn without_cosine(normal: Vec3, l: Vec3, pdf: f32) -> f64 {
    f64::from(pdf * normal.dot(l).abs())
}

fn case(name: &'static str, lamp: Lamp, twin: Twin) -> Case {
    Case { name, lamp, twin }
}

fn cases() -> Vec<Case> {
    let rectangle: Twin = |lamp, l, seen| {
        // Evenly over its area of 1.6 m × 0.8 m.
        f64::from(seen.distance.powi(2) / (1.28 * lamp.record.direction.dot(l).abs()))
    };
    let flat: Twin = |lamp, l, seen| without_cosine(lamp.record.direction, l, seen.pdf);
    let disc: Twin = |lamp, l, seen| {
        // Evenly in r instead of in r².
        let r = (l * seen.distance - lamp.record.position).length();
        f64::from(seen.pdf * 0.8 / (2.0 * r))
    };
    let cylinder: Twin = |lamp, l, seen| {
        let at = l * seen.distance - lamp.record.position;
        let out = at - at.dot(lamp.record.direction) * lamp.record.direction;
        without_cosine(out.normalize(), l, seen.pdf)
    };
    let sphere: Twin = |lamp, l, _| {
        let to = lamp.record.position;
        even_in_angle(off(to.normalize(), l), (0.5 / f64::from(to.length())).asin())
    };
    let sun: Twin = |lamp, l, _| even_in_angle(off(-lamp.record.direction, l), 20f64.to_radians());
    let small_sun: Twin = |lamp, l, _| even_in_angle(off(-lamp.record.direction, l), 0.265f64.to_radians());
    // As if turned the other way by 25°.
    let turned: Twin =
        |lamp, l, _| lamp.seen(Vec3::ZERO, Quat::from_rotation_y(50f32.to_radians()) * l).pdf.into();
    let all_around = [0.0; 3];
    vec![
        case(
            "rectangle",
            lamp("rectangle", "width=1.6 height=0.8 roll=30", [0.3, 0.2, 1.0], [-0.2, 0.1, -1.0]),
            rectangle,
        ),
        case(
            "rectangle from its back",
            lamp(
                "rectangle",
                "width=1.6 height=0.8 roll=-70 two_sided=true",
                [-0.4, 0.2, -0.9],
                [0.3, 0.1, -1.0],
            ),
            rectangle,
        ),
        case(
            "rectangle far away",
            lamp("rectangle", "width=0.6 height=0.4 roll=10", [2.0, 1.0, 9.0], [1.0, 0.2, -1.0]),
            flat,
        ),
        case("disc", lamp("disc", "radius=0.8", [0.2, -0.3, 0.7], [0.1, 0.2, -1.0]), disc),
        case("disc at an angle", lamp("disc", "radius=0.6", [1.2, 0.2, 0.3], [-0.3, 0.0, -1.0]), flat),
        case(
            "disc from its back",
            lamp("disc", "radius=0.8 two_sided=true", [0.2, -0.3, 0.7], [0.5, 0.2, 1.0]),
            disc,
        ),
        case("sphere", lamp("sphere", "radius=0.5", [0.0, 1.2, 1.6], all_around), sphere),
        case("near sphere", lamp("sphere", "radius=0.5", [0.3, 0.0, -0.42], all_around), sphere),
        case(
            "cylinder",
            lamp("cylinder", "length=2.4 radius=0.3", [0.0, 0.3, 1.2], [1.0, 0.2, 0.0]),
            cylinder,
        ),
        case(
            "cylinder along its axis",
            lamp("cylinder", "length=1.5 radius=0.1", [0.5, 0.0, 2.0], [0.0, 0.2, 1.0]),
            cylinder,
        ),
        case("sun", lamp("sun", "diameter=0.53", [0.0; 3], [0.3, -1.0, 0.2]), small_sun),
        case("wide sun", lamp("sun", "diameter=40", [0.0; 3], [-0.3, -0.4, 1.0]), sun),
        case("uniform surroundings", surroundings("uniform"), |_, l, _| {
            // Evenly in the angle from the zenith.
            even_in_angle(off(Vec3::Y, l), PI)
        }),
        case("studio", surroundings("studio rotation=25"), turned),
        case("sky", surroundings("sky sky_type=12 sun_elevation=20 rotation=-70"), |_, l, _| {
            // No samples around the sun.
            if l.y > 0.0 { 0.8 / TAU } else { 0.2 / TAU }
        }),
        case("picture", surroundings("file rotation=25"), turned),
    ]
}

#[test]
fn every_type_with_extent_and_every_source_is_among_the_cases() {
    let cases = cases();
    let registry = Registry::builtin();
    for entry in registry.lights().iter().filter(|entry| entry.declaration.extent) {
        let id = entry.declaration.id;
        assert!(cases.iter().any(|case| case.lamp.entry.declaration.id == id), "{id}");
    }
    let environment = registry.light("environment").expect("built in");
    let source = environment.parameters.iter().find(|p| p.name == "source").expect("it has sources");
    let ParameterKind::Choice(choice) = &source.kind else { panic!("a choice") };
    for (id, _) in choice.options {
        let value = source.parse(id).expect("a source");
        assert!(cases.iter().any(|case| case.lamp.values.0.get("source") == Some(&value)), "{id}");
    }
}

#[test]
fn samples_of_every_light_have_its_density() {
    let wrong: Vec<_> = cases()
        .par_iter()
        .flat_map_iter(|Case { name, lamp, twin }| {
            let chart = Chart::around(lamp);
            let sample = |random: &mut dyn FnMut() -> f32| {
                let Sample { l, pdf, .. } = lamp.sample(Vec3::ZERO, Vec2::new(random(), random()));
                (pdf > 0.0).then(|| chart.to_sphere(l).expect("within the bounds"))
            };
            let statistic = |density: &dyn Fn(Vec3, Seen) -> f64| {
                over::<16>(sample, |d| {
                    let (l, part) = chart.to_light(d);
                    let seen = lamp.seen(Vec3::ZERO, l);
                    let density = if seen.pdf > 0.0 { density(l, seen) } else { 0.0 };
                    (part * density) as f32
                })
            };
            let right = statistic(&|_, seen| seen.pdf.into());
            let wrong = statistic(&|l, seen| twin(lamp, l, seen));
            let ok = right.1 > 60.0 && passes(right) && !passes(wrong);
            (!ok).then(|| format!("{name}: {right:?}, wrong twin {wrong:?}"))
        })
        .collect();
    assert_eq!(wrong, [""; 0]);
}

/// Largest difference of an integral over the samples of a light from one over even directions, relative to all of its light.
const INTEGRAL: f64 = 4e-3;

#[test]
fn densities_integrate_to_one_and_samples_to_the_light_that_is_seen() {
    const COUNT: u32 = 1 << 14;
    let wrong: Vec<_> = cases()
        .par_iter()
        .flat_map_iter(|Case { name, lamp, twin }| {
            let chart = Chart::around(lamp);
            let sequence = Sequence::new(11, 1);
            // The density, the radiance, and the radiance by direction, from even directions of the chart.
            let (mut whole, mut colours, mut vector) = (0.0, DVec3::ZERO, DVec3::ZERO);
            for i in 0..4 * COUNT {
                let (l, part) = chart.to_light(sampling::sphere(sequence.point(i)));
                let Seen { radiance, pdf, .. } = lamp.seen(Vec3::ZERO, l);
                let solid_angle = 4.0 * PI / f64::from(4 * COUNT) * part;
                whole += f64::from(pdf) * solid_angle;
                colours += radiance.as_dvec3() * solid_angle;
                vector += f64::from(radiance.y) * solid_angle * l.as_dvec3();
            }
            // The same by samples of the light, and with the wrong density.
            let (mut sampled, mut along, mut twins) = (DVec3::ZERO, DVec3::ZERO, 0.0);
            for i in 0..COUNT {
                let Sample { l, radiance, pdf } = lamp.sample(Vec3::ZERO, sequence.point(i));
                let (radiance, pdf) = (radiance.as_dvec3(), f64::from(pdf));
                sampled += radiance / pdf;
                along += radiance.y / pdf * l.as_dvec3();
                let seen = lamp.seen(Vec3::ZERO, l);
                // At an edge, a direction may be rounded out of the light.
                twins += if seen.pdf > 0.0 { radiance.y / twin(lamp, l, seen) } else { 0.0 };
            }
            let [sampled, along] = [sampled, along].map(|sum| sum / f64::from(COUNT));
            let all = colours.y;
            let errors =
                [whole - 1.0, (sampled - colours).abs().max_element() / all, (along - vector).length() / all];
            let twin = (twins / f64::from(COUNT) / all - 1.0).abs();
            let ok = all > 0.0 && errors.iter().all(|e| e.abs() < INTEGRAL) && twin > 3.0 * INTEGRAL;
            (!ok).then(|| format!("{name}: {errors:?}, wrong twin {twin}"))
        })
        .collect();
    assert_eq!(wrong, [""; 0]);
}

/// The groups of gradation and indicatrix: S. Darula, R. Kittler (2002), *CIE General Sky Standard Defining Luminance
/// Distributions*, table 1.
const GRADATION: [[f64; 2]; 6] =
    [[4.0, -0.7], [1.1, -0.8], [0.0, -1.0], [-1.0, -0.55], [-1.0, -0.32], [-1.0, -0.15]];
const INDICATRIX: [[f64; 3]; 6] = [
    [0.0, -1.0, 0.0],
    [2.0, -1.5, 0.15],
    [5.0, -2.5, 0.3],
    [10.0, -3.0, 0.45],
    [16.0, -3.0, 0.3],
    [24.0, -2.8, 0.15],
];

/// The groups of the fifteen types.
const GROUPS: [[usize; 2]; 15] = [
    [1, 1],
    [1, 2],
    [2, 1],
    [2, 2],
    [3, 1],
    [3, 2],
    [3, 3],
    [3, 4],
    [4, 2],
    [4, 3],
    [4, 4],
    [5, 4],
    [5, 5],
    [6, 5],
    [6, 6],
];

/// The luminance of a sky of a type from 1 to 15 relative to its zenith, with the angles of the direction and of the sun from
/// the zenith, and the azimuth between them, degrees.
fn relative(kind: usize, [zenith, sun, between]: [f64; 3]) -> f64 {
    let [a, b] = GRADATION[GROUPS[kind - 1][0] - 1];
    let [c, d, e] = INDICATRIX[GROUPS[kind - 1][1] - 1];
    let gradation = |z: f64| if z < PI / 2.0 - 1e-9 { 1.0 + a * (b / z.cos()).exp() } else { 1.0 };
    let indicatrix = |chi: f64| 1.0 + c * ((d * chi).exp() - (d * PI / 2.0).exp()) + e * chi.cos().powi(2);
    let [z, s, between] = [zenith, sun, between].map(f64::to_radians);
    let chi = (s.cos() * z.cos() + s.sin() * z.sin() * between.cos()).clamp(-1.0, 1.0).acos();
    gradation(z) * indicatrix(chi) / (gradation(0.0) * indicatrix(s))
}

/// The direction with an elevation above the horizon, and an azimuth from −z, clockwise as seen from above, degrees.
fn towards(elevation: f64, azimuth: f64) -> Vec3 {
    let [elevation, azimuth] = [elevation, azimuth].map(f64::to_radians);
    let flat = elevation.cos();
    DVec3::new(flat * azimuth.sin(), elevation.sin(), -flat * azimuth.cos()).as_vec3()
}

/// The luminance of surroundings.
fn luminance(sky: &Lamp, elevation: f64, azimuth: f64) -> f64 {
    sky.seen(Vec3::ZERO, towards(elevation, azimuth)).radiance.y.into()
}

fn near(a: f64, b: f64, tolerance: f64) -> bool {
    (a / b - 1.0).abs() < tolerance
}

#[test]
fn the_overcast_sky_is_a_third_as_bright_at_the_horizon_as_at_the_zenith() {
    let sky = |kind: u32| surroundings(&format!("sky sky_type={kind} zenith_luminance=3000"));
    let overcast = sky(1);
    let at = |elevation: f64| luminance(&overcast, elevation, 77.0) / luminance(&overcast, 90.0, 0.0);
    assert!(near(luminance(&overcast, 90.0, 0.0), 3000.0, 1e-6));
    // 1 / (1 + 4 exp(−0.7)), and half way up (1 + 4 exp(−0.7 √2)) / (1 + 4 exp(−0.7)).
    assert!(near(at(0.05), 1.0 / 2.986_341, 1e-4), "{}", at(0.05));
    assert!(near(at(45.0), 2.486_382 / 2.986_341, 1e-4), "{}", at(45.0));
    // P. Moon, D. Spencer (1942): (1 + 2 sin γ) / 3, which the type replaces.
    let moon = |elevation: f64| (1.0 + 2.0 * elevation.to_radians().sin()) / 3.0;
    let off = |kind: u32| {
        let sky = sky(kind);
        let at = |elevation: f64| luminance(&sky, elevation, 200.0) / 3000.0 - moon(elevation);
        (0..=18).map(|i| at(0.05 + 4.9 * f64::from(i)).abs()).fold(0.0, f64::max)
    };
    assert!(off(1) < 0.1, "{}", off(1));
    // The wrong twins: the other overcast sky, and the uniform one.
    assert!(off(3) > 0.3 && off(5) > 0.6, "{} {}", off(3), off(5));
}

#[test]
fn the_uniform_sky_is_the_same_everywhere_above_the_ground() {
    let settings = |kind: u32| {
        surroundings(&format!(
            "sky sky_type={kind} zenith_luminance=500 ground_reflectance=0.3 sun_elevation=20"
        ))
    };
    let darkest_and_brightest = |sky: &Lamp| {
        let all = (1..=90).flat_map(|i| (0..24).map(move |j| (f64::from(i), 15.0 * f64::from(j))));
        let all = all.map(|(elevation, azimuth)| luminance(sky, elevation, azimuth));
        all.fold([f64::MAX, 0.0f64], |[low, high], l| [low.min(l), high.max(l)])
    };
    let uniform = settings(5);
    let [darkest, brightest] = darkest_and_brightest(&uniform);
    assert!(near(darkest, 500.0, 1e-5) && near(brightest, 500.0, 1e-5), "{darkest} {brightest}");
    // The ground: illuminance π L, scattered evenly.
    assert!(near(luminance(&uniform, -30.0, 10.0), 0.3 * 500.0, 1e-4));
    // The wrong twin is its neighbour in the table.
    let [darkest, brightest] = darkest_and_brightest(&settings(6));
    assert!(brightest / darkest > 2.0, "{darkest} {brightest}");
}

#[test]
fn a_clear_sky_is_eleven_times_as_bright_at_the_sun_as_at_the_zenith() {
    let sky = |kind: u32| {
        surroundings(&format!("sky sky_type={kind} sun_elevation=35 sun_azimuth=140 zenith_luminance=2000"))
    };
    let ratio = |kind: u32| luminance(&sky(kind), 35.0, 140.0) / luminance(&sky(kind), 90.0, 0.0);
    // By hand, with a = −1, b = −0.32, c = 10, d = −3, e = 0.45, and the sun 55° from the zenith: f(0) = 11.3602, f(55°) =
    // 1.6197, φ(55°) = 0.42759, φ(0) = 0.27385.
    let expected = 11.360_167 * 0.427_592 / (1.619_676 * 0.273_851);
    assert!(near(expected, 10.9515, 1e-4), "{expected}");
    assert!(near(ratio(12), expected, 1e-3), "{}", ratio(12));
    assert!(near(relative(12, [55.0, 55.0, 0.0]), expected, 1e-4));
    // The wrong twins are its neighbours in the table.
    assert!(!near(ratio(11), expected, 0.05) && !near(ratio(13), expected, 0.05));
}

#[test]
fn the_slider_of_the_zenith_luminance_ends_where_its_values_are_of_use() {
    let entry = *Registry::builtin().light("environment").expect("built in");
    let parameter = entry.parameters.iter().find(|p| p.name == "zenith_luminance").expect("declared");
    let limits = parameter.kind.limits().expect("a number");
    assert_eq!(
        (limits.slider_max, limits.max, parameter.kind.default_value().numbers()[0] as f32),
        (1.0, 20_000.0, 0.1)
    );
}

#[test]
fn all_types_of_sky_are_those_of_the_standard() {
    /// Largest relative difference, attributed to single precision.
    const MOST: f64 = 2e-4;
    let mut seen = 0;
    for kind in 1..=15 {
        let mut mistaken = 0.0f64;
        for (sun, azimuth) in [(5.0, -100.0), (40.0, 0.0), (75.0, 250.0), (90.0, 30.0)] {
            let sky = surroundings(&format!(
                "sky sky_type={kind} sun_elevation={sun} sun_azimuth={azimuth} zenith_luminance=4000"
            ));
            for (elevation, around) in
                (0..=17).flat_map(|i| (0..9).map(move |j| (1.0 + 5.0 * f64::from(i), 40.0 * f64::from(j))))
            {
                let found = luminance(&sky, elevation, azimuth + around) / 4000.0;
                let angles = [90.0 - elevation, 90.0 - sun, around];
                let expected = relative(kind, angles);
                assert!(near(found, expected, MOST), "type {kind}, {sun}° {angles:?}: {found} {expected}");
                // The wrong twin: the next type.
                mistaken = mistaken.max((found / relative(kind % 15 + 1, angles) - 1.0).abs());
                seen += 1;
            }
        }
        assert!(mistaken > 100.0 * MOST, "type {kind} could be the next one: {mistaken}");
    }
    assert_eq!(seen, 15 * 4 * 18 * 9);
}

#[test]
fn the_sun_stands_at_its_azimuth_clockwise_from_minus_z_and_at_its_elevation() {
    let half = 0.5f32.sqrt();
    let thirty = 0.75f32.sqrt();
    let all = [
        ("sun_elevation=0.5 sun_azimuth=0", Vec3::NEG_Z),
        ("sun_elevation=0.5 sun_azimuth=90", Vec3::X),
        ("sun_elevation=0.5 sun_azimuth=180", Vec3::Z),
        ("sun_elevation=0.5 sun_azimuth=-90", Vec3::NEG_X),
        ("sun_elevation=30 sun_azimuth=90", Vec3::new(thirty, 0.5, 0.0)),
        ("sun_elevation=45 sun_azimuth=180", Vec3::new(0.0, half, half)),
        ("sun_elevation=60 sun_azimuth=225", Vec3::new(-0.5 * half, thirty, 0.5 * half)),
        ("sun_elevation=90 sun_azimuth=70", Vec3::Y),
        // Turned anticlockwise by 90° as seen from above: from x to −z.
        ("sun_elevation=30 sun_azimuth=90 rotation=90", Vec3::new(0.0, 0.5, -thirty)),
    ];
    /// The angle between a direction and the brightest one of a sky that is much brighter around the sun, degrees.
    fn away(settings: &str, from: Vec3) -> f64 {
        let sky = surroundings(&format!("sky sky_type=8 {settings}"));
        // Coarsely, then finely around the brightest direction: its gradation is even, so that only the sun counts.
        let brightest = |all: &mut dyn Iterator<Item = (f64, f64)>| {
            let by = |a: &(f64, f64), b: &(f64, f64)| {
                luminance(&sky, a.0, a.1).total_cmp(&luminance(&sky, b.0, b.1))
            };
            all.max_by(by).expect("some")
        };
        let whole =
            (0..46).flat_map(|i| (0..180).map(move |j| (0.1 + 2.0 * f64::from(i), 2.0 * f64::from(j))));
        let (e, a) = brightest(&mut whole.filter(|(elevation, _)| *elevation < 90.0));
        let around = (-20..=20).flat_map(|i| (-20..=20).map(move |j| (f64::from(i), f64::from(j))));
        let around =
            around.map(|(i, j)| (e + 0.1 * i, a + 0.1 * j)).filter(|(e, _)| (0.1..=90.0).contains(e));
        let (e, a) = brightest(&mut { around });
        off(from, towards(e, a)).to_degrees()
    }
    for (settings, expected) in all {
        let found = away(settings, expected);
        assert!(found < 0.7, "{settings}: {found}° away");
        // The wrong twins: anticlockwise, or from z.
        for twin in [Vec3::new(-1.0, 1.0, 1.0), Vec3::new(1.0, 1.0, -1.0)] {
            let twin = twin * expected;
            if twin.distance(expected) > 0.1 {
                assert!(away(settings, twin) > 20.0, "{settings}");
            }
        }
    }
}

#[test]
fn the_ground_scatters_the_illuminance_of_the_sky() {
    for kind in [1, 4, 9, 12, 15] {
        let sky = surroundings(&format!(
            "sky sky_type={kind} sun_elevation=50 zenith_luminance=1000 ground_reflectance=0.25"
        ));
        // By the midpoint rule over the published formula, in steps of half a degree and two degrees.
        let (mut cosines, mut even) = (0.0, 0.0);
        for (i, j) in (0..180).flat_map(|i| (0..180).map(move |j| (i, j))) {
            let [zenith, around] = [0.5 * (f64::from(i) + 0.5), 2.0 * (f64::from(j) + 0.5)];
            let angle = zenith.to_radians();
            let light = 1000.0 * relative(kind, [zenith, 40.0, around]) * angle.sin();
            let area = 0.5f64.to_radians() * 2f64.to_radians();
            cosines += light * angle.cos() * area;
            even += light * area;
        }
        for azimuth in [0.0, 130.0] {
            let found = luminance(&sky, -20.0, azimuth);
            assert!(near(found, 0.25 * cosines / PI, 2e-3), "type {kind}: {found} {cosines}");
            // The wrong twin: without the cosine of the ground.
            assert!(!near(found, 0.25 * even / PI, 0.2), "type {kind}: {found} {even}");
        }
    }
}

#[test]
fn the_illuminance_of_the_sun_is_its_luminance_times_its_projected_solid_angle() {
    for (diameter, noticeable) in [(0.01, false), (0.53, false), (10.0, false), (60.0, true), (90.0, true)] {
        let mut sun = lamp("sun", &format!("diameter={diameter}"), [0.0; 3], [0.2, -1.0, 0.4]);
        sun.record.intensity = 100_000.0;
        let to_sun = -sun.record.direction;
        let luminance = f64::from(sun.seen(Vec3::ZERO, to_sun).radiance.y);
        let radius = 0.5 * f64::from(diameter as f32).to_radians();
        let projected = PI * radius.sin().powi(2);
        let solid_angle = 2.0 * TAU * (0.5 * radius).sin().powi(2);
        assert!(near(luminance * projected, 1e5, 1e-5), "{diameter}°: {luminance}");
        // The wrong twin: without the cosine of the surface, which matters for wide ones only.
        assert_eq!(!near(luminance * solid_angle, 1e5, 0.01), noticeable, "{diameter}°");
        let found = sun.integral(Vec3::ZERO, 1 << 12, |l| f64::from(l.dot(to_sun)));
        assert!(near(found, 1e5, 1e-3), "{diameter}°: {found}");
        // On a surface at 45°, by the cosine, since no part sets.
        let (across, _) = to_sun.any_orthonormal_pair();
        let n = (to_sun + across).normalize();
        let slanted = sun.integral(Vec3::ZERO, 1 << 12, |l| f64::from(l.dot(n).max(0.0)));
        assert!(near(slanted, 1e5 * 0.5f64.sqrt(), 1e-3), "{diameter}°: {slanted}");
        // It ends where it should: a hundredth inside and outside its radius.
        let at = |part: f64| {
            let (sine, cosine) = (part * radius).sin_cos();
            sun.seen(Vec3::ZERO, to_sun * cosine as f32 + across * sine as f32).radiance.y
        };
        assert!(at(0.99) > 0.0 && at(1.01) == 0.0, "{diameter}°");
    }
    // The sun as seen from the earth: 1.5 · 10⁹ cd/m².
    let mut sun = lamp("sun", "diameter=0.53", [0.0; 3], [0.0, -1.0, 0.0]);
    sun.record.intensity = 1e5;
    assert!(near(f64::from(sun.seen(Vec3::ZERO, Vec3::Y).radiance.x), 1.488e9, 1e-3));
}

#[test]
fn luminous_flux_is_all_the_light_that_leaves_a_lamp() {
    // The radiance that arrives on the inside of a sphere around the lamp, times the cosine there.
    const RADIUS: f32 = 4.0;
    const PLACES: u32 = 1 << 12;
    let (turn, middle) = ([0.3, -1.0, 0.5], [0.4, 0.1, -0.3]);
    let all = [
        ("rectangle", "width=1.5 height=0.7 roll=20", 1.5 * 0.7, 1.0),
        ("rectangle", "width=1.5 height=0.7 two_sided=true", 1.5 * 0.7, 2.0),
        ("disc", "radius=0.9", PI * 0.81, 1.0),
        ("disc", "radius=0.9 two_sided=true", PI * 0.81, 2.0),
        ("sphere", "radius=1.2", 4.0 * PI * 1.44, 1.0),
        ("cylinder", "length=2.5 radius=0.4", TAU * 0.4 * 2.5, 1.0),
    ];
    for (id, settings, area, sides) in all {
        let mut lamp = lamp(id, settings, middle, turn);
        lamp.record.intensity = 7.0;
        let lamp = &lamp;
        let (places, across) = (Sequence::new(8, 0), Sequence::new(8, 1));
        let one = |i: u32| {
            let out = sampling::sphere(places.point(i));
            let p = RADIUS * out;
            // Four samples of the lamp at each place.
            (0..4).map(move |j| {
                let Sample { l, radiance, pdf } = lamp.sample(p, across.point(4 * i + j));
                let cosine = f64::from(-l.dot(out));
                if pdf > 0.0 { f64::from(radiance.y) * cosine / f64::from(pdf) } else { 0.0 }
            })
        };
        let sum: f64 = (0..PLACES).flat_map(one).sum();
        let found = sum * 4.0 * PI * f64::from(RADIUS).powi(2) / f64::from(4 * PLACES);
        let declared = 7.0 * lamp.entry.solid_angle(&lamp.values).expect("it has a flux");
        assert!(near(declared, 7.0 * PI * area * sides, 1e-5), "{id} {settings}: {declared}");
        assert!(near(found, declared, 0.01), "{id} {settings}: {found} {declared}");
        // The wrong twins: the other number of sides, and without the cosine of the lamp.
        for twin in [2.0, 0.5] {
            assert!(!near(found, twin * declared, 0.2), "{id} {settings}: {found}");
        }
    }
}

/// Lamps of the least, of usual and of the greatest size, with places on them, at their edges, in their planes, behind and inside
/// them, just beside them and far away.
fn awkward() -> Vec<(String, Lamp, Vec<Vec3>)> {
    let mut all = Vec::new();
    for size in [SMALLEST, 0.37, 100.0] {
        for (id, settings) in [
            ("rectangle", format!("width={size} height={size} roll=33")),
            ("rectangle", format!("width={size} height={SMALLEST} two_sided=true")),
            ("rectangle", format!("width=100 height={size}")),
            ("disc", format!("radius={size}")),
            ("disc", format!("radius={size} two_sided=true")),
            ("sphere", format!("radius={size}")),
            ("cylinder", format!("radius={size} length={size}")),
            ("cylinder", format!("radius={SMALLEST} length={size}")),
            ("cylinder", format!("radius={size} length={SMALLEST}")),
        ] {
            for direction in [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.3, 0.5, -0.8]] {
                let lamp = lamp(id, &settings, [1.0, 2.0, 3.0], direction);
                let n = lamp.record.direction;
                let [x, y] = super::extent::sides(n, Vec2::Y);
                let mut places = vec![Vec3::ZERO, Vec3::splat(1e4), lamp.record.position + 1e6 * n];
                for along in [0.0, 0.25, 0.5, 1.0, 1.0 + 1e-6, 2.0] {
                    for tiny in [0.0, 1e-7, -1e-7, 1e-3, -1e-3, 0.5, -0.5, 1.0, -1.0] {
                        for side in [x, y, (x + y).normalize(), -x] {
                            places.push(lamp.record.position + size * (along * side + tiny * n));
                        }
                    }
                }
                all.push((format!("{id} {settings} {direction:?}"), lamp, places));
            }
        }
    }
    let far = [
        "diameter=0.01",
        "diameter=90",
        "source=uniform",
        "source=studio rotation=-360",
        "source=file",
        "source=sky sun_elevation=0",
        "source=sky sun_elevation=90 sky_type=15",
        "source=sky zenith_luminance=0",
        "source=sky zenith_luminance=20000 ground_reflectance=1 sky_type=14 sun_elevation=0",
    ];
    for settings in far {
        let id = if settings.starts_with("source") { "environment" } else { "sun" };
        for direction in [[0.0, -1.0, 0.0], [0.0, 0.0, -1.0], [0.3, 0.5, -0.8]] {
            let name = format!("{id} {settings} {direction:?}");
            all.push((name, lamp(id, settings, [0.0; 3], direction), vec![Vec3::ZERO, Vec3::splat(1e6)]));
        }
    }
    all
}

/// The flaw of light from a direction, if it has one.
fn odd(l: Vec3, radiance: Vec3, pdf: f32) -> Option<&'static str> {
    match () {
        () if !(l.is_finite() && radiance.is_finite() && pdf.is_finite()) => Some("not finite"),
        () if radiance.min_element() < 0.0 || pdf < 0.0 => Some("negative"),
        () if pdf > 0.0 && (l.length() - 1.0).abs() > 1e-4 => Some("no unit vector"),
        () => None,
    }
}

#[test]
fn everywhere_on_in_and_behind_lamps_of_every_size_light_is_finite_and_not_negative() {
    const LAST: f32 = 1.0 - 0.5 * f32::EPSILON;
    const PLACES: [Vec2; 7] = [
        Vec2::ZERO,
        Vec2::new(0.0, LAST),
        Vec2::new(LAST, 0.0),
        Vec2::new(LAST, LAST),
        Vec2::splat(0.5),
        Vec2::new(0.2, 0.999),
        Vec2::new(0.7, 0.3),
    ];
    let odd_ones: Vec<_> = awkward()
        .par_iter()
        .flat_map_iter(|(name, lamp, places)| {
            let mut found = Vec::new();
            let n = lamp.record.direction;
            for p in places {
                let to = (lamp.record.position - *p).normalize_or_zero();
                let beside = n.any_orthonormal_vector();
                let mut directions = vec![n, -n, beside, -beside, Vec3::Y, Vec3::NEG_Y, Vec3::Z];
                directions.extend((to != Vec3::ZERO).then_some(to));
                for u in PLACES {
                    let Sample { l, radiance, pdf } = lamp.sample(*p, u);
                    found.extend(odd(l, radiance, pdf).map(|what| format!("{name} {p} {u}: {what}")));
                    directions.extend((pdf > 0.0).then_some(l));
                }
                for l in directions {
                    let Seen { radiance, pdf, distance } = lamp.seen(*p, l);
                    let no_distance = distance.is_nan() || distance < 0.0;
                    let odd = odd(l, radiance, pdf).or(no_distance.then_some("no distance"));
                    found.extend(odd.map(|what| format!("{name} {p} towards {l}: {what}")));
                    if let Some(cone) = lamp.emitter.bounds(&lamp.record, *p) {
                        let within = off(cone.axis, l) < f64::from(cone.half_angle) + 1e-3;
                        if !(cone.axis.is_finite() && (within || radiance == Vec3::ZERO)) {
                            found.push(format!("{name} {p} towards {l}: outside of {cone:?}"));
                        }
                    }
                }
            }
            found
        })
        .collect();
    assert_eq!(odd_ones.iter().take(20).collect::<Vec<_>>(), [""; 0], "{}", odd_ones.len());
    // The wrong twins.
    assert_eq!(odd(Vec3::Y, Vec3::ONE, f32::INFINITY), Some("not finite"));
    assert_eq!(odd(Vec3::Y, Vec3::new(1.0, -1e-9, 1.0), 1.0), Some("negative"));
    assert_eq!(odd(Vec3::ONE, Vec3::ONE, 1.0), Some("no unit vector"));
}

#[test]
fn inside_and_behind_a_lamp_is_no_light_and_just_outside_is_half_a_world_of_it() {
    let dark = |lamp: &Lamp, p: Vec3| {
        let sequence = Sequence::new(4, 1);
        (0..256).all(|i| {
            let (u, l) = (sequence.point(i), sampling::sphere(sequence.point(i)));
            lamp.sample(p, u).pdf == 0.0 && lamp.seen(p, l).radiance == Vec3::ZERO
        })
    };
    let sphere = lamp("sphere", "radius=0.5", [0.0; 3], [0.0; 3]);
    let tube = lamp("cylinder", "radius=0.5 length=3", [0.0; 3], [0.0, 1.0, 0.0]);
    for (lamp, inside) in [(&sphere, Vec3::new(0.2, 0.1, -0.3)), (&tube, Vec3::new(0.2, 1.4, -0.3))] {
        for p in [Vec3::ZERO, inside, Vec3::new(0.0, 0.0, 0.4999)] {
            assert!(dark(lamp, p), "{p}");
        }
        assert!(!dark(lamp, Vec3::new(0.0, 0.0, 0.51)));
    }
    // Beyond the dark end of a tube, within its width.
    assert!(dark(&tube, Vec3::new(0.1, 2.0, 0.1)) && !dark(&tube, Vec3::new(0.6, 2.0, 0.1)));
    for id in ["rectangle", "disc"] {
        let [front, back] = [Vec3::new(0.1, -1e-3, 0.1), Vec3::new(0.1, 1e-3, 0.1)];
        let one = lamp(id, "", [0.0; 3], [0.0, -1.0, 0.0]);
        assert!(dark(&one, back) && !dark(&one, front), "{id}");
        let both = lamp(id, "two_sided=true", [0.0; 3], [0.0, -1.0, 0.0]);
        assert!(!dark(&both, back) && !dark(&both, front), "{id}");
    }
    // A surface that lies almost on a lamp gets π L, which is that of light from all of a hemisphere.
    for (lamp, p, n) in [
        (&sphere, Vec3::new(0.0, 0.0, 0.50005), Vec3::NEG_Z),
        (&lamp("rectangle", "width=2 height=2", [0.0; 3], [0.0, 1.0, 0.0]), Vec3::Y * 1e-3, Vec3::NEG_Y),
    ] {
        let found = lamp.integral(p, 1 << 14, |l| f64::from(l.dot(n).max(0.0)));
        assert!(near(found, PI, 0.01), "{found}");
        // Farther away it is less.
        let found = lamp.integral(p - n, 1 << 14, |l| f64::from(l.dot(n).max(0.0)));
        assert!(!near(found, PI, 0.1), "{found}");
    }
}

#[test]
fn each_type_has_a_glyph_of_its_own() {
    let registry = Registry::builtin();
    let glyphs: Vec<_> = registry.lights().iter().map(|light| light.declaration.glyph).collect();
    for (i, glyph) in glyphs.iter().enumerate() {
        assert!(!glyphs[..i].contains(glyph), "{glyph} is that of two types of light");
    }
}
