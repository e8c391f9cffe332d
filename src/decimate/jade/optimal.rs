//! The best triangulation of a hole, by dynamic programming over its polygon.
//!
//! The best fill of the corners `i..=j` joins the edge `i j` to some corner between and fills what is left on either
//! side as well as can be (Klincsek, "Minimal triangulations of polygonal domains", *Annals of Discrete Mathematics* 9,
//! 1980; there for the sum of edge lengths). Here a triangulation is as bad as its worst triangle, ties go to the
//! smaller sum. A polygon of `n` corners has `n (n-1) (n-2) / 6` triangles, each scored once.

use super::asked::MAX_CORNERS;

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
        Self { worst: self.worst.max(other.worst), sum: self.sum + other.sum }
    }
}

/// Triangulates the polygon `corners` with the least worst `score` and appends the triangles to `triangles`.
///
/// `score` gets a triangle and a cutoff, above which any value will do. It gives infinity for a triangle that may not be
/// used, and is never negative. Returns the worst score, or a lower bound of it above `enough`, with any triangles; or
/// `None` where every triangulation has a forbidden triangle. Panics never; polygons above [`MAX_CORNERS`] get `None`.
pub fn triangulate_optimally(
    corners: &[u8],
    enough: f64,
    mut score: impl FnMut([u8; 3], f64) -> f64,
    triangles: &mut Vec<[u8; 3]>,
) -> Option<f64> {
    let n = corners.len();
    if !(3..=MAX_CORNERS).contains(&n) {
        return None;
    }
    let mut best = [[NOTHING; MAX_CORNERS]; MAX_CORNERS];
    let mut apex = [[0_usize; MAX_CORNERS]; MAX_CORNERS];
    for span in 2..n {
        for i in 0..n - span {
            let j = i + span;
            best[i][j] = IMPOSSIBLE;
            for k in i + 1..j {
                let sides = best[i][k].with(best[k][j]);
                if sides.worst >= best[i][j].worst {
                    continue;
                }
                let is_too_bad = sides.worst > enough;
                let own = if is_too_bad {
                    0.0
                } else {
                    score([corners[i], corners[k], corners[j]], best[i][j].worst)
                };
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
    collect(corners, &apex, triangles);
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

    proptest! {
        #[test]
        fn what_is_bad_enough_is_not_looked_into(n in 3_u8..8, enough in 0_u32..50, scores in prop::collection::vec(0_u32..50, 512)) {
            let score = |[a, b, c]: [u8; 3]| {
                f64::from(scores[usize::from(a) * 64 + usize::from(b) * 8 + usize::from(c)])
            };
            let corners: Vec<u8> = (0..n).collect();
            let best = |enough: f64| triangulate_optimally(&corners, enough, |t, _| score(t), &mut vec![]).unwrap();
            let (least, found) = (best(f64::INFINITY), best(enough.into()));
            prop_assert!(found == least || (enough as f64) < found && found <= least);
        }

        #[test]
        fn no_triangulation_is_better(n in 3_u8..8, scores in prop::collection::vec(0_u32..50, 512)) {
            let score = |[a, b, c]: [u8; 3]| {
                let value = scores[usize::from(a) * 64 + usize::from(b) * 8 + usize::from(c)];
                if value > 40 { f64::INFINITY } else { f64::from(value) }
            };
            let corners: Vec<u8> = (0..n).collect();
            let worst = |triangles: &[[u8; 3]]| triangles.iter().map(|&t| score(t)).fold(0.0, f64::max);
            let least = all(0, n - 1).iter().map(|t| worst(t)).fold(f64::INFINITY, f64::min);
            let mut triangles = vec![];
            match triangulate_optimally(&corners, f64::INFINITY, |triangle, _| score(triangle), &mut triangles) {
                None => prop_assert!(least.is_infinite()),
                Some(found) => {
                    prop_assert_eq!(found, least);
                    prop_assert_eq!(worst(&triangles), least);
                    prop_assert_eq!(triangles.len(), usize::from(n) - 2);
                }
            }
        }
    }
}
