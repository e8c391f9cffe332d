//! Counts that tell whether a surface is closed, oriented and of the right genus. The tests check
//! the generators with them.

use std::collections::HashMap;

use nephrite_formats::TriangleMesh;

/// What the edges of a mesh say about it.
pub(super) struct Topology {
    n_vertices: usize,
    n_edges: usize,
    n_triangles: usize,
    /// Edges of one triangle.
    pub(super) n_boundary_edges: usize,
    /// No edge has more than two triangles.
    pub(super) is_manifold: bool,
    /// No two triangles run along an edge in the same direction.
    pub(super) is_oriented: bool,
}

impl Topology {
    /// Counts the edges of a mesh; every index must be in range and every vertex used.
    pub(super) fn of(mesh: &TriangleMesh) -> Self {
        let mut uses: HashMap<[u32; 2], [usize; 2]> = HashMap::new();
        let mut used = vec![false; mesh.positions.len()];
        for triangle in &mesh.triangles {
            for corner in 0..3 {
                let [start, end] = [triangle[corner], triangle[(corner + 1) % 3]];
                assert_ne!(start, end, "{triangle:?} repeats a corner");
                used[start as usize] = true;
                uses.entry([start.min(end), start.max(end)]).or_default()[usize::from(start < end)] += 1;
            }
        }
        assert!(used.iter().all(|&used| used), "a vertex has no triangle");
        Self {
            n_vertices: mesh.positions.len(),
            n_edges: uses.len(),
            n_triangles: mesh.triangles.len(),
            n_boundary_edges: uses.values().filter(|[back, forth]| back + forth == 1).count(),
            is_manifold: uses.values().all(|[back, forth]| back + forth <= 2),
            is_oriented: uses.values().all(|&[back, forth]| back <= 1 && forth <= 1),
        }
    }

    /// Euler characteristic.
    pub(super) fn euler(&self) -> i64 {
        let [vertices, edges, triangles] =
            [self.n_vertices, self.n_edges, self.n_triangles].map(|count| i64::try_from(count).unwrap());
        vertices - edges + triangles
    }

    /// Every edge has two triangles.
    pub(super) fn is_closed(&self) -> bool {
        self.is_manifold && self.n_boundary_edges == 0
    }

    /// Volume enclosed by a closed mesh; negative if its triangles face inwards.
    pub(super) fn volume(mesh: &TriangleMesh) -> f64 {
        let corner = |vertex: u32| mesh.positions[vertex as usize].map(f64::from);
        let sixfold: f64 = mesh
            .triangles
            .iter()
            .map(|&[a, b, c]| {
                let [a, b, c] = [corner(a), corner(b), corner(c)];
                a[0] * (b[1] * c[2] - b[2] * c[1])
                    + a[1] * (b[2] * c[0] - b[0] * c[2])
                    + a[2] * (b[0] * c[1] - b[1] * c[0])
            })
            .sum();
        sixfold / 6.0
    }
}
