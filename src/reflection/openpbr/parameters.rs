//! The parameters of OpenPBR.

use crate::parameter::{BASE_COLOUR, Parameter, ROUGHNESS, meaning};

const fn fraction(name: &'static str, default: f32) -> Parameter {
    Parameter::number(name, 0.0..=1.0, default)
}

const fn index(name: &'static str, default: f32) -> Parameter {
    Parameter::number(name, 0.1..=6.0, default)
}

pub(super) const BASE: Parameter =
    Parameter { kind: Parameter::colour("", [231, 231, 231]).kind, ..BASE_COLOUR };
pub(super) const SPECULAR_ROUGHNESS: Parameter = Parameter { kind: fraction("", 0.3).kind, ..ROUGHNESS };
pub(super) const BASE_WEIGHT: Parameter = fraction("base_weight", 1.0)
    .symbol("w_b")
    .label("weight of the base")
    .help("A factor on the base colour, of the body and of metal alike.");
pub(super) const BASE_DIFFUSE_ROUGHNESS: Parameter = fraction("base_diffuse_roughness", 0.0)
    .symbol("σ")
    .label("roughness of the body")
    .help("The roughness of the body that scatters light, as in EON: 0 is Lambert's law, 1 flat and chalky.")
    .stands_for(&meaning::BODY_ROUGHNESS);
pub(super) const SPECULAR_STRENGTH: Parameter = Parameter::number("specular_strength", 0.0..=10.0, 1.0)
    .symbol("ξ")
    .label("specular strength")
    .help("A factor on the reflectance at normal incidence: 0 removes the reflection of the base, values above 1 raise it.");
pub(super) const SPECULAR_ANISOTROPY: Parameter = fraction("specular_roughness_anisotropy", 0.0)
    .symbol("a")
    .label("anisotropy")
    .help("From 0, isotropic, to 1, highlights stretched along the tangent, as on brushed metal.")
    .stands_for(&meaning::OPENPBR_ANISOTROPY);
pub(super) const SPECULAR_IOR: Parameter = index("specular_ior", 1.5)
    .symbol("n_s")
    .label("refractive index")
    .help("The refractive index of the non-metallic base: water 1.33, plastic and glass 1.5, diamond 2.4.")
    .stands_for(&meaning::INDEX);
pub(super) const COAT_WEIGHT: Parameter = fraction("coat_weight", 0.0)
    .symbol("C")
    .label("coat")
    .help("The fraction of the surface under a clear coat, such as lacquer.")
    .stands_for(&meaning::COAT);
pub(super) const COAT_COLOUR: Parameter = Parameter::colour("coat_colour", [255; 3])
    .symbol("C_c")
    .label("colour of the coat")
    .help("The fraction of light that passes through the coat twice, in and out along the normal.");
pub(super) const COAT_ROUGHNESS: Parameter = fraction("coat_roughness", 0.0)
    .symbol("r_c")
    .label("roughness of the coat")
    .help("From 0, a mirror, to 1, a matte coat, which also blurs the reflection of the base.")
    .stands_for(&meaning::ROUGHNESS_OF_COAT);
pub(super) const COAT_ANISOTROPY: Parameter = fraction("coat_roughness_anisotropy", 0.0)
    .symbol("a_c")
    .label("anisotropy of the coat")
    .help("From 0, isotropic, to 1, reflections of the coat stretched along the tangent.");
pub(super) const COAT_IOR: Parameter = index("coat_ior", 1.6)
    .symbol("n_c")
    .label("refractive index of the coat")
    .help("The refractive index of the coat: lacquer has 1.5 to 1.6.");
pub(super) const COAT_DARKENING: Parameter = fraction("coat_darkening", 1.0)
    .symbol("δ")
    .label("darkening by the coat")
    .help("The amount of the darkening and saturation of a base under a coat, which returns part of the light to it. 1 is physical.");
