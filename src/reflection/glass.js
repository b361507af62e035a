// The inside of glass for web pages, whose knobs change what the program calculated: the twin of `interior` in glass.rs. `m`
// has the parameters, colours as linear light.
(m) => {
  const n = m.refractive_index;
  const alpha = m.roughness ** 2;
  const absorption = absorptionOf(m.transmittance_colour, m.distance);
  return [n, cauchyOf(n, m.dispersion), alpha < LEAST_ALPHA ? 0 : alpha, ...absorption];
}
