//! The trial itself: composes a candidate and builds a pipeline from it.

use std::borrow::Cow;

use bevy::{
    asset::uuid::Uuid,
    mesh::VertexBufferLayout,
    prelude::*,
    render::{render_resource::*, renderer::RenderDevice},
    shader::{ShaderCache, ShaderCacheError, ShaderCacheSource, ShaderDefVal, ShaderImport},
    tasks::block_on,
};
use naga::Module;

use super::{
    explain::{located, offset, refusal, refused, unknown_import},
    tools::{COMPOSED, Example, Tools},
    verdict::Verdict,
};
use crate::{
    platform,
    shader::{check::locate, compose::Composed, limits, pitfall},
};

/// Composes a candidate and builds a pipeline from it. The cache is filled on first use.
pub(super) fn attempt(
    cache: &mut Option<ShaderCache<Module, ()>>,
    composed: &Composed,
    faces: bool,
    example: &Example,
    tools: Tools,
) -> Result<(), Verdict> {
    let cache = cache.get_or_insert_with(|| library(tools));
    let mut descriptor = example.descriptor.clone();
    if faces != descriptor.vertex.shader_defs.contains(&"FACES".into()) {
        change_faces(&mut descriptor, faces);
    }
    let mut modules = Vec::new();
    let fragment_defs = descriptor.fragment.iter().map(|f| &f.shader_defs);
    for defs in [&descriptor.vertex.shader_defs].into_iter().chain(fragment_defs) {
        if modules.iter().any(|(known, _)| *known == defs) {
            continue;
        }
        let module = compose(cache, composed, faces, defs, tools)?;
        if let Some((span, message)) = limits::check_module(&module).or_else(|| pitfall::find(&module)) {
            let offset = offset(&module, &composed.text);
            return Err(located(composed, offset, [span].into_iter(), message));
        }
        modules.push((defs, module));
    }
    let module_of = |defs: &Vec<ShaderDefVal>| {
        modules.iter().find(|(known, _)| *known == defs).map(|(_, module)| module.clone()).unwrap_or_default()
    };
    let vertex = module_of(&descriptor.vertex.shader_defs);
    let fragment = descriptor.fragment.as_ref().map(|f| module_of(&f.shader_defs)).unwrap_or_default();
    build(&descriptor, &example.layouts, vertex, fragment, tools.device)
        .map_err(|error| Verdict::Bad(refused(composed, &error)))
}

/// A cache with Bevy's shaders.
fn library(tools: Tools) -> ShaderCache<Module, ()> {
    let downlevel = tools.adapter.get_downlevel_capabilities().flags;
    let mut cache = ShaderCache::new((), tools.device.features(), downlevel, |(), source, _| match source {
        ShaderCacheSource::Naga(module) => Ok(module),
        _ => Err(ShaderCacheError::CreateShaderModule("only WGSL is expected".to_owned())),
    });
    // Otherwise off in release builds.
    cache.composer.validate = true;
    for (id, shader) in tools.shaders.iter() {
        if !shader.path.starts_with(COMPOSED) {
            cache.set_shader(id, with_limits(shader.clone(), tools.device));
        }
    }
    cache
}

/// Asset id of candidates in the cache.
const CANDIDATE: AssetId<Shader> = AssetId::Uuid { uuid: Uuid::from_u128(0x4c43_4d05) };

/// Adds the limits of the device, as Bevy does for every shader.
fn with_limits(mut shader: Shader, device: &RenderDevice) -> Shader {
    let buffers = device.limits().max_storage_buffers_per_shader_stage;
    shader.shader_defs.push(ShaderDefVal::UInt("AVAILABLE_STORAGE_BUFFER_BINDINGS".to_owned(), buffers));
    shader
}

