/* lcm
{
    "name": "Charlie sheen",
    "author": "A. C. Estevez, C. Kulla 2017",
    "source": "A. C. Estevez, C. Kulla (2017), Production Friendly Microfacet Sheen BRDF, Sony Pictures Imageworks",
    "summary": "Velvet and other cloth: upright fibres make the surface bright at grazing views and dark at normal ones. The opposite of a highlight.",
    "equation": [
        { "term": "diffuse", "text": "I_d = (1 − w) C_b (N·L)" },
        { "term": "specular", "text": "I_s = w π D C_f/(4 (N·V) (1 + Λ_l + Λ_v)), D = (2 + 1/r) sin^{1/r} θ_h/(2π)" },
    ],
    "laws": ["reciprocal", "energy conserving", "non-negative"],
    "parameters": [
        "base_colour",
        {
            "name": "fibre_colour", "symbol": "C_f", "label": "fibre colour", "type": "colour", "stands_for": "sheen_colour",
            "help": "The colour of the light scattered sideways by the fibres.",
        },
        {
            "name": "sheen_weight", "symbol": "w", "label": "sheen", "type": "number", "default": 0.7, "stands_for": "sheen",
            "help": "The fraction of the surface covered with fibres; the rest is matte.",
        },
        {
            "name": "sheen_roughness", "symbol": "r", "label": "sheen roughness", "type": "number",
            "min": 0.1, "max": 1, "default": 0.3, "stands_for": "sheen_roughness",
            "help": "The tilt of the fibres: small for velvet, with its narrow rim; large for wool.",
        },
    ],
}
*/

// The paper's table for the masking of the distribution, between the softest and the sharpest:
// L(x) = a/(1 + b x^c) + d x + e.
fn sheen_fit(x: f32, r: f32) -> f32 {
    let sharp = (1.0 - r) * (1.0 - r);
    let a = mix(21.5473, 25.3245, sharp);
    let b = mix(3.82987, 3.32435, sharp);
    let c = mix(0.19823, 0.16801, sharp);
    let d = mix(-1.97760, -1.27393, sharp);
    let e = mix(-4.32054, -4.85967, sharp);
    return a / (1.0 + b * power(x, c)) + d * x + e;
}

// Λ, mirrored about the cosine 0.5 as in the paper.
fn sheen_lambda(cosine: f32, r: f32) -> f32 {
    if cosine < 0.5 {
        return exp(sheen_fit(cosine, r));
    }
    return exp(2.0 * sheen_fit(0.5, r) - sheen_fit(1.0 - cosine, r));
}

fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {
    let cos_l = dot(frame.n, l);
    let cos_v = dot(frame.n, v);
    if cos_l <= 0.0 || cos_v <= 0.0 {
        return Terms(vec3(0.0), vec3(0.0), vec3(0.0));
    }
    let cos_h = dot(frame.n, half_vector(l, v));
    let sin_h = sqrt(max(1.0 - cos_h * cos_h, 0.0));
    let r = m.sheen_roughness;
    let d = (2.0 + 1.0 / r) * power(sin_h, 1.0 / r) / (2.0 * PI);
    let Lambda_l = sheen_lambda(cos_l, r);
    let Lambda_v = sheen_lambda(cos_v, r);
    let seen = 1.0 + Lambda_l + Lambda_v;
    // The guard is for grazing views, which have the highest values.
    let sheen = PI * d / (4.0 * max(cos_v, 1e-6) * seen);
    return Terms(
        vec3(0.0),
        (1.0 - m.sheen_weight) * m.base_colour * cos_l,
        m.sheen_weight * sheen * m.fibre_colour,
    );
}
