// Lights with extent as they are seen: a triangle over the whole picture, with the light and the depth of the nearest in each
// direction; the twin of src/reference/visible.rs. Drawn only where a scene has such lights.
#import bevy_pbr::mesh_view_bindings::view

// Twice, as in wrapper.wgsl.
@group(#{MATERIAL_BIND_GROUP}) @binding(1) var<storage, read> illumination: Illumination;
@group(#{MATERIAL_BIND_GROUP}) @binding(4) var<uniform> light_list: Illumination;
@group(#{MATERIAL_BIND_GROUP}) @binding(2) var<storage, read> light_words: array<u32>;

fn light_at(i: u32) -> Light {
    return light_list.lights[i];
}

struct SeenStages {
    @builtin(position) clip_position: vec4<f32>,
    // The place in the picture: −1 to 1, to the right and upwards.
#ifdef SAMPLED
    @location(0) @interpolate(perspective, sample) place: vec2<f32>,
#else
    @location(0) place: vec2<f32>,
#endif
}

struct SeenPixel {
    @location(0) colour: vec4<f32>,
    @builtin(frag_depth) depth: f32,
}

@vertex
fn vertex(@location(0) position: vec3<f32>) -> SeenStages {
    return SeenStages(vec4(position, 1.0), position.xy);
}

@fragment
fn fragment(in: SeenStages) -> SeenPixel {
    let ahead = view.view_from_clip * vec4(in.place, 1.0, 1.0);
    // The point of the line of sight whose distance along the view axis is 1.
    let line = ahead.xyz / -ahead.z;
    let stretch = length(line);
    let l = (view.world_from_view * vec4(line / stretch, 0.0)).xyz;
    var light_there = false;
    var nearness = 0.0;
    var radiance = vec3(0.0);
    for (var i = 0u; i < min(illumination.count, MAX_LIGHTS); i++) {
        let light = light_at(i);
        if light_is_visible(light) {
            let seen = seen_light(light, view.world_position, l);
            let is_hidden = seen.distance < 0.0 && illumination.has_backdrop != 0u;
            if seen.distance != 0.0 && !is_hidden {
                light_there = true;
                // Several that are infinitely far away add up.
                let near = select(stretch / seen.distance, 0.0, seen.distance < 0.0);
                if near > nearness {
                    nearness = near;
                    radiance = seen.radiance * light.colour;
                } else if nearness == 0.0 {
                    radiance += seen.radiance * light.colour;
                }
            }
        }
    }
    // Debug channels show objects alone.
    if !light_there || illumination.channel != 0u {
        discard;
    }
    // As bright as a white surface that receives it from everywhere, as objects are shown.
    var shown = displayed(PI * radiance * illumination.exposure);
    if illumination.look == LOOK_PART {
        // A lamp is not a surface that clips: src/render/mean.wgsl marks pixels that any part of one is in.
        shown.a = -4096.0;
    }
    // The depth of objects: the distance of the near plane over that along the view axis.
    return SeenPixel(shown, min(nearness * view.clip_from_view[3].z, 1.0));
}
