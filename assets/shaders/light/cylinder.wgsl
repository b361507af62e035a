// Cylinder: the same luminance from every point of its side, by the area of the part that faces the point.
struct CylinderView {
    to_point: vec3<f32>,
    out: vec3<f32>,
    // The distance of the point from the axis; zero from within.
    away: f32,
    half_angle: f32,
    area: f32,
}

fn cylinder_from(light: Light, m: CylinderParameters, p: vec3<f32>) -> CylinderView {
    let to_point = p - light.position;
    let across = to_point - dot(to_point, light.direction) * light.direction;
    let away = length(across);
    if !(away > m.radius) {
        return CylinderView(to_point, across, 0.0, 0.0, 0.0);
    }
    let half_angle = angle_of_cosine(m.radius / away);
    return CylinderView(to_point, across / away, away, half_angle, 2.0 * half_angle * m.radius * m.length);
}

fn sample_cylinder(light: Light, m: CylinderParameters, p: vec3<f32>, u: vec2<f32>) -> LightSample {
    let view = cylinder_from(light, m, p);
    if view.away <= 0.0 {
        return LightSample(vec3(0.0, 1.0, 0.0), vec3(0.0), 0.0);
    }
    let angle = (2.0 * u.x - 1.0) * view.half_angle;
    let normal = view.out * cos(angle) + cross(light.direction, view.out) * sin(angle);
    let at = normal * m.radius + light.direction * ((u.y - 0.5) * m.length) - view.to_point;
    return LightSample(unit_or_zero(at), vec3(light.intensity), area_pdf(at, normal, view.area));
}

fn seen_cylinder(light: Light, m: CylinderParameters, p: vec3<f32>, l: vec3<f32>) -> LightSeen {
    let view = cylinder_from(light, m, p);
    let x = dot(l, view.out);
    let y = dot(l, cross(light.direction, view.out));
    let squared = x * x + y * y;
    let rest = m.radius * m.radius * squared - view.away * view.away * y * y;
    if view.away <= 0.0 || !(rest >= 0.0) || x >= 0.0 {
        return NOTHING_SEEN;
    }
    let distance = max((-view.away * x - sqrt(rest)) / squared, 0.0);
    let at = l * distance;
    let from_middle = view.to_point + at;
    let along = dot(from_middle, light.direction);
    if !(abs(along) <= 0.5 * m.length) {
        return NOTHING_SEEN;
    }
    let normal = (from_middle - along * light.direction) / m.radius;
    return LightSeen(vec3(light.intensity), area_pdf(at, normal, view.area), distance);
}
