//! Errors of CFD fields.

use super::listed;
use super::memory;
use crate::units::shortest;

/// What is wrong with a CFD field, and how to correct it.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FieldFault {
    /// The file is of another kind.
    #[error("is {found}; {advice}")]
    Format {
        /// What it seems to be, with an article.
        found: String,
        /// How to correct it.
        advice: &'static str,
    },
    /// Something else is written where a certain item is expected.
    #[error("\"{found}\" was found instead of {wanted}; is the file complete, and is it the right one?")]
    Syntax {
        /// As written.
        found: String,
        /// What was expected.
        wanted: &'static str,
    },
    /// The text is not XML.
    #[error("is not valid XML: {message}")]
    Xml {
        /// Message of the parser.
        message: String,
    },
    /// The data cannot be decoded.
    #[error("cannot be decoded: {message}; is the file complete? If it is, write it as ASCII")]
    Encoding {
        /// What is wrong with them.
        message: String,
    },
    /// The encoding is not supported.
    #[error("is written with {found}, which is not supported; write it with {advice}")]
    Unsupported {
        /// What it is.
        found: String,
        /// What is supported.
        advice: &'static str,
    },
    /// The file needs more memory than is allowed.
    #[error("contains more than {}, the most that is read from a file; cut out the part where the fibres fly", memory(*most as f64))]
    TooLarge {
        /// The most that is read, after decoding [bytes].
        most: u64,
    },
    /// There are more tetrahedra or points than are allowed.
    #[error("has more than {most} {of}; cut out the part where the fibres fly, or thin it")]
    TooMany {
        /// The most.
        most: u64,
        /// Of what.
        of: &'static str,
    },
    /// A quantity that cannot be negative is.
    #[error(
        "is below zero at {points} points, down to {least} with a largest value of {greatest}; it cannot be negative. Only values \
         down to {share} % of the largest are taken for rounding and set to zero. Check that the array is what its name says"
    )]
    BelowZero {
        /// How many points.
        points: u64,
        /// Smallest value.
        least: f64,
        /// Largest value.
        greatest: f64,
        /// What is taken for rounding [%].
        share: f64,
    },
    /// There is turbulence, and its dissipation is zero everywhere.
    #[error(
        "is zero at all of the {points} points where k is not, so that the eddies would be infinitely long; write the ε or ω of the \
         solution, or leave out k, and give turbulence_intensity, length_scale and cutoff_frequency in the case"
    )]
    NoDissipation {
        /// Points with turbulence.
        points: usize,
    },
    /// A number of values does not fit.
    #[error("has {found} {of} and needs {wanted}; is the file complete?")]
    Count {
        /// How many were found.
        found: usize,
        /// How many are needed.
        wanted: usize,
        /// Of what.
        of: &'static str,
    },
    /// The file has no points.
    #[error("has no points; a field needs points with values")]
    Empty,
    /// There is no array of velocity.
    #[error(
        "none of the arrays is a velocity ({}); name it U or velocity, with three components, or write u, v and w",
        listed(found)
    )]
    NoVelocity {
        /// The arrays in the file.
        found: Vec<String>,
    },
    /// A column of coordinates is missing.
    #[error("none of the columns is a coordinate along {axis} ({}); name it like {axis}_m", listed(found))]
    NoCoordinate {
        /// The axis.
        axis: char,
        /// The columns in the file.
        found: Vec<String>,
    },
    /// The unit does not fit the quantity or is not supported.
    #[error("has the unit \"{unit}\"; write the values in {wanted}")]
    WrongUnit {
        /// As written.
        unit: String,
        /// What is supported.
        wanted: &'static str,
    },
    /// A value is NaN or too large.
    #[error("{} is not a number between −{most:e} and {most:e}; correct the value, or leave out points without one", shortest(*value))]
    OutOfRange {
        /// As found.
        value: f64,
        /// The most that is taken.
        most: f64,
    },
    /// A cell names a point that does not exist.
    #[error("names point {point} (counted from 0), but there are {points} points; is the file complete?")]
    NoPoint {
        /// Its number, counted from 0.
        point: i64,
        /// How many were found.
        points: usize,
    },
    /// The type of a cell is not supported.
    #[error(
        "is of VTK type {kind}, which is not supported; write tetrahedra, voxels, hexahedra, wedges, pyramids or polyhedra"
    )]
    CellType {
        /// Its number.
        kind: i64,
    },
    /// A cell has the wrong number of points.
    #[error("{name} has {found} points and needs {wanted}; is the file complete?")]
    CellPoints {
        /// The kind of cell, with an article.
        name: &'static str,
        /// Number of its points.
        found: usize,
        /// Number of points it needs.
        wanted: usize,
    },
    /// The mesh has no cells with a volume.
    #[error(
        "has no cells with a volume{}; write the interior of the flow as well, and a plane flow one cell thick or as a table of points",
        if *flat == 0 { String::new() } else { format!(", only {flat} points, lines and faces") }
    )]
    NoVolume {
        /// Cells that are points, lines or faces.
        flat: u64,
    },
    /// A list of files names a part that cannot be used.
    #[error("names the part \"{part}\", {why}")]
    Part {
        /// As written in the list.
        part: String,
        /// Why it cannot be used, and how to correct it.
        why: &'static str,
    },
    /// A list of files names no part with a volume.
    #[error(
        "is a list that names no file with a volume{}; name the file that holds the interior of the flow",
        if *surfaces == 0 { String::new() } else { format!(", only {surfaces} with surfaces (.vtp)") }
    )]
    NoParts {
        /// How many of its parts are surfaces.
        surfaces: u64,
    },
    /// Only some of the parts have turbulence.
    #[error("has k and ε (or ω) in some of its parts only; write them in all parts, or in none")]
    TurbulenceInParts,
    /// The field has too few points.
    #[error("has {found} points; at least {least} are needed for interpolation")]
    TooFewPoints {
        /// Number of points.
        found: usize,
        /// Smallest number.
        least: usize,
    },
}
