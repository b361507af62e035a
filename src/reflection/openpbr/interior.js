// The inside of OpenPBR's solid bodies for web pages, whose knobs change what the program calculated: the twin of `inside` in
// openpbr.rs. `m` has the parameters, colours as linear light; `prepared` is the curve of that name.
(m, { prepared }) => {
  const n = Math.min(10, Math.max(0.1, prepared[0][1]));
  const alpha = prepared[2][3];
  const dispersion = m.transmission_dispersion_scale / m.transmission_dispersion_abbe_number;
  const absorption = absorptionOf(m.transmission_colour, m.transmission_depth);
  return [n, cauchyOf(n, dispersion), alpha > LEAST_ALPHA ? alpha : 0, ...absorption];
}
