// The panel beside the canvas: what is asked for, and what is seen.

import type { Levels } from "../neph/levels.ts";
import { type Paint, RAMP } from "../scene/shaders.ts";
import type { Stage } from "../scene/stage.ts";
import type { Axis, Selection, State } from "../state.ts";
import type { Viewing } from "../viewing.ts";
import { button, element, input, select } from "./dom.ts";
import { bytes, count, significant, time } from "./figures.ts";
import { runColor } from "../scene/figure.ts";

const SLIDER_END = 1000;
/** Queries are timed together for so long: clocks of browsers are coarse. */
const TIMED_MS = 2;
const N_TIMED = 200;

export type Change = (change: Partial<State>) => void;

/** Lets every control say what it changes. */
export function initPanel(viewing: () => Viewing | null, state: () => State, change: Change): void {
  const ask = (selection: Selection) => change({ selection });
  input("error-slider").addEventListener("input", () => {
    const file = viewing()?.file;
    if (file) ask({ by: "error", value: errorAt(file.levels, Number(input("error-slider").value)) });
  });
  input("error-box").addEventListener("change", () => {
    const value = positive("error-box");
    const diagonal = viewing()?.file.diagonal;
    if (value !== null && diagonal) ask({ by: "error", value: state().unit === "percent" ? (value / 100) * diagonal : value });
  });
  input("triangles-box").addEventListener("change", () => {
    const value = positive("triangles-box");
    if (value !== null) ask({ by: "triangles", value });
  });
  const askPixels = () => {
    const value = positive("pixels-box");
    if (input("pixels-on").checked && value) ask({ by: "pixels", value });
  };
  input("pixels-on").addEventListener("change", () => {
    const { level } = viewing() ?? {};
    if (input("pixels-on").checked) askPixels();
    else if (level !== undefined) ask({ by: "level", value: level });
  });
  input("pixels-box").addEventListener("change", () => {
    input("pixels-on").checked = true;
    askPixels();
  });
  select("unit").addEventListener("change", () => change({ unit: select("unit").value as State["unit"] }));
  select("paint").addEventListener("change", () => change({ paint: select("paint").value as Paint }));
  for (const radio of document.querySelectorAll<HTMLInputElement>("input[name=shading]")) {
    radio.addEventListener("change", () => change({ isSmooth: radio.value === "smooth" }));
  }
  const toggles = { edges: "hasEdges", split: "isSplit", morph: "isMorphing", up: "isZUp" } as const;
  for (const [id, key] of Object.entries(toggles)) {
    input(id).addEventListener("change", () => change({ [key]: input(id).checked }));
  }
  initSection(state, change);
}

function initSection(state: () => State, change: Change): void {
  select("section-axis").addEventListener("change", () => {
    const axis = select("section-axis").value as Axis | "";
    change({ section: axis ? { axis, at: 0.5, isFlipped: false } : null });
  });
  input("section-at").addEventListener("input", () => {
    const { section } = state();
    if (section) change({ section: { ...section, at: Number(input("section-at").value) / SLIDER_END } });
  });
  button("section-flip").addEventListener("click", () => {
    const { section } = state();
    if (section) change({ section: { ...section, isFlipped: !section.isFlipped } });
  });
}

/** Shows on every control what is so. */
export function showState(state: State, viewing: Viewing | null): void {
  select("unit").value = state.unit;
  select("paint").value = state.paint;
  for (const radio of document.querySelectorAll<HTMLInputElement>("input[name=shading]")) {
    radio.checked = (radio.value === "smooth") === state.isSmooth;
  }
  input("edges").checked = state.hasEdges;
  input("split").checked = state.isSplit;
  input("morph").checked = state.isMorphing;
  input("up").checked = viewing?.isZUp ?? false;
  select("section-axis").value = state.section?.axis ?? "";
  input("section-at").disabled = !state.section;
  button("section-flip").disabled = !state.section;
  if (state.section) input("section-at").value = String(Math.round(state.section.at * SLIDER_END));
  const { by } = state.selection;
  for (const ask of document.querySelectorAll<HTMLElement>(".ask")) ask.classList.toggle("chosen", ask.dataset.by === by);
  input("pixels-on").checked = by === "pixels";
  if (by === "pixels") setUnlessTyping("pixels-box", String(state.selection.value));
}

