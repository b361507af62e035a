//! The CPU renderer, seen from outside: pictures of small scenes against theory.

use std::collections::HashSet;

use glam::{Vec3, Vec4};
use lights_camera_models::{
    optics::{
        TermSelection,
        colour::{Encoding, luminance, srgb_encode},
        temperature,
    },
    parameter::{Value, Values},
    reference::{self, Picture, Settings},
    reflection::ModelEntry,
    registry::Registry,
    scene::{Light, Object, Observer, Scene},
};

use crate::helpers::{pictures::close_up, support::builtin};

const SMALL: Settings = Settings { width: 160, height: 120, samples: 1, terms: TermSelection::All };

fn render(scene: &Scene, settings: &Settings) -> Picture {
    reference::render(scene, &builtin(), settings)
}

/// The default scene with other models.
fn scene(model: &str, shading: &str) -> Scene {
    Scene { reflection_model: model.to_owned(), shading_model: shading.to_owned(), ..Scene::default() }
}

/// The default observer in front of a large cube, whose front face is the plane z = `z`.
fn wall(model: &str, shading: &str, z: f32) -> Scene {
    let mut scene = scene(model, shading);
    scene.objects[0] = Object {
        object_type: "cube".to_owned(),
        size: 4.0,
        position: Vec3::new(5.0, 5.0, z - 2.0),
        tessellation: Some(64),
        ..Object::default()
    };
    scene
}

/// The point on the plane z = `z` at the centre of a pixel.
fn place(scene: &Scene, settings: &Settings, x: u32, y: u32, z: f32) -> Vec3 {
    let eye = scene.observer.position;
    let half = (0.5 * scene.observer.field_of_view).to_radians().tan();
    let up = half * (1.0 - 2.0 * (y as f32 + 0.5) / settings.height as f32);
    let aspect = settings.width as f32 / settings.height as f32;
    let right = half * aspect * (2.0 * (x as f32 + 0.5) / settings.width as f32 - 1.0);
    eye + (eye.z - z) * Vec3::new(right, up, -1.0)
}

fn covered(picture: &Picture) -> impl Iterator<Item = &Vec4> {
    picture.pixels.iter().filter(|p| p.w == 1.0)
}

#[test]
fn flat_shading_gives_one_colour_per_polygon() {
    let mut scene = scene("lambert", "flat");
    // An octahedron from its side: four of its triangles are visible, two of them lit.
    scene.objects[0].tessellation = Some(2);
    scene.objects[0].rotation = Vec3::new(0.0, 30.0, 0.0);
    let colours = |shading: &str| {
        let scene = Scene { shading_model: shading.to_owned(), ..scene.clone() };
        let picture = render(&scene, &SMALL);
        covered(&picture).map(|p| p.to_array().map(f32::to_bits)).collect::<HashSet<_>>().len()
    };
    let flat = colours("flat");
    assert!((2..=4).contains(&flat), "{flat}");
    // The wrong twin: the same facets, lit per pixel.
    assert!(colours("derivative") > 100);
}

#[test]
fn gouraud_shading_misses_a_highlight_between_vertices_and_phong_shading_finds_it() {
    let mut scene = wall("blinn_phong", "phong", 5.0);
    scene.objects[0].tessellation = Some(2);
    // Light and eye opposite the middle of one of the four squares: the highlight is there.
    let middle = Vec3::new(6.0, 6.0, 5.0);
    scene.observer.position = middle + Vec3::Z * 4.0;
    scene.lights[0].position = Some(middle + Vec3::Z * 4.0);
    scene.objects[0].material.set("alpha", Value::Integer(64));
    let settings = Settings { terms: TermSelection::Specular, ..SMALL };
    let brightest = |shading: &str| {
        let scene = Scene { shading_model: shading.to_owned(), ..scene.clone() };
        render(&scene, &settings).pixels.iter().map(|p| p.x).fold(0.0, f32::max)
    };
    let (gouraud, phong) = (brightest("gouraud"), brightest("phong"));
    // k_s · I / d² = 0.5 · 20 / 16. Normals at the cube's edges lean outward, so a little less.
    assert!(phong > 0.3 && phong <= 0.6251, "{phong}");
    assert!(gouraud < 0.2 * phong, "{gouraud} {phong}");
}

