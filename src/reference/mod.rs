//! The CPU renderer: draws a scene with the Rust functions alone.
//!
//! It shares no code with the shaders, so that each checks the other, and needs neither a window nor a GPU.
//! It follows the rules of graphics hardware (corners snapped to 1/256 pixel, top-left rule,
//! perspective-correct interpolation, the standard four sample positions, one colour per pixel and triangle),
//! so that both give the same picture up to rounding.
//!
//! ```
//! use lights_camera_models::{reference, registry::Registry, scene::Scene};
//! let settings = reference::Settings { width: 64, height: 36, ..Default::default() };
//! let picture = reference::render(&Scene::default(), &Registry::builtin(), &settings);
//! let rgb = picture.to_rgb8(&Scene::default().display);
//! assert_eq!(rgb.len(), 64 * 36 * 3);
//! ```
//!
//! Object types, light types and models are looked up in the registry. A checked scene names only known ones; objects
//! and lights of unknown types are skipped.
//!
//! A shading model of [`Stage::Vertex`] or [`Stage::Pixel`] runs once per vertex, which polygons share: the face
//! normal, tangent and centre of its [`Corner`] are then the vertex's. A shading model of [`Stage::Polygon`] runs once
//! per polygon, at its centre.
//!
//! [`Corner`]: crate::shading::Corner
//! [`Stage::Vertex`]: crate::shading::Stage::Vertex
//! [`Stage::Pixel`]: crate::shading::Stage::Pixel
//! [`Stage::Polygon`]: crate::shading::Stage::Polygon

use std::{
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    time::Instant,
};

use glam::Vec4;
use rayon::prelude::*;

use crate::{
    channel::Setting,
    optics::TermSelection,
    registry::Registry,
    scene::{Display, Scene, observer::clip_from_room},
};

mod channel;
mod converge;
mod display;
mod edits;
mod extended;
mod instead;
mod lighting;
pub(crate) mod meshes;
mod nearest;
mod object;
mod outlines;
pub(crate) mod probe;
mod raster;
mod vertices;
pub(crate) mod visible;
mod wires;

pub use crate::optics::colour::BACKGROUND;
use channel::Sight;
pub(crate) use converge::relative_error;
pub use converge::{Reached, Until, render_until};
use display::DisplayTransform;
pub use display::{DisplaySteps, encode8};
pub use edits::ignored_edits;
pub use extended::LightSamples;
use instead::Instead;
pub(crate) use instead::Leaving;
use lighting::Lights;
use meshes::Meshes;
use object::{Draw, hidden};
pub use outlines::outlines;
use raster::{Screen, TILE, Tile, Triangle};
pub use vertices::brightest_vertex;
use visible::VisibleLights;
pub use wires::{Dot, Line, WireDrawer, Wires, draw_wires};

/// The settings of a picture, apart from the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Settings {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Samples per pixel: 4, the standard positions, or 1, the pixel's centre. Other numbers above 1 count as 4.
    pub samples: u32,
    /// The calculated terms of the equation.
    pub terms: TermSelection,
}

impl Default for Settings {
    fn default() -> Self {
        Self { width: 1280, height: 720, samples: 4, terms: TermSelection::All }
    }
}

/// A picture of light: linear, before exposure.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Row by row from the top: red, green and blue of the light of objects and of visible lights (linear
    /// Rec. 709, the mean over the pixel's samples), and the fraction of samples that they cover. The rest is
    /// [`BACKGROUND`].
    pub pixels: Vec<Vec4>,
}

impl Picture {
    /// Light and coverage of a pixel.
    #[must_use]
    pub fn pixel(&self, x: u32, y: u32) -> Vec4 {
        self.pixels[y as usize * self.width as usize + x as usize]
    }

    /// The steps of a pixel from light to its codes in [`to_rgb8`](Self::to_rgb8).
    #[must_use]
    pub fn display_steps(pixel: Vec4, display: &Display) -> DisplaySteps {
        DisplayTransform::new(display).steps(pixel)
    }

