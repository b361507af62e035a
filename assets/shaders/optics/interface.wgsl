// A rough boundary between two transparent media, the twin of src/optics/interface.rs: B. Walter, S. Marschner, H. Li,
// K. Torrance (2007), Microfacet Models for Refraction through Rough Surfaces. Directions are in the local frame, on either
// side, away from the surface: l to the light, v to the viewer. Radiance is scaled by the squares of the indices.

struct Interface {
    // 0 GGX, 1 Beckmann.
    facets: u32,
    // Along tangent and bitangent, at least MINIMUM_ALPHA.
    alpha: vec2<f32>,
    // Index inside over that outside.
    ior: f32,
}

// The facet that refracts one direction to another; eta from the side of v.
struct Refracting {
    h: vec3<f32>,
    cos_l: f32,
    cos_v: f32,
    eta: f32,
    // (v·h + η l·h)²; 0 if there is none, or one of the two sees its back.
    squared: f32,
}

fn interface_distribution(i: Interface, h: vec3<f32>) -> f32 {
    if i.facets == 1u {
        return beckmann(h, i.alpha);
    }
    return ggx(h, i.alpha);
}

fn interface_lambda(i: Interface, d: vec3<f32>) -> f32 {
    let above = vec3(d.xy, abs(d.z));
    if i.facets == 1u {
        return smith_beckmann(above, i.alpha);
    }
    return smith_ggx(above, i.alpha);
}

// G/(4 |cos θ_l cos θ_v|).
fn interface_visibility(i: Interface, l: vec3<f32>, v: vec3<f32>) -> f32 {
    return separable(abs(l.z), abs(v.z), interface_lambda(i, l), interface_lambda(i, v));
}

fn interface_refracting(i: Interface, l: vec3<f32>, v: vec3<f32>) -> Refracting {
    let eta = relative_index(i.ior, v.z);
    let sum = across(l, v, eta);
    // 1 + v·l.
    let bend = 0.5 * dot(l + v, l + v);
    let along_v = bend + (eta - 1.0) * (bend - 1.0);
    let along_l = bend + (eta - 1.0);
    if l.z * v.z >= 0.0 || is_matched(i.ior) || along_v * along_l >= 0.0 || dot(sum, v) * v.z <= 0.0 {
        return Refracting(vec3(0.0), 0.0, 0.0, eta, 0.0);
    }
    let squared = dot(sum, sum);
    let scale = 1.0 / sqrt(squared);
    return Refracting(sum * scale, min(abs(along_l) * scale, 1.0), min(abs(along_v) * scale, 1.0), eta, squared);
}

// The normal of the facet that reflects l to v, z ≥ 0; zero if there is none.
fn interface_reflecting(i: Interface, l: vec3<f32>, v: vec3<f32>) -> vec3<f32> {
    if l.z * v.z <= 0.0 || is_matched(i.ior) {
        return vec3(0.0);
    }
    return unit_or_zero(select(l + v, -(l + v), v.z < 0.0));
}

// f_r = D F G/(4 |cos θ_l cos θ_v|).
fn interface_reflected(i: Interface, l: vec3<f32>, v: vec3<f32>) -> f32 {
    let h = interface_reflecting(i, l, v);
    if h.z <= 0.0 {
        return 0.0;
    }
    let f = dielectric(relative_index(i.ior, v.z), abs(dot(h, v)));
    return f * interface_distribution(i, h) * interface_visibility(i, l, v);
}

// f_t = |v·h| |l·h|/|cos θ_l cos θ_v| (1 − F) D G/(v·h + η l·h)².
fn interface_transmitted(i: Interface, l: vec3<f32>, v: vec3<f32>) -> f32 {
    let facet = interface_refracting(i, l, v);
    if facet.squared <= 0.0 {
        return 0.0;
    }
    let f = refracting_reflectance(facet.cos_l, facet.cos_v, facet.eta);
    let jacobian = facet.cos_l * facet.cos_v / facet.squared;
    return 4.0 * (1.0 - f) * interface_distribution(i, facet.h) * interface_visibility(i, l, v) * jacobian;
}

fn interface_bsdf(i: Interface, l: vec3<f32>, v: vec3<f32>) -> f32 {
    if l.z * v.z > 0.0 {
        return interface_reflected(i, l, v);
    }
    return interface_transmitted(i, l, v);
}

// The normal of a GGX facet that is visible from v, above the surface (E. Heitz 2018; J. Dupuy, A. Benyoub 2023).
fn interface_visible_normal(u: vec2<f32>, v: vec3<f32>, alpha: vec2<f32>) -> vec3<f32> {
    let wide = normalize(vec3(v.xy * alpha, v.z));
    let phi = 2.0 * PI * u.x;
    let z = (1.0 - u.y) * (1.0 + wide.z) - wide.z;
    let cap = vec3(sqrt(max((1.0 - z) * (1.0 + z), 0.0)) * vec2(cos(phi), sin(phi)), z) + wide;
    return unit_or_zero(vec3(cap.xy * alpha, max(cap.z, 0.0)));
}

// A direction to the light for three numbers from 0 to 1; zero where there is none.
fn interface_sample(i: Interface, u: vec3<f32>, v: vec3<f32>) -> vec3<f32> {
    if v.z == 0.0 || is_matched(i.ior) {
        return vec3(0.0);
    }
    let seen = vec3(v.xy, abs(v.z));
    let h = interface_visible_normal(u.xy, seen, i.alpha);
    let eta = relative_index(i.ior, v.z);
    let cosine = clamp(dot(h, seen), 0.0, 1.0);
    let reflects = u.z < dielectric(eta, cosine);
    var l = refracted(seen, h, eta);
    if reflects {
        l = 2.0 * cosine * h - seen;
    }
    if l.z == 0.0 || (l.z > 0.0) != reflects {
        return vec3(0.0);
    }
    return vec3(l.xy, select(l.z, -l.z, v.z < 0.0));
}

// The density of the GGX facets that a viewer sees, divided by V·H.
fn interface_visible(i: Interface, h: vec3<f32>, v: vec3<f32>) -> f32 {
    let above = vec3(v.xy, abs(v.z));
    return ggx(h, i.alpha) / (above.z + smith_ggx(above, i.alpha));
}

fn interface_pdf(i: Interface, l: vec3<f32>, v: vec3<f32>) -> f32 {
    let facet = interface_refracting(i, l, v);
    if facet.squared > 0.0 {
        let f = refracting_reflectance(facet.cos_l, facet.cos_v, facet.eta);
        let jacobian = facet.eta * facet.eta * facet.cos_l / facet.squared;
        return (1.0 - f) * interface_visible(i, facet.h, v) * facet.cos_v * jacobian;
    }
    let h = interface_reflecting(i, l, v);
    if h.z <= 0.0 {
        return 0.0;
    }
    return dielectric(relative_index(i.ior, v.z), abs(dot(h, v))) * interface_visible(i, h, v) / 4.0;
}
