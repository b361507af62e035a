/* lcm {} */
fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {
    let x = dot(l, v);
    let y = (
#ifdef NEVER
    )
#endif
    x);
    return Terms(vec3(0.0), vec3(y), vec3(0.0));
}
