//! A star seen along its average normal: where fans are valid, and how far they are from it.
//!
//! Seen that way, a star and the fan that is to take its place cover the same polygon, and the
//! height of the one over the other is linear between a few places: the vertex, and where a new
//! edge crosses an old one. The largest height is found there. It is no less than the distance
//! between the two surfaces either way, and costs a few cross products where distances between
//! points and triangles would cost fifty.

use super::classify::Geometry;
use super::ring::Ring;
use crate::geometry::vector::{Vector, add_scaled, cross, dot, length_sq, sub};

/// Sines below this count as no turn at all: the fan's triangle would be a line.
const LEAST_SINE: f64 = 1e-6;

/// The neighbours of a vertex, relative to it, over its average plane. Reused from vertex to
/// vertex.
#[derive(Clone, Debug, Default)]
pub(crate) struct Shadow {
    points: Vec<Point>,
    /// Whether triangles without area are let pass.
    is_degenerate: bool,
    /// Whether no triangle of the star is turned over, and they go around the vertex once.
    is_height_field: bool,
}

/// A place in the plane, and the height above it.
#[derive(Clone, Copy, Debug)]
struct Point {
    x: f64,
    y: f64,
    height: f64,
}

impl Point {
    /// Twice the area that this and another one span with the vertex.
    #[inline]
    fn turn(self, to: Self) -> f64 {
        self.x * to.y - self.y * to.x
    }

    #[inline]
    fn from(self, start: Self) -> Self {
        Self { x: self.x - start.x, y: self.y - start.y, height: self.height - start.height }
    }

    #[inline]
    fn length_sq(self) -> f64 {
        self.x * self.x + self.y * self.y
    }
}

impl Shadow {
    /// Looks at a star. O(valence).
    pub(crate) fn gather(&mut self, ring: &Ring, geometry: &Geometry) {
        let [u, v, w] = axes(geometry.plane.normal);
        self.points.clear();
        self.points.extend(geometry.points.iter().map(|&point| {
            let spoke = sub(point, geometry.apex);
            Point { x: dot(u, spoke), y: dot(v, spoke), height: dot(w, spoke) }
        }));
        self.is_degenerate = geometry.is_degenerate;
        self.is_height_field = ring.is_cycle() && self.surrounds_the_vertex();
    }

    /// Leaves the last neighbour out, which is at the place of the first: the vertex at a crack's
    /// tip is then seen as surrounded.
    pub(crate) fn close_crack(&mut self) {
        self.points.pop();
    }

    /// Whether [`Self::height_over_fan`] can be asked.
    #[inline]
    pub(crate) fn is_height_field(&self) -> bool {
        self.is_height_field
    }

    fn surrounds_the_vertex(&self) -> bool {
        let n = self.points.len();
        let mut n_rounds = 0;
        for i in 0..n {
            let (a, b) = (self.points[i], self.points[if i + 1 == n { 0 } else { i + 1 }]);
            if a.turn(b) <= 0.0 {
                return false;
            }
            n_rounds += u32::from(a.y < 0.0 && b.y >= 0.0);
        }
        n >= 3 && n_rounds == 1
    }

    /// The half-space comparison: every plane through neighbour `into` and another neighbour, along
    /// the average normal, has the loop's vertices before that one on one side and those behind it
    /// on the other.
    ///
    /// Done as the paper has it that takes `n^2` plane equations. Seen from `into`, the loop must
    /// turn one way only, and no part of it that a plane looks at may turn by half a circle; that
    /// is `3 n` of them. A fan of a single triangle, which no plane cuts, must not be turned over
    /// either.
    pub(crate) fn is_valid_fan(&self, into: usize) -> bool {
        let n_others = self.points.len() - 1;
        if n_others < 2 {
            return true;
        }
        let spoke = |k: usize| self.at(into, k).from(self.points[into]);
        let turns = |a: Point, b: Point| {
            let turn = a.turn(b);
            let least_sq = LEAST_SINE * LEAST_SINE * a.length_sq() * b.length_sq();
            if self.is_degenerate { turn >= 0.0 } else { turn > 0.0 && turn * turn > least_sq }
        };
        let (first, second) = (spoke(1), spoke(2));
        let mut before = first;
        for k in 2..=n_others {
            let this = spoke(k);
            let within_half =
                (k == n_others || turns(first, this)) && (k < n_others || k == 2 || turns(second, this));
            if !turns(before, this) || !within_half {
                return false;
            }
            before = this;
        }
        true
    }

    /// Largest height between the star, a height field, and the valid fan from neighbour `into`;
    /// `None` if that is not below `limit`. O(valence^2), and less where the limit is passed
    /// early.
    pub(crate) fn height_over_fan(&self, into: usize, limit: f64) -> Option<f64> {
        let n = self.points.len();
        let target = self.points[into];
        let mut highest = self.height_at_vertex(into);
        for k in 2..n - 1 {
            if highest >= limit {
                return None;
            }
            let edge = self.at(into, k).from(target);
            // On the side of the new edge where the vertex is not, the spokes cross it.
            let across = target.turn(edge);
            let crossing = if across > 0.0 { 1..k } else { k + 1..n };
            for spoke in crossing.map(|m| self.at(into, m)) {
                let whole = spoke.turn(edge);
                let (on_spoke, on_edge) = (across / whole, target.turn(spoke) / whole);
                let height = target.height + on_edge * edge.height - on_spoke * spoke.height;
                // A spoke along the edge gives no number, and is not counted.
                highest = highest.max(height.abs());
            }
        }
        (highest < limit).then_some(highest)
    }

