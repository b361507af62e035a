/* lcm {} */
@group(2) @binding(4) var picture: texture_2d<f32>;
fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {
    let x = dot(l, v);
    let y = textureLoad(picture, vec2(0), 0).x;
    return Terms(vec3(0.0), vec3(y), vec3(0.0));
}
