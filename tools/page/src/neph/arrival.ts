// In which order a file arrives: a coarse level first, then finer ones, then whatever else there is, and whatever is wanted in between.
//
// The naive order is that of the file, which has no picture before nearly all of it is there. The vertices of a level are a prefix and its
// simplices a few runs, so any level can come alone, and what it shares with the next need not come again.

import type { NephFile } from "./file.ts";
import { Intervals } from "./intervals.ts";
import type { Run } from "./levels.ts";

/** Part of the file that the first picture may take. */
const FIRST_PART = 0.02;
/** Simplices of the first picture at most: more would only delay it. */
const FIRST_COUNT = 30_000;
/** By how much each further picture is finer. */
const STEP = 4;
/** Largest part of the file that is read only because it lies between two wanted parts; saves a request. */
const GAP_PART = 1 / 2000;
/** Bytes of one request at most, so that something else can come in between soon. */
const MAX_REQUEST_BYTES = 1 << 21;
/** Requests under way at once; browsers allow six to one server. */
const N_REQUESTS = 4;

/** A part of the vertices or of the slots, in their own counts. */
export interface Piece {
  of: "vertices" | "slots";
  start: number;
  end: number;
}

export class Arrival {
  private readonly arrived = { vertices: new Intervals(), slots: new Intervals() };
  private readonly requested = { vertices: new Intervals(), slots: new Intervals() };
  private readonly stages: number[];
  private wanted: number | null = null;
  private hasStopped = false;
  /** Levels of which everything has arrived. */
  private readonly complete: Uint8Array;

  /** `onPiece` hears of every piece once it is in the arrays of the file. */
  constructor(
    private readonly file: NephFile,
    private readonly onPiece: (piece: Piece) => void,
  ) {
    this.stages = stages(file);
    this.complete = new Uint8Array(file.levels.length);
  }

  /** The level of the first picture. */
  get first(): number {
    return this.stages[0];
  }

  /** Reads the first picture alone; of a file of compact form, all simplices. */
  async readFirst(): Promise<void> {
    if (this.file.isCompact) {
      const all = { of: "slots", start: 0, end: this.file.head.nSlots } as const;
      this.requested.slots.add(all.start, all.end);
      await this.file.readCompact();
      this.hasArrived(all);
    }
    await this.readAll(() => this.nextOf(this.first));
  }

  /** Reads everything; throws a `Failure` with the first request that fails. */
  async readRest(): Promise<void> {
    await this.readAll(() => this.next());
  }

  /** Asks for a level before all others. */
  want(level: number): void {
    this.wanted = level;
  }

  /** Lets requests under way come to their end and asks for nothing more. */
  stop(): void {
    this.hasStopped = true;
  }

  isComplete(level: number): boolean {
    return this.complete[level] === 1;
  }

  /** The level to show for the one that is asked for: itself, the next coarser one that is there, else the next finer one; `null` for none. */
  best(level: number): number | null {
    for (let coarser = level; coarser < this.complete.length; coarser++) if (this.complete[coarser]) return coarser;
    for (let finer = level - 1; finer >= 0; finer--) if (this.complete[finer]) return finer;
    return null;
  }

  /** The finest level that is there. */
  get finest(): number | null {
    const level = this.complete.indexOf(1);
    return level < 0 ? null : level;
  }

  private async readAll(next: () => Piece | null): Promise<void> {
    const work = async () => {
      for (let piece = next(); piece && !this.hasStopped; piece = next()) {
        this.requested[piece.of].add(piece.start, piece.end);
        await this.read(piece);
      }
    };
    try {
      await Promise.all(Array.from({ length: N_REQUESTS }, work));
    } catch (error) {
      this.stop();
      throw error;
    }
  }

  private async read(piece: Piece): Promise<void> {
    if (piece.of === "vertices") await this.file.readVertices(piece.start, piece.end);
    else await this.file.readSlots(piece.start, piece.end);
    this.hasArrived(piece);
  }

  private hasArrived(piece: Piece): void {
    if (this.hasStopped) return;
    this.arrived[piece.of].add(piece.start, piece.end);
    for (let level = 0; level < this.complete.length; level++) {
      if (!this.complete[level] && this.hasAll(level)) this.complete[level] = 1;
    }
    this.onPiece(piece);
  }

  private hasAll(level: number): boolean {
    const { levels } = this.file;
    const { vertices, slots } = this.arrived;
    return (
      vertices.covers(0, levels.vertexCounts[level]) &&
      levels.runs(level).every(({ start, length }) => slots.covers(start, start + length))
    );
  }

  /** What to ask for next. */
  private next(): Piece | null {
    const levels = this.wanted === null ? this.stages : [this.wanted, ...this.stages];
    for (const level of levels) {
      const piece = this.nextOf(level);
      if (piece) return piece;
    }
    const [gap] = this.requested.slots.missing(0, this.file.head.nSlots);
    return gap ? this.piece("slots", gap) : null;
  }

  /** What to ask for next of one level. */
  private nextOf(level: number): Piece | null {
    const { levels, head, slotBytes } = this.file;
    const [vertices] = this.requested.vertices.missing(0, levels.vertexCounts[level]);
    if (vertices) return this.piece("vertices", vertices);
    const missing = levels.runs(level).flatMap(({ start, length }) => this.requested.slots.missing(start, start + length));
    if (missing.length === 0) return null;
    const largestGap = (head.fileBytes * GAP_PART) / slotBytes;
    const [{ start, length }, ...others] = missing;
    let end = start + length;
    for (const other of others) {
      if (other.start - end > largestGap) break;
      end = other.start + other.length;
    }
    return this.piece("slots", { start, length: end - start });
  }

  private piece(of: Piece["of"], { start, length }: Run): Piece {
    const bytes = of === "slots" ? this.file.slotBytes : 12;
    return { of, start, end: start + Math.min(length, Math.ceil(MAX_REQUEST_BYTES / bytes)) };
  }
}

/** Levels in the order in which they are read. */
function stages(file: NephFile): number[] {
  const { levels, head, slotBytes } = file;
  const bytes = (level: number) => levels.counts[level] * slotBytes + levels.vertexCounts[level] * 12;
  let level = levels.coarsest;
  const isSmall = (level: number) => bytes(level) <= FIRST_PART * head.fileBytes && levels.counts[level] <= FIRST_COUNT;
  while (level > 0 && isSmall(level - 1)) level--;
  const stages = [level];
  while (level > 0) {
    level = Math.min(level - 1, levels.atCount(STEP * levels.counts[level]));
    stages.push(level);
  }
  return stages;
}
