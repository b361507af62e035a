// The page: chooses a renderer, and draws when something changed.
//
// After the # of the address: `renderer=webgpu` or `renderer=webgl` allows only that one; `picture=640x360` shows the
// picture alone in that size, from the scene's observer; `samples=1` draws without smooth edges.

const asked = new URLSearchParams(location.hash.slice(1));
const picture = document.getElementById('picture');
const caption = document.getElementById('renderer');
const bare = asked.get('picture')?.match(/^(\d+)x(\d+)$/)?.slice(1).map(Number) ?? null;
// Starts in succession without a whole picture.
const MOST_STARTS = 6;
// Milliseconds before another start where browsers refuse it; longer each time.
const PAUSE = 300;
const NO_GRAPHICS = 'This browser has neither WebGPU nor WebGL 2; a newer one has.';
const REFUSED = 'This browser refuses WebGL 2. Switch on hardware acceleration, or start it anew.';
const GAVE_UP = 'The graphics driver gave up: the scene is too much work for it. Make the window smaller, or use hardware acceleration.';
const samples = asked.get('samples') === '1' ? 1 : 4;

// A picture that could not be drawn, in words; what the browser said, behind them.
const brokenOff = ({ message }) => `The picture could not follow. Reload the page, or open it in another browser. (${message})`;

// True if a canvas that was just drawn on shows nothing, not even what it was cleared with.
function isBlank(canvas) {
  const small = Object.assign(document.createElement('canvas'), { width: 8, height: 8 }).getContext('2d');
  small.drawImage(canvas, 0, 0, 8, 8);
  return small.getImageData(0, 0, 8, 8).data.every((byte) => byte === 0);
}

function fail(text) {
  document.body.classList.add('failed');
  document.getElementById('failure').textContent = text;
  document.body.dataset.state = 'failed';
}

// A fresh canvas: one that has a context of one kind cannot have another.
function freshCanvas() {
  const canvas = document.createElement('canvas');
  picture.querySelector('canvas')?.remove();
  picture.prepend(canvas);
  return canvas;
}

// Waits while the page is out of sight.
const inSight = () =>
  document.hidden && new Promise((done) => document.addEventListener('visibilitychange', done, { once: true }));

// Shows a line in the corner, and waits until it is on the screen: the work that follows may block the page.
async function say(text) {
  caption.textContent = text;
  await inSight();
  await new Promise(requestAnimationFrame);
  await new Promise((done) => setTimeout(done, 0));
}

class Page {
  constructor(scene) {
    this.scene = scene;
    this.camera = new Camera(scene.observer, scene.centre);
    this.renderer = null;
    // The renderers that are left, in the order in which they are tried.
    this.kinds = { webgpu: [WebGpu], webgl: [WebGl] }[asked.get('renderer')] ?? [WebGpu, WebGl];
    // True if there is WebGPU, and it failed.
    this.isSecond = false;
    this.starts = 0;
    // The start in progress, or the last one.
    this.starting = Promise.resolve();
    this.work = new Work(GOAL);
    // True once a picture of the renderer is there.
    this.hasPicture = false;
    // True while a picture is wanted that has not been begun, and while any is drawn.
    this.wanted = false;
    this.painting = false;
    // Changes whose curves are being calculated.
    this.pending = 0;
    this.curves = Promise.resolve();
  }

  // The first renderer that draws the scene. When the system takes it away, another one begins on a fresh canvas, with
  // smaller steps.
  async start() {
    this.starts += 1;
    if (this.starts > MOST_STARTS) return fail(this.gaveUp ? GAVE_UP : REFUSED);
    // Edges that are not smoothed take a quarter of the work.
    const count = this.starts > 3 ? 1 : samples;
    const { kinds } = this;
    // A browser that knows WebGL 2 and does not give it refuses it, often for a while after a driver gave up.
    const nothing = kinds.includes(WebGl) && window.WebGL2RenderingContext ? REFUSED : NO_GRAPHICS;
    let reason = nothing;
    for (const kind of kinds) {
      try {
        this.hasPicture = false;
        await say('Compiling the shader…');
        this.canvas = freshCanvas();
        const renderer = await kind.create(this.canvas, count);
        this.renderer = renderer;
        if (!renderer) {
          reason = nothing;
          continue;
        }
        renderer.lost.then(() => (this.gaveUp = true));
        const [width, height] = this.resize();
        await renderer.tryDrawing(this.scene, this.work.trial(this.scene, width, height), width, height);
        // Drivers compile a shader when they first draw with it.
        await renderer.finished();
        this.label = this.isSecond ? `WebGPU failed, so ${kind.label} draws` : kind.label;
        caption.textContent = 'Drawing…';
        const ofLight = this.scene.lightSamples;
        const noise = ofLight ? `; lights with extent: ${ofLight} samples, some noise` : '';
        caption.title = `${this.isSecond ? 'WebGPU failed. ' : ''}Drawn with ${kind.label}, ${count} samples per pixel${noise}`;
        renderer.lost.then(() => this.goesOnWithout(renderer));
        this.draw();
        return true;
      } catch (error) {
        console.warn(error);
        this.drop(kind);
        if (this.renderer?.isLost) {
          this.gaveUp = true;
          this.work = new Work(0.5 * this.work.goal);
        }
        reason = `This browser cannot draw the scene; another one may. (${error.message})`;
      }
    }
    this.renderer = null;
    if (this.gaveUp || reason === REFUSED) {
      // Browsers refuse graphics for a while after a driver gave up.
      await new Promise((done) => setTimeout(done, PAUSE * this.starts));
      return this.start();
    }
    return fail(reason);
  }

