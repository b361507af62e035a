//! One pixel of a picture with everything that led to it: the renderer itself draws a picture of one pixel
//! and records its calculation.

use std::{
    cell::RefCell,
    sync::{Arc, Mutex},
};

use glam::{Mat4, Vec3, Vec4};

use super::{
    Shot,
    lighting::LightsOn,
    lights::Lights,
    meshes::{MeshStore, Meshes},
    nearest::nearest,
    object::{Draw, Face, Posed},
    raster::{self, Screen, Tile},
};
use crate::{
    caught::{lock, unpoisoned},
    reflection::Surface,
    registry::Registry,
    scene::{Observer, Scene, observer::clip_from_room},
    shading::{Corner, Lighting, PhongShading, Shading, Stage, Varying},
};

pub(crate) use super::lighting::{LitBy, Loop, Point, light_by_light as light_loop};
pub(crate) use super::through::Body;
pub use super::{inside::Turn, through::Inside};

/// The object at a pixel, and the calculation of the pixel's light.
pub(crate) struct Probe {
    /// Index among the objects of the scene.
    pub(crate) object: usize,
    pub(crate) surface: Arc<dyn Surface>,
    /// The body behind the surface, if it is solid.
    pub(crate) body: Option<Body>,
    pub(crate) stage: Stage,
    /// Index of the polygon in the mesh.
    pub(crate) polygon: usize,
    /// The corners of that polygon.
    pub(crate) outline: Vec<Vec3>,
    /// The corners of the triangle that covers the pixel's centre.
    pub(crate) corners: [ProbeCorner; 3],
    /// The values interpolated between them.
    pub(crate) varying: Varying,
    /// The normal of the triangle.
    pub(crate) face_normal: Vec3,
    /// The points at which the light loop ran for the polygon, or for each of its corners.
    pub(crate) at_corners: Vec<(usize, Point)>,
    /// The points at which the light loop ran for the pixel.
    pub(crate) at_pixel: Vec<Point>,
    /// The point at which Phong shading would have run the light loop, unless the shading model runs it per
    /// pixel.
    pub(crate) phong: Option<Point>,
    /// The light of the pixel and its coverage.
    pub(crate) light: Vec4,
}

/// A corner of the triangle that covers a pixel.
#[derive(Clone, Copy, Debug)]
pub struct ProbeCorner {
    /// Index of the vertex in the object's mesh.
    pub vertex: usize,
    /// Position in the room.
    pub position: Vec3,
    /// Weight in the pixel, with perspective correction; the three add up to 1.
    pub weight: f32,
    /// The colour calculated there by the shading model; zero for models that calculate it elsewhere.
    pub colour: Vec3,
}

/// A triangle of an object, and the weights of its corners at the point in question.
struct Found<'a> {
    object: usize,
    draw: Draw<'a>,
    posed: Posed,
    face: Face,
    weights: Vec3,
}

/// The object at a pixel within the picture; `None` for background.
pub(crate) fn probe(store: &mut MeshStore, shot: Shot, pixel: [u32; 2]) -> Option<Probe> {
    let size = [shot.settings.width as usize, shot.settings.height as usize];
    let pixel = pixel.map(|c| c as usize);
    let found = first(store, (shot.scene, shot.registry), &shot.scene.observer, size, pixel)?;
    let screen = Screen::of_pixel(size[0], size[1], pixel);
    Some(shaded(&found, shot, &At::Pixel(&screen, pixel)))
}

/// The point of an object's surface nearest to a point with a normal, in the coordinates of its mesh: shaded
/// as if a pixel showed it.
pub(crate) fn probe_point(
    store: &mut MeshStore,
    shot: Shot,
    index: usize,
    [point, normal]: [Vec3; 2],
) -> Option<Probe> {
    let object = shot.scene.objects.get(index)?;
    let mut meshes = Meshes::with(shot.registry, std::mem::take(store));
    let draw = Draw::first(shot.scene, &mut meshes, &[object], &[]);
    *store = meshes.into_store();
    let draw = draw?;
    let (face, weights) = nearest(&draw.shape.mesh, point, normal)?;
    let posed = draw.posed(&Mat4::IDENTITY, &Screen::new(1, 1, 1));
    let found = Found { object: index, draw, posed, face, weights };
    Some(shaded(&found, shot, &At::Point(weights)))
}

