// What cannot be shown is said on the page.

import assert from "node:assert/strict";
import { readFileSync, renameSync, rmSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { launch } from "./browser.mjs";
import { build, copy, exported, folder, view } from "./fixtures.mjs";
import { open, reach } from "./looking.mjs";
import { serveFolder } from "./server.mjs";

let browser, path, good;

before(async () => {
  path = build("ball", "sphere");
  good = readFileSync(path);
  browser = await launch();
});
after(() => browser.close());

/** What the page says of a file with these bytes. */
async function messageFor(bytes) {
  const site = exported("bad", path);
  writeFileSync(join(site, "files/ball.neph"), bytes);
  const server = await serveFolder(site);
  const { page, complaints, close } = await open(browser, server.url);
  await page.getByRole("alert").waitFor();
  const message = await page.getByRole("alert").innerText();
  assert.deepEqual(complaints.filter((complaint) => !complaint.includes("status of 4")), []);
  await close();
  await server.close();
  return message;
}

function changedAt(offset, ...bytes) {
  const changed = Buffer.from(good);
  changed.set(bytes, offset);
  return changed;
}

test("files that are none, are cut short or are damaged have a message each", async () => {
  const runs = offsetOf(7);
  for (const [bytes, expected] of [
    [Buffer.from("ply\nformat ascii 1.0\n".repeat(20)), /not a \.neph file/],
    [Buffer.alloc(0), /not a \.neph file/],
    [good.subarray(0, 100), /cut short/],
    [good.subarray(0, 4000), /cut short/],
    [good.subarray(0, good.length - 1), /cut short/],
    [Buffer.concat([good, Buffer.alloc(64)]), /damaged[^]*longer/],
    [changedAt(8, 9), /version 9/],
    [changedAt(48, 7), /neither triangles nor tetrahedra/],
    [changedAt(runs + 3, 255), /damaged[^]*runs/],
    [changedAt(offsetOf(8) + 3, 255), /damaged[^]*vertex/],
    [changedAt(offsetOf(5), 0, 0, 192, 127), /damaged[^]*position/],
    [changedAt(offsetOf(1), 0), /damaged[^]*JSON/],
  ]) {
    assert.match(await messageFor(bytes), expected);
  }
});

/** Where the section of a kind begins. */
function offsetOf(kind) {
  for (let at = 192; ; at += 32) if (good.readUInt32LE(at) === kind) return Number(good.readBigUInt64LE(at + 8));
}

test("a file that is replaced while it is viewed is told, and the picture stays", async () => {
  const live = join(folder, "live.neph");
  copy(path, live);
  const server = await view(live);
  const { page, close } = await open(browser, server.url);
  await reach(page, "complete");
  const other = build("other", "torus");
  renameSync(other, live);
  await page.getByRole("alert").waitFor();
  assert.match(await page.getByRole("alert").innerText(), /has changed while it was viewed/);
  assert.ok(await page.locator("#message").evaluate((message) => message.classList.contains("banner")));
  await page.getByRole("button", { name: "Load again" }).click();
  await reach(page, "complete");
  assert.equal(await page.getByRole("alert").isVisible(), false);
  await close();
  assert.equal(await server.stop(), 0);
});

test("a file that changes while it is read is told", async () => {
  const site = exported("slow", path);
  const server = await serveFolder(site, { delay: 150 });
  const { page, close } = await open(browser, server.url);
  await page.waitForFunction(() => document.documentElement.dataset.phase === "first");
  writeFileSync(join(site, "files/ball.neph"), good.subarray(0, good.length - 64));
  await page.getByRole("alert").waitFor();
  assert.match(await page.getByRole("alert").innerText(), /has changed|cut short/);
  await close();
  await server.close();
});

test("a server that is gone, and a file that is gone, are told", async () => {
  const gone = join(folder, "gone.neph");
  copy(path, gone);
  const server = await view(gone);
  rmSync(gone);
  const { page, close } = await open(browser, server.url);
  await page.getByRole("alert").waitFor();
  assert.match(await page.getByRole("alert").innerText(), /cannot be read[^]*404/);
  await server.stop();
  await close();

  // What is only read when it is wanted can fail later, and is told as well.
  const whole = await serveFolder(exported("whole", path));
  const { page: seen, close: closeSeen } = await open(browser, whole.url);
  await reach(seen, "complete");
  await whole.close();
  await seen.locator("#paint").selectOption("birth");
  await seen.getByRole("alert").waitFor();
  assert.match(await seen.getByRole("alert").innerText(), /cannot be read/);
  await closeSeen();

  const site = exported("stopping", path);
  const stopping = await serveFolder(site, { delay: 300 });
  const late = await open(browser, stopping.url);
  await late.page.waitForFunction(() => document.documentElement.dataset.phase === "opening");
  await stopping.close();
  await late.page.getByRole("alert").waitFor();
  assert.match(await late.page.getByRole("alert").innerText(), /cannot be read/);
  await late.close();
});
