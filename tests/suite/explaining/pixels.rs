//! The explanation of a pixel against the picture: `explain::pixel` and `lcm explain`.

use std::{fs, sync::atomic::AtomicBool};

use glam::Vec3;
use lights_camera_models::{
    caption,
    explain::{self, ExplainError, Explainer, Explanation, Place, Spot},
    light::Incident,
    optics::{TermSelection, colour::Encoding, tone::ToneMapping},
    reference::{self, LightSamples, Settings},
    registry::Registry,
    scene::{
        Background, Display, Light, Object, Repetition, Scene,
        load::{self, Defaults},
    },
    testing::random,
};
use serde_json::json;

use crate::helpers::support::{builtin, lcm, lcm_in, root, shipped_scenes, written};

const SMALL: Settings = Settings { width: 160, height: 90, samples: 1, terms: TermSelection::All };

fn at(scene: &Scene, pixel: [u32; 2]) -> Explanation {
    explain::pixel(scene, &builtin(), &SMALL, pixel).expect("in the picture")
}

/// The default scene with other models.
fn scene(model: &str, shading: &str) -> Scene {
    Scene { reflection_model: model.to_owned(), shading_model: shading.to_owned(), ..Scene::default() }
}

/// The middle of the default scene's sphere.
const MIDDLE: [u32; 2] = [80, 45];

fn near(a: Vec3, b: Vec3, tolerance: f32) -> bool {
    (a - b).abs().max_element() <= tolerance * b.abs().max_element().max(1e-6)
}

/// Copies of a row are told apart by what a picture writes below them.
#[test]
fn a_copy_of_a_row_has_the_label_that_pictures_give_it() {
    let file = root().join("scenes/five_spheres.json");
    let mut scene = load::file(&file, &builtin(), Defaults::Refuse).expect("a scene").scene;
    let labels = caption::row_labels(&scene, &builtin());
    assert_eq!(labels.len(), 5);
    let mut found = Vec::new();
    for x in (0..SMALL.width).step_by(4) {
        let explained = at(&scene, [x, 45]);
        let Some(seen) = &explained.seen else { continue };
        let (_, parts) = &labels[seen.object.index];
        let label = caption::line(parts);
        assert_eq!(seen.label.as_ref(), Some(&label), "{x}");
        assert!(explained.to_text().contains(&format!("\n  label: {label}\n")), "{}", explained.to_text());
        assert_eq!(explained.to_json()["seen"]["label"], label);
        found.push(label);
    }
    found.dedup();
    assert_eq!((found.len(), &*found[0]), (5, "r 0.1"), "{found:?}");
    // Without the row they are objects like others.
    scene.objects.iter_mut().for_each(|object| object.repeat = Repetition::None);
    assert_eq!(at(&scene, MIDDLE).seen.expect("the third").label, None);
}

/// The first error in an explanation; `code` is that of the picture.
fn wrong(explained: &Explanation, code: [u8; 3], light: Vec3) -> Result<(), String> {
    if explained.code() != code {
        return Err(format!("the code is {:?}, in the picture {code:?}", explained.code()));
    }
    if explained.steps.light.to_array().map(f32::to_bits) != light.to_array().map(f32::to_bits) {
        return Err(format!("the light is {}, in the picture {light}", explained.steps.light));
    }
    let Some(seen) = &explained.seen else { return Ok(()) };
    for spot in &seen.spots {
        adds_up(explained, spot)?;
    }
    // From the points to the pixel.
    let made: Vec3 = match seen.spots.as_slice() {
        [one] => one.colour,
        several => several
            .iter()
            .filter_map(|spot| match spot.place {
                Place::Vertex { weight, .. } => Some(weight * spot.colour),
                Place::Polygon | Place::Pixel => None,
            })
            .sum(),
    };
    if !near(made, seen.light, 1e-3) {
        return Err(format!("the points make {made}, but the light is {}", seen.light));
    }
    let position: Vec3 = seen.corners.iter().map(|corner| corner.weight * corner.position).sum();
    if (position - seen.position).length() > 1e-3 {
        return Err(format!("the weights make {position}, but the point is {}", seen.position));
    }
    Ok(())
}

