// One file on the stage: which level is shown of what has arrived, and what is drawn of it.

import { Vector4 } from "three";
import type { Hand } from "./hand.ts";
import { Arrival } from "./neph/arrival.ts";
import { NephFile } from "./neph/file.ts";
import type { Figure, Pose } from "./scene/figure.ts";
import type { Stage } from "./scene/stage.ts";
import { Surface } from "./scene/surface.ts";
import type { Selection, State } from "./state.ts";
import type { Landed } from "./work.ts";

/** How long a flow from level to level takes. */
const FLOW_MS = 320;
/** Part of the tolerance in pixels that a coarser level must leave free before it is taken, so that a camera that trembles changes nothing. */
const SLACK = 0.2;
/** How long a level must stay before its deviation is measured. */
const PATIENCE_MS = 120;
/** A surface whose height along z is less than this part of its other extents lies on the ground. */
const FLAT_PART = 0.45;

/** A flow under way: the finer level is drawn, between its own shape and that of the coarser one. */
interface Flow {
  fine: number;
  towards: number;
  from: number;
  startedAt: number | null;
}

export class Viewing {
  readonly arrival: Arrival;
  readonly surface: Surface;
  /** The level that is asked for, arrived or not. */
  level: number;
  /** The largest deviation found of the level that is coloured by it; `null` while it is being measured. */
  largestDeviation: number | null = null;
  /** Vertices of each level. */
  vertexCounts: Uint32Array;
  /** Milliseconds that the last change of level took, from what was asked to the ranges to draw. */
  stepMs = 0;
  /** Hears whenever there is something new to say. */
  onChange: () => void = () => {};
  private readonly main: Figure;
  /** Edges of the level, over the colours of the original's triangles. */
  private readonly overlay: Figure;
  private readonly original: Figure;
  private state: State;
  /** The level that the main figure shows, `null` before the first has arrived. */
  private shown: number | null = null;
  private flow: Flow | null = null;
  private isPreparingFlow = false;
  private measured: { level: number; landed: Landed } | null = null;
  private measuring: number | null = null;
  private measureTimer = 0;
  private hasVertices = false;
  /** The plane that is shown through tetrahedra, empty for none. */
  private slice = "";
  private hasBirths: "no" | "asked" | "yes" = "no";
  private normalsOf: number | null = null;
  private hasStopped = false;

  constructor(
    readonly file: NephFile,
    private readonly stage: Stage,
    private readonly hand: Hand,
    state: State,
  ) {
    this.state = state;
    this.surface = new Surface(file);
    this.main = this.surface.figure();
    this.overlay = this.surface.figure();
    this.original = this.surface.figure();
    this.arrival = new Arrival(file, (piece) => {
      this.surface.arrived(piece);
      this.update();
      this.onChange();
    });
    this.level = file.levels.coarsest;
    this.vertexCounts = file.levels.vertexCounts;
    stage.setSurface(this.surface, this.isZUp);
    this.enter();
  }

  private enter(): void {
    this.stage.left.add(this.main.group, this.overlay.group, this.surface.slice);
    this.stage.right.add(this.original.group);
  }

  /** Whether the simplices are tetrahedra. */
  get isVolume(): boolean {
    return this.file.head.nCorners === 4;
  }

  get isZUp(): boolean {
    if (this.state.isZUp !== null) return this.state.isZUp;
    const { boundsMin, boundsMax } = this.file.head;
    const [x, y, z] = boundsMax.map((most, axis) => most - boundsMin[axis]);
    return z < FLAT_PART * Math.min(x, y);
  }

  /** The level that is seen. */
  get seen(): number | null {
    return this.shown;
  }

  /** Whether a finer level than the one seen is still on its way. */
  get isWaiting(): boolean {
    return !this.arrival.isComplete(this.level);
  }

  /** Reads the file to its end. Throws a `Failure`. */
  async read(onFirst: () => void): Promise<void> {
    await this.arrival.readFirst();
    if (this.hasStopped) return;
    this.makeNormals();
    onFirst();
    this.vertexCounts = await this.file.readVertexCounts();
    await this.arrival.readRest();
    if (this.hasStopped) return;
    this.makeNormals();
    this.update();
  }

  setState(state: State): void {
    const turned = this.isZUp;
    this.state = state;
    if (turned !== this.isZUp) {
      this.stage.setSurface(this.surface, this.isZUp);
      this.enter();
    }
    this.update();
  }

