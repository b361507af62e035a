//! The JSON Schema of scene files, for editors: the declared fields plus the contents of the registry.

use super::{
    Comparison, Display, Field, Light, MAX_DIMENSION, MAX_OBJECTS, Object, Observer, Repeat, Scene,
    SceneSize, Variant, Varied,
    field::{Absent, Kind},
    part::Structure,
    repeat::MAX_VARIED,
    variant::MAX_VARIANTS,
};
use crate::{
    light::MAX_LIGHTS,
    parameter::{
        Parameter, Value, json as value,
        kind::{Kind as _, choice, colour::Colour, number::Number},
    },
    reflection::ModelEntry,
    registry::Registry,
    shading::ShadingEntry,
    text::number,
};
use serde_json::{Map, Value as Json, json};

/// File name of the schema next to the shipped scenes, as in their `$schema`.
pub const FILE_NAME: &str = "scene.schema.json";
/// The end of the names of schemas.
pub(super) const EXTENSION: &str = ".schema.json";

/// The JSON Schema (draft 2020-12) of scene files.
///
/// A schema can express less than [`check`](super::check): neither positions within the size of the room nor coincident
/// parts.
#[must_use]
pub fn schema(registry: &Registry) -> Json {
    let mut schema = part::<Scene>(Scene::ABOUT, registry);
    schema["$schema"] = "https://json-schema.org/draft/2020-12/schema".into();
    schema["title"] = "Scene of Lights, Camera, Models!".into();
    let scene = &mut schema["properties"];
    scene["$schema"] = json!({
        "type": "string",
        "description": "Address of the JSON Schema of scene files, with which editors complete and check this file.",
    });
    scene["scene_size"] = part::<SceneSize>(Scene::scene_size.help, registry);
    scene["observer"] = part::<Observer>(Scene::observer.help, registry);
    scene["display"] = part::<Display>(Scene::display.help, registry);
    scene["comparison"] = part::<Comparison>(Scene::comparison.help, registry);
    scene["lights"]["items"] = part::<Light>(Light::ABOUT, registry);
    scene["objects"]["items"] = part::<Object>(Object::ABOUT, registry);
    scene["objects"]["items"]["properties"][Object::repeat.key] = repeat(registry);
    scene["variants"]["items"] = part::<Variant>(Variant::ABOUT, registry);
    scene["variants"]["maxItems"] = MAX_VARIANTS.into();
    lights(&mut scene["lights"], registry);
    objects(&mut scene["objects"], registry);
    let material = scene["objects"]["items"]["properties"]["material"]["properties"].clone();
    let variants = &mut scene["variants"]["items"]["properties"]["material"];
    (variants["properties"], variants["additionalProperties"]) = (material, false.into());
    schema
}

/// A part, with its documentation.
fn part<P: Structure>(help: &str, registry: &Registry) -> Json {
    let (mut properties, mut required) = (Map::new(), Vec::new());
    P::default().each(&mut |declared, _, default| {
        if !matches!(declared.kind, Kind::Parameters) {
            properties.insert(declared.key.to_owned(), field(declared, default.value(), registry));
        }
        if declared.absent != Absent::Allowed {
            required.push(declared.key);
        }
    });
    let mut part = json!({
        "type": "object", "description": help.trim(), "properties": properties, "additionalProperties": false,
    });
    if !required.is_empty() {
        part["required"] = required.into();
    }
    part
}

/// A row or a grid.
fn repeat(registry: &Registry) -> Json {
    let mut row = part::<Repeat>(Object::repeat.help, registry);
    let fields = &mut row["properties"];
    for count in [Repeat::columns, Repeat::rows] {
        fields[count.key]["maximum"] = MAX_OBJECTS.into();
    }
    fields[Repeat::vary.key]["items"] = part::<Varied>(Varied::ABOUT, registry);
    fields[Repeat::vary.key]["maxItems"] = MAX_VARIED.into();
    row
}

/// A field, with its default if it is the same for all types.
fn field(field: &Field, default: Option<Value>, registry: &Registry) -> Json {
    let vector = |one: Json| json!({ "type": "array", "items": one, "minItems": 3, "maxItems": 3 });
    let mut schema = match field.kind {
        Kind::Number { min, max, .. } => Number { min, max, slider_max: max, default: min }.schema(),
        Kind::Count(min) => json!({ "type": "integer", "minimum": min }),
        Kind::Flag(_) => json!({ "type": "boolean" }),
        Kind::Text(_) => json!({ "type": "string" }),
        Kind::Position => {
            vector(json!({ "type": "number", "exclusiveMinimum": 0, "maximum": number(MAX_DIMENSION) }))
        }
        Kind::Direction | Kind::Step | Kind::Rotation => vector(json!({ "type": "number" })),
        Kind::Colour => Colour { default: [0; 3] }.schema(),
        Kind::Id(ids) => {
            choice::one_of(ids.all(registry).map(|listed| [listed.id, listed.name, listed.summary]))
        }
        Kind::Choice(words) => choice::one_of(words().into_iter()),
        Kind::Parts | Kind::List => json!({ "type": "array" }),
        Kind::Material | Kind::Parameters | Kind::Part => json!({ "type": "object" }),
    };
    schema["description"] = field.help.trim().into();
    let is_free = field.by_type || matches!(field.kind, Kind::Text(_));
    if let Some(default) = default.filter(|_| !is_free && !matches!(field.absent, Absent::Error(_))) {
        schema["default"] = value(&default);
    }
    schema
}

