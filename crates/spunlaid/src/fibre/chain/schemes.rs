//! The time-integration schemes.

named! {
    /// How the equations of motion are advanced in time.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
    pub enum Scheme {
        /// `v ← v + h a(r, v)`, then `r ← r + h v`. First order; the paper uses it. theory.md (27)
        SemiImplicitEuler = "semi-implicit-euler",
        /// Velocities at half steps, drag from the velocity extrapolated to the full step. Second order.
        /// theory.md (28)
        Leapfrog = "leapfrog",
        /// Leapfrog with the tension that the elements will have at the end of the step. Axial waves do not limit
        /// the step; the scheme damps them.                                  theory.md (51) to (54)
        ImplicitTension = "implicit-tension",
    }
}

impl Scheme {
    /// Whether the velocities are those at half steps.
    pub(crate) const fn is_staggered(self) -> bool {
        !matches!(self, Self::SemiImplicitEuler)
    }
}
