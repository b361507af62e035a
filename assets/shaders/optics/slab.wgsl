// A thin plate, the twin of src/optics/slab.rs.

struct Slab {
    reflectance: vec3<f32>,
    transmittance: vec3<f32>,
}

// All orders of reflection between two boundaries of reflectance r; of the light within, a is left after each crossing
// (G. G. Stokes 1862).
fn slab(r: vec3<f32>, a: vec3<f32>) -> Slab {
    let kept = clamp(a, vec3(0.0), vec3(1.0));
    let back = clamp(r, vec3(0.0), vec3(1.0));
    let through = vec3(1.0) - back;
    let less = max(through + back * (vec3(1.0) - kept), vec3(1.2e-38));
    let transmittance = through * through * kept / (less * (vec3(1.0) + back * kept));
    return Slab(back + back * kept * transmittance, transmittance);
}

// What is left after crossing at an angle, given what is left along the normal: the way is longer by 1/cos θ.
fn oblique(a: vec3<f32>, cosine: f32) -> vec3<f32> {
    let longer = 1.0 / clamp(cosine, 1e-4, 1.0);
    let kept = min(a, vec3(1.0));
    return vec3(power(kept.x, longer), power(kept.y, longer), power(kept.z, longer));
}
