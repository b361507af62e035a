// Light with extent: the integral of a model's answer over the directions that lights fill, by samples of the lights and of the
// model's lobes, weighted by the power heuristic; the twin of `src/reference/extended.rs`. The model is called in one place, as
// each call would stand in the shader in full.

// What arrives from a direction of the lobes from all lights with extent.
fn from_lobes(position: vec3<f32>, v: vec3<f32>, frame: Frame, index: u32, count: u32) -> LightSample {
    let local = lobes_sample(sequence_point(sample_seed, 0u, index), v);
    let l = frame.t * local.x + frame.b * local.y + frame.n * local.z;
    let pdf = lobes_pdf(local, v);
    var sum = vec3(0.0);
    if counts(local.z) && pdf > 0.0 {
        for (var i = 0u; i < count; i++) {
            let light = light_at(i);
            if has_extent(light.light_type) {
                let seen = seen_light(light, position, l);
                sum += seen.radiance * light.colour * power_heuristic(pdf, seen.pdf);
            }
        }
    }
    return LightSample(l, sum, pdf);
}

// What arrives from a direction to a light with extent.
fn from_light(position: vec3<f32>, v: vec3<f32>, frame: Frame, index: u32, i: u32) -> LightSample {
    let light = light_at(i);
    if !has_extent(light.light_type) {
        return LightSample(frame.n, vec3(0.0), 0.0);
    }
    let chosen = sample_light(light, position, sequence_point(sample_seed, i + 1u, index));
    let local = to_local(frame, chosen.l);
    if !(chosen.pdf > 0.0 && counts(local.z)) {
        return LightSample(frame.n, vec3(0.0), 0.0);
    }
    let weight = power_heuristic(chosen.pdf, lobes_pdf(local, v));
    return LightSample(chosen.l, chosen.radiance * light.colour * weight, chosen.pdf);
}

fn extended(position: vec3<f32>, view_direction: vec3<f32>, frame: Frame) -> vec3<f32> {
    var own = frame;
    if lobes_are_isotropic() {
        own = frame_from_normal(frame.n);
    }
    let v = lobe_view(to_local(own, view_direction));
    let count = min(illumination.count, MAX_LIGHTS);
    let selection = illumination.terms;
    let samples = max(illumination.sample_count, 1u);
    var colour = vec3(0.0);
    // In each sample every light has its turn, after the lobes.
    let turns = count + 1u;
    for (var i = 0u; i < samples * turns; i++) {
        let index = illumination.first_sample + i / turns;
        let turn = i % turns;
        var chosen: LightSample;
        if turn == count {
            chosen = from_lobes(position, v, own, index, count);
        } else {
            chosen = from_light(position, v, own, index, turn);
        }
        if any(chosen.radiance != vec3(0.0)) {
            let terms = response(chosen.l, view_direction, frame, parameters);
            colour += select_terms(terms, on_side(selection, dot(frame.n, chosen.l))) * (chosen.radiance / chosen.pdf);
        }
    }
    return colour / f32(samples) + unspread(position, view_direction, frame, selection);
}
