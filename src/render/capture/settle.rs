//! Complete pictures: draws frames until nothing is missing, in batches if the shapes do not all fit into
//! memory at once.

use std::{any::TypeId, cell::Cell, time::Duration};

use bevy::{
    camera::{Camera3dDepthLoadOp, Viewport, visibility::VisibleEntities},
    pbr::{PreparedMaterial, SpecializedMaterialPipelineCache},
    prelude::*,
    render::{
        RenderApp,
        camera::CameraRenderGraph,
        erased_render_asset::ErasedRenderAssets,
        mesh::RenderMesh,
        render_asset::RenderAssets,
        render_resource::{CachedPipeline, CachedPipelineState, PipelineCache, PipelineDescriptor},
        sync_world::MainEntity,
        texture::GpuImage,
        view::RetainedViewEntity,
    },
    shader::ShaderCacheError,
};
use web_time::Instant;

use super::gpu::{GpuError, GpuRenderer, PATIENCE};
use crate::{
    channel::DebugChannel,
    progress::Progress,
    reference::{LightSamples, Reached, Until},
    registry::Registry,
    render::{
        camera::{ForDisplay, PictureCamera},
        converge::Convergence,
        entities::CurrentScene,
        live::LiveShaders,
        meshes::ShapeMeshes,
        noise::Noise,
        straight::Layer,
        trial::Bench,
        view::{Drawing, View},
    },
    scene::Object,
};

/// The number of samples of a frame that cannot take all.
const PART: u32 = 8;
/// The share of width and height that is drawn while shaders are tried: one in so many.
const SMALLER: u32 = 16;
/// The most such frames while no other process works on a trial. Where little is in sight, it may be outside of them.
const MOST_SMALL: u32 = 64;

impl GpuRenderer {
    /// Draws frames until nothing is waiting to be loaded or compiled, and all objects are in the picture: if
    /// their shapes take more than [`BATCH`](crate::render::meshes::BATCH), or they have more triangles than
    /// [allowed](Self::limit_triangles), one batch after the other.
    ///
    /// # Errors
    /// Returns [`GpuError::TimedOut`] if this does not happen, e.g. because a shader cannot be compiled;
    /// [`GpuError::Memory`] if a single shape does not fit into memory.
    pub fn settle(&mut self) -> Result<(), GpuError> {
        self.settle_until(None, &Progress::NONE).map(|_| ())
    }

    /// Like [`settle`](Self::settle), and takes samples of lights with extent until their noise is as requested, if one is:
    /// [`Until::noise`], for [`Output::Display`] without a channel. Returns what was reached. The noise is known if frames take
    /// a part of the samples each. Cannot be cancelled.
    ///
    /// [`Output::Display`]: super::gpu::Output::Display
    ///
    /// # Errors
    /// Returns the errors of [`settle`](Self::settle); [`GpuError::Memory`] also if a noise is requested, but the shapes need
    /// several batches.
    pub fn settle_until(&mut self, noise: Option<f32>, progress: &Progress) -> Result<Reached, GpuError> {
        let by_parts = self.takes_parts(noise.is_some());
        // Means are of frames with all objects.
        let most = if by_parts || self.on_demand { u64::MAX } else { self.most_triangles };
        self.limit_frames(most);
        let reached = self.settle_within(noise, by_parts, progress);
        self.limit_frames(u64::MAX);
        reached
    }

    fn limit_frames(&mut self, most: u64) {
        self.app.world_mut().resource_mut::<ShapeMeshes>().draw_in_batches(most);
    }

