// A `.neph` file that is being viewed: its tables at once, its vertices and simplices as they arrive.

import { expand } from "./compact.ts";
import { damaged } from "./failure.ts";
import { type Head, isCompact, Kind, MAX_HEAD_BYTES, narrowBytes, parseHead, type Section } from "./head.ts";
import { Levels } from "./levels.ts";
import { Reader } from "./reader.ts";

/** What the first request asks for: the head, and the tables of files with up to some 300 levels. */
const FIRST_BYTES = 2 * MAX_HEAD_BYTES;
const TABLES = [Kind.metadata, Kind.errors, Kind.simplexCounts, Kind.vertexCounts, Kind.runOffsets, Kind.runs];

/** What a file says about how it was made; every key may be missing. */
export interface Metadata {
  generator?: string;
  method?: string;
  bound?: string;
  /** Levels with fewer simplices carry an estimate, whatever the bound. */
  certified_simplices?: number | null;
}

export class NephFile {
  /** Indices of the vertices of every slot, `nCorners` each; those that have not arrived are 0. */
  readonly indices: Uint32Array<ArrayBuffer>;
  /** Coordinates of every vertex, 3 each; those that have not arrived are 0. */
  readonly positions: Float32Array<ArrayBuffer>;
  private birthsRead: Promise<Uint32Array<ArrayBuffer>> | null = null;

  private constructor(
    readonly reader: Reader,
    readonly head: Head,
    readonly metadata: Metadata,
    readonly levels: Levels,
  ) {
    this.indices = new Uint32Array(head.nSlots * head.nCorners);
    this.positions = new Float32Array(head.nVertices * 3);
  }

  /** Reads head and tables: one request, or two for files of very many levels. Throws a `Failure`. */
  static async open(url: string): Promise<NephFile> {
    const reader = new Reader(url);
    let bytes = await reader.read(0, FIRST_BYTES, true);
    const head = parseHead(bytes, reader.length);
    const sections = TABLES.flatMap((kind) => head.sections.get(kind) ?? []);
    const end = Math.max(...sections.map((section) => section.offset + section.bytes));
    if (end > bytes.length) {
      const rest = await reader.read(bytes.length, end);
      const all = new Uint8Array(end);
      all.set(bytes);
      all.set(rest, bytes.length);
      bytes = all;
    }
    const table = (kind: number): ArrayBuffer => {
      const { offset, bytes: length } = head.sections.get(kind) as Section;
      return bytes.buffer.slice(bytes.byteOffset + offset, bytes.byteOffset + offset + length);
    };
    const levels = new Levels(
      new Float64Array(table(Kind.errors)).map((error) => (error === Number.MAX_VALUE ? Infinity : error)),
      new Uint32Array(table(Kind.simplexCounts)),
      new Uint32Array(table(Kind.vertexCounts)),
      Float64Array.from(new BigUint64Array(table(Kind.runOffsets)), Number),
      new Uint32Array(table(Kind.runs)),
      head.nSlots,
    );
    return new NephFile(reader, head, parseMetadata(table(Kind.metadata)), levels);
  }

  /** Diagonal of the bounding box of all vertices. */
  get diagonal(): number {
    const { boundsMin, boundsMax } = this.head;
    return Math.hypot(...boundsMax.map((most, axis) => most - boundsMin[axis]));
  }

  /** Bytes of a slot in the file. */
  get slotBytes(): number {
    return 4 * this.head.nCorners;
  }

  /** Whether slots can only be read all at once. */
  get isCompact(): boolean {
    return isCompact(this.head);
  }

  /** Reads all slots of a file of compact form. */
  async readCompact(): Promise<void> {
    const { head } = this;
    const all = (kind: number) => this.readWithin(kind, 0, (head.sections.get(kind) as Section).bytes);
    const [distinct, bits, sources] = await Promise.all([Kind.distinctSimplices, Kind.repeatBits, Kind.repeatSources].map(all));
    const compact = {
      distinct: narrow(distinct, narrowBytes(head).index),
      repeatBits: new Uint8Array(bits),
      repeatSources: new Uint32Array(sources),
    };
    expand(compact, head.nCorners, head.nVertices, this.indices);
  }

