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
    ops::Range,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
};

use glam::Vec4;
use rayon::prelude::*;
use web_time::Instant;

use crate::{
    channel::Setting,
    optics::TermSelection,
    registry::Registry,
    scene::{Display, Object, Scene, observer::clip_from_room},
};

mod channel;
mod converge;
mod display;
mod edits;
mod extended;
pub mod inside;
mod instead;
mod layers;
mod lighting;
mod lights;
pub(crate) mod meshes;
mod nearest;
mod object;
mod outlines;
pub(crate) mod probe;
mod raster;
mod through;
mod vertices;
pub(crate) mod visible;
mod wires;

pub use crate::optics::colour::BACKGROUND;
use channel::ChannelSight;
pub(crate) use converge::{BLOCK, ENOUGH, relative_error};
pub use converge::{Reached, Until, render_until};
use display::DisplayTransform;
pub use display::{DisplaySteps, encode8};
pub use edits::{ignored_edits, not_on_cpu};
pub use extended::LightSamples;
use instead::Instead;
pub(crate) use instead::Leaving;
pub use layers::{render_layers, render_numbers};
use lights::Lights;
pub(crate) use lights::within_bounds;
use meshes::{Meshes, Prepared};
use object::{Draw, hidden};
pub use outlines::{covered, covers_alike, outlines};
pub(crate) use raster::sample_positions;
use raster::{Screen, TILE, Tile, Triangle, even};
pub use vertices::brightest_vertex;
use visible::VisibleLights;
pub use wires::{Dot, Line, WireDrawer, Wires, draw_wires};

/// Maximum width and height of a picture, in pixels: the usual limit of GPUs.
pub const MAX_SIDE: u32 = 16_384;

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
    /// [`BACKGROUND`], or what the scene gives instead of it.
    pub pixels: Vec<Vec4>,
}

impl Picture {
    /// Light and coverage of a pixel.
    #[must_use]
    pub fn pixel(&self, x: u32, y: u32) -> Vec4 {
        self.pixels[y as usize * self.width as usize + x as usize]
    }

    /// The steps of a pixel from light to its codes in [`to_rgb8`](Self::to_rgb8), in a row, counted from the top, of a
    /// picture of this height.
    #[must_use]
    pub fn display_steps(pixel: Vec4, display: &Display, row: u32, height: u32) -> DisplaySteps {
        let display = DisplayTransform::new(display);
        display.steps(pixel, display.behind(row as usize, height as usize))
    }

    /// The picture for a display: exposure, tone mapping, sRGB encoding, eight bits; red, green, blue, row by row from
    /// the top.
    #[must_use]
    pub fn to_rgb8(&self, display: &Display) -> Vec<u8> {
        let display = DisplayTransform::new(display);
        let (width, height) = (self.width.max(1) as usize, self.height as usize);
        let mut out = vec![0; self.pixels.len() * 3];
        let rows = out.par_chunks_mut(3 * width).zip(self.pixels.par_chunks(width)).enumerate();
        rows.for_each(|(row, (out, pixels))| {
            let behind = display.behind(row, height);
            for (out, &pixel) in out.as_chunks_mut::<3>().0.iter_mut().zip(pixels) {
                *out = display.apply(pixel, behind);
            }
        });
        out
    }
}

/// A picture to take: of a scene, with what a registry knows, and with some settings.
#[derive(Clone, Copy)]
pub(crate) struct Shot<'a> {
    pub(crate) scene: &'a Scene,
    pub(crate) registry: &'a Registry,
    pub(crate) settings: &'a Settings,
    /// The samples of lights with extent where single points are looked into; a [`Drawing`] has its own.
    pub(crate) samples: LightSamples,
}

impl<'a> Shot<'a> {
    pub(crate) fn new(scene: &'a Scene, registry: &'a Registry, settings: &'a Settings) -> Self {
        Self { scene, registry, settings, samples: LightSamples::default() }
    }

    /// A picture for whose light nobody watches, with the usual samples.
    fn drawing(self) -> Drawing<'a> {
        let samples = LightSamples::default();
        Drawing {
            shot: self,
            sight: None,
            remaining: false,
            samples,
            end: None,
            odd: None,
            tiles: TILES_AT_ONCE,
        }
    }
}

/// Renders a scene to light.
#[must_use]
pub fn render(scene: &Scene, registry: &Registry, settings: &Settings) -> Picture {
    Shot::new(scene, registry, settings).drawing().light()
}

