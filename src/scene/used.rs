//! The values of a scene that its models and types use: not all have each parameter, and some use one only with some
//! choices.

use super::{Field, Key, Light, Object, Part, Scene, field::Ids, part::Fields};
use crate::{
    parameter::{Parameter, Values},
    reflection::usage,
    registry::Registry,
    text::{listed, with_article},
};

/// The reason why a value has no effect.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Idle {
    /// The reason: "Lambert has no roughness".
    pub why: String,
    /// The ids of the models or types with such a parameter, if this one lacks it.
    pub users: Vec<&'static str>,
}

/// The reason why a scene makes no use of a value of a part; `None` if it does.
pub(super) fn idle(
    (part, key): (Part, Key),
    parameter: &Parameter,
    scene: &Scene,
    registry: &Registry,
) -> Option<Idle> {
    let in_material = |object: &Object| in_material(scene, object, parameter, registry);
    let in_type = |fields: &dyn Fields, values: &Values| {
        let (ids, id) = type_of(part, fields)?;
        let users = || ids.having(parameter.name, registry);
        idle_in(&[fields.parameters(registry)], values, parameter, (&with_article(&id), &users))
    };
    match (key, part) {
        (Key::Material(_), Part::Object(i)) => in_material(scene.objects.get(i)?),
        // One object that uses it is enough: no reason is less than any.
        (Key::Material(_), _) => scene.shown().map(in_material).min().flatten(),
        (Key::Own(_), Part::Light(i)) => scene.lights.get(i).and_then(|l| in_type(l, &l.parameters)),
        (Key::Own(_), Part::Object(i)) => scene.objects.get(i).and_then(|o| in_type(o, &o.shape)),
        (Key::Own(_), _) => None,
    }
}

/// The reason why a parameter of an object's material has no effect on it.
fn in_material(scene: &Scene, object: &Object, parameter: &Parameter, registry: &Registry) -> Option<Idle> {
    let model = registry.model(scene.model_of(object));
    let shading = registry.shading_model(scene.shading_model_of(object));
    let lists = [model.map_or(&[][..], |m| m.parameters), shading.map_or(&[][..], |s| s.parameters)];
    let who = model.map_or(scene.model_of(object), |model| model.declaration.name);
    let has = |all: &[Parameter]| all.iter().any(|p| p.name == parameter.name);
    let users = || registry.material_users().filter(|(_, all)| has(all)).map(|(id, _)| id).collect();
    idle_in(&lists, &object.material, parameter, (who, &users))
}

