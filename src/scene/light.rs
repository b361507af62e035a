//! The lights of a scene.

use glam::Vec3;

use super::{
    Field, SceneSize,
    field::{Ids, Kind},
    part::{Fields as _, Key, part},
    range::significant,
};
use crate::{
    light::{self, Emitter, Incident, LightEntry, LightRecord},
    optics::{
        colour::{Encoding, srgb_encode},
        temperature::{self, MAX_TEMPERATURE, MIN_TEMPERATURE},
    },
    parameter::{Parameter, Value, Values},
    registry::Registry,
};

light::fields!(part);

impl Light {
    /// The intensity in the unit of the light's type, whether given as intensity or as flux.
    #[must_use]
    pub fn intensity_as(&self, entry: &LightEntry) -> f32 {
        match self.luminous_flux.zip(entry.solid_angle(&self.parameters)) {
            // A cone may be so narrow that the quotient is not finite in 32 bits.
            Some((flux, solid_angle)) => ((f64::from(flux) / solid_angle) as f32).min(f32::MAX),
            None => self.intensity,
        }
    }

    /// The values that set a parameter of the light's type. Where the parameter says what shines all around, as the source of
    /// an environment and the picture in its file do, the intensity follows, so that the mean luminance stays: a sky, a studio
    /// and pictures are of very different luminance.
    #[must_use]
    pub fn setting(&self, entry: &LightEntry, p: &Parameter, value: Value) -> Vec<(Key, Option<Value>)> {
        let rules =
            |other: &Parameter| other.used_when.is_some_and(|condition| condition.parameter == p.name);
        let is_source = entry.parameters.iter().any(rules) && !p.kind.is_flag() && p.used_when.is_none()
            || p.kind.format().is_some();
        let mut after = self.parameters.clone();
        after.set(p.name, value.clone());
        let mean = |values: &Values| entry.mean_luminance(values).filter(|_| is_source);
        let mut values = vec![(Key::Own(p.name), Some(value))];
        if let Some((before, after)) = mean(&self.parameters).zip(mean(&after))
            && before != after
        {
            let intensity = significant(f64::from(self.intensity) * before / after, 3) as f32;
            if before > 0.0 && after > 0.0 && intensity.is_finite() {
                values.push((Self::intensity.into(), Some(Value::Number(intensity))));
            }
        }
        values
    }

    /// The colour for calculation, whether given as a colour or as a temperature.
    ///
    /// A colour takes away from white light, as a filter does. A temperature keeps the luminance of white.
    #[must_use]
    pub fn colour_under(&self, encoding: Encoding) -> Vec3 {
        let Some(kelvin) = self.colour_temperature else { return encoding.decode(self.colour) };
        let colour = temperature::black_body(kelvin);
        temperature::light_of(match encoding {
            Encoding::Srgb => colour,
            // Gamma-naive: the numbers of a colour picker are used unchanged.
            Encoding::Off => colour.map(srgb_encode),
        })
    }

    /// The colour in sRGB, whether given as a colour or as a temperature.
    #[must_use]
    pub fn rgb8(&self) -> [u8; 3] {
        self.colour_temperature.map_or(self.colour, temperature::black_body_rgb8)
    }

    /// Sets a value within the light, as `put` does, in a room of this size. A new type brings what it
    /// requires; of two fields of which one is given, the other gets the value that it has when the file is reloaded.
    pub(crate) fn set(
        &mut self,
        key: Key,
        value: Option<Value>,
        registry: &Registry,
        room: SceneSize,
    ) -> bool {
        let id = match &value {
            Some(Value::Choice(id)) if key == Self::light_type.into() => Some(id),
            _ => None,
        };
        if let Some(entry) = id.and_then(|id| registry.light(id)) {
            self.set_type(entry, registry, room);
            return true;
        }
        let good = self.put(key, value);
        if key == Self::intensity.into() {
            self.luminous_flux = None;
        } else if key == Self::luminous_flux.into() {
            let entry = registry.light(&self.light_type);
            self.intensity = entry.map_or(self.intensity, |e| e.declaration.default_intensity);
        } else if key == Self::colour.into() {
            self.colour_temperature = None;
        } else if key == Self::colour_temperature.into() {
            self.colour = Self::default().colour;
        }
        good
    }

    /// Changes the type: position, direction and parameters are added or removed as the new type requires.
    /// Intensity or luminous flux is kept, unless the new type has another unit.
    pub fn set_type(&mut self, to: &LightEntry, registry: &Registry, room: SceneSize) {
        let new = to.declaration;
        let flux = self.luminous_flux.filter(|_| to.has_flux());
        self.intensity = match registry.light(&self.light_type) {
            Some(old) if flux.is_none() && old.declaration.unit == new.unit => self.intensity_as(old),
            // 20 cd and 20 lx are very different: a new unit starts from its default.
            _ => new.default_intensity,
        };
        self.luminous_flux = flux;
        let centre = Vec3::new(room.width / 2.0, room.height * 0.8, room.depth / 2.0);
        self.position = new.has_position.then(|| self.position.unwrap_or(centre));
        self.direction = new.has_direction.then(|| self.direction.unwrap_or(Vec3::NEG_Y));
        self.parameters = self.parameters.legal(to.parameters);
        new.id.clone_into(&mut self.light_type);
    }
}

/// A light of the scene for calculation, without its type's parameters. A light of an unknown type is dark.
#[must_use]
pub fn record(light: &Light, registry: &Registry, encoding: Encoding) -> LightRecord {
    let Some(entry) = registry.light(&light.light_type) else {
        return LightRecord { light_type: u32::MAX, ..LightRecord::default() };
    };
    LightRecord {
        light_type: entry.index,
        position: light.position.unwrap_or(Vec3::ZERO),
        direction: light.direction.unwrap_or(Vec3::ZERO).normalize_or_zero(),
        colour: light.colour_under(encoding),
        intensity: light.intensity_as(entry),
    }
}

/// A light of the scene for calculation: its type, the type with its parameters, and the rest. `None` if its
/// type is unknown.
#[must_use]
pub fn emitter<'a>(
    light: &Light,
    registry: &'a Registry,
    encoding: Encoding,
) -> Option<(&'a LightEntry, Box<dyn Emitter>, LightRecord)> {
    let entry = registry.light(&light.light_type)?;
    Some((entry, (entry.instantiate)(&light.parameters, encoding), record(light, registry, encoding)))
}

/// True if any active light has extent, so that lights are sampled.
#[must_use]
pub fn has_extent<'a>(shining: impl IntoIterator<Item = &'a Light>, registry: &Registry) -> bool {
    shining
        .into_iter()
        .any(|light| registry.light(&light.light_type).is_some_and(|entry| entry.declaration.extent))
}

/// True if any active light is uniform, so that albedos are needed.
#[must_use]
pub fn shines_from_everywhere<'a>(
    shining: impl IntoIterator<Item = &'a Light>,
    encoding: Encoding,
    registry: &Registry,
) -> bool {
    shining
        .into_iter()
        .filter_map(|light| emitter(light, registry, encoding))
        .any(|(_, emitter, record)| matches!(emitter.incident(&record, Vec3::ZERO), Incident::Uniform { .. }))
}