/// Like [`render`], with these samples of lights with extent. Sets `odd` if light that is not finite was replaced, as
/// shown by the channel [`NotANumber`](crate::channel::DebugChannel::NotANumber).
#[must_use]
pub fn render_samples(
    scene: &Scene,
    registry: &Registry,
    settings: &Settings,
    samples: LightSamples,
    odd: &AtomicBool,
) -> Picture {
    Drawing { odd: Some(odd), samples, ..Shot::new(scene, registry, settings).drawing() }.light()
}

/// Renders the objects of a scene with the light given by `leaving` at each point.
pub(crate) fn render_instead(shot: Shot, leaving: Arc<Leaving>) -> Picture {
    let instead = Instead(leaving);
    Drawing { sight: Some(&|draw| instead.on(draw)), ..shot.drawing() }.light()
}

/// Renders a scene with its display settings: the same bytes as [`render`] and [`Picture::to_rgb8`], without ever
/// holding the whole picture in floating point.
#[must_use]
pub fn render_rgb8(scene: &Scene, registry: &Registry, settings: &Settings) -> Vec<u8> {
    Shot::new(scene, registry, settings).drawing().rgb8(&scene.display)
}

/// Like [`render_rgb8`]; sets `odd` as [`render_samples`] does.
#[must_use]
pub fn render_rgb8_noting(
    scene: &Scene,
    registry: &Registry,
    settings: &Settings,
    odd: &AtomicBool,
) -> Vec<u8> {
    Drawing { odd: Some(odd), ..Shot::new(scene, registry, settings).drawing() }.rgb8(&scene.display)
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
    let drawing = Drawing { samples, end: Some(end), ..Shot::new(scene, registry, settings).drawing() };
    let rgb8 = drawing.rgb8(&scene.display);
    (Instant::now() < end).then_some(rgb8)
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
    let shot = Shot::new(scene, registry, settings);
    let sight = ChannelSight::new(shot, Setting { channel: setting.channel.ground(), ..*setting });
    let remaining = setting.channel.is_of_remaining();
    let drawing = Drawing { sight: Some(&|draw| sight.seen(draw)), remaining, samples, ..shot.drawing() };
    let mut rgb8 = drawing.rgb8(&Display::default());
    if setting.channel.has_wires() {
        draw_wires(&mut rgb8, scene, registry, settings, setting.channel);
    }
    rgb8
}

/// Maximum number of polygons held at a time: bounds the memory for scenes of any size.
const POLYGONS_PER_BATCH: usize = 1 << 16;

/// Maximum number of tiles drawn at a time, 64 KiB each while further batches are to come: bounds the memory for pictures
/// of any size to 1 GiB beside their pixels. Pictures of up to 16 million pixels are drawn as a whole.
const TILES_AT_ONCE: usize = 1 << 14;

/// Replaces the light of an object by another way of drawing it.
type Seen<'s> = dyn for<'a> Fn(Draw<'a>) -> Draw<'a> + Sync + 's;

/// A picture, and how it is drawn.
#[derive(Clone, Copy)]
struct Drawing<'a> {
    shot: Shot<'a>,
    /// Another way of drawing objects, if any.
    sight: Option<&'a Seen<'a>>,
    /// True if the light that remains inside solid bodies takes the place of the light.
    remaining: bool,
    samples: LightSamples,
    /// Anything not done by then is skipped.
    end: Option<Instant>,
    /// Set if light was not finite.
    odd: Option<&'a AtomicBool>,
    /// Maximum number of tiles drawn at a time; a row of them at least.
    tiles: usize,
}

impl Drawing<'_> {
    /// The light.
    fn light(&self) -> Picture {
        let Settings { width, height, .. } = *self.shot.settings;
        Picture { width, height, pixels: self.draw(|pixel, _| pixel) }
    }

    /// The codes on a display.
    fn rgb8(&self, display: &Display) -> Vec<u8> {
        let display = DisplayTransform::new(display);
        let height = self.shot.settings.height as usize;
        let behind: Vec<_> = (0..height).map(|row| display.behind(row, height)).collect();
        let finish = |pixel, row: usize| display.apply(pixel, behind.get(row).copied().flatten());
        self.draw(finish).into_flattened()
    }

    /// The picture: the result of `finish` for the light, which is 0 where there is neither an object nor a visible light,
    /// and the row.
    fn draw<T: Copy + PartialEq + Send + Sync>(&self, finish: impl Fn(Vec4, usize) -> T + Sync) -> Vec<T> {
        match self.shot.settings.samples {
            0 | 1 => draw_sampled::<1, T>(self, finish),
            _ => draw_sampled::<4, T>(self, finish),
        }
    }
}

