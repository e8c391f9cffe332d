//! Steps: each changes the mesh and is recorded as one step of the history.

use super::classify::VertexClass;
use super::collapse::{Collapse, Contact};
use super::error::vanishes;
use super::events::{Event, EventKind};
use super::proof::AboveLimit;
use super::ring::Ring;
use super::state::State;
use super::vanished::{Piece, PieceMoves, beside, of_star as corners_of_star};
use super::view::Surroundings;
use super::wedge_targets::wedge_targets;

/// What a collapse leaves behind.
struct Departure {
    /// Where pieces go that have vanished before, and this star if nothing is beside it.
    moves: PieceMoves,
    /// If the star vanishes: a triangle beside it that stands for it now.
    host: Option<u32>,
    /// Bound on the distance between the input's points that the star stands for and what stands
    /// for them then.
    bound: f64,
}

impl State {
    /// Collapses the vertex at hand along an edge unless the error would be too large; returns
    /// whether it did.
    pub(super) fn collapse(&mut self, Collapse { into, contact, distance }: Collapse) -> bool {
        let Departure { moves, host, bound } = self.plan_departure(into, distance);
        let Surroundings { ring, class, .. } = &self.view;
        let keeps_topology = contact == Contact::None && !vanishes(ring) && *class != VertexClass::CrackTip;
        let max_error = self.settings.max_error;
        let estimate = bound.max(moves.bound) + self.settings.rounding;
        let plan = match &mut self.proof {
            Some(proof) if keeps_topology => proof.plan(ring, into, max_error),
            _ => None,
        };
        let (error, is_proven, is_carried_on) = match plan {
            Some(Err(AboveLimit)) => return false,
            None if estimate > max_error => return false,
            Some(Ok(plan)) => (plan.error(), true, plan.carry_out()),
            None => (estimate, false, false),
        };
        if !is_carried_on {
            self.proof = None;
        }
        let ring = std::mem::take(&mut self.view.ring);
        self.accumulated.distribute(&ring, distance);
        self.record_collapse(&ring, into, error);
        self.deviations.set_star(&ring, if is_proven { bound.min(error) } else { bound });
        host.iter().for_each(|&host| self.deviations.raise(host, bound));
        self.vanished.carry_out(&ring, moves);
        self.vanished.follow(&self.surface, &ring, host);
        if is_proven {
            self.n_proven = self.journal.n_steps() + 1;
        }
        self.tell_of_collapse(&ring, contact);
        for &r in &ring.vertices {
            self.note_change(r);
        }
        self.view.ring = ring;
        true
    }

    /// What the collapse of the vertex at hand into neighbour `into` leaves, of which the star is
    /// this far at most.
    fn plan_departure(&mut self, into: usize, distance: f64) -> Departure {
        let Self { surface, vanished, deviations, journal, view: Surroundings { ring, .. }, .. } = self;
        // As long as the proof lasts, no triangle is farther from the input than it says.
        let proven = if self.proof.is_some() { journal.recorder.error() } else { f64::INFINITY };
        let of_star = deviations.of_star(ring).min(proven);
        if !vanishes(ring) {
            let moves = vanished.moves_to_fan(surface, ring, into);
            return Departure { moves, host: None, bound: of_star + distance };
        }
        match beside(surface, ring) {
            Some((host, distance)) => {
                let moves = vanished.moves_beside(surface, ring, host);
                Departure { moves, host: Some(host), bound: of_star + distance }
            }
            None => {
                let own = Piece { corners: corners_of_star(surface, ring), bound: of_star };
                Departure { moves: vanished.moves_away(surface, ring, own), host: None, bound: of_star }
            }
        }
    }

    /// If the vertex at hand is in the last triangle of a part: a bound on how far that is from the
    /// rest of the mesh.
    pub(super) fn distance_of_last(&mut self) -> Option<f64> {
        let Surroundings { ring, .. } = &self.view;
        let is_last = vanishes(ring) && beside(&self.surface, ring).is_none();
        is_last.then(|| self.plan_departure(0, 0.0).moves.bound)
    }

    /// History, operations and mesh.
    fn record_collapse(&mut self, ring: &Ring, into: usize, error: f64) {
        let (from, target) = (ring.center, ring.vertices[into]);
        self.counts.collapses += 1;
        if self.wedges.is_some() {
            self.part_wedges(ring, into, error);
        }
        self.journal.recorder.step(error);
        for &slot in &ring.slots {
            let vertices = self.vertices(slot);
            self.journal.recorder.death(slot, vertices);
        }
        match &mut self.wedges {
            None => self.journal.collapse(from, target),
            Some(wedges) => {
                for (&slot, &[wedge, goes_to]) in ring.slots.iter().zip(&self.pairs) {
                    wedges.rename(slot, wedge, goes_to);
                }
                self.pairs.sort_unstable();
                self.pairs.dedup();
                self.pairs.iter().for_each(|&[wedge, goes_to]| self.journal.collapse(wedge, goes_to));
            }
        }
        self.surface.collapse(from, target, &ring.slots);
        for &slot in &ring.slots {
            if self.surface.is_alive(slot) {
                self.journal.recorder.birth(slot);
            }
        }
    }

