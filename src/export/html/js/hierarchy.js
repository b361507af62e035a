// The hierarchy of boxes around the triangles of a mesh, for rays inside solid bodies: the twin of src/shape/hierarchy, whose
// mod.rs has the layout of its rows, and build.rs the sources. It is built here, as it would be the largest part of this file.

// Rows side by side in a texture.
const ROWS_ACROSS = 1024;
const NO_CHILD = 0xffffffff;
const LEAF = 0x80000000;
const COUNT_SHIFT = 28;
// Triangles of a leaf, at most.
const MOST_OF_LEAF = 4;
// Splits from the root to a leaf, at most: two for each of twelve levels.
const MOST_SPLITS = 24;
const BINS = 16;
// The cost of a split, relative to that of a triangle.
const SPLIT_COST = 2;
// By how much boxes are larger than their triangles, relative to the size of the mesh.
const BOX_MARGIN = 4e-6;

// Boxes: the least x, y and z, and the greatest. So many of them, empty, one after the other.
function emptyBoxes(count) {
  const boxes = new Float32Array(6 * count).fill(Infinity);
  for (let i = 3; i < boxes.length; i += 6) boxes.fill(-Infinity, i, i + 3);
  return boxes;
}

// Makes the box at a place large enough for another one.
function include(boxes, at, others, other) {
  for (let k = 0; k < 3; k++) {
    if (others[other + k] < boxes[at + k]) boxes[at + k] = others[other + k];
    if (others[other + 3 + k] > boxes[at + 3 + k]) boxes[at + 3 + k] = others[other + 3 + k];
  }
}

// Half the area; 0 if it is empty.
function areaOf(box) {
  const [x, y, z] = [box[3] - box[0], box[4] - box[1], box[5] - box[2]];
  return x < 0 ? 0 : x * y + y * z + z * x;
}

class Hierarchy {
  constructor(mesh) {
    const { positions, polygons } = mesh;
    // Three vertices, and the polygon; no ray meets a triangle with two corners in one place.
    this.triangles = [];
    const apart = (a, b) => positions[a].some((x, k) => x !== positions[b][k]);
    polygons.forEach((polygon, p) => {
      const places = Mesh.triangles(polygon);
      for (let i = 0; i < places.length; i += 3) {
        const [a, b, c] = places.slice(i, i + 3).map((place) => polygon[place]);
        if (apart(a, b) && apart(b, c) && apart(c, a)) this.triangles.push([a, b, c, p]);
      }
    });
    const count = this.triangles.length;
    this.boxes = emptyBoxes(count);
    // Boxes of one point: twice the centres of those.
    this.centres = new Float32Array(6 * count);
    const corner = new Float32Array(6);
    this.triangles.forEach((triangle, i) => {
      for (let place = 0; place < 3; place++) {
        corner.set(positions[triangle[place]]);
        corner.copyWithin(3, 0, 3);
        include(this.boxes, 6 * i, corner, 0);
      }
      for (let k = 0; k < 6; k++) this.centres[6 * i + k] = this.boxes[6 * i + (k % 3)] + this.boxes[6 * i + 3 + (k % 3)];
    });
    // The triangles in the order of the leaves.
    this.order = Uint32Array.from({ length: count }, (_, i) => i);
    this.margin = BOX_MARGIN * this.boxes.reduce((most, x) => Math.max(most, Math.abs(x)), 0);
    this.nodes = [];
    this.add(this.part(0, count, MOST_SPLITS), MOST_SPLITS);
    this.words = this.rowsOf(mesh);
  }

  // The box around triangles, or around their centres.
  bounds(from, to, boxes) {
    const box = emptyBoxes(1);
    for (let i = from; i < to; i++) include(box, 0, boxes, 6 * this.order[i]);
    return box;
  }

  // Triangles that belong together, sorted for division, with the place of it: 0 for a leaf.
  part(from, to, splits) {
    return { from, to, middle: this.split(from, to, splits) };
  }

  split(from, to, splits) {
    const count = to - from;
    if (count < 2 || splits === 0) return 0;
    const centres = this.bounds(from, to, this.centres);
    const best = this.best(from, to, centres);
    if (!best) return count > MOST_OF_LEAF ? this.halve(from, to, centres) : 0;
    const whole = count > MOST_OF_LEAF ? Infinity : (count - SPLIT_COST) * areaOf(this.bounds(from, to, this.boxes));
    if (best.cost >= whole) return 0;
    let middle = from;
    for (let i = from; i < to; i++) {
      const triangle = this.order[i];
      if (this.bin(triangle, best.axis, centres, best.bins) >= best.bin) continue;
      this.order[i] = this.order[middle];
      this.order[middle++] = triangle;
    }
    // At most so many on each side leave splits enough for all.
    const room = MOST_OF_LEAF * 2 ** (splits - 1);
    return Math.max(middle - from, to - middle) <= room ? middle : this.halve(from, to, centres);
  }

