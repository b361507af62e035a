// The inputs and outputs of a shading model, the twin of `Corner` and `Varying` in src/shading/mod.rs.

struct Corner {
    position: vec3<f32>,
    normal: vec3<f32>,
    tangent: vec3<f32>,
    face_normal: vec3<f32>,
    face_tangent: vec3<f32>,
    face_centre: vec3<f32>,
}

struct Varying {
    position: vec3<f32>,
    normal: vec3<f32>,
    tangent: vec3<f32>,
    colour: vec3<f32>,
    // Position relative to the object's centre: small numbers, whose derivatives stay exact far from
    // the room's origin.
    offset: vec3<f32>,
}