    /// Draws all objects, with the limits that are set.
    fn settle_within(
        &mut self,
        noise: Option<f32>,
        by_parts: bool,
        progress: &Progress,
    ) -> Result<Reached, GpuError> {
        let until = Until { samples: self.app.world().resource::<Convergence>().target, noise };
        let all = Reached { samples: until.samples, noise: None };
        if let Some((background, graph)) = self.batched.take() {
            self.edit_camera(|camera| {
                set_background(camera, background);
                camera.insert(graph);
            });
            ShapeMeshes::restart(self.app.world_mut());
        } else if self.meshes().hides() {
            // The camera may be elsewhere.
            ShapeMeshes::restart(self.app.world_mut());
        }
        self.start()?;
        self.set_parts(by_parts);
        if !by_parts {
            self.try_shaders()?;
        }
        self.draw_frames()?;
        if let Some(why) = self.refused() {
            if by_parts && noise.is_some() {
                let remedy = "so the noise cannot be measured; use a number of samples";
                return Err(GpuError::Memory(format!("{why}, {remedy}")));
            }
            // Each batch would begin the mean anew.
            self.set_parts(false);
            self.draw_batches(progress)?;
        } else if by_parts {
            return self.converge(until, progress);
        }
        Ok(all)
    }

    /// True if a frame cannot take all samples: noise decides how many, there are more than usual, or each of them follows light
    /// through a mesh, and software Vulkan ends all loops of a pixel after 65 536 turns together.
    fn takes_parts(&self, for_noise: bool) -> bool {
        let world = self.app.world();
        let (scene, registry) = (&world.resource::<CurrentScene>().0, world.resource::<Registry>());
        let is_body = |object: &Object| {
            let model = registry.model(scene.model_of(object));
            model.is_some_and(|model| model.passage(&object.material).solid)
        };
        let at_once = self.channel.is_some_and(DebugChannel::is_of_remaining);
        let many = for_noise || world.resource::<Convergence>().target > LightSamples::DEFAULT;
        !at_once && (many || scene.shown().any(is_body)) && scene.rests_on_samples(registry)
    }

    /// Draws frames with a part of the samples each, or all samples in each frame.
    fn set_parts(&mut self, parts: bool) {
        if self.by_parts == parts {
            return;
        }
        self.by_parts = parts;
        self.app.world_mut().resource_mut::<Convergence>().pace = parts.then_some(PART);
        if parts {
            self.add_views();
        } else if !self.on_demand {
            self.edit_camera(|camera| {
                _ = camera.remove::<View>().entry::<Camera>().and_modify(|mut c| c.is_active = true)
            });
        }
    }

    /// Draws frames until the picture is the mean of all samples, or has as little noise as requested.
    fn converge(&mut self, until: Until, progress: &Progress) -> Result<Reached, GpuError> {
        let known = self.app.world().get_resource::<Noise>().cloned().unwrap_or_default();
        if until.noise.is_some() {
            // How many frames were drawn so far depends on the machine, and the picture must not.
            self.edit_camera(|camera| camera.get_mut::<Drawing>().into_iter().for_each(|mut d| d.redraw()));
            self.step();
            self.wait();
        }
        let (mut last, mut since) = (None, Instant::now());
        loop {
            let mut now = None;
            self.edit_camera(|camera| {
                let of = |drawing: &Drawing| {
                    (drawing.is_done(), drawing.converged(), known.measured(camera.id(), drawing))
                };
                now = camera.get::<Drawing>().map(of);
            });
            let all = Reached { samples: until.samples, noise: None };
            let Some((is_done, converged, measured)) = now else { return Ok(all) };
            // A picture of nothing has none; channels are not measured.
            let noise = measured.map(Option::unwrap_or_default).filter(|_| self.channel.is_none());
            let is_enough = until.noise.zip(noise).is_some_and(|(enough, noise)| noise <= enough);
            let noise = noise.filter(|noise| noise.is_finite());
            let reached = Reached { samples: converged.done, noise };
            let (done, said) = until.progress(reached);
            (progress.tell)(done, &said);
            if is_done || is_enough {
                // Linear pictures take all samples in each frame.
                return Ok(if converged.total > 0 { reached } else { all });
            }
            if last.replace(converged) != Some(converged) {
                since = Instant::now();
            } else if since.elapsed() > PATIENCE {
                return Err(GpuError::TimedOut { limit: PATIENCE, waiting: self.missing() });
            }
            self.step();
            self.wait();
        }
    }

