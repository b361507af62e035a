//! Translation of shaders into other languages by naga.

use naga::{
    AddressSpace, Module, ResourceBinding, ShaderStage,
    back::{glsl, hlsl, msl, spv},
    proc::BoundsCheckPolicies,
    valid::ModuleInfo,
};

use super::ExportError;

/// The entry points of exported shaders, with their stages.
pub const ENTRY_POINTS: [(&str, ShaderStage); 2] =
    [("vertex", ShaderStage::Vertex), ("fragment", ShaderStage::Fragment)];

/// A GLSL shader for one stage.
#[derive(Clone, Debug)]
pub struct Glsl {
    /// Source text.
    pub text: String,
    /// The uniform blocks: the binding in WGSL, and the name of the block.
    pub blocks: Vec<(u32, String)>,
}

fn failed(language: &str, error: impl std::fmt::Display) -> ExportError {
    ExportError::refused(format!("its shader could not be translated to {language}: {error}"))
}

/// The uniforms of a module with their bindings, in binding order.
fn uniforms(module: &Module) -> Vec<(ResourceBinding, &str)> {
    let all = module.global_variables.iter().filter(|(_, global)| global.space == AddressSpace::Uniform);
    let mut all: Vec<_> =
        all.filter_map(|(_, global)| Some((global.binding?, global.name.as_deref()?))).collect();
    all.sort_by_key(|(binding, _)| (binding.group, binding.binding));
    all
}

/// The shader of an entry point in GLSL: 4.50 for OpenGL and Vulkan, or ES 3.00 for WebGL 2, which has no
/// binding numbers.
///
/// # Errors
/// Returns an error if naga cannot express the shader.
pub fn glsl(
    module: &Module,
    info: &ModuleInfo,
    version: glsl::Version,
    (entry_point, shader_stage): (&str, ShaderStage),
) -> Result<Glsl, ExportError> {
    let options = glsl::Options {
        version,
        // Flips y; otherwise derivatives along it would have the opposite sign.
        writer_flags: glsl::WriterFlags::ADJUST_COORDINATE_SPACE,
        binding_map: uniforms(module)
            .into_iter()
            .map(|(binding, _)| (binding, binding.binding as u8))
            .collect(),
        zero_initialize_workgroup_memory: true,
    };
    let pipeline =
        glsl::PipelineOptions { shader_stage, entry_point: entry_point.to_owned(), multiview: None };
    let mut text = String::new();
    let mut writer =
        glsl::Writer::new(&mut text, module, info, &options, &pipeline, BoundsCheckPolicies::default())
            .map_err(|e| failed("GLSL", e))?;
    let reflection = writer.write().map_err(|e| failed("GLSL", e))?;
    let mut blocks: Vec<_> = reflection
        .uniforms
        .into_iter()
        .filter_map(|(global, name)| Some((module.global_variables[global].binding?.binding, name)))
        .collect();
    blocks.sort();
    Ok(Glsl { text, blocks })
}

/// Both stages in HLSL of shader model 6.0: constant buffer `bN` is binding N.
///
/// # Errors
/// Returns an error if naga cannot express the shader.
pub fn hlsl(module: &Module, info: &ModuleInfo) -> Result<String, ExportError> {
    let target = |binding: ResourceBinding| hlsl::BindTarget {
        space: 0,
        register: binding.binding,
        ..hlsl::BindTarget::default()
    };
    let options = hlsl::Options {
        shader_model: hlsl::ShaderModel::V6_0,
        binding_map: uniforms(module).into_iter().map(|(b, _)| (b, target(b))).collect(),
        fake_missing_bindings: false,
        ..hlsl::Options::default()
    };
    let mut text = String::new();
    hlsl::Writer::new(&mut text, &options, &hlsl::PipelineOptions::default())
        .write(module, info, None)
        .map_err(|e| failed("HLSL", e))?;
    Ok(text)
}

/// Both stages in the Metal Shading Language 2.0: buffer N is binding N; vertices are the stage input.
///
/// # Errors
/// Returns an error if naga cannot express the shader.
pub fn msl(module: &Module, info: &ModuleInfo) -> Result<String, ExportError> {
    let resources = msl::EntryPointResources {
        resources: uniforms(module)
            .into_iter()
            .map(|(binding, _)| {
                let buffer = Some(binding.binding as u8);
                (binding, msl::BindTarget { buffer, ..msl::BindTarget::default() })
            })
            .collect(),
        ..msl::EntryPointResources::default()
    };
    let options = msl::Options {
        lang_version: (2, 0),
        per_entry_point_map: ENTRY_POINTS
            .iter()
            .map(|(name, _)| ((*name).to_owned(), resources.clone()))
            .collect(),
        fake_missing_bindings: false,
        ..msl::Options::default()
    };
    let (text, _) = msl::write_string(module, info, &options, &msl::PipelineOptions::default())
        .map_err(|e| failed("MSL", e))?;
    Ok(text)
}

/// Both stages in SPIR-V 1.3, little-endian.
///
/// # Errors
/// Returns an error if naga cannot express the shader.
pub fn spirv(module: &Module, info: &ModuleInfo) -> Result<Vec<u8>, ExportError> {
    let options = spv::Options {
        lang_version: (1, 3),
        flags: spv::WriterFlags::ADJUST_COORDINATE_SPACE
            | spv::WriterFlags::LABEL_VARYINGS
            | spv::WriterFlags::CLAMP_FRAG_DEPTH
            | spv::WriterFlags::DEBUG,
        ..spv::Options::default()
    };
    let words = spv::write_vec(module, info, &options, None).map_err(|e| failed("SPIR-V", e))?;
    Ok(words.into_iter().flat_map(u32::to_le_bytes).collect())
}
