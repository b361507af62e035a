// Mouse, touch and keys on the picture, as turns, zooms and moves of the camera.

const TURN_PER_PIXEL = 0.008;
const TURN_PER_KEY = Math.PI / 36;
const ZOOM_PER_KEY = 1.15;
// A finger that moved less tapped.
const TAP = 6;

// `changed` is called after the camera moved, `tapped` with a place on the picture in pixels of the page.
function listen(picture, camera, changed, tapped) {
  const pointers = new Map();
  let travelled = 0;
  const height = () => picture.clientHeight;

  picture.addEventListener('pointerdown', (event) => {
    picture.setPointerCapture(event.pointerId);
    if (pointers.size === 0) travelled = 0;
    pointers.set(event.pointerId, [event.clientX, event.clientY]);
  });
  picture.addEventListener('pointermove', (event) => {
    const before = pointers.get(event.pointerId);
    if (!before) return;
    const here = [event.clientX, event.clientY];
    const [dx, dy] = [here[0] - before[0], here[1] - before[1]];
    travelled += Math.hypot(dx, dy);
    pointers.set(event.pointerId, here);
    const others = [...pointers].filter(([id]) => id !== event.pointerId).map(([, at]) => at);
    if (others.length === 1) {
      // Two fingers: their distance zooms, their middle moves.
      const apart = (at) => Math.max(1, Math.hypot(at[0] - others[0][0], at[1] - others[0][1]));
      camera.zoom(apart(before) / apart(here));
      camera.move((0.5 * dx) / height(), (-0.5 * dy) / height());
    } else if (event.shiftKey || event.buttons > 1) {
      camera.move(dx / height(), -dy / height());
    } else {
      camera.turn(dx * TURN_PER_PIXEL, dy * TURN_PER_PIXEL);
    }
    changed();
  });
  const ended = (event) => {
    if (!pointers.delete(event.pointerId)) return;
    if (event.type === 'pointerup' && travelled < TAP && pointers.size === 0) {
      const frame = picture.getBoundingClientRect();
      tapped(event.clientX - frame.left, event.clientY - frame.top);
    }
  };
  picture.addEventListener('pointerup', ended);
  picture.addEventListener('pointercancel', ended);
  picture.addEventListener('contextmenu', (event) => event.preventDefault());
  picture.addEventListener(
    'wheel',
    (event) => {
      event.preventDefault();
      camera.zoom(Math.exp(Math.max(-60, Math.min(60, event.deltaY)) * 0.003));
      changed();
    },
    { passive: false },
  );

  const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
  picture.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    const arrow = arrows[event.key];
    if (arrow && event.shiftKey) camera.move(0.05 * arrow[0], -0.05 * arrow[1]);
    else if (arrow) camera.turn(arrow[0] * TURN_PER_KEY, arrow[1] * TURN_PER_KEY);
    else if (event.key === '+' || event.key === '=') camera.zoom(1 / ZOOM_PER_KEY);
    else if (event.key === '-') camera.zoom(ZOOM_PER_KEY);
    else if (event.key === '0' || event.key === 'Home') camera.reset();
    else return;
    event.preventDefault();
    changed();
  });
}

