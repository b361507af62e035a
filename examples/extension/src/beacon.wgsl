// A point light that shines in another colour downwards.
fn incident_beacon(light: Light, m: BeaconParameters, p: vec3<f32>) -> Incident {
    let to_light = light.position - p;
    let l = unit_or_zero(to_light);
    let colour = mix(vec3(1.0), m.below, saturate(0.5 + 0.5 * m.blend * l.y));
    return Incident(l, light.intensity / max(dot(to_light, to_light), 1e-6) * colour, 0u);
}
