// Drawing with WebGL 2, where there is no WebGPU. The shaders are those of WebGPU in GLSL; they turn the picture upside
// down, as WebGPU's rows run downwards, and it is turned back when it is copied to the canvas.

class WebGl {
  static label = 'WebGL 2';

  // Null where there is no WebGL 2.
  static async create(canvas, samples) {
    const options = { antialias: false, depth: false, alpha: true, preserveDrawingBuffer: true };
    const gl = canvas.getContext('webgl2', options);
    return gl ? new WebGl(gl, canvas, samples) : null;
  }

  constructor(gl, canvas, samples) {
    this.gl = gl;
    this.samples = Math.min(samples, gl.getParameter(gl.MAX_SAMPLES));
    this.lost = new Promise((lost) => canvas.addEventListener('webglcontextlost', lost, { once: true }));
    this.buffers = new WeakMap();
    this.meshes = new WeakMap();
    this.programs = new WeakMap();
    this.bodies = new WeakMap();
  }

  // At once; `lost` comes later.
  get isLost() {
    return this.gl.isContextLost();
  }

  get largest() {
    return this.gl.getParameter(this.gl.MAX_RENDERBUFFER_SIZE);
  }

  // Begins to compile a program. Asking for the result would wait for it, so all are begun first.
  begin(shader) {
    const { gl } = this;
    if (this.programs.has(shader)) return;
    const program = gl.createProgram();
    const stages = [gl.VERTEX_SHADER, gl.FRAGMENT_SHADER].map((kind, i) => {
      const stage = gl.createShader(kind);
      gl.shaderSource(stage, shader.glsl[i].text);
      gl.compileShader(stage);
      gl.attachShader(program, stage);
      return stage;
    });
    gl.linkProgram(program);
    this.programs.set(shader, { program, stages, finished: false });
  }

  // A program with its uniform blocks in their places.
  programOf(shader) {
    const { gl } = this;
    this.begin(shader);
    const kept = this.programs.get(shader);
    const { program, stages } = kept;
    if (kept.finished) return program;
    if (!gl.getProgramParameter(program, gl.LINK_STATUS) && !gl.isContextLost()) {
      const logs = [...stages.map((stage) => gl.getShaderInfoLog(stage)), gl.getProgramInfoLog(program)];
      throw new Error(`a shader was refused: ${logs.filter(Boolean).join('; ')}`);
    }
    for (const { blocks } of shader.glsl) {
      for (const [binding, name] of blocks) {
        const index = gl.getUniformBlockIndex(program, name);
        if (index !== gl.INVALID_INDEX) gl.uniformBlockBinding(program, index, binding);
      }
    }
    kept.finished = true;
    return program;
  }

  bind(binding, uniform, size) {
    const { gl } = this;
    let kept = this.buffers.get(uniform);
    if (!kept) {
      kept = { buffer: gl.createBuffer(), version: -1 };
      this.buffers.set(uniform, kept);
    }
    gl.bindBufferBase(gl.UNIFORM_BUFFER, binding, kept.buffer);
    if (kept.version === uniform.version) return;
    const bytes = new Uint8Array(Math.max(size, uniform.bytes.length));
    bytes.set(uniform.bytes);
    gl.bufferData(gl.UNIFORM_BUFFER, bytes, gl.DYNAMIC_DRAW);
    kept.version = uniform.version;
  }

