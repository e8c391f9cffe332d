//! The invariants of a history, which every later stage relies on.

use super::{History, NEVER};

/// A history that breaks an invariant.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum HistoryError {
    /// Parallel arrays differ in length.
    #[error("{array} has {found} entries, expected {expected}")]
    Length {
        /// Name of the array.
        array: &'static str,
        /// Its length.
        found: u64,
        /// Length of the array it belongs to.
        expected: u64,
    },
    /// More simplices, vertices or steps than 32 bits can count.
    #[error("{found} {what} exceed the range of 32-bit ids")]
    TooMany {
        /// `simplices`, `vertices` or `steps`.
        what: &'static str,
        /// How many.
        found: u64,
    },
    /// No step at all, not even step 0.
    #[error("error table is empty")]
    NoSteps,
    /// An error is negative or NaN, or the table falls.
    #[error("error of step {step} is {found} after {before}")]
    Error {
        /// Which step.
        step: u32,
        /// Its error.
        found: f64,
        /// Error of the step before, or zero.
        before: f64,
    },
    /// A deviation is negative, not finite or falling, or has another length than the errors.
    #[error("deviation {deviation} is not a finite number per step that never falls")]
    Deviation {
        /// Which one.
        deviation: usize,
    },
    /// A simplex dies before it is born, or lives outside the steps.
    #[error("simplex {simplex} has the lifetime [{birth}, {death}) in {n_steps} steps")]
    Lifetime {
        /// Which simplex.
        simplex: u32,
        /// Its birth.
        birth: u32,
        /// Its death.
        death: u32,
        /// Last step.
        n_steps: u32,
    },
    /// A simplex uses a vertex that dies before it.
    #[error("simplex {simplex} lives until step {death}, its vertex {vertex} {}", lives(*.vertex_death))]
    Vertex {
        /// Which simplex.
        simplex: u32,
        /// Its death.
        death: u32,
        /// The vertex.
        vertex: u32,
        /// Death of the vertex; `None` if there is no such vertex.
        vertex_death: Option<u32>,
    },
    /// A simplex uses a vertex that is born after it.
    #[error("simplex {simplex} is born at step {birth}, its vertex {vertex} at step {vertex_birth}")]
    UnbornVertex {
        /// Which simplex.
        simplex: u32,
        /// Its birth.
        birth: u32,
        /// The vertex.
        vertex: u32,
        /// Birth of the vertex.
        vertex_birth: u32,
    },
    /// A vertex dies at step 0.
    #[error("vertex {vertex} is dead in the input")]
    DeadVertex {
        /// Which vertex.
        vertex: u32,
    },
    /// A vertex dies before it is born, or is born after the last step.
    #[error("vertex {vertex} has the lifetime [{birth}, {death}) in {n_steps} steps")]
    VertexLifetime {
        /// Which vertex.
        vertex: u32,
        /// Its birth.
        birth: u32,
        /// Its death.
        death: u32,
        /// Last step.
        n_steps: u32,
    },
    /// A level has more simplices than the one before it.
    #[error("step {step} has {found} simplices, the level before it has {before}")]
    Grows {
        /// Step of the level.
        step: u32,
        /// Simplices alive.
        found: u32,
        /// Simplices alive at the level before.
        before: u32,
    },
}

/// Until when a vertex lives, as part of a message.
fn lives(death: Option<u32>) -> String {
    death.map_or("does not exist".to_owned(), |death| format!("until step {death}"))
}

impl<const CORNERS: usize> History<CORNERS> {
    /// Number of steps after the input: the last index into `errors`; 0 for an empty table.
    pub fn n_steps(&self) -> u32 {
        u32::try_from(self.errors.len().saturating_sub(1)).unwrap_or(u32::MAX)
    }

    /// Checks every invariant of [`History`]. Cost: one pass.
    ///
    /// # Errors
    ///
    /// The first invariant that does not hold.
    pub fn check(&self) -> Result<(), HistoryError> {
        self.check_lengths()?;
        self.check_errors()?;
        self.check_deviations()?;
        self.check_vertices()?;
        let n_steps = self.n_steps();
        let lifetimes = self.birth.iter().zip(&self.death);
        for (simplex, (vertices, (&birth, &death))) in (0..).zip(self.simplices.iter().zip(lifetimes)) {
            if birth >= death || birth > n_steps || (death > n_steps && death != NEVER) {
                return Err(HistoryError::Lifetime { simplex, birth, death, n_steps });
            }
            for &vertex in vertices {
                let vertex_death = self.vertex_death.get(vertex as usize).copied();
                if vertex_death.is_none_or(|vertex_death| vertex_death < death) {
                    return Err(HistoryError::Vertex { simplex, death, vertex, vertex_death });
                }
                let vertex_birth = self.vertex_birth(vertex);
                if vertex_birth > birth {
                    return Err(HistoryError::UnbornVertex { simplex, birth, vertex, vertex_birth });
                }
            }
        }
        Ok(())
    }

    /// Step at which a vertex appears.
    pub fn vertex_birth(&self, vertex: u32) -> u32 {
        self.vertex_birth.get(vertex as usize).copied().unwrap_or(0)
    }

    fn check_vertices(&self) -> Result<(), HistoryError> {
        let n_steps = self.n_steps();
        for (vertex, &death) in (0..).zip(&self.vertex_death) {
            if death == 0 {
                return Err(HistoryError::DeadVertex { vertex });
            }
            let birth = self.vertex_birth(vertex);
            if birth >= death || birth > n_steps {
                return Err(HistoryError::VertexLifetime { vertex, birth, death, n_steps });
            }
        }
        Ok(())
    }

