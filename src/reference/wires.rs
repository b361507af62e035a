//! Lines and dots of meshes over a picture: visible edges of polygons, vertices, and vertex normals.
//!
//! Hidden parts are found with a depth map, drawn from the same triangles as the picture. Lines and dots have
//! positions in the room, so that the window can draw them as the camera moves on.

use glam::{Mat4, Vec2, Vec3, Vec4};
use rayon::prelude::*;

use super::{
    DisplayTransform, Settings, Shot,
    lights::Lights,
    meshes::{MeshStore, Meshes},
    object::{Draw, Face, Posed},
    raster::{self, Screen},
};
use crate::{
    channel::{DebugChannel, colours::EDGE},
    debug::{Shows, Vertex},
    registry::Registry,
    scene::{Object, Scene, observer::clip_from_room},
    shading::Stage,
};

/// Minimum distance from the eye, in metres.
const NEAR: f32 = 0.05;
/// Relative distance behind the surface up to which a point lies on it.
const ON_IT: f32 = 0.003;
/// Maximum number of steps along an edge.
const STEPS: f32 = 4096.0;
/// Length, in pixels, below which a piece of a hidden edge is only a speck at the rim of the object in front.
const SPECK: f32 = 2.0;
/// Length of a normal, relative to the height of the picture.
const NORMAL: f32 = 0.026;
/// Length of an edge below which it is fainter, in pixels.
const SHORT: f32 = 9.0;
/// Minimum opacity of an edge.
const FAINT: f32 = 0.2;
/// Number of objects processed at a time: bounds the memory.
const AT_ONCE: usize = 64;

/// A line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// End points in the room.
    pub ends: [Vec3; 2],
    /// Display code.
    pub colour: [u8; 3],
    /// Opacity: fine meshes have faint edges, so that the surface stays visible.
    pub opacity: f32,
}

/// A dot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dot {
    /// Position in the room.
    pub at: Vec3,
    /// Display code.
    pub colour: [u8; 3],
}

impl Dot {
    /// The display code of the dot's rim, for contrast.
    #[must_use]
    pub fn rim(&self) -> [u8; 3] {
        if self.colour.iter().any(|code| *code > 70) { [8; 3] } else { [150; 3] }
    }
}

/// The visible lines and dots of some objects.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Wires {
    /// The lines.
    pub lines: Vec<Line>,
    /// The dots.
    pub dots: Vec<Dot>,
    /// Number of objects drawn.
    pub drawn: usize,
    /// Number of objects in the picture; larger than `drawn` if there would be too many lines.
    pub objects: usize,
}

impl Wires {
    /// A remark about omitted objects, if any.
    #[must_use]
    pub fn remark(&self) -> Option<String> {
        (self.drawn < self.objects)
            .then(|| format!("only the {} nearest of {} objects", self.drawn, self.objects))
    }
}

/// Finds lines and dots, building the meshes of the scene only once.
#[derive(Debug, Default)]
pub struct WireDrawer {
    meshes: MeshStore,
}

impl WireDrawer {
    /// The lines and dots of a channel in a picture of a scene: those of the nearest objects, until there are
    /// at least `most`.
    pub fn wires(
        &mut self,
        scene: &Scene,
        registry: &Registry,
        settings: &Settings,
        channel: DebugChannel,
        most: usize,
    ) -> Wires {
        let mut all = Wires::default();
        self.each(Shot::new(scene, registry, settings), channel, &mut |some| {
            all.objects = some.objects;
            if all.lines.len() + all.dots.len() >= most {
                return false;
            }
            all.drawn += some.drawn;
            all.lines.extend(some.lines);
            all.dots.extend(some.dots);
            true
        });
        all
    }

