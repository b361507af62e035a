//! The parameters that several models use.

use super::{Parameter, meaning};

/// The colour of the material under white light.
pub const BASE_COLOUR: Parameter = Parameter::colour("base_colour", [255, 255, 255])
    .symbol("C_b")
    .label("base colour")
    .help("The colour of the material itself: the fraction of red, green and blue light that it scatters.")
    .stands_for(&meaning::COLOUR_OF_BASE);

/// The colour of highlights.
pub const SPECULAR_COLOUR: Parameter = Parameter::colour("specular_colour", [255, 255, 255])
    .symbol("C_s")
    .label("specular colour")
    .help("The colour of highlights under white light: white for plastics and paints, tinted for metals.")
    .stands_for(&meaning::COLOUR_OF_HIGHLIGHT);

/// Coefficient of ambient reflection, CA table 5.
pub const K_A: Parameter = Parameter::number("k_a", 0.0..=1.0, 0.1)
        .label("ambient coefficient")
        .help("The part of each light's intensity that reaches every point regardless of direction; a stand-in for indirect light.");

/// Coefficient of diffuse reflection, CA table 5: every object scatters at least half.
pub const K_D: Parameter = Parameter::number("k_d", 0.5..=1.0, 0.8)
        .label("diffuse coefficient")
        .help("The amount of light scattered evenly in all directions; in the modified Lambert model, the sharpness of the edge between light and shadow.");

/// Coefficient of specular reflection, CA table 5.
pub const K_S: Parameter = Parameter::number("k_s", 0.0..=1.0, 0.5)
    .label("specular coefficient")
    .help("The brightness of the highlight.");

/// Shininess coefficient, CA table 5.
pub const ALPHA: Parameter = Parameter::integer_from("alpha", 0, 512, 32)
    .symbol("α")
    .label("shininess")
    .help("The exponent of the highlight: larger values make it smaller and sharper.");

/// The refractive index n of the material, for red, green and blue light.
pub const IOR: Parameter = Parameter::triple("ior", 0.01..=6.0, [1.5; 3])
        .symbol("n")
        .label("refractive index")
        .help("The factor by which light is slower inside than outside, at 630, 532 and 465 nm: water 1.33, glass 1.5, diamond 2.4. Metals also need an extinction coefficient.")
    .stands_for(&meaning::INDEX);

/// The refractive index of a transparent body, the same for all colours.
pub const REFRACTIVE_INDEX: Parameter = Parameter::number("refractive_index", 1.0..=3.0, 1.5)
        .symbol("n")
        .label("refractive index")
        .help("The factor by which light is slower inside than outside: ice 1.31, water 1.33, window glass 1.52, sapphire 1.77, diamond 2.42. The larger it is, the more light is bent and reflected; at 1 the boundary is invisible.")
    .stands_for(&meaning::INDEX);

/// The colour that light has after passing through.
pub const TRANSMITTANCE_COLOUR: Parameter = Parameter::colour("transmittance_colour", [255, 255, 255])
    .symbol("C_t")
    .label("transmittance colour")
    .help("The colour of white light after it has passed through the material once: white takes nothing away, black lets nothing through.")
    .stands_for(&meaning::COLOUR_OF_TRANSMISSION);

/// The extinction coefficient k: the imaginary part of the refractive index n + ik.
pub const EXTINCTION: Parameter = Parameter::triple("extinction", 0.0..=12.0, [0.0; 3])
        .symbol("k")
        .label("extinction coefficient")
        .help("The rate at which the material absorbs light, at 630, 532 and 465 nm. 0 for glass and water; 2 to 8 for metals, which makes them opaque and shiny.");

/// Perceptual roughness r (Burley 2012, *Physically-Based Shading at Disney*): `α = r²`.
pub const ROUGHNESS: Parameter = Parameter::number("roughness", 0.0..=1.0, 0.5)
        .symbol("r")
        .help("From 0, a mirror, to 1, a matte surface, in perceptually even steps. The width of the distribution of microfacet slopes is its square, α = r².")
    .stands_for(&meaning::PERCEPTUAL_ROUGHNESS);

/// The fraction of metal in the material (Burley 2012).
pub const METALLIC: Parameter = Parameter::number("metallic", 0.0..=1.0, 0.0)
        .symbol("m")
        .help("1 for metals: no diffuse reflection, and the base colour is the colour of the reflection. 0 for everything else. Values in between are mixtures, such as dust on metal.")
    .stands_for(&meaning::METAL);

/// Reflectance of dielectrics on a perceptually even scale (Lagarde and de Rousiers 2014, *Moving Frostbite to
/// Physically Based Rendering*): `F_0 = 0.16 s²`.
pub const REFLECTANCE: Parameter = Parameter::number("reflectance", 0.0..=1.0, 0.5)
        .symbol("s")
        .help("The reflectance of the non-metallic part at normal incidence: 0.16 s². 0.5 gives 4 %, typical of plastic and glass; water 0.36, diamond 1.")
    .stands_for(&meaning::SQUARED_REFLECTANCE);

/// Roughness along the tangent: √2 times the root mean square slope of the microfacets in that direction.
pub const ALPHA_X: Parameter = Parameter::number("alpha_x", 0.001..=1.0, 0.3)
        .symbol("α_x")
        .label("roughness along the tangent")
        .help("The steepness of the microfacets along the tangent: smaller values make the reflection sharper in that direction. It is small where scratches run along the tangent.")
    .stands_for(&meaning::ALPHA_ALONG);

/// Roughness across the tangent: as [`ALPHA_X`], along the bitangent.
pub const ALPHA_Y: Parameter = Parameter::number("alpha_y", 0.001..=1.0, 0.3)
        .symbol("α_y")
        .label("roughness across the tangent")
        .help("The steepness of the microfacets across the tangent. If it equals the roughness along the tangent, the surface is isotropic.")
    .stands_for(&meaning::ALPHA_ACROSS);

/// Standard deviation of the slope angles (Oren, Nayar 1994). The full equation falls below zero from 36° on, so the
/// range ends at 35°.
pub const SIGMA: Parameter = Parameter::number("sigma", 0.0..=35.0, 20.0)
        .symbol("σ")
        .label("slope deviation")
        .unit("°")
        .help("The tilt of the surface's facets, as a standard deviation. 0° is smooth; plaster and sand have about 30°.");
