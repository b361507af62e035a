    // What is not a number has been dealt with.
    let bits = bitcast<vec3<u32>>(light) & vec3(0x7fffffffu);
    if any(bits == vec3(0x7f800000u)) {
        return vec4(CHANNEL_YELLOW, CHANNEL_CODES);
    }
    if any(light < vec3(0.0)) {
        return vec4(CHANNEL_BLUE, CHANNEL_CODES);
    }
    return vec4(vec3(min(0.25 * luminance * illumination.exposure, 0.25)), CHANNEL_LIGHT);
