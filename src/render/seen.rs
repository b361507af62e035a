//! Draws lights with extent in the picture: one triangle over the whole of each view with a special material,
//! which gives each pixel the light and the depth of the nearest light there. It exists if a scene has
//! visible lights with extent.

use bevy::{
    asset::RenderAssetUsages,
    camera::visibility::{NoFrustumCulling, RenderLayers},
    ecs::system::{SystemParamItem, lifetimeless::SRes},
    mesh::{MeshVertexBufferLayoutRef, PrimitiveTopology},
    pbr::{MaterialPipeline, MaterialPipelineKey},
    prelude::*,
    render::{
        render_asset::RenderAssets,
        render_resource::{
            binding_types::{storage_buffer_read_only_sized, uniform_buffer_sized},
            *,
        },
        renderer::{RenderAdapter, RenderDevice},
        storage::GpuShaderBuffer,
    },
    shader::ValidateShader,
};
use wgpu::DownlevelFlags;

use super::{
    entities::CurrentScene,
    illumination::{IlluminationBuffer, LightBuffers},
    live::LiveShaders,
    material::{bound, set_shader},
    overrides::Overrides,
    schedule::{LabFrame, LabSystems},
    shown::Shown,
    stage::{SCENE_LAYER, Stage},
    swap::swap,
    trial::COMPOSED,
};
use crate::{
    optics::colour::Encoding,
    registry::{LightSet, Registry, compose::compose_seen},
    scene::Light,
    shader::{compose::Sources, whole::judged},
};

/// Draws lights with extent.
pub(super) fn plugin(app: &mut App) {
    app.add_plugins(MaterialPlugin::<SeenMaterial>::default())
        .init_resource::<SeenShader>()
        .add_systems(LabFrame, show.in_set(LabSystems::Swap).after(swap));
}

/// The lights of a view, and how they are drawn.
#[derive(Asset, Clone, Debug, PartialEq, TypePath)]
struct SeenMaterial {
    illumination: LightBuffers,
    key: SeenKey,
}

/// The key of the material's pipelines.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
struct SeenKey {
    shader: Handle<Shader>,
    gamma_naive: bool,
    /// True if the device can shade each sample of a pixel separately.
    by_sample: bool,
}

// Written by hand, because a uniform buffer shared between materials cannot be derived.
impl AsBindGroup for SeenMaterial {
    type Data = SeenKey;
    type Param = SRes<RenderAssets<GpuShaderBuffer>>;

    fn label() -> &'static str {
        "seen lights"
    }

    fn bind_group_data(&self) -> SeenKey {
        self.key.clone()
    }

    fn unprepared_bind_group(
        &self,
        _: &BindGroupLayout,
        _: &RenderDevice,
        buffers: &mut SystemParamItem<'_, '_, Self::Param>,
        _: bool,
    ) -> Result<UnpreparedBindGroup, AsBindGroupError> {
        let LightBuffers { lights, words } = &self.illumination;
        bound(buffers, [(1, lights), (2, words), (4, lights)])
    }

    fn bind_group_layout_entries(_: &RenderDevice, _: bool) -> Vec<BindGroupLayoutEntry> {
        let storage = storage_buffer_read_only_sized(false, None);
        let entries = ((1, storage), (2, storage), (4, uniform_buffer_sized(false, None)));
        BindGroupLayoutEntries::with_indices(ShaderStages::FRAGMENT, entries).to_vec()
    }
}

impl Material for SeenMaterial {
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
        let SeenKey { shader, gamma_naive, by_sample } = key.bind_group_data;
        let sampled = by_sample && descriptor.multisample.count > 1;
        descriptor.vertex.buffers =
            vec![layout.0.get_layout(&[Mesh::ATTRIBUTE_POSITION.at_shader_location(0)])?];
        set_shader(descriptor, &shader, if sampled { &["SAMPLED"] } else { &[] }, gamma_naive);
        Ok(())
    }
}

/// The triangle of a view.
#[derive(Component, Debug)]
struct SeenLights {
    /// The view with overrides that shows it; `None` for all others.
    view: Option<Entity>,
    material: SeenMaterial,
}

/// The shader of the light types in the picture.
#[derive(Default, Resource)]
struct SeenShader {
    lights: LightSet,
    text: String,
    handle: Option<Handle<Shader>>,
}