pub(super) const FUZZ_WEIGHT: Parameter = fraction("fuzz_weight", 0.0)
    .symbol("F_z")
    .label("fuzz")
    .help("The amount of fuzz, a layer of fine fibres like the nap of velvet, or of dust.")
    .stands_for(&meaning::SHEEN);
pub(super) const FUZZ_COLOUR: Parameter = Parameter::colour("fuzz_colour", [255; 3])
    .symbol("C_f")
    .label("colour of the fuzz")
    .help("The colour of the fibres. Black fuzz darkens what lies below.")
    .stands_for(&meaning::COLOUR_OF_SHEEN);
pub(super) const FUZZ_ROUGHNESS: Parameter = fraction("fuzz_roughness", 0.5)
    .symbol("r_f")
    .label("roughness of the fuzz")
    .help("The disorder of the fibres: small values shine at the rim alone, as velvet does, 1 like dust everywhere. 0 is no fuzz.")
    .stands_for(&meaning::ROUGHNESS_OF_SHEEN);
pub(super) const THIN_FILM_WEIGHT: Parameter =
    fraction("thin_film_weight", 0.0).symbol("w_t").label("thin film").help(
        "The fraction of the base that has a film so thin that light interferes in it, as on soap bubbles.",
    );
pub(super) const THIN_FILM_THICKNESS: Parameter = Parameter::number("thin_film_thickness", 0.0..=10.0, 0.5)
    .symbol("d")
    .label("thickness of the film")
    .unit("µm")
    .help("The thickness of the film. Colours are strongest from 0.1 to 1 µm, and fade below 0.03 µm.");
pub(super) const THIN_FILM_IOR: Parameter = index("thin_film_ior", 1.4)
    .symbol("n_t")
    .label("refractive index of the film")
    .help("The refractive index of the film: soap 1.33, oxides of metals 2 to 2.7.");

const THIN: &str = "geometry_thin_walled";
pub(super) const TRANSMISSION_WEIGHT: Parameter = fraction("transmission_weight", 0.0)
    .symbol("w_τ")
    .label("transmission")
    .help("The fraction of the non-metallic base that is clear: light passes through it instead of being scattered in the body.")
    .stands_for(&meaning::TRANSMISSION);
pub(super) const TRANSMISSION_COLOUR: Parameter = Parameter::colour("transmission_colour", [255; 3])
    .symbol("C_τ")
    .label("colour of the transmitted light")
    .help("The colour of white light after the depth below, inside the object. At depth 0 the surface tints, wherever light enters or leaves; a thin wall does so at its single crossing.")
    .stands_for(&meaning::COLOUR_OF_TRANSMISSION);
pub(super) const TRANSMISSION_DEPTH: Parameter = Parameter::number("transmission_depth", 0.0..=100.0, 0.0)
    .symbol("d_τ")
    .label("depth of the colour")
    .unit("m")
    .help("The path length inside after which white light has the transmission colour. 0 absorbs nothing: then the colour tints at the surface.")
    .used_when(THIN, &["false"])
    .stands_for(&meaning::DEPTH_OF_TRANSMISSION);
pub(super) const DISPERSION_SCALE: Parameter = fraction("transmission_dispersion_scale", 0.0)
    .symbol("s_τ")
    .label("dispersion")
    .help("How much more blue light is bent than red: 0 nothing, 1 as much as the Abbe number says.")
    .used_when(THIN, &["false"]);
pub(super) const ABBE_NUMBER: Parameter = Parameter::number("transmission_dispersion_abbe_number", 1.0..=100.0, 20.0)
    .symbol("V_d")
    .label("Abbe number")
    .help("The dispersion of the material at full scale; small numbers disperse more. Glass has 20 to 90, water and diamond 55.")
    .used_when(THIN, &["false"]);
pub(super) const THIN_WALLED: Parameter = Parameter::flag(THIN, false)
    .label("thin-walled")
    .help("A sheet without an inside, such as a window or a bubble: light goes straight through. Otherwise the object is solid, and light is bent in it.");
