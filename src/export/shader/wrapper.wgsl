[[alone]]
// The camera: from room coordinates to clip space, with reversed depth (1 near, 0 infinitely far).
struct View {
    clip_from_room: mat4x4<f32>,
    observer_position: vec3<f32>,
    // The factor of the exposure.
    exposure: f32,
}
@group(0) @binding(5) var<uniform> view: View;
// The place, rotation and size of the object.
struct Placement {
    room_from_object: mat4x4<f32>,
}
@group(0) @binding(6) var<uniform> placement: Placement;
[[place]]
fn solid_placement() -> mat4x4<f32> {
    return placement.room_from_object;
}
[[instance]]
// Where the object is found among all that are drawn.
var<private> object_instance: u32;
fn solid_placement() -> mat4x4<f32> {
    return mesh_functions::get_world_from_local(object_instance);
}
[[]]
struct VertexIn {
[[bevy]]
    @builtin(instance_index) instance_index: u32,
[[]]
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) tangent: vec3<f32>,
[[faces]]
    @location(3) face_normal: vec3<f32>,
    @location(4) face_tangent: vec3<f32>,
    @location(5) face_centre: vec3<f32>,
[[]]
}
struct Stages {
    @builtin(position) clip_position: vec4<f32>,
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) tangent: vec3<f32>,
    @location(3) colour: vec3<f32>,
    @location(4) offset: vec3<f32>,
[[instance]]
    @location(5) @interpolate(flat) instance: u32,
[[]]
}
fn observer_position() -> vec3<f32> {
[[alone]]
    return view.observer_position;
[[bevy]]
    return view.world_position;
[[]]
}
@vertex
fn vertex(in: VertexIn) -> Stages {
[[alone]]
    let room_from_object = placement.room_from_object;
[[bevy]]
    let room_from_object = mesh_functions::get_world_from_local(in.instance_index);
[[]]
[[instance]]
    object_instance = in.instance_index;
[[]]
    var corner: Corner;
    corner.position = (room_from_object * vec4(in.position, 1.0)).xyz;
    // The object is scaled uniformly, so normals turn like positions.
    corner.normal = unit_or_zero((room_from_object * vec4(in.normal, 0.0)).xyz);
    corner.tangent = (room_from_object * vec4(in.tangent, 0.0)).xyz;
[[faces]]
    corner.face_normal = unit_or_zero((room_from_object * vec4(in.face_normal, 0.0)).xyz);
    corner.face_tangent = (room_from_object * vec4(in.face_tangent, 0.0)).xyz;
    corner.face_centre = (room_from_object * vec4(in.face_centre, 1.0)).xyz;
[[]]
    let passed = shade_vertex(corner);
    var out: Stages;
[[alone]]
    out.clip_position = view.clip_from_room * vec4(corner.position, 1.0);
[[bevy]]
    out.clip_position = position_world_to_clip(corner.position);
[[]]
    out.position = passed.position;
    out.normal = passed.normal;
    out.tangent = passed.tangent;
    out.colour = passed.colour;
    // Small numbers, whose derivatives stay exact far from the origin.
    out.offset = (room_from_object * vec4(in.position, 0.0)).xyz;
[[instance]]
    out.instance = in.instance_index;
[[]]
    return out;
}
@fragment
fn fragment(in: Stages) -> @location(0) vec4<f32> {
[[samples]]
    let pixel = vec2<u32>(in.clip_position.xy);
    sample_seed = pixel.x | (pixel.y << 16u);
[[instance]]
    object_instance = in.instance;
[[]]
    let passed = Varying(in.position, in.normal, in.tangent, in.colour, in.offset);
[[clip]]
    let light = shade_pixel(passed) * view.exposure;
    return vec4(clamp(light, vec3(0.0), vec3(1.0)), 1.0);
[[decode]]
    let c = clamp(shade_pixel(passed) * view.exposure, vec3(0.0), vec3(1.0));
    let light = vec3(srgb_decode(c.r), srgb_decode(c.g), srgb_decode(c.b));
    return vec4(srgb_encode({{tone}}(light)), 1.0);
[[map]]
    // The largest half float bounds the light, as where it is kept in half floats.
    let light = clamp(shade_pixel(passed) * view.exposure, vec3(-65504.0), vec3(65504.0));
    return vec4(srgb_encode({{tone}}(light)), 1.0);
[[bevy]]
    // Beyond the largest half float, light would become infinite, and black in tone mapping.
    let light = clamp(shade_pixel(passed) * EXPOSURE, vec3(-65504.0), vec3(65504.0));
[[light]]
    return vec4(light, 1.0);
[[undo]]
    // The display encodes its input; decoding first undoes that, and the numbers stay unchanged.
    let c = clamp(light, vec3(0.0), vec3(1.0));
    return vec4(srgb_decode(c.r), srgb_decode(c.g), srgb_decode(c.b), 1.0);
[[]]
}
[[bevy]]
// The factor of the exposure.
const EXPOSURE: f32 = {{exposure}};
