//! Whether a fusion holds, and where its fusion point may be.

use super::creases::Kind;
use super::fusion_point::least_point;
use super::metric::Quadric;
use super::prey::Prey;
use super::state::State;
use crate::geometry::vector::{Vector, add, scale};

/// A fusion that holds.
pub(super) struct Accepted {
    pub point: [f32; 3],
    /// Bound on the distance between the boundary faces that come and the boundary of the input.
    pub error: f64,
    pub six_volumes_lost: f64,
    /// What the fusion costs with the boundary's error counted in.
    pub cost: f64,
}

/// How much the squared error of the boundary counts beside the squared distances to planes. That error is a bound and adds up,
/// which the other terms of a cost are not. Fields add up in a cost: with each the boundary counts once more, so that it does not
/// lose against many.
const ERROR_WEIGHT: f64 = 1.25e3;

/// Cost factor of a fusion that would use up the whole remaining volume budget, so that the budget is left to fusions that need little of it.
const SCARCITY: f64 = 100.0;

/// Largest star of a vertex that is fused. A fusion looks at every tetrahedron around its vertices, and gives all of those around a
/// fusion point a new lifetime: at a vertex of `n` tetrahedra that would be `n` each time, `n^2` in all. Such a vertex stays until
/// fusions around it have left it fewer. On surfaces of scanners and grids of simulations no star had more than 170.
const MAX_STAR: u32 = 512;

impl State {
    /// Whether so many tetrahedra are around a vertex that it is not fused.
    pub(super) fn is_crowded(&self, v: u32) -> bool {
        self.mesh.n_at(v) > MAX_STAR
    }

    /// The quadric error of a fusion at the best point. A lower bound of what it costs where the boundary takes part.
    pub(super) fn cost(&self, prey: &Prey) -> f64 {
        let quadric = self.metric.of(prey.vertices());
        match self.fixed(prey) {
            Some(v) => self.cost_at(prey, &quadric, v),
            None => {
                let point = self.least_point(prey.vertices(), &quadric);
                quadric.at(self.metric.local(point))
            }
        }
    }

    /// The only boundary vertex or a corner among the vertices of a prey: where the fusion point has to be.
    fn fixed(&self, prey: &Prey) -> Option<u32> {
        let kind = |v: &u32| self.creases.kind(*v);
        let mut on_boundary = prey.vertices().iter().copied().filter(|v| kind(v) != Kind::Interior);
        match (on_boundary.next(), on_boundary.next()) {
            (only, None) => only,
            _ => prey.vertices().iter().copied().find(|v| kind(v) >= Kind::Corner),
        }
    }

    /// The quadric error at the place of a fused vertex, whose values stay as they are.
    fn cost_at(&self, prey: &Prey, quadric: &Quadric, v: u32) -> f64 {
        let p = self.metric.local(self.mesh.position(v));
        let departure = self.metric.departure(prey.vertices(), p, |field| self.fields.scaled_value(v, field));
        quadric.at(p) + departure
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
        for &v in prey.vertices() {
            self.mesh.purge(v);
            if self.is_crowded(v) {
                return None;
            }
            if self.creases.kind(v) != Kind::Interior {
                members[n_members] = v;
                n_members += 1;
            }
        }
        match n_members {
            0 => {
                let quadric = self.metric.of(prey.vertices());
                let point = round(self.least_point(prey.vertices(), &quadric));
                self.try_at(prey, point)
            }
            1 => self.try_at(prey, self.mesh.positions()[members[0] as usize]),
            _ => self.try_boundary(prey, &members[..n_members]),
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

    /// A fusion that changes the boundary.
    fn try_boundary(&mut self, prey: &Prey, members: &[u32]) -> Option<Accepted> {
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
            // Far from the origin rounding can make the mesh larger: by no more than it may become smaller.
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
        for &v in anchor.vertices() {
            consider(self.mesh.positions()[v as usize], self.cost_at(prey, &quadric, v));
        }
        if anchor.is_free {
            let places = [self.least_point(members, &quadric), self.barycentre(members)];
            for place in places {
                let point = round(self.patch.highest_inside(place));
                consider(point, quadric.at(self.metric.local(point.map(f64::from))));
            }
        }
        best.filter(|_| self.stays_apart(prey))
    }

    /// Whether no face gets a third tetrahedron. Where tetrahedra fill space once none does; they need not in a file.
    fn stays_apart(&mut self, prey: &Prey) -> bool {
        match prey.vertices().iter().find(|&&v| self.creases.kind(v) == Kind::Locked) {
            Some(&locked) => self.neighbourhood.joins_nothing(&self.mesh, locked),
            None => self.neighbourhood.is_ball(&self.mesh, prey),
        }
    }

    /// Whether a whole component would vanish, as one without volume can. Components stay.
    fn leaves_nothing(&self) -> bool {
        self.neighbourhood.affected.is_empty()
    }

    /// Bound on the distance between the input's boundary and the faces that a fusion would touch. Vertices are numbered as they
    /// are born, so that a face is as old as its newest corner.
    fn error_before(&self) -> f64 {
        let newest = |face: &[u32; 3]| face.iter().copied().max().unwrap_or(0);
        self.neighbourhood.faces.iter().map(|face| self.errors[newest(face) as usize]).fold(0.0, f64::max)
    }
}

#[expect(clippy::cast_possible_truncation, reason = "positions are kept in f32")]
fn round(p: Vector) -> [f32; 3] {
    p.map(|x| x as f32)
}