#[test]
fn interpolation_is_perspective_correct() {
    // One face of a cube, two triangles, seen at a slant: positions are interpolated along it.
    let mut scene = scene("lambert", "derivative");
    let turn = 60f32.to_radians();
    scene.objects[0] = Object {
        object_type: "cube".to_owned(),
        size: 4.0,
        rotation: Vec3::Y * 60.0,
        tessellation: Some(1),
        ..Object::default()
    };
    scene.observer =
        Observer { position: Vec3::new(2.5, 5.0, 9.0), direction: Vec3::NEG_Z, field_of_view: 90.0 };
    let light = Vec3::new(1.0, 5.0, 7.0);
    scene.lights[0].position = Some(light);
    let settings = Settings { width: 400, height: 401, ..SMALL };
    let picture = render(&scene, &settings);

    // The former −x face: its normal, the direction along it, its centre.
    let normal = Vec3::new(-turn.cos(), 0.0, turn.sin());
    let along = Vec3::new(turn.sin(), 0.0, turn.cos());
    let middle = scene.objects[0].position + 2.0 * normal;
    let eye = scene.observer.position;
    let lit = |p: Vec3| {
        let to_light = light - p;
        20.0 / to_light.length_squared() * to_light.normalize().dot(normal).max(0.0)
    };
    // The ends of the face on the screen, as slopes of rays.
    let slope = |p: Vec3| (p.x - eye.x) / (eye.z - p.z);
    let ends = [middle - 2.0 * along, middle + 2.0 * along];
    let (mut worst, mut worst_affine, mut count) = (0.0f32, 0.0f32, 0);
    // The row in the middle of the picture looks along the eye's own height.
    for x in 0..settings.width {
        let ray = place(&scene, &settings, x, 200, 5.0) - eye;
        let p = eye + (middle - eye).dot(normal) / ray.dot(normal) * ray;
        if ray.dot(normal) >= 0.0 || (p - middle).dot(along).abs() > 1.95 {
            continue;
        }
        let got = picture.pixel(x, 200).x;
        worst = worst.max((got / lit(p) - 1.0).abs());
        // The wrong twin: halfway on the screen is halfway on the face.
        let t = (slope(p) - slope(ends[0])) / (slope(ends[1]) - slope(ends[0]));
        worst_affine = worst_affine.max((got / lit(ends[0].lerp(ends[1], t)) - 1.0).abs());
        count += 1;
    }
    assert!(count > 50, "{count}");
    assert!(worst < 0.01, "{worst}");
    assert!(worst_affine > 0.1, "{worst_affine}");
}

#[test]
fn nearer_objects_hide_farther_ones_in_whatever_order_they_are_listed() {
    let mut scene = scene("lambert", "phong");
    let ball = |x: f32, z: f32, colour: [u8; 3]| {
        let mut material = Values::default();
        material.set("base_colour", Value::Colour(colour));
        Object { position: Vec3::new(x, 5.0, z), material, ..Object::default() }
    };
    scene.objects =
        vec![ball(4.7, 5.0, [255, 0, 0]), ball(5.3, 4.0, [0, 255, 0]), ball(5.0, 3.0, [0, 0, 255])];
    let settings = Settings { samples: 4, ..SMALL };
    let forward = render(&scene, &settings);
    scene.objects.reverse();
    assert_eq!(forward, render(&scene, &settings));
    // The middle shows the red ball, which is nearest there.
    let middle = forward.pixel(80, 60);
    assert!(middle.x > 0.0 && middle.y == 0.0 && middle.z == 0.0, "{middle}");
    // The wrong twin: other depths, another picture.
    scene.objects[0].position.z = 6.5;
    assert_ne!(forward, render(&scene, &settings));
}

