// The inside of solid bodies: what the functions of the models at the end of this file have in common.

// The functions that calculate it, by model: refractive index, coefficient of dispersion, width of facets, absorption.
const INTERIORS = {};
// Narrower facets count as smooth.
const LEAST_ALPHA = Math.fround(0.001);

// The coefficient of A. L. Cauchy's equation in µm², by the reciprocal of the Abbe number: over the difference of 1/λ² at
// Fraunhofer's lines F and C.
const cauchyOf = (n, dispersion) =>
  dispersion > 0 ? ((n - 1) * dispersion) / (0.48613 ** -2 - 0.65628 ** -2) : 0;

// Absorption per metre where light has a colour after a distance (A. Beer 1852).
const absorptionOf = (colour, distance) =>
  colour.map((c) => (distance > 0 ? -Math.log(Math.min(1, Math.max(1e-6, c))) / distance : 0));

// The curves of a model beside its albedo, by name, as lists of quadruples.
function curvesIn(model, bytes) {
  const numbers = new Float32Array(bytes.slice().buffer);
  const curves = {};
  let at = model.harmonics * NODES;
  for (const { name, length } of model.curves) {
    curves[name] = Array.from({ length }, (_, i) => numbers.subarray(4 * (at + i), 4 * (at + i) + 4));
    at += length;
  }
  return curves;
}

