// Rectangle: the same luminance from every point of it in every direction to its front, by solid angle.
fn rectangle_from(light: Light, m: RectangleParameters, p: vec3<f32>, sides: Sides) -> SphericalRectangle {
    return spherical_rectangle(light.position - p, sides.x, sides.y, 0.5 * vec2(m.width, m.height));
}

fn sample_rectangle(light: Light, m: RectangleParameters, p: vec3<f32>, u: vec2<f32>) -> LightSample {
    let sides = rectangle_sides(light.direction, vec2(m.roll_sine, m.roll_cosine));
    let seen = rectangle_from(light, m, p, sides);
    let at = spherical_rectangle_sample(seen, u);
    let l = unit_or_zero(at);
    let pdf = select(0.0, spherical_rectangle_pdf(seen, at), light_shines(-dot(l, light.direction), m.two_sided));
    return LightSample(l, vec3(light.intensity), pdf);
}

fn seen_rectangle(light: Light, m: RectangleParameters, p: vec3<f32>, l: vec3<f32>) -> LightSeen {
    let facing = -dot(l, light.direction);
    if !light_shines(facing, m.two_sided) {
        return NOTHING_SEEN;
    }
    let sides = rectangle_sides(light.direction, vec2(m.roll_sine, m.roll_cosine));
    let middle = light.position - p;
    let distance = -dot(middle, light.direction) / facing;
    let beside = l * distance - middle;
    if !(distance > 0.0) || abs(dot(beside, sides.x)) > 0.5 * m.width || abs(dot(beside, sides.y)) > 0.5 * m.height {
        return NOTHING_SEEN;
    }
    let pdf = spherical_rectangle_pdf(rectangle_from(light, m, p, sides), l * distance);
    return LightSeen(vec3(light.intensity), pdf, distance);
}
