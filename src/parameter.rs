//! Parameters of models and lights: one declaration drives JSON, checks, panel knobs, the uniform
//! layout and `lcm models`.
//!
//! Parameters are shared **by name** across models, so that swapping the model keeps what the user
//! set. Those that several models use are declared here once.

use std::{borrow::Cow, collections::BTreeMap, fmt};

use glam::Vec3;
use serde::Serialize;

use crate::optics::colour::Encoding;

/// The declaration of one parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// The name in scene files and on the command line.
    pub name: &'static str,
    /// The symbol in the equation, e.g. `k_d` or `α`.
    pub symbol: &'static str,
    /// The word beside the symbol, e.g. "diffuse coefficient".
    pub label: &'static str,
    /// The unit, empty for dimensionless numbers.
    pub unit: &'static str,
    /// What it does, one sentence, for tooltips and manuals.
    pub help: &'static str,
    /// Type, range and default.
    pub kind: ParameterKind,
    /// When it is used; `None` for always. See [`Parameter::used_when`].
    pub used_when: Option<UsedWhen>,
}

/// A condition under which a parameter is used: another one of the model has one of these choices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct UsedWhen {
    /// The name of the other parameter.
    pub parameter: &'static str,
    /// The names of its choices.
    pub choices: &'static [&'static str],
}

/// The smallest legal value of a number that must be greater than zero.
pub const ABOVE_ZERO: f32 = f32::MIN_POSITIVE;

/// Type, range and default of a parameter.
#[derive(Clone, Debug, PartialEq)]
pub enum ParameterKind {
    /// A real number in a closed range.
    Number {
        /// Smallest legal value.
        min: f32,
        /// Largest legal value.
        max: f32,
        /// Value when the scene does not give one.
        default: f32,
    },
    /// A whole number with a lower bound and perhaps an upper one.
    Integer {
        /// Smallest legal value.
        min: i64,
        /// Largest legal value, if there is one.
        max: Option<i64>,
        /// Where a slider ends when there is no largest value.
        slider_max: i64,
        /// Value when the scene does not give one.
        default: i64,
    },
    /// Three sRGB-encoded integers, 0–255.
    Colour {
        /// Value when the scene does not give one.
        default: [u8; 3],
    },
    /// Three real numbers, one for each of red, green and blue, in a closed range. Files may give one
    /// number for all three.
    Triple {
        /// Smallest legal value.
        min: f32,
        /// Largest legal value.
        max: f32,
        /// Value when the scene does not give one.
        default: [f32; 3],
    },
    /// One of several named choices.
    Choice {
        /// The choices: name in files, name for people.
        options: &'static [(&'static str, &'static str)],
        /// Index of the default.
        default: usize,
    },
}

impl Parameter {
    /// The same parameter, used only while another of the model has one of these choices, and that one is
    /// used itself. Otherwise its knob is disabled and says why.
    #[must_use]
    pub const fn used_when(self, parameter: &'static str, choices: &'static [&'static str]) -> Self {
        Self { used_when: Some(UsedWhen { parameter, choices }), ..self }
    }

    /// The value when the scene does not give one.
    #[must_use]
    pub fn default_value(&self) -> Value {
        match self.kind {
            ParameterKind::Number { default, .. } => Value::Number(default),
            ParameterKind::Integer { default, .. } => Value::Integer(default),
            ParameterKind::Colour { default } => Value::Colour(default),
            ParameterKind::Triple { default, .. } => Value::Triple(default),
            ParameterKind::Choice { options, default } => Value::Choice(Cow::Borrowed(options[default].0)),
        }
    }

    /// What is allowed, as the end of a sentence: "a number between 0.5 and 1".
    #[must_use]
    pub fn rule(&self) -> String {
        match &self.kind {
            ParameterKind::Number { min, max, .. } if *min == ABOVE_ZERO => {
                format!("greater than 0 and at most {max}")
            }
            ParameterKind::Number { min, max, .. } => format!("between {min} and {max}"),
            ParameterKind::Integer { min, max: Some(max), .. } => {
                format!("a whole number between {min} and {max}")
            }
            ParameterKind::Integer { min, max: None, .. } => format!("a whole number, {min} or more"),
            ParameterKind::Colour { .. } => {
                "three whole numbers from 0 to 255: [red, green, blue]".to_owned()
            }
            ParameterKind::Triple { min, max, .. } => {
                format!("three numbers between {min} and {max}, [red, green, blue], or one for all")
            }
            ParameterKind::Choice { options, .. } => {
                let names: Vec<_> = options.iter().map(|(id, _)| format!("\"{id}\"")).collect();
                format!("one of {}", names.join(", "))
            }
        }
    }

    /// Whether a value has the right type and lies in the range.
    #[must_use]
    pub fn allows(&self, value: &Value) -> bool {
        match (&self.kind, value) {
            (ParameterKind::Number { min, max, .. }, Value::Number(v)) => {
                v.is_finite() && (min..=max).contains(&v)
            }
            (ParameterKind::Integer { min, max, .. }, Value::Integer(v)) => {
                v >= min && max.is_none_or(|m| *v <= m)
            }
            (ParameterKind::Colour { .. }, Value::Colour(_)) => true,
            (ParameterKind::Triple { min, max, .. }, Value::Triple(v)) => {
                v.iter().all(|c| c.is_finite() && (min..=max).contains(&c))
            }
            (ParameterKind::Choice { options, .. }, Value::Choice(v)) => {
                options.iter().any(|(id, _)| *id == v.as_ref())
            }
            _ => false,
        }
    }

    /// The WGSL type of the field that carries it.
    #[must_use]
    pub fn wgsl_type(&self) -> &'static str {
        match self.kind {
            ParameterKind::Number { .. } | ParameterKind::Integer { .. } => "f32",
            ParameterKind::Colour { .. } | ParameterKind::Triple { .. } => "vec3<f32>",
            ParameterKind::Choice { .. } => "u32",
        }
    }
}