  /** The level that a selection asks for, from any level to start with. */
  levelFor({ by, value }: Selection): number {
    const { levels } = this.file;
    if (by === "error") return levels.atError(value);
    if (by === "triangles") return levels.atCount(value);
    if (by === "level") return Math.min(levels.coarsest, Math.round(value));
    const allowed = levels.atError(this.stage.lengthOf(value));
    if (this.level >= allowed) return allowed;
    return Math.max(this.level, levels.atError(this.stage.lengthOf(value * (1 - SLACK))));
  }

  /** Follows what the state asks for, and draws. */
  update(): void {
    this.follow();
    this.stage.draw();
  }

  private follow(): void {
    const start = performance.now();
    const level = this.levelFor(this.state.selection);
    const changed = level !== this.level;
    this.level = level;
    const best = this.arrival.best(level);
    if (best !== null) this.choose(best);
    if (changed) {
      this.stepMs = performance.now() - start;
      performance.clearMeasures("level");
      performance.measure("level", { start, duration: this.stepMs });
    }
    if (changed || best !== level) this.arrival.want(level);
    if (changed) this.onChange();
  }

  /** Follows the camera where it decides, and takes flows further; called before each picture. */
  frame(milliseconds: number): void {
    if (this.state.selection.by === "pixels") this.follow();
    const { flow } = this;
    if (!flow) return;
    flow.startedAt ??= milliseconds;
    const part = Math.min(1, (milliseconds - flow.startedAt) / FLOW_MS);
    if (part === 1) {
      this.flow = null;
      this.shown = flow.towards;
      this.show(flow.towards, 0);
      this.update();
      this.onChange();
    } else {
      const eased = part * part * (3 - 2 * part);
      this.show(flow.fine, flow.towards === flow.fine ? 1 - eased : eased);
      this.stage.draw();
    }
  }

  /** Whether levels flow now; a sweep waits for that. */
  get isFlowing(): boolean {
    return this.flow !== null || this.isPreparingFlow;
  }

  stop(): void {
    this.hasStopped = true;
    this.arrival.stop();
    clearTimeout(this.measureTimer);
    this.surface.dispose();
  }

  private choose(level: number): void {
    const isDeviation = this.state.paint === "deviation" && !this.isVolume;
    const canFlow = this.state.isMorphing && !isDeviation && !this.isVolume && this.hasAll;
    if (this.flow || this.isPreparingFlow) {
      if (canFlow) return;
      this.flow = null;
    }
    if (canFlow && this.shown !== null && this.shown !== level) {
      void this.startFlow(this.shown, level);
      return;
    }
    this.shown = level;
    this.show(level, 0);
    if (isDeviation && this.measured?.level !== level) this.measureSoon(level);
    if (this.state.paint === "birth") void this.readBirths();
    if (this.isVolume) void this.cut(level);
  }

  /** Shows the plane of the section through the tetrahedra of a level. */
  private async cut(level: number): Promise<void> {
    const plane = this.section();
    const wanted = plane && this.hasAll ? [level, ...plane.toArray()].join() : "";
    if (wanted === this.slice) return;
    this.slice = wanted;
    if (!plane || !wanted) return this.surface.setSlice(null);
    await this.giveVertices();
    const tetrahedra = this.file.cut(level);
    const job = { kind: "slice", tetrahedra, normal: [plane.x, plane.y, plane.z], distance: plane.w } as const;
    const slice = await this.hand.do(job, [tetrahedra.buffer]);
    if (this.hasStopped || this.slice !== wanted) return;
    this.surface.setSlice(slice);
    this.stage.draw();
  }

  private get hasAll(): boolean {
    return this.arrival.isComplete(0) && this.arrival.isComplete(this.file.levels.coarsest);
  }

