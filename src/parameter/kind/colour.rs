//! A colour.

use std::ops::RangeInclusive;

use serde_json::json;

use super::{
    Cursor, Encoding, Header, Json, Kind, Limits, Parameter, ParameterKind, Payload, Place, Reader, Type,
    Value, Vec3, header, joined, text,
};

/// The content of a value: an sRGB-encoded colour.
pub type Given = [u8; 3];
/// The field of a struct of parameters: linear.
pub type Field = Vec3;

/// The components of a linear colour, which may be beyond their range by as much as 8 bits round it away.
const LINEAR: RangeInclusive<f32> = -0.5 / 255.0 / 12.92..=1.0 + 0.5 / 255.0;

/// The unit.
const UNIT: &str = "sRGB";

/// The legal values, as the end of a sentence.
pub const RULE: &str = "three whole numbers from 0 to 255: [red, green, blue]";

/// Three sRGB-encoded integers, 0–255.
#[derive(Clone, Debug, PartialEq)]
pub struct Colour {
    /// The value if the scene gives none.
    pub default: [u8; 3],
}

impl Parameter {
    /// A colour: three sRGB-encoded integers, 0–255.
    #[must_use]
    pub const fn colour(name: &'static str, default: [u8; 3]) -> Self {
        Self::new(name, ParameterKind::Colour(Colour { default })).unit(UNIT)
    }
}

impl Kind for Colour {
    fn name(&self) -> &'static str {
        "colour"
    }

    fn default_value(&self) -> Value {
        Value::Colour(self.default)
    }

    fn rule(&self) -> String {
        RULE.to_owned()
    }

    fn parse(&self, text: &str) -> Option<Value> {
        text::numbers(text)?.try_into().ok().map(Value::Colour)
    }

    fn read(&self, reader: &mut dyn Reader, value: Cursor, rule: &str, _: Place) -> Option<Value> {
        read(reader, value, rule).map(Value::Colour)
    }

    fn schema(&self) -> Json {
        json!({
            "type": "array",
            "items": { "type": "integer", "minimum": 0, "maximum": 255 },
            "minItems": 3,
            "maxItems": 3,
        })
    }

    fn limits(&self) -> Option<Limits> {
        Some(Limits::between(0.0, 255.0).whole())
    }

    fn unit(&self) -> &'static str {
        UNIT
    }

    fn is_measured(&self) -> bool {
        false
    }

    fn of_numbers(&self, numbers: [f64; 3]) -> Value {
        Value::Colour(numbers.map(|v| v as u8))
    }

    /// Numbers that are not a colour become a triple.
    fn of_field(&self, numbers: [f32; 3], encoding: Encoding) -> Value {
        match numbers.iter().all(|v| LINEAR.contains(v)) {
            true => Value::Colour(encoding.encode(numbers.into())),
            false => Value::Triple(numbers),
        }
    }

    fn mended(&self, value: &Value) -> Option<(Value, String)> {
        let Value::Triple([r, g, b]) = *value else { return None };
        let nearest = Value::Colour(Encoding::Srgb.encode(Vec3::new(r, g, b)));
        Some((nearest, format!("({r}, {g}, {b}), but a linear colour has numbers from 0 to 1")))
    }

    fn random(&self, pick: f32, _: f32, more: &mut dyn FnMut() -> f32) -> Value {
        Value::Colour(if pick < 0.3 { [255; 3] } else { [0; 3].map(|_: u8| (more() * 255.99) as u8) })
    }

    fn caption(&self, _: &str, value: &Value) -> Option<String> {
        Some(format!("({})", value.text().replace(',', ", ")))
    }

    fn wgsl(&self) -> &'static str {
        "vec3<f32>"
    }

    fn linear(&self, value: &Value, encoding: Encoding) -> Option<Vec3> {
        let Value::Colour(rgb) = value else { return None };
        Some(encoding.decode(*rgb))
    }
}

/// Three whole numbers from 0 to 255.
pub(crate) fn read(reader: &mut dyn Reader, value: Cursor, rule: &str) -> Option<[u8; 3]> {
    let Some(list) = value.list().filter(|list| list.len() == 3) else {
        let hint = value.text().and_then(hexadecimal);
        let hint = hint.map_or_else(String::new, |[r, g, b]| format!("; write [{r}, {g}, {b}]"));
        reader.wrong(value, &format!("{rule}{hint}"));
        return None;
    };
    let mut colour = [Some(0); 3];
    for (to, element) in colour.iter_mut().zip(list) {
        *to = channel(element);
        if to.is_none() {
            reader.wrong(element, rule);
        }
    }
    let [r, g, b] = colour;
    Some([r?, g?, b?])
}

fn channel(value: Cursor) -> Option<u8> {
    value.integer().and_then(|v| u8::try_from(v).ok())
}

/// `#ff8000` as three numbers.
pub(crate) fn hexadecimal(text: &str) -> Option<[u8; 3]> {
    let is_digits = |d: &&str| d.len() == 6 && d.bytes().all(|b| b.is_ascii_hexdigit());
    let digits = text.strip_prefix('#').filter(is_digits)?;
    let channel = |i: usize| u8::from_str_radix(&digits[i..i + 2], 16).ok();
    Some([channel(0)?, channel(2)?, channel(4)?])
}

/// The type in custom models.
pub(super) const TYPES: &[Type] =
    &[Type { name: "colour", keys: &[], fits: header::has_list, read: declared }];

fn declared(header: &mut Header) -> Option<ParameterKind> {
    let Some(value) = header.fields.get("default") else {
        let known = header.shared.filter(|known| matches!(known, ParameterKind::Colour(_)));
        return Some(known.cloned().unwrap_or(ParameterKind::Colour(Colour { default: [255; 3] })));
    };
    let channels = value.list().and_then(|list| list.map(channel).collect::<Option<Vec<_>>>());
    let Some(default) = channels.and_then(|c| c.try_into().ok()) else {
        header.reader.wrong(value, &format!("a colour must be {RULE}"));
        return None;
    };
    Some(ParameterKind::Colour(Colour { default }))
}

impl Payload for [u8; 3] {
    fn text(&self) -> String {
        joined(self)
    }

    fn json(&self) -> Json {
        json!(self)
    }

    fn numbers(&self) -> [f64; 3] {
        self.map(f64::from)
    }
}