fn compose(
    cache: &mut ShaderCache<Module, ()>,
    composed: &Composed,
    faces: bool,
    defs: &[ShaderDefVal],
    tools: Tools,
) -> Result<Module, Verdict> {
    let shader = Shader::from_wgsl(composed.text.clone(), format!("{COMPOSED}candidate.wgsl"));
    let imports = shader.imports.clone();
    cache.set_shader(CANDIDATE, with_limits(shader, tools.device));
    match cache.get(0, CANDIDATE, defs) {
        Ok(module) => Ok((*module).clone()),
        Err(ShaderCacheError::ProcessShaderError(error)) => Err(refusal(composed, faces, &error)),
        Err(ShaderCacheError::ShaderImportNotYetAvailable | ShaderCacheError::ShaderNotLoaded(_)) => {
            let known = |import: &ShaderImport| tools.shaders.iter().any(|(_, s)| s.import_path == *import);
            match imports.iter().find(|import| !known(import)) {
                Some(missing) => Err(Verdict::Bad(unknown_import(composed, &missing.module_name(), tools))),
                None => Err(Verdict::NotYet),
            }
        }
        Err(error) => Err(Verdict::Bad(locate(composed, None, error.to_string()))),
    }
}

/// Switches the example to meshes with data of their polygons, or back.
fn change_faces(descriptor: &mut RenderPipelineDescriptor, faces: bool) {
    let change = |defs: &mut Vec<ShaderDefVal>| {
        defs.retain(|def| *def != "FACES".into());
        if faces {
            defs.push("FACES".into());
        }
    };
    change(&mut descriptor.vertex.shader_defs);
    if let Some(fragment) = descriptor.fragment.as_mut() {
        change(&mut fragment.shader_defs);
    }
    let count = if faces { 6 } else { 3 };
    let format = VertexFormat::Float32x3;
    let attribute = |i| VertexAttribute { format, offset: 12 * i, shader_location: i as u32 };
    let attributes = (0..count).map(attribute).collect();
    if let Some(buffer) = descriptor.vertex.buffers.first_mut() {
        *buffer = VertexBufferLayout { array_stride: 12 * count, attributes, ..buffer.clone() };
    }
}

/// Builds a pipeline that is not drawn; returns the driver's error.
fn build(
    descriptor: &RenderPipelineDescriptor,
    layouts: &[BindGroupLayout],
    vertex: Module,
    fragment: Module,
    device: &RenderDevice,
) -> Result<(), wgpu::Error> {
    if !platform::WAITS_FOR_GPU {
        // The composer has validated it.
        return Ok(());
    }
    let wgpu_device = device.wgpu_device();
    // Scopes belong to the thread, so all of this happens here and now.
    let internal = wgpu_device.push_error_scope(wgpu::ErrorFilter::Internal);
    let validation = wgpu_device.push_error_scope(wgpu::ErrorFilter::Validation);
    let module = |module: Module| {
        device.create_and_validate_shader_module(ShaderModuleDescriptor {
            label: None,
            source: ShaderSource::Naga(Cow::Owned(module)),
        })
    };
    let (vertex, fragment) = (module(vertex), module(fragment));
    let layouts: Vec<_> = layouts.iter().map(|layout| Some(&**layout)).collect();
    let layout = wgpu_device.create_pipeline_layout(&PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: &layouts,
        immediate_size: descriptor.immediate_size,
    });
    let buffers: Vec<_> = descriptor
        .vertex
        .buffers
        .iter()
        .map(|b| wgpu::VertexBufferLayout {
            array_stride: b.array_stride,
            step_mode: b.step_mode,
            attributes: &b.attributes,
        })
        .collect();
    let _ = wgpu_device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &vertex,
            entry_point: descriptor.vertex.entry_point.as_deref(),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &buffers,
        },
        primitive: descriptor.primitive,
        depth_stencil: descriptor.depth_stencil.clone(),
        multisample: descriptor.multisample,
        fragment: descriptor.fragment.as_ref().map(|f| wgpu::FragmentState {
            module: &fragment,
            entry_point: f.entry_point.as_deref(),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &f.targets,
        }),
        multiview_mask: None,
        cache: None,
    });
    let errors = [block_on(validation.pop()), block_on(internal.pop())];
    errors.into_iter().flatten().next().map_or(Ok(()), Err)
}
