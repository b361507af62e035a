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
/// Maximum time for the first attempt at a picture; later ones have that much more each, since the machine may be busy.
const PATIENCE: Duration = Duration::from_secs(10);
/// Maximum number of attempts, and the time after which another one follows.
const ATTEMPTS: u32 = 3;
const PAUSE: Duration = Duration::from_secs(30);

/// The picture of a material.
#[derive(Clone)]
pub(super) enum Picture {
    Waiting,
    Ready(TextureHandle),
    /// There is none, for this reason.
    Failed(Arc<str>),
}

/// A picture, and if it took too long, the time at which it was given up.
type Made = (Picture, Option<Instant>);

/// The picture of a material. Models whose files were reloaded are drawn again, and so is what took too long, in a while or
/// once the panel is opened again.
pub(super) fn picture(
    ctx: &Context,
    material: &Material,
    opened: Option<Instant>,
    session: &Session,
    registry: &Registry,
) -> Picture {
    let id = &material.reflection_model;
    let mut key = format!("{id} {:?}", material.material);
    if registry.custom_file(id).is_some() {
        if registry.unread_file(id).is_some() {
            return Picture::Failed("The picture is drawn once an object has had this custom model.".into());
        }
        key += &format!("{:?}", session.shaders.last);
    }
    let (picture, rest) = latest(opened, |attempt| {
        let wanted = || Wanted {
            job: (material.clone(), attempt),
            waiting: (Picture::Waiting, None),
            is_urgent: false,
        };
        Gallery::of(ctx, &(key.clone(), attempt), wanted, || {
            let registry = registry.clone();
            move |ctx: &Context, (material, attempt): (Material, u32)| {
                make(ctx, &material, attempt, &registry)
            }
        })
    });
    if let Some(rest) = rest {
        ctx.request_repaint_after(rest);
    }
    picture
}

/// The picture by the latest attempt, and the time until the next one, if the panel is not opened again before.
fn latest(opened: Option<Instant>, mut made: impl FnMut(u32) -> Made) -> (Picture, Option<Duration>) {
    let mut attempt = 1;
    loop {
        let (picture, late) = made(attempt);
        let Some(late) = late.filter(|_| attempt < ATTEMPTS) else { return (picture, None) };
        let rest = PAUSE.saturating_sub(late.elapsed());
        if !rest.is_zero() && opened.is_none_or(|opened| opened <= late) {
            return (picture, Some(rest));
        }
        attempt += 1;
    }
}

/// Makes a picture by the attempt of this number, from 1.
fn make(ctx: &Context, material: &Material, attempt: u32, registry: &Registry) -> Made {
    match catch(|| draw(material, PATIENCE * attempt, registry)) {
        Ok(Ok(Some(image))) => {
            (Picture::Ready(ctx.load_texture("material", image, TextureOptions::LINEAR)), None)
        }
        Ok(Ok(None)) => {
            let why = match attempt {
                ATTEMPTS => "It takes too long to draw.",
                _ => {
                    "It took too long to draw. It is tried again in a while, and when the panel is opened again."
                }
            };
            (Picture::Failed(why.into()), Some(Instant::now()))
        }
        Ok(Err(why)) => (Picture::Failed(why.into()), None),
        Err(_) => (Picture::Failed("It cannot be drawn.".into()), None),
    }
}

/// Draws a picture; `None` if that takes too long.
fn draw(material: &Material, patience: Duration, registry: &Registry) -> Result<Option<ColorImage>, String> {
    if let Some((_, why)) = reference::not_on_cpu(&material.scene(registry), registry) {
        return Err(format!("The CPU renderer cannot draw it: {why}."));
    }
    let pixels = material.picture(SIDE, registry, Instant::now() + patience);
    Ok(pixels.map(|pixels| ColorImage::from_rgb([SIDE as usize; 2], &pixels)))
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_that_took_too_long_is_tried_again_in_a_while_or_when_the_panel_opens() {
        let now = Instant::now();
        let before = now.checked_sub(PAUSE).expect("the clock goes back that far");
        let asked = |opened: Option<Instant>, late: &[Option<Instant>]| {
            let mut asked = 0;
            let (_, rest) = latest(opened, |attempt| {
                asked = attempt;
                (Picture::Waiting, late[attempt as usize - 1])
            });
            (asked, rest.is_some())
        };
        assert_eq!(asked(None, &[None]), (1, false));
        assert_eq!(asked(None, &[Some(now)]), (1, true));
        assert_eq!(asked(Some(before), &[Some(now)]), (1, true), "it was open already");
        assert_eq!(asked(Some(now + PAUSE), &[Some(now), None]), (2, false), "opened again");
        assert_eq!(asked(None, &[Some(before), Some(now)]), (2, true), "after a while");
        assert_eq!(asked(None, &[Some(before); 3]), (ATTEMPTS, false), "not for ever");
    }
}
