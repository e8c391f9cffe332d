//! Which vertices of tetrahedra are one point, and which of those are one vertex.

use super::places::{n_moved, order_by, position_key};
use super::tetrahedra::{FACES, faces_by_least_vertex};
use crate::flat::DisjointSets;
use nephrite_formats::{Attribute, ScalarType, TetrahedronMesh};

/// The vertices of a mesh as points and as vertices.
pub(super) struct Weld {
    /// The point of each vertex, named by the first vertex there.
    pub points: Vec<u32>,
    /// The first vertex at the point of each that has the same values.
    pub vertices: Vec<u32>,
    /// Vertices at the position of another that are points of their own.
    pub n_apart: usize,
    /// The distinct points of each tetrahedron that has fewer than four, ascending, the largest one
    /// repeated.
    pub degenerate: Vec<[u32; 3]>,
}

/// Merges vertices at one position with the same values. O(n log n).
pub(super) fn weld(input: &TetrahedronMesh) -> Weld {
    let (points, n_apart) = points_and_apart(input);
    let vertices = with_same_values(input, &points);
    let over_points = input.tetrahedra.iter().map(|t| t.map(|v| points[v as usize]));
    let degenerate = over_points.filter(|&corners| is_degenerate(corners)).filter_map(|mut corners| {
        corners.sort_unstable();
        let mut distinct = corners.to_vec();
        distinct.dedup();
        let &last = distinct.last()?;
        distinct.resize(3, last);
        <[u32; 3]>::try_from(distinct).ok()
    });
    Weld { degenerate: degenerate.collect(), points, vertices, n_apart }
}

/// The point of each vertex, named by the first vertex there: all vertices at one position, or
/// those that a tetrahedron has both of where the mesh would not stay one otherwise. O(n log n).
/// Gives besides the number of vertices at the position of another that are points of their own.
fn points_and_apart(mesh: &TetrahedronMesh) -> (Vec<u32>, usize) {
    let n_vertices = mesh.positions.len();
    let firsts = first_at_position(mesh);
    let n_coincident = n_moved(&firsts);
    if n_coincident == 0 {
        return (firsts, 0);
    }
    let welded = mesh.tetrahedra.iter().map(|t| t.map(|v| firsts[v as usize]));
    let welded: Vec<[u32; 4]> = welded.filter(|&t| !is_degenerate(t)).collect();
    if n_faults(&welded, n_vertices) > n_faults(&mesh.tetrahedra, n_vertices) {
        let points = first_in_tetrahedra(mesh, &firsts);
        let n_apart = n_coincident - n_moved(&points);
        (points, n_apart)
    } else {
        (firsts, 0)
    }
}

/// Whether vertices share a position. O(n log n).
pub(crate) fn has_coincident(mesh: &TetrahedronMesh) -> bool {
    n_moved(&first_at_position(mesh)) > 0
}

/// The tetrahedra of a mesh that have four points and are the first with these: over points, and
/// over vertices. O(n log n).
pub(crate) fn fitting(mesh: &TetrahedronMesh) -> (Vec<[u32; 4]>, Vec<[u32; 4]>) {
    let (points, _) = points_and_apart(mesh);
    let over_points = mesh.tetrahedra.iter().map(|t| t.map(|v| points[v as usize]));
    let both =
        over_points.zip(mesh.tetrahedra.iter().copied()).filter(|&(corners, _)| !is_degenerate(corners));
    let (mut over_points, mut vertices): (Vec<_>, Vec<_>) = both.unzip();
    let is_first = is_first(&over_points);
    for tetrahedra in [&mut vertices, &mut over_points] {
        let mut is_first = is_first.iter();
        tetrahedra.retain(|_| is_first.next().copied().unwrap_or(true));
    }
    (over_points, vertices)
}

/// Whether each tetrahedron is the first with its corners. O(n log n).
pub(super) fn is_first(tetrahedra: &[[u32; 4]]) -> Vec<bool> {
    let key = |mut t: [u32; 4]| {
        t.sort_unstable();
        t
    };
    let mut order: Vec<(usize, [u32; 4])> = tetrahedra.iter().map(|&t| key(t)).enumerate().collect();
    order.sort_unstable_by_key(|&(index, key)| (key, index));
    let mut is_first = vec![true; tetrahedra.len()];
    for same in order.chunk_by(|a, b| a.1 == b.1) {
        same[1..].iter().for_each(|&(index, _)| is_first[index] = false);
    }
    is_first
}