fn draw_sampled<const S: usize, T: Copy + PartialEq + Send + Sync>(
    &Drawing { shot, sight, remaining, samples, end, odd, tiles: at_once }: &Drawing,
    finish: impl Fn(Vec4, usize) -> T + Sync,
) -> Vec<T> {
    let Shot { scene, registry, settings, .. } = shot;
    let late = || end.is_some_and(|end| Instant::now() >= end);
    let (width, height) = (settings.width as usize, settings.height as usize);
    if width * height == 0 {
        return Vec::new();
    }
    let mut out = Vec::with_capacity(width * height);
    for row in 0..height {
        let behind = finish(Vec4::ZERO, row);
        match out.last() {
            // To copy a row is faster than to fill one.
            Some(above) if *above == behind => out.extend_from_within((row - 1) * width..),
            _ => out.resize((row + 1) * width, behind),
        }
    }
    let screen = Screen::new(width, height, S);
    let lights = Lights::new(scene, registry, settings.terms).sampled(samples);
    let lights = if sight.is_some() { lights.raw() } else { lights };
    let lights = if remaining { lights.remaining() } else { lights };
    let mut meshes = Meshes::new(registry);
    let clip_from_room = clip_from_room(&scene.observer, width as f32 / height as f32);
    let frustum = raster::frustum(&clip_from_room);
    // Other ways of drawing show only objects.
    let visible = sight.is_none().then(|| VisibleLights::new(shot));

    let shown: Vec<_> = scene.shown().collect();
    for band in bands(&screen, at_once) {
        let mut tiles: Vec<Option<Tile<S>>> = band.clone().map(|_| None).collect();
        let mut rest = &shown[..];
        loop {
            let draws: Vec<Draw> = batch(&mut rest, &mut meshes, &frustum, &late)
                .into_par_iter()
                .filter_map(|(object, shape)| (!late()).then(|| Draw::new(scene, registry, object, shape))?)
                .map(|draw| match sight {
                    Some(seen) => seen(draw),
                    None => draw,
                })
                .collect();
            let of = |draw: &Draw| draw.triangles(&lights, &clip_from_room, &screen);
            let triangles: Vec<Vec<Triangle>> =
                draws.par_iter().map(|draw| if late() { Vec::new() } else { of(draw) }).collect();
            let bins = bin(&triangles, &screen, &band);

            // A tile is finished as soon as the last batch has been drawn into it, which keeps few of them in
            // memory; the picture is assembled when all are finished.
            let is_last = rest.is_empty();
            let draw = |tile: &mut Option<Tile<S>>, bin: &[(u32, u32)], origin: [usize; 2]| {
                for &(object, triangle) in bin.iter().take_while(|_| !late()) {
                    let draw = &draws[object as usize];
                    let triangle = &triangles[object as usize][triangle as usize];
                    let lighting = draw.under(&lights);
                    let tile = tile.get_or_insert_with(Tile::new);
                    tile.draw(triangle, &*draw.shading, &lighting, origin, &screen);
                }
                let visible = visible.as_ref().filter(|_| is_last && !late());
                is_last.then(|| finished(tile.take(), visible, origin, &finish))?
            };
            let drawn = tiles.par_iter_mut().zip(&bins).zip(band.clone());
            let drawn = drawn.filter_map(|((tile, bin), i)| {
                let origin = origin(i, &screen);
                Some((origin, draw(tile, bin, origin)?))
            });
            for (origin, tile) in drawn.collect::<Vec<_>>() {
                tile.put(&mut out, width, origin);
            }
            if is_last || late() {
                break;
            }
        }
    }
    if let Some(odd) = odd {
        odd.fetch_or(lights.was_odd(), Ordering::Relaxed);
    }
    out
}

/// The next objects, as many as are held at a time, with their meshes; those after them remain.
fn batch<'a>(
    rest: &mut &[&'a Object],
    meshes: &mut Meshes,
    frustum: &[Vec4],
    late: &impl Fn() -> bool,
) -> Vec<(&'a Object, Arc<Prepared>)> {
    let (mut batch, mut polygons) = (Vec::new(), 0);
    while let [object, later @ ..] = *rest
        && !late()
    {
        if let Some(shape) = meshes.first(rest)
            && !hidden(object, &shape, frustum)
        {
            polygons += shape.mesh.polygons.len();
            if polygons > POLYGONS_PER_BATCH && !batch.is_empty() {
                break;
            }
            batch.push((*object, shape));
        }
        *rest = later;
    }
    batch
}