/// Factors multiply to the intensity, responses give the contributions, contributions the sum.
fn adds_up(explained: &Explanation, spot: &Spot) -> Result<(), String> {
    let mut sum = Vec3::ZERO;
    for lit in &spot.lights {
        let intensity = lit.factors.iter().fold(Vec3::ONE, |product, factor| product * factor.value);
        // Light with extent arrives from many directions, and has no factors at the point.
        if lit.integral.is_none() && !near(intensity, lit.intensity, 1e-3) {
            return Err(format!("the factors make {intensity}, but the intensity is {}", lit.intensity));
        }
        let response = lit.response.select(explained.terms);
        if !near(response * lit.arriving + lit.through, lit.contribution, 1e-4) {
            return Err(format!(
                "{response} × {} + {} is not {}",
                lit.arriving, lit.through, lit.contribution
            ));
        }
        sum += lit.contribution;
    }
    if near(sum, spot.sum, 1e-4) {
        Ok(())
    } else {
        Err(format!("the lights add up to {sum}, but the sum is {}", spot.sum))
    }
}

/// The samples of light with extent for each of the shading models.
const SAMPLES: [u32; 4] = [LightSamples::DEFAULT, 64, 64, 64];

#[test]
fn every_number_leads_to_the_code_of_the_picture() {
    let registry = Registry::builtin();
    let mut seed = 7;
    let (mut objects, mut backgrounds) = (0, 0);
    let mut refused = 0;
    for path in shipped_scenes() {
        let shipped = load::file(&path, &registry, Defaults::Use).unwrap_or_else(|e| panic!("{e}")).scene;
        // As the window does: meshes are built once.
        let mut explainer = Explainer::default();
        // Both take the same samples of light with extent, so that few compare as well as the usual number.
        for (shading, count) in registry.shading_models().iter().zip(SAMPLES) {
            let view = (random(&mut seed) * (shipped.variants.len() + 1) as f32) as usize;
            let (mut scene, terms) = shipped.seen(view, &registry).expect("there is such a view");
            let models = registry.models();
            let model =
                models[(random(&mut seed) * models.len() as f32) as usize % models.len()].declaration.id;
            // Sometimes unchanged: with overrides of objects.
            if random(&mut seed) < 0.7 {
                model.clone_into(&mut scene.reflection_model);
                shading.declaration.id.clone_into(&mut scene.shading_model);
                for object in &mut scene.objects {
                    (object.reflection_model, object.shading_model) = (None, None);
                }
            }
            let tones = ToneMapping::ALL;
            scene.display.tone_mapping = tones[(random(&mut seed) * 8.0) as usize % 8];
            scene.display.exposure = 4.0 * random(&mut seed) - 2.0;
            scene.display.background = Background::ALL[(objects + backgrounds) / 12 % Background::ALL.len()];
            // Twelve pixels of each are compared, whatever its size.
            let settings = Settings { width: SMALL.width / 2, height: SMALL.height / 2, terms, ..SMALL };
            let (samples, odd) = (LightSamples::of(count), AtomicBool::default());
            let picture = reference::render_samples(&scene, &registry, &settings, samples, &odd);
            let codes = picture.to_rgb8(&scene.display);
            let pick = |side: u32, seed: &mut u64| ((random(seed) * side as f32) as u32).min(side - 1);
            explainer.set_light_samples(count);
            let mut previous: Option<Explanation> = None;
            for _ in 0..12 {
                let pixel = [pick(settings.width, &mut seed), pick(settings.height, &mut seed)];
                let explained = explainer.pixel(&scene, &registry, &settings, pixel).expect("in the picture");
                let i = (pixel[1] * settings.width + pixel[0]) as usize;
                let code = [codes[3 * i], codes[3 * i + 1], codes[3 * i + 2]];
                let light = picture.pixels[i];
                wrong(&explained, code, light.truncate())
                    .unwrap_or_else(|what| panic!("{} {model} {pixel:?}: {what}", path.display()));
                let something = explained.seen.is_some() || explained.lamp.is_some();
                assert_eq!(something, light.w == 1.0, "{}", path.display());
                match explained.seen {
                    Some(_) => objects += 1,
                    None => backgrounds += 1,
                }
                // The wrong twin: the explanation of another pixel.
                if let Some(other) = previous {
                    refused += usize::from(wrong(&other, code, light.truncate()).is_err());
                }
                previous = Some(explained);
            }
        }
    }
    assert_eq!(registry.shading_models().len(), SAMPLES.len());
    assert!(objects > 300 && backgrounds > 100 && refused > 300, "{objects} {backgrounds} {refused}");
}

