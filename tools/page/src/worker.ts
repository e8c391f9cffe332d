// Work on triangles that takes longer than a frame: normals and nearest points.

import { BufferAttribute, BufferGeometry, Vector3 } from "three";
import { MeshBVH } from "three-mesh-bvh";
import { slice } from "./scene/tetrahedra.ts";
import type { Job, Landed, LandJob, Normals, NormalsJob } from "./work.ts";

/** Vertices that land before the worker checks for another request. */
const N_AT_A_TIME = 4096;

let vertices = new Float32Array(0);
let newestLanding = 0;
let built: { level: number; tree: MeshBVH } | null = null;

onmessage = async ({ data }: MessageEvent<{ id: number; job: Job }>) => {
  const { id, job } = data;
  try {
    if (job.kind === "normals") {
      const result = normals(job);
      postMessage({ id, result }, [result.normals.buffer]);
    } else if (job.kind === "land") {
      newestLanding = id;
      const result = await land(job, () => newestLanding !== id);
      postMessage({ id, result }, result ? [result.positions.buffer, result.distances.buffer] : []);
    } else if (job.kind === "slice") {
      const result = slice(job.tetrahedra, vertices, job.normal, job.distance);
      postMessage({ id, result }, [result.positions.buffer, result.corners.buffer]);
    } else {
      vertices = job.positions;
      built = null;
      postMessage({ id, result: null });
    }
  } catch (error) {
    postMessage({ id, error: error instanceof Error ? error.message : String(error) });
  }
};

/** Each triangle counts at a corner by its angle there, so that the way a polygon was cut does not matter. */
function normals({ positions, indices }: NormalsJob): Normals {
  const normals = new Float32Array(positions.length);
  const [a, b, c] = [new Vector3(), new Vector3(), new Vector3()];
  const [normal, to, fro] = [new Vector3(), new Vector3(), new Vector3()];
  for (let at = 0; at < indices.length; at += 3) {
    const corners = [a, b, c];
    corners.forEach((corner, index) => corner.fromArray(positions, 3 * indices[at + index]));
    normal.subVectors(b, a).cross(to.subVectors(c, a)).normalize();
    corners.forEach((corner, index) => {
      to.subVectors(corners[(index + 1) % 3], corner);
      fro.subVectors(corners[(index + 2) % 3], corner);
      const angle = to.angleTo(fro) || 0;
      const vertex = 3 * indices[at + index];
      normals[vertex] += angle * normal.x;
      normals[vertex + 1] += angle * normal.y;
      normals[vertex + 2] += angle * normal.z;
    });
  }
  for (let at = 0; at < normals.length; at += 3) {
    const length = Math.hypot(normals[at], normals[at + 1], normals[at + 2]);
    if (length > 0) for (let axis = 0; axis < 3; axis++) normals[at + axis] /= length;
  }
  return { normals };
}

async function land(job: LandJob, isObsolete: () => boolean): Promise<Landed | null> {
  const leaving = leavingVertices(job);
  if (built?.level !== job.level) built = { level: job.level, tree: tree(job.onto) };
  const { tree: onto } = built;
  const positions = vertices.slice();
  const distances = new Float32Array(vertices.length / 3);
  const [point, found] = [new Vector3(), { point: new Vector3(), distance: 0, faceIndex: 0 }];
  let largest = 0;
  for (let done = 0; done < leaving.length; done++) {
    if (done % N_AT_A_TIME === N_AT_A_TIME - 1) {
      await new Promise((resolve) => setTimeout(resolve));
      if (isObsolete()) return null;
    }
    const vertex = leaving[done];
    if (!onto.closestPointToPoint(point.fromArray(vertices, 3 * vertex), found)) continue;
    found.point.toArray(positions, 3 * vertex);
    distances[vertex] = found.distance;
    largest = Math.max(largest, found.distance);
  }
  return { positions, distances, largest };
}

function leavingVertices({ from, onto }: LandJob): number[] {
  const isLeaving = new Uint8Array(vertices.length / 3);
  for (const vertex of from) isLeaving[vertex] = 1;
  for (const vertex of onto) isLeaving[vertex] = 0;
  const leaving = [];
  for (let vertex = 0; vertex < isLeaving.length; vertex++) if (isLeaving[vertex]) leaving.push(vertex);
  return leaving;
}

function tree(indices: Uint32Array<ArrayBuffer>): MeshBVH {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(vertices, 3));
  geometry.setIndex(new BufferAttribute(indices, 1));
  return new MeshBVH(geometry);
}
