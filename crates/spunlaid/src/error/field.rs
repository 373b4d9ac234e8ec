//! What can be wrong with a field of air.

use super::memory;
use super::record::listed;
use crate::units::shortest;

/// What is wrong with a field of air, and the way out.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FieldFault {
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
