// The panel: shading model, object, reflection model with its equation and knobs, exposure, shader.

class Panel {
  // `changed(thing)` is called after values of an object changed; without an object, after anything else did.
  // `viewed(scene)` is called when another view is chosen.
  constructor(views, changed, viewed) {
    this.views = views;
    this.changed = changed;
    this.viewed = viewed;
    this.shadings = document.getElementById('shadings');
    this.object = document.getElementById('object');
    this.model = document.getElementById('model');
    this.knobs = document.getElementById('knobs');
    this.object.addEventListener('change', () => this.select(this.scene.things[this.object.value]));
    document.getElementById('reset').addEventListener('click', () => this.reset());
    this.showViews();
    this.enter(views[0]);
  }

  // Shows another view of the scene: the same object of it, if it is there.
  enter(scene) {
    const before = this.scene ? this.scene.things.indexOf(this.selected) : 0;
    this.scene = scene;
    this.selected = scene.things[before] ?? scene.things[0];
    this.showShadings();
    this.showObjects();
    this.showExposure();
    this.showModel();
  }

  showViews() {
    const { views } = this;
    document.getElementById('scene-views').hidden = views.length < 2;
    views.forEach((view, i) => {
      const named = view.name === view.letter ? '' : ` ${view.name}`;
      const input = element('input', {
        type: 'radio', name: 'view', checked: i === 0, value: view.letter,
        onchange: () => {
          this.enter(view);
          this.viewed(view);
        },
      });
      const text = element('span', {}, element('b', {}, view.letter), named);
      document.getElementById('views').append(element('label', { title: `View ${view.letter}${named}` }, input, text));
    });
  }

  showShadings() {
    const { scene } = this;
    const own = scene.mixed ? [[null, 'Scene', 'Each object keeps the shading model that the scene gives it.', '']] : [];
    const all = [...own, ...scene.shadings.map((s, i) => [i, s.name, s.summary, s.source])];
    const summary = document.getElementById('shading-summary');
    const tell = (text, source) => {
      summary.textContent = text;
      summary.title = source;
    };
    document.getElementById('shadings').replaceChildren();
    for (const [index, name, text, source] of all) {
      const chosen = scene.shading === index;
      if (chosen) tell(text, source);
      const input = element('input', {
        type: 'radio', name: 'shading', checked: chosen, value: index === null ? 'own' : scene.shadings[index].id,
        onchange: () => {
          scene.setShading(index);
          tell(text, source);
          this.showModel();
          this.changed(null);
        },
      });
      this.shadings.append(element('label', { title: text }, input, element('span', {}, name.replace(/ shading$/, ''))));
    }
  }

  showObjects() {
    const { scene } = this;
    document.getElementById('objects').hidden = scene.things.length < 2;
    this.object.replaceChildren(...scene.things.map(({ name }, i) => element('option', { value: i }, name)));
    this.object.value = scene.things.indexOf(this.selected);
  }

  select(thing) {
    if (!thing || thing === this.selected) return;
    this.selected = thing;
    this.object.value = this.scene.things.indexOf(thing);
    this.showModel();
  }

  showExposure() {
    const [range, number] = slider('exposure', { min: -10, max: 10, step: 0.1, unit: 'EV', open: true }, this.scene.exposure, (v) => {
      this.scene.exposure = v;
      this.changed(null);
    });
    const caption = element('div', { class: 'caption' }, element('span', { class: 'name' }, 'Exposure'), number);
    document.getElementById('exposure').replaceChildren(element('div', { class: 'knob' }, caption, range));
  }

  // The reason why a parameter has no effect at present, or may not change; null if it may. The reason of all of them
  // stands above them.
  reasonFor(parameters, p) {
    if (this.selected.model.fixed) return '';
    let here = p;
    for (let i = 0; i < parameters.length && here.usedWhen; i++) {
      const other = parameters.find((q) => q.name === here.usedWhen.parameter);
      if (!other) return null;
      const value = String(this.selected.value(other));
      if (!here.usedWhen.choices.includes(value)) {
        const [, name] = other.options.find(([id]) => id === value);
        const what = other.kind === 'flag' ? `“${other.label}”` : `the ${other.label}`;
        return `Not used while ${what} is ${name}`;
      }
      here = other;
    }
    return null;
  }

  showModel() {
    const { model } = this.selected;
    const parts = model.equation.map(({ term, html }) => markup('div', html, { class: `part ${term}` }));
    this.model.replaceChildren(
      element('h2', {}, ...kept(model.name)),
      element('p', { class: 'summary' }, ...kept(model.summary)),
      ...(parts.length > 0 ? [element('div', { class: 'equation', role: 'math', 'aria-label': 'Equation' }, ...parts)] : []),
      ...(model.source || model.author ? [element('p', { class: 'source' }, ...kept(model.source || model.author))] : []),
    );
    document.getElementById('shader').textContent = this.selected.program.wgsl;
    this.showKnobs();
  }

  showKnobs() {
    const { selected } = this;
    const { parameters } = selected;
    const made = parameters.map((p) =>
      knob(p, selected.value(p), this.reasonFor(parameters, p), (value) => {
        selected.values[p.name] = value;
        this.changed(selected);
        // Choices decide which other parameters are used.
        if (p.options) this.showKnobs();
      }),
    );
    const focused = document.activeElement?.closest?.('.knob')?.dataset.name;
    const fixed = selected.model.fixed ? [element('p', { class: 'summary' }, selected.model.fixed)] : [];
    this.knobs.replaceChildren(...fixed, ...made);
    if (focused) this.knobs.querySelector(`[data-name="${CSS.escape(focused)}"] select`)?.focus();
  }

  reset() {
    this.selected.reset();
    this.showKnobs();
    this.changed(this.selected);
  }
}