#[test]
fn a_number_that_is_changed_is_noticed() {
    let scene = scene("phong", "gouraud");
    let explained = at(&scene, MIDDLE);
    let (code, light) = (explained.code(), explained.steps.light);
    assert_eq!(wrong(&explained, code, light), Ok(()));
    let twins: [fn(&mut Explanation); 6] = [
        |e| e.seen.as_mut().unwrap().spots[1].lights[0].factors[0].value *= 1.01,
        |e| e.seen.as_mut().unwrap().spots[1].lights[0].response.diffuse *= 1.01,
        |e| e.seen.as_mut().unwrap().spots[1].lights[0].contribution *= 1.01,
        |e| e.seen.as_mut().unwrap().spots[1].colour *= 1.1,
        |e| e.seen.as_mut().unwrap().spots[0].sum *= 1.01,
        |e| e.seen.as_mut().unwrap().corners[0].weight += 0.1,
    ];
    for (i, twin) in twins.into_iter().enumerate() {
        let mut changed = explained.clone();
        twin(&mut changed);
        assert!(wrong(&changed, code, light).is_err(), "twin {i}");
    }
    let other = explained.code().map(|c| c.wrapping_add(1));
    assert!(wrong(&explained, other, light).is_err());
}

#[test]
fn the_equation_is_evaluated_where_the_shading_model_does() {
    let flat = at(&scene("phong", "flat"), MIDDLE).seen.expect("the sphere");
    let [centre] = flat.spots.as_slice() else { panic!("{:?}", flat.spots) };
    assert_eq!(centre.place, Place::Polygon);
    assert!((centre.normal - flat.face_normal).length() < 0.05, "the normal of the polygon");
    assert!((centre.position - flat.position).length() > 1e-4);
    assert!(flat.per_pixel.is_some());

    let gouraud = at(&scene("phong", "gouraud"), MIDDLE).seen.expect("the sphere");
    let weights = gouraud.corners.map(|c| c.weight);
    assert!(
        (weights.iter().sum::<f32>() - 1.0).abs() < 1e-5 && weights.iter().all(|w| (0.0..=1.0).contains(w))
    );
    for (spot, corner) in gouraud.spots.iter().zip(&gouraud.corners) {
        assert_eq!(spot.place, Place::Vertex { vertex: corner.vertex, weight: corner.weight });
        assert_eq!((spot.position, spot.colour), (corner.position, corner.colour));
        // A sphere: the normal of a vertex points away from the centre.
        assert!((spot.normal - (spot.position - Vec3::splat(5.0)).normalize()).length() < 0.02);
    }

    let phong = at(&scene("phong", "phong"), MIDDLE).seen.expect("the sphere");
    let [pixel] = phong.spots.as_slice() else { panic!("{:?}", phong.spots) };
    assert_eq!((pixel.place, pixel.position), (Place::Pixel, phong.position));
    let length = phong.interpolated_normal.length();
    assert!(length < 1.0 - 1e-6, "shortened by interpolation: {length}");
    assert_eq!(pixel.normal, phong.interpolated_normal.normalize());
    assert!(phong.per_pixel.is_none());
    // Gouraud shading is compared with the result of Phong shading.
    let instead = gouraud.per_pixel.expect("evaluated at vertices");
    assert_eq!(
        (instead.position, instead.normal, instead.colour),
        (pixel.position, pixel.normal, pixel.colour)
    );
    assert_eq!(flat.per_pixel.map(|spot| spot.colour), Some(pixel.colour));

    let derivative = at(&scene("phong", "derivative"), MIDDLE).seen.expect("the sphere");
    assert_eq!(derivative.spots[0].normal, derivative.face_normal);
    assert_eq!(derivative.spots[0].position, phong.position);
}

