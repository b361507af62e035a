//! The WGSL functions of light types, and their arguments for the interpreter.

use glam::Vec3;

use super::{LightEntry, LightRecord};
use crate::{optics::colour::Encoding, parameter::Values};

/// A function of a light type's twin in WGSL: `incident_spot` for `incident` and the id `spot`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Twin {
    /// Name without the id.
    pub name: &'static str,
    /// The parameters after the light, the light's own parameters and the point `p`: names with types, and
    /// names alone.
    pub more: [&'static str; 2],
    /// Type of the result.
    pub result: &'static str,
    /// The result for a light that does not shine.
    pub dark: &'static str,
}

const POINT_LIKE: [Twin; 1] = [Twin {
    name: "incident",
    more: ["", ""],
    result: "Incident",
    dark: "Incident(vec3(0.0), vec3(0.0), 0u)",
}];

const EXTENDED: [Twin; 2] = [
    Twin {
        name: "sample",
        more: [", u: vec2<f32>", ", u"],
        result: "LightSample",
        dark: "LightSample(vec3(0.0, 1.0, 0.0), vec3(0.0), 0.0)",
    },
    Twin { name: "seen", more: [", l: vec3<f32>", ", l"], result: "LightSeen", dark: "NOTHING_SEEN" },
];

impl Twin {
    /// The functions of light types with extent, or without.
    #[must_use]
    pub fn all(extent: bool) -> &'static [Self] {
        if extent { &EXTENDED } else { &POINT_LIKE }
    }

    /// The function name for a light type.
    #[must_use]
    pub fn of(&self, light: &LightEntry) -> String {
        format!("{}_{}", self.name, light.declaration.id)
    }

    /// The parameters and the result for a light type.
    #[must_use]
    pub fn signature(&self, light: &LightEntry) -> String {
        let own = match light.fields().as_slice() {
            [] => String::new(),
            _ => format!("m: {}, ", light.parameter_struct()),
        };
        format!("(light: Light, {own}p: vec3<f32>{}) -> {}", self.more[0], self.result)
    }
}

impl LightEntry {
    /// The parameters of a light as its functions in WGSL take them, and the numbers of its files.
    pub(crate) fn arguments(&self, values: &Values, encoding: Encoding) -> (Vec<u32>, Vec<u32>) {
        let mut words = self.words(values, encoding);
        let mut files = Vec::new();
        for (at, table) in self.tables(values) {
            words[at] = files.len() as u32;
            files.extend(table.numbers.iter().map(|n| n.to_bits()));
        }
        (words, files)
    }
}

impl LightRecord {
    /// The arguments of a function of a light type in WGSL: the light, its own parameters, the point.
    pub(crate) fn arguments(&self, own: &[u32], p: Vec3) -> Vec<u32> {
        let Self { light_type, position, direction, colour, intensity } = *self;
        let mut arguments = Vec::new();
        let mut put = |numbers: &[f32]| arguments.extend(numbers.iter().map(|n| n.to_bits()));
        put(&position.to_array());
        put(&[f32::from_bits(light_type)]);
        put(&direction.to_array());
        put(&[intensity]);
        put(&colour.to_array());
        // Where its parameters begin: they are given to it here.
        put(&[0.0]);
        arguments.extend(own);
        arguments.extend(p.to_array().map(f32::to_bits));
        arguments
    }
}
