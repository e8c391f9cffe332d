//! The best triangulation of a hole, by dynamic programming over its polygon.
//!
//! The best fill of the corners `i..=j` joins the edge `i j` to some corner between and fills what
//! is left on either side as well as can be (Klincsek, "Minimal triangulations of polygonal
//! domains", *Annals of Discrete Mathematics* 9, 1980; there for the sum of edge lengths). Here a
//! triangulation is as bad as its worst triangle, ties go to the smaller sum. A polygon of `n`
//! corners has `n (n-1) (n-2) / 6` triangles, each scored once.

use super::sampled_vertices::MAX_CORNERS;
use crate::geometry::prepared::{larger, smaller};

/// Worst score and sum of scores of a triangulation.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
struct Score {
    worst: f64,
    sum: f64,
}

const NOTHING: Score = Score { worst: 0.0, sum: 0.0 };
const IMPOSSIBLE: Score = Score { worst: f64::INFINITY, sum: f64::INFINITY };

impl Score {
    fn with(self, other: Self) -> Self {
        Self { worst: larger(self.worst, other.worst), sum: self.sum + other.sum }
    }
}

/// Scores of the edges inside a polygon, known if they matter, and for each part of the polygon the
/// least worst edge that any triangulation of it has.
#[derive(Clone, Debug, Default)]
pub(crate) struct EdgeScores {
    own: [[f64; MAX_CORNERS]; MAX_CORNERS],
    least: [[f64; MAX_CORNERS]; MAX_CORNERS],
}

impl EdgeScores {
    /// Makes these the scores of the polygon `corners`, at most [`MAX_CORNERS`], as far as they are
    /// needed to tell whether a triangulation is better than `enough`. `score` gets the ends of an
    /// edge. Returns a lower bound of the worst edge of every triangulation, exact up to `enough`.
    pub(crate) fn set(&mut self, corners: &[u8], enough: f64, score: impl Fn([u8; 2]) -> f64) -> f64 {
        let Self { own, least } = self;
        let n = corners.len();
        for span in 2..n {
            for i in 0..n - span {
                let j = i + span;
                let beside =
                    (i + 1..j).map(|k| larger(least[i][k], least[k][j])).fold(f64::INFINITY, smaller);
                let is_inside = span + 1 < n;
                own[i][j] = if is_inside && beside <= enough { score([corners[i], corners[j]]) } else { 0.0 };
                least[i][j] = larger(beside, own[i][j]);
            }
        }
        if n < 3 { 0.0 } else { least[0][n - 1] }
    }
}

/// Triangulates the polygon `corners` with the least worst `score` and appends the triangles to
/// `triangles`.
///
/// `score` gets a triangle and a cutoff above which any value will do. It gives infinity for a
/// triangle that may not be used, and is never negative; each edge inside has a score too. Returns
/// the worst score, or a lower bound of it above `enough`, without triangles. `None` if every
/// triangulation has a forbidden triangle, or if the polygon has more than [`MAX_CORNERS`].
pub(crate) fn triangulate_optimally(
    corners: &[u8],
    enough: f64,
    edges: &EdgeScores,
    mut score: impl FnMut([u8; 3], f64) -> f64,
    triangles: &mut Vec<[u8; 3]>,
) -> Option<f64> {
    let n = corners.len();
    if !(3..=MAX_CORNERS).contains(&n) {
        return None;
    }
    // A part of two corners is an edge and has no triangle. Longer parts are put together from
    // shorter ones.
    let mut best = [[NOTHING; MAX_CORNERS]; MAX_CORNERS];
    let mut apex = [[0_usize; MAX_CORNERS]; MAX_CORNERS];
    for span in 2..n {
        for i in 0..n - span {
            let j = i + span;
            best[i][j] = IMPOSSIBLE;
            // The edges alone may rule a part out before any of its triangles is scored.
            let least = edges.least[i][j];
            if least > enough {
                best[i][j] = Score { worst: least, sum: least };
                continue;
            }
            let across = edges.own[i][j];
            for k in i + 1..j {
                let sides = best[i][k].with(best[k][j]);
                // A whole is no better than its sides, so the triangle between them need not be
                // scored: scores are what takes time here.
                if sides.worst >= best[i][j].worst {
                    continue;
                }
                // A lower bound above `enough` is all that is asked for, and the sides are one. It
                // is kept, so that the parts built on this one are known to be as bad.
                let is_too_bad = sides.worst > enough;
                let own = if is_too_bad {
                    0.0
                } else {
                    score([corners[i], corners[k], corners[j]], best[i][j].worst)
                };
                let own = larger(own, across);
                let whole = sides.with(Score { worst: own, sum: own });
                if whole < best[i][j] {
                    (best[i][j], apex[i][j]) = (whole, k);
                }
            }
        }
    }
    let worst = best[0][n - 1].worst;
    if !worst.is_finite() {
        return None;
    }
    if worst <= enough {
        collect(corners, &apex, triangles);
    }
    Some(worst)
}

