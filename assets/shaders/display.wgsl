// From light to what the picture takes: the last step of every pixel, after the exposure.

// The largest half float; the twin of `BRIGHTEST` in src/optics/tone.rs.
const BRIGHTEST: f32 = 65504.0;

// The opacity of a pixel whose channels ask for more than an 8-bit display can show: 254 of 255, which nobody sees, but
// which can be counted. Exactly white is not cut off, even if half floats round it.
const CUT_OFF: f32 = 254.0 / 255.0;
const WHITE: f32 = 1.0005;

fn displayed(light: vec3<f32>) -> vec4<f32> {
    // Values beyond the target's half floats would become infinite, and black in tone mapping.
    let linear = clamp(light, vec3(-BRIGHTEST), vec3(BRIGHTEST));
    if illumination.look != LOOK_DISPLAY {
        // Light as it is; of a part of a mean marked as something that is seen: src/render/mean.wgsl does the rest with
        // the mean. Numbers are kept whole.
        return select(vec4(linear, 0.0), vec4(light, 1.0), illumination.look == LOOK_NUMBERS);
    }
#ifdef GAMMA_NAIVE
    // The display encodes its input; decoding first undoes that, and the numbers stay unchanged.
    let c = clamp(linear, vec3(0.0), vec3(1.0));
    let opacity = select(1.0, CUT_OFF, any(linear >= vec3(1.0)));
    return vec4(srgb_decode(c.r), srgb_decode(c.g), srgb_decode(c.b), opacity);
#else
    return vec4(linear, select(1.0, CUT_OFF, any(linear > vec3(WHITE))));
#endif
}