    /// The picture for a display: exposure, tone mapping, sRGB encoding, eight bits; red, green, blue, row by row from
    /// the top.
    #[must_use]
    pub fn to_rgb8(&self, display: &Display) -> Vec<u8> {
        let display = DisplayTransform::new(display);
        let mut out = vec![0; self.pixels.len() * 3];
        out.par_chunks_mut(3 * 4096).zip(self.pixels.par_chunks(4096)).for_each(|(out, pixels)| {
            for (out, &pixel) in out.as_chunks_mut::<3>().0.iter_mut().zip(pixels) {
                *out = display.apply(pixel);
            }
        });
        out
    }
}

/// Renders a scene to light.
#[must_use]
pub fn render(scene: &Scene, registry: &Registry, settings: &Settings) -> Picture {
    render_noting(scene, registry, settings, &AtomicBool::default())
}

/// Like [`render`]; sets `odd` if light that is not finite was replaced, as shown by the channel
/// [`NotANumber`](crate::channel::DebugChannel::NotANumber).
#[must_use]
pub fn render_noting(scene: &Scene, registry: &Registry, settings: &Settings, odd: &AtomicBool) -> Picture {
    let pixels =
        draw(scene, registry, settings, None, (None, odd, LightSamples::default()), Vec4::ZERO, |pixel| {
            pixel
        });
    Picture { width: settings.width, height: settings.height, pixels }
}

/// Like [`render_noting`], with these samples of lights with extent.
#[must_use]
pub fn render_samples(
    scene: &Scene,
    registry: &Registry,
    settings: &Settings,
    samples: LightSamples,
    odd: &AtomicBool,
) -> Picture {
    let pixels = draw(scene, registry, settings, None, (None, odd, samples), Vec4::ZERO, |pixel| pixel);
    Picture { width: settings.width, height: settings.height, pixels }
}

/// Renders the objects of a scene with the light given by `leaving` at each point.
pub(crate) fn render_instead(
    scene: &Scene,
    registry: &Registry,
    settings: &Settings,
    leaving: Arc<Leaving>,
) -> Picture {
    let instead = Instead(leaving);
    let seen: &Seen<'_> = &|draw| instead.on(draw);
    let ever = (None, &AtomicBool::default(), LightSamples::default());
    let pixels = draw(scene, registry, settings, Some(seen), ever, Vec4::ZERO, |pixel| pixel);
    Picture { width: settings.width, height: settings.height, pixels }
}

/// Renders a scene with its display settings: the same bytes as [`render`] and [`Picture::to_rgb8`], without ever
/// holding the whole picture in floating point.
#[must_use]
pub fn render_rgb8(scene: &Scene, registry: &Registry, settings: &Settings) -> Vec<u8> {
    render_rgb8_noting(scene, registry, settings, &AtomicBool::default())
}

/// Like [`render_rgb8`]; sets `odd` as [`render_noting`] does.
#[must_use]
pub fn render_rgb8_noting(
    scene: &Scene,
    registry: &Registry,
    settings: &Settings,
    odd: &AtomicBool,
) -> Vec<u8> {
    let display = DisplayTransform::new(&scene.display);
    let background = display.apply(Vec4::ZERO);
    draw(scene, registry, settings, None, (None, odd, LightSamples::default()), background, |pixel| {
        display.apply(pixel)
    })
    .into_flattened()
}

/// Like [`render_rgb8_noting`], with these samples of lights with extent; `None` if it is not finished by `end`.
#[must_use]
pub fn render_rgb8_until(
    scene: &Scene,
    registry: &Registry,
    settings: &Settings,
    samples: LightSamples,
    end: Instant,
) -> Option<Vec<u8>> {
    let display = DisplayTransform::new(&scene.display);
    let background = display.apply(Vec4::ZERO);
    let until = (Some(end), &AtomicBool::default(), samples);
    let pixels = draw(scene, registry, settings, None, until, background, |pixel| display.apply(pixel));
    (Instant::now() < end).then(|| pixels.into_flattened())
}

