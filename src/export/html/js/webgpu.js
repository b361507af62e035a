// Drawing with WebGPU and the scene's own WGSL.

// Milliseconds in which a browser answers whether it has WebGPU: some never do.
const PATIENCE = 10000;

// The graphics device; nothing where there is no WebGPU. Throws if the browser does not answer.
async function deviceOfBrowser() {
  const request = async () => (await navigator.gpu?.requestAdapter())?.requestDevice();
  const device = request();
  let timer;
  const silence = new Promise((_, fails) => {
    timer = setTimeout(() => {
      fails(new Error('WebGPU does not answer'));
      // One that comes too late is given back.
      device.then((late) => late?.destroy(), () => {});
    }, PATIENCE);
  });
  return Promise.race([device, silence]).finally(() => clearTimeout(timer));
}

class WebGpu {
  static label = 'WebGPU';

  // Null where there is no WebGPU.
  static async create(canvas, samples) {
    const device = await deviceOfBrowser();
    const context = device && canvas.getContext('webgpu');
    return context ? new WebGpu(device, context, samples) : null;
  }

  constructor(device, context, samples) {
    this.device = device;
    this.context = context;
    this.samples = samples;
    this.format = navigator.gpu.getPreferredCanvasFormat();
    const usage = GPUTextureUsage.RENDER_ATTACHMENT | GPUTextureUsage.COPY_DST;
    context.configure({ device, format: this.format, usage, alphaMode: 'premultiplied' });
    // After an error that no scope catches, the picture is not to be trusted.
    const error = new Promise((failed) => device.addEventListener('uncapturederror', failed, { once: true }));
    this.lost = Promise.race([device.lost, error]);
    this.isLost = false;
    this.lost.then(() => (this.isLost = true));
    this.buffers = new WeakMap();
    this.meshes = new WeakMap();
    this.pipelines = new WeakMap();
    this.albedoPipelines = new WeakMap();
    this.bodies = new WeakMap();
    this.groups = new Map();
  }

  get largest() {
    return this.device.limits.maxTextureDimension2D;
  }

  // The layout of uniforms and, for solid bodies, of the texture at the binding `body`.
  layoutOf(uniforms, body = null) {
    const visibility = GPUShaderStage.VERTEX | GPUShaderStage.FRAGMENT;
    const entries = uniforms.map(({ binding }) => ({ binding, visibility, buffer: { type: 'uniform' } }));
    if (body !== null) entries.push({ binding: body, visibility, texture: { sampleType: 'uint' } });
    return this.device.createBindGroupLayout({ entries });
  }

  pipelineOf(program) {
    if (this.pipelines.has(program)) return this.pipelines.get(program);
    const module = this.device.createShaderModule({ code: program.wgsl });
    const layout = this.layoutOf(program.uniforms, program.body);
    const count = program.faces ? 6 : 3;
    const attributes = Array.from({ length: count }, (_, i) => ({
      shaderLocation: i,
      offset: 12 * i,
      format: 'float32x3',
    }));
    const pipeline = this.device.createRenderPipeline({
      layout: this.device.createPipelineLayout({ bindGroupLayouts: [layout] }),
      vertex: { module, entryPoint: 'vertex', buffers: [{ arrayStride: 12 * count, attributes }] },
      fragment: { module, entryPoint: 'fragment', targets: [{ format: this.format }] },
      primitive: { topology: 'triangle-list', cullMode: 'back' },
      depthStencil: { format: 'depth32float', depthWriteEnabled: true, depthCompare: 'greater' },
      multisample: { count: this.samples },
    });
    const made = { pipeline, layout };
    this.pipelines.set(program, made);
    return made;
  }

  bufferWith(array, usage) {
    const size = Math.max(16, 4 * Math.ceil(array.byteLength / 4));
    const buffer = this.device.createBuffer({ size, usage, mappedAtCreation: true });
    new Uint8Array(buffer.getMappedRange()).set(new Uint8Array(array.buffer, array.byteOffset, array.byteLength));
    buffer.unmap();
    return buffer;
  }

