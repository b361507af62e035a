// The albedo curve of a model whose parameters changed: the GPU integrates the model's own response (the shaders
// `albedo`), as the program does on the CPU for the values in this file.

const NODES = 16;
// The functions that calculate the further curves of models, by id: those of the models in this file stand at its end.
const CURVES = {};

// The cubic of Catmull and Rom (1974) over the cube root of μ, continued in a straight line at both ends.
function curveAt(nodes, mu) {
  const x = Math.cbrt(Math.min(1, Math.max(0, mu))) * (NODES - 1);
  const i = Math.min(Math.floor(x), NODES - 2);
  const f = x - i;
  const [b, c] = [nodes[i], nodes[i + 1]];
  const a = i > 0 ? nodes[i - 1] : 2 * b - c;
  const d = i < NODES - 2 ? nodes[i + 2] : 2 * c - b;
  const value = b + 0.5 * f * (c - a + f * (2 * a - 5 * b + 4 * c - d + f * (3 * (b - c) + d - a)));
  return Math.min(1, Math.max(0, value));
}

// 2 ∫ E μ dμ = 6 ∫ E x⁵ dx with x³ = μ.
function averageOf(nodes) {
  const n = 960;
  let sum = 0;
  for (let k = 0; k < n; k++) {
    const x = (k + 0.5) / n;
    sum += curveAt(nodes, x ** 3) * 6 * x ** 5;
  }
  return sum / n;
}

// The coefficients of 1, cos 2φ and cos 4φ at a node, from the albedos at 0°, 45° and 90°.
function harmonicsOf(rows, harmonics, node, channel) {
  const [e0, e45, e90] = [0, 1, 2].map((row) => rows[4 * (NODES * row + node) + channel]);
  if (harmonics === 1) return [e0];
  return [0.25 * (e0 + 2 * e45 + e90), 0.5 * (e0 - e90), 0.25 * (e0 - 2 * e45 + e90)];
}

// The numbers of a packed struct of parameters by name, colours as linear light; `defaults` for those that it lacks.
function numbersOf(parameters, bytes, defaults) {
  const view = new DataView(bytes.buffer, bytes.byteOffset);
  const numbers = { ...defaults };
  for (const p of parameters) {
    const at = (i) => view.getFloat32(p.at + 4 * i, true);
    if (p.options) numbers[p.name] = view.getUint32(p.at, true);
    else numbers[p.name] = Array.isArray(p.default) ? p.default.map((_, i) => at(i)) : at(0);
  }
  return numbers;
}

// True if the pictures of an object depend on its curve.
const readsCurve = ({ model, program }) =>
  program.albedo !== null && (model.albedo || model.lobe !== null || model.twin !== null);

// The bytes of the curve of an object with these values.
async function curveOf(renderer, thing, values) {
  const { model, program } = thing;
  const count = model.harmonics * NODES;
  // Behind the harmonics the curves that the model has beside them, and then the mean of the lobe.
  const size = count + model.curves.reduce((sum, { length }) => sum + length, 0);
  const curve = new Float32Array(4 * size + 4);
  const evaluate = (parameters) =>
    renderer.albedo(program.albedo, { parameters, albedo_curve: new Uint8Array(curve.buffer) });
  if (model.twin) {
    const { defaults, table } = model.twin;
    const bytes = thing.scene.blocks[table];
    const numbers = numbersOf(model.parameters, thing.packed(values), defaults);
    const made = CURVES[model.twin.of](numbers, new Float32Array(bytes.slice().buffer));
    let at = count;
    for (const { name, length } of model.curves) {
      made[name].forEach((quadruple, i) => curve.set(quadruple, 4 * (at + i)));
      at += length;
    }
  }
  if (model.lobe) {
    const rows = await evaluate(thing.packed({ ...values, ...model.lobe }));
    const nodes = Array.from({ length: NODES }, (_, i) => harmonicsOf(rows, model.harmonics, i, 0)[0]);
    nodes.forEach((node, i) => (curve[4 * i + 3] = node));
    curve[4 * size] = averageOf(nodes);
  } else {
    for (let i = 0; i < NODES; i++) curve[4 * i + 3] = 1;
    curve[4 * size] = 1;
  }
  if (model.albedo) {
    const rows = await evaluate(thing.packed(values));
    for (let i = 0; i < NODES; i++) {
      for (let channel = 0; channel < 3; channel++) {
        harmonicsOf(rows, model.harmonics, i, channel).forEach((value, harmonic) => {
          curve[4 * (NODES * harmonic + i) + channel] = value;
        });
      }
    }
  }
  return new Uint8Array(curve.buffer);
}