/// The object and the position that an eye sees in the direction of a point.
pub(crate) fn towards(
    store: &mut MeshStore,
    scene: &Scene,
    registry: &Registry,
    [eye, point]: [Vec3; 2],
) -> Option<(usize, Vec3)> {
    /// Field of view of a picture of one pixel, in degrees.
    const NARROW: f32 = 0.1;
    let observer = Observer { field_of_view: NARROW, ..Observer::at(eye, point - eye) };
    let Found { object, posed, face: (_, corners), weights, .. } =
        first(store, (scene, registry), &observer, [1, 1], [0, 0])?;
    let [a, b, c] = corners.map(|i| posed.positions[i as usize]);
    Some((object, a * weights.x + b * weights.y + c * weights.z))
}

/// The nearest triangle at a pixel.
fn first<'a>(
    store: &mut MeshStore,
    (scene, registry): (&'a Scene, &'a Registry),
    observer: &Observer,
    size: [usize; 2],
    pixel: [usize; 2],
) -> Option<Found<'a>> {
    let screen = Screen::of_pixel(size[0], size[1], pixel);
    let clip_from_room = clip_from_room(observer, size[0] as f32 / size[1] as f32);
    let beam = raster::frustum(&(narrowed(size, pixel) * clip_from_room));
    let mut meshes = Meshes::with(registry, std::mem::take(store));
    let (indices, shown): (Vec<_>, Vec<_>) =
        scene.objects.iter().enumerate().filter(|(_, object)| object.visible).unzip();

    // In the renderer's order: the first of equally near triangles is visible.
    let mut nearest = Tile::<1, 1>::new();
    let mut found = None;
    for (i, &index) in indices.iter().enumerate() {
        let Some(draw) = Draw::first(scene, &mut meshes, &shown[i..], &beam) else { continue };
        let posed = draw.posed(&clip_from_room, &screen);
        let mut front = None;
        for &face in &posed.visible {
            // Red at the first corner, green at the second and blue at the third: the interpolated colour
            // consists of the weights.
            let mut colours = [Vec3::X, Vec3::Y, Vec3::Z].into_iter();
            let varyings = draw.varyings(&posed, face, |_| Varying {
                colour: colours.next().unwrap_or_default(),
                ..Varying::default()
            });
            let watched = Watched::new(None);
            let at = (&draw, &posed, face, &screen);
            render(at, varyings, &watched, &NoLight, &mut nearest, pixel);
            if let Some((varying, _)) = watched.seen() {
                front = Some((face, varying.colour));
            }
        }
        if let Some((face, weights)) = front {
            found = Some(Found { object: index, draw, posed, face, weights });
        }
    }
    *store = meshes.into_store();
    found
}

/// The clip-space transformation that makes a pixel, with a pixel around it, fill the picture.
fn narrowed(size: [usize; 2], pixel: [usize; 2]) -> Mat4 {
    let [x, y]: [f32; 2] = std::array::from_fn(|i| 2.0 * (pixel[i] as f32 + 0.5) / size[i] as f32 - 1.0);
    let [across, down] = size.map(|side| side as f32 / 3.0);
    Mat4::from_scale(Vec3::new(across, down, 1.0)) * Mat4::from_translation(Vec3::new(-x, y, 0.0))
}

/// The position at which a triangle is shaded.
enum At<'a> {
    /// The centre of a pixel, shaded by the renderer.
    Pixel(&'a Screen, [usize; 2]),
    /// The point with these weights of the corners.
    Point(Vec3),
}

impl At<'_> {
    /// The light there, and its coverage.
    fn light(
        &self,
        (draw, posed, face): (&Draw, &Posed, Face),
        varyings: [Varying; 3],
        shading: &dyn Shading,
        lighting: &dyn Lighting,
    ) -> Vec4 {
        match self {
            Self::Pixel(screen, pixel) => {
                let mut tile = Tile::<1, 1>::new();
                render((draw, posed, face, screen), varyings, shading, lighting, &mut tile, *pixel);
                tile.resolve().next().unwrap_or_default()
            }
            Self::Point(weights) => {
                let [a, b, c] = varyings.map(|v| v.position);
                let face_normal = (b - a).cross(c - a).normalize_or_zero();
                let varying = raster::between(&varyings, [weights.y, weights.z], draw.anisotropic);
                shading.pixel(lighting, &varying, face_normal).extend(1.0)
            }
        }
    }
}

