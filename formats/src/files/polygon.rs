//! Cuts polygons, also concave ones, into triangles over their own corners.
//!
//! A convex polygon becomes a fan from its first corner, as in nearly every other reader: if it is
//! not flat, the choice of diagonals is part of the surface. For any other polygon a fan is wrong.
//! Ear-cutting libraries made for drawing drop corners on straight edges, which tears a surface
//! apart if a neighbour uses such a corner. Here a polygon of n corners always gives n - 2
//! triangles that use every corner. The method follows G. H. Meisters, "Polygons have ears"
//! (American Mathematical Monthly 82, 1975): cut off a convex corner whose triangle contains no
//! other corner, until a triangle is left.
//!
//! The polygon is projected along the axis nearest to its normal (M. E. Newell's: areas of the
//! projections onto the coordinate planes), which keeps the coordinates exact. Only reflex and flat
//! corners can block an ear. They are sorted along both axes, and the axis along which an ear spans
//! fewer of them is searched. The work per corner is bounded, so a hostile polygon costs time in
//! proportion to its corners. What is left when the bound is reached, or when a polygon that
//! crosses itself has no ear, becomes a fan.

/// Cuts polygons into triangles, and reuses its buffers.
pub(crate) struct Triangulator {
    /// Corners projected along the axis nearest to the normal, counter-clockwise.
    flat: Vec<[f64; 2]>,
    /// Ring of the corners not yet cut off.
    next: Vec<usize>,
    previous: Vec<usize>,
    is_cut: Vec<bool>,
    /// Corners that are not strictly convex, by ascending first and by ascending second coordinate.
    blockers: [Vec<usize>; 2],
    /// Corners that may still be looked at before the rest becomes a fan. Every polygon adds to it,
    /// and what one does not use is left for the next. So all polygons together take at most time
    /// in proportion to their corners, plus a constant.
    budget: usize,
}

/// Looks per corner, on average over all polygons, before giving up; and additional looks once
/// (half a second).
const LOOKS_PER_CORNER: usize = 1024;
const LOOKS_AT_FIRST: usize = 1 << 29;

impl Default for Triangulator {
    fn default() -> Self {
        Self {
            flat: Vec::new(),
            next: Vec::new(),
            previous: Vec::new(),
            is_cut: Vec::new(),
            blockers: Default::default(),
            budget: LOOKS_AT_FIRST,
        }
    }
}

impl Triangulator {
    /// Appends the `n - 2` triangles of a polygon of `n >= 3` corners, as places in `corners`, in
    /// the rotational sense of the polygon.
    ///
    /// Returns whether all of them have the orientation of the polygon. For a polygon that does not
    /// cross itself they then tile it exactly, because their oriented areas add up to the polygon
    /// at every point of the plane. Costs about n log n for the polygons of real files, n^2 for
    /// hostile ones until the bound on work is reached.
    pub(crate) fn triangulate(&mut self, corners: &[[f32; 3]], triangles: &mut Vec<[usize; 3]>) -> bool {
        match corners.len() {
            0..=2 => true,
            3 => {
                triangles.push([0, 1, 2]);
                true
            }
            4 => {
                let (halves, is_tiled) = split_quad(corners);
                triangles.extend(halves);
                is_tiled
            }
            _ => {
                self.lay_flat(corners);
                self.cut_ears(triangles)
            }
        }
    }

    /// Fills the buffers for a polygon: projection, ring and blockers.
    fn lay_flat(&mut self, corners: &[[f32; 3]]) {
        let n_corners = corners.len();
        let normal = newell_normal(corners);
        let axis =
            (0..3).fold(0, |best, axis| if normal[axis].abs() > normal[best].abs() { axis } else { best });
        let (mut first, mut second) = ((axis + 1) % 3, (axis + 2) % 3);
        if normal[axis] < 0.0 {
            (first, second) = (second, first);
        }
        self.flat.clear();
        self.flat.extend(corners.iter().map(|corner| [f64::from(corner[first]), f64::from(corner[second])]));
        self.next.clear();
        self.next.extend((1..n_corners).chain([0]));
        self.previous.clear();
        self.previous.extend([n_corners - 1].into_iter().chain(0..n_corners - 1));
        self.is_cut.clear();
        self.is_cut.resize(n_corners, false);
        let (flat, previous, next) = (&self.flat, &self.previous, &self.next);
        let blocks =
            |&corner: &usize| orientation(flat[previous[corner]], flat[corner], flat[next[corner]]) <= 0.0;
        for (axis, blockers) in self.blockers.iter_mut().enumerate() {
            blockers.clear();
            blockers.extend((0..n_corners).filter(blocks));
            blockers.sort_by(|&a, &b| flat[a][axis].total_cmp(&flat[b][axis]));
        }
        self.budget = self.budget.saturating_add(LOOKS_PER_CORNER * n_corners);
    }

