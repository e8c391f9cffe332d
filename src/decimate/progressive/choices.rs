//! What is known of the vertices in the queue, so that nothing is computed twice.

/// For each vertex, whether its error in the queue is that of its star as it is now, and the
/// collapse that was found for it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Choices {
    known: Vec<Known>,
}

#[derive(Clone, Copy, Debug, Default)]
enum Known {
    /// The star has changed since.
    #[default]
    Nothing,
    /// The vertex is queued with its local error.
    Measured,
    /// The vertex is queued with the error of its collapse into this neighbour, which leaves this
    /// distance.
    Chosen(u32, f64),
}

impl Choices {
    /// Nothing is known of vertices below `n_vertices`.
    pub(crate) fn new(n_vertices: usize) -> Self {
        Self { known: vec![Known::default(); n_vertices] }
    }

    /// Makes room for one more vertex.
    pub(crate) fn add_vertex(&mut self) {
        self.known.push(Known::default());
    }

    /// The star of `v` has changed.
    #[inline]
    pub(crate) fn forget(&mut self, v: u32) {
        self.known[v as usize] = Known::Nothing;
    }

    /// `v` is queued with its local error.
    #[inline]
    pub(crate) fn measure(&mut self, v: u32) {
        self.known[v as usize] = Known::Measured;
    }

    /// `v` is queued with the error of its collapse into neighbour `into`.
    #[inline]
    pub(crate) fn choose(&mut self, v: u32, into: u32, distance: f64) {
        self.known[v as usize] = Known::Chosen(into, distance);
    }

    /// Whether the error that `v` is queued with counts still.
    #[inline]
    pub(crate) fn is_measured(&self, v: u32) -> bool {
        !matches!(self.known[v as usize], Known::Nothing)
    }

    /// Neighbour that `v` is to go into, and the distance that this leaves.
    #[inline]
    pub(crate) fn of(&self, v: u32) -> Option<(u32, f64)> {
        match self.known[v as usize] {
            Known::Chosen(into, distance) => Some((into, distance)),
            Known::Nothing | Known::Measured => None,
        }
    }
}