/// The schema as shipped and printed, with a final line break.
#[must_use]
pub fn text(registry: &Registry) -> String {
    format!("{:#}\n", schema(registry))
}

/// The lights: one variant per type, distinguished by `type`.
fn lights(list: &mut Json, registry: &Registry) {
    list["minItems"] = 1.into();
    list["maxItems"] = MAX_LIGHTS.into();
    let light = &mut list["items"];
    let fields = &mut light["properties"];
    let parameters = || registry.lights().iter().flat_map(|l| l.parameters);
    // Types may declare the same name with other ranges.
    let shared = |p: &Parameter| parameters().any(|other| other.name == p.name && other != p);
    for p in parameters() {
        // Each type adds details to shared fields.
        fields[p.name] = if shared(p) { json!({ "description": p.help }) } else { parameter(p) };
    }
    let types = registry.lights().iter().map(|l| {
        let (d, has_flux) = (l.declaration, l.has_flux());
        let mut required = Vec::new();
        let mut properties = Map::new();
        for (field, has) in [("position", d.has_position), ("direction", d.has_direction)] {
            if has {
                required.push(field);
            } else {
                properties.insert(field.to_owned(), false.into());
            }
        }
        for p in parameters() {
            match l.parameter(p.name) {
                None => _ = properties.insert(p.name.to_owned(), false.into()),
                Some(own) if shared(own) => _ = properties.insert(p.name.to_owned(), parameter(own)),
                Some(_) => {}
            }
        }
        if !has_flux {
            properties.insert("luminous_flux".to_owned(), false.into());
        }
        let intensity = json!({
            "description": format!("Intensity, {}.", unit(d.unit)),
            "default": number(d.default_intensity),
        });
        properties.insert("intensity".to_owned(), intensity);
        json!({
            "if": { "properties": { "type": { "const": d.id } }, "required": ["type"] },
            "then": { "required": required, "properties": properties },
        })
    });
    let alternatives = Light::FIELDS
        .iter()
        .rev()
        .filter_map(|field| Some(json!({ "not": { "required": [field.key, field.instead?] } })));
    light["allOf"] = types.chain(alternatives).collect::<Vec<_>>().into();
    list["items"]["defaultSnippets"] = json!([{
        "label": "point light",
        "body": { "type": "point", "position": [5, 9, 5], "colour": [255, 255, 255], "intensity": 20 },
    }]);
}

/// The objects.
fn objects(list: &mut Json, registry: &Registry) {
    list["minItems"] = 1.into();
    list["maxItems"] = MAX_OBJECTS.into();
    let object = &mut list["items"];
    let of_types = || registry.shapes().iter().flat_map(|s| s.parameters);
    let fields = &mut object["properties"];
    for p in of_types() {
        let (known, field) = (&mut fields[p.name], parameter(p));
        match known {
            Json::Null => *known = field,
            same if *same == field => {}
            // Each type adds details.
            other => *other = json!({ "description": p.help }),
        }
    }
    let mut parameters = Map::new();
    for p in registry.material_parameters() {
        let mut field = parameter(p);
        let user = |m: &ModelEntry| {
            let name = m.declaration.name;
            Some(match m.parameter(p.name)?.used_when {
                Some(u) => format!("{name} (with {} {})", u.parameter, u.choices.join(", ")),
                None => name.to_owned(),
            })
        };
        let shading =
            |s: &ShadingEntry| s.parameter(p.name).map(|_| format!("{} shading", s.declaration.name));
        let shadings = registry.shading_models().iter().filter_map(shading);
        let names: Vec<_> = registry.models().iter().filter_map(user).chain(shadings).collect();
        let ranges = ranges(p, registry, &mut field);
        let defaults = defaults(p, registry, &mut field);
        let (title, help) = words(p, registry);
        field["title"] = title.into();
        let help = format!("{help} Used by: {}.{ranges}{defaults}", names.join(", "));
        field["description"] = help.into();
        parameters.insert(p.name.to_owned(), field);
    }
    fields["material"]["properties"] = parameters.into();
    fields["material"]["additionalProperties"] = false.into();
    let types = registry.shapes().iter().map(|s| {
        let d = s.declaration;
        let tessellation = json!({
            "minimum": d.tessellation.start(),
            "maximum": d.tessellation.end(),
            "default": d.default_tessellation,
            "description": d.tessellation_help,
        });
        let mut properties = Map::from_iter([("tessellation".to_owned(), tessellation)]);
        for p in of_types() {
            let own = s.parameters.iter().find(|own| own.name == p.name);
            properties.insert(p.name.to_owned(), own.map_or(false.into(), parameter));
        }
        json!({
            "if": { "properties": { "type": { "const": d.id } }, "required": ["type"] },
            "then": { "properties": properties },
        })
    });
    let differ = |p: &&Parameter| users_of(p, registry).any(|(_, other)| other.rule() != p.rule());
    let models = registry.models().iter().filter_map(|m| {
        let own: Map<_, _> =
            m.parameters.iter().filter(differ).map(|p| (p.name.to_owned(), parameter(p))).collect();
        let id = m.declaration.id;
        (!own.is_empty()).then(|| {
            json!({
                "if": { "properties": { "reflection_model": { "const": id } }, "required": ["reflection_model"] },
                "then": { "properties": { "material": { "properties": own } } },
            })
        })
    });
    object["allOf"] = types.chain(models).collect::<Vec<_>>().into();
    object["defaultSnippets"] = json!([{
        "label": "sphere",
        "body": { "type": "sphere", "position": [5, 5, 5], "size": 2, "material": { "base_colour": [255, 255, 255] } },
    }]);
}

