//! The shaders of a page: every reflection model of the scene under every shading model, in WGSL and in GLSL.

use naga::{AddressSpace, ShaderStage, back::glsl::Version};
use serde_json::{Value as Json, json};

use super::{blocks::Blocks, limits, texts::Texts};
use crate::{
    export::{
        ExportError,
        lit::{Drawn, Lit, Program},
        manifest::uniforms,
        shader::module,
        translate::{ENTRY_POINTS, Glsl, glsl},
    },
    optics::sharp,
    shading::Stage,
    text::template::{chosen, filled},
};

/// WebGL 2.
const WEBGL: Version = Version::Embedded { version: 300, is_webgl: true };
/// Appended to shaders that read a curve: it recalculates the curve when a parameter changes.
const ALBEDO: &str = include_str!("albedo.wgsl");
/// Entry points of [`ALBEDO`].
const ALBEDO_ENTRY_POINTS: [(&str, ShaderStage); 2] =
    [("albedo_vertex", ShaderStage::Vertex), ("albedo_fragment", ShaderStage::Fragment)];
/// Uniforms that differ between objects, written by the page. The others are shared by all.
const OF_OBJECTS: [&str; 7] =
    ["parameters", "albedo_curve", "material_lobes", "interior", "shading_values", "view", "placement"];

/// A shader and its uniforms.
///
/// # Errors
/// Returns an error if the shader cannot be translated.
pub fn program(
    lit: &Lit,
    drawn: &Drawn,
    texts: &mut Texts,
    blocks: &mut Blocks,
) -> Result<Json, ExportError> {
    let program = &lit.programs[lit.materials[drawn.material].program];
    let text = &program.shader.text;
    let (checked, info) = module(text)?;
    let mut all = Vec::new();
    let given = uniforms(&checked, lit, drawn, 1.0);
    for (binding, name, bytes) in &given {
        let own = OF_OBJECTS.contains(&name.as_str());
        all.push(json!({
            "binding": binding,
            "name": name,
            "size": bytes.len(),
            "block": (!own).then(|| blocks.add(bytes)),
        }));
    }
    limits::uniforms(given.iter().map(|(_, name, bytes)| (name.as_str(), bytes.len())))?;
    let mut stages = Vec::new();
    for entry in ENTRY_POINTS {
        stages.push(stage(&glsl(&checked, &info, WEBGL, entry)?, texts));
    }
    let rows = checked.global_variables.iter().find(|(_, g)| g.name.as_deref() == Some("solid_rows"));
    Ok(json!({
        "faces": program.faces(),
        "faceted": program.shading.declaration.faceted,
        // The texture with the hierarchy of the object's mesh, for solid bodies.
        "body": rows.and_then(|(_, global)| Some(global.binding?.binding)),
        // Lit at the corners of triangles, not at pixels.
        "corners": program.shading.declaration.stage != Stage::Pixel,
        "wgsl": texts.add(text),
        "glsl": stages,
        "uniforms": all,
        "albedo": albedo(program, texts)?,
    }))
}

/// The shader that calculates the curve of a model; null for models without one.
fn albedo(program: &Program, texts: &mut Texts) -> Result<Json, ExportError> {
    if !program.shader.reads_curve {
        return Ok(Json::Null);
    }
    let passage = program.passage;
    let wanted = |part: &str| if part == "sharp" { passage.sharp } else { passage.transmits };
    let integral = filled(&chosen(ALBEDO, wanted), &[("most", &sharp::MOST)]);
    let text = [&program.shader.text, &program.shader.beside, &*integral].concat();
    let (checked, info) = module(&text)?;
    let mut stages = Vec::new();
    for entry in ALBEDO_ENTRY_POINTS {
        stages.push(stage(&glsl(&checked, &info, WEBGL, entry)?, texts));
    }
    let fragment = checked.entry_points.iter().position(|e| e.name == ALBEDO_ENTRY_POINTS[1].0);
    let read = |name: &str| {
        let global = checked.global_variables.iter().find(|(_, global)| global.name.as_deref() == Some(name));
        let uses = fragment.map(|i| info.get_entry_point(i));
        global.zip(uses).is_some_and(|((handle, _), uses)| !uses[handle].is_empty())
    };
    let names = checked.global_variables.iter().filter(|(_, g)| g.space == AddressSpace::Uniform);
    let uniforms: Vec<_> = names
        .filter_map(|(_, global)| Some((global.binding?.binding, global.name.as_deref()?)))
        .filter(|(_, name)| read(name))
        .map(|(binding, name)| json!({ "binding": binding, "name": name }))
        .collect();
    Ok(json!({ "wgsl": texts.add(&text), "glsl": stages, "uniforms": uniforms }))
}

fn stage(glsl: &Glsl, texts: &mut Texts) -> Json {
    let blocks: Vec<_> = glsl.blocks.iter().map(|(binding, name)| json!([binding, name])).collect();
    json!({ "text": texts.add(&glsl.text), "blocks": blocks })
}
