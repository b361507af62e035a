// Meshes: corners and polygons as they stand in this file (see mesh.rs), and from them the vertices of the shaders.

// A column of whole numbers: differences in bytes of 7 bits. Returns the numbers and the place after them.
function column(bytes, at, count) {
  const order = bytes[at++];
  const values = new Int32Array(count);
  for (let i = 0; i < count; i++) {
    let value = 0;
    for (let shift = 0; ; shift += 7) {
      const byte = bytes[at++];
      value |= (byte & 0x7f) << shift;
      if (byte < 0x80) break;
    }
    values[i] = (value >>> 1) ^ -(value & 1);
  }
  for (let k = 0; k < order; k++) {
    for (let i = 1; i < count; i++) values[i] += values[i - 1];
  }
  return [values, at];
}

class Mesh {
  constructor(header, bytes) {
    let at = header.at;
    const next = (count) => {
      const [values, after] = column(bytes, at, count);
      at = after;
      return values;
    };
    const vectors = (count, step) => {
      const [x, y, z] = [next(count), next(count), next(count)];
      return Array.from(x, (_, i) => [x[i] * step, y[i] * step, z[i] * step]);
    };
    this.positions = vectors(header.vertices, header.step);
    const counts = next(header.polygons);
    const places = [0, 1, 2, 3].map(() => next(header.polygons));
    this.polygons = Array.from(counts, (count, i) => {
      let corner = 0;
      return Array.from({ length: count }, (_, place) => (corner += places[place][i]));
    });
    this.closed = header.closed;
    this.tangents = header.tangents ? vectors(header.polygons, 1).map(unit) : null;
    // Not by arguments of a function: a browser takes about 100 000 of them.
    this.radius = this.positions.reduce((most, p) => Math.max(most, length(p)), 0);
  }

  // The triangles of a polygon, as places in its list of corners.
  static triangles(polygon) {
    return polygon.length === 4 ? [0, 1, 2, 0, 2, 3] : polygon.length === 3 ? [0, 1, 2] : [];
  }

  // The normal of a polygon: Newell's sum over its edges.
  normal(polygon) {
    const [first, ...others] = polygon.map((i) => this.positions[i]);
    let sum = [0, 0, 0];
    for (let i = 1; i < others.length; i++) {
      sum = add(sum, cross(subtract(others[i - 1], first), subtract(others[i], first)));
    }
    return unit(sum);
  }

  centre(polygon) {
    return scale(polygon.map((i) => this.positions[i]).reduce(add), 1 / polygon.length);
  }

  // The normals of the vertices: the means of those of their polygons; and so the tangents, which count little where
  // the polygons disagree.
  get smooth() {
    if (this.kept) return this.kept;
    const zero = () => this.positions.map(() => [0, 0, 0]);
    const faceNormals = this.polygons.map((polygon) => this.normal(polygon));
    const [normals, tangents, counts] = [zero(), zero(), this.positions.map(() => 0)];
    this.polygons.forEach((polygon, p) => {
      for (const corner of polygon) {
        normals[corner] = add(normals[corner], faceNormals[p]);
        if (this.tangents) tangents[corner] = add(tangents[corner], this.tangents[p]);
        counts[corner] += 1;
      }
    });
    const agreed = tangents.map((sum, i) => {
      const agreement = length(sum) / Math.max(counts[i], 1);
      return scale(unit(sum), agreement >= 0.75 ? 1 : agreement >= 1e-3 ? 1e-3 : 0);
    });
    this.kept = { normals: normals.map(unit), tangents: agreed, faceNormals };
    return this.kept;
  }

  // The hierarchy of its triangles as words of rows; zero if it is not closed.
  get body() {
    this.keptBody ??= this.closed ? new Hierarchy(this).words : new Uint32Array(4 * ROWS_ACROSS);
    return this.keptBody;
  }

  // The places of the corners of all triangles in the list of vertices; `first` counts the corners of polygons before.
  indices(placed) {
    const count = this.polygons.reduce((sum, polygon) => sum + Mesh.triangles(polygon).length, 0);
    const indices = new Uint32Array(count);
    let at = 0;
    let first = 0;
    for (const polygon of this.polygons) {
      for (const i of Mesh.triangles(polygon)) indices[at++] = placed(polygon, i, first);
      first += polygon.length;
    }
    return indices;
  }

  // Vertices that polygons share: position, normal, tangent.
  get shared() {
    const { normals, tangents } = this.smooth;
    const vertices = new Float32Array(9 * this.positions.length);
    this.positions.forEach((p, i) => {
      [p, normals[i], tangents[i]].forEach((vector, k) => vertices.set(vector, 9 * i + 3 * k));
    });
    return { vertices, indices: this.indices((polygon, i) => polygon[i]), attributes: 3 };
  }

  // Vertices that know their polygon: also its normal, tangent and centre.
  get faces() {
    const { normals, tangents, faceNormals } = this.smooth;
    const corners = this.polygons.reduce((sum, polygon) => sum + polygon.length, 0);
    const vertices = new Float32Array(18 * corners);
    let at = 0;
    this.polygons.forEach((polygon, p) => {
      const own = [faceNormals[p], this.tangents ? this.tangents[p] : [0, 0, 0], this.centre(polygon)];
      for (const i of polygon) {
        for (const vector of [this.positions[i], normals[i], tangents[i], ...own]) {
          vertices.set(vector, at);
          at += 3;
        }
      }
    });
    return { vertices, indices: this.indices((polygon, i, first) => first + i), attributes: 6 };
  }
}

