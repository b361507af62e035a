[[bevy_pbr::mesh_functions]]
fn mesh_functions__get_tag(i: u32) -> u32 { return i; }
fn mesh_functions__get_world_from_local(i: u32) -> mat4x4<f32> { return mat4x4<f32>(); }
[[bevy_pbr::mesh_view_bindings::view]]
struct BevyView {
    world_position: vec3<f32>,
    view_from_clip: mat4x4<f32>,
    world_from_view: mat4x4<f32>,
    clip_from_view: mat4x4<f32>,
}
var<private> view: BevyView;
[[bevy_pbr::view_transformations::position_world_to_clip]]
fn position_world_to_clip(p: vec3<f32>) -> vec4<f32> { return vec4(p, 1.0); }
