/* lcm
{
    // The name in the window. The id in scene files is the name of this file, FILE.
    "name": NAME,
    // "author": "name and year",
    // "source": "publication",
    "summary": "A matte body under a soft gloss; the two share the light.",
    // One part for each term: total, ambient, diffuse, specular, transmitted. _x is a subscript, ^x a superscript.
    "equation": [
        { "term": "diffuse", "text": "I_d = (1 − g) C_b (N·L)" },
        { "term": "specular", "text": "I_s = g (N·H)^n (N·L)" },
    ],
    // The laws that the model keeps. `lcm models check ID` searches for violations.
    "laws": ["reciprocal", "energy conserving", "non-negative"],
    // True if turning the surface about its normal changes the response.
    "anisotropic": false,
    // True if light also passes through: l may then point below the surface, and that light is the term `transmitted`.
    "transmits": false,
    // True if the response is not zero for light from below the surface though none passes through.
    "lit_from_below": false,
    // A name alone is a parameter shared with other models: a surface keeps its value when the model changes.
    // Types are number, integer, colour, triple, choice and flag; missing keys have sensible defaults.
    "parameters": [
        "base_colour",
        {
            "name": "gloss", "symbol": "g", "label": "gloss", "type": "number",
            "min": 0, "max": 1, "default": 0.3,
            "help": "The fraction of light that is mirrored instead of scattered.",
        },
        {
            "name": "polish", "symbol": "n", "label": "polish", "type": "number",
            "min": 1, "max": 200, "default": 20,
            "help": "The exponent of the highlight: larger values make it smaller.",
        },
    ],
}
*/

// The light reflected to the viewer per unit of light, π f_r cos θ_l, where f_r is the BRDF. l points to the
// light and v to the viewer, both of length 1; frame has the normal n, the tangent t and the bitangent b;
// m has the parameters, colours as linear light. Functions of terms.wgsl and optics/ are available, such as
// half_vector, power, schlick and ggx.
fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {
    let cos_l = dot(frame.n, l);
    let cos_v = dot(frame.n, v);
    if cos_l <= 0.0 || cos_v <= 0.0 {
        return Terms(vec3(0.0), vec3(0.0), vec3(0.0));
    }
    let cos_h = max(dot(frame.n, half_vector(l, v)), 0.0);
    let diffuse = (1.0 - m.gloss) * m.base_colour * cos_l;
    let specular = vec3(m.gloss * power(cos_h, m.polish) * cos_l);
    // Ambient, diffuse, specular: the window can show each term alone.
    return Terms(vec3(0.0), diffuse, specular);
}

// The model answers uniform light by its directional albedo, which is calculated. To use a
// formula instead, define:
// fn ambient_response(v: vec3<f32>, frame: Frame, m: Parameters) -> vec3<f32> { … }
