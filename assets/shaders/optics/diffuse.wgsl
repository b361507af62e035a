// Diffuse reflection of rough surfaces, the twin of src/optics/diffuse.rs: factors on Lambert's ρ/π.

// B. Burley (2012), Physically Based Shading at Disney.
fn burley(cos_l: f32, cos_v: f32, cos_d: f32, roughness: f32) -> f32 {
    let f_d90 = 0.5 + 2.0 * roughness * cos_d * cos_d;
    return mix(1.0, f_d90, schlick_weight(cos_l)) * mix(1.0, f_d90, schlick_weight(cos_v));
}
