//! A lobe in the picture: translucent, drawn back to front, with an outline.

use std::collections::HashMap;

use bevy_egui::egui::{Mesh, Painter};

use super::room::Room;
use crate::{
    curves::{
        Lobe,
        draw::{Axis, COLOURS},
        lobe::{edges, length},
    },
    optics::viridis::viridis,
    panel::{
        marks::{Ink, Lens, OUTLINE},
        prelude::*,
    },
};

/// Length of a vector in the picture plane, and of the largest value of the scale, in points.
pub(super) const LENGTH: f32 = 96.0;
/// Opacity of the surface.
const OPACITY: f32 = 0.68;
/// Brightness of the surface at grazing angles.
const SIDE: f32 = 0.45;

/// The lobe for one light.
#[derive(Debug)]
pub struct LightLobe {
    /// Index of the light in the scene.
    pub light: usize,
    /// Name of the light.
    pub name: String,
    /// Direction to the light; for a light with extent, the direction that contributes most.
    pub l: Vec3,
    /// True if the light has extent.
    pub extends: bool,
    /// The lobe.
    pub lobe: Lobe,
    /// Edges that may belong to the outline.
    pub(super) rims: Vec<Rim>,
}

/// Colour of a lobe among several.
pub(super) fn tint(number: usize) -> [u8; 3] {
    let lighter = |c: u8| c + (255 - c) / 4;
    COLOURS[number % COLOURS.len()].map(lighter)
}

/// An edge of the surface with its adjacent triangles: only one at the rim or at a gap.
pub(super) type Rim = ([u32; 2], [Option<u32>; 2]);

/// The edges of a lobe.
pub(super) fn rims(lobe: &Lobe) -> Vec<Rim> {
    let mut all: HashMap<[u32; 2], [Option<u32>; 2]> = HashMap::new();
    for (i, corners) in lobe.triangles.iter().enumerate() {
        for edge in edges(*corners) {
            let sides = all.entry(edge).or_default();
            sides[usize::from(sides[0].is_some())] = Some(i as u32);
        }
    }
    let mut all: Vec<_> = all.into_iter().collect();
    all.sort_unstable();
    all
}

/// A lobe as projected into the picture.
struct Drawn {
    places: Vec<Option<Pos2>>,
    colours: Vec<Color32>,
    /// Distance of each triangle from the eye.
    depths: Vec<f32>,
    /// True for each triangle seen from outside.
    outside: Vec<bool>,
}

fn drawn(lens: &Lens, from: Vec3, lobe: &Lobe, scale: &Axis, colour: impl Fn(f32) -> Vec3) -> Drawn {
    let reach = lens.metres(from, LENGTH);
    let lengths: Vec<_> = lobe.values.iter().map(|value| length(scale, *value)).collect();
    let points: Vec<_> =
        lobe.ways.iter().zip(&lengths).map(|(way, length)| from + *way * (reach * length)).collect();
    let places: Vec<_> = points.iter().map(|p| lens.project(*p)).collect();
    let mut normals = vec![Vec3::ZERO; points.len()];
    let (mut depths, mut outside) = (Vec::new(), Vec::new());
    for corners in &lobe.triangles {
        let [a, b, c] = corners.map(|i| points[i as usize]);
        let normal = (b - a).cross(c - a);
        for i in corners {
            normals[*i as usize] += normal;
        }
        let middle = (a + b + c) / 3.0;
        depths.push(middle.distance_squared(lens.eye));
        outside.push(normal.dot(lens.eye - middle) > 0.0);
    }
    let shaded = |i: usize| {
        let towards = (lens.eye - points[i]).normalize_or_zero();
        let shade = SIDE + (1.0 - SIDE) * normals[i].normalize_or_zero().dot(towards).abs();
        let [r, g, b] = (255.0 * shade * colour(lengths[i])).to_array().map(|c| c.round() as u8);
        Color32::from_rgba_unmultiplied(r, g, b, (255.0 * OPACITY) as u8)
    };
    let colours = (0..points.len()).map(shaded).collect();
    Drawn { places, colours, depths, outside }
}

/// Paints lobes over a point: a single one coloured by value, several in distinct colours, each with a line to its
/// light. Marks their area in the picture as occupied.
pub(super) fn paint(
    ui: &Ui,
    rect: Rect,
    session: &Session,
    from: Vec3,
    lobes: &[LightLobe],
    scale: &Axis,
    room: &mut Room,
) {
    let lens = Lens::of(session, rect);
    let own = |i: usize| Vec3::from(tint(i).map(|c| f32::from(c) / 255.0));
    let colour = |i: usize, length: f32| if lobes.len() == 1 { viridis(length) } else { own(i) };
    let all: Vec<_> = lobes
        .iter()
        .enumerate()
        .map(|(i, light)| drawn(&lens, from, &light.lobe, scale, |length| colour(i, length)))
        .collect();
    let mut order: Vec<(usize, usize)> =
        all.iter().enumerate().flat_map(|(i, lobe)| (0..lobe.depths.len()).map(move |k| (i, k))).collect();
    order.sort_by(|a, b| all[b.0].depths[b.1].total_cmp(&all[a.0].depths[a.1]));
    let mut mesh = Mesh::default();
    let mut first = Vec::new();
    for lobe in &all {
        first.push(mesh.vertices.len() as u32);
        for (place, colour) in lobe.places.iter().zip(&lobe.colours) {
            mesh.colored_vertex(place.unwrap_or_default(), *colour);
        }
    }
    for (i, k) in order {
        let corners = lobes[i].lobe.triangles[k];
        if let [Some(a), Some(b), Some(c)] = corners.map(|corner| all[i].places[corner as usize]) {
            room.take_triangle([a, b, c], rect);
            let [a, b, c] = corners.map(|corner| first[i] + corner);
            mesh.add_triangle(a, b, c);
        }
    }
    let painter = ui.painter_at(rect);
    painter.add(Shape::mesh(mesh));
    for (i, light) in lobes.iter().enumerate() {
        let lobe = &all[i];
        let line = if lobes.len() == 1 { Color32::WHITE } else { own_colour(i) };
        let seen = |k: u32| lobe.outside[k as usize];
        for (edge, sides) in &light.rims {
            let around = match sides {
                [Some(a), Some(b)] => seen(*a) != seen(*b),
                _ => true,
            };
            let [Some(a), Some(b)] = edge.map(|corner| lobe.places[corner as usize]) else { continue };
            if around {
                painter.line_segment([a, b], Stroke::new(2.5, OUTLINE.gamma_multiply(0.35)));
                painter.line_segment([a, b], Stroke::new(1.0, line.gamma_multiply(0.85)));
            }
        }
    }
    if lobes.len() > 1 {
        directions(&painter, lens, from, lobes);
    }
}

/// Paints the directions of several lights, each in the colour of its lobe.
fn directions(painter: &Painter, lens: Lens, from: Vec3, lobes: &[LightLobe]) {
    let mut ink = Ink::new(lens);
    for (i, light) in lobes.iter().enumerate() {
        let end = from + light.l * lens.metres(from, LENGTH);
        for run in lens.path(&[from, end]) {
            ink.stroke(run, 1.5, own_colour(i));
        }
        if let Some(end) = lens.project(end) {
            ink.disc(end, 3.0, own_colour(i));
        }
    }
    ink.paint(painter);
}

/// The colour of the lobe of a light among several.
fn own_colour(i: usize) -> Color32 {
    let [r, g, b] = tint(i);
    Color32::from_rgb(r, g, b)
}