    /// Draws the objects batch by batch: each over the picture and the depths of those before, once the GPU is done with these,
    /// and if memory is full, with meshes that replace theirs. Later frames leave the picture unchanged.
    fn draw_batches(&mut self, progress: &Progress) -> Result<(), GpuError> {
        let mut before = None;
        let mut straight = false;
        self.edit_camera(|camera| {
            straight = camera.get::<ForDisplay>().is_some_and(|display| display.straight);
            before = camera
                .get_components::<(&Camera, &CameraRenderGraph)>()
                .ok()
                .map(|(camera, graph)| (camera.clear_color, graph.clone()));
            if !straight {
                camera.insert(CameraRenderGraph::new(Layer));
            }
        });
        self.batched.clone_from(&before);
        // The first batch has been drawn, but only as light.
        let mut drawn = straight;
        let all = self.meshes().omitted();
        let mut last = usize::MAX;
        loop {
            if !std::mem::take(&mut drawn) {
                self.draw_frames()?;
            }
            let why = self.refused();
            if let Some(why) = &why
                && self.meshes().is_empty()
            {
                return Err(GpuError::Memory(why.clone()));
            }
            self.wait();
            let left = self.meshes().omitted();
            (progress.tell)(1.0 - left as f32 / all.max(1) as f32, "");
            self.edit_camera(|camera| set_background(camera, ClearColorConfig::None));
            if why.is_none() {
                break;
            }
            if self.meshes().is_crowded() {
                ShapeMeshes::take_all_off(self.app.world_mut());
                if last <= left {
                    // An object that several views show may never fit in all of them.
                    self.limit_frames(u64::MAX);
                }
            } else {
                self.clear_meshes();
            }
            last = left;
            self.app.world_mut().resource_mut::<ShapeMeshes>().make_room();
        }
        // The display's passes run once, at the end: they would mistake their own output for light.
        if let Some((_, graph)) = before.filter(|_| !straight) {
            self.edit_camera(|camera| _ = camera.insert(graph));
            self.step();
            self.edit_camera(|camera| _ = camera.insert(CameraRenderGraph::new(Layer)));
        }
        self.clear_meshes();
        Ok(())
    }

    fn meshes(&self) -> &ShapeMeshes {
        self.app.world().resource::<ShapeMeshes>()
    }

    fn clear_meshes(&mut self) {
        ShapeMeshes::clear(self.app.world_mut());
        // The render world releases them a frame later.
        self.step();
        self.step();
        self.wait();
    }

    /// Runs the first frames without the camera, so that what they cannot show yet costs no drawing. A picture needs several
    /// frames only at the start of its renderer:
    ///
    /// - Bevy asks for its shaders in the first frame, and other threads load them. A pipeline that lacks its shader is set
    ///   back in the frame after, and made in the one after that; nothing is drawn before those for instances are there.
    /// - Cameras take the format of their target from the frame before.
    ///
    /// Meanwhile, meshes and materials go to the GPU. Later, a frame shows everything that it gets itself, see
    /// [`shows_all`](Self::shows_all). Shaders on trial are not waited for: they are tried by the example of a pipeline that
    /// draws.
    fn start(&mut self) -> Result<(), GpuError> {
        // Views switch their cameras themselves.
        if self.on_demand || std::mem::replace(&mut self.started, true) {
            return Ok(());
        }
        self.switch_camera(false);
        let started =
            self.run_until(|this, ready| ready > 0 || this.prepared().is_some() && this.is_trying());
        self.switch_camera(true);
        started
    }