/// Shades a triangle again, recording the calculation.
fn shaded(found: &Found, Shot { scene, registry, settings, samples }: Shot, at: &At) -> Probe {
    let Found { object, draw, posed, face, weights } = found;
    let (object, face) = (*object, *face);
    let lights = Lights::new(scene, registry, settings.terms).sampled(samples);
    let lighting = &Asked { lighting: draw.under(&lights), points: RefCell::default() };
    let (polygon, corners) = face;
    let per_polygon = draw.stage == Stage::Polygon;
    let mut at_corners: Vec<(usize, Point)> = Vec::new();
    let mut corner = 0;
    let mut of_polygon = None;
    let varyings = draw.varyings(posed, face, |i| {
        let varying =
            *of_polygon.get_or_insert_with(|| draw.shading.vertex(lighting, &draw.corner(posed, i as usize)));
        if !per_polygon {
            of_polygon = None;
        }
        at_corners.extend(lighting.points.take().into_iter().map(|point| (corner, point)));
        corner += 1;
        varying
    });
    let watched = Watched::new(Some(&*draw.shading));
    let light = at.light((draw, posed, face), varyings, &watched, lighting);
    let (varying, face_normal) = watched.seen().unwrap_or_default();
    let at_pixel = lighting.points.take();

    let phong = (draw.stage != Stage::Pixel).then(|| {
        // These corners are vertices, whatever the shading model uses.
        let phong = Draw {
            object: draw.object,
            shape: draw.shape.clone(),
            stage: Stage::Pixel,
            shading: Box::new(PhongShading::default()),
            surface: draw.surface.clone(),
            lobes: draw.lobes,
            body: draw.body.clone(),
            anisotropic: draw.anisotropic,
        };
        let varyings =
            phong.varyings(posed, face, |i| phong.shading.vertex(lighting, &phong.corner(posed, i as usize)));
        at.light((&phong, posed, face), varyings, &*phong.shading, lighting);
        lighting.points.take().pop()
    });
    Probe {
        object,
        stage: draw.stage,
        polygon: polygon as usize,
        outline: draw.shape.mesh.polygons[polygon as usize]
            .corners()
            .iter()
            .map(|i| posed.positions[*i as usize])
            .collect(),
        corners: std::array::from_fn(|i| ProbeCorner {
            vertex: corners[i] as usize,
            position: posed.positions[corners[i] as usize],
            weight: weights[i],
            colour: varyings[i].colour,
        }),
        varying,
        face_normal,
        at_corners,
        at_pixel,
        phong: phong.flatten(),
        light,
        surface: draw.surface.clone(),
        body: draw.body.clone(),
    }
}

/// Draws one triangle into a tile of one pixel.
fn render(
    (draw, posed, face, screen): (&Draw, &Posed, Face, &Screen),
    varyings: [Varying; 3],
    shading: &dyn Shading,
    lighting: &dyn Lighting,
    tile: &mut Tile<1, 1>,
    pixel: [usize; 2],
) {
    draw.set_up(posed, face, varyings, screen, &mut |triangle| {
        tile.draw(&triangle, shading, lighting, pixel, screen);
    });
}

/// A light loop that records where it ran.
struct Asked<'a> {
    lighting: LightsOn<'a>,
    points: RefCell<Vec<Point>>,
}

impl Lighting for Asked<'_> {
    fn begin_pixel(&self, x: u32, y: u32) {
        self.lighting.begin_pixel(x, y);
    }

    fn colour(&self, position: Vec3, normal: Vec3, tangent: Vec3) -> Vec3 {
        let colour = self.lighting.colour(position, normal, tangent);
        let seed = self.lighting.seed();
        self.points.borrow_mut().push(Point { position, normal, tangent, colour, seed });
        colour
    }
}

struct NoLight;

impl Lighting for NoLight {
    fn colour(&self, _position: Vec3, _normal: Vec3, _tangent: Vec3) -> Vec3 {
        Vec3::ZERO
    }
}

/// A shading model, if any, and its last pixel: interpolated values, normal of the triangle.
struct Watched<'a> {
    shading: Option<&'a dyn Shading>,
    seen: Mutex<Option<(Varying, Vec3)>>,
}

impl<'a> Watched<'a> {
    fn new(shading: Option<&'a dyn Shading>) -> Self {
        Self { shading, seen: Mutex::default() }
    }

    fn seen(self) -> Option<(Varying, Vec3)> {
        unpoisoned(self.seen.into_inner())
    }
}

impl Shading for Watched<'_> {
    fn vertex(&self, lighting: &dyn Lighting, corner: &Corner) -> Varying {
        self.shading.map_or_else(Varying::default, |shading| shading.vertex(lighting, corner))
    }

    fn pixel(&self, lighting: &dyn Lighting, varying: &Varying, face_normal: Vec3) -> Vec3 {
        *lock(&self.seen) = Some((*varying, face_normal));
        self.shading.map_or(Vec3::ZERO, |shading| shading.pixel(lighting, varying, face_normal))
    }
}
