// Files to look at, made by the program itself.

import { execFileSync, spawn } from "node:child_process";
import { cpSync, mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { fileURLToPath } from "node:url";

/** The program: named in the variable NEPHRITE, or the one that `cargo build` leaves. */
const PROGRAM = resolve(process.env.NEPHRITE ?? fileURLToPath(new URL("../../../target/debug/nephrite", import.meta.url)));

export const folder = mkdtempSync(join(tmpdir(), "nephrite-page-"));
process.on("exit", () => rmSync(folder, { recursive: true, force: true }));

export function nephrite(...words) {
  return execFileSync(PROGRAM, words, { cwd: folder, encoding: "utf8" });
}

/** Builds the levels of a surface from a formula; returns the path of the file. */
export function build(name, kind, ...options) {
  nephrite("generate", kind, ...options, "-o", `${name}.ply`);
  nephrite("build", `${name}.ply`, "-o", `${name}.neph`);
  return join(folder, `${name}.neph`);
}

/** What `nephrite info` says of a file. */
export function info(path) {
  return JSON.parse(nephrite("info", path, "--json"));
}

/** Starts `nephrite view`; `url` is its address, `stop` presses Ctrl-C and tells how it ended. */
export async function view(...words) {
  const child = spawn(PROGRAM, ["view", "--no-open", "--json", ...words], { cwd: folder, stdio: ["ignore", "pipe", "inherit"] });
  const line = await new Promise((resolve, reject) => {
    child.stdout.once("data", (data) => resolve(String(data)));
    child.once("exit", (status) => reject(new Error(`the server ended with ${status}`)));
  });
  const stop = () =>
    new Promise((resolve) => {
      child.once("exit", (status, signal) => resolve(signal ?? status));
      child.kill("SIGINT");
    });
  return { url: JSON.parse(line).url, stop };
}

/** A folder with the page and copies of files, as `nephrite view --export` writes it. */
export function exported(name, ...files) {
  nephrite("view", "--export", name, ...files);
  return join(folder, name);
}

export function copy(from, to) {
  cpSync(from, to);
}
