//! The functions of a light type in WGSL.

use super::LightEntry;

/// A function that the twin of a light type has in WGSL: `incident_spot` for `incident` and the id `spot`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Twin {
    /// Its name without the id.
    pub name: &'static str,
    /// The parameters after the light, its own parameters and the point `p`: names with types, and names alone.
    pub more: [&'static str; 2],
    /// The type of its result.
    pub result: &'static str,
    /// The result of a light that does not shine.
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
    /// Those of light types with extent, or of others.
    #[must_use]
    pub fn all(extent: bool) -> &'static [Self] {
        if extent { &EXTENDED } else { &POINT_LIKE }
    }

    /// Its name for a light type.
    #[must_use]
    pub fn of(&self, light: &LightEntry) -> String {
        format!("{}_{}", self.name, light.declaration.id)
    }

    /// Its parameters and its result for a light type.
    #[must_use]
    pub fn signature(&self, light: &LightEntry) -> String {
        let own = match light.fields().as_slice() {
            [] => String::new(),
            _ => format!("m: {}, ", light.parameter_struct()),
        };
        format!("(light: Light, {own}p: vec3<f32>{}) -> {}", self.more[0], self.result)
    }
}
