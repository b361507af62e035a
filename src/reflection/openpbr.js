// The curves of OpenPBR for web pages, whose knobs change what the program calculated: the twin of `Prepared`,
// `boundaries_of` and `fuzz_row` in openpbr.rs. `m` has the parameters, colours as linear light; `table` is that of the
// fuzz. Each curve is a list of quadruples; `averageOf` and `NODES` are the page's.
(m, table) => {
  const mix = (a, b, t) => a * (1 - t) + b * t;
  const unit = (x) => Math.min(1, Math.max(0, x));
  const rgb = (f) => [0, 1, 2].map(f);
  // Fresnel's reflectance of a dielectric for unpolarised light.
  const dielectric = (n, cosine) => {
    const c = unit(cosine);
    const g2 = (n - 1) * (n + 1) + c * c;
    if (g2 <= 0) return 1;
    const g = Math.sqrt(g2);
    return 0.5 * (((c - g) / (c + g)) ** 2 + ((n * n * c - g) / (n * n * c + g)) ** 2);
  };
  const schlick = (f0, c) => f0 + (1 - f0) * (1 - unit(c)) ** 5;
  // 2 ∫ F μ dμ by Simpson's rule over √μ.
  const meanFresnel = (ratio) => {
    if (ratio < 1) return 1 - ratio * ratio * (1 - meanFresnel(1 / ratio));
    let sum = 0;
    for (let i = 0; i <= 128; i++) {
      const x = i / 128;
      sum += (i === 0 || i === 128 ? 1 : 2 + 2 * (i % 2)) * 4 * x ** 3 * dielectric(ratio, x * x);
    }
    return sum / 384;
  };
  const scaledRatio = (ratio, factor) => {
    const r = (ratio - 1) / (ratio + 1);
    const e = Math.sqrt(Math.min(0.9999, factor * r * r)) * (r < 0 ? -1 : 1);
    return (1 + e) / (1 - e);
  };
  const LEAST = 0.001;
  const alphas = (roughness, anisotropy) => {
    const alpha = roughness * roughness;
    const aspect = 1 - anisotropy;
    const along = alpha * Math.sqrt(2 / (1 + aspect * aspect));
    return [Math.max(alpha, LEAST), [Math.max(along, LEAST), Math.max(aspect * along, LEAST)]];
  };

  // What depends on the parameters alone.
  const cover = m.coat_weight;
  const above = mix(1, m.coat_ior, cover);
  const below = above * scaledRatio(m.specular_ior / above, m.specular_strength);
  const ratio = cover > 0 && above > below && below >= 1 ? above / below : below / above;
  const lifted = (r, by, weight) => mix(r, Math.min(1, r ** 4 + by) ** 0.25, weight);
  const fibres = (0.005 * (m.fuzz_colour[0] + m.fuzz_colour[1] + m.fuzz_colour[2]) / 3) * m.fuzz_roughness ** 5;
  const coatRoughness = lifted(m.coat_roughness, fibres, m.fuzz_weight);
  const spread = m.coat_ior < 1 ? 1 - m.coat_ior : 1 - 1 / m.coat_ior;
  const roughness = lifted(m.roughness, spread * coatRoughness ** 4, cover);
  const [alpha, base] = alphas(roughness, m.specular_roughness_anisotropy);
  const [coatAlpha, coat] = alphas(coatRoughness, m.coat_roughness_anisotropy);
  const f0 = rgb((i) => m.base_weight * m.base_colour[i]);
  const bump = (6 / 7) ** 6 / 7;
  const tint = rgb((i) => ((1 - m.specular_colour[i]) * schlick(f0[i], 1 / 7)) / bump);
  const mean = rgb((i) => unit(f0[i] + (1 - f0[i]) / 21 - tint[i] / 126));
  const reflected = meanFresnel(ratio);
  const coatReflected = meanFresnel(m.coat_ior);
  const fromInside = 1 - (1 - coatReflected) / (m.coat_ior * m.coat_ior);
  const scattered = mix(1, roughness, mix(reflected, 1, m.metallic));
  const k = Math.min(0.9999, Math.max(0, mix(coatReflected, fromInside, scattered)));
  const darkening = rgb((i) => {
    const body = mix(f0[i] + (1 - f0[i]) * reflected, 1, m.transmission_weight);
    const albedo = Math.min(1, m.metallic * m.specular_strength * mean[i] + (1 - m.metallic) * body);
    return 1 + ((1 - k) / (1 - albedo * k) - 1) * (cover * m.coat_darkening);
  });
  const t = unit(m.thin_film_thickness / 0.03);
  // n and k of a metal under a film (O. Gulbrandsen 2014).
  const metal = rgb((i) => {
    const r = Math.min(0.99, f0[i]);
    const root = Math.sqrt(r);
    const edge = m.specular_colour[i];
    const n = (edge * (1 - r)) / (1 + r) + ((1 - edge) * (1 + root)) / (1 - root);
    return [n, Math.sqrt(Math.max(0, ((n + 1) ** 2 * r - (n - 1) ** 2) / (1 - r)))];
  });
  const prepared = [
    [above, below, ratio, m.thin_film_weight * t * t * (3 - 2 * t)],
    [...base, ...coat],
    [...tint, alpha],
    [...mean, 0],
    [...darkening, 0],
    [...metal.map((index) => index[0]), 0],
    [...metal.map((index) => index[1]), 0],
  ];

  // The albedo of an isotropic lobe of GGX with separable masking, alone and times a boundary, at μ: over half vectors, as
  // in albedo.wgsl, one side of the plane of incidence.
  const albedos = (a, boundary, mu) => {
    const [turns, rings] = [48, 40];
    const sinV = Math.sqrt(Math.max(0, 1 - mu * mu));
    const lambda = (z) => {
      const q = a * a * (1 - z * z);
      return (0.5 * q) / Math.max(1e-38, Math.sqrt(z * z + q) + z);
    };
    const seen = mu + lambda(mu);
    let [lobe, partly] = [0, 0];
    for (let turn = 0; turn < turns; turn++) {
      const cosPhi = Math.cos(((turn + 0.5) * Math.PI) / turns);
      const most = 0.5 * (0.5 * Math.PI + Math.atan2(sinV * cosPhi, mu));
      for (let ring = 0; ring < rings; ring++) {
        const u = (ring + 0.5) / rings;
        const s = u * u * (3 - 2 * u);
        const theta = most * s ** 4;
        const [sin, cos] = [Math.sin(theta), Math.cos(theta)];
        const across = sinV * sin * cosPhi + mu * cos;
        const lz = 2 * across * cos - mu;
        if (lz <= 0 || across <= 0) continue;
        const q = (sin * sin) / (a * a) + cos * cos;
        // π N·L times D V, and the area of half vectors.
        const response = (lz / (a * a * q * q)) * (0.25 / ((lz + lambda(lz)) * seen));
        const area = (2 * Math.PI * sin * most * 4 * s ** 3 * 4 * across * 6 * u * (1 - u)) / (turns * rings);
        lobe += (response * area) / Math.PI;
        partly += ((response * area) / Math.PI) * dielectric(boundary, across);
      }
    }
    return [lobe, partly];
  };
  const mus = Array.from({ length: NODES }, (_, i) => Math.max(1e-5, (i / (NODES - 1)) ** 3));
  const ofBase = mus.map((mu) => albedos(alpha, ratio, mu));
  const ofCoat = mus.map((mu) => (cover > 0 ? albedos(coatAlpha, m.coat_ior, mu)[1] : 1));
  const boundaries = mus.map((_, i) => [...ofBase[i], ofCoat[i], 1]);
  boundaries.push([0, 1, 2, 3].map((i) => averageOf(boundaries.map((node) => node[i]))));

  // The row of the fuzz at its roughness, and the mean of the lines through it.
  const nodes = Math.sqrt(table.length / 4);
  const x = unit(m.fuzz_roughness) * (nodes - 1);
  const row = Math.min(Math.floor(x), nodes - 2);
  const number = (r, j, i) => table[4 * (nodes * r + j) + i];
  const fuzz = Array.from({ length: nodes }, (_, j) =>
    [0, 1, 2, 3].map((i) => mix(number(row, j, i), number(row + 1, j, i), x - row)),
  );
  const step = 1 / (nodes - 1);
  const piece = (j, i) => step * (fuzz[j][i] * (j * step + step / 3) + fuzz[j + 1][i] * (j * step + (2 * step) / 3));
  const means = [0, 0, 0, 0];
  for (let j = 0; j < nodes - 1; j++) means.forEach((_, i) => (means[i] += piece(j, i)));
  fuzz.push(means);

  return { boundaries, fuzz, prepared };
}
