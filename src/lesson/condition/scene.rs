//! Values of a scene by path, as in a scene file with every default written out.

use serde_json::{Map, Value as Json, json};

use super::Value;
use crate::{
    parameter::{Parameter, Values, json as of},
    registry::Registry,
    scene::{
        Light, Object, Part, Scene, Variant,
        error::{Path, Segment},
        field::Kind,
        part::Fields,
    },
    text::{did_you_mean, plural, quoted},
};

/// The word for the number of entries of a list.
const COUNT: &str = "count";

/// The value at a path, for comparisons, or the reason why it has none.
pub(super) fn value(scene: &Scene, path: &Path, registry: &Registry) -> Result<Value, String> {
    match json_at(scene, path, registry)? {
        // Scenes have 32-bit numbers: 0.1 should be 0.1, not its nearest neighbour.
        Json::Number(number) => {
            let value = number.as_f64().unwrap_or(f64::NAN);
            Ok(Value::Number(if number.is_f64() {
                (value as f32).to_string().parse().unwrap_or(value)
            } else {
                value
            }))
        }
        Json::String(text) => Ok(Value::Text(text)),
        Json::Bool(truth) => Ok(Value::Truth(truth)),
        Json::Null => Err(format!("{path} is not given")),
        Json::Array(_) => Err(format!("{path} is a list; compare an entry, as in {path}[0]")),
        Json::Object(_) => Err(format!("{path} is not a single value; continue with one of its keys")),
    }
}

/// The value at a path; null for an optional value that the scene does not have.
pub(super) fn json_at(scene: &Scene, path: &Path, registry: &Registry) -> Result<Json, String> {
    let segments = path.segments();
    let [Segment::Key(first), rest @ ..] = segments else {
        return Err("a path begins with a key".to_owned());
    };
    let list = |count: usize, part: &dyn Fn(usize) -> Json| match rest {
        [] => {
            Err(format!("{first} is a list; continue with [0], or with .count for the number of its entries"))
        }
        [Segment::Key(key)] if key == COUNT => Ok(json!(count)),
        [Segment::Index(i), rest @ ..] if *i < count => walk(part(*i), &format!("{first}[{i}]"), rest),
        [Segment::Index(i), ..] => Err(format!(
            "there is no {first}[{i}]: the scene has {}, counted from 0; {first}.count is their number",
            plural(count, first.trim_end_matches('s'))
        )),
        [Segment::Key(key), ..] => {
            Err(format!("{first} is a list, so it has no {}; continue with [0] or .count", quoted(key)))
        }
    };
    match first.as_ref() {
        "objects" => list(scene.objects.len(), &|i| object(scene, &scene.objects[i], registry)),
        "lights" => list(scene.lights.len(), &|i| light(&scene.lights[i], registry)),
        "variants" => list(scene.variants.len(), &|i| variant(&scene.variants[i], registry)),
        _ => walk(rest_of(scene), "", segments),
    }
}

/// Follows a path within a value.
fn walk(mut json: Json, from: &str, path: &[Segment]) -> Result<Json, String> {
    let mut at = from.to_owned();
    for step in path {
        let place = if at.is_empty() { "a scene".to_owned() } else { at.clone() };
        json = match (step, json) {
            (Segment::Key(key), Json::Object(mut map)) => {
                let Some(value) = map.remove(key.as_ref()) else {
                    let near = did_you_mean(key, map.keys().map(|k| (k.as_str(), k.as_str())));
                    return Err(format!("{place} has no {}{near}", quoted(key)));
                };
                value
            }
            (Segment::Index(i), Json::Array(mut list)) if *i < list.len() => list.swap_remove(*i),
            (Segment::Index(i), Json::Array(list)) => {
                let count = list.len();
                return Err(format!("there is no {at}[{i}]: the list has {count} entries, counted from 0"));
            }
            (Segment::Key(key), Json::Array(_)) => {
                return Err(format!("{place} is a list, so it has no {}; continue with [0]", quoted(key)));
            }
            (_, Json::Null) => return Ok(Json::Null),
            _ => return Err(format!("{place} is a single value; the path ends there")),
        };
        at = match step {
            Segment::Key(key) if at.is_empty() => key.to_string(),
            Segment::Key(key) => format!("{at}.{key}"),
            Segment::Index(i) => format!("{at}[{i}]"),
        };
    }
    Ok(json)
}

/// Writes the values of all parameters, given or default.
fn fill<'p>(
    map: &mut Map<String, Json>,
    values: &Values,
    parameters: impl IntoIterator<Item = &'p Parameter>,
) {
    for parameter in parameters {
        map.insert(parameter.name.to_owned(), of(&values.get(parameter)));
    }
}

/// The fields of a part, given or default; null for one that it does not have, unless its type has none.
fn map_of(part: &dyn Fields) -> Map<String, Json> {
    let mut map = Map::new();
    part.each(&mut |field, held, _| {
        let written = match (field.kind, held.value()) {
            // Their entries are asked for by themselves.
            (Kind::Parts, _) => json!([]),
            (Kind::Part | Kind::Material | Kind::Parameters | Kind::List, _) => return,
            (_, None) if field.by_type => return,
            (_, value) => value.map_or(Json::Null, |value| of(&value)),
        };
        map.insert(field.key.to_owned(), written);
    });
    map
}

fn object(scene: &Scene, object: &Object, registry: &Registry) -> Json {
    let mut map = map_of(object);
    map.insert("reflection_model".to_owned(), json!(scene.model_of(object)));
    map.insert("shading_model".to_owned(), json!(scene.shading_model_of(object)));
    if let Some(shape) = registry.shape(&object.object_type) {
        map.insert("tessellation".to_owned(), json!(shape.tessellation(object.tessellation)));
        fill(&mut map, &object.shape, shape.parameters);
    }
    let mut material = Map::new();
    fill(&mut material, &object.material, registry.material_parameters());
    map.insert("material".to_owned(), Json::Object(material));
    Json::Object(map)
}

fn light(light: &Light, registry: &Registry) -> Json {
    let mut map = map_of(light);
    map.insert("colour".to_owned(), json!(light.rgb8()));
    if let Some(entry) = registry.light(&light.light_type) {
        fill(&mut map, &light.parameters, entry.parameters);
        map.insert("intensity".to_owned(), json!(light.intensity_as(entry)));
    }
    Json::Object(map)
}

/// The scene without its lists.
fn rest_of(scene: &Scene) -> Json {
    let mut map = map_of(scene);
    for part in [Part::Size, Part::Observer, Part::Display, Part::Comparison] {
        if let (Some(Segment::Key(key)), Some(fields)) = (part.path().segments().first(), scene.part(part)) {
            map.insert(key.to_string(), Json::Object(map_of(fields)));
        }
    }
    Json::Object(map)
}

/// The overrides of a variant. A missing value is inherited: null, not the default.
fn variant(variant: &Variant, registry: &Registry) -> Json {
    let mut map = map_of(variant);
    let value = |p: &Parameter| variant.material.0.get(p.name).map_or(Json::Null, of);
    let material = registry.material_parameters().map(|p| (p.name.to_owned(), value(p)));
    map.insert("material".to_owned(), Json::Object(material.collect()));
    Json::Object(map)
}
