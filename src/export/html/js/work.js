// Drawing in steps. A pixel takes many samples of each light with extent, or many ways through a solid body, and a driver that draws with the processor may
// need a minute for a picture; but systems take the graphics away from a page when one call takes some seconds. So a step
// has as many points as the time of those before it allows: pixels, or corners of triangles where the shading model
// lights these. The picture is the same in one step and in a thousand.

// Milliseconds of a step, at first.
const GOAL = 50;
// Points of the smallest steps, with which drawing begins.
const FEWEST = 64;
// How many times finer a picture is, along each side, than the coarse one before it.
const FINER = 4;

// How many points a step may have, by the time that others took.
class Pace {
  constructor(goal) {
    this.goal = goal;
    this.most = FEWEST;
    this.begin();
  }

  begin() {
    Object.assign(this, { points: 0, time: 0, fits: Infinity });
  }

  took(points, time) {
    this.points += points;
    this.time += time;
    // Shorter times are mostly spent waiting.
    if (4 * time < this.goal) return;
    this.fits = Math.max(FEWEST, Math.min(this.fits, (points * this.goal) / time));
    this.most = Math.min(this.most, this.fits);
  }

  // After a whole picture steps may be larger: by the mean of its steps, unless some took longer.
  end() {
    const mean = (this.points * this.goal) / Math.max(this.time, 1);
    if (4 * this.time < this.goal) this.most = Math.max(this.most, mean);
    else this.most = Math.max(FEWEST, Math.min(mean, this.fits));
    this.begin();
  }
}

// The part of a picture in which drawings are: a rectangle around the cubes around them.
function partOf(drawings, view, width, height) {
  const clip = new Float32Array(view.bytes.buffer, view.bytes.byteOffset, 16);
  const [xs, ys] = [[], []];
  for (const { thing, mesh } of drawings) {
    const m = thing.matrix;
    const half = mesh.radius * length(m.slice(0, 3));
    for (let corner = 0; corner < 8; corner++) {
      const p = [0, 1, 2].map((axis) => m[12 + axis] + (corner & (1 << axis) ? half : -half));
      const [x, y, , w] = [0, 1, 2, 3].map((row) => dot(p, [clip[row], clip[4 + row], clip[8 + row]]) + clip[12 + row]);
      // Behind the camera there is no place in the picture.
      if (w < NEAR) return [0, 0, width, height];
      xs.push((0.5 + (0.5 * x) / w) * width);
      ys.push((0.5 - (0.5 * y) / w) * height);
    }
  }
  const span = (all, side) => {
    const [from, to] = [Math.floor(Math.min(...all)) - 1, Math.ceil(Math.max(...all)) + 1];
    const first = Math.max(0, Math.min(side, from));
    return [first, Math.max(first, Math.min(side, to)) - first];
  };
  const [[x, wide], [y, high]] = [span(xs, width), span(ys, height)];
  return [x, y, wide, high];
}

// The tiles of a part of a picture, each of as many pixels as `pace` allows by then.
function* tiles([left, top, width, height], pace) {
  if (width === 0) return;
  for (let y = 0, high; y < height; y += high) {
    const { most } = pace;
    high = Math.min(height - y, Math.floor(Math.max(Math.sqrt(most), most / width)));
    for (let x = 0, wide; x < width; x += wide) {
      wide = Math.min(width - x, Math.max(1, Math.floor(pace.most / high)));
      yield [left + x, top + y, wide, high];
    }
  }
}

// Pieces of drawings, in lists of as many corners as `pace` allows by then.
function* pieces(drawings, pace, countOf) {
  let [list, points] = [[], 0];
  for (const drawing of drawings) {
    const all = countOf(drawing);
    for (let first = 0, count; first < all; first += count) {
      count = Math.min(all - first, 3 * Math.max(1, Math.floor((pace.most - points) / 3)));
      list.push({ drawing, first, count });
      points += count;
      if (points + 3 <= pace.most) continue;
      yield [list, points];
      [list, points] = [[], 0];
    }
  }
  if (points > 0) yield [list, points];
}