  /** Vertices of each level: those born by then and not dead. Reads the births of vertices, if the file has any. */
  async readVertexCounts(): Promise<Uint32Array> {
    const { nVertices } = this.head;
    const { vertexCounts, length } = this.levels;
    if (!this.head.sections.has(Kind.vertexBirths)) return vertexCounts;
    const births = new Uint32Array(await this.readWithin(Kind.vertexBirths, 0, 4 * nVertices));
    // A vertex counts at the levels from its birth on that have it in their prefix; those are the ones before its death.
    const changes = new Int32Array(length + 1);
    let death = length;
    for (let vertex = 0; vertex < nVertices; vertex++) {
      while (death > 0 && vertexCounts[death - 1] <= vertex) death--;
      if (births[vertex] >= death) throw damaged(`Its vertex ${vertex} is born at level ${births[vertex]} and gone by ${death}`);
      changes[births[vertex]]++;
      changes[death]--;
    }
    let alive = 0;
    return Uint32Array.from({ length }, (_, level) => (alive += changes[level]));
  }

  /** Reads slots `start..end` into `indices`. */
  async readSlots(start: number, end: number): Promise<void> {
    const { nCorners, nVertices } = this.head;
    const indices = new Uint32Array(await this.readWithin(Kind.simplices, start * this.slotBytes, end * this.slotBytes));
    for (const index of indices) {
      if (index >= nVertices) throw damaged(`One of its simplices names vertex ${index} of ${nVertices}`);
    }
    this.indices.set(indices, start * nCorners);
  }

  /** Reads vertices `start..end` into `positions`. */
  async readVertices(start: number, end: number): Promise<void> {
    const positions = new Float32Array(await this.readWithin(Kind.positions, start * 12, end * 12));
    for (const position of positions) {
      if (!Number.isFinite(position)) throw damaged("One of its vertices has no finite position");
    }
    this.positions.set(positions, start * 3);
  }

  /** A copy of the indices of a level, for uses that need them in one piece. */
  cut(level: number): Uint32Array<ArrayBuffer> {
    const { nCorners } = this.head;
    const indices = new Uint32Array(this.levels.counts[level] * nCorners);
    let at = 0;
    for (const { start, length } of this.levels.runs(level)) {
      indices.set(this.indices.subarray(start * nCorners, (start + length) * nCorners), at);
      at += length * nCorners;
    }
    return indices;
  }

  /** The level at which each slot is born. Reads the stamps, once. */
  births(): Promise<Uint32Array<ArrayBuffer>> {
    const { nSlots } = this.head;
    const width = this.isCompact ? narrowBytes(this.head).stamp : 4;
    this.birthsRead ??= this.readWithin(this.isCompact ? Kind.compactStamps : Kind.stamps, 0, width * nSlots).then((bytes) =>
      this.birthsFrom(Uint32Array.from(narrow(bytes, width))),
    );
    return this.birthsRead;
  }

  /**
   * A slot of a birth list, and one of a single level, has its death for a stamp and is born where it first appears; a slot of a death
   * list has its birth. A level at which the slot is alive tells which: births are at most that, deaths above.
   */
  private birthsFrom(stamps: Uint32Array): Uint32Array<ArrayBuffer> {
    const births = Uint32Array.from(stamps);
    const seen = new Map<number, number>();
    for (let level = 0; level < this.levels.length; level++) {
      for (const { start, length } of this.levels.runs(level)) {
        const end = start + length;
        for (let slot = seen.get(start) ?? start; slot < end; slot++) {
          if (stamps[slot] > level) births[slot] = level;
        }
        seen.set(start, Math.max(end, seen.get(start) ?? start));
      }
    }
    return births;
  }

  private async readWithin(kind: number, start: number, end: number): Promise<ArrayBuffer> {
    const { offset } = this.head.sections.get(kind) as Section;
    return (await this.reader.read(offset + start, offset + end)).buffer;
  }
}

function narrow(bytes: ArrayBuffer, width: 2 | 4): Uint16Array | Uint32Array {
  return width === 2 ? new Uint16Array(bytes) : new Uint32Array(bytes);
}

function parseMetadata(bytes: ArrayBuffer): Metadata {
  try {
    const metadata: unknown = JSON.parse(new TextDecoder().decode(bytes));
    if (typeof metadata === "object" && metadata !== null) return metadata;
  } catch {
    // Told below.
  }
  throw damaged("What it says about itself is no JSON object");
}
