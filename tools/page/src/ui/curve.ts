// The error-triangle curve with logarithmic axes: where the level shown is on it, and any other a click away.

import type { Levels } from "../neph/levels.ts";
import { brief, significant } from "./figures.ts";

const SVG = "http://www.w3.org/2000/svg";
const MARGIN = { left: 50, right: 10, top: 8, bottom: 32 };

/** Logarithms of values along pixels. */
class Axis {
  private readonly from: number;
  private readonly to: number;

  constructor(
    values: number[],
    private readonly start: number,
    private readonly end: number,
  ) {
    const logarithms = values.map(Math.log10);
    const [least, most] = values.length ? [Math.min(...logarithms), Math.max(...logarithms)] : [0, 1];
    const room = Math.max(0.04 * (most - least), 0.05);
    this.from = least - room;
    this.to = most + room;
  }

  at(value: number): number {
    const part = (Math.log10(value) - this.from) / (this.to - this.from);
    return this.start + Math.min(1, Math.max(0, part)) * (this.end - this.start);
  }

  value(pixel: number): number {
    return 10 ** (this.from + ((pixel - this.start) / (this.end - this.start)) * (this.to - this.from));
  }

  /** Powers of ten, with twice and five times them where there are few; at most seven. */
  ticks(): number[] {
    const digits = this.to - this.from < 2.2 ? [1, 2, 5] : [1];
    const ticks = [];
    for (let decade = Math.floor(this.from); decade <= this.to; decade++) {
      for (const digit of digits) {
        const value = digit * 10 ** decade;
        const logarithm = Math.log10(value);
        if (logarithm >= this.from && logarithm <= this.to) ticks.push(value);
      }
    }
    const every = Math.ceil(ticks.length / 7);
    return ticks.filter((_, index) => index % every === 0);
  }
}

/** What the curve shows of a file. */
export interface Subject {
  levels: Levels;
  diagonal: number;
  simplices: string;
  inflections: number[];
}

export class Curve {
  private subject: Subject | null = null;
  private level = 0;
  private x = new Axis([], 0, 1);
  private y = new Axis([], 0, 1);
  private readonly svg = document.createElementNS(SVG, "svg");
  private readonly marker = document.createElementNS(SVG, "g");

  /** `onPick` is told the level under the pointer. */
  constructor(
    private readonly place: HTMLElement,
    onPick: (level: number) => void,
  ) {
    this.svg.setAttribute("role", "img");
    place.replaceChildren(this.svg);
    const pick = (event: PointerEvent) => {
      if (!this.subject || !(event.buttons & 1)) return;
      const { left } = this.svg.getBoundingClientRect();
      onPick(this.nearest(event.clientX - left));
    };
    this.svg.addEventListener("pointerdown", (event) => {
      this.svg.setPointerCapture(event.pointerId);
      pick(event);
    });
    this.svg.addEventListener("pointermove", pick);
    new ResizeObserver(() => this.draw()).observe(place);
  }

  setSubject(subject: Subject | null): void {
    this.subject = subject;
    this.draw();
  }

  setLevel(level: number): void {
    this.level = level;
    this.mark();
  }

  /** The level whose number of simplices lies nearest to a place along the axis. */
  private nearest(pixel: number): number {
    const { levels } = this.subject as Subject;
    const wished = this.x.value(pixel);
    const level = levels.atCount(wished);
    const finer = Math.max(0, level - 1);
    const far = (level: number) => Math.abs(Math.log(Math.max(1, levels.counts[level]) / wished));
    return far(finer) < far(level) ? finer : level;
  }

  private draw(): void {
    const { clientWidth: width, clientHeight: height } = this.place;
    this.svg.replaceChildren();
    if (!this.subject || width === 0) return;
    const { levels, diagonal, simplices, inflections } = this.subject;
    this.svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    const all = Array.from(levels.errors.keys());
    this.svg.setAttribute("aria-label", `Error of ${all.length} levels against their ${simplices}`);
    const percent = (level: number) => (100 * levels.errors[level]) / (diagonal || 1);
    const drawn = all.filter((level) => levels.errors[level] > 0 && Number.isFinite(levels.errors[level]) && levels.counts[level] > 0);
    const [left, right] = [MARGIN.left, width - MARGIN.right];
    const [top, bottom] = [MARGIN.top, height - MARGIN.bottom];
    this.x = new Axis(all.map((level) => Math.max(1, levels.counts[level])), left, right);
    this.y = new Axis(drawn.map(percent), bottom, top);
    for (const value of this.x.ticks()) {
      const x = this.x.at(value);
      this.add("path", { class: "grid", d: `M${x} ${top}V${bottom}` });
      this.add("text", { x, y: bottom + 14, "text-anchor": "middle" }, brief(value));
    }
    for (const value of this.y.ticks()) {
      const y = this.y.at(value);
      this.add("path", { class: "grid", d: `M${left} ${y}H${right}` });
      this.add("text", { x: left - 6, y: y + 3.5, "text-anchor": "end" }, `${Number(value.toPrecision(1))} %`);
    }
    this.add("text", { x: (left + right) / 2, y: height - 4, "text-anchor": "middle" }, simplices);
    const steps = drawn.map((level, index) => {
      const [x, y] = [this.x.at(levels.counts[level]).toFixed(1), this.y.at(percent(level)).toFixed(1)];
      return index === 0 ? `M${x} ${y}` : `V${y}H${x}`;
    });
    this.add("path", { class: "line", d: steps.join("") });
    for (const level of inflections.filter((level) => level < levels.length)) {
      const place = { cx: this.x.at(levels.counts[level]), cy: this.y.at(percent(level)), r: 3.2, class: "inflection" };
      const circle = this.add("circle", place);
      const title = document.createElementNS(SVG, "title");
      title.textContent = `inflection at level ${level}, ${significant(percent(level))} %`;
      circle.append(title);
    }
    this.svg.append(this.marker);
    this.mark();
  }

  private mark(): void {
    this.marker.replaceChildren();
    if (!this.subject) return;
    const { levels, diagonal } = this.subject;
    // A level without triangles states no finite error and has no place here.
    if (!Number.isFinite(levels.errors[this.level])) return;
    const x = this.x.at(Math.max(1, levels.counts[this.level]));
    const y = this.y.at(Math.max(Number.MIN_VALUE, (100 * levels.errors[this.level]) / (diagonal || 1)));
    const { clientHeight: height } = this.place;
    this.add("path", { class: "cross", d: `M${MARGIN.left} ${y}H${x}V${height - MARGIN.bottom}`, fill: "none" }, "", this.marker);
    this.add("circle", { class: "point", cx: x, cy: y, r: 5 }, "", this.marker);
  }

  private add(name: string, attributes: Record<string, string | number>, text = "", parent: Element = this.svg): Element {
    const element = document.createElementNS(SVG, name);
    for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, String(value));
    element.textContent = text;
    parent.append(element);
    return element;
  }
}
