//! Whether a fusion holds, and where its fusion point may be.

use super::creases::BoundaryKind;
use super::fusion_point::least_point;
use super::metric::Quadric;
use super::neighbourhood::Affected;
use super::prey::Prey;
use super::state::{Accepted, State};
use crate::geometry::vector::{Vector, add, scale};

/// How much the squared error of the boundary counts beside the squared distances to planes. That
/// error is a bound and adds up, which the other terms of a cost are not. Fields add up in a cost:
/// with each the boundary counts once more, so that it does not lose against many.
const ERROR_WEIGHT: f64 = 1.25e3;

/// Cost factor of a fusion that would use up the whole remaining volume budget, so that the budget
/// is left to fusions that need little of it.
const SCARCITY: f64 = 100.0;

/// Largest star of a vertex that is fused. A fusion looks at every tetrahedron around its vertices,
/// and gives all of those around a fusion point a new lifetime: at a vertex of `n` tetrahedra that
/// would be `n` each time, `n^2` in all. Such a vertex stays until fusions around it have left it
/// fewer. On surfaces of scanners and grids of simulations no star had more than 170.
const MAX_STAR: u32 = 512;

impl State {
    /// Whether so many tetrahedra are around a vertex that it is not fused.
    pub(super) fn is_crowded(&self, v: u32) -> bool {
        self.mesh.n_at(v) > MAX_STAR
    }

    /// Whether two points may become one, as far as can be said without a look at their
    /// surroundings.
    pub(super) fn may_meet(&self, v: u32, w: u32) -> bool {
        let both = |is_meant: &dyn Fn(u32) -> bool| is_meant(v) && is_meant(w);
        let is_locked =
            self.lock_boundary && both(&|point| self.creases.kind(point) != BoundaryKind::Interior);
        let is_jump = both(&|point| self.jumps.is_at(point));
        !is_locked && !is_jump
    }

    /// The prey of the tetrahedron in `slot`, whose points are `corners`.
    pub(super) fn tetrahedron(&self, slot: u32, corners: [u32; 4]) -> Prey {
        Prey::tetrahedron(corners, self.jumps.vertices(slot, corners))
    }

    /// The prey of the edge between two points.
    pub(super) fn edge(&self, v: u32, w: u32) -> Prey {
        Prey::edge([v, w], self.jumps.at_edge(&self.mesh, [v, w]))
    }

    /// The quadric error of a fusion at the best point. A lower bound of what it costs where the
    /// boundary takes part.
    pub(super) fn cost(&self, prey: &Prey) -> f64 {
        let quadric = self.metric.of(prey.vertices());
        match self.fixed(prey) {
            Some(point) => self.cost_at(prey, &quadric, point),
            None => {
                let point = self.least_point(prey.points(), &quadric);
                quadric.at(self.metric.local(point))
            }
        }
    }

    /// The point of a prey at a jump, the only boundary point or a corner: where the fusion point
    /// has to be.
    fn fixed(&self, prey: &Prey) -> Option<u32> {
        let kind = |point: &u32| self.creases.kind(*point);
        let points = || prey.points().iter().copied();
        let mut on_boundary = points().filter(|point| kind(point) != BoundaryKind::Interior);
        points().find(|&point| self.jumps.is_at(point)).or_else(|| {
            match (on_boundary.next(), on_boundary.next()) {
                (only, None) => only,
                _ => points().find(|point| kind(point) >= BoundaryKind::Corner),
            }
        })
    }

    /// The quadric error at the place of a fused point, whose values stay as they are.
    fn cost_at(&self, prey: &Prey, quadric: &Quadric, point: u32) -> f64 {
        let p = self.metric.local(self.mesh.position(point));
        let vertex = prey.vertex(point);
        let value = |field| self.fields.scaled_value(vertex, field);
        quadric.at(p) + self.metric.departure(prey.vertices(), p, value)
    }

    /// Where the quadric is least; the barycentre where it does not tell.
    fn least_point(&self, vertices: &[u32], quadric: &Quadric) -> Vector {
        least_point(quadric).map_or_else(|| self.barycentre(vertices), |p| self.metric.global(p))
    }

    fn barycentre(&self, vertices: &[u32]) -> Vector {
        let sum = vertices.iter().fold([0.0; 3], |sum, &v| add(sum, self.mesh.position(v)));
        scale(sum, 1.0 / vertices.len() as f64)
    }

    /// Whether a fusion holds, and at which point. Gathers its neighbourhood.
    pub(super) fn try_fusion(&mut self, prey: &Prey) -> Option<Accepted> {
        let mut members = [0; 4];
        let mut n_members = 0;
        for &v in prey.points() {
            self.mesh.purge(v);
            if self.is_crowded(v) {
                return None;
            }
            if self.creases.kind(v) != BoundaryKind::Interior {
                members[n_members] = v;
                n_members += 1;
            }
        }
        let mut at_jumps = prey.points().iter().copied().filter(|&point| self.jumps.is_at(point));
        let (at_jump, another) = (at_jumps.next(), at_jumps.next());
        let members = &members[..n_members];
        let may_be_there = at_jump.is_none_or(|point| members.is_empty() || members.contains(&point));
        let is_locked = self.lock_boundary && members.len() > 1;
        if another.is_some() || !may_be_there || is_locked {
            return None;
        }
        match (members, at_jump) {
            ([], None) => {
                let quadric = self.metric.of(prey.vertices());
                let point = round(self.least_point(prey.points(), &quadric));
                self.try_at(prey, point)
            }
            (&[point], _) | ([], Some(point)) => self.try_at(prey, self.mesh.positions()[point as usize]),
            _ => self.try_boundary(prey, members, at_jump),
        }
    }

