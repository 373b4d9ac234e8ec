//! How a fibre is fed at the inlet, and the belt on which it is laid.

/// Feed and belt of a fibre. x runs from the inlet to the belt, which moves along +y, the machine direction; z is the
/// cross direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Laydown {
    /// Speed at which the fibre is fed, along its direction [m/s].
    pub feed_speed: f64,
    /// Distance from the inlet to the belt [m].
    pub distance: f64,
    /// Speed of the belt [m/s].
    pub belt_speed: f64,
    /// What holds the fibre on the belt.
    pub contact: Contact,
    /// Length of fibre behind the newest touch-down that is still computed [m].
    pub kept_length: f64,
    /// Number of time steps from the birth of one element to that of the next.
    pub steps_per_element: u64,
}

/// What holds the fibre on the belt.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Contact {
    /// It stays where it touches down.
    Stick,
    /// It slides where the force along the belt is larger than the friction.
    Friction {
        /// Coefficient of friction `μ` [-].
        coefficient: f64,
        /// Pressure that pulls the fibre on to the belt, times diameter a force per length [Pa].
        suction: f64,
    },
}

impl Contact {
    /// Name in the case file.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Stick => "stick",
            Self::Friction { .. } => "friction",
        }
    }
}
