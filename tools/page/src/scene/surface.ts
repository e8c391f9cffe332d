// One file's surface on the graphics card: static buffers, of which a level draws ranges.

import {
  BufferAttribute,
  BufferGeometry,
  Color,
  DoubleSide,
  FrontSide,
  GLSL3,
  type IUniform,
  Mesh,
  ShaderMaterial,
  Sphere,
  Vector2,
  Vector3,
  Vector4,
} from "three";
import type { Piece } from "../neph/arrival.ts";
import type { NephFile } from "../neph/file.ts";
import { EDGE_STRENGTH, Figure } from "./figure.ts";
import { cornerVertex, fragment, indexedVertex, PAINTS, sliceVertex } from "./shaders.ts";
import { drawnCorners, fillFaces, type Slice } from "./tetrahedra.ts";
import { countsTexture, fillQuads, quadsTexture } from "./textures.ts";

const CLAY = new Color(0xb4c9bd);
const INSIDE = new Color(0x8f857c);
const CUT_INSIDE = new Color(0xc4714c);
const EDGE = new Color(0x12241c);

/** Where vertices come to lie on another level, and how far that is. */
export interface Landing {
  positions: Float32Array<ArrayBuffer>;
  distances: Float32Array<ArrayBuffer>;
}

/** What all figures of a surface share. */
export interface Look {
  isSmooth: boolean;
  /** Normal and distance of the plane beyond which nothing is drawn. */
  section: Vector4 | null;
  pixelRatio: number;
}

export class Surface {
  /** Around all vertices. */
  readonly sphere: Sphere;
  readonly indexedMaterial: ShaderMaterial;
  readonly cornerMaterial: ShaderMaterial;
  /** For edges alone, over what another figure has drawn at the same place. */
  readonly edgeMaterial: ShaderMaterial;
  /** The index buffer: every slot of the file, in the order of the file. */
  readonly index: BufferAttribute;
  readonly attributes: Record<"position" | "normal" | "leaves" | "landing" | "deviation", BufferAttribute>;
  readonly uniforms: Record<string, IUniform>;
  /** Corners of the index buffer that a slot takes. */
  readonly drawnCorners: number;
  /** The plane through tetrahedra where they are cut. */
  readonly slice: Mesh;
  private readonly figures: Figure[] = [];
  private cornerAttribute: BufferAttribute | null = null;
  private readonly sliceMaterial: ShaderMaterial;

  constructor(readonly file: NephFile) {
    const { nVertices, boundsMin, boundsMax } = file.head;
    this.drawnCorners = drawnCorners(file.head.nCorners);
    const isVolume = file.head.nCorners === 4;
    this.index = new BufferAttribute(isVolume ? new Uint32Array(file.head.nSlots * this.drawnCorners) : file.indices, 1);
    this.attributes = {
      position: new BufferAttribute(file.positions, 3),
      normal: new BufferAttribute(new Float32Array(3 * nVertices), 3),
      leaves: new BufferAttribute(leaves(file), 1),
      landing: new BufferAttribute(new Float32Array(3 * nVertices), 3),
      deviation: new BufferAttribute(new Float32Array(nVertices), 1),
    };
    const centre = new Vector3(...boundsMin).add(new Vector3(...boundsMax)).multiplyScalar(0.5);
    this.sphere = new Sphere(centre, file.diagonal / 2);
    const values = {
      paint: PAINTS.plain,
      isSmooth: false,
      isFilled: true,
      edges: 0,
      clay: CLAY,
      inside: INSIDE,
      edgeColor: EDGE,
      runColor: new Color(),
      section: new Vector4(0, 0, 0, 1),
      pixelRatio: 1,
      flight: 0,
      drawnCorners: this.drawnCorners,
      radius: file.diagonal / 2,
      span: new Vector2(0, 1),
      positions: quadsTexture(1),
      normals: quadsTexture(1),
      landings: quadsTexture(1),
      births: countsTexture(new Uint32Array(1)),
    };
    this.uniforms = Object.fromEntries(Object.entries(values).map(([name, value]) => [name, { value }]));
    this.indexedMaterial = this.material(indexedVertex);
    this.cornerMaterial = this.material(cornerVertex);
    this.edgeMaterial = this.material(cornerVertex);
    this.sliceMaterial = this.material(sliceVertex);
    this.slice = this.sliceMesh();
    Object.assign(this.edgeMaterial, {
      transparent: true,
      depthWrite: false,
      polygonOffset: true,
      polygonOffsetFactor: -1,
      polygonOffsetUnits: -4,
    });
  }

  private sliceMesh(): Mesh {
    const mesh = new Mesh(new BufferGeometry(), this.sliceMaterial);
    mesh.frustumCulled = false;
    mesh.visible = false;
    mesh.onBeforeRender = () => {
      const { paint, runColor, isFilled, edges } = this.uniforms;
      [paint.value, runColor.value, isFilled.value, edges.value] = [PAINTS.run, CUT_INSIDE, true, EDGE_STRENGTH];
      this.sliceMaterial.uniformsNeedUpdate = true;
    };
    return mesh;
  }

