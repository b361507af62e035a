// Modified Phong (R. Lewis 1993; E. Lafortune, Y. Willems 1994): a reciprocal lobe around the mirror
// direction, light divided between it and the diffuse part.
fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {
    let cos_i = dot(frame.n, l);
    if cos_i <= 0.0 || dot(frame.n, v) <= 0.0 {
        return Terms(vec3(0.0), vec3(0.0), vec3(0.0));
    }
    let share = m.k_s * m.specular_colour;
    let lobe = (0.5 * m.alpha + 1.0) * power_of_cosine(mirror_tangent_squared(l, v, frame.n), m.alpha);
    return Terms(vec3(0.0), (vec3(1.0) - share) * m.base_colour * cos_i, share * lobe * cos_i);
}
