// Directional light: one direction and one illuminance everywhere.
fn incident_directional(light: Light, p: vec3<f32>) -> Incident {
    return Incident(-light.direction, vec3(light.intensity), 0u);
}
