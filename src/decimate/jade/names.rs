//! What the vertices of the surface are called elsewhere.
//!
//! Three numberings meet in a decimation. The *surface* numbers its vertices along a curve through
//! space. The *input* has the order of its file. The *history* names the vertices of the input and
//! those born later. Several of these can lie at one vertex of the surface, where a seam passes.

use super::options::Placement;
use crate::history::History;
use crate::mesh::{Numbering, Renumbering, Surface, Wedges};

/// The vertices of the input and of the history at each vertex of a surface.
pub(crate) struct Names {
    /// Vertex of the input for each vertex of the surface.
    in_input: Vec<u32>,
    in_history: HistoryNames,
}

/// What decides which vertex of the history a corner of a triangle is.
enum HistoryNames {
    /// The vertex of the surface, by its own number. [`Names::finish`] puts in the numbers of the
    /// input at the end: until then neighbours have near numbers, which take less memory.
    Surface,
    /// The vertex of the surface. Whenever it moves it becomes another one in the history.
    Vertex(Vec<u32>),
    /// The triangle as well: a vertex of the surface at a seam has several.
    Corner(Wedges),
}

impl Names {
    /// Names for a surface with the given wedges, if it has seams.
    pub(crate) fn new(numbering: Numbering, wedges: Option<Wedges>, placement: Placement) -> Self {
        let in_history = match (wedges, placement) {
            (Some(wedges), _) => HistoryNames::Corner(wedges),
            (None, Placement::Best) => HistoryNames::Vertex(numbering.vertices().to_vec()),
            (None, Placement::Original) => HistoryNames::Surface,
        };
        Self { in_input: numbering.into_vertices(), in_history }
    }

    /// The wedges, if the mesh has seams.
    pub(crate) fn wedges(&self) -> Option<&Wedges> {
        match &self.in_history {
            HistoryNames::Corner(wedges) => Some(wedges),
            HistoryNames::Surface | HistoryNames::Vertex(_) => None,
        }
    }

    /// Vertices of the history at the corners of the triangle in `slot`.
    pub(crate) fn corners(&self, surface: &Surface, slot: u32) -> [u32; 3] {
        match &self.in_history {
            HistoryNames::Surface => surface.corners(slot),
            HistoryNames::Vertex(names) => surface.corners(slot).map(|v| names[v as usize]),
            HistoryNames::Corner(wedges) => wedges.corners(slot),
        }
    }

    /// Whether all triangles at `v` have the same vertex of the history there.
    pub(crate) fn is_single(&self, surface: &Surface, v: u32) -> bool {
        self.wedges().is_none_or(|wedges| wedges.only_at(surface, v).is_some())
    }

    /// Makes `v`, which [is single](Self::is_single), the vertex `new` of the history from now on,
    /// the next after those there are. Returns which one it was.
    pub(crate) fn rename(&mut self, surface: &Surface, v: u32, new: u32) -> u32 {
        match &mut self.in_history {
            HistoryNames::Surface => v,
            HistoryNames::Vertex(names) => std::mem::replace(&mut names[v as usize], new),
            HistoryNames::Corner(wedges) => wedges.replace_at(surface, v, new),
        }
    }

    /// Sets the vertices of the history in `slots`; does nothing without seams.
    pub(crate) fn set(&mut self, slots: &[u32], vertices: &[[u32; 3]]) {
        if let HistoryNames::Corner(wedges) = &mut self.in_history {
            slots.iter().zip(vertices).for_each(|(&slot, &vertices)| wedges.set(slot, vertices));
        }
    }

    /// Gives every slot its new number.
    pub(crate) fn renumber_slots(&mut self, slots: &Renumbering) {
        if let HistoryNames::Corner(wedges) = &mut self.in_history {
            wedges.renumber_slots(slots);
        }
    }

    /// Lets go of the seams; what is left puts things in the order of the input.
    pub(crate) fn finish(self) -> InputOrder {
        let is_pending = matches!(self.in_history, HistoryNames::Surface);
        InputOrder { in_input: self.in_input, is_pending }
    }
}

/// Puts what a decimation leaves in the order of the input.
pub(crate) struct InputOrder {
    in_input: Vec<u32>,
    /// Whether the history still has the numbers of the surface.
    is_pending: bool,
}

impl InputOrder {
    /// What belongs to each vertex of the surface, in the order of the input.
    pub(crate) fn arrange<T: Copy + Default>(&self, of_surface: &[T]) -> Vec<T> {
        let mut arranged = vec![T::default(); of_surface.len()];
        for (&v, &item) in self.in_input.iter().zip(of_surface) {
            arranged[v as usize] = item;
        }
        arranged
    }

    /// Gives the history the numbers of the input, if it does not have them yet.
    pub(crate) fn apply(&self, history: &mut History) {
        if self.is_pending {
            history.vertex_death = self.arrange(&history.vertex_death);
            let corners = history.simplices.as_flattened_mut().iter_mut();
            corners.for_each(|v| *v = self.in_input[*v as usize]);
        }
    }
}
