//! What can be wrong with a field of air.

use super::memory;
use super::record::listed;
use crate::units::{excerpt, shortest};
use std::fmt;

/// Where in a file, or among what was given.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FieldPlace {
    /// Nowhere in particular.
    #[default]
    Whole,
    /// A line of a text file, from 1.
    Line(u64),
    /// A byte of a file, from 1.
    Byte(u64),
    /// A point, from 1.
    Point(u64),
    /// A cell, from 1.
    Cell(u64),
}

/// A reason why a field cannot be used: reads as `air.vtu: cell 12: names point 99…`.
#[derive(Clone, Debug, PartialEq)]
pub struct FieldError {
    /// Name of the file, as given; empty where there is none.
    pub file: String,
    /// Where in it.
    pub place: FieldPlace,
    /// The array or column, as the file calls it, where one is to blame.
    pub array: Option<String>,
    /// What is wrong.
    pub fault: FieldFault,
}

impl FieldError {
    /// The same, found at this place unless a place is known already.
    #[must_use]
    pub(crate) fn at(mut self, place: FieldPlace) -> Self {
        if self.place == FieldPlace::Whole {
            self.place = place;
        }
        self
    }

    /// The same, found in this array unless an array is known already.
    #[must_use]
    pub(crate) fn array(mut self, name: &str) -> Self {
        self.array.get_or_insert_with(|| excerpt(name, 40));
        self
    }

    /// The same, found in this file.
    #[must_use]
    pub(crate) fn file(self, file: &str) -> Self {
        Self { file: excerpt(file, 1000), ..self }
    }
}

impl From<FieldFault> for FieldError {
    fn from(fault: FieldFault) -> Self {
        Self { file: String::new(), place: FieldPlace::Whole, array: None, fault }
    }
}

impl std::error::Error for FieldError {}

impl fmt::Display for FieldError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.file)?;
        if let FieldPlace::Line(line) = self.place {
            write!(f, ":{line}")?;
        }
        if !self.file.is_empty() {
            f.write_str(": ")?;
        }
        match self.place {
            FieldPlace::Whole | FieldPlace::Line(_) => {}
            FieldPlace::Byte(byte) => write!(f, "byte {byte}: ")?,
            FieldPlace::Point(point) => write!(f, "point {point}: ")?,
            FieldPlace::Cell(cell) => write!(f, "cell {cell}: ")?,
        }
        if let Some(array) = &self.array {
            write!(f, "{array}: ")?;
        }
        self.fault.fmt(f)
    }
}

