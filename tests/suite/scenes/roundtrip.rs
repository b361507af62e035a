//! Reading a written scene gives the same scene.

use std::{fs, time::Instant};

use glam::Vec3;
use lights_camera_models::{
    optics::{TermSelection, colour::Encoding, tone::ToneMapping},
    parameter::{Parameter, ParameterKind, Value, Values, kind::integer::Integer},
    registry::Registry,
    scene::{
        Background, Comparison, Display, Light, Object, Observer, Repetition, Scene, SceneSize, Variant,
        check,
        comparison::{Channel, Compared, Edge, Layout, Sign},
        load::{self, Defaults},
        variant::MAX_VARIANTS,
    },
};
use proptest::prelude::*;

use crate::helpers::support::{assert_quick, full_scene, read, shipped_scenes, written};

#[test]
fn the_default_scene_comes_back() {
    assert_eq!(read(&written(&Scene::default())), Scene::default());
}

#[test]
fn writing_again_changes_nothing() {
    let once = written(&read(&full_scene().to_string()));
    assert_eq!(written(&read(&once)), once);
}

#[test]
fn lights_are_written_in_the_units_in_which_they_were_given() {
    let text = written(&read(&full_scene().to_string()));
    let json: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let (lamp, bulb) = (&json["lights"][0], &json["lights"][1]);
    assert_eq!((&bulb["luminous_flux"], &bulb["colour_temperature"]), (&400.into(), &2700.into()));
    assert!(bulb.get("colour").or(bulb.get("intensity")).is_none(), "{text}");
    assert!(lamp.get("colour_temperature").or(lamp.get("luminous_flux")).is_none(), "{text}");
    // American spelling is accepted.
    let text = full_scene().to_string().replace("colour_temperature", "color_temperature");
    assert_eq!(read(&text).lights[1].colour_temperature, Some(2700.0));
}

#[test]
fn parameters_of_other_models_are_kept() {
    let mut scene = Scene::default();
    scene.objects[0].material.set("alpha", Value::Integer(7));
    scene.objects[0].material.set("wrap_exponent", Value::Number(1.5));
    assert_eq!(scene.reflection_model, "lambert");
    assert_eq!(read(&written(&scene)), scene);
}

#[test]
fn shipped_scenes_are_valid_complete_and_survive_writing() {
    for path in shipped_scenes() {
        let registry = Registry::builtin();
        let loaded = load::file(&path, &registry, Defaults::Refuse);
        let scene = loaded.unwrap_or_else(|e| panic!("{e}")).scene;
        // In the same folder, which contains the files that it names.
        let again =
            load::from_text(&written(&scene), &path.display().to_string(), &registry, Defaults::Refuse);
        assert_eq!(again.unwrap_or_else(|e| panic!("{e}")).scene, scene, "{}", path.display());
        let text = fs::read_to_string(&path).expect("readable");
        assert!(text.contains("\"$schema\": \"./scene.schema.json\""), "{}", path.display());
    }
}

#[test]
fn ten_thousand_objects_are_read_and_written_quickly() {
    let objects = (0..10_000).map(|i| {
        let position = Vec3::new(1.0 + (i % 8) as f32, 1.0 + (i % 7) as f32, 1.0 + i as f32 * 1e-4);
        let mut object = Object { position, name: Some(format!("object {i}")), ..Object::default() };
        object.material.set("k_d", Value::Number(0.5 + (i as f32) * 5e-5));
        object.material.set("base_colour", Value::Colour([(i % 256) as u8, 1, 2]));
        object
    });
    let mut scene = Scene { objects: objects.collect(), ..Scene::default() };
    let timed = |scene: &Scene| {
        let start = Instant::now();
        let back = read(&written(scene));
        (back, start.elapsed())
    };
    let (back, took) = timed(&scene);
    assert_eq!(back, scene);
    assert_quick(took, || {
        scene.objects.truncate(1000);
        timed(&scene).1
    });
}

/// A finite number, often an awkward one.
fn number(min: f32, max: f32) -> impl Strategy<Value = f32> {
    prop_oneof![4 => min..=max, 1 => Just(min), 1 => Just(max), 1 => (min..=max).prop_map(f32::round).prop_map(move |v| v.clamp(min, max))]
}

fn position() -> impl Strategy<Value = Vec3> {
    (number(1e-3, 1.0), number(1e-3, 1.0), number(1e-3, 1.0)).prop_map(|(x, y, z)| Vec3::new(x, y, z))
}

