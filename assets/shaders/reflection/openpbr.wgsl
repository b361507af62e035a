// OpenPBR Surface 1.1, without volumes that scatter light. What depends on the parameters alone, and the albedos of the
// boundaries, are calculated once per material: value_prepared(i), curve_boundaries(mu), curve_fuzz(mu). Light passes through
// surfaces that are drawn with LIGHT_PASSES alone: through a thin sheet here, through a body in inside.wgsl.

// D G / (4 (N·L)(N·V)) in the local frame.
fn openpbr_facets(h: vec3<f32>, l: vec3<f32>, v: vec3<f32>, alpha: vec2<f32>) -> f32 {
    return ggx(h, alpha) * separable(l.z, v.z, smith_ggx(l, alpha), smith_ggx(v, alpha));
}

// The smallest cosine that is told from 0.
const OPENPBR_GRAZING: f32 = 1e-9;

// The fraction of light that passes the coat once.
fn openpbr_through(mu: f32, m: Parameters) -> vec3<f32> {
    let inside = sqrt(max(1.0 - (1.0 - mu * mu) / (m.coat_ior * m.coat_ior), 1e-4));
    return mix(vec3(1.0), pow(max(m.coat_colour, vec3(1e-9)), vec3(0.5 / inside)), m.coat_weight);
}

// The part of the dielectric base that is a thin sheet.
fn openpbr_sheet_part(m: Parameters) -> f32 {
    return select(0.0, m.transmission_weight, m.geometry_thin_walled != 0u);
}

// The reflectance of the dielectric boundary with its film.
fn openpbr_boundary(cosine: f32, m: Parameters) -> vec3<f32> {
    let of_base = value_prepared(0u);
    var reflected = vec3(dielectric(of_base.z, cosine));
    let channels = select(0u, 3u, of_base.w > 0.0);
    for (var i = 0u; i < channels; i += 1u) {
        let turns = m.thin_film_thickness / vec3(0.62, 0.54, 0.45)[i];
        let covered = thin_film(of_base.x, m.thin_film_ior, of_base.y, 0.0, turns, cosine);
        reflected[i] = mix(reflected[i], covered, of_base.w);
    }
    return reflected;
}

// What a thin sheet between two boundaries reflects and transmits.
fn openpbr_sheet(boundary: vec3<f32>, cosine: f32, m: Parameters) -> Slab {
    let inside = refracted_cosine(cosine, value_prepared(0u).y);
    return slab(boundary, oblique(m.transmission_colour, inside));
}

// The part of the light from below the base that passes the layers above it, towards a viewer; with the albedos of coat and
// fuzz.
fn openpbr_above(mu: f32, coat: f32, fuzz: f32, m: Parameters) -> vec3<f32> {
    let passes = max(1.0 - m.fuzz_weight * fuzz, 0.0);
    if m.coat_weight > 0.0 {
        return openpbr_through(mu, m) * value_prepared(4u).rgb * (max(1.0 - m.coat_weight * coat, 0.0) * passes);
    }
    return vec3(passes);
}

// A smooth sheet lets light go straight on.
fn sharp(i: u32, v: vec3<f32>, frame: Frame, m: Parameters) -> Sharp {
    let mu = dot(frame.n, v);
    let share = (1.0 - m.metallic) * openpbr_sheet_part(m);
    if i != 1u || mu <= 0.0 || share <= 0.0 || value_prepared(2u).w > MINIMUM_ALPHA {
        return Sharp(-v, vec3(0.0));
    }
    let pane = openpbr_sheet(openpbr_boundary(mu, m), mu, m);
    return Sharp(-v, share * openpbr_above(mu, curve_boundaries(mu).z, curve_fuzz(mu).z, m) * pane.transmittance);
}

// The part of the light from within a body that enters it here and leaves it elsewhere, over that without coat and film.
fn entering(v: vec3<f32>, frame: Frame, m: Parameters) -> vec3<f32> {
    let mu = max(dot(frame.n, v), OPENPBR_GRAZING);
    let rough = value_prepared(2u).w > MINIMUM_ALPHA;
    let ior = clamp(value_prepared(0u).y, 0.1, 10.0);
    // Light that would be reflected totally at a cosine of 2/3 enters along the normal.
    let scattered = select(1.0, 2.0 / 3.0, ior * ior > 5.0 / 9.0);
    let at = select(mu, scattered, rough);
    let bare = max(1.0 - dielectric(ior, at), 1e-6);
    let entered = (vec3(1.0) - openpbr_boundary(at, m)) / bare;
    var left = vec3(1.0);
    if m.coat_weight > 0.0 {
        left = openpbr_through(mu, m);
    }
    let tint = select(m.transmission_colour, vec3(1.0), m.transmission_depth > 0.0);
    let above = openpbr_above(mu, curve_boundaries(mu).z, curve_fuzz(mu).z, m);
    return (1.0 - m.metallic) * m.transmission_weight * above * entered * left * tint * tint;
}

