// Several files: a strip of small pictures to choose from.

import type { Hand } from "../hand.ts";
import { Arrival } from "../neph/arrival.ts";
import { NephFile } from "../neph/file.ts";
import type { Stage } from "../scene/stage.ts";
import { Surface } from "../scene/surface.ts";
import { element } from "./dom.ts";

const [WIDTH, HEIGHT] = [184, 124];

/** A file as the list of the server has it. */
export interface Listed {
  name: string;
  url: string;
  bytes: number;
}

/** Shows a button for each file; `onPick` hears which was chosen. */
export function initGallery(files: Listed[], onPick: (file: Listed) => void): void {
  const gallery = element("gallery");
  gallery.hidden = files.length < 2;
  document.body.classList.toggle("has-gallery", files.length > 1);
  const buttons = files.map((file) => {
    const [button, canvas, label] = [document.createElement("button"), document.createElement("canvas"), document.createElement("span")];
    [canvas.width, canvas.height] = [WIDTH, HEIGHT];
    canvas.setAttribute("aria-hidden", "true");
    label.textContent = file.name;
    button.title = file.name;
    button.append(canvas, label);
    button.addEventListener("click", () => onPick(file));
    return button;
  });
  gallery.replaceChildren(...buttons);
}

/** Marks the file that is being viewed. */
export function markCurrent(files: Listed[], current: Listed): void {
  [...element("gallery").children].forEach((button, index) => {
    button.setAttribute("aria-current", String(files[index] === current));
  });
}

/** Draws the small pictures, one after the other; a file that cannot be read has none, and says why when it is chosen. */
export async function drawThumbnails(files: Listed[], stage: Stage, hand: Hand): Promise<void> {
  for (const [index, { url }] of files.entries()) {
    const canvas = element("gallery").children[index].querySelector("canvas") as HTMLCanvasElement;
    await drawThumbnail(url, canvas, stage, hand).catch(() => canvas.getContext("2d")?.clearRect(0, 0, WIDTH, HEIGHT));
  }
}

async function drawThumbnail(url: string, canvas: HTMLCanvasElement, stage: Stage, hand: Hand): Promise<void> {
  const file = await NephFile.open(url);
  const arrival = new Arrival(file, () => {});
  await arrival.readFirst();
  const surface = new Surface(file);
  surface.arrived({ of: "slots", start: 0, end: file.head.nSlots });
  if (file.head.nCorners === 3) {
    const [positions, indices] = [file.positions.slice(), file.cut(arrival.first)];
    const { normals } = await hand.do({ kind: "normals", positions, indices }, [positions.buffer, indices.buffer]);
    surface.setNormals(normals);
  }
  surface.setLook({ isSmooth: true, section: null, pixelRatio: 1 });
  const figure = surface.figure();
  figure.show({ level: arrival.first, paint: "plain", span: [0, 1], edges: "none", flight: 0 });
  const pixels = stage.thumbnail(figure.group, surface, WIDTH, HEIGHT);
  surface.dispose();
  const image = new ImageData(WIDTH, HEIGHT);
  for (let row = 0; row < HEIGHT; row++) {
    image.data.set(pixels.subarray(4 * WIDTH * row, 4 * WIDTH * (row + 1)), 4 * WIDTH * (HEIGHT - 1 - row));
  }
  canvas.getContext("2d")?.putImageData(image, 0, 0);
}