/// The reason why none of these lists of parameters, which `who` has, uses one; others that have it are `users`.
fn idle_in(
    lists: &[&[Parameter]],
    values: &Values,
    wanted: &Parameter,
    (who, users): (&str, &dyn Fn() -> Vec<&'static str>),
) -> Option<Idle> {
    let own = |all: &&[Parameter]| {
        let parameter = all.iter().find(|p| p.name == wanted.name)?;
        Some(usage::unused(all, parameter, values).map(|why| Idle { why, users: Vec::new() }))
    };
    let least = lists.iter().filter_map(own).min();
    least.unwrap_or_else(|| Some(Idle { why: format!("{who} has no {}", wanted.label), users: users() }))
}

/// The registered types of a part that has one of them, and the field with its id.
fn types(part: Part) -> Option<(Ids, Field)> {
    match part {
        Part::Light(_) => Some((Ids::LightType, Light::light_type)),
        Part::Object(_) => Some((Ids::ObjectType, Object::object_type)),
        _ => None,
    }
}

/// The types of which a part has one, and the id of that one.
fn type_of(part: Part, fields: &dyn Fields) -> Option<(Ids, String)> {
    let (ids, field) = types(part)?;
    Some((ids, fields.value(field.into())?.to_string()))
}

/// For messages: the types with a parameter that the type of this part lacks, if there are some.
pub(super) fn other_types(
    part: Part,
    fields: &dyn Fields,
    name: &str,
    registry: &Registry,
) -> Option<String> {
    let (ids, own) = type_of(part, fields)?;
    let users = ids.having(name, registry);
    let at = part.path();
    let rule = format!("; {at} is {}, and only {}", with_article(&own), listed(&users, "and"));
    let has = if users.len() == 1 { "has" } else { "have" };
    (!users.is_empty()).then(|| format!("{rule} {has} such a parameter"))
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::{
        optics::colour::Encoding,
        parameter::Value,
        scene::{at::Place, emitter},
    };

    fn idle(path: &str, scene: &Scene) -> Option<Idle> {
        let registry = Registry::builtin();
        let place = Place::find(path, scene, &registry).unwrap_or_else(|e| panic!("{e}"));
        place.idle(scene, &registry)
    }

    #[test]
    fn models_and_types_say_which_parameters_they_do_not_use() {
        let mut scene = Scene::default();
        let roughness = "objects[0].material.roughness";
        let said = idle(roughness, &scene).expect("Lambert is matte");
        assert_eq!(said.why, "Lambert has no roughness");
        assert!(said.users.contains(&"eon") && !said.users.contains(&"phong"), "{said:?}");
        assert_eq!(idle("objects[0].material.base_colour", &scene), None);
        assert_eq!(idle("objects[0].size", &scene), None);
        scene.objects.push(Object { reflection_model: Some("eon".to_owned()), ..Object::default() });
        assert_eq!(idle("objects[1].material.roughness", &scene), None, "its own model");
        // Choices of a model decide about its other parameters.
        scene.objects[0].reflection_model = Some("microfacet".to_owned());
        let said = idle("objects[0].material.gamma", &scene).expect("GGX has none");
        assert_eq!((&*said.why, said.users.len()), ("Not used with GGX: only GTR has γ", 0));
        scene.objects[0].object_type = "torus".to_owned();
        let registry = Registry::builtin();
        let torus = Place::find("objects[0].tube_radius", &scene, &registry).expect("it has one");
        assert_eq!(torus.idle(&scene, &registry), None);
        let said = torus.idle(&Scene::default(), &registry).expect("it has none");
        assert!(said.why.starts_with("a sphere has no ") && said.users == ["torus"], "{said:?}");
    }

    /// A scene under a sky with the sun at this elevation and azimuth.
    fn under_sky(kind: u32, sun: f32) -> Scene {
        let registry = Registry::builtin();
        let mut light = Light::default();
        let entry = registry.light("environment").expect("built in");
        light.set_type(entry, &registry, Scene::default().scene_size);
        light.parameters.set("source", Value::Choice("sky".into()));
        light.parameters.set("sky_type", Value::Choice(kind.to_string().into()));
        for name in ["sun_elevation", "sun_azimuth"] {
            light.parameters.set(name, Value::Number(sun));
        }
        Scene { lights: vec![light], ..Scene::default() }
    }

    #[test]
    fn the_place_of_the_sun_is_idle_in_skies_that_do_not_depend_on_it() {
        let registry = Registry::builtin();
        let sky = |kind: u32, sun: f32| {
            let scene = under_sky(kind, sun);
            let (_, sky, record) = emitter(&scene.lights[0], &registry, Encoding::Srgb).expect("built in");
            [Vec3::new(0.6, 0.64, 0.48), Vec3::new(-0.8, 0.36, 0.48), Vec3::Y]
                .map(|l| sky.seen(&record, Vec3::ZERO, l).radiance)
        };
        for kind in 1..=15 {
            let depends = sky(kind, 20.0) != sky(kind, 60.0);
            for path in ["lights[0].sun_elevation", "lights[0].sun_azimuth"] {
                let said = idle(path, &under_sky(kind, 20.0));
                assert_eq!(said.is_none(), depends, "type {kind}: {said:?}");
            }
        }
        let said = idle("lights[0].sun_azimuth", &under_sky(5, 20.0)).expect("it is uniform");
        assert_eq!(said.why, "Not used while the type of sky is 5 uniform");
        let mut studio = under_sky(12, 20.0);
        studio.lights[0].parameters.set("source", Value::Choice("studio".into()));
        let said = idle("lights[0].sun_azimuth", &studio).expect("no sky");
        assert_eq!(said.why, "Not used while the source is studio");
        // Unlike another source, another type of sky leaves the intensity as it is.
        let entry = registry.light("environment").expect("built in");
        let changed = |name: &str, id: &'static str| {
            let parameter = entry.parameters.iter().find(|p| p.name == name).expect("declared");
            under_sky(12, 20.0).lights[0].setting(entry, parameter, Value::Choice(id.into())).len()
        };
        assert_eq!([changed("sky_type", "1"), changed("source", "studio")], [1, 2]);
    }

    #[test]
    fn a_parameter_of_another_type_is_named_with_its_types_and_set_only_there() {
        let registry = Registry::builtin();
        let said = Place::find("objects[0].tube_radius", &Scene::default(), &registry).expect_err("a sphere");
        let expected =
            "there is no objects[0].tube_radius; objects[0] is a sphere, and only torus has such a parameter";
        assert_eq!(said, expected);
        let mut scene = Scene::default();
        scene.objects[0].object_type = "torus".to_owned();
        let find = |path: &str| Place::find(path, &scene, &registry).expect(path);
        let (kind, radius) = (find("objects[0].type"), find("objects[0].tube_radius"));
        let (sphere, number) = (Value::from("sphere"), Value::Number(0.1));
        let both = scene.with([(&kind, &sphere), (&radius, &number)], &registry).expect("a sphere");
        assert_eq!(both.objects[0], Object::default());
    }
}