  bufferOf(uniform, size) {
    let kept = this.buffers.get(uniform);
    if (!kept) {
      const usage = GPUBufferUsage.UNIFORM | GPUBufferUsage.COPY_DST;
      kept = { buffer: this.device.createBuffer({ size: Math.max(size, 16), usage }), version: -1 };
      this.buffers.set(uniform, kept);
    }
    if (kept.version !== uniform.version) {
      const bytes = uniform.bytes.subarray(0, kept.buffer.size);
      this.device.queue.writeBuffer(kept.buffer, 0, bytes);
      kept.version = uniform.version;
    }
    return kept.buffer;
  }

  meshOf(mesh, kind) {
    if (!this.meshes.has(mesh)) this.meshes.set(mesh, {});
    const kept = this.meshes.get(mesh);
    if (!kept[kind]) {
      const { vertices, indices } = mesh[kind];
      kept[kind] = {
        vertices: this.bufferWith(vertices, GPUBufferUsage.VERTEX),
        indices: this.bufferWith(indices, GPUBufferUsage.INDEX),
        count: indices.length,
      };
    }
    return kept[kind];
  }

  // The texture of a solid body.
  bodyOf(mesh) {
    if (!this.bodies.has(mesh)) {
      const size = [ROWS_ACROSS, mesh.body.length / (4 * ROWS_ACROSS)];
      const usage = GPUTextureUsage.TEXTURE_BINDING | GPUTextureUsage.COPY_DST;
      const texture = this.device.createTexture({ size, format: 'rgba32uint', usage });
      this.device.queue.writeTexture({ texture }, mesh.body, { bytesPerRow: 16 * ROWS_ACROSS }, size);
      this.bodies.set(mesh, texture);
    }
    return this.bodies.get(mesh);
  }

  groupOf({ thing, program, mesh, uniforms }, layout) {
    if (!this.groups.has(thing)) this.groups.set(thing, new Map());
    const kept = this.groups.get(thing);
    if (!kept.has(program)) {
      const entries = uniforms.map(({ binding, size, uniform }) => ({
        binding,
        resource: { buffer: this.bufferOf(uniform, size) },
      }));
      if (program.body !== null) entries.push({ binding: program.body, resource: this.bodyOf(mesh).createView() });
      kept.set(program, this.device.createBindGroup({ layout, entries }));
    }
    return kept.get(program);
  }

  targetsFor(width, height) {
    if (this.depth?.width === width && this.depth?.height === height) return;
    this.depth?.destroy();
    this.colour?.destroy();
    const target = (format) =>
      this.device.createTexture({
        size: [width, height],
        format,
        sampleCount: this.samples,
        usage: GPUTextureUsage.RENDER_ATTACHMENT | (this.samples > 1 ? 0 : GPUTextureUsage.COPY_SRC),
      });
    this.depth = target('depth32float');
    this.colour = target(this.format);
  }