    /// If triangles with the same wedge at the centre go to different wedges, all but the first get
    /// a copy of it.
    fn part_wedges(&mut self, ring: &Ring, into: usize, error: f64) {
        let Some(wedges) = &self.wedges else { return };
        let mut pairs = std::mem::take(&mut self.pairs);
        wedge_targets(wedges, &self.surface, ring, into, &mut pairs);
        for i in 1..pairs.len() {
            let [wedge, goes_to] = pairs[i];
            let first = pairs[..i].iter().find(|pair| pair[0] == wedge);
            if first.is_none_or(|first| first[1] == goes_to) {
                continue;
            }
            let parted: Vec<usize> = (i..pairs.len()).filter(|&j| pairs[j] == [wedge, goes_to]).collect();
            let slots: Vec<u32> = parted.iter().map(|&j| ring.slots[j]).collect();
            let copy = self.split_wedge(wedge, &slots, error);
            parted.into_iter().for_each(|j| pairs[j][0] = copy);
        }
        self.pairs = pairs;
    }

    fn tell_of_collapse(&mut self, ring: &Ring, contact: Contact) {
        match contact {
            Contact::None => {}
            Contact::ClosesHole => self.tell(EventKind::HoleClosed),
            Contact::Attaches => self.tell(EventKind::Attached),
        }
        if vanishes(ring) && ring.vertices.iter().all(|&r| self.surface.star(r).is_empty()) {
            self.tell(EventKind::ComponentVanished);
        }
    }

    fn tell(&mut self, kind: EventKind) {
        self.events.add(Event {
            kind,
            step: self.journal.n_steps(),
            triangles: self.surface.n_triangles(),
            error: self.journal.recorder.error(),
        });
    }

    /// The vertices of the triangle in `slot`, as the mesh names them.
    fn vertices(&self, slot: u32) -> [u32; 3] {
        match &self.wedges {
            Some(wedges) => wedges.corners(slot),
            None => self.surface.corners(slot),
        }
    }

    /// Splits `v` (section 4.6) and queues it again with its copies, unless its error is too large.
    pub(super) fn split(&mut self, v: u32) {
        self.look_at(v);
        if self.error_in_view(v) > self.settings.max_error {
            return;
        }
        if self.touches_lock() {
            return;
        }
        let Surroundings { ring, geometry, class } = &self.view;
        self.pieces.cut(ring, geometry, *class);
        self.split_into_pieces(v);
        let slots = std::mem::take(&mut self.view.ring.slots);
        self.evaluate_corners(&slots);
    }

    /// Whether a triangle of the vertex at hand has a locked corner: such a vertex is not split, or
    /// the surface would come off its border.
    fn touches_lock(&self) -> bool {
        let Self { surface, view: Surroundings { ring, .. }, .. } = self;
        let is_locked = |&slot: &u32| surface.corners(slot).into_iter().any(|v| surface.is_locked(v));
        surface.has_locked() && ring.slots.iter().any(is_locked)
    }

    /// Evaluates all corners of these triangles, some of which have changed.
    fn evaluate_corners(&mut self, slots: &[u32]) {
        let mut corners: Vec<u32> = slots.iter().flat_map(|&slot| self.surface.corners(slot)).collect();
        corners.sort_unstable();
        corners.dedup();
        corners.into_iter().for_each(|v| self.evaluate_changed(v));
    }

    /// Splits every vertex along its feature edges, and non-manifold ones into their fans (section
    /// 4.9).
    pub(super) fn pre_split(&mut self) {
        for v in (0..).take(self.surface.n_vertices()) {
            self.look_at(v);
            let Surroundings { ring, geometry, class } = &self.view;
            if !self.touches_lock() && self.pieces.cut_at_features(ring, geometry, *class) {
                self.split_into_pieces(v);
            }
        }
        if self.settings.proves {
            self.n_proven = self.journal.n_steps() + 1;
        }
    }

    /// Gives every piece but the first a copy of `v`.
    fn split_into_pieces(&mut self, v: u32) {
        self.proof = None;
        let error = self.journal.recorder.error();
        let pieces = std::mem::take(&mut self.pieces);
        for i in 0..pieces.n_split_off() {
            let slots = pieces.split_off(i);
            let point = self.add_point(v);
            self.counts.splits += 1;
            if self.wedges.is_some() {
                self.split_wedges(v, slots, error);
            } else {
                self.record_split(v, slots, error);
                slots.iter().for_each(|&slot| self.journal.recorder.birth(slot));
            }
            self.surface.rename(v, point, slots);
            self.tell(EventKind::Split);
        }
        self.pieces = pieces;
    }