fn response(light: vec3<f32>, view: vec3<f32>, frame: Frame, m: Parameters) -> Terms {
    var l = to_local(frame, light);
    var v = to_local(frame, view);
    var behind = false;
    if LIGHT_PASSES {
        // From behind a thin sheet, mirrored to the side of the viewer.
        behind = l.z < 0.0 && openpbr_sheet_part(m) > 0.0;
        l.z = select(l.z, -l.z, behind);
    }
    if min(l.z, v.z) <= 0.0 {
        return Terms(vec3(0.0), vec3(0.0), vec3(0.0));
    }
    // At more grazing angles the quotients would leave the range of f32.
    l.z = max(l.z, OPENPBR_GRAZING);
    v.z = max(v.z, OPENPBR_GRAZING);
    let h = half_vector(l, v);
    let cos_d = 0.5 * length(l + v);
    // n_a, n_b, the ratio at the boundary, the share of the film.
    let of_base = value_prepared(0u);
    let alphas = value_prepared(1u);
    let tint = value_prepared(2u);
    let mean = value_prepared(3u).rgb;
    let f0 = m.base_weight * m.base_colour;

    let c = min(cos_d, 1.0);
    let d = 1.0 - c;
    var glass = vec3(dielectric(of_base.z, cos_d));
    var metal = clamp(schlick(f0, c) - tint.rgb * (c * d * d * d * d * d * d), vec3(0.0), vec3(1.0));
    // Films: three channels of the boundary, then three of metal; a loop, which costs nothing where there are none.
    let first = select(0u, 3u, m.metallic >= 1.0);
    let last = select(select(6u, 3u, m.metallic <= 0.0), 0u, of_base.w <= 0.0);
    for (var i = first; i < last; i += 1u) {
        let channel = i % 3u;
        let turns = m.thin_film_thickness / vec3(0.62, 0.54, 0.45)[channel];
        let below = select(vec2(of_base.y, 0.0), vec2(value_prepared(5u)[channel], value_prepared(6u)[channel]), i >= 3u);
        let covered = thin_film(of_base.x, m.thin_film_ior, below.x, below.y, turns, c);
        if i < 3u {
            glass[channel] = mix(glass[channel], covered, of_base.w);
        } else {
            metal[channel] = mix(metal[channel], covered, of_base.w);
        }
    }
    let at_l = curve_boundaries(l.z);
    let at_v = curve_boundaries(v.z);
    let average = mean_boundaries();
    let missing = max(vec3(1.0) - at_v.xyz, vec3(0.0));
    let missing_l = max(vec2(1.0) - at_l.xy, vec2(0.0));
    let rest = max(vec2(1.0) - average.xy, vec2(1e-6));
    let coupled = missing_l * missing.xy / rest;

    let single = PI * l.z * openpbr_facets(h, l, v, alphas.xy);
    var scattered = vec3(0.0);
    if LIGHT_PASSES {
        let part = openpbr_sheet_part(m);
        if part > 0.0 {
            let share = (1.0 - m.metallic) * part;
            let pane = openpbr_sheet(glass, cos_d, m);
            var again = Slab(vec3(0.0), vec3(0.0));
            if tint.w >= 0.0016 {
                again = openpbr_sheet(openpbr_boundary(2.0 / 3.0, m), 2.0 / 3.0, m);
            }
            let bounced = min(coupled.x * l.z, 1.0);
            if behind {
                let straight = select(0.0, single, tint.w > MINIMUM_ALPHA);
                let passed = straight * pane.transmittance + bounced * again.transmittance;
                return terms_through(share * openpbr_above(v.z, at_v.z, curve_fuzz(v.z).z, m) * passed);
            }
            glass = mix(glass, pane.reflectance, part);
            scattered = share * m.specular_colour * bounced * again.reflectance;
        }
    }
    let once = (1.0 - m.metallic) * m.specular_colour * glass
        + m.metallic * min(m.specular_strength * metal, vec3(1.0));
    var specular = single * once + scattered;
    if tint.w >= 0.0016 {
        specular += m.metallic * min(coupled.x * l.z, 1.0) * min(m.specular_strength * mean, vec3(1.0)) * mean;
    }
    let rho = (1.0 - m.metallic) * f0;
    var diffuse = rho * eon(l.z, v.z, dot(l, v), m.base_diffuse_roughness, rho) * (coupled.y * l.z);
    if LIGHT_PASSES {
        diffuse *= 1.0 - m.transmission_weight;
    }

    if m.coat_weight > 0.0 {
        let below = openpbr_through(l.z, m) * openpbr_through(v.z, m) * value_prepared(4u).rgb
            * max(1.0 - m.coat_weight * at_v.z, 0.0);
        let top = PI * l.z * openpbr_facets(h, l, v, alphas.zw) * dielectric(m.coat_ior, cos_d);
        diffuse *= below;
        specular = specular * below + m.coat_weight * top;
    }
    if m.fuzz_weight > 0.0 {
        let fuzz = curve_fuzz(v.z);
        let below = max(1.0 - m.fuzz_weight * fuzz.z, 0.0);
        // L in the frame whose x–z plane holds V.
        let across = dot(v.xy, v.xy);
        let azimuth = select(vec2(1.0, 0.0), v.xy * inverseSqrt(max(across, 1e-37)), across > 0.0);
        let x = dot(azimuth, l.xy);
        let y = azimuth.x * l.y - azimuth.y * l.x;
        let w = vec3(fuzz.x * x + fuzz.y * l.z, fuzz.x * y, l.z);
        let w2 = dot(w, w);
        let lobe = fuzz.z * fuzz.x * fuzz.x / max(w2 * w2, 1e-30);
        diffuse *= below;
        specular = specular * below + m.fuzz_weight * lobe * l.z * m.fuzz_colour;
    }
    return Terms(vec3(0.0), diffuse, specular);
}
