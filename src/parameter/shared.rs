//! The parameters that several models use.

use super::declaration::{Parameter, ParameterKind};

/// The colour of the material under white light.
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
    help: "The part of each light's intensity that reaches every point regardless of direction; a stand-in for indirect light.",
    kind: ParameterKind::Number { min: 0.0, max: 1.0, default: 0.1 },
    used_when: None,
};

/// Coefficient of diffuse reflection, CA table 5: every object scatters at least half.
pub const K_D: Parameter = Parameter {
    name: "k_d",
    symbol: "k_d",
    label: "diffuse coefficient",
    unit: "",
    help: "The amount of light scattered evenly in all directions; in the modified Lambert model, the sharpness of the edge between light and shadow.",
    kind: ParameterKind::Number { min: 0.5, max: 1.0, default: 0.8 },
    used_when: None,
};

/// Coefficient of specular reflection, CA table 5.
pub const K_S: Parameter = Parameter {
    name: "k_s",
    symbol: "k_s",
    label: "specular coefficient",
    unit: "",
    help: "The brightness of the highlight.",
    kind: ParameterKind::Number { min: 0.0, max: 1.0, default: 0.5 },
    used_when: None,
};

/// Shininess coefficient, CA table 5.
pub const ALPHA: Parameter = Parameter {
    name: "alpha",
    symbol: "α",
    label: "shininess",
    unit: "",
    help: "The exponent of the highlight: larger values make it smaller and sharper.",
    kind: ParameterKind::Integer { min: 0, max: None, slider_max: 512, default: 32 },
    used_when: None,
};

/// The refractive index n of the material, for red, green and blue light.
pub const IOR: Parameter = Parameter {
    name: "ior",
    symbol: "n",
    label: "refractive index",
    unit: "",
    help: "The factor by which light is slower inside than outside, at 630, 532 and 465 nm: water 1.33, glass 1.5, diamond 2.4. Metals also need an extinction coefficient.",
    kind: ParameterKind::Triple { min: 0.01, max: 6.0, default: [1.5; 3] },
    used_when: None,
};

/// The extinction coefficient k: the imaginary part of the refractive index n + ik.
pub const EXTINCTION: Parameter = Parameter {
    name: "extinction",
    symbol: "k",
    label: "extinction coefficient",
    unit: "",
    help: "The rate at which the material absorbs light, at 630, 532 and 465 nm. 0 for glass and water; 2 to 8 for metals, which makes them opaque and shiny.",
    kind: ParameterKind::Triple { min: 0.0, max: 12.0, default: [0.0; 3] },
    used_when: None,
};

/// Perceptual roughness r (Burley 2012, *Physically-Based Shading at Disney*): `α = r²`.
pub const ROUGHNESS: Parameter = Parameter {
    name: "roughness",
    symbol: "r",
    label: "roughness",
    unit: "",
    help: "From 0, a mirror, to 1, a matte surface, in perceptually even steps. The width of the distribution of microfacet slopes is its square, α = r².",
    kind: ParameterKind::Number { min: 0.0, max: 1.0, default: 0.5 },
    used_when: None,
};

/// The fraction of metal in the material (Burley 2012).
pub const METALLIC: Parameter = Parameter {
    name: "metallic",
    symbol: "m",
    label: "metallic",
    unit: "",
    help: "1 for metals: no diffuse reflection, and the base colour is the colour of the reflection. 0 for everything else. Values in between are mixtures, such as dust on metal.",
    kind: ParameterKind::Number { min: 0.0, max: 1.0, default: 0.0 },
    used_when: None,
};

/// Reflectance of dielectrics on a perceptually even scale (Lagarde and de Rousiers 2014, *Moving Frostbite to
/// Physically Based Rendering*): `F_0 = 0.16 s²`.
pub const REFLECTANCE: Parameter = Parameter {
    name: "reflectance",
    symbol: "s",
    label: "reflectance",
    unit: "",
    help: "The reflectance of the non-metallic part at normal incidence: 0.16 s². 0.5 gives 4 %, typical of plastic and glass; water 0.36, diamond 1.",
    kind: ParameterKind::Number { min: 0.0, max: 1.0, default: 0.5 },
    used_when: None,
};

/// Roughness along the tangent: √2 times the root mean square slope of the microfacets in that direction.
pub const ALPHA_X: Parameter = Parameter {
    name: "alpha_x",
    symbol: "α_x",
    label: "roughness along the tangent",
    unit: "",
    help: "The steepness of the microfacets along the brushing: smaller values make the reflection sharper in that direction.",
    kind: ParameterKind::Number { min: 0.001, max: 1.0, default: 0.3 },
    used_when: None,
};

/// Roughness across the tangent: as [`ALPHA_X`], along the bitangent.
pub const ALPHA_Y: Parameter = Parameter {
    name: "alpha_y",
    symbol: "α_y",
    label: "roughness across the tangent",
    unit: "",
    help: "The steepness of the microfacets across the brushing. If it equals the roughness along the brushing, the surface is isotropic.",
    kind: ParameterKind::Number { min: 0.001, max: 1.0, default: 0.3 },
    used_when: None,
};

/// Standard deviation of the slope angles (Oren, Nayar 1994). Their full equation falls below zero from 36° on, so the
/// range ends at 35°.
pub const SIGMA: Parameter = Parameter {
    name: "sigma",
    symbol: "σ",
    label: "slope deviation",
    unit: "°",
    help: "The tilt of the surface's facets, as a standard deviation. 0° is smooth; plaster and sand have about 30°.",
    kind: ParameterKind::Number { min: 0.0, max: 35.0, default: 20.0 },
    used_when: None,
};
