// The page: chooses a renderer, and draws when something changed.
//
// After the # of the address: `renderer=webgpu` or `renderer=webgl` allows only that one; `picture=640x360` shows the
// picture alone in that size, from the scene's observer; `samples=1` draws without smooth edges.

const asked = new URLSearchParams(location.hash.slice(1));
const picture = document.getElementById('picture');
const caption = document.getElementById('renderer');
const bare = asked.get('picture')?.match(/^(\d+)x(\d+)$/)?.slice(1).map(Number) ?? null;
const MOST_STARTS = 10;
const samples = asked.get('samples') === '1' ? 1 : 4;

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

class Page {
  constructor(scene) {
    this.scene = scene;
    this.camera = new Camera(scene.observer, scene.centre);
    this.renderer = null;
    this.starts = 0;
    this.waiting = false;
    // Changes whose curves are being calculated.
    this.pending = 0;
    this.curves = Promise.resolve();
  }

  // The first renderer that draws the scene. When the system takes it away, another one begins on a fresh canvas.
  async start() {
    this.starts += 1;
    if (this.starts > MOST_STARTS) {
      fail('The graphics of this browser stop again and again. Loading the page again may help.');
      return false;
    }
    const kinds = { webgpu: [WebGpu], webgl: [WebGl] }[asked.get('renderer')] ?? [WebGpu, WebGl];
    let reason = 'This browser has neither WebGPU nor WebGL 2, and so cannot draw the scene. A newer one can.';
    for (const kind of kinds) {
      try {
        this.canvas = freshCanvas();
        const renderer = await kind.create(this.canvas, samples);
        this.renderer = renderer;
        this.resize();
        if (renderer && (await renderer.tryDrawing(this.scene, this.canvas.width, this.canvas.height))) {
          caption.textContent = kind.label;
          const ofLight = this.scene.lightSamples;
          const noise = ofLight ? `; lights with extent: ${ofLight} samples per pixel, some noise remains` : '';
          caption.title = `Drawn with ${kind.label}, ${samples} samples per pixel${noise}`;
          renderer.lost.then(() => this.renderer === renderer && this.start());
          this.draw();
          return true;
        }
      } catch (error) {
        console.warn(error);
        reason = `This browser cannot draw the scene: ${error.message}`;
      }
    }
    this.renderer = null;
    fail(reason);
    return false;
  }

  resize() {
    const ratio = bare ? 1 : window.devicePixelRatio;
    const [width, height] = bare ?? [picture.clientWidth, picture.clientHeight];
    const most = this.renderer?.largest ?? 4096;
    this.canvas.width = Math.max(1, Math.min(most, Math.round(width * ratio)));
    this.canvas.height = Math.max(1, Math.min(most, Math.round(height * ratio)));
    const { scene, camera } = this;
    const floats = [
      ...camera.clipFromRoom(this.canvas.width / this.canvas.height, !bare),
      ...camera.position,
      2 ** scene.exposure,
    ];
    scene.view.set(bytesOfFloats(floats));
  }

  // Shows another view of the scene, from where the camera is.
  show(scene) {
    this.scene = scene;
    this.draw();
  }

  // Draws before the next picture of the screen.
  draw() {
    if (this.waiting) return;
    this.waiting = true;
    document.body.dataset.state = 'busy';
    requestAnimationFrame(() => {
      this.waiting = false;
      if (!this.renderer) return;
      this.resize();
      picture.style.backgroundImage = this.scene.gradient ?? '';
      this.renderer.draw(this.scene, this.canvas.width, this.canvas.height);
      document.body.dataset.drawn = Number(document.body.dataset.drawn ?? 0) + 1;
      if (this.pending === 0) document.body.dataset.state = 'ready';
    });
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
      if (!replaced && readsCurve(thing) && thing.isChanged) curve = await curveOf(this.renderer, thing, values);
      this.pending -= 1;
      if (replaced) return;
      thing.uniforms.albedo_curve.set(curve);
      thing.uniforms.parameters.set(thing.packed(values));
      thing.uniforms.shading_values.set(thing.packedShading());
      this.draw();
    });
    this.curves = this.curves.catch((error) => fail(`The picture could not follow: ${error.message}`));
  }

  pickAt(x, y) {
    const [width, height] = [picture.clientWidth, picture.clientHeight];
    const ray = this.camera.ray((2 * x) / width - 1, 1 - (2 * y) / height, width / height, !bare);
    return pick(this.scene, this.camera.position, ray);
  }
}

async function main() {
  if (typeof DecompressionStream === 'undefined') {
    fail('This browser is too old to unpack the scene. A newer one can.');
    return;
  }
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
  if (!(await page.start())) return;
  listen(picture, page.camera, () => page.draw(), (x, y) => panel.select(page.pickAt(x, y)));
  document.getElementById('view').addEventListener('click', () => {
    page.camera.reset();
    page.draw();
  });
  new ResizeObserver(() => page.draw()).observe(picture);
  page.draw();
}

const start = () => main().catch((error) => fail(`The page could not start: ${error.message}`));