    /// Passes on lines and dots, some objects at a time and the nearest first, until `take` returns false.
    fn each(&mut self, shot: Shot, channel: DebugChannel, take: &mut dyn FnMut(Wires) -> bool) {
        let Shot { scene, registry, settings, .. } = shot;
        let (width, height) = (settings.width as usize, settings.height as usize);
        if !channel.has_wires() || width == 0 || height == 0 {
            return;
        }
        let mut meshes = Meshes::with(registry, std::mem::take(&mut self.meshes));
        let clip_from_room = clip_from_room(&scene.observer, width as f32 / height as f32);
        let screen = Screen::new(width, height, 1);
        let frustum = raster::frustum(&clip_from_room);
        let eye = scene.observer.position;
        let mut shown: Vec<&Object> = scene.shown().collect();
        shown.sort_by(|a, b| a.position.distance_squared(eye).total_cmp(&b.position.distance_squared(eye)));
        let mut depths = Depths::new(width, height);
        let mut seen = Vec::new();
        for i in 0..shown.len() {
            let Some(draw) = Draw::first(scene, &mut meshes, &shown[i..], &frustum) else { continue };
            seen.push(i);
            let posed = draw.posed(&clip_from_room, &screen);
            for (_, corners) in &posed.visible {
                let clip = corners.map(|c| clip_from_room * posed.positions[c as usize].extend(1.0));
                depths.triangle(clip);
            }
        }
        let lights = Lights::new(scene, registry, settings.terms);
        let display = DisplayTransform::new(&scene.display);
        let view = View { clip_from_room, depths: &depths, eye, up: height as f32 * NORMAL };
        for some in seen.chunks(AT_ONCE) {
            let draws: Vec<_> =
                some.iter().filter_map(|i| Draw::first(scene, &mut meshes, &shown[*i..], &[])).collect();
            let found: Vec<Wires> = draws
                .into_par_iter()
                .map(|draw| {
                    let posed = draw.posed(&clip_from_room, &screen);
                    view.wires(draw, &posed, channel, &lights, &display)
                })
                .collect();
            let mut wires = Wires { drawn: some.len(), objects: seen.len(), ..Wires::default() };
            for one in found {
                wires.lines.extend(one.lines);
                wires.dots.extend(one.dots);
            }
            if !take(wires) {
                break;
            }
        }
        self.meshes = meshes.into_store();
    }
}

/// Draws the lines and dots of a channel over its picture: red, green and blue, row by row from the top.
pub fn draw_wires(
    rgb8: &mut [u8],
    scene: &Scene,
    registry: &Registry,
    settings: &Settings,
    channel: DebugChannel,
) {
    let size = [settings.width, settings.height];
    let aspect = size[0] as f32 / size[1] as f32;
    let clip_from_room = clip_from_room(&scene.observer, aspect);
    let mut canvas = Canvas { rgb8, size: size.map(|side| side as usize) };
    // As thick as in a picture of 720 lines.
    let unit = (size[1] as f32 / 720.0).max(1.0);
    let place = |p: Vec3| on_screen(clip_from_room * p.extend(1.0), size.map(|side| side as f32));
    WireDrawer::default().each(Shot::new(scene, registry, settings), channel, &mut |wires| {
        for line in &wires.lines {
            if let [Some(a), Some(b)] = line.ends.map(place) {
                canvas.line([a, b], 0.55 * unit, line.colour, line.opacity);
            }
        }
        for dot in &wires.dots {
            if let Some(at) = place(dot.at) {
                canvas.line([at, at], 3.4 * unit, dot.rim(), 1.0);
                canvas.line([at, at], 2.4 * unit, dot.colour, 1.0);
            }
        }
        true
    });
}

/// The position of a point in a picture; `None` behind the eye.
fn on_screen(clip: Vec4, [width, height]: [f32; 2]) -> Option<Vec2> {
    (clip.w > NEAR).then(|| {
        let at = clip.truncate() / clip.w;
        Vec2::new((0.5 + 0.5 * at.x) * width, (0.5 - 0.5 * at.y) * height)
    })
}

/// The picture, for one object after the other.
struct View<'a> {
    clip_from_room: Mat4,
    depths: &'a Depths,
    eye: Vec3,
    /// Length of a normal, in pixels.
    up: f32,
}

