//! Vertex classification (section 4.2): seven classes from the topology of the star, its feature
//! edges and its areas.
//!
//! A corner, as in the paper, is never collapsed as it stands: it is split along its feature edges
//! when nothing else can be done. Seams of attributes count as feature edges.

use super::average_plane::{AveragePlane, spoke};
use super::ring::{Ring, Shape};
use crate::geometry::vector::{Vector, dot};
use crate::mesh::{Surface, Wedges, facing_edge};

/// The classes; the first is for a vertex that has gone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum VertexClass {
    /// No triangle.
    #[default]
    Empty,
    /// Surrounded by triangles, with at most one feature edge.
    Simple,
    /// On the boundary, without feature edges.
    Boundary,
    /// Neither a full nor a half cycle of triangles, or an edge with more than two of them.
    NonManifold,
    /// Three or more feature edges, or one on the boundary.
    Corner,
    /// On a feature line that passes through, between these two neighbours.
    InteriorEdge([usize; 2]),
    /// At the end of a crack: on the boundary between two neighbours at one place.
    CrackTip,
    /// A simple or boundary vertex with a triangle of zero area.
    Degenerate,
    /// To stay as it is.
    Locked,
}

impl VertexClass {
    /// Whether a collapse may be tried.
    pub(crate) fn may_collapse(self) -> bool {
        !matches!(self, Self::Empty | Self::NonManifold | Self::Corner | Self::Locked)
    }
}

/// The surroundings of a vertex in space. Reused from vertex to vertex.
#[derive(Clone, Debug, Default)]
pub(crate) struct Geometry {
    /// Position of the vertex.
    pub apex: Vector,
    /// Positions of the neighbours, parallel to the ring's vertices.
    pub points: Vec<Vector>,
    /// Average plane of the star.
    pub plane: AveragePlane,
    /// Area of the star.
    pub area: f64,
    /// Neighbours at feature edges.
    pub features: Vec<usize>,
    /// Whether some triangle has no area.
    pub is_degenerate: bool,
    /// Normal of each triangle and its length.
    normals: Vec<(Vector, f64)>,
}

impl Geometry {
    /// Distance between the vertex and the average plane.
    pub(crate) fn distance_to_plane(&self) -> f64 {
        self.plane.distance()
    }

    /// Takes the ring's surroundings. O(valence).
    pub(crate) fn gather(
        &mut self,
        surface: &Surface,
        wedges: Option<&Wedges>,
        ring: &Ring,
        cos_feature_angle: f64,
    ) {
        self.apex = surface.point(ring.center);
        self.plane = AveragePlane::default();
        self.features.clear();
        self.normals.clear();
        if ring.shape == Shape::NonManifold {
            self.points.clear();
            self.add_loose_triangles(surface, ring);
        } else {
            ring.positions(surface, &mut self.points);
            for i in 0..ring.len() {
                let ends = [i, ring.next(i)].map(|i| spoke(self.apex, self.points[i]));
                self.normals.push(self.plane.add(ends[0], ends[1]));
            }
            self.find_features(surface, wedges, ring, cos_feature_angle);
        }
        self.area = 0.5 * self.plane.weight;
        self.is_degenerate = self.normals.iter().any(|&(_, size)| size <= 0.0);
    }

    fn add_loose_triangles(&mut self, surface: &Surface, ring: &Ring) {
        for &slot in &ring.slots {
            let (from, to) = facing_edge(surface.corners(slot), ring.center);
            let ends = [from, to].map(|v| spoke(self.apex, surface.point(v)));
            self.normals.push(self.plane.add(ends[0], ends[1]));
        }
    }

    /// Edges where the normals turn by more than the feature angle, or where a seam runs.
    fn find_features(
        &mut self,
        surface: &Surface,
        wedges: Option<&Wedges>,
        ring: &Ring,
        cos_feature_angle: f64,
    ) {
        let n = ring.len();
        let first = usize::from(!ring.is_cycle());
        for after in first..n {
            let before = if after == 0 { n - 1 } else { after - 1 };
            let ((a, a_size), (b, b_size)) = (self.normals[before], self.normals[after]);
            let is_seam = || {
                let slots = [ring.slots[before], ring.slots[after]];
                let edge = [ring.center, ring.vertices[after]];
                wedges.is_some_and(|wedges| wedges.differ(surface, slots, edge))
            };
            if dot(a, b) < cos_feature_angle * (a_size * b_size) || is_seam() {
                self.features.push(after);
            }
        }
    }
}

/// Classifies the vertex of `ring`. O(1) after [`Geometry::gather`].
pub(crate) fn classify(surface: &Surface, ring: &Ring, geometry: &Geometry) -> VertexClass {
    let n_features = geometry.features.len();
    match ring.shape {
        Shape::Empty => VertexClass::Empty,
        _ if surface.is_locked(ring.center) => VertexClass::Locked,
        Shape::NonManifold => VertexClass::NonManifold,
        Shape::Cycle => match geometry.features[..] {
            [] | [_] if geometry.is_degenerate => VertexClass::Degenerate,
            [] | [_] => VertexClass::Simple,
            // The two sides of one triangle fold over both edges and yet hold nothing in place.
            [_, _] if ring.len() == 2 => VertexClass::Simple,
            [i, j] => VertexClass::InteriorEdge([i, j]),
            _ => VertexClass::Corner,
        },
        Shape::Chain if n_features > 0 => VertexClass::Corner,
        Shape::Chain => {
            let ends = [ring.vertices[0], ring.vertices[ring.vertices.len() - 1]];
            if ring.len() >= 3 && surface.coincide(ends[0], ends[1]) {
                VertexClass::CrackTip
            } else if geometry.is_degenerate {
                VertexClass::Degenerate
            } else {
                VertexClass::Boundary
            }
        }
    }
}
