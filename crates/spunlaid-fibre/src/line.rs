//! How a fibre is fed at the inlet, and the belt on which it is laid.

/// Feed and belt of a fibre. x runs from the inlet to the belt, which moves along +y, the machine direction; z is the
/// cross direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
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

impl Line {
    /// Feed and belt of which nothing is known yet.
    pub const UNKNOWN: Self = Self {
        feed_speed: f64::NAN,
        distance: f64::NAN,
        belt_speed: f64::NAN,
        contact: Contact::Stick,
        kept_length: f64::NAN,
        steps_per_element: 1,
    };

    /// Speed of the belt over the speed of the feed: the length of belt that passes while a length of fibre
    /// is fed, over that length [-].
    pub fn belt_ratio(&self) -> f64 {
        self.belt_speed / self.feed_speed
    }

    /// The fewest time steps in which an element can be fed: one, or eight if the fibre slides. Flights with
    /// sliding fibres were seen to fail with four.
    pub(crate) const fn fewest_steps(&self) -> u64 {
        match self.contact {
            Contact::Stick => 1,
            Contact::Friction { .. } => 8,
        }
    }

    /// The number of steps, of at most `longest` [s], in which an element of `length` [m] is fed.
    pub fn steps_of(&self, length: f64, longest: f64) -> u64 {
        let ratio = length / self.feed_speed / longest;
        // A step that was written with all its digits is not shortened because of the last of them.
        (ratio * (1.0 - 1e-9)).ceil().clamp(1.0, 1e15) as u64
    }
}

impl Contact {
    /// Every kind of contact, with the usual numbers.
    pub(crate) const ALL: [Self; 2] = [Self::Stick, Self::Friction { coefficient: 0.3, suction: 200.0 }];

    /// Name in the case file.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Stick => "stick",
            Self::Friction { .. } => "friction",
        }
    }
}
