// How a surface is lit and coloured. The same code serves two ways of drawing it:
//
// * indexed, as a renderer would: ranges of one index buffer over attributes of vertices;
// * by corner, where every corner fetches its vertex from textures: it alone knows its triangle and where in it it lies, which edges and
//   colours by triangle need.

/** What a surface is coloured by, as the shaders number it. */
export const PAINTS = { plain: 0, level: 1, birth: 2, run: 3, deviation: 4 } as const;
export type Paint = keyof typeof PAINTS;

/** Viridis at nine even steps (Smith and van der Walt, 2015, CC0). */
export const RAMP: readonly (readonly [number, number, number])[] = [
  [68, 1, 84],
  [71, 45, 123],
  [59, 82, 139],
  [44, 114, 142],
  [33, 144, 140],
  [39, 173, 129],
  [93, 200, 99],
  [170, 220, 50],
  [253, 231, 37],
];

const ramp = RAMP.map((color) => `vec3(${color.map((byte) => (byte / 255).toFixed(4)).join(", ")})`);

const OUTPUTS = /* glsl */ `
  out vec3 seen;        // position as the camera sees it
  centroid out vec3 place; // position in the mesh, never beyond the triangle
  out vec3 smoothNormal;
  out float part;       // what the ramp colours, from 0 to 1
`;

const EMIT = /* glsl */ `
  uniform vec2 span;    // what has the first colour of the ramp, and what the last
  float onSpan(float value) {
    return (value - span.x) / max(span.y - span.x, 1e-30);
  }
  void emit(vec3 position, vec3 normal) {
    vec4 inView = modelViewMatrix * vec4(position, 1.0);
    seen = inView.xyz;
    place = position;
    smoothNormal = normalMatrix * normal;
    gl_Position = projectionMatrix * inView;
  }
`;

export const indexedVertex = /* glsl */ `
  uniform float flight; // 0: vertices at their own places, 1: where they land
  uniform int paint;
  in vec3 landing;
  in float leaves;
  in float deviation;
  ${OUTPUTS}
  out vec3 corner;
  ${EMIT}
  void main() {
    part = onSpan(paint == ${PAINTS.deviation} ? deviation : leaves);
    corner = vec3(1.0);
    emit(mix(position, landing, flight), normal);
  }
`;

export const cornerVertex = /* glsl */ `
  uniform float flight;
  uniform int paint;
  uniform highp sampler2D positions; // and in w the level at which the vertex leaves
  uniform highp sampler2D normals;   // and in w the deviation
  uniform highp sampler2D landings;
  uniform highp usampler2D births;
  uniform int drawnCorners;
  in uint vertex;
  ${OUTPUTS}
  out vec3 corner;
  ${EMIT}
  ivec2 at(int index, int width) {
    return ivec2(index % width, index / width);
  }
  void main() {
    ivec2 texel = at(int(vertex), textureSize(positions, 0).x);
    vec4 own = texelFetch(positions, texel, 0);
    vec4 normal = texelFetch(normals, texel, 0);
    part = onSpan(paint == ${PAINTS.deviation} ? normal.w : own.w);
    if (paint == ${PAINTS.birth}) {
      part = onSpan(float(texelFetch(births, at(gl_VertexID / drawnCorners, textureSize(births, 0).x), 0).r));
    }
    int id = gl_VertexID % 3;
    corner = vec3(id == 0, id == 1, id == 2);
    emit(flight > 0.0 ? mix(own.xyz, texelFetch(landings, texel, 0).xyz, flight) : own.xyz, normal.xyz);
  }
`;

/** A plane through tetrahedra, which lies where the section cuts and is itself not cut. */
export const sliceVertex = /* glsl */ `
  uniform float radius;
  uniform vec4 section;
  in vec3 corners;
  ${OUTPUTS}
  out vec3 corner;
  ${EMIT}
  void main() {
    part = 0.0;
    corner = corners;
    // A little before the faces that end at the plane, or they would show through along its edges.
    vec3 lift = 1e-3 * radius * section.xyz;
    emit(position + lift, vec3(0.0));
    place -= 2.0 * lift;
  }
`;

export const fragment = /* glsl */ `
  precision highp float;
  uniform int paint;
  uniform bool isSmooth;
  uniform bool isFilled;
  uniform float edges;    // how strongly edges are drawn
  uniform vec3 clay;
  uniform vec3 inside;
  uniform vec3 edgeColor;
  uniform vec3 runColor;
  uniform vec4 section;   // where dot(section.xyz, place) > section.w, nothing is
  uniform float pixelRatio;
  in vec3 seen;
  centroid in vec3 place;
  in vec3 smoothNormal;
  in float part;
  in vec3 corner;
  out vec4 color;

  const vec3 RAMP[${RAMP.length}] = vec3[](${ramp.join(", ")});

  // Light adds up in linear terms; colours are given, and shown, as sRGB.
  vec3 linear(vec3 srgb) {
    return pow(srgb, vec3(2.2));
  }

  vec3 onRamp(float part) {
    float at = clamp(part, 0.0, 1.0) * ${(RAMP.length - 1).toFixed(1)};
    int step = min(int(at), ${RAMP.length - 2});
    return linear(mix(RAMP[step], RAMP[step + 1], at - float(step)));
  }

  vec3 surfaceColor() {
    if (!gl_FrontFacing) return inside;
    if (paint == ${PAINTS.run}) return runColor;
    return paint == ${PAINTS.plain} ? clay : onRamp(part);
  }

  // Lights stand beside the camera: a key from the upper left, a fill from the right, sky from above.
  float lit(vec3 normal, out float shine) {
    vec3 toEye = normalize(-seen);
    vec3 key = normalize(vec3(-0.45, 0.65, 0.8));
    vec3 fill = normalize(vec3(0.8, 0.0, 0.45));
    shine = pow(max(dot(normal, normalize(key + toEye)), 0.0), 40.0) * 0.1;
    return 0.2 + 0.1 * normal.y + 0.72 * max(dot(normal, key), 0.0) + 0.16 * max(dot(normal, fill), 0.0);
  }

  void main() {
    if (dot(section.xyz, place) > section.w) discard;
    vec3 normal = normalize(cross(dFdx(seen), dFdy(seen)));
    if (isSmooth && dot(smoothNormal, smoothNormal) > 0.01) {
      normal = normalize(smoothNormal) * (gl_FrontFacing ? 1.0 : -1.0);
    }
    float shine;
    float light = lit(normal, shine);
    // A shine would pass for a colour of the ramp.
    vec3 shaded = surfaceColor() * light + (paint == 0 ? shine : 0.25 * shine);

    // Distance to the nearest edge in pixels, softened over one; where triangles are as small as that, edges fade.
    vec3 width = fwidth(corner);
    vec3 inPixels = corner / max(width, 1e-6) / pixelRatio;
    float nearest = min(inPixels.x, min(inPixels.y, inPixels.z));
    float size = 1.0 / max(max(width.x, max(width.y, width.z)), 1e-6) / pixelRatio;
    float edge = edges * (1.0 - smoothstep(0.2, 1.1, nearest)) * mix(0.12, 1.0, smoothstep(2.0, 14.0, size));
    if (!isFilled && edge < 0.02) discard;
    shaded = pow(shaded, vec3(1.0 / 2.2));
    vec3 line = pow(edgeColor, vec3(1.0 / 2.2));
    color = isFilled ? vec4(mix(shaded, line, edge), 1.0) : vec4(line, edge);
  }
`;
