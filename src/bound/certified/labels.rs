//! Which triangle of a filling each source vertex belongs to, for one filling after another.

/// The filling triangle of each source vertex that is mapped into the hole at hand.
#[derive(Clone, Debug, Default)]
pub(super) struct Labels {
    stamped: Vec<u32>,
    stamp: u32,
}

/// Bits of a stamped label that hold the label; a filling has fewer than 64 triangles.
const LABEL_BITS: u32 = 6;

impl Labels {
    /// Forgets all labels, of `n_vertices` vertices. O(1) but for the first time and every 2^26th.
    pub(super) fn start(&mut self, n_vertices: usize) {
        self.stamp += 1;
        if self.stamped.len() != n_vertices || self.stamp >> (32 - LABEL_BITS) != 0 {
            self.stamped.clear();
            self.stamped.resize(n_vertices, 0);
            self.stamp = 1;
        }
    }

    /// Gives `v` a label, below 64.
    pub(super) fn set(&mut self, v: u32, label: u8) {
        self.stamped[v as usize] = self.stamp << LABEL_BITS | u32::from(label);
    }

    /// The label of `v`, if it got one since the start.
    pub(super) fn get(&self, v: u32) -> Option<u8> {
        let stamped = self.stamped[v as usize];
        (stamped >> LABEL_BITS == self.stamp).then_some((stamped & ((1 << LABEL_BITS) - 1)) as u8)
    }
}
