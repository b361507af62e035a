fn ambient_response(v: vec3<f32>, frame: Frame, m: Parameters) -> vec3<f32> {
    return vec3(0.5);
}
