// The noise of a picture that converges: sums over the pixels in which samples differ, of one workgroup each.

@group(0) @binding(0) var mean: texture_2d<f32>;
@group(0) @binding(1) var squares: texture_2d<f32>;
// Of the pixels in which samples differ, the sum of squares about the mean luminance, the mean luminance, and their
// number; and the number of those in which something is seen.
@group(0) @binding(2) var<storage, read_write> sums: array<vec4<f32>>;

var<workgroup> parts: array<vec4<f32>, 64>;

@compute @workgroup_size(64)
fn sum(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) index: u32,
) {
    let size = textureDimensions(mean);
    var part = vec4(0.0);
    for (var y = group.x; y < size.y; y += groups.x) {
        for (var x = index; x < size.x; x += 64u) {
            let here = textureLoad(mean, vec2(x, y), 0);
            let luminance = dot(here.rgb, vec3(0.2126, 0.7152, 0.0722));
            // As in mean.wgsl: where nothing is seen, the opacity is 1.
            let spread = textureLoad(squares, vec2(x, y), 0).r;
            // Lamps and surroundings in the picture have no noise, and would hide that of surfaces.
            if here.a < 1.0 {
                part.w += 1.0;
                if luminance > 0.0 && spread > 0.0 {
                    part += vec4(spread, luminance, 1.0, 0.0);
                }
            }
        }
    }
    parts[index] = part;
    workgroupBarrier();
    if index == 0u {
        for (var i = 1u; i < 64u; i++) {
            part += parts[i];
        }
        sums[group.x] = part;
    }
}