    /// Walks around the ring and cuts ears. Fans the rest if it has no ear, or if it is convex and
    /// needs none.
    fn cut_ears(&mut self, triangles: &mut Vec<[usize; 3]>) -> bool {
        let mut n_left = self.flat.len();
        let mut n_since_cut = 0;
        let mut corner = 0;
        let is_convex = self.blockers[0].is_empty();
        while !is_convex && n_left > 3 && n_since_cut < n_left && self.budget > 0 {
            let [before, after] = [self.previous[corner], self.next[corner]];
            if self.is_ear([before, corner, after]) {
                triangles.push([before, corner, after]);
                self.next[before] = after;
                self.previous[after] = before;
                self.is_cut[corner] = true;
                n_left -= 1;
                n_since_cut = 0;
                // Skipping the neighbour keeps the walk from cutting slivers off one corner.
                corner = self.next[after];
            } else {
                n_since_cut += 1;
                corner = after;
            }
        }
        let mut is_tiled = true;
        let apex = corner;
        let mut second = self.next[apex];
        for _ in 0..n_left - 2 {
            let third = self.next[second];
            is_tiled &= orientation(self.flat[apex], self.flat[second], self.flat[third]) >= 0.0;
            triangles.push([apex, second, third]);
            second = third;
        }
        is_tiled
    }

    /// Whether a corner with its neighbours is strictly convex and its triangle holds no other
    /// corner.
    fn is_ear(&mut self, triangle: [usize; 3]) -> bool {
        self.budget = self.budget.saturating_sub(1);
        let [a, b, c] = triangle.map(|corner| self.flat[corner]);
        if orientation(a, b, c) <= 0.0 {
            return false;
        }
        let blocks = |&blocker: &usize| {
            let point = self.flat[blocker];
            // A corner at the position of a corner of the ear is the other side of a cut that
            // reaches a hole.
            let is_apart = point != a && point != b && point != c;
            is_apart
                && !self.is_cut[blocker]
                && orientation(a, b, point) >= 0.0
                && orientation(b, c, point) >= 0.0
                && orientation(c, a, point) >= 0.0
        };
        let near = self.blockers_near([a, b, c]);
        let first = near.iter().take(self.budget).position(blocks);
        self.budget = self.budget.saturating_sub(first.map_or(near.len(), |place| place + 1));
        first.is_none()
    }

    /// The blocking corners beside a triangle, along the axis that leaves fewer of them.
    fn blockers_near(&self, triangle: [[f64; 2]; 3]) -> &[usize] {
        let [along_first, along_second] = [0, 1].map(|axis| {
            let values = triangle.map(|corner| corner[axis]);
            let low = values.into_iter().fold(f64::INFINITY, f64::min);
            let high = values.into_iter().fold(f64::NEG_INFINITY, f64::max);
            let sorted = &self.blockers[axis];
            let start = sorted.partition_point(|&corner| self.flat[corner][axis] < low);
            let length = sorted[start..].partition_point(|&corner| self.flat[corner][axis] <= high);
            &sorted[start..start + length]
        });
        if along_first.len() <= along_second.len() { along_first } else { along_second }
    }
}

/// The two triangles of a quadrilateral: along the only diagonal inside it, otherwise from the
/// first corner.
fn split_quad(corners: &[[f32; 3]]) -> ([[usize; 3]; 2], bool) {
    const ALONG_02: [[usize; 3]; 2] = [[0, 1, 2], [0, 2, 3]];
    const ALONG_13: [[usize; 3]; 2] = [[1, 2, 3], [1, 3, 0]];
    let point = |corner: usize| corners[corner].map(f64::from);
    let agreement =
        |[first, second]: [[usize; 3]; 2]| dot(cross_of(first.map(point)), cross_of(second.map(point)));
    let (agreement_02, agreement_13) = (agreement(ALONG_02), agreement(ALONG_13));
    let takes_13 = match (agreement_02 > 0.0, agreement_13 > 0.0) {
        (true, _) => false,
        (false, true) => true,
        // Flat triangles (agreement zero) are better than folded ones.
        (false, false) => agreement_13 > agreement_02,
    };
    if takes_13 { (ALONG_13, agreement_13 >= 0.0) } else { (ALONG_02, agreement_02 >= 0.0) }
}

