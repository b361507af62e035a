//! The Material implementation, generic over the model: one Material type per model.
//!
//! A material contains the parameter table of all objects with its model, whose layout follows from the
//! declaration, the shared light buffer, and the composed shader of its model and shading model, which is
//! part of the pipeline key. Each object has the index of its table row as its mesh tag, so all objects with
//! the same model and shading model share one material and are drawn together.

use std::{collections::HashMap, marker::PhantomData};

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
use crate::{custom::CustomFile, reflection::ReflectionModel};

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

/// The contents of a material, equal for all model types.
#[derive(Clone, Debug, PartialEq)]
pub struct MaterialInputs {
    /// The parameters of all objects with the model.
    pub parameters: Handle<ShaderBuffer>,
    /// The hierarchy of the object's mesh, for models of solid bodies; for others any buffer.
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

/// The material of objects with the model `M`; custom models share [`CustomFile`].
#[derive(Asset, Clone, Debug)]
pub struct ModelMaterial<M: Clone + 'static> {
    inputs: MaterialInputs,
    model: PhantomData<fn() -> M>,
}

/// The key of the pipelines of one model type.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct PipelineKey {
    shader: Handle<Shader>,
    faces: bool,
    gamma_naive: bool,
}

// Written by hand, because a uniform buffer shared between materials cannot be derived.
impl<M: Clone + 'static> AsBindGroup for ModelMaterial<M> {
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
        bound(buffers, [(0, parameters), (1, lights), (2, words), (3, solid)])
    }

    fn bind_group_layout_entries(_: &RenderDevice, _: bool) -> Vec<BindGroupLayoutEntry> {
        let storage = || storage_buffer_read_only_sized(false, None);
        BindGroupLayoutEntries::sequential(
            ShaderStages::VERTEX_FRAGMENT,
            (storage(), uniform_buffer_sized(false, None), storage(), storage()),
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

impl<M: Clone + 'static> From<MaterialInputs> for ModelMaterial<M> {
    fn from(inputs: MaterialInputs) -> Self {
        Self { inputs, model: PhantomData }
    }
}

// Written by hand, so that authors of models need not know Bevy's reflection.
impl<M: Clone + 'static> TypePath for ModelMaterial<M> {
    fn type_path() -> &'static str {
        std::any::type_name::<Self>()
    }

    fn short_type_path() -> &'static str {
        std::any::type_name::<Self>()
    }
}

impl<M: Clone + 'static> Material for ModelMaterial<M> {
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

/// Adds a material of some model type to an entity, or removes it: the same two functions for every model,
/// looked up by id.
#[derive(Clone, Copy)]
pub struct Attachment {
    /// Adds the material.
    pub attach: fn(&mut EntityWorldMut, MaterialInputs),
    /// Removes the material.
    pub detach: fn(&mut EntityWorldMut),
    /// Drops the materials that use a light buffer.
    pub(super) forget: fn(&mut World, AssetId<ShaderBuffer>),
}

/// The [`Attachment`] of every registered model.
#[derive(Default, Resource)]
pub struct Attachments {
    by_id: HashMap<&'static str, Attachment>,
    /// The attachment of all custom models, whose ids may change.
    own: Option<Attachment>,
}

impl Attachments {
    /// The attachment of a model that is or was registered.
    #[must_use]
    pub fn get(&self, id: &str) -> Option<Attachment> {
        self.by_id.get(id).copied().or(self.own)
    }

    pub(super) fn all(&self) -> Vec<Attachment> {
        self.by_id.values().copied().chain(self.own).collect()
    }
}

/// Registers the Material type of the model `M` with the renderer.
pub(super) fn add_model_material<M: ReflectionModel>(app: &mut App) {
    let attachment = attachment::<M>(app);
    app.world_mut().resource_mut::<Attachments>().by_id.insert(M::DECLARATION.id, attachment);
}

/// Registers the Material type of all custom models.
pub(super) fn add_custom_material(app: &mut App) {
    let attachment = attachment::<CustomFile>(app);
    app.world_mut().resource_mut::<Attachments>().own = Some(attachment);
}

/// The attachment of a material type, which is registered with the renderer.
fn attachment<M: Clone + 'static>(app: &mut App) -> Attachment {
    if !app.is_plugin_added::<MaterialPlugin<ModelMaterial<M>>>() {
        app.add_plugins(MaterialPlugin::<ModelMaterial<M>>::default());
    }
    app.init_resource::<Attachments>();
    Attachment { attach: attach::<M>, detach: detach::<M>, forget: forget::<M> }
}

/// The materials of one model by shader, light buffer and, for solid bodies, hierarchy: one for each shading model in use,
/// shared by the views without overrides, and separate for each view with overrides.
#[derive(Resource)]
struct SharedMaterials<M: Clone + 'static>(
    HashMap<[bevy::asset::UntypedAssetId; 3], Handle<ModelMaterial<M>>>,
);

fn attach<M: Clone + 'static>(entity: &mut EntityWorldMut, inputs: MaterialInputs) {
    let handle = entity.world_scope(|world: &mut World| {
        let key = [
            inputs.shader.id().untyped(),
            inputs.illumination.lights.id().untyped(),
            inputs.solid.id().untyped(),
        ];
        world.get_resource_or_insert_with(|| SharedMaterials::<M>(HashMap::new()));
        world.resource_scope(|world, mut shared: Mut<SharedMaterials<M>>| {
            let mut materials = world.resource_mut::<Assets<ModelMaterial<M>>>();
            let Some(handle) = shared.0.get(&key) else {
                let handle = materials.add(ModelMaterial::<M>::from(inputs));
                shared.0.insert(key, handle.clone());
                return handle;
            };
            // A table that was rebuilt for more objects, or another encoding.
            if let Some(material) = materials.get(handle)
                && material.inputs != inputs
            {
                let _ = materials.insert(handle.id(), ModelMaterial::<M>::from(inputs));
            }
            handle.clone()
        })
    });
    if entity.get::<MeshMaterial3d<ModelMaterial<M>>>().map(|m| &m.0) != Some(&handle) {
        entity.insert(MeshMaterial3d(handle));
    }
}

fn detach<M: Clone + 'static>(entity: &mut EntityWorldMut) {
    entity.remove::<MeshMaterial3d<ModelMaterial<M>>>();
}

fn forget<M: Clone + 'static>(world: &mut World, illumination: AssetId<ShaderBuffer>) {
    if let Some(mut shared) = world.get_resource_mut::<SharedMaterials<M>>() {
        shared.0.retain(|[_, lit_by, _], _| *lit_by != illumination.untyped());
    }
}
