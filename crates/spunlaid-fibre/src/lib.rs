//! One fibre: from the melt that it is drawn from to its flight in the air.
//!
//! ```text
//! body, line, drag → spinline (speed and diameter of what comes down)
//!                  → chain (forces and steps; charge, energy) → case (all that is asked of a fibre, checked)
//!                  → flight (up to eight fibres, step by step), load (what they do to their air)
//! ```
//!
//! It is a part of `spunlaid`, which is the crate to depend on: the interface here may change with any version.

// Units are written in brackets, [m/s], which rustdoc would take for broken links.
#![allow(rustdoc::broken_intra_doc_links)]

#[macro_use]
extern crate spunlaid_ground;

pub mod body;
pub mod line;

pub mod drag;

pub mod charge;
pub mod spinline;

pub mod chain;

pub mod energy;

pub mod case;

pub mod flight;
pub mod load;

// The face of the wing: the types that others know by it. Functions are called by their room.
pub use body::{FedFilament, Fibre, FilamentFeed, FilamentSize, Root};
pub use case::{
    Case, Checks, ERROR_TOLERANCE, FLIGHT_MEMORY_LIMIT, MOST_REPLICATES, MOST_STEPS, Run, StepChoice,
};
pub use chain::FibreParameters;
pub use charge::{BREAKDOWN, Charge, ChargeEstimate, SheetHeight};
pub use charge::{ChargedNode, STRONG, SheetField, Sheets};
pub use drag::{
    BoundaryLayer, Drag, DragTable, ElementDrag, FrictionLaw, Growth, NormalLaw, Share, Source, TableLaw,
};
pub use energy::Energy;
pub use flight::{EndNodeMotion, Flight, Job, LaidPoint, Snapshot};
pub use flight::{FlightInvariants, SurroundingRun};
pub use line::{Contact, Line};
pub use load::{Heat, LOAD_MEASURES, LOAD_POSITION_MEASURES, Load, LoadPlace, WayPlace};
pub use spinline::{
    AirChange, AirTable, End, Failure, Law, Material, Melt, Polymer, PolymerFile, PolymerSource,
    SPINLINE_MEASURES, SolidificationCause, Solution, SpinSpec, Spinline, Station, Surroundings,
    ZERO_CELSIUS,
};
pub use spinline::{Cooled, SolidFilament};
