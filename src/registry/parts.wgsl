[[row]]
struct Row {
    parameters: Parameters,
[[curve]]
    curve: array<vec4<f32>, {{length}}>,
    lobe_mean: f32,
[[row]]
{{more}}}
[[curve]]
const HARMONICS: u32 = {{harmonics}}u;
fn curve_node(i: u32) -> vec4<f32> {
    return parameter_table[object_row].curve[i];
}
fn lobe_mean() -> f32 {
    return parameter_table[object_row].lobe_mean;
}
[[cubic]]
fn curve_{{name}}(mu: f32) -> vec4<f32> {
    return curve_from(mu, {{first}}u);
}
[[values]]
fn value_{{name}}(i: u32) -> vec4<f32> {
    return curve_node({{first}}u + i);
}
[[linear]]
fn curve_{{name}}(mu: f32) -> vec4<f32> {
    let x = clamp(mu, 0.0, 1.0) * {{steps}};
    let i = min(u32(x), {{last}}u);
    return mix(curve_node({{first}}u + i), curve_node({{next}}u + i), x - f32(i));
}
[[cubic linear]]
fn mean_{{name}}() -> vec4<f32> {
    return curve_node({{mean}}u);
}
[[ambient]]
fn ambient_response(v: vec3<f32>, frame: Frame, m: Parameters) -> vec3<f32> {
    return directional_albedo(v, frame);
}
[[words]]
fn illumination_number(i: u32) -> f32 {
    return bitcast<f32>(light_words[i]);
}
fn light_word(light: Light, i: u32) -> u32 {
    return light_words[light.first_word + i];
}
fn light_number(light: Light, i: u32) -> f32 {
    return illumination_number(light.first_word + i);
}
[[file_drawn]]
// The numbers of the file of the object.
@group(#{MATERIAL_BIND_GROUP}) @binding(3) var<storage, read> file_words: array<u32>;
[[file_evaluated]]
@group(0) @binding(3) var<storage, read> file_words: array<u32>;
[[file_drawn file_evaluated]]
fn file_word(i: u32) -> u32 {
    return file_words[i];
}
[[file_padding]]
    padding: array<u32, {{padding}}>,
[[file_row]]
    file: array<array<u32, 8>, {{eights}}>,
[[file_alone]]
fn file_word(i: u32) -> u32 {
    return parameter_table[object_row].file[i / 8u][i % 8u];
}
[[light_alone]]
struct FileRow { numbers: array<f32, {{numbers}}> }
@group(0) @binding(0) var<storage, read> file_table: array<FileRow>;
fn illumination_number(i: u32) -> f32 {
    return file_table[0].numbers[i];
}
[[shading_alone]]
struct Row { shading: array<vec4<u32>, {{words}}> }
@group(0) @binding(0) var<storage, read> parameter_table: array<Row>;
var<private> object_row: u32;
var<private> to_the_right: vec3<f32>;
var<private> downwards: vec3<f32>;
fn dpdx(place: vec3<f32>) -> vec3<f32> {
    return to_the_right;
}
fn dpdy(place: vec3<f32>) -> vec3<f32> {
    return downwards;
}
fn illuminate(position: vec3<f32>, normal: vec3<f32>, tangent: vec3<f32>) -> vec3<f32> {
    return 0.5 + 0.25 * normal + 0.125 * tangent.yzx + 0.03125 * position.zxy;
}
[[pixel_alone]]
fn pixel_alone(passed: Varying, right: vec3<f32>, down: vec3<f32>) -> vec3<f32> {
    to_the_right = right;
    downwards = down;
    return shade_pixel(passed);
}
[[lobes]]
fn lobe_row(i: u32) -> vec4<f32> {
    return parameter_table[object_row].lobes[i];
}
[[no_lobes]]
fn lobe_row(i: u32) -> vec4<f32> {
    return vec4(0.0);
}
[[not_extended]]
fn extended(position: vec3<f32>, v: vec3<f32>, frame: Frame) -> vec3<f32> {
    return vec3(0.0);
}
[[reflects]]
// Light from below the surface does not count.
fn counts(cosine: f32) -> bool {
    return cosine > 0.0;
}
fn on_side(selection: u32, cosine: f32) -> u32 {
    return selection;
}
[[from_below]]
// The model answers to light from below the surface with the same terms, though none passes through.
fn counts(cosine: f32) -> bool {
    return cosine != 0.0;
}
fn on_side(selection: u32, cosine: f32) -> u32 {
    return selection;
}
[[transmits]]
fn counts(cosine: f32) -> bool {
    return cosine != 0.0;
}
// The terms of which the response to light from this side is shown: from below, the sum is the transmitted one.
fn on_side(selection: u32, cosine: f32) -> u32 {
    if cosine >= 0.0 || selection == TERM_REMAINING {
        return selection;
    }
    return select(TERM_AMBIENT, TERM_ALL, selection == TERM_ALL || selection == TERM_TRANSMITTED);
}
[[sharp]]
// A direction from which light comes without spreading, and the part of the radiance that reaches the viewer.
struct Sharp {
    l: vec3<f32>,
    share: vec3<f32>,
}
[[passes]]
// True if light passes through the surface.
const LIGHT_PASSES: bool = {{passes}};
[[unspread]]
// The light of the directions in which light does not spread.
fn unspread(position: vec3<f32>, v: vec3<f32>, frame: Frame, selection: u32) -> vec3<f32> {
    var colour = vec3(0.0);
    for (var i = 0u; i < {{most}}u; i++) {
        let way = sharp(i, v, frame, parameters);
        if any(way.share != vec3(0.0)) {
            let shown = on_side(selection, dot(frame.n, way.l));
            let terms = Terms(vec3(0.0), vec3(0.0), PI * way.share);
            colour += select_terms(terms, shown) * radiance_from(position, way.l);
        }
    }
    return colour;
}
[[spread]]
fn unspread(position: vec3<f32>, v: vec3<f32>, frame: Frame, selection: u32) -> vec3<f32> {
    return vec3(0.0);
}
[[radiance]]
// The radiance that arrives from a direction, from all lights with extent.
fn radiance_from(position: vec3<f32>, l: vec3<f32>) -> vec3<f32> {
    return radiance_beside(position, l, 0.0);
}
// The same for a direction chosen with a density, with its weight beside samples of the lights; without a density, weight 1.
fn radiance_beside(position: vec3<f32>, l: vec3<f32>, pdf: f32) -> vec3<f32> {
    var sum = vec3(0.0);
    for (var i = 0u; i < min(illumination.count, MAX_LIGHTS); i++) {
        let light = light_at(i);
        if has_extent(light.light_type) {
            let seen = seen_light(light, position, l);
            let weight = select(power_heuristic(pdf, seen.pdf), 1.0, pdf <= 0.0);
            sum += seen.radiance * light.colour * weight;
        }
    }
    return sum;
}
[[no_extent]]
fn has_extent(light_type: u32) -> bool {
    return false;
}
fn sample_light(light: Light, p: vec3<f32>, u: vec2<f32>) -> LightSample {
    return LightSample(vec3(0.0, 1.0, 0.0), vec3(0.0), 0.0);
}
fn seen_light(light: Light, p: vec3<f32>, l: vec3<f32>) -> LightSeen {
    return NOTHING_SEEN;
}
[[solid]]
// The hierarchy of the mesh of the object; its first row is zero if the mesh is not closed.
@group(#{MATERIAL_BIND_GROUP}) @binding(3) var<storage, read> solid_rows: array<vec4<u32>>;
fn hierarchy_row(i: u32) -> vec4<u32> {
    return solid_rows[i];
}
fn interior_row(i: u32) -> vec4<f32> {
    return parameter_table[object_row].interior[i];
}
[[entering]]
// The part of the light from within the body that reaches the viewer through what lies on its surface.
fn entering(v: vec3<f32>, frame: Frame, m: Parameters) -> vec3<f32> {
    return vec3(1.0);
}
[[placement]]
fn solid_placement() -> mat4x4<f32> {
    return mesh_functions::get_world_from_local(object_instance);
}
[[opaque]]
fn through(position: vec3<f32>, v: vec3<f32>, frame: Frame, selection: u32) -> vec3<f32> {
    return vec3(0.0);
}
