//! Arithmetic on `[f64; 3]`, the one vector type of the engine's geometry.

/// A point or a vector in space.
pub(crate) type Vector = [f64; 3];

/// `a + b`.
#[inline(always)]
pub(crate) fn add(a: Vector, b: Vector) -> Vector {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// `a - b`.
#[inline(always)]
pub(crate) fn sub(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// `factor * a`.
#[inline(always)]
pub(crate) fn scale(a: Vector, factor: f64) -> Vector {
    [factor * a[0], factor * a[1], factor * a[2]]
}

/// `a + factor * b`.
#[inline(always)]
pub(crate) fn add_scaled(a: Vector, factor: f64, b: Vector) -> Vector {
    [a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]]
}

/// Inner product.
#[inline(always)]
pub(crate) fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Cross product, right-handed.
#[inline(always)]
pub(crate) fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Squared length.
#[inline(always)]
pub(crate) fn length_sq(a: Vector) -> f64 {
    dot(a, a)
}

/// Length.
#[inline(always)]
pub(crate) fn length(a: Vector) -> f64 {
    length_sq(a).sqrt()
}

/// Squared distance between two points.
#[inline(always)]
pub(crate) fn distance_sq(a: Vector, b: Vector) -> f64 {
    length_sq(sub(a, b))
}

/// `(a + b) / 2`, the same for either order of the arguments.
#[inline(always)]
pub(crate) fn midpoint(a: Vector, b: Vector) -> Vector {
    scale(add(a, b), 0.5)
}

/// Smaller of each coordinate.
#[inline(always)]
pub(crate) fn min(a: Vector, b: Vector) -> Vector {
    [a[0].min(b[0]), a[1].min(b[1]), a[2].min(b[2])]
}

/// Larger of each coordinate.
#[inline(always)]
pub(crate) fn max(a: Vector, b: Vector) -> Vector {
    [a[0].max(b[0]), a[1].max(b[1]), a[2].max(b[2])]
}

/// An `f32` position in `f64`, exactly.
#[inline(always)]
pub(crate) fn widen(a: [f32; 3]) -> Vector {
    [f64::from(a[0]), f64::from(a[1]), f64::from(a[2])]
}