impl View<'_> {
    fn wires(
        &self,
        draw: Draw,
        posed: &Posed,
        channel: DebugChannel,
        lights: &Lights,
        display: &DisplayTransform,
    ) -> Wires {
        let mut wires = Wires::default();
        let shows = &channel.declaration().shows;
        let (Shows::Normals(colour_of) | Shows::Dots(colour_of)) = shows else {
            let edges = edges(&draw, &posed.visible);
            let ends = |edge: [u32; 2]| edge.map(|corner| posed.positions[corner as usize]);
            wires.lines.extend(edges.into_iter().flat_map(|edge| self.in_sight(ends(edge))));
            return wires;
        };
        let mut vertices: Vec<u32> = posed.visible.iter().flat_map(|(_, corners)| *corners).collect();
        vertices.sort_unstable();
        vertices.dedup();
        let gouraud = draw.stage == Stage::Vertex;
        // Corners are vertices, wherever the shading model runs.
        let draw = Draw { stage: if gouraud { Stage::Vertex } else { Stage::Pixel }, ..draw };
        let lighting = draw.under(lights);
        for vertex in vertices {
            let corner = draw.corner(posed, vertex as usize);
            let clip = self.clip_from_room * corner.position.extend(1.0);
            if !self.depths.shows(clip) {
                continue;
            }
            let normal = corner.normal.normalize_or_zero();
            let colour = || display.apply(draw.shading.vertex(&lighting, &corner).colour.extend(1.0), None);
            let colour = colour_of(&Vertex { normal, colour: gouraud.then_some(&colour) });
            if matches!(shows, Shows::Dots(_)) {
                wires.dots.push(Dot { at: corner.position, colour });
            } else {
                // Normals have the same length in the picture, wherever they are in the room.
                let scale = self.depths.points_per_tangent(&self.clip_from_room);
                let length = self.up * clip.w / scale;
                let ends = [corner.position, corner.position + length * normal];
                let towards = ends[1].distance_squared(self.eye) > 1e-6;
                wires.lines.extend(towards.then_some(Line { ends, colour, opacity: 1.0 }));
            }
        }
        wires
    }

    /// The visible pieces of an edge.
    fn in_sight(&self, ends: [Vec3; 2]) -> Vec<Line> {
        let mut clip = ends.map(|p| self.clip_from_room * p.extend(1.0));
        let mut part = [0.0, 1.0];
        for i in 0..2 {
            let (here, there) = (clip[i].w, clip[1 - i].w);
            if here < NEAR {
                if there < NEAR {
                    return Vec::new();
                }
                let t = (NEAR - here) / (there - here);
                part[i] += t * (part[1 - i] - part[i]);
                clip[i] = clip[i].lerp(clip[1 - i], t);
            }
        }
        let places = clip.map(|c| on_screen(c.with_w(c.w.max(1.01 * NEAR)), self.depths.sides()));
        let [Some(a), Some(b)] = places else { return Vec::new() };
        let pixels = a.distance(b);
        let opacity = (pixels / SHORT).clamp(FAINT, 1.0);
        let count = pixels.ceil().clamp(1.0, STEPS);
        let at = |t: f32| ends[0].lerp(ends[1], part[0] + t * (part[1] - part[0]));
        let shows = |k: usize| self.depths.shows(clip[0].lerp(clip[1], (k as f32 + 0.5) / count));
        let (count, mut pieces, mut first) = (count as usize, Vec::new(), None);
        for k in 0..=count {
            let here = k < count && shows(k);
            if here {
                first.get_or_insert(k);
            } else if let Some(from) = first.take() {
                let part = (k - from) as f32 / count as f32;
                if part == 1.0 || part * pixels >= SPECK {
                    let ends = [from, k].map(|k| at(k as f32 / count as f32));
                    pieces.push(Line { ends, colour: EDGE, opacity });
                }
            }
        }
        pieces
    }
}

/// The edges of the visible polygons, each once.
fn edges(draw: &Draw, visible: &[Face]) -> Vec<[u32; 2]> {
    let mut polygons: Vec<u32> = visible.iter().map(|(polygon, _)| *polygon).collect();
    polygons.dedup();
    let of_polygon = |polygon: u32| {
        let corners = draw.shape.mesh.polygons[polygon as usize].corners();
        let next = corners.iter().cycle().skip(1);
        corners.iter().zip(next).map(|(a, b)| [*a.min(b), *a.max(b)]).collect::<Vec<_>>()
    };
    let mut edges: Vec<_> = polygons.into_iter().flat_map(of_polygon).collect();
    edges.sort_unstable();
    edges.dedup();
    edges
}

/// The nearest surface at the centre of each pixel: 1/w, 0 without a surface.
struct Depths {
    width: usize,
    height: usize,
    nearness: Vec<f32>,
}

impl Depths {
    fn new(width: usize, height: usize) -> Self {
        Self { width, height, nearness: vec![0.0; width * height] }
    }

    fn sides(&self) -> [f32; 2] {
        [self.width as f32, self.height as f32]
    }

    /// Pixels per unit of the tangent.
    fn points_per_tangent(&self, clip_from_room: &Mat4) -> f32 {
        // The row of y has the length of its scale: rotations preserve lengths.
        0.5 * self.height as f32 * clip_from_room.row(1).truncate().length()
    }

