// A page in the browser, watched while it is used.

import { readFileSync } from "node:fs";
import { join } from "node:path";
import { inflateSync } from "node:zlib";

/** Opens an address; all that the page complains of, asks for and uploads is written down. */
export async function open(browser, url, options = {}) {
  const context = await browser.newContext({ viewport: { width: 900, height: 560 }, ...options });
  const page = await context.newPage();
  const complaints = [];
  page.on("console", (message) => {
    if (["error", "warning"].includes(message.type())) complaints.push(message.text());
  });
  page.on("pageerror", (error) => complaints.push(String(error)));
  const asked = [];
  page.on("request", (request) => asked.push(request.url()));
  await page.addInitScript(watchUploads);
  await page.goto(url);
  return { page, complaints, asked, close: () => context.close() };
}

/** Runs in the page, before it: notes uploads and draws. */
function watchUploads() {
  const log = (globalThis.watched = { uploads: [], draws: [] });
  const { prototype } = WebGL2RenderingContext;
  for (const name of ["bufferData", "bufferSubData"]) {
    const original = prototype[name];
    prototype[name] = function (target, ...rest) {
      log.uploads.push({ name, isIndex: target === this.ELEMENT_ARRAY_BUFFER });
      return original.call(this, target, ...rest);
    };
  }
  const original = prototype.drawElements;
  prototype.drawElements = function (mode, count, type, offset) {
    log.draws.push({ count, offset });
    return original.call(this, mode, count, type, offset);
  };
}

/** Waits until the page says of itself that it is so far: `first`, `complete` or `failed`. */
export async function reach(page, phase, timeout = 60_000) {
  await page.waitForFunction((phase) => document.documentElement.dataset.phase === phase, phase, { timeout });
}

/** The number behind what the page shows. */
export async function shown(page, id) {
  return Number(await page.locator(`#${id}`).getAttribute("data-value"));
}

/** Types a number into a box, as a person does. */
export async function type(page, id, value) {
  await page.locator(`#${id}`).fill(String(value));
  await page.locator(`#${id}`).press("Enter");
}

/** Waits for the picture that belongs to what was asked for. */
export async function settle(page) {
  await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
}

/** The canvas as pixels: width, height and three or four bytes each. */
export async function pixels(page) {
  await settle(page);
  return decode(await page.locator("#canvas").screenshot());
}

/** The part of all pixels in which two pictures differ visibly. */
export function difference(a, b) {
  let n = 0;
  const { channels } = a;
  for (let at = 0; at < a.bytes.length; at += channels) {
    const most = Math.max(...[0, 1, 2].map((channel) => Math.abs(a.bytes[at + channel] - b.bytes[at + channel])));
    if (most > 12) n++;
  }
  return (n * channels) / a.bytes.length;
}

/** Pictures that differ in this part of all pixels or more are other pictures. */
export const UNLIKE = 0.002;

/** The canvas once it is visibly unlike `other`, or as it is after five seconds: births and normals arrive some frames later. */
export async function pixelsUnlike(page, other) {
  for (let waited = 0; waited < 5000; waited += 100) {
    const picture = await pixels(page);
    if (difference(picture, other) > UNLIKE) return picture;
    await page.waitForTimeout(100);
  }
  return pixels(page);
}

/** The part of all pixels that are not as the one in the lower left corner. */
export function drawn(picture) {
  const { bytes, width, channels } = picture;
  const corner = { ...picture, bytes: new Uint8Array(bytes.length) };
  const lowest = bytes.length - width * channels;
  for (let at = 0; at < bytes.length; at++) corner.bytes[at] = bytes[lowest + (at % channels)];
  return difference(picture, corner);
}

/** Decodes a PNG of eight bits per channel, which is all that browsers write. */
function decode(png) {
  const parts = [];
  let [width, height, channels] = [0, 0, 0];
  for (let at = 8; at < png.length; ) {
    const [length, kind] = [png.readUInt32BE(at), png.toString("latin1", at + 4, at + 8)];
    const data = png.subarray(at + 8, at + 8 + length);
    if (kind === "IHDR") [width, height, channels] = [data.readUInt32BE(0), data.readUInt32BE(4), data[9] === 6 ? 4 : 3];
    if (kind === "IDAT") parts.push(data);
    at += 12 + length;
  }
  const rows = inflateSync(Buffer.concat(parts));
  const [stride, bytes] = [width * channels, new Uint8Array(width * height * channels)];
  for (let row = 0; row < height; row++) {
    const filter = rows[row * (stride + 1)];
    for (let at = 0; at < stride; at++) {
      const [to, left] = [row * stride + at, at >= channels ? bytes[row * stride + at - channels] : 0];
      const above = row > 0 ? bytes[to - stride] : 0;
      const corner = row > 0 && at >= channels ? bytes[to - stride - channels] : 0;
      const guesses = [0, left, above, (left + above) >> 1, paeth(left, above, corner)];
      bytes[to] = rows[row * (stride + 1) + 1 + at] + guesses[filter];
    }
  }
  return { width, height, channels, bytes };
}

function paeth(left, above, corner) {
  const estimate = left + above - corner;
  const [a, b, c] = [left, above, corner].map((value) => Math.abs(estimate - value));
  return a <= b && a <= c ? left : b <= c ? above : corner;
}

export const read = (...names) => readFileSync(join(...names));