  private show(level: number, flight: number): void {
    const { state, surface, measured } = this;
    const edges = state.hasEdges ? "over" : "none";
    const isReady = state.paint === "birth" ? this.hasBirths === "yes" : state.paint !== "deviation" || !this.isVolume;
    const paint = isReady ? state.paint : "plain";
    const span = this.span(level);
    let pose: Pose = { level, paint, span, edges, flight };
    this.overlay.group.visible = false;
    if (paint === "deviation") {
      if (measured) {
        // The triangles of the original, each vertex where it comes to lie: the shape of the level, with the colours in between.
        pose = { level: 0, paint, span, edges: "none", flight: 1 };
        this.overlay.group.visible = state.hasEdges && measured.level === level;
        if (this.overlay.group.visible) this.overlay.show({ level, paint: "plain", span, edges: "alone", flight: 0 });
      } else {
        pose.paint = "plain";
      }
    }
    this.main.show(pose);
    this.stage.isSplit = state.isSplit;
    if (state.isSplit) {
      const finest = this.arrival.finest ?? level;
      // Births and runs say nothing of the original.
      const paint = pose.paint === "deviation" || pose.paint === "level" ? pose.paint : "plain";
      this.original.show({ level: finest, paint, span, edges, flight: 0 });
    }
    surface.setLook({ isSmooth: state.isSmooth, section: this.section(), pixelRatio: this.stage.pixelRatio });
  }

  /** What has the first and the last colour for a level: whatever its triangles and vertices can have. */
  span(level: number): readonly [number, number] {
    const { levels } = this.file;
    if (this.state.paint === "level") return [level, levels.coarsest];
    if (this.state.paint === "birth") return [0, level];
    // What the level states, or more where it states too little.
    return this.measured ? [0, Math.max(levels.errors[this.measured.level], this.measured.landed.largest)] : [0, 1];
  }

  private section(): Vector4 | null {
    const { section } = this.state;
    if (!section) return null;
    const axis = ["x", "y", "z"].indexOf(section.axis);
    const { boundsMin, boundsMax } = this.file.head;
    const at = boundsMin[axis] + section.at * (boundsMax[axis] - boundsMin[axis]);
    const plane = new Vector4(0, 0, 0, section.isFlipped ? -at : at);
    plane.setComponent(axis, section.isFlipped ? -1 : 1);
    return plane;
  }

  private async startFlow(from: number, towards: number): Promise<void> {
    this.isPreparingFlow = true;
    const [fine, coarse] = [Math.min(from, towards), Math.max(from, towards)];
    try {
      const landed = await this.land(fine, coarse);
      if (this.hasStopped || !landed) return;
      this.surface.setLanding(landed);
      this.measured = null;
      this.flow = { fine, towards, from, startedAt: null };
      this.stage.draw();
    } finally {
      this.isPreparingFlow = false;
    }
  }

  private measureSoon(level: number): void {
    this.largestDeviation = null;
    if (this.measuring === level || !this.hasAll) return;
    clearTimeout(this.measureTimer);
    this.measuring = level;
    this.measureTimer = window.setTimeout(() => void this.measure(level), PATIENCE_MS);
  }

  private async measure(level: number): Promise<void> {
    const landed = await this.land(0, level);
    if (this.measuring === level) this.measuring = null;
    if (this.hasStopped || !landed || this.state.paint !== "deviation") return;
    this.measured = { level, landed };
    this.largestDeviation = landed.largest;
    this.surface.setLanding(landed);
    this.update();
    this.onChange();
  }

  private async land(fine: number, coarse: number): Promise<Landed | null> {
    await this.giveVertices();
    const [from, onto] = [this.file.cut(fine), this.file.cut(coarse)];
    return this.hand.do({ kind: "land", from, onto, level: coarse }, [from.buffer, onto.buffer]);
  }

  private async giveVertices(): Promise<void> {
    if (this.hasVertices) return;
    this.hasVertices = true;
    const positions = this.file.positions.slice();
    await this.hand.do({ kind: "vertices", positions }, [positions.buffer]);
  }

  private async readBirths(): Promise<void> {
    if (this.hasBirths !== "no") return;
    this.hasBirths = "asked";
    const births = await this.file.births();
    if (this.hasStopped) return;
    this.surface.setBirths(births);
    this.hasBirths = "yes";
    this.update();
    this.onChange();
  }

  /** Normals of the finest level that is there: smooth shading shows what the surface is meant to be. */
  private makeNormals(): void {
    const level = this.arrival.finest;
    if (level === null || level === this.normalsOf || this.isVolume) return;
    this.normalsOf = level;
    const [positions, indices] = [this.file.positions.slice(), this.file.cut(level)];
    void this.hand.do({ kind: "normals", positions, indices }, [positions.buffer, indices.buffer]).then(({ normals }) => {
      if (this.hasStopped) return;
      this.surface.setNormals(normals);
      this.stage.draw();
    });
  }
}
