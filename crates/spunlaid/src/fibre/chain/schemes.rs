//! The time-integration schemes.

/// How the equations of motion are advanced in time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Scheme {
    /// `v ← v + h a(r, v)`, then `r ← r + h v`. First order; the paper uses it. theory.md (27)
    SemiImplicitEuler,
    /// Velocities at half steps, drag from the velocity extrapolated to the full step. Second order.
    /// theory.md (28)
    Leapfrog,
    /// Leapfrog with the tension that the elements will have at the end of the step. Axial waves do not limit
    /// the step; the scheme damps them.                                  theory.md (51) to (54)
    ImplicitTension,
}

impl Scheme {
    /// Every scheme.
    pub const ALL: [Self; 3] = [Self::SemiImplicitEuler, Self::Leapfrog, Self::ImplicitTension];

    /// Name in the case file.
    pub const fn name(self) -> &'static str {
        match self {
            Self::SemiImplicitEuler => "semi-implicit-euler",
            Self::Leapfrog => "leapfrog",
            Self::ImplicitTension => "implicit-tension",
        }
    }

    /// Whether the velocities are those at half steps.
    pub(crate) const fn is_staggered(self) -> bool {
        !matches!(self, Self::SemiImplicitEuler)
    }
}
