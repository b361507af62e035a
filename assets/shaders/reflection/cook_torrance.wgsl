// Cook–Torrance (R. L. Cook, K. E. Torrance 1982): Beckmann's distribution, V-shaped cavities, exact
// Fresnel equations; with the 1/4 of a normalised distribution, where the paper prints 1/π.
fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {
    let cos_l = dot(frame.n, l);
    let cos_v = dot(frame.n, v);
    if min(cos_l, cos_v) < 1e-9 {
        return Terms(vec3(0.0), vec3(0.0), vec3(0.0));
    }
    let h = half_vector(l, v);
    let cos_h = dot(frame.n, h);
    let cos_d = length(l + v) / 2.0;
    let d = beckmann(vec3(length(cross(frame.n, h)), 0.0, cos_h), vec2(m.slope));
    let g = v_cavity(cos_l, cos_v, cos_h, cos_d) * cos_l;
    let f = conductor_rgb(m.ior, m.extinction, cos_d);
    let diffuse = (1.0 - m.specular_weight) * cos_l * m.base_colour;
    return Terms(vec3(0.0), diffuse, PI * m.specular_weight * d * g * f);
}
