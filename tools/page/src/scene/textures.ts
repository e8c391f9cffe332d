// Arrays as textures, for shaders that look into them at any place.

import { DataTexture, FloatType, RedIntegerFormat, RGBAFormat, UnsignedIntType } from "three";

/** Texels of a row at least; every device has textures as wide as that. */
const LEAST_WIDTH = 2048;

/** Rows of one width that hold `length` texels and are about as many as they are wide, where they must be many. */
function size(length: number): [width: number, height: number] {
  const width = Math.max(LEAST_WIDTH, 2 ** Math.ceil(Math.log2(Math.sqrt(length))));
  return [width, Math.max(1, Math.ceil(length / width))];
}

/** Room for `length` times four numbers. */
export function quadsTexture(length: number): DataTexture {
  const [width, height] = size(length);
  const texture = new DataTexture(new Float32Array(4 * width * height), width, height, RGBAFormat, FloatType);
  texture.needsUpdate = true;
  return texture;
}

/** Three numbers and, if there is one, a fourth into each texel. */
export function fillQuads(texture: DataTexture, threes: ArrayLike<number>, fourths: ArrayLike<number> | null): void {
  const data = texture.image.data as Float32Array;
  for (let at = 0, from = 0; from < threes.length; at += 4, from += 3) {
    data[at] = threes[from];
    data[at + 1] = threes[from + 1];
    data[at + 2] = threes[from + 2];
    data[at + 3] = fourths ? fourths[at / 4] : 0;
  }
  texture.needsUpdate = true;
}

/** One whole number per texel. */
export function countsTexture(counts: Uint32Array): DataTexture {
  const [width, height] = size(counts.length);
  const data = new Uint32Array(width * height);
  data.set(counts);
  const texture = new DataTexture(data, width, height, RedIntegerFormat, UnsignedIntType);
  texture.internalFormat = "R32UI";
  texture.needsUpdate = true;
  return texture;
}
