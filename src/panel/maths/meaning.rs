//! The meanings of symbols, for tooltips.

use crate::reflection::{EquationPart, Term};
use crate::text::mathematics::{self, Atom, parse, same_symbol};

/// Symbols shared by all equations, with their meanings.
const MEANINGS: &[(&str, &str)] = &[
    ("I", "the light that leaves the surface towards the observer, per unit of light intensity"),
    ("I_a", "the ambient term: light without direction"),
    ("I_d", "the diffuse term: light scattered in all directions"),
    ("I_s", "the specular term: light gathered into a highlight"),
    ("N", "the unit normal: the direction in which the surface faces"),
    ("L", "the unit vector from the surface to the light"),
    ("V", "the unit vector from the surface to the observer"),
    ("H", "the half vector: the unit vector halfway between L and V"),
    ("R", "the mirror direction of L: 2(N·L)N − L"),
    ("T", "the unit tangent: the direction along which the surface is brushed"),
    ("B", "the unit bitangent: across the surface at right angles to the tangent"),
    ("D", "the distribution of the normals of the microfacets: how many face along H"),
    ("G", "masking and shadowing: the fraction of the microfacets that both light and observer see"),
    ("G_1", "masking: the fraction of the microfacets that is seen from one direction"),
    ("G_2", "masking and shadowing: the fraction of the microfacets that both light and observer see"),
    ("Λ", "Smith's function: hidden area of microfacets per visible area"),
    ("F", "the Fresnel reflectance: how much a smooth surface mirrors at this angle"),
    ("F_0", "the Fresnel reflectance when looking straight at the surface"),
    ("R_s", "the reflectance for light polarised perpendicular to the plane of incidence"),
    ("R_p", "the reflectance for light polarised in the plane of incidence"),
    ("F_90", "the Fresnel reflectance at grazing incidence"),
    ("F_L", "Schlick's weight for the light: (1 − N·L)⁵, 0 straight on and 1 at grazing incidence"),
    ("F_V", "Schlick's weight for the observer: (1 − N·V)⁵"),
    ("F_H", "Schlick's weight at the half vector: (1 − L·H)⁵"),
    ("C_0", "the colour of the reflection when looking straight at the surface"),
    ("C_h", "the colour of the sheen: white, or the hue of the base colour"),
    ("C_t", "the hue of the base colour: that colour at luminance 1"),
    ("D_r", "the distribution of the clear coat"),
    ("F_r", "the Fresnel reflectance of the clear coat"),
    ("G_r", "masking of the clear coat"),
    ("G_s", "masking of the base"),
    ("S", "shadowing of steep slopes by others"),
    ("f_s", "a flat diffuse term that stands for light that travels below the surface"),
    ("f_r", "the BRDF: reflected light per incoming light, in 1/sr"),
    ("E", "the directional albedo: how much of the light from one direction is reflected in all"),
    ("E_L", "the directional albedo for the direction of the light"),
    ("E_V", "the directional albedo for the direction of the observer"),
    ("E_m", "the mean directional albedo over all directions"),
    ("E_f", "the directional albedo of the fuzz"),
    ("E_c", "the directional albedo of the coat"),
    ("T_L", "the fraction of the light that passes the coat on its way in"),
    ("T_V", "the fraction of the light that passes the coat on its way to the observer"),
    ("Δ", "the darkening by the coat, which returns light to a base that absorbs some of it"),
    ("f_b", "the BRDF of the body below its boundary"),
    ("f_c", "the BRDF of the coat"),
    ("f_f", "the BRDF of the fuzz"),
    ("f_m", "light that bounces several times between the facets of metal"),
    ("F_d", "the Fresnel reflectance of a dielectric, such as glass or plastic"),
    ("F_82", "the reflectance of metal: Schlick’s approximation with a tint at 82°"),
    ("F_m", "the Fresnel reflectance of metal"),
    ("ρ", "the albedo: how much of the light is reflected, by colour"),
    ("α", "the width of the distribution of the microfacets: small for a mirror, 1 for a matt surface"),
    ("σ", "the spread of the slopes of the facets"),
    ("γ", "the exponent of the tail of the distribution"),
    ("μ", "the cosine of the angle between the normal and the direction"),
    ("μ_l", "the cosine of the angle between the normal and the light, N·L"),
    ("μ_v", "the cosine of the angle between the normal and the observer, N·V"),
    ("μ_i", "the cosine of the angle between the normal and the light, N·L"),
    ("μ_0", "the cosine of the angle between the normal and the light, N·L"),
    ("μ_o", "the cosine of the angle between the normal and the observer, N·V"),
    ("n", "the refractive index"),
    ("i", "the imaginary unit"),
    ("x", "the variable of the function"),
    ("k", "the extinction coefficient: how fast light dies away inside"),
    ("g", "the phase angle between light and observer"),
    ("ω", "a direction"),
    ("d", "the distance from the light to the point"),
    ("p", "the point that is lit"),
    ("e", "2.71828…, the base of natural logarithms"),
    ("π", "3.14159…"),
    ("θ", "the angle between the axis and the ray"),
    ("θ_i", "the angle between the normal and the light"),
    ("θ_r", "the angle between the normal and the observer"),
    ("θ_o", "the angle between the normal and the observer"),
    ("θ_h", "the angle between the normal and the half vector"),
    ("θ_d", "the angle between the half vector and the light"),
    ("α_x", "the width of the distribution along the tangent"),
    ("α_y", "the width of the distribution across the tangent"),
    ("θ_X", "the angle to the normal of L or V, or between L and H"),
    ("β", "the smaller of the angles of light and observer to the normal"),
    ("φ", "the angle about the normal, between light and observer"),
    ("φ_h", "the angle of the half vector about the normal, from the tangent"),
    ("φ_l", "the angle of the light about the normal, from the tangent"),
    ("φ_v", "the angle of the observer about the normal, from the tangent"),
];

