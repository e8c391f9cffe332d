// A first picture stands after a small part of the file, on servers of all kinds.

import assert from "node:assert/strict";
import { gzipSync } from "node:zlib";
import { readdirSync, readFileSync, statSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { launch } from "./browser.mjs";
import { build, exported, info } from "./fixtures.mjs";
import { drawn, open, pixels, reach, shown } from "./looking.mjs";
import { serveFolder } from "./server.mjs";

const DELAY_MS = 200;
let browser, folder, facts;

before(async () => {
  const path = build("ripple", "cosine", "--side", "120");
  facts = info(path);
  folder = exported("site", path);
  browser = await launch();
});
after(() => browser.close());

async function firstPicture(page) {
  return page.evaluate(() => {
    const [{ startTime, detail }] = performance.getEntriesByName("first picture");
    const list = performance.getEntriesByType("resource").find(({ name }) => name.endsWith("files.json"));
    return { ...detail, milliseconds: startTime - list.responseEnd };
  });
}

test("a server of 200 ms a request shows a picture after a few of them and a twentieth of the file", async () => {
  const server = await serveFolder(folder, { delay: DELAY_MS });
  const { page, complaints, close } = await open(browser, `${server.url}#level=0`);
  await page.waitForFunction(() => performance.getEntriesByName("first picture").length > 0);
  const first = await firstPicture(page);
  assert.ok(first.bytes <= 0.05 * facts.file_bytes, `${first.bytes} of ${facts.file_bytes} bytes`);
  assert.ok(first.requests <= 13, `${first.requests} requests, four at a time`);
  // Rounds of requests, and what a machine that draws in software beside other work needs for the picture itself.
  assert.ok(first.milliseconds < 5 * DELAY_MS + 3000, `${first.milliseconds} ms`);
  assert.ok(drawn(await pixels(page)) > 0.1);
  await reach(page, "complete");
  assert.equal(await shown(page, "triangles"), facts.triangles_in);
  const ranges = server.requests.map(({ range }) => range);
  assert.ok(ranges.every((range) => /^bytes=\d+-\d+$/.test(range)), "single ranges only");
  assert.equal(new Set(ranges).size, ranges.length, "nothing is asked for twice");
  assert.deepEqual(complaints, []);
  await close();
  await server.close();
});

test("a server that ignores ranges is read once, from the beginning", async () => {
  const server = await serveFolder(folder, { ignoresRanges: true, bytesPerSecond: 3e6 });
  const { page, complaints, close } = await open(browser, server.url);
  await reach(page, "complete");
  assert.equal(server.requests.length, 1);
  assert.ok(drawn(await pixels(page)) > 0.1);
  assert.deepEqual(complaints, []);
  await close();
  await server.close();
});

test("the page is below a megabyte, compressed", () => {
  const names = readdirSync(folder).filter((name) => statSync(join(folder, name)).isFile());
  const bytes = names.reduce((sum, name) => sum + gzipSync(readFileSync(join(folder, name))).length, 0);
  assert.ok(bytes < 1e6, `${bytes} bytes`);
  for (const name of names.filter((name) => /\.(js|css|html)$/.test(name))) {
    const loads = readFileSync(join(folder, name), "utf8").match(/(?:src|href)="https?:|url\(["']?https?:|import\(?["']https?:/g);
    assert.equal(loads, null, `${name} loads from elsewhere`);
  }
});
