//! Views in the window: their textures are copied to their positions, and the panels are drawn over them in
//! one pass. Until they are ready, the window has one colour.

use bevy::{
    core_pipeline::{Core2d, Core2dSystems},
    prelude::*,
    render::{
        Render, RenderApp, RenderSystems,
        extract_component::{ExtractComponent, ExtractComponentPlugin},
        render_asset::RenderAssets,
        render_resource::{
            CommandEncoderDescriptor, Extent3d, LoadOp, Operations, Origin3d, RenderPassColorAttachment,
            RenderPassDescriptor, StoreOp, TexelCopyTextureInfo, Texture,
        },
        renderer::{RenderContext, RenderDevice, RenderQueue, ViewQuery},
        texture::GpuImage,
        view::{ExtractedWindows, ViewTarget},
    },
};

/// Shows pictures as given by [`Shows`].
#[derive(Clone, Copy, Debug, Default)]
pub struct ShowPlugin;

impl Plugin for ShowPlugin {
    fn build(&self, app: &mut App) {
        app.add_plugins(ExtractComponentPlugin::<Shows>::default());
        if let Some(render) = app.get_sub_app_mut(RenderApp) {
            render
                .add_systems(
                    Core2d,
                    copy.after(Core2dSystems::MainPass).before(bevy_egui::render::prepare_egui_pass),
                )
                .add_systems(Render, clear_first.in_set(RenderSystems::PrepareResources));
        }
    }
}

/// The pictures that a camera of a window shows. The camera's textures need the usage `COPY_DST`.
#[derive(Component, ExtractComponent, Clone, Debug, Default, PartialEq, Eq)]
pub struct Shows(pub Vec<ShownPicture>);

/// A picture, or a part of one, in a window.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ShownPicture {
    /// The picture.
    pub image: Handle<Image>,
    /// Position of its upper left corner in the window, in pixels.
    pub at: UVec2,
    /// The part of the picture to show, in its pixels; `None` for all of it.
    pub part: Option<URect>,
}

/// A texture from a pixel on.
fn from(texture: &Texture, UVec2 { x, y }: UVec2) -> TexelCopyTextureInfo<'_> {
    TexelCopyTextureInfo { origin: Origin3d { x, y, z: 0 }, ..texture.as_image_copy() }
}

fn copy(
    view: ViewQuery<(&ViewTarget, &Shows)>,
    images: Res<RenderAssets<GpuImage>>,
    mut context: RenderContext,
) {
    let (target, shows) = view.into_inner();
    let window = target.main_texture();
    for ShownPicture { image, at, part } in &shows.0 {
        let Some(image) = images.get(image) else { continue };
        if image.texture.format() != window.format() {
            error_once!(
                "The picture cannot be shown: the window's format is {:?} and the picture's {:?}",
                window.format(),
                image.texture.format()
            );
            continue;
        }
        let whole = UVec2::new(image.texture.width(), image.texture.height());
        let part = part.unwrap_or(URect { min: UVec2::ZERO, max: whole });
        let at = *at + part.min;
        let room = UVec2::new(window.width(), window.height()).saturating_sub(at);
        let size = part.max.min(whole).saturating_sub(part.min).min(room);
        if size.min_element() == 0 {
            continue;
        }
        context.command_encoder().copy_texture_to_texture(
            from(&image.texture, part.min),
            from(window, at),
            Extent3d { width: size.x, height: size.y, depth_or_array_layers: 1 },
        );
    }
}

/// Clears a window that is presented for the first time. Its cameras draw nothing before their shaders are compiled, but
/// Bevy presents it, as Wayland demands: it would show whatever is in the memory until the next frame.
fn clear_first(
    windows: Res<ExtractedWindows>,
    colour: Res<ClearColor>,
    device: Res<RenderDevice>,
    queue: Res<RenderQueue>,
) {
    for window in windows.values().filter(|window| window.needs_initial_present) {
        let Some(view) = &window.swap_chain_texture_view else { continue };
        let ops = Operations { load: LoadOp::Clear(colour.0.to_linear().into()), store: StoreOp::Store };
        let attachment = RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops };
        let mut encoder = device.create_command_encoder(&CommandEncoderDescriptor::default());
        drop(encoder.begin_render_pass(&RenderPassDescriptor {
            label: Some("empty window"),
            color_attachments: &[Some(attachment)],
            depth_stencil_attachment: None,
            timestamp_writes: None,
            occlusion_query_set: None,
            multiview_mask: None,
        }));
        queue.submit([encoder.finish()]);
    }
}