    /// Draws a triangle in clip space.
    fn triangle(&mut self, clip: [Vec4; 3]) {
        // The part behind the eye is clipped.
        let mut corners: Vec<Vec4> = Vec::with_capacity(4);
        for i in 0..3 {
            let (a, b) = (clip[i], clip[(i + 1) % 3]);
            if a.w >= NEAR {
                corners.push(a);
            }
            if (a.w >= NEAR) != (b.w >= NEAR) {
                corners.push(a.lerp(b, (NEAR - a.w) / (b.w - a.w)));
            }
        }
        let sides = self.sides();
        let place = |c: &Vec4| {
            let at = c.truncate() / c.w;
            Vec3::new((0.5 + 0.5 * at.x) * sides[0], (0.5 - 0.5 * at.y) * sides[1], 1.0 / c.w)
        };
        let corners: Vec<Vec3> = corners.iter().map(place).collect();
        for i in 2..corners.len() {
            self.fill([corners[0], corners[i - 1], corners[i]]);
        }
    }

    /// Fills a triangle of the picture; 1/w is linear there.
    fn fill(&mut self, [a, b, c]: [Vec3; 3]) {
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        let range = |low: f32, high: f32, side: usize| {
            let from = (low - 0.5).ceil().max(0.0) as usize;
            from..((high - 0.5).floor() + 1.0).clamp(0.0, side as f32) as usize
        };
        let (u, v) = ((b - a).truncate(), (c - a).truncate());
        let area = u.perp_dot(v);
        if area == 0.0 || !area.is_finite() {
            return;
        }
        for y in range(low.y, high.y, self.height) {
            for x in range(low.x, high.x, self.width) {
                let p = Vec2::new(x as f32 + 0.5, y as f32 + 0.5) - a.truncate();
                let [s, t] = [p.perp_dot(v) / area, u.perp_dot(p) / area];
                if s >= 0.0 && t >= 0.0 && s + t <= 1.0 {
                    let near = a.z + s * (b.z - a.z) + t * (c.z - a.z);
                    let known = &mut self.nearness[y * self.width + x];
                    *known = known.max(near);
                }
            }
        }
    }

    /// True if no surface hides a point; a point on the farthest surface of the surrounding pixels is not
    /// hidden.
    fn shows(&self, clip: Vec4) -> bool {
        let Some(at) = on_screen(clip, self.sides()) else { return false };
        if at.x < 0.0 || at.y < 0.0 || at.x >= self.width as f32 || at.y >= self.height as f32 {
            return false;
        }
        let (x, y) = (at.x as usize, at.y as usize);
        let mut farthest = f32::INFINITY;
        for row in y.saturating_sub(1)..(y + 2).min(self.height) {
            for column in x.saturating_sub(1)..(x + 2).min(self.width) {
                farthest = farthest.min(self.nearness[row * self.width + column]);
            }
        }
        1.0 / clip.w >= farthest * (1.0 - ON_IT)
    }
}

/// A picture on which lines are drawn.
struct Canvas<'a> {
    rgb8: &'a mut [u8],
    size: [usize; 2],
}

impl Canvas<'_> {
    /// Draws a line with round ends and smooth sides, or a disc if its ends are equal.
    fn line(&mut self, [a, b]: [Vec2; 2], half: f32, colour: [u8; 3], opacity: f32) {
        let along = b - a;
        let squared = along.length_squared();
        let reach = half + 1.0;
        let range = |low: f32, high: f32, side: usize| {
            (low - reach).floor().max(0.0) as usize..((high + reach).ceil().clamp(0.0, side as f32)) as usize
        };
        let [width, height] = self.size;
        for y in range(a.y.min(b.y), a.y.max(b.y), height) {
            // Only the part of the row that the line covers.
            let row = y as f32 + 0.5;
            let (mut low, mut high) = (a.x.min(b.x), a.x.max(b.x));
            if along.y.abs() > 1e-3 {
                let at = |y: f32| a.x + ((y - a.y) / along.y).clamp(0.0, 1.0) * along.x;
                let (from, to) = (at(row - reach), at(row + reach));
                (low, high) = (from.min(to), from.max(to));
            }
            for x in range(low, high, width) {
                let p = Vec2::new(x as f32 + 0.5, row) - a;
                let t = if squared > 0.0 { (p.dot(along) / squared).clamp(0.0, 1.0) } else { 0.0 };
                let covered = (half + 0.5 - p.distance(t * along)).clamp(0.0, 1.0) * opacity;
                if covered > 0.0 {
                    let pixel = &mut self.rgb8[3 * (y * width + x)..][..3];
                    for (code, new) in pixel.iter_mut().zip(colour) {
                        *code =
                            (f32::from(*code) + covered * (f32::from(new) - f32::from(*code))).round() as u8;
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests;
