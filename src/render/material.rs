//! The Material implementation, of one type for all models.
//!
//! A material contains the parameter table of all objects with its model, whose layout follows from the
//! declaration, the shared light buffer, and the composed shader of its model and shading model, which is
//! part of the pipeline key. Each object has the index of its table row as its mesh tag, so all objects with
//! the same model and shading model share one material and are drawn together.
//!
//! A type for each model would differ in nothing but its name, and Bevy compiles and runs its systems of materials once
//! for each type.

use std::collections::HashMap;

use bevy::{
    ecs::system::{SystemParamItem, lifetimeless::SRes},
    mesh::{MeshVertexAttribute, MeshVertexBufferLayoutRef},
    pbr::{MaterialPipeline, MaterialPipelineKey},
    prelude::*,
    render::{
        render_asset::RenderAssets,
        render_resource::{
            binding_types::{storage_buffer_read_only_sized, uniform_buffer_sized},
            *,
        },
        renderer::RenderDevice,
        storage::{GpuShaderBuffer, ShaderBuffer},
    },
};

use super::{illumination::LightBuffers, trial::MARK};

/// The tangent of the vertex. Three numbers instead of Bevy's four: the bitangent is always `n × t`.
pub const TANGENT: MeshVertexAttribute =
    MeshVertexAttribute::new("BrushTangent", 0x4c43_4d03, VertexFormat::Float32x3);
/// The normal of the polygon, on meshes for shading models that calculate per polygon.
pub const FACE_NORMAL: MeshVertexAttribute =
    MeshVertexAttribute::new("FaceNormal", 0x4c43_4d01, VertexFormat::Float32x3);
/// The tangent of the polygon, on meshes for shading models that calculate per polygon.
pub const FACE_TANGENT: MeshVertexAttribute =
    MeshVertexAttribute::new("FaceTangent", 0x4c43_4d04, VertexFormat::Float32x3);
/// The centre of the polygon, on meshes for shading models that calculate per polygon.
pub const FACE_CENTRE: MeshVertexAttribute =
    MeshVertexAttribute::new("FaceCentre", 0x4c43_4d02, VertexFormat::Float32x3);

/// The vertices of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Vertices {
    /// Shared by polygons, for shading models that interpolate.
    Shared,
    /// Separate for each polygon, for shading models that calculate per polygon.
    Apart,
}

/// The contents of a material.
#[derive(Clone, Debug, PartialEq)]
pub struct MaterialInputs {
    /// The parameters of all objects with the model.
    pub parameters: Handle<ShaderBuffer>,
    /// The hierarchy of the object's mesh, for models of solid bodies, or the numbers of the object's file, for models that
    /// read one; for others any buffer.
    pub solid: Handle<ShaderBuffer>,
    /// The lights of the scene, shared by all materials.
    pub illumination: LightBuffers,
    /// The composed shader of model and shading model.
    pub shader: Handle<Shader>,
    /// True if the mesh has [`FACE_NORMAL`], [`FACE_TANGENT`] and [`FACE_CENTRE`].
    pub faces: bool,
    /// True if the display shows numbers unchanged, [`Encoding::Off`](crate::optics::colour::Encoding::Off).
    pub gamma_naive: bool,
}

/// The material of objects with some reflection model and shading model, whose shader it has.
#[derive(Asset, Clone, Debug, TypePath)]
pub struct ModelMaterial {
    inputs: MaterialInputs,
}

/// The key of the pipelines.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct PipelineKey {
    shader: Handle<Shader>,
    faces: bool,
    gamma_naive: bool,
}

// Written by hand, because a buffer shared between materials cannot be derived.
impl AsBindGroup for ModelMaterial {
    type Data = PipelineKey;
    type Param = SRes<RenderAssets<GpuShaderBuffer>>;

    fn label() -> &'static str {
        "model"
    }

    fn bind_group_data(&self) -> PipelineKey {
        let MaterialInputs { faces, gamma_naive, .. } = self.inputs;
        PipelineKey { shader: self.inputs.shader.clone(), faces, gamma_naive }
    }

    fn unprepared_bind_group(
        &self,
        _: &BindGroupLayout,
        _: &RenderDevice,
        buffers: &mut SystemParamItem<'_, '_, Self::Param>,
        _: bool,
    ) -> Result<UnpreparedBindGroup, AsBindGroupError> {
        let LightBuffers { lights, words } = &self.inputs.illumination;
        let MaterialInputs { parameters, solid, .. } = &self.inputs;
        bound(buffers, [(0, parameters), (1, lights), (2, words), (3, solid), (4, lights)])
    }

    fn bind_group_layout_entries(_: &RenderDevice, _: bool) -> Vec<BindGroupLayoutEntry> {
        let storage = || storage_buffer_read_only_sized(false, None);
        BindGroupLayoutEntries::sequential(
            ShaderStages::VERTEX_FRAGMENT,
            (storage(), storage(), storage(), storage(), uniform_buffer_sized(false, None)),
        )
        .to_vec()
    }
}

/// Buffers at their bindings; `None` until the renderer has all of them.
pub(super) fn bound<const N: usize>(
    buffers: &RenderAssets<GpuShaderBuffer>,
    handles: [(u32, &Handle<ShaderBuffer>); N],
) -> Result<UnpreparedBindGroup, AsBindGroupError> {
    let mut bindings = Vec::with_capacity(N);
    for (binding, handle) in handles {
        let buffer = buffers.get(handle).ok_or(AsBindGroupError::RetryNextUpdate)?;
        bindings.push((binding, OwnedBindingResource::Buffer(buffer.buffer.clone())));
    }
    Ok(UnpreparedBindGroup { bindings: BindingResources(bindings) })
}