/// Renders a debug channel of a scene: red, green and blue of each pixel, as in its legend.
#[must_use]
pub fn render_channel(scene: &Scene, registry: &Registry, settings: &Settings, setting: &Setting) -> Vec<u8> {
    render_channel_by(scene, registry, settings, setting, LightSamples::default())
}

/// Like [`render_channel`], with these samples of lights with extent, except for the [channel that is a
/// picture](crate::channel::DebugChannel::is_picture).
#[must_use]
pub fn render_channel_by(
    scene: &Scene,
    registry: &Registry,
    settings: &Settings,
    setting: &Setting,
    samples: LightSamples,
) -> Vec<u8> {
    if setting.channel.is_picture() {
        return render_rgb8(&setting.lit(scene), registry, settings);
    }
    let display = DisplayTransform::new(&Display::default());
    let background = display.apply(Vec4::ZERO);
    let ground = Setting { channel: setting.channel.ground(), ..*setting };
    let sight = Sight::new(scene, registry, settings, ground);
    let finish = |pixel| display.apply(pixel);
    let ever = (None, &AtomicBool::default(), samples);
    let seen: &Seen<'_> = &|draw| sight.seen(draw);
    let mut rgb8 = draw(scene, registry, settings, Some(seen), ever, background, finish).into_flattened();
    if setting.channel.has_wires() {
        draw_wires(&mut rgb8, scene, registry, settings, setting.channel);
    }
    rgb8
}

/// Maximum number of polygons held at a time: bounds the memory for scenes of any size.
const POLYGONS_PER_BATCH: usize = 1 << 16;

