//! Light types with a counterpart in Mitsuba.

use std::f32::consts::PI;

use glam::{Mat3, Mat4, Vec2, Vec3};
use rayon::prelude::*;

use super::xml::{Xml, look_at, number, to_world};
use crate::{
    export::File,
    light::{LightEntry, LightRecord, extent::sides},
    optics::{
        colour::Encoding,
        radiometry::{cone, cone_edges},
    },
    parameter::Values,
    scene::observer::orientation,
};

/// An active light.
pub(super) struct Lamp<'a> {
    pub(super) entry: &'a LightEntry,
    pub(super) record: LightRecord,
    pub(super) values: &'a Values,
    /// Index of the light, for file names.
    pub(super) number: usize,
}

/// The counterpart of a light: elements, and a file that they reference.
pub(super) struct Emitter {
    pub(super) xml: Vec<Xml>,
    pub(super) file: Option<File>,
    /// True if it shines from all directions: Mitsuba allows one such emitter.
    pub(super) around: bool,
    /// True if it is a surface, which hides the lights behind it.
    pub(super) hides: bool,
}

/// Returns the counterpart, or the reason why there is none.
type Counterpart = fn(&Lamp) -> Result<Emitter, String>;

const COUNTERPARTS: &[(&str, Counterpart)] = &[
    ("point", point),
    ("spot", spot),
    ("directional", directional),
    ("ambient", ambient),
    ("rectangle", rectangle),
    ("disc", disc),
    ("sphere", sphere),
    ("cylinder", cylinder),
    ("sun", sun),
    ("environment", environment),
];

/// Distance between the sides of a two-sided light, in metres: in one plane, each would hide the other.
const APART: f32 = 1e-3;

/// Distance of the sun, in metres.
const FAR: f32 = 1e5;

/// Widest cone, in degrees: the texture in which Mitsuba looks up the light of a cone is unbounded at 90°.
const WIDEST: f32 = 85.0;

impl Lamp<'_> {
    /// The counterpart of the light.
    pub(super) fn emitter(&self) -> Result<Emitter, String> {
        let id = self.entry.declaration.id;
        match COUNTERPARTS.iter().find(|(known, _)| *known == id) {
            Some((_, counterpart)) => counterpart(self),
            None => Err(format!("Mitsuba has no counterpart of the light type {id}")),
        }
    }

    fn power(&self) -> Vec3 {
        self.record.intensity * self.record.colour
    }

    fn parameter(&self, name: &str) -> f32 {
        self.entry.parameter(name).map_or(0.0, |p| self.values.number(p))
    }

    /// The index of the selected option.
    fn choice(&self, name: &str) -> u32 {
        self.entry.parameter(name).map_or(0, |p| self.values.choice(p))
    }

    /// A shape that emits the luminance of the light.
    fn shining(&self, shape: Xml) -> Xml {
        shining(shape, PI * self.power())
    }

    /// A flat shape between −1 and 1 in x and y, given half of each side in the room; one for each emitting
    /// side.
    fn flat(&self, shape: &str, [x, y]: [Vec3; 2]) -> Result<Emitter, String> {
        let LightRecord { position, direction, .. } = self.record;
        let two_sided = self.choice("two_sided") == 1;
        let apart = if two_sided { 0.5 * APART } else { 0.0 };
        let side = |x: Vec3, front: Vec3| {
            let axes = Mat3::from_cols(x, y, front);
            let matrix = Mat4::from_translation(position + apart * front) * Mat4::from_mat3(axes);
            self.shining(Xml::plugin("shape", shape).with(to_world(matrix)))
        };
        let mut xml = vec![side(x, direction)];
        xml.extend(two_sided.then(|| side(-x, -direction)));
        surface(xml)
    }
}

/// An emitting shape, whose surface is black otherwise.
fn shining(shape: Xml, radiance: Vec3) -> Xml {
    let black = Xml::plugin("bsdf", "diffuse").rgb("reflectance", Vec3::ZERO);
    shape.with(black).with(Xml::plugin("emitter", "area").rgb("radiance", radiance))
}

fn alone(xml: Xml) -> Result<Emitter, String> {
    Ok(Emitter { xml: vec![xml], file: None, around: false, hides: false })
}

