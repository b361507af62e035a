//! Views in the window: their textures are copied to their positions, and the panels are drawn over them in
//! one pass.

use bevy::{
    core_pipeline::{Core2d, Core2dSystems},
    prelude::*,
    render::{
        RenderApp,
        extract_component::{ExtractComponent, ExtractComponentPlugin},
        render_asset::RenderAssets,
        render_resource::{Extent3d, Origin3d, TexelCopyTextureInfo, Texture},
        renderer::{RenderContext, ViewQuery},
        texture::GpuImage,
        view::ViewTarget,
    },
};

/// Shows pictures as given by [`Shows`].
#[derive(Clone, Copy, Debug, Default)]
pub struct ShowPlugin;

impl Plugin for ShowPlugin {
    fn build(&self, app: &mut App) {
        app.add_plugins(ExtractComponentPlugin::<Shows>::default());
        if let Some(render) = app.get_sub_app_mut(RenderApp) {
            render.add_systems(
                Core2d,
                copy.after(Core2dSystems::MainPass).before(bevy_egui::render::prepare_egui_pass),
            );
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