    fn check_lengths(&self) -> Result<(), HistoryError> {
        let expected = self.simplices.len() as u64;
        for (array, len) in [("birth", self.birth.len()), ("death", self.death.len())] {
            let found = len as u64;
            if found != expected {
                return Err(HistoryError::Length { array, found, expected });
            }
        }
        let (found, expected) = (self.vertex_birth.len() as u64, self.vertex_death.len() as u64);
        if found != 0 && found != expected {
            return Err(HistoryError::Length { array: "vertex_birth", found, expected });
        }
        let lengths = [
            ("simplices", self.simplices.len()),
            ("vertices", self.vertex_death.len()),
            ("steps", self.errors.len()),
        ];
        for (what, len) in lengths {
            let found = len as u64;
            // NEVER must differ from every step.
            if found >= u64::from(NEVER) {
                return Err(HistoryError::TooMany { what, found });
            }
        }
        Ok(())
    }

    fn check_deviations(&self) -> Result<(), HistoryError> {
        let is_good = |values: &[f64]| {
            values.len() == self.errors.len()
                && values.iter().all(|value| value.is_finite() && *value >= 0.0)
                && values.is_sorted()
        };
        match self.deviations.iter().position(|deviation| !is_good(&deviation.values)) {
            Some(deviation) => Err(HistoryError::Deviation { deviation }),
            None => Ok(()),
        }
    }

    fn check_errors(&self) -> Result<(), HistoryError> {
        if self.errors.is_empty() {
            return Err(HistoryError::NoSteps);
        }
        let mut before = 0.0;
        for (step, &found) in (0..).zip(&self.errors) {
            if found.is_nan() || found < before {
                return Err(HistoryError::Error { step, found, before });
            }
            before = found;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn quad_to_triangle() -> History<3> {
        History {
            simplices: vec![[0, 1, 2], [0, 2, 3], [0, 1, 3]],
            birth: vec![0, 0, 1],
            death: vec![1, 1, NEVER],
            vertex_birth: vec![],
            vertex_death: vec![NEVER, NEVER, 1, NEVER],
            errors: vec![0.0, 0.5],
            deviations: vec![],
        }
    }

    #[test]
    fn vertices_are_born_before_they_die_and_before_they_are_used() {
        let with_births = |vertex_birth: [u32; 4]| {
            History { vertex_birth: vertex_birth.to_vec(), ..quad_to_triangle() }.check()
        };
        assert_eq!(with_births([0; 4]), Ok(()));
        let mut grown = quad_to_triangle();
        grown.vertex_birth = vec![0, 0, 0, 0, 1];
        grown.vertex_death.push(NEVER);
        grown.simplices[2] = [0, 1, 4];
        assert_eq!(grown.check(), Ok(()));
        let lifetime =
            |vertex, birth, death| HistoryError::VertexLifetime { vertex, birth, death, n_steps: 1 };
        assert_eq!(with_births([0, 0, 1, 0]), Err(lifetime(2, 1, 1)));
        assert_eq!(with_births([2, 0, 0, 0]), Err(lifetime(0, 2, NEVER)));
        let unborn = HistoryError::UnbornVertex { simplex: 0, birth: 0, vertex: 1, vertex_birth: 1 };
        assert_eq!(with_births([0, 1, 0, 0]), Err(unborn));
        let mut short = quad_to_triangle();
        short.vertex_birth = vec![0; 3];
        let length = HistoryError::Length { array: "vertex_birth", found: 3, expected: 4 };
        assert_eq!(short.check(), Err(length));
    }

    #[test]
    fn each_broken_invariant_is_named() {
        assert_eq!(quad_to_triangle().check(), Ok(()));
        let broken = |break_it: fn(&mut History<3>)| {
            let mut history = quad_to_triangle();
            break_it(&mut history);
            history.check().unwrap_err()
        };
        let lifetime = |simplex, birth, death| HistoryError::Lifetime { simplex, birth, death, n_steps: 1 };
        assert_eq!(
            broken(|h| h.birth.truncate(2)),
            HistoryError::Length { array: "birth", found: 2, expected: 3 }
        );
        assert_eq!(broken(|h| h.errors.clear()), HistoryError::NoSteps);
        assert_eq!(broken(|h| h.errors[0] = 0.75), HistoryError::Error { step: 1, found: 0.5, before: 0.75 });
        assert!(matches!(broken(|h| h.errors[1] = f64::NAN), HistoryError::Error { step: 1, .. }));
        assert!(matches!(broken(|h| h.errors[0] = -1.0), HistoryError::Error { step: 0, .. }));
        assert_eq!(broken(|h| h.birth[0] = 1), lifetime(0, 1, 1));
        assert_eq!(broken(|h| h.death[1] = 2), lifetime(1, 0, 2));
        assert_eq!(broken(|h| h.birth[2] = 2), lifetime(2, 2, NEVER));
        assert_eq!(
            broken(|h| h.simplices[2][1] = 9),
            HistoryError::Vertex { simplex: 2, death: NEVER, vertex: 9, vertex_death: None }
        );
        assert_eq!(
            broken(|h| h.simplices[2][1] = 2),
            HistoryError::Vertex { simplex: 2, death: NEVER, vertex: 2, vertex_death: Some(1) }
        );
        assert_eq!(broken(|h| h.vertex_death[2] = 0), HistoryError::DeadVertex { vertex: 2 });
    }
}
