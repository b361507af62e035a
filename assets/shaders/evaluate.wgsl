// Evaluates a model for a list of direction pairs in a compute pass: the local frame has the normal
// along +z and the tangent along +x.

struct Pair {
    l: vec3<f32>,
    v: vec3<f32>,
}

// One row.
@group(0) @binding(0) var<storage, read> parameter_table: array<Row>;
@group(0) @binding(1) var<storage, read> pairs: array<Pair>;
@group(0) @binding(2) var<storage, read_write> answers: array<Terms>;

const object_row: u32 = 0u;

@compute @workgroup_size(64)
fn evaluate(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&pairs) {
        return;
    }
    let pair = pairs[id.x];
    let frame = Frame(vec3(0.0, 0.0, 1.0), vec3(1.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0));
    answers[id.x] = response(pair.l, pair.v, frame, parameter_table[object_row].parameters);
}
