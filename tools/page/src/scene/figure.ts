// A level as it is drawn: the ranges of the static buffers that are its runs.

import { BufferGeometry, Color, Group, Mesh, ShaderMaterial, SRGBColorSpace } from "three";
import { type Paint, PAINTS } from "./shaders.ts";
import type { Surface } from "./surface.ts";

/** How one figure is drawn. */
export interface Pose {
  level: number;
  paint: Paint;
  /** What has the first colour of the ramp, and what the last: levels or lengths in mesh units. */
  span: readonly [number, number];
  /** Edges of triangles: none, over the surface, or alone. */
  edges: "none" | "over" | "alone";
  /** 0: vertices at their own places, 1: where they land. */
  flight: number;
}

/** How much of what is below an edge hides. */
export const EDGE_STRENGTH = 0.62;

export class Figure {
  readonly group = new Group();
  private readonly indexed: Mesh;
  private corners: Mesh | null = null;
  private pose: Pose = { level: -1, paint: "plain", span: [0, 1], edges: "none", flight: 0 };

  constructor(private readonly surface: Surface) {
    const geometry = new BufferGeometry();
    geometry.setIndex(surface.index);
    for (const [name, attribute] of Object.entries(surface.attributes)) geometry.setAttribute(name, attribute);
    this.indexed = this.mesh(geometry, surface.indexedMaterial);
  }

  /** Draws as `pose` says from now on. A change of level changes the ranges that are drawn and no buffer. */
  show(pose: Pose): void {
    const needsCorners = pose.edges !== "none" || pose.paint === "birth";
    if (needsCorners && !this.corners) {
      const geometry = new BufferGeometry();
      geometry.setAttribute("vertex", this.surface.corners());
      this.corners = this.mesh(geometry, this.surface.cornerMaterial);
      setRuns(this.corners.geometry, this.surface, this.pose.level);
    }
    if (pose.level !== this.pose.level) {
      setRuns(this.indexed.geometry, this.surface, pose.level);
      if (this.corners) setRuns(this.corners.geometry, this.surface, pose.level);
    }
    this.indexed.visible = !needsCorners;
    if (this.corners) {
      const { cornerMaterial, edgeMaterial } = this.surface;
      this.corners.material = list(pose.edges === "alone" ? edgeMaterial : cornerMaterial);
      this.corners.visible = needsCorners;
    }
    this.pose = { ...pose };
  }

  dispose(): void {
    this.indexed.geometry.dispose();
    this.corners?.geometry.dispose();
  }

  private mesh(geometry: BufferGeometry, material: ShaderMaterial): Mesh {
    geometry.boundingSphere = this.surface.sphere;
    const mesh = new Mesh(geometry, list(material));
    mesh.frustumCulled = false;
    mesh.onBeforeRender = (_renderer, _scene, _camera, _geometry, material, group) => {
      const { uniforms } = this.surface;
      const { paint, span, edges, flight } = this.pose;
      uniforms.paint.value = PAINTS[paint];
      uniforms.span.value.set(...span);
      uniforms.isFilled.value = edges !== "alone";
      uniforms.edges.value = edges === "none" ? 0 : EDGE_STRENGTH;
      uniforms.flight.value = flight;
      uniforms.runColor.value = runColor(geometry.groups.indexOf(group as never));
      (material as ShaderMaterial).uniformsNeedUpdate = true;
    };
    this.group.add(mesh);
    return mesh;
  }
}

/** Groups, which become draws, are looked at only where there is a list of materials. */
function list(material: ShaderMaterial): ShaderMaterial {
  return [material] as unknown as ShaderMaterial;
}

function setRuns(geometry: BufferGeometry, { file, drawnCorners }: Surface, level: number): void {
  geometry.clearGroups();
  if (level < 0) return;
  for (const { start, length } of file.levels.runs(level)) geometry.addGroup(start * drawnCorners, length * drawnCorners, 0);
}

const RUN_COLORS = Array.from({ length: 34 }, (_, run) =>
  // Turning by the golden angle keeps neighbours apart however many there are.
  new Color().setHSL(((run * 137.508 + 150) % 360) / 360, 0.42, 0.62, SRGBColorSpace),
);

/** A colour for each run of a level. */
export function runColor(run: number): Color {
  return RUN_COLORS[Math.max(0, run) % RUN_COLORS.length];
}
