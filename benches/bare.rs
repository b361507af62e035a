//! The driver's own time for ten thousand spheres: a frame of the lab, alternating with a bare draw of the
//! same triangles from the same position, whose vertex shader is one matrix and whose pixels are white.
//! Medians of one run, waiting for each frame, with one sample and with four.

use std::{sync::Arc, time::Instant};

use bevy::render::{
    render_resource::{PollType, TextureFormat},
    renderer::{RenderDevice, RenderQueue},
};
use glam::{Mat4, Vec3};
use lights_camera_models::{
    parameter::Values,
    registry::Registry,
    render::capture::gpu::{GpuRenderer, Output},
    scene::{Light, Object, Observer, Scene, observer},
    shape::PolygonMesh,
};
use wgpu::util::DeviceExt as _;

const SIZE: (u32, u32) = (1280, 720);
const COUNT: usize = 10_000;
const ROUNDS: usize = 5;

fn main() {
    println!("{:<44} {:>9} {:>9} {:>6}", "10 000 spheres, 1280×720, medians", "lab", "bare", "ratio");
    for (lights, what) in [(1, "one light"), (256, "256 lights")] {
        for samples in [1, 4] {
            let scene = grid(lights);
            let mut lab =
                GpuRenderer::new(SIZE.0, SIZE.1, samples, Output::Display).expect("a Vulkan driver");
            lab.set_scene(scene.clone());
            lab.settle().expect("the GPU draws");
            let bare = Bare::new(&mut lab, &scene, u32::from(samples));
            let mut times = [Vec::new(), Vec::new()];
            for _ in 0..ROUNDS {
                times[0].push(timed(|| {
                    lab.step();
                    lab.wait();
                }));
                times[1].push(timed(|| bare.draw()));
            }
            let [lab, bare] = times.map(|mut times| {
                times.sort_by(f64::total_cmp);
                times[times.len() / 2]
            });
            let what = format!("{what}, samples: {samples}");
            println!("{what:<44} {lab:>6.0} ms {bare:>6.0} ms {:>6.2}", lab / bare);
        }
    }
}

fn timed(work: impl FnOnce()) -> f64 {
    let begin = Instant::now();
    work();
    begin.elapsed().as_secs_f64() * 1e3
}

/// Spheres with the default tessellation side by side, all in the picture.
fn grid(lights: usize) -> Scene {
    let side = (COUNT as f32).sqrt();
    let object = |i: usize| {
        let (x, y) = (i as f32 % side, (i as f32 / side).floor());
        let position = Vec3::new((x + 0.5) * 10.0 / side, (y + 0.5) * 10.0 / side, 1.0);
        Object { position, size: 8.0 / side, ..Object::default() }
    };
    let light = |i: usize| Light {
        position: Some(Vec3::new(1.0 + i as f32 * 0.03, 8.0, 8.0)),
        intensity: 30.0 / lights as f32,
        ..Light::default()
    };
    let position = Vec3::new(5.0, 5.0, 9.9);
    Scene {
        objects: (0..COUNT).map(object).collect(),
        lights: (0..lights).map(light).collect(),
        observer: Observer { position, field_of_view: 60.0, ..Observer::default() },
        ..Scene::default()
    }
}

const SHADER: &str = "
@group(0) @binding(0) var<uniform> clip_from_world: mat4x4<f32>;
@vertex fn vertex(@location(0) vertex: vec3<f32>, @location(1) place: vec4<f32>) -> @builtin(position) vec4<f32> {
    return clip_from_world * vec4(place.xyz + place.w * vertex, 1.0);
}
@fragment fn fragment() -> @location(0) vec4<f32> { return vec4(1.0); }
";

/// The triangles drawn without the rest of the lab.
struct Bare {
    device: RenderDevice,
    queue: RenderQueue,
    pipeline: wgpu::RenderPipeline,
    group: wgpu::BindGroup,
    vertices: wgpu::Buffer,
    places: wgpu::Buffer,
    indices: wgpu::Buffer,
    count: u32,
    colour: wgpu::TextureView,
    resolved: Option<wgpu::TextureView>,
    depth: wgpu::TextureView,
}

