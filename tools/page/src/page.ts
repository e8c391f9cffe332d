// The page of `nephrite view`: any level of a mesh, read by the page itself from the file beside it.

import { Hand } from "./hand.ts";
import { asFailure, changed, Failure, unreachable } from "./neph/failure.ts";
import { NephFile } from "./neph/file.ts";
import { PAINTS, type Paint } from "./scene/shaders.ts";
import { Stage } from "./scene/stage.ts";
import { firstSelection, fromHash, nextAxis, type State, toHash } from "./state.ts";
import { Curve } from "./ui/curve.ts";
import { button, element } from "./ui/dom.ts";
import { count } from "./ui/figures.ts";
import { drawThumbnails, initGallery, type Listed, markCurrent } from "./ui/gallery.ts";
import { initKeys } from "./ui/keys.ts";
import { hideFailure, initMessage, showFailure } from "./ui/message.ts";
import { initPanel, showArrival, showFacts, showLegend, showLevel, showQueryTime, showState } from "./ui/panel.ts";
import { Viewing } from "./viewing.ts";

/** How long a sweep over all levels takes. */
const SWEEP_MS = 9000;
/** Levels that a sweep passes over at once while they flow. */
const FLOW_STEPS = 24;
/** How often a live server is asked whether the file is still the same. */
const LOOK_MS = 2000;

let state: State = fromHash(location.hash);
let files: Listed[] = [];
let isLive = false;
let current: Listed | null = null;
let viewing: Viewing | null = null;
let sweep: { from: number; startedAt: number; direction: 1 | -1 } | null = null;

const hand = new Hand();
const stage = openStage();
const curve = new Curve(element("curve"), (level) => change({ selection: { by: "level", value: level } }));

function openStage(): Stage | null {
  try {
    return new Stage(element<HTMLCanvasElement>("canvas"));
  } catch {
    showFailure(new Failure("This browser gives the page no WebGL 2", "Another browser, or hardware acceleration in its settings, will help."), false);
    return null;
  }
}

function change(patch: Partial<State>): void {
  if (patch.selection && sweep && !isSweeping) stopSweep();
  state = { ...state, ...patch };
  viewing?.setState(state);
  // Two pictures side by side have less room; a camera that nobody has moved makes the best of it.
  if (stage && patch.isSplit !== undefined && !state.camera) stage.place = null;
  refresh();
  rememberSoon();
}

/** Shows everything anew that may have changed; cheap enough for every step of a slider. */
function refresh(): void {
  if (!stage) return;
  document.documentElement.toggleAttribute("data-theme", state.theme !== null);
  if (state.theme) document.documentElement.dataset.theme = state.theme;
  showState(state, viewing);
  for (const id of ["left-label", "right-label", "divider"]) element(id).hidden = !state.isSplit || !viewing;
  if (!viewing) return;
  showLevel(viewing, state, stage);
  showLegend(viewing, state);
  const level = viewing.seen ?? viewing.level;
  const { levels } = viewing.file;
  curve.setLevel(level);
  element("left-label").textContent = `level ${level}: ${count(levels.counts[level])}`;
  const finest = viewing.arrival.finest ?? level;
  element("right-label").textContent = `${finest === 0 ? "original" : `level ${finest}, so far`}: ${count(levels.counts[finest])}`;
  stage.draw();
  timeSoon();
}

const timeSoon = later(250, () => viewing && showQueryTime(viewing));
const rememberSoon = later(250, () => history.replaceState(null, "", `#${toHash(state)}`));

/** Calls `act` once nobody has asked for it for a while. */
function later(milliseconds: number, act: () => void): () => void {
  let timer = 0;
  return () => {
    clearTimeout(timer);
    timer = window.setTimeout(act, milliseconds);
  };
}

