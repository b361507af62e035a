//! Light types with a counterpart in Mitsuba.

use std::f32::consts::PI;

use glam::Vec3;

use super::xml::{Xml, number, triple};
use crate::{
    export::File,
    light::{LightEntry, LightRecord},
    optics::radiometry::cone,
    parameter::Values,
    scene::observer::orientation,
};

/// A light that shines.
pub(super) struct Lamp<'a> {
    pub(super) entry: &'a LightEntry,
    pub(super) record: LightRecord,
    pub(super) values: &'a Values,
    /// Its number, for names of files.
    pub(super) number: usize,
}

/// The counterpart of a light: an element, and a file that it names.
pub(super) struct Emitter {
    pub(super) xml: Xml,
    pub(super) file: Option<File>,
}

/// A counterpart, or the reason why there is none.
type Counterpart = fn(&Lamp) -> Result<Emitter, String>;

const COUNTERPARTS: &[(&str, Counterpart)] =
    &[("point", point), ("spot", spot), ("directional", directional), ("ambient", ambient)];

/// The widest cone, degrees: the picture in which Mitsuba looks up the light of a cone has no end at 90°.
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
}

fn alone(xml: Xml) -> Result<Emitter, String> {
    Ok(Emitter { xml, file: None })
}

fn point(lamp: &Lamp) -> Result<Emitter, String> {
    let Vec3 { x, y, z } = lamp.record.position;
    let position = format!("point name=\"position\" x=\"{x}\" y=\"{y}\" z=\"{z}\"");
    let xml = Xml::plugin("emitter", "point").with(Xml::element(position));
    alone(xml.rgb("intensity", PI * lamp.power()))
}

fn directional(lamp: &Lamp) -> Result<Emitter, String> {
    let Vec3 { x, y, z } = lamp.record.direction;
    let direction = format!("vector name=\"direction\" x=\"{x}\" y=\"{y}\" z=\"{z}\"");
    let xml = Xml::plugin("emitter", "directional").with(Xml::element(direction));
    alone(xml.rgb("irradiance", PI * lamp.power()))
}

/// A surface with the albedo E answers to the radiance L from everywhere with E L, and to our ambient light I with E I.
fn ambient(lamp: &Lamp) -> Result<Emitter, String> {
    alone(Xml::plugin("emitter", "constant").rgb("radiance", lamp.power()))
}

/// Mitsuba's cone fades linearly with the angle, ours by a cubic of its cosine. So that one has no soft edge, and our
/// profile is a picture that it projects.
fn spot(lamp: &Lamp) -> Result<Emitter, String> {
    let [angle, penumbra] = ["cone_angle", "penumbra"].map(|name| lamp.parameter(name));
    if angle > WIDEST {
        return Err(format!("Mitsuba has a counterpart of cones up to {WIDEST}°, and this one has {angle}°"));
    }
    let LightRecord { position, direction, .. } = lamp.record;
    let look = format!(
        "lookat origin=\"{}\" target=\"{}\" up=\"{}\"",
        triple(position),
        triple(position + direction),
        triple(orientation(direction).y_axis)
    );
    let xml = Xml::plugin("emitter", "spot")
        .with(Xml::element("transform name=\"to_world\"").with(Xml::element(look)))
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
    Ok(Emitter { xml: xml.with(texture), file: Some(File::new(path, profile(angle, penumbra))) })
}

/// The profile of a cone as a picture in the plane at distance 1, in the Portable FloatMap format.
fn profile(angle: f32, penumbra: f32) -> Vec<u8> {
    /// Pixels across half the picture's soft edge.
    const FINE: f32 = 64.0;
    let side = (FINE / penumbra).clamp(256.0, 2048.0) as usize;
    let mut bytes = format!("Pf\n{side} {side}\n-1.0\n").into_bytes();
    let edge = angle.to_radians().tan();
    let at = |i: usize| ((i as f32 + 0.5) / side as f32 * 2.0 - 1.0) * edge;
    for row in 0..side {
        for column in 0..side {
            let cosine = 1.0 / (1.0 + at(row).powi(2) + at(column).powi(2)).sqrt();
            bytes.extend(cone(cosine, angle, penumbra).to_le_bytes());
        }
    }
    bytes
}
