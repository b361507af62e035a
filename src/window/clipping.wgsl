// Counts the clipped pixels in each cell of a grid over the picture.

struct Ask {
    // Size of the picture in pixels.
    size: vec2<u32>,
    // Value above which a channel is clipped; negative if the opacity marks clipped pixels, as the models' wrapper does.
    limit: f32,
    // Returned with the result, to match it to its request.
    number: u32,
}

@group(0) @binding(0) var picture: texture_2d<f32>;
@group(0) @binding(1) var<uniform> ask: Ask;
@group(0) @binding(2) var<storage, read_write> answer: array<u32>;

@compute @workgroup_size(8, 8)
fn count(@builtin(global_invocation_id) id: vec3<u32>) {
    let grid = vec2<u32>(ACROSS, DOWN);
    if any(id.xy >= grid) {
        return;
    }
    let low = id.xy * ask.size / grid;
    let high = (id.xy + 1u) * ask.size / grid;
    var clipped = 0u;
    for (var y = low.y; y < high.y; y++) {
        for (var x = low.x; x < high.x; x++) {
            let pixel = textureLoad(picture, vec2(x, y), 0);
            // Lights with extent in sight are marked by an opacity of 253 of 255, and do not count.
            let is_beyond = any(pixel.rgb > vec3(ask.limit)) && pixel.a > 253.5 / 255.0;
            clipped += u32(select(is_beyond, pixel.a < 0.999, ask.limit < 0.0));
        }
    }
    answer[1u + id.y * ACROSS + id.x] = clipped;
    if id.x == 0u && id.y == 0u {
        answer[0] = ask.number;
    }
}