  // Draws pieces of drawings into a tile of the picture, after all of it was cleared with `clear`; `show` shows it then.
  draw(scene, { list, tile, clear, show }, width, height) {
    this.targetsFor(width, height);
    const encoder = this.device.createCommandEncoder();
    const picture = show ? this.context.getCurrentTexture() : null;
    const [loadOp, storeOp] = [clear ? 'clear' : 'load', show && this.samples > 1 ? 'discard' : 'store'];
    const colour = { view: this.colour.createView(), loadOp, storeOp, clearValue: scene.clear };
    if (show && this.samples > 1) colour.resolveTarget = picture.createView();
    const pass = encoder.beginRenderPass({
      colorAttachments: [colour],
      depthStencilAttachment: {
        view: this.depth.createView(),
        depthLoadOp: loadOp,
        depthStoreOp: show ? 'discard' : 'store',
        depthClearValue: 0,
      },
    });
    pass.setScissorRect(...tile);
    for (const { drawing, first, count } of list) {
      const { pipeline, layout } = this.pipelineOf(drawing.program);
      for (const { uniform, size } of drawing.uniforms) this.bufferOf(uniform, size);
      const mesh = this.meshOf(drawing.mesh, drawing.kind);
      pass.setPipeline(pipeline);
      pass.setBindGroup(0, this.groupOf(drawing, layout));
      pass.setVertexBuffer(0, mesh.vertices);
      pass.setIndexBuffer(mesh.indices, 'uint32');
      pass.drawIndexed(Math.min(count, mesh.count - first), 1, first);
    }
    pass.end();
    // A target without samples is copied: the picture on the screen lasts for one step.
    if (show && this.samples === 1) encoder.copyTextureToTexture({ texture: this.colour }, { texture: picture }, [width, height]);
    this.device.queue.submit([encoder.finish()]);
  }

  countOf({ mesh, kind }) {
    return this.meshOf(mesh, kind).count;
  }

  // Waits until everything has been drawn.
  finished() {
    return Promise.race([this.device.queue.onSubmittedWorkDone(), this.lost]);
  }

  // Draws one step within scopes that catch errors; throws the first of them.
  async tryDrawing(scene, step, width, height) {
    this.device.pushErrorScope('validation');
    this.device.pushErrorScope('out-of-memory');
    this.draw(scene, { ...step, clear: true, show: false }, width, height);
    const [memory, other] = await Promise.all([this.device.popErrorScope(), this.device.popErrorScope()]);
    if (memory) throw new Error('its graphics memory is too small for the meshes');
    if (other) throw new Error(other.message);
    return true;
  }

  // Three rows of 16 albedos.
  async albedo(shader, bytes) {
    const { device } = this;
    if (!this.albedoPipelines.has(shader)) {
      const module = device.createShaderModule({ code: shader.wgsl });
      const layout = this.layoutOf(shader.uniforms);
      const pipeline = device.createRenderPipeline({
        layout: device.createPipelineLayout({ bindGroupLayouts: [layout] }),
        vertex: { module, entryPoint: 'albedo_vertex' },
        fragment: { module, entryPoint: 'albedo_fragment', targets: [{ format: 'rgba32uint' }] },
      });
      this.albedoPipelines.set(shader, { pipeline, layout });
    }
    const { pipeline, layout } = this.albedoPipelines.get(shader);
    const usage = GPUTextureUsage.RENDER_ATTACHMENT | GPUTextureUsage.COPY_SRC;
    const target = device.createTexture({ size: [NODES, 3], format: 'rgba32uint', usage });
    const read = device.createBuffer({ size: 3 * 256, usage: GPUBufferUsage.MAP_READ | GPUBufferUsage.COPY_DST });
    const buffers = shader.uniforms.map(({ name }) => this.bufferWith(bytes[name], GPUBufferUsage.UNIFORM));
    const entries = shader.uniforms.map(({ binding }, i) => ({ binding, resource: { buffer: buffers[i] } }));
    const encoder = device.createCommandEncoder();
    const pass = encoder.beginRenderPass({
      colorAttachments: [{ view: target.createView(), loadOp: 'clear', storeOp: 'store' }],
    });
    pass.setPipeline(pipeline);
    if (entries.length > 0) pass.setBindGroup(0, device.createBindGroup({ layout, entries }));
    pass.draw(3);
    pass.end();
    encoder.copyTextureToBuffer({ texture: target }, { buffer: read, bytesPerRow: 256 }, [NODES, 3]);
    device.queue.submit([encoder.finish()]);
    await read.mapAsync(GPUMapMode.READ);
    const rows = new Float32Array(read.getMappedRange().slice(0));
    for (const resource of [target, read, ...buffers]) resource.destroy();
    return rows;
  }
}

