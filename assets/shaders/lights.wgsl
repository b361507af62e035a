// The light record and the terms of the light loop. The loop does not know the model, and only the
// generated `incident` knows the types of lights.

// Must equal `MAX_LIGHTS` in src/light/mod.rs (a test compares the layouts).
const MAX_LIGHTS: u32 = 256u;

const TERM_ALL: u32 = 0u;
const TERM_AMBIENT: u32 = 1u;
const TERM_DIFFUSE: u32 = 2u;
const TERM_SPECULAR: u32 = 3u;
const TERM_TRANSMITTED: u32 = 4u;
// No term: what remains inside solid bodies, for a debug channel.
const TERM_REMAINING: u32 = 5u;

// What lights of all types have, the twin of `LightRecord` in src/light/mod.rs.
struct Light {
    position: vec3<f32>,
    light_type: u32,
    direction: vec3<f32>,
    intensity: f32,
    colour: vec3<f32>,
    // Where its own parameters begin in `light_words`.
    first_word: u32,
}

// All lights of the scene and the display settings, small enough for any uniform buffer: 12 336 of at least 16 384 bytes.
struct Illumination {
    count: u32,
    terms: u32,
    exposure: f32,
    gamma_naive: u32,
    // The debug channel that is shown, 0 for none; its light; the ends of its scale, or for the direction of a light: 1 at
    // the low end if the light shines from its position, 0 if along its direction.
    channel: u32,
    channel_light: u32,
    channel_low: f32,
    channel_high: f32,
    // The samples of light with extent that are taken: the number of the first, and how many.
    first_sample: u32,
    sample_count: u32,
    // What pixels become.
    look: u32,
    // 1 if a background that the scene gives stands in place of what is infinitely far away.
    has_backdrop: u32,
    lights: array<Light, MAX_LIGHTS>,
}

// A look for the display; none, as the picture is a part of a mean, which gets its look later; none, as the target takes
// numbers: light before exposure, directions and distances.
const LOOK_DISPLAY: u32 = 0u;
const LOOK_PART: u32 = 1u;
const LOOK_NUMBERS: u32 = 2u;

// The light that arrives at a point from one light, for red, green and blue: from the direction l, or, if
// `everywhere` is not zero, equally from all directions.
struct Incident {
    l: vec3<f32>,
    intensity: vec3<f32>,
    everywhere: u32,
}

// The sum of the visible terms.
fn select_terms(terms: Terms, selection: u32) -> vec3<f32> {
    switch selection {
        case TERM_AMBIENT: { return terms.ambient; }
        case TERM_DIFFUSE: { return terms.diffuse; }
        case TERM_SPECULAR: { return terms.specular; }
        case TERM_TRANSMITTED, TERM_REMAINING: { return vec3(0.0); }
        default: { return terms.ambient + terms.diffuse + terms.specular; }
    }
}
