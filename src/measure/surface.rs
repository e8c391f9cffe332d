//! A mesh prepared for measuring: the vertices and triangles of its surface, in the order of a
//! hierarchy.
//!
//! Both meshes are placed in one frame, `f64` about the centre of the bounding box of the
//! reference. Vertices that no triangle uses are not on the surface and are left out. Triangles are
//! in the order of the leaves of the hierarchy, and vertices in the order in which these triangles
//! use them. So neighbours in space are neighbours in memory, and one search begins where the last
//! one ended.

use rayon::prelude::*;

use super::bvh;
use super::error::{MeasureError, Side};
use super::search::TriangleTree;
use crate::TriangleMesh;
use crate::flat::NO_INDEX;
use crate::geometry::bounds::Bounds;
use crate::geometry::distance::Triangle;
use crate::geometry::vector::{self, Vector};
use crate::mesh::{TooMany, check_counts};

/// Coordinates above this are refused: sixth powers of lengths would come close to the largest
/// `f64`.
const MAX_COORDINATE: f64 = 1e40;

/// The surface of one mesh.
pub(super) struct MeasuredSurface {
    /// The triangles' corners and the hierarchy over them.
    pub(super) tree: TriangleTree,
    /// Positions of the vertices that a triangle uses.
    pub(super) vertices: Vec<Vector>,
    /// Every edge once, lower vertex first, as indices into `vertices`.
    pub(super) edges: Vec<[u32; 2]>,
    /// Largest coordinate that was used in placing the surface; rounding errors are a multiple of
    /// it.
    pub(super) magnitude: f64,
}

/// The frame in which both surfaces are measured.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    /// Origin of the reference.
    origin: [f64; 3],
    /// Centre of the reference's bounding box about that origin.
    centre: Vector,
    /// Length of the diagonal of that box.
    pub(super) bounding_diagonal: f64,
}

impl Frame {
    /// The frame that a reference gives.
    ///
    /// # Errors
    ///
    /// What [`check`] finds.
    pub(super) fn new(reference: &TriangleMesh) -> Result<Self, MeasureError> {
        check(reference, Side::Reference)?;
        let bounds = reference
            .triangles
            .par_iter()
            .map(|corners| Bounds::around(corners.map(|v| vector::widen(reference.positions[v as usize]))))
            .reduce(|| Bounds::EMPTY, |a, b| a.union(&b));
        Ok(Self {
            origin: reference.origin,
            centre: vector::midpoint(bounds.low, bounds.high),
            bounding_diagonal: vector::length(vector::sub(bounds.high, bounds.low)),
        })
    }
}

impl Frame {
    /// The vector that moves the positions of a mesh into the frame.
    pub(super) fn offset(&self, mesh: &TriangleMesh) -> Vector {
        vector::sub(vector::sub(mesh.origin, self.origin), self.centre)
    }

    /// A point of the frame, in file coordinates.
    pub(super) fn to_file(self, p: Vector) -> [f64; 3] {
        vector::add(vector::add(p, self.centre), self.origin)
    }
}

