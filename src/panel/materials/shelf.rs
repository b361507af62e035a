//! What the panel shows: the materials, read by a thread, and their pictures, drawn by another one, each once.

use std::{
    collections::HashMap,
    thread,
    time::{Duration, Instant},
};

use bevy_egui::egui::{ColorImage, TextureHandle, TextureOptions};

use super::super::{kept, prelude::*};
use crate::{caught::catch, materials::Material, reference};

/// Pixels across a picture.
const SIDE: u32 = 128;
/// Maximum time for a picture.
const PATIENCE: Duration = Duration::from_secs(10);
/// Maximum number of pictures kept.
const MOST: usize = 512;

/// The picture of a material.
#[derive(Clone)]
pub(super) enum Picture {
    Waiting,
    Ready(TextureHandle),
    /// There is none, for this reason.
    Failed(Arc<str>),
}

#[derive(Default)]
struct Store {
    known: HashMap<String, Picture>,
    /// Pictures still to be drawn, the first last.
    queue: Vec<(String, Material)>,
    working: bool,
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
    kept::shared(ctx, |store: &mut Store| {
        if let Some(known) = store.known.get(&key) {
            return known.clone();
        }
        if store.known.len() >= MOST {
            store.known.clear();
        }
        store.known.insert(key.clone(), Picture::Waiting);
        store.queue.insert(0, (key, material.clone()));
        if !std::mem::replace(&mut store.working, true) {
            let (ctx, registry) = (ctx.clone(), registry.clone());
            thread::spawn(move || work(&ctx, &registry));
        }
        Picture::Waiting
    })
}

fn work(ctx: &Context, registry: &Registry) {
    let next = |store: &mut Store| {
        let next = store.queue.pop();
        store.working = next.is_some();
        next
    };
    while let Some((key, material)) = kept::shared(ctx, next) {
        let drawn =
            catch(|| draw(&material, registry)).unwrap_or_else(|_| Err("It cannot be drawn.".to_owned()));
        let picture = match drawn {
            Ok(image) => Picture::Ready(ctx.load_texture("material", image, TextureOptions::LINEAR)),
            Err(why) => Picture::Failed(why.into()),
        };
        kept::shared(ctx, |store: &mut Store| store.known.insert(key, picture));
        ctx.request_repaint();
    }
}

fn draw(material: &Material, registry: &Registry) -> Result<ColorImage, String> {
    if let Some((_, why)) = reference::not_on_cpu(&material.scene(registry), registry) {
        return Err(format!("The CPU renderer cannot draw it: {why}."));
    }
    let pixels = material.picture(SIDE, registry, Instant::now() + PATIENCE);
    let pixels = pixels.ok_or_else(|| "It takes too long to draw.".to_owned())?;
    Ok(ColorImage::from_rgb([SIDE as usize; 2], &pixels))
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
