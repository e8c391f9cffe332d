// The canvas: camera, drawing on demand, one or two pictures side by side.

import { Color, Group, MathUtils, PerspectiveCamera, Scene, Vector3, WebGLRenderer, WebGLRenderTarget } from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import type { Surface } from "./surface.ts";

const FOV_DEGREES = 35;
/** Distance of the eye at the start, in radii. */
const START_DISTANCE = 2.95;
const START_DIRECTION = new Vector3(0.45, 0.32, 1).normalize();
/** Near and far plane, in parts of the distance to the nearest and of that to the farthest point. */
const NEAR_PART = 1 / 500;

/** Where the camera is and looks, in radii about the centre of the surface. */
export type CameraPlace = [number, number, number, number, number, number];

export class Stage {
  readonly renderer: WebGLRenderer;
  readonly camera = new PerspectiveCamera(FOV_DEGREES, 1, 0.1, 100);
  /** What is drawn left and, if split, right. Surfaces are scaled to radius 1 about the origin. */
  readonly left = new Group();
  readonly right = new Group();
  isSplit = false;
  /** Hears that the camera was moved, by hand or otherwise. */
  onMove: () => void = () => {};
  /** Called before each picture. */
  onFrame: (milliseconds: number) => void = () => {};
  private readonly scene = new Scene();
  private readonly controls: OrbitControls;
  private isDue = false;
  private isMoved = false;
  private surface: Surface | null = null;

  constructor(readonly canvas: HTMLCanvasElement) {
    this.renderer = new WebGLRenderer({ canvas, antialias: true, powerPreference: "high-performance" });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.autoClear = false;
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = true;
    this.controls.dampingFactor = 0.12;
    this.controls.addEventListener("start", () => {
      this.isMoved = true;
    });
    this.controls.addEventListener("change", () => {
      this.draw();
      this.onMove();
    });
    this.scene.add(this.left, this.right);
    new ResizeObserver(() => this.draw()).observe(canvas);
  }

  /** Shows figures of this surface from now on. */
  setSurface(surface: Surface | null, isZUp: boolean): void {
    this.surface = surface;
    if (!surface) return;
    const { center, radius } = surface.sphere;
    const scale = radius > 0 ? 1 / radius : 1;
    for (const group of [this.left, this.right]) {
      group.clear();
      group.rotation.set(isZUp ? -Math.PI / 2 : 0, 0, 0);
      group.scale.setScalar(scale);
      group.position.copy(center).multiplyScalar(-scale).applyEuler(group.rotation);
    }
    this.draw();
  }

  get pixelRatio(): number {
    return this.renderer.getPixelRatio();
  }

  /** Most pixels of the picture that a length in mesh units can cover. */
  pixelsOf(length: number): number {
    return length / this.lengthOf(1);
  }

  /** Least length in mesh units that can cover as many pixels: that at the point of the surrounding sphere nearest to the eye. */
  lengthOf(pixels: number): number {
    const radius = this.surface?.sphere.radius ?? 1;
    const depth = Math.max(this.camera.position.length() - 1, this.camera.near);
    const height = 2 * Math.tan(MathUtils.degToRad(FOV_DEGREES) / 2) * depth * radius;
    return (pixels * height) / Math.max(1, this.canvas.height);
  }

  /** Where the camera is; `null` while nobody has moved it. */
  get place(): CameraPlace | null {
    if (!this.isMoved) return null;
    return [...this.camera.position.toArray(), ...this.controls.target.toArray()] as CameraPlace;
  }

  /** Moves the camera; `null` takes it back to where it starts. */
  set place(place: CameraPlace | null) {
    const [x, y, z, ...target] = place ?? [...START_DIRECTION.clone().multiplyScalar(this.startDistance()).toArray(), 0, 0, 0];
    this.isMoved = place !== null;
    this.camera.position.set(x, y, z);
    this.controls.target.set(...(target as [number, number, number]));
    this.controls.update();
    this.draw();
  }

  /** Farther away where the picture is narrower than high. */
  private startDistance(): number {
    const { clientWidth, clientHeight } = this.canvas;
    const aspect = clientWidth / Math.max(1, clientHeight) / (this.isSplit ? 2 : 1);
    return START_DISTANCE / Math.min(1, Math.max(aspect, 0.4));
  }

  /** Turns the camera around what it looks at, by parts of a whole turn. */
  turn(aroundUp: number): void {
    this.isMoved = true;
    const offset = this.camera.position.clone().sub(this.controls.target);
    offset.applyAxisAngle(this.camera.up, aroundUp * 2 * Math.PI);
    this.camera.position.copy(this.controls.target).add(offset);
    this.controls.update();
    this.draw();
  }

  /** Asks for a picture with the next frame. */
  draw(): void {
    if (this.isDue) return;
    this.isDue = true;
    requestAnimationFrame((milliseconds) => {
      this.isDue = false;
      this.onFrame(milliseconds);
      this.controls.update();
      this.render();
    });
  }

  /** Draws now. */
  render(): void {
    const { renderer, camera, canvas } = this;
    const { clientWidth: width, clientHeight: height } = canvas;
    if (width === 0 || height === 0) return;
    const ratio = this.pixelRatio;
    if (canvas.width !== Math.floor(width * ratio) || canvas.height !== Math.floor(height * ratio)) {
      // The page's style says how large it is shown.
      renderer.setSize(width, height, false);
    }
    const distance = camera.position.length();
    camera.near = Math.max(distance * NEAR_PART, distance - 1.5);
    camera.far = distance + 2.5;
    renderer.setClearColor(new Color(getComputedStyle(canvas).backgroundColor));
    renderer.setScissorTest(true);
    const parts = this.isSplit ? [this.left, this.right] : [this.left];
    parts.forEach((part, index) => {
      const [x, partWidth] = [Math.round((index * width) / parts.length), Math.round(width / parts.length)];
      camera.aspect = partWidth / height;
      camera.updateProjectionMatrix();
      renderer.setViewport(x, 0, partWidth, height);
      renderer.setScissor(x, 0, partWidth, height);
      this.left.visible = part === this.left;
      this.right.visible = part === this.right;
      renderer.clear();
      renderer.render(this.scene, camera);
    });
  }

  /** The picture as it is now. */
  async picture(): Promise<Blob> {
    this.render();
    return new Promise((resolve, reject) => {
      this.canvas.toBlob((blob) => (blob ? resolve(blob) : reject(new Error("the browser gives no picture"))), "image/png");
    });
  }

  /** A small picture of a group of another surface, as pixels from the lowest row on. */
  thumbnail(group: Group, surface: Surface, width: number, height: number): Uint8Array<ArrayBuffer> {
    const { center, radius } = surface.sphere;
    const scene = new Scene();
    group.scale.setScalar(radius > 0 ? 1 / radius : 1);
    group.position.copy(center).multiplyScalar(-group.scale.x);
    scene.add(group);
    const camera = new PerspectiveCamera(FOV_DEGREES, width / height, 1, 10);
    camera.position.copy(START_DIRECTION).multiplyScalar(0.9 * START_DISTANCE);
    camera.lookAt(0, 0, 0);
    const target = new WebGLRenderTarget(width, height, { samples: 4 });
    const pixels = new Uint8Array(4 * width * height);
    this.renderer.setRenderTarget(target);
    this.renderer.setClearColor(0, 0);
    this.renderer.setScissorTest(false);
    this.renderer.clear();
    this.renderer.render(scene, camera);
    this.renderer.readRenderTargetPixels(target, 0, 0, width, height, pixels);
    this.renderer.setRenderTarget(null);
    target.dispose();
    this.draw();
    return pixels;
  }
}
