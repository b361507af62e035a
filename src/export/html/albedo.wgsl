
// ---------------------------------------------------------------------
// For the page alone: the directional albedo at the nodes of the curve, which the program calculates on
// the CPU (src/optics/albedo). Column i of the target is the node μ = (i/15)³, row k the azimuth k · 45°.
const ALBEDO_PI: f32 = 3.14159265358979;
const ALBEDO_VIEWS: f32 = 15.0;
const ALBEDO_TURNS: u32 = 96u;
const ALBEDO_RINGS: u32 = 40u;

// A triangle that covers the target.
@vertex
fn albedo_vertex(@builtin(vertex_index) i: u32) -> @builtin(position) vec4<f32> {
    return vec4(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.5, 1.0);
}

// The bits of red, green and blue: targets for floats are not everywhere.
@fragment
fn albedo_fragment(@builtin(position) place: vec4<f32>) -> @location(0) vec4<u32> {
    let mu = max(pow(floor(place.x) / ALBEDO_VIEWS, 3.0), 1e-5);
    let sin_v = sqrt(max(1.0 - mu * mu, 0.0));
    let azimuth = floor(place.y) * 0.25 * ALBEDO_PI;
    let v = vec3(sin_v * cos(azimuth), sin_v * sin(azimuth), mu);
    let frame = frame_new(vec3(0.0, 0.0, 1.0), vec3(1.0, 0.0, 0.0));
    let parts = f32(ALBEDO_RINGS * ALBEDO_TURNS);
    var sum = vec3(0.0);
[[sharp]]
    // Light that does not spread.
    for (var i = 0u; i < {{most}}u; i++) {
        sum += sharp(i, v, frame, parameters).share;
    }
[[]]
    for (var turn = 0u; turn < ALBEDO_TURNS; turn++) {
        let phi = (f32(turn) + 0.5) * 2.0 * ALBEDO_PI / f32(ALBEDO_TURNS);
        // Half vectors from the plane of incidence, up to those that put the light on the horizon.
        let theta_max = 0.5 * (0.5 * ALBEDO_PI + atan2(sin_v * cos(phi), mu));
        let local = vec2(cos(phi), sin(phi));
        let turned = vec2(cos(phi + azimuth), sin(phi + azimuth));
        for (var ring = 0u; ring < ALBEDO_RINGS; ring++) {
            // Closer at both ends, where responses change fastest.
            let u = (f32(ring) + 0.5) / f32(ALBEDO_RINGS);
            let t = u * u * (3.0 - 2.0 * u);
            let part = 6.0 * u * (1.0 - u) / parts;
            // The diffuse term over the directions to the light.
            let theta = 0.5 * ALBEDO_PI * t;
            let l_d = vec3(sin(theta) * turned, cos(theta));
            let area = 0.5 * ALBEDO_PI * 2.0 * ALBEDO_PI * sin(theta) * part;
            sum += response(l_d, v, frame, parameters).diffuse * area / ALBEDO_PI;
            // The specular term over half vectors: θ_max t⁴ gives narrow lobes room.
            let t3 = t * t * t;
            let theta_h = theta_max * t3 * t;
            let h = vec3(sin(theta_h) * turned, cos(theta_h));
            let v_h = sin_v * sin(theta_h) * local.x + mu * cos(theta_h);
            let l_s = 2.0 * v_h * h - v;
            let stretch = 2.0 * ALBEDO_PI * sin(theta_h) * theta_max * 4.0 * t3 * 4.0 * v_h * part;
            sum += response(l_s, v, frame, parameters).specular * stretch / ALBEDO_PI;
[[transmits]]
            // The transmitted term over the same directions below the surface.
            let through = response(vec3(l_s.xy, -l_s.z), v, frame, parameters);
            sum += (through.ambient + through.diffuse + through.specular) * stretch / ALBEDO_PI;
[[]]
        }
    }
    return vec4(bitcast<vec3<u32>>(sum), 0u);
}