/// Sets the shader of a material's pipelines, with definitions for both stages.
pub(super) fn set_shader(
    RenderPipelineDescriptor { vertex, fragment, .. }: &mut RenderPipelineDescriptor,
    shader: &Handle<Shader>,
    defs: &[&str],
    gamma_naive: bool,
) {
    (vertex.shader, vertex.entry_point) = (shader.clone(), Some("vertex".into()));
    vertex.shader_defs.extend(defs.iter().map(|def| (*def).into()));
    if let Some(fragment) = fragment {
        (fragment.shader, fragment.entry_point) = (shader.clone(), Some("fragment".into()));
        // Not a choice at run time: software renderers calculate both sides of a branch for every pixel.
        let naive = gamma_naive.then_some(&"GAMMA_NAIVE");
        fragment.shader_defs.extend(defs.iter().chain(naive).map(|def| (*def).into()));
    }
}

impl Material for ModelMaterial {
    // The Commonality Analysis assumes that objects neither shadow nor light each other (AB5, AB6), so no depth-only passes.
    fn enable_prepass() -> bool {
        false
    }

    fn enable_shadows() -> bool {
        false
    }

    fn specialize(
        _pipeline: &MaterialPipeline,
        descriptor: &mut RenderPipelineDescriptor,
        layout: &MeshVertexBufferLayoutRef,
        key: MaterialPipelineKey<Self>,
    ) -> Result<(), SpecializedMeshPipelineError> {
        let PipelineKey { shader, faces, gamma_naive } = key.bind_group_data;
        let of_vertices = [Mesh::ATTRIBUTE_POSITION, Mesh::ATTRIBUTE_NORMAL, TANGENT];
        let of_faces = [FACE_NORMAL, FACE_TANGENT, FACE_CENTRE].into_iter().filter(|_| faces);
        let attributes = (0..).zip(of_vertices.into_iter().chain(of_faces));
        let attributes: Vec<_> = attributes.map(|(i, attribute)| attribute.at_shader_location(i)).collect();
        descriptor.vertex.buffers = vec![layout.0.get_layout(&attributes)?];
        // One pipeline with this mark serves as the example with which edited shaders are tried.
        set_shader(descriptor, &shader, if faces { &["FACES", MARK] } else { &[MARK] }, gamma_naive);
        Ok(())
    }
}

/// Registers the material with the renderer.
pub(super) fn plugin(app: &mut App) {
    app.add_plugins(MaterialPlugin::<ModelMaterial>::default()).init_resource::<SharedMaterials>();
}

/// The materials by shader, light buffer and, for solid bodies and measured surfaces, the buffer of those: one for each pair of models in use, shared by the
/// views without overrides, and separate for each view with overrides.
#[derive(Default, Resource)]
struct SharedMaterials(HashMap<[bevy::asset::UntypedAssetId; 3], SharedMaterial>);

struct SharedMaterial {
    material: Handle<ModelMaterial>,
    /// True if it holds the hierarchy of a mesh, or the numbers of a file.
    is_body: bool,
}

/// True if there are other handles of an asset.
pub(super) fn is_held_elsewhere<A: Asset>(handle: &Handle<A>) -> bool {
    matches!(handle, Handle::Strong(held) if std::sync::Arc::strong_count(held) > 1)
}

/// Adds the material with these contents to an entity, or replaces its material with that one.
pub(super) fn attach(entity: &mut EntityWorldMut, inputs: MaterialInputs) {
    let handle = entity.world_scope(|world: &mut World| {
        let key = [
            inputs.shader.id().untyped(),
            inputs.illumination.lights.id().untyped(),
            inputs.solid.id().untyped(),
        ];
        world.resource_scope(|world, mut shared: Mut<SharedMaterials>| {
            let mut materials = world.resource_mut::<Assets<ModelMaterial>>();
            let Some(SharedMaterial { material: handle, .. }) = shared.0.get(&key) else {
                // A slider makes a body of each of its positions: those that nobody sees go, with their hierarchies.
                shared.0.retain(|_, shared| !shared.is_body || is_held_elsewhere(&shared.material));
                let is_body = inputs.solid != inputs.illumination.words;
                let material = materials.add(ModelMaterial { inputs });
                shared.0.insert(key, SharedMaterial { material: material.clone(), is_body });
                return material;
            };
            // A table that was rebuilt for more objects, or another encoding.
            if let Some(material) = materials.get(handle)
                && material.inputs != inputs
            {
                let _ = materials.insert(handle.id(), ModelMaterial { inputs });
            }
            handle.clone()
        })
    });
    if entity.get::<MeshMaterial3d<ModelMaterial>>().map(|m| &m.0) != Some(&handle) {
        entity.insert(MeshMaterial3d(handle));
    }
}

/// Removes the material of an entity.
pub(super) fn detach(entity: &mut EntityWorldMut) {
    entity.remove::<MeshMaterial3d<ModelMaterial>>();
}

/// Drops the materials that use a light buffer.
pub(super) fn forget(world: &mut World, illumination: AssetId<ShaderBuffer>) {
    let mut shared = world.resource_mut::<SharedMaterials>();
    shared.0.retain(|[_, lit_by, _], _| *lit_by != illumination.untyped());
}