impl Bare {
    fn new(lab: &mut GpuRenderer, scene: &Scene, samples: u32) -> Self {
        let world = lab.app().world();
        let (device, queue) =
            (world.resource::<RenderDevice>().clone(), world.resource::<RenderQueue>().clone());
        let wgpu = device.wgpu_device();
        let registry = Registry::builtin();
        let sphere = registry.shape("sphere").expect("built in");
        let mesh: Arc<PolygonMesh> = Arc::new(sphere.mesh(&Values::default(), sphere.tessellation(None)));
        let indices: Vec<u32> = mesh.triangles().flat_map(|(_, corners)| corners).collect();
        let buffer = |contents: Vec<u8>, usage| {
            wgpu.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: None,
                contents: &contents,
                usage,
            })
        };
        let floats = |numbers: &[f32]| numbers.iter().flat_map(|n| n.to_le_bytes()).collect::<Vec<u8>>();
        let places: Vec<f32> =
            scene.objects.iter().flat_map(|o| [o.position.x, o.position.y, o.position.z, o.size]).collect();
        let positions: Vec<f32> = mesh.positions.iter().flat_map(|p| p.to_array()).collect();
        let eye = &scene.observer;
        let world_from_view =
            Mat4::from_rotation_translation(observer::rotation(eye.direction), eye.position);
        let aspect = SIZE.0 as f32 / SIZE.1 as f32;
        let lens = Mat4::perspective_infinite_reverse_rh(eye.field_of_view.to_radians(), aspect, 0.1);
        let matrix =
            buffer(floats(&(lens * world_from_view.inverse()).to_cols_array()), wgpu::BufferUsages::UNIFORM);

        let module = wgpu.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: None,
            source: wgpu::ShaderSource::Wgsl(SHADER.into()),
        });
        let attributes = [
            wgpu::vertex_attr_array![0 => Float32x3].to_vec(),
            wgpu::vertex_attr_array![1 => Float32x4].to_vec(),
        ];
        let layout = |i: usize, step_mode| wgpu::VertexBufferLayout {
            array_stride: [12, 16][i],
            step_mode,
            attributes: &attributes[i],
        };
        let format = TextureFormat::Rgba8UnormSrgb;
        let pipeline = wgpu.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: None,
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: None,
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: &[
                    layout(0, wgpu::VertexStepMode::Vertex),
                    layout(1, wgpu::VertexStepMode::Instance),
                ],
            },
            primitive: wgpu::PrimitiveState {
                cull_mode: Some(wgpu::Face::Back),
                ..wgpu::PrimitiveState::default()
            },
            depth_stencil: Some(wgpu::DepthStencilState {
                format: TextureFormat::Depth32Float,
                depth_write_enabled: Some(true),
                depth_compare: Some(wgpu::CompareFunction::GreaterEqual),
                stencil: wgpu::StencilState::default(),
                bias: wgpu::DepthBiasState::default(),
            }),
            multisample: wgpu::MultisampleState { count: samples, ..wgpu::MultisampleState::default() },
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: None,
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                targets: &[Some(format.into())],
            }),
            multiview_mask: None,
            cache: None,
        });
        let group = wgpu.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &pipeline.get_bind_group_layout(0),
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: matrix.as_entire_binding() }],
        });
        let texture = |format, sample_count| {
            let texture = wgpu.create_texture(&wgpu::TextureDescriptor {
                label: None,
                size: wgpu::Extent3d { width: SIZE.0, height: SIZE.1, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
                view_formats: &[],
            });
            texture.create_view(&wgpu::TextureViewDescriptor::default())
        };
        Self {
            vertices: buffer(floats(&positions), wgpu::BufferUsages::VERTEX),
            places: buffer(floats(&places), wgpu::BufferUsages::VERTEX),
            indices: buffer(
                indices.iter().flat_map(|i| i.to_le_bytes()).collect(),
                wgpu::BufferUsages::INDEX,
            ),
            count: indices.len() as u32,
            colour: texture(format, samples),
            resolved: (samples > 1).then(|| texture(format, 1)),
            depth: texture(TextureFormat::Depth32Float, samples),
            pipeline,
            group,
            device,
            queue,
        }
    }

    fn draw(&self) {
        let mut encoder =
            self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("bare") });
        {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &self.colour,
                    depth_slice: None,
                    resolve_target: self.resolved.as_ref(),
                    ops: wgpu::Operations::default(),
                })],
                depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                    view: &self.depth,
                    depth_ops: Some(wgpu::Operations {
                        load: wgpu::LoadOp::Clear(0.0),
                        store: wgpu::StoreOp::Discard,
                    }),
                    stencil_ops: None,
                }),
                ..wgpu::RenderPassDescriptor::default()
            });
            pass.set_pipeline(&self.pipeline);
            pass.set_bind_group(0, &self.group, &[]);
            pass.set_vertex_buffer(0, self.vertices.slice(..));
            pass.set_vertex_buffer(1, self.places.slice(..));
            pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint32);
            pass.draw_indexed(0..self.count, 0, 0..COUNT as u32);
        }
        self.queue.submit([encoder.finish()]);
        let _ = self.device.poll(PollType::wait_indefinitely());
    }
}
