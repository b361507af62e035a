#import "../optics/half_difference.wgsl"

// A measured surface of the MERL database (W. Matusik and others 2003).
fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {
    return Terms(vec3(0.0), vec3(0.0), grid_response(m.merl_file, l, v, frame));
}
