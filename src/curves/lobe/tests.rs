use super::*;
use crate::{
    curves::{Detail, Setup, Subject, curve},
    optics::{Terms, colour::Encoding, geometry::mirror},
    parameter::{Value, Values},
    registry::Registry,
};

/// A frame that is not aligned with the axes.
fn tilted() -> Frame {
    Frame::new(Vec3::new(0.3, 0.8, -0.4).normalize(), Vec3::new(1.0, 0.2, 0.1))
}

fn values(set: &[(&'static str, Value)]) -> Values {
    let mut values = Values::default();
    set.iter().for_each(|(name, value)| values.set(*name, value.clone()));
    values
}

fn surface(model: &str, set: &[(&'static str, Value)]) -> std::sync::Arc<dyn Surface> {
    let registry = Registry::builtin();
    registry.model(model).expect("built in").instantiate(&values(set), Encoding::Srgb)
}

fn room(frame: &Frame, theta: f64, phi: f64) -> Vec3 {
    let d = direction(theta, phi);
    frame.t * d.x + frame.b * d.y + frame.n * d.z
}

fn lobe(surface: &dyn Surface, l: Vec3, frame: &Frame) -> Lobe {
    Lobe::new(surface, l, frame, TermSelection::All, &Progress::NONE).expect("not cancelled")
}

/// The direction in which the lobe is highest.
fn peak(lobe: &Lobe) -> Vec3 {
    let highest = (0..lobe.ways.len()).max_by(|a, b| lobe.values[*a].total_cmp(&lobe.values[*b]));
    lobe.ways[highest.expect("not empty")]
}

/// The value of the drawn surface in a direction, from the triangle that the direction meets.
fn drawn(lobe: &Lobe, way: Vec3) -> Option<f64> {
    let point = |i: u32| lobe.ways[i as usize] * lobe.values[i as usize] as f32;
    lobe.triangles.iter().find_map(|corners| {
        let [a, b, c] = corners.map(point);
        let normal = (b - a).cross(c - a).as_dvec3();
        let distance = normal.dot(a.as_dvec3()) / normal.dot(way.as_dvec3());
        let ways = corners.map(|i| lobe.ways[i as usize].as_dvec3());
        let turn = ways[0].cross(ways[1]).dot(ways[2]).signum();
        let side = |i: usize| turn * ways[i].cross(ways[(i + 1) % 3]).normalize().dot(way.as_dvec3());
        let inside = (0..3).all(|i| side(i) >= -1e-5);
        (inside && distance.is_finite()).then_some(distance)
    })
}

#[test]
fn every_length_is_the_value_of_the_curves() {
    let frame = tilted();
    for (model, set) in [
        ("blinn_phong", vec![("alpha", Value::Integer(1000))]),
        ("ward", vec![("alpha_x", Value::Number(0.1)), ("alpha_y", Value::Number(0.4))]),
        ("metallic_roughness", vec![]),
        ("diffuse_transmission", vec![]),
        ("rough_dielectric", vec![("alpha_x", Value::Number(0.3)), ("alpha_y", Value::Number(0.3))]),
    ] {
        let entry = Registry::builtin().model(model).expect("built in").clone();
        let subject = Subject::model(&entry, &values(&set), Encoding::Srgb);
        let surface = surface(model, &set);
        let lobe = lobe(&*surface, room(&frame, 50.0, 20.0), &frame);
        let setup = Setup::new(Kind::Polar, 50.0, 20.0).expect("legal");
        let plotted = curve(&subject, &setup, Detail::Fine, &Progress::NONE).expect("exists");
        let largest = lobe.largest();
        let (mut compared, mut sum) = (0, 0.0);
        for point in plotted.points.iter().filter(|point| (point.angle.abs() - 90.0).abs() > 1.0) {
            let (theta, phi) = if point.angle < 0.0 { (-point.angle, 20.0) } else { (point.angle, 200.0) };
            let Some(found) = drawn(&lobe, room(&frame, theta, phi)) else { continue };
            let right = Channel::Luminance.of(point.rgb);
            compared += 1;
            sum += (found - right).abs() / largest;
            // On a steep flank, a small step to the side is a large one along the ray.
            assert!(
                (found - right).abs() < 0.07 * largest,
                "{model}, {}°: {found}, not {right}",
                point.angle
            );
        }
        assert!(compared > 80, "{model}: {compared} angles");
        assert!(sum / f64::from(compared) < 0.01, "{model}: {sum} in all");
        // At the sampled directions, it is exact.
        for (way, found) in lobe.ways.iter().zip(&lobe.values) {
            let l = room(&frame, 50.0, 20.0);
            let right = if frame.n.dot(*way) < 0.0 {
                surface.behind(l, *way, &frame)
            } else {
                brdf_of(surface.response(l, *way, &frame), l, *way, &frame)
            };
            let right = Channel::Luminance.of(right);
            assert_eq!(*found, right);
        }
        // A wrong twin: the response, which has the cosine of the light.
        let top = peak(&lobe);
        let response = surface.response(room(&frame, 50.0, 20.0), top, &frame).select(TermSelection::All);
        assert!((Channel::Luminance.of(response) - largest).abs() > 0.1 * largest, "{model}");
    }
}

#[test]
fn a_matte_lobe_is_half_a_sphere() {
    let frame = tilted();
    let surface = surface("lambert", &[("base_colour", Value::Colour([255; 3]))]);
    let lobe = lobe(&*surface, room(&frame, 30.0, 70.0), &frame);
    let f = std::f64::consts::FRAC_1_PI;
    assert!(lobe.values.iter().all(|v| (v - f).abs() < 1e-6));
    let rim = lobe.ways.iter().map(|way| frame.n.dot(*way)).fold(f32::INFINITY, f32::min);
    assert!((0.0..0.002).contains(&rim), "it reaches down to the surface: {rim}");
    // The surface is round: no triangle is noticeably inside the sphere, and nothing was refined.
    for corners in &lobe.triangles {
        let middle = corners.iter().map(|i| lobe.ways[*i as usize]).sum::<Vec3>() / 3.0;
        assert!(middle.length() > 0.985, "{}", middle.length());
    }
    assert!(lobe.ways.len() < 600, "{}", lobe.ways.len());
    let linear = scale(&[&lobe], false);
    assert_eq!((linear.from, linear.to), (0.0, 0.4));
    assert!((f64::from(length(&linear, f)) - f / 0.4).abs() < 1e-6);
    assert_eq!((length(&linear, 0.0), length(&linear, -1.0), length(&linear, 9.0)), (0.0, 0.0, 1.0));
}

#[test]
fn isotropic_lobes_are_alike_on_both_sides_of_the_plane_of_incidence() {
    let frame = tilted();
    let l = room(&frame, 40.0, 130.0);
    let across = frame.n.cross(l).normalize();
    let mirrored = |way: Vec3| way - 2.0 * across.dot(way) * across;
    let worst = |lobe: &Lobe| {
        let of = |way: &Vec3, value: &f64| match drawn(lobe, mirrored(*way)) {
            Some(other) => (other - value).abs() / lobe.largest(),
            None => 0.0,
        };
        lobe.ways.iter().zip(&lobe.values).map(|(way, value)| of(way, value)).fold(0.0, f64::max)
    };
    for model in ["phong", "blinn_phong", "torrance_sparrow", "oren_nayar"] {
        let found = worst(&lobe(&*surface(model, &[]), l, &frame));
        assert!(found < 0.04, "{model}: {found}");
    }
    let brushed = surface("ward", &[("alpha_x", Value::Number(0.1)), ("alpha_y", Value::Number(0.4))]);
    assert!(worst(&lobe(&*brushed, l, &frame)) > 0.2, "brushed metal is not");
}

#[test]
fn a_highlight_turns_with_the_light_and_is_round_however_narrow() {
    let frame = tilted();
    let sharp = surface("blinn_phong", &[("alpha", Value::Integer(1000)), ("k_d", Value::Number(0.0))]);
    for (theta, phi) in [(0.0, 0.0), (20.0, 40.0), (45.0, 300.0), (70.0, 111.0)] {
        let l = room(&frame, theta, phi);
        let lobe = lobe(&*sharp, l, &frame);
        let off = peak(&lobe).angle_between(mirror(l, frame.n)).to_degrees();
        assert!(off < 1.5, "light at {theta}°: {off}° beside the mirror direction");
        let half = lobe.values.iter().filter(|v| **v > 0.5 * lobe.largest()).count();
        assert!(half >= 12, "light at {theta}°: {half} directions in the highlight");
        assert!(lobe.ways.len() < MOST + MOST / 2, "{}", lobe.ways.len());
    }
}

#[test]
fn a_term_alone_has_a_lobe_of_its_own() {
    let frame = tilted();
    let l = room(&frame, 45.0, 0.0);
    let phong = surface("phong", &[]);
    let of = |terms| Lobe::new(&*phong, l, &frame, terms, &Progress::NONE).expect("not cancelled");
    let [all, diffuse, specular] =
        [TermSelection::All, TermSelection::Diffuse, TermSelection::Specular].map(of);
    let spread = |lobe: &Lobe| lobe.values.iter().copied().fold(f64::INFINITY, f64::min) / lobe.largest();
    assert!(spread(&diffuse) > 0.999 && spread(&specular) < 1e-6);
    assert!((diffuse.largest() + specular.largest() - all.largest()).abs() < 1e-5);
    assert_eq!(of(TermSelection::Ambient).largest(), 0.0);
}

/// A surface that returns NaN on one side of the plane x = 0 of the room, and infinity at the normal.
struct Broken {
    everywhere: bool,
}

impl Surface for Broken {
    fn response(&self, _l: Vec3, v: Vec3, _frame: &Frame) -> Terms {
        let diffuse = if self.everywhere || v.x < -0.1 { Vec3::NAN } else { Vec3::splat(v.x - 0.05) };
        Terms { diffuse, ..Terms::default() }
    }

    fn ambient_response(&self, _v: Vec3, _frame: &Frame) -> Vec3 {
        Vec3::ZERO
    }

    fn curve(&self) -> Option<crate::optics::albedo::AlbedoCurve> {
        None
    }

    fn lobe(&self) -> Option<crate::optics::albedo::LobeAlbedo> {
        None
    }

    fn readouts(&self) -> Vec<crate::reflection::Readout> {
        Vec::new()
    }
}

#[test]
fn what_is_no_number_is_a_gap() {
    let l = direction(30.0, 10.0);
    let some = lobe(&Broken { everywhere: false }, l, &Frame::LOCAL);
    assert!(some.has_gaps() && some.is_negative());
    assert!(!some.triangles.is_empty());
    for corners in &some.triangles {
        assert!(corners.iter().all(|i| some.values[*i as usize].is_finite()));
    }
    // The edge of the gap was found.
    let edge =
        some.triangles.iter().flatten().map(|i| some.ways[*i as usize].x).fold(f32::INFINITY, f32::min);
    assert!((-0.1..-0.04).contains(&edge), "{edge}");
    let none = lobe(&Broken { everywhere: true }, l, &Frame::LOCAL);
    assert!(none.triangles.is_empty() && none.has_gaps() && none.largest() == 0.0);
    assert!(scale(&[&none], false).to == 1.0 && scale(&[&none], true).log);
}

#[test]
fn light_from_below_gives_nothing_and_work_can_be_stopped() {
    let frame = tilted();
    let phong = surface("phong", &[]);
    assert_eq!(lobe(&*phong, -frame.n, &frame).largest(), 0.0);
    let stopped = Progress { tell: &|_, _| {}, cancelled: &|| true };
    assert_eq!(Lobe::new(&*phong, frame.n, &frame, TermSelection::All, &stopped), Err(Cancelled));
}

#[test]
fn lobes_of_models_that_light_passes_through_are_over_both_sides() {
    let frame = tilted();
    let below = |lobe: &Lobe| {
        let low = lobe.ways.iter().zip(&lobe.values).filter(|(way, _)| way.dot(frame.n) < -0.1);
        low.map(|(_, value)| *value).collect::<Vec<_>>()
    };
    let paper = surface("diffuse_transmission", &[]);
    let from_above = lobe(&*paper, room(&frame, 40.0, 10.0), &frame);
    let half = 0.5 / std::f64::consts::PI;
    assert!(below(&from_above).iter().all(|f| (f - half).abs() < 1e-5), "{:?}", below(&from_above));
    // No rim: every edge has two triangles.
    let mut edges_of: Vec<_> = from_above.triangles.iter().flat_map(|corners| edges(*corners)).collect();
    edges_of.sort_unstable();
    assert!(edges_of.chunk_by(|a, b| a == b).all(|same| same.len() == 2));
    // Light from below comes out above.
    let from_below = lobe(&*paper, room(&frame, 140.0, 10.0), &frame);
    assert!(below(&from_below).iter().all(|f| *f == 0.0) && (from_below.largest() - half).abs() < 1e-5);
    let only = |terms| {
        let lobe = Lobe::new(&*paper, room(&frame, 40.0, 10.0), &frame, terms, &Progress::NONE);
        lobe.expect("not cancelled")
    };
    let through = only(TermSelection::Transmitted);
    assert!(through.values.iter().zip(&through.ways).all(|(f, way)| *f == 0.0 || way.dot(frame.n) < 0.0));
    assert!(below(&only(TermSelection::Diffuse)).iter().all(|f| *f == 0.0));
    let lambert = lobe(&*surface("lambert", &[]), room(&frame, 40.0, 10.0), &frame);
    assert!(lambert.ways.iter().all(|way| way.dot(frame.n) > 0.0));
}
