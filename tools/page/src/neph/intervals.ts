// Which parts of an array have arrived.

import type { Run } from "./levels.ts";

/** Disjoint half-open ranges, ascending, none touching the next. */
export class Intervals {
  private starts: number[] = [];
  private ends: number[] = [];

  /** Adds `start..end`, merging what it touches. */
  add(start: number, end: number): void {
    if (start >= end) return;
    // Those from `first` up to `last` touch the new one.
    const first = this.firstEndingFrom(start);
    let last = first;
    while (last < this.starts.length && this.starts[last] <= end) last++;
    if (last > first) {
      start = Math.min(start, this.starts[first]);
      end = Math.max(end, this.ends[last - 1]);
    }
    this.starts.splice(first, last - first, start);
    this.ends.splice(first, last - first, end);
  }

  /** Whether all of `start..end` is there. */
  covers(start: number, end: number): boolean {
    const at = this.firstEndingFrom(Math.min(start + 1, end));
    return start >= end || (at < this.starts.length && this.starts[at] <= start && end <= this.ends[at]);
  }

  /** What is missing of `start..end`, ascending. */
  missing(start: number, end: number): Run[] {
    const gaps = [];
    let from = start;
    for (let at = this.firstEndingFrom(start); at < this.starts.length && this.starts[at] < end; at++) {
      if (this.starts[at] > from) gaps.push({ start: from, length: this.starts[at] - from });
      from = Math.max(from, this.ends[at]);
    }
    if (from < end) gaps.push({ start: from, length: end - from });
    return gaps;
  }

  private firstEndingFrom(position: number): number {
    let [low, high] = [0, this.ends.length];
    while (low < high) {
      const middle = (low + high) >>> 1;
      if (this.ends[middle] >= position) high = middle;
      else low = middle + 1;
    }
    return low;
  }
}