async function show(listed: Listed): Promise<void> {
  if (!stage) return;
  current = listed;
  markCurrent(files, listed);
  viewing?.stop();
  viewing = null;
  hideFailure();
  const { dataset } = document.documentElement;
  dataset.phase = "opening";
  performance.clearMarks("first picture");
  let mine: Viewing | null = null;
  try {
    const file = await NephFile.open(listed.url);
    if (current !== listed) return;
    state.selection = firstSelection(state, file.levels.counts[0]);
    mine = viewing = new Viewing(file, stage, hand, state);
    viewing.onChange = () => {
      refresh();
      showArrival(mine as Viewing, dataset.phase === "complete");
    };
    stage.isSplit = state.isSplit;
    stage.place = state.camera;
    showFacts(listed.name, viewing);
    const { levels, diagonal } = file;
    curve.setSubject({ levels, diagonal, simplices: mine.isVolume ? "tetrahedra" : "triangles", inflections: levels.inflections() });
    await viewing.read(() => {
      refresh();
      stage.render();
      performance.mark("first picture", { detail: { bytes: file.reader.bytesRead, requests: file.reader.requests, level: mine?.seen } });
      dataset.phase = "first";
    });
    if (viewing !== mine) return;
    dataset.phase = "complete";
    refresh();
    showArrival(viewing, true);
  } catch (error) {
    if (current === listed) showFailure(asFailure(error), (mine?.arrival.finest ?? null) !== null);
  }
}

let isSweeping = false;

function toggleSweep(): void {
  if (sweep) return stopSweep();
  if (!viewing) return;
  const { coarsest } = viewing.file.levels;
  // From where it stands towards coarser levels, and from the coarsest back.
  sweep = { from: viewing.level, startedAt: performance.now(), direction: viewing.level >= coarsest ? -1 : 1 };
  button("play").setAttribute("aria-pressed", "true");
  requestAnimationFrame(takeSweep);
}

function stopSweep(): void {
  sweep = null;
  button("play").setAttribute("aria-pressed", "false");
}

function takeSweep(now: number): void {
  if (!sweep || !viewing) return stopSweep();
  const { coarsest } = viewing.file.levels;
  let level: number;
  if (state.isMorphing) {
    if (viewing.isFlowing) return void requestAnimationFrame(takeSweep);
    level = viewing.level + sweep.direction * Math.max(1, Math.round(coarsest / FLOW_STEPS));
  } else {
    level = Math.round(sweep.from + (sweep.direction * coarsest * (now - sweep.startedAt)) / SWEEP_MS);
  }
  level = Math.min(coarsest, Math.max(0, level));
  isSweeping = true;
  if (level !== viewing.level) change({ selection: { by: "level", value: level } });
  isSweeping = false;
  if (level === (sweep.direction > 0 ? coarsest : 0)) {
    sweep = { from: level, startedAt: now, direction: sweep.direction > 0 ? -1 : 1 };
  }
  requestAnimationFrame(takeSweep);
}

function step(levels: number): void {
  if (!viewing) return;
  const { coarsest } = viewing.file.levels;
  change({ selection: { by: "level", value: Math.min(coarsest, Math.max(0, viewing.level + levels)) } });
}

