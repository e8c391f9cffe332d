// The page shows what the program says, and moving a slider moves no buffer.

import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { launch } from "./browser.mjs";
import { build, info, nephrite, view } from "./fixtures.mjs";
import { UNLIKE, difference, drawn, open, pixels, pixelsUnlike, reach, settle, shown, type } from "./looking.mjs";

let browser, server, path, facts;

before(async () => {
  path = build("ripple", "cosine", "--side", "80");
  facts = info(path);
  [browser, server] = [await launch(), await view(path)];
});
after(async () => {
  await browser.close();
  assert.equal(await server.stop(), 0, "Ctrl-C is how a server ends");
});

/** Opens the page and waits until all of the file is there. */
async function opened(hash = "", options = {}) {
  const looking = await open(browser, server.url + hash, options);
  await reach(looking.page, "complete");
  return looking;
}

async function checkLevel(page, level, how) {
  const expected = facts.curve[level];
  await settle(page);
  assert.equal(await shown(page, "level"), level, how);
  assert.equal(await shown(page, "triangles"), expected.triangles, how);
  assert.equal(await shown(page, "vertices"), expected.vertices, how);
  assert.equal(await shown(page, "stated"), expected.error, how);
}

test("numbers are those of `nephrite info`, whichever way a level is asked for", async () => {
  const { page, complaints, asked, close } = await opened();
  const last = facts.curve.length - 1;
  for (const level of [0, 1, Math.floor(last / 3), Math.floor(last / 2), last]) {
    await type(page, "triangles-box", facts.curve[level].triangles);
    await checkLevel(page, facts.curve.findIndex(({ triangles }) => triangles <= facts.curve[level].triangles), "by triangles");
  }
  await page.locator("#unit").selectOption("mesh");
  for (const level of [Math.floor(last / 4), Math.floor((2 * last) / 3)]) {
    const error = facts.curve[level].error * (1 + 1e-9);
    await type(page, "error-box", error);
    await checkLevel(page, facts.curve.findLastIndex((point) => point.error <= error), "by error");
  }
  const slider = page.locator("#error-slider");
  await slider.fill("1000");
  await checkLevel(page, last, "slider at its end");
  await slider.fill("0");
  await checkLevel(page, 0, "slider at its start");
  assert.equal(await page.locator("#right-label").isVisible(), false);
  assert.deepEqual(complaints, []);
  const elsewhere = asked.filter((url) => !url.startsWith(server.url) && !url.startsWith("data:"));
  assert.deepEqual(elsewhere, [], "the page asks nobody else for anything");
  await close();
});

test("two levels are two pictures, and neither is blank", async () => {
  const { page, close } = await opened("#edges=0&level=0");
  const fine = await pixels(page);
  await page.locator("#error-slider").fill("1000");
  const coarse = await pixels(page);
  assert.ok(drawn(fine) > 0.03 && drawn(coarse) > 0.03, `${drawn(fine)} ${drawn(coarse)} are drawn`);
  assert.ok(difference(fine, coarse) > 0.02, `only ${difference(fine, coarse)} differs`);
  await close();
});

test("the slider uploads no buffer, and a level is drawn as its runs", async () => {
  const { page, close } = await opened("#edges=0&level=3");
  await settle(page);
  await page.evaluate(() => (globalThis.watched.uploads.length = 0));
  for (let position = 0; position <= 1000; position += 50) {
    await page.evaluate(() => (globalThis.watched.draws.length = 0));
    await page.locator("#error-slider").fill(String(position));
    await settle(page);
    const [triangles, runs] = [await shown(page, "triangles"), await shown(page, "runs")];
    const draws = (await page.evaluate(() => globalThis.watched.draws)).slice(-runs);
    assert.equal(draws.reduce((sum, { count }) => sum + count, 0), 3 * triangles, `at ${position}`);
    assert.ok(runs <= Math.ceil(Math.log2(facts.levels)) + 1);
  }
  assert.deepEqual(await page.evaluate(() => globalThis.watched.uploads), []);
  await close();
});

test("a step of the slider costs the engine less than 0.2 ms", async () => {
  const { page, close } = await opened("#edges=0");
  const times = [];
  for (let position = 0; position <= 1000; position += 40) {
    await page.locator("#error-slider").fill(String(position));
    await settle(page);
    await page.waitForTimeout(1);
    times.push(await page.evaluate(() => performance.getEntriesByName("level").at(-1)?.duration ?? 0));
  }
  const median = times.sort((a, b) => a - b)[times.length >> 1];
  assert.ok(median < 0.2, `${median} ms`);
  await close();
});

