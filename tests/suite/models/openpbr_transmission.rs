//! OpenPBR's transmission: sheets, bodies, and none.

use std::{f32::consts::PI, sync::atomic::AtomicBool};

use glam::Vec3;
use lights_camera_models::{
    explain,
    optics::{
        Frame, Terms, absorption, colour::Encoding, fresnel::dielectric, geometry::direction, slab::slab,
    },
    parameter::{Value, Values},
    reference::{self, LightSamples, Settings},
    reflection::{ModelEntry, Passage, Surface},
    registry::Registry,
    render::capture::gpu::{GpuRenderer, Output},
    scene::{Light, Object, Observer, Scene},
    testing::{direction as random_direction, random_values},
};
use std::sync::Arc;

use crate::helpers::{pictures::on_gpu, support::builtin};

const LOCAL: Frame = Frame::LOCAL;

/// A set of parameters.
type Material = Vec<(&'static str, Value)>;

fn number(name: &'static str, value: f32) -> (&'static str, Value) {
    (name, Value::Number(value))
}

fn thin(mut more: Material) -> Material {
    more.insert(0, ("geometry_thin_walled", Value::flag(true)));
    solid(more)
}

fn solid(mut more: Material) -> Material {
    more.insert(0, number("transmission_weight", 1.0));
    more
}

fn values(material: &[(&'static str, Value)]) -> Values {
    let mut values = Values::default();
    material.iter().for_each(|(name, value)| values.set(*name, value.clone()));
    values
}

fn model(registry: &Registry) -> &ModelEntry {
    registry.model("openpbr").expect("built in")
}

fn surface_of(values: &Values) -> Arc<dyn Surface> {
    model(&builtin()).instantiate(values, Encoding::Srgb)
}

fn surface(material: &[(&'static str, Value)]) -> Arc<dyn Surface> {
    surface_of(&values(material))
}

#[test]
fn without_weight_the_others_change_nothing() {
    let registry = Registry::builtin();
    let model = model(&registry);
    let mut seed = 5;
    for thin in [false, true] {
        for _ in 0..20 {
            let mut without = random_values(model, &mut seed);
            without.set("transmission_weight", Value::Number(0.0));
            let with = without.clone();
            for name in ["colour", "depth", "dispersion_scale", "dispersion_abbe_number"] {
                without.0.remove(format!("transmission_{name}").as_str());
            }
            without.set("geometry_thin_walled", Value::flag(false));
            let mut with = with;
            with.set("geometry_thin_walled", Value::flag(thin));
            assert_eq!(model.passage(&with), Passage::NONE);
            let [a, b] = [&with, &without].map(surface_of);
            assert_eq!(a.lobes(), b.lobes());
            assert!(!a.transmits() && a.interior().is_none());
            for _ in 0..100 {
                let (l, v) = (random_direction(&mut seed), random_direction(&mut seed));
                let bits = |s: &Arc<dyn Surface>, l| {
                    s.response(l, v, &LOCAL).each().map(|t| t.to_array().map(f32::to_bits))
                };
                assert_eq!(bits(&a, l), bits(&b, l), "{with:?}");
                assert_eq!(a.response(-l, v, &LOCAL), Terms::default());
            }
        }
    }
}

#[test]
fn the_body_gives_way_to_the_light_that_passes() {
    let l = direction(30.0, 10.0);
    let v = direction(50.0, 150.0);
    let of = |weight: f32, thin: bool| {
        let material = [number("transmission_weight", weight), ("geometry_thin_walled", Value::flag(thin))];
        surface(&material).response(l, v, &LOCAL)
    };
    let opaque = of(0.0, false);
    for thin in [false, true] {
        for weight in [0.25, 0.5, 1.0] {
            let found = of(weight, thin);
            let expected = (1.0 - weight) * opaque.diffuse;
            assert!((found.diffuse - expected).length() < 1e-6, "{weight} {thin}: {found:?}");
            // A body reflects with its first face, a sheet with both.
            let more = found.specular.x / opaque.specular.x;
            assert!(if thin { more > 1.0 + 0.5 * weight } else { more == 1.0 }, "{weight} {thin}: {more}");
            assert!(found.specular.x > 0.0 && found.transmitted == Vec3::ZERO);
        }
    }
}

#[test]
fn a_smooth_sheet_is_thin_glass() {
    let tint = Value::Colour([120, 200, 255]);
    for index in [1.33, 1.5, 2.0] {
        let sheet = surface(&thin(vec![
            number("roughness", 0.0),
            number("specular_ior", index),
            ("transmission_colour", tint.clone()),
        ]));
        let registry = Registry::builtin();
        let pane = registry.model("thin_glass").expect("built in");
        let mut glass = Values::default();
        glass.set("refractive_index", Value::Number(index));
        glass.set("transmittance_colour", tint.clone());
        let pane = pane.instantiate(&glass, Encoding::Srgb);
        for theta in [0.0, 40.0, 70.0, 85.0] {
            let v = direction(theta, 20.0);
            let ours = sheet.sharp(v, &LOCAL);
            let [_, theirs] = pane.sharp(v, &LOCAL)[..] else { panic!("reflected and transmitted") };
            assert_eq!(ours.len(), 1);
            assert!(ours[0].transmitted && ours[0].l == -v);
            assert!((ours[0].share - theirs.share).abs().max_element() < 1e-5, "{index} {theta}");
        }
        // Nothing is spread, and nothing seen from behind.
        assert_eq!(sheet.response(-direction(30.0, 0.0), direction(30.0, 0.0), &LOCAL), Terms::default());
        assert!(sheet.sharp(-Vec3::Z, &LOCAL).is_empty());
    }
    // The wrong twin: a single face.
    let r = dielectric(1.5, 1.0);
    let both = slab(Vec3::splat(r), Vec3::ONE).transmittance.x;
    assert!((both - (1.0 - r)).abs() > 0.03);
}

#[test]
fn clear_sheets_lose_no_light() {
    for (roughness, tolerance) in [(0.0, 0.01), (0.2, 0.01), (0.3, 5e-3), (0.6, 5e-3), (1.0, 5e-3)] {
        for coat in [0.0, 1.0] {
            let sheet = surface(&thin(vec![number("roughness", roughness), number("coat_weight", coat)]));
            for theta in [0.0, 45.0, 70.0] {
                let found = sheet.ambient_response(direction(theta, 20.0), &LOCAL);
                // The coat blurs nothing where it is smooth.
                let tolerance = if coat > 0.0 { 0.02 } else { tolerance };
                assert!(
                    (found - 1.0).abs().max_element() < tolerance,
                    "{roughness} {coat} {theta}°: {found}"
                );
            }
            let tinted = surface(&thin(vec![
                number("roughness", roughness),
                ("transmission_colour", Value::Colour([255, 128, 0])),
            ]));
            let found = tinted.ambient_response(direction(45.0, 20.0), &LOCAL);
            assert!((found.x - 1.0).abs() < 0.01 && found.y < 0.4 && found.z < 0.2, "{roughness}: {found}");
        }
    }
}

#[test]
fn no_sheet_makes_light() {
    let registry = Registry::builtin();
    let model = model(&registry);
    let mut seed = 77;
    for _ in 0..30 {
        let mut values = random_values(model, &mut seed);
        values.set("geometry_thin_walled", Value::flag(true));
        // What makes light without transmission too.
        for name in
            ["thin_film_weight", "specular_roughness_anisotropy", "base_diffuse_roughness", "fuzz_weight"]
        {
            values.set(name, Value::Number(0.0));
        }
        values.set("coat_roughness_anisotropy", Value::Number(0.0));
        let sheet = surface_of(&values);
        for theta in [5.0, 40.0, 65.0, 80.0] {
            let found = sheet.ambient_response(direction(theta, 70.0), &LOCAL);
            assert!(found.max_element() < 1.02 && found.min_element() >= 0.0, "{theta}° {values:?}: {found}");
        }
    }
}

#[test]
fn a_rough_sheet_transmits_the_mirrored_lobe() {
    let sheet = surface(&thin(vec![number("roughness", 0.5)]));
    let v = direction(30.0, 0.0);
    let at = |l: Vec3| sheet.response(l, v, &LOCAL);
    for (theta, phi) in [(30.0, 180.0), (10.0, 60.0), (70.0, 200.0)] {
        let l = direction(theta, phi);
        let (front, behind) = (at(l), at(l.with_z(-l.z)));
        assert!(behind.transmitted.x > 3.0 * front.specular.x && behind.specular == Vec3::ZERO, "{theta}");
    }
    assert!(at(-v).transmitted.x > at(direction(120.0, 0.0)).transmitted.x);
    // An anisotropic lobe is longer along the tangent.
    let brushed =
        surface(&thin(vec![number("roughness", 0.5), number("specular_roughness_anisotropy", 0.8)]));
    let [along, across] =
        [0.0, 90.0].map(|phi| brushed.response(-direction(35.0, phi), Vec3::Z, &LOCAL).transmitted.x);
    assert!(along > 3.0 * across, "{along} {across}");
}

#[test]
fn layers_above_take_their_share_once() {
    let (l, v) = (-direction(35.0, 200.0), direction(35.0, 20.0));
    let with = |more: Material| {
        let mut material = vec![number("roughness", 0.4)];
        material.extend(more);
        surface(&thin(material)).response(l, v, &LOCAL).transmitted
    };
    let bare = with(vec![]);
    // Black coats let nothing through, and black fuzz less.
    let coat = |colour| vec![number("coat_weight", 1.0), ("coat_colour", Value::Colour(colour))];
    assert!(with(coat([0, 0, 0])).max_element() < 1e-4);
    let [clear, green] = [[255; 3], [0, 255, 0]].map(|colour| with(coat(colour)));
    assert!((green.y - clear.y).abs() < 1e-5 && green.x < 0.01 * clear.x, "{green} {clear}");
    // A square root of the colour: the light passes the coat once.
    let grey = with(coat([188; 3])).x / clear.x;
    let colour = Encoding::Srgb.decode([188; 3]).x;
    let inside = (1.0 - (35.0f32.to_radians().sin() / 1.6).powi(2)).sqrt();
    assert!((grey - colour.powf(0.5 / inside)).abs() < 1e-3, "{grey}");
    let fuzzy = with(vec![number("fuzz_weight", 1.0), ("fuzz_colour", Value::Colour([0; 3]))]);
    assert!(fuzzy.x < 0.97 * bare.x && fuzzy.x > 0.2 * bare.x, "{fuzzy} {bare}");
    let metal = with(vec![number("metallic", 0.75)]);
    assert!((metal.x - 0.25 * bare.x).abs() < 1e-5, "{metal} {bare}");
}

/// Below an index of 0.745 the mean angle of light from all sides is one of total reflection.
#[test]
fn a_rough_body_lets_light_in_whatever_its_index() {
    for ior in [0.5, 0.7, 0.74, 0.75, 1.0, 1.5, 2.5] {
        let surface = surface(&solid(vec![number("roughness", 0.3), number("specular_ior", ior)]));
        let enters = surface.entering(direction(40.0, 0.0), &LOCAL);
        assert!((enters - 1.0).abs().max_element() < 1e-3, "{ior}: {enters}");
    }
}

#[test]
fn the_inside_has_the_constants_of_the_parameters() {
    let colour = [128, 230, 255];
    let inside = |more: Material| {
        let mut material = vec![number("roughness", 0.0), ("transmission_colour", Value::Colour(colour))];
        material.extend(more);
        let surface = surface(&solid(material));
        (surface.interior().expect("solid"), surface.entering(direction(40.0, 0.0), &LOCAL))
    };
    let linear = Encoding::Srgb.decode(colour);
    let (deep, enters) = inside(vec![
        number("transmission_depth", 0.5),
        number("transmission_dispersion_scale", 0.5),
        number("transmission_dispersion_abbe_number", 30.0),
        number("specular_ior", 1.62),
    ]);
    assert!((deep.absorption - absorption::coefficient(linear, 0.5)).length() < 1e-6);
    assert!((deep.left(0.5) - linear).abs().max_element() < 1e-5);
    let abbe = lights_camera_models::optics::dispersion::abbe_of_cauchy(deep.ior, deep.cauchy_b);
    assert!((abbe - 60.0).abs() < 1e-2 && (deep.ior - 1.62).abs() < 1e-5 && deep.alpha == 0.0, "{deep:?}");
    assert!((enters - 1.0).abs().max_element() < 1e-6, "{enters}");
    // At depth 0 both boundaries tint.
    let (tinting, enters) = inside(vec![]);
    assert_eq!((tinting.absorption, tinting.cauchy_b), (Vec3::ZERO, 0.0));
    assert!((enters - linear * linear).abs().max_element() < 1e-6, "{enters}");
    // The strength of the reflection is that of the boundary, and so of its index.
    let (none, _) = inside(vec![number("specular_strength", 0.0)]);
    assert!((none.ior - 1.0).abs() < 1e-6);
    let (rough, _) = inside(vec![number("roughness", 0.6)]);
    assert!((rough.alpha - 0.36).abs() < 1e-6);
    // A coat reflects part of what else would enter, and the base under it less.
    let (_, coated) =
        inside(vec![number("coat_weight", 1.0), ("transmission_colour", Value::Colour([255; 3]))]);
    let first = dielectric(1.5, direction(40.0, 0.0).z);
    assert!((0.9..1.0).contains(&(coated.x * (1.0 - first))), "{coated}");
}

/// An object of OpenPBR in uniform light of 0.25 π, which is seen around it.
fn furnace(object_type: &str, material: &Material) -> Scene {
    let mut light =
        Light { light_type: "environment".to_owned(), intensity: 0.25, colour: [255; 3], ..Light::default() };
    light.parameters.set("source", Value::Choice("uniform".into()));
    let mut object = Object {
        object_type: object_type.to_owned(),
        position: Vec3::splat(5.0),
        rotation: Vec3::new(20.0, 30.0, 0.0),
        size: 2.0,
        ..Object::default()
    };
    material.iter().for_each(|(name, value)| object.material.set(*name, value.clone()));
    Scene {
        reflection_model: "openpbr".to_owned(),
        shading_model: "phong".to_owned(),
        lights: vec![light],
        objects: vec![object],
        observer: Observer { field_of_view: 30.0, ..Observer::at(Vec3::new(5.0, 5.0, 10.0), Vec3::NEG_Z) },
        ..Scene::default()
    }
}

const SIZE: u32 = 40;

/// The largest and the mean deviation of a picture from the surroundings, relative.
fn visible(scene: &Scene, samples: u32) -> [f32; 2] {
    let settings = Settings { width: SIZE, height: SIZE, samples: 1, ..Settings::default() };
    let (registry, samples) = (builtin(), LightSamples::of(samples));
    let picture = reference::render_samples(scene, &registry, &settings, samples, &AtomicBool::default());
    let around = picture.pixel(0, 0).x;
    assert!((around - 0.25 * PI).abs() < 1e-5, "{around}");
    let off: Vec<_> =
        picture.pixels.iter().map(|p| (p.truncate() / around - 1.0).abs().max_element()).collect();
    [off.iter().copied().fold(0.0, f32::max), off.iter().sum::<f32>() / off.len() as f32]
}

#[test]
fn clear_glass_is_invisible_in_uniform_light() {
    let smooth = || vec![number("roughness", 0.0)];
    let coated = || vec![number("roughness", 0.0), number("coat_weight", 1.0)];
    for object_type in ["sphere", "cube"] {
        let all = [thin(smooth()), thin(coated()), solid(smooth()), solid(coated())];
        // Rays that the faces of a cube never let out are counted, not followed.
        for material in all.into_iter().take(if object_type == "cube" { 2 } else { 4 }) {
            let [most, mean] = visible(&furnace(object_type, &material), 256);
            assert!(most < 0.06 && mean < 3e-3, "{object_type} {material:?}: {most} {mean}");
        }
    }
    let rough = solid(vec![number("roughness", 0.5)]);
    let [_, mean] = visible(&furnace("sphere", &rough), 64);
    // Light that facets reflect several times is lost at each boundary.
    assert!(mean < 0.15, "{mean}");
    // Facets between equal indices turn no light, at the rim neither.
    let matched = solid(vec![number("roughness", 0.3), number("specular_ior", 1.0)]);
    let [most, _] = visible(&furnace("sphere", &matched), 16);
    assert!(most < 1e-3, "{most}");
    // Wrong twins are seen: an opaque one, half of one, and a tint at depth 0.
    let half = vec![number("transmission_weight", 0.5), number("base_weight", 0.0), number("roughness", 0.0)];
    let mut tint = smooth();
    tint.push(("transmission_colour", Value::Colour([200, 255, 200])));
    for material in [vec![number("base_weight", 0.0)], half, solid(tint)] {
        let [_, mean] = visible(&furnace("sphere", &material), 16);
        assert!(mean > 0.02, "{material:?}: {mean}");
    }
}

#[test]
fn explanations_have_the_equation_along_the_path_of_bodies_only() {
    let settings = Settings { width: SIZE, height: SIZE, samples: 1, ..Settings::default() };
    let text = |material: &Material| {
        let scene = furnace("sphere", material);
        let found = explain::pixel(&scene, &Registry::builtin(), &settings, [SIZE / 2; 2]);
        found.expect("in the picture").to_text()
    };
    let path = "I_t = π ∑_k w_k L(d_k)";
    let smooth = || vec![number("roughness", 0.0)];
    let body = text(&solid(smooth()));
    // In the equation, and with its value.
    assert_eq!(body.matches(path).count(), 2, "{body}");
    for named in ["w_k = w_e a_1", "w_e = (1 − m) w_τ", "ρ_k: ", "a_k = ", "d_k: "] {
        assert!(body.contains(named), "{named}:\n{body}");
    }
    assert!(!body.contains("I_t = ∫"), "{body}");
    for other in [thin(smooth()), smooth()] {
        let text = text(&other);
        assert!(!text.contains(path) && !text.contains("w_e"), "{text}");
    }
}

#[test]
fn both_renderers_draw_the_light_that_passes() {
    let mut renderer = GpuRenderer::new(SIZE, SIZE, 1, Output::Linear).expect("software Vulkan is installed");
    let tint = ("transmission_colour", Value::Colour([140, 220, 255]));
    let depth = number("transmission_depth", 2.0);
    let film = [number("thin_film_weight", 1.0), number("thin_film_thickness", 0.4)];
    let cases = [
        solid(vec![number("roughness", 0.0), tint.clone(), depth.clone()]),
        solid(vec![
            number("roughness", 0.0),
            tint.clone(),
            number("coat_weight", 0.7),
            number("fuzz_weight", 0.5),
        ]),
        solid([vec![number("roughness", 0.0)], film.to_vec()].concat()),
        solid(vec![number("roughness", 0.4), depth, number("transmission_dispersion_scale", 1.0)]),
        thin(vec![number("roughness", 0.0), tint.clone(), number("coat_weight", 1.0)]),
        thin([vec![number("roughness", 0.5), tint, number("metallic", 0.3)], film.to_vec()].concat()),
        vec![number("transmission_weight", 0.5), number("fuzz_weight", 1.0)],
    ];
    let mut all = Vec::new();
    for material in cases {
        let mut scene = furnace("sphere", &material);
        // Half of the surroundings are bright.
        scene.lights[0].parameters.set("source", Value::Choice("sky".into()));
        scene.lights[0].intensity = 1.0;
        let settings = Settings { width: SIZE, height: SIZE, samples: 1, ..Settings::default() };
        let cpu = reference::render(&scene, &builtin(), &settings);
        let gpu = on_gpu(&mut renderer, &scene);
        let scale = cpu.pixels.iter().map(|p| p.truncate().max_element()).fold(0.0, f32::max);
        let off = |(g, c): (&Vec3, &glam::Vec4)| (*g - c.truncate()).abs().max_element() / scale;
        let covered = gpu.iter().zip(&cpu.pixels).filter(|(_, c)| c.w > 0.0);
        let wrong = covered.clone().filter(|pair| off(*pair) > 0.01).count();
        let count = covered.count();
        assert!(count > 500 && wrong * 50 <= count, "{material:?}: {wrong} of {count}");
        assert!(!all.contains(&gpu), "{material:?}: as another one");
        all.push(gpu);
    }
    // The wrong twin: another index.
    let [a, b] = [1.5, 1.45].map(|index| {
        let material = solid(vec![number("roughness", 0.0), number("specular_ior", index)]);
        let mut scene = furnace("sphere", &material);
        scene.lights[0].parameters.set("source", Value::Choice("sky".into()));
        scene.lights[0].intensity = 1.0;
        on_gpu(&mut renderer, &scene)
    });
    assert!(a.iter().zip(&b).filter(|(a, b)| (**a - **b).abs().max_element() > 0.01).count() > 20);
}