/// A tile after its last object, with the lights that are visible in it; `None` if it is empty.
fn finished<const S: usize, T: Copy>(
    mut tile: Option<Tile<S>>,
    visible: Option<&VisibleLights>,
    origin: [usize; 2],
    finish: &impl Fn(Vec4, usize) -> T,
) -> Option<Finished<T>> {
    if let Some(lights) = visible.and_then(|visible| visible.within(origin, TILE, S)) {
        if let (None, Some(light)) = (&tile, lights.throughout) {
            return Some(Finished::Even(finish(even::<S>(light), origin[1])));
        }
        tile.get_or_insert_with(Tile::new).show(&lights);
    }
    let tile = tile?;
    // Neighbours are often the same, bit for bit: background, and polygons of one colour.
    let mut last = None;
    let pixels = tile.resolve().enumerate().map(|(at, pixel)| {
        let (row, bits) = (at / TILE, pixel.to_array().map(f32::to_bits));
        let (.., done) = last
            .filter(|&(above, before, _)| (above, before) == (row, bits))
            .unwrap_or_else(|| (row, bits, finish(pixel, origin[1] + row)));
        last = Some((row, bits, done));
        done
    });
    Some(Finished::Pixels(pixels.collect()))
}

/// A finished tile.
enum Finished<T> {
    /// All pixels are the same.
    Even(T),
    /// Row by row.
    Pixels(Vec<T>),
}

impl<T: Copy> Finished<T> {
    /// Puts the tile with this first pixel into a picture.
    fn put(&self, picture: &mut [T], width: usize, [left, top]: [usize; 2]) {
        let columns = TILE.min(width - left);
        for (row, line) in picture.chunks_exact_mut(width).skip(top).take(TILE).enumerate() {
            let line = &mut line[left..left + columns];
            match self {
                Self::Even(pixel) => line.fill(*pixel),
                Self::Pixels(pixels) => line.copy_from_slice(&pixels[row * TILE..][..columns]),
            }
        }
    }
}

/// The first pixel of a tile.
fn origin(tile: usize, screen: &Screen) -> [usize; 2] {
    [(tile % screen.tiles_across()) * TILE, (tile / screen.tiles_across()) * TILE]
}

/// Consecutive rows of tiles that are drawn one after the other.
fn bands(screen: &Screen, at_once: usize) -> impl Iterator<Item = Range<usize>> {
    let (across, all) = (screen.tiles_across(), screen.tiles());
    let most = (at_once / across).max(1) * across;
    (0..all).step_by(most).map(move |first| first..all.min(first + most))
}

/// For each tile of a band, the triangles that may touch it, in drawing order: object, triangle.
fn bin(triangles: &[Vec<Triangle>], screen: &Screen, band: &Range<usize>) -> Vec<Vec<(u32, u32)>> {
    let mut bins = vec![Vec::new(); band.len()];
    let across = screen.tiles_across();
    let rows = band.start / across..=(band.end - 1) / across;
    for (object, triangles) in triangles.iter().enumerate() {
        for (i, triangle) in triangles.iter().enumerate() {
            let Some([left, right, top, bottom]) = triangle.bounds(screen) else { continue };
            for row in (top / TILE).max(*rows.start())..=(bottom / TILE).min(*rows.end()) {
                for column in left / TILE..=right / TILE {
                    bins[row * across + column - band.start].push((object as u32, i as u32));
                }
            }
        }
    }
    bins
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn large_pictures_are_drawn_in_bands_without_seams() {
        let registry = Registry::builtin();
        // Several batches of polygons.
        let object = |i| Object {
            position: glam::Vec3::new(2.0 + 1.5 * i as f32, 5.0, 5.0),
            tessellation: Some(192),
            ..Object::default()
        };
        let scene = Scene { objects: (0..5).map(object).collect(), ..Scene::default() };
        let settings = Settings { width: 150, height: 130, ..Settings::default() };
        let shot = Shot::new(&scene, &registry, &settings);
        let screen = Screen::new(150, 130, 4);
        let bands: Vec<_> = bands(&screen, 12).collect();
        assert_eq!(bands, [0..10, 10..20, 20..25], "two rows of five tiles each, and the last one");
        let whole = render_rgb8(&scene, &registry, &settings);
        for tiles in [1, 12] {
            assert!(Drawing { tiles, ..shot.drawing() }.rgb8(&scene.display) == whole, "{tiles}");
        }
    }
}
