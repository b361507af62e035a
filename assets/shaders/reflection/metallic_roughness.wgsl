// Metallic–roughness (B. Karis 2013; glTF 2.0, appendix B): GGX, height-correlated Smith masking, Schlick's
// Fresnel term. Written out for one roughness and without a half vector for speed, since it is so common:
// everything needed of H follows from S = L + V.
fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {
    let cos_l = dot(frame.n, l);
    let cos_v = dot(frame.n, v);
    if min(cos_l, cos_v) < 1e-9 {
        return Terms(vec3(0.0), vec3(0.0), vec3(0.0));
    }
    let sum = l + v;
    let squared = dot(sum, sum);
    let f0 = mix(vec3(0.16 * m.reflectance * m.reflectance), m.base_colour, m.metallic);
    let f = schlick(f0, 0.5 * sqrt(squared));

    // π D = 1/(α² q²), q = sin² θ_h/α² + cos² θ_h.
    let alpha = max(m.roughness * m.roughness, MINIMUM_ALPHA);
    let a2 = alpha * alpha;
    let across = cross(frame.n, sum);
    let along = cos_l + cos_v;
    let aq = alpha * (dot(across, across) / a2 + along * along) / squared;
    // V = 1/(2 (cos_l √(α² + (1 − α²) cos_v²) + cos_v √(α² + (1 − α²) cos_l²))).
    let masked_v = cos_l * sqrt(a2 + (1.0 - a2) * cos_v * cos_v);
    let masked_l = cos_v * sqrt(a2 + (1.0 - a2) * cos_l * cos_l);
    let specular = 0.5 * cos_l / (aq * aq * (masked_v + masked_l));
    let diffuse = (1.0 - m.metallic) * cos_l * m.base_colour * (1.0 - f);
    return Terms(vec3(0.0), diffuse, specular * f);
}
