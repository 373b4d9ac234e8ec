//! Many simulations that answer one question: what a setting does, what to change, which settings made a scan.
//!
//! ```text
//! claim, plausible, plant → study (points of a design) → advice (what makes a web more even), fit (from a scan back)
//! ```
//!
//! It is a part of `spunlaid`, which is the crate to depend on: the interface here may change with any version.

// Units are written in brackets, [m/s], which rustdoc would take for broken links.
#![allow(rustdoc::broken_intra_doc_links)]

#[macro_use]
extern crate spunlaid_ground;

pub mod claim;
mod plant;
pub mod plausible;

pub mod study;

pub mod advice;
pub mod fit;

// The face of the wing: the types that others know by it. Functions are called by their room.
pub use advice::{Advice, Change, ChangedWeb, MOST_STEPS, SensitivityRun, setting};
pub use claim::{Claim, REAL, Verdict};
pub use claim::{goes, significance};
pub use fit::USUAL_FACTOR;
pub use fit::{
    FEWEST_WEBS, Fit, FittedKey, FittedNumber, IntervalEnd, KeyWarning, MOST_TRIALS, MeasuredPatch,
    MeasuredWeb, Parameter, Question, Target, Texture, USUAL_WEBS, WebInProgress,
};
pub use plant::{PlantNumber, plant_numbers};
pub use study::{
    Batch, Bundles, Contrast, Design, Experiment, Factor, Header, Journal, JournalState, Levels, Link, Point,
    PointResults, Progress, Quantity, Ranking, Rankings, Record, ReplicateOutcome, Replicates, Rounds, STUDY,
    Spacing, Statement, Study, StudyClaim, Trend,
};
pub use study::{MOST_POINTS, MOST_REPLICATES, RANGE};
