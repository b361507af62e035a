//! The WGSL functions of light types.

use super::LightEntry;

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
