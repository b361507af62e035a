// Ambient light: the same from every direction.
fn incident_ambient(light: Light, p: vec3<f32>) -> Incident {
    return Incident(vec3(0.0), vec3(light.intensity), 1u);
}
