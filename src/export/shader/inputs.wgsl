{{parameters}}// The parameters of the material.
@group({{group}}) @binding(0) var<uniform> parameters: Parameters;
const LIGHT_COUNT: u32 = {{count}}u;
const MAX_LIGHTS: u32 = LIGHT_COUNT;
struct Illumination {
    count: u32,
    terms: u32,
    exposure: f32,
    gamma_naive: u32,
    lights: array<Light, {{room}}>,
}
// The lights of the scene.
@group({{group}}) @binding(1) var<uniform> illumination: Illumination;
[[curve]]
// The directional albedo of the material, by the angle of view.
struct AlbedoCurve {
    nodes: array<vec4<f32>, {{length}}>,
    mean: f32,
}
@group({{group}}) @binding(2) var<uniform> albedo_curve: AlbedoCurve;
const HARMONICS: u32 = {{harmonics}}u;
fn curve_node(i: u32) -> vec4<f32> {
    return albedo_curve.nodes[i];
}
fn lobe_mean() -> f32 {
    return albedo_curve.mean;
}
[[shading]]
{{shading}}// The parameters of the shading model.
@group({{group}}) @binding(3) var<uniform> shading_values: ShadingParameters;
fn shading_parameters() -> ShadingParameters {
    return shading_values;
}
[[samples]]
// The samples of light for each pixel. They are the same in every picture, and so is their noise.
const LIGHT_SAMPLES: u32 = {{samples}}u;
[[extent]]
// The directions from which the material reflects most light. They guide the samples: any others give the same mean, with
// another noise.
@group({{group}}) @binding(7) var<uniform> material_lobes: array<vec4<f32>, {{lobes}}>;
fn lobe_row(i: u32) -> vec4<f32> {
    return material_lobes[i];
}
[[samples]]
// The seed of the samples: that of the pixel; 0 for all vertices, so that interpolation is smooth.
var<private> sample_seed: u32;
[[solid]]
// The boundary of the body, and its inside: the refractive index, the coefficient of its dispersion, the width of facets, and
// 1 if polygons have normals of their own; the absorption per metre.
@group({{group}}) @binding(8) var<uniform> interior: array<vec4<f32>, 2>;
fn interior_row(i: u32) -> vec4<f32> {
    return interior[i];
}
// The triangles of the body and the boxes around them, in rows of four words; the first row is zero if its mesh is not closed.
@group({{group}}) @binding(9) var solid_rows: texture_2d<u32>;
fn hierarchy_row(i: u32) -> vec4<u32> {
    return textureLoad(solid_rows, vec2(i % {{width}}u, i / {{width}}u), 0);
}
[[lamps]]
// The numbers of the files of lamps.
@group({{group}}) @binding(4) var<uniform> lamp_numbers: array<vec4<f32>, {{rows}}>;
fn illumination_number(i: u32) -> f32 {
    return lamp_numbers[i / 4u][i % 4u];
}
[[no_lamps]]
fn illumination_number(i: u32) -> f32 {
    return 0.0;
}