test("every way of colouring, shading and cutting is another picture", async () => {
  // Coarse enough for its facets to be seen.
  const level = facts.curve.findIndex(({ triangles }) => triangles <= 60);
  const { page, complaints, close } = await opened(`#edges=0&level=${level}`);
  const pictures = { plain: await pixels(page) };
  for (const paint of ["level", "birth", "run", "deviation"]) {
    await page.locator("#paint").selectOption(paint);
    if (paint === "deviation") await page.getByText(/^largest /).waitFor();
    pictures[paint] = await pixelsUnlike(page, pictures.plain);
  }
  await page.locator("#paint").selectOption("plain");
  await page.locator("#edges").check();
  pictures.edges = await pixels(page);
  await page.locator("#edges").uncheck();
  await page.getByRole("radio", { name: "smooth" }).check();
  pictures.smooth = await pixelsUnlike(page, pictures.plain);
  await page.locator("#section-axis").selectOption("x");
  pictures.section = await pixels(page);
  await page.locator("#split").check();
  pictures.split = await pixels(page);
  const names = Object.keys(pictures);
  for (const [index, name] of names.entries()) {
    for (const other of names.slice(0, index)) {
      const part = difference(pictures[name], pictures[other]);
      assert.ok(part > UNLIKE, `${name} and ${other} differ in ${part}`);
    }
  }
  assert.deepEqual(complaints, []);
  await close();
});

test("the deviation that is measured is within what the level states", async () => {
  const level = Math.floor(facts.curve.length * 0.6);
  const { page, close } = await opened(`#colour=deviation&unit=mesh&level=${level}`);
  const note = await page.getByText(/^largest /).textContent();
  const found = Number(note.split(" ")[1]);
  const { error } = facts.curve[level];
  // The page shows three digits.
  assert.ok(found <= error * 1.005 && found > error * 0.3, `${found} of ${error}`);
  await close();
});

test("keys act, and the address holds what is seen", async () => {
  const { page, close } = await opened("#level=7");
  await page.keyboard.press("ArrowRight");
  await checkLevel(page, 8, "one coarser");
  await page.keyboard.press("PageDown");
  await checkLevel(page, 18, "ten coarser");
  await page.keyboard.press("End");
  await checkLevel(page, facts.curve.length - 1, "the coarsest");
  await page.keyboard.press("Home");
  for (const key of ["o", "s", "w", "x", "g"]) await page.keyboard.press(key);
  await page.mouse.move(300, 300);
  await page.mouse.wheel(0, -300);
  await page.waitForTimeout(600);
  const hash = await page.evaluate(() => location.hash);
  for (const word of ["level=0", "original=1", "shading=smooth", "edges=0", "section=x", "flow=1", "camera="]) {
    assert.ok(hash.includes(word), `${hash} has no ${word}`);
  }
  const again = await opened(hash);
  await checkLevel(again.page, 0, "from the address");
  assert.equal(await again.page.locator("#split").isChecked(), true);
  assert.equal(await again.page.locator("#edges").isChecked(), false);
  assert.ok(difference(await pixels(page), await pixels(again.page)) < 0.02, "the same address is the same picture");
  await close();
  await again.close();
});

test("a camera that comes closer brings finer levels", async () => {
  const { page, close } = await opened("#pixels=2");
  const far = await shown(page, "level");
  assert.ok((await shown(page, "on-screen")) <= 2);
  await page.mouse.move(300, 300);
  for (let notch = 0; notch < 10; notch++) {
    await page.mouse.wheel(0, -240);
    await page.waitForTimeout(60);
  }
  await page.waitForTimeout(500);
  assert.ok((await shown(page, "level")) < far);
  assert.ok((await shown(page, "on-screen")) <= 2);
  await close();
});

test("a sweep passes over levels, flowing too", async () => {
  for (const flow of ["0", "1"]) {
    const { page, complaints, close } = await opened(`#level=0&flow=${flow}`);
    await page.keyboard.press(" ");
    await page.waitForFunction(() => Number(document.getElementById("level").dataset.value) > 3, null, { timeout: 20_000 });
    await page.keyboard.press(" ");
    assert.equal(await page.locator("#play").getAttribute("aria-pressed"), "false");
    assert.deepEqual(complaints, []);
    await close();
  }
});

test("a click on the curve goes to the level there", async () => {
  const { page, close } = await opened("#level=0");
  const { x, y, width, height } = await page.locator("#curve").boundingBox();
  await page.mouse.click(x + width * 0.4, y + height * 0.5);
  await settle(page);
  const level = await shown(page, "level");
  assert.ok(level > 3 && level < facts.curve.length - 1, `level ${level}`);
  await close();
});

test("a picture can be saved", async () => {
  const { page, close } = await opened("#level=12");
  const [download] = await Promise.all([page.waitForEvent("download"), page.keyboard.press("p")]);
  assert.equal(download.suggestedFilename(), "ripple-level-12.png");
  await close();
});

