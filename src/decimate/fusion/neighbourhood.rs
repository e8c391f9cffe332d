//! Everything that a fusion touches: the tetrahedra that die with it, those that stretch, and the
//! boundary between.

use super::links::is_simple;
use super::prey::Prey;
use crate::geometry::vector::{Vector, cross, dot, length_sq, sub};
use crate::mesh::{FACES, Tetrahedra};

/// A tetrahedron with one corner in the prey ("affected" in the paper).
#[derive(Clone, Copy, Debug)]
pub(super) struct Affected {
    pub slot: u32,
    /// Which corner moves.
    pub corner: usize,
    /// The other corners, so oriented that the one that moves is on their positive side.
    pub base: [u32; 3],
    /// Position of the first of them.
    origin: Vector,
    /// Cross product of the base's sides.
    normal: Vector,
}

/// Least height of a tetrahedron over its base, as a part of the distance between its apex and a
/// corner of the base: far above what rounding does to the sign of a volume.
const MIN_SLOPE: f64 = 1e-8;

impl Affected {
    #[inline(always)]
    fn new(mesh: &Tetrahedra, slot: u32, corners: [u32; 4], corner: usize) -> Self {
        let [a, b, c] = FACES[corner].map(|j| corners[j]);
        // Counter-clockwise from outside is clockwise for the corner opposite to the face.
        let base = [a, c, b];
        let [p, q, r] = base.map(|v| mesh.position(v));
        Self { slot, corner, base, origin: p, normal: cross(sub(q, p), sub(r, p)) }
    }

    /// Six times the volume with the moving corner at `p`, or `None` where it is not safely
    /// positive ("flipped").
    #[inline(always)]
    fn six_volumes(&self, p: Vector) -> Option<f64> {
        let side = sub(p, self.origin);
        let six_volumes = dot(self.normal, side);
        let least_sq = MIN_SLOPE * MIN_SLOPE * length_sq(self.normal) * length_sq(side);
        (six_volumes > 0.0 && six_volumes * six_volumes > least_sq).then_some(six_volumes)
    }
}

/// The tetrahedra around a prey. Kept and filled anew for each candidate.
#[derive(Clone, Debug, Default)]
pub(super) struct Neighbourhood {
    pub affected: Vec<Affected>,
    /// Slots of tetrahedra with two corners or more in the prey.
    pub deleted: Vec<u32>,
    /// Boundary faces with a corner in the prey, seen from outside, such a corner first.
    pub faces: Vec<[u32; 3]>,
    /// The last count in which each vertex was met.
    met: Vec<u32>,
    n_counts: u32,
}

impl Neighbourhood {
    /// Gathers the surroundings of a prey; false, and no more than begun, where a tetrahedron would
    /// flip with the fusion point at `p`. O(the stars of its vertices).
    pub(super) fn gather(&mut self, mesh: &Tetrahedra, prey: &Prey, p: Option<Vector>) -> bool {
        self.affected.clear();
        self.deleted.clear();
        self.faces.clear();
        for (i, &v) in prey.points().iter().enumerate() {
            for &slot in mesh.slots_at(v) {
                let Some(corners) = mesh.get(slot) else { continue };
                let in_prey = prey.corners_in(corners);
                if in_prey.is_power_of_two() {
                    let affected = Affected::new(mesh, slot, corners, in_prey.trailing_zeros() as usize);
                    if p.is_some_and(|p| affected.six_volumes(p).is_none()) {
                        return false;
                    }
                    self.affected.push(affected);
                } else if !prey.points()[..i].iter().any(|earlier| corners.contains(earlier)) {
                    self.deleted.push(slot);
                }
                let bits = mesh.boundary_bits(slot);
                if bits != 0 {
                    self.take_faces(corners, bits, &prey.points()[..=i]);
                }
            }
        }
        true
    }

