//! The background that a scene gives, in place of the colour with which cameras clear their pictures.
//!
//! It is painted before the objects. As the display is to show the colours as they are picked, the tone curve must not
//! change them: where there is a curve, a pass before it takes the background out of the pixels at edges, and a pass after
//! it puts the background back. Both know from the depths how much of a pixel shows something; lights at infinity, which
//! have no depth, are not shown before such a background.

use std::collections::HashMap;

use bevy::{
    camera::Viewport,
    core_pipeline::{
        Core3d, Core3dSystems,
        core_3d::main_opaque_pass_3d,
        tonemapping::{Tonemapping, tonemapping},
    },
    ecs::schedule::ScheduleLabel as _,
    prelude::*,
    render::{
        Extract, Render, RenderApp, RenderSystems,
        camera::ExtractedCamera,
        render_resource::{
            binding_types::{
                texture_2d, texture_depth_2d, texture_depth_2d_multisampled, uniform_buffer_sized,
            },
            *,
        },
        renderer::{RenderContext, RenderDevice, ViewQuery},
        sync_world::RenderEntity,
        view::{ViewDepthTexture, ViewTarget},
    },
};

use super::{
    camera::PictureCamera,
    entities::CurrentScene,
    mean::MeanSystems,
    overrides::Overrides,
    pass::Cover,
    straight::{self, Layer, Straight, cleared, draw_layer},
    view::View,
};
use crate::shader::wgsl;

/// Draws the background that the scene gives.
pub(super) fn plugin(app: &mut App) {
    let Some(render) = app.get_sub_app_mut(RenderApp) else { return };
    render
        .add_systems(ExtractSchedule, extract)
        .add_systems(Render, reveal.in_set(RenderSystems::PrepareViews))
        .add_systems(Straight, paint.before(straight::draw))
        .add_systems(Layer, paint.before(draw_layer))
        .add_systems(
            Core3d,
            (
                paint.in_set(Core3dSystems::MainPass).before(main_opaque_pass_3d),
                lift.after(Core3dSystems::MainPass).after(MeanSystems).before(tonemapping),
                put.in_set(BackdropSystems).in_set(Core3dSystems::PostProcess).after(tonemapping),
            ),
        );
}

/// The pass that puts a background behind the tone-mapped picture.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct BackdropSystems;

/// The background of a view.
#[derive(Component, Clone, Copy, Debug, PartialEq)]
struct Backdrop {
    /// At the upper and at the lower edge, sRGB-encoded.
    colours: [[u8; 3]; 2],
    /// The first row of the picture that the observer sees, and the number of its rows; `None` if it is all of it.
    rows: Option<[f32; 2]>,
}

impl Backdrop {
    /// The bytes of `Backdrop` in the shader.
    fn bytes(self, camera: &ExtractedCamera, target: &ViewTarget) -> Vec<u8> {
        let [top, bottom] = self.colours.map(|rgb| {
            let [r, g, b] = rgb.map(|code| f32::from(code) / 255.0);
            [r, g, b, 0.0]
        });
        let viewport = camera.viewport.as_ref();
        let own = viewport.map(|v| [v.physical_position.y as f32, v.physical_size.y as f32]);
        let whole = [0.0, target.main_texture().size().height as f32];
        let [first, count] = self.rows.or(own).unwrap_or(whole);
        let numbers = [top, bottom, [first, count.max(1.0), 0.0, 0.0]];
        numbers.as_flattened().iter().flat_map(|v| v.to_le_bytes()).collect()
    }

    /// The uniform buffer with these.
    fn buffer(self, camera: &ExtractedCamera, target: &ViewTarget, device: &RenderDevice) -> Buffer {
        device.create_buffer_with_data(&BufferInitDescriptor {
            label: Some("background"),
            contents: &self.bytes(camera, target),
            usage: BufferUsages::UNIFORM,
        })
    }
}

fn extract(
    cameras: Extract<Query<(RenderEntity, Option<&View>, Option<&Overrides>), With<PictureCamera>>>,
    scene: Extract<Res<CurrentScene>>,
    known: Query<(), With<Backdrop>>,
    mut commands: Commands,
) {
    for (camera, view, overrides) in &cameras {
        let display = overrides.map_or(scene.0.display, |overrides| overrides.seen_through(&scene.0));
        if let Some(colours) = display.backdrop() {
            let inset = view.and_then(|view| view.inset);
            let rows = inset.map(|inset| [inset.min.y as f32, inset.height() as f32]);
            commands.entity(camera).insert(Backdrop { colours, rows });
        } else if known.contains(camera) {
            commands.entity(camera).remove::<Backdrop>();
        }
    }
}

/// Lets the passes around the tone curve read the depths.
fn reveal(mut cameras: Query<(&mut Camera3d, &Tonemapping), With<Backdrop>>) {
    for (mut camera, tone) in &mut cameras {
        if *tone != Tonemapping::None {
            let known = TextureUsages::from(camera.depth_texture_usages);
            camera.depth_texture_usages = (known | TextureUsages::TEXTURE_BINDING).into();
        }
    }
}

/// Passes by the format of their target and the samples of a pixel: in the target, or in the depths that they read.
type Passes = HashMap<(TextureFormat, u32), Cover>;

/// The shader of the passes, for depths with so many samples.
fn text(samples: u32) -> String {
    let kind = if samples > 1 { "texture_depth_multisampled_2d" } else { "texture_depth_2d" };
    let own = include_str!("backdrop.wgsl").replace("DEPTHS", kind).replace("SAMPLES", &samples.to_string());
    format!("{}{own}", wgsl!("terms.wgsl").text)
}

