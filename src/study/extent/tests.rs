use std::{f64::consts::PI, sync::Arc};

use glam::{DMat3, DVec3, Vec3};

use super::{
    super::{Lab, Settings},
    SCENE,
    ltc::{Fitted, cosine_share, density, diffuse_share},
    split_sum::Filter,
    subject::{self, Lamp, Way},
};
use crate::{
    light::{Emitter, LightRecord},
    optics::{Frame, albedo, geometry::direction, sequence::Sequence},
    parameter::Value,
    registry::Registry,
    scene::{Light, Scene, emitter},
};

fn lab(registry: &Registry) -> Lab<'_> {
    Lab { registry, settings: Settings { quick: true }, figures: 0, tables: 0 }
}

/// A rectangle with luminance 1, its corners, and its emitter.
struct Softbox {
    light: Light,
    emitter: Box<dyn Emitter>,
    record: LightRecord,
    corners: [Vec3; 4],
}

fn softbox(registry: &Registry, position: Vec3, direction: Vec3) -> Softbox {
    let scene = lab(registry).scene(SCENE).expect("shipped");
    let light = Light {
        position: Some(position),
        direction: Some(direction),
        intensity: 1.0,
        ..scene.lights[1].clone()
    };
    let (_, emitter, record) = emitter(&light, registry, scene.display.encoding).expect("known");
    let lamp = Lamp::new(&light, registry, &scene).expect("known");
    Softbox { emitter, record, corners: lamp.corners().expect("a rectangle"), light }
}

/// Rectangles around the origin, of which the last two reach below the horizon.
fn softboxes(registry: &Registry) -> [Softbox; 4] {
    [
        (Vec3::new(0.3, 0.2, 2.0), Vec3::NEG_Z),
        (Vec3::new(-2.0, 0.5, 2.5), Vec3::new(2.0, -0.6, -2.2)),
        (Vec3::new(-2.5, 0.0, 0.4), Vec3::new(1.0, 0.0, 0.1)),
        (Vec3::new(0.5, 2.0, 0.2), Vec3::new(0.0, -1.0, 0.3)),
    ]
    .map(|(position, direction)| softbox(registry, position, direction))
}

/// The integral of a function of the direction over a softbox, seen from the origin, by sampling.
fn integral(softbox: &Softbox, of: impl Fn(Vec3) -> f64) -> f64 {
    const COUNT: u32 = 1 << 14;
    let sequence = Sequence::new(9, 1);
    let one = |i| {
        let sample = softbox.emitter.sample(&softbox.record, Vec3::ZERO, sequence.point(i));
        if sample.pdf > 0.0 { of(sample.l) / f64::from(sample.pdf) } else { 0.0 }
    };
    (0..COUNT).map(one).sum::<f64>() / f64::from(COUNT)
}

#[test]
fn the_share_of_a_polygon_is_that_of_the_closed_forms() {
    // A rectangle parallel to the surface, with a corner above the point, at the height 1: J. R. Howell, *A Catalog of
    // Radiation Heat Transfer Configuration Factors*, B-3.
    for (a, b) in [(0.5f64, 0.3f64), (2.0, 1.0), (40.0, 60.0)] {
        let corners = [(0.0, 0.0), (a, 0.0), (a, b), (0.0, b)].map(|(x, y)| DVec3::new(x, y, 1.0));
        let half = |a: f64, b: f64| a / a.hypot(1.0) * (b / a.hypot(1.0)).atan();
        let exact = (half(a, b) + half(b, a)) / (2.0 * PI);
        assert!((cosine_share(&corners) - exact).abs() < 1e-12, "{a} {b}");
        // The reverse order gives the same.
        let back = [corners[3], corners[2], corners[1], corners[0]];
        assert!((cosine_share(&back) - exact).abs() < 1e-12);
    }
    // An infinite wall, half of it below the horizon, provides half of the light; below there is none.
    let wall = |x: f64, z: f64| DVec3::new(x * 1e7, 1.0, z * 1e7);
    let all = [wall(-1.0, -1.0), wall(1.0, -1.0), wall(1.0, 1.0), wall(-1.0, 1.0)];
    assert!((cosine_share(&all) - 0.5).abs() < 1e-6, "{}", cosine_share(&all));
    assert_eq!(cosine_share(&all.map(|c| DVec3::new(c.x, c.y, -1.0 - c.z.abs()))), 0.0);
}