    /// A fusion that leaves the boundary as it is.
    fn try_at(&mut self, prey: &Prey, point: [f32; 3]) -> Option<Accepted> {
        let is_gathered = self.neighbourhood.gather(&self.mesh, prey, Some(point.map(f64::from)));
        if !is_gathered || self.leaves_nothing() || !self.stays_apart(prey) {
            return None;
        }
        let error = self.error_before();
        Some(Accepted { point, error, six_volumes_lost: 0.0, cost: 0.0 })
    }

    /// A fusion that changes the boundary, at the place of a point at a jump if there is one.
    fn try_boundary(&mut self, prey: &Prey, members: &[u32], at_jump: Option<u32>) -> Option<Accepted> {
        let anchor = self.creases.anchor(members)?;
        self.neighbourhood.gather(&self.mesh, prey, None);
        if self.leaves_nothing() || !self.patch.fill(&self.mesh, &self.neighbourhood, members) {
            return None;
        }
        let quadric = self.metric.of(prey.vertices());
        let before = self.error_before();
        let six_volumes = self.neighbourhood.six_volumes_before(&self.mesh);
        let [xx, _, _, yy, _, zz] = quadric.a;
        let error_weight = ERROR_WEIGHT * self.metric.n_fields().max(1) as f64 * (xx + yy + zz);
        let mut best: Option<Accepted> = None;
        let mut consider = |point: [f32; 3], quadric_error: f64| {
            let cost = |error: f64| quadric_error.max(0.0) + error_weight * error * error;
            let is_beaten = |error: f64| {
                error > self.max_error || best.as_ref().is_some_and(|best| best.cost <= cost(error))
            };
            // The cheapest test comes first.
            if is_beaten(before) {
                return;
            }
            let p = point.map(f64::from);
            let Some(after) = self.neighbourhood.six_volumes(p) else { return };
            let six_volumes_lost = six_volumes - after;
            // Far from the origin rounding can make the mesh larger: by no more than it may become
            // smaller.
            let left = self.six_volumes_left - six_volumes_lost;
            if left < 0.0 || left > 2.0 * self.six_volumes_to_lose {
                return;
            }
            let Some(fit) = self.patch.fit(p).filter(|fit| fit.outside <= self.slack) else { return };
            let error = before + fit.distance;
            let share_lost =
                if six_volumes_lost > 0.0 { six_volumes_lost / self.six_volumes_left } else { 0.0 };
            let cost = cost(error) * (1.0 + SCARCITY * share_lost);
            if error <= self.max_error && best.as_ref().is_none_or(|best| cost < best.cost) {
                best = Some(Accepted { point, error, six_volumes_lost, cost });
            }
        };
        for &v in anchor.vertices().iter().filter(|&&v| at_jump.is_none_or(|point| point == v)) {
            consider(self.mesh.positions()[v as usize], self.cost_at(prey, &quadric, v));
        }
        if anchor.is_free && at_jump.is_none() {
            let places = [self.least_point(members, &quadric), self.barycentre(members)];
            for place in places {
                let point = round(self.patch.highest_inside(place));
                consider(point, quadric.at(self.metric.local(point.map(f64::from))));
            }
        }
        best.filter(|_| self.stays_apart(prey))
    }

    /// Whether no face gets a third tetrahedron. Where tetrahedra fill space once none does; they
    /// need not in a file.
    fn stays_apart(&mut self, prey: &Prey) -> bool {
        if !self.is_on_one_side(prey) {
            return false;
        }
        match prey.points().iter().find(|&&v| self.creases.kind(v) == BoundaryKind::Locked) {
            Some(&locked) => self.neighbourhood.joins_nothing(&self.mesh, locked),
            None => self.neighbourhood.is_ball(&self.mesh, prey),
        }
    }

    /// Whether the tetrahedra that go have the prey's own vertices, so that no value crosses a
    /// jump, and some are left that have one.
    fn is_on_one_side(&self, prey: &Prey) -> bool {
        if !prey.points().iter().any(|&point| self.jumps.is_at(point)) {
            return true;
        }
        let own = |affected: &Affected| {
            let vertices =
                self.mesh.get(affected.slot).map(|corners| self.jumps.vertices(affected.slot, corners));
            vertices.is_some_and(|vertices| prey.vertices().contains(&vertices[affected.corner]))
        };
        if !self.neighbourhood.affected.iter().any(own) {
            return false;
        }
        let slots = self.neighbourhood.deleted.iter();
        let mut corners = slots.filter_map(|&slot| Some((slot, self.mesh.get(slot)?)));
        corners.all(|(slot, corners)| {
            let vertices = self.jumps.vertices(slot, corners);
            corners.iter().zip(vertices).all(|(&point, v)| !prey.contains(point) || prey.vertex(point) == v)
        })
    }

    /// Whether a whole component would go, as one can that has no volume. Components stay.
    fn leaves_nothing(&self) -> bool {
        self.neighbourhood.affected.is_empty()
    }

    /// Bound on the distance between the input's boundary and the faces that a fusion would touch.
    /// Vertices are numbered as they are born, so that a face is as old as its newest corner.
    fn error_before(&self) -> f64 {
        let newest = |face: &[u32; 3]| face.iter().copied().max().unwrap_or(0);
        self.neighbourhood.faces.iter().map(|face| self.errors[newest(face) as usize]).fold(0.0, f64::max)
    }
}

#[expect(clippy::cast_possible_truncation, reason = "positions are kept in f32")]
fn round(p: Vector) -> [f32; 3] {
    p.map(|x| x as f32)
}
