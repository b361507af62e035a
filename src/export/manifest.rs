//! The information that a program needs to draw with exported shaders: entry points, vertices, bindings with
//! the offsets of every field, and their values in the scene.

use glam::Mat4;
use naga::{AddressSpace, ArraySize, Module, ScalarKind, TypeInner};
use serde_json::{Map, Value as Json, json};

use super::{
    lights::LightRow,
    lit::{Drawn, Lit},
    translate::ENTRY_POINTS,
};
use crate::{optics::colour::Encoding, scene::observer::clip_from_room, shader::check::struct_layout};

/// The uniforms of a module: binding, name, and their bytes for one object of a scene.
#[must_use]
pub fn uniforms(module: &Module, lit: &Lit, drawn: &Drawn, aspect: f32) -> Vec<(u32, String, Vec<u8>)> {
    let material = &lit.materials[drawn.material];
    let mut all = Vec::new();
    for (_, global) in module.global_variables.iter().filter(|(_, g)| g.space == AddressSpace::Uniform) {
        let (Some(binding), Some(name)) = (&global.binding, &global.name) else { continue };
        let mut bytes = match name.as_str() {
            "parameters" => material.parameters.clone(),
            "albedo_curve" => material.curve.clone(),
            "material_lobes" => material.lobes.clone(),
            "interior" => material.interior.clone(),
            "shading_values" => material.shading.clone(),
            "illumination" => lights(module, lit),
            "lamp_numbers" => lit.lights.numbers.iter().flat_map(|n| n.to_le_bytes()).collect(),
            "view" => view(lit, aspect),
            "placement" => matrix(drawn.room_from_object(&lit.request)),
            _ => Vec::new(),
        };
        let size = module.types[global.ty].inner.size(module.to_ctx()) as usize;
        bytes.resize(size.next_multiple_of(16), 0);
        all.push((binding.binding, name.clone(), bytes));
    }
    all.sort();
    all
}

fn matrix(matrix: Mat4) -> Vec<u8> {
    matrix.to_cols_array().into_iter().flat_map(f32::to_le_bytes).collect()
}

/// The bytes of `View`.
fn view(lit: &Lit, aspect: f32) -> Vec<u8> {
    let observer = &lit.request.scene.observer;
    let mut bytes = matrix(clip_from_room(observer, aspect));
    bytes.extend(observer.position.extend(lit.exposure()).to_array().into_iter().flat_map(f32::to_le_bytes));
    bytes
}

/// The bytes of `Illumination`.
fn lights(module: &Module, lit: &Lit) -> Vec<u8> {
    let (Some((fields, size)), Some((record, stride))) =
        (struct_layout(module, "Illumination"), struct_layout(module, "Light"))
    else {
        return Vec::new();
    };
    let mut bytes = vec![0; size];
    let mut put = |at: usize, words: &[u32]| {
        for (i, word) in words.iter().enumerate() {
            bytes[at + 4 * i..at + 4 * i + 4].copy_from_slice(&word.to_le_bytes());
        }
    };
    let fields_of_light = lit.lights.fields();
    for (name, at) in fields {
        match name.as_str() {
            "count" => put(at, &[lit.lights.rows.len() as u32]),
            "exposure" => put(at, &[lit.exposure().to_bits()]),
            "lights" => {
                for (i, row) in lit.lights.rows.iter().enumerate() {
                    let base = at + i * stride;
                    for (name, offset) in &record {
                        put(base + offset, &words(row, &fields_of_light, name));
                    }
                }
            }
            _ => {}
        }
    }
    bytes
}

fn words(row: &LightRow, fields: &[super::lights::LightField], name: &str) -> Vec<u32> {
    fields.iter().find(|field| field.name == name).map(|field| row.words(field)).unwrap_or_default()
}

/// The background: its code, or those of both edges of a gradient.
fn background(lit: &Lit) -> Json {
    match lit.gradient() {
        Some([top, bottom]) => json!({ "top": top, "bottom": bottom }),
        None => json!(Encoding::Srgb.encode(lit.background())),
    }
}

