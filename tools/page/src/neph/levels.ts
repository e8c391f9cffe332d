// The tables of a file: error, counts and runs of each level, and the queries over them.

import { damaged } from "./failure.ts";

/** A contiguous range of slots. */
export interface Run {
  start: number;
  length: number;
}

/** By how much the error must rise from a level to the next to be a leap; the paper uses 10 to 100. */
const INFLECTION_RATIO = 10;

/** Every level of a file. Level 0 is the input, the last the coarsest; errors never fall, counts never rise. */
export class Levels {
  /**
   * `errors.length` levels; the runs of level `l` are the pairs `runs[2 * r], runs[2 * r + 1]`, first slot and slots, for
   * `runOffsets[l] <= r < runOffsets[l + 1]`. Throws a `Failure` if they lead out of `nSlots` or are not as many as counted.
   */
  constructor(
    readonly errors: Float64Array,
    readonly counts: Uint32Array,
    readonly vertexCounts: Uint32Array,
    private readonly runOffsets: Float64Array,
    private readonly runTable: Uint32Array,
    nSlots: number,
  ) {
    for (let level = 0; level < this.length; level++) {
      let [end, counted] = [0, 0];
      for (const run of this.runs(level)) {
        if (run.start < end || run.start + run.length > nSlots) throw damaged(`The runs of its level ${level} lead nowhere`);
        end = run.start + run.length;
        counted += run.length;
      }
      if (counted !== counts[level]) throw damaged(`The runs of its level ${level} hold ${counted} of ${counts[level]} simplices`);
    }
  }

  get length(): number {
    return this.errors.length;
  }

  get coarsest(): number {
    return this.length - 1;
  }

  /** The ranges to draw for a level, ascending and apart. Cost: one object per run, about ten. */
  runs(level: number): Run[] {
    const runs = [];
    const end = Math.min(this.runOffsets[level + 1], this.runTable.length / 2);
    for (let run = this.runOffsets[level]; run < end; run++) {
      runs.push({ start: this.runTable[2 * run], length: this.runTable[2 * run + 1] });
    }
    return runs;
  }

  /** The coarsest level whose error is at most `error`; the finest where none is. */
  atError(error: number): number {
    return Math.max(0, this.firstWhere((level) => !(this.errors[level] <= error)) - 1);
  }

  /** The finest level of at most `count` simplices; the coarsest where none is. */
  atCount(count: number): number {
    return Math.min(this.coarsest, this.firstWhere((level) => this.counts[level] <= count));
  }

  /**
   * The error inflection points: levels before which all is well and after which the error leaps (W. J. Schroeder, "A topology
   * modifying progressive decimation algorithm", IEEE Visualization 1997, equation 6).
   */
  inflections(): number[] {
    const { errors } = this;
    return Array.from(errors.keys()).filter((level) => errors[level + 1] > INFLECTION_RATIO * errors[level]);
  }

  /** The first level for which `holds`, which holds for all levels after it; the number of levels if there is none. */
  private firstWhere(holds: (level: number) => boolean): number {
    let [low, high] = [0, this.length];
    while (low < high) {
      const middle = (low + high) >>> 1;
      if (holds(middle)) high = middle;
      else low = middle + 1;
    }
    return low;
  }
}