/// Replaces the light of an object by another way of drawing it.
type Seen<'s> = dyn for<'a> Fn(Draw<'a>) -> Draw<'a> + Sync + 's;

/// Draws a scene: `background` where there is neither an object nor a visible light, and elsewhere the result
/// of `finish` for the light. Anything not done by `end` is skipped; `odd` is set if light was not finite.
fn draw<T: Copy + Send + Sync>(
    scene: &Scene,
    registry: &Registry,
    settings: &Settings,
    sight: Option<&Seen<'_>>,
    (end, odd, samples): (Option<Instant>, &AtomicBool, LightSamples),
    background: T,
    finish: impl Fn(Vec4) -> T + Sync,
) -> Vec<T> {
    if settings.samples > 1 {
        draw_sampled::<4, T>(scene, registry, settings, sight, (end, odd, samples), background, finish)
    } else {
        draw_sampled::<1, T>(scene, registry, settings, sight, (end, odd, samples), background, finish)
    }
}

fn draw_sampled<const S: usize, T: Copy + Send + Sync>(
    scene: &Scene,
    registry: &Registry,
    settings: &Settings,
    sight: Option<&Seen<'_>>,
    (end, odd, samples): (Option<Instant>, &AtomicBool, LightSamples),
    background: T,
    finish: impl Fn(Vec4) -> T + Sync,
) -> Vec<T> {
    let late = || end.is_some_and(|end| Instant::now() >= end);
    let (width, height) = (settings.width as usize, settings.height as usize);
    let mut out = vec![background; width * height];
    if out.is_empty() {
        return out;
    }
    let screen = Screen::new(width, height, S);
    let lights = Lights::new(scene, registry, settings.terms).sampled(samples);
    let lights = if sight.is_some() { lights.raw() } else { lights };
    let mut meshes = Meshes::new(registry);
    let clip_from_room = clip_from_room(&scene.observer, width as f32 / height as f32);
    let frustum = raster::frustum(&clip_from_room);
    // Other ways of drawing show only objects.
    let visible = sight.is_none().then(|| VisibleLights::new(scene, registry, settings));

    let mut tiles: Vec<Option<Tile<S>>> = (0..screen.tiles()).map(|_| None).collect();
    let shown: Vec<_> = scene.shown().collect();
    let mut rest = &shown[..];
    loop {
        let (mut batch, mut polygons) = (Vec::new(), 0);
        while let [object, later @ ..] = rest
            && !late()
        {
            if let Some(shape) = meshes.first(rest)
                && !hidden(object, &shape, &frustum)
            {
                polygons += shape.mesh.polygons.len();
                if polygons > POLYGONS_PER_BATCH && !batch.is_empty() {
                    break;
                }
                batch.push((*object, shape));
            }
            rest = later;
        }

        let draws: Vec<Draw> = batch
            .into_par_iter()
            .filter_map(|(object, shape)| (!late()).then(|| Draw::new(scene, registry, object, shape))?)
            .map(|draw| match sight {
                Some(seen) => seen(draw),
                None => draw,
            })
            .collect();
        let triangles: Vec<Vec<Triangle>> = draws
            .par_iter()
            .map(|draw| if late() { Vec::new() } else { draw.triangles(&lights, &clip_from_room, &screen) })
            .collect();
        let bins = bin(&triangles, &screen);

        // A tile is finished as soon as the last batch has been drawn into it, which keeps few of them in
        // memory; the picture is assembled when all are finished.
        let finished: Vec<(usize, Vec<T>)> = tiles
            .par_iter_mut()
            .zip(&bins)
            .enumerate()
            .filter_map(|(i, (tile, bin))| {
                for &(object, triangle) in bin {
                    if late() {
                        break;
                    }
                    let draw = &draws[object as usize];
                    let triangle = &triangles[object as usize][triangle as usize];
                    let lighting = draw.under(&lights);
                    let tile = tile.get_or_insert_with(Tile::new);
                    tile.draw(triangle, &*draw.shading, &lighting, origin(i, &screen), &screen);
                }
                if !rest.is_empty() {
                    return None;
                }
                let origin = origin(i, &screen);
                let mut tile = tile.take();
                let seen = visible.as_ref().and_then(|visible| visible.within(origin, TILE));
                if let Some(mut lights) = seen.filter(|_| !late()) {
                    tile.get_or_insert_with(Tile::new).show(&mut lights);
                }
                Some((i, tile?.resolve().map(&finish).collect()))
            })
            .collect();
        for (i, pixels) in finished {
            let [left, top] = origin(i, &screen);
            let columns = TILE.min(width - left);
            for (row, pixels) in pixels.chunks_exact(TILE).take(height - top).enumerate() {
                let start = (top + row) * width + left;
                out[start..start + columns].copy_from_slice(&pixels[..columns]);
            }
        }
        if rest.is_empty() || late() {
            break;
        }
    }
    odd.fetch_or(lights.was_odd(), Ordering::Relaxed);
    out
}

/// The first pixel of a tile.
fn origin(tile: usize, screen: &Screen) -> [usize; 2] {
    [(tile % screen.tiles_across()) * TILE, (tile / screen.tiles_across()) * TILE]
}

/// For each tile, the triangles that may touch it, in drawing order: object, triangle.
fn bin(triangles: &[Vec<Triangle>], screen: &Screen) -> Vec<Vec<(u32, u32)>> {
    let mut bins = vec![Vec::new(); screen.tiles()];
    for (object, triangles) in triangles.iter().enumerate() {
        for (i, triangle) in triangles.iter().enumerate() {
            let Some([left, right, top, bottom]) = triangle.bounds(screen) else { continue };
            for row in top / TILE..=bottom / TILE {
                for column in left / TILE..=right / TILE {
                    bins[row * screen.tiles_across() + column].push((object as u32, i as u32));
                }
            }
        }
    }
    bins
}