#[test]
fn directions_and_cosines_are_those_of_the_scene() {
    let scene = scene("phong", "phong");
    let explained = at(&scene, MIDDLE);
    let spot = &explained.seen.as_ref().expect("the sphere").spots[0];
    let lit = &spot.lights[0];
    let to_light = scene.lights[0].position.expect("a point light") - spot.position;
    let d = to_light.length();
    assert_eq!(lit.distance, Some(d));
    assert!((lit.intensity.x - 20.0 / (d * d)).abs() < 1e-4);
    let geometry = lit.geometry.expect("it has a direction");
    assert!((geometry.l - to_light / d).length() < 1e-6);
    assert!((spot.view - (scene.observer.position - spot.position).normalize()).length() < 1e-6);
    assert!((geometry.h - (geometry.l + spot.view).normalize()).length() < 1e-6);
    let n_l = spot.normal.dot(geometry.l);
    assert!((geometry.r - (2.0 * n_l * spot.normal - geometry.l)).length() < 1e-6);
    assert_eq!(geometry.cosine("N·L"), n_l);
    assert_eq!(geometry.cosine("R·V"), geometry.r.dot(spot.view));
    assert!((explain::angle(0.5) - 60.0).abs() < 1e-4 && explain::angle(1.000_001) == 0.0);
    // By hand: Phong's equation with its defaults.
    let specular = 0.5 * geometry.cosine("R·V").max(0.0).powf(32.0);
    assert!(near(lit.response.diffuse, Vec3::splat(0.8 * n_l), 1e-5));
    assert!(near(lit.response.specular, Vec3::splat(specular), 1e-4));
    let text = explained.to_text();
    for expected in [
        "I_d = k_d max(0, N·L) C_b\n",
        &format!("= 0.8 × max(0, {}) × (1, 1, 1)\n", explain::number(n_l)),
        &format!("= 20 cd × {} 1/m² = {}", explain::number(1.0 / (d * d)), explain::number(lit.intensity.x)),
        "I_a = k_a C_b\n",
        "Reflection model: Phong (B. T. Phong 1975)",
        "interpolated normal: ",
        "tone mapping, None (clip)",
    ] {
        assert!(text.contains(expected), "{expected}\n{text}");
    }
}

#[test]
fn each_light_has_its_own_formula() {
    let mut scene = scene("phong", "phong");
    let of = |light_type: &str| {
        let registry = Registry::builtin();
        let mut light = Light::default();
        light.set_type(registry.light(light_type).expect("built in"), &registry, Scene::default().scene_size);
        light.position = light.position.map(|_| Vec3::new(5.0, 9.0, 6.5));
        light
    };
    scene.lights = ["point", "spot", "photometric", "directional", "ambient"].map(of).to_vec();
    let off = Light { enabled: false, ..of("point") };
    scene.lights.insert(0, off);
    let explained = at(&scene, [80, 30]);
    let spot = &explained.seen.as_ref().expect("the sphere").spots[0];
    let factors = |i: usize| spot.lights[i].factors.iter().map(|f| f.symbol).collect::<Vec<_>>();
    // The first light is off: the indices are still those of the scene.
    assert_eq!(spot.lights.iter().map(|lit| lit.light.index).collect::<Vec<_>>(), [1, 2, 3, 4, 5]);
    assert_eq!(factors(0), ["I", "1/d^2"]);
    assert_eq!(factors(1), ["I", "cone(θ, θ_c, s)", "1/d^2"]);
    assert_eq!(factors(2), ["I", "w", "1/d^2"]);
    assert_eq!((factors(3), factors(4)), (vec!["I"], vec!["I"]));
    assert!(spot.lights[3].distance.is_none() && spot.lights[3].geometry.is_some());
    let ambient = &spot.lights[4];
    assert!(ambient.geometry.is_none());
    assert_eq!(ambient.response.ambient, Vec3::splat(0.1), "k_a C_b");
    let order: Vec<_> = spot.brightest().iter().map(|lit| lit.contribution.y).collect();
    assert!(order.windows(2).all(|pair| pair[0] >= pair[1]), "{order:?}");
    let text = explained.to_text();
    for expected in [
        "I(p) = I cone(θ, θ_c, s) / d^2 = ",
        "θ_c = 30°",
        "γ = ",
        "Light from everywhere",
        "sum over 5 lights",
    ] {
        assert!(text.contains(expected), "{expected}\n{text}");
    }
    assert!(!text.contains("lights[0]"), "{text}");
}

