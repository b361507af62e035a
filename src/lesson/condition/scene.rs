//! Values of a scene by path, as in a scene file with every default written out.

use serde_json::{Map, Value as Json, json};

use super::Value;
use crate::{
    parameter::{Parameter, Values, json as of},
    registry::Registry,
    scene::{
        Light, Object, Scene, SceneIn,
        error::{Path, Segment},
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
        Json::Object(_) => Err(format!("{path} is no single value; go on with one of its keys")),
    }
}

/// The value at a path; null for an optional value that the scene does not have.
pub(super) fn json_at(scene: &Scene, path: &Path, registry: &Registry) -> Result<Json, String> {
    let segments = path.segments();
    let [Segment::Key(first), rest @ ..] = segments else {
        return Err("a path begins with a key".to_owned());
    };
    let list = |count: usize, part: &dyn Fn(usize) -> Json| match rest {
        [] => Err(format!("{first} is a list; go on with [0], or with .count for the number of its entries")),
        [Segment::Key(key)] if key == COUNT => Ok(json!(count)),
        [Segment::Index(i), rest @ ..] if *i < count => walk(part(*i), &format!("{first}[{i}]"), rest),
        [Segment::Index(i), ..] => Err(format!(
            "there is no {first}[{i}]: the scene has {}, counted from 0; {first}.count is their number",
            plural(count, first.trim_end_matches('s'))
        )),
        [Segment::Key(key), ..] => {
            Err(format!("{first} is a list, and has no {}; go on with [0] or .count", quoted(key)))
        }
    };
    match first.as_ref() {
        "objects" => list(scene.objects.len(), &|i| object(scene, &scene.objects[i], registry)),
        "lights" => list(scene.lights.len(), &|i| light(&scene.lights[i], registry)),
        "variants" => list(scene.variants.len(), &|i| variant(scene, i, registry)),
        _ => walk(rest_of(scene, registry), "", segments),
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
                return Err(format!(
                    "there is no {at}[{i}]: the list has {} entries, counted from 0",
                    list.len()
                ));
            }
            (Segment::Key(key), Json::Array(_)) => {
                return Err(format!("{place} is a list, and has no {}; go on with [0]", quoted(key)));
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

/// Writes a value unless one exists.
fn default(map: &mut Map<String, Json>, key: &str, value: Json) {
    map.entry(key).or_insert(value);
}

fn map_of(value: &impl serde::Serialize) -> Map<String, Json> {
    match serde_json::to_value(value) {
        Ok(Json::Object(map)) => map,
        _ => Map::new(),
    }
}

fn object(scene: &Scene, object: &Object, registry: &Registry) -> Json {
    let mut map = map_of(object);
    default(&mut map, "name", Json::Null);
    map.insert("visible".to_owned(), json!(object.visible));
    map.insert("size".to_owned(), json!(object.size));
    map.insert("rotation".to_owned(), json!(object.rotation.to_array()));
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
    for key in ["name", "colour_temperature", "luminous_flux"] {
        default(&mut map, key, Json::Null);
    }
    map.insert("enabled".to_owned(), json!(light.enabled));
    map.insert("colour".to_owned(), json!(light.rgb8()));
    let intensity = registry.light(&light.light_type).map_or(light.intensity, |entry| {
        fill(&mut map, &light.parameters, entry.parameters);
        light.intensity_as(entry)
    });
    map.insert("intensity".to_owned(), json!(intensity));
    Json::Object(map)
}

/// The scene without its lights and objects.
fn rest_of(scene: &Scene, registry: &Registry) -> Json {
    let bare = Scene {
        name: scene.name.clone(),
        description: scene.description.clone(),
        reflection_model: scene.reflection_model.clone(),
        shading_model: scene.shading_model.clone(),
        lights: Vec::new(),
        objects: Vec::new(),
        variants: scene.variants.clone(),
        ..*scene
    };
    let mut map = map_of(&SceneIn(&bare, registry));
    for key in ["name", "description"] {
        default(&mut map, key, Json::Null);
    }
    let mut observer = map_of(&scene.observer);
    observer.insert("field_of_view".to_owned(), json!(scene.observer.field_of_view));
    map.insert("observer".to_owned(), Json::Object(observer));
    let display = &scene.display;
    map.insert(
        "display".to_owned(),
        json!({
            "tone_mapping": display.tone_mapping.id(),
            "exposure": display.exposure,
            "encoding": display.encoding.id(),
        }),
    );
    let comparison = &scene.comparison;
    let mut compared = match map.remove("comparison") {
        Some(Json::Object(map)) => map,
        _ => Map::new(),
    };
    default(&mut compared, "layout", json!(comparison.layout.id()));
    map.insert("comparison".to_owned(), Json::Object(compared));
    Json::Object(map)
}

fn variant(scene: &Scene, index: usize, registry: &Registry) -> Json {
    let mut all = match rest_of(scene, registry) {
        Json::Object(mut map) => map.remove("variants").unwrap_or_default(),
        _ => Json::Null,
    };
    let mut map = match all.get_mut(index).map(Json::take) {
        Some(Json::Object(map)) => map,
        _ => Map::new(),
    };
    for key in [
        "name",
        "based_on",
        "reflection_model",
        "shading_model",
        "terms",
        "tone_mapping",
        "exposure",
        "encoding",
        "tessellation",
    ] {
        default(&mut map, key, Json::Null);
    }
    // A value missing from a variant is inherited: null, not the default.
    let mut material = match map.remove("material") {
        Some(Json::Object(map)) => map,
        _ => Map::new(),
    };
    for parameter in registry.material_parameters() {
        default(&mut material, parameter.name, Json::Null);
    }
    map.insert("material".to_owned(), Json::Object(material));
    Json::Object(map)
}
