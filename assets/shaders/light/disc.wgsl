// Disc: the same luminance from every point of it in every direction to its front, by area.
fn sample_disc(light: Light, m: DiscParameters, p: vec3<f32>, u: vec2<f32>) -> LightSample {
    let sides = rectangle_sides(light.direction, vec2(0.0, 1.0));
    let on = sample_disc_map(u) * m.radius;
    let at = light.position + sides.x * on.x + sides.y * on.y - p;
    let l = unit_or_zero(at);
    let pdf = area_pdf(at, light.direction, PI * m.radius * m.radius);
    return LightSample(l, vec3(light.intensity), select(0.0, pdf, light_shines(-dot(l, light.direction), m.two_sided)));
}

fn seen_disc(light: Light, m: DiscParameters, p: vec3<f32>, l: vec3<f32>) -> LightSeen {
    let facing = -dot(l, light.direction);
    if !light_shines(facing, m.two_sided) {
        return NOTHING_SEEN;
    }
    let middle = light.position - p;
    let distance = -dot(middle, light.direction) / facing;
    let beside = l * distance - middle;
    if !(distance > 0.0) || dot(beside, beside) > m.radius * m.radius {
        return NOTHING_SEEN;
    }
    return LightSeen(vec3(light.intensity), area_pdf(l * distance, light.direction, PI * m.radius * m.radius), distance);
}