#[test]
fn terms_that_are_left_out_are_left_out() {
    let scene = scene("phong", "phong");
    let mut specular = None;
    for terms in TermSelection::ALL {
        let settings = Settings { terms, ..SMALL };
        let explained = explain::pixel(&scene, &builtin(), &settings, MIDDLE).expect("in the picture");
        let lit = &explained.seen.as_ref().expect("the sphere").spots[0].lights[0];
        assert!(near(lit.contribution, lit.response.select(terms) * lit.arriving, 1e-5), "{terms:?}");
        let text = explained.to_text();
        assert_eq!(text.contains("Only the"), terms != TermSelection::All, "{text}");
        // Nor are they listed under the light.
        let lines = lit.lines(&explained.seen.as_ref().expect("the sphere").model);
        let shown = explain::shown_lines(&lines, terms);
        let counts = |line: &&explain::Line| terms == TermSelection::All || line.term.alone() == Some(terms);
        assert!(shown.iter().filter(|line| line.is_term()).all(counts), "{terms:?}: {shown:?}");
        assert_eq!(shown.len() == lines.len(), terms == TermSelection::All, "{terms:?}: {lines:?}");
        let listed = text.matches("I_s = ").count();
        let most = *specular.get_or_insert(listed);
        let hidden = !matches!(terms, TermSelection::All | TermSelection::Specular);
        assert_eq!(listed < most, hidden, "{terms:?}: {text}");
        if terms == TermSelection::Diffuse {
            assert!(text.contains("light to the observer: I_d × "), "{text}");
        }
    }
}

#[test]
fn background_hidden_objects_and_darkness_are_said_plainly() {
    let background = at(&Scene::default(), [0, 0]);
    assert!(background.seen.is_none());
    assert_eq!(background.code(), reference::BACKGROUND);
    assert!(background.to_text().contains("only background"), "{}", background.to_text());
    assert_eq!(background.to_json()["background"], true);
    assert!(background.to_text().contains("whatever the exposure"), "{}", background.to_text());

    // A colour of the scene is shown as it is.
    let display = Display {
        tone_mapping: ToneMapping::AgX,
        encoding: Encoding::Off,
        exposure: 3.0,
        background: Background::Colour,
        background_colour: [12, 200, 255],
        ..Display::default()
    };
    let picked = at(&Scene { display, ..Scene::default() }, [0, 0]);
    assert_eq!(picked.code(), [12, 200, 255]);
    let text = picked.to_text();
    assert!(text.contains("only background: the colour that the scene gives"), "{text}");
    let steps = text.contains("tone mapping, ") || text.contains("without encoding");
    assert!(text.contains("as the scene gives it") && !steps, "{text}");

    let mut hidden = Scene::default();
    hidden.objects[0].visible = false;
    assert!(at(&hidden, MIDDLE).seen.is_none());
    // There is another object behind a hidden one, and its index is that of the scene.
    hidden.objects.push(Object { name: Some("ball".to_owned()), ..Object::default() });
    let seen = at(&hidden, MIDDLE).seen.expect("the second sphere");
    assert_eq!((seen.object.index, seen.object.name.as_deref()), (1, Some("ball")));

    let mut dark = Scene::default();
    dark.lights[0].enabled = false;
    let explained = at(&dark, MIDDLE);
    assert_eq!(explained.code(), [0; 3]);
    assert!(explained.to_text().contains("No light is switched on"), "{}", explained.to_text());

    // An observer within an object sees no back faces.
    let mut within = Scene::default();
    within.observer.position = Vec3::splat(5.0);
    assert!(at(&within, MIDDLE).seen.is_none());

    // A light behind the surface.
    let mut behind = scene("phong", "phong");
    behind.lights[0].position = Some(Vec3::new(5.0, 5.0, 0.5));
    let explained = at(&behind, MIDDLE);
    let lit = &explained.seen.as_ref().expect("the sphere").spots[0].lights[0];
    assert!(lit.is_behind() && lit.response.specular == Vec3::ZERO && lit.response.diffuse == Vec3::ZERO);
    assert!(explained.to_text().contains("faces away from the light"), "{}", explained.to_text());

    // A light within the object, exactly at the point.
    let mut touching = scene("phong", "phong");
    touching.lights[0].position = Some(lit_point(&touching));
    let explained = at(&touching, MIDDLE);
    assert!(explained.steps.light.is_finite(), "{}", explained.to_text());
}