test("narrow or wide, light or dark: every control has a name, fits and can be read", async () => {
  for (const [width, colorScheme] of [[390, "light"], [390, "dark"], [1280, "light"], [1280, "dark"]]) {
    const { page, complaints, close } = await opened("#colour=run", { viewport: { width, height: 800 }, colorScheme });
    const nameless = await page.evaluate(() =>
      [...document.querySelectorAll("button, input, select, canvas:not([aria-hidden])")]
        .filter((control) => !control.closest("[hidden], dialog"))
        .filter((control) => !(control.getAttribute("aria-label") || control.textContent.trim() || control.labels?.[0]?.textContent.trim()))
        .map((control) => control.id),
    );
    assert.deepEqual(nameless, []);
    const wide = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
    assert.ok(wide <= 0, `${wide} pixels too wide at ${width}`);
    const cut = await page.evaluate(() => {
      const right = document.getElementById("panel").getBoundingClientRect().right;
      return [...document.querySelectorAll("#panel *")].filter((part) => part.getBoundingClientRect().right > right + 0.5).map((part) => part.id || part.className || part.tagName);
    });
    assert.deepEqual(cut, [], `at ${width}`);
    assert.deepEqual(await page.evaluate(faint), [], colorScheme);
    assert.deepEqual(complaints, []);
    await close();
  }
});

/** Runs in the page: texts whose contrast with what is behind them is below 4.5 (WCAG 2, 1.4.3). */
function faint() {
  const canvas = document.createElement("canvas").getContext("2d", { willReadFrequently: true });
  const rgba = (color) => {
    canvas.clearRect(0, 0, 1, 1);
    canvas.fillStyle = color;
    canvas.fillRect(0, 0, 1, 1);
    return [...canvas.getImageData(0, 0, 1, 1).data];
  };
  const luminance = (color) => {
    const [r, g, b] = color.map((byte) => (byte / 255 <= 0.04045 ? byte / 255 / 12.92 : ((byte / 255 + 0.055) / 1.055) ** 2.4));
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const behind = (element) => {
    for (let at = element; at; at = at.parentElement) {
      const color = rgba(getComputedStyle(at).backgroundColor);
      if (color[3] > 200) return color;
    }
    return [255, 255, 255];
  };
  const texts = document.querySelectorAll("#panel h1, #panel h2, #panel p, #panel dt, #panel dd, #panel label, #panel span, #panel button, #panel select, #panel kbd, #panel a, #legend *");
  return [...texts]
    .filter((text) => text.textContent.trim() && text.checkVisibility())
    .filter((text) => {
      const [a, b] = [luminance(rgba(getComputedStyle(text).color)), luminance(behind(text))];
      return (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05) < 4.5;
    })
    .map((text) => text.textContent.trim().slice(0, 30));
}

test("a volume shows its boundary, and what a section cuts", async () => {
  nephrite("generate", "ball", "--cells", "8", "-o", "volume.vtu");
  nephrite("build", "volume.vtu", "-o", "volume.neph");
  const { curve } = info("volume.neph");
  const own = await view("volume.neph");
  const { page, complaints, close } = await open(browser, `${own.url}#level=2`);
  await reach(page, "complete");
  assert.equal(await shown(page, "triangles"), curve[2].tetrahedra ?? curve[2].triangles);
  assert.equal(await shown(page, "vertices"), curve[2].vertices);
  assert.equal(await page.locator("#simplex-name").textContent(), "tetrahedra");
  const boundary = await pixels(page);
  assert.ok(drawn(boundary) > 0.05);
  await page.locator("#section-axis").selectOption("z");
  await page.waitForTimeout(500);
  const cut = await pixels(page);
  assert.ok(difference(boundary, cut) > 0.05, `${difference(boundary, cut)} differs`);
  await page.locator("#paint").selectOption("birth");
  await page.waitForTimeout(200);
  assert.ok(difference(cut, await pixels(page)) > 0.0);
  assert.deepEqual(complaints, []);
  await close();
  assert.equal(await own.stop(), 0);
});

test("several files are a gallery", async () => {
  const second = build("ball", "sphere");
  const both = await view(path, second);
  const { page, complaints, close } = await open(browser, both.url);
  await reach(page, "complete");
  await page.getByRole("button", { name: "ball" }).click();
  await reach(page, "complete");
  assert.equal(await page.locator("#name").textContent(), "ball");
  await page.waitForFunction(() =>
    [...document.querySelectorAll("#gallery canvas")].every((canvas) =>
      canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data.some((byte) => byte > 0),
    ),
  );
  await page.keyboard.press("[");
  await page.waitForFunction(() => document.getElementById("name").textContent === "ripple");
  assert.deepEqual(complaints, []);
  await close();
  assert.equal(await both.stop(), 0);
});
