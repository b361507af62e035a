// Light that is absorbed along its way, the twin of src/optics/absorption.rs.

// σ per metre of a medium in which light has this colour after a distance in metres: P. Bouguer (1729), A. Beer (1852).
fn absorption_coefficient(colour: vec3<f32>, distance: f32) -> vec3<f32> {
    if distance <= 0.0 {
        return vec3(0.0);
    }
    return -log(clamp(colour, vec3(1e-6), vec3(1.0))) / max(distance, 1e-35);
}

// What is left after a way in metres.
fn absorption_left(sigma: vec3<f32>, way: f32) -> vec3<f32> {
    return exp(-sigma * max(way, 0.0));
}
