// Sunlight through a blind: every other stripe lies behind a slat.
fn incident_blind(light: Light, m: BlindParameters, p: vec3<f32>) -> Incident {
    let across = unit_or_zero(vec3(0.0, 1.0, 0.0) - light.direction.y * light.direction);
    let open = fract(m.slats * dot(p, across)) < 0.5;
    return Incident(-light.direction, light.intensity * select(m.tint, vec3(1.0), open), 0u);
}
