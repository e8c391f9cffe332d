// Tetrahedra as triangles: four faces of each to draw, of which the outer ones are seen.

/** Corners that a slot takes in the index buffer: one triangle, or the four faces of a tetrahedron. */
export function drawnCorners(nCorners: number): 3 | 12 {
  return nCorners === 4 ? 12 : 3;
}

/** Faces of a tetrahedron of positive volume, as seen from outside. */
const FACES = [0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3];

/** Writes the faces of the tetrahedra in slots `start..end` to their places among all faces. */
export function fillFaces(faces: Uint32Array, tetrahedra: Uint32Array, start: number, end: number): void {
  for (let slot = start; slot < end; slot++) {
    FACES.forEach((corner, index) => (faces[12 * slot + index] = tetrahedra[4 * slot + corner]));
  }
}

/** A plane through tetrahedra: triangles, and for each of their corners what shaders tell edges by. */
export interface Slice {
  positions: Float32Array<ArrayBuffer>;
  corners: Float32Array<ArrayBuffer>;
}

/** Cuts tetrahedra, four indices each, by the plane of points `p` with `normal . p = distance`. */
export function slice(tetrahedra: Uint32Array, vertices: Float32Array, normal: readonly number[], distance: number): Slice {
  const [positions, corners]: [number[], number[]] = [[], []];
  const height = (vertex: number) =>
    normal[0] * vertices[3 * vertex] + normal[1] * vertices[3 * vertex + 1] + normal[2] * vertices[3 * vertex + 2] - distance;
  for (let at = 0; at < tetrahedra.length; at += 4) {
    const tetrahedron = [0, 1, 2, 3].map((corner) => tetrahedra[at + corner]);
    const above = tetrahedron.filter((vertex) => height(vertex) > 0);
    const below = tetrahedron.filter((vertex) => !(height(vertex) > 0));
    const crossing = (a: number, b: number) => {
      const part = height(a) / (height(a) - height(b));
      return [0, 1, 2].map((axis) => vertices[3 * a + axis] + part * (vertices[3 * b + axis] - vertices[3 * a + axis]));
    };
    if (above.length === 2) {
      const [[a, b], [c, d]] = [above, below];
      const [p, q, r, s] = [crossing(a, c), crossing(a, d), crossing(b, d), crossing(b, c)];
      positions.push(...p, ...q, ...r, ...p, ...r, ...s);
      // The middle number never falls: the diagonal is no edge.
      corners.push(1, 1, 0, 0, 1, 0, 0, 1, 1, 1, 0, 1, 0, 0, 1, 0, 1, 1);
    } else if (above.length === 1 || above.length === 3) {
      const [[tip], others] = above.length === 1 ? [above, below] : [below, above];
      for (const other of others) positions.push(...crossing(tip, other));
      corners.push(1, 0, 0, 0, 1, 0, 0, 0, 1);
    }
  }
  return { positions: new Float32Array(positions), corners: new Float32Array(corners) };
}
