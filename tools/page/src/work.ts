// What the page asks of its worker, and what it gets.

import type { Slice } from "./scene/tetrahedra.ts";

/** Angle-weighted normals of the vertices that some triangles use; those of all others are zero. */
export interface NormalsJob {
  kind: "normals";
  positions: Float32Array<ArrayBuffer>;
  indices: Uint32Array<ArrayBuffer>;
}

/** The vertices that later jobs name. */
export interface VerticesJob {
  kind: "vertices";
  positions: Float32Array<ArrayBuffer>;
}

/**
 * For each vertex that `from` uses and `onto` does not, the nearest point of the surface of the triangles `onto`. All other vertices stay.
 */
export interface LandJob {
  kind: "land";
  from: Uint32Array<ArrayBuffer>;
  onto: Uint32Array<ArrayBuffer>;
  /** Stands for the triangles of `onto`: what was built for them may serve again. */
  level: number;
}

/** A plane through tetrahedra, four indices each. */
export interface SliceJob {
  kind: "slice";
  tetrahedra: Uint32Array<ArrayBuffer>;
  normal: readonly number[];
  distance: number;
}

export type Job = NormalsJob | VerticesJob | LandJob | SliceJob;

export interface Normals {
  normals: Float32Array<ArrayBuffer>;
}

export interface Landed {
  /** Where each vertex comes to lie, 3 coordinates each. */
  positions: Float32Array<ArrayBuffer>;
  /** How far that is, per vertex. */
  distances: Float32Array<ArrayBuffer>;
  /** The largest of them. */
  largest: number;
}

/** `null` where a newer job of the same kind took the place of this one. */
export type Result<J extends Job> = J extends NormalsJob ? Normals : J extends LandJob ? Landed | null : J extends SliceJob ? Slice : null;