    /// Takes the boundary faces of a tetrahedron that have the last of `vertices`, but none before
    /// it.
    fn take_faces(&mut self, corners: [u32; 4], bits: u8, vertices: &[u32]) {
        let Some((v, earlier)) = vertices.split_last() else { return };
        for corner in (0..4).filter(|corner| bits >> corner & 1 == 1) {
            let mut face = FACES[corner].map(|j| corners[j]);
            if face.contains(v) && !earlier.iter().any(|v| face.contains(v)) {
                while face[0] != *v {
                    face.rotate_left(1);
                }
                self.faces.push(face);
            }
        }
    }

    /// Whether the bases, the link of the fusion point, are a sphere, or a disk where it is on the
    /// boundary. Where tetrahedra overlap that were not together before, the fusion would join
    /// them, and a face get a third one. O(affected).
    pub(super) fn is_ball(&mut self, mesh: &Tetrahedra, prey: &Prey) -> bool {
        self.met.resize(mesh.n_vertices(), 0);
        self.n_counts = self.n_counts.wrapping_add(1);
        let mut n_vertices = 0;
        for v in self.affected.iter().flat_map(|affected| affected.base) {
            let last = std::mem::replace(&mut self.met[v as usize], self.n_counts);
            n_vertices += usize::from(last != self.n_counts);
        }
        let on_rim = |&[_, b, c]: &[u32; 3]| !prey.contains(b) && !prey.contains(c);
        let n_rim = self.faces.iter().filter(|&face| on_rim(face)).count();
        is_simple(n_vertices, self.affected.len(), n_rim)
    }

    /// Whether a fusion at the place of `v`, whose surroundings need be no ball, leaves each face
    /// there with two tetrahedra at most, or with as many as it had. O(affected log affected).
    pub(super) fn joins_nothing(&mut self, mesh: &Tetrahedra, v: u32) -> bool {
        let mut sides: Vec<([u32; 2], bool)> = Vec::with_capacity(3 * self.affected.len());
        for Affected { slot, corner, base: [a, b, c], .. } in &self.affected {
            let is_old = mesh.get(*slot).is_some_and(|corners| corners[*corner] == v);
            sides.extend([[a, b], [b, c], [a, c]].map(|[p, q]| ([*p.min(q), *p.max(q)], is_old)));
        }
        sides.sort_unstable();
        sides.chunk_by(|(a, _), (b, _)| a == b).all(|same| {
            let n_before = same.iter().filter(|&&(_, is_old)| is_old).count();
            same.len() <= n_before.max(2)
        })
    }

    /// Six times the volume of all affected tetrahedra with the fusion point at `p`, or `None`
    /// where one of them flips.
    pub(super) fn six_volumes(&self, p: Vector) -> Option<f64> {
        let mut sum = 0.0;
        for affected in &self.affected {
            sum += affected.six_volumes(p)?;
        }
        Some(sum)
    }

    /// Six times the volume of all that the fusion would touch, as it is.
    pub(super) fn six_volumes_before(&self, mesh: &Tetrahedra) -> f64 {
        let affected = self.affected.iter().map(|affected| affected.slot);
        affected.chain(self.deleted.iter().copied()).map(|slot| mesh.six_volumes(slot)).sum()
    }

    /// The faces of an affected tetrahedron that are on the boundary after the fusion: its base if
    /// it was, and its sides over the rim of the boundary faces that go.
    pub(super) fn boundary_bits(&self, mesh: &Tetrahedra, prey: &Prey, affected: &Affected) -> u8 {
        let own = 1 << affected.corner;
        let mut bits = mesh.boundary_bits(affected.slot) & own;
        let Some(corners) = mesh.get(affected.slot) else { return bits };
        for &[_, b, c] in &self.faces {
            if prey.contains(b) || prey.contains(c) {
                continue;
            }
            let places = [b, c].map(|v| corners.iter().position(|&w| w == v));
            if let [Some(i), Some(j)] = places {
                // The side opposite the one corner of the base that is not on the rim edge.
                bits |= 0b1111 & !(own | 1 << i | 1 << j);
            }
        }
        bits
    }
}