fn vector() -> impl Strategy<Value = Vec3> {
    let n = || prop_oneof![-1e3f32..1e3, -1e-3f32..1e-3, Just(0.0)];
    (n(), n(), n()).prop_map(|(x, y, z)| Vec3::new(x, y, z))
}

fn direction() -> impl Strategy<Value = Vec3> {
    vector().prop_map(|v| if check::direction(v).is_ok() { v } else { Vec3::NEG_Z })
}

fn parameter(p: &'static Parameter) -> BoxedStrategy<Value> {
    let Some(range) = p.kind.limits() else {
        return prop::sample::select([vec![p.default_value()], p.kind.ends()].concat()).boxed();
    };
    if let ParameterKind::Integer(Integer { min, max, .. }) = p.kind {
        return (min..=max.unwrap_or(i64::MAX)).prop_map(Value::Integer).boxed();
    }
    let (least, most) = (range.min, range.max);
    let one = || match range.whole {
        true => (least as i64..=most as i64).prop_map(|v| v as f64).boxed(),
        false => number(least as f32, most as f32).prop_map(f64::from).boxed(),
    };
    [one(), one(), one()].prop_map(move |numbers| p.kind.of_numbers(numbers)).boxed()
}

/// Some of the parameters, with legal values.
fn values(parameters: Vec<&'static Parameter>) -> impl Strategy<Value = Values> {
    let each: Vec<_> = parameters
        .into_iter()
        .map(|p| prop::option::of(parameter(p)).prop_map(move |v| v.map(|v| (p.name, v))))
        .collect();
    each.prop_map(|set| {
        let mut values = Values::default();
        for (name, value) in set.into_iter().flatten() {
            values.set(name, value);
        }
        values
    })
}

fn light() -> impl Strategy<Value = Light> {
    let kinds = Registry::builtin().lights().to_vec();
    prop::sample::select(kinds).prop_flat_map(|entry| {
        let d = entry.declaration;
        let name = prop::option::of("\\PC{0,20}");
        let brightness = || prop_oneof![number(0.0, 1e3), Just(f32::MAX), Just(f32::MIN_POSITIVE)];
        let flux = prop::option::of(brightness()).prop_map(move |flux| flux.filter(|_| entry.has_flux()));
        let colour = (any::<[u8; 3]>(), prop::option::of(number(1000.0, 40_000.0)));
        let parameters = values(entry.parameters.iter().collect());
        (name, position(), direction(), colour, (brightness(), flux, any::<bool>()), parameters).prop_map(
            move |(name, p, direction, (colour, kelvin), (intensity, flux, enabled), parameters)| Light {
                light_type: d.id.to_owned(),
                name,
                enabled,
                // Apart from the positions of objects and observer.
                position: d.has_position.then_some(p + Vec3::X * 4.0),
                direction: d.has_direction.then_some(direction),
                // Absent fields have their defaults after reading.
                colour: if kelvin.is_some() { [255; 3] } else { colour },
                colour_temperature: kelvin,
                intensity: if flux.is_some() { d.default_intensity } else { intensity },
                luminous_flux: flux,
                parameters,
            },
        )
    })
}

fn object() -> impl Strategy<Value = Object> {
    let registry = Registry::builtin();
    let shapes = registry.shapes().to_vec();
    let models: Vec<_> = registry.models().iter().map(|m| m.declaration.id.to_owned()).collect();
    let shadings: Vec<_> = registry.shading_models().iter().map(|m| m.declaration.id.to_owned()).collect();
    let material: Vec<_> = registry.material_parameters().collect();
    prop::sample::select(shapes).prop_flat_map(move |shape| {
        (
            (prop::option::of("\\PC{0,20}"), any::<bool>()),
            position(),
            prop_oneof![number(1e-30, 1e3), Just(1e9), Just(f32::MIN_POSITIVE)],
            vector(),
            (
                prop::option::of(shape.declaration.tessellation.clone()),
                values(shape.parameters.iter().collect()),
            ),
            prop::option::of(prop::sample::select(models.clone())),
            prop::option::of(prop::sample::select(shadings.clone())),
            values(material.clone()),
        )
            .prop_map(
                move |(
                    (name, visible),
                    position,
                    size,
                    rotation,
                    (tessellation, parameters),
                    reflection_model,
                    shading_model,
                    material,
                )| Object {
                    object_type: shape.declaration.id.to_owned(),
                    shape: parameters,
                    name,
                    visible,
                    position,
                    size,
                    rotation,
                    tessellation,
                    reflection_model,
                    shading_model,
                    material,
                    repeat: Repetition::None,
                },
            )
    })
}

