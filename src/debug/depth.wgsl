    let range = illumination.channel_high - illumination.channel_low;
    return vec4((length(to_eye) - illumination.channel_low) / range, 0.0, 0.0, CHANNEL_PLACE);
