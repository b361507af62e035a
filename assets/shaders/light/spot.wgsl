// Spotlight: a point light within a cone. parameters: cone angle (degrees), penumbra (0–1).
fn incident_spot(light: Light, p: vec3<f32>) -> Incident {
    let to_light = light.position - p;
    let l = unit_or_zero(to_light);
    let profile = cone(dot(light.direction, -l), light.parameters.x, light.parameters.y);
    return Incident(l, light.intensity * profile * inverse_square(to_light), 0u);
}