prop_compose! {
    /// A valid scene of any kind.
    pub fn scene()(
        name in prop::option::of("[\\PC\\n\\t\\\\\"]{0,20}"),
        description in prop::option::of(any::<String>()),
        size in (number(9.0, 100.0), number(9.0, 100.0), number(9.0, 100.0)),
        lights in prop::collection::vec(light(), 1..5),
        objects in prop::collection::vec(object(), 1..5),
        eye in position(),
        direction in direction(),
        field_of_view in number(1.0, 170.0),
        reflection in prop::sample::select(Registry::builtin().models().to_vec()),
        shading in prop::sample::select(Registry::builtin().shading_models().to_vec()),
        tone_mapping in prop::sample::select(&ToneMapping::ALL[..]),
        encoding in prop::sample::select(&Encoding::ALL[..]),
        exposure in number(-16.0, 16.0),
        background in prop::sample::select(Background::ALL),
        (background_colour, background_bottom) in any::<([u8; 3], [u8; 3])>(),
    ) -> Scene {
        Scene {
            name,
            description,
            scene_size: SceneSize { height: size.0, width: size.1, depth: size.2 },
            reflection_model: reflection.declaration.id.to_owned(),
            shading_model: shading.declaration.id.to_owned(),
            lights,
            observer: Observer { position: eye + Vec3::Y * 4.0, direction, field_of_view },
            objects,
            display: Display {
                tone_mapping,
                exposure,
                encoding,
                background,
                background_colour,
                background_bottom,
            },
            variants: Vec::new(),
            comparison: Comparison::default(),
        }
    }
}

fn variant() -> impl Strategy<Value = Variant> {
    let registry = Registry::builtin();
    let models: Vec<_> = registry.models().iter().map(|m| m.declaration.id.to_owned()).collect();
    let shadings: Vec<_> = registry.shading_models().iter().map(|m| m.declaration.id.to_owned()).collect();
    let option = prop::option::of::<prop::sample::Select<String>>;
    (
        option(prop::sample::select(models)),
        option(prop::sample::select(shadings)),
        values(registry.material_parameters().collect()),
        prop::option::of(prop::sample::select(&TermSelection::ALL[..])),
        prop::option::of(prop::sample::select(&ToneMapping::ALL[..])),
        prop::option::of(number(-16.0, 16.0)),
        prop::option::of(prop::sample::select(&Encoding::ALL[..])),
        prop::option::of(1..1000u32),
    )
        .prop_map(
            |(reflection_model, shading_model, material, terms, tone_mapping, exposure, encoding, count)| {
                Variant {
                    name: None,
                    based_on: None,
                    reflection_model,
                    shading_model,
                    material,
                    terms,
                    tone_mapping,
                    exposure,
                    encoding,
                    tessellation: count,
                }
            },
        )
}

prop_compose! {
    /// A valid scene with compared views.
    fn compared()(
        scene in scene(),
        mut variants in prop::collection::vec(variant(), 0..=MAX_VARIANTS),
        named in any::<bool>(),
        with in 1..=MAX_VARIANTS,
        split in number(0.0, 1.0),
        amplification in prop::option::of(number(1.0, 100.0)),
        layout in prop::sample::select(Layout::ALL),
        edge in prop::sample::select(Edge::ALL),
        sign in prop::sample::select(Sign::ALL),
        channel in prop::sample::select(Channel::ALL),
        values in prop::sample::select(Compared::ALL),
    ) -> Scene {
        for (i, variant) in variants.iter_mut().enumerate().filter(|_| named) {
            variant.name = Some(format!("variant \"{i}\""));
            variant.based_on = i.checked_sub(1).map(|base| format!("variant \"{base}\""));
        }
        let with = with.min(variants.len().max(1));
        let comparison = Comparison { layout, with, split, edge, sign, channel, values, amplification };
        Scene { variants, comparison, ..scene }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 256, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn every_valid_scene_comes_back_as_it_was(scene in compared()) {
        prop_assert_eq!(check::scene(&scene, &Registry::builtin()), vec![]);
        prop_assert_eq!(read(&written(&scene)), scene);
    }
}
