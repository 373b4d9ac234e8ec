//! What the user of a field should know.

use std::fmt;

/// Something about a field that the reader of what comes of it should know.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum FieldWarning {
    /// Points, lines and faces among the cells.
    NotSolid {
        /// How many.
        cells: u64,
    },
    /// Cells with curved edges.
    HigherOrder {
        /// How many.
        cells: u64,
    },
    /// Cells without volume.
    Flat {
        /// How many.
        cells: u64,
    },
    /// Cells so crooked that no point sees all of their inside.
    Folded {
        /// How many.
        cells: u64,
    },
    /// Points at the place of another one, with other values.
    Merged {
        /// How many.
        points: u64,
    },
    /// Values at cells, not at points.
    OfCells {
        /// The array.
        array: String,
    },
    /// Rows of a table without all of their numbers.
    Dropped {
        /// How many.
        rows: u64,
        /// The line of the first.
        first: u64,
    },
    /// Turbulence below zero.
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
                    "{cells} cells are points, lines or faces, of the boundary perhaps, and are left out"
                )
            }
            Self::HigherOrder { cells } => {
                write!(f, "{cells} cells have curved edges; their corners alone are used")
            }
            Self::Flat { cells } => write!(f, "{cells} cells have no volume and are left out"),
            Self::Folded { cells } => write!(
                f,
                "{cells} cells fold over themselves, and the air within them is only roughly right; check the mesh"
            ),
            Self::Merged { points } => write!(
                f,
                "{points} points lie exactly where another one does and differ from it; the mean of their values is \
                 taken"
            ),
            Self::OfCells { array } => write!(
                f,
                "{array} is given for cells and goes to their points as the mean of the cells around: at walls the air \
                 does not come to rest; write values at points if you can"
            ),
            Self::Dropped { rows, first } => {
                write!(f, "{rows} rows lack a number and are left out, the first in line {first}")
            }
            Self::Negative { array, points } => {
                write!(f, "{array} is negative at {points} points, where zero is taken")
            }
        }
    }
}