/// The point visible in the middle.
fn lit_point(scene: &Scene) -> Vec3 {
    at(scene, MIDDLE).seen.expect("the sphere").position
}

#[test]
fn what_is_no_number_is_not_hidden() {
    let mut scene = scene("phong", "phong");
    scene.lights[0].intensity = f32::INFINITY;
    let explained = at(&scene, MIDDLE);
    let spot = &explained.seen.as_ref().expect("the sphere").spots[0];
    assert!(spot.is_replaced() && !spot.lights[0].is_finite());
    assert!(explained.steps.light.is_finite());
    let text = explained.to_text();
    for expected in ["∞", "not finite numbers", "counts as 0, and nothing beyond"] {
        assert!(text.contains(expected), "{expected}\n{text}");
    }
    let json = explained.to_json().to_string();
    assert!(json.contains("\"Infinity\""), "{json}");
    scene.lights[0].intensity = f32::NAN;
    let explained = at(&scene, MIDDLE);
    assert!(explained.to_text().contains("(NaN, NaN, NaN)"), "{}", explained.to_text());
    assert!(explained.to_json().to_string().contains("\"NaN\""));
    assert_eq!(explained.code(), [0; 3]);
    let picture = reference::render_rgb8(&scene, &Registry::builtin(), &SMALL);
    let i = (3 * (MIDDLE[1] * SMALL.width + MIDDLE[0])) as usize;
    assert_eq!(picture[i..i + 3], [0; 3]);
}

#[test]
fn a_pixel_outside_the_picture_is_refused_with_the_legal_range() {
    let registry = Registry::builtin();
    let error = explain::pixel(&Scene::default(), &registry, &SMALL, [160, 0]).expect_err("outside");
    assert_eq!(error, ExplainError::Outside { pixel: [160, 0], size: [160, 90] });
    assert_eq!(
        error.to_string(),
        "the pixel 160,0 is outside the picture of 160x90 pixels; X must be from 0 to 159, and Y from 0 to 89"
    );
    let none = Settings { width: 0, height: 5, ..SMALL };
    let error = explain::pixel(&Scene::default(), &registry, &none, [0, 0]).expect_err("outside");
    assert!(error.to_string().ends_with("it has no pixels"), "{error}");
}

#[test]
fn clipping_at_the_near_plane_and_large_triangles_are_explained_too() {
    let registry = Registry::builtin();
    for shading in ["flat", "gouraud", "phong", "derivative"] {
        let mut scene = scene("blinn_phong", shading);
        // A cube of few, large polygons that reaches behind the eye.
        scene.objects[0] = Object {
            object_type: "cube".to_owned(),
            size: 9.0,
            position: Vec3::new(5.0, 0.2, 8.0),
            tessellation: Some(1),
            ..Object::default()
        };
        scene.observer.direction = Vec3::new(0.1, -0.3, -1.0);
        let picture = reference::render(&scene, &registry, &SMALL);
        let codes = picture.to_rgb8(&scene.display);
        let mut explainer = Explainer::default();
        let mut seen = 0;
        for i in (0..picture.pixels.len()).step_by(97) {
            let pixel = [i as u32 % SMALL.width, i as u32 / SMALL.width];
            let explained = explainer.pixel(&scene, &registry, &SMALL, pixel).expect("in the picture");
            let code = [codes[3 * i], codes[3 * i + 1], codes[3 * i + 2]];
            wrong(&explained, code, picture.pixels[i].truncate())
                .unwrap_or_else(|what| panic!("{shading} {pixel:?}: {what}"));
            seen += usize::from(explained.seen.is_some());
        }
        assert!(seen > 20, "{shading}: {seen}");
    }
}