impl SeenShader {
    /// Rebuilds the shader for other light types and other texts. An invalid text changes nothing; for other
    /// light types, the shipped texts replace it.
    fn follow(
        &mut self,
        lights: LightSet,
        sources: &Sources,
        registry: &Registry,
        assets: &mut Assets<Shader>,
    ) {
        let types = registry.lights_in(lights);
        let mut composed = compose_seen(sources, &types);
        if self.handle.is_some() && self.lights == lights && self.text == composed.text {
            return;
        }
        let is_good = |composed| judged(composed, false) == Some(Ok(()));
        if sources.edited().next().is_some() && !is_good(&composed) {
            if self.handle.is_some() && self.lights == lights {
                return;
            }
            composed = compose_seen(&Sources::default(), &types);
        }
        let mut shader =
            Shader::from_wgsl(composed.text.clone(), format!("{COMPOSED}seen/{:x}.wgsl", lights.bits()));
        shader.validate_shader = ValidateShader::Enabled;
        match &self.handle {
            // The asset exists as long as its handle.
            Some(handle) => _ = assets.insert(handle.id(), shader),
            None => self.handle = Some(assets.add(shader)),
        }
        (self.lights, self.text) = (lights, composed.text);
    }
}

/// Gives every view the triangle of its lights if any are visible, and removes it if none are.
fn show(world: &mut World, known: &mut QueryState<(Entity, &'static SeenLights)>) {
    let registry = world.resource::<Registry>();
    let is_visible = |light: &Light| {
        registry.light(&light.light_type).is_some_and(|entry| entry.is_visible(&light.parameters))
    };
    let shown = world.resource::<Shown>();
    let any = registry.has_extent(shown.types) && shown.shining().any(is_visible);
    let mut known: Vec<_> = known.iter(world).map(|(entity, seen)| (entity, seen.view)).collect();
    if any {
        for (view, layer, material) in wanted(world) {
            let at = known.iter().position(|(_, of)| *of == view);
            match at.map(|at| known.swap_remove(at).0) {
                Some(entity) => dress(world, entity, material),
                None => put(world, view, layer, material),
            }
        }
    }
    for (entity, _) in known {
        world.despawn(entity);
    }
}

/// The triangles needed by the views without overrides, and by each view with overrides.
fn wanted(world: &mut World) -> Vec<(Option<Entity>, usize, SeenMaterial)> {
    let registry = world.resource::<Registry>();
    let lights = registry
        .lights_in(world.resource::<Shown>().types)
        .iter()
        .filter(|light| light.declaration.extent)
        .collect();
    let other = world.is_resource_changed::<LiveShaders>() || world.is_resource_changed::<Registry>();
    if other
        || world.resource::<SeenShader>().handle.is_none()
        || world.resource::<SeenShader>().lights != lights
    {
        let sources = world.resource::<LiveShaders>().sources_of_seen(registry);
        let registry = registry.clone();
        world.resource_scope(|world, mut shader: Mut<SeenShader>| {
            shader.follow(lights, &sources, &registry, &mut world.resource_mut::<Assets<Shader>>());
        });
    }
    let Some(shader) = world.resource::<SeenShader>().handle.clone() else { return Vec::new() };
    let by_sample = world.get_resource::<RenderAdapter>().is_some_and(|adapter| {
        adapter.get_downlevel_capabilities().flags.contains(DownlevelFlags::MULTISAMPLED_SHADING)
    });
    let scene = &world.resource::<CurrentScene>().0;
    let material = |illumination: &LightBuffers, encoding: Encoding| SeenMaterial {
        illumination: illumination.clone(),
        key: SeenKey { shader: shader.clone(), gamma_naive: encoding == Encoding::Off, by_sample },
    };
    let shared = &world.resource::<IlluminationBuffer>().buffers;
    let mut all = vec![(None, SCENE_LAYER, material(shared, scene.display.encoding))];
    let mut stages = world.try_query::<(Entity, &Stage, &Overrides)>();
    let stages = stages.iter_mut().flat_map(|stages| stages.iter(world)).map(|(view, stage, overrides)| {
        let encoding = overrides.display_of(scene).encoding;
        (Some(view), stage.layer, material(&stage.illumination, encoding))
    });
    all.extend(stages);
    all
}

/// Adds the triangle of a view.
fn put(world: &mut World, view: Option<Entity>, layer: usize, material: SeenMaterial) {
    let mut mesh = Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default());
    let corners = vec![[-1.0f32, -1.0, 0.0], [3.0, -1.0, 0.0], [-1.0, 3.0, 0.0]];
    mesh.insert_attribute(Mesh::ATTRIBUTE_POSITION, corners);
    let mesh = world.resource_mut::<Assets<Mesh>>().add(mesh);
    let handle = world.resource_mut::<Assets<SeenMaterial>>().add(material.clone());
    world.spawn((
        SeenLights { view, material },
        Mesh3d(mesh),
        MeshMaterial3d(handle),
        NoFrustumCulling,
        RenderLayers::layer(layer),
    ));
}

/// Sets the material of a triangle, if it differs.
fn dress(world: &mut World, entity: Entity, material: SeenMaterial) {
    let Some(mut seen) = world.get_mut::<SeenLights>(entity).filter(|seen| seen.material != material) else {
        return;
    };
    seen.material = material.clone();
    let handle = world.resource_mut::<Assets<SeenMaterial>>().add(material);
    world.entity_mut(entity).insert(MeshMaterial3d(handle));
}
