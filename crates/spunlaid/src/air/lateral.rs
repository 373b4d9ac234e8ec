//! How the air differs across its way: its turbulence from one filament to the next, and its mean flow where it slows.

use super::Air;

/// How the turbulence differs across the flow.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Lateral {
    /// The same at each distance from the axis. Each fibre has turbulence of its own.
    #[default]
    Uniform,
    /// A field in space with the lateral structure of von Kármán's isotropic turbulence, which many fibres share.
    VonKarman {
        /// Largest lateral wave number times the length scale, `k_max L_T` [-].
        cutoff: f64,
    },
}

impl Lateral {
    /// `k_max L_T` of a case that leaves it out [-].
    pub const USUAL_CUTOFF: f64 = 10.0;
    /// Every kind; the second one has the usual cut-off.
    pub const ALL: [Self; 2] = [Self::Uniform, Self::VonKarman { cutoff: Self::USUAL_CUTOFF }];

    /// Name in the case file.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Uniform => "uniform",
            Self::VonKarman { .. } => "von-karman",
        }
    }

    /// `k_max L_T` [-]; none if the turbulence is the same across the flow.
    pub const fn cutoff(self) -> Option<f64> {
        match self {
            Self::Uniform => None,
            Self::VonKarman { cutoff } => Some(cutoff),
        }
    }
}

/// Where the mean flow of a profile widens as it slows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Widening {
    /// Nowhere: the velocity of the profile is all.
    None,
    /// Along y, the machine direction, as in a plane channel.
    MachineDirection,
}

impl Widening {
    /// Both.
    pub const ALL: [Self; 2] = [Self::None, Self::MachineDirection];

    /// Name in the case file.
    pub const fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::MachineDirection => "md",
        }
    }
}

impl Air {
    /// Whether the mean flow of a profile widens as it slows.
    pub(crate) fn widens(&self) -> bool {
        self.widening == Some(Widening::MachineDirection)
    }

    /// `k_max L_T` of the field of eddies in space [-]. None if the turbulence is the same across the flow,
    /// and in still air, which has no turbulence.
    pub fn field_cutoff(&self) -> Option<f64> {
        self.lateral.cutoff().filter(|_| self.velocity != 0.0)
    }
}
