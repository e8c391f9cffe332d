// A field under the sun: backdrop of sky and ground, shadows on the ground, objects.

struct Scene {
    view_projection: mat4x4f,
    to_world: mat4x4f,
    // w: 1 where triangles are shaded flat.
    eye: vec4f,
    // Unit vector towards the sun. w: distance at which haze takes about two thirds.
    sun: vec4f,
}

@group(0) @binding(0) var<uniform> scene: Scene;

const SUNLIGHT = vec3f(2.1, 1.95, 1.7);
const SKYLIGHT = vec3f(0.42, 0.52, 0.66);
const BOUNCE = vec3f(0.26, 0.23, 0.18);
const GROUND = vec3f(0.30, 0.285, 0.255);
const HORIZON = vec3f(0.66, 0.72, 0.78);
const ZENITH = vec3f(0.14, 0.28, 0.52);
const CELL = 2.3;

fn hazed(color: vec3f, distance: f32) -> vec3f {
    return mix(HORIZON, color, exp(-distance / scene.sun.w));
}

// Light that leaves the ground at a place; `sunlit` is 0 in shadow.
fn ground(place: vec2f, sunlit: f32) -> vec3f {
    let width = max(fwidth(place), vec2f(1e-5));
    let to_line = abs(fract(place / CELL + 0.5) - 0.5) * CELL;
    let lines = (1.0 - smoothstep(vec2f(0.0), width + 0.02, to_line)) * 0.04 / (width + 0.04);
    let albedo = GROUND * (1.0 - 0.25 * max(lines.x, lines.y));
    let light = albedo * (SKYLIGHT + sunlit * SUNLIGHT * scene.sun.y);
    return hazed(light, distance(scene.eye.xyz, vec3f(place.x, 0.0, place.y)));
}

struct Backdrop {
    @builtin(position) position: vec4f,
    @location(0) far: vec4f,
}

@vertex
fn backdrop_vertex(@builtin(vertex_index) index: u32) -> Backdrop {
    // One triangle over the whole picture.
    let corner = vec2f(f32(index & 1) * 4.0 - 1.0, f32(index >> 1) * 4.0 - 1.0);
    return Backdrop(vec4f(corner, 0.5, 1.0), scene.to_world * vec4f(corner, 0.5, 1.0));
}

@fragment
fn backdrop_fragment(in: Backdrop) -> @location(0) vec4f {
    let ray = normalize(in.far.xyz / in.far.w - scene.eye.xyz);
    let reach = scene.eye.y / max(-ray.y, 1e-4);
    let on_ground = ground(scene.eye.xz + reach * ray.xz, 1.0);
    let sky = mix(HORIZON, ZENITH, smoothstep(0.0, 0.6, ray.y));
    return vec4f(select(sky, on_ground, ray.y < 0.0), 1.0);
}

struct Vertex {
    @location(0) position: vec3f,
    @location(1) normal: vec4f,
    // Rows of the matrix from mesh units to the scene: turned, moved, scaled evenly.
    @location(2) row_x: vec4f,
    @location(3) row_y: vec4f,
    @location(4) row_z: vec4f,
    @location(5) color: vec4f,
}

fn in_scene(vertex: Vertex) -> vec3f {
    let point = vec4f(vertex.position, 1.0);
    return vec3f(dot(vertex.row_x, point), dot(vertex.row_y, point), dot(vertex.row_z, point));
}

struct Shadow {
    @builtin(position) position: vec4f,
    @location(0) place: vec2f,
}

@vertex
fn shadow_vertex(vertex: Vertex) -> Shadow {
    let point = in_scene(vertex);
    let place = point.xz - scene.sun.xz * point.y / scene.sun.y;
    return Shadow(scene.view_projection * vec4f(place.x, 0.0, place.y, 1.0), place);
}

// Opaque: where shadows overlap, the ground is as dark as under one.
@fragment
fn shadow_fragment(in: Shadow) -> @location(0) vec4f {
    return vec4f(ground(in.place, 0.0), 1.0);
}

struct Object {
    @builtin(position) position: vec4f,
    @location(0) point: vec3f,
    @location(1) normal: vec3f,
    @location(2) color: vec3f,
}

@vertex
fn object_vertex(vertex: Vertex) -> Object {
    let point = in_scene(vertex);
    let n = vertex.normal.xyz;
    let normal = vec3f(dot(vertex.row_x.xyz, n), dot(vertex.row_y.xyz, n), dot(vertex.row_z.xyz, n));
    return Object(scene.view_projection * vec4f(point, 1.0), point, normalize(normal), vertex.color.rgb);
}

@fragment
fn object_fragment(in: Object, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    let to_eye = scene.eye.xyz - in.point;
    let across = cross(dpdx(in.point), dpdy(in.point));
    let flat_normal = across * sign(dot(across, to_eye));
    let smooth_normal = select(-in.normal, in.normal, is_front);
    let normal = normalize(select(smooth_normal, flat_normal, scene.eye.w > 0.5));
    let eye = normalize(to_eye);
    let sun = scene.sun.xyz;

    let around = mix(BOUNCE, SKYLIGHT, 0.5 + 0.5 * normal.y);
    // Objects stand on the ground: less light reaches what is low and turned down.
    let open = mix(0.55, 1.0, smoothstep(0.0, 0.8, in.point.y));
    let sunlit = max(dot(normal, sun), 0.0);
    let shine = pow(max(dot(normal, normalize(sun + eye)), 0.0), 60.0) * sunlit * 0.35;
    let rim = pow(1.0 - max(dot(normal, eye), 0.0), 4.0) * 0.25;
    let light = in.color * (around * open + SUNLIGHT * sunlit) + SUNLIGHT * shine + SKYLIGHT * rim;
    return vec4f(hazed(light, length(to_eye)), 1.0);
}
