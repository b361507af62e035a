    if luminance <= 0.0 {
        return vec4(0.0);
    }
    // Four decades, from 0.001 to 10.
    return vec4(log2(luminance) * 0.0752575 + 0.75, 0.0, 0.0, CHANNEL_PLACE);