#[test]
fn four_samples_are_the_mean_and_one_sample_is_the_centre() {
    let scene = scene("lambert", "gouraud");
    let one = render(&scene, &SMALL);
    let four = render(&scene, &Settings { samples: 4, ..SMALL });
    let mut partly = 0;
    for (a, b) in one.pixels.iter().zip(&four.pixels) {
        assert!(a.w == 0.0 || a.w == 1.0);
        assert!([0.0, 0.25, 0.5, 0.75, 1.0].contains(&b.w));
        partly += usize::from(b.w > 0.0 && b.w < 1.0);
        if b.w == 0.0 {
            assert_eq!(*b, Vec4::ZERO);
        }
    }
    assert!(partly > 50, "{partly}");
    // If one triangle covers the pixel, both have its colour; elsewhere they are close.
    let same = one.pixels.iter().zip(&four.pixels).filter(|(a, b)| (**a - **b).abs().max_element() < 0.05);
    assert!(same.count() + 2 * partly > one.pixels.len());
    // Twice as fine and averaged: the covered area agrees.
    let fine = render(&scene, &Settings { width: 640, height: 480, ..SMALL });
    let area = |p: &Picture| p.pixels.iter().map(|p| p.w).sum::<f32>() / p.pixels.len() as f32;
    assert!((area(&four) - area(&fine)).abs() < 2e-4, "{} {}", area(&four), area(&fine));
}

#[test]
fn what_is_behind_the_eye_is_cut_away() {
    // The eye above the middle of a large ring that lies flat: in front of, beside and behind it.
    let mut scene = scene("lambert", "phong");
    scene.objects[0] =
        Object { object_type: "torus".to_owned(), size: 9.0, rotation: Vec3::X * 90.0, ..Object::default() };
    scene.observer.position = Vec3::new(5.0, 6.5, 5.0);
    let inside = render(&scene, &SMALL);
    let seen = covered(&inside).count();
    assert!(seen > 1000 && seen < inside.pixels.len(), "{seen}");
    // A triangle entirely behind the eye gives no pixel at all.
    scene.objects[0].size = 2.0;
    scene.objects[0].position = Vec3::new(5.0, 5.0, 9.0);
    assert_eq!(covered(&render(&scene, &SMALL)).count(), 0);
    // A wall that reaches from in front of the eye to behind it fills the lower half up to the horizon.
    let mut floor = wall("lambert", "phong", 5.0);
    floor.objects[0] = Object {
        object_type: "cube".to_owned(),
        size: 100.0,
        position: Vec3::new(5.0, -46.0, 5.0),
        tessellation: Some(1),
        ..Object::default()
    };
    let picture = render(&floor, &SMALL);
    for y in 0..SMALL.height {
        for x in 0..SMALL.width {
            let below = place(&floor, &SMALL, x, y, 9.4).y < 5.0;
            let far_edge = y as f32 > 0.5 * SMALL.height as f32 + 3.0;
            if !below {
                assert_eq!(picture.pixel(x, y).w, 0.0, "{x} {y}");
            } else if far_edge {
                assert_eq!(picture.pixel(x, y).w, 1.0, "{x} {y}");
            }
        }
    }
}

#[test]
fn a_point_light_falls_off_with_the_square_of_the_distance() {
    for z in [5.0, 3.0] {
        let mut scene = wall("lambert", "derivative", z);
        let light = Vec3::new(5.0, 5.0, z + 2.0);
        scene.lights[0].position = Some(light);
        let picture = render(&scene, &SMALL);
        for (x, y) in [(80, 60), (60, 60), (100, 80), (80, 40)] {
            let p = place(&scene, &SMALL, x, y, z);
            let to_light = light - p;
            let expected = 20.0 / to_light.length_squared() * to_light.normalize().z;
            let got = picture.pixel(x, y).x;
            assert!((got / expected - 1.0).abs() < 2e-3, "{got} {expected}");
            // The wrong twin, 1/d.
            assert!((got / (20.0 / to_light.length() * to_light.normalize().z) - 1.0).abs() > 0.1);
        }
    }
}