/// The meaning of a symbol shared by all equations.
#[must_use]
pub fn meaning(symbol: &str) -> Option<&'static str> {
    MEANINGS.iter().find(|(s, _)| same_symbol(s, symbol)).map(|(_, m)| *m)
}

/// The definitions in an equation; a part may have several, separated by commas.
#[must_use]
pub fn definitions(parts: &[EquationPart]) -> Vec<(Term, &'static str)> {
    parts
        .iter()
        .flat_map(|part| mathematics::definitions(part.text).into_iter().map(|text| (part.term, text)))
        .collect()
}

/// True if an equation contains a matching symbol.
#[must_use]
pub fn has_symbol(parts: &[EquationPart], fits: impl Fn(&str) -> bool) -> bool {
    let of = |text: &str| parse(text).iter().filter_map(Atom::symbol).any(|symbol| fits(&symbol));
    parts.iter().any(|part| of(part.text))
}

/// The definition of a symbol in an equation: it starts with the symbol, alone or applied to an argument in brackets,
/// and an equals sign.
#[must_use]
pub fn definition(parts: &[EquationPart], symbol: &str) -> Option<&'static str> {
    let of = |text: &str| {
        let atoms: Vec<_> = parse(text).into_iter().filter(|a| *a != Atom::Space).collect();
        let named = atoms.first().and_then(Atom::symbol).is_some_and(|s| same_symbol(&s, symbol));
        let is = |i: usize, sign: &str| atoms.get(i).is_some_and(|a| a.base() == sign);
        named && (is(1, "=") || is(1, "(") && is(3, ")") && is(4, "="))
    };
    definitions(parts).into_iter().map(|(_, text)| text).find(|text| of(text))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_symbol_of_every_equation_is_explained() {
        let registry = crate::registry::Registry::builtin();
        let mut unexplained = Vec::new();
        for model in registry.models() {
            let d = model.declaration;
            for symbol in d.equation.iter().flat_map(|p| parse(p.text)).filter_map(|a| a.symbol()) {
                let known = model.parameters.iter().any(|p| same_symbol(p.symbol, &symbol))
                    || meaning(&symbol).is_some()
                    || definition(d.equation, &symbol).is_some()
                    || d.quantities.iter().any(|quantity| same_symbol(quantity.symbol(), &symbol));
                if !known {
                    unexplained.push(format!("{}: {symbol}", d.id));
                }
            }
        }
        assert_eq!(unexplained, [""; 0], "neither a parameter nor explained in `meaning`");
        let parts = [EquationPart { term: Term::Diffuse, text: "x = H·T / H·N , y_{ab} = x + z" }];
        assert!(definition(&parts, "x").is_some() && definition(&parts, "y_ab").is_some());
        assert!(definition(&parts, "z").is_none() && definition(&parts, "H").is_none());
        let parts = [EquationPart { term: Term::Diffuse, text: "I_d = H(μ_l) C_b, H(μ) = 1 + μ" }];
        assert_eq!(definition(&parts, "H"), Some("H(μ) = 1 + μ"), "not the half vector");
    }
}
