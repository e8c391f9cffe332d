// The parts of the page that need no browser, against the obvious way to do the same.

import assert from "node:assert/strict";
import { build as bundle } from "esbuild";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { fileURLToPath, pathToFileURL } from "node:url";
import { build, exported, folder, nephrite } from "./fixtures.mjs";
import { serveFolder } from "./server.mjs";

let parts, server;

before(async () => {
  const source = ["neph/intervals", "neph/file", "neph/arrival", "state"].map((name) => `export * from "./src/${name}.ts";`).join("\n");
  const outfile = join(folder, "parts.mjs");
  await bundle({ stdin: { contents: source, resolveDir: fileURLToPath(new URL("..", import.meta.url)) }, outfile, bundle: true, format: "esm", platform: "node" });
  parts = await import(pathToFileURL(outfile));
  server = await serveFolder(exported("parts", build("torus", "torus")));
});
after(() => server.close());

/** Numbers that look random and are always the same (a linear congruential generator). */
function random(seed) {
  return (below) => {
    seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0;
    return Math.floor((seed / 2 ** 32) * below);
  };
}

test("intervals are sets of numbers", () => {
  const next = random(1);
  for (let round = 0; round < 300; round++) {
    const [intervals, set] = [new parts.Intervals(), new Array(40).fill(false)];
    for (let step = 0; step < 12; step++) {
      const start = next(40);
      const end = Math.min(40, start + next(8));
      intervals.add(start, end);
      set.fill(true, start, Math.max(start, end));
      const from = next(40);
      const to = Math.min(40, from + next(20));
      assert.equal(intervals.covers(from, to), set.slice(from, to).every(Boolean), `${from}..${to} of ${set}`);
      const missing = intervals.missing(from, to).flatMap(({ start, length }) => Array.from({ length }, (_, index) => start + index));
      assert.deepEqual(missing, [...set.keys()].filter((at) => at >= from && at < to && !set[at]));
    }
  }
});

test("every level arrives whole, and births are the levels at which triangles first are there", async () => {
  const file = await parts.NephFile.open(`${server.url}files/torus.neph`);
  const arrival = new parts.Arrival(file, () => {});
  await arrival.readFirst();
  assert.ok(arrival.isComplete(arrival.first));
  await arrival.readRest();
  const births = await file.births();
  let before = new Set();
  for (let level = 0; level < file.levels.length; level++) {
    assert.ok(arrival.isComplete(level), `level ${level}`);
    const [now, born] = [new Set(), new Set()];
    for (const { start, length } of file.levels.runs(level)) {
      for (let slot = start; slot < start + length; slot++) {
        const triangle = file.indices.subarray(3 * slot, 3 * slot + 3).join();
        now.add(triangle);
        if (births[slot] === level) born.add(triangle);
        assert.ok(births[slot] <= level);
      }
    }
    assert.equal(now.size, file.levels.counts[level]);
    assert.deepEqual([...born].sort(), [...now].filter((triangle) => !before.has(triangle)).sort(), `level ${level}`);
    before = now;
  }
});

test("a file of compact form is the same file", async () => {
  nephrite("build", "torus.ply", "-o", "compact.neph", "--compact");
  const compact = await serveFolder(exported("compact", join(folder, "compact.neph")));
  const files = await Promise.all([`${server.url}files/torus.neph`, `${compact.url}files/compact.neph`].map(parts.NephFile.open));
  for (const file of files) {
    const arrival = new parts.Arrival(file, () => {});
    await arrival.readFirst();
    await arrival.readRest();
  }
  const [plain, other] = files;
  assert.ok(other.isCompact && other.head.fileBytes < plain.head.fileBytes);
  assert.deepEqual(other.indices, plain.indices);
  assert.deepEqual(other.positions, plain.positions);
  assert.deepEqual(await other.births(), await plain.births());
  await compact.close();
});

test("queries find the level that a search through all of them finds", async () => {
  const { levels } = await parts.NephFile.open(`${server.url}files/torus.neph`);
  const errors = [...levels.errors];
  for (const error of [-1, 0, ...errors, ...errors.map((error) => error * 1.0001), Infinity, NaN]) {
    assert.equal(levels.atError(error), Math.max(0, errors.findLastIndex((stated) => stated <= error)));
  }
  assert.equal(levels.inflections()[0], errors.lastIndexOf(0), "no error, then some, is the first leap");
  for (const level of levels.inflections()) assert.ok(errors[level + 1] > 10 * errors[level]);
  for (const count of [0, 1, ...levels.counts, ...levels.counts.map((count) => count + 1), 1e9]) {
    const first = [...levels.counts].findIndex((n) => n <= count);
    assert.equal(levels.atCount(count), first < 0 ? levels.coarsest : first);
  }
});

test("an address says the whole state, and nonsense in it says nothing", () => {
  const state = {
    ...parts.INITIAL,
    file: "a b&c=d",
    selection: { by: "error", value: 0.0125 },
    unit: "mesh",
    paint: "birth",
    isSmooth: true,
    hasEdges: false,
    isSplit: true,
    isMorphing: true,
    isZUp: false,
    section: { axis: "z", at: 0.25, isFlipped: true },
    camera: [1, -2.5, 3, 0, 0.125, 0],
    theme: "dark",
  };
  assert.deepEqual(parts.fromHash(`#${parts.toHash(state)}`), state);
  assert.deepEqual(parts.fromHash(`#${parts.toHash({ ...state, section: { axis: "x", at: 1, isFlipped: false } })}`).section, { axis: "x", at: 1, isFlipped: false });
  assert.equal(parts.toHash(parts.INITIAL), "");
  for (const nonsense of ["level=-1", "error=x", "colour=constructor", "section=w+2", "camera=1,2,3", "camera=1,2,3,4,5,x", "%%%", "theme=blue"]) {
    assert.deepEqual(parts.fromHash(`#${nonsense}`), parts.INITIAL, nonsense);
  }
});
