    if luminance < 1e-4 {
        return vec4(0.0);
    }
    // Four decades, up to 1.
    return vec4(log2(luminance) * 0.0752575 + 1.0, 0.0, 0.0, CHANNEL_PLACE);
