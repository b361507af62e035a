// The object under a place on the picture: the nearest triangle that the ray meets from outside.

function pick(scene, origin, direction) {
  let nearest = Infinity;
  let found = null;
  for (const thing of scene.things) {
    const m = thing.matrix;
    const place = m.slice(12, 15);
    const columns = [m.slice(0, 3), m.slice(4, 7), m.slice(8, 11)];
    const squared = dot(columns[0], columns[0]);
    const mesh = scene.meshes[thing.mesh];
    // Into the coordinates of the object, which is scaled equally in all directions.
    const inside = (v) => columns.map((column) => dot(column, v) / squared);
    const [o, d] = [inside(subtract(origin, place)), inside(direction)];
    const past = Math.sqrt(Math.max(0, dot(o, o) - dot(o, d) ** 2 / dot(d, d)));
    if (past > mesh.radius) continue;
    for (const polygon of mesh.polygons) {
      const corners = Mesh.triangles(polygon).map((i) => mesh.positions[polygon[i]]);
      for (let i = 0; i < corners.length; i += 3) {
        const t = meets(o, d, corners[i], corners[i + 1], corners[i + 2]);
        if (t < nearest) [nearest, found] = [t, thing];
      }
    }
  }
  return found;
}

// The distance to a triangle along a ray, in lengths of the ray's direction (T. Möller, B. Trumbore 1997).
function meets(o, d, a, b, c) {
  const [ab, ac] = [subtract(b, a), subtract(c, a)];
  const p = cross(d, ac);
  const determinant = dot(ab, p);
  if (determinant <= 0) return Infinity;
  const s = subtract(o, a);
  const u = dot(s, p) / determinant;
  const q = cross(s, ab);
  const v = dot(d, q) / determinant;
  const t = dot(ac, q) / determinant;
  return u >= 0 && v >= 0 && u + v <= 1 && t > 0 ? t : Infinity;
}