#[test]
fn a_spotlight_ends_at_its_cone() {
    let mut scene = wall("lambert", "derivative", 5.0);
    let light = Vec3::new(5.0, 5.0, 7.0);
    let mut parameters = Values::default();
    parameters.set("cone_angle", Value::Number(20.0));
    parameters.set("penumbra", Value::Number(0.0));
    scene.lights[0] = Light {
        light_type: "spot".to_owned(),
        position: Some(light),
        direction: Some(Vec3::NEG_Z * 3.0),
        parameters,
        ..Light::default()
    };
    let picture = render(&scene, &SMALL);
    let (mut lit, mut dark) = (0, 0);
    for y in 0..SMALL.height {
        for x in 0..SMALL.width {
            let pixel = picture.pixel(x, y);
            let p = place(&scene, &SMALL, x, y, 5.0);
            let angle = (p - light).angle_between(Vec3::NEG_Z).to_degrees();
            if pixel.w == 0.0 || (angle - 20.0).abs() < 0.2 {
                continue;
            }
            assert_eq!(pixel.x > 0.0, angle < 20.0, "{angle}");
            *if angle < 20.0 { &mut lit } else { &mut dark } += 1;
        }
    }
    assert!(lit > 500 && dark > 500, "{lit} {dark}");
}

#[test]
fn ambient_light_is_the_same_everywhere() {
    for shading in Registry::builtin().shading_models() {
        let mut scene = scene("lambert", shading.declaration.id);
        scene.objects[0].material.set("base_colour", Value::Colour([188, 128, 0]));
        scene.lights[0] =
            Light { light_type: "ambient".to_owned(), position: None, intensity: 0.5, ..Light::default() };
        let base = Encoding::Srgb.decode([188, 128, 0]);
        let picture = render(&scene, &SMALL);
        assert!(covered(&picture).count() > 1000);
        for pixel in covered(&picture) {
            assert!((pixel.truncate() - 0.5 * base).abs().max_element() < 1e-6, "{pixel}");
        }
    }
}

/// The bytes of the first fully covered pixel.
fn shown(scene: &Scene) -> [u8; 3] {
    let picture = render(scene, &SMALL);
    let i = picture.pixels.iter().position(|p| p.w == 1.0).expect("something is there");
    picture.to_rgb8(&scene.display)[3 * i..][..3].try_into().expect("three bytes")
}

#[test]
fn gamma_naive_display_neither_encodes_the_picture_nor_decodes_colours() {
    let mut scene = scene("lambert", "flat");
    scene.objects[0].material.set("base_colour", Value::Colour([128, 64, 200]));
    scene.lights[0] =
        Light { light_type: "ambient".to_owned(), position: None, colour: [128; 3], ..Light::default() };
    scene.lights[0].intensity = 1.0;
    // By hand: 255 (128 / 255) (c / 255).
    scene.display.encoding = Encoding::Off;
    assert_eq!(shown(&scene), [64, 32, 100]);
    // By hand with IEC 61966-2-1: encoded(decoded(128) decoded(c)).
    scene.display.encoding = Encoding::Srgb;
    assert_eq!(shown(&scene), [61, 27, 99]);
}

#[test]
fn lumen_and_candela_are_the_same_light() {
    for (kind, solid_angle) in [("point", 12.566_371), ("spot", 0.763_307)] {
        let mut candela = wall("lambert", "phong", 5.0);
        candela.lights[0] = Light {
            light_type: kind.to_owned(),
            position: Some(Vec3::new(5.0, 5.0, 8.0)),
            direction: (kind == "spot").then_some(Vec3::NEG_Z),
            ..Light::default()
        };
        let mut lumen = candela.clone();
        lumen.lights[0].luminous_flux = Some(20.0 * solid_angle);
        // NaN counts as nothing.
        lumen.lights[0].intensity = 7.0;
        let differs = |a: &Picture, b: &Picture| {
            let pairs = a.pixels.iter().zip(&b.pixels).filter(|(a, _)| a.x > 0.0);
            pairs.map(|(a, b)| (a.x / b.x - 1.0).abs()).fold(0.0, f32::max)
        };
        let (candela, same) = (render(&candela, &SMALL), render(&lumen, &SMALL));
        assert!(differs(&candela, &same) < 1e-5, "{kind}: {}", differs(&candela, &same));
        // A wrong twin: 4π for every light, or none.
        lumen.lights[0].luminous_flux = Some(20.0 * if kind == "spot" { 12.566_371 } else { 1.0 });
        assert!(differs(&candela, &render(&lumen, &SMALL)) > 0.5, "{kind}");
    }
}

