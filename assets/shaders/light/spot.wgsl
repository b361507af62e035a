// Spotlight: a point light within a cone.
fn incident_spot(light: Light, m: SpotParameters, p: vec3<f32>) -> Incident {
    let to_light = light.position - p;
    let l = unit_or_zero(to_light);
    let profile = cone(light.direction, -l, vec2(m.outer_rise, m.inner_rise));
    return Incident(l, vec3(light.intensity * profile * inverse_square(to_light)), 0u);
}