/// The manifest of a shader.
#[must_use]
pub fn manifest(module: &Module, lit: &Lit, drawn: &Drawn, files: Map<String, Json>) -> Json {
    let (width, height) = lit.request.size;
    let aspect = width as f32 / height as f32;
    let object = &lit.request.scene.objects[drawn.index];
    let program = &lit.programs[lit.materials[drawn.material].program];
    let mesh = &lit.meshes[drawn.mesh];
    let stride = 12 * mesh.attributes.len();
    let attributes: Vec<_> = mesh
        .attributes
        .iter()
        .enumerate()
        .map(|(i, a)| json!({ "location": i, "name": a.name, "format": "float32x3", "offset": 12 * i }))
        .collect();
    let bindings: Vec<_> = uniforms(module, lit, drawn, aspect)
        .into_iter()
        .map(|(binding, name, bytes)| {
            let global = module.global_variables.iter().find(|(_, g)| g.name.as_deref() == Some(&name));
            let mut fields = Vec::new();
            if let Some((_, global)) = global {
                describe(module, global.ty, "", 0, &bytes, &mut fields);
            }
            json!({ "group": 0, "binding": binding, "name": name, "kind": "uniform", "size": bytes.len(), "fields": fields })
        })
        .collect();
    json!({
        "scene": lit.request.scene.name,
        "description": lit.request.scene.description,
        "object": object.name.clone().unwrap_or_else(|| object.object_type.clone()),
        "reflection_model": program.model.declaration.id,
        "shading_model": program.shading.declaration.id,
        "files": files,
        "entry_points": ENTRY_POINTS.map(|(name, stage)| json!({ "stage": format!("{stage:?}").to_lowercase(), "name": name })),
        "vertices": { "count": mesh.vertices(), "stride": stride, "attributes": attributes },
        "indices": { "count": mesh.indices.len(), "format": "uint32", "topology": "triangle-list", "front_face": "ccw" },
        "depth": { "clear": 0.0, "compare": "greater", "range": "1 near, 0 infinitely far" },
        "colour": "the fragment's colour is encoded for the display: write it to a target that does not encode again",
        "size": [width, height],
        "background": background(lit),
        "bindings": bindings,
    })
}

/// The fields of a value with their byte offsets and numbers.
fn describe(
    module: &Module,
    ty: naga::Handle<naga::Type>,
    name: &str,
    at: usize,
    bytes: &[u8],
    to: &mut Vec<Json>,
) {
    let join = |field: &str| if name.is_empty() { field.to_owned() } else { format!("{name}.{field}") };
    let mut leaf = |kind: String, count: usize, stride: usize, scalar: ScalarKind| {
        let numbers: Vec<_> =
            (0..count).map(|i| number(bytes, at + stride * (i / 4) + 4 * (i % 4), scalar)).collect();
        let value = if count == 1 { numbers[0].clone() } else { Json::from(numbers) };
        to.push(json!({ "name": name, "type": kind, "offset": at, "value": value }));
    };
    match &module.types[ty].inner {
        TypeInner::Scalar(s) => leaf(scalar(s.kind).to_owned(), 1, 0, s.kind),
        TypeInner::Vector { size, scalar: s } => {
            let count = *size as usize;
            leaf(format!("vec{count}<{}>", scalar(s.kind)), count, 0, s.kind);
        }
        TypeInner::Matrix { columns, rows, scalar: s } => {
            let kind = format!("mat{}x{}<{}>", *columns as usize, *rows as usize, scalar(s.kind));
            leaf(kind, 4 * *columns as usize, 16, s.kind);
        }
        TypeInner::Array { base, size: ArraySize::Constant(count), stride } => {
            for i in 0..count.get() {
                let element = format!("{name}[{i}]");
                describe(module, *base, &element, at + (i * stride) as usize, bytes, to);
            }
        }
        TypeInner::Struct { members, .. } => {
            for member in members {
                let field = join(member.name.as_deref().unwrap_or_default());
                describe(module, member.ty, &field, at + member.offset as usize, bytes, to);
            }
        }
        _ => {}
    }
}

fn scalar(kind: ScalarKind) -> &'static str {
    match kind {
        ScalarKind::Uint => "u32",
        ScalarKind::Sint => "i32",
        _ => "f32",
    }
}

fn number(bytes: &[u8], at: usize, kind: ScalarKind) -> Json {
    let word = bytes.get(at..at + 4).and_then(|b| b.try_into().ok()).map_or(0, u32::from_le_bytes);
    match kind {
        ScalarKind::Uint | ScalarKind::Sint => Json::from(word),
        // The shortest digits that represent these bits exactly.
        _ => format!("{:?}", f32::from_bits(word)).parse::<f64>().map_or(Json::Null, Json::from),
    }
}
