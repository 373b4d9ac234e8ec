//! Warnings about a field.

use std::fmt;

/// Something that was left out or corrected when a field was made.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum FieldWarning {
    /// Some cells are points, lines or faces.
    NotSolid {
        /// How many.
        cells: u64,
    },
    /// Some cells have curved edges.
    HigherOrder {
        /// How many.
        cells: u64,
    },
    /// Some cells have no volume.
    Flat {
        /// How many.
        cells: u64,
    },
    /// Some cells are so distorted that they fold over themselves.
    Folded {
        /// How many.
        cells: u64,
    },
    /// Some points lie at the same place and have different values.
    Merged {
        /// How many.
        points: u64,
    },
    /// The values are given at cells, not at points.
    OfCells {
        /// The array.
        array: String,
    },
    /// Some rows of a table lack a number.
    Dropped {
        /// How many.
        rows: u64,
        /// Line of the first such row.
        first: u64,
    },
    /// Some parts of a list are surfaces.
    Surfaces {
        /// How many.
        parts: u64,
    },
    /// Some values of the turbulence are negative.
    Negative {
        /// The array.
        array: String,
        /// How many points.
        points: u64,
    },
}

impl fmt::Display for FieldWarning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotSolid { cells } => {
                write!(
                    f,
                    "{cells} cells are points, lines or faces, perhaps of the boundary; they are left out"
                )
            }
            Self::HigherOrder { cells } => {
                write!(f, "{cells} cells have curved edges; only their corners are used")
            }
            Self::Flat { cells } => write!(f, "{cells} cells have no volume and are left out"),
            Self::Folded { cells } => write!(
                f,
                "{cells} cells fold over themselves, and the air within them is only roughly right; check the mesh"
            ),
            Self::Merged { points } => write!(
                f,
                "{points} points lie exactly at the place of another point but have other values; the mean of their \
                 values is used"
            ),
            Self::OfCells { array } => write!(
                f,
                "{array} is given at cells; each point gets the mean of the cells around it, so the air does not come \
                 to rest at walls; write values at points if you can"
            ),
            Self::Dropped { rows, first } => {
                write!(f, "{rows} rows lack a number and are left out; the first is in line {first}")
            }
            Self::Surfaces { parts } => {
                write!(
                    f,
                    "the list names surfaces too (.vtp: {parts}), perhaps the boundary; they are left out"
                )
            }
            Self::Negative { array, points } => {
                write!(f, "{array} is negative at {points} points; zero is used there")
            }
        }
    }
}