  // Leaves WebGPU for WebGL 2. False if it is not WebGPU, or the only one allowed.
  drop(kind) {
    if (kind !== WebGpu || !this.kinds.includes(WebGl)) return false;
    this.kinds = [WebGl];
    this.isSecond = true;
    return true;
  }

  // Starts again after a renderer failed: with WebGL 2 where WebGPU did, otherwise if the system took it away. False if
  // neither is so.
  goesOnWithout(renderer) {
    // Loss, drawing and curves may all tell of one failure.
    if (this.renderer !== renderer) return true;
    if (this.drop(renderer.constructor)) this.starts = 0;
    else if (!renderer.isLost) return false;
    this.renderer = null;
    document.body.dataset.state = 'busy';
    this.work = new Work(0.5 * this.work.goal);
    this.starting = this.start();
    return true;
  }

  // The size of the whole picture in pixels; tells the shaders where the camera is.
  resize() {
    const ratio = bare ? 1 : window.devicePixelRatio;
    const [width, height] = bare ?? [picture.clientWidth, picture.clientHeight];
    const most = this.renderer?.largest ?? 4096;
    this.size = [width, height].map((side) => Math.max(1, Math.min(most, Math.round(side * ratio))));
    const { scene, camera } = this;
    const floats = [
      ...camera.clipFromRoom(this.size[0] / this.size[1], !bare),
      ...camera.position,
      2 ** scene.exposure,
    ];
    scene.view.set(bytesOfFloats(floats));
    return this.size;
  }

  // Shows another view of the scene, from where the camera is.
  show(scene) {
    this.scene = scene;
    this.draw();
  }

  // Draws before the next picture of the screen.
  draw() {
    this.wanted = true;
    document.body.dataset.state = 'busy';
    if (this.painting) return;
    this.painting = true;
    this.paint().catch((error) => {
      this.painting = false;
      fail(brokenOff(error));
    });
  }

  async paint() {
    while (this.wanted) {
      await new Promise(requestAnimationFrame);
      this.wanted = false;
      const { renderer } = this;
      try {
        if (!renderer || !(await this.pictures(renderer))) continue;
      } catch (error) {
        if (!this.goesOnWithout(renderer)) throw error;
        continue;
      }
      this.starts = 1;
      document.body.dataset.drawn = Number(document.body.dataset.drawn ?? 0) + 1;
      if (this.pending === 0 && !this.wanted) document.body.dataset.state = 'ready';
    }
    this.painting = false;
  }

  // Draws the whole picture, and coarse ones before it where it takes long. False if it was given up on the way, as the
  // scene changed or the system took the renderer away.
  async pictures(renderer) {
    const [width, height] = this.resize();
    picture.style.backgroundImage = this.scene.gradient ?? '';
    const scales = this.work.scales(this.scene, width * height);
    for (const [i, scale] of scales.entries()) {
      const size = [width, height].map((side) => Math.ceil(side / scale));
      // The first one is finished in any case, so that something follows the hand.
      if (!(await this.picture(renderer, size, i === 0 && scale > 1))) return false;
      if (this.wanted && scale > 1) return false;
    }
    return true;
  }