/// The declarations of a parameter of materials, with the models that share it.
fn users_of<'a>(
    p: &Parameter,
    registry: &'a Registry,
) -> impl Iterator<Item = (&'static str, &'static Parameter)> + 'a {
    let name = p.name;
    registry.material_users().filter_map(move |(id, all)| Some((id, all.iter().find(|q| q.name == name)?)))
}

/// Values by the models that have them, in words, if there are several.
fn differing(all: Vec<(String, Vec<&str>)>) -> Option<String> {
    let each: Vec<_> = all.iter().map(|(value, users)| format!("{value} in {}", users.join(", "))).collect();
    (each.len() > 1).then(|| each.join("; "))
}

/// The ids of each value.
fn by_value(all: impl Iterator<Item = (&'static str, String)>) -> Vec<(String, Vec<&'static str>)> {
    let mut found: Vec<(String, Vec<_>)> = Vec::new();
    for (id, value) in all {
        match found.iter_mut().find(|(known, _)| *known == value) {
            Some((_, users)) => users.push(id),
            None => found.push((value, vec![id])),
        }
    }
    found
}

/// The title and the help of a parameter, of each model if they differ.
fn words(p: &Parameter, registry: &Registry) -> (String, String) {
    let titles = by_value(users_of(p, registry).map(|(id, own)| (id, title(own))));
    let helps = by_value(users_of(p, registry).map(|(id, own)| (id, own.help.to_owned())));
    let each: Vec<_> = helps.iter().map(|(help, users)| format!("{}: {help}", users.join(", "))).collect();
    let help = if each.len() > 1 { each.join(" ") } else { p.help.to_owned() };
    (differing(titles).unwrap_or_else(|| title(p)), help)
}

/// The ranges of a parameter in words if they differ between models; all of them are then in its field.
/// `check` knows the model of an object, and applies its range.
fn ranges(p: &Parameter, registry: &Registry, field: &mut Json) -> String {
    let all = by_value(users_of(p, registry).map(|(id, own)| (id, own.rule())));
    let firsts: Vec<_> = all.iter().filter_map(|(_, users)| users.first().copied()).collect();
    let Some(said) = differing(all) else { return String::new() };
    let alternatives = users_of(p, registry).filter(|(id, _)| firsts.contains(id)).map(|(_, own)| {
        let mut one = parameter(own);
        let words = ["title", "description", "default"];
        words.iter().for_each(|key| drop(one.as_object_mut().and_then(|map| map.remove(*key))));
        one
    });
    *field = json!({ "anyOf": alternatives.collect::<Vec<_>>(), "title": field["title"], "default": field["default"] });
    format!(" It is {said}.")
}

/// The defaults of a parameter in words if they differ between models; its field then has none.
fn defaults(p: &Parameter, registry: &Registry, field: &mut Json) -> String {
    let all = by_value(users_of(p, registry).map(|(id, own)| (id, own.default_value().to_string())));
    let Some(said) = differing(all) else { return String::new() };
    if let Some(map) = field.as_object_mut() {
        map.remove("default");
    }
    format!(" By default {said}.")
}

/// A unit of intensity, in words.
fn unit(unit: &str) -> &str {
    match unit {
        "cd" => "candela (cd)",
        "lx" => "lux (lx)",
        "cd/m²" => "candela per square metre (cd/m²)",
        "×" => "a factor: 1 is the light as it is",
        other => other,
    }
}

/// The label of a parameter, with its symbol and unit.
fn title(p: &Parameter) -> String {
    let unit = if p.unit.is_empty() { String::new() } else { format!(", {}", p.unit) };
    format!("{} ({}{unit})", p.label, p.symbol)
}

/// A declared parameter.
fn parameter(p: &Parameter) -> Json {
    let mut field = p.kind.schema();
    field["title"] = title(p).into();
    field["description"] = p.help.into();
    field["default"] = value(&p.default_value());
    field
}
