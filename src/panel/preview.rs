//! Previews of scenes that are not open: examples, and files in the dialog. A thread reads them and draws them with the
//! CPU renderer, each once.

use std::{path::PathBuf, time::Duration};

use bevy_egui::egui::{ColorImage, TextureHandle, TextureOptions};
use web_time::Instant;

use super::{
    gallery::{Gallery, Wanted},
    prelude::*,
};
use crate::{
    caught::catch,
    parameter::Outside,
    reference::{self, LightSamples},
    scene::{
        examples::EXAMPLES,
        load::{self, Defaults},
    },
};

/// Ways of drawing a preview, the best first.
const QUALITIES: [Quality; 2] = [
    // Noise is hardly visible in a small picture.
    Quality { size: [320, 180], samples: 4, light_samples: LightSamples::of(32) },
    Quality { size: [160, 90], samples: 1, light_samples: LightSamples::of(8) },
];
/// Maximum rendering time of a preview in each quality: if the best takes longer, the next is tried.
const PATIENCE: Duration = Duration::from_secs(3);
/// Maximum number of lines about problems of a file.
const LINES: usize = 6;

/// A way of drawing a preview.
struct Quality {
    /// Pixels across and down.
    size: [u32; 2],
    /// Samples per pixel.
    samples: u32,
    /// Samples of light with extent.
    light_samples: LightSamples,
}

/// The scene of a preview.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Source {
    /// One of [`EXAMPLES`].
    Example(usize),
    /// A scene file.
    File(PathBuf),
}

/// The preview of a scene.
#[derive(Clone)]
pub enum Preview {
    /// The preview is being made.
    Waiting,
    /// The preview is complete.
    Ready(Arc<Shown>),
    /// The file cannot be used, for the given reason.
    Failed(Arc<str>),
}

/// The contents of a preview.
pub struct Shown {
    /// Name of the scene, if it has one.
    pub name: Option<String>,
    /// Description of the scene, if it has one.
    pub description: Option<String>,
    /// Summary of the scene's contents, in one line.
    pub facts: String,
    /// The picture, unless rendering would take too long.
    pub picture: Option<TextureHandle>,
}

/// The previews, each under its source.
type Previews = Gallery<Source, Source, Preview>;

/// The current preview of a scene, which may name the files `outside` its folder. The latest file requested is read
/// first; examples are all requested at once, and read from the first on.
pub fn of(ctx: &Context, source: &Source, registry: &Registry, outside: &Outside) -> Preview {
    let wanted = || Wanted {
        job: source.clone(),
        waiting: Preview::Waiting,
        is_urgent: matches!(source, Source::File(_)),
    };
    Previews::of(ctx, source, wanted, || {
        let (registry, outside) = (registry.clone(), outside.clone());
        move |ctx: &Context, source: Source| {
            catch(|| make(ctx, &source, &registry, &outside))
                .unwrap_or_else(|_| Preview::Failed("This scene cannot be drawn.".into()))
        }
    })
}

/// Forgets the previews of files, which may have changed since the dialog was last open.
pub fn forget_files(ctx: &Context) {
    Previews::retain(ctx, |source| matches!(source, Source::Example(_)));
}

fn make(ctx: &Context, source: &Source, registry: &Registry, outside: &Outside) -> Preview {
    let read = match source {
        Source::Example(i) => match EXAMPLES.get(*i) {
            Some(example) => example.scene(registry),
            None => return Preview::Failed("There is no such example.".into()),
        },
        Source::File(path) => {
            load::file(path, registry, Defaults::Use.allowing(outside)).map(|loaded| loaded.scene)
        }
    };
    let scene = match read {
        Ok(scene) => scene,
        Err(error) => {
            let lines: Vec<_> = error.to_string().lines().take(LINES).map(str::to_owned).collect();
            return Preview::Failed(lines.join("\n").into());
        }
    };
    let picture = draw(&scene, registry, [PATIENCE; 2])
        .map(|image| ctx.load_texture("preview", image, TextureOptions::LINEAR));
    Preview::Ready(Arc::new(Shown {
        facts: facts(&scene, registry),
        name: scene.name,
        description: scene.description,
        picture,
    }))
}

/// Draws a scene in the best quality for which the patience with it suffices.
fn draw(scene: &Scene, registry: &Registry, patience: [Duration; 2]) -> Option<ColorImage> {
    QUALITIES.iter().zip(patience).find_map(|(Quality { size, samples, light_samples }, patience)| {
        let [width, height] = *size;
        let settings =
            reference::Settings { width, height, samples: *samples, ..reference::Settings::default() };
        let end = Instant::now() + patience;
        let pixels = reference::render_rgb8_until(scene, registry, &settings, *light_samples, end)?;
        Some(ColorImage::from_rgb(size.map(|n| n as usize), &pixels))
    })
}

fn facts(scene: &Scene, registry: &Registry) -> String {
    let model = registry.model(&scene.reflection_model).map_or("–", |m| m.declaration.name);
    let shading = registry.shading_model(&scene.shading_model).map_or("–", |m| m.declaration.name);
    let [objects, lights] =
        [(scene.objects.len(), "object"), (scene.lights.len(), "light")].map(|(n, what)| plural(n, what));
    format!("{objects} · {lights} · {model} · {shading} shading")
}

/// Paints the picture of a scene, or says why there is none yet.
pub fn paint(ui: &Ui, rect: Rect, preview: &Preview) {
    let palette = Palette::here(ui);
    let painter = ui.painter_at(rect);
    let words = match preview {
        Preview::Ready(shown) => match &shown.picture {
            Some(picture) => {
                let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
                painter.image(picture.id(), rect, whole, Color32::WHITE);
                return;
            }
            None => "Takes too long to draw",
        },
        Preview::Waiting => "…",
        Preview::Failed(_) => "No picture",
    };
    painter.rect_filled(rect, 2.0, palette.field);
    let font = TextStyle::Small.resolve(ui.style());
    let words = painter.layout(words.to_owned(), font, palette.weak, rect.width() - 8.0);
    painter.galley(rect.center() - 0.5 * words.size(), words, palette.weak);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scene_for_which_there_is_no_time_is_drawn_coarsely() {
        let (scene, registry) = (Scene::default(), Registry::builtin());
        let sizes = [[320, 180], [160, 90]];
        let best = draw(&scene, &registry, [Duration::from_secs(60); 2]).expect("time enough");
        assert_eq!(best.size, sizes[0]);
        let coarse = draw(&scene, &registry, [Duration::ZERO, Duration::from_secs(60)]).expect("time enough");
        assert_eq!(coarse.size, sizes[1]);
        let many = |image: &ColorImage| {
            image.pixels.iter().filter(|pixel| **pixel != image.pixels[0]).count() as f32
                / image.pixels.len() as f32
        };
        assert!((many(&best) - many(&coarse)).abs() < 0.02 && many(&coarse) > 0.05, "the same picture");
        assert!(draw(&scene, &registry, [Duration::ZERO; 2]).is_none());
    }
}
