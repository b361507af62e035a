// One knob: the caption with its help, and the control of a parameter's kind.

// An element with attributes, listeners and children.
function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith('on')) made.addEventListener(name.slice(2), value);
    else if (value === true) made.setAttribute(name, '');
    else if (value !== false && value !== null && value !== undefined) made.setAttribute(name, value);
  }
  made.append(...children.filter((child) => child !== null));
  return made;
}

// Text with markup that export/html/equation.rs wrote and escaped.
function markup(tag, html, attributes = {}) {
  const made = element(tag, attributes);
  made.innerHTML = html;
  return made;
}

// A text in which no line ends after a dash within a word: “Blinn–Phong”, “192–198”.
function kept(text) {
  return text.split(/(\S*–\S*)/).map((part, i) => (i % 2 ? element('span', { class: 'whole' }, part) : part));
}

const hex = (colour) => `#${colour.map((c) => c.toString(16).padStart(2, '0')).join('')}`;
const fromHex = (text) => [1, 3, 5].map((i) => parseInt(text.slice(i, i + 2), 16));
const shown = (number) => String(Number(number.toPrecision(4)));

// A slider with a field for the number. `set` receives numbers in the range.
function slider(label, { min, max, step, open, unit }, value, set) {
  const within = (v) => Math.min(open ? Infinity : max, Math.max(min, v));
  const range = element('input', { type: 'range', min, max, step, 'aria-label': label, value });
  const field = element('input', {
    type: 'number', min, max: open ? null : max, step: step === 1 ? 1 : 'any', 'aria-label': `${label}, number`,
    inputmode: 'decimal',
  });
  const show = (v) => {
    range.value = v;
    field.value = shown(v);
    range.style.setProperty('--part', `${(100 * (Math.min(v, max) - min)) / (max - min)}%`);
  };
  show(value);
  range.addEventListener('input', () => {
    const v = within(step === 1 ? Math.round(range.valueAsNumber) : Number(range.value));
    show(v);
    set(v);
  });
  field.addEventListener('change', () => {
    const typed = field.valueAsNumber;
    if (Number.isFinite(typed)) {
      value = within(step === 1 ? Math.round(typed) : typed);
      set(value);
    }
    show(Number.isFinite(typed) ? value : range.valueAsNumber);
  });
  return [range, element('span', { class: 'field' }, field, unit ? element('span', { class: 'unit' }, unit) : null)];
}

const CONTROLS = {
  number(p, value, set) {
    const [range, number] = slider(p.label, { ...p, step: (p.max - p.min) / 1000 }, value, set);
    return { beside: number, below: [range] };
  },
  integer(p, value, set) {
    const [range, number] = slider(p.label, { ...p, step: 1 }, value, set);
    return { beside: number, below: [range] };
  },
  triple(p, value, set) {
    const numbers = [...value];
    const rows = ['red', 'green', 'blue'].slice(0, value.length).map((channel, i) => {
      const [range, number] = slider(`${p.label}, ${channel}`, { ...p, step: (p.max - p.min) / 1000 }, value[i], (v) => {
        numbers[i] = v;
        set([...numbers]);
      });
      return element('div', { class: `channel ${channel}` }, range, number);
    });
    return { beside: null, below: rows };
  },
  colour(p, value, set) {
    const text = element('code', {}, hex(value));
    const input = element('input', {
      type: 'color', value: hex(value), 'aria-label': p.label,
      oninput: (event) => {
        text.textContent = event.target.value;
        set(fromHex(event.target.value));
      },
    });
    return { beside: element('span', { class: 'swatch' }, text, input), below: [] };
  },
  choice(p, value, set) {
    const options = p.options.map(([id, name]) => element('option', { value: id, selected: id === value }, name));
    const select = element('select', { 'aria-label': p.label, onchange: (event) => set(event.target.value) }, ...options);
    return { beside: null, below: [select] };
  },
  flag(p, value, set) {
    const check = element('input', {
      type: 'checkbox', checked: value, 'aria-label': p.label, onchange: (event) => set(event.target.checked),
    });
    return { beside: check, below: [] };
  },
};

// A knob; `reason` says why it is disabled, if it is.
function knob(p, value, reason, set) {
  const control = CONTROLS[p.kind] ?? CONTROLS[Array.isArray(value) ? 'triple' : 'number'];
  const { beside, below } = control(p, value, set);
  const id = `help-${p.name}`;
  const help = element('p', { class: 'help', id, hidden: true }, p.help);
  const toggle = element('button', {
    class: 'name', type: 'button', 'aria-expanded': 'false', 'aria-controls': id, title: p.help,
    onclick: () => {
      help.hidden = !help.hidden;
      toggle.setAttribute('aria-expanded', String(!help.hidden));
    },
  }, p.symbol ? markup('span', p.symbol, { class: 'symbol' }) : null, element('span', {}, p.label));
  const caption = element('div', { class: 'caption' }, toggle, beside);
  const why = reason ? element('p', { class: 'reason' }, `${reason}.`) : null;
  const kinds = `knob ${p.kind}${reason === null ? '' : ' unused'}`;
  const made = element('div', { class: kinds, role: 'group', 'aria-label': p.label, 'data-name': p.name }, caption, ...below);
  // The name still tells what the parameter would do.
  for (const control of made.querySelectorAll('input, select')) control.disabled = reason !== null;
  return element('div', { class: 'parameter' }, made, help, why);
}

