// Cloth whose fibres shine at the rim: I_d = (1 − N·V)^p (N·L) C.
fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {
    let rim = pow(1.0 - saturate(dot(frame.n, v)), m.falloff);
    return Terms(vec3(0.0), rim * max(dot(frame.n, l), 0.0) * m.base_colour, vec3(0.0));
}
