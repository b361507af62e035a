// Torrance–Sparrow (K. E. Torrance, E. M. Sparrow 1967): facets with Gaussian angles, V-shaped cavities,
// exact Fresnel equations.

// The angle of this sine and cosine, 0 to π/2: four times the arctangent of the tangent of its quarter,
// by its series. The built-in atan may be accurate to only three digits.
fn angle_of(sine: f32, cosine: f32) -> f32 {
    let half = sine / (1.0 + cosine);
    let quarter = half / (1.0 + sqrt(1.0 + half * half));
    let x = -quarter * quarter;
    let series = 1.0 + x * (1.0 / 3.0 + x * (1.0 / 5.0 + x * (1.0 / 7.0 + x * (1.0 / 9.0 + x * (1.0 / 11.0 + x * (1.0 / 13.0 + x / 15.0))))));
    return 4.0 * quarter * series;
}

fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {
    let cos_l = dot(frame.n, l);
    let cos_v = dot(frame.n, v);
    if min(cos_l, cos_v) < 1e-9 {
        return Terms(vec3(0.0), vec3(0.0), vec3(0.0));
    }
    let h = half_vector(l, v);
    let cos_h = dot(frame.n, h);
    let cos_d = length(l + v) / 2.0;
    // D = c²/π exp(−c² θ²), c = 1/β.
    let spread = radians(m.facet_spread);
    let x = angle_of(length(cross(frame.n, h)), cos_h) / spread;
    let d = select(0.0, exp(-x * x) / (PI * spread * spread), cos_h > 0.0);
    let g = v_cavity(cos_l, cos_v, cos_h, cos_d) * cos_l;
    let f = conductor_rgb(m.ior, m.extinction, cos_d);
    let diffuse = (1.0 - m.specular_weight) * cos_l * m.base_colour;
    return Terms(vec3(0.0), diffuse, PI * m.specular_weight * d * g * f);
}
