// Refraction at a smooth boundary, the twin of src/optics/refraction.rs. Directions point away from the boundary; eta is the
// refractive index on the other side, divided by that on the side of v.

// Indices that differ by less count as equal.
const MATCHED: f32 = 1e-3;

fn is_matched(eta: f32) -> bool {
    return abs(eta - 1.0) < MATCHED;
}

// eta of a body of refractive index ior, from outside (a positive cosine to its normal) or inside.
fn relative_index(ior: f32, cosine: f32) -> f32 {
    return select(1.0 / ior, ior, cosine >= 0.0);
}

// The cosine of the angle of refraction; 0 for total reflection.
fn refracted_cosine(cosine: f32, eta: f32) -> f32 {
    let g2 = (eta - 1.0) * (eta + 1.0) + cosine * cosine;
    return min(sqrt(max(g2, 0.0)) / eta, 1.0);
}

// W. Snell's law as a vector: ((c − g) n − v)/η with n on the side of v. Zero for total reflection.
fn refracted(v: vec3<f32>, n: vec3<f32>, eta: f32) -> vec3<f32> {
    let c = dot(v, n);
    let g2 = (eta - 1.0) * (eta + 1.0) + c * c;
    if g2 <= 0.0 {
        return vec3(0.0);
    }
    let along = (1.0 - eta) * (1.0 + eta) / (max(c, 0.0) + sqrt(g2));
    return (n * along - v) / eta;
}

// ±(v + η l), along the normal of the facet that refracts l to v, z ≥ 0 (B. Walter et al. 2007).
fn across(l: vec3<f32>, v: vec3<f32>, eta: f32) -> vec3<f32> {
    let sum = (eta - 1.0) * l + (v + l);
    return select(sum, -sum, sum.z < 0.0);
}

// The reflectance of a boundary that refracts between these cosines, calculated in the thinner medium.
fn refracting_reflectance(cos_l: f32, cos_v: f32, eta: f32) -> f32 {
    if eta < 1.0 {
        return dielectric(1.0 / eta, cos_l);
    }
    return dielectric(eta, cos_v);
}