/// The value of a parameter, as a scene file holds it.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Value {
    /// A real number.
    Number(f32),
    /// A whole number.
    Integer(i64),
    /// An sRGB-encoded colour.
    Colour([u8; 3]),
    /// A number for each of red, green and blue.
    Triple([f32; 3]),
    /// The name of a choice.
    Choice(Cow<'static, str>),
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(v) => write!(f, "{v}"),
            Self::Integer(v) => write!(f, "{v}"),
            Self::Colour([r, g, b]) => write!(f, "{r},{g},{b}"),
            Self::Triple([r, g, b]) => write!(f, "{r},{g},{b}"),
            Self::Choice(v) => f.write_str(v),
        }
    }
}

/// The parameters that a scene gives for one object, by name. What is absent has its default; what
/// the current model does not use is kept.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[serde(transparent)]
pub struct Values(pub BTreeMap<Cow<'static, str>, Value>);

impl Values {
    /// The value of a parameter: the scene's, or the declared default when the scene has none of a
    /// legal type and range.
    #[must_use]
    pub fn get(&self, parameter: &Parameter) -> Value {
        match self.0.get(parameter.name) {
            Some(value) if parameter.allows(value) => value.clone(),
            _ => parameter.default_value(),
        }
    }

    /// Sets a parameter.
    pub fn set(&mut self, name: impl Into<Cow<'static, str>>, value: Value) {
        self.0.insert(name.into(), value);
    }

    /// The parameter as a number for calculation; of three the first.
    #[must_use]
    pub fn number(&self, parameter: &Parameter) -> f32 {
        match self.get(parameter) {
            Value::Number(v) => v,
            Value::Integer(v) => v as f32,
            Value::Colour([r, ..]) => f32::from(r),
            Value::Triple([r, ..]) => r,
            Value::Choice(_) => self.choice(parameter) as f32,
        }
    }

    /// The parameter as a linear colour, or as its three numbers, for calculation; zero when it is
    /// neither.
    #[must_use]
    pub fn colour(&self, parameter: &Parameter, encoding: Encoding) -> Vec3 {
        match self.get(parameter) {
            Value::Colour(rgb) => encoding.decode(rgb),
            Value::Triple(v) => v.into(),
            _ => Vec3::ZERO,
        }
    }

    /// The index of the chosen option; 0 when it is not a choice.
    #[must_use]
    pub fn choice(&self, parameter: &Parameter) -> u32 {
        match (&parameter.kind, self.get(parameter)) {
            (ParameterKind::Choice { options, .. }, Value::Choice(v)) => {
                options.iter().position(|(id, _)| *id == v.as_ref()).unwrap_or(0) as u32
            }
            _ => 0,
        }
    }
}

/// The most bytes that the parameters of a model may take.
pub const BLOCK_BYTES: usize = 256;

/// The fields of the WGSL struct `Parameters` of a model: name, type, byte offset, in the order of
/// the declarations. The layout is WGSL's (vec3 aligned to 16), the same for uniform and storage buffers.
#[must_use]
pub fn layout(parameters: &[Parameter]) -> Vec<(&'static str, &'static str, usize)> {
    let mut offset = 0usize;
    let mut fields = Vec::with_capacity(parameters.len());
    for p in parameters {
        let (size, align) = match p.wgsl_type() {
            "vec3<f32>" => (12, 16),
            _ => (4, 4),
        };
        offset = offset.next_multiple_of(align);
        fields.push((p.name, p.wgsl_type(), offset));
        offset += size;
    }
    fields
}

/// Bytes from the parameters of one object to those of the next in the table that the shader reads:
/// the size of the WGSL struct `Parameters`.
#[must_use]
pub fn stride(parameters: &[Parameter]) -> usize {
    let fields = layout(parameters);
    let align = if fields.iter().any(|f| f.1 == "vec3<f32>") { 16 } else { 4 };
    let end = fields.last().map_or(4, |(_, kind, offset)| offset + if *kind == "vec3<f32>" { 12 } else { 4 });
    end.next_multiple_of(align)
}

/// The bytes of the parameters of one object, [`stride`] long.
#[must_use]
pub fn pack(parameters: &[Parameter], values: &Values, encoding: Encoding) -> Vec<u8> {
    let mut block = vec![0u8; stride(parameters)];
    for ((_, kind, offset), parameter) in layout(parameters).into_iter().zip(parameters) {
        let mut put = |at: usize, bytes: [u8; 4]| block[at..at + 4].copy_from_slice(&bytes);
        match kind {
            "vec3<f32>" => {
                for (i, c) in values.colour(parameter, encoding).to_array().into_iter().enumerate() {
                    put(offset + 4 * i, c.to_le_bytes());
                }
            }
            "u32" => put(offset, values.choice(parameter).to_le_bytes()),
            _ => put(offset, values.number(parameter).to_le_bytes()),
        }
    }
    block
}

/// The parameters of one object as words without padding, as a
/// [`Program`](crate::shader::interpret::Program) takes the WGSL struct `Parameters` for an argument.
#[must_use]
pub fn words(parameters: &[Parameter], values: &Values, encoding: Encoding) -> Vec<u32> {
    if parameters.is_empty() {
        // The unused field.
        return vec![0];
    }
    let mut words = Vec::new();
    for p in parameters {
        match p.wgsl_type() {
            "vec3<f32>" => words.extend(values.colour(p, encoding).to_array().map(f32::to_bits)),
            "u32" => words.push(values.choice(p)),
            _ => words.push(values.number(p).to_bits()),
        }
    }
    words
}

/// A type whose fields are declared parameters; written by [`parameters!`](crate::parameters).
pub trait ParameterSet: Sized + Send + Sync + 'static {
    /// The declarations, in the order of the fields.
    const PARAMETERS: &'static [Parameter];

    /// The values for calculation: colours decoded, choices as indices.
    fn from_values(values: &Values, encoding: Encoding) -> Self;
}