// The kind of work: what is lit, and whether it is a surface or a solid body, which takes longer.
const kindOf = ({ program }) => `${program.corners ? 'corners' : 'pixels'} ${program.body === null ? 'surfaces' : 'bodies'}`;

// Neighbours of one kind of work, in lists: objects are drawn in their order.
function runs(drawings) {
  const all = [];
  for (const drawing of drawings) {
    const last = all.at(-1);
    if (last && kindOf(last[0]) === kindOf(drawing)) last.push(drawing);
    else all.push([drawing]);
  }
  return all;
}

const whole = (drawing) => ({ drawing, first: 0, count: Infinity });

class Work {
  constructor(goal) {
    this.goal = goal;
    // One for each kind of work.
    this.paces = {};
  }

  paceOf(drawing) {
    return (this.paces[kindOf(drawing)] ??= new Pace(this.goal));
  }

  // How many times coarser, along each side, the pictures are that lead to the whole one.
  scales(scene, points) {
    const scales = [1];
    const byPixel = scene.drawings.filter(({ program }) => scene.slow && !program.corners);
    const most = byPixel.reduce((least, drawing) => Math.min(least, this.paceOf(drawing).most), Infinity);
    while (points > 4 * most * scales[0] ** 2) scales.unshift(FINER * scales[0]);
    return scales;
  }

  // The steps of a picture: pieces of drawings, the tile into which they are drawn, whether that is all, the part of the
  // picture that is done then, and the points of each pace.
  *steps(scene, width, height, countOf) {
    const { drawings } = scene;
    const frame = [0, 0, width, height];
    const all = { list: drawings.map(whole), tile: frame, isAll: true, done: 1, paces: [] };
    if (!scene.slow) {
      yield all;
      return;
    }
    const byPace = new Map();
    for (const drawing of drawings) {
      const pace = this.paceOf(drawing);
      byPace.set(pace, drawing.program.corners ? (byPace.get(pace) ?? 0) + countOf(drawing) : width * height);
    }
    const paces = [...byPace].filter(([, points]) => points > 0);
    const corners = drawings.filter(({ program }) => program.corners).reduce((sum, d) => sum + countOf(d), 0);
    if (paces.every(([pace, points]) => points <= pace.most)) {
      yield { ...all, paces };
      return;
    }
    const groups = runs(drawings).map((group) => [group, partOf(group, scene.view, width, height)]);
    const total = groups.reduce((sum, [[first], part]) => sum + (first.program.corners ? 0 : part[2] * part[3]), corners);
    let done = 0;
    const step = (list, tile, pace, points) => {
      done += points;
      return { list, tile, isAll: false, done: done / total, paces: [[pace, points]] };
    };
    for (const [group, part] of groups) {
      const pace = this.paceOf(group[0]);
      if (group[0].program.corners) {
        for (const [list, points] of pieces(group, pace, countOf)) {
          yield step(list, frame, pace, points);
          // All corners take about the same time.
          pace.end();
        }
      } else {
        const list = group.map(whole);
        for (const tile of tiles(part, pace)) yield step(list, tile, pace, tile[2] * tile[3]);
      }
    }
  }

  // A step that meets every shader, and is small.
  trial(scene, width, height) {
    const part = ({ program }) => (program.corners ? 3 : Infinity);
    const list = scene.drawings.map((drawing) => ({ drawing, first: 0, count: part(drawing) }));
    const side = Math.min(4, width, height);
    return { list, tile: [(width - side) >> 1, (height - side) >> 1, side, side] };
  }

  begin() {
    for (const pace of Object.values(this.paces)) pace.begin();
  }

  end() {
    for (const pace of Object.values(this.paces)) pace.end();
  }
}
