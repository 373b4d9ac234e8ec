//! What is simulated together: fibres in independent turbulence, or all filaments of a line in shared turbulence, and
//! what is measured.
//!
//! ```text
//! observe (what is measured) → ensemble (fibres in independent turbulence)
//!                            layers (the webs of a line) → shared_turbulence (their filaments)
//! ```
//!
//! It is a part of `spunlaid`, which is the crate to depend on: the interface here may change with any version.

// Units are written in brackets, [m/s], which rustdoc would take for broken links.
#![allow(rustdoc::broken_intra_doc_links)]

#[macro_use]
extern crate spunlaid_ground;

pub mod observe;

pub mod ensemble;

pub mod layers;

pub mod shared_turbulence;

// The face of the wing: the types that others know by it. Functions are called by their room.
pub use ensemble::{
    CellSource, Change, Curve, CurveValue, EndPath, EndPoint, FinerCheck, FinerChecks, FinerPlans, Job,
    KeepShapes, LaidCurves, LineFilaments, LostFibre, Number, Recorded, Recorder, Refinement, Results,
    RunPaths, Shape, Shapes, Silence, Sources, SpectrumPoint, Statistic, Trajectory, Unchecked,
};
pub use layers::SAME;
pub use layers::{
    Flown, KEPT_SIMULATIONS, LaydownSource, LayerSpec, WEB, WEB_KEYS, WEB_TABLES, WantedError, WebKey,
    WebSpec,
};
pub use observe::{DECLARED, FibreMeasure, LAYDOWN, MEASURES, Observation, Observer, SURROGATE};
pub use shared_turbulence::FewOfWeb;
pub use shared_turbulence::{
    Beam, BeamCharge, BeamFindings, Compared, Flights, FlownWeb, Flyer, PlannedFlight,
};
