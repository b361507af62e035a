// Point light: I(p) = I / d².
fn incident_point(light: Light, p: vec3<f32>) -> Incident {
    let to_light = light.position - p;
    return Incident(unit_or_zero(to_light), vec3(light.intensity * inverse_square(to_light)), 0u);
}