#[test]
fn without_encoding_the_steps_say_so() {
    let display = Display { encoding: Encoding::Off, exposure: 1.0, ..Display::default() };
    let scene = Scene { display, ..Scene::default() };
    let explained = at(&scene, MIDDLE);
    let steps = explained.steps;
    assert_eq!(steps.exposed, 2.0 * steps.light);
    // The numbers themselves reach the display.
    assert!(near(steps.encoded, steps.exposed.clamp(Vec3::ZERO, Vec3::ONE), 1e-4));
    assert!(explained.to_text().contains("without encoding"), "{}", explained.to_text());
}

#[test]
fn custom_models_are_explained_by_the_interpreter() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::create_dir(folder.path().join("models")).expect("writable");
    fs::copy(root().join("assets/models/gooch.wgsl"), folder.path().join("models/mine.wgsl")).expect("there");
    let mut scene: serde_json::Value = serde_json::from_str(&lights_camera_models::scene::save::to_json(
        &Scene::default(),
        None,
        &Registry::builtin(),
    ))
    .expect("JSON");
    scene["reflection_model"] = json!("mine");
    scene["shading_model"] = json!("phong");
    fs::write(folder.path().join("a.json"), scene.to_string()).expect("writable");
    let arguments = ["explain", "a.json", "--models", "models", "--at", "320,180", "--size", "640x360"];
    let run = lcm_in(folder.path(), &arguments, b"");
    assert_eq!((run.status, run.err.as_str()), (Some(0), ""));
    assert!(run.out.contains("The CPU interprets the WGSL of this model."), "{}", run.out);
    let run = lcm_in(folder.path(), &[arguments.as_slice(), &["--json"]].concat(), b"");
    let json: serde_json::Value = serde_json::from_str(&run.out).expect("JSON");
    let model = &json["seen"]["reflection_model"];
    assert_eq!((&model["id"], &model["interpreted"]), (&json!("mine"), &json!(true)));
    assert!(!model["parameters"].as_array().expect("a list").is_empty());
    let code: Vec<u8> = serde_json::from_value(json["code"].clone()).expect("three codes");
    let arguments = [
        "render",
        "a.json",
        "--models",
        "models",
        "--size",
        "640x360",
        "--renderer",
        "cpu",
        "--samples",
        "1",
        "-o",
        "a.png",
    ];
    assert_eq!(lcm_in(folder.path(), &arguments, b"").status, Some(0));
    let (_, picture) = crate::renderers::golden::read_png(&folder.path().join("a.png"))
        .map(|(width, height, rgb)| ((width, height), rgb))
        .expect("a picture");
    let i = 3 * (180 * 640 + 320);
    assert_eq!(picture[i..i + 3], code);
}

#[test]
fn the_command_explains_a_view_and_refuses_what_it_cannot() {
    let run = lcm(&["explain", "--at", "640,360"], "");
    assert_eq!((run.status, run.err.as_str()), (Some(0), ""));
    assert!(run.out.starts_with("Pixel 640,360 of 1280×720: red "), "{}", run.out);
    let file = "scenes/compare_phong_blinn_phong.json";
    let model = |view: &str| {
        let run = lcm(&["explain", file, "--at", "640,360", "--view", view, "--json"], "");
        let json: serde_json::Value = serde_json::from_str(&run.out).expect("JSON");
        json["seen"]["reflection_model"]["id"].as_str().map(str::to_owned)
    };
    assert_ne!(model("A"), model("B"));
    for (arguments, status, expected) in [
        (vec!["explain"], 2, "--at"),
        (vec!["explain", "--at", "5"], 2, "it must be X,Y: two whole numbers, 0 or more"),
        (vec!["explain", "--at", "-1,5"], 2, "it must be X,Y"),
        (
            vec!["explain", "--at", "1280,5"],
            2,
            "error: --at: the pixel 1280,5 is outside the picture of 1280x720 pixels; X must be from 0 to 1279, and Y from 0 to 719",
        ),
        (
            vec!["explain", "--at", "1,1", "--view", "D"],
            1,
            "the default scene: there is no view \"D\"; it must be A",
        ),
        (vec!["explain", "none.json", "--at", "1,1"], 1, "none.json: file not found"),
        (vec!["explain", "--at", "1,1", "--term", "diffus"], 2, "did you mean diffuse?"),
    ] {
        let run = lcm(&arguments, "");
        assert_eq!(run.status, Some(status), "{arguments:?} {}", run.err);
        assert!(run.err.contains(expected), "{arguments:?}: {}", run.err);
        assert_eq!(run.out, "");
    }
}

