//! Previews of scenes that are not open: examples, and files in the dialog. A thread reads them and draws them with the
//! CPU renderer, each once.

use std::{
    collections::HashMap,
    path::PathBuf,
    thread,
    time::{Duration, Instant},
};

use bevy_egui::egui::{ColorImage, TextureHandle, TextureOptions};

use super::prelude::*;
use crate::{
    caught::catch,
    parameter::Outside,
    reference::{self, LightSamples},
    scene::{
        examples::EXAMPLES,
        load::{self, Defaults},
    },
};

/// Width and height of a preview, in pixels.
const SIZE: [u32; 2] = [320, 180];
/// Samples of light with extent: noise is hardly visible in a small picture.
const LIGHT_SAMPLES: LightSamples = LightSamples::of(32);
/// Maximum rendering time of a preview.
const PATIENCE: Duration = Duration::from_secs(3);
/// Maximum number of previews kept.
const MOST: usize = 128;
/// Maximum number of lines about problems of a file.
const LINES: usize = 6;

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

#[derive(Default)]
struct Store {
    known: HashMap<Source, Preview>,
    /// Previews still to be made, the most urgent last.
    queue: Vec<Source>,
    working: bool,
}

/// The current preview of a scene, which may name the files `outside` its folder. The latest file requested is read
/// first.
pub fn of(ctx: &Context, source: &Source, registry: &Registry, outside: &Outside) -> Preview {
    kept::shared(ctx, |store: &mut Store| {
        if let Some(known) = store.known.get(source) {
            return known.clone();
        }
        if store.known.len() >= MOST {
            store.known.clear();
        }
        store.known.insert(source.clone(), Preview::Waiting);
        match source {
            // All examples are requested at once, and read from the first on.
            Source::Example(_) => store.queue.insert(0, source.clone()),
            Source::File(_) => store.queue.push(source.clone()),
        }
        if !std::mem::replace(&mut store.working, true) {
            let (ctx, registry, outside) = (ctx.clone(), registry.clone(), outside.clone());
            thread::spawn(move || work(&ctx, &registry, &outside));
        }
        Preview::Waiting
    })
}

/// Forgets the previews of files, which may have changed since the dialog was last open.
pub fn forget_files(ctx: &Context) {
    kept::shared(ctx, |store: &mut Store| {
        store.known.retain(|source, _| matches!(source, Source::Example(_)));
        store.queue.retain(|source| matches!(source, Source::Example(_)));
    });
}

fn work(ctx: &Context, registry: &Registry, outside: &Outside) {
    let next = |store: &mut Store| {
        let source = store.queue.pop();
        store.working = source.is_some();
        source
    };
    while let Some(source) = kept::shared(ctx, next) {
        let made = catch(|| make(ctx, &source, registry, outside))
            .unwrap_or_else(|_| Preview::Failed("This scene cannot be drawn.".into()));
        kept::shared(ctx, |store: &mut Store| store.known.insert(source, made));
        ctx.request_repaint();
    }
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
    let [width, height] = SIZE;
    let settings = reference::Settings { width, height, ..reference::Settings::default() };
    let end = Instant::now() + PATIENCE;
    let picture = reference::render_rgb8_until(&scene, registry, &settings, LIGHT_SAMPLES, end);
    let picture = picture.map(|pixels| {
        let image = ColorImage::from_rgb(SIZE.map(|n| n as usize), &pixels);
        ctx.load_texture("preview", image, TextureOptions::LINEAR)
    });
    Preview::Ready(Arc::new(Shown {
        facts: facts(&scene, registry),
        name: scene.name,
        description: scene.description,
        picture,
    }))
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
            None => "Too large for a preview",
        },
        Preview::Waiting => "…",
        Preview::Failed(_) => "No picture",
    };
    painter.rect_filled(rect, 2.0, palette.field);
    let font = TextStyle::Small.resolve(ui.style());
    painter.text(rect.center(), Align2::CENTER_CENTER, words, font, palette.weak);
}
