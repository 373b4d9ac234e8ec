//! The air along the spinline.

use spunlaid_air::FileContent;

/// The air along the spinline.
#[derive(Clone, Debug, PartialEq)]
pub enum Surroundings {
    /// The same everywhere.
    Uniform(AirState),
    /// Values at distances from the die, from a table.
    Table(FileContent<AirTable>),
    /// The velocity of the case's CFD field upstream of the inlet.
    Field {
        /// Temperature of the air [K].
        temperature: f64,
        /// The air along the line, as it was found in the field.
        table: AirTable,
    },
    /// The air behind a row of filaments.
    Behind(AirTable),
}

/// The air at a place of the spinline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AirState {
    /// Velocity along the filament `u`, downwards [m/s].
    pub velocity: f64,
    /// Velocity across it `v_c` [m/s].
    pub cross_velocity: f64,
    /// Temperature `T_a` [K].
    pub temperature: f64,
}

/// How the air of a table or a field is changed as a whole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AirChange {
    /// Factor on the velocity along the filament [-].
    pub velocity_factor: f64,
    /// Factor on the velocity across it [-].
    pub cross_velocity_factor: f64,
    /// Added to the temperature [K].
    pub temperature_offset: f64,
    /// Whether `velocity_factor` follows from the air at the slot, with which the air along the line ends.
    pub follows_air: bool,
}

impl AirChange {
    /// The air stays as it is.
    pub(crate) const NONE: Self = Self {
        velocity_factor: 1.0,
        cross_velocity_factor: 1.0,
        temperature_offset: 0.0,
        follows_air: false,
    };

    /// The changed air.
    pub(super) fn apply(self, air: AirState) -> AirState {
        AirState {
            velocity: self.velocity_factor * air.velocity,
            cross_velocity: self.cross_velocity_factor * air.cross_velocity,
            temperature: air.temperature + self.temperature_offset,
        }
    }
}

/// The air as a function of the distance from the die. It is linear between the rows; outside of them it is
/// that of the nearest row.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AirTable {
    /// Distances from the die `z`, rising [m].
    pub distance: Vec<f64>,
    /// Velocity along the filament [m/s].
    pub velocity: Vec<f64>,
    /// Velocity across the filament [m/s].
    pub cross_velocity: Vec<f64>,
    /// Temperature [K].
    pub temperature: Vec<f64>,
}

impl AirTable {
    /// The velocity along the filament at a distance from the die [m/s].
    pub fn velocity_at(&self, distance: f64) -> f64 {
        self.at(distance, &mut 0).velocity
    }

    /// The air at a distance from the die [m].
    ///
    /// * `hint` – the row above which the last look was; a look nearby is quicker with it
    fn at(&self, distance: f64, hint: &mut usize) -> AirState {
        let rows = self.distance.len();
        let mut above = (*hint).min(rows);
        while above < rows && self.distance[above] <= distance {
            above += 1;
        }
        while above > 0 && self.distance[above - 1] > distance {
            above -= 1;
        }
        *hint = above;
        let (low, high) = (above.saturating_sub(1), above.min(rows - 1));
        let share = if low == high {
            0.0
        } else {
            (distance - self.distance[low]) / (self.distance[high] - self.distance[low])
        };
        let between = |column: &[f64]| column[low] + share * (column[high] - column[low]);
        AirState {
            velocity: between(&self.velocity),
            cross_velocity: between(&self.cross_velocity),
            temperature: between(&self.temperature),
        }
    }
}

impl Surroundings {
    /// The table, if the air changes along the line.
    pub fn table(&self) -> Option<&AirTable> {
        match self {
            Self::Uniform(_) => None,
            Self::Table(table) => Some(table),
            Self::Field { table, .. } | Self::Behind(table) => Some(table),
        }
    }

    /// The air at a distance from the die [m]; see [`AirTable`].
    pub fn at(&self, distance: f64, hint: &mut usize) -> AirState {
        match self {
            Self::Uniform(state) => *state,
            Self::Table(table) => table.at(distance, hint),
            Self::Field { table, .. } | Self::Behind(table) => table.at(distance, hint),
        }
    }

    /// The distances at which the air may have a kink [m].
    pub(crate) fn rows(&self) -> &[f64] {
        self.table().map_or(&[], |table| &table.distance)
    }
}
