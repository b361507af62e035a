//! The parameters that several models use.

use super::declaration::{Parameter, ParameterKind};

/// The colour of the body of the material, under white light.
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

/// The share of metal in the material (Burley 2012).
pub const METALLIC: Parameter = Parameter {
    name: "metallic",
    symbol: "m",
    label: "metallic",
    unit: "",
    help: "1 for a metal: nothing is scattered from inside, and the base colour is the colour of the reflection. 0 for everything else. Values between are mixtures, such as dust on metal.",
    kind: ParameterKind::Number { min: 0.0, max: 1.0, default: 0.0 },
    used_when: None,
};

/// Reflectance of dielectrics on a scale that looks even (Lagarde and de Rousiers 2014, *Moving
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
