//! The order of work: which vertex is collapsed or split next.

use super::choices::Choices;
use super::queue::VertexQueue;
use super::turns::{JudgeBuffers, Turn};

/// When each vertex has its turn, and what is known of it until then.
#[derive(Clone, Debug)]
pub(super) struct Schedule {
    /// Vertices that may be collapsed.
    pub(super) queue: VertexQueue,
    /// Vertices without a valid collapse: to be split once nothing else is left.
    pub(super) stuck: VertexQueue,
    /// What is known of vertices in the queue.
    pub(super) choices: Choices,
    /// Whether splits have their turn.
    pub(super) splits: bool,
    /// Changes around vertices of large valence since they were last looked at.
    pub(super) n_changes: Vec<u32>,
    /// Vertices at which closing a crack has not led to a collapse. It is not tried again: cracks
    /// might open and close for ever.
    pub(super) keeps_crack: Vec<bool>,
    /// Vertices taken from the queue, and room to judge them.
    pub(super) turns: Vec<Turn>,
    pub(super) scratches: Vec<JudgeBuffers>,
    /// Rounds of taking vertices from the queue, and the round in which the star of each vertex
    /// last changed.
    pub(super) n_rounds: u32,
    pub(super) changed_in: Vec<u32>,
}

impl Schedule {
    /// Nothing queued yet of vertices below `n_points`. Splits have their turn from the start if
    /// the mesh is split before anything else.
    pub(super) fn new(n_points: usize, pre_split: bool) -> Self {
        Self {
            queue: VertexQueue::new(n_points),
            stuck: VertexQueue::new(n_points),
            choices: Choices::new(n_points),
            splits: pre_split,
            n_changes: vec![0; n_points],
            keeps_crack: vec![false; n_points],
            turns: Vec::new(),
            scratches: vec![JudgeBuffers::default()],
            n_rounds: 0,
            changed_in: vec![0; n_points],
        }
    }

    /// Makes room for one more vertex, which copies `v`.
    pub(super) fn add_vertex(&mut self, v: u32) {
        self.queue.add_vertex();
        self.stuck.add_vertex();
        self.choices.add_vertex();
        self.changed_in.push(self.n_rounds);
        self.n_changes.push(0);
        self.keeps_crack.push(self.keeps_crack[v as usize]);
    }
}