  // Sorts triangles into two halves along the longest axis.
  halve(from, to, centres) {
    const sizes = [0, 1, 2].map((axis) => centres[3 + axis] - centres[axis]);
    const axis = sizes.indexOf(Math.max(...sizes));
    this.order.subarray(from, to).sort((a, b) => this.centres[6 * a + axis] - this.centres[6 * b + axis]);
    return (from + to) >> 1;
  }

  // The bin of a triangle along an axis, by the box around all centres.
  bin(triangle, axis, centres, bins) {
    const at = (this.centres[6 * triangle + axis] - centres[axis]) / (centres[3 + axis] - centres[axis]);
    return Math.min(bins - 1, Math.floor(at * bins));
  }

  // The best place to divide, by the area of the boxes on both sides; null if all centres are in one place.
  best(from, to, centres) {
    const bins = Math.min(BINS, to - from);
    let best = null;
    for (let axis = 0; axis < 3; axis++) {
      if (centres[axis] === centres[3 + axis]) continue;
      const boxes = emptyBoxes(bins);
      const counts = new Uint32Array(bins);
      for (let i = from; i < to; i++) {
        const bin = this.bin(this.order[i], axis, centres, bins);
        include(boxes, 6 * bin, this.boxes, 6 * this.order[i]);
        counts[bin] += 1;
      }
      // The cost of the bins from each to the last one.
      const after = new Float32Array(bins);
      let [box, count] = [emptyBoxes(1), 0];
      for (let bin = bins - 1; bin > 0; bin--) {
        include(box, 0, boxes, 6 * bin);
        count += counts[bin];
        after[bin] = count * areaOf(box);
      }
      [box, count] = [emptyBoxes(1), 0];
      for (let bin = 1; bin < bins; bin++) {
        include(box, 0, boxes, 6 * (bin - 1));
        count += counts[bin - 1];
        const cost = count * areaOf(box) + after[bin];
        if (count > 0 && count < to - from && (!best || cost < best.cost)) best = { cost, axis, bin, bins };
      }
    }
    return best;
  }

  // Adds a node with everything below it; returns its number.
  add(part, splits) {
    const number = this.nodes.length;
    const node = new Uint32Array(28);
    const numbers = new Float32Array(node.buffer);
    this.nodes.push(node);
    node.fill(NO_CHILD, 24);
    const halves = ({ from, to, middle }, left) =>
      middle ? [this.part(from, middle, left), this.part(middle, to, left)] : [{ from, to, middle }];
    const parts = halves(part, splits - 1).flatMap((half) => halves(half, splits - 2));
    parts.filter(({ from, to }) => to > from).forEach((child, i) => {
      const box = this.bounds(child.from, child.to, this.boxes);
      for (let k = 0; k < 6; k++) numbers[4 * k + i] = box[k] + (k < 3 ? -this.margin : this.margin);
      const leaf = LEAF + (child.to - child.from - 1) * 2 ** COUNT_SHIFT + child.from;
      node[24 + i] = child.middle ? this.add(child, splits - 2) : leaf;
    });
    return number;
  }

  // The rows, up to the end of those side by side.
  rowsOf(mesh) {
    const { normals, faceNormals } = mesh.smooth;
    const count = this.triangles.length;
    const triangles = 2 + 7 * this.nodes.length;
    const corners = triangles + 3 * count;
    const begins = [2, triangles, corners, corners + count];
    const rows = begins[3] + normals.length;
    const words = new Uint32Array(4 * ROWS_ACROSS * Math.ceil(rows / ROWS_ACROSS));
    const numbers = new Float32Array(words.buffer);
    words.set([...begins, this.nodes.length, count, normals.length]);
    this.nodes.forEach((node, i) => words.set(node, 4 * (2 + 7 * i)));
    this.order.forEach((triangle, i) => {
      const [a, b, c, polygon] = this.triangles[triangle];
      const vectors = [...[a, b, c].map((vertex) => mesh.positions[vertex]), faceNormals[polygon]];
      for (let axis = 0; axis < 3; axis++) {
        numbers.set(vectors.map((vector) => vector[axis]), 4 * (triangles + 3 * i + axis));
      }
      words.set(this.triangles[triangle], 4 * (corners + i));
    });
    normals.forEach((normal, i) => numbers.set(normal, 4 * (begins[3] + i)));
    return words;
  }
}