#[test]
fn the_identity_is_lamberts_law() {
    let registry = Registry::builtin();
    let lambert = lab(&registry).surface("lambert", "base_colour=255,255,255").expect("it can be made");
    let v = direction(40.0, 0.0);
    let identity = Fitted::of(DMat3::IDENTITY);
    for (i, softbox) in softboxes(&registry).iter().enumerate() {
        let response = |l: Vec3| f64::from(lambert.response(l, v, &Frame::LOCAL).diffuse.y);
        let exact = integral(softbox, response) / PI;
        for share in [identity.share(&softbox.corners, Vec3::Z, v), diffuse_share(&softbox.corners, Vec3::Z)]
        {
            assert!((share / exact - 1.0).abs() < 2e-3, "{i}: {share} {exact}");
        }
        // Wrong twins: a slightly narrower lobe, and a rectangle that the horizon does not clip.
        let narrower = Fitted::of(DMat3::from_diagonal(DVec3::new(0.9, 0.9, 1.0)));
        assert!((narrower.share(&softbox.corners, Vec3::Z, v) / exact - 1.0).abs() > 0.01, "{i}");
        if i >= 2 {
            let corners = softbox.corners.map(|c| c.as_dvec3().normalize());
            let uncut: f64 = (0..4)
                .map(|i| {
                    let (a, b) = (corners[i], corners[(i + 1) % 4]);
                    a.angle_between(b) * a.cross(b).normalize().z / (2.0 * PI)
                })
                .sum();
            assert!((uncut.abs() / exact - 1.0).abs() > 0.05, "{i}: {uncut}");
        }
    }
}

#[test]
fn a_transformed_cosine_stays_a_density() {
    let matrix =
        DMat3::from_cols(DVec3::new(0.3, 0.0, 0.2), DVec3::new(0.0, 0.6, 0.0), DVec3::new(0.5, 0.0, 0.8));
    let (inverse, sequence, count) = (matrix.inverse(), Sequence::new(4, 1), 1 << 16);
    let mean = |of: &dyn Fn(DVec3) -> f64| {
        let at = |i| of(crate::optics::sampling::sphere(sequence.point(i)).as_dvec3());
        4.0 * PI * (0..count).map(at).sum::<f64>() / f64::from(count)
    };
    assert!((mean(&|l| density(&inverse, l)) - 1.0).abs() < 5e-3);
    let twin = mean(&|l| density(&inverse, l) / inverse.determinant().abs());
    assert!((twin - 1.0).abs() > 0.1, "without the change of solid angle: {twin}");
}

#[test]
fn fitted_lobes_are_near_to_ggx_and_far_from_another_width() {
    let registry = Registry::builtin();
    let lab = lab(&registry);
    let ggx = |alpha: f64| {
        let settings = format!("fresnel=none alpha_x={alpha} alpha_y={alpha}");
        lab.surface("microfacet", &settings).expect("it can be made")
    };
    let (right, wrong) = (Fitted::new(&*ggx(0.25), 0.25), Fitted::new(&*ggx(0.35), 0.35));
    let misplaced: Vec<f64> = right.all().map(|(_, _, off)| off).collect();
    // Up to 60°, and beyond, where the horizon cuts GGX but not the cosine.
    assert!(misplaced[..11].iter().all(|off| *off < 0.09), "{misplaced:?}");
    assert!(misplaced[11..].iter().all(|off| *off < 0.3), "{misplaced:?}");
    let surface = ggx(0.25);
    // The lobe is round along the normal, and slanted towards a grazing view.
    let (_, first, _) = right.all().next().expect("there is one");
    assert!((first.x_axis.x / first.y_axis.y - 1.0).abs() < 0.02 && first.z_axis.x.abs() < 0.01, "{first}");
    let (mut off, mut twin) = (0.0f64, 0.0f64);
    for softbox in &softboxes(&registry)[..2] {
        for degrees in [0.0, 20.0, 40.0] {
            let v = direction(degrees, 0.0);
            let of = |l: Vec3| f64::from(surface.response(l, v, &Frame::LOCAL).specular.y);
            let e = albedo::directional(|l| surface.response(l, v, &Frame::LOCAL), v, &Frame::LOCAL).y;
            let exact = integral(softbox, of) / (PI * e);
            off = off.max((right.share(&softbox.corners, Vec3::Z, v) - exact).abs());
            twin = twin.max((wrong.share(&softbox.corners, Vec3::Z, v) - exact).abs());
        }
    }
    assert!(off < 0.03 && twin > 2.0 * off, "{off} {twin}");
}

