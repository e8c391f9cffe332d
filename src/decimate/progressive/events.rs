//! The moments at which the topology of the mesh changed.

use serde::{Deserialize, Serialize};

/// How the topology changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum EventKind {
    /// A boundary loop of three edges closed.
    HoleClosed,
    /// Two parts of the mesh came to share an edge: where a tunnel collapsed to a line.
    Attached,
    /// The last triangles of a component went.
    ComponentVanished,
    /// A vertex was replaced by two at its place.
    Split,
    /// Two vertices at one place became one again.
    Merged,
}

/// Every kind, in the order of [`EventLog::tallies`].
const KINDS: [EventKind; 5] = [
    EventKind::HoleClosed,
    EventKind::Attached,
    EventKind::ComponentVanished,
    EventKind::Split,
    EventKind::Merged,
];

/// One change of topology.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Event {
    /// What changed.
    pub kind: EventKind,
    /// Step of the history.
    pub step: u32,
    /// Triangles left after it.
    pub triangles: usize,
    /// Error of the mesh then, in mesh units.
    pub error: f64,
}

/// How often something happened, and when first and last.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Tally {
    /// What happened.
    pub kind: EventKind,
    /// How often.
    pub count: usize,
    /// The first time.
    pub first: Event,
    /// The last time.
    pub last: Event,
}

/// All changes of topology of one decimation.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct EventLog {
    /// The first 2,048 events, in order.
    pub events: Vec<Event>,
    tallies: Vec<Tally>,
}

/// Events that are listed one by one; the others are only counted. A file's metadata has room for
/// some ten thousand.
pub(crate) const MAX_LISTED: usize = 2048;

impl EventLog {
    /// Records an event.
    pub fn add(&mut self, event: Event) {
        if self.events.len() < MAX_LISTED {
            self.events.push(event);
        }
        match self.tallies.iter_mut().find(|tally| tally.kind == event.kind) {
            Some(tally) => {
                tally.count += 1;
                tally.last = event;
            }
            None => self.tallies.push(Tally { kind: event.kind, count: 1, first: event, last: event }),
        }
    }

    /// How often each kind happened, without kinds that never did.
    pub fn tallies(&self) -> impl Iterator<Item = &Tally> {
        KINDS.into_iter().filter_map(|kind| self.tallies.iter().find(|tally| tally.kind == kind))
    }

    /// How often something of this kind happened.
    pub fn count(&self, kind: EventKind) -> usize {
        self.tallies.iter().find(|tally| tally.kind == kind).map_or(0, |tally| tally.count)
    }
}
