//! What a removal changes in the map.

use super::chains::{Chains, Portion};
use super::contents::Contents;
use super::star::OUTSIDE;
use crate::mesh::{Hole, MAX_VALENCE};

/// What a removal changes in the map.
#[derive(Clone, Debug, Default)]
pub(crate) struct MapChange {
    /// Every vertex mapped into the hole, by label.
    pub(super) assignments: Vec<Assignment>,
    /// Every source edge that needs or needed a chain through the hole.
    pub(in crate::bound) chains: Vec<NewChain>,
    /// The new chains, one after another.
    pub(super) portions: Vec<Portion>,
    /// Labels of the filling's triangles and the edges that have portions there, by label.
    pub(super) through: Vec<(u8, u32)>,
}

/// A source vertex and where its image is from now on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Assignment {
    /// Index of its triangle in the filling.
    pub(super) label: u8,
    /// See `Certified::rim_corner`.
    pub(super) rim_corner: u8,
    pub(super) vertex: u32,
}

/// A source edge that gets another chain.
#[derive(Clone, Copy, Debug)]
pub(in crate::bound) struct NewChain {
    pub(in crate::bound) edge: u32,
    /// Where the new one ends among the portions.
    pub(super) end: usize,
}

impl MapChange {
    /// Gives the source edges that the removal moves their new chains.
    pub(super) fn set_chains(&self, chains: &mut Chains) {
        let mut start = 0;
        for chain in &self.chains {
            chains.set(chain.edge, &self.portions[start..chain.end]);
            start = chain.end;
        }
    }

    /// Empties the slots of `hole` and fills those of its filling, and shows `take` each vertex
    /// with the slot it is mapped into.
    pub(super) fn fill_slots(
        &self,
        hole: &Hole,
        contents: &mut Contents,
        mut take: impl FnMut(Assignment, u32),
    ) {
        hole.slots.iter().for_each(|&slot| contents.clear(slot));
        let (mut assignments, mut through) = (self.assignments.as_slice(), self.through.as_slice());
        for (label, &slot) in (0..).zip(&hole.slots) {
            let vertices = take_while(&mut assignments, |assignment| assignment.label == label);
            let edges = take_while(&mut through, |&(through, _)| through == label);
            contents.fill(
                slot,
                vertices.iter().map(|assignment| assignment.vertex),
                edges.iter().map(|&(_, edge)| edge),
            );
            vertices.iter().for_each(|&assignment| take(assignment, slot));
        }
    }

    pub(super) fn clear(&mut self) {
        self.assignments.clear();
        self.chains.clear();
        self.portions.clear();
        self.through.clear();
    }

    /// A copy in order of the labels.
    pub(super) fn in_order(&self) -> Self {
        Self {
            assignments: by_label(&self.assignments, |assignment| assignment.label),
            chains: self.chains.clone(),
            portions: self.portions.clone(),
            through: by_label(&self.through, |&(label, _)| label),
        }
    }

    /// Adds the new chain of `edge`, whose portions lie in the filling's triangles `labels`, or
    /// [`OUTSIDE`] the hole.
    pub(super) fn add_chain(&mut self, edge: u32, portions: &[Portion], labels: &[u8]) {
        self.portions.extend_from_slice(portions);
        self.chains.push(NewChain { edge, end: self.portions.len() });
        if portions.len() < 2 {
            return;
        }
        let mut seen = 0_u64;
        for &label in labels.iter().filter(|&&label| label != OUTSIDE) {
            if seen & (1 << label) == 0 {
                seen |= 1 << label;
                self.through.push((label, edge));
            }
        }
    }
}

/// The items in order of their labels, which are below [`MAX_VALENCE`], by counting.
fn by_label<T: Copy>(items: &[T], label: impl Fn(&T) -> u8) -> Vec<T> {
    let mut starts = [0; MAX_VALENCE + 1];
    let mut n_labels = 0;
    for item in items {
        let label = usize::from(label(item));
        starts[label + 1] += 1;
        n_labels = n_labels.max(label + 1);
    }
    for at in 1..n_labels {
        starts[at + 1] += starts[at];
    }
    let mut ordered = items.to_vec();
    for item in items {
        let start = &mut starts[usize::from(label(item))];
        ordered[*start] = *item;
        *start += 1;
    }
    ordered
}

/// Takes the leading ones off `rest`.
fn take_while<'a, T>(rest: &mut &'a [T], is_leading: impl Fn(&T) -> bool) -> &'a [T] {
    let n_leading = rest.iter().take_while(|&item| is_leading(item)).count();
    let (leading, others) = rest.split_at(n_leading);
    *rest = others;
    leading
}
