// A ring that shines evenly to its front. `sample` gives a direction to it with its density, `seen` what is in a direction.
fn lamp_area(m: RingLampParameters) -> f32 {
    return PI * m.radius * m.radius * (1.0 - m.hole * m.hole);
}

fn sample_ring_lamp(light: Light, m: RingLampParameters, p: vec3<f32>, u: vec2<f32>) -> LightSample {
    let sides = rectangle_sides(light.direction, vec2(0.0, 1.0));
    let away = m.radius * sqrt(mix(m.hole * m.hole, 1.0, u.x));
    let angle = 2.0 * PI * u.y;
    let at = light.position + away * (cos(angle) * sides.x + sin(angle) * sides.y) - p;
    if !(dot(at, light.direction) < 0.0) {
        return LightSample(vec3(0.0, 1.0, 0.0), vec3(0.0), 0.0);
    }
    return LightSample(unit_or_zero(at), vec3(light.intensity), area_pdf(at, light.direction, lamp_area(m)));
}

fn seen_ring_lamp(light: Light, m: RingLampParameters, p: vec3<f32>, l: vec3<f32>) -> LightSeen {
    let middle = light.position - p;
    let facing = dot(l, light.direction);
    let distance = dot(middle, light.direction) / facing;
    let away = length(l * distance - middle);
    if !(facing < 0.0) || !(distance > 0.0) || away > m.radius || away < m.hole * m.radius {
        return NOTHING_SEEN;
    }
    return LightSeen(vec3(light.intensity), area_pdf(l * distance, light.direction, lamp_area(m)), distance);
}