/// Twice the area vector of a polygon; its components are twice the areas of the projections onto
/// the coordinate planes.
fn newell_normal(corners: &[[f32; 3]]) -> [f64; 3] {
    let start = corners[0].map(f64::from);
    let mut normal = [0.0; 3];
    for pair in corners[1..].windows(2) {
        let triangle = cross_of([start, pair[0].map(f64::from), pair[1].map(f64::from)]);
        normal = std::array::from_fn(|axis| normal[axis] + triangle[axis]);
    }
    normal
}

fn orientation(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

fn cross_of([a, b, c]: [[f64; 3]; 3]) -> [f64; 3] {
    let (u, v) = (subtract(b, a), subtract(c, a));
    [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
}

fn subtract(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|axis| a[axis] - b[axis])
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn triangulate(corners: &[[f32; 2]]) -> (Vec<[usize; 3]>, bool) {
        let corners: Vec<[f32; 3]> = corners.iter().map(|c| [c[0], c[1], 0.0]).collect();
        let mut triangles = Vec::new();
        let is_tiled = Triangulator::default().triangulate(&corners, &mut triangles);
        assert_eq!(triangles.len(), corners.len().saturating_sub(2));
        (triangles, is_tiled)
    }

    fn areas(corners: &[[f32; 2]], triangles: &[[usize; 3]]) -> Vec<f64> {
        let point = |corner: usize| corners[corner].map(f64::from);
        triangles.iter().map(|t| 0.5 * orientation(point(t[0]), point(t[1]), point(t[2]))).collect()
    }

    fn polygon_area(corners: &[[f32; 2]]) -> f64 {
        let shifted = corners.iter().cycle().skip(1);
        corners.iter().zip(shifted).map(|(a, b)| 0.5 * f64::from(a[0] * b[1] - a[1] * b[0])).sum()
    }

    /// Checks that every triangle keeps the orientation of the polygon and that together they have
    /// its area.
    fn check_tiles(corners: &[[f32; 2]]) {
        let (triangles, is_tiled) = triangulate(corners);
        let areas = areas(corners, &triangles);
        let expected = polygon_area(corners);
        assert!(is_tiled);
        assert!(areas.iter().all(|area| area * expected.signum() >= 0.0), "{areas:?}");
        let total: f64 = areas.iter().sum();
        assert!((total - expected).abs() <= 1e-5 * expected.abs(), "{total} {expected}");
    }

    #[test]
    fn an_arrow_head_is_split_at_its_notch() {
        let arrow = [[0.0, 0.0], [2.0, -2.0], [1.0, 0.0], [2.0, 2.0]];
        for turn in 0..4 {
            let mut turned = arrow;
            turned.rotate_left(turn);
            check_tiles(&turned);
            turned.reverse();
            check_tiles(&turned);
        }
    }

    #[test]
    fn convex_polygons_are_fans_from_the_first_corner() {
        let kite = [[0.0, 0.0], [1.0, -0.5], [4.0, 0.0], [1.0, 0.5]];
        assert_eq!(triangulate(&kite).0, [[0, 1, 2], [0, 2, 3]]);
        let pentagon = [[0.0, 0.0], [2.0, 0.0], [3.0, 1.0], [1.0, 3.0], [-1.0, 1.0]];
        assert_eq!(triangulate(&pentagon).0, [[0, 1, 2], [0, 2, 3], [0, 3, 4]]);
    }

    #[test]
    fn concave_polygons_keep_their_area() {
        let comb: Vec<[f32; 2]> = (0..20_u8)
            .flat_map(|i| [[f32::from(i), 0.0], [f32::from(i) + 0.5, 5.0]])
            .chain([[20.0, 0.0], [20.0, -1.0], [0.0, -1.0]])
            .rev()
            .collect();
        check_tiles(&comb);
        let spiral: Vec<[f32; 2]> = (0..200_u8)
            .map(|i| f32::from(i) * 0.1)
            .map(|angle| [angle * angle.cos(), angle * angle.sin()])
            .chain(
                (0..200_u8)
                    .rev()
                    .map(|i| f32::from(i) * 0.1)
                    .map(|angle| [(angle + 1.0) * angle.cos(), (angle + 1.0) * angle.sin()]),
            )
            .collect();
        check_tiles(&spiral);
    }

    #[test]
    fn corners_on_straight_edges_are_used() {
        let square = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.0, 2.0], [0.0, 2.0], [0.0, 1.0]];
        check_tiles(&square);
        let (triangles, _) = triangulate(&square);
        assert!((0..7).all(|corner| triangles.iter().flatten().any(|&used| used == corner)));
        assert!(areas(&square, &triangles).iter().all(|&area| area > 0.0));
    }

    #[test]
    fn a_hole_reached_by_a_cut_stays_open() {
        let outer = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0], [0.0, 0.0]];
        let hole = [[1.0, 1.0], [1.0, 3.0], [3.0, 3.0], [3.0, 1.0], [1.0, 1.0]];
        let corners: Vec<[f32; 2]> = outer.into_iter().chain(hole).collect();
        check_tiles(&corners);
    }

    #[test]
    fn crossing_and_flat_polygons_still_give_triangles() {
        let bow_tie = [[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]];
        assert!(!triangulate(&bow_tie).1);
        let line: Vec<[f32; 2]> = (0..6_u8).map(|i| [f32::from(i), 0.0]).collect();
        assert_eq!(triangulate(&line).0.len(), 4);
        triangulate(&[[1.0, 1.0]; 9]);
    }

    #[test]
    fn large_polygons_are_tiled_within_the_bound_on_work() {
        let n_teeth = 20_000_u16;
        let comb: Vec<[f32; 2]> = (0..n_teeth)
            .rev()
            .map(|i| 10.0 * f32::from(i) / f32::from(n_teeth))
            .flat_map(|x| [[x + 2e-4, 0.0], [x, 10.0]])
            .chain([[0.0, -1.0], [10.0, -1.0]])
            .collect();
        check_tiles(&comb);
        let turned: Vec<[f32; 2]> = comb.iter().map(|&[x, y]| [-y, x]).collect();
        check_tiles(&turned);
        let star: Vec<[f32; 2]> = (0..40_000_u16)
            .map(|i| (f32::from(i) / 40_000.0 * std::f32::consts::TAU, 1.0 + f32::from(i % 2)))
            .map(|(angle, radius)| [1000.0 * radius * angle.cos(), 1000.0 * radius * angle.sin()])
            .collect();
        check_tiles(&star);
    }

    #[test]
    fn any_plane_gives_the_same_result() {
        let notched = [[0.0, 0.0], [3.0, 0.0], [3.0, 3.0], [1.5, 0.5], [0.0, 3.0_f32]];
        let planes: [fn([f32; 2]) -> [f32; 3]; 4] = [
            |p| [p[0], p[1], 7.0],
            |p| [7.0, p[0], p[1]],
            |p| [p[0], 7.0, p[1]],
            |p| [p[0], p[1], p[0] + p[1]],
        ];
        for plane in planes {
            let mut triangles = Vec::new();
            assert!(Triangulator::default().triangulate(&notched.map(plane), &mut triangles));
            assert!(areas(&notched, &triangles).iter().all(|&area| area > 0.0));
        }
    }

    proptest! {
        /// Star-shaped polygons are simple, so their triangles must tile them.
        #[test]
        fn star_shaped_polygons_are_tiled(radii in proptest::collection::vec(0.1_f32..1.0, 5..200)) {
            let n_corners = radii.len() as f32;
            let corners: Vec<[f32; 2]> = radii
                .iter()
                .enumerate()
                .map(|(i, radius)| (i as f32 / n_corners * std::f32::consts::TAU, radius))
                .map(|(angle, radius)| [radius * angle.cos(), radius * angle.sin()])
                .collect();
            check_tiles(&corners);
        }

        #[test]
        fn any_corners_give_two_triangles_fewer(corners in proptest::collection::vec([-2_i8..3, -2_i8..3], 3..40)) {
            let corners: Vec<[f32; 2]> = corners.iter().map(|corner| corner.map(f32::from)).collect();
            let (triangles, _) = triangulate(&corners);
            prop_assert!(triangles.iter().flatten().all(|&corner| corner < corners.len()));
        }
    }
}
