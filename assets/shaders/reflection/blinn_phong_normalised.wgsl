// Normalised Blinn–Phong (J. Blinn 1977; exact factor after F. Giesen 2009): light is divided between
// the diffuse part and the lobe.
fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {
    let cos_i = dot(frame.n, l);
    if cos_i <= 0.0 || dot(frame.n, v) <= 0.0 {
        return Terms(vec3(0.0), vec3(0.0), vec3(0.0));
    }
    let a = m.alpha;
    let share = m.k_s * m.specular_colour;
    // π (α + 2)(α + 4)/(8π (2^(−α/2) + α)); the exponential is 0 long before its argument is too large.
    let norm = 0.125 * (a + 2.0) * ((a + 4.0) / (exp2(-0.5 * min(a, 250.0)) + a));
    let lobe = norm * power_of_cosine(half_tangent_squared(l, v, frame.n), a);
    return Terms(vec3(0.0), (vec3(1.0) - share) * m.base_colour * cos_i, share * lobe * cos_i);
}