#[test]
fn lights_have_the_colour_of_their_temperature() {
    let mut scene = scene("lambert", "flat");
    scene.lights[0] =
        Light { light_type: "ambient".to_owned(), position: None, intensity: 1.0, ..Light::default() };
    for encoding in Encoding::ALL {
        scene.display.encoding = encoding;
        for kelvin in [1900.0, 2700.0, 6500.0, 12_000.0] {
            scene.lights[0].colour_temperature = Some(kelvin);
            // The reported sRGB colour is that of a white object, decoded or not, whose largest channel is 1.
            scene.lights[0].intensity = scene.lights[0].colour_under(encoding).max_element().recip();
            assert_eq!(shown(&scene), scene.lights[0].rgb8(), "{kelvin} K {encoding:?}");
        }
    }
    scene.lights[0].intensity = luminance(temperature::black_body(1900.0).map(srgb_encode));
    let [r, g, b] = shown(&Scene {
        lights: vec![Light { colour_temperature: Some(1900.0), ..scene.lights[0].clone() }],
        ..scene.clone()
    });
    assert!(r == 255 && g < 160 && b < 60, "a candle is orange: {r} {g} {b}");
}

/// Lumens are photometric: they state the brightness of a light, whatever its colour.
#[test]
fn equal_lumens_give_equal_luminance_at_every_temperature() {
    for encoding in Encoding::ALL {
        let mut scene = wall("lambert", "phong", 5.0);
        scene.display.encoding = encoding;
        scene.objects[0].material.set("base_colour", Value::Colour([255; 3]));
        scene.lights[0].luminous_flux = Some(800.0);
        let lit = |scene: &Scene, kelvin: Option<f32>| {
            let mut scene = scene.clone();
            scene.lights[0].colour_temperature = kelvin;
            let picture = render(&scene, &SMALL);
            luminance(picture.pixels[picture.pixels.len() / 2 + SMALL.width as usize / 2].truncate())
        };
        let white = lit(&scene, None);
        assert!(white > 0.1);
        for kelvin in [1000.0, 1900.0, 2700.0, 4000.0, 6500.0, 12_000.0, 40_000.0] {
            let ratio = lit(&scene, Some(kelvin)) / white;
            assert!((ratio - 1.0).abs() < 1e-5, "{kelvin} K {encoding:?}: {ratio}");
        }
        // A colour is a filter, and a wrong twin of a temperature.
        scene.lights[0].colour = temperature::black_body_rgb8(2700.0);
        assert!(lit(&scene, None) / white < 0.8);
    }
}

#[test]
fn the_terms_add_up_to_the_whole() {
    let registry = Registry::builtin();
    for model in registry.models() {
        let mut scene = scene(model.declaration.id, "phong");
        scene.lights.push(Light { light_type: "ambient".to_owned(), position: None, ..Light::default() });
        let [all, parts @ ..] = TermSelection::ALL.map(|terms| render(&scene, &Settings { terms, ..SMALL }));
        for (i, all) in all.pixels.iter().enumerate() {
            let sum: Vec3 = parts.iter().map(|p| p.pixels[i].truncate()).sum();
            assert!((sum - all.truncate()).abs().max_element() <= 1e-5 * (1.0 + all.max_element()));
        }
        assert!(parts[0].pixels.iter().any(|p| p.x > 0.0), "ambient light belongs to the ambient term");
    }
}

