//! What every other wing stands on, and what knows nothing of fibres: numbers side by side in lanes, vectors,
//! transforms, chance; units, errors and their words; threads, tables, logs of keyed rows; statistics, measures.
//!
//! ```text
//! named → lanes → vec3, fft, nodes, sort, random, place → error → units, threads, removed
//!       → company, log → file, table → statistics → measure → effects
//! ```

#[macro_use]
mod named;

// Vector instructions are unsafe to call; nothing else in the workspace is.
#[allow(unsafe_code)]
pub mod lanes;

pub(crate) mod fft;
pub mod nodes;
pub mod place;
pub(crate) mod random;
pub(crate) mod sort;
pub mod vec3;

pub mod error;

pub mod removed;
pub mod threads;
pub mod units;

pub(crate) mod company;
pub mod log;

pub(crate) mod file;
pub mod table;

pub mod statistics;

pub mod measure;

pub mod effects;

// The face of the wing: the types that others know by it. Functions are called by their room.
pub(crate) use company::{Bits, PerLane};
pub(crate) use effects::RACING;
pub use effects::{Change, ChangedKey, Effect, NAMED, Outcome, Setting, Trials, Tried};
pub use error::{Error, Fault, FileError, FileKind, Finding, Position, Problem};
pub(crate) use error::{IS, WAS};
pub(crate) use fft::{Complex, InverseTransform, WideComplex};
#[cfg(test)]
pub(crate) use lanes::Plain;
pub use lanes::{Isa, Lanes, WIDTH};
pub(crate) use lanes::{Register, Simd, Singles, Sixteen, Task, Wide};
pub use log::Log;
pub use measure::{
    Aggregate, ErrorRole, Figure, Formula, Group, HERTZ, KELVIN, Known, METRES_PER_SECOND, MILLIMETRES,
    MILLINEWTONS, Measure, MeasureKind, Measured, OF_PERCENT, PER_METRE, PER_SQUARE_METRE, PERCENT, RATIO,
    SQUARE_MILLIMETRES_PER_HERTZ, Unit, Value,
};
pub use nodes::Nodes;
pub use removed::{REMOVED, Removed};
pub(crate) use statistics::EvenSample;
pub use statistics::{Difference, Estimate, Interval, NORMAL_95, Spectrum, Welch, Window};
pub use table::Table;
pub(crate) use table::{FORMS, FirstCell, Head, Meaning, ParquetTable, Stamp};
pub use threads::OnDrop;
pub(crate) use units::Powers;
pub use units::{Dimension, Expression, UnitAdvice};
pub use vec3::Vec3;
