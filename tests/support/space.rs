//! Vectors and the distance of a point to a triangle, with no code of the engine.
#![allow(dead_code, reason = "each test file uses its part")]
#![allow(unreachable_pub, reason = "a test file is no library")]

/// A point or a direction.
pub type Vector = [f64; 3];

pub fn widen(p: [f32; 3]) -> Vector {
    p.map(f64::from)
}

pub fn add_scaled(a: Vector, factor: f64, b: Vector) -> Vector {
    std::array::from_fn(|axis| a[axis] + factor * b[axis])
}

pub fn add(a: Vector, b: Vector) -> Vector {
    add_scaled(a, 1.0, b)
}

pub fn sub(a: Vector, b: Vector) -> Vector {
    add_scaled(a, -1.0, b)
}

pub fn scale(a: Vector, factor: f64) -> Vector {
    a.map(|x| factor * x)
}

pub fn dot(a: Vector, b: Vector) -> f64 {
    (0..3).map(|axis| a[axis] * b[axis]).sum()
}

pub fn cross(a: Vector, b: Vector) -> Vector {
    let minor = |i: usize, k: usize| a[i] * b[k] - a[k] * b[i];
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

pub fn length(a: Vector) -> f64 {
    dot(a, a).sqrt()
}

pub fn distance_sq(a: Vector, b: Vector) -> f64 {
    let difference = sub(a, b);
    dot(difference, difference)
}

/// Squared distance of `p` to a triangle by minimising over it: along each edge, and inside by the
/// normal equations.
pub fn point_triangle_distance_sq(p: Vector, &[a, b, c]: &[Vector; 3]) -> f64 {
    let on_edge = |a: Vector, b: Vector| {
        let (ab, ap) = (sub(b, a), sub(p, a));
        let s = if dot(ab, ab) > 0.0 { (dot(ab, ap) / dot(ab, ab)).clamp(0.0, 1.0) } else { 0.0 };
        distance_sq(p, add_scaled(a, s, ab))
    };
    let mut best = on_edge(a, b).min(on_edge(b, c)).min(on_edge(c, a));
    let (u, v, w) = (sub(b, a), sub(c, a), sub(p, a));
    let (uu, uv, vv, wu, wv) = (dot(u, u), dot(u, v), dot(v, v), dot(w, u), dot(w, v));
    let determinant = uu * vv - uv * uv;
    let (s, t) = ((vv * wu - uv * wv) / determinant, (uu * wv - uv * wu) / determinant);
    if s > 0.0 && t > 0.0 && s + t < 1.0 {
        best = best.min(distance_sq(p, add(a, add(scale(u, s), scale(v, t)))));
    }
    best
}