    fn record_split(&mut self, v: u32, slots: &[u32], error: f64) -> u32 {
        self.journal.recorder.step(error);
        for &slot in slots {
            let vertices = self.vertices(slot);
            self.journal.recorder.death(slot, vertices);
        }
        self.journal.split(v, slots)
    }

    /// Copies the wedges that the triangles in `slots` share with others at `v`.
    fn split_wedges(&mut self, v: u32, slots: &[u32], error: f64) {
        let wedge_of =
            |this: &Self, slot| this.wedges.as_ref().map_or(v, |wedges| wedges.at(&this.surface, slot, v));
        let mut inside: Vec<(u32, u32)> = slots.iter().map(|&slot| (wedge_of(self, slot), slot)).collect();
        inside.sort_unstable();
        let mut outside: Vec<u32> = self.surface.star(v).to_vec();
        outside.retain(|slot| !slots.contains(slot));
        let mut outside: Vec<u32> = outside.into_iter().map(|slot| wedge_of(self, slot)).collect();
        outside.sort_unstable();
        for same in inside.chunk_by(|a, b| a.0 == b.0) {
            let wedge = same[0].0;
            if outside.binary_search(&wedge).is_ok() {
                let slots: Vec<u32> = same.iter().map(|&(_, slot)| slot).collect();
                self.split_wedge(wedge, &slots, error);
            }
        }
    }

    /// Gives the triangles in `slots` a copy of `wedge`, in a step of its own.
    fn split_wedge(&mut self, wedge: u32, slots: &[u32], error: f64) -> u32 {
        let copy = self.record_split(wedge, slots, error);
        if let Some(wedges) = &mut self.wedges {
            wedges.add_copy(wedge);
            slots.iter().for_each(|&slot| wedges.rename(slot, wedge, copy));
        }
        slots.iter().for_each(|&slot| self.journal.recorder.birth(slot));
        copy
    }

    /// Merges the two neighbours at one place between which the crack ends that the vertex at hand
    /// is the tip of; false where they have a triangle in common, or triangles that would be the
    /// same afterwards.
    pub(super) fn close_crack(&mut self) -> bool {
        let ring = std::mem::take(&mut self.view.ring);
        let (into, from) = (ring.vertices[0], ring.vertices[ring.vertices.len() - 1]);
        let is_free = |&slot: &u32| {
            let corners = self.surface.corners(slot);
            let renamed = corners.map(|v| if v == from { into } else { v });
            !corners.contains(&into) && !self.surface.has_oriented_triangle(renamed)
        };
        let can_merge = self.surface.star(from).iter().all(is_free);
        if can_merge {
            self.merge(from, into);
            self.evaluate(from);
            let slots = self.surface.star(into).to_vec();
            self.evaluate_corners(&slots);
            // The centre is at hand and must not be in a queue.
            self.schedule.queue.delete(ring.center);
            self.schedule.stuck.delete(ring.center);
        }
        self.view.ring = ring;
        can_merge
    }

    /// Takes the point `from` to `into`, at the same place: the inverse of a split.
    fn merge(&mut self, from: u32, into: u32) {
        self.counts.merges += 1;
        self.proof = None;
        let error = self.journal.recorder.error();
        let slots = self.surface.star(from).to_vec();
        self.accumulated.merge(from, into);
        match &self.wedges {
            None => {
                self.record_merge(from, into, &slots, error);
            }
            Some(wedges) => {
                let at = |slots: &[u32], point| {
                    let mut found: Vec<u32> =
                        slots.iter().map(|&slot| wedges.at(&self.surface, slot, point)).collect();
                    found.sort_unstable();
                    found.dedup();
                    found
                };
                let (leaving, staying) = (at(&slots, from), at(self.surface.star(into), into));
                let same = |wedge: u32| {
                    staying
                        .iter()
                        .copied()
                        .find(|&other| self.journal.origin(other) == self.journal.origin(wedge))
                };
                let merges: Vec<_> = leaving.into_iter().filter_map(|w| Some((w, same(w)?))).collect();
                for (wedge, other) in merges {
                    let renamed: Vec<u32> =
                        slots.iter().copied().filter(|&slot| self.vertices(slot).contains(&wedge)).collect();
                    self.record_merge(wedge, other, &renamed, error);
                    if let Some(wedges) = &mut self.wedges {
                        renamed.iter().for_each(|&slot| wedges.rename(slot, wedge, other));
                    }
                }
            }
        }
        self.surface.rename(from, into, &slots);
        self.tell(EventKind::Merged);
    }

    fn record_merge(&mut self, from: u32, into: u32, slots: &[u32], error: f64) {
        self.journal.recorder.step(error);
        for &slot in slots {
            let vertices = self.vertices(slot);
            self.journal.recorder.death(slot, vertices);
        }
        self.journal.collapse(from, into);
        slots.iter().for_each(|&slot| self.journal.recorder.birth(slot));
    }
}