/// What is wrong with a field of air, and the way out.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FieldFault {
    /// No such file.
    #[error(
        "there is no such file; name a field of air, VTK (.vtu, .vti, .vts, .vtr, .vtk) or a table (.csv)"
    )]
    NotThere,
    /// A folder.
    #[error("is a folder; name the field of air in it")]
    IsFolder,
    /// The system does not let it be read.
    #[error("cannot be read: {message}")]
    Unreadable {
        /// What the system says.
        message: String,
    },
    /// A file of another kind.
    #[error("is {found}; {advice}")]
    Format {
        /// What it seems to be, with its article.
        found: String,
        /// The way out.
        advice: &'static str,
    },
    /// Something else where a certain thing belongs.
    #[error("\"{found}\" stands in the place of {wanted}; is the file whole, and the right one?")]
    Syntax {
        /// As written.
        found: String,
        /// What belongs there.
        wanted: &'static str,
    },
    /// The file ends before its time.
    #[error("ends where {wanted} should follow; is the file cut off?")]
    CutOff {
        /// What should follow.
        wanted: &'static str,
    },
    /// Text that is no XML.
    #[error("is not valid XML: {message}")]
    Xml {
        /// What the parser says.
        message: String,
    },
    /// Bytes that cannot be decoded.
    #[error("cannot be decoded: {message}; is the file whole? If so, write it as ASCII")]
    Encoding {
        /// What is wrong with them.
        message: String,
    },
    /// An encoding that is not read.
    #[error("is written with {found}, which is not read here; write it with {advice}")]
    Unsupported {
        /// What it is.
        found: String,
        /// What would do.
        advice: &'static str,
    },
    /// More than memory should hold.
    #[error("holds more than {}, which is as much as is read of a file; cut out the part where the fibres fly", memory(*most as f64))]
    TooLarge {
        /// The most that is read, decoded [bytes].
        most: u64,
    },
    /// More tetrahedra than memory should hold.
    #[error("has more than {most} {of}; cut out the part where the fibres fly, or thin it")]
    TooMany {
        /// The most.
        most: u64,
        /// Of what.
        of: &'static str,
    },
    /// A number of things that does not fit.
    #[error("has {found} {of} where {wanted} are needed; is the file whole?")]
    Count {
        /// How many there are.
        found: usize,
        /// How many are needed.
        wanted: usize,
        /// Of what.
        of: &'static str,
    },
    /// Nothing there.
    #[error("holds no points; a field needs some")]
    Empty,
    /// A table without names.
    #[error("has no line of names above its numbers; write one, like x_m,y_m,z_m,u_m_s,v_m_s,w_m_s")]
    NoHeader,
    /// No velocity among the arrays.
    #[error(
        "no array is a velocity, among {}; name it U or velocity, with three components, or write u, v and w",
        listed(found)
    )]
    NoVelocity {
        /// The arrays there are.
        found: Vec<String>,
    },
    /// No coordinates among the columns.
    #[error("no column is a coordinate along {axis}, among {}; name it like {axis}_m", listed(found))]
    NoCoordinate {
        /// Which.
        axis: char,
        /// The columns there are.
        found: Vec<String>,
    },
    /// A unit that the quantity is not measured in, or not read.
    #[error("has the unit \"{unit}\"; write the values in {wanted}")]
    WrongUnit {
        /// As written.
        unit: String,
        /// What would do.
        wanted: &'static str,
    },
    /// Numbers that are none, or too large.
    #[error("{} is no number between −{most:e} and {most:e}; mend the value, or leave out what has none", shortest(*value))]
    OutOfRange {
        /// As found.
        value: f64,
        /// The most that is taken.
        most: f64,
    },
    /// A text that is no number.
    #[error("\"{text}\" is not a number; write one")]
    NotANumber {
        /// As written.
        text: String,
    },
    /// A row with cells missing or too many.
    #[error("this row has {found} cells where {wanted} are needed; {}", if found < wanted { "is the file cut off here?" } else { "do decimal commas meet a comma between cells?" })]
    Cells {
        /// Cells there are.
        found: usize,
        /// Cells needed.
        wanted: usize,
    },
    /// Coordinates or offsets that do not increase.
    #[error("goes from {} to {}; it must increase", shortest(*before), shortest(*after))]
    NotIncreasing {
        /// A value.
        before: f64,
        /// The next one.
        after: f64,
    },
    /// A point that is not there.
    #[error("names point {point}, counted from 0, where there are {points}; is the file whole?")]
    NoPoint {
        /// Its number, from 0.
        point: i64,
        /// How many there are.
        points: usize,
    },
    /// A cell of a type that is not read.
    #[error(
        "is of VTK type {kind}, which is not read here; write tetrahedra, voxels, hexahedra, wedges, pyramids or polyhedra"
    )]
    CellType {
        /// Its number.
        kind: i64,
    },
    /// A cell with the wrong number of points.
    #[error("{name} of {found} points, where {wanted} are needed; is the file whole?")]
    CellPoints {
        /// What kind of cell, with its article.
        name: &'static str,
        /// Points it has.
        found: usize,
        /// Points it needs.
        wanted: usize,
    },
    /// A mesh without inside.
    #[error(
        "has no cells with a volume{}; write the inside of the flow too, and a plane flow one cell thick or as a table of points",
        if *flat == 0 { String::new() } else { format!(", only {flat} points, lines and faces") }
    )]
    NoVolume {
        /// Cells that are points, lines or faces.
        flat: u64,
    },
    /// Too few points to go by.
    #[error("has {found} points; at least {least} are needed between which the air can be known")]
    TooFewPoints {
        /// Points there are.
        found: usize,
        /// Least number.
        least: usize,
    },
}