    /// Draws small frames while shaders are tried: trials need a pipeline that draws, so at the start objects have built-in
    /// shaders, whose picture nobody sees. Frames with a part of the samples are cheap as they are.
    fn try_shaders(&mut self) -> Result<(), GpuError> {
        // Views switch their cameras themselves.
        if self.on_demand || !self.is_trying() {
            return Ok(());
        }
        let physical_size = UVec2::from(self.size().map(|side| side.div_ceil(SMALLER)));
        self.set_viewport(Some(Viewport { physical_size, ..default() }));
        let frames = Cell::new(0);
        let tried = self.run_until(|this, ready| {
            // A trial in another process takes longer than many small frames.
            let elsewhere = this.app.world().get_resource::<Bench>().is_some_and(Bench::is_waiting);
            ready > 0 || !elsewhere && frames.replace(frames.get() + 1) == MOST_SMALL
        });
        self.set_viewport(None);
        tried
    }

    fn set_viewport(&mut self, viewport: Option<Viewport>) {
        self.edit_camera(|camera| {
            if let Some(mut camera) = camera.get_mut::<Camera>() {
                camera.viewport = viewport;
            }
        });
    }

    fn switch_camera(&mut self, on: bool) {
        self.edit_camera(|camera| {
            if let Some(mut camera) = camera.get_mut::<Camera>() {
                camera.is_active = on;
            }
        });
    }

    /// Draws frames until nothing is waiting to be loaded or compiled, and the last one has shown all objects.
    fn draw_frames(&mut self) -> Result<(), GpuError> {
        // Views draw two pictures after each change.
        self.run_until(|this, ready| ready == 2 || ready == 1 && !this.on_demand && this.shows_all())?;
        self.wait();
        Ok(())
    }

    /// Runs frames until there are enough, as judged by their number since something was waiting to be loaded or compiled.
    fn run_until(&mut self, are_enough: impl Fn(&mut Self, u32) -> bool) -> Result<(), GpuError> {
        let (mut ready, mut state, mut since) = (0, None, Instant::now());
        while !are_enough(self, ready) {
            let has_target = self.prepared().is_some();
            self.step();
            if self.meshes().is_crowded() {
                self.wait();
            }
            ready = if self.is_waiting()? || !has_target { 0 } else { ready + 1 };
            if self.app.world().get_resource::<Bench>().is_some_and(Bench::is_waiting) {
                // Another process is using the processors for trials.
                std::thread::sleep(Duration::from_millis(2));
            }
            // A software driver may take minutes for large shaders, one after the other.
            let now = Some((ready, self.prepared(), self.made()));
            if state != now {
                (state, since) = (now, Instant::now());
            } else if since.elapsed() > PATIENCE {
                return Err(GpuError::TimedOut { limit: PATIENCE, waiting: self.missing() });
            }
        }
        Ok(())
    }

    /// True if the last frame drew all visible objects. Meshes, materials and pipelines are made before drawing, in this order,
    /// and so serve the frame in which they were asked for. But a material whose buffer is new, too, may come before the buffer:
    /// it is made in the next frame, and so is the pipeline of its objects.
    fn shows_all(&mut self) -> bool {
        let world = self.app.world_mut();
        let mut cameras = world.query::<(Entity, &Camera, &VisibleEntities)>();
        let visible: Vec<_> = cameras
            .iter(world)
            .filter(|(_, camera, _)| camera.is_active)
            .map(|(camera, _, visible)| {
                let view = RetainedViewEntity::new(camera.into(), None, 0);
                (view, visible.get(TypeId::of::<Mesh3d>()).to_vec())
            })
            .collect();
        let Some(render_app) = self.app.get_sub_app(RenderApp) else { return false };
        let Some(made) = render_app.world().get_resource::<SpecializedMaterialPipelineCache>() else {
            return false;
        };
        visible.iter().all(|(view, objects)| {
            let made = made.get(view);
            let is_made =
                |object: &Entity| made.is_some_and(|made| made.contains_key(&MainEntity::from(*object)));
            objects.iter().all(is_made)
        })
    }

