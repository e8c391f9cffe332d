// The compact form of slots: each simplex once, slots laid out again in memory.

import { damaged } from "./failure.ts";

/** The sections of the compact form; numbers are of 2 or 4 bytes. */
export interface Compact {
  /** Corners of the distinct simplices. */
  distinct: Uint16Array | Uint32Array;
  /** A bit per slot, from the lowest of each byte, set where the simplex is one of an earlier slot. */
  repeatBits: Uint8Array;
  /** For each set bit a place among the distinct simplices. */
  repeatSources: Uint32Array;
}

/**
 * Lays out slots, `nCorners` indices each, into `indices`. Throws a `Failure` where a slot has no simplex or a simplex a vertex that is
 * not among `nVertices`.
 */
export function expand({ distinct, repeatBits, repeatSources }: Compact, nCorners: number, nVertices: number, indices: Uint32Array): void {
  let [nDistinct, nRepeats] = [0, 0];
  for (let slot = 0; slot * nCorners < indices.length; slot++) {
    const isRepeat = (repeatBits[slot >> 3] >> (slot & 7)) & 1;
    const place = isRepeat ? repeatSources[nRepeats++] : nDistinct++;
    if (!(place < nDistinct) || (place + 1) * nCorners > distinct.length) throw damaged(`Its slot ${slot} has no simplex`);
    for (let corner = 0; corner < nCorners; corner++) {
      const vertex = distinct[place * nCorners + corner];
      if (vertex >= nVertices) throw damaged(`One of its simplices names vertex ${vertex} of ${nVertices}`);
      indices[slot * nCorners + corner] = vertex;
    }
  }
}