  meshOf(mesh, kind) {
    const { gl } = this;
    if (!this.meshes.has(mesh)) this.meshes.set(mesh, {});
    const kept = this.meshes.get(mesh);
    if (!kept[kind]) {
      const { vertices, indices, attributes } = mesh[kind];
      const array = gl.createVertexArray();
      gl.bindVertexArray(array);
      gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
      gl.bufferData(gl.ARRAY_BUFFER, vertices, gl.STATIC_DRAW);
      for (let i = 0; i < attributes; i++) {
        gl.enableVertexAttribArray(i);
        gl.vertexAttribPointer(i, 3, gl.FLOAT, false, 12 * attributes, 12 * i);
      }
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
      gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, indices, gl.STATIC_DRAW);
      kept[kind] = { array, count: indices.length };
    }
    return kept[kind];
  }

  // The texture of a solid body, the only one of its shader: samplers read the first unit unless they are told otherwise.
  bindBody(mesh) {
    const { gl } = this;
    if (!this.bodies.has(mesh)) {
      const texture = gl.createTexture();
      const height = mesh.body.length / (4 * ROWS_ACROSS);
      gl.bindTexture(gl.TEXTURE_2D, texture);
      gl.texImage2D(
        gl.TEXTURE_2D, 0, gl.RGBA32UI, ROWS_ACROSS, height, 0, gl.RGBA_INTEGER, gl.UNSIGNED_INT, mesh.body,
      );
      for (const filter of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) {
        gl.texParameteri(gl.TEXTURE_2D, filter, gl.NEAREST);
      }
      this.bodies.set(mesh, texture);
    }
    gl.bindTexture(gl.TEXTURE_2D, this.bodies.get(mesh));
  }

  targetsFor(width, height) {
    const { gl } = this;
    if (this.width === width && this.height === height) return;
    for (const { frame, buffers } of [this.sampled, this.single].filter(Boolean)) {
      gl.deleteFramebuffer(frame);
      for (const buffer of buffers) gl.deleteRenderbuffer(buffer);
    }
    const target = (samples, parts) => {
      const frame = gl.createFramebuffer();
      gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
      const buffers = parts.map(([attachment, format]) => {
        const buffer = gl.createRenderbuffer();
        gl.bindRenderbuffer(gl.RENDERBUFFER, buffer);
        gl.renderbufferStorageMultisample(gl.RENDERBUFFER, samples, format, width, height);
        gl.framebufferRenderbuffer(gl.FRAMEBUFFER, attachment, gl.RENDERBUFFER, buffer);
        return buffer;
      });
      return { frame, buffers };
    };
    const colour = [gl.COLOR_ATTACHMENT0, gl.RGBA8];
    this.sampled = target(this.samples > 1 ? this.samples : 0, [colour, [gl.DEPTH_ATTACHMENT, gl.DEPTH_COMPONENT32F]]);
    this.single = target(0, [colour]);
    Object.assign(this, { width, height });
  }

  // Draws pieces of drawings into a tile of the picture, after all of it was cleared with `clear`; `show` shows it then.
  draw(scene, { list, tile, clear, show }, width, height) {
    const { gl } = this;
    if (gl.isContextLost()) return;
    this.targetsFor(width, height);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.sampled.frame);
    gl.viewport(0, 0, width, height);
    if (clear) {
      gl.clearColor(...scene.clear);
      gl.clearDepth(0);
      gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    }
    gl.enable(gl.SCISSOR_TEST);
    gl.scissor(...tile);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.GREATER);
    gl.enable(gl.CULL_FACE);
    gl.frontFace(gl.CW);
    for (const { drawing } of list) this.begin(drawing.program);
    for (const { drawing, first, count } of list) {
      gl.useProgram(this.programOf(drawing.program));
      for (const { binding, uniform, size } of drawing.uniforms) this.bind(binding, uniform, size);
      if (drawing.program.body !== null) this.bindBody(drawing.mesh);
      gl.bindVertexArray(this.meshOf(drawing.mesh, drawing.kind).array);
      gl.drawElements(gl.TRIANGLES, Math.min(count, this.countOf(drawing) - first), gl.UNSIGNED_INT, 4 * first);
    }
    gl.bindVertexArray(null);
    gl.disable(gl.SCISSOR_TEST);
    if (show) this.show(width, height);
  }

  show(width, height) {
    const { gl } = this;
    // Samples are joined first: only then can the copy turn the picture round.
    gl.bindFramebuffer(gl.READ_FRAMEBUFFER, this.sampled.frame);
    gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, this.single.frame);
    gl.blitFramebuffer(0, 0, width, height, 0, 0, width, height, gl.COLOR_BUFFER_BIT, gl.NEAREST);
    gl.bindFramebuffer(gl.READ_FRAMEBUFFER, this.single.frame);
    gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, null);
    gl.blitFramebuffer(0, 0, width, height, 0, height, width, 0, gl.COLOR_BUFFER_BIT, gl.NEAREST);
  }

  countOf({ mesh, kind }) {
    return this.meshOf(mesh, kind).count;
  }

  // Waits until everything has been drawn.
  finished() {
    const { gl } = this;
    const fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl.flush();
    return new Promise((done) => {
      const ask = () => {
        if (!gl.isContextLost() && gl.clientWaitSync(fence, 0, 0) === gl.TIMEOUT_EXPIRED) {
          setTimeout(ask, 1);
          return;
        }
        gl.deleteSync(fence);
        done();
      };
      ask();
    });
  }

  // Draws one step; throws the first error.
  async tryDrawing(scene, step, width, height) {
    const { gl } = this;
    const most = gl.getParameter(gl.MAX_UNIFORM_BLOCK_SIZE);
    for (const { uniforms } of scene.drawings) {
      for (const { size } of uniforms) {
        if (size > most) throw new Error(`the lights take ${size} bytes, and this browser takes ${most}`);
      }
    }
    while (gl.getError() !== gl.NO_ERROR && !gl.isContextLost());
    this.draw(scene, { ...step, clear: true, show: false }, width, height);
    const error = gl.getError();
    if (error === gl.OUT_OF_MEMORY) throw new Error('its graphics memory is too small for the meshes');
    if (error !== gl.NO_ERROR && !gl.isContextLost()) throw new Error(`WebGL 2 reports error ${error}`);
    return true;
  }

  // Three rows of 16 albedos.
  async albedo(shader, bytes) {
    const { gl } = this;
    const frame = gl.createFramebuffer();
    const buffer = gl.createRenderbuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
    gl.bindRenderbuffer(gl.RENDERBUFFER, buffer);
    gl.renderbufferStorage(gl.RENDERBUFFER, gl.RGBA32UI, NODES, 3);
    gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.RENDERBUFFER, buffer);
    gl.viewport(0, 0, NODES, 3);
    gl.disable(gl.DEPTH_TEST);
    gl.disable(gl.CULL_FACE);
    gl.useProgram(this.programOf(shader));
    for (const { binding, name } of shader.uniforms) {
      this.bind(binding, new Uniform(bytes[name]), bytes[name].length);
    }
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    const rows = new Uint32Array(4 * NODES * 3);
    gl.readPixels(0, 0, NODES, 3, gl.RGBA_INTEGER, gl.UNSIGNED_INT, rows);
    gl.deleteFramebuffer(frame);
    gl.deleteRenderbuffer(buffer);
    return new Float32Array(rows.buffer);
  }
}

