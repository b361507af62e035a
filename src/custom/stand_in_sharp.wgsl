fn sharp(i: u32, v: vec3<f32>, frame: Frame, m: Parameters) -> Sharp {
    return Sharp(v, vec3(0.0));
}