fn surface(xml: Vec<Xml>) -> Result<Emitter, String> {
    Ok(Emitter { xml, file: None, around: false, hides: true })
}

fn all_around(xml: Xml) -> Result<Emitter, String> {
    Ok(Emitter { around: true, ..alone(xml)? })
}

/// A point, `<point name="…" x="…" y="…" z="…"/>`, or a vector.
fn place(kind: &str, name: &str, Vec3 { x, y, z }: Vec3) -> Xml {
    Xml::element(format!("{kind} name=\"{name}\" x=\"{x}\" y=\"{y}\" z=\"{z}\""))
}

fn point(lamp: &Lamp) -> Result<Emitter, String> {
    let xml = Xml::plugin("emitter", "point").with(place("point", "position", lamp.record.position));
    alone(xml.rgb("intensity", PI * lamp.power()))
}

fn directional(lamp: &Lamp) -> Result<Emitter, String> {
    let xml = Xml::plugin("emitter", "directional").with(place("vector", "direction", lamp.record.direction));
    alone(xml.rgb("irradiance", PI * lamp.power()))
}

fn rectangle(lamp: &Lamp) -> Result<Emitter, String> {
    let (sine, cosine) = lamp.parameter("roll").to_radians().sin_cos();
    let [x, y] = sides(lamp.record.direction, Vec2::new(sine, cosine));
    lamp.flat("rectangle", [0.5 * lamp.parameter("width") * x, 0.5 * lamp.parameter("height") * y])
}

fn disc(lamp: &Lamp) -> Result<Emitter, String> {
    lamp.flat("disk", sides(lamp.record.direction, Vec2::Y).map(|side| lamp.parameter("radius") * side))
}

fn sphere(lamp: &Lamp) -> Result<Emitter, String> {
    let shape = Xml::plugin("shape", "sphere").with(place("point", "center", lamp.record.position));
    surface(vec![lamp.shining(shape.float("radius", lamp.parameter("radius")))])
}

fn cylinder(lamp: &Lamp) -> Result<Emitter, String> {
    let LightRecord { position, direction, .. } = lamp.record;
    let half = 0.5 * lamp.parameter("length") * direction;
    let [from, to] = [place("point", "p0", position - half), place("point", "p1", position + half)];
    let shape = Xml::plugin("shape", "cylinder").with(from).with(to);
    surface(vec![lamp.shining(shape.float("radius", lamp.parameter("radius")))])
}

/// A disc so far away that it subtends the same angle everywhere in the room. E lux correspond to the
/// luminance E/(π sin²(δ/2)).
fn sun(lamp: &Lamp) -> Result<Emitter, String> {
    let LightRecord { direction, .. } = lamp.record;
    let radius = 0.5 * lamp.parameter("diameter").to_radians();
    let [x, y] = sides(direction, Vec2::Y).map(|side| FAR * radius.tan() * side);
    let matrix = Mat4::from_translation(-FAR * direction) * Mat4::from_mat3(Mat3::from_cols(x, y, direction));
    let disk = Xml::plugin("shape", "disk").with(to_world(matrix));
    surface(vec![shining(disk, lamp.power() / radius.sin().powi(2))])
}

/// Light from all directions: constant, or a picture.
fn environment(lamp: &Lamp) -> Result<Emitter, String> {
    if lamp.choice("source") == 0 {
        return all_around(Xml::plugin("emitter", "constant").rgb("radiance", PI * lamp.power()));
    }
    let path = format!("textures/environment_{}.pfm", lamp.number);
    let map = Xml::plugin("emitter", "envmap").set("string", "filename", &path);
    let light = (lamp.entry.instantiate)(lamp.values, Encoding::default());
    let radiance = |d: Vec3| PI * lamp.record.colour * light.seen(&lamp.record, Vec3::ZERO, d).radiance;
    Ok(Emitter { file: Some(File::new(path, panorama(&radiance))), ..all_around(map)? })
}

