//! The schemes of time integration.

/// How the equations of motion are advanced in time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scheme {
    /// `v ← v + h a(r, v)`, then `r ← r + h v`: first order, the paper's.    theory.md (27)
    SemiImplicitEuler,
    /// Velocities at half steps, drag at the velocity extrapolated to the full step: second order.
    /// theory.md (28)
    Leapfrog,
    /// Leapfrog with the tension that the elements will have at the end of the step: no axial limit on the
    /// step; axial waves die out.                                             theory.md (29)
    ImplicitTension,
}

impl Scheme {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::SemiImplicitEuler, Self::Leapfrog, Self::ImplicitTension];

    /// Name in the case file.
    pub const fn name(self) -> &'static str {
        match self {
            Self::SemiImplicitEuler => "semi-implicit-euler",
            Self::Leapfrog => "leapfrog",
            Self::ImplicitTension => "implicit-tension",
        }
    }

    /// Whether velocities are kept at half steps.
    pub const fn is_staggered(self) -> bool {
        !matches!(self, Self::SemiImplicitEuler)
    }
}
