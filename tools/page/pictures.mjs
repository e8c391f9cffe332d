// Makes the pictures of the README: `node pictures.mjs BUNNY.neph [FOLDER]`.

import { mkdirSync } from "node:fs";
import { join, resolve } from "node:path";
import { launch } from "./test/browser.mjs";
import { view } from "./test/fixtures.mjs";
import { open, reach, settle } from "./test/looking.mjs";

const [file, folder = "../../docs/pictures"] = process.argv.slice(2);
const WHOLE = { width: 1240, height: 800 };
const SMALL = { width: 844, height: 620 };

/** Name, address, size and whether only the canvas is taken. */
const pictures = [
  ["beside", "#original=1&triangles=5000", WHOLE, false, "light"],
  ["deviation", "#colour=deviation&triangles=1500", SMALL, true, "light"],
  ["runs", "#colour=run&triangles=4000", SMALL, true, "light"],
  ["section", "#section=x%2B0.5&triangles=6000&camera=1.6,0.55,1.9,-0.2,0.05,0", SMALL, true, "light"],
  ["births", "#colour=birth&triangles=3000", SMALL, true, "dark"],
];

mkdirSync(folder, { recursive: true });
const [browser, server] = [await launch(), await view(resolve(file))];
for (const [name, hash, viewport, isCanvas, colorScheme] of pictures) {
  const { page, complaints, close } = await open(browser, server.url + hash, { viewport, colorScheme });
  await reach(page, "complete");
  if (hash.includes("deviation")) await page.getByText(/^largest /).waitFor();
  await page.waitForTimeout(1200);
  await settle(page);
  await (isCanvas ? page.locator("#viewport") : page).screenshot({ path: join(folder, `${name}.png`) });
  if (complaints.length) console.error(name, complaints);
  await close();
}
await browser.close();
await server.stop();
