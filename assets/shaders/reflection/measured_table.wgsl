#import "../optics/half_difference.wgsl"

// Free measurements, interpolated into a table (R. Franke, G. Nielson 1980).
fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {
    return Terms(vec3(0.0), vec3(0.0), grid_response(m.table_file, l, v, frame));
}