fn collect(corners: &[u8], apex: &[[usize; MAX_CORNERS]; MAX_CORNERS], triangles: &mut Vec<[u8; 3]>) {
    // At most one open side per corner waits at a time.
    let mut open = [(0, 0); MAX_CORNERS];
    open[0] = (0, corners.len() - 1);
    let mut n_open = 1;
    while n_open > 0 {
        n_open -= 1;
        let (i, j) = open[n_open];
        if j < i + 2 {
            continue;
        }
        let k = apex[i][j];
        triangles.push([corners[i], corners[k], corners[j]]);
        open[n_open] = (k, j);
        open[n_open + 1] = (i, k);
        n_open += 2;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Every triangulation of the polygon `i..=j`, by brute force.
    fn all(i: u8, j: u8) -> Vec<Vec<[u8; 3]>> {
        if j < i + 2 {
            return vec![vec![]];
        }
        let join = |k: u8| {
            let right = all(k, j);
            all(i, k)
                .into_iter()
                .flat_map(move |l| {
                    let with = move |r: &Vec<[u8; 3]>| [l.clone(), r.clone(), vec![[i, k, j]]].concat();
                    right.iter().map(with).collect::<Vec<_>>()
                })
                .collect::<Vec<_>>()
        };
        (i + 1..j).flat_map(join).collect()
    }

    /// Largest score among the triangles of a triangulation and the edges inside it.
    fn worst(
        triangles: &[[u8; 3]],
        n: u8,
        score: impl Fn([u8; 3]) -> f64,
        edge: impl Fn([u8; 2]) -> f64,
    ) -> f64 {
        let outer = |&[i, j]: &[u8; 2]| j == i + 1 || (i == 0 && j == n - 1);
        let inner =
            triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [a, c]]).filter(|side| !outer(side));
        triangles.iter().map(|&t| score(t)).chain(inner.map(edge)).fold(0.0, f64::max)
    }

    fn of_triangle(scores: &[u32], [a, b, c]: [u8; 3]) -> f64 {
        f64::from(scores[usize::from(a) * 64 + usize::from(b) * 8 + usize::from(c)])
    }

    fn of_edge(scores: &[u32], [i, j]: [u8; 2]) -> f64 {
        f64::from(scores[usize::from(i) * 8 + usize::from(j)])
    }

    proptest! {
        #[test]
        fn what_is_bad_enough_is_not_looked_into(
            n in 3_u8..8,
            enough in 0_u32..50,
            scores in prop::collection::vec(0_u32..50, 512),
            edge_scores in prop::collection::vec(0_u32..50, 64),
        ) {
            let corners: Vec<u8> = (0..n).collect();
            let best = |enough: f64| {
                let mut edges = EdgeScores::default();
                edges.set(&corners, enough, |edge| of_edge(&edge_scores, edge));
                triangulate_optimally(&corners, enough, &edges, |t, _| of_triangle(&scores, t), &mut vec![]).unwrap()
            };
            let (least, found) = (best(f64::INFINITY), best(enough.into()));
            prop_assert!(found == least || (enough as f64) < found && found <= least);
        }

        #[test]
        fn no_triangulation_is_better(
            n in 3_u8..8,
            scores in prop::collection::vec(0_u32..50, 512),
            edge_scores in prop::collection::vec(0_u32..40, 64),
        ) {
            let score = |triangle| { let score = of_triangle(&scores, triangle); if score > 40.0 { f64::INFINITY } else { score } };
            let edge = |edge| of_edge(&edge_scores, edge);
            let corners: Vec<u8> = (0..n).collect();
            let least = all(0, n - 1).iter().map(|t| worst(t, n, score, edge)).fold(f64::INFINITY, f64::min);
            let mut edges = EdgeScores::default();
            edges.set(&corners, f64::INFINITY, edge);
            let mut triangles = vec![];
            match triangulate_optimally(&corners, f64::INFINITY, &edges, |triangle, _| score(triangle), &mut triangles) {
                None => prop_assert!(least.is_infinite()),
                Some(found) => {
                    prop_assert_eq!(found, least);
                    prop_assert_eq!(worst(&triangles, n, score, edge), least);
                    prop_assert_eq!(triangles.len(), usize::from(n) - 2);
                }
            }
        }

        /// One set of scores after another, since they are written over the ones before.
        #[test]
        fn edges_alone_bound_every_triangulation(
            polygons in prop::collection::vec((1_u8..8, prop::collection::vec(0_u32..50, 64)), 1..4),
            enough in 0_u32..50,
        ) {
            let mut edges = EdgeScores::default();
            for (n, scores) in polygons {
                let corners: Vec<u8> = (0..n).collect();
                let found = edges.set(&corners, enough.into(), |edge| of_edge(&scores, edge));
                let least = |t: &Vec<[u8; 3]>| worst(t, n, |_| 0.0, |edge| of_edge(&scores, edge));
                let least = all(0, n - 1).iter().map(least).fold(f64::INFINITY, f64::min);
                prop_assert!(found == least || f64::from(enough) < found && found <= least);
            }
        }
    }
}