async function savePicture(): Promise<void> {
  if (!stage || !viewing) return;
  const link = document.createElement("a");
  link.href = URL.createObjectURL(await stage.picture());
  link.download = `${current?.name ?? "nephrite"}-level-${viewing.seen ?? viewing.level}.png`;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

function toggleTheme(): void {
  const isDark = state.theme ? state.theme === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
  change({ theme: isDark ? "light" : "dark" });
}

function resetView(): void {
  if (stage) stage.place = null;
  change({ camera: null });
}

function nextFile(by: number): void {
  if (!current || files.length < 2) return;
  const index = (files.indexOf(current) + by + files.length) % files.length;
  pick(files[index]);
}

function pick(file: Listed): void {
  // Each file is looked at from where it is seen whole.
  state = { ...state, file: file.name, camera: null };
  rememberSoon();
  void show(file);
}

function initActions(stage: Stage): void {
  initPanel(() => viewing, () => state, change);
  const help = element<HTMLDialogElement>("help");
  const paints = Object.keys(PAINTS) as Paint[];
  const section = () => {
    const axis = nextAxis(state.section?.axis ?? null);
    change({ section: axis ? { axis, at: 0.5, isFlipped: false } : null });
  };
  const actions = {
    ArrowLeft: () => step(-1),
    ArrowRight: () => step(1),
    PageUp: () => step(-10),
    PageDown: () => step(10),
    Home: () => step(-Infinity),
    End: () => step(Infinity),
    " ": toggleSweep,
    w: () => change({ hasEdges: !state.hasEdges }),
    s: () => change({ isSmooth: !state.isSmooth }),
    c: () => change({ paint: paints[(paints.indexOf(state.paint) + 1) % paints.length] }),
    o: () => change({ isSplit: !state.isSplit }),
    x: section,
    g: () => change({ isMorphing: !state.isMorphing }),
    u: () => change({ isZUp: !(viewing?.isZUp ?? false) }),
    a: () => stage.turn(-1 / 48),
    d: () => stage.turn(1 / 48),
    r: resetView,
    t: toggleTheme,
    p: () => void savePicture(),
    "[": () => nextFile(-1),
    "]": () => nextFile(1),
    "?": () => help.showModal(),
  };
  initKeys(actions);
  for (const [id, key] of [["finer", "ArrowLeft"], ["coarser", "ArrowRight"], ["play", " "], ["theme", "t"], ["reset", "r"], ["screenshot", "p"], ["help-open", "?"]] as const) {
    button(id).addEventListener("click", actions[key]);
  }
  stage.onFrame = (milliseconds) => viewing?.frame(milliseconds);
  stage.onMove = () => {
    state.camera = stage.place;
    if (viewing) showLevel(viewing, state, stage);
    rememberSoon();
  };
  addEventListener("hashchange", () => {
    const before = state.file;
    state = fromHash(location.hash);
    stage.place = state.camera;
    const named = files.find(({ name }) => name === state.file) ?? files[0];
    if (state.file !== before && named && named !== current) void show(named);
    else change({});
  });
}

/** Tells when a file that is being looked at is no longer the one on the disk. */
async function look(): Promise<void> {
  const reader = viewing?.file.reader;
  if (!reader || document.hidden) return;
  await reader.look().catch(() => {
    if (viewing?.file.reader === reader) showFailure(changed(), viewing.arrival.finest !== null);
  });
}

/** What goes wrong beside the reading of a file: births that do not come, a worker that fails, a graphics card that is reset. */
function initRescue(): void {
  const tell = (failure: Failure) => showFailure(failure, (viewing?.arrival.finest ?? null) !== null);
  addEventListener("unhandledrejection", (event) => {
    event.preventDefault();
    tell(asFailure(event.reason));
  });
  element("canvas").addEventListener("webglcontextlost", () => {
    tell(new Failure("The graphics card has dropped the picture", "Load the page again; the address holds what you saw."));
  });
}

async function start(): Promise<void> {
  initMessage();
  initRescue();
  if (!stage) return;
  initActions(stage);
  refresh();
  try {
    const response = await fetch("files.json", { cache: "no-store" }).catch(() => null);
    if (!response?.ok) throw unreachable("The list of files did not come");
    ({ files, live: isLive } = (await response.json()) as { files: Listed[]; live: boolean });
    initGallery(files, pick);
    const first = files.find(({ name }) => name === state.file) ?? files[0];
    if (!first) throw new Failure("There is no file to show", "Name one: `nephrite view FILE`.");
    if (isLive) setInterval(() => void look(), LOOK_MS);
    await show(first);
    if (files.length > 1) await drawThumbnails(files, stage, hand);
  } catch (error) {
    showFailure(asFailure(error), false);
  }
}

void start();
