//! A volume at the steps of its history, with all that must hold: positive tetrahedra, the volume,
//! and the topology of the boundary.

use nephrite::{History, TetrahedronMesh};
use std::collections::HashMap;
use std::collections::hash_map::Entry;

/// Corners of the faces of a tetrahedron.
const FACES: [[usize; 3]; 4] = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];

/// The volume at one step.
///
/// A tetrahedron is inverted or not for its whole life, because vertices are replaced and do not
/// move. So each is checked once, when it is born, and that covers every tetrahedron of every step.
#[derive(Debug, Default)]
pub struct BoundaryWalk {
    /// Six times the volume.
    pub six_volumes: f64,
    /// Tetrahedra born so far.
    pub n_born: usize,
    /// Those of them whose volume is not positive.
    pub n_inverted: usize,
    /// Faces with three tetrahedra or more, now.
    pub n_crowded_faces: i64,
    /// Edges of the boundary with other than two of its faces, now.
    pub n_open_edges: i64,
    faces: HashMap<[u32; 3], u32>,
    boundary_edges: HashMap<[u32; 2], u32>,
    boundary_vertices: HashMap<u32, u32>,
    n_boundary_faces: i64,
}

impl BoundaryWalk {
    /// A tetrahedron is born.
    pub fn add(&mut self, mesh: &TetrahedronMesh, corners: [u32; 4]) {
        let six_volumes = mesh.six_volumes(corners);
        self.six_volumes += six_volumes;
        self.n_born += 1;
        self.n_inverted += usize::from(six_volumes.is_nan() || six_volumes <= 0.0);
        for face in FACES {
            self.count_face(face.map(|i| corners[i]), 1);
        }
    }

    /// A tetrahedron dies.
    pub fn remove(&mut self, mesh: &TetrahedronMesh, corners: [u32; 4]) {
        self.six_volumes -= mesh.six_volumes(corners);
        for face in FACES {
            self.count_face(face.map(|i| corners[i]), -1);
        }
    }

    /// Euler characteristic of the boundary.
    pub fn characteristic(&self) -> i64 {
        let count = |n: usize| i64::try_from(n).unwrap_or(i64::MAX);
        count(self.boundary_vertices.len()) - count(self.boundary_edges.len()) + self.n_boundary_faces
    }

    /// Whether a vertex is on the boundary.
    pub fn is_on_boundary(&self, v: u32) -> bool {
        self.boundary_vertices.contains_key(&v)
    }

    /// Components of the boundary. O(its faces).
    pub fn n_components(&self) -> usize {
        let mut roots: HashMap<u32, u32> = self.boundary_vertices.keys().map(|&v| (v, v)).collect();
        fn root(roots: &mut HashMap<u32, u32>, mut v: u32) -> u32 {
            while let Some(&up) = roots.get(&v).filter(|&&up| up != v) {
                let above = roots.get(&up).copied().unwrap_or(up);
                roots.insert(v, above);
                v = above;
            }
            v
        }
        for &[a, b] in self.boundary_edges.keys() {
            let [a, b] = [root(&mut roots, a), root(&mut roots, b)];
            roots.insert(a.max(b), a.min(b));
        }
        roots.iter().filter(|(v, up)| v == up).count()
    }

    fn count_face(&mut self, mut face: [u32; 3], change: i32) {
        face.sort_unstable();
        let [before, after] = counted(self.faces.entry(face), change);
        self.n_crowded_faces += i64::from(after > 2) - i64::from(before > 2);
        let change = i32::from(after == 1) - i32::from(before == 1);
        if change == 0 {
            return;
        }
        self.n_boundary_faces += i64::from(change);
        let [a, b, c] = face;
        for edge in [[a, b], [b, c], [a, c]] {
            let [before, after] = counted(self.boundary_edges.entry(edge), change);
            let is_open = |n: u32| i64::from(n != 0 && n != 2);
            self.n_open_edges += is_open(after) - is_open(before);
        }
        for v in face {
            counted(self.boundary_vertices.entry(v), change);
        }
    }
}

/// Changes a count and removes it at 0; returns it before and after.
fn counted<K>(entry: Entry<'_, K, u32>, change: i32) -> [u32; 2] {
    match entry {
        Entry::Vacant(vacant) => {
            let after = change.max(0).unsigned_abs();
            if after > 0 {
                vacant.insert(after);
            }
            [0, after]
        }
        Entry::Occupied(mut occupied) => {
            let before = *occupied.get();
            let after = before.saturating_add_signed(change);
            if after == 0 {
                occupied.remove();
            } else {
                *occupied.get_mut() = after;
            }
            [before, after]
        }
    }
}

/// The simplices that die and those that are born at each step of a history, by their places in it.
/// O(n).
pub fn events(history: &History<4>) -> Vec<[Vec<usize>; 2]> {
    let mut events = vec![[Vec::new(), Vec::new()]; history.errors.len()];
    for (i, (&birth, &death)) in history.birth.iter().zip(&history.death).enumerate() {
        events[birth as usize][1].push(i);
        if let Some(event) = events.get_mut(death as usize) {
            event[0].push(i);
        }
    }
    events
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_tetrahedra_are_a_ball_and_one_of_them_as_well() {
        let mesh = TetrahedronMesh {
            positions: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 1.0, 1.0]],
            ..TetrahedronMesh::default()
        };
        let mut walk = BoundaryWalk::default();
        walk.add(&mesh, [0, 1, 2, 3]);
        assert_eq!((walk.characteristic(), walk.n_components(), walk.six_volumes), (2, 1, 1.0));
        walk.add(&mesh, [1, 2, 3, 4]);
        assert_eq!((walk.characteristic(), walk.n_components(), walk.n_open_edges), (2, 1, 0));
        walk.add(&mesh, [2, 1, 3, 4]);
        assert_eq!((walk.n_inverted, walk.n_crowded_faces), (1, 1));
        walk.remove(&mesh, [2, 1, 3, 4]);
        walk.remove(&mesh, [0, 1, 2, 3]);
        assert_eq!((walk.characteristic(), walk.n_crowded_faces, walk.is_on_boundary(0)), (2, 0, false));
    }
}
