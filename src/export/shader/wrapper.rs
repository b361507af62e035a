//! The entry points of an exported shader: the twins of `assets/shaders/wrapper.wgsl` for one object at a time.

use std::fmt::Write as _;

use super::Host;
use crate::optics::{colour::Encoding, tone::ToneMapping};

/// The text before everything else.
pub(super) fn prelude(host: Host) -> &'static str {
    match host {
        Host::Alone { .. } => "",
        Host::Bevy { .. } => {
            "#import bevy_pbr::mesh_functions
#import bevy_pbr::mesh_view_bindings::view
#import bevy_pbr::view_transformations::position_world_to_clip
"
        }
    }
}

/// The bind group of the material and the lights.
pub(super) fn group(host: Host) -> &'static str {
    match host {
        Host::Alone { .. } => "0",
        Host::Bevy { .. } => "#{MATERIAL_BIND_GROUP}",
    }
}

/// The entry points and the bindings used only by them; with `faces`, vertices contain data of their polygon;
/// with `samples`, pixels have a seed.
pub(super) fn text(host: Host, faces: bool, samples: bool) -> String {
    let mut text = String::new();
    let (input, placed, eye, clip) = match host {
        Host::Alone { .. } => (
            "",
            "placement.room_from_object",
            "view.observer_position",
            "view.clip_from_room * vec4(corner.position, 1.0)",
        ),
        Host::Bevy { .. } => (
            "    @builtin(instance_index) instance_index: u32,\n",
            "mesh_functions::get_world_from_local(in.instance_index)",
            "view.world_position",
            "position_world_to_clip(corner.position)",
        ),
    };
    if let Host::Alone { .. } = host {
        text.push_str(
            "// The camera: from room coordinates to clip space, with reversed depth (1 near, 0 infinitely far).
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
",
        );
    }
    let polygon = if faces {
        "    @location(3) face_normal: vec3<f32>,
    @location(4) face_tangent: vec3<f32>,
    @location(5) face_centre: vec3<f32>,
"
    } else {
        ""
    };
    let polygon_in_room = if faces {
        "    corner.face_normal = unit_or_zero((room_from_object * vec4(in.face_normal, 0.0)).xyz);
    corner.face_tangent = (room_from_object * vec4(in.face_tangent, 0.0)).xyz;
    corner.face_centre = (room_from_object * vec4(in.face_centre, 1.0)).xyz;
"
    } else {
        ""
    };
    let seed = if samples {
        "    let pixel = vec2<u32>(in.clip_position.xy);
    sample_seed = pixel.x | (pixel.y << 16u);
"
    } else {
        ""
    };
    let _ = write!(
        text,
        "struct VertexIn {{
{input}    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) tangent: vec3<f32>,
{polygon}}}
struct Stages {{
    @builtin(position) clip_position: vec4<f32>,
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) tangent: vec3<f32>,
    @location(3) colour: vec3<f32>,
    @location(4) offset: vec3<f32>,
}}
fn observer_position() -> vec3<f32> {{
    return {eye};
}}
@vertex
fn vertex(in: VertexIn) -> Stages {{
    let room_from_object = {placed};
    var corner: Corner;
    corner.position = (room_from_object * vec4(in.position, 1.0)).xyz;
    // The object is scaled uniformly, so normals turn like positions.
    corner.normal = unit_or_zero((room_from_object * vec4(in.normal, 0.0)).xyz);
    corner.tangent = (room_from_object * vec4(in.tangent, 0.0)).xyz;
{polygon_in_room}    let passed = shade_vertex(corner);
    var out: Stages;
    out.clip_position = {clip};
    out.position = passed.position;
    out.normal = passed.normal;
    out.tangent = passed.tangent;
    out.colour = passed.colour;
    // Small numbers, whose derivatives stay exact far from the origin.
    out.offset = (room_from_object * vec4(in.position, 0.0)).xyz;
    return out;
}}
@fragment
fn fragment(in: Stages) -> @location(0) vec4<f32> {{
{seed}    let passed = Varying(in.position, in.normal, in.tangent, in.colour, in.offset);
{}}}
",
        display(host)
    );
    if let Host::Bevy { exposure, .. } = host {
        let _ = write!(text, "// The factor of the exposure.\nconst EXPOSURE: f32 = {exposure:?};\n");
    }
    text
}

/// The conversion from light to the colour of the pixel.
fn display(host: Host) -> String {
    match host {
        Host::Alone { tone: ToneMapping::None, encoding: Encoding::Off } => {
            "    let light = shade_pixel(passed) * view.exposure;
    return vec4(clamp(light, vec3(0.0), vec3(1.0)), 1.0);
"
            .to_owned()
        }
        Host::Alone { tone, encoding: Encoding::Off } => format!(
            "    let c = clamp(shade_pixel(passed) * view.exposure, vec3(0.0), vec3(1.0));
    let light = vec3(srgb_decode(c.r), srgb_decode(c.g), srgb_decode(c.b));
    return vec4(srgb_encode({}(light)), 1.0);
",
            tone_function(tone)
        ),
        Host::Alone { tone, encoding: Encoding::Srgb } => format!(
            "    // The largest half float bounds the light, as where it is kept in half floats.
    let light = clamp(shade_pixel(passed) * view.exposure, vec3(-65504.0), vec3(65504.0));
    return vec4(srgb_encode({}(light)), 1.0);
",
            tone_function(tone)
        ),
        Host::Bevy { encoding, .. } => {
            let light = "    // Beyond the largest half float, light would become infinite, and black in tone mapping.
    let light = clamp(shade_pixel(passed) * EXPOSURE, vec3(-65504.0), vec3(65504.0));
";
            let end = match encoding {
                Encoding::Srgb => "    return vec4(light, 1.0);\n",
                Encoding::Off => "    // The display encodes its input; decoding first undoes that, and the numbers stay unchanged.
    let c = clamp(light, vec3(0.0), vec3(1.0));
    return vec4(srgb_decode(c.r), srgb_decode(c.g), srgb_decode(c.b), 1.0);
",
            };
            format!("{light}{end}")
        }
    }
}

/// The function of a tone mapping in `tone.wgsl`.
pub(super) fn tone_function(tone: ToneMapping) -> String {
    format!("tone_{}", tone.id())
}