#[test]
fn the_factors_of_a_light_are_its_light() {
    // The law is in `testing`; this is its wrong twin.
    let registry = Registry::builtin();
    let scene = Scene::default();
    let entry = registry.light("point").expect("built in");
    let emitter = (entry.instantiate)(&scene.lights[0].parameters, Encoding::Srgb);
    let record = lights_camera_models::scene::record(&scene.lights[0], &registry, Encoding::Srgb);
    let Incident::From { intensity, .. } = emitter.incident(&record, Vec3::ONE) else {
        panic!("it has a place")
    };
    let product = |factors: &[lights_camera_models::light::Factor]| {
        factors.iter().fold(Vec3::ONE, |product, factor| product * factor.value)
    };
    let factors = emitter.factors(&record, Vec3::ONE);
    assert!(near(product(&factors), intensity, 1e-6));
    assert!(!near(product(&factors[1..]), intensity, 1e-2));
}

#[test]
fn models_that_say_less_are_explained_as_far_as_they_say() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::create_dir(folder.path().join("models")).expect("writable");
    let response = "fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {
    return Terms(vec3(0.0), 0.5 * vec3(max(dot(frame.n, l), 0.0)), vec3(0.0));
}
";
    let explained = |id: &str, declaration: &str| {
        let text = format!("/* lcm {declaration} */\n{response}");
        fs::write(folder.path().join(format!("models/{id}.wgsl")), text).expect("writable");
        let scene = Scene { reflection_model: id.to_owned(), ..scene("lambert", "phong") };
        let mut text: serde_json::Value = serde_json::from_str(&written(&scene)).expect("JSON");
        text["reflection_model"] = json!(id);
        fs::write(folder.path().join("a.json"), text.to_string()).expect("writable");
        let run = lcm_in(folder.path(), &["explain", "a.json", "--models", "models", "--at", "640,360"], b"");
        assert_eq!((run.status, run.err.as_str()), (Some(0), ""), "{id}");
        run.out
    };
    let silent = explained("silent", "{ \"parameters\": [] }");
    assert!(silent.contains("\n    I_d = (0.3"), "{silent}");
    let whole = explained("whole", "{ \"equation\": \"I = max(0, N·L)/2\", \"parameters\": [] }");
    for expected in ["    I = max(0, N·L)/2\n      = max(0, 0.60", ")/2\n      = (0.3", "\n    I_d = (0.3"] {
        assert!(whole.contains(expected), "{expected}\n{whole}");
    }
}

#[test]
fn the_hemisphere_above_a_point_is_a_picture() {
    let folder = tempfile::tempdir().expect("a folder");
    let run = lcm_in(folder.path(), &["explain", "--at", "640,360", "--hemisphere", "above.png"], b"");
    assert_eq!(run.status, Some(0));
    assert!(run.err.contains("--hemisphere: No light with extent shines on the point"), "{}", run.err);
    let bytes = fs::read(folder.path().join("above.png")).expect("written");
    assert!(bytes.starts_with(b"\x89PNG"));
    let run = lcm_in(folder.path(), &["explain", "--at", "0,0", "--hemisphere", "none.png"], b"");
    assert!(run.status == Some(2) && run.err.contains("choose a pixel on an object"), "{}", run.err);
    assert!(!folder.path().join("none.png").exists());
}
