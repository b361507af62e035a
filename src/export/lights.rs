//! The active lights of a scene, with one record type that contains the fields needed by their types.

use glam::Vec3;

use super::lamp_files::{Fitted, LampFiles};
use crate::{
    light::{LightEntry, LightRecord, Twin},
    parameter::{Parameter, lanes},
    registry::Registry,
    scene::{Scene, record, shines_from_everywhere},
};

/// The active lights of a scene.
#[derive(Debug)]
pub struct Lights<'a> {
    /// The types in use, in the order of the registry.
    pub types: Vec<&'a LightEntry>,
    /// The lights.
    pub rows: Vec<LightRow>,
    /// The numbers of the files that they use, one file after the other; pictures of environments are reduced to fit
    /// into a uniform.
    pub numbers: Vec<f32>,
    /// How many of the numbers are those of pictures of environments.
    pub pictures: usize,
    /// A sentence for each picture that was reduced.
    pub notes: Vec<String>,
    /// True if some light is uniform ambient light.
    pub uniform: bool,
}

/// A light.
#[derive(Clone, Debug)]
pub struct LightRow {
    /// Index in the scene.
    pub index: usize,
    /// Index of the light's type in [`Lights::types`].
    pub light_type: usize,
    /// The fields shared by all types.
    pub record: LightRecord,
    /// The parameters of the light, without padding; for a file, the index of its first number.
    words: Vec<u32>,
}

/// A field of the record of a light.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LightField {
    /// Name of the field.
    pub name: String,
    /// Type in WGSL.
    pub kind: &'static str,
    source: FieldSource,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum FieldSource {
    Position,
    Type,
    Direction,
    Intensity,
    Colour,
    /// The words of a type's parameter: the index of the type, the first word.
    Parameter(usize, usize),
}

impl<'a> Lights<'a> {
    /// The lights of a valid scene.
    #[must_use]
    pub fn of(scene: &Scene, registry: &'a Registry) -> Self {
        let encoding = scene.display.encoding;
        let used = |entry: &&LightEntry| scene.shining().any(|l| l.light_type == entry.declaration.id);
        let types: Vec<_> = registry.lights().iter().filter(used).collect();
        let mut files = LampFiles::default();
        let mut uses = Vec::new();
        let mut rows: Vec<LightRow> = Vec::new();
        for (index, light) in scene.lights.iter().enumerate().filter(|(_, light)| light.enabled) {
            let Some(light_type) = types.iter().position(|t| t.declaration.id == light.light_type) else {
                continue;
            };
            let entry = types[light_type];
            let words = entry.words(&light.parameters, encoding);
            for (place, table) in entry.tables(&light.parameters) {
                uses.push((rows.len(), place, files.index(table)));
            }
            rows.push(LightRow { index, light_type, record: record(light, registry, encoding), words });
        }
        let Fitted { numbers, begins, pictures, notes } = files.fitted();
        for (row, place, file) in uses {
            rows[row].words[place] = begins[file];
        }
        let uniform = shines_from_everywhere(scene.shining(), encoding, registry);
        Self { types, rows, numbers, pictures, notes, uniform }
    }

    /// True if some light has extent.
    #[must_use]
    pub fn has_extent(&self) -> bool {
        self.types.iter().any(|entry| entry.declaration.extent)
    }

    /// The fields needed by lights of these types, ordered to leave few gaps.
    #[must_use]
    pub fn fields(&self) -> Vec<LightField> {
        use FieldSource::{Colour, Direction, Intensity, Position, Type};
        let field = |name: &str, kind, source| LightField { name: name.to_owned(), kind, source };
        let mut fields = vec![
            field("position", "vec3<f32>", Position),
            field("light_type", "u32", Type),
            field("direction", "vec3<f32>", Direction),
            field("intensity", "f32", Intensity),
            field("colour", "vec3<f32>", Colour),
        ];
        for (t, entry) in self.types.iter().enumerate() {
            let mut at = 0;
            for p in &entry.fields() {
                let source = FieldSource::Parameter(t, at);
                fields.push(field(&self.parameter_field(t, p.name), p.kind.wgsl(), source));
                at += lanes(p.kind.wgsl());
            }
        }
        fields
    }

    /// The name of the field for a parameter of a type: the parameter's own, unless another field has it.
    #[must_use]
    pub fn parameter_field(&self, light_type: usize, name: &str) -> String {
        let taken = ["position", "light_type", "direction", "intensity", "colour"].contains(&name);
        let holders = self.types.iter().filter(|t| t.fields().iter().any(|p| p.name == name)).count();
        match taken || holders > 1 {
            true => format!("{}_{name}", self.types[light_type].declaration.id),
            false => name.to_owned(),
        }
    }
}

/// The size of a WGSL record with these fields, in bytes.
#[must_use]
pub fn stride(fields: &[LightField]) -> usize {
    let end = fields.iter().fold(0usize, |end, field| {
        let words = lanes(field.kind);
        end.next_multiple_of(4 * words.next_power_of_two()) + 4 * words
    });
    end.next_multiple_of(16)
}

impl LightRow {
    /// The words of a field: zero if the light's type lacks this parameter.
    #[must_use]
    pub fn words(&self, field: &LightField) -> Vec<u32> {
        let vector = |v: Vec3| v.to_array().map(f32::to_bits).to_vec();
        match field.source {
            FieldSource::Position => vector(self.record.position),
            FieldSource::Direction => vector(self.record.direction),
            FieldSource::Colour => vector(self.record.colour),
            FieldSource::Intensity => vec![self.record.intensity.to_bits()],
            FieldSource::Type => vec![self.light_type as u32],
            FieldSource::Parameter(t, at) if t == self.light_type => {
                self.words[at..at + lanes(field.kind)].to_vec()
            }
            FieldSource::Parameter(..) => vec![0; lanes(field.kind)],
        }
    }
}

/// The call of a function of a light type in WGSL; `light` and the other parameters are in scope.
#[must_use]
pub fn call(lights: &Lights, light_type: usize, twin: &Twin) -> String {
    let entry = lights.types[light_type];
    let field = |p: &Parameter| format!("light.{}", lights.parameter_field(light_type, p.name));
    let values: Vec<_> = entry.fields().iter().map(field).collect();
    let own = match values.as_slice() {
        [] => String::new(),
        all => format!("{}({}), ", entry.parameter_struct(), all.join(", ")),
    };
    format!("{}(light, {own}p{})", twin.of(entry), twin.more[1])
}
