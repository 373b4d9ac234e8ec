//! What the crates of the simulator `spunlaid` are built on, independent of fibres: numbers side by side in
//! lanes, vectors, transforms, chance; units, errors and their words; threads, tables of text, logs of keyed rows;
//! statistics, measures.
//!
//! It is published because `spunlaid` and `spunlaid-field` need it; its interface follows their needs.
//!
//! ```text
//! named → lanes → vec3, fft, nodes, random, place → error → units, threads
//!       → company, log → file, table → statistics → measure → effects
//! ```

// Units are written in brackets, [m/s], which rustdoc would take for broken links.
#![allow(rustdoc::broken_intra_doc_links)]

#[macro_use]
mod named;

// Vector instructions are unsafe to call; nothing else in the workspace is.
#[allow(unsafe_code)]
pub mod lanes;

pub mod fft;
pub mod nodes;
pub mod place;
pub mod random;
pub mod vec3;

pub mod error;

pub mod threads;
pub mod units;

pub mod company;
pub mod log;

pub mod file;
pub mod table;

pub mod statistics;

pub mod measure;

pub mod effects;

// The face: the types that others know by it. Functions are called by their room.
pub use company::{Bits, PerLane};
pub use effects::{
    Change, ChangedKey, Effect, NAMED, Outcome, RACING, Sensitivity, SensitivityRun, Setting, Turned,
};
pub use error::{Diagnostic, Error, Fault, FileError, FileKind, IS, Position, Severity, WAS};
pub use fft::{Complex, InverseTransform, WideComplex};
pub use lanes::{F32x12, F32x16, Isa, Lanes, Plain, Register, Simd, Task, WIDTH, Wide};
pub use log::Log;
pub use measure::{
    Aggregate, ErrorRole, Figure, Formula, Group, HERTZ, KELVIN, Known, METRES_PER_SECOND, MILLIMETRES,
    MILLINEWTONS, Measure, MeasureKind, Measured, OF_PERCENT, PER_METRE, PER_SQUARE_METRE, PERCENT, RATIO,
    SQUARE_MILLIMETRES_PER_HERTZ, Unit, Value,
};
pub use nodes::Nodes;
pub use statistics::{Difference, Estimate, EvenSample, Interval, NORMAL_95, Spectrum, Welch, Window};
pub use table::{FORMS, FirstCell, Head, Stamp, Table, refuse_twice};
pub use threads::{OnDrop, RunContext, Workers};
pub use units::{Dimension, Expression, Powers, UnitAdvice};
pub use vec3::Vec3;