  // Draws one picture in steps, and shows it; it gives way to changes unless it `stays`.
  async picture(renderer, [width, height], stays) {
    const { scene, canvas, work } = this;
    const countOf = (drawing) => renderer.countOf(drawing);
    const draw = (step) => {
      if (step.show) Object.assign(canvas, { width, height });
      renderer.draw(scene, step, width, height);
      // A gradient is behind the canvas, which may then be empty.
      const mayBeBlank = this.hasPicture || scene.gradient || renderer.isLost;
      if (step.show && !mayBeBlank && isBlank(canvas)) throw new Error(`${renderer.constructor.label} shows nothing`);
    };
    work.begin();
    let clear = true;
    let isAll = false;
    for (const step of work.steps(scene, width, height, countOf)) {
      await inSight();
      const begun = performance.now();
      ({ isAll } = step);
      draw({ ...step, clear, show: isAll });
      clear = false;
      if (step.paces.length > 0) await renderer.finished();
      if (this.renderer !== renderer || renderer.isLost) return false;
      // Browsers slow down pages that are out of sight.
      if (!document.hidden) for (const [pace, points] of step.paces) pace.took(points, performance.now() - begun);
      if (isAll) break;
      if (this.wanted && !stays) return false;
      const drawing = this.hasPicture ? `${this.label}:` : 'Drawing…';
      caption.textContent = `${drawing} ${Math.floor(100 * step.done)} %`;
    }
    if (!isAll) draw({ list: [], tile: [0, 0, width, height], clear, show: true });
    work.end();
    this.hasPicture = true;
    caption.textContent = this.label;
    return true;
  }

  // The curve of an object with these values, by the next renderer where one fails.
  async curveOf(thing, values) {
    for (;;) {
      await this.starting;
      const { renderer } = this;
      if (!renderer) return thing.initialCurve;
      try {
        const curve = await curveOf(renderer, thing, values);
        if (!renderer.isLost) return curve;
        this.goesOnWithout(renderer);
      } catch (error) {
        if (!this.goesOnWithout(renderer)) throw error;
      }
    }
  }

  // Applies the values of an object; its curve belongs to them, and so both change at once.
  apply(thing) {
    const values = structuredClone(thing.values);
    this.pending += 1;
    document.body.dataset.state = 'busy';
    this.curves = this.curves.then(async () => {
      // A later change replaces this one.
      const replaced = JSON.stringify(values) !== JSON.stringify(thing.values);
      let curve = thing.initialCurve;
      if (!replaced && readsCurve(thing) && thing.isChanged) curve = await this.curveOf(thing, values);
      this.pending -= 1;
      if (replaced) return;
      thing.uniforms.albedo_curve.set(curve);
      thing.uniforms.parameters.set(thing.packed(values));
      thing.uniforms.interior.set(thing.packedInterior(values, curve));
      thing.uniforms.shading_values.set(thing.packedShading());
      this.draw();
    });
    this.curves = this.curves.catch((error) => fail(brokenOff(error)));
  }

  pickAt(x, y) {
    const [width, height] = [picture.clientWidth, picture.clientHeight];
    const ray = this.camera.ray((2 * x) / width - 1, 1 - (2 * y) / height, width / height, !bare);
    return pick(this.scene, this.camera.position, ray);
  }
}

async function main() {
  if (typeof DecompressionStream === 'undefined') {
    fail('This browser is too old to unpack the scene.');
    return;
  }
  for (const words of document.querySelectorAll('h1, header p')) words.replaceChildren(...kept(words.textContent));
  const [text, meshes] = await Promise.all([unpack('scene-data'), unpack('mesh-data')]);
  const data = JSON.parse(new TextDecoder().decode(text));
  const shared = new Shared(data, meshes);
  const views = data.views.map((view) => new Scene(view, shared));
  const page = new Page(views[0]);
  if (bare) {
    document.body.classList.add('bare');
    picture.style.width = `${bare[0]}px`;
    picture.style.height = `${bare[1]}px`;
  }
  const changed = (thing) => (thing ? page.apply(thing) : page.draw());
  const panel = new Panel(views, changed, (scene) => page.show(scene));
  page.starting = page.start();
  if (!(await page.starting)) return;
  // Without a use it would only cover the picture.
  const back = document.getElementById('view');
  const turned = () => {
    back.hidden = !page.camera.hasMoved;
    page.draw();
  };
  listen(picture, page.camera, turned, (x, y) => panel.select(page.pickAt(x, y)));
  back.addEventListener('click', () => {
    page.camera.reset();
    turned();
    // The button has vanished.
    picture.focus({ preventScroll: true });
  });
  new ResizeObserver(() => page.draw()).observe(picture);
  page.draw();
}

const start = () => main().catch((error) => fail(`The page could not start: ${error.message}`));
