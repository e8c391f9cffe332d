// What the page shows, and how the address says it.

import type { CameraPlace } from "./scene/stage.ts";
import { type Paint, PAINTS } from "./scene/shaders.ts";

/** What decides the level: the same four ways as the program's, lengths in mesh units. */
export interface Selection {
  by: "error" | "triangles" | "level" | "pixels";
  value: number;
}

export type Axis = "x" | "y" | "z";
export type Theme = "light" | "dark";

export interface State {
  /** Name of the file, empty for the first. */
  file: string;
  selection: Selection;
  unit: "percent" | "mesh";
  paint: Paint;
  isSmooth: boolean;
  hasEdges: boolean;
  isSplit: boolean;
  isMorphing: boolean;
  /** `null`: as the shape of the surface suggests. */
  isZUp: boolean | null;
  /** A plane across an axis, at a part of the extent from 0 to 1; `isFlipped` keeps the other side. */
  section: { axis: Axis; at: number; isFlipped: boolean } | null;
  camera: CameraPlace | null;
  theme: Theme | null;
}

/** Where nothing is said, a level of so many triangles, or of this part of the input's where that is fewer: coarse enough to be seen as one. */
const FIRST_TRIANGLES = 5000;
const FIRST_PART = 1 / 8;

/** The selection to begin with for an input of so many triangles, if the address says none. */
export function firstSelection({ selection }: State, nTriangles: number): Selection {
  if (selection !== INITIAL.selection) return selection;
  return { by: "triangles", value: Math.max(1, Math.min(FIRST_TRIANGLES, Math.round(FIRST_PART * nTriangles))) };
}

export const INITIAL: Readonly<State> = {
  file: "",
  selection: { by: "triangles", value: FIRST_TRIANGLES },
  unit: "percent",
  paint: "plain",
  isSmooth: false,
  hasEdges: true,
  isSplit: false,
  isMorphing: false,
  isZUp: null,
  section: null,
  camera: null,
  theme: null,
};

const SELECTIONS = ["error", "triangles", "level", "pixels"] as const;
const AXES = ["x", "y", "z"] as const;

/** The part of an address after `#`, without what is as at the start. */
export function toHash(state: State): string {
  const words = new URLSearchParams();
  if (state.file) words.set("file", state.file);
  const { by, value } = state.selection;
  if (by !== INITIAL.selection.by || value !== INITIAL.selection.value) words.set(by, String(Number(value.toPrecision(6))));
  if (state.unit !== INITIAL.unit) words.set("unit", state.unit);
  if (state.paint !== INITIAL.paint) words.set("colour", state.paint);
  if (state.isSmooth) words.set("shading", "smooth");
  if (!state.hasEdges) words.set("edges", "0");
  if (state.isSplit) words.set("original", "1");
  if (state.isMorphing) words.set("flow", "1");
  if (state.isZUp !== null) words.set("up", state.isZUp ? "z" : "y");
  if (state.section) {
    const { axis, at, isFlipped } = state.section;
    words.set("section", `${axis}${isFlipped ? "-" : "+"}${at.toFixed(3)}`);
  }
  if (state.camera) words.set("camera", state.camera.map((value) => Number(value.toFixed(3))).join(","));
  if (state.theme) words.set("theme", state.theme);
  return words.toString().replaceAll("%2C", ",");
}

/** The state that an address says; what it does not say, or says in a way that has no meaning, is as at the start. */
export function fromHash(hash: string): State {
  const words = new URLSearchParams(hash.replace(/^#/, ""));
  const state: State = { ...INITIAL };
  state.file = words.get("file") ?? "";
  for (const by of SELECTIONS) {
    const value = number(words.get(by));
    if (value !== null && value >= 0) state.selection = { by, value };
  }
  if (words.get("unit") === "mesh") state.unit = "mesh";
  const paint = words.get("colour") ?? "";
  if (Object.hasOwn(PAINTS, paint)) state.paint = paint as Paint;
  state.isSmooth = words.get("shading") === "smooth";
  state.hasEdges = words.get("edges") !== "0";
  state.isSplit = words.get("original") === "1";
  state.isMorphing = words.get("flow") === "1";
  const up = words.get("up");
  state.isZUp = up === "z" ? true : up === "y" ? false : null;
  const section = /^([xyz])([+-])(\d(?:\.\d+)?)$/.exec((words.get("section") ?? "").replace(" ", "+"));
  if (section) {
    const [, axis, side, at] = section;
    state.section = { axis: axis as Axis, at: Math.min(1, Number(at)), isFlipped: side === "-" };
  }
  const camera = (words.get("camera") ?? "").split(",").map(number);
  if (camera.length === 6 && camera.every((value) => value !== null)) state.camera = camera as CameraPlace;
  const theme = words.get("theme");
  if (theme === "light" || theme === "dark") state.theme = theme;
  return state;
}

/** The axis after this one, then none. */
export function nextAxis(axis: Axis | null): Axis | null {
  return axis === null ? AXES[0] : (AXES[AXES.indexOf(axis) + 1] ?? null);
}

function number(text: string | null): number | null {
  const value = text === null || text.trim() === "" ? Number.NaN : Number(text);
  return Number.isFinite(value) ? value : null;
}