#[test]
fn the_picture_does_not_depend_on_the_number_of_threads() {
    let mut scene = scene("phong", "gouraud");
    scene.objects = ["sphere", "cube", "torus", "teapot"]
        .iter()
        .enumerate()
        .map(|(i, kind)| Object {
            object_type: (*kind).to_owned(),
            position: Vec3::new(3.5 + i as f32, 5.0, 5.0),
            rotation: Vec3::new(20.0, 30.0 * i as f32, 10.0),
            ..Object::default()
        })
        .collect();
    let settings = Settings { samples: 4, ..SMALL };
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| render(&scene, &settings))
    };
    assert_eq!(on(1), on(7));
}

#[test]
fn bytes_come_out_the_same_with_and_without_the_picture_in_between() {
    let mut scene = scene("blinn_phong", "phong");
    for encoding in Encoding::ALL {
        scene.display.encoding = encoding;
        scene.display.exposure = 0.7;
        let settings = Settings { samples: 4, width: 130, height: 70, ..SMALL };
        let bytes = reference::render_rgb8(&scene, &Registry::builtin(), &settings);
        assert_eq!(bytes, render(&scene, &settings).to_rgb8(&scene.display));
        assert_eq!(bytes[..3], reference::BACKGROUND);
    }
}

#[test]
fn no_pixel_is_nan_whatever_is_shown() {
    let registry = Registry::builtin();
    for model in registry.models() {
        for shading in registry.shading_models() {
            for shape in registry.shapes() {
                let mut scene = scene(model.declaration.id, shading.declaration.id);
                scene.objects[0].object_type = shape.declaration.id.to_owned();
                scene.objects[0].rotation = Vec3::new(30.0, 40.0, 50.0);
                // A light in the surface and an eye close to it.
                scene.lights.push(Light { position: Some(Vec3::new(5.0, 5.0, 6.0)), ..Light::default() });
                scene.observer.position = Vec3::new(5.0, 5.0, 6.02);
                let picture = render(&scene, &Settings { samples: 4, width: 64, height: 48, ..SMALL });
                assert!(picture.pixels.iter().all(|p| p.is_finite()));
            }
        }
    }
}

#[test]
fn things_of_unknown_kinds_are_left_out() {
    let mut scene = scene("lambert", "phong");
    scene.objects.push(Object { object_type: "dodecahedron".to_owned(), ..Object::default() });
    scene.lights.push(Light { light_type: "candle".to_owned(), ..Light::default() });
    assert_eq!(
        render(&scene, &SMALL),
        render(&Scene { shading_model: "phong".to_owned(), ..Scene::default() }, &SMALL)
    );
    scene.reflection_model = "plaid".to_owned();
    assert_eq!(covered(&render(&scene, &SMALL)).count(), 0);
}

/// At the rim an interpolated normal faces away from the viewer. A model that is zero for a viewer below the
/// surface must not be black where a matte surface is lit.
#[test]
fn rims_are_as_little_black_as_lambert_leaves_them() {
    let registry = Registry::builtin();
    for shape in ["sphere", "cube", "teapot"] {
        for shading in ["gouraud", "phong"] {
            let black = |model: &str| {
                let mut scene = close_up(shape, "directional");
                scene.reflection_model = model.to_owned();
                scene.shading_model = shading.to_owned();
                let picture = render(&scene, &SMALL);
                picture.pixels.iter().filter(|p| p.w > 0.0 && p.truncate().max_element() < 1e-6).count()
            };
            let lambert = black("lambert");
            // Smooth glass does not reflect a light without extent at all.
            let is_smooth = |model: &ModelEntry| {
                let passage = model.passage(&Values::default());
                passage.sharp || passage.solid
            };
            for model in registry.models().iter().filter(|model| !is_smooth(model)) {
                let id = model.declaration.id;
                let count = black(id);
                // The few where the halves of a lobe end differently; without the mirroring there are
                // hundreds.
                assert!(
                    count <= lambert + lambert / 20,
                    "{shape} × {shading} × {id}: {count} black pixels, Lambert {lambert}"
                );
            }
        }
    }
}
