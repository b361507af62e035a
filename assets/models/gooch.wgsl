/* lcm
{
    "name": "Gooch",
    "author": "A. Gooch et al. 1998",
    "source": "A. Gooch, B. Gooch, P. Shirley, E. Cohen (1998), A Non-Photorealistic Lighting Model for Automatic Technical Illustration, SIGGRAPH 98",
    "summary": "The look of technical drawings: surfaces shade from warm facing the light to cool facing away, so their shape is visible everywhere, even in shadow. Deliberately breaks every law but one.",
    "equation": [
        { "term": "diffuse", "text": "I_d = t (y (1, 1, 0) + β C_b) + (1 − t)(b (0, 0, 1) + α C_b), t = (1 + N·L)/2" },
    ],
    "laws": ["non-negative"],
    "lit_from_below": true,
    "parameters": [
        "base_colour",
        { "name": "blue", "symbol": "b", "label": "blue in the shade", "default": 0.4, "help": "The amount of blue in the shade." },
        { "name": "yellow", "symbol": "y", "label": "yellow in the light", "default": 0.4, "help": "The amount of yellow on the lit side." },
        { "name": "shade_share", "symbol": "α", "label": "colour in the shade", "default": 0.2, "help": "The fraction of the base colour in the shade." },
        { "name": "light_share", "symbol": "β", "label": "colour in the light", "default": 0.6, "help": "The fraction of the base colour in the light." },
    ],
}
*/

fn gooch_cool(m: Parameters) -> vec3<f32> {
    return vec3(0.0, 0.0, m.blue) + m.shade_share * m.base_colour;
}

fn gooch_warm(m: Parameters) -> vec3<f32> {
    return vec3(m.yellow, m.yellow, 0.0) + m.light_share * m.base_colour;
}

// There is no dark side: light from behind counts as well.
fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {
    let t = 0.5 * (1.0 + dot(frame.n, l));
    return Terms(vec3(0.0), mix(gooch_cool(m), gooch_warm(m), t), vec3(0.0));
}

fn ambient_response(v: vec3<f32>, frame: Frame, m: Parameters) -> vec3<f32> {
    return mix(gooch_cool(m), gooch_warm(m), 0.5);
}