  /** A way to draw a level of this surface. */
  figure(): Figure {
    const figure = new Figure(this);
    this.figures.push(figure);
    return figure;
  }

  /** Takes over what has arrived: that part of the buffers is uploaded, once. */
  arrived({ of, start, end }: Piece): void {
    if (of === "slots") {
      const { index, file, drawnCorners } = this;
      if (index.array !== file.indices) fillFaces(index.array as Uint32Array, file.indices, start, end);
      for (const attribute of [index, this.cornerAttribute]) {
        attribute?.addUpdateRange(start * drawnCorners, (end - start) * drawnCorners);
        if (attribute) attribute.needsUpdate = true;
      }
    } else {
      const { position } = this.attributes;
      position.addUpdateRange(3 * start, 3 * (end - start));
      position.needsUpdate = true;
      if (this.cornerAttribute) this.fillVertices();
    }
  }

  setNormals(normals: Float32Array): void {
    replace(this.attributes.normal, normals);
    if (this.cornerAttribute) this.fillNormals();
  }

  setBirths(births: Uint32Array): void {
    this.uniforms.births.value.dispose();
    this.uniforms.births.value = countsTexture(births);
  }

  setLanding({ positions, distances }: Landing): void {
    replace(this.attributes.landing, positions);
    replace(this.attributes.deviation, distances);
    if (this.cornerAttribute) this.fillLandings();
  }

  setLook({ isSmooth, section, pixelRatio }: Look): void {
    const { uniforms } = this;
    uniforms.isSmooth.value = isSmooth;
    uniforms.inside.value = section ? CUT_INSIDE : INSIDE;
    uniforms.section.value = section ?? new Vector4(0, 0, 0, 1);
    uniforms.pixelRatio.value = pixelRatio;
  }

  /** Every corner of every slot: the index buffer as an attribute. Made, with the textures it needs, when it is first asked for. */
  corners(): BufferAttribute {
    if (!this.cornerAttribute) {
      this.cornerAttribute = new BufferAttribute(this.index.array, 1);
      for (const name of ["positions", "normals", "landings"]) {
        this.uniforms[name].value.dispose();
        this.uniforms[name].value = quadsTexture(this.file.head.nVertices);
      }
      this.fillVertices();
      this.fillNormals();
      this.fillLandings();
    }
    return this.cornerAttribute;
  }

  /** Shows a plane through tetrahedra, or none. */
  setSlice(slice: Slice | null): void {
    this.slice.visible = slice !== null;
    this.slice.geometry.dispose();
    this.slice.geometry = new BufferGeometry();
    this.slice.geometry.boundingSphere = this.sphere;
    this.slice.geometry.setAttribute("position", new BufferAttribute(slice?.positions ?? new Float32Array(0), 3));
    this.slice.geometry.setAttribute("corners", new BufferAttribute(slice?.corners ?? new Float32Array(0), 3));
  }

  dispose(): void {
    this.slice.geometry.dispose();
    this.sliceMaterial.dispose();
    for (const figure of this.figures) figure.dispose();
    for (const { value } of Object.values(this.uniforms)) value?.dispose?.();
    this.indexedMaterial.dispose();
    this.cornerMaterial.dispose();
    this.edgeMaterial.dispose();
  }

  private fillVertices(): void {
    fillQuads(this.uniforms.positions.value, this.attributes.position.array, this.attributes.leaves.array);
  }

  private fillNormals(): void {
    fillQuads(this.uniforms.normals.value, this.attributes.normal.array, this.attributes.deviation.array);
  }

  private fillLandings(): void {
    fillQuads(this.uniforms.landings.value, this.attributes.landing.array, null);
    this.fillNormals();
  }

  private material(vertexShader: string): ShaderMaterial {
    // Between two tetrahedra lie two faces, of which one looks this way; nothing is seen from behind but through a section, which is filled.
    const side = this.file.head.nCorners === 4 && vertexShader !== sliceVertex ? FrontSide : DoubleSide;
    const material = new ShaderMaterial({ vertexShader, fragmentShader: fragment, glslVersion: GLSL3, side });
    // One set of uniforms for both ways of drawing.
    material.uniforms = this.uniforms;
    return material;
  }
}

function replace(attribute: BufferAttribute, values: ArrayLike<number>): void {
  (attribute.array as Float32Array).set(values);
  attribute.clearUpdateRanges();
  attribute.needsUpdate = true;
}

/** For each vertex the last level that has it. Vertices are ordered by it. */
function leaves({ head, levels }: NephFile): Float32Array<ArrayBuffer> {
  const leaves = new Float32Array(head.nVertices);
  let from = 0;
  for (let level = levels.coarsest; level >= 0; level--) {
    leaves.fill(level, from, levels.vertexCounts[level]);
    from = Math.max(from, levels.vertexCounts[level]);
  }
  return leaves;
}
