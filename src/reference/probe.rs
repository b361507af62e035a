//! One pixel of a picture with everything that led to it: the renderer itself, on a picture of one pixel, watched.

use std::{
    cell::RefCell,
    sync::{Arc, Mutex, PoisonError},
};

use glam::{Mat4, Vec3, Vec4};

use super::{
    Settings,
    lighting::{Lights, LightsOn, light_by_light},
    meshes::{MeshStore, Meshes},
    object::{Draw, Face, Posed, hidden},
    raster::{self, Screen, Tile},
};
use crate::{
    reflection::Surface,
    registry::Registry,
    scene::{Scene, observer::clip_from_room},
    shading::{Corner, Lighting, PhongShading, Shading, Stage, Varying},
};

pub(crate) use super::lighting::{LitBy, Loop, Point};

/// The object at a pixel, and the way from its corners to the light of the pixel.
pub(crate) struct Probe {
    /// Its place among the objects of the scene.
    pub(crate) object: usize,
    pub(crate) surface: Arc<dyn Surface>,
    pub(crate) stage: Stage,
    /// The number of the polygon in the mesh.
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
    /// The points at which it ran for the pixel.
    pub(crate) at_pixel: Vec<Point>,
    /// The point at which Phong shading would have run it, unless the shading model runs it per pixel.
    pub(crate) phong: Option<Point>,
    /// The light of the pixel and its coverage.
    pub(crate) light: Vec4,
}

/// A corner of a triangle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ProbeCorner {
    /// The number of the vertex in the mesh.
    pub(crate) vertex: usize,
    pub(crate) position: Vec3,
    /// Its weight in the pixel, perspective corrected.
    pub(crate) weight: f32,
    /// The colour calculated there, if the shading model does so.
    pub(crate) colour: Vec3,
}

/// The object at a pixel within the picture; none if there is only background.
pub(crate) fn probe(
    store: &mut MeshStore,
    scene: &Scene,
    registry: &Registry,
    settings: &Settings,
    pixel: [u32; 2],
) -> Option<Probe> {
    let (width, height) = (settings.width as usize, settings.height as usize);
    let pixel = pixel.map(|c| c as usize);
    let screen = Screen::of_pixel(width, height, pixel);
    let clip_from_room = clip_from_room(&scene.observer, width as f32 / height as f32);
    let beam = raster::frustum(&(narrowed([width, height], pixel) * clip_from_room));
    let mut meshes = Meshes::with(registry, std::mem::take(store));
    let (indices, shown): (Vec<_>, Vec<_>) =
        scene.objects.iter().enumerate().filter(|(_, object)| object.visible).unzip();

    // In the order of the renderer: of equally near triangles, the first is seen.
    let mut nearest = Tile::<1, 1>::new();
    let mut found = None;
    for (i, object) in shown.iter().enumerate() {
        let Some(shape) = meshes.first(&shown[i..]).filter(|shape| !hidden(object, shape, &beam)) else {
            continue;
        };
        let Some(draw) = Draw::new(scene, registry, object, shape) else { continue };
        let posed = draw.posed(&clip_from_room, &screen);
        let mut front = None;
        for &face in &posed.visible {
            // Red at the first corner, green at the second and blue at the third: the colour interpolated by the
            // renderer is the weights.
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
            found = Some((indices[i], draw, posed, face, weights));
        }
    }
    *store = meshes.into_store();
    let (object, draw, posed, face, weights) = found?;
    let lights = Lights::new(scene, registry, settings.terms);
    let lighting = Asked { lighting: lights.on(&*draw.surface), points: RefCell::default() };
    Some(shaded(object, &draw, &posed, face, weights, &lighting, &screen, pixel))
}

/// The light loop at a point of an object, light by light.
pub(crate) fn light_loop(
    scene: &Scene,
    registry: &Registry,
    settings: &Settings,
    surface: &dyn Surface,
    point: &Point,
) -> Loop {
    light_by_light(scene, registry, settings.terms, surface, point)
}

/// The change of clip space that makes a pixel, and a pixel around it, all of the picture.
fn narrowed(size: [usize; 2], pixel: [usize; 2]) -> Mat4 {
    let [x, y]: [f32; 2] = std::array::from_fn(|i| 2.0 * (pixel[i] as f32 + 0.5) / size[i] as f32 - 1.0);
    let [across, down] = size.map(|side| side as f32 / 3.0);
    Mat4::from_scale(Vec3::new(across, down, 1.0)) * Mat4::from_translation(Vec3::new(-x, y, 0.0))
}

/// Shades a triangle that is seen, once more and watched.
fn shaded(
    object: usize,
    draw: &Draw,
    posed: &Posed,
    face: Face,
    weights: Vec3,
    lighting: &Asked,
    screen: &Screen,
    pixel: [usize; 2],
) -> Probe {
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
    let at = (draw, posed, face, screen);
    let watched = Watched::new(Some(&*draw.shading));
    let mut tile = Tile::<1, 1>::new();
    render(at, varyings, &watched, lighting, &mut tile, pixel);
    let (varying, face_normal) = watched.seen().unwrap_or_default();
    let at_pixel = lighting.points.take();
    let light = tile.resolve().next().unwrap_or_default();

    let phong = (draw.stage != Stage::Pixel).then(|| {
        // Its corners are vertices, whatever those of the shading model are.
        let phong = Draw {
            object: draw.object,
            shape: draw.shape.clone(),
            stage: Stage::Pixel,
            shading: Box::new(PhongShading::default()),
            surface: draw.surface.clone(),
            anisotropic: draw.anisotropic,
        };
        let varyings =
            phong.varyings(posed, face, |i| phong.shading.vertex(lighting, &phong.corner(posed, i as usize)));
        let at = (&phong, posed, face, screen);
        render(at, varyings, &*phong.shading, lighting, &mut Tile::<1, 1>::new(), pixel);
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

/// The light loop, which remembers where it ran.
struct Asked<'a> {
    lighting: LightsOn<'a>,
    points: RefCell<Vec<Point>>,
}

impl Lighting for Asked<'_> {
    fn colour(&self, position: Vec3, normal: Vec3, tangent: Vec3) -> Vec3 {
        let colour = self.lighting.colour(position, normal, tangent);
        self.points.borrow_mut().push(Point { position, normal, tangent, colour });
        colour
    }
}

struct NoLight;

impl Lighting for NoLight {
    fn colour(&self, _position: Vec3, _normal: Vec3, _tangent: Vec3) -> Vec3 {
        Vec3::ZERO
    }
}

/// A shading model, or none, and the last pixel that was to be shaded with it: interpolated values, normal of the
/// triangle.
struct Watched<'a> {
    shading: Option<&'a dyn Shading>,
    seen: Mutex<Option<(Varying, Vec3)>>,
}

impl<'a> Watched<'a> {
    fn new(shading: Option<&'a dyn Shading>) -> Self {
        Self { shading, seen: Mutex::default() }
    }

    fn seen(self) -> Option<(Varying, Vec3)> {
        self.seen.into_inner().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Shading for Watched<'_> {
    fn vertex(&self, lighting: &dyn Lighting, corner: &Corner) -> Varying {
        self.shading.map_or_else(Varying::default, |shading| shading.vertex(lighting, corner))
    }

    fn pixel(&self, lighting: &dyn Lighting, varying: &Varying, face_normal: Vec3) -> Vec3 {
        *self.seen.lock().unwrap_or_else(PoisonError::into_inner) = Some((*varying, face_normal));
        self.shading.map_or(Vec3::ZERO, |shading| shading.pixel(lighting, varying, face_normal))
    }
}