/// A picture of all directions in Mitsuba's layout: columns run around the vertical from −z via +x, starting
/// with the first; the centres of the first and last rows are straight above and below. Each pixel is a mean,
/// so that edges are soft.
fn panorama(radiance: &(impl Fn(Vec3) -> Vec3 + Sync)) -> Vec<u8> {
    /// Width in pixels.
    const WIDTH: usize = 1024;
    const HEIGHT: usize = WIDTH / 2 + 1;
    /// Sample points across a pixel: an even number, so that none lies on the horizon, which belongs to the
    /// ground alone.
    const FINE: usize = 4;
    let part = |i: usize| (i as f32 + 0.5) / FINE as f32;
    let pixel = |row: usize, column: usize| {
        let mut sum = Vec3::ZERO;
        for (i, j) in (0..FINE).flat_map(|i| (0..FINE).map(move |j| (i, j))) {
            let down = ((row as f32 + part(i) - 0.5) / (HEIGHT - 1) as f32).clamp(0.0, 1.0);
            let (sin_theta, cos_theta) = (PI * down).sin_cos();
            let (sin_phi, cos_phi) = (2.0 * PI * (column as f32 + part(j)) / WIDTH as f32).sin_cos();
            sum += radiance(Vec3::new(sin_theta * sin_phi, cos_theta, -sin_theta * cos_phi));
        }
        sum / (FINE * FINE) as f32
    };
    // The format starts with the bottom row.
    let rows = (0..HEIGHT).into_par_iter().rev().map(|row| {
        let numbers = (0..WIDTH).flat_map(|column| pixel(row, column).to_array());
        numbers.flat_map(f32::to_le_bytes).collect::<Vec<u8>>()
    });
    let mut bytes = format!("PF\n{WIDTH} {HEIGHT}\n-1.0\n").into_bytes();
    bytes.extend(rows.collect::<Vec<_>>().concat());
    bytes
}

/// A surface with the albedo E responds to the radiance L from all directions with E L, and to our ambient
/// light I with E I.
fn ambient(lamp: &Lamp) -> Result<Emitter, String> {
    all_around(Xml::plugin("emitter", "constant").rgb("radiance", lamp.power()))
}

/// Mitsuba's cone fades linearly with the angle, ours by a cubic of its cosine. The exported cone therefore
/// has no soft edge, and projects our profile as a picture.
fn spot(lamp: &Lamp) -> Result<Emitter, String> {
    let [angle, penumbra] = ["cone_angle", "penumbra"].map(|name| lamp.parameter(name));
    if angle > WIDEST {
        return Err(format!("Mitsuba has a counterpart of cones up to {WIDEST}°, but this one has {angle}°"));
    }
    let LightRecord { position, direction, .. } = lamp.record;
    let xml = Xml::plugin("emitter", "spot")
        .with(look_at(position, direction, orientation(direction).y_axis))
        .rgb("intensity", PI * lamp.power())
        .set("float", "cutoff_angle", &number(angle))
        .set("float", "beam_width", &number(angle));
    if penumbra == 0.0 {
        return alone(xml);
    }
    let path = format!("textures/cone_{}.pfm", lamp.number);
    let texture = Xml::element("texture name=\"texture\" type=\"bitmap\"")
        .set("string", "filename", &path)
        .set("boolean", "raw", "true")
        .set("string", "wrap_mode", "clamp");
    let file = Some(File::new(path, profile(angle, penumbra)));
    Ok(Emitter { file, ..alone(xml.with(texture))? })
}

/// The profile of a cone as a picture in the plane at distance 1, in the Portable FloatMap format.
fn profile(angle: f32, penumbra: f32) -> Vec<u8> {
    /// Pixels across half of the soft edge.
    const FINE: f32 = 64.0;
    let side = (FINE / penumbra).clamp(256.0, 2048.0) as usize;
    let mut bytes = format!("Pf\n{side} {side}\n-1.0\n").into_bytes();
    let edge = angle.to_radians().tan();
    let edges = cone_edges(angle, penumbra);
    let at = |i: usize| ((i as f32 + 0.5) / side as f32 * 2.0 - 1.0) * edge;
    for row in 0..side {
        for column in 0..side {
            let ray = Vec3::new(at(column), at(row), 1.0).normalize();
            bytes.extend(cone(Vec3::Z, ray, edges).to_le_bytes());
        }
    }
    bytes
}
