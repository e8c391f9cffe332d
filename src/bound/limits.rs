//! Errors of a removal, and what they may be.

/// The largest local and global error that a removal may make now.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Limits {
    /// Limit on the error between the star and its filling.
    pub local: f64,
    /// Limit on the error between the input and the filling.
    pub global: f64,
}

impl Limits {
    /// No limit.
    #[cfg(test)]
    pub(crate) const NONE: Self = Self { local: f64::INFINITY, global: f64::INFINITY };

    /// Both limits times a factor.
    pub(super) fn scaled(self, factor: f64) -> Self {
        Self { local: self.local * factor, global: self.global * factor }
    }
}

/// Errors that a removal would make, or lower bounds of them once one is above its limit.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Errors {
    /// Error between the star and its filling.
    pub local: f64,
    /// Error between the input and the filling.
    pub global: f64,
}

impl Errors {
    /// Whether both errors are within their limits.
    pub(crate) fn within(self, limits: Limits) -> bool {
        self.local <= limits.local && self.global <= limits.global
    }
}
