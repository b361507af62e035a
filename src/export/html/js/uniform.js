// Bytes for shaders, and how often they changed: renderers copy them when that number is new.

class Uniform {
  constructor(bytes) {
    this.bytes = bytes;
    this.version = 0;
  }

  set(bytes) {
    this.bytes = bytes;
    this.version += 1;
  }
}

const bytesOfFloats = (numbers) => new Uint8Array(new Float32Array(numbers).buffer);

// 8-bit colours as numbers for calculation (IEC 61966-2-1, unless the scene decodes nothing).
function decoded(colour, encoding) {
  return colour.map((c) => {
    const v = c / 255;
    if (encoding === 'off') return v;
    return v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4;
  });
}

// The bytes of a struct of parameters.
function packed(parameters, size, values, encoding) {
  const bytes = new Uint8Array(Math.max(16, 16 * Math.ceil(size / 16)));
  const view = new DataView(bytes.buffer);
  for (const p of parameters) {
    const value = values[p.name] ?? p.default;
    if (p.options) {
      view.setUint32(p.at, p.options.findIndex(([id]) => id === String(value)), true);
    } else if (Array.isArray(value)) {
      const numbers = p.kind === 'colour' ? decoded(value, encoding) : value;
      numbers.forEach((number, i) => view.setFloat32(p.at + 4 * i, number, true));
    } else {
      view.setFloat32(p.at, value, true);
    }
  }
  return bytes;
}

