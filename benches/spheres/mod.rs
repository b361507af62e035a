//! Ten thousand spheres as a scene, and drawn bare: the same triangles from the same position without the rest of
//! the lab, which is the driver's own time for them.

use std::ops::Range;

use bevy::render::{
    render_resource::{PollType, TextureFormat},
    renderer::{RenderDevice, RenderQueue},
};
use glam::{Mat4, Vec3};
use lights_camera_models::{
    parameter::Values,
    registry::Registry,
    scene::{Light, Object, Observer, Scene, observer},
};
use wgpu::util::DeviceExt as _;

/// Width and height of the picture.
pub const SIZE: (u32, u32) = (1280, 720);
const COUNT: u32 = 10_000;

/// Spheres with the default tessellation side by side, all in the picture.
pub fn grid(lights: usize) -> Scene {
    let side = (COUNT as f32).sqrt();
    let object = |i: u32| {
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

/// Asserts that about a third of a picture differs from its first pixel, as the spheres cover it. A pixel has so many
/// bytes.
pub fn assert_drawn(picture: &[u8], pixel: usize) {
    let background = &picture[..pixel];
    let covered = picture.chunks_exact(pixel).filter(|bytes| *bytes != background).count();
    let share = covered as f32 * pixel as f32 / picture.len() as f32;
    assert!((0.2..0.5).contains(&share), "{share} of the picture differ from the background");
}

/// What draws the triangles of the scene.
pub struct Bare {
    device: RenderDevice,
    queue: RenderQueue,
    pipeline: wgpu::RenderPipeline,
    group: wgpu::BindGroup,
    vertices: wgpu::Buffer,
    places: wgpu::Buffer,
    indices: wgpu::Buffer,
    /// The number of indices of a sphere.
    corners: u32,
    picture: wgpu::Texture,
    /// The view of the picture, and of its samples if there are several.
    colour: wgpu::TextureView,
    samples: Option<wgpu::TextureView>,
    depth: wgpu::TextureView,
}

impl Bare {
    /// The WGSL in `shader` has the entry points of a vertex and of a fragment. A vertex has its position and normal as
    /// inputs 0 and 1, and the position and size of its sphere as input 2.
    pub fn new(device: RenderDevice, queue: RenderQueue, scene: &Scene, shader: &str, samples: u32) -> Self {
        let wgpu = device.wgpu_device();
        let registry = Registry::builtin();
        let sphere = registry.shape("sphere").expect("built in");
        let mesh = sphere.mesh(&Values::default(), sphere.tessellation(None));
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
        let normals = mesh.vertex_normals();
        let vertices: Vec<f32> = mesh
            .positions
            .iter()
            .zip(&normals)
            .flat_map(|(p, n)| [p.to_array(), n.to_array()])
            .flatten()
            .collect();
        let eye = &scene.observer;
        let world_from_view =
            Mat4::from_rotation_translation(observer::rotation(eye.direction), eye.position);
        let aspect = SIZE.0 as f32 / SIZE.1 as f32;
        let lens = Mat4::perspective_infinite_reverse_rh(eye.field_of_view.to_radians(), aspect, 0.1);
        let matrix =
            buffer(floats(&(lens * world_from_view.inverse()).to_cols_array()), wgpu::BufferUsages::UNIFORM);

        let module = wgpu.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: None,
            source: wgpu::ShaderSource::Wgsl(shader.into()),
        });
        let attributes = [
            wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3].to_vec(),
            wgpu::vertex_attr_array![2 => Float32x4].to_vec(),
        ];
        let layout = |i: usize, step_mode| wgpu::VertexBufferLayout {
            array_stride: [24, 16][i],
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
        let texture = |format, sample_count, usage| {
            wgpu.create_texture(&wgpu::TextureDescriptor {
                label: None,
                size: wgpu::Extent3d { width: SIZE.0, height: SIZE.1, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT | usage,
                view_formats: &[],
            })
        };
        let drawn = |format, sample_count| {
            let texture = texture(format, sample_count, wgpu::TextureUsages::empty());
            texture.create_view(&wgpu::TextureViewDescriptor::default())
        };
        let picture = texture(format, 1, wgpu::TextureUsages::COPY_SRC);
        Self {
            vertices: buffer(floats(&vertices), wgpu::BufferUsages::VERTEX),
            places: buffer(floats(&places), wgpu::BufferUsages::VERTEX),
            indices: buffer(
                indices.iter().flat_map(|i| i.to_le_bytes()).collect(),
                wgpu::BufferUsages::INDEX,
            ),
            corners: indices.len() as u32,
            colour: picture.create_view(&wgpu::TextureViewDescriptor::default()),
            samples: (samples > 1).then(|| drawn(format, samples)),
            depth: drawn(TextureFormat::Depth32Float, samples),
            picture,
            pipeline,
            group,
            device,
            queue,
        }
    }

    /// Draws the spheres in passes of at most so many triangles, each over the colours and depths of those
    /// before. Waits for the last one, or for each.
    pub fn draw(&self, most_triangles: u64, each: bool) {
        let most = (most_triangles / u64::from(self.corners / 3)).clamp(1, u64::from(COUNT)) as u32;
        for first in (0..COUNT).step_by(most as usize) {
            let end = (first + most).min(COUNT);
            self.draw_some(first..end);
            if each || end == COUNT {
                self.wait();
            }
        }
    }

    fn draw_some(&self, spheres: Range<u32>) {
        let (is_first, is_last) = (spheres.start == 0, spheres.end == COUNT);
        let mut encoder = self.encoder();
        {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: self.samples.as_ref().unwrap_or(&self.colour),
                    depth_slice: None,
                    resolve_target: self.samples.as_ref().filter(|_| is_last).map(|_| &self.colour),
                    ops: wgpu::Operations {
                        load: if is_first {
                            wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT)
                        } else {
                            wgpu::LoadOp::Load
                        },
                        store: wgpu::StoreOp::Store,
                    },
                })],
                depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                    view: &self.depth,
                    depth_ops: Some(wgpu::Operations {
                        load: if is_first { wgpu::LoadOp::Clear(0.0) } else { wgpu::LoadOp::Load },
                        store: if is_last { wgpu::StoreOp::Discard } else { wgpu::StoreOp::Store },
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
            pass.draw_indexed(0..self.corners, 0, spheres);
        }
        self.queue.submit([encoder.finish()]);
    }

    /// Asserts that the last picture shows the spheres.
    pub fn check(&self) {
        let staging = self.device.wgpu_device().create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: u64::from(4 * SIZE.0 * SIZE.1),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let layout =
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * SIZE.0), rows_per_image: None };
        let mut encoder = self.encoder();
        encoder.copy_texture_to_buffer(
            self.picture.as_image_copy(),
            wgpu::TexelCopyBufferInfo { buffer: &staging, layout },
            self.picture.size(),
        );
        self.queue.submit([encoder.finish()]);
        staging.map_async(wgpu::MapMode::Read, .., |mapped| mapped.expect("the picture can be read"));
        self.wait();
        assert_drawn(&staging.get_mapped_range(..), 4);
    }

    fn encoder(&self) -> wgpu::CommandEncoder {
        self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("bare") })
    }

    fn wait(&self) {
        let _ = self.device.poll(PollType::wait_indefinitely());
    }
}
