// Header and directory of a `.neph` file; formats/SPEC.md is the one home of the layout.

import { Failure, cutShort, damaged, notNeph } from "./failure.ts";

const MAGIC = [0x89, 0x4e, 0x45, 0x50, 0x48, 0x0d, 0x0a, 0x1a];
const HEADER_BYTES = 192;
const RECORD_BYTES = 32;
const MAX_SECTIONS = 506;

/** Kinds of sections that the page reads. */
export const Kind = {
  metadata: 1,
  errors: 2,
  simplexCounts: 3,
  vertexCounts: 4,
  positions: 5,
  runOffsets: 6,
  runs: 7,
  simplices: 8,
  stamps: 9,
  attributeTable: 10,
  attributeNames: 11,
  attributeValues: 12,
  checksums: 13,
  vertexBirths: 14,
  distinctSimplices: 15,
  repeatBits: 16,
  repeatSources: 17,
  compactStamps: 18,
} as const;

/** Where a section lies, in bytes from the start of the file. */
export interface Section {
  offset: number;
  bytes: number;
}

/** What the first bytes of a file say. Lengths are in mesh units, relative to `origin`. */
export interface Head {
  fileBytes: number;
  /** 3 for triangles, 4 for tetrahedra. */
  nCorners: number;
  nLevels: number;
  nVertices: number;
  nSlots: number;
  nLifetimes: number;
  origin: [number, number, number];
  boundsMin: [number, number, number];
  boundsMax: [number, number, number];
  sections: Map<number, Section>;
}

/** Bytes that always hold the head. */
export const MAX_HEAD_BYTES = 16384;

/** Reads the head of a file of `fileBytes`, if its length is known. Throws a `Failure` for any other file. */
export function parseHead(bytes: Uint8Array<ArrayBuffer>, fileBytes: number | null): Head {
  if (MAGIC.some((byte, at) => bytes[at] !== byte)) throw notNeph();
  if (bytes.length < HEADER_BYTES) throw cutShort(bytes.length, HEADER_BYTES);
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.length);
  const u32 = (at: number) => view.getUint32(at, true);
  const u64 = (at: number) => Number(view.getBigUint64(at, true));
  const version = u32(8);
  if (version !== 1) {
    throw new Failure(
      `The file has version ${version}, this page reads version 1`,
      "A newer `nephrite view` reads it, or build the file again with this one.",
    );
  }
  const head: Head = {
    fileBytes: u64(16),
    nCorners: u32(48),
    nLevels: u32(52),
    nVertices: u64(56),
    nSlots: u64(64),
    nLifetimes: u64(72),
    origin: [view.getFloat64(80, true), view.getFloat64(88, true), view.getFloat64(96, true)],
    boundsMin: [view.getFloat32(104, true), view.getFloat32(108, true), view.getFloat32(112, true)],
    boundsMax: [view.getFloat32(116, true), view.getFloat32(120, true), view.getFloat32(124, true)],
    sections: new Map(),
  };
  if (fileBytes !== null && fileBytes < head.fileBytes) throw cutShort(fileBytes, head.fileBytes);
  if (fileBytes !== null && fileBytes > head.fileBytes) throw damaged("It is longer than its header says");
  const nSections = u32(12);
  if (nSections > MAX_SECTIONS) throw damaged(`Its directory claims ${nSections} sections`);
  const end = HEADER_BYTES + nSections * RECORD_BYTES;
  if (bytes.length < end) throw cutShort(bytes.length, end);
  for (let at = HEADER_BYTES; at < end; at += RECORD_BYTES) {
    const [kind, flags, offset, length] = [u32(at), u32(at + 4), u64(at + 8), u64(at + 16)];
    const isKnown = (Object.values(Kind) as number[]).includes(kind);
    if (!isKnown && flags & 1) {
      throw new Failure("The file needs a newer page", `Its section of kind ${kind} may not be skipped. Use a newer \`nephrite view\`.`);
    }
    if (offset + length > head.fileBytes) throw damaged(`Its section of kind ${kind} reaches beyond its end`);
    head.sections.set(kind, { offset, bytes: length });
  }
  check(head);
  return head;
}

/** Whether slots are in the compact form, which is laid out in memory. */
export function isCompact(head: Head): boolean {
  return head.sections.has(Kind.distinctSimplices);
}

/** Bytes of a vertex index and of a stamp in the compact form. */
export function narrowBytes({ nVertices, nLevels }: Head): { index: 2 | 4; stamp: 2 | 4 } {
  return { index: nVertices <= 1 << 16 ? 2 : 4, stamp: nLevels < 1 << 16 ? 2 : 4 };
}

/** Kind, name and length of a section. */
type Expected = [kind: number, name: string, bytes: number];

function plainSections({ nCorners, nSlots }: Head): Expected[] {
  return [
    [Kind.simplices, "simplices", 4 * nCorners * nSlots],
    [Kind.stamps, "stamps", 4 * nSlots],
  ];
}

function compactSections(head: Head): Expected[] {
  const { index, stamp } = narrowBytes(head);
  const simplexBytes = index * head.nCorners;
  const nDistinct = Math.floor((head.sections.get(Kind.distinctSimplices)?.bytes ?? 0) / simplexBytes);
  return [
    [Kind.distinctSimplices, "distinct simplices", nDistinct * simplexBytes],
    [Kind.repeatBits, "repeat bits", 8 * Math.ceil(head.nSlots / 64)],
    [Kind.repeatSources, "repeat sources", 4 * (head.nSlots - nDistinct)],
    [Kind.compactStamps, "compact stamps", stamp * head.nSlots],
  ];
}

/** Holds the lengths of the sections against the counts. */
function check(head: Head): void {
  const { nCorners, nLevels, nVertices } = head;
  if (nCorners !== 3 && nCorners !== 4) {
    throw new Failure("The file holds neither triangles nor tetrahedra", `Its simplices have ${nCorners} corners.`);
  }
  const expected: Expected[] = [
    [Kind.errors, "errors", 8 * nLevels],
    [Kind.simplexCounts, "simplex counts", 4 * nLevels],
    [Kind.vertexCounts, "vertex counts", 4 * nLevels],
    [Kind.positions, "positions", 12 * nVertices],
    [Kind.runOffsets, "run offsets", 8 * (nLevels + 1)],
    ...(isCompact(head) ? compactSections(head) : plainSections(head)),
  ];
  for (const [kind, name, bytes] of expected) {
    const section = head.sections.get(kind);
    if (!section) throw damaged(`It has no section of ${name}`);
    if (section.bytes !== bytes) throw damaged(`Its section of ${name} has ${section.bytes} bytes, not ${bytes}`);
  }
  if (!head.sections.has(Kind.runs)) throw damaged("It has no section of runs");
  if (nLevels === 0) throw damaged("It has no level");
}
