    if any(exposed > vec3(1.0005)) {
        let stripe = (u32(pixel.x) + u32(pixel.y)) & 4u;
        return vec4(select(CHANNEL_YELLOW, vec3(0.0), stripe != 0u), CHANNEL_CODES);
    }
    let shown = clamp(exposed, vec3(0.0), vec3(1.0));
    return vec4(shown, select(CHANNEL_LIGHT, CHANNEL_CODES, illumination.gamma_naive != 0u));