/// Uniform surroundings in which a white surface that absorbs nothing is as bright as its albedo.
fn uniform(registry: &Registry) -> (Scene, Arc<Lamp>) {
    let mut scene = lab(registry).scene(SCENE).expect("shipped");
    let mut light = scene.lights.swap_remove(2);
    light.parameters.set("source", Value::Choice("uniform".into()));
    light.colour_temperature = None;
    light.intensity = std::f32::consts::FRAC_1_PI;
    let lamp = Lamp::new(&light, registry, &scene).expect("known");
    (scene, Arc::new(lamp))
}

#[test]
fn the_split_sum_is_exact_in_uniform_surroundings() {
    let registry = Registry::builtin();
    let (_, lamp) = uniform(&registry);
    let lab = lab(&registry);
    for subject in subject::all() {
        let surface = subject.surface(&lab).expect("it can be made");
        let mut known = subject.known(&lab, 1024).expect("it can be made");
        let error = |known: &Arc<subject::Known>| {
            let mut most = 0.0f64;
            for degrees in [0.0, 30.0, 60.0, 75.0] {
                let v = direction(degrees, 0.0);
                let exact = albedo::directional(|l| surface.response(l, v, &Frame::LOCAL), v, &Frame::LOCAL);
                // From far enough, the observer is in a single direction.
                let leaving = Way::SplitSum.leaving(known, &lamp, v * 1e6);
                let found = leaving(Vec3::ZERO, Vec3::Z, Vec3::X).as_dvec3();
                most = most.max(((found - exact) / exact).abs().max_element());
            }
            most
        };
        let right = Arc::new(known);
        // Curves of albedos are interpolated to 0.002, of an albedo of about 0.3.
        assert!(error(&right) < 8e-3, "{}: {}", subject.name, error(&right));
        // The wrong twin: weights that are not divided by their sum.
        known = Arc::into_inner(right).expect("no one else has it");
        known.filter_mut().forget_norm();
        let wrong = error(&Arc::new(known));
        assert!(wrong > 0.02, "{}: {wrong}", subject.name);
    }
}

#[test]
fn filters_are_mirrors_when_narrow_and_irradiance_when_wide() {
    let registry = Registry::builtin();
    let scene = lab(&registry).scene(SCENE).expect("shipped");
    let (_, sky, record) = emitter(&scene.lights[2], &registry, scene.display.encoding).expect("known");
    let sky = (&*sky, &record);
    for axis in [Vec3::new(0.3, 0.8, 0.2), Vec3::new(-0.5, 0.5, 0.7), Vec3::new(0.1, -0.9, 0.2)] {
        let axis = axis.normalize();
        let exact = sky.0.seen(sky.1, Vec3::ZERO, axis).radiance * sky.1.colour;
        let of = |alpha: f32| (Filter::ggx(alpha, 512).mean(sky, Vec3::ZERO, axis) / exact - 1.0).y.abs();
        assert!(of(0.005) < 0.01, "{axis}: {}", of(0.005));
        if axis.y > 0.0 {
            assert!(of(0.7) > 0.02, "{axis}: a wide lobe is no mirror");
        }
    }
    // Two ways to obtain one number: samples, and Lambert's polygon.
    for softbox in softboxes(&registry) {
        let mean = Filter::cosine(2048).mean((&*softbox.emitter, &softbox.record), Vec3::ZERO, Vec3::Z);
        let exact = diffuse_share(&softbox.corners, Vec3::Z);
        assert!(
            (f64::from(mean.y) / exact - 1.0).abs() < 5e-3,
            "{}: {mean} {exact}",
            softbox.light.intensity
        );
    }
}
