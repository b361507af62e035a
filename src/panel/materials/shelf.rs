//! What the panel shows: the materials, read by a thread, and their pictures, drawn by another one, each once.

use std::time::Duration;

use bevy_egui::egui::{ColorImage, TextureHandle, TextureOptions};
use web_time::Instant;

use super::super::{
    gallery::{Gallery, Wanted},
    prelude::*,
};
use crate::{caught::catch, materials::Material, reference};

/// Pixels across a picture.
const SIDE: u32 = 128;
/// Maximum time for a picture.
const PATIENCE: Duration = Duration::from_secs(10);

/// The picture of a material.
#[derive(Clone)]
pub(super) enum Picture {
    Waiting,
    Ready(TextureHandle),
    /// There is none, for this reason.
    Failed(Arc<str>),
}

/// The picture of a material. Models whose files were reloaded are drawn again.
pub(super) fn picture(ctx: &Context, material: &Material, session: &Session, registry: &Registry) -> Picture {
    let id = &material.reflection_model;
    let mut key = format!("{id} {:?}", material.material);
    if registry.custom_file(id).is_some() {
        if registry.unread_file(id).is_some() {
            return Picture::Failed("The picture is drawn once an object has had this custom model.".into());
        }
        key += &format!("{:?}", session.shaders.last);
    }
    let wanted = || Wanted { job: material.clone(), waiting: Picture::Waiting, is_urgent: false };
    Gallery::of(ctx, &key, wanted, || {
        let registry = registry.clone();
        move |ctx: &Context, material: Material| {
            let drawn = catch(|| draw(&material, &registry))
                .unwrap_or_else(|_| Err("It cannot be drawn.".to_owned()));
            match drawn {
                Ok(image) => Picture::Ready(ctx.load_texture("material", image, TextureOptions::LINEAR)),
                Err(why) => Picture::Failed(why.into()),
            }
        }
    })
}

fn draw(material: &Material, registry: &Registry) -> Result<ColorImage, String> {
    if let Some((_, why)) = reference::not_on_cpu(&material.scene(registry), registry) {
        return Err(format!("The CPU renderer cannot draw it: {why}."));
    }
    let pixels = material.picture(SIDE, registry, Instant::now() + PATIENCE);
    let pixels = pixels.ok_or_else(|| "It takes too long to draw.".to_owned())?;
    Ok(ColorImage::from_rgb([SIDE as usize; 2], &pixels))
}

/// Says on a picture that objects have the material, and get its look as soon as the shader is compiled.
pub(super) fn compiling(ui: &Ui, rect: Rect) {
    let palette = Palette::here(ui);
    let words = theme::elided(ui, "compiling…", TextStyle::Small, palette.text, rect.width() - 4.0);
    let strip = rect.with_min_y(rect.bottom() - words.size().y - 6.0);
    let painter = ui.painter_at(rect);
    painter.rect_filled(strip, 2.0, palette.panel.gamma_multiply(0.9));
    painter.galley(strip.center() - 0.5 * words.size(), words, palette.text);
}

/// Paints a picture, or says why there is none yet.
pub(super) fn paint(ui: &Ui, rect: Rect, picture: &Picture) {
    let palette = Palette::here(ui);
    let words = match picture {
        Picture::Ready(texture) => {
            let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
            ui.painter().image(texture.id(), rect, whole, Color32::WHITE);
            return;
        }
        Picture::Waiting => "…",
        Picture::Failed(_) => "No picture",
    };
    let painter = ui.painter_at(rect);
    painter.rect_filled(rect, 2.0, palette.field);
    let words = theme::elided(ui, words, TextStyle::Small, palette.weak, rect.width() - 8.0);
    painter.galley(rect.center() - 0.5 * words.size(), words, palette.weak);
}