/** Shows the level that is seen, in all its figures. */
export function showLevel(viewing: Viewing, state: State, stage: Stage): void {
  const { file, seen } = viewing;
  const level = seen ?? viewing.level;
  const { levels, diagonal } = file;
  const [error, n] = [levels.errors[level], levels.counts[level]];
  const runs = levels.runs(level).length;
  output("triangles", count(n), n);
  const share = (100 * n) / levels.counts[0];
  element("share").textContent = viewing.isWaiting
    ? `while ${count(levels.counts[viewing.level])} are on their way`
    : `${share === 100 ? "all" : `${significant(share, 3)} %`} of the original's ${count(levels.counts[0])}`;
  const percent = (length: number) => (diagonal > 0 ? (100 * length) / diagonal : 0);
  output("stated", state.unit === "percent" ? `${significant(percent(error))} %` : significant(error), error);
  // What the words promise depends on the bound, and on the level where the topology was changed.
  const { bound, certified_simplices: leastCertified } = file.metadata;
  const isProven = bound === "certified" && n >= (leastCertified ?? 0);
  element("error-name").textContent = isProven ? "proven error" : "stated error";
  element("stated").title = `${significant(error, 6)} mesh units, ${significant(percent(error), 6)} % of the diagonal`;
  const pixels = stage.pixelsOf(error);
  output("on-screen", `≤ ${significant(pixels, 2)} px`, pixels);
  output("level", `${level} of ${levels.coarsest}`, level);
  output("vertices", count(viewing.vertexCounts[level]), viewing.vertexCounts[level]);
  output("runs", String(runs), runs);
  const asked = state.selection.by === "error" ? state.selection.value : levels.errors[viewing.level];
  setUnlessTyping("error-box", significant(state.unit === "percent" ? percent(asked) : asked, 5));
  const budget = state.selection.by === "triangles" ? state.selection.value : levels.counts[viewing.level];
  setUnlessTyping("triangles-box", String(budget));
  const slider = input("error-slider");
  slider.value = String(sliderAt(levels, asked));
  slider.setAttribute("aria-valuetext", `${significant(percent(asked))} % of the diagonal, ${count(n)} simplices`);
}

/** Shows how long a query of this level takes, measured now. */
export function showQueryTime({ file, level, stepMs }: Viewing): void {
  const { levels } = file;
  const error = levels.errors[level];
  let [found, n, elapsed] = [0, 0, 0];
  const start = performance.now();
  do {
    for (let query = 0; query < N_TIMED; query++) found += levels.runs(levels.atError(error)).length;
    n += N_TIMED;
    elapsed = performance.now() - start;
  } while (elapsed < TIMED_MS);
  output("query", found > 0 ? time(elapsed / n) : "–", stepMs);
  element("query").title = `The last change of level took ${time(stepMs)}, with everything but drawing.`;
}

/** Shows what is being viewed. */
export function showFacts(name: string, { file }: Viewing): void {
  const { head, levels, metadata } = file;
  element("name").textContent = name;
  element("name").title = name;
  const facts = [`${count(levels.length)} levels`, bytes(head.fileBytes), metadata.method];
  element("facts").textContent = facts.filter(Boolean).join(" · ");
  document.title = `${name} – nephrite`;
  const simplices = head.nCorners === 4 ? "tetrahedra" : "triangles";
  element("simplex-name").textContent = simplices;
  element("budget-name").textContent = `${simplices} at most`;
  element("curve-title").textContent = `Error against ${simplices}`;
  // Both ask for the nearest points of a surface.
  for (const control of [select("paint").querySelector<HTMLOptionElement>("option[value=deviation]"), input("morph")]) {
    if (control) control.disabled = head.nCorners === 4;
  }
}

