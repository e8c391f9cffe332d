//! Attributes at points: which vertex each triangle has at a point that carries several.
//!
//! A *wedge* is a vertex of the mesh: a point with one set of attributes (H. Hoppe, "Efficient implementation of progressive
//! meshes", 1998, section 2). Without seams a point and its wedge are the same number and nothing here is needed.

use super::complex::Complex;
use super::ring::Ring;

/// The wedges at the corners of every slot, parallel to the points that [`Complex`] keeps there.
#[derive(Clone, Debug)]
pub struct Wedges {
    corners: Vec<[u32; 3]>,
    /// Wedges that differ at most in the normal have the same entry.
    looks: Vec<u32>,
}

impl Wedges {
    /// Wedges of a mesh whose slot `t` has the wedges `corners[t]`, which look the same where `looks` agree.
    pub fn new(corners: Vec<[u32; 3]>, looks: Vec<u32>) -> Self {
        Self { corners, looks }
    }

    /// The wedges of the triangle in `slot`.
    pub fn corners(&self, slot: u32) -> [u32; 3] {
        self.corners[slot as usize]
    }

    /// The wedge that the triangle in `slot` has at `point`, one of its corners.
    pub fn at(&self, complex: &Complex, slot: u32, point: u32) -> u32 {
        let corner = complex.corners(slot).iter().position(|&corner| corner == point);
        corner.map_or(point, |corner| self.corners[slot as usize][corner])
    }

    /// Gives the triangle in `slot` another wedge in the place of `from`.
    pub fn rename(&mut self, slot: u32, from: u32, to: u32) {
        let corners = &mut self.corners[slot as usize];
        *corners = corners.map(|wedge| if wedge == from { to } else { wedge });
    }

    /// A new wedge that looks like `wedge`.
    pub fn add_copy(&mut self, wedge: u32) {
        self.looks.push(self.looks[wedge as usize]);
    }

    /// Whether the surface looks different on either side of the edge from the ring's centre to `point`.
    pub fn differ(&self, complex: &Complex, slots: [u32; 2], edge: [u32; 2]) -> bool {
        edge.into_iter().any(|point| {
            let [a, b] = slots.map(|slot| self.looks[self.at(complex, slot, point) as usize]);
            a != b
        })
    }

    /// For each triangle of the ring, in its order: the wedge that it has at the centre, and the wedge at neighbour `into`
    /// that the collapse along this edge puts there. A triangle takes the wedge of `into` on its own side of the edge, going round from there
    /// until the wedge at the centre changes; what lies beyond takes the nearer one.
    pub fn targets(&self, complex: &Complex, ring: &Ring, into: usize, pairs: &mut Vec<[u32; 2]>) {
        let (n, target) = (ring.len(), ring.vertices[into]);
        let at_center = |i: usize| self.at(complex, ring.slots[i], ring.center);
        let at_target = |i: usize| self.at(complex, ring.slots[i], target);
        let before = if into > 0 { Some(into - 1) } else { ring.is_cycle().then(|| n - 1) };
        let after = (into < n).then_some(into);
        let [before, after] = [before.or(after), after.or(before)].map(Option::unwrap_or_default);
        pairs.clear();
        pairs.extend((0..n).map(|i| {
            // Steps from the edge to the triangle, this way round and that; at the end of a chain both begin alike.
            let (forward, backward) = ((i + n - after) % n, (before + n - i) % n);
            let same = |place: usize| at_center(place) == at_center(i);
            let ahead = (0..forward).all(|step| same((after + step) % n));
            let behind = (0..backward).all(|step| same((before + n - step) % n));
            let is_ahead = if ahead == behind { forward <= backward } else { ahead };
            [at_center(i), at_target(if is_ahead { after } else { before })]
        }));
    }
}