/// The pass of an entry point of the shader, into a target with so many samples in a pixel. The depths that it reads have
/// `depths` samples.
fn pass(
    entry: &'static str,
    (format, samples): (TextureFormat, u32),
    depths: u32,
    entries: &[BindGroupLayoutEntry],
    device: &RenderDevice,
) -> Cover {
    Cover::new(device, "background", (text(depths).into(), entry), entries, (&[format], samples))
}

/// Runs the pass over a target, or over the part of it that a camera draws into.
fn run(
    cover: &Cover,
    group: &BindGroup,
    target: RenderPassColorAttachment,
    part: Option<&Viewport>,
    encoder: &mut CommandEncoder,
) {
    let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
        label: Some("background"),
        color_attachments: &[Some(target)],
        depth_stencil_attachment: None,
        timestamp_writes: None,
        occlusion_query_set: None,
        multiview_mask: None,
    });
    if let Some(Viewport { physical_position: at, physical_size: size, .. }) = part {
        let [x, y, width, height] = [at.x, at.y, size.x, size.y].map(|v| v as f32);
        pass.set_viewport(x, y, width, height, 0.0, 1.0);
    }
    pass.set_pipeline(&cover.pipeline);
    pass.set_bind_group(0, &**group, &[]);
    pass.draw(0..3, 0..1);
}

/// Paints the background, before anything else is drawn.
fn paint(
    view: ViewQuery<(&ExtractedCamera, &ViewTarget, &Backdrop)>,
    usual: Res<ClearColor>,
    device: Res<RenderDevice>,
    mut passes: Local<Passes>,
    mut context: RenderContext,
) {
    let (camera, target, backdrop) = view.into_inner();
    // A picture that is drawn over has it already.
    let Some(clear) = cleared(camera, &usual) else { return };
    let (attachment, kind) = if camera.schedule == Straight.intern() {
        let out = target.out_texture_color_attachment(Some(clear));
        let Some((attachment, format)) = out.zip(target.out_texture_view_format()) else { return };
        (attachment, (format, 1))
    } else {
        let samples = target.sampled_main_texture().map_or(1, |texture| texture.sample_count());
        (target.get_color_attachment(), (target.main_texture_format(), samples))
    };
    let cover = passes.entry(kind).or_insert_with(|| {
        let entries =
            BindGroupLayoutEntries::single(ShaderStages::FRAGMENT, uniform_buffer_sized(false, None));
        pass("paint", kind, 1, &entries, &device)
    });
    let uniform = backdrop.buffer(camera, target, &device);
    let entries = BindGroupEntries::single(uniform.as_entire_buffer_binding());
    let group = device.create_bind_group("background", &cover.bindings, &entries);
    run(cover, &group, attachment, camera.viewport.as_ref(), context.command_encoder());
}

/// The components of a view used by the passes around the tone curve.
type Parts = (
    &'static ExtractedCamera,
    &'static ViewTarget,
    &'static ViewDepthTexture,
    &'static Tonemapping,
    &'static Backdrop,
);

/// Takes the background out of the pixels in which something else is seen as well.
fn lift(
    view: ViewQuery<Parts>,
    device: Res<RenderDevice>,
    mut passes: Local<Passes>,
    mut context: RenderContext,
) {
    let parts = view.into_inner();
    // A pixel with one sample shows one or the other.
    if parts.2.texture.sample_count() > 1 {
        around("lift", parts, &device, &mut passes, &mut context);
    }
}

/// Puts the background behind the tone-mapped picture.
fn put(
    view: ViewQuery<Parts>,
    device: Res<RenderDevice>,
    mut passes: Local<Passes>,
    mut context: RenderContext,
) {
    around("put", view.into_inner(), &device, &mut passes, &mut context);
}

/// A pass before or after the tone curve, if the view has one.
fn around(
    entry: &'static str,
    (camera, target, depth, tone, backdrop): (
        &ExtractedCamera,
        &ViewTarget,
        &ViewDepthTexture,
        &Tonemapping,
        &Backdrop,
    ),
    device: &RenderDevice,
    passes: &mut Passes,
    context: &mut RenderContext,
) {
    if *tone == Tonemapping::None || !camera.hdr {
        return;
    }
    let (format, depths) = (target.main_texture_format(), depth.texture.sample_count());
    let cover = passes.entry((format, depths)).or_insert_with(|| {
        let of_depths = if depths > 1 { texture_depth_2d_multisampled() } else { texture_depth_2d() };
        let picture = texture_2d(TextureSampleType::Float { filterable: false });
        let entries = (uniform_buffer_sized(false, None), picture, of_depths);
        let entries = BindGroupLayoutEntries::sequential(ShaderStages::FRAGMENT, entries);
        pass(entry, (format, 1), depths, &entries, device)
    });
    let uniform = backdrop.buffer(camera, target, device);
    let written = target.post_process_write();
    let entries =
        BindGroupEntries::sequential((uniform.as_entire_buffer_binding(), written.source, depth.view()));
    let group = device.create_bind_group("background", &cover.bindings, &entries);
    let attachment = RenderPassColorAttachment {
        view: written.destination,
        depth_slice: None,
        resolve_target: None,
        ops: Operations { load: LoadOp::Clear(Default::default()), store: StoreOp::Store },
    };
    run(cover, &group, attachment, None, context.command_encoder());
}

#[cfg(test)]
mod tests {
    use naga::valid::{Capabilities, ValidationFlags, Validator};

    #[test]
    fn the_shader_is_valid_for_depths_with_one_sample_and_with_several() {
        for samples in [1, 4] {
            let text = super::text(samples);
            let module =
                naga::front::wgsl::parse_str(&text).unwrap_or_else(|e| panic!("{}", e.emit_to_string(&text)));
            let valid = Validator::new(ValidationFlags::all(), Capabilities::all()).validate(&module);
            assert!(valid.is_ok(), "{samples}: {valid:?}");
        }
    }
}
