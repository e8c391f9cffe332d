// Bundles the page: `node bundle.mjs [FOLDER]`. Nothing it writes refers to anything elsewhere.
import { build } from "esbuild";
import { copyFile, mkdir, readFile, writeFile } from "node:fs/promises";

const folder = process.argv[2] ?? "dist";

await mkdir(folder, { recursive: true });
await build({
  entryPoints: { page: "src/page.ts", worker: "src/worker.ts" },
  outdir: folder,
  bundle: true,
  format: "esm",
  target: "es2022",
  minify: true,
  legalComments: "none", // LICENSES.txt has them whole
  logLevel: "warning",
});
await build({ entryPoints: ["src/page.css"], outdir: folder, minify: true, logLevel: "warning" });
await copyFile("src/index.html", `${folder}/index.html`);

// What is bundled is used under these terms.
const bundled = ["three", "three-mesh-bvh"];
const licences = bundled.map(async (name) => {
  const { version } = JSON.parse(await readFile(`node_modules/${name}/package.json`, "utf8"));
  return `${name} ${version}\n\n${await readFile(`node_modules/${name}/LICENSE`, "utf8")}`;
});
await writeFile(`${folder}/LICENSES.txt`, (await Promise.all(licences)).join("\n\n"));
