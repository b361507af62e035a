/* lcm {} */
var /* a comment /* in a comment */ */
< // and another one
workgroup > W: f32;
fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {
    let x = dot(l, v);
    let y = W;
    return Terms(vec3(0.0), vec3(y), vec3(0.0));
}
