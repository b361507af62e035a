// The scene: objects with their values, and what shaders need of them.

class Thing {
  constructor(data, scene) {
    Object.assign(this, data);
    this.scene = scene;
    this.model = scene.models[data.model];
    this.initialValues = structuredClone(data.values);
    this.initialInterior = data.interior === null ? new Uint8Array(0) : scene.blocks[data.interior];
    this.initialCurve = data.curve === null ? new Uint8Array(0) : scene.blocks[data.curve];
    this.uniforms = {
      placement: new Uniform(bytesOfFloats(data.matrix)),
      parameters: new Uniform(this.packed(this.values)),
      albedo_curve: new Uniform(this.initialCurve),
      // Knobs do not change them: any lobes give the right picture, with more noise or less.
      material_lobes: new Uniform(data.lobes === null ? new Uint8Array(0) : scene.blocks[data.lobes]),
      interior: new Uniform(this.packedInterior(this.values, this.initialCurve)),
      shading_values: new Uniform(this.packedShading()),
    };
  }

  // The shading model that draws it.
  get shadingInUse() {
    return this.scene.shading ?? this.shading;
  }

  get program() {
    return this.model.programs[this.shadingInUse];
  }

  get parameters() {
    const shading = this.scene.shadings[this.shadingInUse].parameters;
    const known = new Set(this.model.parameters.map((p) => p.name));
    // Hidden ones would need another shader.
    const own = this.model.parameters.filter((p) => !p.hidden);
    return [...own, ...shading.filter((p) => !known.has(p.name))];
  }

  value(parameter) {
    return this.values[parameter.name] ?? parameter.default;
  }

  packed(values) {
    return packed(this.model.parameters, this.model.size, values, this.scene.encoding);
  }

  packedShading() {
    const shading = this.scene.shadings[this.shadingInUse];
    return packed(shading.parameters, shading.size, this.values, this.scene.encoding);
  }

  // What light meets at the boundary of a solid body, and inside: the program's until a knob moves. Faceted shading
  // has the normals of polygons.
  packedInterior(values, curve) {
    const { model, initialInterior, program } = this;
    const numbers = new Float32Array(initialInterior.slice().buffer);
    if (numbers.length === 0) return initialInterior;
    if (this.isChanged && INTERIORS[model.id]) {
      const parameters = numbersOf(model.parameters, this.packed(values), {});
      const [n, b, alpha, ...absorption] = INTERIORS[model.id](parameters, curvesIn(model, curve));
      numbers.set([n, b, alpha, 0, ...absorption]);
    }
    numbers[3] = program.faceted ? 1 : 0;
    return new Uint8Array(numbers.buffer);
  }

  get isChanged() {
    return JSON.stringify(this.values) !== JSON.stringify(this.initialValues);
  }

  reset() {
    this.values = structuredClone(this.initialValues);
  }
}

// What all views of a scene have in common.
class Shared {
  constructor(data, meshBytes) {
    this.shadings = data.shadings;
    this.blocks = data.blocks.map(bytesOf);
    this.common = this.blocks.map((bytes) => new Uniform(bytes));
    this.meshes = data.meshes.map((header) => new Mesh(header, meshBytes));
    this.texts = data.texts;
  }
}

// One view of the scene.
class Scene {
  constructor(data, shared) {
    this.blocks = shared.blocks;
    Object.assign(this, {
      letter: data.letter,
      name: data.name,
      shadings: shared.shadings,
      models: data.models,
      encoding: data.encoding,
      background: data.background,
      // Of CSS; null for one colour.
      gradient: data.gradient,
      lightSamples: data.lightSamples,
      slow: data.slow,
      exposure: data.exposure,
      initialExposure: data.exposure,
      observer: data.observer,
      // The shading model of all objects; null while each has its own.
      shading: null,
    });
    this.common = shared.common;
    const text = (parts) => parts.map((i) => shared.texts[i]).join('');
    const joined = (shader) => {
      shader.wgsl = text(shader.wgsl);
      for (const stage of shader.glsl) stage.text = text(stage.text);
    };
    for (const model of this.models) {
      for (const program of model.programs) {
        joined(program);
        if (program.albedo) joined(program.albedo);
      }
    }
    this.meshes = shared.meshes;
    this.things = data.objects.map((object) => new Thing(object, this));
    const shadings = new Set(this.things.map((thing) => thing.shading));
    this.mixed = shadings.size > 1;
    if (!this.mixed) [this.shading] = shadings;
    this.view = new Uniform(new Uint8Array(80));
  }

  // What clears the picture: nothing where the browser paints a gradient behind it.
  get clear() {
    return this.gradient ? [0, 0, 0, 0] : [...this.background, 1];
  }

  get centre() {
    const places = this.things.map((thing) => thing.matrix.slice(12, 15));
    return scale(places.reduce(add), 1 / places.length);
  }

  setShading(shading) {
    this.shading = shading;
    for (const thing of this.things) {
      thing.uniforms.shading_values.set(thing.packedShading());
      thing.uniforms.interior.set(thing.packedInterior(thing.values, thing.uniforms.albedo_curve.bytes));
    }
  }

  // What renderers draw: a program, the vertices and the uniforms of each object.
  get drawings() {
    return this.things.map((thing) => {
      const program = thing.program;
      const uniforms = program.uniforms.map(({ binding, name, size, block }) => {
        const own = name === 'view' ? this.view : thing.uniforms[name];
        return { binding, name, size, uniform: block === null ? own : this.common[block] };
      });
      return { thing, program, uniforms, mesh: this.meshes[thing.mesh], kind: program.faces ? 'faces' : 'shared' };
    });
  }
}

