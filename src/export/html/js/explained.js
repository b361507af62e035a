// Why one point of the picture has its colour: the numbers of the program for the scene as exported, below the equation,
// and a cross in the picture while that shows this scene from there. Pages without such a point have none of this.

// Calls `after` with the object behind every call of a method.
function behind(kind, name, after) {
  const method = kind.prototype[name];
  kind.prototype[name] = function (...given) {
    const result = method.apply(this, given);
    after(this);
    return result;
  };
}

class Explained {
  constructor() {
    // By the letters of the views: a direction, and a text with markup that export/html/explained.rs wrote and escaped.
    this.points = {};
    // The shading model of each view as exported.
    this.shadings = new Map();
    this.section = document.getElementById('why');
    this.remark = document.getElementById('why-now');
    this.text = document.getElementById('why-text');
    this.cross = element('div', { id: 'cross', hidden: true });
    picture.append(this.cross);
    document.getElementById('why-back').addEventListener('click', () => this.setBack());
  }

  async read() {
    this.points = JSON.parse(new TextDecoder().decode(await unpack('explained-data')));
    if (this.panel) this.show(this.panel);
    if (this.page) this.follow(this.page);
  }

  // Shows the text of the view that the panel shows.
  show(panel) {
    this.panel = panel;
    const { scene } = panel;
    if (!this.shadings.has(scene)) this.shadings.set(scene, scene.shading);
    const point = this.points[scene.letter];
    this.section.hidden = !point;
    if (!point || this.shown === scene) return;
    this.shown = scene;
    this.text.innerHTML = point.html;
  }

  // Marks the point in the picture that is being drawn, or says that the picture is another one.
  follow(page) {
    this.page = page;
    const { camera, size, scene } = page;
    const point = this.points[scene.letter];
    const changed = this.isChanged(scene);
    this.remark.hidden = !changed;
    this.cross.hidden = !point || changed || camera.hasMoved || bare !== null;
    if (this.cross.hidden) return;
    const aspect = size[0] / size[1];
    const slope = camera.slope(aspect, !bare);
    this.cross.style.left = `${50 + (50 * point.at[0]) / (slope * aspect)}%`;
    this.cross.style.top = `${50 - (50 * point.at[1]) / slope}%`;
  }

  isChanged(scene) {
    const shading = this.shadings.get(scene) ?? null;
    const other = scene.exposure !== scene.initialExposure || scene.shading !== shading;
    return other || scene.things.some((thing) => thing.isChanged);
  }

  // The knobs as they were exported; the camera stays.
  setBack() {
    const { panel } = this;
    const { scene } = panel;
    const changed = scene.things.filter((thing) => thing.isChanged);
    for (const thing of changed) thing.reset();
    scene.exposure = scene.initialExposure;
    scene.setShading(this.shadings.get(scene) ?? null);
    panel.enter(scene);
    for (const thing of changed) panel.changed(thing);
    panel.changed(null);
    // The button is about to vanish.
    document.getElementById('why-title').focus({ preventScroll: true });
  }
}

const explained = new Explained();
behind(Panel, 'enter', (panel) => explained.show(panel));
behind(Page, 'resize', (page) => explained.follow(page));
explained.read().catch((error) => console.warn(error));

