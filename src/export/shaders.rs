//! The forms `wgsl`, `glsl`, `hlsl`, `msl` and `spirv`: the shader of one object, with a manifest of its bindings, and
//! its vertices.

use naga::{Module, back::glsl::Version, valid::ModuleInfo};
use serde_json::{Map, Value as Json};

use super::{
    Export, ExportError, File, Form, Makes, Progress, Request,
    lit::Lit,
    manifest::manifest,
    shader::{Host, module},
    translate::{self, ENTRY_POINTS},
};
use crate::optics::tone::ToneMapping;

/// WGSL.
pub const WGSL: Form = form(
    "wgsl",
    "WGSL shader",
    "the shader of an object for WebGPU, alone, with a manifest of its bindings",
    |request, progress| {
        make(request, progress, |text, _, _| Ok(vec![("shader", "shader.wgsl", text.into())]))
    },
);
/// GLSL 4.50.
pub const GLSL: Form =
    form("glsl", "GLSL shaders", "the same as two shaders for OpenGL 4.5", |request, progress| {
        make(request, progress, |_, module, info| {
            let [vertex, fragment] =
                ENTRY_POINTS.map(|entry| translate::glsl(module, info, Version::Desktop(450), entry));
            Ok(vec![
                ("vertex_shader", "shader.vert", vertex?.text.into()),
                ("fragment_shader", "shader.frag", fragment?.text.into()),
            ])
        })
    });
/// HLSL of shader model 6.0.
pub const HLSL: Form = form("hlsl", "HLSL shader", "the same for Direct3D 12", |request, progress| {
    make(request, progress, |_, module, info| {
        Ok(vec![("shader", "shader.hlsl", translate::hlsl(module, info)?.into())])
    })
});
/// MSL 2.0.
pub const MSL: Form = form("msl", "Metal shader", "the same for Metal", |request, progress| {
    make(request, progress, |_, module, info| {
        Ok(vec![("shader", "shader.metal", translate::msl(module, info)?.into())])
    })
});
/// SPIR-V 1.3.
pub const SPIRV: Form = form("spirv", "SPIR-V shader", "the same for Vulkan", |request, progress| {
    make(request, progress, |_, module, info| {
        Ok(vec![("shader", "shader.spv", translate::spirv(module, info)?)])
    })
});

const fn form(
    id: &'static str,
    name: &'static str,
    summary: &'static str,
    make: fn(&Request, &Progress) -> Result<Export, ExportError>,
) -> Form {
    Form { id, name, summary, makes: Makes::Folder, of_object: true, of_view: true, make }
}

/// The files of a shader: the key of each in the manifest, its name, and its content.
type Files = Vec<(&'static str, &'static str, Vec<u8>)>;
/// Writes a shader in a language.
type Write = fn(&str, &Module, &ModuleInfo) -> Result<Files, ExportError>;

/// The host of self-contained shaders.
///
/// # Errors
/// Returns an error if the scene's tone mapping uses a table: these shaders have no textures.
pub fn alone(request: &Request) -> Result<Host, ExportError> {
    let display = request.scene.display;
    match display.tone_mapping {
        tone if tone.is_table() => {
            let formulas = ToneMapping::ALL.into_iter().filter(|t| !t.is_table()).map(ToneMapping::id);
            let formulas = crate::text::listed(&formulas.collect::<Vec<_>>(), "and");
            let is = format!("display.tone_mapping: {} is a table of colours", tone.id());
            let why = "a stand-alone shader has only formulas; these can be exported";
            Err(ExportError::refused(format!("{is}, but {why}: {formulas}")))
        }
        tone => Ok(Host::Alone { tone, encoding: display.encoding }),
    }
}

/// The scene of one object, taken apart for a self-contained shader.
fn lit<'a>(request: &Request<'a>) -> Result<Lit<'a>, ExportError> {
    let lit = Lit::of(*request, alone(request)?, |index| index == request.object)?;
    if lit.objects.is_empty() {
        let path = request.scene.object_path(request.object);
        let what = format!("{path} is hidden; make it visible, or choose another object");
        return Err(ExportError::refused(what));
    }
    if let Some(program) = lit.programs.iter().find(|program| program.shader.reads_body) {
        let (path, model) = (request.scene.object_path(request.object), program.model);
        let instead = if model.passage_varies() { "make it thin-walled" } else { "choose thin_glass" };
        let what = format!(
            "{path}: {} follows the mesh of the object, which these shaders do not hold; {instead}, or render the picture",
            model.declaration.id
        );
        return Err(ExportError::refused(what));
    }
    Ok(lit)
}

fn make(request: &Request, progress: &Progress, write: Write) -> Result<Export, ExportError> {
    progress.step(0.0, "composing the shader")?;
    let lit = lit(request)?;
    let drawn = lit.objects[0];
    let text = &lit.programs[0].shader.text;
    let (module, info) = module(text)?;
    progress.step(0.5, "translating it")?;
    let mesh = &lit.meshes[drawn.mesh];
    let mut files = Vec::new();
    let mut names = Map::new();
    for (word, name, bytes) in write(text, &module, &info)? {
        names.insert(word.to_owned(), name.into());
        files.push(File::new(name, bytes));
    }
    let indices: Vec<u8> = mesh.indices.iter().flat_map(|i| i.to_le_bytes()).collect();
    for (word, name, bytes) in
        [("vertices", "vertices.bin", mesh.interleaved()), ("indices", "indices.bin", indices)]
    {
        names.insert(word.to_owned(), name.into());
        files.push(File::new(name, bytes));
    }
    progress.step(0.8, "describing its bindings")?;
    let mirrored = names.contains_key("vertex_shader");
    let mut manifest: Json = manifest(&module, &lit, &drawn, names);
    if mirrored {
        manifest["indices"]["front_face"] = "cw".into();
        manifest["rows"] =
            "the shader turns y over: the first row of the framebuffer is the upper one".into();
    }
    files.push(File::new("manifest.json", format!("{manifest:#}\n")));
    let mut notes = lit.notes();
    if lit.gradient().is_some() {
        let why =
            "the shader of an object does not draw what is behind it; manifest.json has its two colours";
        notes.push(format!("The background is a gradient, and {why}."));
    }
    Ok(Export { files, notes })
}

/// True if the form is the shader of an object in a text language.
#[must_use]
pub fn is_text(form: &Form) -> bool {
    form.of_object && form.id != SPIRV.id
}

/// The text of the shader of one object in a text language, for the clipboard.
///
/// # Errors
/// Returns an error if exporting the shader fails.
pub fn text(form: &Form, request: &Request) -> Result<String, ExportError> {
    let export = (form.make)(request, &Progress::NONE)?;
    let shaders = export.files.iter().filter(|file| file.path.starts_with("shader."));
    let texts: Vec<_> = shaders.filter_map(|file| String::from_utf8(file.bytes.clone()).ok()).collect();
    Ok(texts.join("\n"))
}