impl MeasuredSurface {
    /// Places a mesh in the frame and builds its hierarchy.
    ///
    /// # Errors
    ///
    /// What [`check`] finds, and [`MeasureError::TooFarApart`].
    pub(super) fn new(mesh: &TriangleMesh, frame: &Frame, side: Side) -> Result<Self, MeasureError> {
        check(mesh, side)?;
        let offset = frame.offset(mesh);
        let place = |v: u32| vector::add(vector::widen(mesh.positions[v as usize]), offset);
        let unordered: Vec<Triangle> = mesh.triangles.par_iter().map(|corners| corners.map(place)).collect();
        let bounds = unordered
            .par_iter()
            .map(|triangle| Bounds::around(*triangle))
            .reduce(|| Bounds::EMPTY, |a, b| a.union(&b));
        let magnitude = [offset, bounds.low, bounds.high]
            .concat()
            .into_iter()
            .fold(0.0, |largest: f64, coordinate| largest.max(coordinate.abs()));
        if magnitude > MAX_COORDINATE {
            return Err(MeasureError::TooFarApart { found: magnitude, limit: MAX_COORDINATE });
        }
        let (nodes, order) = bvh::build(&unordered);
        let triangles: Vec<Triangle> = order.iter().map(|&t| unordered[t as usize]).collect();
        let corners = order.iter().map(|&t| mesh.triangles[t as usize]);
        let (tree, (vertices, edges)) = rayon::join(
            || TriangleTree::new(nodes, triangles),
            || {
                let (vertex_ids, triangle_vertices) = number_by_use(corners, mesh.positions.len());
                let vertices: Vec<Vector> = vertex_ids.iter().map(|&v| place(v)).collect();
                let edges = collect_edges(&triangle_vertices, vertices.len());
                (vertices, edges)
            },
        );
        Ok(Self { tree, vertices, edges, magnitude })
    }
}

/// Checks what measuring relies on: there are triangles, indices are below the number of vertices,
/// and the coordinates they use are finite.
fn check(mesh: &TriangleMesh, side: Side) -> Result<(), MeasureError> {
    let n_vertices = mesh.positions.len();
    if mesh.triangles.is_empty() {
        return Err(MeasureError::NoTriangles { side, n_vertices });
    }
    check_counts(n_vertices, mesh.triangles.len())
        .map_err(|TooMany { what, found, limit }| MeasureError::TooLarge { side, what, found, limit })?;
    if !mesh.origin.iter().all(|coordinate| coordinate.is_finite()) {
        return Err(MeasureError::OriginNotFinite { side, origin: mesh.origin });
    }
    mesh.triangles.par_iter().enumerate().try_for_each(|(triangle, corners)| {
        for &vertex in corners {
            let Some(position) = mesh.positions.get(vertex as usize) else {
                return Err(MeasureError::VertexOutOfRange { side, triangle, vertex, n_vertices });
            };
            if !position.iter().all(|coordinate| coordinate.is_finite()) {
                return Err(MeasureError::NotFinite { side, vertex, position: vector::widen(*position) });
            }
        }
        Ok(())
    })
}

/// Numbers vertices in the order of their first use. Returns the old index of each new vertex, and
/// the renumbered corners.
fn number_by_use(corners: impl Iterator<Item = [u32; 3]>, n_vertices: usize) -> (Vec<u32>, Vec<[u32; 3]>) {
    let mut new_ids = vec![NO_INDEX; n_vertices];
    let mut old_ids = Vec::new();
    let mut next = 0;
    let renumbered = corners
        .map(|corners| {
            corners.map(|old| {
                let id = &mut new_ids[old as usize];
                if *id == NO_INDEX {
                    *id = next;
                    next += 1;
                    old_ids.push(old);
                }
                *id
            })
        })
        .collect();
    (old_ids, renumbered)
}

/// Every edge of the triangles once, ordered by its lower vertex, which comes first. Edges from a
/// vertex to itself are left out.
fn collect_edges(triangles: &[[u32; 3]], n_vertices: usize) -> Vec<[u32; 2]> {
    let edges = || {
        triangles
            .iter()
            .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
            .map(|[a, b]| [a.min(b), a.max(b)])
            .filter(|[a, b]| a != b)
    };
    // A counting sort by the lower vertex; the few edges that share it are sorted among themselves.
    let mut places = vec![0usize; n_vertices + 1];
    for [low, _] in edges() {
        places[low as usize + 1] += 1;
    }
    for v in 0..n_vertices {
        places[v + 1] += places[v];
    }
    let mut sorted = vec![[0; 2]; places[n_vertices]];
    for edge in edges() {
        let place = &mut places[edge[0] as usize];
        sorted[*place] = edge;
        *place += 1;
    }
    let mut start = 0;
    for &end in &places[..n_vertices] {
        sorted[start..end].sort_unstable();
        start = end;
    }
    sorted.dedup();
    sorted
}