    /// What the heights of the vertex and its neighbours spread over, if the star is a height
    /// field: no valid fan is higher over it. O(valence).
    pub(crate) fn spread(&self) -> Option<f64> {
        let heights = self.points.iter().map(|point| point.height);
        let (low, high) = heights.fold((0.0_f64, 0.0_f64), |(low, high), h| (low.min(h), high.max(h)));
        self.is_height_field.then_some(high - low)
    }

    /// Height of the fan over the vertex.
    fn height_at_vertex(&self, into: usize) -> f64 {
        let n = self.points.len();
        let target = self.points[into];
        let mut k = 1;
        while k + 2 < n && target.turn(self.at(into, k + 1)) > 0.0 {
            k += 1;
        }
        let (a, b) = (self.at(into, k), self.at(into, k + 1));
        let weights = [a.turn(b), b.turn(target), target.turn(a)];
        let whole: f64 = weights.iter().sum();
        let heights = weights[0] * target.height + weights[1] * a.height + weights[2] * b.height;
        if whole > 0.0 { (heights / whole).abs() } else { f64::INFINITY }
    }

    /// The `k`-th neighbour after neighbour `into`, `k` at most their number.
    #[inline]
    fn at(&self, into: usize, k: usize) -> Point {
        let at = into + k;
        self.points[if at < self.points.len() { at } else { at - self.points.len() }]
    }
}

/// Two axes of the plane with this normal, and the normal, each one long; nothing but zeros where
/// the normal is zero.
fn axes(normal: Vector) -> [Vector; 3] {
    let unit = |vector: Vector| {
        let size_sq = length_sq(vector);
        if size_sq > 0.0 { vector.map(|x| x / size_sq.sqrt()) } else { [0.0; 3] }
    };
    let w = unit(normal);
    let [x, y, z] = w.map(f64::abs);
    let aside = if x <= y && x <= z {
        [1.0, 0.0, 0.0]
    } else if y <= z {
        [0.0, 1.0, 0.0]
    } else {
        [0.0, 0.0, 1.0]
    };
    let u = unit(add_scaled(aside, -dot(aside, w), w));
    if length_sq(w) > 0.0 { [u, cross(w, u), w] } else { [[0.0; 3]; 3] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::distance::point_triangle_distance_sq;
    use proptest::prelude::*;

    fn star(radii: &[f64], heights: &[f64]) -> Geometry {
        let n = radii.len();
        let mut geometry = Geometry::default();
        geometry.plane.normal = [0.0, 0.0, 1.0];
        geometry.points.extend((0..n).map(|i| {
            let (sin, cos) = (std::f64::consts::TAU * i as f64 / n as f64).sin_cos();
            [radii[i] * cos, radii[i] * sin, heights[i]]
        }));
        geometry
    }

    fn shadow_of(geometry: &Geometry) -> Shadow {
        let mut ring = Ring::default();
        ring.shape = super::super::ring::Shape::Cycle;
        let mut shadow = Shadow::default();
        shadow.gather(&ring, geometry);
        shadow
    }

    /// The test as the paper has it: every split plane, every vertex.
    fn planes_separate(geometry: &Geometry, n: usize, into: usize) -> bool {
        let at = |k: usize| geometry.points[(into + k) % n];
        (2..n - 1).all(|j| {
            let plane = cross(geometry.plane.normal, sub(at(j), at(0)));
            let side = |k: usize| dot(plane, sub(at(k), at(0)));
            (1..j).all(|k| side(k) < 0.0) && (j + 1..n).all(|k| side(k) > 0.0)
        })
    }

    proptest! {
        #[test]
        fn few_turns_say_what_all_half_spaces_say(
            radii in prop::collection::vec(0.2_f64..1.0, 4..9), heights in prop::collection::vec(-0.2_f64..0.2, 9)
        ) {
            let geometry = star(&radii, &heights);
            let shadow = shadow_of(&geometry);
            for into in 0..radii.len() {
                prop_assert_eq!(shadow.is_valid_fan(into), planes_separate(&geometry, radii.len(), into));
            }
        }

        #[test]
        fn no_point_of_a_fan_is_farther_from_the_star_than_the_height(
            radii in prop::collection::vec(0.6_f64..1.0, 4..9), heights in prop::collection::vec(-0.5_f64..0.5, 9),
            weights in prop::collection::vec((0.0_f64..1.0, 0.0_f64..1.0), 8)
        ) {
            let geometry = star(&radii, &heights);
            let shadow = shadow_of(&geometry);
            prop_assert!(shadow.is_height_field());
            let n = radii.len();
            for into in (0..n).filter(|&into| shadow.is_valid_fan(into)) {
                let height = shadow.height_over_fan(into, f64::INFINITY).unwrap();
                prop_assert_eq!(shadow.height_over_fan(into, height), None);
                let at = |k: usize| geometry.points[(into + k) % n];
                for k in 1..n - 1 {
                    for &(a, b) in &weights {
                        let (a, b) = if a + b > 1.0 { (1.0 - a, 1.0 - b) } else { (a, b) };
                        let edge = |to: Vector| sub(to, at(0));
                        let point = add_scaled(add_scaled(at(0), a, edge(at(k))), b, edge(at(k + 1)));
                        let spokes = (0..n).map(|i| [[0.0; 3], geometry.points[i], geometry.points[(i + 1) % n]]);
                        let distance_sq = spokes.map(|t| point_triangle_distance_sq(point, &t)).fold(f64::INFINITY, f64::min);
                        prop_assert!(distance_sq.sqrt() <= height + 1e-12, "{} over {}", distance_sq.sqrt(), height);
                    }
                }
            }
        }
    }
}