/** Shows how much of the file is here. */
export function showArrival({ file }: Viewing, isDone: boolean): void {
  const loading = element("loading");
  const percent = isDone ? 100 : Math.min(100, (100 * file.reader.bytesRead) / file.head.fileBytes);
  (loading.firstElementChild as HTMLElement).style.width = `${percent}%`;
  loading.setAttribute("aria-valuenow", percent.toFixed(0));
  loading.classList.toggle("done", isDone);
}

/** Shows what the colours mean. */
export function showLegend(viewing: Viewing, state: State): void {
  const legend = element("legend");
  legend.hidden = state.paint === "plain" || (viewing.isVolume && state.paint === "deviation");
  if (legend.hidden) return;
  const { levels, diagonal } = viewing.file;
  const length = (length: number) =>
    state.unit === "percent" ? `${significant((100 * length) / (diagonal || 1), 3)} %` : significant(length, 3);
  const level = viewing.seen ?? viewing.level;
  const nRuns = levels.runs(level).length;
  const found = viewing.largestDeviation;
  const [least, most] = viewing.span(level);
  const words: Record<Exclude<Paint, "plain">, [string, string, string, string]> = {
    deviation: [
      "From the original's vertices to this level",
      "0",
      found === null ? (viewing.arrival.isComplete(0) ? "measuring" : "when all is here") : `largest ${length(found)}`,
      length(most),
    ],
    level: ["The level at which a vertex leaves", String(least), "", String(most)],
    birth: ["The level at which a triangle is born", "0 (the input)", "", String(most)],
    run: [`${nRuns} runs: each a range of the one index buffer`, "1", "", String(nRuns)],
  };
  const ids = ["legend-title", "legend-least", "legend-note", "legend-most"];
  words[state.paint as Exclude<Paint, "plain">].forEach((text, index) => (element(ids[index]).textContent = text));
  const ramp = RAMP.map((color) => `rgb(${color.join(" ")})`);
  const blocks = Array.from({ length: nRuns }, (_, run) => {
    const color = runColor(run).getStyle();
    return `${color} ${(100 * run) / nRuns}% ${(100 * (run + 1)) / nRuns}%`;
  });
  element("legend-bar").style.background = `linear-gradient(90deg, ${(state.paint === "run" ? blocks : ramp).join(", ")})`;
}

/** The error at a place of the slider: none at its start, then even steps of the logarithm up to the coarsest level. */
function errorAt(levels: Levels, position: number): number {
  const [least, most] = ends(levels);
  return position === 0 ? levels.errors[0] : least * (most / least) ** (position / SLIDER_END);
}

function sliderAt(levels: Levels, error: number): number {
  const [least, most] = ends(levels);
  if (!(error > least) || most <= least) return error >= most && most > 0 && levels.length === 1 ? SLIDER_END : 0;
  return Math.round(SLIDER_END * Math.min(1, Math.log(error / least) / Math.log(most / least)));
}

/** The least error above none, and the largest that is finite. */
function ends({ errors }: Levels): [number, number] {
  const most = errors.findLast(Number.isFinite) ?? 0;
  const least = errors.find((error) => error > 0) ?? 1;
  return most > 0 ? [least, most] : [1, 1];
}

function positive(id: string): number | null {
  const value = input(id).valueAsNumber;
  return Number.isFinite(value) && value >= 0 ? value : null;
}

function setUnlessTyping(id: string, value: string): void {
  if (document.activeElement !== input(id)) input(id).value = value;
}

function output(id: string, text: string, value: number): void {
  const output = element(id);
  output.textContent = text;
  output.dataset.value = String(value);
}