    /// The number of pipelines that are compiled.
    fn made(&self) -> usize {
        let Some(render_app) = self.app.get_sub_app(RenderApp) else { return 0 };
        let pipelines = render_app.world().resource::<PipelineCache>().pipelines();
        pipelines.filter(|p| matches!(p.state, CachedPipelineState::Ok(_))).count()
    }

    /// The part that is not ready yet, for an error.
    fn missing(&self) -> String {
        if self.app.world().get_resource::<LiveShaders>().is_some_and(LiveShaders::is_trying) {
            return "the trial of a shader".to_owned();
        }
        let Some(render_app) = self.app.get_sub_app(RenderApp) else { return "the renderer".to_owned() };
        let cache = render_app.world().resource::<PipelineCache>();
        let label = |pipeline: &CachedPipeline| match &pipeline.descriptor {
            PipelineDescriptor::RenderPipelineDescriptor(of) => of.label.clone(),
            PipelineDescriptor::ComputePipelineDescriptor(of) => of.label.clone(),
        };
        let waiting = cache.waiting_pipelines().filter_map(|id| cache.pipelines().nth(id));
        let names: Vec<_> = waiting.filter_map(|p| Some(format!("`{}`", label(p)?))).take(3).collect();
        if names.is_empty() { "shapes and pictures".to_owned() } else { names.join(", ") }
    }

    /// The numbers of meshes, materials and images on the GPU; `None` before the target is there.
    fn prepared(&self) -> Option<[usize; 3]> {
        let world = self.app.get_sub_app(RenderApp)?.world();
        let images = world.resource::<RenderAssets<GpuImage>>();
        images.get(&self.target)?;
        Some([
            world.resource::<RenderAssets<RenderMesh>>().iter().count(),
            world.resource::<ErasedRenderAssets<PreparedMaterial>>().iter().count(),
            images.iter().count(),
        ])
    }

    /// True while something waits to be loaded or compiled.
    pub(super) fn is_waiting(&self) -> Result<bool, GpuError> {
        let Some(render_app) = self.app.get_sub_app(RenderApp) else { return Ok(false) };
        let cache = render_app.world().resource::<PipelineCache>();
        for pipeline in cache.pipelines() {
            if let CachedPipelineState::Err(error) = &pipeline.state
                && !matches!(
                    error,
                    ShaderCacheError::ShaderNotLoaded(_) | ShaderCacheError::ShaderImportNotYetAvailable
                )
            {
                return Err(GpuError::Shader(error.to_string()));
            }
        }
        // Bevy still lists a pipeline for one frame after creating it.
        let made =
            |id| matches!(cache.pipelines().nth(id).map(|p| &p.state), Some(CachedPipelineState::Ok(_)));
        Ok(self.is_trying() || !cache.waiting_pipelines().all(made))
    }

    /// True while shaders are tried before they are drawn with.
    fn is_trying(&self) -> bool {
        self.app.world().get_resource::<LiveShaders>().is_some_and(LiveShaders::is_trying)
    }

    /// The reason why shapes are missing in the picture, if any.
    fn refused(&self) -> Option<String> {
        self.meshes().problem()
    }

    pub(super) fn edit_camera(&mut self, change: impl FnOnce(&mut EntityWorldMut)) {
        let world = self.app.world_mut();
        let mut cameras = world.query_filtered::<Entity, With<PictureCamera>>();
        if let Some(camera) = cameras.iter(world).next() {
            change(&mut world.entity_mut(camera));
        }
    }
}

/// Sets the background of a camera; without one it draws over the existing picture.
pub(super) fn set_background(camera: &mut EntityWorldMut, background: ClearColorConfig) {
    if let Some(mut lens) = camera.get_mut::<Camera3d>() {
        lens.depth_load_op = match background {
            ClearColorConfig::None => Camera3dDepthLoadOp::Load,
            _ => Camera3dDepthLoadOp::default(),
        };
    }
    if let Some(mut camera) = camera.get_mut::<Camera>() {
        camera.clear_color = background;
    }
}