/// Declares the struct of a model: its fields are its parameters, each with its declaration. A block
/// `derived { field: Type = function }` after it adds fields that are calculated once from the others.
///
/// ```
/// use lights_camera_models::{parameters, reflection::parameter::{BASE_COLOUR, K_D, ParameterSet}};
/// parameters! {
///     /// A model with two parameters.
///     pub struct Matte {
///         /// What colour it has.
///         base_colour: colour = BASE_COLOUR,
///         /// How much it scatters.
///         k_d: number = K_D,
///     }
/// }
/// assert_eq!(Matte::PARAMETERS[1].name, "k_d");
/// ```
#[macro_export]
macro_rules! parameters {
    (
        $(#[$meta:meta])*
        pub struct $name:ident { $( $(#[$field_meta:meta])* $field:ident : $kind:ident = $declaration:expr ),* $(,)? }
        $( derived {
            $( $(#[$derived_meta:meta])* $derived:ident : $derived_type:ty = $derive:expr ),* $(,)?
        } )?
    ) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct $name {
            $( $(#[$field_meta])* pub $field: $crate::parameters!(@type $kind), )*
            $( $( $(#[$derived_meta])* pub $derived: $derived_type, )* )?
        }

        impl $crate::parameter::ParameterSet for $name {
            const PARAMETERS: &'static [$crate::parameter::Parameter] = &[$($declaration),*];

            #[allow(unused_variables, unused_mut)]
            fn from_values(
                values: &$crate::parameter::Values,
                encoding: $crate::optics::colour::Encoding,
            ) -> Self {
                let mut this = Self {
                    $( $field: $crate::parameters!(@get $kind values encoding $declaration), )*
                    $( $( $derived: <$derived_type>::default(), )* )?
                };
                $( $( this.$derived = ($derive)(&this); )* )?
                this
            }
        }
    };
    (@type colour) => { glam::Vec3 };
    (@type triple) => { glam::Vec3 };
    (@type number) => { f32 };
    (@type choice) => { u32 };
    (@get colour $values:ident $encoding:ident $declaration:expr) => { $values.colour(&$declaration, $encoding) };
    (@get triple $values:ident $encoding:ident $declaration:expr) => { $values.colour(&$declaration, $encoding) };
    (@get number $values:ident $encoding:ident $declaration:expr) => { $values.number(&$declaration) };
    (@get choice $values:ident $encoding:ident $declaration:expr) => { $values.choice(&$declaration) };
}

/// The colour of the body of the material: what a white light makes it look like.
pub const BASE_COLOUR: Parameter = Parameter {
    name: "base_colour",
    symbol: "C_b",
    label: "base colour",
    unit: "sRGB",
    help: "The colour of the material itself: the fraction of red, green and blue light that it scatters.",
    kind: ParameterKind::Colour { default: [255, 255, 255] },
    used_when: None,
};

/// The colour of highlights.
pub const SPECULAR_COLOUR: Parameter = Parameter {
    name: "specular_colour",
    symbol: "C_s",
    label: "specular colour",
    unit: "sRGB",
    help: "The colour of highlights under white light: white for plastics and paints, tinted for metals.",
    kind: ParameterKind::Colour { default: [255, 255, 255] },
    used_when: None,
};

/// Coefficient of ambient reflection, CA table 5.
pub const K_A: Parameter = Parameter {
    name: "k_a",
    symbol: "k_a",
    label: "ambient coefficient",
    unit: "",
    help: "How much of each light's intensity reaches every point regardless of direction; a stand-in for indirect light.",
    kind: ParameterKind::Number { min: 0.0, max: 1.0, default: 0.1 },
    used_when: None,
};

/// Coefficient of diffuse reflection, CA table 5: every object scatters at least half.
pub const K_D: Parameter = Parameter {
    name: "k_d",
    symbol: "k_d",
    label: "diffuse coefficient",
    unit: "",
    help: "How much light is scattered evenly in all directions; in the modified Lambert model, how sharply light turns into shadow.",
    kind: ParameterKind::Number { min: 0.5, max: 1.0, default: 0.8 },
    used_when: None,
};

/// Coefficient of specular reflection, CA table 5.
pub const K_S: Parameter = Parameter {
    name: "k_s",
    symbol: "k_s",
    label: "specular coefficient",
    unit: "",
    help: "How bright the highlight is.",
    kind: ParameterKind::Number { min: 0.0, max: 1.0, default: 0.5 },
    used_when: None,
};

/// Shininess coefficient, CA table 5.
pub const ALPHA: Parameter = Parameter {
    name: "alpha",
    symbol: "α",
    label: "shininess",
    unit: "",
    help: "The exponent of the highlight: the larger, the smaller and sharper it is.",
    kind: ParameterKind::Integer { min: 0, max: None, slider_max: 512, default: 32 },
    used_when: None,
};

/// The refractive index n of the material, for red, green and blue light.
pub const IOR: Parameter = Parameter {
    name: "ior",
    symbol: "n",
    label: "refractive index",
    unit: "",
    help: "How many times slower light is inside than outside, at 630, 532 and 465 nm. Water 1.33, glass 1.5, diamond 2.4; metals also need an extinction coefficient.",
    kind: ParameterKind::Triple { min: 0.01, max: 6.0, default: [1.5; 3] },
    used_when: None,
};

/// The extinction coefficient k: the imaginary part of the refractive index n + ik.
pub const EXTINCTION: Parameter = Parameter {
    name: "extinction",
    symbol: "k",
    label: "extinction coefficient",
    unit: "",
    help: "How fast light dies away inside, at 630, 532 and 465 nm. 0 for glass and water; 2 to 8 for metals, which is why they mirror and hide what is behind them.",
    kind: ParameterKind::Triple { min: 0.0, max: 12.0, default: [0.0; 3] },
    used_when: None,
};

/// Perceptual roughness r (Burley 2012, *Physically-Based Shading at Disney*): `α = r²`.
pub const ROUGHNESS: Parameter = Parameter {
    name: "roughness",
    symbol: "r",
    label: "roughness",
    unit: "",
    help: "From 0, a mirror, to 1, a matt surface, in steps that look even. The width of the slopes of the microfacets is its square, α = r².",
    kind: ParameterKind::Number { min: 0.0, max: 1.0, default: 0.5 },
    used_when: None,
};

/// How much the material is a metal (Burley 2012).
pub const METALLIC: Parameter = Parameter {
    name: "metallic",
    symbol: "m",
    label: "metallic",
    unit: "",
    help: "1 for a metal: nothing is scattered from inside, and the base colour is the colour of the reflection. 0 for everything else. Values between are mixtures, such as dust on metal.",
    kind: ParameterKind::Number { min: 0.0, max: 1.0, default: 0.0 },
    used_when: None,
};

/// Reflectance of what is not metal on a scale that looks even (Lagarde and de Rousiers 2014, *Moving
/// Frostbite to Physically Based Rendering*): `F_0 = 0.16 s²`.
pub const REFLECTANCE: Parameter = Parameter {
    name: "reflectance",
    symbol: "s",
    label: "reflectance",
    unit: "",
    help: "How strongly the surface mirrors when seen straight on, where it is not metal: F_0 = 0.16 s². 0.5 gives 4 %, as of plastic and glass; water 0.36, diamond 1.",
    kind: ParameterKind::Number { min: 0.0, max: 1.0, default: 0.5 },
    used_when: None,
};

/// Roughness along the tangent: root mean square slope, times √2, of the microfacets in that direction.
pub const ALPHA_X: Parameter = Parameter {
    name: "alpha_x",
    symbol: "α_x",
    label: "roughness along the tangent",
    unit: "",
    help: "How steep the microfacets are along the brushing: the smaller, the sharper the reflection in that direction.",
    kind: ParameterKind::Number { min: 0.001, max: 1.0, default: 0.3 },
    used_when: None,
};

/// Roughness across the tangent: as [`ALPHA_X`], along the bitangent.
pub const ALPHA_Y: Parameter = Parameter {
    name: "alpha_y",
    symbol: "α_y",
    label: "roughness across the tangent",
    unit: "",
    help: "How steep the microfacets are across the brushing. Equal to the roughness along it, the surface looks the same from all sides.",
    kind: ParameterKind::Number { min: 0.001, max: 1.0, default: 0.3 },
    used_when: None,
};

/// Standard deviation of the angle of the slopes (Oren, Nayar 1994). Their full equation falls below zero
/// from 36° on, so the range ends at 35°.
pub const SIGMA: Parameter = Parameter {
    name: "sigma",
    symbol: "σ",
    label: "slope deviation",
    unit: "°",
    help: "How far the facets of the surface are tilted, as a standard deviation. 0° is smooth; plaster and sand have about 30°.",
    kind: ParameterKind::Number { min: 0.0, max: 35.0, default: 20.0 },
    used_when: None,
};

/// A value as scene files write it.
#[must_use]
pub fn json(value: &Value) -> serde_json::Value {
    match value {
        Value::Number(v) => crate::text::number(*v),
        Value::Integer(v) => (*v).into(),
        Value::Colour(rgb) => serde_json::json!(rgb),
        Value::Triple(v) => v.iter().map(|c| crate::text::number(*c)).collect(),
        Value::Choice(v) => v.as_ref().into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_layout_follows_the_alignment_rules_of_wgsl() {
        let fields = layout(&[K_A, BASE_COLOUR, K_S, SPECULAR_COLOUR]);
        let offsets: Vec<_> = fields.iter().map(|f| f.2).collect();
        assert_eq!(offsets, [0, 16, 28, 32]);
    }

    #[test]
    fn values_outside_the_range_fall_back_to_the_default() {
        let mut values = Values::default();
        values.set("k_d", Value::Number(0.2));
        assert_eq!(values.get(&K_D), Value::Number(0.8));
        values.set("k_d", Value::Number(0.6));
        assert_eq!(values.get(&K_D), Value::Number(0.6));
        values.set("k_d", Value::Number(f32::NAN));
        assert_eq!(values.get(&K_D), Value::Number(0.8));
    }

    #[test]
    fn packing_decodes_colours_and_lays_out_numbers() {
        let mut values = Values::default();
        values.set("base_colour", Value::Colour([255, 188, 0]));
        let block = pack(&[BASE_COLOUR, K_D], &values, Encoding::Srgb);
        let at = |i: usize| f32::from_le_bytes(block[i..i + 4].try_into().expect("four bytes"));
        assert_eq!(at(0), 1.0);
        assert!((at(4) - 0.502_886).abs() < 1e-5);
        assert_eq!(at(8), 0.0);
        assert_eq!(at(12), 0.8);
    }
}
