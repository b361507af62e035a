// What knows the renderer: bindings, vertex attributes, entry points; that of lights in the picture is seen.wgsl.
#import bevy_pbr::mesh_functions
#import bevy_pbr::mesh_view_bindings::view
#import bevy_pbr::view_transformations::position_world_to_clip

// The parameters of all objects with the model, and values derived from them; an object's row is its
// mesh tag.
@group(#{MATERIAL_BIND_GROUP}) @binding(0) var<storage, read> parameter_table: array<Row>;
// The lights, and what holds for all of them. Shaders branch on the latter, and software Vulkan (Mesa) compiles a shader
// again whenever a uniform buffer is bound that it branches on: so a storage buffer. The lights one by one come from the same
// buffer bound as a uniform one, which it reads in a fifth of the time.
@group(#{MATERIAL_BIND_GROUP}) @binding(1) var<storage, read> illumination: Illumination;
@group(#{MATERIAL_BIND_GROUP}) @binding(4) var<uniform> light_list: Illumination;
// The parameters of the lights one after the other, and behind them the numbers of the files that they name.
@group(#{MATERIAL_BIND_GROUP}) @binding(2) var<storage, read> light_words: array<u32>;

// The parameters of the object being drawn.
var<private> parameters: Parameters;
var<private> object_row: u32;
// Where the object is found among all that are drawn.
var<private> object_instance: u32;
// The seed of the samples of light with extent: that of the pixel; 0 for all vertices, so that interpolation is smooth.
var<private> sample_seed: u32;

struct VertexIn {
    @builtin(instance_index) instance_index: u32,
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) tangent: vec3<f32>,
#ifdef FACES
    @location(3) face_normal: vec3<f32>,
    @location(4) face_tangent: vec3<f32>,
    @location(5) face_centre: vec3<f32>,
#endif
}

struct Stages {
    @builtin(position) clip_position: vec4<f32>,
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) tangent: vec3<f32>,
    @location(3) colour: vec3<f32>,
    @location(4) offset: vec3<f32>,
    @location(5) @interpolate(flat) row: u32,
    @location(6) @interpolate(flat) instance: u32,
}

fn light_at(i: u32) -> Light {
    return light_list.lights[i];
}

fn observer_position() -> vec3<f32> {
    return view.world_position;
}

// True if no triangle at a corner faces the observer, so that none is drawn. The normal was as long as the cone of the
// triangles' normals around it is narrow, the twin of src/render/facing.rs.
fn faces_away(position: vec3<f32>, normal: vec3<f32>, narrowness: f32) -> bool {
    return dot(normal, unit_or_zero(observer_position() - position)) * narrowness < -1.0;
}

@vertex
fn vertex(in: VertexIn) -> Stages {
    object_instance = in.instance_index;
    object_row = mesh_functions::get_tag(in.instance_index);
    parameters = parameter_table[object_row].parameters;
    let room_from_local = mesh_functions::get_world_from_local(in.instance_index);
    let centre = room_from_local[3].xyz;
    var corner: Corner;
    corner.position = (room_from_local * vec4(in.position, 1.0)).xyz;
    // Objects are scaled uniformly, so normals turn like positions. A tangent keeps its length, which
    // is its weight in interpolation between corners.
    corner.normal = unit_or_zero((room_from_local * vec4(in.normal, 0.0)).xyz);
    corner.tangent = (room_from_local * vec4(in.tangent, 0.0)).xyz;
#ifdef FACES
    corner.face_normal = unit_or_zero((room_from_local * vec4(in.face_normal, 0.0)).xyz);
    corner.face_tangent = (room_from_local * vec4(in.face_tangent, 0.0)).xyz;
    corner.face_centre = (room_from_local * vec4(in.face_centre, 1.0)).xyz;
#endif
    var passed = Varying(corner.position, corner.normal, corner.tangent, vec3(0.0), vec3(0.0));
#ifdef FACES
    let is_hidden = faces_away(corner.position, corner.face_normal, length(in.face_normal));
#else
    let is_hidden = faces_away(corner.position, corner.normal, length(in.normal));
#endif
    if !is_hidden {
        passed = shade_vertex(corner);
    }
    var out: Stages;
    out.clip_position = position_world_to_clip(corner.position);
    out.position = passed.position;
    out.normal = passed.normal;
    if illumination.channel >= CHANNEL_OF_GEOMETRY {
        // That of the vertex, whatever the shading model makes of it.
        out.normal = corner.normal;
    }
    out.tangent = passed.tangent;
    out.colour = passed.colour;
    out.offset = (room_from_local * vec4(in.position, 0.0)).xyz;
    out.row = object_row;
    out.instance = in.instance_index;
    return out;
}

@fragment
fn fragment(in: Stages) -> @location(0) vec4<f32> {
    object_row = in.row;
    object_instance = in.instance;
    parameters = parameter_table[object_row].parameters;
    let pixel = vec2<u32>(in.clip_position.xy);
    sample_seed = pixel.x | (pixel.y << 16u);
    let passed = Varying(in.position, in.normal, in.tangent, in.colour, in.offset);
    let shaded = shade_pixel(passed);
    if illumination.channel != 0u {
        let normal = unit_or_zero(in.normal);
        let face_normal = unit_or_zero(cross(dpdy(in.offset), dpdx(in.offset)));
        return vec4(channel_colour(shaded, in.position, normal, face_normal, in.clip_position.xy), 1.0);
    }
    let light = shaded * illumination.exposure;
    return displayed(light);
}