pub(super) fn is_degenerate([a, b, c, d]: [u32; 4]) -> bool {
    a == b || a == c || a == d || b == c || b == d || c == d
}

/// The first vertex at the point of each whose values are the same: as numbers, and NaN as NaN.
fn with_same_values(mesh: &TetrahedronMesh, points: &[u32]) -> Vec<u32> {
    let mut vertices: Vec<u32> = points.to_vec();
    // Only points of several vertices need a look.
    let mut is_shared = vec![false; points.len()];
    for (v, &point) in (0u32..).zip(points).filter(|(v, point)| v != *point) {
        is_shared[v as usize] = true;
        is_shared[point as usize] = true;
    }
    let mut shared: Vec<u32> =
        (0u32..).zip(&is_shared).filter(|(_, is_shared)| **is_shared).map(|(v, _)| v).collect();
    let values = |v: u32| mesh.attributes.iter().flat_map(move |attribute| bits(attribute, v));
    let by_values = |&a: &u32, &b: &u32| {
        points[a as usize].cmp(&points[b as usize]).then_with(|| values(a).cmp(values(b)))
    };
    shared.sort_by(by_values);
    for same in shared.chunk_by(|a, b| by_values(a, b).is_eq()) {
        // The sort is stable: the first is the least.
        same.iter().for_each(|&v| vertices[v as usize] = same[0]);
    }
    vertices
}

/// The values of an attribute at a vertex, as numbers that agree where the values do.
fn bits(attribute: &Attribute, v: u32) -> impl Iterator<Item = u64> {
    let stride = attribute.stride_bytes();
    let row = attribute.bytes.get(v as usize * stride..).and_then(|rest| rest.get(..stride)).unwrap_or(&[]);
    let number = |bytes: &[u8]| bytes.iter().rev().fold(0, |number, &byte| number << 8 | u64::from(byte));
    row.chunks_exact(attribute.scalar.size_bytes()).map(move |bytes| {
        let value = match attribute.scalar {
            ScalarType::F32 => f64::from(f32::from_bits(u32::try_from(number(bytes)).unwrap_or(0))),
            ScalarType::F64 => f64::from_bits(number(bytes)),
            _ => return number(bytes),
        };
        if value.is_nan() { f64::NAN.to_bits() } else { (value + 0.0).to_bits() }
    })
}

/// The first vertex at the position of each, `-0` equal to `0`.
fn first_at_position(mesh: &TetrahedronMesh) -> Vec<u32> {
    let key = |v: u32| position_key(mesh.positions[v as usize]);
    let order = order_by(mesh.positions.len(), key);
    let mut firsts: Vec<u32> = order.clone();
    for same in order.chunk_by(|&a, &b| key(a) == key(b)) {
        same.iter().for_each(|&v| firsts[v as usize] = same[0]);
    }
    firsts
}

/// As `firsts`, but only where a tetrahedron has both vertices.
fn first_in_tetrahedra(mesh: &TetrahedronMesh, firsts: &[u32]) -> Vec<u32> {
    let mut sets = DisjointSets::new(firsts.len());
    for tetrahedron in &mesh.tetrahedra {
        for (i, &a) in tetrahedron.iter().enumerate() {
            for &b in &tetrahedron[..i] {
                if firsts[a as usize] == firsts[b as usize] {
                    sets.join(a, b);
                }
            }
        }
    }
    (0..).take(firsts.len()).map(|v| sets.root(v)).collect()
}

/// Faces with more than two tetrahedra, and edges of the boundary with other than two faces.
fn n_faults(tetrahedra: &[[u32; 4]], n_vertices: usize) -> usize {
    let mut n_faults = 0;
    let mut edges: Vec<[u32; 2]> = Vec::new();
    for list in faces_by_least_vertex(tetrahedra, n_vertices).iter_mut() {
        list.sort_unstable();
        for same in list.chunk_by(|a, b| a.others == b.others) {
            n_faults += usize::from(same.len() > 2);
            if let [face] = same {
                let [a, b, c] = FACES[face.corner as usize].map(|i| tetrahedra[face.slot as usize][i]);
                edges.extend([ascending(a, b), ascending(b, c), ascending(c, a)]);
            }
        }
    }
    edges.sort_unstable();
    n_faults + edges.chunk_by(|a, b| a == b).filter(|faces| faces.len() != 2).count()
}

pub(super) fn ascending(a: u32, b: u32) -> [u32; 2] {
    [a.min(b), a.max(b)]
}
