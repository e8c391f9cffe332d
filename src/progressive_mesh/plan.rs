//! What a decimation did, operation by operation, in the order of growth.

use crate::decimate::progressive::journal::{Operation, Trace};
use crate::mesh::Surface;
use nephrite_formats::TriangleMesh;

/// One operation to be written, in the numbers of the build: vertices of its mesh, triangles as
/// slots.
#[derive(Clone, Debug)]
pub(super) enum Planned {
    /// The inverse of a collapse: `vertex` takes the triangles `moved` from `beside`, and `born`
    /// appear.
    EdgeSplit { vertex: u32, beside: u32, moved: Vec<u32>, born: Vec<(u32, [u32; 3])> },
    /// The inverse of a split.
    VertexMerge { vertex: u32, beside: u32 },
    /// A triangle that the decimation left.
    Triangle { slot: u32, corners: [u32; 3] },
}

/// Plays the trace on the input, and returns the way back. Memory: as much as the stream of all
/// operations.
pub(super) fn plan(mesh: &TriangleMesh, trace: &Trace) -> Vec<Planned> {
    let mut surface = Surface::new(mesh.positions.clone(), mesh.triangles.clone());
    let mut planned: Vec<Planned> = trace
        .operations
        .iter()
        .map(|operation| match operation {
            &Operation::Collapse { from, into } => {
                let star = surface.star(from).to_vec();
                let (born, moved): (Vec<u32>, Vec<u32>) =
                    star.iter().partition(|&&slot| surface.corners(slot).contains(&into));
                let born = born.into_iter().map(|slot| (slot, surface.corners(slot))).collect();
                surface.collapse(from, into, &star);
                Planned::EdgeSplit { vertex: from, beside: into, moved, born }
            }
            Operation::Split { from, copy, slots } => {
                surface.rename(*from, *copy, &trace.slots[slots.clone()]);
                Planned::VertexMerge { vertex: *copy, beside: *from }
            }
        })
        .collect();
    let rest = surface.iter().map(|(slot, corners)| Planned::Triangle { slot, corners });
    planned.extend(rest);
    planned.reverse();
    planned
}
